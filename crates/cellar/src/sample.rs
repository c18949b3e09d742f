//! Variants of a room. In one variant, every stack has its own random imperfections; the motion and the randomly drawn
//! contact constants are the same for all stacks.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use barrelstack::assemble::{PartKind, law_in_space};
use barrelstack::breakage::Breakage;
use barrelstack::ground::GroundError;
use barrelstack::outcome::Outcome;
use barrelstack::run::{check_kept, end_time};
use barrelstack::scenario::{Friction, Interface, NormalLaw, Scene};
use barrelstack::variants::planes;
use barrelstack::watch::Ending;
use barrelstack::{RunFailure, Scenario, pool};
use barrelstack_dynamics::{Drive, Spatial};
use barrelstack_input::fnv1a;
use barrelstack_space::Ground;
use serde::{Deserialize, Serialize};

use crate::geometry::{Convex, Grid};
use crate::kept::Kept;
use crate::plan::{Obstacles, Plan, moved, outline_in_plan};
use crate::result::{BodyEnd, RoomRun, StackEnd};
use crate::room::{Obstacle, Placed, Room, RoomFailure, Settings};
use crate::run::{Advance, check_overlaps, run};
use crate::scenario::{Cellar, Standing};
use crate::sequence::{after, can_continue, joined};
use crate::start::{StackStart, starts};

/// Reason why a cellar cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum CellarFailure {
    /// The plan has a problem that prevents a run.
    #[error(transparent)]
    Plan(#[from] barrelstack::scenario::ScenarioError),
    /// A stack cannot be built, does not stand, or would run too long.
    #[error(transparent)]
    Stack(#[from] RunFailure),
    /// The room cannot be run.
    #[error(transparent)]
    Room(#[from] RoomFailure),
    /// The result of a variant cannot be written to the folder, or a result in the folder cannot be used.
    #[error("{path}: {reason}; remove the file, or keep the results in another folder")]
    Kept {
        /// Path of the file or folder.
        path: String,
        /// The reason.
        reason: String,
    },
}

impl From<GroundError> for CellarFailure {
    fn from(error: GroundError) -> Self {
        Self::Stack(error.into())
    }
}

/// A cellar that is ready to run.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The cellar, with the records of its ground motion in memory.
    pub cellar: Cellar,
    /// The plan of the cellar.
    pub plan: Plan,
    /// The ground motion along the axes of the room.
    pub ground: Ground,
    /// Time (s) at which the shaking starts: the first time at which the horizontal acceleration exceeds 0.02 g.
    pub onset: f64,
    /// The shocks of a sequence after the first.
    pub later: Vec<Later>,
    starts: BTreeMap<String, StackStart>,
    obstacles: Vec<Obstacle>,
}

/// Callback that receives the progress of a run and may stop it.
pub type Observer<'a> = &'a mut dyn FnMut(&Advance) -> ControlFlow<()>;

/// A shock after the first.
#[derive(Clone, Debug)]
pub struct Later {
    /// The ground motion along the axes of the room.
    pub ground: Ground,
    /// Time (s), in the record of the shock, at which the shaking starts.
    pub onset: f64,
}

/// Horizontal acceleration (m/s²) at which the shaking starts.
const ONSET: f64 = 0.02 * barrelstack::motion::STANDARD_GRAVITY;

/// Time (s) between two samples of the ground motion.
const SAMPLE: f64 = 0.005;

/// Thickness (m) of walls.
const WALL: f64 = 0.3;

/// Side (m) of a cell of the map of fallen barrels.
pub const CELL: f64 = 0.25;

impl Prepared {
    /// Lays out a cellar and reads its motion.
    ///
    /// # Errors
    /// If the plan has a problem, a stack cannot be built, or the motion cannot be read.
    pub fn new(cellar: &Cellar) -> Result<Self, CellarFailure> {
        let cellar = cellar.with_records()?;
        let plan = Plan::of(&cellar)?;
        if let Some((error, _)) = plan.problems.into_iter().next() {
            return Err(error.into());
        }
        let plan = Plan { problems: Vec::new(), ..plan };
        let mut ground = Ground::of_spec(&cellar.stated().motion, 1.0)?;
        ground.warnings.splice(0..0, cellar.stated().warnings().iter().cloned());
        let onset_of = onset;
        let onset = onset_of(&ground);
        let later = |motion| -> Result<Later, CellarFailure> {
            let ground = Ground::of_spec(motion, 1.0)?;
            Ok(Later { onset: onset_of(&ground), ground })
        };
        let later = cellar.later.iter().map(later).collect::<Result<_, _>>()?;
        let starts = starts(&cellar.start, &cellar.host, &plan.stacks, &plan.models)?;
        let obstacles = obstacles(&cellar)?;
        Ok(Self { cellar, plan, ground, onset, later, starts, obstacles })
    }

    /// Returns the number of variants. Variant 0, the room as stated in its file, is not counted.
    pub fn count(&self) -> u32 {
        self.cellar.stated().imperfections().map_or(0, |imperfections| imperfections.variants)
    }

    /// Returns the room of a variant. Variant 0 is the room as stated in its file, without random draws.
    ///
    /// # Errors
    /// If the motion cannot be read.
    pub fn room(&self, variant: u32) -> Result<Room, CellarFailure> {
        let stacks = self.plan.stacks.iter().map(|standing| {
            let stated = self.starts.get(&standing.name).cloned().unwrap_or_default();
            Ok(Placed {
                name: standing.name.clone(),
                scenario: self.drawn(standing, variant)?,
                at: standing.at,
                azimuth: standing.azimuth,
                start: stated.poses,
                carried_on: false,
                shifts: stated.shifts,
            })
        });
        Ok(Room {
            stacks: stacks.collect::<Result<_, CellarFailure>>()?,
            obstacles: self.obstacles.clone(),
            ground: self.ground.clone(),
        })
    }

    /// Returns the scenario of a stack with the random draws of a variant applied. All stacks of the variant have the
    /// same randomly drawn contact constants, but each stack has its own imperfections.
    fn drawn(&self, standing: &Standing, variant: u32) -> Result<Scenario, CellarFailure> {
        let stated = &self.cellar.models[standing.model];
        if variant == 0 {
            return Ok(stated.clone());
        }
        let mut shared = stated.clone();
        let own = match &mut shared.scene {
            Scene::Stack { imperfections, .. } => {
                let own = imperfections.clone();
                imperfections.drawn = false;
                imperfections.sign = false;
                own
            }
            Scene::Free(_) | Scene::Spatial(_) => return Ok(shared),
        };
        let mut stack = drawn(&shared, variant)?;
        if let Scene::Stack { imperfections, unknowns, .. } = &mut stack.scene {
            let seed = fnv1a(format!("{} {}", own.seed, standing.name).as_bytes());
            let [high, low] = [seed >> 32, seed & u64::from(u32::MAX)];
            *imperfections = own;
            imperfections.seed = u32::try_from(high ^ low).unwrap_or(u32::MAX);
            unknowns.drawn = false;
        }
        drawn(&stack, variant)
    }

    /// Runs a variant and records its frames.
    ///
    /// # Errors
    /// If a stack cannot be built or does not stand.
    pub fn run(
        &self,
        variant: u32,
        threads: usize,
        observer: Observer<'_>,
    ) -> Result<RoomRun, CellarFailure> {
        let (room, first) = self.first(variant, threads, observer)?;
        self.continued(room, first, threads, observer)
    }

    /// Runs the first shock of a variant and records its frames. Returns the room of the variant and the run.
    ///
    /// # Errors
    /// As for [`Prepared::run`].
    pub(crate) fn first(
        &self,
        variant: u32,
        threads: usize,
        observer: Observer<'_>,
    ) -> Result<(Room, RoomRun), CellarFailure> {
        let room = self.room(variant)?;
        self.check_kept(&room)?;
        let settings = Settings { threads, frames: true };
        let first = run(&room, &settings, observer).map_err(|failure| self.placed(failure))?;
        Ok((room, first))
    }

    /// Runs the shocks after the first, and returns the runs of all shocks joined into one run. `room` is the room of
    /// the variant, and `first` the run of its first shock.
    ///
    /// # Errors
    /// As for [`Prepared::run`].
    pub(crate) fn continued(
        &self,
        mut room: Room,
        first: RoomRun,
        threads: usize,
        observer: Observer<'_>,
    ) -> Result<RoomRun, CellarFailure> {
        if self.later.is_empty() {
            return Ok(first);
        }
        let settings = Settings { threads, frames: true };
        let (mut from, mut shocks) = (first.end_time, Vec::<RoomRun>::new());
        for Later { ground, .. } in &self.later {
            let before = shocks.last().unwrap_or(&first);
            if !can_continue(before) {
                break;
            }
            room = after(Room { ground: ground.clone(), ..room }, before);
            let mut look = |now: &Advance| {
                let [time, end_time] = [now.time, now.end_time].map(|time| from + time);
                observer(&Advance { time, end_time, ..now.clone() })
            };
            let next = run(&room, &settings, &mut look)?;
            from += next.end_time;
            shocks.push(next);
        }
        Ok(joined(first, shocks))
    }

    /// Checks that the stacks of variant 0, the room without random draws, do not overlap in their initial poses.
    ///
    /// # Errors
    /// If they overlap, or a stack cannot be built or does not stand.
    pub fn check_start(&self) -> Result<(), CellarFailure> {
        check_overlaps(&self.room(0)?).map_err(|failure| self.placed(failure))
    }

    /// Checks that memory suffices for the frames of all shocks, which are stored twice: for each shock, and for the
    /// joined run.
    fn check_kept(&self, room: &Room) -> Result<(), CellarFailure> {
        if self.later.is_empty() {
            return Ok(());
        }
        let stated = self.cellar.stated();
        let mut frames = 0.0;
        let later = self.later.iter().map(|later| &later.ground);
        for ground in std::iter::once(&self.ground).chain(later) {
            frames += end_time(stated, ground.motion_end(), 1.0)? * stated.record.frame_rate + 1.0;
        }
        let bodies = usize::try_from(room.bodies()).unwrap_or(usize::MAX);
        Ok(check_kept((2.0 * frames, bodies, 8), (0.0, 0))?)
    }

    /// Converts an overlap of bodies to an error that points to an entry of the file: the entry that states the initial
    /// pose of one of the two stacks. Other failures are returned unchanged, and so is an overlap for which there is no
    /// such entry.
    fn placed(&self, failure: RoomFailure) -> CellarFailure {
        let RoomFailure::Overlap { first, second, depth } = &failure else {
            return failure.into();
        };
        let of = |body: &String| self.starts.get(body.split(' ').next().unwrap_or_default());
        let Some(stated) = of(first)
            .into_iter()
            .chain(of(second))
            .max_by_key(|stated| (&stated.path, stated.line))
        else {
            return failure.into();
        };
        let line =
            stated.line.map_or_else(String::new, |line| format!("line {line} of the file: "));
        let message = format!(
            "{line}\"{first}\" and \"{second}\" overlap by {:.1} mm at the start: shift them apart, or also shift the \
             bodies above or below them",
            1e3 * depth
        );
        self.cellar.host.error(&[&stated.path], message).into()
    }

    /// Runs variants, several at a time; the result of a variant that was interrupted is `None`. If `kept` is given,
    /// results that are already in its folder are read, and each new result is written as soon as it is available.
    ///
    /// The observer receives the number of finished variants, from several threads, and may stop the work.
    ///
    /// # Errors
    /// If a variant cannot be run, or a result cannot be read from the folder or written to it.
    pub fn cases(
        &self,
        numbers: &[u32],
        kept: Option<&Kept>,
        observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
    ) -> Result<Vec<Option<Case>>, CellarFailure> {
        each(numbers, observer, &|number, threads, look| {
            if let Some(case) = kept.map_or(Ok(None), |kept| kept.read(number))? {
                return Ok(Some(case));
            }
            let run = self.run(number, threads, look)?;
            if run.interrupted {
                return Ok(None);
            }
            let case = self.case(number, &run);
            kept.map_or(Ok(()), |kept| kept.write(&case))?;
            Ok(Some(case))
        })
    }

    /// Returns the result of a variant, which is computed from its run.
    pub fn case(&self, variant: u32, run: &RoomRun) -> Case {
        let onsets = std::iter::once(self.onset).chain(self.later.iter().map(|later| later.onset));
        let shocks =
            run.shocks.iter().zip(onsets).map(|(run, onset)| self.shock(variant, run, onset));
        Case { shocks: shocks.collect(), ..self.shock(variant, run, self.onset) }
    }

    /// Returns the result of a variant, without results of its individual shocks. `run` is the run of one shock, or the
    /// joined run of all shocks. `onset` is the time (s) in the run at which the shaking starts.
    fn shock(&self, variant: u32, run: &RoomRun, onset: f64) -> Case {
        let outlines = self.outlines(run, |body| &body.to);
        let stacks: Vec<StackCase> = run.stacks.iter().map(|end| stack_case(run, end)).collect();
        let taken = Obstacles { cellar: &self.cellar, taken: outlines.iter().collect() };
        let aisles = self
            .cellar
            .aisles
            .iter()
            .map(|aisle| self.aisle(aisle.from, aisle.to, run, &taken, onset));
        let fallen = run.bodies.iter().zip(&outlines);
        let fallen =
            fallen.filter(|(body, _)| body.kind == PartKind::Barrel && body.fate.fell_at.is_some());
        let mut map = self.map();
        fallen.for_each(|(_, outline)| map.take(outline, 0.0));
        Case {
            variant,
            valid: stacks.iter().all(|stack| stack.valid),
            aisles: aisles.collect(),
            paths_to_doors: taken.paths_to_doors(),
            obstacles: run
                .obstacles
                .iter()
                .map(|end| {
                    let [x, y, z] = end.impulse;
                    let impulse = (x * x + y * y + z * z).sqrt();
                    ObstacleCase { struck: end.first.is_some(), peak: end.peak, impulse }
                })
                .collect(),
            map: map.cells().to_vec(),
            end_time: run.end_time,
            cut_short: run.stacks.iter().any(|stack| stack.ending != Ending::Rest),
            still_moving: run.stacks.iter().filter(|stack| !stack.rests()).count(),
            stacks,
            warnings: run.warnings.clone(),
            shocks: Vec::new(),
        }
    }

    /// Returns an empty map of fallen barrels.
    pub(crate) fn map(&self) -> Grid {
        Grid::new([0.0; 2], [self.cellar.room.length, self.cellar.room.width], CELL)
    }

    /// Returns the outlines of the bodies of a run from above, in the poses that `pose` returns.
    fn outlines(&self, run: &RoomRun, pose: fn(&BodyEnd) -> &[f64; 7]) -> Vec<Convex> {
        let of = |(at, end): (usize, &StackEnd)| {
            let surfaces = &self.plan.models[self.plan.stacks[at].model].surfaces;
            let bodies = &run.bodies[end.bodies.clone()];
            bodies.iter().zip(surfaces).map(|(body, points)| outline_in_plan(points, pose(body)))
        };
        run.stacks.iter().enumerate().flat_map(|stack| of(stack).collect::<Vec<_>>()).collect()
    }

    /// Returns the result of a run for an aisle, a rectangle with the opposite corners `from` and `to` (m). `end`
    /// contains the bodies in their final poses. `onset` is the time (s) in the run at which the shaking starts.
    fn aisle(
        &self,
        from: [f64; 2],
        to: [f64; 2],
        run: &RoomRun,
        end: &Obstacles<'_>,
        onset: f64,
    ) -> AisleCase {
        let inside = |pose: &[f64; 7]| {
            (from[0]..=to[0]).contains(&pose[0]) && (from[1]..=to[1]).contains(&pose[1])
        };
        let (mut first, mut fastest) = (None::<f64>, None::<f64>);
        for (frames, stack) in run.frames.iter().zip(&run.stacks) {
            for (at, body) in run.bodies[stack.bodies.clone()].iter().enumerate() {
                if body.kind != PartKind::Barrel || inside(&body.start) {
                    continue;
                }
                for (frame, time) in frames.times.iter().enumerate() {
                    if inside(&frames.poses[frame][at]) {
                        first = Some(first.map_or(*time, |first| first.min(*time)));
                        let speed = frames.speeds[frame][at];
                        fastest = Some(fastest.map_or(speed, |fastest| fastest.max(speed)));
                    }
                }
            }
        }
        AisleCase {
            first: first.map(|time| time - onset),
            fastest,
            covered: end.covered(from, to),
            blocked_at: self.blocked_at(from, to, run, end, onset).map(|time| time - onset),
        }
    }

    /// Returns the time (s) from which an aisle stays blocked until the end; `None` if the aisle is passable at the
    /// end. If stacks and columns already block the aisle before the shaking, the returned time is the start of the
    /// shaking, `onset`.
    fn blocked_at(
        &self,
        from: [f64; 2],
        to: [f64; 2],
        run: &RoomRun,
        end: &Obstacles<'_>,
        onset: f64,
    ) -> Option<f64> {
        // No body reaches farther than this distance (m) from its center.
        const REACH: f64 = 2.0;
        let placed = run.bodies.iter().any(|body| body.start != body.from);
        let bodies = if placed { self.outlines(run, |body| &body.start) } else { Vec::new() };
        let taken = if placed { &bodies } else { &self.plan.footprints };
        let standing = Obstacles { cellar: &self.cellar, taken: taken.iter().collect() };
        if end.is_passable(from, to) {
            return None;
        }
        if !standing.is_passable(from, to) {
            return Some(onset);
        }
        let near = |pose: &[f64; 7]| {
            [0, 1]
                .into_iter()
                .all(|axis| (from[axis] - REACH..=to[axis] + REACH).contains(&pose[axis]))
        };
        let passable = |time: f64| {
            let mut outlines = Vec::new();
            for (at, frames) in run.frames.iter().enumerate() {
                let Some(frame) = frames.times.iter().rposition(|t| *t <= time) else { continue };
                let surfaces = &self.plan.models[self.plan.stacks[at].model].surfaces;
                for (pose, points) in frames.poses[frame].iter().zip(surfaces) {
                    if near(pose) {
                        outlines.push(outline_in_plan(points, pose));
                    }
                }
            }
            Obstacles { cellar: &self.cellar, taken: outlines.iter().collect() }
                .is_passable(from, to)
        };
        let mut blocked = run.end_time;
        while blocked > BLOCKED && !passable(blocked - BLOCKED) {
            blocked -= BLOCKED;
        }
        Some(blocked)
    }
}

/// Function that processes one variant. Its arguments are the variant number, the number of threads, and the observer.
/// It returns `None` if the work was interrupted.
pub(crate) type OfVariant<'a, T> =
    &'a (dyn Fn(u32, usize, Observer<'_>) -> Result<Option<T>, CellarFailure> + Sync);

/// Calls the function `one` for each of the variants `numbers`, several at a time, and returns its results. The
/// observer is called as in [`Prepared::cases`].
///
/// # Errors
/// The first error that the function returns.
pub(crate) fn each<T: Send>(
    numbers: &[u32],
    observer: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
    one: OfVariant<'_, T>,
) -> Result<Vec<Option<T>>, CellarFailure> {
    let (done, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    // A single room takes all cores by itself.
    let threads = usize::from(numbers.len() > 1);
    let report = |done: usize| {
        if observer(done).is_break() {
            stopped.store(true, Ordering::Relaxed);
        }
        if stopped.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let work = |number: &u32| {
        if report(done.load(Ordering::Relaxed)).is_break() {
            return Ok(None);
        }
        let mut look = |_: &Advance| report(done.load(Ordering::Relaxed));
        let result = one(*number, threads, &mut look)?;
        if result.is_some() {
            let _ = report(done.fetch_add(1, Ordering::Relaxed) + 1);
        }
        Ok(result)
    };
    pool::map(numbers, work, &|_| ()).into_iter().collect()
}

/// Step (s) of the backward search for the time from which an aisle stays blocked.
const BLOCKED: f64 = 0.25;

fn drawn(scenario: &Scenario, variant: u32) -> Result<Scenario, CellarFailure> {
    let mut all = planes(scenario)?;
    Ok(all.swap_remove(0).variant(variant))
}

/// Returns the time (s) at which the shaking starts; zero without motion.
fn onset(ground: &Ground) -> f64 {
    let velocity = |time: f64| Drive::<Spatial>::at(ground, time).1;
    let mut time = 0.0;
    let mut before = velocity(time);
    while time < ground.end() {
        let after = velocity(time + SAMPLE);
        let [x, y] = [after.x - before.x, after.y - before.y];
        if (x * x + y * y).sqrt() > ONSET * SAMPLE {
            return time;
        }
        (time, before) = (time + SAMPLE, after);
    }
    0.0
}

/// Returns the walls and columns of a room as obstacles.
fn obstacles(cellar: &Cellar) -> Result<Vec<Obstacle>, CellarFailure> {
    let room = &cellar.room;
    let stated = cellar.stated().stack().map(|stack| stack.interfaces.barrel_ground);
    let Some(mut law) = stated else { return Ok(Vec::new()) };
    if room.stiffness.is_some() || room.restitution.is_some() {
        let NormalLaw::Rebound { stiffness, restitution, .. } = &mut law.normal else {
            let message = "the stiffness and restitution of walls need a rebound contact law: set `law = \"rebound\"` \
                           in interface.barrel-ground, or leave them out"
                .to_owned();
            return Err(cellar.host.error(&["room.stiffness", "room.restitution"], message).into());
        };
        *stiffness = room.stiffness.unwrap_or(*stiffness);
        *restitution = room.restitution.unwrap_or(*restitution);
    }
    if let Some(wanted) = room.friction {
        set_friction(&mut law, wanted);
    }
    let interface = law_in_space("obstacle", &law);
    let block = |name: &str, lower: [f64; 2], upper: [f64; 2]| Obstacle {
        name: name.to_owned(),
        center: [0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1]), 0.5 * room.height],
        half: [0.5 * (upper[0] - lower[0]), 0.5 * (upper[1] - lower[1]), 0.5 * room.height],
        azimuth: 0.0,
        interface: interface.clone(),
    };
    let (l, w) = (room.length, room.width);
    let mut all = Vec::new();
    if room.walls {
        all.extend([
            block("left wall", [-WALL, -WALL], [0.0, w + WALL]),
            block("right wall", [l, -WALL], [l + WALL, w + WALL]),
            block("near wall", [0.0, -WALL], [l, 0.0]),
            block("far wall", [0.0, w], [l, w + WALL]),
        ]);
    }
    all.extend(cellar.columns.iter().map(|column| {
        let [lower, upper] = column.corners();
        block(&column.name, lower, upper)
    }));
    Ok(all)
}

/// Sets the friction coefficient of a contact law.
fn set_friction(law: &mut Interface, wanted: f64) {
    match &mut law.friction {
        Friction::Coulomb { coefficient, static_coefficient, .. } => {
            let ratio = if *coefficient > 0.0 { *static_coefficient / *coefficient } else { 1.0 };
            (*coefficient, *static_coefficient) = (wanted, wanted * ratio);
        }
        Friction::Regularized { coefficient, .. } => *coefficient = wanted,
        Friction::None => {}
    }
}

/// Result of one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Number of the variant; 0 is the room as stated in its file, without random draws.
    pub variant: u32,
    /// `false` if the computation of a stack failed.
    pub valid: bool,
    /// The stacks, in the order of the plan.
    pub stacks: Vec<StackCase>,
    /// The aisles.
    pub aisles: Vec<AisleCase>,
    /// For each place where people work, `true` if a path to a door is left; `None` if there are no doors.
    pub paths_to_doors: Vec<Option<bool>>,
    /// Walls and columns.
    pub obstacles: Vec<ObstacleCase>,
    /// For each cell of the map, `true` if a fallen barrel covers it at the end.
    pub map: Vec<bool>,
    /// Time (s) at which the run of the last stack ended.
    pub end_time: f64,
    /// `true` if the run ended before all stacks were at rest.
    pub cut_short: bool,
    /// Number of stacks in which a body still moved at the end.
    pub still_moving: usize,
    /// Warnings, one sentence each, preceded by the name of the stack that the warning concerns; `None` instead of the
    /// name if a warning concerns the whole room.
    pub warnings: Vec<(Option<String>, String)>,
    /// For a sequence, the results of its shocks, each in the time of its own run, which begins at zero; empty for a
    /// single shock.
    pub shocks: Vec<Self>,
}

/// A stack in one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StackCase {
    /// `false` if the computation of the stack failed.
    pub valid: bool,
    /// `true` if the stack had fallen before the run; it does not fall again.
    pub fallen_before: bool,
    /// Time (s) of the first loss of a seat, if the stack falls.
    pub fell_at: Option<f64>,
    /// `true` if the stack falls after a body of another stack touched it.
    pub knocked: bool,
    /// First contact with another stack: time (s), index of the other stack, and impulse (N·s) that other stacks exert
    /// on this stack until its first loss of a seat ([`Touch::impulse`](crate::Touch::impulse)).
    pub touched: Option<(f64, usize, f64)>,
    /// Names of the two bodies of the first contact: the body of this stack, and that of the other stack.
    pub touching: Option<[String; 2]>,
    /// Number of barrels that fell.
    pub barrels: usize,
    /// Expected numbers of barrels that burst, one for each of the three assumptions in [`Breakage::RANGE`].
    pub burst: [f64; 3],
    /// Expected volumes (m³) of wine lost, one for each of the three assumptions in [`Breakage::RANGE`].
    pub wine: [f64; 3],
    /// Largest horizontal displacement (m) at the end of the run, over the bodies that did not fall.
    pub moved: f64,
}

impl StackCase {
    /// Returns `true` if the stack falls by itself.
    pub fn by_itself(&self) -> bool {
        self.fell_at.is_some() && !self.knocked
    }
}

/// An aisle in one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AisleCase {
    /// Time (s), counted from the start of the shaking, at which the center of a barrel is first above the aisle.
    /// `None` if no barrel enters the aisle. Barrels that are above the aisle before the run do not count.
    pub first: Option<f64>,
    /// Largest speed (m/s) that any barrel counted in `first` has while its center is above the aisle; `None` if no
    /// barrel enters the aisle.
    pub fastest: Option<f64>,
    /// Share of the aisle's area that bodies cover at the end of the run.
    pub covered: f64,
    /// Time (s), counted from the start of the shaking, from which no path as wide as a person leads through the aisle
    /// any more; `None` if there is such a path at the end of the run.
    pub blocked_at: Option<f64>,
}

/// A wall or column in one variant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObstacleCase {
    /// `true` if a body struck the wall or column.
    pub struck: bool,
    /// Largest magnitude (N) of the total force on the wall or column.
    pub peak: f64,
    /// Magnitude (N·s) of the impulse on the wall or column over the whole run.
    pub impulse: f64,
}

fn stack_case(run: &RoomRun, end: &StackEnd) -> StackCase {
    let bodies = &run.bodies[end.bodies.clone()];
    let collapsed = matches!(end.outcome, Outcome::Collapse { .. });
    let (fallen_before, falls) = (collapsed && end.was_down(), collapsed && !end.was_down());
    let fallen: Vec<_> = bodies
        .iter()
        .filter(|body| body.kind == PartKind::Barrel)
        .filter(|body| body.fate.fell_at.is_some_and(|time| time > 0.0))
        .collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        fallen.iter().map(|body| of(body.fate.drop, body.wine)).sum()
    };
    StackCase {
        valid: !matches!(end.outcome, Outcome::Invalid { .. }),
        fallen_before,
        fell_at: end.lost_seat.map(|(time, _)| time).filter(|_| falls),
        knocked: falls && end.knocked_over,
        touched: end.touched.map(|touch| (touch.time, run.bodies[touch.by].stack, touch.impulse)),
        touching: end
            .touched
            .map(|touch| [touch.body, touch.by].map(|body| run.bodies[body].name.clone())),
        barrels: fallen.len(),
        burst: Breakage::RANGE.map(|breakage| sum(&|drop, _| breakage.probability(drop))),
        wine: Breakage::RANGE.map(|breakage| sum(&|drop, wine| wine * breakage.probability(drop))),
        moved: bodies
            .iter()
            .filter(|body| body.fate.fell_at.is_none())
            .map(|body| moved(&body.from, &body.to))
            .fold(0.0, f64::max),
    }
}
