//! Spectral matching of two horizontal components together, to a target for `RotD50` or `RotD100`.

use crate::error::MotionError;
use crate::fourier::{apply_gain, forward_real, inverse};
use crate::horizontals::Horizontals;
use crate::matched::MatchedPair;
use crate::matching::{GOOD_ENOUGH, Matching, Work, matched_periods, misfit_of};
use crate::math::{self, PI, TAU};
use crate::normal_equations::System;
use crate::response::Step;
use crate::rotd::{RotatedPeak, rotated_peak};
use crate::wavelets::{FORGOTTEN, Wavelet};

/// Maximum number of rounds in the frequency domain. These rounds approach the target and then
/// stall.
const FREQUENCY_ROUNDS: usize = 12;
/// Power to which a round in the frequency domain raises the ratio of target to response spectrum. The
/// Fourier amplitudes are multiplied by the result.
const AMPLITUDE_STEP: f64 = 0.7;
/// Initial and smallest fraction of the misfit that the wavelets of one round remove. Rounds
/// without improvement reduce the fraction.
const RELAXATION: [f64; 2] = [0.6, 0.1];
/// Number of rounds without improvement after which the match gives up.
const PATIENCE: usize = 12;

/// Accelerations (m/s²) of two components with the same time step and length.
pub(crate) type Pair = [Vec<f64>; 2];

/// Matches the `RotD50` or `RotD100` spectrum of two components to the target of `work`.
///
/// First, the Fourier amplitudes of both components are multiplied by the same gain, which keeps
/// the polarization. Then wavelets are added along the direction of the response at its peak (Grant
/// 2011, Earthquake Spectra 27:675-685, for `RotD100`).
pub(crate) fn match_pair(
    work: &Work<'_>,
    start: Pair,
    measure: Horizontals,
    settings: &Matching,
) -> Result<(Pair, MatchedPair), MotionError> {
    let search = Search { work, measure };
    let mut best = Best { pair: start.clone(), misfit: f64::INFINITY };
    let mut pair = start;
    let mut rounds = 0;
    let (periods, goals) = work.judged();
    for _ in 0..FREQUENCY_ROUNDS.min(settings.rounds) {
        let now = search.spectrum(periods, &pair);
        best.offer(&pair, misfit_of(goals, &now));
        if best.misfit <= GOOD_ENOUGH * settings.tolerance {
            break;
        }
        pair = search.amplified(&pair, &now)?;
        rounds += 1;
    }
    best.offer(&pair, misfit_of(goals, &search.spectrum(periods, &pair)));
    let [mut share, least] = RELAXATION;
    let mut since = 0;
    pair = best.pair.clone();
    for round in 1..=settings.rounds {
        if best.misfit <= GOOD_ENOUGH * settings.tolerance || since > PATIENCE {
            break;
        }
        pair = search.corrected(&pair, &matched_periods(settings, round), share)?;
        rounds += 1;
        if best.offer(&pair, misfit_of(goals, &search.spectrum(periods, &pair))) {
            since = 0;
        } else {
            since += 1;
            if since % 4 == 0 {
                // Restart from the best pair, with smaller corrections.
                share = (0.5 * share).max(least);
                pair = best.pair.clone();
            }
        }
    }
    let (checked, goals) = work.checked();
    let now = search.spectrum(checked, &best.pair);
    let misfit = misfit_of(goals, &now);
    let missed = work.missed_at(&now, settings.tolerance);
    Ok((best.pair, MatchedPair { misfit, missed, rounds }))
}

/// Returns the response spectrum (m/s²) of a pair at the given periods (s), measured as `RotD50` or `RotD100`.
pub(crate) fn spectrum(
    work: &Work<'_>,
    measure: Horizontals,
    periods: &[f64],
    pair: &Pair,
) -> Vec<f64> {
    let of = |period: &f64| value(measure, &rotated(&histories(work, *period, pair)));
    periods.iter().map(of).collect()
}

fn value(measure: Horizontals, peak: &RotatedPeak) -> f64 {
    match measure {
        Horizontals::RotD100 => peak.largest,
        Horizontals::RotD50 | Horizontals::GeometricMean => peak.median,
    }
}

/// Returns the pseudo-acceleration histories (m/s²) of an oscillator under each of the two
/// components.
fn histories(work: &Work<'_>, period: f64, pair: &Pair) -> Pair {
    let step = Step::new(period, work.damping, work.time_step);
    let stiffness = (TAU / period) * (TAU / period);
    [0, 1].map(|side| {
        let (mut u, mut v) = (0.0, 0.0);
        let advance = |pair: &[f64]| {
            (u, v) = step.advance(u, v, -pair[0], -pair[1]);
            stiffness * u
        };
        std::iter::once(0.0).chain(pair[side].windows(2).map(advance)).collect()
    })
}

struct Best {
    pair: Pair,
    misfit: f64,
}

impl Best {
    fn offer(&mut self, pair: &Pair, misfit: f64) -> bool {
        let better = misfit < self.misfit;
        if better {
            self.pair.clone_from(pair);
            self.misfit = misfit;
        }
        better
    }
}

struct Search<'a> {
    work: &'a Work<'a>,
    measure: Horizontals,
}

impl Search<'_> {
    fn spectrum(&self, periods: &[f64], pair: &Pair) -> Vec<f64> {
        spectrum(self.work, self.measure, periods, pair)
    }

    /// Returns the pair with its Fourier amplitudes multiplied by the ratio of the target to the
    /// response spectrum `now`, raised to the power [`AMPLITUDE_STEP`].
    fn amplified(&self, pair: &Pair, now: &[f64]) -> Result<Pair, MotionError> {
        let (periods, goals) = self.work.judged();
        let length = (pair[0].len() + pair[0].len() / 4).next_power_of_two();
        let ln_f: Vec<f64> = periods.iter().rev().map(|t| -math::ln(*t)).collect();
        let ratio: Vec<f64> = goals
            .iter()
            .zip(now)
            .rev()
            .map(|(g, n)| math::powf(g / n, AMPLITUDE_STEP).clamp(0.5, 2.0))
            .collect();
        let one = |side: usize| {
            let mut spectrum = forward_real(&pair[side], length);
            apply_gain(&mut spectrum, self.work.time_step, |f| {
                if f > 0.0 { math::interpolate(&ln_f, &ratio, math::ln(f)) } else { 0.0 }
            });
            inverse(&mut spectrum);
            let changed: Vec<f64> = spectrum[..pair[side].len()].iter().map(|x| x.re).collect();
            self.work.steady(&changed)
        };
        Ok([one(0)?, one(1)?])
    }

    /// Returns the pair with added wavelets that remove a share of the misfit. Each wavelet acts
    /// along the direction of the response at the time of the peak response.
    fn corrected(&self, pair: &Pair, periods: &[f64], share: f64) -> Result<Pair, MotionError> {
        let count = pair[0].len();
        let aims: Vec<Aim> =
            periods.iter().flat_map(|&period| self.aims(period, pair, share)).collect();
        let wavelets: Vec<Wavelet> =
            aims.iter().map(|aim| Wavelet::new(aim.period, self.work, aim.sample, count)).collect();
        let mut system = System::new(wavelets.len());
        let mut row = vec![0.0; wavelets.len()];
        for aim in &aims {
            for ((value, wavelet), other) in row.iter_mut().zip(&wavelets).zip(&aims) {
                let along = aim.direction[0] * other.push[0] + aim.direction[1] * other.push[1];
                *value = along * self.response(aim, wavelet);
            }
            system.add(&row, aim.change);
        }
        let mut sum = pair.clone();
        for ((wavelet, amplitude), aim) in wavelets.iter().zip(system.solve()).zip(&aims) {
            for (side, push) in sum.iter_mut().zip(aim.push) {
                for (value, shape) in side[wavelet.first..].iter_mut().zip(&wavelet.values) {
                    *value += amplitude * push * shape;
                }
            }
        }
        Ok([self.work.close(&sum[0])?, self.work.close(&sum[1])?])
    }

    /// Returns the changes of the response at a period that remove the fraction `share` of the
    /// misfit. For `RotD100`, only the largest response must change. For `RotD50`, the two middle
    /// responses must change, because their mean is the median.
    fn aims(&self, period: f64, pair: &Pair, share: f64) -> Vec<Aim> {
        let histories = histories(self.work, period, pair);
        let peak = rotated(&histories);
        let goal = self.work.target.acceleration(period);
        let wanted = share * (goal / value(self.measure, &peak) - 1.0);
        let degrees = match self.measure {
            Horizontals::RotD100 => vec![peak.angle],
            Horizontals::RotD50 | Horizontals::GeometricMean => peak.median_angles.to_vec(),
        };
        let aim = |degree: f64| {
            let (s, c) = math::sin_cos(PI * degree / 180.0);
            let along = |k: usize| histories[0][k] * c + histories[1][k] * s;
            let sample = (0..histories[0].len())
                .fold(0, |best, k| if along(k).abs() > along(best).abs() { k } else { best });
            let value = along(sample);
            let [x, y] = [histories[0][sample], histories[1][sample]];
            let length = (x * x + y * y).sqrt().max(f64::MIN_POSITIVE) * value.signum();
            Aim {
                period,
                sample,
                direction: [c, s],
                push: [x / length, y / length],
                change: wanted * value,
                step: Step::new(period, self.work.damping, self.work.time_step),
            }
        };
        degrees.into_iter().map(aim).collect()
    }

    /// Returns the pseudo-acceleration (m/s²) that a wavelet causes in the oscillator of `aim` at
    /// the sample of `aim`.
    fn response(&self, aim: &Aim, wavelet: &Wavelet) -> f64 {
        let Work { damping, time_step, .. } = *self.work;
        let w = TAU / aim.period;
        let (mut u, mut v) = (0.0, 0.0);
        let load = |k: usize| wavelet.values.get(k).map_or(0.0, |value| -value);
        for k in 0..aim.sample.saturating_sub(wavelet.first) {
            let free = k.saturating_sub(wavelet.values.len()) as f64 * time_step;
            if damping * w * free > FORGOTTEN {
                return 0.0;
            }
            (u, v) = aim.step.advance(u, v, load(k), load(k + 1));
        }
        w * w * u
    }
}

/// A required change of the response of an oscillator at one sample.
struct Aim {
    period: f64,
    sample: usize,
    /// Unit vector of the direction in which the response is measured.
    direction: [f64; 2],
    /// Unit vector along which the wavelet acts. This is the direction of the response at the time of
    /// its peak along [`Aim::direction`].
    push: [f64; 2],
    /// Required change of the response in [`Aim::direction`] (m/s²).
    change: f64,
    step: Step,
}

fn rotated([first, second]: &Pair) -> RotatedPeak {
    rotated_peak(first, second)
}
