//! Triangle meshes of the bodies of a three-dimensional run, for 3D viewers.

use std::f64::consts::{FRAC_PI_2, TAU};

use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{Body, Element, Solid, Spatial, Vec3, math};
use barrelstack_report::{Role, SolidBody, SolidTie, Solids};

use crate::drawing::PLATE;
use crate::run::Run;

/// Number of mesh steps per quarter circle: `FINE` for balls and barrels, `COARSE` for tubes. Tubes have coarser
/// meshes, because racks have many tubes and all points are written for every frame.
const FINE: u32 = 6;
const COARSE: u32 = 3;

/// Points (m) of a surface, and its triangles. Viewed from outside, the corners of a triangle are in counterclockwise
/// order.
type Mesh = (Vec<Vec3>, Vec<[usize; 3]>);

/// Returns the bodies of a run as triangle meshes, with the poses of the bodies in all frames between two times (s).
pub fn solids(run: &Run, [from, to]: [f64; 2]) -> Solids {
    let floor = floor(run);
    let parts = run.stack.parts.iter().zip(run.stack.model.bodies());
    let bodies = parts.map(|(part, body)| {
        let (points, triangles) = surface(body, &part.lines, floor);
        SolidBody {
            name: part.name.clone(),
            role: match part.kind {
                PartKind::Ground => Role::Ground,
                PartKind::Barrel => Role::Barrel,
                PartKind::Rack => Role::Rack,
                PartKind::Device => Role::Device,
                PartKind::Wine | PartKind::Body => Role::Block,
            },
            level: part.level,
            points: points.into_iter().map(|point| [point.x, point.y, point.z]).collect(),
            triangles,
        }
    });
    let frames = &run.frames;
    let within = |at: &usize| (from..=to).contains(&frames.times[*at]);
    let kept: Vec<usize> = (0..frames.times.len()).filter(within).collect();
    let ties = run.devices().filter_map(|((element, _), fate)| match element {
        Element::Strap(strap) => Some(SolidTie {
            name: strap.link.name.clone(),
            bodies: strap.link.bodies,
            points: strap.link.points.map(|point| [point.x, point.y, point.z]),
            torn_at: fate.broken_at,
        }),
        Element::Rod(_) | Element::Guide(_) => None,
    });
    Solids {
        bodies: bodies.collect(),
        ties: ties.collect(),
        times: kept.iter().map(|at| frames.times[*at]).collect(),
        poses: kept.iter().map(|at| frames.poses[*at].clone()).collect(),
        twists: kept.iter().map(|at| frames.twists[*at].clone()).collect(),
    }
}

/// Returns points (m) of the surface of a body, in the body frame. The convex hull of the points is nearly the convex
/// hull of the body. The result is empty for the floor.
pub fn points(body: &Body<Spatial>) -> Vec<Vec3> {
    let round = body.surfaces.iter().any(|placed| !matches!(placed.surface, Solid::HalfSpace));
    if round { surface(body, &[], 0.0).0 } else { Vec::new() }
}

/// Returns half the side (m) of the square that represents a half-space. The square is small, because viewers choose
/// their first view so that the whole square is visible.
fn floor(run: &Run) -> f64 {
    let far = |pose: &[f64; 7]| pose[..3].iter().fold(0.0_f64, |far, x| far.max(x.abs()));
    let sizes = run.stack.model.bodies().iter().map(Body::reach);
    let reach = sizes.filter(|size| size.is_finite()).fold(0.5, f64::max);
    run.frames.poses.iter().flatten().map(far).fold(0.0, f64::max) + 2.0 * reach
}

/// Returns the mesh of a body in the body frame. Half-spaces are drawn as squares; `floor` is half the side (m) of a
/// square. The `lines`, which represent parts of devices on the body, are drawn as bars.
fn surface(body: &Body<Spatial>, lines: &[Vec<Vec3>], floor: f64) -> Mesh {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for placed in &body.surfaces {
        let (own, faces) = match &placed.surface {
            Solid::HalfSpace => square(floor),
            // A dish is not shown, since it lies in the ground.
            Solid::Dish(_) => Mesh::default(),
            Solid::Ball(ball) => revolved(&rounded(0.0, ball.radius, FINE), FINE),
            Solid::Capsule(tube) => {
                revolved(&rounded(tube.half_length, tube.radius, COARSE), COARSE)
            }
            Solid::Barrel(barrel) => {
                let (half, head, chime) = (barrel.half_length, barrel.head_radius, barrel.rounding);
                let arc = barrel.stave_radius + chime;
                let widest = math::asin(half / barrel.stave_radius);
                let mut profile = vec![[-half - chime, 0.0]];
                let corner = |side: f64, angle: f64| {
                    let (sin, cos) = math::sin_cos(angle);
                    [side * (half + chime * sin), head + chime * cos]
                };
                profile.extend([FRAC_PI_2, 0.5 * (FRAC_PI_2 + widest)].map(|a| corner(-1.0, a)));
                profile.extend((-4..=4).map(|at| {
                    let (sin, cos) = math::sin_cos(widest * f64::from(at) / 4.0);
                    [arc * sin, arc * cos - barrel.stave_offset]
                }));
                profile.extend([0.5 * (FRAC_PI_2 + widest), FRAC_PI_2].map(|a| corner(1.0, a)));
                profile.push([half + chime, 0.0]);
                revolved(&profile, FINE)
            }
            Solid::Block(block) => {
                let out = block.rounding;
                cuboid(block.half + Vec3::new(out, out, out))
            }
        };
        let first = points.len();
        let place = |point: Vec3| placed.offset + placed.rotation.apply(point);
        points.extend(own.into_iter().map(place));
        triangles.extend(faces.into_iter().map(|face| face.map(|corner| first + corner)));
    }
    for ends in lines.iter().flat_map(|line| line.windows(2)) {
        let (own, faces) = bar([ends[0], ends[1]]);
        let first = points.len();
        points.extend(own);
        triangles.extend(faces.into_iter().map(|face| face.map(|corner| first + corner)));
    }
    (points, triangles)
}

/// Returns the mesh of a bar between two points (m), with round ends.
fn bar([from, to]: [Vec3; 2]) -> Mesh {
    let along = to - from;
    let [x, any] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    let axis = along.unit_or(x);
    // Perpendicular to the axis; the second direction is used for a bar that is upright.
    let side = axis.cross(any).unit_or(axis.cross(x).unit_or(x));
    let up = axis.cross(side);
    let (own, faces) = revolved(&rounded(0.5 * along.length(), PLATE, COARSE), COARSE);
    let middle = (from + to) * 0.5;
    let place = |point: Vec3| middle + axis * point.x + side * point.y + up * point.z;
    (own.into_iter().map(place).collect(), faces)
}

fn square(half: f64) -> Mesh {
    let corner = |x: f64, y: f64| Vec3::new(x * half, y * half, 0.0);
    let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    (corners, vec![[0, 1, 2], [0, 2, 3]])
}

/// Returns the mesh of a block with sharp edges, given half its side lengths (m).
fn cuboid(half: Vec3) -> Mesh {
    let corner = |at: u32| {
        let side = |bit: u32| if at & bit == 0 { -1.0 } else { 1.0 };
        half.times(Vec3::new(side(1), side(2), side(4)))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    ((0..8).map(corner).collect(), triangles.collect())
}

/// Returns the profile of a cylinder with hemispherical ends, from pole to pole, as positions (m) along the axis and
/// distances (m) from the axis; `quarter` is the number of steps per quarter circle.
fn rounded(half_length: f64, radius: f64, quarter: u32) -> Vec<[f64; 2]> {
    let step = FRAC_PI_2 / f64::from(quarter);
    let end = |side: f64, at: u32| {
        let (sin, cos) = math::sin_cos(step * f64::from(at));
        // The cosine of a right angle is not exactly zero.
        let away = if at == quarter { 0.0 } else { radius * cos };
        [side * (half_length + radius * sin), away]
    };
    let mut profile: Vec<[f64; 2]> = (0..=quarter).rev().map(|at| end(-1.0, at)).collect();
    // Both ends of a ball share a ring.
    let second = u32::from(half_length <= 0.0);
    profile.extend((second..=quarter).map(|at| end(1.0, at)));
    profile
}

/// Returns the mesh of the surface that a profile, given from pole to pole, generates by rotation about `x`; `quarter`
/// is the number of steps per quarter circle.
fn revolved(profile: &[[f64; 2]], quarter: u32) -> Mesh {
    debug_assert!(profile.len() >= 3, "a profile between two poles");
    let around = 4 * quarter as usize;
    let last = profile.len() - 1;
    let mut points = vec![Vec3::new(profile[0][0], 0.0, 0.0)];
    for [x, radius] in &profile[1..last] {
        points.extend((0..around).map(|at| {
            let (sin, cos) = math::sin_cos(TAU * at as f64 / around as f64);
            Vec3::new(*x, radius * cos, radius * sin)
        }));
    }
    points.push(Vec3::new(profile[last][0], 0.0, 0.0));
    let far = points.len() - 1;
    let on = |ring: usize, at: usize| 1 + ring * around + at % around;
    let mut triangles = Vec::new();
    for at in 0..around {
        triangles.push([0, on(0, at + 1), on(0, at)]);
        for ring in 0..last - 2 {
            let [a, b] = [on(ring, at), on(ring, at + 1)];
            let [c, d] = [on(ring + 1, at + 1), on(ring + 1, at)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([far, on(last - 2, at), on(last - 2, at + 1)]);
    }
    (points, triangles)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use barrelstack_dynamics::Linear as _;

    use super::*;

    /// Returns the volume (m³) that a closed mesh encloses; negative if the mesh is inside out.
    fn volume((points, triangles): &Mesh) -> f64 {
        let corner = |[a, b, c]: &[usize; 3]| points[*a].dot(points[*b].cross(points[*c])) / 6.0;
        triangles.iter().map(corner).sum()
    }

    /// Returns `true` if every edge of a mesh belongs to two triangles, with opposite directions.
    fn is_closed((_, triangles): &Mesh) -> bool {
        let mut edges: Vec<(usize, usize)> =
            triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
        edges.sort_unstable();
        let once = edges.windows(2).all(|two| two[0] != two[1]);
        once && edges.iter().all(|(a, b)| edges.binary_search(&(*b, *a)).is_ok())
    }

    #[test]
    fn surfaces_enclose_their_solids() {
        let ball = 4.0 / 3.0 * PI * 0.027;
        for (mesh, exact, near) in [
            (cuboid(Vec3::new(0.5, 1.0, 1.5)), 6.0, 1e-12),
            // Measured 2.3 % below the exact volume, because the polyhedra are inscribed.
            (revolved(&rounded(0.0, 0.3, FINE), FINE), ball, 0.03),
            (revolved(&rounded(0.4, 0.3, FINE), FINE), ball + PI * 0.09 * 0.8, 0.03),
            // A prism of twelve sides has 0.955 times the cross-sectional area of the bar, and the round ends add 0.016
            // to the ratio.
            (bar([Vec3::default(), Vec3::new(0.0, 0.0, 1.0)]), PI * PLATE * PLATE, 0.04),
            (bar([Vec3::default(), Vec3::new(0.6, 0.0, 0.8)]), PI * PLATE * PLATE, 0.04),
        ] {
            assert!(is_closed(&mesh));
            assert!((volume(&mesh) / exact - 1.0).abs() < near, "{}", volume(&mesh) / exact);
        }
    }
}
