"""Pickles, threads, processes, Ctrl-C and memory."""

from __future__ import annotations

import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import psutil
import pytest
import rocking as rk

BLOCK = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9)


@pytest.mark.parametrize("friction", [None, 0.2])
def test_scenes_and_runs_are_pickled(scenes: Path, friction: float | None) -> None:
    scene = rk.Scene.load(scenes / "three-drums-pulse.toml")
    scene = scene if friction is None else scene.replace(friction=friction, t_end=2)
    run = rk.simulate(scene)
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(run, protocol))
        assert again == run and again.scene == scene and again.events.equals(run.events) and again.summary == run.summary
        for name in ("t", "theta", "omega", "ground", "pattern", "slide", "gap", "place", "velocity", "force"):
            ours, theirs = getattr(run, name), getattr(again, name)
            assert ours is theirs is None or np.array_equal(ours, theirs), name
    assert pickle.loads(pickle.dumps(scene)) == scene and pickle.loads(pickle.dumps(scene.column)) == scene.column


def test_damaged_pickles_are_refused() -> None:
    from rocking import _rocking

    state = rk.simulate(BLOCK)._response.state()
    for damaged in (b"", state[:7], state[:100], state[:-8], b"\xff" * 40):
        with pytest.raises(ValueError):
            _rocking.Response.from_state(damaged)
    with pytest.raises(ValueError):
        _rocking.Scene.from_state(b"{}")


def test_threads_run_side_by_side_with_the_same_results() -> None:
    scenes = [BLOCK.replace(keys={"excitation.horizontal.amplitude_uplift": 1.0 + 0.05 * number}) for number in range(100)]
    alone = [rk.simulate(scene) for scene in scenes]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(rk.simulate, scenes)) == alone


def test_the_lock_is_released() -> None:
    """A thread counts while another one computes."""
    scene = BLOCK.replace(keys={"solver.method": "rk4", "solver.step": 1e-6, "output.dt": 1.0, "solver.t_end": 2.0})
    worker = threading.Thread(target=rk.simulate, args=(scene,))
    worker.start()
    ticks = 0
    while worker.is_alive():
        time.sleep(1e-3)
        ticks += 1
    assert ticks > 20, f"{ticks} ticks"


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_processes_run_after_a_sweep(method: str) -> None:
    sweep = rk.Sweep(BLOCK, {"amplitude_uplift": {"from": 1, "to": 9, "steps": 200}})
    here = sweep.table()
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as pool:
        assert pool.submit(sweep.table).result(timeout=60).equals(here)
        assert pool.submit(rk.simulate, BLOCK).result(timeout=60) == rk.simulate(BLOCK)


LONG = """
import rocking as rk, sys
scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("harmonic", amplitude_g=0.3, omega=5.0), t_end=1e5, output_dt=1e3)
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted")
    sys.exit(7)
print("finished")
"""
CALLS = {
    "run": "rk.simulate(scene, method='rk4', step=1e-8)",
    "sweep": "rk.sweep(scene.replace(t_end=20, output_dt=1.0), {'amplitude_g': {'from': 0.2, 'to': 0.9, 'steps': 10000000}}, ask='peaks')",
    "study": "rk.ida(scene, rk.synthetic(range(2000), duration=8.0), 'pgv', [x / 500 for x in range(1, 3000)])",
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_ends_a_computation(call: str) -> None:
    process = subprocess.Popen([sys.executable, "-c", LONG.format(call=CALLS[call])], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    time.sleep(1.5)
    asked = time.monotonic()
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert (process.returncode, out) == (7, "interrupted\n")
    assert time.monotonic() - asked < 10.0


RUNS = int(os.environ.get("ROCKING_LEAK_RUNS", "100000"))


def test_nothing_leaks_over_many_runs() -> None:
    """A byte a run would be 100 kB over 1e5 runs; what is allowed is 2 MB of the process and 50 kB of Python."""
    process = psutil.Process()

    def work(count: int) -> None:
        for number in range(count):
            run = rk.simulate(BLOCK, rows=False)
            if number % 100 == 0:
                run = rk.simulate(BLOCK)
                _ = run.theta, run.events, run.summary, pickle.loads(pickle.dumps(run))
                rk.Scene(BLOCK.column, rk.pulse("ricker", amplitude=1.0, omega=2.0))
                with pytest.raises(rk.SceneError):
                    rk.Scene(BLOCK.column, eta=2.0)

    work(RUNS // 10)
    gc.collect()
    tracemalloc.start()
    work(RUNS // 100)
    gc.collect()
    before, rss = tracemalloc.take_snapshot(), process.memory_info().rss
    work(RUNS // 10)
    gc.collect()
    grown = sum(entry.size_diff for entry in tracemalloc.take_snapshot().compare_to(before, "filename"))
    tracemalloc.stop()
    work(RUNS)
    gc.collect()
    assert grown < 50_000, f"Python grew by {grown} bytes"
    leaked = process.memory_info().rss - rss
    assert leaked < 2_000_000 + 8_000_000 * (RUNS < 50_000), f"the process grew by {leaked} bytes"
