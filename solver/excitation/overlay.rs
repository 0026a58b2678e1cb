//! Pieces of several motions side by side: the spans of time in which each of them has one formula.

use super::piece::Piece;

/// A smooth piece and its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// `[s]`
    pub start: f64,
    /// `[s]`, infinite for what goes on for ever.
    pub end: f64,
    /// What holds in it.
    pub piece: Piece,
}

/// Break points closer than this, relative to the time, are one: the sum of start and period of two components that end
/// together rounds differently. A step across such a gap would be shorter than the resolution of time.
const SAME_TIME: f64 = 1e-13;

/// Calls `visit(start, end, pieces)` for each span between break points of `motions` in `from .. to` `[s]`, in order of time, with the
/// piece of each motion there. Finite bounds are break points as well; between infinite ones there are spans from the first to the
/// last break point of the motions.
pub fn overlay(motions: &[Vec<Span>], from: f64, to: f64, mut visit: impl FnMut(f64, f64, &[Piece])) {
    let inside = |t: &f64| *t > from && *t < to;
    let mut breaks: Vec<f64> =
        motions.iter().flatten().flat_map(|span| [span.start, span.end]).filter(inside).collect();
    breaks.extend([from, to].iter().filter(|t| t.is_finite()));
    if motions.iter().flatten().any(|span| span.end >= to) && to.is_infinite() {
        breaks.push(to);
    }
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|later, kept| later.is_finite() && *later - *kept <= SAME_TIME * later.abs().max(1.0));

    let mut cursors = vec![0; motions.len()];
    let mut pieces = vec![Piece::Zero; motions.len()];
    for pair in breaks.windows(2) {
        let inner = if pair[1].is_finite() { 0.5 * (pair[0] + pair[1]) } else { pair[0] + 1.0 };
        for ((motion, cursor), piece) in motions.iter().zip(&mut cursors).zip(&mut pieces) {
            while motion.get(*cursor).is_some_and(|span| span.end <= inner) {
                *cursor += 1;
            }
            let found = motion.get(*cursor).filter(|span| span.start <= inner);
            *piece = found.map_or(Piece::Zero, |span| span.piece.clone());
        }
        visit(pair[0], pair[1], &pieces);
    }
}
