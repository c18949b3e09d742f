//! Errors of a run, with the fields of the scenario that they concern.

use barrelstack_dynamics::Lack;

use crate::assemble::AssembleError;
use crate::ground::GroundError;
use crate::rest::Restless;

/// Maximum memory (bytes) of the results of a run.
pub(super) const MOST_KEPT: f64 = 2e9;

/// Reason why a scenario cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum RunFailure {
    /// The ground motion cannot be read or generated.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// The stack cannot be built.
    #[error(transparent)]
    Assemble(#[from] AssembleError),
    /// The stack does not stand by itself.
    #[error(transparent)]
    Settle(#[from] Restless),
    /// The time step is too long for the contacts.
    #[error("run.step = {given} ms is too long: {reason}; try {instead} ms, or leave run.step out")]
    Step {
        /// The step requested (ms).
        given: f64,
        /// Reason why the step is too long.
        reason: String,
        /// The default step (ms).
        instead: f64,
    },
    /// The duration of the run is undefined or too long.
    #[error("{0}")]
    Duration(String),
    /// The results would take more memory than allowed.
    #[error(
        "{samples:.2e} samples of {channels} histories and {frames:.2e} frames of {bodies} bodies take {gigabytes:.1} \
         GB, but a run may store at most {} GB: lower record.history_rate or record.frame_rate, or shorten \
         run.duration",
        MOST_KEPT / 1e9
    )]
    Memory {
        /// Number of samples in each history.
        samples: f64,
        /// Number of histories.
        channels: usize,
        /// Number of frames.
        frames: f64,
        /// Number of bodies.
        bodies: usize,
        /// Memory (GB) for all samples and frames.
        gigabytes: f64,
    },
}

impl RunFailure {
    /// Returns the fields of the scenario that the error concerns. The field that most likely has to be changed comes
    /// first.
    pub fn fields(&self) -> Vec<String> {
        let of = |fields: &[&str]| fields.iter().map(|field| (*field).to_owned()).collect();
        match self {
            Self::Step { .. } => of(&["run.step"]),
            Self::Duration(_) => of(&["run.duration", "run.step"]),
            Self::Memory { .. } => {
                of(&["record.history_rate", "record.frame_rate", "run.duration"])
            }
            Self::Ground(GroundError::Vertical { .. }) => of(&["motion.vertical"]),
            Self::Ground(GroundError::Unit { .. }) => of(&["motion.unit"]),
            Self::Ground(GroundError::Motion(_)) => of(&["motion.component", "motion.scale"]),
            Self::Ground(
                GroundError::Unreadable { .. }
                | GroundError::Read(_)
                | GroundError::UnknownBundled { .. },
            ) => of(&["motion.record", "motion.bundled"]),
            Self::Assemble(AssembleError::Overlap { first, second, .. }) => vec![
                format!("body.{second}.position"),
                format!("body.{first}.position"),
                "stack.override".into(),
            ],
            Self::Assemble(AssembleError::Shape { body, .. }) => vec![format!("body.{body}.shape")],
            Self::Assemble(AssembleError::Space) => of(&["stack.view"]),
            Self::Assemble(AssembleError::FreeInSpace) => of(&["kind"]),
            Self::Assemble(AssembleError::NotInSpace { field, .. }) => of(&[field]),
            Self::Assemble(AssembleError::Stack(_)) => of(&["stack.override", "stack"]),
            Self::Assemble(AssembleError::Model(_)) => Vec::new(),
            Self::Settle(Restless { error }) => {
                let body = format!("body.{}.position", error.body);
                match &error.lack {
                    Lack::Stiffness { interface, .. } => {
                        vec![format!("interface.{interface}.stiffness"), body]
                    }
                    Lack::Friction { interface, .. } | Lack::Stick { interface, .. } => {
                        vec![format!("interface.{interface}.friction"), body]
                    }
                    Lack::Support | Lack::Balance { .. } | Lack::Place | Lack::Time { .. } => {
                        vec![body, "stack.override".into()]
                    }
                }
            }
        }
    }
}
