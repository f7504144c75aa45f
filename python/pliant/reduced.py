"""Reduced models: scenes in a few unknowns."""

import json
import os
import warnings

import numpy as np

from .errors import ModelWarning


class ReducedModel:
    """A scene in a few unknowns, learned from its own motion: what :func:`reduce` returns, and `Scene.reduced` takes.

    `str` has the table of what was tried, and what was chosen.
    """

    def __init__(self, reduced):
        self._reduced = reduced

    unknowns = property(lambda self: self._reduced.unknowns, doc="Number of unknowns.")
    cells = property(lambda self: self._reduced.cells, doc="Number of cells whose forces are computed; 0 where these are exact along the shapes.")
    error = property(lambda self: self._reduced.error, doc="Largest error of a displacement where it was checked, as a part of the largest one.")
    is_estimate = property(lambda self: self.data["is_estimate"], doc="Whether the error is what runs by the model told, as it was checked with none of all unknowns.")
    is_within = property(lambda self: self._reduced.is_within, doc="Whether that is within what was wanted.")

    @property
    def data(self):
        """All numbers, with the keys of NAME-reduced.json."""
        return json.loads(self._reduced.data)

    @property
    def table(self):
        """What was tried, as an array of NumPy with the columns unknowns, cells, error, told and seconds."""
        kinds = [("unknowns", int), ("cells", int), ("error", float), ("told", float), ("seconds", float)]
        # JSON has no infinity, the error of a run that failed
        rows = [tuple(np.inf if row[name] is None else row[name] for name, _ in kinds) for row in self.data["tried"]]
        return np.array(rows, dtype=kinds)

    def write(self, path):
        """Writes the model as a file, which `reduced` of `[solver]` and `pliant run --reduced` take."""
        self._reduced.write(os.fspath(path))

    def write_chart(self, path, title="Reduced models"):
        """Draws error over time of all models that were tried, as SVG or PNG."""
        self._reduced.write_chart(os.fspath(path), title)

    def __str__(self):
        return str(self._reduced)

    def __repr__(self):
        return f"<pliant.ReducedModel: {self.unknowns} unknowns, {self.cells} cells, error {self.error:.2g}>"


def reduce(scene, within=0.02, *, vary=None, hold_out=2, most=64, modes=False):
    """Learns a reduced model of a scene, as `pliant reduce` does: a :class:`ReducedModel`.

    Parameters
    ----------
    scene : Scene
        What is run with all its unknowns, and learned from.
    within : float
        The largest error of a displacement that is wanted, as a part of the largest one.
    vary : dict, optional
        Keys and the ranges that the model is for, each with how many values are learned (2, the ends, without):
        ``{"phase.1.pressure.1.value": (0.0, 5e3), "phase.1.actuate.1.force": (0.0, 2.0, 4)}``.
    hold_out : int
        Points of the ranges that models are checked with, and not learned from.
    most : int
        Most unknowns of a model.
    modes : bool
        Run nothing with all unknowns: begin with equilibria, free vibrations and their derivatives, and go on with what runs by
        the model lack. The error is what these runs tell.
    """
    ranges = [(key, float(least), float(most), *(count or [None])) for key, (least, most, *count) in (vary or {}).items()]
    model = ReducedModel(scene._scene.reduce(within, ranges, hold_out, most, modes))
    if not model.is_within:
        told = f"no model of {most} unknowns at most is within {within}: the best one is off by {model.error:.2g}"
        warnings.warn(f"{told}; learn from more runs, or take more unknowns", ModelWarning, stacklevel=2)
    return model
