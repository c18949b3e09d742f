//! Alignment of the channels of a record to a common time span.

use crate::error::MotionError;
use crate::math::{self, PI};
use crate::record::{Channel, Record, Stage};
use crate::sampled::integrate;
use crate::site::Site;
use crate::utc::Utc;

/// Number of samples used for interpolation on each side of a point. Shifts by a fraction of a time
/// step need interpolation.
const REACH: usize = 32;
/// Shifts below this fraction of a time step are ignored, because they are smaller than the errors of
/// recorder clocks.
const NEGLECTED: f64 = 0.01;

impl Record {
    /// Aligns channels that begin at different instants. The channels are cut to their common time
    /// span and then shifted by the remaining fraction of a time step. The cuts and shifts are
    /// added to the notes.
    ///
    /// Channels are shifted by sinc interpolation with a squared-cosine window over 32 samples on
    /// each side. Below 80 % of the Nyquist frequency, the error is at most 1e-4 of the amplitude.
    /// Channels with an unknown start time are not changed.
    ///
    /// # Errors
    /// If the channels have no common span.
    pub fn align(&mut self) -> Result<(), MotionError> {
        let all: Vec<usize> = (0..self.channels.len()).collect();
        self.align_some(&all)
    }

    /// Aligns the channels of each station and sensor separately; see [`Record::align`].
    pub(crate) fn align_each_site(&mut self) -> Result<(), MotionError> {
        let mut sites: Vec<(Site, Vec<usize>)> = Vec::new();
        for (place, channel) in self.channels.iter().enumerate() {
            match sites.iter_mut().find(|(site, _)| *site == channel.site) {
                Some((_, places)) => places.push(place),
                None => sites.push((channel.site.clone(), vec![place])),
            }
        }
        sites.iter().try_for_each(|(_, places)| self.align_some(places))
    }

    fn align_some(&mut self, places: &[usize]) -> Result<(), MotionError> {
        let spans: Vec<(usize, Utc, Utc)> = places
            .iter()
            .filter_map(|&place| {
                let channel = &self.channels[place];
                let start = channel.start?;
                Some((place, start, start.later(channel.duration())))
            })
            .collect();
        let Some((latest, begin)) = spans.iter().map(|(p, s, _)| (*p, *s)).max_by_key(|(_, s)| *s)
        else {
            return Ok(());
        };
        if spans.iter().all(|(_, start, _)| *start == begin) {
            return Ok(());
        }
        let end = spans.iter().map(|(_, _, end)| *end).min().unwrap_or(begin);
        let longest_step =
            spans.iter().map(|(p, ..)| self.channels[*p].time_step).fold(0.0, f64::max);
        let each: Vec<String> = spans
            .iter()
            .map(|(p, start, end)| format!("{} {start} to {end}", self.channels[*p].name))
            .collect();
        let apart = MotionError::mismatch(
            format!("the channels have no common time span: {}", each.join(", ")),
            "give channels that were recorded at the same time",
        );
        if !(end.since(begin) >= longest_step) {
            return Err(apart);
        }
        let reference = self.channels[latest].name.clone();
        for (place, start, _) in spans {
            let corrected = self.stage == Stage::Corrected;
            let channel = &mut self.channels[place];
            let before = channel.acceleration.len();
            let late = begin.since(start);
            let shifted = begin_later(channel, late, end.since(begin), corrected);
            channel.start = Some(begin);
            if channel.acceleration.len() < 2 {
                return Err(apart);
            }
            let lost = before - channel.acceleration.len();
            if late == 0.0 && lost == 0 {
                continue;
            }
            let name = &channel.name;
            let begins = match late {
                0.0 => format!("channel {name}"),
                _ => format!("channel {name} begins {late:.4} s before {reference}"),
            };
            let rest = shifted.map_or_else(String::new, |share| {
                format!(
                    ", and the rest was shifted by {share:.3} of a step (interpolated by a windowed sinc)"
                )
            });
            let note =
                format!("{begins}: {lost} samples outside the common time span were cut{rest}");
            self.notes.push(note);
        }
        Ok(())
    }
}

/// Makes a channel begin `late` seconds later and last `length` seconds. Returns the fraction of a
/// time step by which the channel was shifted by interpolation; `None` if it was not interpolated. If
/// `corrected` is `true`, the initial velocity becomes the velocity at the new first sample.
fn begin_later(channel: &mut Channel, late: f64, length: f64, corrected: bool) -> Option<f64> {
    let steps = late / channel.time_step;
    let part = steps - steps.round();
    let shifted = (part.abs() >= NEGLECTED).then_some(part);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the record"
    )]
    let whole = |value: f64| value.max(0.0) as usize;
    let first = whole(steps.round());
    if corrected && first > 0 {
        let (velocity, _) =
            integrate(channel.time_step, &channel.acceleration, channel.initial_velocity);
        channel.initial_velocity = velocity[first.min(velocity.len() - 1)];
    }
    let count = whole((length / channel.time_step + NEGLECTED).floor()) + 1;
    let last = (first + count).min(channel.acceleration.len());
    channel.acceleration = match shifted {
        None => channel.acceleration[first.min(last)..last].to_vec(),
        Some(part) => interpolated(&channel.acceleration, first..last, part),
    };
    shifted
}

/// Returns the values interpolated at the positions `k + part` (in samples), for every `k` in
/// `range`. Near the ends, where some samples of the window are missing, the weights of the other
/// samples are normalized.
fn interpolated(values: &[f64], range: std::ops::Range<usize>, part: f64) -> Vec<f64> {
    let reach = REACH as f64;
    // Weight of the sample `j - REACH` steps away.
    let weights: Vec<f64> = (0..=2 * REACH)
        .map(|j| {
            let x = j as f64 - reach - part;
            let (sine, window) = (math::sin(PI * x), math::cos(0.5 * PI * x / (reach + 1.0)));
            sine / (PI * x) * window * window
        })
        .collect();
    range
        .map(|k| {
            let (mut sum, mut weight) = (0.0, 0.0);
            for (j, w) in weights.iter().enumerate() {
                if let Some(value) = (k + j).checked_sub(REACH).and_then(|at| values.get(at)) {
                    sum += w * value;
                    weight += w;
                }
            }
            sum / weight
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_by_part_of_a_step_is_exact_below_the_nyquist_frequency() {
        // The measured errors are just below these limits.
        for (share, limit) in [(0.1, 2e-5), (0.5, 2e-5), (0.8, 1e-4), (0.9, 3e-3)] {
            let wave = |t: f64| (PI * share * t + 0.4).sin();
            let values: Vec<f64> = (0..400).map(|k| wave(f64::from(k))).collect();
            for part in [-0.5, -0.2, 0.013, 0.37, 0.5] {
                let shifted = interpolated(&values, 50..350, part);
                let worst = shifted
                    .iter()
                    .zip(50..350)
                    .map(|(v, k)| (v - wave(f64::from(k) + part)).abs())
                    .fold(0.0, f64::max);
                assert!(worst < limit, "{share} of Nyquist, {part}: {worst:e}");
            }
        }
        // A constant stays constant up to the ends.
        let flat = interpolated(&[2.0; 40], 0..40, 0.3);
        assert!(flat.iter().all(|v| (v - 2.0).abs() < 1e-12));
    }
}
