//! Check of a scenario without shaking: whether the scenario is valid, and whether its stack stands.

use barrelstack_columns::described;
use barrelstack_dynamics::Settled;
use barrelstack_dynamics::settle::Locked;

use crate::assemble::PartKind;
use crate::ground::{MotionSummary, from_disk};
use crate::run::{RunFailure, check_memory, end_time};
use crate::scenario::{Scenario, View};
use crate::stand::{Standing, stand};
use crate::stick::SoftStick;

described! {
    /// Result of the check of a valid scenario.
    #[derive(Clone, Debug)]
    pub struct Checked {
        /// Name and version of the format of this document.
        pub schema: &'static str ["check/1"],
        /// The scenario's title.
        pub title: String,
        /// Plane of the model, or `spatial` for a stack in three dimensions; null for a free scene.
        pub view: Option<&'static str> ["transverse", "longitudinal", "spatial"],
        /// Number of barrels.
        pub barrels: usize,
        /// Number of racks.
        pub racks: usize,
        /// Number of bodies of a free scene.
        pub free_bodies: usize,
        /// Time step.
        pub time_step: f64 as "s",
        /// State at rest; null if the scenario starts without settling.
        pub rest: Option<AtRest>,
        /// Ground motion.
        pub motion: Option<MotionSummary>,
        /// Warnings about friction springs that are too soft for the motion, one sentence each.
        pub sticks: Vec<String>,
        /// Warnings about the ground motion, one sentence each.
        pub warnings: Vec<String>,
        /// Hash of the scenario with every default written out.
        pub scenario_hash: String,
        /// Result for the other plane; null if the scenario has only one plane.
        pub other_plane: Option<Box<Checked>>,
    }

    /// State of a stack at rest.
    #[derive(Clone, Debug)]
    pub struct AtRest {
        /// Number of steps taken to find equilibrium.
        pub steps: u64,
        /// Largest distance by which a body sank while the stack came to rest.
        pub deepest_sinking: f64 as "m",
        /// Largest residual acceleration of any body, as a fraction of gravity.
        pub unbalanced: f64 as "1",
        /// Friction locked in while the stack settled, as a fraction of the normal forces.
        pub locked_friction: f64 as "1",
        /// Number of contacts that stick.
        pub holding: usize,
        /// Number of contacts at their friction limit.
        pub slipping: usize,
    }
}

impl AtRest {
    /// Creates the summary of a settled stack, given the largest settlement (m) of any body.
    pub fn of(Settled { steps, unbalanced, locked }: Settled, deepest_sinking: f64) -> Self {
        let Locked { friction: locked_friction, holding, slipping } = locked;
        Self { steps, deepest_sinking, unbalanced, locked_friction, holding, slipping }
    }
}

impl Checked {
    /// Returns the result of the check as lines of text.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![self.title.clone()];
        let counts =
            [(self.barrels, "barrel"), (self.racks, "rack"), (self.free_bodies, "free body")];
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
        lines.push(format!("  time step     {:.3} ms", 1e3 * self.time_step));
        if let Some(rest) = &self.rest {
            lines.push(format!(
                "  at rest       after {} steps, deepest sinking {:.1} mm, residual acceleration at most {:.0e} g",
                rest.steps,
                1e3 * rest.deepest_sinking,
                rest.unbalanced
            ));
            lines.push(format!(
                "  friction      at rest, {:.0} % of the normal forces; {} contacts stick, and {} are at their \
                 friction limit",
                100.0 * rest.locked_friction,
                rest.holding,
                rest.slipping
            ));
        }
        if let Some(motion) = &self.motion {
            lines.push(format!(
                "  motion        {}: {:.2} s, PGA {:.3} g, PGV {:.1} cm/s, PGD {:.1} cm",
                motion.name,
                motion.duration,
                motion.pga / barrelstack_motion::STANDARD_GRAVITY,
                100.0 * motion.pgv,
                100.0 * motion.pgd
            ));
        }
        lines.extend(self.sticks.iter().map(|stick| format!("  stick         {stick}")));
        lines.extend(self.warnings.iter().map(|warning| format!("  warning       {warning}")));
        lines.push(format!("  fingerprint   {}", self.scenario_hash));
        lines.push("the scenario is sound".into());
        lines
    }
}

/// Checks a scenario: performs all steps of a run that precede the shaking.
///
/// # Errors
/// The same as for [`Scenario::run`].
pub fn check(scenario: &Scenario) -> Result<Checked, RunFailure> {
    let scenario = &scenario.with_records(&mut from_disk)?;
    let ground = scenario.ground()?;
    let end_time = end_time(scenario, ground.motion_end(), scenario.run.similitude.sqrt())?;
    let standing = stand(scenario, end_time)?;
    let deepest = standing.deepest_sinking();
    let Standing { assembly, scratch, settled, step, .. } = standing;
    let scale = scenario.run.similitude.sqrt();
    let rates = (scenario.record.frame_rate / scale, scenario.record.history_rate / scale);
    check_memory(&assembly, end_time, rates)?;
    let count = |kind| assembly.of_kind(kind).count();
    let rest = settled.map(|settled| AtRest::of(settled, deepest));
    let sticks = if scenario.run.settle {
        SoftStick::of(&assembly, &scratch, ground.motion.as_ref())
    } else {
        Vec::new()
    };
    Ok(Checked {
        schema: "check/1",
        title: scenario.title.clone(),
        view: assembly.view.map(View::name),
        barrels: count(PartKind::Barrel),
        racks: count(PartKind::Rack),
        free_bodies: count(PartKind::Body),
        time_step: step,
        rest,
        motion: ground.motion.as_ref().map(MotionSummary::of),
        sticks: sticks.iter().map(ToString::to_string).collect(),
        warnings: ground.warnings,
        scenario_hash: format!("{:016x}", scenario.fingerprint()),
        other_plane: None,
    })
}
