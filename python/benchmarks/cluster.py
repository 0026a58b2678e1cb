"""What a study costs beside its runs: partitions, bytes moved, memory, Parquet.

    python python/benchmarks/cluster.py partition          costs of a partition
    python python/benchmarks/cluster.py study RUNS [FOLDER]  one study into Parquet, with memory and traffic over time (CSV beside the folder)

Figures of docs/book/clusters.md. The scene is cheap (one block, outcome only), so that everything beside the runs shows. Times are wall-clock on a machine that others may use:
take the least of several. Bytes moved are those of the loopback device, of all programs of the machine.
"""

from __future__ import annotations

import csv
import math
import os
import pickle
import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import psutil
import rocking as rk
import rocking.dask as rd
from distributed import Client, LocalCluster

WORKERS = 2

#: Seconds between two readings of the memory.
INTERVAL = 0.25


def study(runs: int) -> rk.Sweep:
    """A grid of about so many runs of one block under a pulse."""
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9, t_end=20, rtol=1e-6)
    frequencies = max(1, round(math.sqrt(runs / 10)))
    amplitudes = max(1, round(runs / frequencies))
    return rk.Sweep(
        scene, {"omega_p": {"from": 0.5, "to": 8.0, "steps": frequencies}, "amplitude_uplift": {"from": 0.5, "to": 12.0, "steps": amplitudes}}
    )


def loopback() -> int:
    """Bytes sent so far by programs of this machine to each other."""
    return psutil.net_io_counters(pernic=True)["lo"].bytes_sent


def partition() -> None:
    """Costs of a partition: of its task, and of its file."""
    plan = study(100_000)
    pickled = pickle.dumps(plan)
    print(f"pickle of the study: {len(pickled)} bytes")
    best = {"read the study": math.inf, "one row": math.inf, "pickle": math.inf}
    for _ in range(20):
        begin = time.perf_counter()
        again = pickle.loads(pickled)
        read = time.perf_counter()
        again.table(0, 1, threads=1)
        row = time.perf_counter()
        pickle.dumps(plan)
        for name, spent in (("read the study", read - begin), ("one row", row - read), ("pickle", time.perf_counter() - row)):
            best[name] = min(best[name], spent)
    for name, spent in best.items():
        print(f"{name}: {1e3 * spent:.3g} ms")

    def plain() -> float:
        begin = time.perf_counter()
        plan.table(threads=1)
        return time.perf_counter() - begin

    alone = min(plain() for _ in range(5))
    print(f"plain sweep, one thread: {1e6 * alone / len(plan):.3g} us a run, {len(plan)} runs")
    with cluster(), tempfile.TemporaryDirectory() as scratch:
        rd.frame(plan, partition_size=len(plan) // 10).outcome.value_counts().compute()
        rows: list[dict[str, float]] = []
        for parts in (20, 100, 500, 2000):
            size = -(-len(plan) // parts)
            for kind in ("counts", "parquet"):
                spent, moved = [], []
                for _ in range(3):
                    before, begin = loopback(), time.perf_counter()
                    if kind == "counts":
                        rd.frame(plan, partition_size=size).outcome.value_counts().compute()
                    else:
                        rd.to_parquet(plan, Path(scratch) / "table", partition_size=size)
                    spent.append(time.perf_counter() - begin)
                    moved.append(loopback() - before)
                    shutil.rmtree(Path(scratch) / "table", ignore_errors=True)
                rows.append({"parts": parts, "kind": kind, "seconds": min(spent), "bytes": min(moved)})  # type: ignore[dict-item]
                print(f"{kind:8} {parts:5} partitions of {size:5} rows: {min(spent):.3f} s, {min(moved) / 1e3:.0f} kB moved", flush=True)
        for kind in ("counts", "parquet"):
            first, last = [row for row in rows if row["kind"] == kind][:: len([row for row in rows if row["kind"] == kind]) - 1]
            more = last["parts"] - first["parts"]
            print(f"{kind}: a partition costs {1e3 * (last['seconds'] - first['seconds']) / more:.3g} ms of {WORKERS} workers, moves {(last['bytes'] - first['bytes']) / more:.0f} bytes")


class cluster:
    """A scheduler and workers of this machine, and their client."""

    def __enter__(self) -> Client:
        # The same limit whatever the machine has: a worker that needs more is stopped and the study fails.
        self.cluster = LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None, memory_limit="1GiB")
        self.client = Client(self.cluster)
        return self.client

    def __exit__(self, *_: object) -> None:
        self.client.close()
        self.cluster.close()


def memory(client: Client, stop: threading.Event, rows: list[list[float]]) -> None:
    """Reads resident memory of client (with the scheduler) and workers until it is stopped."""
    processes = [psutil.Process(), *(psutil.Process(pid) for pid in client.run(os.getpid).values())]
    begin, before = time.perf_counter(), loopback()
    while not stop.wait(INTERVAL):
        sizes = [process.memory_info().rss / 1e6 for process in processes]
        rows.append([time.perf_counter() - begin, *sizes, float(loopback() - before)])


def measured(runs: int, folder: Path) -> None:
    """A study into Parquet files, and the shares of outcomes from them."""
    plan = study(runs)
    begin = time.perf_counter()
    size = rd.partition_size(plan)
    print(f"{len(plan)} runs, partitions of {size} rows ({-(-len(plan) // size)}), chosen in {time.perf_counter() - begin:.2f} s")
    rows: list[list[float]] = []
    with cluster() as client:
        stop = threading.Event()
        reader = threading.Thread(target=memory, args=(client, stop, rows))
        reader.start()
        time.sleep(1.0)
        cpu = [psutil.Process(pid).cpu_times() for pid in client.run(os.getpid).values()]
        before, begin = loopback(), time.perf_counter()
        rd.to_parquet(plan, folder, partition_size=size)
        spent, moved = time.perf_counter() - begin, loopback() - before
        after = [psutil.Process(pid).cpu_times() for pid in client.run(os.getpid).values()]
        import dask.dataframe as dd

        table: Any = dd.read_parquet(folder)
        counts = table.outcome.value_counts().compute()
        stop.set()
        reader.join()
    assert int(counts.sum()) == len(plan)
    files = list(folder.glob("*.parquet"))
    stored = sum(file.stat().st_size for file in files)
    worked = sum(late.user + late.system - early.user - early.system for early, late in zip(cpu, after))
    print(counts.sort_index().to_string())
    print(f"{spent:.1f} s, {worked:.1f} s of the workers' processors ({1e6 * worked / len(plan):.3g} us a run), {moved / 1e6:.2f} MB moved, {len(files)} files of {stored / 1e6:.1f} MB")
    print(f"largest resident memory: client {max(row[1] for row in rows):.0f} MB, workers {', '.join(f'{max(row[number] for row in rows):.0f}' for number in range(2, 2 + WORKERS))} MB")
    print(f"at the start: client {rows[0][1]:.0f} MB, workers {', '.join(f'{rows[0][number]:.0f}' for number in range(2, 2 + WORKERS))} MB")
    # The largest of each tenth: bounded memory does not grow from one to the next.
    tenths = [rows[len(rows) * part // 10 : max(len(rows) * (part + 1) // 10, len(rows) * part // 10 + 1)] for part in range(10)]
    for number, name in enumerate(("client", *(f"worker {worker + 1}" for worker in range(WORKERS))), start=1):
        print(f"{name} over time, MB: {' '.join(f'{max(row[number] for row in tenth):.0f}' for tenth in tenths)}")
    with open(folder.parent / f"{folder.name}-memory.csv", "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["t", "client_mb", *(f"worker_{worker + 1}_mb" for worker in range(WORKERS)), "bytes_moved"])
        writer.writerows(rows)


def main() -> None:
    if sys.argv[1:2] == ["partition"]:
        partition()
    elif sys.argv[1:2] == ["study"] and len(sys.argv) in (3, 4):
        with tempfile.TemporaryDirectory() as scratch:
            measured(int(float(sys.argv[2])), Path(sys.argv[3] if len(sys.argv) == 4 else f"{scratch}/study"))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
