"""Runs led step by step, Krylov methods, observers and ensembles against closed forms."""

import gc
import pickle
import threading
import time
import weakref

import numpy as np
import pytest

import pliant

TIGHT = dict(rtol=1e-8, atol=1e-10)


def decay(t, y, rate):
    return -rate * y


@pytest.mark.parametrize("method", ["bdf", "adams", "auto", "rosenbrock", "esdirk", "dormand-prince"])
def test_steps_reach_the_end_as_solve_ivp_does(method):
    """The same steps, to the last bit; and their states are those of exp(-2 t), within 10 rtol (measured: at most 6)."""
    run = pliant.Run(decay, (0.0, 3.0), [1.0], method, args=(2.0,), **TIGHT)
    times, states = [0.0], [1.0]
    while (step := run.advance()) is not None:
        assert step.t_old == times[-1] and step.before is None and step.events == []
        middle = 0.5 * (step.t_old + step.t)
        assert abs(run.interpolate(middle)[0] - np.exp(-2.0 * middle)) < 1e-7
        times.append(step.t)
        states.append(step.y[0])
    assert run.end == "span" and run.t == 3.0 and run.nsteps == len(times) - 1 and run.nfev >= run.nsteps
    solution = pliant.solve_ivp(decay, (0.0, 3.0), [1.0], method, args=(2.0,), **TIGHT)
    assert np.array_equal(solution.t, times) and np.array_equal(solution.y[0], states)
    assert np.abs(np.array(states) - np.exp(-2.0 * np.array(times))).max() < 1e-7


def test_a_change_of_parameters_and_the_way_back():
    """y' = -p y, from t = 0.5 on with p = 3 in place of 2; and again with 2. Measured: 1.3e-8 and 4e-9."""
    run = pliant.Run(decay, (0.0, 2.0), [1.0], "bdf", args=(2.0,), **TIGHT)
    run.advance_to(0.5)
    assert run.t == 0.5 and abs(run.y[0] - np.exp(-1.0)) < 5e-8
    saved = run.save()
    for rate in (3.0, 2.0):
        run.restore(saved)

        def change(jump):
            assert jump.t == 0.5
            jump.p[0] = rate

        run.jump(change)
        assert run.parameters.tolist() == [rate]
        run.advance_to(1.0)
        assert abs(run.y[0] - np.exp(-1.0 - 0.5 * rate)) < 2e-8
    with pytest.raises(pliant.InputError, match="has reached 1.0"):
        run.advance_to(0.7)
    run.jump(lambda jump: jump.end())
    assert run.end == "break" and run.advance() is None
    with pytest.raises(pliant.InputError, match="restore an earlier state"):
        run.jump(change)


def test_events_integrals_and_sensitivities_of_a_run():
    """A ball falls from 5 m at 10 m/s^2, and is thrown back after 1 s at half of its speed; dv/dp = 10 m/s there. Measured: 7e-9."""

    def impact(jump):
        jump.y[1] *= -jump.p[0]

    floor = pliant.Event(lambda t, y, part: y[0], direction=-1, action=impact)
    fall = lambda t, y, part: [y[1], -10.0]
    options = dict(args=(0.5,), events=floor, sensitivities=True, integrands=lambda t, y, part: abs(y[1]), **TIGHT)
    run = pliant.Run(fall, (0.0, 1.75), [5.0, 0.0], "bdf", **options)
    met = run.advance_to(1.5)
    assert [event.event for event in met] == [0] and abs(met[0].t - 1.0) < 1e-9 and abs(met[0].y[1] + 10.0) < 1e-8
    while (step := run.advance()) is not None:
        pass
    assert abs(run.y[0] - 0.9375) < 3e-8 and abs(run.sensitivities[0, 0] - 7.5) < 1e-9
    assert abs(run.integrals[0] - 6.5625) < 3e-8
    stepped = pliant.Run(fall, (0.0, 1.75), [5.0, 0.0], "bdf", **options)
    jumps = [step for step in iter(stepped.advance, None) if step.before is not None]
    assert len(jumps) == 1 and abs(jumps[0].before[1] + 10.0) < 1e-8 and abs(jumps[0].y[1] - 5.0) < 1e-8


def test_a_run_goes_on_from_a_file(tmp_path):
    """The ball above, whose run is saved to a file after the impact: another run that reads it has the same numbers, and ends alike to the last
    bit, with the event counted."""

    def impact(jump):
        jump.y[1] *= -jump.p[0]
        jump.p[0] *= 0.9

    floor = pliant.Event(lambda t, y, part: y[0], direction=-1, action=impact, terminal=2)
    options = dict(args=(0.5,), events=floor, sensitivities=True, integrands=lambda t, y, part: abs(y[1]), **TIGHT)

    def ball():
        return pliant.Run(lambda t, y, part: [y[1], -10.0], (0.0, 9.0), [5.0, 0.0], "bdf", **options)

    file = tmp_path / "ball.run"
    first = ball()
    first.advance_to(1.25)
    file.write_bytes(pickle.dumps(first.save()))
    first.restore(first.save())
    later = ball()
    later.restore(pickle.loads(file.read_bytes()))
    for name in ("t", "y", "parameters", "sensitivities", "integrals"):
        assert np.array_equal(getattr(later, name), getattr(first, name)), name
    ends = []
    for run in (first, later):
        while run.advance() is not None:
            pass
        assert run.end == "event" and abs(run.t - 2.0) < 1e-8 and run.parameters.tolist() == [0.5 * 0.9 * 0.9]
        ends.append((run.t, *run.y, *run.sensitivities.ravel(), *run.integrals))
    assert ends[0] == ends[1]
    with pytest.raises(ValueError, match="no saved run"):
        type(first.save())("{}")


def test_runs_of_residuals_of_complex_numbers_and_back_in_time():
    """y1' = -y2 with y1 = y2; y' = i y; and y' = -2 y back from t = 1, by a method that goes forward alone. Measured: at most 7e-9."""
    run = pliant.Run.dae(lambda t, y, yp: [yp[0] + y[1], y[0] - y[1]], (0.0, 1.0), [1.0, 0.0], differential=[True, False], **TIGHT)
    run.advance_to(1.0)
    assert np.abs(run.y - np.exp(-1.0)).max() < 3e-8 and abs(run.yp[0] + np.exp(-1.0)) < 3e-8
    turning = pliant.Run(lambda t, y: 1j * y, (0.0, 1.0), [1.0 + 0j], **TIGHT)
    turning.advance_to(1.0)
    assert abs(turning.y[0] - np.exp(1j)) < 3e-9
    back = pliant.Run(decay, (1.0, 0.0), [np.exp(-2.0)], "rosenbrock", args=(2.0,), **TIGHT)
    back.advance_to(0.5)
    assert back.t == 0.5 and abs(back.y[0] - np.exp(-1.0)) < 3e-9
    assert abs(back.interpolate(0.5)[0] - back.y[0]) < 1e-15
    assert back.advance().t < 0.5


def test_what_a_run_refuses():
    with pytest.raises(pliant.InputError, match="end of the span"):
        pliant.Run(decay, (1.0, 1.0), [1.0], args=(1.0,))
    with pytest.raises(TypeError, match="t_eval"):
        pliant.Run(decay, (0.0, 1.0), [1.0], args=(1.0,), t_eval=[0.5])
    short = pliant.Run(decay, (0.0, 1.0), [1.0], "bdf", args=(1.0,), max_steps=3)
    with pytest.raises(pliant.Error, match="max_steps"):
        short.advance_to(1.0)

    def inward(t, y):
        run.advance()

    run = pliant.Run(lambda t, y: -y if t == 0.0 else inward(t, y), (0.0, 1.0), [1.0], "bdf")
    with pytest.raises(RuntimeError, match="at work"):
        run.advance()
    other = pliant.Run(decay, (0.0, 1.0), [1.0, 1.0], args=(1.0,))
    with pytest.raises(pliant.InputError, match="saved run"):
        other.restore(run.save())
    with pytest.raises(KeyError, match="mine"):
        pliant.Run(lambda t, y: {}["mine"], (0.0, 1.0), [1.0], "dormand-prince").advance()


def test_a_warning_names_the_line_of_the_caller():
    for call in (
        lambda: pliant.Run(decay, (0.0, 1.0), [1.0], args=(1.0,), rtol=1e-20),
        lambda: pliant.solve_ivp(decay, (0.0, 1.0), [1.0], args=(1.0,), rtol=1e-20, max_steps=1),
        lambda: pliant.gradient(decay, (0.0, 0.1), [1.0], (1.0,), terminal=lambda t, y, rate: y[0], rtol=1e-20),
    ):
        with pytest.warns(UserWarning, match="`rtol` is too small") as warned:
            call()
        assert warned[0].filename == __file__


def test_a_run_that_its_own_functions_lead_to_is_collected():
    class Plant:
        def __init__(self):
            floor = pliant.Event(lambda t, y: self.level(y), action=self.impact)
            self.run = pliant.Run(self.fun, (0.0, 1.0), [1.0], "bdf", events=floor, observed_by=self.observe, jac=self.jac)

        def level(self, y):
            return y[0] - 0.5

        def impact(self, jump):
            jump.y[0] = 1.0

        def observe(self, progress):
            self.seen = progress.t

        def fun(self, t, y):
            return -y

        def jac(self, t, y):
            return [[-1.0]]

    plant = Plant()
    plant.run.advance_to(0.9)
    assert plant.seen == 0.9 and abs(plant.run.y[0] - 2.0 * np.exp(-0.9)) < 5e-3
    seen = weakref.ref(plant)
    del plant
    gc.collect()
    assert seen() is None


def heat(n):
    """The matrix of heat conduction along n points between cold ends, its first shape, and the rate at which that decays."""
    scipy = pytest.importorskip("scipy.sparse")
    ones = np.ones(n)
    matrix = scipy.diags([ones[1:], -2 * ones, ones[1:]], [-1, 0, 1], format="csc") * (n + 1.0) ** 2
    rate = 4.0 * (n + 1) ** 2 * np.sin(np.pi / (2 * (n + 1))) ** 2
    return matrix, np.sin(np.pi * np.arange(1, n + 1) / (n + 1)), rate


KRYLOV = {
    "name": "gmres",
    "gmres": pliant.Krylov("gmres", iterations=20, restarts=2, tolerance_factor=0.01),
    "bicgstab": pliant.Krylov("bicgstab", iterations=20),
    "tfqmr": pliant.Krylov("tfqmr", iterations=20),
    "cg": pliant.Krylov("cg", iterations=20),
    "fgmres": pliant.Krylov("fgmres", iterations=20, preconditioner="ilu", side="right"),
}


@pytest.mark.parametrize("kind", list(KRYLOV))
def test_krylov_methods(kind):
    """The decay of the first shape at its rate; within 10 rtol (measured: at most 4)."""
    matrix, shape, rate = heat(40)
    options = dict(lband=1, uband=1) if kind == "fgmres" else {}
    solution = pliant.solve_ivp(
        lambda t, y: matrix @ y, (0.0, 0.1), shape, "bdf", krylov=KRYLOV[kind], rtol=1e-7, atol=1e-10, **options
    )
    assert solution.success, solution.message
    assert np.abs(solution.y[:, -1] - np.exp(-0.1 * rate) * shape).max() < 1e-6


@pytest.mark.parametrize("span", [(0.0, 0.02), (0.02, 0.0)])
@pytest.mark.parametrize("method", ["bdf", "esdirk"])
def test_products_and_preconditioners(method, span):
    """Both are called with `args`, and save evaluations (measured: 45 for 127, 76 for 170); also where time goes back. The shape decays at
    its rate (measured: 2.4e-7)."""
    splu = pytest.importorskip("scipy.sparse.linalg").splu
    matrix, shape, rate = heat(40)
    matrix = matrix if span[0] < span[1] else -matrix
    called = dict(products=0, preconditioner=0)

    def products(t, y, v, factor):
        called["products"] += 1
        return factor * (matrix @ v)

    def preconditioner(t, y, gamma, factor):
        called["preconditioner"] += 1
        import scipy.sparse

        return splu((scipy.sparse.eye(40) - gamma * factor * matrix).tocsc()).solve

    krylov = pliant.Krylov("gmres", products=products, preconditioner=preconditioner)
    options = dict(args=(2.0,), rtol=1e-7, atol=1e-10)
    fun = lambda t, y, factor: factor * (matrix @ y)
    led = pliant.solve_ivp(fun, span, shape, method, krylov=krylov, **options)
    assert led.success and min(called.values()) > 0
    assert np.abs(led.y[:, -1] - np.exp(-0.04 * rate) * shape).max() < 1e-6
    alone = pliant.solve_ivp(fun, span, shape, method, krylov=pliant.Krylov("gmres", iterations=40), **options)
    assert 2 * led.nfev < alone.nfev, (led.nfev, alone.nfev)


def test_krylov_methods_of_residuals():
    """y1' = -1000 y1 + y2 with y2 = y1: a rate of 999; products, and a preconditioner that solves all. Measured: 3e-9."""

    def products(t, y, yp, v):
        return [1000.0 * v[0] - v[1], v[0] - v[1]], [v[0], 0.0]

    def preconditioner(t, y, yp, cj):
        matrix = np.array([[1000.0 + cj, -1.0], [1.0, -1.0]])
        return lambda r: np.linalg.solve(matrix, r)

    fun = lambda t, y, yp: [yp[0] + 1000.0 * y[0] - y[1], y[0] - y[1]]
    solution = pliant.solve_dae(
        fun, (0.0, 0.002), [1.0, 1.0], [-999.0, -999.0], krylov=pliant.Krylov(products=products, preconditioner=preconditioner), **TIGHT
    )
    assert solution.success and np.abs(solution.y[:, -1] - np.exp(-1.998)).max() < 1e-8


@pytest.mark.parametrize("form", ["ode", "ilu", "residual"])
def test_gradients_by_krylov_methods(form):
    """G = c y(T) of y' = p A y with a flow in A, which makes it differ from its transpose: dG/dp = c A T exp(p A T) y0 and
    dG/dy0 = exp(p A T)^T c, within 2 rtol of the weights (measured: at most 0.3)."""
    scipy = pytest.importorskip("scipy.sparse")
    expm = pytest.importorskip("scipy.linalg").expm
    n, p, end = 20, 2.0, 0.05
    matrix = (heat(n)[0] + scipy.diags([-np.ones(n - 1), np.ones(n)], [-1, 0]) * -60.0).tocsc()
    weights, y0 = np.linspace(1.0, 2.0, n), np.sin(np.arange(n))
    options = dict(terminal=lambda t, y, p: (weights @ y, weights, [0.0]), rtol=1e-8, atol=1e-10)
    if form == "residual":
        krylov = pliant.Krylov("gmres", iterations=20, transposed=lambda t, y, yp, v, w, p: w - p * (matrix.T @ v))
        options |= dict(method="ida", yp0=p * (matrix @ y0), differential=[True] * n)
        fun = lambda t, y, yp, p: yp - p * (matrix @ y)
    else:
        ilu = dict(preconditioner="ilu") if form == "ilu" else {}
        options |= dict(lband=1, uband=1) if form == "ilu" else {}
        krylov = pliant.Krylov("gmres", iterations=20, transposed=lambda t, y, v, p: p * (matrix.T @ v), **ilu)
        fun = lambda t, y, p: p * (matrix @ y)
    found = pliant.gradient(fun, (0.0, end), y0, (p,), krylov=krylov, **options)
    flow = expm(p * end * matrix.toarray())
    size = np.abs(weights).max()
    assert abs(found.value - weights @ flow @ y0) < 2e-8 * size
    assert abs(found.parameters[0] - weights @ (matrix.toarray() @ flow @ y0) * end) < 2e-8 * size
    assert np.abs(found.initial_state - flow.T @ weights).max() < 2e-8 * size


def test_what_krylov_methods_refuse():
    def solve(method="bdf", y0=(1.0,), **options):
        return pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), list(y0), method, **options)

    with pytest.raises(ValueError, match="\"gmres\", \"fgmres\""):
        solve(krylov="minres")
    with pytest.raises(ValueError, match="jac_sparsity"):
        solve(krylov=pliant.Krylov(preconditioner="ilu"))
    with pytest.raises(ValueError, match="between 1 and 1000"):
        solve(krylov=pliant.Krylov(iterations=0))
    with pytest.raises(ValueError, match="`products`"):
        solve(krylov="gmres", jac=[[-1.0]])
    with pytest.raises(ValueError, match="real unknowns"):
        solve(krylov="gmres", y0=(1j,))
    with pytest.raises(ValueError, match="\"left\" or \"right\""):
        solve(krylov=pliant.Krylov(side="up"))
    with pytest.raises(TypeError, match="pliant.Krylov"):
        solve(krylov=5)
    for method in ("dormand-prince", "rosenbrock"):
        with pytest.raises(ValueError, match="takes no Krylov method"):
            solve(method, krylov="gmres")
    with pytest.raises(ValueError, match="leave out `krylov`"):
        solve("esdirk", krylov="gmres", mass=[1.0])
    back = lambda krylov: pliant.gradient(lambda t, y, p: -p * y, (0.0, 1.0), [1.0], (1.0,), terminal=lambda t, y, p: y[0], krylov=krylov)
    with pytest.raises(ValueError, match="`transposed`"):
        back("gmres")
    with pytest.raises(ValueError, match="a function is not"):
        back(pliant.Krylov(transposed=lambda t, y, v, p: -p * v, preconditioner=lambda t, y, gamma, p: lambda r: r))
    with pytest.raises(pliant.Error, match="adjoint_rhs is wrong"):
        back(pliant.Krylov(transposed=lambda t, y, v, p: p * v))
    with pytest.raises(ZeroDivisionError):
        back(pliant.Krylov(transposed=lambda t, y, v, p: 1 / 0))
    with pytest.raises(ZeroDivisionError):
        solve(krylov=pliant.Krylov(products=lambda t, y, v: 1 / 0))
    with pytest.raises(ValueError, match="2 numbers where 1"):
        solve(krylov=pliant.Krylov(preconditioner=lambda t, y, gamma: lambda r: [1.0, 2.0]))


@pytest.mark.parametrize("method", ["bdf", "rosenbrock", "dormand-prince"])
def test_observers(method):
    """Called once after each step; the one that returns true ends the run there, also back in time."""
    seen = []
    solution = pliant.solve_ivp(decay, (0.0, 2.0), [1.0], method, args=(1.0,), observed_by=seen.append, **TIGHT)
    assert solution.success and [progress.t for progress in seen] == solution.t[1:].tolist()
    assert [progress.steps for progress in seen] == list(range(1, solution.nsteps + 1))
    assert [progress.y[0] for progress in seen] == solution.y[0, 1:].tolist() and seen[-1].part == 1.0
    half = lambda progress: abs(progress.y[0] - np.exp(-progress.t)) > 1e-6 or progress.y[0] > 0.5
    stopped = pliant.solve_ivp(decay, (2.0, 0.0), [np.exp(-2.0)], method, args=(1.0,), observed_by=half, **TIGHT)
    assert stopped.status == -1 and "cancelled" in stopped.message
    assert stopped.y[0, -1] > 0.5 >= stopped.y[0, -2] and abs(stopped.y[0, -1] - np.exp(-stopped.t[-1])) < 1e-6
    with pytest.raises(ZeroDivisionError):
        pliant.solve_ivp(decay, (0.0, 2.0), [1.0], method, args=(1.0,), observed_by=lambda progress: 1 / 0)


def test_ensembles():
    """exp(-3) for each rate over three times its decay time, in the order of the rates; one that raises is its exception. Measured: 4e-9."""
    rates = [0.5, 1.0, 2.0, 0.0, 4.0]
    results = pliant.ensemble(5, lambda k: pliant.solve_ivp(decay, (0.0, 3.0 / rates[k]), [1.0], "bdf", args=(rates[k],), **TIGHT))
    assert isinstance(results.pop(3), ZeroDivisionError)
    assert [solution.t[-1] for solution in results] == [6.0, 3.0, 1.5, 0.75]
    assert max(abs(solution.y[0, -1] - np.exp(-3.0)) for solution in results) < 1e-8


def test_compiled_functions_leave_python_to_others():
    """While one is integrated, another thread runs, without pauses of half the time that it takes (measured: 0.014; nearly
    all of it where the run keeps Python)."""
    numba = pytest.importorskip("numba")
    from numba import types

    number, pointer = types.float64, types.CPointer(types.float64)

    @numba.cfunc(types.void(number, pointer, pointer, pointer))
    def oscillator(t, y, ydot, args):
        ydot[0] = y[1]
        ydot[1] = -y[0]

    pauses, done = [0.0], threading.Event()

    def look():
        last = time.perf_counter()
        while not done.is_set():
            now = time.perf_counter()
            last, pauses[0] = now, max(pauses[0], now - last)

    thread = threading.Thread(target=look)
    thread.start()
    try:
        start, pauses[0] = time.perf_counter(), 0.0
        solution = pliant.solve_ivp(oscillator, (0.0, 1e3), [1.0, 0.0], rtol=1e-8, atol=1e-10)
        duration, longest = time.perf_counter() - start, pauses[0]
    finally:
        done.set()
        thread.join()
    assert solution.success and longest < 0.5 * duration
