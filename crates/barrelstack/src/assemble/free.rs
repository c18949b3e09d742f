//! A free scene: any planar bodies on a ground.

use barrelstack_dynamics::shape::{BarrelProfile, Circle, Cradle, Polygon};
use barrelstack_dynamics::space::Space;
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Counts, Model, Motion, Node, Nodes, Placed, Planar, Pose, Shape,
    Twist, Vec2,
};

use super::interfaces::interface;
use super::{AssembleError, Assembly, Part, PartKind, Similitude, outline_of};
use crate::scenario::{self, FreeBody, FreeScene};

/// Builds a free scene.
pub(super) fn assemble(
    scene: &FreeScene,
    gravity: f64,
    scale: Similitude,
) -> Result<Assembly, AssembleError> {
    let mut bodies = vec![Body::ground(scene.ground.slope)];
    let mut parts = vec![Part::ground()];
    let mut kinds = vec![scene.ground.kind.as_str()];
    for body in &scene.bodies {
        let (body_of_model, part) = free_body(body, scale)?;
        bodies.push(body_of_model);
        parts.push(part);
        kinds.push(body.kind.as_str());
    }
    let mut pairs = Vec::new();
    let mut interfaces = Vec::new();
    for (index, law) in scene.interfaces.iter().enumerate() {
        let [contactor_kind, target_kind] = &law.between;
        join(&bodies, &kinds, [contactor_kind.as_str(), target_kind.as_str()], index, &mut pairs);
        let name = format!("{contactor_kind}-{target_kind}");
        interfaces.push(interface(&name, &law.law, 1.0, scale));
    }
    let model = Model::new(bodies, interfaces, pairs, Vec2::new(0.0, -gravity))?;
    Ok(Assembly {
        model,
        parts,
        loose: Vec::new(),
        step: f64::INFINITY,
        devices: Vec::new(),
        height: 0.0,
        levels: 0,
        view: None,
        rack_reach: 0.0,
    })
}

/// Every body of the first kind against every one of the second.
///
/// Between bodies of one kind both carry nodes, but for two that roll, where one says it all. Convex
/// boundaries without nodes test each other both ways; against a round one, its rolling node says it all.
fn join(
    bodies: &[Body<Planar>],
    kinds: &[&str],
    between: [&str; 2],
    interface: usize,
    pairs: &mut Vec<ContactPair>,
) {
    let of =
        |kind: &str| -> Vec<BodyId> { (0..bodies.len()).filter(|i| kinds[*i] == kind).collect() };
    let mut add = |contactor: BodyId, nodes: usize, target: BodyId, surface: usize| {
        let counts = Counts::Everywhere;
        pairs.push(ContactPair { contactor, nodes, target, surface, interface, counts });
    };
    for contactor in of(between[0]) {
        for target in of(between[1]) {
            let both_fixed = bodies[contactor].motion == Motion::Prescribed
                && bodies[target].motion == Motion::Prescribed;
            if contactor == target || both_fixed {
                continue;
            }
            for (own, nodes) in bodies[contactor].nodes.iter().enumerate() {
                for surface in 0..bodies[target].surfaces.len() {
                    // Every part of a body has its nodes and its surface at one place in the lists, but
                    // chosen nodes, which come alone.
                    let theirs = bodies[target].nodes.get(surface);
                    match (nodes, theirs) {
                        (Nodes::Rounds(_), Some(Nodes::Rolling { .. })) => {
                            add(target, surface, contactor, own);
                        }
                        (Nodes::Rounds(_), Some(Nodes::Rounds(_))) => {
                            add(contactor, own, target, surface);
                            add(target, surface, contactor, own);
                        }
                        (Nodes::Rolling { .. }, Some(Nodes::Rolling { .. }))
                            if between[0] == between[1] && contactor > target => {}
                        _ => add(contactor, own, target, surface),
                    }
                }
            }
        }
    }
}

fn free_body(body: &FreeBody, scale: Similitude) -> Result<(Body<Planar>, Part), AssembleError> {
    let length = scale.length;
    let vector = |v: [f64; 2]| Vec2::new(v[0], v[1]) * length;
    let center = vector(body.center_of_mass);
    let rotation = <Planar as Space>::rotation(body.angle);
    let mut part = Part::alone(&body.name, PartKind::Body);
    let (mut surfaces, mut node_sets) = (Vec::new(), Vec::new());
    for piece in body.shape.parts() {
        let surface = shape(&body.name, &piece.shape, length)?;
        let offset = vector(piece.offset) - center;
        let placed = Placed { surface, offset, rotation: <Planar as Space>::rotation(piece.turn) };
        part.outlines.push(outline_of(&placed));
        if let Some(nodes) = nodes(&body.nodes, &placed, length) {
            node_sets.push(nodes);
        }
        surfaces.push(placed);
    }
    if let scenario::Nodes::At(list) = &body.nodes {
        let node = |node: &scenario::ChosenNode| Node {
            position: vector(node.at) - center,
            tributary_length: node.tributary_length * length,
        };
        node_sets.push(Nodes::Fixed(list.iter().map(node).collect()));
    }
    let points = part.outlines.iter().flat_map(|outline| &outline.points);
    part.size = points.map(|p| p.length()).fold(0.0, f64::max);
    let damping = body.viscous.map(|viscous| {
        let linear = viscous.linear * scale.damping(false);
        let angular = viscous.angular * scale.damping(false) * length * length;
        [[linear, 0.0, 0.0], [0.0, linear, 0.0], [0.0, 0.0, angular]]
    });
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
    Ok((body, part))
}

fn shape(body: &str, shape: &scenario::Shape, length: f64) -> Result<Shape, AssembleError> {
    let refuse = |problem: String| AssembleError::Shape { body: body.to_owned(), problem };
    Ok(match shape {
        scenario::Shape::Compound { .. } => {
            return Err(refuse("a part of a compound is a compound itself".into()));
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

/// The nodes of one part by a rule, in the body frame; none where they are chosen for the whole body.
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
        // For curved shapes a count divides the whole boundary; without one, 64 parts are fine enough.
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
    };
    Some(Nodes::Fixed(boundary.into_iter().map(node).collect()))
}

/// The length (m) of a shape's boundary.
fn boundary_length(shape: &Shape) -> f64 {
    shape.nodes(f64::INFINITY).iter().map(|node| node.tributary_length).sum()
}
