"""Ground motion by formulas: the keys of one component of a scene file."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any, Union

import numpy as np

from ._keys import copied
from ._record import Record, StudyRecord

#: What shakes in one direction: a pulse, a record, or the keys of a component as a mapping.
MotionLike = Union["Motion", Record, Mapping[str, Any]]


class Motion(Mapping[str, Any]):
    """The keys of one component of the ground motion, as below ``[excitation.horizontal]``; not changed after it was made."""

    def __init__(self, **keys: Any) -> None:
        self._keys = {key: copied(value) for key, value in keys.items() if value is not None}

    def __getitem__(self, key: str) -> Any:
        return copied(self._keys[key])

    def __contains__(self, key: object) -> bool:
        return key in self._keys

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mapping) and _plain(self) == _plain(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Motion({', '.join(f'{key}={value!r}' for key, value in self._keys.items())})"

    def __add__(self, other: MotionLike) -> "Motion":
        return total(self, other)

    def replace(self, **keys: Any) -> "Motion":
        """The motion with other keys; ``None`` removes one."""
        return Motion(**{**self._keys, **keys})

    def _scene_keys(self) -> dict[str, Any]:
        return self._keys


def _plain(value: Any) -> Any:
    """Keys in which arrays are lists, so that they can be compared."""
    if isinstance(value, Mapping):
        return {key: _plain(own) for key, own in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(own) for own in (value.tolist() if isinstance(value, np.ndarray) else value)]
    return value


def pulse(
    kind: str,
    *,
    amplitude: float | None = None,
    amplitude_g: float | None = None,
    amplitude_uplift: float | None = None,
    velocity: float | None = None,
    omega: float | None = None,
    frequency: float | None = None,
    period: float | None = None,
    omega_p: float | None = None,
    start: float | None = None,
    phase: float | None = None,
    gamma: float | None = None,
    duration: float | None = None,
    cycles: int | None = None,
) -> Motion:
    """A motion by a formula. Exactly one amplitude is given, and one frequency; rectangular pulses have a duration in its place.

    The scene that takes the motion checks its keys, and raises :class:`SceneError`. Formulas and sources are in the book's chapter Ground motion.

    Parameters
    ----------
    kind : str
        ``sine-pulse``, ``cosine-pulse``, ``half-sine``, ``type-c``, ``ricker``, ``antisymmetric-ricker``, ``mavroeidis-papageorgiou``, ``gabor``,
        ``rectangular``, ``double-rectangular`` or ``harmonic``.
    amplitude, amplitude_g, amplitude_uplift : float
        Amplitude of the acceleration in m/s², in g, or in units of ``g tan α``, the acceleration that opens the base of the column.
    velocity : float
        Amplitude of the velocity [m/s], of ``mavroeidis-papageorgiou`` and ``gabor``.
    omega, frequency, period, omega_p : float
        Angular frequency [rad/s], frequency [Hz], period [s], or angular frequency in units of the frequency parameter p of the column as one body.
    start : float
        Time at which the motion begins [s], 0 unless given.
    phase : float
        Phase [rad], of ``harmonic``, ``mavroeidis-papageorgiou`` and ``gabor``.
    gamma : float
        Width of the envelope, dimensionless, of ``mavroeidis-papageorgiou`` and ``gabor``.
    duration : float
        Duration of the rectangular pulses and of ``harmonic`` [s]; a harmonic motion has no end unless it is given.
    cycles : int
        Number of cycles of ``type-c``.

    >>> pulse("ricker", amplitude_g=0.4, frequency=1.2)
    Motion(kind='ricker', amplitude_g=0.4, frequency=1.2)
    """
    return Motion(
        kind=kind,
        amplitude=amplitude,
        amplitude_g=amplitude_g,
        amplitude_uplift=amplitude_uplift,
        velocity=velocity,
        omega=omega,
        frequency=frequency,
        period=period,
        omega_p=omega_p,
        start=start,
        phase=phase,
        gamma=gamma,
        duration=duration,
        cycles=cycles,
    )


def checked(name: str, motion: Any) -> Any:
    """What shakes in one direction; another thing is refused, with what to make of it."""
    if isinstance(motion, (Record, Mapping)):
        return motion
    if isinstance(motion, StudyRecord):
        remedy = "give one of its components, as `record.horizontal`"
    elif isinstance(motion, (str, os.PathLike)):
        remedy = f"read the record with Record.read({os.fspath(motion)!r})"
    elif isinstance(motion, (list, tuple)) or hasattr(motion, "__array__"):
        remedy = "make a record of accelerations with Record(accelerations, dt=0.01)"
    else:
        remedy = "give a motion, as of pulse(..) or Record.read(..), or the keys of one"
    raise TypeError(f"{name} is of {type(motion).__name__}; {remedy}")


def total(*terms: MotionLike) -> Motion:
    """The sum of several motions; of a sum among them the terms are taken.

    Raises
    ------
    TypeError
        For a term that is no motion.
    """
    items: list[Any] = []
    for number, term in enumerate(terms, start=1):
        checked(f"motion {number} of the sum", term)
        if isinstance(term, Motion) and set(term) == {"kind", "term"} and term["kind"] == "sum":
            items.extend(term["term"])
        else:
            items.append(dict(term) if isinstance(term, Mapping) else term)
    return Motion(kind="sum", term=items)
