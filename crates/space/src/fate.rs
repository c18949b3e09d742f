//! The fate of every body in space: whether it kept its seat, when and in which direction it left it, how far it fell.

use barrelstack::assemble::PartKind;
use barrelstack::watch::{Loss, Thresholds};
use barrelstack_dynamics::{BodyId, Linear as _, Rotation3, Scratch, Spatial, State, Vec3, math};
use serde::Serialize;

use crate::stack::Stack;

/// Where something went, as seen from above by one who stands before the heads of the barrels, with `x` to the right
/// and `y` into the depth.
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
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Right, Self::Left, Self::Away, Self::Near];

    /// Of a way: the direction of which it has most.
    pub fn of(way: Vec3) -> Self {
        match (way.x.abs() >= way.y.abs(), way.x >= 0.0, way.y >= 0.0) {
            (true, true, _) => Self::Right,
            (true, false, _) => Self::Left,
            (false, _, true) => Self::Away,
            (false, _, false) => Self::Near,
        }
    }

    /// Whether it is across the barrels, not along them.
    pub fn is_across(self) -> bool {
        matches!(self, Self::Right | Self::Left)
    }

    /// The word used in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
            Self::Away => "away",
            Self::Near => "near",
        }
    }
}

/// What became of one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fate {
    /// Position at rest (m), relative to the ground.
    pub rest: Vec3,
    /// When (s) it left its seat, how, and in which direction.
    pub left_seat: Option<(f64, Loss, Heading)>,
    /// When (s) it had fallen by the threshold.
    pub fell_at: Option<f64>,
    /// Largest drop (m) below its place at rest.
    pub drop: f64,
    /// Largest force (N) on it since it had fallen.
    pub fall_force: f64,
    /// Where it is (m), relative to the ground and its place at rest.
    pub moved: Vec3,
    /// The same at the moment of the collapse; at the end if there was none.
    pub moved_at_collapse: Vec3,
    /// Displacement (m) across and along relative to what it stands on, in the mean of all of that, at the end.
    pub residual_slip: [f64; 2],
    /// Largest displacement (m) across and along relative to what it stands on, in the mean of all of that, before
    /// the collapse; of different instants.
    pub peak_slip: [f64; 2],
    /// Largest rise (m) above its place at rest, before the collapse.
    pub peak_uplift: f64,
    /// Largest motions before the collapse.
    pub until_loss: PeakMotion,
    /// Largest motions over the whole run, falls included.
    pub whole_run: PeakMotion,
}

/// The largest motions of a body in any step; displacements are horizontal, whatever their direction, and each is that of
/// one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakMotion {
    /// Largest displacement (m) relative to the ground.
    pub displacement: f64,
    /// Largest displacement (m) relative to what the body stands on, in the mean of all of that.
    pub slip: f64,
    /// Largest tilt (rad) of a rack from where it stood.
    pub tilt: f64,
}

impl PeakMotion {
    fn raise(&mut self, displacement: f64, slip: f64, tilt: f64) {
        self.displacement = self.displacement.max(displacement);
        self.slip = self.slip.max(slip);
        self.tilt = self.tilt.max(tilt);
    }
}

/// Follows all bodies through a run; sees every step.
#[derive(Clone, Debug)]
pub struct Fates<'a> {
    stack: &'a Stack,
    thresholds: Thresholds,
    /// How every body was turned at rest.
    upright: Vec<Rotation3>,
    /// What was up in every body at rest, in its own frame.
    upward: Vec<Vec3>,
    /// How every body is turned in the state that is looked at.
    turned: Vec<Rotation3>,
    all: Vec<Fate>,
    /// When (s) the first body left its seat, and which.
    collapse: Option<(f64, BodyId)>,
    /// When (s) the first barrel had fallen.
    first_fall: Option<f64>,
}

impl<'a> Fates<'a> {
    /// Starts at rest.
    pub fn new(stack: &'a Stack, state: &State<Spatial>, thresholds: Thresholds) -> Self {
        let ground = state.poses[Stack::GROUND].position;
        let fate = |pose: &barrelstack_dynamics::Pose<Spatial>| Fate {
            rest: pose.position - ground,
            ..Fate::default()
        };
        let upright: Vec<_> = state.poses.iter().map(|pose| pose.orientation.matrix()).collect();
        Self {
            stack,
            thresholds,
            upward: upright.iter().map(|turned| turned.unapply(UP)).collect(),
            turned: upright.clone(),
            upright,
            all: state.poses.iter().map(fate).collect(),
            collapse: None,
            first_fall: None,
        }
    }

    /// The fates of all bodies, in the order of the parts.
    pub fn all(&self) -> &[Fate] {
        &self.all
    }

    /// When (s) the first body left its seat, and which.
    pub fn collapse(&self) -> Option<(f64, BodyId)> {
        self.collapse
    }

    /// When (s) the first barrel had fallen.
    pub fn first_fall(&self) -> Option<f64> {
        self.first_fall
    }

    /// The fates of all bodies at the end of a run, in the order of the parts.
    pub fn at_end(mut self, state: &State<Spatial>) -> Vec<Fate> {
        self.turn(state);
        let mut slips = Vec::new();
        for i in 1..self.all.len() {
            self.slips(state, i, &mut slips);
            let Vec3 { x, y, .. } = mean(&slips);
            self.all[i].residual_slip = [x, y];
        }
        self.all
    }

    /// Looks at how the bodies are turned.
    fn turn(&mut self, state: &State<Spatial>) {
        for (turned, pose) in self.turned.iter_mut().zip(&state.poses) {
            *turned = pose.orientation.matrix();
        }
    }

    /// Looks at an accepted state.
    pub fn observe(&mut self, state: &State<Spatial>, scratch: &Scratch<Spatial>) {
        let ground = state.poses[Stack::GROUND].position;
        let standing = self.collapse.is_none();
        self.turn(state);
        let mut slips = Vec::with_capacity(4);
        for i in 1..self.all.len() {
            let kind = self.stack.parts[i].kind;
            let moved = state.poses[i].position - ground - self.all[i].rest;
            let fate = &mut self.all[i];
            fate.moved = moved;
            fate.drop = fate.drop.max(-moved.z);
            if fate.fell_at.is_none() && -moved.z > self.thresholds.fall_drop {
                fate.fell_at = Some(state.time);
                if kind == PartKind::Barrel && self.first_fall.is_none() {
                    self.first_fall = Some(state.time);
                }
            }
            if fate.fell_at.is_some() {
                fate.fall_force = fate.fall_force.max(scratch.wrenches[i].force.length());
            }
            if standing {
                fate.moved_at_collapse = moved;
            }
            self.slips(state, i, &mut slips);
            let mean = mean(&slips);
            // A barrel turns about its axis without end.
            let up = if kind == PartKind::Rack { self.up(i).z } else { 1.0 };
            let tilt = if up < 1.0 { math::acos(up.max(-1.0)) } else { 0.0 };
            let (way, slip) = (level(moved).length(), level(mean).length());
            let fate = &mut self.all[i];
            fate.whole_run.raise(way, slip, tilt);
            if standing {
                fate.until_loss.raise(way, slip, tilt);
                fate.peak_uplift = fate.peak_uplift.max(moved.z);
                fate.peak_slip[0] = fate.peak_slip[0].max(mean.x.abs());
                fate.peak_slip[1] = fate.peak_slip[1].max(mean.y.abs());
            }
            if self.all[i].left_seat.is_none()
                && let Some((loss, heading)) = self.lost(i, &slips)
            {
                self.all[i].left_seat = Some((state.time, loss, heading));
                self.collapse.get_or_insert((state.time, i));
            }
        }
    }

    /// Whether a body has left its seat now, how, and whereto.
    fn lost(&self, i: BodyId, slips: &[Vec3]) -> Option<(Loss, Heading)> {
        let part = &self.stack.parts[i];
        let fate = &self.all[i];
        let slip = mean(slips);
        // What protects a stack has no seat to lose.
        if part.kind == PartKind::Device {
            return None;
        }
        if part.kind == PartKind::Barrel {
            let most = self.thresholds.seat_loss_ratio * part.size;
            if slip.dot(slip) > most * most {
                // Over the ground, not in the frame of a rack that may be tilted.
                let way = part.carrier.map_or(fate.moved, |rack| fate.moved - self.all[rack].moved);
                return Some((Loss::Displaced, Heading::of(way)));
            }
        } else {
            let [across, along] = self.stack.reach.map(|m| m * self.thresholds.rack_slide_ratio);
            let off = |slip: &&Vec3| slip.y.abs() > along;
            if !part.supports.is_empty() {
                // A rack that twists walks off one of its barrels first.
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

    /// What was up in a body at rest.
    fn up(&self, i: BodyId) -> Vec3 {
        self.turned[i].apply(self.upward[i])
    }

    /// Displacements (m) of a body relative to what it stands on: of a barrel in the frame of its rack, of a rack on
    /// each of the barrels below in its own frame, of others against the ground; as at rest turned.
    fn slips(&self, state: &State<Spatial>, i: BodyId, slips: &mut Vec<Vec3>) {
        slips.clear();
        let part = &self.stack.parts[i];
        let seen_from = |frame: BodyId, body: BodyId| {
            let arm = state.poses[body].position - state.poses[frame].position;
            let place = self.upright[frame].apply(self.turned[frame].unapply(arm));
            place - (self.all[body].rest - self.all[frame].rest)
        };
        if let Some(rack) = part.carrier {
            slips.push(seen_from(rack, i));
        } else if part.supports.is_empty() {
            let ground = state.poses[Stack::GROUND].position;
            slips.push(state.poses[i].position - ground - self.all[i].rest);
        } else {
            slips.extend(part.supports.iter().map(|barrel| -seen_from(i, *barrel)));
        }
    }
}

const UP: Vec3 = Vec3::new(0.0, 0.0, 1.0);

fn mean(slips: &[Vec3]) -> Vec3 {
    slips.iter().fold(Vec3::default(), |sum, slip| sum + *slip) * (1.0 / slips.len() as f64)
}

/// The horizontal part.
fn level(way: Vec3) -> Vec3 {
    Vec3::new(way.x, way.y, 0.0)
}
