"""Scenes: a body, what surrounds it, what happens."""

import json
import os
import warnings
from dataclasses import dataclass

import numpy as np

from . import _pliant
from .errors import ModelWarning, SceneError
from .mesh import Mesh
from .motion import Equilibrium, Motion
from .optimum import Optimum
from .plain import as_json
from .progress import bar
from .reduced import ReducedModel
from .simulation import Simulation


class Scene:
    """A scene, in the words of scene files.

    ``Scene({...})`` takes the tables of a scene file as dicts, ``Scene(body=..., phase=...)`` as keywords, for which
    :mod:`pliant.words` has builders with all keys. NumPy arrays, lists, and a :class:`Mesh` for `mesh` may stand anywhere.
    All numbers are in SI units; nodes that are named by number count from 1.

    >>> import pliant
    >>> from pliant import words
    >>> scene = pliant.Scene(
    ...     gravity=[0.0, -9.8],
    ...     body=words.body(
    ...         mesh=words.mesh_rectangle(size=[0.1, 0.02], nodes=[6, 2], cells="triangles6"),
    ...         thickness=0.01,
    ...         material=words.material(density=1000.0, young=1e6, poisson=0.4, viscosity=0.0),
    ...     ),
    ...     phase=words.phase(until=0.1, hold=words.hold(nodes="left")),
    ... )
    >>> motion = scene.run(sampling=0.01)
    >>> motion.positions.shape
    (11, 33, 2)
    """

    def __init__(self, tables=None, /, *, path="scene.toml", **keywords):
        if isinstance(tables, str):
            raise TypeError("Scene takes dicts: Scene.from_toml reads files and their text")
        text = _pliant.toml_of(as_json({**(tables or {}), **keywords}))
        try:
            self._scene = _pliant.Scene(text, os.fspath(path), [])
        except SceneError as error:
            # there are no lines where there is no file
            where = f"{error.key}: " if error.key else ""
            raise SceneError(f"{where}{error.help}", error.key, error.help, None, None) from None

    @classmethod
    def _of(cls, scene):
        new = cls.__new__(cls)
        new._scene = scene
        return new

    @classmethod
    def from_toml(cls, source, set=None):
        """The scene in a file, or in a text that is no path.

        `set` gives other values to some keys, as ``{"body.material.young": 2e5, "phase.free.until": 1.5}``.
        """
        if isinstance(source, os.PathLike) or "\n" not in source:
            with open(source, encoding="utf-8") as file:
                text, path = file.read(), os.fspath(source)
        else:
            text, path = source, "scene.toml"
        return cls._of(_pliant.Scene(text, path, _values(set)))

    def with_values(self, values=None, /, **keywords):
        """The same scene with other values for some keys, which may be a path as in ``phase.free.until``."""
        return Scene._of(self._scene.with_values(_values({**(values or {}), **keywords})))

    def to_toml(self):
        """The text of the scene file."""
        return self._scene.to_toml()

    def save(self, path):
        """Writes the scene as a file, which `pliant run` takes."""
        text = self.to_toml()
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    title = property(lambda self: self._scene.title, doc="The title.")
    end = property(lambda self: self._scene.end, doc="The end of the last phase (s).")
    notes = property(lambda self: self._scene.notes, doc="What is outdated in the file.")

    @property
    def mesh(self):
        """The mesh of the body, or of all bodies if they have the same kind of cells, with its node sets."""
        scene = self._scene
        return Mesh(scene.nodes(), scene.cells(), scene.cell_kind, scene.sets())

    @property
    def bodies(self):
        """The meshes of several bodies by name, with their own numbers of nodes and node sets."""
        return {name: Mesh(*mesh) for name, *mesh in self._scene.bodies()}

    def run(self, *, sampling=None, accuracy=None, progress=None, **solver):
        """Runs the scene and returns its :class:`Motion`.

        Parameters
        ----------
        sampling : float or list, optional
            Time between samples, or times of samples (s), instead of those of `[output]`.
        accuracy : optional
            As of `[solver]`: ``"1%"``, ``0.01``. The scene is run until two runs agree to that.
        progress : bool, optional
            Whether a bar is shown; by default in terminals and notebooks.
        **solver
            Keys of `[solver]`: ``rtol``, ``method``, ``max_step`` and others.

        Ctrl-C ends the run; what was computed until then is returned, and ``motion.failure`` says so.
        """
        scene = self._scene.with_values(_settings(accuracy, solver))
        times = None if sampling is None else np.atleast_1d(np.asarray(sampling, dtype=float)).tolist()
        step = times.pop() if times and np.ndim(sampling) == 0 else None
        with bar(scene.title or "run", scene.end, progress) as show:
            motion = Motion(scene.run(show, step, None if step else times))
        for warning in motion.warnings:
            warnings.warn(warning, ModelWarning, stacklevel=2)
        if motion.failure:
            warnings.warn(motion.failure, ModelWarning, stacklevel=2)
        return motion

    def static(self, **statics):
        """The :class:`Equilibrium` of the phase that `[statics]` names; keywords are keys of that table."""
        values = [(f"statics.{key}", as_json(value)) for key, value in statics.items()]
        equilibrium = Equilibrium(*self._scene.with_values(values).equilibrium())
        for warning in equilibrium.warnings:
            warnings.warn(warning, ModelWarning, stacklevel=2)
        return equilibrium

    def advise(self, within, quantity=None, budget=None):
        """Which model, mesh, method and tolerance are enough, as `pliant advise` finds it: an :class:`Advice`.

        Parameters
        ----------
        within : float
            The error that is allowed, as a part of the quantity: 0.02.
        quantity : str, optional
            Quantity that has to be right, as in `--quantity`. Default: the whole motion.
        budget : float, optional
            Time for the search (s).
        """
        text, data = self._scene.advise(within, quantity, budget)
        return Advice(text, json.loads(data))

    def fit(self, measured, unknowns, *, static=False):
        """Fits keys of the scene to measurements, as `pliant fit` does: a :class:`Fit`.

        Parameters
        ----------
        measured : dict of arrays, or a DataFrame
            The times (s) in ``t`` or ``time``, or as the index of a DataFrame; readings by the names of sensors: ``tip.y``.
        unknowns : dict
            The least and the most of each key: ``{"body.material.young": (1e5, 5e5)}``.
        static : bool
            Whether the rows are equilibria. There are no times then: columns that are no sensors are keys of the scene with their values
            there, ``phase.blow.pressure.value``.
        """
        limits = [(key, float(least), float(most)) for key, (least, most) in unknowns.items()]
        if static:
            values = [(str(name), [as_json(value) for value in column]) for name, column in dict(measured).items()]
            return Fit._of(self._scene.fit_at_rest(values, limits))
        return Fit._of(self._scene.fit(*_measurements(measured), limits))

    def gradient(self, of=None, by=(), *, measured=None, static=False, method=None, check=False):
        """Derivatives of what the scene does by some of its numbers, as `pliant gradient` finds them: a :class:`SceneGradient`.

        Parameters
        ----------
        of : str
            The quantity: ``"tip.y"``, which is its value at the end, ``"tip.y:max"``, ``"com.y:frequency"``.
        by : list of str
            Keys of the numbers: ``["body.material.young", "phase.push.load.force.2"]``.
        measured : dict of arrays, or a DataFrame
            In place of a quantity the sum of the squares of what sensors read less this, as in :meth:`fit`.
        static : bool
            Of the equilibrium.
        method : str, optional
            ``"adjoint"``, ``"same-steps"`` or ``"differences"``.
        check : bool
            With differences of whole runs beside the derivatives.
        """
        if (of is None) == (measured is None):
            raise ValueError("a gradient is of a quantity, as of='tip.y', or of squares by measured={...}")
        if measured is not None and static:
            raise ValueError("squares of equilibria are for the command: pliant gradient --static --data")
        times, columns = ([], []) if measured is None else _measurements(measured)
        by = [by] if isinstance(by, str) else [str(key) for key in by]
        text, data = self._scene.gradient(of, times, columns, bool(static), by, method, bool(check))
        found = SceneGradient(text, json.loads(data))
        for key, warning in found.warnings.items():
            warnings.warn(f"the derivative by {key} means little: {warning}", ModelWarning, stacklevel=2)
        return found

    def optimize(self, of, by, *, maximize=False, goals=None, static=False):
        """The numbers with which a quantity is least, or largest, or with which quantities reach goals, as `pliant optimize` finds them: an
        :class:`~pliant.optimum.Optimum`.

        Parameters
        ----------
        of : str or list of str
            The quantity, as in :meth:`gradient`: ``"tip.y"``; several with goals.
        by : dict
            The least and the most of each number: ``{"body.material.young": (1e5, 5e5)}``.
        maximize : bool
            As large as it can be.
        goals : float or list of float
            As near to these values as they can be.
        static : bool
            Of the equilibrium.
        """
        if maximize and goals is not None:
            raise ValueError("a quantity is made large or brought to a goal: give `maximize` or `goals`")
        of = [of] if isinstance(of, str) else [str(name) for name in of]
        goals = None if goals is None else np.atleast_1d(np.asarray(goals, dtype=float)).tolist()
        limits = [(str(key), float(least), float(most)) for key, (least, most) in by.items()]
        text, data = self._scene.optimize(of, limits, bool(maximize), goals, bool(static))
        found = Optimum(text, json.loads(data))
        for key, warning in found.data["warnings"]:
            warnings.warn(f"the derivative by {key} means little: {warning}", ModelWarning, stacklevel=2)
        return found

    def as_torch(self, of, by, *, static=False):
        """A function of PyTorch, with gradients: from a tensor of the numbers `by` to a tensor of the quantities `of`, as in :meth:`gradient`.

        Each call finds the derivatives, too, one :meth:`gradient` for each quantity.
        """
        from .torch import function

        return function(self, of, by, static=static)

    def as_jax(self, of, by, *, static=False):
        """The same of JAX, for `jax.grad`, `jax.jacrev` and `jax.jit`: from an array of the numbers `by` to one of the quantities `of`.

        Arrays of JAX have single precision unless ``jax.config.update("jax_enable_x64", True)`` was called.
        """
        from .jax import function

        return function(self, of, by, static=static)

    def chart(self, directory, methods=None, rtol=(1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8), repetitions=3):
        """Charts speed against accuracy, as `pliant chart` does: chart.svg, .png, .md and .csv in `directory`.

        Returns the table of the fastest method for each accuracy, in Markdown.
        """
        os.makedirs(directory, exist_ok=True)
        return self._scene.chart(os.fspath(directory), methods, [float(r) for r in rtol], repetitions)

    def reduced(self, model):
        """The same scene by a reduced model of it: a :class:`ReducedModel`, or the path of its file; by all its unknowns with None."""
        if isinstance(model, (str, os.PathLike)):
            path = os.path.abspath(model)
            return Scene._of(self._scene.reduced(None)).with_values({"solver.reduced": path})
        if model is not None and not isinstance(model, ReducedModel):
            raise TypeError(f"a reduced model is a ReducedModel or the path of a file, not {type(model).__name__}")
        return Scene._of(self._scene.reduced(model and model._reduced))

    def half(self, axis):
        """The half of the same scene below its middle along an `axis`, ``"x"``, ``"y"`` or ``"z"``, if it is symmetric; all of it with None.

        Of both halves it is the one that the sensors are on. They read what they would read of the whole; energies and forces are those of
        the half.
        """
        return self.with_values({"solver.half": axis or ""})

    def in_plane(self, axis):
        """The section across an `axis` of the same scene in space, if it is the same all along it, in a plane; all of space with None.

        It is in plane strain where both ends are held along the axis, and else in plane stress. Nodes, displacements and sensors without a
        component have the other two axes.
        """
        return self.with_values({"solver.plane": axis or ""})

    def start(self, **solver) -> Simulation:
        """The scene in motion under the control of a program: a :class:`Simulation`."""
        return Simulation(self._scene.with_values(_settings(None, solver)).start())

    def __repr__(self):
        return f"<pliant.Scene {self.title!r}: {self.mesh!r}, {self.end} s>"


@dataclass(frozen=True)
class Advice:
    """What is enough for a scene: in words (`text`, printed), and as `data`, with the keys of `advice.json`."""

    text: str
    data: dict

    def __str__(self):
        return self.text

    @property
    def enough(self):
        """The cheapest candidate that is right: model, error, what to set. None if there is none."""
        return self.data["enough"]


@dataclass(frozen=True)
class Fit:
    """Keys that were fitted: in words (`text`, printed), their `values`, and the half widths of intervals of 95 % confidence.

    `rms` has the root mean square of what is left over by sensors: in the middle of the ranges, and at the values.
    """

    text: str
    values: dict
    half_widths: dict
    rms: dict

    @classmethod
    def _of(cls, fitted):
        text, found, columns = fitted
        return cls(text, {key: value for key, value, _ in found}, {key: half for key, _, half in found}, dict(columns))

    def __str__(self):
        return self.text


@dataclass(frozen=True)
class SceneGradient:
    """Derivatives of an objective by numbers of a scene: in words (`text`, printed), and as `data`, with the keys of gradient.json.

    ``float(gradient["body.material.young"])`` is one of them; `derivatives`, `errors` and `at` are arrays in the order of `by`.
    """

    text: str
    data: dict

    def __str__(self):
        return self.text

    def __getitem__(self, key):
        return self.data["gradient"][key]["value"]

    value = property(lambda self: self.data["value"], doc="The objective.")
    unit = property(lambda self: self.data["unit"], doc="Its unit.")
    by = property(lambda self: list(self.data["gradient"]), doc="The keys of the numbers.")
    derivatives = property(lambda self: self._column("value"), doc="The derivatives.")
    errors = property(lambda self: self._column("error"), doc="Their estimated errors.")
    at = property(lambda self: self._column("at"), doc="The numbers.")

    @property
    def warnings(self):
        """Why derivatives mean little, by keys, where they do."""
        return {key: one["warning"] for key, one in self.data["gradient"].items() if one["warning"]}

    def _column(self, word):
        return np.array([one[word] for one in self.data["gradient"].values()])


def _measurements(measured):
    """Times (s), and columns with their names."""
    columns = {str(name): np.asarray(values, dtype=float).tolist() for name, values in dict(measured).items()}
    times = [columns.pop(name) for name in ("t", "time") if name in columns]
    if hasattr(measured, "index") and not times:
        times = [np.asarray(measured.index, dtype=float).tolist()]
    if len(times) != 1:
        raise ValueError("measurements have their times (s) in one column, t or time")
    if any(len(values) != len(times[0]) for values in columns.values()):
        raise ValueError("all columns of measurements are as long as their times")
    return times[0], list(columns.items())


def _values(values):
    return [(key, as_json(value)) for key, value in (values or {}).items()]


def _settings(accuracy, solver):
    """Keys of `[solver]` as values that replace those of the scene."""
    values = {"accuracy": accuracy, **solver}
    return _values({f"solver.{key}": value for key, value in values.items() if value is not None})
