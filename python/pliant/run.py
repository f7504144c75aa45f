"""Runs that a program leads, step by step."""

import weakref
from typing import NamedTuple

import numpy as np

from . import _pliant
from .dae import asked_dae
from .events import acting
from .ivp import asked_ivp


class Occurrence(NamedTuple):
    """An event that was met."""

    #: Its number in `events`.
    event: int
    #: Time.
    t: float
    #: State before any action.
    y: np.ndarray


class Step(NamedTuple):
    """One step of a :class:`Run`."""

    #: Time at its start.
    t_old: float
    #: Time at its end.
    t: float
    #: State at its end, after any jump.
    y: np.ndarray
    #: State at its end before the jump; None if there is none.
    before: np.ndarray | None
    #: A list of :class:`Occurrence`: the events within the step and at its end.
    events: list


class _Functions(list):
    """The functions of a run, which live as long as it does."""


def _lent(keys, functions):
    """`keys` with functions that look up their originals in the list `functions`: the engine, into which Python's collection of garbage does
    not look, then has none that leads back to its run.
    """
    if isinstance(keys, dict):
        return {name: _lent(value, functions) for name, value in keys.items()}
    if isinstance(keys, (list, tuple)) and any(isinstance(value, dict) or callable(value) for value in keys):
        return type(keys)(_lent(value, functions) for value in keys)
    if not callable(keys):
        return keys
    found, place = weakref.ref(functions), len(functions)
    functions.append(keys)
    return lambda *at: found()[place](*at)


class Run:
    """An initial value problem that is solved step by step, under the control of a program.

    It takes the arguments of :func:`solve_ivp` but for `t_eval` and `dense_output`. The numbers in `args` are its parameters, which
    :meth:`jump` changes.

    Errors are those of :mod:`pliant.errors`: :class:`InputError` for what cannot be used, :class:`Error` where the run cannot go on.

    >>> import pliant
    >>> run = pliant.Run(lambda t, y, u: [u], (0.0, 2.0), [0.0], "bdf", args=(1.0,), rtol=1e-8, atol=1e-10)
    >>> _ = run.advance_to(0.5)
    >>> middle = run.save()
    >>> run.jump(lambda jump: jump.p.__setitem__(0, -3.0))
    >>> _ = run.advance_to(1.0)
    >>> bool(abs(run.y[0] + 1.0) < 1e-8)
    True
    >>> run.restore(middle)                             # a second try from the middle
    >>> _ = run.advance_to(1.0)
    >>> bool(abs(run.y[0] - 1.0) < 1e-8)
    True
    """

    def __init__(self, fun, t_span, y0, method="RK45", **options):
        self._begin(fun, *asked_ivp(fun, t_span, y0, method, are_parameters=True, **options))

    @classmethod
    def dae(cls, fun, t_span, y0, yp0=None, **options):
        """A run of the residual ``fun(t, y, yp)``, with the arguments of :func:`solve_dae` but for `t_eval` and `dense_output`."""
        run = cls.__new__(cls)
        run._begin(fun, *asked_dae(fun, t_span, y0, yp0, are_parameters=True, **options))
        return run

    def _begin(self, fun, keys, how):
        self._fun = fun  # a compiled function is only an address there
        self._functions = _Functions()
        self._run, self._parts, self._sign = _pliant.Run(_lent(keys, self._functions)), how.parts, how.sign

    def advance(self):
        """Takes one step, and returns it as a :class:`Step`; None once the run has ended."""
        step = self._run.advance()
        if step is None:
            return None
        t_old, t, y, before, events = step
        before = None if before is None else self._state(before)
        return Step(self._sign * t_old, self._sign * t, self._state(y), before, self._met(events))

    def advance_to(self, t):
        """Goes to time `t`, or to the end of the run if that comes first, and returns the events on the way as a list of :class:`Occurrence`.

        A step ends there, and the next one continues from it without a new start of the integrator.
        """
        return self._met(self._run.advance_to(self._sign * float(t)))

    def jump(self, action):
        """Changes the state, the parameters, or which events are armed at the present time: ``action(jump)``, as of an :class:`Event`.

        The integrator restarts from there. With sensitivities `action` is called some more times, at states nearby.
        """
        self._run.jump(acting(action, self._parts, self._sign))

    def save(self):
        """Where the run stands, for :meth:`restore`: numbers alone, which `pickle` writes to a file."""
        return self._run.save()

    def restore(self, saved):
        """Goes back, or on, to where the run stood when it was saved: with its state, parameters and events. Counters of cost go on.

        It may have been another run of the same problem, also of another program, whose span has that time, too.
        """
        self._run.restore(saved)

    def interpolate(self, t):
        """The state at time `t` within the last step, before any jump at its end."""
        return self._state(self._run.interpolate(self._sign * float(t)))

    @property
    def t(self):
        """Time reached."""
        return self._sign * self._run.t

    @property
    def y(self):
        """State there, after any jump."""
        return self._state(self._run.y)

    @property
    def yp(self):
        """Its time derivative for a residual; empty otherwise."""
        return self._run.yp

    @property
    def parameters(self):
        """The numbers in `args`, one after the other."""
        return self._run.parameters

    @property
    def sensitivities(self):
        """The derivatives of `y` by the wanted parameters: [unknown, parameter]."""
        return self._parts.unpack(self._run.sensitivities).T

    @property
    def integrals(self):
        """The integrals of `integrands` since the start."""
        return self._run.integrals

    @property
    def end(self):
        """How the run has ended: ``"span"``, ``"event"``, ``"break"`` (an action of :meth:`jump` ended it) or ``"early"``; None before."""
        return self._run.end

    @property
    def nsteps(self):
        """Steps so far."""
        return self._run.steps

    @property
    def nfev(self):
        """Evaluations of `fun` so far."""
        return self._run.evaluations

    def _state(self, y):
        return self._parts.unpack(y[None, :])[0]

    def _met(self, events):
        return [Occurrence(event, self._sign * t, self._state(y)) for event, t, y in events]
