"""Where the command is, which the module is compared with."""

import os
import shutil
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def command():
    """The command `pliant`: that of PLIANT_COMMAND, or one that is installed."""
    found = os.environ.get("PLIANT_COMMAND") or shutil.which("pliant")
    if not found:
        pytest.skip("set PLIANT_COMMAND to the command `pliant`")
    return str(Path(found).absolute())
