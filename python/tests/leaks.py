"""A process that runs a scene again and again, and prints as JSON what it holds more after each batch of runs."""

from __future__ import annotations

import ctypes
import gc
import json
import pickle
import sys
import tracemalloc

import psutil
import rocking as rk

BATCHES = 4


class Mallinfo2(ctypes.Structure):
    """What glibc tells of its allocator; ``uordblks`` and ``hblkhd`` are bytes in use."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")
    ]


def bytes_in_use() -> int | None:
    """Bytes that C and Rust have allocated and not freed; None where the allocator does not tell."""
    mallinfo2 = getattr(ctypes.CDLL(None), "mallinfo2", None) if sys.platform == "linux" else None
    if mallinfo2 is None:
        return None
    mallinfo2.restype = Mallinfo2
    told = mallinfo2()
    return int(told.uordblks + told.hblkhd)


def work(scene: rk.Scene, count: int) -> None:
    for number in range(count):
        run = rk.simulate(scene, rows=False)
        if number % 100 == 0:
            run = rk.simulate(scene)
            _ = run.theta, run.events, run.summary, pickle.loads(pickle.dumps(run))
            rk.Scene(scene.column, rk.pulse("ricker", amplitude=1.0, omega=2.0))
            try:
                rk.Scene(scene.column, eta=2.0)
            except rk.SceneError:
                continue
            raise AssertionError("eta = 2 is refused")


def main(runs: int) -> None:
    block = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9)
    process = psutil.Process()
    work(block, runs // 10)
    held: dict[str, list[int]] = {"resident": [], "allocated": [], "blocks": []}
    for _ in range(BATCHES + 1):
        gc.collect()
        held["blocks"].append(sys.getallocatedblocks())
        held["resident"].append(process.memory_info().rss)
        if (in_use := bytes_in_use()) is not None:
            held["allocated"].append(in_use)
        if len(held["blocks"]) <= BATCHES:
            work(block, runs // BATCHES)
    grown = {name: [after - before for before, after in zip(values, values[1:])] for name, values in held.items()}
    tracemalloc.start()
    work(block, runs // 100)
    gc.collect()
    before = tracemalloc.take_snapshot()
    work(block, runs // 10)
    gc.collect()
    grown["traced"] = [sum(entry.size_diff for entry in tracemalloc.take_snapshot().compare_to(before, "filename"))]
    print(json.dumps(grown))


if __name__ == "__main__":
    main(int(sys.argv[1]))
