//! Static margins: the largest steady horizontal acceleration that a stack bears, found by tilting the floor.

use std::ops::ControlFlow;

use barrelstack::stability::stability;

use super::{HeightsError, Request, plan};
use crate::pool;
use crate::run::RunFailure;
use crate::scenario::{Scenario, View};
use crate::study::StudyError;

/// Returns the static margin (m/s²) of a stack: `None` if the stack stands even at 1 g, zero if it falls
/// under its own weight.
fn margin(
    request: &Request,
    (levels, view): (u32, View),
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Option<f64>, HeightsError> {
    if stop().is_break() {
        return Err(StudyError::Stopped.into());
    }
    let text = format!("schema = 1\nmotion.none = true\n{}", plan::stack(request, view, levels)?);
    let scenario = Scenario::from_str(&text).map_err(StudyError::from)?;
    match stability(&scenario) {
        // A tilted floor acts like a level floor with a steady horizontal acceleration of g times the tangent of the tilt.
        Ok(found) => {
            Ok(found.tilt.map(|tilt| barrelstack_motion::STANDARD_GRAVITY * libm::tan(tilt)))
        }
        Err(RunFailure::Settle(rest)) if rest.falls() => Ok(Some(0.0)),
        Err(failure) => Err(HeightsError::Stack(failure)),
    }
}

/// Returns the static margin (m/s²) of each stack; stacks are given by levels and direction. `None` for a
/// stack that stands even at 1 g.
pub(super) fn margins(
    request: &Request,
    stacks: &[(u32, View)],
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Vec<Option<f64>>, HeightsError> {
    let of = |stack: &(u32, View)| margin(request, *stack, stop);
    pool::map(stacks, of, &|_| ()).into_iter().collect()
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::print_stdout,
        reason = "a test that shows what it measured"
    )]

    use super::*;
    use crate::outcome::Outcome;

    fn going() -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    #[test]
    fn a_stack_stands_below_its_margin_and_falls_above_it() {
        let request = Request::default();
        let stacks = [(6, View::Transverse), (2, View::Longitudinal), (4, View::Longitudinal)];
        let found: Vec<f64> =
            margins(&request, &stacks, &going).unwrap().into_iter().map(Option::unwrap).collect();
        println!("{found:?} m/s²");
        for ((levels, view), margin) in stacks.iter().zip(&found) {
            // An acceleration that grows to a share of the margin and stays near it for ten seconds.
            let falls = |share: f64| {
                let text = format!(
                    "schema = 1\n{}[motion.pulse]\nkind = \"half-sine\"\namplitude = \"{} m/s^2\"\nperiod = \"80 s\"\n\
                     [run]\nduration = \"40 s\"\nstop_after_collapse = \"0 s\"\n",
                    plan::stack(&request, *view, *levels).unwrap(),
                    share * margin
                );
                Scenario::from_str(&text).unwrap().run().unwrap().outcome != Outcome::Stable
            };
            assert_eq!([falls(0.8), falls(1.15)], [false, true], "{levels} {view:?}");
        }
        // The higher stack has the smaller margin.
        assert!(found[2] < found[1], "{found:?}");
    }
}
