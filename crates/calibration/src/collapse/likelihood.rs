//! Likelihood of an observation given a simulated course.

use std::f64::consts::PI;

use barrelstack_dynamics::math;

use super::ensemble::Course;
use super::observed::{Observed, Time};

/// Assumed differences between observations and the course of a correct simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Standard deviation (s) of a time read from a video.
    pub reading: f64,
    /// Increase of the standard deviation of a time, in seconds per second after the first loss of a seat.
    ///
    /// The longer a collapse lasts, the more its course differs from the course that any model predicts. For example,
    /// in a stack of eight barrels, a barrel that falls two seconds after the loss of a seat falls half a second
    /// earlier or later if one contact parameter changes by 10 %.
    pub growth: f64,
    /// Probability that an observed mode, first barrel or time differs from the simulated one for a reason outside the
    /// model.
    pub other: f64,
}

impl Default for Errors {
    fn default() -> Self {
        Self { reading: 0.05, growth: 0.25, other: 0.02 }
    }
}

impl Errors {
    /// Returns the log-likelihood of an observation.
    ///
    /// Let ε = `other`. An observed mode or barrel has the probability 1 − ε if it agrees with the simulated
    /// one, and ε otherwise. For a simulated time s, an observed time t has the probability density (1 − ε)
    /// N(t; s, σ²) + ε/T, where σ = reading + growth · (time since the loss of a seat) and T is the duration of
    /// the observation.
    pub(super) fn log_likelihood(&self, observed: &Observed, course: &Course) -> f64 {
        let label = |same: bool| math::log(if same { 1.0 - self.other } else { self.other });
        let mut sum = observed.mode.map_or(0.0, |mode| label(mode == course.mode));
        let first = course.first_fall();
        if let Some(barrel) = &observed.first_barrel {
            sum += label(first.is_some_and(|(name, _)| name == barrel));
        }
        if let Some(loss) = observed.loss {
            sum += self.time(observed, loss, course.loss, course.loss);
        }
        if let Some(fall) = observed.first_fall {
            let simulated = first.map_or(Time::Never, |(_, time)| Time::At(time));
            sum += self.time(observed, fall, simulated, course.loss);
        }
        for (barrel, time) in &observed.falls {
            if let Some(simulated) = course.fall(barrel) {
                sum += self.time(observed, *time, simulated, course.loss);
            }
        }
        sum
    }

    fn time(&self, observed: &Observed, time: Time, simulated: Time, loss: Time) -> f64 {
        let at_random = self.other / observed.until;
        math::log(match (time, simulated) {
            (Time::At(time), Time::At(simulated)) => {
                let since =
                    if let Time::At(loss) = loss { (simulated - loss).max(0.0) } else { 0.0 };
                let sigma = self.reading + self.growth * since;
                let off = (time - simulated) / sigma;
                let density = math::exp(-0.5 * off * off) / (sigma * (2.0 * PI).sqrt());
                (1.0 - self.other) * density + at_random
            }
            (Time::At(_), Time::Never) => at_random,
            (Time::Never, Time::At(_)) => self.other,
            (Time::Never, Time::Never) => 1.0 - self.other,
        })
    }
}
