"""Sweeps: runs of one scene with several values."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from typing import Any

from . import _jabuka
from .errors import warn
from .progress import Progress, shown
from .runs import Run
from .scenes import Scene
from .tables import table_of

__all__ = ["Point", "Sweep", "sweep"]


class Point:
    """A run of a sweep, or its result."""

    def __init__(self, values: dict[str, Any], result: Any) -> None:
        self.values = values
        """The values that were set, by their keys."""
        self.result = result
        """The run, or what the function of the sweep returned for it."""

    def __repr__(self) -> str:
        values = ", ".join(f"{key}={value!r}" for key, value in self.values.items())
        return f"<Point {values}: {self.result!r}>"


class Sweep:
    """The points of a sweep, in the order of the values. The last key varies fastest."""

    def __init__(self, points: list[Point]) -> None:
        self._points = points

    def __len__(self) -> int:
        return len(self._points)

    def __iter__(self) -> Iterator[Point]:
        return iter(self._points)

    def __getitem__(self, number: int) -> Point:
        return self._points[number]

    @property
    def results(self) -> list[Any]:
        """The result of each point."""
        return [point.result for point in self._points]

    def table(self, library: str | None = None) -> Any:
        """Returns a table with a row for each point: a column for each key, then the results.

        A result that is a mapping becomes several columns; any other result is the column ``result``. ``library`` is as in
        :meth:`Run.table`.
        """
        rows = [
            {**point.values, **(point.result if isinstance(point.result, Mapping) else {"result": point.result})}
            for point in self._points
        ]
        names = list(dict.fromkeys(name for row in rows for name in row))
        return table_of({name: [row.get(name) for row in rows] for name in names}, library)

    def __repr__(self) -> str:
        return f"<Sweep: {len(self)} points>"


def sweep(
    scene: Scene | str | os.PathLike[str],
    values: Mapping[str, Iterable[Any]],
    of: Callable[[Run], Any] | None = None,
    *,
    jobs: int | None = None,
    progress: Progress = False,
) -> Sweep:
    """Runs a scene with all combinations of values, several at the same time.

    >>> flights = jabuka.sweep("throw.toml", {"variables.angle": range(10, 81, 5)}, lambda run: run["ball"].location[:, 0].max())
    >>> flights.table()

    ``values`` maps keys of the scene to their values; see :meth:`Scene.set`. ``of`` computes the result of a run. Without it, the result
    is the run itself. ``jobs`` is the number of runs at the same time, and is usually the number of processors. ``progress=True`` shows the
    number of points. Ctrl-C stops all runs.

    Raises what :meth:`Scene.set` and :meth:`Scene.run` raise, with the values of the point as a note.
    """
    base = scene if isinstance(scene, Scene) else Scene.load(scene)
    choices = [list(choice) for choice in values.values()]
    points = [dict(zip(values, chosen)) for chosen in product(*choices)]
    stop = _jabuka.Stop()

    def result(point: dict[str, Any]) -> tuple[Point, list[str]]:
        try:
            one = base.copy()
            one._set(point)
            run = one._run(stop=stop)
            # A run that was stopped early has no result.
            made = run if of is None or stop.is_set() else of(run)
            return Point(point, made), one._warnings() + run._warnings()
        except Exception as error:
            if hasattr(error, "add_note"):
                error.add_note("in the sweep, at " + ", ".join(f"{key} = {value}" for key, value in point.items()))
            raise

    done: list[Point] = []
    with shown(progress, "point") as show, ThreadPoolExecutor(jobs or os.cpu_count()) as pool:
        try:
            for point, said in pool.map(result, points):
                done.append(point)
                warn(said)
                if show is not None:
                    show(len(done), len(points))
        except BaseException:
            stop.set()
            pool.shutdown(wait=True, cancel_futures=True)
            raise
    return Sweep(done)
