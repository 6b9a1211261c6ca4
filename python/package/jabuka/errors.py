"""The exceptions and warnings of jabuka, and the diagnostics that they carry."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .runs import Run

__all__ = [
    "Diagnostic",
    "Edit",
    "Interrupted",
    "JabukaError",
    "JabukaWarning",
    "RenderError",
    "RunError",
    "SceneError",
    "Span",
]


@dataclass(frozen=True)
class Span:
    """A range of a text. Lines and columns count from 1, columns are in characters, and the end is exclusive."""

    file: str
    """The path of the file, or ``--set`` for a value that was set, or ``measure`` for a formula."""
    line: int
    column: int
    end_line: int
    end_column: int
    label: str = ""
    """A remark on the range. Often empty."""


@dataclass(frozen=True)
class Edit:
    """A replacement of a range of a text. It is part of a suggested correction."""

    span: Span
    text: str
    """The new text of the range."""


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning, with its place in the text of the scene."""

    severity: str
    """``error`` or ``warning``."""
    code: str
    """The code, such as ``unknown-key``. ``jabuka explain CODE`` explains it."""
    message: str
    help: str | None
    """Advice on how to correct the error."""
    span: Span | None
    """The place in the text. ``None`` if the error has no place."""
    related: tuple[Span, ...] = ()
    """Further places, each with a label."""
    fix: tuple[Edit, ...] = ()
    """The edits that correct the error. All of them belong together. Empty if no correction is known."""

    @property
    def line(self) -> int | None:
        """The line of the error, counted from 1."""
        return None if self.span is None else self.span.line

    @property
    def column(self) -> int | None:
        """The column of the error, in characters, counted from 1."""
        return None if self.span is None else self.span.column


def _span(entry: dict[str, Any]) -> Span:
    return Span(
        entry["file"],
        entry["line"],
        entry["column"],
        entry["end_line"],
        entry["end_column"],
        entry.get("label", ""),
    )


def diagnostics_of(text: str) -> tuple[Diagnostic, ...]:
    """Reads diagnostics from the JSON that ``jabuka check --format json`` prints, too."""
    return tuple(
        Diagnostic(
            severity=entry["severity"],
            code=entry["code"],
            message=entry["message"],
            help=entry["help"],
            span=_span(entry) if "line" in entry else None,
            related=tuple(map(_span, entry["related"])),
            fix=tuple(Edit(_span(edit), edit["text"]) for edit in entry.get("fix", ())),
        )
        for entry in json.loads(text)
    )


class JabukaError(Exception):
    """The base of all errors of jabuka. Its text shows each error at its place, as the command does."""

    diagnostics: tuple[Diagnostic, ...] = ()
    """All errors and warnings, in the order of their places."""

    @classmethod
    def _of(cls, text: str, entries: str) -> JabukaError:
        error = cls(text.rstrip("\n"))
        error.diagnostics = diagnostics_of(entries)
        return error

    @property
    def first(self) -> Diagnostic:
        """The first error."""
        errors = [one for one in self.diagnostics if one.severity == "error"]
        return (errors or list(self.diagnostics))[0]

    @property
    def code(self) -> str:
        """The code of the first error, such as ``unknown-key``."""
        return self.first.code

    @property
    def line(self) -> int | None:
        """The line of the first error, counted from 1."""
        return self.first.line

    @property
    def column(self) -> int | None:
        """The column of the first error, in characters, counted from 1."""
        return self.first.column

    @property
    def fix(self) -> tuple[Edit, ...]:
        """The edits that correct the first error."""
        return self.first.fix


class SceneError(JabukaError, ValueError):
    """The text of a scene, a value that was set, or a formula has mistakes."""


class RunError(JabukaError, RuntimeError):
    """A run broke down."""

    run: Run | None = None
    """The run with the frames before the breakdown. ``None`` if there are none."""


class RenderError(JabukaError, RuntimeError):
    """An image or a film could not be made."""


class JabukaWarning(UserWarning):
    """A warning about a scene or its run. The scene is valid, but something in it is probably unintended."""


class Interrupted(UserWarning):
    """Ctrl-C has ended a run. The frames so far are kept."""


def warn(texts: Iterable[str]) -> None:
    """Issues warnings at the line that has called a method of jabuka."""
    for text in texts:
        warnings.warn("\n" + text.rstrip("\n"), JabukaWarning, stacklevel=3)
