//! Direction in which a stack is shaken.

use std::fmt::Write as _;

use barrelstack::check::Checked;

use crate::run::RunFailure;
use crate::scenario::{Scenario, View};

/// Direction in which a stack is shaken: in one vertical plane, or in three dimensions by all components of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// In one vertical plane, across or along the barrels.
    Plane(View),
    /// In three dimensions, by all components of a motion.
    Space,
}

impl Direction {
    /// Returns the direction in which the stack of a scenario is shaken; `None` if the scenario has no stack.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let view = scenario.stack()?.view;
        Some(if scenario.is_spatial() { Self::Space } else { Self::Plane(view) })
    }

    /// Returns the name that files use: "transverse", "longitudinal" or "spatial".
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane(view) => view.name(),
            Self::Space => "spatial",
        }
    }

    /// Returns the direction as a phrase, such as "along the barrels".
    pub fn words(self) -> &'static str {
        match self {
            Self::Plane(view) => view.words(),
            Self::Space => "in all directions",
        }
    }
}

/// Checks that the stack of a scenario stands under its own weight.
///
/// # Errors
/// If the stack cannot be built, or does not stand.
pub(crate) fn check(scenario: &Scenario) -> Result<Checked, RunFailure> {
    if scenario.is_spatial() {
        barrelstack_space::check(scenario)
    } else {
        barrelstack::check(scenario)
    }
}

/// Returns the `[[factor]]` table that rotates the motions of a study about the vertical axis by a random angle, for a
/// three-dimensional stack; empty for a stack in one plane.
///
/// Pulses and synthetic motions have only one horizontal component, and the direction of the next earthquake is
/// unknown. The angle is therefore drawn for every run.
pub(crate) fn turned(scenario: &Scenario) -> String {
    let mut text = String::new();
    if scenario.is_spatial() {
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "[[factor]]\nname = \"direction of the motion\"\nfield = \"stack.azimuth\"\n\
             distribution = {{ kind = \"uniform\", from = \"0 deg\", to = \"360 deg\" }}\n\n"
        );
    }
    text
}
