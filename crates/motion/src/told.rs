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

fn of_period(f: &mut Formatter<'_>, what: &str, amplitude: f64, unit: &str, period: f64) -> Result {
    write!(f, "{what} of {} {unit} and period {} s", Short(amplitude), Short(period))
}

impl Display for Pulse {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match *self {
            Self::Sine { amplitude, period, cycles, ramp_cycles } => {
                let [amplitude, period, cycles] = [amplitude, period, cycles].map(Short);
                write!(
                    f,
                    "harmonic displacement of amplitude {amplitude} m and period {period} s, \
                     {cycles} cycles, "
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
                of_period(f, "one sine", acceleration, "m/s2", period)
            }
            Self::OneCosine { acceleration, period } => {
                of_period(f, "one cosine", acceleration, "m/s2", period)
            }
            Self::Ricker { acceleration, period } => {
                of_period(f, "Ricker wavelet", acceleration, "m/s2", period)
            }
            Self::CycloidA { velocity, period } => {
                of_period(f, "cycloidal pulse A", velocity, "m/s", period)
            }
            Self::CycloidB { velocity, period } => {
                of_period(f, "cycloidal pulse B", velocity, "m/s", period)
            }
            Self::Rectangular { acceleration, duration } => {
                let (acceleration, duration) = (Short(acceleration), Short(duration));
                write!(f, "constant acceleration of {acceleration} m/s2 over {duration} s")
            }
            Self::Gabor { velocity, period, gamma, phase } => {
                let [velocity, period, gamma, phase] = [velocity, period, gamma, phase].map(Short);
                write!(
                    f,
                    "Gabor wavelet of {velocity} m/s, period {period} s, width {gamma} and phase \
                     {phase} rad"
                )
            }
            Self::CycloidC { velocity, period, cycles } => {
                of_period(f, "cycloidal pulse C", velocity, "m/s", period)?;
                write!(f, " with {cycles} main cycles")
            }
            Self::MavroeidisPapageorgiou { velocity, period, gamma, phase } => {
                let [velocity, period, gamma, phase] = [velocity, period, gamma, phase].map(Short);
                write!(
                    f,
                    "pulse of Mavroeidis and Papageorgiou of {velocity} m/s, period {period} s, \
                     oscillatory character {gamma} and phase {phase} rad"
                )
            }
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
                let [peak, exponent] = [peak, exponent].map(Short);
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
