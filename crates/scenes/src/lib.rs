//! Scenes, ground motions and closed-form solutions shared by the dynamics tests and the validation program.

pub mod drive;
pub mod order;
pub mod scene;
pub mod spatial;
pub mod theory;
pub mod tumble;

/// Standard gravity (m/s²).
pub const GRAVITY: f64 = 9.806_65;
