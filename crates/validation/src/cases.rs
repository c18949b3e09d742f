//! Problems from files. Each file contains a scenario of individual bodies that do not form a stack (a *free scene*),
//! followed by a table `[expect]` with the requested quantity and the exact answer.
//!
//! ```toml
//! [expect]
//! source = "Housner 1963"
//! body = "block"
//! quantity = "overturning-border"    # see Quantity
//! vary = "motion.pulse.amplitude"    # the parameter whose boundary is searched
//! unit = "g"                         # its unit
//! between = [0.5, 0.6]               # stands at the first, not at the second
//! exact = 0.55
//! tolerance = 0.01                   # relative
//! ```

use std::fmt;

use barrelstack::{Run, Scenario};
use serde::Deserialize;

use crate::oracle::OVERTURNED;
use crate::problem::border;
use crate::swing::crossing;
use crate::{Effort, Failure, Outcome, Problem, Tolerance};

/// A quantity that a case may request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Time (s) at which the body is upright for the first time.
    FirstUpright,
    /// Displacement (m) along `x` of the body relative to the ground at the end.
    #[serde(rename = "way")]
    Displacement,
    /// Value of the varied parameter above which the body overturns.
    OverturningBorder,
    /// Value of the varied parameter above which a corner of the body lifts off.
    UpliftBorder,
}

impl Quantity {
    fn words(self) -> &'static str {
        match self {
            Self::FirstUpright => "time until the body is upright",
            Self::Displacement => "displacement relative to the ground",
            Self::OverturningBorder => "smallest value that overturns the body",
            Self::UpliftBorder => "smallest value that lifts a corner",
        }
    }

    /// Returns the rotation (rad) above which the body counts as overturned or lifted; `None` for quantities that are
    /// not boundaries.
    fn beyond(self) -> Option<f64> {
        match self {
            Self::FirstUpright | Self::Displacement => None,
            Self::OverturningBorder => Some(OVERTURNED),
            Self::UpliftBorder => Some(2e-4),
        }
    }
}

/// The table `[expect]` of a case.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Expect {
    source: String,
    body: String,
    quantity: Quantity,
    vary: Option<String>,
    unit: Option<String>,
    between: Option<[f64; 2]>,
    exact: f64,
    tolerance: f64,
}

/// Error in a case file.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct CaseError {
    file: String,
    problem: String,
}

/// Returns the cases bundled with the crate.
pub(crate) fn shipped() -> Vec<Problem> {
    let files = [
        ("housner-period", include_str!("../cases/housner-period.toml")),
        ("housner-uplift", include_str!("../cases/housner-uplift.toml")),
        ("half-sine-4", include_str!("../cases/half-sine-4.toml")),
        ("one-sine-4-starts", include_str!("../cases/one-sine-4-starts.toml")),
        ("one-sine-4-without-impact", include_str!("../cases/one-sine-4-without-impact.toml")),
        ("housner-period-short", include_str!("../cases/housner-period-short.toml")),
        ("half-sine-2.5", include_str!("../cases/half-sine-2.5.toml")),
        ("one-cosine-2.5-starts", include_str!("../cases/one-cosine-2.5-starts.toml")),
        (
            "one-cosine-2.5-without-impact",
            include_str!("../cases/one-cosine-2.5-without-impact.toml"),
        ),
        ("rectangular-0.75", include_str!("../cases/rectangular-0.75.toml")),
        ("sliding-rectangular", include_str!("../cases/sliding-rectangular.toml")),
        ("sliding-half-sine", include_str!("../cases/sliding-half-sine.toml")),
    ];
    // A case that cannot be read becomes a problem that fails, so that no case is skipped.
    files
        .into_iter()
        .map(|(name, text)| read(name, text).unwrap_or_else(|error| broken(name, &error)))
        .collect()
}

fn broken(name: &str, error: &CaseError) -> Problem {
    let message = error.to_string();
    Problem {
        id: format!("cases/{name}"),
        title: "a case that cannot be read".into(),
        source: String::new(),
        quantity: "",
        unit: "",
        exact: f64::NAN,
        tolerance: Tolerance::Relative(0.0),
        fast: None,
        run: Box::new(move |_| Err(Failure::Absent(message.clone()))),
    }
}

/// Parses a case.
///
/// # Errors
/// If the scenario or the table `[expect]` is invalid.
pub fn read(name: &str, text: &str) -> Result<Problem, CaseError> {
    let file = format!("{name}.toml");
    let refuse =
        |problem: &dyn fmt::Display| CaseError { file: file.clone(), problem: problem.to_string() };
    let Some((scene, answer)) = text.split_once("\n[expect]\n") else {
        return Err(refuse(&"expected a line `[expect]` after the scenario, found none"));
    };
    let expect: Expect = toml::from_str(answer).map_err(|e| refuse(&e.message()))?;
    let scenario = Scenario::parse(&file, scene, &[]).map_err(|e| refuse(&e.sentence()))?;
    let unit = match (expect.quantity, expect.unit.as_deref()) {
        (Quantity::FirstUpright, None) => "s",
        (Quantity::Displacement, None) => "m",
        (Quantity::OverturningBorder | Quantity::UpliftBorder, Some("g")) => "g",
        (Quantity::OverturningBorder | Quantity::UpliftBorder, Some("m/s")) => "m/s",
        (quantity, unit) => {
            return Err(refuse(&format!(
                "expect.unit: for a limit of overturning or uplift, the unit must be \"g\" or \"m/s\"; for a time or a \
                 displacement, no unit may be stated; found {unit:?} for {quantity:?}"
            )));
        }
    };
    if expect.quantity.beyond().is_some() && (expect.vary.is_none() || expect.between.is_none()) {
        return Err(refuse(&"expect: a limit of overturning or uplift needs `vary` and `between`"));
    }
    let scene = scene.to_owned();
    Ok(Problem {
        id: format!("cases/{name}"),
        title: scenario.title,
        source: expect.source.clone(),
        quantity: expect.quantity.words(),
        unit,
        exact: expect.exact,
        tolerance: Tolerance::Relative(expect.tolerance),
        fast: Some(Tolerance::Relative(expect.tolerance.max(1e-2))),
        run: Box::new(move |effort| answer_of(&file, &scene, &expect, effort).map(Outcome::of)),
    })
}

fn answer_of(file: &str, scene: &str, expect: &Expect, effort: Effort) -> Result<f64, Failure> {
    let run = |overrides: &[String]| -> Result<(Run, usize), Failure> {
        let scenario = Scenario::parse(file, scene, overrides)?;
        let run = scenario.run()?;
        let body = run
            .assembly
            .model
            .body_named(&expect.body)
            .ok_or_else(|| Failure::Absent(format!("there is no body {:?}", expect.body)))?;
        Ok((run, body))
    };
    match (expect.quantity.beyond(), &expect.vary, expect.between) {
        (Some(limit), Some(vary), Some([low, high])) => {
            let halvings = if effort == Effort::Full { 9 } else { 2 };
            border((low, high), halvings, |value| {
                let unit = expect.unit.as_deref().unwrap_or_default();
                let (run, body) = run(&[format!("{vary}=\"{value} {unit}\"")])?;
                let start = run.recording.frames.poses[0][body][2];
                let turned = |pose: &Vec<[f64; 3]>| (pose[body][2] - start).abs() > limit;
                Ok(run.recording.frames.poses.iter().any(turned))
            })
        }
        _ if expect.quantity == Quantity::Displacement => {
            let (run, body) = run(&[])?;
            let place = |pose: &[[f64; 3]]| pose[body][0] - pose[0][0];
            match (run.recording.frames.poses.first(), run.recording.frames.poses.last()) {
                (Some(first), Some(last)) => Ok((place(last) - place(first)).abs()),
                _ => Err(Failure::Absent("nothing was recorded".into())),
            }
        }
        _ => {
            let (run, body) = run(&[])?;
            let frames = &run.recording.frames;
            let leans = frames.poses.iter().map(|pose| pose[body][2]);
            let leans: Vec<(f64, f64)> = frames.times.iter().copied().zip(leans).collect();
            let passed = leans.windows(2).find(|pair| pair[0].1 * pair[1].1 <= 0.0);
            let never = || Failure::Absent("the body is never upright".into());
            passed.map(|pair| crossing(pair[0], pair[1])).ok_or_else(never)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn a_file_that_is_no_case_says_what_it_lacks() {
        let said = |text: &str| read("x", text).err().map(|e| e.to_string()).unwrap_or_default();
        assert_eq!(
            said("schema = 1"),
            "x.toml: expected a line `[expect]` after the scenario, found none"
        );
        assert!(said("schema = 1\n[expect]\nsource = 3\n").starts_with("x.toml: invalid type"));
    }
}
