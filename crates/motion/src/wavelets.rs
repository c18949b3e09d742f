//! Spectral matching in the time domain: wavelets are added at the times of the peak responses.

use crate::error::MotionError;
use crate::matching::{Best, GOOD_ENOUGH, Matching, PATIENCE, Work, matched_periods};
use crate::math::{self, TAU};
use crate::normal_equations::System;
use crate::response::{Bank, Step, TOGETHER};

/// Fraction of the misfit removed in one round; with a larger fraction, peaks jump to other times.
const RELAXATION: f64 = 0.6;
/// Fraction of the target above which extrema other than the peak are also constrained, so that the
/// correction of one peak does not raise another.
const WATCHED: f64 = 0.85;
/// Weight of the equation for a constrained extremum that does not exceed the target. All other equations have a weight
/// of 1.
const WATCHED_WEIGHT: f64 = 0.4;

/// Maximum number of times that the linear system is solved in one round. The system is solved again if a solution
/// raises further extrema above the target.
const BOUNDING: usize = 5;
/// Largest applied fraction of a correction. The fraction is doubled after a success and halved after a
/// failure.
const LARGEST_SHARE: f64 = 0.8;
/// Smallest applied fraction of a correction.
const SMALLEST_SHARE: f64 = 0.05;
/// Polishing ends when the misfit is at most this fraction of the tolerance.
const POLISHED: f64 = 0.95;
/// In two of three rounds, polishing does not correct a peak whose misfit is below this fraction of
/// the tolerance, because every correction disturbs other peaks.
const BAND: f64 = 0.6;
/// Minimum number of segments per period in the piecewise linear approximation of a wavelet, from which the responses
/// to the wavelet are computed. If the motion has fewer samples per period, every sample interval is a segment.
const WAVELET_LINES: f64 = 40.0;
/// A free vibration is neglected after it has decayed to the fraction `exp(-FORGOTTEN)`.
pub(crate) const FORGOTTEN: f64 = 7.0;
/// Ratio below which two periods are too close for separate wavelets.
const NEIGHBOR: f64 = 1.006;

/// A local extremum of the response of an oscillator.
#[derive(Clone, Copy)]
struct Extremum {
    sample: usize,
    /// Signed pseudo-acceleration (m/s²).
    value: f64,
}

/// An oscillator with one of the matched periods.
struct Oscillator {
    period: f64,
    /// Target pseudo-acceleration (m/s²).
    goal: f64,
}

/// An equation of the system: the response of an oscillator at `sample` must change by `change`.
struct Demand {
    oscillator: usize,
    sample: usize,
    change: f64,
    weight: f64,
}

/// Matches the response spectrum to the target in rounds. Each round solves a linear system for the
/// amplitudes of wavelets that correct the responses at all peak times.
pub(crate) fn match_in_time(
    work: &Work<'_>,
    start: &[f64],
    settings: &Matching,
    all: &mut Best,
) -> Result<Vec<f64>, MotionError> {
    let mut a = start.to_vec();
    let (mut best, mut gained) = (Best::new(&a), 0);
    // Far from the target, rounds with demands on the peaks alone converge fastest.
    let alone = 2 * settings.rounds / 3;
    for round in 1..=settings.rounds {
        let watching = round > alone;
        if round == alone + 1 && gained > 0 {
            a.clone_from(&best.acceleration);
        }
        if best.offer(&a, work.judged_misfit(&a)) {
            gained = round;
        }
        let stalled = watching && round > gained.max(alone) + PATIENCE;
        if best.misfit <= GOOD_ENOUGH * settings.tolerance || stalled {
            break;
        }
        a = work.close(&corrected(work, &a, &matched_periods(settings, round), watching))?;
        all.rounds += 1;
    }
    all.offer(&best.acceleration, work.misfit(&best.acceleration));
    Ok(best.acceleration)
}

/// Improves the best motion in rounds. Each round applies only a fraction of its correction. The
/// fraction is doubled after a success and halved after a failure. Gives up after [`PATIENCE`]
/// rounds without improvement.
pub(crate) fn polish(
    work: &Work<'_>,
    mut best: Vec<f64>,
    settings: &Matching,
    all: &mut Best,
) -> Result<(), MotionError> {
    let mut fit = work.fit(&best);
    let (mut gained, mut share) = (0, LARGEST_SHARE);
    let target = POLISHED * settings.tolerance;
    // The exact misfit is expensive; it is computed only if the approximate misfit is at most this
    // value.
    let mut promising = target;
    for round in 1..=settings.rounds {
        // Every third round corrects all peaks, so that the peaks within the band do not drift to
        // its edge. The other rounds do not correct peaks within the band.
        let band = if round % 3 == 0 { 0.0 } else { BAND * settings.tolerance };
        let mut periods = matched_periods(settings, round);
        periods.extend(
            fit.worst
                .iter()
                .filter(|(_, misfit)| *misfit > BAND * settings.tolerance)
                .map(|(t, _)| *t),
        );
        periods.sort_by(f64::total_cmp);
        periods.dedup_by(|b, a| *b < NEIGHBOR * *a);
        let full = work.close(&bounded(work, &best, &periods, band))?;
        all.rounds += 1;
        for _ in 0..2 {
            let tried: Vec<f64> =
                best.iter().zip(&full).map(|(a, b)| a + share * (b - a)).collect();
            let now = work.fit(&tried);
            if now.roughness < fit.roughness {
                (best, fit, gained) = (tried, now, round);
                share = (2.0 * share).min(LARGEST_SHARE);
                break;
            }
            share = (0.5 * share).max(SMALLEST_SHARE);
        }
        if fit.misfit <= promising {
            let exact = work.misfit(&best);
            if exact <= target {
                break;
            }
            promising = fit.misfit - (exact - target);
        }
        if round > gained + PATIENCE {
            break;
        }
    }
    all.offer(&best, work.misfit(&best));
    Ok(())
}

/// Returns the motion `a` with the wavelets of one round added, one wavelet for each of the `periods`. If `watching` is
/// `true`, other extrema above the fraction [`WATCHED`] of the target are constrained, too.
fn corrected(work: &Work<'_>, a: &[f64], periods: &[f64], watching: bool) -> Vec<f64> {
    let oscillators = oscillators(work, periods);
    let mut wavelets = Vec::with_capacity(oscillators.len());
    let mut demands = Vec::new();
    let share = if watching { WATCHED } else { f64::INFINITY };
    let extrema = extrema(work, a, &oscillators, share);
    for (k, (oscillator, extrema)) in oscillators.iter().zip(&extrema).enumerate() {
        let peak = demand(extrema, k, oscillator, work.time_step, &mut demands);
        wavelets.push(Wavelet::new(oscillator.period, work, peak.sample, a.len()));
    }
    let rows = rows(work, &oscillators, &wavelets, &demands);
    let mut system = System::new(wavelets.len());
    for (demand, row) in demands.iter().zip(rows.chunks_exact(wavelets.len())) {
        system.add(row, demand.weight * demand.change);
    }
    added(a, &wavelets, &system.solve())
}

fn oscillators(work: &Work<'_>, periods: &[f64]) -> Vec<Oscillator> {
    let oscillator = |&period: &f64| Oscillator { period, goal: work.target.acceleration(period) };
    periods.iter().map(oscillator).collect()
}

fn added(a: &[f64], wavelets: &[Wavelet], amplitudes: &[f64]) -> Vec<f64> {
    let mut sum = a.to_vec();
    for (wavelet, amplitude) in wavelets.iter().zip(amplitudes) {
        for (value, shape) in sum[wavelet.first..].iter_mut().zip(&wavelet.values) {
            *value += amplitude * shape;
        }
    }
    sum
}

/// Returns the motion `a` with added wavelets that bring every peak to within the fraction `band` of its target.
///
/// If a solution leaves another extremum above this band, an equation for this extremum is added and the system is
/// solved again, at most [`BOUNDING`] times in all.
fn bounded(work: &Work<'_>, a: &[f64], periods: &[f64], band: f64) -> Vec<f64> {
    let oscillators = oscillators(work, periods);
    let (mut wavelets, mut demands, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut active = Vec::new();
    let extrema = extrema(work, a, &oscillators, WATCHED);
    for (k, (oscillator, extrema)) in oscillators.iter().zip(extrema).enumerate() {
        let peak = peak(&extrema);
        for extremum in extrema {
            let Extremum { sample, value } = extremum;
            let bounds = (1.0 - band, 1.0 + band);
            let size = value.abs().clamp(bounds.0 * oscillator.goal, bounds.1 * oscillator.goal);
            let change = (size - value.abs()) * value.signum();
            demands.push(Demand { oscillator: k, sample, change, weight: 1.0 });
            values.push(value);
            active.push(sample == peak.sample);
        }
        wavelets.push(Wavelet::new(oscillator.period, work, peak.sample, a.len()));
    }
    let count = wavelets.len();
    let rows = rows(work, &oscillators, &wavelets, &demands);
    let mut amplitudes = Vec::new();
    for _ in 0..BOUNDING {
        let mut system = System::new(count);
        for (k, row) in rows.chunks_exact(count).enumerate() {
            if active[k] {
                system.add(row, demands[k].change);
            }
        }
        amplitudes = system.solve();
        let mut more = false;
        for (k, row) in rows.chunks_exact(count).enumerate() {
            let change: f64 = row.iter().zip(&amplitudes).map(|(r, b)| r * b).sum();
            let goal = oscillators[demands[k].oscillator].goal;
            if !active[k] && (values[k] + change).abs() > (1.0 + band) * goal {
                (active[k], more) = (true, true);
            }
        }
        if !more {
            break;
        }
    }
    added(a, &wavelets, &amplitudes)
}

/// Returns the weighted responses to wavelets with an amplitude of 1, with one row for each demand
/// and one column for each wavelet.
fn rows(
    work: &Work<'_>,
    oscillators: &[Oscillator],
    wavelets: &[Wavelet],
    demands: &[Demand],
) -> Vec<f64> {
    let count = wavelets.len();
    let mut rows = vec![0.0; demands.len() * count];
    let mut first = 0;
    for (group, some) in oscillators.chunks(TOGETHER).enumerate() {
        let of = |demand: &Demand| demand.oscillator / TOGETHER == group;
        let last = first + demands[first..].iter().take_while(|demand| of(demand)).count();
        // Demands on these oscillators, in order of time.
        let mut demanded: Vec<usize> = (first..last).collect();
        demanded.sort_by_key(|&row| demands[row].sample);
        let group = Group::new(work, some, wavelets);
        for (j, wavelet) in wavelets.iter().enumerate() {
            let mut bank = group.bank(wavelet.stride);
            let mut at = 0;
            for &row in &demanded {
                let demand = &demands[row];
                let Some(since) = demand.sample.checked_sub(wavelet.first) else { continue };
                let k = demand.oscillator % TOGETHER;
                let whole = (since / wavelet.stride).min(wavelet.coarse());
                while at < whole {
                    bank.advance(-wavelet.at(at), -wavelet.at(at + 1));
                    at += 1;
                }
                let u = group.on(k, &bank, wavelet, whole, since);
                rows[row * count + j] = demand.weight * group.free[k].stiffness * u;
            }
        }
        first = last;
    }
    rows
}

/// Oscillators whose responses are computed together.
struct Group {
    /// Coefficients of each oscillator for steps of 1, 2, 3, … samples.
    steps: Vec<Vec<Step>>,
    free: Vec<FreeVibration>,
}

impl Group {
    fn new(work: &Work<'_>, oscillators: &[Oscillator], wavelets: &[Wavelet]) -> Self {
        let longest = wavelets.iter().map(|wavelet| wavelet.stride).max().unwrap_or(1);
        let of =
            |o: &Oscillator, n: usize| Step::new(o.period, work.damping, n as f64 * work.time_step);
        let steps = |o: &Oscillator| (1..=longest).map(|n| of(o, n)).collect();
        let free = |o: &Oscillator| FreeVibration::new(o.period, work.damping, work.time_step);
        Self {
            steps: oscillators.iter().map(steps).collect(),
            free: oscillators.iter().map(free).collect(),
        }
    }

    fn bank(&self, stride: usize) -> Bank {
        let steps: Vec<Step> = self.steps.iter().map(|steps| steps[stride - 1]).collect();
        Bank::new(&steps)
    }

    /// Returns the displacement of oscillator `k` at `since` samples after the start of a wavelet. `bank` holds the
    /// state of the oscillators after `whole` strides of the wavelet.
    fn on(&self, k: usize, bank: &Bank, wavelet: &Wavelet, whole: usize, since: usize) -> f64 {
        let (u, v) = (bank.u[k], bank.v[k]);
        let left = since - whole * wavelet.stride;
        if whole == wavelet.coarse() {
            return self.free[k].displacement((u, v), left);
        }
        if left == 0 {
            return u;
        }
        let (load, next) = (-wavelet.at(whole), -wavelet.at(whole + 1));
        let end = load + (next - load) * left as f64 / wavelet.stride as f64;
        self.steps[k][left - 1].advance(u, v, load, end).0
    }
}

/// Returns the largest extremum, the first one if several are equally large.
fn peak(extrema: &[Extremum]) -> Extremum {
    let first = Extremum { sample: 1, value: 0.0 };
    extrema.iter().fold(
        first,
        |best, other| {
            if other.value.abs() > best.value.abs() { *other } else { best }
        },
    )
}

/// Adds the equations for the extrema of one oscillator to `demands`, and returns its peak. Other extrema that are
/// closer than 1.5 periods to the peak are omitted.
fn demand(
    extrema: &[Extremum],
    index: usize,
    oscillator: &Oscillator,
    time_step: f64,
    demands: &mut Vec<Demand>,
) -> Extremum {
    let goal = oscillator.goal;
    let peak = peak(extrema);
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

/// Returns, for every oscillator, the local extrema of the response to the motion `a` that exceed the fraction `share`
/// of the target in magnitude. The largest extremum is always included.
fn extrema(
    work: &Work<'_>,
    a: &[f64],
    oscillators: &[Oscillator],
    share: f64,
) -> Vec<Vec<Extremum>> {
    let layers = work.layers(a);
    let mut all = Vec::with_capacity(oscillators.len());
    for some in oscillators.chunks(TOGETHER) {
        let periods: Vec<f64> = some.iter().map(|oscillator| oscillator.period).collect();
        let threshold: [f64; TOGETHER] =
            std::array::from_fn(|k| some.get(k).map_or(f64::INFINITY, |o| share * o.goal));
        let mut found: Vec<Vec<Extremum>> = vec![Vec::new(); some.len()];
        let mut largest = [Extremum { sample: 1, value: 0.0 }; TOGETHER];
        let (mut before, mut here, mut at) = ([0.0_f64; TOGETHER], [0.0_f64; TOGETHER], 0);
        layers.follow(&periods, work.damping, |sample, after| {
            for k in 0..TOGETHER {
                let size = here[k].abs();
                if size > threshold[k] && size >= before[k].abs() && size > after[k].abs() {
                    found[k].push(Extremum { sample: at, value: here[k] });
                }
                if after[k].abs() > largest[k].value.abs() {
                    largest[k] = Extremum { sample, value: after[k] };
                }
            }
            (before, here, at) = (here, *after, sample);
        });
        for (found, largest) in found.iter_mut().zip(largest) {
            if found.iter().all(|extremum| extremum.sample != largest.sample) {
                found.push(largest);
                found.sort_by_key(|extremum| extremum.sample);
            }
        }
        all.append(&mut found);
    }
    all
}

/// A tapered cosine that causes a response peak of its oscillator at a given sample.
pub(crate) struct Wavelet {
    pub(crate) first: usize,
    pub(crate) values: Vec<f64>,
    /// Number of sample intervals per segment of the piecewise linear approximation ([`WAVELET_LINES`]).
    stride: usize,
}

impl Wavelet {
    /// Creates the wavelet that causes a peak at sample `peak` in the response of the oscillator with the given period
    /// (s), in a motion of `n` samples.
    ///
    /// The wavelet is `cos(w' (t - t_j + Δt)) exp(-((t - t_j + Δt)/γ)²)` with `w' = w √(1-ξ²)`,
    /// `Δt = atan(√(1-ξ²)/ξ)/w'` and `γ = 1.178 f^-0.93` (Al Atik and Abrahamson 2010). Here `t_j` is the time of the
    /// peak (s); `f` (Hz), `w` (rad/s) and `ξ` are frequency, angular frequency and damping ratio of the oscillator.
    pub(crate) fn new(period: f64, work: &Work<'_>, peak: usize, n: usize) -> Self {
        let Work { damping, time_step, .. } = *work;
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
        // Cosine and Gaussian are computed recursively, from sample to sample.
        let (turn_s, turn_c) = math::sin_cos(w * time_step);
        let from = first as f64 * time_step - center;
        let (mut s, mut c) = math::sin_cos(w * from);
        let width = time_step / gamma;
        let x = from / gamma;
        let mut bell = math::exp(-x * x);
        let mut ratio = math::exp(-width * (2.0 * x + width));
        let squared = math::exp(-2.0 * width * width);
        let mut values = Vec::with_capacity(last + 1 - first);
        for _ in first..=last {
            values.push(c * bell);
            (s, c) = (s * turn_c + c * turn_s, c * turn_c - s * turn_s);
            (bell, ratio) = (bell * ratio, ratio * squared);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let stride = (period / (WAVELET_LINES * time_step)).clamp(1.0, 1000.0) as usize;
        Self { first, values, stride }
    }

    /// Returns the number of strides that cover the wavelet; after that many strides, the wavelet is zero.
    fn coarse(&self) -> usize {
        self.values.len().div_ceil(self.stride)
    }

    /// Returns the value of the wavelet after `strides` segments of [`Self::stride`] samples; zero after its end.
    fn at(&self, strides: usize) -> f64 {
        self.values.get(strides * self.stride).copied().unwrap_or(0.0)
    }
}

/// Free vibration of an oscillator. A closed-form expression gives the displacement after any number of steps.
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
        if self.decay * t > FORGOTTEN {
            return 0.0;
        }
        let (s, c) = math::sin_cos(self.frequency * t);
        math::exp(-self.decay * t) * (u * c + (v + self.decay * u) / self.frequency * s)
    }
}
