"""Errors, with the text of the library: file, line, key, what is wrong, what to do."""

from __future__ import annotations

import errno
import warnings
from typing import Any


class RockingError(Exception):
    """Base of all errors of the package."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class SceneError(RockingError, ValueError):
    """A scene, a sweep or a study is refused.

    Attributes
    ----------
    file : str
        The scene file; ``<scene>`` for one made in Python, whose text is ``Scene.toml``.
    line : int
        Line of the file, from 1; 0 where there is none.
    key : str
        Dotted key, e.g. ``solver.t_end``.
    problem, remedy : str
        What is wrong, and what to do.
    record : str
        The record's file, where a record is at fault.
    faults : tuple of SceneError
        All faults, where there are several.
    """

    def __init__(
        self,
        message: str,
        file: str = "",
        line: int = 0,
        key: str = "",
        problem: str = "",
        remedy: str = "",
        record: str = "",
        faults: tuple["SceneError", ...] = (),
    ) -> None:
        super().__init__(message, file, line, key, problem, remedy, record, faults)
        first = faults[0] if faults else None
        self.file: str = first.file if first else file
        self.line: int = first.line if first else line
        self.key: str = first.key if first else key
        self.problem: str = first.problem if first else problem
        self.remedy: str = first.remedy if first else remedy
        self.record: str = record
        self.faults: tuple[SceneError, ...] = faults or (self,)


class MissingFileError(SceneError, FileNotFoundError):
    """A file of a scene, a sweep or a study, or a folder of records, is not there. ``filename`` is its path, as is ``file``."""

    def __init__(self, message: str, file: str = "", *details: Any) -> None:
        super().__init__(message, file, *details)
        self.errno, self.strerror, self.filename = errno.ENOENT, message, file


class RecordError(RockingError, ValueError):
    """A record is refused. ``file`` is its file, or its name."""

    def __init__(self, message: str, file: str = "") -> None:
        super().__init__(message, file)
        self.file: str = file


class SolveError(RockingError, RuntimeError):
    """A run could not be finished. ``time`` [s] is where it ended."""

    def __init__(self, message: str, time: float | None = None) -> None:
        super().__init__(message, time)
        self.time: float | None = time


class StudyError(RockingError, ValueError):
    """A study is refused: no record, no level, a state that its runs do not tell."""


class FolderError(RockingError, OSError):
    """The folder of a run cannot be written or read."""


MOST_WARNINGS = 10


def warn(sentences: list[str], stacklevel: int) -> None:
    """Warns of the first of these, and of how many others there are, ``stacklevel`` calls above."""
    others = len(sentences) - MOST_WARNINGS
    for sentence in sentences[:MOST_WARNINGS] + ([f"and {others} more"] if others > 0 else []):
        warnings.warn(sentence, stacklevel=stacklevel)
