//! Runs are bit-identical, and non-finite numbers are reported.

use std::ops::ControlFlow;

use crate::common::{
    DOWN, Scene, all_pairs, bits, centered, disc, every_method, floor, ground_of, interface, pair,
};
use barrelstack_dynamics::shape::HalfPlane;
use barrelstack_dynamics::simulate::Finish;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    Body, FrictionLaw, Method, Model, ModelError, Nodes, NormalLaw, Placed, Planar, RunError,
    Shape, Still, Twist, Vec2,
};
use barrelstack_scenes::drive::Shake;
use barrelstack_scenes::tumble::{bodies, rough};

fn tumbling() -> Scene {
    Scene::new(bodies(2008, 8, 0.1), rough(1.0, 1.0), DOWN).unwrap()
}

/// Returns a hash of the bits (FNV-1a).
fn hash(bits: &[u64]) -> u64 {
    bits.iter().flat_map(|b| b.to_le_bytes()).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[test]
fn a_run_repeated_gives_the_same_bits() {
    for method in every_method(1e-5) {
        let run = || {
            let mut scene = tumbling();
            let totals = scene
                .by(method)
                .run(&Shake::Harmonic { acceleration: 4.0, omega: 7.0 }, 2e-4, 1.0)
                .unwrap();
            let energy = totals.energy.summary(0);
            (bits(&scene.state), energy, totals.steps, scene.scratch.contact_evaluations)
        };
        let (first, second) = (run(), run());
        assert_eq!(hash(&first.0), hash(&second.0), "{}", method.name());
        assert_eq!(first, second, "{}", method.name());
    }
}

#[test]
fn a_run_stopped_and_continued_gives_the_bits_of_one_run() {
    // Continues from the saved state alone: twists, poses and contact history. Times are powers of two, so that the
    // steps are the same.
    let (step, half, end) = (1.0 / 4096.0, 0.25, 0.5);
    let drive = Shake::Harmonic { acceleration: 4.0, omega: 7.0 };
    let mut whole = tumbling();
    whole.by(Method::RungeKutta4).run(&drive, step, end).unwrap();
    let mut parts = tumbling();
    parts.by(Method::RungeKutta4).run(&drive, step, half).unwrap();
    let mut resumed = Scene::of(parts.model.clone());
    resumed.state = parts.state.clone();
    resumed.by(Method::RungeKutta4).run(&drive, step, end).unwrap();
    // Time, positions and velocities of all bodies; the contact history affects them at the next step.
    let all = 1 + 6 * whole.state.poses.len();
    assert_eq!(bits(&whole.state)[..all], bits(&resumed.state)[..all]);
}

#[test]
fn bodies_of_kinds_have_the_pairs_and_the_bits_of_a_list() {
    let bodies = bodies(2008, 8, 0.1);
    let pairs = all_pairs(&bodies);
    let kind = |body: &Body<Planar>| match body.nodes.first() {
        None => 0,
        Some(Nodes::Rolling { .. }) => 1,
        Some(Nodes::Fixed(_) | Nodes::Rounds(_)) => 2,
        Some(Nodes::Whole(none)) => match *none {},
    };
    let kinds = bodies.iter().map(kind).collect();
    let meet = |_: &[Body<Planar>], [a, b]: [usize; 2]| {
        let of = |pair: &&barrelstack_dynamics::ContactPair| {
            [pair.contactor, pair.target] == [a, b] || [pair.contactor, pair.target] == [b, a]
        };
        pairs.iter().filter(of).copied().collect()
    };
    let laws = vec![rough(1.0, 1.0)];
    let listed = Model::new(bodies.clone(), laws.clone(), pairs.clone(), DOWN).unwrap();
    let of_kinds = Model::of_kinds(bodies, laws, kinds, &meet, DOWN).unwrap();
    assert!(listed.pairs().eq(of_kinds.pairs()));
    let (mut here, mut there) = (Scene::of(listed), Scene::of(of_kinds));
    here.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
    there.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
    assert_eq!(bits(&here.state), bits(&there.state));
}

#[test]
fn the_order_in_which_pairs_are_given_does_not_matter() {
    let bodies = bodies(2008, 8, 0.1);
    let mut pairs = all_pairs(&bodies);
    let model = Model::new(bodies.clone(), vec![rough(1.0, 1.0)], pairs.clone(), DOWN).unwrap();
    pairs.reverse();
    pairs.push(pairs[3]);
    let other = Model::new(bodies, vec![rough(1.0, 1.0)], pairs, DOWN).unwrap();
    assert!(model.pairs().eq(other.pairs()));
    let (mut here, mut there) = (Scene::of(model), Scene::of(other));
    here.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
    there.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
    assert_eq!(bits(&here.state), bits(&there.state));
}

#[test]
fn work_is_counted() {
    let mut scene = tumbling();
    let totals = scene.by(Method::RungeKutta4).run(&Still, 1e-3, 0.1).unwrap();
    assert_eq!(totals.steps, 100);
    assert_eq!(totals.finish, Finish::EndTime);
    assert_eq!(scene.scratch.evaluations, 1 + 4 * 100);
    let mut scene = tumbling();
    scene.by(Method::VelocityVerlet).run(&Still, 1e-3, 0.1).unwrap();
    assert_eq!(scene.scratch.evaluations, 1 + 100);
}

#[test]
fn an_observer_sees_the_start_and_can_stop_the_run() {
    let mut scene = tumbling();
    let mut times = vec![];
    let totals = scene
        .by(Method::VelocityVerlet)
        .watch(&Still, 1e-3, 1.0, |state, _, _| {
            times.push(state.time);
            if times.len() == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    assert_eq!((totals.finish, totals.steps), (Finish::Stopped, 3));
    assert_eq!(times, [0.0, 1e-3, 2e-3, 3e-3]);
    assert_eq!(bits(&scene.state)[0], 3e-3_f64.to_bits());
}

#[test]
fn a_step_far_too_long_ends_with_the_time_and_the_body() {
    // A disc pressed between a floor and a ceiling: the contact is permanent, so above the critical step the
    // oscillation doubles again and again.
    let ceiling = Placed {
        surface: Shape::HalfPlane(HalfPlane),
        offset: Vec2::new(0.0, 0.39),
        rotation: Rotation2::new(std::f64::consts::PI),
    };
    let walls = ground_of(vec![centered(Shape::HalfPlane(HalfPlane)), ceiling]);
    let idle = disc("idle", 0.1, 5.0, 0.005, Vec2::new(10.0, 0.5));
    let squeezed = disc("squeezed", 0.2, 5.0, 0.02, Vec2::new(0.0, 0.194));
    let bodies = vec![walls, idle, squeezed];
    let law =
        interface(NormalLaw::SpeedGap { stiffness: 1e7, damping: 1e3 }, FrictionLaw::Frictionless);
    let mut pairs = all_pairs(&bodies);
    pairs.push(barrelstack_dynamics::ContactPair { surface: 1, ..pair(2, 0) });
    let model = Model::new(bodies, vec![law], pairs, DOWN).unwrap();
    for method in [Method::SemiImplicitEuler, Method::VelocityVerlet, Method::RungeKutta4] {
        let mut scene = Scene::of(model.clone());
        let step = 0.01;
        let mut last = 0.0;
        let error = scene
            .by(method)
            .watch(&Still, step, 60.0, |state, _, _| {
                assert!(state.poses[2].position.z.is_finite(), "lost numbers reach no observer");
                last = state.time;
                ControlFlow::Continue(())
            })
            .unwrap_err();
        let RunError::NotFinite { time, body, time_step, .. } = &error;
        assert_eq!(body, "squeezed", "{}", method.name());
        assert_eq!(*time_step, step);
        assert!((*time - last - step).abs() < 1e-12 && *time > 0.0);
        assert_eq!(
            error.to_string(),
            format!(
                "the step failed at t = {time:.6} s: the motion of body \"squeezed\" is no \
                 longer finite; try a step below 1.00e-2 s"
            )
        );
    }
}

#[test]
fn a_body_that_starts_without_a_number_is_named() {
    let mut scene = tumbling();
    scene.state.twists[3] = Twist { linear: Vec2::new(f64::NAN, 0.0), angular: 0.0 };
    for method in every_method(1e-6) {
        let mut scene = Scene { state: scene.state.clone(), ..Scene::of(scene.model.clone()) };
        let found = scene.by(method).watch(&Still, 1e-3, 1.0, |_, _, _| ControlFlow::Continue(()));
        let RunError::NotFinite { time, body, .. } = found.unwrap_err();
        assert_eq!(body, "body 2", "{}", method.name());
        assert!(time <= 1e-3, "{time}");
    }
}

#[test]
fn what_is_no_model_is_refused_with_its_name() {
    let law = || vec![rough(1.0, 1.0)];
    let ball = |name: &str| disc(name, 0.2, 5.0, 0.02, Vec2::new(0.0, 1.0));
    let model = |bodies, pairs| Model::new(bodies, law(), pairs, DOWN).map(|_| ()).unwrap_err();

    let twins = model(vec![floor(), ball("a"), ball("a")], vec![]);
    assert_eq!(twins, ModelError::DuplicateName { name: "a".into() });
    assert_eq!(twins.to_string(), "two bodies are named \"a\": give each its own name");

    for mass in [0.0, -1.0, f64::INFINITY] {
        let mut light = ball("light");
        light.mass = mass;
        let found = model(vec![floor(), light], vec![]);
        assert_eq!(found, ModelError::Mass { name: "light".into(), mass });
    }
    let mut endless = ball("endless");
    endless.surfaces = vec![centered(Shape::HalfPlane(HalfPlane))];
    assert_eq!(model(vec![endless], vec![]), ModelError::Unbounded { name: "endless".into() });

    let found = model(vec![floor(), ball("a")], vec![pair(1, 7)]);
    let expected = ModelError::Dangling { pair: 0, what: "body", index: 7, count: 2 };
    assert_eq!(found, expected);
    assert_eq!(found.to_string(), "contact pair 0 refers to body 7, but only 2 exist");
    let found = model(vec![floor(), ball("a")], vec![pair(0, 1)]);
    assert!(matches!(found, ModelError::Dangling { what: "node set", index: 0, count: 0, .. }));
}

#[test]
fn a_free_body_needs_a_moment_of_inertia() {
    for inertia in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut thin = disc("thin", 0.2, 5.0, 0.02, Vec2::new(0.0, 1.0));
        thin.inertia = inertia;
        let found = Model::new(vec![floor(), thin], vec![rough(1.0, 1.0)], vec![], DOWN);
        assert!(found.is_err(), "inertia {inertia} makes a model");
    }
}
