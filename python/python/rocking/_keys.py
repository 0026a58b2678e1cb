"""Keys of scenes as dictionaries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def copied(value: Any) -> Any:
    """A copy of nested dictionaries, lists and arrays: who changes his own later does not change the scene. Motions and records, which nobody changes, are shared."""
    if hasattr(value, "_scene_keys") or isinstance(value, np.generic):
        return value
    if isinstance(value, Mapping):
        return {key: copied(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, range)):
        return [copied(item) for item in value]
    if np.ma.is_masked(value):
        raise ValueError("an array of the scene has masked values; fill them, or leave them out")
    return np.array(value) if hasattr(value, "tolist") or hasattr(value, "__array__") else value
