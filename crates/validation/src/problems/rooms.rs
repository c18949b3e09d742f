//! Rooms of stacks: impacts between stacks and on walls, rows of dominoes, stacks that stand alone, and symmetry.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::OnceLock;

use barrelstack::Scenario;
use barrelstack_cellar::{Obstacle, Placed, Room, RoomRun, Settings};
use barrelstack_dynamics::math::{cos, pow, sin};
use barrelstack_dynamics::{Basis, FrictionLaw, Interface, NormalLaw};
use barrelstack_space::Ground;

use crate::dominoes::{DOMINO, Row, theory};
use crate::ode::solution;
use crate::problem::{Reference, absent, absolute, relative, setting};
use crate::{Failure, Outcome, Problem};

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = pounding();
    list.extend(rebound());
    list.extend([(0.2, 28), (0.3, 20), (0.4, 20), (0.5, 20)].map(|(s, count)| wave(s, count)));
    list.extend([alone(), turned(), reversed()]);
    list
}

/// Returns a room that is shaken by the motion of its first stack's scenario.
fn room(stacks: Vec<Placed>) -> Result<Room, Failure> {
    let ground = Ground::of_spec(&stacks[0].scenario.motion, 1.0).map_err(absent)?;
    Ok(Room { stacks, obstacles: Vec::new(), ground })
}

fn run(room: &Room, threads: usize) -> Result<RoomRun, Failure> {
    let settings = Settings { threads, ..Settings::default() };
    barrelstack_cellar::run(room, &settings, &mut |_| ControlFlow::Continue(())).map_err(absent)
}

/// Returns a wall whose face at `x` (m) faces the negative x-direction.
fn wall(x: f64, normal: NormalLaw) -> Obstacle {
    let name = "wall".to_owned();
    let interface = Interface {
        name: name.clone(),
        normal,
        stop: None,
        rolling: None,
        friction: FrictionLaw::Frictionless,
        basis: Basis::Seat,
    };
    Obstacle { name, center: [x + 0.1, 0.0, 1.0], half: [0.1, 3.0, 1.0], azimuth: 0.0, interface }
}

/// Name of a problem, name and unit of its quantity, reference value, and the function that computes the quantity from
/// a run.
type Measure = (&'static str, &'static str, &'static str, Reference, fn(&RoomRun) -> Option<f64>);

/// Creates the problems whose quantities are computed from one run.
fn measured(
    title: &str,
    source: &str,
    run: fn() -> Result<&'static RoomRun, Failure>,
    measures: Vec<Measure>,
) -> Vec<Problem> {
    let problem = |(name, quantity, unit, reference, of): Measure| {
        let own = setting(format!("rooms/{name}"), title, source);
        own.quantity(quantity, unit, reference)
            .by(move |_| of(run()?).ok_or_else(|| absent("the bodies do not meet")))
    };
    measures.into_iter().map(problem).collect()
}

/// Returns the run that is stored in a cell; the first caller computes it.
fn once(
    cell: &'static OnceLock<Result<RoomRun, String>>,
    compute: fn() -> Result<RoomRun, Failure>,
) -> Result<&'static RoomRun, Failure> {
    cell.get_or_init(|| compute().map_err(|error| error.to_string())).as_ref().map_err(absent)
}

/// Mass (kg) and speed (m/s) of the first block, gap (m), and stiffness (N/m) at each of the four corners of a face.
const BLOCK: [f64; 4] = [50.0, 0.8, 0.05, 1e6];

/// Duration (s) of the runs in which two blocks collide.
const POUNDING: f64 = 1.2;

/// Returns a block on a smooth floor with a velocity (m/s).
fn block(velocity: f64) -> Result<Scenario, Failure> {
    let [mass, .., spring] = BLOCK;
    let text = format!(
        "schema = 1\nkind = \"free-spatial\"\n[[body]]\nname = \"block\"\nkind = \"block\"\nmass = \"{mass} kg\"\n\
         solid = {{ type = \"block\", sides = [\"0.4 m\", \"0.3 m\", \"0.2 m\"] }}\n\
         position = [\"0 m\", \"0 m\", \"0.1 m\"]\nvelocity = [\"{velocity} m/s\", \"0 m/s\", \"0 m/s\"]\n\
         [[interface]]\nbetween = [\"block\", \"ground\"]\nstiffness = \"1 MN/m\"\ndamping = \"1 kN s/m\"\n\
         friction = {{ coefficient = 0 }}\n\
         [[interface]]\nbetween = [\"block\", \"block\"]\nlaw = \"kelvin-voigt\"\nstiffness = \"{spring} N/m\"\n\
         damping = \"0 N s/m\"\nfriction = {{ coefficient = 0 }}\n\
         [run]\nduration = \"{POUNDING} s\"\nuntil = \"duration\"\nstep = \"0.02 ms\"\n"
    );
    Ok(Scenario::parse("block.toml", &text, &[])?)
}

/// Contact law of a wall that a block strikes.
const SPRING: NormalLaw = NormalLaw::KelvinVoigt { stiffness: BLOCK[3], damping: 0.0 };

/// Simulates two blocks: the first strikes the second, which then crosses a second gap and rebounds from a wall.
fn pounded() -> Result<RoomRun, Failure> {
    let [_, speed, gap, _] = BLOCK;
    let mut room = room(vec![
        Placed::new("A", block(speed)?, [0.0, 0.0]),
        Placed::new("B", block(0.0)?, [0.4 + gap, 0.0]),
    ])?;
    room.obstacles.push(wall(0.6 + 2.0 * gap, SPRING));
    run(&room, 1)
}

/// Creates the problems of two equal blocks, A and B, and a wall: A strikes B across a gap; B then strikes the wall.
///
/// Since the masses are equal and the contacts are elastic, the blocks exchange their velocities. A moves to B and
/// stops; B moves to the wall, returns to A and stops; A then moves back at the initial speed. The impulse of the wall
/// on B is twice the momentum of B.
fn pounding() -> Vec<Problem> {
    static RUN: OnceLock<Result<RoomRun, String>> = OnceLock::new();
    let [mass, speed, gap, spring] = BLOCK;
    let (momentum, stiffness) = (mass * speed, 4.0 * spring);
    let first = gap / speed;
    // Half a period of two masses joined by a spring, and of one mass on a spring.
    let together = PI / (2.0 * stiffness / mass).sqrt();
    let back = PI / (stiffness / mass).sqrt();
    // While the springs of two blocks are in contact, B moves by half of the distance that A would have moved: v T / 2.
    let away = first + together + (gap - 0.5 * speed * together) / speed;
    // B stands where it met A again, and A moves back with the full speed.
    let again = away + back + gap / speed - 0.5 * together;
    let end = gap - speed * (POUNDING - again - together);
    measured(
        "two equal blocks that pound across a gap, the second of which comes back from a wall",
        "momentum and energy; half a period of springs: T = π √(m/2k) and π √(m/k)",
        || once(&RUN, pounded),
        vec![
            // measured below 1e-6 s
            ("pounding-time", "time of the first contact", "s", absolute(first, 3e-5), |run| {
                Some(run.meetings.first()?.time)
            }),
            // measured 8e-5
            (
                "pounding-impulse",
                "impulse between the blocks in both impacts",
                "N s",
                relative(2.0 * momentum, 1e-3),
                |run| Some(run.meetings.first()?.impulse),
            ),
            // measured 4e-6
            (
                "pounding-peak",
                "largest force between the blocks",
                "N",
                relative(speed * (0.5 * mass * stiffness).sqrt(), 1e-4),
                |run| Some(run.meetings.first()?.peak),
            ),
            // measured 1.3e-5 s
            (
                "pounding-wall-time",
                "time of the first contact with the wall",
                "s",
                absolute(away, 5e-5),
                |run| Some(run.obstacles.first()?.first?.0),
            ),
            // measured 8e-5
            (
                "pounding-wall-impulse",
                "impulse on the wall",
                "N s",
                relative(2.0 * momentum, 1e-3),
                |run| Some(run.obstacles.first()?.impulse[0]),
            ),
            // measured 1.1e-4
            (
                "pounding-wall-peak",
                "largest force on the wall",
                "N",
                relative(speed * (mass * stiffness).sqrt(), 1e-3),
                |run| Some(run.obstacles.first()?.peak),
            ),
            // measured 3.2e-4
            (
                "pounding-energy",
                "kinetic energy at the end",
                "J",
                relative(0.5 * momentum * speed, 1e-3),
                |run| Some(run.energy?.kinetic),
            ),
            // measured 1.4e-10
            (
                "pounding-balance",
                "residual of the energy balance, divided by the energy exchanged",
                "",
                absolute(0.0, 1e-5),
                |run| Some(run.energy?.residual_ratio()),
            ),
            // measured 1.3e-4 m
            (
                "pounding-first-end",
                "displacement of the first block at the end",
                "m",
                absolute(end, 5e-4),
                |run| Some(run.bodies.first()?.fate.moved.x),
            ),
            // measured 4e-7 m
            (
                "pounding-second-end",
                "displacement of the second block at the end",
                "m",
                absolute(0.0, 1e-4),
                |run| Some(run.bodies.get(1)?.fate.moved.x),
            ),
        ],
    )
}

/// Mass (kg) and speed (m/s) of a barrel that rolls, its distance (m) from the wall, and its radius (m).
const BARREL: [f64; 4] = [280.0, 0.9, 0.1, 0.345];

/// Stiffness (N/m^1.5) of the wall, coefficient of restitution, and speed (m/s) below which the restitution is higher.
const REBOUND: [f64; 3] = [1.2e9, 0.4, 0.05];

/// Simulates a barrel that moves on a smooth floor and strikes a wall. The barrel spins as if it rolled. Since no
/// contact has friction, the spin does not change.
fn thrown_back() -> Result<RoomRun, Failure> {
    let ([mass, speed, gap, radius], [stiffness, restitution, slow]) = (BARREL, REBOUND);
    let text = format!(
        "schema = 1\nkind = \"free-spatial\"\n\
         [[body]]\nname = \"barrel\"\nmass = \"{mass} kg\"\norientation = [\"0 deg\", \"0 deg\", \"90 deg\"]\n\
         solid = {{ type = \"barrel\", length = \"0.945 m\", bilge_diameter = \"0.69 m\", head_diameter = \"0.555 m\" }}\n\
         position = [\"0 m\", \"0 m\", \"{radius} m\"]\nvelocity = [\"{speed} m/s\", \"0 m/s\", \"0 m/s\"]\n\
         spin = [\"0 rad/s\", \"{} rad/s\", \"0 rad/s\"]\n\
         [[interface]]\nbetween = [\"barrel\", \"ground\"]\nstiffness = \"5 MN/m\"\ndamping = \"5 kN s/m\"\n\
         friction = {{ coefficient = 0 }}\n\
         [run]\nduration = \"0.3 s\"\nuntil = \"duration\"\nstep = \"0.005 ms\"\n",
        speed / radius
    );
    let scenario = Scenario::parse("barrel.toml", &text, &[])?;
    let mut room = room(vec![Placed::new("A", scenario, [0.0, 0.0])])?;
    room.obstacles
        .push(wall(radius + gap, NormalLaw::Rebound { stiffness, restitution, speed: slow }));
    run(&room, 1)
}

/// Returns the force (N) of the rebound law at a penetration (m) and its rate (m/s).
fn force([depth, rate]: [f64; 2]) -> f64 {
    let [stiffness, restitution, slow] = REBOUND;
    let back = restitution * restitution;
    let share = rate / (rate * rate + slow * slow).sqrt();
    let spring = stiffness * pow(depth.max(0.0), 1.5);
    spring * 0.5 * (1.0 + back + (1.0 - back) * share)
}

/// Returns the penetration (m) of the barrel into the wall and its rate (m/s) at nondecreasing times (s), from an
/// independent integration of `m x'' = -f(x, x')`.
fn history(times: impl IntoIterator<Item = f64>) -> impl Iterator<Item = [f64; 2]> {
    let [mass, speed, gap, _] = BARREL;
    let mut last = (gap / speed, [0.0, speed]);
    times.into_iter().map(move |time| {
        if time > last.0 {
            let rates = |_, state: &[f64; 2]| [state[1], -force(*state) / mass];
            last = (time, solution(rates, last.1, (last.0, time)));
        }
        last.1
    })
}

/// Returns the largest of nonnegative numbers; NaN if a number is NaN or if there are no numbers.
fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |one: f64, other: f64| if other > one || other.is_nan() { other } else { one };
    numbers.into_iter().reduce(larger).unwrap_or(f64::NAN)
}

/// Compares the force on the wall with that of the independent integration. Returns the largest difference at any step,
/// divided by the largest force on the wall; `None` if the room has no wall.
fn apart(run: &RoomRun) -> Option<f64> {
    let wall = run.obstacles.first()?;
    let exact = history(wall.history.iter().map(|(time, _)| *time));
    let pairs = wall.history.iter().zip(exact);
    let most = largest(pairs.map(|((_, own), state)| (own[0] - force(state)).abs()));
    Some(most / wall.peak)
}

/// Creates the problems of a barrel that rolls into a wall and is thrown back.
fn rebound() -> Vec<Problem> {
    static RUN: OnceLock<Result<RoomRun, String>> = OnceLock::new();
    let ([mass, speed, gap, _], [_, restitution, _]) = (BARREL, REBOUND);
    let times = (0..).map(|at| gap / speed + 5e-6 * f64::from(at));
    let states: Vec<_> = history(times).take_while(|state| state[0] >= 0.0).collect();
    let peak = states.iter().map(|state| force(*state)).fold(0.0, f64::max);
    let leaves = states.last().map_or(f64::NAN, |state| state[1]);
    measured(
        "a barrel that rolls into a wall at 0.9 m/s and is thrown back",
        "equation of motion with the rebound law, solved by a library",
        || once(&RUN, thrown_back),
        vec![
            // measured 3.9e-6 s
            (
                "rebound-time",
                "time of the first contact",
                "s",
                absolute(gap / speed, 1e-5),
                |run| Some(run.obstacles.first()?.first?.0),
            ),
            // measured 1e-6
            ("rebound-peak", "largest force on the wall", "N", relative(peak, 1e-4), |run| {
                Some(run.obstacles.first()?.peak)
            }),
            // measured 1.3e-7
            (
                "rebound-impulse",
                "impulse on the wall",
                "N s",
                relative(mass * (speed - leaves), 1e-4),
                |run| Some(run.obstacles.first()?.impulse[0]),
            ),
            // measured 7.4e-5
            (
                "rebound-history",
                "largest difference of the force at any step, divided by the largest force",
                "",
                absolute(0.0, 1e-4),
                apart,
            ),
            // The restitution of the law is slightly higher at low speed; measured 0.044.
            (
                "rebound-speed",
                "speed after the impact, divided by the speed before it",
                "",
                relative(restitution, 0.06),
                |run| Some(run.obstacles.first()?.impulse[0] / (BARREL[0] * BARREL[1]) - 1.0),
            ),
            // The wall pushes along its normal only, and the weight stays on the floor: measured 1e-14 m.
            (
                "rebound-rise",
                "vertical displacement of the barrel",
                "m",
                absolute(0.0, 1e-3),
                |run| Some(run.bodies.first()?.fate.moved.z),
            ),
        ],
    )
}

/// Creates the problem of a row of dominoes, each of which is a stack of its own.
fn wave(spacing: f64, count: u32) -> Problem {
    setting(
        format!("rooms/dominoes-{spacing}"),
        format!("a row of {count} smooth dominoes at {spacing} heights, each a stack of its own"),
        "van Leeuwen 2010, American Journal of Physics 78, 721",
    )
    // measured 1.1 to 1.6 % below theory
    .quantity(
        "speed of the wave, divided by the root of gravity and height",
        "",
        relative(theory(DOMINO, spacing), 0.025),
    )
    .by(move |_| Row { count, spacing, friction: 0.0 }.speed())
}

/// Creates the problem of stacks that are far apart.
fn alone() -> Problem {
    setting(
        "rooms/far-apart",
        "three stacks of two levels that are 20 m apart, the last one turned by 30°, under a record",
        "mechanics: stacks that meet nobody move as each does alone",
    )
    .quantity("stacks of which a bit differs from the stack alone", "", absolute(0.0, 0.0))
    .by(|_| {
        let demo = |azimuth: u32| {
            let changes = [
                "stack.view=spatial".to_owned(),
                "stack.levels=2".to_owned(),
                "run.duration=1 s".to_owned(),
                format!("stack.azimuth=\"{azimuth} deg\""),
            ];
            Scenario::builtin("demo-napa", &changes)
        };
        let (straight, turned) = (demo(0)?, demo(30)?);
        let stack = |at: u32| {
            Placed::new(&format!("S{at}"), straight.clone(), [20.0 * f64::from(at), 1.3])
        };
        let mut stacks: Vec<Placed> = (0..3).map(stack).collect();
        stacks[2].azimuth = 30_f64.to_radians();
        let run = run(&room(stacks)?, 2)?;
        let mut differ = 0;
        for (stack, scenario) in run.stacks.iter().zip([&straight, &straight, &turned]) {
            let own = barrelstack_space::run::run(scenario).map_err(absent)?;
            let fates = run.bodies[stack.bodies.clone()].iter().map(|body| &body.fate);
            let same = fates.eq(&own.fates[1..])
                && (stack.end_time, &stack.outcome) == (own.end_time, &own.outcome)
                && stack.touched.is_none();
            differ += u32::from(!same);
        }
        Ok(Outcome::of(f64::from(differ)).noted(format!("{} stacks", run.stacks.len())))
    })
}

/// Returns a room with two blocks that strike each other; the second block then strikes a wall. The room is turned by
/// the angle `turn` (rad), and the second block by the angle `own` (rad) about its own vertical axis; `side` is -1
/// for the mirror image.
fn glancing(turn: f64, own: f64, side: f64) -> Result<Room, Failure> {
    let place = |x: f64, y: f64| [cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y];
    let at = |name: &str, scenario: Scenario, [x, y]: [f64; 2], own: f64| Placed {
        azimuth: turn + own,
        ..Placed::new(name, scenario, place(x, y))
    };
    // The center of the second block lies beside the path of the first, so the impact turns both blocks.
    let mut room = room(vec![
        at("A", block(side * BLOCK[1])?, [0.0, 0.0], 0.0),
        at("B", block(0.0)?, [side * 0.45, 0.1], own),
    ])?;
    let wall = wall(0.7, SPRING);
    let [x, y] = place(side * wall.center[0], 0.0);
    room.obstacles.push(Obstacle { center: [x, y, wall.center[2]], azimuth: turn, ..wall });
    Ok(room)
}

/// Simulates a room of [`glancing`] blocks. Returns an error if the blocks do not touch each other, or if the second
/// block does not touch the wall.
fn met(room: &Room, threads: usize) -> Result<RoomRun, Failure> {
    let run = run(room, threads)?;
    let all = !run.meetings.is_empty() && run.obstacles[0].first.is_some();
    all.then_some(run).ok_or_else(|| absent("the blocks do not meet each other and the wall"))
}

/// Creates the problem of a room that is turned or mirrored.
fn turned() -> Problem {
    // measured 1.3e-15 m
    setting(
        "rooms/turned-and-mirrored",
        "two blocks that pound, turn and meet a wall; the room turned, mirrored, or with a block turned by 180°",
        "symmetry of mechanics",
    )
    .quantity("largest difference from the room itself", "m", absolute(0.0, 1e-12))
    .by(|_| {
        // The ends of both blocks, in the room before it was turned and mirrored.
        let ends = |turn: f64, own: f64, side: f64| -> Result<[[f64; 2]; 2], Failure> {
            let run = met(&glancing(turn, own, side)?, 1)?;
            Ok([0, 1].map(|body| {
                let [x, y, ..] = run.bodies[body].to;
                let (sin, cos) = (sin(turn), cos(turn));
                [side * (cos * x + sin * y), cos * y - sin * x]
            }))
        };
        let straight = ends(0.0, 0.0, 1.0)?;
        let others = [(0.7, 0.0, 1.0), (0.0, PI, 1.0), (0.0, 0.0, -1.0), (-2.0, PI, -1.0)];
        let mut apart = Vec::new();
        for (turn, own, side) in others {
            let other = ends(turn, own, side)?;
            let pairs = straight.as_flattened().iter().zip(other.as_flattened().to_owned());
            apart.extend(pairs.map(|(one, other)| (one - other).abs()));
        }
        let aside = straight[1][1] - 0.1;
        if aside.abs() < 0.01 {
            return Err(absent("the blocks do not turn"));
        }
        Ok(Outcome::of(largest(apart)).noted(format!("the second block moves {aside:.3} m to the side")))
    })
}

/// Creates the problem of a room whose stacks are listed in the reverse order.
fn reversed() -> Problem {
    setting(
        "rooms/order",
        "two blocks that pound, turn and meet a wall, listed in the reverse order, on two threads",
        "symmetry of mechanics",
    )
    .quantity("blocks whose pose at the end differs by a bit", "", absolute(0.0, 0.0))
    .by(|_| {
        let mut room = glancing(0.7, 0.0, 1.0)?;
        let one = met(&room, 1)?;
        room.stacks.reverse();
        let other = met(&room, 2)?;
        let bits = |pose: &[f64; 7]| pose.map(f64::to_bits);
        let pairs = one.bodies.iter().zip(other.bodies.iter().rev());
        Ok(pairs.filter(|(one, other)| bits(&one.to) != bits(&other.to)).count() as f64)
    })
}
