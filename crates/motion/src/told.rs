//! What made motions are, in sentences with units, as their provenance tells them.

use std::fmt::{Display, Formatter, Result};

use crate::pulse::Pulse;
use crate::synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, SiteAmplification};

impl Display for Pulse {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Sine { amplitude, period, cycles, ramp_cycles } => write!(
                f,
                "harmonic displacement of amplitude {amplitude} m and period {period} s, {cycles} \
                 cycles long with ramps of {ramp_cycles}"
            ),
            Self::HalfSine { acceleration, duration } => {
                write!(f, "half a sine of {acceleration} m/s2 over {duration} s")
            }
            Self::OneSine { acceleration, period } => {
                write!(f, "one sine of {acceleration} m/s2 and period {period} s")
            }
            Self::OneCosine { acceleration, period } => {
                write!(f, "one cosine of {acceleration} m/s2 and period {period} s")
            }
            Self::Rectangular { acceleration, duration } => {
                write!(f, "constant acceleration of {acceleration} m/s2 over {duration} s")
            }
            Self::Ricker { acceleration, period } => {
                write!(f, "Ricker wavelet of {acceleration} m/s2 and period {period} s")
            }
            Self::Gabor { velocity, period, gamma, phase } => write!(
                f,
                "Gabor wavelet of {velocity} m/s, period {period} s, width {gamma} and phase {phase} \
                 rad"
            ),
            Self::CycloidA { velocity, period } => {
                write!(f, "cycloidal pulse A of {velocity} m/s and period {period} s")
            }
            Self::CycloidB { velocity, period } => {
                write!(f, "cycloidal pulse B of {velocity} m/s and period {period} s")
            }
            Self::CycloidC { velocity, period, cycles } => write!(
                f,
                "cycloidal pulse C of {velocity} m/s and period {period} s with {cycles} main cycles"
            ),
            Self::MavroeidisPapageorgiou { velocity, period, gamma, phase } => write!(
                f,
                "pulse of Mavroeidis and Papageorgiou of {velocity} m/s, period {period} s, \
                 oscillatory character {gamma} and phase {phase} rad"
            ),
        }
    }
}

impl Display for Envelope {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Flat => write!(f, "without envelope"),
            Self::Jennings { rise, decay_start, decay } => write!(
                f,
                "rising over {rise} s and decaying from {decay_start} s at {decay} 1/s (Jennings)"
            ),
            Self::SaragoniHart { peak, exponent } => {
                write!(f, "with its peak at {peak} s and exponent {exponent} (Saragoni and Hart)")
            }
        }
    }
}

impl Display for CloughPenzien {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(
            f,
            "{} m/s2 rms, ground of {} rad/s and damping ratio {}, high-pass of {} rad/s and damping \
             ratio {}",
            self.rms,
            self.ground_frequency,
            self.ground_damping,
            self.filter_frequency,
            self.filter_damping
        )
    }
}

impl Display for BooreSource {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let path = &self.path;
        write!(
            f,
            "magnitude {} at {} km, stress parameter {} bar, {} km/s and {} g/cm3 at the source, Q = \
             {} f^{}, kappa {} s, ",
            self.magnitude,
            path.distance,
            self.stress,
            self.velocity,
            self.density,
            path.quality,
            path.quality_exponent,
            path.kappa
        )?;
        match &path.amplification {
            SiteAmplification::None => write!(f, "no site amplification"),
            SiteAmplification::Table(points) => {
                write!(f, "site amplification at {} frequencies", points.len())
            }
        }
    }
}

impl Display for NearFault {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(
            f,
            "{} from {} s on, around it the stochastic method above {} of the pulse's frequency: {}",
            self.pulse, self.start, self.crossover, self.rest
        )
    }
}
