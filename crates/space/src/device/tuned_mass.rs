//! Tuned masses of three-dimensional stacks. A mass swings in both horizontal directions. In each direction it has the
//! spring, damper and stops of the plane model.

use barrelstack::assemble::{PartKind, Similitude};
use barrelstack::device::TunedMass;
use barrelstack_dynamics::{Body, Link, Pose, Quaternion, Vec3};

use crate::builder::Builder;
use crate::part::Part;

/// Installs a tuned mass on every rack of one level, at the center of mass of the rack.
pub(super) fn place(device: &TunedMass, builder: &mut Builder<'_>) {
    if !device.is_on() {
        return;
    }
    let level = device.level_of(builder.spec.levels);
    for rack in builder.on_levels_from(PartKind::Rack, level) {
        if builder.parts[rack].level != level {
            continue;
        }
        let name = format!("mass on {}", builder.parts[rack].name);
        let [half, rise] = TunedMass::HALF;
        // Every force passes through the center of the mass, so the mass never rotates and its inertia is irrelevant.
        let inertia = device.mass * half * half;
        let position = builder.bodies[rack].pose.position;
        let pose = Pose { position, orientation: Quaternion::identity() };
        let mass = builder.add(
            Body::free(&name, device.mass, Vec3::new(inertia, inertia, inertia), pose),
            Part { carrier: Some(rack), size: half, ..Part::alone(&name, PartKind::Device) },
        );
        let corner = |x: f64, y: f64, z: f64| position + Vec3::new(x * half, y * half, z * rise);
        for side in [-1.0, 1.0] {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
            builder.draw(mass, &corners.map(|[x, z]| corner(x, side, z)));
            builder.draw(mass, &corners.map(|[y, z]| corner(side, y, z)));
        }
        let turned = builder.turned(rack);
        for (axis_name, x, y) in [("across", 1.0, 0.0), ("along", 0.0, 1.0)] {
            let name = format!("{name} {axis_name}");
            let link = Link { name, bodies: [rack, mass], points: [Vec3::default(); 2] };
            let axis = turned.unapply(Vec3::new(x, y, 0.0));
            builder
                .held
                .push((device.swing(link, axis, 1.0, Similitude::FULL).into(), TunedMass::WORDS));
        }
        let link = Link { name, bodies: [rack, mass], points: [Vec3::default(); 2] };
        let up = turned.unapply(Vec3::new(0.0, 0.0, 1.0));
        builder
            .held
            .push((device.hold(link, up, 1.0, Similitude::FULL).into(), TunedMass::SUPPORT));
    }
}
