//! Free rocking of a block: period and amplitude, energy loss at impacts, uplift, and overturning by a single pulse.

use barrelstack_dynamics::math::{cos, tan};

use crate::drive::{Both, Shake};
use crate::problem::{border, halvings, refine, relative, setting};
use crate::rocking::{Corner, RockingBlock, contact_frequency};
use crate::{Effort, Failure, GRAVITY, Problem, theory};

const SOURCE: &str = "Housner 1963";

/// Creates a block whose corners are damped enough to reproduce Housner's ratio of angular velocities at an impact.
pub(super) fn firm(effort: Effort, radius: f64, alpha: f64) -> RockingBlock {
    RockingBlock {
        // Damping in both directions is closer to Housner's plastic impact than damping on approach alone.
        corner: Corner::KelvinVoigt,
        damping_ratio: 3.0,
        contact_frequency: contact_frequency(effort),
        ..RockingBlock::new(radius, alpha)
    }
}

/// Creates a slender block, for comparison with closed-form solutions that assume small angles. The contact is so stiff
/// that the penetration stays small.
pub(super) fn slender(effort: Effort, radius: f64) -> RockingBlock {
    let stiffer = if effort == Effort::Full { 5.0 } else { 4.0 };
    RockingBlock {
        contact_frequency: stiffer * contact_frequency(effort),
        ..firm(effort, radius, 0.03)
    }
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    for alpha in [0.10, 0.25, 0.40] {
        list.extend([0.10, 0.25, 0.50, 0.75, 0.90].map(|share| quarter_period(alpha, share)));
    }
    list.extend([0.10, 0.25, 0.40].map(ratio));
    for (alpha, count) in [(0.25, 5), (0.40, 3)] {
        list.extend((1..=count).map(|n| decay(alpha, n)));
        list.push(half_period(alpha, 1));
        list.push(half_period(alpha, count));
    }
    list.extend([0.10, 0.15, 0.25, 0.40].map(|alpha| uplift(alpha, 0.0)));
    list.extend([-0.3, 0.3].map(|vertical| uplift(0.25, vertical)));
    list.extend([0.25, 0.5, 1.0, 2.0].map(rectangular));
    list.push(impulse());
    list
}

fn quarter_period(alpha: f64, share: f64) -> Problem {
    let exact = theory::quarter_period(alpha, share);
    setting(
        format!("housner/quarter-period-{alpha:.2}-{share:.2}"),
        format!("block of α = {alpha} released at φ = {share}"),
        SOURCE,
    )
    .quantity("p multiplied by the quarter period", "", relative(exact, 1e-3).fast(5e-3)) // measured 1e-6
    .by(move |effort| {
        let block = firm(effort, 1.0, alpha);
        let slender = theory::slender_quarter_period(share);
        let mut outcome =
            refine(effort, exact, |level| block.refined(level - 1).quarter_period(share))?;
        outcome.note = format!("{}; slender block {slender:.5}", outcome.note);
        Ok(outcome)
    })
}

fn ratio(alpha: f64) -> Problem {
    let exact = theory::housner_restitution(alpha);
    setting(
        format!("housner/impact-{alpha:.2}"),
        format!("first impact of a block of α = {alpha} released at φ = 0.5"),
        SOURCE,
    )
    .quantity("ratio of angular velocities η", "", relative(exact, 1e-3).fast(5e-3))
    .refined(move |effort, level| firm(effort, 1.0, alpha).refined(level - 1).restitution(0.5))
}

/// Returns the peak rotation divided by α after a number of impacts. The block is released at rest at the rotation
/// `½ α`. The result is exact for any α.
fn peaks(alpha: f64, impacts: usize) -> f64 {
    let eta = theory::housner_restitution(alpha);
    (0..impacts).fold(0.5, |share, _| theory::next_peak(alpha, share, eta * eta))
}

fn decay(alpha: f64, impacts: usize) -> Problem {
    let exact = peaks(alpha, impacts);
    setting(
        format!("housner/decay-{alpha:.2}-{impacts}"),
        format!("block of α = {alpha} released at φ = 0.5"),
        SOURCE,
    )
    .quantity(
        "peak rotation divided by α after the number of impacts in the name",
        "",
        relative(exact, 1e-2).fast(3e-2),
    )
    .by(move |effort| {
        let ratio = theory::housner_restitution(alpha).powi(2);
        let n = i32::try_from(impacts).unwrap_or(i32::MAX);
        let slender = 1.0 - (1.0 - ratio.powi(n) * 0.75).sqrt();
        let mut outcome = refine(effort, exact, |level| {
            let block = firm(effort, 1.0, alpha).refined(level - 1);
            nth(&block.swings(0.5, impacts, 10.0)?, impacts).map(|swing| swing.1)
        })?;
        outcome.note = format!("{}; slender block {slender:.4}", outcome.note);
        Ok(outcome)
    })
}

/// Returns the time (s) of the impact with the number `impacts`, counted from 1, and the next peak rotation divided by
/// α.
///
/// # Errors
/// If fewer impacts occurred.
fn nth(swings: &[(f64, f64)], impacts: usize) -> Result<(f64, f64), Failure> {
    swings.get(impacts - 1).copied().ok_or_else(|| {
        Failure::Absent(format!("only {} of {impacts} impacts occurred", swings.len()))
    })
}

fn half_period(alpha: f64, impacts: usize) -> Problem {
    let exact = 2.0 * theory::quarter_period(alpha, peaks(alpha, impacts));
    setting(
        format!("housner/half-period-{alpha:.2}-{impacts}"),
        format!("block of α = {alpha} released at φ = 0.5"),
        SOURCE,
    )
    .quantity("p multiplied by the time to the next impact", "", relative(exact, 5e-3).fast(2.5e-2))
    .refined(move |effort, level| {
        let block = firm(effort, 1.0, alpha).refined(level - 1);
        let swings = block.swings(0.5, impacts + 1, 12.0)?;
        let interval = nth(&swings, impacts + 1)?.0 - nth(&swings, impacts)?.0;
        Ok(interval * block.rate())
    })
}

/// Creates the problem of the uplift under a slowly growing horizontal ground acceleration, with a constant vertical
/// ground acceleration (g).
fn uplift(alpha: f64, vertical: f64) -> Problem {
    let exact = tan(alpha) * (1.0 + vertical);
    let name = if vertical == 0.0 {
        format!("{alpha:.2}")
    } else {
        format!("{alpha:.2}-vertical-{vertical:+.1}")
    };
    setting(
        format!("housner/uplift-{name}"),
        format!("block of α = {alpha}, vertical ground acceleration {vertical} g"),
        SOURCE,
    )
    .quantity(
        "horizontal ground acceleration that lifts a corner",
        "g",
        relative(exact, 5e-3).fast(1.2e-2),
    )
    .by(move |effort| {
        let block = firm(effort, 1.0, alpha);
        let bracket = (0.98 * exact, 1.02 * exact);
        border(bracket, halvings(effort), |push| {
            let ramped = |acceleration| Shake::Ramped { acceleration, ramp: 0.2 };
            let drive = Both { x: ramped(push * GRAVITY), z: ramped(vertical * GRAVITY) };
            let mut scene = block.scene(0.0)?;
            scene.run(&drive, block.step(), 0.6)?;
            Ok(scene.state.poses[1].orientation.abs() > 2e-4)
        })
    })
}

fn rectangular(product: f64) -> Problem {
    let exact = theory::rectangular_overturning(product);
    setting(
        format!("housner/rectangular-{product}"),
        format!("slender block (α = 0.03), constant push of p t₁ = {product}"),
        SOURCE,
    )
    .quantity(
        "push divided by g tan α that overturns the block",
        "",
        relative(exact, 1e-2).fast(2.5e-2),
    )
    .by(move |effort| {
        // The sudden push makes the contact springs vibrate; the stiffer the springs, the smaller the vibration.
        refine(effort, exact, |level| {
            let softer = if effort == Effort::Full { 2 } else { 0 };
            let block = slender(effort, 1.0).refined(level - softer);
            let duration = product / block.rate();
            border((0.97 * exact, 1.03 * exact), halvings(effort), |strength| {
                let acceleration = strength * block.uplift();
                let push = Shake::Rectangular { acceleration, duration };
                block.overturns(&push, duration)
            })
        })
    })
}

fn impulse() -> Problem {
    let (radius, alpha) = (1.0, 0.25);
    let exact = (8.0 * GRAVITY * radius * (1.0 - cos(alpha)) / 3.0).sqrt() / cos(alpha);
    setting("housner/impulse", "block of α = 0.25, ground velocity reached within 2 ms", SOURCE)
        .quantity(
            "sudden ground velocity that overturns the block",
            "m/s",
            relative(exact, 1e-2).fast(2.5e-2),
        )
        .by(move |effort| {
            let block = firm(effort, radius, alpha);
            let duration = 2e-3;
            border((0.97 * exact, 1.03 * exact), halvings(effort), |velocity| {
                let push = Shake::Rectangular { acceleration: velocity / duration, duration };
                block.overturns(&push, duration)
            })
        })
}
