//! The range of the angles of a run and its companions, behind the run's own curves, from where they part.

use super::curve::{Frame, Point};
use super::drawn_run::{DrawnRun, FALL};
use super::sheet::{Anchor, Panel, Sheet, text_width};
use super::style::{self, Stroke};
use rocking::trust::{Band, Trust};

/// Columns of the band `[px]`: in each, the whole range of the times that fall into it.
const GRAIN: f64 = 1.0;

/// Darkness of the area of a block, of one.
const OPACITY: f64 = 0.16;

/// What companions say of a run whose angles are not determined to its end, with their band.
fn open<'a>(motion: &'a DrawnRun) -> Option<&'a Trust> {
    motion.results.trust.as_ref().filter(|trust| !trust.reaches_the_end() && !trust.band.is_empty())
}

/// Values of the band, up to [`FALL`] times the slenderness, for the axis of angles; none of a run whose angles are determined to its end.
pub fn values(motion: &DrawnRun) -> Vec<f64> {
    let Some(trust) = open(motion) else { return Vec::new() };
    let Band { t, low, high, .. } = &trust.band;
    let (slenderness, units) = (motion.slenderness(), motion.units());
    let rows = t.iter().zip(low.iter().zip(high)).filter(|(t, _)| **t <= motion.end);
    let both = |(low, high): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        let over = |angles: &[f64]| -> Vec<f64> {
            let drawn = angles.iter().zip(slenderness.iter().zip(&units));
            drawn.map(|(angle, (alpha, unit))| angle.clamp(-FALL * alpha, FALL * alpha) / unit).collect()
        };
        [over(low), over(high)].concat()
    };
    rows.flat_map(|(_, pair)| both(pair)).collect()
}

/// Draws the band of each block.
pub fn draw(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel) {
    let Some(trust) = open(motion) else { return };
    let frame = &panel.frame;
    for (block, unit) in motion.units().into_iter().enumerate() {
        let edges = edges(trust, block, motion.end, panel, unit);
        let inside = |[x, y]: Point| [x, y.clamp(frame.top, frame.bottom())];
        let upper = edges.iter().map(|(x, [_, top])| inside([*x, *top]));
        let lower = edges.iter().rev().map(|(x, [bottom, _])| inside([*x, *bottom]));
        let corners: Vec<Point> = upper.chain(lower).collect();
        if corners.len() > 2 {
            sheet.veil(corners, style::line(block).color, OPACITY);
        }
    }
}

/// Draws a line at the horizon with its name, where no curve runs if there is such a place.
pub fn mark_horizon(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel) {
    let Some(trust) = open(motion) else { return };
    let frame = &panel.frame;
    // Where the scene determines the angles to the end, its first six digits may not.
    let (t, words) = match trust.horizon < trust.ends_at {
        true => (trust.horizon, "angles known up to here"),
        false => (trust.input_horizon, "known up to here by six digits"),
    };
    let x = panel.place_x(t);
    sheet.line([x, frame.top], [x, frame.bottom()], &Stroke::dashed(style::INK, 1.2, &[6.0, 3.0]));
    // Left of the line, unless it begins at once.
    let width = text_width(words, style::NOTE);
    let is_room = x - frame.left > width + 12.0;
    let (at, anchor) = if is_room { (x - 6.0, Anchor::End) } else { (x + 6.0, Anchor::Start) };
    let left = if is_room { at - width } else { at };
    let size = f64::from(style::NOTE);
    let is_free = |y: &f64| sheet.is_free(&Frame { left, top: y - size, width, height: size + 4.0 });
    let (top, bottom) = (frame.top + 16.0, frame.bottom() - 8.0);
    let y = [top, bottom].into_iter().find(is_free).unwrap_or(top);
    sheet.words_on_paper([at, y], words, style::NOTE, anchor);
}

/// The range of a block's angles per column of paper: `x`, and its lower and upper end `[px]`.
fn edges(trust: &Trust, block: usize, end: f64, panel: &Panel, unit: f64) -> Vec<(f64, [f64; 2])> {
    let mut edges: Vec<(f64, [f64; 2])> = Vec::new();
    let Band { t, low, high, .. } = &trust.band;
    for (place, t) in t.iter().enumerate().filter(|(_, t)| (trust.input_horizon..=end).contains(t)) {
        let place_of = |angle: f64| panel.place([*t, angle / unit]);
        let ([x, bottom], [_, top]) = (place_of(low[place][block]), place_of(high[place][block]));
        match edges.last_mut().filter(|(last, _)| x - *last < GRAIN) {
            Some((_, range)) => *range = [range[0].max(bottom), range[1].min(top)],
            None => edges.push((x, [bottom, top])),
        }
    }
    edges
}

/// A sentence for the caption; empty for a run whose angles are determined to its end.
pub fn caption(motion: &DrawnRun) -> String {
    open(motion).map_or(String::new(), |trust| {
        format!(
            " Shaded: the range of the run and its {} companions, which differ by less than anybody can know; they agree up to t = {:.4} s.",
            trust.companions.len(),
            trust.input_horizon
        )
    })
}
