//! Strips: what becomes of the column over one axis of a sweep, a strip for each combination of values of the other axes.

use super::cells::{cells, legend};
use super::class::Class;
use super::family::Family;
use super::grid::share_lost;
use super::place::{GAP, NUMBERS, Place, TITLE};
use super::points::Points;
use super::scale::Scale;
use crate::number::percent;
use crate::plot::curve::Frame;
use crate::plot::paper::Paper;
use crate::plot::sheet::{Anchor, Figure, Key, LEFT, RIGHT, Sheet, shortened_settings};
use crate::plot::style;

/// Height of a strip `[px]`.
const HEIGHT: f64 = 40.0;

/// Left end of strips `[px]`: there are no numbers upwards.
const EDGE: f64 = 0.5 * LEFT;

/// The figure of all strips.
pub fn draw(points: &Points, family: &Family, paper: &Paper) -> Figure {
    let rows = family.rows(points);
    // Cells reach half way to their neighbours.
    let x = Scale::of(&family.x.key, family.x.values.clone());
    let one = Scale::strip();
    let what = format!("What becomes of the column over {}", family.along());
    let mut sheet = Sheet::new(&what, paper);
    let width = sheet.width - EDGE - RIGHT;
    let heading = if family.titles == [""] { GAP } else { TITLE };
    let mut strips: Vec<Vec<Class>> = Vec::new();
    let mut bottom = 0.0;
    for (number, title) in family.titles.iter().enumerate() {
        let frame = Frame { left: EDGE, top: heading + number as f64 * (HEIGHT + heading), width, height: HEIGHT };
        let place = Place { frame, x: &x, y: &one, top_name: "" };
        // Of several points at one position, the most violent class is drawn. Both positions rise.
        let order = |class: &Class| Class::ALL.iter().position(|own| own == class);
        let mut own = rows[number][0].iter().map(|(position, row)| (*position, points.classes[*row])).peekable();
        let mut at = |value: f64| {
            let here = std::iter::from_fn(|| own.next_if(|(position, _)| *position <= value));
            here.map(|(_, class)| class).max_by_key(order).unwrap_or(Class::Error)
        };
        let strip: Vec<Class> = x.values.iter().map(|value| at(*value)).collect();
        sheet.words(
            [frame.left, frame.top - 7.0],
            &shortened_settings(title, style::LABEL, width),
            style::LABEL,
            Anchor::Start,
        );
        cells(&mut sheet, &place, &strip);
        place.axes(&mut sheet, [number + 1 == family.titles.len(), false]);
        strips.push(strip);
        bottom = frame.bottom();
    }
    let below = [EDGE + 0.5 * width, bottom + NUMBERS + 12.0];
    sheet.words(below, &x.label(), style::LABEL, Anchor::Middle);
    let each_the_same = vec![1.0; x.values.len()];
    let mut entries = legend(&strips, &each_the_same, None);
    entries.extend(points.cut().map(|cut| (Key::None, cut)));
    sheet.height = sheet.legend(below[1] + 8.0, &entries) + 6.0;
    let share = |strip: &Vec<Class>| percent(share_lost(std::slice::from_ref(strip), &each_the_same));
    let parts: Vec<String> = family
        .titles
        .iter()
        .zip(&strips)
        .map(|(title, strip)| format!("{title} {}", share(strip)).trim_start().into())
        .collect();
    let caption = format!("{what}. Share of the points that are lost: {}.{}", parts.join(", "), points.notes());
    Figure::new("outcomes", caption, sheet)
}
