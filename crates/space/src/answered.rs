//! The results of a scenario, whether it is simulated in vertical planes or in three dimensions.

use std::ops::ControlFlow;

use barrelstack::compare::{Comparable, Side};
use barrelstack::ensemble::CaseResult;
use barrelstack::export::{self, ExportError};
use barrelstack::ground::GroundError;
use barrelstack::outcome::Outcome;
use barrelstack::render::{RenderFolder, Rendered, Rendering};
use barrelstack::report::{answer_document, sentences};
use barrelstack::scenario::View;
use barrelstack::summary::AnySummary;
use barrelstack::variants::{self, Advance, Observer, Remedy, RunChoice};
use barrelstack::verify::{Verification, verify};
use barrelstack::watch::Ending;
use barrelstack::{Progress, RunFailure, Scenario};
use barrelstack_report::{Document, Language};

use crate::report::document;
use crate::variants::Answer;
use crate::words;

/// Results of a scenario, simulated either in vertical planes or in three dimensions.
#[derive(Clone, Debug)]
pub enum AnyAnswer {
    /// Results in one or both vertical planes.
    Planes(Box<variants::Answer>),
    /// Results in three dimensions.
    Space(Box<Answer>),
}

/// Evaluates the same expression for both variants of [`AnyAnswer`].
macro_rules! either {
    ($of:expr, $one:pat => $value:expr) => {
        match $of {
            AnyAnswer::Planes($one) => $value,
            AnyAnswer::Space($one) => $value,
        }
    };
}

impl AnyAnswer {
    /// Runs the variants of a scenario, and then the case that `choice` selects, which the results show in detail. The
    /// observer receives the progress and may cancel the work.
    ///
    /// # Errors
    /// When the motion cannot be read, or when the stack cannot be built or does not stand.
    pub fn of(
        scenario: &Scenario,
        choice: RunChoice,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure> {
        Ok(if scenario.is_spatial() {
            Self::Space(Box::new(crate::variants::answer(scenario, choice, observer)?))
        } else {
            Self::Planes(Box::new(variants::answer(scenario, choice, observer)?))
        })
    }

    /// Searches for the smallest changes that would have kept the stack standing. Returns `None` if no search is made,
    /// for example because the stack stands.
    ///
    /// # Errors
    /// When a motion cannot be read.
    pub fn remedy(&self, observer: Observer<'_>) -> Result<Option<Remedy>, GroundError> {
        match self {
            Self::Planes(answer) => variants::remedy(answer, observer),
            Self::Space(answer) => crate::variants::remedy(answer, observer),
        }
    }

    /// Stores the changes that would have kept the stack standing, as [`AnyAnswer::remedy`] returns them.
    pub fn set_remedy(&mut self, found: Option<Remedy>) {
        match self {
            Self::Planes(answer) => answer.decides.summary.remedy = found,
            Self::Space(answer) => answer.summary.remedy = found,
        }
    }

    /// Sets the wall-clock time (s) of the computation.
    pub fn set_wall_seconds(&mut self, seconds: f64) {
        match self {
            Self::Planes(answer) => answer.decides.summary.run.wall_seconds = Some(seconds),
            Self::Space(answer) => answer.summary.run.wall_seconds = Some(seconds),
        }
    }

    /// Runs the shown case again with small changes of step and position, and stores the comparison in the summary.
    ///
    /// # Errors
    /// When a repeat cannot be built or does not stand.
    pub fn verify(
        &mut self,
        progress: &mut (dyn FnMut(Progress) -> ControlFlow<()> + Send),
    ) -> Result<(), RunFailure> {
        match self {
            Self::Planes(answer) => {
                answer.decides.summary.verification = Some(verify(&answer.decides.run, progress)?);
            }
            Self::Space(answer) => {
                answer.summary.verification = Some(verify(&answer.run, progress)?);
            }
        }
        Ok(())
    }

    /// Returns the comparison of the run that is shown in detail with its repeats; `None` before
    /// [`AnyAnswer::verify`] is called.
    pub fn verification(&self) -> Option<&Verification> {
        match self {
            Self::Planes(answer) => answer.decides.summary.verification.as_ref(),
            Self::Space(answer) => answer.summary.verification.as_ref(),
        }
    }

    /// Returns the summary of the run that is shown in detail, with the statistics of all variants.
    pub fn summary(&self) -> AnySummary {
        match self {
            Self::Planes(answer) => AnySummary::Planar(Box::new(answer.decides.summary.clone())),
            Self::Space(answer) => AnySummary::Spatial(Box::new(answer.summary.clone())),
        }
    }

    /// Returns the result in one sentence.
    pub fn headline(&self) -> String {
        match self {
            Self::Planes(answer) => answer.headline(),
            Self::Space(answer) => words::headline(&answer.run, &answer.summary),
        }
    }

    /// Returns the title of the scenario.
    pub fn title(&self) -> &str {
        match self {
            Self::Planes(answer) => &answer.decides.summary.title,
            Self::Space(answer) => &answer.summary.title,
        }
    }

    /// Returns the result in a few sentences, with the main numbers on which it is based.
    pub fn sentences(&self) -> Vec<String> {
        match self {
            Self::Planes(answer) => sentences(&answer.decides.run, &answer.decides.summary),
            Self::Space(answer) => {
                let Answer { run, summary, .. } = &**answer;
                let advice = summary.remedy.as_ref().map(Remedy::sentence);
                std::iter::once(words::headline(run, summary))
                    .chain(advice)
                    .chain(words::sentences(run, summary))
                    .collect()
            }
        }
    }

    /// Returns the time (s) at which the run that is shown in detail ended.
    pub fn end_time(&self) -> f64 {
        match self {
            Self::Planes(answer) => answer.decides.run.end_time,
            Self::Space(answer) => answer.run.end_time,
        }
    }

    /// Returns all warnings, without duplicates.
    pub fn warnings(&self) -> Vec<&str> {
        let (own, other) = match self {
            Self::Planes(answer) => {
                let other = answer.other.as_ref().map(|other| &other.summary.warnings);
                (&answer.decides.summary.warnings, other)
            }
            Self::Space(answer) => (&answer.summary.warnings, None),
        };
        let other = other.into_iter().flatten().filter(|text| !own.contains(text));
        own.iter().chain(other).map(String::as_str).collect()
    }

    /// Returns `true` if any part of the computation was interrupted.
    pub fn is_stopped(&self) -> bool {
        match self {
            Self::Planes(answer) => answer.is_stopped(),
            Self::Space(answer) => {
                let Answer { run, summary, .. } = &**answer;
                run.ending == Ending::Interrupted || summary.unfinished.is_some()
            }
        }
    }

    /// Returns `true` if the computation failed in any of the runs that are shown in detail.
    pub fn is_invalid(&self) -> bool {
        let invalid = |outcome: &Outcome| matches!(outcome, Outcome::Invalid { .. });
        match self {
            Self::Planes(answer) => {
                let mut runs = std::iter::once(&answer.decides).chain(&answer.other);
                runs.any(|shown| invalid(&shown.run.outcome))
            }
            Self::Space(answer) => invalid(&answer.run.outcome),
        }
    }

    /// Builds the report.
    pub fn document(&self) -> Document {
        match self {
            Self::Planes(answer) => answer_document(answer),
            Self::Space(answer) => document(answer),
        }
    }

    /// Returns the names and contents of the output files. The report is written in the given language.
    ///
    /// # Errors
    /// When an archive cannot be written.
    pub fn files(&self, language: Language) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
        match self {
            Self::Planes(answer) => export::files(answer, language),
            Self::Space(answer) => {
                let stated = answer.scenario.to_resolved_toml();
                Ok(crate::export::files(answer, &stated, language))
            }
        }
    }

    /// Renders the run that is shown in detail into a folder. Returns one [`Rendered`] for each part of the rendering.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn render(
        &self,
        folder: &RenderFolder,
        how: &Rendering,
    ) -> Result<Vec<Rendered>, ExportError> {
        match self {
            Self::Planes(answer) => folder.write(&answer.decides.run, &answer.decides.summary, how),
            Self::Space(answer) => crate::export::render(answer, folder, how),
        }
    }
}

impl Comparable for AnyAnswer {
    fn scenario(&self) -> &Scenario {
        either!(self, answer => Comparable::scenario(&**answer))
    }

    fn variant(&self) -> u32 {
        either!(self, answer => answer.variant())
    }

    fn results(&self) -> Vec<Option<Vec<CaseResult>>> {
        either!(self, answer => answer.results())
    }

    fn with_variant(
        &self,
        number: u32,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure> {
        Ok(match self {
            Self::Planes(answer) => Self::Planes(Box::new(answer.with_variant(number, observer)?)),
            Self::Space(answer) => Self::Space(Box::new(answer.with_variant(number, observer)?)),
        })
    }

    fn worst(&self) -> (f64, Option<View>) {
        either!(self, answer => answer.worst())
    }

    fn side(self, name: String, plane: Option<View>) -> Side {
        either!(self, answer => answer.side(name, plane))
    }
}
