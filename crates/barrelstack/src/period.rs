//! Amplitude-dependent rocking period of a stack: computed for the equivalent rigid block, and
//! measured in a run.

use barrelstack_dynamics::Motion;

use crate::assemble::{Assembly, PartKind};
use crate::run::Run;

/// Rigid block equivalent to a stack whose parts do not move relative to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBlock {
    /// Distance (m) between the center of mass and the edge about which the block rocks.
    pub radius: f64,
    /// Angle (rad) at rest between the vertical and the line that joins the center of mass and the edge about which the
    /// block rocks; the block overturns if it tilts by more than this angle.
    pub slenderness: f64,
    /// Frequency parameter `p` (1/s): `p² = m g R / I`, where `I` is the moment of inertia about the edge.
    pub frequency: f64,
}

/// Height of the foot of a block, as a fraction of the total height of the block.
const FOOT: f64 = 1e-3;

impl RigidBlock {
    /// Returns the rigid block equivalent to all free bodies as assembled; `gravity` is in m/s².
    ///
    /// `None` if there are no free bodies, or if their foot has no width.
    pub fn of(assembly: &Assembly, gravity: f64) -> Option<Self> {
        let bodies =
            || assembly.model.bodies().iter().enumerate().filter(|(_, b)| b.motion == Motion::Free);
        let mass: f64 = bodies().map(|(_, body)| body.mass).sum();
        let points = || {
            bodies().flat_map(|(i, body)| {
                let outlines = assembly.parts[i].outlines.iter();
                outlines.flat_map(move |o| o.points.iter().map(move |p| body.pose.position + *p))
            })
        };
        let low = points().map(|p| p.z).fold(f64::INFINITY, f64::min);
        let high = points().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
        let foot = || points().filter(|p| p.z <= low + FOOT * (high - low)).map(|p| p.x);
        let left = foot().fold(f64::INFINITY, f64::min);
        let right = foot().fold(f64::NEG_INFINITY, f64::max);
        let center = |axis: fn(barrelstack_dynamics::Vec2) -> f64| {
            bodies().map(|(_, body)| body.mass * axis(body.pose.position)).sum::<f64>() / mass
        };
        let (x, z) = (center(|p| p.x), center(|p| p.z) - low);
        // The block rocks about the nearer edge first.
        let edge = if x - left < right - x { left } else { right };
        let (half, radius) = ((x - edge).abs(), libm::hypot(x - edge, z));
        let inertia: f64 = bodies()
            .map(|(_, body)| {
                let arm = libm::hypot(body.pose.position.x - edge, body.pose.position.z - low);
                body.inertia + body.mass * arm * arm
            })
            .sum();
        let frequency = (mass * gravity * radius / inertia).sqrt();
        let block = Self { radius, slenderness: libm::atan2(half, z), frequency };
        (half > 0.0 && frequency.is_finite()).then_some(block)
    }

    /// Returns the period (s) of free rocking between tilts of `±tilt` (rad), without energy loss:
    ///
    /// ```text
    /// T = (4/p) arcosh( 1 / (1 − θ₀/α) )
    /// ```
    ///
    /// The formula holds for slender blocks (Housner 1963, eq. 4). The period is 0 at rest and
    /// infinite at the overturning tilt.
    pub fn period(&self, tilt: f64) -> f64 {
        let share = (tilt.abs() / self.slenderness).min(1.0);
        4.0 / self.frequency * libm::acosh(1.0 / (1.0 - share))
    }
}

/// A half-cycle of a history: a swing to one side and back to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Start (s).
    pub start: f64,
    /// Period (s), which is twice the duration of the swing.
    pub period: f64,
    /// Largest absolute value during the swing, in the unit of the history.
    pub amplitude: f64,
}

/// Smallest amplitude of a reported swing, as a share of the largest amplitude.
const SMALLEST: f64 = 0.1;

/// Returns the swings of a history, each from one zero crossing to the next.
///
/// Zero crossings are interpolated linearly between samples. Swings with less than a tenth of the
/// largest amplitude are left out, because small impacts cause random zero crossings.
pub fn swings(times: &[f64], values: &[f64]) -> Vec<Swing> {
    let count = times.len().min(values.len());
    let mut crossings: Vec<(usize, f64)> = Vec::new();
    for k in 1..count {
        let (before, after) = (values[k - 1], values[k]);
        if (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0) {
            let share = before / (before - after);
            crossings.push((k, times[k - 1] + share * (times[k] - times[k - 1])));
        }
    }
    let mut swings: Vec<Swing> = crossings
        .windows(2)
        .map(|pair| {
            let [(first, start), (last, end)] = [pair[0], pair[1]];
            let amplitude = values[first..last].iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            Swing { start, period: 2.0 * (end - start), amplitude }
        })
        .collect();
    let largest = swings.iter().map(|swing| swing.amplitude).fold(0.0, f64::max);
    swings.retain(|swing| swing.amplitude > SMALLEST * largest);
    swings
}

/// Drift of the top of a stack relative to its foot, while the stack stood.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Height (m), in the stack as assembled, of the point whose drift is measured: the center of the top left barrel.
    pub height: f64,
    /// Largest absolute drift (m).
    pub largest: f64,
    /// Swings of the drift, with amplitudes in m.
    pub swings: Vec<Swing>,
}

/// Returns the drift of a stack: the displacement of its top left barrel minus that of its bottom
/// rack.
///
/// `None` for a free scene.
pub fn drift(run: &Run) -> Option<Drift> {
    let (recording, assembly) = (&run.recording, &run.assembly);
    let of = |kind: PartKind, level: u32| {
        assembly.of_kind(kind).find(|body| assembly.parts[*body].level == Some(level))
    };
    let (top, foot) = (of(PartKind::Barrel, assembly.levels)?, of(PartKind::Rack, 1)?);
    let end = run.fates.collapse_time().unwrap_or(f64::INFINITY);
    let standing = recording.times.iter().take_while(|time| **time < end).count();
    let moved = |body: usize| recording.displacement(&assembly.parts[body].name);
    let drift: Vec<f64> = moved(top)?
        .values
        .iter()
        .zip(&moved(foot)?.values)
        .take(standing)
        .map(|(top, foot)| top - foot)
        .collect();
    Some(Drift {
        height: assembly.model.bodies()[top].pose.position.z,
        largest: drift.iter().fold(0.0, |most, v| v.abs().max(most)),
        swings: swings(&recording.times[..standing], &drift),
    })
}
