"""Sweeps: many scenes from one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import pandas as pd

from . import _rocking
from ._arguments import path_text, whole
from ._errors import warn
from ._keys import copied
from ._plan import Plan
from ._scene import FILE_KEYS, POINT, Scene, absolute, is_label

if TYPE_CHECKING:
    import pyarrow

#: What is asked of each run of a sweep.
Ask = Literal["outcome", "overturns", "peaks", "slides", "validity", "trust"]

#: How axes are combined.
Combine = Literal["cartesian", "paired"]

# Points whose scenes are read for warnings.
POINTS_READ = 1000


class Sweep(Plan):
    """A scene and the axes over its keys; the point of any index is found without the others.

    Parameters
    ----------
    scene : Scene
        The base scene.
    axes : mapping
        Keys of a scene file, dotted or short as in a sweep file, and their values: one number or name, or a sequence of them, or
        ``{"from": .., "to": .., "steps": .., "scale": "log"}``, or a distribution such as ``{"lognormal": [median, dispersion]}``. The last axis runs
        fastest.
    ask : str
        ``outcome``, ``overturns``, ``peaks``, ``slides``, ``validity`` or ``trust``.
    combine : str
        ``cartesian`` or ``paired``.
    sampling : mapping
        Where axes are distributions, the keys of ``[sampling]`` of a sweep file: ``samples``, ``method`` (``plain``, ``latin-hypercube`` or ``sobol``),
        ``seed``, ``correlations``.

    Raises
    ------
    SceneError
        For a key that no scene has, an axis without values, a base scene that is refused. A point whose scene is refused is a row with an error.

    >>> from rocking import Column, pulse
    >>> scene = Scene(Column.prisms(1, half_width=0.4, half_height=1.6), pulse("sine-pulse", amplitude_uplift=3, omega_p=5), eta=0.9)
    >>> sweep = Sweep(scene, {"amplitude_uplift": [0.5, 2.0, 8.0]})
    >>> sweep.table().outcome.tolist()
    ['no-uplift', 'rocks', 'overturns']
    """

    def __init__(
        self,
        scene: Scene,
        axes: Mapping[str, Any],
        *,
        ask: Ask = "outcome",
        combine: Combine = "cartesian",
        sampling: Mapping[str, Any] | None = None,
    ) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene is of {type(scene).__name__}; give a Scene")
        for name, value in (("axes", axes), ("sampling", {} if sampling is None else sampling)):
            if not isinstance(value, Mapping):
                raise TypeError(f"{name} is of {type(value).__name__}; give a dictionary")
        axes, sampling = copied(axes), copied(sampling)
        if is_label(scene.file):
            # As the records of the scene: those of the present folder.
            axes = {key: _absolute(values) if str(key).rsplit(".", 1)[-1] in FILE_KEYS else values for key, values in axes.items()}
        self._source: tuple[Any, ...] = (scene, axes, ask, combine, sampling)
        drawn = {} if sampling is None else {"sampling": sampling}
        text = _rocking.to_toml({"ask": ask, "combine": combine, **drawn, "axes": axes})
        self._sweep = _rocking.Sweep.from_toml(text, "<sweep>", scene.toml, scene.file)

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> "Sweep":
        """Reads a sweep file.

        Raises
        ------
        SceneError
            For a sweep that is refused, with file, line, key and remedy; :class:`MissingFileError` where the file is not there.
        """
        made = cls.__new__(cls)
        # A process that runs a part may have another folder, and the file may be another by then.
        path = os.path.abspath(path_text("file", file))
        made._sweep = _rocking.Sweep.load(path)
        made._source = (path, _rocking.scene_text(path), *made._sweep.base)
        return made

    @property
    def axes(self) -> dict[str, int]:
        """Dotted keys of the axes, and their numbers of values."""
        return dict(self._sweep.axes)

    @property
    def ask(self) -> str:
        """What is asked of each run."""
        return self._sweep.ask

    @property
    def warnings(self) -> list[str]:
        """Warnings about axes and about the scenes of the points, or of a thousand points that are evenly spread, a sentence each, each once."""
        return self._sweep.warnings(POINTS_READ)

    def __len__(self) -> int:
        return len(self._sweep)

    def scene(self, index: int) -> Scene:
        """The scene of a point, with rows and forces. It has no keys: it can be run as it is, and not changed by :meth:`Scene.replace`.

        Raises
        ------
        SceneError
            For a scene that is refused.
        IndexError
            For a point after the last one; ValueError for a negative index.
        """
        return Scene._of({}, POINT, self._sweep.scene(whole("index", index)))

    def _columns(self, start: int, stop: int, threads: int) -> list[tuple[Any, ...]]:
        return self._sweep.table(start, stop, threads)

    def __repr__(self) -> str:
        axes = ", ".join(f"{key} ({count})" for key, count in self.axes.items())
        return f"<Sweep of {len(self)} points over {axes}; ask = {self.ask}>"

    def __getstate__(self) -> tuple[Any, ...]:
        return self._source

    def __setstate__(self, source: tuple[Any, ...]) -> None:
        if len(source) == 4:
            path, text, base, base_file = self._source = source
            keys = _rocking.from_toml(text)
            keys.pop("scene", None)
            self._sweep = _rocking.Sweep.from_toml(_rocking.to_toml(keys), path, base, base_file)
        else:
            scene, axes, ask, combine, sampling = source
            self.__init__(scene, axes, ask=ask, combine=combine, sampling=sampling)  # type: ignore[misc]


def _absolute(files: Any) -> Any:
    """Values of an axis of files, with absolute paths: a file, a list of files, or ``{"folder": ..}``."""
    if isinstance(files, Mapping):
        return {key: absolute(value) if key == "folder" else value for key, value in files.items()}
    return list(map(absolute, files)) if isinstance(files, (list, np.ndarray)) else absolute(files)


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Any],
    *,
    ask: Ask = ...,
    combine: Combine = ...,
    sampling: Mapping[str, Any] | None = ...,
    threads: int = ...,
    table: Literal["pandas"] = ...,
) -> pd.DataFrame: ...


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Any],
    *,
    ask: Ask = ...,
    combine: Combine = ...,
    sampling: Mapping[str, Any] | None = ...,
    threads: int = ...,
    table: Literal["pyarrow"],
) -> "pyarrow.Table": ...


def sweep(
    scene: Scene,
    axes: Mapping[str, Any],
    *,
    ask: Ask = "outcome",
    combine: Combine = "cartesian",
    sampling: Mapping[str, Any] | None = None,
    threads: int = 0,
    table: Literal["pandas", "pyarrow"] = "pandas",
) -> "pd.DataFrame | pyarrow.Table":
    """Runs a sweep; as :class:`Sweep` with :meth:`Sweep.table`, or with :meth:`Sweep.to_arrow` where ``table`` is ``pyarrow``.

    >>> from rocking import Column, pulse
    >>> scene = Scene(Column.prisms(1, half_width=0.4, half_height=1.6), pulse("sine-pulse", amplitude_uplift=3, omega_p=5), eta=0.9)
    >>> drawn = sweep(scene, {"amplitude_uplift": {"lognormal": [5.0, 0.4]}}, sampling={"samples": 200, "method": "sobol", "seed": 1})
    >>> bool((drawn.outcome == "overturns").mean() > 0.05)
    True
    """
    if table not in ("pandas", "pyarrow"):
        raise ValueError(f"there is no table of {table!r}; give pandas or pyarrow")
    plan = Sweep(scene, axes, ask=ask, combine=combine, sampling=sampling)
    warn(plan.warnings)
    made = plan.table(threads=threads) if table == "pandas" else plan.to_arrow(threads=threads)
    outcomes = made["outcome"].unique()
    if list(map(str, outcomes)) == ["error"]:
        warn([f"all {len(plan)} runs failed; the first: {made['error'][0]}"])
    return made
