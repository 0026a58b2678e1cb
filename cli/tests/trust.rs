//! Trust on the command line: a chaotic run says that its verdict is not determined, files of the run are the same without companions, and sweeps and
//! studies have it in their tables.

mod common;

use common::{rocking, succeeds};
use std::path::{Path, PathBuf};

/// Three slender drums in twenty seconds of harmonic motion.
const CHAOTIC: &str = "[column]\nblocks = 3\nhalf_width = 0.02\nhalf_height = 1.0\n\n[excitation.horizontal]\nkind = \"harmonic\"\n\
                       amplitude = 0.37\nomega = 12.566\nduration = 20.0\n\n[solver]\nt_end = 40.0\n";

const PLAIN: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n\n[restitution]\neta = 0.9\n\n[excitation.horizontal]\n\
                     kind = \"sine-pulse\"\namplitude = 7.3575\nomega = 10.7\n\n[solver]\nt_end = 10.0\n";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("chaotic.toml"), CHAOTIC).expect("a file");
    std::fs::write(folder.join("plain.toml"), PLAIN).expect("a file");
    folder
}

fn text(path: PathBuf) -> String {
    std::fs::read_to_string(path).expect("a file")
}

fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_str(&text(folder.join("summary.json"))).expect("JSON")
}

#[test]
fn a_chaotic_run_is_not_determined_in_text_summary_figure_and_report() {
    let folder = folder("trust-chaotic");
    let told = succeeds(&folder, &["run", "chaotic.toml", "--out", "with", "--report", "--plots"]);
    assert!(told.starts_with("not determined; this run rocks and stands at t = 40.0000 s"), "{told}");
    assert!(told.contains("trust: angles are known up to t = ") && told.contains("companions.csv"), "{told}");
    let summary = summary(&folder.join("with"));
    let trust = &summary["trust"];
    assert_eq!((&summary["status"], &trust["determined"]), (&"end-of-time".into(), &false.into()));
    assert_eq!(trust["outcome"], "not determined");
    let horizon = trust["horizon"].as_f64().expect("a number");
    assert!(horizon > 1.0 && horizon < 20.0, "{horizon}");
    assert_eq!(trust["companions"].as_array().map(Vec::len), Some(9));
    let report = text(folder.join("with/report.html"));
    assert!(
        report.contains("The verdict is <strong>not determined</strong>. In this run the column stands"),
        "the sentence"
    );
    assert!(report.contains("Shaded: the range of the run and its 9 companions"), "the band");
    // A page made of the folder is the same.
    succeeds(&folder, &["report", "with"]);
    assert_eq!(text(folder.join("with/report.html")), report);
    assert!(text(folder.join("with/time-history.svg")).contains("angles known up to here"));

    // Without companions: the same run, and nothing left of them.
    let before = ["response.csv", "events.json"].map(|name| text(folder.join("with").join(name)));
    let told = succeeds(&folder, &["run", "chaotic.toml", "--out", "with", "--no-trust"]);
    assert!(told.starts_with("rocks and stands at t = 40.0000 s") && !told.contains("trust"), "{told}");
    assert_eq!(["response.csv", "events.json"].map(|name| text(folder.join("with").join(name))), before);
    assert!(!folder.join("with/companions.csv").exists());
    assert!(self::summary(&folder.join("with"))["trust"].is_null());

    // A damaged band is refused with its line.
    succeeds(&folder, &["run", "chaotic.toml", "--out", "with"]);
    let band = text(folder.join("with/companions.csv"));
    std::fs::write(folder.join("with/companions.csv"), band.replacen("\n0.0,", "\nnought,", 1)).expect("a file");
    let refused = rocking(&folder, &["report", "with"]);
    assert!(!refused.status.success());
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(error.contains("companions.csv") && error.contains("line 2"), "{error}");
}

#[test]
fn a_plain_run_says_in_one_line_that_it_is_determined() {
    let folder = folder("trust-plain");
    let told = succeeds(&folder, &["run", "plain.toml", "--out", "out"]);
    let lines: Vec<&str> = told.lines().collect();
    assert!(lines[0].starts_with("rocks and stands at t = 10.0000 s"), "{told}");
    assert!(lines[1].starts_with("trust: 9 companions agree to the end, small changes grow "), "{told}");
    assert!(lines[1].ends_with("% more shaking") && lines[1].contains("; overturns with "), "{told}");
    assert!(!folder.join("out/companions.csv").exists());
    let trust = &summary(&folder.join("out"))["trust"];
    assert_eq!((&trust["determined"], &trust["verdict"]), (&true.into(), &"stands".into()));
    assert!(trust["fold"]["turns"][0]["change"].as_f64().is_some_and(|change| change > 0.0 && change < 0.1), "{trust}");
}

#[test]
fn a_sweep_has_a_column_of_trust_on_request() {
    let folder = folder("trust-sweep");
    let sweep = "scene = \"chaotic.toml\"\nask = \"trust\"\n\n[axes]\namplitude = [0.01, 0.37]\n";
    std::fs::write(folder.join("sweep.toml"), sweep).expect("a file");
    let told = succeeds(&folder, &["sweep", "sweep.toml", "--out", "table.csv"]);
    assert!(told.contains("the outcome of 1 run(s) is not determined (column trust)"), "{told}");
    let table = text(folder.join("table.csv"));
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|own| *own == name).expect("a column");
    let cell = |row: usize, name: &str| rows[row][column(name)];
    assert_eq!([cell(1, "trust"), cell(2, "trust")], ["determined", "not-determined"], "{table}");
    assert_eq!([cell(1, "outcome"), cell(2, "outcome")], ["no-uplift", "rocks"], "{table}");
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{table}");
    assert!(cell(2, "peak_3").parse::<f64>().is_ok_and(|peak| peak > 0.0), "{table}");
    succeeds(&folder, &["merge", "merged.csv", "table.csv", "--sweep", "sweep.toml"]);
    assert_eq!(text(folder.join("merged.csv")), table);
}

/// Long records on three slender drums: what is not determined counts as undecided in the table, the stripes and the legend.
#[test]
fn a_study_counts_runs_that_are_not_determined_as_undecided() {
    let folder = folder("trust-ida");
    let study = "scene = \"chaotic.toml\"\nmeasure = \"pga_uplift\"\nlevels = [0.5, 2.5, 3.5]\n\n[records.synthetic]\nseeds = { from = 1, to = 4 }\n\
                 duration = 30.0\nfrequency = 2.0\n\n[fragility]\nreplicates = 0\n";
    std::fs::write(folder.join("study.toml"), study).expect("a file");
    std::fs::write(folder.join("alone.toml"), format!("trust = false\n{study}")).expect("a file");
    let outcomes = |table: &str| -> Vec<String> {
        let table = text(folder.join(table));
        let place = table.lines().next().and_then(|head| head.split(',').position(|name| name == "outcome"));
        let place = place.expect("a column");
        table.lines().skip(1).map(|row| row.split(',').nth(place).expect("a cell").to_string()).collect()
    };
    let told = succeeds(&folder, &["ida", "study.toml", "--out", "ida.csv", "--plot", "ida.svg"]);
    let found = outcomes("ida.csv");
    let open = found.iter().filter(|outcome| *outcome == "not-determined").count();
    assert!(open > 0 && open < found.len(), "{found:?}");
    assert!(told.contains(&format!("not determined {open}")), "{told}");
    assert!(told.contains("undecided run(s) are left out"), "{told}");
    let figure = text(folder.join("ida.svg"));
    assert!(figure.contains(&format!("{open} of 12 runs undecided, left out")), "the legend");
    let stripes = text(folder.join("ida-stripes.csv"));
    let heads: Vec<&str> = stripes.lines().next().unwrap_or_default().split(',').collect();
    let place = heads.iter().position(|name| *name == "not_determined").expect("a column");
    let counted: usize =
        stripes.lines().skip(1).filter_map(|row| row.split(',').nth(place)?.parse::<usize>().ok()).sum();
    assert_eq!(counted, open);

    // Runs that are determined are those of the study without companions.
    succeeds(&folder, &["ida", "alone.toml", "--out", "alone.csv"]);
    let alone = outcomes("alone.csv");
    assert!(alone.iter().all(|outcome| outcome != "not-determined"));
    assert!(found.iter().zip(&alone).all(|(own, other)| own == other || own == "not-determined"));
}

/// Five drums whose run hangs on the lowest hop that is followed: below the default of 1e-9 rad peaks differ by 6 %, and no tolerance shows it.
#[test]
fn hops_that_are_not_followed_bound_the_horizon() {
    let folder = folder("trust-hops");
    let sizes = [(0.3650, 0.8692), (0.3905, 0.4867), (0.3514, 0.3809), (0.3429, 0.4012), (0.3419, 0.5789)];
    let blocks = sizes.map(|(half_width, half_height)| {
        format!("[[block]]\nhalf_width = {half_width}\nhalf_height = {half_height}\ndensity = 2700\ntop_half_width = 0.313\n")
    });
    let excitation = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.401\nfrequency = 1.859\n";
    let scene = format!("friction = 0.5\n{}{excitation}[solver]\nt_end = 12\n", blocks.concat());
    std::fs::write(folder.join("hops.toml"), scene).expect("a file");
    succeeds(&folder, &["run", "hops.toml", "--out", "hops"]);
    let trust = &summary(&folder.join("hops"))["trust"];
    assert!(trust["solver_horizon"].as_f64().is_some_and(|horizon| horizon < 2.0), "{trust}");
    assert_eq!(trust["determined"], false, "{trust}");
}
