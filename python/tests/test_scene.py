"""Scenes and motions: the same words, numbers and errors as those of the command."""

import json
import subprocess
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest

import pliant
from pliant import words

ROOT = Path(__file__).parents[2]

BEAM = dict(
    gravity=[0.0, -9.8],
    body=dict(
        mesh=dict(kind="rectangle", size=[0.1, 0.02], nodes=[6, 2], cells="triangles6"),
        thickness=0.01,
        material=dict(density=1000.0, young=1e6, poisson=0.4, viscosity=100.0),
    ),
    phase=[dict(until=0.05, hold=dict(nodes="left"))],
    sensor=[dict(name="tip", kind="position", nodes="right")],
    output=dict(step=0.01),
)


def test_a_file_a_text_and_dicts_are_one_scene():
    written = pliant.Scene(BEAM)
    read = pliant.Scene.from_toml(written.to_toml())
    built = pliant.Scene(
        gravity=np.array([0.0, -9.8]),
        body=words.body(
            mesh=words.mesh_rectangle(size=(0.1, 0.02), nodes=np.array([6, 2]), cells="triangles6"),
            thickness=0.01,
            material=words.material(density=1000.0, young=1e6, poisson=0.4, viscosity=100.0),
        ),
        phase=words.phase(until=0.05, hold=dict(nodes="left")),
        sensor=words.sensor_position(name="tip", nodes="right"),
        output=words.output(step=0.01),
    )
    motions = [scene.run(rtol=1e-6) for scene in (written, read, built)]
    for motion in motions[1:]:
        assert np.array_equal(motion.positions, motions[0].positions)


def test_arrays_are_those_of_the_command(tmp_path, command):
    scene = pliant.Scene(BEAM)
    scene.save(tmp_path / "beam.toml")
    subprocess.run([command, "run", "beam.toml", "--rtol", "1e-6", "--out", "o", "-q"], cwd=tmp_path, check=True, capture_output=True)
    motion = scene.run(rtol=1e-6)
    rows = np.genfromtxt(tmp_path / "o/trajectory.csv", delimiter=",", names=True, deletechars="")
    assert np.array_equal(rows[rows.dtype.names[0]], motion.times)
    columns = [name for name in rows.dtype.names if name.startswith("tip")]
    assert len(columns) == 2 and len(motion.sensors) == 2
    for column, values in zip(columns, motion.sensors.values()):
        assert np.array_equal(rows[column], values)
    report = json.loads((tmp_path / "o/report.json").read_text())
    assert report["steps"] == motion.report["steps"]


def test_numbers_of_a_motion_fit_together():
    motion = pliant.Scene(BEAM).run(rtol=1e-8, sampling=1e-4)
    assert motion.positions.shape == (501, 33, 2) and len(motion) == 501
    tip = motion.mesh.nodes[:, 0] == 0.1
    places = motion.positions[:, tip].mean(axis=1)
    for axis, values in enumerate(motion.sensors.values()):
        assert np.allclose(places[:, axis], values, rtol=0, atol=1e-15)
    # what the clamp bears is the weight and the change of momentum
    weight = np.array([0.0, -9.8]) * 1000.0 * 0.1 * 0.02 * 0.01
    borne = motion.reactions.sum(axis=1) + weight
    slope = np.gradient(motion.momentum, motion.times, axis=0, edge_order=2)
    off = np.abs(borne - slope)[5:-5].max() / np.abs(weight).max()
    print(off)
    assert off < 5e-3
    balance = motion.energies["balance"]
    assert np.abs(balance - balance[0]).max() < 1e-6 * np.abs(motion.energies["kinetic"]).max()


def test_a_mesh_of_arrays_moves_as_the_generated_one():
    mesh = pliant.Scene(BEAM).mesh
    body = {**BEAM["body"], "mesh": pliant.Mesh(mesh.nodes, mesh.cells, mesh.kind, {**mesh.sets, "tip": mesh.sets["right"]})}
    listed = pliant.Scene({**BEAM, "body": body, "sensor": [dict(name="tip", kind="position", nodes="tip")]})
    assert np.array_equal(listed.run().positions, pliant.Scene(BEAM).run().positions)
    again = pliant.Scene.from_toml(listed.to_toml())
    assert np.array_equal(again.mesh.sets["tip"], mesh.sets["right"])


def test_several_bodies():
    """Bodies by name: their meshes, and their parts of arrays; what falls together keeps its distance."""
    soft = {"density": 1000.0, "young": 1e5, "poisson": 0.3, "viscosity": 10.0}
    square = {"kind": "rectangle", "size": [0.1, 0.1], "nodes": [3, 3], "cells": "triangles"}
    quadratic = {**square, "cells": "rectangles9", "origin": [0.5, 0.0]}
    scene = pliant.Scene(
        gravity=[0.0, -10.0],
        body=[
            {"name": "left", "mesh": square, "thickness": 0.01, "material": soft},
            {"name": "right", "mesh": quadratic, "thickness": 0.01, "material": soft, "velocity": [0.0, 1.0]},
        ],
        phase={"until": 0.1},
    )
    assert [len(mesh.nodes) for mesh in scene.bodies.values()] == [9, 25]
    assert scene.bodies["right"].kind == "quadrilaterals9"
    motion = scene.run()
    left, right = (motion.displacements[-1, nodes, 1] for nodes in motion.bodies.values())
    assert len(right) == 25 and abs(right - left.mean() - 0.1).max() < 1e-9
    with pytest.raises(ValueError, match="scene.bodies"):
        motion.mesh  # noqa: B018


def test_bodies_that_touch():
    """What is thrown hands on its momentum: contact forces, a sensor of the gap, and what each body feels."""
    soft = {"density": 1000.0, "young": 1e5, "poisson": 0.3, "viscosity": 10.0}
    square = {"kind": "rectangle", "size": [0.1, 0.1], "nodes": [3, 3], "cells": "triangles"}
    right = {**square, "origin": [0.11, 0.02]}
    scene = pliant.Scene(
        body=[
            {"name": "left", "mesh": square, "thickness": 0.01, "material": soft, "velocity": [1.0, 0.0]},
            {"name": "right", "mesh": right, "thickness": 0.01, "material": soft},
        ],
        touch=words.touch(name="both", distance=2e-3),
        phase={"until": 0.03},
        sensor=[
            words.sensor_gap(name="gap", touch="both"),
            words.sensor_contact_force(name="push", touch="both", body="right", component="x"),
            words.sensor_contact_area(name="area", touch="both", body="right"),
            words.sensor_contact_pressure(name="pressure", touch="both", body="right"),
        ],
    )
    motion = scene.run(sampling=np.linspace(0.0, 0.03, 16)[1:])
    assert motion.sensors["gap"].min() < 2e-3
    assert motion.sensors["push"].max() > 1.0
    nodes = motion.bodies["right"]
    pushed = motion.contact_forces[:, nodes, 0].sum(axis=1)
    assert np.allclose(pushed, motion.sensors["push"], rtol=0, atol=1e-9)
    pressures = motion.contact_pressures
    assert pressures.shape == motion.contact_status.shape == motion.positions.shape[:2]
    # the order of sums may differ
    assert np.allclose(pressures[:, nodes].max(axis=1), motion.sensors["pressure"], rtol=1e-9, atol=0)
    # without friction what touches slides
    assert (pressures > 0).any() and (motion.contact_status[pressures > 0] == 2).all()
    # half of each side, at most, is beside the other: 0.08 of 0.1 m
    assert 0 < motion.sensors["area"].max() < 0.1 * 0.01


def test_a_rigid_body_keeps_its_shape():
    bar = words.body(
        mesh=words.mesh_rectangle(size=[0.1, 0.01], nodes=[5, 2], cells="triangles"),
        thickness=0.01,
        material=words.material(density=2000.0, rigid=True),
    )
    pinned = pliant.Scene(gravity=[0.0, -9.8], body=bar, phase=dict(until=0.3, hold=dict(nodes=[1])), output=dict(step=0.1))
    x = pinned.run(rtol=1e-8).positions
    apart = np.linalg.norm(x[:, :, None] - x[:, None, :], axis=-1)
    assert np.ptp(apart, axis=0).max() < 1e-8
    assert np.linalg.norm(x[-1] - x[0], axis=-1).max() > 0.1


def test_regions_of_a_listed_mesh():
    mesh = pliant.Scene(BEAM).mesh
    half = np.flatnonzero(mesh.nodes[mesh.cells].mean(axis=1)[:, 0] > 0.05)
    stiff = words.region(group="stiff", material=words.material(density=1000.0, young=1e8, poisson=0.4))
    boxed = words.region(box=[[0.05, -1.0], [1.0, 1.0]], material=stiff["material"])

    def run(mesh, region):
        return pliant.Scene({**BEAM, "body": {**BEAM["body"], "mesh": mesh, "region": [region]}}).run().positions

    listed = pliant.Mesh(mesh.nodes, mesh.cells, mesh.kind, mesh.sets, {"stiff": half})
    assert np.allclose(run(listed, stiff), run(BEAM["body"]["mesh"], boxed), rtol=0, atol=1e-12)


def test_other_values():
    scene = pliant.Scene(BEAM)
    soft = scene.with_values({"body.material.young": 1e5, "phase.1.until": 0.02})
    assert soft.end == 0.02 and scene.end == 0.05
    assert "100000.0" in soft.to_toml()
    sampled = scene.run(sampling=[0.01, 0.03])
    assert sampled.times.tolist() == [0.0, 0.01, 0.03, 0.05]
    accurate = scene.run(accuracy="1%", sampling=0.01)
    achieved = accurate.report["achieved"]
    assert achieved["difference"] <= achieved["asked"] == 0.01


@pytest.mark.parametrize(
    "change, key, told",
    [
        (dict(body={**BEAM["body"], "thicknes": 1.0}), "body.thicknes", "thickness"),
        (dict(phase=[dict(until=-1.0)]), "phase.until", "after 0 s"),
        (dict(gravity="down"), "gravity", "list"),
        (dict(solver=dict(rtol=2.0)), "solver.rtol", ""),
        (dict(body={**BEAM["body"], "mesh": dict(kind="listed", positions=[[0, 0], [1, 0]], cells="triangles", connectivity=[[1, 2]])}), "connectivity", "3 nodes"),
        (dict(body={**BEAM["body"], "mesh": dict(kind="listed", positions=[[0, 0], [1]], cells="segments", connectivity=[[1, 2]])}), "positions", "2 numbers"),
        (dict(body={**BEAM["body"], "mesh": dict(kind="listed", positions=[[0, 0], [1, 0]], cells="segments", connectivity=[[0, 1]])}), "connectivity", "1 or above"),
    ],
)
def test_errors_name_key_and_help(change, key, told):
    with pytest.raises(pliant.SceneError) as caught:
        pliant.Scene({**BEAM, **change})
    assert caught.value.key.endswith(key) and told in caught.value.help, (caught.value.key, str(caught.value))


def test_errors_of_files_name_the_line(tmp_path):
    path = tmp_path / "scene.toml"
    text = pliant.Scene(BEAM).to_toml().replace("young = 1000000.0", "young = -1.0")
    path.write_text(text)
    with pytest.raises(pliant.SceneError) as caught:
        pliant.Scene.from_toml(path)
    assert caught.value.path == str(path)
    assert text.splitlines()[caught.value.line - 1].startswith("young")
    assert isinstance(caught.value, ValueError)


def test_what_no_scene_holds():
    with pytest.raises(TypeError, match="not object"):
        pliant.Scene({**BEAM, "title": object()})
    with pytest.raises(ValueError, match="nan"):
        pliant.Scene({**BEAM, "gravity": [0.0, float("nan")]})


def test_an_integration_that_fails_keeps_its_motion():
    with pytest.raises(pliant.IntegrationError) as caught:
        pliant.Scene.from_toml(ROOT / "scenes/ring-springs-5N.toml").run()
    failure = caught.value
    assert failure.motion.times[-1] == failure.time and 0.2 < failure.time < 0.22
    assert "spring" in str(failure)


def test_warnings_are_warnings():
    heavy = pliant.Scene({**BEAM, "body": {**BEAM["body"], "material": {**BEAM["body"]["material"], "density": 1e6}}})
    with pytest.warns(pliant.ModelWarning, match="density"):
        motion = heavy.run()
    assert motion.warnings


def test_an_equilibrium():
    beam = pliant.Scene(BEAM).with_values({"body.material.viscosity": 2e4})
    found = beam.static(load_steps=2)
    assert found.report["iterations"] > 1
    released = beam.with_values({"phase.1.until": 3.0}).run(sampling=1.0)
    tip = found.sensors["tip.y"][-1]
    assert abs(released.sensors["tip.y"][-1] - tip) < 1e-3 * abs(tip)


def test_tables_of_others(tmp_path):
    pandas = pytest.importorskip("pandas")
    motion = pliant.Scene(BEAM).run()
    table = motion.to_pandas()
    assert isinstance(table, pandas.DataFrame) and np.array_equal(table["tip.y"], motion.sensors["tip.y"])
    motion.write_csv(tmp_path / "motion.csv")
    assert len(pandas.read_csv(tmp_path / "motion.csv")) == len(table)


def test_files(tmp_path):
    motion = pliant.Scene(BEAM).run()
    motion.write_html(tmp_path / "a.html")
    motion.write_svg(tmp_path / "a.svg", [0.0, 0.05])
    motion.write_vtk(tmp_path / "vtk")
    motion.write_report(tmp_path / "r.json")
    assert json.loads((tmp_path / "r.json").read_text()) == motion.report
    assert "<script" in (tmp_path / "a.html").read_text() and "srcdoc" in motion._repr_html_()
    assert (tmp_path / "vtk/body.pvd").exists() and (tmp_path / "a.svg").stat().st_size > 1000


def test_ctrl_c_keeps_what_there_is():
    import _thread
    import signal

    # a process in the background begins without this handler
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    scene = pliant.Scene({**BEAM, "phase": [dict(until=100.0, hold=dict(nodes="left"))], "output": dict(step=1.0)})
    threading.Timer(0.5, _thread.interrupt_main).start()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        motion = scene.run(method="rk")
    signal.signal(signal.SIGINT, before)
    assert motion.failure and 0.0 < motion.times[-1] < 100.0


def test_other_threads_work_while_it_runs():
    scene = pliant.Scene({**BEAM, "phase": [dict(until=3.0, hold=dict(nodes="left"))]})
    count, running = [0], threading.Event()

    def work():
        while not running.is_set():
            count[0] += 1

    thread = threading.Thread(target=work)
    thread.start()
    scene.run(method="rk")
    running.set()
    thread.join()
    assert count[0] > 1000


def test_words_are_those_of_the_reader(command):
    schema = subprocess.run([command, "schema"], check=True, capture_output=True).stdout
    maker = ROOT / "python/make_words.py"
    made = subprocess.run(["python3", maker], input=schema, check=True, capture_output=True).stdout
    assert made.decode() == Path(words.__file__).read_text()


def test_a_modulus_is_found():
    """The command and the module give the same words; the truth lies in the interval."""
    truth = pliant.Scene(BEAM).with_values({"body.material.young": 8e5}).run(rtol=1e-6, sampling=1e-3)
    noise = np.random.default_rng(3).normal(0.0, 1e-6, len(truth))
    fit = pliant.Scene(BEAM).fit({"t": truth.times, "tip.y": truth.sensors["tip.y"] + noise}, {"body.material.young": (5e5, 2e6)})
    young, half = fit.values["body.material.young"], fit.half_widths["body.material.young"]
    assert abs(young - 8e5) < 2 * half < 4e4 and "young" in str(fit)
    assert fit.rms["tip.y"][1] < 1.5e-6 < fit.rms["tip.y"][0]
    with pytest.raises(pliant.InputError, match="tip.y"):
        pliant.Scene(BEAM).fit({"t": [0.01], "top.y": [0.0]}, {"body.material.young": (5e5, 2e6)})
    with pytest.raises(ValueError, match="t or time"):
        pliant.Scene(BEAM).fit({"tip.y": [0.0]}, {"body.material.young": (5e5, 2e6)})


def test_a_fit_to_equilibria():
    """A beam under several weights, each a list."""
    scene = pliant.Scene(BEAM)
    weights = [[0.0, -1.0], [0.0, -5.0], [0.0, -9.8]]
    truth = scene.with_values({"body.material.young": 8e5})
    tips = [truth.with_values(gravity=weight).static().sensors["tip.y"][-1] for weight in weights]
    fit = scene.fit({"gravity": weights, "tip.y": tips}, {"body.material.young": (5e5, 2e6)}, static=True)
    assert abs(fit.values["body.material.young"] / 8e5 - 1.0) < 1e-6
    with pytest.raises(pliant.InputError, match="tip.y"):
        scene.fit({"gravity": weights, "tpi.y": tips}, {"body.material.young": (5e5, 2e6)}, static=True)


def test_advice():
    beam = pliant.Scene({**BEAM, "title": "a beam"})
    advice = beam.advise(0.1, "tip.y:end", budget=5.0)
    assert advice.enough["error"] < 0.1 and advice.data["accuracy"] == 0.1 and str(advice) == advice.text


def test_a_chart(tmp_path):
    table = pliant.Scene(BEAM).chart(tmp_path / "chart", methods=["rk", "arkode"], rtol=[1e-3, 1e-5], repetitions=1)
    assert "arkode" in table or "rk" in table
    assert sorted(path.name for path in (tmp_path / "chart").iterdir()) == ["chart.csv", "chart.md", "chart.png", "chart.svg"]


def test_smaller_models_read_what_the_whole_does():
    scene = pliant.Scene.from_toml("""
        [body]
        mesh = { kind = "cuboid", size = [0.2, 0.04, 0.05], nodes = [5, 2, 3], cells = "hexahedra" }
        material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 20.0 }
        [[phase]]
        until = 0.02
        hold = [{ nodes = "front", axes = ["y"] }, { nodes = "back", axes = ["y"] }]
        load = [{ nodes = "left", total = [-0.5, 0.0, 0.0] }, { nodes = "right", total = [0.5, 0.0, 0.0] }]
        [[sensor]]
        name = "end"
        kind = "position"
        nodes = "right"
        component = "x"
        [solver]
        rtol = 1e-8
    """)
    plane = scene.in_plane("y")
    assert plane.mesh.nodes.shape == (15, 2) and plane.half("x").mesh.nodes.shape == (9, 2)
    assert plane.in_plane(None).mesh.nodes.shape == (30, 3)
    end = scene.run().sensors["end"][-1]
    for smaller in (plane, scene.half("x")):
        # to some errors of the steps
        assert abs(smaller.run().sensors["end"][-1] - end) < 1e-8 * end
    with pytest.raises(pliant.SceneError, match="solver.plane"):
        scene.in_plane("x")


def test_a_gradient():
    scene = pliant.Scene.from_toml(
        """
        body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 20.0 } }
        phase = { name = "pull", until = 0.05, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
        sensor = { name = "tip", kind = "displacement", nodes = "right" }
        """
    )
    force, young = "phase.pull.load.force.1", "body.material.young"
    found = scene.gradient("tip.x", by=[force, young])
    # the bar is linear
    assert found.by == [force, young] and abs(found[force] * 0.1 / found.value - 1.0) < 1e-6
    assert found.derivatives.shape == (2,) and (found.errors < 1e-5 * abs(found.derivatives)).all()
    assert found.unit == "m" and not found.warnings and "adjoint" in str(found)
    still = scene.gradient("tip.x", by=young, static=True)
    assert abs(still[young] + still.value / 1e5) <= still.errors[0] + 1e-17
    squares = scene.gradient(by=young, measured={"t": [0.05], "tip.x": [0.0]})
    assert abs(squares[young] / (2.0 * found.value * found[young]) - 1.0) < 1e-5
    with pytest.raises(pliant.InputError, match="tip.z"):
        scene.gradient("tip.z", by=young)
    with pytest.raises(ValueError, match="of a quantity"):
        scene.gradient(by=young)
