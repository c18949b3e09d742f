//! Is a scenario sound, and does its stack stand before it is shaken?

use crate::assemble::PartKind;
use crate::run::{RunFailure, end_time};
use crate::scenario::Scenario;
use crate::stand::{Standing, stand};
use crate::stick::SoftStick;

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    lines: Vec<String>,
}

impl Checked {
    /// What was found, a line each, for people.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        self.lines.iter().map(String::as_str)
    }
}

/// Does everything that comes before the shaking.
///
/// # Errors
/// As [`Scenario::run`].
pub fn check(scenario: &Scenario) -> Result<Checked, RunFailure> {
    let mut lines = vec![scenario.title.clone()];
    let ground = scenario.ground()?;
    let end_time = end_time(scenario, &ground, scenario.run.similitude.sqrt())?;
    let Standing { assembly, state, scratch, settled, step } = stand(scenario, end_time)?;
    let count = |kind| assembly.of_kind(kind).count();
    let counts = [
        (count(PartKind::Barrel), "barrel"),
        (count(PartKind::Rack), "rack"),
        (count(PartKind::Body), "free body"),
    ];
    let counts: Vec<String> = counts
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| match (count, name) {
            (1, _) => format!("1 {name}"),
            (_, "free body") => format!("{count} free bodies"),
            _ => format!("{count} {name}s"),
        })
        .collect();
    lines.push(format!("  bodies        {}", counts.join(", ")));
    lines.push(format!("  time step     {:.3} ms", 1e3 * step));
    if let Some(settled) = settled {
        let sunk = assembly.model.bodies().iter().zip(&state.poses);
        let deepest =
            sunk.map(|(body, now)| body.pose.position.z - now.position.z).fold(0.0, f64::max);
        lines.push(format!(
            "  at rest       after {} steps, deepest sinking {:.1} mm, forces balanced to {:.0e} of \
             gravity",
            settled.steps,
            1e3 * deepest,
            settled.unbalanced
        ));
        let locked = settled.locked;
        lines.push(format!(
            "  friction      locked in as the stack sank: {:.0} % of the normal forces, at {} contacts \
             that hold and {} at their limit",
            100.0 * locked.friction,
            locked.holding,
            locked.slipping
        ));
    }
    if let Some(motion) = &ground.motion {
        lines.push(format!(
            "  motion        {}: {:.2} s, PGA {:.3} g, PGV {:.1} cm/s, PGD {:.1} cm",
            motion.name,
            motion.duration,
            motion.pga() / barrelstack_motion::STANDARD_GRAVITY,
            100.0 * motion.pgv(),
            100.0 * motion.pgd()
        ));
    }
    if scenario.run.settle {
        let soft = SoftStick::of(&assembly, &scratch, ground.motion.as_ref());
        lines.extend(soft.iter().map(|stick| format!("  stick         {stick}")));
    }
    lines.extend(ground.warnings.iter().map(|warning| format!("  warning       {warning}")));
    lines.push(format!("  fingerprint   {:016x}", scenario.fingerprint()));
    lines.push("the scenario is sound".into());
    Ok(Checked { lines })
}
