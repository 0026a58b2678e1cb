"""Arguments that the compiled module could not name: their types and ranges."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np


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
    """A number; text is none, though Python would read it."""
    if isinstance(value, (str, bytes)) or not hasattr(type(value), "__float__") and not hasattr(type(value), "__index__"):
        raise TypeError(f"{name} is of {type(value).__name__}; give a number")
    return float(value)


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is of {type(value).__name__}; give True or False")
    return bool(value)
