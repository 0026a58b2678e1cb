//! Runs in which blocks slide and fly, as a user sees them.

use crate::common::{Folder, assert_has};
use roxmltree::Document;
use serde_json::Value;

/// Two wide blocks: they slide and do not rock.
const SLIDES: &str = "title = \"Two slabs\"
friction = { static = [0.3, 0.2], kinetic = [0.3, 0.2] }
[[block]]
half_width = 1.0
half_height = 0.4
[[block]]
half_width = 1.0
half_height = 0.4
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude_g = 0.5
omega = 6.0
[solver]
t_end = 3.0
";

/// Three blocks that vertical motion throws up.
const THROWN: &str = "friction = 0.6
[column]
blocks = 3
half_width = 0.4
half_height = 1.2
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude_g = 0.8
frequency = 1.5
[excitation.vertical]
kind = \"harmonic\"
amplitude_g = 1.6
frequency = 3.0
duration = 2.0
";

/// Runs a scene in `folder` into `out`. Returns what is printed.
fn run(folder: &Folder, scene: &str) -> String {
    folder.write("scene.toml", scene);
    folder.succeeds("run scene.toml --out out --report --plots")
}

#[test]
fn a_run_says_where_each_block_stayed() {
    let folder = Folder::new();
    let account = run(&folder, SLIDES);
    let sliding = folder.summary()["sliding"].clone();
    let residual: Vec<f64> =
        sliding["residual_slide"].as_array().expect("a list").iter().flat_map(Value::as_f64).collect();
    assert!(residual.iter().all(|slide| slide.abs() > 1e-5), "{residual:?}");
    assert!(account.contains(&format!(", {:.3} cm; 0 flight(s)", 100.0 * residual[1])), "{account}");
    let page = folder.page();
    let stayed = page.lines().find(|line| line.contains("Where the blocks stayed")).expect("the sentence");
    for (block, slide) in residual.iter().enumerate() {
        let side = if *slide > 0.0 { "right" } else { "left" };
        let place = stayed.find(&format!("block {}: ", block + 1)).expect("it has slid");
        assert!(stayed[place..].split(" on ").next().is_some_and(|part| part.contains(side)), "{stayed}");
    }
    assert!(stayed.contains(&format!("block 2: {:.2}&nbsp;cm", 100.0 * residual[1].abs())), "{stayed}");
    assert!(!page.contains("flight at") && !page.contains("flights at"), "nothing flew");
}

/// Drums with names, displaced at the start; and a column that is lost, which stays nowhere.
#[test]
fn a_page_tells_slides_at_the_start_and_none_of_a_column_that_is_lost() {
    let folder = Folder::new();
    let drums = SLIDES
        .replace("half_width = 1.0\nhalf_height = 0.4", "name = \"slab\"\ndiameter = 2.0\nheight = 0.8\ndensity = 2700")
        .replace("[solver]", "[initial]\nslide = [0.0, -0.1]\n[solver]");
    run(&folder, &drums);
    let told = folder.page();
    let stayed = told.lines().find(|line| line.contains("Where the drums stayed")).expect("the sentence");
    assert!(stayed.contains("<li>block 1 (slab): ") && !stayed.contains("block 1: "), "{stayed}");
    assert!(stayed.contains(" on block 1 (10&nbsp;cm to the left at the start)</li>"), "{stayed}");
    assert_eq!(stayed.matches("at the start").count(), 1, "{stayed}");
    let far = SLIDES.replace("amplitude_g = 0.5", "amplitude_g = 1.0").replace("omega = 6.0", "omega = 0.8");
    run(&folder, &far.replace("t_end = 3.0", "t_end = 12.0").replace("half_width = 1.0", "half_width = 0.9"));
    let told = folder.page();
    assert!(told.contains("<strong>collapses</strong>") && told.contains("<p>Slid"));
    assert!(!told.contains("Where the blocks"), "where it was when it was lost");
    let (_, length) = told.split_once("<dt>Longest run</dt><dd>12 s; this one ends at t = ").expect("its length");
    assert!(length.split(' ').next().is_some_and(|t| t.parse::<f64>().is_ok_and(|t| t < 12.0)));
}

/// A block that turns in the air and a column that still rocks where the run ends: no work was done, and nothing stayed.
#[test]
fn a_run_that_ends_in_flight_or_rocking_is_told_so() {
    let folder = Folder::new();
    let thrown = "friction = 0.5\n[[block]]\nhalf_width = 0.5\nhalf_height = 0.5\ndensity = 2700.0\n[initial]\nx = [0.0]\ny = [3.0]\n\
        vx = [0.1]\nvy = [1.0]\nomega = [0.3]\n[solver]\nt_end = 0.5\n";
    run(&folder, thrown);
    let told = folder.page();
    assert!(!told.contains("balance is open") && !told.contains("Relative error"), "rounding over rounding");
    assert!(told.contains("Where the blocks are at the end of the run, still sliding or flying"), "{told}");
    run(&folder, &SLIDES.replace("half_width = 1.0", "half_width = 0.1").replace("t_end = 3.0", "t_end = 0.8"));
    let told = folder.page();
    assert!(
        told.contains("Where the blocks that slid or flew are at the end of the run:") && !told.contains("stayed"),
        "{told}"
    );
}

/// The ground that moves vertically alone has its own peak; and figures of another run do not pass for those of this one.
#[test]
fn vertical_shaking_has_its_peak_and_old_figures_a_warning() {
    let folder = Folder::new();
    let vertical =
        THROWN.replace("[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.8\nfrequency = 1.5\n", "");
    run(&folder, &vertical);
    let told = folder.page();
    assert!(told.contains("<span class=\"value\">1.6 g</span> <span class=\"note\">vertical</span>"), "{told}");
    folder.write("still.toml", "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.1]\n");
    folder.succeeds("run still.toml --out still");
    folder.write("figures/slides.svg", "<svg/>");
    let warned = folder.says("plot still --out figures").1;
    assert!(warned.contains("slides.svg was there before, and is no figure of this run"), "{warned}");
}

/// While a block flies there is no contact: no force, no friction demand, and no slide.
#[test]
fn free_interfaces_have_neither_force_nor_demand_nor_slide() {
    let folder = Folder::new();
    run(&folder, THROWN);
    let response = folder.table("out/response.csv");
    let mut free = 0;
    for (row, interface) in response.rows().flat_map(|row| (1..=3).map(move |interface| (row, interface))) {
        if row.number(&format!("gap_{interface}")) > 0.0 {
            free += 1;
            let forces = ["normal", "tangential"].map(|name| row.number(&format!("{name}_{interface}")));
            assert_eq!(forces, [0.0; 2], "t = {}, interface {interface}", row.text("t"));
        }
    }
    assert!(free > 100, "{free}");
    let read = |name: &str| folder.read(&format!("out/{name}"));
    let (forces, slides) = (read("forces.svg"), read("slides.svg"));
    assert!(forces.contains(" Gaps: nothing presses there") && !forces.contains("Larger demands"), "in the caption");
    assert!(forces.contains("interface 2: 0.6<") && slides.contains("interrupted while these are apart"));
    // In the tables, forces of contacts that part are zero and not rounding.
    let page = folder.page();
    assert!(page.contains("<td>0 (0 % of the weight)</td>") && page.contains("no rocking"));
    // Blocks that only slide have no gaps, and those with different coefficients have all of them.
    run(&folder, SLIDES);
    let forces = read("forces.svg");
    assert!(!forces.contains("Gaps: nothing presses"), "in the caption");
    assert!(forces.contains(">friction coefficients 0.3, 0.2, base first<"));
    let lines = forces.lines().filter(|line| line.contains("stroke=\"#222222\" stroke-width=\"1.8\""));
    assert_eq!(lines.count(), 3, "a line for each coefficient, and the key");
}

/// On narrow paper the right edge of the frame is closer to the end of a run than a letter is high.
#[test]
fn the_name_of_an_ending_does_not_lie_on_the_frame() {
    let folder = Folder::new();
    run(&folder, THROWN);
    for (width, pixels) in [("80", 384.0), ("100", 480.0)] {
        folder.succeeds(&format!("plot out --width {width} --out narrow"));
        let figure = folder.read("narrow/slides.svg");
        let document = Document::parse(&figure).expect("XML");
        let mut texts = document.descendants().filter(|node| node.has_tag_name("text"));
        let ending =
            texts.find(|text| text.text().is_some_and(|text| text.starts_with("overturned"))).expect("its name");
        let base: f64 = ending.attribute("x").and_then(|x| x.parse().ok()).expect("a number");
        // The right margin has 18 px; letters of 13 px rise by about 10.
        let frame = pixels - 18.0;
        let (is_inside, is_in_the_margin) = (base + 4.0 < frame, base - 10.0 > frame && base + 4.0 <= pixels);
        assert!(is_inside || is_in_the_margin, "{base}, {frame}");
    }
}

/// A block that is never closed has neither the largest demand nor the smallest force.
#[test]
fn a_contact_that_never_closed_has_no_extremes() {
    let folder = Folder::new();
    let thrown = "friction = 0.6\n[column]\nblocks = 2\nhalf_width = 0.3\nhalf_height = 0.5\n[initial]\nx = [0.0, 0.1]\n\
        y = [0.35, 1.4]\nvx = [0.3, 0.5]\nvy = [0.0, 3.0]\ntheta = [0.1, -0.05]\n[solver]\nt_end = 0.3\n";
    run(&folder, thrown);
    let page = folder.page();
    assert!(page.contains("<th scope=\"row\">2</th><td>–</td><td>–</td><td>–</td>") && !page.contains("not finite"));
    assert!(page.contains("<li>block 2: in flight above block 1</li>"), "at the end of the run");
    let figure = folder.read("out/forces.svg");
    assert!(figure.contains(">interface 2: never closed<"));
}

#[test]
fn friction_that_holds_is_said_to_hold() {
    let folder = Folder::new();
    let account = run(&folder, &SLIDES.replace("[0.3, 0.2]", "[0.9, 0.8]"));
    assert!(account.contains("friction holds: no block slides or flies"), "{account}");
    assert!(folder.page().contains("Friction holds: no block slides or flies."));
}

/// Blocks placed one by one whose friction is never used up: the companions that say how far the verdict can be trusted have friction, too.
#[test]
fn a_block_that_is_dropped_lands_and_rests() {
    let folder = Folder::new();
    let dropped = "friction = 0.9\n[[block]]\nhalf_width = 1.0\nhalf_height = 0.3\n\
                   [initial]\nx = [0.0]\ny = [1.2]\nvx = [0.0]\nvy = [0.0]\n";
    let account = run(&folder, dropped);
    // From 0.9 m: √(2 · 0.9 / 9.81) s.
    assert!(account.contains("at rest from t = 0.4284 s on"), "{account}");
    assert_has(&account, &["companions agree to the end", "1 flight(s)"]);
    // At rest from the start on.
    let account = run(&folder, &dropped.replace("y = [1.2]", "y = [0.3]"));
    assert!(account.contains("friction holds"), "{account}");
}

#[test]
fn a_drum_pushed_off_its_support_has_collapsed() {
    let folder = Folder::new();
    let far = SLIDES.replace("amplitude_g = 0.5", "amplitude_g = 1.0").replace("omega = 6.0", "omega = 0.8");
    let account =
        run(&folder, &far.replace("t_end = 3.0", "t_end = 12.0").replace("half_width = 1.0", "half_width = 0.9"));
    assert_eq!(folder.summary()["status"], "collapsed", "{account}");
    assert_eq!(folder.summary()["collapsed_block"], 2);
    assert_has(&account, &["collapses at t = ", "(block 2 lost its support)"]);
    let page = folder.page();
    assert!(page.contains("<strong>collapses</strong>") && page.contains("block 2 loses its support"));
    let figure = folder.read("out/time-history.svg");
    assert!(figure.contains("collapsed"), "the end of the run is marked");
}

#[test]
fn the_page_tells_what_slid_and_whether_the_energy_balance_closes() {
    let folder = Folder::new();
    run(&folder, SLIDES);
    let page = folder.page();
    assert!(!page.contains("which the model excludes") && !page.contains("the blocks would slide"), "it is modelled");
    assert!(page.contains(
        "<strong>The model holds for this run</strong>: sliding and flight are part of it; interfaces 1 and 2 slid"
    ));
    assert!(
        page.contains("Slides per interface") && page.contains("the scene has 0.3, 0.2, base first"),
        "with coefficients"
    );
    let sliding = folder.summary()["sliding"].clone();
    let [ground, friction, losses, change] = ["ground_work", "friction_work", "impact_losses", "energy_change"]
        .map(|key| sliding[key].as_f64().expect("a number"));
    // Steps at the default tolerance of 1e-9 and Gauss's rule of order ten.
    assert!((ground + friction - losses - change).abs() < 1e-9 * ground, "{sliding}");
    assert!(page.contains("Energy balance: work of the ground") && page.contains("Relative error: "));
    assert!(page.contains("<p>Ambiguous: none.</p>") && page.contains("<p>Jammed: none.</p>"));
}

#[test]
fn slides_are_drawn_where_something_slides() {
    let folder = Folder::new();
    run(&folder, SLIDES);
    let figure = folder.read("out/slides.svg");
    Document::parse(&figure).expect("XML");
    assert!(figure.contains("Slide [cm]") && figure.contains("interface 2"), "{}", &figure[..500]);
    assert!(folder.page().contains("<figure id=\"figure-slides\">"));
    // The next run of the same folder does not slide: an old figure would lie.
    run(&folder, &SLIDES.replace("[0.3, 0.2]", "[0.9, 0.8]"));
    assert!(!folder.has("out/slides.svg") && folder.has("out/forces.svg"));
    assert!(!folder.page().contains("figure-slides"));
}

/// A block at 0.5 m/s slides v²/(2 μ g) = 4.247 cm: to one side, also where `x` places it 4 cm to the left at the start. One under a pulse of two
/// rectangles slides to and fro, and its ground ends at rest, also where the pulse is the only term of a sum.
#[test]
fn the_report_says_which_blocks_slid_to_and_fro() {
    let block = "friction = 0.3\n[[block]]\nhalf_width = 0.8\nhalf_height = 0.5\n";
    let placed = "[initial]\nx = [-0.04]\ny = [0.5]\nvx = [0.5]\nvy = [0.0]\n";
    let pulse = "kind = \"double-rectangular\"\namplitude_g = 0.9\nduration = 0.5\n[output]\ndt = 0.02\n";
    let own = format!("{block}[excitation.horizontal]\n{pulse}");
    // Dropped from 10 cm into the pulse.
    let drop = "[initial]\nx = [0.0]\ny = [0.6]\nvx = [0.1]\nvy = [0.0]\n";
    let dropped = format!("{block}{drop}[excitation.horizontal]\n{pulse}");
    let sum = format!("{block}[excitation.horizontal]\nkind = \"sum\"\n[[excitation.horizontal.term]]\n{pulse}");
    let later = "[output]\ntimes = [0.12, 0.2, 1.0]\n";
    for (scene, told) in [
        (format!("{block}{placed}"), "Slid: interface 1 by 4.25&nbsp;cm."),
        // Without a row at the start.
        (format!("{block}{placed}{later}"), "Slid: interface 1 by 4.25&nbsp;cm."),
        (own, "cm to and fro."),
        (sum, "cm to and fro."),
        (dropped, "cm in all. 1 flight at interface 1"),
    ] {
        let folder = Folder::with("scene.toml", &scene);
        folder.succeeds("run scene.toml --out out --report --no-trust");
        assert_has(&folder.page(), &[told]);
        assert!(!folder.page().contains("is taken out"), "{scene}");
    }
}

/// A block that lies where it lands has neither rocked nor slid, although its flight of no height counts.
#[test]
fn a_block_that_lands_where_it_begins_does_not_slide() {
    let scene = "friction = 0.9\n[[block]]\nhalf_width = 0.5\nhalf_height = 1.0\n\
                 [initial]\nx = [0.0]\ny = [1.0]\nvx = [0.1]\nvy = [-2.0]\n";
    let folder = Folder::with("scene.toml", scene);
    assert_has(&folder.succeeds("run scene.toml --no-trust"), &["no uplift and stands", "1 flight(s)"]);
}

/// Pushed by 0.5 g for 0.1 s, both blocks as one speed up by 0.2 g, then slow down by 0.3 g: they slide g T²/6 = 1.635 cm.
#[test]
fn slides_begin_where_the_blocks_stand_at_the_start() {
    let scene = SLIDES
        .replace("[0.3, 0.2]", "[0.3, 0.9]")
        .replace("kind = \"sine-pulse\"", "kind = \"rectangular\"")
        .replace("omega = 6.0", "duration = 0.1")
        .replace("[solver]", "[initial]\nslide = [0.02, 0.1]\n[solver]");
    let folder = Folder::with("scene.toml", &scene);
    folder.succeeds("run scene.toml --out out --report --no-trust");
    let page = folder.page();
    // One way, from 2 cm back towards the middle.
    assert!(page.contains("<p>Slid: interface 1 by 1.64&nbsp;cm.</p>"), "not to and fro");
    // At the end, largest, way.
    assert_has(&page, &[">1</th><td>0.365</td><td>2</td><td>1.635</td>", ">2</th><td>10</td><td>10</td><td>0</td>"]);
}
