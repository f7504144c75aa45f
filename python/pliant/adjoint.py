"""Gradients of a number that depends on a solution, by runs backward in time."""

from typing import NamedTuple

import numpy as np

from . import _pliant
from .dae import equations_of
from .equations import NOTHING, Arguments, Complex, tolerances, unknowns
from .events import event_list, watched_events
from .ivp import compiled, engine_method
from .krylov import krylov_key
from .matrices import newton


class Gradient(NamedTuple):
    """A number G and its derivatives: the result of :func:`gradient`."""

    #: G.
    value: float
    #: dG/dp, by the numbers in `args`, one after the other.
    parameters: np.ndarray
    #: dG/dy0. Where `y0` depends on parameters, ``initial_state @ dy0_dp`` adds to `parameters`. Algebraic unknowns of a
    #: DAE follow from the others, and have zeros.
    initial_state: np.ndarray


def gradient(
    fun,
    t_span,
    y0,
    args=None,
    method="bdf",
    *,
    terminal=None,
    running=None,
    events=None,
    rtol=1e-6,
    atol=1e-9,
    adjoint_atol=None,
    jac=None,
    jac_sparsity=None,
    lband=None,
    uband=None,
    krylov=None,
    mass=None,
    yp0=None,
    differential=None,
    max_steps=1_000_000,
):
    """G = terminal(T, y(T)) + integral of running(t, y) over time, and its gradient by the numbers in `args` and by `y0`.

    One run backward in time gives the derivatives by all parameters, however many.

    Parameters
    ----------
    fun : callable, or a compiled function
        ``fun(t, y, *args)`` returns y', as of :func:`solve_ivp`; with the method ``"ida"`` and without `mass` it is the residual
        ``fun(t, y, yp, *args)`` of :func:`solve_dae`.
    args : tuple of numbers and arrays
        The parameters.
    method : str
        ``"bdf"``, ``"adams"`` or ``"ida"``; ``"auto"`` is the first or, with a mass matrix, the last.
    terminal, running : callable
        ``terminal(t, y, *args)`` and ``running(t, y, *args)`` return a number, whose derivatives are then taken by central
        differences; or a number, its derivatives by y, and those by the numbers in `args`.
    events : callable, or list of them, optional
        As of :func:`solve_ivp`. Where one is terminal, the end T depends on the parameters.
    adjoint_atol : float, optional
        Absolute tolerance of the adjoint dG/dy(t) in the backward run, for which `rtol` is the relative one; the least `atol` by
        default.
    krylov : Krylov, optional
        A Krylov method, forward and backward, with its `transposed` products; its preconditioner is ``"ilu"`` or none.
    jac, jac_sparsity, lband, uband, mass, yp0, differential, rtol, atol, max_steps
        As of :func:`solve_ivp` and :func:`solve_dae`.

    >>> import pliant
    >>> end = lambda t, y, p: y[0]
    >>> found = pliant.gradient(lambda t, y, p: -p * y, (0.0, 1.0), [1.0], (2.0,), terminal=end, rtol=1e-9, atol=1e-11)
    >>> bool(abs(found.parameters[0] + np.exp(-2.0)) < 1e-7)
    True
    """
    if terminal is None and running is None:
        raise ValueError("give `terminal` or `running`, whose gradient is wanted")
    start, end = map(float, t_span)
    facts = engine_method(method)
    name = facts.name
    if not facts.has_sensitivities:
        raise ValueError(f"{method!r} has no gradient: take \"bdf\", \"adams\" or \"ida\"")
    y0, parts = unknowns(y0)
    if isinstance(parts, Complex):
        raise ValueError("the unknowns of a gradient are real numbers: give real and imaginary parts")
    if mass is not None and not facts.takes_mass:
        raise ValueError(f"{method!r} takes no mass matrix: take \"ida\"")
    given = Arguments(args, True)
    if name == "ida" and mass is None:
        equations = equations_of(fun, y0, parts, yp0, differential, jac, jac_sparsity, lband, uband, given, start)
    else:
        if yp0 is not None or differential is not None:
            raise ValueError("`yp0` and `differential` are those of a residual, with the method \"ida\" and without `mass`")
        is_compiled = hasattr(fun, "address")
        slopes = given.of(jac)
        first = slopes(start, y0, *given.last) if callable(jac) else jac
        equations = dict(
            fun=compiled(fun, parts) if is_compiled else given.of(fun),
            is_compiled=is_compiled,
            method=name,
            y0=parts.pack(y0).tolist(),
            parameters=given.parameters,
            **newton(slopes, first, jac_sparsity, lband, uband, parts, mass, given, start),
        )
    rtol, atol = tolerances(rtol, atol, parts, level=3)
    watched = watched_events(event_list(events), given, parts) or []
    solver = krylov_key(krylov, jac, given, parts, mass, is_residual=name == "ida", goes_back=True)
    asked = NOTHING | equations | dict(span=(start, end), rtol=rtol, atol=atol, events=watched, max_steps=max_steps, krylov=solver)
    adjoint_atol = min(atol) if adjoint_atol is None else float(adjoint_atol)
    return Gradient(*_pliant.gradient(asked, _valued(terminal, given), _valued(running, given), adjoint_atol))


def _valued(function, given):
    """`function` as one of (t, y, p, whether derivatives are wanted)."""
    if function is None:
        return None

    def value(t, y, p):
        return float(np.ravel(returned(t, y, p)[0])[0])

    def returned(t, y, p):
        result = function(t, y, *given.split(p))
        return result if isinstance(result, tuple) else (result,)

    def valued(t, y, p, wanted):
        found = returned(t, y, p)
        number = float(np.ravel(found[0])[0])
        if not wanted:
            return number
        if len(found) == 3:
            return number, *found[1:]
        if len(found) != 1:
            raise ValueError(f"a number is needed, or one and its derivatives by y and by the numbers in `args`, not {len(found)} values")
        by_y = _differences(lambda y: value(t, y, p), y)
        return number, by_y, _differences(lambda p: value(t, y, p), p)

    return valued


def _differences(function, at):
    """Central differences of `function` along each number of the array `at`."""
    slopes = np.empty(len(at))
    for i, number in enumerate(at):
        distance = np.finfo(float).eps ** (1 / 3) * (abs(number) or 1.0)
        ahead, behind = at.copy(), at.copy()
        ahead[i] += distance
        behind[i] -= distance
        slopes[i] = (function(ahead) - function(behind)) / (ahead[i] - behind[i])
    return slopes
