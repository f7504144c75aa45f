"""Initial value problems with the signature of SciPy."""

import warnings

import numpy as np

from . import _pliant

#: Methods by pliant's names and by SciPy's, where they mean the same: the name for the engine, whether it is implicit.
_METHODS = {
    "bdf": ("bdf", True),
    "adams": ("adams", True),
    "rosenbrock": ("rosenbrock", True),
    "esdirk": ("ESDIRK436L2SA_6_3_4", True),
    "dormand-prince": ("dormand-prince", False),
    "BDF": ("bdf", True),
    "LSODA": ("bdf", True),
    "Radau": ("ESDIRK547L2SA_7_4_5", True),
    "RK45": ("dormand-prince", False),
    "RK23": ("BOGACKI_SHAMPINE_4_2_3", False),
    "DOP853": ("VERNER_8_5_6", False),
}

#: Methods that integrate forward only.
_FORWARD = ("dormand-prince", "rosenbrock")

_MESSAGES = {
    0: "The solver successfully reached the end of the integration interval.",
    1: "A termination event occurred.",
}


class OdeResult(dict):
    """The result of :func:`solve_ivp`: a dict whose keys are attributes, too, as SciPy's.

    `t`, `y` [unknown, time], `sol` (a function of time, or None), `t_events`, `y_events`, `nfev`, `njev`, `nlu`, `nsteps`,
    `status` (0: the end is reached, 1: an event has ended it, -1: it failed), `message`, `success`.
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


def solve_ivp(
    fun,
    t_span,
    y0,
    method="RK45",
    t_eval=None,
    dense_output=False,
    events=None,
    vectorized=False,
    args=None,
    *,
    rtol=1e-3,
    atol=1e-6,
    jac=None,
    jac_sparsity=None,
    lband=None,
    uband=None,
    first_step=None,
    min_step=None,
    max_step=np.inf,
    max_order=None,
    max_steps=1_000_000,
):
    """Integrates y' = fun(t, y) from `t_span[0]` to `t_span[1]`, with the arguments and the result of SciPy's `solve_ivp`.

    Parameters
    ----------
    fun : callable, or a compiled function
        ``fun(t, y)`` returns y'. A `cfunc` of numba with the signature
        ``void(float64, CPointer(float64), CPointer(float64), CPointer(float64))``, that takes t, y, where to write y', and
        `args` as numbers, is called without Python.
    method : str
        ``"RK45"`` (default, as in SciPy), or better for stiff equations ``"bdf"``; ``"adams"``, also of CVODE, ``"esdirk"`` or any table of ARKODE by its name, ``"rosenbrock"``, and
        ``"dormand-prince"``. Names of SciPy stand for methods of the same kind: ``"BDF"`` and ``"LSODA"`` are ``"bdf"``,
        ``"Radau"`` is an ESDIRK method of order 5, ``"RK45"`` is ``"dormand-prince"``, ``"RK23"`` Bogacki and Shampine's
        method, ``"DOP853"`` Verner's of order 6.
    t_eval, dense_output, events, vectorized, args, rtol, atol, jac, jac_sparsity, lband, uband, first_step, min_step, max_step
        As in SciPy. An event may have the attributes `terminal` (True, or the number of the event that ends the run) and
        `direction`.
    max_order : int, optional
        Highest order of ``"bdf"``, ``"adams"`` and ``"rosenbrock"``.
    max_steps : int
        Steps after which the run ends with status -1.

    Returns
    -------
    OdeResult
        As in SciPy, with `nsteps` in addition.

    >>> import pliant
    >>> solution = pliant.solve_ivp(lambda t, y: -50.0 * y, (0.0, 1.0), [1.0], rtol=1e-8, atol=1e-10)
    >>> bool(abs(solution.y[0, -1]) < 1e-9)
    True
    """
    start, end = map(float, t_span)
    method = getattr(method, "__name__", method)  # a solver class of SciPy
    if method not in _METHODS and not isinstance(method, str):
        raise ValueError(f"`method` must be one of {sorted(_METHODS)} or a table of ARKODE by its name, not {method!r}")
    name, implicit = _METHODS.get(method, (method, True))
    y0 = np.atleast_1d(np.asarray(y0))
    if y0.ndim != 1:
        raise ValueError("`y0` must be 1-dimensional.")
    if not np.all(np.isfinite(y0)):
        raise ValueError("All components of the initial state `y0` must be finite.")
    if np.issubdtype(y0.dtype, np.complexfloating):
        parts = _Complex(len(y0))
    else:
        parts = _Real(len(y0))
    address = getattr(fun, "address", None)
    data = None
    if address is not None:
        data = _data(fun, args, parts)
        function = address
    else:
        if args is not None:
            try:
                args = tuple(args)
            except TypeError as error:
                raise TypeError(f"Supplied 'args' cannot be unpacked. Give a tuple: args=({args!r},)") from error
            fun = _with(fun, args)
            jac = _with(jac, args) if callable(jac) else jac
        function = parts.function(fun)
    if first_step is not None:
        if first_step <= 0:
            raise ValueError("`first_step` must be positive.")
        if first_step > abs(end - start):
            raise ValueError("`first_step` exceeds bounds.")
    if max_step <= 0:
        raise ValueError("`max_step` must be positive.")
    rtol, atol = _tolerances(rtol, atol, parts)
    times = None
    if t_eval is not None:
        t_eval = np.asarray(t_eval, dtype=float)
        if t_eval.ndim != 1:
            raise ValueError("`t_eval` must be 1-dimensional.")
        if np.any(t_eval < min(start, end)) or np.any(t_eval > max(start, end)):
            raise ValueError("Values in `t_eval` are not within `t_span`.")
        steps = np.diff(t_eval)
        if (end > start and np.any(steps <= 0)) or (end < start and np.any(steps >= 0)):
            raise ValueError("Values in `t_eval` are not properly sorted.")
        times = None if dense_output else t_eval.tolist()
    watched = _events(events, args if address is None else None, parts)
    if start == end or parts.count == 0:
        return _at_once(start, end, parts.unpack(parts.pack(y0)[None, :]), t_eval, dense_output, watched)
    # what goes forward only goes back along s = -t
    sign = -1.0 if end < start and name in _FORWARD else 1.0
    if sign < 0.0:
        function, watched, times = _reversed(function, watched, times)
        jac = (lambda slopes: lambda t, y: slopes(-t, y))(jac) if callable(jac) else jac
    jacobian, sparsity, band = None, None, None
    if implicit:
        jacobian, sparsity, band = _jacobian(jac, jac_sparsity, lband, uband, fun, sign * start, y0, parts)
        if sign < 0.0 and jacobian is not None:
            jacobian = (lambda slopes: lambda t, y: -slopes(t, y))(jacobian)
    run = _pliant.solve(
        function,
        data,
        (sign * start, sign * end),
        parts.pack(y0).tolist(),
        name,
        rtol,
        atol,
        jac=jacobian,
        sparsity=sparsity,
        band=band,
        events=watched or [],
        times=times,
        first_step=first_step,
        min_step=min_step or None,
        max_step=None if np.isinf(max_step) else float(max_step),
        max_order=max_order,
        max_steps=max_steps,
    )
    status = -1 if run.failure else int(run.ended_by_event)
    t, y = sign * run.t, parts.unpack(run.y)
    if t_eval is not None:
        reached = t[-1]
        kept = t_eval[t_eval <= reached] if end > start else t_eval[t_eval >= reached]
        direction = np.sign(end - start)
        y = parts.unpack(run.at((sign * kept).tolist())) if dense_output else y[np.searchsorted(t * direction, kept * direction)]
        t = kept
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
        nfev=run.evaluations,
        njev=run.jacobian_evaluations if jac is None or callable(jac) else 0,
        nlu=run.factorizations,
        nsteps=run.steps,
        status=status,
        message=_MESSAGES.get(status, run.failure),
        success=status >= 0,
    )


class _Real:
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


class _Complex(_Real):
    """Unknowns that are complex numbers: real parts, then imaginary parts."""

    def pack(self, y):
        return np.concatenate([np.real(y), np.imag(y)]).astype(float)

    def unpack(self, states):
        return states[:, : self.count] + 1j * states[:, self.count :]

    def whole(self, y):
        return y[: self.count] + 1j * y[self.count :]

    def function(self, fun):
        return lambda t, y: self.pack(fun(t, self.whole(y)))

    def matrix(self, jac):
        jac = np.asarray(jac)
        return np.ascontiguousarray(np.block([[np.real(jac), -np.imag(jac)], [np.imag(jac), np.real(jac)]]))


def _with(fun, args):
    return lambda t, y: fun(t, y, *args)


def _data(fun, args, parts):
    """The numbers of `args` for a compiled function, whose signature is checked."""
    if isinstance(parts, _Complex):
        raise TypeError("compiled functions take real numbers")
    signature = str(getattr(fun, "_sig", "")).replace(" ", "")
    if signature and not signature.startswith("(float64,float64*,float64*,float64*)"):
        raise TypeError(
            f"the signature of a compiled function is void(float64, CPointer(float64), CPointer(float64), CPointer(float64)), not {signature}"
        )
    return [float(number) for number in np.ravel(() if args is None else args)]


def _tolerances(rtol, atol, parts):
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
        warnings.warn(f"`rtol` is too small, setting to {least}", stacklevel=3)
        rtol = least
    atol = np.broadcast_to(atol, (parts.count,))
    count = 2 if isinstance(parts, _Complex) else 1
    return float(rtol), np.tile(atol, count).tolist()


def _events(events, args, parts):
    """Events as functions with a direction and the number of the one that ends the run; None if there are none."""
    if events is None:
        return None
    events = [events] if callable(events) else list(events)
    watched = []
    for event in events:
        last = getattr(event, "terminal", None)
        if last is None or last is False or last == 0:
            last = 0
        elif int(last) == last and last > 0:
            last = int(last)
        else:
            raise ValueError("The `terminal` attribute of each event must be a boolean or positive integer.")
        direction = int(np.sign(getattr(event, "direction", 0) or 0))
        function = event if args is None else _with(event, args)
        watched.append((_number(function, parts), direction, last))
    return watched


def _reversed(function, watched, times):
    """Function, events and times along s = -t."""
    def back(t, y):
        return -np.asarray(function(-t, y), dtype=float)

    turned = [((lambda g: lambda t, y: g(-t, y))(event), -direction, last) for event, direction, last in watched or []]
    return back, None if watched is None else turned, None if times is None else [-t for t in times]


def _number(function, parts):
    return lambda t, y: float(np.ravel(function(t, parts.whole(y)))[0])


def _jacobian(jac, pattern, lband, uband, fun, t, y0, parts):
    """A function for the Jacobian, its pattern by columns, its bandwidths."""
    n = parts.count
    if lband is not None or uband is not None:
        if isinstance(parts, _Complex):
            raise ValueError("bands are those of real unknowns")
        return None, None, (lband or 0, uband or 0)
    if jac is None:
        if pattern is None:
            return None, None, None
        import scipy.sparse

        pattern = scipy.sparse.csc_matrix(pattern)
        if pattern.shape != (n, n):
            raise ValueError(f"`jac_sparsity` is expected to have shape {(n, n)}, but actually has {pattern.shape}.")
        if isinstance(parts, _Complex):
            pattern = scipy.sparse.csc_matrix(scipy.sparse.kron(np.ones((2, 2)), pattern))
        pattern = scipy.sparse.csc_matrix(pattern + scipy.sparse.eye(pattern.shape[0]))
        pattern.sort_indices()
        return None, (pattern.indptr.tolist(), pattern.indices.tolist()), None
    first = jac(t, y0) if callable(jac) else jac
    if np.ndim(first) < 2 and not hasattr(first, "tocsc"):
        first = np.atleast_2d(first)
        jac = (lambda slopes: lambda t, y: np.atleast_2d(slopes(t, y)))(jac) if callable(jac) else first
    if hasattr(first, "tocsc"):
        return _sparse_jacobian(jac, first, parts)
    shape = np.shape(first)
    if shape != (n, n):
        raise ValueError(f"`jac` is expected to have shape {(n, n)}, but actually has {shape}.")
    if not callable(jac):
        matrix = parts.matrix(jac)
        return (lambda t, y: matrix), None, None
    return (lambda t, y: parts.matrix(jac(t, parts.whole(y)))), None, None


def _sparse_jacobian(jac, first, parts):
    """As a dense one with its entries where they are at the start; an entry elsewhere later is an error."""
    import scipy.sparse

    n = parts.count
    if first.shape != (n, n):
        raise ValueError(f"`jac` is expected to have shape {(n, n)}, but actually has {first.shape}.")

    def matrix(t, y):
        value = scipy.sparse.csc_matrix(jac(t, parts.whole(y)) if callable(jac) else jac)
        if isinstance(parts, _Complex):
            value = scipy.sparse.bmat([[value.real, -value.imag], [value.imag, value.real]], format="csc")
        return value

    size = n * (2 if isinstance(parts, _Complex) else 1)
    pattern = scipy.sparse.csc_matrix((first != 0).astype(float))
    if isinstance(parts, _Complex):
        pattern = scipy.sparse.csc_matrix(scipy.sparse.kron(np.ones((2, 2)), pattern))
    pattern = scipy.sparse.csc_matrix(pattern + scipy.sparse.eye(size))
    pattern.sort_indices()
    columns = np.repeat(np.arange(size), np.diff(pattern.indptr))

    def values(t, y):
        value = matrix(t, y)
        taken = np.asarray(value[pattern.indices, columns]).ravel()
        if abs(value).sum() > abs(taken).sum() * (1 + 1e-12):
            raise ValueError("`jac` has entries where it had none at the start: give all of them by `jac_sparsity`")
        return taken

    return values, (pattern.indptr.tolist(), pattern.indices.tolist()), None


def _at_once(t, end, y, t_eval, dense_output, watched):
    """The result where nothing changes: the span has no length, or there are no unknowns."""
    times = np.array([t] if t == end else [t, end]) if t_eval is None else t_eval
    states = np.repeat(y.T, len(times), axis=1)
    nothing = None if watched is None else [np.array([]) for _ in watched]

    class Constant:
        ts, t_min, t_max = np.array([t, end]), min(t, end), max(t, end)

        def __call__(self, at):
            return np.repeat(y.T, np.size(at), axis=1).reshape((-1, *np.shape(at)))

    return OdeResult(
        t=times, y=states, sol=Constant() if dense_output else None, t_events=nothing, y_events=nothing,
        nfev=0, njev=0, nlu=0, nsteps=0, status=0, message=_MESSAGES[0], success=True,
    )
