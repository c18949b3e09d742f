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
    /// The calibration was canceled. The simulations completed by then are discarded.
    #[error("the simulations were stopped")]
    Stopped,
}
