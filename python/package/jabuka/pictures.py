"""Images and films that notebooks show."""

from __future__ import annotations

import base64
import os
from pathlib import Path
from typing import Any

__all__ = ["Film", "Still"]

_TYPES = {".mp4": "video/mp4", ".webm": "video/webm", ".gif": "image/gif"}


class Still:
    """The image of a moment of a run."""

    def __init__(self, time: float, png: bytes) -> None:
        self.time = time
        """The time of the image, s."""
        self.png = png
        """The image as PNG."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the image to a PNG file."""
        Path(path).write_bytes(self.png)

    def _repr_png_(self) -> bytes:
        return self.png

    def __repr__(self) -> str:
        return f"<Still at t = {self.time} s>"


class Film:
    """A film of a run, in a file."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        """The path of the file."""

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any]:
        kind = _TYPES[self.path.suffix.lower()]
        data = base64.b64encode(self.path.read_bytes()).decode("ascii")
        source = f"data:{kind};base64,{data}"
        is_gif = kind == "image/gif"
        html = f'<img src="{source}">' if is_gif else f'<video controls loop src="{source}"></video>'
        return {"text/html": html, "text/plain": repr(self)}

    def __repr__(self) -> str:
        return f"<Film {self.path}>"
