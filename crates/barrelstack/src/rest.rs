//! A stack comes to rest, or is refused with what would help.

use barrelstack_dynamics::{Lack, Planar, Scratch, SettleError, Settled, State, settle};

use crate::assemble::Assembly;

/// Largest share of gravity that may be left unbalanced at rest.
const TOLERANCE: f64 = 1e-10;

/// A stack that does not stand by itself, and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{error}; {}", remedy(&error.lack))]
pub struct Restless {
    /// Which body goes, and why.
    pub error: SettleError,
}

/// Lets the stack come to rest.
///
/// # Errors
/// When it does not stand: names the body that goes first, what it lacks, and what would help.
pub(crate) fn at_rest(
    assembly: &Assembly,
    state: &mut State<Planar>,
    scratch: &mut Scratch<Planar>,
) -> Result<Settled, Restless> {
    settle(&assembly.model, state, scratch, TOLERANCE).map_err(|error| Restless { error })
}

/// The next move of who wants a stack that stands.
fn remedy(lack: &Lack) -> String {
    match lack {
        Lack::Support => {
            "put something under it, or let it fall from the start (run.settle = false)".to_owned()
        }
        Lack::Stiffness { interface, .. } => format!(
            "see whether interface.{interface}.stiffness has the right unit, or take fewer levels"
        ),
        Lack::Friction { interface, .. } => format!(
            "a larger coefficient of interface.{interface}.friction may hold it, or a place where it \
             does not slide"
        ),
        Lack::Stick { interface, .. } => format!(
            "interface.{interface}.friction.law = \"coulomb\" holds it; or start without equilibrium \
             (run.settle = false) and let it creep"
        ),
        Lack::Balance { .. } => {
            "fewer levels, stiffer or wider bearings, or a place further from the \
                                 edge may keep it upright"
                .to_owned()
        }
        Lack::Place => "see whether it has room, and lies where it should".to_owned(),
        Lack::Time { .. } => "see whether the stiffnesses of its contacts have the right unit, or \
                              start without equilibrium (run.settle = false)"
            .to_owned(),
    }
}
