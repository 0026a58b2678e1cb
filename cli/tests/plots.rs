//! Figures of a run: what they claim to show is in them, and they are documents that anybody can open.

use crate::common::figures::{parts, words};
use crate::common::scenes::SCENE;
use crate::common::{Folder, assert_has, project, project_text, root};
use roxmltree::{Document, Node};
use serde_json::Value;

const FIGURES: [&str; 4] = ["time-history", "phase-portrait", "energy", "forces"];

/// A column that nothing moves.
const STILL: &str = "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 1.0\n";

/// A stack whose centre of gravity is on, or beyond, the edge of its support has no slenderness to measure angles by: they are drawn in degrees.
#[test]
fn stacks_that_lean_beyond_their_support_are_drawn_in_degrees() {
    for slide in ["0.4", "0.39"] {
        let block = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n".repeat(3);
        let scene = format!("{block}[initial]\nslide = [0.0, {slide}, {slide}]\n[solver]\nt_end = 2\n");
        let folder = Folder::with("scene.toml", &scene);
        let told = folder.succeeds("run scene.toml --out out --plots --report");
        assert_has(&told, &["time-history.svg", "report.html"]);
        let texts = words(&folder.read("out/time-history.svg")).join(" ");
        assert_has(&texts, &["Angles θᵢ [°]", "°"]);
        folder.succeeds("plot out --degrees");
    }
}

/// The figures of a scene of the project, and its summary.
fn figures_of(scene: &str) -> (Vec<String>, Value) {
    let folder = Folder::new();
    let figures = figures_in(&folder, &project(&format!("scenes/{scene}.toml")));
    (figures, folder.summary())
}

/// The figures of a scene that is written for them.
fn figures_of_text(scene: &str) -> Vec<String> {
    figures_in(&Folder::with("scene.toml", scene), "scene.toml")
}

fn figures_in(folder: &Folder, scene: &str) -> Vec<String> {
    let text = folder.succeeds(&["run", scene, "--out", "out", "--plots"]);
    let figure = |name: &str| {
        assert!(text.contains(&format!("{name}.svg")), "{text}");
        folder.read(&format!("out/{name}.svg"))
    };
    FIGURES.map(figure).into()
}

fn number(node: &Node, attribute: &str) -> f64 {
    node.attribute(attribute).and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{attribute} of {node:?}"))
}

fn paths<'a>(document: &'a Document) -> impl Iterator<Item = Vec<Vec<[f64; 2]>>> + 'a {
    document.descendants().filter_map(|node| node.attribute("d")).map(parts)
}

#[test]
fn figures_stand_alone_and_beside_others_and_scale() {
    let scenes =
        ["three-drums-pulse", "paper-1-block-3.00", "five-drums-free", "two-drums-record", "paper-1-block-6.32"];
    let drawn = scenes.map(|scene| figures_of(scene).0).into_iter().chain([figures_of_text(STILL)]);
    for figure in drawn.flatten() {
        let document = Document::parse(&figure).expect("XML");
        let root = document.root_element();
        let (width, height) = (number(&root, "width"), number(&root, "height"));
        assert_eq!(root.attribute("viewBox"), Some(format!("0 0 {width} {height}").as_str()));
        assert!(root.attribute("font-family").is_some_and(|family| family.ends_with("sans-serif")));
        for node in document.descendants() {
            assert!(node.attribute("id").is_none() && node.attribute("clip-path").is_none(), "{node:?} may clash");
            for attribute in node.attributes() {
                assert!(!["NaN", "inf"].iter().any(|bad| attribute.value().contains(bad)), "{attribute:?}");
            }
        }
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        assert!(texts.clone().count() > 5);
        // Eleven pixels where a figure is 900 wide.
        assert!(texts.into_iter().all(|text| number(&text, "font-size") * 900.0 / width >= 11.0));
        for [x, y] in paths(&document).flatten().flatten() {
            assert!((-1.0..=width + 1.0).contains(&x) && (-1.0..=height + 1.0).contains(&y), "({x}, {y})");
        }
    }
}

#[test]
fn a_time_history_has_a_tick_for_every_impact_and_a_name_for_every_mode() {
    for scene in ["three-drums-pulse", "paper-1-block-3.00", "five-drums-free", "two-drums-record"] {
        let (figures, summary) = figures_of(scene);
        let document = Document::parse(&figures[0]).expect("XML");
        let impacts = summary["impacts"].as_u64().expect("a number") as usize;
        let upright = |part: &Vec<[f64; 2]>| part.len() == 2 && part[0][0] == part[1][0];
        let ticks = paths(&document).filter(|parts| parts.len() == impacts && parts.iter().all(upright));
        assert_eq!(ticks.count(), 1, "{scene}: {impacts} impacts");

        let words = words(&figures[0]);
        let slides = summary["sliding"]["way_slid"].as_array().is_some_and(|ways| ways.iter().any(|way| *way != 0.0));
        for mode in summary["time_in_mode"].as_object().expect("modes").keys() {
            // Where blocks slide, that none rocks is not rest.
            if mode == "rest" && slides {
                assert!(words.iter().any(|text| text.starts_with("no rocking: ")), "{scene}: {words:?}");
                continue;
            }
            let named = |text: &String| {
                text.split([',', ':', ' ']).any(|word| word == mode) && (text.contains(',') || text.contains(':'))
                    || text == mode
            };
            assert!(words.iter().any(named), "{scene}: mode {mode} is not in {words:?}");
        }
        let blocks = summary["peak_theta"].as_array().expect("a list").len();
        assert!(
            blocks == 1
                || (1..=blocks).all(|block| words.iter().any(|text| text.starts_with(&format!("block {block},"))))
        );
    }
}

/// Words only: coordinates may differ in their last digit from one machine to the next.
#[test]
fn the_figure_of_the_readme_is_what_its_command_draws() {
    let (figures, _) = figures_of("paper-3-blocks-3.00");
    let shown = project_text("docs/time-history.svg");
    assert_eq!(words(&figures[0]), words(&shown));
    let readme = project_text("README.md");
    assert!(readme.contains("rocking run scenes/paper-3-blocks-3.00.toml --out out/ --plots"));
}

#[test]
fn endings_are_told() {
    let told = |scene: &str| words(&figures_of(scene).0[0]);
    assert!(told("paper-1-block-6.32").iter().any(|text| text == "overturned"));
    assert!(told("paper-3-blocks-7.17").iter().any(|text| text.starts_with("overturned (block ")));
    assert!(told("five-drums-free").iter().any(|text| text == "at rest"));
}

/// Between rows the acceleration of the ground is not drawn.
#[test]
fn a_caption_gives_the_interval_of_the_rows() {
    let figures = figures_of_text(&format!("{STILL}[output]\ndt = 0.25\n"));
    assert!(figures[0].contains(" at the rows alone (every 0.25 s, 5 rows);"));
}

/// At an impact the total energy falls, straight down, by what the event says; and rates jump.
#[test]
fn impacts_are_drops_of_the_energy_and_jumps_of_the_rate() {
    let (figures, summary) = figures_of("paper-1-block-3.00");
    let impacts = summary["impacts"].as_u64().expect("a number") as usize;
    let portrait = Document::parse(&figures[1]).expect("XML");
    let jumps = portrait.descendants().filter(|node| node.attribute("stroke") == Some("#d55e00"));
    let dashes: Vec<_> = jumps.filter_map(|node| node.attribute("d")).flat_map(parts).collect();
    let upright = dashes.iter().filter(|part| part.iter().all(|point| point[0] == part[0][0]));
    assert!(upright.count() >= impacts, "each jump has one dash at least");

    let energy = Document::parse(&figures[2]).expect("XML");
    let total = energy.descendants().filter(|node| node.attribute("stroke") == Some("#000000"));
    let total = total.filter_map(|node| node.attribute("d")).map(parts).max_by_key(|parts| parts[0].len());
    let total = total.expect("a curve").remove(0);
    let drops = total.windows(2).filter(|ends| ends[1][0] - ends[0][0] < 0.6 && ends[1][1] > ends[0][1] + 0.5);
    assert!(drops.count() >= impacts / 2, "the larger ones can be seen");
}

#[test]
fn friction_demand_is_drawn_against_what_the_scene_has() {
    let (figures, summary) = figures_of("three-drums-pulse");
    let said = words(&figures[3]);
    assert!(said.iter().any(|text| text == "friction coefficient 0.8"), "{said:?}");
    for (interface, demand) in summary["friction_demand"].as_array().expect("a list").iter().enumerate() {
        let demand = demand.as_f64().expect("a number");
        let of_interface = |text: &String| text.strip_prefix(&format!("interface {}: ", interface + 1))?.parse().ok();
        let shown: f64 = said.iter().find_map(of_interface).expect("a number");
        assert!((shown / demand - 1.0).abs() < 5e-3, "{demand}, {shown}");
    }
    let without = figures_of("five-drums-free").0;
    assert!(!words(&without[3]).iter().any(|text| text.starts_with("friction coefficient")));
}

#[test]
fn pngs_have_the_figures_size_and_figures_are_the_same_from_run_to_run() {
    let folder = Folder::new();
    folder.succeeds(&["run", &project("scenes/paper-2-blocks-3.00.toml")]);
    for (format, out) in [("svg", "first"), ("svg", "second"), ("png", "first"), ("png", "second")] {
        let text = folder.succeeds(&format!("plot out --format {format} --out {out}"));
        assert!(text.starts_with(&format!("wrote 4 figures to {out}\n")), "{text}");
        let told = |name: &str| text.lines().any(|line| line.starts_with(&format!("{name}.{format}: ")));
        assert!(FIGURES.iter().all(|name| told(name)), "{text}");
    }
    for name in FIGURES {
        let read = |out: &str, format: &str| folder.bytes(&format!("{out}/{name}.{format}"));
        assert!(read("first", "svg") == read("second", "svg") && read("first", "png") == read("second", "png"));
        let (svg, png) = (String::from_utf8(read("first", "svg")).expect("text"), read("first", "png"));
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        let side = |place: usize| u32::from_be_bytes(png[place..place + 4].try_into().expect("four bytes"));
        let document = Document::parse(&svg).expect("XML");
        let sides = ["width", "height"].map(|side| (3.0 * number(&document.root_element(), side)) as u32);
        assert!(side(16).abs_diff(sides[0]) <= 1 && side(20).abs_diff(sides[1]) <= 1);
    }
}

#[test]
fn a_folder_that_is_not_of_a_run_is_bad_input() {
    let folder = Folder::new();
    folder.refused("plot .", &["summary.json", "rocking run"]);
    assert_eq!(folder.names(""), [""; 0], "nothing is half written");
}

/// A hundred thousand rows of a chattering column.
#[test]
fn figures_of_long_runs_stay_small() {
    let scene = "[column]\nblocks = 3\nhalf_width = 0.4\nhalf_height = 1.6\n\
        [excitation.horizontal]\nkind = \"harmonic\"\namplitude_g = 0.5\nfrequency = 2.0\n\
        [solver]\nt_end = 200.0\n[output]\ndt = 0.002\n";
    for (figure, name) in figures_of_text(scene).iter().zip(FIGURES) {
        assert!(figure.len() < 1_000_000, "{name} has {} bytes", figure.len());
    }
}

#[test]
fn one_file_knows_the_plotting_crate() {
    let mut folders = vec![root().join("cli/src")];
    let mut knowing = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder of the project") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else if std::fs::read_to_string(&path).expect("readable").contains("kuva::") {
                knowing.push(path);
            }
        }
    }
    assert!(knowing.len() == 1 && knowing[0].ends_with("plot/sheet.rs"), "{knowing:?}");
}

#[test]
fn the_name_of_the_friction_line_covers_no_curve() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml --plots");
    let figure = folder.read("out/forces.svg");
    let document = Document::parse(&figure).expect("XML");
    let height = |name: &str| -> f64 {
        let mut texts = document.descendants().filter(|node| node.has_tag_name("text"));
        let text = texts.find(|node| node.text() == Some(name)).unwrap_or_else(|| panic!("{name}"));
        text.attribute("y").and_then(|y| y.parse().ok()).expect("a number")
    };
    assert!(height("friction coefficient 0.8") > height("Time [s]"), "it stands below the panels");
    // White patches below words are the only areas of that fill.
    let patches =
        document.descendants().filter(|node| node.has_tag_name("path") && node.attribute("fill") == Some("#ffffff"));
    assert_eq!(
        patches.count(),
        usize::from(figure.contains("overturned")) * 2 + usize::from(figure.contains("at rest")) * 2
    );
}

/// Three blocks that slide as one: their energy is ½ m v².
#[test]
fn energies_of_blocks_that_slide_are_drawn() {
    let scene = "friction = 0.3\n[column]\nblocks = 3\nhalf_width = 0.4\nhalf_height = 1.2\n\
        [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.7\nperiod = 0.8\n";
    let folder = Folder::with("s.toml", scene);
    folder.succeeds("run s.toml --no-trust");
    let told = folder.succeeds("plot out");
    let response = folder.table("out/response.csv");
    let speed = response.rows().map(|row| row.number("vx_1").abs()).fold(0.0, f64::max);
    // 0.8 m by 2.4 m, 1 kg/m².
    let largest = 0.5 * 0.8 * 2.4 * speed.powi(2);
    let (_, caption) = told.split_once("Largest, at rows and events: ").expect("in the caption");
    let found: f64 = caption.split(' ').next().expect("a number").parse().expect("a number");
    assert!(largest > 0.1 && (found / largest - 1.0).abs() < 5e-3, "{found} {largest}");
    // The name of the end keeps clear of the curves.
    assert!(words(&folder.read("out/slides.svg")).contains(&"at rest".into()));
}

/// The axis of energies and that of slides have numbers of their unit.
#[test]
fn numbers_at_an_axis_are_in_its_unit() {
    let drawn = |name: &str, scene: &str| {
        let folder = Folder::with("s.toml", scene);
        folder.succeeds("run s.toml --no-trust --plots");
        words(&folder.read(&format!("out/{name}.svg")))
    };
    // A thousand times the mass, a thousand times the energy.
    let energies = ["50", "50e3", "50e6"].map(|mass| {
        let block = format!("[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\nmass = {mass}\n");
        drawn("energy", &format!("{block}[initial]\ntheta = [0.2]\n[solver]\nt_end = 3.0\n"))
    });
    assert!(energies[0].contains(&"20".into()), "{:?}", energies[0]);
    for (own, unit) in energies.iter().zip(["J", "kJ", "MJ"]) {
        let label = format!("Energy [{unit}]");
        assert!(own.contains(&label), "{own:?}");
        let renamed: Vec<String> = own.iter().map(|word| word.replace(&label, "Energy [J]")).collect();
        assert_eq!(renamed, energies[0]);
    }
    // Pushed by 0.5 g for a time T, a block with μ = 0.3 slides g T²/6 to the left: 4.1 mm, 10.2 cm and 1.05 m.
    for (duration, unit, farthest) in [(0.05, "mm", "−4"), (0.25, "cm", "−10"), (0.8, "m", "−1.0")] {
        let scene = format!(
            "friction = 0.3\n[[block]]\nhalf_width = 1.0\nhalf_height = 0.4\n[excitation.horizontal]\nkind = \"rectangular\"\n\
             amplitude_g = 0.5\nduration = {duration}\n[solver]\nt_end = 3.0\n"
        );
        let own = drawn("slides", &scene);
        assert!(own.contains(&format!("Slide [{unit}]")) && own.contains(&farthest.into()), "{own:?}");
    }
}
