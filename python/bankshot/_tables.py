"""Results as tables: HTML for notebooks, Arrow for everything else."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from . import _engine

Rows = Sequence[tuple[str, ...]]


def html(title: str, header: Sequence[str], rows: Rows) -> str:
    """A table of text."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><caption>{escape(title)}</caption><tr>{head}</tr>{body}</table>"


def arrow(records: Sequence[dict[str, Any]]) -> Any:
    """A table with the Arrow PyCapsule interface of records of numbers and text."""
    import numpy as np

    columns: list[tuple[str, Any]] = []
    for name in records[0] if records else []:
        values = [record.get(name) for record in records]
        if all(isinstance(value, str) for value in values):
            columns.append((name, values))
        elif all(value is None or isinstance(value, (int, float)) for value in values):
            numbers = [float("nan") if value is None else float(value) for value in values]
            columns.append((name, np.array(numbers)))
    return _engine.arrow_table(columns)
