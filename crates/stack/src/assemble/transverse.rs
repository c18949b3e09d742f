//! Assembly of a stack in the plane across its barrels. Barrels are circles in the cradles of racks. A rack stands on
//! the ground, on the barrels below, or on the rack below.
//!
//! ```text
//!      ( B2.1 )   ( B2.2 )
//!      __|_|________|_|__      two bars per cradle, with round ends at ± the support angle; a beam
//!         [_]        [_]       feet, if the rack has any, over each crown
//!      ( B1.1 )   ( B1.2 )
//!      __|_|________|_|__
//!         [_]        [_]
//!     ////////////////////     ground
//! ```
//!
//! The beam, feet, bars and posts of a rack are convex solids that can touch all other bodies.

use barrelstack_dynamics::shape::{Circle, Polygon, PolygonError};
use barrelstack_dynamics::{BodyId, Shape, Vec2, math};

use super::builder::{Builder, Draft};
use super::solid::{Seat, Solid, row};
use super::{AssembleError, PartKind, posts};
use crate::device::Chocks;
use crate::scenario::{Cradle, Friction, Rack, RackKind, SeatContact};

/// Assumed half thickness (m) of the bars of a cradle, and radius of their round ends.
pub const BAR_RADIUS: f64 = 0.015;

/// Assumed corner radius (m) of tubes.
///
/// Twice this radius exceeds the stroke of a seat, which is the penetration beyond which the impact law also acts. The
/// cores of two tubes (the parts inside the rounding) therefore never touch.
pub const TUBE_CORNER: f64 = 0.012;

/// Adds the racks and barrels of all levels.
///
/// Returns the height (m) of the stack, and the displacement (m) of a rack, relative to the level below, beyond which
/// the rack is no longer supported.
pub(super) fn build(builder: &mut Builder<'_>) -> Result<(f64, f64), AssembleError> {
    let spec = builder.spec;
    let rack = &spec.rack;
    let radius = 0.5 * spec.barrel.section_diameter;
    let level_pitch = match (rack.kind, &rack.posts) {
        (RackKind::OnRacks, Some(posts)) => posts.height,
        _ => rack.clearance + 2.0 * radius,
    };
    let racks = spec.racks_per_level();
    let mut below: Vec<Vec<BodyId>> = vec![Vec::new(); racks as usize];
    for level in 1..=spec.levels {
        let underside = f64::from(level - 1) * level_pitch;
        for column in 1..=racks {
            let slot = column as usize - 1;
            let middle = (f64::from(column) - 0.5 * f64::from(racks + 1)) * (rack.width + spec.gap);
            let supports = std::mem::take(&mut below[slot]);
            let (rack_id, barrels) = add_rack(builder, level, column, middle, underside, supports)?;
            below[slot] = match rack.kind {
                RackKind::OnBarrels => barrels,
                RackKind::OnRacks => vec![rack_id],
            };
        }
    }
    let height = f64::from(spec.levels - 1) * level_pitch + rack.clearance + 2.0 * radius;
    Ok((height, reach(rack, radius, &spec.interfaces.barrel_rack.friction)))
}

/// Returns the displacement (m) of a rack, relative to the level below, beyond which the rack is no longer supported.
///
/// A rack with feet is supported until its feet stand beside the crowns and its beam rests on the curved side of a
/// barrel. A rack without feet is supported until the end of its beam has passed the crown and has reached the point
/// where the surface of the barrel descends at an angle of arctan μ, the steepest slope on which friction holds the
/// beam. For a rack on posts, the result is that of `posts::reach`.
fn reach(rack: &Rack, radius: f64, friction: &Friction) -> f64 {
    if let (RackKind::OnRacks, Some(posts)) = (rack.kind, &rack.posts) {
        return posts::reach(rack, posts.half_spacing);
    }
    let coefficient = match *friction {
        Friction::None => 0.0,
        Friction::Coulomb { static_coefficient, .. } => static_coefficient,
        Friction::Regularized { coefficient, .. } => coefficient,
    };
    if rack.foot_height > 0.0 {
        // A foot bears on the descending side of the barrel until the beam has come down on the barrel.
        let height = (radius - rack.foot_height).max(0.0);
        return rack.foot_half_length + (radius * radius - height * height).sqrt();
    }
    let bearing = 0.5 * (rack.width - f64::from(rack.barrels - 1) * rack.pitch);
    let (sin, _) = math::sin_cos(math::atan(coefficient));
    bearing + radius * sin
}

/// Adds one rack with its barrels, and returns the IDs of the rack and of the barrels.
fn add_rack(
    builder: &mut Builder<'_>,
    level: u32,
    column: u32,
    middle: f64,
    underside: f64,
    supports: Vec<BodyId>,
) -> Result<(BodyId, Vec<BodyId>), AssembleError> {
    let spec = builder.spec;
    let rack = &spec.rack;
    let radius = 0.5 * spec.barrel.section_diameter;
    let places: Vec<f64> = (0..rack.barrels)
        .map(|i| (f64::from(i) - 0.5 * f64::from(rack.barrels - 1)) * rack.pitch)
        .collect();

    let (name, mass, offset) = builder.rack_at(level, column);
    let shape = |problem: PolygonError| AssembleError::Shape {
        body: name.clone(),
        problem: problem.to_string(),
    };
    let mut solids = rack_solids(rack, &places, radius, level).map_err(shape)?;
    if spec.devices.chock.at(level, spec.levels) {
        let horns = chocks(rack, spec.devices.chock, &places, radius).map_err(shape)?;
        let inside = |horn: &&Solid| horn.offset.x.abs() > 0.5 * rack.width;
        if let Some(horn) = horns.iter().find(inside) {
            return Err(AssembleError::Stack(format!(
                "chocks at ± {:.3} m lie beyond the rack, which extends to ± {:.3} m: set a smaller stack.chock.angle \
                 or stack.chock.gap",
                horn.offset.x.abs(),
                0.5 * rack.width
            )));
        }
        solids.extend(horns);
    }
    let rack_id = builder.add(Draft {
        name,
        kind: PartKind::Rack,
        level: Some(level),
        column,
        mass,
        inertia: None,
        position: Vec2::new(middle + offset, underside),
        size: 0.5 * rack.width,
        solids,
        carrier: None,
        supports,
    });

    let origin = Vec2::new(middle + offset, underside + rack.clearance + radius);
    let shape = Shape::Circle(Circle { radius });
    let at = (level, column);
    let barrels = builder.add_barrels(rack_id, at, (origin, &places), (&shape, radius));
    Ok((rack_id, barrels))
}

/// Returns the solids of a rack, relative to the middle of its underside.
fn rack_solids(
    rack: &Rack,
    places: &[f64],
    radius: f64,
    level: u32,
) -> Result<Vec<Solid>, PolygonError> {
    let stands_on_racks = rack.posts.filter(|_| rack.kind == RackKind::OnRacks);
    let feet = rack.foot_height > 0.0 && stands_on_racks.is_none();
    let lift = if feet { rack.foot_height } else { 0.0 };
    let corner = TUBE_CORNER.min(0.25 * rack.beam_height);
    let mut beam = Solid::exact(
        Shape::Polygon(Polygon::rectangle(rack.width, rack.beam_height, corner)?),
        Vec2::new(0.0, lift + 0.5 * rack.beam_height),
        if feet { Seat::None } else { Seat::OnSupports },
    );
    if !feet && stands_on_racks.is_none() && rack.contact == SeatContact::Nodes {
        beam.below = row(rack.node_spacing, 0.0, 0.5 * rack.width - corner, 0.0);
    }
    let mut solids = vec![beam];
    if feet {
        for (column, place) in places.iter().enumerate() {
            let mut foot = Solid::exact(
                Shape::Polygon(Polygon::rectangle(
                    2.0 * rack.foot_half_length,
                    rack.foot_height,
                    0.0,
                )?),
                Vec2::new(*place, 0.5 * rack.foot_height),
                Seat::OnSupport(column),
            );
            if rack.contact == SeatContact::Nodes {
                foot.below = row(rack.node_spacing, *place, rack.foot_half_length, 0.0);
            }
            solids.push(foot);
        }
    }
    let top = lift + rack.beam_height;
    for (column, place) in places.iter().enumerate() {
        cradle(&mut solids, rack, *place, radius, top, Seat::Barrel(column))?;
    }
    if let Some(posts) = stands_on_racks {
        solids.extend(posts::posts_and_cups(rack, &posts, posts.half_spacing, level)?);
    }
    Ok(solids)
}

/// Adds the cradle of a barrel: two bars that stand on the beam, or a trough made of bars placed end to end.
///
/// The lowest point of the barrel is `rack.clearance` above the underside of the rack; `top` is the height (m) of the
/// top of the beam.
fn cradle(
    solids: &mut Vec<Solid>,
    rack: &Rack,
    place: f64,
    radius: f64,
    top: f64,
    seat: Seat,
) -> Result<(), PolygonError> {
    let mut bar = |from: Vec2, to: Vec2| -> Result<(), PolygonError> {
        // If a support does not rise above the beam, only its round end remains.
        let shape = if (to - from).z.abs() + (to - from).x.abs() < 1e-3 {
            Shape::Circle(Circle { radius: BAR_RADIUS })
        } else {
            let middle = (from + to) * 0.5;
            Shape::Polygon(Polygon::bar(from - middle, to - middle, BAR_RADIUS)?)
        };
        let offset = if matches!(shape, Shape::Circle(_)) { from } else { (from + to) * 0.5 };
        solids.push(Solid::exact(shape, offset, seat));
        Ok(())
    };
    match rack.cradle {
        Cradle::Supports { angle } => {
            let center = Vec2::new(place, rack.clearance + radius);
            let (sin, cos) = math::sin_cos(angle);
            for side in [-1.0, 1.0] {
                let end = center + Vec2::new(side * sin, -cos) * (radius + BAR_RADIUS);
                bar(end, Vec2::new(end.x, end.z.min(top)))?;
            }
        }
        Cradle::Arc { radius: trough, half_angle } => {
            let center = Vec2::new(place, rack.clearance + trough);
            // Each bar touches the circle of the trough at its middle.
            let length = 2.0 * half_angle * trough;
            let count = (length / TROUGH_BAR).ceil().max(2.0);
            let turn = 2.0 * half_angle / count;
            let (_, cos) = math::sin_cos(0.5 * turn);
            let at = |angle: f64| {
                let (sin, cosine) = math::sin_cos(angle);
                center + Vec2::new(sin, -cosine) * ((trough + BAR_RADIUS) / cos)
            };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a small count"
            )]
            for i in 0..count as u32 {
                let from = -half_angle + f64::from(i) * turn;
                bar(at(from), at(from + turn))?;
            }
        }
    }
    Ok(())
}

/// Returns the chocks of a rack: bars on its beam, with a gap between their round ends and the barrels.
fn chocks(
    rack: &Rack,
    chock: Chocks,
    places: &[f64],
    radius: f64,
) -> Result<Vec<Solid>, PolygonError> {
    let foot = if rack.kind == RackKind::OnBarrels { rack.foot_height } else { 0.0 };
    let top = foot + rack.beam_height;
    let (sin, cos) = math::sin_cos(chock.angle);
    let away = radius + chock.gap + BAR_RADIUS;
    let mut solids = Vec::new();
    for place in places {
        let center = Vec2::new(*place, rack.clearance + radius);
        for side in [-1.0, 1.0] {
            let end = center + Vec2::new(side * sin, -cos) * away;
            let middle = Vec2::new(end.x, 0.5 * (end.z + top));
            let bar = Polygon::bar(Vec2::new(end.x, top) - middle, end - middle, BAR_RADIUS)?;
            let horn = Solid::exact(Shape::Polygon(bar), middle, Seat::None);
            // The stated mass of a rack does not include its chocks.
            solids.push(Solid { weighs: false, ..horn });
        }
    }
    Ok(solids)
}

/// Maximum arc length (m) of the part of a trough that one straight bar forms.
const TROUGH_BAR: f64 = 0.04;
