"""Trust: how far a run is determined, by companions that differ from it by less than anybody can know."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Trust:
    """How far a run is determined, by runs of almost the same scene, its companions (book, chapter Trust). Fields are those of ``trust`` in ``summary.json``."""

    outcome: str
    """The verdict in words, as far as it is determined: ``stands``, ``stands up to the end of the run`` (the ground may still move, or blocks slide on, then), ``overturns``,
    ``collapses``, ``not determined``, or ``ends undetermined`` (a run with friction that has no answer)."""
    determined: bool
    """Whether the verdict is determined: it is certain within the horizon, and all companions have it."""
    likely: bool
    """Whether a verdict that is not determined is that of all companions, 24 further ones included."""
    verdict: str
    """Verdict of the run itself: ``stands``, ``may-overturn``, ``overturns``, ``collapses`` or ``undetermined``."""
    certain_at: float
    """Time from which that verdict was certain [s]."""
    horizon: float
    """Time up to which the angles of the run and of all companions but those with changes of 1e-6 agree [s]; ``ends_at`` where they agree to the end."""
    solver_horizon: float
    """Time up to which the companion with a tighter tolerance agrees [s]: the solver's own error is small up to then."""
    input_horizon: float
    """Time up to which all companions agree [s]: beyond it the angles depend on the seventh digit of the inputs."""
    slide_horizon: float | None
    """Time up to which the slides of all companions agree [s]; None where they agree to the end, or nothing slides."""
    ends_at: float
    """When the run ended [s]."""
    compared_every: float
    """Interval between the rows that were compared [s]: horizons are no finer."""
    amplification: float
    """Largest change of an angle over α, with friction also of a slide over the contact's half-width, per relative change of the inputs; dimensionless."""
    grows_on: bool
    """Whether the amplification is a lower bound."""
    same_block: bool
    """Whether all companions lose the same block as the run, or none where the run loses none."""
    companions: tuple[dict[str, Any], ...] = field(repr=False)
    """For each companion: its ``change`` (``tolerance`` with the factor, or ``excitation`` or ``sizes`` with the relative change), its ``verdict`` (None if the
    run failed), the ``block`` that is lost (None if none is), ``ends_at`` [s], ``parts_at`` and ``slides_part_at`` [s] (None where angles and slides agree to the
    end), and the largest
    ``difference``, as in ``amplification``."""
    further: dict[str, int] | None
    """More companions with changes up to 1e-6: how many ``runs``, and how many ``others`` failed or have another verdict; None where the first ones decide."""
    fold: dict[str, Any] | None
    """The relative changes of the shaking that were ``tried``, each up and down, and in ``turns`` those of the smallest size that turn the verdict (overturning
    and collapse count as one). None for a run that is not determined, or without ground motion."""
    sentence: str
    """Trust in a line, as ``rocking run`` prints it."""

    @classmethod
    def _of(cls, summary: dict[str, Any], sentence: str) -> "Trust":
        return cls(**{**summary, "companions": tuple(summary["companions"])}, sentence=sentence)

    def __str__(self) -> str:
        return f"{self.outcome}: {self.sentence}"
