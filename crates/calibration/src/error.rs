//! Errors of calibration.

use barrelstack::run::RunFailure;
use barrelstack_input::measured::TableError;

/// Reason why a calibration gives no parameters.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// The table is invalid, or does not determine the parameters.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The scenario is not suitable for the calibration; the string states the reason.
    #[error("{0}")]
    Scenario(String),
    /// The first simulation of the fit fails.
    #[error(transparent)]
    Run(#[from] RunFailure),
    /// The calibration was canceled; the simulations completed so far give no estimate.
    #[error("the simulations were stopped")]
    Stopped,
}
