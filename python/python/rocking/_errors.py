"""Errors, with the text of the library: file, line, key, what is wrong, what to do."""

from __future__ import annotations

import errno
import sys
import warnings
from collections.abc import Sequence
from typing import Any


class RockingError(Exception):
    """Base of all errors of the package."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


#: Attributes of a :class:`SceneError` that are made of its arguments.
MADE = ("file", "line", "key", "problem", "remedy", "record", "faults")


class SceneError(RockingError, ValueError):
    """A scene, a sweep or a study is refused.

    Attributes
    ----------
    file : str
        The file, or the folder of records. What was made in Python has a name in angle brackets instead, such as ``<sweep>`` or ``<scene>``; lines of a
        scene are those of ``Scene.toml``.
    line : int
        Line of the file, from 1; 0 where there is none.
    key : str
        Dotted key, e.g. ``solver.t_end``.
    problem, remedy : str
        What is wrong, and what to do.
    record : str
        The record's file, where a record is at fault.
    faults : tuple of SceneError
        All faults, in the order of the text; of a single one, this error alone.
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

    def __reduce__(self) -> tuple[Any, ...]:
        # Pickled by its own arguments. Workers of `distributed` take another way for errors that do not say how: it fails for a class that is an OSError and a
        # ValueError, and it does not end for one of several faults that was raised again, as that stands in the arguments of the error in whose handling it was.
        faults = [] if self.faults[0] is self else self.faults
        given = {name: value for name, value in self.__dict__.items() if name not in MADE}
        return _again, (type(self), self._arguments(), [(type(fault), fault._arguments()) for fault in faults]), given

    def _arguments(self) -> list[Any]:
        return [str(self), self.file, self.line, self.key, self.problem, self.remedy, self.record]


def _again(kind: type[SceneError], own: Sequence[Any], faults: Sequence[tuple[type[SceneError], Sequence[Any]]] = ()) -> SceneError:
    """An error made anew when it is unpickled."""
    arguments: list[Any] = [*own, tuple(_again(*fault) for fault in faults)]
    return kind(*arguments)


class MissingFileError(SceneError, FileNotFoundError):
    """A scene file, a sweep file, a study file, a folder of records, or a record that a scene names is not there. ``filename`` is its path."""

    def __init__(self, message: str, file: str = "", *details: Any) -> None:
        super().__init__(message, file, *details)
        self.errno, self.strerror, self.filename = errno.ENOENT, message, self.record or file


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
    """A study is refused: it has no record or no level, its table lacks a column, or a limit state needs a column that the table lacks."""


class FolderError(RockingError, OSError):
    """The folder of a run cannot be written or read."""


MOST_WARNINGS = 10


def warn(sentences: list[str]) -> None:
    """Warns of the first of these, and of how many others there are, at the line from which the package was called."""
    stacklevel, frame = 2, sys._getframe(1)
    while frame.f_back is not None and (frame.f_globals.get("__name__") or "").split(".")[0] == __package__:
        stacklevel, frame = stacklevel + 1, frame.f_back
    others = len(sentences) - MOST_WARNINGS
    for sentence in sentences[:MOST_WARNINGS] + ([f"and {others} more"] if others > 0 else []):
        warnings.warn(sentence, stacklevel=stacklevel)
