//! Stiffness of seats from a tap test: the period at which a stack sways after a light push.

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

/// Natural logarithm of the largest factor by which the stiffness in the scenario is multiplied or divided in
/// the search.
const WIDEST: f64 = 7.0;

/// Number of bisection steps in the logarithm of the factor.
const HALVINGS: u32 = 24;

/// Fits the stiffness of all seats of a stack to the period of its sway.
///
/// The table has the column `period`, with one row per tap. `scenario` is the stack that was tapped, in the
/// plane in which it swayed. The stiffnesses of all seats are multiplied by the same factor. The interval of the
/// stiffness follows from the 95 % interval of the mean period (Student's t distribution).
///
/// # Errors
/// If the table lacks its column or has fewer than two rows, the scenario is not a stack in one plane whose contact
/// laws are linear, or no stiffness gives the period.
pub fn sway(table: &Table, scenario: &Scenario) -> Result<Calibration, CalibrateError> {
    let refuse = |reason: &str| CalibrateError::Scenario(reason.to_owned());
    let stack = scenario.stack().filter(|_| !scenario.is_spatial()).ok_or_else(|| {
        refuse(
            "a tap test needs a planar stack, in the plane in which it swayed: set stack.view to \"transverse\" or \
             \"longitudinal\"",
        )
    })?;
    if stack.across().is_some() {
        return Err(refuse(
            "a tap test measures the sway in one plane, but stack.view = \"both\" has two planes: set stack.view to \
             \"transverse\" or \"longitudinal\"",
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
                "a tap test needs linear contact laws with constants per seat or per node; the law of interface.{name} \
                 is of another kind"
            ))
        })
    });
    let own = own.collect::<Result<Vec<f64>, _>>()?;
    let periods = table.required("period", Dimension::TIME)?;
    if periods.len() < 2 {
        return Err(table
            .unsuited("the scatter cannot be computed from one row: repeat the test at least once")
            .into());
    }
    let (period, half) = mean(&periods);
    let factor = |period: f64| factor(scenario, period);
    let outside = || {
        table.unsuited(
            "no stiffness within a factor of 1000 of that in the scenario gives this period: check that the scenario is the stack \
             that was tapped, in the plane in which it swayed, and that each period is that of a whole cycle",
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
            // Scaled so that the damping ratio stays the same.
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

/// Returns the factor by which the stiffness of all seats is to be multiplied so that the stack sways with a
/// period (s); `None` if no factor within the range gives that period.
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
            // A stack too soft to stand counts as slower than any period.
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

/// Returns the stiffness (N/m) of a linear contact law whose constants are per seat or per node; `None` for other
/// contact laws.
fn stiffness(law: &Interface) -> Option<f64> {
    let (NormalLaw::SpeedGap { stiffness, .. } | NormalLaw::KelvinVoigt { stiffness, .. }) =
        law.normal
    else {
        return None;
    };
    (law.basis != Basis::Length).then_some(stiffness)
}

/// Returns the basis of the constants of a contact law, "seat" or "node".
fn basis(law: &Interface) -> &'static str {
    if law.basis == Basis::Seat { "seat" } else { "node" }
}

/// Returns the damping (N·s/m) of a linear contact law; `None` if the law has a coefficient of restitution instead.
fn damping(law: &Interface) -> Option<f64> {
    let (NormalLaw::SpeedGap { damping, .. } | NormalLaw::KelvinVoigt { damping, .. }) = law.normal
    else {
        return None;
    };
    if let Damping::Coefficient(damping) = damping { Some(damping) } else { None }
}

/// Plots the period of every tap, and the mean.
fn picture(periods: &[f64], mean: &Estimate) -> Figure {
    let taps: Vec<f64> = (1..=periods.len()).map(|tap| tap as f64).collect();
    let ends = [0.5, periods.len() as f64 + 0.5];
    let series = vec![level(mean, ends, 0), measured("measured", taps, periods.to_vec(), 1)];
    let caption = "Tap test: the period of sway after every tap, and the mean with its interval.";
    figure("tap-test", caption, [Axis::new("tap", ""), Axis::new("period", "s")], series)
}
