//! Claims about the page as a browser shows it: angles, places, events, playing. They are ignored where there is no Chromium.

use super::browser::Browser;
use super::{HOSTILE, Run, SCENES, hostile, numbers, run, run_text};
use crate::common::{Folder, Row, Table, project_text};
use rocking::kinematics::outlines;
use rocking::pattern::Pattern;
use rocking::{Block, Column};
use serde_json::{Value, json};
use std::collections::HashSet;

/// A run's rows: time, angles, pattern; base first.
fn rows(run: &Run, blocks: usize) -> Vec<(f64, Vec<f64>, String)> {
    let response = Table::of(&run.read("response.csv"));
    let angles = |row: Row| (1..=blocks).map(|block| row.number(&format!("theta_{block}"))).collect();
    response.rows().map(|row| (row.number("t"), angles(row), row.text("pattern").into())).collect()
}

fn column(run: &Run) -> Column {
    let summary = run.json("summary.json");
    let blocks: Vec<Block> = serde_json::from_value(summary["column"]["blocks"].clone()).expect("blocks");
    Column::new(blocks, summary["column"]["gravity"].as_f64().expect("a number")).expect("valid")
}

/// Written with ten digits behind the point: off by 5e-11 rad at most.
const ANGLE: f64 = 1e-9;
/// Corners are sums of a dozen lengths of metres turned by such angles.
const LENGTH: f64 = 1e-6;

#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn the_page_shows_the_angles_and_corners_of_the_response() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    for name in SCENES {
        let run = run(&folder, name);
        let column = column(&run);
        let rows = rows(&run, column.len());
        let events: Vec<f64> = run
            .json("events.json")
            .as_array()
            .expect("a list")
            .iter()
            .map(|event| event["t"].as_f64().expect("a time"))
            .collect();
        // Three rows by the address, as a reader of the page has them; every row by the page's own function.
        for index in [0, rows.len() / 3, rows.len() - 1] {
            let (t, theta, _) = &rows[index];
            browser.open(&run.path("report.html"), &format!("t={t:?}"));
            assert_eq!(browser.time(), *t, "{name}");
            let shown = browser.evaluate("JSON.parse(document.documentElement.dataset.theta)");
            for (shown, expected) in numbers(&shown).iter().zip(theta) {
                assert!((shown - expected).abs() < ANGLE, "{name}, t = {t}: {shown}, {expected}");
            }
            let written = browser.evaluate("document.querySelector('.readout output').textContent");
            let top = theta.last().expect("a block").to_degrees().abs();
            let top = format!("{top:.3}°");
            assert!(written.as_str().expect("text").ends_with(&top), "{name}, t = {t}: {written}, {top}");
        }
        let times: Vec<f64> = rows.iter().map(|(t, ..)| *t).collect();
        let shown = browser.evaluate(&format!("{}.map(t => rocking.at(t))", json!(times)));
        for (shown, (t, theta, pattern)) in shown.as_array().expect("a list").iter().zip(&rows) {
            for (shown, expected) in numbers(&shown["theta"]).iter().zip(theta) {
                assert!((shown - expected).abs() < ANGLE, "{name}, t = {t}: {shown}, {expected}");
            }
            // A row on an event may be of either side of it.
            if events.iter().any(|event| event == t) {
                continue;
            }
            assert_eq!(shown["pattern"], pattern.as_str(), "{name}, t = {t}");
            let pattern = Pattern::parse(pattern).expect("a pattern");
            let mode = pattern.mode().map_or("rest".into(), |(label, _)| label.to_string());
            assert_eq!(shown["mode"], mode.as_str(), "{name}, t = {t}");
            for (block, outline) in outlines(&column, &pattern, theta).iter().enumerate() {
                for (shown, expected) in
                    shown["corners"][block].as_array().expect("four").iter().map(numbers).zip(outline.corners)
                {
                    let off = (shown[0] - expected[0]).hypot(shown[1] - expected[1]);
                    assert!(off < LENGTH, "{name}, t = {t}, block {block}: {shown:?}, {expected:?}");
                }
            }
        }
        assert_eq!(browser.console, [""; 0], "{name}");
        assert_eq!(browser.evaluate("document.documentElement.dataset.error || ''"), "", "{name}");
    }
}

/// Three drums that slide apart while they rock.
const SLIDES: &str = "friction = 0.4\n\
    [[block]]\nhalf_width = 0.5\nhalf_height = 0.5\n\
    [[block]]\nhalf_width = 0.48\nhalf_height = 0.5\n\
    [[block]]\nhalf_width = 0.46\nhalf_height = 0.6\n\
    [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 1.5\nomega = 9.0\n[solver]\nt_end = 2.0\n";

/// Lengths of the player's joints are written with six digits behind the point: nine of them and the turns between are off by less.
const JOINTS: f64 = 1e-5;

#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn blocks_that_slide_or_fly_are_drawn_where_they_are() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    // The second is dropped from a height, turned.
    let dropped = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.5\nhalf_height = 1.0\n[initial]\ntheta = [0.05, -0.1]\n\
        x = [0.0, 0.1]\ny = [0.7, 1.9]\nvx = [0.0, 0.0]\nvy = [0.0, 0.0]\n[solver]\nt_end = 0.3\n";
    for (name, scene) in [("slides", SLIDES), ("dropped", dropped)] {
        let run = run_text(&folder, name, scene);
        let response = Table::of(&run.read("response.csv"));
        let times = response.numbers("t");
        browser.open(&run.path("report.html"), "");
        let shown = browser.evaluate(&format!("{}.map(t => rocking.at(t))", json!(times)));
        for (row, shown) in response.rows().zip(shown.as_array().expect("a list")) {
            for (block, corners) in shown["corners"].as_array().expect("a list").iter().enumerate() {
                let corners: Vec<Vec<f64>> = corners.as_array().expect("four").iter().map(numbers).collect();
                for (axis, column) in ["x", "y"].into_iter().enumerate() {
                    // Of a rectangle the centroid is the mean of the corners.
                    let centroid = corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
                    let expected = row.number(&format!("{column}_{}", block + 1));
                    assert!(
                        (centroid - expected).abs() < JOINTS,
                        "{name}, t = {}: {centroid}, {expected}",
                        row.text("t")
                    );
                }
            }
        }
        let states = browser.evaluate("rocking.at(0).interfaces");
        assert_eq!(
            states,
            if name == "dropped" { json!(["apart", "apart"]) } else { json!(["closed", "closed", "closed"]) },
            "{name}"
        );
        assert_eq!(browser.evaluate("document.documentElement.dataset.error || ''"), "", "{name}");
    }
}

/// Between rows the page interpolates; at an event it shows the event, and after it the new pattern at once.
#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn events_are_shown_at_their_instants() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    let run = run(&folder, "pulse");
    browser.open(&run.path("report.html"), "");
    for event in run.json("events.json").as_array().expect("a list") {
        let shown = browser.evaluate(&format!("rocking.at({})", event["t"]));
        assert_eq!(shown["mode"], event["mode"], "{event}");
        for (shown, expected) in numbers(&shown["theta"]).iter().zip(numbers(&event["theta"])) {
            assert!((shown - expected).abs() < ANGLE, "{event}");
        }
    }
}

/// The eighth block once had the line of the first.
#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn the_curves_of_many_blocks_are_distinct() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    let scene = "[column]\nblocks = 21\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 0.1\n";
    let run = run_text(&folder, "tall", scene);
    browser.open(&run.path("report.html"), "");
    let lines = browser.evaluate(
        "[...document.querySelectorAll('.readout path')].map(one => one.style.stroke + one.getAttribute('stroke-dasharray'))",
    );
    let lines: HashSet<&str> = lines.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert_eq!(lines.len(), 21, "{lines:?}");
}

/// A run with ten times as many rows is the reference. Cubics through angles and rates are off by h⁴/384 times a fourth
/// derivative, 1e-10 s⁴/384 at rows 0.01 s apart; where a phase is cut short by an event the cubic is shorter.
#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn between_rows_the_page_follows_the_motion() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    let scene = project_text("scenes/paper-3-blocks-3.00.toml");
    let coarse = run_text(&folder, "coarse", &format!("{scene}\n[output]\ndt = 0.01\n"));
    let fine = run_text(&folder, "fine", &format!("{scene}\n[output]\ndt = 0.001\n"));
    browser.open(&coarse.path("report.html"), "");
    let rows = rows(&fine, 3);
    let times: Vec<f64> = rows.iter().map(|(t, ..)| *t).collect();
    let shown = browser.evaluate(&format!("{}.map(t => rocking.at(t).theta)", json!(times)));
    for (shown, (t, theta, _)) in shown.as_array().expect("a list").iter().zip(&rows) {
        for (shown, expected) in numbers(shown).iter().zip(theta) {
            // The pulse's fourth derivative is 7.36 · 10.7⁴ / 2.8 rad/s⁴ at most: 1e-9 · 3.4e4 / 384 = 1e-6 rad.
            assert!((shown - expected).abs() < 1e-6, "t = {t}: {shown}, {expected}");
        }
    }
}

#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn it_plays_to_the_end_and_obeys_the_keyboard() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    let run = run(&folder, "pulse");
    let file = run.path("report.html");
    let ended = "document.documentElement.dataset.ended === 'true'";
    browser.open(&file, "t=9&play=1&speed=2");
    browser.wait("Number(document.documentElement.dataset.t) > 9.2");
    browser.wait(ended);
    assert_eq!(browser.time(), 10.0);

    browser.open(&file, "t=1");
    let playing = "document.getElementById('player').classList.contains('playing')";
    browser.evaluate("document.getElementById('scrub').focus()");
    browser.press(" ", false);
    assert_eq!(browser.evaluate(playing), true);
    browser.wait("Number(document.documentElement.dataset.t) > 1.1");
    browser.press(" ", false);
    assert_eq!(browser.evaluate(playing), false);
    browser.press("Home", false);
    assert_eq!(browser.time(), 0.0);
    browser.press("ArrowRight", false);
    assert_eq!(browser.time(), 0.01);
    browser.press("ArrowLeft", false);
    assert_eq!(browser.time(), 0.0);
    let events = run.json("events.json");
    for event in events.as_array().expect("a list").iter().take(3) {
        browser.press("ArrowRight", true);
        assert_eq!(browser.time(), event["t"].as_f64().expect("a time"));
    }
    browser.press("ArrowLeft", true);
    assert_eq!(browser.time(), events[1]["t"].as_f64().expect("a time"));
    browser.press("End", false);
    assert_eq!(browser.time(), 10.0);
    browser.press("-", false);
    assert_eq!(browser.evaluate("document.getElementById('speed').value"), "0.5");
    // The slider and what it says to those who do not see it.
    browser.evaluate("scrub.value = 2.5; scrub.dispatchEvent(new Event('input'))");
    assert_eq!(browser.time(), 2.5);
    let told = browser.evaluate("scrub.getAttribute('aria-valuetext')");
    assert!(told.as_str().is_some_and(|told| told.starts_with("2.50 seconds, mode 1.5")), "{told}");
    assert_eq!(browser.console, [""; 0]);
}

/// Nothing reaches beyond the page, what is to be touched is large enough, and the canvas is as sharp as the screen.
#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn it_fits_a_phone() {
    let mut browser = Browser::start(390);
    let folder = Folder::new();
    for name in SCENES {
        let run = run(&folder, name);
        browser.open(&run.path("report.html"), "t=0.6");
        assert_eq!(browser.evaluate("innerWidth"), 390, "{name}");
        assert_eq!(browser.evaluate("document.documentElement.scrollWidth"), 390, "{name}");
        let small = "[...document.querySelectorAll('button, select, input, summary')].filter(one => \
            one.getBoundingClientRect().height < 40).map(one => one.id || one.textContent)";
        assert_eq!(browser.evaluate(small), json!([]), "{name}");
        let nameless = "[...document.querySelectorAll('button, select, input, canvas')].filter(one => \
            !one.getAttribute('aria-label') && !(one.labels && one.labels.length)).map(one => one.id)";
        assert_eq!(browser.evaluate(nameless), json!([]), "{name}");
        assert_eq!(browser.evaluate("stage.width === Math.round(2 * stage.clientWidth)"), true, "{name}");
    }
}

#[test]
#[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
fn a_hostile_scene_runs_no_script() {
    let mut browser = Browser::start(1280);
    let folder = Folder::new();
    // The folder's name is no address; the page is the same elsewhere.
    folder.write("page.html", hostile(&folder).page());
    browser.open(&folder.path("page.html"), "t=0.5");
    assert_eq!(browser.evaluate("document.title"), HOSTILE);
    assert_eq!(browser.evaluate("document.querySelector('h1').textContent"), HOSTILE);
    assert_eq!(browser.evaluate("document.images.length"), 0);
    assert_eq!(browser.console, [""; 0]);
}
