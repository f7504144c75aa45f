"""`pliant.solve_ivp` beside the integrators that Python has: time against error.

    pip install scipy numba pydiffsol scikit-sundae    # the last two are left out if they are not there
    python python_ivp.py                               # prints the tables of python.md

HIRES (8 unknowns) and a Brusselator in one dimension (1,000 unknowns, a band), with right-hand sides in Python (NumPy) and
compiled (numba; pydiffsol compiles a language of its own, the time for which is not counted). Times are processor times, the
best of five; errors are those of the last state, weighted as by the tolerances: sqrt(mean((e / (atol + rtol |y|))^2)) at rtol = atol = 1e-6.
"""

import time

import numpy as np
from scipy.integrate import solve_ivp as by_scipy

import pliant

RTOL = ATOL = 1e-6


def hires(t, y):
    y0, y1, y2, y3, y4, y5, y6, y7 = y
    fast = 280.0 * y5 * y7
    return np.array([
        -1.71 * y0 + 0.43 * y1 + 8.32 * y2 + 0.0007,
        1.71 * y0 - 8.75 * y1,
        -10.03 * y2 + 0.43 * y3 + 0.035 * y4,
        8.32 * y1 + 1.71 * y2 - 1.12 * y3,
        -1.745 * y4 + 0.43 * y5 + 0.43 * y6,
        -fast + 0.69 * y3 + 1.71 * y4 - 0.43 * y5 + 0.69 * y6,
        fast - 1.81 * y6,
        -fast + 1.81 * y6,
    ])


POINTS = 500


def brusselator(t, y):
    """u' = 1 + u^2 v - 4 u + u_xx / 50, v' = 3 u - u^2 v + v_xx / 50, ends at (1, 3); unknowns in turns."""
    u, v = y[0::2], y[1::2]
    of = 0.02 * (POINTS + 1) ** 2
    slopes = np.empty_like(y)
    square = u * u * v
    slopes[0::2] = 1.0 + square - 4.0 * u - 2.0 * of * u
    slopes[1::2] = 3.0 * u - square - 2.0 * of * v
    slopes[2::2] += of * u[:-1]
    slopes[0:-2:2] += of * u[1:]
    slopes[3::2] += of * v[:-1]
    slopes[1:-2:2] += of * v[1:]
    slopes[0] += of
    slopes[-2] += of
    slopes[1] += 3.0 * of
    slopes[-1] += 3.0 * of
    return slopes


def compiled():
    """The same in numba: (for SciPy, for pliant)."""
    from numba import carray, cfunc, njit, types

    fast, dense = njit(brusselator), njit(hires)
    number, pointer = types.float64, types.CPointer(types.float64)
    signature = types.void(number, pointer, pointer, pointer)

    @cfunc(signature)
    def hires_c(t, y, ydot, args):
        carray(ydot, 8)[:] = dense(t, carray(y, 8))

    @cfunc(signature)
    def brusselator_c(t, y, ydot, args):
        carray(ydot, 1000)[:] = fast(t, carray(y, 1000))

    return {"HIRES": (dense, hires_c), "Brusselator": (fast, brusselator_c)}


def diffsl():
    """The same in the language of pydiffsol, with the places of our unknowns among its own: all u of the Brusselator, then all v."""
    of, last = 0.02 * (POINTS + 1) ** 2, POINTS - 1
    x = np.arange(1, POINTS + 1) / (POINTS + 1)
    first = ", ".join(f"{u:.17g}" for u in 1.0 + np.sin(2.0 * np.pi * x))
    ends = f"(0:1): 1, (1:{last}): 0, ({last}:{POINTS}): 1"
    diffusion = f"(0..{POINTS},0..{POINTS}): {-2 * of}, (0..{last},1..{POINTS}): {of}, (1..{POINTS},0..{last}): {of}"
    line = f"""
        D_ij {{ {diffusion} }}
        e_i {{ {ends} }}
        z_i {{ {first} }}
        u_i {{ (0:{POINTS}): p = z_i, ({POINTS}:{2 * POINTS}): q = 3 }}
        dp_i {{ D_ij * p_j }}
        dq_i {{ D_ij * q_j }}
        F_i {{ 1 + p_i * p_i * q_i - 4 * p_i + dp_i + {of} * e_i, 3 * p_i - p_i * p_i * q_i + dq_i + {3 * of} * e_i }}"""
    chain = """
        u_i { y0 = 1, y1 = 0, y2 = 0, y3 = 0, y4 = 0, y5 = 0, y6 = 0, y7 = 0.0057 }
        F_i { -1.71 * y0 + 0.43 * y1 + 8.32 * y2 + 0.0007,
              1.71 * y0 - 8.75 * y1,
              -10.03 * y2 + 0.43 * y3 + 0.035 * y4,
              8.32 * y1 + 1.71 * y2 - 1.12 * y3,
              -1.745 * y4 + 0.43 * y5 + 0.43 * y6,
              -280.0 * y5 * y7 + 0.69 * y3 + 1.71 * y4 - 0.43 * y5 + 0.69 * y6,
              280.0 * y5 * y7 - 1.81 * y6,
              -280.0 * y5 * y7 + 1.81 * y6 }"""
    in_turns = np.arange(2 * POINTS).reshape(2, POINTS).T.ravel()
    return {"HIRES": (chain, slice(None)), "Brusselator": (line, in_turns)}


def problems():
    x = np.arange(1, POINTS + 1) / (POINTS + 1)
    start = np.empty(2 * POINTS)
    start[0::2], start[1::2] = 1.0 + np.sin(2.0 * np.pi * x), 3.0
    first = np.zeros(8)
    first[0], first[7] = 1.0, 0.0057
    return {
        "HIRES": (hires, (0.0, 321.8122), first, {}),
        "Brusselator": (brusselator, (0.0, 10.0), start, dict(lband=2, uband=2)),
    }


def banded(options, scipys):
    """SciPy takes bands by LSODA alone, and a pattern elsewhere."""
    if not options or not scipys:
        return options
    import scipy.sparse

    size, half = 2 * POINTS, 2
    return dict(jac_sparsity=scipy.sparse.diags([np.ones(size - abs(k)) for k in range(-half, half + 1)], range(-half, half + 1)))


def timed(call):
    best, result = np.inf, None
    for _ in range(5):
        start = time.process_time()
        result = call()
        best = min(best, time.process_time() - start)
    return best, result


def row(who, call, reference):
    try:
        spent, end = timed(call)
    except Exception as error:
        return print(f"| {who} | | {type(error).__name__}: {error} |")
    off = np.sqrt(np.mean(((end - reference) / (ATOL + RTOL * np.abs(reference))) ** 2))
    print(f"| {who} | {1e3 * spent:.1f} | {off:.1f} |")


def main():
    fast = compiled()
    for name, (fun, span, y0, options) in problems().items():
        reference = pliant.solve_ivp(fast[name][1], span, y0, "bdf", rtol=1e-11, atol=1e-12, **options).y[:, -1]
        other = by_scipy(fast[name][0], span, y0, "Radau", rtol=1e-9, atol=1e-11, **banded(options, True)).y[:, -1]
        print(f"\n{name}: reference and SciPy's Radau at 1e-9 agree to {np.abs(reference - other).max():.1e}\n")
        print("| method | processor time (ms) | error (tolerances) |\n| --- | --- | --- |")
        for kind, functions in (("Python", (fun, fun)), ("compiled", fast[name])):
            for method in ("bdf", "esdirk", "rosenbrock"):
                solve = lambda: pliant.solve_ivp(functions[1], span, y0, method, rtol=RTOL, atol=ATOL, **options).y[:, -1]
                row(f"pliant {method}, {kind}", solve, reference)
            for method in ("BDF", "Radau", "LSODA"):
                more = options if method == "LSODA" else banded(options, True)
                solve = lambda: by_scipy(functions[0], span, y0, method, rtol=RTOL, atol=ATOL, **more).y[:, -1]
                row(f"SciPy {method}, {kind}", solve, reference)
            try:
                import sksundae
            except ImportError:
                continue

            def slopes(t, y, yp):
                yp[:] = functions[0](t, y)

            bands = dict(linsolver="band", lband=2, uband=2) if options else {}
            solver = sksundae.cvode.CVODE(slopes, rtol=RTOL, atol=ATOL, method="BDF", **bands)
            row(f"scikit-SUNDAE BDF, {kind}", lambda: solver.solve(np.array(span), y0).y[-1], reference)
        by_diffsol(name, span[1], reference)


def by_diffsol(name, end, reference):
    try:
        import pydiffsol
    except ImportError:
        return
    code, order = diffsl()[name]
    matrix = pydiffsol.faer_sparse if name == "Brusselator" else pydiffsol.faer_dense
    for method in ("bdf", "esdirk34", "tr_bdf2"):
        ode = pydiffsol.Ode(code, matrix_type=matrix, ode_solver=getattr(pydiffsol, method))
        ode.rtol, ode.atol = RTOL, ATOL
        row(f"pydiffsol {method}, its language", lambda: ode.solve(np.array([]), end).ys[:, -1][order], reference)


if __name__ == "__main__":
    main()
