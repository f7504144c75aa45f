"""SciPy's solve_ivp on systems of equations: right-hand sides and Jacobians of pliant, compiled, called through ctypes."""

import ctypes as c
import sys
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csc_matrix

DOUBLES = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
INTEGERS = np.ctypeslib.ndpointer(dtype=np.int64, flags="C_CONTIGUOUS")


class System:
    """A system of equations: see src/system_ffi.rs."""

    def __init__(self, library, name):
        self.lib = lib = c.CDLL(library)
        handle, size, double = c.c_void_p, c.c_size_t, c.c_double
        signatures = {
            "open": (handle, [c.c_char_p]),
            "size": (size, [handle]),
            "end": (double, [handle]),
            "half_band": (c.c_int64, [handle]),
            "start": (None, [handle, DOUBLES]),
            "rhs": (c.c_int, [handle, double, DOUBLES, DOUBLES]),
            "entries": (size, [handle]),
            "pattern": (c.c_int, [handle, INTEGERS, INTEGERS]),
            "jacobian": (c.c_int, [handle, double, DOUBLES, DOUBLES]),
        }
        for name_, (result, arguments) in signatures.items():
            function = getattr(lib, "peers_system_" + name_)
            function.restype, function.argtypes = result, arguments
        self.handle = handle = lib.peers_system_open(name.encode())
        if not handle:
            raise SystemExit(f"failed: no system {name}")
        self.n, self.end = lib.peers_system_size(handle), lib.peers_system_end(handle)
        self.half_band = lib.peers_system_half_band(handle)
        self.start = np.empty(self.n)
        lib.peers_system_start(handle, self.start)
        self.values = np.empty(lib.peers_system_entries(handle))
        columns = np.empty(self.n + 1, dtype=np.int64)
        rows = np.empty(len(self.values), dtype=np.int64)
        self.is_sparse = lib.peers_system_pattern(handle, columns, rows) == 0
        self.columns, self.rows = columns.astype(np.int32), rows.astype(np.int32)

    def rhs(self, t, y):
        f = np.empty(self.n)
        if self.lib.peers_system_rhs(self.handle, t, np.ascontiguousarray(y), f):
            f[:] = np.nan
        return f

    def jacobian(self, t, y):
        self.lib.peers_system_jacobian(self.handle, t, np.ascontiguousarray(y), self.values)
        if self.is_sparse:
            return csc_matrix((self.values.copy(), self.rows, self.columns), shape=(self.n, self.n))
        return self.values.reshape(self.n, self.n).T.copy()


def solve(system, method, rtol, atol):
    options = {"jac": system.jacobian}
    if method == "LSODA" and system.half_band >= 0:
        # it knows no sparse matrices: difference quotients of a band
        options = {"lband": system.half_band, "uband": system.half_band}
    return solve_ivp(
        system.rhs,
        (0.0, system.end),
        system.start,
        method=method,
        t_eval=[system.end],
        rtol=rtol,
        atol=atol,
        **options,
    )


def main():
    library, name, method, rtol, atol, out = sys.argv[1:]
    system, atol, seconds = System(library, name), np.fromfile(atol), []
    # as src/motion.rs says
    while len(seconds) < 5 and sum(seconds) < 0.6:
        clock = time.process_time()
        solution = solve(system, method, float(rtol), atol)
        seconds.append(time.process_time() - clock)
        if not solution.success:
            raise SystemExit(f"failed: {solution.message}")
    Path(out).write_bytes(np.ascontiguousarray(solution.y[:, -1]).tobytes())
    print(min(seconds), -1, solution.nfev, solution.nlu)


main()
