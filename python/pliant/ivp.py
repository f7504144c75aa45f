"""Initial value problems with the signature of SciPy."""

from typing import NamedTuple

import numpy as np

from . import _pliant
from .equations import (
    MESSAGES,
    NOTHING,
    Arguments,
    Complex,
    How,
    MethodUse,
    OdeResult,
    check_times,
    engine_breaks,
    nonnegative_places,
    observer_key,
    result_of,
    step_limits,
    tolerances,
    unknowns,
    wanted_integrals,
    wanted_sensitivities,
    wanted_times,
)
from .events import event_list, have_actions, watched_events
from .krylov import krylov_key
from .matrices import newton

#: Other names of methods, SciPy's among them, and the names of the library for methods of the same kind.
_SYNONYMS = {
    "esdirk": "ESDIRK436L2SA_6_3_4",
    "BDF": "bdf",
    "LSODA": "bdf",
    "Radau": "ESDIRK547L2SA_7_4_5",
    "RK45": "dormand-prince",
    "RK23": "BOGACKI_SHAMPINE_4_2_3",
    "DOP853": "VERNER_8_5_6",
}


class EngineMethod(NamedTuple):
    """The facts of a method, from the library."""

    name: str
    is_implicit: bool
    goes_backward: bool
    takes_mass: bool
    takes_singular_mass: bool
    has_sensitivities: bool


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
    mass=None,
    sensitivities=None,
    initial_sensitivities=None,
    integrands=None,
    breaks=None,
    nonnegative=None,
    check_jacobian=True,
    krylov=None,
    observed_by=None,
):
    """Integrates y' = fun(t, y) from `t_span[0]` to `t_span[1]`, with the arguments and the result of SciPy's `solve_ivp`.

    Parameters
    ----------
    fun : callable, or a compiled function
        ``fun(t, y)`` returns y'. A `cfunc` of numba with the signature
        ``void(float64, CPointer(float64), CPointer(float64), CPointer(float64))``, that takes t, y, where to write y', and
        `args` as numbers, is called without Python.
    method : str
        ``"RK45"`` (default, as in SciPy), or better for stiff equations ``"bdf"``; ``"auto"``, which changes between explicit and
        implicit methods with the solution; ``"adams"``, also of CVODE, ``"esdirk"`` or any table of ARKODE by its name, ``"rosenbrock"``,
        and ``"dormand-prince"``. Names of SciPy stand for methods of the same kind: ``"BDF"`` and ``"LSODA"`` are ``"bdf"``,
        ``"Radau"`` is an ESDIRK method of order 5, ``"RK45"`` is ``"dormand-prince"``, ``"RK23"`` Bogacki and Shampine's
        method, ``"DOP853"`` Verner's of order 6.
    t_eval, dense_output, events, vectorized, args, rtol, atol, jac, jac_sparsity, lband, uband, first_step, min_step, max_step
        As in SciPy. An event may have the attributes `terminal` (True, or the number of the event that ends the run) and
        `direction`; or is an :class:`Event`, which may have an action that changes the state, or be a clock.
    max_order : int, optional
        Highest order of ``"bdf"``, ``"adams"``, ``"ida"`` and ``"rosenbrock"``.
    max_steps : int
        Steps after which the run ends with status -1.
    mass : array, sparse matrix, or callable, optional
        M of ``M y' = fun(t, y)``: the matrix or its diagonal, or ``mass(t)`` that returns one of them. It may be singular with
        the method ``"ida"``; unknowns without mass are corrected at the start so that their equations hold. The Runge-Kutta methods
        (``"esdirk"``, ``"Radau"``, tables of ARKODE) take a regular one.
    sensitivities : True, or sequence of int, optional
        Also computes the derivatives of y by the numbers in `args`, all or those at these places (from 0; arrays in `args` count
        with each of their numbers), by ``"bdf"``, ``"adams"`` or ``"ida"``. Conditions that `fun` switches by belong into `events`:
        the derivatives are right across these, and a switch that is none ends the run.
    initial_sensitivities : array, optional
        Those of `y0` [unknown, parameter]; zeros by default.
    integrands : callable, optional
        ``integrands(t, y)`` returns numbers whose integrals over time are computed along, with sensitivities if these are wanted, by the
        methods that have those.
    breaks : sequence of float, optional
        Times at which `fun` jumps or has a kink: a step ends just before each.
    nonnegative : sequence of int, optional
        Places of unknowns that stay at 0 or above; not by ``"rosenbrock"`` and ``"dormand-prince"``.
    check_jacobian : bool
        Whether `jac`, `jac_sparsity`, `lband` and `uband` are compared with differences now and then; switch it off for what is meant to be
        an approximation.
    krylov : Krylov or str, optional
        How implicit methods solve their linear systems without a matrix; see :class:`Krylov`.
    observed_by : callable, optional
        ``observed_by(progress)`` is called after each step, with `t`, `y`, `steps` and `part` of :class:`Progress`; the run ends, with status -1, if
        it returns true.

    Returns
    -------
    OdeResult
        As in SciPy, with `nsteps` and `method` in addition, the method that ran by the name it has here (such as
        "dormand-prince" for SciPy's "RK45", or the table of ARKODE); `methods`, with times and reasons, where ``"auto"`` changes between
        several; and `sensitivities` [unknown, parameter, time], `integrals` [integral, time] and `integral_sensitivities`
        [integral, parameter, time] if they are wanted.

    >>> import pliant
    >>> solution = pliant.solve_ivp(lambda t, y: -50.0 * y, (0.0, 1.0), [1.0], rtol=1e-8, atol=1e-10)
    >>> bool(abs(solution.y[0, -1]) < 1e-9)
    True
    >>> decay = pliant.solve_ivp(lambda t, y, p: -p * y, (0.0, 1.0), [1.0], "bdf", args=(2.0,), sensitivities=True, rtol=1e-8, atol=1e-10)
    >>> bool(abs(decay.sensitivities[0, 0, -1] + np.exp(-2.0)) < 1e-6)
    True
    """
    start, end = map(float, t_span)
    t_eval = wanted_times(t_eval, start, end)
    check_times(t_eval, dense_output, sensitivities=sensitivities, integrals=integrands)
    keys, how = asked_ivp(
        fun,
        t_span,
        y0,
        method,
        events=events,
        args=args,
        rtol=rtol,
        atol=atol,
        jac=jac,
        jac_sparsity=jac_sparsity,
        lband=lband,
        uband=uband,
        first_step=first_step,
        min_step=min_step,
        max_step=max_step,
        max_order=max_order,
        max_steps=max_steps,
        mass=mass,
        sensitivities=sensitivities,
        initial_sensitivities=initial_sensitivities,
        integrands=integrands,
        breaks=breaks,
        nonnegative=nonnegative,
        check_jacobian=check_jacobian,
        krylov=krylov,
        observed_by=observed_by,
    )
    if (start == end or how.parts.count == 0) and not how.is_sensitive:
        return _at_once(start, end, how.parts.unpack(np.array(keys["y0"])[None, :]), t_eval, dense_output, how)
    times = None if t_eval is None or dense_output else (how.sign * t_eval).tolist()
    return result_of(_pliant.solve(keys | dict(times=times)), how, np.sign(end - start), t_eval, dense_output)


def asked_ivp(
    fun,
    t_span,
    y0,
    method,
    *,
    events=None,
    args=None,
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
    mass=None,
    sensitivities=None,
    initial_sensitivities=None,
    integrands=None,
    breaks=None,
    nonnegative=None,
    check_jacobian=True,
    krylov=None,
    observed_by=None,
    are_parameters=False,
):
    """The arguments of :func:`solve_ivp` as keys for the engine, and what makes its result; `args` are parameters wherever the engine
    changes them, or if `are_parameters`.
    """
    start, end = map(float, t_span)
    facts = engine_method(method)
    name, implicit = facts.name, facts.is_implicit
    is_sensitive = sensitivities is not None and sensitivities is not False
    _check(facts, method, mass, is_sensitive, krylov)
    events = event_list(events)
    y0, parts = unknowns(y0)
    is_compiled = hasattr(fun, "address")
    given = Arguments(args, is_sensitive or is_compiled or are_parameters or have_actions(events))
    function = compiled(fun, parts) if is_compiled else parts.function(given.of(fun))
    jac = given.of(jac)
    limits = step_limits(start, end, first_step, min_step, max_step)
    rtol, atol = tolerances(rtol, atol, parts)
    wanted = wanted_sensitivities(sensitivities, initial_sensitivities, len(given.parameters), parts)
    # what goes forward only goes back along s = -t
    sign = -1.0 if end < start and not facts.goes_backward else 1.0
    watched = watched_events(events, given, parts, sign)
    if sign < 0.0:
        if is_compiled:
            raise ValueError(f"{method!r} goes forward in time: take \"bdf\" or \"esdirk\" for a compiled function")
        function = (lambda fun: lambda t, y, *p: -np.asarray(fun(-t, y, *p), dtype=float))(function)
        jac = (lambda slopes: lambda t, y, *p: slopes(-t, y, *p))(jac) if callable(jac) else jac
    matrices = {}
    if (implicit or mass is not None) and parts.count > 0 and start != end:
        first = jac(sign * start, y0, *given.last) if implicit and callable(jac) else jac
        matrices = newton(jac if implicit else None, first, jac_sparsity, lband, uband, parts, mass, given, start)
        if sign < 0.0 and matrices["jac"] is not None:
            matrices["jac"] = (lambda slopes: lambda t, y, *p: -slopes(t, y, *p))(matrices["jac"])
    keys = NOTHING | dict(
        fun=function,
        is_compiled=is_compiled,
        span=(sign * start, sign * end),
        y0=parts.pack(y0).tolist(),
        parameters=given.parameters,
        method=name,
        rtol=rtol,
        atol=atol,
        events=watched or [],
        breaks=engine_breaks(breaks, sign),
        max_order=max_order,
        max_steps=max_steps,
        check_jacobian=bool(check_jacobian),
        krylov=krylov_key(krylov, jac, given, parts, mass),
        observer=observer_key(observed_by, parts, sign),
        **limits,
        **wanted,
        **matrices,
        **nonnegative_places(nonnegative, parts),
        **wanted_integrals(integrands, given, (start, y0), lambda t, y, *p: (t, parts.whole(y), *p)),
    )
    return keys, How(parts, name, sign, watched, jac, is_sensitive)


def engine_method(method):
    """The facts of a method."""
    method = getattr(method, "__name__", method)  # a solver class of SciPy
    if not isinstance(method, str):
        raise ValueError(f"`method` is a name, such as {sorted(_SYNONYMS)}, or a table of ARKODE by its name, not {method!r}")
    return EngineMethod(*_pliant.method(_SYNONYMS.get(method, method)))


def _check(facts, method, mass, is_sensitive, krylov):
    """Refuses what the method does not have."""
    if mass is None and facts.name == "ida":
        raise ValueError("\"ida\" goes with a mass matrix here: give `mass`, take \"bdf\", or call solve_dae")
    if mass is not None and not facts.takes_mass:
        raise ValueError(f"{method!r} takes no mass matrix: take \"ida\", also for a singular one, or \"esdirk\"")
    if is_sensitive and not facts.has_sensitivities:
        raise ValueError(f"{method!r} has no sensitivities: take one of \"auto\", \"bdf\", \"adams\", \"ida\"")
    if krylov is not None and (not facts.is_implicit or facts.name == "rosenbrock"):
        raise ValueError(f"{method!r} takes no Krylov method: take one of \"auto\", \"bdf\", \"adams\", \"esdirk\"")


def compiled(fun, parts):
    """The address of a compiled function, whose signature is checked."""
    if isinstance(parts, Complex):
        raise TypeError("compiled functions take real numbers")
    signature = str(getattr(fun, "_sig", "")).replace(" ", "")
    if signature and not signature.startswith("(float64,float64*,float64*,float64*)"):
        raise TypeError(
            f"the signature of a compiled function is void(float64, CPointer(float64), CPointer(float64), CPointer(float64)), not {signature}"
        )
    return fun.address


def _at_once(t, end, y, t_eval, dense_output, how):
    """The result where nothing changes: the span has no length, or there are no unknowns."""
    times = np.array([t] if t == end else [t, end]) if t_eval is None else t_eval
    states = np.repeat(y.T, len(times), axis=1)
    nothing = None if how.watched is None else [np.array([]) for _ in how.watched]

    class Constant:
        ts, t_min, t_max = np.array([t, end]), min(t, end), max(t, end)

        def __call__(self, at):
            return np.repeat(y.T, np.size(at), axis=1).reshape((-1, *np.shape(at)))

    return OdeResult(
        t=times, y=states, sol=Constant() if dense_output else None, t_events=nothing, y_events=nothing,
        method=how.method, methods=[MethodUse(t, how.method, "as asked for")], nfev=0, njev=0, nlu=0, nsteps=0, status=0, message=MESSAGES[0], success=True,
    )
