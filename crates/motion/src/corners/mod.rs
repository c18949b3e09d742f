//! Suggests filter corners from the frequency band in which the shaking exceeds the noise that was
//! recorded before it.

mod arrival;
mod smooth;

use crate::error::MotionError;
use crate::fourier::forward_real;
use crate::math;
use crate::process::taper_ends;
use crate::record::{Channel, Record};

use arrival::arrival;
use smooth::konno_ohmachi;

/// Minimum duration (s) of the noise from which corners can be determined.
const SHORTEST_NOISE: f64 = 1.0;
/// Minimum duration (s) of the shaking from which corners can be determined.
const SHORTEST_SHAKING: f64 = 5.0;
/// Length of the taper at each end of a series, as a fraction of the length of the series. The
/// noise and the shaking are tapered separately.
const TAPER: f64 = 0.05;
/// Upper limits of the low-pass corner. The first is a fraction of the Nyquist frequency, the
/// second is in Hz.
const HIGHEST: (f64, f64) = (0.75, 40.0);

/// Criterion on the signal-to-noise ratio, with its frequency range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseCriterion {
    /// Minimum ratio of the smoothed Fourier amplitudes of signal and noise.
    pub ratio: f64,
    /// Lowest frequency of the criterion (Hz); the high-pass corner is at or below this frequency.
    pub from: f64,
    /// Highest frequency of the criterion (Hz); the low-pass corner is above this frequency.
    pub to: f64,
    /// Coefficient `b` of the smoothing window of Konno and Ohmachi (1998).
    pub bandwidth: f64,
}

impl Default for NoiseCriterion {
    /// Returns a criterion with a ratio of 3 from 0.2 to 5 Hz, smoothed with `b` = 20.
    fn default() -> Self {
        Self { ratio: 3.0, from: 0.2, to: 5.0, bandwidth: 20.0 }
    }
}

/// Filter corners suggested by the noise of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corners {
    /// High-pass corner (Hz).
    pub high_pass: f64,
    /// Low-pass corner (Hz).
    pub low_pass: f64,
    /// Time (s) from the first sample to the first arrival, where the noise ends.
    pub arrival: f64,
    /// Smallest signal-to-noise ratio in the frequency range of the criterion.
    pub least_ratio: f64,
}

impl Corners {
    /// Describes the corners, the duration of the noise, and the smallest signal-to-noise ratios, for messages and
    /// notes.
    pub fn sentence(&self, criterion: &NoiseCriterion) -> String {
        let unknown = 1.0 / self.arrival;
        format!(
            "corners {:.4} and {:.2} Hz; between them, the signal is at least {} times the noise of \
             the first {:.2} s, and at least {:.1} times this noise from {} to {} Hz{}",
            self.high_pass,
            self.low_pass,
            criterion.ratio,
            self.arrival,
            self.least_ratio,
            criterion.from,
            criterion.to,
            if self.high_pass < unknown {
                format!(" (the noise is too short to resolve frequencies below {unknown:.2} Hz)")
            } else {
                String::new()
            }
        )
    }
}

/// Frequencies (Hz), and the signal-to-noise ratio of a channel at each of them.
struct Spectra {
    frequency: Vec<f64>,
    /// Signal-to-noise ratio at each frequency, as defined by [`noise_corners`].
    ratio: Vec<f64>,
}

/// Returns the filter corners of one channel whose noise ends at `arrival` (s).
///
/// The spectrum of the noise is multiplied by `r = √(length of the shaking / length of the noise)`.
/// The product is the spectrum of the noise within the shaking. The signal is the spectrum of the
/// shaking minus this product. The signal-to-noise ratio is divided by `r`, so that the criterion
/// is stricter if the noise is short.
///
/// The corners are the ends of the first frequency band that has a sufficient ratio and covers the frequency range of
/// the criterion. The high-pass corner has two lower limits: the reciprocal of the duration, and the foot of the ratio.
/// To find the foot, only frequencies below the peak of the ratio are considered; the foot is the frequency at which
/// the ratio is smallest in this range. The low-pass corner has two upper limits: 0.75 of the Nyquist frequency, and 40
/// Hz. The automatic processing of the USGS uses this rule (Hearne et al. 2019; Ramos-Sepúlveda et al. 2023).
///
/// # Errors
/// If there is less than 1 s of noise or 5 s of shaking, if the noise is below the resolution of the file, or if the
/// criterion is not satisfied.
pub fn noise_corners(
    channel: &Channel,
    arrival: f64,
    criterion: &NoiseCriterion,
) -> Result<Corners, MotionError> {
    let refuse = |what: String| {
        let what = format!("channel {}: {what}", channel.name);
        MotionError::mismatch(what, "specify the corners")
    };
    let (dt, a) = (channel.time_step, &channel.acceleration);
    let split = samples(arrival, dt).min(a.len());
    if arrival < SHORTEST_NOISE {
        return Err(refuse(format!(
            "the record has {arrival:.2} s of noise before the shaking; at least {SHORTEST_NOISE} s are needed"
        )));
    }
    let shaking = (a.len() - split) as f64 * dt;
    if shaking < SHORTEST_SHAKING {
        return Err(refuse(format!(
            "the record has {shaking:.2} s of shaking after the arrival; at least {SHORTEST_SHAKING} s are needed"
        )));
    }
    let first = a[0];
    if a[..split].iter().all(|value| *value == first) {
        return Err(refuse(format!(
            "in the {arrival:.2} s before the shaking, the noise is below the resolution of the file"
        )));
    }
    let spectra = Spectra::of(dt, &a[..split], &a[split..], criterion.bandwidth);
    let (low, high) = spectra.band(criterion).ok_or_else(|| {
        refuse(format!(
            "the signal-to-noise ratio falls to {:.2} between {} and {} Hz; at least {} is needed",
            spectra.least(criterion),
            criterion.from,
            criterion.to,
            criterion.ratio
        ))
    })?;
    let high_pass = low.max(1.0 / channel.duration()).max(spectra.foot());
    let low_pass = high.min(HIGHEST.0 * 0.5 / dt).min(HIGHEST.1);
    Ok(Corners { high_pass, low_pass, arrival, least_ratio: spectra.least(criterion) })
}

impl Record {
    /// Returns the filter corners of every channel, in order.
    ///
    /// Both horizontal components are assigned the overlap of their two frequency bands, so that they can be rotated
    /// together. All channels use the earliest arrival of any channel.
    pub fn noise_corners(&self, criterion: &NoiseCriterion) -> Vec<Result<Corners, MotionError>> {
        let first = self
            .channels
            .iter()
            .map(|channel| arrival(channel.time_step, &channel.acceleration))
            .fold(f64::INFINITY, f64::min);
        let mut found: Vec<Result<Corners, MotionError>> =
            self.channels.iter().map(|c| noise_corners(c, first, criterion)).collect();
        let flat: Vec<bool> = self.channels.iter().map(|channel| !channel.is_vertical()).collect();
        let mut band = (0.0_f64, f64::INFINITY);
        for (corners, _) in found.iter().zip(&flat).filter(|(_, flat)| **flat) {
            let Ok(corners) = corners else { return found };
            band = (band.0.max(corners.high_pass), band.1.min(corners.low_pass));
        }
        for (corners, _) in found.iter_mut().zip(&flat).filter(|(_, flat)| **flat) {
            if let Ok(corners) = corners {
                (corners.high_pass, corners.low_pass) = band;
            }
        }
        found
    }
}

impl Spectra {
    fn of(dt: f64, noise: &[f64], shaking: &[f64], bandwidth: f64) -> Self {
        let length = noise.len().max(shaking.len()).next_power_of_two();
        let frequency: Vec<f64> =
            (0..=length / 2).map(|k| k as f64 / (length as f64 * dt)).collect();
        let centers = math::log_space(frequency[1], frequency[length / 2], 300);
        let smooth = |part: &[f64]| -> Vec<f64> {
            let mean = math::mean(part);
            let mut part: Vec<f64> = part.iter().map(|a| a - mean).collect();
            taper_ends(&mut part, TAPER);
            let amplitude: Vec<f64> =
                forward_real(&part, length)[..=length / 2].iter().map(|x| x.norm()).collect();
            konno_ohmachi(&frequency, &amplitude, &centers, bandwidth)
        };
        let stretch = (shaking.len() as f64 / noise.len() as f64).sqrt();
        let ratio = smooth(shaking)
            .iter()
            .zip(smooth(noise))
            .map(|(all, noise)| (all - stretch * noise) / (stretch * noise) / stretch)
            .collect::<Vec<f64>>();
        // Frequencies below the reciprocal of the length of the shaking cannot be resolved.
        let known = 1.0 / (shaking.len() as f64 * dt);
        let first = centers.partition_point(|f| *f < known);
        Self { frequency: centers[first..].to_vec(), ratio: ratio[first..].to_vec() }
    }

    /// Returns the first frequency band that has sufficient signal and covers the frequency range
    /// of the criterion.
    fn band(&self, criterion: &NoiseCriterion) -> Option<(f64, f64)> {
        let enough = |ratio: &f64| *ratio >= criterion.ratio;
        let mut begin = 0;
        for stretch in self.ratio.chunk_by(|one, next| enough(one) == enough(next)) {
            let end = begin + stretch.len();
            let (low, high) = (self.frequency[begin], self.frequency[end - 1]);
            if enough(&stretch[0]) && low <= criterion.from && high > criterion.to {
                return Some((low, high));
            }
            begin = end;
        }
        None
    }

    /// Returns the smallest signal-to-noise ratio in the frequency range of the criterion; infinite
    /// if the spectra have no frequency in this range.
    fn least(&self, criterion: &NoiseCriterion) -> f64 {
        let inside = self.frequency.iter().zip(&self.ratio);
        inside
            .filter(|(f, _)| (criterion.from..=criterion.to).contains(*f))
            .fold(f64::INFINITY, |least, (_, ratio)| least.min(*ratio))
    }

    /// Returns the foot of the signal-to-noise ratio: in the range of frequencies below the peak of the
    /// ratio, the frequency at which the ratio is smallest. Below the foot, drift raises the ratio.
    fn foot(&self) -> f64 {
        let best = |range: std::ops::Range<usize>, sign: f64| {
            range.reduce(
                |best, k| {
                    if sign * self.ratio[k] > sign * self.ratio[best] { k } else { best }
                },
            )
        };
        best(0..self.ratio.len(), 1.0)
            .and_then(|peak| best(0..peak, -1.0))
            .map_or(0.0, |foot| self.frequency[foot])
    }
}

fn samples(seconds: f64, dt: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative")]
    let n = (seconds / dt).round().clamp(0.0, 1e9) as usize;
    n
}
