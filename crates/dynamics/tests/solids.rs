//! Three-dimensional solids: distances compared with exact distances, and invariants at any pose.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::f64::consts::PI;

use crate::common::Dice;
use barrelstack_dynamics::contact::Stick;
use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::shape::{Surface, Whole};
use barrelstack_dynamics::solid::{Ball, Barrel, Block, Capsule, Hull, Rounded};
use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{
    FrictionLaw, NormalLaw, Quaternion, Rotation3, Solid, Space, Spatial, Vec3, evaluate,
};
use barrelstack_scenes::scene::{Scene, interface};
use barrelstack_scenes::spatial::{floor, solid};

/// Returns a barrel of 225 liters with a chime rounded by 10 mm.
fn bordeaux() -> Barrel {
    Barrel::new(0.945, 0.2775, 0.345, 0.01).unwrap()
}

/// Returns the rotation from `x` to a direction.
fn along(direction: Vec3) -> Rotation3 {
    let to = direction * (1.0 / direction.length());
    let from = Vec3::new(1.0, 0.0, 0.0);
    // A vector halfway gives the quaternion of the full rotation.
    let half = (from + to) * (1.0 / (from + to).length());
    Quaternion { w: from.dot(half), v: from.cross(half) }.matrix()
}

/// Returns a capsule from point to point, in place: its hull, center and rotation.
fn capsule(from: Vec3, to: Vec3, radius: f64) -> (Rounded, Vec3, Rotation3) {
    let half_length = 0.5 * (to - from).length();
    let hull = Hull::Capsule(Capsule { half_length, radius });
    (Rounded::centered(hull), (from + to) * 0.5, along(to - from))
}

#[test]
fn the_core_is_the_barrel_drawn_in_by_its_chime() {
    let core = bordeaux();
    assert!((core.half_length - 0.4625).abs() < 1e-15);
    assert!((core.head_radius - 0.269_982_558_045_203).abs() < 1e-14); // measured 2e-16
    assert!((core.stave_radius - 1.6775).abs() < 1e-14);
    assert!((core.stave_offset - 1.3425).abs() < 1e-14);
    assert!(Barrel::new(0.945, 0.345, 0.345, 0.01).is_err(), "a cylinder has no stave arc");
    assert!(Barrel::new(0.945, 0.2775, 0.345, 0.5).is_err(), "nothing is left of the core");
}

#[test]
fn capsules_are_as_far_from_a_barrel_as_they_are() {
    let point = Vec3::new;
    let cases = [
        ((point(0.27, -0.7, -0.33), point(0.27, 0.7, -0.33)), -0.013_346_450_288_522_3),
        ((point(0.1, -0.7, -0.40), point(0.35, 0.6, -0.30)), -0.003_053_050_821_474_8),
        ((point(0.47, -0.5, -0.20), point(0.50, 0.5, -0.33)), -0.010_500_783_635_494_8),
    ];
    let normals = [
        Some(point(0.159_371_623, 0.0, -0.987_218_662)),
        None,
        Some(point(0.993_547_113, -0.043_427_407, -0.104_776_876)),
    ];
    for (((from, to), exact), normal) in cases.into_iter().zip(normals) {
        let (tube, at, turned) = capsule(from, to, 0.02);
        let found = tube.closest(&Solid::Barrel(bordeaux()), at, turned).unwrap();
        let off = found.distance - exact;
        assert!(found.converged && off.abs() < 1e-10, "{off:e}"); // measured 2e-16
        if let Some(normal) = normal {
            assert!((found.normal - normal).length() < 1e-8); // given to nine digits
        }
    }
}

#[test]
fn barrels_are_as_far_from_each_other_as_they_are() {
    let other = Rounded::centered(Hull::Barrel(bordeaux()));
    let target = Solid::Barrel(bordeaux());
    let across = along(Vec3::new(0.0, 1.0, 0.0));
    let crossed = other.closest(&target, Vec3::new(0.0, 0.0, 0.68), across).unwrap();
    assert!((crossed.distance + 0.01).abs() < 1e-10, "{:e}", crossed.distance + 0.01); // 1e-16
    assert!((crossed.normal - Vec3::new(0.0, 0.0, 1.0)).length() < 1e-8);
    let leaning = along(Vec3::new(0.2, 0.3, 1.0));
    let on_head = other.closest(&target, Vec3::new(0.85, 0.05, 0.15), leaning).unwrap();
    let off = on_head.distance - 0.008_524_857_055_249_4;
    assert!(off.abs() < 1e-10, "{off:e}"); // measured 1e-16
    assert!((on_head.normal - Vec3::new(1.0, 0.0, 0.0)).length() < 1e-8);
}

/// Returns points and gaps of a hull on the floor.
fn on_floor(hull: Hull, height: f64, turned: Rotation3) -> Vec<f64> {
    let mut gaps = Vec::new();
    Rounded::centered(hull).meet(
        &Solid::HalfSpace,
        Vec3::new(0.0, 0.0, height),
        turned,
        true,
        |patch| {
            gaps.push(patch.deepest.gap.distance);
        },
    );
    gaps
}

#[test]
fn a_barrel_stands_as_high_on_the_floor_as_it_does() {
    let cases = [
        (0.0, 0.345),
        (5.0, 0.350_108_618),
        (16.2602, 0.398_683_225),
        (20.0, 0.421_884_934),
        (45.0, 0.527_943_384),
        (80.0, 0.512_355_565),
        (90.0, 0.4725),
    ];
    for (degrees, exact) in cases {
        let turn = Quaternion::turn(Vec3::new(0.0, f64::to_radians(degrees), 0.0));
        let gaps = on_floor(Hull::Barrel(bordeaux()), 0.0, turn.matrix());
        let height = -gaps.into_iter().fold(f64::INFINITY, f64::min);
        // The table has nine digits.
        assert!((height - exact).abs() < 6e-10, "{degrees}: {height}");
    }
}

/// Returns a solid as target and as contactor, and the distance of its boundary from its core.
fn as_both(hull: Hull) -> (Solid, Rounded, f64) {
    let grown = match hull {
        Hull::Barrel(barrel) => barrel.rounding,
        Hull::Capsule(tube) => tube.radius,
        Hull::Block(block) => block.rounding,
    };
    (hull.surface(), Rounded::centered(hull), grown)
}

/// Asserts, for a number of poses of one solid around another, that the search converges, is optimal, and agrees from
/// both sides.
fn meet_anyhow(one: Hull, other: Hull, poses: u32) {
    let ((target, target_hull, grown), (other_target, contactor, more)) =
        (as_both(one), as_both(other));
    let reach = target.reach() + other_target.reach();
    let mut dice = Dice(7);
    let (mut apart, mut evaluations, mut most) = (0_u32, 0_u64, 0);
    let (mut swapped, mut bent, mut turned_over) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut seen = 0;
    while seen < poses {
        let at = dice.vector() * reach;
        let rotation = dice.orientation().matrix();
        let found = contactor.closest(&target, at, rotation).unwrap();
        // Bodies with overlapping cores have no distance along a normal.
        if found.distance <= -(grown + more) * 0.99 {
            continue;
        }
        seen += 1;
        assert!(found.converged, "pose {seen}: {at:?} {rotation:?}");
        evaluations += u64::from(found.evaluations);
        most = most.max(found.evaluations);
        apart += u32::from(found.distance > 0.0);
        // Optimal: the distance of each core point from the other body is as expected.
        let (point, normal) = (found.point, found.normal);
        let gap = target.gap(point + normal * more);
        let across = point - normal * (found.distance + grown);
        let back = other_target.gap(rotation.unapply(across - at));
        bent = bent
            .max((gap.distance - found.distance - more).abs())
            .max((back.distance - found.distance - grown).abs());
        // If the cores are very close, the normal is lost in rounding.
        if found.distance + grown + more > 1e-3 {
            let off = (gap.normal - found.normal).length();
            let off = off.max((rotation.apply(back.normal) + found.normal).length());
            turned_over = turned_over.max(off);
        }
        let swap =
            target_hull.closest(&other_target, rotation.unapply(-at), rotation.back()).unwrap();
        assert!(swap.converged);
        swapped = swapped.max((swap.distance - found.distance).abs());
    }
    let mean = evaluations as f64 / f64::from(poses);
    println!(
        "{poses} poses, {apart} apart, {mean:.1} evaluations, {most} at most: swapped {swapped:.1e} m, \
         off {bent:.1e} m, normals {turned_over:.1e}"
    );
    assert!(
        swapped < 1e-12 && bent < 1e-12 && turned_over < 1e-8,
        "{swapped:e} {bent:e} {turned_over:e}"
    );
}

const TUBE: Hull = Hull::Capsule(Capsule { half_length: 0.7, radius: 0.02 });

fn all_pairs(poses: u32) {
    let barrel = Hull::Barrel(bordeaux());
    let small = Hull::Barrel(Barrel::new(0.7, 0.2, 0.27, 0.015).unwrap());
    meet_anyhow(barrel, TUBE, poses);
    meet_anyhow(barrel, barrel, poses);
    meet_anyhow(barrel, small, poses);
    meet_anyhow(TUBE, TUBE, poses);
    let block = Hull::Block(Block { half: Vec3::new(0.5, 0.04, 0.3), rounding: 0.01 });
    meet_anyhow(block, TUBE, poses);
    meet_anyhow(block, barrel, poses);
    meet_anyhow(block, block, poses);
}

#[test]
fn every_pose_is_found_whichever_body_asks() {
    all_pairs(10_000);
}

#[test]
#[ignore = "a million poses a pair take a minute"]
fn every_pose_of_a_million_is_found_whichever_body_asks() {
    all_pairs(1_000_000);
}

#[test]
fn distances_do_not_jump_along_paths_over_chime_and_bilge() {
    let target = Solid::Barrel(bordeaux());
    let mut dice = Dice(11);
    let mut worst = 0.0_f64;
    for path in 0..1000 {
        let hull = if path % 2 == 0 { TUBE } else { Hull::Barrel(bordeaux()) };
        let contactor = Rounded::centered(hull);
        let reach = if path % 2 == 0 { 0.72 } else { 0.56 };
        let turned = dice.orientation();
        // Along the barrel, just above its bilge and past its end.
        let from = Vec3::new(0.0, 0.0, 0.36 + 0.3 * (0.5 + 0.5 * dice.roll()));
        let (way, spin) = (Vec3::new(0.6 + reach, 0.1 * dice.roll(), -0.2), dice.vector() * 2.0);
        let mut before: Option<f64> = None;
        for i in 0..400 {
            let share = f64::from(i) / 400.0;
            let rotation = Quaternion::turn(spin * share).after(turned).matrix();
            let found = contactor.closest(&target, from + way * share, rotation).unwrap();
            if found.distance < -0.019 {
                before = None;
                continue;
            }
            // A distance changes by no more than the displacements of its bodies.
            let moved = (way.length() + spin.length() * reach) / 400.0;
            if let Some(before) = before {
                worst = worst.max((found.distance - before).abs() - moved);
            }
            before = Some(found.distance);
        }
    }
    assert!(worst < 1e-9, "{worst:e}");
}

/// Returns the energy (J) of a barrel on the floor, and the force and moment on it.
fn pressed(height: f64, orientation: Quaternion) -> (f64, Vec3, Vec3) {
    let law = NormalLaw::KelvinVoigt { stiffness: 1e6, damping: 0.0 };
    let at = Vec3::new(0.3, -0.2, height);
    let inertia = Vec3::new(4.0, 8.0, 8.0);
    let mut body = solid("barrel", Hull::Barrel(bordeaux()), 269.0, inertia, at);
    body.pose.orientation = orientation;
    let laws = interface(law, FrictionLaw::Frictionless);
    let mut scene: Scene<Spatial> = Scene::new(vec![floor(), body], laws, Vec3::default()).unwrap();
    evaluate(&scene.model, &scene.state, &mut scene.scratch);
    let wrench = scene.scratch.wrenches[1];
    (scene.scratch.totals.elastic, wrench.force, wrench.moment)
}

#[test]
fn a_barrel_that_stands_leans_or_lies_is_pushed_down_the_slope_of_its_energy() {
    let mut dice = Dice(3);
    let mut worst = 0.0_f64;
    for case in 0..200 {
        // Upright with all four points in contact, leaning, or lying.
        let lean = match case % 4 {
            0 => 0.004 * dice.roll(),
            1 => 0.05 * dice.roll(),
            2 => 0.8 * dice.roll(),
            _ => PI / 2.0 + 0.2 * dice.roll(),
        };
        let heading = PI * dice.roll();
        let aside = Vec3::new(-sin(heading), cos(heading), 0.0);
        let upright = Quaternion::turn(Vec3::new(0.0, -PI / 2.0, 0.0));
        let turned = Quaternion::turn(aside * lean).after(upright);
        let lowest = on_floor(Hull::Barrel(bordeaux()), 0.0, turned.matrix());
        let lowest = lowest.into_iter().fold(f64::INFINITY, f64::min);
        let height = -lowest - 0.002 * (1.1 + dice.roll());
        let (_, force, moment) = pressed(height, turned);
        let h = 1e-7;
        let slope = |moved: &dyn Fn(f64) -> (f64, Quaternion)| {
            let energy = |way: f64| {
                let (height, orientation) = moved(way);
                pressed(height, orientation).0
            };
            (energy(-h) - energy(h)) / (2.0 * h)
        };
        let up = slope(&|way| (height + way, turned));
        worst = worst.max((force.z - up).abs() / force.z);
        for axis in [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)] {
            let turn = slope(&|way| (height, Quaternion::turn(axis * way).after(turned)));
            worst = worst.max((moment.dot(axis) - turn).abs() / force.z);
        }
    }
    assert!(worst < 1e-5, "{worst:e}");
}

#[test]
fn a_barrel_settles_on_its_head_and_stays() {
    let inertia = Vec3::new(4.0, 8.0, 8.0);
    let place = Vec3::new(0.0, 0.0, 0.474);
    let mut body = solid("barrel", Hull::Barrel(bordeaux()), 269.0, inertia, place);
    body.pose.orientation = Quaternion::turn(Vec3::new(0.0, -PI / 2.0, 0.0));
    let law = NormalLaw::SpeedGap { stiffness: 1e7, damping: 1e4 };
    let friction = barrelstack_scenes::scene::coulomb(0.5, 1e7, 1e4);
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let scene = Scene::new(vec![floor(), body], interface(law, friction), gravity).unwrap();
    let scene = scene.settled(1e-9).unwrap();
    let forces: Vec<f64> = scene.scratch.contacts.iter().map(|c| c.normal_force).collect();
    let weight: f64 = forces.iter().sum();
    // All friction acts on the four tangential springs around the center of pressure, which is the middle of the head.
    for force in &forces[1..] {
        assert!((force / weight - 0.25).abs() < 1e-6, "{forces:?}");
    }
    let sunk = 0.4725 - scene.state.poses[1].position.z;
    assert!((sunk * 4e7 / weight - 1.0).abs() < 1e-6, "{sunk}");
    assert!((weight / (269.0 * 9.81) - 1.0).abs() < 1e-6, "{weight}");
}

#[test]
fn balls_touch_every_solid() {
    let ball = Solid::Ball(Ball { radius: 0.1 });
    let barrel = Rounded::centered(Hull::Barrel(bordeaux()));
    let beside = Rotation3::identity();
    let found = barrel.closest(&ball, Vec3::new(0.0, 0.0, -0.45), beside).unwrap();
    // On the bilge: center to center less both radii; the normal points out of the ball.
    assert!((found.distance - (0.45 - 0.345 - 0.1)).abs() < 1e-14);
    assert!((found.normal - Vec3::new(0.0, 0.0, -1.0)).length() < 1e-14);
    let other = Solid::Barrel(bordeaux()).gap(Vec3::new(0.0, 0.0, 0.45));
    assert!((other.distance - 0.105).abs() < 1e-14);
}

#[test]
fn a_stick_keeps_its_length_and_its_plane_wherever_it_is_carried() {
    let mut dice = Dice(5);
    for _ in 0..1000 {
        let unit = |v: Vec3| v * (1.0 / v.length());
        let (from, to) = (unit(dice.vector()), unit(dice.vector()));
        let displacement = Spatial::<f64>::tangential(dice.vector(), from);
        let stick: Stick<Spatial> = Stick { displacement, slipping: false, tangent_plane: from };
        let carried = stick.carried(to);
        let length = carried.displacement.length();
        let scale = 1.0 / (1.0 + from.dot(to)).max(1e-9);
        assert!(carried.displacement.dot(to).abs() < 1e-15 * scale);
        assert!((length - displacement.length()).abs() < 1e-15 * scale);
        // And back again.
        let back = carried.carried(from).displacement - displacement;
        assert!(back.length() < 1e-14 * scale);
    }
}
