"""Studies of many runs: one scene for many values of its keys."""

import os
import tempfile
import threading
from collections.abc import Mapping

import numpy as np

from . import _pliant
from .plain import as_json
from .progress import bar
from .scene import Scene

#: Rows in a task of HyperQueue: to start its process takes as long as some hundred small runs.
ROWS_IN_TASK = 10


class Sweep:
    """The rows of a study, in a directory with table.csv, plot.svg and sweep.html."""

    def __init__(self, directory, rows, missing, kept=None):
        self.directory, self.rows, self.missing = directory, rows, missing
        #: A temporary directory, which is there as long as this is.
        self._kept = kept

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


def sweep(
    study,
    vary=None,
    client=None,
    *,
    quantities=None,
    static=False,
    accuracy=None,
    sample=None,
    directory=None,
    cores=None,
    limit=None,
    yes=False,
    progress=None,
):
    """Computes a study, and returns its :class:`Sweep`: that of a file as `pliant sweep` takes it, or of a scene and what varies.

    Rows that are there already, from this call, another process or the command, are not computed again; Ctrl-C loses none.

    >>> import pliant
    >>> scene = pliant.Scene.from_toml("scenes/square-press.toml")
    >>> rows = pliant.sweep(scene, {"body.material.young": [5e5, 1e6]}, quantities=["com.y:end"])
    >>> len(rows.table)
    2

    Parameters
    ----------
    study : path or Scene
        The study file; or a scene, with `vary` and `quantities`.
    vary : dict
        Values of keys of the scene, all combined: a list, or a range as in a study file,
        ``{"body.material.young": {"from": 1e5, "to": 1e6, "count": 5}}``. Where `study` is a file, a client may stand here.
    quantities : list of str
        What is kept of each run of the scene: ``["tip.y:end"]``.
    static : bool
        Whether each point is an equilibrium of the scene, as :meth:`Scene.static` finds it, and not a run; quantities are ``["tip.y"]`` then.
    accuracy, sample : optional
        As in study files.
    client : dask.distributed.Client or hyperqueue.Client, optional
        Where the rows are computed: a task each by Dask, ten in a task by HyperQueue, whose tasks are processes. Its workers have to see
        `directory` and, of HyperQueue, to find `pliant`: ``cluster.client(python_env=PythonEnv(sys.executable))``. Default: on the
        cores of this machine.
    directory : path, optional
        Where rows and results are. Default: ``out/NAME-sweep``; of a scene, a temporary one that is there as long as the :class:`Sweep`.
    cores : int, optional
        How many runs there are at once on this machine. Default: one on each core, as far as they fit into memory.
    limit : int, optional
        Rows to compute at most, spread over the study.
    yes : bool
        Whether more than a million runs are meant.
    progress : bool, optional
        Whether a bar is shown; by default in terminals and notebooks.
    """
    kept = None
    if isinstance(study, Scene):
        if directory is None:
            kept = tempfile.TemporaryDirectory(prefix="pliant-sweep-")
            directory = kept.name
        directory = os.path.abspath(directory)
        name = study.title or "sweep"
        study = _study_file(study, vary, quantities, static, accuracy, sample, directory)
    else:
        if vary is not None and not isinstance(vary, Mapping):
            vary, client = None, vary
        if static or any(value is not None for value in (vary, quantities, accuracy, sample)):
            raise TypeError("a study file says what varies and what is kept: vary, quantities, static, accuracy and sample are for a Scene")
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
            by_hyperqueue = type(client).__module__.split(".")[0] == "hyperqueue"
            (_by_hyperqueue if by_hyperqueue else _by_dask)(client, study, directory, numbers, show)
    return Sweep(directory, *opened.gather(), kept)


def _study_file(scene, vary, quantities, static, accuracy, sample, directory):
    """Writes a scene and the study of it into a directory, and returns the path of the study."""
    if not isinstance(vary, Mapping) or not vary:
        raise TypeError('vary is a dict of keys and their values: {"body.material.young": [1e5, 2e5]}')
    if isinstance(quantities, str) or not quantities:
        raise TypeError('quantities are a list of what is kept of each run: ["tip.y:end"]')
    keys = [{"name": key, **(values if isinstance(values, Mapping) else {"values": list(values)})} for key, values in vary.items()]
    study = {"title": scene.title, "scene": "scene.toml", "quantities": list(quantities), "key": keys, "accuracy": accuracy, "sample": sample}
    study["static"] = static or None
    texts = {"scene.toml": scene._scene.to_toml_anywhere(), "study.toml": _pliant.toml_of(as_json(study))}
    os.makedirs(directory, exist_ok=True)
    for name, text in texts.items():
        path = os.path.join(directory, name)
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                if file.read() != text:
                    raise ValueError(f"{path} is of another study: name another directory")
        else:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
    return os.path.join(directory, "study.toml")


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


def compute_rows(study, directory, numbers):
    """Some rows, by a worker somewhere."""
    return _pliant.Sweep(study, directory, True).compute(numbers, 1)


def _by_dask(client, study, directory, numbers, show):
    """A task for each row; a row whose worker has died is given to another one."""
    from dask.distributed import as_completed

    tasks = client.map(compute_rows, [study] * len(numbers), [directory] * len(numbers), [[number] for number in numbers], pure=False)
    for done, task in enumerate(as_completed(tasks), 1):
        task.result()
        if show:
            show(done)


def _by_hyperqueue(client, study, directory, numbers, show):
    """Tasks of several rows, as each is a process of its own; what a killed one leaves is submitted again."""
    from hyperqueue import Job

    opened, done = _pliant.Sweep(study, directory, True), 0
    while numbers:
        job = Job(name="pliant-sweep", max_fails=None)
        for first in range(0, len(numbers), ROWS_IN_TASK):
            rows = numbers[first : first + ROWS_IN_TASK]
            job.function(compute_rows, args=(study, directory, rows), stdout=None, stderr=None)
        submitted = client.submit(job)
        client.wait_for_jobs([submitted], raise_on_error=False)
        open_now = set(opened.open())
        left = [number for number in numbers if number in open_now]
        if len(left) == len(numbers):
            errors = [task.error for task in client.get_failed_tasks(submitted).values()]
            raise RuntimeError(f"HyperQueue has computed none of {len(left)} rows: {errors[0] if errors else 'its tasks wrote no row'}")
        done += len(numbers) - len(left)
        numbers = left
        if show:
            show(done)
