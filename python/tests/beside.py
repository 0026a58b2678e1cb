"""What a thread can do beside a computation."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


def ticks_during(compute: Callable[[], object]) -> int:
    """Milliseconds, at most, that this thread counts while another one computes: few where that holds the interpreter's lock."""
    worker = threading.Thread(target=compute)
    worker.start()
    ticks = 0
    while worker.is_alive():
        time.sleep(1e-3)
        ticks += 1
    return ticks
