"""solve_dae, mass matrices, sensitivities and gradients against closed forms, published digits and differences."""

import numpy as np
import pytest

import pliant

TIGHT = dict(rtol=1e-9, atol=1e-12)


def robertson(t, y, yp):
    slow, fast = 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
    return [yp[0] + 0.04 * y[0] - slow, yp[1] - 0.04 * y[0] + slow + fast, y[0] + y[1] + y[2] - 1.0]


def robertson_slopes(t, y, yp):
    by_y = [[0.04, -1e4 * y[2], -1e4 * y[1]], [-0.04, 1e4 * y[2] + 6e7 * y[1], 1e4 * y[1]], [1.0, 1.0, 1.0]]
    return np.array(by_y), np.diag([1.0, 1.0, 0.0])


#: At t = 4e10, computed in quadruple precision.
ROBERTSON_END = [5.20834517679924e-8, 2.08333817792549e-13, 0.999999947916340]


@pytest.mark.parametrize("kind", ["differences", "jac", "sparse jac"])
def test_robertson(kind):
    """Trusted digits, to some thousand times the tolerance (measured: 1,600 to 8,400)."""
    sparse = pytest.importorskip("scipy.sparse")
    jac = {
        "differences": None,
        "jac": robertson_slopes,
        "sparse jac": lambda *at: tuple(sparse.csc_matrix(part) for part in robertson_slopes(*at)),
    }[kind]
    solution = pliant.solve_dae(
        robertson, (0.0, 4e10), [1.0, 0.0, 0.0], differential=[True, True, False], rtol=1e-10, atol=[1e-14, 1e-18, 1e-14], jac=jac,
        jac_sparsity=np.ones((3, 3)) if kind == "sparse jac" else None,
    )
    assert solution.success
    assert np.abs(solution.y[:, -1] / ROBERTSON_END - 1.0).max() < 3e-6


def test_robertson_as_an_ode():
    def fun(t, y):
        slow, fast = 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
        return [-0.04 * y[0] + slow, 0.04 * y[0] - slow - fast, fast]

    options = dict(rtol=1e-8, atol=[1e-12, 1e-15, 1e-12], t_eval=[0.4, 4.0, 40.0, 400.0])
    ode = pliant.solve_ivp(fun, (0.0, 400.0), [1.0, 0.0, 0.0], "bdf", **options)
    dae = pliant.solve_dae(robertson, (0.0, 400.0), [1.0, 0.0, 0.0], differential=[True, True, False], **options)
    assert np.array_equal(dae.t, ode.t) and np.abs(dae.y / ode.y - 1.0).max() < 1e-6


def pendulum(t, y, yp, g=13.750371636040745654980191559621114395801712):
    """x, y, their velocities, and the tension, in the form of index 1: the second derivative of x^2 + y^2 = 1."""
    x, h, u, v, tension = y
    return [yp[0] - u, yp[1] - v, yp[2] + tension * x, yp[3] + tension * h + g, u * u + v * v - tension - g * h]


DIFFERENTIAL = [True] * 4 + [False]


def test_a_pendulum_is_back_after_its_period():
    """From the side at rest its period is 2 with this g; the tension at the start is found, and y' at the end told."""
    solution = pliant.solve_dae(pendulum, (0.0, 2.0), [1.0, 0.0, 0.0, 0.0, 7.0], differential=DIFFERENTIAL, dense_output=True, **TIGHT)
    assert abs(solution.y[4, 0]) < 1e-12
    assert np.abs(solution.y[:, -1] - [1.0, 0.0, 0.0, 0.0, 0.0]).max() < 1e-6
    assert np.abs(solution.last_yp[:4] - [0.0, 0.0, 0.0, -13.7503716360407]).max() < 1e-6
    t = np.linspace(0.0, 2.0, 41)
    x, h, u, v, tension = solution.sol(t)
    assert np.abs(u * u + v * v + 2 * 13.7503716360407 * h).max() < 5e-6
    given = pliant.solve_dae(pendulum, (0.0, 2.0), [1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -13.750371636040746, 0.0], **TIGHT)
    assert np.abs(given.y[:, -1] - solution.y[:, -1]).max() < 1e-5


def test_events_of_a_dae():
    """The lowest point at 1/2 and 3/2; the first from the right ends the run."""
    bottom = lambda t, y: y[0]
    bottom.terminal, bottom.direction = True, 1
    passed = lambda t, y: y[0]
    solution = pliant.solve_dae(pendulum, (0.0, 2.0), [1.0, 0.0, 0.0, 0.0, 0.0], differential=DIFFERENTIAL, events=[bottom, passed], **TIGHT)
    assert solution.status == 1 and abs(solution.t[-1] - 1.5) < 1e-6
    assert np.allclose(solution.t_events[1], [0.5, 1.5], atol=1e-6)


@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_slopes_at_the_start_choose_the_branch(slope):
    """y'^2 = 1 rises or falls."""
    solution = pliant.solve_dae(lambda t, y, yp: yp**2 - 1.0, (0.0, 1.0), [0.0], [slope], **TIGHT)
    assert abs(solution.y[0, -1] - slope) < 1e-9


def test_what_a_dae_cannot_use_is_told():
    start = [1.0, 0.0, 0.0]
    with pytest.raises(ValueError, match="`differential`"):
        pliant.solve_dae(robertson, (0.0, 1.0), start)
    with pytest.raises(ValueError, match="`differential` is expected"):
        pliant.solve_dae(robertson, (0.0, 1.0), start, differential=[True])
    with pytest.raises(ValueError, match="2 numbers where 3"):
        pliant.solve_dae(lambda t, y, yp: [0.0, 0.0], (0.0, 1.0), start, [0.0, 0.0, 0.0])
    with pytest.raises(KeyError, match="mine"):
        pliant.solve_dae(lambda t, y, yp: {}["mine"], (0.0, 1.0), start, [0.0, 0.0, 0.0])


@pytest.mark.parametrize("form", ["array", "sparse", "function", "band", "sparse jac", "jac_sparsity"])
@pytest.mark.parametrize("method", ["ida", "esdirk"])
def test_mass_matrices(form, method):
    """M y' = -K y with M = [[2, 1], [1, 2]] and K = M diag(1, 3): y = (e^-t, e^-3t)."""
    sparse = pytest.importorskip("scipy.sparse")
    mass = np.array([[2.0, 1.0], [1.0, 2.0]])
    matrix = -mass @ np.diag([1.0, 3.0])
    given = {
        "array": dict(mass=mass),
        "sparse": dict(mass=sparse.csr_matrix(mass)),
        "function": dict(mass=lambda t: mass),
        "band": dict(mass=mass, lband=1, uband=1),
        "sparse jac": dict(mass=sparse.csr_matrix(mass), jac=lambda t, y: sparse.csc_matrix(matrix)),
        "jac_sparsity": dict(mass=mass, jac_sparsity=np.eye(2) - np.ones((2, 2))),
    }[form]
    if form == "jac_sparsity":
        matrix = np.array([[0.0, -3.0], [-3.0, 0.0]])
    solution = pliant.solve_ivp(lambda t, y: matrix @ y, (0.0, 1.0), [1.0, 1.0], method, **given, **TIGHT)
    # with the pattern of zeros on the diagonal, y1 = y2 obeys 3 y' = -3 y
    exact = np.exp([-1.0, -1.0]) if form == "jac_sparsity" else np.exp([-1.0, -3.0])
    assert np.abs(solution.y[:, -1] - exact).max() < 3e-8


def test_a_mass_that_changes():
    """(1 + t) y' = -y: y = 1 / (1 + t)."""
    solution = pliant.solve_ivp(lambda t, y, c: -c * y, (0.0, 1.0), [1.0], "ida", args=(1.0,), mass=lambda t, c: [c + t], **TIGHT)
    assert abs(solution.y[0, -1] - 0.5) < 1e-7


def test_a_singular_mass():
    """y1' = -y2 and 0 = y1 - y2, from a y2 that does not fit."""
    fun = lambda t, y: [-y[1], y[0] - y[1]]
    jac = [[0.0, -1.0], [1.0, -1.0]]
    for options in ({}, {"jac": jac}):
        solution = pliant.solve_ivp(fun, (0.0, 1.0), [1.0, 0.0], "ida", mass=[1.0, 0.0], **options, **TIGHT)
        assert abs(solution.y[1, 0] - 1.0) < 1e-12 and np.abs(solution.y[:, -1] - np.exp(-1.0)).max() < 1e-7


def test_what_a_mass_cannot_be_is_told():
    fun = lambda t, y: -y
    with pytest.raises(ValueError, match='take "ida"'):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", mass=[2.0])
    with pytest.raises(ValueError, match="give `mass`"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "ida")
    with pytest.raises(ValueError, match="`mass` is expected"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "ida", mass=[1.0, 2.0])
    with pytest.raises(ValueError, match="outside of the band"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0, 1.0, 1.0], "ida", mass=np.ones((3, 3)), lband=1, uband=1)


@pytest.mark.parametrize("method", ["bdf", "adams"])
def test_sensitivities_of_a_decay(method):
    """y = a e^(-p t): dy/dp = -t y, dy/da = e^(-p t) from the sensitivity at the start."""
    t = np.linspace(0.0, 2.0, 9)
    solution = pliant.solve_ivp(
        lambda t, y, p, a: -p * y, (0.0, 2.0), [3.0], method, t, args=(0.7, 3.0), sensitivities=True, initial_sensitivities=[[0.0, 1.0]], **TIGHT
    )
    assert solution.sensitivities.shape == (1, 2, 9)
    exact = [-3.0 * t * np.exp(-0.7 * t), np.exp(-0.7 * t)]
    assert np.abs(solution.sensitivities[0] - exact).max() < 1e-7


def test_sensitivities_to_some_of_an_array():
    """y' = -k1 y + k2: against differences of runs."""
    fun = lambda t, y, k, scale: scale * (-k[0] * y + k[1])
    end = lambda k, scale: pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", args=(np.array(k), scale), **TIGHT).y[0, -1]
    solution = pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", args=(np.array([0.5, 2.0]), 1.5), sensitivities=[1, 2], **TIGHT)
    differences = [(end([0.5, 2.01], 1.5) - end([0.5, 1.99], 1.5)) / 0.02, (end([0.5, 2.0], 1.501) - end([0.5, 2.0], 1.499)) / 0.002]
    assert np.abs(solution.sensitivities[0, :, -1] - differences).max() < 1e-6


def test_sensitivities_of_a_dae():
    """y1' = -p y2, 0 = y1 - y2, and the same by a mass matrix: dy/dp = -t e^(-p t) of both."""
    exact = -np.exp(-2.0)
    fun = lambda t, y, yp, p: [yp[0] + p * y[1], y[0] - y[1]]
    dae = pliant.solve_dae(fun, (0.0, 1.0), [1.0, 1.0], differential=[True, False], args=(2.0,), sensitivities=True, **TIGHT)
    assert np.abs(dae.sensitivities[:, 0, -1] - exact).max() < 1e-8
    fun = lambda t, y, p: [-p * y[1], y[0] - y[1]]
    mass = pliant.solve_ivp(fun, (0.0, 1.0), [1.0, 1.0], "ida", args=(2.0,), mass=[1.0, 0.0], sensitivities=True, **TIGHT)
    assert np.abs(mass.sensitivities[:, 0, -1] - exact).max() < 1e-8


def test_sensitivities_of_complex_unknowns():
    """y = e^(i p t): dy/dp = i t y."""
    solution = pliant.solve_ivp(lambda t, y, p: 1j * p * y, (0.0, 1.0), [1.0 + 0j], "bdf", args=(2.0,), sensitivities=True, **TIGHT)
    assert abs(solution.sensitivities[0, 0, -1] - 1j * np.exp(2j)) < 5e-8


def decay():
    numba = pytest.importorskip("numba")
    number, pointer = numba.types.float64, numba.types.CPointer(numba.types.float64)

    @numba.cfunc(numba.types.void(number, pointer, pointer, pointer))
    def function(t, y, ydot, args):
        ydot[0] = -args[0] * y[0]

    return function


def test_sensitivities_of_compiled_functions():
    solution = pliant.solve_ivp(decay(), (0.0, 1.0), [1.0], "bdf", args=(2.0,), sensitivities=True, **TIGHT)
    assert abs(solution.sensitivities[0, 0, -1] + np.exp(-2.0)) < 1e-7
    found = pliant.gradient(decay(), (0.0, 1.0), [1.0], (2.0,), terminal=lambda t, y, p: y[0], **TIGHT)
    assert abs(found.parameters[0] + np.exp(-2.0)) < 1e-7


def test_what_sensitivities_cannot_be_is_told():
    fun = lambda t, y, p: -p * y
    options = dict(args=(2.0,), sensitivities=True)
    with pytest.raises(ValueError, match="take one of"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], **options)
    with pytest.raises(TypeError, match="numbers in `args`"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", args=("a",), sensitivities=True)
    with pytest.raises(ValueError, match="places among the 1 numbers"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", args=(2.0,), sensitivities=[1])
    with pytest.raises(ValueError, match="shape"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", initial_sensitivities=[1.0], **options)
    with pytest.raises(ValueError, match="t_eval"):
        pliant.solve_ivp(fun, (0.0, 1.0), [1.0], "bdf", [0.5], True, **options)


def lotka(t, y, rates, loss):
    return [rates[0] * y[0] - rates[1] * y[0] * y[1], rates[1] * y[0] * y[1] - loss * y[1]]


def prey(t, y, rates, loss):
    return y[0] ** 2 + loss


def hunt(t, y, rates, loss):
    return rates[1] * y[0] * y[1]


@pytest.mark.parametrize("supplied", [False, True])
def test_a_gradient(supplied):
    """Of an end value and an integral, by parameters and the start, against differences of runs of the fourth order."""
    terminal, running = prey, hunt
    if supplied:
        terminal = lambda t, y, rates, loss: (prey(t, y, rates, loss), [2.0 * y[0], 0.0], [0.0, 0.0, 1.0])
        running = lambda t, y, rates, loss: (
            hunt(t, y, rates, loss), [rates[1] * y[1], rates[1] * y[0]], [0.0, y[0] * y[1], 0.0],
        )

    def value(x):
        args = (x[:2], x[2])
        whole = lambda t, y: [*lotka(t, y, *args), hunt(t, y, *args)]
        end = pliant.solve_ivp(whole, (0.0, 3.0), [x[3], x[4], 0.0], "adams", rtol=1e-11, atol=1e-13).y[:, -1]
        return prey(3.0, end, *args) + end[2]

    x = np.array([1.1, 0.4, 0.9, 2.0, 1.5])
    found = pliant.gradient(lotka, (0.0, 3.0), x[3:], (x[:2], x[2]), terminal=terminal, running=running, rtol=1e-10, atol=1e-12)
    step = 2e-3 * np.eye(5)
    differences = [(8.0 * (value(x + e) - value(x - e)) - value(x + 2.0 * e) + value(x - 2.0 * e)) / 24e-3 for e in step]
    assert abs(found.value / value(x) - 1.0) < 1e-7
    assert np.abs([*found.parameters, *found.initial_state] / np.array(differences) - 1.0).max() < 1e-6


@pytest.mark.parametrize("form", ["residual", "mass"])
def test_a_gradient_of_a_dae(form):
    """The end of y1' = -p y2, 0 = q y1 - y2: y1 = e^(-p q t)."""
    if form == "residual":
        fun = lambda t, y, yp, p, q: [yp[0] + p * y[1], q * y[0] - y[1]]
        options = dict(differential=[True, False])
    else:
        fun = lambda t, y, p, q: [-p * y[1], q * y[0] - y[1]]
        options = dict(mass=[1.0, 0.0])
    end = lambda t, y, p, q: y[0]
    found = pliant.gradient(fun, (0.0, 1.0), [1.0, 2.0], (0.5, 2.0), "ida", terminal=end, **options, **TIGHT)
    exact = np.exp(-1.0)
    assert abs(found.value - exact) < 1e-7 and np.abs(found.parameters - [-2.0 * exact, -0.5 * exact]).max() < 3e-8
    assert np.abs(found.initial_state - [exact, 0.0]).max() < 3e-8


def test_a_gradient_of_the_time_of_an_event():
    """A stone from height h falls for sqrt(2 h / g): dT/dg = -T / (2 g), dT/dh = 1 / (g T)."""
    floor = lambda t, y, g: y[0]
    floor.terminal = True
    found = pliant.gradient(lambda t, y, g: [y[1], -g], (0.0, 9.0), [20.0, 0.0], (10.0,), terminal=lambda t, y, g: t, events=floor, **TIGHT)
    assert abs(found.value - 2.0) < 1e-8 and abs(found.parameters[0] + 0.1) < 1e-7
    assert abs(found.initial_state[0] - 0.05) < 1e-7


def test_what_a_gradient_cannot_be_is_told():
    fun = lambda t, y, p: -p * y
    end = lambda t, y, p: y[0]
    with pytest.raises(ValueError, match="`terminal` or `running`"):
        pliant.gradient(fun, (0.0, 1.0), [1.0], (2.0,))
    with pytest.raises(ValueError, match="no gradient"):
        pliant.gradient(fun, (0.0, 1.0), [1.0], (2.0,), "esdirk", terminal=end)
    with pytest.raises(ZeroDivisionError):
        pliant.gradient(fun, (0.0, 1.0), [1.0], (2.0,), terminal=lambda t, y, p: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        pliant.gradient(lambda t, y, p: [1 / 0], (0.0, 1.0), [1.0], (2.0,), terminal=end)
    with pytest.raises(ValueError, match="not 2 values"):
        pliant.gradient(fun, (0.0, 1.0), [1.0], (2.0,), terminal=lambda t, y, p: (y[0], [1.0]))
    with pytest.raises(pliant.Error, match="max_steps"):
        pliant.gradient(fun, (0.0, 1.0), [1.0], (2.0,), terminal=end, max_steps=3)
