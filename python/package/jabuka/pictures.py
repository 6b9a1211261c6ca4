"""Images, films and pages that notebooks show."""

from __future__ import annotations

import base64
import html
import os
from pathlib import Path
from typing import Any

__all__ = ["Film", "Still", "View"]

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
        element = f'<img src="{source}">' if is_gif else f'<video controls loop src="{source}"></video>'
        return {"text/html": element, "text/plain": repr(self)}

    def __repr__(self) -> str:
        return f"<Film {self.path}>"


class View:
    """A run on a page: it plays, the camera turns, a click on a body shows its values."""

    def __init__(self, page: str, height: int) -> None:
        self.page = page
        """The page as HTML, with the data of the run. It needs no network."""
        self.height = height
        """The height of the page in a notebook, pixels."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to an HTML file, which any browser shows."""
        Path(path).write_bytes(self.page.encode())

    def _repr_html_(self) -> str:
        source = html.escape(self.page, quote=True)
        return f'<iframe srcdoc="{source}" style="width: 100%; height: {self.height}px; border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<View of {len(self.page) / 1e6:.1f} MB>"
