//! Data of a room that do not change during its run.

use std::sync::Arc;

use barrelstack::Scenario;
use barrelstack::overlap::ALLOWED;
use barrelstack::pool;
use barrelstack::run::{check_length, end_time, method, thresholds};
use barrelstack::watch::Thresholds;
use barrelstack_dynamics::contact_elements::ContactElements;
use barrelstack_dynamics::join::{Crossing, Frame, Running};
use barrelstack_dynamics::solid::Block;
use barrelstack_dynamics::{
    Body, Model, Motion, Placed as On, Pose, Quaternion, Rotation3, Scratch, Simulation, Solid,
    Spatial, State, Stepper, Substepping, Twist, Vec3, evaluate,
};
use barrelstack_space::Stack;
use barrelstack_space::run::{Standing, deepest_overlap};
use barrelstack_space::step::steps_at_fixed;

use crate::contact_kinds::ContactKinds;
use crate::island::Owner;
use crate::room::{MOST_BODIES, Obstacle, Placed, Room, RoomFailure, Shift};

/// A stack of a room.
pub(crate) struct StackOf<'a> {
    pub(crate) name: &'a str,
    pub(crate) scenario: &'a Scenario,
    pub(crate) stack: Arc<Stack>,
    /// State at rest, before the ground moves.
    pub(crate) at_rest: State<Spatial>,
    /// State at the start of the run.
    pub(crate) running: Running,
    pub(crate) thresholds: Thresholds,
    pub(crate) simulation: Simulation,
    pub(crate) kinds: Vec<usize>,
    /// For every body, the radius (m) of a sphere about its center of mass that encloses it.
    pub(crate) reach: Vec<f64>,
    pub(crate) rank: usize,
    pub(crate) frame: Frame,
    /// Index of the first body of the stack, which is its ground, in a list of the bodies of all stacks.
    pub(crate) first: usize,
}

/// An obstacle of a room.
pub(crate) struct ObstacleOf {
    pub(crate) model: Model<Spatial>,
    pub(crate) kinds: [usize; 1],
    pub(crate) rank: usize,
    /// Longest time step (s) with which the contacts of the obstacle are integrated.
    pub(crate) step: f64,
}

/// Data of a room that do not change during its run.
pub(crate) struct World<'a> {
    pub(crate) room: &'a Room,
    pub(crate) stacks: Vec<StackOf<'a>>,
    pub(crate) obstacles: Vec<ObstacleOf>,
    pub(crate) crossing: Arc<Crossing>,
    pub(crate) end_time: f64,
    /// Number of bodies of all stacks, grounds included.
    pub(crate) count: usize,
}

/// Radius (m) of the rounded edges of an obstacle.
const ROUNDING: f64 = 0.01;

impl<'a> World<'a> {
    /// Builds and settles all stacks.
    pub(crate) fn of(room: &'a Room, threads: usize) -> Result<Self, RoomFailure> {
        check(room)?;
        let of = |placed: &Placed, failure| RoomFailure::Stack {
            name: placed.name.clone(),
            failure: Box::new(failure),
        };
        let mut end = 0.0_f64;
        for placed in &room.stacks {
            let own = end_time(&placed.scenario, room.ground.motion_end(), 1.0);
            end = end.max(own.map_err(|failure| of(placed, failure))?);
        }
        let stand = |placed: &Placed| barrelstack_space::run::stand(&placed.scenario);
        let standing = pool::map_on(threads, &room.stacks, stand, &|_| ());
        let mut ranks: Vec<usize> = (0..room.stacks.len()).collect();
        ranks.sort_by(|a, b| room.stacks[*a].name.cmp(&room.stacks[*b].name));
        let (mut kinds, mut stacks, mut first) = (ContactKinds::default(), Vec::new(), 0);
        for (number, (placed, standing)) in room.stacks.iter().zip(standing).enumerate() {
            let scenario = &placed.scenario;
            let Standing { stack, mut state, mut scratch, .. } =
                standing.map_err(|failure| of(placed, failure))?;
            check_length(end, stack.step).map_err(|failure| of(placed, failure))?;
            let simulation =
                Simulation { method: method(scenario), time_step: stack.step, end_time: end };
            let at_rest = state.clone();
            if placed.start.is_some() || !placed.shifts.is_empty() {
                start_from(&mut state, placed, &stack)?;
            }
            let drive = room.ground.clone().turned(placed.azimuth);
            let stepper =
                Stepper::start(&stack.model, &drive, &mut state, &mut scratch, &simulation);
            let rank = ranks.iter().position(|at| *at == number).unwrap_or_default();
            stacks.push(StackOf {
                name: &placed.name,
                scenario,
                at_rest,
                running: Running { state, scratch, stepper },
                thresholds: thresholds(scenario),
                simulation,
                kinds: kinds.of_stack(&stack, &scenario.scene),
                reach: stack.model.bodies().iter().map(Body::reach).collect(),
                rank: room.obstacles.len() + rank,
                frame: Frame {
                    at: Vec3::new(placed.at[0], placed.at[1], 0.0),
                    azimuth: placed.azimuth,
                },
                first,
                stack: Arc::new(stack),
            });
            first += stacks[number].stack.parts.len();
        }
        let kind = kinds.of_obstacle();
        let obstacles = room.obstacles.iter().enumerate();
        let obstacles = obstacles
            .map(|(rank, obstacle)| obstacle_of(obstacle, rank, kind, &stacks))
            .collect::<Result<_, _>>()?;
        let crossing = Arc::new(kinds.crossing());
        Ok(Self { room, stacks, obstacles, crossing, end_time: end, count: first })
    }

    /// Returns the index of a body or an obstacle in a list of the bodies of all stacks, followed by the obstacles.
    pub(crate) fn number(&self, owner: Owner) -> usize {
        match owner {
            Owner::Stack((stack, body)) => self.stacks[stack].first + body,
            Owner::Obstacle(obstacle) => self.count + obstacle,
        }
    }

    /// Returns a body or an obstacle of the room, and the index of its contact kind.
    pub(crate) fn body(&self, owner: Owner) -> (&Body<Spatial>, usize) {
        match owner {
            Owner::Stack((stack, body)) => {
                let of = &self.stacks[stack];
                (&of.stack.model.bodies()[body], of.kinds[body])
            }
            Owner::Obstacle(obstacle) => {
                let of = &self.obstacles[obstacle];
                (&of.model.bodies()[0], of.kinds[0])
            }
        }
    }

    /// Returns the name of a body in the room.
    pub(crate) fn name(&self, owner: Owner) -> String {
        match owner {
            Owner::Stack((stack, body)) => {
                let of = &self.stacks[stack];
                format!("{} {}", of.name, of.stack.parts[body].name)
            }
            Owner::Obstacle(obstacle) => self.room.obstacles[obstacle].name.clone(),
        }
    }
}

/// Largest depth (m) by which bodies may overlap if a stack starts from stated poses: in a heap, loads press bodies
/// into each other.
pub(crate) const PRESSED: f64 = 5.0 * ALLOWED;

/// Maximum increase (m) of the deepest overlap within a stack when its bodies are shifted from their poses at rest; a
/// larger increase is an error.
const DEEPENED: f64 = 0.5 * ALLOWED;

/// Moves the bodies of a stack to the poses from which it starts, at rest and without contact history.
fn start_from(
    state: &mut State<Spatial>,
    placed: &Placed,
    stack: &Stack,
) -> Result<(), RoomFailure> {
    let name = || placed.name.clone();
    let deepest = |state: &State<Spatial>| {
        // The list of contact elements still belongs to the previous poses.
        let (mut state, mut scratch) = (state.clone(), Scratch::new(&stack.model));
        state.contact_elements.make_exhaustive(&stack.model, &state.poses);
        evaluate(&stack.model, &state, &mut scratch);
        deepest_overlap(stack, &scratch)
    };
    let expected = state.poses.len() - 1;
    let poses = placed.start.as_deref().unwrap_or_default();
    if placed.start.is_some() && poses.len() != expected {
        return Err(RoomFailure::Start { name: name(), found: poses.len(), expected });
    }
    let limit = match (&placed.start, deepest(state)) {
        (Some(_), _) => PRESSED,
        (None, Some((_, depth))) => depth + DEEPENED,
        (None, None) => DEEPENED,
    };
    for (body, numbers) in poses.iter().enumerate() {
        let [x, y, z, w, a, b, c] = *numbers;
        let size = (w * w + a * a + b * b + c * c).sqrt();
        if !(numbers.iter().all(|number| number.is_finite()) && (size - 1.0).abs() < 1e-6) {
            return Err(RoomFailure::Pose { name: name(), body: body + 1 });
        }
        state.poses[body + 1] = Pose {
            position: Vec3::new(x, y, z),
            orientation: Quaternion { w, v: Vec3::new(a, b, c) },
        };
    }
    for Shift { body, by: [x, y, z], turn } in &placed.shifts {
        let bodies = match body {
            Some(body) if *body >= expected => {
                return Err(RoomFailure::Shift { name: name(), body: body + 1, bodies: expected });
            }
            Some(body) => body + 1..body + 2,
            None => 1..expected + 1,
        };
        for pose in &mut state.poses[bodies] {
            // A body turns about its own center of mass.
            let center = if body.is_some() { pose.position } else { Vec3::default() };
            let frame = Frame { at: center + Vec3::new(*x, *y, *z), azimuth: *turn };
            *pose = frame.pose(Pose { position: pose.position - center, ..*pose });
        }
    }
    state.twists.fill(Twist::default());
    state.contact_elements = ContactElements::default();
    if placed.carried_on {
        return Ok(());
    }
    match deepest(state) {
        Some((bodies, depth)) if depth > limit => {
            let [first, second] =
                bodies.map(|body| format!("{} {}", placed.name, stack.parts[body].name));
            Err(RoomFailure::Overlap { first, second, depth })
        }
        Some(_) | None => Ok(()),
    }
}

fn check(room: &Room) -> Result<(), RoomFailure> {
    if room.stacks.is_empty() {
        return Err(RoomFailure::Empty);
    }
    let bodies = room.bodies();
    if bodies > MOST_BODIES {
        return Err(RoomFailure::Large { bodies });
    }
    let settings = |placed: &Placed| (placed.scenario.run.gravity, placed.scenario.run.method);
    let first = &room.stacks[0];
    if let Some(other) = room.stacks.iter().find(|placed| settings(placed) != settings(first)) {
        return Err(RoomFailure::Differ { first: first.name.clone(), second: other.name.clone() });
    }
    let stacks = room.stacks.iter().map(|stack| &stack.name);
    let mut names: Vec<&String> = stacks.chain(room.obstacles.iter().map(|of| &of.name)).collect();
    names.sort_unstable();
    match names.windows(2).find(|two| two[0] == two[1]) {
        Some(two) => Err(RoomFailure::Name { name: two[0].clone() }),
        None => Ok(()),
    }
}

fn obstacle_of(
    obstacle: &Obstacle,
    rank: usize,
    kind: usize,
    stacks: &[StackOf<'_>],
) -> Result<ObstacleOf, RoomFailure> {
    let least = obstacle.half.iter().copied().fold(f64::INFINITY, f64::min);
    if !(least > 0.0 && obstacle.half.iter().all(|half| half.is_finite())) {
        return Err(RoomFailure::Side { name: obstacle.name.clone(), side: 2.0 * least });
    }
    let rounding = ROUNDING.min(0.5 * least);
    let [x, y, z] = obstacle.half.map(|half| half - rounding);
    let [a, b, c] = obstacle.center;
    let pose = Pose {
        position: Vec3::new(a, b, c),
        orientation: Quaternion::turn(Vec3::new(0.0, 0.0, obstacle.azimuth)),
    };
    let surface = On {
        surface: Solid::Block(Block { half: Vec3::new(x, y, z), rounding }),
        offset: Vec3::default(),
        rotation: Rotation3::identity(),
    };
    let body = Body {
        motion: Motion::Prescribed,
        surfaces: vec![surface],
        ..Body::free(&obstacle.name, 1.0, Vec3::new(1.0, 1.0, 1.0), pose)
    };
    let law = obstacle.interface.clone();
    let bodies = stacks.iter().flat_map(|of| of.stack.model.bodies());
    let [step, shortest, depth] = steps_at_fixed(bodies, &law);
    let gravity = stacks[0].stack.model.gravity();
    let mut model = Model::new(vec![body], vec![law], Vec::new(), gravity)?;
    let own = stacks[0].stack.model.substepping();
    model.set_substepping(Substepping {
        substeps: (step / shortest).max(1.0),
        whole_step_depth: vec![depth],
        ..own.clone()
    });
    Ok(ObstacleOf { model, kinds: [kind], rank, step })
}
