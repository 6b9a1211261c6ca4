"""Scenes: the texts that describe what moves and what is drawn."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from typing import Any

from . import _jabuka
from .errors import Diagnostic, Interrupted, diagnostics_of, warn
from .progress import Progress, shown
from .runs import Run

__all__ = ["Scene"]


class Scene:
    """A physics scene: bodies, forces, joints, and how they are drawn.

    ``Scene`` reads the text of a scene, or a mapping with the same keys. :meth:`load` reads a file.

    >>> scene = Scene({"body": {"ball": {"shape": {"sphere": {"radius": 0.1}}, "velocity": [3, 5, 0]}}})
    >>> scene.set("simulation.duration", 2)
    >>> scene.run()["ball"].location[-1]
    array([ 6., 10.,  0.])

    Raises :class:`~jabuka.SceneError` if the text has mistakes. All of them are in its ``diagnostics``, each with its place.
    """

    def __init__(self, source: str | Mapping[str, Any], *, trust: bool = False) -> None:
        """Reads the text of a scene, or a mapping with the same keys.

        A scene from a text has no folder, so it cannot name files. ``trust`` lets the POV-Ray code of the scene access files.
        """
        text = source if isinstance(source, str) else _jabuka.toml_document(source)
        self._source: tuple[bool, str] = (False, text)
        self._trust = trust
        self._settings: dict[str, str] = {}
        self._core = self._read(self._settings)
        warn(self._warnings())

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, trust: bool = False) -> Scene:
        """Reads the scene in a file.

        ``trust`` lets the POV-Ray code of the scene access files, and its paths lead out of its folder.

        Raises :class:`~jabuka.SceneError` if the scene has mistakes or cannot be read.
        """
        scene = cls.__new__(cls)
        scene._source = (True, os.fspath(path))
        scene._trust = trust
        scene._settings = {}
        scene._core = scene._read(scene._settings)
        warn(scene._warnings())
        return scene

    def _read(self, settings: Mapping[str, str]) -> _jabuka.Scene:
        is_file, source = self._source
        read = _jabuka.Scene.from_file if is_file else _jabuka.Scene.from_text
        return read(source, [f"{key}={value}" for key, value in settings.items()], self._trust)

    def _warnings(self) -> list[str]:
        text, entries = self._core.warnings
        return [text] if entries != "[]" else []

    def set(self, key: str | Mapping[str, Any], value: Any = None) -> None:
        """Sets a value of the scene: ``scene.set("body.ball.velocity", [3, 5, 0])``.

        The value is a number, a text, a list, an array or a mapping, in the unit of the key. A text may be a formula. A mapping
        instead of a key sets several values at once. All keys are those of scene files.

        Raises :class:`~jabuka.SceneError` if the scene is wrong with the new values. Then it keeps the old ones.
        """
        self._set(key if isinstance(key, Mapping) else {key: value})
        warn(self._warnings())

    def _set(self, values: Mapping[str, Any]) -> None:
        settings = dict(self._settings)
        for key, value in values.items():
            # A value that is set later counts, so it comes last.
            settings.pop(key, None)
            settings[key] = _jabuka.toml_value(value)
        self._core = self._read(settings)
        self._settings = settings

    def copy(self) -> Scene:
        """Returns a scene with the same text and values. Values that are set in one of them do not change the other."""
        scene = Scene.__new__(Scene)
        scene._source, scene._trust, scene._core = self._source, self._trust, self._core
        scene._settings = dict(self._settings)
        return scene

    @property
    def name(self) -> str:
        """The name of the scene: its file name without the extension, or ``scene``."""
        return self._core.name

    @property
    def bodies(self) -> tuple[str, ...]:
        """The names of the bodies, in the order of the scene. A copy has a name such as ``brick[3,0]``."""
        return tuple(self._core.bodies)

    @property
    def text(self) -> str:
        """The text of the scene, without the values that were set. For a mapping, the text that was made of it."""
        return self._core.text

    @property
    def settings(self) -> dict[str, str]:
        """The values that were set, by their keys, as TOML."""
        return dict(self._settings)

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """The warnings about the scene."""
        return diagnostics_of(self._core.warnings[1])

    def run(self, *, progress: Progress = False) -> Run:
        """Simulates the scene, and returns the run.

        Other Python threads go on meanwhile. Ctrl-C ends the run, and the frames so far are returned: then ``run.interrupted`` is true,
        and there is a warning :class:`~jabuka.Interrupted`. ``progress=True`` shows the number of frames.

        Raises :class:`~jabuka.RunError` if the run breaks down. Its ``run`` has the frames before.
        """
        run = self._run(progress)
        if run.interrupted:
            message = f"the run was interrupted at t = {run.times[-1]} s; the frames so far are kept"
            warnings.warn(message, Interrupted, stacklevel=2)
        warn(run._warnings())
        return run

    def _run(self, progress: Progress = False, stop: _jabuka.Stop | None = None) -> Run:
        with shown(progress, "frame") as show:
            core = self._core.run(show, stop)
        run = Run(core, self.bodies)
        breakdown = core.breakdown
        if breakdown is not None:
            breakdown.run = run
            raise breakdown
        return run

    def __repr__(self) -> str:
        bodies, frames = len(self._core.bodies), self._core.frames
        return f"<Scene {self.name}: {bodies} {'body' if bodies == 1 else 'bodies'}, {frames} frames>"
