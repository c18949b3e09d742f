//! Why a test gives no parameters.

use barrelstack::run::RunFailure;
use barrelstack_input::measured::TableError;

/// Why a test gives no parameters.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// The table cannot be used, or no parameter can be had from it.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The scenario does not go with the fit.
    #[error("{0}")]
    Scenario(String),
    /// The simulation that the fit starts from fails.
    #[error(transparent)]
    Run(#[from] RunFailure),
    /// It was told to stop: what a part of the simulations says is no estimate.
    #[error("the simulations were stopped")]
    Stopped,
}
