"""What all tests share: the repository, and the command line of the same wheel."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path
from typing import Callable

import matplotlib
import pytest

matplotlib.use("agg")

# A job in the background of a script ignores Ctrl-C, and so would the processes that tests start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def scenes() -> Path:
    return ROOT / "scenes"


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """Runs ``rocking ARGUMENTS`` in a process of its own; what it prints."""

    def run(*arguments: object) -> str:
        words = [sys.executable, "-m", "rocking", *map(str, arguments)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
