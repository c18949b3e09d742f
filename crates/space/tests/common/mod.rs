//! The demo with seats as soft as the contact nodes of Candia et al. (2008), on which stacks fall within a few seconds.
use barrelstack::Scenario;

/// Changes that give every seat the constants of one contact node of Candia et al. (2008), and their friction.
const SOFT: [&str; 12] = [
    "interface.rack-ground.basis=node",
    "interface.rack-ground.stiffness=980 kN/m",
    "interface.rack-ground.damping=2200 N*s/m",
    "interface.rack-ground.friction.coefficient=0.5",
    "interface.rack-ground.friction.tangential_stiffness_ratio=1",
    "interface.barrel-rack.basis=node",
    "interface.barrel-rack.stiffness=980 kN/m",
    "interface.barrel-rack.damping=2200 N*s/m",
    "interface.barrel-rack.friction.coefficient=0.22",
    "interface.barrel-rack.friction.tangential_stiffness_ratio=1",
    "interface.fallen-barrel-rack.friction.coefficient=0.22",
    "interface.fallen-rack-ground.friction.coefficient=0.4",
];

/// Returns the demo on soft seats, with further changes.
pub(crate) fn soft_demo(changes: &[String]) -> Scenario {
    // A change of the law of barrels on racks replaces the whole law.
    let own = changes.iter().any(|change| change.starts_with("interface.barrel-rack."));
    let kept = |change: &&&str| !(own && change.starts_with("interface.barrel-rack."));
    let soft = SOFT.iter().filter(kept).map(|&change| change.to_owned());
    let all: Vec<String> = soft.chain(changes.iter().cloned()).collect();
    Scenario::builtin("demo-napa", &all).unwrap()
}
