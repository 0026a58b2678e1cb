//! The report of a run: complete, self-contained, harmless, the same every time; in Chromium, where there is one, it plays and
//! shows the angles of `response.csv`.

#[cfg(unix)]
#[path = "report/browser.rs"]
mod browser;
mod common;

use std::path::{Path, PathBuf};

/// Scenes by name: a pulse on three blocks, overturning, five drums let go, nothing at all, a record, shaking both ways.
const SCENES: [&str; 6] = ["pulse", "overturning", "free", "quiet", "record", "vertical"];

/// Runs a scene with `--report`; the folder of its results.
fn run(folder: &Path, name: &str) -> PathBuf {
    let scene = match name {
        "pulse" => "paper-3-blocks-3.00",
        "overturning" => "paper-1-block-6.33",
        "free" => "five-drums-free",
        "record" => "two-drums-record",
        "vertical" => "harmonic-with-vertical",
        _ => {
            return run_text(
                folder,
                name,
                "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 1.0\n",
            );
        }
    };
    let scene = common::root().join(format!("scenes/{scene}.toml"));
    run_file(folder, name, &scene)
}

fn run_text(folder: &Path, name: &str, text: &str) -> PathBuf {
    let scene = folder.join(format!("{name}.toml"));
    std::fs::write(&scene, text).expect("writable");
    run_file(folder, name, &scene)
}

fn run_file(folder: &Path, name: &str, scene: &Path) -> PathBuf {
    let said = common::succeeds(folder, &["run", scene.to_str().expect("text"), "--out", name, "--report"]);
    assert!(said.contains("report.html"), "{said}");
    folder.join(name)
}

fn page(run: &Path) -> String {
    std::fs::read_to_string(run.join("report.html")).expect("written")
}

#[test]
fn a_report_has_every_section_and_needs_no_other_file() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in SCENES {
        let page = page(&run(folder.path(), name));
        for section in ["outcome", "animation", "peaks", "impacts", "modes", "validity", "inputs", "provenance"] {
            assert!(page.contains(&format!("<section id=\"{section}\"")), "{name}: no section {section}");
        }
        assert!(!page.contains("{{") && !page.contains("NaN") && !page.contains("undefined<"), "{name}");
        let (head, script) = page.split_once("<script").expect("the player");
        for part in ["src=", "@import", "url(http", "url(//"] {
            assert!(!head.contains(part), "{name}: {part}");
        }
        for part in ["fetch(", "XMLHttpRequest", "import(", "WebSocket", "sendBeacon", "new Image", "src="] {
            assert!(!script.contains(part), "{name}: {part}");
        }
        // The only references are to parts of the page itself, and to an icon without content.
        for reference in page.split("href=\"").skip(1) {
            assert!(reference.starts_with('#') || reference.starts_with("data:,"), "{name}: {reference:.40}");
        }
    }
}

#[test]
fn the_outcome_is_told_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let outcomes = [
        (
            "pulse",
            "The column <strong>stands</strong>, but is still rocking at the end of the run, t&nbsp;=&nbsp;10&nbsp;s.",
        ),
        ("overturning", "The column <strong>overturns</strong> at t&nbsp;=&nbsp;3.882&nbsp;s."),
        ("free", "The column <strong>stands</strong>: it comes to rest at t&nbsp;=&nbsp;6.466&nbsp;s."),
        ("quiet", "The column <strong>stands</strong>: nothing starts it in 1&nbsp;s."),
    ];
    for (name, sentence) in outcomes {
        let page = page(&run(folder.path(), name));
        assert!(page.contains(sentence), "{name}: {}", &page[page.find("class=\"outcome").unwrap_or(0)..][..400]);
    }
}

/// Key figures are of the run: the largest of the peaks, each over its own slenderness, and the events that occurred.
#[test]
fn tiles_agree_with_the_tables_below_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = page(&run(folder.path(), "pulse"));
    let shares: Vec<f64> = told
        .split("<td class=\"share\">")
        .skip(1)
        .filter_map(|cell| cell.split_once("</i></span><span>")?.1.split_once(" %")?.0.parse().ok())
        .collect();
    assert_eq!(shares.len(), 3);
    let largest = shares.iter().copied().fold(0.0, f64::max);
    assert!(told.contains(&format!("; |θ|/α up to {largest} %</span>")), "{shares:?}");
    let tile = told.split("<span class=\"name\">impacts</span>").nth(1).and_then(|rest| rest.split("</li>").next());
    let tile = tile.expect("a tile");
    assert!(tile.contains("besides ") && !tile.contains("(s)") && !tile.contains("slip"), "{tile}");
    let told = page(&run(folder.path(), "quiet"));
    assert!(told.contains("<span class=\"note\">no other events</span>") && told.contains("0 modes entered"));
    // A scene without a title.
    assert!(told.contains("<h1>quiet.toml</h1>") && told.contains("<title>quiet.toml</title>"));
    assert!(!told.contains("jump at an impact"), "in the legend of the phase portrait");
}

/// A column with a coefficient that is enough, none, and one that is not.
#[test]
fn the_verdict_follows_the_friction_that_the_scene_has() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 3\nhalf_width = 0.3974745895307783\nhalf_height = 1.5566366369849045\n[restitution]\neta = 0.9\n\
        [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.75\nomega = 10.7\n";
    let verdicts = [
        ("rough", "friction = 2.0\n", "The model holds for this run"),
        ("unknown", "", "The model holds if the joints are rough enough"),
        ("smooth", "friction = 0.6\n", "The model holds for this run</strong>: sliding and flight are part of it"),
    ];
    for (name, friction, verdict) in verdicts {
        let page = page(&run_text(folder.path(), name, &format!("{friction}{scene}")));
        assert_eq!(page.matches(verdict).count(), 2, "{name}: at the top and in the section");
    }
}

#[test]
fn the_same_folder_gives_the_same_page_wherever_it_lies() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = run(folder.path(), "record");
    let once = page(&first);
    let moved = folder.path().join("moved");
    std::fs::rename(&first, &moved).expect("renamed");
    common::succeeds(folder.path(), &["report", "moved"]);
    common::succeeds(folder.path(), &["report", "moved", "--out", "elsewhere.html"]);
    let elsewhere = std::fs::read_to_string(folder.path().join("elsewhere.html")).expect("written");
    assert!(once == page(&moved) && once == elsewhere);
}

/// Title, scene text and file name that would end elements, attributes and scripts.
const HOSTILE: &str = "</script><script>document.title='taken'</script><img src=x onerror=alert(1)>'\"&{{css}}";

fn hostile(folder: &Path) -> PathBuf {
    let title = HOSTILE.replace('"', "\\\"");
    let text = format!(
        "title = \"{title}\" # {HOSTILE}\n[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n\
         [initial]\ntheta = [0.1]\n[solver]\nt_end = 1.0\n"
    );
    run_text(folder, "a'b <i>&", &text)
}

#[test]
fn what_a_scene_says_is_text_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = page(&hostile(folder.path()));
    assert!(
        !page.contains("<img") && !page.contains("document.title=&#39;taken&#39;</script>") && !page.contains("<i>&")
    );
    let ends = page.matches("</script>").count();
    assert_eq!(ends, 2, "the data's and the player's");
    assert!(page.contains("&lt;/script&gt;&lt;script&gt;document.title=&#39;taken&#39;"));
    // One word of the command line, the folder before it.
    assert!(page.contains("a&#39;\\&#39;&#39;b &lt;i&gt;&amp;.toml&#39; --out out --report"));
}

/// 30,001 rows: every second one is kept, and both sides of every event.
#[test]
fn a_long_run_is_thinned_between_its_events() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.04, 0.06]\n[solver]\nt_end = 3.0\n\
        [output]\ndt = 0.0001\n";
    let run = run_text(folder.path(), "long", scene);
    let page = page(&run);
    assert!(page.contains("one row in 2 of response.csv") && page.len() < 3_000_000, "{} bytes", page.len());
    let (_, data) = page.split_once("id=\"run\">").expect("the data");
    let data: serde_json::Value = serde_json::from_str(data.split("</script>").next().expect("closed")).expect("JSON");
    let times: Vec<f64> = serde_json::from_value(data["t"].clone()).expect("numbers");
    assert!(times.is_sorted() && times[0] == 0.0 && times.last() == Some(&3.0));
    let events = data["events"].as_array().expect("a list");
    assert_eq!(times.len(), 15_001 + 2 * events.len());
    for event in events {
        let time = event["t"].as_f64().expect("a time");
        assert_eq!(times.iter().filter(|one| **one == time).count(), 2, "{time}");
    }
}

/// Rows at given times, unevenly apart or a single one, of blocks that stick, slide and fall: figures and page are of what is there.
#[test]
fn a_run_with_rows_at_given_times_has_its_figures_and_its_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = |friction: &str, amplitude: f64, times: &str| {
        format!(
            "{friction}[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"ricker\"\n\
             amplitude_g = {amplitude}\nfrequency = 1.2\n[solver]\nt_end = 8\n[output]\ntimes = {times}\n"
        )
    };
    for (place, (friction, amplitude)) in
        [("", 0.5), ("friction = 0.3\n", 0.6), ("", 2.0), ("friction = 0.9\n", 2.0)].into_iter().enumerate()
    {
        for (number, (times, told)) in [
            ("[0.0, 0.125, 0.5, 0.6]", "at 4 times from 0 s to 0.6 s"),
            ("[0.2, 0.4]", "every 0.2 s, 2 rows"),
            ("[0.5]", "one row"),
        ]
        .into_iter()
        .enumerate()
        {
            let run = run_text(folder.path(), &format!("run-{place}-{number}"), &scene(friction, amplitude, times));
            assert!(page(&run).contains(told), "{told}");
            common::succeeds(folder.path(), &["plot", run.to_str().expect("text")]);
        }
    }
    let late = folder.path().join("late.toml");
    std::fs::write(&late, scene("", 0.5, "[7.9]") + "[initial]\ntheta = [1.0, 1.0]\n").expect("writable");
    common::succeeds(folder.path(), &["run", "late.toml", "--out", "late"]);
    let output = common::rocking(folder.path(), &["report", "late"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(2) && said.contains("there are no rows") && said.contains("output.times"),
        "{said}"
    );
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = common::rocking(folder.path(), &["report", "."]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).to_string();
    assert!(said.contains("summary.json") && said.contains("rocking run"), "{said}");
    assert!(!folder.path().join("report.html").exists());
}

/// Claims about the page as a browser shows it; each says so and passes where there is no Chromium.
#[cfg(unix)]
mod in_chromium {
    use super::browser::Browser;
    use super::{SCENES, common, hostile, page, run, run_text};
    use rocking::kinematics::outlines;
    use rocking::pattern::Pattern;
    use rocking::{Block, Column};
    use serde_json::{Value, json};
    use std::collections::HashSet;
    use std::path::Path;

    /// A run's rows: time, angles, pattern; base first.
    fn rows(run: &Path, blocks: usize) -> Vec<(f64, Vec<f64>, String)> {
        let mut reader = csv::Reader::from_path(run.join("response.csv")).expect("written");
        let row = |row: Result<csv::StringRecord, csv::Error>| {
            let row = row.expect("as written");
            let number = |column: usize| row[column].parse::<f64>().expect("a number");
            (number(0), (1..=blocks).map(number).collect(), row[row.len() - 1].to_string())
        };
        reader.records().map(row).collect()
    }

    fn json_of(run: &Path, file: &str) -> Value {
        serde_json::from_str(&std::fs::read_to_string(run.join(file)).expect("written")).expect("JSON")
    }

    fn column(run: &Path) -> Column {
        let summary = json_of(run, "summary.json");
        let blocks: Vec<Block> = serde_json::from_value(summary["column"]["blocks"].clone()).expect("blocks");
        Column::new(blocks, summary["column"]["gravity"].as_f64().expect("a number")).expect("valid")
    }

    fn numbers(value: &Value) -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|one| one.as_f64().expect("a number")).collect()
    }

    /// Written with ten digits behind the point: off by 5e-11 rad at most.
    const ANGLE: f64 = 1e-9;
    /// Corners are sums of a dozen lengths of metres turned by such angles.
    const LENGTH: f64 = 1e-6;

    #[test]
    #[cfg_attr(not(has_chromium), ignore = "needs Chromium")]
    fn the_page_shows_the_angles_and_corners_of_the_response() {
        let mut browser = Browser::start(1280);
        let folder = tempfile::tempdir().expect("a folder");
        for name in SCENES {
            let run = run(folder.path(), name);
            let column = column(&run);
            let rows = rows(&run, column.len());
            let events: Vec<f64> = json_of(&run, "events.json")
                .as_array()
                .expect("a list")
                .iter()
                .map(|event| event["t"].as_f64().expect("a time"))
                .collect();
            // Three rows by the address, as a reader of the page has them; every row by the page's own function.
            for index in [0, rows.len() / 3, rows.len() - 1] {
                let (t, theta, _) = &rows[index];
                browser.open(&run.join("report.html"), &format!("t={t:?}"));
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
        let folder = tempfile::tempdir().expect("a folder");
        // The second is dropped from a height, turned.
        let dropped = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.5\nhalf_height = 1.0\n[initial]\ntheta = [0.05, -0.1]\n\
            x = [0.0, 0.1]\ny = [0.7, 1.9]\nvx = [0.0, 0.0]\nvy = [0.0, 0.0]\n[solver]\nt_end = 0.3\n";
        for (name, scene) in [("slides", SLIDES), ("dropped", dropped)] {
            let run = run_text(folder.path(), name, scene);
            let mut reader = csv::Reader::from_path(run.join("response.csv")).expect("written");
            let head = reader.headers().expect("a head").clone();
            let of = |row: &csv::StringRecord, column: String| {
                let at = head.iter().position(|name| name == column).unwrap_or_else(|| panic!("no column {column}"));
                row[at].parse::<f64>().expect("a number")
            };
            let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("as written")).collect();
            let times: Vec<f64> = rows.iter().map(|row| of(row, "t".into())).collect();
            browser.open(&run.join("report.html"), "");
            let shown = browser.evaluate(&format!("{}.map(t => rocking.at(t))", json!(times)));
            for (row, shown) in rows.iter().zip(shown.as_array().expect("a list")) {
                for (block, corners) in shown["corners"].as_array().expect("a list").iter().enumerate() {
                    let corners: Vec<Vec<f64>> = corners.as_array().expect("four").iter().map(numbers).collect();
                    for (axis, column) in ["x", "y"].into_iter().enumerate() {
                        // Of a rectangle the centroid is the mean of the corners.
                        let centroid = corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0;
                        let expected = of(row, format!("{column}_{}", block + 1));
                        assert!(
                            (centroid - expected).abs() < JOINTS,
                            "{name}, t = {}: {centroid}, {expected}",
                            &row[0]
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
        let folder = tempfile::tempdir().expect("a folder");
        let run = run(folder.path(), "pulse");
        browser.open(&run.join("report.html"), "");
        for event in json_of(&run, "events.json").as_array().expect("a list") {
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
        let folder = tempfile::tempdir().expect("a folder");
        let scene = "[column]\nblocks = 21\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 0.1\n";
        let run = run_text(folder.path(), "tall", scene);
        browser.open(&run.join("report.html"), "");
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
        let folder = tempfile::tempdir().expect("a folder");
        let scene = std::fs::read_to_string(common::root().join("scenes/paper-3-blocks-3.00.toml")).expect("a scene");
        let coarse = super::run_text(folder.path(), "coarse", &format!("{scene}\n[output]\ndt = 0.01\n"));
        let fine = super::run_text(folder.path(), "fine", &format!("{scene}\n[output]\ndt = 0.001\n"));
        browser.open(&coarse.join("report.html"), "");
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
        let folder = tempfile::tempdir().expect("a folder");
        let run = run(folder.path(), "pulse");
        let file = run.join("report.html");
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
        let events = json_of(&run, "events.json");
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
        let folder = tempfile::tempdir().expect("a folder");
        for name in SCENES {
            let run = run(folder.path(), name);
            browser.open(&run.join("report.html"), "t=0.6");
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
        let folder = tempfile::tempdir().expect("a folder");
        let run = hostile(folder.path());
        // The folder's name is no address; the page is the same elsewhere.
        let file = folder.path().join("page.html");
        std::fs::write(&file, page(&run)).expect("writable");
        browser.open(&file, "t=0.5");
        assert_eq!(browser.evaluate("document.title"), super::HOSTILE);
        assert_eq!(browser.evaluate("document.querySelector('h1').textContent"), super::HOSTILE);
        assert_eq!(browser.evaluate("document.images.length"), 0);
        assert_eq!(browser.console, [""; 0]);
    }
}

/// Events name the interfaces that close; with friction, others stay open at angles that are rounding.
#[test]
fn impacts_with_friction_are_counted_at_the_interfaces_that_events_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "friction = 0.5\n[column]\nblocks = 5\ndiameter = 0.9\ntop_diameter = 0.7\nheight = 5.0\ndensity = 2500\n\
        [initial]\nslide = [0.0, 0.03, -0.02, 0.01, 0.0]\n[excitation.horizontal]\nkind = \"synthetic\"\npga_g = 0.8\nduration = 5\n[solver]\nt_end = 6\n";
    let run = run_text(folder.path(), "drums", scene);
    let page = page(&run);
    let events: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(run.join("events.json")).expect("written")).expect("JSON");
    let mut at = [0; 5];
    let mut impacts = 0;
    for event in events.as_array().expect("a list") {
        if !["impact", "landing"].contains(&event["kind"].as_str().expect("a kind")) {
            continue;
        }
        impacts += 1;
        let named = match event["interfaces"].as_array() {
            Some(several) => several.clone(),
            None => vec![event["interface"].clone()],
        };
        named.iter().for_each(|number| at[number.as_u64().expect("a number") as usize - 1] += 1);
    }
    assert!(impacts > 100, "{impacts}");
    for (interface, count) in (1..).zip(at) {
        assert!(page.contains(&format!("<li>interface {interface}: {count}</li>")), "{interface}: {count}");
    }
    assert!(page.contains("other events, by their first change: "));
}

#[test]
fn a_run_that_ends_at_its_start_has_figures_and_a_page_of_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let block = "[[block]]\nwidth = 0.6\nheight = 1.0\nmass = 1000\n";
    let scene = format!(
        "friction = 0.5\n{block}{block}[initial]\nx = [0.0, 0.9]\ny = [0.5, 1.6]\nvx = [0.0, 0.1]\nvy = [0.0, 0.0]\n[solver]\nt_end = 1e-9\n"
    );
    let run = run_text(folder.path(), "start", &scene);
    assert!(page(&run).contains("x = 0, 0.9 m; y = 0.5, 1.6 m; vx = 0, 0.1 m/s"));
    let scene = scene.replace("1.6]", "1.5]").replace("t_end = 1e-9", "t_end = 1");
    let run = run_text(folder.path(), "lost", &scene);
    common::succeeds(folder.path(), &["plot", "lost"]);
    let figure = std::fs::read_to_string(run.join("time-history.svg")).expect("drawn");
    assert!(!page(&run).contains("NaN") && !figure.contains("NaN"));
}
