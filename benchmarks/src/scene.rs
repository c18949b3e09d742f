//! The scene of the comparison: eight barrels on four levels under a sinusoidal ground motion.

use std::f64::consts::TAU;

use barrelstack_dynamics::{Model, Planar, Scratch, State, settle};
use barrelstack_validation::drive::Shake;
use barrelstack_validation::problems::consensus;

use crate::Failure;

/// Amplitude (m) of the ground motion.
pub(crate) const AMPLITUDE: f64 = 0.1016;
/// Period (s) of the ground motion.
pub(crate) const PERIOD: f64 = 1.0748;

/// A stack at rest.
pub(crate) struct Scene {
    pub(crate) model: Model<Planar>,
    pub(crate) rest: State<Planar>,
}

impl Scene {
    /// Returns the scene on which five independent codes agree, with cradle supports at an angle
    /// (degrees) to both sides of the vertical.
    pub(crate) fn consensus(degrees: f64) -> Result<Self, Failure> {
        let model = consensus::eight_barrels(degrees)?;
        let mut rest = State::initial(&model);
        settle(&model, &mut rest, &mut Scratch::new(&model), 1e-9)?;
        Ok(Self { model, rest })
    }

    /// Returns the ground motion with its amplitude multiplied by a factor.
    pub(crate) fn ground(factor: f64) -> Shake {
        Shake::Swing { amplitude: factor * AMPLITUDE, omega: TAU / PERIOD }
    }
}
