//! Results of variants, in the form in which the parallel engines of a page exchange them: bit-exact, and reduced to
//! the data that a verdict needs.

use barrelstack::ensemble::CaseResult;
use barrelstack::outcome::{CollapseMode, Outcome};
use serde::{Deserialize, Serialize};

/// The result of a variant, reduced to the data that a verdict on all variants needs.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Outcome of the variant.
    outcome: Ended,
    /// Time (s) at which the first barrel counts as fallen; `None` if no barrel fell, or if the
    /// variant has no valid result.
    first_fall: Option<f64>,
    /// Number of barrels.
    barrels: usize,
    /// Name of each barrel, and the time (s) at which it counts as fallen; `None` for a barrel that
    /// did not fall.
    falls: Vec<(String, Option<f64>)>,
    /// Largest displacement of the top barrels relative to the ground until the first loss of a seat, divided by the
    /// height of the stack; `None` if the variant has no valid result or the scenario has no stack.
    drift: Option<f64>,
    /// Largest vertical force between a barrel and a rack until the first loss of a seat, divided by the capacity of
    /// the staves; `None` if the variant has no valid result or the scenario has no rack.
    stave_utilization: Option<f64>,
    /// The first warning about the result; `None` if there are no warnings.
    warning: Option<String>,
    /// Duration (s) of the ground motion that remained when the run ended; zero if the run ended at
    /// rest or covered the whole motion. `None` if the variant was stopped or could not run.
    cut: Option<f64>,
    /// Simulated time (s) that the run reached; `None` if the variant was stopped or could not run.
    end_time: Option<f64>,
}

/// An outcome, or the reason why the variant has no outcome.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
enum Ended {
    Stable,
    Collapse { mode: String, time: f64, first: String, from_level: u32, to_level: u32 },
    NotJudged,
    Interrupted,
    Invalid { reason: String },
    Refused { reason: String },
}

impl Case {
    /// Reduces a result to the data that a verdict needs.
    pub fn of(result: &CaseResult) -> Self {
        Self {
            outcome: match result.outcome.clone() {
                Ok(Outcome::Stable) => Ended::Stable,
                Ok(Outcome::Collapse { mode, time, first, from_level, to_level }) => {
                    let mode = mode.name().to_owned();
                    Ended::Collapse { mode, time, first, from_level, to_level }
                }
                Ok(Outcome::NotJudged) => Ended::NotJudged,
                Ok(Outcome::Interrupted) => Ended::Interrupted,
                Ok(Outcome::Invalid { reason }) => Ended::Invalid { reason },
                Err(reason) => Ended::Refused { reason },
            },
            first_fall: result.first_fall,
            barrels: result.barrels,
            falls: result.falls.clone(),
            drift: result.demands.top_drift_ratio,
            stave_utilization: result.demands.stave_utilization,
            warning: result.warnings.first().cloned(),
            cut: result.cut,
            end_time: result.end_time,
        }
    }

    /// Converts the case back to a result with the data that a verdict needs, without the paths of the barrels, which
    /// are transferred separately.
    pub(crate) fn result(self) -> Result<CaseResult, String> {
        let outcome = match self.outcome {
            Ended::Stable => Ok(Outcome::Stable),
            Ended::Collapse { mode, time, first, from_level, to_level } => {
                let mode = CollapseMode::named(&mode)
                    .ok_or_else(|| format!("there is no mode of collapse \"{mode}\""))?;
                Ok(Outcome::Collapse { mode, time, first, from_level, to_level })
            }
            Ended::NotJudged => Ok(Outcome::NotJudged),
            Ended::Interrupted => Ok(Outcome::Interrupted),
            Ended::Invalid { reason } => Ok(Outcome::Invalid { reason }),
            Ended::Refused { reason } => Err(reason),
        };
        let Self { first_fall, barrels, falls, cut, end_time, .. } = self;
        let known = CaseResult::failed(String::new());
        let mut result = CaseResult { outcome, first_fall, barrels, falls, cut, end_time, ..known };
        result.demands.top_drift_ratio = self.drift;
        result.demands.stave_utilization = self.stave_utilization;
        result.warnings = self.warning.into_iter().collect();
        Ok(result)
    }
}
