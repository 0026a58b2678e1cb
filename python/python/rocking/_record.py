"""Records of ground motion, alone and in sets."""

from __future__ import annotations

import os
import stat
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np
import numpy.typing as npt

from . import _rocking
from ._arguments import flag, number, numbers, optional, path_text, text, whole
from ._errors import MissingFileError, SceneError
from ._files import write_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._motion import Motion, MotionLike
    from ._scene import Column

Array = npt.NDArray[np.float64]

#: Size of one g [m/s²] where no scene says.
GRAVITY = 9.81

Fixed = TypeVar("Fixed", bound="npt.NDArray[Any] | None")


def _fixed(values: Fixed) -> Fixed:
    """An array that cannot be written to: it is a copy, and who changes it would change nothing else."""
    if values is not None:
        values.flags.writeable = False
    return values


class Record:
    """Ground acceleration at equal intervals, linear between the samples and zero outside; not changed after it was made.

    Parameters
    ----------
    accel : array, shape (samples,)
        Accelerations.
    dt : float
        Sampling interval [s].
    start : float
        Time of the first sample [s].
    name : str
        As in tables and reports.
    units : str
        Unit of ``accel``: ``m/s2``, ``cm/s2``, ``mm/s2``, ``gal``, ``g``, ``mg``, ``in/s2``, ``ft/s2``.
    gravity : float
        One g of the samples [m/s²].

    Raises
    ------
    RecordError
        For fewer than two samples, a sample that is not finite, or an interval out of range.
    ValueError
        For an array of another shape, masked samples, or a unit that does not exist.
    TypeError
        For what are no real numbers.

    >>> Record([0.0, 1.0, -1.0, 0.0], dt=0.01).duration
    0.03
    """

    def __init__(
        self,
        accel: npt.ArrayLike,
        dt: float,
        *,
        start: float = 0.0,
        name: str = "",
        units: str = "m/s2",
        gravity: float = GRAVITY,
    ) -> None:
        if accel is None or isinstance(accel, (str, os.PathLike)):
            raise TypeError(f"accel is of {type(accel).__name__}; give accelerations [m/s²], or read a file with Record.read")
        if np.ma.is_masked(accel):
            raise ValueError("accel has masked samples; fill them, or cut the record there")
        if isinstance(accel, (bytes, bytearray, memoryview)):
            raise TypeError(f"accel is of {type(accel).__name__}; give accelerations [m/s²], as numpy.frombuffer reads them")
        try:
            given = np.asarray(accel)
        except ValueError as error:
            raise ValueError(f"accel is no array of accelerations ({error}); give one acceleration [m/s²] per sample") from None
        if np.iscomplexobj(given):
            raise ValueError("accel is complex; give real accelerations [m/s²]")
        if given.dtype.kind in "mMSU":
            raise TypeError(f"accel has {'times' if given.dtype.kind in 'mM' else 'texts'}; give accelerations [m/s²]")
        if given.ndim == 0 and given.dtype.kind == "O":
            raise TypeError(f"accel is of {type(accel).__name__}; give a list or an array of accelerations [m/s²]")
        samples = np.ascontiguousarray(numbers("accel", given))
        if samples.ndim != 1:
            raise ValueError(f"accel has the shape {samples.shape}; give one acceleration per sample")
        start, units, gravity = number("start", start), text("units", units), number("gravity", gravity)
        self._record = _rocking.Record(samples, number("dt", dt), start, text("name", name), units, gravity)

    @classmethod
    def _of(cls, record: _rocking.Record) -> "Record":
        made = cls.__new__(cls)
        made._record = record
        return made

    @classmethod
    def read(
        cls,
        file: str | os.PathLike[str],
        *,
        units: str | None = None,
        dt: float | None = None,
        lenient: bool = False,
        channel: int | None = None,
        column: str | int | None = None,
        skip_rows: int = 0,
        gravity: float = GRAVITY,
    ) -> "Record":
        """Reads a file of PEER, ESM, ITACA, K-NET, KiK-net, CSMIP, COSMOS, or a table; what the file does not say is given as for records of scene files.

        Parameters
        ----------
        units : str
            Unit of the samples where the file states none: ``g``, ``mg``, ``m/s2``, ``cm/s2``, ``mm/s2``, ``gal``, ``in/s2``, ``ft/s2``.
        dt : float
            Sampling interval [s] of a table without times.
        lenient : bool
            Whether a file with fewer samples than it declares, another peak than it states, two units or intervals, or times
            with too few digits for ``dt`` is accepted, with a warning.
        channel : int
            Number of the channel, from 1, of a file that has several; the first one, with a warning, unless given.
        column : str or int
            Column of a table with the accelerations: its name, its number from 1, or ``all`` where samples fill row after row; found by itself
            unless given.
        skip_rows : int
            Lines at the head of a table that are not read.
        gravity : float
            One g of the samples [m/s²].

        Raises
        ------
        RecordError
            For a file that is no record, with the place in the file and the remedy.
        OSError
            For a file that cannot be opened; ``FileNotFoundError`` where there is none.
        ValueError
            For a unit that does not exist, or an option out of range.
        """
        name = None if column is None else str(column)
        channel, skip_rows = None if channel is None else whole("channel", channel), whole("skip_rows", skip_rows)
        units, dt, gravity = None if units is None else text("units", units), optional("dt", dt), number("gravity", gravity)
        return cls._of(_rocking.Record.read(os.fsdecode(file), gravity, dt, units, flag("lenient", lenient), channel, skip_rows, name))

    @classmethod
    def synthetic(
        cls,
        seed: int,
        *,
        duration: float = 20.0,
        dt: float = 0.01,
        frequency: float = 2.5,
        damping: float = 0.6,
        pga: float = 3.0,
    ) -> "Record":
        """White noise under an envelope (Jennings, Housner & Tsai 1968) through the filters of Kanai (1957), Tajimi (1960) and Clough & Penzien (1975).

        The same seed gives the same record on every machine.

        Parameters
        ----------
        seed : int
            From 0.
        duration, dt : float
            Duration and sampling interval [s].
        frequency : float
            Frequency of the ground [Hz]: about 1 for soft soil, 2.5 for firm ground, 4 for rock.
        damping : float
            Damping ratio of the ground.
        pga : float
            Peak acceleration [m/s²].

        Raises
        ------
        RecordError
            For a size out of range.
        """
        sizes = {"duration": duration, "dt": dt, "frequency": frequency, "damping": damping, "pga": pga}
        return cls._of(_rocking.Record.synthetic(whole("seed", seed), *(number(name, size) for name, size in sizes.items())))

    def scaled(
        self,
        scale: float | None = None,
        *,
        gravity: float = GRAVITY,
        column: "Column | None" = None,
        sa_period: float | None = None,
        sa_damping: float | None = None,
        **size: float,
    ) -> "Record":
        """The record times a factor, or scaled to one measure by its name in a scene file.

        Measures are ``pga`` [m/s²], ``pga_g`` [g], ``pga_uplift`` [g tan α], ``pgv`` [m/s], ``pgv_uplift`` [g tan α / p], ``pgd`` [m], ``arias`` [m/s],
        ``cav`` [m/s], and ``sa`` [m/s²] or ``sa_g`` [g] at ``sa_period`` [s] with the damping ratio ``sa_damping``, 0.05 unless given. Those of ``uplift``
        need the ``column``. One g is that of the column, where it is given, else ``gravity`` [m/s²].

        Raises
        ------
        TypeError
            Unless exactly one size is given.
        ValueError
            For a measure that does not exist, or a size out of range.
        RecordError
            For a record whose measure is zero, or that would be out of range.

        >>> float(Record([0.0, 1.0, -2.0], dt=0.01).scaled(pga=0.5).accel.min())
        -0.5
        """
        if len(size) + (scale is not None) != 1:
            known = ", ".join(["scale", *_rocking.MEASURES])
            raise TypeError(f"give one size, of {known}; {len(size) + (scale is not None)} are given")
        if scale is not None:
            if sa_period is not None or sa_damping is not None:
                raise TypeError("a factor has no sa_period and no sa_damping; leave them out, or give sa or sa_g")
            return Record._of(self._record.scaled(number("scale", scale)))
        ((measure, value),) = size.items()
        if column is not None and not hasattr(column, "_native"):
            raise TypeError(f"column is of {type(column).__name__}; give a Column")
        period, damping = optional("sa_period", sa_period), optional("sa_damping", sa_damping)
        unit, own = None, number("gravity", gravity)
        if column is not None:
            unit, own = column._native().unit_of(measure, period, damping)
        return Record._of(self._record.scaled_to(measure, number(measure, value), own, unit, period, damping))

    def __add__(self, other: "MotionLike") -> "Motion":
        from ._motion import total

        return total(self, other)

    def trimmed(self, start: float, stop: float) -> "Record":
        """The samples from ``start`` to ``stop``, both included, counted from the first sample [s].

        The first sample that stays is at the time :attr:`start`, as the first one was: what was cut away before it moves the record in time.

        Raises
        ------
        RecordError
            Where fewer than two samples are left.
        """
        return Record._of(self._record.trimmed(number("start", start), number("stop", stop)))

    def starting_at(self, start: float) -> "Record":
        """The record with its first sample at a time [s]; ValueError for a time that is not finite."""
        return Record._of(self._record.starting_at(number("start", start)))

    def named(self, name: str) -> "Record":
        """The record under another name."""
        return Record._of(self._record.named(text("name", name)))

    @property
    def name(self) -> str:
        """Name of the record: that of :meth:`named`, or the path of its file."""
        return self._record.source[0]

    @property
    def t(self) -> Array:
        """Times of the samples [s], shape (samples,)."""
        times: Array = self.start + self.dt * np.arange(len(self), dtype=np.float64)
        return times

    @property
    def accel(self) -> Array:
        """Accelerations [m/s²], shape (samples,); read-only, ``copy()`` gives an array to change."""
        return _fixed(self._record.accel)

    @property
    def velocity(self) -> Array:
        """Ground velocity [m/s], from rest at the first sample, shape (samples,); read-only."""
        return _fixed(self._record.velocity)

    @property
    def displacement(self) -> Array:
        """Ground displacement [m], from rest at the first sample, shape (samples,); read-only."""
        return _fixed(self._record.displacement)

    @property
    def dt(self) -> float:
        """Sampling interval [s]."""
        return self._record.dt

    @property
    def start(self) -> float:
        """Time of the first sample [s]."""
        return self._record.start

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return self._record.duration

    @property
    def scale(self) -> float:
        """Factor by which :meth:`scaled` changed the samples, in all; 1 for a record as it was read or made."""
        return self._record.scale

    @property
    def warnings(self) -> list[str]:
        """Warnings about the file or the samples, a sentence each."""
        return self._record.warnings

    def measures(self, gravity: float = GRAVITY) -> dict[str, float]:
        """Intensity measures by name, in SI; ``gravity`` [m/s²] enters the Arias intensity.

        ``pga`` [m/s²] and ``pga_time`` [s]; ``pgv`` [m/s]; ``pgd`` and ``end_displacement`` [m]; ``arias`` [m/s] (Arias 1970); ``cav`` [m/s], the integral of
        ``|a|`` (EPRI 1988); ``mean_period`` [s] of the Fourier amplitudes from 0.25 to 20 Hz (Rathje et al. 1998), NaN where there are none;
        ``significant_duration`` [s] from 5 to 95 % of the Arias intensity (Trifunac & Brady 1975), between the times ``significant_start`` and
        ``significant_end`` [s], and ``significant_duration_75`` [s] from 5 to 75 % (Somerville et al. 1997); ``duration`` [s] of the record.

        Raises
        ------
        ValueError
            For a ``gravity`` that is not above zero.
        """
        return {name: np.nan if value is None else value for name, value in self._record.measures(number("gravity", gravity)).items()}

    def spectrum(self, periods: npt.ArrayLike, damping: float = 0.05, *, threads: int = 0) -> Array:
        """Pseudo-spectral accelerations [m/s²] at periods [s], of the shape of the periods; exact for linear samples (Nigam & Jennings 1969).

        Parameters
        ----------
        periods : array
            Above zero [s].
        damping : float
            Damping ratio, from 0 to below 1.
        threads : int
            Number of threads, 0 for as many as the machine has.

        Raises
        ------
        ValueError
            For a period or a damping ratio out of range, or more than 1024 threads.
        """
        wanted = numbers("periods", periods)
        values = self._record.spectrum(np.ascontiguousarray(wanted.ravel()), number("damping", damping), whole("threads", threads))
        return values.reshape(wanted.shape)

    def to_csv(self, file: str | os.PathLike[str] | None = None) -> str | None:
        """Writes the record as a table of times from its first sample [s] and accelerations [m/s²]; returns the text where no file is given.

        :meth:`read` reads it back to the same samples; the record then starts at zero.
        """
        text = self._record.to_csv()
        if file is None:
            return text
        write_text(path_text("file", file), text)
        return None

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draws the accelerations over time."""
        from ._plot import record

        return record(self, ax)

    def __len__(self) -> int:
        return len(self._record)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._record.equals(other._record)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        peak = float(np.abs(self.accel).max())
        return f"<Record {self.name or 'without name'}: {len(self)} samples every {self.dt:g} s, peak {peak:.4g} m/s²>"

    def _scene_keys(self) -> dict[str, Any]:
        return {"kind": "record", "accel": self.accel.tolist(), "dt": self.dt, "start": self.start}

    def _short_keys(self) -> dict[str, Any]:
        """The keys with two samples only."""
        return {"kind": "record", "accel": [0.0, 0.0], "dt": self.dt, "start": self.start}

    def __getstate__(self) -> bytes:
        return self._record.state()

    def __setstate__(self, state: bytes) -> None:
        self._record = _rocking.Record.from_state(state)


class StudyRecord:
    """Components of one record under a name: horizontal, and perhaps vertical; not changed after it was made, and equal to itself alone."""

    __slots__ = ("_name", "_horizontal", "_vertical")

    def __init__(self, name: str, horizontal: Record, vertical: Record | None = None) -> None:
        for direction, record in (("horizontal", horizontal), ("vertical", vertical)):
            if not isinstance(record, Record) and not (record is None and direction == "vertical"):
                raise TypeError(f"{direction} is of {type(record).__name__}; give a Record")
        self._name = text("name", name)
        if not name:
            raise ValueError("name is empty; give the record a name, under which it stands in the table of a study")
        self._horizontal = horizontal
        self._vertical = vertical

    @property
    def name(self) -> str:
        """Name of the record, as in the table of a study."""
        return self._name

    @property
    def horizontal(self) -> Record:
        """The horizontal component."""
        return self._horizontal

    @property
    def vertical(self) -> Record | None:
        """The vertical component, if it shakes as well."""
        return self._vertical

    def _native(self) -> _rocking.StudyRecord:
        return _rocking.StudyRecord(self.name, self.horizontal._record, None if self.vertical is None else self.vertical._record)

    @classmethod
    def _of(cls, record: _rocking.StudyRecord) -> "StudyRecord":
        vertical = record.vertical
        return cls(record.name, Record._of(record.horizontal), None if vertical is None else Record._of(vertical))

    def __repr__(self) -> str:
        return f"<StudyRecord {self.name}{': horizontal and vertical' if self.vertical else ''}>"


#: Number of names in the text of a set of records.
MOST_SHOWN = 20


class Records(Sequence[StudyRecord]):
    """Records of a study, each under a name of its own. A :class:`Record` without a name is "record 3" for the third.

    Raises
    ------
    ValueError
        For a name that is given twice.
    """

    def __init__(self, records: "Iterable[StudyRecord | Record]") -> None:
        if isinstance(records, str | os.PathLike):
            raise TypeError(f"{os.fspath(records)!r} is a path; give records(folder), or a list of Record")
        if isinstance(records, (Record, StudyRecord)):
            raise TypeError(f"records is one {type(records).__name__}; give a list of them")
        self._records: list[StudyRecord] = []
        for number, record in enumerate(records, start=1):
            if isinstance(record, Record):
                record = StudyRecord(record.name or f"record {number}", record)
            if not isinstance(record, StudyRecord):
                raise TypeError(f"record {number} is a {type(record).__name__}; give a Record, as Record(samples, dt=0.01)")
            self._records.append(record)
        for name, count in Counter(record.name for record in self._records).items():
            if count > 1:
                raise ValueError(f"the name {name!r} is there twice; give each record a name of its own with Record.named")

    @overload
    def __getitem__(self, index: int) -> StudyRecord: ...

    @overload
    def __getitem__(self, index: slice) -> "Records": ...

    def __getitem__(self, index: int | slice) -> "StudyRecord | Records":
        return Records(self._records[index]) if isinstance(index, slice) else self._records[index]

    def __len__(self) -> int:
        return len(self._records)

    def __iter__(self) -> Iterator[StudyRecord]:
        return iter(self._records)

    def __repr__(self) -> str:
        shown, others = self._records[:MOST_SHOWN], len(self._records) - MOST_SHOWN
        more = f", and {others} more" if others > 0 else ""
        return f"<Records: {', '.join(record.name for record in shown)}{more}>"


def records(
    folder: str | os.PathLike[str],
    *,
    component: str | None = None,
    vertical: bool | None = None,
    units: str | None = None,
    dt: float | None = None,
    lenient: bool | None = None,
    channel: int | None = None,
    column: str | int | None = None,
    skip_rows: int | None = None,
    gravity: float = GRAVITY,
) -> Records:
    """All record files of a folder, in the order of their names and the numbers in them (``RSN6``, ``RSN77``, ``RSN125``).

    Parameters
    ----------
    folder : path
        The folder; what lies in folders within it is not read.
    component : str
        ``horizontal`` (the default) takes each horizontal component as a record of its own, ``vertical`` the vertical ones, another name those whose
        file name or header says so (``EW``, ``000``, ...); ``H1`` and ``H2`` are otherwise the horizontal ones by the order of the files' names.
    vertical : bool
        Whether the vertical component of each record shakes as well.
    units, dt, lenient, channel, column, skip_rows
        As of :meth:`Record.read`, for all files.
    gravity : float
        One g [m/s²], in files whose unit is g.

    Raises
    ------
    ValueError
        For a gravity that is not above zero.
    SceneError
        For a folder without records, a record without the component, a file that cannot be read; ``MissingFileError`` where there is no folder.
    """
    for name, words in (("component", component), ("units", units)):
        if words is not None:
            text(name, words)
    for name, choice in (("vertical", vertical), ("lenient", lenient)):
        if choice is not None:
            flag(name, choice)
    optional("dt", dt)
    if not number("gravity", gravity) > 0:
        raise ValueError(f"gravity = {gravity} is out of range; give m/s² above zero")
    given = path_text("folder", folder)
    path = os.path.abspath(given)
    try:
        is_folder = stat.S_ISDIR(os.stat(path).st_mode)
    except (FileNotFoundError, NotADirectoryError, ValueError):
        raise MissingFileError(f"{path}: there is no such folder; check the path", path) from None
    except OSError as failed:
        problem = failed.strerror or str(failed)
        remedy = "check the permissions" if isinstance(failed, PermissionError) else "check the path"
        raise SceneError(f"{path}: {problem}; {remedy}", path, key="records.folder", problem=problem, remedy=remedy) from None
    if not is_folder:
        raise SceneError(f"{path}: this is no folder; give one of record files", path, key="records.folder", problem="this is no folder")
    keys: dict[str, Any] = {
        "folder": given,
        "component": component,
        "vertical": vertical,
        "units": units,
        "dt": dt,
        "lenient": lenient,
        "channel": channel,
        "column": column,
        "skip_rows": skip_rows,
    }
    # The reader of studies finds components; any column and any level do.
    study = {"measure": "pga", "levels": [1.0], "records": keys, "scene": {"gravity": gravity, "block": [{"half_width": 0.1, "half_height": 1.0}]}}
    try:
        found = _rocking.Ida.from_toml(_rocking.to_toml(study), "<records>").records
    except SceneError as refused:
        # There is no file of a study, whose line could be named, and no argument `files`.
        problem, remedy = refused.problem, refused.remedy
        for what, read in (("records", "others"), ("files", "files")):
            remedy = remedy.replace(f"name the {what} with `files`", f"read the {read} one by one with Record.read")
        remedy = remedy.replace("give the folder relative to the study", "give a folder that can be read")
        problem = problem.removeprefix(f"{given}: ")
        argument = (refused.key or "").removeprefix("records.")
        place = f"{path}, {argument}" if argument in keys and argument != "folder" else path
        raise SceneError(f"{place}: {problem}; {remedy}", path, 0, refused.key, problem, remedy, refused.record) from None
    return Records(StudyRecord._of(record) for record in found)


def synthetic(seeds: Iterable[int], *, duration: float = 20.0, dt: float = 0.01, frequency: float = 2.5, damping: float = 0.6) -> Records:
    """Synthetic records, one for each seed, as :meth:`Record.synthetic` makes them; ValueError for a seed that is given twice."""
    if not isinstance(seeds, Iterable):
        raise TypeError(f"seeds is of {type(seeds).__name__}; give a sequence of whole numbers, such as range(10)")
    made = (Record.synthetic(seed, duration=duration, dt=dt, frequency=frequency, damping=damping) for seed in seeds)
    return Records(made)
