//! Describes analytic motions in sentences with units.

use std::fmt::{Display, Formatter, Result};

use crate::pulse::Pulse;

/// A number printed with at most six significant digits. The scenario or the study file has the
/// full precision.
pub struct Short(pub f64);

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
                    _ => write!(f, "of which the first and last {} are ramps", Short(ramp_cycles)),
                }
            }
            Self::HalfSine { acceleration, duration } => {
                write!(f, "half sine of {} m/s2 over {} s", Short(acceleration), Short(duration))
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
