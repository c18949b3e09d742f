//! Comparison of two or more runs: their differing inputs and their results.

mod labels;
mod page;
mod paired;
mod tables;

use std::ops::ControlFlow;

use barrelstack_report::described;

use crate::ensemble::CaseResult;
use crate::outcome::Outcome;
use crate::run::{Run, RunFailure};
use crate::scenario::{Scenario, View};
use crate::summary::Summary;
use crate::variants::{Advance, Answer, Shown, Spread, common_number};

pub use labels::labels;
pub use page::document;
pub use paired::Paired;

/// One run of a comparison.
#[derive(Clone, Debug)]
pub struct Side {
    /// Name of the run, short enough for a column heading.
    pub name: String,
    /// The run.
    pub run: Run,
    /// Summary of the run.
    pub summary: Summary,
    /// Results in the plane that is not shown, if the scenario has both planes.
    pub other: Option<OtherPlane>,
    /// For each plane, the shown plane first: `true` for each variant that collapses, in the order
    /// of the variant numbers; `None` for a variant without a verdict.
    pub collapsed: Vec<(Option<View>, Vec<Option<bool>>)>,
}

/// Results of a stack in the plane that is not shown.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherPlane {
    /// Plane in which these results were computed.
    pub view: View,
    /// Outcome of the run in this plane, for the same variant number as the shown run.
    pub outcome: Outcome,
    /// Statistics of the variants; `None` if no variants were run.
    pub spread: Option<Spread>,
}

/// Makes all answers show the same variant under the same component of the motion.
///
/// The variant is the medoid over all answers. For every answer that shows another variant, the
/// medoid is run; the observer receives the progress and may cancel. Answers are returned unchanged
/// if any of them has no variants.
///
/// # Errors
/// When the common variant cannot be run.
pub fn aligned(
    answers: Vec<(String, Answer)>,
    observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
) -> Result<Vec<(String, Answer)>, RunFailure> {
    let all: Vec<&Answer> = answers.iter().map(|(_, answer)| answer).collect();
    let Some(number) = common_number(&all)? else { return Ok(answers) };
    let align = |(name, answer): (String, Answer)| {
        if answer.decides.summary.variant == number {
            return Ok((name, answer));
        }
        Ok((name, answer.with_variant(number, observer)?))
    };
    answers.into_iter().map(align).collect()
}

/// Returns the runs of the answers with their names.
///
/// If all answers have both planes, every run is shown in the governing plane of the worst answer.
pub fn sides(answers: Vec<(String, Answer)>) -> Vec<Side> {
    let share = |answer: &Answer| match &answer.decides.summary.ensemble {
        Some(spread) => spread.share.unwrap_or(0.0),
        None => f64::from(u8::from(answer.decides.run.outcome.is_collapse())),
    };
    let worst = answers
        .iter()
        .map(|(_, answer)| answer)
        .reduce(|worst, answer| if share(answer) > share(worst) { answer } else { worst });
    let plane = worst.and_then(|answer| answer.decides.run.assembly.view);
    let side = |(name, answer): (String, Answer)| {
        let Answer { decides, other, .. } = answer;
        let collapsed = |shown: &Shown| {
            let results = shown.variants.as_ref()?.results.get(1..)?;
            Some((shown.run.assembly.view, results.iter().map(CaseResult::collapsed).collect()))
        };
        let (shown, other) = match other {
            Some(other) if other.run.assembly.view == plane => (other, Some(decides)),
            other => (decides, other),
        };
        let collapsed = std::iter::once(&shown).chain(&other).filter_map(collapsed).collect();
        let summary = Summary { other_plane: None, ..shown.summary };
        let other = other.and_then(|Shown { run, summary, .. }| {
            let (outcome, spread) = (run.outcome, summary.ensemble);
            Some(OtherPlane { view: run.assembly.view?, outcome, spread })
        });
        Side { name, run: shown.run, summary, other, collapsed }
    };
    answers.into_iter().map(side).collect()
}

/// Error of a comparison.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CompareError {
    /// Fewer than two runs.
    #[error("a comparison needs at least two runs, found {0}")]
    TooFew(usize),
    /// More runs than a page can show.
    #[error("a comparison shows at most {most} runs side by side, found {found}: leave some out")]
    TooMany {
        /// Number of requested runs.
        found: usize,
        /// Maximum number of runs.
        most: usize,
    },
    /// Two runs have equal inputs.
    #[error("{first} and {second} are the same run: all their inputs are equal")]
    Identical {
        /// The first of the two.
        first: String,
        /// The second of the two.
        second: String,
    },
}

/// Maximum number of runs in a comparison; a seventh run would repeat a color.
pub const MOST: usize = 6;

/// Checks a comparison before any work is done.
///
/// # Errors
/// When there are too few or too many runs, or two runs have equal inputs.
pub fn check(scenarios: &[(String, Scenario)]) -> Result<(), CompareError> {
    match scenarios.len() {
        found @ 0..=1 => return Err(CompareError::TooFew(found)),
        found if found > MOST => return Err(CompareError::TooMany { found, most: MOST }),
        _ => {}
    }
    for (at, (second, scenario)) in scenarios.iter().enumerate() {
        let print = scenario.fingerprint();
        if let Some((first, _)) = scenarios[..at].iter().find(|(_, s)| s.fingerprint() == print) {
            return Err(CompareError::Identical { first: first.clone(), second: second.clone() });
        }
    }
    Ok(())
}

described! {
    /// Two or more runs side by side.
    #[derive(Clone, Debug)]
    pub struct Comparison of sides: &[Side], unfinished: Vec<String> {
        /// Name and version of this layout.
        pub schema: &'static str ["comparison/1"] = "comparison/1",
        /// The runs, in order.
        pub runs: Vec<Compared> = sides.iter().map(Compared::of).collect(),
        /// Paired comparison of the first run with every other run: the shown plane first, then the
        /// other plane.
        pub paired: Vec<Paired> = pairs(sides),
        /// Names of the runs that were stopped early or never started; they are not compared.
        pub unfinished: Vec<String> = unfinished,
        /// The inputs that differ between the runs.
        pub differences: Vec<Difference> = differences(sides.iter().map(|side| &*side.run.stated)),
    }

    /// One run of a comparison.
    #[derive(Clone, Debug)]
    pub struct Compared of side: &Side {
        /// Name of the run.
        pub name: String = side.name.clone(),
        /// Summary of the run.
        pub summary: Summary = side.summary.clone(),
        /// Statistics of the variants in the plane that is not shown; null if the scenario has one
        /// plane.
        pub ensemble_of_other_plane: Option<Spread> =
            side.other.as_ref().and_then(|other| other.spread.clone()),
        /// Outcome in the plane that is not shown; null if the scenario has one plane.
        pub outcome_of_other_plane: Option<&'static str>
            ["stable", "collapse", "not-judged", "interrupted", "invalid"] =
            side.other.as_ref().map(|other| other.outcome.kind()),
    }

    /// An input that is not equal in all runs.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct Difference {
        /// Path of the input, as in an override.
        pub path: String,
        /// Meaning of the input.
        pub help: &'static str,
        /// Value of the input in each run; null for a run that has no such input.
        pub values: Vec<Option<String>>,
    }
}

/// Returns the inputs that differ between scenarios, in the order of the scenario file.
pub fn differences<'a>(scenarios: impl IntoIterator<Item = &'a Scenario>) -> Vec<Difference> {
    let all: Vec<_> = scenarios.into_iter().map(Scenario::settings).collect();
    let mut list: Vec<Difference> = Vec::new();
    for setting in all.iter().flatten() {
        if list.iter().any(|known| known.path == setting.path) {
            continue;
        }
        let value = |settings: &Vec<crate::scenario::Setting>| {
            settings.iter().find(|s| s.path == setting.path).map(|s| s.value.clone())
        };
        list.push(Difference {
            path: setting.path.clone(),
            help: setting.help,
            values: all.iter().map(value).collect(),
        });
    }
    list.retain(|one| one.values.iter().any(|value| *value != one.values[0]));
    list
}

/// Compares the first run with every other run, in every plane that both have.
fn pairs(sides: &[Side]) -> Vec<Paired> {
    let Some((first, others)) = sides.split_first() else { return Vec::new() };
    others.iter().flat_map(|other| Paired::of(first, other)).collect()
}

/// Returns the letter of a run by its position: A for the first.
fn letter(at: usize) -> char {
    char::from(b'A' + u8::try_from(at).unwrap_or(0))
}
