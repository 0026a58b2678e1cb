"""Trust: how far a run is determined, by companions that differ from it by less than anybody can know."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Trust:
    """What the companions of a run say; the fields are those of ``trust`` in ``summary.json``."""

    outcome: str
    """The verdict in words as far as it is determined: ``stands``, ``overturns``, ``collapses``, ``not determined``; ``ends undetermined``."""
    determined: bool
    """Whether the verdict is determined: certain within the horizon, and that of all companions."""
    verdict: str
    """Of the run itself: ``stands``, ``may-overturn``, ``overturns``, ``collapses`` or ``undetermined``."""
    certain_at: float
    """Time from which that verdict was certain [s]."""
    horizon: float
    """Time up to which the angles are known [s]; ``ends_at`` where companions agree to the end."""
    solver_horizon: float
    """The same of the companion with a tighter tolerance alone [s]."""
    input_horizon: float
    """The same of all companions [s]: beyond it angles hang on the seventh digit of the inputs."""
    ends_at: float
    """When the run ended [s]."""
    compared_every: float
    """Interval between the rows that were compared [s]: horizons are no finer."""
    amplification: float
    """Largest change of an angle over α, per relative change of the inputs, dimensionless."""
    grows_on: bool
    """Whether the amplification is a lower bound."""
    same_block: bool
    """Whether the same block overturns or collapses in all runs."""
    companions: tuple[dict[str, Any], ...] = field(repr=False)
    """Per companion ``change``, ``verdict``, ``block``, ``ends_at``, ``parts_at`` [s] and ``difference``."""
    further: dict[str, int] | None
    """More companions with changes up to 1e-6: how many ``runs``, and how many ``others`` have another verdict; None where the nine decide."""
    fold: dict[str, Any] | None
    """Relative changes of the shaking that were ``tried``, and the ``turns`` that change the verdict; None for a run that is not determined, or without ground motion."""
    sentence: str
    """Trust in a line, as ``rocking run`` prints it."""

    @classmethod
    def _of(cls, summary: dict[str, Any], sentence: str) -> "Trust":
        return cls(**{**summary, "companions": tuple(summary["companions"])}, sentence=sentence)

    def __str__(self) -> str:
        return f"{self.outcome}: {self.sentence}"
