"""Krylov methods, which solve the linear systems of Newton's iteration without their matrix."""

from typing import Callable, NamedTuple

import numpy as np

from .equations import Complex


class Krylov(NamedTuple):
    """A Krylov method for `krylov` of the integrators: it needs products of the Jacobian with vectors alone.

    It is for systems with too many unknowns for a factorization.

    >>> import pliant
    >>> solution = pliant.solve_ivp(lambda t, y: -100.0 * y, (0.0, 1.0), np.ones(50), "bdf", krylov=pliant.Krylov("gmres"), rtol=1e-8)
    >>> bool(np.abs(solution.y[:, -1]).max() < 1e-5)
    True
    """

    #: ``"gmres"``, ``"fgmres"``, ``"bicgstab"``, ``"tfqmr"``, or ``"cg"`` for symmetric definite Newton matrices.
    method: str = "gmres"
    #: Iterations allowed, 1 to 1000; those of ``"gmres"`` and ``"fgmres"`` are the dimensions of their subspace.
    iterations: int = 5
    #: How often ``"gmres"`` and ``"fgmres"`` may restart from the point they have reached.
    restarts: int = 0
    #: ``products(t, y, v, *args)`` returns df/dy v; ``products(t, y, yp, v, *args)`` of a residual the pair dF/dy v, dF/dy' v.
    #: By default, differences.
    products: Callable | None = None
    #: ``"ilu"``, the incomplete factorization ILU(0) on `jac_sparsity`, a sparse `jac`, or `lband` and `uband`; or
    #: ``preconditioner(t, y, gamma, *args)``, that returns a function ``solve(r)`` whose value is nearly x of
    #: (1 - gamma df/dy) x = r; ``preconditioner(t, y, yp, cj, *args)`` of a residual, for (dF/dy + cj dF/dy') x = r.
    preconditioner: Callable | str | None = None
    #: The side on which the preconditioner is applied, ``"left"`` or ``"right"``; ``"ida"`` and residuals have the left alone,
    #: ``"fgmres"`` the right alone.
    side: str = "left"
    #: Error allowed to a linear system, relative to that allowed to Newton's iteration; 0.05 by default.
    tolerance_factor: float | None = None
    #: ``transposed(t, y, v, *args)`` returns (df/dy)^T v, which :func:`gradient` needs; ``transposed(t, y, yp, v, w, *args)`` of a residual
    #: (dF/dy)^T v + (dF/dy')^T w.
    transposed: Callable | None = None


def krylov_key(krylov, jac, given, parts, mass=None, is_residual=False, goes_back=False):
    """A Krylov method, or its name, as a dict for the engine; None if there is none. A gradient `goes_back`."""
    if krylov is None:
        return None
    if mass is not None:
        raise ValueError("with `mass` linear systems are solved by their matrix: leave out `krylov`, or give a residual")
    krylov = Krylov(krylov) if isinstance(krylov, str) else krylov
    if not isinstance(krylov, Krylov):
        raise TypeError(f"`krylov` is a pliant.Krylov or the name of its method, not {krylov!r}")
    if isinstance(parts, Complex):
        raise ValueError("`krylov` goes with real unknowns: give real and imaginary parts")
    if krylov.side not in ("left", "right"):
        raise ValueError(f"the side of a preconditioner is \"left\" or \"right\", not {krylov.side!r}")
    is_ilu = krylov.preconditioner == "ilu"
    if not is_ilu and krylov.preconditioner is not None and not callable(krylov.preconditioner):
        raise ValueError(f"the preconditioner of a Krylov is \"ilu\" or a function, not {krylov.preconditioner!r}")
    if goes_back and krylov.transposed is None:
        raise ValueError("a gradient with `krylov` needs the products of the transposed Jacobian: give `transposed` of pliant.Krylov")
    if goes_back and callable(krylov.preconditioner):
        raise ValueError("a gradient needs a preconditioner of the transposed matrix, too: \"ilu\" is one, a function is not")
    if jac is not None and not is_ilu:
        raise ValueError("with `krylov` the preconditioner \"ilu\" alone uses `jac`: give its products with vectors by `products`")
    products = given.of(krylov.products)
    return krylov._replace(
        products=_of_residual(products) if is_residual else products,
        preconditioner=None if is_ilu else given.of(krylov.preconditioner),
        transposed=given.of(krylov.transposed),
    )._asdict() | dict(ilu=is_ilu, right=krylov.side == "right")


def _of_residual(products):
    """Products of dF/dy + cj dF/dy'."""
    if products is None:
        return None

    def combined(t, y, yp, v, cj, *p):
        by_y, by_yp = products(t, y, yp, v, *p)
        return np.asarray(by_y, dtype=float) + cj * np.asarray(by_yp, dtype=float)

    return combined
