//! Isolators of three-dimensional stacks: a platform under every bottom rack. At each corner, the platform has a
//! bearing that slides on a flat surface or in a dish.
//!
//! Springs and stops act at the middles of the four sides of the platform, so they also resist rotation of the platform
//! about the vertical. The stops limit the displacements across and along the barrels separately, so the platform may
//! move farther than the stroke in a diagonal direction.

use barrelstack::assemble::{PartKind, Similitude};
use barrelstack::device::{Isolators, Path};
use barrelstack_dynamics::solid::{Block, Bulk, Dish, Hull, Part as Matter, compound};
use barrelstack_dynamics::{
    BodyId, ContactPair, Counts, Link, Node, Nodes, Placed, Rotation3, Solid, Vec3,
};

use super::Loose;
use crate::builder::{Builder, TRIBUTARY};
use crate::part::Part;
use crate::stack::Stack;

/// Raises the stack and installs the platforms under its bottom racks.
pub(super) fn place(device: &Isolators, builder: &mut Builder<'_>) {
    let Some(law) = builder.laws.bearing else { return };
    builder.raise(Isolators::BEARING + Isolators::PLATE);
    for rack in builder.on_levels_from(PartKind::Rack, 1) {
        if !builder.parts[rack].supports.is_empty() {
            continue;
        }
        let half = Vec3::new(
            builder.parts[rack].size + Isolators::MARGIN,
            builder.reach_along() + Isolators::MARGIN,
            0.5 * Isolators::PLATE,
        );
        let place = builder.bodies[rack].pose.position;
        let center = Vec3::new(place.x, place.y, Isolators::BEARING + half.z);
        let platform = platform(device, builder, rack, (center, half));
        let corner = half - Vec3::new(Isolators::MARGIN, Isolators::MARGIN, 0.0);
        for y in [-1.0, 1.0] {
            for x in if builder.spec.mirror { [1.0, -1.0] } else { [-1.0, 1.0] } {
                let below = Vec3::new(center.x + x * corner.x, center.y + y * corner.y, 0.0);
                bear(device, builder, (platform, law), below);
            }
        }
        for (side, end) in builder.sides(half.x, half.y) {
            // The guides at the left and right sides act along the barrels. The guides at the near and far sides act
            // across the barrels.
            let across = end.x == 0.0;
            let axis = if across { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.0, 1.0, 0.0) };
            let link = Link {
                name: format!("{} {side}", builder.parts[rack].name),
                bodies: [Stack::GROUND, platform],
                points: [Vec3::default(), builder.within(platform, center + end)],
            };
            let guide = device.guide(link, axis, 0.5, Similitude::FULL);
            builder.loose.push(Loose::new(guide, 0.0, Isolators::WORDS));
        }
    }
}

/// Adds the platform of a rack, given the center (m) and half the side lengths (m) of the platform.
fn platform(
    device: &Isolators,
    builder: &mut Builder<'_>,
    rack: BodyId,
    (center, half): (Vec3, Vec3),
) -> BodyId {
    let name = format!("platform of {}", builder.parts[rack].name);
    let rounding = 0.25 * Isolators::PLATE;
    let block = Block { half: half - Vec3::new(rounding, rounding, rounding), rounding };
    let matter = Matter {
        hull: Hull::Block(block),
        center,
        rotation: Rotation3::identity(),
        bulk: Bulk::of_block(half, device.mass),
    };
    let body = compound(&name, &[matter], TRIBUTARY);
    let part = Part { size: half.x, ..Part::alone(&name, PartKind::Device) };
    let platform = builder.add(body, part);
    builder.parts[rack].carrier = Some(platform);
    platform
}

/// Adds a bearing of a platform at a position (m) on the ground.
fn bear(
    device: &Isolators,
    builder: &mut Builder<'_>,
    (platform, interface): (BodyId, usize),
    below: Vec3,
) {
    let surface = match device.path {
        Path::None | Path::Flat => 0,
        Path::Dish => {
            let radius = device.dish_radius;
            let offset = below + Vec3::new(0.0, 0.0, radius);
            // The dish is drawn as far as the platform can move, up to its stops.
            let arc = |across: bool| -> Vec<Vec3> {
                let at = |share: f64| {
                    let travel = share * device.stroke;
                    let rise = (radius * radius - travel * travel).sqrt();
                    let [x, y] = if across { [travel, 0.0] } else { [0.0, travel] };
                    offset + Vec3::new(x, y, -rise)
                };
                (-6..=6).map(|step| at(f64::from(step) / 6.0)).collect()
            };
            builder.draw(Stack::GROUND, &arc(true));
            builder.draw(Stack::GROUND, &arc(false));
            let surfaces = &mut builder.bodies[Stack::GROUND].surfaces;
            let rotation = Rotation3::identity();
            surfaces.push(Placed { surface: Solid::Dish(Dish { radius }), offset, rotation });
            surfaces.len() - 1
        }
    };
    let position = builder.within(platform, below);
    let nodes = &mut builder.bodies[platform].nodes;
    nodes.push(Nodes::Fixed(vec![Node { position, tributary_length: TRIBUTARY, outward: None }]));
    builder.bearings.push(ContactPair {
        contactor: platform,
        nodes: nodes.len() - 1,
        target: Stack::GROUND,
        surface,
        interface,
        counts: Counts::Everywhere,
    });
}
