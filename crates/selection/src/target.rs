//! Target of a selection: mean and spread of ln Sa, optionally conditional on the value of Sa at one period.

use barrelstack_motion::{MotionError, Random, TargetSpectrum};

use crate::correlation::spectral_correlation;

/// Periods (s) at which records are matched to a code spectrum.
pub const PERIODS: [f64; 22] = [
    0.05, 0.075, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9, 1.0, 1.25, 1.5, 2.0,
    2.5, 3.0, 4.0, 5.0, 7.5,
];

/// Condition of a conditional spectrum: a spectral acceleration at one period, the conditioning period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Period (s), which must be one of the periods of the target.
    pub period: f64,
    /// Pseudo-acceleration (m/s²) at the period.
    pub acceleration: f64,
}

impl Condition {
    /// Creates a condition in which ln Sa is `epsilon` standard deviations above the logarithm of the median
    /// (m/s²).
    pub fn at_epsilon(period: f64, median: f64, deviation: f64, epsilon: f64) -> Self {
        Self { period, acceleration: median * libm::exp(deviation * epsilon) }
    }
}

/// Mean, standard deviation and covariance of ln Sa at a list of periods.
#[derive(Clone, Debug, PartialEq)]
pub struct SelectionTarget {
    periods: Vec<f64>,
    /// Mean of ln Sa at each period; Sa is in m/s².
    mean: Vec<f64>,
    deviation: Vec<f64>,
    /// Covariance matrix of ln Sa, in row-major order.
    covariance: Vec<f64>,
    condition: Option<Condition>,
}

impl SelectionTarget {
    /// Creates a target from the medians of Sa (m/s²) and the standard deviations of ln Sa that a
    /// ground-motion model gives at ascending periods (s).
    ///
    /// With a condition, the target is the conditional spectrum (Baker 2011, Journal of Structural Engineering
    /// 137:322-331):
    ///
    /// ```text
    /// ε   = (ln Sa* − ln median*)/σ*
    /// μᵢ  = ln medianᵢ + σᵢ ρ(Tᵢ, T*) ε
    /// Cᵢⱼ = σᵢ σⱼ (ρ(Tᵢ, Tⱼ) − ρ(Tᵢ, T*) ρ(Tⱼ, T*))
    /// ```
    ///
    /// # Errors
    /// If there are fewer than two periods, if the lists differ in length, if the periods are not in ascending order,
    /// if a number is out of range, or if the conditioning period is not one of the periods.
    pub fn new(
        periods: &[f64],
        median: &[f64],
        deviation: &[f64],
        condition: Option<Condition>,
    ) -> Result<Self, MotionError> {
        let n = periods.len();
        MotionError::require(
            n >= 2 && median.len() == n && deviation.len() == n,
            "target of a selection",
            "at least 2 periods, each with a median and a standard deviation",
            format!("{n}, {} and {}", median.len(), deviation.len()),
        )?;
        for k in 0..n {
            let row = |what: &str| format!("target of a selection, row {}, {what}", k + 1);
            MotionError::require_positive(&row("period (s)"), periods[k])?;
            MotionError::require_positive(&row("median (m/s2)"), median[k])?;
            let within = (0.0..=5.0).contains(&deviation[k]);
            let what = row("standard deviation of ln Sa");
            MotionError::require(within, what, "0 to 5", deviation[k])?;
            let before = k.checked_sub(1).map_or(0.0, |before| periods[before]);
            let above = format!("above {before}");
            MotionError::require(periods[k] > before, row("period (s)"), above, periods[k])?;
        }
        let mut mean: Vec<f64> = median.iter().map(|m| libm::log(*m)).collect();
        let mut to_condition = vec![0.0; n];
        if let Some(given) = condition {
            MotionError::require_positive("given acceleration (m/s2)", given.acceleration)?;
            let at = periods.iter().position(|t| *t == given.period).ok_or_else(|| {
                let listed: Vec<String> = periods.iter().map(f64::to_string).collect();
                let expected = format!("one of the periods of the target, {}", listed.join(", "));
                MotionError::parameter("period of the condition (s)", expected, given.period)
            })?;
            MotionError::require_positive("standard deviation at the condition", deviation[at])?;
            let epsilon = (libm::log(given.acceleration) - mean[at]) / deviation[at];
            for k in 0..n {
                to_condition[k] = spectral_correlation(periods[k], given.period);
                mean[k] += deviation[k] * to_condition[k] * epsilon;
            }
        }
        let mut covariance = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                let left = spectral_correlation(periods[i], periods[j])
                    - to_condition[i] * to_condition[j];
                covariance[i * n + j] = deviation[i] * deviation[j] * left;
            }
        }
        let deviation = (0..n).map(|k| covariance[k * n + k].max(0.0).sqrt()).collect();
        Ok(Self { periods: periods.to_vec(), mean, deviation, covariance, condition })
    }

    /// Creates a target without spread from the values of a spectrum.
    ///
    /// # Errors
    /// As for [`SelectionTarget::new`].
    pub fn of_spectrum(spectrum: &TargetSpectrum, periods: &[f64]) -> Result<Self, MotionError> {
        spectrum.check()?;
        let median: Vec<f64> = periods.iter().map(|t| spectrum.acceleration(*t)).collect();
        Self::new(periods, &median, &vec![0.0; periods.len()], None)
    }

    /// Returns the periods (s), in ascending order.
    pub fn periods(&self) -> &[f64] {
        &self.periods
    }

    /// Returns the mean of ln Sa at each period; Sa is in m/s².
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Returns the standard deviation of ln Sa at each period.
    pub fn deviation(&self) -> &[f64] {
        &self.deviation
    }

    /// Returns the condition and the index of its period; `None` if the target is not conditional.
    pub fn condition(&self) -> Option<(usize, Condition)> {
        let given = self.condition?;
        Some((self.periods.iter().position(|t| *t == given.period)?, given))
    }

    /// Draws spectra (ln Sa) from the normal distribution of the target.
    pub(super) fn draw(&self, count: usize, random: &mut Random) -> Vec<Vec<f64>> {
        let n = self.periods.len();
        let root = self.cholesky();
        let one = |random: &mut Random| {
            let deviates: Vec<f64> = (0..n).map(|_| random.normal()).collect();
            let along = |i: usize| (0..=i).map(|j| root[i * n + j] * deviates[j]).sum::<f64>();
            (0..n).map(|i| self.mean[i] + along(i)).collect()
        };
        (0..count).map(|_| one(random)).collect()
    }

    /// Returns the lower triangular Cholesky factor `L` of the covariance matrix `L Lᵀ`.
    ///
    /// Some columns are zero: the column of the conditioning period, and the column of any period at which ln Sa is
    /// determined by its values at the preceding periods. Published correlations are rounded, so small negative pivots
    /// occur; their columns are zero, too.
    fn cholesky(&self) -> Vec<f64> {
        let n = self.periods.len();
        let mut root = vec![0.0; n * n];
        for j in 0..n {
            let before: f64 = (0..j).map(|k| root[j * n + k] * root[j * n + k]).sum();
            let pivot = self.covariance[j * n + j] - before;
            if pivot <= 1e-10 {
                continue;
            }
            let pivot = pivot.sqrt();
            root[j * n + j] = pivot;
            for i in j + 1..n {
                let dot: f64 = (0..j).map(|k| root[i * n + k] * root[j * n + k]).sum();
                root[i * n + j] = (self.covariance[i * n + j] - dot) / pivot;
            }
        }
        root
    }
}
