"""Jacobians and mass matrices, in the form of the Newton matrix."""

import numpy as np

from .equations import Complex


def newton(jac, first, pattern, lband, uband, parts, mass=None, given=None, t0=None):
    """How the Newton matrix is made: keys for the engine.

    `first` is the value of `jac` at the start `t0`, or one with nonzeros in the same places.
    """
    n = parts.count
    band = None if lband is None and uband is None else (lband or 0, uband or 0)
    if band is not None and isinstance(parts, Complex):
        raise ValueError("bands are those of real unknowns")
    is_sparse = pattern is not None if jac is None else hasattr(first, "tocsc")
    mass = _mass(mass, t0, given, parts, band, is_sparse)
    if band is not None:
        return dict(jac=None, band=band, mass=mass)
    if jac is None and pattern is None:
        return dict(jac=None, mass=mass)
    if pattern is not None:
        import scipy.sparse

        pattern = abs(scipy.sparse.csc_matrix(pattern, dtype=float))
        if pattern.shape != (n, n):
            raise ValueError(f"`jac_sparsity` is expected to have shape {(n, n)}, but actually has {pattern.shape}.")
    if jac is None:
        pattern = _pattern(pattern, parts, mass)
        return dict(jac=None, sparsity=(pattern.indptr.tolist(), pattern.indices.tolist()), mass=mass)
    if np.ndim(first) < 2 and not is_sparse:
        first = np.atleast_2d(first)
        jac = (lambda slopes: lambda *at: np.atleast_2d(slopes(*at)))(jac) if callable(jac) else first
    if np.shape(first) != (n, n):
        raise ValueError(f"`jac` is expected to have shape {(n, n)}, but actually has {np.shape(first)}.")
    if is_sparse:
        function, pattern = _sparse_jacobian(jac, first, pattern, parts, mass)
        return dict(jac=function, sparsity=(pattern.indptr.tolist(), pattern.indices.tolist()), mass=mass)
    if not callable(jac):
        matrix = parts.matrix(jac)
        return dict(jac=lambda *at: matrix, mass=mass)
    return dict(jac=lambda t, y, *more: parts.matrix(jac(t, parts.whole(y), *more)), mass=mass)


def _pattern(pattern, parts, mass):
    """`pattern`, whose entries are positive, with the diagonal and the entries of the mass matrix, by columns."""
    import scipy.sparse

    if isinstance(parts, Complex):
        pattern = scipy.sparse.kron(np.ones((2, 2)), pattern)
    if mass is not None:
        rows, columns, _ = mass
        pattern = pattern + scipy.sparse.coo_matrix((np.ones(len(rows)), (rows, columns)), shape=pattern.shape)
    pattern = scipy.sparse.csc_matrix(pattern + scipy.sparse.eye(pattern.shape[0]))
    pattern.sort_indices()
    return pattern


def _sparse_jacobian(jac, first, pattern, parts, mass):
    """As a dense one with its entries where they are at the start or where `pattern` has them; an entry elsewhere is an error."""
    import scipy.sparse

    def matrix(t, y, *more):
        value = scipy.sparse.csc_matrix(jac(t, parts.whole(y), *more) if callable(jac) else jac)
        if isinstance(parts, Complex):
            value = scipy.sparse.bmat([[value.real, -value.imag], [value.imag, value.real]], format="csc")
        return value

    places = scipy.sparse.csc_matrix((first != 0).astype(float))
    if pattern is not None:
        places = places + pattern
    pattern = _pattern(places, parts, mass)
    columns = np.repeat(np.arange(pattern.shape[0]), np.diff(pattern.indptr))

    def values(*at):
        value = matrix(*at)
        taken = np.asarray(value[pattern.indices, columns]).ravel()
        if abs(value).sum() > abs(taken).sum() * (1 + 1e-12):
            raise ValueError("`jac` has entries where it had none at the start: give all of them by `jac_sparsity`")
        return taken

    return values, pattern


def _mass(mass, t0, given, parts, band, is_sparse):
    """Rows and columns of the entries of a mass matrix, and their values or a function of t that returns them."""
    if mass is None:
        return None
    n = parts.count
    if isinstance(parts, Complex):
        raise ValueError("`mass` goes with real unknowns")
    bound = given.of(mass)
    first = bound(t0, *given.last) if callable(mass) else mass
    if hasattr(first, "tocoo"):
        if callable(mass):
            raise ValueError("a function for `mass` returns an array: the diagonal, or all of the matrix")
        first = first.tocoo()
        first.sum_duplicates()
        rows, columns, values = first.row, first.col, first.data
    else:
        first = np.asarray(first, dtype=float)
        if first.ndim == 1:
            rows = columns = np.arange(len(first))
        elif callable(mass) and first.ndim == 2:
            rows, columns = (place.ravel() for place in np.indices(first.shape))
        else:
            rows, columns = np.nonzero(np.atleast_2d(first))
        values = None if callable(mass) else first if first.ndim == 1 else first[rows, columns]
    if first.shape not in ((n,), (n, n)):
        raise ValueError(f"`mass` is expected to have shape {(n, n)}, or {(n,)} for its diagonal, but actually has {first.shape}.")
    if band is not None and np.any((rows - columns > band[0]) | (columns - rows > band[1])):
        raise ValueError("`mass` has entries outside of the band that `lband` and `uband` describe")
    if is_sparse and callable(mass) and first.ndim == 2:
        raise ValueError("with a sparse `jac` a function for `mass` returns the diagonal")
    return rows.tolist(), columns.tolist(), values.tolist() if not callable(mass) else bound
