//! The time of the next event, estimated from the second derivatives at the start of a step. A step far beyond it would need a series of higher order for
//! a part that is thrown away. The step's guards, not this estimate, locate the event.

/// Ratio of a step to the time of the expected event. If it were smaller, the event would fall into the next step more
/// often; if larger, the step would take more orders.
const STEP_OVER_EXPECTED_TIME: f64 = 1.25;

/// Least share of the suggested step to which an expected event shortens a step. Zero, and a step could be too short to advance the time.
const LEAST_SHARE_OF_SUGGESTED_STEP: f64 = 1e-6;

/// Length of a step that ends soon after an event expected at `time` `[s]`, where the method suggests a step of length `suggested` `[s]`.
pub fn longest_step(time: f64, suggested: f64) -> f64 {
    (STEP_OVER_EXPECTED_TIME * time).max(LEAST_SHARE_OF_SUGGESTED_STEP * suggested)
}

/// Time at which a gap of this value, rate and constant acceleration closes `[s]`; infinite if it does not close. A gap that is zero has just opened.
pub fn closing([value, rate, acceleration]: [f64; 3]) -> f64 {
    // The first root of a parabola, in the form without cancellation; not a number if there is none.
    let root = (rate * rate - 2.0 * acceleration * value).sqrt();
    let time = if rate > 0.0 { (rate + root) / -acceleration } else { 2.0 * value / (root - rate) };
    if time > 0.0 { time } else { f64::INFINITY }
}

/// Time at which a slide of this rate and constant acceleration stops `[s]`; infinite if it does not stop.
pub fn stop([rate, acceleration]: [f64; 2]) -> f64 {
    let time = -rate / acceleration;
    if time > 0.0 { time } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parabolas with integer coefficients and roots: exact in doubles.
    #[test]
    fn times_are_the_first_ones_after_the_start() {
        // 2 t - 4 t²/2 falls back at 1, 3 + 2 t - 2 t²/2 at 3, 3 - 4 t + 2 t²/2 comes down at 1 before it rises, 3 - 2 t - 2 t²/2 at 1.
        let hops =
            [([0.0, 2.0, -4.0], 1.0), ([3.0, 2.0, -2.0], 3.0), ([3.0, -4.0, 2.0], 1.0), ([3.0, -2.0, -2.0], 1.0)];
        for (gap, time) in hops {
            assert_eq!(closing(gap), time, "{gap:?}");
        }
        // Opens ever faster, turns back above zero, rests, is critical.
        for gap in [[0.0, 1.0, 1.0], [3.0, -2.0, 2.0], [3.0, 0.0, 0.0], [0.0, 0.0, 0.0]] {
            assert_eq!(closing(gap), f64::INFINITY, "{gap:?}");
        }
        assert_eq!([stop([3.0, -2.0]), stop([-3.0, 2.0])], [1.5; 2]);
        assert_eq!([stop([3.0, 2.0]), stop([0.0, 2.0]), stop([0.0, 0.0]), stop([3.0, 0.0])], [f64::INFINITY; 4]);
    }

    #[test]
    fn a_step_passes_the_event_and_advances() {
        assert_eq!(longest_step(f64::INFINITY, 0.1), f64::INFINITY);
        assert!(longest_step(0.01, 0.1) > 0.01 && longest_step(0.01, 0.1) < 0.02);
        assert!(longest_step(1e-300, 0.1) > 1e-8);
    }
}
