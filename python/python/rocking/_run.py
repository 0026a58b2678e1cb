"""Runs: arrays, events, summary, pictures."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal, NoReturn, TypeVar

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _rocking
from ._arguments import flag, path_text, text, whole
from ._errors import SceneError
from ._files import write_text
from ._motion import MotionLike
from ._record import Array, _fixed
from ._scene import Column, Scene, SceneKeys
from ._trust import Trust

#: Interval of rows that leaves one [s].
NO_ROWS = 1e9

#: What is asked of a run.
Wanted = Literal["everything", "outcome", "overturns"]

#: What the contacts transmit, with units.
FORCES = (("normal", "N"), ("tangential", "N"), ("moment", "N m"))

_T = TypeVar("_T")


class computed_once(cached_property[_T]):
    """A property that is computed when it is first read, and cannot be set."""

    def __set__(self, instance: object, value: object) -> NoReturn:
        raise AttributeError(f"{self.attrname} of a run is a result and cannot be set")


if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from typing_extensions import Unpack


#: How JSON has numbers that are not finite.
NOT_FINITE = {"infinite": math.inf, "-infinite": -math.inf, "not a number": math.nan}

#: Keys of a summary whose values are texts of the user, whatever they say.
TEXTS = ("title", "file", "text", "name")


def _with_numbers(value: Any, key: str = "") -> Any:
    """A part of a summary, with numbers in the place of :data:`NOT_FINITE`."""
    if isinstance(value, dict):
        return {name: _with_numbers(own, name) for name, own in value.items()}
    if isinstance(value, list):
        return [_with_numbers(own, key) for own in value]
    return NOT_FINITE.get(value, value) if isinstance(value, str) and key not in TEXTS else value


def simulate(
    column: "Scene | Column | Iterable[Mapping[str, Any]]",
    motion: MotionLike | None = None,
    *,
    vertical: MotionLike | None = None,
    rows: bool = True,
    forces: bool = True,
    wanted: Wanted = "everything",
    trust: bool = False,
    threads: int = 0,
    **arguments: "Unpack[SceneKeys]",
) -> "Run":
    """Runs a scene, or a column under a ground motion.

    The computation releases the interpreter's lock, and Ctrl-C ends it.

    Parameters
    ----------
    column : Scene, Column or blocks
    motion, vertical : Motion, Record or mapping
        Ground motion; of a scene, in place of its own.
    rows : bool
        Whether rows are returned, every ``output_dt`` seconds or at the times ``t_eval``. Without them a short run takes a fraction of the time.
    forces : bool
        Whether the summary has friction demand and smallest normal force of each interface. :attr:`Run.force` does not depend on it.
    wanted : str
        ``everything``, ``outcome`` (whether and when it overturns: no rows, events, peaks or forces) or ``overturns`` (whether it does).
    trust : bool
        Whether the run is followed by its companions, as ``rocking run`` does: ``run.trust`` then says how far it is determined. The run itself is the same.
        Companions take 7 to 30 times as long as the run, up to 73 times where nine are too few. With ``wanted="everything"`` alone.
    threads : int
        Threads of the companions, 0 for as many as the machine has: 1 where each of many processes runs scenes of its own. A run itself takes one.
    **arguments
        As of :class:`Scene`.

    Raises
    ------
    SceneError
        For a scene that is refused, with the key and the remedy.
    SolveError
        For a run that cannot go on, with the time.
    ValueError
        For what cannot be ``wanted``, or ``wanted`` with ``trust``; for a negative number of ``threads``, or more than 1024.

    >>> run = simulate(Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=2, output_dt=0.5)
    >>> run.t.tolist(), run.theta.shape, run.impacts
    ([0.0, 0.5, 1.0, 1.5, 2.0], (5, 1), 2)
    >>> simulate(run.scene, t_eval=[0.1, 0.75, 2.0]).t.tolist()
    [0.1, 0.75, 2.0]
    """
    if "horizontal" in arguments:
        raise TypeError("there is no argument `horizontal`; give the horizontal motion as `motion`, after the column")
    base = column if isinstance(column, (Scene, Column)) else Column(column)
    try:
        scene = _scene(base, motion, vertical, arguments)
    except SceneError as refused:
        makes_rows = rows and wanted == "everything"
        if makes_rows or arguments.get("output_dt") is not None or arguments.get("t_eval") is not None or "rows up to t_end" not in str(refused):
            raise
        # Rows at the usual interval are too many for the memory, and none are asked for.
        scene = _scene(base, motion, vertical, {**arguments, "output_dt": NO_ROWS})
    flags = {name: flag(name, value) for name, value in (("rows", rows), ("forces", forces), ("trust", trust))}
    return Run(scene, scene._compiled.run(wanted=text("wanted", wanted), threads=whole("threads", threads), **flags))


def _scene(column: Scene | Column, motion: MotionLike | None, vertical: MotionLike | None, arguments: "SceneKeys") -> Scene:
    if not isinstance(column, Scene):
        return Scene(column, motion, vertical, **arguments)
    if arguments or motion is not None or vertical is not None:
        return column.replace(horizontal=motion, vertical=vertical, **arguments)
    return column


def trust(
    column: "Scene | Column | Iterable[Mapping[str, Any]]",
    motion: MotionLike | None = None,
    *,
    vertical: MotionLike | None = None,
    threads: int = 0,
    **arguments: "Unpack[SceneKeys]",
) -> Trust:
    """How far the run of a scene is determined: ``simulate(..., trust=True).trust``, of a run without rows.

    ``threads`` is the number of threads of the companions, 0 for as many as the machine has.

    >>> found = trust(Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=2)
    >>> found.outcome, found.determined, len(found.companions)
    ('stands', True, 9)
    """
    for name in {"rows", "forces", "wanted", "trust"} & set(arguments):
        raise TypeError(f"there is no argument `{name}` of rocking.trust: it has no rows and no forces; use rocking.simulate")
    found = simulate(column, motion, vertical=vertical, rows=False, forces=False, trust=True, threads=threads, **arguments).trust
    assert found is not None
    return found


class Run:
    """The response of a column. Blocks and interfaces are base first; arrays are read-only, ``copy()`` gives one to change.

    A run with ``rows=False``, or with another ``wanted`` than ``everything``, has arrays of no rows.

    Attributes
    ----------
    scene : Scene
        What was run.
    """

    def __init__(self, scene: Scene, response: _rocking.Response) -> None:
        self.scene = scene
        self._response = response

    @computed_once
    def t(self) -> Array:
        """Times of the rows [s], shape (rows,)."""
        return _fixed(self._response.t())

    @computed_once
    def theta(self) -> Array:
        """Angles of the blocks [rad], clockwise positive, shape (rows, blocks)."""
        return _fixed(self._response.theta())

    @computed_once
    def omega(self) -> Array:
        """Rates of the angles [rad/s], shape (rows, blocks)."""
        return _fixed(self._response.omega())

    @computed_once
    def ground(self) -> Array:
        """Ground acceleration, horizontal and vertical [m/s²], shape (rows, 2)."""
        return _fixed(self._response.ground())

    @computed_once
    def pattern(self) -> npt.NDArray[np.int8]:
        """Signs of the interfaces: 1 where the block above stands on its right corner (``phi`` > 0), -1 on its left, 0 closed; shape (rows, blocks)."""
        return _fixed(self._response.pattern())

    @computed_once
    def slide(self) -> Array | None:
        """Slides at the interfaces [m], shape (rows, blocks); None without friction."""
        return _fixed(self._response.slide())

    @computed_once
    def gap(self) -> Array | None:
        """Gaps of interfaces in flight [m], shape (rows, blocks); None without friction."""
        return _fixed(self._response.gap())

    @computed_once
    def place(self) -> Array | None:
        """Centroids in the frame of the ground [m], shape (rows, blocks, 2); None where nothing slides or flies."""
        state = _fixed(self._response.place_and_velocity())
        return None if state is None else state[:, :, :2]

    @computed_once
    def velocity(self) -> Array | None:
        """Velocities of the centroids in the frame of the ground [m/s], shape (rows, blocks, 2); None where nothing slides or flies."""
        state = _fixed(self._response.place_and_velocity())
        return None if state is None else state[:, :, 2:]

    @computed_once
    def force(self) -> Array | None:
        """Normal force, tangential force [N] and moment [N m] of the contacts, shape (rows, blocks, 3); None where nothing slides or flies."""
        return _fixed(self._response.force())

    @computed_once
    def phi(self) -> Array:
        """Rotations at the interfaces [rad], the angle of the block above minus that of the block below, shape (rows, blocks)."""
        return _fixed(self._response.relative_angles())

    @computed_once
    def top(self) -> Array:
        """Displacement of the middle of the column's top in the frame of the ground [m], to the right and upwards, shape (rows, 2).

        It counts from the upright column, displaced by the slides of the initial state; where ``x`` and ``y`` place the blocks, from the aligned one.
        """
        return _fixed(self._response.top_displacement())

    @property
    def events(self) -> pd.DataFrame:
        """Impacts, openings and other events, a row each: ``t`` [s], ``kind``, ``interface``, patterns and modes, angles [rad], rates [rad/s] before and after,
        impulses [N s, N m s], ``mirrored`` (whether the pattern after is the mirror image of that of ``mode``) and ``energy_lost``, the share of the kinetic
        energy that an impact takes. ``interfaces`` are those that caused the event, ``"1 3"`` for the first and the third, ``interface`` is the lowest.
        ``theta_1``, ``omega_before_1``, ``omega_after_1`` are of the first block, ``normal_impulse_1``, ``tangential_impulse_1``, ``moment_impulse_1`` of the
        first interface.

        Where blocks slid or flew also slides ``slide_1`` [m], centroids ``x_1``, ``y_1`` [m] with their velocities ``vx_before_1``, ``vx_after_1``,
        ``vy_before_1``, ``vy_after_1`` [m/s], and the states of the interfaces, base first: ``(+>,0,f)`` is a first one open on its right corner that
        slides to the right, a second one closed, a third in flight. The book's chapter Results explains what the columns mean.
        """
        return self._events.copy()

    @computed_once
    def _events(self) -> pd.DataFrame:
        columns: dict[str, Any] = {}
        for name, values in self._response.events().items():
            if getattr(values, "ndim", 1) == 2:
                columns.update({f"{name}_{block + 1}": values[:, block] for block in range(values.shape[1])})
            elif name == "interface":
                columns[name] = pd.arrays.IntegerArray(values, values == 0)
            else:
                columns[name] = values if isinstance(values, np.ndarray) else pd.array(values, dtype="string")
        return pd.DataFrame(columns)

    @property
    def summary(self) -> dict[str, Any]:
        """The content of ``summary.json``, made anew each time. Numbers that are not finite, words in the file, are ``inf``, ``-inf`` and ``nan``;
        ``impacts`` is None where only the outcome is asked for."""
        read: dict[str, Any] = _with_numbers(json.loads(self._response.summary()))
        return {**read, "impacts": self._response.impacts}

    @computed_once
    def friction_demand(self) -> Array:
        """Largest ratio of tangential to normal force at each interface, of the whole run, a fall included; infinite where a tangential force acted while the
        contact did not press; NaN without ``forces``; shape (blocks,)."""
        return self._of_each("friction_demand")

    @computed_once
    def impulse_friction_demand(self) -> Array:
        """As :attr:`friction_demand`, of the impulses of impacts; shape (blocks,)."""
        return self._of_each("impulse_friction_demand")

    @computed_once
    def min_normal_force(self) -> Array:
        """Smallest normal force at each interface [N]; NaN without ``forces``; shape (blocks,)."""
        return self._of_each("min_normal_force")

    @computed_once
    def peak_slide(self) -> Array:
        """Largest size of the slide of each interface [m]; without friction that of the start; shape (blocks,)."""
        return self._of_sliding("peak_slide", abs)

    @computed_once
    def residual_slide(self) -> Array:
        """Slide of each interface at the end, that of the start included [m]; without friction that of the start; shape (blocks,)."""
        return self._of_sliding("residual_slide", lambda slide: slide)

    @computed_once
    def way_slid(self) -> Array:
        """Length of the way that each interface has slid, to and fro [m]; zero without friction; shape (blocks,)."""
        return self._of_sliding("way_slid", lambda slide: 0.0)

    def _of_each(self, name: str) -> Array:
        """Numbers of the summary, one for each interface; NaN where they are not recorded."""
        summary = self.summary
        numbers = summary.get(name)
        return _fixed(np.full(len(summary["alpha"]), np.nan) if numbers is None else np.array(numbers, dtype=np.float64))

    def _of_sliding(self, name: str, without_friction: Callable[[float], float]) -> Array:
        """Numbers of the report of slides, one for each interface; without friction those that follow from the slides of the start."""
        summary = self.summary
        report = summary.get("sliding")
        numbers = map(without_friction, summary["column"]["slides"]) if report is None else report[name]
        return _fixed(np.array(list(numbers), dtype=np.float64))

    @computed_once
    def trust(self) -> Trust | None:
        """How far the run is determined; None for a run without companions, see :func:`simulate`."""
        sentence = self._response.trust
        return None if sentence is None else Trust._of(self.summary["trust"], sentence)

    @property
    def status(self) -> str:
        """Why the run ended: ``end-of-time``, ``at-rest``, ``overturned``, ``collapsed``, ``undetermined``; where only the outcome is asked for,
        also ``stands`` and ``falls`` from the time on at which that is certain.
        """
        return self._response.status

    @property
    def outcome(self) -> str:
        """Outcome of the run, as in tables: ``no-uplift``, ``rocks``, ``overturns``, ``slides``, ``collapses``, ``undetermined``.

        That of this run; ``trust`` says whether it is determined.
        """
        return self._response.outcome

    @property
    def overturned(self) -> bool:
        """Whether the column overturned; where only the outcome is asked for, also whether it is certain to."""
        return self._response.overturned

    @property
    def t_final(self) -> float:
        """When the run ended [s]."""
        return self._response.t_final

    @property
    def impacts(self) -> int:
        """Number of impacts.

        Raises
        ------
        ValueError
            Where only the outcome is asked for: such a run ends early.
        """
        count = self._response.impacts
        if count is None:
            raise ValueError("the run has its outcome alone and ends early, so that its impacts are not counted; run it without `wanted`")
        return count

    @property
    def seconds(self) -> float:
        """Duration of the computation [s]."""
        return self._response.seconds

    @computed_once
    def peak_theta(self) -> Array:
        """Largest size of each angle [rad], shape (blocks,); (0,) where only the outcome is asked for."""
        return _fixed(self._response.peak_theta())

    @computed_once
    def peaks(self) -> Array:
        """Largest size of each angle over the slenderness of the stack from its block up, as ``peaks`` of sweeps; infinite where that stack does not stand
        by itself; shape (blocks,); (0,) where only the outcome is asked for.
        """
        return _fixed(self._response.peaks())

    @computed_once
    def alpha(self) -> Array:
        """Slenderness of the stack that begins with each block [rad], initial slides included, below zero where it leans beyond its support; shape (blocks,)."""
        return _fixed(np.array(self.scene._compiled.stacks()["alpha"]))

    @property
    def warnings(self) -> list[str]:
        """What must be known before the run is believed, a sentence each."""
        warnings = self._response.warnings
        if self._response.lead:
            warnings.append(f"the verdict is not determined: {self._response.trust}")
        return warnings

    @property
    def _lead(self) -> str:
        """Words before the outcome of a run whose verdict is not determined."""
        return self._response.lead

    def to_pandas(self) -> pd.DataFrame:
        """The rows as a table with the columns of ``response.csv`` except ``pattern``: ``t``, ``theta_1``, ..., ``omega_1``, ..., ``ground_x``, ``ground_y``.

        Where blocks slide or fly, their places, velocities and forces as well; ``phi_1``, ... [rad] and ``top_x``, ``top_y`` [m] where the scene's
        ``output_columns`` ask for them.
        """
        columns: dict[str, Any] = {"t": self.t}
        for name, values in (("theta", self.theta), ("omega", self.omega), ("slide", self.slide), ("gap", self.gap)):
            if values is not None:
                columns.update({f"{name}_{block + 1}": values[:, block] for block in range(values.shape[1])})
        if self.place is not None and self.velocity is not None and self.force is not None:
            states = np.concatenate([self.place, self.velocity, self.force], axis=2)
            for kind, name in enumerate(("x", "y", "vx", "vy", "normal", "tangential", "moment")):
                columns.update({f"{name}_{block + 1}": states[:, block, kind] for block in range(states.shape[1])})
        columns.update({"ground_x": self.ground[:, 0], "ground_y": self.ground[:, 1]})
        for asked in self._response.output_columns:
            if asked == "relative":
                columns.update({f"phi_{interface + 1}": self.phi[:, interface] for interface in range(self.phi.shape[1])})
            elif asked == "top":
                columns.update({"top_x": self.top[:, 0], "top_y": self.top[:, 1]})
        return pd.DataFrame(columns)

    def to_xarray(self) -> "xarray.Dataset":
        """The rows as a data set over ``t`` and ``block``: what :meth:`to_pandas` has, places and velocities over ``direction`` as well. Needs ``xarray``.

        It has ``phi`` and ``top`` where the scene's ``output_columns`` ask for them.
        """
        import xarray

        names = {"theta": "rad", "omega": "rad/s", "slide": "m", "gap": "m"}
        known = {name: values for name in names if (values := getattr(self, name)) is not None}
        variables: dict[str, Any] = {name: (("t", "block"), values, {"units": names[name]}) for name, values in known.items()}
        ground = {"ground": (("t", "direction"), self.ground, {"units": "m/s²"})}
        if self.place is not None and self.velocity is not None and self.force is not None:
            variables["place"] = (("t", "block", "direction"), self.place, {"units": "m"})
            variables["velocity"] = (("t", "block", "direction"), self.velocity, {"units": "m/s"})
            variables.update({name: (("t", "block"), self.force[:, :, kind], {"units": unit}) for kind, (name, unit) in enumerate(FORCES)})
        asked = self._response.output_columns
        if "relative" in asked:
            variables["phi"] = (("t", "block"), self.phi, {"units": "rad"})
        if "top" in asked:
            ground["top"] = (("t", "direction"), self.top, {"units": "m"})
        coordinates = {"t": self.t, "block": np.arange(1, self.theta.shape[1] + 1), "direction": ["horizontal", "vertical"]}
        return xarray.Dataset({**variables, **ground}, coords=coordinates, attrs={"status": self.status, "t_final": self.t_final})

    def to_json(self) -> str:
        """Summary, rows and events as JSON."""
        table = self.to_pandas()
        rows = {name: table[name].tolist() for name in table.columns}
        return json.dumps({"summary": self.summary, "rows": rows, "events": json.loads(self._response.events_json())})

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes the folder of the run: ``response.csv``, ``events.json`` and ``summary.json``, as ``rocking run`` does.

        ``companions.csv`` as well where companions do not agree to the end. Figures and report of an earlier run in the folder are removed.

        Raises
        ------
        ValueError
            Where only the outcome was asked for.
        FolderError
            For a folder that cannot be written.
        """
        if self._response.impacts is None:
            raise ValueError("the run has its outcome alone; run it without `wanted` to write its folder")
        self._response.write(path_text("folder", folder))

    def report(self, file: str | os.PathLike[str]) -> None:
        """Writes the page of the run: one HTML file with outcome, validity, animation, figures, inputs; ValueError for a run without rows."""
        self._need_rows()
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder)
            page = _rocking.page(folder)
        write_text(path_text("file", file), page)

    def figures(self) -> dict[str, str]:
        """The figures of the page as SVG, by their names: ``time-history``, ``phase-portrait``, ``energy``, ``forces``, ``slides``.

        Raises
        ------
        ValueError
            For a run without rows.
        """
        self._need_rows()
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder)
            return {name: svg for name, _, svg in _rocking.figures(folder)}

    def _need_rows(self) -> None:
        if len(self.t) == 0:
            raise ValueError("the run has no rows; run it with rows=True, without `wanted`, and with output times up to its end")

    def plot(self, axes: Any = None) -> "npt.NDArray[Any]":
        """Draws ground acceleration and angles over time; returns both axes of matplotlib. ValueError for a run without rows."""
        from ._plot import run

        self._need_rows()
        return run(self, axes)

    def _repr_svg_(self) -> str | None:
        return self.figures()["time-history"] if len(self.t) else None

    def _repr_html_(self) -> str:
        shares = ", ".join(f"{peak:.3g}" for peak in self.peaks) if len(self.peaks) else "not asked"
        facts = {
            "outcome": f"{self._lead}{self.outcome} ({self.status} at t = {self.t_final:.4g} s)",
            **({} if self._response.impacts is None else {"impacts": str(self.impacts)}),
            **({} if self._response.trust is None else {"trust": escape(self._response.trust)}),
            "largest |θ|/α, base first": shares,
            "warnings": "<br>".join(escape(warning) for warning in self.warnings) or "none",
        }
        table = "".join(f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{text}</td></tr>" for name, text in facts.items())
        return f"<div>{self._repr_svg_() or ''}<table>{table}</table></div>"

    def __repr__(self) -> str:
        end = f"{self._lead}{self.outcome} ({self.status} at t = {self.t_final:.6g} s)"
        trust = "" if self._response.trust is None else f"; trust: {self._response.trust}"
        impacts = "" if self._response.impacts is None else f", {self.impacts} impact(s)"
        return f"<Run: {end}{impacts}, {len(self.t)} row(s){trust}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Run) and self._response.equals(other._response)

    __hash__ = None  # type: ignore[assignment]

    def __getstate__(self) -> tuple[Scene, bytes]:
        return self.scene, self._response.state()

    def __setstate__(self, state: tuple[Scene, bytes]) -> None:
        self.scene, self._response = state[0], _rocking.Response.from_state(state[1])
