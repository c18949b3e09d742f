//! Reasons why a stack does not come to rest, with remedies.

use barrelstack_dynamics::{Lack, SettleError};

/// Reason why a stack does not stand by itself, with a remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{error}; {}", remedy(&error.lack))]
pub struct Restless {
    /// The body that does not come to rest, and the reason.
    pub error: SettleError,
}

impl Restless {
    /// Returns `true` if the stack falls under its own weight.
    ///
    /// Returns `false` if this is unknown: if settling ran out of time before the forces balanced, or if a regularized
    /// friction law lets the stack creep.
    pub fn falls(&self) -> bool {
        match self.error.lack {
            Lack::Support
            | Lack::Stiffness { .. }
            | Lack::Friction { .. }
            | Lack::Balance { .. }
            | Lack::Place => true,
            Lack::Stick { .. } | Lack::Time { .. } => false,
        }
    }
}

fn remedy(lack: &Lack) -> String {
    match lack {
        Lack::Support => {
            "put a support under the body, or let it fall from the start (run.settle = false)".to_owned()
        }
        Lack::Stiffness { interface, .. } => format!(
            "check whether interface.{interface}.stiffness has the right unit, or use fewer levels"
        ),
        Lack::Friction { interface, .. } => format!(
            "to hold the body, try a larger coefficient of interface.{interface}.friction, or place the body where it \
             does not slide"
        ),
        Lack::Stick { interface, .. } => format!(
            "set interface.{interface}.friction.law = \"coulomb\" to hold the body, or start without equilibrium \
             (run.settle = false) and let it creep"
        ),
        Lack::Balance { .. } => {
            "to keep the body upright, try fewer levels, stiffer or wider bearings, or a place further from the edge"
                .to_owned()
        }
        Lack::Place => "check whether the body has enough room, and whether its position is right".to_owned(),
        Lack::Time { .. } => {
            "check whether the stiffnesses of its contacts have the right unit, or \
                              start without equilibrium (run.settle = false)"
                .to_owned()
        }
    }
}
