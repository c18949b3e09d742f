//! Outcome of every body in three dimensions: loss of a seat and its direction, fall, slip, and tilt.

use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::watch::{Loss, Thresholds};
use barrelstack_dynamics::space::Wrench;
use barrelstack_dynamics::{BodyId, Linear as _, Pose, Rotation3, Spatial, State, Vec3, math};
use serde::Serialize;

use crate::stack::Stack;

/// Horizontal direction of a motion, for a viewer in front of the heads of the barrels: `x` points to the right
/// and `y` away from the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Heading {
    /// Across the barrels, toward positive `x`.
    Right,
    /// Across the barrels, toward negative `x`.
    Left,
    /// Along the barrels, toward positive `y`.
    Away,
    /// Along the barrels, toward negative `y`.
    Near,
}

impl Heading {
    /// All directions.
    pub const ALL: [Self; 4] = [Self::Right, Self::Left, Self::Away, Self::Near];

    /// Returns the direction of the largest component of a displacement.
    pub fn of(displacement: Vec3) -> Self {
        match (
            displacement.x.abs() >= displacement.y.abs(),
            displacement.x >= 0.0,
            displacement.y >= 0.0,
        ) {
            (true, true, _) => Self::Right,
            (true, false, _) => Self::Left,
            (false, _, true) => Self::Away,
            (false, _, false) => Self::Near,
        }
    }

    /// Returns `true` for a direction across the barrels, and `false` for a direction along the barrels.
    pub fn is_across(self) -> bool {
        matches!(self, Self::Right | Self::Left)
    }

    /// Returns the name of the direction in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
            Self::Away => "away",
            Self::Near => "near",
        }
    }
}

/// Outcome of one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fate {
    /// Position at rest (m), relative to the ground.
    pub rest: Vec3,
    /// Time (s), kind and direction of the loss of a seat; `None` if the body has not lost its seat.
    pub left_seat: Option<(f64, Loss, Heading)>,
    /// Time (s) at which the drop of the body exceeded the threshold that counts as a fall; `None` if the body has not
    /// fallen.
    pub fell_at: Option<f64>,
    /// Largest drop (m) below the position at rest, over the whole run.
    pub drop: f64,
    /// Largest force (N) on the body, without gravity, from the time at which it counts as fallen, including
    /// its impact.
    pub fall_force: f64,
    /// Displacement (m) from the position at rest, relative to the ground, in the last observed state.
    pub moved: Vec3,
    /// Displacement (m) from the position at rest, relative to the ground, at the time of the collapse; in the last
    /// observed state if there is no collapse.
    pub moved_at_collapse: Vec3,
    /// Mean slip (m) across and along the barrels at the end of the run: the displacement relative to each support,
    /// averaged over the supports.
    pub residual_slip: [f64; 2],
    /// Largest magnitude (m) of the mean slip across and along the barrels before the collapse; over the whole run if
    /// there is no collapse. The two maxima may occur at different times.
    pub peak_slip: [f64; 2],
    /// Largest rise (m) above the position at rest before the collapse; over the whole run if there is no collapse.
    pub peak_uplift: f64,
    /// Largest displacement, slip and tilt before the collapse; over the whole run if there is no collapse.
    pub until_loss: PeakMotion,
    /// Largest displacement, slip and tilt over the whole run, falls included.
    pub whole_run: PeakMotion,
}

/// Largest displacement, slip and tilt of a body over a span of time. Displacements are horizontal, in any direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakMotion {
    /// Largest displacement (m) relative to the ground.
    pub displacement: f64,
    /// Largest magnitude (m) of the mean slip. The mean slip is the displacement relative to each support, averaged
    /// over the supports.
    pub slip: f64,
    /// Largest tilt (rad) of a rack from its orientation at rest.
    pub tilt: f64,
}

impl PeakMotion {
    /// Returns the larger displacement, the larger slip and the larger tilt of `self` and `other`.
    #[must_use]
    pub fn or_larger(mut self, other: Self) -> Self {
        self.raise(other.displacement, other.slip, other.tilt);
        self
    }

    fn raise(&mut self, displacement: f64, slip: f64, tilt: f64) {
        self.displacement = self.displacement.max(displacement);
        self.slip = self.slip.max(slip);
        self.tilt = self.tilt.max(tilt);
    }
}

/// Recorder of the outcomes of all bodies during a run. It must observe every accepted step.
#[derive(Clone, Debug)]
pub struct Fates {
    stack: Arc<Stack>,
    thresholds: Thresholds,
    /// For every body, its rotation when the stack is at rest.
    upright: Vec<Rotation3>,
    /// For every body, the direction in the body frame that points up at rest.
    upward: Vec<Vec3>,
    /// For every body, its rotation in the current state.
    turned: Vec<Rotation3>,
    /// For every rack, the least cosine of its tilt so far.
    least_upright: Vec<f64>,
    all: Vec<Fate>,
    /// Time (s) of the first loss of a seat, and the body that lost its seat; `None` if no body has lost its seat.
    collapse: Option<(f64, BodyId)>,
    /// Time (s) at which the first barrel counted as fallen; `None` if no barrel has fallen.
    first_fall: Option<f64>,
}

impl Fates {
    /// Creates the recorder for a stack at rest.
    pub fn new(stack: Arc<Stack>, state: &State<Spatial>, thresholds: Thresholds) -> Self {
        let ground = state.poses[Stack::GROUND].position;
        let fate = |pose: &Pose<Spatial>| Fate { rest: pose.position - ground, ..Fate::default() };
        let upright: Vec<_> = state.poses.iter().map(|pose| pose.orientation.matrix()).collect();
        Self {
            stack,
            thresholds,
            upward: upright.iter().map(|turned| turned.unapply(UP)).collect(),
            turned: upright.clone(),
            least_upright: vec![1.0; upright.len()],
            upright,
            all: state.poses.iter().map(fate).collect(),
            collapse: None,
            first_fall: None,
        }
    }

    /// Returns the outcomes of all bodies so far, in the order of the parts.
    pub fn all(&self) -> &[Fate] {
        &self.all
    }

    /// Returns the time (s) of the first loss of a seat, and the body that lost its seat; `None` if no body has lost
    /// its seat.
    pub fn collapse(&self) -> Option<(f64, BodyId)> {
        self.collapse
    }

    /// Returns the time (s) at which the first barrel counted as fallen; `None` if no barrel has fallen.
    pub fn first_fall(&self) -> Option<f64> {
        self.first_fall
    }

    /// Returns the outcomes of all bodies at the end of a run, in the order of the parts.
    pub fn at_end(mut self, poses: &[Pose<Spatial>]) -> Vec<Fate> {
        self.turn(poses);
        let mut slips = Vec::new();
        for i in 1..self.all.len() {
            self.slips(poses, i, &mut slips);
            let Vec3 { x, y, .. } = mean(&slips);
            self.all[i].residual_slip = [x, y];
        }
        self.all
    }

    /// Sets the current rotations of all bodies from their poses.
    fn turn(&mut self, poses: &[Pose<Spatial>]) {
        for (turned, pose) in self.turned.iter_mut().zip(poses) {
            *turned = pose.orientation.matrix();
        }
    }

    /// Records the poses of all bodies and the forces on them at a time (s).
    pub fn observe_bodies(
        &mut self,
        time: f64,
        poses: &[Pose<Spatial>],
        wrenches: &[Wrench<Spatial>],
    ) {
        let ground = poses[Stack::GROUND].position;
        let standing = self.collapse.is_none();
        self.turn(poses);
        let mut slips = Vec::with_capacity(4);
        for i in 1..self.all.len() {
            let kind = self.stack.parts[i].kind;
            let moved = poses[i].position - ground - self.all[i].rest;
            let fate = &mut self.all[i];
            fate.moved = moved;
            fate.drop = fate.drop.max(-moved.z);
            if fate.fell_at.is_none() && -moved.z > self.thresholds.fall_drop {
                fate.fell_at = Some(time);
                if kind == PartKind::Barrel && self.first_fall.is_none() {
                    self.first_fall = Some(time);
                }
            }
            if fate.fell_at.is_some() {
                fate.fall_force = fate.fall_force.max(wrenches[i].force.length());
            }
            if standing {
                fate.moved_at_collapse = moved;
            }
            self.slips(poses, i, &mut slips);
            let mean = mean(&slips);
            // A barrel may roll about its axis without limit. Angles smaller than the largest so far are not needed.
            let upright = if kind == PartKind::Rack { self.up(i).z } else { 1.0 };
            let tilt = if upright < self.least_upright[i] {
                self.least_upright[i] = upright;
                math::acos(upright.max(-1.0))
            } else {
                0.0
            };
            let (displacement, slip) = (level(moved).length(), level(mean).length());
            let fate = &mut self.all[i];
            fate.whole_run.raise(displacement, slip, tilt);
            if standing {
                fate.until_loss.raise(displacement, slip, tilt);
                fate.peak_uplift = fate.peak_uplift.max(moved.z);
                fate.peak_slip[0] = fate.peak_slip[0].max(mean.x.abs());
                fate.peak_slip[1] = fate.peak_slip[1].max(mean.y.abs());
            }
            if self.all[i].left_seat.is_none()
                && let Some((loss, heading)) = self.lost(i, &slips)
            {
                self.all[i].left_seat = Some((time, loss, heading));
                self.collapse.get_or_insert((time, i));
            }
        }
    }

    /// Returns the kind and the direction of the loss of a seat; `None` if the body is on its seat in the current
    /// state.
    fn lost(&self, i: BodyId, slips: &[Vec3]) -> Option<(Loss, Heading)> {
        let part = &self.stack.parts[i];
        let fate = &self.all[i];
        let slip = mean(slips);
        // Devices have no seat to lose.
        if part.kind == PartKind::Device {
            return None;
        }
        if part.kind == PartKind::Barrel {
            let most = self.thresholds.seat_loss_ratio * part.size;
            if slip.dot(slip) > most * most {
                // The direction is relative to the ground, since the rack may be tilted.
                let displacement =
                    part.carrier.map_or(fate.moved, |rack| fate.moved - self.all[rack].moved);
                return Some((Loss::Displaced, Heading::of(displacement)));
            }
        } else {
            let [across, along] = self.stack.reach.map(|m| m * self.thresholds.rack_slide_ratio);
            let off = |slip: &&Vec3| slip.y.abs() > along;
            if !part.supports.is_empty() {
                // A rack that turns about the vertical walks off one of its barrels first.
                if let Some(slip) = slips.iter().find(off) {
                    return Some((Loss::Slid, Heading::of(Vec3::new(0.0, slip.y, 0.0))));
                }
                if slip.x.abs() > across {
                    return Some((Loss::Slid, Heading::of(Vec3::new(slip.x, 0.0, 0.0))));
                }
            }
            let below = part.supports.first().and_then(|on| self.stack.parts[*on].carrier);
            let most = match below {
                Some(_) => self.thresholds.rocking_angle,
                None => self.thresholds.overturning_angle,
            };
            let own = self.up(i);
            let under = below.map_or(UP, |rack| self.up(rack));
            let between = math::acos(own.dot(under).clamp(-1.0, 1.0));
            if between > most {
                return Some((Loss::Tilted, Heading::of(own - under)));
            }
        }
        fate.fell_at.map(|_| (Loss::Dropped, Heading::of(fate.moved)))
    }

    /// Returns the current direction of the body axis that points up at rest.
    fn up(&self, i: BodyId) -> Vec3 {
        self.turned[i].apply(self.upward[i])
    }

    /// Computes the displacements (m) of a body relative to its supports, and stores them in `slips`.
    ///
    /// A body with a carrier, such as a barrel on a rack, has one displacement, in the frame of the carrier. A rack on
    /// barrels has one displacement for each barrel below, in the frame of the rack. These frames rotate with their
    /// bodies; at rest, their axes are the axes of the stack. Any other body has one displacement, relative to the
    /// ground.
    fn slips(&self, poses: &[Pose<Spatial>], i: BodyId, slips: &mut Vec<Vec3>) {
        slips.clear();
        let part = &self.stack.parts[i];
        let seen_from = |frame: BodyId, body: BodyId| {
            let arm = poses[body].position - poses[frame].position;
            let place = self.upright[frame].apply(self.turned[frame].unapply(arm));
            place - (self.all[body].rest - self.all[frame].rest)
        };
        if let Some(rack) = part.carrier {
            slips.push(seen_from(rack, i));
        } else if part.supports.is_empty() {
            let ground = poses[Stack::GROUND].position;
            slips.push(poses[i].position - ground - self.all[i].rest);
        } else {
            slips.extend(part.supports.iter().map(|barrel| -seen_from(i, *barrel)));
        }
    }
}

const UP: Vec3 = Vec3::new(0.0, 0.0, 1.0);

fn mean(slips: &[Vec3]) -> Vec3 {
    slips.iter().fold(Vec3::default(), |sum, slip| sum + *slip) * (1.0 / slips.len() as f64)
}

/// Returns the horizontal part of a vector.
fn level(vector: Vec3) -> Vec3 {
    Vec3::new(vector.x, vector.y, 0.0)
}
