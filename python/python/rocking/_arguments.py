"""Arguments that the compiled module could not name: their types and ranges."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt


def whole(name: str, value: Any) -> int:
    """A whole number from 0 on."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is of {type(value).__name__}; give a whole number") from None
    if not 0 <= number < 2**64:
        raise ValueError(f"{name} = {number} is out of range; give a whole number from 0 on")
    return number


def number(name: str, value: Any) -> float:
    """A number; text, truths and arrays are none, though Python would read some of them."""
    is_scalar = getattr(value, "ndim", 0) == 0 and (hasattr(type(value), "__float__") or hasattr(type(value), "__index__"))
    # Differences of times have a unit of their own, and would be taken as so many of the unit of the argument.
    has_other_kind = getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M", "c")
    if isinstance(value, (str, bytes, bool, np.bool_)) or has_other_kind or not is_scalar:
        raise TypeError(f"{name} is of {type(value).__name__}; give a number")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name} is out of the range of numbers; give a smaller one") from None
    except TypeError:
        raise TypeError(f"{name} is of {type(value).__name__}; give a number") from None


def optional(name: str, value: Any) -> float | None:
    """A number, or None."""
    return None if value is None else number(name, value)


def numbers(name: str, values: Any) -> npt.NDArray[np.float64]:
    """An array of numbers, whatever holds them; text, times, truths, complex and masked numbers are refused."""
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked values; fill them, or leave them out")
    try:
        array = np.asarray(list(values) if isinstance(values, Iterator) else values)
    except ValueError:
        raise TypeError(f"{name} is not regular; give a list or an array of numbers") from None
    if array.ndim == 0 and isinstance(values, Iterable) and not isinstance(values, (str, bytes)) and not hasattr(values, "__array__"):
        raise TypeError(f"{name} is of {type(values).__name__}; give a list or an array of numbers")
    if array.dtype.kind == "O":
        items = [number(f"an item of {name}" if array.ndim else name, item) for item in array.ravel().tolist()]
        return np.array(items, dtype=np.float64).reshape(array.shape)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} has values of {array.dtype}; give numbers")
    return array.astype(np.float64)


def path_text(name: str, value: str | bytes | os.PathLike[str] | os.PathLike[bytes]) -> str:
    """A path as a text."""
    found = os.fsdecode(value)
    if not found:
        raise ValueError(f"{name} is empty; give a path, '.' for the present folder")
    return found


def text(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise TypeError(f"{name} is of {type(value).__name__}; give a text")
    return value


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is of {type(value).__name__}; give True or False")
    return bool(value)
