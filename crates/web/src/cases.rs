//! What became of a variant, as it goes from one engine to another: what a verdict reads, to the last bit.

use barrelstack::ensemble::CaseResult;
use barrelstack::outcome::{CollapseMode, Outcome};
use serde::{Deserialize, Serialize};

/// What became of a variant, as far as a verdict on all of them needs it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// What happened.
    outcome: Ended,
    /// When (s) the first barrel had fallen.
    first_fall: Option<f64>,
    /// How many barrels there are.
    barrels: usize,
    /// When (s) each barrel had fallen, by name.
    falls: Vec<(String, Option<f64>)>,
    /// Largest displacement of the top against the ground, over the height of the stack.
    drift: Option<f64>,
    /// Largest load on a stave over its capacity, where one is stated.
    stave_utilization: Option<f64>,
    /// First sentence of what its reader should know.
    warning: Option<String>,
    /// Time (s) of the motion that was left at the end.
    cut: Option<f64>,
    /// When (s) it ended.
    end_time: Option<f64>,
}

/// An outcome, or why there is none.
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
    /// Of a result.
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

    /// The result again, with nothing in it that a verdict does not read; its trail goes by itself.
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
