//! `rocking derive` and `rocking modes` of states with friction: formats, table, figure, and what is refused.

mod common;

fn derive(blocks: &str, states: &str, more: &[&str]) -> String {
    common::succeeds(&common::root(), &[&["derive", "--blocks", blocks, "--mode", states], more].concat())
}

#[test]
fn a_sliding_block_is_derived_in_every_format() {
    let text = derive("1", "(0>)", &[]);
    assert!(
        text.starts_with("states (0>) of 1 block(s), 0 free angle(s), 1 translation(s), program Angles0Translations1"),
        "{text}"
    );
    // By hand: m u¨ + m (x¨_g + mu g) = 0.
    assert!(
        text.contains("M_1_1 = mass_1\n") && text.contains("Q_1 = ground_x*mass_1 + gravity*mass_1*mu_1\n"),
        "{text}"
    );
    let latex = derive("1", "(0>)", &["--format", "latex"]);
    assert!(latex.contains("\\begin{document}") && latex.trim_end().ends_with("\\end{document}"), "{latex}");
    assert!(latex.contains("\\ddot u_{1}") && latex.contains("\\mu_{1}"), "{latex}");
    let rust = derive("1", "(0>)", &["--format", "rust"]);
    assert!(rust.contains("impl<S: Scalar> MovingProgram<S, 0, 1, 1> for Angles0Translations1"), "{rust}");
    let counts = derive("1", "(0>)", &["--counts"]);
    assert!(counts.contains("program Angles0Translations1") && counts.contains("flops"), "{counts}");
}

/// The direction of a slide is the sign of its friction, and nothing else in the rows.
#[test]
fn slides_to_the_left_have_the_opposite_friction() {
    let (right, left) = (derive("2", "(+,->)", &[]), derive("2", "(+,-<)", &[]));
    assert!(right.contains("tested along (1, mu_2)") && left.contains("tested along (1, -mu_2)"), "{right}");
    assert_eq!(right.lines().count(), left.lines().count());
    assert_ne!(right, left);
}

#[test]
fn a_corner_may_slide_on_either_face() {
    let (lower, upper) = (derive("2", "(+,+>)", &[]), derive("2", "(+,+>u)", &[]));
    assert!(lower.contains("along the lower face") && upper.contains("along the upper face"));
    assert_ne!(lower.split("Positions").nth(1), upper.split("Positions").nth(1));
}

#[test]
fn states_that_stick_are_a_mode() {
    for format in ["text", "rust", "latex"] {
        let states = derive("3", "(+,0,-)", &["--format", format]);
        assert_eq!(states, derive("3", "1.6", &["--format", format]));
    }
}

#[test]
fn what_is_no_state_is_refused_with_the_states_there_are() {
    for (blocks, states, words) in [
        ("2", "(+,up)", ["`up` is no state of interface 2", "states are 0, 0>, 0<"]),
        ("2", "(+>,0", ["in parentheses", "base first"]),
        ("3", "(+>,0)", ["2 state(s) for 3 block(s)", "one per interface"]),
        ("2", "(0,0)", ["nothing moves", "open an interface"]),
        ("1", "(+>u)", ["the ground has no corner", "leave the u out"]),
    ] {
        let output = common::rocking(&common::root(), &["derive", "--blocks", blocks, "--mode", states]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        // Messages are broken into lines.
        let message = message.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert!(words.iter().all(|word| message.contains(word)), "{states}: {message}");
    }
}

#[test]
fn the_table_of_programs_counts_every_combination_of_states_once() {
    for blocks in 1..=4u32 {
        let text = common::succeeds(&common::root(), &["modes", "--blocks", &blocks.to_string(), "--friction"]);
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split_whitespace().collect()).collect();
        let rows: Vec<&Vec<&str>> = rows.iter().filter(|row| row.len() == 5 && row[0].parse::<u32>().is_ok()).collect();
        let states: u64 = rows.iter().map(|row| row[2].parse::<u64>().expect("a number")).sum();
        assert_eq!(states, 10u64.pow(blocks) - 3u64.pow(blocks));
        assert!(rows.iter().all(|row| row[3] == format!("Angles{}Translations{}", row[0], row[1])), "{text}");
    }
    let json = common::succeeds(&common::root(), &["modes", "--blocks", "3", "--friction", "--json"]);
    let rows: Vec<serde_json::Value> = serde_json::from_str(&json).expect("JSON");
    assert_eq!(rows.len(), 18);
    let readme = std::fs::read_to_string(common::root().join("README.md")).expect("readable");
    assert!(readme.contains("18 programs serve the\n973 combinations of three blocks"), "the README counts them");
}

#[test]
fn the_figure_of_the_book_is_what_its_command_writes() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["modes", "--blocks", "1", "--friction", "--svg", "interface-states.svg"];
    common::succeeds(folder.path(), &arguments);
    let [written, committed] = [folder.path().to_path_buf(), common::root().join("docs")]
        .map(|folder| std::fs::read_to_string(folder.join("interface-states.svg")).expect("readable"));
    assert_eq!(written.matches("<title>state ").count(), 10);
    let texts = |svg: &str| {
        let document = roxmltree::Document::parse(svg).expect("XML");
        let texts =
            document.descendants().filter(|node| node.is_text()).filter_map(|node| node.text().map(String::from));
        texts.collect::<Vec<_>>()
    };
    assert!(texts(&written) == texts(&committed), "renew it: rocking {} in docs/", arguments.join(" "));
}
