"""Sweeps, incremental dynamic analyses and fragilities have the values of the command line's tables."""

from __future__ import annotations

import pickle
import sys
import warnings
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import rocking as rk
from tables import as_read, read

COLUMN = rk.Column.prisms(1, half_width=0.4, half_height=1.56)
SCENE = rk.Scene(COLUMN, rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9, t_end=20, rtol=1e-6)


@pytest.mark.parametrize("ask", ["outcome", "overturns", "peaks", "validity", "trust"])
def test_a_sweep_has_the_table_of_the_command_line(ask: str, command, scenes: Path, tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    base = (scenes / "sweeps" / "column.toml").read_text()
    (tmp_path / "column.toml").write_text(base)
    axes = 'blocks = [1, 2, 500]\nmethod = ["auto", "dop853"]\nomega_p = { from = 1, to = 8, steps = 4 }\namplitude_uplift = { from = 0.5, to = 12, steps = 5, scale = "log" }\n'
    file.write_text(f'scene = "column.toml"\nask = "{ask}"\n[axes]\n{axes}')
    command("sweep", file, "--out", tmp_path / "table.csv", "--quiet")
    expected = read(tmp_path / "table.csv")
    made = rk.sweep(
        rk.Scene.load(tmp_path / "column.toml"),
        {
            "blocks": [1, 2, 500],
            "method": ["auto", "dop853"],
            "omega_p": np.linspace(1, 8, 4),
            "amplitude_uplift": {"from": 0.5, "to": 12, "steps": 5, "scale": "log"},
        },
        ask=ask,
    )
    assert list(made.columns) == list(expected.columns)
    pd.testing.assert_frame_equal(as_read(made), expected, check_exact=True, check_dtype=False)
    loaded = rk.Sweep.load(file)
    pd.testing.assert_frame_equal(loaded.table(), made)
    pd.testing.assert_frame_equal(pd.concat([loaded.table(0, 7), loaded.table(7, threads=1)]), made)
    assert (made.outcome == "error").sum() == 40 and made.error.notna().sum() == 40


@pytest.mark.parametrize("method", ["plain", "latin-hypercube", "sobol"])
def test_a_sampled_sweep_has_the_table_of_the_command_line(method: str, command, scenes: Path, tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    (tmp_path / "column.toml").write_text((scenes / "sweeps" / "column.toml").read_text())
    correlated = '[{ axes = ["amplitude_uplift", "eta"], value = 0.5 }]'
    sampling = f'[sampling]\nsamples = 64\nmethod = "{method}"\nseed = 7\ncorrelations = {correlated}\n'
    axes = "blocks = [1, 2]\namplitude_uplift = { lognormal = [4.0, 0.4] }\neta = { normal = [0.88, 0.1], max = 1.0 }\nmethod = { discrete = ['auto', 'dop853'] }\n"
    file.write_text(f'scene = "column.toml"\n{sampling}[axes]\n{axes}')
    command("sweep", file, "--out", tmp_path / "table.csv", "--quiet")
    expected = read(tmp_path / "table.csv")
    sweep = rk.Sweep(
        rk.Scene.load(tmp_path / "column.toml"),
        {
            "blocks": [1, 2],
            "amplitude_uplift": {"lognormal": [4.0, 0.4]},
            "eta": {"normal": [0.88, 0.1], "max": 1.0},
            "method": {"discrete": ["auto", "dop853"]},
        },
        sampling={"samples": 64, "method": method, "seed": 7, "correlations": [{"axes": ["amplitude_uplift", "eta"], "value": 0.5}]},
    )
    made = sweep.table()
    assert len(made) == 128 and made["restitution.eta"].max() <= 1 and made["restitution.eta"].nunique() > 30
    pd.testing.assert_frame_equal(as_read(made), expected, check_exact=True, check_dtype=False)
    pd.testing.assert_frame_equal(pd.concat([sweep.table(0, 50), pickle.loads(pickle.dumps(sweep)).table(50)]), made)


def without_blanks(table: pd.DataFrame) -> list[list[object]]:
    """Columns as lists, blanks as None."""
    return [[None if pd.isna(value) else value for value in table[name].tolist()] for name in table.columns]


@pytest.mark.parametrize("ask", ["outcome", "peaks", "validity", "trust"])
def test_tables_of_arrow_have_the_values_of_pandas(ask: str) -> None:
    pa = pytest.importorskip("pyarrow")
    axes = {"amplitude_uplift": [0.5, 2.0, 9.0], "method": ["auto", "dop853"], "eta": [0.9, 1.5]}
    with pytest.raises(rk.SceneError):
        SCENE.replace(eta=1.5)
    sweep = rk.Sweep(SCENE, axes, ask=ask)
    table, made = sweep.to_arrow(), sweep.table()
    assert isinstance(table, pa.Table) and table.column_names == list(made.columns) and table.num_rows == len(sweep) == 12
    assert list(table.to_pydict().values()) == without_blanks(made)
    # Points that are refused have blanks, and the reason.
    assert table["error"].null_count == 6 and table["outcome"].to_pylist().count("error") == 6
    kinds = {"index": pa.int64(), "excitation.horizontal.amplitude_uplift": pa.float64(), "outcome": pa.dictionary(pa.int32(), pa.string())}
    assert {name: table.schema.field(name).type for name in kinds} == kinds
    # Types do not depend on the rows, and parts make the whole.
    assert sweep.to_arrow(0, 0).schema == table.schema and sweep.to_arrow(0, 0).num_rows == 0
    assert pa.concat_tables([sweep.to_arrow(0, 5), sweep.to_arrow(5, threads=1)]).to_pydict() == table.to_pydict()
    assert rk.sweep(SCENE, axes, ask=ask, table="pyarrow").equals(table)
    with pytest.raises(ValueError, match="give pandas or pyarrow"):
        rk.sweep(SCENE, axes, table="polars")  # type: ignore[call-overload]


def test_a_study_is_a_table_of_arrow() -> None:
    pa = pytest.importorskip("pyarrow")
    ida = rk.Ida(COLUMN, rk.synthetic(range(2)), "PGV", [0.1, 2.0], eta=0.9)
    table = ida.to_arrow()
    assert isinstance(table, pa.Table) and list(table.to_pydict().values()) == without_blanks(ida.table())
    pd.testing.assert_frame_equal(rk.Study(table.to_pandas(), ida.measure).stripes, ida.run().stripes)


def test_without_pyarrow_the_way_out_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ModuleNotFoundError, match="pip install pyarrow"):
        rk.sweep(SCENE, {"amplitude_uplift": [2.0]}, table="pyarrow")


def test_a_sweep_with_friction_asks_for_slides() -> None:
    scene = SCENE.replace(friction=0.4)
    table = rk.sweep(scene, {"friction": [0.2, 0.9], "amplitude_uplift": [2.0, 4.0]}, ask="slides")
    assert {"peak_1", "last_mode", "residual_slide_1"} < set(table.columns) and abs(table.residual_slide_1[0]) > 0
    with pytest.raises(rk.SceneError, match="without friction"):
        rk.sweep(SCENE, {"amplitude_uplift": [2.0]}, ask="slides")


def test_a_point_of_a_sweep_is_a_scene() -> None:
    sweep = rk.Sweep(SCENE, {"amplitude_uplift": [1.5, 6.0], "omega_p": [3.0, 4.0, 5.0]}, ask="peaks")
    table, run = sweep.table(), rk.simulate(sweep.scene(1))
    assert len(sweep) == 6 and table["excitation.horizontal.omega_p"].tolist() == [3.0, 4.0, 5.0] * 2
    assert table.peak_1[1] == run.peak_theta[0] / run.alpha[0] and table.impacts[1] == run.impacts
    assert sweep.axes == {"excitation.horizontal.amplitude_uplift": 2, "excitation.horizontal.omega_p": 3}
    assert [sweep.shard(part, 4) for part in (1, 2, 3, 4)] == [range(0, 1), range(1, 3), range(3, 4), range(4, 6)]
    pd.testing.assert_frame_equal(pickle.loads(pickle.dumps(sweep)).table(), table)
    assert len(run.t) > 10 and run.force is None and len(rk.simulate(sweep.scene(1), rows=False).t) == 0
    with pytest.raises(IndexError):
        sweep.table(0, 7)


def test_a_sweep_of_a_file_stays_what_it_was_when_it_was_read(tmp_path: Path) -> None:
    SCENE.save(tmp_path / "base.toml")
    text = 'scene = "base.toml"\nask = "peaks"\n[axes]\nomega_p = [2.0, 4.0]\namplitude_uplift = { from = 1.0, to = 8.0, steps = 5 }\n'
    (tmp_path / "sweep.toml").write_text(text)
    sweep = rk.Sweep.load(tmp_path / "sweep.toml")
    pickled = pickle.dumps(sweep)
    (tmp_path / "sweep.toml").write_text('scene = "base.toml"\n[axes]\nomega_p = [9.0]\n')
    (tmp_path / "base.toml").unlink()
    pd.testing.assert_frame_equal(pickle.loads(pickled).table(), sweep.table())


def test_runs_that_are_cut_are_told() -> None:
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.3, half_height=1.2), {"kind": "synthetic", "pgv": 0.5, "seed": 1}, eta=0.9, t_end=5)
    study = rk.Study(rk.sweep(scene, {"seed": list(range(4)), "pgv": [0.4, 0.8, 1.6]}, ask="peaks"))
    count = int(study.table.truncated.sum())
    assert count > 6
    with pytest.warns(UserWarning, match=f"^{count} run.s. end before their ground motion") as told:
        study.fragility(replicates=0)
    assert [warning.filename for warning in told] == [__file__]
    with pytest.warns(UserWarning) as told:
        study.plot()
    assert [warning.filename for warning in told] == [__file__]


def test_runs_of_a_study_have_the_rows_that_the_scene_asks_for() -> None:
    column, record = rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.synthetic([1])
    first = [rk.Ida(rk.Scene(column, eta=0.9, **rows), record, "pga_g", [0.3]).simulate(0).t for rows in ({}, {"output_dt": 0.1}, {"t_eval": [1.0, 2.0]})]
    assert first[0][1] < 0.02 and first[1][1] == 0.1 and first[2].tolist() == [1.0, 2.0]
    with pytest.raises(TypeError, match="horizontal is of int; give a Record"):
        rk.StudyRecord("a", 3)  # type: ignore[arg-type]
    table = pd.DataFrame([[0.1, 0.2, "rocks"]], columns=["pgv", "pgv", "outcome"])
    with pytest.raises(rk.StudyError, match="several columns `pgv`"):
        rk.Study(table, "pgv")


def test_a_record_in_memory_is_swept() -> None:
    record = rk.Record.synthetic(1, duration=8.0)
    scene = rk.Scene(COLUMN, record, eta=0.9, t_end=12)
    table = rk.sweep(scene, {"excitation.horizontal.pgv": [0.2, 2.0]}, ask="peaks")
    expected = [rk.simulate(scene.replace(horizontal=record.scaled(pgv=size))).peak_theta[0] / COLUMN.alpha for size in (0.2, 2.0)]
    assert table.peak_1.tolist() == expected


@pytest.mark.parametrize(
    ("axes", "options", "text"),
    [
        ({"amplitude_gg": [1.0]}, {}, "amplitude_gg"),
        ({"amplitude_uplift": []}, {}, "the axis has no values"),
        ({}, {}, "axes"),
        ({"amplitude_uplift": [1.0]}, {"ask": "everything"}, "there is no question"),
        ({"amplitude_uplift": {"lognormal": [4.0, 0.4]}}, {}, "sampling"),
        ({"half_width": {"normal": [0.4, 0.5]}}, {"sampling": {"samples": 64}}, "half_width"),
        ({"amplitude_uplift": [1.0]}, {"sampling": {"samples": 64}}, "sampling"),
        ({"amplitude_uplift": [1.0], "omega_p": [1.0, 2.0]}, {"combine": "paired"}, "equally long"),
    ],
)
def test_bad_sweeps_are_refused(axes, options, text: str) -> None:
    with pytest.raises(rk.SceneError, match=text) as caught:
        rk.sweep(SCENE, axes, **options)
    assert caught.value.file == "<sweep>"


@pytest.fixture(scope="module")
def statue(command, scenes: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the study of the statue, made by the command line."""
    folder = tmp_path_factory.mktemp("statue")
    command("ida", scenes / "studies" / "statue-ida.toml", "--out", folder / "ida.csv", "--quiet")
    return folder


@pytest.fixture(scope="module")
def study(scenes: Path) -> rk.Study:
    scene = rk.Scene.load(scenes / "studies" / "statue.toml")
    records = rk.synthetic(range(1, 7), frequency=1.5, duration=20.0)
    return rk.ida(scene, records, "PGV", np.round(np.linspace(0.1, 1.5, 15), 12))


def test_a_study_has_the_tables_of_the_command_line(
    statue: Path, study: rk.Study, scenes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = read(statue / "ida.csv")
    pd.testing.assert_frame_equal(as_read(study.table), expected, check_exact=True, check_dtype=False)
    stripes = read(statue / "ida-stripes.csv")
    pd.testing.assert_frame_equal(as_read(study.stripes), stripes, check_exact=True, check_dtype=False)
    file = scenes / "studies" / "statue-ida.toml"
    pd.testing.assert_frame_equal(rk.Study.load(file).table, study.table)
    # The study of a file in parts, as a cluster runs it.
    plan = rk.Ida.load(file)
    monkeypatch.chdir(tmp_path)
    for own in (plan, pickle.loads(pickle.dumps(plan))):
        assert len(own.records) * len(own.levels) == len(own) == len(study.table) and own.scene.title == rk.Scene.load(scenes / "studies" / "statue.toml").title
        pd.testing.assert_frame_equal(own.table(10, 14), study.table.iloc[10:14])


def test_fragilities_are_those_of_the_command_line(statue: Path, study: rk.Study) -> None:
    curves = read(statue / "ida-fragility.csv").set_index("state")
    shares = read(statue / "ida-shares.csv")
    for state in ("uplift", "peak > 0.15", "peak > 0.35", "overturned"):
        found, row = study.fragility(state, seed=1), curves.loc[state]
        assert (found.fit, found.median, found.dispersion) == (row.fit, row["median"], row.dispersion)
        assert found.bands["median"] == [row.median_low, row.median_high] and found.goodness["pseudo_r2"] == row.pseudo_r2
        assert "; ".join(found.statements) == row.statement
        own = shares[shares.state == state]
        assert found.counts.share.tolist() == own.share.tolist()
        assert found.probability(own.pgv).tolist() == pytest.approx(own.curve.tolist(), rel=1e-14)
    # A table that was read back, and one without bands.
    again = rk.Study(pd.read_csv(statue / "ida.csv"), "pgv").fragility("overturned", replicates=0)
    assert again.median == curves.loc["overturned", "median"] and again.bands is None


def test_figures_of_studies(study: rk.Study) -> None:
    ax = study.plot()
    assert len(ax.lines) == 6 + 3 + 1 and ax.get_ylabel() == "PGV [m/s]"
    ax = study.fragility("overturned", replicates=100).plot()
    assert len(ax.lines) == 2 and len(ax.collections) == 1
    same = study.fragility("uplift", replicates=0).plot(ax, label="first motion")
    assert same is ax and "first motion" in ax.get_legend_handles_labels()[1][1]
    none = study.fragility("peak > 100000")
    lost = int(study.table.outcome.isin(["overturns", "collapses"]).sum())
    assert none.by_loss == lost > 0 and study.fragility("overturned", replicates=0).by_loss == 0
    assert "Study of 90 runs" in repr(study) and "lognormal" in repr(none)


def test_states_without_a_curve_say_why() -> None:
    study = rk.ida(COLUMN, rk.synthetic(range(3), duration=6.0), "pga_uplift", [0.2, 0.4])
    found = study.fragility("uplift")
    assert found.fit == "never" and found.median is None and "go higher" in found.statements[0]
    assert len(found.plot().lines) == 1
    with pytest.raises(rk.StudyError, match="go higher"):
        found.probability([1.0])
    one = rk.ida(COLUMN, [rk.Record.synthetic(0)], "pga_uplift", [0.2, 40.0])
    assert one.fragility("uplift").fit == "one-record"


def test_bad_studies_are_refused() -> None:
    records = rk.synthetic(range(2), duration=6.0)
    for arguments, text in (
        (([], "pgv", [1.0]), "no record"),
        ((records, "pgv", []), "no level"),
        ((records, "pgv", [1.0, -1.0]), "above zero"),
        ((records, "pgx", [1.0]), "no measure `pgx`"),
        ((records, "sa", [1.0]), "sa_period"),
    ):
        with pytest.raises(rk.StudyError, match=text):
            rk.ida(COLUMN, *arguments)
    with pytest.raises(TypeError, match="'peer' is a path"):
        rk.ida(COLUMN, "peer", "pgv", [1.0])
    study = rk.ida(COLUMN, records, "sa_g", [0.1, 1.0], sa_period=0.5)
    assert rk.Ida(COLUMN, records, "pgv", [0.1, 1.0]).simulate(1).t_final > 0.0
    assert study.measure == "sa_g(0.5)" and study.label.startswith("Sa(0.5 s")
    with pytest.raises(rk.StudyError, match="no state `falling`"):
        study.fragility("falling")
    with pytest.raises(rk.StudyError, match="scene with friction with ask = \"slides\""):
        study.fragility("slide > 0.1")
    with pytest.raises(ValueError, match="confidence"):
        study.fragility(confidence=2.0)
    with pytest.raises(rk.StudyError, match="no column has the name of a measure"):
        rk.Study(study.table.drop(columns="sa_g(0.5)"))
    with pytest.raises(rk.StudyError, match="ask = \"peaks\""):
        rk.Study(rk.sweep(rk.Scene(COLUMN, rk.Record.synthetic(1)), {"pgv": [0.1, 0.2]})).fragility("peak > 0.1")


def test_a_sweep_of_one_ground_motion_is_of_one_record() -> None:
    scene = rk.Scene(COLUMN, rk.Record.synthetic(1))
    one = rk.sweep(scene, {"pgv": [0.05, 0.1, 0.3, 0.5, 0.7, 0.9]}, ask="peaks")
    found = rk.Study(one).fragility("peak > 0.3", replicates=0)
    assert (found.fit, found.records) == ("one-record", 1)
    # A second axis of the ground motion makes other motions of it.
    several = rk.sweep(scene, {"start": [0.0, 0.1, 0.2], "pgv": [0.3, 0.5, 0.7]}, ask="peaks")
    with pytest.warns(UserWarning, match="values of `excitation.horizontal.start`"):
        assert rk.Study(several).fragility("peak > 0.3", replicates=0).records == 9


def test_a_study_without_companions_has_the_same_runs() -> None:
    records = rk.synthetic(range(2), duration=6.0)
    with_trust, without = (rk.ida(COLUMN, records, "pgv", [0.1, 0.2], trust=trust).table for trust in (True, False))
    assert (with_trust.outcome != "not-determined").all()
    assert (with_trust.trust == "determined").all() and "trust" not in without
    pd.testing.assert_frame_equal(with_trust.drop(columns="trust"), without)


def test_a_study_is_pickled_and_runs_in_ranges() -> None:
    plan = rk.Ida(COLUMN, rk.synthetic(range(3), duration=6.0), "pgv", [0.1, 0.4, 0.9], eta=0.9)
    table = plan.run().table
    again = pickle.loads(pickle.dumps(plan))
    pd.testing.assert_frame_equal(pd.concat([again.table(0, 4), again.table(4, threads=1)]), table)
    parts = [plan.shard(number, 2) for number in (1, 2)]
    assert parts == [range(0, 4), range(4, 9)]
    pd.testing.assert_frame_equal(pd.concat([plan.table(part.start, part.stop) for part in parts]), table)
    assert len(plan) == 9 and plan.levels.tolist() == [0.1, 0.4, 0.9] and "3 record(s)" in repr(plan)


def test_a_block_that_the_column_has_not_is_refused() -> None:
    column = rk.Column.prisms(1, half_width=0.2, half_height=0.8)
    study = rk.ida(column, rk.synthetic(range(3), duration=6.0), "pgv", [0.3, 5.0])
    with pytest.raises(rk.StudyError, match=r"`peak_2 > 0.3` needs the column peak_2, and the columns of the table have 1 block"):
        study.fragility("peak_2 > 0.3")
    assert study.fragility("peak_1 > 0.3").statements


def test_a_figure_without_a_curve_says_so() -> None:
    study = rk.ida(rk.Column.prisms(1, half_width=0.2, half_height=0.8), rk.synthetic(range(3), duration=6.0), "pgv", [0.01, 0.02])
    legend = study.fragility("overturned").plot().get_legend()
    assert legend is not None and [text.get_text() for text in legend.get_texts()] == ["overturned: no curve"]


def test_the_figure_of_a_study_leaves_runs_out_that_are_not_determined() -> None:
    levels = [0.1, 0.2, 0.3, 0.4]
    outcomes = ["rocks", "not-determined", "undetermined", "overturns"]
    table = pd.DataFrame({"record": "a", "pga": levels, "outcome": outcomes, "peak_1": [0.4, 8.6, 7.5, 9.0]})
    axes = rk.Study(table, measure="pga").plot()
    drawn = axes.lines[0].get_xdata()
    assert axes.get_xlim()[1] < 1.2 and np.isnan(drawn[1:3]).all() and drawn[0] == 0.4 and np.isfinite(drawn[3])
    plt.close("all")


def test_a_record_in_memory_decides_the_end_of_the_run():
    """As a record file does: the run ended as if there were no ground motion."""
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.56)
    record = rk.Record.synthetic(1, duration=40)
    assert rk.Scene(column, record).t_end == rk.Scene(column, rk.total(record)).t_end >= 50
    assert rk.Scene(column, rk.pulse("sine-pulse", amplitude=1, omega=5), vertical=record).t_end >= 50
    assert rk.Scene(column, record, t_end=3).t_end == 3


def test_a_study_of_the_scene_of_a_point_runs():
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.3, half_height=1.2), rk.pulse("ricker", amplitude=1.0, omega=2.0))
    point = rk.Sweep(scene, {"eta": [0.8, 0.9]}).scene(1)
    study = rk.Ida(point, [rk.Record.synthetic(1, duration=4.0).named("a")], "pgv", [0.5])
    assert study.simulate(0).outcome == study.table()["outcome"][0]


def test_the_scene_of_a_point_is_run_as_it_is():
    """Its keys were those of the base scene: whatever was replaced in it ran another scene."""
    pulse = rk.pulse("sine-pulse", amplitude_uplift=3, omega_p=5)
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.56), pulse, eta=0.9, t_end=10)
    point = rk.Sweep(scene, {"amplitude_uplift": [0.5, 8.0]}).scene(0)
    assert rk.simulate(point).outcome == "no-uplift"
    for use in (lambda: point.toml, lambda: point.keys, lambda: point.replace(rtol=1e-8), lambda: rk.simulate(point, rtol=1e-8), lambda: point.column):
        with pytest.raises(ValueError, match="point of a sweep"):
            use()


def test_columns_of_blocks_go_by_their_numbers():
    table = pd.DataFrame({"record": np.repeat(list("abcdefghij"), 6), "pgv": np.tile([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], 10), "outcome": "rocks"})
    table["peak_2"], table["peak_1"] = table.pgv, 0.0
    study = rk.Study(table)
    assert study.fragility("peak_2 > 0.33", replicates=0).counts.reached.tolist() == [0, 0, 0, 10, 10, 10]
    assert study.fragility("peak_1 > 0.33", replicates=0).counts.reached.tolist() == [0] * 6
    with pytest.raises(rk.StudyError, match="from 1"):
        rk.Study(table.drop(columns="peak_1")).fragility("overturned", replicates=0)
    table.loc[3, "peak_1"] = np.nan
    with pytest.raises(ValueError, match=r"table.iloc\[3\]"):
        rk.Study(table).fragility("overturned", replicates=0)


def test_rows_of_other_axes_make_one_curve_with_a_warning():
    table = pd.DataFrame({"alpha": [0.1, 0.2] * 6, "record": list("abcdef") * 2, "pgv": np.linspace(0.1, 1.2, 12), "outcome": ["rocks"] * 6 + ["overturns"] * 6})
    with pytest.warns(UserWarning, match="2 values of `alpha`"):
        rk.Study(table).fragility("overturned", replicates=0)


def test_arguments_that_a_study_does_not_use_are_refused():
    column = rk.Column.prisms(1, half_width=0.3, half_height=1.2)
    for argument in ({"vertical": rk.pulse("ricker", amplitude=1, omega=5)}, {"t_end": 20.0}):
        with pytest.raises(TypeError, match="a study has no argument"):
            rk.ida(column, rk.synthetic(range(2)), "PGV", [0.1, 0.2], **argument)
    for keys in ({"solver.t_end": 20.0}, {"solver": {"t_end": 20.0}}):
        with pytest.raises(TypeError, match="a study has no key `solver.t_end`"):
            rk.ida(column, rk.synthetic(range(2)), "PGV", [0.1, 0.2], keys=keys)


def test_a_study_follows_its_table():
    """Curves were those of the table as it was when the first was made."""
    table = pd.DataFrame({"record": np.repeat(list("abcdef"), 2), "pgv": [0.1, 0.2] * 6, "outcome": ["rocks", "overturns"] * 6})
    study = rk.Study(table.copy())
    assert study.fragility(replicates=0).counts.reached.tolist() == [0, 6] and study.stripes.overturns.tolist() == [0, 6]
    study.table = table[table.record < "d"]
    assert study.fragility(replicates=0).counts.reached.tolist() == [0, 3] and study.stripes.overturns.tolist() == [0, 3]


def test_a_loaded_study_has_the_fragility_of_its_file(scenes: Path, tmp_path: Path):
    text = (scenes / "studies" / "statue-ida.toml").read_text().replace("statue.toml", str(scenes.resolve() / "studies" / "statue.toml"))
    head = text.split("[fragility]")[0]
    file = tmp_path / "ida.toml"
    file.write_text(head + '[fragility]\nstates = ["peak > 0.2", "overturned"]\nreplicates = 40\nconfidence = 0.5\nseed = 3\nlayout = "cloud"\n')
    study = rk.Study.load(file)
    assert study.states == ["peak > 0.2", "overturned"]
    given = {"replicates": 40, "confidence": 0.5, "seed": 3, "layout": "cloud"}
    own, plain = study.fragility("peak > 0.2"), rk.Study(study.table)
    assert own.to_dict() == plain.fragility("peak > 0.2", **given).to_dict() != plain.fragility("peak > 0.2").to_dict()
    assert study.fragility("peak > 0.2", replicates=0).bands is None and study.fragility("peak > 0.2", replicates=0).layout == "cloud"


def test_words_that_a_table_of_runs_has_not_are_refused():
    table = pd.DataFrame({"record": np.repeat(list("abcdef"), 2), "pgv": [0.1, 0.2] * 6, "outcome": ["rocks", "overturns"] * 6, "trust": "determined"})
    assert rk.Study(table).fragility(replicates=0).counts.undecided.tolist() == [0, 0]
    table.loc[[1, 3], "trust"] = ["not-determined", None]
    assert rk.Study(table).fragility(replicates=0).counts.undecided.tolist() == [0, 1]
    with pytest.raises(ValueError, match=r"table.iloc\[0\]: column `trust`: `True` is none of determined, likely, not-determined"):
        rk.Study(table.assign(trust=True)).fragility(replicates=0)
    with pytest.raises(rk.StudyError, match=r"table.iloc\[0\]: column `outcome`: `fell` is no outcome"):
        rk.Study(table.assign(outcome="fell")).fragility(replicates=0)


def test_numbers_beyond_any_use_are_refused():
    study = rk.Study(pd.DataFrame({"record": list("abcdef"), "pgv": 0.1, "outcome": "rocks"}))
    with pytest.raises(ValueError, match="replicates"):
        study.fragility(replicates=10_000_000)
    with pytest.raises(ValueError, match="threads"):
        rk.sweep(SCENE, {"amplitude_uplift": [2.0]}, threads=10_000)
    for gravity in (0.0, -9.81, float("nan")):
        with pytest.raises(ValueError, match="gravity"):
            rk.Record.synthetic(1).scaled(pga_g=0.1, gravity=gravity)


def test_fractiles_need_the_peaks_of_all_runs():
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.3, half_height=1.5), {"kind": "synthetic", "duration": 6.0, "pgv": 0.3}, eta=0.85)
    axes = {"seed": [1, 2, 3], "pgv": [0.3, 0.6]}
    known = rk.Study(rk.sweep(scene, axes, ask="peaks")).stripes
    assert (known.peak_50 > 0.0).all()
    table = rk.sweep(scene, axes, ask="outcome")
    assert (table.outcome == "rocks").all()
    assert rk.Study(table).stripes[["peak_16", "peak_50", "peak_84"]].isna().all(axis=None)
    none = rk.Study(table[table.outcome == "overturns"])
    assert len(none.stripes) == 0 and none.fragility().fit == "no-runs"


def test_the_scene_of_a_point_runs_to_its_end():
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.3, half_height=1.5), {"kind": "synthetic", "duration": 6.0, "pgv": 0.3}, eta=0.85)
    sweep = rk.Sweep(scene, {"seed": [1, 2]}, ask="outcome")
    whole = rk.simulate(sweep.scene(1))
    assert whole.status == "at-rest" and len(whole.peak_theta) == 1


def test_records_of_a_study_are_records():
    with pytest.raises(TypeError, match="record 2 is a ndarray; give a Record"):
        rk.Records([rk.Record([0.0, 1.0], dt=0.01), np.array([0.0, 1.0])])


def test_runs_stand_once_and_have_outcomes() -> None:
    plan = rk.Ida(rk.Column.prisms(1, half_width=0.3, half_height=1.4), rk.synthetic(range(4), frequency=1.5), "PGV", [0.2, 0.9], eta=0.9, trust=False)
    table = plan.table()
    with pytest.raises(rk.StudyError, match="run 3 stands in the table twice; give each run once"):
        rk.Study(pd.concat([plan.table(0, 5), plan.table(3, 8)]))
    # The same numbers of other records are other runs.
    pooled = pd.concat([table, table.assign(record=table.record.astype(str) + "'")])
    assert len(rk.Study(pooled).stripes) == 2
    with pytest.raises(rk.StudyError, match=r"table.iloc\[2\] has no outcome; give the table as it was made"):
        rk.Study(table.assign(outcome=table.outcome.astype(object).where(table.index != 2)))
    with pytest.raises(ValueError, match=r"3 replicate\(s\) have no bands of 90 %; give 0 for no bands, or at least 20"):
        rk.Study(table).fragility(replicates=3)


def test_values_of_other_types_are_named() -> None:
    column = rk.Column.prisms(1, half_width=0.3, half_height=1.4)
    table = pd.DataFrame({"record": ["a"], "pgv": [0.2], "outcome": ["rocks"], "peak_1": [0.1]})
    record = rk.Record([0.0, 1.0, 0.0], 0.1)
    refused: list[tuple[Any, str]] = [
        (lambda: rk.sweep(column, {"eta": [0.9]}), "scene is of Column; give a Scene"),
        (lambda: rk.Study(table).fragility(3), "state is of int; give the text of one limit state"),
        (lambda: rk.Study({}), "table is of dict; give a DataFrame of runs"),
        (lambda: record.scaled(pga_uplift=2, column=3), "column is of int; give a Column"),
        (lambda: rk.Scene(column, keys=3), "keys are of int; give a dictionary"),
        (lambda: rk.Scene.from_dict(3), "keys are of int; give a dictionary"),
        (lambda: rk.Record(np.array(["2020", "2021"], dtype="M8[s]"), 0.1), "accel has times; give accelerations"),
    ]
    for call, message in refused:
        with pytest.raises(TypeError, match=message):
            call()
    assert dict(record + rk.pulse("sine-pulse", amplitude=1.0, omega=5.0))["kind"] == "sum"


def test_the_run_of_a_study_is_a_run(tmp_path: Path) -> None:
    """It was the response of the compiled module, without scene, figures and pickle."""
    ida = rk.Ida(COLUMN, rk.synthetic(range(2), duration=6.0), "pgv", [0.1, 0.4], eta=0.9, trust=False)
    run, row = ida.simulate(3), ida.table(3).iloc[0]
    assert isinstance(run, rk.Run) and (run.outcome, run.impacts) == (row.outcome, row.impacts) and len(run.to_pandas()) > 100
    assert pickle.loads(pickle.dumps(run)) == run and run.scene == ida.scene_of(3) != ida.scene_of(2)
    assert rk.simulate(ida.scene_of(3)) == run and len(run.plot()) == 2
    run.report(tmp_path / "run.html")
    for use in (lambda: run.scene.toml, lambda: run.scene.replace(rtol=1e-8)):
        with pytest.raises(ValueError, match="run of a study has no keys"):
            use()


def test_a_sweep_whose_runs_all_fail_warns_with_the_first_reason() -> None:
    """The table of errors came without a word."""
    scene = rk.Scene(COLUMN, rk.pulse("sine-pulse", amplitude=3.0, omega=5.0))
    for table in ("pandas", "pyarrow"):
        with pytest.warns(UserWarning, match=r"all 2 runs failed; the first: .*eta"):
            failed = rk.sweep(scene, {"eta": [-0.5, -0.7]}, table=table)  # type: ignore[call-overload]
        assert len(failed) == 2


def test_whole_numbers_are_named_with_their_range() -> None:
    """They were `OverflowError: can't convert negative int to unsigned`."""
    ida = rk.Ida(COLUMN, rk.synthetic(range(2), duration=6.0), "pgv", [0.1, 0.4], trust=False)
    study, sweep = ida.run(), rk.Sweep(SCENE, {"eta": [0.9]})
    refused: list[tuple[Any, str]] = [
        (lambda: ida.run(threads=-1), "threads = -1"),
        (lambda: ida.table(-1), "start = -1"),
        (lambda: ida.to_arrow(0, -2), "stop = -2"),
        (lambda: ida.simulate(-1), "index = -1"),
        (lambda: sweep.scene(-1), "index = -1"),
        (lambda: sweep.table(threads=-1), "threads = -1"),
        (lambda: study.fragility(replicates=-1), "replicates = -1"),
        (lambda: study.fragility(seed=-1), "seed = -1"),
        (lambda: study.fragility(threads=-1), "threads = -1"),
        (lambda: rk.simulate(SCENE, threads=-1), "threads = -1"),
        (lambda: rk.synthetic([-1]), "seed = -1"),
        (lambda: rk.Record.read("none", skip_rows=-1), "skip_rows = -1"),
    ]
    for call, message in refused:
        with pytest.raises(ValueError, match=f"{message} is out of range; give a whole number from 0 on"):
            call()
    with pytest.raises(TypeError, match="threads is of float; give a whole number"):
        sweep.table(threads=1.5)  # type: ignore[arg-type]
    assert rk.Record.synthetic(2**64 - 1) == rk.Record.synthetic(np.uint64(2**64 - 1))


def test_tables_as_pandas_users_have_them_are_read(recwarn: pytest.WarningsRecorder):
    """Records in the index were no records, and levels of another byte order an error of pandas."""
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    study = rk.ida(column, rk.synthetic(range(10), duration=8), "pgv", np.geomspace(0.4, 4, 12), trust=False)
    own = study.fragility()
    for table in (study.table.set_index("record"), study.table.set_index(["record", "pgv"]), study.table.assign(pgv=study.table.pgv.astype(">f8"))):
        other = rk.Study(table).fragility()
        assert (other.median, other.bands) == (own.median, own.bands)
    with pytest.raises(rk.StudyError, match="no `record`"):
        rk.Study(study.table.assign(record=study.table.record.astype("object").where(study.table.index > 0))).fragility()
    recwarn.clear()
    cloud = pd.DataFrame({"record": [f"r{k}" for k in range(40)], "pga": np.linspace(1, 2, 40), "pgv": np.linspace(0.1, 1.2, 40)})
    cloud["outcome"] = np.where(np.sin(np.arange(40) * 7) + cloud.pgv > 0.8, "overturns", "rocks")
    rk.Study(cloud, "pgv").fragility(replicates=0)
    assert not [warning for warning in recwarn if "make one curve" in str(warning.message)]
    # Runs of a record that differ by more than their level are of several columns: none of them comes back.
    runs = pd.DataFrame({"record": "a", "pgv": [0.1, 0.2, 0.3, 0.4], "size.alpha": 0.2, "outcome": ["rocks", "overturns", "rocks", "rocks"]})
    told = [" ".join(rk.Study(table).fragility(replicates=0).statements) for table in (runs, runs.assign(**{"size.alpha": [0.2, 0.1, 0.3, 0.25]}))]
    assert "do not at a higher level (a)" in told[0]
    assert "(a)" not in told[1] and "are not named, as runs of a record differ" in told[1]


def test_bands_that_are_not_there_are_none():
    column = rk.Column.drums(2, diameter=0.8, height=3.2, density=2500)
    study = rk.ida(column, rk.synthetic(range(2), duration=6), "pgv", np.geomspace(0.2, 3, 10), friction=0.4, trust=False)
    curve = study.fragility(replicates=200)
    assert curve.to_dict()["bands"]["median"] is None and curve.bands is None


def test_a_range_is_an_axis():
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), {"kind": "synthetic", "pgv": 0.5}, eta=0.9)
    assert len(rk.sweep(scene, {"seed": range(5)})) == 5


def without_unit(folder: Path, name: str) -> Path:
    """A record file whose header does not state its unit."""
    samples = " ".join(f"{0.1 * np.sin(0.6 * place) * (1 - place / 399):.6f}" for place in range(400))
    file = folder / name
    file.write_text(f"SOME DATA BASE\nSOMEWHERE\nACCELERATION TIME SERIES\nNPTS= 400, DT= .0100 SEC\n{samples}\n")
    return file


def test_what_is_to_be_known_of_records_is_a_warning_of_studies_and_sweeps(tmp_path: Path) -> None:
    without_unit(tmp_path, "X.AT2")
    record = rk.Record.read(tmp_path / "X.AT2")
    column = rk.Column.prisms(1, half_width=0.3, half_height=1.5)
    for make in (rk.Ida, rk.ida):
        with pytest.warns(UserWarning, match="X.AT2.*unit") as told:
            analysis = make(column, [record], "pgv", [0.3], trust=False)
        assert [warning.filename for warning in told] == [__file__]
    with pytest.warns(UserWarning):
        analysis = rk.Ida(column, [record], "pgv", [0.3], trust=False)
    assert len(analysis.warnings) == 1
    with warnings.catch_warnings():
        # Those who are given the analysis have been told.
        warnings.simplefilter("error")
        assert pickle.loads(pickle.dumps(analysis)).warnings == analysis.warnings
        analysis.run()
    study = tmp_path / "study.toml"
    study.write_text('measure = "pgv"\nlevels = [0.3]\ntrust = false\n[records]\nfiles = ["X.AT2"]\n[scene.column]\nblocks = 1\nhalf_width = 0.3\nhalf_height = 1.5\n')
    with pytest.warns(UserWarning, match="unit"):
        rk.Study.load(study)
    scene = rk.Scene(column, {"kind": "record", "file": str(tmp_path / "X.AT2")})
    with pytest.warns(UserWarning, match="unit"):
        rk.sweep(scene, {"excitation.horizontal.scale": [1.0, 2.0]})
    # A record that begins before the run is cut there.
    with pytest.warns(UserWarning, match="record cut is cut: it begins at t"):
        rk.Ida(column, [rk.Record.synthetic(1, duration=6).starting_at(-3).named("cut")], "pgv", [0.3])


def test_records_of_a_study_do_not_change_and_have_the_names_of_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record = rk.StudyRecord("a", rk.Record.synthetic(1))
    with pytest.raises(AttributeError):
        record.horizontal = rk.Record.synthetic(2)  # type: ignore[misc]
    copy = pickle.loads(pickle.dumps(record))
    assert (copy.name, copy.horizontal, copy.vertical) == (record.name, record.horizontal, None)
    (tmp_path / "d").mkdir()
    for name in ("A_X.csv", "B_X.csv"):
        rk.Record.synthetic(1).to_csv(tmp_path / "d" / name)
    monkeypatch.chdir(tmp_path)
    assert [one.name for one in rk.records("d")] == ["d/A_X.csv", "d/B_X.csv"]


def test_a_study_that_was_read_notices_another_base_scene(tmp_path: Path) -> None:
    """Parts of it would be of two studies."""
    scene, study = tmp_path / "s.toml", tmp_path / "study.toml"
    scene.write_text("[column]\nblocks = 1\nhalf_width = 0.3\nhalf_height = 1.2\n")
    study.write_text('scene = "s.toml"\nmeasure = "pgv"\nlevels = [0.5]\ntrust = false\n[records.synthetic]\nseeds = [1, 2]\n')
    kept = pickle.dumps(rk.Ida.load(study))
    assert len(pickle.loads(kept).table()) == 2
    scene.write_text(scene.read_text().replace("0.3", "0.31"))
    with pytest.raises(rk.StudyError, match=r"s\.toml is another scene than when .*study\.toml was read"):
        pickle.loads(kept)


def test_records_in_g_are_of_the_gravity_that_is_given(tmp_path: Path) -> None:
    (tmp_path / "A_X.csv").write_text("t [s],a [g]\n0,0\n0.1,0.5\n0.2,0\n")
    usual, moon = (rk.records(tmp_path, **given)[0].horizontal for given in ({}, {"gravity": 1.62}))
    assert (usual.accel.max(), moon.accel.max()) == (0.5 * 9.81, 0.5 * 1.62) and moon == rk.Record.read(tmp_path / "A_X.csv", gravity=1.62)
    with pytest.raises(ValueError, match="gravity = -1"):
        rk.records(tmp_path, gravity=-1)


def test_cells_that_are_no_numbers_are_named() -> None:
    table = pd.DataFrame({"record": ["a", "b"], "pgv": [0.1, 0.2], "outcome": ["rocks", "rocks"], "peak_1": [0.1, 0.2]})
    for column, cells, told in [
        ("pgv", ["0.1", "much"], r"iloc\[1\], column `pgv`: 'much' is no number"),
        ("peak_1", [0.1, "high"], r"iloc\[1\], column `peak_1`: 'high' is no number"),
        ("pgv", pd.to_timedelta([1, 2], unit="s"), "column `pgv` has values of timedelta64"),
        ("peak_1", [0.1, 1j], r"iloc\[0\], column `peak_1`: \(0.1\+0j\) is no number|has values of complex"),
        ("peak_1", pd.Series([0.1, 10**400], dtype=object), r"iloc\[1\], column `peak_1`: 1000"),
        ("peak_1", [0.1, -0.2], "column `peak_1`: -0.2 is below zero"),
    ]:
        with pytest.raises(rk.StudyError, match=told):
            rk.Study(table.assign(**{column: cells}), "pgv").fragility("peak > 0.15", replicates=0)
    # Names of columns that are numbers are those of columns of text.
    study = rk.Study(table.assign(**{"0": 1.0}).rename(columns={"0": 0}), "pgv")
    assert study.stripes.runs.tolist() == [1, 1]


def test_axes_keep_their_order_whatever_their_values(tmp_path: Path) -> None:
    ranged = rk.Sweep(SCENE, {"omega_p": {"from": 1, "to": 3, "steps": 3}, "amplitude_uplift": [1.5, 2.0]})
    listed = rk.Sweep(SCENE, {"omega_p": [1.0, 2.0, 3.0], "amplitude_uplift": [1.5, 2.0]})
    assert list(ranged.axes) == list(listed.axes) == ["excitation.horizontal.omega_p", "excitation.horizontal.amplitude_uplift"]
    pd.testing.assert_frame_equal(ranged.table(), listed.table())
    # A range behind or before a list, read from a file, keeps its place in another process.
    SCENE.save(tmp_path / "base.toml")
    file = tmp_path / "sweep.toml"
    file.write_text('scene = "base.toml"\n[axes]\nomega_p = { from = 1, to = 3, steps = 3 }\namplitude_uplift = [1.5, 2.0]\n')
    loaded = rk.Sweep.load(file)
    for copied in (pickle.loads(pickle.dumps(loaded)), pickle.loads(pickle.dumps(ranged))):
        assert list(copied.axes) == list(ranged.axes)
        pd.testing.assert_frame_equal(copied.table(), ranged.table())


def test_fractiles_are_drawn_of_three_records_or_more() -> None:
    for count in (2, 3):
        study = rk.ida(COLUMN, rk.synthetic(range(count)), "pgv", [0.2, 3.0], trust=False)
        lines = study.plot().get_lines()
        labels = [line.get_label() for line in lines if str(line.get_label()).endswith("%")]
        assert len(labels) == (3 if count == 3 else 0)
        plt.close()


def test_what_is_handed_out_is_a_copy() -> None:
    curve = rk.ida(COLUMN, rk.synthetic(range(3)), "pgv", [0.2, 0.4, 3.0], trust=False).fragility("uplift")
    curve.to_dict()["counts"].clear()
    assert len(curve.counts) == 3


def test_a_study_of_the_repository_has_the_fragility_of_its_file(scenes: Path):
    """Its file gives no layout: none is set, and none is asked for."""
    study = rk.Study.load(scenes / "studies" / "statue-ida.toml")
    curves = {state: study.fragility(state, replicates=0) for state in study.states}
    assert list(curves) == ["uplift", "peak > 0.15", "peak > 0.35", "overturned"]
    assert all(curve.layout == "stripes" for curve in curves.values())


def _study() -> pd.DataFrame:
    """Five records at six levels, two blocks: what `rocking ida` writes of them."""
    runs = [(record, level) for record in range(5) for level in range(1, 7)]
    size = np.array([level + record % 3 for record, level in runs])
    peak = np.where(size > 5, 9.0, np.where(size > 2, 0.1 * size, 0.0))
    return pd.DataFrame({
        "index": range(30),
        "record": [f"r{record}" for record, _ in runs],
        "scale": 1.5,
        "pgv": [level / 10 for _, level in runs],
        "outcome": np.select([size > 5, size > 2], ["overturns", "rocks"], "no-uplift"),
        "block": pd.array([2 if one > 5 else pd.NA for one in size], dtype="Int64"),
        "truncated": False,
        "first_uplift": np.where(size > 2, 1.5, np.nan),
        "peak_1": 0.5 * peak,
        "peak_2": peak,
    })


def test_columns_are_known_by_their_names() -> None:
    """In any order, with properties of the records, and after a trip through a file, a study says the same."""
    table = _study()
    states = ["uplift", "overturned", "peak > 0.35"]
    said = [rk.Study(table).fragility(state, replicates=50).to_dict() for state in states]
    magnitude = table.record.map({f"r{k}": 6.0 + 0.1 * k for k in range(5)})
    drift = table.peak_2.round(3) * np.linspace(1, 2, 30)
    floats = table.astype({"index": float, "block": float, "truncated": int})
    for changed in (
        table[table.columns[::-1]],
        table[["outcome", "peak_2", "pgv", "peak_1", "record", "index", "scale", "first_uplift", "block", "truncated"]],
        table.assign(magnitude=magnitude, drift=drift),
        table.assign(pga=table.pgv * 10),
        floats,
        table.sample(frac=1.0, random_state=1),
    ):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            study = rk.Study(changed)
            assert [study.fragility(state, replicates=50).to_dict() for state in states][0]["counts"] == said[0]["counts"]
            assert [rk.Study(changed.sort_values("index")).fragility(state, replicates=50).to_dict() for state in states] == said
    # Seeds of a table of floats are those of a table of whole numbers.
    seeds = table.drop(columns="record").assign(seed=[int(name[1:]) for name in table.record])
    halves = pd.concat([seeds[::2], seeds[1::2].astype({"seed": float})]).astype({"seed": object}).sort_values("index")
    assert rk.Study(halves).fragility("overturned", replicates=50).bands == rk.Study(seeds).fragility("overturned", replicates=50).bands


def test_what_would_change_an_answer_is_told() -> None:
    table = _study()
    for changed, told in (
        (table.assign(column=np.repeat(["a", "b"], 15)), "all 2 values of `column` make one curve"),
        (pd.concat([table, table], ignore_index=True).assign(index=range(60)), r"30 run\(s\) have all settings of a run above"),
        (pd.concat([table, table.assign(scale=2.5)], ignore_index=True).assign(index=range(60)), "different records share 5 names, such as 'r0'"),
        (table.assign(truncated=(table.outcome == "rocks").astype(int)), r"15 run\(s\) end before their ground motion"),
        (table.assign(peak_2=table.peak_2.where(table.outcome != "rocks")), r"15 run\(s\) that stand have no `peak_2`"),
    ):
        with pytest.warns(UserWarning, match=told):
            rk.Study(changed).fragility("peak > 0.35", replicates=0)
    for fits in ("sa_g(0.5)", "sa(0.5 0.05)"):
        with pytest.warns(UserWarning, match="different records share 5 names"):
            rk.Study(pd.concat([table, table.assign(scale=2.5)], ignore_index=True).assign(index=range(60)).rename(columns={"pgv": fits})).stripes
    with warnings.catch_warnings():
        # A column of this name that has no numbers, or categories of them, is none of scales.
        warnings.simplefilter("error")
        for scale in ("small", pd.NA, pd.Categorical([1.5] * 30)):
            rk.Study(table.assign(scale=scale)).fragility("overturned", replicates=0)
    with warnings.catch_warnings():
        # In units of uplift a record has another scale for another column.
        warnings.simplefilter("error")
        columns = pd.concat([table, table.assign(scale=2.5)], ignore_index=True).assign(index=range(60))
        rk.Study(columns.rename(columns={"pgv": "pgv_uplift"})).fragility("overturned", replicates=0)
    with pytest.raises(rk.StudyError, match=r"table.iloc\[5\]: block 2 was lost, and the table has 1 column"):
        rk.Study(table.drop(columns="peak_2")).fragility("peak > 0.35", replicates=0)
    with pytest.raises(rk.StudyError, match="column `first_uplift`: 'NA' is no number"):
        rk.Study(table.assign(first_uplift=table.first_uplift.astype(object).fillna("NA"))).fragility("uplift", replicates=0)
    with pytest.raises(rk.StudyError, match="run 0 stands in the table twice"):
        rk.Study(pd.concat([table, table])[["outcome", *table.columns.drop("outcome")]])


def test_a_table_set_anew_is_checked_as_the_first(tmp_path: Path) -> None:
    table = _study()
    study = rk.Study(table)
    said = study.fragility("uplift", replicates=20).to_dict()
    study.table = table.set_index(["record", "pgv"])
    assert study.fragility("uplift", replicates=20).to_dict() == said
    capitals = table.rename(columns={"record": "Record", "first_uplift": " First_uplift", "peak_2": "Peak_2", "outcome": "Outcome"})
    study.table = capitals
    assert study.fragility("uplift", replicates=20).to_dict() == said and list(study.table.columns) == list(table.columns)
    spectra = table.assign(spectrum=[np.arange(3.0)] * 30, block=table.block.astype("category"), peak_01=1.0)
    assert rk.Study(spectra).fragility("uplift", replicates=20).to_dict() == said
    joined = table.assign(first_uplift=table.first_uplift.where(table["index"] < 15))
    assert rk.Study(joined).fragility("uplift", replicates=20).counts.reached.tolist() == study.fragility("uplift", replicates=0).counts.reached.tolist()
    held = study.table
    for wrong, told in (
        (table.drop(columns="outcome"), "no column `outcome`"),
        (pd.concat([table, table]), "run 0 stands in the table twice"),
        (table.assign(outcome=None), r"table.iloc\[0\] has no outcome"),
    ):
        with pytest.raises(rk.StudyError, match=told):
            study.table = wrong
        assert study.table is held
    with pytest.raises(TypeError, match="table is of list; give a DataFrame of runs"):
        study.table = [1]  # type: ignore[assignment]
    study = rk.Study(table.copy())
    study.table.loc[3, "outcome"] = None
    with pytest.raises(rk.StudyError, match=r"table.iloc\[3\] has no outcome"):
        study.fragility("uplift")
    for first, told in ((table.first_uplift.notna(), "values of bool"), (table.first_uplift.fillna(-1.0), "-1 is no time")):
        with pytest.raises(rk.StudyError, match=told):
            rk.Study(table.assign(first_uplift=first)).fragility("uplift")
    own = table.assign(Block="A", residual_slide_1=0.0, residual_slide_2=0.0)
    assert list(rk.Study(own).table.columns) == list(own.columns)
    for wrong, told in (
        (own.drop(columns="residual_slide_2"), r"2 column\(s\) peak_... and 1 residual_slide_..."),
        (table.assign(record=table.record.replace("r1", "")), r"table.iloc\[6\] has no `record`"),
    ):
        with pytest.raises(rk.StudyError, match=told):
            rk.Study(wrong).fragility("uplift")
    # Beside a stack that does not stand by itself.
    rk.Study(table.assign(peak_2=table.peak_2.where(table["index"] != 2, np.inf))).plot()
    plt.close("all")


def test_levels_that_differ_by_rounding_are_one_stripe() -> None:
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)

    def table(seeds: range, levels: object) -> pd.DataFrame:
        return rk.ida(column, rk.synthetic(seeds, frequency=1.5, duration=5.0), "pgv", levels, eta=0.9, trust=False).table

    whole = pd.concat([table(range(3), np.linspace(0.1, 1.5, 15)), table(range(3, 6), [round(0.1 * k, 1) for k in range(1, 16)])])
    whole = whole.drop(columns="index")
    assert whole.pgv.nunique() > 15
    studies = [rk.Study(own, "pgv") for own in (whole, whole.assign(pgv=whole.pgv.round(9)))]
    found = [own.fragility("overturned", replicates=0) for own in studies]
    assert [len(own.counts) for own in found] == [15, 15] and found[0].counts.runs.tolist() == found[1].counts.runs.tolist()
    assert studies[0].stripes.runs.tolist() == [6] * 15
