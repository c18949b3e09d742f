//! Lids of three-dimensional stacks. The lids are round: a barrel is released as soon as it has moved out from under
//! its lid in any direction.

use barrelstack::assemble::{PartKind, Similitude};
use barrelstack::device::{Lids, lowest};
use barrelstack_dynamics::{Link, Vec3};

use super::Loose;
use crate::builder::Builder;

/// Installs a lid over every barrel of the protected levels.
pub(super) fn place(device: &Lids, builder: &mut Builder<'_>) {
    for barrel in
        builder.on_levels_from(PartKind::Barrel, lowest(device.levels, builder.spec.levels))
    {
        let part = &builder.parts[barrel];
        let Some(rack) = part.carrier else { continue };
        let (name, size) = (part.name.clone(), part.size);
        let link = Link { name, bodies: [rack, barrel], points: [Vec3::default(); 2] };
        let up = builder.turned(rack).unapply(Vec3::new(0.0, 0.0, 1.0));
        let guide = device.guide(link, up, size, Similitude::FULL);
        builder.loose.push(Loose::new(guide, 0.0, Lids::WORDS));
        let [half, rise] = device.drawn(size, Similitude::FULL);
        let top = builder.bodies[barrel].pose.position + Vec3::new(0.0, 0.0, rise);
        for arm in [Vec3::new(half, 0.0, 0.0), Vec3::new(0.0, half, 0.0)] {
            builder.draw(rack, &[top - arm, top + arm]);
        }
    }
}
