//! The one-evaluation methods: symplectic Euler and velocity Verlet.

use super::{Drive, advance_sticks, free, place_prescribed};
use crate::forces::{Scratch, commit_corrected, evaluate, evaluate_within};
use crate::model::Model;
use crate::real::Real;
use crate::space::Space;
use crate::state::State;

/// Takes a step of symplectic Euler: `v ← v + a dt`, then `q ← q + v dt` and `s ← s + ṡ dt`, both with the new
/// velocity.
///
/// The new slip rates are known only after the evaluation, so the displacements of the tangential springs are predicted
/// with the old rates and then corrected. If they were advanced by the old rates alone, the energy of these springs
/// would grow by a factor of about 1 + ω² dt² in every step, for a tangential angular frequency ω.
pub(super) fn semi_implicit_euler<S: Space>(
    model: &Model<S>,
    drive: &impl Drive<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    until: S::Real,
) {
    let step = until - state.time;
    S::Real::scope(
        #[inline(always)]
        || {
            for i in free(model) {
                let twist = state.twists[i].plus(scratch.accelerations[i], step);
                let inertia = model.inert[i].inertia;
                (state.poses[i], state.twists[i]) = state.poses[i].coasted(inertia, twist, step);
            }
            advance_sticks(state, &scratch.slip_rates, step);
        },
    );
    std::mem::swap(&mut scratch.old_slip_rates, &mut scratch.slip_rates);
    state.time = until;
    place_prescribed(model, drive, state);
    evaluate(model, state, scratch);
    accept(model, state, scratch, step);
}

/// Takes a step of velocity Verlet: a half-kick, a drift without forces ([`Space::coast`]), and a half-kick with the
/// forces at the new position.
///
/// Forces that depend on the velocity use a velocity predicted with the old acceleration, which is corrected
/// afterwards. The displacements of the tangential springs are likewise predicted with the old slip rate and then
/// corrected. Springs that engage or release within the step act only during part of the step
/// ([`NormalForce::within_step`](crate::contact::NormalForce::within_step)). Prediction errors are of second order and
/// do not accumulate, since the corrected values are kept.
pub(super) fn velocity_verlet<S: Space>(
    model: &Model<S>,
    drive: &impl Drive<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    until: S::Real,
) {
    let step = until - state.time;
    S::Real::scope(
        #[inline(always)]
        || predict(model, state, scratch, step),
    );
    state.time = until;
    place_prescribed(model, drive, state);
    evaluate_within(model, state, step, scratch);
    S::Real::scope(
        #[inline(always)]
        || correct(model, state, scratch, step),
    );
    accept(model, state, scratch, S::Real::splat(0.5) * step);
}

/// Computes the positions at the end of the step, and predicts the velocities and the displacements of the tangential
/// springs from the old forces.
#[inline(always)]
fn predict<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &mut Scratch<S>,
    step: S::Real,
) {
    let half = S::Real::splat(0.5) * step;
    for i in free(model) {
        let kick = scratch.accelerations[i];
        let middle = state.twists[i].plus(kick, half);
        let (pose, arrived) = state.poses[i].coasted(model.inert[i].inertia, middle, step);
        state.poses[i] = pose;
        state.twists[i] = arrived.plus(kick, half);
        // Kept for the correction once the new forces are known.
        scratch.old_accelerations[i] = kick;
    }
    advance_sticks(state, &scratch.slip_rates, step);
    std::mem::swap(&mut scratch.old_slip_rates, &mut scratch.slip_rates);
}

/// Corrects the velocities: replaces the old acceleration by the new one for half of the step.
#[inline(always)]
fn correct<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>, step: S::Real) {
    let half = S::Real::splat(0.5) * step;
    for i in free(model) {
        let new = scratch.accelerations[i];
        let old = scratch.old_accelerations[i];
        state.twists[i] = state.twists[i].plus(new, half).plus(old, -half);
    }
}

/// Ends a step: corrects the displacement of every tangential spring, and accepts the state at which `scratch` was
/// evaluated. The correction is the change of the slip rate in the step, multiplied by the time `share` (s).
fn accept<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>, share: S::Real) {
    let (new, old) = (&scratch.slip_rates, &scratch.old_slip_rates);
    commit_corrected(
        model,
        state,
        scratch,
        #[inline(always)]
        |element, displacement| displacement + (new[element] - old[element]) * share,
    );
}
