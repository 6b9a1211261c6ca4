"""The command ``jabuka``, also as ``python -m jabuka``."""

import signal
import sys

from . import _jabuka


def main() -> None:
    """Runs the command line of jabuka, and exits with its code."""
    # jabuka handles Ctrl-C itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_jabuka.command(["jabuka", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
