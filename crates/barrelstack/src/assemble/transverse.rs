//! A stack across its barrels: circles in the cradles of racks that lie on the circles below.
//!
//! ```text
//!      ( B2.1 )   ( B2.2 )
//!      __\_/________\_/__      cradle supports at ± the support angle, rack beam
//!          =          =        flat underside bearing around each crown
//!      ( B1.1 )   ( B1.2 )
//!      __\_/________\_/__
//!          =          =
//!     ////////////////////     ground
//! ```
//!
//! A rack touches barrels with nodes: one at each cradle support (or along a cradle arc), and a row
//! along the bearing around each crown below.
//! The corners of its beam are nodes too, for what falls on it and where it falls.
//! The beam is a polygon for the nodes of other racks.

use barrelstack_dynamics::shape::{self, Circle, Polygon};
use barrelstack_dynamics::{BodyId, Shape, Vec2, math};

use super::builder::{Builder, Draft, DraftNodes};
use super::{AssembleError, PartKind, outline_of};
use crate::scenario::{Cradle, Friction, Posts, Rack, RackKind, StackBody, View};

/// Play (m) between the cup of a foot and the post in it.
const SPIGOT_PLAY: f64 = 0.005;

/// Builds all levels; returns the height of the stack and the reach of a rack on its barrels (m).
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

/// How far a rack may move across the barrels below: past the end of its flat bearing it stands on the
/// falling side of the round, where friction holds it up to a slope of arctan μ.
fn reach(rack: &Rack, radius: f64, friction: &Friction) -> f64 {
    if let (RackKind::OnRacks, Some(posts)) = (rack.kind, &rack.posts) {
        // A post stands on a post: half of its width, and it is off.
        return rack.rail_width.min(posts.half_spacing);
    }
    let coefficient = match *friction {
        Friction::None => 0.0,
        Friction::Coulomb { static_coefficient, .. } => static_coefficient,
        Friction::Regularized { coefficient, .. } => coefficient,
    };
    let (sin, _) = math::sin_cos(math::atan(coefficient));
    rack.bearing_half_length + radius * sin
}

/// One rack with its barrels; returns their ids.
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

    let mut mass = rack.mass;
    let mut offset = 0.0;
    for change in builder.overrides(StackBody::Rack, level, column) {
        mass = change.mass.unwrap_or(mass);
        offset += change.offset_x;
    }
    let name = if spec.racks_per_level() == 1 {
        format!("R{level}")
    } else {
        format!("R{level}.{column}")
    };
    let center = Vec2::new(middle + offset, underside + 0.5 * rack.beam_height);
    let mut draft = Draft {
        name,
        kind: PartKind::Rack,
        level,
        column,
        mass,
        inertia: mass * (rack.width * rack.width + rack.beam_height * rack.beam_height) / 12.0,
        position: center,
        size: 0.5 * rack.width,
        surfaces: Vec::new(),
        nodes: vec![DraftNodes::Fixed(rack_nodes(rack, &places, radius, level))],
        outlines: Vec::new(),
        carrier: None,
        supports,
    };
    draw_rack(&mut draft, rack, &places, radius)?;
    let rack_id = builder.add(draft);

    let mut barrels = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let barrel_column = (column - 1) * rack.barrels + u32::try_from(i).unwrap_or(0) + 1;
        let mut barrel = spec.barrel.clone();
        let mut offset_x = 0.0;
        for change in builder.overrides(StackBody::Barrel, level, barrel_column) {
            barrel = barrel.altered(change.mass, change.fill);
            offset_x += change.offset_x;
        }
        let shape = Shape::Circle(Circle { radius });
        barrels.push(builder.add(Draft {
            name: format!("B{level}.{barrel_column}"),
            kind: PartKind::Barrel,
            level,
            column: barrel_column,
            mass: barrel.mass,
            inertia: barrel.inertia(View::Transverse),
            position: Vec2::new(
                middle + offset + place + offset_x,
                underside + rack.clearance + radius,
            ),
            size: radius,
            outlines: vec![outline_of(&shape, Vec2::default())],
            surfaces: vec![(shape, Vec2::default())],
            nodes: vec![DraftNodes::Rolling(radius, rack.node_spacing)],
            carrier: Some(rack_id),
            supports: Vec::new(),
        }));
    }
    Ok((rack_id, barrels))
}

/// The nodes of a rack from its center of mass, with their tributary lengths.
fn rack_nodes(rack: &Rack, places: &[f64], radius: f64, level: u32) -> Vec<(Vec2, f64)> {
    let mut nodes = match (rack.kind, &rack.posts) {
        (RackKind::OnRacks, Some(posts)) => feet(rack, posts, level),
        _ => places.iter().flat_map(|x| row(rack, *x, rack.bearing_half_length)).collect(),
    };
    nodes.extend(places.iter().flat_map(|x| cradle_nodes(rack, *x, radius)));
    // The corners of the beam, for what falls on it and where it falls.
    let (half_width, half_height) = (0.5 * rack.width, 0.5 * rack.beam_height);
    for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        nodes.push((Vec2::new(x * half_width, z * half_height), rack.node_spacing));
    }
    nodes
}

/// A row of nodes along the underside, `half` (m) to either side of `middle` (m).
fn row(rack: &Rack, middle: f64, half: f64) -> Vec<(Vec2, f64)> {
    let z = -0.5 * rack.beam_height;
    let parts = (2.0 * half / rack.node_spacing - 1e-9).ceil().max(1.0);
    let step = 2.0 * half / parts;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let last = parts as u32;
    (0..=last)
        .map(|i| {
            let tributary = if i == 0 || i == last { 0.5 * step } else { step };
            (Vec2::new(middle - half + f64::from(i) * step, z), tributary)
        })
        .collect()
}

/// The feet of a rack that stands on posts.
///
/// Above the first level a foot is a cup over the post: nodes beside it hold the rack in place until it
/// is lifted off. On the floor there is nothing to hold.
fn feet(rack: &Rack, posts: &Posts, level: u32) -> Vec<(Vec2, f64)> {
    let half = 0.5 * rack.rail_width;
    let mut nodes = Vec::new();
    for side in [-1.0, 1.0] {
        let foot = side * posts.half_spacing;
        nodes.extend(row(rack, foot, half));
        if level > 1 && posts.spigot > 0.0 {
            for beside in [-1.0, 1.0] {
                let x = foot + beside * (half + SPIGOT_PLAY);
                for share in [0.5, 1.0] {
                    let z = -0.5 * rack.beam_height - share * posts.spigot;
                    nodes.push((Vec2::new(x, z), 0.5 * posts.spigot));
                }
            }
        }
    }
    nodes
}

/// The nodes of one cradle, seen from the center of its barrel.
fn cradle_nodes(rack: &Rack, place: f64, radius: f64) -> Vec<(Vec2, f64)> {
    let center = Vec2::new(place, rack.clearance + radius - 0.5 * rack.beam_height);
    match rack.cradle {
        Cradle::Supports { angle } => {
            let (sin, cos) = math::sin_cos(angle);
            [-1.0, 1.0]
                .map(|side| (center + Vec2::new(side * sin, -cos) * radius, rack.node_spacing))
                .to_vec()
        }
        Cradle::Arc { radius: arc_radius, half_angle } => {
            let center = center + Vec2::new(0.0, arc_radius - radius);
            Shape::Cradle(shape::Cradle::new(arc_radius, half_angle))
                .nodes(rack.node_spacing)
                .into_iter()
                .map(|node| (center + node.position, node.tributary_length))
                .collect()
        }
    }
}

/// The beam and posts as surfaces, and the lines that show a rack.
fn draw_rack(
    draft: &mut Draft,
    rack: &Rack,
    places: &[f64],
    radius: f64,
) -> Result<(), AssembleError> {
    let half_height = 0.5 * rack.beam_height;
    let rectangle = |width: f64, height: f64| {
        Polygon::rectangle(width, height, 0.0).map(Shape::Polygon).map_err(|problem| {
            AssembleError::Shape { body: draft.name.clone(), problem: problem.to_string() }
        })
    };
    let mut surfaces = vec![(rectangle(rack.width, rack.beam_height)?, Vec2::default())];
    if let (RackKind::OnRacks, Some(posts)) = (rack.kind, &rack.posts) {
        let post = posts.height - rack.beam_height;
        for side in [-1.0, 1.0] {
            let place = Vec2::new(side * posts.half_spacing, half_height + 0.5 * post);
            surfaces.push((rectangle(rack.rail_width, post)?, place));
        }
    }
    draft.outlines = surfaces.iter().map(|(shape, offset)| outline_of(shape, *offset)).collect();
    // Saddles, for the eye: from the beam up to each support.
    let (angle, saddle_radius) = match rack.cradle {
        Cradle::Supports { angle } => (angle, radius),
        Cradle::Arc { radius, half_angle } => (half_angle, radius),
    };
    for place in places {
        let center = Vec2::new(*place, rack.clearance + saddle_radius - half_height);
        for side in [-1.0, 1.0] {
            let (sin, cos) = math::sin_cos(angle);
            let tip = center + Vec2::new(side * sin, -cos) * saddle_radius;
            let foot = |dx: f64| Vec2::new(tip.x + dx, half_height);
            draft.outlines.push(super::Outline {
                points: vec![foot(-0.025), foot(0.025), tip],
                closed: true,
            });
        }
    }
    draft.surfaces = surfaces;
    Ok(())
}
