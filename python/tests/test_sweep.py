"""Studies on the cores of this machine, and by Dask."""

import os
import signal
from pathlib import Path

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


def test_bad_studies(study, tmp_path):
    study.write_text(STUDY.replace("young", "yuong"))
    with pytest.raises(pliant.SceneError, match="yuong"):
        pliant.sweep(study, directory=tmp_path / "rows")
    assert not (tmp_path / "rows").exists()


def test_dask_computes_each_row_once_though_a_worker_is_killed(study, tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            first = next(iter(client.run(os.getpid).values()))
            os.kill(first, signal.SIGKILL)
            swept = pliant.sweep(study, client, directory=tmp_path / "rows")
    assert (swept.rows, swept.missing) == (12, 0)
    assert len(set(swept.table["id"])) == 12 and len(list(Path(tmp_path / "rows/rows").glob("*.json"))) == 12
