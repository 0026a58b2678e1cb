//! Bad input ends with status 2 and names file, line, key and remedy; nothing is written.

use crate::common::sweeps::{SWEEP, folder};
use crate::common::{Folder, failed};

const SCENE: &str = "[[block]]
half_width = 0.4
half_height = 1.6
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude = 3.0
omega = 10.0
[solver]
t_end = 1.0
";

const AT2: &str = "OWN NUMBERS\nNOWHERE\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .01 SEC\n";

/// Runs a scene that must be refused; the message must hold all of `named`.
fn refused(scene: &str, named: &[&str]) {
    let folder = Folder::with("scene.toml", scene);
    folder.write("word.AT2", format!("{AT2} .1 .2 x3 .4\n"));
    folder.write("short.AT2", format!("{AT2} .1 .2 .3\n"));
    let output = folder.rocking("run scene.toml --out out");
    failed(&output, 2, scene, &[&["scene.toml"], named].concat());
    assert!(!folder.has("out"), "something was written for\n{scene}");
}

/// The scene with one line replaced.
fn with(line: &str, by: &str) -> String {
    assert!(SCENE.contains(line));
    SCENE.replace(line, by)
}

fn record(keys: &str) -> String {
    with("kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0", &format!("kind = \"record\"\n{keys}"))
}

/// A file of one kind that is given for another says what it is, and what takes it.
#[test]
fn files_of_another_kind() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("table.csv", "index,outcome,impacts\n0,rocks,1\n");
    folder.write("word.AT2", format!("{AT2} .1 .2 .3 .4\n"));
    folder
        .refused("report table.csv", &["table.csv", "this is a file", "give the folder of the run", "`rocking plot`"]);
    for command in ["plot scene.toml", "fragility scene.toml"] {
        folder.refused(command, &["scene.toml", "this is a TOML file and no table", "`rocking sweep`"]);
    }
    folder.refused("run word.AT2", &["word.AT2, line 1", "not TOML", "joined by `=`", "`rocking record`"]);
}

#[test]
fn cycles_of_a_type_c() {
    for cycles in ["0", "1000001", "4294967296"] {
        let scene = with("kind = \"sine-pulse\"", &format!("kind = \"type-c\"\ncycles = {cycles}"));
        refused(&scene, &["cycles", &format!("{cycles} is out of range"), "whole number"]);
    }
}

#[test]
fn no_blocks() {
    let (_, rest) = SCENE.split_once("half_height = 1.6\n").expect("the block comes first");
    refused(rest, &["line 1", "`block`", "[[block]]"]);
}

#[test]
fn sizes_that_no_block_has() {
    for (value, problem) in
        [("0.0", "out of range"), ("-0.4", "out of range"), ("inf", "not finite"), ("nan", "not finite")]
    {
        let scene = with("half_width = 0.4", &format!("half_width = {value}"));
        refused(&scene, &["line 2", "`block[1].half_width`", problem, "give a finite number"]);
    }
    refused(&with("half_width = 0.4\n", ""), &["line 1", "half_width", "missing", "give it in m"]);
    refused(&with("half_height = 1.6", "half_height = 1.6\nmass = -1"), &["line 4", "mass", "above zero"]);
}

#[test]
fn unknown_keys_and_kinds() {
    refused(&with("t_end = 1.0", "t_ned = 1.0"), &["line 9", "`solver.t_ned`", "unknown", "did you mean `t_end`?"]);
    refused(&with("omega = 10.0", "omga = 10.0"), &["line 7", "omga", "unknown", "did you mean `omega`?"]);
    refused(&with("[solver]", "[zzz]"), &["line 8", "`zzz`", "unknown", "known here are", "or remove it"]);
    // Keys of another table of the scene.
    refused(&format!("t_end = 2.0\n{SCENE}"), &["line 1", "`t_end`", "unknown", "write it below [solver]"]);
    refused(&with("t_end = 1.0", "dt = 0.1"), &["line 9", "`solver.dt`", "unknown", "write it below [output]"]);
    refused(&with("t_end = 1.0", "eta = 0.9"), &["line 9", "`solver.eta`", "write it below [restitution]"]);
    let in_block = with("half_width = 0.4", "half_width = 0.4\nt_end = 1.0");
    refused(&in_block, &["line 3", "`block[1].t_end`", "write it below [solver]"]);
    refused(
        &with("omega = 10.0", "omega = 10.0\ndt = 0.1"),
        &["line 8", "`excitation.horizontal.dt`", "known here are"],
    );
    // Names that the field has for keys, and keys in capitals.
    refused(&format!("mu = 0.7\n{SCENE}"), &["line 1", "`mu`", "did you mean `friction`?"]);
    refused(&format!("g = 9.81\n{SCENE}"), &["line 1", "`g`", "did you mean `gravity`?"]);
    refused(&with("t_end = 1.0", "duration = 1.0"), &["line 9", "`solver.duration`", "did you mean `t_end`?"]);
    refused(&with("half_height = 1.6", "heigth = 2.0"), &["heigth", "did you mean `height`?"]);
    refused(&with("half_width = 0.4", "half_width = 0.4\nweight = 2.0"), &["weight", "did you mean `mass`?"]);
    refused(&with("omega = 10.0", "OMEGA = 10.0"), &["line 7", "OMEGA", "did you mean `omega`?"]);
    refused(&with("sine-pulse", "sinus"), &["line 5", "kind", "`sinus`", "choose one of sine-pulse"]);
    refused(&with("\"sine-pulse\"", "\"a\\nall is well\""), &["line 5", "there is no kind `a\\nall is well`"]);
}

#[test]
fn columns_that_are_no_list_or_stand_twice() {
    let output = |columns: &str| format!("{SCENE}[output]\ncolumns = {columns}\n");
    refused(&output("{ top = true }"), &["line 11", "`output.columns`", "a table stands here", "a list of names"]);
    refused(&output("[\"top\", \"top\"]"), &["line 11", "`output.columns`", "`top` stands there twice"]);
}

/// The file has no such sizes: they come of `[size]`.
#[test]
fn sizes_that_no_column_can_be_scaled_to() {
    for (key, value) in [("p", "1e-200"), ("R", "1e300"), ("R", "1e-12"), ("rocking_period", "1e9"), ("alpha", "1e-30")]
    {
        let size = format!("{SCENE}[size]\n{key} = {value}\n");
        refused(&size, &["line 11", &format!("`size.{key}`"), "multiplies the sizes", "1e-7 to 1e6 m"]);
    }
}

/// The key at fault is named as the file has it.
#[test]
fn sizes_beyond_doubles_name_their_own_key() {
    let scene = |sizes: &str| format!("[column]\nblocks = 2\n{sizes}");
    refused(&scene("width = 0.8\nhalf_height = 1e308\n"), &["line 4", "`column.half_height`"]);
    refused(&scene("height = 1.6\nshape = \"drum\"\ndiameter = 1e308\n"), &["line 5", "`column.diameter`"]);
    refused("[[block]]\nhalf_width = 0.4\nhalf_height = 1e308\n", &["line 3", "half_height"]);
    let tapered = "[[block]]\nbottom_half_width = 0.4\ntop_half_width = 1e200\nhalf_height = 1.0\n";
    refused(tapered, &["line 3", "top_half_width"]);
}

#[test]
fn contradictory_keys() {
    let both = with("amplitude = 3.0", "amplitude = 3.0\namplitude_g = 0.3");
    refused(&both, &["line 7", "amplitude_g", "`amplitude` is given as well", "remove one"]);
    let both = with("omega = 10.0", "omega = 10.0\nperiod = 1.0");
    refused(&both, &["line 8", "period", "`omega` is given as well", "remove one"]);
    refused(&format!("{SCENE}[column]\nblocks = 2\n"), &["line 10", "column", "one way"]);
}

#[test]
fn records() {
    refused(&record("file = \"no.AT2\""), &["no.AT2", "line 6", "file", "relative to the file that names it"]);
    refused(&record("file = \"word.AT2\""), &["word.AT2", "line 5, column 8", "`x3`", "mend or remove"]);
    refused(&record("file = \"short.AT2\""), &["short.AT2", "line 4", "declares 4", "has 3", "NPTS"]);
    refused(&record("accel = [0.1, 0.2]"), &["`excitation.horizontal.dt`", "missing", "sampling interval"]);
    refused(&record("accel = [0.1, \"x\"]\ndt = 0.1"), &["line 6", "accel", "number 2", "finite numbers"]);
}

#[test]
fn options_out_of_range() {
    refused(&with("t_end = 1.0", "t_end = -1.0"), &["line 9", "`solver.t_end`", "-1", "above zero"]);
    refused(&with("t_end = 1.0", "t_end = 1.0\nrtol = 0.0"), &["line 10", "`solver.rtol`", "above zero"]);
    refused(&with("t_end = 1.0", "t_end = 1.0\natol = -1e-9"), &["line 10", "`solver.atol`", "above zero"]);
    refused(
        &with("t_end = 1.0", "t_end = 1.0\nmethod = \"euler\""),
        &["line 10", "method", "choose one of auto, dop853"],
    );
}

#[test]
fn restitution_and_initial_state() {
    refused(
        &format!("{SCENE}[restitution]\nfactors = [1.0, 1.0]\n"),
        &["line 11", "`restitution.factors`", "one per interface"],
    );
    for eta in ["-0.1", "1.1"] {
        refused(&format!("{SCENE}[restitution]\neta = {eta}\n"), &["line 11", "`restitution.eta`", eta, "from 0 to 1"]);
    }
    refused(&format!("{SCENE}[initial]\ntheta = [0.1, 0.2]\n"), &["line 11", "`initial.theta`", "one per block"]);
}

/// Two equal drums; tables may follow.
const DRUMS: &str = "[column]
blocks = 2
half_width = 0.4
half_height = 1.6
[solver]
t_end = 1.0
";

#[test]
fn sizes_are_named_by_the_key_that_gives_them() {
    let beside = "half_width = 0.4\nbottom_width = 0.8\ntop_width = 0.6";
    let named = ["line 2", "`block[1].half_width`", "`bottom_width` and `top_width` are given as well", "remove it"];
    refused(&with("half_width = 0.4", beside), &named);
    let pointed =
        "[[block]]\nhalf_width = 0.4\nhalf_height = 1.0\n[[block]]\nbottom_width = 0.8\ntop_width = 0\nheight = 2.0\n";
    refused(&format!("{pointed}{SCENE}"), &["line 6", "`block[2].top_width`", "leaves no width to stand on"]);
    let too_strong = with(
        "kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0",
        "kind = \"synthetic\"\nseed = 1\nduration = 5.0\npga_g = 4e5",
    );
    refused(&too_strong, &["line 8", "`excitation.horizontal.pga_g`", "out of range"]);
    refused(
        &record("dt = 0.01\naccel = [0.0, 1e12, 0.0]"),
        &["line 7", "`excitation.horizontal.accel`", "out of range"],
    );
    let damped = "file = \"short.AT2\"\nlenient = true\npga = 3.0\nsa_damping = 0.1";
    refused(
        &record(damped),
        &["line 9", "`excitation.horizontal.sa_damping`", "nothing is scaled to `sa`", "remove it"],
    );
}

#[test]
fn friction_that_no_contact_has() {
    let number = |value: &str| format!("friction = {value}\n{DRUMS}");
    refused(&number("-0.1"), &["line 1", "`friction`", "-0.1 is out of range", "from zero to 1e8"]);
    refused(&number("1e300"), &["line 1", "1e300 is out of range"]);
    refused(&number("nan"), &["line 1", "`friction`", "not finite", "give a finite number"]);
    refused(&number("inf"), &["line 1", "`friction`", "not finite", "give a finite number"]);
    refused(&number("\"rough\""), &["line 1", "`friction`", "text stands here", "give a number"]);
    let table = |keys: &str| format!("{DRUMS}[friction]\n{keys}\n");
    refused(&table("static = 0.5\nkinetic = -0.5"), &["line 9", "`friction.kinetic`", "-0.5 is out of range"]);
    refused(&table("static = [0.5, nan]"), &["line 8", "`friction.static`", "NaN", "give finite numbers"]);
    refused(
        &table("static = 0.5\nkinetic = 0.6"),
        &["line 9", "`friction.kinetic`", "0.6 is above the static coefficient, 0.5, of interface 1", "no larger than"],
    );
    refused(&table("static = 0.5\nkinetic = [0.5, 0.6]"), &["line 9", "0.6 is above", "interface 2"]);
    for list in ["[]", "[0.5, 0.4, 0.3]"] {
        let scene = table(&format!("static = {list}"));
        refused(
            &scene,
            &["line 8", "`friction.static`", "number(s) for 2 interface(s)", "one per interface, base first"],
        );
    }
    refused(&table("static = 0.5\nkinetic = [0.5, 0.4, 0.3]"), &["line 9", "`friction.kinetic`", "one per interface"]);
    refused(&table("kinetic = 0.3"), &["line 7", "`friction.static`", "it is missing", "write friction = 0.7"]);
    refused(&table("static = 0.4\nkinetik = 0.3"), &["line 9", "`friction.kinetik`", "did you mean `kinetic`?"]);
}

#[test]
fn drums_that_do_not_stand_on_each_other() {
    let initial = |keys: &str| format!("{DRUMS}[initial]\n{keys}\n");
    for slide in ["0.9", "-0.8"] {
        let scene = initial(&format!("slide = [0.0, {slide}]"));
        refused(
            &scene,
            &["line 8", "`initial.slide`", slide, "block 2 off its support", "0.8 m", "leave the faces some overlap"],
        );
    }
    refused(
        &initial("slide = [0.0]"),
        &["line 8", "`initial.slide`", "1 slide(s) for 2 interface(s)", "one slide per interface"],
    );
    refused(&initial("slide = [0.0, nan]"), &["line 8", "`initial.slide`", "NaN", "give finite numbers"]);
    refused(&initial("slide = [1e7, 0.0]"), &["line 8", "`initial.slide`", "1e7 m", "out of range", "up to 1e6 m"]);
}

#[test]
fn tapered_blocks_of_no_width() {
    let block = |keys: &str| format!("[[block]]\n{keys}\nhalf_height = 1.6\n");
    let both = "give a finite number above zero";
    refused(&block("bottom_half_width = 0.0\ntop_half_width = 0.3"), &["line 2", "`block[1].bottom_half_width`", both]);
    refused(
        &block("bottom_half_width = -0.4\ntop_half_width = 0.3"),
        &["line 2", "`block[1].bottom_half_width`", both],
    );
    refused(
        &block("bottom_half_width = 0.4\ntop_half_width = -0.1"),
        &["line 3", "`block[1].top_half_width`", "out of range"],
    );
    refused(
        &block("bottom_half_width = 0.4"),
        &["line 1", "`block[1].top_half_width`", "it is missing", "half_width for both"],
    );
}

/// A width of one side replaces the one that is given for both.
#[test]
fn a_width_of_both_sides_may_stand_beside_that_of_one() {
    let block = |keys: &str| format!("[[block]]\n{keys}\nhalf_height = 1.0\nmass = 10.0\n[solver]\nt_end = 1.0\n");
    for [short, long] in [
        ["half_width = 0.5\nbottom_half_width = 0.6", "bottom_half_width = 0.6\ntop_half_width = 0.5"],
        ["half_width = 0.5\ntop_half_width = 0.4", "bottom_half_width = 0.5\ntop_half_width = 0.4"],
    ] {
        let read = |keys| rocking::Scene::from_toml(&block(keys), "scene.toml".as_ref()).expect("a valid scene").column;
        assert_eq!(read(short), read(long), "{short}");
    }
}

#[test]
fn densities_of_side_views_beside_those_of_solids() {
    let drum = "[[block]]\nwidth = 0.9\nheight = 1.0\nshape = \"drum\"\n";
    let prism = |keys: &str| format!("[[block]]\nwidth = 0.5\nheight = 1.8\n{keys}[solver]\nt_end = 1.0\n");
    let [depth, remedy] = ["`block[2].depth`", "give the depth of the block in m, or its mass"];
    refused(
        &format!("{drum}{}", prism("density = 2700.0\n")),
        &["line 5", depth, "`block[1].mass` is of a solid", remedy],
    );
    refused(&format!("{drum}depth = 0.9\n{}", prism("")), &["line 5", "`block[1].depth`", "shape = \"prism\""]);
}

#[test]
fn drums_that_are_thrown_by_halves() {
    let thrown = |keys: &str| format!("friction = 0.5\n{DRUMS}[initial]\n{keys}\n");
    let all = "x = [0.0, 0.0]\ny = [0.9, 2.6]\nvx = [0.0, 0.0]\nvy = [0.0, 0.0]";
    refused(
        &thrown("x = [0.0, 0.0]"),
        &["line 8", "`initial.y`", "missing beside initial.x", "give x, y, vx and vy together"],
    );
    refused(&thrown("vy = [0.0, 0.0]"), &["line 8", "`initial.x`", "missing beside initial.vy"]);
    refused(
        &thrown(&all.replace("y = [0.9, 2.6]", "y = [0.9]")),
        &["line 10", "`initial.y`", "1 number(s) for 2 block(s)"],
    );
    refused(&thrown(&all.replace("2.6", "nan")), &["line 10", "`initial.y`", "NaN", "give finite numbers"]);
    let without = thrown(all).replace("friction = 0.5\n", "");
    refused(
        &without,
        &["line 8", "`initial.x`", "without friction, blocks stand on each other", "give friction, or leave it out"],
    );
}

#[test]
fn types_and_syntax() {
    refused(&with("omega = 10.0", "omega = \"ten\""), &["line 7", "omega", "text stands here", "give a number"]);
    refused(&with("omega = 10.0", "omega = true"), &["line 7", "omega", "give a number"]);
    refused(&with("omega = 10.0", "omega = "), &["line 7", "omega", "not TOML", "correct the line"]);
    refused(&with("omega = 10.0", "omega = 10.0\nomega = 11.0"), &["line 8", "omega", "duplicate"]);
    refused(&with("omega = 10.0", "omega = 10,0"), &["line 7", "omega", "decimals have a point"]);
    refused("[block]\nhalf_width = 0.3\n[block]\nhalf_width = 0.2\n", &["line 3", "duplicate", "[[block]]"]);
    refused("title = \"C:\\Users\"\n", &["line 1", "single quotes"]);
    refused(
        "[[block]]\nhalf_widht = 0.8\nheight = 1.0\n",
        &["line 2", "block[1].half_widht", "did you mean `half_width`"],
    );
}

#[test]
fn a_scene_that_is_not_there_or_not_text() {
    let folder = Folder::new();
    folder.refused("run scene.toml --out out", &["scene.toml"]);
    folder.write("scene.toml", b"title = \"\xff\"\n");
    folder.refused("run scene.toml --out out", &["line 1 is not UTF-8"]);
}

#[test]
fn all_values_out_of_range_are_named_at_once() {
    let scene = with("t_end = 1.0", "t_end = -1.0\nrtol = 10.0").replace("amplitude = 3.0", "amplitude = 1e300");
    refused(
        &scene,
        &["line 9", "`solver.t_end`", "line 10", "`solver.rtol`", "line 6", "`excitation.horizontal.amplitude`"],
    );
}

#[test]
fn numbers_out_of_all_range() {
    refused(&with("amplitude = 3.0", "amplitude = 1e300"), &["line 6", "amplitude", "1e300", "out of range"]);
    refused(&with("amplitude = 3.0", "amplitude_g = 1e308"), &["excitation.horizontal.amplitude", "out of range"]);
    refused(
        &with("half_width = 0.4\nhalf_height = 1.6", "half_width = 1e-200\nhalf_height = 1e-200"),
        &["line 2", "`block[1].half_width`", "range of doubles"],
    );
    refused(&with("t_end = 1.0", "t_end = 1e-14"), &["line 9", "`solver.t_end`", "too short"]);
    refused(&with("t_end = 1.0", "t_end = 1e9"), &["output.dt", "too many", "larger value"]);
    refused(&with("t_end = 1.0", "t_end = 1.0\nrtol = 10.0"), &["line 10", "`solver.rtol`", "too loose"]);
    refused(&record("accel = [0.0, 10.0, 0.0]\ndt = 0.1\nscale = 1e308"), &["line 8", "scale", "finite"]);
    refused(&record("accel = [0.0, 1.0]\ndt = 1e-15"), &["line 7", "dt", "out of range"]);
    refused(&format!("{SCENE}[initial]\ntheta = []\n"), &["line 11", "`initial.theta`", "one per block"]);
}

#[test]
fn times_of_rows_that_no_run_has() {
    let output = |keys: &str| format!("{SCENE}[output]\n{keys}\n");
    let refused = |keys: &str, named: &[&str]| {
        refused(&output(keys), &[named, &["line 11", "`output.times`"]].concat());
    };
    refused("times = []", &["the list is empty", "give times in s"]);
    refused("times = 0.5", &["a list of numbers"]);
    refused("times = [0.0, \"one\"]", &["number 2 of the list is text", "finite"]);
    refused("times = [0.0, nan]", &["number 2 of the list is NaN", "finite"]);
    refused("times = [0.0, 1.5]", &["time 2 is 1.5 s", "from 0 to 1 s", "let solver.t_end be later"]);
    refused("times = [-0.5, 0.5]", &["time 1 is -0.5 s", "give times within the run"]);
    refused("times = [0.5, 0.25]", &["time 2 is 0.25 s, after 0.5 s", "ascending"]);
    refused("times = [0.5, 0.5]", &["time 2 is 0.5 s, after 0.5 s", "each once"]);
    refused("times = [0.5]\ndt = 0.1", &["`dt` is given as well", "remove one of the two"]);
}

#[cfg(unix)]
#[test]
fn only_regular_files_up_to_a_size_are_read() {
    let folder = folder(SWEEP);
    let pipe = std::process::Command::new("mkfifo").arg(folder.path("pipe")).status();
    assert!(pipe.is_ok_and(|status| status.success()));
    let large = std::fs::File::create(folder.path("large")).expect("made");
    large.set_len(1 << 41).expect("a sparse file");
    folder.succeeds("run base.toml");
    for (file, problem) in [("/dev/zero", "device or a pipe"), ("pipe", "device or a pipe"), ("large", "at most")] {
        for arguments in [
            "run",
            "check",
            "thresholds",
            "sweep",
            "plot",
            "record",
            "init new.toml --record",
            "merge m.csv",
            "merge m.csv sweep.csv --sweep",
        ] {
            folder.refused(&format!("{arguments} {file}"), &[file, problem]);
        }
    }
    folder.remove("out/events.json");
    folder.link("/dev/zero", "out/events.json");
    for command in ["plot", "report"] {
        folder.refused(&format!("{command} out"), &["events.json", "device or a pipe", "run the scene again"]);
    }
}

/// A base scene is read as any scene is: no device, nothing without end. One that is missing is a fault of the key that names it.
#[test]
fn base_scenes_are_regular_files_and_named_by_their_key() {
    let folder = folder("scene = \"no.toml\"\n[axes]\neta = [0.9]\n");
    folder.write("study.toml", "scene = \"no.toml\"\nmeasure = \"pga\"\n");
    for file in ["sweep.toml", "study.toml"] {
        let named = [file, "line 1", "`scene`", "no.toml: No such file", "relative to this file"];
        folder.refused(&format!("check {file}"), &named);
    }
    if cfg!(unix) {
        for file in ["sweep.toml", "study.toml"] {
            let text = folder.read(file).replace("no.toml", "/dev/zero");
            folder.write(file, text);
            folder.refused(&format!("check {file}"), &[file, "`scene`", "/dev/zero: this is a device or a pipe"]);
        }
    }
}

/// Each of the three commands says which one a file is for.
#[test]
fn files_of_another_kind_are_sent_to_their_command() {
    let folder = folder(SWEEP);
    folder.write("study.toml", "scene = \"base.toml\"\nmeasure = \"pga\"\n");
    let [run, sweep, ida] = ["run --out out", "sweep", "ida --out ida.csv"];
    for (command, file, named) in [
        (run, "sweep.toml", "`rocking sweep`"),
        (run, "study.toml", "`rocking ida`"),
        (sweep, "base.toml", "`rocking run`"),
        (sweep, "study.toml", "`rocking ida`"),
        (ida, "base.toml", "`rocking run`"),
        (ida, "sweep.toml", "`rocking sweep`"),
    ] {
        folder.refused(&format!("{command} {file}"), &[file, "give it to", named]);
    }
}

/// A negative number after an option is its value, and the range of the option says what is wrong.
#[test]
fn negative_values_of_options_are_out_of_range() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("a.csv", "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n");
    for (arguments, named) in [
        ("record a.csv --pga-g -0.3", ["'-0.3'", "--pga-g"]),
        ("record a.csv --sa -1", ["'-1'", "--sa"]),
        ("plot out --width -5", ["'-5'", "--width"]),
        ("sweep scene.toml --threads -1", ["'-1'", "--threads"]),
    ] {
        let message = folder.refused(arguments, &named);
        assert!(message.contains("invalid value") && !message.contains("-- "), "{message}");
    }
    let turned = folder.succeeds("record a.csv --scale -2");
    assert!(turned.contains("PGA"), "{turned}");
}

/// `slide` and `x` both say where blocks are: the motion followed `x`, slenderness and peaks `slide`.
#[test]
fn slides_of_blocks_that_are_placed_are_refused() {
    let placed = "[initial]\nx = [0.0, 0.0]\ny = [0.78, 2.34]\nvx = [0.0, 0.0]\nvy = [0.0, 0.0]\nslide = [0.0, 0.3]\n";
    let column = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.56\n";
    let folder = Folder::with("scene.toml", &format!("{column}{placed}"));
    folder.refused("check scene.toml", &["line 11", "initial.slide", "leave it out"]);
    folder.write("scene.toml", format!("{column}{}", placed.replace("0.3]", "0.0]")));
    // Stacks and thresholds are not those of where the blocks are placed.
    for command in ["check scene.toml", "thresholds scene.toml"] {
        let told = folder.succeeds(command);
        assert!(told.contains("x and y place the blocks; stacks,"), "{told}");
    }
}

/// A sampling interval is at fault, not the samples; a sum within a sum is headed as TOML has it.
#[test]
fn keys_of_ground_motions_are_blamed_and_headed_rightly() {
    let block = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.5\n[excitation.horizontal]\n";
    let folder = Folder::with("scene.toml", &format!("{block}kind = \"record\"\naccel = [0, 1, 0]\ndt = 1.5e6\n"));
    folder.refused("check scene.toml", &["line 7", "`excitation.horizontal.dt`", "above 1e-9 s, up to 1e6"]);
    let sum = format!("{block}kind = \"sum\"\n[[excitation.horizontal.term]]\nkind = \"sum\"\n");
    folder.write("scene.toml", &sum);
    folder.refused("check scene.toml", &["add [[excitation.horizontal.term.term]] for each"]);
    let term = "kind = \"ricker\"\namplitude_g = 0.3\nperiod = 1.0\n";
    folder.write("scene.toml", format!("{sum}[[excitation.horizontal.term.term]]\n{term}"));
    folder.succeeds("check scene.toml");
}

#[test]
fn a_kind_that_is_misspelt_is_guessed() {
    let folder = Folder::new();
    folder.succeeds("init");
    let text = folder.read("scene.toml");
    for (kind, guess) in
        [("antisymetric-ricker", "antisymmetric-ricker"), ("sine_pulse", "sine-pulse"), ("gabour", "gabor")]
    {
        folder.write("scene.toml", text.replace("\"sine-pulse\"", &format!("\"{kind}\"")));
        folder.refused("check scene.toml", &[&format!("did you mean `{guess}`?")]);
    }
}

/// A fault is shown with its lines also beside a record whose samples stand in one long line.
#[test]
fn a_long_line_elsewhere_hides_no_fault() {
    let samples = vec!["0.125"; 1000].join(", ");
    let scene = |below: &str| {
        format!(
            "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"record\"\n\
             accel = [{samples}]\ndt = 0.01\n\n{below}"
        )
    };
    refused(&scene("[solver]\nt_endd = 5.0\n"), &["line 11", "did you mean `t_end`?", "t_endd = 5.0", "here"]);
    // Beside the long line itself there is no excerpt.
    refused(&scene("").replace("dt = 0.01", "dtt = 0.01"), &["line 8", "did you mean `dt`?"]);
    let folder = Folder::with("scene.toml", &scene("").replace("dt = 0.01", "dtt = 0.01"));
    let told = String::from_utf8(folder.rocking("run scene.toml").stderr).expect("text");
    assert!(told.len() < 1000, "{told}");
}
