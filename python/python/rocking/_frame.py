"""Tables of the compiled module as data frames and as tables of Arrow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

if TYPE_CHECKING:
    import pyarrow


def frame(columns: list[tuple[Any, ...]], start: int = 0) -> pd.DataFrame:
    """A data frame of columns ``(name, kind, ...)``, numbered from ``start``; equal studies have equal types, whatever stands in their rows."""
    table = pd.DataFrame({name: _series(kind, values) for name, kind, *values in columns})
    table.index = pd.RangeIndex(start, start + len(table))
    return table


def arrow(columns: list[tuple[Any, ...]]) -> "pyarrow.Table":
    """A table of Arrow of the same columns, its arrays those of the compiled module where none is blank. Blanks are null, and categories are dictionaries."""
    try:
        import pyarrow
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError("there is no pyarrow; install it with `pip install pyarrow`, or take a table of pandas", name="pyarrow") from missing

    def array(kind: str, values: list[Any]) -> Any:
        if kind in ("Int64", "boolean"):
            return pyarrow.array(values[0], mask=values[1])
        if kind == "category":
            codes = pyarrow.array(values[0], mask=values[0] < 0)
            return pyarrow.DictionaryArray.from_arrays(codes, pyarrow.array(values[1], type=pyarrow.string()))
        if kind == "string":
            return pyarrow.array(values[0], type=pyarrow.string())
        # What is not a number is blank.
        return pyarrow.array(values[0], from_pandas=True)

    return pyarrow.table({name: array(kind, values) for name, kind, *values in columns})


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
