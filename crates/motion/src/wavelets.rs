//! Time-domain matching: wavelets added where the responses peak.

use crate::error::MotionError;
use crate::matching::{Best, GOOD_ENOUGH, Matching, Work, matched_periods};
use crate::math::{self, TAU};
use crate::response::Step;

/// Share of the misfit taken out in one round; more makes peaks jump to other times.
const RELAXATION: f64 = 0.6;
/// Other extrema above this share of the target are watched too, so that taking out one peak does
/// not raise another.
const WATCHED: f64 = 0.85;
/// Weight of a watched extremum that is not too high.
const WATCHED_WEIGHT: f64 = 0.4;
/// Ridge relative to the largest diagonal entry, which keeps neighbors from fighting.
const RIDGE: f64 = 1e-2;

/// A local extremum of an oscillator's response.
#[derive(Clone, Copy)]
struct Extremum {
    sample: usize,
    /// Signed pseudo-acceleration (m/s²).
    value: f64,
}

/// One matched period.
struct Oscillator {
    period: f64,
    /// Target pseudo-acceleration (m/s²).
    goal: f64,
    step: Step,
}

/// One equation: the response of an oscillator at `sample` shall change by `change`.
struct Demand {
    oscillator: usize,
    sample: usize,
    change: f64,
    weight: f64,
}

/// Rounds of linear systems: the responses of all wavelets at all peak times against the misfits.
pub(crate) fn match_in_time(
    work: &Work<'_>,
    start: &[f64],
    settings: &Matching,
) -> Result<(Vec<f64>, usize), MotionError> {
    let n = start.len();
    let mut a = work.close(start)?;
    let mut best = Best::new(&a);
    for round in 1..=settings.rounds {
        // Far from the target the peaks alone lead on fastest.
        let watching = round > 2 * settings.rounds / 3;
        if round == 2 * settings.rounds / 3 + 1 && best.round > 0 {
            a.clone_from(&best.acceleration);
        }
        let oscillators: Vec<Oscillator> = matched_periods(settings, round)
            .into_iter()
            .map(|period| Oscillator {
                period,
                goal: work.target.acceleration(period),
                step: Step::new(period, work.damping, work.time_step),
            })
            .collect();
        let mut wavelets = Vec::with_capacity(oscillators.len());
        let mut demands = Vec::new();
        for (k, oscillator) in oscillators.iter().enumerate() {
            let threshold = if watching { WATCHED * oscillator.goal } else { f64::INFINITY };
            let extrema = extrema(&a, oscillator, threshold);
            let peak = demand(&extrema, k, oscillator, work.time_step, &mut demands);
            let period = oscillator.period;
            wavelets.push(Wavelet::new(period, work.damping, work.time_step, peak.sample, n));
        }
        best.offer(&a, work.misfit(&a)?, round);
        if best.misfit <= GOOD_ENOUGH * settings.tolerance {
            break;
        }
        let amplitudes = solve(work, &oscillators, &wavelets, &demands);
        for (wavelet, amplitude) in wavelets.iter().zip(&amplitudes) {
            for (value, shape) in a[wavelet.first..].iter_mut().zip(&wavelet.values) {
                *value += amplitude * shape;
            }
        }
        a = work.close(&a)?;
    }
    Ok((best.acceleration, best.round))
}

/// Least-squares amplitudes of the wavelets for the demands, which are in order of period.
fn solve(
    work: &Work<'_>,
    oscillators: &[Oscillator],
    wavelets: &[Wavelet],
    demands: &[Demand],
) -> Vec<f64> {
    let count = wavelets.len();
    let mut system = System::new(count);
    for group in demands.chunk_by(|a, b| a.oscillator == b.oscillator) {
        let oscillator = &oscillators[group[0].oscillator];
        let mut rows = vec![0.0; group.len() * count];
        for (j, wavelet) in wavelets.iter().enumerate() {
            let free = FreeVibration::new(oscillator.period, work.damping, work.time_step);
            let mut state = (0.0, 0.0);
            let mut at = wavelet.first;
            for (i, demand) in group.iter().enumerate() {
                let u =
                    wavelet.advance(&oscillator.step, &free, &mut state, &mut at, demand.sample);
                rows[i * count + j] = demand.weight * free.stiffness * u;
            }
        }
        for (demand, row) in group.iter().zip(rows.chunks_exact(count)) {
            system.add(row, demand.weight * demand.change);
        }
    }
    system.solve()
}

/// Adds the demands of one oscillator and returns its peak.
fn demand(
    extrema: &[Extremum],
    index: usize,
    oscillator: &Oscillator,
    time_step: f64,
    demands: &mut Vec<Demand>,
) -> Extremum {
    let goal = oscillator.goal;
    let first = Extremum { sample: 1, value: 0.0 };
    let peak = extrema.iter().fold(first, |best, other| {
        if other.value.abs() > best.value.abs() { *other } else { best }
    });
    for extremum in extrema {
        let is_peak = extremum.sample == peak.sample;
        let apart = extremum.sample.abs_diff(peak.sample) as f64 * time_step;
        let excess = extremum.value.abs() - goal;
        if !is_peak && (apart < 1.5 * oscillator.period) {
            continue;
        }
        let change = if is_peak { -excess } else { -excess.max(0.0) };
        demands.push(Demand {
            oscillator: index,
            sample: extremum.sample,
            change: RELAXATION * change * extremum.value.signum(),
            weight: if is_peak || excess > 0.0 { 1.0 } else { WATCHED_WEIGHT },
        });
    }
    peak
}

/// Local extrema of the response above `threshold`, and the largest in any case.
fn extrema(a: &[f64], oscillator: &Oscillator, threshold: f64) -> Vec<Extremum> {
    let w = TAU / oscillator.period;
    let (mut u, mut v) = (0.0_f64, 0.0_f64);
    let mut found = Vec::new();
    let mut largest = Extremum { sample: 1, value: 0.0 };
    let (mut before, mut here) = (0.0_f64, 0.0_f64);
    for (k, pair) in a.windows(2).enumerate() {
        (u, v) = oscillator.step.advance(u, v, -pair[0], -pair[1]);
        let after = w * w * u;
        // `here` belongs to sample k.
        if here.abs() >= before.abs() && here.abs() > after.abs() && here.abs() > threshold {
            found.push(Extremum { sample: k, value: here });
        }
        if after.abs() > largest.value.abs() {
            largest = Extremum { sample: k + 1, value: after };
        }
        before = here;
        here = after;
    }
    if found.iter().all(|extremum| extremum.sample != largest.sample) {
        found.push(largest);
        found.sort_by_key(|extremum| extremum.sample);
    }
    found
}

/// A tapered cosine whose oscillator answers with a peak at a given sample.
struct Wavelet {
    first: usize,
    values: Vec<f64>,
}

impl Wavelet {
    /// `cos(w' (t - t_j + Δt)) exp(-((t - t_j + Δt)/γ)²)` with `w' = w √(1-ξ²)`,
    /// `Δt = atan(√(1-ξ²)/ξ)/w'` and `γ = 1.178 f^-0.93` (Al Atik and Abrahamson 2010).
    fn new(period: f64, damping: f64, time_step: f64, peak: usize, n: usize) -> Self {
        let q = (1.0 - damping * damping).sqrt();
        let w = TAU / period * q;
        let lag = math::atan2(q, damping) / w;
        let gamma = 1.178 * math::powf(period, 0.93);
        let center = peak as f64 * time_step - lag;
        let reach = 3.0 * gamma;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the record"
        )]
        let index = |t: f64| (t / time_step).clamp(0.0, (n - 1) as f64) as usize;
        let (first, last) = (index(center - reach), index(center + reach));
        let values = (first..=last)
            .map(|k| {
                let s = k as f64 * time_step - center;
                let x = s / gamma;
                math::cos(w * s) * math::exp(-x * x)
            })
            .collect();
        Self { first, values }
    }

    /// Carries an oscillator from sample `at` to `sample` under this wavelet and gives its
    /// displacement there; samples must come in ascending order.
    fn advance(
        &self,
        step: &Step,
        free: &FreeVibration,
        state: &mut (f64, f64),
        at: &mut usize,
        sample: usize,
    ) -> f64 {
        if sample <= self.first {
            return 0.0;
        }
        let end = self.first + self.values.len();
        let value = |k: usize| self.values.get(k - self.first).copied().unwrap_or(0.0);
        while *at < sample.min(end) {
            *state = step.advance(state.0, state.1, -value(*at), -value(*at + 1));
            *at += 1;
        }
        if sample > end { free.displacement(*state, sample - end) } else { state.0 }
    }
}

/// An oscillator left alone, at any number of steps in one evaluation.
struct FreeVibration {
    stiffness: f64,
    decay: f64,
    frequency: f64,
    time_step: f64,
}

impl FreeVibration {
    fn new(period: f64, damping: f64, time_step: f64) -> Self {
        let w = TAU / period;
        let frequency = w * (1.0 - damping * damping).sqrt();
        Self { stiffness: w * w, decay: damping * w, frequency, time_step }
    }

    fn displacement(&self, (u, v): (f64, f64), steps: usize) -> f64 {
        let t = self.time_step * steps as f64;
        let (s, c) = math::sin_cos(self.frequency * t);
        math::exp(-self.decay * t) * (u * c + (v + self.decay * u) / self.frequency * s)
    }
}

/// Normal equations `(CᵀC + λI) b = Cᵀ r` of many demands on few wavelets, solved by Cholesky
/// factors.
struct System {
    size: usize,
    normal: Vec<f64>,
    right: Vec<f64>,
}

impl System {
    fn new(size: usize) -> Self {
        Self { size, normal: vec![0.0; size * size], right: vec![0.0; size] }
    }

    fn add(&mut self, row: &[f64], value: f64) {
        for j in 0..self.size {
            self.right[j] += row[j] * value;
            for k in 0..=j {
                self.normal[j * self.size + k] += row[j] * row[k];
            }
        }
    }

    fn solve(mut self) -> Vec<f64> {
        let n = self.size;
        let m = &mut self.normal;
        let largest = (0..n).map(|k| m[k * n + k]).fold(0.0, f64::max);
        for k in 0..n {
            m[k * n + k] += RIDGE * RIDGE * largest;
        }
        for j in 0..n {
            for k in 0..=j {
                let sum = (0..k).fold(m[j * n + k], |sum, i| sum - m[j * n + i] * m[k * n + i]);
                m[j * n + k] = if j == k { sum.max(1e-300).sqrt() } else { sum / m[k * n + k] };
            }
        }
        let mut b = self.right;
        for j in 0..n {
            let sum = (0..j).fold(b[j], |sum, k| sum - m[j * n + k] * b[k]);
            b[j] = sum / m[j * n + j];
        }
        for j in (0..n).rev() {
            let sum = (j + 1..n).fold(b[j], |sum, k| sum - m[k * n + j] * b[k]);
            b[j] = sum / m[j * n + j];
        }
        b
    }
}
