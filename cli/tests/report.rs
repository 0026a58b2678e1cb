//! The report of a run: complete, self-contained, harmless, the same every time; in Chromium, where there is one, it plays and
//! shows the angles of `response.csv` (`in_chromium`).

#[cfg(unix)]
mod browser;
#[cfg(unix)]
mod in_chromium;

use crate::common::{Folder, assert_has, parsed, project};
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Scenes by name: a pulse on three blocks, overturning, five drums let go, nothing at all, a record, shaking both ways.
const SCENES: [&str; 6] = ["pulse", "overturning", "free", "quiet", "record", "vertical"];

/// A run with its report, in a folder of its name.
struct Run<'a> {
    folder: &'a Folder,
    name: String,
}

impl Run<'_> {
    fn path(&self, file: &str) -> PathBuf {
        self.folder.path(&format!("{}/{file}", self.name))
    }

    fn read(&self, file: &str) -> String {
        self.folder.read(&format!("{}/{file}", self.name))
    }

    fn json(&self, file: &str) -> Value {
        parsed(&self.read(file))
    }

    fn page(&self) -> String {
        self.read("report.html")
    }
}

/// What the player of a page reads.
fn data(page: &str) -> Value {
    let (_, data) = page.split_once("id=\"run\">").expect("the data");
    parsed(data.split("</script>").next().expect("closed"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|one| one.as_f64().expect("a number")).collect()
}

/// Runs one of [`SCENES`] with `--report`.
fn run<'a>(folder: &'a Folder, name: &str) -> Run<'a> {
    let scene = match name {
        "pulse" => "paper-3-blocks-3.00",
        "overturning" => "paper-1-block-6.33",
        "free" => "five-drums-free",
        "record" => "two-drums-record",
        "vertical" => "harmonic-with-vertical",
        _ => {
            let still = "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[solver]\nt_end = 1.0\n";
            return run_text(folder, name, still);
        }
    };
    run_file(folder, name, &project(&format!("scenes/{scene}.toml")))
}

fn run_text<'a>(folder: &'a Folder, name: &str, text: &str) -> Run<'a> {
    let scene = format!("{name}.toml");
    folder.write(&scene, text);
    run_file(folder, name, &folder.path(&scene).to_string_lossy())
}

fn run_file<'a>(folder: &'a Folder, name: &str, scene: &str) -> Run<'a> {
    let said = folder.succeeds(&["run", scene, "--out", name, "--report"]);
    assert!(said.contains("report.html"), "{said}");
    Run { folder, name: name.into() }
}

#[test]
fn a_report_has_every_section_and_needs_no_other_file() {
    let folder = Folder::new();
    for name in SCENES {
        let page = run(&folder, name).page();
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
    let folder = Folder::new();
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
        let page = run(&folder, name).page();
        assert!(page.contains(sentence), "{name}: {}", &page[page.find("class=\"outcome").unwrap_or(0)..][..400]);
    }
}

/// Key figures are of the run: the largest of the peaks, each over its own slenderness, and the events that occurred.
#[test]
fn tiles_agree_with_the_tables_below_them() {
    let folder = Folder::new();
    let told = run(&folder, "pulse").page();
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
    let told = run(&folder, "quiet").page();
    assert!(told.contains("<span class=\"note\">no other events</span>") && told.contains("0 modes entered"));
    // A scene without a title.
    assert!(told.contains("<h1>quiet.toml</h1>") && told.contains("<title>quiet.toml</title>"));
    assert!(!told.contains("jump at an impact"), "in the legend of the phase portrait");
}

/// A column with a coefficient that is enough, none, and one that is not.
#[test]
fn the_verdict_follows_the_friction_that_the_scene_has() {
    let folder = Folder::new();
    let scene = "[column]\nblocks = 3\nhalf_width = 0.3974745895307783\nhalf_height = 1.5566366369849045\n[restitution]\neta = 0.9\n\
        [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.75\nomega = 10.7\n";
    let verdicts = [
        ("rough", "friction = 2.0\n", "The model holds for this run"),
        ("unknown", "", "The model holds if the joints are rough enough"),
        ("smooth", "friction = 0.6\n", "The model holds for this run</strong>: sliding and flight are part of it"),
    ];
    for (name, friction, verdict) in verdicts {
        let page = run_text(&folder, name, &format!("{friction}{scene}")).page();
        assert_eq!(page.matches(verdict).count(), 2, "{name}: at the top and in the section");
    }
}

#[test]
fn the_same_folder_gives_the_same_page_wherever_it_lies() {
    let folder = Folder::new();
    let first = run(&folder, "record");
    let once = first.page();
    std::fs::rename(first.path(""), folder.path("moved")).expect("renamed");
    folder.succeeds("report moved");
    folder.succeeds("report moved --out elsewhere.html");
    assert!(once == folder.read("moved/report.html") && once == folder.read("elsewhere.html"));
}

/// Title, scene text and file name that would end elements, attributes and scripts.
const HOSTILE: &str = "</script><script>document.title='taken'</script><img src=x onerror=alert(1)>'\"&{{css}}";

fn hostile(folder: &Folder) -> Run<'_> {
    let title = HOSTILE.replace('"', "\\\"");
    let text = format!(
        "title = \"{title}\" # {HOSTILE}\n[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n\
         [initial]\ntheta = [0.1]\n[solver]\nt_end = 1.0\n"
    );
    run_text(folder, "a'b <i>&", &text)
}

#[test]
fn what_a_scene_says_is_text_and_nothing_else() {
    let folder = Folder::new();
    let page = hostile(&folder).page();
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
    let folder = Folder::new();
    let scene = "[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.04, 0.06]\n[solver]\nt_end = 3.0\n\
        [output]\ndt = 0.0001\n";
    let page = run_text(&folder, "long", scene).page();
    assert!(page.contains("one row in 2 of response.csv") && page.len() < 3_000_000, "{} bytes", page.len());
    let data = data(&page);
    let times = numbers(&data["t"]);
    assert!(times.is_sorted() && times[0] == 0.0 && times.last() == Some(&3.0));
    let events = data["events"].as_array().expect("a list");
    assert_eq!(times.len(), 15_001 + 2 * events.len());
    for event in events {
        let time = event["t"].as_f64().expect("a time");
        assert_eq!(times.iter().filter(|one| **one == time).count(), 2, "{time}");
    }
}

/// Blocks of a pile that hang over fall from the start: a stack that does not stand has no balance of which its angle would be a share.
#[test]
fn stacks_that_do_not_stand_have_no_share_of_their_balance() {
    let block = "[[block]]\nhalf_width = 0.4\nhalf_height = 0.5\n";
    let scene = |slide: &str| format!("{block}{block}{block}[initial]\nslide = [{slide}]\n[solver]\nt_end = 3.0\n");
    for (slide, told) in
        [("0.0, 0.0, 0.5", "in stacks that stand by themselves"), ("0.0, 0.5, 0.5", "no stack stands by itself")]
    {
        let page = run_text(&Folder::new(), "leaning", &scene(slide)).page();
        assert_has(&page, &[told]);
    }
    let page = run_text(&Folder::new(), "standing", &scene("0.0, 0.1, 0.0")).page();
    assert!(!page.contains("by themselves") && !page.contains("no stack stands"));
}

/// Twenty drums that come to rest in a chatter, and 10,001 rows of them: events of a millisecond have two frames in common, and no row is inside; every third
/// row is kept.
#[test]
fn very_many_events_share_their_frames() {
    let scene = "[column]\nblocks = 20\nhalf_width = 0.7\nhalf_height = 4.5\n[excitation.horizontal]\nkind = \"sine-pulse\"\n\
        amplitude_uplift = 1.6\nomega_p = 4.0\n[solver]\nt_end = 20.0\n[output]\ndt = 0.002\n";
    let page = run_text(&Folder::new(), "chatter", scene).page();
    assert_has(&page, &["one row in 3 of response.csv", "those within a millisecond are drawn as one"]);
    let data = data(&page);
    let (times, events) = (numbers(&data["t"]), data["events"].as_array().expect("a list"));
    let own: Vec<f64> = events.iter().map(|event| event["t"].as_f64().expect("a time")).collect();
    assert!(own.len() > 2000 && times.is_sorted(), "{} events", own.len());
    let mut instants: Vec<[f64; 2]> = Vec::new();
    for t in own {
        match instants.last_mut() {
            Some([first, last]) if t - *first < 1e-3 => *last = t,
            _ => instants.push([t, t]),
        }
    }
    let frames = times.len();
    assert!(
        (3334 + instants.len()..=3334 + 2 * instants.len()).contains(&frames),
        "{frames}, {} instants",
        instants.len()
    );
    assert!(instants.len() < 1000 && instants.iter().flatten().all(|end| times.contains(end)));
    for [first, last] in instants {
        assert!(!times.iter().any(|t| first < *t && *t < last), "a frame between {first} and {last}");
    }
}

/// The ground at an event is on the line between the rows around it. A block with b/h = 0.3 opens where sin 2πt = 0.6, after the row at 0.1 s.
#[test]
fn frames_of_an_event_have_the_ground_between_the_rows() {
    let scene = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"harmonic\"\namplitude_g = 0.5\n\
        frequency = 1.0\n[solver]\nt_end = 2.0\n[output]\ndt = 0.1\n";
    let data = data(&run_text(&Folder::new(), "coarse", scene).page());
    let times = numbers(&data["t"]);
    let opening = 0.6f64.asin() / TAU;
    assert_eq!([times[1], times[2], times[4]], [0.1, times[3], 0.2]);
    assert!((times[2] - opening).abs() < 1e-9, "{times:?}");
    let share = (opening - 0.1) / 0.1;
    for key in ["ax", "dx"] {
        let own = numbers(&data[key]);
        let between = own[1] + share * (own[4] - own[1]);
        // Five digits behind the point, of three numbers.
        assert!((own[2] - between).abs() < 1e-5 && own[3] == own[2], "{key}: {between} {own:?}");
    }
}

/// Rows at given times, unevenly apart or a single one, of blocks that stick, slide and fall: figures and page are of what is there.
#[test]
fn a_run_with_rows_at_given_times_has_its_figures_and_its_page() {
    let folder = Folder::new();
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
            let run = run_text(&folder, &format!("run-{place}-{number}"), &scene(friction, amplitude, times));
            assert!(run.page().contains(told), "{told}");
            folder.succeeds(&format!("plot {}", run.name));
        }
    }
    folder.write("late.toml", scene("", 0.5, "[7.9]") + "[initial]\ntheta = [1.0, 1.0]\n");
    folder.succeeds("run late.toml --out late");
    folder.refused("report late", &["there are no rows", "output.times"]);
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let folder = Folder::new();
    folder.refused("report .", &["summary.json", "rocking run"]);
    // What is missing is the run, not a folder for the page.
    for words in ["report nowhere", "report nowhere --out r.html"] {
        folder.refused(words, &["nowhere/summary.json", "give the folder of a finished `rocking run`"]);
    }
    assert!(!folder.has("report.html"));
}

/// Events name the interfaces that close; with friction, others stay open at angles that are rounding.
#[test]
fn impacts_with_friction_are_counted_at_the_interfaces_that_events_name() {
    let folder = Folder::new();
    let scene = "friction = 0.5\n[column]\nblocks = 5\ndiameter = 0.9\ntop_diameter = 0.7\nheight = 5.0\ndensity = 2500\n\
        [initial]\nslide = [0.0, 0.03, -0.02, 0.01, 0.0]\n[excitation.horizontal]\nkind = \"synthetic\"\npga_g = 0.8\nduration = 5\n[solver]\nt_end = 6\n";
    let run = run_text(&folder, "drums", scene);
    let page = run.page();
    let events = run.json("events.json");
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
    let folder = Folder::new();
    let block = "[[block]]\nwidth = 0.6\nheight = 1.0\nmass = 1000\n";
    let scene = format!(
        "friction = 0.5\n{block}{block}[initial]\nx = [0.0, 0.9]\ny = [0.5, 1.6]\nvx = [0.0, 0.1]\nvy = [0.0, 0.0]\n[solver]\nt_end = 1e-9\n"
    );
    let run = run_text(&folder, "start", &scene);
    assert!(run.page().contains("x = 0, 0.9 m; y = 0.5, 1.6 m; vx = 0, 0.1 m/s"));
    let scene = scene.replace("1.6]", "1.5]").replace("t_end = 1e-9", "t_end = 1");
    let run = run_text(&folder, "lost", &scene);
    folder.succeeds("plot lost");
    let figure = run.read("time-history.svg");
    assert!(!run.page().contains("NaN") && !figure.contains("NaN"));
}

#[test]
fn the_report_shows_round_blocks_as_round_and_names_them() {
    let folder = Folder::with(
        "s.toml",
        "[[block]]\ndiameter = 0.8\nheight = 1.0\n[[block]]\nwidth = 0.7\nheight = 1.0\ndepth = 0.7\nname = \"capital\"\n[initial]\ntheta = [0.1, 0.1]\n",
    );
    folder.succeeds("run s.toml --report");
    let page = folder.page();
    assert!(page.contains("\"round\":[true,false]") && page.contains("2 (capital)"));
}

/// A page is not written over the scene of its run, nor over its record.
#[test]
fn a_page_over_an_input_is_refused() {
    let folder = Folder::with(
        "s.toml",
        "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1\n[excitation.horizontal]\nkind = \"record\"\nfile = \"a.AT2\"\n[solver]\nt_end = 1\n",
    );
    folder.copy("scenes/records/synthetic.AT2", "a.AT2");
    folder.succeeds("run s.toml --out out");
    for name in ["s.toml", "a.AT2"] {
        let before = folder.read(name);
        folder.refused(&format!("report out --out {name}"), &[name]);
        assert_eq!(folder.read(name), before);
    }
    folder.succeeds("report out --out page.html");
}

/// Housner (1963): 1 - 3/2 sin² α = 0.876 of a block with b/h = 0.3.
#[test]
fn the_inputs_say_how_much_of_its_rate_a_plastic_column_keeps() {
    let scene = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[solver]\nt_end = 1.0\n";
    let page = run_text(&Folder::new(), "plastic", scene).page();
    assert!(page.contains("as one body the column keeps 88 % of its rate"));
}
