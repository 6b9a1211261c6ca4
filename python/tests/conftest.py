"""What several tests use."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

THROW = """
[simulation]
duration = 2
frame_rate = 25
gravity = [0, -9.81, 0]

[body.ball]
shape.sphere.radius = 0.11
mass = 0.43
location = [0, 1, 0]
velocity = [3, 9, 0]
angular_velocity = [0, 0, 5]

[body.late]
shape.box.size = [0.1, 0.2, 0.3]
start = 0.5
velocity = [0, 1, 0]
angular_velocity = [1, 2, 3]
"""

BOUNCE = """
[simulation]
duration = 2
gravity = [0, -9.81, 0]
contacts = "event-driven"

[body.ball]
shape.sphere.radius = 0.11
location = [0, 1, 0]
restitution = 0.5

[environment.ground]
height = 0
"""


@pytest.fixture
def command(tmp_path):
    """Runs the command of the package, or the program that the variable JABUKA names, in a folder of its own, and returns its result."""
    program = os.environ.get("JABUKA", Path(sys.executable).with_name("jabuka"))

    def run(*arguments, check=True):
        environment = {**os.environ, "JABUKA_CACHE_DIR": str(tmp_path / "cache")}
        return subprocess.run(
            [program, *map(str, arguments)],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=check,
        )

    return run
