//! Invariants of every scene: balance of momentum and energy, symmetry, similitude.

use crate::common;

use std::ops::ControlFlow;

use crate::common::{
    DOWN, Scene, all_pairs, bits, centered, disc, finely_noded_block, floor, ground_of, interface,
    numbers, pose,
};
use barrelstack_dynamics::contact::Exponent;
use barrelstack_dynamics::forces::contact_force;
use barrelstack_dynamics::shape::{Circle, Polygon, Surface};
use barrelstack_dynamics::{
    Body, ContactPair, Drive, FrictionLaw, Interface, Method, Model, Nodes, NormalLaw, Planar,
    Shape, State, Still, Twist, Vec2,
};
use barrelstack_scenes::drive::Shake;
use barrelstack_scenes::tumble::{Random, bodies, rough};
use proptest::prelude::*;

fn tumbling(seed: u64) -> Scene {
    Scene::new(bodies(seed, 6, 0.1), rough(1.0, 1.0), DOWN).unwrap()
}

/// Returns a moment about the origin of the inertial frame.
fn moment(arm: Vec2, force: Vec2) -> f64 {
    arm.x * force.z - arm.z * force.x
}

/// Returns the largest difference of two states in positions (m), angles (rad) and velocities.
fn apart(a: &State<Planar>, b: &State<Planar>) -> f64 {
    let pairs = a.poses.iter().zip(&a.twists).zip(b.poses.iter().zip(&b.twists));
    pairs
        .flat_map(|((p, t), (q, u))| {
            numbers(p, t).into_iter().zip(numbers(q, u)).map(|(x, y)| (x - y).abs())
        })
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(common::cases(12))]

    #[test]
    fn contact_forces_balance_and_stay_in_their_cones(seed in any::<u64>()) {
        let mut scene = tumbling(seed);
        let (model, mut touched) = (scene.model.clone(), 0);
        let drive = Shake::Harmonic { acceleration: 3.0, omega: 9.0 };
        scene.by(Method::VelocityVerlet).watch(&drive, 2e-4, 0.6, |state, scratch, _| {
            let (mut force, mut turn, mut size) = (Vec2::default(), 0.0, 1.0_f64);
            for (wrench, pose) in scratch.wrenches.iter().zip(&state.poses) {
                force += wrench.force;
                turn += wrench.moment + moment(pose.position, wrench.force);
                size = size.max(wrench.force.length());
            }
            assert!(force.length() < 1e-13 * size, "{force:?}"); // measured 4.5e-16
            assert!(turn.abs() < 1e-13 * size, "{turn}"); // measured 6.1e-16
            // For every pair, force and moment of the contacts equal those on both bodies.
            let mut sums = vec![(Vec2::default(), 0.0); model.bodies().len()];
            for contact in &scratch.contacts {
                touched += 1;
                let FrictionLaw::Coulomb { static_coefficient, .. } =
                    model.interfaces()[0].friction else { unreachable!() };
                assert!(contact.normal_force >= 0.0 && contact.penetration >= 0.0);
                let limit = static_coefficient * contact.normal_force;
                assert!(contact.friction_force.abs() <= limit * (1.0 + 1e-15));
                let (force, point) = contact_force(&model, state, scratch, contact);
                let pair = model.pair(contact.pair);
                // The force acts on both bodies at the target's surface or, if the contact is exact, midway between the
                // surfaces of target and contactor.
                let surface = &model.bodies()[pair.target].surfaces[pair.surface].surface;
                let depth = match &model.bodies()[pair.contactor].nodes[pair.nodes] {
                    Nodes::Fixed(_) => 0.0,
                    Nodes::Rounds(_) | Nodes::Rolling { .. } => 0.5 * contact.penetration,
                    Nodes::Whole(none) => match *none {},
                };
                let companion = contact.point + contact.normal * depth;
                assert!(Surface::<Planar>::gap(surface, companion).distance.abs() < 1e-14);
                for (body, force) in [(pair.contactor, force), (pair.target, -force)] {
                    sums[body].0 += force;
                    sums[body].1 += moment(point - state.poses[body].position, force);
                }
            }
            for (wrench, (force, turn)) in scratch.wrenches.iter().zip(sums) {
                assert!((wrench.force - force).length() < 1e-12 * size);
                assert!((wrench.moment - turn).abs() < 1e-12 * size);
            }
            ControlFlow::Continue(())
        }).unwrap();
        prop_assert!(touched > 500, "only {touched} contacts");
    }

    #[test]
    fn the_energy_balances(seed in any::<u64>()) {
        let drive = Shake::Harmonic { acceleration: 3.0, omega: 9.0 };
        let ratio = |step: f64| {
            let mut scene = tumbling(seed);
            let totals = scene.by(Method::VelocityVerlet).run(&drive, step, 1.0).unwrap();
            let summary = totals.energy.summary(0);
            assert!(summary.damped >= 0.0 && summary.friction >= 0.0 && summary.viscous == 0.0);
            assert!(summary.damped + summary.friction > 10.0, "nothing was lost: {summary:?}");
            summary.residual_ratio()
        };
        let (coarse, fine) = (ratio(1e-4), ratio(1e-5));
        // measured 3.3e-4 and 4.0e-5 at worst
        prop_assert!(coarse < 1e-3 && fine < 1.5e-4, "{coarse:e} {fine:e}");
    }

    #[test]
    fn a_mirrored_scene_moves_the_other_way(seed in any::<u64>()) {
        let mirrored = |body: &Body<Planar>| {
            let mut body = body.clone();
            let flip = |v: Vec2| Vec2::new(-v.x, v.z);
            body.pose.position = flip(body.pose.position);
            body.pose.orientation = -body.pose.orientation;
            body.twist = Twist { linear: flip(body.twist.linear), angular: -body.twist.angular };
            // Rectangles, discs and floors are their own mirror images; their nodes are not.
            for nodes in &mut body.nodes {
                if let Nodes::Fixed(nodes) = nodes {
                    for node in nodes {
                        node.position = flip(node.position);
                    }
                }
            }
            body
        };
        let here = bodies(seed, 6, 0.1);
        let there = here.iter().map(mirrored).collect();
        let (mut here, mut there) =
            (Scene::new(here, rough(1.0, 1.0), DOWN).unwrap(), Scene::new(there, rough(1.0, 1.0), DOWN).unwrap());
        here.by(Method::VelocityVerlet).run(&Shake::Harmonic { acceleration: 3.0, omega: 9.0 }, 2e-4, 0.5).unwrap();
        there.by(Method::VelocityVerlet).run(&Shake::Harmonic { acceleration: -3.0, omega: 9.0 }, 2e-4, 0.5).unwrap();
        for (i, pose) in here.state.poses.iter().enumerate() {
            let (this, other) = (
                numbers(pose, &here.state.twists[i]),
                numbers(&there.state.poses[i], &there.state.twists[i]),
            );
            let sign = [-1.0, 1.0, -1.0, -1.0, 1.0, -1.0];
            for k in 0..6 {
                // The results are not bit-identical, since a mirrored rectangle measures along its sides from the other
                // ends.
                let error = (this[k] - sign[k] * other[k]).abs();
                prop_assert!(error < 4e-12, "{i}, {k}: {error:e}"); // measured 6.0e-14
            }
        }
    }

    #[test]
    fn a_scene_four_times_as_large_moves_alike_bit_for_bit(seed in any::<u64>()) {
        // Time ×2, mass ×64, forces ×64, equal gravity; all factors are powers of two. The margin of the near list is
        // in meters and does not scale: the results must be bit-identical nevertheless.
        let ground = Shake::Swing { amplitude: 0.03, omega: 9.0 };
        let larger_ground = Shake::Swing { amplitude: 4.0 * 0.03, omega: 4.5 };
        for method in [Method::SemiImplicitEuler, Method::VelocityVerlet, Method::RungeKutta4] {
            for law in [rough(1.0, 1.0), crossley()] {
                let (mut small, mut large) = (
                    Scene::new(bodies(seed, 6, 0.1), law.clone(), DOWN).unwrap(),
                    Scene::new(
                        bodies(seed, 6, 0.1).iter().map(four_times).collect(),
                        stiffer(&law),
                        DOWN,
                    ).unwrap(),
                );
                let steps = 3000.0;
                small.by(method).run(&ground, 2e-4, steps * 2e-4).unwrap();
                large.by(method).run(&larger_ground, 4e-4, steps * 4e-4).unwrap();
                prop_assert!(small.scratch.contact_evaluations > 3000);
                for i in 0..small.state.poses.len() {
                    let this = numbers(&small.state.poses[i], &small.state.twists[i]);
                    let other = numbers(&large.state.poses[i], &large.state.twists[i]);
                    let scale = [4.0, 4.0, 1.0, 2.0, 2.0, 0.5];
                    for k in 0..6 {
                        prop_assert_eq!(
                            (this[k] * scale[k]).to_bits(), other[k].to_bits(),
                            "body {}, number {}, {}", i, k, method.name()
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn another_unit_of_mass_changes_no_bit_of_the_motion(seed in any::<u64>()) {
        let heavier = |body: &Body<Planar>| {
            let mut body = body.clone();
            body.mass *= 1024.0;
            body.inertia *= 1024.0;
            body
        };
        let law = |factor: f64| interface(
            NormalLaw::SpeedGap { stiffness: factor * 2.0e5, damping: factor * 600.0 },
            common::coulomb(0.4, factor * 1.5e5, factor * 300.0),
        );
        let mut light = Scene::new(bodies(seed, 6, 0.1), law(1.0), DOWN).unwrap();
        let mut heavy = Scene::new(bodies(seed, 6, 0.1).iter().map(heavier).collect(), law(1024.0), DOWN).unwrap();
        light.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.6).unwrap();
        heavy.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.6).unwrap();
        prop_assert_eq!(bits(&light.state), bits(&heavy.state));
    }

    #[test]
    fn a_scene_on_moving_ground_moves_as_one_at_rest(seed in any::<u64>()) {
        let speed = 3.0;
        let end = 0.5;
        let mut rest = tumbling(seed);
        let mut riding = tumbling(seed);
        for twist in &mut riding.state.twists {
            twist.linear.x += speed;
        }
        rest.by(Method::VelocityVerlet).run(&Still, 2e-4, end).unwrap();
        riding.by(Method::VelocityVerlet).run(&Shake::Cruise(speed), 2e-4, end).unwrap();
        for (pose, twist) in riding.state.poses.iter_mut().zip(&mut riding.state.twists) {
            pose.position.x -= speed * end;
            twist.linear.x -= speed;
        }
        riding.state.twists[0] = rest.state.twists[0];
        let error = apart(&rest.state, &riding.state);
        prop_assert!(error < 2e-9, "{error:e}"); // measured 1.8e-10
    }

    #[test]
    fn the_order_of_bodies_and_nodes_decides_no_more_than_rounding(seed in any::<u64>()) {
        let bodies = bodies(seed, 6, 0.1);
        let mut order: Vec<usize> = (1..bodies.len()).collect();
        let mut random = Random(seed);
        for i in (1..order.len()).rev() {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
            order.swap(i, random.within(0.0, (i + 1) as f64) as usize);
        }
        order.insert(0, 0);
        let shuffled: Vec<Body<Planar>> = order
            .iter()
            .map(|&i| {
                let mut body = bodies[i].clone();
                for nodes in &mut body.nodes {
                    if let Nodes::Fixed(nodes) = nodes {
                        nodes.reverse();
                    }
                }
                body
            })
            .collect();
        // The contactor and the target of every pair remain the same, whatever the order of the bodies.
        let place = |i: usize| order.iter().position(|&k| k == i).unwrap();
        let pairs: Vec<ContactPair> = all_pairs(&bodies)
            .into_iter()
            .map(|p| ContactPair { contactor: place(p.contactor), target: place(p.target), ..p })
            .collect();
        let mut here = Scene::new(bodies, rough(1.0, 1.0), DOWN).unwrap();
        let mut there = Scene::of(Model::new(shuffled, vec![rough(1.0, 1.0)], pairs, DOWN).unwrap());
        here.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
        there.by(Method::VelocityVerlet).run(&Still, 2e-4, 0.5).unwrap();
        let mut back = there.state.clone();
        for (k, &i) in order.iter().enumerate() {
            back.poses[i] = there.state.poses[k];
            back.twists[i] = there.state.twists[k];
        }
        let error = apart(&here.state, &back);
        prop_assert!(error < 1e-11, "{error:e}"); // measured 1.9e-13
    }

    #[test]
    fn the_near_list_gives_the_bits_of_testing_every_node(seed in any::<u64>()) {
        let run = |exhaustive: bool, method: Method| {
            let mut scene = tumbling(seed);
            if exhaustive {
                let poses = scene.state.poses.clone();
                scene.state.contact_elements.make_exhaustive(&scene.model, &poses);
            }
            let mut history = vec![];
            scene.by(method).watch(&Shake::Harmonic { acceleration: 3.0, omega: 9.0 }, 2e-4, 1.0, |state, scratch, energy| {
                let poses = state.poses.iter().zip(&state.twists);
                history.extend(poses.flat_map(|(p, t)| numbers(p, t)).map(f64::to_bits));
                history.push(energy.summary(0).residual.to_bits());
                history.push(scratch.contacts.len() as u64);
                ControlFlow::Continue(())
            }).unwrap();
            (history, scene.scratch.contact_evaluations)
        };
        for method in [Method::VelocityVerlet, Method::BogackiShampine { tolerance: 1e-5 }] {
            let ((near, few), (all, many)) = (run(false, method), run(true, method));
            prop_assert!(near == all, "{}: the near list missed a contact", method.name());
            prop_assert!(few < many, "the near list saved nothing");
        }
    }
}

/// Returns `true` if the near list and the exhaustive list agree on a scene that has a contact.
fn near_list_is_plain(scene: impl Fn() -> Scene, drive: &impl Drive<Planar>, end: f64) -> bool {
    let run = |exhaustive: bool| {
        let mut scene = scene();
        if exhaustive {
            let poses = scene.state.poses.clone();
            scene.state.contact_elements.make_exhaustive(&scene.model, &poses);
        }
        let mut touched = 0;
        scene
            .by(Method::VelocityVerlet)
            .watch(drive, 1e-3, end, |_, scratch, _| {
                touched += scratch.contacts.len();
                ControlFlow::Continue(())
            })
            .unwrap();
        (bits(&scene.state)[..=6 * scene.state.poses.len()].to_vec(), touched)
    };
    let (near, plain) = (run(false), run(true));
    plain.1 > 0 && near == plain
}

#[test]
fn the_near_list_sees_a_bar_that_turns_on_the_spot() {
    // The center of the bar stays in place, and its tip sweeps onto a disc that is not in the first list.
    let scene = || {
        let mut bar = finely_noded_block("bar", (2.0, 0.1), 40.0, 0.1, pose(0.0, 0.0, 0.0));
        bar.twist.angular = 0.5;
        let ball = disc("ball", 0.1, 20.0, 0.005, Vec2::new(0.6, 0.7));
        Scene::new(vec![bar, ball], rough(1.0, 1.0), Vec2::default()).unwrap()
    };
    assert!(near_list_is_plain(scene, &Still, 3.0));
}

#[test]
fn the_near_list_sees_ground_that_comes_to_a_body_at_rest() {
    let scene = || {
        let wall = Shape::Polygon(Polygon::rectangle(0.2, 2.0, 0.0).unwrap());
        let ball = disc("ball", 0.1, 20.0, 0.005, Vec2::new(1.0, 0.0));
        Scene::new(vec![ground_of(vec![centered(wall)]), ball], rough(1.0, 1.0), Vec2::default())
            .unwrap()
    };
    assert!(near_list_is_plain(scene, &Shake::Cruise(0.5), 3.0));
}

fn crossley() -> Interface<Planar> {
    interface(
        NormalLaw::HuntCrossley {
            stiffness: 4.0e6,
            dissipation: 0.4,
            exponent: Exponent::Hertzian,
        },
        FrictionLaw::Regularized { coefficient: 0.4, velocity: 0.02 },
    )
}

/// Returns a body four times as large in the same gravity.
fn four_times(body: &Body<Planar>) -> Body<Planar> {
    let mut body = body.clone();
    body.mass *= 64.0;
    body.inertia *= 1024.0;
    body.pose.position = body.pose.position * 4.0;
    body.twist = Twist { linear: body.twist.linear * 2.0, angular: body.twist.angular * 0.5 };
    for placed in &mut body.surfaces {
        placed.offset = placed.offset * 4.0;
        match &mut placed.surface {
            Shape::Circle(circle) => *circle = Circle { radius: 4.0 * circle.radius },
            Shape::HalfPlane(_) => {}
            Shape::Polygon(polygon) => *polygon = polygon.scaled(4.0),
            Shape::Cradle(_) | Shape::BarrelProfile(_) => unreachable!("not in these scenes"),
        }
    }
    for nodes in &mut body.nodes {
        match nodes {
            Nodes::Fixed(nodes) => {
                for node in nodes {
                    node.position = node.position * 4.0;
                    node.tributary_length *= 4.0;
                }
            }
            Nodes::Rounds(_) => unreachable!("not in these scenes"),
            Nodes::Whole(none) => match *none {},
            Nodes::Rolling { center, radius, tributary_length } => {
                *center = *center * 4.0;
                *radius *= 4.0;
                *tributary_length *= 4.0;
            }
        }
    }
    body
}

/// Returns the interface for bodies four times as large.
fn stiffer(interface: &Interface<Planar>) -> Interface<Planar> {
    let mut larger = interface.clone();
    match &mut larger.normal {
        NormalLaw::SpeedGap { stiffness, damping }
        | NormalLaw::KelvinVoigt { stiffness, damping } => {
            *stiffness *= 16.0;
            *damping *= 32.0;
        }
        NormalLaw::HuntCrossley { stiffness, dissipation, exponent } => {
            *stiffness *= match exponent {
                Exponent::Linear => 16.0,
                Exponent::Hertzian => 8.0,
            };
            *dissipation *= 0.5;
        }
        NormalLaw::Hertz { stiffness } => *stiffness *= 8.0,
        NormalLaw::Rebound { stiffness, speed, .. } => {
            *stiffness *= 8.0;
            *speed *= 2.0;
        }
    }
    match &mut larger.friction {
        FrictionLaw::Frictionless => {}
        FrictionLaw::Coulomb { tangential_stiffness, tangential_damping, .. } => {
            *tangential_stiffness *= 16.0;
            *tangential_damping *= 32.0;
        }
        FrictionLaw::Regularized { velocity, .. } => *velocity *= 2.0,
    }
    larger
}

#[test]
fn viscous_damping_brings_a_flying_body_to_its_terminal_speed() {
    let mut body = disc("disc", 0.2, 10.0, 0.02, Vec2::new(0.0, 50.0));
    body.twist = Twist { linear: Vec2::new(3.0, 0.0), angular: 5.0 };
    body.damping = Some([[20.0, 0.0, 0.0], [0.0, 40.0, 0.0], [0.0, 0.0, 0.4]]);
    let mut scene = Scene::new(vec![floor(), body], rough(1.0, 1.0), DOWN).unwrap();
    let totals = scene.by(Method::RungeKutta4).run(&Still, 1e-3, 2.0).unwrap();
    let twist = scene.state.twists[1];
    let (fall, mass) = (-10.0 * 9.80665 / 40.0, 10.0);
    // v = v∞ + (v₀ − v∞) e^{−c t/m} for each velocity.
    let error = (twist.linear.x - 3.0 * libm::exp(-20.0 * 2.0 / mass)).abs();
    assert!(error < 1e-12, "{error:e}"); // measured 4.9e-14
    let error = (twist.linear.z - fall * (1.0 - libm::exp(-40.0 * 2.0 / mass))).abs();
    assert!(error < 1e-12, "{error:e}"); // measured 4.9e-14
    let error = (twist.angular - 5.0 * libm::exp(-0.4 * 2.0 / (mass * 0.02))).abs();
    assert!(error < 1e-12, "{error:e}"); // measured 4.9e-14
    let summary = totals.energy.summary(0);
    assert!(summary.residual_ratio() < 1e-6, "{summary:?}"); // measured 1.4e-7
    assert!(summary.viscous > 40.0);
}

#[test]
fn bodies_that_collide_in_space_keep_momentum_and_angular_momentum() {
    let mut left = finely_noded_block("left", (0.3, 0.2), 30.0, 0.1, pose(-0.5, 0.05, 0.3));
    let mut right = disc("right", 0.2, 50.0, 0.02, Vec2::new(0.3, -0.1));
    left.twist = Twist { linear: Vec2::new(3.0, 0.2), angular: 2.0 };
    right.twist = Twist { linear: Vec2::new(-2.0, 0.0), angular: -1.0 };
    let mut scene = Scene::new(vec![left, right], rough(1.0, 1.0), Vec2::default()).unwrap();
    let momenta = |scene: &Scene| {
        let (mut linear, mut angular) = (Vec2::default(), 0.0);
        for (i, body) in scene.model.bodies().iter().enumerate() {
            let (pose, twist) = (scene.state.poses[i], scene.state.twists[i]);
            linear += twist.linear * body.mass;
            angular +=
                body.inertia * twist.angular + moment(pose.position, twist.linear * body.mass);
        }
        (linear, angular)
    };
    let (linear, angular) = momenta(&scene);
    scene.by(Method::VelocityVerlet).run(&Still, 1e-4, 0.6).unwrap();
    assert!((scene.state.twists[0].linear.x - 3.0).abs() > 1.0, "they must have collided");
    let (linear_after, angular_after) = momenta(&scene);
    assert!((linear_after - linear).length() < 4e-12); // measured 9.1e-14
    let drift = (angular_after - angular).abs();
    assert!(drift < 4e-11, "{drift:e}"); // measured 9.8e-13
}

#[test]
fn constants_per_length_do_not_depend_on_the_spacing_of_nodes() {
    let sunk = |spacing: f64| {
        let mut law = rough(1.0, 1.0);
        law.basis = barrelstack_dynamics::Basis::Length;
        let body = finely_noded_block("block", (0.6, 0.3), 40.0, spacing, pose(0.0, 0.15, 0.0));
        let scene = Scene::new(vec![floor(), body], law, DOWN).unwrap().settled(1e-10).unwrap();
        0.15 - scene.state.poses[1].position.z
    };
    // The tributary lengths of the corners include half of the short sides, whatever the spacing: subtract that.
    let exact = |spacing: f64| 40.0 * 9.80665 / (2.0e5 * (0.6 + spacing));
    for spacing in [0.3, 0.15, 0.05, 0.025] {
        let error = (sunk(spacing) / exact(spacing) - 1.0).abs();
        assert!(error < 1e-8, "{spacing}: {error:e}"); // measured 7.1e-11
    }
}

#[test]
fn a_drive_is_the_derivative_of_its_displacement() {
    fn check(drive: &impl Drive<Planar>) {
        for i in 0..200 {
            let (t, h) = (0.005 * f64::from(i) + 1e-3, 1e-6);
            let slope = (drive.at(t + h).0.x - drive.at(t - h).0.x) / (2.0 * h);
            assert!((slope - drive.at(t).1.x).abs() < 1e-6, "at {t}");
        }
    }
    check(&Shake::Harmonic { acceleration: 3.0, omega: 9.0 });
    check(&Shake::Cruise(2.0));
    check(&Shake::constant(2.0));
    check(&Shake::Ramped { acceleration: 2.0, ramp: 0.3 });
    check(&Shake::Rectangular { acceleration: 2.0, duration: 0.3 });
    check(&Shake::half_sine(2.0, 0.3));
}

#[test]
fn bits_tell_states_apart() {
    let mut scene = tumbling(1);
    let before = bits(&scene.state);
    scene.state.twists[3].angular += 1e-12;
    assert_ne!(before, bits(&scene.state));
}
