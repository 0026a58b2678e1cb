"""Tables of the command line, read with the floats that Python reads."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pandas as pd


def read(source: Path | str) -> pd.DataFrame:
    """A CSV table; columns of numbers as floats, blank cells as missing."""
    text = source.read_text() if isinstance(source, Path) else source
    head, *rows = csv.reader(io.StringIO(text))
    columns = {}
    for place, name in enumerate(head):
        cells = [{"True": "true", "False": "false"}.get(row[place], row[place]) for row in rows]
        try:
            columns[name] = pd.Series([float(cell) if cell else float("nan") for cell in cells], dtype="float64")
        except ValueError:
            columns[name] = pd.Series([cell or None for cell in cells], dtype="object")
    return pd.DataFrame(columns)


def as_read(table: pd.DataFrame) -> pd.DataFrame:
    """A table after a journey through CSV."""
    text = table.to_csv(index=False)
    assert text is not None
    return read(text)
