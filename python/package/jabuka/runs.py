"""Runs: the simulated motion of scenes, as arrays, tables and pictures."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _jabuka
from .errors import Diagnostic, diagnostics_of, warn
from .pictures import Film, Still, View
from .progress import Progress, shown
from .tables import table_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Body", "Run"]

_EVENT = np.dtype(
    [
        ("time", "f8"),
        ("body", "O"),
        ("other", "O"),
        ("location", "f8", 3),
        ("normal", "f8", 3),
        ("impulse", "f8", 3),
        ("lost", "f8"),
    ]
)
_COLUMNS = {
    "location": ["x [m]", "y [m]", "z [m]"],
    "orientation": ["qx", "qy", "qz", "qw"],
    "velocity": ["vx [m/s]", "vy [m/s]", "vz [m/s]"],
    "angular_velocity": ["wx [rad/s]", "wy [rad/s]", "wz [rad/s]"],
}


class _Motion:
    """The arrays that a run has of all bodies, and a body of itself."""

    def _array(self, name: str) -> NDArray[np.float64]:
        raise NotImplementedError

    @property
    def location(self) -> NDArray[np.float64]:
        """The center of mass in world axes, m. Shape: (frames, 3); of a run: (bodies, frames, 3). NaN while a body is absent."""
        return self._array("location")

    @property
    def velocity(self) -> NDArray[np.float64]:
        """The velocity of the center of mass in world axes, m/s. Shape: (frames, 3); of a run: (bodies, frames, 3)."""
        return self._array("velocity")

    @property
    def orientation(self) -> NDArray[np.float64]:
        """The rotation from body axes to world axes, as quaternions x, y, z, w. Shape: (frames, 4); of a run: (bodies, frames, 4)."""
        return self._array("orientation")

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """The angular velocity in world axes, rad/s. Shape: (frames, 3); of a run: (bodies, frames, 3)."""
        return self._array("angular_velocity")

    @property
    def force(self) -> NDArray[np.float64]:
        """The sum of all forces in world axes, N. Shape: (frames, 3); of a run: (bodies, frames, 3)."""
        return self._array("force")


class Body(_Motion):
    """The motion of one body of a run. Its arrays are read-only views of the arrays of the run."""

    def __init__(self, run: Run, name: str, number: int) -> None:
        self._run, self._number = run, number
        self.name = name
        """The name of the body in the scene."""

    def _array(self, name: str) -> NDArray[np.float64]:
        view: NDArray[np.float64] = self._run._array(name)[self._number]
        return view

    def measure(self, quantity: str) -> NDArray[np.float64]:
        """A measure of the body in each frame, such as ``speed`` or ``kinetic:mJ``. Shape: (frames,). See :meth:`Run.measure`."""
        return self._run.measure(f"{self.name}.{quantity}")

    def __repr__(self) -> str:
        return f"<Body {self.name}>"


class Run(_Motion):
    """A simulated run: the state of each body in each frame. ``Scene.run`` makes it.

    ``run["ball"]`` is the motion of a body. All arrays are read-only, share the memory of the run, and are read when they are first asked
    for.
    """

    def __init__(self, core: _jabuka.Run, bodies: tuple[str, ...]) -> None:
        self._core = core
        self._bodies = {name: number for number, name in enumerate(bodies)}

    def _array(self, name: str) -> NDArray[np.float64]:
        return self._core.array(name)

    def _warnings(self) -> list[str]:
        text, entries = self._core.warnings
        return [text] if entries != "[]" else []

    @property
    def bodies(self) -> tuple[str, ...]:
        """The names of the bodies, in the order of the scene."""
        return tuple(self._bodies)

    @property
    def times(self) -> NDArray[np.float64]:
        """The times of the frames, s. Shape: (frames,)."""
        return self._core.times

    @property
    def drift(self) -> float:
        """The largest energy error of the run, relative to an energy of the scene. It measures the error of the integration."""
        return self._core.drift

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C has ended the run."""
        return self._core.interrupted

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """The warnings about the motion, such as bodies that pass through each other, or energy that drifts."""
        return diagnostics_of(self._core.warnings[1])

    def __getitem__(self, name: str) -> Body:
        """Returns the motion of a body."""
        number = self._bodies.get(name)
        if number is None:
            near = _jabuka.nearest(name, list(self._bodies))
            hint = f"; did you mean {near!r}?" if near else "; `run.bodies` lists all"
            raise KeyError(f"the scene has no body {name!r}{hint}")
        return Body(self, name, number)

    def __contains__(self, name: object) -> bool:
        return name in self._bodies

    def __iter__(self) -> Iterator[str]:
        return iter(self._bodies)

    def __len__(self) -> int:
        """Returns the number of frames."""
        return self._core.frames

    def measure(self, formula: str) -> NDArray[np.float64]:
        """The value of a formula in each frame. Shape: (frames,).

        The formula is written as in plots and labels: ``energy``, ``ball.speed``, ``ball.speed:km/h``, ``joint.hinge.angle``,
        ``max(brick.speed)``, ``kinetic + potential``. ``jabuka list measures`` lists all measures with their units. NaN where a value is
        not known, such as the speed of an absent body.

        Raises :class:`~jabuka.SceneError` if the formula has a mistake.
        """
        return self._core.measure([formula])[0][0]

    @property
    def events(self) -> NDArray[np.void]:
        """The impacts of the run, in order of time, as a structured array.

        Its fields are ``time`` (s), the names ``body`` and ``other``, the contact point ``location`` (m), the unit ``normal`` from ``body`` to
        ``other``, the ``impulse`` on ``other`` (N·s), and the kinetic energy that is ``lost`` (J). The ground has the name ``ground``.

        Raises ``ValueError`` if the scene has no contacts.
        """
        first, second, numbers = self._core.events()
        events = np.empty(len(first), _EVENT)
        events["time"], events["lost"] = numbers[:, 0], numbers[:, 10]
        events["body"], events["other"] = first, second
        for start, name in (1, "location"), (4, "normal"), (7, "impulse"):
            events[name] = numbers[:, start : start + 3]
        return events

    def table(self, *formulas: str, library: str | None = None) -> Any:
        """Returns a table of pandas or polars.

        Without formulas, it has a row for each frame and present body, and the columns of ``jabuka export``. With formulas, it has a row for
        each frame, a column of the time, and a column for each formula, with its unit. See :meth:`measure`.

        ``library`` is ``"pandas"``, ``"polars"``, or ``"dict"`` for a dictionary of arrays. Without it, pandas is used if it is installed,
        then polars.
        """
        if formulas:
            columns: dict[str, Any] = {"t [s]": self.times}
            for formula, (values, unit) in zip(formulas, self._core.measure(list(formulas))):
                name = formula.rpartition(":")[0].strip() if unit and ":" in formula else formula
                columns[f"{name} [{unit}]" if unit else name] = values
            return table_of(columns, library)
        present = ~np.isnan(self.location[:, :, 0]).T
        frames, bodies = np.nonzero(present)
        columns = {"t [s]": self.times[frames], "body": np.array(self.bodies, dtype=object)[bodies]}
        for quantity, names in _COLUMNS.items():
            values = self._array(quantity)[bodies, frames]
            columns.update({name: values[:, number] for number, name in enumerate(names)})
        return table_of(columns, library)

    def still(
        self,
        time: float = 0.0,
        *,
        size: tuple[int, int] | None = None,
        quality: str = "good",
        view: str | None = None,
        povray: str | os.PathLike[str] | None = None,
        progress: Progress = False,
    ) -> Still:
        """Renders the image of a moment with POV-Ray. A notebook shows it.

        ``time`` (s) need not be the time of a frame. ``size`` is width and height in pixels, ``quality`` is ``"draft"``, ``"good"`` or
        ``"final"``, ``view`` is the name of a view of the scene, and ``povray`` the path of POV-Ray.

        Raises :class:`~jabuka.RenderError` if POV-Ray is missing or fails.
        """
        with shown(progress, "image") as show:
            png, said = self._core.still(
                time,
                size=None if size is None else list(size),
                quality=quality,
                view=view,
                povray=povray,
                progress=show,
            )
        warn(said)
        return Still(time, png)

    def view(self, *, height: int = 480) -> View:
        """Returns the run as a page, which a notebook shows ``height`` pixels high.

        The page plays the run, turns the camera, plots energies, and shows the values of the body that one clicks. It holds the data of the
        run, so it also works in a saved notebook, and without a network. If bodies times frames exceed 100,000, it leaves out the values of
        single bodies.

        Raises ``ValueError`` if the run ended early, and :class:`~jabuka.RenderError` if it is too large for a browser.
        """
        return View(self._core.page(), height)

    def film(
        self,
        path: str | os.PathLike[str],
        *,
        size: tuple[int, int] | None = None,
        quality: str = "good",
        view: str | None = None,
        povray: str | os.PathLike[str] | None = None,
        progress: Progress = False,
        rate: float | None = None,
        every: int = 1,
        folder: str | os.PathLike[str] | None = None,
    ) -> Film:
        """Renders all frames with POV-Ray, and makes a film of them with ffmpeg: ``.mp4``, ``.webm`` or ``.gif``. A notebook shows it.

        ``rate`` is the number of frames per second of the film. ``every`` renders every n-th frame. ``folder`` keeps scripts and images, so
        that the next film renders only what has changed. The other options are those of :meth:`still`.

        Raises :class:`~jabuka.RenderError` if POV-Ray or ffmpeg are missing or fail.
        """
        with shown(progress, "image") as show:
            said = self._core.film(
                path,
                size=None if size is None else list(size),
                quality=quality,
                view=view,
                povray=povray,
                progress=show,
                rate=rate,
                every=every,
                folder=folder,
            )
        warn(said)
        return Film(path)

    def __repr__(self) -> str:
        frames, end = len(self), self.times[-1]
        early = ", interrupted" if self.interrupted else ""
        return f"<Run: {len(self._bodies)} bodies, {frames} frames to t = {end} s{early}>"
