"""A bar that shows how far a run has come."""

import contextlib
import sys
import time

WIDTH = 30


@contextlib.contextmanager
def bar(title, end, wanted, unit="s"):
    """Gives a function of how far it is, of `end` in all, or None if no bar is wanted."""
    is_notebook = "ipykernel" in sys.modules
    # notebooks show stderr in red, as if it were an error
    stream = sys.stdout if is_notebook else sys.stderr
    if wanted is None:
        wanted = is_notebook or stream.isatty()
    if not wanted:
        yield None
        return
    start, shown = time.monotonic(), [False]

    def show(reached):
        part = min(reached / end, 1.0)
        spent = time.monotonic() - start
        left = spent / part - spent if part > 0 else float("inf")
        full = int(WIDTH * part)
        line = f"\r{title}: {100 * part:3.0f}%|{'#' * full}{' ' * (WIDTH - full)}| {reached:.4g}/{end:.4g} {unit}"
        print(f"{line} [{spent:.0f} s, {left:.0f} s to go]", end="", file=stream, flush=True)
        shown[0] = True

    try:
        yield show
    finally:
        if shown[0]:
            print(file=stream)
