"""Studies of many runs: one scene for many values of its keys."""

import os
import threading

import numpy as np

from . import _pliant
from .progress import bar


class Sweep:
    """The rows of a study, in a directory with table.csv, plot.svg and sweep.html."""

    def __init__(self, directory, rows, missing):
        self.directory, self.rows, self.missing = directory, rows, missing

    @property
    def table(self):
        """table.csv as an array of NumPy with the names of its columns."""
        path = os.path.join(self.directory, "table.csv")
        return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8", deletechars="", replace_space=" ")

    def to_pandas(self):
        """table.csv as a DataFrame of pandas, by id."""
        import pandas

        return pandas.read_csv(os.path.join(self.directory, "table.csv"), index_col="id")

    def __repr__(self):
        left = f", {self.missing} are not there yet" if self.missing else ""
        return f"<pliant.Sweep in {self.directory!r}: {self.rows} rows{left}>"


def sweep(study, client=None, *, directory=None, cores=None, limit=None, yes=False, progress=None):
    """Computes a study, a file as `pliant sweep` takes it, and returns its :class:`Sweep`.

    Rows that are there already, from this call, another process or the command, are not computed again; Ctrl-C loses none.

    Parameters
    ----------
    study : path
        The study file.
    client : dask.distributed.Client, optional
        Where the rows are computed: one task each. Its workers have to see `directory`. Default: on the cores of this machine.
    directory : path, optional
        Where rows and results are. Default: ``out/NAME-sweep``.
    cores : int, optional
        How many runs there are at once on this machine. Default: one on each core, as far as they fit into memory.
    limit : int, optional
        Rows to compute at most, spread over the study.
    yes : bool
        Whether more than a million runs are meant.
    progress : bool, optional
        Whether a bar is shown; by default in terminals and notebooks.
    """
    study = os.path.abspath(study)
    name = os.path.splitext(os.path.basename(study))[0]
    directory = os.path.abspath(directory or os.path.join("out", f"{name}-sweep"))
    opened = _pliant.Sweep(study, directory, yes)
    opened.check()
    numbers = opened.open()[:limit]
    with bar(name, max(len(numbers), 1), progress, unit="rows") as show:
        if client is None:
            _here(opened, numbers, cores, show)
        else:
            _there(client, study, directory, numbers, show)
    return Sweep(directory, *opened.gather())


def _here(opened, numbers, cores, show):
    """On the cores of this machine, in another thread, so that Ctrl-C is heard."""
    ended, failure = threading.Event(), []

    def count(done):
        if show:
            show(done)
        if ended.is_set():
            raise KeyboardInterrupt

    def compute():
        try:
            opened.compute(numbers, cores, count)
        except BaseException as error:
            failure.append(error)

    thread = threading.Thread(target=compute)
    thread.start()
    try:
        while thread.is_alive():
            thread.join(0.1)
    except KeyboardInterrupt:
        ended.set()
        thread.join()
    if failure:
        raise failure[0]


def compute_row(study, directory, number):
    """One row, by a worker somewhere."""
    return _pliant.Sweep(study, directory, True).compute([number], 1)


def _there(client, study, directory, numbers, show):
    """By the workers of a client of Dask."""
    from dask.distributed import as_completed

    tasks = client.map(compute_row, [study] * len(numbers), [directory] * len(numbers), numbers, pure=False)
    for done, task in enumerate(as_completed(tasks), 1):
        task.result()
        if show:
            show(done)
