//! What would have kept a stack up, in a sentence and as a table.

use barrelstack_report::{Cell, Table, capital};

use super::remedy::{PRETENSIONS, Remedy, Tried};
use super::words::percent;
use crate::scenario::title::{counted, number};

impl Remedy {
    /// What would have kept the stack up, or that nothing of what was tried would.
    pub fn sentence(&self) -> String {
        let any = |kind: &str| self.tried.iter().any(|one| one.kind == kind);
        let most = 1e-3 * PRETENSIONS[PRETENSIONS.len() - 1];
        let sentence = match (&self.height, &self.straps) {
            (Some(height), Some(straps)) if share(height) == share(straps) => {
                format!(
                    "{}, or {}, would have stood in {}",
                    name(height),
                    name(straps),
                    share(height)
                )
            }
            (Some(height), Some(straps)) => format!(
                "{} would have stood in {}, {} in {}",
                name(height),
                share(height),
                name(straps),
                share(straps)
            ),
            (Some(height), None) if self.complete && any("straps") => format!(
                "{} would have stood in {}; straps tightened to at most {most} kN would not suffice",
                name(height),
                share(height)
            ),
            (None, Some(straps)) if any("height") => format!(
                "{} would have stood in {}; fewer levels without them would not suffice",
                name(straps),
                share(straps)
            ),
            (Some(one), None) | (None, Some(one)) => {
                format!("{} would have stood in {}", name(one), share(one))
            }
            (None, None) if !self.complete => {
                return "What would have kept it up is not known: the search was stopped."
                    .to_owned();
            }
            (None, None) => {
                let tried = match (any("height"), any("straps")) {
                    (true, true) => format!(
                        "neither fewer levels, down to one, nor straps tightened to at most {most} kN"
                    ),
                    (true, false) => "fewer levels, down to one".to_owned(),
                    (false, _) => format!("straps tightened to at most {most} kN"),
                };
                return format!("Nothing that was tried would have kept it up: {tried}.");
            }
        };
        let stopped = if self.complete { "" } else { " The search for more was stopped." };
        format!("{}.{stopped}", capital(&sentence))
    }

    /// Every change that was tried.
    pub(crate) fn table(&self) -> Table {
        let caption = format!(
            "Changes that were tried, each in variants of its own; one suffices when at least {:.0} % of \
             all stand in every plane, and is dropped as soon as too many have failed. Straps do not \
             slip on what they tie.",
            100.0 * self.required_share
        );
        let verdict = |one: &Tried| match (one.suffices, self.complete) {
            (true, _) => "yes",
            (false, true) => "no",
            (false, false) => "not known",
        };
        Table::of(
            caption,
            &self.tried,
            &[
                ("change", "", &|one| Cell::text(name(one))),
                ("variants run", "", &|one| Cell::Measured(f64::from(one.variants), 0)),
                ("of these fall", "", &|one| Cell::Measured(f64::from(one.failed), 0)),
                ("share that falls, 95 % interval", "", &|one| {
                    Cell::text(one.interval.map(percent).join(" to "))
                }),
                ("suffices", "", &|one| Cell::text(verdict(one))),
            ],
        )
    }
}

/// A change: "three levels", "five levels strapped together at 4 kN".
pub(super) fn name(tried: &Tried) -> String {
    let levels = counted(tried.levels, "level");
    match tried.pretension {
        None => levels,
        Some(pretension) if tried.levels == 1 => {
            format!("barrels strapped to their racks at {} kN", 1e-3 * pretension)
        }
        Some(pretension) => {
            format!("{} levels strapped together at {} kN", number(tried.levels), 1e-3 * pretension)
        }
    }
}

/// The share that stands: "63 of 64 variants".
fn share(tried: &Tried) -> String {
    let Tried { variants, failed, .. } = tried;
    if *failed == 0 {
        format!("all {variants} variants")
    } else {
        format!("{} of {variants} variants", variants - failed)
    }
}
