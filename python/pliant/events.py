"""Events along a solution: roots of functions, clocks, and the actions at them."""

import numpy as np


class Event:
    """A root of ``function(t, y, *args)``, with what happens there; for `events` of the integrators.

    A plain function with such attributes is an event, too, as in SciPy (``terminal``, ``direction``).

    Parameters
    ----------
    function : callable
        Its roots are the events.
    direction : float
        Positive: only where it becomes positive; negative: only where it becomes negative; 0: both.
    terminal : bool or int
        Whether the event ends the run, or the number of the one that does.
    action : callable, optional
        ``action(jump)`` changes the state at the event, ``jump.y``, and the parameters, ``jump.p``; see :class:`Jump`. The numbers and
        arrays of numbers in `args` are then the parameters. With sensitivities it is called some more times, at states nearby.
    once : bool
        Whether it takes place once, and then no more until an action arms it.
    at_accumulation : callable, optional
        ``at_accumulation(jump)`` brings the solution to rest where the action turns it back ever faster, as a ball that bounces. Without
        it the run ends there with status -1.
    touching : float, optional
        Also counts minima of ``abs(function)`` below this that do not cross zero.
    samples : int, optional
        In how many places of a step the function is evaluated; 4 by default.

    >>> import pliant
    >>> floor = pliant.Event(lambda t, y: y[0], direction=-1, action=lambda jump: jump.y.__setitem__(1, -0.9 * jump.y[1]))
    >>> ball = pliant.solve_ivp(lambda t, y: [y[1], -10.0], (0.0, 2.0), [5.0, 0.0], "bdf", events=floor, rtol=1e-8, atol=1e-10)
    >>> bool(abs(ball.y[0, -1] - 4.0) < 1e-6)          # after 1 s on the floor, thrown back at 9 m/s
    True
    """

    def __init__(
        self, function, *, direction=0, terminal=False, action=None, once=False, at_accumulation=None, touching=None, samples=None
    ):
        self.function, self.direction, self.terminal = function, direction, terminal
        self.action, self.once, self.at_accumulation = action, once, at_accumulation
        self.touching, self.samples = touching, samples
        self.period = self.start = None

    def __call__(self, *at):
        return self.function(*at)

    @classmethod
    def every(cls, period, start=None, **options):
        """A clock: at each multiple of `period` after the start of the span, or at `start` and each `period` after it, which may be the
        start of the span. No tick is lost, and their times are exact. `options`: `terminal`, `action`, `once`.
        """
        event = cls(None, **options)
        event.period, event.start = float(period), None if start is None else float(start)
        return event

    @classmethod
    def at(cls, t, **options):
        """An event at the time `t`, which may be the start or the end of the span. `options` as of :meth:`every`."""
        event = cls(None, **options)
        event.start = float(t)
        return event


class Jump:
    """The state at an event, for an action, which changes it in place."""

    def __init__(self, t, y, yp, p):
        #: Time.
        self.t = t
        #: State; the solution goes on from the values written here.
        self.y = y
        #: Its time derivative for a residual; empty otherwise.
        self.yp = yp
        #: The numbers in `args`, one after the other; values written here apply from now on.
        self.p = p
        self._armed, self._ends = [], False

    def arm(self, event):
        """Lets the event of this number in `events` take place again."""
        self._armed.append((int(event), True))

    def disarm(self, event):
        """Lets the event of this number in `events` take place no more until it is armed."""
        self._armed.append((int(event), False))

    def end(self):
        """Ends the run here."""
        self._ends = True


def event_list(events):
    """`events` as a list; None if there are none."""
    return None if events is None else [events] if callable(events) else list(events)


def have_actions(events):
    """Whether one of the list has an action."""
    return any(getattr(event, "action", None) is not None for event in events or [])


def watched_events(events, given, parts, sign=1.0):
    """The list of events as dicts for the engine, along the time `sign` t; None if there are none."""
    return None if events is None else [_watched(event, given, parts, sign) for event in events]


def _watched(event, given, parts, sign):
    last = getattr(event, "terminal", None)
    if last is None or last is False or last == 0:
        last = 0
    elif int(last) == last and last > 0:
        last = int(last)
    else:
        raise ValueError("The `terminal` attribute of each event must be a boolean or positive integer.")
    start, period = getattr(event, "start", None), getattr(event, "period", None)
    is_clock = start is not None or period is not None
    return dict(
        function=None if is_clock else _number(given.of(event), parts, sign),
        direction=int(sign * np.sign(getattr(event, "direction", 0) or 0)),
        last=last,
        once=bool(getattr(event, "once", False)),
        touching=getattr(event, "touching", None),
        samples=getattr(event, "samples", None),
        start=None if start is None else sign * start,
        period=period,
        action=acting(getattr(event, "action", None), parts, sign),
        at_accumulation=acting(getattr(event, "at_accumulation", None), parts, sign),
    )


def _number(function, parts, sign):
    return lambda t, y, *p: float(np.ravel(function(sign * t, parts.whole(y), *p))[0])


def acting(action, parts, sign):
    """`action` as a function of the engine's t, y, y', p that returns the new y, y', p, what is armed, and whether the run ends."""
    if action is None:
        return None

    def act(t, y, yp, p):
        jump = Jump(sign * t, parts.whole(y), yp, p)
        action(jump)
        return parts.pack(jump.y), np.asarray(jump.yp, dtype=float), np.asarray(jump.p, dtype=float), jump._armed, jump._ends

    return act
