//! Explicit Runge–Kutta methods as data, one stepper for all.

use super::{Drive, accept, free, place_prescribed};
use crate::contact::Stick;
use crate::forces::{Scratch, evaluate};
use crate::math::cbrt;
use crate::model::Model;
use crate::real::Real;
use crate::space::{Linear, Pose, Space, Twist};
use crate::state::State;

/// The coefficients of an explicit method.
pub(super) struct Tableau {
    /// Times of the stages as shares of the step; the first is zero.
    times: &'static [f64],
    /// How much of each earlier stage goes into a stage, row by row from the second stage.
    rows: &'static [&'static [f64]],
    /// How much of each stage goes into the step.
    weights: &'static [f64],
    /// The same for the embedded result, with the new state as one more stage.
    embedded: Option<&'static [f64]>,
}

/// The classical fourth-order method (Kutta 1901).
pub(super) static CLASSICAL: Tableau = Tableau {
    times: &[0.0, 0.5, 0.5, 1.0],
    rows: &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    weights: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    embedded: None,
};

/// Third order with an embedded second order (Bogacki and Shampine 1989).
pub(super) static BOGACKI_SHAMPINE: Tableau = Tableau {
    times: &[0.0, 0.5, 0.75],
    rows: &[&[0.5], &[0.0, 0.75]],
    weights: &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0],
    embedded: Some(&[7.0 / 24.0, 0.25, 1.0 / 3.0, 0.125]),
};

/// The rates of one stage.
#[derive(Clone, Debug)]
#[expect(clippy::struct_field_names, reason = "a slip rate is called so everywhere")]
struct Rates<S: Space> {
    twists: Vec<Twist<S>>,
    accelerations: Vec<Twist<S>>,
    slip_rates: Vec<S::Tangent>,
}

/// Working memory: the rates of every stage, and the state a step starts from.
#[derive(Debug)]
pub(super) struct Stages<S: Space> {
    rates: Vec<Rates<S>>,
    poses: Vec<Pose<S>>,
    twists: Vec<Twist<S>>,
    sticks: Vec<Stick<S>>,
}

impl<S: Space> Default for Stages<S> {
    fn default() -> Self {
        Self { rates: Vec::new(), poses: Vec::new(), twists: Vec::new(), sticks: Vec::new() }
    }
}

impl<S: Space> Stages<S> {
    /// One step of a fixed length.
    pub(super) fn fixed(
        &mut self,
        tableau: &Tableau,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: S::Real,
    ) {
        self.begin(state);
        self.attempt(tableau, model, drive, state, scratch, until);
        accept(model, state, scratch);
    }

    /// One step that is as long as the tolerance allows, and ends at `until` at the latest.
    ///
    /// Returns the step (s) to try next. Lanes share the step that the worst of them needs.
    #[expect(clippy::too_many_arguments, reason = "the method, its tolerance, and what it acts on")]
    pub(super) fn adaptive(
        &mut self,
        tableau: &Tableau,
        tolerance: f64,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: S::Real,
    ) -> S::Real {
        let start = state.time;
        let mut until = until;
        self.begin(state);
        loop {
            self.attempt(tableau, model, drive, state, scratch, until);
            let dt = (until - start).largest_lane();
            let error = self.error(tableau, model, scratch, state, dt) / tolerance;
            // A step that can hardly move the clock is accepted: at a touch-down the damper's force
            // jumps, and no step is short enough to make a jump smooth.
            let smallest = 1e-9;
            if error <= 1.0 || dt <= smallest {
                accept(model, state, scratch);
                let growth = 0.9 / cbrt(error.max(1e-6));
                return S::Real::splat(dt * growth.clamp(0.2, 4.0));
            }
            if !error.is_finite() {
                accept(model, state, scratch);
                return S::Real::splat(dt);
            }
            let shorter = (dt * (0.9 / cbrt(error)).clamp(0.1, 0.9)).max(smallest);
            until = start + S::Real::splat(shorter);
            self.restore(state, start);
        }
    }

    fn begin(&mut self, state: &State<S>) {
        self.poses.clone_from(&state.poses);
        self.twists.clone_from(&state.twists);
        self.sticks.clone_from(&state.contact_elements.sticks);
        self.rates.clear();
    }

    fn restore(&mut self, state: &mut State<S>, time: S::Real) {
        state.time = time;
        state.poses.clone_from(&self.poses);
        state.twists.clone_from(&self.twists);
        state.contact_elements.sticks.clone_from(&self.sticks);
        // The first stage is the start itself and stays.
        self.rates.truncate(1);
    }

    /// Goes through the stages and leaves `state` and `scratch` at the new state, not yet accepted.
    fn attempt(
        &mut self,
        tableau: &Tableau,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: S::Real,
    ) {
        let start = state.time;
        let dt = until - start;
        if self.rates.is_empty() {
            self.keep(state, scratch);
        }
        for (row, time) in tableau.rows.iter().zip(&tableau.times[1..]) {
            self.combine(model, state, row, dt);
            state.time = start + S::Real::splat(*time) * dt;
            place_prescribed(model, drive, state);
            evaluate(model, state, scratch);
            self.keep(state, scratch);
        }
        self.combine(model, state, tableau.weights, dt);
        state.time = until;
        place_prescribed(model, drive, state);
        evaluate(model, state, scratch);
    }

    fn keep(&mut self, state: &State<S>, scratch: &Scratch<S>) {
        self.rates.push(Rates {
            twists: state.twists.clone(),
            accelerations: scratch.accelerations.clone(),
            slip_rates: scratch.slip_rates.clone(),
        });
    }

    /// The start plus a weighted sum of the rates.
    fn combine(&self, model: &Model<S>, state: &mut State<S>, weights: &[f64], dt: S::Real) {
        for i in free(model) {
            let mut velocity = Twist::default();
            let mut twist = self.twists[i];
            for (rates, weight) in self.rates.iter().zip(weights) {
                let share = S::Real::splat(*weight) * dt;
                velocity = velocity.plus(rates.twists[i], share);
                twist = twist.plus(rates.accelerations[i], share);
            }
            state.poses[i] = self.poses[i].moved(velocity, S::Real::splat(1.0));
            state.twists[i] = twist;
        }
        for (element, stick) in state.contact_elements.sticks.iter_mut().enumerate() {
            let mut displacement = self.sticks[element].displacement;
            for (rates, weight) in self.rates.iter().zip(weights) {
                displacement += rates.slip_rates[element] * (S::Real::splat(*weight) * dt);
            }
            *stick = Stick { displacement, slipping: self.sticks[element].slipping };
        }
    }

    /// The largest difference (m) between the step and its embedded result; velocities count with
    /// the way they make in the step.
    fn error(
        &self,
        tableau: &Tableau,
        model: &Model<S>,
        scratch: &Scratch<S>,
        state: &State<S>,
        dt: f64,
    ) -> f64 {
        let Some(embedded) = tableau.embedded else { return 0.0 };
        let differences: Vec<f64> = (0..embedded.len())
            .map(|k| tableau.weights.get(k).copied().unwrap_or(0.0) - embedded[k])
            .collect();
        let last = self.rates.len();
        let mut worst = 0.0_f64;
        for i in free(model) {
            let reach = S::Real::splat(model.reach[i].max(1e-9));
            let mut way = Twist::<S>::default();
            let mut kick = Twist::<S>::default();
            for (k, difference) in differences.iter().enumerate() {
                let share = S::Real::splat(difference * dt);
                let (twist, acceleration) = if k < last {
                    (self.rates[k].twists[i], self.rates[k].accelerations[i])
                } else {
                    (state.twists[i], scratch.accelerations[i])
                };
                way = way.plus(twist, share);
                kick = kick.plus(acceleration, share);
            }
            let size = |t: Twist<S>| {
                let linear = t.linear.dot(t.linear).sqrt();
                let angular = t.angular.dot(t.angular).sqrt() * reach;
                (linear + angular).largest_lane()
            };
            let error = size(way).max(size(kick) * dt);
            if error.is_nan() {
                return f64::NAN;
            }
            worst = worst.max(error);
        }
        worst
    }
}
