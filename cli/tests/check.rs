//! `rocking check` and `rocking thresholds` say what a scene or a sweep is before it is run.

use crate::common::sweeps::{BASE, SWEEP, folder};
use crate::common::{Folder, assert_has, project};
use serde_json::Value;

#[test]
fn a_sweep_file_is_checked_as_a_sweep() {
    let folder = folder(SWEEP);
    let text = folder.succeeds("check sweep.toml");
    assert_has(
        &text,
        &["60 point(s)", "blocks: 2 value(s), from 1 to 2", "base.toml is valid", "rocking sweep sweep.toml"],
    );
    let found = folder.answers("check sweep.toml --json");
    assert_eq!((&found["points"], found["axes"].as_array().map(Vec::len)), (&60.into(), Some(3)));
    folder.write("base.toml", BASE.replace("eta = 0.9", "eta = 9"));
    folder.refused("check sweep.toml", &["base.toml", "restitution.eta"]);
}

/// Zeros at the end of a record are no motion that a run leaves out.
#[test]
fn zeros_at_the_end_of_a_record_are_not_called_cut() {
    let scene = |samples: &str| {
        format!(
            "[[block]]\nhalf_width = 0.3\nhalf_height = 1.5\n[excitation.horizontal]\nkind = \"record\"\naccel = [0, 3, -3, {samples}]\ndt = 1.0\n[solver]\nt_end = 13.0\n"
        )
    };
    for (sample, is_cut) in [("0, ", false), ("1, ", true)] {
        let folder = Folder::with("scene.toml", &scene(&sample.repeat(20)));
        let told = folder.succeeds("check scene.toml");
        assert_eq!(told.contains("that is after the end of the run"), is_cut, "{told}");
    }
}

/// The column of the paper: p = 2.14 rad/s, slenderness 0.25, thresholds of its tables.
#[test]
fn a_check_explains_the_papers_column() {
    let (folder, scene) = (Folder::new(), project("scenes/paper-3-blocks-3.00.toml"));
    let text = folder.succeeds(&["check", &scene]);
    assert_has(&text, &["p = 2.14", "alpha = 0.25", "one-sine pulse", "PGA 0.75", "eta = 0.9", "response.csv"]);
    let check = folder.answers(&["check", &scene, "--json"]);
    let stacks = check["stacks"].as_array().expect("a list");
    assert_eq!(stacks.len(), 3);
    let number = |value: &Value| value.as_f64().expect("a number");
    // Housner (1963): 1 - 3/2 sin² α of a homogeneous rectangle.
    let alpha = number(&stacks[0]["slenderness"]);
    assert!((number(&stacks[0]["housner_ratio"]) - (1.0 - 1.5 * alpha.sin().powi(2))).abs() < 1e-12);
    assert_eq!(check["horizontal"]["kind"], "sine-pulse");
    // What the text says of laws and tolerances.
    assert_eq!(check["restitution"]["eta"], 0.9);
    assert!(check["friction"].is_null());
    assert_eq!((number(&check["gravity"]), number(&check["options"]["rtol"])), (9.81, 1e-9));
    // Of a one-sine pulse: 2 a / ω and 2π a / ω².
    let (a, omega) = (number(&check["horizontal"]["amplitude"]), number(&check["horizontal"]["omega"]));
    assert!((number(&check["horizontal"]["pgv"]) - 2.0 * a / omega).abs() < 1e-3 * a / omega);
    let left = number(&check["horizontal"]["left_with"][1]);
    assert!((left - std::f64::consts::TAU * a / (omega * omega)).abs() < 1e-12);
}

/// What a file leaves open is said: here density, masses, inertias and sizes of equal blocks.
#[test]
fn a_check_says_what_was_derived() {
    let scene = "[column]\nblocks = 4\nhalf_width = 0.5\nhalf_height = 2.0\nmass = 8.0\n";
    let folder = Folder::with("a.toml", scene);
    let text = folder.succeeds("check a.toml");
    assert_has(
        &text,
        &[
            "block[1..4].half_height = 0.5 m: column.half_height / 4",
            "block[1..4].mass = 2 kg: column.mass / 4",
            "block[1..4].inertia = 0.333333 kg m²",
            "does not move",
        ],
    );
    folder.write(
        "b.toml",
        "[[block]]\nhalf_width = 0.5\nhalf_height = 0.5\nmass = 2.0\ninertia = 1.0\n[solver]\nt_end = 10\n",
    );
    assert!(!folder.succeeds("check b.toml").contains("derived"));
    let check = folder.answers("check b.toml --json");
    assert_eq!(check["derived"], Value::Array(Vec::new()));
}

#[test]
fn thresholds_are_the_papers_tables_1_and_2() {
    for (scene, expected) in [
        ("paper-1-block-3.00", vec!["1.02"]),
        ("paper-2-blocks-3.00", vec!["1.02", "2.04"]),
        ("paper-3-blocks-3.00", vec!["1.02", "1.53", "3.06"]),
    ] {
        let text = Folder::new().succeeds(&["thresholds", &project(&format!("scenes/{scene}.toml"))]);
        let ratios: Vec<&str> = text.lines().skip(2).filter_map(|line| line.split_whitespace().nth(4)).collect();
        assert_eq!(ratios, expected, "{text}");
    }
}

#[test]
fn a_check_counts_the_vertical_ground_motion() {
    let folder = Folder::new();
    let scene = "friction = 5.0\n[[block]]\nhalf_width = 0.5\nhalf_height = 0.5\n\
                 [excitation.horizontal]\nkind = \"rectangular\"\namplitude_g = 0.8\nduration = 1.0\n\
                 [excitation.vertical]\nkind = \"rectangular\"\namplitude_g = -0.4\nduration = 1.0\n";
    folder.write("scene.toml", scene);
    let text = folder.succeeds("check scene.toml");
    // A cube opens at 1 g, and at 0.6 g while the ground falls at 0.4 g.
    assert!(
        text.contains("with the vertical motion it opens interface(s) 1 of the column at rest, the first at t = 0"),
        "{text}"
    );
    assert!(!text.contains("at the PGA it"), "{text}");
    // Of two blocks the base opens before the joint: 0.9 sin = 0.3 (1 + 0.1 sin), and 0.9 sin = 0.6 (1 + 0.1 sin).
    let two = "[column]\nblocks = 2\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"half-sine\"\n\
        amplitude_g = 0.9\nperiod = 4.0\n[excitation.vertical]\nkind = \"half-sine\"\namplitude_g = 0.1\nperiod = 4.0\n";
    folder.write("scene.toml", two);
    let first = (0.3f64 / 0.87).asin() * 2.0 / std::f64::consts::PI;
    let told = format!("opens interface(s) 1, 2 of the column at rest, the first at t = {first:.4} s");
    assert_has(&folder.succeeds("check scene.toml"), &[&told]);
}

/// A block of t = b/h = 1/4 (FRICTION: closed form 1): its coefficients to rock without sliding at 0.5, 1 and 2 g.
#[test]
fn a_check_says_what_slides_before_it_rocks() {
    let folder = Folder::new();
    let check = |friction: f64, amplitude: f64| {
        let scene = format!(
            "friction = {friction}\n[column]\nblocks = 1\nhalf_width = 0.25\nhalf_height = 1.0\n\
             [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = {amplitude}\nomega = 6.0\n"
        );
        folder.write("scene.toml", scene);
        let found = folder.answers("check scene.toml --json");
        (folder.succeeds("check scene.toml"), found["contacts"][0].clone())
    };
    for (amplitude, expected) in [(0.5, 0.30986), (1.0, 0.41558), (2.0, 0.58427)] {
        let (text, contact) = check(0.45, amplitude);
        // Given with five digits.
        let needed = contact["coefficient_to_rock"].as_f64().expect("a number");
        assert!((needed - expected).abs() < 5e-6, "{needed}, {expected}");
        let (verdict, words) = match expected < 0.45 {
            true => ("rocks", "rocks without sliding"),
            false => ("slides-and-rocks", "slides and rocks"),
        };
        assert_eq!(contact["at_pga"], verdict);
        assert!(text.contains("interface 1 opens at 0.25 g before it slides at 0.45 g; at the PGA it"), "{text}");
        assert!(text.contains(words), "{text}");
    }
    let (text, contact) = check(0.2, 0.5);
    assert!(text.contains("interface 1 slides at 0.2 g before it opens at 0.25 g"), "{text}");
    assert_eq!((&contact["at_pga"], contact["coefficient_to_rock"].is_null()), (&"slides".into(), true));
    assert_eq!(check(0.2, 0.1).1["at_pga"], "rests");
    // Once it slides, less kinetic friction than b/h turns it no more: the run slides with its face on the ground.
    let two = "[friction]\nstatic = 0.4\nkinetic = 0.2\n[column]\nblocks = 1\nhalf_width = 0.25\nhalf_height = 1.0\n\
               [excitation.horizontal]\nkind = \"rectangular\"\namplitude_g = 1.0\nduration = 0.3\n[solver]\nt_end = 1.0\n";
    folder.write("scene.toml", two);
    assert_eq!(folder.answers("check scene.toml --json")["contacts"][0]["at_pga"], "slides");
    assert!(folder.succeeds("check scene.toml").contains("at the PGA it slides, and rocks once it sticks"));
    folder.succeeds("run scene.toml");
    assert_eq!(folder.summary()["outcome"], "slides");
}

/// A displaced block makes one side weaker, and vertical motion changes the weight: the time of the first slide or opening decides, not a threshold.
#[test]
fn a_check_says_what_this_ground_motion_does_first() {
    let folder = Folder::new();
    let check = |scene: &str| {
        folder.write("scene.toml", scene);
        let found = folder.answers("check scene.toml --json");
        (folder.succeeds("check scene.toml"), found["contacts"][0].clone())
    };
    let displaced = |amplitude: f64| {
        format!(
            "[friction]\nstatic = [0.4, 3.0]\n[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 0.6\n[initial]\nslide = [0.0, 0.2]\n\
             [excitation.horizontal]\nkind = \"rectangular\"\namplitude_g = {amplitude}\nduration = 0.05\n"
        )
    };
    // The centroid is 0.1 m to the right: the base opens at 0.5 g to one side, and at 0.83 g to the other.
    folder.write("scene.toml", displaced(0.55));
    assert_has(
        &folder.succeeds("thresholds scene.toml"),
        &["note: blocks are displaced; each row is of the weaker side"],
    );
    let (text, contact) = check(&displaced(0.55));
    assert!(text.contains("interface 1 slides at 0.4 g, and opens, to its weaker side, at 0.5 g; under this ground motion it slides, at"), "{text}");
    assert_eq!((contact["slides_from"].as_f64(), contact["opens_from"].is_null()), (Some(0.0), true));
    let (text, contact) = check(&displaced(-0.55));
    assert_eq!((contact["slides_from"].as_f64(), contact["opens_from"].as_f64()), (Some(0.0), Some(0.0)));
    assert!(
        contact["at_pga"].is_null() && text.contains("under this ground motion it passes both at t = 0.0000 s"),
        "{text}"
    );
    // |ẍ| = μ (g + ÿ): 0.3 sin = 0.35 (1 - 0.4 sin).
    let vertical = "friction = 0.35\n[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"half-sine\"\n\
        amplitude_g = 0.3\nperiod = 1.0\n[excitation.vertical]\nkind = \"half-sine\"\namplitude_g = -0.4\nperiod = 1.0\n";
    let (text, contact) = check(vertical);
    let expected = (0.35f64 / (0.3 + 0.35 * 0.4)).asin() / std::f64::consts::TAU;
    assert!((contact["slides_from"].as_f64().expect("it slides") - expected).abs() < 1e-12, "{contact}");
    assert!(text.contains(&format!("it slides first, at t = {expected:.4} s")), "{text}");
}

/// Two blocks, the upper one displaced by a fifth of its width: towards one side it takes 0.2444 g, towards the other 0.4222 g.
#[test]
fn a_check_says_towards_which_side_a_displaced_column_is_weak() {
    let scene = |amplitude: &str| {
        format!(
            "[[block]]\nwidth = 1.0\nheight = 1.0\n[[block]]\nwidth = 1.0\nheight = 2.0\n[initial]\nslide = [0.0, 0.2]\n\
             [excitation.horizontal]\nkind = \"half-sine\"\namplitude_g = {amplitude}\nperiod = 0.8\n"
        )
    };
    let told = |amplitude: &str| Folder::with("scene.toml", &scene(amplitude)).succeeds("check scene.toml");
    assert_has(
        &told("0.4"),
        &[
            "0.4000 g opens no interface of the column at rest: the peak acts towards its stronger side; towards the weaker one 0.2444 g is enough",
        ],
    );
    assert_has(
        &told("-0.2"),
        &["0.2000 g opens no interface of the column at rest, which takes 0.2444 g towards its weaker side"],
    );
    assert_has(&told("-0.4"), &["is enough to open", "opens at 0.2444 g towards its weaker side"]);
    // In JSON, without friction as well, the side on which the motion opens the base: |0.4 g sin| reaches either threshold.
    for (amplitude, by) in [(-0.4, 0.24444), (0.5, 0.42222)] {
        let contact =
            Folder::with("scene.toml", &scene(&amplitude.to_string())).answers("check scene.toml --json")["contacts"]
                [0]
            .clone();
        let number = |name: &str| contact[name].as_f64().expect("a number");
        assert!((number("opened_by") / 9.81 - by).abs() < 1e-5 && (number("opens_at") / 9.81 - 0.24444).abs() < 1e-5);
        let expected = (by / f64::abs(amplitude)).asin() * 0.8 / std::f64::consts::TAU;
        assert!((number("opens_from") - expected).abs() < 1e-5 && contact["coefficient"].is_null(), "{contact}");
    }
    // The ratio of either side is another than that of the stack above the middle of its contact, which the table has.
    let note = "Housner's ratio of a displaced stack is that of the stack above the middle of its contact";
    assert_has(&told("0.4"), &[note]);
    let aligned =
        Folder::with("scene.toml", &scene("0.4").replace("[0.0, 0.2]", "[0.0, 0.0]")).succeeds("check scene.toml");
    assert!(!aligned.contains(note), "{aligned}");
}

/// A displaced block that stands on all of its base opens, to either side at the same acceleration. The other interface has the least threshold, to its
/// weaker side, and does not open.
#[test]
fn the_threshold_is_that_of_the_interface_which_opens_first() {
    let scene = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\nmass = 0.8\n[[block]]\nhalf_width = 0.18\nhalf_height = 0.5\nmass = 3\n\
        [initial]\nslide = [0.0, 0.15]\n[excitation.horizontal]\nkind = \"half-sine\"\namplitude_g = 0.38\nomega = 6.0\n[solver]\nt_end = 2\n";
    let told = Folder::with("scene.toml", scene).succeeds("check scene.toml");
    assert_has(
        &told,
        &[
            "0.3800 g is enough to open interface(s) 2 of the column at rest; the first opens at 0.3600 g; the least that opens one, to its weaker side, is 0.2184 g",
        ],
    );
    // All interfaces open in the instant of the jump.
    let jump = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n[[block]]\nhalf_width = 0.1\nhalf_height = 0.5\n\
        [excitation.horizontal]\nkind = \"rectangular\"\namplitude_g = 0.9\nduration = 0.2\nstart = 0.3\n[solver]\nt_end = 2\n";
    let told = Folder::with("scene.toml", jump).succeeds("check scene.toml");
    assert_has(
        &told,
        &["0.9000 g is enough to open interface(s) 1, 2 of the column at rest; the first opens at 0.2000 g\n"],
    );
    // The upper blocks lean beyond their support: nothing but their weight opens interface 2, at once.
    let leaning = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n".repeat(3)
        + "[initial]\nslide = [0.0, -0.39, -0.39]\n[excitation.horizontal]\nkind = \"half-sine\"\namplitude_g = 0.38\nomega = 6.0\n[solver]\nt_end = 2\n";
    let told = Folder::with("scene.toml", &leaning).succeeds("check scene.toml");
    assert_has(
        &told,
        &["the first at t = 0.0000 s: a stack that leans beyond its support, which the ground does not hold then"],
    );
}

#[test]
fn stacks_that_do_not_stand_by_themselves_are_named() {
    let block = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n";
    let scene = |slide: &str| format!("{}[initial]\nslide = {slide}\n[solver]\nt_end = 1\n", block.repeat(3));
    let folder = Folder::with("s.toml", &scene("[0, 0.35, 0.45]"));
    assert_has(
        &folder.succeeds("check s.toml"),
        &["the stack above interface(s) 2, 3 does not stand by itself: its weight acts"],
    );
    folder.write("s.toml", scene("[0, 0.1, 0]"));
    assert!(!folder.succeeds("check s.toml").contains("stand by itself"));

    // Beyond the edge of the base, there is no acceleration that opens it.
    let leaning = scene("[0, 0.45, 0.45]");
    for (motion, key) in [
        ("kind = \"sine-pulse\"\namplitude_uplift = 2.0\nperiod = 0.5\n", "amplitude_uplift"),
        ("kind = \"synthetic\"\npga_uplift = 2.0\n", "pga_uplift"),
    ] {
        folder.write("s.toml", format!("{leaning}[excitation.horizontal]\n{motion}"));
        folder.refused(
            "check s.toml",
            &[key, "the column does not stand by itself: no acceleration of the ground opens its base"],
        );
    }
}

/// Housner's ratios of the two stacks are 1 - 3/2 sin² α = 0.9851 and 0.9423.
#[test]
fn factors_of_restitution_that_would_gain_energy_are_named() {
    let told = |factors: &str| {
        let scene =
            format!("[column]\nblocks = 2\nhalf_width = 0.2\nhalf_height = 2.0\n[restitution]\nfactors = {factors}\n");
        Folder::with("scene.toml", &scene).succeeds("check scene.toml")
    };
    for (factors, gaining) in [("[1.3, 1.0]", "1"), ("[1.01, 1.07]", "2"), ("[1.02, 1.07]", "1, 2")] {
        let words = format!("where interface(s) {gaining} alone are open, the stack above would gain energy");
        assert_has(&told(factors), &[&words]);
    }
    assert!(!told("[1.01, 1.06]").contains("gain energy"));
}

/// The impulse that turns a block with the ratio η has a friction ratio of h/b (1 - η)/(1 + η), 0.4635 here; that of the plastic impact is 0.1119.
#[test]
fn a_ratio_that_friction_cannot_give_is_noted() {
    let told = |friction: f64| {
        let scene = format!(
            "friction = {friction}\n[column]\nblocks = 1\nhalf_width = 0.3\nhalf_height = 2.0\n[restitution]\neta = 0.87\n\
             [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 2.0\nomega_p = 5.0\n[solver]\nt_end = 5.0\n"
        );
        let folder = Folder::with("scene.toml", &scene);
        folder.succeeds("run scene.toml --no-trust");
        let plastic = folder.summary()["without_restitution"].as_u64().expect("a count");
        (folder.succeeds("check scene.toml"), plastic)
    };
    for friction in [0.46, 0.3] {
        let (text, plastic) = told(friction);
        let note = format!(
            "an impact at which nothing slides needs a coefficient of friction of 0.4635; with {friction} restitution is left out"
        );
        assert_has(&text, &[&note]);
        assert!(plastic > 2, "{plastic}");
    }
    let (text, plastic) = told(0.47);
    assert!(!text.contains("restitution is left out") && plastic == 0, "{plastic}, {text}");
}

/// A density in t/m³ makes a column of kilograms. Without a density or a mass only ratios of masses count.
#[test]
fn densities_in_tonnes_give_a_warning() {
    for (density, is_noted) in [("density = 2.7", true), ("density = 2700", false), ("", false), ("mass = 3", false)] {
        let scene = format!("[column]\nblocks = 3\ndiameter = 1.2\nheight = 6.0\n{density}\n");
        let (_, warned) = Folder::with("scene.toml", &scene).says("check scene.toml");
        assert_eq!(
            warned.contains("warning: drums have a density of a few kg/m³; stone has 1500 to 3000 kg/m³"),
            is_noted,
            "{warned}"
        );
    }
}

#[test]
fn a_column_taller_than_any_gives_a_warning() {
    for (half_height, is_noted) in [(29.0, false), (35.0, true)] {
        let scene = format!("[column]\nblocks = 1\nhalf_width = 8.0\nhalf_height = {half_height}\n");
        let (_, warned) = Folder::with("scene.toml", &scene).says("check scene.toml");
        assert_eq!(warned.contains("the column is higher than 60 m, which no column is"), is_noted, "{warned}");
    }
}

/// A capital whose density was forgotten weighs 1 kg/m² of its side view: the run says so, and its summary.
#[test]
fn a_density_forgotten_on_one_block_gives_a_warning() {
    let blocks = |density: &str| {
        format!(
            "[[block]]\nhalf_width = 0.4\nhalf_height = 1.0\ndensity = 2600\n[[block]]\nhalf_width = 0.4\nhalf_height = 0.3\n{density}"
        )
    };
    let folder = Folder::with("s.toml", &blocks("[solver]\nt_end = 0.1\n"));
    let warning = "block 1 is more than 100 times denser than block 2: is a density or mass missing";
    for command in ["check s.toml", "run s.toml --no-trust"] {
        let (_, warned) = folder.says(command);
        assert!(warned.contains(warning), "{command}: {warned}");
    }
    assert!(folder.summary()["warnings"].to_string().contains(warning));
    folder.write("s.toml", blocks("mass = 100\n[solver]\nt_end = 0.1\n"));
    assert_eq!(folder.says("check s.toml").1, "");
}

/// One radian where one degree was meant.
#[test]
fn a_block_that_begins_past_its_balance_is_noted() {
    let scene = |theta: f64| {
        format!("[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.01, {theta}]\n")
    };
    let told = Folder::with("s.toml", &scene(1.0)).succeeds("check s.toml");
    assert!(
        told.contains("note: block 2 begins past its balance: at 1 rad (57.3°), with a slenderness of 0.4636 rad"),
        "{told}"
    );
    // One degree; and a displaced block, whose balances to its two sides differ.
    for quiet in [scene(0.017), format!("{}slide = [0.0, 0.05]\n", scene(1.0))] {
        let told = Folder::with("s.toml", &quiet).succeeds("check s.toml");
        assert!(!told.contains("past its balance"), "{told}");
    }
}

/// A factor of the record takes the place of the size to which the base scene scales it.
#[test]
fn an_axis_that_takes_the_place_of_a_key_is_named() {
    let base = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"record\"\nfile = \"a.csv\"\ndt = 0.1\nunits = \"g\"\npga_g = 0.3\n[solver]\nt_end = 1.0\n";
    let folder = Folder::with("base.toml", base);
    folder.write("a.csv", "0\n0.1\n-0.2\n0\n");
    let sweep = |key: &str| format!("scene = \"base.toml\"\n[axes]\n{key} = [1.0, 2.0]\n");
    folder.write("s.toml", sweep("scale"));
    let place = "in place of excitation.horizontal.pga_g in the base scene";
    let warning = "the axis excitation.horizontal.scale takes the place of excitation.horizontal.pga_g";
    let (told, warned) = folder.says("check s.toml");
    assert!(told.contains(place) && warned.contains(warning), "{told}{warned}");
    let (_, warned) = folder.says("sweep s.toml");
    assert!(warned.contains(warning), "{warned}");
    // One size for another is what the axis says.
    folder.write("s.toml", sweep("pga"));
    let (told, warned) = folder.says("check s.toml");
    assert!(told.contains(place) && warned.is_empty(), "{told}{warned}");
}

/// Under exactly the acceleration that opens it, or with its weight exactly above its edge, a block stays at rest: rounding opens nothing.
#[test]
fn rounding_opens_nothing() {
    let folder = Folder::new();
    let both = |scene: &str| {
        folder.write("scene.toml", scene);
        let checked = folder.answers("check scene.toml --json");
        (checked["opens"].clone(), folder.succeeds("run scene.toml --no-trust --out out"))
    };
    for (half_width, half_height) in [(0.07, 0.6), (0.25, 1.9), (0.1, 0.3), (0.4, 1.56)] {
        let block = format!("[[block]]\nhalf_width = {half_width}\nhalf_height = {half_height}\n");
        let pulse = |share: f64| {
            let amplitude = share * 9.81 * half_width / half_height;
            format!(
                "{block}[excitation.horizontal]\nkind = \"rectangular\"\namplitude = {amplitude:?}\nstart = 0.5\nduration = 0.1\n[solver]\nt_end = 3\n"
            )
        };
        let (opens, told) = both(&pulse(1.0));
        assert!(opens == serde_json::json!([]) && told.starts_with("no uplift"), "{half_width}: {opens} {told}");
        let (opens, told) = both(&pulse(1.0 + 1e-9));
        assert!(opens == serde_json::json!([1]) && told.starts_with("rocks"), "{half_width}: {opens} {told}");
    }
    let two = |slide: f64| {
        format!(
            "[[block]]\nhalf_width = 0.5\nhalf_height = 0.5\n[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n[initial]\nslide = [0.0, {slide}]\n[excitation.horizontal]\nkind = \"rectangular\"\namplitude = 0.6\nduration = 1.0\n[solver]\nt_end = 3\n"
        )
    };
    let (opens, told) = both(&two(0.5));
    assert!(opens == serde_json::json!([]) && told.starts_with("no uplift"), "{opens} {told}");
    // The ground holds a stack that leans, and lets it fall when the pulse ends.
    let (opens, told) = both(&two(0.52));
    assert!(opens == serde_json::json!([2]) && told.starts_with("overturns"), "{opens} {told}");
    let told = folder.succeeds("check scene.toml");
    assert!(told.contains("interface(s) 2 of the column at rest open, the first at t = 1.0000 s: a stack that leans beyond its support"), "{told}");
}

/// With `μ = b/h` a block slides and opens at the same acceleration: neither is before the other, and the run decides.
#[test]
fn a_block_may_slide_and_open_at_once() {
    let scene = "friction = 0.3\n[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.5\nomega = 5.0\n";
    let folder = Folder::with("scene.toml", scene);
    let told = folder.succeeds("check scene.toml");
    assert!(
        told.contains("slides at 0.3 g, and opens at 0.3 g; under this ground motion it passes both at t = 0.1287 s"),
        "{told}"
    );
    assert!(folder.answers("check scene.toml --json")["contacts"][0]["at_pga"].is_null());
}

/// Rounding of a slide makes no side weaker; an upper block that slides shields those below; without weight blocks fly.
#[test]
fn what_a_check_says_of_contacts_holds_in_the_run() {
    let folder = Folder::new();
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.35\nperiod = 1.0\n";
    for slide in [0.01, 0.03, 0.06, 0.08, 0.09] {
        // The upper base stands on the lower top with all of its width.
        let blocks =
            "[[block]]\nhalf_width = 0.5\nhalf_height = 0.75\n[[block]]\nhalf_width = 0.4\nhalf_height = 0.75\n";
        folder.write("scene.toml", format!("friction = 0.3\n{blocks}[initial]\nslide = [0.0, {slide}]\n{pulse}"));
        let contact = folder.answers("check scene.toml --json")["contacts"][1].clone();
        assert_eq!((&contact["is_symmetric"], &contact["at_pga"]), (&true.into(), &"slides".into()), "{slide}");
    }
    let shielded = "[friction]\nstatic = [0.6, 0.1]\n[[block]]\nhalf_width = 0.3\nhalf_height = 0.3\nmass = 100.0\n[[block]]\nhalf_width = 0.3\nhalf_height = 0.75\n\
        mass = 1000.0\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.5\nperiod = 0.5\n";
    folder.write("scene.toml", shielded);
    let told = folder.succeeds("check scene.toml");
    assert_has(
        &told,
        &["open interface(s) 1, 2", "interface 2 slides before, at t = 0.0160 s, and may keep all of them closed"],
    );
    assert!(folder.succeeds("run scene.toml --no-trust --out out").starts_with("slides"));
    folder.write(
        "scene.toml",
        format!("{shielded}[excitation.vertical]\nkind = \"half-sine\"\namplitude_g = 0.02\nomega = 5.0\n"),
    );
    assert_has(
        &folder.succeeds("check scene.toml"),
        &["with the vertical motion it opens interface(s) 1, 2", "interface 2 slides before"],
    );
    let thrown = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.3\nhalf_height = 1.5\n[excitation.vertical]\nkind = \"rectangular\"\namplitude_g = -1.5\n\
        duration = 0.2\nstart = 0.1\n[output]\ntimes = [0.0, 0.4]\n";
    folder.write("scene.toml", thrown);
    assert_has(&folder.succeeds("check scene.toml"), &["it has no weight left at t = 0.1000 s, and flies"]);
    // A smooth motion takes the weight at a time that is found to rounding.
    let smooth = thrown
        .replace("rectangular", "harmonic")
        .replace("-1.5", "1.3")
        .replace("duration = 0.2\n", "omega = 6.0\nduration = 2.0\n");
    folder.write("smooth.toml", smooth);
    assert_has(&folder.succeeds("check smooth.toml"), &["it has no weight left at t = ", ", and flies"]);
    // The last row is one of a flight, which has landed when the run ends.
    folder.succeeds("run scene.toml --no-trust --out out --report");
    let page = folder.read("out/report.html");
    assert!(page.contains("comes to rest") && !page.contains("in flight above"), "{page}");
}
