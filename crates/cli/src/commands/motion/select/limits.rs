//! Eligibility of records: ranges of magnitude, distance and site velocity, and the pulse class.

use std::str::FromStr;

use barrelstack_campaign::study::StudyTable;

/// A range that includes both limits. If the lower limit is left out, it is zero; if the upper limit is left out, the
/// range is unbounded above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    from: f64,
    to: f64,
}

impl Range {
    pub(super) fn ends(self) -> [f64; 2] {
        [self.from, self.to]
    }

    fn holds(self, value: f64) -> bool {
        (self.from..=self.to).contains(&value)
    }
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refuse =
            || "expected two numbers separated by .., such as 6..7.5, 6.. or ..30".to_owned();
        let (from, to) = text.split_once("..").ok_or_else(refuse)?;
        let end = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => text.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(refuse),
        };
        let range = Self { from: end(from, 0.0)?, to: end(to, f64::MAX)? };
        if range.from > range.to {
            return Err(format!("{} is above {}", range.from, range.to));
        }
        Ok(range)
    }
}

/// Limits on eligible records.
#[derive(Debug, clap::Args)]
pub(super) struct Limits {
    /// Range of magnitudes, from the flatfile or the header.
    #[arg(long, value_name = "FROM..TO")]
    pub(super) magnitude: Option<Range>,
    /// Range of distances in km: to the rupture, from the flatfile; without a flatfile, to the epicenter, from the
    /// header.
    #[arg(long, value_name = "FROM..TO")]
    pub(super) distance: Option<Range>,
    /// Range of Vs30 in m/s, from the flatfile or the header.
    #[arg(long, value_name = "FROM..TO")]
    pub(super) vs30: Option<Range>,
    /// Pulse class of eligible records, according to Shahi and Baker (2014) or, for a single horizontal component,
    /// Baker (2007).
    #[arg(long, value_enum, default_value_t = Pulses::Any)]
    pulses: Pulses,
}

/// Pulse class of eligible records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Pulses {
    /// All records.
    Any,
    /// Only pulse-like records.
    Only,
    /// Only records without a pulse.
    None,
}

/// For each limit, the number of records that the limit excludes and the number of records that
/// lack the data to apply the limit.
#[derive(Debug, Default)]
pub(super) struct LeftOut {
    /// Number of records whose distance is measured to the epicenter.
    by_epicenter: usize,
    counts: Vec<(&'static str, usize, usize)>,
}

impl Limits {
    /// Returns the rows within all limits, and the counts of the excluded rows.
    pub(super) fn rows(&self, table: &StudyTable) -> (Vec<usize>, LeftOut) {
        let mut rows: Vec<usize> = (0..table.rows()).collect();
        let mut left_out = LeftOut::default();
        let numbers = |name: &str| table.numbers(name).unwrap_or_default();
        let integers = |name: &str| table.integers(name).unwrap_or_default();
        let (rupture, epicenter) = (numbers("rupture_distance"), numbers("epicentral_distance"));
        let nearest = |(rupture, epicenter): (&Option<f64>, &Option<f64>)| rupture.or(*epicenter);
        let distances: Vec<Option<f64>> = rupture.iter().zip(epicenter).map(nearest).collect();
        let by_epicenter = rupture
            .iter()
            .zip(&distances)
            .filter(|(known, used)| known.is_none() && used.is_some());
        left_out.by_epicenter = self.distance.map_or(0, |_| by_epicenter.count());
        let ranges = [
            ("magnitude", self.magnitude, numbers("magnitude")),
            ("distance", self.distance, &distances),
            ("Vs30", self.vs30, numbers("vs30")),
        ];
        for (name, range, values) in ranges {
            let Some(range) = range else { continue };
            left_out.keep(name, &mut rows, |row| values[row].map(|value| range.holds(value)));
        }
        let wanted = match self.pulses {
            Pulses::Any => return (rows, left_out),
            Pulses::Only => 1,
            Pulses::None => 0,
        };
        let (pair, single) = (integers("pulse_shahi_baker"), integers("pulse_baker_h1"));
        let class = |row: usize| pair[row].or(single[row]).map(|class| class == wanted);
        left_out.keep("pulse class", &mut rows, class);
        (rows, left_out)
    }
}

impl LeftOut {
    fn keep(
        &mut self,
        name: &'static str,
        rows: &mut Vec<usize>,
        within: impl Fn(usize) -> Option<bool>,
    ) {
        let (mut outside, mut unknown) = (0, 0);
        rows.retain(|row| match within(*row) {
            Some(true) => true,
            Some(false) => {
                outside += 1;
                false
            }
            None => {
                unknown += 1;
                false
            }
        });
        self.counts.push((name, outside, unknown));
    }

    /// Describes how many records are candidates, and why the other records are excluded.
    pub(super) fn sentence(&self, all: usize, candidates: usize, spectrum: &str) -> String {
        let mut reasons = Vec::new();
        let mut lost = 0;
        for (name, outside, unknown) in &self.counts {
            lost += outside + unknown;
            if outside + unknown > 0 {
                reasons.push(format!(
                    "{outside} outside the limit of {name}, {unknown} of unknown {name}"
                ));
            }
        }
        if candidates + lost < all {
            reasons.push(format!("{} without a {spectrum} spectrum", all - candidates - lost));
        }
        if self.by_epicenter > 0 {
            reasons.push(format!(
                "distances of {} are to the epicenter, because no flatfile states the distance to the rupture",
                self.by_epicenter
            ));
        }
        let why =
            if reasons.is_empty() { String::new() } else { format!(": {}", reasons.join(", ")) };
        format!("{candidates} of {all} records are eligible{why}")
    }
}
