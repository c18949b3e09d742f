//! Intensity measures of ground motion.

use std::fmt;
use std::str::FromStr;

use crate::error::MotionError;
use crate::fiv3::fiv3;
use crate::fourier::FourierSpectrum;
use crate::history::History;
use crate::math::{self, PI, STANDARD_GRAVITY};
use crate::response::{check_oscillator, response};
use crate::sampled::Sampled;

/// An intensity measure of one component, in SI units.
///
/// Integrals over time are computed by the trapezoidal rule from the samples, as is customary for
/// published values. The text form is `pgv`, `sa(1.0)`, `sa(1.0,0.02)`, `d5-95`, `housner` and so
/// on; printing includes all parameters, such as `sa(1,0.05)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntensityMeasure {
    /// Peak ground acceleration (m/s²).
    Pga,
    /// Peak ground velocity (m/s).
    Pgv,
    /// Peak ground displacement (m), integrated from the sampled velocities by the trapezoidal rule
    /// ([`Sampled::pgd_by_trapezoid`]).
    Pgd,
    /// Ratio PGV/PGA (s); large for pulse-like motions.
    PgvOverPga,
    /// Arias intensity `π/(2g) ∫a² dt` (m/s) (Arias 1970).
    Arias,
    /// Cumulative absolute velocity `∫|a| dt` (m/s) (EPRI 1988).
    Cav,
    /// Cumulative absolute velocity (m/s) over those one-second intervals in which `|a|` exceeds
    /// 0.025 g (EPRI 1991).
    CavStandardized,
    /// Time (s) during which the Arias intensity grows from one fraction of its final value to another fraction
    /// (Trifunac and Brady 1975).
    SignificantDuration {
        /// Fraction of the final Arias intensity at which the duration starts, such as 0.05.
        from: f64,
        /// Fraction of the final Arias intensity at which the duration ends, such as 0.95.
        to: f64,
    },
    /// Time (s) between the first and the last crossing of `threshold` by `|a|`.
    BracketedDuration {
        /// Threshold of the acceleration (m/s²), customarily 0.05 g.
        threshold: f64,
    },
    /// Root mean square of the acceleration over the whole record (m/s²).
    Rms,
    /// Housner intensity `∫ PSV dT` from 0.1 to 2.5 s (m) (Housner 1952), by the trapezoidal rule
    /// with steps of 0.01 s.
    Housner {
        /// Damping ratio; 0, 0.05 and 0.2 occur in the literature.
        damping: f64,
    },
    /// Acceleration spectrum intensity `∫ PSA dT` from 0.1 to 0.5 s at 5 % damping (m/s) (Von Thun
    /// et al. 1988).
    Asi,
    /// Velocity spectrum intensity `∫ PSV dT` from 0.1 to 2.5 s at 5 % damping (m) (Von Thun et al.
    /// 1988).
    Vsi,
    /// Mean period `Σ(C²/f)/ΣC²` (s), with the Fourier amplitudes `C` at the frequencies `f` from 0.25 to 20 Hz (Rathje
    /// et al. 1998).
    MeanPeriod,
    /// Fajfar index `PGV · D5-95^0.25` (m/s^0.75) (Fajfar et al. 1990).
    Fajfar,
    /// Pseudo-spectral acceleration (m/s²).
    Sa {
        /// Period (s).
        period: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// Filtered incremental velocity (m/s): the sum of the three largest increments of velocity,
    /// each over 0.7 times a period (Dávalos and Miranda 2019).
    Fiv3 {
        /// Period (s).
        period: f64,
    },
}

/// Dependence of a measure on the scale factor of the motion.
enum Growth {
    /// Proportional to the given power of the factor.
    Power(f64),
    /// Increasing with the factor, but not as a power of it.
    Monotone,
    /// Constant, or increasing in steps. The string is the reason why a motion cannot be scaled to the measure.
    None(&'static str),
}

impl IntensityMeasure {
    /// Significant duration from 5 % to 95 % of the Arias intensity.
    pub const D5_95: Self = Self::SignificantDuration { from: 0.05, to: 0.95 };
    /// Significant duration from 5 % to 75 % of the Arias intensity.
    pub const D5_75: Self = Self::SignificantDuration { from: 0.05, to: 0.75 };
    /// Bracketed duration at 0.05 g.
    pub const BRACKETED: Self = Self::BracketedDuration { threshold: 0.05 * STANDARD_GRAVITY };

    /// Returns the SI unit of the measure; empty for a dimensionless measure.
    pub fn unit(&self) -> &'static str {
        self.unit_and_growth().0
    }

    fn unit_and_growth(&self) -> (&'static str, Growth) {
        match self {
            Self::Pga | Self::Rms | Self::Sa { .. } => ("m/s2", Growth::Power(1.0)),
            Self::Pgv | Self::Cav | Self::Asi | Self::Fiv3 { .. } => ("m/s", Growth::Power(1.0)),
            Self::Arias => ("m/s", Growth::Power(2.0)),
            Self::CavStandardized => ("m/s", Growth::Monotone),
            Self::Pgd | Self::Housner { .. } | Self::Vsi => ("m", Growth::Power(1.0)),
            Self::Fajfar => ("m/s^0.75", Growth::Power(1.0)),
            Self::PgvOverPga => ("s", Growth::None("a ratio does not change with the amplitude")),
            Self::SignificantDuration { .. } | Self::MeanPeriod => {
                ("s", Growth::None("a time does not change with the amplitude"))
            }
            Self::BracketedDuration { .. } => {
                ("s", Growth::None("a bracketed duration grows in steps"))
            }
        }
    }

    /// Returns the scale factor of a motion at which this measure equals `target` (SI units).
    ///
    /// `value` takes a scale factor and returns the measure of the motion scaled by this factor.
    /// `name` is the name of the motion in error messages.
    ///
    /// # Errors
    /// If the measure does not grow with the amplitude, or is zero.
    pub fn factor(
        self,
        target: f64,
        name: &str,
        value: impl Fn(f64) -> Result<f64, MotionError>,
    ) -> Result<f64, MotionError> {
        MotionError::require_positive(&format!("target {self} ({})", self.unit()), target)?;
        let zero = || MotionError::Zero {
            measure: self.to_string(),
            motion: name.to_owned(),
            target: format!("{target} {}", self.unit()),
        };
        match self.unit_and_growth().1 {
            Growth::Power(power) => {
                let now = value(1.0)?;
                if !(now > 0.0) {
                    return Err(zero());
                }
                let ratio = target / now;
                Ok(if power == 2.0 { ratio.sqrt() } else { ratio })
            }
            Growth::Monotone => bracketed(target, value)?.ok_or_else(zero),
            Growth::None(reason) => Err(MotionError::NotScalable {
                measure: self.to_string(),
                reason: reason.to_owned(),
            }),
        }
    }

    /// Checks the parameters of the measure.
    ///
    /// # Errors
    /// If a parameter is out of range; the error names the first such parameter.
    pub fn check(&self) -> Result<(), MotionError> {
        match *self {
            Self::SignificantDuration { from, to } => {
                let within = 0.0 <= from && from < to && to <= 1.0;
                let (what, expected) = ("significant duration", "fractions 0 <= from < to <= 1");
                MotionError::require(within, what, expected, format!("{from} and {to}"))
            }
            Self::BracketedDuration { threshold } => {
                MotionError::require_positive("bracketed duration threshold (m/s2)", threshold)
            }
            Self::Housner { damping } => check_oscillator(1.0, damping),
            Self::Sa { period, damping } => check_oscillator(period, damping),
            Self::Fiv3 { period } => MotionError::require_positive("period of FIV3 (s)", period),
            Self::Pga
            | Self::Pgv
            | Self::Pgd
            | Self::PgvOverPga
            | Self::Arias
            | Self::Cav
            | Self::CavStandardized
            | Self::Rms
            | Self::Asi
            | Self::Vsi
            | Self::MeanPeriod
            | Self::Fajfar => Ok(()),
        }
    }

    /// Returns the value of the measure for a sampled motion.
    ///
    /// # Errors
    /// If a parameter of the measure is out of range.
    pub fn of(&self, motion: &Sampled) -> Result<f64, MotionError> {
        self.check()?;
        let (dt, a) = (motion.time_step(), motion.acceleration());
        Ok(match *self {
            Self::Pga => motion.pga(),
            Self::Pgv => motion.pgv(),
            Self::Pgd => motion.pgd_by_trapezoid(),
            Self::PgvOverPga => motion.pgv() / motion.pga(),
            Self::Arias => arias(dt, a),
            Self::Cav => math::trapezoid(a.iter().map(|a| a.abs()), dt),
            Self::CavStandardized => cav_standardized(dt, a),
            Self::SignificantDuration { from, to } => significant_duration(dt, a, from, to),
            Self::BracketedDuration { threshold } => bracketed_duration(dt, a, threshold),
            Self::Rms => (math::trapezoid(a.iter().map(|a| a * a), dt) / motion.duration()).sqrt(),
            Self::Housner { damping } => spectrum_integral(dt, a, 0.1, 2.5, damping, false)?,
            Self::Vsi => spectrum_integral(dt, a, 0.1, 2.5, 0.05, false)?,
            Self::Asi => spectrum_integral(dt, a, 0.1, 0.5, 0.05, true)?,
            Self::MeanPeriod => mean_period(dt, a),
            Self::Fajfar => {
                let duration = significant_duration(dt, a, 0.05, 0.95);
                motion.pgv() * duration.sqrt().sqrt()
            }
            Self::Sa { period, damping } => response(dt, a, period, damping)?.pseudo_acceleration,
            Self::Fiv3 { period } => fiv3(dt, a, period),
        })
    }

    /// Returns the value of the measure for any history.
    ///
    /// A history that is not sampled is first sampled at its natural step, except that PGA, PGV and
    /// PGD are found by a search on the exact history.
    ///
    /// # Errors
    /// If a parameter of the measure is out of range.
    pub fn of_history(&self, history: &History) -> Result<f64, MotionError> {
        match (self, history) {
            (_, History::Sampled(sampled)) => self.of(sampled),
            (Self::Pga, _) => Ok(history.pga()),
            (Self::Pgv, _) => Ok(history.pgv()),
            (Self::Pgd, _) => Ok(history.pgd()),
            (Self::PgvOverPga, _) => Ok(history.pgv() / history.pga()),
            _ => self.of(&history.sampled(history.natural_step())?),
        }
    }
}

/// Finds, by bisection, the scale factor at which a measure that increases with the factor reaches `target`. Returns
/// `None` if the measure does not reach it at any factor up to 10¹².
fn bracketed(
    target: f64,
    value: impl Fn(f64) -> Result<f64, MotionError>,
) -> Result<Option<f64>, MotionError> {
    let (mut low, mut high) = (1.0, 1.0);
    while value(low)? > target {
        low *= 0.5;
    }
    while value(high)? < target {
        high *= 2.0;
        if high > 1e12 {
            return Ok(None);
        }
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if value(middle)? < target {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(Some(high))
}

/// Returns the Arias intensity (m/s) of accelerations (m/s²).
pub fn arias(time_step: f64, acceleration: &[f64]) -> f64 {
    PI / (2.0 * STANDARD_GRAVITY) * math::trapezoid(acceleration.iter().map(|a| a * a), time_step)
}

/// Returns the Arias intensity accumulated up to each sample, divided by its final value (Husid
/// plot).
pub fn husid(acceleration: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut build_up = Vec::with_capacity(acceleration.len());
    build_up.push(0.0);
    for pair in acceleration.windows(2) {
        sum += 0.5 * (pair[0] * pair[0] + pair[1] * pair[1]);
        build_up.push(sum);
    }
    if sum > 0.0 {
        for value in &mut build_up {
            *value /= sum;
        }
    }
    build_up
}

fn significant_duration(time_step: f64, acceleration: &[f64], from: f64, to: f64) -> f64 {
    let build_up = husid(acceleration);
    let time = |fraction: f64| {
        let after = build_up.partition_point(|&value| value < fraction);
        if after == 0 || after == build_up.len() {
            return after as f64;
        }
        let (low, high) = (build_up[after - 1], build_up[after]);
        (after - 1) as f64 + (fraction - low) / (high - low)
    };
    time_step * (time(to) - time(from))
}

fn cav_standardized(time_step: f64, acceleration: &[f64]) -> f64 {
    let threshold = 0.025 * STANDARD_GRAVITY;
    let per_window = (1.0 / time_step).round().max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 1")]
    let per_window = per_window as usize;
    let mut sum = 0.0;
    let mut first = 0;
    while first + 1 < acceleration.len() {
        let last = (first + per_window).min(acceleration.len() - 1);
        let window = &acceleration[first..=last];
        if math::peak(window) > threshold {
            sum += math::trapezoid(window.iter().map(|a| a.abs()), time_step);
        }
        first = last;
    }
    sum
}

fn bracketed_duration(time_step: f64, acceleration: &[f64], threshold: f64) -> f64 {
    let above = |a: &f64| a.abs() > threshold;
    let (Some(first), Some(last)) =
        (acceleration.iter().position(above), acceleration.iter().rposition(above))
    else {
        return 0.0;
    };
    // The crossing lies between two samples; interpolate from the sample below the threshold to the
    // sample above it.
    let part = |below: f64, above: f64| (threshold - below.abs()) / (above.abs() - below.abs());
    let start = if first == 0 {
        0.0
    } else {
        (first - 1) as f64 + part(acceleration[first - 1], acceleration[first])
    };
    let end = if last + 1 == acceleration.len() {
        last as f64
    } else {
        (last + 1) as f64 - part(acceleration[last + 1], acceleration[last])
    };
    time_step * (end - start)
}

fn spectrum_integral(
    time_step: f64,
    acceleration: &[f64],
    first: f64,
    last: f64,
    damping: f64,
    of_acceleration: bool,
) -> Result<f64, MotionError> {
    let steps = ((last - first) / 0.01).round();
    let ordinate = |k: u32| {
        let period = first + (last - first) * f64::from(k) / steps;
        let peaks = response(time_step, acceleration, period, damping)?;
        Ok(if of_acceleration { peaks.pseudo_acceleration } else { peaks.pseudo_velocity })
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some hundred")]
    let ordinates: Vec<f64> = (0..=steps as u32).map(ordinate).collect::<Result<_, _>>()?;
    Ok(math::trapezoid(ordinates.into_iter(), (last - first) / steps))
}

fn mean_period(time_step: f64, acceleration: &[f64]) -> f64 {
    let spectrum = FourierSpectrum::new(time_step, acceleration);
    let (mut weighted, mut total) = (0.0, 0.0);
    for (&f, &c) in spectrum.frequency.iter().zip(&spectrum.amplitude) {
        if (0.25..=20.0).contains(&f) {
            weighted += c * c / f;
            total += c * c;
        }
    }
    weighted / total
}

impl fmt::Display for IntensityMeasure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pga => f.write_str("pga"),
            Self::Pgv => f.write_str("pgv"),
            Self::Pgd => f.write_str("pgd"),
            Self::PgvOverPga => f.write_str("pgv/pga"),
            Self::Arias => f.write_str("arias"),
            Self::Cav => f.write_str("cav"),
            Self::CavStandardized => f.write_str("cav-std"),
            Self::SignificantDuration { from, to } => {
                write!(f, "d{}-{}", percent(*from), percent(*to))
            }
            Self::BracketedDuration { threshold } => write!(f, "bracketed({threshold})"),
            Self::Rms => f.write_str("rms"),
            Self::Housner { damping } => write!(f, "housner({damping})"),
            Self::Asi => f.write_str("asi"),
            Self::Vsi => f.write_str("vsi"),
            Self::MeanPeriod => f.write_str("tm"),
            Self::Fajfar => f.write_str("fajfar"),
            Self::Sa { period, damping } => write!(f, "sa({period},{damping})"),
            Self::Fiv3 { period } => write!(f, "fiv3({period})"),
        }
    }
}

/// Converts a fraction to a percentage without rounding noise.
fn percent(fraction: f64) -> f64 {
    (fraction * 1e8).round() / 1e6
}

impl FromStr for IntensityMeasure {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let refuse = || {
            MotionError::parameter(
                "intensity measure",
                "pga, pgv, pgd, pgv/pga, arias, cav, cav-std, d5-75, d5-95, bracketed, rms, \
                 housner, asi, vsi, tm, fajfar, fiv3(period), sa(period) or sa(period,damping)",
                format!("\"{text}\""),
            )
        };
        let lower = text.trim().to_ascii_lowercase();
        let (name, arguments) = match lower.split_once('(') {
            Some((name, rest)) => {
                let inside = rest.strip_suffix(')').ok_or_else(refuse)?;
                let numbers = inside
                    .split(',')
                    .map(|part| part.trim().parse::<f64>())
                    .collect::<Result<Vec<_>, _>>()
                    .map_err(|_| refuse())?;
                (name.trim().to_owned(), numbers)
            }
            None => (lower.clone(), Vec::new()),
        };
        let measure = match (name.as_str(), arguments.as_slice()) {
            ("pga", []) => Self::Pga,
            ("pgv", []) => Self::Pgv,
            ("pgd", []) => Self::Pgd,
            ("pgv/pga", []) => Self::PgvOverPga,
            ("arias" | "ia", []) => Self::Arias,
            ("cav", []) => Self::Cav,
            ("cav-std", []) => Self::CavStandardized,
            ("bracketed", []) => Self::BRACKETED,
            ("bracketed", [threshold]) => Self::BracketedDuration { threshold: *threshold },
            ("rms", []) => Self::Rms,
            ("housner", []) => Self::Housner { damping: 0.05 },
            ("housner", [damping]) => Self::Housner { damping: *damping },
            ("asi", []) => Self::Asi,
            ("vsi", []) => Self::Vsi,
            ("tm", []) => Self::MeanPeriod,
            ("fajfar", []) => Self::Fajfar,
            ("fiv3", [period]) => Self::Fiv3 { period: *period },
            ("sa", [period]) => Self::Sa { period: *period, damping: 0.05 },
            ("sa", [period, damping]) => Self::Sa { period: *period, damping: *damping },
            (duration, []) => {
                let (from, to) = duration
                    .strip_prefix('d')
                    .and_then(|rest| rest.split_once('-'))
                    .ok_or_else(refuse)?;
                let fraction =
                    |part: &str| part.parse::<f64>().map(|p| p / 100.0).map_err(|_| refuse());
                Self::SignificantDuration { from: fraction(from)?, to: fraction(to)? }
            }
            _ => return Err(refuse()),
        };
        measure.check()?;
        Ok(measure)
    }
}
