//! Static margins: the largest steady horizontal acceleration that a stack withstands, found by tilting the floor.

use std::ops::ControlFlow;

use barrelstack::stability::stability;

use super::{HeightsError, Request, plan};
use crate::direction::Direction;
use crate::pool;
use crate::run::RunFailure;
use crate::scenario::View;
use crate::study::StudyError;

/// Returns the static margin (m/s²) of a stack: `None` if the stack stands even at 1 g, zero if it falls under its own
/// weight. For a three-dimensional stack it is the smaller of the margins across and along the barrels.
fn margin(
    request: &Request,
    (levels, direction): (u32, Direction),
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Option<f64>, HeightsError> {
    if stop().is_break() {
        return Err(StudyError::Stopped.into());
    }
    if direction == Direction::Space {
        let mut least: Option<f64> = None;
        for view in View::ALL {
            let found = margin(request, (levels, Direction::Plane(view)), stop)?;
            least = least.into_iter().chain(found).reduce(f64::min);
        }
        return Ok(least);
    }
    let scenario = plan::at_rest(request, direction, levels)?;
    match stability(&scenario) {
        // A tilted floor acts like a level floor with a steady horizontal acceleration of g times the tangent of the
        // tilt.
        Ok(found) => {
            Ok(found.tilt.map(|tilt| barrelstack_motion::STANDARD_GRAVITY * libm::tan(tilt)))
        }
        Err(RunFailure::Settle(rest)) if rest.falls() => Ok(Some(0.0)),
        Err(failure) => Err(HeightsError::Stack(failure)),
    }
}

/// Returns the static margin (m/s²) of each stack; `None` for a stack that stands even at 1 g.
///
/// Each element of `stacks` holds the number of levels of a stack and the direction in which the stack is shaken.
pub(super) fn margins(
    request: &Request,
    stacks: &[(u32, Direction)],
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Vec<Option<f64>>, HeightsError> {
    let of = |stack: &(u32, Direction)| margin(request, *stack, stop);
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
    use crate::scenario::Scenario;

    fn going() -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    #[test]
    fn a_stack_stands_below_its_margin_and_falls_above_it() {
        let request = Request::default();
        let [across, along] = View::ALL.map(Direction::Plane);
        let stacks = [(6, across), (2, along), (4, along), (6, Direction::Space), (6, along)];
        let found: Vec<f64> =
            margins(&request, &stacks, &going).unwrap().into_iter().map(Option::unwrap).collect();
        println!("{found:?} m/s²");
        for ((levels, direction), margin) in stacks[..3].iter().zip(&found) {
            // The acceleration grows to the given share of the margin and stays near that value for ten seconds.
            let falls = |share: f64| {
                let text = format!(
                    "schema = 1\n{}[motion.pulse]\nkind = \"half-sine\"\namplitude = \"{} m/s^2\"\nperiod = \"80 s\"\n\
                     [run]\nduration = \"40 s\"\nstop_after_collapse = \"0 s\"\n",
                    plan::stack(&request, *direction, *levels).unwrap(),
                    share * margin
                );
                Scenario::from_str(&text).unwrap().run().unwrap().outcome != Outcome::Stable
            };
            assert_eq!([falls(0.8), falls(1.15)], [false, true], "{levels} {direction:?}");
        }
        // The margin of the higher stack is smaller.
        assert!(found[2] < found[1], "{found:?}");
        // For a three-dimensional stack, the margin is the smaller of the margins across and along the barrels.
        assert_eq!(found[3], found[0].min(found[4]));
    }
}
