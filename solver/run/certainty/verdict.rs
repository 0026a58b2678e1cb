//! Whether a proof of the outcome holds at the state of a run.

use super::falls::Fall;
use super::stands::OutcomeBounds;
use crate::column::Column;
use crate::mechanics::kinematics::{Posture, rotations};
use crate::numerics::per_block::{PerBlock, for_size};
use crate::run::problem::Problem;
use crate::run::segment_time::SegmentTime;
use crate::run::state::State;
use crate::scene::Scene;
use rocking_codegen::pattern::Pattern;

/// Least share of the barrier that must be missing from the energy. Roundings are far less, and runs that pass closer to the top take many seconds
/// over it.
const LEAST_MISSING_SHARE: f64 = 1e-6;

/// Share of energy that a run may have gained by the errors of some hundred steps, as a multiple of the relative tolerance of a step.
const ENERGY_DRIFT_TOLERANCES: f64 = 1e3;

/// Largest share of the barrier that must be missing, however loose the tolerance. The proof holds for the motion from the present state on,
/// whatever the tolerance; the share allows for the errors of the steps that the proof spares the run. Without this bound a whole barrier would have
/// to be missing at a tolerance of 1e-3: nothing could be proved, and spectra would take five times as long as at 1e-4.
const MOST_MISSING_SHARE: f64 = 0.1;

/// Time over which pushes of the ground are summed, as a multiple of the time to overturn on a ground at rest.
const LOOKAHEAD_FACTOR: f64 = 1.5;

/// Relative margin by which a proof must hold.
fn slack(problem: &Problem) -> f64 {
    (ENERGY_DRIFT_TOLERANCES * problem.scene.options.rtol).clamp(LEAST_MISSING_SHARE, MOST_MISSING_SHARE)
}

/// Whether the column is certain to stand. With the angles and rates that `state` gives, it is in the box of its barrier, and the ground motion to
/// come brings less energy than it takes to leave the box.
pub(crate) fn stands(
    problem: &Problem,
    now: SegmentTime,
    pattern: &Pattern,
    state: impl FnOnce() -> (PerBlock<f64>, PerBlock<f64>),
) -> bool {
    let Some(outcome_bounds) = problem.outcome_bounds.filter(|_| problem.may_stand) else { return false };
    let Some(impulse) = problem.ground.impulse_from(now.segment, now.t, outcome_bounds.impulse) else { return false };
    let (theta, omega) = state();
    if outcome_bounds.barrier.is_left(&theta) {
        return false;
    }
    let energy = above_rest(outcome_bounds, &problem.scene.column, pattern, &theta, &omega);
    outcome_bounds.stays(energy, impulse, slack(problem))
}

/// Energy of a column above that at rest `[J]`.
fn above_rest(bounds: &OutcomeBounds, column: &Column, pattern: &Pattern, theta: &[f64], omega: &[f64]) -> f64 {
    for_size!(column.len(), size => {
        let own = rotations(size, theta);
        let posture = Posture::of(size, column, &pattern.0, &own);
        let kinetic = posture.kinetic_energy(&posture.linear(&posture.link_rates(omega)), omega);
        kinetic + bounds.potential(&own)
    })
}

/// Whether a column in this state, at the end of a run, is past its balance or, on a ground that rests from then on, has the energy to get there.
pub(crate) fn may_overturn(scene: &Scene, state: &State) -> bool {
    let bounds = OutcomeBounds::of(scene);
    let has_energy = || {
        let energy = above_rest(&bounds, &scene.column, &state.pattern, &state.theta, &state.omega);
        !scene.excitation.moves_after(scene.options.t_end) && bounds.barrier.is_within_reach(energy)
    };
    bounds.barrier.is_left(&state.theta) || has_energy()
}

/// Whether one block, leaning to a side at an angle and a rate `[θ, θ̇]`, is certain to overturn before the run ends.
pub(crate) fn falls(fall: &Fall, problem: &Problem, now: SegmentTime, x: [f64; 2], sign: f64) -> bool {
    let SegmentTime { t, segment } = now;
    let Some(excess) = fall.excess(x, sign, slack(problem)) else { return false };
    let has_fallen_by = |end: f64, push: f64| fall.latest(excess, push).is_some_and(|latest| t + latest < end);
    if has_fallen_by(problem.scene.options.t_end, problem.ground.push_from(sign, segment, t)) {
        return true;
    }
    // Ground motion after the block has overturned does not matter.
    let soon = fall.latest(excess, 0.0).map_or(f64::INFINITY, |latest| t + LOOKAHEAD_FACTOR * latest);
    let end = problem.ground[segment].end;
    soon < end && has_fallen_by(soon, problem.ground.push_in(sign, segment, [t, soon]))
}
