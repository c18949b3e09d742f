//! Assembly of a free scene: arbitrary planar bodies on the ground.

use std::collections::HashMap;
use std::mem::discriminant;
use std::ops::Range;

use barrelstack_dynamics::shape::{BarrelProfile, Circle, Cradle, Polygon};
use barrelstack_dynamics::space::Space;
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Counts, Element, Guide, Link, Model, Motion, Node, Nodes, Placed,
    Planar, Pose, Rod, Shape, State, Strap, Twist, Vec2,
};

use super::bundle::Bundle;
use super::interfaces::interface;
use super::{AssembleError, Assembly, Part, PartKind, Similitude, outline_of};
use crate::device::FREE;
use crate::scenario::element::{ElementLaw, FreeElement};
use crate::scenario::{self, FreeBody, FreeInterface, FreeScene};

/// Builds the model of a free scene.
pub(super) fn assemble(
    scene: &FreeScene,
    gravity: f64,
    scale: Similitude,
) -> Result<Assembly, AssembleError> {
    let mut bodies = vec![Body::ground(scene.ground.slope)];
    let mut parts = vec![Part::ground()];
    let mut outer = vec![Outer {
        group: None,
        boundaries: vec![Boundary { kind: &scene.ground.kind, surfaces: 0..1, nodes: 0..0 }],
    }];
    for body in &scene.bodies {
        let (body_of_model, part, of_body) = free_body(body, scale)?;
        bodies.push(body_of_model);
        parts.push(part);
        outer.push(of_body);
    }
    let law = |law: &FreeInterface| interface(&law.between.join("-"), &law.law, Bundle::ONE, scale);
    let interfaces = scene.interfaces.iter().map(law).collect();
    let kinds = kinds(scene, &bodies, &outer);
    let gravity = Vec2::new(0.0, -gravity);
    let meet = |bodies: &[Body<Planar>], between| pairs(scene, between, bodies, &outer);
    let mut model = Model::of_kinds(bodies, interfaces, kinds, &meet, gravity)?;
    let start = State::initial(&model);
    let elements = scene.elements.iter().map(|spec| element(spec, scene, &start, scale));
    model.fasten(elements.collect())?;
    Ok(Assembly {
        model,
        parts,
        loose: Vec::new(),
        step: f64::INFINITY,
        devices: vec![&FREE; scene.elements.len()],
        height: 0.0,
        levels: 0,
        view: None,
        stave_capacity: f64::INFINITY,
        rack_reach: 0.0,
    })
}

/// Returns a force element between two bodies. If no length is stated, the length is the initial distance between the
/// ends of the element.
fn element(
    spec: &FreeElement,
    scene: &FreeScene,
    start: &State<Planar>,
    scale: Similitude,
) -> Element<Planar> {
    let place = |name: &String, point: [f64; 2]| {
        let point = Vec2::new(point[0], point[1]) * scale.length;
        // The ground is body 0, and its frame is that of the scene.
        match scene.bodies.iter().position(|body| body.name == *name) {
            Some(at) => {
                let [x, z] = scene.bodies[at].center_of_mass;
                (at + 1, point - Vec2::new(x, z) * scale.length)
            }
            None => (Assembly::GROUND, point),
        }
    };
    let [first, second] =
        [(0, spec.at), (1, spec.to)].map(|(end, point)| place(&spec.between[end], point));
    let link =
        Link { name: spec.name.clone(), bodies: [first.0, second.0], points: [first.1, second.1] };
    let never = |force: Option<f64>| force.map_or(f64::INFINITY, |it| it * scale.force());
    let spring = |it: f64| it * scale.stiffness(1.0, false);
    let damper = |it: f64| it * scale.damping(false);
    let (stiffness, damping) = (spring(spec.stiffness), damper(spec.damping));
    let length = match spec.kind {
        ElementLaw::Strap { length, .. } | ElementLaw::Rod { length, .. } => length,
        ElementLaw::Guide { .. } => None,
    };
    let mut element: Element<Planar> = match spec.kind {
        ElementLaw::Strap { yields_at, strength, .. } => {
            let (yields_at, strength) = (never(yields_at), never(strength));
            Strap { link, length: 0.0, stiffness, damping, yields_at, strength }.into()
        }
        ElementLaw::Rod { sway_damping, .. } => {
            let sway_damping = damper(sway_damping);
            Rod { link, length: 0.0, stiffness, damping, sway_damping }.into()
        }
        ElementLaw::Guide { axis, gap, stop_stiffness, stop_damping, strength, reach } => Guide {
            gap: gap.map_or(f64::INFINITY, |gap| gap * scale.length),
            stop_stiffness: spring(stop_stiffness),
            stop_damping: damper(stop_damping),
            strength: never(strength),
            reach: reach.map_or(f64::INFINITY, |reach| reach * scale.length),
            ..Guide::spring(
                link,
                <Planar as Space>::rotation(axis).apply(Vec2::new(1.0, 0.0)),
                stiffness,
                damping,
            )
        }
        .into(),
    };
    let span = element.link().span(start);
    element.fit(start, length.map_or(0.0, |length| length * scale.length - span));
    element
}

/// Group and boundaries of a body. Bodies of the same group touch only through interfaces that act within groups.
struct Outer<'a> {
    group: Option<&'a str>,
    boundaries: Vec<Boundary<'a>>,
}

/// A boundary of a body: its kind, and the index ranges of its surfaces and of its node sets.
///
/// Every part of the boundary has one surface. If a rule places the nodes, every part also has one node set, and both
/// ranges list the parts in the same order. Nodes at individually chosen points form a single node set that belongs to
/// no part.
struct Boundary<'a> {
    kind: &'a str,
    surfaces: Range<usize>,
    nodes: Range<usize>,
}

impl Boundary<'_> {
    /// Returns the index of the node set on the same part as a surface; `None` if the nodes are at individually chosen
    /// points.
    fn nodes_of(&self, surface: usize) -> Option<usize> {
        let at = self.nodes.start + surface - self.surfaces.start;
        (self.nodes.len() == self.surfaces.len()).then_some(at)
    }

    /// Returns the index of the surface on the same part as a node set.
    fn surface_of(&self, nodes: usize) -> usize {
        self.surfaces.start + nodes - self.nodes.start
    }
}

/// Divides the bodies into classes, and returns the class number of each body. Bodies of the same class form the same
/// contact pairs with any other body.
fn kinds(scene: &FreeScene, bodies: &[Body<Planar>], outer: &[Outer<'_>]) -> Vec<usize> {
    let grouped = scene.interfaces.iter().any(|interface| !interface.within_groups);
    let mut known = HashMap::new();
    let kind = |(body, outer): (&Body<Planar>, &Outer<'_>)| {
        let surfaces = body.surfaces.iter().map(|placed| discriminant(&placed.surface));
        let of = |b: &Boundary<'_>| (b.kind.to_owned(), b.surfaces.clone(), b.nodes.clone());
        let key = (
            body.motion,
            outer.group.filter(|_| grouped).map(str::to_owned),
            outer.boundaries.iter().map(of).collect::<Vec<_>>(),
            surfaces.collect::<Vec<_>>(),
            body.nodes.iter().map(discriminant).collect::<Vec<_>>(),
        );
        let next = known.len();
        *known.entry(key).or_insert(next)
    };
    bodies.iter().zip(outer).map(kind).collect()
}

/// Returns the contact pairs of two bodies. Each pair tests the nodes of one boundary against the surface of another.
///
/// The first kind of an interface provides the nodes, and the second kind provides the surface. If both kinds are the
/// same, two boundaries form two pairs, so that the nodes of each are tested against the surface of the other. Two
/// convex boundaries with the rule [`Exact`](scenario::Nodes::Exact) also form two pairs. With the rules `Exact` and
/// `Rolling`, a circle has a single node, its deepest point. Two such circles, or such a circle and a convex boundary
/// with the rule `Exact`, therefore form one pair only.
fn pairs(
    scene: &FreeScene,
    between: [BodyId; 2],
    bodies: &[Body<Planar>],
    outer: &[Outer<'_>],
) -> Vec<ContactPair> {
    let [one, other] = between;
    let mut pairs = Vec::new();
    if [one, other].iter().all(|id| bodies[*id].motion == Motion::Prescribed) {
        return pairs;
    }
    let together = outer[one].group.is_some() && outer[one].group == outer[other].group;
    for (interface, law) in scene.interfaces.iter().enumerate() {
        if together && !law.within_groups {
            continue;
        }
        for [contactor, target] in [[one, other], [other, one]] {
            let of = |id: BodyId, kind: &String| {
                let kind = kind.clone();
                outer[id].boundaries.iter().filter(move |boundary| boundary.kind == kind)
            };
            for own in of(contactor, &law.between[0]) {
                for theirs in of(target, &law.between[1]) {
                    let mut add = |contactor, nodes, target, surface| {
                        let counts = Counts::Everywhere;
                        pairs.push(ContactPair {
                            contactor,
                            nodes,
                            target,
                            surface,
                            interface,
                            counts,
                        });
                    };
                    for nodes in own.nodes.clone() {
                        for surface in theirs.surfaces.clone() {
                            let back = theirs.nodes_of(surface);
                            let back = back.map(|at| (at, &bodies[target].nodes[at]));
                            match (&bodies[contactor].nodes[nodes], back) {
                                (Nodes::Rounds(_), Some((back, Nodes::Rolling { .. }))) => {
                                    add(target, back, contactor, own.surface_of(nodes));
                                }
                                (Nodes::Rounds(_), Some((back, Nodes::Rounds(_)))) => {
                                    add(contactor, nodes, target, surface);
                                    add(target, back, contactor, own.surface_of(nodes));
                                }
                                (Nodes::Rolling { .. }, Some((_, Nodes::Rolling { .. })))
                                    if law.between[0] == law.between[1] && contactor > target => {}
                                _ => add(contactor, nodes, target, surface),
                            }
                        }
                    }
                }
            }
        }
    }
    pairs
}

fn free_body(
    body: &FreeBody,
    scale: Similitude,
) -> Result<(Body<Planar>, Part, Outer<'_>), AssembleError> {
    let length = scale.length;
    let vector = |v: [f64; 2]| Vec2::new(v[0], v[1]) * length;
    let center = vector(body.center_of_mass);
    let rotation = <Planar as Space>::rotation(body.angle);
    let mut part = Part::alone(&body.name, PartKind::Body);
    let (mut surfaces, mut node_sets) = (Vec::new(), Vec::new());
    let mut boundaries = Vec::new();
    for (kind, outline, rule) in body.outer() {
        let (first_surface, first_nodes) = (surfaces.len(), node_sets.len());
        for piece in outline.iter().flat_map(|outline| outline.parts()) {
            let surface = shape(&body.name, &piece.shape, length)?;
            let offset = vector(piece.offset) - center;
            let rotation = <Planar as Space>::rotation(piece.turn);
            let placed = Placed { surface, offset, rotation };
            part.outlines.push(outline_of(&placed));
            if let Some(nodes) = nodes(rule, &placed, length) {
                node_sets.push(nodes);
            }
            surfaces.push(placed);
        }
        if let scenario::Nodes::At(list) = rule {
            let node = |node: &scenario::ChosenNode| {
                let position = vector(node.at) - center;
                let outward = |placed: &Placed<Planar>| {
                    let within = placed.rotation.unapply(position - placed.offset);
                    placed.surface.outward(within).map(|outward| placed.rotation.apply(outward))
                };
                Node {
                    position,
                    tributary_length: node.tributary_length * length,
                    outward: surfaces[first_surface..].iter().find_map(outward),
                }
            };
            node_sets.push(Nodes::Fixed(list.iter().map(node).collect()));
        }
        boundaries.push(Boundary {
            kind,
            surfaces: first_surface..surfaces.len(),
            nodes: first_nodes..node_sets.len(),
        });
    }
    let points = part.outlines.iter().flat_map(|outline| &outline.points);
    part.size = points.map(|p| p.length()).fold(0.0, f64::max);
    let damping = body.viscous.map(|viscous| {
        let linear = viscous.linear * scale.damping(false);
        let angular = viscous.angular * scale.damping(false) * length * length;
        [[linear, 0.0, 0.0], [0.0, linear, 0.0], [0.0, 0.0, angular]]
    });
    let outer = Outer { group: body.group.as_deref(), boundaries };
    let body = Body {
        name: body.name.clone(),
        motion: if body.fixed_to_ground { Motion::Prescribed } else { Motion::Free },
        mass: body.mass * scale.mass(),
        inertia: body.inertia * scale.inertia(),
        damping,
        pose: Pose {
            position: vector(body.position) + rotation.apply(center),
            orientation: body.angle,
        },
        twist: Twist {
            linear: Vec2::new(body.velocity[0], body.velocity[1]) * scale.time(),
            angular: body.spin / scale.time(),
        },
        surfaces,
        nodes: node_sets,
        faces: Vec::new(),
    };
    Ok((body, part, outer))
}

fn shape(body: &str, shape: &scenario::Shape, length: f64) -> Result<Shape, AssembleError> {
    let refuse = |problem: String| AssembleError::Shape { body: body.to_owned(), problem };
    Ok(match shape {
        scenario::Shape::Compound { .. } => {
            return Err(refuse("a part of a compound must not be a compound itself".into()));
        }
        scenario::Shape::Rectangle { width, height, corner_radius } => Shape::Polygon(
            Polygon::rectangle(width * length, height * length, corner_radius * length)
                .map_err(|problem| refuse(problem.to_string()))?,
        ),
        scenario::Shape::Circle { radius } => Shape::Circle(Circle { radius: radius * length }),
        scenario::Shape::Polygon { vertices } => {
            let corners: Vec<Vec2> =
                vertices.iter().map(|v| Vec2::new(v[0], v[1]) * length).collect();
            Shape::Polygon(
                Polygon::new(&corners, 0.0).map_err(|problem| refuse(problem.to_string()))?,
            )
        }
        scenario::Shape::Cradle { radius, half_angle } => {
            Shape::Cradle(Cradle::new(radius * length, *half_angle))
        }
        scenario::Shape::BarrelProfile { length: long, bilge_diameter, head_diameter } => {
            BarrelProfile::new(long * length, head_diameter * length, bilge_diameter * length)
                .map(Shape::BarrelProfile)
                .ok_or_else(|| {
                    refuse("needs 0 < head_diameter < bilge_diameter and a length".into())
                })?
        }
    })
}

/// Returns the nodes that a rule places on one part, in the body frame; `None` if the points of the nodes are chosen
/// individually.
fn nodes(rule: &scenario::Nodes, placed: &Placed<Planar>, length: f64) -> Option<Nodes<Planar>> {
    let shape = &placed.surface;
    let boundary = match (rule, shape) {
        (scenario::Nodes::At(_), _) => return None,
        (scenario::Nodes::Exact, _) | (scenario::Nodes::Rolling, Shape::Circle(_)) => {
            return Some(super::solid::boundary(placed, length));
        }
        (scenario::Nodes::Corners, Shape::Polygon(polygon)) => polygon.corner_nodes(),
        (scenario::Nodes::Spacing(spacing), _) => shape.nodes(spacing * length),
        (scenario::Nodes::Count(count), Shape::Polygon(polygon)) => {
            polygon.nodes_per_side(*count as usize)
        }
        (scenario::Nodes::Count(count), Shape::Circle(circle)) => {
            let around = std::f64::consts::TAU * circle.radius;
            shape.nodes(around / f64::from((*count).max(1)))
        }
        // On a curved shape, the count is the number of parts of the whole boundary; without a count, there are 64.
        (scenario::Nodes::Count(count), _) => {
            shape.nodes(boundary_length(shape) / f64::from((*count).max(1)))
        }
        (scenario::Nodes::Corners | scenario::Nodes::Rolling, _) => {
            shape.nodes(boundary_length(shape) / 64.0)
        }
    };
    let node = |node: barrelstack_dynamics::shape::BoundaryNode| Node {
        position: placed.offset + placed.rotation.apply(node.position),
        tributary_length: node.tributary_length,
        outward: shape.outward(node.position).map(|outward| placed.rotation.apply(outward)),
    };
    Some(Nodes::Fixed(boundary.into_iter().map(node).collect()))
}

/// Returns the length (m) of the boundary of a shape.
fn boundary_length(shape: &Shape) -> f64 {
    shape.nodes(f64::INFINITY).iter().map(|node| node.tributary_length).sum()
}
