//! Check of a three-dimensional scenario without shaking: whether the scenario is valid, and whether its stack stands.

use barrelstack::assemble::PartKind;
use barrelstack::check::{AtRest, Checked};
use barrelstack::ground::{MotionSummary, from_disk};
use barrelstack::{RunFailure, Scenario};

use crate::ground::Ground;
use crate::run::{Standing, affordable, stand};

/// Checks a scenario: reads its motion, builds its stack and settles the stack, but does not shake the stack.
///
/// ```
/// use barrelstack::Scenario;
///
/// let found = barrelstack_space::check(&Scenario::builtin("rolling-ball", &[])?)?;
/// assert_eq!(found.free_bodies, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The same as for [`run`](crate::run::run).
pub fn check(scenario: &Scenario) -> Result<Checked, RunFailure> {
    let scenario = &scenario.with_records(&mut from_disk)?;
    let ground = Ground::of(scenario)?;
    let Standing { stack, state, settled, .. } = stand(scenario)?;
    affordable(scenario, &stack, &ground)?;
    let count = |kind| stack.of_kind(kind).count();
    let sunk = stack.model.bodies().iter().zip(&state.poses);
    let sunk = sunk.map(|(body, now)| body.pose.position.z - now.position.z).fold(0.0, f64::max);
    Ok(Checked {
        schema: "check/1",
        title: scenario.title.clone(),
        view: (!stack.is_free()).then_some("spatial"),
        barrels: count(PartKind::Barrel),
        racks: count(PartKind::Rack),
        free_bodies: count(PartKind::Body),
        time_step: stack.step,
        rest: settled.map(|settled| AtRest::of(settled, sunk)),
        motion: ground.first.motion.as_ref().map(MotionSummary::of),
        // Only plane models warn about contacts whose sticking stiffness is too low.
        sticks: Vec::new(),
        warnings: ground.warnings,
        scenario_hash: format!("{:016x}", scenario.fingerprint()),
        other_plane: None,
    })
}
