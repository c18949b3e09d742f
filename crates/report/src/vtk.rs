//! Scenes as time series for ParaView: VTK `PolyData` in XML, with compressed arrays.

mod poly_data;
mod solids;

use std::fmt::Write as _;

use self::poly_data::PolyData;
pub use solids::{SolidBody, SolidTie, Solids, paraview_of_solids};

use crate::{
    Attachment, Polyline, Role, Scene, csv_field,
    film::sampled,
    scene::{Point, Pose2, place, window},
};

/// Returns the files of a scene for ParaView, to be written into a separate folder.
///
/// `stack.pvd` is the file to open. For each time, there is one file `bodies-*.vtp` and one file `forces-*.vtp`. The
/// file `bodies.csv` lists the index, the name and the role of each body.
///
/// Times are `1/rate` (s) apart, as for [`Film`](crate::Film). The plane of the scene is y = 0, z
/// is up, and lengths are in m, rounded to multiples of [`POSE_QUANTUM`](crate::POSE_QUANTUM).
///
/// - Bodies: closed outlines are polygons; open outlines and marks are lines. Cells carry `body`
///   (the index in the scene), `role` (0 ground, 1 barrel, 2 rack, 3 block, 4 device) and
///   `displacement` (m): the displacement vector of the origin of the body since the first frame.
///   Bodies without a finite pose are left out.
/// - Forces: a vertex at each point of application, with `force` (N) as a vector.
pub fn paraview(scene: &Scene, rate: f64) -> Vec<Attachment> {
    let frames = sampled(scene, rate);
    let digits = frames.len().to_string().len().max(4);
    let mut index = opened_index();
    // The ground is hundreds of meters long, and a viewer fits its first picture to everything in the
    // file, so only the part of the ground near the stack is written.
    let view = window(scene, &frames);
    let sight = [view.lower[0] - view.width(), view.upper[0] + view.width()];
    let mut files = Vec::new();
    for (at, &frame) in frames.iter().enumerate() {
        let time = scene.frames.times[frame];
        let parts = [("bodies", bodies(scene, frame, sight)), ("forces", forces(scene, frame))];
        for (part, (name, bytes)) in parts.into_iter().enumerate() {
            let name = format!("{name}-{at:0digits$}.vtp");
            index_entry(&mut index, time, part, &name);
            files.push(Attachment { name, bytes });
        }
    }
    let mut names = String::from("body,name,role\n");
    for (at, body) in scene.bodies.iter().enumerate() {
        let _ = writeln!(names, "{at},{},{}", csv_field(&body.name), body.role.class());
    }
    files.push(Attachment { name: "bodies.csv".into(), bytes: names.into_bytes() });
    files.push(Attachment { name: "stack.pvd".into(), bytes: closed_index(index).into_bytes() });
    files
}

/// Returns the start of the index file.
fn opened_index() -> String {
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" \
     byte_order=\"LittleEndian\">\n<Collection>\n"
        .to_owned()
}

/// Adds the file of one instant (s) to the index; if an instant has several parts, each part has its
/// own file.
fn index_entry(index: &mut String, time: f64, part: usize, file: &str) {
    // Writing to a String cannot fail, here and below.
    let _ = writeln!(
        index,
        "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file}\"/>"
    );
}

/// Appends the closing tags to the index file.
fn closed_index(index: String) -> String {
    index + "</Collection>\n</VTKFile>\n"
}

/// Points and cells, with their data.
#[derive(Default)]
struct Mesh {
    points: Vec<Point>,
    lines: Vec<Cell>,
    polygons: Vec<Cell>,
}

/// A polyline or polygon of a body.
struct Cell {
    points: Vec<usize>,
    body: usize,
    role: Role,
    displacement: Point,
}

fn bodies(scene: &Scene, frame: usize, sight: [f64; 2]) -> Vec<u8> {
    let mut mesh = Mesh::default();
    for (at, body) in scene.bodies.iter().enumerate() {
        let Some(pose) = scene.frames.pose(frame, at) else { continue };
        let start = scene.frames.pose(0, at).unwrap_or(pose);
        let moved = [pose[0] - start[0], pose[1] - start[1]];
        for line in body.outlines.iter().chain(&body.marks) {
            if body.role == Role::Ground && !line.closed {
                mesh.add(&shortened(line, sight), (at, body.role), pose, moved);
            } else {
                mesh.add(line, (at, body.role), pose, moved);
            }
        }
    }
    mesh.write()
}

/// Returns the part of a line between `from` and `to` (m) along x.
fn shortened(line: &Polyline, [from, to]: [f64; 2]) -> Polyline {
    let mut points: Vec<Point> = Vec::new();
    for pair in line.points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if a[0].max(b[0]) < from || a[0].min(b[0]) > to {
            continue;
        }
        for end in [a, b] {
            let x = end[0].clamp(from, to);
            let slope = if a[0] == b[0] { 0.0 } else { (b[1] - a[1]) / (b[0] - a[0]) };
            let point = if x == end[0] { end } else { [x, a[1] + slope * (x - a[0])] };
            if points.last() != Some(&point) {
                points.push(point);
            }
        }
    }
    Polyline::open(points)
}

impl Mesh {
    fn add(
        &mut self,
        line: &Polyline,
        (body, role): (usize, Role),
        pose: Pose2,
        displacement: Point,
    ) {
        let from = self.points.len();
        let finite = line.points.iter().filter(|p| p.iter().all(|v| v.is_finite()));
        self.points.extend(finite.map(|point| place(pose, *point)));
        let cell = Cell { points: (from..self.points.len()).collect(), body, role, displacement };
        let cells = if line.closed { &mut self.polygons } else { &mut self.lines };
        if cell.points.len() > 1 {
            cells.push(cell);
        }
    }

    fn write(&self) -> Vec<u8> {
        let mut file = PolyData::new(self.points.len(), [0, self.lines.len(), self.polygons.len()]);
        let cells = || self.lines.iter().chain(&self.polygons);
        file.open("CellData Scalars=\"body\"");
        file.whole("body", cells().map(|cell| cell.body));
        file.whole("role", cells().map(|cell| cell.role as usize));
        file.lengths("displacement", cells().map(|cell| in_space(&cell.displacement)));
        file.close("CellData");
        file.points(self.points.iter().map(in_space));
        for (name, cells) in [("Lines", &self.lines), ("Polys", &self.polygons)] {
            let corners = cells.iter().flat_map(|cell| cell.points.iter().copied());
            file.cells(name, corners, cells.iter().map(|cell| cell.points.len()));
        }
        file.finish()
    }
}

/// Converts a point in the plane of the scene to a three-dimensional point.
fn in_space([x, z]: &Point) -> [f64; 3] {
    [*x, 0.0, *z]
}

fn forces(scene: &Scene, frame: usize) -> Vec<u8> {
    let list = scene.frames.forces.get(frame).map_or(&[][..], Vec::as_slice);
    let finite = |f: &&crate::ContactForce| [f.x, f.z, f.fx, f.fz].iter().all(|v| v.is_finite());
    let list: Vec<_> = list.iter().filter(finite).collect();
    let count = list.len();
    let mut file = PolyData::new(count, [count, 0, 0]);
    file.open("PointData Vectors=\"force\"");
    file.vectors("force", list.iter().map(|f| [f.fx, 0.0, f.fz]));
    file.close("PointData");
    file.points(list.iter().map(|f| [f.x, 0.0, f.z]));
    file.cells("Verts", 0..count, std::iter::repeat_n(1, count));
    file.finish()
}
