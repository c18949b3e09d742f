//! Pulses of a formula as they are asked for on the command line.

use anyhow::bail;
use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_motion::{GroundMotion, IntensityMeasure, Pulse};

use super::input::quantity;

/// Size and period of a pulse.
#[derive(Debug, clap::Args)]
pub(super) struct Size {
    /// Peak of the acceleration, velocity or displacement, told apart by the unit: "0.4 g",
    /// "60 cm/s", "5 cm".
    #[arg(long, value_name = "QUANTITY")]
    peak: String,
    /// Period; of a half sine or a rectangle its length.
    #[arg(long, value_name = "TIME")]
    period: String,
}

/// Size, period and number of cycles.
#[derive(Debug, clap::Args)]
pub(super) struct Cycles {
    #[command(flatten)]
    size: Size,
    /// Number of cycles.
    #[arg(long, value_name = "NUMBER", default_value_t = 10.0)]
    cycles: f64,
    /// Length of the ramps at both ends in cycles; without a ramp the velocity jumps at the start.
    #[arg(long, value_name = "NUMBER", default_value_t = 2.0)]
    ramp_cycles: f64,
}

/// Size, period and main cycles of a cycloid.
#[derive(Debug, clap::Args)]
pub(super) struct MainCycles {
    #[command(flatten)]
    size: Size,
    /// Number of main cycles.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    cycles: u32,
}

/// Size, period and shape of a wavelet.
#[derive(Debug, clap::Args)]
pub(super) struct Wavelet {
    #[command(flatten)]
    size: Size,
    /// Width, which sets the number of cycles.
    #[arg(long, value_name = "NUMBER", default_value_t = 2.0)]
    gamma: f64,
    /// Phase.
    #[arg(long, value_name = "ANGLE", default_value = "0 deg", allow_hyphen_values = true)]
    phase: String,
}

/// A pulse of unit amplitude, to be scaled.
pub(super) enum Shape<'a> {
    /// `d = A sin(w t)` with ramps.
    Sine(&'a Cycles),
    /// Half a wave of acceleration.
    HalfSine(&'a Size),
    /// One sine wave of acceleration.
    OneSine(&'a Size),
    /// One cosine wave of acceleration.
    OneCosine(&'a Size),
    /// Constant acceleration.
    Rectangular(&'a Size),
    /// Ricker wavelet.
    Ricker(&'a Size),
    /// Gabor wavelet.
    Gabor(&'a Wavelet),
    /// Forward step.
    CycloidA(&'a Size),
    /// Forth and back.
    CycloidB(&'a Size),
    /// Several cycles.
    CycloidC(&'a MainCycles),
    /// Near-fault pulse.
    MavroeidisPapageorgiou(&'a Wavelet),
}

impl Shape<'_> {
    fn size(&self) -> &Size {
        match self {
            Self::Sine(cycles) => &cycles.size,
            Self::HalfSine(size)
            | Self::OneSine(size)
            | Self::OneCosine(size)
            | Self::Rectangular(size)
            | Self::Ricker(size)
            | Self::CycloidA(size)
            | Self::CycloidB(size) => size,
            Self::CycloidC(cycles) => &cycles.size,
            Self::Gabor(wavelet) | Self::MavroeidisPapageorgiou(wavelet) => &wavelet.size,
        }
    }

    /// The pulse with the peak that was asked for.
    pub(super) fn motion(&self, name: &str) -> anyhow::Result<GroundMotion> {
        let size = self.size();
        let period = quantity("--period", &size.period, Dimension::TIME)?;
        let dimensions = [Dimension::ACCELERATION, Dimension::VELOCITY, Dimension::LENGTH];
        let peak = Quantity::parse_as(&size.peak, &dimensions)
            .map_err(|error| anyhow::anyhow!("--peak: {error}; write for example \"0.4 g\""))?;
        let phase = |wavelet: &Wavelet| quantity("--phase", &wavelet.phase, Dimension::ANGLE);
        let pulse = match self {
            Self::Sine(c) => {
                let (cycles, ramp_cycles) = (c.cycles, c.ramp_cycles);
                Pulse::Sine { amplitude: 1.0, period, cycles, ramp_cycles }
            }
            Self::HalfSine(_) => Pulse::HalfSine { acceleration: 1.0, duration: period },
            Self::OneSine(_) => Pulse::OneSine { acceleration: 1.0, period },
            Self::OneCosine(_) => Pulse::OneCosine { acceleration: 1.0, period },
            Self::Rectangular(_) => Pulse::Rectangular { acceleration: 1.0, duration: period },
            Self::Ricker(_) => Pulse::Ricker { acceleration: 1.0, period },
            Self::Gabor(w) => {
                Pulse::Gabor { velocity: 1.0, period, gamma: w.gamma, phase: phase(w)? }
            }
            Self::CycloidA(_) => Pulse::CycloidA { velocity: 1.0, period },
            Self::CycloidB(_) => Pulse::CycloidB { velocity: 1.0, period },
            Self::CycloidC(c) => Pulse::CycloidC { velocity: 1.0, period, cycles: c.cycles },
            Self::MavroeidisPapageorgiou(w) => {
                let (gamma, phase) = (w.gamma, phase(w)?);
                Pulse::MavroeidisPapageorgiou { velocity: 1.0, period, gamma, phase }
            }
        };
        let measure = match peak.dimension {
            Dimension::ACCELERATION => IntensityMeasure::Pga,
            Dimension::VELOCITY => IntensityMeasure::Pgv,
            _ => IntensityMeasure::Pgd,
        };
        if !(peak.value > 0.0) {
            bail!("--peak: expected a quantity above 0, found {}", size.peak);
        }
        let unit = GroundMotion::from_pulse(name, pulse)?;
        // What the user asked for stands in the file, not the pulse of unit amplitude.
        let mut motion = unit.scaled(unit.scale_factor(measure, peak.value)?);
        motion.provenance =
            vec![format!("made by formula: {name}, period {} s, {measure} {}", period, size.peak)];
        Ok(motion)
    }
}
