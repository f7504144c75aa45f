"""The environment of gymnasium."""

import runpy
import warnings
from pathlib import Path

import pytest

pytest.importorskip("gymnasium")
EXAMPLE = Path(__file__).parents[1] / "examples/gym_ring.py"


def test_gymnasium_finds_nothing_wrong_and_a_search_finds_something_better():
    from gymnasium.utils.env_checker import check_env

    example = runpy.run_path(str(EXAMPLE))
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        check_env(example["Ring"](), skip_render_check=True)
    ways = example["search"](rounds=2, candidates=4)
    assert ways[-1] >= ways[0]
