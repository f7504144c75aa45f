"""Studies on the cores of this machine, by Dask and by HyperQueue."""

import contextlib
import os
import signal
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import pliant

SCENE = """
gravity = [0.0, -9.8]
[body]
mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [6, 2], cells = "triangles" }
thickness = 0.01
material = { density = 1000.0, young = 1e6, poisson = 0.4, viscosity = 100.0 }
[[phase]]
until = 0.05
hold = { nodes = "left" }
[[sensor]]
name = "tip"
kind = "position"
nodes = "right"
"""
STUDY = """
scene = "beam.toml"
quantities = ["tip.y:end"]
[[key]]
name = "body.material.young"
from = 5e5
to = 2e6
count = 12
"""


@pytest.fixture
def study(tmp_path):
    (tmp_path / "beam.toml").write_text(SCENE)
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path / "study.toml"


def test_rows_are_runs(study, tmp_path):
    some = pliant.sweep(study, directory=tmp_path / "rows", limit=5)
    assert (some.rows, some.missing) == (5, 7)
    table = pliant.sweep(study, directory=tmp_path / "rows").table
    assert len(table) == 12 and set(table["verdict"]) <= {"fine", "doubtful"}
    for row in table[::5]:
        motion = pliant.Scene.from_toml(tmp_path / "beam.toml", set={"body.material.young": row["body.material.young"]}).run()
        assert motion.sensors["tip.y"][-1] == row["tip.y:end"]


def test_rows_are_equilibria(tmp_path):
    scene = pliant.Scene.from_toml(SCENE)
    vary = {"body.material.young": [5e5, 2e6]}
    rows = pliant.sweep(scene, vary, quantities=["tip.y"], static=True, directory=tmp_path / "rest")
    for row in rows.table:
        found = scene.with_values({"body.material.young": row["body.material.young"]}).static()
        assert found.sensors["tip.y"][-1] == row["tip.y"]
    with pytest.raises(TypeError, match="static"):
        pliant.sweep(tmp_path / "rest" / "study.toml", static=True)


def test_a_scene_without_a_file(study, tmp_path):
    """The rows of a scene and what varies are those of the same study from a file."""
    by_file = pliant.sweep(study, directory=tmp_path / "rows").table
    scene = pliant.Scene.from_toml(SCENE)
    vary = {"body.material.young": {"from": 5e5, "to": 2e6, "count": 12}}
    rows = pliant.sweep(scene, vary, quantities=["tip.y:end"], directory=tmp_path / "scene")
    assert (rows.rows, rows.missing) == (12, 0)
    for name in ("body.material.young", "tip.y:end"):
        assert list(rows.table[name]) == list(by_file[name])
    # in a temporary directory, over two keys, with values of the scene that are no more those of its text
    heavy = scene.with_values({"body.material.density": 2e3})
    few = pliant.sweep(heavy, {"body.material.young": np.array([5e5, 1e6]), "phase.until": [0.02, 0.05]}, quantities=["tip.y:end"])
    assert len(few.table) == 4
    for row in few.table:
        values = {"body.material.young": row["body.material.young"], "phase.1.until": row["phase.until"]}
        assert heavy.with_values(values).run().sensors["tip.y"][-1] == row["tip.y:end"]
    with pytest.raises(ValueError, match="another study"):
        pliant.sweep(heavy, vary, quantities=["tip.y:end"], directory=tmp_path / "scene")
    with pytest.raises(TypeError, match="quantities"):
        pliant.sweep(scene, vary)
    with pytest.raises(TypeError, match="vary is a dict"):
        pliant.sweep(scene, quantities=["tip.y:end"])
    with pytest.raises(TypeError, match="for a Scene"):
        pliant.sweep(study, vary)


def test_a_scene_whose_mesh_is_in_a_file(tmp_path):
    """Files that it names are found from wherever its rows are."""
    (tmp_path / "beam.msh").write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"left\"\n$EndPhysicalNames\n"
        "$Nodes\n4\n1 0 0 0\n2 0.1 0 0\n3 0.1 0.1 0\n4 0 0.1 0\n$EndNodes\n"
        "$Elements\n3\n1 1 2 1 1 4 1\n2 2 2 0 1 1 2 3\n3 2 2 0 1 1 3 4\n$EndElements\n"
    )
    start, rest = SCENE.split("mesh = ")
    text = f'{start}mesh = {{ kind = "gmsh", file = "beam.msh" }}\n' + rest.split("\n", 1)[1].replace('"right"', "2")
    (tmp_path / "beam.toml").write_text(text)
    scene = pliant.Scene.from_toml(tmp_path / "beam.toml")
    rows = pliant.sweep(scene, {"body.material.young": [5e5, 1e6]}, quantities=["tip.y:end"])
    assert (rows.rows, rows.missing) == (2, 0) and np.isfinite(rows.table["tip.y:end"]).all()


def test_bad_studies(study, tmp_path):
    study.write_text(STUDY.replace("young", "yuong"))
    with pytest.raises(pliant.SceneError, match="yuong"):
        pliant.sweep(study, directory=tmp_path / "rows")
    assert not (tmp_path / "rows").exists()


@pytest.fixture
def many(study):
    """A study of 200 short rows."""
    (study.parent / "beam.toml").write_text(SCENE.replace("until = 0.05", "until = 0.005"))
    study.write_text(STUDY.replace("count = 12", "count = 200"))
    return study


@contextlib.contextmanager
def killed_in_the_middle(rows, process):
    """Kills a process, whose number is called for when 55 files of `rows` are there, in the middle of a task, while the block goes on."""
    killed = []

    def kill():
        while len(list(rows.glob("*.json"))) < 55 and not ended.is_set():
            time.sleep(0.01)
        while not killed and not ended.is_set():
            with contextlib.suppress(ProcessLookupError, StopIteration):
                number = next(process())
                os.kill(number, signal.SIGKILL)
                killed.append(number)

    ended = threading.Event()
    thread = threading.Thread(target=kill)
    thread.start()
    try:
        yield killed
    finally:
        ended.set()
        thread.join()


def has_each_row_once(swept, rows, killed):
    """All of 200 rows are there, and a process was killed before the last one was."""
    assert len(killed) == 1
    assert (swept.rows, swept.missing) == (200, 0)
    assert len(set(swept.table["id"])) == 200 and len(list(rows.glob("*.json"))) == 200


def test_dask_computes_each_row_once_though_a_worker_is_killed(many, tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    rows = tmp_path / "rows/rows"
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            workers = list(client.run(os.getpid).values())
            with killed_in_the_middle(rows, lambda: iter(workers)) as killed:
                swept = pliant.sweep(many, client, directory=tmp_path / "rows")
    has_each_row_once(swept, rows, killed)


def tasks_of_hyperqueue():
    """Numbers of the processes in which tasks of HyperQueue's workers run."""
    for number in filter(str.isdigit, os.listdir("/proc")):
        # others may have ended by now
        with contextlib.suppress(OSError):
            if b"hyperqueue.task.function" in Path("/proc", number, "cmdline").read_bytes():
                yield int(number)


def test_hyperqueue_computes_each_row_once_though_a_task_is_killed(many, tmp_path):
    hyperqueue = pytest.importorskip("hyperqueue")
    cluster_of, function = pytest.importorskip("hyperqueue.cluster"), pytest.importorskip("hyperqueue.task.function")
    rows = tmp_path / "rows/rows"
    with hyperqueue.LocalCluster() as cluster:
        for _ in range(2):
            cluster.start_worker(cluster_of.WorkerConfig(cores=1))
        client = cluster.client(python_env=function.PythonEnv(sys.executable))
        with killed_in_the_middle(rows, tasks_of_hyperqueue) as killed:
            swept = pliant.sweep(many, client, directory=tmp_path / "rows")
    has_each_row_once(swept, rows, killed)


def test_tasks_of_hyperqueue_that_fail(study, tmp_path):
    """A client whose tasks run in a Python without `pliant` ends with the reason, not with rows that lack."""
    hyperqueue = pytest.importorskip("hyperqueue")
    cluster_of, function = pytest.importorskip("hyperqueue.cluster"), pytest.importorskip("hyperqueue.task.function")
    with hyperqueue.LocalCluster(worker_config=cluster_of.WorkerConfig(cores=1)) as cluster:
        client = cluster.client(python_env=function.PythonEnv("no-python"))
        with pytest.raises(RuntimeError, match="none of 12 rows"):
            pliant.sweep(study, client, directory=tmp_path / "rows")
