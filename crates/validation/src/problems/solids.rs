//! Solid bodies: no overlaps, impacts with penetrations of only millimeters, and smooth contact forces along
//! boundaries.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use barrelstack_dynamics::shape::{BarrelProfile, Polygon};
use barrelstack_dynamics::{
    Body, FrictionLaw, Model, Motion, Nodes, NormalLaw, Planar, Pose, Scratch, Shape, State, Still,
    Twist, Vec2, evaluate,
};

use super::overlaps;
use crate::problem::{absolute, relative, setting};
use crate::scene::{self, DOWN, Scene, centered, disc, floor, ground_of, interface};
use crate::{Effort, Failure, GRAVITY, Outcome, Problem};

const REBOUND: &str = "balance of energy of a spring k δ^1.5";

/// Mass (kg) of a full barrel.
const MASS: f64 = 270.0;
/// Stiffness (N/m^1.5) of the impact law of the barrel, the default in the catalog.
const STIFFNESS: f64 = 1.2e9;
/// Coefficient of restitution of the impact law of the barrel, the default in the catalog.
const RESTITUTION: f64 = 0.3;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    for height in [1.0, 2.0, 3.3] {
        list.push(depth(height));
        list.push(rebound("barrel", MASS, height));
    }
    list.push(rebound("rack corner", 10.0, 2.0));
    list.push(default_step());
    list.extend([(0.25, 2.0), (0.5, 2.0), (0.75, 2.0)].map(|(share, count)| flat(share, count)));
    list.push(smooth());
    list.extend([
        slope("two boxes", two_boxes),
        slope("a rail and the edge of a barrel", rail_and_barrel),
    ]);
    list.push(overlaps::problem());
    list
}

fn law() -> NormalLaw {
    NormalLaw::Rebound { stiffness: STIFFNESS, restitution: RESTITUTION, speed: 0.1 }
}

/// Returns the largest penetration (m) and the rebound speed (m/s) of a mass that hits the floor after a fall from a
/// height (m).
fn drop(mass: f64, height: f64, step: f64) -> Result<(f64, f64), Failure> {
    let radius = 0.35;
    let mut body = disc("mass", radius, mass, 0.01, Vec2::new(0.0, radius));
    body.twist = Twist { linear: Vec2::new(0.0, -speed_after(height)), angular: 0.0 };
    let mut scene =
        Scene::new(vec![floor(), body], interface(law(), FrictionLaw::Frictionless), DOWN)?;
    let (mut deepest, mut left) = (0.0_f64, None);
    scene.watch(&Still, step, 0.2, |state, _, _| {
        let depth = radius - state.poses[1].position.z;
        deepest = deepest.max(depth);
        if depth <= 0.0 && state.twists[1].linear.z > 0.0 {
            left = Some(state.twists[1].linear.z);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    })?;
    let left = left.ok_or_else(|| Failure::Absent("the mass does not leave the floor".into()))?;
    Ok((deepest, left))
}

fn speed_after(height: f64) -> f64 {
    (2.0 * GRAVITY * height).sqrt()
}

/// Creates the problem of the largest penetration of a falling barrel: `½ m v² + m g δ = ⅖ k δ^2.5`.
///
/// The barrel is so fast that the force on approach is practically that of the spring alone.
fn depth(height: f64) -> Problem {
    let energy = MASS * GRAVITY * height;
    let mut exact = 0.01;
    for _ in 0..100 {
        exact = ((energy + MASS * GRAVITY * exact) / (0.4 * STIFFNESS)).powf(0.4);
    }
    setting(
        format!("solids/depth-{height:.1}m"),
        format!("a full barrel of {MASS} kg falls {height} m onto the floor"),
        REBOUND,
    )
    .quantity("largest penetration", "m", relative(exact, 2e-3))
    .refined(move |_, level| Ok(drop(MASS, height, 1e-5 / 2.0_f64.powi(level))?.0))
}

/// Creates the problem of the rebound speed, which must not depend on the mass.
fn rebound(what: &str, mass: f64, height: f64) -> Problem {
    setting(
        format!("solids/restitution-{}-{height:.1}m", what.replace(' ', "-")),
        format!("a {what} ({mass} kg at the contact) falls {height} m onto the floor"),
        "the fraction e² of the energy is returned; Walton and Braun 1986",
    )
    .quantity("speed after the impact, divided by that before", "", relative(RESTITUTION, 2e-2))
    .by(move |effort| {
        let step = if effort == Effort::Full { 1e-6 } else { 1e-5 };
        let (depth, left) = drop(mass, height, step)?;
        let share = left / speed_after(height);
        Ok(Outcome::of(share).noted(format!("{:.1} mm deep", 1e3 * depth)))
    })
}

/// Creates the problem of the rebound, computed with the default time step of a stack.
fn default_step() -> Problem {
    setting(
        "solids/restitution-at-the-default-step",
        "a full barrel falls 3.3 m, computed with steps of 0.25 ms",
        "the fraction e² of the energy is returned; Walton and Braun 1986",
    )
    .quantity("speed after the impact, divided by that before", "", relative(RESTITUTION, 0.1))
    .by(|_| {
        let (depth, left) = drop(MASS, 3.3, 2.5e-4)?;
        let said = [1e-4, 5e-4].map(|step| drop(MASS, 3.3, step));
        let [fine, coarse] = said;
        let share = |left: f64| left / speed_after(3.3);
        let note = format!(
            "penetration {:.1} mm; ratio {:.3} at 0.1 ms, {:.3} at 0.5 ms",
            1e3 * depth,
            share(fine?.1),
            share(coarse?.1)
        );
        Ok(Outcome::of(share(left)).noted(note))
    })
}

/// Creates a body whose contacts are computed from its exact shape instead of from individual nodes.
fn solid(name: &str, shape: Shape, pose: Pose<Planar>) -> Body<Planar> {
    let rounds = Nodes::Rounds(shape.rounds(1.0));
    Body {
        name: name.into(),
        motion: Motion::Free,
        mass: 100.0,
        inertia: 10.0,
        damping: None,
        pose,
        twist: Twist::default(),
        surfaces: vec![centered(shape)],
        nodes: vec![rounds],
        faces: Vec::new(),
    }
}

/// Creates a box with corners rounded by 10 mm.
fn rounded_box(width: f64, height: f64) -> Shape {
    match Polygon::rectangle(width, height, 0.01) {
        Ok(polygon) => Shape::Polygon(polygon),
        Err(problem) => panic!("a box of {width} m by {height} m: {problem}"),
    }
}

fn two_boxes() -> [Shape; 2] {
    [rounded_box(1.0, 0.2), rounded_box(0.6, 0.2)]
}

/// Returns the cross-section of a rail and the longitudinal profile of a barrel.
fn rail_and_barrel() -> [Shape; 2] {
    let rail = Polygon::bar(Vec2::new(-0.48, 0.0), Vec2::new(0.48, 0.0), 0.012);
    let barrel = BarrelProfile::new(0.95, 0.58, 0.7).and_then(|profile| profile.rounded(0.01));
    match (rail, barrel) {
        (Ok(rail), Some(barrel)) => [Shape::Polygon(rail), Shape::BarrelProfile(barrel)],
        other => panic!("no shapes: {other:?}"),
    }
}

/// Creates a model of two bodies with two contact pairs, so that each body is the contactor in one pair and the target
/// in the other. The lower body is at the origin.
fn two(
    [below, above]: [Shape; 2],
    upper: Pose<Planar>,
    swapped: bool,
) -> Result<(Model<Planar>, State<Planar>), Failure> {
    let below = solid("below", below, Pose { position: Vec2::default(), orientation: 0.0 });
    let above = solid("above", above, upper);
    let ground = ground_of(vec![]);
    let bodies = if swapped { vec![ground, above, below] } else { vec![ground, below, above] };
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 0.0 };
    let laws = vec![interface(law, FrictionLaw::Frictionless)];
    let model = Model::new(bodies, laws, vec![scene::pair(1, 2), scene::pair(2, 1)], DOWN)?;
    let state = State::initial(&model);
    Ok((model, state))
}

/// Returns the forces on the upper box (horizontal and vertical force in N, moment in N m) and the number of contacts.
/// If `swapped` is `true`, the upper box precedes the lower one in the list of bodies.
fn forces_on(upper: Pose<Planar>, swapped: bool) -> Result<([f64; 3], usize), Failure> {
    let (model, state) = two(two_boxes(), upper, swapped)?;
    let mut scratch = Scratch::new(&model);
    evaluate(&model, &state, &mut scratch);
    let wrench = scratch.wrenches[if swapped { 1 } else { 2 }];
    Ok(([wrench.force.x, wrench.force.z, wrench.moment], scratch.contacts.len()))
}

/// Creates the problem of a box that lies flat on another box. There must be two contacts, at the ends of the overlap,
/// whichever box comes first.
fn flat(share: f64, count: f64) -> Problem {
    setting(
        format!("solids/flat-on-flat-{share:.2}"),
        format!("a box that lies flat on another box, with {share} of its width beyond the edge"),
        "two overlapping lines touch at the two ends of the overlap",
    )
    .quantity("contacts", "", absolute(count, 0.0))
    .by(move |_| {
        let pose = Pose { position: Vec2::new(share * 0.6, 0.2 - 1e-3), orientation: 0.0 };
        let (one, contacts) = forces_on(pose, false)?;
        let (other, swapped) = forces_on(pose, true)?;
        let apart = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if apart > 1e-9 * one[1].abs() || contacts != swapped {
            return Err(Failure::Absent(format!(
                "swapping the boxes changes the forces by {apart} N"
            )));
        }
        Ok(Outcome::of(contacts as f64).noted(format!("{:.0} N", one[1])))
    })
}

/// Creates the problem of the smoothness of forces while one box moves over the flats, edges and corners of another.
///
/// For neighboring points of a fine path, the change of force is divided by the contact stiffness and by the step
/// between the points. The quantity is the amount by which the largest such ratio exceeds 4; it is 0 if no ratio
/// exceeds 4.
fn smooth() -> Problem {
    setting(
        "solids/smooth-along-paths",
        "a box that is moved over the flats, edges and corners of another box on 40 paths",
        "forces of a spring of stiffness k change by k times the displacement",
    )
    .quantity(
        "largest jump of a force, divided by k times the step, in excess of 4",
        "",
        absolute(0.0, 1e-9),
    )
    .by(|effort| {
        let steps = if effort == Effort::Full { 4000 } else { 1000 };
        let (mut worst, mut touching) = (0.0_f64, 0_u64);
        for path in 0..40 {
            // From the left edge to the right one, sinking and rotating a little along the path.
            let lean = f64::from(path) / 40.0 - 0.5;
            let depth = 1e-3 * (1.0 + f64::from(path % 4));
            let at = |i: i32| {
                let share = f64::from(i) / f64::from(steps);
                let angle = 0.02 * lean * (2.0 * PI * share).sin();
                Pose { position: Vec2::new(1.7 * share - 0.85, 0.2 - depth), orientation: angle }
            };
            let mut before: Option<[f64; 3]> = None;
            for i in 0..=steps {
                let (forces, contacts) = forces_on(at(i), false)?;
                touching += contacts as u64;
                if let Some(before) = before {
                    let (from, to) = (at(i - 1), at(i));
                    let travel = (to.position - from.position).x.abs()
                        + (to.orientation - from.orientation).abs();
                    let jump = (0..2).map(|k| (forces[k] - before[k]).abs()).fold(0.0, f64::max);
                    worst = worst.max(jump / (1e6 * travel) - 4.0);
                }
                before = Some(forces);
            }
        }
        Ok(Outcome::of(worst.max(0.0)).noted(format!("{touching} contacts along the path")))
    })
}

/// Displacement (m, rad) to either side in the central finite difference.
const STEP: f64 = 1e-8;

/// Creates the problem that checks that the force is the negative gradient of the elastic energy, at poses all around
/// the lower body.
///
/// If force and gradient agree wherever two bodies press on each other, no path around a corner gains or loses energy.
/// The quantity is the largest difference between the two in any of the three components, divided by the force.
fn slope(what: &str, shapes: fn() -> [Shape; 2]) -> Problem {
    setting(
        format!("solids/slope-of-the-energy-{}", what.replace(' ', "-")),
        format!("{what}, in contact in poses all around each other"),
        "a conservative force is the negative gradient of its energy",
    )
    .quantity("largest difference, divided by the force", "", absolute(0.0, 1e-4))
    .by(move |effort| {
        let wanted = if effort == Effort::Full { 20_000 } else { 1000 };
        let (model, mut state) = two(shapes(), scene::pose(0.0, 0.0, 0.0), false)?;
        let mut scratch = Scratch::new(&model);
        let mut energy_and_force = |[x, z, orientation]: [f64; 3]| {
            state.poses[2] = Pose { position: Vec2::new(x, z), orientation };
            state.contact_elements.make_exhaustive(&model, &state.poses);
            evaluate(&model, &state, &mut scratch);
            let deepest = scratch.contacts.iter().map(|c| c.penetration).fold(0.0, f64::max);
            let wrench = scratch.wrenches[2];
            let force = [wrench.force.x, wrench.force.z, wrench.moment];
            (scratch.totals.elastic, force, deepest, scratch.contacts.len())
        };
        let (mut worst, mut count, mut several) = (0.0_f64, 0, 0);
        let mut at = [0.0; 3];
        while count < wanted {
            // A low-discrepancy sequence, which samples the poses evenly.
            for (value, step) in at.iter_mut().zip([0.819_172_5, 0.671_043_6, 0.549_700_5]) {
                *value = (*value + step) % 1.0;
            }
            let pose = [1.8 * at[0] - 0.9, 1.2 * at[1] - 0.6, 2.0 * PI * at[2]];
            let (_, force, deepest, contacts) = energy_and_force(pose);
            // At greater depths the cores of the bodies (the shapes without their rounded edges) may overlap; the
            // contact is not designed for this.
            if deepest == 0.0 || deepest > 0.015 {
                continue;
            }
            count += 1;
            several += usize::from(contacts > 1);
            let size = force[0].hypot(force[1]);
            for k in 0..3 {
                let moved = |step: f64| {
                    let mut pose = pose;
                    pose[k] += step;
                    pose
                };
                let change = energy_and_force(moved(STEP)).0 - energy_and_force(moved(-STEP)).0;
                worst = worst.max((change / (2.0 * STEP) + force[k]).abs() / size);
            }
        }
        Ok(Outcome::of(worst).noted(format!("{count} poses, {several} with several contacts")))
    })
}
