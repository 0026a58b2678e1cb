"""Tables of the compiled module as data frames."""

from __future__ import annotations

from typing import Any

import pandas as pd


def frame(columns: list[tuple[Any, ...]], start: int = 0) -> pd.DataFrame:
    """A data frame of columns ``(name, kind, ...)``, numbered from ``start``; equal studies have equal types, whatever stands in their rows."""
    table = pd.DataFrame({name: _series(kind, values) for name, kind, *values in columns})
    table.index = pd.RangeIndex(start, start + len(table))
    return table


def _series(kind: str, values: list[Any]) -> Any:
    if kind == "Int64":
        return pd.arrays.IntegerArray(values[0], values[1])
    if kind == "boolean":
        return pd.arrays.BooleanArray(values[0], values[1])
    if kind == "category":
        return pd.Categorical.from_codes(values[0], categories=pd.Index(values[1], dtype="str"))
    if kind == "string":
        return pd.array(values[0], dtype="string")
    return values[0]
