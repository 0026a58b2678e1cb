//! `rocking derive` and `rocking modes` of states with friction: formats, table, figure, and what is refused.

use crate::common::{Folder, assert_has, project_text, unbroken};

fn derive(blocks: &str, states: &str, more: &str) -> String {
    Folder::new().succeeds(&format!("derive --blocks {blocks} --mode {states} {more}"))
}

#[test]
fn a_sliding_block_is_derived_in_every_format() {
    let text = derive("1", "(0>)", "");
    assert!(
        text.starts_with("states (0>) of 1 block(s), 0 free angle(s), 1 translation(s), program Angles0Translations1"),
        "{text}"
    );
    // By hand: m u¨ + m (x¨_g + mu g) = 0.
    assert_has(&text, &["M_1_1 = mass_1\n", "Q_1 = ground_x*mass_1 + gravity*mass_1*mu_1\n"]);
    let latex = derive("1", "(0>)", "--format latex");
    assert!(latex.contains("\\begin{document}") && latex.trim_end().ends_with("\\end{document}"), "{latex}");
    assert_has(&latex, &["\\ddot u_{1}", "\\mu_{1}"]);
    let rust = derive("1", "(0>)", "--format rust");
    assert!(rust.contains("impl<S: Scalar> MovingProgram<S, 0, 1, 1> for Angles0Translations1"), "{rust}");
    let counts = derive("1", "(0>)", "--counts");
    assert_has(&counts, &["program Angles0Translations1", "flops"]);
}

/// The direction of a slide is the sign of its friction, and nothing else in the rows.
#[test]
fn slides_to_the_left_have_the_opposite_friction() {
    let (right, left) = (derive("2", "(+,->)", ""), derive("2", "(+,-<)", ""));
    assert!(right.contains("tested along (1, mu_2)") && left.contains("tested along (1, -mu_2)"), "{right}");
    assert_eq!(right.lines().count(), left.lines().count());
    assert_ne!(right, left);
}

#[test]
fn a_corner_may_slide_on_either_face() {
    let (lower, upper) = (derive("2", "(+,+>)", ""), derive("2", "(+,+>u)", ""));
    assert!(lower.contains("along the lower face") && upper.contains("along the upper face"));
    assert_ne!(lower.split("Positions").nth(1), upper.split("Positions").nth(1));
}

#[test]
fn states_that_stick_are_a_mode() {
    for format in ["text", "rust", "latex"] {
        let states = derive("3", "(+,0,-)", &format!("--format {format}"));
        assert_eq!(states, derive("3", "1.6", &format!("--format {format}")));
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
        let message = unbroken(&Folder::new().refused(&format!("derive --blocks {blocks} --mode {states}"), &[]));
        assert!(words.iter().all(|word| message.contains(word)), "{states}: {message}");
    }
}

#[test]
fn the_table_of_programs_counts_every_combination_of_states_once() {
    for blocks in 1..=4u32 {
        let text = Folder::new().succeeds(&format!("modes --blocks {blocks} --friction"));
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split_whitespace().collect()).collect();
        let rows: Vec<&Vec<&str>> = rows.iter().filter(|row| row.len() == 5 && row[0].parse::<u32>().is_ok()).collect();
        let states: u64 = rows.iter().map(|row| row[2].parse::<u64>().expect("a number")).sum();
        assert_eq!(states, 10u64.pow(blocks) - 3u64.pow(blocks));
        assert!(rows.iter().all(|row| row[3] == format!("Angles{}Translations{}", row[0], row[1])), "{text}");
    }
    let rows = Folder::new().answers("modes --blocks 3 --friction --json");
    assert_eq!(rows.as_array().map(Vec::len), Some(18));
    let readme = project_text("README.md");
    assert!(readme.contains("18 programs serve the\n973 combinations of three blocks"), "the README counts them");
}

#[test]
fn the_figure_of_the_book_is_what_its_command_writes() {
    let folder = Folder::new();
    let command = "modes --blocks 1 --friction --svg interface-states.svg";
    folder.succeeds(command);
    let [written, committed] = [folder.read("interface-states.svg"), project_text("docs/interface-states.svg")];
    assert_eq!(written.matches("<title>state ").count(), 10);
    let texts = |svg: &str| {
        let document = roxmltree::Document::parse(svg).expect("XML");
        let texts =
            document.descendants().filter(|node| node.is_text()).filter_map(|node| node.text().map(String::from));
        texts.collect::<Vec<_>>()
    };
    assert!(texts(&written) == texts(&committed), "renew it: rocking {command} in docs/");
}
