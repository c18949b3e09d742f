//! Spectral matching of one component, in the frequency domain or in the time domain.

use crate::error::MotionError;
use crate::fourier::{apply_gain, forward_real, inverse};
use crate::ground_motion::GroundMotion;
use crate::history::History;
use crate::layers::Layers;
use crate::matched::{Matched, Missed};
use crate::math;
use crate::process::{Pads, Processing};
use crate::response::pseudo_accelerations;
use crate::sampled::Sampled;
use crate::target::TargetSpectrum;
use crate::wavelets;

/// Method of spectral matching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchMethod {
    /// Multiplies the Fourier amplitudes repeatedly by the ratio of target to response spectrum,
    /// and keeps the phases.
    ///
    /// This method is simple and converges fast at first, but changes the character of the whole
    /// motion. Scaling the amplitudes alone stalls at a misfit of 5 to 9 %; wavelets then remove
    /// the remaining misfit.
    Frequency,
    /// Adds wavelets at the times of the peak responses (Lilhanand and Tseng 1988; Al Atik and
    /// Abrahamson 2010, Earthquake Spectra 26:601-617).
    ///
    /// This method is slower, but keeps the character of the motion. If the match stalls, further
    /// rounds start from the best motion. They correct the peak responses without raising other
    /// extrema of the responses above the target. If that also fails, the match restarts in the
    /// frequency domain, and the provenance says so.
    Time,
}

/// Settings of spectral matching.
#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    /// Method of matching.
    pub method: MatchMethod,
    /// Shortest matched period (s); at least four time steps of the motion.
    pub shortest: f64,
    /// Longest matched period (s).
    pub longest: f64,
    /// Largest accepted relative misfit at any matched period.
    pub tolerance: f64,
    /// Maximum number of rounds of one stage of the match. The stages are: changing the Fourier
    /// amplitudes, adding wavelets, and making smaller corrections with wavelets. If a stage ends
    /// before the tolerance is met, the next stage follows.
    pub rounds: usize,
}

impl Default for Matching {
    /// Returns settings for the time domain, with periods from 0.1 to 3 s, a tolerance of 5 % and
    /// at most 100 rounds.
    fn default() -> Self {
        Self {
            method: MatchMethod::Time,
            shortest: 0.1,
            longest: 3.0,
            tolerance: 0.05,
            rounds: 100,
        }
    }
}

/// Exponents for the frequency domain. A round multiplies the Fourier amplitudes by the ratio of
/// target to response spectrum, raised to one of these powers. If the match misses the tolerance, it
/// restarts with the next exponent.
const AMPLITUDE_STEPS: [f64; 4] = [0.7, 0.5, 0.9, 0.3];
/// Upper limit of the product of the number of samples and the number of rounds. Above this limit,
/// the match does not restart. A motion of 35,000 samples reaches the limit after 400 rounds, which
/// take about 6 s.
const MOST_SAMPLES: usize = 14_000_000;

/// Time steps per shortest matched period. With this number, a peak between two samples is
/// underestimated by at most 1.2 %; with ten steps, the error would be 5 %, the entire tolerance of
/// a match.
pub(crate) const STEPS_A_PERIOD: f64 = 20.0;
/// Number of matched periods per decade.
const PER_DECADE: f64 = 60.0;
/// Number of judged periods per matched period. Every round evaluates the misfit at the judged
/// periods, so that a misfit between matched periods is noticed.
const JUDGED: usize = 3;
/// Number of checked periods per judged period. The final misfit is evaluated at the checked
/// periods, which form an even finer grid.
const CHECKED: usize = 6;
/// No further method is started once the misfit is at most this fraction of the tolerance.
const CLEAR: f64 = 0.98;
/// Number of rounds without improvement after which a method gives up.
pub(crate) const PATIENCE: usize = 15;
/// The rounds of a method end when the misfit at the judged periods is at most this fraction of the
/// tolerance.
pub(crate) const GOOD_ENOUGH: f64 = 0.7;

impl GroundMotion {
    /// Matches the horizontal component to a target spectrum.
    ///
    /// The motion is first multiplied by one factor: the geometric mean, over the matched range of
    /// periods, of the ratio of target to response spectrum. A vertical component is not changed
    /// further. Every round ends by bringing the final velocity and displacement to zero, so that the
    /// result does not drift.
    ///
    /// # Errors
    /// If a setting is out of range, the motion is zero, or the tolerance is not reached.
    ///
    /// ```
    /// use barrelstack_motion::{CloughPenzien, Envelope, Matching, TargetSpectrum};
    /// let envelope = Envelope::Jennings { rise: 2.0, decay_start: 8.0, decay: 0.5 };
    /// let motion = CloughPenzien::medium(1.0).motion(&envelope, 15.0, 0.01, 1)?;
    /// let target =
    ///     TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping: 0.05 };
    /// let settings = Matching { tolerance: 0.1, ..Matching::default() };
    /// let matched = motion.match_spectrum(&target, &settings)?;
    /// assert!(matched.misfit <= 0.1);
    /// # Ok::<(), barrelstack_motion::MotionError>(())
    /// ```
    pub fn match_spectrum(
        &self,
        target: &TargetSpectrum,
        settings: &Matching,
    ) -> Result<Matched, MotionError> {
        let matched = self.match_spectrum_nearly(target, settings)?;
        if matched.missed.is_empty() {
            return Ok(matched);
        }
        Err(not_converged(matched.misfit, &matched.missed_in_words(), matched.rounds, settings))
    }

    /// Matches the horizontal component as [`GroundMotion::match_spectrum`] does, but returns the
    /// best motion even if the tolerance is not reached. [`Matched::missed`] lists the ranges of
    /// periods that miss the target.
    ///
    /// # Errors
    /// If a setting is out of range or the motion is zero.
    pub fn match_spectrum_nearly(
        &self,
        target: &TargetSpectrum,
        settings: &Matching,
    ) -> Result<Matched, MotionError> {
        let sampled = self.horizontal.sampled(self.horizontal.natural_step())?;
        let work = Work::new(target, settings, sampled.time_step())?;
        let (time_step, given) = subdivided(&sampled, settings.shortest);
        let now = work.spectrum(&work.judged, &given);
        let factor = mean_ratio(&work.judged_goal, &now);
        if !(factor.is_finite() && factor > 0.0) {
            return Err(MotionError::Zero {
                measure: "the response spectrum".to_owned(),
                motion: self.name.clone(),
                target: "the target spectrum".to_owned(),
            });
        }
        let start: Vec<f64> = given.iter().map(|a| a * factor).collect();
        let start = work.steady(&start)?;
        let (Best { acceleration, misfit, rounds }, first) = work.alternate(&start, settings)?;
        let missed = work.missed(&acceleration, settings.tolerance);
        let horizontal = History::Sampled(Sampled::new(time_step, acceleration)?);
        let vertical = self.vertical.as_ref().map(|history| history.scaled(factor));
        let provenance = self.provenance.clone();
        let motion = Self { provenance, ..Self::new(self.name.clone(), horizontal, vertical) };
        let chosen = settings.method;
        let mut matched = Matched { motion, misfit, missed, rounds, chosen, first };
        matched.motion.provenance.push(format!(
            "scaled by {factor:.4} and matched in {} to {target} at periods from {} to {} s: \
             misfit at most {:.2} % after {rounds} rounds, with the final velocity and displacement \
             brought to zero",
            matched.domain(),
            settings.shortest,
            settings.longest,
            100.0 * misfit
        ));
        if !matched.missed.is_empty() {
            let words = matched.missed_in_words();
            matched.motion.provenance.push(format!("the target is missed {words}"));
        }
        Ok(matched)
    }
}

/// Returns an error about a motion that misses its target.
pub(crate) fn not_converged(
    misfit: f64,
    missed: &str,
    rounds: usize,
    settings: &Matching,
) -> MotionError {
    MotionError::NotConverged {
        what: "spectral matching".to_owned(),
        reached: format!("a misfit of {:.1} % ({missed})", 100.0 * misfit),
        rounds,
        wanted: format!("{:.1} %", 100.0 * settings.tolerance),
        remedy: "start from a motion closer to the target, accept a larger tolerance, or accept the best motion as it is"
            .to_owned(),
    }
}

fn check(settings: &Matching, time_step: f64) -> Result<(), MotionError> {
    let Matching { shortest, longest, tolerance, rounds, .. } = *settings;
    let least = 4.0 * time_step;
    MotionError::require(
        shortest >= least && shortest < longest,
        "shortest matched period (s)",
        format!("at least four steps, {least} s, and below {longest} s"),
        shortest,
    )?;
    MotionError::require_positive("matching tolerance", tolerance)?;
    MotionError::require_finite("longest matched period (s)", longest)?;
    MotionError::require((1..=10_000).contains(&rounds), "matching rounds", "1 to 10000", rounds)
}

/// Subdivides the steps of a piecewise-linear motion, so that wavelets and peaks are resolved.
/// There are then at least [`STEPS_A_PERIOD`] steps per shortest matched period. Returns the new
/// time step (s) and the accelerations.
pub(crate) fn subdivided(motion: &Sampled, shortest: f64) -> (f64, Vec<f64>) {
    let parts = parts(motion.time_step(), shortest);
    let a = motion.acceleration();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 5")]
    let count = parts as usize;
    let mut fine = Vec::with_capacity(count * a.len());
    for pair in a.windows(2) {
        for part in 0..count {
            fine.push(pair[0] + (pair[1] - pair[0]) * part as f64 / parts);
        }
    }
    fine.extend(a.last());
    (motion.time_step() / parts, fine)
}

/// Returns the number of parts into which `time_step` (s) must be divided, so that an oscillation
/// with the period `shortest` (s) has at least [`STEPS_A_PERIOD`] steps per period.
fn parts(time_step: f64, shortest: f64) -> f64 {
    (STEPS_A_PERIOD * time_step / shortest * (1.0 - 1e-9)).ceil().max(1.0)
}

/// Returns the number of intervals into which the range from the shortest to the longest period is
/// divided, with [`PER_DECADE`] intervals per decade.
fn intervals(settings: &Matching) -> usize {
    let decades = math::log10(settings.longest / settings.shortest);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small, positive")]
    let count = (PER_DECADE * decades).ceil().clamp(1.0, 1000.0) as usize;
    count
}

/// Returns a logarithmic grid of periods (s) from the shortest to the longest matched period.
///
/// The grid divides every interval between matched periods into `finer` intervals.
fn judged_periods(settings: &Matching, finer: usize) -> Vec<f64> {
    math::log_space(settings.shortest, settings.longest, finer * intervals(settings))
}

/// Returns the periods matched in one round: the shortest, the longest, and a grid between them.
/// The grid shifts from round to round, so that every period is covered.
pub(crate) fn matched_periods(settings: &Matching, round: usize) -> Vec<f64> {
    let count = intervals(settings);
    let shift = (0.618_033_988_749_894_8 * (round - 1) as f64).fract();
    let ratio = math::ln(settings.longest / settings.shortest) / count as f64;
    let mut periods = vec![settings.shortest];
    periods.extend(
        (0..count)
            .map(|k| settings.shortest * math::exp(ratio * (k as f64 + shift)))
            .filter(|period| *period > settings.shortest * 1.000_1),
    );
    periods.push(settings.longest);
    periods
}

/// Returns the geometric mean, over all periods, of the ratio of target to response spectrum.
pub(crate) fn mean_ratio(goal: &[f64], now: &[f64]) -> f64 {
    let sum: f64 = goal.iter().zip(now).map(|(g, n)| math::ln(g / n)).sum();
    math::exp(sum / goal.len() as f64)
}

pub(crate) fn misfit_of(goal: &[f64], now: &[f64]) -> f64 {
    goal.iter().zip(now).map(|(g, n)| (n / g - 1.0).abs()).fold(0.0, f64::max)
}

/// Data that are constant during a match: target, periods and processing.
pub(crate) struct Work<'a> {
    pub(crate) time_step: f64,
    pub(crate) target: &'a TargetSpectrum,
    judged: Vec<f64>,
    judged_goal: Vec<f64>,
    checked: Vec<f64>,
    checked_goal: Vec<f64>,
    pub(crate) damping: f64,
    chain: Processing,
}

impl<'a> Work<'a> {
    /// Prepares a match to `target`. `time_step` is the time step (s) of the motion before
    /// [`subdivided`] reduces it.
    pub(crate) fn new(
        target: &'a TargetSpectrum,
        settings: &Matching,
        time_step: f64,
    ) -> Result<Self, MotionError> {
        target.check()?;
        check(settings, time_step)?;
        let goals = |periods: &[f64]| periods.iter().map(|&t| target.acceleration(t)).collect();
        let judged = judged_periods(settings, JUDGED);
        let judged_goal: Vec<f64> = goals(&judged);
        let checked = judged_periods(settings, CHECKED * JUDGED);
        let checked_goal = goals(&checked);
        // Remove drift below the longest matched period.
        let chain = Processing {
            high_pass: Some(0.25 / settings.longest),
            pads: Pads::Removed,
            close: true,
            ..Processing::none()
        };
        let time_step = time_step / parts(time_step, settings.shortest);
        let damping = target.damping();
        Ok(Self { time_step, target, judged, judged_goal, checked, checked_goal, damping, chain })
    }

    /// Returns the exact pseudo-accelerations (m/s²) at the given periods.
    fn spectrum(&self, periods: &[f64], acceleration: &[f64]) -> Vec<f64> {
        pseudo_accelerations(self.time_step, acceleration, periods, self.damping)
    }

    /// Returns a motion at successively coarser time steps ([`Layers`]), for oscillators with periods
    /// up to the longest matched period.
    pub(crate) fn layers(&self, acceleration: &[f64]) -> Layers {
        let longest = self.checked.last().copied().unwrap_or(0.0);
        Layers::new(self.time_step, acceleration, longest)
    }

    /// Returns approximate pseudo-accelerations (m/s²) at ascending periods, accurate enough for
    /// the rounds of a match.
    fn nearly(&self, periods: &[f64], acceleration: &[f64]) -> Vec<f64> {
        self.layers(acceleration).pseudo_accelerations(periods, self.damping)
    }

    /// Returns the approximate largest misfit at the judged periods; the computation is fast enough
    /// for every round.
    pub(crate) fn judged_misfit(&self, acceleration: &[f64]) -> f64 {
        misfit_of(&self.judged_goal, &self.nearly(&self.judged, acceleration))
    }

    /// Returns the exact largest relative misfit at all checked periods.
    pub(crate) fn misfit(&self, acceleration: &[f64]) -> f64 {
        misfit_of(&self.checked_goal, &self.spectrum(&self.checked, acceleration))
    }

    /// Returns the judged periods (s), at which every round evaluates the misfit, and their target
    /// values (m/s²).
    pub(crate) fn judged(&self) -> (&[f64], &[f64]) {
        (&self.judged, &self.judged_goal)
    }

    /// Returns the checked periods (s), at which the final misfit is evaluated, and their target
    /// values (m/s²).
    pub(crate) fn checked(&self) -> (&[f64], &[f64]) {
        (&self.checked, &self.checked_goal)
    }

    /// Returns the ranges of periods in which the misfit exceeds the tolerance.
    fn missed(&self, acceleration: &[f64], tolerance: f64) -> Vec<Missed> {
        self.missed_at(&self.spectrum(&self.checked, acceleration), tolerance)
    }

    /// Returns the ranges of periods in which a spectrum, given at the checked periods, misses the
    /// target by more than the tolerance.
    pub(crate) fn missed_at(&self, now: &[f64], tolerance: f64) -> Vec<Missed> {
        let mut ranges: Vec<Missed> = Vec::new();
        let mut open = false;
        for ((&period, n), g) in self.checked.iter().zip(now).zip(&self.checked_goal) {
            let misfit = n / g - 1.0;
            if misfit.abs() <= tolerance {
                open = false;
                continue;
            }
            match ranges.last_mut() {
                Some(last) if open && last.misfit.signum() == misfit.signum() => {
                    last.to = period;
                    if misfit.abs() > last.misfit.abs() {
                        last.misfit = misfit;
                    }
                }
                _ => ranges.push(Missed { from: period, to: period, misfit }),
            }
            open = true;
        }
        ranges
    }

    /// Compares the approximate spectrum with the target at every second checked period.
    pub(crate) fn fit(&self, acceleration: &[f64]) -> Fit {
        let half = |all: &[f64]| all.iter().copied().step_by(2).collect::<Vec<f64>>();
        let (periods, goal) = (half(&self.checked), half(&self.checked_goal));
        let now = self.nearly(&periods, acceleration);
        let misfits: Vec<f64> = goal.iter().zip(&now).map(|(g, n)| (n / g - 1.0).abs()).collect();
        let powers = misfits.iter().map(|misfit| {
            let square = misfit * misfit;
            let fourth = square * square;
            fourth * fourth * fourth
        });
        let mean = powers.sum::<f64>() / now.len() as f64;
        let peak = |&k: &usize| {
            let at = |k: Option<usize>| k.and_then(|k| misfits.get(k)).copied().unwrap_or(0.0);
            misfits[k] >= at(k.checked_sub(1)) && misfits[k] > at(k.checked_add(1))
        };
        Fit {
            misfit: misfits.iter().copied().fold(0.0, f64::max),
            roughness: math::powf(mean, 1.0 / 12.0),
            worst: (0..misfits.len()).filter(peak).map(|k| (periods[k], misfits[k])).collect(),
        }
    }

    /// Brings the final velocity and displacement to zero. Unlike [`Work::steady`], this function
    /// applies no filter, because wavelets cause no drift.
    pub(crate) fn close(&self, acceleration: &[f64]) -> Result<Vec<f64>, MotionError> {
        let ends = Processing { high_pass: None, ..self.chain.clone() };
        Ok(ends.apply(self.time_step, acceleration, 0.0)?.acceleration)
    }

    /// Removes drift by a high-pass filter and brings the final velocity and displacement to zero.
    pub(crate) fn steady(&self, acceleration: &[f64]) -> Result<Vec<f64>, MotionError> {
        Ok(self.chain.apply(self.time_step, acceleration, 0.0)?.acceleration)
    }

    /// Runs the methods in turn. Returns the best motion and the first method of the attempt that
    /// produced it ([`Matched::first`]).
    ///
    /// If the time domain is requested, the first attempt adds wavelets to `start`. If it misses the
    /// tolerance, or if the frequency domain is requested, every further attempt begins in the
    /// frequency domain with one of [`AMPLITUDE_STEPS`], and then adds wavelets.
    fn alternate(
        &self,
        start: &[f64],
        settings: &Matching,
    ) -> Result<(Best, MatchMethod), MotionError> {
        let mut best = Best::new(start);
        if settings.method == MatchMethod::Time {
            self.wavelets(start, settings, &mut best)?;
            if best.misfit <= settings.tolerance {
                return Ok((best, MatchMethod::Time));
            }
        }
        let stalled = best.misfit;
        let most = MOST_SAMPLES / start.len();
        for step in AMPLITUDE_STEPS {
            if best.misfit <= CLEAR * settings.tolerance || best.rounds > most {
                break;
            }
            let near = self.in_frequency(start, settings, step, &mut best)?;
            self.wavelets(&near, settings, &mut best)?;
        }
        let began = best.misfit < stalled;
        Ok((best, if began { MatchMethod::Frequency } else { settings.method }))
    }

    /// Adds wavelets in rounds. If the result misses the tolerance, `wavelets::polish` improves it in
    /// further rounds with smaller corrections.
    fn wavelets(
        &self,
        start: &[f64],
        settings: &Matching,
        best: &mut Best,
    ) -> Result<(), MotionError> {
        if best.misfit > CLEAR * settings.tolerance {
            let near = wavelets::match_in_time(self, start, settings, best)?;
            if best.misfit > CLEAR * settings.tolerance {
                wavelets::polish(self, near, settings, best)?;
            }
        }
        Ok(())
    }

    /// Changes the Fourier amplitudes in rounds and returns the best motion. Every round multiplies
    /// them by the ratio of target to response spectrum, raised to the power `step`.
    fn in_frequency(
        &self,
        start: &[f64],
        settings: &Matching,
        step: f64,
        all: &mut Best,
    ) -> Result<Vec<f64>, MotionError> {
        let length = (start.len() + start.len() / 4).next_power_of_two();
        let mut a = start.to_vec();
        let (mut best, mut gained) = (Best::new(&a), 0);
        // The ratios are interpolated over the logarithm of frequency, from long to short periods.
        let ln_f: Vec<f64> = self.judged.iter().rev().map(|t| -math::ln(*t)).collect();
        for round in 1..=settings.rounds {
            let now = self.nearly(&self.judged, &a);
            if best.offer(&a, misfit_of(&self.judged_goal, &now)) {
                gained = round;
            }
            if best.misfit <= GOOD_ENOUGH * settings.tolerance || round > gained + PATIENCE {
                break;
            }
            let ratio: Vec<f64> = self
                .judged_goal
                .iter()
                .zip(&now)
                .rev()
                .map(|(g, n)| math::powf(g / n, step).clamp(0.5, 2.0))
                .collect();
            let mut spectrum = forward_real(&a, length);
            apply_gain(&mut spectrum, self.time_step, |f| {
                if f > 0.0 { math::interpolate(&ln_f, &ratio, math::ln(f)) } else { 0.0 }
            });
            inverse(&mut spectrum);
            let changed: Vec<f64> = spectrum[..a.len()].iter().map(|x| x.re).collect();
            a = self.steady(&changed)?;
            all.rounds += 1;
        }
        all.offer(&best.acceleration, self.misfit(&best.acceleration));
        Ok(best.acceleration)
    }
}

/// Misfit between a spectrum and its target.
pub(crate) struct Fit {
    /// Largest relative misfit.
    pub(crate) misfit: f64,
    /// Power mean of all misfits with exponent 12, in which the largest misfits dominate.
    pub(crate) roughness: f64,
    /// Periods (s) at which the misfit has a local maximum, each with its misfit.
    pub(crate) worst: Vec<(f64, f64)>,
}

/// The best motion found so far.
pub(crate) struct Best {
    pub(crate) acceleration: Vec<f64>,
    pub(crate) misfit: f64,
    /// Total number of rounds of the match.
    pub(crate) rounds: usize,
}

impl Best {
    pub(crate) fn new(acceleration: &[f64]) -> Self {
        Self { acceleration: acceleration.to_vec(), misfit: f64::INFINITY, rounds: 0 }
    }

    /// Keeps a motion if its misfit is smaller than the best misfit so far; returns `true` if the
    /// motion was kept.
    pub(crate) fn offer(&mut self, acceleration: &[f64], misfit: f64) -> bool {
        let better = misfit < self.misfit;
        if better {
            self.acceleration = acceleration.to_vec();
            self.misfit = misfit;
        }
        better
    }
}
