"""Rocking columns of stacked rigid blocks in earthquakes.

>>> import rocking as rk
>>> column = rk.Column.drums(3, half_width=0.4, half_height=1.56, density=2700)
>>> run = rk.simulate(column, rk.pulse("sine-pulse", amplitude_g=0.75, omega=10.7), eta=0.9, t_end=10)
>>> run.outcome, run.theta.shape
('rocks', (1001, 3))

Lengths are in m, masses in kg, times in s, angles in rad. Arguments have the names and units of the keys of scene files. Blocks and interfaces are base first.

``MEASURES`` are the names of the measures to which a record can be scaled, ``MAX_BLOCKS`` the number of blocks
up to which this build has generated equations of motion.
"""

from ._errors import FolderError, MissingFileError, RecordError, RockingError, SceneError, SolveError, StudyError
from ._motion import Motion, pulse, total
from ._record import Record, Records, StudyRecord, records, synthetic
from ._rocking import MAX_BLOCKS, MEASURES, __version__
from ._run import Run, simulate, trust
from ._scene import Block, Column, Scene
from ._study import Fragility, Ida, Study, ida
from ._sweep import Sweep, sweep
from ._trust import Trust

__all__ = [
    "Block",
    "Column",
    "FolderError",
    "Fragility",
    "Ida",
    "MAX_BLOCKS",
    "MEASURES",
    "MissingFileError",
    "Motion",
    "Record",
    "RecordError",
    "Records",
    "RockingError",
    "Run",
    "Scene",
    "SceneError",
    "SolveError",
    "Study",
    "StudyError",
    "StudyRecord",
    "Sweep",
    "Trust",
    "__version__",
    "ida",
    "pulse",
    "records",
    "simulate",
    "sweep",
    "synthetic",
    "total",
    "trust",
]
