"""Types: of the package, of its stubs, and of a program that uses it."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest
import rocking as rk

PROGRAM = """
import numpy as np
import pandas as pd
import rocking as rk
from typing_extensions import assert_type

column = rk.Column.drums(5, half_width=0.5, top_half_width=0.4, height=5.0, density=2700)
run = rk.simulate(column, rk.pulse("ricker", amplitude_g=0.4, frequency=1.2), eta=0.9, t_end=30.0, theta=np.zeros(5))
assert_type(run, rk.Run)
assert_type(run.impacts, int)
study = rk.ida(column, rk.synthetic(range(6)), "PGV", np.linspace(0.05, 2, 20), eta=0.9)
assert_type(rk.sweep(run.scene, {"eta": [0.9]}), pd.DataFrame)
assert_type(study.fragility("overturned").median, float | None)
rk.simulate(column, eat=0.9)  # E: not an argument
rk.Scene(column, t_end="ten")  # E: not a number
rk.simulate(column, t_eval=[0.0, 0.5])
rk.simulate(column, t_eval=0.5)  # E: not a list
rk.simulate(column, t_eval=pd.Series([0.0, 0.5]), theta=np.zeros(5, dtype=np.float32))
rk.simulate(run.scene, friction=None).scene.replace(friction=None, eta=None, keys=None)
rk.Column.prisms(2, width=0.8, height=3.0, gravity=3.7, depth=1.0)
rk.Column.drums(3, half_widht=0.4, height=5.0)  # E: misspelt
rk.Column.cut(3, half_width=0.4, heigth=5.0)  # E: misspelt
rk.Block(half_width=0.4, heigth=5.0)  # E: misspelt
assert_type(rk.Ida(column, rk.synthetic(range(2)), "PGV", [0.1]).simulate(0), rk.Run)
rk.sweep(run.scene, {"eta": [0.9]}, table="polars")  # E: neither pandas nor pyarrow
"""


def test_users_are_checked(tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    file.write_text(PROGRAM)
    # With the cache of the working directory: CI has checked the package there just before.
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", str(file)], capture_output=True, text=True)
    wrong = {number for number, line in enumerate(PROGRAM.splitlines(), start=1) if "# E" in line}
    told = {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line}
    assert told == wrong, done.stdout


MODULES = ["rocking", *(f"rocking.{module.name}" for module in pkgutil.iter_modules(rk.__path__) if module.name not in ("_rocking", "__main__"))]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of_docstrings_hold(name: str) -> None:
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


def test_what_is_public_has_a_docstring() -> None:
    for name in rk.__all__:
        thing = getattr(rk, name)
        if callable(thing):
            assert thing.__doc__, name
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, (property, classmethod))):
                    assert getattr(thing, member).__doc__ or value.__doc__, f"{name}.{member}"
