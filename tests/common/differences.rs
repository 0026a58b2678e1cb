//! How far two runs of a scene are apart.

use rocking::Response;

/// Largest difference of an angle `[rad]` or a place `[m]` at the rows of two runs of a scene with friction. They have one outcome, and rows at the same
/// times.
pub fn difference(a: &Response, b: &Response) -> f64 {
    assert_eq!((a.status, a.samples.len()), (b.status, b.samples.len()));
    let rows = a.samples.iter().zip(&b.samples);
    let differences = rows.flat_map(|(a, b)| {
        assert_eq!((a.t, a.blocks.len()), (b.t, b.blocks.len()));
        let angles = a.theta.iter().zip(&b.theta).map(|(a, b)| a - b);
        let places = a.blocks.iter().zip(&b.blocks);
        angles.chain(places.flat_map(|(a, b)| [a.place[0] - b.place[0], a.place[1] - b.place[1]]))
    });
    differences.fold(0.0, |most, difference: f64| {
        assert!(difference.is_finite());
        most.max(difference.abs())
    })
}
