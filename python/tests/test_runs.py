"""The reference runs through Python are those of the command line, to the last bit."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rocking as rk
from tables import read

SCENES = Path(__file__).resolve().parents[2] / "scenes"


@pytest.mark.parametrize("file", sorted(SCENES.glob("*.toml")), ids=lambda file: file.stem)
def test_a_run_has_the_bits_of_the_command_line(file: Path, command, tmp_path: Path) -> None:
    command("run", file, "--out", tmp_path, "--quiet", "--no-trust")
    run = rk.simulate(rk.Scene.load(file))
    rows = read(tmp_path / "response.csv")
    blocks = len(run.scene.column)
    assert run.theta.shape == (len(rows), blocks) == run.omega.shape
    pd.testing.assert_frame_equal(run.to_pandas(), rows.drop(columns="pattern"), check_exact=True)
    shown = {1: "+", 0: "0", -1: "-"}
    assert ["(" + ",".join(shown[sign] for sign in row) + ")" for row in run.pattern.tolist()] == rows.pattern.tolist()
    # Words of the file are numbers of Python, which reads them so.
    summary = json.loads((tmp_path / "summary.json").read_text().replace('"infinite"', "Infinity").replace('"-infinite"', "-Infinity"))
    # Hashes of the other files of the folder, which a run in memory has not.
    assert set(summary.pop("digests")) == {"response.csv", "events.json"}
    own = run.summary
    for one in (summary, own):
        one.pop("wall_seconds")
    assert own == summary
    events = json.loads((tmp_path / "events.json").read_text())
    assert json.loads(run.to_json())["events"] == events
    assert run.events.t.tolist() == [event["t"] for event in events]
    assert run.events.kind.tolist() == [event["kind"] for event in events]


@pytest.mark.parametrize("asked", [["relative"], ["top"], ["top", "relative"], []], ids="-".join)
@pytest.mark.parametrize("file", ["three-drums-pulse", "harmonic-with-vertical", "sliding"])
def test_columns_that_the_scene_asks_for(file: str, asked: list[str], scenes: Path, command, tmp_path: Path) -> None:
    if file == "sliding":
        column = rk.Column.prisms(2, half_width=0.4, half_height=0.8)
        scene = rk.Scene(column, rk.pulse("sine-pulse", amplitude_g=0.6, frequency=2), friction=0.2, t_end=2, output_columns=asked)
    else:
        scene = rk.Scene.load(scenes / f"{file}.toml").replace(output_columns=asked)
    scene.save(tmp_path / "scene.toml")
    command("run", tmp_path / "scene.toml", "--out", tmp_path, "--quiet", "--no-trust")
    run = rk.simulate(scene)
    made = run.to_pandas()
    pd.testing.assert_frame_equal(made, read(tmp_path / "response.csv").drop(columns="pattern"), check_exact=True)
    phi, top = [f"phi_{block + 1}" for block in range(len(run.scene.column))], ["top_x", "top_y"]
    names = {"relative": phi, "top": top}
    assert list(made.columns)[len(made.columns) - sum(len(names[name]) for name in asked) :] == [column for name in asked for column in names[name]]
    assert json.loads(run.to_json())["rows"].keys() == set(made.columns)
    data, again = run.to_xarray(), pickle.loads(pickle.dumps(run))
    assert ("phi" in data, "top" in data) == ("relative" in asked, "top" in asked)
    assert again.to_pandas().equals(made)
    if "relative" in asked:
        assert np.array_equal(data.phi.sel(block=1), made.theta_1) and np.array_equal(data.phi, made[phi]) and data.phi.units == "rad"
        assert np.array_equal(run.phi[:, 1:], np.diff(run.theta, axis=1))
    if "top" in asked:
        assert np.array_equal(data.top.sel(direction="vertical"), made.top_y) and data.top.units == "m"
        assert run.top[0].tolist() == [0.0, 0.0] and np.abs(run.top).max() > 1e-4


def test_the_folder_of_a_run_is_that_of_the_command_line(scenes: Path, command, tmp_path: Path) -> None:
    file = scenes / "two-drums-record.toml"
    command("run", file, "--out", tmp_path / "command", "--quiet")
    rk.simulate(rk.Scene.load(str(file))).write(tmp_path / "python")
    for name in ("response.csv", "events.json"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "command" / name).read_bytes()


def test_a_folder_keeps_no_figures_of_an_earlier_run(tmp_path: Path) -> None:
    """They show another run; other files stay."""
    for name in ("report.html", "time-history.svg", "forces.png", "mine.svg"):
        (tmp_path / name).write_text("earlier")
    rk.simulate(rk.Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=2).write(tmp_path)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["events.json", "mine.svg", "response.csv", "summary.json"]


def test_a_folder_names_a_file_only_for_its_own_scene(tmp_path: Path) -> None:
    file = tmp_path / "base.toml"
    file.write_text("[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 2\nomega_p = 5\n")
    base = rk.Scene.load(file)
    named = {
        "own": base,
        "changed": base.replace(eta=0.8),
        "point": rk.Sweep(base, {"amplitude_uplift": [2, 8]}).scene(1),
        "text": rk.Scene.from_toml(file.read_text()),
    }
    pages = {}
    for name, scene in named.items():
        run = rk.simulate(scene)
        run.write(tmp_path / name)
        run.report(tmp_path / f"{name}.html")
        pages[name] = (tmp_path / f"{name}.html").read_text()
    origins = {name: json.loads((tmp_path / name / "summary.json").read_text())["scene"] for name in named}
    assert {name: origin["file"] for name, origin in origins.items()} == {"own": str(file), "changed": "<scene>", "point": "<scene>", "text": "<scene>"}
    assert "# excitation.horizontal.amplitude_uplift = 8\n" in origins["point"]["text"]
    assert [name for name, page in pages.items() if "To repeat the run" in page] == ["own"]


def test_stacks_that_do_not_stand_are_drawn_in_degrees() -> None:
    blocks = [rk.Block(half_width=0.4, half_height=0.5)] * 3
    leaning = rk.simulate(rk.Scene(rk.Column(blocks), slide=[0, 0.4, 0.4], t_end=2))
    above, below = leaning.plot()
    low, high = below.get_ylim()
    assert below.get_ylabel() == "θ [°]" and -110 < low < high < 110 and low <= np.degrees(leaning.theta).clip(-90, 90).min()
    # A block that begins beyond what is drawn.
    fallen = rk.simulate(rk.Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.35], t_end=1).plot()[1]
    assert fallen.get_ylim()[0] < fallen.get_ylim()[1]


def test_a_scene_of_arguments_is_the_scene_of_the_file(scenes: Path) -> None:
    column = rk.Column.cut(3, half_width=0.4, half_height=1.56)
    motion = rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0)
    made = rk.simulate(column, motion, eta=0.9, t_end=20, rtol=1e-6)
    loaded = rk.Scene.load(scenes / "sweeps" / "column.toml").replace(keys={"column.blocks": 3})
    read = rk.simulate(loaded)
    assert np.array_equal(made.theta, read.theta) and made.impacts == read.impacts > 0


def test_without_rows_and_forces_the_motion_is_the_same(scenes: Path) -> None:
    scene = rk.Scene.load(scenes / "paper-3-blocks-3.00.toml")
    full, bare = rk.simulate(scene), rk.simulate(scene, rows=False, forces=False)
    assert bare.theta.shape == (0, 3) and bare.summary["friction_demand"] == []
    assert np.array_equal(full.peak_theta, bare.peak_theta) and full.events.equals(bare.events)
    decided = rk.simulate(scene, wanted="outcome")
    assert decided.outcome == full.outcome and len(decided.peak_theta) == 0
    with pytest.raises(ValueError, match="everything, outcome or overturns"):
        rk.simulate(scene, wanted="all")


@pytest.mark.parametrize("friction", [None, 0.9, 0.2], ids=["without friction", "sticks", "slides"])
def test_rows_at_given_times_are_those_of_an_interval(friction: float | None) -> None:
    motion = rk.pulse("ricker", amplitude_g=0.5, frequency=1.2)
    scene = rk.Scene(rk.Column.prisms(2, half_width=0.4, half_height=1.6), motion, friction=friction, t_end=6, output_dt=0.01)
    dense = rk.simulate(scene)
    chosen = np.array([0, 3, 4, 111, 250, 251, 600])
    for times in (dense.t[chosen], dense.t[chosen].tolist(), tuple(dense.t[chosen]), pd.Series(dense.t[chosen])):
        run = rk.simulate(scene, t_eval=times)
        np.testing.assert_array_equal(run.t, np.asarray(times))
        for name in ("theta", "omega", "ground", "pattern", "slide", "gap", "place", "velocity", "force"):
            own, expected = getattr(run, name), getattr(dense, name)
            assert (own is None) == (expected is None), name
            if own is not None:
                np.testing.assert_allclose(own, expected[chosen], rtol=1e-12, atol=1e-12, err_msg=name)
    assert run.impacts == dense.impacts and run.events.equals(dense.events)
    assert len(rk.simulate(run.scene, rows=False).t) == 0
    # In any direction, one takes the place of the other.
    assert run.scene.replace(output_dt=0.01) == scene and pickle.loads(pickle.dumps(run)) == run
    assert rk.Scene.from_toml(run.scene.toml) == run.scene and run.figures()["time-history"]


def test_what_contacts_ask_for_is_in_arrays() -> None:
    column = rk.Column.prisms(3, half_width=0.4, half_height=1.56)
    pulse = rk.pulse("sine-pulse", amplitude_g=0.75, omega=10.7)
    run = rk.simulate(rk.Scene.load(SCENES / "paper-3-blocks-7.18.toml").replace(title="infinite"))
    # A tensile contact asks for infinite friction: a word in the file, a number here.
    assert run.summary["title"] == "infinite" and np.isinf(run.friction_demand).any() and "infinite" not in run.summary["friction_demand"]
    assert run.friction_demand.tolist() == run.summary["friction_demand"] and run.impulse_friction_demand.shape == (3,)
    assert (run.min_normal_force < 0).any()
    slides = (run.peak_slide, run.residual_slide, run.way_slid)
    assert all(slide.tolist() == [0.0, 0.0, 0.0] for slide in slides)
    slid = rk.simulate(column, pulse, eta=0.9, friction=0.3)
    assert (slid.peak_slide >= abs(slid.residual_slide)).all() and slid.way_slid.min() > 1e-3
    displaced = rk.simulate(column, pulse, slide=[0.0, -0.05, 0.0])
    assert displaced.residual_slide.tolist() == [0.0, -0.05, 0.0] and displaced.peak_slide.tolist() == [0.0, 0.05, 0.0]
    assert not displaced.way_slid.any()
    assert np.isnan(rk.simulate(column, pulse, forces=False).friction_demand).all()


def test_rows_may_be_asked_for_up_to_the_end_that_follows_from_a_record() -> None:
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    record = rk.Record.synthetic(1, duration=40)
    run = rk.simulate(column, record, t_eval=np.arange(0, 40, 0.5))
    assert run.scene.t_end > 40 and len(run.t) == 80
    # The one fault is that of the mass, whatever the rows are.
    with pytest.raises(rk.SceneError) as refused:
        rk.simulate([{"half_width": 0.4, "half_height": 1.6, "mass": -1.0}], record, t_eval=np.arange(0, 40, 0.5))
    assert "mass" in str(refused.value) and "times" not in str(refused.value)
    with pytest.raises(rk.SceneError, match=r"output\.times.*the run lasts from 0 to"):
        rk.simulate(column, record, t_eval=[0.0, 400.0])


def test_rows_at_given_times_end_with_the_run() -> None:
    block = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    assert rk.simulate(block, theta=[0.3], t_end=9, t_eval=[0.1, 0.2, 8.5]).t.tolist() == [0.1, 0.2]
    assert rk.simulate(block, theta=[0.01], eta=0.2, t_end=9, t_eval=np.arange(10)).theta[-1].tolist() == [0.0]
    fallen = rk.simulate(block, theta=[1.0], t_end=9, t_eval=[8.0])
    assert fallen.overturned and fallen.theta.shape == (0, 1) and len(fallen.to_pandas()) == 0 and "<table>" in fallen._repr_html_()
    for drawn in (fallen.figures, fallen.plot, lambda: fallen.report("none.html")):
        with pytest.raises(ValueError, match="no rows"):
            drawn()


@pytest.mark.parametrize(
    ("times", "told"),
    [
        ([], "the list is empty"),
        (1.0, "a list of numbers"),
        ([[0.0, 1.0]], "number 1 of the list is a list"),
        ([0.0, np.nan], "NaN"),
        ([-1.0], "time 1 is -1 s"),
        ([0.0, 3.0], "the run lasts from 0 to 2 s"),
        ([1.0, 0.5], "ascending"),
        ([1.0, 1.0], "each once"),
    ],
)
def test_times_that_no_run_has_are_refused(times: object, told: str) -> None:
    with pytest.raises(rk.SceneError, match=told) as refused:
        rk.simulate(rk.Column.prisms(1, half_width=0.4, half_height=1.6), t_end=2, t_eval=times)  # type: ignore[arg-type]
    assert refused.value.key == "output.times" and refused.value.line is not None and refused.value.remedy


def test_an_interval_and_times_of_rows_exclude_each_other() -> None:
    block = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    for refuse in (lambda: rk.Scene(block, output_dt=0.1, t_eval=[0.5]), lambda: rk.Scene(block).replace(output_dt=0.1, t_eval=[0.5])):
        with pytest.raises(rk.SceneError, match="`dt` is given as well"):
            refuse()


def test_friction_brings_slides_and_places() -> None:
    column = rk.Column.prisms(2, half_width=0.4, half_height=0.8)
    motion = rk.pulse("sine-pulse", amplitude_g=0.6, frequency=2)
    run = rk.simulate(column, motion, friction=0.2, t_end=2)
    assert run.outcome == "slides" and run.slide is not None and abs(run.slide[-1, 0]) > 0.01
    assert run.place.shape == run.velocity.shape == (len(run.t), 2, 2) and run.force.shape == (len(run.t), 2, 3)
    assert np.allclose(run.place[0], [[0.0, 0.4], [0.0, 1.2]]) and np.allclose(run.force[0, :, 0].ptp() if hasattr(run.force, "ptp") else 0.0, 0.0)
    sticking = rk.simulate(column, motion.replace(amplitude_g=0.05), friction={"static": 0.9, "kinetic": [0.8, 0.7]}, t_end=1)
    assert sticking.outcome == "no-uplift" and sticking.place is None and np.all(sticking.slide == 0)
    events = run.events
    assert events.states_after[0] == "(0<,0)" and list(events.states_before[1:]) == list(events.states_after[:-1])
    assert abs(events.slide_1.iloc[-1]) > 0.01 and "states_after" not in sticking.events


def test_tables_pictures_and_pages(scenes: Path, tmp_path: Path) -> None:
    run = rk.simulate(rk.Scene.load(scenes / "three-drums-pulse.toml"))
    table, data = run.to_pandas(), run.to_xarray()
    assert list(table.columns)[:4] == ["t", "theta_1", "theta_2", "theta_3"]
    assert np.array_equal(data.theta.sel(block=2), table.theta_2) and data.theta.units == "rad"
    above, below = run.plot()
    assert len(below.lines) == 4 and "θ / α" in below.get_ylabel() and len(above.lines) == 1
    assert run._repr_svg_().startswith("<svg") and "impacts" in run._repr_html_()
    assert set(run.figures()) == {"time-history", "phase-portrait", "energy", "forces", "slides"}
    run.report(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text()
    assert page.startswith("<!") and run.scene.title in page
    empty = rk.simulate(run.scene, rows=False)
    assert empty._repr_svg_() is None and "rocks" in empty._repr_html_()
    with pytest.raises(ValueError, match="rows=True"):
        empty.plot()
    for time in (0.0, 0.5):
        above, below = rk.simulate(run.scene, t_eval=[time]).plot()
        low, high = below.get_xlim()
        assert low <= time < high and all(line.get_marker() == "." for line in below.lines[:3])


def test_the_page_is_that_of_the_command_line(scenes: Path, command, tmp_path: Path) -> None:
    file = scenes / "five-drums-free.toml"
    run = rk.simulate(rk.Scene.load(str(file)))
    run.write(tmp_path / "folder")
    command("report", tmp_path / "folder", "--out", tmp_path / "command.html")
    run.report(tmp_path / "python.html")
    assert (tmp_path / "python.html").read_bytes() == (tmp_path / "command.html").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["sweep", "sweep.toml", "--out", "t.parquet"], "t.parquet"),
        (["merge", "t.parquet", "1.csv"], "t.parquet"),
        (["plot", "1.parquet"], "1.parquet"),
        (["record", "r", "--plot", "r.pdf"], "PDF needs a build with `--features pdf`"),
    ],
)
def test_a_build_without_parquet_and_pdf_says_how_to_get_them(arguments: list[str], told: str, tmp_path: Path) -> None:
    """The wheel is such a build; CI tests the command line with both."""
    (tmp_path / "s.toml").write_text("[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n")
    (tmp_path / "sweep.toml").write_text('scene = "s.toml"\n[axes]\neta = [0.8, 0.9]\n')
    (tmp_path / "1.parquet").write_text("PAR1")
    run = subprocess.run([sys.executable, "-m", "rocking", *arguments], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 2 and told in run.stderr and "--features p" in run.stderr, run.stderr
    assert sorted(file.name for file in tmp_path.iterdir()) == ["1.parquet", "s.toml", "sweep.toml"]


def test_impacts_of_a_run_that_ends_early_are_not_counted(tmp_path: Path):
    """They were 0 where the whole run has 65."""
    column, motion = rk.Column.drums(2, diameter=0.8, height=3.2, density=2500), rk.pulse("ricker", amplitude_g=0.3, period=0.6)
    assert rk.simulate(column, motion, eta=0.9).impacts == 65
    run = rk.simulate(column, motion, eta=0.9, wanted="outcome")
    assert "impact" not in repr(run)
    for call in (lambda: run.impacts, lambda: run.write(tmp_path / "run")):
        with pytest.raises(ValueError, match="without `wanted`"):
            call()


def test_a_data_set_has_places_and_forces_of_sliding_blocks():
    column = rk.Column.drums(2, diameter=0.8, height=3.2, density=2500)
    run = rk.simulate(column, rk.pulse("ricker", amplitude_g=0.5, period=0.6), friction=0.3)
    data, table = run.to_xarray(), run.to_pandas()
    assert data.place.sel(direction="horizontal", block=2).values.tolist() == table.x_2.tolist()
    assert data.normal.sel(block=1).values.tolist() == table.normal_1.tolist()
    for array in (run.alpha, rk.Record.synthetic(1).accel):
        with pytest.raises(ValueError, match="read-only"):
            array *= 2


def test_the_text_of_a_scene_with_a_record_in_memory_is_no_scene_without_it() -> None:
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.3, half_height=1.5), rk.Record.synthetic(1, pga=4.0))
    text = rk.simulate(scene).summary["scene"]["text"]
    with pytest.raises(rk.SceneError, match="Scene.toml has them"):
        rk.Scene.from_toml(text)
    assert rk.simulate(rk.Scene.from_toml(scene.toml)).outcome == "rocks"


def test_a_pickle_whose_sliding_lacks_a_list_is_refused() -> None:
    column = rk.Column.prisms(2, half_width=0.4, half_height=1.6)
    run = rk.simulate(rk.Scene(column, rk.Record.synthetic(1, duration=2, pga=5.0), friction=0.3, t_end=1))
    damaged = pickle.dumps(run).replace(b'"flights":', b'"flightz":')
    with pytest.raises(ValueError, match="damaged"):
        pickle.loads(damaged)


def test_peaks_are_those_of_the_summary_and_of_tables() -> None:
    """A stack that leans beyond its support has a slenderness below zero, and is past its balance from the start."""
    column = rk.Column([rk.Block(width=1.0, height=1.0, density=2000)] * 3)
    run = rk.simulate(column, rk.pulse("half-sine", amplitude=1.0, omega=5.0), friction=0.8, slide=[0.0, 0.4, 0.4], t_end=0.5)
    assert (run.alpha < 0).any()
    shares = run.summary["peaks"]
    assert run.peaks.tolist() == shares and np.isinf(run.peaks).tolist() == (run.alpha < 0).tolist()
    assert "-" not in re.search(r"largest \|θ\|/α.*?<td[^>]*>([^<]*)</td>", run._repr_html_())[1]
    assert rk.simulate(run.scene, wanted="outcome").peaks.shape == (0,)


def test_slides_of_a_run_without_rows_have_their_shape() -> None:
    column = rk.Column.prisms(2, half_width=0.4, half_height=1.0)
    run = rk.simulate(column, rk.pulse("half-sine", amplitude=8.0, omega=5.0), friction=0.3, t_end=1.0, rows=False)
    assert run.slide.shape == run.gap.shape == (0, 2)
    assert rk.simulate(run.scene, rows=False, friction=None).slide is None


def test_events_have_all_that_events_json_has() -> None:
    column = rk.Column.prisms(3, half_width=0.4, half_height=1.56)
    run = rk.simulate(column, rk.pulse("sine-pulse", amplitude=7.4, omega=10.7), friction=0.3, eta=0.9, t_end=2.0)
    events = json.loads(run.to_json())["events"]
    assert len(events) == len(run.events) > 5 and any("interfaces" in event for event in events)
    for (_, row), event in zip(run.events.iterrows(), events):
        changed = event.get("interfaces") or ([event["interface"]] if "interface" in event else [])
        assert ("" if pd.isna(row.interfaces) else row.interfaces) == " ".join(map(str, changed))
        for number, block in enumerate(event["blocks"], start=1):
            assert [row[f"x_{number}"], row[f"y_{number}"]] == block["place"]
            assert [row[f"vx_before_{number}"], row[f"vy_before_{number}"]] == block["velocity_before"]
            assert [row[f"vx_after_{number}"], row[f"vy_after_{number}"]] == block["velocity_after"]
        for number, impulse in enumerate(event.get("impulses", []), start=1):
            assert row[f"moment_impulse_{number}"] == impulse["moment"]


def test_results_of_a_run_cannot_be_set() -> None:
    run = rk.simulate(rk.Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=1, output_dt=0.5)
    for name in ("t", "theta", "peaks", "pattern"):
        with pytest.raises(AttributeError, match=f"{name} of a run is a result"):
            setattr(run, name, np.zeros((1, 1)))
    assert run.theta.shape == (3, 1) and run.theta is run.theta
    assert run.to_pandas().shape[0] == 3


def test_folders_of_runs_are_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = rk.simulate(rk.Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=1)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="folder is empty"):
        run.write("")
    assert list(tmp_path.iterdir()) == []
    run.write(os.fsencode(tmp_path / "run"))
    assert (tmp_path / "run" / "summary.json").is_file()


def test_an_outcome_needs_no_memory_for_rows() -> None:
    column = rk.Column.prisms(1, half_width=0.4, half_height=1.6)
    long = rk.Record(np.sin(np.arange(500_000) * 0.02) * 0.5, 0.01)
    assert rk.simulate(column, long, wanted="outcome", eta=0.9).outcome == "no-uplift"
    with pytest.raises(rk.SceneError, match="too many for the memory"):
        rk.simulate(column, long, eta=0.9)
