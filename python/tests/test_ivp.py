"""solve_ivp against closed forms, published values and SciPy."""

import numpy as np
import pytest

import pliant

IMPLICIT = ["bdf", "adams", "rosenbrock", "esdirk", "BDF", "LSODA", "Radau"]
EXPLICIT = ["dormand-prince", "RK45", "RK23", "DOP853"]


@pytest.mark.parametrize("method", IMPLICIT + EXPLICIT)
def test_an_oscillator(method):
    """After one period it is back: within 200 rtol by every method (measured: 0.4 to 90)."""
    solution = pliant.solve_ivp(lambda t, y: [y[1], -y[0]], (0.0, 2 * np.pi), [1.0, 0.0], method, rtol=1e-6, atol=1e-6)
    assert solution.success and np.abs(solution.y[:, -1] - [1.0, 0.0]).max() < 200e-6


def test_van_der_pol():
    """The end that the README of pliant states."""
    fun = lambda t, y: [y[1], 1e3 * (1.0 - y[0] ** 2) * y[1] - y[0]]
    jac = lambda t, y: np.array([[0.0, 1.0], [-2e3 * y[0] * y[1] - 1.0, 1e3 * (1.0 - y[0] ** 2)]])
    for options in ({}, {"jac": jac}):
        solution = pliant.solve_ivp(fun, (0.0, 2000.0), [2.0, 0.0], "bdf", rtol=1e-8, atol=1e-8, **options)
        assert abs(solution.y[0, -1] - 1.706167732170465) < 1e-4


def heat(n):
    import scipy.sparse

    ones = np.ones(n)
    return scipy.sparse.diags([ones[1:], -2 * ones, ones[1:]], [-1, 0, 1], format="csc") * (n + 1.0) ** 2


@pytest.mark.parametrize("kind", ["dense", "function", "sparse", "sparse function", "pattern", "band", "differences"])
def test_jacobians(kind):
    pytest.importorskip("scipy")
    n = 40
    matrix = heat(n)
    x = np.arange(1, n + 1) / (n + 1)
    options = {
        "dense": dict(jac=matrix.toarray()),
        "function": dict(jac=lambda t, y: matrix.toarray()),
        "sparse": dict(jac=matrix),
        "sparse function": dict(jac=lambda t, y: matrix),
        "pattern": dict(jac_sparsity=matrix),
        "band": dict(lband=1, uband=1),
        "differences": {},
    }[kind]
    solution = pliant.solve_ivp(lambda t, y: matrix @ y, (0.0, 0.1), np.sin(np.pi * x), "bdf", rtol=1e-7, atol=1e-10, **options)
    rate = -4.0 * (n + 1) ** 2 * np.sin(np.pi / (2 * (n + 1))) ** 2
    assert np.abs(solution.y[:, -1] - np.exp(0.1 * rate) * np.sin(np.pi * x)).max() < 1e-6


def test_a_pattern_that_grows_is_told():
    scipy = pytest.importorskip("scipy.sparse")

    def jac(t, y):
        return scipy.csc_matrix([[-1.0, t > 0.1], [0.0, -1.0]])

    with pytest.raises(ValueError, match="jac_sparsity"):
        pliant.solve_ivp(lambda t, y: [-y[0] + (t > 0.1) * y[1], -y[1]], (0.0, 10.0), [1.0, 1.0], "bdf", jac=jac, rtol=1e-8)


def test_events():
    """A ball thrown up at 10 m/s under 10 m/s^2: on top after 1 s, back after 2 s."""
    fun = lambda t, y: [y[1], -10.0]
    floor = lambda t, y: y[0]
    floor.terminal, floor.direction = True, -1
    top = lambda t, y: y[1]
    solution = pliant.solve_ivp(fun, (0.0, 5.0), [0.0, 10.0], events=[floor, top], rtol=1e-8, atol=1e-10)
    assert solution.status == 1 and abs(solution.t[-1] - 2.0) < 1e-7
    assert np.allclose(solution.t_events[1], 1.0, atol=1e-7) and np.allclose(solution.y_events[1][0][0], 5.0)


def test_events_at_the_edge_of_what_is_defined():
    """An emptying tank, y = (1 - t/2)^2; and a logarithm, which is -4 at exp(-4). Behind both there are no numbers."""
    empty = lambda t, y: y[0]
    low = lambda t, y: np.log(y[0]) + 4
    empty.terminal = low.terminal = True
    with np.errstate(invalid="ignore", divide="ignore"):
        for method in IMPLICIT + EXPLICIT:
            if method not in ("RK23", "DOP853"):
                tank = pliant.solve_ivp(lambda t, y: -np.sqrt(y), (0, 5), [1.0], method, events=empty, rtol=1e-6, atol=1e-8)
                assert tank.status == 1 and abs(tank.t[-1] - 2.0) < 2e-2, (method, tank.message)
            falling = pliant.solve_ivp(lambda t, y: [-1.0], (0, 5), [1.0], method, events=low)
            assert falling.status == 1 and abs(falling.t[-1] - 1 + np.exp(-4)) < 1e-12, (method, falling.message)


def test_the_method_that_ran_is_told():
    """By the names of pliant and of ARKODE, also where there is nothing to integrate."""
    own = {"esdirk": "ESDIRK436L2SA_6_3_4", "Radau": "ESDIRK547L2SA_7_4_5", "BDF": "bdf", "LSODA": "bdf"}
    own |= {"RK45": "dormand-prince", "RK23": "BOGACKI_SHAMPINE_4_2_3", "DOP853": "VERNER_8_5_6"}
    for method in IMPLICIT + EXPLICIT:
        for end in (1.0, 0.0):
            assert pliant.solve_ivp(lambda t, y: -y, (0.0, end), [1.0], method).method == own.get(method, method)
    assert pliant.solve_dae(lambda t, y, yp: yp + y, (0.0, 1.0), [1.0], [-1.0]).method == "ida"


def test_between_the_times():
    solution = pliant.solve_ivp(lambda t, y: [y[1], -y[0]], (0.0, 6.0), [0.0, 1.0], rtol=1e-8, atol=1e-10, dense_output=True)
    t = np.linspace(0.0, 6.0, 101)
    assert np.abs(solution.sol(t)[0] - np.sin(t)).max() < 1e-6 and solution.sol(1.0).shape == (2,)
    at = pliant.solve_ivp(lambda t, y: [y[1], -y[0]], (0.0, 6.0), [0.0, 1.0], rtol=1e-8, atol=1e-10, t_eval=t)
    assert np.array_equal(at.t, t) and np.abs(at.y[0] - np.sin(t)).max() < 1e-6


def test_complex_numbers():
    solution = pliant.solve_ivp(lambda t, y: 1j * y, (0.0, 1.0), [1.0 + 0j], rtol=1e-8, atol=1e-10)
    assert abs(solution.y[0, -1] - np.exp(1j)) < 1e-6


def test_exceptions_pass_through():
    def fun(t, y):
        raise KeyError("mine")

    for method in ("bdf", "dormand-prince", "esdirk"):
        with pytest.raises(KeyError, match="mine"):
            pliant.solve_ivp(fun, (0.0, 1.0), [1.0], method)
    with pytest.raises(ValueError, match="2 numbers where 1"):
        pliant.solve_ivp(lambda t, y: [1.0, 2.0], (0.0, 1.0), [1.0])
    with pytest.raises(ZeroDivisionError):
        pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], events=lambda t, y: 1 / 0)


def test_a_run_that_fails_has_status_minus_one():
    solution = pliant.solve_ivp(lambda t, y: y**2, (0.0, 2.0), [1.0], rtol=1e-6, atol=1e-9)
    assert solution.status == -1 and not solution.success and abs(solution.t[-1] - 1.0) < 1e-2
    limited = pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], "bdf", max_steps=3)
    assert limited.status == -1 and "max_steps" in limited.message


def test_compiled_functions():
    numba = pytest.importorskip("numba")
    from numba import types

    number, pointer = types.float64, types.CPointer(types.float64)

    @numba.cfunc(types.void(number, pointer, pointer, pointer))
    def decay(t, y, ydot, args):
        ydot[0] = -args[0] * y[0]

    solution = pliant.solve_ivp(decay, (0.0, 1.0), [1.0], args=(50.0,), rtol=1e-8, atol=1e-12)
    assert abs(solution.y[0, -1] - np.exp(-50.0)) < 1e-9
    half = pliant.solve_ivp(decay, (0.0, 1.0), [1.0], args=(50.0,), events=lambda t, y, rate: y[0] - 0.5, rtol=1e-8, atol=1e-12)
    assert abs(half.t_events[0][0] - np.log(2.0) / 50.0) < 1e-9
    with pytest.raises(ValueError, match="goes forward"):
        pliant.solve_ivp(decay, (1.0, 0.0), [1.0], args=(50.0,))

    @numba.cfunc(types.float64(number))
    def other(t):
        return t

    with pytest.raises(TypeError, match="signature"):
        pliant.solve_ivp(other, (0.0, 1.0), [1.0])
