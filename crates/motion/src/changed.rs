//! Operations on whole records: processing, scaling and matching. Every step is added to the notes
//! of the record.

use crate::error::MotionError;
use crate::ground_motion::GroundMotion;
use crate::history::History;
use crate::horizontals::Horizontals;
use crate::matched::{Matched, MatchedPair, missed_in_words};
use crate::matching::{Matching, STEPS_A_PERIOD, Work, mean_ratio, not_converged, subdivided};
use crate::matching_pair::{match_pair, spectrum};
use crate::process::Processing;
use crate::record::{Channel, Record, Stage};
use crate::sampled::Sampled;
use crate::target::TargetSpectrum;

impl Channel {
    /// Returns the channel as a sampled motion that starts with the channel's initial velocity.
    ///
    /// # Errors
    /// The same as for [`Sampled::new`].
    pub fn sampled(&self) -> Result<Sampled, MotionError> {
        let acceleration = self.acceleration.clone();
        Sampled::with_initial_velocity(self.time_step, acceleration, self.initial_velocity)
    }
}

impl Record {
    /// Returns the record with all channels processed. Every step is added to the notes.
    ///
    /// ```
    /// use barrelstack_motion::{Processing, bundled};
    /// let napa = bundled("napa-college-2014").unwrap();
    /// let gentle = napa.processed(&Processing { high_pass: Some(0.2), ..Processing::none() })?;
    /// assert!(gentle.channels[0].pgd() < napa.channels[0].pgd());
    /// # Ok::<(), barrelstack_motion::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// If a setting is out of range for a channel.
    pub fn processed(&self, chain: &Processing) -> Result<Self, MotionError> {
        let mut out = self.clone();
        for channel in &mut out.channels {
            let done = chain
                .apply(channel.time_step, &channel.acceleration, channel.initial_velocity)
                .map_err(|error| {
                    let what = format!("{}, channel {}: {error}", self.file, channel.name);
                    MotionError::mismatch(what, "give a value in this range")
                })?;
            channel.acceleration = done.acceleration;
            channel.initial_velocity = done.initial_velocity;
            for step in done.steps {
                out.notes.push(format!("{}: {step}", channel.name));
            }
            // The peaks stated in the header do not apply to the processed values.
            channel.peaks.clear();
        }
        out.stage = Stage::Corrected;
        Ok(out)
    }

    /// Returns the record with all channels multiplied by one factor.
    ///
    /// This method adds no note, because only the caller knows the purpose of the factor.
    #[must_use]
    pub fn multiplied(&self, factor: f64) -> Self {
        let mut out = self.clone();
        for channel in &mut out.channels {
            for value in &mut channel.acceleration {
                *value *= factor;
            }
            channel.initial_velocity *= factor;
            channel.peaks.clear();
        }
        out
    }

    /// Returns the record with the channel at index `place` matched to a target spectrum, and the outcome of
    /// the match. `named` is the name of the target in the notes.
    ///
    /// Before it is matched, the channel is scaled as described for [`GroundMotion::match_spectrum`]. All other
    /// channels are only multiplied by the same factor.
    ///
    /// If `nearly` is `true`, the best motion is accepted even if the tolerance is not reached.
    ///
    /// # Errors
    /// The same as for [`GroundMotion::match_spectrum`], and if there is no such channel.
    pub fn matched(
        &self,
        place: usize,
        target: &TargetSpectrum,
        named: &str,
        settings: &Matching,
        nearly: bool,
    ) -> Result<(Self, Matched), MotionError> {
        let channel = self.channels.get(place).ok_or_else(|| MotionError::NoChannel {
            file: self.file.clone(),
            wanted: format!("#{}", place + 1),
            available: self.channels.len().to_string(),
        })?;
        let horizontal = History::Sampled(channel.sampled()?);
        // Before the match, the motion is multiplied by one factor; for a vertical component, this is the only
        // change. A vertical component of constant acceleration 1 therefore yields this factor, which is then applied
        // to all other channels.
        let probe = History::Sampled(Sampled::new(1.0, vec![1.0, 1.0])?);
        let given = GroundMotion::new(channel.name.clone(), horizontal, Some(probe));
        let matched = if nearly {
            given.match_spectrum_nearly(target, settings)?
        } else {
            given.match_spectrum(target, settings)?
        };
        let factor =
            matched.motion.vertical.as_ref().map_or(1.0, |probe| probe.at(0.0).acceleration);
        let series = matched.motion.horizontal.sampled(matched.motion.horizontal.natural_step())?;
        let step = series.time_step();
        let mut after = self.clone();
        for (k, other) in after.channels.iter_mut().enumerate() {
            other.peaks.clear();
            if k == place {
                other.acceleration = series.acceleration().to_vec();
                other.initial_velocity = 0.0;
            } else {
                let scaled = History::Sampled(other.sampled()?.scaled(factor));
                other.acceleration = scaled.sampled(step)?.acceleration().to_vec();
                other.initial_velocity *= factor;
            }
            other.time_step = step;
        }
        after.stage = Stage::Corrected;
        after.notes.push(format!(
            "{}: scaled by {factor:.4} and matched in {} to {named} at periods from {} to {} s: \
             misfit at most {:.2} % after {} rounds, with the final velocity and displacement \
             brought to zero",
            channel.name,
            matched.domain(),
            settings.shortest,
            settings.longest,
            100.0 * matched.misfit,
            matched.rounds
        ));
        if after.channels.len() > 1 {
            after.notes.push(format!("all other components scaled by {factor:.4}"));
        }
        after.notes.extend(cut(channel.time_step, step));
        if !matched.missed.is_empty() {
            let words = matched.missed_in_words();
            after.notes.push(format!("{}: the target is missed {words}", channel.name));
        }
        Ok((after, matched))
    }

    /// Returns the record with both horizontal components matched together to a target spectrum, and the
    /// outcome of the match. `measure` is `RotD50` or `RotD100`; `named` is the name of the target in the notes.
    ///
    /// First, all channels are multiplied by one factor: the geometric mean, over the matched range of periods, of the
    /// ratio of target to response spectrum. The other channels are not changed further. Then the Fourier
    /// amplitudes of both components are multiplied by a gain that depends on the frequency; it is the same for
    /// both components, which keeps their polarization. Finally, wavelets are added along the directions of the
    /// measured response. `settings.method` is not used. If `nearly` is `true`, the best motion is accepted even
    /// if the tolerance is not reached.
    ///
    /// # Errors
    /// The same as for [`Record::horizontal_pair`], and if a setting is out of range, the measure
    /// is not `RotD50` or `RotD100`, the motion is zero, or the tolerance is not reached.
    pub fn matched_pair(
        &self,
        measure: Horizontals,
        target: &TargetSpectrum,
        named: &str,
        settings: &Matching,
        nearly: bool,
    ) -> Result<(Self, MatchedPair), MotionError> {
        if measure == Horizontals::GeometricMean {
            let what =
                "two components are matched over all directions, not by their geometric mean";
            return Err(MotionError::mismatch(what.to_owned(), "choose rotd50 or rotd100"));
        }
        let (first, second) = self.horizontal_pair()?;
        let names = [first.name.clone(), second.name.clone()];
        let (first, second) = self.horizontals(&Processing::none())?;
        let work = Work::new(target, settings, first.time_step())?;
        let given = [&first, &second].map(|one| subdivided(one, settings.shortest).1);
        let (periods, goals) = work.judged();
        let now = spectrum(&work, measure, periods, &given);
        let factor = mean_ratio(goals, &now);
        if !(factor.is_finite() && factor > 0.0) {
            return Err(MotionError::Zero {
                measure: "the response spectrum".to_owned(),
                motion: self.file.clone(),
                target: "the target spectrum".to_owned(),
            });
        }
        let scaled =
            |one: &Vec<f64>| work.steady(&one.iter().map(|a| a * factor).collect::<Vec<f64>>());
        let start = [scaled(&given[0])?, scaled(&given[1])?];
        let (pair, matched) = match_pair(&work, start, measure, settings)?;
        if !(nearly || matched.missed.is_empty()) {
            let missed = missed_in_words(&matched.missed);
            return Err(not_converged(matched.misfit, &missed, matched.rounds, settings));
        }
        let mut after = self.clone();
        for channel in &mut after.channels {
            channel.peaks.clear();
            if let Some(side) = names.iter().position(|name| *name == channel.name) {
                channel.acceleration.clone_from(&pair[side]);
                channel.initial_velocity = 0.0;
            } else {
                let scaled = History::Sampled(channel.sampled()?.scaled(factor));
                channel.acceleration = scaled.sampled(work.time_step)?.acceleration().to_vec();
                channel.initial_velocity *= factor;
            }
            channel.time_step = work.time_step;
        }
        after.stage = Stage::Corrected;
        after.notes.push(format!(
            "{} and {}: scaled by {factor:.4} and matched together, {measure} to {named} at \
             periods from {} to {} s: misfit at most {:.2} % after {} rounds, with the final \
             velocity and displacement brought to zero",
            names[0],
            names[1],
            settings.shortest,
            settings.longest,
            100.0 * matched.misfit,
            matched.rounds
        ));
        if after.channels.len() > 2 {
            after.notes.push(format!("all other components scaled by {factor:.4}"));
        }
        after.notes.extend(cut(first.time_step(), work.time_step));
        if !matched.missed.is_empty() {
            after.notes.push(format!("the target is missed {}", missed_in_words(&matched.missed)));
        }
        Ok((after, matched))
    }
}

/// Describes by how much spectral matching reduced the time step (s); `None` if the step is unchanged.
fn cut(before: f64, after: f64) -> Option<String> {
    (before != after).then(|| {
        format!(
            "time step reduced from {before} to {after} s, so that the shortest matched period has \
             {STEPS_A_PERIOD} steps; sums over samples, such as the Arias intensity, decrease \
             slightly, because the motion is linear between the samples"
        )
    })
}
