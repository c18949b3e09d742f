//! Measured blocks: the granite blocks of Peña et al. on a shaking table.
//!
//! The sizes are exact, and the reference answers are exact solutions of rigid-body theory. The measured ratios of
//! angular velocities have not been verified against the publication. The problems do not check the measurements. They
//! check that the contact can be calibrated to a measured block.

use barrelstack_dynamics::math::atan;

use crate::problem::{relative, setting};
use crate::rocking::RockingBlock;
use crate::{Effort, Failure, Outcome, Problem, theory};

use super::housner::firm;

const SOURCE: &str = "Peña, Prieto, Lourenço et al. 2007, blocks S1 to S3";

/// Name, width (m) and height (m) of each block, and the measured ratio of its angular velocities after and before an
/// impact.
///
/// The measured ratio of S3, 0.978, is left out, because no damping of the contact can give it: the smallest possible
/// ratio is Housner's, 0.9787.
const BLOCKS: [(&str, f64, f64, Option<f64>); 3] =
    [("s1", 0.25, 1.000, Some(0.936)), ("s2", 0.17, 1.000, Some(0.973)), ("s3", 0.12, 1.000, None)];

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let periods = BLOCKS.into_iter().map(|(name, width, height, _)| period(name, width, height));
    let decays = BLOCKS
        .into_iter()
        .filter_map(|(name, width, height, ratio)| Some(decay(name, width, height, ratio?)));
    periods.chain(decays).collect()
}

/// Returns the half-diagonal (m) and the slenderness angle (rad) of a block.
fn dimensions(width: f64, height: f64) -> (f64, f64) {
    (0.5 * width.hypot(height), atan(width / height))
}

fn period(name: &str, width: f64, height: f64) -> Problem {
    let (radius, alpha) = dimensions(width, height);
    let exact = theory::quarter_period(alpha, 0.5) / theory::rocking_rate(radius);
    setting(
        format!("measured/{name}-quarter-period"),
        format!("granite block {width} m by {height} m released at φ = 0.5"),
        SOURCE,
    )
    .quantity("time until the block is upright", "s", relative(exact, 5e-3).fast(1.2e-2)) // measured 9.6e-6
    .by(move |effort| {
        let block = firm(effort, radius, alpha);
        Ok(block.quarter_period(0.5)? / block.rate())
    })
}

/// Creates the problem of the peak rotation of a block after three impacts. The damping of the contact is calibrated so
/// that the first impact has the measured ratio of angular velocities.
fn decay(name: &str, width: f64, height: f64, ratio: f64) -> Problem {
    let (radius, alpha) = dimensions(width, height);
    let exact = (0..3).fold(0.5, |share, _| theory::next_peak(alpha, share, ratio * ratio));
    setting(
        format!("measured/{name}-decay"),
        format!(
            "the same block, with the damping calibrated at the first impact to the measured η = \
             {ratio}"
        ),
        SOURCE,
    )
    // The loss at an impact depends slightly on the rotation, mostly for the smallest of the three blocks.
    .quantity(
        "peak rotation divided by α after three impacts",
        "",
        relative(exact, 3e-2).fast(6e-2),
    ) // measured 5.8e-3; measured 9.6e-4
    .by(move |effort| {
        let stiffer = if effort == Effort::Full { 1.0 } else { 0.5 };
        let block = RockingBlock {
            contact_frequency: 3000.0 * stiffer,
            ..RockingBlock::new(radius, alpha)
        };
        let Some(block) = block.calibrated(ratio)? else {
            return Err(Failure::Absent(format!("no damping ratio gives η = {ratio}")));
        };
        let swings = block.swings(0.5, 3, 20.0 / block.rate())?;
        let Some((_, last)) = swings.get(2) else {
            return Err(Failure::Absent("fewer than three impacts".into()));
        };
        Ok(Outcome::of(*last).noted(format!(
            "ζ = {:.3}; Housner's own ratio is {:.4}",
            block.damping_ratio,
            theory::housner_restitution(alpha)
        )))
    })
}
