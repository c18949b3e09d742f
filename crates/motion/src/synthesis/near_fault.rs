//! A near-fault motion: a velocity pulse and a high-frequency residual.

use crate::error::MotionError;
use crate::ground_motion::GroundMotion;
use crate::history::{Delayed, History};
use crate::process::{Pads, Processing};
use crate::pulse::Pulse;
use crate::sampled::Sampled;
use crate::synthesis::BooreSource;

/// A pulse of Mavroeidis and Papageorgiou on top of a stochastic motion without its long periods,
/// after the steps of Mavroeidis and Papageorgiou (2003), with the pulse as a closed form.
#[derive(Clone, Debug, PartialEq)]
pub struct NearFault {
    /// The pulse.
    pub pulse: Pulse,
    /// Start of the pulse (s), not negative.
    pub start: f64,
    /// The source of the residual motion.
    pub rest: BooreSource,
    /// The residual is high-passed at this multiple of the pulse's frequency; 1 or slightly more.
    pub crossover: f64,
}

impl NearFault {
    /// Returns the motion with a residual of step `time_step` (s) from `seed`.
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
