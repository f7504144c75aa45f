"""Events with actions: a square that falls on a floor, which gives back a part of its speed."""

import gc
import weakref

import numpy as np
import pytest

import pliant

SQUARE = pliant.Scene(
    gravity=[0.0, -9.8],
    body=dict(
        mesh=dict(kind="rectangle", size=[0.1, 0.1], nodes=[3, 3], cells="triangles", origin=[0.0, 1.0]),
        thickness=0.01,
        material=dict(density=1000.0, young=1e6, poisson=0.48, viscosity=40.0),
    ),
    phase=[dict(until=3.0)],
)


def floor(t, x, v):
    """It falls 1 m before its lower edge is there."""
    return x[:, 1].min()


def bouncing(part, times=None):
    square = SQUARE.start(rtol=1e-8)

    def bounce(square):
        if times is not None:
            times.append(square.time)
        square.change_state(velocities=-part * square.velocities)

    square.when(floor, bounce, direction=-1)
    return square


def test_a_square_bounces():
    """At the times of the closed form: t1 = sqrt(2 h / g), then after 2 part^k t1 each."""
    times = []
    square = bouncing(0.9, times)
    assert square.advance_to(2.5)
    first = np.sqrt(2.0 / 9.8)
    exact = first * np.array([1.0, 2.8, 4.42])
    assert len(times) == 3 and np.abs(times - exact).max() < 1e-9
    assert square.time == 2.5


def test_an_action_stops_the_advance():
    square = SQUARE.start()
    square.when(floor, lambda square: True)
    assert not square.advance_to(1.0)
    assert abs(square.time - np.sqrt(2.0 / 9.8)) < 1e-9
    assert square.advance_to(1.0) and square.time == 1.0
    # control ends there, too
    square = SQUARE.start()
    square.when(floor, lambda square: True)
    assert not square.control(0.01, 1.0, lambda square: None)


def test_directions():
    met = []
    square = bouncing(0.9)
    for direction in (-1, 0, 1):
        square.when(lambda t, x, v: v[:, 1].mean(), lambda square, d=direction: met.append(d), direction=direction)
    square.advance_to(0.9)
    # the one top after the first bounce
    assert sorted(met) == [-1, 0]


def test_exceptions_end_the_advance():
    square = SQUARE.start()
    square.when(floor, lambda square: {}["mine"])
    with pytest.raises(KeyError, match="mine"):
        square.advance_to(1.0)
    assert abs(square.time - np.sqrt(2.0 / 9.8)) < 1e-9
    assert square.advance_by(0.1)
    square = SQUARE.start()
    square.when(lambda t, x, v: 1 / 0, lambda square: None)
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            square.advance_to(1.0)


def test_bounces_that_accumulate_are_told():
    with pytest.raises(pliant.InputError, match="turns the motion back"):
        bouncing(0.5).advance_to(2.0)


def test_an_action_may_advance_and_return():
    """Within an action nothing is watched: it looks ahead, and goes back."""
    seen = []

    def look(square):
        kept = square.checkpoint()
        square.advance_by(0.1)
        seen.append(square.position(1)[1])
        square.restore(kept)
        return True

    square = SQUARE.start(rtol=1e-8)
    square.when(floor, look, direction=-1)
    assert not square.advance_to(1.0)
    first = np.sqrt(2.0 / 9.8)
    assert abs(square.time - first) < 1e-9 and abs(seen[0] - (1.0 - 4.9 * (first + 0.1) ** 2)) < 1e-6


def test_an_event_cannot_command():
    square = SQUARE.start()

    def inside(t, x, v):
        square.step()
        return 1.0

    square.when(inside, lambda square: None)
    with pytest.raises(RuntimeError, match="fork"):
        square.advance_to(1.0)


def test_forks_watch_nothing():
    times = []
    square = bouncing(0.9, times)
    fork = square.fork()
    fork.advance_to(1.0)
    assert times == [] and fork.position(1)[1] < -3.0


def test_advance_until_meets_both():
    times = []
    square = bouncing(0.9, times)
    assert square.advance_until(2.0, lambda t, x, v: t - 1.0)
    assert len(times) == 1 and abs(square.time - 1.0) < 1e-12


def test_what_watches_is_let_go():
    square = bouncing(0.9)
    square.when(floor, lambda _: square.time)
    square.advance_to(1.0)
    gone = weakref.ref(square)
    del square
    gc.collect()
    assert gone() is None
