"""What Python costs: a run and a sweep against Rust, and a run against the notebook with `solve_ivp` that people write today.

    python python/benchmarks/benchmark.py [SECONDS_OF_RUST_RUN SCENES_PER_SECOND_OF_RUST]

The figures of Rust come from `cargo run --release` in python/benchmarks/rust, which runs the same scenes. Each time is the least of many: others use the machine too.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable

import numpy as np
import rocking as rk
from scipy.integrate import solve_ivp

HALF_WIDTH, HALF_HEIGHT, G = 0.3974745895307783, 1.5566366369849045, 9.81
ETA, T_END = 0.9, 10.0


def least(work: Callable[[], object], times: int, inner: int = 1) -> float:
    """The least time of a call [s]."""
    best = math.inf
    for _ in range(times):
        begin = time.perf_counter()
        for _ in range(inner):
            work()
        best = min(best, (time.perf_counter() - begin) / inner)
    return best


def notebook(amplitude: float, omega: float, rtol: float) -> tuple[float, int]:
    """A block under a one-sine pulse as in a notebook: an event for each impact, a restart after it. The angle at the end and the number of impacts."""
    alpha, radius = math.atan2(HALF_WIDTH, HALF_HEIGHT), math.hypot(HALF_WIDTH, HALF_HEIGHT)
    p2, end = 3 * G / (4 * radius), 2 * math.pi / omega

    def right(t: float, x: np.ndarray, sign: float) -> list[float]:
        ground = amplitude * math.sin(omega * t) if t < end else 0.0
        return [x[1], -p2 * (math.sin(sign * alpha - x[0]) + ground / G * math.cos(sign * alpha - x[0]))]

    def lands(t: float, x: np.ndarray, sign: float) -> float:
        return sign * x[0]

    lands.terminal, lands.direction = True, -1
    # The ground acceleration that opens the base.
    t = math.asin(math.tan(alpha) * G / amplitude) / omega
    x, sign, impacts = np.zeros(2), -1.0, 0
    atol = 1e-3 * rtol
    while t < T_END:
        # The pulse's end is a kink: no step may pass it.
        stop = end if t < end else T_END
        run = solve_ivp(right, (t, stop), x, method="DOP853", rtol=rtol, atol=atol, events=lands, args=(sign,))
        t, x = run.t[-1], run.y[:, -1]
        if run.status == 1:
            impacts += 1
            x, sign = np.array([0.0, ETA * x[1]]), -sign
            if abs(x[1]) < 1e-9:
                break
    return float(x[0]), impacts


def main() -> None:
    column = rk.Column.prisms(1, half_width=HALF_WIDTH, half_height=HALF_HEIGHT)
    alpha = column.alpha
    # The paper's block at 3.00 αg, which rocks to the end.
    amplitude, omega = 7.3575, 10.7
    motion = rk.pulse("sine-pulse", amplitude=amplitude, omega=omega)
    scene = rk.Scene(column, motion, eta=ETA, t_end=T_END)
    figures: dict[str, float] = {}

    # A run.
    def bare() -> object:
        return rk.simulate(scene, rows=False, forces=False)

    figures["run, us"] = 1e6 * least(bare, 200, 100)
    figures["run, of which Rust says, us"] = 1e6 * min(bare().seconds for _ in range(20000))  # type: ignore[attr-defined]
    figures["run with rows, us"] = 1e6 * least(lambda: rk.simulate(scene), 100, 20)
    figures["run with rows and arrays, us"] = 1e6 * least(lambda: rk.simulate(scene).theta, 100, 20)
    figures["run of column and motion, us"] = 1e6 * least(lambda: rk.simulate(column, motion, eta=ETA, t_end=T_END, rows=False, forces=False), 100, 20)

    # A sweep.
    spectrum = rk.Sweep(
        scene.replace(keys={"solver.rtol": 1e-6, "solver.t_end": 20.0}),
        {"omega_p": {"from": 0.5, "to": 10.0, "steps": 191}, "amplitude": {"from": 1.0, "to": 40.0, "steps": 1000}},
    )
    for threads in (1, 2):
        seconds = least(lambda: spectrum.table(threads=threads), 3)
        figures[f"sweep, {threads} thread(s), scenes/s"] = len(spectrum) / seconds

    # The same in Rust.
    rust = Path(__file__).parent / "rust"
    if "--rust" in sys.argv:
        told = subprocess.run(["cargo", "run", "--release", "--quiet"], cwd=rust, capture_output=True, text=True, check=True).stdout
        figures.update({f"Rust: {name}": value for name, value in json.loads(told).items()})

    # The notebook: error of the angle at the end against the tightest run.
    truth = rk.simulate(scene.replace(rtol=1e-13, atol=1e-16, output_dt=T_END)).theta[-1, 0]
    print(f"angle at {T_END} s: {truth!r} rad")
    for rtol in (1e-6, 1e-8, 1e-10, 1e-12):
        angle, impacts = notebook(amplitude, omega, rtol)
        figures[f"solve_ivp, rtol {rtol:g}: error, rad"] = abs(angle - truth)
        figures[f"solve_ivp, rtol {rtol:g}: ms"] = 1e3 * least(lambda: notebook(amplitude, omega, rtol), 5)
        figures[f"solve_ivp, rtol {rtol:g}: impacts"] = impacts
    for rtol in (1e-4, 1e-6, 1e-8, 1e-9, 1e-10):
        run = scene.replace(rtol=rtol, atol=1e-3 * rtol, output_dt=T_END)
        figures[f"rocking, rtol {rtol:g}: error, rad"] = abs(rk.simulate(run).theta[-1, 0] - truth)
        figures[f"rocking, rtol {rtol:g}: us"] = 1e6 * least(lambda: rk.simulate(run), 50, 20)
        figures[f"rocking, rtol {rtol:g}: impacts"] = rk.simulate(run).impacts
    for name, value in figures.items():
        print(f"{name:48} {value:.4g}")


if __name__ == "__main__":
    main()
