//! Processing of recorded accelerations for integration. Every step is explicit and is recorded in
//! the provenance.

use crate::error::MotionError;
use crate::fourier::{apply_gain, forward_real, inverse};
use crate::math::{self, PI};
use crate::record::Stage;
use crate::sampled::integrate;

/// The mean that processing removes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeanRemoval {
    /// No mean is removed.
    Keep,
    /// Mean of the quiet part before the first arrival, of which at most 5 s are used. If the shaking begins within the
    /// first second, the mean of the whole record is removed instead.
    PreEvent,
    /// Mean of the whole record.
    Whole,
}

/// Treatment of the zero pads added for the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pads {
    /// The pads are kept. They contain the filter transients that bring velocity and displacement
    /// to zero at the end (Boore 2005, BSSA 95:745-750).
    Kept,
    /// The pads are removed after filtering; [`Processing::close`] brings the final velocity and
    /// displacement to zero instead.
    Removed,
}

/// Processing of one record; the steps are applied in the order of the fields.
///
/// ```
/// use barrelstack_motion::{Processing, Stage};
/// assert_eq!(Processing::for_stage(Stage::Corrected), Processing::none());
/// let gentle = Processing { high_pass: Some(0.05), ..Processing::raw() };
/// assert_eq!(gentle.order, 4);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Processing {
    /// Mean to be removed.
    pub mean: MeanRemoval,
    /// If `true`, subtracts the least-squares line. This is suitable only for records without permanent tilt.
    pub detrend: bool,
    /// Length of the cosine taper at each end, as a fraction of the record; 0 for no taper.
    pub taper: f64,
    /// High-pass corner (Hz). A corner below the reciprocal of the duration is raised to this reciprocal.
    pub high_pass: Option<f64>,
    /// Low-pass corner (Hz); at least the reciprocal of the duration, and below the Nyquist frequency.
    pub low_pass: Option<f64>,
    /// Order `n` of the Butterworth filter, applied forward and backward: gain
    /// `1/(1 + (fc/f)^(2n))`, zero phase, half amplitude at the corner.
    pub order: u32,
    /// Treatment of the zero pads at both ends, `1.5 n/fc` seconds in total (Converse and Brady
    /// 1992).
    pub pads: Pads,
    /// If `true`, adds a smooth acceleration with two terms, which brings the final velocity and
    /// displacement to zero.
    pub close: bool,
}

impl Processing {
    /// Returns settings that apply no processing; the record is used as published.
    pub fn none() -> Self {
        Self {
            mean: MeanRemoval::Keep,
            detrend: false,
            taper: 0.0,
            high_pass: None,
            low_pass: None,
            order: 4,
            pads: Pads::Kept,
            close: false,
        }
    }

    /// Returns the full processing for raw records: pre-event mean, 2 % taper, fourth-order zero-phase
    /// high-pass at 0.1 Hz with pads kept, final velocity and displacement brought to zero.
    pub fn raw() -> Self {
        Self {
            mean: MeanRemoval::PreEvent,
            taper: 0.02,
            high_pass: Some(0.1),
            close: true,
            ..Self::none()
        }
    }

    /// Returns [`Processing::raw`] with the pads removed, for runs in which half a minute of quiet
    /// before the shaking would take too long.
    pub fn compact() -> Self {
        Self { pads: Pads::Removed, ..Self::raw() }
    }

    /// Returns the default processing for a record: [`Processing::raw`] for a raw record, and no
    /// processing for any other record.
    pub fn for_stage(stage: Stage) -> Self {
        match stage {
            Stage::Raw => Self::raw(),
            Stage::Corrected | Stage::Unknown => Self::none(),
        }
    }

    /// Returns `true` if the processing does not change the record.
    pub fn is_none(&self) -> bool {
        self.mean == MeanRemoval::Keep
            && !self.detrend
            && self.taper == 0.0
            && self.high_pass.is_none()
            && self.low_pass.is_none()
            && !self.close
    }

    fn check(&self, time_step: f64, samples: usize) -> Result<(), MotionError> {
        MotionError::require_positive("time step (s)", time_step)?;
        let fits = (0.0..=0.5).contains(&self.taper);
        MotionError::require(fits, "taper", "a fraction from 0 to 0.5", self.taper)?;
        MotionError::require(
            (1..=12).contains(&self.order),
            "filter order",
            "1 to 12",
            self.order,
        )?;
        let (slowest, nyquist) = (1.0 / (time_step * samples as f64), 0.5 / time_step);
        if let Some(corner) = self.high_pass {
            let within = corner > 0.0 && corner < nyquist;
            let expected = format!("above 0 and below the Nyquist frequency, {nyquist} Hz");
            MotionError::require(within, "high-pass corner (Hz)", expected, corner)?;
        }
        let Some(low) = self.low_pass else { return Ok(()) };
        MotionError::require(
            low >= slowest && low < nyquist,
            "low-pass corner (Hz)",
            format!(
                "at least the reciprocal of the duration, {slowest:.4} Hz, and below the Nyquist \
                 frequency, {nyquist} Hz"
            ),
            low,
        )?;
        let Some(high) = self.high_pass_used(time_step, samples) else { return Ok(()) };
        let what = "high-pass corner (Hz), at least the reciprocal of the duration";
        MotionError::require(high < low, what, format!("below the low-pass corner, {low} Hz"), high)
    }

    /// Returns the high-pass corner (Hz) used for a record of this length. The corner is at least the
    /// reciprocal of the duration, because the record does not resolve longer periods.
    fn high_pass_used(&self, time_step: f64, samples: usize) -> Option<f64> {
        self.high_pass.map(|corner| corner.max(1.0 / (time_step * samples as f64)))
    }

    /// Applies the processing to accelerations (m/s²) with step `time_step` (s).
    ///
    /// # Errors
    /// If a setting is out of range for the record.
    pub fn apply(
        &self,
        time_step: f64,
        acceleration: &[f64],
        initial_velocity: f64,
    ) -> Result<Processed, MotionError> {
        self.check(time_step, acceleration.len())?;
        let mut steps = Vec::new();
        let mut a = acceleration.to_vec();
        let mut initial_velocity = initial_velocity;
        let mut lead = 0.0;
        if self.is_none() {
            steps.push("used as read, without processing".to_owned());
        } else {
            self.remove_mean(time_step, &mut a, &mut steps);
            if self.detrend {
                remove_line(&mut a);
                steps.push("least-squares line subtracted".to_owned());
            }
            if self.taper > 0.0 {
                taper_ends(&mut a, self.taper);
                steps.push(format!("cosine taper of {:.1} % at each end", 100.0 * self.taper));
            }
            if self.high_pass.is_some() || self.low_pass.is_some() {
                lead = self.filter(time_step, &mut a, &mut steps);
                // The high-pass removes the mean velocity along with everything else below its
                // corner.
                initial_velocity = 0.0;
            }
            if self.close {
                close_ends(time_step, &mut a, initial_velocity, &mut steps);
            }
        }
        let residuals = Residuals::of(time_step, &a, initial_velocity);
        steps.push(residuals.sentence());
        Ok(Processed { acceleration: a, initial_velocity, lead, residuals, steps })
    }

    fn remove_mean(&self, time_step: f64, a: &mut [f64], steps: &mut Vec<String>) {
        let (mean, of) = match self.mean {
            MeanRemoval::Keep => return,
            MeanRemoval::Whole => (math::mean(a), "the whole record".to_owned()),
            MeanRemoval::PreEvent => match quiet_samples(time_step, a) {
                Some(n) => {
                    (math::mean(&a[..n]), format!("the first {:.2} s", n as f64 * time_step))
                }
                None => (
                    math::mean(a),
                    "the whole record (it has no quiet part before the first arrival)".to_owned(),
                ),
            },
        };
        for value in a.iter_mut() {
            *value -= mean;
        }
        steps.push(format!("mean of {of} removed, {mean:.3e} m/s2"));
    }

    /// Pads and filters the accelerations. Returns the length (s) of the leading pad, which delays the recorded part.
    fn filter(&self, time_step: f64, a: &mut Vec<f64>, steps: &mut Vec<String>) -> f64 {
        let corner = self.high_pass_used(time_step, a.len());
        if let (Some(requested), Some(used)) = (self.high_pass, corner)
            && used > requested
        {
            steps.push(format!(
                "high-pass corner raised from {requested} to {used:.4} Hz, the reciprocal of the \
                 duration"
            ));
        }
        let slowest = corner.or(self.low_pass).unwrap_or(1.0);
        let side = (0.75 * f64::from(self.order) / slowest / time_step).ceil();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive, and at most 9 times the record because both corners are at least \
                      1/duration"
        )]
        let side = side as usize;
        let recorded = a.len();
        let mut padded = vec![0.0; recorded + 2 * side];
        padded[side..side + recorded].copy_from_slice(a);
        let length = padded.len().next_power_of_two();
        let mut spectrum = forward_real(&padded, length);
        let power = 2 * self.order;
        apply_gain(&mut spectrum, time_step, |f| {
            let high = corner.map_or(1.0, |fc| {
                if f == 0.0 { 0.0 } else { 1.0 / (1.0 + math::powi(fc / f, power)) }
            });
            high * self.low_pass.map_or(1.0, |fc| 1.0 / (1.0 + math::powi(f / fc, power)))
        });
        inverse(&mut spectrum);
        for (value, filtered) in padded.iter_mut().zip(&spectrum) {
            *value = filtered.re;
        }
        for (pass, corner) in [("high", corner), ("low", self.low_pass)] {
            steps.extend(corner.map(|fc| {
                format!(
                    "zero-phase Butterworth {pass}-pass, order {} forward and backward, at {fc:.4} Hz",
                    self.order
                )
            }));
        }
        let pad = side as f64 * time_step;
        match self.pads {
            Pads::Kept => {
                *a = padded;
                steps.push(format!("kept the zero padding of {pad:.2} s at each end"));
                pad
            }
            Pads::Removed => {
                a.copy_from_slice(&padded[side..side + recorded]);
                steps.push(format!("zero pads of {pad:.2} s at each end removed after filtering"));
                0.0
            }
        }
    }
}

/// Processed accelerations, with a description of the applied steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Processed {
    /// Acceleration (m/s²).
    pub acceleration: Vec<f64>,
    /// Velocity at the first sample (m/s).
    pub initial_velocity: f64,
    /// Delay of the recorded part (s) caused by a leading pad.
    pub lead: f64,
    /// Velocity and displacement left at the end.
    pub residuals: Residuals,
    /// Description of every processing step, one sentence each.
    pub steps: Vec<String>,
}

/// Velocity and displacement left at the end of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Final velocity divided by PGV.
    pub velocity: f64,
    /// Final displacement divided by PGD.
    pub displacement: f64,
}

impl Residuals {
    /// Integrates accelerations (m/s²) from `initial_velocity` (m/s), and returns the absolute final
    /// velocity and displacement divided by their peaks.
    pub fn of(time_step: f64, acceleration: &[f64], initial_velocity: f64) -> Self {
        let (v, d) = integrate(time_step, acceleration, initial_velocity);
        let ratio = |values: &[f64]| {
            let peak = math::peak(values);
            match values.last() {
                Some(last) if peak > 0.0 => last.abs() / peak,
                _ => 0.0,
            }
        };
        Self { velocity: ratio(&v), displacement: ratio(&d) }
    }

    /// Returns `true` if the final velocity is below 0.1 % of PGV and the final displacement is
    /// below 1 % of PGD.
    pub fn acceptable(&self) -> bool {
        self.velocity < 1e-3 && self.displacement < 1e-2
    }

    fn sentence(self) -> String {
        // Rounding errors of a motion at rest are not shown.
        let share = |value: f64| match value {
            v if v < 1e-6 => "less than 1e-6".to_owned(),
            v => format!("{v:.1e}"),
        };
        let [velocity, displacement] = [self.velocity, self.displacement].map(share);
        let values = format!(
            "ends with a velocity of {velocity} times PGV and a displacement of {displacement} times PGD"
        );
        if self.acceptable() {
            values
        } else {
            format!(
                "{values} (limits 1e-3 and 1e-2): the ground does not return to rest at its initial position"
            )
        }
    }
}

/// Returns the number of quiet samples before the first arrival, limited to 5 s; `None` if the quiet part is shorter
/// than half a second.
///
/// The arrival is the first sample that differs from the mean of the first half second by more than
/// 5 % of the peak. The half second before the arrival is excluded.
fn quiet_samples(time_step: f64, a: &[f64]) -> Option<usize> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, small")]
    let samples = |seconds: f64| (seconds / time_step).ceil().min(1e9) as usize;
    let half_second = samples(0.5);
    if a.len() < 2 * half_second {
        return None;
    }
    let level = math::mean(&a[..half_second]);
    let peak = a.iter().fold(0.0_f64, |peak, value| peak.max((value - level).abs()));
    let arrival = a.iter().position(|value| (value - level).abs() > 0.05 * peak)?;
    let quiet = arrival.saturating_sub(half_second).min(samples(5.0));
    (quiet >= half_second).then_some(quiet)
}

/// Subtracts the least-squares straight line.
fn remove_line(a: &mut [f64]) {
    let middle = 0.5 * (a.len() as f64 - 1.0);
    let mean = math::mean(a);
    let (mut product, mut square) = (0.0, 0.0);
    for (k, value) in a.iter().enumerate() {
        let x = k as f64 - middle;
        product += x * value;
        square += x * x;
    }
    let slope = if square > 0.0 { product / square } else { 0.0 };
    for (k, value) in a.iter_mut().enumerate() {
        *value -= mean + slope * (k as f64 - middle);
    }
}

/// Applies a half-cosine taper at each end, over a fraction of the length.
pub(crate) fn taper_ends(a: &mut [f64], fraction: f64) {
    let n = a.len();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to n/2")]
    let width = (fraction * n as f64).round() as usize;
    for k in 0..width.min(n) {
        let weight = 0.5 * (1.0 - math::cos(PI * k as f64 / width as f64));
        a[k] *= weight;
        a[n - 1 - k] *= weight;
    }
}

/// Adds `c₁ s² + c₂ s² cos(π t/T)` with `s = sin(π t/T)`, so that velocity and displacement are
/// zero at the end. Both terms start and end smoothly at zero.
pub(crate) fn close_ends(
    time_step: f64,
    a: &mut [f64],
    initial_velocity: f64,
    steps: &mut Vec<String>,
) {
    let n = a.len();
    if n < 3 {
        return;
    }
    let term = |k: usize, odd: bool| {
        let (s, c) = math::sin_cos(PI * k as f64 / (n - 1) as f64);
        if odd { s * s * c } else { s * s }
    };
    let ends = |values: &[f64], v0: f64| {
        let (v, d) = integrate(time_step, values, v0);
        (v[n - 1], d[n - 1])
    };
    let even: Vec<f64> = (0..n).map(|k| term(k, false)).collect();
    let odd: Vec<f64> = (0..n).map(|k| term(k, true)).collect();
    let (even_v, even_d) = ends(&even, 0.0);
    let (odd_v, odd_d) = ends(&odd, 0.0);
    let determinant = even_v * odd_d - odd_v * even_d;
    let mut largest = 0.0_f64;
    // The second pass removes the rounding errors left by the first.
    for _ in 0..2 {
        let (v, d) = ends(a, initial_velocity);
        let c1 = -(v * odd_d - odd_v * d) / determinant;
        let c2 = -(even_v * d - v * even_d) / determinant;
        if !(c1.is_finite() && c2.is_finite()) {
            return;
        }
        for (k, value) in a.iter_mut().enumerate() {
            let correction = c1 * even[k] + c2 * odd[k];
            largest = largest.max(correction.abs());
            *value += correction;
        }
    }
    let pga = math::peak(a);
    let share = if pga > 0.0 { largest / pga } else { 0.0 };
    steps.push(format!(
        "final velocity and displacement brought to zero by a smooth acceleration of at most {largest:.1e} m/s2 ({share:.1e} of PGA)"
    ));
}
