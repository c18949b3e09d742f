//! List of the contact elements that could touch soon, with their contact history.
//!
//! A contact element is a node of a contactor and the surface of a target. The list contains only the elements within
//! reach; it is rebuilt before any body can have moved far enough for an element outside the list to touch. The list
//! affects only the speed of the computation: the forces are bit-identical to those of a computation that tests every
//! node in every step.

use crate::body::{Body, BodyId, Motion, Nodes, Round};
use crate::contact::Stick;
use crate::lanes::Lanewise;
use crate::model::{ContactPair, Counts, InterfaceId, Model};
use crate::pair_frame::PairFrame;
use crate::real::{Mask, Real};
use crate::shape::{Surface, Whole};
use crate::space::{Linear, Pose, Rotation3, Space, Spatial, Twist, Vec3};
use crate::state::State;

/// Slack (m) that is added to the displacements predicted for the lookahead time, since velocities change within this
/// time. An element is missing from the list only if its gap exceeds the sum of the predicted displacements and the
/// slack. So the prediction of substeps does not depend on which elements are in the list.
const LOOKAHEAD_SLACK: f64 = 1e-3;

/// Minimum allowance (m): every body may move at least this far before the list is rebuilt.
const LEAST_ALLOWANCE: f64 = 0.015;

/// Time (s) for which the list should remain valid if bodies keep their speeds, so that the list need not be rebuilt
/// every few steps while bodies fall.
const HORIZON: f64 = 0.012;

/// Maximum allowance (m): no body may move farther before the list is rebuilt. A larger allowance would make the list
/// longer, and every step more expensive.
const MOST_ALLOWANCE: f64 = 0.15;

/// The elements of one contact pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    /// Index of the pair in its model.
    pub(crate) pair: usize,
    /// Contactor and target.
    bodies: [BodyId; 2],
    /// Interface of the pair.
    pub(crate) interface: InterfaceId,
    /// Index of the first element of the group.
    pub(crate) first: usize,
    /// Index after the last element of the group.
    pub(crate) end: usize,
}

/// Slack (m) that is added to the displacements predicted for a step, since velocities change within the step. A group
/// is skipped if its gap exceeds the sum of the displacements of its two bodies and the slack.
const ASLEEP_SLACK: f64 = 2.0 * LOOKAHEAD_SLACK;

/// The contact elements within reach, in the order in which their forces are summed.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactElements<S: Space> {
    pub(crate) groups: Vec<Group>,
    /// For every element, the index of its node in the node set.
    pub(crate) nodes: Vec<u32>,
    /// For every element, the position (m) of its node in the body frame of the contactor.
    pub(crate) positions: Vec<S::Vector>,
    /// For every element, the factor by which the constants of its contact laws are multiplied: the tributary length
    /// (m) for constants per length, and 1 for constants per node or per seat.
    pub(crate) weights: Vec<S::Real>,
    /// For every element, its contact history.
    pub(crate) sticks: Vec<Stick<S>>,
    /// For every group, the smallest gap (m) of its elements when the list was built.
    apart: Vec<S::Real>,
    /// For every body, an upper bound of its displacement (m) from the time when the list was built to the end of the
    /// current step; infinite between steps.
    travels: Vec<S::Real>,
    /// Poses of the bodies when the list was built.
    built_for: Vec<Pose<S>>,
    /// For every body, its allowance (m): the displacement that is permitted before the list is rebuilt. The list
    /// contains all elements whose gap, when the list was built, was at most the sum of the allowances of their two
    /// bodies.
    allowances: Vec<f64>,
    /// `true` if the list contains all elements of the model.
    exhaustive: bool,
}

impl<S: Space> Default for ContactElements<S> {
    fn default() -> Self {
        Self {
            groups: Vec::new(),
            nodes: Vec::new(),
            positions: Vec::new(),
            weights: Vec::new(),
            sticks: Vec::new(),
            apart: Vec::new(),
            travels: Vec::new(),
            built_for: Vec::new(),
            allowances: Vec::new(),
            exhaustive: false,
        }
    }
}

impl<S: Space> ContactElements<S> {
    /// Returns the number of elements in the list.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns `true` if the list has no elements, because no node is near a surface.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns the lanes in which the gap of every element of a group stays larger than `gap` (m) during the current
    /// step, so that the group need not be tested.
    #[inline(always)]
    pub(crate) fn asleep(&self, group: usize, gap: S::Real) -> <S::Real as Real>::Mask {
        let [a, b] = self.groups[group].bodies;
        let travel = self.travels[a] + self.travels[b];
        (travel + (gap + S::Real::splat(ASLEEP_SLACK))).lt(self.apart[group])
    }

    /// Ends the step. Until the next step begins, bodies may be moved anywhere, so no group is skipped.
    pub(crate) fn end_step(&mut self) {
        self.travels.fill(S::Real::splat(f64::INFINITY));
    }

    /// Returns the contact history of an element, given its index as in
    /// [`Contact::element`](crate::forces::Contact::element).
    pub fn stick(&self, element: usize) -> Stick<S> {
        self.sticks[element]
    }

    /// Keeps every element in the list from now on; tests use the complete list as the reference for the shorter list.
    pub fn make_exhaustive(&mut self, model: &Model<S>, poses: &[Pose<S>]) {
        self.exhaustive = true;
        self.rebuild(model, poses, &vec![Twist::default(); poses.len()]);
    }

    /// Rebuilds the list if an element outside the list could touch now or within `dt` (s).
    ///
    /// Returns the origins that [`ContactElements::rebuild`] returns; `None` if the list was not rebuilt.
    pub(crate) fn refresh(
        &mut self,
        model: &Model<S>,
        poses: &[Pose<S>],
        twists: &[Twist<S>],
        dt: S::Real,
    ) -> Option<Vec<Option<usize>>> {
        if self.exhaustive {
            return None;
        }
        let moves = |list: &mut Self| {
            S::Real::scope(
                #[inline(always)]
                || list.has_moved_out(model, poses, twists, dt),
            )
        };
        let stale = moves(self);
        stale.then(|| {
            let origins = self.rebuild(model, poses, twists);
            moves(self);
            origins
        })
    }

    /// Updates the displacements of all bodies; returns `true` if a body may exceed its allowance.
    #[inline(always)]
    fn has_moved_out(
        &mut self,
        model: &Model<S>,
        poses: &[Pose<S>],
        twists: &[Twist<S>],
        dt: S::Real,
    ) -> bool {
        // Displacements are relative to the ground, which moves all bodies together.
        let ground = model.bodies.iter().position(|b| b.motion == Motion::Prescribed);
        let (carried, carrier) = ground.map_or_else(Default::default, |g| {
            (poses[g].position - self.built_for[g].position, twists[g].linear)
        });
        // Includes the current step, lengthened by half since velocities change within the step.
        let ahead = S::Real::splat(1.5) * dt;
        let mut stale = <S::Real as Real>::Mask::default();
        for (i, body) in model.bodies.iter().enumerate() {
            if body.motion == Motion::Prescribed {
                self.travels[i] = S::Real::zero();
                continue;
            }
            let moved = poses[i].position - self.built_for[i].position - carried;
            let velocity = twists[i].linear - carrier;
            let turned = S::angle_between(poses[i].orientation, self.built_for[i].orientation);
            let spin = S::spin_magnitude(twists[i].angular);
            let travel = S::length_bound(moved)
                + S::length_bound(velocity) * ahead
                + (turned + spin * ahead) * S::Real::splat(model.reach[i]);
            self.travels[i] = travel;
            stale = stale | !travel.lt(S::Real::splat(self.allowances[i] - LOOKAHEAD_SLACK));
        }
        stale.any()
    }

    /// Lists the elements within reach and copies their contact history from the old list.
    ///
    /// Returns the origins: for every element of the new list, its index in the old list.
    pub(crate) fn rebuild(
        &mut self,
        model: &Model<S>,
        poses: &[Pose<S>],
        twists: &[Twist<S>],
    ) -> Vec<Option<usize>> {
        let old = std::mem::replace(self, Self { exhaustive: self.exhaustive, ..Self::default() });
        self.built_for = poses.to_vec();
        self.allowances = allowances(model, twists);
        self.travels = vec![S::Real::splat(f64::INFINITY); poses.len()];
        let rotations: Vec<S::Rotation> = S::Real::scope(
            #[inline(always)]
            || {
                let mut rotations = Vec::with_capacity(poses.len());
                for pose in poses {
                    rotations.push(S::rotation(pose.orientation));
                }
                rotations
            },
        );
        let mut remembered = Remembered { old: &old, group: 0 };
        let mut origins = Vec::new();
        for index in self.pairs_in_reach(model, poses) {
            let pair = &model.pair(index);
            let first = self.nodes.len();
            let apart = S::Real::scope(
                #[inline(always)]
                || {
                    let frame = PairFrame::new(model, pair, poses, &rotations);
                    self.list_pair(model, pair, &frame)
                },
            );
            let end = self.nodes.len();
            if end > first {
                self.apart.push(apart);
                let bodies = [pair.contactor, pair.target];
                let interface = pair.interface;
                self.groups.push(Group { pair: index, bodies, interface, first, end });
                for element in first..end {
                    let origin = remembered.origin(index, self.nodes[element]);
                    self.sticks.push(origin.map_or_else(Stick::default, |o| old.sticks[o]));
                    origins.push(origin);
                }
            }
        }
        origins
    }

    /// Enlarges the bounding ball of every body by its allowance, and returns the contact pairs of all bodies whose
    /// enlarged balls overlap, in the order of the model.
    ///
    /// The bodies are sorted and swept along the first axis, so that the cost for a row of bodies does not grow with
    /// the square of their number.
    fn pairs_in_reach(&self, model: &Model<S>, poses: &[Pose<S>]) -> Vec<usize> {
        if self.exhaustive {
            return model.pairs.numbers().collect();
        }
        // Lanes may have different ground motions, so extents are relative to the ground of each lane.
        let ground = model.bodies.iter().position(|body| body.motion == Motion::Prescribed);
        let carried = ground.map_or_else(S::Vector::default, |ground| poses[ground].position);
        let ball = |(i, body): (usize, &Body<S>)| {
            let reach = if body.is_unbounded() { f64::INFINITY } else { model.reach[i] };
            reach + self.allowances[i]
        };
        let balls: Vec<f64> = model.bodies.iter().enumerate().map(ball).collect();
        let mut extents: Vec<(f64, f64, usize)> = balls
            .iter()
            .enumerate()
            .map(|(i, ball)| {
                let half = S::Real::splat(*ball);
                let place = S::first_coordinate(poses[i].position - carried);
                let least = -(half - place).largest_lane();
                (least, (place + half).largest_lane(), i)
            })
            .collect();
        extents.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        let mut couples = Vec::new();
        let mut open: Vec<(f64, usize)> = Vec::new();
        for (from, to, body) in extents {
            open.retain(|(end, _)| from <= *end);
            S::Real::scope(
                #[inline(always)]
                || {
                    for (_, other) in &open {
                        // In a heap, most bodies that lie above each other are far apart.
                        let apart = poses[body].position - poses[*other].position;
                        let touch = S::Real::splat(balls[body] + balls[*other]);
                        if !(touch * touch).lt(apart.dot(apart)).all() {
                            let bodies = [body.min(*other), body.max(*other)];
                            let pairs = model.pairs.of_couple(bodies);
                            if !pairs.is_empty() {
                                couples.push(pairs);
                            }
                        }
                    }
                },
            );
            open.push((to, body));
        }
        couples.sort_unstable_by_key(|pairs| pairs.start);
        couples.into_iter().flatten().collect()
    }

    /// Returns the distance (m) between a surface and a ball about a point; `None` if the distance exceeds a margin (m)
    /// in all lanes.
    #[inline(always)]
    fn near(
        &self,
        surface: &S::Surface,
        point: S::Vector,
        radius: S::Real,
        margin: f64,
    ) -> Option<S::Real> {
        let distance = surface.gap(point).distance - radius;
        let near = self.exhaustive || (!S::Real::splat(margin).lt(distance)).any();
        near.then_some(distance)
    }

    /// Returns `true` if no lane can have a contact before the list is rebuilt, because in every lane the surface
    /// remains deeper in the round piece than [`Round::greatest_depth`].
    ///
    /// The center of an arc may lie far outside its body. When the body turns, such a center may move farther than the
    /// allowance of the body, so a larger bound is used for it.
    #[inline(always)]
    fn behind(
        &self,
        model: &Model<S>,
        pair: &ContactPair,
        surface: &S::Surface,
        round: &Round<S>,
        center: S::Vector,
        frame: &PairFrame<S>,
    ) -> bool {
        let one = S::Real::splat(1.0);
        // Allowances bound the displacement of all points within the reach of a body; points beyond it move farther as
        // the body turns.
        let travel = |body: usize, arm: S::Vector| {
            let turning = arm.dot(arm).sqrt() / S::Real::splat(model.reach[body].max(1e-9));
            S::Real::splat(self.allowances[body]) * (one + turning)
        };
        let travels = travel(pair.contactor, center - frame.contactor)
            + travel(pair.target, center - frame.target);
        let depth = round.radius - surface.gap(center).distance;
        !self.exhaustive && (round.greatest_depth + travels).lt(depth).all()
    }

    /// Adds to the list those elements of a pair that are within reach. Returns the smallest gap (m) of these elements
    /// in every lane.
    #[inline(always)]
    fn list_pair(&mut self, model: &Model<S>, pair: &ContactPair, frame: &PairFrame<S>) -> S::Real {
        let mut least = S::Real::splat(f64::INFINITY);
        let surface = &model.bounded(pair.target).surfaces[pair.surface].surface;
        let margin = self.allowances[pair.contactor] + self.allowances[pair.target];
        // Bounding balls first: most pairs are far apart.
        let apart = frame.contactor - frame.target;
        let touch = model.reach[pair.contactor]
            + surface.reach()
            + margin
            + frame.target.dot(frame.target).sqrt().largest_lane();
        let far = S::Real::splat(touch * touch).lt(apart.dot(apart));
        if !self.exhaustive && !(!far).any() {
            return least;
        }
        let undecided = frame.before(model, pair).is_none_or(|before| {
            let margin = S::Real::splat(margin);
            match pair.counts {
                Counts::BehindFace(_) | Counts::BehindFaceOfTarget(_) => {
                    before.lt(margin).any()
                        || !frame.at_face(model, pair).is_some_and(|f| f.never())
                }
                Counts::Everywhere | Counts::BeforeFace(_) => (-margin).lt(before).any(),
            }
        });
        if !self.exhaustive && !undecided {
            return least;
        }
        let basis = model.interfaces[pair.interface].basis;
        match model.pair_nodes(pair) {
            Nodes::Fixed(nodes) => {
                let reach = S::Real::splat(model.reach[pair.contactor]);
                if self.near(surface, frame.contactor, reach, margin).is_none() {
                    return least;
                }
                for (index, node) in nodes.iter().enumerate() {
                    let (place, zero) = (frame.to_surface(node.position), S::Real::zero());
                    if let Some(gap) = self.near(surface, place, zero, margin) {
                        least = least.min(gap);
                        self.nodes.push(u32::try_from(index).unwrap_or(u32::MAX));
                        self.positions.push(node.position);
                        self.weights.push(basis.weight(node.tributary_length));
                    }
                }
            }
            Nodes::Rounds(rounds) => {
                for (index, round) in rounds.iter().enumerate() {
                    let center = frame.to_surface(round.center);
                    let Some(gap) = self.near(surface, center, round.radius, margin) else {
                        continue;
                    };
                    if !self.behind(model, pair, surface, round, center, frame) {
                        least = least.min(gap);
                        self.nodes.push(u32::try_from(index).unwrap_or(u32::MAX));
                        self.positions.push(round.center);
                        self.weights.push(basis.weight(round.tributary_length));
                    }
                }
            }
            Nodes::Rolling { center, radius, tributary_length } => {
                let place = frame.to_surface(*center);
                if let Some(gap) = self.near(surface, place, *radius, margin) {
                    least = least.min(gap);
                    self.nodes.push(0);
                    self.positions.push(*center);
                    self.weights.push(basis.weight(*tributary_length));
                }
            }
            Nodes::Whole(whole) => {
                let (center, radius) = whole.ball();
                let around = self.near(surface, frame.to_surface(center), radius, margin);
                let Some(around) = around else { return least };
                let all = S::Real::splat(if self.exhaustive { f64::INFINITY } else { margin });
                let near = !all.lt(around);
                // A slender body may be far away although its bounding ball is near.
                whole.meet(surface, frame.contactor, frame.relative, near, |patch| {
                    let gap = patch.deepest.gap.distance;
                    least = least.min(S::Real::select(near, gap, around));
                });
                if self.exhaustive || !S::Real::splat(margin).lt(least).all() {
                    for index in 0..whole.most_sticks() {
                        self.nodes.push(u32::try_from(index).unwrap_or(u32::MAX));
                        self.positions.push(center);
                        self.weights.push(basis.weight(whole.tributary_length()));
                    }
                }
            }
        }
        least
    }
}

/// A group of elements that is moved into another model.
pub(crate) struct Moved {
    /// Index of the pair in the new model.
    pair: usize,
    group: Group,
    nodes: Vec<u32>,
    sticks: Vec<Stick<Spatial>>,
    slip_rates: Vec<Vec3>,
}

impl Moved {
    /// Returns the index of the pair in the new model.
    pub(crate) fn pair(&self) -> usize {
        self.pair
    }
}

impl ContactElements<Spatial> {
    /// Returns the groups whose pairs exist in a new model as well. `number_of` maps the index of a pair to its index
    /// in the new model, and returns `None` for a pair that does not exist there. `turn` rotates the displacements of
    /// the tangential springs and the slip rates into the frame of the new model.
    pub(crate) fn moved(
        &self,
        slip_rates: &[Vec3],
        turn: Rotation3,
        number_of: &dyn Fn(usize) -> Option<usize>,
    ) -> Vec<Moved> {
        let stick = |stick: &Stick<Spatial>| Stick {
            displacement: turn.apply(stick.displacement),
            tangent_plane: turn.apply(stick.tangent_plane),
            slipping: stick.slipping,
        };
        let moved = |group: &Group| {
            let own = group.first..group.end;
            let rates = slip_rates.get(own.clone()).unwrap_or_default();
            Some(Moved {
                pair: number_of(group.pair)?,
                group: *group,
                nodes: self.nodes[own.clone()].to_vec(),
                sticks: self.sticks[own].iter().map(stick).collect(),
                slip_rates: rates.iter().map(|rate| turn.apply(*rate)).collect(),
            })
        };
        self.groups.iter().filter_map(moved).collect()
    }

    /// Lists the elements of a model at a state. Elements of the moved groups, which must be sorted by their pairs,
    /// keep their contact history. Returns the list and the slip rates of its elements.
    pub(crate) fn of_moved(
        model: &Model<Spatial>,
        moved: &[Moved],
        state: &State<Spatial>,
    ) -> (Self, Vec<Vec3>) {
        let (mut list, mut rates) = (Self::default(), Vec::new());
        for one in moved {
            let first = list.nodes.len();
            list.nodes.extend(&one.nodes);
            list.sticks.extend(&one.sticks);
            rates.extend(&one.slip_rates);
            let end = list.nodes.len();
            list.groups.push(Group { pair: one.pair, first, end, ..one.group });
        }
        let origins = list.rebuild(model, &state.poses, &state.twists);
        let rate = |origin: &Option<usize>| {
            origin.and_then(|origin| rates.get(origin).copied()).unwrap_or_default()
        };
        let rates = origins.iter().map(rate).collect();
        (list, rates)
    }
}

impl<S: Space> ContactElements<S> {
    /// Copies the contact history and the slip rates from the state of a single run into one lane; elements that the
    /// single run does not list start with an empty history.
    pub(crate) fn put_memory(
        &mut self,
        lane: usize,
        slip_rates: &mut [S::Tangent],
        single: &ContactElements<S::Single>,
        single_slip_rates: &[<S::Single as Space>::Tangent],
    ) {
        let mut remembered = Remembered { old: single, group: 0 };
        for group in &self.groups {
            let elements = group.first..group.end;
            let sticks = &mut self.sticks[elements.clone()];
            let rates = &mut slip_rates[elements.clone()];
            for ((node, stick), rate) in self.nodes[elements].iter().zip(sticks).zip(rates) {
                let origin = remembered.origin(group.pair, *node);
                let memory = origin.map_or_else(Stick::default, |o| single.sticks[o]);
                stick.put(lane, &memory);
                rate.put(lane, &origin.map(|o| single_slip_rates[o]).unwrap_or_default());
            }
        }
    }

    /// Returns a list with the contact history of one lane; the history of elements that do not touch in this lane is
    /// empty. The list lacks the other data of the elements, so it must be rebuilt before it is used in a single run.
    pub(crate) fn of_lane(
        &self,
        lane: usize,
        touching: &[<S::Real as Real>::Mask],
    ) -> ContactElements<S::Single> {
        let stick = |(stick, touching): (&Stick<S>, &<S::Real as Real>::Mask)| {
            if touching.lane(lane) { stick.of_lane(lane) } else { Stick::default() }
        };
        let sticks = self.sticks.iter().zip(touching).map(stick).collect();
        let (groups, nodes) = (self.groups.clone(), self.nodes.clone());
        ContactElements { groups, nodes, sticks, ..ContactElements::default() }
    }
}

/// Returns the allowance (m) of each body: the displacement that is permitted before the list is rebuilt.
///
/// The allowance grows with the largest speed of the body over all lanes. The speed is relative to the ground, since
/// the motion of the ground moves all bodies together.
fn allowances<S: Space>(model: &Model<S>, twists: &[Twist<S>]) -> Vec<f64> {
    let ground = model.bodies.iter().position(|body| body.motion == Motion::Prescribed);
    let carrier = ground.map_or_else(S::Vector::default, |ground| twists[ground].linear);
    let allowance = |(i, body): (usize, &Body<S>)| {
        if body.motion == Motion::Prescribed {
            return 0.0;
        }
        let speed = S::Real::scope(
            #[inline(always)]
            || {
                S::length_bound(twists[i].linear - carrier)
                    + S::spin_magnitude(twists[i].angular) * S::Real::splat(model.reach[i])
            },
        );
        (LEAST_ALLOWANCE + HORIZON * speed.largest_lane().max(0.0)).min(MOST_ALLOWANCE)
    };
    model.bodies.iter().enumerate().map(allowance).collect()
}

/// Looks up elements in an old list while a new list is traversed; both lists are sorted by pair and node.
struct Remembered<'a, S: Space> {
    old: &'a ContactElements<S>,
    group: usize,
}

impl<S: Space> Remembered<'_, S> {
    /// Returns the index of an element in the old list.
    fn origin(&mut self, pair: usize, node: u32) -> Option<usize> {
        let groups = &self.old.groups;
        while self.group < groups.len() && groups[self.group].pair < pair {
            self.group += 1;
        }
        let group = groups.get(self.group).filter(|group| group.pair == pair)?;
        let nodes = &self.old.nodes[group.first..group.end];
        nodes.binary_search(&node).ok().map(|at| group.first + at)
    }
}
