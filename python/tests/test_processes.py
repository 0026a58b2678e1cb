"""Pickles, threads, processes, Ctrl-C and memory."""

from __future__ import annotations

import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import rocking as rk
from beside import ticks_during

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
    assert ticks_during(lambda: rk.simulate(scene)) > 20


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_processes_run_after_a_sweep(method: str) -> None:
    sweep = rk.Sweep(BLOCK, {"amplitude_uplift": {"from": 1, "to": 9, "steps": 200}})
    here = sweep.table()
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method)) as pool:
        assert pool.submit(sweep.table).result(timeout=60).equals(here)
        assert pool.submit(rk.simulate, BLOCK).result(timeout=60) == rk.simulate(BLOCK)


LONG = """
import pandas as pd, rocking as rk, sys, time
scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("harmonic", amplitude_g=0.3, omega=5.0), t_end=1e5, output_dt=1e3)
short = scene.replace(t_end=2, output_dt=1.0)
began = time.monotonic()
{before}
print(time.monotonic() - began, flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted")
    sys.exit(7)
print("finished")
"""
#: Each takes minutes or hours; companions of a run, on one thread, twelve times as long as the run (measured).
CALLS = {
    "run": "rk.simulate(scene, method='rk4', step=1e-8)",
    "companions": "rk.simulate(short, method='rk4', step=5e-7, trust=True, threads=1)",
    "sweep": "rk.sweep(scene.replace(t_end=2000, output_dt=100.0), {'amplitude_g': {'from': 0.2, 'to': 0.9, 'steps': 100_000}}, ask='peaks')",
    "study": "rk.ida(scene, rk.synthetic(range(2000), duration=8.0), 'pgv', [x / 500 for x in range(1, 3000)])",
    "sweep whose runs differ": "rk.sweep(scene.replace(t_end=10, output_dt=1.0, method='rk4'),"
    " {'step': [1e-3, 1e-6], 'amplitude_g': {'from': 0.2, 'to': 0.3, 'steps': 1000}}, ask='peaks')",
    "sweep of long runs": "rk.sweep(scene.replace(method='rk4', step=1e-8), {'amplitude_g': [0.2, 0.3]})",
    "companions of a sweep": "rk.sweep(short.replace(method='rk4', step=3e-7), {'amplitude_g': [0.2, 0.3]}, ask='trust', threads=1)",
    "study of long runs": "rk.ida(scene.replace(method='rk4', step=1e-8), rk.synthetic(range(2), duration=8.0), 'pgv', [0.6, 0.7])",
    "bands": "rk.Study(pd.DataFrame({'record': [str(i // 960) for i in range(96_000)], 'pgv': [0.01 * (1 + i % 960) for i in range(96_000)],"
    " 'outcome': ['overturns' if (i * 7) % 960 < i % 960 else 'rocks' for i in range(96_000)]})).fragility(replicates=1_000_000)",
    "spectrum": "rk.Record.synthetic(1, duration=400.0, dt=0.005).spectrum([0.02 * 1.00001**x for x in range(30_000)])",
}
#: What a call does first, and is not asked about: companions follow the runs that they accompany.
BEFORE = {
    "companions": "rk.simulate(short, method='rk4', step=5e-7)",
    "companions of a sweep": "rk.sweep(short.replace(method='rk4', step=3e-7), {'amplitude_g': [0.2, 0.3]}, ask='peaks')",
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_ends_a_computation(call: str) -> None:
    code = LONG.format(before=BEFORE.get(call, ""), call=CALLS[call])
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    before = float(process.stdout.readline())
    time.sleep(1.5 + 1.5 * before)
    process.send_signal(signal.SIGINT)
    try:
        # The answer takes a few tenths of a second; on a machine with other work, tenfold.
        out, _ = process.communicate(timeout=5 + 3 * before if call in BEFORE else 60)
    finally:
        process.kill()
    assert (process.returncode, out) == (7, "interrupted\n")


def test_a_table_beyond_the_memory_is_refused() -> None:
    """The interpreter was aborted."""
    many = {"from": 0.1, "to": 1.0, "steps": 100_000}
    sweep = rk.Sweep(BLOCK, {"eta": many, "amplitude_uplift": many})
    for table in (sweep.table, sweep.to_arrow):
        with pytest.raises(MemoryError, match=r"10000000000 rows do not fit into the memory; give `start` and `stop`"):
            table()
    assert len(sweep.table(len(sweep) - 3)) == 3


RUNS = int(os.environ.get("ROCKING_LEAK_RUNS", "100000"))


def test_nothing_leaks_over_many_runs() -> None:
    """What is lost a run grows with every batch of runs; what caches, arenas and fragmentation hold grows in some and comes to an end. So the least
    growth of four equal batches counts, in a process of its own, in which no other test has left memory behind that would be used again.

    Allowed are 4 bytes and a hundredth of an object of Python a run (measured: 0 and 0.0001). The smallest allocation of C or Rust takes 32 bytes,
    the smallest object of Python is one. Traced memory of Python may grow by 5 bytes a run.
    """
    program = Path(__file__).with_name("leaks.py")
    told = subprocess.run([sys.executable, str(program), str(RUNS)], stdout=subprocess.PIPE, text=True, check=True).stdout
    grown = json.loads(told)
    batch = RUNS // len(grown["blocks"])
    least = {name: min(growths) for name, growths in grown.items() if growths}
    assert least["resident"] < 4 * batch and least.get("allocated", 0) < 4 * batch, f"{batch} runs each: {grown}"
    assert least["blocks"] < batch / 100, f"{batch} runs each: {grown}"
    assert least["traced"] < 5 * (RUNS // 10), f"{RUNS // 10} runs: {grown}"


SLOW = """
friction = 0.6
column = { blocks = 4, half_width = 0.35, half_height = 2.5, shape = "drum", density = 2500 }
restitution = { eta = 0.9 }
solver = { method = "rk4", step = 2e-4, t_end = 10 }
initial = { theta = [0.02, 0.02, 0.02, 0.02] }
"""
STUDIES = {
    "sweep": 'scene = "column.toml"\n[axes]\neta = { from = 0.8, to = 0.9, steps = 500 }\n',
    "ida": 'scene = "column.toml"\nmeasure = "pgv"\ntrust = false\nlevels = [0.1, 0.2]\n[records.synthetic]\nseeds = { from = 0, to = 49 }\n',
}


@pytest.mark.parametrize("study", STUDIES)
def test_an_interrupted_command_keeps_the_rows_that_are_done(study: str, tmp_path: Path) -> None:
    """Rows were written in batches of 256 points or 16 runs: studies of slow runs that were stopped every few seconds never got on."""
    (tmp_path / "column.toml").write_text(SLOW)
    (tmp_path / "study.toml").write_text(STUDIES[study])
    words = [sys.executable, "-m", "rocking", study, "study.toml", "--out", "table.csv", "--quiet", "--threads", "1"]

    def rows() -> int:
        return sum(len(part.read_bytes().splitlines()) - 1 for part in tmp_path.glob(".table.csv.*.part"))

    kept = 0
    for _ in range(2):
        with subprocess.Popen(words, cwd=tmp_path) as process:
            until = time.monotonic() + 60.0
            while rows() < kept + 2 and time.monotonic() < until:
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
        # Of a batch more would stand there at once.
        assert kept + 2 <= rows() < kept + 16
        kept = rows()
