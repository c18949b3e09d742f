//! Normal contact stress along the boundary of every barrel and rack: at rest, and the largest while
//! the stack stands.
//!
//! In a planar model stress is force per length of boundary (N/m): the force of a node over the
//! length that the node stands for.
//! A rack's stress sits at its nodes. On a barrel it sits wherever a node presses, so the barrel's
//! boundary is divided into cells, and a node presses on all the cells of its own length.

use barrelstack_dynamics::forces::{Contact, tributary_length};
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
    /// One for every node of the body's first node set.
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
}

impl Stresses {
    /// Starts with the stresses at rest in `scratch`.
    pub(super) fn new(assembly: &Assembly, scratch: &Scratch<Planar>) -> Self {
        let mut envelopes = Vec::new();
        let mut of_body = vec![None; assembly.parts.len()];
        for (i, part) in assembly.parts.iter().enumerate() {
            let body = &assembly.model.bodies()[i];
            let made = match part.kind {
                PartKind::Barrel => body.surfaces.first().and_then(|s| on_surface(i, &s.surface)),
                PartKind::Rack => on_nodes(i, &body.nodes),
                PartKind::Ground | PartKind::Body => None,
            };
            if let Some(envelope) = made {
                of_body[i] = Some(envelopes.len());
                envelopes.push(envelope);
            }
        }
        let mut stresses = Self { envelopes, of_body };
        stresses.observe(&assembly.model, scratch);
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
        for contact in &scratch.contacts {
            let pair = &model.pairs()[contact.pair];
            let length = tributary_length(model, pair, contact.node as usize);
            let stress = contact.normal_force / length;
            if let Some(at) = self.of_body[pair.target] {
                self.envelopes[at].press(contact, length, stress);
            }
            if let Some(at) = self.of_body[pair.contactor]
                && matches!(self.envelopes[at].cells, Cells::Nodes)
            {
                let peak = &mut self.envelopes[at].peak[contact.node as usize];
                *peak = peak.max(stress);
            }
        }
    }
}

impl StressEnvelope {
    /// A node of a length presses on the cells around its companion point.
    fn press(&mut self, contact: &Contact<Planar>, length: f64, stress: f64) {
        let point = contact.point;
        match self.cells {
            Cells::Around(radius) => {
                let turn = fast_angle(point) / std::f64::consts::TAU;
                let half = 0.5 * length / (radius * std::f64::consts::TAU);
                let count = self.peak.len();
                let cell = |turn: f64| (turn * count as f64).floor();
                let (first, last) = (
                    cell(turn - half + 0.5 / count as f64),
                    cell(turn + half - 0.5 / count as f64),
                );
                let mut at = first;
                while at <= last.max(first) {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "rem_euclid of a whole number below the count"
                    )]
                    let index = at.rem_euclid(count as f64) as usize;
                    self.peak[index] = self.peak[index].max(stress);
                    at += 1.0;
                }
            }
            Cells::Along(half_length) => {
                let cells = self.peak.len() / 2;
                let width = 2.0 * half_length / cells as f64;
                let from = ((point.x - 0.5 * length + half_length) / width + 0.5).floor().max(0.0);
                let to = ((point.x + 0.5 * length + half_length) / width - 0.5).floor();
                let to = to.min(cells as f64 - 1.0);
                let side = if point.z >= 0.0 { 0 } else { cells };
                let mut at = from.min(cells as f64 - 1.0);
                while at <= to.max(from) && at < cells as f64 {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "between zero and the number of cells"
                    )]
                    let index = side + at as usize;
                    self.peak[index] = self.peak[index].max(stress);
                    at += 1.0;
                }
            }
            Cells::Nodes => {}
        }
    }
}

fn empty(body: BodyId, points: Vec<BoundaryPoint>, closed: bool, cells: Cells) -> StressEnvelope {
    let count = points.len();
    let length = match cells {
        Cells::Around(radius) => std::f64::consts::TAU * radius / count as f64,
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
                    let angle = std::f64::consts::TAU * (i as f64 + 0.5) / CELLS as f64;
                    let (sin, cos) = math::sin_cos(angle);
                    let normal = Vec2::new(cos, sin);
                    BoundaryPoint {
                        position: normal * circle.radius,
                        normal,
                        coordinate: if angle > std::f64::consts::PI {
                            angle - std::f64::consts::TAU
                        } else {
                            angle
                        },
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
fn on_nodes(body: BodyId, nodes: &[Nodes<Planar>]) -> Option<StressEnvelope> {
    let Some(Nodes::Fixed(nodes)) = nodes.first() else { return None };
    let points = nodes
        .iter()
        .map(|node| BoundaryPoint {
            position: node.position,
            normal: Vec2::new(0.0, if node.position.z > 0.0 { 1.0 } else { -1.0 }),
            coordinate: node.position.x,
        })
        .collect();
    let lengths = nodes.iter().map(|node| node.tributary_length).collect();
    Some(StressEnvelope { lengths, ..empty(body, points, false, Cells::Nodes) })
}

/// The angle of a vector from `x`, between 0 and 2π, good to 2e-4 rad: fine enough to find a cell.
fn fast_angle(v: Vec2) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let (a, b) = (v.x.abs(), v.z.abs());
    let ratio = a.min(b) / a.max(b).max(f64::MIN_POSITIVE);
    let square = ratio * ratio;
    let octant = ratio
        * (0.999_866
            + square
                * (-0.330_299_5
                    + square * (0.180_141 + square * (-0.085_133 + 0.020_835_1 * square))));
    let quadrant = if b > a { FRAC_PI_2 - octant } else { octant };
    let half = if v.x < 0.0 { PI - quadrant } else { quadrant };
    if v.z < 0.0 { TAU - half } else { half }
}
