//! Hindcasts: observations of barrel stacks in real earthquakes compared with the model, and what the comparison
//! implies for the unknowns.
//!
//! ```text
//! observations.toml ─┐
//! cases/*.csv ───────┴─▶ fitted probability of a fall ─▶ likelihoods, posterior ─▶ field.md, tables, figure
//! ```
//!
//! [`evaluate`] depends only on the observations and the simulated cases, so that a test can check the page against
//! these inputs. `cargo xtask field` simulates the cases.

mod cases;
mod chance;
mod figure;
mod page;
mod results;
mod weigh;

pub use barrelstack_calibration::shares::{Earthquake, Kind, Likelihood, Statement, Statements};
pub use cases::{COLUMNS, FieldCase, FieldCases, UNKNOWNS};
pub use chance::{Chance, MEDIANS, Point};
pub use results::{Bin, Posterior, Results, Share};
pub use weigh::Range;

/// Reason why the hindcasts cannot be evaluated, such as an invalid file of observations or cases.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct FieldError(pub String);

/// Returns the files of the hindcasts by their paths in `validation`: the page, its tables and its figure.
///
/// `cases` are the names of the studies and their cases as CSV.
///
/// # Errors
/// If a file cannot be read, or the cases of a study are missing.
pub fn evaluate(
    observations: &str,
    cases: &[(String, String)],
) -> Result<Vec<(String, String)>, FieldError> {
    let observations = Statements::read("observations.toml", observations)
        .map_err(|error| FieldError(error.to_string()))?;
    let cases = cases
        .iter()
        .map(|(name, text)| FieldCases::read(name, text))
        .collect::<Result<Vec<FieldCases>, FieldError>>()?;
    let results = Results::of(&observations, &cases)?;
    Ok(vec![
        ("field.md".to_owned(), page::page(&observations, &cases, &results)),
        ("field.svg".to_owned(), figure::figure(&results).to_svg()),
        ("field/shares.csv".to_owned(), results.shares_csv()),
        ("field/posterior.csv".to_owned(), results.posterior_csv()),
        ("field/likelihood.csv".to_owned(), results.likelihood_csv()),
    ])
}
