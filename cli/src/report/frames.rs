//! Frames of the player: the state at every output time and on both sides of every event, with the ground's motion.
//!
//! A frame is a row of `response.csv`, or the column just before or just after an event. An event has two frames at one time, so that
//! the player interpolates (cubic Hermite, from angles and rates) within smooth phases only and never across an impact. Angles are
//! written to 1e-10 rad. The ground's displacement only serves the picture: the rows integrated as a record, without a drift.

use crate::number::{fixed, significant};
use crate::plot;
use crate::plot::modes::{called, fill};
use crate::report::html::script;
use crate::report::number;
use crate::report::outcome::changed;
use rocking::Event;
use rocking::column::Shape;
use rocking::pattern::Pattern;
use rocking::run_folder::Results;
use rocking::{Block, Column, EventKind, ModeName, StopReason};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Rows are thinned to so many at most, and to so many angles: a page of a few megabytes opens on a phone, one of a hundred does not.
const MOST_ROWS: usize = 20_000;
const MOST_ANGLES: usize = 100_000;

/// Of more events than this, those of an instant have one frame before and one after. Drums that come to rest in a chatter have tens of thousands.
const MOST_EVENTS: usize = 2_000;

/// Length of an instant `[s]`: no screen shows what is nearer.
const INSTANT: f64 = 1e-3;

/// Digits behind the point of an angle `[rad]`: at the time of a row, the player shows the angles of the row to 1e-9 rad.
const ANGLE_DIGITS: usize = 10;

/// Significant digits of rates, which only shape the curve between two frames.
const RATE_DIGITS: usize = 7;

/// Digits behind the point of displacements `[m]` and accelerations `[m/s²]`.
const GROUND_DIGITS: usize = 5;

/// Digits behind the point of joints `[m]`.
const JOINT_DIGITS: usize = 6;

/// Way of a drift over the range of the motion around it, below which it is only rounding.
const NO_DRIFT: f64 = 1e-3;

/// One frame.
struct Frame<'a> {
    t: f64,
    theta: &'a [f64],
    omega: &'a [f64],
    pattern: Pattern,
    /// Where each block stands on the one below; empty for a run in which nothing slides or flies.
    joints: Vec<Joint>,
    /// Ground acceleration `[m/s²]` and displacement `[m]`, `[x, y]` each.
    ground: [[f64; 2]; 2],
}

/// `[a, c, b]` `[m]`: the vector from the middle of the lower face to that of the upper one is `R(θ_{i-1}) (a, c) + R(θ_i) (b, 0)`. `(a, c)` is the
/// corner on the side given by the pattern, in contact unless the block flies; of a closed interface, the middle of the upper face. `b` is the offset
/// from `(a, c)` to this middle, along the upper face. In contact `c` is zero. Between events the three change evenly, so that the player may enlarge
/// angles without making blocks part or overlap.
type Joint = [f64; 3];

/// The joints of blocks whose centroids are given, base first.
fn joints(column: &Column, theta: &[f64], pattern: &Pattern, places: &[[f64; 2]]) -> Vec<Joint> {
    // A turn by an angle, clockwise; back with its negative.
    let turned = |angle: f64, [u, v]: [f64; 2]| {
        let (sin, cos) = angle.sin_cos();
        [u * cos + v * sin, v * cos - u * sin]
    };
    let less = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let (mut top, mut below, mut reach) = ([0.0, 0.0], 0.0, f64::INFINITY);
    let mut joints = Vec::with_capacity(places.len());
    for (((block, place), angle), state) in column.blocks().iter().zip(places).zip(theta).zip(&pattern.0) {
        let foot = less(*place, turned(*angle, [0.0, block.centroid_height]));
        let (way, side) = (less(foot, top), f64::from(state.sign()));
        let on_lower = |b: f64| turned(-below, less(way, turned(*angle, [b, 0.0])));
        let mut b = -side * block.bottom_half_width;
        let mut corner = on_lower(b);
        if side * corner[0] > reach {
            // The lower block's corner is in contact instead.
            b = turned(-angle, less(way, turned(below, [side * reach, 0.0])))[0];
            corner = on_lower(b);
        }
        joints.push([corner[0], corner[1], b]);
        top = less(*place, turned(*angle, [0.0, block.centroid_height - 2.0 * block.half_height]));
        (below, reach) = (*angle, block.top_half_width);
    }
    joints
}

/// Stride of the rows: one of this number of rows is kept.
fn stride(results: &Results) -> usize {
    results.response.samples.len().div_ceil(MOST_ROWS.min(MOST_ANGLES / results.column.len()))
}

/// The events that have their frames in common: each by itself or, of very many, those of an instant.
fn instants(events: &[Event]) -> Vec<&[Event]> {
    let length = if events.len() > MOST_EVENTS { INSTANT } else { 0.0 };
    let (mut instants, mut rest) = (Vec::new(), events);
    while let Some(first) = rest.first() {
        let within = rest.iter().take_while(|event| event.t - first.t < length).count().max(1);
        let (instant, others) = rest.split_at(within);
        instants.push(instant);
        rest = others;
    }
    instants
}

/// All frames in order of time.
fn frames<'a>(results: &'a Results, ground: &Ground) -> Vec<Frame<'a>> {
    let rows = &results.response.samples;
    let stride = stride(results);
    let instants = instants(&results.response.events);
    let mut frames = Vec::with_capacity(rows.len() / stride + 2 * instants.len() + 1);
    let mut instants = instants.into_iter().peekable();
    let last = rows.len() - 1;
    for (index, row) in rows.iter().enumerate() {
        while let Some(instant) = instants.next_if(|instant| instant[0].t <= row.t) {
            frames.extend(sides(&results.column, instant, |t| ground.at(results, index, t)));
        }
        // A row at the time of an event or within an instant is left out: events give the frames before and after.
        let is_reported = frames.last().is_some_and(|frame| frame.t >= row.t);
        if !is_reported && (index % stride == 0 || index == last) {
            let at = ground.at(results, index, row.t);
            let places: Vec<[f64; 2]> = row.blocks.iter().map(|block| block.place).collect();
            frames.push(Frame {
                t: row.t,
                theta: &row.theta,
                omega: &row.omega,
                pattern: row.pattern.clone(),
                joints: joints(&results.column, &row.theta, &row.pattern, &places),
                ground: at,
            });
        }
    }
    // Overturning ends the rows. Events after the last row still belong to the run.
    for instant in instants {
        frames.extend(sides(&results.column, instant, |t| ground.at(results, last, t)));
    }
    frames
}

/// The frames just before the first event of an instant and just after its last one; `ground` gives the ground's motion at a time.
fn sides<'a>(
    column: &Column,
    instant: &'a [Event],
    ground: impl Fn(f64) -> [[f64; 2]; 2],
) -> impl Iterator<Item = Frame<'a>> {
    let side = |event: &'a Event, pattern: &Pattern, omega: &'a [f64]| {
        let places: Vec<[f64; 2]> = event.blocks.iter().map(|block| block.place).collect();
        Frame {
            t: event.t,
            theta: &event.theta,
            omega,
            pattern: pattern.clone(),
            joints: joints(column, &event.theta, pattern, &places),
            ground: ground(event.t),
        }
    };
    let before = instant.first().map(|event| side(event, &event.before, &event.omega_before));
    let after = instant.last().map(|event| side(event, &event.after, &event.omega_after));
    before.into_iter().chain(after)
}

/// Displacement of the ground at the rows, for display.
struct Ground {
    /// `[m]`, `[x, y]` per row.
    displacement: Vec<[f64; 2]>,
    /// Constant velocity taken out, `[x, y]` `[m/s]`.
    drift: [f64; 2],
}

impl Ground {
    /// Integrates the accelerations of the rows twice from rest, without the drift.
    fn new(results: &Results) -> Ground {
        let rows = &results.response.samples;
        let times: Vec<f64> = rows.iter().map(|row| row.t).collect();
        let (mut displacement, mut drift) = (vec![[0.0; 2]; rows.len()], [0.0; 2]);
        for axis in 0..2 {
            let accelerations: Vec<f64> = rows.iter().map(|row| row.ground[axis]).collect();
            let is_pulse = is_pulse(&results.excitation[["horizontal", "vertical"][axis]]);
            let (own, own_drift) = displaced(&times, &accelerations, is_pulse);
            drift[axis] = own_drift;
            // Accelerations read from a folder may be too large to integrate.
            if !own.iter().all(|d| d.is_finite()) {
                continue;
            }
            for ((t, place), d) in times.iter().zip(&mut displacement).zip(own) {
                place[axis] = d - drift[axis] * (t - times[0]);
            }
        }
        Ground { displacement, drift }
    }

    /// Acceleration and displacement at `t`, linear between the row `index` and the one before it.
    fn at(&self, results: &Results, index: usize, t: f64) -> [[f64; 2]; 2] {
        let rows = &results.response.samples;
        let before = index.saturating_sub(1);
        let dt = rows[index].t - rows[before].t;
        let share = if dt > 0.0 { ((t - rows[before].t) / dt).clamp(0.0, 1.0) } else { 1.0 };
        let between = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]));
        [between(rows[before].ground, rows[index].ground), between(self.displacement[before], self.displacement[index])]
    }
}

/// Displacement at these times `[m]`, and the constant velocity that is to be taken out `[m/s]`. A pulse keeps it, wherever the run ends: the ground would
/// otherwise begin with a motion against the push.
fn displaced(times: &[f64], accelerations: &[f64], is_pulse: bool) -> (Vec<f64>, f64) {
    let displacement = integrated(times, accelerations, is_pulse);
    let drift = if is_pulse { 0.0 } else { drift_of(times, &displacement) };
    (displacement, drift)
}

/// Whether a ground motion is a pulse, or a sum of pulses: its velocity at the end is no drift of a record.
fn is_pulse(motion: &Value) -> bool {
    match (motion["kind"].as_str(), motion["terms"].as_array()) {
        (Some("sum"), Some(terms)) => terms.iter().all(is_pulse),
        (kind, _) => !matches!(kind, Some("record" | "synthetic" | "harmonic" | "sum")),
    }
}

/// Displacement at these times `[m]` from accelerations `[m/s²]`, linear between them, from rest. If a pulse comes to its end, and the velocity then is no
/// more than the error that jumps of the acceleration cause between two rows, it ends at rest.
fn integrated(times: &[f64], accelerations: &[f64], is_pulse: bool) -> Vec<f64> {
    let last = times.len() - 1;
    if accelerations.iter().all(|a| *a == 0.0) {
        return vec![0.0; times.len()];
    }
    let moves_until = accelerations.iter().rposition(|a| *a != 0.0).map_or(0, |place| (place + 1).min(last));
    let pairs = || times.windows(2).zip(accelerations.windows(2));
    let [left, error] = pairs().fold([0.0, 0.0f64], |[velocity, error], (t, a)| {
        let h = t[1] - t[0];
        [velocity + 0.5 * h * (a[0] + a[1]), error.max(h * (a[1] - a[0]).abs())]
    });
    let span = times[moves_until] - times[0];
    let excess = if is_pulse && moves_until < last && left.abs() <= error { left / span } else { 0.0 };
    let (mut displacement, mut velocity) = (vec![0.0; times.len()], 0.0);
    for (place, (t, a)) in pairs().enumerate() {
        let h = t[1] - t[0];
        let [a, b] = [0, 1].map(|side: usize| a[side] - if place < moves_until { excess } else { 0.0 });
        displacement[place + 1] = displacement[place] + h * (velocity + h * (2.0 * a + b) / 6.0);
        velocity = if excess != 0.0 && place + 1 >= moves_until { 0.0 } else { velocity + 0.5 * h * (a + b) };
    }
    displacement
}

/// The mean velocity of the second half of the time `[m/s]`, if it is a drift: the base line of a record, or a harmonic motion that starts from rest, carries
/// the ground away. Zero otherwise.
fn drift_of(times: &[f64], displacement: &[f64]) -> f64 {
    let (first, last) = (times[0], times[times.len() - 1]);
    let half = times.partition_point(|t| *t < 0.5 * (first + last));
    // A single row has no mean velocity.
    let mean = (displacement[displacement.len() - 1] - displacement[half]) / (last - times[half]);
    let around = times.iter().zip(displacement).map(|(t, d)| d - mean * (t - first));
    let [low, high] = around.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], d| [low.min(d), high.max(d)]);
    let is_drift = mean.is_finite() && mean.abs() * (last - first) > NO_DRIFT * (high - low);
    if is_drift { mean } else { 0.0 }
}

/// The JSON that the player reads; `player/state.js` lists its keys.
pub fn json(results: &Results) -> String {
    let ground = Ground::new(results);
    let frames = frames(results, &ground);
    let (patterns, states) = distinct_patterns(&frames);
    let head = head(results, &patterns).to_string();
    // Numbers of lists are rounded text, of which `json!` knows nothing: lists are written after its keys.
    let mut text = head.strip_suffix('}').unwrap_or(&head).to_string();
    for (key, values) in [("pattern", list(states))].into_iter().chain(channels(results, &frames)) {
        let _ = write!(text, ",\n\"{key}\":{values}");
    }
    text.push('}');
    script(&text)
}

/// The different patterns of the frames, and for each frame the index of its pattern, as text.
fn distinct_patterns<'f>(frames: &'f [Frame]) -> (Vec<&'f Pattern>, Vec<String>) {
    let mut patterns: Vec<&Pattern> = Vec::new();
    let mut index_of = |pattern: &'f Pattern| {
        patterns.iter().position(|known| *known == pattern).unwrap_or_else(|| {
            patterns.push(pattern);
            patterns.len() - 1
        })
    };
    let indices = frames.iter().map(|frame| index_of(&frame.pattern).to_string()).collect();
    (patterns, indices)
}

/// What does not change from frame to frame: the column, the patterns, and the events.
fn head(results: &Results, patterns: &[&Pattern]) -> serde_json::Value {
    let column = &results.column;
    let contact = |interface: usize| {
        let ([left, right], slide) = (column.contact(interface), column.slides()[interface]);
        let centre = 0.5 * (left + right);
        [column.contact_half_width(interface), centre, centre - slide]
    };
    let contact: Vec<[f64; 3]> = (0..column.len()).map(contact).collect();
    let size = |block: &Block| [block.bottom_half_width, block.top_half_width, block.half_height];
    let sizes: Vec<[f64; 3]> = column.blocks().iter().map(size).collect();
    let round: Vec<bool> = (0..column.len()).map(|block| results.shape(block) == Shape::Drum).collect();
    let pattern = |pattern: &&Pattern| {
        let mode = pattern.mode();
        json!({
            "signs": pattern.signs(),
            "text": pattern.to_string(),
            "mode": mode.map(|(label, _)| label.to_string()),
            "mirrored": mode.is_some_and(|(_, mirrored)| mirrored),
            "link": pattern.linkage().link_of_block(),
        })
    };
    let patterns: Vec<_> = patterns.iter().map(pattern).collect();
    let fills: Vec<&str> = (0..=column.len()).map(fill).collect();
    // The player's status line names each event.
    let event = |event: &Event| {
        let Event { t, kind, mode, mirrored, .. } = event;
        json!({ "t": t, "kind": kind, "at": interfaces(event), "mode": mode, "mirrored": mirrored })
    };
    let events: Vec<_> = results.response.events.iter().map(event).collect();
    json!({
        "blocks": sizes, "round": round, "contact": contact, "gravity": column.gravity(), "fills": fills,
        "patterns": patterns, "rest": called(ModeName::Rest, &results.response), "events": events, "angles": largest_shown(results),
    })
}

/// A JSON list of numbers, given as text.
fn list(numbers: Vec<String>) -> String {
    format!("[{}]", numbers.join(","))
}

/// The lists of numbers over the frames, as JSON: times, angles, rates, joints, and acceleration and displacement of the ground.
fn channels(results: &Results, frames: &[Frame]) -> [(&'static str, String); 8] {
    let blocks = 0..results.column.len();
    let over_frames = |number: &dyn Fn(&Frame) -> String| list(frames.iter().map(number).collect());
    let per_block = |number: &dyn Fn(&Frame, usize) -> String| {
        list(blocks.clone().map(|block| over_frames(&|frame| number(frame, block))).collect())
    };
    // Either all frames of a run have joints, or none has.
    let has_joints = frames.iter().all(|frame| frame.joints.len() == results.column.len());
    let part = |block: usize, part: usize| over_frames(&|frame| fixed(frame.joints[block][part], JOINT_DIGITS));
    let of_block = |block: usize| list((0..3).map(|index| part(block, index)).collect());
    let joints = if has_joints { list(blocks.clone().map(of_block).collect()) } else { "null".into() };
    let ground = |quantity: usize, axis: usize| match results.peak_ground_acceleration[axis] > 0.0 {
        true => over_frames(&|frame| fixed(frame.ground[quantity][axis], GROUND_DIGITS)),
        false => "null".into(),
    };
    [
        // `{:?}` is the shortest text that reads back to the same bits.
        ("t", over_frames(&|frame| format!("{:?}", frame.t))),
        ("theta", per_block(&|frame, block| fixed(frame.theta[block], ANGLE_DIGITS))),
        ("omega", per_block(&|frame, block| significant(frame.omega[block], RATE_DIGITS))),
        ("joints", joints),
        ("ax", ground(0, 0)),
        ("ay", ground(0, 1)),
        ("dx", ground(1, 0)),
        ("dy", ground(1, 1)),
    ]
}

/// The largest angle that the player's curves show `[rad]`, as in the figures. `None` if the column does not overturn: all angles are shown.
fn largest_shown(results: &Results) -> Option<f64> {
    let column = &results.column;
    let shown = |interface: usize| plot::fall_angle(column.stack(interface).slenderness());
    (results.response.status == StopReason::Overturned).then(|| (0..column.len()).map(shown).fold(0.0, f64::max))
}

/// Interfaces, from 0, at which an event happens: at a start, an opening or a jump those whose state changed, at other events those that the event names.
fn interfaces(event: &Event) -> Vec<usize> {
    match event.kind {
        // Patterns are compared, because a jump names no interface. A slip changes no pattern, and is in the last arm.
        EventKind::Start | EventKind::Opening | EventKind::Jump => (0..event.after.0.len())
            .filter(|&interface| event.before.0[interface] != event.after.0[interface])
            .collect(),
        _ => changed(event),
    }
}

/// HTML notes below the player: how ground motion, slides and a long run are shown.
pub fn notes(results: &Results) -> String {
    let mut notes = Vec::new();
    if results.peak_ground_acceleration != [0.0; 2] {
        let Ground { drift, .. } = Ground::new(results);
        let name = |axis: usize| ["horizontal", "vertical"][axis];
        let taken: Vec<String> = (0..2)
            .filter(|&axis| drift[axis] != 0.0)
            .map(|axis| format!("{} m/s {}", number::significant(drift[axis], 3), name(axis)))
            .collect();
        notes.push(if taken.is_empty() {
            "The ground's displacement is its acceleration, integrated twice over the output rows.".to_string()
        } else {
            format!(
                "The ground's displacement is its acceleration, integrated twice over the output rows, and shown without drift: \
                 a constant velocity of {} is taken out.",
                taken.join(" and ")
            )
        });
    }
    if results.response.motion_at_contacts().is_some() {
        notes.push("Blocks are drawn where they have slid or flown to, at true size whatever the angles; a block that slides has the colour of the one below.".into());
    }
    let stride = stride(results);
    if stride > 1 {
        notes.push(format!("The picture is drawn from one row in {stride} of response.csv, and from the events."));
    }
    if results.response.events.len() > MOST_EVENTS {
        notes.push("The run has very many events: those within a millisecond are drawn as one. The line below the picture names each.".into());
    }
    notes.iter().map(|note| format!("<p class=\"note\">{note}</p>\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Displacement and drift of an acceleration at rows every hundredth of a second.
    fn of(end: f64, is_pulse: bool, acceleration: impl Fn(f64) -> f64) -> (Vec<f64>, f64) {
        let times: Vec<f64> = (0..=(100.0 * end).round() as usize).map(|place| 0.01 * place as f64).collect();
        let accelerations: Vec<f64> = times.iter().map(|t| acceleration(*t)).collect();
        displaced(&times, &accelerations, is_pulse)
    }

    #[test]
    fn of_very_many_events_those_of_an_instant_are_one() {
        let event = |t: f64| -> Event {
            let list = |text: &str| serde_json::from_str::<Value>(text).expect("JSON");
            let fields = json!({ "t": t, "kind": "impact", "before": [1], "after": [-1], "mode_before": "1.1", "mode": "1.1", "mirrored": true,
                "theta": [0.0], "omega_before": [-0.1], "omega_after": [-0.09], "energy_lost": 0.1, "interfaces": [1], "impulses": list("[]") });
            serde_json::from_value(fields).expect("an event")
        };
        let at = |times: &[f64]| times.iter().map(|t| event(*t)).collect::<Vec<Event>>();
        let few = at(&[0.5, 0.5, 0.5004]);
        assert_eq!(instants(&few).len(), 3);
        let times: Vec<f64> = (0..=MOST_EVENTS).map(|place| 1.0 + 0.3 * INSTANT * place as f64).collect();
        let many = at(&times);
        let instants = instants(&many);
        assert!(instants.iter().rev().skip(1).all(|instant| instant.len() == 4), "{}", instants[0].len());
        assert_eq!(instants.iter().map(|instant| instant.len()).sum::<usize>(), many.len());
        assert!(instants.windows(2).all(|pair| pair[1][0].t - pair[0][0].t >= INSTANT));
    }

    #[test]
    fn drift_is_what_carries_the_ground_away() {
        // A pulse that ends at rest, cut in its middle and followed to its end: displaced by A T² / 2π.
        let sine = |t: f64| if t < 1.0 { (TAU * t).sin() } else { 0.0 };
        assert_eq!([0.7, 0.9, 0.95, 1.0, 9.0].map(|end| of(end, true, sine).1), [0.0; 5]);
        let displaced = of(9.0, true, sine).0[900];
        assert!((displaced - 1.0 / TAU).abs() < 1e-4, "{displaced}");
        // A cosine jumps at its ends: what rows make of the jumps is no velocity.
        let cosine = |t: f64| if t < 1.0 { (TAU * t).cos() } else { 0.0 };
        let (displacement, drift) = of(9.0, true, cosine);
        assert!(drift == 0.0 && displacement[900].abs() < 1e-2, "{drift} {}", displacement[900]);
        // From rest a harmonic motion goes on with A / Ω on average.
        let (_, drift) = of(9.0, false, |t| (TAU * t).sin());
        assert!((drift - 1.0 / TAU).abs() < 0.02, "{drift}");
        // The base line of a record is off by 0.02 m/s² for 10 s: from 6 to 12 s the ground goes from 0.36 to 1.40 m. The wave before, and the jump between rows, add less than 2 mm.
        let record = |t: f64| if t < 10.0 { (TAU * t).sin() * (-(t - 4.0) * (t - 4.0)).exp() + 0.02 } else { 0.0 };
        let (displacement, drift) = of(12.0, false, record);
        assert!((drift - 1.04 / 6.0).abs() < 2e-3, "{drift}");
        assert!((displacement[1200] - 1.40).abs() < 2e-3, "{}", displacement[1200]);
    }
}
