"""jabuka simulates physics scenes written in TOML, and renders them with POV-Ray.

>>> import jabuka
>>> scene = jabuka.Scene.load("throw.toml")
>>> scene.set("body.ball.velocity", [3, 5, 0])
>>> run = scene.run()
>>> run["ball"].location            # m, one row for each frame
>>> run.measure("ball.speed:km/h")  # any formula of plots and labels
>>> run.still(0.5)                  # an image, which a notebook shows
"""

import os
import sys

from . import _jabuka
from .errors import (
    Diagnostic,
    Edit,
    Interrupted,
    JabukaError,
    JabukaWarning,
    RenderError,
    RunError,
    SceneError,
    Span,
)
from .pictures import Film, Still, View
from .runs import Body, Run
from .scenes import Scene
from .sweeps import Point, Sweep, sweep

__all__ = [
    "Body",
    "Diagnostic",
    "Edit",
    "Film",
    "Interrupted",
    "JabukaError",
    "JabukaWarning",
    "Point",
    "RenderError",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "Span",
    "Still",
    "Sweep",
    "View",
    "sweep",
]

# POV-Ray and ffmpeg start in a sandbox: a process gives up its rights and then becomes the program. Python without site packages starts
# fastest.
_jabuka.set_launcher(sys.executable, ["-E", "-s", "-S", os.path.join(os.path.dirname(__file__), "_launcher.py")])
