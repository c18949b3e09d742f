//! Functions that make single changes to a scenario.

use barrelstack::scenario::{
    Cradle, Fill, Friction, Interface, MotionSource, Scenario, Scene, StackSpec,
};

/// Returns a copy of a scenario with `change` applied to its stack; a scenario without a stack is returned unchanged.
pub(super) fn with(scenario: &Scenario, change: impl FnOnce(&mut StackSpec)) -> Scenario {
    let mut changed = scenario.clone();
    if let Scene::Stack { stack, .. } = &mut changed.scene {
        change(stack);
    }
    changed
}

/// Returns a scenario that ends `after` seconds after the collapse, with minimal recording.
pub(super) fn brief(scenario: &Scenario, after: f64) -> Scenario {
    let mut brief = scenario.clone();
    brief.run.stop_after_collapse = Some(after);
    brief.record.frame_rate = 1.0;
    brief.record.history_rate = 1.0;
    brief
}

/// Returns the interfaces between bodies that rest on each other: rack–ground, barrel–rack and rack–rack.
fn seats(stack: &mut StackSpec) -> [&mut Interface; 3] {
    let all = &mut stack.interfaces;
    [&mut all.rack_ground, &mut all.barrel_rack, &mut all.rack_rack]
}

/// Multiplies the contact stiffness of all seats by `factor`.
pub(super) fn stiffness(stack: &mut StackSpec, factor: f64) {
    for interface in seats(stack) {
        interface.stiffen(factor);
    }
}

/// Multiplies the contact damping of all seats by `factor`; damping that is stated as a coefficient of restitution is
/// unchanged.
pub(super) fn damping(stack: &mut StackSpec, factor: f64) {
    for interface in seats(stack) {
        interface.damp(factor);
    }
}

/// Multiplies the friction between barrels and racks by `factor`.
pub(super) fn barrel_rack_friction(stack: &mut StackSpec, factor: f64) {
    stack.interfaces.barrel_rack.roughen(factor);
}

/// Multiplies the friction between the bottom rack and the ground by `factor`.
pub(super) fn rack_ground_friction(stack: &mut StackSpec, factor: f64) {
    stack.interfaces.rack_ground.roughen(factor);
}

/// Multiplies the ratio of tangential to normal stiffness of all seats by `factor`.
pub(super) fn stick_stiffness(stack: &mut StackSpec, factor: f64) {
    for interface in seats(stack) {
        if let Friction::Coulomb { tangential_stiffness_ratio, .. } = &mut interface.friction {
            *tangential_stiffness_ratio *= factor;
        }
    }
}

/// Adds `more` to the angle (rad) of cradle supports; a cradle that is a trough is unchanged.
pub(super) fn cradle_angle(stack: &mut StackSpec, more: f64) {
    if let Cradle::Supports { angle } = &mut stack.rack.cradle {
        *angle += more;
    }
}

/// Changes the barrels so that the wine does not rotate with the wood. The mass is unchanged.
pub(super) fn fluid(stack: &mut StackSpec) {
    stack.barrel.fill = Fill::FullFluid;
}

/// Returns a scenario whose sine grows over the first `cycles` cycles and decays over the last `cycles` cycles.
pub(super) fn ramped(scenario: &Scenario, cycles: f64) -> Scenario {
    let mut changed = scenario.clone();
    if let MotionSource::Sine(sine) = &mut changed.motion.source {
        sine.ramp_cycles = cycles;
    }
    changed
}
