//! The fate of every body: whether it kept its seat, when it left it, how far it fell.

use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Linear, Planar, Scratch, State, Vec2};

use crate::assemble::{Assembly, Part, PartKind};
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
    /// When (s) it landed: the first time after it had fallen that it went down less than half as fast as
    /// it had on the way.
    pub landed_at: Option<f64>,
    /// Its largest speed downward (m/s) from when it had fallen until it landed.
    pub landing_speed: Option<f64>,
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

/// Follows all bodies through a run, or through as many runs as there are lanes; sees every step.
#[derive(Clone, Debug)]
pub struct Fates<R: Real = f64> {
    /// Drop (m) at which a body has fallen.
    fall_drop: R,
    bodies: Vec<Followed<R>>,
    /// When (s) the first body left its seat; infinite while none has.
    collapse: R,
    /// Which body that was, lane by lane.
    first: Vec<Option<BodyId>>,
    /// When (s) the first barrel had fallen; infinite while none has.
    first_fall: R,
}

/// A body, its limits, and what became of it until now.
#[derive(Clone, Debug)]
struct Followed<R: Real> {
    kind: PartKind,
    carrier: Option<BodyId>,
    supports: Vec<BodyId>,
    /// The rack below, against which a rack's tilt is measured.
    below: Option<BodyId>,
    /// Position at rest (m), relative to the ground.
    rest: Vec2<R>,
    /// How far (m) it may go on what it stands on.
    most_slip: R,
    /// How far (rad) a rack may tilt.
    most_tilt: R,
    /// When (s) it left its seat; infinite while it has not.
    left_seat: R,
    /// How, lane by lane.
    loss: Vec<Loss>,
    /// When (s) it had fallen; infinite while it has not.
    fell_at: R,
    /// When (s) it landed; infinite while it has not.
    landed_at: R,
    /// Largest speed downward (m/s) between the two.
    landing_speed: R,
    drop: R,
    peak_displacement: R,
    residual_displacement: R,
    displacement_at_collapse: R,
    peak_slip: R,
    residual_slip: R,
    peak_tilt: R,
    peak_uplift: R,
}

impl Fates {
    /// Starts at rest.
    pub fn new(assembly: &Assembly, state: &State<Planar>, thresholds: Thresholds) -> Self {
        let ground = state.poses[Assembly::GROUND].position;
        let follow = |(i, part): (usize, &Part)| {
            let below = part.supports.first().copied();
            let foot = part.supports.is_empty();
            let most_slip = match part.kind {
                PartKind::Barrel => thresholds.seat_loss_ratio * part.size,
                PartKind::Rack if !foot => thresholds.rack_slide_ratio * assembly.rack_reach,
                PartKind::Rack | PartKind::Ground | PartKind::Body => f64::INFINITY,
            };
            let most_tilt =
                if foot { thresholds.overturning_angle } else { thresholds.rocking_angle };
            Followed {
                kind: part.kind,
                carrier: part.carrier,
                supports: part.supports.clone(),
                below: below.map(|body| assembly.parts[body].carrier.unwrap_or(body)),
                rest: state.poses[i].position - ground,
                most_slip,
                most_tilt,
                left_seat: f64::INFINITY,
                loss: vec![Loss::Dropped],
                fell_at: f64::INFINITY,
                landed_at: f64::INFINITY,
                landing_speed: 0.0,
                drop: 0.0,
                peak_displacement: 0.0,
                residual_displacement: 0.0,
                displacement_at_collapse: 0.0,
                peak_slip: 0.0,
                residual_slip: 0.0,
                peak_tilt: 0.0,
                peak_uplift: 0.0,
            }
        };
        Self {
            fall_drop: thresholds.fall_drop,
            bodies: assembly.parts.iter().enumerate().map(follow).collect(),
            collapse: f64::INFINITY,
            first: vec![None],
            first_fall: f64::INFINITY,
        }
    }

    /// Position at rest (m) of a body, relative to the ground.
    pub fn rest(&self, body: BodyId) -> Vec2 {
        self.bodies[body].rest
    }

    /// The fate of a body.
    pub fn fate(&self, body: BodyId) -> Fate {
        let followed = &self.bodies[body];
        Fate {
            left_seat: known(followed.left_seat).map(|time| (time, followed.loss[0])),
            fell_at: known(followed.fell_at),
            landed_at: known(followed.landed_at),
            landing_speed: known(followed.landed_at).map(|_| followed.landing_speed),
            drop: followed.drop,
            peak_displacement: followed.peak_displacement,
            residual_displacement: followed.residual_displacement,
            displacement_at_collapse: followed.displacement_at_collapse,
            peak_slip: followed.peak_slip,
            residual_slip: followed.residual_slip,
            peak_tilt: followed.peak_tilt,
            peak_uplift: followed.peak_uplift,
        }
    }

    /// When (s) the first body left its seat.
    pub fn collapse_time(&self) -> Option<f64> {
        known(self.collapse)
    }

    /// The first body that left its seat.
    pub fn first(&self) -> Option<BodyId> {
        self.first[0]
    }

    /// When (s) the first barrel had fallen.
    pub fn first_fall(&self) -> Option<f64> {
        known(self.first_fall)
    }
}

/// A time (s) that has come.
fn known(time: f64) -> Option<f64> {
    time.is_finite().then_some(time)
}

impl<R: Real> Fates<R> {
    /// When (s) the first body left its seat; infinite in lanes where none has.
    pub fn collapse(&self) -> R {
        self.collapse
    }

    /// Looks at an accepted state.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub fn observe(&mut self, state: &State<Planar<R>>, scratch: &Scratch<Planar<R>>) {
        let ground = state.poses[Assembly::GROUND].position;
        let standing = !self.collapse.lt(R::splat(f64::INFINITY));
        for i in 0..self.bodies.len() {
            if self.bodies[i].kind == PartKind::Ground {
                continue;
            }
            let moved = state.poses[i].position - ground - self.bodies[i].rest;
            let slip = self.slip(state, scratch, i);
            let body = &mut self.bodies[i];
            raise(&mut body.drop, -moved.z);
            body.residual_displacement = moved.x;
            body.residual_slip = slip.x;
            if standing.any() {
                let now = R::select(standing, moved.x, body.displacement_at_collapse);
                body.displacement_at_collapse = now;
                raise(&mut body.peak_displacement, seen(standing, moved.x.abs()));
                raise(&mut body.peak_slip, seen(standing, slip.x.abs()));
                raise(&mut body.peak_uplift, seen(standing, moved.z));
                if body.kind == PartKind::Rack {
                    raise(&mut body.peak_tilt, seen(standing, state.poses[i].orientation.abs()));
                }
            }
            let fallen = self.fall_drop.lt(-moved.z);
            if fallen.any() {
                let first = fallen & !body.fell_at.lt(R::splat(f64::INFINITY));
                body.fell_at = R::select(first, state.time, body.fell_at);
                if body.kind == PartKind::Barrel {
                    let first = first & !self.first_fall.lt(R::splat(f64::INFINITY));
                    self.first_fall = R::select(first, state.time, self.first_fall);
                }
            }
            let never = R::splat(f64::INFINITY);
            let body = &mut self.bodies[i];
            let falling = body.fell_at.lt(never) & !body.landed_at.lt(never);
            if falling.any() {
                let ground = state.twists[Assembly::GROUND].linear.z;
                let down = ground - state.twists[i].linear.z;
                raise(&mut body.landing_speed, seen(falling, down));
                let landed = falling & down.lt(R::splat(0.5) * body.landing_speed);
                body.landed_at = R::select(landed, state.time, body.landed_at);
            }
            self.seat(state, i, slip);
        }
    }

    /// Whether a body has left its seat now, and how.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    fn seat(&mut self, state: &State<Planar<R>>, i: BodyId, slip: Vec2<R>) {
        let never = R::splat(f64::INFINITY);
        let body = &self.bodies[i];
        let fell = body.fell_at.lt(never);
        let (slid, tilted) = match body.kind {
            PartKind::Ground | PartKind::Body => return,
            PartKind::Barrel => {
                ((body.most_slip * body.most_slip).lt(slip.dot(slip)), R::Mask::default())
            }
            PartKind::Rack => {
                let below = body.below.map_or(R::zero(), |rack| state.poses[rack].orientation);
                let tilt = (state.poses[i].orientation - below).abs();
                (body.most_slip.lt(slip.x.abs()), body.most_tilt.lt(tilt))
            }
        };
        let left = (slid | tilted | fell) & !body.left_seat.lt(never);
        if !left.any() {
            return;
        }
        let collapses = left & !self.collapse.lt(never);
        for lane in (0..R::LANES).filter(|lane| left.lane(*lane)) {
            let body = &mut self.bodies[i];
            body.loss[lane] = match (slid.lane(lane), tilted.lane(lane)) {
                (true, _) if body.kind == PartKind::Barrel => Loss::Displaced,
                (true, _) => Loss::Slid,
                (false, true) => Loss::Tilted,
                (false, false) => Loss::Dropped,
            };
            if collapses.lane(lane) {
                self.first[lane] = Some(i);
            }
        }
        let body = &mut self.bodies[i];
        body.left_seat = R::select(left, state.time, body.left_seat);
        self.collapse = R::select(collapses, state.time, self.collapse);
    }

    /// Displacement (m) of a body relative to what it stands on: a barrel in the frame of its rack, a
    /// rack against the mean of the barrels below, the rest against the ground.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    fn slip(&self, state: &State<Planar<R>>, scratch: &Scratch<Planar<R>>, i: BodyId) -> Vec2<R> {
        let body = &self.bodies[i];
        let here = state.poses[i].position;
        if let Some(rack) = body.carrier {
            let place = scratch.rotations[rack].unapply(here - state.poses[rack].position);
            return place - (body.rest - self.bodies[rack].rest);
        }
        if body.supports.is_empty() {
            return here - state.poses[Assembly::GROUND].position - body.rest;
        }
        let share = R::splat(1.0 / body.supports.len() as f64);
        let mut below = Vec2::default();
        let mut below_rest = Vec2::default();
        for support in &body.supports {
            below += state.poses[*support].position * share;
            below_rest += self.bodies[*support].rest * share;
        }
        (here - below) - (body.rest - below_rest)
    }

    /// All lanes as one case begins.
    pub(crate) fn in_all(single: &Fates) -> Self {
        let mut fates = Self {
            fall_drop: R::splat(single.fall_drop),
            bodies: single.bodies.iter().map(Followed::in_all).collect(),
            collapse: R::zero(),
            first: vec![None; R::LANES],
            first_fall: R::zero(),
        };
        for lane in 0..R::LANES {
            fates.put(lane, single);
        }
        fates
    }

    /// Puts a case into one lane.
    pub(crate) fn put(&mut self, lane: usize, single: &Fates) {
        self.fall_drop = self.fall_drop.with_lane(lane, single.fall_drop);
        self.collapse = self.collapse.with_lane(lane, single.collapse);
        self.first[lane] = single.first[0];
        self.first_fall = self.first_fall.with_lane(lane, single.first_fall);
        for (body, single) in self.bodies.iter_mut().zip(&single.bodies) {
            body.put(lane, single);
        }
    }

    /// The case in one lane.
    pub(crate) fn of_lane(&self, lane: usize) -> Fates {
        Fates {
            fall_drop: self.fall_drop.lane(lane),
            bodies: self.bodies.iter().map(|body| body.of_lane(lane)).collect(),
            collapse: self.collapse.lane(lane),
            first: vec![self.first[lane]],
            first_fall: self.first_fall.lane(lane),
        }
    }
}

/// Raises a peak to a value above it.
#[inline(always)]
#[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
fn raise<R: Real>(peak: &mut R, value: R) {
    *peak = R::select(peak.lt(value), value, *peak);
}

/// A value while the stack stands; nothing afterwards.
#[inline(always)]
#[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
fn seen<R: Real>(standing: R::Mask, value: R) -> R {
    R::select(standing, value, R::zero())
}

impl<R: Real> Followed<R> {
    /// The numbers of a body, with those of a body of a single run.
    fn numbers<'a>(&'a mut self, single: &Followed<f64>) -> [(&'a mut R, f64); 16] {
        [
            (&mut self.rest.x, single.rest.x),
            (&mut self.rest.z, single.rest.z),
            (&mut self.most_slip, single.most_slip),
            (&mut self.most_tilt, single.most_tilt),
            (&mut self.left_seat, single.left_seat),
            (&mut self.fell_at, single.fell_at),
            (&mut self.landed_at, single.landed_at),
            (&mut self.landing_speed, single.landing_speed),
            (&mut self.drop, single.drop),
            (&mut self.peak_displacement, single.peak_displacement),
            (&mut self.residual_displacement, single.residual_displacement),
            (&mut self.displacement_at_collapse, single.displacement_at_collapse),
            (&mut self.peak_slip, single.peak_slip),
            (&mut self.residual_slip, single.residual_slip),
            (&mut self.peak_tilt, single.peak_tilt),
            (&mut self.peak_uplift, single.peak_uplift),
        ]
    }

    fn in_all(single: &Followed<f64>) -> Self {
        let zero = R::zero();
        Self {
            kind: single.kind,
            carrier: single.carrier,
            supports: single.supports.clone(),
            below: single.below,
            rest: Vec2::default(),
            most_slip: zero,
            most_tilt: zero,
            left_seat: zero,
            loss: vec![Loss::Dropped; R::LANES],
            fell_at: zero,
            landed_at: zero,
            landing_speed: zero,
            drop: zero,
            peak_displacement: zero,
            residual_displacement: zero,
            displacement_at_collapse: zero,
            peak_slip: zero,
            residual_slip: zero,
            peak_tilt: zero,
            peak_uplift: zero,
        }
    }

    fn put(&mut self, lane: usize, single: &Followed<f64>) {
        self.loss[lane] = single.loss[0];
        for (bundle, number) in self.numbers(single) {
            *bundle = bundle.with_lane(lane, number);
        }
    }

    fn of_lane(&self, lane: usize) -> Followed<f64> {
        Followed {
            kind: self.kind,
            carrier: self.carrier,
            supports: self.supports.clone(),
            below: self.below,
            rest: Vec2::new(self.rest.x.lane(lane), self.rest.z.lane(lane)),
            most_slip: self.most_slip.lane(lane),
            most_tilt: self.most_tilt.lane(lane),
            left_seat: self.left_seat.lane(lane),
            loss: vec![self.loss[lane]],
            fell_at: self.fell_at.lane(lane),
            landed_at: self.landed_at.lane(lane),
            landing_speed: self.landing_speed.lane(lane),
            drop: self.drop.lane(lane),
            peak_displacement: self.peak_displacement.lane(lane),
            residual_displacement: self.residual_displacement.lane(lane),
            displacement_at_collapse: self.displacement_at_collapse.lane(lane),
            peak_slip: self.peak_slip.lane(lane),
            residual_slip: self.residual_slip.lane(lane),
            peak_tilt: self.peak_tilt.lane(lane),
            peak_uplift: self.peak_uplift.lane(lane),
        }
    }
}
