"""The command line: ``python -m rocking run scene.toml``, or ``rocking`` where scripts are installed."""

from __future__ import annotations

import signal
import sys

from . import _rocking


def main() -> int:
    """Carries out the command of ``sys.argv``; the exit status."""
    # Ctrl-C ends the program, as it does without Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _rocking.command_line(["rocking", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
