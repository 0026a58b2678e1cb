//! The LaTeX derivation: its formulas are those that were derived, and its text is LaTeX that fits a page.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use rocking_codegen::derive;
use rocking_codegen::joints::Joints;
use rocking_codegen::pattern::{Pattern, linkages, modes};
use rocking_codegen::report::moving_latex;
use rocking_codegen::report::{Compact, latex};
use rocking_codegen::symbolic::latex::width;
use rocking_codegen::symbolic::{Arena, Environment, Expr};
use std::process::Command;

fn pattern(blocks: usize, mode: &str) -> Pattern {
    modes(blocks).find(|(label, _)| label.to_string() == mode).expect("there is such a mode").1
}

fn documents(largest: usize) -> impl Iterator<Item = (String, String)> {
    (1..=largest)
        .flat_map(|blocks| modes(blocks).map(move |(label, pattern)| (format!("{blocks} {label}"), latex(&pattern))))
}

fn value(arena: &Arena, expr: Expr, values: &Environment) -> f64 {
    arena.evaluate(expr, values).expect("all symbols have values")
}

/// The constants, the mass matrix, the other terms and the energies, evaluated as they are printed, against the derivation.
#[test]
fn the_printed_form_has_the_values_of_the_derivation() {
    let mut rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    for linkage in (1..=5).flat_map(linkages) {
        let mut derivation = derive(&linkage);
        let (arena, s, e) = (&mut derivation.arena, &derivation.symbols, &derivation.equations);
        let compact = Compact::find(arena, s, e);
        let motion: Vec<_> = (0..linkage.dof()).map(|row| compact.motion(arena, s, row).concat()).collect();
        for _ in 0..5 {
            let mut draw = |low: f64, high: f64| low + (high - low) * (f64::from(rng.next_u32()) / f64::from(u32::MAX));
            let mut at = Environment::new();
            for (family, low, high) in [
                (&s.theta, -0.9, 0.9),
                (&s.omega, -2.0, 2.0),
                (&s.alpha, -3.0, 3.0),
                (&s.pivot, -0.8, 0.8),
                (&s.half_height, 0.3, 1.5),
                (&s.mass, 0.4, 2.5),
                (&s.inertia, 0.1, 1.0),
                (&vec![s.ground_x], -4.0, 4.0),
                (&vec![s.gravity], 5.0, 13.0),
            ] {
                family.iter().for_each(|symbol| _ = at.insert(*symbol, draw(low, high)));
            }
            for definition in compact.definitions() {
                let constant = value(arena, definition.value, &at);
                at.insert(definition.symbol, constant);
            }
            // Both sides are sums of products of numbers of order one: some roundings of their largest terms.
            let agrees = |printed: &[Expr], derived: &[Expr], what: &str| {
                let sum = |terms: &[Expr], part: fn(f64) -> f64| -> f64 {
                    terms.iter().map(|term| part(value(arena, *term, &at))).sum()
                };
                let scale = 1.0 + sum(printed, f64::abs) + sum(derived, f64::abs);
                let difference = sum(printed, |x| x) - sum(derived, |x| x);
                assert!(difference.abs() <= 1e-12 * scale, "{linkage:?} {what}: {difference} of {scale}");
            };
            agrees(&compact.kinetic, &[e.kinetic], "T");
            agrees(&[compact.potential], &[e.potential], "V");
            for (row, terms) in motion.iter().enumerate() {
                for column in 0..linkage.dof() {
                    agrees(&[compact.mass[row][column]], &[e.mass[row][column]], "M");
                }
                agrees(&compact.bias[row], &[e.bias[row]], "rates");
                agrees(&compact.forcing[row], &[e.forcing[row]], "forcing");
                let mass: f64 =
                    e.mass[row].iter().zip(&s.alpha).map(|(m, alpha)| value(arena, *m, &at) * at[alpha]).sum();
                let residual = mass + value(arena, e.bias[row], &at) + value(arena, e.forcing[row], &at);
                let printed: f64 = terms.iter().map(|term| value(arena, *term, &at)).sum();
                assert!((printed - residual).abs() <= 1e-12 * (100.0 + residual.abs()), "{linkage:?} equation {row}");
            }
        }
    }
}

/// [`Compact::find`] proves every form and panics if one does not hold.
#[test]
fn every_linkage_has_the_compact_form() {
    for linkage in (1..=5).flat_map(linkages) {
        let mut derivation = derive(&linkage);
        let compact = Compact::find(&mut derivation.arena, &derivation.symbols, &derivation.equations);
        let dof = linkage.dof();
        assert_eq!((compact.coupling.len(), compact.kinetic.len()), (dof * (dof - 1) / 2, dof * (dof + 1) / 2));
        assert_eq!(compact.ground_moment.is_some(), !linkage.open[0]);
        for row in 0..dof {
            assert_eq!((compact.bias[row].len(), compact.forcing[row].len()), (dof - 1, 2), "{linkage:?}");
        }
    }
}

#[test]
fn braces_and_environments_are_balanced() {
    for (mode, text) in documents(4) {
        assert!(text.is_ascii(), "{mode}");
        let mut depth = 0i32;
        let mut previous = ' ';
        for character in text.chars() {
            depth += match (previous, character) {
                ('\\', _) => 0,
                (_, '{') => 1,
                (_, '}') => -1,
                _ => 0,
            };
            assert!(depth >= 0, "{mode}");
            // Two backslashes break a line: the second escapes nothing.
            previous = if previous == '\\' { ' ' } else { character };
        }
        assert_eq!(depth, 0, "{mode}");
        assert_eq!(text.matches("$").count() % 2, 0, "{mode}");
        for (open, close) in [("\\bigl", "\\bigr"), ("\\Bigl", "\\Bigr"), ("(", ")"), ("[", "]")] {
            assert_eq!(text.matches(open).count(), text.matches(close).count(), "{mode} {open}");
        }
        let mut open: Vec<&str> = Vec::new();
        for (position, _) in text.match_indices('\\') {
            let rest = &text[position..];
            let name =
                |rest: &'_ str| rest.find('}').map(|end| position + rest.find('{').unwrap_or(0) + 1..position + end);
            if rest.starts_with("\\begin{") {
                open.push(&text[name(rest).expect("closed")]);
            } else if rest.starts_with("\\end{") {
                assert_eq!(open.pop(), Some(&text[name(rest).expect("closed")]), "{mode}");
            }
        }
        assert!(open.is_empty(), "{mode}: {open:?}");
    }
}

/// Every macro is plain LaTeX or amsmath.
#[test]
fn only_known_macros_are_used() {
    const KNOWN: &[&str] = &[
        "allowdisplaybreaks",
        "arraycolsep",
        "author",
        "begin",
        "bigl",
        "bigr",
        "cdot",
        "cos",
        "date",
        "ddot",
        "documentclass",
        "dot",
        "emergencystretch",
        "end",
        "frac",
        "hat",
        "maketitle",
        "mathbf",
        "mathrm",
        "mathtt",
        "notag",
        "parallel",
        "partial",
        "perp",
        "quad",
        "section",
        "setcounter",
        "sin",
        "sum",
        "tfrac",
        "theta",
        "title",
        "omega",
        "usepackage",
        // Not letters: end of a row, a space, an underscore.
        "\\",
        ",",
        "_",
    ];
    for (mode, text) in documents(4) {
        let mut rest = text.as_str();
        while let Some(position) = rest.find('\\') {
            rest = &rest[position + 1..];
            let letters = rest.chars().take_while(char::is_ascii_alphabetic).count().max(1);
            let (name, tail) = rest.split_at(letters);
            assert!(KNOWN.contains(&name), "{mode}: \\{name}");
            rest = tail;
        }
    }
}

/// The text between two headings.
fn section<'a>(text: &'a str, heading: &str) -> &'a str {
    let (_, rest) = text.split_once(&format!("\\section*{{{heading}}}")).expect("there is such a section");
    rest.split("\\section*").next().expect("split gives one part at least")
}

/// Visible symbols, by a count of its own: macros for one, scripts and letters alike.
fn symbols(line: &str) -> usize {
    let mut count = 0;
    let mut rest = line;
    while let Some(character) = rest.chars().next() {
        let letters = match character {
            '\\' => 1 + rest[1..].chars().take_while(char::is_ascii_alphabetic).count().max(1),
            _ => 1,
        };
        let (token, tail) = rest.split_at(letters);
        let mute = [
            "{", "}", " ", "_", "^", "&", "\\\\", "\\notag", "\\quad", "\\dot", "\\ddot", "\\hat", "\\mathtt",
            "\\bigl", "\\bigr",
        ];
        count += usize::from(!mute.contains(&token));
        rest = tail;
    }
    count
}

#[test]
fn no_line_of_a_display_leaves_the_page() {
    let largest = [(6, "1.1"), (6, "1.41"), (8, "1.1094"), (10, "1.1")];
    let large = largest.iter().map(|(blocks, mode)| ((*mode).to_string(), latex(&pattern(*blocks, mode))));
    let states = ["(+>,f)", "(f,f,f)", "(0,+<u,0>,-)", "(+,-,+,f)"]
        .map(|states| (states.to_string(), moving_latex(&Joints::parse(states).expect("states that slide or fly"))));
    for (mode, text) in documents(4).chain(large).chain(states) {
        let displays: Vec<_> =
            text.split("\\begin{align").skip(1).filter_map(|rest| rest.split_once("\\end{align")).collect();
        assert!(displays.len() > 2, "{mode}: {} displays", displays.len());
        for (display, _) in displays {
            let plain = |line: &str| {
                ["\\notag", "\\\\[1ex]", "\\\\[0.5ex]", "\\\\"]
                    .iter()
                    .fold(line.to_string(), |line, part| line.replace(part, ""))
            };
            let rows: Vec<String> = display.lines().filter(|line| line.contains('&')).map(plain).collect();
            let sides: Vec<(&str, &str)> = rows.iter().filter_map(|row| row.split_once('&')).collect();
            assert!(!sides.is_empty(), "{mode}: a display without equations: {display}");
            // Left sides stand in a column, as wide as the widest.
            let column = sides.iter().map(|(left, _)| width(left)).fold(0.0, f64::max);
            for (left, right) in sides {
                let whole = column + width(&right.replace('&', ""));
                assert!(whole <= 440.0, "{mode}: {whole} pt in {left} {right}");
                let count = symbols(left) + symbols(right);
                assert!(count <= 95, "{mode}: {count} symbols in {left} {right}");
            }
        }
    }
}

/// Pinned, so that a change shows: characters of LaTeX, and terms of `T` multiplied out and as printed.
#[test]
fn shared_factors_are_collected() {
    let text = latex(&pattern(3, "1.1"));
    let sizes = ["Energies", "Equations of motion"].map(|heading| section(&text, heading).len());
    assert!(sizes[0] < 2000 && sizes[1] < 2500, "{sizes:?}");
    let mut derivation = derive(&pattern(3, "1.1").linkage());
    let multiplied_out = derivation.arena.expand_fully(derivation.equations.kinetic);
    let compact = Compact::find(&mut derivation.arena, &derivation.symbols, &derivation.equations);
    assert_eq!((derivation.arena.terms(multiplied_out).len(), compact.kinetic.len()), (75, 6));
    for (blocks, mode, collected) in [
        (3, "1.5", "S_{1}^{\\perp} &= -p_{1} (m_{1} + m_{2} + m_{3})"),
        (
            3,
            "1.1",
            "J_{1} &= I_{1} + m_{1} (p_{1}^{2} + h_{1}^{2}) + (m_{2} + m_{3}) \\bigl[4 h_{1}^{2} + (p_{1} - p_{2})^{2}\\bigr]",
        ),
        (3, "1.1", "S_{1}^{\\parallel} &= h_{1} (m_{1} + 2 m_{2} + 2 m_{3})"),
        (2, "1.1", "\\mathbf{G}_{2} &= (p_{1}, 0) + R(\\theta_{1}) \\mathbf{d}_{1} + R(\\theta_{2}) (-p_{2}, h_{2})"),
        (2, "1.1", "\\mathbf{d}_{1} = (d_{1}^{\\perp}, d_{1}^{\\parallel}) &= (p_{2} - p_{1}, 2 h_{1})"),
        (2, "2.1", "V &= \\hat g (S_{1}^{\\parallel} \\cos\\theta_{1} - S_{1}^{\\perp} \\sin\\theta_{1} + S_{0})"),
    ] {
        let text = latex(&pattern(blocks, mode));
        assert!(text.contains(collected), "{collected} is not in\n{text}");
    }
}

#[test]
fn signs_of_the_pivots_and_links_are_told() {
    let text = latex(&pattern(4, "2.3"));
    for part in [
        "$(0,+,+,-)$",
        "$p_{4} = -c_{4}$",
        "Block~1 stays with the ground",
        "block~4 is link 3",
        "interface~1 is closed",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert!(latex(&pattern(2, "1.2").mirror()).contains("mode 1.2, mirrored"));
}

#[test]
#[ignore = "needs pdflatex"]
fn pdflatex_takes_it_without_a_warning_of_width() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("latex");
    std::fs::create_dir_all(&folder).expect("a folder for the documents");
    let all = (1..=3).flat_map(|blocks| modes(blocks).map(move |(label, _)| (blocks, label.to_string())));
    let large = [(4, "1.5"), (4, "2.1"), (6, "1.1"), (6, "1.41"), (8, "1.1094"), (10, "1.1")];
    for (blocks, mode) in all.chain(large.map(|(blocks, mode)| (blocks, mode.to_string()))) {
        let name = format!("column-{blocks}-mode-{mode}");
        let file = format!("{name}.tex");
        std::fs::write(folder.join(&file), latex(&pattern(blocks, &mode))).expect("written");
        let output = Command::new("pdflatex")
            .args(["-interaction=nonstopmode", "-halt-on-error", &file])
            .current_dir(&folder)
            .output()
            .expect("pdflatex runs");
        let log = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{name}:\n{log}");
        for complaint in ["Overfull", "undefined", "Missing"] {
            assert!(!log.contains(complaint), "{name}:\n{log}");
        }
    }
}
