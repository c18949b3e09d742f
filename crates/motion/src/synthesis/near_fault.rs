//! Near-fault motions: a velocity pulse plus a high-frequency residual.

use crate::error::MotionError;
use crate::ground_motion::GroundMotion;
use crate::history::{Delayed, History};
use crate::process::{Pads, Processing};
use crate::pulse::Pulse;
use crate::sampled::Sampled;
use crate::synthesis::BooreSource;

/// A velocity pulse added to a stochastic motion without long periods, following Mavroeidis and
/// Papageorgiou (2003). The pulse is a closed-form expression.
#[derive(Clone, Debug, PartialEq)]
pub struct NearFault {
    /// The velocity pulse.
    pub pulse: Pulse,
    /// Start of the pulse (s), not negative.
    pub start: f64,
    /// Source of the residual motion.
    pub rest: BooreSource,
    /// High-pass corner of the residual, as a multiple of the pulse frequency; 1 or slightly more.
    pub crossover: f64,
}

impl NearFault {
    /// Returns the motion. `time_step` (s) and `seed` apply to the residual.
    ///
    /// # Errors
    /// If a parameter is out of range.
    pub fn motion(&self, time_step: f64, seed: u64) -> Result<GroundMotion, MotionError> {
        self.pulse.check()?;
        MotionError::require_positive("crossover", self.crossover)?;
        let starts = self.start >= 0.0 && self.start.is_finite();
        MotionError::require(starts, "pulse start (s)", "0 or above", self.start)?;
        let corner = self.crossover / self.pulse.time_scale();
        let chain = Processing {
            taper: 0.02,
            high_pass: Some(corner),
            pads: Pads::Removed,
            close: true,
            ..Processing::none()
        };
        let drawn = self.rest.acceleration(time_step, seed)?;
        let rest = chain.apply(time_step, &drawn, 0.0)?;
        let parts = vec![
            Delayed { delay: self.start, history: History::Analytic(self.pulse) },
            Delayed {
                delay: 0.0,
                history: History::Sampled(Sampled::new(time_step, rest.acceleration)?),
            },
        ];
        let mut motion = GroundMotion::new(format!("near-fault {seed}"), History::Sum(parts), None);
        motion.provenance.push(format!("near-fault motion: {self}, seed {seed}"));
        motion.provenance.extend(rest.steps);
        Ok(motion)
    }
}
