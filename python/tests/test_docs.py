"""The code blocks of docs/python.md and of docstrings are run."""

import doctest
import json
import re
import sys
import warnings
from pathlib import Path

import pytest

import pliant
import pliant.adjoint
import pliant.dae
import pliant.ensemble
import pliant.events
import pliant.ivp
import pliant.krylov
import pliant.run
import pliant.scene

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S)


@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_blocks_of_the_page(number, tmp_path, monkeypatch):
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pliant.ModelWarning)
        exec(compile(BLOCKS[number], f"block {number + 1} of docs/python.md", "exec"), {})


MODULES = ["adjoint", "dae", "ensemble", "events", "ivp", "krylov", "run", "scene"]


@pytest.mark.parametrize("module", [sys.modules[f"pliant.{name}"] for name in MODULES])
def test_docstrings(module):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pliant.ModelWarning)
        result = doctest.testmod(module)
    assert result.attempted > 1 and result.failed == 0


def test_the_notebook(monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    notebook = json.loads((ROOT / "python/examples/finger.ipynb").read_text())
    cells = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number, cell in enumerate(notebook["cells"]):
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), f"cell {number} of finger.ipynb", "exec"), cells)
    assert abs(cells["height"][-1] - cells["wanted"](4.5)) < 1e-3
