//! Sampled barrel positions of a case: paths of the top barrels, and final positions of all barrels.

use barrelstack_dynamics::{BodyId, Planar, Pose, State};

use crate::assemble::{Assembly, PartKind};

/// Samples per second: enough to show how a barrel sways and falls.
pub const RATE: f64 = 16.0;

/// Barrel positions relative to the ground, sampled at multiples of `1/RATE` (s) for display.
///
/// Each sample is taken at the first step that reaches its time, and is stored in single precision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trail {
    /// IDs of the barrels of the top level.
    pub top: Vec<BodyId>,
    /// Path of each barrel of the top level, in the order of `top`: `x` and `z` (m) relative to the ground.
    pub paths: Vec<Vec<[f32; 2]>>,
    /// IDs of all barrels.
    pub barrels: Vec<BodyId>,
    /// Last position of each barrel, in the order of `barrels`: `x` and `z` (m) relative to the ground, and the angle
    /// (rad).
    pub last: Vec<[f32; 3]>,
}

impl Trail {
    pub(super) fn new(assembly: &Assembly) -> Self {
        let barrels: Vec<BodyId> = assembly.of_kind(PartKind::Barrel).collect();
        let of_top = |body: &BodyId| assembly.parts[*body].level == Some(assembly.levels);
        let top: Vec<BodyId> = barrels.iter().copied().filter(of_top).collect();
        Self {
            paths: vec![Vec::new(); top.len()],
            last: vec![[0.0; 3]; barrels.len()],
            top,
            barrels,
        }
    }

    /// Returns the time (s) at which the next sample is due; infinity if there are no barrels.
    pub(super) fn due(&self) -> f64 {
        self.paths.first().map_or(f64::INFINITY, |path| path.len() as f64 / RATE)
    }

    /// Records the positions of all barrels, and extends the paths of the top barrels if a sample is due.
    pub(super) fn see(&mut self, time: f64, pose: impl Fn(BodyId) -> Pose<Planar>) {
        let ground = pose(Assembly::GROUND).position;
        let due = self.due() <= time;
        let place = |body: BodyId| {
            let Pose { position, orientation } = pose(body);
            [position.x - ground.x, position.z - ground.z, orientation].map(single)
        };
        for (body, last) in self.barrels.iter().zip(&mut self.last) {
            *last = place(*body);
        }
        for (body, path) in self.top.iter().zip(&mut self.paths).filter(|_| due) {
            let [x, z, _] = place(*body);
            path.push([x, z]);
        }
    }

    /// Records the positions in `state`, as [`Self::see`] does.
    pub(super) fn see_state(&mut self, state: &State<Planar>) {
        self.see(state.time, |body| state.poses[body]);
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a display needs no more digits")]
fn single(value: f64) -> f32 {
    value as f32
}
