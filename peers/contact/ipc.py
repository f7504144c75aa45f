"""pliant's contact of bodies beside the IPC toolkit: distances, energies, forces, intersections, laws.

    PLIANT=path/to/pliant python ipc.py [poses] [throws] [laws]    # prints the tables of ../contact.md
"""

import itertools
import sys

import ipctk
import numpy as np

from bodies import Run, Surfaces, body, grid, random_turn

SOFT = "{ density = 1000.0, young = 1.0e5, poisson = 0.3, viscosity = 0.0 }"
# shares of the corners of a facet in its quadrature points, and their weights
EDGE = [((1 - k / 4, k / 4), w / 12) for k, w in enumerate([1, 4, 2, 4, 1])]
TRIANGLE = (
    [(tuple(float(i == k) for i in range(3)), 1 / 20) for k in range(3)]
    + [(tuple(0.5 * (i != k) for i in range(3)), 2 / 15) for k in range(3)]
    + [((1 / 3,) * 3, 9 / 20)]
)


def features(facets):
    """Facets, edges and corners of a closed surface, and their weights by inclusion and exclusion."""
    weights = dict.fromkeys(map(tuple, facets), 1)
    sides = [frozenset(s) for facet in facets for s in itertools.combinations(facet, 2)] if len(facets[0]) == 3 else []
    weights |= {tuple(side): -1 for side in sides}
    sign = 1 if sides else -1
    return weights | {(node,): sign for node in np.unique(facets)}


MEASURES = {
    1: (lambda p, a: ((p - a) ** 2).sum(), lambda p, a: 2 * np.concatenate([p - a, a - p])),
    2: (ipctk.point_edge_distance, ipctk.point_edge_distance_gradient),
    3: (ipctk.point_triangle_distance, ipctk.point_triangle_distance_gradient),
}


def crossing(x, area, lengths, k, D):
    """The energy (J) of two edges with the ends `x`, two of each, the product of whose undeformed lengths is `lengths`."""
    a, b, w = x[1] - x[0], x[3] - x[2], x[2] - x[0]
    n = np.cross(a, b)
    xi, eta, d = np.cross(w, b) @ n / (n @ n), np.cross(w, a) @ n / (n @ n), np.sqrt((w @ n) ** 2 / (n @ n))
    if not (0 < xi.real < 1 and 0 < eta.real < 1 and d.real < D / 2):
        return 0.0
    ramp = lambda t: t * t * (3 - 2 * t) if t.real < 1 else 1.0
    window = ramp(4 * min(xi, 1 - xi, key=np.real)) * ramp(4 * min(eta, 1 - eta, key=np.real))
    return area * ramp(n @ n / (D * D * lengths)) * window * 2 * k * (D / 2 - d) ** 3 / (3 * d)


def edges(mesh, start):
    """Edges of an undeformed surface by their nodes, numbered from `start` on, with a third of the facets beside each (m^2)."""
    areas = {}
    for facet in mesh.facets:
        a, b, c = mesh.nodes[facet]
        for side in itertools.combinations(sorted(facet + start), 2):
            areas[side] = areas.get(side, 0.0) + np.linalg.norm(np.cross(b - a, c - a)) / 6
    return areas.items()


def contact(meshes, k, D, thickness):
    """pliant's energy (J), forces (N) on all nodes and least distance of points (m) of two meshes, with the toolkit's distances
    and gradients; edges that cross edges by `crossing`, and by complex steps."""
    starts = [0, len(meshes[0].nodes)]
    x = np.concatenate([mesh.nodes for mesh in meshes])
    energy, force, least = 0.0, np.zeros_like(x), np.inf
    for a, b in [(0, 1), (1, 0)]:
        others = features([tuple(facet + starts[b]) for facet in meshes[b].facets])
        for facet in meshes[a].facets + starts[a]:
            corners = x[facet]
            area = thickness * np.linalg.norm(corners[1] - corners[0])
            if len(facet) == 3:
                area = 0.5 * np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
            for shares, weight in TRIANGLE if len(facet) == 3 else EDGE:
                point = shares @ corners
                for feature, sign in others.items():
                    measure, gradient = MEASURES[len(feature)]
                    d = measure(point, *x[list(feature)]) ** 0.5
                    least = min(least, d)
                    if d >= D:
                        continue
                    of = 0.5 * weight * area * sign
                    energy += of * k * (D - d) ** 3 / (3 * d)
                    slope = -of * k * (D - d) ** 2 * (D + 2 * d) / (3 * d * d)
                    by = gradient(point, *x[list(feature)]).reshape(-1, x.shape[1]) * slope / (2 * d)
                    for node, share in zip(facet, shares):
                        force[node] -= share * by[0]
                    np.subtract.at(force, list(feature), by[1:])
    pairs = itertools.product(edges(meshes[0], 0), edges(meshes[1], starts[1])) if x.shape[1] == 3 else []
    for (a, of_a), (b, of_b) in pairs:
        nodes = [*a, *b]
        ends = x[nodes]
        of = 0.25 * np.sqrt(of_a * of_b), np.linalg.norm(ends[1] - ends[0]) * np.linalg.norm(ends[3] - ends[2]), k, D
        own = crossing(ends, *of)
        if own == 0.0:
            continue
        energy += own
        for node, axis in itertools.product(range(4), range(3)):
            moved = ends.astype(complex)
            moved[node, axis] += 1e-30j
            force[nodes[node], axis] -= crossing(moved, *of).imag / 1e-30
    return energy, force, least


def poses(count=100):
    print("| | poses | energy, off by | force on a node, off by | least distance, off by | surfaces nearer than points, mean | most |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for dimension in [2, 3]:
        random = np.random.default_rng(dimension)
        worst, nearer = np.zeros(3), []
        cell, D, k = 0.02, 0.03, 1e4
        while len(nearer) < count:
            base = grid([0.04] * dimension, [3] * dimension)
            way = random.normal(size=dimension)
            way *= random.uniform(0.045, 0.07) / np.linalg.norm(way)
            meshes = [base.moved(random_turn(random, dimension), w) for w in (0 * way, way)]
            surfaces = Surfaces(meshes)
            x = surfaces.nodes
            exact = surfaces.distance(x)
            if surfaces.intersect(x) or surfaces.depth(x) > 0 or not 0.02 * D < exact < 0.9 * D:
                continue
            energy, force, least = contact(meshes, k, D, 0.01)
            sensors = "".join(
                f'[[sensor]]\nname = "f{n}"\nkind = "contact-force"\ntouch = "touch"\nnodes = {n + 1}\n'
                for n in range(len(x))
            )
            scene = (
                body("a", meshes[0], SOFT) + body("b", meshes[1], SOFT)
                + f'[[touch]]\nname = "touch"\nbodies = ["a", "b"]\ndistance = {D}\nstiffness_density = {k}\n'
                + '[[phase]]\nuntil = 1e-9\n[[sensor]]\nname = "gap"\nkind = "gap"\ntouch = "touch"\n' + sensors
            )
            run = Run(scene)
            assert not run.failed, run.messages
            read = lambda name: run.columns[name][0]
            found = np.array([[read(f"f{n}.{axis}") for axis in "xyz"[:dimension]] for n in range(len(x))])
            off = [
                abs(read("contact") / energy - 1),
                np.abs(found - force).max() / np.abs(force).max(),
                abs(read("gap") - exact) / cell,
            ]
            worst = np.maximum(worst, off)
            nearer.append((least - exact) / cell)
        print(
            f"| {'squares in the plane' if dimension == 2 else 'cubes in space'} | {count} | {worst[0]:.0e} | {worst[1]:.0e} "
            f"| {worst[2]:.0e} of a cell | {100 * np.mean(nearer):.2f} % of a cell | {100 * max(nearer):.1f} % of a cell |"
        )


def throws(count=60):
    print("| | speed of each, at most (m/s) | throws | met | failed | states | that intersect | throws with one | deepest (of a cell) |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    shapes = {
        2: [([0.08, 0.01], [9, 2]), ([0.05, 0.04], [4, 4])],
        3: [([0.08, 0.01, 0.02], [9, 2, 3]), ([0.04, 0.04, 0.03], [4, 4, 3])],
    }
    for dimension, speed in itertools.product([2, 3], [0.3, 1.0, 3.0]):
        random = np.random.default_rng(int(10 * speed) + dimension)
        met = failed = states = bad = spoilt = 0
        deepest = 0.0
        number = count if dimension == 2 else count // 3
        for _ in range(number):
            meshes, velocities = [], []
            for side in (-1, 1):
                size, nodes = shapes[dimension][random.integers(2)]
                way = np.zeros(dimension)
                way[0] = side * 0.06
                way[1:] = random.uniform(-0.015, 0.015, dimension - 1)
                meshes.append(grid(size, nodes).moved(random_turn(random, dimension), way))
                velocities.append([-side * speed * random.uniform(0.3, 1.0)] + [0.0] * (dimension - 1))
            surfaces = Surfaces(meshes)
            if surfaces.distance(surfaces.nodes) < 1e-3 or surfaces.depth(surfaces.nodes) > 0:
                continue
            law = '{ density = 1000.0, young = 2.0e5, poisson = 0.3, viscosity = 0.0, law = { kind = "neo-hookean" } }'
            ends = 0.2 / speed
            scene = (
                "".join(body(n, m, law, f"velocity = {v}\n") for n, m, v in zip("ab", meshes, velocities))
                + '[[touch]]\nname = "touch"\ndistance = 5e-4\nfriction_coefficient = 0.3\nsticking_speed = 0.02\n'
                + f'[[phase]]\nuntil = {ends}\n[[sensor]]\nname = "gap"\nkind = "gap"\ntouch = "touch"\n'
                + f"[solver]\nrtol = 1e-3\n[output]\nstep = {ends / 40}\ntrack = {list(range(1, len(surfaces.nodes) + 1))}\n"
            )
            run = Run(scene)
            if run.failed:
                failed += 1
                continue
            met += run.columns["gap"].min() < 5e-4
            frames = run.positions(surfaces.nodes)
            crossing = [x for x in frames if surfaces.intersect(x)]
            states += len(frames)
            bad += len(crossing)
            spoilt += bool(crossing)
            deepest = max([deepest] + [surfaces.depth(x) for x in crossing])
        print(
            f"| {dimension} dimensions | {speed} | {number} | {met} | {failed} | {states} | {bad} | {spoilt} | {deepest / 0.01:.3f} |",
            flush=True,
        )


def laws():
    """The force between two parallel plates, which is the slope of the energy per area, over that at half of the distance D."""
    toolkit = {
        "clamped log": ipctk.ClampedLogBarrier(), "cubic": ipctk.CubicBarrier(), "two stages": ipctk.TwoStageBarrier()
    }
    D, at = 1e-3, [0.9, 0.75, 0.5, 0.25, 0.1, 0.03, 0.01]
    found = []
    for part in at:
        plates = [grid([0.2, 0.01], [21, 2]), grid([0.2, 0.01], [21, 2])]
        plates[1] = plates[1].moved(np.eye(2), [0.0, 0.01 + part * D])
        scene = (
            body("a", plates[0], SOFT) + body("b", plates[1], SOFT)
            + f'[[touch]]\nname = "touch"\nbodies = ["a", "b"]\ndistance = {D}\nstiffness_density = 1e7\n[[phase]]\nuntil = 1e-12\n'
            + '[[sensor]]\nname = "force"\nkind = "contact-force"\ntouch = "touch"\nbody = "b"\n'
        )
        # the corners of the sides, too, lie at that distance: a twelfth of each side acts there
        found.append(Run(scene).columns["force.y"][0] / (0.01 * (0.2 + 2 * 0.01 / 12)))
    closed = [1e7 * (D - p * D) ** 2 * (D + 2 * p * D) / (3 * (p * D) ** 2) for p in at]
    print(f"pressure of parallel plates by pliant and by its formula differ by {max(abs(np.divide(found, closed) - 1)):.1e} at most\n")
    print("| gap (of D) | " + " | ".join(f"{p:g}" for p in at) + " |\n| --- |" + " --- |" * len(at))
    rows = {"pliant": found}
    for name, barrier in toolkit.items():
        rows["IPC toolkit, " + name] = [-barrier.first_derivative(p * D, D) for p in at]
    for name, row in rows.items():
        print(f"| {name} | " + " | ".join(f"{value / row[at.index(0.5)]:.3g}" for value in row) + " |")


if __name__ == "__main__":
    for name in sys.argv[1:] or ["poses", "throws", "laws"]:
        {"poses": poses, "throws": throws, "laws": laws}[name]()
        print()
