//! Drawing of a three-dimensional body in a view direction: the outlines of its solids, and lines that show its
//! rotation.

use std::f64::consts::TAU;

use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{Body, Linear as _, Solid, Spatial, Vec3, math};
use barrelstack_report::{Point, Polyline, Role, SceneBody};

use crate::part::Part;

/// View of a body in a drawing. Its direction is rounded, so that one drawing serves for similar directions.
pub(super) struct BodyView {
    /// Axes, in the body frame, that point right and up in the drawing.
    axes: [Vec3; 2],
    /// Rotation of the drawing on the page (rad).
    pub(super) angle: f64,
    kind: PartKind,
}

impl BodyView {
    /// Creates the view of a body. `page` holds the axes of the page that point right and up, in the body frame. The
    /// view direction is rounded: for a barrel, its angle to the cross-section is rounded to multiples of a right angle
    /// divided by `steps`; for any other body, its components in the body frame are rounded to multiples of the
    /// reciprocal of `steps`.
    pub(super) fn of(kind: PartKind, page: [Vec3; 2], steps: f64) -> Self {
        let toward = page[0].cross(page[1]);
        let axis = Vec3::new(1.0, 0.0, 0.0);
        let stepped = |value: f64| (value * steps).round() / steps;
        let (from, mut right) = if kind == PartKind::Barrel {
            // A body of revolution looks the same at any rotation about its axis.
            let tilt =
                stepped(math::asin(toward.dot(axis).clamp(-1.0, 1.0)) / (0.25 * TAU)) * 0.25 * TAU;
            let side = toward - axis * toward.dot(axis);
            let around = side.unit_or(Vec3::new(0.0, 0.0, 1.0));
            let (sin, cos) = math::sin_cos(tilt);
            let from = axis * sin + around * cos;
            // Only in a view of its head does the drawing show how the body rolls.
            let head = sin.abs() > 0.999;
            let from = if head { axis * tilt.signum() } else { from };
            (from, if head { Vec3::new(0.0, 1.0, 0.0) } else { axis })
        } else {
            let from = Vec3::new(stepped(toward.x), stepped(toward.y), stepped(toward.z));
            let from = from.unit_or(Vec3::new(0.0, 0.0, 1.0));
            let right = if from.x.abs() < 0.9 { axis } else { Vec3::new(0.0, 1.0, 0.0) };
            (from, right)
        };
        right = (right - from * right.dot(from)).unit_or(axis);
        let up = from.cross(right);
        let angle = math::atan2(right.dot(page[1]), right.dot(page[0]));
        Self { axes: [right, up], angle, kind }
    }

    /// Returns a key that is different for different drawings of the same body.
    #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
    pub(super) fn key(&self) -> [i32; 3] {
        let from = self.axes[0].cross(self.axes[1]);
        let fine = |value: f64| (1e3 * value).round() as i32;
        if self.kind == PartKind::Barrel {
            [fine(from.x), 0, 0]
        } else {
            [fine(from.x), fine(from.y), fine(from.z)]
        }
    }

    /// Returns the drawing of a body in this view.
    pub(super) fn draw(&self, part: &Part, body: &Body<Spatial>) -> SceneBody {
        let name = &part.name;
        let [right, up] = self.axes;
        let from = right.cross(up);
        let flat = |point: Vec3| [point.dot(right), point.dot(up)];
        let mut outlines = Vec::new();
        let mut marks = Vec::new();
        for placed in &body.surfaces {
            let place = |point: Vec3| placed.offset + placed.rotation.apply(point);
            match &placed.surface {
                Solid::Capsule(tube) => {
                    let ends = [-tube.half_length, tube.half_length]
                        .map(|x| flat(place(Vec3::new(x, 0.0, 0.0))));
                    let rim = (0..8).map(|at| TAU * f64::from(at) / 8.0);
                    let points = rim.flat_map(|angle| {
                        ends.map(|[x, z]| {
                            [x + tube.radius * math::cos(angle), z + tube.radius * math::sin(angle)]
                        })
                    });
                    outlines.push(Polyline::closed(hull(points.collect())));
                }
                Solid::Barrel(barrel) => {
                    let half = barrel.half_length + barrel.rounding;
                    let arc = barrel.stave_radius + barrel.rounding;
                    let radius = |x: f64| (arc * arc - x * x).sqrt() - barrel.stave_offset;
                    let ring = |x: f64| {
                        (0..24).map(move |at| {
                            let angle = TAU * f64::from(at) / 24.0;
                            let (y, z) =
                                (radius(x) * math::cos(angle), radius(x) * math::sin(angle));
                            Vec3::new(x, y, z)
                        })
                    };
                    let rings = (-6..=6).map(|at| half * f64::from(at) / 6.0);
                    outlines.push(Polyline::closed(hull(
                        rings.flat_map(ring).map(|p| flat(place(p))).collect(),
                    )));
                    if from.x.abs() > 0.999 && self.kind == PartKind::Barrel {
                        // The marks are the same as in the drawings of plane models.
                        marks = SceneBody::barrel(name, radius(0.0)).marks;
                    } else if self.kind == PartKind::Barrel {
                        // Hoops, on the visible side.
                        for x in [0.28, 0.6, -0.6, -0.28, 0.94, -0.94].map(|share| share * half) {
                            let near = |point: &Vec3| point.y * from.y + point.z * from.z >= -1e-9;
                            let mut hoop: Vec<Point> =
                                ring(x).filter(near).map(|p| flat(place(p))).collect();
                            hoop.sort_by(|a, b| a[1].total_cmp(&b[1]));
                            marks.push(Polyline::open(hoop));
                        }
                    }
                }
                Solid::Ball(ball) => {
                    let [x, z] = flat(place(Vec3::default()));
                    let around = |at: u32| TAU * f64::from(at) / 32.0;
                    let rim = (0..32).map(around).map(|angle| {
                        [x + ball.radius * math::cos(angle), z + ball.radius * math::sin(angle)]
                    });
                    outlines.push(Polyline::closed(rim.collect()));
                    // Great circles, on the visible side, show the rotation.
                    for [one, other] in [[0, 1], [1, 2], [2, 0]] {
                        let axes = [
                            Vec3::new(1.0, 0.0, 0.0),
                            Vec3::new(0.0, 1.0, 0.0),
                            Vec3::new(0.0, 0.0, 1.0),
                        ];
                        let on = |at: u32| {
                            let (sin, cos) = math::sin_cos(around(at));
                            (axes[one] * cos + axes[other] * sin) * ball.radius
                        };
                        let near = |at: &u32| placed.rotation.apply(on(*at)).dot(from) >= -1e-9;
                        // The visible half is one contiguous arc, which starts at the first visible point after a
                        // hidden point.
                        let start = (0..32).find(|at| near(at) && !near(&((at + 31) % 32)));
                        let start = start.unwrap_or(0);
                        let visible = (0..=32).map(|at| (start + at) % 32).take_while(near);
                        marks.push(Polyline::open(visible.map(|at| flat(place(on(at)))).collect()));
                    }
                }
                Solid::Block(block) => {
                    let half =
                        block.half + Vec3::new(block.rounding, block.rounding, block.rounding);
                    let corner = |at: u32| {
                        let side = |bit: u32| if at & bit == 0 { -1.0 } else { 1.0 };
                        flat(place(half.times(Vec3::new(side(1), side(2), side(4)))))
                    };
                    outlines.push(Polyline::closed(hull((0..8).map(corner).collect())));
                }
                Solid::HalfSpace | Solid::Dish(_) => {}
            }
        }
        let line = |line: &Vec<Vec3>| Polyline::open(line.iter().copied().map(flat).collect());
        outlines.extend(part.lines.iter().map(line));
        let role = match self.kind {
            PartKind::Barrel => Role::Barrel,
            PartKind::Body => Role::Block,
            PartKind::Device | PartKind::Wine => Role::Device,
            PartKind::Ground | PartKind::Rack => Role::Rack,
        };
        SceneBody { name: name.clone(), role, outlines, marks }
    }
}

/// Returns the convex hull of points, counterclockwise.
fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let left = |a: Point, b: Point, c: Point| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 1e-12
    };
    let chain = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && !left(a, b, point)
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut whole = chain(&mut points.iter().copied());
    whole.extend(chain(&mut points.iter().rev().copied()));
    whole
}
