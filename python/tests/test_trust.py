"""How far runs are determined: what Python says is what the command line says."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import rocking as rk
from beside import ticks_during

# Slender drums in long harmonic motion: chaotic after some ten seconds.
DRUMS = rk.Scene(
    rk.Column.drums(3, half_width=0.02, half_height=1.0),
    rk.pulse("harmonic", amplitude=0.37, omega=12.566, duration=20.0),
    law="plastic",
    t_end=40,
)
BLOCK = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9, t_end=10)


@pytest.mark.parametrize(("scene", "determined"), [(DRUMS, False), (BLOCK, True)], ids=["drums", "block"])
def test_trust_is_that_of_the_command_line(scene: rk.Scene, determined: bool, command, tmp_path: Path) -> None:
    scene.save(tmp_path / "scene.toml")
    printed = command("run", tmp_path / "scene.toml", "--out", tmp_path / "command")
    run = rk.simulate(rk.Scene.load(tmp_path / "scene.toml"), trust=True)
    summary = json.loads((tmp_path / "command" / "summary.json").read_text())
    assert run.summary["trust"] == summary["trust"] and run.warnings[: len(summary["warnings"])] == summary["warnings"]
    trust = run.trust
    assert trust is not None and trust.determined == determined and len(trust.companions) == 9
    for name, value in summary["trust"].items():
        assert getattr(trust, name) == (tuple(value) if name == "companions" else value), name
    assert f"trust: {trust.sentence}\n" in printed and trust.sentence in repr(run) and trust.sentence in run._repr_html_().replace("&lt;", "<")
    lead = "not determined; this run "
    assert (lead in printed) == (lead in repr(run)) == (lead in run._repr_html_()) == (not determined)
    assert [warning for warning in run.warnings if "not determined" in warning] == ([] if determined else [f"the verdict is not determined: {trust.sentence}"])
    # The folder and the page of the run.
    run.write(tmp_path / "python")
    names = sorted(file.name for file in (tmp_path / "command").iterdir())
    assert sorted(file.name for file in (tmp_path / "python").iterdir()) == names and ("companions.csv" in names) == (not determined)
    for name in names:
        if name != "summary.json":
            assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "command" / name).read_bytes()
    command("report", tmp_path / "python", "--out", tmp_path / "command.html")
    run.report(tmp_path / "python.html")
    page = (tmp_path / "python.html").read_text()
    assert page == (tmp_path / "command.html").read_text() and ("not determined</strong>" in page) == (not determined)
    # A run written over another without companions leaves nothing of them behind.
    rk.simulate(BLOCK).write(tmp_path / "python")
    assert not (tmp_path / "python" / "companions.csv").exists()


@pytest.mark.parametrize("scene", [DRUMS, BLOCK], ids=["drums", "block"])
def test_trust_is_pickled_and_the_run_is_the_same(scene: rk.Scene, tmp_path: Path) -> None:
    alone, run = rk.simulate(scene), rk.simulate(scene, trust=True)
    assert alone.trust is None and alone.summary["trust"] is None and "trust" not in repr(alone) and "determined" not in repr(alone)
    assert run == alone and np.array_equal(run.theta, alone.theta)
    again = pickle.loads(pickle.dumps(run))
    assert again.trust == run.trust and again.summary == run.summary and again.warnings == run.warnings and repr(again) == repr(run)
    for name, one in (("one", run), ("other", again)):
        one.write(tmp_path / name)
    for file in (tmp_path / "one").iterdir():
        assert (tmp_path / "other" / file.name).read_bytes() == file.read_bytes()
    assert pickle.loads(pickle.dumps(alone)).trust is None
    assert rk.trust(scene) == run.trust and pickle.loads(pickle.dumps(run.trust)) == run.trust
    with pytest.raises(AttributeError):
        run.trust.determined = True  # type: ignore[misc, union-attr]


def test_trust_is_of_a_whole_run() -> None:
    for wanted in ("outcome", "overturns"):
        with pytest.raises(ValueError, match="trust is of a whole run"):
            rk.simulate(BLOCK, wanted=wanted, trust=True)
    found = rk.trust(rk.Column.prisms(1, half_width=0.4, half_height=1.56), theta=[0.1], t_end=2)
    assert found.determined and found.fold is None and "not determined" in str(rk.trust(DRUMS))


def test_the_lock_is_released_while_companions_run() -> None:
    scene = BLOCK.replace(method="rk4", step=1e-5)
    assert ticks_during(lambda: rk.trust(scene)) > 20


def test_results_do_not_depend_on_threads() -> None:
    study = rk.ida(BLOCK, rk.synthetic(range(12), duration=6.0), "pgv", [0.2, 0.4, 0.8], trust=False)
    run, alone = rk.simulate(DRUMS, trust=True, threads=1), rk.simulate(DRUMS, trust=True)
    assert run == alone and run.trust == alone.trust == rk.trust(DRUMS, threads=3)
    assert study.fragility(threads=1).to_dict() == study.fragility().to_dict()
    # The pool of threads refuses so many: the number reaches it.
    for compute in (
        lambda: rk.simulate(BLOCK, trust=True, threads=2000),
        lambda: rk.trust(BLOCK, threads=2000),
        lambda: study.fragility(threads=2000),
    ):
        with pytest.raises(ValueError, match="threads = 2000 is out of range"):
            compute()
