//! Joins files: overlapping parts of one record, and components in separate files.

use crate::error::MotionError;
use crate::math;
use crate::record::{Channel, Record, Stage};

/// Words of the warning about a file that contains a part of a record.
pub(crate) const PART: &str = "one part of a longer record";

/// Shortest overlap of two parts (s).
const SHORTEST_OVERLAP: f64 = 1.0;
/// Largest root-mean-square difference between two parts in their overlap, divided by the root mean
/// square of their samples.
const LARGEST_MISFIT: f64 = 0.05;

impl Record {
    /// Combines several files, with one or more components each, into one record with a common time
    /// base ([`Record::align`]).
    ///
    /// Repeated channel names are prefixed with the file name.
    ///
    /// # Errors
    /// If no record is given, the time steps differ, or the files are of different stations,
    /// sensors, events, publishers or stages, or have no common time span.
    pub fn gather(records: &[Self]) -> Result<Self, MotionError> {
        if let Some((first, rest)) = records.split_first()
            && let Some(what) = rest.iter().find_map(|record| first.unlike(record))
        {
            let remedy = "give components recorded by one sensor in one event";
            return Err(MotionError::mismatch(what, remedy));
        }
        Self::gather_mixed(records)
    }

    /// Combines files as [`Record::gather`] does, but also files of different stations, sensors,
    /// events, publishers or stages.
    ///
    /// If the files differ in one of these, the result has a warning, and two of its channels may
    /// form a horizontal pair even if they belong to different stations or sensors
    /// ([`Record::mixed`]).
    ///
    /// # Errors
    /// If no record is given, the time steps differ, or the files have no common time span.
    pub fn gather_mixed(records: &[Self]) -> Result<Self, MotionError> {
        let Some((first, rest)) = records.split_first() else {
            return Err(MotionError::parameter("records to gather", "at least 1", 0));
        };
        let mut gathered = first.clone();
        for record in rest {
            for channel in &record.channels {
                let mut channel = channel.clone();
                if gathered.channels.iter().any(|other| other.name == channel.name) {
                    channel.name =
                        format!("{} {}", crate::format::file_stem(&record.file), channel.name);
                }
                require_step(&gathered.channels[0], &channel, ONE_STEP)?;
                gathered.channels.push(channel);
            }
            if record.stage != gathered.stage && first.unlike(record).is_none() {
                gathered.warn(
                    None,
                    format!(
                        "{} is {}, {} is {}",
                        first.file, first.stage, record.file, record.stage
                    ),
                );
            }
            gathered.warnings.extend(record.warnings.iter().cloned());
            gathered.notes.extend(record.notes.iter().cloned());
            gathered.file = format!("{}, {}", gathered.file, record.file);
            if let Some(what) = first.unlike(record) {
                gathered.mixed = true;
                gathered.warn(None, format!("combined although {what}"));
            }
        }
        if !rest.is_empty() {
            let known = gathered.channels.iter().filter(|channel| channel.start.is_some()).count();
            if known < gathered.channels.len() {
                let whose = if known == 0 { "no file states" } else { "not all files state" };
                gathered.notes.push(format!(
                    "{whose} a readable time of its first sample: the first samples are assumed to be simultaneous"
                ));
            }
            gathered.align()?;
        }
        Ok(gathered)
    }

    /// Cuts all channels to the length of the shortest channel, so that they fit into columns of
    /// one file. The notes list the samples that were cut.
    pub fn cut_to_shortest(&mut self) {
        let shortest = self.channels.iter().map(|c| c.acceleration.len()).min().unwrap_or(0);
        for channel in &mut self.channels {
            let extra = channel.acceleration.len() - shortest;
            if extra > 0 {
                channel.acceleration.truncate(shortest);
                self.notes.push(format!(
                    "{}: the last {extra} samples were cut, because the shortest channel ends there",
                    channel.name
                ));
            }
        }
    }

    /// Compares the headers of two files. Returns a description of the first difference in site, format, event or stage
    /// that prevents the files from being components of one record; `None` if there is no such difference.
    pub fn unlike(&self, other: &Self) -> Option<String> {
        let one = self;
        let files = format!("{} and {}", one.file, other.file);
        for a in &one.channels {
            if let Some(what) = other.channels.iter().find_map(|b| a.site.differs(&b.site)) {
                return Some(format!("{files} come from {what}"));
            }
        }
        // Files made by the user may be combined with files of a publisher.
        let own = |record: &Self| ["barrelstack", "columns"].contains(&record.format);
        if names_differ(one.format, other.format) && !own(one) && !own(other) {
            return Some(format!("{files} have the formats {} and {}", one.format, other.format));
        }
        if names_differ(&one.event, &other.event) {
            return Some(format!("{files} are of \"{}\" and \"{}\"", one.event, other.event));
        }
        let stages = (one.stage, other.stage);
        let known = one.stage != Stage::Unknown && other.stage != Stage::Unknown;
        (known && one.stage != other.stage)
            .then(|| format!("{files} are {} and {}", stages.0, stages.1))
    }

    /// Joins overlapping parts of one long record.
    ///
    /// The overlap is found by comparing the start of the later part with every position in the
    /// earlier part. The later part is then shifted to the baseline of the earlier part. Parts are
    /// joined only if the samples in the overlap are the same in both parts. Parts that overlap by
    /// less than 1 s are refused.
    ///
    /// # Errors
    /// If no part is given, channels or time steps differ, or two consecutive parts do not overlap.
    pub fn join(parts: &[Self]) -> Result<Self, MotionError> {
        let Some((first, rest)) = parts.split_first() else {
            return Err(MotionError::parameter("parts to join", "at least 1", 0));
        };
        let mut joined = first.clone();
        for part in rest {
            join_pair(&mut joined, part)?;
        }
        joined.warnings.retain(|warning| !warning.message.contains(PART));
        Ok(joined)
    }

    /// Returns `true` if the name of the file indicates one part of a longer record, which [`Record::join`] completes.
    pub fn is_part(&self) -> bool {
        self.warnings.iter().any(|warning| warning.message.contains(PART))
    }
}

/// Returns `true` if two names differ; an empty name matches any name.
///
/// Case, blanks and punctuation are ignored, because formats replace commas, parentheses and
/// accents. Non-ASCII characters are also ignored if a letter or digit remains.
pub(crate) fn names_differ(one: &str, other: &str) -> bool {
    let letters = |name: &str| {
        let kept = name.chars().filter(char::is_ascii_alphanumeric);
        kept.map(|c| c.to_ascii_lowercase()).collect::<String>()
    };
    if one.is_empty() || other.is_empty() || one.eq_ignore_ascii_case(other) {
        return false;
    }
    let (a, b) = (letters(one), letters(other));
    if a.is_empty() && b.is_empty() { !one.contains('?') && !other.contains('?') } else { a != b }
}

const ONE_STEP: &str = "give files with the same time step";

/// Checks that two channels have the same time step; the error includes the given remedy.
pub(crate) fn require_step(
    one: &Channel,
    other: &Channel,
    remedy: &str,
) -> Result<(), MotionError> {
    if (one.time_step / other.time_step - 1.0).abs() > 1e-9 {
        let what = format!(
            "channel {} has a step of {} s, channel {} of {} s",
            one.name, one.time_step, other.name, other.time_step
        );
        return Err(MotionError::mismatch(what, remedy));
    }
    Ok(())
}

fn join_pair(joined: &mut Record, part: &Record) -> Result<(), MotionError> {
    let refuse =
        |what: String| MotionError::mismatch(what, "give the parts of one record in order of time");
    let mut overlap = None;
    // Channels of plain columns are named after their files. If no name is shared, channels are
    // matched by their order in the file.
    let shares = |channel: &Channel| part.channels.iter().any(|other| other.name == channel.name);
    let by_order =
        joined.channels.len() == part.channels.len() && !joined.channels.iter().any(shares);
    for (place, mine) in joined.channels.iter_mut().enumerate() {
        let name = mine.name.clone();
        let theirs = if by_order {
            part.channels.get(place)
        } else {
            part.channels.iter().find(|channel| channel.name == name)
        };
        let Some(theirs) = theirs else {
            return Err(refuse(format!("{} has no channel {name}", part.file)));
        };
        require_step(mine, theirs, ONE_STEP)?;
        let found = match overlap {
            Some(samples) => samples,
            None => find_overlap(mine, theirs).ok_or_else(|| {
                refuse(format!(
                    "the start of {} does not repeat the end of {}",
                    part.file, joined.file
                ))
            })?,
        };
        overlap = Some(found);
        let shorter =
            |file: &str| refuse(format!("channel {name} of {file} is shorter than the overlap"));
        let start =
            mine.acceleration.len().checked_sub(found).ok_or_else(|| shorter(&joined.file))?;
        if found > theirs.acceleration.len() {
            return Err(shorter(&part.file));
        }
        let (tail, head) = (&mine.acceleration[start..], &theirs.acceleration[..found]);
        let misfit = misfit(tail, head);
        if !(misfit <= LARGEST_MISFIT) {
            return Err(refuse(format!(
                "channel {name}: in the overlap, {} differs by {:.0} % from the preceding file",
                part.file,
                100.0 * misfit
            )));
        }
        let offset = math::mean(tail) - math::mean(head);
        let seconds = found as f64 * mine.time_step;
        mine.acceleration.extend(theirs.acceleration[found..].iter().map(|a| a + offset));
        // The stated peaks apply to the parts, not to the joined record.
        mine.peaks.clear();
        joined.notes.push(format!(
            "channel {name}: {} joined where its first {seconds:.2} s repeat the end of the \
             previous part, baseline shifted by {offset:.3e} m/s2",
            part.file
        ));
    }
    joined.warnings.extend(part.warnings.iter().cloned());
    joined.file = format!("{}, {}", joined.file, part.file);
    Ok(())
}

/// Returns the number of samples at the end of `first` that `second` repeats at its start.
fn find_overlap(first: &Channel, second: &Channel) -> Option<usize> {
    let (a, b) = (&first.acceleration, &second.acceleration);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, small")]
    let shortest = (SHORTEST_OVERLAP / first.time_step).ceil().min(1e9) as usize;
    let longest = a.len().min(b.len());
    // The compared samples must contain motion; otherwise, any quiet interval would match.
    let probe_length = shortest.max(200).min(longest);
    let mut best: Option<(f64, usize)> = None;
    for samples in (shortest..=longest).rev() {
        let start = a.len() - samples;
        let length = probe_length.min(samples);
        let misfit = misfit(&a[start..start + length], &b[..length]);
        if misfit <= LARGEST_MISFIT && best.is_none_or(|(least, _)| misfit < least) {
            best = Some((misfit, samples));
        }
    }
    best.map(|(_, samples)| samples)
}

/// Removes the means of two series, and returns the root-mean-square difference of the series
/// divided by the root mean square of their samples.
fn misfit(one: &[f64], other: &[f64]) -> f64 {
    let (mean_one, mean_other) = (math::mean(one), math::mean(other));
    let (mut difference, mut size) = (0.0, 0.0);
    for (a, b) in one.iter().zip(other) {
        let (a, b) = (a - mean_one, b - mean_other);
        difference += (a - b) * (a - b);
        size += 0.5 * (a * a + b * b);
    }
    if size > 0.0 { (difference / size).sqrt() } else { f64::INFINITY }
}
