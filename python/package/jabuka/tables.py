"""Tables of pandas and polars."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any


def table_of(columns: Mapping[str, Any], library: str | None) -> Any:
    """Returns columns as a table of ``pandas`` or ``polars``, or as a ``dict``. ``None`` selects the first that is installed."""
    if library is None:
        library = next((name for name in ("pandas", "polars") if find_spec(name)), None)
        if library is None:
            raise ImportError('a table needs pandas or polars: `pip install pandas`, or take library="dict"')
    if library == "dict":
        return dict(columns)
    if library not in ("pandas", "polars"):
        raise ValueError(f'there is no library {library!r}: take "pandas", "polars" or "dict"')
    return import_module(library).DataFrame(dict(columns))
