"""Plots over time, and the progress bar."""

import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from pliant.motion import Equilibrium, Motion
from pliant.progress import bar


def motion():
    """Two pressures, a mass and an angle, as a run would have them."""
    return Motion(
        SimpleNamespace(
            times=lambda: np.array([0.0, 1.0]),
            centre_of_mass=lambda: np.zeros((2, 2)),
            energy_names=lambda: ["kinetic"],
            energies=lambda: np.array([[0.0], [7.0]]),
            sensor_names=[("p", "Pa"), ("gas", "kg"), ("q", "Pa"), ("turn", "rad")],
            sensors=lambda: np.array([[0.0, 1e-6, 5.0, 0.1], [1e4, 2e-6, 6.0, 0.2]]),
        )
    )


def test_each_unit_has_an_axis_of_its_own():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    axes = motion().plot()
    labels = {one.get_ylabel(): [line.get_label() for line in one.lines] for one in axes.figure.axes}
    assert labels == {"Pa": ["p", "q"], "kg": ["gas"], "rad": ["turn"]}
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["p", "gas", "q", "turn"]
    assert len({line.get_color() for one in axes.figure.axes for line in one.lines}) == 4
    plt.close(axes.figure)

    figure, given = plt.subplots()
    assert motion().plot("energy kinetic", "centre of mass y", axes=given) is given
    assert [one.get_ylabel() for one in figure.axes] == ["J", "m"]
    plt.close(figure)
    with pytest.raises(KeyError, match="'none' is none of"):
        motion().plot("none")


def test_load_curves_are_drawn_over_their_factor():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    curve = motion()._motion
    curve.sensor_names[0] = ("load factor", "1")
    axes = Equilibrium(curve, "{}").plot()
    assert axes.get_xlabel() == "load factor (1)"
    assert [line.get_label() for line in axes.lines] == ["gas"]
    assert list(axes.lines[0].get_xdata()) == [0.0, 1e4]
    plt.close(axes.figure)


@pytest.mark.parametrize("is_notebook", [False, True])
def test_notebooks_get_the_bar_on_stdout(is_notebook, capsys, monkeypatch):
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    if is_notebook:
        monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    with bar("run", 2.0, None if is_notebook else True) as show:
        show(1.0)
    out, err = capsys.readouterr()
    shown, silent = (out, err) if is_notebook else (err, out)
    assert "50%" in shown and silent == ""
