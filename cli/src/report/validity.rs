//! Whether the model holds for a run, in plain words: friction demand, smallest normal force, separations.

use crate::number::{percent, significant};
use crate::text::escape;
use rocking::run_folder::Results;
use std::fmt::Write as _;

/// Above this, bare stone on stone slides: friction coefficients of dry masonry stay below one.
const UNUSUAL_FRICTION: f64 = 1.0;

/// Warnings that are shown at once; a longer list is folded, as the verdict above sums it up.
const WARNINGS_SHOWN: usize = 5;

/// Whether a run stayed within the model's limits.
enum Verdict {
    /// Nothing speaks against the model.
    Holds(String),
    /// The model holds for joints that are rough enough; the scene gives no friction coefficient.
    Conditional(String),
    /// The reasons against it.
    Fails(Vec<String>),
    /// Contact forces were not recorded.
    Unknown,
}

/// The interface, from 0, that needs most friction, with its demand; infinite where none is enough.
fn largest_demand(results: &Results) -> Option<(usize, f64)> {
    results.response.friction_demand.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}

fn judge(results: &Results) -> Verdict {
    let response = &results.response;
    let mut reasons = Vec::new();
    if let Some(first) = response.separations.first() {
        let count = response.separations.len();
        let times = if count == 1 { "once".into() } else { format!("{count} times, first") };
        reasons.push(format!(
            "a block would leave its contact ({times} at t = {} s); what comes after is not reliable",
            significant(first.t, 5)
        ));
    }
    let forces = response.min_normal_force.iter().enumerate();
    let parted: Vec<usize> = forces.filter(|(_, force)| **force < 0.0).map(|(at, _)| at).collect();
    if !parted.is_empty() {
        reasons.push(format!("{} would have to pull: the blocks would part", named(&parted)));
    }
    let Some((worst, demand)) = largest_demand(results) else {
        return if reasons.is_empty() { Verdict::Unknown } else { Verdict::Fails(reasons) };
    };
    let demands = response.friction_demand.iter().copied().enumerate();
    let beyond = |available: f64| demands.clone().filter(|(_, demand)| *demand > available).map(|(at, _)| at).collect();
    if demand.is_infinite() {
        let limitless: Vec<usize> = beyond(f64::MAX);
        reasons.push(format!("no friction coefficient is enough at {}: the blocks would slide", named(&limitless)));
    } else if let Some(available) = results.available_friction().filter(|available| demand > *available) {
        let sliding: Vec<usize> = beyond(available);
        let (verb, most) = if sliding.len() == 1 { ("needs", "") } else { ("need", "up to ") };
        reasons.push(format!(
            "{} {verb} a friction coefficient of {most}{}, the scene has {}: the blocks would slide",
            named(&sliding),
            significant(demand, 3),
            significant(available, 3)
        ));
    }
    match (reasons.is_empty(), results.available_friction()) {
        (false, _) => Verdict::Fails(reasons),
        (true, Some(available)) => Verdict::Holds(format!(
            "no block leaves its contact, and the joints need a friction coefficient of at most {} where the scene has {}",
            significant(demand, 3),
            significant(available, 3)
        )),
        (true, None) if demand == 0.0 => {
            Verdict::Holds("no block leaves its contact, and no joint needs any friction".into())
        }
        (true, None) => Verdict::Conditional(format!(
            "no block leaves its contact, and {} needs a friction coefficient of {}{}",
            named(&[worst]),
            significant(demand, 3),
            if demand > UNUSUAL_FRICTION { ", which is more than bare stone on stone offers" } else { "" }
        )),
    }
}

/// Interfaces, given from 0, by their numbers.
fn named(interfaces: &[usize]) -> String {
    let numbers: Vec<String> = interfaces.iter().map(|interface| (interface + 1).to_string()).collect();
    match numbers.split_last() {
        Some((last, [])) => format!("interface {last}"),
        Some((last, others)) => format!("interfaces {} and {last}", others.join(", ")),
        None => String::new(),
    }
}

/// The verdict in a sentence or a list, with its sign.
pub fn verdict(results: &Results) -> String {
    let (class, sign, words) = match judge(results) {
        Verdict::Holds(why) => ("holds", "✓", format!("<p><strong>The model holds for this run</strong>: {why}.</p>")),
        Verdict::Conditional(why) => (
            "conditional",
            "?",
            format!(
                "<p><strong>The model holds if the joints are rough enough</strong>: {why}. The scene names no coefficient.</p>"
            ),
        ),
        Verdict::Fails(reasons) => {
            let reasons: String = reasons.iter().map(|reason| format!("<li>{reason}</li>")).collect();
            ("fails", "!", format!("<p><strong>The model does not hold for this run</strong>:</p><ul>{reasons}</ul>"))
        }
        Verdict::Unknown => (
            "conditional",
            "?",
            "<p><strong>Whether the model holds is not known</strong>: contact forces were not recorded.</p>".into(),
        ),
    };
    format!(
        "<div class=\"verdict {class}\"><span class=\"sign\" aria-hidden=\"true\">{sign}</span><div>{words}</div></div>\n"
    )
}

/// Demands and forces per interface, the top one first, and what they mean.
pub fn details(results: &Results) -> String {
    let (response, column) = (&results.response, &results.column);
    let mut rows = String::new();
    for interface in (0..column.len().min(response.friction_demand.len()).min(response.min_normal_force.len())).rev() {
        let weight = column.mass_above(interface) * column.gravity();
        let demand = response.friction_demand[interface];
        let force = response.min_normal_force[interface];
        let slides = results.available_friction().is_some_and(|available| demand > available);
        let known = |text: String| if force.is_finite() { text } else { "not finite".into() };
        let share = known(format!("{} <span class=\"note\">{}</span>", significant(force, 4), percent(force / weight)));
        let _ = writeln!(
            rows,
            "<tr{}><th scope=\"row\">{}</th><td>{}</td><td>{share}</td><td>{}</td></tr>",
            if slides { " class=\"beyond\"" } else { "" },
            interface + 1,
            if demand.is_finite() { significant(demand, 3) } else { "none is enough".into() },
            significant(weight, 4),
        );
    }
    let mut text = String::new();
    if !rows.is_empty() {
        let available = results.available_friction().map_or("the scene names no coefficient".into(), |friction| {
            format!("the scene has {}", significant(friction, 3))
        });
        let _ = write!(
            text,
            "<div class=\"wide\"><table>\n<caption>Per interface, the top one first; interface 1 is under block 1. Friction: {available}.</caption>\n\
             <thead><tr><th scope=\"col\">interface</th><th scope=\"col\">largest friction demand |T|/N</th>\
             <th scope=\"col\">smallest normal force [N], share of weight</th><th scope=\"col\">weight above [N]</th></tr></thead>\n\
             <tbody>\n{rows}</tbody></table></div>\n"
        );
    }
    text.push_str(
        "<p>In the model blocks rock about their corners; they neither slide nor fly. The friction demand is the coefficient that an \
         interface needs so as not to slide; a normal force that falls to zero is a block about to lift off. Peaks that last a \
         few milliseconds count in full.</p>\n",
    );
    if response.overturned_at().is_some() {
        text.push_str(
            "<p>The column falls in this run, and the fall is included: its friction demand grows with the lean.</p>\n",
        );
    }
    let separations = match response.separations.len() {
        0 => "<p>Separations: none.</p>\n".to_string(),
        count => {
            let times: Vec<String> = response.separations.iter().take(5).map(|one| significant(one.t, 6)).collect();
            let more = if count > times.len() { ", …" } else { "" };
            format!("<p>Separations: {count}, at t = {}{more} s.</p>\n", times.join(", "))
        }
    };
    text.push_str(&separations);
    if !results.warnings.is_empty() {
        let list: String = results.warnings.iter().map(|warning| format!("<li>{}</li>", escape(warning))).collect();
        let list = format!("<ul class=\"warnings\">{list}</ul>");
        let _ = match results.warnings.len() {
            0..=WARNINGS_SHOWN => writeln!(text, "<h3>Warnings of the run</h3>\n{list}"),
            count => writeln!(text, "<details><summary>{count} warnings of the run</summary>\n{list}</details>"),
        };
    }
    text
}
