//! Error that an elastic friction spring causes when the slip reverses.
//!
//! A contact with Coulomb friction sticks by means of an elastic tangential spring. When the slip reverses, the
//! friction force therefore changes its sign gradually, over twice the yield displacement of the spring, which delays
//! every reversal by √(4 yield / acceleration). For a block on oscillating ground, this delay increased or decreased
//! the slip by a relative amount of 0.3 to 2.7 times √(yield / amplitude) (`crates/dynamics/tests/reversal.rs`). The
//! relative error is therefore reported as √(yield / amplitude).

use std::fmt;

use barrelstack_dynamics::{FrictionLaw, Interface, Planar, Scratch};
use barrelstack_motion::GroundMotion;

use crate::assemble::Assembly;

/// Relative error of slip above which the error is reported.
const REPORTED: f64 = 0.05;

/// An interface whose friction springs are too soft for the ground motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SoftStick {
    interface: String,
    /// Tangential displacement (m) at which the friction springs of the interface yield under the normal forces at
    /// rest: the sum of their friction limits, divided by the sum of their stiffnesses.
    yields: f64,
    /// Peak displacement of the ground (m).
    swing: f64,
    /// Relative error of slip.
    error: f64,
}

impl SoftStick {
    /// Returns the interfaces of a stack at rest whose friction springs cause a relative error of slip above
    /// [`REPORTED`] under a ground motion; none without a motion.
    pub(crate) fn of(
        assembly: &Assembly,
        rest: &Scratch<Planar>,
        motion: Option<&GroundMotion>,
    ) -> Vec<Self> {
        let Some(swing) = motion.map(GroundMotion::pgd) else { return Vec::new() };
        let model = &assembly.model;
        let mut sums = vec![(0.0, 0.0); model.interfaces().len()];
        for pressed in rest.pressed.iter().filter(|pressed| pressed.touching) {
            let interface = model.pair(pressed.pair).interface;
            let friction = &model.interfaces()[interface].friction;
            if let FrictionLaw::Coulomb { static_coefficient, .. } = *friction {
                sums[interface].0 += static_coefficient * pressed.normal_force;
                sums[interface].1 += friction.stick_stiffness() * pressed.weight;
            }
        }
        let soft = |(interface, (limit, stiffness)): (&Interface<Planar>, (f64, f64))| {
            let yields = limit / stiffness;
            let error = (yields / swing).sqrt();
            let interface = interface.name.clone();
            (error > REPORTED).then_some(Self { interface, yields, swing, error })
        };
        model.interfaces().iter().zip(sums).filter_map(soft).collect()
    }

    /// Returns `true` if a slip (m) exceeds the elastic range of the friction springs.
    pub(crate) fn shows_in(&self, slip: f64) -> bool {
        slip > 2.0 * self.yields
    }
}

impl fmt::Display for SoftStick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: a contact slips only after its friction spring has stretched by {:.2} mm, so if the ground moves \
             back and forth by {:.0} mm, the slip may differ by {:.0} % from the slip with rigid friction; a \
             friction.tangential_stiffness_ratio {:.0} times as large reduces this error to {:.0} %",
            self.interface,
            1e3 * self.yields,
            1e3 * self.swing,
            100.0 * self.error,
            ((self.error / REPORTED) * (self.error / REPORTED)).ceil(),
            100.0 * REPORTED
        )
    }
}
