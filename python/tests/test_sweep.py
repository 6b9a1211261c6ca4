"""Sweeps: all combinations of values, in order."""

import os
import signal

import pytest
from conftest import ROOT, THROW

import jabuka


def test_a_sweep_runs_all_combinations_in_order():
    scene = jabuka.Scene(THROW.replace("-9.81", "0"))
    values = {"body.ball.velocity": [[1, 0, 0], [2, 0, 0]], "simulation.duration": [1, 3]}
    way = jabuka.sweep(scene, values, lambda run: run["ball"].location[-1, 0])
    assert way.results == pytest.approx([1, 3, 2, 6])
    assert [point.values["simulation.duration"] for point in way] == [1, 3, 1, 3]
    assert scene.settings == {}
    table = jabuka.sweep(scene, {"simulation.duration": [1, 2]}, lambda run: {"frames": len(run), "end": run.times[-1]}).table()
    assert list(table.columns) == ["simulation.duration", "frames", "end"]
    assert table["frames"].tolist() == [26, 51]


def test_without_a_function_the_runs_are_the_results():
    runs = jabuka.sweep(jabuka.Scene(THROW), {"simulation.duration": range(1, 3)}).results
    assert [run.times[-1] for run in runs] == [1, 2]


def test_an_error_names_the_values_of_its_point():
    with pytest.raises(jabuka.SceneError) as caught:
        jabuka.sweep(jabuka.Scene(THROW), {"body.ball.mass": [1, -1]})
    assert caught.value.__notes__ == ["in the sweep, at body.ball.mass = -1"]


def test_warnings_of_runs_come_from_the_line_of_the_sweep():
    scene = jabuka.Scene(THROW)
    with pytest.warns(jabuka.JabukaWarning, match="falls below height 0") as caught:
        jabuka.sweep(scene, {"body.ball.velocity": [[1, 0, 0]]}, len)
    assert [one.filename for one in caught] == [__file__]


def test_ctrl_c_stops_all_runs():
    """The first run presses Ctrl-C at its end. The second one would take many times as long, and has no result."""
    scene = jabuka.Scene.load(ROOT / "scenes" / "two_galaxies.toml")
    ended = []

    def press(run):
        ended.append(len(run))
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        jabuka.sweep(scene, {"simulation.duration": [0.08, 900]}, press, jobs=2)
    assert ended == [3]
