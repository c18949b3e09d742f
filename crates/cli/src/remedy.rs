//! Advice after an error: the error message of a library states what is wrong, and this module adds what the user can
//! do about it, such as an option to set.

use anyhow::Error;
use barrelstack::RunFailure;
use barrelstack::compare::CompareError;
use barrelstack::export::ExportError;
use barrelstack::ground::GroundError;
use barrelstack_campaign::study::StudyError;
use barrelstack_motion::{MotionError, ReadError, Refusal};

/// Returns the advice to print after an error; `None` if there is no advice for this error.
pub(crate) fn remedy(error: &Error) -> Option<&'static str> {
    error.chain().find_map(|cause| {
        if let Some(ExportError::Occupied { .. }) = cause.downcast_ref() {
            return Some(
                "give another folder, or add --overwrite to replace the files of an earlier run",
            );
        }
        if let Some(ExportError::Foreign { .. }) = cause.downcast_ref() {
            return Some("move the file away, or give another folder with --out");
        }
        if let Some(ExportError::Write { .. }) = cause.downcast_ref() {
            return Some("give another folder with --out");
        }
        if let Some(CompareError::TooFew(_)) = cause.downcast_ref() {
            return Some("give another scenario, or add --against PATH=VALUE");
        }
        if let Some(RunFailure::Ground(ground)) = cause.downcast_ref() {
            return of_ground(ground);
        }
        if let Some(StudyError::Motion { error, .. }) = cause.downcast_ref()
            && let GroundError::Read(read) = &**error
            && let Refusal::Missing(_) = read.refusal
        {
            return Some(
                "`barrelstack motion convert` with --unit, --time-step or --sensitivity writes a copy of the file that states the missing information",
            );
        }
        if let Some(read) = cause.downcast_ref() {
            return of_reading(read);
        }
        cause.downcast_ref().and_then(of_ground)
    })
}

fn of_reading(error: &ReadError) -> Option<&'static str> {
    (error.refusal == Refusal::Unrecognized)
        .then_some("`barrelstack motion --help` lists all formats")
}

fn of_ground(error: &GroundError) -> Option<&'static str> {
    match error {
        GroundError::Unreadable { .. } => Some("give your file with --record FILE"),
        GroundError::Motion(MotionError::NoChannel { .. }) => Some(
            "select a horizontal component with --set motion.component=NAME; a vertical component alone does not shake the stack sideways",
        ),
        GroundError::Read(read) => of_reading(read),
        GroundError::Motion(_)
        | GroundError::Vertical { .. }
        | GroundError::UnknownBundled { .. }
        | GroundError::Unit { .. } => None,
    }
}
