//! A stack along its barrels: barrel profiles on the rails of racks that lie on the profiles below.
//!
//! The model is a slice one barrel wide: a rack that carries several barrels side by side lends each
//! of them its share of the mass.
//! A rail is a square tube; the nodes of its upper side carry the barrel above, those of its lower
//! side lie on the barrel below or on the ground.

use barrelstack_dynamics::shape::{BarrelProfile, Polygon};
use barrelstack_dynamics::{BodyId, Shape, Vec2};

use super::builder::{Builder, Draft, DraftNodes};
use super::{AssembleError, PartKind, outline_of};
use crate::scenario::{Rack, RackKind, StackBody, View};

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
        .ok_or_else(|| {
            AssembleError::Stack(format!(
                "a barrel in longitudinal section needs 0 < head_diameter < bilge_diameter, found \
                 {} m and {} m",
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
    // Rails are level, staves are not: a rail touches with its inner edge, where the barrel is thickest.
    let seat = profile.radius_at(rack.rail_half_spacing - 0.5 * rack.rail_width);
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

    let mut mass = rack.mass;
    let mut offset = 0.0;
    for change in builder.overrides(StackBody::Rack, level, column) {
        mass = change.mass.unwrap_or(mass);
        offset += change.offset_x;
    }
    let mass = mass / f64::from(rack.barrels);
    let half_width = places.last().copied().unwrap_or(0.0) + rack.rail_half_spacing;
    let half_height = 0.5 * rack.clearance;
    let name = if spec.racks_per_level() == 1 {
        format!("R{level}")
    } else {
        format!("R{level}.{column}")
    };
    let tube = Polygon::rectangle(rack.rail_width, rack.clearance, 0.0).map_err(|problem| {
        AssembleError::Shape { body: name.clone(), problem: problem.to_string() }
    })?;
    let rails: Vec<f64> = places
        .iter()
        .flat_map(|place| [place - rack.rail_half_spacing, place + rack.rail_half_spacing])
        .collect();
    let surfaces: Vec<(Shape, Vec2)> =
        rails.iter().map(|x| (Shape::Polygon(tube.clone()), Vec2::new(*x, 0.0))).collect();
    let mut outlines: Vec<super::Outline> =
        surfaces.iter().map(|(shape, at)| outline_of(shape, *at)).collect();
    // The bar that joins the rails, for the eye.
    outlines.push(super::Outline {
        points: vec![Vec2::new(-half_width, 0.0), Vec2::new(half_width, 0.0)],
        closed: false,
    });
    let rack_id = builder.add(Draft {
        name,
        kind: PartKind::Rack,
        level,
        column,
        mass,
        // The rails carry the mass, as two lines of it, each a rectangle of tube.
        inertia: mass
            * (half_width * half_width
                + (rack.rail_width * rack.rail_width + rack.clearance * rack.clearance) / 12.0),
        position: Vec2::new(underside.x + offset, underside.z + half_height),
        size: half_width,
        surfaces,
        nodes: vec![DraftNodes::Fixed(rail_nodes(rack, &rails, half_height))],
        outlines,
        carrier: None,
        supports,
    });

    let mut barrels = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let barrel_column = (column - 1) * deep + u32::try_from(i).unwrap_or(0) + 1;
        let mut barrel = spec.barrel.clone();
        let mut offset_x = 0.0;
        for change in builder.overrides(StackBody::Barrel, level, barrel_column) {
            barrel = barrel.altered(change.mass, change.fill);
            offset_x += change.offset_x;
        }
        let shape = Shape::BarrelProfile(*profile);
        let nodes = shape
            .nodes(rack.node_spacing.max(0.02))
            .into_iter()
            .map(|node| (node.position, node.tributary_length))
            .collect();
        barrels.push(builder.add(Draft {
            name: format!("B{level}.{barrel_column}"),
            kind: PartKind::Barrel,
            level,
            column: barrel_column,
            mass: barrel.mass,
            inertia: barrel.inertia(View::Longitudinal),
            position: Vec2::new(
                underside.x + offset + place + offset_x,
                underside.z + rack.clearance + seat,
            ),
            size: profile.bilge_radius,
            outlines: vec![outline_of(&shape, Vec2::default())],
            surfaces: vec![(shape, Vec2::default())],
            nodes: vec![DraftNodes::Fixed(nodes)],
            carrier: Some(rack_id),
            supports: Vec::new(),
        }));
    }
    Ok(barrels)
}

/// Nodes along the upper and the lower side of every rail, from the rack's center of mass.
fn rail_nodes(rack: &Rack, rails: &[f64], half_height: f64) -> Vec<(Vec2, f64)> {
    let parts = (rack.rail_width / rack.node_spacing - 1e-9).ceil().max(1.0);
    let step = rack.rail_width / parts;
    let mut nodes = Vec::new();
    for rail in rails {
        for side in [-1.0, 1.0] {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a small count"
            )]
            for i in 0..=parts as u32 {
                let edge = i == 0 || f64::from(i) >= parts;
                let x = rail - 0.5 * rack.rail_width + f64::from(i) * step;
                nodes
                    .push((Vec2::new(x, side * half_height), if edge { 0.5 * step } else { step }));
            }
        }
    }
    nodes
}
