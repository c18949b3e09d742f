//! Observer of contact stresses in every step of one run, or of one run per lane.

use std::collections::BTreeMap;
use std::ops::Range;

use barrelstack_dynamics::forces::tributary_length;
use barrelstack_dynamics::lanes::{Lanewise, put_truth};
use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::shape::Surface as _;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{BodyId, Model, Nodes, Planar, Scratch, State, Vec2, lanewise};

use super::places::{on_nodes, on_surface};
use super::{BoundaryPoint, Cells, StressEnvelope, Stresses};
use crate::assemble::{Assembly, PartKind};

/// Range of contact points for which a contact element loads the same cells of a body, and the largest force of the
/// element since its contact point entered this range. A cell is the part of the boundary that one point of the stress
/// envelope represents.
///
/// As long as the contact point stays in this range, only the largest force matters. In most steps, most contacts
/// therefore need only a few comparisons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds<R: Real = f64> {
    /// First point or direction of the range.
    pub(super) from: Vec2<R>,
    /// First point or direction past the range.
    pub(super) to: Vec2<R>,
    /// On a barrel, `true` if the range is above the axis; on a rack, `true` if the loaded point has been determined.
    pub(super) above: R::Mask,
    /// Largest force (N) since the contact point entered the range.
    most: R,
}

/// Geometry of the set of contact points for which a contact element loads the same cells of a body.
#[derive(Clone, Copy, Debug)]
enum CellRange {
    /// All points of a rack: a contact element always loads the envelope point that it loaded at its first contact.
    Everywhere,
    /// Points in a wedge, counterclockwise from the direction `from` to the direction `to` of [`Bounds`].
    Wedge,
    /// Points between two values of `x` (m) above the axis, or below it.
    Strip,
}

/// One of the two bodies of a contact pair, for which a stress envelope is recorded.
#[derive(Clone, Copy, Debug)]
struct Side {
    body: BodyId,
    range: CellRange,
    /// `true` if the body is the target of the pair.
    is_target: bool,
}

lanewise!(same Side);
lanewise!(struct Bounds<R> { from, to, most } masks { above });
lanewise!(struct Pair<R> { bodies, sides, count, offset, rotation });

/// Data that all contact elements of a pair share.
#[derive(Clone, Debug)]
struct Pair<R: Real> {
    /// The contactor and the target.
    bodies: [BodyId; 2],
    /// The bodies for which a stress envelope is recorded.
    sides: Vec<Side>,
    /// Number of contact elements.
    count: usize,
    /// Offset (m) of the target's surface from the origin of the frame of its body.
    offset: Vec2<R>,
    /// Rotation of the target's surface relative to its body.
    rotation: Rotation2<R>,
}

impl<R: Real> Pair<R> {
    /// Transforms a contact point (m) from the frame of the target's surface to the frame of the body that `side`
    /// selects.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn in_body(
        &self,
        side: Side,
        point: Vec2<R>,
        state: &State<Planar<R>>,
        scratch: &Scratch<Planar<R>>,
    ) -> Vec2<R> {
        let in_target = self.offset + self.rotation.apply(point);
        if side.is_target {
            return in_target;
        }
        let [contactor, target] = self.bodies;
        let apart = state.poses[target].position - state.poses[contactor].position;
        let place = apart + scratch.rotations[target].apply(in_target);
        scratch.rotations[contactor].unapply(place)
    }
}

impl Bounds {
    /// Returns empty bounds, for an element without contact so far.
    pub(super) fn none() -> Self {
        Self { from: Vec2::default(), to: Vec2::default(), above: false, most: 0.0 }
    }
}

impl<R: Real> Bounds<R> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn hold(&self, range: CellRange, point: Vec2<R>) -> R::Mask {
        let Self { from, to, above, .. } = *self;
        match range {
            CellRange::Everywhere => above,
            CellRange::Wedge => {
                (from.z * point.x).le(from.x * point.z) & (point.z * to.x).lt(point.x * to.z)
            }
            CellRange::Strip => {
                let upper = R::zero().le(point.z);
                let side = (upper & above) | (!upper & !above);
                from.x.le(point.x) & point.x.lt(to.x) & side
            }
        }
    }
}

/// The points of the stress envelope of a body that a contact element loads.
#[derive(Clone, Debug, Default)]
struct Pressed {
    /// Index of the stress envelope of the body.
    on: usize,
    /// Tributary length (m) of the element.
    length: f64,
    /// The loaded points of the envelope; indices past the last point wrap around to the first point.
    points: Range<usize>,
}

/// Stresses of the run in one lane.
#[derive(Clone, Debug, Default)]
struct Lane {
    stresses: Stresses,
    /// For every entry of [`StressWatch::bounds`], the envelope points that its contact element loads.
    pressed: Vec<Pressed>,
    /// Index of the envelope point that a contact on a rack loads, by pair, contact element and body.
    on_racks: BTreeMap<(usize, u32, BodyId), usize>,
}

/// Value that marks a pair that has not touched yet.
const NEVER: usize = usize::MAX;

/// Observer of the stresses in one run, or in one run per lane. It must observe every accepted step.
#[derive(Clone, Debug)]
pub(crate) struct StressWatch<R: Real = f64> {
    lanes: Vec<Lane>,
    /// The lanes in which a run is observed.
    watched: R::Mask,
    /// The observed lanes in which a body has left its seat.
    lost: R::Mask,
    pairs: Vec<Pair<R>>,
    /// For every pair, the index of its first entry in `bounds`; [`NEVER`] if the pair has not touched yet.
    first: Vec<usize>,
    /// One entry for each combination of a contact element and one of its two bodies, for all pairs that have touched.
    bounds: Vec<Bounds<R>>,
    /// For every body, the sum of the normal contact forces (N) in the current step, and the largest sum so far.
    totals: Vec<[R; 2]>,
}

impl StressWatch {
    /// Creates the observer of a run that starts from the state at rest in `state`. The stresses at rest are computed
    /// from the contact forces in `scratch`.
    pub(crate) fn new(
        assembly: &Assembly,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
    ) -> Self {
        let stresses = empty(assembly);
        let mut pairs = Vec::new();
        // A free scene has no envelopes, and may have too many pairs to list.
        let watched = !stresses.envelopes.is_empty();
        for pair in assembly.model.pairs().take_while(|_| watched) {
            let side = |(body, is_target): (BodyId, bool)| {
                let range = match stresses.of(body)?.cells {
                    Cells::Around(_) => CellRange::Wedge,
                    Cells::Along(_) => CellRange::Strip,
                    Cells::Nodes => CellRange::Everywhere,
                };
                Some(Side { body, range, is_target })
            };
            let body = |id: BodyId| &assembly.model.bodies()[id];
            let placed = &body(pair.target).surfaces[pair.surface];
            pairs.push(Pair {
                bodies: [pair.contactor, pair.target],
                sides: [(pair.contactor, false), (pair.target, true)]
                    .into_iter()
                    .filter_map(side)
                    .collect(),
                count: body(pair.contactor).nodes[pair.nodes].count(),
                offset: placed.offset,
                rotation: placed.rotation,
            });
        }
        let mut watch = Self {
            lanes: vec![Lane { stresses, ..Lane::default() }],
            watched,
            lost: false,
            first: vec![NEVER; pairs.len()],
            pairs,
            bounds: Vec::new(),
            totals: vec![[0.0; 2]; assembly.parts.len()],
        };
        watch.observe(true, state, scratch, &|_| Some(&assembly.model));
        watch.rest(scratch);
        watch
    }

    /// Stores the current forces as the forces at rest.
    fn rest(&mut self, scratch: &Scratch<Planar>) {
        let Some(Lane { stresses, pressed, .. }) = self.lanes.first_mut() else { return };
        let envelopes = &mut stresses.envelopes;
        // Force (N) and loaded length (m) of every point of every envelope.
        let mut loads: Vec<Vec<[f64; 2]>> =
            envelopes.iter().map(|one| vec![[0.0; 2]; one.points.len()]).collect();
        for contact in scratch.pressed.iter().take_while(|_| self.watched) {
            let pair = &self.pairs[contact.pair];
            for side in 0..pair.sides.len() {
                let at = self.first[contact.pair] + side * pair.count + contact.node as usize;
                let Pressed { on, length, points } = &pressed[at];
                let (load, share) = (&mut loads[*on], 1.0 / points.len() as f64);
                let count = load.len();
                for point in points.clone() {
                    let [force, loaded] = &mut load[point % count];
                    *force += contact.normal_force * share;
                    *loaded += length * share;
                }
            }
        }
        if self.watched {
            self.raise(0);
        }
        let envelopes = &mut self.lanes[0].stresses.envelopes;
        for (envelope, loads) in envelopes.iter_mut().zip(loads) {
            for (at, [force, length]) in loads.into_iter().enumerate() {
                if force > 0.0 {
                    if !envelope.is_on_nodes() {
                        envelope.lengths[at] = length;
                    }
                    envelope.at_rest[at] = force / envelope.lengths[at];
                }
                let peak = envelope.at_rest[at].max(envelope.peak_whole_run[at]);
                envelope.peak_whole_run[at] = peak;
            }
            envelope.peak.clone_from(&envelope.peak_whole_run);
            envelope.total.at_rest = self.totals[envelope.body][1];
        }
    }
}

/// Creates the stress envelopes of all barrels and racks, with zero stresses.
fn empty(assembly: &Assembly) -> Stresses {
    let mut envelopes: Vec<StressEnvelope> = Vec::new();
    let mut of_body = vec![None; assembly.parts.len()];
    for (i, part) in assembly.parts.iter().enumerate() {
        let body = &assembly.model.bodies()[i];
        let made = match part.kind {
            PartKind::Barrel => body.surfaces.first().and_then(|placed| {
                // Most barrels are equal, so their cells can be copied.
                let alike = |known: &&StressEnvelope| {
                    let other = assembly.model.bodies()[known.body].surfaces.first();
                    !known.is_on_nodes()
                        && other.is_some_and(|other| other.surface == placed.surface)
                };
                match envelopes.iter().rev().find(alike) {
                    Some(known) => Some(StressEnvelope { body: i, ..known.clone() }),
                    None => on_surface(i, &placed.surface),
                }
            }),
            PartKind::Rack => Some(on_nodes(i, &body.nodes)),
            PartKind::Ground | PartKind::Device | PartKind::Wine | PartKind::Body => None,
        };
        if let Some(envelope) = made {
            of_body[i] = Some(envelopes.len());
            envelopes.push(envelope);
        }
    }
    Stresses { envelopes, of_body }
}

impl<R: Real> StressWatch<R> {
    /// Creates an observer that observes no run yet.
    pub(crate) fn nothing() -> Self {
        Self {
            lanes: vec![Lane::default(); R::LANES],
            watched: R::Mask::default(),
            lost: R::Mask::default(),
            pairs: Vec::new(),
            first: Vec::new(),
            bounds: Vec::new(),
            totals: Vec::new(),
        }
    }

    /// Starts to observe a run in a lane; all runs that are observed together have the same topology.
    pub(crate) fn begin(&mut self, lane: usize, mut single: StressWatch) {
        if self.pairs.is_empty() {
            self.pairs = Lanewise::in_all(&single.pairs);
            self.first = vec![NEVER; single.pairs.len()];
            self.totals = Lanewise::in_all(&single.totals);
        } else {
            self.pairs.put(lane, &single.pairs);
            self.totals.put(lane, &single.totals);
        }
        if single.watched {
            single.raise(0);
        }
        // The envelope points that the contacts in this lane load, including those on racks, have to be determined
        // again.
        for bounds in &mut self.bounds {
            bounds.put(lane, &Bounds::none());
        }
        put_truth(&mut self.watched, lane, single.watched);
        put_truth(&mut self.lost, lane, single.lost);
        let mut alone = std::mem::take(&mut single.lanes[0]);
        alone.pressed = vec![Pressed::default(); self.bounds.len()];
        self.lanes[lane] = alone;
    }

    /// Ends the run in a lane and returns its stresses.
    pub(crate) fn finish(&mut self, lane: usize) -> Stresses {
        if self.watched.lane(lane) {
            self.raise(lane);
            if !self.lost.lane(lane) {
                self.keep(lane);
            }
            for envelope in &mut self.lanes[lane].stresses.envelopes {
                envelope.total.peak_whole_run = self.totals[envelope.body][1].lane(lane);
            }
        }
        put_truth(&mut self.watched, lane, false);
        std::mem::take(&mut self.lanes[lane]).stresses
    }

    /// Raises the envelopes of a lane to the stresses that the largest forces in `bounds` cause.
    fn raise(&mut self, lane: usize) {
        let Lane { stresses, pressed, .. } = &mut self.lanes[lane];
        for (bounds, pressed) in self.bounds.iter().zip(pressed.iter()) {
            stresses.raise(pressed, bounds.most.lane(lane));
        }
    }

    /// Stores the envelopes of a lane as the envelopes until the first loss of a seat.
    fn keep(&mut self, lane: usize) {
        for envelope in &mut self.lanes[lane].stresses.envelopes {
            envelope.peak.clone_from(&envelope.peak_whole_run);
            envelope.total.peak = self.totals[envelope.body][1].lane(lane);
        }
    }

    /// Records the contacts of an accepted state.
    ///
    /// `standing` are the lanes in which no seat had been lost before this state, and `model` returns the model of a
    /// lane.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub(crate) fn observe<'a>(
        &mut self,
        standing: R::Mask,
        state: &State<Planar<R>>,
        scratch: &Scratch<Planar<R>>,
        model: &impl Fn(usize) -> Option<&'a Model<Planar>>,
    ) {
        if !self.watched.any() {
            return;
        }
        let falls = self.watched & !standing & !self.lost;
        if falls.any() {
            for lane in (0..R::LANES).filter(|lane| falls.lane(*lane)) {
                self.raise(lane);
                self.keep(lane);
            }
            self.lost = self.lost | falls;
        }
        for total in &mut self.totals {
            total[0] = R::zero();
        }
        for contact in &scratch.pressed {
            let pair = &self.pairs[contact.pair];
            let force = R::select(contact.touching, contact.normal_force, R::zero());
            for body in pair.bodies {
                self.totals[body][0] += force;
            }
            if self.first[contact.pair] == NEVER {
                self.first[contact.pair] = self.bounds.len();
                let more = self.bounds.len() + pair.sides.len() * pair.count;
                self.bounds.resize(more, Bounds::in_all(&Bounds::none()));
                for lane in &mut self.lanes {
                    lane.pressed.resize(more, Pressed::default());
                }
            }
            for (number, side) in pair.sides.iter().enumerate() {
                let at = self.first[contact.pair] + number * pair.count + contact.node as usize;
                let bounds = &mut self.bounds[at];
                let presses = self.watched & contact.touching;
                let anywhere = matches!(side.range, CellRange::Everywhere);
                let point = if !anywhere || (presses & !bounds.above).any() {
                    pair.in_body(*side, contact.point, state, scratch)
                } else {
                    // Not needed: the contact loads the point of the rack that it has loaded before.
                    contact.point
                };
                let here = presses & bounds.hold(side.range, point);
                let more = here & bounds.most.lt(contact.normal_force);
                if more.any() {
                    bounds.most = R::select(more, contact.normal_force, bounds.most);
                }
                let leaves = presses & !here;
                if leaves.any() {
                    for lane in (0..R::LANES).filter(|lane| leaves.lane(*lane)) {
                        let one = &mut self.lanes[lane];
                        one.stresses.raise(&one.pressed[at], bounds.most.lane(lane));
                        let mut single = Bounds::none();
                        single.most = contact.normal_force.lane(lane);
                        let element = (contact.pair, contact.node, side.body);
                        let [point, touch] = [point, contact.point].map(|p| p.of_lane(lane));
                        if let Some(model) = model(lane) {
                            one.pressed[at] = one.find(model, element, point, touch, &mut single);
                        }
                        bounds.put(lane, &single);
                    }
                }
            }
        }
        for [now, most] in &mut self.totals {
            *most = R::select(self.watched & most.lt(*now), *now, *most);
        }
    }
}

impl Lane {
    /// Determines which points of the envelope of a body a contact element loads, and sets the bounds of the element.
    ///
    /// `element` contains the pair, the node and the body. `point` (m) is the contact point in the frame of the body,
    /// and `touch` (m) is the same point in the frame of the target's surface.
    fn find(
        &mut self,
        model: &Model<Planar>,
        element: (usize, u32, BodyId),
        point: Vec2,
        touch: Vec2,
        bounds: &mut Bounds,
    ) -> Pressed {
        let (number, node, body) = element;
        let pair = model.pair(number);
        let length = tributary_length(model, &pair, node as usize);
        let Some(on) = self.stresses.of_body[body] else { return Pressed::default() };
        let envelope = &mut self.stresses.envelopes[on];
        if !envelope.is_on_nodes() {
            return Pressed { on, length, points: envelope.place(point, length, bounds) };
        }
        bounds.above = true;
        let known = self.on_racks.entry(element).or_insert_with(|| {
            let sets = &model.bodies()[pair.contactor].nodes;
            let fixed = |set: &Nodes<Planar>| matches!(set, Nodes::Fixed(_));
            if body == pair.contactor && fixed(&sets[pair.nodes]) {
                // The points of a rack begin with those of its fixed nodes, one set after the other.
                let before = sets[..pair.nodes].iter().filter(|set| fixed(set)).map(Nodes::count);
                return before.sum::<usize>() + node as usize;
            }
            let placed = &model.bodies()[pair.target].surfaces[pair.surface];
            let normal = placed.rotation.apply(placed.surface.gap(touch).normal);
            // The first normal is kept, because racks turn by only a few degrees while they stand.
            let normal = if body == pair.target { normal } else { -normal };
            envelope.push(BoundaryPoint { position: point, normal, coordinate: point.x }, length);
            envelope.points.len() - 1
        });
        Pressed { on, length, points: *known..*known + 1 }
    }
}

impl Stresses {
    /// Raises an envelope to the stress that a contact with the given force (N) causes.
    fn raise(&mut self, pressed: &Pressed, force: f64) {
        if force <= 0.0 {
            return;
        }
        let stress = force / pressed.length;
        let peaks = &mut self.envelopes[pressed.on].peak_whole_run;
        let count = peaks.len();
        for point in pressed.points.clone() {
            let peak = &mut peaks[if point < count { point } else { point - count }];
            *peak = peak.max(stress);
        }
    }
}

impl StressEnvelope {
    /// Adds a point with the given tributary length (m) and zero stress.
    fn push(&mut self, point: BoundaryPoint, length: f64) {
        self.points.push(point);
        self.lengths.push(length);
        self.at_rest.push(0.0);
        self.peak.push(0.0);
        self.peak_whole_run.push(0.0);
    }
}
