//! How figures are written: width on paper, degrees, PDF, names of blocks.

use crate::common::figures::words;
use crate::common::{Folder, assert_has, project};
use roxmltree::Document;

/// Two blocks with names, one of them long.
const STATUE: &str = "[[block]]\nname = \"pedestal\"\nhalf_width = 0.45\nhalf_height = 0.5\n\
    [[block]]\nname = \"statue of the emperor Augustus\"\nhalf_width = 0.25\nhalf_height = 0.9\n[restitution]\neta = 0.9\n\
    [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.35\nperiod = 0.6\n[solver]\nt_end = 6.0\n";

/// A folder with a run of a scene.
fn run(scene: &str) -> (Folder, String) {
    let folder = Folder::with("s.toml", scene);
    let told = folder.succeeds("run s.toml --no-trust");
    (folder, told)
}

/// A column that overturns before the first row is a result: what is to be drawn is missing, and nothing has failed.
#[test]
fn a_run_without_rows_has_results_and_no_figures() {
    let scene = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.5\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 1.5\nperiod = 1.0\n[output]\ntimes = [9.0]\n";
    let folder = Folder::with("s.toml", scene);
    let (told, warned) = folder.says("run s.toml --no-trust --plots --report");
    assert_has(&told, &["overturns", "wrote summary.json, response.csv, events.json to out"]);
    assert_has(&warned, &["no figures and no report", "before the first of `output.times`"]);
    assert!(folder.has("out/summary.json") && !folder.has("out/report.html"));
    folder.refused("plot out", &["there are no rows"]);
}

#[test]
fn angles_are_drawn_in_degrees_on_request() {
    let (folder, _) = run(STATUE);
    folder.succeeds("plot out --out natural");
    folder.succeeds("plot out --out degrees --degrees");
    let of = |name: &str| words(&folder.read(name));
    let (natural, degrees) = (of("natural/time-history.svg"), of("degrees/time-history.svg"));
    assert!(natural.contains(&"Angles θᵢ/αᵢ".into()) && degrees.contains(&"Angles θᵢ [°]".into()), "{degrees:?}");
    // The slenderness of the statue on its interface, atan(0.25 / 0.9).
    let alpha = (0.25f64 / 0.9).atan().to_degrees();
    assert!(degrees.iter().any(|word| word.ends_with(&format!("α₂ = {alpha:.1}°"))), "{degrees:?}");
    let portrait = of("degrees/phase-portrait.svg");
    assert!(
        portrait.contains(&"Angle θ [°]".into()) && portrait.contains(&"Rate ω = dθ/dt [°/s]".into()),
        "{portrait:?}"
    );
    // Nothing else has angles.
    for name in ["energy", "forces"] {
        assert_eq!(folder.read(&format!("natural/{name}.svg")), folder.read(&format!("degrees/{name}.svg")));
    }
    // Of a sweep, the slenderness.
    folder.write("sweep.toml", "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\nalpha = [0.2, 0.3]\np = [1, 2, 3]\n");
    folder.succeeds("sweep sweep.toml");
    folder.succeeds("plot sweep.csv --degrees");
    let found = of("sweep.svg");
    assert!(found.contains(&format!("α = {:.1}°", 0.2f64.to_degrees())), "{found:?}");
}

#[test]
fn a_figure_is_laid_out_for_the_width_of_its_paper() {
    let (folder, _) = run(STATUE);
    for (width, pixels) in [("85", 408.0), ("150", 720.0), ("200", 960.0)] {
        folder.succeeds(&format!("plot out --out {width} --width {width}"));
        for name in ["time-history", "phase-portrait", "energy", "forces"] {
            let figure = folder.read(&format!("{width}/{name}.svg"));
            let document = Document::parse(&figure).expect("XML");
            let root = document.root_element();
            assert_eq!(root.attribute("width"), Some(&*format!("{width}.00mm")));
            let view: Vec<f64> = root
                .attribute("viewBox")
                .expect("a box")
                .split(' ')
                .map(|number| number.parse().expect("a number"))
                .collect();
            assert_eq!(view[2], pixels);
            // Text keeps its size, and nothing is right of the paper.
            let texts = || document.descendants().filter(|node| node.has_tag_name("text"));
            assert!(texts().all(|text| ["13", "14"].contains(&text.attribute("font-size").expect("a size"))), "{name}");
            let x = |text: roxmltree::Node| text.attribute("x").and_then(|x| x.parse::<f64>().ok()).unwrap_or(0.0);
            assert!(texts().all(|text| x(text) <= pixels), "{name}");
            // About 0.55 em a sign.
            let end =
                |text: roxmltree::Node| x(text) + 13.0 * 0.55 * text.text().unwrap_or_default().chars().count() as f64;
            let begins = |text: &roxmltree::Node| text.attribute("text-anchor").is_none_or(|anchor| anchor == "start");
            for text in texts().filter(begins).filter(|text| text.attribute("transform").is_none()) {
                assert!(end(text) <= pixels + 8.0, "{name}: {:?}", text.text());
            }
        }
    }
    folder.refused("plot out --width 20", &["give 80 to 500 mm"]);
}

/// Thirteen ticks of time on narrow paper: some have no number.
#[test]
fn numbers_of_an_axis_do_not_run_into_one_another() {
    let scene =
        "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.1]\n[solver]\nt_end = 0.24\n";
    let folder = Folder::with("s.toml", scene);
    folder.succeeds("run s.toml --out out");
    folder.succeeds("plot out --width 80");
    for name in ["time-history", "energy", "forces"] {
        let figure = folder.read(&format!("out/{name}.svg"));
        let document = Document::parse(&figure).expect("XML");
        let times = document.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| {
            let text = node.text().filter(|text| text.starts_with("0.") && text.len() == 4)?;
            let place = |name: &str| node.attribute(name).and_then(|value| value.parse::<f64>().ok());
            (node.attribute("text-anchor") == Some("middle")).then_some(())?;
            Some((place("y")?, place("x")?, text.to_string()))
        });
        let mut times: Vec<_> = times.collect();
        times.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let lowest = times.last().expect("numbers").0;
        let x: Vec<f64> = times.iter().filter(|(y, ..)| *y == lowest).map(|(_, x, _)| *x).collect();
        assert!(x.len() >= 3 && x.windows(2).all(|pair| pair[1] - pair[0] > 13.0 * 0.55 * 4.0), "{name}: {times:?}");
    }
}

#[test]
fn blocks_have_their_names_in_the_text_of_a_run_and_in_its_figures() {
    let (folder, told) = run(STATUE);
    assert_has(&told, &["base first: pedestal 0.", ", statue of the emperor Augustus 0."]);
    folder.succeeds("plot out");
    let found = words(&folder.read("out/time-history.svg"));
    assert!(found.iter().any(|word| word.starts_with("block 1 (pedestal), α₁ = ")), "{found:?}");
    // Legends stay short.
    assert!(found.iter().any(|word| word.starts_with("block 2 (statue of the e…), α₂ = ")), "{found:?}");
    let (_, told) = run(&STATUE.replace("amplitude_g = 0.35", "amplitude_g = 2.5"));
    assert!(
        told.contains("(block 2, statue of the emperor Augustus)") || told.contains("(block 1, pedestal)"),
        "{told}"
    );
    // Without names nothing changes.
    let (_, told) = run(&STATUE
        .lines()
        .filter(|line| !line.starts_with("name"))
        .map(|line| format!("{line}\n"))
        .collect::<String>());
    assert!(told.contains("largest |θ|/α, base first: 0."), "{told}");
}

/// All kinds of figures: of a run, a sweep, a study, a record, and the modes.
#[cfg(feature = "pdf")]
#[test]
fn figures_of_all_kinds_are_written_as_pdf() {
    let (folder, _) = run(STATUE);
    folder.write("sweep.toml", "scene = \"s.toml\"\n[axes]\namplitude_g = [0.2, 0.3, 1.0]\nperiod = [0.5, 1.0]\n");
    let record = project("ground/tests/records/peer/RSN9001_HOLLOW_MIL000.AT2");
    folder.succeeds("plot out --format pdf");
    folder.succeeds("plot out --format pdf --width 85 --out narrow");
    folder.succeeds("sweep sweep.toml --plot f.pdf");
    folder.succeeds(&["record", &record, "--plot", "r.pdf"]);
    folder.succeeds("modes --blocks 2 --svg m.pdf");
    let page = |name: &str| -> Vec<f64> {
        let bytes = folder.bytes(name);
        assert!(bytes.starts_with(b"%PDF-"), "{name}");
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let (_, found) = text.split_once("/MediaBox").expect("a page");
        let numbers = found.split(['[', ']']).nth(1).expect("a box").split_whitespace();
        numbers.map(|number| number.parse().expect("a number")).collect()
    };
    for name in [
        "out/time-history.pdf",
        "out/phase-portrait.pdf",
        "out/energy.pdf",
        "out/forces.pdf",
        "f.pdf",
        "f-minimum.pdf",
        "r.pdf",
    ] {
        // 15 cm.
        assert!((page(name)[2] - 150.0 / 25.4 * 72.0).abs() < 0.1, "{name} {:?}", page(name));
    }
    assert!((page("narrow/energy.pdf")[2] - 85.0 / 25.4 * 72.0).abs() < 0.1);
    assert!(page("m.pdf")[2] > 100.0);
    // The same bytes again.
    let before = folder.bytes("out/forces.pdf");
    folder.succeeds("plot out --format pdf");
    assert!(before == folder.bytes("out/forces.pdf"));
}

#[cfg(not(feature = "pdf"))]
#[test]
fn a_build_without_pdf_says_how_to_get_it() {
    let named = ["PDF needs a build with `--features pdf`"];
    Folder::new().refused(&["record", &project("r"), "--plot", "r.pdf"], &named);
}
