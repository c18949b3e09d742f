//! A rocking block with penalty contact at its corners, and the damping with which the block reproduces a restitution
//! such as Housner's.

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{cos, sin, tan};
use barrelstack_dynamics::{Drive, NormalLaw, Planar, Still, Vec2};

use crate::oracle::{OVERTURNED, Ride, Rocker};
use crate::scene::{DOWN, Scene, block, coulomb, floor, interface, pose};
use crate::{Effort, Failure, GRAVITY, swing, theory};

/// Mass (kg) of the block; no result depends on it.
const MASS: f64 = 100.0;

/// The contact law of the corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Damping on approach only: the element of Candia et al. (2008).
    SpeedGap,
    /// Damping in both directions, without tension.
    KelvinVoigt,
}

/// A block that stands on two stiff corners and cannot slide.
#[derive(Clone, Copy, Debug)]
pub struct RockingBlock {
    /// Half-diagonal R (m).
    pub radius: f64,
    /// Slenderness angle α (rad).
    pub alpha: f64,
    /// Contact law of the corners.
    pub corner: Corner,
    /// ω = √(k/m) (rad/s): the stiffness of a corner, expressed as the natural frequency of the whole mass on it.
    pub contact_frequency: f64,
    /// ζ = c/(2√(km)): the damping of a corner, expressed as the damping ratio of the whole mass on it.
    pub damping_ratio: f64,
}

impl RockingBlock {
    /// Creates a block with stiff, critically damped corners and the contact law [`Corner::SpeedGap`].
    pub fn new(radius: f64, alpha: f64) -> Self {
        Self {
            radius,
            alpha,
            corner: Corner::SpeedGap,
            contact_frequency: 3000.0,
            damping_ratio: 1.0,
        }
    }

    /// Returns the block after a number of refinements, each of which makes the corners four times as stiff.
    #[must_use]
    pub fn refined(mut self, refinements: i32) -> Self {
        self.contact_frequency *= 2.0_f64.powi(refinements);
        self
    }

    /// Returns the frequency parameter p = √(3g/4R) (rad/s).
    pub fn rate(&self) -> f64 {
        theory::rocking_rate(self.radius)
    }

    /// Returns the rigid block of the same size, with a given restitution.
    pub fn rigid(&self, restitution: f64) -> Rocker {
        Rocker { alpha: self.alpha, rate: self.rate(), restitution, slender: false }
    }

    /// Returns the time step (s): well below the stability limit of the damped corner.
    pub fn step(&self) -> f64 {
        // Along the base a corner has the mobility 1/m + (R cos α)²/I, about 4/m. The tangential damping stays at
        // ζ = 1 or less, so the normal direction limits the step only above this ratio.
        let zeta = 2.0 * self.damping_ratio.max(0.5);
        let limit = (1.0 + zeta * zeta).sqrt() - zeta;
        0.4 * limit / self.contact_frequency
    }

    fn stiffness(&self) -> f64 {
        MASS * self.contact_frequency * self.contact_frequency
    }

    /// Creates the block at a rotation (rad, clockwise positive); the corners that carry the block are at their static
    /// penetration.
    ///
    /// # Errors
    /// If the dimensions do not make a valid body.
    pub fn scene(&self, lean: f64) -> Result<Scene, Failure> {
        let stiffness = self.stiffness();
        let (half_width, half_height) =
            (self.radius * sin(self.alpha), self.radius * cos(self.alpha));
        let damping = restitution::damping(stiffness, self.damping_ratio, MASS);
        let tangential = restitution::damping(stiffness, self.damping_ratio.min(1.0), MASS);
        let corners = if lean > 0.0 { 1.0 } else { 2.0 };
        let sunk = MASS * GRAVITY / (corners * stiffness);
        let (x, z) = if lean > 0.0 {
            let direction = self.alpha - lean;
            (half_width - self.radius * sin(direction), self.radius * cos(direction))
        } else {
            (0.0, half_height)
        };
        let mut body =
            block("block", (2.0 * half_width, 2.0 * half_height), MASS, pose(x, z - sunk, -lean));
        let nodes = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, z)| Vec2::new(x * half_width, z * half_height));
        body.nodes = vec![crate::scene::points(&nodes)];
        let normal = match self.corner {
            Corner::SpeedGap => NormalLaw::SpeedGap { stiffness, damping },
            Corner::KelvinVoigt => NormalLaw::KelvinVoigt { stiffness, damping },
        };
        // The block of rigid-block theory never slides.
        let laws = interface(normal, coulomb(20.0, stiffness, tangential));
        Ok(Scene::new(vec![floor(), body], laws, DOWN)?)
    }

    /// Returns `p` multiplied by the time that the block takes from a rotation of `share · α` to the upright position.
    ///
    /// # Errors
    /// If the run fails numerically, or if the block does not pass through the upright position.
    pub fn quarter_period(&self, share: f64) -> Result<f64, Failure> {
        match self.swings(share, 1, 20.0)?.first() {
            Some((end, _)) => Ok(end * self.rate()),
            None => Err(Failure::Absent("the block does not come down".into())),
        }
    }

    /// Releases the block at a rotation of `share · α` and follows its impacts.
    ///
    /// Returns, for each impact, the time (s) at which the block is upright and the next peak rotation divided by α.
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn swings(
        &self,
        share: f64,
        impacts: usize,
        patience: f64,
    ) -> Result<Vec<(f64, f64)>, Failure> {
        let mut scene = self.scene(share * self.alpha)?;
        let (mut before, mut peak) = ((0.0, share * self.alpha), 0.0_f64);
        let mut swings: Vec<(f64, f64)> = vec![];
        // During an impact the corners bounce and rotate the block, by less than this angle.
        let slack = 1e-3 * self.alpha;
        let mut side = 1.0;
        let mut crossing = f64::NAN;
        scene.watch(&Still, self.step(), patience, |state, _, _| {
            let lean = -state.poses[1].orientation;
            if before.1 * lean < 0.0 {
                crossing = swing::crossing(before, (state.time, lean));
            }
            if side * lean < -slack {
                // The block has clearly passed to the other side, so the last crossing was the impact.
                if let Some(last) = swings.last_mut() {
                    last.1 = peak / self.alpha;
                }
                if swings.len() == impacts {
                    return ControlFlow::Break(());
                }
                swings.push((crossing, f64::NAN));
                side = -side;
                peak = 0.0;
            }
            peak = peak.max(side * lean);
            before = (state.time, lean);
            ControlFlow::Continue(())
        })?;
        if let Some(last) = swings.last_mut()
            && last.1.is_nan()
        {
            last.1 = peak / self.alpha;
        }
        Ok(swings)
    }

    /// Releases the block at a rotation of `share · α`, and returns the ratio of its angular velocities after and
    /// before the first impact.
    ///
    /// The ratio is the square root of the fraction of the energy that remains after the impact, computed from the next
    /// peak rotation.
    ///
    /// # Errors
    /// If the run fails numerically, or if the block does not pass through the upright position.
    pub fn restitution(&self, share: f64) -> Result<f64, Failure> {
        let height = |share: f64| {
            let theta = share * self.alpha;
            2.0 * sin(self.alpha - 0.5 * theta) * sin(0.5 * theta)
        };
        let patience = 6.0 / self.rate();
        match self.swings(share, 1, patience)?.first() {
            Some((_, peak)) => Ok((height(*peak) / height(share)).sqrt()),
            None => Err(Failure::Absent("the block does not come down".into())),
        }
    }

    /// Returns the block with the damping ratio that gives a target [`restitution`](Self::restitution) after a release
    /// at a rotation of `½ α`; `None` if no damping ratio between 0.02 and 12 gives this restitution.
    ///
    /// # Errors
    /// If a run fails numerically, or if the block does not pass through the upright position.
    pub fn calibrated(mut self, target: f64) -> Result<Option<Self>, Failure> {
        let (mut low, mut high) = (0.02, 12.0);
        let mut shows = |zeta: f64| {
            self.damping_ratio = zeta;
            self.restitution(0.5)
        };
        if shows(low)? < target || shows(high)? > target {
            return Ok(None);
        }
        for _ in 0..14 {
            let middle = (low * high).sqrt();
            if shows(middle)? > target { low = middle } else { high = middle }
        }
        self.damping_ratio = (low * high).sqrt();
        Ok(Some(self))
    }

    /// Returns `true` if a ground motion overturns the block.
    ///
    /// `acceleration_end` (s) is the end of the ground acceleration.
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn overturns(
        &self,
        drive: &impl Drive<Planar>,
        acceleration_end: f64,
    ) -> Result<bool, Failure> {
        self.ride(drive, acceleration_end, 15.0).map(|ride| ride.overturned)
    }

    /// Returns `true` if a ground motion overturns the block before it comes back upright.
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn overturns_at_once(
        &self,
        drive: &impl Drive<Planar>,
        acceleration_end: f64,
    ) -> Result<bool, Failure> {
        let mut scene = self.scene(0.0)?;
        let (mut fell, mut side) = (false, 0.0);
        // Rotations below this angle are vibrations of the corners before uplift.
        let slack = 0.01 * self.alpha;
        scene.watch(drive, self.step(), acceleration_end + 15.0, |state, _, _| {
            let lean = state.poses[1].orientation;
            if side == 0.0 && lean.abs() > slack {
                side = lean.signum();
            }
            fell = lean.abs() > OVERTURNED;
            let back = side * lean < 0.0;
            if fell || back { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(fell)
    }

    /// Simulates the block on moving ground; returns `true` if the block overturns, and its largest rotation.
    ///
    /// `acceleration_end` (s) is the end of the ground acceleration. The run ends when the block has overturned or can
    /// no longer overturn, and at the latest `patience` (s) after the end of the acceleration.
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn ride(
        &self,
        drive: &impl Drive<Planar>,
        acceleration_end: f64,
        patience: f64,
    ) -> Result<Ride, Failure> {
        let mut scene = self.scene(0.0)?;
        let rate = self.rate();
        let (mut fell, mut peak, mut last) = (false, 0.0_f64, 0.0_f64);
        let until = acceleration_end + patience;
        scene.watch(drive, self.step(), until, |state, _, _| {
            let (lean, spin) = (state.poses[1].orientation, state.twists[1].angular);
            last = lean.abs();
            peak = peak.max(last);
            fell = last > OVERTURNED;
            let left = self.alpha - last;
            // From here on the block only loses energy. During an impact the springs store part of it, so only a
            // block that clearly swings back, or rests, is judged.
            let back = spin * lean < 0.0 && last > 0.01 * self.alpha;
            let rests = last < 1e-5 && spin.abs() < 1e-4;
            let safe = state.time > acceleration_end
                && left > 0.0
                && 0.5 * spin * spin < rate * rate * (1.0 - cos(left))
                && (back || rests);
            if fell || safe { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        Ok(Ride { overturned: fell || last > self.alpha, peak })
    }

    /// Returns the ground acceleration (m/s²) that lifts a corner.
    pub fn uplift(&self) -> f64 {
        GRAVITY * tan(self.alpha)
    }
}

/// Returns the contact frequency (rad/s) for an effort.
pub fn contact_frequency(effort: Effort) -> f64 {
    match effort {
        Effort::Fast => 1500.0,
        Effort::Full => 3000.0,
    }
}
