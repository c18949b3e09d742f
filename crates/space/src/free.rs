//! Assembly of a three-dimensional free scene: individual bodies, and contact pairs with their contact laws.

use barrelstack::RunFailure;
use barrelstack::assemble::{AssembleError, PartKind, laws_of_free};
use barrelstack::scenario::{FreeInterface, Scenario, SpatialBody, SpatialScene};
use barrelstack::step::keep_restitution;
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Counts, Model, Motion, Quaternion, Solid, Spatial, Vec3,
};

use crate::part::{Part, ground};
use crate::stack::Stack;
use crate::step::{critical_of_interface, time_step};

/// Builds a free scene, without settling it.
pub(crate) fn assemble(scenario: &Scenario, scene: &SpatialScene) -> Result<Stack, RunFailure> {
    if scenario.run.similitude != 1.0 {
        let reason = "scaled scenes are supported only in a plane: set run.similitude to 1".into();
        return Err(AssembleError::NotInSpace { field: "run.similitude", reason }.into());
    }
    let mut floor = ground();
    // A slope that rises to the right is a negative rotation about y.
    floor.pose.orientation = Quaternion::turn(Vec3::new(0.0, -scene.ground.slope, 0.0));
    let mut bodies = vec![floor];
    bodies.extend(scene.bodies.iter().map(SpatialBody::build));
    let mut parts = vec![Part::alone("ground", PartKind::Ground)];
    parts.extend(scene.bodies.iter().map(|body| Part::alone(&body.name, PartKind::Body)));
    let pairs = pairs(scene, &bodies);
    let gravity = Vec3::new(0.0, 0.0, -scenario.run.gravity);
    let mut model =
        Model::new(bodies, laws_of_free(scene), pairs, gravity).map_err(AssembleError::from)?;
    let step = time_step(scenario, &model)?;
    keep_restitution(&mut model, &scene.interfaces, step, 1.0, critical_of_interface);
    Ok(Stack {
        model,
        parts,
        step,
        height: 0.0,
        levels: 0,
        bilge_radius: 0.0,
        reach: [0.0; 2],
        stave_capacity: 0.0,
        loose: Vec::new(),
        devices: Vec::new(),
    })
}

/// Returns the contact pairs between the solids of any two bodies for which an interface is given, unless both bodies
/// are fixed. Each pair occurs once.
fn pairs(scene: &SpatialScene, bodies: &[Body<Spatial>]) -> Vec<ContactPair> {
    let mut list = Vec::new();
    for one in 0..bodies.len() {
        for other in one + 1..bodies.len() {
            let Some((interface, turned)) = law_of(scene, [one, other]) else { continue };
            if [one, other].iter().all(|id| bodies[*id].motion == Motion::Prescribed) {
                continue;
            }
            // A half-space is always the target.
            let turned = if is_unbounded(&bodies[one]) || is_unbounded(&bodies[other]) {
                is_unbounded(&bodies[one])
            } else {
                turned
            };
            let (contactor, target) = if turned { (other, one) } else { (one, other) };
            for nodes in 0..bodies[contactor].nodes.len() {
                for surface in 0..bodies[target].surfaces.len() {
                    let counts = Counts::Everywhere;
                    list.push(ContactPair { contactor, nodes, target, surface, interface, counts });
                }
            }
        }
    }
    list
}

fn is_unbounded(body: &Body<Spatial>) -> bool {
    body.surfaces.iter().any(|placed| placed.surface == Solid::HalfSpace)
}

/// Returns the index of the interface between two bodies, and a flag that is `true` if the interface names the second
/// body first; `None` if no interface applies to the two bodies.
fn law_of(scene: &SpatialScene, [one, other]: [BodyId; 2]) -> Option<(usize, bool)> {
    let label = |id: BodyId| match id.checked_sub(1) {
        Some(at) => (scene.bodies[at].kind(), scene.bodies[at].group.as_deref()),
        None => (scene.ground.kind.as_str(), None),
    };
    let ((first, group), (second, other_group)) = (label(one), label(other));
    let together = group.is_some() && group == other_group;
    let meets = |law: &FreeInterface, a: &str, b: &str| law.between[0] == a && law.between[1] == b;
    let mut laws = scene.interfaces.iter().enumerate();
    laws.find(|(_, law)| meets(law, first, second) || meets(law, second, first))
        .filter(|(_, law)| !together || law.within_groups)
        .map(|(at, law)| (at, !meets(law, first, second)))
}
