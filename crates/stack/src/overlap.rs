//! Overlap depths of bodies, computed from their outlines alone, independently of contact elements and contact laws.

use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{Body, BodyId, Linear as _, Planar, Pose, Shape, State, Vec2};

use crate::assemble::{AssembleError, Assembly, Part, PartKind};

/// Largest accepted overlap (m) of two bodies in the initial state. Bodies that have settled under their weight overlap
/// by less.
pub const ALLOWED: f64 = 2e-3;

/// Number of corners n of the polygon that represents a circle; the sides of the polygon lie inside the circle, at a
/// distance of at most `r (1 − cos π/n)`, where r is the radius of the circle.
const AROUND: usize = 256;

/// Rejects an initial state in which bodies overlap.
///
/// # Errors
/// Returns an error that names the two bodies that overlap most.
pub(crate) fn check_overlap(
    assembly: &Assembly,
    state: &State<Planar>,
    length_scale: f64,
) -> Result<(), AssembleError> {
    match Boundaries::new(assembly).deepest(&state.poses) {
        Some(Overlap { bodies: [first, second], depth }) if depth > ALLOWED * length_scale => {
            let name = |body: BodyId| assembly.parts[body].name.clone();
            Err(AssembleError::Overlap { first: name(first), second: name(second), depth })
        }
        _ => Ok(()),
    }
}

/// Two overlapping bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// The bodies, the lower ID first.
    pub bodies: [BodyId; 2],
    /// Shortest displacement (m) that separates the two convex parts that overlap most.
    pub depth: f64,
}

/// The convex outlines of all bodies of a model, each in the frame of its body.
pub struct Boundaries {
    bodies: Vec<Vec<(Outline, Depth)>>,
}

/// Position of a part in the direction perpendicular to the plane of the model.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    /// The part is a barrel.
    Barrel,
    /// The part stands beside the barrels and touches no barrel.
    Beside,
    /// The part can touch all others.
    Any,
}

/// Outline of a convex part.
enum Outline {
    /// Corners (m), counterclockwise.
    Polygon(Vec<Vec2>),
    /// The half-plane below a line, given by a point (m) on the line and by the unit normal of the line.
    Below(Vec2, Vec2),
}

impl Boundaries {
    /// Creates the boundaries of all bodies of a model, from the outlines of their surfaces.
    pub fn new(assembly: &Assembly) -> Self {
        let turn = |i: usize| Rotation2::new(std::f64::consts::TAU * i as f64 / AROUND as f64);
        let around: Vec<Rotation2> = (0..AROUND).map(turn).collect();
        let outline = |placed: &barrelstack_dynamics::Placed<Planar>| {
            let place = |point: Vec2| placed.offset + placed.rotation.apply(point);
            match &placed.surface {
                Shape::HalfPlane(_) => {
                    Some(Outline::Below(placed.offset, placed.rotation.apply(Vec2::new(0.0, 1.0))))
                }
                Shape::Circle(circle) => {
                    let corner =
                        |turn: &Rotation2| place(turn.apply(Vec2::new(circle.radius, 0.0)));
                    Some(Outline::Polygon(around.iter().map(corner).collect()))
                }
                // A trough has no interior that a body could overlap.
                Shape::Cradle(_) => None,
                shape @ (Shape::Polygon(_) | Shape::BarrelProfile(_)) => {
                    Some(Outline::Polygon(shape.outline().0.into_iter().map(place).collect()))
                }
            }
        };
        let placed = |(part, body): (&Part, &Body<Planar>)| {
            let depth = |at: usize| match part.out_of_plane.get(at) {
                _ if part.kind == PartKind::Barrel => Depth::Barrel,
                Some(true) => Depth::Beside,
                Some(false) | None => Depth::Any,
            };
            let surfaces = body.surfaces.iter().enumerate();
            surfaces.filter_map(|(at, surface)| Some((outline(surface)?, depth(at)))).collect()
        };
        Self { bodies: assembly.parts.iter().zip(assembly.model.bodies()).map(placed).collect() }
    }

    /// Returns the deepest overlap of any two bodies at the given poses; `None` if no two overlap.
    pub fn deepest(&self, poses: &[Pose<Planar>]) -> Option<Overlap> {
        self.overlaps(poses).into_iter().max_by(|a, b| a.depth.total_cmp(&b.depth))
    }

    /// Returns all pairs of bodies that overlap at the given poses.
    pub fn overlaps(&self, poses: &[Pose<Planar>]) -> Vec<Overlap> {
        let at = |pose: &Pose<Planar>, (outline, depth): &(Outline, Depth)| {
            let (outline, around) = outline.at(pose);
            (outline, around, *depth)
        };
        let bodies = self.bodies.iter().zip(poses);
        let placed: Vec<Vec<Solid>> =
            bodies.map(|(solids, pose)| solids.iter().map(|s| at(pose, s)).collect()).collect();
        // Sweep along x, so that the cost does not grow quadratically with the number of bodies in a row.
        let mut extents: Vec<(f64, f64, BodyId)> = Vec::new();
        for (body, outlines) in placed.iter().enumerate() {
            let least =
                outlines.iter().map(|(_, around, _)| around[0]).fold(f64::INFINITY, f64::min);
            let most = outlines.iter().map(|(_, around, _)| around[2]);
            extents.push((least, most.fold(f64::NEG_INFINITY, f64::max), body));
        }
        extents.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut overlaps = Vec::new();
        let mut open: Vec<(f64, BodyId)> = Vec::new();
        for (from, to, body) in extents {
            open.retain(|(end, _)| from <= *end);
            for (_, other) in &open {
                let bodies = [body.min(*other), body.max(*other)];
                let depth = deepest_of(&placed[bodies[0]], &placed[bodies[1]]);
                if depth > 0.0 {
                    overlaps.push(Overlap { bodies, depth });
                }
            }
            open.push((to, body));
        }
        overlaps.sort_unstable_by_key(|overlap| overlap.bodies);
        overlaps
    }
}

impl Outline {
    /// Returns the outline at a pose, and the bounding box of the outline: least `x` and `z`, then greatest `x` and `z`
    /// (m).
    fn at(&self, pose: &Pose<Planar>) -> (Self, [f64; 4]) {
        let rotation = Rotation2::new(pose.orientation);
        let place = |point: &Vec2| pose.position + rotation.apply(*point);
        match self {
            Self::Polygon(corners) => {
                let corners: Vec<Vec2> = corners.iter().map(place).collect();
                let mut around =
                    [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
                for corner in &corners {
                    around[0] = around[0].min(corner.x);
                    around[1] = around[1].min(corner.z);
                    around[2] = around[2].max(corner.x);
                    around[3] = around[3].max(corner.z);
                }
                (Self::Polygon(corners), around)
            }
            Self::Below(point, normal) => {
                let everywhere =
                    [f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY];
                (Self::Below(place(point), rotation.apply(*normal)), everywhere)
            }
        }
    }
}

/// Outline of a part at a pose, its bounding box as in [`Outline::at`], and its position in the direction perpendicular
/// to the plane.
type Solid = (Outline, [f64; 4], Depth);

/// Returns the deepest overlap (m) of the parts of two bodies; zero if they do not overlap.
fn deepest_of(first: &[Solid], second: &[Solid]) -> f64 {
    let mut depth = 0.0_f64;
    for (a, box_a, of_a) in first {
        for (b, box_b, of_b) in second {
            let apart = (0..2).any(|k| box_a[k] > box_b[k + 2] || box_b[k] > box_a[k + 2]);
            let past = matches!(
                (of_a, of_b),
                (Depth::Barrel, Depth::Beside) | (Depth::Beside, Depth::Barrel)
            );
            if !apart && !past {
                depth = depth.max(parting(a, b));
            }
        }
    }
    depth
}

/// Returns the shortest displacement (m) that separates two convex outlines; zero or less if they are apart.
///
/// For two convex polygons, this displacement is along the normal of a side of one of the polygons.
fn parting(a: &Outline, b: &Outline) -> f64 {
    match (a, b) {
        (Outline::Polygon(a), Outline::Polygon(b)) => least_along(a, b).min(least_along(b, a)),
        (Outline::Below(point, normal), Outline::Polygon(corners))
        | (Outline::Polygon(corners), Outline::Below(point, normal)) => {
            corners.iter().map(|c| (*point - *c).dot(*normal)).fold(f64::NEG_INFINITY, f64::max)
        }
        (Outline::Below(..), Outline::Below(..)) => 0.0,
    }
}

/// Returns the shortest displacement (m), along an outward normal of the polygon `sides`, that separates the polygon
/// `corners` from the polygon `sides`; zero or less if the polygons are apart.
fn least_along(sides: &[Vec2], corners: &[Vec2]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, from) in sides.iter().enumerate() {
        let along = sides[(i + 1) % sides.len()] - *from;
        let outward = -along.quarter_turn() * (1.0 / along.length());
        let mut lowest = f64::INFINITY;
        for corner in corners {
            lowest = lowest.min((*corner - *from).dot(outward));
            // The displacement for another side is already shorter.
            if -lowest >= least {
                break;
            }
        }
        least = least.min(-lowest);
        if least <= 0.0 {
            break;
        }
    }
    least
}
