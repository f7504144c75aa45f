"""Many problems on all cores."""

import os
from concurrent.futures import ThreadPoolExecutor


def ensemble(count, member):
    """The results of `count` members: ``member(k)`` makes and solves the problem of number k, and returns its result.

    Each has its own result, in the order of the numbers, whatever happens to the others: that of one that raised is its exception.
    Compiled functions are integrated on all cores at once; those of Python take turns.

    >>> import pliant
    >>> rates = [0.5, 1.0, 2.0]
    >>> results = pliant.ensemble(3, lambda k: pliant.solve_ivp(lambda t, y: -rates[k] * y, (0.0, 3.0 / rates[k]), [1.0], "bdf", rtol=1e-8))
    >>> [round(float(solution.y[0, -1]), 4) for solution in results]
    [0.0498, 0.0498, 0.0498]
    """

    def outcome(k):
        try:
            return member(k)
        except Exception as error:
            return error

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        return list(threads.map(outcome, range(count)))
