//! Three-dimensional bodies as time series for ParaView.

use std::fmt::Write as _;

use super::poly_data::PolyData;
use super::{closed_index, index_entry, opened_index};
use crate::film::sampled_times;
use crate::{Attachment, Role, csv_field};

/// The surface of a three-dimensional body, in the frame of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidBody {
    /// Name.
    pub name: String,
    /// Role.
    pub role: Role,
    /// Level, 1 at the bottom; 0 for a body outside all levels.
    pub level: u32,
    /// Points (m).
    pub points: Vec<[f64; 3]>,
    /// Corner indices of the triangles, counterclockwise viewed from outside.
    pub triangles: Vec<[usize; 3]>,
}

/// A strap or tie between two bodies, drawn as a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidTie {
    /// Name.
    pub name: String,
    /// Indices of the bodies.
    pub bodies: [usize; 2],
    /// Ends (m), each in the frame of its body.
    pub points: [[f64; 3]; 2],
    /// Time (s) at which the tie breaks; `None` if it does not break. A broken tie is not drawn.
    pub torn_at: Option<f64>,
}

/// Three-dimensional bodies and their motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solids {
    /// The bodies.
    pub bodies: Vec<SolidBody>,
    /// The straps and ties. In the files, they are numbered after the bodies.
    pub ties: Vec<SolidTie>,
    /// Times of the frames (s).
    pub times: Vec<f64>,
    /// For each time and body, position (m) and unit quaternion `w`, `x`, `y`, `z`.
    pub poses: Vec<Vec<[f64; 7]>>,
    /// For each time and body, the velocity (m/s) of the origin of the body, then the angular velocity (rad/s), both in
    /// the world frame.
    pub twists: Vec<Vec<[f64; 6]>>,
}

/// Creates the ParaView files of three-dimensional bodies and passes them to `put`, one at a time.
///
/// The files are to be written into a separate folder. `stack.pvd` is the file to open. There is a `bodies-*.vtp` for
/// each time, and `bodies.csv` lists the names of the bodies and ties by number.
///
/// Times are `1/rate` (s) apart, as for [`Film`](crate::Film); z is up, and lengths are in m, rounded
/// as in [`paraview`](super::paraview).
///
/// Surfaces are triangles; straps and ties are lines. Cells carry `body` (the index of the body or
/// tie), `role` (as in [`paraview`](super::paraview)), `level` (0 for a tie) and `displacement` (m):
/// the displacement vector of the origin of the body since the first frame (0 for a tie). Points
/// carry `velocity` (m/s).
///
/// # Errors
/// The first error of `put`.
pub fn paraview_of_solids<E>(
    solids: &Solids,
    rate: f64,
    put: &mut dyn FnMut(Attachment) -> Result<(), E>,
) -> Result<(), E> {
    let frames = sampled_times(&solids.times, rate);
    let digits = frames.len().to_string().len().max(4);
    let mut index = opened_index();
    for (at, &frame) in frames.iter().enumerate() {
        let name = format!("bodies-{at:0digits$}.vtp");
        index_entry(&mut index, solids.times[frame], 0, &name);
        put(Attachment { name, bytes: file(solids, frame) })?;
    }
    let mut names = String::from("body,name,role,level\n");
    for (at, body) in solids.bodies.iter().enumerate() {
        let name = csv_field(&body.name);
        // Writing to a String cannot fail, here and below.
        let _ = writeln!(names, "{at},{name},{},{}", body.role.class(), body.level);
    }
    for (at, tie) in solids.ties.iter().enumerate() {
        let (at, name) = (solids.bodies.len() + at, csv_field(&tie.name));
        let _ = writeln!(names, "{at},{name},{},0", Role::Device.class());
    }
    put(Attachment { name: "bodies.csv".into(), bytes: names.into_bytes() })?;
    put(Attachment { name: "stack.pvd".into(), bytes: closed_index(index).into_bytes() })
}

/// Returns the content of the `.vtp` file of a frame, with the bodies and the ties.
fn file(solids: &Solids, frame: usize) -> Vec<u8> {
    let Solids { bodies, ties, poses, twists, .. } = solids;
    let (mut points, mut velocities) = (Vec::new(), Vec::new());
    let (mut ends, mut corners, mut of_body) = (Vec::new(), Vec::new(), Vec::new());
    // A body whose numbers are not finite is left out, with its ties.
    let lost = |at: usize| {
        poses[frame][at].iter().chain(&twists[frame][at]).any(|value| !value.is_finite())
    };
    let mut add = |at: usize, point: [f64; 3]| {
        let (now, twist) = (poses[frame][at], twists[frame][at]);
        let here = placed(now, point);
        points.push(here);
        velocities.push(velocity(now, twist, here));
        points.len() - 1
    };
    // In VTK the cells of lines precede those of polygons.
    let whole_tie = |tie: &SolidTie| {
        tie.torn_at.is_none_or(|torn| solids.times[frame] < torn)
            && !tie.bodies.iter().any(|at| lost(*at))
    };
    for (at, tie) in ties.iter().enumerate().filter(|(_, tie)| whole_tie(tie)) {
        ends.extend([0, 1].map(|end| add(tie.bodies[end], tie.points[end])));
        of_body.push(bodies.len() + at);
    }
    let lines = of_body.len();
    for (at, body) in bodies.iter().enumerate().filter(|(at, _)| !lost(*at)) {
        let placed: Vec<usize> = body.points.iter().map(|point| add(at, *point)).collect();
        corners.extend(body.triangles.iter().flatten().map(|corner| placed[*corner]));
        of_body.extend(body.triangles.iter().map(|_| at));
    }
    let role = |at: usize| bodies.get(at).map_or(Role::Device, |body| body.role) as usize;
    let level = |at: usize| bodies.get(at).map_or(0, |body| body.level) as usize;
    let moved = |at: usize| {
        let place = |frame: usize| poses[frame].get(at);
        let both = place(frame).zip(place(0));
        both.map_or([0.0; 3], |(now, start)| [0, 1, 2].map(|axis| now[axis] - start[axis]))
    };
    let triangles = of_body.len() - lines;
    let mut file = PolyData::new(points.len(), [0, lines, triangles]);
    file.open("PointData Vectors=\"velocity\"");
    file.vectors("velocity", velocities.into_iter());
    file.close("PointData");
    file.open("CellData Scalars=\"body\"");
    file.whole("body", of_body.iter().copied());
    file.whole("role", of_body.iter().map(|at| role(*at)));
    file.whole("level", of_body.iter().map(|at| level(*at)));
    file.lengths("displacement", of_body.iter().map(|at| moved(*at)));
    file.close("CellData");
    file.points(points.into_iter());
    file.cells("Lines", ends.into_iter(), std::iter::repeat_n(2, lines));
    file.cells("Polys", corners.into_iter(), std::iter::repeat_n(3, triangles));
    file.finish()
}

/// Converts a point `r` from the frame of a body to the world frame.
///
/// For a body at `p` with the unit quaternion `w, v`, the result is `p + r + 2 w (v × r) + 2 v × (v × r)`.
fn placed([x, y, z, w, a, b, c]: [f64; 7], point: [f64; 3]) -> [f64; 3] {
    let v = [a, b, c];
    let once = cross(v, point);
    let twice = cross(v, once);
    let along = |axis: usize| point[axis] + 2.0 * (w * once[axis] + twice[axis]);
    [x + along(0), y + along(1), z + along(2)]
}

/// Returns the velocity (m/s) of a point of a body; `place` is the position of the point in the world frame.
fn velocity(pose: [f64; 7], [u, v, w, a, b, c]: [f64; 6], place: [f64; 3]) -> [f64; 3] {
    let arm = [place[0] - pose[0], place[1] - pose[1], place[2] - pose[2]];
    let turning = cross([a, b, c], arm);
    [u + turning[0], v + turning[1], w + turning[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
