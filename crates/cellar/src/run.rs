//! Run of a room. An island is a group of stacks that advance together; each stack is an island of its own at the
//! start. Islands advance in parallel in short windows of time, and islands that come near each other are merged.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use barrelstack::overlap::ALLOWED;
use barrelstack::pool;
use barrelstack::run::check_kept;
use barrelstack::watch::Ending;
use barrelstack_dynamics::space::Linear as _;
use barrelstack_dynamics::{BodyId, Vec3};

use crate::collect::result;
use crate::island::{Island, Owner};
use crate::merge::merged;
use crate::nearby::{Nearby, Places, gap, locate};
use crate::result::RoomRun;
use crate::room::{Room, RoomFailure, Settings};
use crate::world::{PRESSED, World};

/// Length (s) of a time window. With longer windows, islands are merged at larger gaps; shorter windows take more
/// computing time.
const WINDOW: f64 = 2e-3;

/// Shortest time (s) for which an island at rest is advanced further if one of its barrels still rolls toward another
/// stack or an obstacle. An island counts as at rest even while barrels roll away from their stacks.
const ROLLS: f64 = 0.25;

/// Wall-clock time between two calls of the observer.
const PATIENCE: Duration = Duration::from_millis(500);

/// Progress of a run.
#[derive(Clone, Debug, Default)]
pub struct Advance {
    /// Simulated time (s) that all moving stacks have reached; `end_time` if no stack moves.
    pub time: f64,
    /// Latest simulated time (s) at which the run can end.
    pub end_time: f64,
    /// Number of stacks that move.
    pub moving: usize,
}

/// Runs a room until all stacks are at rest or the duration of the run is over.
///
/// First, every stack settles under its own weight. From then on, the observer receives the progress about twice a
/// second. It may stop the run; the results obtained until then are returned.
///
/// # Errors
/// If a stack cannot be built or does not stand, or stacks or obstacles overlap.
pub fn run(
    room: &Room,
    settings: &Settings,
    observer: &mut dyn FnMut(&Advance) -> ControlFlow<()>,
) -> Result<RoomRun, RoomFailure> {
    let world = World::of(room, settings.threads)?;
    let rate = room.stacks[0].scenario.record.frame_rate;
    let every = settings.frames.then_some(1.0 / rate);
    if settings.frames {
        // A frame has the pose and the speed of every body.
        let frames = (world.end_time * rate + 1.0, world.count, 8);
        check_kept(frames, (0.0, 0)).map_err(|failure| RoomFailure::Stack {
            name: room.stacks[0].name.clone(),
            failure: Box::new(failure),
        })?;
    }
    let mut run = Running::start(&world, every);
    run.check_overlaps()?;
    let interrupted = run.advance(settings.threads, observer)?;
    let Running { islands, places, merges, .. } = run;
    Ok(result(&world, islands, &places, merges, interrupted))
}

/// Checks that the stacks and obstacles of a room do not overlap at the start. The room is not run.
///
/// # Errors
/// As for [`run`].
pub(crate) fn check_overlaps(room: &Room) -> Result<(), RoomFailure> {
    let world = World::of(room, 0)?;
    Running::start(&world, None).check_overlaps()
}

struct Running<'a> {
    world: &'a World<'a>,
    /// The islands, each at the smallest index of its stacks; `None` at the indices of its other stacks.
    islands: Vec<Option<Island>>,
    places: Places,
    nearby: Nearby,
    merges: usize,
}

impl<'a> Running<'a> {
    /// Creates one island for each stack. The islands record frames at the interval `every` (s); `None` for no frames.
    fn start(world: &'a World<'a>, every: Option<f64>) -> Self {
        let alone = |stack| Some(Island::alone(world, stack, every));
        let islands: Vec<Option<Island>> = (0..world.stacks.len()).map(alone).collect();
        let places = (0..islands.len()).map(|stack| (stack, 0)).collect();
        Self { world, islands, places, nearby: Nearby::new(world), merges: 0 }
    }

    /// Rejects a room whose bodies overlap.
    fn check_overlaps(&mut self) -> Result<(), RoomFailure> {
        let Self { world, islands, places, nearby, .. } = self;
        if world.room.stacks.iter().any(|placed| placed.carried_on) {
            return Ok(());
        }
        let stated = world.room.stacks.iter().any(|placed| placed.start.is_some());
        let limit = if stated { PRESSED } else { ALLOWED };
        nearby.refresh(world, islands);
        let meetings = nearby.meetings(world, islands, places, WINDOW);
        let depth = |bodies: &[Owner; 2]| -gap(world, islands, places, *bodies, limit);
        let deepest = meetings.iter().map(|bodies| (depth(bodies), bodies));
        match deepest.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((depth, bodies)) if depth > limit => {
                let [first, second] = bodies.map(|owner| world.name(owner));
                Err(RoomFailure::Overlap { first, second, depth })
            }
            Some(_) | None => Ok(()),
        }
    }

    /// Advances all islands until the run of each has ended; returns `true` if the observer stopped the run.
    fn advance(
        &mut self,
        threads: usize,
        observer: &mut dyn FnMut(&Advance) -> ControlFlow<()>,
    ) -> Result<bool, RoomFailure> {
        let mut called: Option<Instant> = None;
        let mut windows = 0_u32;
        loop {
            self.keep_rolling(f64::from(windows) * WINDOW);
            let awake = || self.islands.iter().flatten().filter(|island| island.is_awake());
            let done = awake().next().is_none();
            if done || called.is_none_or(|at| at.elapsed() >= PATIENCE) {
                called = Some(Instant::now());
                let end_time = self.world.end_time;
                let now = Advance {
                    time: awake().map(Island::time).fold(end_time, f64::min),
                    end_time,
                    moving: awake().map(|island| island.fixed.members.len()).sum(),
                };
                if observer(&now).is_break() {
                    return Ok(true);
                }
            }
            if done {
                return Ok(false);
            }
            windows += 1;
            self.window(f64::from(windows) * WINDOW, threads)?;
        }
    }

    /// Advances all islands to a time (s).
    fn window(&mut self, until: f64, threads: usize) -> Result<(), RoomFailure> {
        let world = self.world;
        self.nearby.refresh(world, &self.islands);
        let meetings = self.nearby.meetings(world, &self.islands, &self.places, WINDOW);
        if !meetings.is_empty() {
            self.merge_all(&meetings)?;
        }
        for number in 0..self.islands.len() {
            self.open(number);
        }
        let mut tasks: Vec<Mutex<&mut Island>> = self
            .islands
            .iter_mut()
            .flatten()
            .filter(|island| island.is_awake())
            .map(Mutex::new)
            .collect();
        // The largest islands come first, because threads take the tasks in order.
        tasks.sort_by_key(|task| {
            task.lock().map_or(0, |island| usize::MAX - island.fixed.owners.len())
        });
        let advance = |task: &Mutex<&mut Island>| {
            if let Ok(mut island) = task.lock() {
                island.advance(world, until);
            }
        };
        pool::map_on(threads, &tasks, advance, &|_| ());
        drop(tasks);
        self.repair(until)?;
        for island in self.islands.iter_mut().flatten() {
            self.nearby.add(world, island);
        }
        Ok(())
    }

    /// Starts a time window for the island `number`, and limits how far each of its bodies may move in the window.
    fn open(&mut self, number: usize) {
        let (tubes, near) = self.nearby.limit(self.world, &self.islands, &self.places, number);
        if let Some(island) = &mut self.islands[number] {
            island.tubes = tubes;
            let keeps = near && island.is_awake();
            island.open(keeps);
        }
    }

    /// Merges each island that stopped because a body could have moved too far in the window. The island is merged with
    /// the island or obstacle that most restricts how far this body may move. Islands that stopped earlier are merged
    /// first.
    fn repair(&mut self, until: f64) -> Result<(), RoomFailure> {
        let world = self.world;
        loop {
            let stopped = self.islands.iter().enumerate().filter_map(|(number, island)| {
                let island = island.as_ref()?;
                let rank = world.stacks[island.fixed.members[0].stack].rank;
                Some((island.time(), rank, number, island.live.stopped_by?))
            });
            let first = stopped.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let Some((time, _, number, body)) = first else { return Ok(()) };
            let Some(island) = &self.islands[number] else { return Ok(()) };
            let Some(other) = self.nearby.nearest_to(world, &self.places, island, body) else {
                if let Some(island) = &mut self.islands[number] {
                    island.live.stopped_by = None;
                    island.live.ending = Some(Ending::Broken);
                }
                continue;
            };
            let own = island.fixed.owners[body];
            let partner = owner_island(&self.places, other);
            if let Some(partner) = partner.and_then(|at| self.islands[at].as_mut()) {
                partner.go_back();
                partner.advance_to(world, time);
            }
            for number in self.merge_all(&[[own, other]])? {
                self.open(number);
                if let Some(island) = &mut self.islands[number] {
                    island.advance(world, until);
                }
            }
        }
    }

    /// Merges islands such that the two parties of each meeting, bodies or obstacles, belong to the same island.
    /// Returns the indices of the merged islands.
    fn merge_all(&mut self, meetings: &[[Owner; 2]]) -> Result<Vec<usize>, RoomFailure> {
        // Every island points to an island of its group; the first island of a group points to itself.
        let mut group: Vec<usize> = (0..self.islands.len()).collect();
        let mut obstacles: Vec<(usize, usize)> = Vec::new();
        for [one, other] in meetings {
            let Some(first) = owner_island(&self.places, *one) else { continue };
            match (*other, owner_island(&self.places, *other)) {
                (_, Some(second)) => {
                    let (a, b) = (root(&group, first), root(&group, second));
                    group[a.max(b)] = a.min(b);
                }
                (Owner::Obstacle(obstacle), None) => obstacles.push((first, obstacle)),
                (Owner::Stack(_), None) => {}
            }
        }
        let mut all = Vec::new();
        for first in 0..self.islands.len() {
            if group[first] != first || self.islands[first].is_none() {
                continue;
            }
            let of_group = |at: usize| root(&group, at) == first;
            let numbers: Vec<usize> = (first..group.len())
                .filter(|at| of_group(*at) && self.islands[*at].is_some())
                .collect();
            let own: Vec<usize> =
                obstacles.iter().filter(|(at, _)| of_group(*at)).map(|(_, of)| *of).collect();
            if numbers.len() == 1 && own.is_empty() {
                continue;
            }
            let mut islands: Vec<Island> =
                numbers.iter().filter_map(|at| self.islands[*at].take()).collect();
            let time = islands.iter().map(Island::time).fold(0.0, f64::max);
            for island in &mut islands {
                island.advance_to(self.world, time);
                self.nearby.add(self.world, island);
            }
            let island = merged(self.world, islands, &own)?;
            for member in &island.fixed.members {
                self.places[member.stack] = (first, member.bodies.start);
            }
            self.islands[first] = Some(island);
            self.merges += 1;
            all.push(first);
        }
        Ok(all)
    }

    /// Resumes every island at rest that has a barrel rolling toward another stack or an obstacle. `now` is the
    /// present time (s).
    fn keep_rolling(&mut self, now: f64) {
        let world = self.world;
        let mut goes_on = Vec::new();
        for (number, island) in self.islands.iter().enumerate() {
            let Some(island) = island else { continue };
            if island.live.ending != Some(Ending::Rest) {
                continue;
            }
            if island.rolling().into_iter().any(|body| self.will_meet(island, body)) {
                goes_on.push(number);
            }
        }
        for number in goes_on {
            if let Some(island) = &mut self.islands[number] {
                // An island that has rested for more than a window is first carried along with the ground to the
                // present time.
                if island.time() < now - WINDOW {
                    island.advance_to(world, now);
                }
                island.live.ending = None;
                island.live.not_before = island.time() + ROLLS;
            }
        }
    }

    /// Returns `true` if a body will come near a body of another stack or an obstacle, provided that it keeps its
    /// direction of motion.
    fn will_meet(&self, island: &Island, body: BodyId) -> bool {
        let world = self.world;
        let Owner::Stack((own, of)) = island.fixed.owners[body] else { return false };
        let level = |v: Vec3| Vec3::new(v.x, v.y, 0.0);
        let (place, velocity) = (island.in_room(body).position, level(island.velocity(body)));
        let reach = world.stacks[own].reach[of];
        let ahead = |other: Vec3, radius: f64| {
            let apart = level(other - place);
            let along = apart.dot(velocity);
            let aside = apart.cross(velocity).length();
            let speed = velocity.length();
            // Part of the other body, such as a long wall, can be ahead even if its center is not.
            along > -radius * speed && aside < (reach + radius) * speed
        };
        let stacks = (0..world.stacks.len()).filter(|stack| *stack != own);
        let meets_stack = stacks.clone().any(|stack| {
            (1..world.stacks[stack].stack.parts.len()).any(|body| {
                let other = Owner::Stack((stack, body));
                locate(&self.islands, &self.places, other).is_some_and(|(island, at)| {
                    ahead(island.in_room(at).position, world.stacks[stack].reach[body])
                })
            })
        });
        meets_stack
            || world.room.obstacles.iter().any(|obstacle| {
                let [x, y, _] = obstacle.center;
                let [a, b, _] = obstacle.half;
                ahead(Vec3::new(x, y, 0.0), Vec3::new(a, b, 0.0).length())
            })
    }
}

/// Returns the first island of the group to which the island `at` belongs.
fn root(group: &[usize], mut at: usize) -> usize {
    while group[at] != at {
        at = group[at];
    }
    at
}

/// Returns the island of a body; `None` for an obstacle.
fn owner_island(places: &Places, owner: Owner) -> Option<usize> {
    match owner {
        Owner::Stack((stack, _)) => Some(places[stack].0),
        Owner::Obstacle(_) => None,
    }
}
