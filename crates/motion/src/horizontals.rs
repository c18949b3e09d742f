//! Intensity measures of two horizontal components, combined into one number.

use std::str::FromStr;

use crate::error::MotionError;
use crate::intensity::IntensityMeasure;
use crate::math::{self, PI};
use crate::rotd::{DIRECTIONS, rotated_peak, rotated_spectrum};
use crate::sampled::{Sampled, running_trapezoid};

/// Rule by which the intensity measures of two horizontal components are combined into one number.
///
/// The text form is `rotd50`, `rotd100` or `geomean`.
///
/// ```
/// use barrelstack_motion::{Horizontals, IntensityMeasure, Sampled};
/// let east = Sampled::new(0.01, vec![0.0, 3.0, -2.0, 0.0])?;
/// let north = Sampled::new(0.01, vec![0.0, 4.0, 1.0, 0.0])?;
/// let largest = Horizontals::RotD100.of(IntensityMeasure::Pga, &east, &north)?;
/// assert!((largest - 5.0).abs() < 1e-3);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Horizontals {
    /// Median over all directions, one degree apart (Boore 2010, BSSA 100:1830-1835).
    RotD50,
    /// Maximum over all directions, one degree apart.
    RotD100,
    /// Geometric mean of both components as recorded.
    GeometricMean,
}

impl Horizontals {
    /// Returns the combined measure of two components with the same time step (SI units).
    ///
    /// For `RotD50` and `RotD100`, the longer component is cut to the length of the shorter one.
    /// Peaks and spectral accelerations are computed from the convex hull of the two responses. All
    /// other measures are computed from the motion rotated in steps of one degree. The geometric
    /// mean uses each component in full.
    ///
    /// # Errors
    /// If the steps differ, or a parameter of the measure is out of range.
    pub fn of(
        self,
        measure: IntensityMeasure,
        first: &Sampled,
        second: &Sampled,
    ) -> Result<f64, MotionError> {
        measure.check()?;
        first.require_step(second)?;
        let peaks = match (self, measure) {
            (Self::GeometricMean, _) => {
                return Ok((measure.of(first)? * measure.of(second)?).sqrt());
            }
            (_, IntensityMeasure::Pga) => rotated_peak(first.acceleration(), second.acceleration()),
            (_, IntensityMeasure::Pgv) => rotated_peak(first.velocity(), second.velocity()),
            (_, IntensityMeasure::Pgd) => {
                // Integrates by the trapezoidal rule, as for the measure of one component.
                let along = |one: &Sampled| running_trapezoid(one.time_step(), one.velocity());
                rotated_peak(&along(first), &along(second))
            }
            (_, IntensityMeasure::Sa { period, damping }) => {
                let (a, b) = (first.acceleration(), second.acceleration());
                return rotated_spectrum(first.time_step(), a, b, &[period], damping)
                    .map(|peaks| self.pick(peaks[0].median, peaks[0].largest));
            }
            _ => {
                let values = turned(measure, first, second)?;
                let middle = DIRECTIONS / 2;
                return Ok(
                    self.pick(0.5 * (values[middle - 1] + values[middle]), values[DIRECTIONS - 1])
                );
            }
        };
        Ok(self.pick(peaks.median, peaks.largest))
    }

    fn pick(self, median: f64, largest: f64) -> f64 {
        match self {
            Self::RotD50 | Self::GeometricMean => median,
            Self::RotD100 => largest,
        }
    }

    /// Returns the factor, the same for both components, that brings the combined measure to
    /// `target` (SI units).
    ///
    /// # Errors
    /// The same as for [`Horizontals::of`], and if the measure does not grow with the amplitude or
    /// is zero, or if the target is not positive.
    pub fn scale_factor(
        self,
        measure: IntensityMeasure,
        first: &Sampled,
        second: &Sampled,
        target: f64,
    ) -> Result<f64, MotionError> {
        measure.factor(target, &format!("both horizontals ({self})"), |factor| {
            self.of(measure, &first.scaled(factor), &second.scaled(factor))
        })
    }
}

/// Returns the values of the measure for all directions, sorted in ascending order.
fn turned(
    measure: IntensityMeasure,
    first: &Sampled,
    second: &Sampled,
) -> Result<Vec<f64>, MotionError> {
    let v0 = (first.velocity()[0], second.velocity()[0]);
    let mut values = Vec::with_capacity(DIRECTIONS);
    for degree in 0..DIRECTIONS {
        let (s, c) = math::sin_cos(PI * degree as f64 / DIRECTIONS as f64);
        let along = first.acceleration().iter().zip(second.acceleration());
        let a = along.map(|(x, y)| x * c + y * s).collect();
        let v = v0.0 * c + v0.1 * s;
        values.push(measure.of(&Sampled::with_initial_velocity(first.time_step(), a, v)?)?);
    }
    values.sort_by(f64::total_cmp);
    Ok(values)
}

printed_as!(Horizontals, RotD50 = "rotd50", RotD100 = "rotd100", GeometricMean = "geomean");

impl FromStr for Horizontals {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let name = text.trim().to_ascii_lowercase();
        let all = [Self::RotD50, Self::RotD100, Self::GeometricMean];
        all.into_iter().find(|one| one.to_string() == name).ok_or_else(|| {
            let (what, all) = ("measure of two horizontals", "rotd50, rotd100 or geomean");
            MotionError::parameter(what, all, format!("\"{text}\""))
        })
    }
}
