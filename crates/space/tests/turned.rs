//! Rotating a stack together with its ground motion rotates the result.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_dynamics::{
    Drive, Method, Model, Quaternion, Scratch, Simulation, Spatial, State, Vec3, simulate,
};
use barrelstack_space::{Ground, Stack};

use crate::common::soft_demo;

/// Ground motion rotated about the vertical.
struct Turned(Ground, Quaternion);

impl Drive<Spatial> for Turned {
    fn at(&self, time: f64) -> (Vec3, Vec3) {
        let (place, velocity) = self.0.at(time);
        let turn = self.1.matrix();
        (turn.apply(place), turn.apply(velocity))
    }
}

/// Returns the displacements (m) of the bodies of a stack of two levels after seven seconds, rotated back, relative
/// to their positions as built.
///
/// The stack starts as built, without settling: seats with friction have many states of rest, and rounding may lead to
/// another one, some hundredths of a millimeter away.
fn ways(angle: f64) -> Vec<Vec3> {
    let changes = ["stack.view=spatial", "stack.levels=2", "stack.columns_along=2"];
    let scenario = soft_demo(&changes.map(str::to_owned));
    let stack = Stack::of(&scenario).unwrap();
    let turn = Quaternion::turn(Vec3::new(0.0, 0.0, angle));
    let mut bodies = stack.model.bodies().to_vec();
    // The half-space is not rotated, so that it must be isotropic.
    for body in &mut bodies[1..] {
        body.pose.position = turn.matrix().apply(body.pose.position);
        body.pose.orientation = turn.after(body.pose.orientation);
    }
    let pairs = stack.model.pairs().collect();
    let laws = stack.model.interfaces().to_vec();
    let mut model = Model::new(bodies, laws, pairs, stack.model.gravity()).unwrap();
    model.set_substepping(stack.model.substepping().clone());
    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let simulation =
        Simulation { method: Method::VelocityVerlet, time_step: stack.step, end_time: 7.0 };
    let ground = Turned(Ground::of(&scenario).unwrap(), turn);
    simulate(&model, &ground, &mut state, &mut scratch, &simulation, &mut ()).unwrap();
    let places = state.poses.iter().zip(stack.model.bodies());
    places.map(|(pose, was)| turn.matrix().unapply(pose.position) - was.pose.position).collect()
}

#[test]
fn a_stack_and_its_ground_that_are_turned_together_do_the_same() {
    let straight = ways(0.0);
    let ground = straight[0];
    let sway = straight.iter().map(|way| (*way - ground).length()).fold(0.0, f64::max);
    assert!(sway > 0.05, "{sway}"); // measured 0.059
    for degrees in [17.0_f64, 90.0, 123.0] {
        let turned = ways(degrees.to_radians());
        let apart = straight.iter().zip(&turned).map(|(a, b)| (*a - *b).length());
        let apart = apart.fold(0.0, f64::max);
        println!("{degrees}°: {apart:e} m of {sway:.4} m");
        assert!(apart < 1e-11, "{apart:e}"); // measured 9e-14
    }
}
