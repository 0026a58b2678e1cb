//! Sweeps over distributions: failure probabilities against closed forms, samples that do not depend on the others, clear errors.

mod common;

use common::{rocking, succeeds};
use std::path::{Path, PathBuf};

/// A block under a constant acceleration that lasts: it overturns where that exceeds `g tan α = 2.4525 m/s²`, and nothing opens below.
const SCENE: &str = "[column]\nblocks = 1\nhalf_width = 0.25\nhalf_height = 1.0\n\n[excitation.horizontal]\nkind = \"rectangular\"\n\
                     amplitude = 1.0\nduration = 9.0\n\n[solver]\nt_end = 10.0\n";

fn folder(name: &str, sweep: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("scene.toml"), SCENE).expect("a file");
    std::fs::write(folder.join("sweep.toml"), format!("scene = \"scene.toml\"\n{sweep}")).expect("a file");
    folder
}

fn table(folder: &Path, name: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join(name)).expect("a table");
    text.lines().map(|line| line.split(',').map(String::from).collect()).collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().expect("a number")
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
            let folder = folder("sampling-probability", &sweep);
            let told = succeeds(&folder, &["sweep", "sweep.toml", "--out", "table.csv"]);
            let rows = table(&folder, "table-probability.csv");
            assert_eq!(rows[0], ["runs", "lost", "undecided", "probability", "low", "high"]);
            let [runs, lost, undecided, share, low, high] =
                [0, 1, 2, 3, 4, 5].map(|place: usize| number(&rows[1][place]));
            assert_eq!((runs, undecided, share), (2048.0, 0.0, lost / 2048.0));
            assert!((share - exact).abs() < error, "{method}: {share} and {exact}");
            assert!(low < exact && exact < high && high - low < 0.05, "{method}: {low} to {high}");
            assert!(
                told.contains(&format!("lost with probability {share:.4} ({lost} of 2048; 95 % confidence: ")),
                "{told}"
            );
        }
    }
}

/// Samples with each value of another axis, and shards with the rows of the whole.
#[test]
fn samples_are_found_without_the_others() {
    let sweep = "[sampling]\nsamples = 50\nseed = 3\n[axes]\namplitude = { uniform = [2.0, 3.0] }\n\
                 half_width = { normal = [0.25, 0.02], min = 0.2 }\nhalf_height = [0.9, 1.0, 1.1]\n";
    let folder = folder("sampling-shards", sweep);
    let told = succeeds(&folder, &["check", "sweep.toml"]);
    assert!(
        told.contains("150 point(s)") && told.contains("excitation.horizontal.amplitude: 50 value(s), from 2.0"),
        "{told}"
    );
    succeeds(&folder, &["sweep", "sweep.toml", "--out", "whole.csv"]);
    let rows = table(&folder, "whole.csv");
    assert_eq!(rows[0][..4], ["index", "column.half_height", "excitation.horizontal.amplitude", "column.half_width"]);
    // The same samples at each height, each within its bounds and one in each fiftieth.
    for sample in 0..50 {
        assert_eq!(rows[1 + sample][2..4], rows[51 + sample][2..4]);
    }
    let mut fiftieths: Vec<usize> = rows[1..51].iter().map(|row| ((number(&row[2]) - 2.0) * 50.0) as usize).collect();
    fiftieths.sort_unstable();
    assert!(fiftieths.into_iter().eq(0..50));
    assert!(rows[1..].iter().all(|row| number(&row[3]) >= 0.2));
    let probabilities = table(&folder, "whole-probability.csv");
    assert_eq!(probabilities.len(), 4);
    assert_eq!(probabilities[1..].iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["0.9", "1", "1.1"]);
    // Less slender, safer.
    assert!(number(&probabilities[1][4]) <= number(&probabilities[3][4]), "{probabilities:?}");
    for shard in ["1/3", "2/3", "3/3"] {
        succeeds(&folder, &["sweep", "sweep.toml", "--shard", shard, "--out", &format!("part-{}.csv", &shard[..1])]);
    }
    let told =
        succeeds(&folder, &["merge", "merged.csv", "part-3.csv", "part-1.csv", "part-2.csv", "--sweep", "sweep.toml"]);
    assert_eq!(table(&folder, "merged.csv"), rows);
    assert_eq!(table(&folder, "merged-probability.csv"), probabilities);
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
        let folder = folder("sampling-correlated", &sweep);
        succeeds(&folder, &["sweep", "sweep.toml", "--out", "table.csv"]);
        let rows = table(&folder, "table.csv");
        let column = |name: &str| -> Vec<f64> {
            let place = rows[0].iter().position(|own| own == name).expect("a column");
            rows[1..].iter().map(|row| number(&row[place])).collect()
        };
        let logarithms: Vec<f64> = column("excitation.horizontal.amplitude").iter().map(|a| a.ln()).collect();
        let axes = [logarithms, column("column.half_width"), column("column.half_height")];
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
        let folder = folder("sampling-refused", &sweep);
        let refused = rocking(&folder, &["sweep", "sweep.toml", "--out", "table.csv"]);
        let error = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{sweep}: {error}");
        let plain: String = error.split_whitespace().collect::<Vec<_>>().join(" ");
        for words in told {
            assert!(plain.contains(words), "{sweep}: `{words}` is not in {plain}");
        }
        assert!(!folder.join("table.csv").exists());
    }
}
