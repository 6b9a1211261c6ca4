"""Shows how far work is."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = bool | Callable[[int, int], object]
"""``True`` shows a line on standard error, and a function is called with the numbers of done steps and of all steps."""


@contextmanager
def shown(progress: Progress, what: str) -> Iterator[Callable[[int, int], object] | None]:
    """Yields the function that shows progress, or ``None``."""
    if not isinstance(progress, bool):
        yield progress
        return
    if not progress:
        yield None
        return
    last = ""

    def show(done: int, total: int) -> None:
        nonlocal last
        line = f"{what} {done}/{total}"
        if line != last:
            sys.stderr.write(f"\r{line}")
            sys.stderr.flush()
            last = line

    try:
        yield show
    finally:
        if last:
            sys.stderr.write("\n")
