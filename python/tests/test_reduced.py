"""Reduced models: learned, run, written, and what is refused."""

import numpy as np
import pytest

import pliant

SCENE = """
[body]
mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [7, 2], cells = "triangles6" }
thickness = 0.01
strain = "green"
material = { density = 1000.0, young = 1e5, poisson = 0.4, viscosity = 500.0 }
[[phase]]
until = 0.2
hold = { nodes = "left" }
load = { nodes = "right", total = [0.0, -0.02] }
[[phase]]
until = 0.4
gravity = [0.0, -3.0]
hold = { nodes = "left" }
"""


@pytest.fixture(scope="module")
def scene():
    return pliant.Scene.from_toml(SCENE)


def test_a_model_is_learned_and_run(scene, tmp_path):
    model = pliant.reduce(scene, 0.05)
    assert model.is_within and model.error <= 0.05 and 0 < model.unknowns < scene.mesh.nodes.size
    assert model.table["error"][-1] == model.error and str(model.unknowns) in str(model)
    full, short = (one.run(sampling=0.02).displacements for one in (scene, scene.reduced(model)))
    # the error that was found is of other samples of the same motion: twice as many
    off = np.linalg.norm(short - full, axis=2).max() / np.linalg.norm(full, axis=2).max()
    assert off <= 1.05 * model.error
    assert np.array_equal(scene.reduced(model).reduced(None).run(sampling=0.02).displacements, full)

    model.write(tmp_path / "beam.reduced")
    model.write_chart(tmp_path / "beam.svg")
    by_file = scene.run(sampling=0.02, reduced=str(tmp_path / "beam.reduced")).displacements
    assert np.array_equal(by_file, short)
    read = scene.reduced(tmp_path / "beam.reduced")
    assert np.array_equal(read.run(sampling=0.02).displacements, short)
    assert np.array_equal(read.reduced(None).run(sampling=0.02).displacements, full)
    with pytest.raises(TypeError, match="the path of a file, not int"):
        scene.reduced(3)
    other = scene.with_values({"body.material.young": 2e5})
    with pytest.raises(pliant.SceneError, match="materials differ"):
        other.run(reduced=str(tmp_path / "beam.reduced"))


def test_a_model_without_a_full_run(scene):
    model = pliant.reduce(scene, 0.1, modes=True)
    assert model.is_within and model.is_estimate and model.data["full"]["seconds"] is None
    full, short = (one.run(sampling=0.02).displacements for one in (scene, scene.reduced(model)))
    off = np.linalg.norm(short - full, axis=2).max() / np.linalg.norm(full, axis=2).max()
    assert off <= 0.1


def test_what_cannot_be_varied(scene):
    with pytest.raises(pliant.InputError, match="materials"):
        pliant.reduce(scene, vary={"body.material.young": (1e5, 2e5)})
    with pytest.raises(pliant.InputError, match="least value to the largest"):
        pliant.reduce(scene, vary={"phase.2.until": (0.5, 0.4)})
