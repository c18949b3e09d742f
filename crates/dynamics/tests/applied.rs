//! Forces from outside the model: closed forms, energy balance, and steps that can be continued.

use std::f64::consts::TAU;

use crate::common::{bits, disc, every_method};
use barrelstack_dynamics::{
    Applied, ApplyError, Body, Drive, Guide, Link, Model, Motion, Planar, Pose, Quaternion,
    Scratch, Simulation, Spatial, State, Stepper, Still, Vec2, Vec3,
};

const MASS: f64 = 100.0;
const INERTIA: f64 = 4.5;
const STEP: f64 = 1e-3;

/// A weight on a spring from the ground, without gravity.
fn on_a_spring(stiffness: f64) -> Model<Planar> {
    let ground =
        Body { motion: Motion::Prescribed, ..disc("ground", 0.1, 1.0, 1.0, Vec2::default()) };
    let weight = disc("weight", 0.3, MASS, INERTIA / MASS, Vec2::new(0.0, 3.0));
    let mut model =
        Model::new(vec![ground, weight], Vec::new(), Vec::new(), Vec2::default()).unwrap();
    let link = Link {
        name: "spring".into(),
        bodies: [0, 1],
        points: [Vec2::new(0.0, 3.0), Vec2::default()],
    };
    model.fasten(vec![Guide::spring(link, Vec2::new(1.0, 0.0), stiffness, 0.0).into()]).unwrap();
    model
}

fn push(force: Vec2, point: Vec2, moment: f64) -> Applied<Planar> {
    Applied { body: 1, force, point, moment }
}

#[test]
fn a_weight_on_a_spring_swings_about_the_place_where_the_force_is_balanced() {
    let (omega, force) = (TAU, 50.0);
    let model = on_a_spring(MASS * omega * omega);
    let center = force / (MASS * omega * omega);
    for (method, limit) in every_method(1e-9).into_iter().zip([8e-5, 5e-7, 1e-11, 1e-7]) {
        let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
        let run = Simulation { method, time_step: STEP, end_time: 2.0 };
        let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
        let push = push(Vec2::new(force, 0.0), Vec2::default(), 0.0);
        stepper.apply(&model, &mut state, &mut scratch, push).unwrap();
        let mut worst = 0.0_f64;
        while !stepper.is_at_end(&state) {
            stepper.step(&model, &Still, &mut state, &mut scratch).unwrap();
            let exact = center * (1.0 - libm::cos(omega * state.time));
            worst = worst.max((state.poses[1].position.x - exact).abs());
        }
        let energy = stepper.energy.summary(0);
        let work = force * state.poses[1].position.x;
        assert!(worst < limit, "{}: {worst:e}", method.name());
        assert!((energy.applied_work - work).abs() < 1e-9, "{}: {energy:?}", method.name());
        assert!(energy.residual_ratio() < 1e-2, "{}: {energy:?}", method.name());
        assert_eq!(
            energy.ground_work, 0.0,
            "the force acts in the direction of the spring, whose end is still"
        );
    }
}

#[test]
fn a_force_beside_the_center_and_a_moment_turn_a_body() {
    let model = on_a_spring(0.0);
    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let method = barrelstack_dynamics::Method::VelocityVerlet;
    let run = Simulation { method, time_step: STEP, end_time: 1.0 };
    let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
    // The moment of the force at its arm is cancelled at first by the additional moment.
    let force = Vec2::new(10.0, 0.0);
    let arm = Vec2::new(0.0, 0.2);
    stepper.apply(&model, &mut state, &mut scratch, push(force, arm, 2.0)).unwrap();
    assert_eq!(scratch.accelerations[1].angular, 0.0);
    stepper.apply(&model, &mut state, &mut scratch, push(Vec2::default(), arm, 9.0)).unwrap();
    while !stepper.is_at_end(&state) {
        stepper.step(&model, &Still, &mut state, &mut scratch).unwrap();
    }
    // measured 1e-14
    assert!((state.twists[1].angular - 9.0 / INERTIA).abs() < 1e-12, "{:?}", state.twists[1]);
    assert!((state.poses[1].orientation - 4.5 / INERTIA).abs() < 1e-12);
    let energy = stepper.energy.summary(0);
    assert!((energy.applied_work - 0.5 * INERTIA * 4.0).abs() < 1e-9, "{energy:?}");
    assert!((energy.kinetic - energy.applied_work).abs() < 1e-9, "{energy:?}");
}

#[test]
fn in_space_a_force_turns_a_body_about_the_axis_of_its_moment() {
    let pose = Pose { position: Vec3::default(), orientation: Quaternion::identity() };
    let body = Body::<Spatial>::free("body", MASS, Vec3::new(2.0, 2.0, 2.0), pose);
    let model = Model::new(vec![body], Vec::new(), Vec::new(), Vec3::default()).unwrap();
    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let method = barrelstack_dynamics::Method::VelocityVerlet;
    let run = Simulation { method, time_step: STEP, end_time: 1.0 };
    let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
    // A couple about z, which stays constant in the inertial frame.
    let couple = Applied {
        body: 0,
        force: Vec3::default(),
        point: Vec3::default(),
        moment: Vec3::new(0.0, 0.0, 4.0),
    };
    stepper.apply(&model, &mut state, &mut scratch, couple).unwrap();
    while !stepper.is_at_end(&state) {
        stepper.step(&model, &Still, &mut state, &mut scratch).unwrap();
    }
    // measured 1e-13
    assert!((state.twists[0].angular.z - 2.0).abs() < 1e-11, "{:?}", state.twists[0]);
    let lever =
        Applied { force: Vec3::new(0.0, 3.0, 0.0), point: Vec3::new(1.0, 0.0, 0.0), ..couple };
    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
    stepper.apply(&model, &mut state, &mut scratch, lever).unwrap();
    assert_eq!(scratch.accelerations[0].angular, Vec3::new(0.0, 0.0, 3.5));
    assert_eq!(scratch.accelerations[0].linear, Vec3::new(0.0, 0.03, 0.0));
}

/// Ground that swings.
struct Swinging;

impl Drive<Planar> for Swinging {
    fn at(&self, time: f64) -> (Vec2, Vec2) {
        let omega = 5.0;
        let moved = Vec2::new(0.1 * libm::sin(omega * time), 0.0);
        (moved, Vec2::new(0.1 * omega * libm::cos(omega * time), 0.0))
    }
}

/// What is done before each step.
type Touch<'a> = &'a dyn Fn(&mut Stepper<Planar>, &mut State<Planar>, &mut Scratch<Planar>);

#[test]
fn a_force_that_is_taken_back_or_set_again_leaves_the_bits() {
    let model = on_a_spring(3e3);
    for method in every_method(1e-9) {
        let run = Simulation { method, time_step: STEP, end_time: 0.5 };
        let ran = |touch: Touch<'_>| {
            let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
            let mut stepper = Stepper::start(&model, &Swinging, &mut state, &mut scratch, &run);
            while !stepper.is_at_end(&state) {
                touch(&mut stepper, &mut state, &mut scratch);
                stepper.step(&model, &Swinging, &mut state, &mut scratch).unwrap();
            }
            bits(&state)
        };
        let force = push(Vec2::new(30.0, 0.0), Vec2::new(0.0, 0.1), 0.0);
        let nothing = Applied { force: Vec2::default(), ..force };
        let untouched = ran(&|_, _, _| {});
        let zero = ran(&|stepper, state, scratch| {
            stepper.apply(&model, state, scratch, nothing).unwrap();
            assert!(state.applied.is_empty() && scratch.applied.is_empty());
        });
        assert_eq!(untouched, zero);
        let once = ran(&|stepper, state, scratch| {
            if stepper.steps == 0 {
                stepper.apply(&model, state, scratch, force).unwrap();
            }
        });
        let held = ran(&|stepper, state, scratch| {
            stepper.apply(&model, state, scratch, force).unwrap();
            assert_eq!(state.applied.len(), 1);
        });
        assert_eq!(once, held);
        assert_ne!(once, untouched);
    }
}

#[test]
fn a_force_that_cannot_act_is_refused() {
    let model = on_a_spring(1.0);
    let (mut state, mut scratch) = (State::initial(&model), Scratch::new(&model));
    let method = barrelstack_dynamics::Method::VelocityVerlet;
    let run = Simulation { method, time_step: STEP, end_time: 0.5 };
    let mut stepper = Stepper::start(&model, &Still, &mut state, &mut scratch, &run);
    let force = push(Vec2::new(1.0, 0.0), Vec2::default(), 0.0);
    let mut refused =
        |applied| stepper.apply(&model, &mut state, &mut scratch, applied).unwrap_err();
    assert_eq!(refused(Applied { body: 2, ..force }), ApplyError::NoBody { body: 2, bodies: 2 });
    let ground = ApplyError::Prescribed { name: "ground".into() };
    assert_eq!(refused(Applied { body: 0, ..force }), ground);
    let lost = ApplyError::NotFinite { name: "weight".into() };
    assert_eq!(refused(Applied { moment: f64::NAN, ..force }), lost);
    assert!(state.applied.is_empty());
}
