//! Result of a room: outcomes of bodies and stacks, contacts between stacks, and forces on obstacles.

use barrelstack::assemble::PartKind;
use barrelstack::outcome::Outcome;
use barrelstack::run::Work;
use barrelstack::watch::Ending;
use barrelstack_dynamics::EnergySummary;
use barrelstack_space::Fate;

/// Index of a stack in [`Room::stacks`](crate::Room::stacks).
pub type StackRef = usize;

/// A body at the end of a run.
#[derive(Clone, Debug)]
pub struct BodyEnd {
    /// Index of the stack of the body.
    pub stack: StackRef,
    /// Name within its stack, such as `B2.1`.
    pub name: String,
    /// Kind of the body.
    pub kind: PartKind,
    /// Level, 1 at the bottom.
    pub level: u32,
    /// Volume (m³) of the wine in a barrel.
    pub wine: f64,
    /// Outcome of the body; its displacements are along the axes of the stack.
    pub fate: Fate,
    /// Pose at rest before the shaking, in the room: position (m) and quaternion `w`, `x`, `y`, `z`.
    pub from: [f64; 7],
    /// Pose at the start of the run, in the room: equal to `from` if the stack starts as built.
    pub start: [f64; 7],
    /// Pose at the end, in the room.
    pub to: [f64; 7],
    /// Pose at the end, in the frame of its stack. Another run may start from this pose.
    pub own: [f64; 7],
}

/// The first contact of a stack with a body of another stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Time (s).
    pub time: f64,
    /// The body of the stack, by its index in [`RoomRun::bodies`].
    pub body: usize,
    /// The body of the other stack, by its index in [`RoomRun::bodies`].
    pub by: usize,
    /// Impulse (N·s, sum of magnitudes) that all bodies of other stacks exert on the stack until its first loss of
    /// a seat, or over the whole run if it keeps its seats.
    pub impulse: f64,
}

/// A stack at the end of a run.
#[derive(Clone, Debug)]
pub struct StackEnd {
    /// Name of the stack.
    pub name: String,
    /// Outcome, defined as for a single stack.
    pub outcome: Outcome,
    /// Time (s) of the first loss of a seat, and index of the body in [`RoomRun::bodies`].
    pub lost_seat: Option<(f64, usize)>,
    /// Time (s) at which the first barrel counted as fallen.
    pub first_fall: Option<f64>,
    /// First contact with a body of another stack.
    pub touched: Option<Touch>,
    /// Time (s) of the first contact with an obstacle, and index of the obstacle in [`RoomRun::obstacles`].
    pub touched_obstacle: Option<(f64, usize)>,
    /// `true` if the stack lost a seat after a body of another stack had touched it.
    pub knocked_over: bool,
    /// Indices of the bodies of the stack in [`RoomRun::bodies`].
    pub bodies: std::ops::Range<usize>,
    /// Reason why the run of the stack ended.
    pub ending: Ending,
    /// Time (s) at which the run of the stack ended: when its bodies came to rest, or at the end of the run of the
    /// room.
    pub end_time: f64,
    /// Number of bodies of the stack that still move when its run ends; barrels that roll away freely do not delay
    /// the end.
    pub moving: usize,
}

impl StackEnd {
    /// `true` if the stack had lost a seat before the run started.
    pub fn was_down(&self) -> bool {
        self.lost_seat.is_some_and(|(time, _)| time <= 0.0)
    }

    /// `true` if the stack was at rest when its run ended.
    pub fn rests(&self) -> bool {
        self.ending == Ending::Rest && self.moving == 0
    }
}

/// The contact between the bodies of two stacks during a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The two stacks, the lower index first.
    pub stacks: [StackRef; 2],
    /// Time (s) of the first contact.
    pub time: f64,
    /// The bodies of the first contact, in the order of the stacks, by their indices in [`RoomRun::bodies`].
    pub bodies: [usize; 2],
    /// Impulse (N·s) between the two stacks over the whole run, as the sum of magnitudes.
    pub impulse: f64,
    /// Largest magnitude (N) of the force between the two stacks.
    pub peak: f64,
}

/// Forces on an obstacle.
#[derive(Clone, Debug, Default)]
pub struct ObstacleEnd {
    /// Name of the obstacle.
    pub name: String,
    /// Time (s) of the first contact, and index of the body in [`RoomRun::bodies`].
    pub first: Option<(f64, usize)>,
    /// Largest magnitude (N) of the total force on the obstacle.
    pub peak: f64,
    /// Components (N·s), along the axes of the room, of the impulse on the obstacle over the whole run.
    pub impulse: [f64; 3],
    /// Times (s) and total forces (N) along the axes of the room, at every accepted step with a contact. The steps just
    /// before and after a contact, at which the force is zero, are included.
    pub history: Vec<(f64, [f64; 3])>,
}

/// Frames of one stack, without the ground.
#[derive(Clone, Debug, Default)]
pub struct RoomFrames {
    /// Times (s) of the frames. A stack that has come to rest has no further frames, because its bodies stay where
    /// they are.
    pub times: Vec<f64>,
    /// For every frame and body of the stack, position (m) and quaternion in the room, relative to the ground.
    pub poses: Vec<Vec<[f64; 7]>>,
    /// For every frame and body of the stack, speed (m/s) relative to the ground.
    pub speeds: Vec<Vec<f64>>,
}

/// Result of a room.
#[derive(Clone, Debug)]
pub struct RoomRun {
    /// All bodies except the ground, stack by stack.
    pub bodies: Vec<BodyEnd>,
    /// The stacks, in the order of [`Room::stacks`](crate::Room::stacks).
    pub stacks: Vec<StackEnd>,
    /// All pairs of stacks that have touched each other, in the order of their first contacts.
    pub meetings: Vec<Meeting>,
    /// The obstacles, in the order of [`Room::obstacles`](crate::Room::obstacles).
    pub obstacles: Vec<ObstacleEnd>,
    /// Frames of every stack; empty unless requested.
    pub frames: Vec<RoomFrames>,
    /// Energy balance, summed over all islands; `None` if the motion of a body has become infinite or NaN.
    pub energy: Option<EnergySummary>,
    /// Numbers of time steps and force evaluations, summed over all islands.
    pub work: Work,
    /// Number of times that islands were merged.
    pub merges: usize,
    /// Time (s) at which the run of the last stack ended.
    pub end_time: f64,
    /// `true` if the observer stopped the run.
    pub interrupted: bool,
    /// Warnings, one sentence each, preceded by the name of the stack that the warning concerns; `None` instead of the
    /// name if a warning concerns the whole room.
    pub warnings: Vec<(Option<String>, String)>,
    /// For a sequence, the runs of its shocks, each with its own clock; empty for a single shock.
    pub shocks: Vec<RoomRun>,
}
