//! Measures how fast a cellar is computed: the tables of `validation/cellar.md`.
//!
//! ```text
//! cargo run --release -p barrelstack-cellar --example cellar -- ROWS STACKS [THREADS [SECONDS [LEVELS [ALIKE]]]]
//! ```
//!
//! The cellar has rows of four-barrel racks, with walls around them, under the South Napa record of the demo. Every
//! stack is another variant unless ALIKE is 1; without SECONDS a room is run to rest.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use barrelstack::Scenario;
use barrelstack::assemble::{PartKind, law_in_space};
use barrelstack::scenario::Scene;
use barrelstack_cellar::{Obstacle, Placed, Room, RoomRun, Settings, run};
use barrelstack_space::Ground;

/// Distances (m) of a stack from the next one of its row, across the barrels, and from the next row, along them.
const PITCH: [f64; 2] = [1.75, 2.6];

/// Footprint (m) of a stack across and along its barrels.
const FOOTPRINT: [f64; 2] = [1.5, 1.95];

/// Distances (m) of the outermost stacks from the walls across and along the barrels.
const TO_WALL: [f64; 2] = [0.3, 0.46];

fn cellar(rows: u32, stacks: u32, alike: bool, changes: &[String]) -> Result<Room, Box<dyn Error>> {
    let stated = Scenario::builtin("demo-napa", changes)?;
    // Every stack has positions, masses and friction of its own.
    let planes = barrelstack::variants::planes(&stated)?;
    let middle = |at: u32, count: u32| f64::from(at) - 0.5 * f64::from(count - 1);
    let place = |number: u32| {
        let (row, stack) = (number / stacks, number % stacks);
        let at = [PITCH[0] * middle(stack, stacks), PITCH[1] * middle(row, rows)];
        let name = format!("{:02}-{:02}", row + 1, stack + 1);
        Placed::new(&name, planes[0].variant(if alike { 0 } else { number + 1 }), at)
    };
    let half = [stacks, rows].map(f64::from);
    let half: [f64; 2] = std::array::from_fn(|axis| {
        0.5 * (PITCH[axis] * (half[axis] - 1.0) + FOOTPRINT[axis]) + TO_WALL[axis]
    });
    let Scene::Stack { stack, .. } = &stated.scene else { return Err("a stack".into()) };
    let law = law_in_space("wall", &stack.interfaces.barrel_ground);
    let wall = |name: &str, axis: usize, side: f64| {
        let mut center = [0.0, 0.0, 2.5];
        let mut sides = [half[0] + 0.2, half[1] + 0.2, 2.5];
        center[axis] = side * (half[axis] + 0.1);
        sides[axis] = 0.1;
        let (name, interface) = (name.to_owned(), law.clone());
        Obstacle { name, center, half: sides, azimuth: 0.0, interface }
    };
    Ok(Room {
        stacks: (0..rows * stacks).map(place).collect(),
        obstacles: vec![
            wall("right wall", 0, 1.0),
            wall("left wall", 0, -1.0),
            wall("back wall", 1, 1.0),
            wall("front wall", 1, -1.0),
        ],
        ground: Ground::of_spec(&stated.motion, 1.0)?,
    })
}

/// Returns a number that differs if any bit of the result differs.
fn fingerprint(run: &RoomRun) -> u64 {
    let bits = run.bodies.iter().flat_map(|body| body.to).flat_map(|x| x.to_bits().to_le_bytes());
    barrelstack_input::fnv1a(&bits.collect::<Vec<u8>>())
}

/// Returns a line of the status of the process that starts with a name, where the system has one.
fn status(name: &str) -> String {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with(name)).unwrap_or_default();
    line.trim_start_matches(name).trim_start_matches(':').trim().to_owned()
}

/// Returns the processor time (s) of the process, where the system states it.
fn processor() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = text
        .rsplit(") ")
        .next()
        .unwrap_or_default()
        .split(' ')
        .filter_map(|field| field.parse().ok())
        .collect();
    // User and system time in hundredths of a second follow the state and ten numbers.
    fields.get(10).zip(fields.get(11)).map_or(f64::NAN, |(user, system)| (user + system) / 100.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = std::env::args().skip(1);
    let numbers: Vec<u32> = arguments.map(|arg| arg.parse()).collect::<Result<_, _>>()?;
    let number = |at: usize, default: u32| numbers.get(at).copied().unwrap_or(default);
    let (rows, stacks, threads) = (number(0, 11), number(1, 7), number(2, 0));
    let levels = number(4, 6);
    let mut changes = vec![
        "stack.view=spatial".to_owned(),
        "stack.rack=four-barrel".to_owned(),
        format!("stack.levels={levels}"),
    ];
    if let Some(seconds) = numbers.get(3).filter(|seconds| **seconds > 0) {
        changes.push(format!("run.duration={seconds} s"));
    }
    let start = Instant::now();
    let room = cellar(rows, stacks, number(5, 0) == 1, &changes)?;
    let settings = Settings { threads: usize::try_from(threads)?, ..Settings::default() };
    let (mut settled, mut shown) = (0.0, Instant::now());
    let run = run(&room, &settings, &mut |now| {
        if settled == 0.0 {
            settled = processor();
        }
        if shown.elapsed().as_secs() >= 20 {
            shown = Instant::now();
            let wall = start.elapsed().as_secs();
            eprintln!("{:.2} of {:.1} s, {} moving, {wall} s", now.time, now.end_time, now.moving);
        }
        ControlFlow::Continue(())
    })?;
    let (wall, cpu) = (start.elapsed().as_secs_f64(), processor());
    let barrels = run.bodies.iter().filter(|body| body.kind == PartKind::Barrel);
    let fallen = barrels.clone().filter(|body| body.fate.fell_at.is_some()).count();
    let lost = run.stacks.iter().filter(|stack| stack.lost_seat.is_some()).count();
    let knocked = run.stacks.iter().filter(|stack| stack.knocked_over).count();
    let moved: f64 = run.stacks.iter().map(|s| s.end_time * s.bodies.len() as f64).sum();
    println!(
        "{} barrels, {} bodies, {} stacks: {wall:.1} s, {cpu:.1} s of processor time ({settled:.1} s to settle), \
         {:.1} s of motion; {:.0} µs per body and simulated second; peak memory {}; {} lost a seat, \
         {knocked} of them knocked over, {fallen} barrels fell; {} stacks touched a wall or column, {} meetings, \
         {} merges, {} steps of islands; energy residual {:.1e}; fingerprint {:016x}",
        barrels.count(),
        run.bodies.len(),
        run.stacks.len(),
        run.end_time,
        1e6 * (cpu - settled) / moved,
        status("VmHWM"),
        lost,
        run.stacks.iter().filter(|stack| stack.touched_obstacle.is_some()).count(),
        run.meetings.len(),
        run.merges,
        run.work.steps,
        run.energy.map_or(f64::NAN, |energy| energy.residual_ratio()),
        fingerprint(&run),
    );
    for obstacle in &run.obstacles {
        println!(
            "{}: first contact {:?}, largest force {:.1} kN, impulse {:.0} N s",
            obstacle.name,
            obstacle.first.map(|(time, _)| time),
            1e-3 * obstacle.peak,
            obstacle.impulse.iter().map(|x| x * x).sum::<f64>().sqrt()
        );
    }
    Ok(())
}
