"""Incremental dynamic analysis and fragility."""

from __future__ import annotations

import copy
import json
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _rocking
from ._arguments import flag, number, numbers, optional, path_text, text, whole
from ._errors import StudyError, warn
from ._frame import frame
from ._plan import Plan
from ._record import Array, Record, Records, StudyRecord
from ._run import Run, simulate
from ._scene import RUN, Column, Scene, SceneKeys, dotted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from typing_extensions import Unpack


class Ida(Plan):
    """Records times levels of a measure, before it is run; the run of any index is found without the others.

    Parameters
    ----------
    column : Scene, Column or blocks
        Ground motion and end of a scene are not used: a run lasts as long as its record and ``free_swing`` seconds more.
    records : Records, or iterable of Record
    measure : str
        ``pga``, ``pga_g``, ``pga_uplift``, ``pgv``, ``pgv_uplift``, ``pgd``, ``arias``, ``cav``, ``sa`` or ``sa_g``; upper case will do.
    levels : array, shape (levels,)
        In the unit of the measure, above zero.
    free_swing : float
        [s], 10 unless given.
    sa_period, sa_damping : float
        Period [s] and damping ratio of ``sa`` and ``sa_g``; the ratio is 0.05 unless given.
    trust : bool
        Whether each run is followed by its companions, which say whether its verdict is determined or likely (column ``trust``); the default. They take 7 to 30
        times as long as the runs, up to 73 times.
    **arguments
        As of :class:`Scene`.

    Raises
    ------
    StudyError
        For a study without records or levels, a measure that does not exist, or a record that cannot be scaled to a level.
    SceneError
        For a scene that is refused.
    """

    def __init__(
        self,
        column: "Scene | Column | Iterable[Mapping[str, Any]]",
        records: "Records | Iterable[Record | StudyRecord]",
        measure: str,
        levels: npt.ArrayLike,
        *,
        free_swing: float | None = None,
        sa_period: float | None = None,
        sa_damping: float | None = None,
        trust: bool = True,
        **arguments: "Unpack[SceneKeys]",
    ) -> None:
        for name in ("horizontal", "vertical", "t_end", "t_eval", "output_dt"):
            if arguments.get(name) is not None:
                raise TypeError(f"a study has no argument `{name}`: its records shake the column, and free_swing ends its runs")
        if any(key == "solver.t_end" and value is not None for key, value in dotted(arguments)):
            raise TypeError("a study has no key `solver.t_end`: free_swing ends its runs")
        scene = column if isinstance(column, Scene) else Scene(column, **arguments)
        if scene is column and arguments:
            scene = scene.replace(**arguments)
        found = records if isinstance(records, Records) else Records(records)
        if isinstance(levels, Mapping):
            raise TypeError("levels are a dictionary; give a list or an array, such as numpy.linspace(0.1, 1.0, 10)")
        sizes = numbers("levels", levels).ravel().tolist()
        times = (optional("free_swing", free_swing), optional("sa_period", sa_period), optional("sa_damping", sa_damping))
        self._source: tuple[Any, ...] = (scene, found, text("measure", measure), sizes, *times, flag("trust", trust))
        self._become()
        warn(self.warnings)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> "Ida":
        """Reads a study file of ``rocking ida``, and runs nothing. Its ``[fragility]`` is that of the study that :meth:`run` returns.

        Raises
        ------
        SceneError
            For a study that is refused, with file, line, key and remedy; :class:`MissingFileError` where the file is not there.
        """
        path = os.path.abspath(path_text("file", file))
        made = cls.__new__(cls)
        # A process that runs a part reads scene and records again, and may have another folder.
        made._source = (path, _rocking.scene_text(path), None)
        made._become()
        made._source = (*made._source[:2], made.scene.toml)
        warn(made.warnings)
        return made

    def _become(self) -> None:
        if self._is_of_file():
            path, text, base = self._source
            self._ida = _rocking.Ida.from_toml(text, path)
            scene = _rocking.from_toml(text)["scene"]
            is_table = isinstance(scene, Mapping)
            self._scene = Scene.from_dict(scene, file=path) if is_table else Scene.load(os.path.join(os.path.dirname(path), scene))
            if base is not None and self._scene.toml != base:
                raise StudyError(f"{self._scene.file} is another scene than when {path} was read; read the study again")
            self._records = Records(map(StudyRecord._of, self._ida.records))
        else:
            self._scene, self._records, measure, levels, free_swing, sa_period, sa_damping, trust = self._source
            natives = [record._native() for record in self._records]
            self._ida = _rocking.Ida(self._scene._compiled, natives, measure, levels, free_swing, sa_period, sa_damping, trust)

    def _is_of_file(self) -> bool:
        return isinstance(self._source[0], str)

    @property
    def scene(self) -> Scene:
        """The base scene."""
        return self._scene

    @property
    def records(self) -> Records:
        """The records."""
        return self._records

    @property
    def measure(self) -> str:
        """Heading of the measure in the table."""
        return self._ida.measure

    @property
    def warnings(self) -> list[str]:
        """Warnings about the scene and the records, a sentence each, each once; the first ones are also a ``UserWarning`` when the analysis is made."""
        return self._ida.warnings

    @property
    def levels(self) -> Array:
        """Levels, in the unit of the measure, shape (levels,)."""
        return np.array(self._ida.levels)

    def __len__(self) -> int:
        return len(self._ida)

    def _columns(self, start: int, stop: int, threads: int) -> list[tuple[Any, ...]]:
        return self._ida.table(start, stop, threads)

    def run(self, *, threads: int = 0) -> "Study":
        """All runs."""
        study = Study(self.table(threads=threads), self.measure)
        if self._is_of_file():
            study.states, study._options = self._ida.states, self._ida.options
        return study

    def scene_of(self, index: int) -> Scene:
        """The scene of a run, without forces, with the rows that the base scene asks for, else with the samples of the record among them.

        It is run as it is: it has no keys, and nothing in it can be replaced.
        """
        asked = self.scene._keys.get("output") or {}
        times = asked.get("times")
        times = None if times is None else np.asarray(times, dtype=np.float64).tolist()
        return Scene._of({}, RUN, self._ida.scene(whole("index", index), asked.get("dt"), times))

    def simulate(self, index: int) -> Run:
        """A run alone, with rows and without forces."""
        return simulate(self.scene_of(index))

    def __repr__(self) -> str:
        return f"<Ida of {len(self.records)} record(s) at {len(self.levels)} level(s) of {self.measure}>"

    def __getstate__(self) -> tuple[Any, ...]:
        return self._source

    def __setstate__(self, source: tuple[Any, ...]) -> None:
        self._source = source
        self._become()


def ida(
    column: "Scene | Column | Iterable[Mapping[str, Any]]",
    records: "Records | Iterable[Record | StudyRecord]",
    measure: str,
    levels: npt.ArrayLike,
    *,
    free_swing: float | None = None,
    sa_period: float | None = None,
    sa_damping: float | None = None,
    trust: bool = True,
    threads: int = 0,
    **arguments: "Unpack[SceneKeys]",
) -> "Study":
    """Runs each record at each level; arguments as of :class:`Ida`, and the number of threads (0: as many as the machine has).

    >>> from rocking import Column, synthetic
    >>> study = ida(Column.prisms(1, half_width=0.3, half_height=1.2), synthetic(range(3)), "PGV", [0.05, 0.5, 3.0], eta=0.9)
    >>> len(study.table), study.stripes.runs.tolist()
    (9, [3, 3, 3])
    """
    periods = {"free_swing": free_swing, "sa_period": sa_period, "sa_damping": sa_damping}
    return Ida(column, records, measure, levels, **periods, trust=trust, **arguments).run(threads=threads)


@dataclass(frozen=True)
class Runs:
    """Columns of a table of runs. `trust` and `uplift` are none where the table has no such column; blanks of `peaks` and `slides` are NaN."""

    records: list[str]
    levels: list[float]
    outcomes: list[str | None]
    trust: list[str | None] | None
    uplift: list[bool] | None
    peaks: "Array"
    slides: "Array"
    #: Whether runs of one record differ in something beside their level, as those of several columns do.
    differ_beside_level: bool


#: Largest number of values of an axis whose rows may have been pooled by mistake: a column with more of them is none.
MOST_VALUES = 1000


def _floats(table: pd.DataFrame, name: str) -> Array:
    """A column of numbers; blanks are NaN."""
    cells = table[name]
    is_truth = pd.api.types.is_bool_dtype(cells)
    is_number = pd.api.types.is_numeric_dtype(cells) and not pd.api.types.is_complex_dtype(cells) and not is_truth
    if is_truth or not is_number and not pd.api.types.is_object_dtype(cells) and not pd.api.types.is_string_dtype(cells):
        raise StudyError(f"column `{name}` has values of {cells.dtype}; give numbers")
    if is_number:
        return np.ascontiguousarray(cells.to_numpy(dtype=np.float64, na_value=np.nan))
    made = np.empty(len(cells))
    for place, cell in enumerate(cells):
        try:
            made[place] = np.nan if cell is None or cell is pd.NA or cell == "" else float(cell)
        except (TypeError, ValueError, OverflowError):
            raise StudyError(f"table.iloc[{place}], column `{name}`: {cell!r} is no number; give numbers") from None
    return made


def _tidied(table: pd.DataFrame) -> pd.DataFrame:
    """A table with named levels of its index as columns, texts for headings, those that are read without capitals, and the byte order of the machine."""
    if not isinstance(table, pd.DataFrame):
        lazy = "the DataFrame that its method compute() returns"
        remedy = lazy if hasattr(table, "compute") else "a DataFrame of runs"
        raise TypeError(f"table is of {type(table).__name__}; give {remedy}")
    # Levels of an index that have names are columns, as in tables of files.
    if any(name is not None and name not in table.columns for name in table.index.names):
        table = table.reset_index(level=[name for name in table.index.names if name is not None and name not in table.columns])
    headings = {name: _heading(name) for name in table.columns}
    # A column of the user's, `Block` beside `block`, keeps its capitals.
    changed = {name: heading for name, heading in headings.items() if heading != name and heading not in table.columns}
    table = table.rename(columns=changed) if changed else table
    table = table if all(isinstance(name, str) for name in table.columns) else table.rename(columns=str)
    swapped = {name: kind.newbyteorder("=") for name, kind in table.dtypes.items() if isinstance(kind, np.dtype) and not kind.isnative}
    return table.astype(swapped) if swapped else table


def _heading(name: Any) -> str:
    """A heading; one that is read has neither capitals nor blanks beside it."""
    lower = str(name).strip().lower()
    return lower if _rocking.is_result(lower) or lower in ("index", "record", "scale") else str(name)


def _settings(table: pd.DataFrame) -> list[str]:
    """Columns that say what was run, wherever they stand: all but those of results, and the numbers of rows that pandas has written without a name."""
    named = [name for name in table.columns if not _rocking.is_result(name) and not name.startswith("Unnamed: ")]
    # Lists and arrays, such as a spectrum of each record, are none.
    is_plain = {name: table[name].dtype != object or table[name].map(pd.api.types.is_hashable).all() for name in named}
    return [name for name in named if is_plain[name]]


def _name(cell: Any) -> str:
    """The name of a record: a seed is a whole number, whichever column it has been joined into."""
    return str(int(cell)) if isinstance(cell, (float, np.floating)) and float(cell).is_integer() else str(cell)


class Study:
    """The runs of a study, and what follows from them.

    Parameters
    ----------
    table : DataFrame
        A row per run, with the columns of ``rocking ida``, or of ``rocking sweep`` over records and a measure.
    measure : str
        Column of the levels; the one that has the name of a measure unless given.

    Attributes
    ----------
    measure : str
        As given. What follows from the table is computed when it is asked for.
    states : list of str
        Limit states of the study's file; none for a study that was not loaded from a file.

    Raises
    ------
    StudyError
        For a table that is not one of runs: it lacks a column, has one twice, or a run twice.
    """

    def __init__(self, table: pd.DataFrame, measure: str | None = None) -> None:
        table = _tidied(table)
        if measure is None:
            known = [name for name in map(str, table.columns) if _rocking.measure_label(_last(name)) is not None]
            # A study has its measure beside the scale of the record; others may be properties of the records.
            of_study = [name for scale, name in zip(table.columns, table.columns[1:]) if scale == "scale" and name in known]
            known = of_study or known
            if len(known) != 1:
                problem = f"several columns are measures: {', '.join(known)}" if known else "no column has the name of a measure"
                raise StudyError(f"{problem}; name the column with `measure`")
            measure = known[0]
        self.measure = measure
        self.table = table
        self.states: list[str] = []
        self._options: dict[str, Any] = {}

    @property
    def table(self) -> pd.DataFrame:
        """The table as given, named levels of its index as columns. Another one may be set; it is checked as the first was."""
        return self._table

    @table.setter
    def table(self, table: pd.DataFrame) -> None:
        self._table = self._checked(_tidied(table))

    def _checked(self, table: pd.DataFrame) -> pd.DataFrame:
        """The table, if it is one of runs."""
        twice = table.columns[table.columns.duplicated()]
        if len(twice):
            raise StudyError(f"the table has several columns `{twice[0]}`; give each once")
        for name in (self.measure, "outcome"):
            if name not in table.columns:
                raise StudyError(f"the table has no column `{name}`; it has {', '.join(map(str, table.columns))}")
        if "index" in table.columns:
            # Studies with other records may be pooled: their runs have the same numbers.
            again = table["index"][table["index"].notna() & table.duplicated(_settings(table))]
            if len(again):
                raise StudyError(f"run {again.iloc[0]} stands in the table twice; give each run once")
        blank = np.flatnonzero(table["outcome"].isna())
        if len(blank):
            raise StudyError(f"table.iloc[{blank[0]}] has no outcome; give the table as it was made, in which a run that failed has the outcome `error`")
        return table

    @classmethod
    def load(cls, file: str | os.PathLike[str], *, threads: int = 0) -> "Study":
        """Runs a study file of ``rocking ida``, as :meth:`Ida.run` of :meth:`Ida.load`. Its ``[fragility]`` gives ``states`` and what :meth:`fragility` takes
        unless given.

        Raises
        ------
        SceneError
            For a study that is refused, with file, line, key and remedy; :class:`MissingFileError` where the file is not there.
        """
        return Ida.load(file).run(threads=threads)

    @property
    def label(self) -> str:
        """Label of an axis of the measure: quantity and unit."""
        return _rocking.measure_label(_last(self.measure)) or self.measure

    def _warn_of_shared_names(self, table: pd.DataFrame, of_records: list[str], keys: list[str]) -> None:
        """Warns of records of one name whose scales differ at a level of a measure that does not depend on the column: they are different records."""
        rounding = _rocking.equal_scales(self.measure)
        if rounding is None:
            return
        # A column of this name may be another one.
        sizes = np.abs(pd.to_numeric(table["scale"].astype(object), errors="coerce"))
        scales = table.assign(scale=sizes).groupby([*of_records, self.measure, *keys], dropna=False, sort=False, observed=True)["scale"]
        differ = scales.max() > scales.min() * (1.0 + rounding)
        shared = list(dict.fromkeys(row[: len(of_records)] for row in differ[differ].index))
        if shared:
            first = ", ".join(map(_name, shared[0]))
            share = f"the name {first!r}" if len(shared) == 1 else f"{len(shared)} names, such as {first!r}"
            told = f"different records share {share}: their scales differ at one level, and they count as one"
            warn([f"{told}; give each record a name of its own, as with Record.named"])

    def _runs(self) -> "Runs":
        """Columns as the library reads them, with warnings about rows that make one curve and runs that are cut."""
        # It may have been changed in place.
        self.table = self._table
        table = self._table
        names = [str(name) for name in table.columns]
        of_records = [table.columns[place] for place in _rocking.record_columns(names)]
        if of_records:
            blank = np.flatnonzero((table[of_records].isna() | (table[of_records] == "")).any(axis=1))
            if len(blank):
                raise StudyError(f"table.iloc[{blank[0]}] has no `{of_records[0]}`; give each run the name of its record")
            records = [", ".join(map(_name, row)) for row in table[of_records].itertuples(index=False)]
        elif _rocking.is_of_one_record(names, names.index(self.measure)):
            records = ["the record of the scene"] * len(table)
        else:
            records = [f"run {number}" for number in range(1, len(table) + 1)]

        settings = [name for name in _settings(table) if name != "index"]
        # Beside the scale of the record other measures are properties of the scaled record.
        measures = [name for name in names if "scale" in names and _rocking.measure_label(name) is not None]
        others = [name for name in settings if name not in ("scale", self.measure, *measures, *of_records)]
        for name in others:
            count = table[name].nunique(dropna=False)
            # A value of its own for each record is a property of the record, such as its PGA; nor has an axis nearly as many values as there are runs.
            own = table[[*of_records, name]].drop_duplicates() if of_records else ()
            is_of_record = len(own) == count == len(set(records))
            if 1 < count <= min(MOST_VALUES, len(table) // 2) and not is_of_record:
                warn([f"the rows of all {count} values of `{name}` make one curve; filter the table for those of one"])
        # A column that is no key of a scene may be a result.
        keys = [name for name in others if "." in name and _rocking.measure_label(name) is None]
        differ = bool((table[keys].groupby(np.array(records)).nunique(dropna=False) > 1).any(axis=None)) if keys else False
        if of_records and "scale" in names:
            self._warn_of_shared_names(table, of_records, [name for name in others if name in keys or name == "gravity"])
        again = int(table.duplicated(settings).sum()) if of_records else 0
        if again:
            warn([f"{again} run(s) have all settings of a run above; if they are the same runs, give each once"])
        if "truncated" in names:
            cut = int(table["truncated"].astype("string").str.lower().isin(["true", "1", "1.0"]).sum())
            if cut:
                told = f"{cut} run(s) end before their ground motion, while the column may be falling, or sliding (`truncated`), and count as standing; a later t_end settles them"
                warn([told])

        def texts(name: str) -> list[str | None]:
            return [None if pd.isna(cell) else str(cell) for cell in table[name]]

        def grid(prefix: str) -> Array:
            numbers = sorted(int(name[len(prefix) :]) for name in names if re.fullmatch(prefix + "[1-9][0-9]*", name))
            if numbers != list(range(1, len(numbers) + 1)):
                raise StudyError(f"the columns {prefix}... have the numbers {numbers}; give all of them, from 1")
            own = [_floats(table, f"{prefix}{number}") for number in numbers]
            return np.stack(own, axis=1) if own else np.empty((len(table), 0))

        uplift = None
        if "first_uplift" in names:
            first = _floats(table, "first_uplift")
            before = np.flatnonzero(first < 0.0)
            if len(before):
                raise StudyError(f"table.iloc[{before[0]}], column `first_uplift`: {first[before[0]]:g} is no time; leave it blank where nothing opens")
            uplift = (~np.isnan(first)).tolist()
        peaks, outcomes = grid("peak_"), texts("outcome")
        slides, blocks = grid("residual_slide_"), peaks.shape[1]
        if blocks and slides.shape[1] not in (0, blocks):
            raise StudyError(f"the table has {blocks} column(s) peak_... and {slides.shape[1]} residual_slide_...; give all of them")
        if blocks:
            # The block with which a column was lost is one of it.
            block = pd.to_numeric(table["block"].astype(object), errors="coerce") if "block" in names else pd.Series(dtype=float)
            lost = np.flatnonzero(block > blocks)
            if len(lost):
                raise StudyError(f"table.iloc[{lost[0]}]: block {block.iloc[lost[0]]:.0f} was lost, and the table has {blocks} column(s) peak_...; give all of them")
            standing = np.isin(np.array(outcomes, dtype=object), ["no-uplift", "rocks", "slides"])
            short = int((standing & np.isnan(peaks[:, -1])).sum())
            if short and not any(_last(name) == "blocks" for name in names):
                warn([f"{short} run(s) that stand have no `peak_{blocks}`: limit states do not see this block there"])
        return Runs(
            records=records,
            levels=_floats(table, self.measure).tolist(),
            outcomes=outcomes,
            trust=texts("trust") if "trust" in names else None,
            uplift=uplift,
            peaks=peaks,
            slides=slides,
            differ_beside_level=differ,
        )

    @property
    def stripes(self) -> pd.DataFrame:
        """A row per level: counts of outcomes, and the 16, 50 and 84 % fractiles of the largest |θ|/α.

        Fractiles are infinite where the column is lost, and NaN where peaks are unknown. StudyError for a table whose columns cannot be read.
        """
        return self._stripes(self._runs())

    def _stripes(self, runs: "Runs") -> pd.DataFrame:
        return pd.DataFrame(_rocking.stripes(runs)).rename(columns={"level": self.measure})

    def fragility(
        self,
        state: str = "overturned",
        *,
        replicates: int | None = None,
        confidence: float | None = None,
        seed: int | None = None,
        layout: str | None = None,
        threads: int = 0,
    ) -> "Fragility":
        """The probability of a limit state given the level.

        Parameters
        ----------
        state : str
            ``uplift``, ``overturned``, ``peak > 0.35`` (|θ|/α), ``peak_2 > 0.35`` of the second block, or ``slide > 0.05`` [m].
        replicates, confidence, seed
            Resampled sets of records for the bands, their share within the bands, and the seed of the resampling; 1000, 0.9 and 0 unless given here or
            in the study's file.
        layout : str
            ``stripes``, where many records have each level, or ``cloud``, where each run has a level of its own; found from the number of runs per level
            unless given.
        threads : int
            Threads of the resampling, 0 for as many as the machine has; bands do not depend on it.

        Raises
        ------
        StudyError
            For a state that does not exist, or that needs columns which the table lacks.
        ValueError
            For another layout, or a number out of range.
        """
        if not isinstance(state, str):
            raise TypeError(f"state is of {type(state).__name__}; give the text of one limit state, such as \"overturned\"")
        runs = self._runs()
        kind = re.split(r"[_\s]", state.strip())[0]
        if kind.startswith("peak") and runs.peaks.shape[1] == 0:
            raise StudyError(f"the state `{state}` needs the columns peak_1, ...: run the sweep with ask = \"peaks\"")
        blocks, named = runs.peaks.shape[1], re.match(r"\s*peak_(\d+)", state)
        if named is not None and int(named[1]) > blocks:
            raise StudyError(f"the state `{state}` needs the column peak_{named[1]}, and the columns of the table have {blocks} block(s)")
        if kind.startswith("slide") and runs.slides.shape[1] == 0:
            raise StudyError(f"the state `{state}` needs the columns residual_slide_1, ...: run the sweep of a scene with friction with ask = \"slides\"")
        given = {"replicates": replicates, "confidence": confidence, "seed": seed, "layout": layout}
        options = {**self._options, **{name: value for name, value in given.items() if value is not None}}
        options.update({name: whole(name, options[name]) for name in ("replicates", "seed") if name in options})
        if "confidence" in options:
            options["confidence"] = number("confidence", options["confidence"])
        if options.get("layout") is not None:
            text("layout", options["layout"])
        found, statements = _rocking.fragility(runs, state, threads=whole("threads", threads), **options)
        return Fragility(json.loads(found), statements, self.measure, self.label)

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draws the curves of the records and the fractiles."""
        from ._plot import study

        return study(self, ax)

    def __repr__(self) -> str:
        counts = self.table["outcome"].value_counts()
        told = ", ".join(f"{name} {counts[name]}" for name in counts.index if counts[name])
        return f"<Study of {len(self.table)} runs over {self.measure}: {told}>"


def _last(key: str) -> str:
    """The last part of a dotted key; a measure such as ``sa(0.5)`` has a point of its own."""
    return key if _rocking.measure_label(key) is not None else key.rsplit(".", 1)[-1]


class Fragility:
    """The probability of a limit state given the level: a lognormal curve, or why there is none.

    Attributes
    ----------
    state : str
        The limit state.
    measure, label : str
        Column of the levels, and the label of its axis: quantity and unit.
    layout : str
        ``stripes`` or ``cloud``, see :meth:`Study.fragility`.
    records : int
        Number of records with a run of which it is known whether it reached the state.
    fit : str
        ``lognormal``, or why there is no curve: ``no-runs``, ``one-record``, ``never``, ``always``, ``step``, ``falling`` (the share of runs
        falls, stays, or rises too little for a median).
    median, dispersion : float or None
        Of the curve, by maximum likelihood (Baker 2015); the median in the unit of the measure.
    log_likelihood : float or None
        Logarithm of the likelihood of the runs by that curve.
    bands : dict or None
        Bands of the bootstrap: lower and upper ends of ``median`` and ``dispersion``, and of ``probability`` at the ``levels``. None where too few resampled
        sets have a curve.
    bounds : list of dict or None
        The curves if none, and if all, of the undecided runs reached the state: ``kind``, and of a curve ``median`` and ``dispersion``. None where no run, or
        every run, is undecided.
    goodness : dict or None
        Pearson's chi-squared, its p-value, McFadden's R².
    falls, resurrections : list
        Where the state is not monotonic in the level: pairs of levels between which the share of runs falls, and records that reach the state and do not at
        a higher level. No record is named where runs of a record differ in something beside their level; ``statements`` say so.
    by_loss : int
        Number of runs that have reached the state because the column was lost, without a peak or slide above the limit up to then: mostly another block fell.
    statements : list of str
        Results and warnings, a sentence each.
    """

    def __init__(self, found: dict[str, Any], statements: list[str], measure: str, label: str) -> None:
        self._found = found
        self.measure = measure
        self.label = label
        self.statements = statements
        self.state: str = found["state"]
        self.layout: str = found["layout"]
        self.records: int = found["records"]
        self.fit: str = found["fit"]["kind"]
        self.median: float | None = found["fit"].get("median")
        self.dispersion: float | None = found["fit"].get("dispersion")
        self.log_likelihood: float | None = found["fit"].get("log_likelihood")
        bands = found["bands"]
        self.bands: dict[str, Any] | None = None if bands is None or bands["median"] is None else bands
        self.bounds: list[dict[str, Any]] | None = found["bounds"]
        self.goodness: dict[str, Any] | None = found["goodness"]
        self.falls: list[list[float]] = found["falls"]
        self.resurrections: list[str] = found["resurrections"]
        self.by_loss: int = found["by_loss"]

    @property
    def counts(self) -> pd.DataFrame:
        """A row per level: ``level``, ``runs``, ``reached``, ``undecided`` and the raw ``share``."""
        table = pd.DataFrame(self._found["counts"], columns=["level", "runs", "reached", "undecided"])
        return table.assign(share=table.reached / table.runs.where(table.runs > 0))

    def probability(self, levels: npt.ArrayLike) -> Array:
        """Probability of the state by the curve, of the shape of the levels.

        Raises
        ------
        StudyError
            Where there is no curve.
        """
        if self.median is None or self.dispersion is None:
            raise StudyError(self.statements[0])
        sizes = numbers("levels", levels)
        values = _rocking.probability(self.median, self.dispersion, sizes.ravel().tolist())
        return np.array(values).reshape(sizes.shape)

    def plot(self, ax: "Axes | None" = None, **style: Any) -> "Axes":
        """Draws the curve with its bands and the raw shares."""
        from ._plot import fragility

        return fragility(self, ax, **style)

    def to_dict(self) -> dict[str, Any]:
        """All of it, as JSON has it."""
        return copy.deepcopy(self._found)

    def __repr__(self) -> str:
        return f"<Fragility of {self.state} over {self.measure}: {self.statements[0]}>"
