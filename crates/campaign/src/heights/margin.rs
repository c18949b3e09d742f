//! Static margins: the horizontal acceleration at which a stack comes apart when it grows slowly.

use std::ops::ControlFlow;

use super::{HeightsError, Request, plan};
use crate::outcome::Outcome;
use crate::pool;
use crate::run::RunFailure;
use crate::scenario::{Scenario, View};
use crate::study::StudyError;

/// Growth of the acceleration: to what (m/s²) and within how long (s), along a quarter of a sine.
type Growth = (f64, f64);

/// First growth: to 1 g, so fast that a stack leaves its seats some tenths of a margin after it has lost its balance.
const FIRST: Growth = (barrelstack_motion::STANDARD_GRAVITY, 100.0);

/// Time (s) of the second growth, up to what the first one found: it ends so slowly that little more is added while the
/// stack leaves its seats.
const SECOND: f64 = 60.0;

/// Builds a stack of the catalog in one direction, under an acceleration that grows from nothing.
fn growing(
    request: &Request,
    (levels, view): (u32, View),
    (most, seconds): Growth,
) -> Result<Scenario, HeightsError> {
    let text = format!(
        "schema = 1\n{}[motion.pulse]\nkind = \"half-sine\"\namplitude = \"{most} m/s^2\"\nperiod = \"{} s\"\n\
         [run]\nduration = \"{seconds} s\"\nstop_after_collapse = \"0 s\"\n\
         [record]\nframe_rate = \"0.1 Hz\"\nhistory_rate = \"0.1 Hz\"\n",
        plan::stack(request, view, levels)?,
        4.0 * seconds
    );
    Ok(Scenario::from_str(&text).map_err(StudyError::from)?)
}

/// Returns the acceleration (m/s²) at which a stack leaves its seats; none where it stands to the end of the growth, zero
/// where it falls under its own weight.
fn leaves_at(
    scenario: &Scenario,
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Option<f64>, HeightsError> {
    let run = match scenario.run_watched(&mut |_| stop()) {
        Ok(run) => run,
        Err(RunFailure::Settle(rest)) if rest.falls() => return Ok(Some(0.0)),
        Err(failure) => return Err(HeightsError::Stack(failure)),
    };
    match run.outcome {
        Outcome::Collapse { time, .. } => {
            let motion = run.ground.motion.as_ref();
            Ok(motion.map(|motion| motion.horizontal.at(time).acceleration.abs()))
        }
        Outcome::Interrupted => Err(StudyError::Stopped.into()),
        Outcome::Stable | Outcome::NotJudged | Outcome::Invalid { .. } => Ok(None),
    }
}

/// Returns the static margin (m/s²) of a stack; none where it stands until 1 g.
fn margin(
    request: &Request,
    stack: (u32, View),
    stop: &(dyn Fn() -> ControlFlow<()> + Sync),
) -> Result<Option<f64>, HeightsError> {
    let first = leaves_at(&growing(request, stack, FIRST)?, stop)?;
    let Some(most) = first.filter(|most| *most > 0.0) else { return Ok(first) };
    let second = leaves_at(&growing(request, stack, (most, SECOND))?, stop)?;
    Ok(second.or(first))
}

/// Returns the static margins (m/s²) of stacks by their levels and directions, in their order; none for one that stands
/// until 1 g.
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
            // Accelerations that grow to less and to more, and stay near that for ten seconds.
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
        // The higher stack has less.
        assert!(found[2] < found[1], "{found:?}");
    }
}
