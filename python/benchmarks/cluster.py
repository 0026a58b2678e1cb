"""What a study costs beside its runs: partitions, bytes moved, memory, Parquet.

    python python/benchmarks/cluster.py partition          costs of a partition
    python python/benchmarks/cluster.py graph              memory of client and scheduler for each partition
    python python/benchmarks/cluster.py study RUNS [FOLDER]  one study into Parquet, with memory and traffic over time (CSV beside the folder)

Figures of docs/book/clusters.md. The scene is cheap (one block, outcome only), so that everything beside the runs shows. Costs are processor times, which other
programs on the machine change little. Bytes moved are those of the loopback device, of all programs of the machine.
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

import pandas as pd
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
    frequencies = max(2, round(math.sqrt(runs / 10)))
    amplitudes = max(2, round(runs / frequencies))
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
        for name, took in (("read the study", read - begin), ("one row", row - read), ("pickle", time.perf_counter() - row)):
            best[name] = min(best[name], took)
    for name, took in best.items():
        print(f"{name}: {1e3 * took:.3g} ms")

    print(f"plain sweep, one thread: {1e6 * plain(plan):.3g} us a run, {len(plan)} runs")
    records = rk.Ida(plan.scene(0), rk.synthetic(range(20), duration=60.0, dt=0.005), "PGV", [0.01 + 0.001 * level for level in range(20)])
    print(f"pickle of an analysis of 20 records of 60 s: {len(pickle.dumps(records))} bytes")
    with cluster() as client, tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "table"
        # Modules are imported, and the first of everything is done.
        rd.to_parquet(plan, folder, partition_size=len(plan) // 10)
        rd.frame(plan, partition_size=len(plan) // 10).outcome.value_counts().compute()

        def counts(studied: rd.Plan, size: int) -> None:
            rd.frame(studied, partition_size=size).outcome.value_counts().compute()

        def parquet(studied: rd.Plan, size: int) -> None:
            rd.to_parquet(studied, folder, partition_size=size)
            shutil.rmtree(folder)

        for kind, studied, work in (("counts", plan, counts), ("parquet", plan, parquet), ("records, counts", records, counts)):
            few, many = (20, 400) if studied is plan else (4, 40)
            rows = []
            for parts in (few, many):
                before, begin = (loopback(), *spent(client)), time.perf_counter()
                work(studied, len(studied) // parts)
                wall, after = time.perf_counter() - begin, (loopback(), *spent(client))
                rows.append([late - early for early, late in zip(before, after)])
                moved, own, workers = rows[-1]
                print(
                    f"{kind}, {parts} partitions of {len(studied) // parts} rows: {wall:.2f} s, processors: client and scheduler {own:.2f} s, workers {workers:.2f} s; {moved / 1e3:.0f} kB moved",
                    flush=True,
                )
            moved, own, workers = ((late - early) / (many - few) for early, late in zip(*rows))
            print(f"{kind}: a partition costs {1e3 * own:.2f} ms of client and scheduler and {1e3 * workers:.2f} ms of a worker, and moves {moved / 1e3:.1f} kB")


def graph() -> None:
    """Memory of client and scheduler, one process here, for each partition of a study of many."""
    parts = 5000
    plan = study(parts)
    rows: list[list[float]] = []
    with cluster() as client, tempfile.TemporaryDirectory() as scratch:
        rd.to_parquet(plan, Path(scratch) / "few", partition_size=parts // 10)
        stop = threading.Event()
        reader = threading.Thread(target=memory, args=(client, stop, rows))
        reader.start()
        begin = time.process_time()
        rd.to_parquet(plan, Path(scratch) / "many", partition_size=1)
        own = time.process_time() - begin
        stop.set()
        reader.join()
    most = max(row[1] for row in rows) - rows[0][1]
    print(f"{len(plan)} partitions: client and scheduler grow by {most:.0f} MB ({1e3 * most / len(plan):.1f} kB each) and take {1e3 * own / len(plan):.2f} ms each")


def plain(plan: rd.Plan) -> float:
    """Processor time of a run in a plain table [s]."""
    begin = time.process_time()
    plan.table(threads=1)
    return (time.process_time() - begin) / len(plan)


def spent(client: Client) -> tuple[float, float]:
    """Processor time so far: of this process, which has client and scheduler, and of all workers [s]."""
    workers = [psutil.Process(pid).cpu_times() for pid in client.run(os.getpid).values()]
    return time.process_time(), sum(times.user + times.system for times in workers)


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


def outcomes(file: str) -> "pd.Series[int]":
    """Rows of a file by outcome."""
    return pd.read_parquet(file, columns=["outcome"])["outcome"].astype(str).value_counts()


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
        before, begin = (loopback(), *spent(client)), time.perf_counter()
        rd.to_parquet(plan, folder, partition_size=size)
        wall, after = time.perf_counter() - begin, (loopback(), *spent(client))
        files = list(folder.glob("*.parquet"))
        counts = pd.concat(client.gather(client.map(outcomes, [str(file) for file in files]))).groupby(level=0).sum()
        stop.set()
        reader.join()
    assert int(counts.sum()) == len(plan)
    stored = sum(file.stat().st_size for file in files)
    moved, own, worked = (late - early for early, late in zip(before, after))
    print(counts.to_string())
    print(f"{wall:.1f} s; processors: client and scheduler {own:.1f} s, workers {worked:.1f} s ({1e6 * worked / len(plan):.3g} us a run)")
    print(f"{moved / 1e6:.2f} MB moved, {len(files)} files of {stored / 1e6:.1f} MB ({stored / len(plan):.3g} bytes a run)")
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
    elif sys.argv[1:2] == ["graph"]:
        graph()
    elif sys.argv[1:2] == ["study"] and len(sys.argv) in (3, 4):
        with tempfile.TemporaryDirectory() as scratch:
            measured(int(float(sys.argv[2])), Path(sys.argv[3] if len(sys.argv) == 4 else f"{scratch}/study"))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
