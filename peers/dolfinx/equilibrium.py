"""dolfinx on a clamped block of St. Venant-Kirchhoff material that sags under its weight: Newton's method, factors of MUMPS.

P2 has displacements alone; P2-P1 (Taylor and Hood) and P2-P0 have a pressure p = lambda tr E as well, continuous
and linear, or constant in each cell.
"""

import os
import sys
import time
from pathlib import Path

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem.petsc import assemble_matrix, assemble_vector, create_matrix, create_vector, set_bc
from mpi4py import MPI
from petsc4py import PETSc

# Newton's iteration ends with a change (m) below this part of the block's length
TOLERANCE = 1e-9
COMPILER = {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"]}
PRESSURES = {"P2-P1": ("CG", 1), "P2-P0": ("DG", 0)}


def block(size, cells):
    ends = [np.zeros(len(size)), np.array(size)]
    if len(size) == 2:
        return mesh.create_rectangle(MPI.COMM_SELF, ends, cells)
    return mesh.create_box(MPI.COMM_SELF, ends, cells, mesh.CellType.tetrahedron)


def at_clamp(x):
    return np.isclose(x[0], 0)


def energy(w, element, pair):
    lam, mu = pair
    u = ufl.split(w)[0] if element in PRESSURES else w
    dimension = u.ufl_shape[0]
    F = ufl.Identity(dimension) + ufl.grad(u)
    E = (F.T * F - ufl.Identity(dimension)) / 2
    shear = mu * ufl.inner(E, E)
    if element not in PRESSURES:
        return u, shear + lam / 2 * ufl.tr(E) ** 2
    p = ufl.split(w)[1]
    return u, shear + p * ufl.tr(E) - p**2 / (2 * lam)


def solve(element, size, cells, weight, pair):
    """Displacement of the middle of the free end, iterations, unknowns."""
    box = block(size, cells)
    dimension = len(size)
    quadratic = ufl.VectorElement("CG", box.ufl_cell(), 2)
    if element in PRESSURES:
        family, degree = PRESSURES[element]
        pressure = ufl.FiniteElement(family, box.ufl_cell(), degree)
        space = fem.FunctionSpace(box, ufl.MixedElement(quadratic, pressure))
        moves, displacements = space.sub(0).collapse()
        clamped = fem.locate_dofs_geometrical((space.sub(0), moves), at_clamp)
        bc = fem.dirichletbc(fem.Function(moves), clamped, space.sub(0))
    else:
        space = moves = fem.FunctionSpace(box, quadratic)
        displacements = slice(None)
        clamped = fem.locate_dofs_geometrical(space, at_clamp)
        bc = fem.dirichletbc(np.zeros(dimension), clamped, space)
    w = fem.Function(space)
    u, density = energy(w, element, pair)
    dx = ufl.Measure("dx", metadata={"quadrature_degree": 3 if element == "P2-P1" else 2})
    down = fem.Constant(box, np.array([0.0] * (dimension - 1) + [weight]))
    first = ufl.derivative((density + ufl.dot(down, u)) * dx, w)
    residual_form = fem.form(first, jit_params=COMPILER)
    tangent_form = fem.form(ufl.derivative(first, w), jit_params=COMPILER)

    matrix, residual = create_matrix(tangent_form), create_vector(residual_form)
    change = residual.duplicate()
    # an LDL^T factor, as tangents with pressures are not definite
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    solver = PETSc.KSP().create(box.comm)
    solver.setOperators(matrix)
    solver.setType("preonly")
    solver.getPC().setType("cholesky")
    solver.getPC().setFactorSolverType("mumps")
    for iteration in range(1, 40):
        with residual.localForm() as local:
            local.set(0)
        assemble_vector(residual, residual_form)
        set_bc(residual, [bc], scale=0)
        matrix.zeroEntries()
        assemble_matrix(matrix, tangent_form, bcs=[bc])
        matrix.assemble()
        solver.solve(residual, change)
        w.vector.axpy(-1, change)
        if np.abs(change.array[displacements]).max() < TOLERANCE * size[0]:
            break
    else:
        raise SystemExit("failed: Newton's iteration does not converge")
    places = moves.tabulate_dof_coordinates()
    tip = np.array([size[0], *(length / 2 for length in size[1:]), 0][:3])
    node = np.argmin(np.linalg.norm(places - tip, axis=1))
    values = w.x.array[displacements]
    unknowns = space.dofmap.index_map.size_global * space.dofmap.index_map_bs
    return values[dimension * node : dimension * (node + 1)], iteration, unknowns


def main():
    element, *numbers, out = sys.argv[1:]
    numbers = [float(number) for number in numbers]
    dimension = int(numbers[0])
    cells = [int(number) for number in numbers[1 : 1 + dimension]]
    size, rest = numbers[1 + dimension : 1 + 2 * dimension], numbers[1 + 2 * dimension :]
    weight, pair = rest[0], rest[1:3]
    # compiles what is not in the cache yet
    solve(element, size, [2] * dimension, weight, pair)
    clock = time.process_time()
    tip, iterations, unknowns = solve(element, size, cells, weight, pair)
    seconds = time.process_time() - clock
    Path(out).write_bytes(tip.tobytes())
    print(seconds, unknowns, iterations, iterations)


os.environ["OMP_NUM_THREADS"] = "1"
main()
