//! `rocking thresholds`: when a column's interfaces open.

use rocking::Scene;
use std::fmt::Write as _;

/// The paper's Tables 1 and 2 for a column: heights, and the ground acceleration that opens each interface at rest.
pub fn thresholds(scene: &Scene) -> String {
    let column = &scene.column;
    let slenderness = column.slenderness();
    let mut text = format!(
        "column of {} block(s), slenderness {:.4} rad\ninterface  c [m]     h_P [m]   c/h_P     c/(h_P alpha)  opens at [m/s2]  [g]\n",
        column.len(),
        slenderness
    );
    for interface in 0..column.len() {
        let (half_width, height) = (column.contact_half_width(interface), column.centroid_height(interface));
        let ratio = half_width / height;
        let acceleration = column.uplift_acceleration(interface);
        let _ = writeln!(
            text,
            "{:<10} {:<9.4} {:<9.4} {:<9.4} {:<14.2} {:<16.4} {:.4}",
            interface + 1,
            half_width,
            height,
            ratio,
            ratio / slenderness,
            acceleration,
            acceleration / column.gravity()
        );
    }
    text
}
