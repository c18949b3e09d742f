//! Properties that hold in every scene: symmetry, similitude, invariance, and energy balance.

use barrelstack_dynamics::{
    Body, ContactPair, Model, Nodes, NormalLaw, Planar, Shape, State, Still, Twist, Vec2,
};

use crate::drive::Shake;
use crate::problem::{absolute, relative, setting};
use crate::scene::{DOWN, Scene, all_pairs, coulomb, disc, floor, interface, points};
use crate::tumble::{self, rough};
use crate::{Effort, Failure, Outcome, Problem};

const SOURCE: &str = "symmetry of mechanics";
const BALANCE: &str = "balance of energy";

/// Returns the number of random heaps of bodies for which a problem is computed.
fn seeds(effort: Effort) -> u64 {
    match effort {
        Effort::Fast => 2,
        Effort::Full => 12,
    }
}

fn heap(seed: u64) -> Vec<Body<Planar>> {
    tumble::bodies(seed, 6, f64::INFINITY)
}

fn shaken(acceleration: f64) -> Shake {
    Shake::Harmonic { acceleration, omega: 9.0 }
}

/// Returns the position, rotation, velocity and spin of each body as six numbers.
fn numbers(state: &State<Planar>) -> Vec<[f64; 6]> {
    let bodies = state.poses.iter().zip(&state.twists);
    bodies
        .map(|(p, t)| {
            [p.position.x, p.position.z, p.orientation, t.linear.x, t.linear.z, t.angular]
        })
        .collect()
}

/// Returns the largest difference between two states, after the components of the first state have been scaled.
fn apart(a: &State<Planar>, scale: [f64; 6], b: &State<Planar>) -> f64 {
    numbers(a)
        .iter()
        .zip(numbers(b))
        .flat_map(|(x, y)| (0..6).map(move |k| (scale[k] * x[k] - y[k]).abs()))
        .fold(0.0, f64::max)
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        invariance("mirror", "mirrored heap on mirrored ground", 1e-10, mirror),
        invariance("froude", "heap four times as large, same gravity", 0.0, froude),
        invariance("mass-unit", "heap and contacts 1024 times as heavy", 0.0, mass_unit),
        invariance("galilean", "heap on ground that moves at 3 m/s", 1e-8, galilean),
        invariance("order", "heap with bodies and nodes in reverse order", 1e-10, order),
        invariance(
            "time-shift",
            "heap on ground at rest, with the time starting at 64 s",
            1e-9,
            time_shift,
        ),
        invariance("repeat", "the same heap run twice", 0.0, repeat),
        balance(),
        elastic_row(),
    ]
}

fn invariance(
    name: &str,
    title: &str,
    limit: f64,
    difference: fn(u64) -> Result<f64, Failure>,
) -> Problem {
    setting(format!("invariances/{name}"), title, SOURCE)
        .quantity("largest difference in m, rad, m/s, rad/s", "", absolute(0.0, limit))
        .by(move |effort| {
            let mut worst = 0.0_f64;
            for seed in 0..seeds(effort) {
                let found = difference(seed)?;
                worst = if found.is_nan() { f64::NAN } else { worst.max(found) };
            }
            Ok(Outcome::of(worst).noted(format!("worst of {} heaps", seeds(effort))))
        })
}

/// Time step (s) of the runs of heaps.
const STEP: f64 = 2e-4;
/// End time (s) of the runs of heaps.
const END: f64 = 0.5;

fn mirror(seed: u64) -> Result<f64, Failure> {
    let flip = |v: Vec2| Vec2::new(-v.x, v.z);
    let mirrored = |body: &Body<Planar>| {
        let mut body = body.clone();
        body.pose.position = flip(body.pose.position);
        body.pose.orientation = -body.pose.orientation;
        body.twist = Twist { linear: flip(body.twist.linear), angular: -body.twist.angular };
        // Rectangles, discs and floors are symmetric; their nodes are not.
        for nodes in &mut body.nodes {
            if let Nodes::Fixed(nodes) = nodes {
                for node in nodes {
                    node.position = flip(node.position);
                }
            }
        }
        body
    };
    let bodies = heap(seed);
    let image = bodies.iter().map(mirrored).collect();
    let mut here = Scene::new(bodies, rough(1.0, 1.0), DOWN)?;
    let mut there = Scene::new(image, rough(1.0, 1.0), DOWN)?;
    here.run(&shaken(3.0), STEP, END)?;
    there.run(&shaken(-3.0), STEP, END)?;
    Ok(apart(&here.state, [-1.0, 1.0, -1.0, -1.0, 1.0, -1.0], &there.state))
}

/// Returns a body that is four times as large, under the same gravity.
fn four_times(body: &Body<Planar>) -> Body<Planar> {
    let mut body = body.clone();
    body.mass *= 64.0;
    body.inertia *= 1024.0;
    body.pose.position = body.pose.position * 4.0;
    body.twist = Twist { linear: body.twist.linear * 2.0, angular: body.twist.angular * 0.5 };
    for placed in &mut body.surfaces {
        match &mut placed.surface {
            Shape::Circle(circle) => circle.radius *= 4.0,
            Shape::Polygon(polygon) => *polygon = polygon.scaled(4.0),
            // Half-planes have no size, and heaps contain no other shapes.
            Shape::HalfPlane(_) | Shape::Cradle(_) | Shape::BarrelProfile(_) => {}
        }
    }
    for nodes in &mut body.nodes {
        match nodes {
            Nodes::Fixed(nodes) => {
                for node in nodes {
                    node.position = node.position * 4.0;
                }
            }
            // Heaps consist of blocks with nodes and of discs.
            Nodes::Rounds(_) | Nodes::Whole(_) => {}
            Nodes::Rolling { radius, .. } => *radius *= 4.0,
        }
    }
    body
}

/// Compares a heap with a heap that is four times as large.
///
/// All factors are powers of two, so the two runs must be bit-identical up to these factors.
fn froude(seed: u64) -> Result<f64, Failure> {
    let bodies = heap(seed);
    let large = bodies.iter().map(four_times).collect();
    let mut small = Scene::new(bodies, rough(1.0, 1.0), DOWN)?;
    let mut large = Scene::new(large, rough(16.0, 32.0), DOWN)?;
    small.run(&shaken(0.0), STEP, END)?;
    large.run(&shaken(0.0), 2.0 * STEP, 2.0 * END)?;
    Ok(apart(&small.state, [4.0, 4.0, 1.0, 2.0, 2.0, 0.5], &large.state))
}

fn mass_unit(seed: u64) -> Result<f64, Failure> {
    let bodies = heap(seed);
    let mut heavy = bodies.clone();
    for body in &mut heavy {
        body.mass *= 1024.0;
        body.inertia *= 1024.0;
    }
    let mut light = Scene::new(bodies, rough(1.0, 1.0), DOWN)?;
    let mut heavy = Scene::new(heavy, rough(1024.0, 1024.0), DOWN)?;
    light.run(&shaken(3.0), STEP, END)?;
    heavy.run(&shaken(3.0), STEP, END)?;
    Ok(apart(&light.state, [1.0; 6], &heavy.state))
}

fn galilean(seed: u64) -> Result<f64, Failure> {
    let speed = 3.0;
    let mut rest = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
    let mut riding = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
    for twist in &mut riding.state.twists {
        twist.linear.x += speed;
    }
    rest.run(&Still, STEP, END)?;
    riding.run(&Shake::Cruise(speed), STEP, END)?;
    for (pose, twist) in riding.state.poses.iter_mut().zip(&mut riding.state.twists) {
        pose.position.x -= speed * END;
        twist.linear.x -= speed;
    }
    riding.state.twists[0] = rest.state.twists[0];
    Ok(apart(&rest.state, [1.0; 6], &riding.state))
}

fn order(seed: u64) -> Result<f64, Failure> {
    let bodies = heap(seed);
    let last = bodies.len();
    // The ground stays first; body i is swapped with body last − i.
    let place = |i: usize| if i == 0 { 0 } else { last - i };
    let mut turned: Vec<Body<Planar>> = (0..last).map(|i| bodies[place(i)].clone()).collect();
    for nodes in turned.iter_mut().flat_map(|body| &mut body.nodes) {
        if let Nodes::Fixed(nodes) = nodes {
            nodes.reverse();
        }
    }
    // Each pair keeps its bodies and their roles (contactor or target), although the bodies have new numbers.
    let pairs = all_pairs(&bodies)
        .into_iter()
        .map(|p| ContactPair { contactor: place(p.contactor), target: place(p.target), ..p })
        .collect();
    let mut here = Scene::new(bodies, rough(1.0, 1.0), DOWN)?;
    let mut there = Scene::of(Model::new(turned, vec![rough(1.0, 1.0)], pairs, DOWN)?);
    here.run(&Still, STEP, END)?;
    there.run(&Still, STEP, END)?;
    let mut back = there.state.clone();
    for i in 0..last {
        back.poses[i] = there.state.poses[place(i)];
        back.twists[i] = there.state.twists[place(i)];
    }
    Ok(apart(&here.state, [1.0; 6], &back))
}

fn time_shift(seed: u64) -> Result<f64, Failure> {
    let start = 64.0;
    let mut now = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
    let mut later = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
    later.state.time = start;
    now.run(&Still, STEP, END)?;
    later.run(&Still, STEP, start + END)?;
    Ok(apart(&now.state, [1.0; 6], &later.state))
}

fn repeat(seed: u64) -> Result<f64, Failure> {
    let run = || -> Result<Scene, Failure> {
        let mut scene = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
        scene.run(&shaken(3.0), STEP, END)?;
        Ok(scene)
    };
    Ok(apart(&run()?.state, [1.0; 6], &run()?.state))
}

fn balance() -> Problem {
    setting("invariances/energy-balance", "heap on shaking ground, one second", BALANCE)
        .quantity(
            "residual of the energy balance, divided by the energy exchanged",
            "",
            absolute(0.0, 1e-4).fast(1e-3),
        )
        .by(|effort| {
            let worst = |step: f64| -> Result<f64, Failure> {
                let mut worst = 0.0_f64;
                for seed in 0..seeds(effort) {
                    let mut scene = Scene::new(heap(seed), rough(1.0, 1.0), DOWN)?;
                    let totals = scene.run(&shaken(3.0), step, 1.0)?;
                    worst = worst.max(totals.energy.summary(0).residual_ratio());
                }
                Ok(worst)
            };
            if effort == Effort::Fast {
                return worst(1e-4).map(Outcome::of);
            }
            let errors = [worst(2e-5)?, worst(1e-5)?, worst(5e-6)?];
            Ok(Outcome {
                value: errors[2],
                order: Some((errors[0] / errors[2]).log2() / 2.0),
                note: format!(
                    "steps 20, 10, 5 µs: {:.1e}, {:.1e}, {:.1e}",
                    errors[0], errors[1], errors[2]
                ),
            })
        })
}

/// Creates the problem of Newton's cradle: elastic discs in a row, without friction.
fn elastic_row() -> Problem {
    setting(
        "invariances/elastic-row",
        "disc that strikes a row of four, elastic contacts, no gravity",
        BALANCE,
    )
    .quantity(
        "kinetic energy after the impact, divided by that before",
        "",
        relative(1.0, 1e-6).fast(1e-4),
    )
    .by(|effort| {
        let energy = |step: f64| -> Result<f64, Failure> {
            let mut bodies = vec![floor()];
            bodies[0].surfaces.clear();
            bodies[0].nodes = vec![points(&[])];
            for i in 0..5 {
                let x = if i == 0 { -0.3 } else { 0.2 * f64::from(i) };
                let mut ball = disc(&format!("ball {i}"), 0.1, 1.0, 0.005, Vec2::new(x, 0.0));
                if i == 0 {
                    ball.twist.linear.x = 1.0;
                }
                bodies.push(ball);
            }
            let law = NormalLaw::SpeedGap { stiffness: 1e5, damping: 0.0 };
            let laws = interface(law, coulomb(0.0, 1e5, 0.0));
            let mut scene = Scene::new(bodies, laws, Vec2::default())?;
            scene.run(&Still, step, 1.0)?;
            Ok(scene.state.twists.iter().map(|t| t.linear.length().powi(2)).sum())
        };
        crate::problem::refine(effort, 1.0, |level| {
            let coarse = if effort == Effort::Full { 1e-5 } else { 4e-5 };
            energy(coarse / 2.0_f64.powi(level))
        })
    })
}
