//! Sequences of shocks: the room after a shock, from which the next shock starts, and the runs of all shocks combined
//! into one run.

use barrelstack::outcome::Outcome;
use barrelstack_space::Fate;

use crate::island::plus;
use crate::result::{BodyEnd, Meeting, ObstacleEnd, RoomFrames, RoomRun, StackEnd, Touch};
use crate::room::Room;

/// Returns the room after a run: every body starts in the pose in which the run has left it, at rest and without
/// contact history. The quiet time between two shocks is skipped.
#[must_use]
pub fn after(mut room: Room, run: &RoomRun) -> Room {
    for (placed, stack) in room.stacks.iter_mut().zip(&run.stacks) {
        let own = run.bodies[stack.bodies.clone()].iter().map(|body| body.own);
        placed.start = Some(own.collect());
        placed.carried_on = true;
        placed.shifts.clear();
    }
    room
}

/// `true` if another shock can follow a run, that is, if the run was not stopped and its computation did not fail.
pub(crate) fn can_continue(run: &RoomRun) -> bool {
    let valid = |stack: &StackEnd| !matches!(stack.outcome, Outcome::Invalid { .. });
    !run.interrupted && run.stacks.iter().all(valid)
}

/// Returns the runs of the first shock and of the later ones as one run. The clock of this run continues from shock to
/// shock without the quiet time between them: every shock starts when the previous one ends.
pub(crate) fn joined(first: RoomRun, later: Vec<RoomRun>) -> RoomRun {
    let mut all = first.clone();
    let mut shocks = vec![first];
    for mut next in later {
        keep_fallen(&shocks[shocks.len() - 1], &mut next);
        add(&mut all, &next);
        shocks.push(next);
    }
    all.shocks = shocks;
    all
}

/// Counts a stack or a body that fell in an earlier shock as fallen at time zero, even if it stands in its place
/// again.
fn keep_fallen(before: &RoomRun, run: &mut RoomRun) {
    for (old, new) in before.stacks.iter().zip(&mut run.stacks) {
        if let (Outcome::Collapse { .. }, Some((_, body))) = (&old.outcome, old.lost_seat) {
            (new.lost_seat, new.knocked_over) = (Some((0.0, body)), false);
            if !matches!(new.outcome, Outcome::Invalid { .. }) {
                new.outcome = old.outcome.clone();
            }
        }
    }
    for (old, new) in before.bodies.iter().zip(&mut run.bodies) {
        if old.fate.fell_at.is_some() {
            new.fate.fell_at = Some(0.0);
        }
    }
}

/// Appends the run of the next shock to `all`, the joined run of the shocks before it.
fn add(all: &mut RoomRun, next: &RoomRun) {
    let from = all.end_time;
    let stood: Vec<bool> = all.stacks.iter().map(|stack| stack.lost_seat.is_none()).collect();
    for (one, next) in all.bodies.iter_mut().zip(&next.bodies) {
        add_body(one, next, from, stood[one.stack]);
    }
    all.stacks.iter_mut().zip(&next.stacks).for_each(|(one, next)| add_stack(one, next, from));
    for meeting in &next.meetings {
        match all.meetings.iter_mut().find(|one| one.stacks == meeting.stacks) {
            Some(known) => {
                known.impulse += meeting.impulse;
                known.peak = known.peak.max(meeting.peak);
            }
            None => all.meetings.push(Meeting { time: from + meeting.time, ..*meeting }),
        }
    }
    let obstacles = all.obstacles.iter_mut().zip(&next.obstacles);
    obstacles.for_each(|(one, next)| add_obstacle(one, next, from));
    all.frames.iter_mut().zip(&next.frames).for_each(|(one, next)| add_frames(one, next, from));
    all.energy = all.energy.zip(next.energy).map(|(one, next)| plus(one, &next));
    all.work.steps += next.work.steps;
    all.work.evaluations += next.work.evaluations;
    all.work.contact_evaluations += next.work.contact_evaluations;
    all.merges += next.merges;
    all.end_time = from + next.end_time;
    all.interrupted |= next.interrupted;
    for warning in &next.warnings {
        if !all.warnings.contains(warning) {
            all.warnings.push(warning.clone());
        }
    }
}

/// Adds the result of a body in a further shock to the result of the body so far. `from` is the time (s) at which the
/// shock starts; `stood` is `true` if the stack of the body had not lost a seat before the shock.
fn add_body(all: &mut BodyEnd, next: &BodyEnd, from: f64, stood: bool) {
    let (one, two) = (all.fate, next.fate);
    let left = two.left_seat.map(|(time, loss, heading)| (from + time, loss, heading));
    all.fate = Fate {
        left_seat: one.left_seat.or(left),
        fell_at: one.fell_at.or(two.fell_at.map(|time| from + time)),
        drop: one.drop.max(two.drop),
        fall_force: one.fall_force.max(two.fall_force),
        whole_run: one.whole_run.or_larger(two.whole_run),
        ..two
    };
    if stood {
        all.fate.peak_slip = [0, 1].map(|axis| one.peak_slip[axis].max(two.peak_slip[axis]));
        all.fate.peak_uplift = one.peak_uplift.max(two.peak_uplift);
        all.fate.until_loss = one.until_loss.or_larger(two.until_loss);
    } else {
        all.fate.peak_slip = one.peak_slip;
        all.fate.peak_uplift = one.peak_uplift;
        all.fate.until_loss = one.until_loss;
        all.fate.moved_at_collapse = one.moved_at_collapse;
    }
    (all.to, all.own) = (next.to, next.own);
}

fn add_stack(all: &mut StackEnd, next: &StackEnd, from: f64) {
    let stood = all.lost_seat.is_none();
    all.touched = match (all.touched, next.touched) {
        (Some(one), Some(next)) if stood => {
            Some(Touch { impulse: one.impulse + next.impulse, ..one })
        }
        (None, Some(next)) => Some(Touch { time: from + next.time, ..next }),
        (one, _) => one,
    };
    if stood {
        all.lost_seat = next.lost_seat.map(|(time, body)| (from + time, body));
        all.knocked_over = next.knocked_over;
    }
    if stood || matches!(next.outcome, Outcome::Invalid { .. }) {
        all.outcome = next.outcome.clone();
    }
    all.first_fall = all.first_fall.or(next.first_fall.map(|time| from + time));
    let touched = next.touched_obstacle.map(|(time, obstacle)| (from + time, obstacle));
    all.touched_obstacle = all.touched_obstacle.or(touched);
    (all.ending, all.end_time, all.moving) = (next.ending, from + next.end_time, next.moving);
}

fn add_obstacle(all: &mut ObstacleEnd, next: &ObstacleEnd, from: f64) {
    all.first = all.first.or(next.first.map(|(time, body)| (from + time, body)));
    all.peak = all.peak.max(next.peak);
    for (sum, next) in all.impulse.iter_mut().zip(next.impulse) {
        *sum += next;
    }
    all.history.extend(next.history.iter().map(|(time, force)| (from + time, *force)));
}

fn add_frames(all: &mut RoomFrames, next: &RoomFrames, from: f64) {
    all.times.extend(next.times.iter().map(|time| from + time));
    all.poses.extend_from_slice(&next.poses);
    all.speeds.extend_from_slice(&next.speeds);
}
