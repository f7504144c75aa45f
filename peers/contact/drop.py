"""A soft cube falls on another one: pliant, MuJoCo and Newton on the same mesh, error against time.

    PLIANT=path/to/pliant python drop.py soft     # or stiff: prints a table of ../contact.md and writes ../charts/contact-soft.svg

Cubes of 0.1 m, 5 x 5 x 5 nodes, tetrahedra, lumped masses, E = 0.1 MPa (stiff: 1 MPa), nu = 0.3, 1000 kg/m^3, without damping and friction. One is
held at its bottom, the other one comes down at 0.5 m/s, turned at random. Errors are root mean square distances of all nodes from a reference of the same mesh
and law over 30 times.
"""

import itertools
import os
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
import ipctk
import numpy as np
import scipy.sparse

import chart
from bodies import Run, Surfaces, body, grid, random_turn, stopwatch

CASE = sys.argv[1] if len(sys.argv) > 1 else "soft"
YOUNG, SEED, REFERENCE_STEP = {"soft": (1e5, 7, 5e-6), "stiff": (1e6, 3, 2.5e-6)}[CASE]
POISSON, DENSITY, SPEED, GRAVITY = 0.3, 1000.0, 0.5, 9.8
TIMES = np.linspace(0.0, 0.15, 31)
LOWER = grid([0.1] * 3, [5] * 3)
HELD = np.flatnonzero(LOWER.nodes[:, 2] < -0.0499)
turned = LOWER.moved(random_turn(np.random.default_rng(SEED), 3), np.zeros(3))
UPPER = turned.moved(np.eye(3), [0.02, 0.01, 0.051 - turned.nodes[:, 2].min()])
SURFACES = Surfaces([LOWER, UPPER])
START, COUNT = SURFACES.nodes, len(LOWER.nodes)
CELLS = np.concatenate([LOWER.cells, UPPER.cells + COUNT])
MASSES = np.concatenate([mesh.masses(DENSITY) for mesh in (LOWER, UPPER)])
MU, LAMBDA = YOUNG / (2 + 2 * POISSON), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
EDGES = START[CELLS][:, 1:] - START[CELLS][:, :1]
VOLUMES = np.abs(np.linalg.det(EDGES)) / 6
_shapes = np.linalg.inv(EDGES.transpose(0, 2, 1))
_shapes = np.concatenate([-_shapes.sum(1, keepdims=True), _shapes], 1)
_rows = np.arange(3 * len(CELLS)).reshape(-1, 1, 3).repeat(4, 1)
# takes positions of nodes to transposed deformation gradients
GRADIENT = scipy.sparse.csr_matrix((_shapes.ravel(), (_rows.ravel(), CELLS[:, :, None].repeat(3, 2).ravel())))
LAWS = ["st-venant-kirchhoff", "stable neo-Hookean"]  # that of MuJoCo and pliant, and Newton's


class Motion:
    """Positions at `TIMES` (m), energies there but for that of the contact (J), and the processor time (s)."""

    def __init__(self, positions, velocities, law, seconds=0.0):
        self.x, self.law, self.seconds = np.array(positions), law, seconds
        kinetic = 0.5 * (MASSES[:, None] * np.array(velocities) ** 2).sum((1, 2))
        potential = [GRAVITY * MASSES @ x[:, 2] + VOLUMES @ strain(deformation(x), law) for x in self.x]
        self.energy = kinetic + potential


def pliant(D, rtol, method="auto", refined=False):
    """`refined`: with quadratic cells, which have nodes on all edges of the mesh besides."""
    of = f"{{ density = {DENSITY}, young = {YOUNG}, poisson = {POISSON}, viscosity = 0.0 }}"
    lumped = "" if refined else 'inertia = "lumped"\n'
    cubes = body("lower", LOWER, of, lumped) + body("upper", UPPER, of, lumped + f"velocity = [0.0, 0.0, -{SPEED}]\n")
    between = len({(*sorted(edge),) for cell in LOWER.cells for edge in itertools.combinations(cell, 2)}) if refined else 0
    numbers = [*range(1, COUNT + 1), *(COUNT + between + n for n in range(1, COUNT + 1))]
    scene = (
        f"gravity = [0.0, 0.0, -{GRAVITY}]\n" + cubes.replace('"listed"', '"listed", quadratic = true' if refined else '"listed"')
        + f'[[touch]]\nbodies = ["lower", "upper"]\ndistance = {D}\n'
        + f'[[phase]]\nuntil = {TIMES[-1]}\nhold = [{{ nodes = {(HELD + 1).tolist()} }}]\n'
        + f'[solver]\nrtol = {rtol}\nmethod = "{method}"\n'
        + f"[output]\nstep = {TIMES[1]}\ntrack = {numbers}\n"
    )
    run = Run(scene)
    if run.failed:
        raise RuntimeError(run.messages)
    x = run.positions(START, numbers)
    motion = Motion(x, np.zeros_like(x), LAWS[0], run.processor)
    motion.energy = sum(run.columns[part] for part in ("kinetic", "strain", "gravity"))
    return motion


def mujoco(step, integrator, soft, passive=False):
    """With contact of the time constant `soft` (s), critically damped."""
    import mujoco

    # it warns that flexes without constraints have no passive forces, whatever their elasticity
    mujoco.set_mju_user_warning(lambda message: None)
    flexes = ""
    for name, mesh, held in (("lower", LOWER, HELD), ("upper", UPPER, [])):
        text = lambda values: " ".join(f"{value:.9g}" for value in np.ravel(values))
        flexes += (
            f'<flexcomp name="{name}" type="direct" dim="3" radius="1e-5" point="{text(mesh.nodes)}" element="{text(mesh.cells)}">'
            + (f'<pin id="{text(held)}"/>' if len(held) else "")
            + f'<contact selfcollide="none" condim="1" solref="{soft} 1" passive="{str(passive).lower()}"/>'
            + f'<elasticity young="{YOUNG}" poisson="{POISSON}"/></flexcomp>'
        )
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><size memory="500M"/><worldbody>{flexes}</worldbody>'
        f'<option timestep="{step}" integrator="{integrator}" gravity="0 0 -{GRAVITY}"/></mujoco>'
    )
    # nodes have the same mass each by default
    free = np.flatnonzero(model.flex_vertbodyid > 0)
    bodies = model.flex_vertbodyid[free]
    model.body_mass[bodies] = MASSES[free]
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    places = model.body_dofadr[bodies][:, None] + np.arange(3)
    data.qvel[places[free >= COUNT, 2]] = -SPEED
    x, v = [], []

    def record():
        mujoco.mj_kinematics(model, data)
        mujoco.mj_flex(model, data)
        x.append(data.flexvert_xpos.copy())
        v.append(np.zeros_like(START))
        v[-1][free] = data.qvel[places]

    def work():
        record()
        for _ in TIMES[1:]:
            for _ in range(round(TIMES[1] / step)):
                mujoco.mj_step(model, data)
            record()

    _, seconds = stopwatch(work)
    return Motion(x, v, LAWS[0], seconds)


def newton(step, iterations, D, stiffness):
    """Vertex block descent, with the contact distance `D` (m) and the `stiffness` (N/m) of each contact."""
    import warp

    warp.config.quiet = True
    import newton

    builder = newton.ModelBuilder(gravity=(0.0, 0.0, -GRAVITY))
    for mesh in (LOWER, UPPER):
        builder.add_soft_mesh(
            pos=warp.vec3(), rot=warp.quat_identity(), scale=1.0, vel=warp.vec3(), vertices=[warp.vec3(*x) for x in mesh.nodes.tolist()],
            indices=mesh.cells.ravel().tolist(), density=DENSITY, k_mu=MU, k_lambda=LAMBDA, k_damp=0.0, particle_radius=1e-4,
        )
    for node in HELD:
        builder.particle_mass[node] = 0.0
        builder.particle_flags[node] &= ~int(newton.ParticleFlags.ACTIVE)
    builder.color()
    model = builder.finalize(device="cpu")
    model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu = stiffness, 0.0, 0.0
    solver = newton.solvers.SolverVBD(
        model, iterations=iterations, particle_enable_self_contact=True, particle_self_contact_margin=D, particle_self_contact_gap=D,
        particle_enable_tile_solve=False,
    )
    states, control = [model.state(), model.state()], model.control()
    solver.step(*states, control, None, step)  # compiles
    v = np.zeros_like(START)
    v[COUNT:, 2] = -SPEED
    states[0].particle_q.assign(START.astype(np.float32))
    states[0].particle_qd.assign(v.astype(np.float32))
    motion = [[START, v]]

    def work():
        for _ in TIMES[1:]:
            for _ in range(round(TIMES[1] / step)):
                states[0].clear_forces()
                solver.step(*states, control, None, step)
                states.reverse()
            motion.append([states[0].particle_q.numpy().astype(float), states[0].particle_qd.numpy().astype(float)])

    _, seconds = stopwatch(work)
    return Motion(*zip(*motion), LAWS[1], seconds)


def deformation(x):
    """Deformation gradients, cells x 3 x 3."""
    return (GRADIENT @ x).reshape(-1, 3, 3).transpose(0, 2, 1)


def strain(F, law):
    """Energies per natural volume (J/m^3)."""
    if law == LAWS[0]:
        E = 0.5 * (F.transpose(0, 2, 1) @ F - np.eye(3))
        return MU * (E**2).sum((1, 2)) + 0.5 * LAMBDA * np.trace(E, axis1=1, axis2=2) ** 2
    alpha = MU / (LAMBDA + MU)
    return 0.5 * MU * ((F**2).sum((1, 2)) - 3) + 0.5 * (LAMBDA + MU) * ((np.linalg.det(F) - 1 - alpha) ** 2 - alpha**2)


def stress(F, law):
    """First Piola-Kirchhoff stress (Pa) under deformation gradients, cells x 3 x 3."""
    if law == LAWS[0]:
        E = 0.5 * (F.transpose(0, 2, 1) @ F - np.eye(3))
        return F @ (2 * MU * E + LAMBDA * np.trace(E, axis1=1, axis2=2)[:, None, None] * np.eye(3))
    # stable neo-Hookean (Smith, de Goes, Kim 2018), as Newton has it
    J = np.linalg.det(F)[:, None, None]
    cofactors = J * np.linalg.inv(F).transpose(0, 2, 1)
    return MU * F + (LAMBDA + MU) * (J - 1 - MU / (LAMBDA + MU)) * cofactors


def toolkit(law, D, step, stiffness):
    """Central differences with the contact of the IPC toolkit: a motion that owes nothing to the others."""
    spread = GRADIENT.T.tocsr()
    surface, used = SURFACES.apart, SURFACES.used
    potential = ipctk.BarrierPotential(D, stiffness)
    free = np.ones((len(START), 1))
    free[HELD] = 0.0
    x, v, near = START.copy(), np.zeros_like(START), ipctk.Candidates()
    v[COUNT:, 2] = -SPEED
    motion = [[x.copy(), v.copy()]]
    for number in range(round(TIMES[-1] / step)):
        x += 0.5 * step * v
        pushes = VOLUMES[:, None, None] * stress(deformation(x), law)
        force = -spread @ pushes.transpose(0, 2, 1).reshape(-1, 3)
        if number % 20 == 0:
            near.build(surface, x[used], 1e-3)
        if len(near):
            collisions = ipctk.NormalCollisions()
            collisions.build(near, surface, x[used], D)
            force[used] -= potential.gradient(collisions, surface, x[used]).reshape(-1, 3)
        v += step * free * (force / MASSES[:, None] - [0.0, 0.0, GRAVITY])
        x += 0.5 * step * v
        if (number + 1) % round(TIMES[1] / step) == 0:
            motion.append([x.copy(), v.copy()])
    return Motion(*zip(*motion), law)


def runs():
    """Names of lines, settings, and what runs them."""
    for D in [2e-3, 1e-3, 5e-4, 2e-4, 1e-4]:
        yield "pliant", f"D = {1e3 * D:g} mm, rtol 1e-3", lambda: pliant(D, 1e-3)
    for rtol in [1e-4, 1e-5]:
        yield "pliant", f"D = 0.2 mm, rtol 1e-{round(-np.log10(rtol))}", lambda: pliant(2e-4, rtol)
    yield "pliant, central differences", "D = 0.2 mm", lambda: pliant(2e-4, 1e-3, "central-difference")
    for step in [5e-3, 2.5e-3, 1e-3, 5e-4, 2.5e-4, 1e-4]:
        yield "MuJoCo `discrete`", f"steps of {1e3 * step:g} ms, stiffest contact", lambda: mujoco(step, "discrete", 1e-4)
    yield "MuJoCo `discrete`, as it comes", "steps of 1 ms, contact of 20 ms", lambda: mujoco(1e-3, "discrete", 0.02)
    for step in [1e-3, 2.5e-4]:
        yield "MuJoCo `discrete`, passive", f"steps of {1e3 * step:g} ms", lambda: mujoco(step, "discrete", 0.02, True)
    for step in [2.5e-3, 1e-3, 5e-4, 2.5e-4, 1e-4, 5e-5, 2.5e-5]:
        yield "MuJoCo `Euler`", f"steps of {1e3 * step:g} ms, contact of two", lambda: mujoco(step, "Euler", 2 * step)
    for step in [2.5e-4, 1e-4, 5e-5]:
        yield "MuJoCo `Euler`, 1 ms", f"steps of {1e3 * step:g} ms, contact of 1 ms", lambda: mujoco(step, "Euler", 1e-3)
    for step in [5e-4, 2.5e-4, 1e-4]:
        yield "MuJoCo `RK4`", f"steps of {1e3 * step:g} ms, contact of two", lambda: mujoco(step, "RK4", 2 * step)
    for step in [5e-3, 2.5e-3, 1e-3, 5e-4, 2.5e-4]:
        yield "Newton VBD", f"steps of {1e3 * step:g} ms, 10 rounds, D = 1 mm", lambda: newton(step, 10, 1e-3, 1e4)
    yield "Newton VBD", "steps of 0.25 ms, 20 rounds, D = 0.3 mm", lambda: newton(2.5e-4, 20, 3e-4, 1e4)


def main():
    distance = lambda a, b: 1e3 * np.sqrt(((a - b) ** 2).sum(-1).mean())
    references = {law: toolkit(law, 5e-5, REFERENCE_STEP, 1e14) for law in LAWS}
    others = {law: toolkit(law, 2e-4, 2 * REFERENCE_STEP, 1e7 * YOUNG) for law in LAWS}
    for law, reference in references.items():
        print(f"reference, {law}: {distance(reference.x, others[law].x):.2f} mm from one of D = 0.2 mm; motion {distance(reference.x, START):.1f} mm; "
              f"energy {reference.energy[-1] - reference.energy[0]:+.1e} J")
    print(f"laws: {distance(*(references[law].x for law in LAWS)):.2f} mm apart; pliant, D = 0.05 mm, rtol 1e-5: "
          f"{distance(pliant(5e-5, 1e-5).x, references[LAWS[0]].x):.2f} mm")
    finer = pliant(5e-4, 1e-3, refined=True)
    print(f"mesh: {distance(finer.x, references[LAWS[0]].x):.2f} mm from quadratic cells, {finer.seconds:.1f} s\n", flush=True)
    print("| | | error (mm) | energy at the end | deepest overlap (mm) | states that intersect | time (s) |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    lines, fallen = {}, 0.5 * DENSITY * 1e-3 * SPEED**2
    for name, setting, run in runs():
        try:
            motions = [run()]
        except RuntimeError as error:
            print(f"| {name} | {setting} | {error} |")
            continue
        if motions[0].seconds < 5:
            motions += [run(), run()]
        motion, seconds = motions[0], min(motion.seconds for motion in motions)
        if not np.isfinite(motion.x).all() or abs(motion.x).max() > 1.0:
            print(f"| {name} | {setting} | unstable | | | | {seconds:.2f} |")
            continue
        error = distance(motion.x, references[motion.law].x)
        lines.setdefault(name, []).append((seconds, error))
        crossing = [x for x in motion.x if SURFACES.intersect(x)]
        deepest = max([0.0] + [SURFACES.depth(x) for x in crossing])
        print(
            f"| {name} | {setting} | {error:.2f} | {100 * (motion.energy[-1] - motion.energy[0]) / fallen:+.1f} % "
            f"| {1e3 * deepest:.3f} | {len(crossing)} | {seconds:.2f} |", flush=True,
        )
    chart.write(f"../charts/contact-{CASE}.svg", lines)


if __name__ == "__main__":
    main()
