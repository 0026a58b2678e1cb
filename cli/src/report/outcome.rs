//! Outcome of a run: in a sentence, then key figures, peaks, impacts, time in each mode.

use crate::ending::Ending;
use crate::number::counted;
use crate::plot::modes::{called, sketch};
use crate::report::number::{degrees, percent, significant};
use crate::report::trust;
use crate::report::validity::named;
use crate::text::escape;
use rocking::column::Shape;
use rocking::pattern::Pattern;
use rocking::run_folder::Results;
use rocking::{Event, EventKind, ModeName, SlidingReport, StopReason};
use std::fmt::Write as _;

/// HTML of the outcome: the sentence with a sign, what is known of its trust, and where the blocks stayed.
pub fn sentence(results: &Results) -> String {
    let (class, words) = end_of_run(results);
    let (class, words) = trust::qualified(results, class, words);
    // Outcomes differ by the shape of their sign, not by colour alone.
    let sign = match class {
        "overturned" => "<path d=\"M6 6l12 12M18 6L6 18\"/>",
        "stands" => "<path d=\"M5 13l5 5L19 7\"/>",
        "undetermined" => "<path d=\"M8 9a4 4 0 1 1 4 4v2M12 19v.5\"/>",
        _ => "<path d=\"M4 12c3-6 5-6 8 0s5 6 8 0\"/>",
    };
    format!(
        "<p class=\"outcome {class}\"><svg viewBox=\"0 0 24 24\" aria-hidden=\"true\">{sign}</svg><span>{words}</span></p>\n{}{}",
        trust::paragraph(results),
        places(results)
    )
}

/// How the run ends: the class of the sentence, and the sentence in HTML.
fn end_of_run(results: &Results) -> (&'static str, String) {
    let response = &results.response;
    let t = significant(response.t_final, 4);
    let end = significant(results.options.t_end, 4);
    let overturn_angle = results.options.overturn_angle;
    match Ending::of(response, &results.column, overturn_angle) {
        Ending::Overturned { is_below_balance } => {
            let first = response.overturned_block.map_or(String::new(), |block| match results.column.len() {
                1 => String::new(),
                _ => format!(", block {} first", escape(&results.block_name(block - 1))),
            });
            let sentence = match is_below_balance {
                true => format!(
                    "The column <strong>reaches solver.overturn_angle</strong> = {} rad, below its balance, at t&nbsp;=&nbsp;{t}&nbsp;s{first}.",
                    significant(overturn_angle, 4)
                ),
                false => format!("The column <strong>overturns</strong> at t&nbsp;=&nbsp;{t}&nbsp;s{first}."),
            };
            ("overturned", sentence)
        }
        Ending::CertainToFall => {
            ("overturned", "The column <strong>overturns</strong>: nothing can stop it any more.".to_string())
        }
        Ending::Collapsed => {
            let who = match response.collapsed_block {
                Some(block) => format!("block {} loses its support", escape(&results.block_name(block - 1))),
                None => "a block loses its support".into(),
            };
            ("overturned", format!("The column <strong>collapses</strong> at t&nbsp;=&nbsp;{t}&nbsp;s: {who}."))
        }
        Ending::Undetermined => (
            "undetermined",
            format!(
                "The run <strong>ends without an outcome</strong> at t&nbsp;=&nbsp;{t}&nbsp;s: no motion follows from the laws of \
                 contact with friction there."
            ),
        ),
        Ending::MayBeFalling => (
            "rocking",
            format!(
                "The column has <strong>not overturned</strong> up to t&nbsp;=&nbsp;{end}&nbsp;s, where the run ends, but it is past its balance \
                 or has the energy to get there: whether it stands is open."
            ),
        ),
        Ending::GroundStillMoves => (
            "rocking",
            format!(
                "The column has <strong>not overturned</strong> up to t&nbsp;=&nbsp;{end}&nbsp;s, where the run ends; the ground still \
                 moves then, and what it does later is not known."
            ),
        ),
        Ending::NeverStarted => {
            ("stands", format!("The column <strong>stands</strong>: nothing starts it in {end}&nbsp;s."))
        }
        Ending::AtRest => {
            ("stands", format!("The column <strong>stands</strong>: it comes to rest at t&nbsp;=&nbsp;{t}&nbsp;s."))
        }
        Ending::CertainToStand => {
            ("stands", "The column <strong>stands</strong>: it has too little energy left to overturn.".to_string())
        }
        Ending::Standing { still: Some(moves) } => (
            "rocking",
            format!(
                "The column <strong>stands</strong>, but is still {moves} at the end of the run, t&nbsp;=&nbsp;{end}&nbsp;s."
            ),
        ),
        Ending::Standing { still: None } => {
            ("stands", format!("The column <strong>stands</strong> at the end of the run, t&nbsp;=&nbsp;{end}&nbsp;s."))
        }
    }
}

/// Slides below this are not worth a number `[m]`.
const SMALLEST_SLIDE: f64 = 1e-6;

/// Share of the way slid that may be lost in turns for the slide to count as one way.
const ONE_WAY_SHARE: f64 = 0.01;

/// Where the blocks stayed, and what slid and flew. Empty for a scene without friction.
fn places(results: &Results) -> String {
    let Some(report) = &results.response.sliding else { return String::new() };
    if !report.is_any() {
        return "<p>Friction holds: no block slides or flies.</p>\n".into();
    }
    let is_worth_a_number =
        |interface: usize| report.way_slid[interface] >= SMALLEST_SLIDE || report.flights[interface] > 0;
    let moved: Vec<usize> = (0..results.column.len()).filter(|&interface| is_worth_a_number(interface)).collect();
    if moved.is_empty() {
        return "<p>Friction holds but for slides below a thousandth of a millimetre.</p>\n".into();
    }
    // Slides at the start: those of the row at zero or, without one, of the column that nothing has moved; of placed blocks they are not known then.
    let first = results.response.samples.first().filter(|row| row.t == 0.0);
    let start = |interface: usize| match first.and_then(|row| row.slide.get(interface)) {
        Some(slide) => Some(*slide),
        None => results.initial.x.is_empty().then(|| results.column.slides()[interface]),
    };
    let slid = moved.iter().filter(|&&interface| report.way_slid[interface] >= SMALLEST_SLIDE);
    let way: Vec<String> = slid
        .map(|&interface| {
            let way = report.way_slid[interface];
            let turned = |start: f64| way - (report.residual_slide[interface] - start).abs();
            let turns = match (start(interface).map(turned), report.flights[interface]) {
                (Some(turned), _) if turned <= SMALLEST_SLIDE.max(ONE_WAY_SHARE * way) => "",
                (None, 0) => "",
                (Some(_), 0) => " to and fro",
                // Flights displace blocks as well.
                _ => " in all",
            };
            format!("interface {} by {}{turns}", interface + 1, length_in_words(way))
        })
        .collect();
    let mut parts = Vec::new();
    if !way.is_empty() {
        parts.push(format!("Slid: {}.", way.join(", ")));
    }
    let flights: usize = report.flights.iter().sum();
    if flights > 0 {
        let who: Vec<usize> = moved.iter().copied().filter(|&one| report.flights[one] > 0).collect();
        let times = counted(flights, ["flight", "flights"]);
        let height = match report.highest_flight {
            height if height < SMALLEST_SLIDE => String::new(),
            height => format!(", up to {} high", length_in_words(height)),
        };
        parts.push(format!("{times} at {}{height}.", named(&who)));
    }
    format!("{}<p>{}</p>\n", stayed(results, report, &moved), parts.join(" "))
}

/// Where each of the `moved` blocks stayed on the block below. Empty for a column that is lost: where it was then says nothing of where it lies.
fn stayed(results: &Results, report: &SlidingReport, moved: &[usize]) -> String {
    let response = &results.response;
    if response.status.overturns() || response.status == StopReason::Collapsed {
        return String::new();
    }
    let place = |&block: &usize| {
        let below = if block == 0 { "the ground".into() } else { format!("block {block}") };
        // Rows may end before the run does, with a flight that was to land.
        let last = response.samples.last().filter(|row| row.t >= response.t_final);
        let where_to = match last.and_then(|row| row.gap.get(block)) {
            Some(gap) if *gap > 0.0 => format!("in flight above {below}"),
            _ if block == 0 && report.residual_slide[block].abs() < SMALLEST_SLIDE => {
                format!("in its place on the ground{}", at_start(results, block))
            }
            _ => format!("{} on {below}{}", sideways(report.residual_slide[block]), at_start(results, block)),
        };
        format!("<li>block {}: {where_to}</li>", escape(&results.block_name(block)))
    };
    let all = 0..results.column.len();
    let bodies = if all.clone().all(|block| results.shape(block) == Shape::Drum) { "drums" } else { "blocks" };
    let verb = match response.status {
        StopReason::Undetermined => "stood at the end of the run",
        _ if response.slides_on => "are at the end of the run, still sliding or flying",
        // Rocking blocks may slide on.
        StopReason::AtRest if !response.cuts_ground_motion() => "stayed",
        _ => "are at the end of the run",
    };
    let which = if moved.len() < all.len() { " that slid or flew" } else { "" };
    let places: String = moved.iter().map(place).collect();
    let known = results.trust.as_ref().and_then(|trust| trust.slide_horizon).map_or(String::new(), |t| {
        format!(" (in this run: slides are known up to {} s, and companions have others at the end)", milliseconds(t))
    });
    format!("<p>Where the {bodies}{which} {verb}{known}:</p><ul class=\"plain\">{places}</ul>\n")
}

/// A slide at the start, in brackets; empty if there is none.
fn at_start(results: &Results, block: usize) -> String {
    let first = results.response.samples.first().filter(|row| row.t == 0.0);
    match first.and_then(|row| row.slide.get(block)) {
        Some(slide) if slide.abs() >= SMALLEST_SLIDE => format!(" ({} at the start)", sideways(*slide)),
        _ => String::new(),
    }
}

/// A slide, with its direction.
fn sideways(slide: f64) -> String {
    match slide {
        slide if slide.abs() < SMALLEST_SLIDE => "in the middle".into(),
        slide => format!("{} to the {}", length_in_words(slide), if slide > 0.0 { "right" } else { "left" }),
    }
}

/// A length, without its sign, in cm or, below 1 mm, in mm.
fn length_in_words(length: f64) -> String {
    let (number, unit) = match length.abs() {
        length if length < 1e-3 => (1e3 * length, "mm"),
        length => (1e2 * length, "cm"),
    };
    format!("{}&nbsp;{unit}", significant(number, 3))
}

/// The key numbers: largest angle, impacts, the mode or rest that lasts longest in all, ground acceleration.
pub fn tiles(results: &Results) -> String {
    let response = &results.response;
    let mut tiles = Vec::new();
    let largest = response.peak_theta.iter().copied().fold(0.0, f64::max);
    let (shares, leaning): (Vec<f64>, Vec<f64>) =
        response.peaks(&results.column).into_iter().partition(|share| share.is_finite());
    let largest_share = shares.iter().copied().reduce(f64::max).map(|share| format!("|θ|/α up to {}", percent(share)));
    let share = match (largest_share, leaning.is_empty()) {
        (Some(share), true) => share,
        (Some(share), false) => format!("{share} in stacks that stand by themselves"),
        (None, _) => "no stack stands by itself".into(),
    };
    tiles.push(("largest angle", degrees(largest), format!("{} rad; {share}", significant(largest, 4))));
    tiles.push(("impacts", response.impacts.to_string(), other_events(&response.events)));
    let total: f64 = response.time_in_mode.values().sum();
    if let Some((mode, time)) = response.modes_by_time().first().copied().filter(|_| total > 0.0) {
        let name = match mode {
            ModeName::Mode(label) => format!("mode {label}"),
            ModeName::Rest => called(mode, response),
        };
        tiles.push((
            "longest time in one state",
            name,
            format!("{} of {} s", percent(time / total), significant(total, 4)),
        ));
    }
    let peaks = results.peak_ground_acceleration;
    let [x, y] = peaks.map(|peak| format!("{} g", significant(peak / results.column.gravity(), 3)));
    tiles.push(match peaks {
        [0.0, 0.0] => ("ground acceleration", "none".into(), "the ground does not move".into()),
        [_, 0.0] => ("peak ground acceleration", x, "horizontal".into()),
        [0.0, _] => ("peak ground acceleration", y, "vertical".into()),
        _ => ("peak ground acceleration", x, format!("horizontal; vertical {y}")),
    });
    let tile = |(name, value, note): (&str, String, String)| {
        format!(
            "<li><span class=\"name\">{name}</span> <span class=\"value\">{value}</span> <span class=\"note\">{note}</span></li>\n"
        )
    };
    format!("<ul class=\"tiles\">\n{}</ul>\n", tiles.into_iter().map(tile).collect::<String>())
}

/// Kinds of events without impact, in singular and plural.
const OTHER_EVENTS: [(EventKind, [&str; 2]); 8] = [
    (EventKind::Start, ["start", "starts"]),
    (EventKind::Opening, ["opening", "openings"]),
    (EventKind::Jump, ["jump of the ground", "jumps of the ground"]),
    (EventKind::Slip, ["slip", "slips"]),
    (EventKind::Stick, ["end of a slip", "ends of slips"]),
    (EventKind::Flight, ["flight", "flights"]),
    (EventKind::Edge, ["corner past an edge", "corners past an edge"]),
    (EventKind::Collapsed, ["loss of support", "losses of support"]),
];

/// Numbers of the events without impact, by their kinds. With friction an event may change several contacts, of which its kind names the first.
fn other_events(events: &[Event]) -> String {
    let of_kind = |kind: EventKind| events.iter().filter(|event| event.kind == kind).count();
    let found = OTHER_EVENTS.iter().map(|(kind, nouns)| (of_kind(*kind), *nouns)).filter(|(count, _)| *count > 0);
    let found: Vec<String> = found.map(|(count, nouns)| counted(count, nouns)).collect();
    let lead = match events.iter().any(|event| event.states_after.is_some()) {
        true => "other events, by their first change: ",
        false => "besides ",
    };
    if found.is_empty() { "no other events".into() } else { format!("{lead}{}", found.join(", ")) }
}

/// Peak angles, top block first.
pub fn peaks(results: &Results) -> String {
    let column = &results.column;
    let mut rows = String::new();
    let shares = results.response.peaks(column);
    for block in (0..column.len()).rev() {
        let (peak, share) = (results.response.peak_theta[block], shares[block]);
        let slenderness = column.stack(block).slenderness();
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td class=\"share\">{}<span>{}</span></td></tr>",
            escape(&results.block_name(block)),
            significant(peak, 5),
            degrees(peak),
            significant(slenderness, 4),
            bar(share),
            if share.is_finite() { percent(share) } else { "–".into() }
        );
    }
    format!(
        "<div class=\"wide\"><table>\n<thead><tr><th scope=\"col\">block</th><th scope=\"col\">peak [rad]</th><th scope=\"col\">peak</th>\
         <th scope=\"col\">α of stack [rad]</th><th scope=\"col\">peak / α</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

/// A bar whose filled part is `share`, from 0 to 1. A larger share fills the whole bar.
fn bar(share: f64) -> String {
    format!(
        "<span class=\"bar\" aria-hidden=\"true\"><i style=\"width:{}%\"></i></span>",
        significant((share * 100.0).clamp(0.0, 100.0), 3)
    )
}

/// Interfaces, from 0, that an event names. If it names none, those whose state changed.
pub fn changed(event: &Event) -> Vec<usize> {
    let all = 0..event.after.0.len();
    match event.causes() {
        [] => all.filter(|&at| event.before.0[at] != event.after.0[at]).collect(),
        causes => all.filter(|interface| causes.contains(&(interface + 1))).collect(),
    }
}

/// Number of impacts, their interfaces, and the times of the first and the last.
pub fn impacts(results: &Results) -> String {
    let impacts: Vec<&Event> = results.response.events.iter().filter(|event| event.kind.is_impact()).collect();
    let (Some(first), Some(last)) = (impacts.first(), impacts.last()) else {
        return "<p>There is no impact in this run.</p>\n".into();
    };
    let words = match impacts.len() {
        1 => format!("One impact, at t = {} s", significant(first.t, 4)),
        count => {
            format!(
                "{count} impacts, the first at t = {} s, the last at {} s",
                significant(first.t, 4),
                significant(last.t, 4)
            )
        }
    };
    let mut at = vec![0; results.column.len()];
    impacts.iter().flat_map(|event| changed(event)).for_each(|interface| at[interface] += 1);
    let share = |interface: usize| format!("<li>interface {}: {}</li>", interface + 1, at[interface]);
    let shares: String = (0..at.len()).rev().map(share).collect();
    let counted = if at.len() > 1 {
        let several = if at.iter().sum::<usize>() > impacts.len() { ", several at once in some" } else { "" };
        format!("; interfaces that closed{several}:</p>\n<ul class=\"plain\">{shares}</ul>\n")
    } else {
        ".</p>\n".into()
    };
    format!("<p>{words}{counted}")
}

/// Number of modes that are shown at once. The other modes are folded; they are brief in most runs.
const MODES_SHOWN: usize = 8;

/// Number of modes that are drawn; a column of sixty blocks goes through thousands. `summary.json` has all.
const MODES_DRAWN: usize = 200;

/// Time in each mode, the longest first.
pub fn modes(results: &Results) -> String {
    let blocks = results.column.len();
    let total: f64 = results.response.time_in_mode.values().sum::<f64>().max(f64::MIN_POSITIVE);
    let modes = results.response.modes_by_time();
    let row = |(mode, time): &(ModeName, f64)| {
        let pattern = match mode {
            ModeName::Rest => Some(Pattern::rest(blocks)),
            ModeName::Mode(label) => label.pattern(blocks),
        };
        let (drawing, signs) = pattern
            .map_or((String::new(), String::new()), |pattern| (sketch(&results.column, &pattern), typeset(&pattern)));
        let name = called(*mode, &results.response);
        format!(
            "<li>{drawing}<span class=\"mode\"><strong>{name}</strong> <span class=\"note\">{signs}</span></span>{}\
             <span class=\"time\">{} s <span class=\"note\">{}</span></span></li>\n",
            bar(time / total),
            milliseconds(*time),
            percent(time / total)
        )
    };
    let list = |modes: &[(ModeName, f64)]| {
        format!("<ul class=\"bars\">\n{}</ul>\n", modes.iter().map(row).collect::<String>())
    };
    let (shown, others) = modes.split_at(modes.len().min(MODES_SHOWN));
    let mut text = list(shown);
    if !others.is_empty() {
        let time: f64 = others.iter().map(|(_, time)| time).sum();
        let _ = writeln!(
            text,
            "<details><summary>{} more, {} s together{}</summary>\n{}</details>",
            others.len(),
            milliseconds(time),
            if modes.len() > MODES_DRAWN {
                format!("; of these the {} longest", MODES_DRAWN - MODES_SHOWN)
            } else {
                String::new()
            },
            list(&others[..others.len().min(MODES_DRAWN - MODES_SHOWN)])
        );
    }
    text
}

/// A time to the millisecond `[s]`.
fn milliseconds(time: f64) -> String {
    if time < 0.001 { "< 0.001".into() } else { format!("{time:.3}") }
}

/// The pattern with a minus as wide as the plus.
pub fn typeset(pattern: &Pattern) -> String {
    pattern.to_string().replace('-', "\u{2212}")
}
