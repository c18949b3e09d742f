//! The cases of the paper as built-in scenarios.

use std::path::Path;

use barrelstack::scenario::{Scale, Scenario};
use barrelstack_motion::STANDARD_GRAVITY;

use super::ReproduceError;

/// Peak acceleration (g) of the component PEL360 of RSN995 as published by PEER.
const PEL360_PGA: f64 = 0.358_34;

/// Difference (g) from [`PEL360_PGA`] below which the peak acceleration of a record identifies the paper's record. The
/// peaks that two agencies publish for this record differ in the sixth digit.
const PGA_TOLERANCE: f64 = 1e-4;

/// The ground motion of the six barrels.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// The paper's record, read from a file.
    Paper {
        /// Name of the file.
        file: String,
    },
    /// A record other than the paper's: its peak acceleration differs from that of the paper's record.
    Other {
        /// Name of the file.
        file: String,
        /// Peak acceleration of the record before scaling (m/s²).
        pga: f64,
    },
    /// The bundled record of the South Napa earthquake, used if no file is given.
    Bundled,
}

impl Motion {
    /// Returns `true` if results under this motion can be compared with the paper's results.
    pub fn is_papers(&self) -> bool {
        matches!(self, Self::Paper { .. })
    }

    /// Returns a short name of the motion.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Paper { .. } => "the Hollywood Storage record (N-S) scaled to 60 cm/s".into(),
            Self::Other { file, .. } => format!("the record {file} scaled to 60 cm/s"),
            Self::Bundled => "the South Napa record scaled to 60 cm/s".into(),
        }
    }

    /// Returns the name of the motion for captions, with a remark if it is not the paper's record.
    pub(super) fn words(&self) -> String {
        let name = self.name();
        if self.is_papers() { name } else { format!("{name}, which replaces the paper's record") }
    }
}

/// The five cases of the paper.
#[derive(Clone, Debug)]
pub(super) struct PaperCases {
    /// Six barrels, rack–ground friction 0.4.
    pub(super) six: Scenario,
    /// Six barrels, rack–ground friction 0.1.
    pub(super) slippery: Scenario,
    /// Eight barrels at full scale.
    pub(super) eight: Scenario,
    /// Eight barrels at half scale, the scale of the shaking-table test.
    pub(super) half: Scenario,
    /// A stack of four levels in the longitudinal plane, along the barrel axes.
    pub(super) along: Scenario,
    /// The ground motion of the six barrels.
    pub(super) motion: Motion,
}

impl PaperCases {
    /// Creates the cases. `record` is the file of the ground motion of the six barrels; if `None`, they are shaken by
    /// the bundled record.
    pub(super) fn new(record: Option<&Path>) -> Result<Self, ReproduceError> {
        let change = match record {
            Some(path) => record_of(path),
            None => r#"motion={bundled = "napa-college-2014", component = "horizontal-1", scale = {pgv = "60 cm/s"}}"#
                .to_owned(),
        };
        let six = Scenario::builtin("candia-6-barrels", std::slice::from_ref(&change))?;
        let slippery = Scenario::builtin("candia-6-barrels-low-friction", &[change])?;
        let motion = match record {
            Some(path) => recognize(path)?,
            None => Motion::Bundled,
        };
        Ok(Self {
            six,
            slippery,
            eight: Scenario::builtin("candia-8-barrels", &[])?,
            half: Scenario::builtin("candia-8-barrels-half-scale", &[])?,
            along: Scenario::builtin("candia-8-barrels-longitudinal", &[])?,
            motion,
        })
    }
}

/// Returns the assignment to `motion.record` that sets the record of a scenario.
fn record_of(path: &Path) -> String {
    // A JSON string is a valid TOML string, too.
    format!("motion.record={}", serde_json::Value::from(path.display().to_string()))
}

/// Reads a record, and recognizes the paper's record by its peak acceleration before scaling.
///
/// # Errors
/// If the file cannot be read.
pub fn recognize(path: &Path) -> Result<Motion, ReproduceError> {
    let mut unscaled = Scenario::builtin("candia-6-barrels", &[record_of(path)])?;
    unscaled.motion.scale = Scale::Factor(1.0);
    let pga = unscaled.ground()?.motion.map_or(0.0, |motion| motion.pga());
    let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Ok(if (pga / STANDARD_GRAVITY - PEL360_PGA).abs() < PGA_TOLERANCE {
        Motion::Paper { file }
    } else {
        Motion::Other { file, pga }
    })
}
