"""SciPy's solve_ivp on the equations of pliant.

solve_ivp knows no mass matrix: with a consistent one, the Jacobian of y' = (v, M^-1 f) is dense.
So that its implicit methods need not suffer from that, they are given M here, in a class of a few
lines: the matrix of Newton's iteration becomes (M - c df/dy), sparse, and right-hand sides are
multiplied by M. Forces, tangents and M^-1 are those of pliant, compiled, called through ctypes.
"""

import ctypes as c
import sys
import time
from pathlib import Path

import numpy as np
from scipy.integrate import BDF, DOP853, Radau, solve_ivp
from scipy.sparse import bmat, csc_matrix, identity
from scipy.sparse.linalg import splu

DOUBLES = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
SIZES = np.ctypeslib.ndpointer(dtype=np.uint64, flags="C_CONTIGUOUS")


class Case:
    """A case and its present phase: see src/ffi.rs."""

    def __init__(self, library, name, is_lumped):
        self.lib = lib = c.CDLL(library)
        handle, size, double = c.c_void_p, c.c_size_t, c.c_double
        signatures = {
            "open": (handle, [c.c_char_p, c.c_int]),
            "tolerances": (None, [handle, double, DOUBLES]),
            "dofs": (size, [handle]),
            "phases": (size, [handle]),
            "end": (double, [handle, size]),
            "begin": (c.c_int, [handle, size, DOUBLES, DOUBLES]),
            "size": (size, [handle]),
            "free": (None, [handle, SIZES]),
            "entries": (size, [handle, c.c_int]),
            "pattern": (None, [handle, c.c_int, SIZES, SIZES]),
            "masses": (None, [handle, DOUBLES]),
            "acceleration": (c.c_int, [handle, double, DOUBLES, DOUBLES, DOUBLES]),
            "tangents": (None, [handle, double, DOUBLES, DOUBLES, DOUBLES, DOUBLES]),
            "complete": (None, [handle, double, DOUBLES, DOUBLES, DOUBLES, DOUBLES]),
            "close": (None, [handle]),
        }
        for name_, (result, arguments) in signatures.items():
            function = getattr(lib, "peers_" + name_)
            function.restype, function.argtypes = result, arguments
        self.handle = lib.peers_open(name.encode(), int(is_lumped))
        if not self.handle:
            raise SystemExit(f"failed: no case {name}")
        self.dofs = lib.peers_dofs(self.handle)

    def begin(self, phase, u, v):
        if self.lib.peers_begin(self.handle, phase, u, v):
            raise SystemExit("failed: the phase does not begin")
        self.n = self.lib.peers_size(self.handle)
        self.free = np.empty(self.n, dtype=np.uint64)
        self.lib.peers_free(self.handle, self.free)
        rows, columns, count = self.pattern(0)
        masses = np.empty(count)
        self.lib.peers_masses(self.handle, masses)
        self.mass = csc_matrix((masses, rows, columns), shape=(self.n, self.n))
        self.rows, self.columns, count = self.pattern(1)
        self.tangents = np.empty(count), np.empty(count)

    def pattern(self, which):
        count = self.lib.peers_entries(self.handle, which)
        columns, rows = np.empty(self.n + 1, dtype=np.uint64), np.empty(count, dtype=np.uint64)
        self.lib.peers_pattern(self.handle, which, columns, rows)
        return rows.astype(np.int32), columns.astype(np.int32), count

    def rhs(self, t, y):
        n, rates = self.n, np.empty_like(y)
        rates[:n] = y[n:]
        if self.lib.peers_acceleration(self.handle, t, y[:n].copy(), y[n:].copy(), rates[n:]):
            rates[n:] = np.nan
        return rates

    def jacobian(self, t, y):
        """diag(1, M) times the Jacobian of rhs."""
        n, (stiffness, damping) = self.n, self.tangents
        self.lib.peers_tangents(self.handle, t, y[:n].copy(), y[n:].copy(), stiffness, damping)
        k, d = (
            csc_matrix((-x, self.rows, self.columns), shape=(n, n)) for x in (stiffness, damping)
        )
        return bmat([[None, identity(n)], [k, d]], format="csc")

    def complete(self, t, y):
        u, v = np.empty(self.dofs), np.empty(self.dofs)
        n = self.n
        self.lib.peers_complete(self.handle, t, y[:n].copy(), y[n:].copy(), u, v)
        return u, v


def with_mass(method, mass):
    """`method` with the mass matrix in Newton's iteration."""

    class WithMass(method):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            self.I = mass

            def lu(matrix):
                self.nlu += 1
                return splu(matrix)

            self.lu = lu
            self.solve_lu = lambda factor, right: factor.solve(mass @ right)

    return WithMass


def solve(case, method, rtol, times):
    u, v = np.zeros(case.dofs), np.zeros(case.dofs)
    start, samples, counts = 0.0, [], np.zeros(3, dtype=int)
    atol = np.empty(2)
    case.lib.peers_tolerances(case.handle, rtol, atol)
    for phase in range(case.lib.peers_phases(case.handle)):
        case.begin(phase, u, v)
        end = case.lib.peers_end(case.handle, phase)
        own = times[(times > start) & (times <= end)]
        free = case.free.astype(int)
        options = {"rtol": rtol, "atol": np.repeat(atol, case.n)}
        if method is not DOP853:
            mass = bmat([[identity(case.n), None], [None, case.mass]], format="csc")
            options |= {"method": with_mass(method, mass), "jac": case.jacobian}
        else:
            options |= {"method": method}
        grid = own if own.size and own[-1] == end else np.append(own, end)
        solution = solve_ivp(
            case.rhs, (start, end), np.concatenate([u[free], v[free]]), t_eval=grid, **options
        )
        if not solution.success:
            raise SystemExit(f"failed: {solution.message}")
        samples += [case.complete(t, solution.y[:, k])[0] for k, t in enumerate(own)]
        u, v = case.complete(end, solution.y[:, -1])
        counts += [0, solution.nfev, solution.nlu]
        start = end
    return np.array(samples), counts


def main():
    library, name, inertia, method, setting, _, times, out = sys.argv[1:]
    methods = {"BDF": BDF, "Radau": Radau, "DOP853": DOP853}
    times = np.loadtxt(times)
    case = Case(library, name, inertia == "lumped")
    seconds = []
    # as src/motion.rs says
    while len(seconds) < 5 and sum(seconds) < 0.6:
        clock = time.process_time()
        samples, counts = solve(case, methods[method], float(setting), times)
        seconds.append(time.process_time() - clock)
    Path(out).write_bytes(samples.tobytes())
    print(min(seconds), -1, counts[1], counts[2])


main()
