"""Runs a command of jabuka without the rest of the package, which takes longer to load. This is how the sandbox starts programs."""

import sys

# Python has put the folder of this file at the beginning of the path.
import _jabuka  # type: ignore[import-not-found]

sys.exit(_jabuka.command(["jabuka", *sys.argv[1:]]))
