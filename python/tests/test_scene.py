"""Scenes: from files, texts and mappings; values that are set; errors at their places."""

import numpy as np
import pytest
from conftest import ROOT, THROW

import jabuka


def test_a_file_a_text_and_a_mapping_give_the_same_run(tmp_path):
    (tmp_path / "throw.toml").write_text(THROW)
    ball = {"shape": {"sphere": {"radius": 0.11}}, "mass": 0.43, "location": [0, 1, 0], "velocity": [3, 9, 0]}
    of_mapping = jabuka.Scene(
        {
            "simulation": {"duration": 2, "frame_rate": 25, "gravity": np.array([0, -9.81, 0])},
            "body": {"ball": {**ball, "angular_velocity": (0, 0, np.int64(5))}},
        }
    )
    of_file = jabuka.Scene.load(tmp_path / "throw.toml")
    assert of_file.name == "throw"
    assert of_file.bodies == ("ball", "late")
    runs = [scene.run()["ball"].location for scene in (of_file, jabuka.Scene(THROW), of_mapping)]
    assert np.array_equal(runs[0], runs[1])
    assert np.array_equal(runs[0], runs[2])


def test_each_example_is_loaded():
    for path in sorted((ROOT / "scenes").glob("*.toml"))[::6]:
        assert jabuka.Scene.load(path).name == path.stem


def test_a_value_is_set_until_it_is_set_again():
    scene = jabuka.Scene(THROW.replace("-9.81", "0"))
    scene.set("body.ball.velocity", [1, 0, 0])
    other = scene.copy()
    scene.set({"body.ball.velocity": np.array([2.5, 0, 0]), "simulation.duration": "1 + 1"})
    assert scene.settings == {"body.ball.velocity": "[2.5, 0.0, 0.0]", "simulation.duration": '"1 + 1"'}
    assert scene.run()["ball"].location[-1, 0] == pytest.approx(5)
    assert other.run()["ball"].location[-1, 0] == pytest.approx(2)
    scene.set({"simulation": {"gravity": [0, 0, 0]}, "simulation.duration": 4})
    assert scene.run().times[-1] == 4


def test_all_mistakes_of_a_scene_are_in_its_error():
    with pytest.raises(jabuka.SceneError) as caught:
        jabuka.Scene('[body.ball]\nshape.sphere.raduis = 1\nvelocity = ["3 + q", 0, 0]\n')
    error = caught.value
    assert [one.code for one in error.diagnostics] == ["unknown-key", "unknown-name"]
    assert (error.code, error.line, error.column) == ("unknown-key", 2, 14)
    assert error.first.span == jabuka.Span("scene.toml", 2, 14, 2, 20, "did you mean `radius`?")
    assert error.fix == (jabuka.Edit(jabuka.Span("scene.toml", 2, 14, 2, 20), "radius"),)
    assert "scene.toml:2:14" in str(error)


def test_a_wrong_value_is_refused_and_the_old_one_stays():
    scene = jabuka.Scene(THROW)
    with pytest.raises(jabuka.SceneError) as caught:
        scene.set("body.ball.velocty", [1, 0, 0])
    assert caught.value.first.span.file == "--set"
    with pytest.raises(jabuka.SceneError, match="expected a number greater than 0"):
        scene.set("body.ball.mass", -1.0)
    with pytest.raises(TypeError, match="cannot hold a value of the type object"):
        scene.set("body.ball.mass", object())
    assert scene.settings == {}
    assert scene.run()["ball"].location[-1, 0] == pytest.approx(6)


def test_warnings_of_a_scene_are_warnings_of_python():
    with pytest.warns(jabuka.JabukaWarning, match="has no bodies"):
        scene = jabuka.Scene("")
    assert [one.code for one in scene.warnings] == ["no-bodies"]


def test_a_missing_file_is_an_error_with_its_path():
    with pytest.raises(jabuka.SceneError, match="nowhere.toml") as caught:
        jabuka.Scene.load("nowhere.toml")
    assert caught.value.code == "cannot-read"
