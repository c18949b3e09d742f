//! Dry friction: sticking contacts do not creep, sliding contacts follow Coulomb's law.

use crate::common;

use crate::common::{GRAVITY, Scene, assert_close, block, coulomb, floor, gravity_on_slope};
use crate::common::{interface, pose};
use barrelstack_dynamics::contact::Stick;
use barrelstack_dynamics::{FrictionLaw, NormalLaw, Planar, Still, Twist, Vec2};
use proptest::prelude::*;

const MASS: f64 = 50.0;
const STIFFNESS: f64 = 1e6;

/// Returns a law that is nearly rigid, damped on approach and on separation so that transients decay.
fn firm() -> NormalLaw {
    NormalLaw::KelvinVoigt { stiffness: STIFFNESS, damping: 1e4 }
}

/// Returns a low block on its two lower corners, settled, on a slope of an angle (rad).
fn sledge(friction: FrictionLaw, slope: f64, speed: f64) -> Scene {
    let (width, height) = (0.6, 0.1);
    let gravity = gravity_on_slope(slope);
    let sunk = -MASS * gravity.z / (2.0 * STIFFNESS);
    let mut body = block("sledge", (width, height), MASS, pose(0.0, 0.5 * height - sunk, 0.0));
    body.twist = Twist { linear: Vec2::new(speed, 0.0), angular: 0.0 };
    Scene::new(vec![floor(), body], interface(firm(), friction), gravity).unwrap()
}

/// Runs a scene; returns downhill velocity (m/s) and position (m).
fn run(scene: &mut Scene, until: f64, time_step: f64) -> (f64, f64) {
    scene.run(&Still, time_step, until).unwrap();
    (scene.state.twists[1].linear.x, scene.state.poses[1].position.x)
}

#[test]
fn a_stuck_block_hangs_on_its_sticks_by_its_weight_downhill() {
    let slope = libm::atan(0.3);
    let mut scene = sledge(coulomb(0.5, STIFFNESS, 1e4), slope, 0.0);
    run(&mut scene, 2.0, 5e-4);
    let sticks: f64 = (0..scene.state.contact_elements.len())
        .map(|i| scene.state.contact_elements.stick(i).displacement)
        .sum();
    let expected = MASS * GRAVITY * libm::sin(slope) / STIFFNESS;
    assert_close("sum of sticks", sticks, expected, 1e-12); // measured 2e-16
}

#[test]
fn regularized_friction_creeps_at_the_speed_it_announces() {
    for share in [0.3, 0.6, 0.9] {
        let law = FrictionLaw::Regularized { coefficient: 0.5, velocity: 0.01 };
        let mut scene = sledge(law, libm::atan(0.5 * share), 0.0);
        let (speed, _) = run(&mut scene, 2.0, 5e-4);
        assert_close("creep speed", speed, law.creep_speed(share), 1e-12); // measured 3e-15
    }
    assert_eq!(coulomb(0.5, 1e6, 1e3).creep_speed(0.9), 0.0);
}

#[test]
fn what_rests_is_held_by_the_static_coefficient_and_what_slides_by_the_kinetic() {
    let law = FrictionLaw::Coulomb {
        static_coefficient: 0.5,
        kinetic_coefficient: 0.3,
        tangential_stiffness: STIFFNESS,
        tangential_damping: 1e4,
    };
    let slope = libm::atan(0.37);
    let mut resting = sledge(law, slope, 0.0);
    let (_, start) = run(&mut resting, 1.0, 2e-4);
    let (_, end) = run(&mut resting, 5.0, 2e-4);
    assert!((end - start).abs() < 1e-12, "{:e}", end - start); // measured 0

    let mut sliding = sledge(law, slope, 0.5);
    let (start, _) = run(&mut sliding, 1.0, 2e-4);
    let (end, _) = run(&mut sliding, 2.0, 2e-4);
    let expected = GRAVITY * (libm::sin(slope) - 0.3 * libm::cos(slope));
    assert_close("acceleration", end - start, expected, 1e-10); // measured 1.4e-12

    // A block thrown uphill slows down, reverses, and is held by static friction.
    let mut thrown = sledge(law, slope, -0.5);
    let (_, place) = run(&mut thrown, 3.0, 2e-4);
    let (speed, end) = run(&mut thrown, 5.0, 2e-4);
    assert!(speed.abs() < 1e-12 && (end - place).abs() < 1e-12, "{speed:e} {:e}", end - place);
    let slow_down = GRAVITY * (libm::sin(slope) + 0.3 * libm::cos(slope));
    // Tangential springs that are stretched uphill relax, and the weight component of the block stretches them
    // downhill.
    let back = MASS * slow_down / (2.0 * STIFFNESS);
    assert_close("way uphill", -end, 0.25 / (2.0 * slow_down) - back, 5e-3); // measured 2.4e-3
}

#[test]
fn a_block_on_frictionless_ice_slides_for_ever() {
    let mut scene = sledge(FrictionLaw::Frictionless, 0.0, 1.5);
    let (speed, place) = run(&mut scene, 4.0, 1e-3);
    assert_eq!(speed, 1.5);
    assert_close("place", place, 6.0, 1e-12);
}

#[test]
fn a_lifted_node_forgets_its_stick() {
    let mut scene = sledge(coulomb(0.5, STIFFNESS, 1e4), libm::atan(0.3), 0.0);
    run(&mut scene, 1.0, 5e-4);
    assert!(scene.state.contact_elements.stick(0).displacement > 0.0);
    scene.state.twists[1].linear.z = 1.0;
    run(&mut scene, 1.05, 5e-4);
    assert!(scene.scratch.contacts.is_empty(), "the block is in the air");
    for element in 0..scene.state.contact_elements.len() {
        assert_eq!(scene.state.contact_elements.stick(element), Stick::<Planar>::default());
    }
}

#[test]
fn a_slope_to_the_left_mirrors_one_to_the_right() {
    let right = run(&mut sledge(coulomb(0.2, STIFFNESS, 1e4), 0.4, 0.0), 1.0, 5e-4);
    let left = run(&mut sledge(coulomb(0.2, STIFFNESS, 1e4), -0.4, 0.0), 1.0, 5e-4);
    assert_eq!((left.0, left.1), (-right.0, -right.1));
}

#[test]
fn a_node_slips_until_the_slip_turns_against_its_spring() {
    let law = FrictionLaw::Coulomb {
        static_coefficient: 0.5,
        kinetic_coefficient: 0.3,
        tangential_stiffness: 1e6,
        tangential_damping: 0.0,
    };
    // A normal force of 1000 N: breaks at 500 N, slides at 300 N.
    let commit = |displacement: f64, slipping: bool, slip: f64| {
        let stick: Stick<Planar> = Stick { displacement, slipping, tangent_plane: () };
        stick.commit(&law, slip, 1000.0, 1.0)
    };
    assert!(!commit(0.49e-3, false, 0.1).slipping);
    let broken = commit(0.51e-3, false, 0.1);
    assert!(broken.slipping && (broken.displacement - 0.3e-3).abs() < 1e-18);
    // Slipping continues while the slip follows the spring, even where the spring has become short.
    assert!(commit(0.2e-3, true, 0.1).slipping);
    assert!(!commit(0.2e-3, true, -0.1).slipping);
    assert!(!commit(-0.2e-3, true, 0.1).slipping);
}

#[test]
fn a_stick_stores_half_its_force_times_its_stretch() {
    let law = coulomb(0.5, 1e6, 0.0);
    let found = |displacement: f64| {
        let stick: Stick<Planar> = Stick { displacement, slipping: false, tangent_plane: () };
        law.force::<Planar>(stick, 0.0, 1000.0, 1.0)
    };
    assert!(
        (found(0.2e-3).energy - 0.02).abs() < 1e-15 && (found(0.2e-3).force - 200.0).abs() < 1e-12
    );
}

#[test]
fn what_sticks_held_at_the_start_is_not_counted_as_lost() {
    let mut scene =
        sledge(coulomb(0.5, STIFFNESS, 1e4), libm::atan(0.3), 0.0).settled(1e-10).unwrap();
    let summary = scene.run(&Still, 5e-4, 0.5).unwrap().energy.summary(0);
    assert!(summary.stick > 1e-3, "{summary:?}");
    assert!(summary.friction.abs() < 1e-9 && summary.residual.abs() < 1e-9, "{summary:?}");
}

fn any_law() -> impl Strategy<Value = FrictionLaw> {
    prop_oneof![
        (0.0..1.0_f64, 0.0..1.0_f64, 1e3..1e7_f64, 0.0..1e4_f64).prop_map(
            |(kinetic, more, tangential_stiffness, tangential_damping)| FrictionLaw::Coulomb {
                static_coefficient: kinetic + more,
                kinetic_coefficient: kinetic,
                tangential_stiffness,
                tangential_damping,
            }
        ),
        (0.0..1.0_f64, 1e-4..0.1_f64)
            .prop_map(|(coefficient, velocity)| FrictionLaw::Regularized { coefficient, velocity }),
        Just(FrictionLaw::Frictionless),
    ]
}

fn largest_coefficient(law: &FrictionLaw) -> f64 {
    match *law {
        FrictionLaw::Frictionless => 0.0,
        FrictionLaw::Coulomb { static_coefficient, .. } => static_coefficient,
        FrictionLaw::Regularized { coefficient, .. } => coefficient,
    }
}

fn any_stick() -> impl Strategy<Value = Stick<Planar>> {
    (-0.01..0.01_f64, any::<bool>()).prop_map(|(displacement, slipping)| Stick {
        displacement,
        slipping,
        tangent_plane: (),
    })
}

proptest! {
    #![proptest_config(common::cases(300))]

    #[test]
    fn friction_stays_within_its_cone(
        law in any_law(), stick in any_stick(), slip in -2.0..2.0_f64, normal in 0.0..1e5_f64,
        weight in 0.01..1.0_f64,
    ) {
        let found = law.force::<Planar>(stick, slip, normal, weight);
        let limit = largest_coefficient(&law) * normal;
        prop_assert!(found.force.abs() <= limit * (1.0 + 1e-15));
        prop_assert!(found.energy >= 0.0);
    }

    #[test]
    fn friction_without_a_stretched_stick_opposes_the_slip(
        law in any_law(), slip in -2.0..2.0_f64, normal in 0.0..1e5_f64
    ) {
        let found = law.force::<Planar>(Stick::default(), slip, normal, 1.0);
        prop_assert!(found.force * slip >= 0.0);
    }

    #[test]
    fn a_committed_stick_holds_no_more_than_friction_can(
        law in any_law(), stick in any_stick(), slip in -2.0..2.0_f64, normal in 0.0..1e5_f64,
        weight in 0.01..1.0_f64,
    ) {
        let kept = stick.commit(&law, slip, normal, weight);
        if let FrictionLaw::Coulomb { tangential_stiffness, .. } = law {
            let spring = tangential_stiffness * weight * kept.displacement;
            prop_assert!(spring.abs() <= largest_coefficient(&law) * normal * (1.0 + 1e-12));
            // The displacement never reverses or grows, and a second commit changes nothing.
            prop_assert!(kept.displacement * stick.displacement >= 0.0);
            prop_assert!(kept.displacement.abs() <= stick.displacement.abs());
            let spring_alone = law.force::<Planar>(kept, 0.0, normal, weight);
            prop_assert!((spring_alone.force - spring).abs() <= 1e-12 * spring.abs());
        } else {
            prop_assert_eq!(kept, Stick::default());
        }
    }

    #[test]
    fn friction_of_a_mirrored_slip_is_mirrored(
        law in any_law(), stick in any_stick(), slip in -2.0..2.0_f64, normal in 0.0..1e5_f64
    ) {
        let mirrored = Stick { displacement: -stick.displacement, ..stick };
        let (here, there) = (
            law.force::<Planar>(stick, slip, normal, 1.0),
            law.force::<Planar>(mirrored, -slip, normal, 1.0),
        );
        prop_assert_eq!(here.force, -there.force);
        prop_assert_eq!(here.energy, there.energy);
        let (here, there) =
            (stick.commit(&law, slip, normal, 1.0), mirrored.commit(&law, -slip, normal, 1.0));
        prop_assert_eq!(here.displacement, -there.displacement);
        prop_assert_eq!(here.slipping, there.slipping);
    }
}
