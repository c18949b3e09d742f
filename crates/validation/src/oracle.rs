//! Independent integrator for one rocking block: Housner's equation of motion between impacts, and a given restitution
//! at impacts.
//!
//! The integrator shares no code with the contact model. It takes classical Runge–Kutta steps and finds the times of
//! uplift and impact by bisection. The problems `ode/own-integrator-…` compare its smooth motions with those of an
//! external library.

use barrelstack_dynamics::math::{cos, sin, tan};

use crate::GRAVITY;

/// A rigid rectangle that rocks about its lower corners without sliding or bouncing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rocker {
    /// Slenderness angle α (rad): the arctangent of width divided by height.
    pub alpha: f64,
    /// Frequency parameter p = √(3g/4R) (rad/s), with the half-diagonal R.
    pub rate: f64,
    /// Ratio η of the angular velocities after and before an impact.
    pub restitution: f64,
    /// `true` to use equations that are linearized for small angles.
    pub slender: bool,
}

/// Outcome of the motion of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ride {
    /// `true` if the block overturned.
    pub overturned: bool,
    /// Largest rotation (rad), limited to the angle at which the block counts as overturned.
    pub peak: f64,
}

/// Rotation (rad) beyond which a block counts as overturned. With the linearized equations of [`Rocker::slender`], this
/// rotation is 5 α instead.
pub const OVERTURNED: f64 = 1.2;

/// Angular velocity (rad/s) below which an impact brings the block to rest.
const REST: f64 = 1e-6;

impl Rocker {
    /// Returns θ'' (rad/s²) at rotation `theta` (rad) on a side (±1), under the ground acceleration `push` (as a
    /// multiple of g).
    fn spin_rate(&self, theta: f64, side: f64, push: f64) -> f64 {
        let angle = self.alpha * side - theta;
        let moment = if self.slender { angle + push } else { sin(angle) + push * cos(angle) };
        -self.rate * self.rate * moment
    }

    /// Returns the ground acceleration at uplift, as a multiple of g.
    pub fn uplift(&self) -> f64 {
        if self.slender { self.alpha } else { tan(self.alpha) }
    }

    /// Takes one Runge–Kutta step.
    ///
    /// The ground acceleration is evaluated slightly inside the ends of the step, since it may be discontinuous at the
    /// ends.
    fn step(
        &self,
        (theta, spin): (f64, f64),
        side: f64,
        (from, length): (f64, f64),
        push: &impl Fn(f64) -> f64,
    ) -> (f64, f64) {
        let inset = 1e-9 * length;
        let pushes = [push(from + inset), push(from + 0.5 * length), push(from + length - inset)];
        let rate = |theta: f64, at: usize| self.spin_rate(theta, side, pushes[at]);
        let h = length;
        let (k1, l1) = (spin, rate(theta, 0));
        let (k2, l2) = (spin + 0.5 * h * l1, rate(theta + 0.5 * h * k1, 1));
        let (k3, l3) = (spin + 0.5 * h * l2, rate(theta + 0.5 * h * k2, 1));
        let (k4, l4) = (spin + h * l3, rate(theta + h * k3, 2));
        (
            theta + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4),
            spin + h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4),
        )
    }

    /// Returns the rotation (rad) and the angular velocity (rad/s) after a time (s) of rocking on one corner.
    ///
    /// Takes equal steps from the state `start` at time zero, and assumes that the rotation stays positive.
    pub(crate) fn stretch(
        &self,
        start: (f64, f64),
        acceleration: impl Fn(f64) -> f64,
        until: f64,
        steps: u32,
    ) -> (f64, f64) {
        let push = |t: f64| acceleration(t) / GRAVITY;
        let length = until / f64::from(steps);
        (0..steps).fold(start, |at, i| self.step(at, 1.0, (f64::from(i) * length, length), &push))
    }

    /// Returns `true` if the block can no longer overturn, provided that the ground acceleration stays zero.
    fn safe(&self, theta: f64, spin: f64) -> bool {
        let left = self.alpha - theta.abs();
        let barrier = if self.slender { 0.5 * left * left } else { 1.0 - cos(left) };
        left > 0.0 && 0.5 * spin * spin < self.rate * self.rate * barrier
    }

    /// Integrates the motion of the block under a ground acceleration (m/s²) that ends by `pushed_until` (s).
    ///
    /// All steps have the same length, which is `pushed_until` divided by an integer and is at most `longest` (s). If
    /// the outcome is still open `patience` (s) after `pushed_until`, the block is judged by its rotation at that time.
    pub fn ride(
        &self,
        acceleration: impl Fn(f64) -> f64,
        pushed_until: f64,
        longest: f64,
        patience: f64,
    ) -> Ride {
        let push = |t: f64| acceleration(t) / GRAVITY;
        let length = pushed_until / (pushed_until / longest).ceil();
        let gone = if self.slender { 5.0 * self.alpha } else { OVERTURNED };
        let mut ride = Ride::default();
        let (mut theta, mut spin, mut side) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut count = 0.0;
        loop {
            let (mut from, until) = (count * length, (count + 1.0) * length);
            count += 1.0;
            // One pass for each uplift, stretch of free rocking, or impact within the step.
            for _ in 0..100 {
                if until - from < 1e-12 * length {
                    break;
                }
                if side == 0.0 {
                    let Some(start) = self.uplift_within(from, until, &push) else { break };
                    side = -push(start + 1e-9 * length).signum();
                    from = start;
                    continue;
                }
                let next = self.step((theta, spin), side, (from, until - from), &push);
                if side * next.0 >= 0.0 {
                    (theta, spin) = next;
                    break;
                }
                let (mut low, mut high) = (0.0, until - from);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let there = self.step((theta, spin), side, (from, middle), &push);
                    if side * there.0 >= 0.0 { low = middle } else { high = middle }
                }
                let there = self.step((theta, spin), side, (from, high), &push);
                (theta, spin) = (0.0, self.restitution * there.1);
                from += high;
                side = -side;
                if spin.abs() < REST {
                    (spin, side) = (0.0, 0.0);
                }
            }
            ride.peak = ride.peak.max(theta.abs());
            if theta.abs() > gone {
                ride.overturned = true;
                return ride;
            }
            if until >= pushed_until - 1e-9 * length {
                let resting = side == 0.0;
                // A block whose rotation still grows has not yet reached its peak.
                let settled = self.safe(theta, spin) && spin * theta <= 0.0;
                if resting || settled {
                    return ride;
                }
                if until > pushed_until + patience {
                    ride.overturned = theta.abs() > self.alpha;
                    return ride;
                }
            }
        }
    }

    /// Returns the time (s) within a step at which a resting block lifts off; `None` if the block stays at rest.
    fn uplift_within(&self, from: f64, until: f64, push: &impl Fn(f64) -> f64) -> Option<f64> {
        let inset = 1e-9 * (until - from);
        let lifts = |t: f64| push(t).abs() > self.uplift();
        if lifts(from + inset) {
            return Some(from);
        }
        if !lifts(until - inset) {
            return None;
        }
        let (mut low, mut high) = (from, until - inset);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if lifts(middle) { high = middle } else { low = middle }
        }
        Some(high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Shake;

    /// Returns the amplitude of the pulse at the boundary between standing and overturning, as a multiple of the ground
    /// acceleration at uplift.
    fn border(
        rocker: &Rocker,
        pulse: impl Fn(f64) -> Shake,
        (mut low, mut high): (f64, f64),
    ) -> f64 {
        let overturns = |strength: f64| {
            let shake = pulse(strength * GRAVITY * rocker.uplift());
            rocker.ride(|t| shake.acceleration(t), shake.end(), 2e-4, 30.0).overturned
        };
        let up = overturns(high);
        assert_ne!(overturns(low), up, "no border between {low} and {high}");
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            if overturns(middle) == up { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    #[test]
    fn it_shows_the_published_borders_of_the_slender_block() {
        // Zhang and Makris (2001): a slender block with η = 0.9 under one sine, ω/p = 2, 3, 5.
        let rocker = Rocker { alpha: 0.25, rate: 2.14, restitution: 0.9, slender: true };
        for (ratio, [starts, safe, again]) in [
            (2.0, [1.2252, 2.3144, 2.3499]),
            (3.0, [1.4036, 3.4847, 3.6311]),
            (5.0, [3.0186, 6.3181, 7.1681]),
        ] {
            let pulse =
                |a: f64| Shake::Sine { acceleration: a, omega: ratio * 2.14, half_waves: 2.0 };
            for (published, bracket) in [
                (starts, (0.97 * starts, 0.5 * (starts + safe))),
                (safe, (0.5 * (starts + safe), 0.5 * (safe + again))),
                (again, (0.5 * (safe + again), 1.03 * again)),
            ] {
                let found = border(&rocker, pulse, bracket);
                let error = (found / published - 1.0).abs();
                assert!(error < 2e-4, "ω/p {ratio}: {found} for {published}"); // measured 5e-5
            }
        }
    }

    #[test]
    fn it_shows_the_closed_forms_without_impact() {
        let rocker = Rocker { alpha: 0.25, rate: 2.14, restitution: 0.9, slender: true };
        for ratio in [2.0, 3.0, 5.0] {
            let half =
                |a: f64| Shake::Sine { acceleration: a, omega: ratio * 2.14, half_waves: 1.0 };
            let exact = crate::theory::half_sine_overturning(ratio);
            let found = border(&rocker, half, (0.9 * exact, 1.1 * exact));
            assert!((found / exact - 1.0).abs() < 1e-4, "{found} for {exact}"); // measured 1e-5
        }
    }
}
