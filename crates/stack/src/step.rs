//! Default time step: set by the seats, divided during impacts.

use barrelstack_dynamics::body::Motion;
use barrelstack_dynamics::model::FORESEEN;
use barrelstack_dynamics::{
    Basis, Body, BodyId, ContactPair, Element, Linear as _, Model, Node, Nodes, NormalLaw, Planar,
    Round, Shape, Space, Substepping, math,
};

use crate::assemble::Assembly;
use crate::scenario::{FreeInterface, Method, Scenario, Scene};

/// Fraction of the critical time step of seats: accuracy requires more than stability.
const SHARE: f64 = 0.3;

/// Fraction of the time 1/γ in which dampers stop a body: beyond all of it, velocities predicted from the last step
/// overshoot. With 0.7 some of a thousand random stacks that had come to rest (`tests/settling.rs`) drifted by
/// millimeters.
const DAMPING_SHARE: f64 = 0.33;

/// Penetration (m) at full scale at which nonlinear laws are linearized.
const REFERENCE: f64 = 0.01;

/// Fraction of the critical time step of impacts, applied while they last, some milliseconds. With it the energy
/// balance of the paper's cases closes to 3e-5, and halving the step moves none of their falls by more than 0.3 ms
/// (`tests/paper.rs`).
const IMPACT_SHARE: f64 = 0.4;

/// Share of [`REFERENCE`] up to which impacts are followed with whole steps: resting contacts are below it. With it
/// the energy residual of the demo along the barrels is 1.1e-5, with four times as much 2.4e-4.
const WHOLE_STEP: f64 = 0.05;

/// Maximum fraction of the critical time step at that penetration, sticks included: bodies at rest require stability
/// alone. At twice that penetration, to which a contact at rest is followed, it is 0.83 of the critical time step,
/// since stiffness grows with the root of penetration.
const WHOLE_STEP_SHARE: f64 = 0.7;

/// Weights of the heaviest body that may rest on the lightest one through impact contacts. Their damping grows with
/// the load: beyond [`LOADED_SHARE`] of the time in which they then stop that body, heaps of racks under barrels do
/// not come to rest.
const LOAD: f64 = 3.0;
const LOADED_SHARE: f64 = 1.4;

/// Fraction of the critical time step of a contact that states a restitution, applied while it lasts: its damper engages
/// at once, somewhere within a step, which is an error of first order. With it a restitution of 0.7 is kept to 0.002,
/// of 0.3 to 0.003, besides the work of gravity during the contact.
const RESTITUTION_SHARE: f64 = 0.005;

/// Gap (m) at full scale within which such contacts are foreseen: so fast that 40 m/s are foreseen at steps of 1 ms.
const FORESEEN_REBOUND: f64 = 0.05;

/// Radius (m) above which a round piece counts as nearly straight: for contacts whose constants are stated per seat,
/// and for others. Levers of rounder ones are overestimated by up to four times; the paper's cases, whose staves are
/// such, keep their steps.
const NEARLY_STRAIGHT: (f64, f64) = (1.0, 4.0);

/// Time stepping of a stack.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeStepping {
    /// Time step (s) outside of impacts, rounded down to few digits at full scale.
    pub step: f64,
    /// Subdivision during impacts.
    pub substepping: Substepping<f64>,
}

impl TimeStepping {
    /// Computes the steps for the contacts of a model and its force elements, including `loose` ones that are not
    /// installed yet; `time_scale` is that of similitude.
    pub fn of<'a>(
        model: &'a Model<Planar>,
        loose: &(impl Iterator<Item = &'a Element<Planar>> + Clone),
        time_scale: f64,
    ) -> Self {
        let depth = REFERENCE * time_scale * time_scale;
        let elements = |constant| of_elements(model, loose.clone(), constant);
        let damping = fastest(model, |pair, body| damping_rate(model, pair, body, depth))
            + elements(Element::damping);
        let held = elements(Element::stiffness);
        let critical = |depth, of| critical(model, held, depth, of);
        let whole_step_depth = WHOLE_STEP * depth;
        let impact = IMPACT_SHARE * critical(depth, &|_| true);
        let step = (SHARE * critical(depth, &|pair| !is_impact(model, pair)))
            .min(WHOLE_STEP_SHARE * critical(whole_step_depth, &|_| true))
            .min(DAMPING_SHARE / damping)
            .min(LOADED_SHARE / loaded(model));
        let full_scale = step / time_scale;
        let full_scale = if full_scale.is_finite() { round_down(full_scale) } else { 1e-3 };
        let step = full_scale * time_scale;
        // Rounding must not divide a step that is as short as impacts require.
        let substeps = (step / impact * (1.0 - 1e-9)).ceil().max(1.0);
        let mut substepping = Substepping {
            substeps,
            whole_step_depth: vec![f64::INFINITY; model.interfaces().len()],
            resting_allowance: whole_step_depth,
            foreseen_gap: FORESEEN,
            fast: None,
        };
        model.each_meeting(&mut |pair, _, _| {
            let stop = model.interfaces()[pair.interface].stop;
            if let Some(stop) = stop {
                substepping.whole_step_depth[pair.interface] = stop.depth + whole_step_depth;
            } else if is_impact(model, pair) {
                substepping.whole_step_depth[pair.interface] = whole_step_depth;
            }
        });
        Self { step, substepping }
    }
}

/// Largest tolerance with which the adaptive method, whose steps are not divided, keeps a restitution: within 1 % of the
/// exact motion, where 1e-3 misses it by 4 %.
const KEEPS_RESTITUTION: f64 = 1e-6;

/// Returns a warning if the adaptive method is too inaccurate for the restitution that a free scene states.
pub fn restitution_warning(scenario: &Scenario) -> Option<String> {
    let Method::BogackiShampine { tolerance } = scenario.run.method else { return None };
    let laws = match &scenario.scene {
        Scene::Stack { .. } => return None,
        Scene::Free(scene) => &scene.interfaces,
        Scene::Spatial(scene) => &scene.interfaces,
    };
    let states = laws.iter().any(|law| law.law.states_restitution());
    (states && tolerance > KEEPS_RESTITUTION).then(|| {
        format!(
            "run.tolerance = {tolerance:e}: the adaptive method may miss the restitution that this \
             scene states by several percent; {KEEPS_RESTITUTION:e} keeps it"
        )
    })
}

/// Divides the steps (s) of a free scene while contacts that state a restitution are closed or about to close, so that
/// they give it back; `critical` is the critical time step (s) of the contacts of an interface at a penetration (m), and
/// `time_scale` that of similitude.
pub fn keep_restitution<S: Space<Real = f64>>(
    model: &mut Model<S>,
    laws: &[FreeInterface],
    step: f64,
    time_scale: f64,
    critical: impl Fn(&Model<S>, f64, usize) -> f64,
) {
    let depth = REFERENCE * time_scale * time_scale;
    let mut substepping = model.substepping().clone();
    for (interface, _) in laws.iter().enumerate().filter(|(_, law)| law.law.states_restitution()) {
        let shortest = RESTITUTION_SHARE * critical(model, depth, interface);
        substepping.substeps = substepping.substeps.max((step / shortest).ceil());
        substepping.whole_step_depth[interface] = 0.0;
        substepping.resting_allowance = WHOLE_STEP * depth;
        substepping.foreseen_gap = FORESEEN_REBOUND * time_scale * time_scale;
    }
    model.set_substepping(substepping);
}

/// Returns the critical time step (s) of the contacts of an interface in the plane at a penetration (m).
pub(crate) fn critical_of_interface(model: &Model<Planar>, depth: f64, interface: usize) -> f64 {
    critical(model, 0.0, depth, &|pair| pair.interface == interface)
}

/// Returns `true` if a pair meets in impacts and carries little load between them.
fn is_impact(model: &Model<Planar>, pair: &ContactPair) -> bool {
    let law = &model.interfaces()[pair.interface].normal;
    let nodes = &model.bodies()[pair.contactor].nodes[pair.nodes];
    matches!(law, NormalLaw::Rebound { .. }) && !matches!(nodes, Nodes::Fixed(_))
}

/// Returns the rate (1/s) at which impact contacts stop the lightest body of a pair under [`LOAD`].
fn loaded(model: &Model<Planar>) -> f64 {
    let bodies = model.bodies().iter().filter(|body| body.motion == Motion::Free);
    let heaviest = bodies.map(|body| body.mass).fold(0.0, f64::max);
    let load = LOAD * heaviest * model.gravity().length();
    fastest(model, |pair, body| match model.interfaces()[pair.interface].normal {
        // Derivative of the force with respect to the rate (m/s), linearized at rest.
        NormalLaw::Rebound { restitution, speed, .. } if is_impact(model, pair) => {
            let back = restitution * restitution;
            0.5 * load * (1.0 - back) / (1.0 + back) / speed / body.mass
        }
        NormalLaw::Rebound { .. }
        | NormalLaw::SpeedGap { .. }
        | NormalLaw::KelvinVoigt { .. }
        | NormalLaw::HuntCrossley { .. }
        | NormalLaw::Hertz { .. } => 0.0,
    })
}

/// Returns the critical time step (s) of an assembly, its impacts divided; infinite when nothing can touch.
///
/// For an explicit method it is 2/ω, with ω² = Σk/m for the stiffest body: the springs of all nodes of one of its
/// boundaries that face one target, over its mass, and those of its force elements. Nonlinear laws are linearized at
/// a penetration of 1 cm at full scale; `time_scale` is that of similitude.
pub fn critical_time_step(assembly: &Assembly, time_scale: f64) -> f64 {
    let model = &assembly.model;
    let depth = REFERENCE * time_scale * time_scale;
    let loose = assembly.loose.iter().map(|loose| &loose.element);
    let held = of_elements(model, loose, Element::stiffness);
    let seats = critical(model, held, depth, &|pair| !is_impact(model, pair));
    let impacts = critical(model, held, depth, &|pair| is_impact(model, pair));
    seats.min(model.substepping().substeps * impacts)
}

/// Returns the critical time step of some pairs at a penetration (m); force elements add the rate `held` (1/s²).
fn critical(
    model: &Model<Planar>,
    held: f64,
    depth: f64,
    of: &dyn Fn(&ContactPair) -> bool,
) -> f64 {
    let rate = fastest(model, |pair, body| {
        let rate = per_stiffness(model, pair, body) * stiffness(model, pair, depth);
        if of(pair) { rate } else { 0.0 }
    });
    2.0 / (rate + held).sqrt()
}

/// Returns the largest rate due to the force elements of any body: the sum of one of their constants over its mass,
/// and over its inertia times the square of the arm.
fn of_elements<'a>(
    model: &'a Model<Planar>,
    loose: impl Iterator<Item = &'a Element<Planar>>,
    constant: fn(&Element<Planar>) -> f64,
) -> f64 {
    let mut rates = vec![0.0; model.bodies().len()];
    let place = |id: BodyId| model.bodies()[id].pose.position;
    for element in loose.chain(model.elements()) {
        // Some act on both bodies at the point of the second one, which may be far from the first.
        let [first, second] = element.link().bodies;
        let apart = place(second) - place(first);
        for (id, point) in element.ends() {
            let body = &model.bodies()[id];
            if body.motion != Motion::Free {
                continue;
            }
            let arm = if id == first && element.acts_at_second() { apart } else { point };
            rates[id] += constant(element) * (1.0 / body.mass + arm.dot(arm) / body.inertia);
        }
    }
    // The body at the other end may move against it, so each counts twice.
    2.0 * rates.into_iter().fold(0.0, f64::max)
}

/// Returns the largest rate over all pairs and their free bodies. A body may be held from below and above, so each
/// counts twice.
fn fastest(model: &Model<Planar>, rate: impl Fn(&ContactPair, &Body<Planar>) -> f64) -> f64 {
    let mut most = 0.0_f64;
    let bodies = model.bodies();
    model.each_meeting(&mut |pair, contactors, targets| {
        let met = |contactor, target| ContactPair { contactor, target, ..*pair };
        let free = |id: &&BodyId| bodies[**id].motion == Motion::Free;
        // The rate of the contactor does not depend on the target.
        for id in contactors.iter().filter(free) {
            most = most.max(2.0 * rate(&met(*id, pair.target), &bodies[*id]));
        }
        // The rate of a target grows with a figure of the contactor: of many, keep the two with the largest, since
        // one may be the target itself.
        let yardstick = (contactors.len() > 1).then(|| bodies[pair.target].clone());
        let mut largest: [Option<(f64, BodyId)>; 2] = [None; 2];
        for id in contactors {
            let figure = |body| rate(&met(*id, pair.target), body);
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
                most = most.max(2.0 * rate(&met(*other, *id), &bodies[*id]));
            }
        }
    });
    most
}

/// Returns the rate (1/s²) of a body per N/m of its nodes that face a target at once: all nodes of a straight face, a
/// quarter of those around the body.
fn per_stiffness(model: &Model<Planar>, pair: &ContactPair, body: &Body<Planar>) -> f64 {
    facing(model, pair, |nodes| if is_straight(nodes) { 1.0 } else { 0.25 }) / body.mass
}

/// Returns the stiffness (N/m) of a node at a penetration (m), or that of its stick if larger.
fn stiffness(model: &Model<Planar>, pair: &ContactPair, depth: f64) -> f64 {
    let interface = &model.interfaces()[pair.interface];
    interface.normal.tangent_stiffness(depth).max(interface.friction.stick_stiffness())
}

/// Returns Σc/m, or Σc d²/I if larger (1/s), of the nodes that face a target at once: on a flat target half of those
/// around a body, on a round one a quarter.
fn damping_rate(model: &Model<Planar>, pair: &ContactPair, body: &Body<Planar>, depth: f64) -> f64 {
    let damping = model.interfaces()[pair.interface].normal.tangent_damping(depth);
    let flat = match &model.bodies()[pair.target].surfaces[pair.surface].surface {
        Shape::HalfPlane(_) | Shape::Polygon(_) => true,
        Shape::Circle(_) | Shape::Cradle(_) | Shape::BarrelProfile(_) => false,
    };
    let contactor = &model.bodies()[pair.contactor];
    let turning = if std::ptr::eq(body, contactor) {
        mean_square_arm(model.interfaces()[pair.interface].basis, &contactor.nodes[pair.nodes])
            / body.inertia
    } else {
        0.0
    };
    facing(model, pair, |_| if flat { 0.5 } else { 0.25 }) * damping * turning.max(1.0 / body.mass)
}

/// Returns the number of nodes of a pair, or meters of boundary, in contact at once: a share of all, at least two.
fn facing(
    model: &Model<Planar>,
    pair: &ContactPair,
    share: impl Fn(&[Node<Planar>]) -> f64,
) -> f64 {
    let basis = model.interfaces()[pair.interface].basis;
    let weight = |tributary: f64| basis.weight(tributary);
    match &model.bodies()[pair.contactor].nodes[pair.nodes] {
        // Nodes of a seat share one constant, whatever their number.
        Nodes::Fixed(_) if basis == Basis::Seat => 1.0,
        Nodes::Fixed(nodes) => {
            let total: f64 = nodes.iter().map(|n| weight(n.tributary_length)).sum();
            let two: f64 = nodes.iter().take(2).map(|n| weight(n.tributary_length)).sum();
            (share(nodes) * total).max(two)
        }
        // At most two round pieces of a convex boundary bear at once.
        Nodes::Rounds(rounds) => {
            rounds.iter().take(2).map(|round| weight(round.tributary_length)).sum()
        }
        Nodes::Rolling { tributary_length, .. } => weight(*tributary_length),
        Nodes::Whole(none) => match *none {},
    }
}

/// Returns `true` if the nodes are collinear.
fn is_straight(nodes: &[Node<Planar>]) -> bool {
    let [first, .., last] = nodes else { return true };
    let along = last.position - first.position;
    let aside = |node: &Node<Planar>| Planar::moment(along, node.position - first.position).abs();
    nodes.iter().all(|node| aside(node) <= 1e-9 * along.dot(along))
}

/// Returns the mean square lever (m²) of node forces about the center of mass. A rolling node turns a body by
/// friction only, which the stick bounds.
fn mean_square_arm(basis: Basis, nodes: &Nodes<Planar>) -> f64 {
    match nodes {
        Nodes::Fixed(nodes) if !nodes.is_empty() => {
            mean_square(nodes.iter().map(|node| node.position.length()))
        }
        Nodes::Rounds(rounds) if !rounds.is_empty() => {
            mean_square(rounds.iter().map(|round| lever(basis, round)))
        }
        Nodes::Fixed(_) | Nodes::Rounds(_) | Nodes::Rolling { .. } => 0.0,
        Nodes::Whole(none) => match *none {},
    }
}

/// Returns a bound of the lever (m) of the force on a round piece: its normals pass through its center.
///
/// The center of nearly straight staves is hundreds of meters away, but contact is limited to their ends: the limits
/// there are perpendicular to the outermost normals.
fn lever(basis: Basis, round: &Round<Planar>) -> f64 {
    let center = round.center;
    let is_bounded = round.limits.iter().all(|limit| limit.length() > 0.0);
    let straight = match basis {
        Basis::Seat => NEARLY_STRAIGHT.0,
        Basis::Node | Basis::Length => NEARLY_STRAIGHT.1,
    };
    if round.radius < straight || !is_bounded {
        return center.length();
    }
    round.limits.iter().map(|limit| center.dot(*limit).abs()).fold(0.0, f64::max)
}

fn mean_square(arms: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = arms.len() as f64;
    arms.map(|arm| arm * arm).sum::<f64>() / count
}

/// Rounds down to one of these digits times a power of ten.
pub fn round_down(value: f64) -> f64 {
    const DIGITS: [f64; 10] = [1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0];
    let power = math::pow(10.0, math::log10(value).floor());
    let digit = value / power;
    power * DIGITS.into_iter().rev().find(|kept| digit >= *kept).unwrap_or(1.0)
}
