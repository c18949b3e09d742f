//! Straps of three-dimensional stacks: the straps of both plane models, each placed so that it is vertical on the
//! undeformed stack.
//!
//! A strap over a barrel runs around the barrel at the middle of its length, as in the plane across the barrels: the
//! strap is attached at the ends of the horizontal diameter, and runs from there straight down to the rack. Where
//! levels are tied together, every rack has one strap down the middle of each of its four sides. The straps on the left
//! and right sides are the straps of the plane model across the barrels; the straps on the near and far sides are the
//! straps of the plane model along the barrels.

use barrelstack::assemble::{AssembleError, PartKind, Similitude};
use barrelstack::device::{Straps, Ties, lowest};
use barrelstack_dynamics::{BodyId, Link, Vec3};

use super::Loose;
use crate::builder::Builder;

/// Installs the straps, body by body from the ground up; for each body, the strap on the left comes first, or the strap
/// on the right if the stack is mirrored.
pub(super) fn place(device: &Straps, builder: &mut Builder<'_>) -> Result<(), AssembleError> {
    if !device.is_on() {
        return Ok(());
    }
    let lowest = lowest(device.levels, builder.spec.levels);
    let along = builder.reach_along();
    for body in 0..builder.parts.len() {
        let part = &builder.parts[body];
        let sides = builder.sides(part.size, along);
        match part.kind {
            PartKind::Barrel => {
                let Some(rack) = part.carrier.filter(|_| part.level >= lowest) else { continue };
                for side in &sides[..2] {
                    strap(device, builder, [body, rack], *side)?;
                }
            }
            PartKind::Rack => {
                // The lowest of the strapped levels has no strap to the level below.
                let tied = device.ties == Ties::LevelsTogether && part.level > lowest;
                let below = builder.parts.iter().position(|other| {
                    other.kind == PartKind::Rack
                        && (other.column, other.row) == (part.column, part.row)
                        && other.level + 1 == part.level
                });
                let Some(below) = below.filter(|_| tied) else { continue };
                for side in sides {
                    strap(device, builder, [body, below], side)?;
                }
            }
            PartKind::Ground | PartKind::Device | PartKind::Wine | PartKind::Body => {}
        }
    }
    Ok(())
}

/// Adds a strap from a side of the upper body straight down to the lower body.
fn strap(
    device: &Straps,
    builder: &mut Builder<'_>,
    [upper, lower]: [BodyId; 2],
    (side, from): (&str, Vec3),
) -> Result<(), AssembleError> {
    let Builder { parts, bodies, .. } = builder;
    let apart = bodies[upper].pose.position - bodies[lower].pose.position;
    let name = format!("{}-{} {side}", parts[upper].name, parts[lower].name);
    let over = from + Vec3::new(apart.x, apart.y, 0.0);
    let points = [builder.turned(upper).unapply(from), builder.turned(lower).unapply(over)];
    let link = Link { name, bodies: [upper, lower], points };
    let (strap, give) = device
        .strap(link, apart.z, Similitude::FULL)
        .map_err(|reason| AssembleError::NotInSpace { field: "stack.strap", reason })?;
    builder.loose.push(Loose::new(strap, give, Straps::WORDS));
    Ok(())
}
