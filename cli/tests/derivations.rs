//! `rocking derive`: equations of a mode as text, code and LaTeX, and what each pass saves.

use crate::common::{Folder, assert_has};

#[test]
fn derivations_are_printed_as_text_as_code_and_as_latex() {
    let folder = Folder::new();
    let text = folder.succeeds("derive --blocks 3 --mode 1.5");
    assert_has(&text, &["mode 1.5", "(+,0,0)", "T = ", "V = ", "M_1_1 = ", "Equations of motion", "7 flops"]);
    assert_has(
        &text,
        &["Blocks 1, 2 and 3 are link 1, turned by theta_1", "clockwise positive", "rectangles and stand aligned"],
    );
    // As below the figure of states, with its minus sign.
    let sliding = folder.succeeds("derive --blocks 2 --mode (−,+>u)");
    assert_has(
        &sliding,
        &["pivot_1 = -c_1, sticks", "pivot_2 = top_half_width_1, u_2 slides to the right along the upper face"],
    );
    // A block that slides does not stay with the ground, and results have the names of the equations.
    let flat = folder.succeeds("derive --blocks 2 --mode (0,0>)");
    assert_has(
        &flat,
        &["Blocks 1 and 2 do not turn.", "-> M_1_1 = tested_mass_1_1", "-> -(B_1 + Q_1) = tested_load_1"],
    );
    assert_has(&text, &["-> theta_ddot_1 = load_1", "-> M_1_1 = link_inertia_1", "-> T = ", "-> V = "]);
    let latex = folder.succeeds("derive --blocks 2 --mode (+>,f) --format latex");
    assert_has(
        &latex,
        &["$p_{1} = b_{1}^{\\mathrm{bot}}$", "$(x^{f}_{2}, y^{f}_{2})$", "interfaces that stick stand aligned"],
    );
    assert_has(
        &latex,
        &["slides to the right along the lower face, $\\dot u_{1} > 0$", "is positive to the right along its face"],
    );
    assert_has(&latex, &["K_{1,2} &= \\mathtt{mass\\_2\\_1}", "f_{3} &= \\mathtt{tested\\_load\\_1}"]);
    let code = folder.succeeds("derive --blocks 2 --mode (+>,f) --format rust");
    assert_has(
        &code,
        &["//   carried_mass_2 = mass_2", "use rocking::program::{Carried, MovingProgram, MovingState, Scalar};"],
    );
    let code = folder.succeeds("derive --blocks 2 --mode 1.1 --format rust");
    let parts =
        ["impl<S: Scalar> StepProgram<S> for Dof2", "SeriesProgram<S> for SeriesDof2", "pub fn scene_constants"];
    assert_has(&code, &parts);
    assert_has(&code, &["use rocking::program::{", "pub fn energy_scene_constants", "pub fn series_scene_constants"]);
    let latex = folder.succeeds("derive --blocks 3 --mode 1.5 --format latex");
    assert_has(&latex, &["\\documentclass", "mode 1.5", "$(+,0,0)$", "J_{1} \\ddot\\theta_{1}", "\\end{document}\n"]);
    for mode in ["3.2", "1.0", "18446744073709551616.1"] {
        folder.refused(&format!("derive --blocks 3 --mode {mode}"), &["has no such mode", "rocking modes --blocks 3"]);
    }
}

/// Pinned: what each pass is worth for three drums rocking apart.
#[test]
fn operation_counts_are_printed_before_and_after_each_pass() {
    let output = Folder::new().succeeds("derive --blocks 3 --mode 1.1 --counts");
    let flops_of = |start: &str| {
        let line = output.lines().find(|line| line.trim_start_matches([' ', '*']).starts_with(start));
        let line = line.unwrap_or_else(|| panic!("`{start}` is missing in\n{output}"));
        let fields: Vec<&str> = line.split_whitespace().rev().take(4).collect();
        fields[3].parse::<usize>().expect("a count")
    };
    assert_eq!(flops_of("mass matrix, rate terms, weight: as differentiated"), 199);
    assert_eq!(flops_of("each term in its cheapest form"), 140);
    assert_eq!(flops_of("scene constants hoisted"), 72);
    assert_eq!(flops_of("rates by pairs, weight by vector, SI"), 100);
    let kept: Vec<&str> = output.lines().filter(|line| line.starts_with("* rates")).collect();
    assert_eq!(kept.len(), 2);
    assert!(kept[0].contains(" 94 ") && kept[1].contains(" 97 "), "{kept:?}");
}
