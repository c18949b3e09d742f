//! Explicit Runge–Kutta methods: their tableaus, and one stepper for all tableaus.

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
    /// Times of the stages as fractions of the step; the first is zero.
    times: &'static [f64],
    /// For each stage from the second on, the weights of all earlier stages.
    rows: &'static [&'static [f64]],
    /// Weights of the stages in the step.
    weights: &'static [f64],
    /// Weights of the stages in the embedded result, where the rates at the new state count as one additional stage;
    /// `None` for a method without an embedded result.
    embedded: Option<&'static [f64]>,
}

/// The classical fourth-order method (Kutta 1901).
pub(super) static CLASSICAL: Tableau = Tableau {
    times: &[0.0, 0.5, 0.5, 1.0],
    rows: &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    weights: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
    embedded: None,
};

/// The third-order method with an embedded second-order result (Bogacki and Shampine 1989).
pub(super) static BOGACKI_SHAMPINE: Tableau = Tableau {
    times: &[0.0, 0.5, 0.75],
    rows: &[&[0.5], &[0.0, 0.75]],
    weights: &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0],
    embedded: Some(&[7.0 / 24.0, 0.25, 1.0 / 3.0, 0.125]),
};

/// The rates of one stage.
#[derive(Clone, Debug)]
#[expect(clippy::struct_field_names, reason = "the name that is used everywhere else")]
struct Rates<S: Space> {
    /// Linear velocity of every body, and the rate of its rotation vector ([`Space::turn_rate`]). The rotation vector
    /// describes the rotation from the start of the step to the current stage.
    velocities: Vec<Twist<S>>,
    /// Linear acceleration of every body, and the rate of its [`Space::momentum`].
    kicks: Vec<Twist<S>>,
    slip_rates: Vec<S::Tangent>,
}

/// Working memory: the rates of every stage, and the initial state of a step.
#[derive(Clone, Debug)]
pub(super) struct Stages<S: Space> {
    rates: Vec<Rates<S>>,
    poses: Vec<Pose<S>>,
    /// Linear velocity of every body and, in place of its spin, its [`Space::momentum`].
    momenta: Vec<Twist<S>>,
    sticks: Vec<Stick<S>>,
    /// Rotation vector of every body from the start of the step to the current stage.
    turned: Vec<S::Spin>,
}

impl<S: Space> Default for Stages<S> {
    fn default() -> Self {
        Self {
            rates: Vec::new(),
            poses: Vec::new(),
            momenta: Vec::new(),
            sticks: Vec::new(),
            turned: Vec::new(),
        }
    }
}

impl<S: Space> Stages<S> {
    /// Takes one step of a fixed length.
    pub(super) fn fixed(
        &mut self,
        tableau: &Tableau,
        model: &Model<S>,
        drive: &impl Drive<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
        until: S::Real,
    ) {
        self.begin(model, state, scratch);
        self.attempt(tableau, model, drive, state, scratch, until);
        accept(model, state, scratch);
    }

    /// Takes one step that is as long as the tolerance allows and does not extend beyond `until` (s).
    ///
    /// Returns the step (s) to try next. All lanes take the shortest step that any of them requires.
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
        self.begin(model, state, scratch);
        loop {
            self.attempt(tableau, model, drive, state, scratch, until);
            let dt = (until - start).largest_lane();
            let error = self.error(tableau, model, scratch, state, dt) / tolerance;
            // Steps at the lower limit are accepted: at touch-down the force of the damper jumps, and no step length
            // makes a jump smooth.
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
            self.restore(model, state, start);
        }
    }

    fn begin(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        self.poses.clone_from(&state.poses);
        self.momenta.clear();
        for (i, twist) in state.twists.iter().enumerate() {
            self.momenta.push(momentum(model, scratch, i, *twist));
        }
        self.turned.clear();
        self.turned.resize(state.poses.len(), S::Spin::default());
        self.sticks.clone_from(&state.contact_elements.sticks);
        self.rates.clear();
    }

    fn restore(&mut self, model: &Model<S>, state: &mut State<S>, time: S::Real) {
        state.time = time;
        state.poses.clone_from(&self.poses);
        for (i, twist) in state.twists.iter_mut().enumerate() {
            *twist = of_momentum(model, i, self.poses[i].orientation, self.momenta[i]);
        }
        self.turned.fill(S::Spin::default());
        state.contact_elements.sticks.clone_from(&self.sticks);
        // The first stage is the start itself and remains valid.
        self.rates.truncate(1);
    }

    /// Computes all stages and leaves `state` and `scratch` at the new state, not yet accepted.
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
            self.keep(model, state, scratch);
        }
        for (row, time) in tableau.rows.iter().zip(&tableau.times[1..]) {
            self.combine(model, state, row, dt);
            state.time = start + S::Real::splat(*time) * dt;
            place_prescribed(model, drive, state);
            evaluate(model, state, scratch);
            self.keep(model, state, scratch);
        }
        self.combine(model, state, tableau.weights, dt);
        state.time = until;
        place_prescribed(model, drive, state);
        evaluate(model, state, scratch);
    }

    fn keep(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        let mut rates = Rates {
            velocities: Vec::with_capacity(state.twists.len()),
            kicks: Vec::with_capacity(state.twists.len()),
            slip_rates: scratch.slip_rates.clone(),
        };
        for i in 0..state.twists.len() {
            let (velocity, kick) = self.rates_of(model, state, scratch, i);
            rates.velocities.push(velocity);
            rates.kicks.push(kick);
        }
        self.rates.push(rates);
    }

    /// Returns, for a body at a stage, the rates of its position and rotation, and the rates of its velocity and
    /// momentum.
    fn rates_of(
        &self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        body: usize,
    ) -> (Twist<S>, Twist<S>) {
        let Twist { linear, angular } = state.twists[body];
        let velocity = Twist { linear, angular: S::turn_rate(self.turned[body], angular) };
        (velocity, momentum(model, scratch, body, scratch.accelerations[body]))
    }

    /// Sets the state to the initial state of the step plus the weighted sum of the rates multiplied by the step `dt`
    /// (s).
    fn combine(&mut self, model: &Model<S>, state: &mut State<S>, weights: &[f64], dt: S::Real) {
        S::Real::scope(
            #[inline(always)]
            || {
                for i in free(model) {
                    let mut velocity = Twist::default();
                    let mut reached = self.momenta[i];
                    for (rates, weight) in self.rates.iter().zip(weights) {
                        let share = S::Real::splat(*weight) * dt;
                        velocity = velocity.plus(rates.velocities[i], share);
                        reached = reached.plus(rates.kicks[i], share);
                    }
                    state.poses[i] = self.poses[i].moved(velocity, S::Real::splat(1.0));
                    state.twists[i] = of_momentum(model, i, state.poses[i].orientation, reached);
                    self.turned[i] = velocity.angular;
                }
                for (element, stick) in state.contact_elements.sticks.iter_mut().enumerate() {
                    let mut displacement = self.sticks[element].displacement;
                    for (rates, weight) in self.rates.iter().zip(weights) {
                        displacement += rates.slip_rates[element] * (S::Real::splat(*weight) * dt);
                    }
                    *stick = Stick { displacement, ..self.sticks[element] };
                }
            },
        );
    }

    /// Returns the largest difference (m) between the result of a step and its embedded result; differences of
    /// velocities are multiplied by the step (s).
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
            let mut displacement = Twist::<S>::default();
            let mut kick = Twist::<S>::default();
            for (k, difference) in differences.iter().enumerate() {
                let share = S::Real::splat(difference * dt);
                let (velocity, acceleration) = if k < last {
                    (self.rates[k].velocities[i], self.rates[k].kicks[i])
                } else {
                    self.rates_of(model, state, scratch, i)
                };
                displacement = displacement.plus(velocity, share);
                kick = kick.plus(acceleration, share);
            }
            let kick = of_momentum(model, i, state.poses[i].orientation, kick);
            let size = |t: Twist<S>| {
                let linear = t.linear.dot(t.linear).sqrt();
                let angular = t.angular.dot(t.angular).sqrt() * reach;
                (linear + angular).largest_lane()
            };
            let error = size(displacement).max(size(kick) * dt);
            if error.is_nan() {
                return f64::NAN;
            }
            worst = worst.max(error);
        }
        worst
    }
}

/// Replaces the spin of a twist by its [`Space::momentum`]. The methods add momenta instead of spins, since a spin may
/// change even without a moment.
fn momentum<S: Space>(
    model: &Model<S>,
    scratch: &Scratch<S>,
    body: usize,
    twist: Twist<S>,
) -> Twist<S> {
    let (inertia, rotation) = (model.inert[body].inertia, scratch.rotations[body]);
    Twist { linear: twist.linear, angular: S::momentum(inertia, rotation, twist.angular) }
}

/// Inverse of [`momentum`]: replaces the momentum by the spin, for a body with the given orientation.
#[inline(always)]
fn of_momentum<S: Space>(
    model: &Model<S>,
    body: usize,
    orientation: S::Orientation,
    momentum: Twist<S>,
) -> Twist<S> {
    let inertia = model.inert[body].inertia;
    Twist { linear: momentum.linear, angular: S::spin_of(inertia, orientation, momentum.angular) }
}
