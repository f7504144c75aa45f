"""Differential-algebraic equations."""

import numpy as np

from . import _pliant
from .equations import (
    NOTHING,
    Arguments,
    Complex,
    How,
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


def solve_dae(
    fun,
    t_span,
    y0,
    yp0=None,
    t_eval=None,
    dense_output=False,
    events=None,
    args=None,
    *,
    differential=None,
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
    sensitivities=None,
    initial_sensitivities=None,
    integrands=None,
    breaks=None,
    nonnegative=None,
    check_jacobian=True,
    krylov=None,
    observed_by=None,
):
    """Integrates F(t, y, y') = 0 from `t_span[0]` to `t_span[1]` by IDA; for equations of index 1 or 0.

    Parameters
    ----------
    fun : callable
        ``fun(t, y, yp)`` returns the residual F, as many numbers as there are unknowns.
    y0, yp0 : array
        y and y' at the start, which satisfy the equations unless `differential` is given.
    differential : sequence of bool, optional
        For each unknown whether its derivative occurs in the equations. Then `y0` of the others and `yp0` (zeros by default) are
        first guesses, which are corrected so that they satisfy the equations.
    jac : callable, or pair of matrices, optional
        ``jac(t, y, yp)`` returns the pair dF/dy, dF/dy', arrays or sparse matrices. By default, differences.
    args : tuple, optional
        Further arguments of `fun`, `jac` and `events`.
    events : callable, or list of them, optional
        ``event(t, y)``, otherwise as of :func:`solve_ivp`. After an action the algebraic unknowns and the derivatives are corrected, if
        `differential` is given.
    integrands : callable, optional
        ``integrands(t, y, yp)``, otherwise as of :func:`solve_ivp`.
    t_eval, dense_output, rtol, atol, jac_sparsity, lband, uband, first_step, min_step, max_step, max_order, max_steps, breaks,
    nonnegative, check_jacobian, krylov, observed_by
        As of :func:`solve_ivp`. `jac_sparsity` tells where dF/dy or dF/dy' has entries.
    sensitivities, initial_sensitivities
        As of :func:`solve_ivp`; those of the algebraic unknowns at the start are corrected, too.

    Returns
    -------
    OdeResult
        As of :func:`solve_ivp`, with `last_yp`, y' at the last time.

    >>> import pliant
    >>> def fun(t, y, yp):                  # y1' = -y2 with y1 = y2
    ...     return [yp[0] + y[1], y[0] - y[1]]
    >>> solution = pliant.solve_dae(fun, (0.0, 1.0), [1.0, 0.0], differential=[True, False], rtol=1e-8, atol=1e-10)
    >>> bool(abs(solution.y[1, -1] - np.exp(-1.0)) < 1e-6)
    True
    """
    start, end = map(float, t_span)
    t_eval = wanted_times(t_eval, start, end)
    check_times(t_eval, dense_output, sensitivities=sensitivities, integrals=integrands)
    keys, how = asked_dae(
        fun,
        t_span,
        y0,
        yp0,
        events=events,
        args=args,
        differential=differential,
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
        sensitivities=sensitivities,
        initial_sensitivities=initial_sensitivities,
        integrands=integrands,
        breaks=breaks,
        nonnegative=nonnegative,
        check_jacobian=check_jacobian,
        krylov=krylov,
        observed_by=observed_by,
    )
    run = _pliant.solve(keys | dict(times=None if t_eval is None or dense_output else t_eval.tolist()))
    return result_of(run, how, np.sign(end - start), t_eval, dense_output, last_yp=run.last_yp)


def asked_dae(
    fun,
    t_span,
    y0,
    yp0=None,
    *,
    events=None,
    args=None,
    differential=None,
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
    """The arguments of :func:`solve_dae` as keys for the engine, and what makes its result; `args` are parameters wherever the engine
    changes them, or if `are_parameters`.
    """
    start, end = map(float, t_span)
    if hasattr(fun, "address"):
        raise TypeError("the residual is a function of Python: compiled ones are right-hand sides, for solve_ivp")
    is_sensitive = sensitivities is not None and sensitivities is not False
    events = event_list(events)
    given = Arguments(args, is_sensitive or are_parameters or have_actions(events))
    y0, parts = unknowns(y0)
    residual = equations_of(fun, y0, parts, yp0, differential, jac, jac_sparsity, lband, uband, given, start)
    limits = step_limits(start, end, first_step, min_step, max_step)
    rtol, atol = tolerances(rtol, atol, parts)
    wanted = wanted_sensitivities(sensitivities, initial_sensitivities, len(given.parameters), parts)
    watched = watched_events(events, given, parts)
    keys = NOTHING | dict(
        span=(start, end),
        rtol=rtol,
        atol=atol,
        events=watched or [],
        max_order=max_order,
        max_steps=max_steps,
        breaks=engine_breaks(breaks),
        check_jacobian=bool(check_jacobian),
        krylov=krylov_key(krylov, jac, given, parts, is_residual=True),
        observer=observer_key(observed_by, parts),
        **residual,
        **limits,
        **wanted,
        **nonnegative_places(nonnegative, parts),
        **wanted_integrals(integrands, given, (start, y0, np.array(residual["yp0"])), lambda *at: at),
    )
    return keys, How(parts, "ida", 1.0, watched, jac, is_sensitive)


def equations_of(fun, y0, parts, yp0, differential, jac, jac_sparsity, lband, uband, given, start):
    """The residual `fun` and where it starts: keys for the engine."""
    if isinstance(parts, Complex):
        raise ValueError("the unknowns of a DAE are real numbers: give real and imaginary parts")
    if differential is not None:
        differential = [bool(flag) for flag in differential]
    if yp0 is None and differential is None:
        raise ValueError("`yp0` is needed, or `differential`, which tells which unknowns may be corrected at the start")
    yp0 = np.zeros(parts.count) if yp0 is None else np.atleast_1d(np.asarray(yp0, dtype=float))
    for name, values in (("yp0", yp0), ("differential", differential)):
        if values is not None and np.shape(values) != y0.shape:
            raise ValueError(f"`{name}` is expected to have shape {y0.shape}, as `y0` has, but actually has {np.shape(values)}.")
    slopes = first = None
    if jac is not None:
        pair = given.of(jac) if callable(jac) else lambda *at: jac

        def slopes(t, y, yp, cj, *p):
            by_y, by_yp = map(_matrix, pair(t, y, yp, *p))
            return by_y + cj * by_yp

        first = sum(abs(_matrix(part)) for part in pair(start, y0, yp0, *given.last))
    return dict(
        fun=given.of(fun),
        is_compiled=False,
        method="ida",
        y0=parts.pack(y0).tolist(),
        yp0=yp0.tolist(),
        differential=differential,
        parameters=given.parameters,
        **newton(slopes, first, jac_sparsity, lband, uband, parts),
    )


def _matrix(part):
    return part if hasattr(part, "tocsc") else np.atleast_2d(np.asarray(part, dtype=float))
