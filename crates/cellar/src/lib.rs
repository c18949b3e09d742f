//! Rooms: many stacks, walls and columns on one ground, and the collapses that spread from stack to stack.
//!
//! ```text
//! Room { stacks, obstacles, ground } ─ run ─▶ islands: one for each stack, advanced in parallel
//!                                                │ bodies of two islands could meet
//!                                                ▼
//!                                             one island ─▶ RoomRun { bodies, stacks, obstacles, meetings }
//! ```
//!
//! Coordinates of a room: `x` and `y` horizontal, `z` up from the floor. Poses in results are relative to the ground,
//! as for an observer who stands in the room.

// Results are bit-identical on every machine, so the transcendental functions of the platform are disallowed
// (`clippy.toml`).
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod aftershocks;
mod answer;
mod collect;
pub mod comparison;
mod contact_kinds;
pub mod geometry;
mod history;
mod island;
pub mod kept;
mod merge;
mod nearby;
pub mod plan;
pub mod report;
pub mod result;
pub mod room;
mod run;
pub mod sample;
pub mod scenario;
pub mod sequence;
pub mod start;
pub mod summary;
pub mod words;
mod world;

pub use answer::{Answer, answer, answer_with, run_part};
pub use plan::Plan;
pub use result::{BodyEnd, Meeting, ObstacleEnd, RoomFrames, RoomRun, StackEnd, StackRef, Touch};
pub use room::{MOST_BODIES, Obstacle, Placed, Room, RoomFailure, Settings, Shift};
pub use run::{Advance, run};
pub use sample::{CellarFailure, Prepared};
pub use scenario::Cellar;

/// The example of the README, which is compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
