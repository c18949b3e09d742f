//! Scenes as time series for ParaView: VTK `PolyData` in XML, as text.

mod solids;

use std::fmt::Write as _;

pub use solids::{SolidBody, SolidTie, Solids, paraview_of_solids};

use crate::{
    Attachment, Polyline, Role, Scene, csv_field,
    film::sampled,
    number,
    scene::{Point, Pose2, place, window},
};

/// Returns the files of a scene for ParaView, to be written into a separate folder.
///
/// `stack.pvd` is the file to open. There are a `bodies-*.vtp` and a `forces-*.vtp` for each time,
/// and `bodies.csv` lists the names of the bodies by number.
///
/// Times are `1/rate` (s) apart, as for [`Film`](crate::Film). The plane of the scene is y = 0, z
/// is up, and lengths are in m.
///
/// - Bodies: closed outlines are polygons, open outlines and marks are lines. Cells carry `body`
///   (the index in the scene) and `role` (0 ground, 1 barrel, 2 rack, 3 block, 4 device); points
///   carry `displacement` (m) from the first frame. Bodies without a finite pose are left out.
/// - Forces: a vertex at each point of contact, with `force` (N) as a vector.
pub fn paraview(scene: &Scene, rate: f64) -> Vec<Attachment> {
    let frames = sampled(scene, rate);
    let digits = frames.len().to_string().len().max(4);
    let mut index = opened_index();
    // The ground is hundreds of meters long, and a viewer fits its first picture to the whole
    // scene.
    let view = window(scene, &frames);
    let sight = [view.lower[0] - view.width(), view.upper[0] + view.width()];
    let mut files = Vec::new();
    for (at, &frame) in frames.iter().enumerate() {
        let time = scene.frames.times[frame];
        let parts = [("bodies", bodies(scene, frame, sight)), ("forces", forces(scene, frame))];
        for (part, (name, text)) in parts.into_iter().enumerate() {
            let name = format!("{name}-{at:0digits$}.vtp");
            index_entry(&mut index, time, part, &name);
            files.push(Attachment { name, bytes: text.into_bytes() });
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

/// Adds the file of a time (s) to the index; if a time has several parts, each part has its own
/// file.
fn index_entry(index: &mut String, time: f64, part: usize, file: &str) {
    // Writing to a String cannot fail, here and below.
    let _ = writeln!(
        index,
        "<DataSet timestep=\"{time}\" group=\"\" part=\"{part}\" file=\"{file}\"/>"
    );
}

/// Returns the complete index file.
fn closed_index(index: String) -> String {
    index + "</Collection>\n</VTKFile>\n"
}

/// Points and cells, with their data.
#[derive(Default)]
struct Mesh {
    points: Vec<Point>,
    displacements: Vec<Point>,
    lines: Vec<Cell>,
    polygons: Vec<Cell>,
}

/// A polyline or polygon of a body.
struct Cell {
    points: Vec<usize>,
    body: usize,
    role: Role,
}

fn bodies(scene: &Scene, frame: usize, sight: [f64; 2]) -> String {
    let mut mesh = Mesh::default();
    for (at, body) in scene.bodies.iter().enumerate() {
        let Some(pose) = scene.frames.pose(frame, at) else { continue };
        let start = scene.frames.pose(0, at);
        for line in body.outlines.iter().chain(&body.marks) {
            if body.role == Role::Ground && !line.closed {
                mesh.add(&shortened(line, sight), (at, body.role), pose, start);
            } else {
                mesh.add(line, (at, body.role), pose, start);
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
        start: Option<Pose2>,
    ) {
        let from = self.points.len();
        for point in line.points.iter().filter(|p| p.iter().all(|v| v.is_finite())) {
            let now = place(pose, *point);
            let then = start.map_or(now, |start| place(start, *point));
            self.points.push(now);
            self.displacements.push([now[0] - then[0], now[1] - then[1]]);
        }
        let cell = Cell { points: (from..self.points.len()).collect(), body, role };
        let cells = if line.closed { &mut self.polygons } else { &mut self.lines };
        if cell.points.len() > 1 {
            cells.push(cell);
        }
    }

    fn write(&self) -> String {
        let cells = [0, self.lines.len(), self.polygons.len()];
        let mut piece = piece(self.points.len(), cells, "displacement");
        vectors(&mut piece, "displacement", &self.displacements);
        piece.push_str("</PointData>\n<CellData Scalars=\"body\">\n");
        let cells = || self.lines.iter().chain(&self.polygons);
        whole(&mut piece, "Int32", "body", cells().map(|cell| cell.body));
        whole(&mut piece, "Int32", "role", cells().map(|cell| cell.role as usize));
        piece.push_str("</CellData>\n<Points>\n");
        vectors(&mut piece, "points", &self.points);
        piece.push_str("</Points>\n");
        topology(&mut piece, "Lines", &self.lines);
        topology(&mut piece, "Polys", &self.polygons);
        poly_data("", &piece)
    }
}

fn forces(scene: &Scene, frame: usize) -> String {
    let list = scene.frames.forces.get(frame).map_or(&[][..], Vec::as_slice);
    let finite = |f: &&crate::ContactForce| [f.x, f.z, f.fx, f.fz].iter().all(|v| v.is_finite());
    let list: Vec<_> = list.iter().filter(finite).collect();
    let count = list.len();
    let mut piece = piece(count, [count, 0, 0], "force");
    vectors(&mut piece, "force", &list.iter().map(|f| [f.fx, f.fz]).collect::<Vec<_>>());
    piece.push_str("</PointData>\n<Points>\n");
    vectors(&mut piece, "points", &list.iter().map(|f| [f.x, f.z]).collect::<Vec<_>>());
    piece.push_str("</Points>\n<Verts>\n");
    whole(&mut piece, "Int64", "connectivity", 0..count);
    whole(&mut piece, "Int64", "offsets", 1..=count);
    piece.push_str("</Verts>\n");
    poly_data("", &piece)
}

/// Returns the start of a piece, up to its vector data, for the given numbers of points, vertices,
/// lines and polygons.
fn piece(points: usize, [vertices, lines, polygons]: [usize; 3], vectors: &str) -> String {
    format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{vertices}\" NumberOfLines=\"{lines}\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{polygons}\">\n<PointData Vectors=\"{vectors}\">\n"
    )
}

/// Wraps one piece into a file, with the attributes of the array encoding.
fn poly_data(packing: &str, piece: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" \
         byte_order=\"LittleEndian\"{packing}>\n<PolyData>\n{piece}</Piece>\n</PolyData>\n</VTKFile>\n"
    )
}

/// Writes planar vectors as spatial vectors, at full precision.
fn vectors(out: &mut String, name: &str, values: &[Point]) {
    let _ = writeln!(
        out,
        "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"ascii\">"
    );
    for [x, z] in values {
        let _ = writeln!(out, "{} 0 {}", number::csv_number(*x), number::csv_number(*z));
    }
    out.push_str("</DataArray>\n");
}

fn whole(out: &mut String, kind: &str, name: &str, values: impl Iterator<Item = usize>) {
    let _ = writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">");
    for value in values {
        let _ = write!(out, "{value} ");
    }
    out.push_str("\n</DataArray>\n");
}

fn topology(out: &mut String, name: &str, cells: &[Cell]) {
    let _ = writeln!(out, "<{name}>");
    whole(out, "Int64", "connectivity", cells.iter().flat_map(|cell| cell.points.iter().copied()));
    let mut end = 0;
    let ends = cells.iter().map(|cell| {
        end += cell.points.len();
        end
    });
    whole(out, "Int64", "offsets", ends);
    let _ = writeln!(out, "</{name}>");
}
