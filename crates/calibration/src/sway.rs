//! Stiffness of seats from a tap test: the period at which a stack sways that was pushed lightly.

use std::fmt::Write as _;

use barrelstack::scenario::{Basis, Damping, Dimension, Interface, NormalLaw, Scenario, Scene};
use barrelstack::stability::sway_period;
use barrelstack::{RunFailure, scenario::StackInterfaces};
use barrelstack_dynamics::math;
use barrelstack_report::{Axis, Figure};

use super::figures::{figure, level, measured};
use super::result::quoted;
use super::statistics::mean;
use super::{CalibrateError, Calibration, Estimate, Table};

/// Natural logarithm of the greatest factor on the stiffness of the scenario that is tried, and how often it is halved.
const WIDEST: f64 = 7.0;
const HALVINGS: u32 = 24;

/// Fits the stiffness of all seats of a stack to the period of its sway.
///
/// The column is `period`, one row for each tap.
/// `scenario` is the stack that was tapped, in the plane in which it swayed; its seats keep the ratios of their stiffness.
/// The interval is that of the mean period by Student's t.
///
/// # Errors
/// When the table lacks its column or has less than two rows, when the scenario is no stack of linear laws in one plane, or
/// when no stiffness gives the period.
pub fn sway(table: &Table, scenario: &Scenario) -> Result<Calibration, CalibrateError> {
    let refuse = |reason: &str| CalibrateError::Scenario(reason.to_owned());
    let stack = scenario.stack().filter(|_| !scenario.is_spatial()).ok_or_else(|| {
        refuse(
            "a tap test is about a stack in one plane, the one in which it swayed: set stack.view to \"transverse\" or \
             \"longitudinal\"",
        )
    })?;
    if stack.across().is_some() {
        return Err(refuse(
            "stack.view = \"both\" is two planes, and a tap sways the stack in one: set stack.view to \"transverse\" or \
             \"longitudinal\"",
        ));
    }
    let seats = [
        ("barrel-rack", &stack.interfaces.barrel_rack, true),
        ("rack-ground", &stack.interfaces.rack_ground, true),
        ("rack-rack", &stack.interfaces.rack_rack, stack.rack.posts.is_some()),
    ];
    let seats: Vec<(&str, &Interface)> =
        seats.iter().filter(|(.., there)| *there).map(|(name, law, _)| (*name, *law)).collect();
    let own = seats.iter().map(|(name, law)| {
        stiffness(law).ok_or_else(|| {
            refuse(&format!(
                "a tap test needs linear laws with constants per seat or per node; interface.{name} has another"
            ))
        })
    });
    let own = own.collect::<Result<Vec<f64>, _>>()?;
    let periods = table.required("period", Dimension::TIME)?;
    if periods.len() < 2 {
        return Err(table
            .unsuited("one row shows no scatter: repeat the test at least once")
            .into());
    }
    let (period, half) = mean(&periods);
    let factor = |period: f64| factor(scenario, period);
    let outside = || {
        table.unsuited(
            "no stiffness within a factor of 1000 of the scenario's gives this period: check that the scenario is the stack that \
             was tapped, in the plane in which it swayed, and that times are of whole cycles",
        )
    };
    let of = |factor: f64| factor * own[0];
    let value = factor(period)?.ok_or_else(outside)?;
    let low = factor(period + half)?.map_or(0.0, of);
    let high = if period > half {
        factor(period - half)?.map_or(f64::INFINITY, of)
    } else {
        f64::INFINITY
    };
    let name = "stiffness k".to_owned();
    let estimate = Estimate { name, value: of(value), low, high, dimension: Dimension::STIFFNESS };
    let mut lines = String::new();
    for ((name, law), own) in seats.iter().zip(&own) {
        let stiffness = quoted(value * own, Dimension::STIFFNESS);
        let _ = writeln!(
            lines,
            "[interface.{name}]\nbasis = \"{}\"\nstiffness = {stiffness}",
            basis(law)
        );
        if let Some(damping) = damping(law) {
            // The damping ratio stays.
            let damping = quoted(value.sqrt() * damping, Dimension::DAMPING);
            let _ = writeln!(lines, "damping = {damping}");
        }
    }
    let measured_period = Estimate::symmetric("period", period, half, Dimension::TIME);
    Ok(Calibration {
        title: format!("tap test {}: period of sway", table.file()),
        figures: vec![picture(&periods, &measured_period)],
        estimates: vec![estimate, measured_period],
        facts: vec![("taps".to_owned(), periods.len().to_string())],
        scenario: lines,
        warnings: table.unused(&["period"]),
        ..Calibration::default()
    })
}

/// The factor on the stiffness of all seats with which the stack of a scenario sways at a period (s); none where there is none.
fn factor(scenario: &Scenario, period: f64) -> Result<Option<f64>, CalibrateError> {
    let slower = |log: f64| -> Result<bool, CalibrateError> {
        let mut changed = scenario.clone();
        if let Scene::Stack { stack, .. } = &mut changed.scene {
            let StackInterfaces { barrel_rack, rack_ground, rack_rack, .. } = &mut stack.interfaces;
            for law in [barrel_rack, rack_ground, rack_rack] {
                law.stiffen(math::exp(log));
            }
        }
        match sway_period(&changed) {
            Ok(found) => Ok(found.is_none_or(|found| found > period)),
            // What is too soft to stand takes longer than any period.
            Err(RunFailure::Settle(_)) => Ok(true),
            Err(failure) => Err(failure.into()),
        }
    };
    let (mut soft, mut stiff) = (-WIDEST, WIDEST);
    if !slower(soft)? || slower(stiff)? {
        return Ok(None);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (soft + stiff);
        if slower(middle)? {
            soft = middle;
        } else {
            stiff = middle;
        }
    }
    Ok(Some(math::exp(0.5 * (soft + stiff))))
}

/// The stiffness (N/m) of a linear law whose constants are of a seat or a node.
fn stiffness(law: &Interface) -> Option<f64> {
    let (NormalLaw::SpeedGap { stiffness, .. } | NormalLaw::KelvinVoigt { stiffness, .. }) =
        law.normal
    else {
        return None;
    };
    (law.basis != Basis::Length).then_some(stiffness)
}

/// The word for the basis of a law whose constants are of a seat or a node.
fn basis(law: &Interface) -> &'static str {
    if law.basis == Basis::Seat { "seat" } else { "node" }
}

/// The damping (N·s/m) of a linear law that states it rather than a restitution.
fn damping(law: &Interface) -> Option<f64> {
    let (NormalLaw::SpeedGap { damping, .. } | NormalLaw::KelvinVoigt { damping, .. }) = law.normal
    else {
        return None;
    };
    if let Damping::Coefficient(damping) = damping { Some(damping) } else { None }
}

/// The period of every tap, and their mean.
fn picture(periods: &[f64], mean: &Estimate) -> Figure {
    let taps: Vec<f64> = (1..=periods.len()).map(|tap| tap as f64).collect();
    let ends = [0.5, periods.len() as f64 + 0.5];
    let series = vec![level(mean, ends, 0), measured("measured", taps, periods.to_vec(), 1)];
    let caption =
        "The tap test: the period of sway after every tap, and their mean with its interval.";
    figure("tap-test", caption, [Axis::new("tap", ""), Axis::new("period", "s")], series)
}
