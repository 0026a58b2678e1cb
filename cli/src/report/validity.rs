//! Whether the model holds for a run, in plain words: friction demand, smallest normal force, separations; with friction, what slid and flew, and
//! whether the energy balance closes.

use crate::number::coefficients;
use crate::report::number::{degrees, fixed, percent, significant, with_minus};
use crate::text::escape;
use rocking::run_folder::Results;
use rocking::validity::{COEFFICIENTS, ContactNeeds, Extreme, LIGHT_CONTACT};
use rocking::{ContactTimes, Response, SlidingReport, StopReason, Validity};
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
    /// The model holds, with the reason and a list of reservations.
    Noted(String, Vec<String>),
    /// The model does not hold, for these reasons.
    Fails(Vec<String>),
    /// Nothing is known of the contacts, for this reason.
    Unknown(&'static str),
}

/// Interface, from 0, with the largest friction demand, and this demand; infinite if no coefficient is enough. `None` without recorded forces.
fn largest_demand(results: &Results) -> Option<(usize, f64)> {
    results.response.counted_forces().0.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Relative error of the energy balance above which a run is not trusted.
const BALANCE: f64 = 1e-6;

/// Share of the energy that lifts the column by its own height below which works are rounding: a block in free flight does none.
const NO_WORK: f64 = 1e-11;

/// The energy balance of a run in which some work was done ([`SlidingReport::balance`]).
fn balance(results: &Results, report: &SlidingReport) -> Option<f64> {
    let height: f64 = results.column.blocks().iter().map(|block| 2.0 * block.half_height).sum();
    let least = NO_WORK * results.column.mass_above(0) * results.column.gravity() * height;
    let SlidingReport { ground_work, friction_work, impact_losses, ground_exchange, energy_change, .. } = *report;
    let works = [ground_work, friction_work, impact_losses, ground_exchange, energy_change];
    report.balance().filter(|_| works.iter().any(|work| work.abs() > least))
}

/// The verdict on a run whose friction is modelled.
fn judge_sliding(results: &Results, report: &SlidingReport) -> Verdict {
    let response = &results.response;
    if response.status == StopReason::Undetermined {
        let t = significant(response.t_final, 5);
        return Verdict::Fails(vec![format!("no motion follows from the laws of contact with friction at t = {t} s")]);
    }
    if !report.is_any() {
        let why = match largest_demand(results) {
            Some((worst, demand)) if demand > 0.0 => format!(
                "friction holds, no block slides or flies; {} comes nearest to sliding, with |T|/N up to {}",
                named(&[worst]),
                significant(demand, 3)
            ),
            _ => "friction holds, no block slides or flies".into(),
        };
        return Verdict::Holds(why);
    }
    let moved = |kind: fn(&SlidingReport, usize) -> bool| -> Vec<usize> {
        (0..report.way_slid.len()).filter(|&interface| kind(report, interface)).collect()
    };
    let slid = moved(|report, interface| report.way_slid[interface] > 0.0);
    let flew = moved(|report, interface| report.flights[interface] > 0);
    let mut parts = Vec::new();
    if !slid.is_empty() {
        parts.push(format!("{} slid", named(&slid)));
    }
    if !flew.is_empty() {
        parts.push(format!("{} parted for a time", named(&flew)));
    }
    let mut why = format!("sliding and flight are part of it; {}", parts.join(", "));
    let mut notes = Vec::new();
    match balance(results, report) {
        Some(error) if error <= BALANCE => {
            let _ = write!(why, ", and the energy balance closes to {}", significant(error, 1));
        }
        Some(error) => notes.push(format!("the energy balance is open by {} of the work done", percent(error))),
        None => {}
    }
    for (instants, what) in [
        (&report.ambiguous, "friction admits several motions, of which one was taken by the rules of the model"),
        (&report.jammed, "friction admits no smooth motion: the blocks jam, and strike"),
    ] {
        if !instants.is_empty() {
            notes.push(format!("at {}, {what}", times(instants)));
        }
    }
    if notes.is_empty() { Verdict::Holds(why) } else { Verdict::Noted(why, notes) }
}

/// Largest number of instants that are listed.
const TIMES_SHOWN: usize = 5;

/// Instants in words.
fn times(instants: &[f64]) -> String {
    let listed: Vec<String> = instants.iter().take(TIMES_SHOWN).map(|one| significant(*one, 6)).collect();
    match instants.len() {
        1 => format!("t = {} s", listed[0]),
        count => {
            format!("{count} instants, t = {}{} s", listed.join(", "), if count > listed.len() { ", …" } else { "" })
        }
    }
}

fn judge(results: &Results) -> Verdict {
    let response = &results.response;
    if let Some(report) = &response.sliding {
        return judge_sliding(results, report);
    }
    if response.validity.as_ref().is_some_and(|validity| validity.until <= 0.0) {
        return Verdict::Unknown("the column falls from the start, and contacts count up to the point of no return");
    }
    let mut reasons = Vec::new();
    let (count, first) = match &response.validity {
        Some(validity) => (validity.separations, validity.first_separation),
        None => (response.separations.len(), response.separations.first().map(|first| first.t)),
    };
    if let Some(first) = first {
        let times = if count == 1 { "once".into() } else { format!("{count} times, first") };
        reasons.push(format!(
            "a block would leave its contact ({times} at t = {} s); what comes after is not reliable",
            significant(first, 5)
        ));
    }
    let (friction_demand, min_normal_force) = response.counted_forces();
    let forces = min_normal_force.iter().enumerate();
    let parted: Vec<usize> = forces.filter(|(_, force)| **force < 0.0).map(|(at, _)| at).collect();
    if !parted.is_empty() {
        reasons.push(format!("{} would have to pull: the blocks would part", named(&parted)));
    }
    let Some((worst, demand)) = largest_demand(results) else {
        return if reasons.is_empty() {
            Verdict::Unknown("contact forces were not recorded")
        } else {
            Verdict::Fails(reasons)
        };
    };
    let demands = friction_demand.iter().copied().enumerate();
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
            "no block leaves its contact, and {} needs a friction coefficient of {}{}{}",
            named(&[worst]),
            significant(demand, 3),
            if demand > UNUSUAL_FRICTION { ", which is more than bare stone on stone offers" } else { "" },
            impacts_need(response, demand)
        )),
    }
}

/// What the impulses at impacts need, where it is more than the forces do; empty otherwise.
fn impacts_need(response: &Response, forces_need: f64) -> String {
    let contacts = response.validity.as_ref().map_or(&[][..], |validity| &validity.contacts);
    let needs = contacts.iter().map(|contact| contact.impulse_friction_demand.map_or(0.0, |demand| demand.value));
    let pulled: Vec<usize> =
        needs.clone().enumerate().filter(|(_, need)| need.is_infinite()).map(|(at, _)| at).collect();
    if !pulled.is_empty() {
        return format!("; at an impact {} would have to pull: blocks may part there for an instant", named(&pulled));
    }
    match needs.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((worst, need)) if need > forces_need => format!(
            "; impacts ask for up to {} at {}, below which blocks slip for an instant",
            significant(need, 3),
            named(&[worst])
        ),
        _ => String::new(),
    }
}

/// Interfaces, given from 0, by their numbers.
pub fn named(interfaces: &[usize]) -> String {
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
        Verdict::Noted(why, notes) => {
            let notes: String = notes.iter().map(|note| format!("<li>{note}</li>")).collect();
            let words =
                format!("<p><strong>The model holds, with reservations</strong>: {why}. But:</p><ul>{notes}</ul>");
            ("conditional", "?", words)
        }
        Verdict::Fails(reasons) => {
            let reasons: String = reasons.iter().map(|reason| format!("<li>{reason}</li>")).collect();
            ("fails", "!", format!("<p><strong>The model does not hold for this run</strong>:</p><ul>{reasons}</ul>"))
        }
        Verdict::Unknown(why) => {
            ("conditional", "?", format!("<p><strong>Whether the model holds is not known</strong>: {why}.</p>"))
        }
    };
    format!(
        "<div class=\"verdict {class}\"><span class=\"sign\" aria-hidden=\"true\">{sign}</span><div>{words}</div></div>\n"
    )
}

/// Largest angle that is written as zero `[rad]`: smaller ones are rounding.
const NO_ANGLE: f64 = 1e-12;

/// An extreme with its time and angle, in a cell.
fn at(value: String, extreme: Option<&Extreme>) -> String {
    match extreme {
        Some(extreme) => format!(
            "{value} <span class=\"note\">at {}&nbsp;s, θ&nbsp;=&nbsp;{}</span>",
            significant(extreme.t, 4),
            degrees(if extreme.theta.abs() < NO_ANGLE { 0.0 } else { extreme.theta })
        ),
        None => value,
    }
}

/// HTML text: friction demand and smallest normal force per interface, the top one first, with their meaning; slides or separations; warnings.
pub fn details(results: &Results) -> String {
    let response = &results.response;
    let mut text = needs_table(results);
    if let Some(validity) = &response.validity {
        text.push_str(&durations(validity));
    }
    match &response.sliding {
        Some(report) => text.push_str(&slides(results, report)),
        None => text.push_str(
            "<p>In the model blocks rock about their corners; they neither slide nor fly. The friction demand is the coefficient that an \
             interface needs so as not to slide; a normal force that falls to zero is a block about to lift off.</p>\n",
        ),
    }
    text.push_str(&fall(results));
    if response.sliding.is_none() {
        text.push_str(&separations(results));
    }
    text.push_str(&warnings(results));
    text
}

/// Table of friction demand and smallest normal force per interface, the top one first. Empty without recorded forces.
fn needs_table(results: &Results) -> String {
    let (response, column) = (&results.response, &results.column);
    let (demands, forces) = response.counted_forces();
    let contacts = response.validity.as_ref().map(|validity| &validity.contacts);
    let mut rows = String::new();
    for interface in (0..column.len().min(demands.len()).min(forces.len())).rev() {
        let weight = column.mass_above(interface) * column.gravity();
        let (demand, force) = (demands[interface], forces[interface]);
        let own = contacts.and_then(|contacts| contacts.get(interface));
        // Where friction is modelled, no demand counts as beyond the coefficient.
        let slides =
            response.sliding.is_none() && results.available_friction().is_some_and(|friction| demand > friction);
        let force = if force.abs() <= LIGHT_CONTACT * weight { 0.0 } else { force };
        let in_words = |demand: f64| if demand.is_finite() { significant(demand, 3) } else { "none is enough".into() };
        // A contact that has never been closed has neither.
        let [demand, force] = if force.is_finite() {
            let share = format!("{} ({} of the weight)", significant(force, 4), percent(force / weight));
            let demand = in_words(demand);
            [at(demand, own.map(|own| &own.friction_demand)), at(share, own.map(|own| &own.min_normal_force))]
        } else {
            ["–"; 2].map(String::from)
        };
        let own_at_impacts = own.and_then(|own| own.impulse_friction_demand.as_ref());
        let at_impacts = match (own_at_impacts, response.impulse_friction_demand.get(interface)) {
            _ if demand == "–" => "–".into(),
            (Some(own), _) if own.value == 0.0 => "0".into(),
            (Some(own), _) => at(in_words(own.value), Some(own)),
            (None, Some(demand)) => in_words(*demand),
            (None, None) => "–".into(),
        };
        let _ = writeln!(
            rows,
            "<tr{}><th scope=\"row\">{}</th><td>{demand}</td><td>{at_impacts}</td><td>{force}</td><td>{}</td></tr>",
            if slides { " class=\"beyond\"" } else { "" },
            interface + 1,
            significant(weight, 4),
        );
    }
    if rows.is_empty() {
        return rows;
    }
    let available = results.friction.as_ref().map_or("the scene names no coefficient".into(), |friction| {
        format!("the scene has {}", coefficients(friction))
    });
    format!(
        "<div class=\"wide\"><table class=\"needs\">\n<caption>Per interface, the top one first; interface 1 is under block 1, θ is the angle of the block \
         above. Friction: {available}.</caption>\n\
         <thead><tr><th scope=\"col\">interface</th><th scope=\"col\">largest friction demand |T|/N</th>\
         <th scope=\"col\">the same of impulses at impacts</th>\
         <th scope=\"col\">smallest normal force [N]</th><th scope=\"col\">weight above [N]</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

/// Up to when the contacts of a column that overturns count; empty for any other.
fn fall(results: &Results) -> String {
    let response = &results.response;
    let (Some(validity), Some(fallen), None) = (&response.validity, response.overturned_at(), &response.sliding) else {
        return String::new();
    };
    let (fallen, until) = (significant(fallen, 5), significant(validity.until, 5));
    if response.ends_below_balance(&results.column, results.options.overturn_angle) {
        return format!(
            "<p>The run ends at t = {fallen} s, where some block reaches the overturning angle of {} rad (<code>solver.overturn_angle</code>), which is less \
             than its balance. Contacts count up to t = {until} s.</p>\n",
            significant(results.options.overturn_angle, 5)
        );
    }
    format!(
        "<p>The column overturns at t = {fallen} s. Contacts count up to the point of no return, t = {until} s: from then on some block is past its \
             balance, and falls. What its contacts would need in the fall does not change the outcome.</p>\n"
    )
}

/// The warnings of the run as a list, folded where there are many; empty without warnings.
fn warnings(results: &Results) -> String {
    if results.warnings.is_empty() {
        return String::new();
    }
    let list: String =
        results.warnings.iter().map(|warning| format!("<li>{}</li>", escape(&with_minus(warning)))).collect();
    let list = format!("<ul class=\"warnings\">{list}</ul>");
    match results.warnings.len() {
        0..=WARNINGS_SHOWN => format!("<h3>Warnings of the run</h3>\n{list}\n"),
        count => format!("<details><summary>{count} warnings of the run</summary>\n{list}</details>\n"),
    }
}

/// Table of the times for which each contact needs more than the [`COEFFICIENTS`], and for which it would pull. Empty if all times are zero.
fn durations(validity: &Validity) -> String {
    let is_reported =
        |needs: &ContactNeeds| needs.tension.time > 0.0 || needs.above.iter().any(|above| above.time > 0.0);
    if !validity.contacts.iter().any(is_reported) {
        return String::new();
    }
    let cell = |time: f64, share: f64| match time {
        0.0 => "<td>0</td>".to_string(),
        time => format!("<td>{} <span class=\"note\">{}</span></td>", significant(time, 3), percent(share)),
    };
    let mut rows = String::new();
    for (interface, needs) in validity.contacts.iter().enumerate().rev() {
        let above: String = needs.above.iter().map(|above| cell(above.time, above.share)).collect();
        let tension = cell(needs.tension.time, needs.tension.share);
        let _ = writeln!(rows, "<tr><th scope=\"row\">{}</th>{above}{tension}</tr>", interface + 1);
    }
    let heads: String = COEFFICIENTS.iter().map(|level| format!("<th scope=\"col\">|T|/N &gt; {level}</th>")).collect();
    format!(
        "<div class=\"wide\"><table>\n<caption>Time in s in which an interface needs more than these coefficients of friction, or would pull, and its \
         share of the {} s that count.</caption>\n<thead><tr><th scope=\"col\">interface</th>{heads}<th scope=\"col\">N &lt; 0</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n",
        significant(validity.until, 5)
    )
}

/// Contact problems without admissible pattern, up to the point of no return if it is known.
fn separations(results: &Results) -> String {
    let until = results.response.validity.as_ref().map_or(f64::INFINITY, |validity| validity.until);
    let instants = results.response.separations.iter().map(|one| one.t);
    let instants: Vec<f64> = instants.filter(|t| *t <= until).collect();
    match instants.len() {
        0 => "<p>Separations: none.</p>\n".into(),
        count => format!(
            "<p>Separations: {count}, at {}.</p>\n",
            times(&instants).trim_start_matches(&format!("{count} instants, "))
        ),
    }
}

/// What slid and flew, per interface, with the energy balance and the instants that friction leaves open.
fn slides(results: &Results, report: &SlidingReport) -> String {
    let mut text = String::from(
        "<p>Blocks stick, slide and fly by Coulomb's law and Moreau's law of impact: where a contact sticks, |T|/N stays below its static \
         coefficient; while it slides, |T|/N is the kinetic one; where the normal force falls to zero, the blocks part.</p>\n",
    );
    if !report.is_any() {
        text.push_str("<p>In this run nothing slides or flies: it is the run without friction.</p>\n");
        return text;
    }
    let cm = |length: f64| fixed(100.0 * length, 3);
    let mut rows = String::new();
    for (interface, ContactTimes { sliding, free, .. }) in report.times.iter().enumerate().rev() {
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            interface + 1,
            cm(report.residual_slide[interface]),
            cm(report.peak_slide[interface]),
            cm(report.way_slid[interface]),
            fixed(*sliding, 3),
            report.flights[interface],
            fixed(*free, 3)
        );
    }
    let _ = write!(
        text,
        "<div class=\"wide\"><table>\n<caption>Slides per interface, the top one first; to the right is positive.</caption>\n\
         <thead><tr><th scope=\"col\">interface</th><th scope=\"col\">slide at the end [cm]</th><th scope=\"col\">largest in contact [cm]</th>\
         <th scope=\"col\">way slid [cm]</th><th scope=\"col\">time sliding [s]</th><th scope=\"col\">flights</th>\
         <th scope=\"col\">time free [s]</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    );
    if results.response.lost_block().is_some() {
        text.push_str("<p>The run ends in the fall: slides at its end are not those with which blocks stay, and count flights.</p>\n");
    }
    if report.highest_flight > 0.0 {
        let _ = writeln!(text, "<p>Largest gap of a flight: {} cm.</p>", significant(100.0 * report.highest_flight, 3));
    }
    if let Some(error) = balance(results, report) {
        let joules = |work: f64| format!("{}&nbsp;J", significant(work, 5));
        let _ = writeln!(
            text,
            "<p>Energy balance: work of the ground {}, of friction {}, lost at impacts {}; change of energy {}. \
             Relative error: {}.</p>",
            joules(report.ground_work),
            joules(report.friction_work),
            joules(report.impact_losses),
            joules(report.energy_change),
            significant(error, 2)
        );
    }
    for (name, instants) in [("Ambiguous", &report.ambiguous), ("Jammed", &report.jammed)] {
        let words = if instants.is_empty() { "none".into() } else { times(instants) };
        let _ = writeln!(text, "<p>{name}: {words}.</p>");
    }
    text
}
