//! An island: stacks that advance together, since their bodies may meet.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use barrelstack::run::Work;
use barrelstack::watch::Ending;
use barrelstack_dynamics::join::{Frame, Running};
use barrelstack_dynamics::{
    BodyId, Drive as _, EnergySummary, Model, Pose, RunError, Simulation, Space as _, Spatial,
    Twist, Vec3,
};
use barrelstack_space::fate::Fates;
use barrelstack_space::rest::Rest;
use barrelstack_space::{Ground, Stack};

use crate::result::RoomFrames;
use crate::world::World;

/// A body of a stack: index of the stack, and ID of the body within its stack.
pub(crate) type StackBody = (usize, BodyId);

/// Owner of a body of the model of an island.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Owner {
    /// A body of a stack.
    Stack(StackBody),
    /// An obstacle, by its index in the room.
    Obstacle(usize),
}

/// A stack of an island.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    /// Index of the stack in the room.
    pub(crate) stack: usize,
    /// IDs of the bodies of the stack in the model of the island.
    pub(crate) bodies: Range<BodyId>,
    /// Indices of the elements of the stack in the model of the island.
    pub(crate) elements: Range<usize>,
    /// Placement of the frame of the stack in the frame of the island.
    pub(crate) frame: Frame,
}

/// Data of an island that change only when the island is merged with another.
#[derive(Debug)]
pub(crate) struct Fixed {
    pub(crate) members: Vec<Member>,
    /// Indices, in the room, of the obstacles that the model contains.
    pub(crate) obstacles: Vec<usize>,
    /// The owners of the bodies of the model.
    pub(crate) owners: Vec<Owner>,
    pub(crate) model: Arc<Model<Spatial>>,
    pub(crate) drive: Ground,
    /// Placement, in the room, of the frame of the island, which is the frame of its first stack.
    pub(crate) frame: Frame,
    pub(crate) simulation: Simulation,
}

/// Record of the contacts between two parties, each a stack or an obstacle.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    pub(crate) time: f64,
    /// The bodies of the first contact.
    pub(crate) bodies: [Owner; 2],
    /// Total force (N) on the first of the two parties after the last time step, in the frame of the island.
    pub(crate) last: Vec3,
    now: Vec3,
    /// Impulse (N·s) so far: the time integral of the magnitude of the force.
    pub(crate) impulse: f64,
    pub(crate) peak: f64,
}

/// Observers of a stack.
#[derive(Clone, Debug)]
pub(crate) struct Watch {
    pub(crate) fates: Fates,
    pub(crate) rest: Rest,
    /// First contact with a body of another stack: time (s), own body, other body; `None` before this contact.
    pub(crate) touched: Option<(f64, BodyId, StackBody)>,
    pub(crate) touched_obstacle: Option<(f64, usize)>,
    /// Impulse (N·s) that other stacks exert on the stack until the first of its bodies loses its seat. It is the sum
    /// of the impulses of the contacts, each computed like [`Contact::impulse`].
    pub(crate) impulse: f64,
}

/// The part of an island that changes during a run. A copy of it lets the island return to the start of a time window.
#[derive(Clone, Debug)]
pub(crate) struct Live {
    pub(crate) running: Running,
    pub(crate) watches: Vec<Watch>,
    pub(crate) contacts: BTreeMap<[PartyId; 2], Contact>,
    pub(crate) ending: Option<Ending>,
    pub(crate) failure: Option<RunError>,
    /// Lengths of the island's logs in this state. When the island returns to this state, its logs are cut to these
    /// lengths.
    kept: Vec<usize>,
    /// For every body, an upper bound (m) on the largest displacement of any of its points, relative to the ground,
    /// since the start of the window.
    pub(crate) travels: Vec<f64>,
    /// The body that stopped the last advance: in the next step, it could have exceeded the distance that
    /// [`Island::tubes`] allows. `None` if no body stopped the advance.
    pub(crate) stopped_by: Option<BodyId>,
    /// Time (s) before which the run of the island does not end, because a barrel rolls toward another stack.
    pub(crate) not_before: f64,
}

impl Live {
    /// Creates the mutable state of an island, without contact records.
    pub(crate) fn of(running: Running, watches: Vec<Watch>) -> Self {
        let travels = vec![0.0; running.state.poses.len()];
        Self {
            running,
            watches,
            contacts: BTreeMap::new(),
            ending: None,
            failure: None,
            kept: Vec::new(),
            travels,
            stopped_by: None,
            not_before: 0.0,
        }
    }
}

/// Stack or obstacle that takes part in a contact, by its index in the room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PartyId {
    Stack(usize),
    Obstacle(usize),
}

impl Owner {
    fn party(self) -> PartyId {
        match self {
            Self::Stack((stack, _)) => PartyId::Stack(stack),
            Self::Obstacle(obstacle) => PartyId::Obstacle(obstacle),
        }
    }
}

/// Logs of an island. Entries are only appended, so that an earlier state of a log is restored by cutting it to its
/// earlier length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Logs {
    /// Recorded frames of every member.
    pub(crate) frames: Vec<RoomFrames>,
    /// For every obstacle of the island, the history of the force on it: time (s), and force (N) along the axes of the
    /// room.
    pub(crate) forces: Vec<Vec<(f64, [f64; 3])>>,
}

/// Stacks that advance together.
#[derive(Debug)]
pub(crate) struct Island {
    pub(crate) fixed: Fixed,
    pub(crate) live: Live,
    pub(crate) logs: Logs,
    /// Sum of the energy balances of the islands that were merged into this one, up to the merge.
    pub(crate) energy_before: EnergySummary,
    pub(crate) work: Work,
    /// Time (s) between recorded frames; `None` if no frames are recorded.
    pub(crate) every: Option<f64>,
    /// For every body, the distance (m) that it may move in the current window.
    pub(crate) tubes: Vec<f64>,
    /// For every body, its pose relative to the ground at the start of the window.
    from: Vec<Pose<Spatial>>,
    /// The state at the start of the window.
    start: Option<Box<Live>>,
}

impl Island {
    /// Creates an island of a single stack.
    pub(crate) fn alone(world: &World<'_>, stack: usize, every: Option<f64>) -> Self {
        let of = &world.stacks[stack];
        let Running { state, mut scratch, stepper } = of.running.clone();
        scratch.keeps_contacts = false;
        let count = of.stack.parts.len();
        let fates = Fates::new(Arc::clone(&of.stack), &of.at_rest, of.thresholds);
        let rest = Rest::new(of.scenario, Arc::clone(&of.stack), &world.room.ground);
        let watch = Watch { fates, rest, touched: None, touched_obstacle: None, impulse: 0.0 };
        let fixed = Fixed {
            members: vec![Member {
                stack,
                bodies: 0..count,
                elements: 0..of.stack.model.elements().len(),
                frame: Frame::default(),
            }],
            obstacles: Vec::new(),
            owners: (0..count).map(|body| Owner::Stack((stack, body))).collect(),
            model: Arc::new(of.stack.model.clone()),
            drive: world.room.ground.clone().turned(of.frame.azimuth),
            frame: of.frame,
            simulation: of.simulation,
        };
        let live = Live::of(Running { state, scratch, stepper }, vec![watch]);
        let logs = Logs { frames: vec![RoomFrames::default()], forces: Vec::new() };
        let mut island = Self::of(fixed, live, logs, every);
        island.observe(0.0);
        island
    }

    /// Creates an island at the start of a window.
    pub(crate) fn of(fixed: Fixed, live: Live, logs: Logs, every: Option<f64>) -> Self {
        let tubes = vec![f64::INFINITY; fixed.owners.len()];
        let (energy_before, work) = (EnergySummary::default(), Work::default());
        Self { fixed, live, logs, energy_before, work, every, tubes, from: Vec::new(), start: None }
    }

    pub(crate) fn time(&self) -> f64 {
        self.live.running.state.time
    }

    pub(crate) fn is_awake(&self) -> bool {
        self.live.ending.is_none()
    }

    /// Returns the poses and twists of the bodies of a member, in the frame of its stack.
    pub(crate) fn own(&self, member: usize) -> (Vec<Pose<Spatial>>, Vec<Twist<Spatial>>) {
        let Member { bodies, frame, .. } = &self.fixed.members[member];
        let (state, back) = (&self.live.running.state, frame.back());
        let poses = state.poses[bodies.clone()].iter().map(|pose| back.pose(*pose)).collect();
        let twists = state.twists[bodies.clone()].iter().map(|twist| back.twist(*twist)).collect();
        (poses, twists)
    }

    /// Returns the pose of a body relative to the ground, in the coordinates of the room.
    pub(crate) fn in_room(&self, body: BodyId) -> Pose<Spatial> {
        self.fixed.frame.pose(self.relative(body))
    }

    /// Returns the velocity (m/s) of a body relative to the ground, along the axes of the room.
    pub(crate) fn velocity(&self, body: BodyId) -> Vec3 {
        let twists = &self.live.running.state.twists;
        self.fixed.frame.vector(twists[body].linear - twists[Stack::GROUND].linear)
    }

    /// Returns the pose of a body relative to the ground, in the coordinates of the island.
    fn relative(&self, body: BodyId) -> Pose<Spatial> {
        let poses = &self.live.running.state.poses;
        let Pose { position, orientation } = poses[body];
        Pose { position: position - poses[Stack::GROUND].position, orientation }
    }

    /// Returns an upper bound on the speed (m/s) of any point of a body, relative to the ground.
    pub(crate) fn speed(&self, world: &World<'_>, body: BodyId) -> f64 {
        let Owner::Stack((stack, own)) = self.fixed.owners[body] else { return 0.0 };
        let twists = &self.live.running.state.twists;
        let Twist { linear, angular } = twists[body];
        let velocity = linear - twists[Stack::GROUND].linear;
        velocity.length() + angular.length() * world.stacks[stack].reach[own]
    }

    /// Returns the bodies that move fast although their stack rests: barrels that roll away from it.
    pub(crate) fn rolling(&self) -> Vec<BodyId> {
        let mut all = Vec::new();
        for (number, watch) in self.live.watches.iter().enumerate() {
            let (poses, twists) = self.own(number);
            let first = self.fixed.members[number].bodies.start;
            all.extend(watch.rest.moving((&poses, &twists)).map(|body| first + body));
        }
        all
    }

    /// Returns the number of moving bodies of a member.
    pub(crate) fn moving(&self, member: usize) -> usize {
        let (poses, twists) = self.own(member);
        self.live.watches[member].rest.moving((&poses, &twists)).count()
    }

    /// Starts a time window, in which no body may move farther than [`Island::tubes`] allows; `keeps` is `true` if the
    /// island may have to return to the start of the window.
    pub(crate) fn open(&mut self, keeps: bool) {
        self.from = (0..self.fixed.owners.len()).map(|body| self.relative(body)).collect();
        self.live.travels.fill(0.0);
        self.live.stopped_by = None;
        self.live.kept = self.logs.lengths();
        self.start = keeps.then(|| Box::new(self.live.clone()));
    }

    /// Returns to the start of the window.
    pub(crate) fn go_back(&mut self) {
        if let Some(start) = &self.start {
            self.live = (**start).clone();
            self.logs.cut(&self.live.kept);
        }
    }

    /// Advances until the next time step would end after `until` (s), or until a body could, in that step, exceed the
    /// distance that [`Island::tubes`] allows.
    pub(crate) fn advance(&mut self, world: &World<'_>, until: f64) {
        let Simulation { time_step: step, end_time, .. } = self.fixed.simulation;
        let latest = until + 1e-9 * step;
        self.live.stopped_by = None;
        while self.is_awake() && (self.time() + step <= latest || latest >= end_time) {
            if let Some(body) = self.update_travels(world, step) {
                self.live.stopped_by = Some(body);
                return;
            }
            self.step(None);
        }
        let _ = self.update_travels(world, 0.0);
    }

    /// Advances to a time (s) exactly; the last time step is shortened.
    pub(crate) fn advance_to(&mut self, world: &World<'_>, time: f64) {
        let sliver = 1e-9 * self.fixed.simulation.time_step;
        self.live.stopped_by = None;
        while self.is_awake() && self.time() < time - sliver {
            self.step(Some(time));
            let _ = self.update_travels(world, 0.0);
        }
        if self.live.failure.is_none() {
            self.wait_until(time);
        }
    }

    /// Sets a later time (s) without time steps: all bodies keep their poses and velocities relative to the ground.
    fn wait_until(&mut self, time: f64) {
        let state = &mut self.live.running.state;
        if time <= state.time {
            return;
        }
        let [(before, fast), (after, slow)] = [state.time, time].map(|at| self.fixed.drive.at(at));
        for (pose, twist) in state.poses.iter_mut().zip(&mut state.twists) {
            pose.position += after - before;
            twist.linear += slow - fast;
        }
        state.time = time;
    }

    /// Updates how far each body has moved since the start of the window. Returns a body that could exceed the
    /// distance that [`Island::tubes`] allows within a time `ahead` (s).
    fn update_travels(&mut self, world: &World<'_>, ahead: f64) -> Option<BodyId> {
        if self.from.is_empty() {
            return None;
        }
        let state = &self.live.running.state;
        let ground = (state.poses[Stack::GROUND].position, state.twists[Stack::GROUND].linear);
        let mut first = None;
        for (body, owner) in self.fixed.owners.iter().enumerate() {
            let Owner::Stack((stack, own)) = *owner else { continue };
            if own == Stack::GROUND {
                continue;
            }
            let reach = world.stacks[stack].reach[own];
            let (pose, twist, from) = (state.poses[body], state.twists[body], self.from[body]);
            let moved = (pose.position - ground.0 - from.position).length();
            let turned = Spatial::angle_between(pose.orientation, from.orientation);
            let travel = moved + turned * reach;
            self.live.travels[body] = self.live.travels[body].max(travel);
            let speed = (twist.linear - ground.1).length() + twist.angular.length() * reach;
            // The factor allows for a change of velocity within the step.
            if travel + 1.5 * ahead * speed > self.tubes[body] && first.is_none() {
                first = Some(body);
            }
        }
        first
    }

    fn step(&mut self, until: Option<f64>) {
        let Running { state, scratch, stepper } = &mut self.live.running;
        let Fixed { model, drive, .. } = &self.fixed;
        let before = state.time;
        let result = match until {
            Some(until) => stepper.step_until(model, drive, state, scratch, until),
            None => stepper.step(model, drive, state, scratch),
        };
        if let Err(error) = result {
            (self.live.failure, self.live.ending) = (Some(error), Some(Ending::Broken));
            return;
        }
        self.observe(self.time() - before);
    }

    /// Processes an accepted state, a time `step` (s) after the previous one: updates the outcomes, the contacts and
    /// the logs, and checks whether the run of the island ends.
    fn observe(&mut self, step: f64) {
        let rests = self.watch();
        self.meet(step);
        self.record();
        if self.live.ending.is_none() {
            if rests && self.live.not_before <= self.time() {
                self.live.ending = Some(Ending::Rest);
            } else if self.live.running.stepper.is_at_end(&self.live.running.state) {
                self.live.ending = Some(Ending::Patience);
            }
        }
    }

    /// Updates the outcomes of the bodies and checks whether the stacks are at rest; returns `true` if all are.
    fn watch(&mut self) -> bool {
        let time = self.time();
        let mut rests = true;
        for (number, Member { bodies, frame, .. }) in self.fixed.members.iter().enumerate() {
            let placed = *frame != Frame::default();
            let (poses, twists) = if placed { self.own(number) } else { Default::default() };
            let Running { state, scratch, .. } = &self.live.running;
            let (poses, twists) = if placed {
                (&poses[..], &twists[..])
            } else {
                (&state.poses[bodies.clone()], &state.twists[bodies.clone()])
            };
            let watch = &mut self.live.watches[number];
            watch.fates.observe_bodies(time, poses, &scratch.wrenches[bodies.clone()]);
            let collapsed = watch.fates.collapse().is_some();
            rests &= watch.rest.observe_bodies(time, (poses, twists), collapsed);
        }
        rests
    }

    /// Updates the contact records, the observers and the forces on obstacles after a time step of length `step` (s).
    fn meet(&mut self, step: f64) {
        let Live { running, watches, contacts, .. } = &mut self.live;
        let forces = &running.scratch.pair_forces;
        let first = forces.partition_point(|f| f.pair < self.fixed.model.first_foreign_pair());
        let time = running.state.time;
        for contact in contacts.values_mut() {
            contact.now = Vec3::default();
        }
        for force in &forces[first..] {
            let (mut bodies, mut on) =
                ([force.contactor, force.target].map(|body| self.fixed.owners[body]), force.force);
            if bodies[1] < bodies[0] {
                bodies.reverse();
                on = -on;
            }
            let contact = contacts.entry(bodies.map(Owner::party)).or_insert(Contact {
                time,
                bodies,
                last: Vec3::default(),
                now: Vec3::default(),
                impulse: 0.0,
                peak: 0.0,
            });
            contact.now += on;
        }
        for (parties, contact) in contacts.iter_mut() {
            let (now, last) = (contact.now.length(), contact.last.length());
            let impulse = 0.5 * step * (now + last);
            contact.impulse += impulse;
            contact.peak = contact.peak.max(now);
            for (side, party) in parties.iter().enumerate() {
                let PartyId::Stack(stack) = *party else { continue };
                let Some(at) = self.fixed.members.iter().position(|of| of.stack == stack) else {
                    continue;
                };
                let watch = &mut watches[at];
                match (contact.bodies[side], contact.bodies[1 - side]) {
                    (Owner::Stack((_, own)), Owner::Stack(other)) => {
                        if now > 0.0 && watch.touched.is_none() {
                            watch.touched = Some((time, own, other));
                        }
                        if watch.fates.collapse().is_none_or(|(at, _)| at >= time) {
                            watch.impulse += impulse;
                        }
                    }
                    (Owner::Stack(_), Owner::Obstacle(obstacle)) => {
                        if now > 0.0 && watch.touched_obstacle.is_none() {
                            watch.touched_obstacle = Some((time, obstacle));
                        }
                    }
                    (Owner::Obstacle(_), _) => {}
                }
            }
            contact.last = contact.now;
        }
        for (number, obstacle) in self.fixed.obstacles.iter().enumerate() {
            let of = |(parties, contact): (&[PartyId; 2], &Contact)| {
                (parties[1] == PartyId::Obstacle(*obstacle)).then_some(-contact.now)
            };
            let touching = contacts.iter().filter_map(of);
            let total = touching.fold(Vec3::default(), |sum, force| sum + force);
            let Vec3 { x, y, z } = self.fixed.frame.vector(total);
            let log = &mut self.logs.forces[number];
            let (none, now) = ([0.0; 3], [x, y, z]);
            if now != none {
                if log.last().is_none_or(|(_, last)| *last == none) {
                    log.push((time - step, none));
                }
                log.push((time, now));
            } else if log.last().is_some_and(|(_, last)| *last != none) {
                log.push((time, none));
            }
        }
    }

    /// Records a frame when it is due.
    fn record(&mut self) {
        let Some(every) = self.every else { return };
        for (number, Member { bodies, .. }) in self.fixed.members.iter().enumerate() {
            let time = self.time();
            let last = self.logs.frames[number].times.last();
            let due = last.map_or(0.0, |last| ((last / every + 1e-9).floor() + 1.0) * every);
            if time < due {
                continue;
            }
            let bodies = bodies.clone().skip(1);
            let poses = bodies.clone().map(|body| numbers(self.in_room(body))).collect();
            let speeds = bodies.map(|body| self.velocity(body).length()).collect();
            let frames = &mut self.logs.frames[number];
            frames.times.push(time);
            frames.poses.push(poses);
            frames.speeds.push(speeds);
        }
    }

    /// Returns the energy balance since the start, including the islands from which this one was merged.
    pub(crate) fn energy(&self) -> EnergySummary {
        plus(self.live.running.stepper.energy.summary(0), &self.energy_before)
    }

    /// Returns the numbers of time steps and force evaluations since the start.
    pub(crate) fn work(&self) -> Work {
        let Running { scratch, stepper, .. } = &self.live.running;
        Work {
            steps: self.work.steps + stepper.steps,
            evaluations: self.work.evaluations + scratch.evaluations,
            contact_evaluations: self.work.contact_evaluations + scratch.contact_evaluations,
        }
    }
}

impl Logs {
    fn lengths(&self) -> Vec<usize> {
        let frames = self.frames.iter().map(|frames| frames.times.len());
        frames.chain(self.forces.iter().map(Vec::len)).collect()
    }

    fn cut(&mut self, lengths: &[usize]) {
        let (frames, forces) = lengths.split_at(self.frames.len());
        for (of, length) in self.frames.iter_mut().zip(frames) {
            of.times.truncate(*length);
            of.poses.truncate(*length);
            of.speeds.truncate(*length);
        }
        for (of, length) in self.forces.iter_mut().zip(forces) {
            of.truncate(*length);
        }
    }
}

/// Adds two energy balances term by term.
pub(crate) fn plus(one: EnergySummary, other: &EnergySummary) -> EnergySummary {
    EnergySummary {
        kinetic: one.kinetic + other.kinetic,
        potential: one.potential + other.potential,
        elastic: one.elastic + other.elastic,
        stick: one.stick + other.stick,
        damped: one.damped + other.damped,
        friction: one.friction + other.friction,
        viscous: one.viscous + other.viscous,
        ground_work: one.ground_work + other.ground_work,
        applied_work: one.applied_work + other.applied_work,
        residual: one.residual + other.residual,
        throughput: one.throughput + other.throughput,
    }
}

/// Returns the components of a pose: the position x, y, z (m), followed by the quaternion w, x, y, z of the
/// orientation.
pub(crate) fn numbers(pose: Pose<Spatial>) -> [f64; 7] {
    let (p, q) = (pose.position, pose.orientation);
    [p.x, p.y, p.z, q.w, q.v.x, q.v.y, q.v.z]
}
