//! Inputs of a run: the column, gravity, contact law, ground motion, initial state, and the scene file itself.

use crate::ground_in_words;
use crate::number::{self, coefficients, widths};
use crate::report::html::definitions;
use crate::report::number::{percent, significant, with_minus};
use crate::text::escape;
use rocking::response::BlockState;
use rocking::run_folder::Results;
use rocking::{Restitution, StopReason};
use serde_json::Value;
use std::fmt::Write as _;

/// The inputs of a run.
pub fn inputs(results: &Results) -> String {
    let column = &results.column;
    let mut text = blocks(results);
    let peaks = results.peak_ground_acceleration;
    let component = |name: &str, axis: usize| {
        let motion = results.excitation.get(name).unwrap_or(&Value::Null);
        escape(&with_minus(&ground_in_words::words(motion, column.gravity(), peaks[axis])))
    };
    let mut rows = vec![
        ("Slenderness", format!("α = {} rad, of the whole column", significant(column.slenderness(), 5))),
        ("Gravity", format!("{} m/s²", significant(column.gravity(), 6))),
        ("Impacts", restitution(&results.restitution, column.housner_ratio())),
        ("Friction", results.friction.as_ref().map_or("not given".into(), coefficients)),
        ("Ground, horizontal", component("horizontal", 0)),
        ("Ground, vertical", component("vertical", 1)),
    ];
    rows.extend(initial(results).map(|state| ("Initial state", state)));
    let (end, planned) = (results.response.t_final, format!("{} s", significant(results.options.t_end, 6)));
    rows.push(match results.response.status {
        StopReason::Overturned | StopReason::Collapsed | StopReason::Undetermined => {
            ("Longest run", format!("{planned}; this one ends at t = {} s", significant(end, 4)))
        }
        _ => ("Length of the run", planned),
    });
    text.push_str(&definitions(&rows));
    let _ = write!(
        text,
        "<details><summary>The scene file, <code>{}</code></summary>\n<pre tabindex=\"0\">{}</pre></details>\n",
        escape(&results.scene.file.display().to_string()),
        escape(&results.scene.text)
    );
    text
}

/// The blocks, the top one first, as the column stands.
fn blocks(results: &Results) -> String {
    let mut rows = String::new();
    for (index, block) in results.column.blocks().iter().enumerate().rev() {
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&results.block_name(index)),
            widths(block, 5),
            significant(2.0 * block.half_height, 5),
            significant(block.mass, 5),
            significant(block.inertia, 5)
        );
    }
    format!(
        "<div class=\"wide\"><table>\n<caption>Blocks are numbered from the base; the top one stands first, as in the column.</caption>\n\
         <thead><tr><th scope=\"col\">block</th><th scope=\"col\">width [m]</th><th scope=\"col\">height [m]</th>\
         <th scope=\"col\">mass [kg]</th><th scope=\"col\">inertia [kg m²]</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

/// The contact law. `housner` is the ratio of the rates after and before a plastic impact of the column as one body.
fn restitution(law: &Restitution, housner: f64) -> String {
    let plastic = "angular momentum is conserved about the new pivots, nothing rebounds";
    match law {
        Restitution::Plastic => {
            let as_one_body = match housner > 0.0 {
                true => format!("as one body the column keeps {} of its rate", percent(housner)),
                false => "as one body the column is so squat that it stops at an impact".into(),
            };
            format!("plastic: {plastic}; {as_one_body}")
        }
        Restitution::Eta(eta) => format!(
            "η = {}: the ratio of rates after and before of the column as one body ({} if plastic)",
            significant(*eta, 5),
            significant(housner, 4)
        ),
        Restitution::Factors(factors) => {
            let factors: Vec<String> = factors.iter().map(|one| significant(*one, 5)).collect();
            format!("factors of the plastic relative rate, base first: {}", factors.join(", "))
        }
        law => escape(&format!("{law:?}")),
    }
}

/// Initial angles, rates and slides, and places and velocities where a block flies, from the row at the start. `None` if all are zero, or rows begin
/// later.
fn initial(results: &Results) -> Option<String> {
    let first = results.response.samples.first().filter(|first| first.t == 0.0)?;
    let flies = first.gap.iter().any(|gap| *gap != 0.0);
    let of_blocks =
        |value: fn(&BlockState) -> f64| first.blocks.iter().filter(|_| flies).map(value).collect::<Vec<_>>();
    let [x, y] = [of_blocks(|block| block.place[0]), of_blocks(|block| block.place[1])];
    let [vx, vy] = [of_blocks(|block| block.velocity[0]), of_blocks(|block| block.velocity[1])];
    let lists: [(&str, &[f64], &str); 7] = [
        ("θ", &first.theta, "rad"),
        ("ω", &first.omega, "rad/s"),
        ("slides", &first.slide, "m"),
        ("x", &x, "m"),
        ("y", &y, "m"),
        ("vx", &vx, "m/s"),
        ("vy", &vy, "m/s"),
    ];
    number::state(&lists).map(|state| with_minus(&state))
}
