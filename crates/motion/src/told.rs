//! What made motions are, in sentences with units, as their provenance tells them.

use std::fmt::{Display, Formatter, Result};

use crate::pulse::Pulse;
use crate::synthesis::{BooreSource, CloughPenzien, Envelope, NearFault, SiteAmplification};

/// A number with six significant digits at most; the scenario or the study has all of them.
struct Short(f64);

impl Display for Short {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{}", format!("{:.5e}", self.0).parse().unwrap_or(self.0))
    }
}

impl Display for Pulse {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Sine { amplitude, period, cycles, ramp_cycles } => {
                write!(
                    f,
                    "harmonic displacement of amplitude {} m and period {} s, \
                     {} cycles, ",
                    Short(amplitude),
                    Short(period),
                    Short(cycles)
                )?;
                match ramp_cycles {
                    0.0 => write!(f, "without ramps"),
                    _ => write!(f, "the first and last {} of them ramps", Short(ramp_cycles)),
                }
            }
            Self::HalfSine { acceleration, duration } => {
                write!(f, "half a sine of {} m/s2 over {} s", Short(acceleration), Short(duration))
            }
            Self::OneSine { acceleration, period } => {
                write!(f, "one sine of {} m/s2 and period {} s", Short(acceleration), Short(period))
            }
            Self::OneCosine { acceleration, period } => {
                write!(
                    f,
                    "one cosine of {} m/s2 and period {} s",
                    Short(acceleration),
                    Short(period)
                )
            }
            Self::Rectangular { acceleration, duration } => {
                write!(
                    f,
                    "constant acceleration of {} m/s2 over {} s",
                    Short(acceleration),
                    Short(duration)
                )
            }
            Self::Ricker { acceleration, period } => {
                write!(
                    f,
                    "Ricker wavelet of {} m/s2 and period {} s",
                    Short(acceleration),
                    Short(period)
                )
            }
            Self::Gabor { velocity, period, gamma, phase } => write!(
                f,
                "Gabor wavelet of {} m/s, period {} s, width {} and phase {} \
                 rad",
                Short(velocity),
                Short(period),
                Short(gamma),
                Short(phase)
            ),
            Self::CycloidA { velocity, period } => {
                write!(
                    f,
                    "cycloidal pulse A of {} m/s and period {} s",
                    Short(velocity),
                    Short(period)
                )
            }
            Self::CycloidB { velocity, period } => {
                write!(
                    f,
                    "cycloidal pulse B of {} m/s and period {} s",
                    Short(velocity),
                    Short(period)
                )
            }
            Self::CycloidC { velocity, period, cycles } => write!(
                f,
                "cycloidal pulse C of {} m/s and period {} s with {} main cycles",
                Short(velocity),
                Short(period),
                cycles
            ),
            Self::MavroeidisPapageorgiou { velocity, period, gamma, phase } => write!(
                f,
                "pulse of Mavroeidis and Papageorgiou of {} m/s, period {} s, \
                 oscillatory character {} and phase {} rad",
                Short(velocity),
                Short(period),
                Short(gamma),
                Short(phase)
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
                "rising over {} s and decaying from {} s at {} 1/s (Jennings)",
                Short(rise),
                Short(decay_start),
                Short(decay)
            ),
            Self::SaragoniHart { peak, exponent } => {
                write!(
                    f,
                    "with its peak at {} s and exponent {} (Saragoni and Hart)",
                    Short(peak),
                    Short(exponent)
                )
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
            Short(self.rms),
            Short(self.ground_frequency),
            Short(self.ground_damping),
            Short(self.filter_frequency),
            Short(self.filter_damping)
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
            Short(self.magnitude),
            Short(path.distance),
            Short(self.stress),
            Short(self.velocity),
            Short(self.density),
            Short(path.quality),
            Short(path.quality_exponent),
            Short(path.kappa)
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
            self.pulse,
            Short(self.start),
            Short(self.crossover),
            self.rest
        )
    }
}
