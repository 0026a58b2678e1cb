//! Trust on the command line: a chaotic run says that its verdict is not determined, files of the run are the same without companions, and sweeps and
//! studies have it in their tables.

use crate::common::figures::words;
use crate::common::{Folder, assert_has};

/// Three slender drums in twenty seconds of harmonic motion.
const CHAOTIC: &str = "[column]\nblocks = 3\nhalf_width = 0.02\nhalf_height = 1.0\n\n[excitation.horizontal]\nkind = \"harmonic\"\n\
                       amplitude = 0.37\nomega = 12.566\nduration = 20.0\n\n[solver]\nt_end = 40.0\n";

const PLAIN: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n\n[restitution]\neta = 0.9\n\n[excitation.horizontal]\n\
                     kind = \"sine-pulse\"\namplitude = 7.3575\nomega = 10.7\n\n[solver]\nt_end = 10.0\n";

#[test]
fn a_chaotic_run_is_not_determined_in_text_summary_figure_and_report() {
    let folder = Folder::with("chaotic.toml", CHAOTIC);
    let told = folder.succeeds("run chaotic.toml --out with --report --plots");
    assert!(told.starts_with("not determined; this run rocks and stands at t = 40.0000 s"), "{told}");
    assert_has(&told, &["angles are known up to t = ", "companions.csv"]);
    let summary = folder.json("with/summary.json");
    let trust = &summary["trust"];
    assert_eq!((&summary["status"], &trust["determined"]), (&"end-of-time".into(), &false.into()));
    assert_eq!(trust["outcome"], "not determined");
    let horizon = trust["horizon"].as_f64().expect("a number");
    assert!(horizon > 1.0 && horizon < 20.0, "{horizon}");
    assert_eq!(trust["companions"].as_array().map(Vec::len), Some(9));
    let report = folder.read("with/report.html");
    assert!(
        report.contains("The verdict is <strong>not determined</strong>. In this run the column stands"),
        "the sentence"
    );
    assert!(report.contains("Shaded: the range of the run and its 9 companions"), "the band");
    // A page made of the folder is the same.
    folder.succeeds("report with");
    assert_eq!(folder.read("with/report.html"), report);
    assert!(folder.read("with/time-history.svg").contains("known up to here, if inputs were exact"));

    // Without companions: the same run, and nothing left of them.
    let before = ["response.csv", "events.json"].map(|name| folder.read(&format!("with/{name}")));
    let told = folder.succeeds("run chaotic.toml --out with --no-trust");
    assert!(told.starts_with("rocks and stands at t = 40.0000 s") && !told.contains("trust"), "{told}");
    assert_eq!(["response.csv", "events.json"].map(|name| folder.read(&format!("with/{name}"))), before);
    assert!(!folder.has("with/companions.csv"));
    assert!(folder.json("with/summary.json")["trust"].is_null());

    // On one thread: the same files.
    folder.succeeds("run chaotic.toml --out with");
    let files = ["companions.csv", "response.csv", "events.json"];
    let whole = files.map(|name| folder.read(&format!("with/{name}")));
    folder.succeeds("run chaotic.toml --out with --threads 1");
    assert_eq!(files.map(|name| folder.read(&format!("with/{name}"))), whole);

    // A damaged band is refused with its line.
    let band = folder.read("with/companions.csv");
    folder.write("with/companions.csv", band.replacen("\n0.0,", "\nnought,", 1));
    folder.refused("report with", &["companions.csv", "line 2"]);
    std::fs::remove_file(folder.path("with/companions.csv")).expect("it is there");
    folder.refused("report with", &["companions.csv", "No such file"]);
}

#[test]
fn a_plain_run_says_in_one_line_that_it_is_determined() {
    let folder = Folder::with("plain.toml", PLAIN);
    let told = folder.succeeds("run plain.toml --out out");
    let lines: Vec<&str> = told.lines().collect();
    assert!(lines[0].starts_with("rocks and stands at t = 10.0000 s"), "{told}");
    assert!(lines[1].starts_with("trust: 9 companions agree to the end, small changes grow "), "{told}");
    assert!(lines[1].ends_with("% more shaking") && lines[1].contains("; overturns with "), "{told}");
    assert!(!folder.has("out/companions.csv"));
    let trust = &folder.summary()["trust"];
    assert_eq!((&trust["determined"], &trust["verdict"]), (&true.into(), &"stands".into()));
    assert!(trust["fold"]["turns"][0]["change"].as_f64().is_some_and(|change| change > 0.0 && change < 0.1), "{trust}");
}

#[test]
fn a_sweep_has_a_column_of_trust_on_request() {
    let folder = Folder::with("chaotic.toml", CHAOTIC);
    let sweep = "scene = \"chaotic.toml\"\nask = \"trust\"\n\n[axes]\namplitude = [0.01, 0.37]\n";
    folder.write("sweep.toml", sweep);
    let told = folder.succeeds("sweep sweep.toml --out table.csv");
    assert!(told.contains("no uplift 1, rocks 0, overturns 0, not determined (column trust) 1, errors 0"), "{told}");
    let table = folder.table("table.csv");
    assert_eq!(table.texts("trust"), ["determined", "not-determined"], "{table:?}");
    assert_eq!(table.texts("outcome"), ["no-uplift", "rocks"], "{table:?}");
    assert!(table.row(1).number("peak_3") > 0.0, "{table:?}");
    folder.succeeds("merge merged.csv table.csv --sweep sweep.toml");
    assert_eq!(folder.read("merged.csv"), folder.read("table.csv"));

    // Over two axes such runs are hatched, and belong to no share.
    folder.write("sweep.toml", sweep.replace("[axes]", "[axes]\nomega = [12.566, 100.0]"));
    let told = folder.succeeds("sweep sweep.toml --out plane.csv");
    assert!(told.contains("not determined (column trust)"), "{told}");
    // Without largest angles the plane is drawn.
    let plane = folder.read("plane.csv").replace("peak_", "angle_");
    folder.write("plane.csv", plane);
    let told = folder.succeeds("plot plane.csv");
    assert!(told.contains("1 of 4 runs is not determined and is left out"), "{told}");
    assert!(folder.read("plane.svg").contains("not determined (hatched), 25 %"));
}

/// Long records on three slender drums: what is not determined counts as undecided in the table, the stripes and the legend.
#[test]
fn a_study_counts_runs_that_are_not_determined_as_undecided() {
    let folder = Folder::with("chaotic.toml", CHAOTIC);
    let study = "scene = \"chaotic.toml\"\nmeasure = \"pga_uplift\"\nlevels = [0.5, 1.2, 1.5]\n\n[records.synthetic]\nseeds = { from = 1, to = 4 }\n\
                 duration = 30.0\nfrequency = 2.0\n\n[fragility]\nreplicates = 0\n";
    folder.write("study.toml", study);
    folder.write("alone.toml", format!("trust = false\n{study}"));
    let told = folder.succeeds("ida study.toml --out ida.csv --plot ida.svg");
    let table = folder.table("ida.csv");
    let found = table.texts("outcome");
    let open = found.iter().filter(|outcome| **outcome == "not-determined").count();
    let trust = table.texts("trust");
    let likely = trust.iter().filter(|degree| **degree == "likely").count();
    assert!(open > 0 && likely > 0 && open + likely < found.len(), "{found:?} {trust:?}");
    let agree = |(outcome, degree): (&&str, &&str)| (*outcome == "not-determined") == (*degree == "not-determined");
    assert!(found.iter().zip(&trust).all(agree), "{found:?} {trust:?}");
    assert_has(&told, &[&format!("\nlikely: {likely} run(s), counted with their own outcome")]);
    assert!(told.contains(&format!("not determined {open}")), "{told}");
    assert_has(&told, &["\nnot determined: companions end otherwise (", "undecided run(s) are left out"]);
    let figure = folder.read("ida.svg");
    assert!(figure.contains(&format!("{open} of 12 runs undecided, left out")), "the legend");
    let counted: f64 = folder.table("ida-stripes.csv").numbers("not_determined").iter().sum();
    assert_eq!(counted, open as f64);

    // Runs that are determined or likely are those of the study without companions.
    folder.succeeds("ida alone.toml --out alone.csv");
    let alone = folder.table("alone.csv");
    assert!(!folder.read("alone.csv").contains("trust"));
    let alone = alone.texts("outcome");
    assert!(alone.iter().all(|outcome| *outcome != "not-determined"));
    assert!(found.iter().zip(&alone).all(|(own, other)| own == other || *own == "not-determined"));
}

/// Five drums whose run hangs on the lowest hop that is followed: below the default of 1e-9 rad peaks differ by 6 %, and no tolerance shows it.
#[test]
fn hops_that_are_not_followed_bound_the_horizon() {
    let sizes = [(0.3650, 0.8692), (0.3905, 0.4867), (0.3514, 0.3809), (0.3429, 0.4012), (0.3419, 0.5789)];
    let blocks = sizes.map(|(half_width, half_height)| {
        format!("[[block]]\nhalf_width = {half_width}\nhalf_height = {half_height}\ndensity = 2700\ntop_half_width = 0.313\n")
    });
    let excitation = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.401\nfrequency = 1.859\n";
    let scene = format!("friction = 0.5\n{}{excitation}[solver]\nt_end = 12\n", blocks.concat());
    let folder = Folder::with("hops.toml", &scene);
    // The column stands in all runs, the 24 further ones included.
    let told = folder.succeeds("run hops.toml --out hops --report");
    assert!(told.starts_with("not determined, but likely; this run rocks and stands"), "{told}");
    assert_has(&told, &["all 33 companions stand as well\n"]);
    assert!(
        folder
            .read("hops/report.html")
            .contains("The verdict is <strong>not determined</strong>, but likely. In this run the column")
    );
    let trust = &folder.json("hops/summary.json")["trust"];
    assert!(trust["solver_horizon"].as_f64().is_some_and(|horizon| horizon < 2.0), "{trust}");
    assert_eq!(
        (&trust["determined"], &trust["likely"], &trust["further"]["others"]),
        (&false.into(), &true.into(), &0.into()),
        "{trust}"
    );
    folder.succeeds("report hops");
}

/// Four equal drums that slide and do not rock: equal coefficients of friction decide which of them slides, and no two joints are so equal. The column stands
/// whichever it is.
#[test]
fn slides_that_equal_friction_decides_are_not_known() {
    let drums = "[friction]\nstatic = 0.4\nkinetic = 0.3\n[column]\nblocks = 4\nhalf_width = 1.0\nhalf_height = 2.0\n";
    let shaking = "[excitation.horizontal]\nkind = \"synthetic\"\npga_g = 0.7\nduration = 15.0\nseed = 4\n";
    let folder = Folder::with("s.toml", &format!("{drums}{shaking}"));
    let told = folder.succeeds("run s.toml");
    assert!(told.starts_with("slides and stands"), "{told}");
    assert_has(&told, &["trust: 33 companions agree to the end but for slides, ", "; slides are known up to t = 1."]);
    let trust = folder.summary()["trust"].clone();
    assert_eq!((&trust["determined"], &trust["further"]["others"]), (&true.into(), &0.into()));
    assert!(trust["slide_horizon"].as_f64().is_some_and(|horizon| horizon < 2.0), "{trust}");
    // The figure says so, too.
    let told = folder.succeeds("plot out");
    assert_has(
        &told,
        &[
            "At the end of this run alone (companions, which differ by less than anybody can know, have the same slides up to t = 1.",
        ],
    );
    assert!(words(&folder.read("out/slides.svg")).contains(&"known up to here".into()));
    // Coefficients that differ by a millionth make other drums slide.
    let slides = || folder.summary()["sliding"]["residual_slide"].as_array().expect("a list").clone();
    let own = slides();
    folder.write("s.toml", format!("{drums}{shaking}").replace("static = 0.4", "static = [0.4, 0.3999996, 0.4, 0.4]"));
    folder.succeeds("run s.toml --no-trust");
    let far = |(own, other): (&serde_json::Value, &serde_json::Value)| {
        (own.as_f64().expect("a number") - other.as_f64().expect("a number")).abs() > 0.05
    };
    assert!(own.iter().zip(&slides()).any(far), "{own:?}");
    // So it is where interfaces are equal in pairs.
    let pairs = "static = [0.4, 0.9, 0.4, 0.9]\nkinetic = [0.3, 0.8, 0.3, 0.8]";
    folder.write("s.toml", format!("{drums}{shaking}").replace("static = 0.4\nkinetic = 0.3", pairs));
    assert_has(&folder.succeeds("run s.toml"), &["; slides are known up to t = 6."]);
}

/// Slides that companions do not share are those of the run itself, one draw: left out, only runs without slides and lost columns would count.
#[test]
fn a_study_counts_slides_that_companions_do_not_share() {
    let drums = "[friction]\nstatic = 0.4\nkinetic = 0.3\n[column]\nblocks = 4\nhalf_width = 0.5\nhalf_height = 0.8\n";
    let folder = Folder::with("s.toml", drums);
    let study = "scene = \"s.toml\"\nmeasure = \"pgv\"\nlevels = [0.2, 1.0]\n[records.synthetic]\nseeds = [1, 2]\nduration = 12.0\n\
                 frequency = 1.5\n[fragility]\nstates = [\"overturned\", \"slide > 0.05\"]\nreplicates = 0\n";
    folder.write("study.toml", study);
    folder.succeeds("ida study.toml --out ida.csv");
    let table = folder.table("ida.csv");
    assert_eq!(table.texts("outcome"), ["no-uplift", "slides", "no-uplift", "slides"]);
    assert_eq!(table.texts("trust"), ["determined"; 4]);
    let slides = table.numbers("residual_slide_1");
    assert!(slides[0] == 0.0 && slides[2] == 0.0 && slides[1] != 0.0 && slides[3] != 0.0, "{slides:?}");
    assert_eq!(folder.table("ida-fragility.csv").numbers("undecided"), [0.0, 0.0]);
    // They are those of the run alone.
    folder.write("study.toml", format!("trust = false\n{study}"));
    folder.succeeds("ida study.toml --out alone.csv");
    assert_eq!(folder.table("alone.csv").numbers("residual_slide_1"), slides);
}

/// One block under a pulse just below that which overturns it; the run ends 0.8 s after the pulse.
fn nearly_overturns(amplitude: f64) -> String {
    format!(
        "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude = {amplitude}\n\
         period = 1.2\n[solver]\nt_end = 2.0\n"
    )
}

/// Companions that stand at the end but may be falling then have another verdict than a run that stands for certain.
#[test]
fn companions_that_may_be_falling_at_the_end_do_not_stand() {
    let folder = Folder::with("s.toml", &nearly_overturns(3.6013));
    let told = folder.succeeds("run s.toml");
    assert_has(&told, &["trust: 9 companions agree to the end", "; may overturn with 0.1 % more shaking\n"]);
    // A millionth more is enough.
    folder.write("s.toml", nearly_overturns(3.602395));
    let told = folder.succeeds("run s.toml");
    assert_has(
        &told,
        &[
            "not determined; ",
            "known to the end of the run, but the column may be falling then: give a later t_end; small changes grow ",
            " may overturn\n",
        ],
    );
    let trust = folder.summary()["trust"].clone();
    assert_eq!((&trust["verdict"], &trust["determined"]), (&"stands".into(), &false.into()));
    assert!(trust["companions"].as_array().expect("a list").iter().any(|one| one["verdict"] == "may-overturn"));
}

/// A run at rest from the start, of which a change of a millionth makes one that overturns: it is compared beyond its end.
#[test]
fn a_run_at_rest_is_compared_to_the_end_of_the_time() {
    let scene = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"rectangular\"\namplitude_uplift = 1.0\nduration = 12.0\n";
    let folder = Folder::with("s.toml", scene);
    let told = folder.succeeds("run s.toml");
    assert_has(
        &told,
        &[
            "not determined; ",
            "a change of the inputs by a millionth alters the motion from t = ",
            "small changes grow more than ",
            "companions.csv",
        ],
    );
    let trust = folder.summary()["trust"].clone();
    assert!(trust["input_horizon"].as_f64().expect("a number") > 1.0, "{trust}");
}
