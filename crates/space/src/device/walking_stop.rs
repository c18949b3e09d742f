//! Walking stops of three-dimensional stacks, which keep racks from walking on the barrels below.
//!
//! A hook acts along the axis of its barrel, at the height of the rack; the barrel may turn under the hook. The hook
//! disengages as soon as the distance between the rack and the axis of the barrel exceeds its value at rest by the
//! height of the lip. A saddle acts across the barrel, at any position of the rack along the barrel. It disengages as
//! soon as the rack has risen by the height of the lip.

use barrelstack::assemble::{PartKind, Similitude};
use barrelstack::device::{Holds, WalkingStops, lowest};
use barrelstack_dynamics::{BodyId, Guide, Link, Vec3};

use super::Loose;
use crate::builder::Builder;
use crate::rack::Heights;

/// Installs stops between every rack and each of the barrels below.
pub(super) fn place(device: &WalkingStops, builder: &mut Builder<'_>) {
    if !device.is_on() {
        return;
    }
    for rack in builder.on_levels_from(PartKind::Rack, lowest(device.levels, builder.spec.levels)) {
        for barrel in builder.parts[rack].supports.clone() {
            if device.holds != Holds::Across {
                hook(device, builder, [rack, barrel]);
            }
            if device.holds != Holds::Along {
                saddle(device, builder, [rack, barrel]);
            }
        }
    }
}

fn named(builder: &Builder<'_>, rack: BodyId, barrel: BodyId, direction: &str) -> String {
    format!("{}-{} {direction}", builder.parts[rack].name, builder.parts[barrel].name)
}

fn hook(device: &WalkingStops, builder: &mut Builder<'_>, [rack, barrel]: [BodyId; 2]) {
    let axis = builder.turned(barrel).unapply(Vec3::new(0.0, 1.0, 0.0));
    let center = builder.bodies[barrel].pose.position;
    let over =
        center + Vec3::new(0.0, 0.0, Heights::of(&builder.spec.rack, &builder.barrel).underside);
    let point = builder.within(rack, over);
    let name = named(builder, rack, barrel, "along");
    let link = Link { name, bodies: [barrel, rack], points: [Vec3::default(), point] };
    let guide = device.guide(link, axis, Similitude::FULL);
    let hook = Loose { about_axis: true, ..Loose::new(guide, 0.0, WalkingStops::WORDS) };
    builder.loose.push(hook);
    // The hooks are drawn from the rack over both ends of the barrel.
    for side in [-1.0, 1.0] {
        let at = |y: f64, z: f64| over + Vec3::new(0.0, side * y, z);
        let end = 0.5 * builder.spec.barrel.length + device.gap;
        let rail = builder.spec.rack.rail_half_spacing;
        builder.draw(rack, &[at(rail, 0.0), at(end, 0.0), at(end, -device.lip.max(0.05))]);
    }
}

fn saddle(device: &WalkingStops, builder: &mut Builder<'_>, [rack, barrel]: [BodyId; 2]) {
    let [across, along] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let name = named(builder, rack, barrel, "across");
    let link = Link { name, bodies: [rack, barrel], points: [Vec3::default(); 2] };
    let turned = builder.turned(rack);
    let guide = Guide {
        free: turned.unapply(along),
        ..device.guide(link, turned.unapply(across), Similitude::FULL)
    };
    builder.loose.push(Loose::new(guide, 0.0, WalkingStops::WORDS));
    let size = builder.parts[barrel].size;
    let top = builder.bodies[barrel].pose.position + Vec3::new(0.0, 0.0, size);
    for side in [-1.0, 1.0] {
        let at = |x: f64, z: f64| top + Vec3::new(side * x, 0.0, z);
        // The saddle is drawn on the surface of the barrel, as far to the side as a saddle reaches.
        let foot = 0.7 * size + device.gap;
        builder.draw(rack, &[at(foot, 0.0), at(foot, -device.lip.max(0.25 * size))]);
    }
}
