//! Where the barrels of a case were, now and then: the ways of the top ones, and where all came to lie.

use barrelstack_dynamics::{BodyId, Planar, Pose, State};

use crate::assemble::{Assembly, PartKind};

/// Places kept per second: enough to see a barrel sway and fall.
pub const RATE: f64 = 16.0;

/// Where barrels were, relative to the ground, at whole multiples of `1/RATE` (s), each seen at the step that
/// reached it; in single precision, since it is looked at and not computed with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trail {
    /// The barrels of the top level.
    pub top: Vec<BodyId>,
    /// For each of them, `x` and `z` (m) relative to the ground.
    pub ways: Vec<Vec<[f32; 2]>>,
    /// All barrels.
    pub barrels: Vec<BodyId>,
    /// For each of them, `x`, `z` (m) relative to the ground and the angle (rad), where it was seen last.
    pub last: Vec<[f32; 3]>,
}

impl Trail {
    pub(super) fn new(assembly: &Assembly) -> Self {
        let barrels: Vec<BodyId> = assembly.of_kind(PartKind::Barrel).collect();
        let of_top = |body: &BodyId| assembly.parts[*body].level == Some(assembly.levels);
        let top: Vec<BodyId> = barrels.iter().copied().filter(of_top).collect();
        Self {
            ways: vec![Vec::new(); top.len()],
            last: vec![[0.0; 3]; barrels.len()],
            top,
            barrels,
        }
    }

    /// When (s) the next place is due; never where no barrel is followed.
    pub(super) fn due(&self) -> f64 {
        self.ways.first().map_or(f64::INFINITY, |way| way.len() as f64 / RATE)
    }

    /// Sees all barrels by their poses, on their way where that is due.
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
        for (body, way) in self.top.iter().zip(&mut self.ways).filter(|_| due) {
            let [x, z, _] = place(*body);
            way.push([x, z]);
        }
    }

    /// Sees a state of a run that is alone.
    pub(super) fn see_state(&mut self, state: &State<Planar>) {
        self.see(state.time, |body| state.poses[body]);
    }
}

#[expect(clippy::cast_possible_truncation, reason = "what is looked at needs no more digits")]
fn single(value: f64) -> f32 {
    value as f32
}
