//! Options of pulses that are defined by formulas.

use anyhow::bail;
use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_motion::{GroundMotion, IntensityMeasure, Pulse};

use super::input::quantity;
use crate::number::{real, whole};

/// Peak and period of a pulse.
#[derive(Debug, clap::Args)]
pub(super) struct Size {
    /// Peak acceleration, velocity or displacement; the unit determines which: "0.4 g", "60 cm/s",
    /// "5 cm".
    #[arg(long, value_name = "QUANTITY")]
    peak: String,
    /// Period; for a half sine, the duration of the pulse.
    #[arg(long, value_name = "TIME")]
    period: String,
}

/// Peak, period and number of cycles of a harmonic motion.
#[derive(Debug, clap::Args)]
pub(super) struct Harmonic {
    #[command(flatten)]
    pub(super) size: Size,
    /// Number of cycles.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 10.0, allow_negative_numbers = true,
        value_parser = real("a number above 0, such as 10", |number| number > 0.0)
    )]
    pub(super) cycles: f64,
    /// Length of the ramp at each end, in cycles; without ramps, the velocity jumps at the start.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 2.0, allow_negative_numbers = true,
        value_parser = real("a number of 0 or more, such as 2", |number| number >= 0.0)
    )]
    pub(super) ramp_cycles: f64,
}

/// Peak, period and number of main cycles of a cycloid.
#[derive(Debug, clap::Args)]
pub(super) struct Repeated {
    #[command(flatten)]
    pub(super) size: Size,
    /// Number of main cycles.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(1..=1000_u32)
    )]
    pub(super) cycles: u32,
}

/// Peak, period and shape of a wavelet.
#[derive(Debug, clap::Args)]
pub(super) struct Wavelet {
    #[command(flatten)]
    pub(super) size: Size,
    /// Width of the wavelet, which determines the number of cycles.
    #[arg(
        long, value_name = "NUMBER", default_value_t = 2.0, allow_negative_numbers = true,
        value_parser = real("a number above 0, such as 2", |number| number > 0.0)
    )]
    pub(super) gamma: f64,
    /// Phase angle of the wavelet.
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", allow_hyphen_values = true)]
    phase: String,
}

impl Wavelet {
    /// Returns the phase angle (rad).
    pub(super) fn phase(&self) -> anyhow::Result<f64> {
        quantity("--phase", &self.phase, Dimension::ANGLE)
    }
}

impl Size {
    /// Scales a pulse of unit amplitude with the given period (s) to the requested peak.
    pub(super) fn motion(
        &self,
        name: &str,
        pulse: impl FnOnce(f64) -> anyhow::Result<Pulse>,
    ) -> anyhow::Result<GroundMotion> {
        let period = quantity("--period", &self.period, Dimension::TIME)?;
        let dimensions = [Dimension::ACCELERATION, Dimension::VELOCITY, Dimension::LENGTH];
        let peak = Quantity::parse_as(&self.peak, &dimensions).map_err(|error| {
            let example = Quantity::suggestion(&self.peak, &dimensions);
            anyhow::anyhow!("--peak: {error}; write for example \"{example}\"")
        })?;
        let pulse = pulse(period)?;
        let measure = match peak.dimension {
            Dimension::ACCELERATION => IntensityMeasure::Pga,
            Dimension::VELOCITY => IntensityMeasure::Pgv,
            _ => IntensityMeasure::Pgd,
        };
        if peak.value <= 0.0 {
            bail!("--peak: expected a quantity above 0, found {}", self.peak);
        }
        let unit = GroundMotion::from_pulse(name, pulse)?;
        // The provenance states the requested pulse, not the pulse of unit amplitude.
        let mut motion = unit.scaled(unit.scale_factor(measure, peak.value)?);
        motion.provenance =
            vec![format!("made by formula: {name}, period {period} s, {measure} {}", self.peak)];
        Ok(motion)
    }
}
