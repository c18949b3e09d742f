//! Default time step, which is determined by the seats and divided during impacts.

use barrelstack_dynamics::body::Motion;
use barrelstack_dynamics::model::FORESEEN;
use barrelstack_dynamics::{
    Basis, Body, BodyId, ContactPair, Element, Linear as _, Model, Node, Nodes, NormalLaw, Planar,
    Round, Shape, Space, Substepping, math,
};

use crate::assemble::Assembly;
use crate::scenario::{FreeInterface, Method, Scenario, Scene};

/// Time step as a fraction of the critical time step of seats: accuracy requires a shorter step than stability.
const SHARE: f64 = 0.3;

/// Largest time step as a fraction of the time 1/γ in which dampers stop a body.
///
/// With a fraction above 1, velocities predicted from the last step overshoot. With a fraction of 0.7, some of a
/// thousand random stacks that had come to rest (`tests/settling.rs`) drifted by millimeters.
const DAMPING_SHARE: f64 = 0.33;

/// Penetration (m) at full scale at which nonlinear normal laws are linearized.
const REFERENCE: f64 = 0.01;

/// Time step during impacts, which last a few milliseconds, as a fraction of the critical time step of impacts.
///
/// With this fraction, the energy balance of the cases of Candia, de la Llera and Almazán (2008) closes to 3e-5.
/// Halving the step changes the time of every fall by at most 0.3 ms (`tests/paper.rs`).
pub const IMPACT_SHARE: f64 = 0.4;

/// Penetration above which steps are divided during impacts, as a fraction of `REFERENCE`; the penetration of resting
/// contacts is smaller.
///
/// With this value, the energy residual of the demo scenario in the view along the barrels is 1.1e-5; with a value four
/// times as large, it is 2.4e-4.
pub const WHOLE_STEP: f64 = 0.05;

/// Largest time step as a fraction of the critical time step at the penetration [`WHOLE_STEP`], including tangential
/// springs.
///
/// Impacts require accuracy, but contacts at rest require stability only. For contacts at rest, the penetration above
/// which steps are divided is therefore twice as large as for impacts. At that penetration, the step is 0.83 of the
/// critical step, since the stiffness grows with the square root of the penetration.
pub const WHOLE_STEP_SHARE: f64 = 0.7;

/// Assumed load on the lightest body through its impact contacts, divided by the weight of the heaviest body.
const LOAD: f64 = 3.0;

/// Largest time step as a fraction of the time 1/γ in which the damping of impact contacts under [`LOAD`] stops the
/// lightest body.
///
/// The damping of these contacts grows with the load. With longer steps, heaps of racks under barrels do not come to
/// rest.
const LOADED_SHARE: f64 = 1.4;

/// Time step during a contact whose damping is specified by a restitution, as a fraction of the critical time step of
/// the contact.
///
/// The damper of the contact engages abruptly within a step, which causes a first-order error. With this fraction, a
/// restitution of 0.7 is reproduced within 0.002, and a restitution of 0.3 within 0.003. These errors do not include
/// the effect of the work of gravity during the contact.
const RESTITUTION_SHARE: f64 = 0.005;

/// Gap (m) at full scale within which closing contacts are detected in advance if their damping is specified by a
/// restitution. The gap is sufficient for a closing speed of 40 m/s at steps of 1 ms.
const FORESEEN_REBOUND: f64 = 0.05;

/// Radius (m) above which an arc of a boundary counts as nearly straight. The first value is for contacts whose
/// stiffness and damping are given per seat ([`Basis::Seat`]), the second for other contacts.
///
/// The lever arms of arcs with a smaller radius, such as the staves in the cases of Candia, de la Llera and Almazán
/// (2008), are overestimated by a factor of up to four.
const NEARLY_STRAIGHT: (f64, f64) = (1.0, 4.0);

/// Time step of a model, and the rule by which it is divided into substeps during impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeStepping {
    /// Time step (s) outside of impacts, rounded down to one or two significant digits at full scale.
    pub step: f64,
    /// Rule by which a step is divided into substeps during impacts.
    pub substepping: Substepping<f64>,
}

impl TimeStepping {
    /// Computes the time stepping for the contacts and force elements of a model.
    ///
    /// `loose` are force elements that are not installed yet, and `time_scale` is the time scale of similitude.
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
        // Rounding must not divide a step that is already as short as impacts require.
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

/// Largest tolerance at which the adaptive method reproduces a specified restitution.
///
/// The steps of this method are not divided during impacts. At this tolerance, the motion is within 1 % of the exact
/// motion; at a tolerance of 1e-3, the error is 4 %.
const KEEPS_RESTITUTION: f64 = 1e-6;

/// Returns a warning if the adaptive method is too inaccurate for a restitution that is specified in a free scene.
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
            "run.tolerance = {tolerance:e}: with the adaptive method, the restitution may differ from the stated \
             value by several percent; the tolerance {KEEPS_RESTITUTION:e} reproduces this value"
        )
    })
}

/// Divides the steps of a free scene while contacts whose damping is specified by a restitution are closed or about to
/// close, so that these contacts reproduce the restitution.
///
/// `step` is the time step (s), `critical` returns the critical time step (s) of the contacts of an interface at a
/// penetration (m), and `time_scale` is the time scale of similitude.
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

/// Returns the critical time step (s), at a penetration (m), of all contacts to which one interface of a planar model
/// applies.
pub(crate) fn critical_of_interface(model: &Model<Planar>, depth: f64, interface: usize) -> f64 {
    critical(model, 0.0, depth, &|pair| pair.interface == interface)
}

/// Returns `true` if a pair has impact contacts: contacts with [`NormalLaw::Rebound`] whose nodes are not fixed. These
/// contacts carry little load between impacts.
fn is_impact(model: &Model<Planar>, pair: &ContactPair) -> bool {
    let law = &model.interfaces()[pair.interface].normal;
    let nodes = &model.bodies()[pair.contactor].nodes[pair.nodes];
    matches!(law, NormalLaw::Rebound { .. }) && !matches!(nodes, Nodes::Fixed(_))
}

/// Returns the rate γ (1/s) at which the damping of impact contacts under [`LOAD`] stops the lightest body.
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

/// Returns the critical time step (s) of an assembly, given that steps are divided into substeps during impacts.
/// Returns infinity if nothing can touch.
///
/// For an explicit method, this step is 2/ω with ω² = Σk/m for the stiffest body. The sum covers the springs of all
/// nodes on one boundary of the body that face one target, and the force elements of the body. Nonlinear normal
/// laws are linearized at a penetration of 1 cm at full scale; `time_scale` is the time scale of similitude.
pub fn critical_time_step(assembly: &Assembly, time_scale: f64) -> f64 {
    let model = &assembly.model;
    let depth = REFERENCE * time_scale * time_scale;
    let loose = assembly.loose.iter().map(|loose| &loose.element);
    let held = of_elements(model, loose, Element::stiffness);
    let seats = critical(model, held, depth, &|pair| !is_impact(model, pair));
    let impacts = critical(model, held, depth, &|pair| is_impact(model, pair));
    seats.min(model.substepping().substeps * impacts)
}

/// Returns the critical time step (s), at a penetration (m), of the pairs that `of` selects; `held` (1/s²) is the
/// contribution of force elements to ω².
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

/// Returns the largest rate of any body due to its force elements: ω² (1/s²) for stiffness, or γ (1/s) for damping.
///
/// The rate is twice the sum of `constant` × (1/mass + arm²/inertia) over the elements of a body, where `constant`
/// returns the stiffness or the damping of an element.
fn of_elements<'a>(
    model: &'a Model<Planar>,
    loose: impl Iterator<Item = &'a Element<Planar>>,
    constant: fn(&Element<Planar>) -> f64,
) -> f64 {
    let mut rates = vec![0.0; model.bodies().len()];
    let place = |id: BodyId| model.bodies()[id].pose.position;
    for element in loose.chain(model.elements()) {
        // Some elements act on both bodies at the attachment point of the second body, which may be far from the first
        // body.
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
    // The body at the other end may move in the opposite direction, so each element counts twice.
    2.0 * rates.into_iter().fold(0.0, f64::max)
}

/// Returns twice the largest rate over all pairs and their free bodies. The factor of two accounts for a body that is
/// in contact both from below and from above.
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
        // If one contactor has a larger rate than another for one target, it has a larger rate for every target. All
        // contactors are therefore compared for the same target (the yardstick), and the two with the largest rates are
        // kept: two, since one of them may itself be the target of a pair.
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

/// Returns the factor (1/kg) by which the stiffness (N/m) of one node is multiplied to obtain ω² (1/s²) of a body: the
/// number of nodes that are in contact at the same time, divided by the mass of the body.
///
/// The nodes in contact are all nodes of a straight face, or a quarter of the nodes around a body.
fn per_stiffness(model: &Model<Planar>, pair: &ContactPair, body: &Body<Planar>) -> f64 {
    facing(model, pair, |nodes| if is_straight(nodes) { 1.0 } else { 0.25 }) / body.mass
}

/// Returns the larger of the normal stiffness (N/m) of a node at a penetration (m) and the stiffness (N/m) of its
/// tangential spring.
fn stiffness(model: &Model<Planar>, pair: &ContactPair, depth: f64) -> f64 {
    let interface = &model.interfaces()[pair.interface];
    interface.normal.tangent_stiffness(depth).max(interface.friction.stick_stiffness())
}

/// Returns the rate γ (1/s) at which the dampers of a pair stop a body: the larger of Σc/m and Σc d²/I, where c is the
/// damping of a node and d its lever arm.
///
/// The sums cover the nodes that are in contact at the same time: half of the nodes around a body on a flat target, and
/// a quarter of the nodes on a round target.
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

/// Returns the number of nodes of a pair that are in contact at the same time, or their tributary length (m) if the
/// contact constants are given per length.
///
/// For fixed nodes, `share` returns the fraction that is in contact; at least two nodes are assumed to be in contact.
/// Fixed nodes with constants per seat count as one node.
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
        // At most two corners or arcs of a convex boundary are in contact at the same time.
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

/// Returns the mean of the squared lever arms (m²) of the node forces about the center of mass.
///
/// The result is zero for [`Nodes::Rolling`]: the normal force on a rolling node does not turn the body, and the
/// friction that turns it is limited by the tangential spring.
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

/// Returns an upper bound of the lever arm (m) of the normal force on a round piece (a corner or an arc), whose normals
/// pass through its center of curvature.
///
/// The center of curvature of nearly straight staves is hundreds of meters away, but contacts lie between the ends of
/// the staves. For such pieces, the bound is therefore the lever arm of the normal at one of the two ends, whichever
/// arm is larger.
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

/// Rounds down to a power of ten multiplied by 1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6 or 8.
pub fn round_down(value: f64) -> f64 {
    const DIGITS: [f64; 10] = [1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0];
    let power = math::pow(10.0, math::log10(value).floor());
    let digit = value / power;
    power * DIGITS.into_iter().rev().find(|kept| digit >= *kept).unwrap_or(1.0)
}
