"""Scenes are the keys of scene files, and errors are the reader's."""

from __future__ import annotations

import errno
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import rocking as rk
from rocking._scene import ARGUMENTS

ROOT = Path(__file__).resolve().parents[2]
COLUMN = rk.Column.prisms(2, half_width=0.4, half_height=1.6)


def test_every_key_of_the_reference_has_its_argument() -> None:
    text = (ROOT / "docs" / "book" / "scene-file.md").read_text()
    chapters = {"Top level": "", "Impacts": "restitution.", "Initial state": "initial.", "Solver": "solver.", "Output": "output."}
    documented = set()
    for section in text.split("\n## ")[1:]:
        table = next((table for head, table in chapters.items() if section.startswith(head)), None)
        if table is None:
            continue
        for row in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE):
            documented |= {table + key for key in re.findall(r"`(\w+)`", row)}
    assert len(documented) > 18 and documented == set(ARGUMENTS.values())


def test_a_column_is_cut_and_measured() -> None:
    column = rk.Column.drums(5, half_width=0.5, top_half_width=0.4, height=5.0, density=2700)
    assert len(column) == 5 and column.blocks.half_height.tolist() == [0.5] * 5
    assert column.blocks.mass.sum() == pytest.approx(2700 * np.pi * 5 * (0.25 + 0.2 + 0.16) / 3)
    one = rk.Column([rk.Block(width=0.6, height=0.8, mass=100.0)])
    assert one.R == pytest.approx(0.5) and one.p == pytest.approx(np.sqrt(3 * 9.81 / 2)) and one.alpha == pytest.approx(np.arctan(0.75))
    assert one.uplift_acceleration == pytest.approx(0.75 * 9.81)
    assert one == rk.Column([{"half_width": 0.3, "half_height": 0.4, "mass": 100.0}]) != column
    with pytest.raises(TypeError, match="give one of them"):
        rk.Block(width=1.0, half_width=0.5, height=1.0)


def test_contacts_of_a_column_at_rest_say_what_gives_way_first() -> None:
    """A cube opens at 1 g and slides at 0.6 g, which the half-sine reaches when its sine is two thirds."""
    cube, shaken = [rk.Block(half_width=0.5, half_height=0.5)], rk.pulse("half-sine", amplitude_g=0.9, omega=2.0)
    contact = rk.Scene(cube, shaken, friction=0.6).contacts.loc[1]
    assert (contact.slides_at, contact.opens_at) == pytest.approx((0.6 * 9.81, 9.81))
    assert contact.slides_from == pytest.approx(np.arcsin(0.6 / 0.9) / 2.0, abs=1e-12) and contact.at_pga == "slides"
    assert np.isnan(contact.opens_from) and np.isnan(contact.coefficient_to_rock)
    held = rk.Scene(cube, shaken).contacts
    assert held.slides_at.isna().all() and held.at_pga.to_list() == ["rests"] and held.index.name == "interface"


def test_a_scene_goes_to_text_and_back() -> None:
    scene = rk.Scene(
        COLUMN,
        rk.pulse("ricker", amplitude_g=np.float64(0.4), frequency=1.2) + {"kind": "synthetic", "pga_g": 0.1, "seed": np.int64(3)},
        {"kind": "harmonic", "amplitude_g": 0.05, "frequency": 4.0, "duration": 10.0},
        title='Two "drums"\n– with everything',
        factors=np.array([0.95, 0.9]),
        theta=(0.01, 0.01),
        t_end=20,
        rtol=1e-8,
        output_dt=0.05,
    )
    again = rk.Scene.from_toml(scene.toml)
    assert again == scene and again.title == 'Two "drums"\n– with everything'
    assert rk.Scene.from_dict(scene.keys) == scene and rk.Scene.from_dict(again.keys) == scene
    assert scene.replace(t_end=10) != scene and scene.replace(t_end=10).replace(t_end=20) == scene


def test_replacing_takes_dotted_keys_and_alternatives(tmp_path: Path) -> None:
    scene = rk.Scene([rk.Block(half_width=0.4, half_height=0.8)] * 2, rk.pulse("ricker", amplitude=2.0, omega=5.0), eta=0.9)
    changed = scene.replace(factors=[1.0, 1.0], keys={"block[2].half_width": 0.3, "excitation.horizontal.amplitude": 3.0, "solver.t_end": 4.0})
    assert changed.keys["restitution"] == {"factors": [1.0, 1.0]} and changed.t_end == 4.0
    assert changed.column.blocks.top_half_width.tolist() == [0.4, 0.3] and changed.keys["excitation"]["horizontal"]["amplitude"] == 3.0
    assert scene.keys["block"][1]["half_width"] == 0.4 and scene.keys["excitation"]["horizontal"]["amplitude"] == 2.0
    assert scene.replace(keys={"restitution.eta": None}) == rk.Scene(scene.column, rk.pulse("ricker", amplitude=2.0, omega=5.0))
    with pytest.raises(ValueError, match="no such item"):
        scene.replace(keys={"block[3].mass": 1.0})
    scene.save(tmp_path / "scene.toml")
    assert rk.Scene.load(tmp_path / "scene.toml") == scene


def test_records_are_found_beside_their_scene(scenes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    loaded = rk.Scene.load(scenes / "two-drums-record.toml")
    assert loaded.replace(t_end=5).keys["excitation"]["horizontal"]["file"] == "records/synthetic.AT2"
    # Pickled, the samples travel with it.
    (tmp_path / "moved").mkdir()
    for name in ("two-drums-record.toml", "records/synthetic.AT2"):
        target = tmp_path / "moved" / name
        target.parent.mkdir(exist_ok=True)
        target.write_bytes((scenes / name).read_bytes())
    moved = pickle.dumps(rk.Scene.load(tmp_path / "moved" / "two-drums-record.toml"))
    (tmp_path / "moved" / "records" / "synthetic.AT2").unlink()
    run = rk.simulate(pickle.loads(moved))
    assert run.impacts == rk.simulate(loaded).impacts > 0


def test_an_error_names_file_line_key_and_remedy(tmp_path: Path) -> None:
    with pytest.raises(rk.SceneError) as caught:
        rk.Scene(COLUMN, eta=1.5)
    error = caught.value
    assert (error.file, error.key) == ("<scene>", "restitution.eta") and error.problem == "1.5 is out of range"
    assert error.remedy == "give a number from 0 to 1" and error.faults == (error,)
    text = rk.Scene(COLUMN, eta=0.5).toml.replace("0.5", "1.5")
    assert text.splitlines()[error.line - 1] == "eta = 1.5"
    assert str(error) == f"<scene>, line {error.line}, key `restitution.eta`: 1.5 is out of range; give a number from 0 to 1"
    file = tmp_path / "scene.toml"
    file.write_text("[column]\nblocks = 2\nhalf_width = 0.4\nhalf_hight = 1.6\n")
    with pytest.raises(rk.SceneError) as caught:
        rk.Scene.load(file)
    assert (caught.value.file, caught.value.line, caught.value.key) == (str(file), 4, "column.half_hight")
    assert "did you mean `half_height`?" in str(caught.value)
    with pytest.raises(rk.SceneError, match="check the path") as caught:
        rk.Scene.load(tmp_path / "none.toml")
    assert caught.value.file == str(tmp_path / "none.toml") and caught.value.line == 0


def test_an_error_of_a_changed_scene_names_no_line_of_its_file(scenes: Path) -> None:
    """Its text is made anew of its keys: a line of it is none of the file's."""
    scene = rk.Scene.load(scenes / "two-drums-record.toml")
    with pytest.raises(rk.SceneError, match="^<scene>, line ") as caught:
        scene.replace(eta=1.5)
    assert caught.value.file == "<scene>" and caught.value.key == "restitution.eta"
    with pytest.raises(rk.SceneError, match="asked for by <scene>, line ") as caught:
        scene.replace(keys={"excitation.horizontal.file": "none.AT2"})
    assert caught.value.file == "<scene>" and caught.value.record == str(scenes.resolve() / "none.AT2")


def test_several_faults_are_all_told_and_errors_are_pickled() -> None:
    with pytest.raises(rk.SceneError) as caught:
        rk.Scene(COLUMN, t_end=-1.0, rtol=1.0)
    assert sorted(fault.key for fault in caught.value.faults) == ["solver.rtol", "solver.t_end"]
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and [fault.line for fault in again.faults] == [fault.line for fault in caught.value.faults]
    for base in (rk.RockingError, ValueError):
        assert isinstance(again, base)


def test_a_missing_record_is_an_error_with_its_place(tmp_path: Path) -> None:
    with pytest.raises(rk.SceneError) as caught:
        rk.Scene(COLUMN, {"kind": "record", "file": tmp_path / "none.AT2"})
    assert caught.value.key == "excitation.horizontal.file" and caught.value.record == str(tmp_path / "none.AT2") and caught.value.line > 0


@pytest.mark.parametrize(
    ("arguments", "kind", "text"),
    [
        ({"etta": 0.9}, TypeError, "no argument `etta`"),
        ({"keys": {"solver.rtoll": 1.0}}, rk.SceneError, "rtol"),
        ({"theta": [0.1]}, rk.SceneError, "1 number\\(s\\) for 2 block"),
        ({"theta": [0.1, None]}, TypeError, "None stands in a list"),
        ({"title": object()}, TypeError, "key `title`: a object cannot stand in a scene"),
        ({"t_end": float("nan")}, rk.SceneError, "solver.t_end"),
        ({"t_end": "ten"}, rk.SceneError, "text stands here"),
        ({"friction": -0.1}, rk.SceneError, "friction"),
        ({"keys": {"title.x": 1}, "title": "t"}, ValueError, "has no keys"),
    ],
)
def test_bad_arguments_are_refused(arguments, kind, text: str) -> None:
    with pytest.raises(kind, match=text):
        rk.Scene(COLUMN, **arguments)


def test_bad_columns_and_motions_are_refused() -> None:
    with pytest.raises(rk.SceneError, match="half_width"):
        rk.Column.drums(2, half_width=-1.0, height=2.0)
    with pytest.raises(rk.SceneError, match="add a \\[\\[block\\]\\]"):
        rk.Column([])
    with pytest.raises(rk.SceneError, match="there is no kind `rickr`"):
        rk.simulate(COLUMN, rk.pulse("rickr", amplitude=1.0, omega=1.0))
    with pytest.raises(rk.SceneError, match="amplitude_g"):
        rk.simulate(COLUMN, rk.pulse("ricker", amplitude=1.0, amplitude_g=1.0, omega=1.0))


@pytest.mark.parametrize("value", [np.longdouble("0.9"), np.float32(0.9), np.float64(0.9), np.array(0.9, dtype=np.longdouble)])
def test_numbers_of_numpy_are_numbers(value: object) -> None:
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    assert abs(rk.Scene(column, eta=value).keys["restitution"]["eta"] - 0.9) < 1e-7
    assert rk.Scene(column, theta=np.array([0.125], dtype=np.longdouble)).keys["initial"]["theta"][0] == 0.125
    axis = np.linspace(0.5, 0.75, 2, dtype=np.longdouble)
    assert rk.sweep(rk.Scene(column, rk.pulse("ricker", amplitude=1.0, omega=2.0)), {"eta": axis})["restitution.eta"].tolist() == [0.5, 0.75]


def test_times_with_units_and_complex_numbers_are_refused() -> None:
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.pulse("ricker", amplitude=1.0, omega=2.0))
    nanoseconds = np.array([0, 1], "m8[ns]")
    for refused in (
        lambda: rk.simulate(scene, t_eval=nanoseconds),
        lambda: scene.replace(t_end=np.timedelta64(20, "ns")),
        lambda: rk.sweep(scene, {"t_end": nanoseconds}),
        lambda: scene.replace(eta=np.complex64(0.5)),
        lambda: scene.replace(eta=np.clongdouble(0.5)),
        lambda: rk.Record([0.0, 1.0], np.timedelta64(1, "ns")),
        lambda: rk.Record([0.0, 1.0], 0.01, start=np.datetime64(5, "ns")),
        lambda: rk.Record([0.0, 1.0], 0.01).scaled(pga=np.complex64(1 + 2j)),
    ):
        with pytest.raises(TypeError):
            refused()
    with pytest.raises(TypeError, match="is a date; give a number in the unit of the key"):
        scene.replace(t_end=np.datetime64("2026-01-01"))


def test_what_was_given_may_change_afterwards() -> None:
    """Arrays and dictionaries were shared: text, sweeps and pickles of a scene followed them, its runs did not."""
    theta, motion, keys = np.array([0.02, 0.02]), {"kind": "ricker", "amplitude": 2.0, "omega": 5.0}, {"output.columns": ["top"]}
    scene = rk.Scene(COLUMN, motion, theta=theta, keys=keys)
    samples = [0.0, 1.0, 0.0]
    recorded = rk.Motion(kind="record", accel=samples, dt=0.01)
    axes = {"eta": np.array([0.8, 0.9])}
    sweep = rk.Sweep(scene, axes)
    before = scene.toml, sweep.table()
    theta[0], motion["amplitude"], samples[1], axes["eta"][0] = 0.3, 9.0, 5.0, 0.1
    keys["output.columns"].append("relative")
    assert scene.toml == before[0] and recorded["accel"] == [0.0, 1.0, 0.0]
    assert pickle.loads(pickle.dumps(sweep)).table().equals(before[1])
    nested = {"column": {"blocks": 1, "half_width": 0.4, "half_height": 1.6}, "initial": {"theta": [0.1]}}
    rk.Scene.from_dict(nested).replace(theta=[0.2])
    assert nested["initial"] == {"theta": [0.1]}


def test_none_leaves_a_key_out() -> None:
    scene = rk.Scene(COLUMN, rk.pulse("ricker", amplitude=2.0, omega=5.0), friction=0.5, eta=0.9, t_end=7.0)
    assert scene.replace(friction=None) == rk.Scene(COLUMN, rk.pulse("ricker", amplitude=2.0, omega=5.0), eta=0.9, t_end=7.0)
    assert rk.simulate(scene, friction=None).slide is None and rk.simulate(scene).slide is not None
    assert scene.replace(factors=None) == scene and rk.Scene(COLUMN, friction=None, t_end=3) == rk.Scene(COLUMN, t_end=3)


def test_a_scene_is_not_saved_where_it_would_name_other_records(scenes: Path, tmp_path: Path) -> None:
    scene = rk.Scene.load(scenes / "two-drums-record.toml")
    with pytest.raises(ValueError, match="records/synthetic.AT2 relative to"):
        scene.save(tmp_path / "scene.toml")
    moved = scene.replace(keys={"excitation.horizontal.file": scenes.resolve() / "records" / "synthetic.AT2"})
    moved.save(tmp_path / "scene.toml")
    again = rk.Scene.load(tmp_path / "scene.toml")
    assert rk.simulate(again).impacts == rk.simulate(scene).impacts


def test_a_record_stands_beside_no_station() -> None:
    with pytest.raises(rk.SceneError, match="`station` is given as well") as caught:
        rk.Scene(COLUMN, rk.Record.synthetic(1), keys={"excitation.station": {"record": "records/RSN1"}})
    assert caught.value.key == "excitation.horizontal"


def test_what_stands_in_the_wrong_place_is_told() -> None:
    motion, table = rk.pulse("ricker", amplitude=2.0, omega=5.0), pd.DataFrame({"width": [1.0], "height": [2.0]})
    record = rk.StudyRecord("a", rk.Record.synthetic(1))
    refused: list[tuple[Any, str]] = [
        (lambda: rk.simulate(COLUMN, record), "horizontal motion is of StudyRecord; give one of its components, as `record.horizontal`"),
        (lambda: rk.simulate(COLUMN, vertical=record), "vertical motion is of StudyRecord"),
        (lambda: rk.Scene(COLUMN).replace(horizontal=record), "horizontal motion is of StudyRecord"),
        (lambda: rk.total(motion, record), "motion 2 of the sum is of StudyRecord"),
        (lambda: rk.simulate(COLUMN, horizontal=motion), "no argument `horizontal`; give the horizontal motion as `motion`"),
        (lambda: rk.simulate(COLUMN, np.zeros(10)), r"is of ndarray; make a record of accelerations with Record\(accelerations, dt=0.01\)"),
        (lambda: rk.simulate(COLUMN, "a.AT2"), r"is of str; read the record with Record.read\('a.AT2'\)"),
        (lambda: rk.simulate(motion, COLUMN), "the column is of Motion; give the column first, then the motion"),
        (lambda: rk.simulate("a.toml"), r"the column is of str; read a scene with Scene.load\('a.toml'\)"),
        (lambda: rk.Column(rk.Block(width=1.0, height=2.0)), "the column is of Block; give a list of Block, base first"),
        (lambda: rk.Column(table), "the column is of DataFrame; give a list of Block"),
        (lambda: rk.Column([1.0]), "block 1 is of float; give a Block"),
        (lambda: rk.simulate(COLUMN, rows=1), "rows is of int; give True or False"),
        (lambda: rk.Scene(COLUMN, keys={5: 1}), "the name 5 in keys is of int; give dotted names"),
    ]
    for call, message in refused:
        with pytest.raises(TypeError, match=message):
            call()
    assert len(rk.Column(table.to_dict("records"))) == 1


def test_sizes_that_are_no_numbers_are_named() -> None:
    for sizes in ({"width": "0.8 m", "height": 5.0}, {"half_width": "0.4 m", "height": 5.0}):
        with pytest.raises(rk.SceneError, match="key `column.half_width`: text stands here; give a number"):
            rk.Column.drums(3, **sizes)


def test_a_file_that_is_not_there_is_a_file_not_found(tmp_path: Path) -> None:
    missing = tmp_path / "none.toml"
    for load in (rk.Scene.load, rk.Sweep.load, rk.Study.load, rk.records):
        with pytest.raises(FileNotFoundError, match="check the path") as caught:
            load(missing)
        error = pickle.loads(pickle.dumps(caught.value))
        assert isinstance(error, rk.SceneError) and error.errno == errno.ENOENT and error.filename == error.file == str(missing)
    with pytest.raises(FileNotFoundError, match="check the path") as read:
        rk.Record.read(missing)
    assert read.value.errno == errno.ENOENT and read.value.filename == str(missing)
    with pytest.raises(rk.SceneError) as folder:
        rk.Scene.load(tmp_path)
    assert not isinstance(folder.value, FileNotFoundError)


def test_a_record_that_is_not_there_is_a_file_not_found(tmp_path: Path) -> None:
    missing, damaged = tmp_path / "none.AT2", tmp_path / "damaged.AT2"
    damaged.write_text("no record\n")
    with pytest.raises(FileNotFoundError) as caught:
        rk.Scene(COLUMN, {"kind": "record", "file": str(missing)})
    error = pickle.loads(pickle.dumps(caught.value))
    assert isinstance(error, rk.MissingFileError) and error.filename == error.record == str(missing) and error.file == "<scene>"
    with pytest.raises(rk.SceneError) as caught_too:
        rk.Scene(COLUMN, {"kind": "record", "file": str(damaged)})
    assert caught_too.value.record == str(damaged) and not isinstance(caught_too.value, FileNotFoundError)
    # The record of a station is there, and has no vertical component.
    rk.Record.synthetic(1).to_csv(tmp_path / "S_000.csv")
    with pytest.raises(rk.SceneError) as station:
        rk.Scene(COLUMN, keys={"excitation.station": {"record": str(tmp_path / "S"), "vertical": True}})
    assert station.value.record and not isinstance(station.value, FileNotFoundError)


def test_relative_records_are_those_of_the_folder_in_which_a_scene_was_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a change of folder another record of the same name was run, without a word."""
    for folder, pga in (("a", 5.0), ("b", 9.0)):
        (tmp_path / folder).mkdir()
        rk.Record.synthetic(1, duration=4.0, pga=pga).to_csv(tmp_path / folder / "acc.csv")
    monkeypatch.chdir(tmp_path / "a")
    motion = {"kind": "record", "file": "acc.csv"}
    made = rk.Scene(COLUMN, motion, eta=0.9, t_end=5.0)
    text = '[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = "record"\nfile = "acc.csv"\n'
    scenes = [made, rk.Scene(COLUMN, rk.total(rk.Motion(**motion))), rk.Scene.from_toml(text), rk.Scene.from_dict(rk.Scene.from_toml(text).keys)]
    scenes.append(rk.Scene.from_dict({**made.keys, "excitation": {"horizontal": motion}}))
    assert all(scene == scene.replace() == rk.Scene.from_dict(scene.keys) for scene in scenes)
    upright = rk.Scene(COLUMN, t_end=5.0)
    scenes += [upright.replace(horizontal=motion), upright.replace(horizontal=rk.pulse("half-sine", amplitude=1.0, omega=5.0)).replace(horizontal=motion)]
    scenes.append(rk.Scene.from_toml(text, file="<notebook>"))
    before = [rk.simulate(scene).peak_theta for scene in scenes]
    assert all(peaks.any() for peaks in before)
    files = rk.Sweep(made, {"excitation.horizontal.file": ["acc.csv"]}, ask="peaks")
    peaks_of_files = files.table()
    sweep = rk.Sweep(made, {"eta": [0.9]}, ask="peaks")
    monkeypatch.chdir(tmp_path / "b")
    for scene, peaks in zip(scenes, before):
        replaced = scene.replace(title="the same")
        scene.save(tmp_path / "b" / "saved.toml")
        for again in (scene, replaced, pickle.loads(pickle.dumps(scene)).replace(title="pickled"), rk.Scene.load("saved.toml")):
            np.testing.assert_array_equal(rk.simulate(again).peak_theta, peaks)
    assert pickle.loads(pickle.dumps(files)).table().equals(peaks_of_files)
    assert rk.Sweep(made, {"eta": [0.9]}, ask="peaks").table().equals(sweep.table()) and pickle.loads(pickle.dumps(sweep)).table().equals(sweep.table())


@pytest.mark.parametrize(
    "error",
    [
        rk.SceneError("message", "file", 3, "key", "problem", "remedy", "record"),
        rk.MissingFileError("message", "file", 3, "key", "problem", "remedy", "record"),
        rk.MissingFileError("message", "file"),
        rk.RecordError("message", "file"),
        rk.SolveError("message", 1.5),
        rk.StudyError("message"),
        rk.FolderError("message"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_errors_come_back_from_workers(error: rk.RockingError) -> None:
    """Workers of distributed pickle errors with their tracebacks; errors that are several things at once did not come back."""
    support = pytest.importorskip("tblib.pickling_support")
    with pytest.raises(type(error)) as raised:
        raise error
    support.install(raised.value)
    back = pickle.loads(pickle.dumps(raised.value))
    assert type(back) is type(error) and str(back) == "message" and back.args == error.args and back.__traceback__ is not None
    of_file = ("file", "line", "key", "problem", "remedy", "record", "time", "errno", "filename")
    assert all(getattr(back, name, None) == getattr(error, name, None) for name in of_file)


def test_one_of_several_faults_comes_back_from_workers() -> None:
    """Raised again while the error of them all is handled, it stands in the arguments of its own context."""
    support = pytest.importorskip("tblib.pickling_support")
    with pytest.raises(rk.SceneError) as raised:
        try:
            rk.Scene(COLUMN, eta=1.5, t_end=-1.0)
        except rk.SceneError as several:
            assert len(several.faults) == 2
            raise several.faults[1]
    support.install(raised.value, raised.value.__context__)
    back = pickle.loads(pickle.dumps(raised.value))
    assert (back.key, str(back)) == (raised.value.key, str(raised.value)) and len(back.__context__.faults) == 2


def test_a_folder_that_may_not_be_entered_is_not_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    # So long a name cannot be asked for, whoever asks: that is not the same as a file that is not there.
    for load in (rk.Scene.load, rk.Sweep.load, rk.Study.load, rk.records):
        with pytest.raises(rk.SceneError) as unknown:
            load("n" * 5000)
        assert not isinstance(unknown.value, FileNotFoundError)

    def refused(path: Any, *others: Any, **named: Any) -> Any:
        raise PermissionError(errno.EACCES, "Permission denied", path)

    monkeypatch.setattr("rocking._record.os.stat", refused)
    with pytest.raises(rk.SceneError, match="Permission denied; check the permissions") as caught:
        rk.records("/closed")
    assert not isinstance(caught.value, FileNotFoundError)
    monkeypatch.undo()
    for load in (rk.records, rk.Scene.load, rk.Sweep.load, rk.Study.load):
        with pytest.raises(ValueError, match="is empty; give a path"):
            load("")
    with pytest.raises(ValueError, match="name is empty; give the record a name"):
        rk.StudyRecord("", rk.Record.synthetic(1))


def test_what_a_motion_gives_out_changes_no_scene() -> None:
    shake = rk.total(rk.pulse("half-sine", amplitude=1.0, omega=5.0), rk.pulse("half-sine", amplitude=2.0, omega=5.0, start=1.0))
    scene = rk.Scene(COLUMN, shake)
    shake["term"].append({"kind": "half-sine", "amplitude": 9.0, "omega": 5.0})
    shake["term"][0]["amplitude"] = 9.0
    assert len(shake["term"]) == 2 and rk.Scene.from_toml(scene.toml) == scene and "9.0" not in scene.toml


def test_rows_that_are_not_wanted_are_not_too_many() -> None:
    motion = rk.pulse("ricker", amplitude=2.0, omega=5.0)
    assert len(rk.simulate(COLUMN, motion, t_end=1e5, rows=False).t) == 0
    assert len(rk.simulate(rk.Scene(COLUMN, motion), t_end=1e5, rows=False).t) == 0
    blocks = (rk.Block(width=0.4, height=2.0) for _ in range(2))
    assert rk.simulate(blocks, motion, t_end=1e5, rows=False).peak_theta.shape == (2,)
    with pytest.raises(rk.SceneError, match="too many for the memory"):
        rk.simulate(COLUMN, motion, t_end=1e5)
    with pytest.raises(rk.SceneError, match="rtol"):
        rk.simulate(COLUMN, motion, rtol=2.0, rows=False)


def test_another_column_comes_with_its_own_gravity_and_size() -> None:
    moon = rk.Column.prisms(1, half_width=0.4, half_height=1.6, gravity=1.62)
    earth = rk.Column.prisms(1, half_width=0.2, half_height=0.8)
    scene = rk.Scene(moon, theta=[0.1], t_end=3)
    assert scene.replace(column=earth) == rk.Scene(earth, theta=[0.1], t_end=3) and scene.replace(column=earth).column == earth
    assert scene.replace(column=earth, gravity=1.62).column.p < earth.p
    sized = rk.Scene(earth, theta=[0.1], t_end=3, keys={"size.alpha": 0.1})
    assert sized.replace(column=moon).column == moon


def test_a_scene_is_of_the_folder_in_which_it_was_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    column = '[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = "record"\nfile = "r.csv"\n'
    for folder, peak in (("a", 0.3), ("b", 0.6)):
        (tmp_path / folder / "in").mkdir(parents=True)
        (tmp_path / folder / "in" / "s.toml").write_text(column)
        rk.Record([0.0, peak * 9.81, 0.0, 0.0], 0.02).to_csv(tmp_path / folder / "in" / "r.csv")
    monkeypatch.chdir(tmp_path / "a")
    scene = rk.Scene.load("in/s.toml")
    monkeypatch.chdir(tmp_path / "b")
    one, other = (rk.simulate(own, rows=False).summary["peak_ground_acceleration"] for own in (scene, scene.replace(rtol=1e-8)))
    assert one == other


def test_a_key_takes_the_place_of_those_of_which_a_scene_has_one():
    """As an axis of a sweep: the mass of a block whose density was given, an amplitude in other units, a size of a record."""
    drum = {"shape": "drum", "half_width": 0.4, "half_height": 0.5, "density": 2500.0}
    scene = rk.Scene([drum, {**drum, "depth": 0.7, "shape": "prism"}], rk.pulse("sine-pulse", amplitude_g=0.3, omega=5.0), eta=0.9)
    changed = scene.replace(keys={"block[2].mass": 900.0, "excitation.horizontal.amplitude": 2.0, "restitution.factors": [1.0, 1.0]})
    assert changed.keys["block"][1]["mass"] == 900.0 and changed.keys["excitation"]["horizontal"]["amplitude"] == 2.0
    assert not {"density", "depth"} & set(changed.keys["block"][1]) and "density" in changed.keys["block"][0]
    assert "amplitude_g" not in changed.keys["excitation"]["horizontal"] and changed.keys["restitution"] == {"factors": [1.0, 1.0]}
    # Two that are given are refused.
    with pytest.raises(rk.SceneError):
        scene.replace(keys={"block[2].half_height": 0.4, "block[2].height": 0.8})


def test_files_are_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record, file = rk.Record([0.0, 3.0, 0.0], 0.02), tmp_path / "r.csv"
    record.to_csv(file)
    whole = file.read_text()
    file.chmod(0o640)

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched, pytest.raises(KeyboardInterrupt):
        patched.setattr("rocking._files.os.replace", interrupted)
        record.scaled(2.0).to_csv(file)
    assert file.read_text() == whole and [path.name for path in tmp_path.iterdir()] == ["r.csv"]
    record.scaled(2.0).to_csv(file)
    assert file.read_text() != whole and file.stat().st_mode & 0o777 == 0o640
    (tmp_path / "link.csv").symlink_to(file)
    record.to_csv(tmp_path / "link.csv")
    assert file.read_text() == whole and (tmp_path / "link.csv").is_symlink()
    for place, refusal in ((tmp_path / "none" / "r.csv", FileNotFoundError), (tmp_path, IsADirectoryError)):
        with pytest.raises(refusal) as refused:
            record.to_csv(place)
        assert refused.value.filename == str(place)
    # An open file of a process is written as it is, not replaced.
    program = "import rocking as rk; rk.Record([0.0, 1.0], 0.1).to_csv('/dev/stdout')"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == rk.Record([0.0, 1.0], 0.1).to_csv()
    # A scene does not take the place of its record.
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.Motion(kind="record", file=str(file)))
    with pytest.raises(ValueError, match=r"reads the record .*r\.csv"):
        scene.save(file)
    assert file.read_text() == whole


@pytest.mark.parametrize("files", [["r.csv"], "r.csv", {"folder": "."}, Path("r.csv")])
def test_a_sweep_over_files_is_of_the_folder_in_which_it_was_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, files: Any) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
    rk.Record([0.0, 3.0, 0.0, 0.0], 0.02).to_csv(tmp_path / "a" / "r.csv")
    monkeypatch.chdir(tmp_path / "a")
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    sweep = rk.Sweep(rk.Scene(column, rk.Motion(kind="record", file="r.csv")), {"excitation.horizontal.file": files})
    monkeypatch.chdir(tmp_path / "b")
    for own in (sweep, pickle.loads(pickle.dumps(sweep))):
        assert own.table().outcome.tolist() == ["rocks"]


def test_arguments_of_a_wrong_type_are_named():
    """NumPy and the compiled module named no argument, and read masked values, times and texts as numbers."""
    column, record = rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.Record.synthetic(1)
    masked = np.ma.masked_array([0.1, 0.2], [False, True])
    for call, told in (
        (lambda: record.spectrum(masked), "periods has masked values"),
        (lambda: rk.Ida(column, [record], "pgv", masked), "levels has masked values"),
        (lambda: rk.Scene(column, theta=masked[1:]), "masked values"),
        (lambda: rk.Ida(column, [record], "pgv", pd.to_timedelta([1], unit="s")), "levels has values of timedelta64"),
        (lambda: rk.Ida(column, [record], "pgv", ["0.3"]), "levels has values of"),
        (lambda: rk.Ida(column, [record], "pgv", None), "levels is of NoneType"),
        (lambda: record.spectrum([[0.1, 0.2], [0.3]]), "periods is not regular"),
        (lambda: record.spectrum([1.0], "a"), "damping is of str"),
        (lambda: record.measures("a"), "gravity is of str"),
        (lambda: record.trimmed("a", 1), "start is of str"),
        (lambda: rk.Record.synthetic(1, duration="x"), "duration is of str"),
        (lambda: rk.Record.read("x", units=3), "units is of int"),
        (lambda: rk.Record(bytearray(b"abc"), 0.01), "accel is of bytearray"),
        (lambda: rk.Record(pd.Series(["1.0", "2.0"]), 0.01), "accel is of str"),
        (lambda: rk.StudyRecord(3, record), "name is of int"),
        (lambda: rk.records(".", component=3), "component is of int"),
        (lambda: rk.simulate(column, wanted=3), "wanted is of int"),
        (lambda: rk.Block(width=[1], height=2), "width is of list"),
        (lambda: rk.Block(width=True, height=2), "width is of bool"),
        (lambda: rk.synthetic(5), "seeds is of int"),
    ):
        with pytest.raises((TypeError, ValueError), match=told):
            call()
    assert record.spectrum(np.array([0.5, 1.0], dtype=">f4")).shape == (2,) and rk.Record(pd.array([1, 2], dtype="Float64"), 0.01).dt == 0.01


def test_a_record_in_a_sum_has_no_keys() -> None:
    motion = rk.pulse("ricker", amplitude=1.0, omega=2.0) + rk.Record.synthetic(1, duration=4.0)
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), motion)
    with pytest.raises(ValueError, match=r"term\[2\] is a Record and has no keys; give another record"):
        scene.replace(keys={"excitation.horizontal.term[2].scale": 2.0})


def test_sums_in_a_loop_are_one_sum():
    """Each addition nested the one before: at eighty terms the text was no TOML, at 250 Python gave up."""
    wave = lambda index: rk.pulse("harmonic", amplitude=0.02, frequency=0.5 + 0.01 * index, duration=5)
    motion = wave(0)
    for index in range(1, 250):
        motion = motion + wave(index)
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    assert rk.Scene(column, motion) == rk.Scene(column, rk.total(*map(wave, range(250))))


def test_a_column_may_be_replaced_by_blocks():
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), t_end=2)
    assert len(scene.replace(column=[rk.Block(width=1, height=2)] * 2).column) == 2
    with pytest.raises(ValueError, match="Record.scaled"):
        scene.replace(horizontal=rk.Record.synthetic(1)).replace(keys={"excitation.horizontal.pga_g": 0.2})


def test_errors_beside_a_record_in_memory_name_the_line_of_the_text():
    """The lines were those of a text without the record."""
    column, record = rk.Column.prisms(1, half_width=0.4, half_height=1.6), rk.Record.synthetic(1)
    for arguments, key in (({"eta": 1.5}, "eta = 0.9"), ({"t_end": -1.0, "eta": 0.9}, "t_end = 3.0")):
        with pytest.raises(rk.SceneError) as refused:
            rk.Scene(column, record, **arguments)
        good = {**arguments, **({"eta": 0.9} if "eta = " in key else {"t_end": 3.0})}
        assert rk.Scene(column, record, **good).toml.splitlines()[refused.value.line - 1] == key


def test_a_table_of_settings_in_keys_leaves_the_other_settings() -> None:
    scene = rk.Scene(COLUMN, t_end=5, rtol=1e-7, keys={"solver": {"method": "rk4"}})
    assert scene.keys["solver"] == {"t_end": 5, "rtol": 1e-7, "method": "rk4"}
    assert scene.replace(keys={"solver": {"rtol": None}}).keys["solver"] == {"t_end": 5, "method": "rk4"}


def test_an_argument_that_is_fixed_is_named() -> None:
    with pytest.raises(TypeError, match="leave `shape` out"):
        rk.Column.drums(3, half_width=0.4, height=3, shape="prism")
    with pytest.raises(TypeError, match="no argument `rows`"):
        rk.trust(rk.Scene(COLUMN), rows=True)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="text is of int"):
        rk.Scene.from_toml(5)  # type: ignore[arg-type]


def test_motions_with_arrays_compare() -> None:
    def motion(last: float) -> rk.Motion:
        return rk.Motion(kind="record", accel=np.array([0.0, 1.0, last]), dt=0.01)

    assert motion(2.0) == motion(2.0) and motion(2.0) != motion(3.0)
    assert motion(2.0) == {"kind": "record", "accel": [0.0, 1.0, 2.0], "dt": 0.01}
    assert motion(2.0) != "record"
