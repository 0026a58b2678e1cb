//! Curves on paper `[px]`: thinned to what can be seen, cut at the frame, cut into dashes.
//!
//! Dashes are cut here and not by the SVG reader or the raster, so that both outputs show the same: the raster would start its dashes
//! anew at every point and show none.

use std::collections::HashSet;

/// `[x, y]`, y downwards on paper.
pub type Point = [f64; 2];

/// A rectangle on paper `[px]`; width and height are above zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

impl Frame {
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// Width of the columns in which [`thin_along_x`] keeps extremes `[px]`. In wider columns, sudden drops of an energy would look inclined.
const COLUMN: f64 = 0.5;

/// Thins a curve that runs to the right. In each column of half a pixel, the first, highest, lowest and last point remain, in their order.
pub fn thin_along_x(points: &[Point]) -> Vec<Point> {
    let column = |point: &Point| (point[0] / COLUMN).floor();
    let mut kept = Vec::new();
    for points in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &&(usize, &Point), b: &&(usize, &Point)| a.1[1].total_cmp(&b.1[1]);
        let numbered: Vec<(usize, &Point)> = points.iter().enumerate().collect();
        let extremes = [numbered.iter().min_by(by_height), numbered.iter().max_by(by_height)];
        let mut places = vec![0, points.len() - 1];
        places.extend(extremes.into_iter().flatten().map(|(place, _)| *place));
        places.sort_unstable();
        places.dedup();
        kept.extend(places.into_iter().map(|place| points[place]));
    }
    kept
}

/// Largest distance of an omitted point from the drawn curve `[px]`: a tenth of a pixel of the PNG.
const STRAIGHT: f64 = 0.03;

/// Number of points from one that is kept in any case to the next. Otherwise a curve that goes up and down at each point would take a time that grows with
/// the square of their number.
const POINTS_AT_ONCE: usize = 100;

/// A curve without the points that lie on a straight line between others (Douglas and Peucker 1973).
pub fn straighten(run: &[Point]) -> Vec<Point> {
    let last = run.len().saturating_sub(1);
    let mut kept: Vec<bool> = (0..run.len()).map(|place| place % POINTS_AT_ONCE == 0 || place == last).collect();
    let mut parts: Vec<(usize, usize)> =
        (0..last).step_by(POINTS_AT_ONCE).map(|from| (from, last.min(from + POINTS_AT_ONCE))).collect();
    while let Some((from, to)) = parts.pop() {
        let off = |place: usize| (place, distance(run[place], run[from], run[to]));
        let farthest = (from + 1..to).map(off).max_by(|(_, a), (_, b)| a.total_cmp(b));
        if let Some((place, _)) = farthest.filter(|(_, off)| *off > STRAIGHT) {
            kept[place] = true;
            parts.extend([(from, place), (place, to)]);
        }
    }
    run.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// Distance of a point from the segment between two others.
fn distance(point: Point, from: Point, to: Point) -> f64 {
    let (along, out) = ([to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]);
    let length = along[0] * along[0] + along[1] * along[1];
    let share = if length > 0.0 { ((out[0] * along[0] + out[1] * along[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (out[0] - share * along[0]).hypot(out[1] - share * along[1])
}

/// Side of a square of [`Ink`] `[px]`, about half of a line's width: a second line through the same square could not be seen.
const INK_SQUARE: f64 = 0.7;

/// Largest number of squares along one straight line.
const MOST_SQUARES: f64 = 10_000.0;

/// Squares that have ink: a curve has been drawn through them.
#[derive(Debug, Default)]
pub struct Ink(HashSet<[i32; 2]>);

impl Ink {
    /// Marks the squares that a curve of any shape runs through, and returns the parts of the curve in squares that had no ink: a motion that repeats itself
    /// a thousand times is drawn once.
    pub fn new_parts(&mut self, run: &[Point]) -> Vec<Vec<Point>> {
        let mut parts: Vec<Vec<Point>> = Vec::new();
        let mut joined = false;
        for ends in run.windows(2) {
            let [from, to] = [ends[0], ends[1]];
            // The bound exceeds the length of any line on the paper. Beyond the edges of the paper no square needs ink.
            let squares = ((to[0] - from[0]).hypot(to[1] - from[1]) / INK_SQUARE).ceil().min(MOST_SQUARES);
            let mut new = false;
            for square in 0..=squares as i32 {
                let share = f64::from(square) / squares.max(1.0);
                let along = |axis: usize| ((from[axis] + share * (to[axis] - from[axis])) / INK_SQUARE).floor() as i32;
                new |= self.0.insert([along(0), along(1)]);
            }
            match parts.last_mut().filter(|_| joined && new) {
                Some(part) => part.push(to),
                None if new => parts.push(vec![from, to]),
                None => {}
            }
            joined = new;
        }
        parts
    }
}

/// The parts of a curve inside a frame.
pub fn clip(run: &[Point], frame: &Frame) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let is_finite = |ends: &&[Point]| ends.iter().flatten().all(|part| part.is_finite());
    for ends in run.windows(2).filter(is_finite) {
        let Some([from, to]) = clip_segment(ends[0], ends[1], frame) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
    }
    parts
}

/// Part of a segment inside a frame, by Liang and Barsky (1984). `None` if the segment lies outside.
fn clip_segment(from: Point, to: Point, frame: &Frame) -> Option<[Point; 2]> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let sides = [
        (-along[0], from[0] - frame.left),
        (along[0], frame.right() - from[0]),
        (-along[1], from[1] - frame.top),
        (along[1], frame.bottom() - from[1]),
    ];
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (outwards, room) in sides {
        if outwards == 0.0 && room < 0.0 {
            return None;
        } else if outwards < 0.0 {
            enters = enters.max(room / outwards);
        } else if outwards > 0.0 {
            leaves = leaves.min(room / outwards);
        }
    }
    // An end inside the frame is returned unchanged, so that consecutive segments join.
    let at = |share: f64| [from[0] + share * along[0], from[1] + share * along[1]];
    let first = if enters > 0.0 { at(enters) } else { from };
    let last = if leaves < 1.0 { at(leaves) } else { to };
    (enters <= leaves).then_some([first, last])
}

/// Longest curve that is dashed `[px]`, forty times the width of a panel: a longer curve runs to and fro so densely that dashes would
/// not be seen.
const TOO_LONG_FOR_DASHES: f64 = 25_000.0;

/// Cuts a curve into dashes. `lengths`: dashes and gaps in turn, empty for a solid line. Solid and very long curves are not cut.
pub fn dash(run: &[Point], lengths: &[f64]) -> Vec<Vec<Point>> {
    let length: f64 = run.windows(2).map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])).sum();
    if lengths.is_empty() || run.is_empty() || length > TOO_LONG_FOR_DASHES {
        return vec![run.to_vec()];
    }
    let mut dashes = Vec::new();
    let mut drawn = vec![run[0]];
    let (mut turn, mut left) = (0, lengths[0]);
    for ends in run.windows(2) {
        let (mut from, to) = (ends[0], ends[1]);
        loop {
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            if length <= left {
                left -= length;
                if turn % 2 == 0 {
                    drawn.push(to);
                }
                break;
            }
            let share = left / length;
            from = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
            if turn % 2 == 0 {
                drawn.push(from);
                dashes.push(std::mem::take(&mut drawn));
            } else {
                drawn = vec![from];
            }
            turn += 1;
            left = lengths[turn % lengths.len()];
        }
    }
    if drawn.len() > 1 {
        dashes.push(drawn);
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame { left: 0.0, top: 0.0, width: 10.0, height: 10.0 };

    #[test]
    fn thinning_keeps_every_extreme_and_both_ends() {
        let points: Vec<Point> = (0..10_000).map(|i| [f64::from(i) * 1e-3, (f64::from(i) * 0.7).sin()]).collect();
        let thinned = thin_along_x(&points);
        assert!(thinned.len() <= 4 * 20, "{}", thinned.len());
        let largest = |points: &[Point]| points.iter().map(|point| point[1]).fold(f64::MIN, f64::max);
        assert_eq!(largest(&thinned), largest(&points));
        assert_eq!((thinned.first(), thinned.last()), (points.first(), points.last()));
        assert!(thinned.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }

    #[test]
    fn points_on_a_straight_line_are_left_out_and_corners_are_not() {
        let run: Vec<Point> = (0..=20).map(|i| [f64::from(i), (f64::from(i) - 10.0).abs()]).collect();
        assert_eq!(straighten(&run), [[0.0, 10.0], [10.0, 0.0], [20.0, 10.0]]);
        assert_eq!(straighten(&run[..1]), run[..1]);
        assert!(straighten(&[]).is_empty());
        let closed = [[0.0, 0.0], [5.0, 0.0], [0.0, 0.0]];
        assert_eq!(straighten(&closed), closed);
    }

    #[test]
    fn what_repeats_itself_is_drawn_once() {
        let circle = |turns: i32| -> Vec<Point> {
            let angles = (0..=100 * turns).map(|i| f64::from(i) * std::f64::consts::TAU / 100.0);
            angles.map(|angle| [50.0 + 20.0 * angle.cos(), 50.0 + 20.0 * angle.sin()]).collect()
        };
        let count = |turns: i32| Ink::default().new_parts(&circle(turns)).iter().map(Vec::len).sum::<usize>();
        assert!(count(1) > 90 && count(100) < count(1) + 10, "{} {}", count(1), count(100));
        let mut ink = Ink::default();
        assert_eq!(ink.new_parts(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]), [[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]]);
        assert_eq!(ink.new_parts(&[[0.0, 0.0], [9.0, 0.0], [15.0, 0.0]]), [[[9.0, 0.0], [15.0, 0.0]]]);
    }

    #[test]
    fn a_curve_is_cut_where_it_crosses_the_frame_and_whole_inside() {
        let run = [[-5.0, 5.0], [5.0, 5.0], [5.0, 8.0], [5.0, 20.0], [8.0, 20.0], [8.0, 5.0]];
        let parts = clip(&run, &FRAME);
        assert_eq!(parts, [vec![[0.0, 5.0], [5.0, 5.0], [5.0, 8.0], [5.0, 10.0]], vec![[8.0, 10.0], [8.0, 5.0]]]);
        assert!(clip(&[[-1.0, -1.0], [-1.0, 20.0]], &FRAME).is_empty());
    }

    #[test]
    fn dashes_go_around_corners() {
        let run = [[0.0, 0.0], [3.0, 0.0], [3.0, 5.0]];
        let dashes = dash(&run, &[4.0, 2.0]);
        assert_eq!(dashes, [vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]], vec![[3.0, 3.0], [3.0, 5.0]]]);
        assert_eq!(dash(&run, &[]), [run.to_vec()]);
    }
}
