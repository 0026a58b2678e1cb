//! Band of angles: the range of the angles of a run and its companions, behind the curves of the run. The band starts where the runs part.

use super::curve::Point;
use super::drawn_run::DrawnRun;
use super::sheet::{Anchor, Panel, Sheet, patch};
use super::style::{self, Stroke};
use rocking::trust::{Band, Trust};

/// Smallest width of the columns of the band `[px]`. Each column has the whole range of angles at the times within it.
const GRAIN: f64 = 1.0;

/// Opacity of the band of one block, from 0 to 1.
const OPACITY: f64 = 0.16;

/// Trust of a run whose angles are not determined to its end. `None` for any other run, or if no band was recorded.
fn open<'a>(motion: &'a DrawnRun) -> Option<&'a Trust> {
    motion.results.trust.as_ref().filter(|trust| !trust.reaches_the_end() && !trust.band.is_empty())
}

/// Angles of the band in the unit of the axis, cut at those of [`DrawnRun::fall_angles`]. Empty if the run has no band to draw.
pub fn values(motion: &DrawnRun) -> Vec<f64> {
    let Some(trust) = open(motion) else { return Vec::new() };
    let Band { t, low, high, .. } = &trust.band;
    let (fall_angles, units) = (motion.fall_angles(), motion.units());
    let rows = t.iter().zip(low.iter().zip(high)).filter(|(t, _)| **t <= motion.end);
    let both = |(low, high): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        let over = |angles: &[f64]| -> Vec<f64> {
            let drawn = angles.iter().zip(fall_angles.iter().zip(&units));
            drawn.map(|(angle, (most, unit))| angle.clamp(-most, *most) / unit).collect()
        };
        [over(low), over(high)].concat()
    };
    rows.flat_map(|(_, pair)| both(pair)).collect()
}

/// Shades the range of each block's angle.
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

/// Draws a line at the horizon of the angles.
pub fn mark_horizon(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel) {
    let Some(trust) = open(motion) else { return };
    // If the exact inputs determine the angles to the end, the line marks how far the first six digits of the inputs do.
    let (t, words) = match trust.horizon < trust.ends_at {
        true => (trust.horizon, "known up to here, if inputs were exact"),
        false => (trust.input_horizon, "known up to here by six digits"),
    };
    mark(sheet, panel, t, words);
}

/// Draws a line at the horizon of the slides, if companions have others at the end of the run.
pub fn mark_slide_horizon(sheet: &mut Sheet, motion: &DrawnRun, panel: &Panel) {
    let horizon = motion.results.trust.as_ref().and_then(|trust| trust.slide_horizon);
    if let Some(t) = horizon.filter(|t| *t < motion.end) {
        mark(sheet, panel, t, KNOWN);
    }
}

/// What the line at a horizon says, in short.
const KNOWN: &str = "known up to here";

/// Number of heights at which the words beside a horizon are tried.
const HEIGHTS: u8 = 12;

/// Draws a line at a horizon `t` `[s]`, with words in a free place beside the line. Where there is no free place the words have no white ground: what a
/// curve shows must not be hidden.
fn mark(sheet: &mut Sheet, panel: &Panel, t: f64, words: &'static str) {
    let (x, frame) = (panel.place_x(t), &panel.frame);
    sheet.line([x, frame.top], [x, frame.bottom()], &Stroke::dashed(style::INK, 1.2, &[6.0, 3.0]));
    // Left of the line, or right: at the top, at the bottom, or between. Where there is no room for all words, the first ones say the same.
    let (top, bottom) = (frame.top + 16.0, frame.bottom() - 8.0);
    let between = (1..HEIGHTS).map(|step| top + (bottom - top) * f64::from(step) / f64::from(HEIGHTS));
    let heights: Vec<f64> = [top, bottom].into_iter().chain(between).collect();
    let sides = [(x - 6.0, Anchor::End), (x + 6.0, Anchor::Start)];
    let beside = |words: &'static str| {
        let heights = &heights;
        sides.into_iter().flat_map(move |(at, anchor)| heights.iter().map(move |y| ([at, *y], words, anchor)))
    };
    let patch_of = |(at, words, anchor): &(Point, &str, Anchor)| patch(*at, words, style::NOTE, *anchor);
    let fits = |place: &(Point, &str, Anchor)| {
        let patch = patch_of(place);
        patch.left >= frame.left && patch.right() <= frame.right()
    };
    let places: Vec<_> = [words, KNOWN].into_iter().flat_map(beside).filter(fits).collect();
    match places.iter().find(|place| sheet.is_free(&patch_of(place))) {
        Some((at, words, anchor)) => sheet.words_on_paper(*at, words, style::NOTE, *anchor),
        None => {
            let usual = places.first().copied().unwrap_or(([x, top], KNOWN, Anchor::Middle));
            sheet.words(usual.0, usual.1, style::NOTE, usual.2);
        }
    }
}

/// Range of a block's angles in each column of the band, up to the time `end`: `x`, and the lower and upper end of the range `[px]`.
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
