//! Closest points of two convex bodies.
//!
//! The result in each lane is bit-identical to that of a single run. The usual case, a tube (capsule) on the stave of a
//! barrel, is computed in all lanes together; for all others, lanes are processed one after the other.

use super::barrel::Barrel;
use super::rounded::Hull;
use crate::real::{Mask as _, Real};
use crate::shape::Gap;
use crate::space::{Linear, Rotation3, Spatial, Vec3};

/// Closest or deepest points of two bodies, in the frame of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Distance (m) between the surfaces; negative where they overlap.
    pub distance: f64,
    /// Unit normal that points out of the target.
    pub normal: Vec3,
    /// The closest or deepest point (m) of the contactor's surface.
    pub point: Vec3,
    /// Number of distance and support evaluations.
    pub evaluations: u32,
    /// `true` if the search converged.
    pub converged: bool,
}

/// Maximum number of evaluations of the search along an axis. Bisection alone needs 50. False position may converge
/// more slowly than bisection, for example where the slope is constant to nine digits up to a kink. Therefore, every
/// third evaluation bisects the interval, unless the interval has halved in the last three evaluations.
const MOST_ALONG: u32 = 180;

/// Result of a search along a segment: the position, from −1 at `middle − half` to 1 at `middle + half`; the gap at
/// this position; the number of evaluations; and `true` if the gap is the minimum.
type Along = (f64, Gap<Spatial>, u32, bool);

/// Tolerance within which the slope `n · half` of a gap along a segment counts as zero, as a fraction of the length of
/// `half`.
const FLAT: f64 = 1e-14;
/// Maximum number of steps of Halley's method along a segment before the slower search takes over.
const MOST_HALLEY: u32 = 6;
/// Length of a step of Halley's method, as a fraction of half the segment, below which the search ends. The error that
/// remains after a step is proportional to the third power of the step; here it is below the rounding error.
const LAST_HALLEY: f64 = 1e-5;

/// Returns the point of a segment that is closest to a hull. For a tube there is a closed form. For the stave of a
/// barrel, which is the usual case, Halley's method converges in two or three steps. Since the gap is convex, the
/// result is the minimum if the gap does not decrease toward either side. Otherwise [`along_axis`] searches for the
/// minimum.
#[inline(always)]
pub(super) fn along(hull: &Hull, middle: Vec3, half: Vec3) -> Along {
    // `inline(always)`, because a closure that is not inlined loses the target feature.
    let found = match hull {
        Hull::Barrel(barrel) => halley(
            middle,
            half,
            #[inline(always)]
            |point| barrel.derivatives(point, half),
        ),
        Hull::Capsule(capsule) => Some(capsule.nearest_on_line(middle, half).clamp(-1.0, 1.0)),
        Hull::Block(_) => None,
    };
    if let Some(place) = found {
        let gap = hull.gap(middle + half * place);
        let (slope, flat) = (gap.normal.dot(half), FLAT * half.length());
        if (slope <= flat || place == -1.0) && (slope >= -flat || place == 1.0) {
            return (place, gap, 1, true);
        }
    }
    along_axis(
        #[inline(always)]
        |point| hull.gap(point),
        middle,
        half,
    )
}

/// Searches as [`along`] does for a barrel, in all lanes together. Returns the position, the gap, and the lanes in
/// which both are bit-identical to the result of [`along`]; in all other lanes, the slower search is needed.
#[inline(always)]
pub(super) fn along_barrel<R: Real>(
    barrel: &Barrel<R>,
    middle: Vec3<R>,
    half: Vec3<R>,
) -> (R, Gap<Spatial<R>>, R::Mask) {
    let one = R::splat(1.0);
    let mut place = (-middle.dot(half) / half.dot(half)).clamp_magnitude(one);
    let (mut done, mut failed) = (R::Mask::default(), R::Mask::default());
    for _ in 0..MOST_HALLEY {
        let [first, second, third] = barrel.derivatives(middle + half * place, half);
        let step = first * second / (second * second - R::splat(0.5) * first * third);
        let next = (place - step).clamp_magnitude(one);
        let moved = (next - place).abs();
        // A NaN is not less than or equal to itself.
        failed = failed | (!done & !step.le(step));
        place = R::select(done, place, next);
        done = done | moved.lt(R::splat(LAST_HALLEY));
        if done.all() {
            break;
        }
    }
    let gap = barrel.gap(middle + half * place);
    let (slope, flat) = (gap.normal.dot(half), R::splat(FLAT) * half.length());
    let not_lower_left = slope.le(flat) | place.le(-one);
    let not_lower_right = (-flat).le(slope) | one.le(place);
    (place, gap, done & !failed & not_lower_left & not_lower_right)
}

/// Finds the minimum of a quantity along a segment by Halley's method, from the first three derivatives of the
/// quantity. Exchanging the ends of the segment gives a bit-identical result.
#[inline(always)]
fn halley(middle: Vec3, half: Vec3, derivatives: impl Fn(Vec3) -> [f64; 3]) -> Option<f64> {
    let mut place = (-middle.dot(half) / half.dot(half)).clamp(-1.0, 1.0);
    for _ in 0..MOST_HALLEY {
        let [first, second, third] = derivatives(middle + half * place);
        let step = first * second / (second * second - 0.5 * first * third);
        let next = (place - step).clamp(-1.0, 1.0);
        let moved = (next - place).abs();
        place = next;
        if moved < LAST_HALLEY {
            return Some(place);
        }
    }
    None
}

/// Returns the same as [`along`] for any convex body, by a search that needs only the gap.
///
/// The distance is convex along the segment, so its slope `n · half` never decreases and has one zero, which is found
/// by false position with bisection as a safeguard. Exchanging the ends of the segment gives a bit-identical result.
#[inline(always)]
fn along_axis(gap: impl Fn(Vec3) -> Gap<Spatial>, middle: Vec3, half: Vec3) -> Along {
    let (first, falling) = slope(&gap, middle, half, -1.0);
    if falling >= 0.0 {
        return (-1.0, first, 1, true);
    }
    let (last, rising) = slope(&gap, middle, half, 1.0);
    if rising <= 0.0 {
        return (1.0, last, 2, true);
    }
    // Position and slope at both ends of the bracket.
    let (mut low, mut high) = ((-1.0, falling), (1.0, rising));
    let flat = 1e-15 * half.length();
    let (mut kept, mut best, mut wide) = (0, (-1.0, first), 2.0);
    for evaluation in 3..MOST_ALONG {
        let secant = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let narrowed: f64 = high.0 - low.0;
        // Every third evaluation bisects the interval, unless the interval has halved since the last check.
        let slow = evaluation % 3 == 0 && narrowed > 0.5 * wide;
        if evaluation % 3 == 0 {
            wide = if slow { 0.5 * narrowed } else { narrowed };
        }
        let inside = secant > low.0 && secant < high.0;
        let place = if inside && !slow { secant } else { 0.5 * (low.0 + high.0) };
        let (here, slope) = slope(&gap, middle, half, place);
        best = (place, here);
        if slope.abs() <= flat || narrowed <= 8.0 * f64::EPSILON {
            return (place, here, evaluation, true);
        }
        // The slope at an end that is kept twice is halved (the Illinois rule), so that both ends approach the zero.
        if slope < 0.0 {
            low = (place, slope);
            if kept == 1 {
                high.1 *= 0.5;
            }
            kept = 1;
        } else {
            high = (place, slope);
            if kept == -1 {
                low.1 *= 0.5;
            }
            kept = -1;
        }
    }
    (best.0, best.1, MOST_ALONG, false)
}

/// Returns the gap at a position on a segment, and the slope of the gap along the segment.
#[inline(always)]
fn slope(
    gap: &impl Fn(Vec3) -> Gap<Spatial>,
    middle: Vec3,
    half: Vec3,
    place: f64,
) -> (Gap<Spatial>, f64) {
    let gap = gap(middle + half * place);
    (gap, gap.normal.dot(half))
}

/// A barrel with its pose in the frame of another barrel.
#[derive(Clone, Copy)]
struct Set<'a> {
    barrel: &'a Barrel,
    center: Vec3,
    rotation: Rotation3,
}

/// Support point of a core, with the local curvature of its surface.
struct Support {
    /// The support point (m).
    point: Vec3,
    /// Radius of curvature (m) that is common to all tangential directions: the radius of the stave along the barrel,
    /// or zero at the chime.
    along: f64,
    /// Additional radius of curvature (m) in the direction `around`.
    across: f64,
    /// Unit vector in the circumferential direction.
    around: Vec3,
    /// Component β of the direction for which this support point was computed; see [`Set::support`].
    outward: f64,
}

impl Set<'_> {
    fn axis(&self) -> Vec3 {
        self.rotation.apply(Vec3::new(1.0, 0.0, 0.0))
    }

    /// Returns the point (m) of the core that is nearest to a point outside of the core.
    fn project(&self, point: Vec3) -> Vec3 {
        let gap = self.barrel.gap(self.rotation.unapply(point - self.center));
        let depth = (gap.distance + self.barrel.rounding).max(0.0);
        point - self.rotation.apply(gap.normal) * depth
    }

    /// Returns the support point in a unit direction, with the curvature of the surface there.
    ///
    /// The support function is `h = R |n| − a β` on the stave and `h = l |α| + r β` on the chime. Here α and β are the
    /// components of the direction `n` along and across the axis, `l` is half the length of the core, `r` the radius of
    /// its heads, and `R` and `a` are as in [`Barrel`]. The curvature follows from the second derivatives: the second
    /// derivative of `|n|` is 1 in every tangential direction, and the second derivative of β is `1/β` around the
    /// axis.
    fn support(&self, direction: Vec3) -> Support {
        let local = self.rotation.unapply(direction);
        let barrel = self.barrel;
        let outward = (local.y * local.y + local.z * local.z).sqrt();
        let corner = barrel.head_radius + barrel.stave_offset;
        let on_stave = local.x.abs() * corner <= barrel.half_length * outward;
        let inverse = 1.0 / outward.max(1e-300);
        let around = self.rotation.apply(Vec3::new(0.0, -local.z * inverse, local.y * inverse));
        let (along, across) = if on_stave {
            (barrel.stave_radius, -barrel.stave_offset * inverse)
        } else {
            (0.0, barrel.head_radius * inverse)
        };
        let point = self.center + self.rotation.apply(barrel.furthest(local));
        Support { point, along, across, around, outward }
    }

    /// Returns the support point in the axial direction of a head. All points of the head are equally far in this
    /// direction; the point of the rim that is nearest to `toward` (m) is used.
    fn on_rim(&self, direction: Vec3, toward: Vec3) -> Support {
        let (barrel, toward) = (self.barrel, self.rotation.unapply(toward - self.center));
        let radial = Vec3::new(0.0, toward.y, toward.z).unit_or(Vec3::new(0.0, 0.0, 1.0));
        let side = if direction.dot(self.axis()) < 0.0 { -1.0 } else { 1.0 };
        let rim = Vec3::new(side * barrel.half_length, 0.0, 0.0) + radial * barrel.head_radius;
        Support {
            point: self.center + self.rotation.apply(rim),
            along: 0.0,
            across: barrel.head_radius / HEAD,
            around: self.rotation.apply(Vec3::new(0.0, -radial.z, radial.y)),
            outward: HEAD,
        }
    }
}

/// Angle (rad) to the axis below which a direction counts as normal to the head.
const HEAD: f64 = 1e-7;

/// Separation of two cores in a direction.
struct Separation {
    /// Vector (m) from the support point of the target to the support point of the contactor.
    offset: Vec3,
    /// Distance (m) between the supporting planes.
    distance: f64,
    supports: [Support; 2],
}

fn separation(target: &Set<'_>, contactor: &Set<'_>, normal: Vec3) -> Separation {
    let mut supports = [target.support(normal), contactor.support(-normal)];
    // Where a whole head bears, use the point of its rim nearest to the other body.
    if supports[0].outward < HEAD {
        supports[0] = target.on_rim(normal, supports[1].point);
    }
    if supports[1].outward < HEAD {
        supports[1] = contactor.on_rim(-normal, supports[0].point);
    }
    let offset = supports[1].point - supports[0].point;
    Separation { offset, distance: offset.dot(normal), supports }
}

/// Relative length of the tangential part of [`Separation::offset`] below which the error of a normal is a rounding
/// error. The length is divided by the sum of the length of `offset` and the distance between the centers of the
/// barrels.
const TANGENTIAL: f64 = 4e-15;
/// Newton step (rad) below which a normal is exact. Near the edge of a head the support point moves much faster than
/// the direction turns, so rounding errors affect its position long before they affect the normal.
const TURN: f64 = 1e-11;
/// Maximum number of Newton steps before projections are used.
const MOST_STEPS: u32 = 25;
/// Maximum number of attempts with Newton's method. After a failed attempt, projections determine the start of the next
/// one.
const MOST_HELP: u32 = 40;

/// Returns the closest points of two barrels; the target is at the origin.
///
/// The normal is the direction `n` that maximizes `g(n) = n · c − h₁(n) − h₂(−n)`, the distance between the supporting
/// planes of the cores. The maximum is the distance between the cores; `g` is concave where the cores are separate.
/// Where the closest point lies on a head, `g` has a kink, so heads are tested first; otherwise Newton's method runs on
/// the sphere of directions. It starts from projections from one core to the other and back. Projections also take over
/// where Newton's method does not ascend, since they always approach the solution.
pub(super) fn barrels(
    target: &Barrel,
    contactor: &Barrel,
    center: Vec3,
    rotation: Rotation3,
) -> Closest {
    let one = Set { barrel: target, center: Vec3::default(), rotation: Rotation3::identity() };
    let other = Set { barrel: contactor, center, rotation };
    let grown = target.rounding + contactor.rounding;
    let found = |normal: Vec3, point: Vec3, distance: f64, evaluations, converged| Closest {
        distance: distance - grown,
        normal,
        point: point - normal * contactor.rounding,
        evaluations,
        converged,
    };
    let mut evaluations = 0;
    for (bearing, resting, sense) in [(&one, &other, 1.0), (&other, &one, -1.0)] {
        if let Some((normal, point, distance)) = on_head(bearing, resting) {
            // The point belongs to the body that rests on the head.
            let at = if sense > 0.0 { point } else { point - normal * distance };
            return found(normal * sense, at, distance, 4, true);
        }
        evaluations += 2;
    }

    if let Some((normal, point, distance)) = rims_crossed(&one, &other) {
        return found(normal, point, distance, evaluations + 2, true);
    }
    let mut from = one.project(center);
    let mut to = other.project(from);
    let mut normal = (to - from).unit_or(center.unit_or(Vec3::new(0.0, 0.0, 1.0)));
    for _ in 0..MOST_HELP {
        let mut best = separation(&one, &other, normal);
        for _ in 0..MOST_STEPS {
            evaluations += 1;
            let tangential = best.offset - normal * best.distance;
            let scale = best.offset.length() + center.length();
            let step = newton(normal, &best, tangential);
            if tangential.length() <= TANGENTIAL * scale || step.length() <= TURN {
                let (normal, point, distance) = polished(&one, &other, normal, &best);
                return found(normal, point, distance, evaluations, true);
            }
            let Some((next, reached)) = ascend(&one, &other, normal, &best, tangential, step)
            else {
                break;
            };
            (normal, best) = (next, reached);
        }
        // Converged if only rounding prevents an ascent.
        let tangential = best.offset - normal * best.distance;
        if newton(normal, &best, tangential).length() <= 2e-9 {
            let (normal, point, distance) = polished(&one, &other, normal, &best);
            return found(normal, point, distance, evaluations, true);
        }
        for _ in 0..8 {
            from = one.project(to);
            to = other.project(from);
            evaluations += 2;
        }
        let offset = to - from;
        if offset.length() <= 1e-9 * grown {
            // The cores overlap: there is no closest pair, and the best direction so far is returned.
            break;
        }
        normal = offset.unit_or(normal);
    }
    let best = separation(&one, &other, normal);
    found(normal, best.supports[1].point, best.distance, evaluations, false)
}

/// Returns the closest point of one core to a head of another, if this point lies in front of the head. The result is
/// the normal out of the head, the point of the core, and the distance (m).
fn on_head(bearing: &Set<'_>, resting: &Set<'_>) -> Option<(Vec3, Vec3, f64)> {
    let axis = bearing.axis();
    let side = if (resting.center - bearing.center).dot(axis) < 0.0 { -1.0 } else { 1.0 };
    let normal = axis * side;
    let support = resting.support(-normal);
    let head = bearing.center + normal * bearing.barrel.half_length;
    let offset = support.point - head;
    let distance = offset.dot(normal);
    let aside = (offset - normal * distance).length();
    (distance >= 0.0 && aside <= bearing.barrel.head_radius).then_some((
        normal,
        support.point,
        distance,
    ))
}

/// Returns the closest points of the rims of two heads that face each other, if the rims cross in projection along the
/// axis. The result is the normal out of the target, the point of the contactor's core and the distance (m).
///
/// The projections of such heads overlap in a lens. The heads are closest at a corner of the lens, unless the rim of
/// one lies inside the other. The solution uses Newton's method on the angles of both points. For both barrels, the
/// normal must lie between the normals of the head and of the stave at the rim; otherwise another feature is closer.
fn rims_crossed(target: &Set<'_>, contactor: &Set<'_>) -> Option<(Vec3, Vec3, f64)> {
    let side = contactor.center.x.signum();
    let facing = contactor.axis() * -(side * contactor.axis().x.signum());
    if facing.x.abs() < 0.99 {
        return None;
    }
    let (radius, other_radius) = (target.barrel.head_radius, contactor.barrel.head_radius);
    let head = Vec3::new(side * target.barrel.half_length, 0.0, 0.0);
    let other_head = contactor.center + facing * contactor.barrel.half_length;
    let aside = Vec3::new(0.0, other_head.y, other_head.z);
    let apart = aside.length();
    let along = 0.5 * (apart + (radius * radius - other_radius * other_radius) / apart);
    let square = radius * radius - along * along;
    // Crossings of nearly coincident rims are ill-conditioned.
    if apart < 1e-6 || square <= 1e-6 * radius * radius {
        return None;
    }
    let toward = aside * (1.0 / apart);
    let across = Vec3::new(0.0, -toward.z, toward.y);
    let axis = Vec3::new(side, 0.0, 0.0);
    let mut best: Option<(Vec3, Vec3, f64)> = None;
    for root in [square.sqrt(), -square.sqrt()] {
        // Unit vectors from the centers of both heads to their points.
        let mut out = (toward * along + across * root) * (1.0 / radius);
        let corner = head + out * radius - other_head;
        let mut other_out =
            (corner - facing * corner.dot(facing)).unit_or(Vec3::new(0.0, 0.0, 1.0));
        let mut separation = Vec3::default();
        for _ in 0..12 {
            separation = other_head + other_out * other_radius - head - out * radius;
            // Tangents of both rims, per radian.
            let (slope, other_slope) =
                (axis.cross(out) * radius, facing.cross(other_out) * other_radius);
            let (a, c) = (
                radius * radius + separation.dot(out) * radius,
                other_radius * other_radius - separation.dot(other_out) * other_radius,
            );
            let b = -slope.dot(other_slope);
            let (f, g) = (-separation.dot(slope), separation.dot(other_slope));
            let determinant = a * c - b * b;
            let (turn, other_turn) = ((b * g - c * f) / determinant, (b * f - a * g) / determinant);
            if turn.abs().max(other_turn.abs()) > 0.5 {
                return None;
            }
            out = (out + axis.cross(out) * turn).unit_or(out);
            other_out = (other_out + facing.cross(other_out) * other_turn).unit_or(other_out);
            if turn.abs().max(other_turn.abs()) < 1e-15 {
                break;
            }
        }
        let distance = separation.length();
        let normal = separation.unit_or(axis);
        let borne = |barrel: &Barrel, outward: f64, radial: f64| {
            let corner = barrel.head_radius + barrel.stave_offset;
            radial >= -1e-12 && outward > 0.0 && radial * barrel.half_length <= outward * corner
        };
        if borne(target.barrel, normal.dot(axis), normal.dot(out))
            && borne(contactor.barrel, -normal.dot(facing), -normal.dot(other_out))
            && best.is_none_or(|best| distance < best.2)
        {
            best = Some((normal, other_head + other_out * other_radius, distance));
        }
    }
    best
}

/// Returns the normal, the point of the contactor's core and the distance (m), computed from the more accurate of the
/// two support points. A support point on a rim is inaccurate where the direction is nearly axial, since the point
/// then moves much faster than the direction turns.
fn polished(
    target: &Set<'_>,
    contactor: &Set<'_>,
    normal: Vec3,
    here: &Separation,
) -> (Vec3, Vec3, f64) {
    let [from, to] = &here.supports;
    let (from, to) = if from.outward < to.outward {
        (target.project(to.point), to.point)
    } else {
        (from.point, contactor.project(from.point))
    };
    // At smaller distances the difference of two points has no reliable direction.
    if here.distance < 1e-6 {
        return (normal, here.supports[1].point, here.distance);
    }
    let offset = to - from;
    (offset.unit_or(normal), to, offset.length())
}

/// Returns a Newton step (rad) on the sphere of directions, toward the largest separation of the cores.
fn newton(normal: Vec3, here: &Separation, tangential: Vec3) -> Vec3 {
    let slope = tangential.length();
    let first = tangential.unit_or(normal);
    let second = normal.cross(first);
    // Curvatures of both cores, and of the sphere.
    let mut matrix = [here.distance.abs(), 0.0, here.distance.abs()];
    for support in &here.supports {
        let (u, v) = (support.around.dot(first), support.around.dot(second));
        matrix[0] += support.along + support.across * u * u;
        matrix[1] += support.across * u * v;
        matrix[2] += support.along + support.across * v * v;
    }
    let [a, b, c] = matrix;
    let determinant = a * c - b * b;
    if determinant > 1e-14 * (a * c).abs() && a > 0.0 {
        first * (slope * c / determinant) - second * (slope * b / determinant)
    } else {
        first * (slope / a.max(1e-3))
    }
}

/// Returns a step that has been shortened until it increases the separation of the cores.
fn ascend(
    target: &Set<'_>,
    contactor: &Set<'_>,
    normal: Vec3,
    here: &Separation,
    tangential: Vec3,
    step: Vec3,
) -> Option<(Vec3, Separation)> {
    // No step turns by more than half a radian, since the curvatures change with the direction.
    let mut share = 0.5 / step.length().max(0.5);
    for _ in 0..40 {
        let next = (normal + step * share).unit_or(normal);
        let there = separation(target, contactor, next);
        let rounding = 1e-15 * (contactor.center.length() + there.offset.length());
        let off = there.offset - next * there.distance;
        if there.distance > here.distance + rounding
            || (there.distance >= here.distance - rounding && off.length() < tangential.length())
        {
            return Some((next, there));
        }
        share *= 0.5;
    }
    None
}
