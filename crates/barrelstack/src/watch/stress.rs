//! Normal contact stress along the boundary of every barrel and rack: at rest, and the largest while
//! the stack stands.
//!
//! In a planar model stress is force per length of boundary (N/m): the force of a node over the
//! length that the node stands for.
//! A rack's stress sits at its nodes, and where it is touched exactly, at the places where something
//! presses at rest. On a barrel it sits wherever a node presses, so the barrel's
//! boundary is divided into cells, and a node presses on all the cells of its own length.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use barrelstack_dynamics::forces::tributary_length;
use barrelstack_dynamics::{BodyId, Model, Nodes, Planar, Scratch, Shape, Vec2, math};

use crate::assemble::{Assembly, PartKind};

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
#[derive(Clone, Debug)]
pub struct Stresses {
    /// One envelope for every barrel and rack, in the order of the bodies.
    pub envelopes: Vec<StressEnvelope>,
    /// Index of a body's envelope.
    of_body: Vec<Option<usize>>,
    /// Where every node of every pair presses; one entry per node, pair after pair.
    presses: Vec<Press>,
    /// The first entry of every pair.
    first_press: Vec<usize>,
}

/// Where a node presses on a target, and how hard it must press to raise an envelope.
///
/// As long as the companion point stays in one place, the node presses on the same cells, and a force
/// that does not exceed the lowest of their peaks changes nothing: most contacts of most steps are
/// done with a few comparisons.
#[derive(Clone, Debug)]
struct Press {
    /// Length (m) that the node stands for.
    length: f64,
    place: Place,
    /// The cells of the target; past the last one they go on with the first.
    cells: Range<usize>,
    /// The place on a rack: its envelope, and which of its points.
    on_rack: Option<(usize, usize)>,
    /// No force (N) up to this one raises an envelope.
    floor: f64,
}

/// Companion points that press on the same cells.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// No point yet.
    Nowhere,
    /// All points: the target has no cells.
    Everywhere,
    /// Those between two directions, counterclockwise.
    Wedge(Vec2, Vec2),
    /// Those between two values of `x` (m) above the axis, or below it.
    Strip(f64, f64, bool),
}

impl Place {
    #[inline]
    fn holds(self, point: Vec2) -> bool {
        match self {
            Self::Nowhere => false,
            Self::Everywhere => true,
            Self::Wedge(from, to) => {
                from.x * point.z >= from.z * point.x && point.x * to.z > point.z * to.x
            }
            Self::Strip(from, to, above) => {
                from <= point.x && point.x < to && (point.z >= 0.0) == above
            }
        }
    }
}

impl Stresses {
    /// Starts with the stresses at rest in `scratch`.
    pub(super) fn new(assembly: &Assembly, scratch: &Scratch<Planar>) -> Self {
        let model = &assembly.model;
        let mut envelopes = Vec::new();
        let mut of_body = vec![None; assembly.parts.len()];
        for (i, part) in assembly.parts.iter().enumerate() {
            let body = &model.bodies()[i];
            let made = match part.kind {
                PartKind::Barrel => body.surfaces.first().and_then(|s| on_surface(i, &s.surface)),
                PartKind::Rack => Some(on_nodes(i, &body.nodes)),
                PartKind::Ground | PartKind::Body => None,
            };
            if let Some(envelope) = made {
                of_body[i] = Some(envelopes.len());
                envelopes.push(envelope);
            }
        }
        let (mut presses, mut first_press) = (Vec::new(), Vec::new());
        if envelopes.is_empty() {
            // As in a free scene, whose pairs may be more than can be listed.
            return Self { envelopes, of_body, presses, first_press };
        }
        for pair in model.pairs() {
            first_press.push(presses.len());
            let sets = &model.bodies()[pair.contactor].nodes;
            // The points of a rack are those of its fixed nodes, set after set.
            let fixed = |set: &Nodes<Planar>| matches!(set, Nodes::Fixed(_));
            let before =
                sets[..pair.nodes].iter().filter(|set| fixed(set)).map(Nodes::count).sum::<usize>();
            let rack = of_body[pair.contactor]
                .filter(|at: &usize| fixed(&sets[pair.nodes]) && envelopes[*at].is_on_nodes());
            presses.extend((0..sets[pair.nodes].count()).map(|node| Press {
                length: tributary_length(model, &pair, node),
                place: Place::Nowhere,
                cells: 0..0,
                on_rack: rack.map(|at| (at, before + node)),
                floor: 0.0,
            }));
        }
        for contact in &scratch.contacts {
            let pair = &model.pair(contact.pair);
            let press = &mut presses[first_press[contact.pair] + contact.node as usize];
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
        let mut stresses = Self { envelopes, of_body, presses, first_press };
        stresses.observe(model, scratch);
        for envelope in &mut stresses.envelopes {
            envelope.at_rest.clone_from(&envelope.peak);
        }
        stresses
    }

    /// The envelope of a body.
    pub fn of(&self, body: BodyId) -> Option<&StressEnvelope> {
        self.of_body.get(body).copied().flatten().map(|at| &self.envelopes[at])
    }

    /// Raises the envelopes to the stresses of an accepted state.
    pub(super) fn observe(&mut self, model: &Model<Planar>, scratch: &Scratch<Planar>) {
        if self.envelopes.is_empty() {
            return;
        }
        for contact in &scratch.contacts {
            let press = &mut self.presses[self.first_press[contact.pair] + contact.node as usize];
            let placed = press.place.holds(contact.point);
            if placed && contact.normal_force <= press.floor {
                continue;
            }
            let pair = &model.pair(contact.pair);
            let stress = contact.normal_force / press.length;
            let mut lowest = f64::INFINITY;
            if let Some(at) = self.of_body[pair.target] {
                let envelope = &mut self.envelopes[at];
                if !placed {
                    (press.place, press.cells) = envelope.place(contact.point, press.length);
                }
                let count = envelope.peak.len();
                for cell in press.cells.clone() {
                    let peak = &mut envelope.peak[if cell < count { cell } else { cell - count }];
                    *peak = peak.max(stress);
                    lowest = lowest.min(*peak);
                }
            } else {
                press.place = Place::Everywhere;
            }
            if let Some((at, point)) = press.on_rack {
                let peak = &mut self.envelopes[at].peak[point];
                *peak = peak.max(stress);
                lowest = lowest.min(*peak);
            }
            press.floor = lowest * press.length;
        }
    }
}

impl StressEnvelope {
    /// The cells on which a node of a length (m) presses around a companion point (m), and the points
    /// for which they stay the same.
    fn place(&self, point: Vec2, length: f64) -> (Place, Range<usize>) {
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
                (Place::Wedge(direction(from), direction(to)), first_cell..first_cell + cells)
            }
            Cells::Along(half_length) => {
                let cells = self.peak.len() / 2;
                let most = cells as f64 - 1.0;
                let width = 2.0 * half_length / cells as f64;
                let (first, last, from, to) = span(point.x + half_length, length, width);
                let first = whole(first.clamp(0.0, most));
                let last = whole(last.clamp(0.0, most));
                let above = point.z >= 0.0;
                let side = if above { 0 } else { cells };
                let place = Place::Strip(from - half_length, to - half_length, above);
                (place, side + first..side + last + 1)
            }
            // Its nodes press on others; what presses on them leaves no stress.
            Cells::Nodes => (Place::Everywhere, 0..0),
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

fn empty(body: BodyId, points: Vec<BoundaryPoint>, closed: bool, cells: Cells) -> StressEnvelope {
    let count = points.len();
    let length = match cells {
        Cells::Around(radius) => TAU * radius / count as f64,
        Cells::Along(half_length) => 4.0 * half_length / count as f64,
        Cells::Nodes => 0.0,
    };
    StressEnvelope {
        body,
        points,
        lengths: vec![length; count],
        closed,
        at_rest: vec![0.0; count],
        peak: vec![0.0; count],
        cells,
    }
}

/// Cells along a surface that nodes of other bodies press on.
fn on_surface(body: BodyId, shape: &Shape) -> Option<StressEnvelope> {
    match shape {
        Shape::Circle(circle) => {
            let points = (0..CELLS)
                .map(|i| {
                    let angle = TAU * (i as f64 + 0.5) / CELLS as f64;
                    let (sin, cos) = math::sin_cos(angle);
                    let normal = Vec2::new(cos, sin);
                    BoundaryPoint {
                        position: normal * circle.radius,
                        normal,
                        coordinate: if angle > PI { angle - TAU } else { angle },
                    }
                })
                .collect();
            Some(empty(body, points, true, Cells::Around(circle.radius)))
        }
        Shape::BarrelProfile(profile) => {
            let half = profile.half_length;
            let cells = CELLS / 2;
            let mut points = Vec::new();
            for side in [1.0, -1.0] {
                for i in 0..cells {
                    let x = half * (2.0 * (i as f64 + 0.5) / cells as f64 - 1.0);
                    let z = profile.radius_at(x);
                    let up = z - profile.bilge_radius + profile.stave_radius;
                    let normal = Vec2::new(x, side * up) * (1.0 / profile.stave_radius);
                    points.push(BoundaryPoint {
                        position: Vec2::new(x, side * z),
                        normal,
                        coordinate: x,
                    });
                }
            }
            Some(empty(body, points, false, Cells::Along(half)))
        }
        Shape::HalfPlane(_) | Shape::Polygon(_) | Shape::Cradle(_) => None,
    }
}

/// One place for every node of a rack.
fn on_nodes(body: BodyId, sets: &[Nodes<Planar>]) -> StressEnvelope {
    let nodes = || {
        sets.iter().filter_map(|set| match set {
            Nodes::Fixed(nodes) => Some(nodes),
            Nodes::Rounds(_) | Nodes::Rolling { .. } => None,
        })
    };
    let points = nodes()
        .flatten()
        .map(|node| BoundaryPoint {
            position: node.position,
            normal: Vec2::new(0.0, if node.position.z > 0.0 { 1.0 } else { -1.0 }),
            coordinate: node.position.x,
        })
        .collect();
    let lengths = nodes().flatten().map(|node| node.tributary_length).collect();
    StressEnvelope { lengths, ..empty(body, points, false, Cells::Nodes) }
}
