"""Records: files, arrays, scaling, measures."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
import rocking as rk


@pytest.fixture(scope="module")
def record(scenes: Path) -> rk.Record:
    return rk.Record.read(scenes / "records" / "synthetic.AT2")


def test_a_record_of_a_file_gives_the_run_of_its_scene_file(scenes: Path, record: rk.Record) -> None:
    scene = rk.Scene.load(scenes / "two-drums-record.toml")
    run = rk.simulate(scene.replace(horizontal=record))
    assert np.array_equal(run.theta, rk.simulate(scene).theta) and run.impacts > 0
    for size in ({"pga_g": 0.5}, {"pga": 4.0}, {"pgv": 0.4}, {"cav": 3.0}, {"arias": 1.0}, {"sa_g": 0.7, "sa_period": 0.5}):
        by_file = rk.simulate(scene.replace(keys={f"excitation.horizontal.{key}": value for key, value in size.items()}))
        assert np.array_equal(rk.simulate(scene.replace(horizontal=record.scaled(**size))).theta, by_file.theta), size
    by_file = rk.simulate(scene.replace(keys={"excitation.horizontal.pgv_uplift": 1.5}))
    scaled = record.scaled(pgv_uplift=1.5, column=scene.column)
    assert np.array_equal(rk.simulate(scene, scaled).theta, by_file.theta)


def test_a_record_in_a_sum_and_in_text_has_its_samples(record: rk.Record) -> None:
    column = rk.Column.prisms(1, half_width=0.3, half_height=1.5)
    alone = rk.Scene(column, record.starting_at(1.0), t_end=20)
    assert np.array_equal(rk.simulate(rk.Scene.from_toml(alone.toml)).theta, rk.simulate(alone).theta)
    both = rk.simulate(column, rk.total(record.scaled(0.5), record.scaled(0.5)), t_end=20)
    assert both.ground[:, 0] == pytest.approx(rk.simulate(column, record, t_end=20).ground[:, 0], abs=1e-12)


def test_measures_are_those_of_numpy() -> None:
    rng = np.random.default_rng(1)
    accel = np.concatenate([[0.0], rng.normal(size=400), [0.0]])
    record = rk.Record(accel, dt=0.01, name="noise")
    assert np.array_equal(record.accel, accel) and record.duration == pytest.approx(4.01) and len(record) == 402
    velocity = np.concatenate([[0.0], np.cumsum((accel[1:] + accel[:-1]) / 2 * 0.01)])
    assert record.velocity == pytest.approx(velocity, abs=1e-12)
    measures = record.measures()
    assert measures["pga"] == np.abs(accel).max()
    squares = np.sum((accel[1:] ** 2 + accel[1:] * accel[:-1] + accel[:-1] ** 2) / 3) * 0.01
    assert measures["arias"] == pytest.approx(np.pi / (2 * 9.81) * squares)
    assert record.scaled(pgv=0.2).measures()["pgv"] == pytest.approx(0.2)
    # A kink of the record sets a stiff oscillator ringing by the change of slope over ω: 0.2 % of the largest acceleration at 1e-4 s.
    stiff = record.spectrum([1e-4, 0.5])
    assert stiff.shape == (2,) and stiff[0] == pytest.approx(measures["pga"], rel=1e-2)


def test_records_are_cut_shifted_written_and_pickled(record: rk.Record, tmp_path: Path) -> None:
    part = record.trimmed(1.0, 2.0).starting_at(3.0).named("part")
    assert part.start == 3.0 and part.duration == pytest.approx(1.0) and part.name == "part" and part.t[0] == 3.0
    again = pickle.loads(pickle.dumps(part))
    assert again == part and again != record and "part" in repr(again)
    record.to_csv(tmp_path / "record.csv")
    assert np.array_equal(rk.Record.read(tmp_path / "record.csv").accel, record.accel)
    assert record.plot().get_ylabel() == "a [m/s²]"


def test_bad_records_are_refused(tmp_path: Path, record: rk.Record) -> None:
    with pytest.raises(rk.RecordError, match="at least two"):
        rk.Record([1.0], dt=0.1)
    with pytest.raises(ValueError, match="shape"):
        rk.Record([[1.0, 2.0]], dt=0.1)
    with pytest.raises(rk.RecordError, match="dt"):
        rk.Record([1.0, 2.0], dt=0.0)
    with pytest.raises(ValueError, match="masked"):
        rk.Record(np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0]), dt=0.1)
    with pytest.raises(ValueError, match="complex"):
        rk.Record(np.array([1.0j, 2.0]), dt=0.1)
    for arguments, message in (((None, 0.01), "accel is of NoneType"), (("a.AT2", 0.01), "accel is of str"), (([0, 1], None), "dt is of NoneType"), (([0, 1], "0.01 s"), "dt is of str")):
        with pytest.raises(TypeError, match=message):
            rk.Record(*arguments)
    assert rk.Record([0, 1], np.float32(0.5)).dt == 0.5
    (tmp_path / "bad.txt").write_text("0.1\nnonsense\n")
    with pytest.raises(rk.RecordError) as caught:
        rk.Record.read(tmp_path / "bad.txt", dt=0.01, units="g")
    assert caught.value.file == str(tmp_path / "bad.txt") and "nonsense" in str(caught.value)
    with pytest.raises(OSError, match="none.AT2"):
        rk.Record.read(tmp_path / "none.AT2")
    with pytest.raises(ValueError, match="unit `furlong`"):
        rk.Record.read(tmp_path / "bad.txt", units="furlong")
    for size, text in (
        ({}, "give one size"),
        ({"pga": 1, "pgv": 1}, "give one size"),
        ({"pgx": 1.0}, "no measure `pgx`"),
        ({"pga": -1.0}, "out of range"),
        ({"pgv": 0.5, "sa_damping": 0.2}, "`pgv` has no damping; leave sa_damping out, or measure by sa or sa_g"),
        ({"pgv": 0.5, "sa_period": 0.2}, "`pgv` has no period; leave sa_period out, or measure by sa or sa_g"),
    ):
        with pytest.raises((TypeError, ValueError), match=text):
            record.scaled(**size)
    with pytest.raises(ValueError, match="give `column`"):
        record.scaled(pga_uplift=1.0)
    with pytest.raises(rk.RecordError):
        rk.Record([0.0, 0.0], dt=0.1).scaled(pga=1.0)


def test_a_folder_is_read_by_components(tmp_path: Path) -> None:
    for station in ("AAA", "BBB"):
        for component, seed in (("000", 1), ("090", 2), ("UP", 3)):
            made = rk.Record.synthetic(seed, duration=5.0, pga=1.0 + seed)
            (tmp_path / f"{station}_{component}.csv").write_text(made.to_csv())
    found = rk.records(tmp_path)
    assert len(found) == 4 and all("UP" not in record.name and record.vertical is None for record in found)
    shaken = rk.records(tmp_path, component="090", vertical=True)
    assert len(shaken) == 2 and shaken[0].vertical == rk.Record.read(tmp_path / "AAA_UP.csv").named(shaken[0].vertical.name)
    assert [record.name for record in rk.Records([r.horizontal for r in found])] == [record.name for record in found]
    with pytest.raises(rk.SceneError, match="component `270`"):
        rk.records(tmp_path, component="270")
    with pytest.raises(rk.SceneError, match="choose another component, or read the files one by one with Record.read"):
        rk.records(tmp_path, component="270")
    (tmp_path / "empty").mkdir()
    with pytest.raises(rk.SceneError) as caught:
        rk.records(tmp_path / "empty")
    assert caught.value.key == "records.folder"
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "bad.txt").write_text("1.0\n2.0\n")
    with pytest.raises(rk.SceneError, match="read the others one by one with Record.read") as caught:
        rk.records(tmp_path / "bad")
    assert caught.value.file == str(tmp_path / "bad") and "<records>" not in str(caught.value) and "`files`" not in str(caught.value)
    with pytest.raises(ValueError, match="there twice"):
        rk.Records([made.named("a"), made.named("a")])


def test_arguments_of_the_wrong_kind_are_named() -> None:
    record = rk.Record([0.0, 1.0, 0.0], 0.01)
    for call, told in (
        (lambda: rk.Record(["1", "2"], 0.01), "accel has texts"),
        (lambda: rk.Record((x for x in (1.0, 2.0)), 0.01), "accel is of generator; give a list"),
        (lambda: rk.Record([0.0, 1.0], 0.01, name=None), "name is of NoneType"),
        (lambda: record.scaled("2"), "scale is of str"),
        (lambda: record.scaled(pga="1"), "pga is of str"),
        (lambda: record.scaled(2.0, sa_period=3.0), "a factor has no sa_period"),
        (lambda: rk.Records(record), "records is one Record; give a list"),
        (lambda: rk.Ida(rk.Column.prisms(1, half_width=0.4, half_height=1.6), [record], "pga", [1.0], trust=1), "trust is of int"),
        (lambda: rk.Ida(rk.Column.prisms(1, half_width=0.4, half_height=1.6), [record], "pga", {"from": 1}), "levels are a dictionary"),
    ):
        with pytest.raises(TypeError, match=told):
            call()


def test_samples_of_an_array_are_doubted_as_those_of_a_file(tmp_path: Path) -> None:
    waves = np.sin(0.1 * np.arange(500)) * np.linspace(1, 0, 500)
    wrong = rk.Record(300 * waves, dt=0.01)
    wrong.to_csv(tmp_path / "wrong.csv")
    assert wrong.warnings == rk.Record.read(tmp_path / "wrong.csv").warnings and "hardly one" in wrong.warnings[0]
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.56)
    for motion in (wrong, {"kind": "record", "accel": (300 * waves).tolist(), "dt": 0.01}):
        assert any("the horizontal record: a peak of" in warning for warning in rk.simulate(column, motion, t_end=1).warnings)
    right = rk.Record(300 * waves, dt=0.01, units="cm/s2")
    assert right.warnings == [] and np.allclose(right.accel, 3 * waves, rtol=1e-15, atol=0)
    in_g = {"kind": "record", "accel": waves.tolist(), "dt": 0.01, "units": "g"}
    assert np.array_equal(rk.simulate(column, in_g, t_end=1).theta, rk.simulate(column, rk.Record(waves, dt=0.01, units="g"), t_end=1).theta)
    assert "hardly one" in rk.Record(waves, dt=10).warnings[0]
    assert "missing" in rk.Record([0.0, -999.0, 0.0], dt=0.01).warnings[0]
    assert rk.Record([0.0, 1.0, -1.0, 0.0], dt=0.5).warnings == []
    with pytest.raises(ValueError, match="no unit `kg`"):
        rk.Record(waves, dt=0.01, units="kg")
    with pytest.raises(ValueError, match="accel is no array"):
        rk.Record([[1.0], [1.0, 2.0]], dt=0.01)  # type: ignore[list-item]
