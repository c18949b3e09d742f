//! A stack along its barrels: barrel profiles on the rails of racks that lie on the profiles below.
//!
//! The model is a slice one barrel wide: a rack that carries several barrels side by side lends each
//! of them its share of the mass.
//! A rail is a tube whose upper side carries the barrel above and whose lower side lies on the barrel below
//! or on the ground: with nodes, as in the paper, or exactly, with one contact element where they touch.

use barrelstack_dynamics::shape::{BarrelProfile, Polygon};
use barrelstack_dynamics::{BodyId, Shape, Vec2};

use super::builder::{Builder, Draft};
use super::solid::{Seat, Solid, row};
use super::transverse::TUBE_CORNER;
use super::{AssembleError, PartKind};
use crate::scenario::{Rack, RackKind, SeatContact};

/// Radius (m) of the round of a barrel's chime: an assumption.
const CHIME_RADIUS: f64 = 0.01;

/// Cosine of the angle (73°) to a rail's seat up to which the nodes of the seat bear; what touches the rail
/// more from the side, as the chime of a barrel that has slid off does, is tested exactly. Of cosines from 0 to 0.7
/// tried on seven stacks, the worst among them, this one left the energy books best closed: open by 8.3e-5 at most.
const WIDEST: f64 = 0.3;

/// Builds all levels; returns the height of the stack and the reach of a rack on its barrels (m).
pub(super) fn build(builder: &mut Builder<'_>) -> Result<(f64, f64), AssembleError> {
    let spec = builder.spec;
    let (rack, barrel) = (&spec.rack, &spec.barrel);
    if rack.kind == RackKind::OnRacks {
        return Err(AssembleError::Stack(
            "the longitudinal view knows racks that lie on barrels; a rack-on-rack stack carries its \
             load on posts, so use stack.view = \"transverse\", or another rack"
                .into(),
        ));
    }
    let profile = BarrelProfile::new(barrel.length, barrel.head_diameter, barrel.bilge_diameter)
        .and_then(|sharp| sharp.rounded(CHIME_RADIUS))
        .ok_or_else(|| {
            AssembleError::Stack(format!(
                "a barrel in longitudinal section needs 0 < head_diameter < bilge_diameter and room for a \
                 chime rounded by {CHIME_RADIUS} m, found {} m and {} m",
                barrel.head_diameter, barrel.bilge_diameter
            ))
        })?;
    if rack.rail_half_spacing + 0.5 * rack.rail_width >= profile.half_length {
        return Err(AssembleError::Stack(format!(
            "the rails at ± {} m lie beyond the ends of a barrel {} m long: make \
             rack.rail_half_spacing smaller",
            rack.rail_half_spacing, barrel.length
        )));
    }
    let seat = seat_height(&profile, rack);
    let level_pitch = rack.clearance + 2.0 * seat;
    let pitch = barrel.length + spec.gap;
    let racks = spec.racks_per_level();
    let mut below: Vec<Vec<BodyId>> = vec![Vec::new(); racks as usize];
    for level in 1..=spec.levels {
        let underside = f64::from(level - 1) * level_pitch;
        for column in 1..=racks {
            let supports = std::mem::take(&mut below[column as usize - 1]);
            let deep = f64::from(rack.barrels_deep);
            let middle = (f64::from(column) - 0.5 * f64::from(racks + 1)) * deep * pitch;
            below[column as usize - 1] = add_rack(
                builder,
                &profile,
                (level, column),
                Vec2::new(middle, underside),
                seat,
                supports,
            )?;
        }
    }
    let reach = profile.half_length - rack.rail_half_spacing;
    Ok((f64::from(spec.levels) * level_pitch, reach))
}

/// One rack with its barrels end to end; returns the ids of the barrels.
fn add_rack(
    builder: &mut Builder<'_>,
    profile: &BarrelProfile,
    (level, column): (u32, u32),
    underside: Vec2,
    seat: f64,
    supports: Vec<BodyId>,
) -> Result<Vec<BodyId>, AssembleError> {
    let spec = builder.spec;
    let rack = &spec.rack;
    let pitch = spec.barrel.length + spec.gap;
    let deep = rack.barrels_deep;
    let places: Vec<f64> =
        (0..deep).map(|i| (f64::from(i) - 0.5 * f64::from(deep - 1)) * pitch).collect();

    let (name, mass, offset) = builder.rack_at(level, column);
    let mass = mass / f64::from(rack.barrels);
    let half_width = places.last().copied().unwrap_or(0.0) + rack.rail_half_spacing;
    let tube = Polygon::rectangle(rack.rail_width, rack.clearance, corner_of(rack)).map_err(
        |problem| AssembleError::Shape { body: name.clone(), problem: problem.to_string() },
    )?;
    let rail = |(barrel, x): (usize, f64)| {
        let at = Vec2::new(x, 0.5 * rack.clearance);
        let mut rail = Solid::exact(Shape::Polygon(tube.clone()), at, Seat::Along(barrel));
        if rack.contact == SeatContact::Nodes {
            rail.widest = WIDEST;
            rail.below = noded_face(rack, x, 0.0, -1.0);
            rail.above = noded_face(rack, x, rack.clearance, 1.0);
        }
        rail
    };
    let rails = places.iter().enumerate().flat_map(|(barrel, place)| {
        [-1.0, 1.0].map(|side| (barrel, place + side * rack.rail_half_spacing))
    });
    let rack_id = builder.add(Draft {
        name,
        kind: PartKind::Rack,
        level: Some(level),
        column,
        mass,
        inertia: None,
        position: Vec2::new(underside.x + offset, underside.z),
        size: half_width,
        solids: rails.map(rail).collect(),
        carrier: None,
        supports,
    });

    let origin = Vec2::new(underside.x + offset, underside.z + rack.clearance + seat);
    let shape = Shape::BarrelProfile(*profile);
    let at = (level, column);
    Ok(builder.add_barrels(rack_id, at, (origin, &places), (&shape, profile.bilge_radius)))
}

/// Nodes of the lower or upper face of a rail about `x` (m) at height `z` (m): along its flat part, and one
/// amid the round of each end.
fn noded_face(rack: &Rack, x: f64, z: f64, outward: f64) -> Vec<(Vec2, f64)> {
    let corner = corner_of(rack);
    let half = 0.5 * rack.rail_width - corner;
    let amid = corner * std::f64::consts::FRAC_1_SQRT_2;
    let end = |side: f64| {
        let place = Vec2::new(x + side * (half + amid), z - outward * (corner - amid));
        (place, std::f64::consts::FRAC_PI_2 * corner)
    };
    // The first node says where the face lies.
    let mut nodes = row(rack.node_spacing, x, half, z);
    nodes.extend([-1.0, 1.0].map(end));
    nodes
}

/// Radius (m) of the corners of a rail.
fn corner_of(rack: &Rack) -> f64 {
    TUBE_CORNER.min(0.25 * rack.rail_width)
}

/// Height (m) of a barrel's axis above the level of the rails that carry it: staves slope, so a rail
/// touches with the round of its inner corner.
fn seat_height(profile: &BarrelProfile, rack: &Rack) -> f64 {
    let corner = corner_of(rack);
    let across = rack.rail_half_spacing - 0.5 * rack.rail_width + corner;
    let apart = profile.stave_radius + corner;
    (apart * apart - across * across).sqrt()
        - corner
        - (profile.stave_radius - profile.bilge_radius)
}
