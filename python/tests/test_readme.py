"""The examples of the README run in their order."""

import re

from conftest import ROOT


def test_the_examples_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "python" / "README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 5
    names = {}
    for block in blocks:
        exec(block, names)
    assert "did you mean" in capsys.readouterr().out
    assert (tmp_path / "throw.mp4").stat().st_size > 0
    assert names["heights"].results[1] > names["heights"].results[0] > 4
