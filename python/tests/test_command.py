"""The command that comes with the package."""

import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import THROW

COMMANDS = [[Path(sys.executable).with_name("jabuka")], [sys.executable, "-m", "jabuka"]]


@pytest.mark.parametrize("program", COMMANDS, ids=["jabuka", "python -m jabuka"])
def test_commands_print_and_return_their_exit_codes(program, tmp_path):
    def run(*arguments):
        done = subprocess.run([*program, *arguments], cwd=tmp_path, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    (tmp_path / "scene.toml").write_text(THROW)
    (tmp_path / "wrong.toml").write_text("[body.ball]\nshape.sphere.raduis = 1\n")
    assert run("--version") == (0, f"jabuka {version('jabuka')}\n", "")
    code, out, error = run("check", "scene.toml")
    assert code == 0 and error == ""
    code, out, error = run("check", "wrong.toml")
    assert code == 1 and "wrong.toml:2:14" in error
    code, out, error = run("chek")
    assert code == 2 and "check" in error
    code, out, error = run("compile", "scene.toml")
    assert code == 0 and out.startswith("out/scene: 51 of 51 frames\n")
    assert (tmp_path / "out" / "scene" / "frame_0050.pov").exists()


def test_the_command_renders_in_the_sandbox(command, tmp_path):
    victim = tmp_path / "victim.txt"
    victim.write_text("keep")
    (tmp_path / "folder").mkdir()
    sdl = f'#fopen F "{victim}" write\n#write (F, "gone")\n#fclose F'
    (tmp_path / "folder" / "scene.toml").write_text(f"povray.sdl = '''\n{sdl}\n'''\n{THROW}")
    done = command("still", "folder/scene.toml", "--trust", "--size", "32x24", check=False)
    assert done.returncode == 1 and "error[outside-sandbox]" in done.stderr
    assert victim.read_text() == "keep"
