"""Columns and scenes: the keys of a scene file, checked by its reader."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict, Union

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _rocking
from ._arguments import number, path_text
from ._errors import SceneError
from ._files import write_text
from ._keys import copied
from ._motion import Motion, MotionLike, checked
from ._record import Array, Record, StudyRecord

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: Name in errors of a scene that has no file.
WITHOUT_FILE = "<scene>"
#: Files of scenes that have no keys of their own.
POINT, RUN = "<point of a sweep>", "<run of a study>"
#: Keys of the ground motion that name files.
FILE_KEYS = ("file", "record")

Numbers = Union[Sequence[float], npt.NDArray[Any], "pd.Series[Any]"]


class SceneKeys(TypedDict, total=False):
    """Keys of a scene file other than column and ground motion, under the names of arguments; None leaves one out."""

    title: str | None
    gravity: float | None
    friction: float | Mapping[str, Any] | None
    law: str | None
    eta: float | None
    factors: Numbers | None
    theta: Numbers | None
    omega: Numbers | None
    slide: Numbers | None
    x: Numbers | None
    y: Numbers | None
    vx: Numbers | None
    vy: Numbers | None
    t_end: float | None
    method: str | None
    rtol: float | None
    atol: float | None
    step: float | None
    stick_angle: float | None
    overturn_angle: float | None
    output_dt: float | None
    t_eval: Numbers | None
    output_columns: Sequence[str] | None
    keys: Mapping[str, Any] | None


#: Where the arguments stand in a scene file.
ARGUMENTS: dict[str, str] = {
    **{name: name for name in ("title", "gravity", "friction")},
    **{name: f"restitution.{name}" for name in ("law", "eta", "factors")},
    **{name: f"initial.{name}" for name in ("theta", "omega", "slide", "x", "y", "vx", "vy")},
    **{name: f"solver.{name}" for name in ("t_end", "method", "rtol", "atol", "step", "stick_angle", "overturn_angle")},
    "output_dt": "output.dt",
    "t_eval": "output.times",
    "output_columns": "output.columns",
}

#: Tables whose keys are settings by themselves: of such a table in ``keys`` each key is set, and the others stay.
SETTINGS = ("initial", "solver", "output")

#: Keys of a scene that are those of its column.
OF_COLUMN = ("column", "block", "gravity", "size")

#: Keys of rows, of which a scene has one; other keys of which it has one: ``_rocking.replaced_by``.
ROWS = ("output.dt", "output.times")


class Sizes(TypedDict, total=False):
    """Sizes and material of a block, or of a column: keys that both have in a scene file; m, kg, kg m²."""

    name: str | None
    half_width: float | None
    width: float | None
    diameter: float | None
    bottom_half_width: float | None
    bottom_width: float | None
    bottom_diameter: float | None
    top_half_width: float | None
    top_width: float | None
    top_diameter: float | None
    half_height: float | None
    height: float | None
    depth: float | None
    density: float | None
    mass: float | None
    centroid_height: float | None
    inertia: float | None


class Block(Mapping[str, Any]):
    """A block: the keys of a ``[[block]]`` of a scene file; lengths in m, mass in kg.

    Parameters
    ----------
    shape : str
        ``prism`` or ``drum``; with a diameter a drum unless given, else a prism.
    half_width, width, diameter : float
        Of the whole block; one of them, or one of the base and one of the top: ``bottom_half_width``, ``bottom_width``, ``bottom_diameter``,
        ``top_half_width``, ``top_width``, ``top_diameter``. Half the width of a drum is its radius.
    half_height, height : float
        One of them.
    density, mass : float
        One of them, or neither: 1 unless given. A density is in kg/m³ of drums and of prisms with a ``depth``, else in kg/m².
    depth : float
        Of a prism, across the plane of motion.
    centroid_height, inertia : float
        Of a block that is not homogeneous: height of the centroid above the base [m], moment of inertia about it [kg m²].
    name : str
        As in tables and reports.

    The column that takes the block checks its keys, and raises :class:`SceneError`.

    >>> Block(half_width=0.4, height=1.6, density=2700)
    Block(half_width=0.4, half_height=0.8, density=2700)
    """

    def __init__(self, *, shape: str | None = None, **sizes: "Unpack[Sizes]") -> None:
        self._keys = _halved({**sizes, "shape": shape})

    def __getitem__(self, key: str) -> Any:
        return self._keys[key]

    def __iter__(self) -> Any:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)

    def __repr__(self) -> str:
        return f"Block({', '.join(f'{key}={value!r}' for key, value in self._keys.items())})"


def _halved(sizes: Mapping[str, Any]) -> dict[str, Any]:
    """The keys that are given, width and height as their halves."""
    keys: dict[str, Any] = {}
    for key, value in sizes.items():
        if key in ("width", "height") and value is not None:
            if sizes.get(f"half_{key}") is not None:
                raise TypeError(f"half_{key} and {key} are given; give one of them")
            # The reader refuses text, and names the key.
            key, value = f"half_{key}", value if isinstance(value, str) else number(key, value) / 2
        if value is not None:
            keys[key] = copied(value)
    return keys


def _blocks(blocks: Any) -> Iterable[Mapping[str, Any]]:
    """Blocks, base first; another thing is refused, with what to make of it."""
    kind = type(blocks).__name__
    if isinstance(blocks, (Motion, Record, StudyRecord)):
        raise TypeError(f"the column is of {kind}; give the column first, then the motion")
    if isinstance(blocks, (str, os.PathLike)):
        raise TypeError(f"the column is of {kind}; read a scene with Scene.load({os.fspath(blocks)!r})")
    if isinstance(blocks, pd.DataFrame):
        raise TypeError('the column is of DataFrame; give a list of Block, as table.to_dict("records")')
    if isinstance(blocks, Mapping) or not isinstance(blocks, Iterable):
        raise TypeError(f"the column is of {kind}; give a list of Block, base first")
    for number, block in enumerate(blocks, start=1):
        if not isinstance(block, Mapping):
            raise TypeError(f"block {number} is of {type(block).__name__}; give a Block, as Block(width=0.8, height=3.2)")
        yield block


def _refuse_shape(name: str, sizes: Mapping[str, Any]) -> None:
    if "shape" in sizes:
        raise TypeError(f"Column.{name} has its shape; leave `shape` out, or use Column.cut")


class Column:
    """A column of blocks, base first, checked when it is made.

    Parameters
    ----------
    blocks : iterable of Block or mapping
        Base first.
    gravity : float
        [m/s²], 9.81 unless given.

    Raises
    ------
    SceneError
        For a block that is refused, with the key and the remedy.

    >>> column = Column.drums(5, half_width=0.5, top_half_width=0.4, height=5.0, density=2700)
    >>> len(column), round(column.alpha, 4)
    (5, 0.2127)
    """

    def __init__(self, blocks: Iterable[Mapping[str, Any]], *, gravity: float | None = None) -> None:
        self._become({"block": [copied(block) for block in _blocks(blocks)]}, gravity)

    def _become(self, keys: dict[str, Any], gravity: float | None) -> None:
        self._keys: dict[str, Any] = {**keys, **({} if gravity is None else {"gravity": gravity})}
        self._compiled: _rocking.Scene | None = None
        self._native()

    def _native(self) -> _rocking.Scene:
        if self._compiled is None:
            self._compiled = _rocking.Scene.from_keys(self._keys, "<column>", None, None)
        return self._compiled

    @classmethod
    def cut(cls, blocks: int, *, shape: str | None = None, gravity: float | None = None, **sizes: "Unpack[Sizes]") -> "Column":
        """A column cut into blocks of equal height, with straight sides: ``[column]`` of a scene file. Height and mass are those of the whole column.

        Sizes are those of :class:`Block`, of the whole column. SceneError for one that is refused.
        """
        made = cls.__new__(cls)
        made._become({"column": {"blocks": blocks, **_halved({**sizes, "shape": shape})}}, gravity)
        return made

    @classmethod
    def drums(cls, blocks: int, *, gravity: float | None = None, **sizes: "Unpack[Sizes]") -> "Column":
        """Round drums: :meth:`cut` with ``shape="drum"``; half-widths are radii, a density is in kg/m³."""
        _refuse_shape("drums", sizes)
        return cls.cut(blocks, shape="drum", gravity=gravity, **sizes)

    @classmethod
    def prisms(cls, blocks: int, *, gravity: float | None = None, **sizes: "Unpack[Sizes]") -> "Column":
        """Prisms: :meth:`cut` with ``shape="prism"``; a density is in kg/m³ with ``depth``, in kg/m² without."""
        _refuse_shape("prisms", sizes)
        return cls.cut(blocks, shape="prism", gravity=gravity, **sizes)

    @property
    def blocks(self) -> pd.DataFrame:
        """Sizes of the blocks, base first, a row each.

        ``bottom_half_width``, ``top_half_width``, ``half_height`` and the ``centroid_height`` above the base [m], ``mass`` [kg], and ``inertia`` [kg m²], the
        moment of inertia about the centroid.
        """
        return pd.DataFrame(self._native().blocks(), index=pd.RangeIndex(1, len(self) + 1, name="block"))

    @property
    def stacks(self) -> pd.DataFrame:
        """The stack that begins with each block, as one body (Housner 1963), a row each.

        ``alpha`` [rad] is its slenderness, ``R`` [m] the distance of its centre of gravity from the corner of its base, ``p`` [rad/s] its frequency
        parameter, the square root of ``m g R`` over its moment of inertia about that corner; ``uplift_acceleration`` [m/s²] opens its base;
        ``housner_ratio`` is the ratio of its rates after and before an impact of its base. The book's chapter Conventions has the formulas.
        """
        return pd.DataFrame(self._native().stacks(), index=pd.RangeIndex(1, len(self) + 1, name="block"))

    @property
    def alpha(self) -> float:
        """Slenderness of the whole column [rad]."""
        return self._native().stacks()["alpha"][0]

    @property
    def R(self) -> float:
        """Distance of the centre of gravity of the whole column from a corner of its base [m]."""
        return self._native().stacks()["R"][0]

    @property
    def p(self) -> float:
        """Frequency parameter of the whole column as one body [rad/s], the square root of ``m g R`` over its moment of inertia about the corner (Housner 1963)."""
        return self._native().stacks()["p"][0]

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal ground acceleration that opens the base [m/s²]."""
        return self._native().stacks()["uplift_acceleration"][0]

    def __len__(self) -> int:
        return len(self._native().blocks()["mass"])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Column) and self._native().equals(other._native())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        stacks = self._native().stacks()
        return f"<Column of {len(self)} block(s): alpha = {stacks['alpha'][0]:.4f} rad, p = {stacks['p'][0]:.4f} rad/s>"

    def __getstate__(self) -> dict[str, Any]:
        return self._keys

    def __setstate__(self, keys: dict[str, Any]) -> None:
        self._keys, self._compiled = keys, None


class Scene:
    """What is simulated: the keys of a scene file, checked by its reader; not changed after it was made.

    Parameters
    ----------
    column : Column, or iterable of Block
    horizontal, vertical : Motion, Record or mapping
        Ground motion.
    **arguments
        Every other key of a scene file: ``title``; ``gravity`` [m/s²]; ``friction``, a coefficient or ``{"static": .., "kinetic": ..}``; ``eta``,
        ``factors`` or ``law`` of impacts; ``theta`` [rad], ``omega`` [rad/s], ``slide`` [m], ``x``, ``y`` [m], ``vx``, ``vy`` [m/s] at t = 0, base first;
        ``t_end`` [s], ``method``, ``rtol``, ``atol``, ``step`` [s], ``stick_angle`` [rad], ``overturn_angle`` [rad] of the solver; the interval
        ``output_dt`` of the rows [s] or their times ``t_eval`` [s], ascending, shape (rows,); ``output_columns``, of ``relative`` and ``top``. ``keys`` takes
        any others under their dotted names.

    Raises
    ------
    SceneError
        With the key and the remedy.

    >>> scene = Scene(Column.drums(2, half_width=0.4, height=3.2, density=2700), theta=[0.05, 0.05], t_end=2)
    >>> scene.keys["solver"]
    {'t_end': 2}
    """

    def __init__(
        self,
        column: "Column | Iterable[Mapping[str, Any]]",
        horizontal: MotionLike | None = None,
        vertical: MotionLike | None = None,
        **arguments: "Unpack[SceneKeys]",
    ) -> None:
        column = column if isinstance(column, Column) else Column(column)
        keys = copied(column._keys)
        given = (("horizontal", horizontal), ("vertical", vertical))
        motions = {name: checked(f"{name} motion", motion) for name, motion in given if motion is not None}
        if motions:
            keys["excitation"] = copied(motions)
        for key, value in dotted(arguments):
            _put(keys, key, copied(value))
        self._become(keys, WITHOUT_FILE)

    def _become(self, keys: dict[str, Any], file: str, native: _rocking.Scene | None = None, text: str | None = None) -> None:
        keys = _of_this_folder(keys) if is_label(file) else keys
        self._keys, self._file, self._text = keys, file, text
        if native is None:
            shown = keys
            records: list[Record | None] = [None, None]
            motions = keys.get("excitation")
            if isinstance(motions, Mapping):
                records = [record if isinstance(record := motions.get(name), Record) else None for name in ("horizontal", "vertical")]
                if any(records):
                    others = {name: motion for name, motion in motions.items() if not isinstance(motion, Record)}
                    shown = {**keys, "excitation": others or None}
            horizontal, vertical = (None if record is None else record._record for record in records)
            try:
                native = _rocking.Scene.from_keys(shown, file, horizontal, vertical)
            except SceneError:
                if any(records):
                    # Lines of errors are those of the whole text, in which each record takes as many as a record of two samples.
                    short = {name: motion._short_keys() if isinstance(motion, Record) else motion for name, motion in (motions or {}).items()}
                    _rocking.Scene.from_keys({**keys, "excitation": short}, file, horizontal, vertical)
                raise
        self._compiled = native

    @classmethod
    def _of(cls, keys: dict[str, Any], file: str, native: _rocking.Scene | None = None, text: str | None = None) -> "Scene":
        made = cls.__new__(cls)
        made._become(keys, file, native, text)
        return made

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> "Scene":
        """Reads a scene file; records are found relative to it.

        Raises
        ------
        SceneError
            For a scene that is refused, with file, line, key and remedy; :class:`MissingFileError` where the file, or a record of it, is not there.
        """
        path = _place(file)
        return cls.from_toml(_rocking.scene_text(path), file=path)

    @classmethod
    def from_toml(cls, text: str, *, file: str | os.PathLike[str] = WITHOUT_FILE) -> "Scene":
        """Reads the text of a scene file; ``file`` is named in errors, and records are found relative to it. Raises as :meth:`load`.

        Without a file, or with a name in angle brackets, they are found relative to the present folder. The text of such a scene with such a record is written
        anew, without its comments, with the absolute path of the record.
        """
        if not isinstance(text, str):
            raise TypeError(f"text is of {type(text).__name__}; give the text of a scene, or keys to Scene.from_dict")
        path = _place(file)
        # Errors have lines of this text.
        native, keys = _rocking.Scene.from_toml(text, path), _rocking.from_toml(text)
        return cls._of(keys, path) if is_label(path) and _relative_files(keys) else cls._of(keys, path, native, text)

    @classmethod
    def from_dict(cls, keys: Mapping[str, Any], *, file: str | os.PathLike[str] = WITHOUT_FILE) -> "Scene":
        """Reads the keys of a scene file as a nested dictionary; records are found relative to ``file``, or to the present folder. Raises as :meth:`load`;
        errors name ``<scene>``."""
        if not isinstance(keys, Mapping):
            raise TypeError(f"keys are of {type(keys).__name__}; give a dictionary of the keys of a scene file")
        return cls._of(copied(keys), _place(file))

    def replace(
        self,
        *,
        column: "Column | Iterable[Mapping[str, Any]] | None" = None,
        horizontal: MotionLike | None = None,
        vertical: MotionLike | None = None,
        **arguments: "Unpack[SceneKeys]",
    ) -> "Scene":
        """The scene with other arguments; ``keys`` takes dotted ones such as ``{"block[2].mass": 900.0}``.

        A new key takes the place of those of which a scene has one, as an axis of a sweep does: ``mass`` that of ``density``, ``amplitude`` that of
        ``amplitude_g``.

        Another ``column`` replaces the blocks, their ``size`` and the gravity, which is 9.81 m/s² unless the new column has one. None removes a key:
        ``friction=None`` gives the scene without friction, ``keys={"excitation.vertical": None}`` without vertical motion, which ``vertical=None``, as
        ``horizontal=None`` and ``column=None``, leaves as it is.

        Raises
        ------
        SceneError
            For a scene that is refused, with the key and the remedy.
        ValueError
            For a dotted name that the scene cannot have, and for the scene of a point of a sweep or of a run of a study, which has no keys.
        """
        keys = self.keys
        if column is not None:
            column = column if isinstance(column, Column) else Column(column)
            keys = {**{key: value for key, value in keys.items() if key not in OF_COLUMN}, **copied(column._keys)}
        for name, motion in (("horizontal", horizontal), ("vertical", vertical)):
            if motion is not None:
                _put(keys, f"excitation.{name}", copied(checked(f"{name} motion", motion)))
        given = list(dotted(arguments))
        for key, value in given:
            _put(keys, key, copied(value))
        # Those of the scene make room for those given; of two that are given the reader refuses one.
        named = {key for key, _ in given}
        for key, value in given:
            for other in _replaced_by(key) if value is not None else ():
                if other not in named:
                    _put(keys, other, None)
        return Scene._of(keys, self._file)

    @property
    def keys(self) -> dict[str, Any]:
        """The keys as in a scene file; a copy. ValueError for the scene of a point of a sweep or of a run of a study, which has none; so :attr:`toml`."""
        if self._file in (POINT, RUN):
            raise ValueError(f"the scene of a {self._file[1:-1]} has no keys of its own; change those of the base scene")
        keys: dict[str, Any] = copied(self._keys)
        return keys

    @property
    def toml(self) -> str:
        """The scene as the text of a scene file, records in memory with their samples."""
        return self._text if self._text is not None else _rocking.to_toml(self.keys)

    @property
    def file(self) -> str:
        """The scene file; ``<scene>``, ``<point of a sweep>`` or ``<run of a study>`` for a scene without one."""
        return self._file

    @property
    def column(self) -> Column:
        """The column as its blocks stand above each other, without the slides of the initial state. ValueError where there are no :attr:`keys`."""
        made = Column.__new__(Column)
        keys = self.keys
        made._become({key: keys[key] for key in OF_COLUMN if key in keys}, None)
        return made

    @property
    def title(self) -> str:
        """The title; empty where there is none."""
        return self._compiled.title

    @property
    def t_end(self) -> float:
        """End of the run [s]."""
        return self._compiled.t_end

    @property
    def warnings(self) -> list[str]:
        """Warnings about its records, and about numbers that are likely missing or in another unit, a sentence each."""
        return self._compiled.warnings

    @property
    def contacts(self) -> pd.DataFrame:
        """What the ground motion does to each contact of the column at rest, base first, a row each: which slides or opens first, and when. Nothing is run.

        Of the state at t = 0 only ``slide`` counts; angles, rates and places of blocks (``x``, ``y``) do not. Each contact is taken by itself, with the stack
        above as one body and the others closed. ``coefficient`` is that of static friction; ``slides_at`` and ``opens_at`` [m/s²] are horizontal
        accelerations of the ground, without vertical motion, at which the contact slides, and opens on the side on which it takes less; ``opens_at`` is
        negative for a stack that leans beyond its support. ``slides_from`` and ``opens_from`` [s] are the first times at which this ground motion, both
        components, does so. At ``weightless_from`` [s] the vertical one takes all weight from a contact with friction that neither slides nor opens before.
        ``at_pga``: whether the stack ``rests``, ``slides``, ``rocks`` or ``slides-and-rocks`` under the largest horizontal acceleration, and
        ``coefficient_to_rock`` the least coefficient with which it would rock without sliding; neither where the ground moves vertically, the stack is
        displaced, or the contact slides and opens at the same acceleration. What does not happen is blank.

        >>> from rocking import pulse
        >>> statue = Scene([Block(half_width=0.25, half_height=1.0)], pulse("half-sine", amplitude_g=1.0, period=1.0), friction=0.5)
        >>> print(statue.contacts.at_pga[1], round(statue.contacts.coefficient_to_rock[1], 5))
        rocks 0.41558
        """
        contacts: dict[str, Any] = {**self._compiled.contacts()}
        contacts["at_pga"] = pd.array(contacts["at_pga"], dtype="string")
        return pd.DataFrame(contacts, index=pd.RangeIndex(1, len(contacts["opens_at"]) + 1, name="interface"))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scene file.

        Raises
        ------
        ValueError
            Where the scene names records relative to its own folder and the file is for another one: it would name other records; and where the file is
            a record of the scene.
        """
        path = path_text("file", file)
        own, new = os.path.dirname(os.path.abspath(self._file)), os.path.dirname(os.path.abspath(path))
        named = _relative_files(self.keys)
        if named and own != new:
            raise ValueError(f"the scene names {named[0]} relative to {own}; save it there, or name the record by its absolute path")
        if os.path.realpath(path) in (os.path.realpath(os.path.join(own, name)) for name in _files(self.keys.get("excitation"))):
            raise ValueError(f"the scene reads the record {path}; give another name")
        write_text(path, self.toml)

    def to_json(self) -> str:
        """The scene with all of its numbers in SI, as the solver has it."""
        return self._compiled.json()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._compiled.equals(other._compiled)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        blocks = len(self._compiled.blocks()["mass"])
        return f"<Scene{f' “{self.title}”' if self.title else ''} of {blocks} block(s) until {self.t_end:g} s>"

    def __getstate__(self) -> tuple[dict[str, Any], str, str | None, bytes]:
        return self._keys, self._file, self._text, self._compiled.state()

    def __setstate__(self, state: tuple[dict[str, Any], str, str | None, bytes]) -> None:
        keys, file, text, native = state
        self._become(keys, file, _rocking.Scene.from_state(native), text)


def dotted(arguments: Mapping[str, Any]) -> Iterable[tuple[str, Any]]:
    """Arguments under the dotted names of their keys, those of ``keys`` last; None for a key that is left out."""
    for name, value in arguments.items():
        if name == "keys":
            continue
        if name not in ARGUMENTS:
            known = ", ".join([*ARGUMENTS, "keys"])
            raise TypeError(f"there is no argument `{name}`; arguments are {known}")
        yield ARGUMENTS[name], value
    others = {} if arguments.get("keys") is None else arguments["keys"]
    if not isinstance(others, Mapping):
        raise TypeError(f"keys are of {type(others).__name__}; give a dictionary of dotted names")
    for key, value in others.items():
        if not isinstance(key, str):
            raise TypeError(f"the name {key!r} in keys is of {type(key).__name__}; give dotted names, such as \"solver.rtol\"")
        if key in SETTINGS and isinstance(value, Mapping):
            yield from ((f"{key}.{name}", item) for name, item in value.items())
        else:
            yield key, value


def _place(file: str | os.PathLike[str]) -> str:
    """The file of a scene as an absolute path: its records may be read later, by `replace` or another process, in another folder."""
    path = path_text("file", file)
    return path if is_label(path) else os.path.abspath(path)


def is_label(file: str) -> bool:
    """Whether this is a name for errors, in angle brackets, of what has no file."""
    return file.startswith("<") and file.endswith(">")


def _relative_files(keys: Mapping[str, Any]) -> list[str]:
    return [name for name in _files(keys.get("excitation")) if name and not os.path.isabs(name)]


def _of_this_folder(keys: dict[str, Any]) -> dict[str, Any]:
    """Keys of a scene without a file, whose records are named by their absolute paths: they may be read later in another folder."""
    return {**keys, "excitation": _absolute(keys["excitation"])} if _relative_files(keys) else keys


def absolute(file: Any) -> Any:
    """The absolute path of a file; what is no path, as it is."""
    return os.path.abspath(os.fspath(file)) if file and isinstance(file, (str, os.PathLike)) else file


def _absolute(motion: Any) -> Any:
    """Keys of the ground motion with absolute paths of files."""
    if isinstance(motion, Mapping):
        found = {key: absolute(value) if key in FILE_KEYS else _absolute(value) for key, value in motion.items()}
        return Motion(**found) if isinstance(motion, Motion) else found
    return [_absolute(item) for item in motion] if isinstance(motion, list) else motion


def _files(motion: Any) -> Iterable[str]:
    """Files that keys of the ground motion name."""
    if isinstance(motion, Mapping):
        for key, value in motion.items():
            yield from [os.fspath(value)] if key in FILE_KEYS and isinstance(value, (str, os.PathLike)) else _files(value)
    elif isinstance(motion, list):
        for item in motion:
            yield from _files(item)


def _replaced_by(key: str) -> Iterable[str]:
    """Dotted keys that a dotted key replaces: ``block[2].density`` and ``block[2].depth`` for ``block[2].mass``."""
    if key in ROWS:
        return ROWS
    table, dot, name = key.rpartition(".")
    return [table + dot + other for other in _rocking.replaced_by(name)]


def _put(keys: dict[str, Any], key: str, value: Any) -> None:
    """Sets a dotted key, ``block[2].mass`` that of the second block; ``None`` removes it."""
    place: Any = keys
    *tables, last = key.split(".")
    for name in tables:
        part = _part(name)
        if isinstance(part, str):
            inner = place.get(part)
            if isinstance(inner, Motion):
                inner = place[part] = dict(inner)
            elif not isinstance(inner, dict):
                if value is None:
                    return
                if inner is not None:
                    remedy = "give another record, as of Record.scaled" if isinstance(inner, Record) else f"give all of `{name}`, as a dictionary"
                    raise ValueError(f"`{key}`: {name} is a {type(inner).__name__} and has no keys; {remedy}")
                inner = place[part] = {}
            place = inner
        else:
            place = _item(place, part, key)
            if isinstance(place, Record):
                raise ValueError(f"`{key}`: {name} is a Record and has no keys; give another record, as of Record.scaled")
    part = _part(last)
    if not isinstance(part, str):
        (name, number) = part
        items = list(place.get(name, ()))
        if not 1 <= number <= len(items):
            raise ValueError(f"`{key}`: the scene has no such item; count from 1")
        items[number - 1] = value
        place[name] = items
    elif value is None:
        place.pop(part, None)
    else:
        place[part] = value


def _part(name: str) -> "str | tuple[str, int]":
    indexed = re.fullmatch(r"(\w+)\[(\d+)\]", name)
    return (indexed[1], int(indexed[2])) if indexed else name


def _item(place: dict[str, Any], part: tuple[str, int], key: str) -> Any:
    items = place.get(part[0])
    if not isinstance(items, list) or not 1 <= part[1] <= len(items):
        raise ValueError(f"`{key}`: the scene has no such item; count from 1")
    return items[part[1] - 1]


__all__ = ["ARGUMENTS", "Array", "Block", "Column", "Scene", "SceneKeys"]
