//! Rolling on a rim or on the staves: tops, discs, and barrels on a floor and on tubes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow;

use barrelstack_dynamics::math::{atan2, cos, sin};
use barrelstack_dynamics::solid::{Barrel, Capsule, Hull, Rounded};
use barrelstack_dynamics::{
    Body, ContactPair, Model, Nodes, Placed, Quaternion, Rotation3, Solid, Spatial, State, Still,
    Vec3,
};

use super::{G, Role, STEP, STIFFNESS, axis, down, firm, rough, scene, upright};
use crate::problem::{absent, relative, setting};
use crate::scene::{Scene, interface, pair};
use crate::spatial::{floor, free, gravity_on_slope, ground_of, solid, yaw};
use crate::swing::run_crossings;
use crate::{Failure, Problem};

/// Contents of a barrel of 225 liters: name, and the mass (kg) and the moments of inertia (kg·m²) of the barrel with
/// these contents. The moments are about the axis of the barrel and about a transverse axis.
const FILLS: [(&str, f64, f64, f64); 3] =
    [("frozen", 269.0, 14.1, 22.6), ("fluid", 269.0, 4.0, 8.5), ("empty", 48.0, 3.9, 6.0)];

pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![top("precession"), top("speed")];
    let discs = [
        (5.0, 38.739_665_6),
        (10.0, 27.445_349_0),
        (20.0, 19.555_910_0),
        (30.0, 16.174_053_3),
        (60.0, 12.289_622_9),
    ];
    list.extend(discs.map(|(degrees, exact)| disc(degrees, exact)));
    let wobbles = [
        [18.435_057_1, 12.516_623_3, 9.630_776_1],
        [29.678_751_3, 19.841_202_8, 14.971_922_9],
        [15.146_972_6, 10.312_630_7, 7.963_795_4],
    ];
    let rocks = [
        [0.780_151_379_4, 0.796_841_787_7, 0.844_238_672_1],
        [0.671_946_357_0, 0.691_114_670_8, 0.744_630_241_1],
        [0.855_274_213_5, 0.870_604_992_1, 0.914_519_033_5],
    ];
    let rolls = [0.569_987_625, 0.748_781_573, 0.481_664_791];
    for (fill, exact) in FILLS.into_iter().zip(wobbles) {
        list.extend(
            [5.0, 10.0, 15.0].into_iter().zip(exact).map(|(lean, exact)| wobble(fill, lean, exact)),
        );
    }
    for (fill, exact) in FILLS.into_iter().zip(rocks) {
        list.extend(
            [0.0, 5.0, 10.0].into_iter().zip(exact).map(|(lean, exact)| rock(fill, lean, exact)),
        );
    }
    for (fill, exact) in FILLS.into_iter().zip(rolls) {
        list.push(rail(fill, exact, Role::Contactor));
        list.push(rail(fill, exact, Role::Target));
        list.push(bears(fill));
    }
    list
}

/// Creates the shape of a barrel of 225 liters with a chime rounded by 10 mm.
fn barrel() -> Result<Barrel, Failure> {
    shaped(0.945, 0.2775, 0.345, 0.01)
}

fn shaped(length: f64, head: f64, bilge: f64, rounding: f64) -> Result<Barrel, Failure> {
    Barrel::new(length, head, bilge, rounding).map_err(absent)
}

/// Returns the mean rate (rad/s) at which the axis of body 1 precesses about the vertical, from the start to `end`
/// (s).
fn precession(scene: &mut Scene<Spatial>, step: f64, end: f64) -> Result<f64, Failure> {
    let (mut round, mut before) = (0.0, 0.0);
    scene.watch(&Still, step, end, |state, _, _| {
        let axis = axis(state.poses[1].orientation);
        let now = atan2(axis.y, axis.x);
        // Azimuths jump by a full turn.
        let turned: f64 = now - before;
        round += if turned > PI {
            turned - TAU
        } else if turned < -PI {
            turned + TAU
        } else {
            turned
        };
        before = now;
        ControlFlow::Continue(())
    })?;
    Ok(round / end)
}

/// Creates the problem of a top that precesses steadily while its spherical tip rolls.
fn top(which: &'static str) -> Problem {
    let (quantity, unit, exact) = match which {
        "speed" => ("speed of the center of the top after 1 s", "m/s", 0.344_417_790),
        _ => ("precession", "rad/s", 2.867_405_337_754),
    };
    setting(
        format!("space-barrels/top-{which}"),
        "top of 0.5 kg with a rolling tip of 5 mm, 200 rad/s",
        "steady precession without slip; Routh 1884",
    )
    .quantity(quantity, unit, relative(exact, 1e-3))
    .by(move |_| {
        let (mass, tip, length) = (0.5, 0.005, 0.06);
        let (lean, spin, round) = (25_f64.to_radians(), 200.0, 2.867_405_337_754);
        let stiffness = 1e7;
        let mut body = free("top", mass, Vec3::new(4e-4, 6e-4, 6e-4), Vec3::default());
        body.nodes = vec![Nodes::Rolling {
            center: Vec3::new(-length, 0.0, 0.0),
            radius: tip,
            tributary_length: 1.0,
        }];
        body.pose.orientation = upright(lean);
        let (axis, up) = (axis(upright(lean)), Vec3::new(0.0, 0.0, 1.0));
        let from_tip = axis * length + up * tip;
        body.pose.position = Vec3::new(0.0, 0.0, from_tip.z - mass * G / stiffness);
        body.twist.angular = axis * (spin - round * cos(lean)) + up * round;
        body.twist.linear = body.twist.angular.cross(from_tip);
        let laws = (firm(stiffness, mass), rough(0.5, stiffness, 0.1 * mass));
        let mut scene = scene(vec![floor(), body], laws.0, laws.1, down())?;
        let found = precession(&mut scene, 5e-6, 1.0)?;
        Ok(match which {
            "speed" => scene.state.twists[1].linear.length(),
            _ => found,
        })
    })
}

/// Creates a body of revolution that rolls on its lower rim while its center stays at rest.
///
/// The point of the rim on the floor is at rest, so the angular velocity is parallel to the line from the center to
/// this point.
fn running_round(
    shape: Barrel,
    (mass, about, across): (f64, f64, f64),
    lean: f64,
    round: f64,
) -> Result<Scene<Spatial>, Failure> {
    let inertia = Vec3::new(about, across, across);
    let (aside, height) = (
        shape.head_radius * cos(lean) - shape.half_length * sin(lean),
        shape.head_radius * sin(lean) + shape.half_length * cos(lean) + shape.rounding,
    );
    let place = Vec3::new(0.0, 0.0, height - mass * G / STIFFNESS);
    let mut body = solid("barrel", Hull::Barrel(shape), mass, inertia, place);
    body.pose.orientation = upright(lean);
    // The vector from the center to the floor, decomposed along the vertical and along the axis.
    let to_rim = Vec3::new(aside, 0.0, -height);
    let upward = -height - aside * cos(lean) / sin(lean);
    body.twist.angular = to_rim * (round / upward);
    scene(vec![floor(), body], firm(STIFFNESS, mass), rough(0.5, STIFFNESS, mass), down())
}

fn disc(degrees: f64, exact: f64) -> Problem {
    setting(
        format!("space-barrels/disc-{degrees}"),
        format!(
            "thin disc of 0.3 m that rolls on its rim at {degrees}° to the floor, for one turn"
        ),
        "Ω² = 4 g / (R sin α); Euler's disc",
    )
    .quantity("precession", "rad/s", relative(exact, 1e-3))
    .by(move |_| {
        let (mass, radius) = (20.0, 0.3);
        let square = mass * radius * radius;
        // The disc is so thin that its thickness has no effect.
        let shape = shaped(2e-5, radius, radius + 1.6e-10, 0.0)?;
        let bulk = (mass, 0.5 * square, 0.25 * square);
        let mut scene = running_round(shape, bulk, degrees.to_radians(), exact)?;
        precession(&mut scene, STEP, TAU / exact)
    })
}

fn wobble(
    (name, mass, about, across): (&'static str, f64, f64, f64),
    degrees: f64,
    exact: f64,
) -> Problem {
    setting(
        format!("space-barrels/chime-{name}-{degrees}"),
        format!("{name} barrel that wobbles on its chime at {degrees}° from upright, for 0.5 s"),
        "steady rolling of a rim; Euler's disc of a barrel",
    )
    .quantity("precession", "rad/s", relative(exact, 1e-3))
    .by(move |_| {
        let bulk = (mass, about, across);
        let mut scene = running_round(barrel()?, bulk, degrees.to_radians(), exact)?;
        precession(&mut scene, STEP, 0.5)
    })
}

/// Creates the problem of a barrel that rocks on its bilge along its length.
fn rock(
    (name, mass, about, across): (&'static str, f64, f64, f64),
    degrees: f64,
    exact: f64,
) -> Problem {
    setting(
        format!("space-barrels/bilge-{name}-{degrees}"),
        format!("{name} barrel that rocks on its bilge by {degrees}°"),
        "body with an arc that rolls on a floor",
    )
    .quantity("period", "s", relative(exact, 1e-3))
    .by(move |_| {
        // A small amplitude represents the limit of zero amplitude.
        let lean = if degrees == 0.0 { 0.003 } else { degrees.to_radians() };
        let inertia = Vec3::new(about, across, across);
        let height = 1.6875 - 1.3425 * cos(lean) - mass * G / STIFFNESS;
        let place = Vec3::new(0.0, 0.0, height);
        let mut body = solid("barrel", Hull::Barrel(barrel()?), mass, inertia, place);
        body.pose.orientation = Quaternion::turn(Vec3::new(0.0, lean, 0.0));
        let laws = (firm(STIFFNESS, mass), rough(1.0, STIFFNESS, mass));
        let mut scene = scene(vec![floor(), body], laws.0, laws.1, down())?;
        let rise = |state: &State<Spatial>| axis(state.poses[1].orientation).z;
        match run_crossings(&mut scene, STEP, exact, rise)?[..] {
            [first, second, ..] => Ok(2.0 * (second - first)),
            _ => Err(Failure::Absent("the barrel does not rock".into())),
        }
    })
}

/// Height (m) of the axis of a barrel above the axes of the tubes that support it.
const ABOVE_TUBES: f64 = 0.343_517_867_6;
/// Angle (rad) between the vertical and the normal of a contact between the barrel and a tube that supports it.
const CONTACT_ANGLE: f64 = 9.098_134_339 * PI / 180.0;
/// Slope (rad) of the tubes that support the barrel.
const SLOPE: f64 = 5.0 * PI / 180.0;

/// Creates a barrel at rest across two tubes that descend along `x`.
fn on_tubes(
    (_, mass, about, across): (&str, f64, f64, f64),
    role: Role,
) -> Result<Scene<Spatial>, Failure> {
    let tube = Capsule { half_length: 3.0, radius: 0.02 };
    let hull = Hull::Barrel(barrel()?);
    let gravity = gravity_on_slope(G, SLOPE, 0.0);
    let stiffness = 1e9;
    // Vertical penetration from the penetration along the normal.
    let press = -mass * gravity.z / (2.0 * cos(CONTACT_ANGLE));
    let sunk = press / (stiffness * cos(CONTACT_ANGLE));
    let place = Vec3::new(0.0, 0.0, ABOVE_TUBES - sunk);
    let mut body = solid("barrel", hull, mass, Vec3::new(about, across, across), place);
    body.pose.orientation = yaw(FRAC_PI_2);
    let sides = [-0.27, 0.27].map(|y| Vec3::new(0.0, y, 0.0));
    let (ground, pairs): (Body<Spatial>, Vec<ContactPair>) = match role {
        Role::Contactor => {
            let placed = sides.map(|offset| Placed {
                surface: Solid::Capsule(tube),
                offset,
                rotation: Rotation3::identity(),
            });
            let pairs = [0, 1].map(|surface| ContactPair { surface, ..pair(1, 0) });
            (ground_of(placed.to_vec()), pairs.to_vec())
        }
        Role::Target => {
            let placed = sides.map(|center| {
                Nodes::Whole(Rounded { center, ..Rounded::centered(Hull::Capsule(tube)) })
            });
            let pairs = [0, 1].map(|nodes| ContactPair { nodes, ..pair(0, 1) });
            (Body { nodes: placed.to_vec(), ..ground_of(Vec::new()) }, pairs.to_vec())
        }
    };
    let laws = interface(firm(stiffness, mass), rough(0.5, stiffness, mass));
    Ok(Scene::of(Model::new(vec![ground, body], vec![laws], pairs, gravity)?))
}

fn rail(fill: (&'static str, f64, f64, f64), exact: f64, role: Role) -> Problem {
    let as_what = if role == Role::Contactor { "contactor" } else { "target" };
    setting(
        format!("space-barrels/tubes-{}-{as_what}", fill.0),
        format!("{} barrel as {as_what} that rolls down two tubes on a slope of 5°", fill.0),
        "g sin θ / (1 + I / (m ρ²)) with the rolling radius ρ",
    )
    .quantity("acceleration", "m/s2", relative(exact, 1e-4))
    .by(move |_| {
        let mut scene = on_tubes(fill, role)?;
        scene.run(&Still, STEP, 0.3)?;
        let before = scene.state.twists[1].linear.x;
        scene.run(&Still, STEP, 0.8)?;
        Ok((scene.state.twists[1].linear.x - before) / 0.5)
    })
}

fn bears(fill: (&'static str, f64, f64, f64)) -> Problem {
    let exact = fill.1 * G * cos(SLOPE) / (2.0 * cos(CONTACT_ANGLE));
    setting(
        format!("space-barrels/tubes-{}-bear", fill.0),
        format!("{} barrel that rolls down two tubes on a slope of 5°", fill.0),
        "equilibrium of the barrel across the tubes",
    )
    .quantity("normal force of a tube", "N", relative(exact, 1e-4))
    .by(move |_| {
        let mut scene = on_tubes(fill, Role::Contactor)?;
        scene.run(&Still, STEP, 0.3)?;
        match scene.scratch.contacts[..] {
            [first, second] => Ok(0.5 * (first.normal_force + second.normal_force)),
            _ => Err(Failure::Absent("the barrel does not rest on both tubes".into())),
        }
    })
}
