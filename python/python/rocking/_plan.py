"""Plans: runs that make the rows of a table, whole or in parts. Sweeps and incremental dynamic analyses are plans."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._arguments import whole
from ._frame import arrow, frame

if TYPE_CHECKING:
    import pyarrow


class Plan(ABC):
    """Runs that make the rows of a table, a :class:`Sweep` or an :class:`Ida`; the row of any index is found without the others."""

    @abstractmethod
    def __len__(self) -> int:
        """Number of runs."""

    @abstractmethod
    def _columns(self, start: int, stop: int, threads: int) -> list[tuple[Any, ...]]:
        """Columns of the rows from ``start`` to before ``stop``, as the compiled module makes them."""

    def table(self, start: int = 0, stop: int | None = None, *, threads: int = 0) -> pd.DataFrame:
        """Runs the points of a sweep, or the runs of an analysis, from ``start`` to before ``stop``; a row each, with the columns of ``rocking sweep`` or
        ``rocking ida``.

        ``threads`` is the number of threads, 0 for as many as the machine has; rows do not depend on it. A point of a sweep whose scene cannot be read or
        run is a row with ``outcome`` "error". Blank are ``NaN`` and ``NA``.

        Raises
        ------
        IndexError
            For a ``stop`` after the last row.
        ValueError
            For a negative index, or more than 1024 threads.
        """
        return frame(self._checked(start, stop, threads), start)

    def to_arrow(self, start: int = 0, stop: int | None = None, *, threads: int = 0) -> "pyarrow.Table":
        """As :meth:`table`, as a table of Arrow, without pandas in between; blanks are null, and names are dictionaries. Needs ``pyarrow``."""
        return arrow(self._checked(start, stop, threads))

    def _checked(self, start: int, stop: int | None, threads: int) -> list[tuple[Any, ...]]:
        end = len(self) if stop is None else whole("stop", stop)
        return self._columns(whole("start", start), end, whole("threads", threads))

    def shard(self, number: int, count: int) -> range:
        """Indices of the ``number``-th (from 1) of ``count`` parts, as ``rocking sweep --shard``."""
        number, count = whole("number", number), whole("count", count)
        if not 1 <= number <= count:
            raise ValueError(f"there is no part {number} of {count}")
        return range(len(self) * (number - 1) // count, len(self) * number // count)
