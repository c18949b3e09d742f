//! The result of a room, collected from its islands.

use barrelstack::outcome::Outcome;
use barrelstack::run::{Ended, Verdict, Work};
use barrelstack::watch::Ending;
use barrelstack_dynamics::{EnergySummary, Pose, Spatial, Vec3};
use barrelstack_space::Stack;
use barrelstack_space::run::judge;

use crate::history::summed;
use crate::island::{Contact, Island, Owner, PartyId, Watch, numbers, plus};
use crate::nearby::Places;
use crate::result::{BodyEnd, Meeting, ObstacleEnd, RoomFrames, RoomRun, StackEnd, Touch};
use crate::world::{StackOf, World};

/// Returns the result of a room.
pub(crate) fn result(
    world: &World<'_>,
    islands: Vec<Option<Island>>,
    places: &Places,
    merges: usize,
    interrupted: bool,
) -> RoomRun {
    let body_of = |owner: Owner| match owner {
        // The bodies of a result do not include the ground of any stack.
        Owner::Stack((stack, body)) => world.stacks[stack].first + body - stack - 1,
        Owner::Obstacle(obstacle) => obstacle,
    };
    let mut run = RoomRun {
        bodies: Vec::new(),
        stacks: Vec::new(),
        meetings: Vec::new(),
        obstacles: Vec::new(),
        frames: Vec::new(),
        energy: None,
        work: Work::default(),
        merges,
        end_time: 0.0,
        interrupted,
        warnings: world.room.ground.warnings.iter().map(|text| (None, text.clone())).collect(),
        shocks: Vec::new(),
    };
    let mut energy = Some(EnergySummary::default());
    for island in islands.iter().flatten() {
        let own = island.live.failure.is_none().then(|| island.energy());
        energy = energy.zip(own).map(|(all, own)| plus(all, &own));
        let work = island.work();
        run.work.steps += work.steps;
        run.work.evaluations += work.evaluations;
        run.work.contact_evaluations += work.contact_evaluations;
        for ([_, side], contact) in &island.live.contacts {
            if let PartyId::Stack(_) = side {
                run.meetings.push(meeting(contact, &body_of));
            }
        }
    }
    run.energy = energy;
    run.meetings.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.stacks.cmp(&b.stacks)));
    for (number, of) in world.stacks.iter().enumerate() {
        let Some(island) = &islands[places[number].0] else { continue };
        let members = &island.fixed.members;
        let Some(at) = members.iter().position(|of| of.stack == number) else { continue };
        let watch = &island.live.watches[at];
        let first = run.bodies.len();
        run.bodies.extend(bodies_of(of, number, island, at));
        let (outcome, ending, warnings) = judged(world, of, island, watch);
        for warning in warnings {
            run.warnings.push((Some(of.name.to_owned()), warning));
        }
        let lost_seat = watch.fates.collapse().map(|(time, body)| (time, first + body - 1));
        let touched = watch.touched.map(|(time, own, by)| Touch {
            time,
            body: first + own - 1,
            by: body_of(Owner::Stack(by)),
            impulse: watch.impulse,
        });
        let both = lost_seat.zip(touched);
        run.stacks.push(StackEnd {
            name: of.name.to_owned(),
            outcome,
            lost_seat,
            first_fall: watch.fates.first_fall(),
            touched,
            touched_obstacle: watch.touched_obstacle,
            knocked_over: both.is_some_and(|((lost, _), touch)| touch.time <= lost),
            bodies: first..run.bodies.len(),
            ending,
            end_time: island.time(),
            moving: island.moving(at),
        });
        run.end_time = run.end_time.max(island.time());
    }
    let obstacles = world.room.obstacles.iter().enumerate();
    run.obstacles = obstacles
        .map(|(number, obstacle)| obstacle_end(&islands, number, &obstacle.name, &body_of))
        .collect();
    let mut frames = vec![RoomFrames::default(); world.stacks.len()];
    for island in islands.into_iter().flatten() {
        for (member, own) in island.fixed.members.iter().zip(island.logs.frames) {
            frames[member.stack] = own;
        }
    }
    if frames.iter().any(|own| !own.times.is_empty()) {
        run.frames = frames;
    }
    run
}

/// Returns the result for each body of a stack at the end of the run, except the ground. `member` is the index of the
/// stack in its island.
fn bodies_of(of: &StackOf<'_>, stack: usize, island: &Island, member: usize) -> Vec<BodyEnd> {
    let (poses, _) = island.own(member);
    let fates = island.live.watches[member].fates.clone().at_end(&poses);
    let relative = |all: &[Pose<Spatial>], body: usize| {
        let mut pose = all[body];
        pose.position -= all[Stack::GROUND].position;
        pose
    };
    let parts = of.stack.parts.iter().enumerate().skip(1);
    let ends = parts.map(|(body, part)| {
        let [own, from, start] =
            [&poses, &of.at_rest.poses, &of.running.state.poses].map(|poses| relative(poses, body));
        BodyEnd {
            stack,
            name: part.name.clone(),
            kind: part.kind,
            level: part.level,
            wine: part.wine,
            fate: fates[body],
            from: numbers(of.frame.pose(from)),
            start: numbers(of.frame.pose(start)),
            to: numbers(of.frame.pose(own)),
            own: numbers(own),
        }
    });
    ends.collect()
}

/// Returns the outcome of a stack, the reason why its run ended, and warnings.
fn judged(
    world: &World<'_>,
    of: &StackOf<'_>,
    island: &Island,
    watch: &Watch,
) -> (Outcome, Ending, Vec<String>) {
    let ending = match island.live.ending {
        Some(Ending::Patience) => Ending::of_time(of.scenario),
        Some(ending) => ending,
        None => Ending::Interrupted,
    };
    let ended = match &island.live.failure {
        Some(error) => Err(error.clone()),
        None => Ok(Ended { energy: island.energy(), steps: island.work().steps }),
    };
    let judge = || judge(&of.stack, &watch.fates);
    let motion_end = world.room.ground.end();
    let Verdict { outcome, warnings, ending, .. } =
        Verdict::of(ended, judge, island.time(), motion_end, ending);
    if ending == Ending::Broken && island.live.failure.is_none() {
        let reason = "a body moves faster than 45 m/s".to_owned();
        return (Outcome::Invalid { reason }, ending, warnings);
    }
    (outcome, ending, warnings)
}

fn meeting(contact: &Contact, body_of: &dyn Fn(Owner) -> usize) -> Meeting {
    let stack = |owner: Owner| match owner {
        Owner::Stack((stack, _)) => stack,
        Owner::Obstacle(obstacle) => obstacle,
    };
    Meeting {
        stacks: contact.bodies.map(stack),
        time: contact.time,
        bodies: contact.bodies.map(body_of),
        impulse: contact.impulse,
        peak: contact.peak,
    }
}

/// Returns the forces on an obstacle from all islands.
fn obstacle_end(
    islands: &[Option<Island>],
    number: usize,
    name: &str,
    body_of: &dyn Fn(Owner) -> usize,
) -> ObstacleEnd {
    let mut end = ObstacleEnd { name: name.to_owned(), ..ObstacleEnd::default() };
    for island in islands.iter().flatten() {
        let Some(at) = island.fixed.obstacles.iter().position(|of| *of == number) else { continue };
        end.history = summed(&end.history, &island.logs.forces[at]);
        for ([_, side], contact) in &island.live.contacts {
            let first = end.first.is_none_or(|(time, _)| contact.time < time);
            if *side == PartyId::Obstacle(number) && first {
                end.first = Some((contact.time, body_of(contact.bodies[0])));
            }
        }
    }
    for two in end.history.windows(2) {
        let [(before, old), (after, new)] = [two[0], two[1]];
        for axis in 0..3 {
            end.impulse[axis] += 0.5 * (after - before) * (old[axis] + new[axis]);
        }
    }
    let size = |[x, y, z]: [f64; 3]| Vec3::new(x, y, z).length();
    end.peak = end.history.iter().map(|(_, force)| size(*force)).fold(0.0, f64::max);
    end
}
