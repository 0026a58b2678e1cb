//! `rocking thresholds`: the ground acceleration at which each interface of a column opens.

use rocking::{Scene, Stack};
use serde::Serialize;
use std::fmt::Write as _;

/// The stack above an interface as one body that rocks on it.
#[derive(Debug, Serialize)]
pub struct Row {
    /// From 1, base first.
    pub interface: usize,
    /// Mass, sizes, inertia.
    #[serde(flatten)]
    pub stack: Stack,
    /// `[rad]`
    pub slenderness: f64,
    /// `[rad/s]`
    pub frequency_parameter: f64,
    /// `[m/s²]`
    pub uplift_acceleration: f64,
    /// Dimensionless.
    pub housner_ratio: f64,
}

/// The note that a scene with given places of its blocks is described as if these stood on each other; nothing for another scene.
pub fn note_of_places(scene: &Scene) -> &'static str {
    match scene.initial.x.is_empty() {
        true => "",
        false => {
            "note: x and y place the blocks; stacks, and what opens or slides, are of the column as if it stood at rest, each block in the middle of the one below (`slide` displaces it)\n"
        }
    }
}

/// All interfaces of a scene's column, base first.
pub fn rows(scene: &Scene) -> Vec<Row> {
    let row = |interface: usize| {
        let stack = scene.column.stack(interface);
        Row {
            interface: interface + 1,
            stack,
            slenderness: stack.slenderness(),
            frequency_parameter: stack.frequency_parameter(),
            uplift_acceleration: stack.uplift_acceleration(),
            housner_ratio: stack.housner_ratio(),
        }
    };
    (0..scene.column.len()).map(row).collect()
}

/// The paper's Tables 1 and 2 for a column: heights, and the ground acceleration that opens each interface at rest.
pub fn thresholds(scene: &Scene) -> String {
    let slenderness = scene.column.slenderness();
    let mut text = format!(
        "column of {} block(s), slenderness {slenderness:.4} rad\n\
         interface  c [m]     h_P [m]   c/h_P     c/(h_P alpha)  opens at [m/s2]  [g]\n",
        scene.column.len(),
    );
    for Row { interface, stack, uplift_acceleration, .. } in rows(scene) {
        let ratio = stack.half_width / stack.centroid_height;
        let _ = writeln!(
            text,
            "{interface:<10} {:<9.4} {:<9.4} {ratio:<9.4} {:<14.2} {uplift_acceleration:<16.4} {:.4}",
            stack.half_width,
            stack.centroid_height,
            ratio / slenderness,
            uplift_acceleration / stack.gravity
        );
    }
    if scene.column.slides().iter().any(|slide| *slide != 0.0) {
        text.push_str("note: blocks are displaced; each row is of the weaker side of its interface\n");
    }
    text.push_str(note_of_places(scene));
    text
}
