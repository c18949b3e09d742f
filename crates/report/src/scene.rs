//! A scene: rigid bodies in a vertical plane, their poses over time, and events.

use std::f64::consts::TAU;

use crate::{Depth, Language};

/// A point or vector `[x, z]` (m): x to the right, z up.
pub type Point = [f64; 2];

/// A pose `[x, z, angle]` (m, m, rad) of a body in the world frame; the angle is counterclockwise.
pub type Pose2 = [f64; 3];

/// A polyline.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Polyline {
    /// Vertices (m).
    pub points: Vec<Point>,
    /// `true` if the last point is joined to the first.
    pub closed: bool,
}

impl Polyline {
    /// Creates an open polyline.
    pub fn open(points: Vec<Point>) -> Self {
        Self { points, closed: false }
    }

    /// Creates a closed polyline.
    pub fn closed(points: Vec<Point>) -> Self {
        Self { points, closed: true }
    }

    /// Creates a circle about the origin with `sides` vertices (at least 3).
    pub fn circle(radius: f64, sides: usize) -> Self {
        let sides = sides.max(3);
        let corner = |k: usize| {
            let angle = TAU * k as f64 / sides as f64;
            [radius * angle.cos(), radius * angle.sin()]
        };
        Self::closed((0..sides).map(corner).collect())
    }

    /// Creates a rectangle from its lower left and upper right corners.
    pub fn rectangle(lower: Point, upper: Point) -> Self {
        Self::closed(vec![lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]])
    }
}

/// The role of a body, which determines the color and the line style of the body; files for
/// ParaView number the roles in this order, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The ground, which is drawn without a name, and ignored when the view follows the stack.
    Ground,
    /// A barrel, drawn as wood.
    Barrel,
    /// A rack, drawn as steel.
    Rack,
    /// Any other body.
    Block,
    /// A protection device.
    Device,
}

impl Role {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Barrel => "barrel",
            Self::Rack => "rack",
            Self::Block => "block",
            Self::Device => "device",
        }
    }
}

/// A body, and its outlines and lines in the frame of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBody {
    /// Name shown at the origin of the body.
    pub name: String,
    /// Role.
    pub role: Role,
    /// Outlines; closed outlines are filled.
    pub outlines: Vec<Polyline>,
    /// Lines that make rotation visible; the first line (the bung) is strong, the others are thin.
    pub marks: Vec<Polyline>,
}

impl SceneBody {
    /// Creates a body without marks.
    pub fn new(name: impl Into<String>, role: Role, outlines: Vec<Polyline>) -> Self {
        Self { name: name.into(), role, outlines, marks: Vec::new() }
    }

    /// Creates a barrel viewed along its axis: a circle with a strong bung mark at the top and
    /// stave marks.
    pub fn barrel(name: impl Into<String>, radius: f64) -> Self {
        let spoke = |angle: f64, from: f64| {
            let (sin, cos) = angle.sin_cos();
            Polyline::open(vec![
                [from * radius * cos, from * radius * sin],
                [radius * cos, radius * sin],
            ])
        };
        let mut marks = vec![spoke(TAU / 4.0, 0.72)];
        marks.extend((1..12).map(|k| spoke(TAU / 4.0 + TAU * f64::from(k) / 12.0, 0.86)));
        Self {
            name: name.into(),
            role: Role::Barrel,
            outlines: vec![Polyline::circle(radius, 48)],
            marks,
        }
    }
}

/// A force on a body at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The x-coordinate (m) of the point of application.
    pub x: f64,
    /// The z-coordinate (m) of the point of application.
    pub z: f64,
    /// Component along x (N).
    pub fx: f64,
    /// Component along z (N).
    pub fz: f64,
}

/// Poses over time.
///
/// If [`times`](Self::times) and [`poses`](Self::poses) differ in length, the surplus entries of the longer list are
/// ignored. A body is not drawn in frames in which it has no finite pose.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Frames {
    /// Times of the frames (s), not decreasing.
    pub times: Vec<f64>,
    /// For each frame, the pose of each body in the order of [`Scene::bodies`].
    pub poses: Vec<Vec<Pose2>>,
    /// For each frame, contact forces; empty if there are no forces. The packed data are smallest if a contact has the
    /// same position in the list of every frame.
    pub forces: Vec<Vec<ContactForce>>,
}

impl Frames {
    /// Returns the number of frames that have both a time and poses.
    pub fn len(&self) -> usize {
        self.times.len().min(self.poses.len())
    }

    /// `true` if there are no frames.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the index of the frame nearest to `time` (s); of two equally near frames, the earlier frame. `None` if
    /// `time` is not finite or no frame has a finite time.
    pub fn nearest(&self, time: f64) -> Option<usize> {
        let count = self.len();
        let times = self.times.get(..count)?;
        let distance = |k: usize| (times[k] - time).abs();
        (0..count).filter(|&k| distance(k).is_finite()).min_by(|&a, &b| {
            distance(a).partial_cmp(&distance(b)).unwrap_or(std::cmp::Ordering::Equal)
        })
    }

    pub(crate) fn pose(&self, frame: usize, body: usize) -> Option<Pose2> {
        let pose = *self.poses.get(frame)?.get(body)?;
        pose.iter().all(|v| v.is_finite()).then_some(pose)
    }
}

/// The kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// A contact opened.
    Uplift,
    /// A contact slid.
    Slip,
    /// A body left its seat.
    LossOfSeat,
    /// A body reached the ground or left the scene.
    Fall,
    /// Any other event worth marking.
    Note,
}

impl EventKind {
    /// Returns the word that names the kind of event for the reader.
    pub fn word(self) -> &'static str {
        match self {
            Self::Uplift => "uplift",
            Self::Slip => "slip",
            Self::LossOfSeat => "gives way",
            Self::Fall => "fall",
            Self::Note => "note",
        }
    }

    /// Returns the word in a language. The word for a fall is the translation of the entry "falls". The entry "fall" is
    /// reserved for the plural verb in headings of tables, which is a different word in other languages.
    pub(crate) fn word_in(self, language: Language) -> &'static str {
        match (self, language) {
            (_, Language::English) => self.word(),
            (Self::Fall, _) => language.fixed("falls"),
            _ => language.fixed(self.word()),
        }
    }

    pub(crate) fn class(self) -> &'static str {
        if self == Self::LossOfSeat { "seat" } else { self.word() }
    }
}

/// An event at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time (s).
    pub time: f64,
    /// Index in [`Scene::bodies`] of the body that the event concerns; `None` if it concerns no particular body.
    pub body: Option<usize>,
    /// Kind.
    pub kind: EventKind,
    /// Description in one plain sentence.
    pub text: String,
}

/// A quantity over time.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct History {
    /// Name.
    pub label: String,
    /// Unit of the values as displayed; may be empty.
    pub unit: String,
    /// Times (s).
    pub times: Vec<f64>,
    /// Values; NaN makes a gap.
    pub values: Vec<f64>,
}

/// A line between a point of one body and a point of another, such as a strap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    /// Indices of the bodies in [`Scene::bodies`].
    pub bodies: [usize; 2],
    /// End points of the line, each in the frame of its body (m).
    pub points: [Point; 2],
    /// Time (s) at which the tie breaks; `None` if it does not break. A broken tie is not drawn.
    pub torn_at: Option<f64>,
}

/// The most informative instant of a scene, at which its player opens.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Time (s).
    pub time: f64,
    /// Index in [`Scene::bodies`] of the body that the description names.
    pub body: usize,
    /// Description, such as "here rack R3 leaves its seat".
    pub text: String,
    /// `true` if a body falls at this instant. A player of several scenes first shows a scene in which a body falls, if
    /// there is one.
    pub falls: bool,
}

/// A quantity of every body in every frame, which a reader of the page can show as the color of the bodies.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Tint {
    /// Name of the quantity.
    pub label: String,
    /// Unit of the values as displayed.
    pub unit: String,
    /// For each frame, the value of each body in the order of [`Scene::bodies`]; never negative.
    pub values: Vec<Vec<f64>>,
}

/// Other runs of the same scene as an overlay: paths of points and final poses of bodies.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Ghosts {
    /// Label of the switch that shows the other runs.
    pub label: String,
    /// Number of runs.
    pub count: usize,
    /// Paths (m) of points of bodies, relative to the body with the role [`Role::Ground`].
    pub paths: Vec<Vec<Point>>,
    /// Indices of bodies in [`Scene::bodies`], with their final poses relative to the ground.
    pub ends: Vec<(usize, Pose2)>,
}

/// Bodies, their motion, events, and the ground motion.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Scene {
    /// The bodies, drawn in this order.
    pub bodies: Vec<SceneBody>,
    /// Lines between bodies, drawn over the bodies.
    pub ties: Vec<Tie>,
    /// Poses of the bodies over time.
    pub frames: Frames,
    /// Events, in order of time.
    pub events: Vec<Event>,
    /// Histories shown in the strip below the player.
    pub ground: Vec<History>,
    /// The instant at which the player opens; the first frame if `None`.
    pub moment: Option<Moment>,
    /// Quantity that a reader of the page can show as the color of the bodies.
    pub tint: Option<Tint>,
    /// Other runs, which a reader of the page can overlay on the scene.
    pub ghosts: Option<Ghosts>,
    /// The scene in three dimensions; `None` if only its plane is known.
    pub depth: Option<Depth>,
}

impl Scene {
    /// Returns the ends of a tie in a frame; `None` if the tie is broken or one of its bodies is not
    /// drawn.
    pub(crate) fn ends(&self, tie: &Tie, frame: usize) -> Option<[Point; 2]> {
        let time = *self.frames.times.get(frame)?;
        let end = |at: usize| Some(place(self.frames.pose(frame, tie.bodies[at])?, tie.points[at]));
        let whole = tie.torn_at.is_none_or(|torn| time < torn);
        if whole { Some([end(0)?, end(1)?]) } else { None }
    }

    /// Returns the name of a body, or a generic name such as "body 3" if there is no such body.
    pub fn name(&self, body: usize) -> String {
        self.bodies.get(body).map_or_else(|| format!("body {}", body + 1), |b| b.name.clone())
    }
}

/// A point of a body whose path is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Index in [`Scene::bodies`] of the body.
    pub body: usize,
    /// Position of the point in the frame of the body (m).
    pub point: Point,
    /// Name of the point.
    pub label: String,
}

/// An axis-aligned bounding box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extent {
    pub lower: Point,
    pub upper: Point,
}

impl Extent {
    pub(crate) const EMPTY: Self =
        Self { lower: [f64::INFINITY; 2], upper: [f64::NEG_INFINITY; 2] };

    pub(crate) fn add(&mut self, point: Point) {
        if point.iter().all(|v| v.is_finite()) {
            for (axis, value) in point.into_iter().enumerate() {
                self.lower[axis] = self.lower[axis].min(value);
                self.upper[axis] = self.upper[axis].max(value);
            }
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lower[0] > self.upper[0]
    }

    fn join(&mut self, other: &Self) {
        self.add(other.lower);
        self.add(other.upper);
    }

    fn holds(&self, point: Point) -> bool {
        (0..2).all(|axis| (self.lower[axis]..=self.upper[axis]).contains(&point[axis]))
    }

    /// Returns the center; not finite if the extent is empty.
    fn center(&self) -> Point {
        [0.5 * (self.lower[0] + self.upper[0]), 0.5 * (self.lower[1] + self.upper[1])]
    }

    pub(crate) fn width(&self) -> f64 {
        (self.upper[0] - self.lower[0]).max(0.0)
    }

    pub(crate) fn height(&self) -> f64 {
        (self.upper[1] - self.lower[1]).max(0.0)
    }
}

pub(crate) fn place(pose: Pose2, point: Point) -> Point {
    let (sin, cos) = pose[2].sin_cos();
    [pose[0] + cos * point[0] - sin * point[1], pose[1] + sin * point[0] + cos * point[1]]
}

/// Returns the extent of a body in a frame; empty if the body is not drawn in this frame.
fn body_extent(scene: &Scene, frame: usize, body: usize) -> Extent {
    let mut extent = Extent::EMPTY;
    if let (Some(drawn), Some(pose)) = (scene.bodies.get(body), scene.frames.pose(frame, body)) {
        for point in drawn.outlines.iter().flat_map(|line| &line.points) {
            extent.add(place(pose, *point));
        }
    }
    extent
}

fn moving(scene: &Scene) -> impl Iterator<Item = usize> {
    (0..scene.bodies.len()).filter(|&at| scene.bodies[at].role != Role::Ground)
}

/// Maximum distances by which a window may extend beyond the bodies of the first frame. The first distance applies to
/// the left and to the right, the second upward. Both are fractions of the larger side of the rectangle around these
/// bodies.
///
/// The horizontal limit is larger because a body that topples comes to rest within the height of the stack, but may
/// roll farther.
const REACH: [f64; 2] = [1.75, 0.15];

/// Returns the window for the given frames, which contains the extent of the first frame and all
/// bodies that stay or land near it.
///
/// A body that moves far away leaves the picture; otherwise all other bodies would be drawn small.
pub(crate) fn window(scene: &Scene, frames: &[usize]) -> Extent {
    let mut all = Extent::EMPTY;
    for body in moving(scene) {
        all.join(&body_extent(scene, 0, body));
    }
    let limit = (!all.is_empty()).then(|| {
        let size = all.width().max(all.height());
        Extent {
            lower: [all.lower[0] - REACH[0] * size, all.lower[1] - 0.05 * size],
            upper: [all.upper[0] + REACH[0] * size, all.upper[1] + REACH[1] * size],
        }
    });
    for &frame in frames {
        for body in moving(scene) {
            let extent = body_extent(scene, frame, body);
            if limit.is_none_or(|limit| limit.holds(extent.center())) {
                all.join(&extent);
            }
        }
    }
    if all.is_empty() {
        return Extent { lower: [-1.0, 0.0], upper: [1.0, 1.0] };
    }
    if let Some(limit) = limit {
        for axis in 0..2 {
            all.lower[axis] = all.lower[axis].max(limit.lower[axis]);
            all.upper[axis] = all.upper[axis].min(limit.upper[axis]);
        }
    }
    let pad = 0.04 * all.width().max(all.height()).max(0.1);
    Extent {
        lower: [all.lower[0] - pad, all.lower[1]],
        upper: [all.upper[0] + pad, all.upper[1] + pad],
    }
}

/// Returns hatch strokes below a line of the ground, between `from` and `to` (m) along x, in the
/// frame of the line; `spacing` (m) is both the distance between the strokes and their size.
pub(crate) fn hatch(line: &Polyline, spacing: f64, [from, to]: [f64; 2]) -> Vec<[Point; 2]> {
    let mut strokes = Vec::new();
    let finite = [spacing, from, to].iter().all(|v| v.is_finite());
    // Limits the number of strokes in case the window is wrong.
    if !(finite && spacing > 0.0 && (to - from) / spacing < 5000.0) {
        return strokes;
    }
    for pair in line.points.windows(2) {
        let (a, b) = if pair[0][0] <= pair[1][0] { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
        let (low, high) = (a[0].max(from), b[0].min(to));
        let mut x = (low / spacing).ceil() * spacing;
        while x < high {
            let z = a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
            strokes.push([[x, z], [x - 0.7 * spacing, z - 0.7 * spacing]]);
            x += spacing;
        }
    }
    strokes
}
