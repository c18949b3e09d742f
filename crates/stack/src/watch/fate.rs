//! Outcome for every body: loss of a seat, fall, slip and tilt.

use barrelstack_dynamics::lanes::PerLane;
use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Linear, Planar, Scratch, State, Vec2, lanewise};

use crate::assemble::{Assembly, Part, PartKind};
use crate::scenario::OutcomeSpec;

/// Thresholds beyond which a body counts as having left its seat, or as fallen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Displacement of a barrel from its position in the rack, in barrel radii, beyond which the barrel has left its
    /// seat.
    pub seat_loss_ratio: f64,
    /// Drop (m) of a body below its position at rest, beyond which the body has fallen.
    pub fall_drop: f64,
    /// Displacement of a rack on the barrels below, as a fraction of [`Assembly::rack_reach`], beyond which the rack
    /// has left its seat.
    pub rack_slide_ratio: f64,
    /// Tilt (rad) of a rack relative to the rack below, beyond which the rack has left its seat by rocking.
    pub rocking_angle: f64,
    /// Tilt (rad) of the bottom rack, beyond which the stack has overturned.
    pub overturning_angle: f64,
}

impl Thresholds {
    /// Returns the thresholds of a scenario, with lengths multiplied by `length_scale`.
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

/// Kind of a loss of a seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// A barrel moved too far from its position in the rack.
    Displaced,
    /// A rack moved too far along its support.
    Slid,
    /// A rack tilted too far.
    Tilted,
    /// A body dropped, although it had neither moved nor tilted too far.
    Dropped,
}

/// Outcome of a run for one body: loss of a seat, fall, and largest motions.
///
/// The collapse is the first loss of a seat of any body of the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fate {
    /// Time (s) and kind of the loss of a seat; `None` if the body kept its seat.
    pub left_seat: Option<(f64, Loss)>,
    /// Time (s) at which the drop of the body exceeded the threshold of a fall; `None` if the body did not fall.
    pub fell_at: Option<f64>,
    /// Time (s) at which the body landed: the first time after [`Fate::fell_at`] at which the body moved downward at
    /// less than half of its largest downward speed. `None` if the body has not landed.
    pub landed_at: Option<f64>,
    /// Largest downward speed (m/s) between fall and landing; `None` if the body has not landed.
    pub landing_speed: Option<f64>,
    /// Largest magnitude (N) of the total force on the body, excluding gravity, from [`Fate::fell_at`] on,
    /// including the impact on landing; `None` if the body did not fall.
    pub fall_force: Option<f64>,
    /// Largest drop (m) below its position at rest.
    pub drop: f64,
    /// Largest displacement (m) along `x` relative to the ground, until the collapse.
    pub peak_displacement: f64,
    /// Displacement (m) along `x` relative to the ground, at the end of the run.
    pub residual_displacement: f64,
    /// Displacement (m) along `x` relative to the ground at the collapse, or at the end of the run if there was no
    /// collapse.
    pub displacement_at_collapse: f64,
    /// Largest displacement (m) relative to the support, until the collapse: of a rack on the barrels below, or of a
    /// barrel in its cradle.
    pub peak_slip: f64,
    /// Displacement (m) relative to the support, at the end of the run.
    pub residual_slip: f64,
    /// Largest tilt (rad) of a rack, until the collapse; zero for other bodies.
    pub peak_tilt: f64,
    /// Largest rise (m) of the body above its position at rest, until the collapse.
    pub peak_uplift: f64,
    /// Largest motions over the whole run.
    pub whole_run: PeakMotion,
}

/// Largest motions of a body over all steps of a run, or over the steps until the first loss of a seat.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakMotion<R: Real = f64> {
    /// Largest displacement (m) along `x` relative to the ground.
    pub displacement: R,
    /// Largest displacement (m) relative to the support.
    pub slip: R,
    /// Largest tilt (rad) of a rack; zero for other bodies.
    pub tilt: R,
}

lanewise!(struct PeakMotion<R> { displacement, slip, tilt });

impl Fate {
    /// Returns the largest motions until the first loss of a seat.
    pub fn until_loss(&self) -> PeakMotion {
        let Self { peak_displacement, peak_slip, peak_tilt, .. } = *self;
        PeakMotion { displacement: peak_displacement, slip: peak_slip, tilt: peak_tilt }
    }
}

/// Observer of losses of seats, falls and largest motions of all bodies, in one run or in one run per lane. It must
/// observe every accepted step.
#[derive(Clone, Debug)]
pub struct Fates<R: Real = f64> {
    /// Drop (m) beyond which a body has fallen.
    fall_drop: R,
    bodies: Vec<Followed<R>>,
    /// Time (s) at which the first body left its seat; infinite until then.
    collapse: R,
    /// In each lane, the first body that left its seat; `None` until then.
    first: PerLane<Option<BodyId>>,
    /// Time (s) at which the first barrel counted as fallen; infinite until then.
    first_fall: R,
}

/// Kind and supports of a body, which are the same in all lanes.
#[derive(Clone, Debug)]
struct BodySupport {
    kind: PartKind,
    carrier: Option<BodyId>,
    supports: Vec<BodyId>,
    /// Rack below, relative to which the tilt of a rack is measured.
    below: Option<BodyId>,
    /// Height (m) of the center of mass of a rack above its foot, if it stands on a rack; `None` otherwise.
    foot: Option<f64>,
}

lanewise!(same BodySupport);
lanewise!(struct Followed<R> {
    support, rest, most_slip, most_tilt, left_seat, loss, fell_at, landed_at, landing_speed, fall_force, drop,
    peak_displacement, residual_displacement, displacement_at_collapse, peak_slip, residual_slip,
    peak_tilt, peak_uplift, whole_run
});
lanewise!(struct Fates<R> { fall_drop, bodies, collapse, first, first_fall });

/// A body, its limits, and its outcome so far.
#[derive(Clone, Debug)]
struct Followed<R: Real> {
    support: BodySupport,
    /// Position at rest (m), relative to the ground.
    rest: Vec2<R>,
    /// Limit (m) of the displacement of the body on its support.
    most_slip: R,
    /// Limit (rad) of the tilt of a rack.
    most_tilt: R,
    /// Time (s) at which the body left its seat; infinite until then.
    left_seat: R,
    /// Kind of the loss of a seat.
    loss: PerLane<Loss>,
    /// Time (s) at which the body fell; infinite until then.
    fell_at: R,
    /// Time (s) at which the body landed; infinite until then.
    landed_at: R,
    /// Largest downward speed (m/s) between fall and landing.
    landing_speed: R,
    /// Largest magnitude (N) of the total force on the body, excluding gravity, from `fell_at` on.
    fall_force: R,
    drop: R,
    peak_displacement: R,
    residual_displacement: R,
    displacement_at_collapse: R,
    peak_slip: R,
    residual_slip: R,
    peak_tilt: R,
    peak_uplift: R,
    whole_run: PeakMotion<R>,
}

impl Fates {
    /// Creates the observer of a stack that is at rest.
    pub fn new(assembly: &Assembly, state: &State<Planar>, thresholds: Thresholds) -> Self {
        let ground = state.poses[Assembly::GROUND].position;
        let follow = |(i, part): (usize, &Part)| {
            let below = part.supports.first().copied();
            let on_rack = below.is_some_and(|body| assembly.parts[body].kind == PartKind::Rack);
            let foot = part.supports.is_empty();
            let most_slip = match part.kind {
                PartKind::Barrel => thresholds.seat_loss_ratio * part.size,
                PartKind::Rack if !foot => thresholds.rack_slide_ratio * assembly.rack_reach,
                PartKind::Rack
                | PartKind::Ground
                | PartKind::Device
                | PartKind::Wine
                | PartKind::Body => f64::INFINITY,
            };
            let most_tilt =
                if foot { thresholds.overturning_angle } else { thresholds.rocking_angle };
            Followed {
                support: BodySupport {
                    kind: part.kind,
                    carrier: part.carrier,
                    supports: part.supports.clone(),
                    below: below.map(|body| assembly.parts[body].carrier.unwrap_or(body)),
                    foot: on_rack.then_some(part.foot),
                },
                rest: state.poses[i].position - ground,
                most_slip,
                most_tilt,
                left_seat: f64::INFINITY,
                loss: PerLane::single(Loss::Dropped),
                fell_at: f64::INFINITY,
                landed_at: f64::INFINITY,
                landing_speed: 0.0,
                fall_force: 0.0,
                drop: 0.0,
                peak_displacement: 0.0,
                residual_displacement: 0.0,
                displacement_at_collapse: 0.0,
                peak_slip: 0.0,
                residual_slip: 0.0,
                peak_tilt: 0.0,
                peak_uplift: 0.0,
                whole_run: PeakMotion::default(),
            }
        };
        Self {
            fall_drop: thresholds.fall_drop,
            bodies: assembly.parts.iter().enumerate().map(follow).collect(),
            collapse: f64::INFINITY,
            first: PerLane::single(None),
            first_fall: f64::INFINITY,
        }
    }

    /// Returns the position at rest (m) of a body, relative to the ground.
    pub fn rest(&self, body: BodyId) -> Vec2 {
        self.bodies[body].rest
    }

    /// Returns the outcome for one body.
    pub fn fate(&self, body: BodyId) -> Fate {
        let followed = &self.bodies[body];
        Fate {
            left_seat: known(followed.left_seat).map(|time| (time, followed.loss[0])),
            fell_at: known(followed.fell_at),
            landed_at: known(followed.landed_at),
            landing_speed: known(followed.landed_at).map(|_| followed.landing_speed),
            fall_force: known(followed.fell_at).map(|_| followed.fall_force),
            drop: followed.drop,
            peak_displacement: followed.peak_displacement,
            residual_displacement: followed.residual_displacement,
            displacement_at_collapse: followed.displacement_at_collapse,
            peak_slip: followed.peak_slip,
            residual_slip: followed.residual_slip,
            peak_tilt: followed.peak_tilt,
            peak_uplift: followed.peak_uplift,
            whole_run: followed.whole_run,
        }
    }

    /// Returns the time (s) at which the first body left its seat; `None` if no body has left its seat.
    pub fn collapse_time(&self) -> Option<f64> {
        known(self.collapse)
    }

    /// Returns the first body that left its seat; `None` if no body has left its seat.
    pub fn first(&self) -> Option<BodyId> {
        self.first[0]
    }

    /// Returns the time (s) at which the first barrel counted as fallen; `None` if no barrel has fallen.
    pub fn first_fall(&self) -> Option<f64> {
        known(self.first_fall)
    }
}

/// Returns a time (s) if it is finite; `None` otherwise.
fn known(time: f64) -> Option<f64> {
    time.is_finite().then_some(time)
}

impl<R: Real> Fates<R> {
    /// Returns the time (s) at which the first body left its seat; infinite in lanes in which no body has left its
    /// seat.
    pub fn collapse(&self) -> R {
        self.collapse
    }

    /// Returns the lanes in which no body has left its seat.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub(crate) fn stands(&self) -> R::Mask {
        !self.collapse.lt(R::splat(f64::INFINITY))
    }

    /// Records an accepted state.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub fn observe(&mut self, state: &State<Planar<R>>, scratch: &Scratch<Planar<R>>) {
        let ground = state.poses[Assembly::GROUND].position;
        let standing = self.stands();
        for i in 0..self.bodies.len() {
            if self.bodies[i].support.kind == PartKind::Ground {
                continue;
            }
            let moved = state.poses[i].position - ground - self.bodies[i].rest;
            let slip = self.slip(state, scratch, i);
            let body = &mut self.bodies[i];
            raise(&mut body.drop, -moved.z);
            raise(&mut body.whole_run.displacement, moved.x.abs());
            raise(&mut body.whole_run.slip, slip.x.abs());
            if body.support.kind == PartKind::Rack {
                raise(&mut body.whole_run.tilt, state.poses[i].orientation.abs());
            }
            body.residual_displacement = moved.x;
            body.residual_slip = slip.x;
            if standing.any() {
                let now = R::select(standing, moved.x, body.displacement_at_collapse);
                body.displacement_at_collapse = now;
                raise(&mut body.peak_displacement, masked(standing, moved.x.abs()));
                raise(&mut body.peak_slip, masked(standing, slip.x.abs()));
                raise(&mut body.peak_uplift, masked(standing, moved.z));
                if body.support.kind == PartKind::Rack {
                    raise(&mut body.peak_tilt, masked(standing, state.poses[i].orientation.abs()));
                }
            }
            let fallen = self.fall_drop.lt(-moved.z);
            if fallen.any() {
                let first = fallen & !body.fell_at.lt(R::splat(f64::INFINITY));
                body.fell_at = R::select(first, state.time, body.fell_at);
                let down = body.fell_at.lt(R::splat(f64::INFINITY));
                raise(&mut body.fall_force, masked(down, scratch.wrenches[i].force.length()));
                if body.support.kind == PartKind::Barrel {
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
                raise(&mut body.landing_speed, masked(falling, down));
                let landed = falling & down.lt(R::splat(0.5) * body.landing_speed);
                body.landed_at = R::select(landed, state.time, body.landed_at);
            }
            self.seat(state, i, slip);
        }
    }

    /// Records whether a body has left its seat, and the kind of the loss.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn seat(&mut self, state: &State<Planar<R>>, i: BodyId, slip: Vec2<R>) {
        let never = R::splat(f64::INFINITY);
        let body = &self.bodies[i];
        let fell = body.fell_at.lt(never);
        let (slid, tilted) = match body.support.kind {
            PartKind::Ground | PartKind::Device | PartKind::Wine | PartKind::Body => return,
            PartKind::Barrel => {
                ((body.most_slip * body.most_slip).lt(slip.dot(slip)), R::Mask::default())
            }
            PartKind::Rack => {
                let below =
                    body.support.below.map_or(R::zero(), |rack| state.poses[rack].orientation);
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
                (true, _) if body.support.kind == PartKind::Barrel => Loss::Displaced,
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

    /// Returns the displacement (m) of a body relative to its support.
    ///
    /// A barrel is measured in the frame of its rack, and the foot of a rack on posts in the frame of the rack below. A
    /// rack on barrels is measured relative to the mean position of these barrels, and any other body relative to the
    /// ground.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn slip(&self, state: &State<Planar<R>>, scratch: &Scratch<Planar<R>>, i: BodyId) -> Vec2<R> {
        let body = &self.bodies[i];
        let here = state.poses[i].position;
        if let Some(rack) = body.support.carrier {
            let place = scratch.rotations[rack].unapply(here - state.poses[rack].position);
            return place - (body.rest - self.bodies[rack].rest);
        }
        if body.support.supports.is_empty() {
            return here - state.poses[Assembly::GROUND].position - body.rest;
        }
        if let (Some(rack), Some(foot)) = (body.support.below, body.support.foot) {
            // In this frame, a rack does not slide if it leans together with the rack below, or rocks on the posts of
            // that rack.
            let foot = Vec2::new(R::zero(), R::splat(-foot));
            let from = here + scratch.rotations[i].apply(foot) - state.poses[rack].position;
            let rest = body.rest + foot - self.bodies[rack].rest;
            return scratch.rotations[rack].unapply(from) - rest;
        }
        let share = R::splat(1.0 / body.support.supports.len() as f64);
        let mut below = Vec2::default();
        let mut below_rest = Vec2::default();
        for support in &body.support.supports {
            below += state.poses[*support].position * share;
            below_rest += self.bodies[*support].rest * share;
        }
        (here - below) - (body.rest - below_rest)
    }
}

/// Raises a peak to a value if the value is larger.
#[inline(always)]
#[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
fn raise<R: Real>(peak: &mut R, value: R) {
    *peak = R::select(peak.lt(value), value, *peak);
}

/// Returns a value in the lanes of a mask, and zero in all other lanes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
fn masked<R: Real>(standing: R::Mask, value: R) -> R {
    R::select(standing, value, R::zero())
}
