"""The type hints of the package fit its code, and the stubs fit the compiled part."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import jabuka
from jabuka import _jabuka

PACKAGE = Path(jabuka.__file__).parent


def test_mypy_finds_no_mistake(tmp_path):
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path), "-p", "jabuka"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_stub_has_each_name_of_the_compiled_part():
    stub = (PACKAGE / "_jabuka.pyi").read_text()
    declared = set(re.findall(r"(?:def|class) (\w+)", stub)) - {"__init__"}
    public = {name for name in vars(_jabuka) if not name.startswith("_")}
    members = {name for one in (_jabuka.Scene, _jabuka.Run, _jabuka.Stop) for name in vars(one) if not name.startswith("_")}
    assert declared == public | members


def test_each_public_name_has_a_docstring():
    for name in jabuka.__all__:
        one = getattr(jabuka, name)
        assert inspect.getdoc(one), name
        members = {key: member for key, member in vars(one).items() if not key.startswith("_")} if inspect.isclass(one) else {}
        for key, member in members.items():
            if callable(member) or isinstance(member, property):
                assert inspect.getdoc(member), f"{name}.{key}"
