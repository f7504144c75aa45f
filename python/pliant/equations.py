"""What :func:`solve_ivp`, :func:`solve_dae` and :func:`gradient` have in common: their arguments, and their result."""

import warnings
from typing import NamedTuple

import numpy as np

MESSAGES = {
    0: "The solver successfully reached the end of the integration interval.",
    1: "A termination event occurred.",
}


class MethodUse(NamedTuple):
    """A method at work, from a time on."""

    #: Time of its start.
    t: float
    #: The method.
    method: str
    #: Why it is used.
    reason: str


class Progress(NamedTuple):
    """Progress of a run, for `observed_by`."""

    #: Time reached.
    t: float
    #: State there.
    y: np.ndarray
    #: Steps taken.
    steps: int
    #: Part of the span that is done, from 0 to 1.
    part: float


class How(NamedTuple):
    """Facts by which a run of the engine becomes a result."""

    #: The kind of the unknowns.
    parts: object
    #: The method.
    method: str
    #: The engine goes along the time `sign` t.
    sign: float
    #: The events, None if there are none.
    watched: list | None
    jac: object
    is_sensitive: bool


class OdeResult(dict):
    """The result of :func:`solve_ivp` and :func:`solve_dae`: a dict whose keys are attributes, too, as SciPy's.

    `t`, `y` [unknown, time], `sol` (a function of time, or None), `t_events`, `y_events`, `nfev`, `njev`, `nlu`, `nsteps`,
    `status` (0: the end is reached, 1: an event has ended it, -1: it failed), `message`, `success`; `sensitivities`
    [unknown, parameter, time] if they are wanted, and `last_yp`, y' at the last time, of :func:`solve_dae`; `integrals`
    [integral, time] and `integral_sensitivities` [integral, parameter, time] if they are wanted; `methods`, a list of
    :class:`MethodUse`, several with the method ``"auto"``; `parameters`, the numbers in `args` at the end, if they are parameters.
    """

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(name) from None

    __setattr__ = dict.__setitem__
    __delattr__ = dict.__delitem__

    def __repr__(self):
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:>{width}}: {value!r}" for name, value in self.items())

    def __dir__(self):
        return list(self)


class OdeSolution:
    """The solution between its times: `sol(t)` gives [unknown] at one time, [unknown, time] at several."""

    def __init__(self, run, unpacked, sign):
        self._run, self._unpacked, self._sign = run, unpacked, sign
        self.ts = sign * run.t
        self.t_min, self.t_max = min(self.ts[0], self.ts[-1]), max(self.ts[0], self.ts[-1])

    def __call__(self, t):
        t = np.asarray(t, dtype=float)
        return self._unpacked(self._run.at((self._sign * t.ravel()).tolist())).T.reshape((-1, *t.shape))


class Real:
    """Unknowns that are real numbers."""

    def __init__(self, count):
        self.count = count

    def pack(self, y):
        return np.asarray(y, dtype=float)

    def unpack(self, states):
        return states

    def whole(self, y):
        """The unknowns of a packed state."""
        return y

    def function(self, fun):
        return fun

    def matrix(self, jac):
        return np.ascontiguousarray(jac, dtype=float)


class Complex(Real):
    """Unknowns that are complex numbers: real parts, then imaginary parts."""

    def pack(self, y):
        return np.concatenate([np.real(y), np.imag(y)]).astype(float)

    def unpack(self, states):
        return states[..., : self.count] + 1j * states[..., self.count :]

    def whole(self, y):
        return y[: self.count] + 1j * y[self.count :]

    def function(self, fun):
        return lambda t, y, *p: self.pack(fun(t, self.whole(y), *p))

    def matrix(self, jac):
        jac = np.asarray(jac)
        return np.ascontiguousarray(np.block([[np.real(jac), -np.imag(jac)], [np.imag(jac), np.real(jac)]]))


class Arguments:
    """The further arguments of functions, `args`; if derivatives are taken by their numbers, these are parameters.

    Functions are then called with the parameters as their last argument, in place of `args`.
    """

    def __init__(self, args, are_parameters):
        try:
            self.args = () if args is None else tuple(args)
        except TypeError as error:
            raise TypeError(f"Supplied 'args' cannot be unpacked. Give a tuple: args=({args!r},)") from error
        self.parameters, self.shapes = [], None
        if are_parameters:
            try:
                arrays = [np.asarray(arg, dtype=float) for arg in self.args]
            except (TypeError, ValueError) as error:
                raise TypeError(f"parameters are the numbers in `args`: it holds numbers and arrays of them, not {args!r}") from error
            self.shapes = [array.shape for array in arrays]
            self.parameters = [float(number) for array in arrays for number in array.flat]

    def of(self, fun):
        """`fun` with these arguments."""
        if not self.args or not callable(fun):
            return fun
        if not self.parameters:
            return lambda *given: fun(*given, *self.args)
        return lambda *given: fun(*given[:-1], *self.split(given[-1]))

    def split(self, p):
        """The arguments that the parameters `p` stand for."""
        args, start = [], 0
        for shape in self.shapes:
            end = start + int(np.prod(shape))
            args.append(p[start:end].reshape(shape) if shape else float(p[start]))
            start = end
        return args

    @property
    def last(self):
        """What functions take as their last argument."""
        return (np.array(self.parameters),) if self.parameters else ()


def unknowns(y0):
    """`y0` as an array, and what kind of numbers they are."""
    y0 = np.atleast_1d(np.asarray(y0))
    if y0.ndim != 1:
        raise ValueError("`y0` must be 1-dimensional.")
    if not np.all(np.isfinite(y0)):
        raise ValueError("All components of the initial state `y0` must be finite.")
    return y0, (Complex if np.issubdtype(y0.dtype, np.complexfloating) else Real)(len(y0))


def tolerances(rtol, atol, parts, level=4):
    """The tolerances for the engine; a warning names the line that is so many calls away."""
    atol = np.asarray(atol, dtype=float)
    if np.any(np.asarray(rtol) < 0):
        raise ValueError("`rtol` must be positive.")
    if np.any(atol < 0):
        raise ValueError("`atol` must be positive.")
    if atol.ndim > 0 and atol.shape != (parts.count,):
        raise ValueError("`atol` has wrong shape.")
    rtol = float(np.min(rtol))  # of several the smallest, for all unknowns
    least = 100 * np.finfo(float).eps
    if rtol < least:
        warnings.warn(f"`rtol` is too small, setting to {least}", stacklevel=level)
        rtol = least
    atol = np.broadcast_to(atol, (parts.count,))
    count = 2 if isinstance(parts, Complex) else 1
    return float(rtol), np.tile(atol, count).tolist()


#: What equations need not have: keys for the engine.
NOTHING = dict.fromkeys(
    ["yp0", "differential", "jac", "sparsity", "band", "mass", "times", "first_step", "min_step", "max_step", "max_order"]
    + ["sensitivities", "initial_sensitivities", "integrands", "integral_count", "krylov", "observer"]
) | dict(nonnegative=[], breaks=[], check_jacobian=True)


def step_limits(start, end, first_step, min_step, max_step):
    """The limits of steps as keys for the engine."""
    if first_step is not None:
        if first_step <= 0:
            raise ValueError("`first_step` must be positive.")
        if first_step > abs(end - start):
            raise ValueError("`first_step` exceeds bounds.")
    if max_step <= 0:
        raise ValueError("`max_step` must be positive.")
    return dict(first_step=first_step, min_step=min_step or None, max_step=None if np.isinf(max_step) else float(max_step))


def wanted_times(t_eval, start, end):
    if t_eval is None:
        return None
    t_eval = np.asarray(t_eval, dtype=float)
    if t_eval.ndim != 1:
        raise ValueError("`t_eval` must be 1-dimensional.")
    if np.any(t_eval < min(start, end)) or np.any(t_eval > max(start, end)):
        raise ValueError("Values in `t_eval` are not within `t_span`.")
    steps = np.diff(t_eval)
    if (end > start and np.any(steps <= 0)) or (end < start and np.any(steps >= 0)):
        raise ValueError("Values in `t_eval` are not properly sorted.")
    return t_eval


def check_times(t_eval, dense_output, **wanted):
    """Refuses what is wanted where no polynomial between the steps gives it."""
    for what, value in wanted.items():
        if value is not None and value is not False and t_eval is not None and dense_output:
            raise ValueError(f"`{what}` are known at the steps or at `t_eval`: leave out `t_eval` or `dense_output`")


def wanted_sensitivities(sensitivities, initial, count, parts):
    """Places among `count` parameters, and the sensitivities at the start, one column after the other: keys for the engine."""
    if sensitivities is None or sensitivities is False:
        if initial is not None:
            raise ValueError("`initial_sensitivities` belong to `sensitivities`: give both")
        return {}
    places = list(range(count)) if sensitivities is True else [int(place) for place in np.ravel(sensitivities)]
    if not places:
        raise ValueError("`sensitivities` are derivatives by the numbers in `args`, of which there are none")
    if any(not 0 <= place < count for place in places):
        raise ValueError(f"`sensitivities` are places among the {count} numbers in `args`, from 0: not {places}")
    if initial is None:
        return dict(sensitivities=places)
    initial = np.asarray(initial)
    if initial.shape != (parts.count, len(places)):
        expected = (parts.count, len(places))
        raise ValueError(f"`initial_sensitivities` is expected to have shape {expected}, but actually has {initial.shape}.")
    columns = np.concatenate([parts.pack(column) for column in initial.T])
    return dict(sensitivities=places, initial_sensitivities=columns.tolist())


def engine_breaks(breaks, sign=1.0):
    """Times at which equations jump, along the time `sign` t."""
    return [] if breaks is None else (sign * np.atleast_1d(np.asarray(breaks, dtype=float))).tolist()


def nonnegative_places(places, parts):
    """Places of unknowns that stay at 0 or above: key for the engine."""
    if places is None:
        return {}
    if isinstance(parts, Complex):
        raise ValueError("`nonnegative` goes with real unknowns")
    places = [int(place) for place in np.ravel(places)]
    if any(not 0 <= place < parts.count for place in places):
        raise ValueError(f"`nonnegative` are places among the {parts.count} unknowns, from 0: not {places}")
    return dict(nonnegative=places)


def observer_key(observer, parts, sign=1.0):
    """An observer as a function of the engine's time, state, number of steps and part of the span; None if there is none."""
    if observer is None:
        return None
    return lambda t, y, steps, part: bool(observer(Progress(sign * t, parts.whole(y), steps, part)))


def wanted_integrals(function, given, first, whole):
    """The integrands as a function of the engine's arguments, and their number: keys for the engine.

    `first` are the arguments at the start; `whole` makes arguments of `function` of those of the engine.
    """
    if function is None:
        return {}
    bound = given.of(function)

    def values(*at):
        return np.ravel(np.asarray(bound(*whole(*at)), dtype=float))

    return dict(integrands=values, integral_count=len(values(*first, *given.last)))


def result_of(run, how, direction, t_eval, dense_output, **more):
    """The result of a run in the `direction` of t."""
    parts, method, sign, watched, jac, is_sensitive = how
    status = -1 if run.failure else int(run.ended_by_event)
    t, y = sign * run.t, parts.unpack(run.y)
    kept = slice(None)
    if t_eval is not None:
        times = t_eval[direction * t_eval <= direction * t[-1]]
        # where the solution jumps, the state after that
        kept = np.searchsorted(direction * t, direction * times, side="right") - 1
        y = parts.unpack(run.at((sign * times).tolist())) if dense_output else y[kept]
        t = times
    if is_sensitive:
        more["sensitivities"] = parts.unpack(run.sensitivities[kept]).T
    if run.integral_count > 0:
        more["integrals"] = run.integrals[kept].T
        if is_sensitive:
            more["integral_sensitivities"] = run.integral_sensitivities[kept].T
    if run.parameters.size > 0:
        more["parameters"] = run.parameters
    t_events = y_events = None
    if watched is not None:
        t_events = [[] for _ in watched]
        y_events = [[] for _ in watched]
        for number, time, state in run.events():
            t_events[number].append(sign * time)
            y_events[number].append(parts.unpack(state[None, :])[0])
        t_events, y_events = [np.asarray(t) for t in t_events], [np.asarray(y) for y in y_events]
    return OdeResult(
        t=t,
        y=y.T,
        sol=OdeSolution(run, parts.unpack, sign) if dense_output else None,
        t_events=t_events,
        y_events=y_events,
        method=method,
        methods=[MethodUse(sign * t, *use) for t, *use in run.methods],
        nfev=run.evaluations,
        njev=run.jacobian_evaluations if jac is None or callable(jac) else 0,
        nlu=run.factorizations,
        nsteps=run.steps,
        status=status,
        message=MESSAGES.get(status, run.failure),
        success=status >= 0,
        **more,
    )
