"""Runs: arrays, measures, events and tables, compared with what the command exports."""

import csv
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest
from conftest import BOUNCE, ROOT, THROW

import jabuka
from jabuka import _jabuka

COLUMNS = {"location": slice(2, 5), "orientation": slice(5, 9), "velocity": slice(9, 12), "angular_velocity": slice(12, 15)}


def exported(command, tmp_path, scene, *options):
    """Returns the header and the rows of the table that the command exports of a scene."""
    (tmp_path / "scene.toml").write_text(scene)
    command("export", "scene.toml", *options, "-o", "table.csv")
    with (tmp_path / "table.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    return header, rows


def test_arrays_have_the_bits_of_the_export(command, tmp_path):
    _, rows = exported(command, tmp_path, THROW)
    run = jabuka.Scene(THROW).run()
    assert list(run) == ["ball", "late"]
    for body in run:
        of_body = {float(row[0]): row for row in rows if row[1] == body}
        for quantity, columns in COLUMNS.items():
            array = getattr(run[body], quantity)
            assert array.shape == (51, columns.stop - columns.start)
            for time, values in zip(run.times, array):
                row = of_body.get(float(time))
                expected = [float(value) for value in row[columns]] if row else [np.nan] * len(values)
                assert np.array(expected).tobytes() == values.tobytes() or not row and np.isnan(values).all()
    assert np.isnan(run["late"].location).any()


def test_tables_have_the_bits_of_the_export(command, tmp_path):
    header, rows = exported(command, tmp_path, THROW)
    run = jabuka.Scene(THROW).run()
    pandas, polars = run.table(), run.table(library="polars")
    assert list(pandas.columns) == polars.columns == header
    assert len(pandas) == len(rows)
    for number, name in enumerate(header):
        expected = [row[number] if name == "body" else float(row[number]) for row in rows]
        assert pandas[name].tolist() == polars[name].to_list() == expected


def test_events_have_the_bits_of_the_export(command, tmp_path):
    _, rows = exported(command, tmp_path, BOUNCE, "--events")
    events = jabuka.Scene(BOUNCE).run().events
    assert len(events) == len(rows) > 3
    for event, row in zip(events, rows):
        numbers = [event["time"], *event["location"], *event["normal"], *event["impulse"], event["lost"]]
        assert numbers == [float(row[0]), *map(float, row[3:])]
        assert [event["body"], event["other"]] == row[1:3] == ["ball", "ground"]
    with pytest.raises(ValueError, match="no impacts"):
        _ = jabuka.Scene(THROW).run().events


def test_measures_have_the_values_of_a_plot(command, tmp_path):
    formulas = ["energy", "ball.speed:km/h", "2*kinetic", "late.y", "max(ball.speed, 5)"]
    plot = f"\n[plot.all]\ny = {formulas}\n"
    _, rows = exported(command, tmp_path, THROW + plot, "--plot", "all")
    run = jabuka.Scene(THROW).run()
    for number, formula in enumerate(formulas):
        values = run.measure(formula)
        for value, row in zip(values, rows):
            assert np.isnan(value) if row[number + 1] == "" else value + 0.0 == float(row[number + 1])
    assert np.array_equal(run["ball"].measure("speed:km/h"), run.measure("ball.speed:km/h"))
    table = run.table("ball.speed:km/h", "2*kinetic", library="dict")
    assert list(table) == ["t [s]", "ball.speed [km/h]", "2*kinetic"]
    assert np.array_equal(table["2*kinetic"], run.measure("2*kinetic"))


def test_measures_that_the_run_did_not_record_are_simulated_again():
    run = jabuka.Scene(BOUNCE).run()
    assert run.measure("ball.impacts.ground")[-1] == len(run.events[run.events["time"] <= run.times[-1]])


def test_a_mistake_in_a_formula_is_shown_in_it():
    run = jabuka.Scene(THROW).run()
    with pytest.raises(jabuka.SceneError, match="measure:1:6") as caught:
        run.measure("1 + (bal.speed)")
    assert caught.value.first.span.label == "did you mean `ball`?"


def test_arrays_are_read_only_views_of_one_array():
    run = jabuka.Scene(THROW).run()
    location = run["ball"].location
    assert np.shares_memory(location, run.location)
    assert np.shares_memory(location, run["ball"].location)
    assert location.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        location[0, 0] = 1
    del run
    assert location[0].tolist() == [0, 1, 0]


def test_an_unknown_body_is_a_key_error():
    run = jabuka.Scene(THROW).run()
    with pytest.raises(KeyError, match="did you mean 'ball'"):
        run["bal"]
    assert "ball" in run and "bal" not in run


def test_a_breakdown_keeps_the_frames_before_it():
    scene = jabuka.Scene(
        '[simulation]\nduration = 4\n[body.ball]\nshape.sphere.radius = 0.1\n[force.f.formula]\nforce = ["1/(2 - t)^0.5", 0, 0]\n'
    )
    with pytest.raises(jabuka.RunError) as caught:
        scene.run()
    assert caught.value.line == 6
    assert 1.9 < caught.value.run.times[-1] <= 2
    with pytest.raises(ValueError, match="ended early"):
        caught.value.run.still(3)


def test_a_file_that_has_changed_is_noticed(tmp_path):
    path = tmp_path / "throw.toml"
    path.write_text(THROW)
    run = jabuka.Scene.load(path).run()
    path.write_text(THROW.replace("0.43", "0.44"))
    with pytest.raises(jabuka.SceneError, match="has changed"):
        run.measure("energy")


def test_other_threads_go_on_during_a_run():
    """The other thread stops the run. If the run held the lock of the interpreter, it would go on to its end."""
    scene = jabuka.Scene.load(ROOT / "scenes" / "two_galaxies.toml")
    begun, stop = threading.Event(), _jabuka.Stop()

    def end():
        begun.wait()
        stop.set()

    thread = threading.Thread(target=end)
    thread.start()
    run = scene._run(progress=lambda done, total: begun.set(), stop=stop)
    thread.join()
    assert 0 < len(run) < scene._core.frames


def test_an_error_of_the_progress_function_ends_the_run():
    def fail(done, total):
        assert 0 < done <= total
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        jabuka.Scene(THROW).run(progress=fail)


def test_ctrl_c_ends_a_run_and_keeps_its_frames():
    program = """
        import os, signal, warnings, jabuka
        scene = jabuka.Scene.load("two_galaxies.toml")
        pressed = []
        def press(done, total):
            if done > 1 and not pressed:
                pressed.append(done)
                os.kill(os.getpid(), signal.SIGINT)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            run = scene.run(progress=press)
        assert run.interrupted
        assert pressed[0] <= len(run) < 100, len(run)
        assert len(run[run.bodies[0]].location) == len(run.times) == len(run)
        assert any(one.category is jabuka.Interrupted for one in caught)
    """
    command = [sys.executable, "-c", textwrap.dedent(program)]
    done = subprocess.run(command, cwd=ROOT / "scenes", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
