//! Contact forces over time: normal force over the weight above, and the friction that each interface asks for.

use super::axis::{Axis, brief, span};
use super::curve::Point;
use super::drawn_run::DrawnRun;
use super::sheet::{Anchor, Figure, Key, Panel, Sheet};
use super::style::{self, Stroke};
use super::time_history::{mark_ending, time_axis};
use crate::number::coefficients;
use rocking::Friction;
use rocking::validity::LIGHT_CONTACT;

/// Heights `[px]`.
const NORMAL: f64 = 190.0;
const FRICTION: f64 = 230.0;
const GAP: f64 = 16.0;

/// Largest upper end of the axis of friction demand, or a third above the scene's coefficient if that is larger. No real contact
/// has more friction, and peaks just before a contact parts would flatten the rest.
const LARGEST_DEMAND: f64 = 2.0;
/// Normal forces beyond this multiple of the weight do not extend their axis: a column that falls hits hard.
const LARGEST_NORMAL: f64 = 5.0;

/// Lines of the scene's friction coefficients.
const AVAILABLE: Stroke = Stroke::dashed(style::INK, 1.8, &[10.0, 5.0]);

/// Curves of one interface over time. Friction demand has gaps where nothing presses.
struct Contact {
    normal: Vec<Point>,
    demand: Vec<Vec<Point>>,
}

/// The figure.
pub fn draw(motion: &DrawnRun) -> Figure {
    let contacts = contacts(motion);
    let response = &motion.results.response;
    let mut sheet = Sheet::new("Normal forces and friction demand of the interfaces over time", &motion.paper);
    let entries: Vec<(Key, String)> = (0..contacts.len())
        .map(|interface| (Key::Line(style::line(interface)), format!("interface {}", interface + 1)))
        .collect();
    let top = sheet.legend(0.0, &entries) + 4.0;

    let normals = contacts.iter().flat_map(|contact| &contact.normal).map(|point| point[1]);
    let normals = normals.map(|normal| normal.clamp(-1.0, LARGEST_NORMAL)).chain([0.0, 1.0]);
    let label = "Normal force N/W";
    let normal = sheet.panel(top, NORMAL, time_axis(motion).unnumbered(), Axis::around(label, normals, 3));
    sheet.level(&normal, 0.0, &Stroke::solid(style::GREY, 0.8));
    sheet.level(&normal, 1.0, &style::REFERENCE);
    for (interface, contact) in contacts.iter().enumerate() {
        sheet.history(&normal, &contact.normal, &style::line(interface));
    }
    mark_ending(&mut sheet, motion, &normal, Anchor::Start);

    let [_, needed] = span(response.counted_forces().0.into_iter().chain(demands(&contacts)));
    let available = available(motion);
    let largest = available.last().copied();
    let most = LARGEST_DEMAND.max(largest.map_or(0.0, |friction| friction * 4.0 / 3.0));
    let least = largest.unwrap_or(0.05) * 1.15;
    let axis = Axis::over("Friction demand |T|/N", [0.0, (needed * 1.08).clamp(least.min(most), most)], 4);
    let friction = sheet.panel(normal.frame.bottom() + GAP, FRICTION, time_axis(motion), axis);
    // These lines are drawn first, below the curves, so that a peak that reaches one is seen.
    available.iter().for_each(|coefficient| sheet.level(&friction, *coefficient, &AVAILABLE));
    for (interface, contact) in contacts.iter().enumerate() {
        sheet.interrupted_history(&friction, &contact.demand, &style::line(interface));
    }
    let below = sheet.label_below(&friction);
    sheet.height = largest_demands(&mut sheet, motion, &friction, below) + 8.0;
    Figure::new("forces", caption(motion, &contacts, &friction), sheet)
}

/// The scene's different coefficients of friction, static and kinetic, the smallest first.
fn available(motion: &DrawnRun) -> Vec<f64> {
    let friction = motion.results.friction.iter();
    let mut coefficients: Vec<f64> = friction.flat_map(|one| one.fixed.iter().chain(&one.kinetic)).copied().collect();
    coefficients.sort_by(f64::total_cmp);
    coefficients.dedup();
    coefficients
}

fn contacts(motion: &DrawnRun) -> Vec<Contact> {
    let column = &motion.results.column;
    let weights: Vec<f64> =
        (0..column.len()).map(|interface| column.mass_above(interface) * column.gravity()).collect();
    let empty = || Contact { normal: Vec::new(), demand: vec![Vec::new()] };
    let mut contacts: Vec<Contact> = weights.iter().map(|_| empty()).collect();
    let until = counted_until(motion).unwrap_or(f64::INFINITY);
    // The first row after the end, if it is there, holds the column as it was at the end, fallen.
    let end = motion.results.response.t_final;
    let upright = motion.samples.iter().filter(|sample| !motion.overturned() || sample.t < end);
    for sample in upright {
        for ((contact, force), weight) in contacts.iter_mut().zip(sample.contact_forces(column)).zip(&weights) {
            contact.normal.push([sample.t, force.normal / weight]);
            if sample.t > until {
                continue;
            }
            if force.normal > LIGHT_CONTACT * weight {
                let demand = force.tangential.abs() / force.normal;
                contact.demand.last_mut().expect("there is a first").push([sample.t, demand]);
            } else {
                contact.demand.push(Vec::new());
            }
        }
    }
    contacts.iter_mut().for_each(|contact| contact.demand.retain(|run| !run.is_empty()));
    contacts
}

/// Point of no return, up to which friction demand counts `[s]`. `None` if the column does not overturn, or no validity was recorded.
fn counted_until(motion: &DrawnRun) -> Option<f64> {
    motion.results.response.validity.as_ref().filter(|_| motion.overturned()).map(|validity| validity.until)
}

fn demands(contacts: &[Contact]) -> impl Iterator<Item = f64> {
    contacts.iter().flat_map(|contact| &contact.demand).flatten().map(|point| point[1])
}

/// Marks of the largest friction demands at the right edge of a panel, and a legend with their numbers below. Demands between output
/// times count as well. Returns the lower end of the legend `[px]`.
fn largest_demands(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel, top: f64) -> f64 {
    let response = &motion.results.response;
    // The coefficients are named below the panel. A name along the line of a coefficient would lie on the curves.
    let mut entries: Vec<_> =
        motion.results.friction.iter().map(|friction| (Key::Line(AVAILABLE), named(friction))).collect();
    let (largest, least) = response.counted_forces();
    if !largest.is_empty() {
        let which = if counted_until(motion).is_some() { "up to the point of no return" } else { "of the whole run" };
        entries.push((Key::None, format!("Largest friction demand {which} (◂):")));
    }
    for (interface, (demand, normal)) in largest.iter().zip(&least).enumerate() {
        let what = match (normal.is_finite(), demand.is_finite()) {
            (true, true) => brief(*demand),
            (true, false) => "no friction is enough".into(),
            (false, _) if counted_until(motion) == Some(0.0) => "–".into(),
            (false, _) => "never closed".into(),
        };
        entries.push((Key::Line(style::line(interface)), format!("interface {}: {what}", interface + 1)));
        if normal.is_finite() && panel.reaches(*demand) {
            let [x, y] = [panel.frame.right() + 2.0, panel.place([0.0, *demand])[1]];
            sheet.areas(vec![vec![[x, y], [x + 11.0, y - 5.0], [x + 11.0, y + 5.0]]], style::line(interface).color);
        }
    }
    if entries.is_empty() { top } else { sheet.legend(top, &entries) }
}

/// Coefficients of friction with their name.
fn named(friction: &Friction) -> String {
    let is_one = friction.fixed.len() == 1 && friction.kinetic == friction.fixed;
    format!("friction coefficient{} {}", if is_one { "" } else { "s" }, coefficients(friction))
}

fn caption(motion: &DrawnRun, contacts: &[Contact], panel: &Panel) -> String {
    let mut caption = String::from(
        "At output times: normal force of each interface over the weight above it (dashed: 1), and below the friction \
         coefficient it asks for",
    );
    let response = &motion.results.response;
    match &motion.results.friction {
        Some(friction) if response.motion_at_contacts().is_some() => {
            caption.push_str(&format!("; contacts slide where it reaches theirs, dashed ({}).", named(friction)));
        }
        Some(friction) => caption.push_str(&format!("; the scene has {} (dashed).", coefficients(friction))),
        None => caption.push_str("; the scene names no friction coefficient."),
    }
    let beyond = demands(contacts).chain(response.counted_forces().0.into_iter().filter(|demand| demand.is_finite()));
    if beyond.into_iter().any(|demand| !panel.reaches(demand)) {
        caption.push_str(" Larger demands leave the panel.");
    }
    if counted_until(motion).is_some() {
        caption.push_str(" Friction demand is shown up to the point of no return.");
    }
    let until = counted_until(motion).unwrap_or(f64::INFINITY);
    let has_gaps = |contact: &Contact| {
        let rows = contact.normal.iter().take_while(|point| point[0] <= until).count();
        contact.demand.iter().map(Vec::len).sum::<usize>() < rows
    };
    if contacts.iter().any(has_gaps) {
        caption.push_str(match &response.sliding {
            Some(_) => " Gaps: nothing presses there, the blocks are apart.",
            None => " Gaps: nothing presses there, and no friction is enough.",
        });
    }
    caption
}
