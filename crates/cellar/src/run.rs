//! Run of a room.

use std::ops::ControlFlow;

use barrelstack::run::Work;
use barrelstack::watch::Ending;
use barrelstack_space::Run;

use crate::result::{BodyEnd, ObstacleEnd, RoomRun, StackEnd};
use crate::room::{Placed, Room, RoomFailure, Settings};

/// Progress of a run.
#[derive(Clone, Debug, Default)]
pub struct Advance {
    /// Simulated time (s) that all stacks have reached or at which they rest.
    pub time: f64,
    /// Simulated time (s) at which the run ends at the latest.
    pub end_time: f64,
    /// Number of stacks that move.
    pub moving: usize,
    /// Stacks that have come to rest since the last call, by their indices. A stack that is hit later moves again.
    pub rested: Vec<usize>,
}

/// Runs a room to rest.
///
/// The observer receives the progress at least every second, and may stop the run; the results until then are returned.
///
/// # Errors
/// If a stack cannot be built or does not stand, or stacks or obstacles overlap.
pub fn run(
    room: &Room,
    settings: &Settings,
    observer: &mut dyn FnMut(&Advance) -> ControlFlow<()>,
) -> Result<RoomRun, RoomFailure> {
    let _ = settings;
    if room.stacks.is_empty() {
        return Err(RoomFailure::Empty);
    }
    let mut all = RoomRun {
        bodies: Vec::new(),
        stacks: Vec::new(),
        meetings: Vec::new(),
        obstacles: Vec::new(),
        frames: Vec::new(),
        energy: None,
        work: Work::default(),
        merges: 0,
        end_time: 0.0,
        interrupted: false,
        warnings: room.ground.warnings.clone(),
    };
    for obstacle in &room.obstacles {
        all.obstacles.push(ObstacleEnd { name: obstacle.name.clone(), ..ObstacleEnd::default() });
    }
    for (index, placed) in room.stacks.iter().enumerate() {
        let ground = room.ground.clone().turned(placed.azimuth);
        let mut look = |now: barrelstack::Progress| {
            observer(&Advance {
                time: now.time,
                end_time: now.end_time,
                moving: room.stacks.len() - index,
                rested: Vec::new(),
            })
        };
        let run = barrelstack_space::run::run_on(&placed.scenario, ground, &mut look)
            .map_err(|failure| RoomFailure::Stack { name: placed.name.clone(), failure })?;
        all.interrupted |= run.ending == Ending::Interrupted;
        enter(&mut all, index, placed, &run);
    }
    Ok(all)
}

fn enter(all: &mut RoomRun, index: usize, placed: &Placed, run: &Run) {
    let first = all.bodies.len();
    let ground = run.last.poses[0].position;
    for (body, part) in run.stack.parts.iter().enumerate().skip(1) {
        let (fate, pose) = (run.fates[body], run.last.poses[body]);
        let (p, q) = (pose.position - ground, pose.orientation);
        let own = [p.x, p.y, p.z, q.w, q.v.x, q.v.y, q.v.z];
        let mut to = own;
        to[0] += placed.at[0];
        to[1] += placed.at[1];
        let mut from = to;
        from[..3].copy_from_slice(&[
            fate.rest.x + placed.at[0],
            fate.rest.y + placed.at[1],
            fate.rest.z,
        ]);
        let (name, kind, level, wine) = (part.name.clone(), part.kind, part.level, part.wine);
        all.bodies.push(BodyEnd { stack: index, name, kind, level, wine, fate, from, to, own });
    }
    let lost = run
        .fates
        .iter()
        .enumerate()
        .filter_map(|(body, fate)| fate.left_seat.map(|(time, ..)| (time, first + body - 1)));
    all.stacks.push(StackEnd {
        name: placed.name.clone(),
        outcome: run.outcome.clone(),
        lost_seat: lost.min_by(|a, b| a.0.total_cmp(&b.0)),
        first_fall: run.first_fall,
        touched: None,
        touched_obstacle: None,
        knocked_over: false,
        bodies: first..all.bodies.len(),
        ending: run.ending,
        end_time: run.end_time,
    });
    all.end_time = all.end_time.max(run.end_time);
    all.work.steps += run.work.steps;
}
