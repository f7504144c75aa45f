"""dolfinx on a block of St. Venant-Kirchhoff material: generalized-alpha, one factor of MUMPS a step.

The residual and its tangents are compiled from UFL; Newton's iteration keeps the factor of the step's first
tangent. That tangent is symmetric: of the viscous force it takes the derivative by velocities alone. The spectral radius is 0.9, as that of
src/implicit.rs.
"""

import os
import sys
import time
from pathlib import Path

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem.petsc import (
    assemble_matrix,
    assemble_vector,
    create_matrix,
    create_vector,
    set_bc,
)
from mpi4py import MPI
from petsc4py import PETSc

RHO = 0.9
# Newton's iteration ends with a change (m) below this part of the block's length
TOLERANCE = 3e-6
COMPILER = {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"]}


class Block:
    """Forms and matrices. `numbers`: size, cells, density, gravity, the elastic and the viscous Lame pair."""

    def __init__(self, degree, size, cells, density, gravity, elastic, viscous):
        box = mesh.create_box(MPI.COMM_SELF, [np.zeros(3), np.array(size)], cells, mesh.CellType.tetrahedron)
        self.space = V = fem.VectorFunctionSpace(box, ("CG", degree))
        clamped = fem.locate_dofs_geometrical(V, lambda x: np.isclose(x[0], 0))
        self.bc = [fem.dirichletbc(np.zeros(3), clamped, V)]
        tip = np.array([size[0], size[1] / 2, size[2] / 2])
        self.tip = np.argmin(np.linalg.norm(V.tabulate_dof_coordinates() - tip, axis=1))
        self.u, self.v = fem.Function(V), fem.Function(V)
        test, trial = ufl.TestFunction(V), ufl.TrialFunction(V)
        # what integrates quadratic functions exactly, as pliant's own quadrature does
        dx = ufl.Measure("dx", metadata={"quadrature_degree": 2 * (degree - 1)})
        one = ufl.Identity(3)
        F = one + ufl.grad(self.u)
        E = (F.T * F - one) / 2
        rate = ufl.sym(F.T * ufl.grad(self.v))

        def stress(pair, strain):
            return pair[0] * ufl.tr(strain) * one + 2 * pair[1] * strain

        def force(stress):
            return ufl.inner(F * stress, ufl.grad(test)) * dx

        elasticity = force(stress(elastic, E))
        self.is_viscous = viscous[1] > 0
        internal = elasticity + (force(stress(viscous, rate)) if self.is_viscous else 0)
        self.scales = [fem.Constant(box, 1.0), fem.Constant(box, 0.0)]
        tangent = self.scales[0] * ufl.derivative(elasticity, self.u, trial)
        if self.is_viscous:
            tangent += self.scales[1] * ufl.derivative(internal, self.v, trial)
        exact = ufl.Measure("dx")
        weight = fem.Constant(box, np.array([0.0, 0.0, -density * gravity]))

        def compiled(form):
            return fem.form(form, jit_params=COMPILER)

        self.internal, self.tangent = compiled(internal), compiled(tangent)
        self.mass = compiled(density * ufl.inner(trial, test) * exact)
        self.load = compiled(ufl.inner(weight, test) * exact)

    def unknowns(self):
        return 3 * self.space.dofmap.index_map.size_global


def factor(matrix):
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOperators(matrix)
    solver.setType("preonly")
    pc = solver.getPC()
    pc.setType("cholesky")
    pc.setFactorSolverType("mumps")
    return solver


def solve(block, end, steps, times):
    """Displacements of the tip at `times`, and how often forces were computed and matrices factorized."""
    h = end / steps
    am, af = (2 * RHO - 1) / (RHO + 1), RHO / (RHO + 1)
    gamma, beta = 0.5 - am + af, (1 - am + af) ** 2 / 4
    block.scales[0].value = 1 - af
    block.scales[1].value = (1 - af) * gamma / (beta * h)
    mass = assemble_matrix(block.mass, bcs=block.bc, diagonal=0.0)
    mass.assemble()
    load = assemble_vector(block.load)
    matrix, residual = create_matrix(block.tangent), create_vector(block.internal)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    newton = factor(matrix)

    first = assemble_matrix(block.mass, bcs=block.bc)
    first.assemble()
    set_bc(load, block.bc)
    a = load.duplicate()
    factor(first).solve(load, a)
    u, v = a.duplicate(), a.duplicate()
    u.zeroEntries()
    v.zeroEntries()
    change, inertia, mean = u.duplicate(), u.duplicate(), u.duplicate()
    evaluations, samples = 0, []
    at_tip = slice(3 * block.tip, 3 * block.tip + 3)
    scale = TOLERANCE * np.ptp(block.space.mesh.geometry.x[:, 0])
    for step in range(steps):
        u1, a1, v1 = u.copy(), a.copy(), v.copy()
        # the predictor of constant acceleration
        u1.axpy(h, v)
        u1.axpy(h * h / 2, a)
        v1.axpy(h, a)
        for iteration in range(20):
            for target, new, old in ((block.u, u1, u), (block.v, v1, v)):
                target.vector.zeroEntries()
                target.vector.axpy(1 - af, new)
                target.vector.axpy(af, old)
            mean.zeroEntries()
            mean.axpy(1 - am, a1)
            mean.axpy(am, a)
            mass.mult(mean, inertia)
            with residual.localForm() as local:
                local.set(0)
            assemble_vector(residual, block.internal)
            evaluations += 1
            residual.axpy(1, inertia)
            residual.axpy(-1, load)
            set_bc(residual, block.bc, scale=0)
            if iteration == 0:
                matrix.zeroEntries()
                assemble_matrix(matrix, block.tangent, bcs=block.bc)
                matrix.assemble()
                matrix.axpy((1 - am) / (beta * h * h), mass, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
                newton.setOperators(matrix)
            newton.solve(residual, change)
            u1.axpy(-1, change)
            v1.axpy(-gamma / (beta * h), change)
            a1.axpy(-1 / (beta * h * h), change)
            if change.norm(PETSc.NormType.NORM_INFINITY) < scale:
                break
        else:
            raise SystemExit("failed: Newton's iteration does not converge")
        ends = [x.array[at_tip].copy() for x in (u, v, u1, v1)]
        while len(samples) < len(times) and times[len(samples)] <= (step + 1) * h * (1 + 1e-12):
            samples.append(cubic((times[len(samples)] - step * h) / h, h, *ends))
        u, v, a = u1, v1, a1
    return np.array(samples), evaluations


def cubic(s, h, u0, v0, u1, v1):
    r = 1 - s
    return (1 + 2 * s) * r * r * u0 + s * s * (3 - 2 * s) * u1 + h * s * r * r * v0 - h * s * s * r * v1


def main():
    element, *numbers, out = sys.argv[1:]
    numbers = [float(number) for number in numbers]
    cells, steps = [int(number) for number in numbers[:3]], int(numbers[3])
    size, (end, density, gravity), pairs = numbers[4:7], numbers[7:10], numbers[10:14]
    block = Block(int(element[1]), size, cells, density, gravity, pairs[:2], pairs[2:])
    times = end * np.arange(1, 102) / 101
    clock = time.process_time()
    samples, evaluations = solve(block, end, steps, times)
    seconds = time.process_time() - clock
    Path(out).write_bytes(samples.tobytes())
    print(seconds, steps, evaluations, steps)


os.environ["OMP_NUM_THREADS"] = "1"
main()
