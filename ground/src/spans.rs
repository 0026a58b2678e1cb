//! The spans of time in which each of several motions has one formula.

use crate::piece::Piece;
use smallvec::{SmallVec, smallvec};

/// A smooth piece and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// `[s]`
    pub start: f64,
    /// `[s]`, infinite for a motion without end.
    pub end: f64,
    /// Formula of the span.
    pub piece: Piece,
}

/// The spans of a motion, in order of time, without overlap. Most motions have one.
pub type Spans = SmallVec<[Span; 1]>;

/// Break points no further apart than this share of the time, or of 1 s if that is more, count as one: the ends of two components that
/// end together may differ by rounding. A step across such a gap would be shorter than the resolution of time.
const TIME_TOLERANCE: f64 = 1e-13;

/// Calls `visit(start, end, pieces)` for each span between neighbouring break points of `motions` in `from .. to` `[s]`, in order of time.
/// `pieces[k]` is the piece of motion `k`, zero outside its spans; `visit` may move it out. The spans of each motion must be in order.
/// A finite bound is a break point too. An infinite `from` or `to` stands for the first or the last break point.
pub fn overlay(motions: &[Spans], from: f64, to: f64, mut visit: impl FnMut(f64, f64, &mut [Piece])) {
    let first = motions.iter().filter_map(|motion| motion.first()).map(|span| span.start).fold(f64::INFINITY, f64::min);
    let mut t = if from.is_finite() { from } else { first };
    let mut rests: SmallVec<[&[Span]; 4]> = motions.iter().map(SmallVec::as_slice).collect();
    let mut pieces: SmallVec<[Piece; 4]> = smallvec![Piece::Zero; motions.len()];
    while t < to {
        let now = t + TIME_TOLERANCE * t.abs().max(1.0);
        let mut end = to.is_finite().then_some(to);
        for (rest, piece) in rests.iter_mut().zip(&mut pieces) {
            while let [span, later @ ..] = *rest
                && span.end <= now
            {
                *rest = later;
            }
            let next = match *rest {
                [span, ..] if span.start <= now => {
                    *piece = span.piece.clone();
                    span.end
                }
                [span, ..] => {
                    *piece = Piece::Zero;
                    span.start
                }
                [] => {
                    *piece = Piece::Zero;
                    continue;
                }
            };
            end = Some(end.map_or(next, |end| end.min(next)));
        }
        let Some(end) = end.filter(|end| *end > now) else { return };
        visit(t, end, &mut pieces);
        t = end;
    }
}

/// As [`overlay`], for one motion and finite bounds: calls `visit(start, end, piece)`, with [`Default`] outside the spans. Spans are start, end and piece;
/// the pieces are moved, not copied.
#[inline(always)]
pub fn divide<P: Default>(
    spans: impl Iterator<Item = (f64, f64, P)>,
    from: f64,
    to: f64,
    mut visit: impl FnMut(f64, f64, P),
) {
    let same = |t: f64| t + TIME_TOLERANCE * t.abs().max(1.0);
    let (mut t, mut now) = (from, same(from));
    for (start, end, piece) in spans {
        if end <= now {
            continue;
        }
        if t >= to {
            return;
        }
        if start > now {
            let until = start.min(to);
            if until <= now {
                return;
            }
            visit(t, until, P::default());
            (t, now) = (until, same(until));
            if end <= now {
                continue;
            }
        }
        let until = end.min(to);
        if until <= now {
            return;
        }
        visit(t, until, piece);
        (t, now) = (until, same(until));
    }
    if t < to && to > now {
        visit(t, to, P::default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(bounds: &[(f64, f64, f64)]) -> Spans {
        let span = |&(start, end, value): &(f64, f64, f64)| {
            let piece = Piece::Linear { value, slope: 0.0, start: 0.0 };
            Span { start, end, piece }
        };
        bounds.iter().map(span).collect()
    }

    /// Start, end and the two values of each span.
    fn divided(motions: [&[(f64, f64, f64)]; 2], from: f64, to: f64) -> Vec<[f64; 4]> {
        let mut found = Vec::new();
        overlay(&motions.map(spans), from, to, |start, end, pieces| {
            found.push([start, end, pieces[0].value(0.0), pieces[1].value(0.0)]);
        });
        found
    }

    #[test]
    fn spans_end_where_either_motion_does() {
        let (a, b) = ([(0.5, 1.0, 1.0), (1.0, 3.0, 2.0)], [(0.0, 2.0, 5.0)]);
        let both = [[0.5, 1.0, 1.0, 5.0], [1.0, 2.0, 2.0, 5.0], [2.0, 3.0, 2.0, 0.0]];
        let from_zero = [&[[0.0, 0.5, 0.0, 5.0]][..], &both, &[[3.0, 4.0, 0.0, 0.0]]].concat();
        assert_eq!(divided([&a, &b], 0.0, 4.0), from_zero);
        assert_eq!(divided([&a, &b], 0.5, 3.0), both);
        assert_eq!(divided([&a, &b], f64::NEG_INFINITY, f64::INFINITY), from_zero[..4]);
    }

    #[test]
    fn one_motion_alone_has_the_spans_of_one_beside_none() {
        let cases: [&[(f64, f64, f64)]; 6] = [
            &[],
            &[(0.5, 1.0, 1.0), (1.0, 3.0, 2.0)],
            &[(-2.0, -1.0, 1.0), (-0.5, 0.5, 2.0), (0.7, 9.0, 3.0)],
            &[(0.0, 1e-15, 1.0), (1e-15, 1.0, 2.0), (1.0, f64::INFINITY, 4.0)],
            &[(6.0, 7.0, 1.0)],
            &[(0.5, 0.5 + 1e-14, 1.0), (0.5 + 1e-14, 2.0, 2.0), (3.0, 3.0 + 1e-14, 3.0)],
        ];
        for case in cases {
            for to in [4.0, 0.6, 1.0, 1.0 + 1e-15, 1e-15] {
                let mut found = Vec::new();
                let own = spans(case).into_iter().map(|Span { start, end, piece }| (start, end, piece));
                divide(own, 0.0, to, |start, end, piece| found.push([start, end, piece.value(0.0), 0.0]));
                assert_eq!(found, divided([case, &[]], 0.0, to), "{case:?} {to}");
            }
        }
    }

    #[test]
    fn gaps_and_motions_without_end_are_spans() {
        let (a, b) = ([(1.0, 2.0, 1.0), (3.0, f64::INFINITY, 2.0)], []);
        let spans = [[1.0, 2.0, 1.0, 0.0], [2.0, 3.0, 0.0, 0.0], [3.0, f64::INFINITY, 2.0, 0.0]];
        assert_eq!(divided([&a, &b], f64::NEG_INFINITY, f64::INFINITY), spans);
        assert_eq!(divided([&b, &b], f64::NEG_INFINITY, f64::INFINITY), [[0.0; 4]; 0]);
        assert_eq!(divided([&b, &b], 0.0, 2.0), [[0.0, 2.0, 0.0, 0.0]]);
    }

    #[test]
    fn ends_that_differ_by_rounding_are_one() {
        let (a, b) = ([(0.0, 1.0, 1.0)], [(0.0, 1.0 + 1e-15, 5.0), (1.0 + 1e-15, 2.0, 6.0)]);
        assert_eq!(divided([&a, &b], 0.0, 1.0 + 1e-14), [[0.0, 1.0, 1.0, 5.0]]);
        assert_eq!(divided([&a, &b], 0.0, 2.0), [[0.0, 1.0, 1.0, 5.0], [1.0, 2.0, 0.0, 6.0]]);
    }
}
