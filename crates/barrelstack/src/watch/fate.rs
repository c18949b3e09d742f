//! The fate of every body: whether it kept its seat, when it left it, how far it fell.

use barrelstack_dynamics::{BodyId, Linear, Planar, Scratch, State, Vec2};

use crate::assemble::{Assembly, PartKind};
use crate::scenario::OutcomeSpec;

/// When a body counts as having left its seat, or fallen; all definitions are here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// A barrel has left its seat when its center is this many of its radii from its place in the rack.
    pub seat_loss_ratio: f64,
    /// A body has fallen when its center is this far (m) below its place at rest.
    pub fall_drop: f64,
    /// A rack has left its seat when it has moved this part of its reach on the barrels below.
    pub rack_slide_ratio: f64,
    /// A rack has left its seat by rocking when it is tilted this much (rad) against the rack below.
    pub rocking_angle: f64,
    /// The stack has overturned when its bottom rack is tilted this much (rad).
    pub overturning_angle: f64,
}

impl Thresholds {
    /// The thresholds of a scenario, its lengths scaled.
    pub fn of(spec: &OutcomeSpec, length_scale: f64) -> Self {
        Self {
            seat_loss_ratio: spec.seat_loss_ratio,
            fall_drop: spec.fall_drop * length_scale,
            rack_slide_ratio: spec.rack_slide_ratio,
            rocking_angle: spec.rocking_angle,
            overturning_angle: spec.overturning_angle,
        }
    }
}

/// How a rack left its seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// A barrel came too far from its place in the rack.
    Displaced,
    /// A rack moved too far along what it stands on.
    Slid,
    /// A rack tilted too far.
    Tilted,
    /// It went down before anything else was noticed.
    Dropped,
}

/// What became of one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fate {
    /// When (s) it left its seat, and how.
    pub left_seat: Option<(f64, Loss)>,
    /// When (s) it had fallen by the threshold.
    pub fell_at: Option<f64>,
    /// Largest drop (m) below its place at rest.
    pub drop: f64,
    /// Largest displacement (m) along `x` relative to the ground, before the collapse.
    pub peak_displacement: f64,
    /// Displacement (m) along `x` relative to the ground at the end.
    pub residual_displacement: f64,
    /// Displacement (m) along `x` relative to the ground at the moment of the collapse; at the end if
    /// there was none.
    pub displacement_at_collapse: f64,
    /// Largest displacement (m) relative to what the body stands on, before the collapse: a rack's
    /// walk, a barrel's way in its cradle.
    pub peak_slip: f64,
    /// Displacement (m) relative to what the body stands on, at the end.
    pub residual_slip: f64,
    /// Largest tilt (rad) of a rack, before the collapse.
    pub peak_tilt: f64,
    /// Largest rise (m) of a body above its place at rest, before the collapse.
    pub peak_uplift: f64,
}

/// Follows all bodies through a run; sees every step.
#[derive(Clone, Debug)]
pub struct Fates {
    thresholds: Thresholds,
    /// Positions at rest, relative to the ground.
    rest: Vec<Vec2>,
    bodies: Vec<Fate>,
    collapse: Option<(f64, BodyId)>,
    first_fall: Option<f64>,
}

impl Fates {
    /// Starts at rest.
    pub fn new(assembly: &Assembly, state: &State<Planar>, thresholds: Thresholds) -> Self {
        let ground = state.poses[Assembly::GROUND].position;
        Self {
            thresholds,
            rest: state.poses.iter().map(|pose| pose.position - ground).collect(),
            bodies: vec![Fate::default(); assembly.parts.len()],
            collapse: None,
            first_fall: None,
        }
    }

    /// Position at rest (m) of a body, relative to the ground.
    pub fn rest(&self, body: BodyId) -> Vec2 {
        self.rest[body]
    }

    /// The fate of a body.
    pub fn fate(&self, body: BodyId) -> &Fate {
        &self.bodies[body]
    }

    /// When (s) the first body left its seat.
    pub fn collapse_time(&self) -> Option<f64> {
        self.collapse.map(|(time, _)| time)
    }

    /// The first body that left its seat.
    pub fn first(&self) -> Option<BodyId> {
        self.collapse.map(|(_, body)| body)
    }

    /// When (s) the first barrel had fallen.
    pub fn first_fall(&self) -> Option<f64> {
        self.first_fall
    }

    /// Looks at an accepted state.
    pub(super) fn observe(
        &mut self,
        assembly: &Assembly,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
    ) {
        let ground = state.poses[Assembly::GROUND].position;
        let standing = self.collapse.is_none();
        for (i, part) in assembly.parts.iter().enumerate() {
            if part.kind == PartKind::Ground {
                continue;
            }
            let moved = state.poses[i].position - ground - self.rest[i];
            let slip = self.slip(assembly, state, scratch, i);
            let tilt = state.poses[i].orientation;
            let fate = &mut self.bodies[i];
            fate.drop = fate.drop.max(-moved.z);
            fate.residual_displacement = moved.x;
            fate.residual_slip = slip.x;
            if standing {
                fate.displacement_at_collapse = moved.x;
                fate.peak_displacement = fate.peak_displacement.max(moved.x.abs());
                fate.peak_slip = fate.peak_slip.max(slip.x.abs());
                fate.peak_uplift = fate.peak_uplift.max(moved.z);
                if part.kind == PartKind::Rack {
                    fate.peak_tilt = fate.peak_tilt.max(tilt.abs());
                }
            }
            if fate.fell_at.is_none() && -moved.z > self.thresholds.fall_drop {
                fate.fell_at = Some(state.time);
                if part.kind == PartKind::Barrel && self.first_fall.is_none() {
                    self.first_fall = Some(state.time);
                }
            }
            let fell = self.bodies[i].fell_at.is_some();
            if self.bodies[i].left_seat.is_none()
                && let Some(loss) = self.loss(assembly, state, i, slip, fell)
            {
                self.bodies[i].left_seat = Some((state.time, loss));
                if self.collapse.is_none() {
                    self.collapse = Some((state.time, i));
                }
            }
        }
    }

    /// Displacement (m) of a body relative to what it stands on: a barrel in the frame of its rack, a
    /// rack against the mean of the barrels below, the rest against the ground.
    fn slip(
        &self,
        assembly: &Assembly,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        body: BodyId,
    ) -> Vec2 {
        let part = &assembly.parts[body];
        let ground = state.poses[Assembly::GROUND].position;
        let here = state.poses[body].position;
        if let Some(rack) = part.carrier {
            let place = scratch.rotations[rack].unapply(here - state.poses[rack].position);
            return place - (self.rest[body] - self.rest[rack]);
        }
        if part.supports.is_empty() {
            return here - ground - self.rest[body];
        }
        let share = 1.0 / part.supports.len() as f64;
        let mut below = Vec2::default();
        let mut below_rest = Vec2::default();
        for support in &part.supports {
            below += state.poses[*support].position * share;
            below_rest += self.rest[*support] * share;
        }
        (here - below) - (self.rest[body] - below_rest)
    }

    /// Tilt (rad) of a rack against the rack it stands on, directly or by way of barrels; of the rest
    /// against the ground.
    fn tilt(assembly: &Assembly, state: &State<Planar>, body: BodyId) -> f64 {
        let below = assembly.parts[body].supports.first().copied();
        let rack = below.map(|support| assembly.parts[support].carrier.unwrap_or(support));
        state.poses[body].orientation - rack.map_or(0.0, |rack| state.poses[rack].orientation)
    }

    fn loss(
        &self,
        assembly: &Assembly,
        state: &State<Planar>,
        body: BodyId,
        slip: Vec2,
        fell: bool,
    ) -> Option<Loss> {
        let part = &assembly.parts[body];
        let limits = &self.thresholds;
        match part.kind {
            PartKind::Ground | PartKind::Body => None,
            PartKind::Barrel => {
                let seat = limits.seat_loss_ratio * part.size;
                let away = slip.dot(slip) > seat * seat;
                if away { Some(Loss::Displaced) } else { fell.then_some(Loss::Dropped) }
            }
            PartKind::Rack => {
                let tilt = Self::tilt(assembly, state, body).abs();
                let limit = if part.supports.is_empty() {
                    limits.overturning_angle
                } else {
                    limits.rocking_angle
                };
                let slid = !part.supports.is_empty()
                    && slip.x.abs() > limits.rack_slide_ratio * assembly.rack_reach;
                if slid {
                    Some(Loss::Slid)
                } else if tilt > limit {
                    Some(Loss::Tilted)
                } else {
                    fell.then_some(Loss::Dropped)
                }
            }
        }
    }
}
