//! Normal contact stress along the boundary of every barrel and rack: at rest, and the largest while
//! the stack stands.
//!
//! In a planar model stress is force per length of boundary (N/m): the force of a node over the
//! length that the node stands for.
//! A rack's stress sits at its nodes, and where it is touched exactly, at the places where something
//! presses at rest. On a barrel it sits wherever a node presses, so the barrel's
//! boundary is divided into cells, and a node presses on all the cells of its own length.

mod places;

use std::f64::consts::TAU;
use std::ops::Range;

use barrelstack_dynamics::forces::tributary_length;
use barrelstack_dynamics::lanes::{Lanewise, put_truth};
use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Nodes, Planar, Scratch, Vec2, lanewise, math};

use crate::assemble::{Assembly, PartKind};

use places::{on_nodes, on_surface};

/// Cells around a barrel in transverse section: half a degree each.
const CELLS: usize = 720;

/// A place on a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint {
    /// Position (m) in the body frame.
    pub position: Vec2,
    /// Unit normal out of the body.
    pub normal: Vec2,
    /// Coordinate along the boundary: angle (rad) from `x` on a circle, `x` (m) elsewhere.
    pub coordinate: f64,
}

/// Stress along one boundary.
#[derive(Clone, Debug)]
pub struct StressEnvelope {
    /// The body.
    pub body: BodyId,
    /// Where the values are.
    pub points: Vec<BoundaryPoint>,
    /// Length of boundary (m) that each value holds for.
    pub lengths: Vec<f64>,
    /// Whether the last point is next to the first.
    pub closed: bool,
    /// At rest (N/m).
    pub at_rest: Vec<f64>,
    /// Largest while the stack stood (N/m).
    pub peak: Vec<f64>,
    /// How the points of a contact are found among them.
    cells: Cells,
}

#[derive(Clone, Copy, Debug)]
enum Cells {
    /// By angle around a circle of this radius (m).
    Around(f64),
    /// By `x` along the upper and then the lower half of a profile of this half length (m).
    Along(f64),
    /// One for every node, and every place that is pressed at rest.
    Nodes,
}

impl StressEnvelope {
    /// Whether the values sit at nodes of the body, and not in cells along its whole boundary.
    pub fn is_on_nodes(&self) -> bool {
        matches!(self.cells, Cells::Nodes)
    }

    /// Largest stress while the stack stood over the largest at rest; none where nothing pressed.
    pub fn amplification(&self) -> Option<f64> {
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let at_rest = most(&self.at_rest);
        (at_rest > 0.0).then(|| most(&self.peak) / at_rest)
    }

    /// Sum of the largest stresses over the sum of those at rest, where something presses at rest:
    /// the average amplification of the loaded boundary.
    pub fn mean_amplification(&self) -> Option<f64> {
        let loaded = || self.at_rest.iter().zip(&self.peak).filter(|(rest, _)| **rest > 0.0);
        let at_rest: f64 = loaded().map(|(rest, _)| rest).sum();
        (at_rest > 0.0).then(|| loaded().map(|(_, peak)| peak).sum::<f64>() / at_rest)
    }
}

/// Stress along all boundaries.
#[derive(Clone, Debug, Default)]
pub struct Stresses {
    /// One envelope for every barrel and rack, in the order of the bodies.
    pub envelopes: Vec<StressEnvelope>,
    /// Index of a body's envelope.
    of_body: Vec<Option<usize>>,
    /// Where every node of every pair presses; one entry per node, pair after pair.
    presses: Vec<LoadedNode>,
}

/// Where a node presses.
#[derive(Clone, Debug)]
struct LoadedNode {
    /// Length (m) that the node stands for.
    length: f64,
    /// The cells of the target; past the last one they go on with the first.
    cells: Range<usize>,
    /// The place on a rack: its envelope, and which of its points.
    on_rack: Option<(usize, usize)>,
}

/// How hard a node has pressed in one place.
///
/// As long as the companion point stays there, the node presses on the same cells, and the largest of its
/// forces tells all: most contacts of most steps are done with a few comparisons.
#[derive(Clone, Copy, Debug)]
struct Bounds<R: Real = f64> {
    /// The first point or direction, and that past the last one.
    from: Vec2<R>,
    to: Vec2<R>,
    /// Whether the place is above the axis.
    above: R::Mask,
    /// The largest force (N) there.
    most: R,
}

/// Companion points that press on the same cells.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// All points: the target has no cells.
    Everywhere,
    /// Those between two directions, counterclockwise.
    Wedge,
    /// Those between two values of `x` (m) above the axis, or below it.
    Strip,
}

lanewise!(struct Bounds<R> { from, to, most } masks { above });

impl Place {
    /// Where the nodes press that face a target with such cells.
    fn on(cells: Option<Cells>) -> Self {
        match cells {
            Some(Cells::Around(_)) => Self::Wedge,
            Some(Cells::Along(_)) => Self::Strip,
            // The nodes of a rack press on others; what presses on them leaves no stress.
            Some(Cells::Nodes) | None => Self::Everywhere,
        }
    }
}

impl Bounds {
    /// Those of a node that has pressed with a force (N) at most, and of which no place but everywhere holds the point.
    fn of(most: f64) -> Self {
        Self { from: Vec2::default(), to: Vec2::default(), above: false, most }
    }
}

impl<R: Real> Bounds<R> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    fn hold(&self, place: Place, point: Vec2<R>) -> R::Mask {
        let Self { from, to, above, .. } = *self;
        match place {
            Place::Everywhere => !R::Mask::default(),
            Place::Wedge => {
                (from.z * point.x).le(from.x * point.z) & (point.z * to.x).lt(point.x * to.z)
            }
            Place::Strip => {
                let upper = R::zero().le(point.z);
                let side = (upper & above) | (!upper & !above);
                from.x.le(point.x) & point.x.lt(to.x) & side
            }
        }
    }
}

/// Follows the stresses of a run, or of as many runs as there are lanes; sees every step.
#[derive(Clone, Debug)]
pub(crate) struct StressWatch<R: Real = f64> {
    /// The stresses in every lane; nothing where there is no run.
    lanes: Vec<Stresses>,
    /// The lanes that have a run.
    watched: R::Mask,
    /// One for every node of every pair, pair after pair.
    bounds: Vec<Bounds<R>>,
    pairs: Vec<Facing>,
}

/// What all nodes of a pair have in common.
#[derive(Clone, Copy, Debug)]
struct Facing {
    /// The entry of the first of them.
    first: usize,
    target: BodyId,
    place: Place,
}

impl StressWatch {
    /// Starts with the stresses at rest in `scratch`.
    pub(crate) fn new(assembly: &Assembly, scratch: &Scratch<Planar>) -> Self {
        let model = &assembly.model;
        let mut envelopes: Vec<StressEnvelope> = Vec::new();
        let mut of_body = vec![None; assembly.parts.len()];
        for (i, part) in assembly.parts.iter().enumerate() {
            let body = &model.bodies()[i];
            let made = match part.kind {
                PartKind::Barrel => body.surfaces.first().and_then(|placed| {
                    // Most barrels are alike, and so are the cells along their boundaries.
                    let alike = |known: &&StressEnvelope| {
                        let other = model.bodies()[known.body].surfaces.first();
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
        let (mut presses, mut bounds, mut pairs) = (Vec::new(), Vec::new(), Vec::new());
        if envelopes.is_empty() {
            // As in a free scene, whose pairs may be more than can be listed.
            let lanes = vec![Stresses { envelopes, of_body, presses }];
            return Self { lanes, watched: false, bounds, pairs };
        }
        for pair in model.pairs() {
            let cells = of_body[pair.target].map(|at: usize| envelopes[at].cells);
            let (first, target, place) = (presses.len(), pair.target, Place::on(cells));
            pairs.push(Facing { first, target, place });
            let sets = &model.bodies()[pair.contactor].nodes;
            // The points of a rack are those of its fixed nodes, set after set.
            let fixed = |set: &Nodes<Planar>| matches!(set, Nodes::Fixed(_));
            let before =
                sets[..pair.nodes].iter().filter(|set| fixed(set)).map(Nodes::count).sum::<usize>();
            let rack = of_body[pair.contactor]
                .filter(|at: &usize| fixed(&sets[pair.nodes]) && envelopes[*at].is_on_nodes());
            presses.extend((0..sets[pair.nodes].count()).map(|node| LoadedNode {
                length: tributary_length(model, &pair, node),
                cells: 0..0,
                on_rack: rack.map(|at| (at, before + node)),
            }));
            bounds.resize(presses.len(), Bounds::of(0.0));
        }
        for contact in &scratch.contacts {
            let pair = &model.pair(contact.pair);
            let press = &mut presses[pairs[contact.pair].first + contact.node as usize];
            let placed = &model.bodies()[pair.target].surfaces[pair.surface];
            let place = placed.offset + placed.rotation.apply(contact.point);
            let normal = placed.rotation.apply(contact.normal);
            let rack = |body: BodyId| of_body[body].filter(|at| envelopes[*at].is_on_nodes());
            let found = match (rack(pair.target), rack(pair.contactor), press.on_rack) {
                (_, _, Some(_)) | (None, None, None) => None,
                (Some(at), _, None) => Some((at, place, normal)),
                (None, Some(at), None) => {
                    // The target stands still at rest, and so the place is that on the rack.
                    let [rack, target] =
                        [pair.contactor, pair.target].map(|id| model.bodies()[id].pose.position);
                    Some((at, target + place - rack, -normal))
                }
            };
            if let Some((at, position, normal)) = found {
                let envelope = &mut envelopes[at];
                press.on_rack = Some((at, envelope.points.len()));
                envelope.points.push(BoundaryPoint { position, normal, coordinate: position.x });
                envelope.lengths.push(press.length);
                envelope.at_rest.push(0.0);
                envelope.peak.push(0.0);
            }
        }
        let lanes = vec![Stresses { envelopes, of_body, presses }];
        let mut pressing = Self { lanes, watched: true, bounds, pairs };
        pressing.observe(true, scratch);
        pressing.raise(0);
        for envelope in &mut pressing.lanes[0].envelopes {
            envelope.at_rest.clone_from(&envelope.peak);
        }
        pressing
    }
}

impl<R: Real> StressWatch<R> {
    /// Watches nothing yet.
    pub(crate) fn nothing() -> Self {
        let lanes = vec![Stresses::default(); R::LANES];
        Self { lanes, watched: R::Mask::default(), bounds: Vec::new(), pairs: Vec::new() }
    }

    /// Puts a run into a lane; all runs that are watched together are of one topology.
    pub(crate) fn begin(&mut self, lane: usize, mut single: StressWatch) {
        if self.bounds.is_empty() {
            self.bounds = Lanewise::in_all(&single.bounds);
        } else {
            self.bounds.put(lane, &single.bounds);
        }
        put_truth(&mut self.watched, lane, single.watched);
        self.lanes[lane] = single.finish(0);
        self.pairs = single.pairs;
    }

    /// The stresses of the run of a lane, which is watched no more.
    pub(crate) fn finish(&mut self, lane: usize) -> Stresses {
        self.raise(lane);
        put_truth(&mut self.watched, lane, false);
        std::mem::take(&mut self.lanes[lane])
    }

    /// Raises the envelopes of a lane to what its nodes have pressed where they are.
    fn raise(&mut self, lane: usize) {
        for (pair, facing) in self.pairs.iter().enumerate() {
            let end = self.pairs.get(pair + 1).map_or(self.bounds.len(), |next| next.first);
            for at in facing.first..end {
                self.lanes[lane].raise(at, facing.target, self.bounds[at].most.lane(lane));
            }
        }
    }

    /// Sees the stresses of an accepted state, in lanes whose stack stands.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub(crate) fn observe(&mut self, standing: R::Mask, scratch: &Scratch<Planar<R>>) {
        let watched = standing & self.watched;
        if !watched.any() {
            return;
        }
        for pressed in &scratch.pressed {
            let Facing { first, target, place } = self.pairs[pressed.pair];
            let at = first + pressed.node as usize;
            let bounds = &mut self.bounds[at];
            let presses = watched & pressed.touching;
            let here = presses & bounds.hold(place, pressed.point);
            let more = here & bounds.most.lt(pressed.normal_force);
            if more.any() {
                bounds.most = R::select(more, pressed.normal_force, bounds.most);
            }
            let leaves = presses & !here;
            if leaves.any() {
                for lane in (0..R::LANES).filter(|lane| leaves.lane(*lane)) {
                    let (stresses, most) = (&mut self.lanes[lane], bounds.most.lane(lane));
                    stresses.raise(at, target, most);
                    let mut single = Bounds::of(pressed.normal_force.lane(lane));
                    stresses.place(at, target, pressed.point.of_lane(lane), &mut single);
                    bounds.put(lane, &single);
                }
            }
        }
    }
}

impl Stresses {
    /// The envelope of a body.
    pub fn of(&self, body: BodyId) -> Option<&StressEnvelope> {
        self.of_body.get(body).copied().flatten().map(|at| &self.envelopes[at])
    }

    /// Finds the cells on which a node presses at a point (m) of its target.
    fn place(&mut self, at: usize, target: BodyId, point: Vec2, bounds: &mut Bounds) {
        if let Some(on) = self.of_body[target] {
            let press = &mut self.presses[at];
            press.cells = self.envelopes[on].place(point, press.length, bounds);
        }
    }

    /// Raises the envelopes to the stress of a node that presses with a force (N).
    fn raise(&mut self, at: usize, target: BodyId, force: f64) {
        if force <= 0.0 {
            return;
        }
        let press = &self.presses[at];
        let stress = force / press.length;
        if let Some(on) = self.of_body[target] {
            let peaks = &mut self.envelopes[on].peak;
            let count = peaks.len();
            for cell in press.cells.clone() {
                let peak = &mut peaks[if cell < count { cell } else { cell - count }];
                *peak = peak.max(stress);
            }
        }
        if let Some((on, point)) = press.on_rack {
            let peak = &mut self.envelopes[on].peak[point];
            *peak = peak.max(stress);
        }
    }
}

impl StressEnvelope {
    /// The cells on which a node of a length (m) presses around a companion point (m); `bounds` are left to
    /// hold the points for which they stay the same.
    fn place(&self, point: Vec2, length: f64, bounds: &mut Bounds) -> Range<usize> {
        match self.cells {
            Cells::Around(radius) => {
                let count = self.peak.len() as f64;
                let width = TAU / count;
                let angle = math::atan2(point.z, point.x).rem_euclid(TAU);
                let (first, last, from, to) = span(angle, length / radius, width);
                let direction = |angle: f64| {
                    let (sin, cos) = math::sin_cos(angle);
                    Vec2::new(cos, sin)
                };
                let first_cell = whole(first.rem_euclid(count));
                let cells = whole((last - first + 1.0).min(count));
                (bounds.from, bounds.to) = (direction(from), direction(to));
                first_cell..first_cell + cells
            }
            Cells::Along(half_length) => {
                let cells = self.peak.len() / 2;
                let most = cells as f64 - 1.0;
                let width = 2.0 * half_length / cells as f64;
                let (first, last, from, to) = span(point.x + half_length, length, width);
                let first = whole(first.clamp(0.0, most));
                let last = whole(last.clamp(0.0, most));
                bounds.above = point.z >= 0.0;
                (bounds.from.x, bounds.to.x) = (from - half_length, to - half_length);
                let side = if bounds.above { 0 } else { cells };
                side + first..side + last + 1
            }
            Cells::Nodes => 0..0,
        }
    }
}

/// The first and the last cell of a width whose middle is covered by a length about a coordinate (at
/// least one), and the coordinates from which and up to which that stays so.
fn span(coordinate: f64, length: f64, width: f64) -> (f64, f64, f64, f64) {
    let half = 0.5 * length;
    let first = ((coordinate - half) / width + 0.5).floor();
    let last = ((coordinate + half) / width - 0.5).floor();
    let from = ((first - 0.5) * width + half).max((last + 0.5) * width - half);
    let to = ((first + 0.5) * width + half).min((last + 1.5) * width - half);
    (first, last.max(first), from, to)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between zero and the number of cells"
)]
fn whole(number: f64) -> usize {
    number as usize
}
