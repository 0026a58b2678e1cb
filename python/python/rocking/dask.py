"""Studies beyond one machine: a sweep or an incremental dynamic analysis as a lazy ``dask.dataframe``.

A study finds the run of any index without the others, so a partition is a range of indices and a task sends nothing but the study and two numbers. A study with
records is a task of its own, which a worker receives once. Names and types of the columns are known beforehand. A task that is lost with its worker is run again
elsewhere and gives the same rows.

>>> import rocking as rk, rocking.dask as rd
>>> scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.pulse("sine-pulse", amplitude_uplift=3, omega_p=5), eta=0.9)
>>> sweep = rk.Sweep(scene, {"omega_p": [2.0, 4.0], "amplitude_uplift": {"from": 1, "to": 8, "steps": 50}})
>>> table = rd.frame(sweep, partition_size=25)
>>> table.npartitions, int((table.outcome == "overturns").sum().compute(scheduler="sync"))
(4, 89)
"""

from __future__ import annotations

import os
import pickle
import time
from typing import TYPE_CHECKING, Any

import pandas as pd

from ._arguments import number, path_text, whole
from ._plan import Plan
from ._sweep import Sweep

if TYPE_CHECKING:
    import dask.dataframe as dd

#: Seconds that a partition should take. Beside its runs a partition costs a worker 10 ms and the scheduler 2.4 ms of processor (measured by
#: benchmarks/cluster.py): 0.2 % of the worker's time, and one scheduler keeps 2000 workers busy.
SECONDS_PER_PARTITION = 5.0

#: Rows of the largest partition [rows], for the memory of a worker: 240 MB beside those of an idle one.
MOST_ROWS = 500_000

#: Largest study that travels with each partition [bytes]. Dask has a smaller graph of these; a larger study would be most of what moves.
MOST_BYTES = 20_000

#: Most values on the axes of such a study: each partition reads them anew, at 1 µs each.
MOST_VALUES = 20_000

#: Seconds of runs that are timed to choose a partition.
TIMED_SECONDS = 0.25


def _part(bounds: tuple[int, int], plan: Plan, threads: int) -> pd.DataFrame:
    """The rows of a partition."""
    return plan.table(*bounds, threads=threads)


def partition_size(plan: Plan, *, seconds: float = SECONDS_PER_PARTITION, threads: int = 1) -> int:
    """Rows of a partition that takes so many seconds, from the time of rows spread over the study.

    The estimate costs about half a second of runs; partitions of a study whose runs differ much take between a fraction and a multiple of it. ``threads`` are
    those of a task, 0 for as many as this machine has.

    Raises
    ------
    ValueError
        For ``seconds`` that are not above zero, or a negative number of ``threads``.
    """
    if not isinstance(plan, Plan):
        raise TypeError(f"plan is of {type(plan).__name__}; give a Sweep or an Ida")
    seconds = number("seconds", seconds)
    if not seconds > 0.0:
        raise ValueError(f"seconds = {seconds}; give a time above zero")
    if whole("threads", threads) < 0:
        raise ValueError(f"threads = {threads}; give a number from 0 on")
    length, threads = len(plan), threads or os.cpu_count() or 1
    pieces, rows, spent = 8, 4, 0.0
    most = max(1, length // pieces)
    # A call costs half a millisecond beside its rows: it is timed over as many as make that little.
    while True:
        rows = min(rows, most)
        starts = sorted({(length - rows) * piece // (pieces - 1) for piece in range(pieces)})
        begin = time.process_time()
        for start in starts:
            plan.table(start, start + rows, threads=1)
        spent = time.process_time() - begin
        if spent >= TIMED_SECONDS or rows == most:
            break
        rows *= 2
    per_row = spent / (rows * len(starts)) / threads
    return int(min(max(seconds / per_row, 1.0), MOST_ROWS)) if per_row > 0 else MOST_ROWS


def frame(plan: Plan, *, rows: range | None = None, partition_size: int | None = None, threads: int = 1) -> "dd.DataFrame":
    """The table of a study as a lazy data frame.

    Parameters
    ----------
    plan : Sweep or Ida
        Files that its scene names must be readable by the workers; records read with ``Record.read`` travel with the study.
    rows : range
        Indices of the runs, all unless given; ``plan.shard`` has those of a part.
    partition_size : int
        Rows of a partition; chosen by :func:`partition_size` unless given.
    threads : int
        Threads of a task: 1 where workers have one thread a core, as those of a ``LocalCluster`` with ``threads_per_worker=1``.

    Raises
    ------
    ValueError
        For ``rows`` that are empty or not in the study, or a ``partition_size`` below 1.
    """
    import dask.dataframe as dd
    from dask.base import tokenize
    from dask.delayed import delayed

    if not isinstance(plan, Plan):
        raise TypeError(f"plan is of {type(plan).__name__}; give a Sweep or an Ida")
    asked = range(len(plan)) if rows is None else rows
    if not isinstance(asked, range):
        raise TypeError(f"rows are of {type(asked).__name__}; give a range")
    if asked.step != 1 or not 0 <= asked.start < asked.stop <= len(plan):
        raise ValueError(f"rows = {asked} are no range of the {len(plan)} rows of the study")
    size = globals()["partition_size"](plan, threads=threads) if partition_size is None else whole("partition_size", partition_size)
    if size < 1:
        raise ValueError(f"partition_size = {size}; give at least one row")
    bounds = [(start, min(start + size, asked.stop)) for start in range(asked.start, asked.stop, size)]
    # Known beforehand: an empty range has the columns of all others.
    meta = plan.table(0, 0, threads=1)
    divisions = (*(start for start, _ in bounds), asked.stop - 1)
    state = pickle.dumps(plan)
    made: dd.DataFrame
    values = sum(plan.axes.values()) if isinstance(plan, Sweep) else 0
    if len(state) <= MOST_BYTES and values <= MOST_VALUES:
        from_map: Any = dd.from_map
        made = from_map(_part, bounds, plan=plan, threads=threads, meta=meta, divisions=divisions, label="rocking")
    else:
        # Bytes until a worker has them: the study is read once there.
        name = tokenize(state, size, threads, asked.start, asked.stop)
        shared = delayed(pickle.loads)(state, dask_key_name=f"rocking-study-{name}")
        part = delayed(_part)
        parts = [part(own, shared, threads, dask_key_name=f"rocking-{name}-{own[0]}") for own in bounds]
        made = dd.from_delayed(parts, meta=meta, divisions=divisions, verify_meta=False)
    return made


def to_parquet(
    plan: Plan, folder: str | os.PathLike[str], *, rows: range | None = None, partition_size: int | None = None, threads: int = 1, **options: Any
) -> None:
    """Runs a study into a folder of Parquet files, a file per partition, by the present client; no worker holds more than its partition.

    Arguments as of :func:`frame`; ``options`` are those of ``dask.dataframe.DataFrame.to_parquet``, but for ``compute`` and ``write_index``.

    Raises
    ------
    FileExistsError
        For a folder that has Parquet files, unless ``overwrite`` or ``append`` is given.
    TypeError
        For ``compute`` or ``write_index``: the table is written at once, and its rows are numbered by a column of their own.
    """
    for name in {"compute", "write_index"} & set(options):
        raise TypeError(f"there is no argument `{name}` of rocking.dask.to_parquet: the table is written at once, without an index; use rocking.dask.frame")
    path = path_text("folder", folder)
    is_kept = options.get("overwrite") or options.get("append")
    if not is_kept and os.path.isdir(path) and any(name.endswith((".parquet", ".parq")) for name in os.listdir(path)):
        raise FileExistsError(f"{path} has Parquet files, which would be read with the new ones; give another folder, or overwrite=True")
    table: Any = frame(plan, rows=rows, partition_size=partition_size, threads=threads)
    written = table.to_parquet(path, write_index=False, compute=False, **options)
    # One task for each partition: rows are written by the worker that made them.
    written.optimize(fuse=True).compute()
