//! The time step when none is given: from the stiffest contact.

use barrelstack_dynamics::body::Motion;
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Element, Linear as _, Model, Nodes, NormalLaw, Planar, Shape, math,
};

use crate::assemble::Assembly;

/// Share of the critical time step of seats that is taken: accuracy asks for more than stability.
const SHARE: f64 = 0.1;

/// Share of the time 1/γ in which dampers stop a body: beyond the whole of it, velocities predicted
/// from the last step overshoot. With 0.7 some of a thousand random stacks that had come to rest
/// (`tests/settling.rs`) moved on by millimeters.
const DAMPING_SHARE: f64 = 0.33;

/// Penetration (m) of full scale at which laws that stiffen with penetration are measured.
const REFERENCE: f64 = 0.01;

/// Share of the critical time step of impacts that is taken: they are over within a few milliseconds, and
/// may not force the step of what stands. With it the cases of the paper close their energy books to 5e-5,
/// and half the step moves none of their falls by more than 0.3 ms (`tests/paper.rs`).
const IMPACT_SHARE: f64 = 0.4;

/// The time step (s): a share of the critical one, rounded down to a number that is easily said at full
/// scale; `time_scale` is that of similitude.
pub fn default_step(assembly: &Assembly, time_scale: f64) -> f64 {
    let depth = REFERENCE * time_scale * time_scale;
    let damping =
        fastest(&assembly.model, |model, pair, body| damping_rate(model, pair, body, depth))
            + of_elements(assembly, Element::damping);
    let seats = critical(assembly, depth, |law| !matches!(law, NormalLaw::Rebound { .. }));
    let step = (SHARE * seats)
        .min(IMPACT_SHARE * critical_time_step(assembly, time_scale))
        .min(DAMPING_SHARE / damping)
        / time_scale;
    let full_scale = if step.is_finite() { round_down(step) } else { 1e-3 };
    full_scale * time_scale
}

/// The critical time step (s) of what was built; infinite when nothing can touch.
///
/// For an explicit method it is 2/ω, with ω² = Σk/m for the stiffest body: the springs of all nodes of
/// one of its boundaries that face one target, over its mass, and those of its force elements.
/// Laws that stiffen count with a penetration of 1 cm at full scale; `time_scale` is that of similitude.
pub fn critical_time_step(assembly: &Assembly, time_scale: f64) -> f64 {
    critical(assembly, REFERENCE * time_scale * time_scale, |_| true)
}

/// The same for the contacts of some laws, at a penetration (m).
fn critical(assembly: &Assembly, depth: f64, of: fn(&NormalLaw) -> bool) -> f64 {
    let contacts = fastest(&assembly.model, |model, pair, body| {
        let law = &model.interfaces()[pair.interface].normal;
        if of(law) { stiffness_rate(model, pair, body, depth) } else { 0.0 }
    });
    2.0 / (contacts + of_elements(assembly, Element::stiffness)).sqrt()
}

/// The largest rate that the force elements of any body give it: the sum of a constant of theirs over its mass,
/// and over its inertia by the square of the arm.
fn of_elements(assembly: &Assembly, constant: fn(&Element<Planar>) -> f64) -> f64 {
    let mut rates = vec![0.0; assembly.parts.len()];
    let loose = assembly.loose.iter().map(|loose| &loose.element);
    for element in loose.chain(assembly.model.elements()) {
        for (id, point) in element.ends() {
            let body = &assembly.model.bodies()[id];
            rates[id] += constant(element) * (1.0 / body.mass + point.dot(point) / body.inertia);
        }
    }
    // The body at its other end may swing against it, so each counts twice.
    2.0 * rates.into_iter().fold(0.0, f64::max)
}

/// The largest rate over all pairs and their free bodies. A body is held from below and above, so each
/// counts twice.
fn fastest(
    model: &Model<Planar>,
    rate: impl Fn(&Model<Planar>, &ContactPair, &Body<Planar>) -> f64,
) -> f64 {
    let mut most = 0.0_f64;
    let bodies = model.bodies();
    model.each_meeting(&mut |pair, contactors, targets| {
        let met = |contactor, target| ContactPair { contactor, target, ..*pair };
        let free = |id: &&BodyId| bodies[**id].motion == Motion::Free;
        // What a pair does to its contactor is the same whichever target it meets.
        for id in contactors.iter().filter(free) {
            most = most.max(2.0 * rate(model, &met(*id, pair.target), &bodies[*id]));
        }
        // What it does to a target grows with a figure of the contactor: of many, the two with the largest,
        // since one may be the target itself.
        let yardstick = (contactors.len() > 1).then(|| bodies[pair.target].clone());
        let mut largest: [Option<(f64, BodyId)>; 2] = [None; 2];
        for id in contactors {
            let figure = |body| rate(model, &met(*id, pair.target), body);
            let figure = yardstick.as_ref().map_or(0.0, figure);
            let beats = |other: Option<(f64, BodyId)>| other.is_none_or(|(most, _)| most < figure);
            if beats(largest[0]) {
                largest = [Some((figure, *id)), largest[0]];
            } else if beats(largest[1]) {
                largest[1] = Some((figure, *id));
            }
        }
        for id in targets.iter().filter(free) {
            if let Some((_, other)) = largest.iter().flatten().find(|(_, other)| other != id) {
                most = most.max(2.0 * rate(model, &met(*other, *id), &bodies[*id]));
            }
        }
    });
    most
}

/// Σk/m (1/s²) of the nodes that face a target at a time: a quarter of those around a body at most.
fn stiffness_rate(
    model: &Model<Planar>,
    pair: &ContactPair,
    body: &Body<Planar>,
    depth: f64,
) -> f64 {
    let interface = &model.interfaces()[pair.interface];
    let normal = interface.normal.tangent_stiffness(depth);
    let stiffness = normal.max(interface.friction.stick_stiffness());
    facing(model, pair, 0.25) * stiffness / body.mass
}

/// Σc/m, or Σc d²/I if more (1/s), of the nodes that face a target at a time: on a flat target half of
/// those around a body, on a round one a quarter.
fn damping_rate(model: &Model<Planar>, pair: &ContactPair, body: &Body<Planar>, depth: f64) -> f64 {
    let damping = model.interfaces()[pair.interface].normal.tangent_damping(depth);
    let flat = match &model.bodies()[pair.target].surfaces[pair.surface].surface {
        Shape::HalfPlane(_) | Shape::Polygon(_) => true,
        Shape::Circle(_) | Shape::Cradle(_) | Shape::BarrelProfile(_) => false,
    };
    let contactor = &model.bodies()[pair.contactor];
    let turning = if std::ptr::eq(body, contactor) {
        mean_square_arm(&contactor.nodes[pair.nodes]) / body.inertia
    } else {
        0.0
    };
    facing(model, pair, if flat { 0.5 } else { 0.25 }) * damping * turning.max(1.0 / body.mass)
}

/// How many nodes of a pair, or meters of boundary, push at a time: a share of all, two at least.
fn facing(model: &Model<Planar>, pair: &ContactPair, share: f64) -> f64 {
    let basis = model.interfaces()[pair.interface].basis;
    let weight = |tributary: f64| basis.weight(tributary);
    match &model.bodies()[pair.contactor].nodes[pair.nodes] {
        Nodes::Fixed(nodes) => {
            let total: f64 = nodes.iter().map(|n| weight(n.tributary_length)).sum();
            let two: f64 = nodes.iter().take(2).map(|n| weight(n.tributary_length)).sum();
            (share * total).max(two)
        }
        // Two round pieces of a convex boundary at most bear at a time.
        Nodes::Rounds(rounds) => {
            rounds.iter().take(2).map(|round| weight(round.tributary_length)).sum()
        }
        Nodes::Rolling { tributary_length, .. } => weight(*tributary_length),
    }
}

/// Mean square distance (m²) of nodes from the center of mass. A rolling node turns a body by friction
/// only, which the stick bounds.
fn mean_square_arm(nodes: &Nodes<Planar>) -> f64 {
    match nodes {
        Nodes::Fixed(nodes) if !nodes.is_empty() => {
            mean_square(nodes.iter().map(|node| node.position.length()))
        }
        Nodes::Rounds(rounds) if !rounds.is_empty() => {
            mean_square(rounds.iter().map(|round| round.center.length()))
        }
        Nodes::Fixed(_) | Nodes::Rounds(_) | Nodes::Rolling { .. } => 0.0,
    }
}

fn mean_square(arms: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = arms.len() as f64;
    arms.map(|arm| arm * arm).sum::<f64>() / count
}

/// The largest of these digits times a power of ten that is not above a number.
fn round_down(value: f64) -> f64 {
    const DIGITS: [f64; 8] = [1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let power = math::pow(10.0, math::log10(value).floor());
    let digit = value / power;
    power * DIGITS.into_iter().rev().find(|kept| digit >= *kept).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::round_down;

    #[test]
    fn steps_are_round_numbers() {
        for (value, kept) in [(1.4e-4, 1e-4), (2.7e-4, 2.5e-4), (9.9e-4, 8e-4), (1.0e-3, 1e-3)] {
            assert!((round_down(value) / kept - 1.0).abs() < 1e-12, "{value}");
        }
    }
}
