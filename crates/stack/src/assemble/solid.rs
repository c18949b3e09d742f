//! Convex solids of a body, for drawing, contact and mass.

use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    Body, Face, Linear as _, Node, Nodes, Placed, Planar, Round, Shape, Vec2,
};

/// A convex part of a body at full scale, in the frame of that body's `Draft`.
pub(crate) struct Solid {
    pub(super) shape: Shape,
    /// Position (m) of the origin of the shape.
    pub(super) offset: Vec2,
    pub(super) seat: Seat,
    /// Nodes along the flat underside: positions (m) and tributary lengths (m); empty if the underside has no row of
    /// nodes.
    pub(super) below: Vec<(Vec2, f64)>,
    /// Nodes along the flat top; empty if the top has no row of nodes.
    pub(super) above: Vec<(Vec2, f64)>,
    /// Cosine of the largest angle between contact normal and face normal at which a contact still belongs to a face
    /// with nodes; see [`Face::widest`].
    pub(super) widest: f64,
    /// `true` if the solid contributes to the mass of its body.
    pub(super) weighs: bool,
    /// `true` if the solid stands beside the barrels, outside the plane of the model, and never touches a barrel.
    pub(super) out_of_plane: bool,
}

/// Role of a solid of a rack: what rests on the solid, and on what the solid itself rests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seat {
    /// No role: the solid touches other bodies in impacts only.
    None,
    /// The rack stands on this solid. The solid rests on the ground, or on the body with this index in the list of the
    /// rack's supports.
    OnSupport(usize),
    /// The rack stands on this solid. The solid rests on the ground, or on any body in the list of the rack's supports.
    OnSupports,
    /// The solid carries one barrel of the rack. The value is the index of the barrel among the barrels of the rack.
    Barrel(usize),
    /// In the plane along the barrels: the solid carries the barrel with this index, and stands on the ground or on the
    /// support below that barrel.
    Along(usize),
    /// The next rack stands on this solid.
    Rack,
}

impl Seat {
    /// Returns `true` if the rack stands on the solid.
    pub(super) fn stands(self) -> bool {
        match self {
            Self::OnSupport(_) | Self::OnSupports | Self::Along(_) => true,
            Self::None | Self::Barrel(_) | Self::Rack => false,
        }
    }
}

/// Contact data of one solid of a body. The data of the solids are in the order of the surfaces of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) seat: Seat,
    /// `true` if the solid never touches a barrel.
    pub(super) out_of_plane: bool,
    /// Index into the node sets of the body, for the whole boundary of the solid: its corners and arcs, or the single
    /// node of a circle.
    pub(super) exact: usize,
    /// The underside, if it carries nodes.
    pub(super) below: Option<NodedFace>,
    /// The top, if it carries nodes.
    pub(super) above: Option<NodedFace>,
}

/// A flat face of a solid that carries nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodedFace {
    /// Index into the node sets of the body, for the nodes along the face.
    pub(super) nodes: usize,
    /// Index into the node sets of the body, for the corners and arcs of the solid that are not ends of the face.
    pub(super) others: usize,
    /// Index into the faces of the body.
    pub(super) face: usize,
}

/// Value of [`Solid::widest`] for a face that carries a round body.
///
/// The value is below any cosine, so that contacts in every direction belong to the face, provided that the center of
/// the round body lies in front of the face.
const ROUND: f64 = -2.0;

/// Distance (m) from a face within which a corner or an arc counts as an end of the face.
const AT_END: f64 = 1e-9;

impl Solid {
    /// Creates a solid without rows of nodes along its faces.
    pub(crate) fn exact(shape: Shape, offset: Vec2, seat: Seat) -> Self {
        Self {
            shape,
            offset,
            seat,
            below: Vec::new(),
            above: Vec::new(),
            widest: ROUND,
            weighs: true,
            out_of_plane: false,
        }
    }

    /// Scales the solid by `length` and adds it to a body whose center of mass is at `center` (m) in the frame of its
    /// draft.
    pub(super) fn add_to(self, body: &mut Body<Planar>, center: Vec2, length: f64) -> Touch {
        let shape = scaled(self.shape, length);
        let offset = (self.offset - center) * length;
        let placed = Placed { surface: shape, offset, rotation: Rotation2::identity() };
        let exact = add(body, boundary(&placed, length));
        let mut face = |nodes: &[(Vec2, f64)], outward: f64| {
            let at = |(position, tributary): &(Vec2, f64)| Node {
                position: (*position - center) * length,
                tributary_length: tributary * length,
                outward: None,
            };
            let nodes: Vec<Node<Planar>> = nodes.iter().map(at).collect();
            let point = nodes.first()?.position;
            let at_end = |round: &Round<Planar>| {
                let height = outward * (round.center.z - point.z) + round.radius;
                height.abs() < AT_END * length
            };
            let others = match &body.nodes[exact] {
                Nodes::Rounds(rounds) => rounds.iter().copied().filter(|r| !at_end(r)).collect(),
                Nodes::Fixed(_) | Nodes::Rolling { .. } | Nodes::Whole(_) => Vec::new(),
            };
            body.faces.push(Face { point, outward: Vec2::new(0.0, outward), widest: self.widest });
            Some(NodedFace {
                nodes: add(body, Nodes::Fixed(nodes)),
                others: add(body, Nodes::Rounds(others)),
                face: body.faces.len() - 1,
            })
        };
        let (below, above) = (face(&self.below, -1.0), face(&self.above, 1.0));
        body.surfaces.push(placed);
        Touch { seat: self.seat, out_of_plane: self.out_of_plane, exact, below, above }
    }
}

/// Returns a row of nodes along a face at height `z` (m). The row extends `half` (m) to either side of `middle` (m),
/// with nodes at most `spacing` (m) apart.
pub(super) fn row(spacing: f64, middle: f64, half: f64, z: f64) -> Vec<(Vec2, f64)> {
    let parts = (2.0 * half / spacing - 1e-9).ceil().max(1.0);
    let step = 2.0 * half / parts;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let last = parts as u32;
    (0..=last)
        .map(|i| {
            let tributary = if i == 0 || i == last { 0.5 * step } else { step };
            (Vec2::new(middle - half + f64::from(i) * step, z), tributary)
        })
        .collect()
}

/// Adds a node set to a body and returns its index.
fn add(body: &mut Body<Planar>, nodes: Nodes<Planar>) -> usize {
    body.nodes.push(nodes);
    body.nodes.len() - 1
}

/// Length (m) of boundary, at full scale, that a contact at a corner, an arc or a circle represents.
pub(super) const TRIBUTARY: f64 = 0.01;

/// Returns the node set for the whole boundary of a part: its corners and arcs, or the single node of a circle. The
/// tributary length is [`TRIBUTARY`] scaled by `length`.
pub(super) fn boundary(placed: &Placed<Planar>, length: f64) -> Nodes<Planar> {
    let Placed { surface, offset, rotation } = placed;
    let tributary_length = TRIBUTARY * length;
    match surface {
        Shape::Circle(circle) => {
            Nodes::Rolling { center: *offset, radius: circle.radius, tributary_length }
        }
        Shape::HalfPlane(_) | Shape::Polygon(_) | Shape::Cradle(_) | Shape::BarrelProfile(_) => {
            let mut rounds = surface.rounds(tributary_length);
            for round in &mut rounds {
                round.center = *offset + rotation.apply(round.center);
                round.limits = round.limits.map(|limit| rotation.apply(limit));
                round.arc_limits =
                    round.arc_limits.map(|limit| limit.map(|limit| rotation.apply(limit)));
                for (outward, distance) in round.sides.iter_mut().flatten() {
                    *outward = rotation.apply(*outward);
                    *distance += outward.dot(*offset);
                }
            }
            Nodes::Rounds(rounds)
        }
    }
}

/// Returns the center of mass (m) and the squared radius of gyration (m²) of solids that all have the same density.
pub(super) fn uniform(solids: &[Solid]) -> (Vec2, f64) {
    let sections = || {
        solids.iter().filter(|solid| solid.weighs).filter_map(|solid| {
            solid.shape.section().map(|section| (section.centroid + solid.offset, section))
        })
    };
    let area: f64 = sections().map(|(_, section)| section.measure).sum();
    let mut center = Vec2::default();
    for (place, section) in sections() {
        center += place * (section.measure / area);
    }
    let about = |(place, section): (Vec2, barrelstack_dynamics::shape::Section)| {
        let apart = place - center;
        section.measure / area * (section.gyration_squared + apart.x * apart.x + apart.z * apart.z)
    };
    (center, sections().map(about).sum())
}

/// Returns a shape scaled by a factor.
fn scaled(shape: Shape, length: f64) -> Shape {
    if length == 1.0 {
        return shape;
    }
    match shape {
        Shape::Circle(mut circle) => {
            circle.radius *= length;
            Shape::Circle(circle)
        }
        Shape::HalfPlane(plane) => Shape::HalfPlane(plane),
        Shape::Polygon(polygon) => Shape::Polygon(polygon.scaled(length)),
        Shape::Cradle(mut cradle) => {
            cradle.radius *= length;
            Shape::Cradle(cradle)
        }
        Shape::BarrelProfile(mut profile) => {
            profile.half_length *= length;
            profile.head_radius *= length;
            profile.bilge_radius *= length;
            profile.stave_radius *= length;
            profile.rounding *= length;
            profile.corner_height *= length;
            Shape::BarrelProfile(profile)
        }
    }
}
