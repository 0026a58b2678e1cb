//! Contacts of a column at rest in sentences: what slides or opens, at which acceleration, and when.

use crate::number::significant;
use rocking::{ContactAtRest, UnderPeak};
use std::cmp::Ordering::Equal;

/// What slides or opens first at a contact with friction.
pub fn first_motion(contact: &ContactAtRest, gravity: f64) -> String {
    let interface = contact.interface;
    let [slides_at, opens_at] = [contact.slides_at.unwrap_or(f64::INFINITY), contact.opens_at];
    let [slides, opens] = [slides_at, opens_at].map(|acceleration| significant(acceleration / gravity, 4));
    if opens_at <= 0.0 {
        return format!("interface {interface} opens by itself: the stack above leans beyond its support");
    }
    let Some(at_pga) = contact.at_pga else {
        let side = if contact.is_symmetric { "" } else { ", to its weaker side," };
        let first = first_in_time(contact);
        return format!(
            "interface {interface} slides at {slides} g, and opens{side} at {opens} g; under this ground motion {first}"
        );
    };
    if slides_at < opens_at {
        let both = if at_pga == UnderPeak::Slides { "; at the PGA it slides" } else { "" };
        return format!("interface {interface} slides at {slides} g before it opens at {opens} g{both}");
    }
    let both = contact.coefficient_to_rock.map(|needed| {
        let verb = match at_pga {
            UnderPeak::Rocks => "rocks without sliding: that takes",
            UnderPeak::Slides => "slides, and rocks once it sticks: to rock without sliding takes",
            _ => "slides and rocks: to rock without sliding takes",
        };
        let [needed, own] =
            [needed, contact.coefficient.unwrap_or_default()].map(|coefficient| significant(coefficient, 4));
        format!("; at the PGA it {verb} {needed} (mu_c), and it has {own}")
    });
    format!("interface {interface} opens at {opens} g before it slides at {slides} g{}", both.unwrap_or_default())
}

/// What the ground motion does first, and when.
fn first_in_time(contact: &ContactAtRest) -> String {
    match (contact.weightless_from, contact.slides_from, contact.opens_from) {
        (Some(t), ..) => format!("it has no weight left at t = {t:.4} s, and flies"),
        (_, None, None) => "neither".into(),
        (_, Some(slides), None) => format!("it slides, at t = {slides:.4} s"),
        (_, Some(_), Some(opens)) if contact.slides_and_opens_at_once() => {
            format!("it passes both at t = {opens:.4} s")
        }
        (_, Some(slides), Some(opens)) if slides < opens => format!("it slides first, at t = {slides:.4} s"),
        (.., Some(opens)) => format!("it opens first, at t = {opens:.4} s"),
    }
}

/// The interfaces that the ground motion opens of a column at rest.
pub struct Openings<'c> {
    contacts: &'c [ContactAtRest],
    /// Those that open.
    opened: Vec<&'c ContactAtRest>,
    gravity: f64,
}

impl<'c> Openings<'c> {
    pub fn of(contacts: &'c [ContactAtRest], gravity: f64) -> Openings<'c> {
        let opened = contacts.iter().filter(|contact| contact.opens_from.is_some()).collect();
        Openings { contacts, opened, gravity }
    }

    /// Their numbers.
    pub fn interfaces(&self) -> Vec<usize> {
        self.opened.iter().map(|contact| contact.interface).collect()
    }

    /// When the first of them opens `[s]`.
    pub fn first(&self) -> Option<f64> {
        self.opened.iter().filter_map(|contact| contact.opens_from).reduce(f64::min)
    }

    fn listed(&self) -> String {
        self.interfaces().iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
    }

    /// In a sentence, where the ground moves vertically; whether horizontally as well.
    pub fn with_vertical_motion(&self, moves_horizontally: bool) -> String {
        let motion = if moves_horizontally { "with the vertical motion it" } else { "it" };
        match self.first() {
            Some(t) => format!(
                "{motion} opens interface(s) {} of the column at rest, the first at t = {t:.4} s{}",
                self.listed(),
                self.slip_before(t)
            ),
            None => format!("{motion} opens no interface of the column at rest"),
        }
    }

    /// In a sentence, where the ground moves horizontally only, with this peak acceleration `[m/s²]`.
    pub fn under_a_peak_of(&self, pga: f64, is_displaced: bool) -> String {
        let in_g = |acceleration: f64| acceleration / self.gravity;
        let lowest = self.contacts.iter().map(|contact| contact.opens_at).fold(f64::INFINITY, f64::min).max(0.0);
        let (pga, least) = (in_g(pga), in_g(lowest));
        let Some(t) = self.first() else {
            return match is_displaced {
                true if pga >= least => format!(
                    "{pga:.4} g opens no interface of the column at rest: the peak acts towards its stronger side; towards the weaker one {least:.4} g is enough"
                ),
                _ => {
                    let weaker = if is_displaced { " towards its weaker side" } else { "" };
                    format!("{pga:.4} g opens no interface of the column at rest, which takes {least:.4} g{weaker}")
                }
            };
        };
        let (interfaces, slip) = (self.listed(), self.slip_before(t));
        let at_first = self.opened.iter().filter(|contact| contact.opens_from == Some(t));
        // Of several that open at once, the one that takes least.
        let by_size = |a: &&&ContactAtRest, b: &&&ContactAtRest| a.opened_by.partial_cmp(&b.opened_by).unwrap_or(Equal);
        let weakest = at_first.min_by(by_size);
        if weakest.is_some_and(|contact| contact.opened_by <= Some(0.0)) {
            return format!(
                "interface(s) {interfaces} of the column at rest open, the first at t = {t:.4} s: a stack that leans beyond its support, which the ground does not hold then{slip}"
            );
        }
        let threshold = weakest.and_then(|contact| Some((contact, contact.opened_by?)));
        let told = threshold.map_or_else(String::new, |(contact, threshold)| {
            let side = match contact.opens_to_its_weaker_side() {
                None => "",
                Some(true) => " towards its weaker side",
                Some(false) => " towards its stronger side",
            };
            let other = match lowest < threshold * (1.0 - 1e-9) {
                true => format!("; the least that opens one, to its weaker side, is {least:.4} g"),
                false => String::new(),
            };
            format!("; the first opens at {:.4} g{side}{other}", in_g(threshold))
        });
        format!("{pga:.4} g is enough to open interface(s) {interfaces} of the column at rest{told}{slip}")
    }

    /// A clause on the interface that slides before the first opening `[s]`; empty if none does.
    fn slip_before(&self, opening: f64) -> String {
        let slips = self.contacts.iter().filter_map(|contact| Some((contact.slides_from?, contact.interface)));
        let first = slips.min_by(|(t, _), (other, _)| t.total_cmp(other));
        match first.filter(|(t, _)| *t < opening) {
            Some((t, interface)) => {
                format!("; interface {interface} slides before, at t = {t:.4} s, and may keep all of them closed")
            }
            None => String::new(),
        }
    }
}
