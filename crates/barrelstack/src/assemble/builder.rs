//! The parts list of a stack: bodies in order, scaled, and which boundaries may meet.

use barrelstack_dynamics::shape::HalfPlane;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Motion, Node, Nodes, Placed, Planar, Pose, Shape, Twist, Vec2,
};

use super::{Assembly, Outline, Part, PartKind, Similitude};
use crate::scenario::{BodyOverride, StackBody, StackSpec, View};

/// The interfaces of a stack, in the order of their ids.
pub(super) const RACK_GROUND: usize = 0;
pub(super) const BARREL_RACK: usize = 1;
pub(super) const BARREL_BARREL: usize = 2;
pub(super) const BARREL_GROUND: usize = 3;
pub(super) const RACK_RACK: usize = 4;

/// A stack while it is built up.
pub(super) struct Builder<'a> {
    pub(super) spec: &'a StackSpec,
    pub(super) scale: Similitude,
    pub(super) bodies: Vec<Body<Planar>>,
    pub(super) parts: Vec<Part>,
}

/// What a view says of a body: full-scale numbers in its own frame, from its center of mass.
pub(super) struct Draft {
    pub(super) name: String,
    pub(super) kind: PartKind,
    pub(super) level: u32,
    pub(super) column: u32,
    /// Mass (kg) and moment of inertia (kg·m²).
    pub(super) mass: f64,
    pub(super) inertia: f64,
    /// Center of mass (m).
    pub(super) position: Vec2,
    /// A length that tells its size (m).
    pub(super) size: f64,
    pub(super) surfaces: Vec<(Shape, Vec2)>,
    pub(super) nodes: Vec<DraftNodes>,
    pub(super) outlines: Vec<Outline>,
    pub(super) carrier: Option<BodyId>,
    pub(super) supports: Vec<BodyId>,
}

/// A node set of a draft.
pub(super) enum DraftNodes {
    /// Positions (m) and tributary lengths (m).
    Fixed(Vec<(Vec2, f64)>),
    /// A rolling node of a circle about the center of mass, and its tributary length (m).
    Rolling(f64, f64),
}

impl<'a> Builder<'a> {
    /// A stack of nothing but the ground.
    pub(super) fn new(spec: &'a StackSpec, scale: Similitude) -> Self {
        let mut builder = Self { spec, scale, bodies: Vec::new(), parts: Vec::new() };
        builder.add_ground();
        builder
    }

    fn add_ground(&mut self) {
        self.bodies.push(Body {
            name: "ground".into(),
            motion: Motion::Prescribed,
            mass: 1.0,
            inertia: 1.0,
            damping: None,
            pose: Pose { position: Vec2::default(), orientation: 0.0 },
            twist: Twist::default(),
            surfaces: vec![Placed {
                surface: Shape::HalfPlane(HalfPlane),
                offset: Vec2::default(),
                rotation: Rotation2::identity(),
            }],
            nodes: Vec::new(),
        });
        self.parts.push(Part {
            name: "ground".into(),
            kind: PartKind::Ground,
            level: None,
            column: None,
            carrier: None,
            supports: Vec::new(),
            size: 0.0,
            outlines: vec![super::floor()],
        });
    }

    /// Adds a body, scaled; returns its id.
    pub(super) fn add(&mut self, draft: Draft) -> BodyId {
        let length = self.scale.length;
        let nodes = draft.nodes.into_iter().map(|set| match set {
            DraftNodes::Fixed(nodes) => Nodes::Fixed(
                nodes
                    .into_iter()
                    .map(|(position, tributary)| Node {
                        position: position * length,
                        tributary_length: tributary * length,
                    })
                    .collect(),
            ),
            DraftNodes::Rolling(radius, tributary) => Nodes::Rolling {
                center: Vec2::default(),
                radius: radius * length,
                tributary_length: tributary * length,
            },
        });
        let surfaces = draft.surfaces.into_iter().map(|(shape, offset)| Placed {
            surface: scaled(shape, length),
            offset: offset * length,
            rotation: Rotation2::identity(),
        });
        self.bodies.push(Body {
            name: draft.name.clone(),
            motion: Motion::Free,
            mass: draft.mass * self.scale.mass(),
            inertia: draft.inertia * self.scale.inertia(),
            damping: None,
            pose: Pose { position: draft.position * length, orientation: 0.0 },
            twist: Twist::default(),
            surfaces: surfaces.collect(),
            nodes: nodes.collect(),
        });
        let outlines = draft.outlines.into_iter().map(|outline| Outline {
            points: outline.points.into_iter().map(|p| p * length).collect(),
            closed: outline.closed,
        });
        self.parts.push(Part {
            name: draft.name,
            kind: draft.kind,
            level: Some(draft.level),
            column: Some(draft.column),
            carrier: draft.carrier,
            supports: draft.supports,
            size: draft.size * length,
            outlines: outlines.collect(),
        });
        self.bodies.len() - 1
    }

    /// What the scenario changes at one place, later entries last.
    pub(super) fn overrides(
        &self,
        body: StackBody,
        level: u32,
        column: u32,
    ) -> impl Iterator<Item = &BodyOverride> {
        self.spec.overrides.iter().filter(move |o| {
            o.body == body && o.level == level && o.column.is_none_or(|c| c == column)
        })
    }

    /// Turns the stack left to right: everything at `x` goes to `−x`.
    pub(super) fn mirror(&mut self) {
        let flip = |v: &mut Vec2| v.x = -v.x;
        for body in &mut self.bodies {
            flip(&mut body.pose.position);
            for set in &mut body.nodes {
                if let Nodes::Fixed(nodes) = set {
                    for node in nodes {
                        flip(&mut node.position);
                    }
                }
            }
            for placed in &mut body.surfaces {
                flip(&mut placed.offset);
                // Every shape of a stack is symmetric about its own frame, but for polygons.
                if let Shape::Polygon(polygon) = &placed.surface {
                    placed.surface = Shape::Polygon(polygon.mirrored());
                }
            }
        }
        for outline in self.parts.iter_mut().flat_map(|part| &mut part.outlines) {
            outline.points.iter_mut().for_each(flip);
        }
    }

    /// All boundaries that can ever meet, each with its interface.
    ///
    /// Racks carry the nodes against barrels and against each other; barrels against the ground and
    /// against barrels. Between two barrels the one with the lower id carries the nodes when they
    /// roll (the other's would say the same), and both do when their nodes are fixed.
    ///
    /// A round barrel that neither lies in a rack nor bears it meets it only in a heap, anywhere along
    /// its beam, where the rack has no nodes: there the barrel carries one that rolls, which finds the
    /// beam wherever it is.
    pub(super) fn pairs(&self) -> Vec<ContactPair> {
        let mut pairs = Vec::new();
        let mut join = |contactor: BodyId, target: BodyId, interface: usize| {
            for nodes in 0..self.bodies[contactor].nodes.len() {
                for surface in 0..self.bodies[target].surfaces.len() {
                    pairs.push(ContactPair {
                        contactor,
                        nodes,
                        target,
                        surface,
                        interface,
                        counts: Counts::Everywhere,
                    });
                }
            }
        };
        let count = self.bodies.len();
        for a in 1..count {
            let interface = match self.parts[a].kind {
                PartKind::Rack => RACK_GROUND,
                PartKind::Barrel | PartKind::Ground | PartKind::Body => BARREL_GROUND,
            };
            join(a, Assembly::GROUND, interface);
            for b in a + 1..count {
                match (self.parts[a].kind, self.parts[b].kind) {
                    (PartKind::Rack, PartKind::Rack) => {
                        join(a, b, RACK_RACK);
                        join(b, a, RACK_RACK);
                    }
                    (PartKind::Rack, _) if self.only_in_a_heap(a, b) => join(b, a, BARREL_RACK),
                    (PartKind::Rack, _) => join(a, b, BARREL_RACK),
                    (_, PartKind::Rack) if self.only_in_a_heap(b, a) => join(a, b, BARREL_RACK),
                    (_, PartKind::Rack) => join(b, a, BARREL_RACK),
                    _ => {
                        join(a, b, BARREL_BARREL);
                        if self.spec.view == View::Longitudinal {
                            join(b, a, BARREL_BARREL);
                        }
                    }
                }
            }
        }
        pairs
    }

    /// Whether a rack and a rolling barrel are no neighbors in the stack.
    fn only_in_a_heap(&self, rack: BodyId, barrel: BodyId) -> bool {
        let rolls = matches!(self.bodies[barrel].nodes.first(), Some(Nodes::Rolling { .. }));
        let carried = self.parts[barrel].carrier == Some(rack);
        rolls && !carried && !self.parts[rack].supports.contains(&barrel)
    }
}

/// A shape at another size.
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
            Shape::BarrelProfile(profile)
        }
    }
}
