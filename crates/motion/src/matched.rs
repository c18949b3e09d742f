//! Result of spectral matching.

use crate::ground_motion::GroundMotion;
use crate::matching::MatchMethod;

/// A range of periods in which a spectrum exceeds its target, or falls short of it, by more than the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Missed {
    /// Shortest period of the range (s).
    pub from: f64,
    /// Longest period of the range (s).
    pub to: f64,
    /// Relative misfit of the largest magnitude in the range; negative if the spectrum is below the target.
    pub misfit: f64,
}

/// Maximum number of missed ranges that a description lists.
const MOST_LISTED: usize = 5;

/// A motion matched to a target spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Matched {
    /// The motion. The horizontal component is matched; the vertical component is only multiplied by
    /// the factor described for [`GroundMotion::match_spectrum`].
    pub motion: GroundMotion,
    /// Largest relative misfit at any period from the shortest to the longest matched period, on a grid of
    /// 1080 periods per decade.
    pub misfit: f64,
    /// Ranges of periods in which the misfit exceeds the tolerance; empty if the tolerance is met.
    pub missed: Vec<Missed>,
    /// Number of rounds.
    pub rounds: usize,
    /// The requested method.
    pub chosen: MatchMethod,
    /// First method of the attempt that produced the motion. This is the requested method, or the
    /// frequency domain if wavelets alone missed the tolerance and a restart in the frequency domain
    /// came closer.
    pub first: MatchMethod,
}

/// Outcome of matching two components together to a target spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchedPair {
    /// Largest relative misfit; see [`Matched::misfit`].
    pub misfit: f64,
    /// Ranges of periods in which the misfit exceeds the tolerance; see [`Matched::missed`].
    pub missed: Vec<Missed>,
    /// Number of rounds.
    pub rounds: usize,
}

impl Matched {
    /// Describes the missed ranges, such as "by +5.6 % at 0.41 to 0.43 s, ...". If there are many
    /// ranges, the worst are listed and the others are counted.
    pub fn missed_in_words(&self) -> String {
        missed_in_words(&self.missed)
    }

    /// Describes the domain of the match, in words that follow "matched in".
    pub fn domain(&self) -> &'static str {
        match (self.first, self.chosen) {
            (MatchMethod::Time, _) => "the time domain",
            (MatchMethod::Frequency, MatchMethod::Frequency) => "the frequency domain",
            (MatchMethod::Frequency, MatchMethod::Time) => {
                "the frequency domain, because matching in the time domain made no further progress,"
            }
        }
    }
}

/// Describes missed ranges, such as "by +5.6 % at 0.41 to 0.43 s, ...". If there are many ranges, the
/// worst are listed and the others are counted.
pub fn missed_in_words(all: &[Missed]) -> String {
    let words = |missed: &Missed| {
        let (from, to) = (format!("{:.3}", missed.from), format!("{:.3}", missed.to));
        let periods = if from == to { from } else { format!("{from} to {to}") };
        format!("by {:+.1} % at {periods} s", 100.0 * missed.misfit)
    };
    let mut sizes: Vec<f64> = all.iter().map(|missed| missed.misfit.abs()).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    let least = sizes.get(MOST_LISTED - 1).copied().unwrap_or(0.0);
    let worst = all.iter().filter(|missed| missed.misfit.abs() >= least);
    let mut ranges: Vec<String> = worst.map(words).collect();
    let others = all.len() - ranges.len();
    if others > 0 {
        ranges.push(format!("by less in {others} other ranges"));
    }
    ranges.join(", ")
}
