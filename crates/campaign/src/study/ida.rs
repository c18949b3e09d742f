//! Choice of the levels in one hunt of an incremental dynamic analysis.

/// Settings of a hunt: the search for the level at which one motion makes the stack collapse.
///
/// The method is hunt and fill (Vamvatsikos and Cornell 2004, Earthquake Spectra 20:523). Levels rise in
/// growing steps until the stack collapses. Then the gap between the highest level at which the stack stood
/// and the lowest level at which it collapsed is narrowed: each further run is placed at one third of the
/// gap. Each remaining run is placed in the middle of the widest gap between neighboring levels below this
/// narrowed gap. All levels are in SI units of the intensity measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Hunt {
    /// Lowest level, at which the hunt starts.
    pub first: f64,
    /// Size of the first step, from the first to the second level.
    pub step: f64,
    /// Amount by which each step is larger than the step before it.
    pub growth: f64,
    /// Narrowing stops when the gap between the highest level at which the stack stood and the lowest level at which it
    /// collapsed is at most this fraction of the former level.
    pub resolution: f64,
    /// Number of runs in each hunt.
    pub runs: u32,
}

/// Level of a run, and whether the stack collapsed in it (`None` if the run has no verdict).
pub(super) type LevelResult = (f64, Option<bool>);

impl Hunt {
    /// Returns the next level to run, given the results so far; `None` if the hunt is over.
    pub(super) fn next(&self, results: &[LevelResult]) -> Option<f64> {
        // A run without a verdict ends the hunt, since a run at the next level would fail as well.
        let known: Vec<(f64, bool)> = results
            .iter()
            .map(|(level, fell)| fell.map(|fell| (*level, fell)))
            .collect::<Option<_>>()?;
        if known.len() >= self.runs as usize {
            return None;
        }
        let lowest_fall =
            known.iter().filter(|(_, fell)| *fell).map(|(level, _)| *level).reduce(f64::min);
        let Some(fall) = lowest_fall else {
            let Some((last, _)) = known.last() else { return Some(self.first) };
            let steps = (known.len() - 1) as f64;
            return Some(last + self.step + steps * self.growth);
        };
        let stood =
            known.iter().filter(|(level, fell)| !*fell && *level < fall).map(|(level, _)| *level);
        let stood = stood.fold(0.0, f64::max);
        let gap = fall - stood;
        // If the stack stood at no level, a tenth of the first level takes the place of the highest level at which it
        // stood.
        if gap > self.resolution * stood.max(0.1 * self.first) {
            return Some(stood + gap / 3.0);
        }
        let mut below: Vec<f64> =
            known.iter().map(|(level, _)| *level).filter(|level| *level <= stood).collect();
        below.sort_by(f64::total_cmp);
        let widest = below.windows(2).map(|pair| (pair[1] - pair[0], 0.5 * (pair[0] + pair[1])));
        widest.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, middle)| middle)
    }
}

#[cfg(test)]
mod tests {
    use super::{Hunt, LevelResult};

    fn hunt() -> Hunt {
        Hunt { first: 0.1, step: 0.1, growth: 0.05, resolution: 0.1, runs: 14 }
    }

    /// Returns all levels of a hunt, for a stack that collapses at levels for which `falls` returns `true`.
    fn levels(hunt: &Hunt, falls: impl Fn(f64) -> bool) -> Vec<LevelResult> {
        let mut results = Vec::new();
        while let Some(level) = hunt.next(&results) {
            results.push((level, Some(falls(level))));
        }
        results
    }

    #[test]
    fn steps_grow_until_the_collapse_and_the_gap_is_narrowed_below_its_resolution() {
        let results = levels(&hunt(), |level| level > 0.62);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} and {b}");
        for ((level, _), expected) in results.iter().zip([0.1, 0.2, 0.35, 0.55, 0.8]) {
            // Measured: 6e-17.
            near(*level, expected);
        }
        near(results[5].0, 0.55 + 0.25 / 3.0);
        let fall = results
            .iter()
            .filter(|(_, fell)| *fell == Some(true))
            .map(|(l, _)| *l)
            .fold(f64::INFINITY, f64::min);
        let stood = results
            .iter()
            .filter(|(_, fell)| *fell == Some(false))
            .map(|(l, _)| *l)
            .fold(0.0, f64::max);
        assert!(stood <= 0.62 && fall > 0.62 && fall - stood <= 0.1 * stood, "{stood} {fall}");
        assert_eq!(results.len(), 14, "what is left fills the gaps below");
        let mut sorted: Vec<f64> = results.iter().map(|(level, _)| *level).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        assert_eq!(sorted.len(), 14, "no level is run twice");
    }

    #[test]
    fn an_island_of_collapse_below_is_found_and_the_hunt_goes_on_below_it() {
        let results = levels(&hunt(), |level| level > 0.62 || (0.4..0.5).contains(&level));
        assert!(
            results.iter().any(|(level, fell)| *fell == Some(true) && *level < 0.5),
            "{results:?}"
        );
    }

    #[test]
    fn a_stack_that_never_falls_or_has_no_verdict_ends_its_hunt() {
        assert_eq!(levels(&hunt(), |_| false).len(), 14);
        assert_eq!(hunt().next(&[(0.1, None)]), None);
    }

    #[test]
    fn a_stack_that_falls_at_once_is_hunted_downward() {
        let results = levels(&hunt(), |_| true);
        assert!(results.len() < 14 && results.last().unwrap().0 < 0.015, "{results:?}");
    }
}
