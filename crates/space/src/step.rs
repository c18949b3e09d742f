//! Time step of a three-dimensional free scene, derived from its contacts and initial spins.

use barrelstack::RunFailure;
use barrelstack::scenario::{Method, Scenario};
use barrelstack::step::{IMPACT_SHARE, WHOLE_STEP, WHOLE_STEP_SHARE, round_down};
use barrelstack_dynamics::solid::Hull;
use barrelstack_dynamics::{
    Body, ContactPair, Interface, Model, Motion, Nodes, NormalLaw, Rotation3, Spatial, Vec3,
};

/// Time step as a fraction of the critical time step, as in the plane models.
const SHARE: f64 = 0.3;

/// Time step as a fraction of the time constant with which dampers slow a body (its effective mass divided by the
/// damping), as in the plane models.
const DAMPING_SHARE: f64 = 0.33;

/// Penetration (m) at which nonlinear contact laws are linearized, as in the plane models.
const REFERENCE: f64 = 0.01;

/// Largest time step (s), used if no contact and no spin requires a shorter one.
const LONGEST: f64 = 1e-3;

/// Largest rotation (rad) of a body during a time step at its initial spin. With this limit, the relative energy error
/// of a tumbling block stays below 3e-9.
const TURN: f64 = 5e-3;

/// Returns the time step (s) that a scenario states or, by default, a step derived from its contacts and initial spins.
pub(crate) fn time_step(scenario: &Scenario, model: &Model<Spatial>) -> Result<f64, RunFailure> {
    let rate = fastest(model, |pair| {
        let law = &model.interfaces()[pair.interface];
        law.normal.tangent_stiffness(REFERENCE).max(law.friction.stick_stiffness())
    });
    let damping =
        fastest(model, |pair| model.interfaces()[pair.interface].normal.tangent_damping(REFERENCE));
    let critical = 2.0 / rate.sqrt();
    let spins = model.bodies().iter().map(|body| body.twist.angular.length());
    let turning = TURN / spins.fold(0.0, f64::max);
    let sound = (SHARE * critical).min(DAMPING_SHARE / damping).min(turning).min(LONGEST);
    let own = round_down(sound) * scenario.run.accuracy.step();
    match scenario.run.step {
        Some(step) if step >= critical && !adapts(scenario.run.method) => Err(RunFailure::Step {
            given: 1e3 * step,
            reason: format!("the stiffest contact allows {:.2} ms at most", 1e3 * critical),
            instead: 1e3 * own,
        }),
        Some(step) => Ok(step),
        None => Ok(own),
    }
}

/// Returns the critical time step (s) of the contacts of an interface at a penetration (m).
pub(crate) fn critical_of_interface(model: &Model<Spatial>, depth: f64, interface: usize) -> f64 {
    let rate = fastest(model, |pair| {
        let law = &model.interfaces()[pair.interface].normal;
        if pair.interface == interface { law.tangent_stiffness(depth) } else { 0.0 }
    });
    2.0 / rate.sqrt()
}

fn adapts(method: Method) -> bool {
    matches!(method, Method::BogackiShampine { .. })
}

/// Returns the largest ratio of a contact constant (stiffness or damping) to the effective mass of a body, over all
/// contact pairs and their free bodies. The effective mass accounts for rotation about the center of mass, with the
/// longest lever arm of any contact.
///
/// A body may have contacts both below and above, so every constant counts twice.
fn fastest(model: &Model<Spatial>, constant: impl Fn(&ContactPair) -> f64) -> f64 {
    let mut most = 0.0_f64;
    for pair in model.pairs() {
        let bodies = [pair.contactor, pair.target].map(|id| &model.bodies()[id]);
        let constant = constant(&pair);
        for body in bodies.into_iter().filter(|body| body.motion == Motion::Free) {
            most = most.max(constant * bearing(body, &bodies[0].nodes[pair.nodes]));
        }
    }
    most
}

/// Returns twice the number of contacts of a node set that can carry load at the same time, divided by the effective
/// mass of the body at a contact (1/kg).
fn bearing(body: &Body<Spatial>, nodes: &Nodes<Spatial>) -> f64 {
    2.0 * contacts(nodes) * (1.0 / body.mass + turned(body))
}

/// Returns the time steps for contacts between free bodies and a fixed body, with the contact law `law`.
///
/// The result contains the longest time step (s) outside of impacts, the longest time step (s) during impacts, and the
/// largest penetration (m) at which the time step outside of impacts is short enough. Bodies that are not free are
/// ignored.
pub fn steps_at_fixed<'a>(
    bodies: impl Iterator<Item = &'a Body<Spatial>>,
    law: &Interface<Spatial>,
) -> [f64; 3] {
    let free = bodies.filter(|body| body.motion == Motion::Free);
    let most = free
        .flat_map(|body| body.nodes.iter().map(|nodes| bearing(body, nodes)))
        .fold(0.0, f64::max);
    let critical = |depth: f64| {
        let stiffness = law.normal.tangent_stiffness(depth).max(law.friction.stick_stiffness());
        2.0 / (most * stiffness).sqrt()
    };
    let damped = DAMPING_SHARE / (most * law.normal.tangent_damping(REFERENCE));
    if let NormalLaw::Rebound { .. } = law.normal {
        let depth = WHOLE_STEP * REFERENCE;
        let step = (WHOLE_STEP_SHARE * critical(depth)).min(damped);
        return [step, step.min(IMPACT_SHARE * critical(REFERENCE)), depth];
    }
    let step = (SHARE * critical(REFERENCE)).min(damped);
    [step, step, f64::INFINITY]
}

/// Returns the number of contacts of a node set that can carry load at the same time.
fn contacts(nodes: &Nodes<Spatial>) -> f64 {
    match nodes {
        Nodes::Whole(whole) => match whole.hull {
            Hull::Capsule(_) => 2.0,
            Hull::Barrel(_) | Hull::Block(_) => 4.0,
        },
        Nodes::Fixed(_) | Nodes::Rounds(_) | Nodes::Rolling { .. } => 1.0,
    }
}

/// Divides the square of the longest lever arm by the moment of inertia, for each principal axis of a body, and returns
/// the largest result (1/kg).
fn turned(body: &Body<Spatial>) -> f64 {
    let upright = Rotation3::identity();
    let mut most: Vec3 = Vec3::default();
    for nodes in &body.nodes {
        let (center, rows, half) = match nodes {
            Nodes::Rolling { center, radius, .. } => {
                (*center, upright.rows, Vec3::new(*radius, *radius, *radius))
            }
            Nodes::Whole(whole) => (whole.center, whole.rotation.rows, reach(&whole.hull)),
            Nodes::Fixed(_) | Nodes::Rounds(_) => continue,
        };
        let along = |row: Vec3| row.x.abs() * half.x + row.y.abs() * half.y + row.z.abs() * half.z;
        most.x = most.x.max(center.x.abs() + along(rows[0]));
        most.y = most.y.max(center.y.abs() + along(rows[1]));
        most.z = most.z.max(center.z.abs() + along(rows[2]));
    }
    let square = most.times(most);
    let levers = Vec3::new(square.y + square.z, square.z + square.x, square.x + square.y);
    let Vec3 { x, y, z } = levers.over(body.inertia);
    x.max(y).max(z)
}

/// Returns half the side lengths (m) of the bounding box of a solid.
fn reach(hull: &Hull) -> Vec3 {
    match hull {
        Hull::Capsule(tube) => Vec3::new(tube.half_length + tube.radius, tube.radius, tube.radius),
        Hull::Block(block) => {
            block.half + Vec3::new(block.rounding, block.rounding, block.rounding)
        }
        Hull::Barrel(barrel) => {
            let bilge = barrel.stave_radius - barrel.stave_offset + barrel.rounding;
            Vec3::new(barrel.half_length + barrel.rounding, bilge, bilge)
        }
    }
}
