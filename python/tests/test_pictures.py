"""Stills and films by POV-Ray and ffmpeg, as notebooks show them."""

import html
import subprocess

import pytest
from conftest import THROW

import jabuka


def size_of(path):
    """Returns width, height and number of frames of a film."""
    asked = ["-count_frames", "-show_entries", "stream=width,height,nb_read_frames", "-of", "csv=p=0"]
    told = subprocess.run(["ffprobe", "-v", "error", *asked, str(path)], capture_output=True, text=True, check=True)
    return [int(number) for number in told.stdout.strip().split(",")]


def test_a_still_is_the_image_of_the_command(command, tmp_path):
    (tmp_path / "scene.toml").write_text(THROW)
    command("still", "scene.toml", "--time", 0.71, "--size", "64x48", "-o", "still.png")
    still = jabuka.Scene(THROW).run().still(0.71, size=(64, 48))
    assert still._repr_png_() == still.png == (tmp_path / "still.png").read_bytes()
    still.save(tmp_path / "saved.png")
    assert (tmp_path / "saved.png").read_bytes() == still.png


def test_a_film_shows_itself(tmp_path):
    run = jabuka.Scene(THROW).run()
    seen = []
    film = run.film(
        tmp_path / "film.mp4",
        size=(64, 48),
        quality="draft",
        every=10,
        folder=tmp_path / "scripts",
        progress=lambda done, total: seen.append((done, total)),
    )
    assert size_of(film.path) == [64, 48, 6]
    assert (6, 6) in seen
    shown = film._repr_mimebundle_()
    assert shown["text/html"].startswith('<video controls loop src="data:video/mp4;base64,')
    assert len(list((tmp_path / "scripts" / "images").glob("*.png"))) == 6


def test_pictures_that_cannot_be_made_are_errors(tmp_path):
    run = jabuka.Scene(THROW).run()
    with pytest.raises(jabuka.RenderError, match="no-such-povray") as caught:
        run.still(povray=tmp_path / "no-such-povray")
    assert caught.value.code == "no-povray"
    with pytest.raises(jabuka.RenderError, match="no view `side`"):
        run.still(view="side")
    with pytest.raises(jabuka.RenderError, match="film.avi"):
        run.film(tmp_path / "film.avi")
    with pytest.raises(ValueError, match="from 0 to 2 s"):
        run.still(2.5)
    with pytest.raises(ValueError, match="no quality `best`"):
        run.still(quality="best")


def test_pov_ray_is_confined(tmp_path):
    """Even that of a trusted scene writes only in the folders of its results."""
    victim = tmp_path / "victim.txt"
    victim.write_text("keep")
    sdl = f'#fopen F "{victim}" write\n#write (F, "gone")\n#fclose F'
    run = jabuka.Scene(f"povray.sdl = '''\n{sdl}\n'''\n{THROW}", trust=True).run()
    with pytest.raises(jabuka.RenderError, match="Cannot open user file") as caught:
        run.still(size=(32, 24))
    assert caught.value.code == "outside-sandbox"
    assert victim.read_text() == "keep"


def test_warnings_about_pictures_are_warnings_of_python(tmp_path):
    """The first film wrote the script, then the user has edited it."""
    run = jabuka.Scene(THROW).run()
    options = {"size": (32, 24), "quality": "draft", "every": 50, "folder": tmp_path / "scripts"}
    run.film(tmp_path / "film.gif", **options)
    script = tmp_path / "scripts" / "frame_0000.pov"
    script.write_text(script.read_text() + "// mine\n")
    with pytest.warns(jabuka.JabukaWarning, match="frame_0000.pov") as caught:
        run.film(tmp_path / "film.gif", **options)
    assert caught[0].filename == __file__


def test_a_view_is_the_page_of_the_command(command, tmp_path):
    (tmp_path / "scene.toml").write_text(THROW)
    command("export", "scene.toml", "-o", "scene.html")
    view = jabuka.Scene.load(tmp_path / "scene.toml").run().view(height=300)
    view.save(tmp_path / "saved.html")
    assert (tmp_path / "saved.html").read_bytes() == (tmp_path / "scene.html").read_bytes()
    shown = view._repr_html_()
    assert shown.startswith('<iframe srcdoc="&lt;!doctype html&gt;') and "height: 300px" in shown
    assert html.unescape(shown.split('"')[1]) == view.page
