//! A force element between two bodies: a weight falls into a strap, which stops it at the elongation that follows from
//! the energy.
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::ops::ControlFlow;

use barrelstack_dynamics::{
    Body, Link, Method, Model, Motion, Planar, Pose, Scratch, Simulation, State, Still, Strap,
    Vec2, look, simulate,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mass, stiffness, fall, gravity) = (100.0, 1e5, 0.5, 9.80665);
    let hook = Body::ground(0.0);
    let pose = Pose { position: Vec2::new(0.0, -0.5), orientation: 0.0 };
    let weight = Body { name: "weight".into(), motion: Motion::Free, mass, pose, ..hook.clone() };
    let weight = Body { surfaces: Vec::new(), ..weight };
    let link = Link { name: "strap".into(), bodies: [0, 1], points: [Vec2::default(); 2] };
    let strap = Strap {
        link,
        length: 0.5 + fall,
        stiffness,
        damping: 0.0,
        yields_at: f64::INFINITY,
        strength: f64::INFINITY,
    };
    let mut model = Model::new(vec![hook, weight], vec![], vec![], Vec2::new(0.0, -gravity))?;
    model.fasten(vec![strap.into()])?;

    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let mut lowest: f64 = 0.0_f64;
    let mut watch = look(|state: &State<Planar>, _, _| {
        lowest = lowest.min(state.poses[1].position.z);
        ControlFlow::Continue(())
    });
    let run = Simulation { method: Method::VelocityVerlet, time_step: 1e-4, end_time: 1.0 };
    simulate(&model, &Still, &mut state, &mut scratch, &run, &mut watch)?;
    drop(watch);
    let still = mass * gravity / stiffness;
    let stretch = still + (still * still + 2.0 * still * fall).sqrt();
    println!("stopped at {lowest:.4} m; expected from the energy: {:.4} m", -0.5 - fall - stretch);
    Ok(())
}
