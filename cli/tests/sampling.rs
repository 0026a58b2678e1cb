//! Sweeps over distributions: failure probabilities against closed forms, samples that do not depend on the others, clear errors.

use crate::common::{Folder, assert_has, unbroken};

/// A block under a constant acceleration that lasts: it overturns where that exceeds `g tan α = 2.4525 m/s²`, and nothing opens below.
const SCENE: &str = "[column]\nblocks = 1\nhalf_width = 0.25\nhalf_height = 1.0\n\n[excitation.horizontal]\nkind = \"rectangular\"\n\
                     amplitude = 1.0\nduration = 9.0\n\n[solver]\nt_end = 10.0\n";

/// A folder with a sweep over that block.
fn folder(sweep: &str) -> Folder {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("sweep.toml", format!("scene = \"scene.toml\"\n{sweep}"));
    folder
}

/// `P(a > g tan α) = 1 - Φ(ln(g tan α / median) / dispersion)` of a lognormal acceleration.
#[test]
fn failure_probabilities_are_those_of_the_distribution() {
    // Φ(1) = 0.841345: the median lies a dispersion of 0.4 above the threshold, at it, and below it.
    let threshold: f64 = 2.4525;
    for (method, error) in [("plain", 0.04), ("latin-hypercube", 0.0006), ("sobol", 0.0006)] {
        for (median, exact) in
            [(threshold * 0.4f64.exp(), 0.841_345), (threshold, 0.5), (threshold * (-0.4f64).exp(), 0.158_655)]
        {
            let sweep = format!(
                "ask = \"overturns\"\n[sampling]\nsamples = 2048\nmethod = \"{method}\"\nseed = 5\n[axes]\namplitude = {{ lognormal = [{median}, 0.4] }}\n"
            );
            let folder = folder(&sweep);
            let told = folder.succeeds("sweep sweep.toml --out table.csv");
            let table = folder.table("table-probability.csv");
            let columns = ["runs", "lost", "undecided", "truncated", "probability", "low", "high"];
            assert_eq!(table.columns(), columns);
            let [runs, lost, undecided, truncated, share, low, high] = columns.map(|name| table.row(0).number(name));
            assert_eq!((runs, undecided, truncated, share), (2048.0, 0.0, 0.0, lost / 2048.0));
            assert!((share - exact).abs() < error, "{method}: {share} and {exact}");
            assert!(low < exact && exact < high && high - low < 0.05, "{method}: {low} to {high}");
            let printed = told.split_once("lost with probability ").and_then(|(_, rest)| rest.split_once(' '));
            let (printed, rest) = printed.expect("a probability");
            // Four digits.
            assert!((printed.parse::<f64>().expect("a number") / share - 1.0).abs() <= 5e-4, "{told}");
            assert!(rest.starts_with(&format!("({lost} of 2048; 95 % confidence: ")), "{told}");
        }
    }
}

/// Samples with each value of another axis, and shards with the rows of the whole.
#[test]
fn samples_are_found_without_the_others() {
    let sweep = "[sampling]\nsamples = 50\nseed = 3\n[axes]\namplitude = { uniform = [2.0, 3.0] }\n\
                 half_width = { normal = [0.25, 0.02], min = 0.2 }\nhalf_height = [0.9, 1.0, 1.1]\n";
    let folder = folder(sweep);
    let told = folder.succeeds("check sweep.toml");
    assert_has(&told, &["150 point(s)", "excitation.horizontal.amplitude: 50 value(s), from 2.0"]);
    folder.succeeds("sweep sweep.toml --out whole.csv");
    let table = folder.table("whole.csv");
    let [height, amplitude, width] = ["column.half_height", "excitation.horizontal.amplitude", "column.half_width"];
    assert_eq!(table.columns()[..4], ["index", height, amplitude, width]);
    // The same samples at each height, each within its bounds and one in each fiftieth.
    let (amplitudes, widths) = (table.texts(amplitude), table.texts(width));
    assert!(amplitudes[..50] == amplitudes[50..100] && widths[..50] == widths[50..100]);
    let mut fiftieths: Vec<usize> =
        table.numbers(amplitude)[..50].iter().map(|amplitude| ((amplitude - 2.0) * 50.0) as usize).collect();
    fiftieths.sort_unstable();
    assert!(fiftieths.into_iter().eq(0..50));
    assert!(table.numbers(width).iter().all(|width| *width >= 0.2));
    let probabilities = folder.table("whole-probability.csv");
    assert_eq!(probabilities.texts(probabilities.columns()[0]), ["0.9", "1", "1.1"]);
    // Less slender, safer.
    let shares = probabilities.numbers("probability");
    assert!(shares[0] <= shares[2], "{probabilities:?}");
    for shard in 1..=3 {
        folder.succeeds(&format!("sweep sweep.toml --shard {shard}/3 --out part-{shard}.csv"));
    }
    let told = folder.succeeds("merge merged.csv part-3.csv part-1.csv part-2.csv --sweep sweep.toml");
    assert_eq!(folder.table("merged.csv"), table);
    assert_eq!(folder.table("merged-probability.csv"), probabilities);
    assert!(told.contains("column.half_height = 0.9: lost with probability "), "{told}");
}

/// Correlations of normal axes are those asked for; of plain samples within 3 / √n, and of those of a Latin hypercube.
#[test]
fn axes_are_correlated_as_asked() {
    for method in ["plain", "latin-hypercube", "sobol"] {
        let sweep = format!(
            "[sampling]\nsamples = 4096\nmethod = \"{method}\"\ncorrelations = [{{ axes = [\"half_width\", \"amplitude\"], value = -0.7 }}]\n\
             [axes]\namplitude = {{ lognormal = [1.0, 0.3] }}\nhalf_height = {{ normal = [1.0, 0.01] }}\nhalf_width = {{ normal = [0.25, 0.01] }}\n"
        );
        let folder = folder(&sweep);
        folder.succeeds("sweep sweep.toml --out table.csv");
        let table = folder.table("table.csv");
        let logarithms = table.numbers("excitation.horizontal.amplitude").iter().map(|a| a.ln()).collect();
        let axes: [Vec<f64>; 3] = [logarithms, table.numbers("column.half_width"), table.numbers("column.half_height")];
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let product = |a: &[f64], b: &[f64]| {
            let (of_a, of_b) = (mean(a), mean(b));
            mean(&a.iter().zip(b).map(|(a, b)| (a - of_a) * (b - of_b)).collect::<Vec<_>>())
        };
        let correlation = |a: usize, b: usize| {
            product(&axes[a], &axes[b]) / (product(&axes[a], &axes[a]) * product(&axes[b], &axes[b])).sqrt()
        };
        let found = [correlation(0, 1), correlation(0, 2), correlation(1, 2)];
        for (found, wanted) in found.into_iter().zip([-0.7, 0.0, 0.0]) {
            assert!((found - wanted).abs() < 3.0 / 64.0, "{method}: {found} and {wanted}");
        }
        assert!((product(&axes[1], &axes[1]).sqrt() / 0.01 - 1.0).abs() < 0.05, "the deviation stays");
    }
}

#[test]
fn bad_distributions_are_refused_with_place_and_remedy() {
    let sampling = "[sampling]\nsamples = 200\n";
    for (sweep, told) in [
        // A share of widths below zero.
        (
            format!("{sampling}[axes]\nhalf_width = {{ normal = [0.25, 0.2] }}\n"),
            vec!["half_width", "sample ", " is -0.", "`min` and `max`", "sweep.toml:5"],
        ),
        ("[axes]\nhalf_width = { normal = [0.25, 0.01] }\n".into(), vec!["[sampling]", "samples = 1000"]),
        (
            format!("{sampling}[axes]\nhalf_width = {{ normal = [0.25, 0.01], min = 0.3, max = 0.2 }}\n"),
            vec!["truncated to 0.3 .. 0.2 a share of 0e0 is left", "the lower one first"],
        ),
        (format!("{sampling}[axes]\nhalf_width = [0.25]\n"), vec!["no axis is a distribution"]),
        (
            format!("{sampling}[axes]\nhalf_width = {{ gumbel = [0.25, 0.01] }}\n"),
            vec!["axes.half_width", "`gumbel` makes no axis", "normal, lognormal, uniform, discrete"],
        ),
        (format!("{sampling}[axes]\nhalf_width = {{ normal = [0.25] }}\n"), vec!["1 number(s)", "standard deviation"]),
        (format!("{sampling}[axes]\nhalf_width = {{ lognormal = [-1, 0.2] }}\n"), vec!["a median of -1"]),
        (format!("{sampling}[axes]\nhalf_width = {{ uniform = [0.3, 0.2] }}\n"), vec!["smaller end first"]),
        (
            format!("{sampling}[axes]\nhalf_width = {{ normal = [0.25, 0.01], min = 5.0 }}\n"),
            vec!["truncated to 5 ..", "lower one first"],
        ),
        (
            format!("{sampling}[axes]\nhalf_width = {{ discrete = [0.2, 0.3], weights = [1] }}\n"),
            vec!["1 weight(s) for 2 value(s)"],
        ),
        (
            "[sampling]\nsamples = 70000\nmethod = \"sobol\"\n[axes]\nhalf_width = { uniform = [0.2, 0.3] }\n".into(),
            vec!["70000 samples are too many", "65536"],
        ),
        (
            "[sampling]\nsamples = 10\nmethod = \"halton\"\n[axes]\nhalf_width = { uniform = [0.2, 0.3] }\n".into(),
            vec!["halton", "latin-hypercube"],
        ),
        (
            format!("combine = \"paired\"\n{sampling}[axes]\nhalf_width = {{ uniform = [0.2, 0.3] }}\n"),
            vec!["leave `combine` out"],
        ),
        (
            format!(
                "{sampling}correlations = [{{ axes = [\"half_width\", \"half_height\"], value = 0.5 }}]\n[axes]\nhalf_width = {{ uniform = [0.2, 0.3] }}\n"
            ),
            vec!["`half_height` is no distributed axis", "column.half_width"],
        ),
        (
            format!(
                "{sampling}correlations = [{{ axes = [\"half_width\", \"half_height\"], value = 1.5 }}]\n[axes]\nhalf_width = {{ uniform = [0.2, 0.3] }}\n"
            ),
            vec!["1.5 is out of range", "below 1"],
        ),
        (
            format!("{sampling}[axes]\nhalf_width = {{ normal = [0.25, 0.01], minimum = 0.2 }}\n"),
            vec!["minimum", "known here are"],
        ),
    ] {
        let folder = folder(&sweep);
        let message = unbroken(&folder.refused("sweep sweep.toml --out table.csv", &[]));
        assert_has(&message, &told);
        assert!(!folder.has("table.csv"));
    }
}

/// A value that is wrong beside some values of another axis, and right beside others, is no reason to refuse the sweep: such samples are rows with errors.
/// Whether a sweep was refused hung on its seed.
#[test]
fn samples_that_do_not_fit_together_are_rows_with_errors() {
    let friction = "friction = { static = [0.6], kinetic = [0.4] }\n";
    for seed in 0..6 {
        let sweep = format!(
            "[sampling]\nsamples = 20\nseed = {seed}\n[axes]\nfriction.static = {{ uniform = [0.3, 0.5] }}\nfriction.kinetic = {{ uniform = [0.2, 0.51] }}\n"
        );
        let folder = folder(&sweep);
        folder.write("scene.toml", format!("{friction}{SCENE}"));
        folder.succeeds("sweep sweep.toml --out table.csv");
        let table = folder.table("table.csv");
        let wrong = table.rows().filter(|row| row.number("friction.kinetic") > row.number("friction.static")).count();
        let errors = table.rows().filter(|row| row.text("outcome") == "error").count();
        assert!(errors == wrong && errors < 20, "seed {seed}: {errors} error(s), {wrong} pair(s)");
    }
    // A negative coefficient is none of any scene, of an item of a list either. What the base scene has at another item is not the sample's fault.
    let folder = folder(
        "[sampling]\nsamples = 5\n[axes]\n\"friction.static[1]\" = { normal = [0.1, 0.2] }\nhalf_width = { normal = [0.25, 0.01] }\n",
    );
    folder.write("scene.toml", format!("{friction}{SCENE}").replace("kinetic = [0.4]", "kinetic = [0.0]"));
    folder.refused("sweep sweep.toml --out table.csv", &["axes.friction.static[1]", "sample ", " is -0."]);
    let two = SCENE.replace("blocks = 1", "blocks = 2");
    folder.write("scene.toml", format!("friction = {{ static = [0.6, 0.6], kinetic = [0.4, 0.5] }}\n{two}"));
    folder.write("sweep.toml", "scene = \"scene.toml\"\n[sampling]\nsamples = 5\n[axes]\n\"friction.kinetic[1]\" = { uniform = [0.2, 0.3] }\n\"friction.static[2]\" = { uniform = [0.3, 0.6] }\n");
    folder.succeeds("sweep sweep.toml --out table.csv");
    let table = folder.table("table.csv");
    let error =
        table.rows().map(|row| row.text("error")).find(|error| !error.is_empty()).expect("a pair that does not fit");
    assert!(error.contains("0.5 is above the static coefficient") && !error.contains("axis `"), "{error}");
}

/// Rare failures have digits: with four decimals, 5 in a million were 0.0000.
#[test]
fn rare_probabilities_are_printed_with_their_digits() {
    let sweep = "ask = \"overturns\"\n[axes]\namplitude = { lognormal = [1.2, 0.2] }\n[sampling]\nsamples = 20000\nmethod = \"plain\"\n";
    let folder = folder(sweep);
    let told = folder.succeeds("sweep sweep.toml --out table.csv");
    let line = told.lines().find(|line| line.starts_with("lost with probability")).expect("a probability");
    let row = folder.table("table-probability.csv");
    let [lost, low, high] = ["lost", "low", "high"].map(|name| row.row(0).number(name));
    assert!(lost > 0.0 && lost < 100.0, "{line}");
    let (_, interval) = line.split_once("confidence: ").expect("an interval");
    let ends: Vec<f64> =
        interval.trim_end_matches(')').split(" to ").map(|end| end.parse().expect("a number")).collect();
    for (printed, exact) in ends.iter().zip([low, high]) {
        assert!((printed / exact - 1.0).abs() <= 5e-4, "{line}");
    }
}

/// All samples overturn. The table that is merged says of one that its companions do not agree.
#[test]
fn a_sample_whose_verdict_is_not_determined_is_left_out() {
    let folder = folder("ask = \"trust\"\n[sampling]\nsamples = 4\n[axes]\namplitude = { uniform = [3.0, 4.0] }\n");
    folder.succeeds("sweep sweep.toml --out table.csv");
    let counts = |name: &str| {
        let table = folder.table(name);
        ["runs", "lost", "undecided"].map(|column| table.row(0).number(column))
    };
    assert_eq!(counts("table-probability.csv"), [4.0, 4.0, 0.0]);
    folder.write("table.csv", folder.read("table.csv").replacen(",determined,", ",not-determined,", 1));
    folder.succeeds("merge merged.csv table.csv --sweep sweep.toml");
    assert_eq!(counts("merged-probability.csv"), [3.0, 3.0, 1.0]);
}

/// Of runs that `t_end` cuts nobody knows what becomes of the column: the table says how many count as standing. Overturning takes longer than 0.4 s.
#[test]
fn probabilities_say_how_many_runs_are_cut() {
    let sampled = "[sampling]\nsamples = 16\n[axes]\namplitude = { uniform = [3.0, 4.0] }\n";
    for (t_end, lost, truncated) in [("0.4", 0.0, 16.0), ("20.0", 16.0, 0.0)] {
        let folder = folder(&format!("ask = \"overturns\"\n{sampled}"));
        folder.write("scene.toml", SCENE.replace("t_end = 10.0", &format!("t_end = {t_end}")));
        let told = folder.succeeds("sweep sweep.toml --out table.csv");
        let table = folder.table("table-probability.csv");
        let counts = ["runs", "lost", "undecided", "truncated"].map(|name| table.row(0).number(name));
        assert_eq!(counts, [16.0, lost, 0.0, truncated], "{t_end}");
        assert_eq!(told.contains("; 16 cut, counted as standing\n"), truncated > 0.0, "{told}");
    }
}

/// A file that has the name of what a sweep makes or removes, but is not of that kind, is the user's.
#[test]
fn files_of_other_kinds_are_neither_removed_nor_replaced() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("plain.toml", "scene = \"scene.toml\"\n[axes]\neta = [0.8, 0.9]\n");
    let sampled = "scene = \"scene.toml\"\n[sampling]\nsamples = 8\n[axes]\neta = { uniform = [0.8, 0.9] }\n";
    folder.write("sampled.toml", sampled);
    // The table of another sweep, and notes.
    folder.succeeds("sweep plain.toml --out t-probability.csv");
    folder.write("t-stripes.csv", "my own notes\n");
    folder.write("t.csv.digest", "my own notes\n");
    let kept = ["t-probability.csv", "t-stripes.csv", "t.csv.digest"].map(|name| (name, folder.read(name)));
    folder.succeeds("sweep plain.toml --out t.csv");
    folder.refused("sweep sampled.toml --out t.csv", &["t-probability.csv", "it is no table of probabilities"]);
    folder.succeeds("merge t.csv t-probability.csv");
    folder.write("notes.csv", "my own notes\n");
    let fragility = "fragility --state overturned --replicates 0 --measure restitution.eta t.csv --out";
    folder.refused(&format!("{fragility} notes.csv"), &["notes.csv", "it is no table of fragility curves"]);
    // A shard would write its digest there.
    folder.refused("sweep plain.toml --out t.csv --shard 1/2", &["t.csv.digest", "no command here has written it"]);
    kept.iter().for_each(|(name, text)| assert_eq!(folder.read(name), *text, "{name}"));
    // What the commands have made goes with its table.
    folder.succeeds(&format!("{fragility} t-fragility.csv"));
    folder.succeeds(&format!("{fragility} t-fragility.csv"));
    folder.succeeds("sweep plain.toml --out t.csv");
    assert!(!folder.has("t-fragility.csv") && !folder.has("t-shares.csv"));
}

/// The probabilities of an earlier sweep of that name are not those of the merged table.
#[test]
fn merging_removes_what_belongs_to_an_earlier_table() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write(
        "sampled.toml",
        "scene = \"scene.toml\"\n[sampling]\nsamples = 8\n[axes]\neta = { uniform = [0.8, 0.9] }\n",
    );
    folder.succeeds("sweep sampled.toml --out table.csv");
    assert!(folder.has("table-probability.csv"));
    folder.write("plain.toml", "scene = \"scene.toml\"\n[axes]\neta = [0.8, 0.85, 0.9]\n");
    folder.succeeds("sweep plain.toml --out a.csv --shard 1/2");
    folder.succeeds("sweep plain.toml --out b.csv --shard 2/2");
    folder.succeeds("merge table.csv a.csv b.csv");
    assert!(folder.has("table.csv") && !folder.has("table-probability.csv"));
}
