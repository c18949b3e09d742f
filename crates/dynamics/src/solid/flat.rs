//! Line and face contacts of two bounded solids: two parallel tubes (capsules), a tube on a head or on the face of a
//! block, and a head on a head or on the face of a block.
//!
//! All computations are scalar, as in [`closest`](super::closest).

use super::barrel::Barrel;
use super::block::Block;
use super::{Capsule, Hull};
use crate::shape::{Gap, Shares, Slopes};
use crate::space::{Linear, Quaternion, Rotation3, Spatial, Vec3, Wrench};

/// Line or face contact of two bodies, described at the middle of the contact patch, in the frame of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flat {
    /// Point (m) of the contactor's surface at the middle of the patch.
    pub(super) point: Vec3,
    pub(super) gap: Gap<Spatial>,
    /// Weights of the deepest point and of the other parts of the patch, as in [`Spread`](crate::shape::Spread).
    pub(super) shares: Shares<f64>,
    pub(super) radius: f64,
    /// Unit vectors along the patch; for a line, only the first is used.
    pub(super) axes: [Vec3; 2],
}

/// Sine of the maximum angle between two solids that touch along a line or over a face.
pub(super) const WIDEST: f64 = 0.1;
/// Extent (m) of a line or face from its middle, above which the line or face has full weight.
const LONG: f64 = 0.05;

/// Returns `3 u² − 2 u³` (smoothstep), where `u` is first clamped to the range from 0 to 1.
pub(super) fn smooth(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * (3.0 - u - u)
}

/// Returns the weights of a contact patch between two solids that are inclined to each other. The patch acts like
/// `springs` springs and extends `length` (m) from its middle; `sine_squared` is the squared sine of the angle between
/// the solids.
///
/// The shorter the patch, the smaller the permitted angle. If a tube is inclined to a head, its deepest point is not in
/// the part of the tube in front of the head, so the weight must decrease to zero before this part ends.
fn shares(springs: f64, sine_squared: f64, length: f64) -> Shares<f64> {
    let short = LONG / length;
    let flat = smooth(1.0 - sine_squared * (1.0 + short * short) / (WIDEST * WIDEST));
    let long = smooth(length / LONG);
    let each = (1.0 + (springs - 1.0) * long) / springs;
    Shares { deepest: 1.0 - flat * (1.0 - each), others: flat * each, aside: long }
}

/// Returns the contact patch of a contactor and a target, in the frame of the target; `None` if they touch at a point,
/// and for two blocks.
///
/// `at` is the origin (m) of the contactor, `frame` the rotation from the frame of the contactor to that of the target,
/// and `normal` the contact normal out of the target.
pub(super) fn shared(
    contactor: &Hull,
    target: &Hull,
    at: Vec3,
    frame: Rotation3,
    normal: Vec3,
) -> Option<Flat> {
    let axis = Vec3::new(1.0, 0.0, 0.0);
    match (contactor, target) {
        (Hull::Capsule(tube), Hull::Capsule(target)) => {
            side_by_side(target, tube, at, frame.apply(axis))
        }
        (Hull::Capsule(tube), target) => {
            let direction = frame.apply(axis);
            let line = along(target, tube, at, direction, normal)?;
            Some(Flat {
                point: line.center - line.normal * tube.radius,
                gap: Gap { distance: line.distance, normal: line.normal },
                shares: line.shares,
                radius: line.length,
                axes: [direction; 2],
            })
        }
        // Computed in the frame of the contactor.
        (hull, Hull::Capsule(tube)) => {
            let own = [at, axis, normal].map(|vector| frame.unapply(vector));
            let line = along(hull, tube, -own[0], own[1], own[2])?;
            let on_hull = line.center - line.normal * (line.distance + tube.radius);
            Some(Flat {
                point: at + frame.apply(on_hull),
                gap: Gap { distance: line.distance, normal: -frame.apply(line.normal) },
                shares: line.shares,
                radius: line.length,
                axes: [axis; 2],
            })
        }
        (Hull::Barrel(barrel), Hull::Barrel(target)) => {
            let lens = |aside: Vec3| {
                // Two circles overlap in a lens, whose middle lies on the line of their centers.
                let (least, most, half) =
                    overlap(target.head_radius, aside.length(), barrel.head_radius);
                let toward = aside.unit_or(Vec3::new(0.0, 0.0, 1.0));
                (toward * (0.5 * (least + most)), half)
            };
            head_on(axis, (target.half_length, target.rounding), lens, barrel, at, frame)
        }
        (Hull::Barrel(barrel), Hull::Block(block)) => {
            head_on_block(block, barrel, at, frame, normal)
        }
        // Computed in the frame of the block.
        (Hull::Block(block), Hull::Barrel(barrel)) => {
            let flat = head_on_block(
                block,
                barrel,
                frame.unapply(-at),
                frame.back(),
                frame.unapply(normal),
            )?;
            let on_block = flat.point - flat.gap.normal * flat.gap.distance;
            Some(Flat {
                point: at + frame.apply(on_block),
                gap: Gap { normal: -frame.apply(flat.gap.normal), ..flat.gap },
                axes: flat.axes.map(|axis| frame.apply(axis)),
                ..flat
            })
        }
        // Blocks are handled in `faces`, since a face of one may lie on an edge of the other.
        (Hull::Block(_), Hull::Block(_)) => None,
    }
}

/// Step (m, rad) of central differences; the derivatives are accurate to eight digits.
const HAIR: f64 = 1e-6;

/// Returns the derivatives of a patch with respect to the motion of the contactor, by finite differences between
/// neighboring poses.
pub(super) fn slopes(
    flat: &Flat,
    contactor: &Hull,
    target: &Hull,
    at: Vec3,
    frame: Rotation3,
    normal: Vec3,
) -> Slopes<Spatial> {
    let values = |flat: &Flat| [-flat.gap.distance, flat.shares.deepest, flat.shares.others];
    let here = values(flat);
    let slope = |along: &dyn Fn(f64) -> (Vec3, Rotation3)| {
        let there = |offset: f64| {
            let (at, frame) = along(offset);
            shared(contactor, target, at, frame, normal).map(|flat| (offset, values(&flat)))
        };
        // A one-sided difference where the patch ends.
        let from = there(-HAIR).unwrap_or((0.0, here));
        let to = there(HAIR).unwrap_or((0.0, here));
        let length = if to.0 > from.0 { to.0 - from.0 } else { 1.0 };
        [0, 1, 2].map(|value: usize| (to.1[value] - from.1[value]) / length)
    };
    let [x, y, z] = AXES.map(|axis| slope(&|offset| (at + axis * offset, frame)));
    let [yz, zx, xy] =
        AXES.map(|axis| slope(&|turn| (at, Quaternion::turn(axis * turn).matrix().after(frame))));
    let [mut middle, deepest, others] = [0, 1, 2].map(|value: usize| Wrench {
        force: Vec3::new(x[value], y[value], z[value]),
        moment: Vec3::new(yz[value], zx[value], xy[value]),
    });
    // Excludes the part due to the motion of the bodies at the middle: the depth decreases as the contactor moves along
    // the normal.
    middle.force += flat.gap.normal;
    middle.moment += (flat.point - at).cross(flat.gap.normal);
    Slopes { middle, deepest, others }
}

/// Returns the contact line of two tubes; the axis of the target is along `x`. Returns `None` if the tubes are not
/// nearly parallel, or do not overlap along the axis.
fn side_by_side(target: &Capsule, tube: &Capsule, at: Vec3, direction: Vec3) -> Option<Flat> {
    let sine_squared = 1.0 - direction.x * direction.x;
    if sine_squared >= WIDEST * WIDEST {
        return None;
    }
    // Measured along the contactor, on which the closest point lies: as the overlap shrinks to a point, only its middle
    // remains.
    let (least, most, radius) =
        overlap(tube.half_length, -at.dot(direction), target.half_length * direction.x.abs());
    if radius <= 0.0 {
        return None;
    }
    let center = at + direction * (0.5 * (least + most));
    let gap = target.gap(center);
    Some(Flat {
        point: center - gap.normal * tube.radius,
        gap: Gap { distance: gap.distance - tube.radius, normal: gap.normal },
        shares: shares(2.0, sine_squared, radius),
        radius,
        axes: [Vec3::new(1.0, 0.0, 0.0); 2],
    })
}

/// Returns the two ends, and half the length, of the overlap of two intervals. The first extends by `half` to either
/// side of zero, the second by `other` to either side of `center`.
fn overlap(half: f64, center: f64, other: f64) -> (f64, f64, f64) {
    let (least, most) = ((center - other).max(-half), (center + other).min(half));
    (least, most, 0.5 * (most - least))
}

/// Contact line of a tube on a head or a face.
struct Line {
    /// Middle (m) of the part of the tube's axis in front of the head or face.
    center: Vec3,
    /// Distance (m) between the surfaces at the middle.
    distance: f64,
    /// Unit normal out of the head or face.
    normal: Vec3,
    shares: Shares<f64>,
    /// Half the length (m) of the line.
    length: f64,
}

/// Magnitude of the axial component of a contact normal below which the contact is taken to be on the staves of a
/// barrel.
pub(super) const MOST_ON_STAVE: f64 = 0.5;

/// Returns the contact line of a tube on a head or a face of a solid, in the frame of that solid.
fn along(hull: &Hull, tube: &Capsule, at: Vec3, direction: Vec3, normal: Vec3) -> Option<Line> {
    match hull {
        Hull::Capsule(_) => None,
        // A tube on the stave has no part in front of a head.
        Hull::Barrel(_) if normal.x.abs() < MOST_ON_STAVE => None,
        Hull::Barrel(barrel) => {
            // The part of the tube whose axis lies in front of the circle of the head.
            let across = Vec3::new(0.0, direction.y, direction.z);
            let (a, b) = (across.dot(across), across.dot(at));
            let beyond = at.y * at.y + at.z * at.z - barrel.head_radius * barrel.head_radius;
            let root = (b * b - a * beyond).max(0.0).sqrt();
            let chord = (-b / a, root / a);
            let axis = Vec3::new(1.0, 0.0, 0.0);
            on_plane(axis, (barrel.half_length, barrel.rounding), chord, tube, at, direction)
        }
        Hull::Block(block) => {
            let axis = facing(normal);
            // The part of the tube whose axis lies in front of the face.
            let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
            for other in AXES {
                if other.dot(axis) == 0.0 {
                    let (half, slope, place) =
                        (block.half.dot(other), direction.dot(other), at.dot(other));
                    let ends = [(-half - place) / slope, (half - place) / slope];
                    if slope == 0.0 && place.abs() > half {
                        return None;
                    }
                    if slope != 0.0 {
                        least = least.max(ends[0].min(ends[1]));
                        most = most.min(ends[0].max(ends[1]));
                    }
                }
            }
            let chord = (0.5 * (least + most), 0.5 * (most - least));
            let plane = (block.half.dot(axis), block.rounding);
            on_plane(axis, plane, chord, tube, at, direction)
        }
    }
}

/// Returns the contact line of a tube on a flat face perpendicular to an axis. The face is given by the height (m) of
/// its core along the axis, and by the rounding (m) that is added to this height. The part of the tube in front of the
/// face is given by the position (m) of its middle along the tube and by half its length (m).
fn on_plane(
    axis: Vec3,
    (height, rounding): (f64, f64),
    (middle, half): (f64, f64),
    tube: &Capsule,
    at: Vec3,
    direction: Vec3,
) -> Option<Line> {
    let sine = direction.dot(axis);
    if sine.abs() >= WIDEST {
        return None;
    }
    let (least, most, length) = overlap(tube.half_length, middle, half);
    if length <= 0.0 {
        return None;
    }
    let center = at + direction * (0.5 * (least + most));
    let normal = axis * center.dot(axis).signum();
    let distance = center.dot(normal) - height - rounding - tube.radius;
    Some(Line { center, distance, normal, shares: shares(2.0, sine * sine, length), length })
}

const AXES: [Vec3; 3] =
    [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];

/// Returns the unit axis of a block that is most nearly parallel to a normal; the sign of the normal does not matter.
fn facing(normal: Vec3) -> Vec3 {
    let steep = |axis: &Vec3| normal.dot(*axis).abs();
    let [x, y, z] = AXES;
    let steeper = if steep(&y) > steep(&x) { y } else { x };
    if steep(&z) > steep(&steeper) { z } else { steeper }
}

/// Returns the contact patch of a head on the face of a block, in the frame of the block.
fn head_on_block(
    block: &Block,
    barrel: &Barrel,
    at: Vec3,
    frame: Rotation3,
    normal: Vec3,
) -> Option<Flat> {
    let axis = facing(normal);
    let middle = |aside: Vec3| {
        let (mut middle, mut radius) = (Vec3::default(), f64::INFINITY);
        for other in AXES {
            if other.dot(axis) == 0.0 {
                let (half, center) = (block.half.dot(other), aside.dot(other));
                let (least, most, length) = overlap(half, center, barrel.head_radius);
                middle += other * (0.5 * (least + most));
                radius = radius.min(length);
            }
        }
        // Near a corner, the point in the middle of the overlaps along both sides may lie outside of the head.
        (middle, radius.min(barrel.head_radius - (middle - aside).length()))
    };
    head_on(axis, (block.half.dot(axis), block.rounding), middle, barrel, at, frame)
}

/// Returns the contact patch of a barrel's head on a flat face perpendicular to an axis. The face is given by the
/// height (m) of its core along the axis, and by the rounding (m) that is added to this height.
///
/// `middle` takes the position (m) of the center of the head in the plane of the face, and returns the middle of the
/// shared area and its extent (m) from the middle.
fn head_on(
    axis: Vec3,
    (height, rounding): (f64, f64),
    middle: impl Fn(Vec3) -> (Vec3, f64),
    barrel: &Barrel,
    center: Vec3,
    frame: Rotation3,
) -> Option<Flat> {
    let along = frame.apply(Vec3::new(1.0, 0.0, 0.0));
    let cosine = along.dot(axis);
    let sine_squared = 1.0 - cosine * cosine;
    if sine_squared >= WIDEST * WIDEST {
        return None;
    }
    let normal = axis * center.dot(axis).signum();
    let outward = along * -along.dot(normal).signum();
    let head = center + outward * barrel.half_length;
    let aside = head - axis * head.dot(axis);
    let (middle, radius) = middle(aside);
    if radius <= 0.0 {
        return None;
    }
    // The point of the head's plane opposite to the middle.
    let reach = (middle - aside).dot(outward) / outward.dot(normal);
    let facing = middle + normal * (head.dot(normal) - reach);
    let distance = facing.dot(normal) - height - rounding - barrel.rounding;
    Some(Flat {
        point: facing - normal * barrel.rounding,
        gap: Gap { distance, normal },
        shares: shares(4.0, sine_squared, radius),
        radius,
        axes: [Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)].map(|axis| frame.apply(axis)),
    })
}
