"""Events with actions, clocks, integrals and what else the integrators have beside SciPy's, against closed forms."""

import numpy as np
import pytest

import pliant

METHODS = ["bdf", "adams", "rosenbrock", "esdirk", "dormand-prince", "auto"]
TIGHT = dict(rtol=1e-9, atol=1e-11)


def bounce(part):
    def action(jump):
        jump.y[1] *= -part

    return action


@pytest.mark.parametrize("method", METHODS)
def test_a_ball_bounces(method):
    """From 5 m under 10 m/s^2: on the floor after 1 s, then in the air for 1 s at half of the speed. Backward in time, too."""
    floor = pliant.Event(lambda t, y: y[0], direction=-1, action=bounce(0.5))
    ball = pliant.solve_ivp(lambda t, y: [y[1], -10.0], (0.0, 1.75), [5.0, 0.0], method, events=floor, **TIGHT)
    assert np.allclose(ball.t_events[0], [1.0], atol=1e-8)
    assert np.allclose(ball.y[:, -1], [5.0 * 0.75 - 5.0 * 0.75**2, 5.0 - 7.5], atol=1e-7)
    # where the solution jumps, a time that is asked for has the state after that
    floor = pliant.Event(lambda t, y: y[0], direction=0, action=bounce(2.0), once=True)
    times = [1.75, 1.5, 0.5]
    back = pliant.solve_ivp(lambda t, y: [y[1], -10.0], (1.75, 0.5), ball.y[:, -1], method, t_eval=times, events=floor, **TIGHT)
    assert np.allclose(back.y[:, -1], [5.0 - 1.25, -5.0], atol=1e-6), back


def test_events_that_arm_each_other_and_end():
    """A thermostat: heated at rate 1 to 1, cooled at rate 1 to 0.5, and on; ended by the action of a clock."""

    def switch(mode, off, on):
        def action(jump):
            jump.p[0] = mode
            jump.disarm(off)
            jump.arm(on)

        return action

    events = [
        pliant.Event(lambda t, y, mode: y[0] - 1.0, action=switch(-1.0, 0, 1)),
        pliant.Event(lambda t, y, mode: y[0] - 0.5, action=switch(1.0, 1, 0)),
        pliant.Event.at(2.75, action=lambda jump: jump.end()),
        pliant.Event.every(0.5, start=0.0),
    ]
    run = pliant.solve_ivp(lambda t, y, mode: [mode], (0.0, 10.0), [0.6], "bdf", args=(1.0,), events=events, **TIGHT)
    assert run.status == 1 and run.t[-1] == 2.75
    assert np.allclose(run.t_events[0], [0.4, 1.4, 2.4]) and np.allclose(run.t_events[1], [0.9, 1.9])
    assert np.array_equal(run.t_events[3], 0.5 * np.arange(6)) and run.parameters.tolist() == [-1.0]


def test_clocks_once_touching_and_accumulation():
    ticks = [pliant.Event.every(0.1), pliant.Event.every(0.3, start=0.05), pliant.Event.at(1.0)]
    for method in METHODS:
        run = pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], method, events=ticks, **TIGHT)
        assert np.allclose(run.t_events[0], 0.1 * np.arange(1, 11)) and np.allclose(run.t_events[1], [0.05, 0.35, 0.65, 0.95])
        assert run.t_events[2].tolist() == [1.0]
    events = [
        pliant.Event(lambda t, y: y[0], once=True),
        pliant.Event(lambda t, y: 1.0 + 1e-7 - y[0], touching=1e-6),
        pliant.Event(lambda t, y: 1.0 + 1e-7 - y[0]),
    ]
    run = pliant.solve_ivp(lambda t, y: [y[1], -y[0]], (0.1, 10.0), np.sin([0.1, 0.1 + np.pi / 2]), "bdf", events=events, **TIGHT)
    assert np.allclose(run.t_events[0], np.pi) and np.allclose(run.t_events[1], [np.pi / 2, 2.5 * np.pi], atol=1e-3)
    assert len(run.t_events[2]) == 0
    floor = pliant.Event(lambda t, y, g: y[0], direction=-1, action=bounce(0.5))
    fall = lambda t, y, g: [y[1], -g]
    stopped = pliant.solve_ivp(fall, (0.0, 5.0), [1.0, 0.0], "bdf", args=(8.0,), events=floor, **TIGHT)
    assert stopped.status == -1 and "accumulates" in stopped.message

    def lie(jump):
        jump.y[:] = 0.0
        jump.p[0] = 0.0

    floor = pliant.Event(lambda t, y, g: y[0], direction=-1, action=bounce(0.5), at_accumulation=lie)
    at_rest = pliant.solve_ivp(fall, (0.0, 5.0), [1.0, 0.0], "bdf", args=(8.0,), events=floor, **TIGHT)
    assert at_rest.success and at_rest.y[:, -1].tolist() == [0.0, 0.0] and abs(at_rest.t_events[0][-1] - 1.5) < 1e-4


def test_actions_of_complex_unknowns_and_of_algebraic_ones():
    turn = pliant.Event.at(1.0, action=lambda jump: jump.y.__imul__(1j))
    run = pliant.solve_ivp(lambda t, y: 1j * y, (0.0, 2.0), [1.0 + 0j], events=turn, **TIGHT)
    assert abs(run.y[0, -1] - 1j * np.exp(2j)) < 1e-7

    def halve(jump):
        jump.y[0] *= 0.5

    residual = lambda t, y, yp: [yp[0] + y[1], y[0] - y[1]]
    half = pliant.Event.at(1.0, action=halve)
    run = pliant.solve_dae(residual, (0.0, 2.0), [1.0, 0.0], differential=[True, False], events=half, **TIGHT)
    assert np.abs(run.y[:, -1] - 0.5 * np.exp(-2.0)).max() < 1e-7


def test_errors_of_actions():
    def wrong(jump):
        raise KeyError("mine")

    def longer(jump):
        jump.y = np.zeros(2)

    decay = lambda t, y, *p: -y
    for method in METHODS:
        with pytest.raises(KeyError, match="mine"):
            pliant.solve_ivp(decay, (0.0, 1.0), [1.0], method, events=pliant.Event.at(0.5, action=wrong))
    with pytest.raises(ValueError, match="2 numbers in y where 1"):
        pliant.solve_ivp(decay, (0.0, 1.0), [1.0], events=pliant.Event.at(0.5, action=longer))
    none = pliant.solve_ivp(decay, (0.0, 1.0), [1.0], events=pliant.Event.at(0.5, action=lambda jump: jump.arm(3)))
    assert none.status == -1 and "arms or disarms" in none.message and none.t[-1] <= 0.5
    with pytest.raises(TypeError, match="numbers in `args`"):
        pliant.solve_ivp(decay, (0.0, 1.0), [1.0], args=("word",), events=pliant.Event.at(0.5, action=halve_all))


def halve_all(jump):
    jump.y *= 0.5


def test_integrals_and_their_sensitivities():
    """y = e^(-p t), its integral (1 - e^(-p)) / p and that of p y^2, 1/2 - e^(-2p) / 2; with derivatives by p; across a jump to half of it."""
    p = 2.0
    decay = lambda t, y, p: -p * y
    both = lambda t, y, p: [y[0], p * y[0] ** 2]
    options = dict(args=(p,), integrands=both, **TIGHT)
    for method in ("bdf", "adams", "auto"):
        run = pliant.solve_ivp(decay, (0.0, 1.0), [1.0], method, sensitivities=True, t_eval=[0.5, 1.0], **options)
        e = np.exp(-p)
        assert run.integrals.shape == (2, 2) and run.integral_sensitivities.shape == (2, 1, 2)
        assert np.allclose(run.integrals[:, -1], [(1 - e) / p, (1 - e**2) / 2], atol=1e-7)
        assert np.allclose(run.integral_sensitivities[:, 0, -1], [e / p - (1 - e) / p**2, e**2], atol=1e-6)
    run = pliant.solve_ivp(decay, (0.0, 1.0), [1.0], "bdf", events=pliant.Event.at(0.5, action=halve_all), **options)
    e = np.exp(-0.5 * p)
    assert abs(run.integrals[0, -1] - (1 - e) / p * (1 + 0.5 * e)) < 1e-7
    residual = lambda t, y, yp, p: yp + p * y
    run = pliant.solve_dae(residual, (0.0, 1.0), [1.0], [-p], args=(p,), integrands=lambda t, y, yp, p: -yp, **TIGHT)
    assert abs(run.integrals[0, -1] - (1 - np.exp(-p))) < 1e-7
    with pytest.raises(ValueError, match="integrals"):
        pliant.solve_ivp(decay, (0.0, 1.0), [1.0], "rosenbrock", **options)
    with pytest.raises(ValueError, match="dense_output"):
        pliant.solve_ivp(decay, (0.0, 1.0), [1.0], "bdf", t_eval=[1.0], dense_output=True, **options)


def test_the_automatic_choice_tells_what_it_chose():
    stiff = lambda t, y: [-1e6 * (y[0] - np.sin(t)) + np.cos(t)]
    run = pliant.solve_ivp(stiff, (0.0, 10.0), [0.0], "auto", rtol=1e-6, atol=1e-6)
    assert run.method == "auto" and run.nsteps < 1000 and abs(run.y[0, -1] - np.sin(10.0)) < 1e-4
    first, second = run.methods[:2]
    assert (first.t, first.method) == (0.0, "dormand-prince") and "cost" in first.reason
    assert second.t > 0.0 and second.method == "rosenbrock" and "stability limits" in second.reason
    assert [use.method for use in pliant.solve_ivp(stiff, (0.0, 10.0), [0.0], "bdf").methods] == ["bdf"]
    backward = pliant.solve_ivp(lambda t, y: y, (1.0, 0.0), [np.e], "auto", **TIGHT)
    assert backward.methods[0].method == "bdf" and "backward" in backward.methods[0].reason
    assert abs(backward.y[0, -1] - 1.0) < 1e-7
    massive = pliant.solve_ivp(lambda t, y: [-y[1], y[0] - y[1]], (0.0, 1.0), [1.0, 1.0], "auto", mass=[1.0, 0.0], **TIGHT)
    assert massive.methods[0].method == "ida" and abs(massive.y[0, -1] - np.exp(-1.0)) < 1e-7


def test_words_of_methods():
    """One list, of the library: what it does not have is refused with all words."""
    with pytest.raises(ValueError, match="auto, bdf, adams, dormand-prince, rosenbrock, ida, or a table"):
        pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], "rk4")
    assert pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], "ARKODE_TRBDF2_3_3_2").method == "TRBDF2_3_3_2"
    with pytest.raises(ValueError, match="takes no mass matrix"):
        pliant.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], "rosenbrock", mass=[1.0])


def test_breaks_signs_and_unchecked_jacobians():
    """A jump of 1e4 at t = 1 that a step might pass; a decay to 0 that stays above; a Jacobian that is none."""
    jumps = lambda t, y: [1e4 if 1.0 <= t < 1.0001 else 0.0]
    for method in METHODS:
        run = pliant.solve_ivp(jumps, (0.0, 3.0), [0.0], method, breaks=[1.0, 1.0001], **TIGHT)
        assert abs(run.y[0, -1] - 1.0) < 1e-8
    # Robertson's reactions to 4e10, where differences of large numbers make concentrations negative
    rates = lambda t, y: [-0.04 * y[0] + 1e4 * y[1] * y[2], 0.04 * y[0] - 1e4 * y[1] * y[2] - 3e7 * y[1] ** 2, 3e7 * y[1] ** 2]
    loose = dict(rtol=1e-3, atol=1e-6)
    free = pliant.solve_ivp(rates, (0.0, 4e10), [1.0, 0.0, 0.0], "bdf", **loose)
    kept = pliant.solve_ivp(rates, (0.0, 4e10), [1.0, 0.0, 0.0], "bdf", nonnegative=[0, 1, 2], **loose)
    assert kept.success and kept.y.min() >= 0.0 and (not free.success or free.y.min() < 0.0)
    with pytest.raises(ValueError, match="among the 3 unknowns"):
        pliant.solve_ivp(rates, (0.0, 1.0), [1.0, 0.0, 0.0], "bdf", nonnegative=[3])
    stiff, wrong = (lambda t, y: [-50.0 * y[0], -y[1]]), np.diag([-45.0, -1.0])
    told = pliant.solve_ivp(stiff, (0.0, 1.0), [1.0, 1.0], "bdf", jac=wrong, **TIGHT)
    assert told.status == -1 and "dense_jacobian is wrong" in told.message
    run = pliant.solve_ivp(stiff, (0.0, 1.0), [1.0, 1.0], "bdf", jac=wrong, check_jacobian=False, **TIGHT)
    assert run.success and abs(run.y[1, -1] - np.exp(-1.0)) < 1e-7


def test_gradients_across_actions():
    """A ball that keeps a part p of its speed, 0.25 s after the impact: 4 p / 4 - 1 / 4 m, by p."""
    floor = pliant.Event(lambda t, y, p: y[0], direction=-1, action=lambda jump: jump.y.__setitem__(1, -jump.p[0] * jump.y[1]))
    fall = lambda t, y, p: [y[1], -8.0]
    found = pliant.gradient(fall, (0.0, 0.75), [1.0, 0.0], (0.5,), "auto", terminal=lambda t, y, p: y[0], events=floor, **TIGHT)
    assert abs(found.value - 0.25) < 1e-7 and abs(found.parameters[0] - 1.0) < 1e-6
    run = pliant.solve_ivp(fall, (0.0, 0.75), [1.0, 0.0], "bdf", args=(0.5,), sensitivities=True, events=floor, **TIGHT)
    assert abs(run.sensitivities[0, 0, -1] - 1.0) < 1e-6
