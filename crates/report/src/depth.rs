//! A scene in three dimensions, which a reader can rotate on a page.

use serde_json::{Value, json};

use crate::{
    Event, Moment, Role,
    pack::{self, POSE_QUANTUM},
    player_data::events,
};

/// Quantum (m) to which the points of application of forces are rounded: about 2 mm, which is too little to be visible.
const POINT_QUANTUM: f64 = 1.0 / 512.0;

/// Factor by which the quantum to which forces are rounded exceeds the power of two that [`pack::quantum_for`] returns.
/// This power of two is at most 2⁻¹⁶ of the largest component of the forces.
const FORCE_STEPS: f64 = 64.0;

/// A point or vector `[x, y, z]` (m): x across the barrels, y along them, z up; right-handed.
pub type Point3 = [f64; 3];

/// A pose `[x, y, z, w, a, b, c]` of a body in the world frame: position (m), and a unit quaternion
/// with its scalar `w` first.
pub type Pose3 = [f64; 7];

/// A solid in the frame of its body.
#[derive(Clone, Debug, PartialEq)]
pub enum Volume {
    /// A solid of revolution.
    Turned {
        /// Origin of the profile (m).
        at: Point3,
        /// Direction of the axis, a unit vector.
        axis: Point3,
        /// Points from one end to the other, each as the position along the axis and the radius
        /// (m). The ends are closed by flat heads.
        profile: Vec<[f64; 2]>,
    },
    /// A round tube.
    Tube {
        /// Ends of the axis (m).
        ends: [Point3; 2],
        /// Radius (m).
        radius: f64,
    },
    /// A cuboid.
    Block {
        /// Center (m).
        at: Point3,
        /// Vectors (m) from the center of the cuboid to the centers of three adjacent faces.
        sides: [Point3; 3],
    },
    /// A ball.
    Ball {
        /// Center (m).
        at: Point3,
        /// Radius (m).
        radius: f64,
    },
}

impl Volume {
    /// Returns a cuboid with edges along the axes of its body, from its center and half of each edge
    /// length (m).
    pub fn upright(at: Point3, [x, y, z]: Point3) -> Self {
        Self::Block { at, sides: [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]] }
    }

    fn value(&self) -> Value {
        let short = |list: &[f64]| list.iter().copied().map(tenths).collect::<Vec<_>>();
        match self {
            Self::Turned { at, axis, profile } => json!({
                "turned": short(profile.as_flattened()), "at": short(at), "axis": axis.map(|v| (v * 1e6).round() / 1e6),
            }),
            Self::Tube { ends, radius } => {
                json!({ "tube": short(ends.as_flattened()), "radius": tenths(*radius) })
            }
            Self::Block { at, sides } => {
                json!({ "block": short(at), "sides": short(sides.as_flattened()) })
            }
            Self::Ball { at, radius } => json!({ "ball": short(at), "radius": tenths(*radius) }),
        }
    }
}

/// Rounds a length (m) to a tenth of a millimeter, which is also the precision of outlines.
fn tenths(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// A body in three dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthBody {
    /// Name.
    pub name: String,
    /// Role.
    pub role: Role,
    /// Solids of the body; empty for a body that is not drawn.
    pub volumes: Vec<Volume>,
    /// Offsets (m), in the world frame, from the position of the body to its drawn copies: a barrel of a planar model
    /// represents several barrels that lie one behind the other and move alike.
    pub rows: Vec<Point3>,
}

/// Poses of the bodies of a scene in three dimensions.
#[derive(Clone, Debug, PartialEq)]
pub enum DepthPoses {
    /// Poses of the planar scene, placed in the plane of x and z. The bodies have the same indices as in the planar
    /// scene.
    Across,
    /// Poses of the planar scene, placed in the plane of y and z. The bodies have the same indices as in the planar
    /// scene.
    Along,
    /// For each frame of the planar scene, the pose of each body.
    Free(Vec<Vec<Pose3>>),
}

/// A band between points of two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTie {
    /// Indices of the bodies in [`Depth::bodies`].
    pub bodies: [usize; 2],
    /// End points of the band, each in the frame of its body (m).
    pub points: [Point3; 2],
    /// Time (s) at which the band breaks, after which it is not drawn; `None` if it does not break.
    pub torn_at: Option<f64>,
}

/// Bodies in three dimensions, at the times of the frames of a planar scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Depth {
    /// The bodies.
    pub bodies: Vec<DepthBody>,
    /// Poses of the bodies.
    pub poses: DepthPoses,
    /// Bands between bodies.
    pub ties: Vec<DepthTie>,
    /// Events, in order of time.
    pub events: Vec<Event>,
    /// The instant that the player shows when it opens, with the index of its body in [`Self::bodies`]; `None` if no
    /// instant is marked.
    pub moment: Option<Moment>,
    /// With [`DepthPoses::Free`]: for each [`Trace`](crate::Trace) of the planar scene, the index of the body whose
    /// center it follows.
    pub paths: Vec<usize>,
    /// With [`DepthPoses::Free`]: for each frame, the contact forces, each as its point (m) and its components (N). A
    /// force of zero is not drawn. The packed data are smallest if a contact has the same index in the list of every
    /// frame.
    pub forces: Vec<Vec<[Point3; 2]>>,
    /// For each pane of the player, the indices of the axes that point right and up in it; the pane shows the
    /// components of forces along these axes.
    pub panes: Vec<[usize; 2]>,
}

impl Depth {
    /// Returns the data for the page; `count` is the number of frames. If several bodies have the
    /// same list of solids, the list is written only once.
    pub(crate) fn value(&self, count: usize) -> Value {
        let mut shapes: Vec<Value> = Vec::new();
        let mut shape = |body: &DepthBody| {
            let own: Value = body.volumes.iter().map(Volume::value).collect();
            shapes.iter().position(|known| *known == own).unwrap_or_else(|| {
                shapes.push(own);
                shapes.len() - 1
            })
        };
        let bodies: Vec<Value> = self
            .bodies
            .iter()
            .map(|body| {
                let rows: Vec<Point3> = body.rows.iter().map(|row| row.map(tenths)).collect();
                json!({ "name": body.name, "role": body.role.class(), "shape": shape(body), "rows": rows })
            })
            .collect();
        let ties: Vec<Value> = self
            .ties
            .iter()
            .map(|tie| json!({ "bodies": tie.bodies, "points": tie.points, "torn": tie.torn_at }))
            .collect();
        let moment = self
            .moment
            .as_ref()
            .filter(|moment| moment.time.is_finite() && moment.body < self.bodies.len())
            .map(|moment| json!({ "t": moment.time, "body": moment.body, "text": moment.text }));
        let (plane, poses) = match &self.poses {
            DepthPoses::Across => (json!("across"), Value::Null),
            DepthPoses::Along => (json!("along"), Value::Null),
            DepthPoses::Free(frames) => (Value::Null, self.packed(frames, count)),
        };
        json!({
            "shapes": shapes,
            "bodies": bodies,
            "ties": ties,
            "events": events(&self.events, self.bodies.len()),
            "moment": moment,
            "plane": plane,
            "poses": poses,
            "paths": self.paths,
            "forces": self.packed_forces(count),
            "axes": self.panes,
        })
    }

    /// Packs forces as six lists of channels: for the three coordinates of the point and the three components of the
    /// force. Channel `i` of each list holds, for every frame, the force with index `i`. It has a gap in a frame where
    /// this force is missing or zero.
    fn packed_forces(&self, count: usize) -> Value {
        let frames = &self.forces[..self.forces.len().min(count)];
        let slots = frames.iter().map(Vec::len).max().unwrap_or(0);
        if slots == 0 {
            return Value::Null;
        }
        let pick = |kind: usize, axis: usize| -> Vec<Vec<f64>> {
            let at = |frame: usize, slot: usize| {
                let force = frames.get(frame).and_then(|list| list.get(slot));
                force
                    .filter(|[_, force]| *force != [0.0; 3])
                    .map_or(f64::NAN, |force| force[kind][axis])
            };
            (0..slots).map(|slot| (0..count).map(|frame| at(frame, slot)).collect()).collect()
        };
        let all = frames.iter().flatten().flat_map(|[_, force]| force);
        let peak = all.map(|value| value.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
        let quantum = pack::quantum_for(&[0.0, peak]) * FORCE_STEPS;
        let packed = |kind: usize, quantum: f64| {
            [0, 1, 2].map(|axis| pack::channels(&pick(kind, axis), count, quantum))
        };
        json!({ "at": packed(0, POINT_QUANTUM), "force": packed(1, quantum) })
    }

    /// Packs poses as seven channels per body; the signs of the quaternions are chosen so that the
    /// components change continuously.
    fn packed(&self, frames: &[Vec<Pose3>], count: usize) -> Value {
        let mut channels = vec![Vec::with_capacity(count); 7 * self.bodies.len()];
        for (body, own) in channels.chunks_mut(7).enumerate() {
            let mut last = [1.0, 0.0, 0.0, 0.0];
            for frame in 0..count {
                let mut pose = frames
                    .get(frame)
                    .and_then(|list| list.get(body))
                    .copied()
                    .unwrap_or([f64::NAN; 7]);
                let dot: f64 = pose[3..].iter().zip(last).map(|(a, b)| a * b).sum();
                let sign = if dot < 0.0 { -1.0 } else { 1.0 };
                for (value, last) in pose[3..].iter_mut().zip(&mut last) {
                    *value *= sign;
                    *last = if value.is_finite() { *value } else { *last };
                }
                for (channel, value) in own.iter_mut().zip(pose) {
                    channel.push(value);
                }
            }
        }
        pack::channels(&channels, count, POSE_QUANTUM)
    }
}
