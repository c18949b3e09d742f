//! Classifies pulse-like ground motions by two published methods.

mod wavelet;

use crate::error::MotionError;
use crate::math;
use crate::sampled::Sampled;

use wavelet::{Pair, Wavelet};

/// Shortest and longest period of a pulse (s).
const PERIODS: (f64, f64) = (0.25, 15.0);
/// Number of intervals between the smallest and the largest wavelet scale, which correspond to
/// [`PERIODS`].
const SCALES: usize = 50;
/// Number of wavelets that form a pulse.
const WAVELETS: usize = 10;
/// Largest distance in time between consecutive wavelets of a pulse, as a multiple of the wavelet
/// scale. Once a pulse has been found, the part of the record within this distance of it is
/// excluded from later searches.
const REACH: f64 = 0.4;
/// Number of candidate pulses examined in a pair of components.
const PULSES: usize = 5;
/// Largest time step (s) to which velocities are decimated: 1/25 of the shortest period.
const STEP: f64 = 0.01;

/// A velocity pulse, extracted as a sum of wavelets, with its classification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassifiedPulse {
    /// `true` if the motion is pulse-like.
    pub pulse_like: bool,
    /// Pulse indicator. A motion may be pulse-like if the indicator is above 0.85 (Baker 2007) or
    /// above 0 (Shahi and Baker 2014).
    pub indicator: f64,
    /// Period of the pulse (s).
    pub period: f64,
    /// `true` if the pulse arrives too late to be a directivity pulse.
    pub late: bool,
    /// Direction of the component that contains the pulse (degrees from the first component toward
    /// the second, 0 to below 180); 0 for a single component.
    pub angle: f64,
    /// Peak velocity of the component that contains the pulse (m/s).
    pub pgv: f64,
}

/// Classifies one component by the method of Baker (2007, BSSA 97:1486-1501):
///
/// ```text
/// PI = 1/(1 + exp(−23.3 + 14.6 PGV ratio + 20.5 energy ratio))
/// ```
///
/// Each ratio is the value for the motion without the pulse divided by the value for the whole
/// motion.
///
/// The motion is pulse-like if PI exceeds 0.85, PGV is at least 30 cm/s, and the pulse reaches 10 %
/// of its energy before the motion reaches 20 % of its energy.
///
/// # Errors
/// If the motion is shorter than the shortest pulse, or its velocity is zero.
pub fn classify_component(motion: &Sampled) -> Result<ClassifiedPulse, MotionError> {
    let thin = Thinned::of(motion, None)?;
    let [map, ..] = Map::of(&thin);
    single(&thin.first, thin.time_step, &map)
}

/// Classifies two horizontal components, separately and jointly.
///
/// Each component is classified as by [`classify_component`]. The joint classification examines
/// five candidate pulses, in the directions of the five strongest wavelets (Shahi and Baker 2014,
/// BSSA 104:2456-2466), with PGV in cm/s:
///
/// ```text
/// PC = 0.63 PGV ratio + 0.777 energy ratio
/// PI = 9.384 (0.76 − PC − 0.0616 PGV)(PC + 6.914·10⁻⁴ PGV − 1.072) − 6.179
/// ```
///
/// The motion is pulse-like if, for one of these pulses, PI is positive and the pulse reaches 5 %
/// of its energy before the motion reaches 17 % of its energy. Returns the first such pulse, or
/// else the strongest pulse.
///
/// # Errors
/// The same as for [`classify_component`], and if the time steps differ.
pub fn classify_pair(
    first: &Sampled,
    second: &Sampled,
) -> Result<([ClassifiedPulse; 2], ClassifiedPulse), MotionError> {
    let thin = Thinned::of(first, Some(second))?;
    let [one, two, both] = Map::of(&thin);
    let singles =
        [single(&thin.first, thin.time_step, &one)?, single(&thin.second, thin.time_step, &two)?];
    Ok((singles, double(&thin, both)?))
}

fn single(velocity: &[f64], time_step: f64, map: &Map) -> Result<ClassifiedPulse, MotionError> {
    let found = map.strongest().ok_or_else(still)?;
    let pulse = Extracted::of(velocity, time_step, found);
    let (pgv_ratio, energy_ratio) = pulse.ratios(velocity);
    let exponent = -23.3 + 14.6 * pgv_ratio + 20.5 * energy_ratio;
    let indicator = 1.0 / (1.0 + math::exp(exponent));
    let late = time_of(velocity, 0.2) <= time_of(&pulse.velocity, 0.1);
    let pgv = math::peak(velocity);
    Ok(ClassifiedPulse {
        pulse_like: indicator > 0.85 && pgv >= 0.3 && !late,
        indicator,
        period: wavelet::period(pulse.scale),
        late,
        angle: 0.0,
        pgv,
    })
}

fn double(thin: &Thinned, mut map: Map) -> Result<ClassifiedPulse, MotionError> {
    let mut best: Option<ClassifiedPulse> = None;
    for _ in 0..PULSES {
        let Some(found) = map.strongest() else { break };
        let (x, y) = found.coefficients;
        let length = math::hypot(x, y);
        let (c, s) = (x / length, y / length);
        let along: Vec<f64> =
            thin.first.iter().zip(&thin.second).map(|(a, b)| a * c + b * s).collect();
        let pulse = Extracted::of(&along, thin.time_step, found);
        let (pgv_ratio, energy_ratio) = pulse.ratios(&along);
        let pgv = math::peak(&along);
        let cm = 100.0 * pgv;
        let pc = 0.63 * pgv_ratio + 0.777 * energy_ratio;
        let indicator = 9.384 * (0.76 - pc - 0.0616 * cm) * (pc + 6.914e-4 * cm - 1.072) - 6.179;
        let start = time_of(&pulse.velocity, 0.05);
        let late = energy_until(&along, start) >= 0.17;
        let judged = ClassifiedPulse {
            pulse_like: indicator > 0.0 && !late,
            indicator,
            period: wavelet::period(pulse.scale),
            late,
            angle: half_turn(math::atan2(s, c).to_degrees()),
            pgv,
        };
        if judged.pulse_like {
            return Ok(judged);
        }
        best = best.or(Some(judged));
        map.take_out(found);
    }
    best.ok_or_else(still)
}

/// Reduces an angle (degrees) to the range from 0 to below 180.
fn half_turn(degrees: f64) -> f64 {
    // The remainder of a tiny negative angle is rounded to 180.
    let angle = degrees.rem_euclid(180.0);
    if angle < 180.0 { angle } else { 0.0 }
}

fn still() -> MotionError {
    MotionError::parameter("motion", "a velocity other than zero", "zero")
}

/// Velocities (m/s) of both components; those of the second are zero for a single component.
///
/// They are decimated to the largest multiple of the original time step that does not exceed [`STEP`]. If the original
/// time step is already larger, every sample is kept.
struct Thinned {
    time_step: f64,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Thinned {
    fn of(first: &Sampled, second: Option<&Sampled>) -> Result<Self, MotionError> {
        let dt = first.time_step();
        second.map_or(Ok(()), |second| first.require_step(second))?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 1")]
        let every = (STEP / dt * (1.0 + 1e-9)).floor().clamp(1.0, 1e6) as usize;
        let thin = |motion: &Sampled| -> Vec<f64> {
            motion.velocity().iter().copied().step_by(every).collect()
        };
        let mut one = thin(first);
        let mut two = second.map_or_else(|| vec![0.0; one.len()], thin);
        let common = one.len().min(two.len());
        one.truncate(common);
        two.truncate(common);
        let time_step = dt * every as f64;
        let duration = time_step * common as f64;
        if duration < PERIODS.0 {
            return Err(MotionError::parameter(
                "duration (s)",
                format!("at least the shortest pulse, {} s", PERIODS.0),
                duration,
            ));
        }
        Ok(Self { time_step, first: one, second: two })
    }
}

/// A wavelet at one time and scale, with its coefficients in both components.
#[derive(Clone, Copy)]
struct WaveletAt {
    /// Lower and upper limit (s) between which the scale of the pulse is refined.
    scales: (f64, f64),
    scale: f64,
    at: usize,
    coefficients: (f64, f64),
}

impl WaveletAt {
    /// Returns the squared norm of the two coefficients.
    fn strength(self) -> f64 {
        let (x, y) = self.coefficients;
        x * x + y * y
    }
}

/// For each sample, the strongest wavelet over all scales.
struct Map {
    best: Vec<Option<WaveletAt>>,
    time_step: f64,
}

impl Map {
    /// Computes three maps: for the first component, for the second, and for both together.
    fn of(thin: &Thinned) -> [Self; 3] {
        let (least, largest) = (wavelet::scale(PERIODS.0), wavelet::scale(PERIODS.1));
        let step = (largest - least) / SCALES as f64;
        let wavelet = |k: usize| Wavelet::new(least + step * k as f64, thin.time_step);
        let pair = Pair::new(&thin.first, &thin.second, &wavelet(SCALES));
        let empty = || Self { best: vec![None; thin.first.len()], time_step: thin.time_step };
        let mut maps = [empty(), empty(), empty()];
        for k in 0..=SCALES {
            let scale = least + step * k as f64;
            let scales = ((scale - step).max(least), (scale + step).min(largest));
            for (at, (x, y)) in pair.coefficients(&wavelet(k)).into_iter().enumerate() {
                let views = [(x, 0.0), (0.0, y), (x, y)];
                for (map, coefficients) in maps.iter_mut().zip(views) {
                    let next = WaveletAt { scales, scale, at, coefficients };
                    let before = map.best[at].map_or(0.0, WaveletAt::strength);
                    if next.strength() > before {
                        map.best[at] = Some(next);
                    }
                }
            }
        }
        maps
    }

    fn strongest(&self) -> Option<WaveletAt> {
        let found = self.best.iter().flatten().copied();
        found.reduce(|best, next| if next.strength() > best.strength() { next } else { best })
    }

    /// Excludes the part of the record around a pulse from later searches.
    fn take_out(&mut self, found: WaveletAt) {
        let reach = reach(found.scale, self.time_step);
        let last = (found.at + reach).min(self.best.len() - 1);
        self.best[found.at.saturating_sub(reach)..=last].fill(None);
    }
}

/// Returns [`REACH`] as a number of samples, for a pulse of the given scale (s).
fn reach(scale: f64, time_step: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let samples = (REACH * scale / time_step).ceil() as usize;
    samples
}

/// A pulse extracted from a velocity history.
struct Extracted {
    scale: f64,
    velocity: Vec<f64>,
}

impl Extracted {
    /// Extracts ten wavelets of one scale, one after the other. Each is the strongest wavelet near
    /// the previous one, in the motion that remains after the previous wavelets are subtracted.
    fn of(velocity: &[f64], time_step: f64, found: WaveletAt) -> Self {
        let (low, high) = found.scales;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
        let finer = ((high - low) / time_step).round().max(1.0) as usize;
        let mut best = (found.scale, 0.0_f64);
        for k in 0..=finer {
            let scale = low + (high - low) * k as f64 / finer as f64;
            let size = Wavelet::new(scale, time_step).coefficient(velocity, found.at).abs();
            if size > best.1 {
                best = (scale, size);
            }
        }
        let scale = best.0;
        let wavelet = Wavelet::new(scale, time_step);
        let pair = Pair::new(velocity, &vec![0.0; velocity.len()], &wavelet);
        let mut left: Vec<f64> = pair.coefficients(&wavelet).into_iter().map(|c| c.0).collect();
        let overlap = wavelet.overlap();
        let reach = reach(scale, time_step);
        let mut pulse = vec![0.0; velocity.len()];
        // Each wavelet is searched for near the previous one, as in the program of the authors.
        let mut at = found.at;
        for _ in 0..WAVELETS {
            let near = at.saturating_sub(reach)..=(at + reach).min(velocity.len() - 1);
            at = near.fold(at, |best, k| if left[k].abs() > left[best].abs() { k } else { best });
            let factor = left[at];
            wavelet.add_to(&mut pulse, at, factor);
            for (k, value) in left.iter_mut().enumerate() {
                if let Some(overlap) = overlap.get(k.abs_diff(at)) {
                    *value -= factor * overlap;
                }
            }
        }
        Self { scale, velocity: pulse }
    }

    /// Returns the peak velocity and the energy of the motion without the pulse, each relative to
    /// the whole motion.
    fn ratios(&self, whole: &[f64]) -> (f64, f64) {
        let left: Vec<f64> = whole.iter().zip(&self.velocity).map(|(a, b)| a - b).collect();
        let energy = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
        (math::peak(&left) / math::peak(whole), energy(&left) / energy(whole))
    }
}

/// Returns the index of the first sample at which the cumulative sum of squares exceeds a fraction of the total.
fn time_of(values: &[f64], share: f64) -> usize {
    let total: f64 = values.iter().map(|v| v * v).sum();
    let mut sum = 0.0;
    values
        .iter()
        .position(|v| {
            sum += v * v;
            sum > share * total
        })
        .unwrap_or(0)
}

/// Returns the sum of squares before a sample as a fraction of the total.
fn energy_until(values: &[f64], sample: usize) -> f64 {
    let energy = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
    energy(&values[..sample]) / energy(values)
}
