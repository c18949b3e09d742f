//! Assembly of a stack in the plane along its barrels.
//!
//! Barrel profiles lie on the rails of racks, which stand on the profiles below or on the posts of the racks below. The
//! model is a slice one barrel wide: a rack that carries several barrels side by side contributes a share of its mass
//! to each slice. A rail is a tube: its upper side carries the barrel above, and its lower side lies on the barrel
//! below or on the ground. The contacts of the tube act at nodes, as in Candia, de la Llera and Almazán (2008), or on
//! one contact element, at the point where rail and barrel touch. Posts stand beside the barrels, at the corners of a
//! rack: they touch racks and the ground, but no barrel.

use barrelstack_dynamics::shape::{BarrelProfile, Polygon, PolygonError};
use barrelstack_dynamics::{BodyId, Shape, Vec2, math};

use super::builder::{Builder, Draft};
use super::solid::{Seat, Solid, row};
use super::transverse::TUBE_CORNER;
use super::{AssembleError, PartKind, posts};
use crate::scenario::{Basis, Posts, Rack, RackKind, SeatContact, StackSpec};

/// Radius (m) to which the chime of a barrel is rounded. The value is an assumption.
pub const CHIME_RADIUS: f64 = 0.01;

/// Cosine of an angle (73°). The nodes on a face of a rail carry a contact only if the angle between the normal of the
/// contact and the normal of the face is at most this angle.
///
/// Contacts at larger angles, such as those of the chime of a barrel that has slid off, are found without the nodes.
/// Cosines from 0 to 0.7 were compared on seven stacks, including the worst known cases; this cosine gave the smallest
/// residual of the energy balance, at most 8.3e-5.
const WIDEST: f64 = 0.3;

/// Adds all levels. Returns the height (m) of the stack and the displacement (m) beyond which a rack is no longer
/// supported.
pub(super) fn build(builder: &mut Builder<'_>) -> Result<(f64, f64), AssembleError> {
    let spec = builder.spec;
    let (rack, barrel) = (&spec.rack, &spec.barrel);
    let profile = BarrelProfile::new(barrel.length, barrel.head_diameter, barrel.bilge_diameter)
        .and_then(|sharp| sharp.rounded(CHIME_RADIUS))
        .ok_or_else(|| {
            AssembleError::Stack(format!(
                "a barrel in longitudinal section needs 0 < head_diameter < bilge_diameter and room for a \
                 chime with a radius of {CHIME_RADIUS} m, found diameters of {} m and {} m",
                barrel.head_diameter, barrel.bilge_diameter
            ))
        })?;
    if rack.rail_half_spacing + 0.5 * rack.rail_width >= profile.half_length {
        return Err(AssembleError::Stack(format!(
            "the rails at ± {} m lie beyond the ends of a barrel {} m long: set a smaller stack.rack.rail_half_spacing",
            rack.rail_half_spacing, barrel.length
        )));
    }
    let seating = Seating::of(&profile, rack)?;
    let level_pitch = rack.posts.map_or(rack.clearance + 2.0 * seating.seat, |posts| posts.height);
    let pitch = rack_pitch(rack, barrel.length, spec.gap);
    let racks = spec.racks_per_level();
    let mut below: Vec<Vec<BodyId>> = vec![Vec::new(); racks as usize];
    for level in 1..=spec.levels {
        let underside = f64::from(level - 1) * level_pitch;
        for column in 1..=racks {
            let supports = std::mem::take(&mut below[column as usize - 1]);
            let deep = f64::from(rack.barrels_deep);
            let middle = (f64::from(column) - 0.5 * f64::from(racks + 1)) * deep * pitch;
            let (rack_id, barrels) = add_rack(
                builder,
                &profile,
                (level, column),
                Vec2::new(middle, underside),
                &seating,
                supports,
            )?;
            below[column as usize - 1] = match rack.kind {
                RackKind::OnBarrels => barrels,
                RackKind::OnRacks => vec![rack_id],
            };
        }
    }
    let below_top = f64::from(spec.levels - 1) * level_pitch;
    Ok(match rack.posts {
        Some(posts) => (
            below_top + rack.clearance + seating.seat + profile.bilge_radius,
            posts::reach(rack, posts.half_spacing_along),
        ),
        None => (below_top + level_pitch, profile.half_length - rack.rail_half_spacing),
    })
}

/// Returns the spacing (m) of racks along the barrels, divided by the number of barrels that a rack carries end to end.
///
/// The spacing follows from the length of the barrels, or from the length of the frame if the frame is longer.
fn rack_pitch(rack: &Rack, barrel: f64, gap: f64) -> f64 {
    let pitch = barrel + gap;
    let deep = f64::from(rack.barrels_deep);
    rack.posts.map_or(pitch, |posts| {
        let frame = 2.0 * (posts.half_spacing_along + posts::cup(rack));
        pitch.max(((deep - 1.0) * pitch + frame + gap) / deep)
    })
}

/// Adds one rack with its barrels end to end, and returns the IDs of the rack and of the barrels.
fn add_rack(
    builder: &mut Builder<'_>,
    profile: &BarrelProfile,
    (level, column): (u32, u32),
    underside: Vec2,
    seating: &Seating,
    supports: Vec<BodyId>,
) -> Result<(BodyId, Vec<BodyId>), AssembleError> {
    let spec = builder.spec;
    let rack = &spec.rack;
    let pitch = spec.barrel.length + spec.gap;
    let deep = rack.barrels_deep;
    let places: Vec<f64> =
        (0..deep).map(|i| (f64::from(i) - 0.5 * f64::from(deep - 1)) * pitch).collect();

    let (name, mass, offset) = builder.rack_at(level, column);
    let mass = mass / f64::from(rack.barrels);
    let outer = places.last().copied().unwrap_or(0.0);
    let half_width =
        outer + rack.posts.map_or(rack.rail_half_spacing, |posts| posts.half_spacing_along);
    let shape = |problem: PolygonError| AssembleError::Shape {
        body: name.clone(),
        problem: problem.to_string(),
    };
    // In a rack with posts, the rails lie above the underside of the frame, at a distance equal to the stroke of the
    // seats. The rails carry load once the stroke is used up.
    let lift = rack.posts.map_or(0.0, |_| rack.seat_stroke.min(rack.beam_height));
    let on_barrels = rack.posts.is_none() && level > 1;
    let rail = |(barrel, place, side): (usize, f64, f64)| {
        let x = place + side * rack.rail_half_spacing;
        // Rails on barrels follow the incline of the barrels; the floor and posts are level.
        let rise = side * seating.rise;
        let (bottom, top) = (if on_barrels { rise } else { lift }, rack.clearance + rise);
        let tube = Polygon::rectangle(rack.rail_width, top - bottom, corner_of(rack))?;
        let at = Vec2::new(x, 0.5 * (bottom + top));
        let seat = if rack.posts.is_some() { Seat::Barrel(barrel) } else { Seat::Along(barrel) };
        let mut rail = Solid::exact(Shape::Polygon(tube), at, seat);
        if has_rows(spec) {
            rail.widest = WIDEST;
            if rack.posts.is_none() {
                rail.below = noded_face(rack, x, bottom, -1.0);
            }
            rail.above = noded_face(rack, x, top, 1.0);
        }
        Ok(rail)
    };
    let rails = places
        .iter()
        .enumerate()
        .flat_map(|(barrel, place)| [-1.0, 1.0].map(|side| (barrel, *place, side)));
    let mut solids = rails.map(rail).collect::<Result<Vec<Solid>, _>>().map_err(shape)?;
    if let Some(posts) = &rack.posts {
        solids.extend(frame(rack, posts, outer, level).map_err(shape)?);
    }
    let rack_id = builder.add(Draft {
        name,
        kind: PartKind::Rack,
        level: Some(level),
        column,
        mass,
        inertia: None,
        position: Vec2::new(underside.x + offset, underside.z),
        size: half_width,
        solids,
        carrier: None,
        supports,
    });

    let origin = Vec2::new(underside.x + offset, underside.z + rack.clearance + seating.seat);
    let shape = Shape::BarrelProfile(*profile);
    let at = (level, column);
    let size = profile.bilge_radius;
    let barrels = builder.add_barrels(rack_id, at, (origin, &places), (&shape, size));
    for barrel in &barrels {
        builder.bodies[*barrel].pose.orientation = rack.incline;
    }
    Ok((rack_id, barrels))
}

/// Returns `true` if rails carry rows of nodes.
///
/// A barrel touches the rounded edge of a rail over a few millimeters only, and a rail on the ground rests on its two
/// corners. If constants are stated per seat, each of these contacts is therefore one element, and rails carry no rows.
pub(super) fn has_rows(spec: &StackSpec) -> bool {
    spec.rack.contact == SeatContact::Nodes && spec.interfaces.barrel_rack.basis != Basis::Seat
}

/// Returns the parts of a rack with posts that stand beside the barrels: the tube from post to post, the posts, and
/// the cups over the posts below.
///
/// `outer` is the distance (m) of the outer barrels from the middle of the rack.
fn frame(rack: &Rack, posts: &Posts, outer: f64, level: u32) -> Result<Vec<Solid>, PolygonError> {
    let spacing = outer + posts.half_spacing_along;
    let length = 2.0 * (spacing + posts::cup(rack));
    let corner = TUBE_CORNER.min(0.25 * rack.beam_height);
    let mut solids = vec![Solid::exact(
        Shape::Polygon(Polygon::rectangle(length, rack.beam_height, corner)?),
        Vec2::new(0.0, 0.5 * rack.beam_height),
        Seat::OnSupports,
    )];
    solids.extend(posts::posts_and_cups(rack, posts, spacing, level)?);
    Ok(solids.into_iter().map(|solid| Solid { out_of_plane: true, ..solid }).collect())
}

/// Returns the nodes of the lower or upper face of a rail: their positions (m) and tributary lengths (m).
///
/// A row of nodes lies along the flat part, and one node in the middle of each rounded end. The rail is centered at `x`
/// (m), and the face is at height `z` (m). `outward` is 1 for the upper face, and −1 for the lower face.
fn noded_face(rack: &Rack, x: f64, z: f64, outward: f64) -> Vec<(Vec2, f64)> {
    let corner = corner_of(rack);
    let half = 0.5 * rack.rail_width - corner;
    let amid = corner * std::f64::consts::FRAC_1_SQRT_2;
    let end = |side: f64| {
        let place = Vec2::new(x + side * (half + amid), z - outward * (corner - amid));
        (place, std::f64::consts::FRAC_PI_2 * corner)
    };
    // The first node defines the position of the face.
    let mut nodes = row(rack.node_spacing, x, half, z);
    nodes.extend([-1.0, 1.0].map(end));
    nodes
}

/// Returns the corner radius (m) of a rail.
fn corner_of(rack: &Rack) -> f64 {
    TUBE_CORNER.min(0.25 * rack.rail_width)
}

/// Position of a barrel, which may be inclined, relative to its two rails.
struct Seating {
    /// Height (m) of the center of the barrel above the mean height of the tops of its rails.
    seat: f64,
    /// Height (m) of the right rail above the mean height of both rails; the left rail is below the mean by the same
    /// amount.
    ///
    /// A rail lies between a barrel below and a barrel above, which have the same inclination. Since barrels are
    /// symmetric, the top and the underside of the rail shift by the same amount, so that the rail keeps its thickness.
    rise: f64,
}

impl Seating {
    /// Computes the position of a barrel on its rails. Because staves slope, a rail touches the barrel with its rounded
    /// inner corner.
    fn of(profile: &BarrelProfile, rack: &Rack) -> Result<Self, AssembleError> {
        let corner = corner_of(rack);
        let across = rack.rail_half_spacing - 0.5 * rack.rail_width + corner;
        let apart = profile.stave_radius + corner;
        let (sin, cos) = math::sin_cos(rack.incline);
        // Distance from the center of the barrel to the center of curvature of its staves.
        let up = profile.stave_radius - profile.bilge_radius;
        if up * sin.abs() >= across {
            return Err(AssembleError::Stack(format!(
                "a barrel inclined by {:.1}° leans on the outer corners of its rails: reduce stack.rack.incline to at \
                 most {:.1}°, or increase stack.rack.rail_half_spacing",
                rack.incline.to_degrees(),
                math::asin((across / up).min(1.0)).to_degrees()
            )));
        }
        let depth = |side: f64| {
            let x = side * across + up * sin;
            (apart * apart - x * x).sqrt() - corner - up * cos
        };
        let (left, right) = (depth(-1.0), depth(1.0));
        Ok(Self { seat: 0.5 * (left + right), rise: 0.5 * (left - right) })
    }
}
