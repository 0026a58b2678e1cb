//! Rocking spectra: sweeps with `ask = "peaks"` over the size of the column, and their figures; figures of one axis and of paired axes.

use crate::common::figures::parts;
use crate::common::{Folder, assert_has, figures};
use rocking::ground::Synthetic;
use rocking::studies::fractile;
use rocking::{Block, Column, Excitation, Motion, Restitution, Scene, Sweep, simulate};
use roxmltree::{Document, Node};
use std::collections::HashMap;
use std::f64::consts::TAU;

const COLUMN: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[restitution]\neta = 0.9\n";

const NOISE: &str = "[excitation.horizontal]\nkind = \"synthetic\"\nduration = 8\npga_g = 0.35\nfrequency = 1.5\n";

/// A folder with a base scene and a sweep.
fn folder(scene: &str, sweep: &str) -> Folder {
    let folder = Folder::with("base.toml", scene);
    folder.write("sweep.toml", format!("scene = \"base.toml\"\n{sweep}"));
    folder
}

/// The texts of a figure.
fn words(folder: &Folder, name: &str) -> Vec<String> {
    figures::words(&folder.read(name))
}

/// Slenderness, rocking period, record: columns made by hand of both, records by hand of their seeds.
#[test]
fn the_values_of_a_spectrum_are_those_of_single_runs() {
    let axes = "ask = \"peaks\"\n[axes]\nalpha = [0.15, 0.25]\nseed = { from = 1, to = 4 }\n\
        rocking_period = { from = 1.5, to = 4.5, steps = 4 }\n";
    let folder = folder(&format!("{COLUMN}{NOISE}[solver]\nt_end = 14.0\n"), axes);
    let told = folder.succeeds("sweep sweep.toml --plot f.svg");
    assert!(told.contains("wrote f.svg: Rocking spectrum: the largest |θ|/α over 2π/p [s], 4 records"), "{told}");
    let table = folder.table("sweep.csv");
    assert_eq!(table.len(), 32);
    let mut by_point: HashMap<String, Vec<f64>> = HashMap::new();
    let mut compared = 0;
    for row in table.rows() {
        let (alpha, period) = (row.number("size.alpha"), row.number("size.rocking_period"));
        let seed = row.number("excitation.horizontal.seed") as u64;
        // p² = 3 g / (4 R) of a rectangular block.
        let radius = 0.75 * 9.81 * (period / TAU).powi(2);
        let block = Block::rectangle(radius * alpha.sin(), radius * alpha.cos(), 1.0);
        let mut scene = Scene::new(Column::new(vec![block], 9.81).expect("valid"));
        scene.restitution = Restitution::Eta(0.9);
        scene.options.t_end = 14.0;
        let record = Synthetic { seed, duration: 8.0, frequency: 1.5, pga: 0.35 * 9.81, ..Synthetic::default() };
        let record = Motion::Record(record.record().expect("valid"));
        scene.excitation = Excitation { horizontal: Some(record), vertical: None };
        let response = simulate(&scene).expect("runs");
        assert_eq!(row.text("outcome") == "overturns", response.status.overturns(), "{row:?}");
        let lost = response.status.overturns();
        if !lost {
            let expected = response.peak_theta[0] / alpha;
            assert!((row.number("peak_1") - expected).abs() <= 1e-6 * expected, "{row:?} {expected}");
            compared += usize::from(expected > 0.0);
        }
        let demand = if lost { f64::INFINITY } else { row.number("peak_1") };
        by_point.entry(format!("{alpha} {period}")).or_default().push(demand);
    }
    assert!(compared > 8, "{compared} runs rock and stand");

    let fractiles = folder.table("sweep-fractiles.csv");
    assert_eq!(fractiles.len(), 8);
    for row in fractiles.rows() {
        let (alpha, period) = (row.number("size.alpha"), row.number("size.rocking_period"));
        let demands = &by_point[&format!("{alpha} {period}")];
        let lost = demands.iter().filter(|demand| demand.is_infinite()).count();
        let counts = ["runs", "lost", "undecided", "truncated"].map(|name| row.number(name));
        assert_eq!(counts, [4.0, lost as f64, 0.0, 0.0]);
        for share in [16, 50, 84] {
            assert_eq!(row.number(&format!("peak_{share}")), fractile(demands, f64::from(share) / 100.0), "{row:?}");
        }
    }
    let found = words(&folder, "f.svg");
    for word in ["α = 0.15 rad", "α = 0.25 rad", "2π/p [s]", "Largest |θ|/α", "4 records", "16 %", "50 %", "84 %"]
    {
        assert!(found.iter().any(|own| own == word), "{word} is not in {found:?}");
    }

    // The same by the library, and of the table that is there.
    let sweep = Sweep::from_file(&folder.path("sweep.toml")).expect("valid");
    for row in sweep.rows(0..sweep.len()) {
        let demand = row.result.expect("runs").demand().expect("an answer");
        let own = table.row(row.index);
        assert!(if own.text("outcome") == "overturns" { demand.is_infinite() } else { demand == own.number("peak_1") });
    }
    folder.succeeds("plot sweep.csv");
    let [first, later] = ["f.svg", "sweep.svg"].map(|name| folder.bytes(name));
    assert!(first == later);
    // Shards have no fractiles, the table that is merged of them has.
    for shard in ["1/2", "2/2"] {
        folder.succeeds(&format!("sweep sweep.toml --shard {shard}"));
    }
    assert!(!folder.has("sweep-1-of-2-fractiles.csv"));
    folder.succeeds("merge m.csv sweep-1-of-2.csv sweep-2-of-2.csv --sweep sweep.toml");
    let [whole, merged] = ["sweep", "m"].map(|name| folder.bytes(&format!("{name}-fractiles.csv")));
    assert!(whole == merged);
    // Where the ground still moves at the end, those that stand are cut.
    let cut = folder.read("base.toml").replace("t_end = 14.0", "t_end = 4.0");
    folder.write("base.toml", cut);
    folder.succeeds("sweep sweep.toml --out cut.csv");
    let fractiles = folder.table("cut-fractiles.csv");
    let is_cut = |row: crate::common::Row| row.number("truncated") == 4.0 - row.number("lost");
    assert!(fractiles.rows().all(is_cut) && fractiles.numbers("truncated")[0] > 0.0, "{fractiles:?}");
}

/// Axes that change together, and a distribution beside an axis of records, have fractiles of the records at each combination of the others as well.
#[test]
fn paired_and_sampled_sweeps_of_records_have_fractiles() {
    let paired = "ask = \"peaks\"\ncombine = \"paired\"\n[axes]\nseed = [1, 2, 3, 1, 2, 3]\npgv = [0.4, 0.4, 0.4, 0.8, 0.8, 0.8]\n";
    let sampled =
        "ask = \"peaks\"\n[sampling]\nsamples = 5\n[axes]\nseed = [1, 2, 3]\neta = { uniform = [0.8, 0.9] }\n";
    let noise = NOISE.replace("pga_g = 0.35", "pgv = 0.4");
    for (sweep, scene, key, groups) in
        [(paired, noise.as_str(), "excitation.horizontal.pgv", 2), (sampled, NOISE, "restitution.eta", 5)]
    {
        let folder = folder(&format!("{COLUMN}{scene}[solver]\nt_end = 14.0\n"), sweep);
        let told = folder.succeeds("sweep sweep.toml");
        assert!(told.contains("wrote 16, 50 and 84 % fractiles"), "{told}");
        let (table, fractiles) = (folder.table("sweep.csv"), folder.table("sweep-fractiles.csv"));
        assert_eq!(fractiles.len(), groups, "{key}");
        for row in fractiles.rows() {
            let own = table.rows().filter(|one| one.number(key) == row.number(key));
            let lost = |one: &crate::common::Row| one.text("outcome") == "overturns";
            let demands: Vec<f64> =
                own.map(|one| if lost(&one) { f64::INFINITY } else { one.number("peak_1") }).collect();
            assert_eq!((demands.len(), row.number("runs")), (3, 3.0), "{key}");
            assert_eq!(row.number("peak_50"), fractile(&demands, 0.5), "{key}");
        }
    }
    // Where each record has values of its own there is nothing to take together.
    let apart = paired.replace("0.4, 0.4, 0.4, 0.8, 0.8, 0.8", "0.3, 0.4, 0.5, 0.6, 0.7, 0.8");
    let folder = folder(&format!("{COLUMN}{noise}[solver]\nt_end = 14.0\n"), &apart);
    folder.succeeds("sweep sweep.toml");
    assert!(!folder.has("sweep-fractiles.csv"));
}

/// A slender block under a constant acceleration of λ g tan α for the time t: θ/α = (λ - 1)(cosh pt - 1) and θ'/(αp) = (λ - 1) sinh pt at its end, then
/// θ'² - p²(θ - α)² stays: the peak is α (1 - √((1 - θ/α)² - (θ'/(αp))²)), and the block is lost where the root is none.
#[test]
fn validation_the_spectrum_of_a_rectangular_pulse_is_the_closed_form_of_the_slender_block() {
    let (lambda, duration, alpha) = (1.4, 0.3, 1e-3);
    let pulse = format!(
        "[excitation.horizontal]\nkind = \"rectangular\"\namplitude_uplift = {lambda}\nduration = {duration}\n"
    );
    let axes =
        format!("ask = \"peaks\"\n[axes]\nalpha = [{alpha}]\nrocking_period = {{ from = 0.5, to = 6, steps = 56 }}\n");
    let folder = folder(&format!("{COLUMN}{pulse}[solver]\nt_end = 10.0\n"), &axes);
    folder.succeeds("sweep sweep.toml --plot f.png");
    let (mut lost, mut rocking) = (0, 0);
    for row in folder.table("sweep.csv").rows() {
        let p = TAU / row.number("size.rocking_period");
        let (angle, rate) = ((lambda - 1.0) * ((p * duration).cosh() - 1.0), (lambda - 1.0) * (p * duration).sinh());
        let square = (1.0 - angle).powi(2) - rate.powi(2);
        if angle >= 1.0 || square < 0.0 {
            assert_eq!(row.text("outcome"), "overturns", "{row:?}");
            lost += 1;
        } else {
            let expected = 1.0 - square.sqrt();
            // The nonlinear block differs by terms of α².
            assert!((row.number("peak_1") / expected - 1.0).abs() < 1e-4, "{row:?} {expected}");
            rocking += 1;
        }
    }
    assert!(lost > 3 && rocking > 30, "{lost} {rocking}");
    assert!(folder.bytes("f.png").starts_with(b"\x89PNG"));
    // Below uplift nothing moves, whatever its size.
    let text = folder.read("base.toml");
    folder.write("base.toml", text.replace("amplitude_uplift = 1.4", "amplitude_uplift = 0.99"));
    folder.succeeds("sweep sweep.toml --plot f.svg");
    let still = folder.table("sweep.csv");
    assert!(
        still.len() == 56 && still.rows().all(|row| row.text("outcome") == "no-uplift" && row.number("peak_1") == 0.0)
    );
}

/// A figure over `p` has its period to the right.
#[test]
fn an_axis_over_p_is_drawn_as_its_period() {
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.5\nperiod = 0.8\n";
    let drawn = |axis: &str| {
        let axes = format!("ask = \"peaks\"\n[axes]\nalpha = [0.2, 0.3, 0.4]\n{axis}\n");
        let folder = folder(&format!("{COLUMN}{pulse}"), &axes);
        folder.succeeds("sweep sweep.toml --plot f.svg");
        assert!(!folder.has("sweep-fractiles.csv"), "no records");
        (words(&folder, "f.svg"), folder.read("f.svg"))
    };
    // The same points, from the other end.
    let periods: Vec<f64> = (2..=8).map(f64::from).collect();
    let list = |values: Vec<f64>| format!("{values:?}");
    let (by_p, first) = drawn(&format!("p = {}", list(periods.iter().map(|period| TAU / period).collect())));
    let (by_period, second) = drawn(&format!("rocking_period = {}", list(periods)));
    assert_eq!(by_p, by_period);
    assert!(by_p.contains(&"2π/p [s]".into()) && by_p.contains(&"α = 0.3 rad".into()), "{by_p:?}");
    // Curves are the same to a hundredth of a pixel, mostly.
    let numbers = |figure: &str| figure.matches('L').count();
    assert!(numbers(&first).abs_diff(numbers(&second)) < 5);
}

#[test]
fn one_axis_is_drawn_as_strips_or_as_a_curve_for_each_block() {
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 3\nomega_p = 5\n";
    let scene = format!("{COLUMN}{pulse}[solver]\nt_end = 12.0\nrtol = 1e-6\n");
    let amplitudes = "amplitude_uplift = { from = 0.5, to = 10, steps = 20 }\n";
    let one = folder(&scene, &format!("[axes]\n{amplitudes}"));
    let told = one.succeeds("sweep sweep.toml --plot f.svg");
    assert!(
        told.contains(
            "wrote f.svg: What becomes of the column over a / (g tan α). Share of the points that are lost: "
        ),
        "{told}"
    );
    assert!(!one.has("f-minimum.svg"));
    // The second figure of another table, if there is one, is not taken for one of this.
    one.write("t-minimum.svg", "of another table");
    one.write("t.csv", one.read("sweep.csv"));
    let (_, warned) = one.says("plot t.csv");
    assert_has(&warned, &["t-minimum.svg was there before, and is no figure of this table"]);
    let table = one.table("sweep.csv");
    let standing = table.rows().filter(|row| row.text("outcome") == "rocks").count();
    let share = format!("rocks and stands, {:.0} %", 5.0 * standing as f64);
    let found = words(&one, "f.svg");
    assert!(found.contains(&share) && found.contains(&"a / (g tan α)".into()), "{share} {found:?}");

    // A strip for each name.
    let kinds = folder(&scene, &format!("[axes]\nkind = [\"sine-pulse\", \"ricker\"]\n{amplitudes}"));
    kinds.succeeds("sweep sweep.toml --plot f.svg");
    let found = words(&kinds, "f.svg");
    assert!(["sine-pulse", "ricker"].iter().all(|word| found.contains(&(*word).into())), "{found:?}");

    let blocks = scene.replace("blocks = 1", "blocks = 3");
    let peaks = folder(&blocks, &format!("ask = \"peaks\"\n[axes]\n{amplitudes}"));
    let told = peaks.succeeds("sweep sweep.toml --plot f.svg");
    assert!(told.contains("Largest angle: the largest |θ|/α over a / (g tan α)"), "{told}");
    let found = words(&peaks, "f.svg");
    assert!(["block 1", "block 2", "block 3"].iter().all(|word| found.contains(&(*word).into())), "{found:?}");
    // Too many curves, and no plane.
    let kinds: Vec<String> = (0..13).map(|number| format!("\"t{number}\"")).collect();
    let many = folder(&scene, &format!("ask = \"peaks\"\n[axes]\ntitle = [{}]\n{amplitudes}", kinds.join(", ")));
    many.refused("sweep sweep.toml --plot f.svg", &["make 13 curves, and 12 can be read"]);
    let none = folder(&scene, "[axes]\nkind = [\"sine-pulse\", \"ricker\"]\n");
    none.refused("sweep sweep.toml --plot f.svg", &["no axis with numbers has several values"]);
}

/// Block 2 falls at 0.4, 0.5 and 0.7; block 1 hardly moves. Curves of blocks stop there, and marks say that the column is lost. A curve of the largest angle
/// of all blocks runs along the upper edge.
#[test]
fn columns_that_are_lost_are_marked_whichever_block_falls() {
    let axes =
        "index,excitation.horizontal.amplitude,outcome,impacts,block,overturned_at,peak_1,peak_2,truncated,error\n";
    let row = |index: usize, amplitude: &str, is_lost: bool| match is_lost {
        true => format!("{index},{amplitude},overturns,1,2,1.5,0.001,9.5,false,\n"),
        false => format!("{index},{amplitude},rocks,1,,,0.001,0.5,false,\n"),
    };
    let amplitudes = ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7"];
    let is_lost = |amplitude: &str| ["0.4", "0.5", "0.7"].contains(&amplitude);
    let rows = amplitudes.iter().enumerate().map(|(index, amplitude)| row(index, amplitude, is_lost(amplitude)));
    let folder = Folder::with("blocks.csv", &format!("{axes}{}", rows.collect::<String>()));
    let told = folder.succeeds("plot blocks.csv");
    assert!(told.contains("At the upper edge the column is lost: 3 of 7 runs are."), "{told}");
    let figure = folder.read("blocks.svg");
    assert!(words(&folder, "blocks.svg").contains(&"column lost".into()));
    // The marks are at the upper edge, and no curve of a block is: frame and grid alone end there.
    let document = Document::parse(&figure).expect("XML");
    let number = |node: &Node, name: &str| node.attribute(name).and_then(|text| text.parse::<f64>().ok());
    let dots: Vec<f64> = document.descendants().filter_map(|node| number(&node, "cy")).collect();
    // One run that stands between two that fall is a dot of each block.
    assert_eq!(dots.len(), 3 + 2, "{dots:?}");
    let top = dots.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(dots.iter().filter(|y| **y == top).count(), 3);
    let colors = ["#0072b2", "#d55e00"];
    let heights = |color: &str| -> Vec<f64> {
        let of_color = document.descendants().filter(|node| node.attribute("stroke") == Some(color));
        let paths = of_color.filter_map(|node| node.attribute("d"));
        paths.flat_map(parts).flatten().map(|[_, y]| y).collect()
    };
    for color in colors {
        assert!(!heights(color).is_empty() && heights(color).iter().all(|y| *y > top + 10.0), "{color}");
    }

    // Two columns: each has a curve.
    let second = |text: &str, blocks: &str| text.replacen(',', &format!(",{blocks},"), 1);
    let of = |blocks: &'static str, from: usize| {
        let rows = amplitudes.iter().enumerate();
        rows.map(move |(place, amplitude)| second(&row(from + place, amplitude, is_lost(amplitude)), blocks))
            .collect::<String>()
    };
    let table = format!("{}{}{}", second(axes, "column.blocks"), of("2", 0), of("3", 7));
    folder.write("two.csv", table);
    folder.succeeds("plot two.csv");
    let figure = folder.read("two.svg");
    let document = Document::parse(&figure).expect("XML");
    assert!(!words(&folder, "two.svg").contains(&"column lost".into()));
    assert!(!document.descendants().any(|node| node.has_tag_name("circle")));
    let solid = document.descendants().filter(|node| node.attribute("stroke") == Some(colors[0]));
    let runs: Vec<Vec<[f64; 2]>> = solid.filter_map(|node| node.attribute("d")).flat_map(parts).collect();
    let top = runs.iter().flatten().map(|[_, y]| *y).fold(f64::INFINITY, f64::min);
    let along = runs.iter().flat_map(|run| run.windows(2)).find(|pair| pair[0][1] == top && pair[1][1] == top);
    let [[from, _], [to, _]] = along.expect("a piece along the upper edge") else { panic!("two ends") };
    assert!((to - from).abs() > 50.0, "{from} {to}");
}

#[test]
fn paired_axes_are_drawn_along_the_first_that_has_numbers() {
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 3\nomega_p = 5\n";
    let scene = format!("{COLUMN}{pulse}[solver]\nt_end = 12.0\nrtol = 1e-6\n");
    let axes = "combine = \"paired\"\n[axes]\nkind = [\"sine-pulse\", \"ricker\", \"sine-pulse\", \"ricker\"]\nomega_p = [2, 3, 5, 8]\namplitude_uplift = [1.5, 1.5, 4, 9]\n";
    for (ask, x) in [("", "Ω / p"), ("ask = \"peaks\"\n", "Ω / p")] {
        let folder = folder(&scene, &format!("{ask}{axes}"));
        let told = folder.succeeds("sweep sweep.toml --plot f.svg");
        assert!(words(&folder, "f.svg").contains(&x.into()));
        assert!(told.contains("over Ω / p, with which these change: kind, a / (g tan α)."), "{told}");
        folder.succeeds("plot sweep.csv --out again");
        let [first, later] = ["f.svg", "again/sweep.svg"].map(|name| folder.bytes(name));
        assert!(first == later);
    }
    // Without numbers, by the points.
    let axes = "combine = \"paired\"\nask = \"peaks\"\n[axes]\ntitle = [\"a\", \"b\", \"c\"]\n";
    let folder = folder(&scene, axes);
    folder.refused("sweep sweep.toml --plot f.svg", &["no axis with numbers"]);
    // Where values come again, rows that make a grid are drawn as one, and others are refused.
    let paired = |axes: &str| format!("scene = \"base.toml\"\ncombine = \"paired\"\nask = \"peaks\"\n[axes]\n{axes}");
    folder.write("grid.toml", paired("omega_p = [2, 2, 5, 5]\namplitude_uplift = [1.5, 4, 4, 1.5]\n"));
    folder.succeeds("sweep grid.toml --out grid.csv --plot grid.svg");
    folder.write("none.toml", paired("omega_p = [2, 2, 5]\namplitude_uplift = [1.5, 4, 4]\n"));
    folder.refused("sweep none.toml --plot f.svg", &["need one among them with another value in each row"]);
}

/// What stands in the table is what one would write.
#[test]
fn values_of_ranges_are_decimal_numbers_in_the_table() {
    let pulse = "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 0.5\nomega_p = 5\n";
    let axes = "[axes]\n\"solver.rtol\" = { from = 1e-9, to = 1e-5, steps = 5, scale = \"log\" }\namplitude_uplift = { from = 0.1, to = 0.9, steps = 9 }\n";
    let folder = folder(&format!("{COLUMN}{pulse}[solver]\nt_end = 5.0\n"), axes);
    folder.succeeds("sweep sweep.toml");
    let table = folder.table("sweep.csv");
    let of = |name: &str, index: usize| table.row(index).text(name);
    let amplitudes: Vec<&str> = (0..9).map(|index| of("excitation.horizontal.amplitude_uplift", index)).collect();
    assert_eq!(amplitudes, ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9"]);
    let tolerances: Vec<f64> = (0..5).map(|index| of("solver.rtol", 9 * index).parse().expect("a number")).collect();
    assert_eq!(tolerances, [1e-9, 1e-8, 1e-7, 1e-6, 1e-5]);
}

#[test]
fn residual_slides_have_a_figure_of_their_own() {
    let scene = "friction = 0.3\n[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.2\n\
        [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.4\nfrequency = 1.5\n[solver]\nt_end = 4.0\n";
    let axis = "[axes]\namplitude_g = { from = 0.2, to = 0.6, steps = 5 }\n";
    let folder = folder(scene, &format!("ask = \"slides\"\n{axis}"));
    let told = folder.succeeds("sweep sweep.toml --plot f.svg");
    assert!(told.contains("wrote f.svg: Largest angle: the largest |θ|/α over"), "{told}");
    assert!(
        told.contains("wrote f-slides.svg: Residual slide: the size of the slide at the end of a run over"),
        "{told}"
    );
    let (angles, slides) = (words(&folder, "f.svg"), words(&folder, "f-slides.svg"));
    assert!(angles.contains(&"block 2".into()) && angles.contains(&"Largest |θ|/α".into()), "{angles:?}");
    assert!(slides.contains(&"interface 2".into()) && slides.contains(&"Residual slide [m]".into()), "{slides:?}");
    // The axis reaches just beyond the largest slide of the table, whatever its sign.
    let table = folder.table("sweep.csv");
    let sizes = table.rows().flat_map(|row| [1, 2].map(|i| row.number(&format!("residual_slide_{i}")).abs()));
    let largest = sizes.fold(0.0, f64::max);
    let ticks: Vec<f64> = slides.iter().filter_map(|word| word.parse().ok()).filter(|tick: &f64| *tick < 0.2).collect();
    let top = ticks.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1e-3 && top > 0.6 * largest && top < 1.06 * largest, "{largest} {ticks:?}");
    // The table alone gives the same; without slides there is one figure.
    let later = folder.succeeds("plot sweep.csv");
    assert!(later.contains("sweep-slides.svg"), "{later}");
    folder.write("peaks.toml", format!("scene = \"base.toml\"\nask = \"peaks\"\n{axis}"));
    folder.succeeds("sweep peaks.toml --plot p.svg");
    assert!(folder.has("p.svg") && !folder.has("p-slides.svg"));
}

/// A point that is there twice in the place of another, and a largest angle that is no number, make no figure.
#[test]
fn damaged_tables_are_not_drawn() {
    let axes =
        "ask = \"peaks\"\n[axes]\nseed = { from = 1, to = 4 }\nrocking_period = { from = 1, to = 4, steps = 3 }\n";
    let folder = folder(&format!("{COLUMN}{NOISE}[solver]\nt_end = 14.0\n"), axes);
    folder.succeeds("sweep sweep.toml");
    folder.succeeds("plot sweep.csv");
    let whole = folder.read("sweep.csv");
    let with = |place: usize, cell: &str| {
        let row = |line: &str| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if cells[0] == "7" {
                cells[place] = cell;
            }
            cells.join(",") + "\n"
        };
        whole.lines().map(row).collect::<String>()
    };
    let peak = whole.lines().next().and_then(|header| header.split(',').position(|name| name == "peak_1"));
    // Numbers of rows that pandas has written, once and again, are no axes.
    let figure = folder.read("sweep.svg");
    for name in ["", "Unnamed: 0"] {
        let numbered = |(row, line): (usize, &str)| match row {
            0 => format!("{name},{line}\n"),
            _ => format!("{row},{line}\n"),
        };
        folder.write("sweep.csv", whole.lines().enumerate().map(numbered).collect::<String>());
        folder.succeeds("plot sweep.csv");
        assert_eq!(folder.read("sweep.svg"), figure, "{name}");
    }
    for (damaged, told) in [
        (with(1, "1"), "points are missing"),
        (with(peak.expect("a column"), "x"), "row 8, column `peak_1`: `x` is no number"),
    ] {
        folder.write("sweep.csv", damaged);
        folder.refused("plot sweep.csv", &[told]);
    }
}
