//! Ties of three-dimensional stacks. A tie joins the middle of one of the four sides of a rack to a neighboring rack, a
//! wall or the ceiling. The ties on the left and right sides are the ties of the plane model across the barrels. The
//! ties on the near and far sides are the ties of the plane model along the barrels, in which the near side is on the
//! left.

use barrelstack::assemble::{AssembleError, PartKind, Similitude};
use barrelstack::device::{Anchor, AnchorTies, Side, lowest};
use barrelstack_dynamics::{BodyId, Link, Vec3};

use super::Loose;
use crate::builder::Builder;
use crate::stack::Stack;

/// A side of a rack to which a tie can be attached. In a mirrored stack, the left side is on the right, and the right
/// side is on the left.
struct End {
    name: &'static str,
    on: Side,
    /// Offset, in columns and rows, of the neighboring rack on this side.
    beside: [i64; 2],
}

const ENDS: [End; 4] = [
    End { name: "left", on: Side::Left, beside: [-1, 0] },
    End { name: "right", on: Side::Right, beside: [1, 0] },
    End { name: "near", on: Side::Left, beside: [0, -1] },
    End { name: "away", on: Side::Right, beside: [0, 1] },
];

/// Installs the ties from the ground up.
pub(super) fn place(device: &AnchorTies, builder: &mut Builder<'_>) -> Result<(), AssembleError> {
    if !device.is_on() {
        return Ok(());
    }
    let spec = builder.spec;
    if device.to == Anchor::Neighbors && spec.racks_per_level() * spec.racks_along() < 2 {
        return Err(AssembleError::NotInSpace {
            field: "stack.tie.to",
            reason: "\"neighbors\" ties the racks of a level to each other, but each level of this stack has only one \
                     rack: set stack.columns or stack.columns_along higher, or stack.tie.to = \"wall\""
                .into(),
        });
    }
    for rack in builder.on_levels_from(PartKind::Rack, lowest(device.levels, spec.levels)) {
        for end in &ENDS {
            tie(device, builder, rack, end);
        }
    }
    Ok(())
}

fn tie(device: &AnchorTies, builder: &mut Builder<'_>, rack: BodyId, end: &End) {
    let [x, y] = end.beside.map(|steps| steps as f64);
    let out = builder.mirrored(Vec3::new(x, y, 0.0));
    let reach = if end.beside[0] == 0 { builder.reach_along() } else { builder.parts[rack].size };
    let from = builder.bodies[rack].pose.position + out * reach;
    let (other, to, name) = match (device.to, builder.beside(rack, end.beside)) {
        // Each pair of neighbors is visited once.
        (Anchor::Neighbors, Some(next)) if end.on == Side::Right => {
            let to = builder.bodies[next].pose.position - out * reach;
            (next, to, builder.parts[next].name.clone())
        }
        // There is no wall between racks.
        (Anchor::Neighbors, _) | (Anchor::Wall, Some(_)) => return,
        (Anchor::Wall, None) => {
            (Stack::GROUND, from + out * device.distance, format!("wall {}", end.name))
        }
        (Anchor::Ceiling, _) => {
            let up = Vec3::new(0.0, 0.0, device.distance);
            (Stack::GROUND, from + up, format!("ceiling {}", end.name))
        }
    };
    if other == Stack::GROUND {
        if ![end.on, Side::Both].contains(&device.side) {
            return;
        }
        let half = match device.to {
            Anchor::Ceiling => out * 0.15,
            Anchor::Wall | Anchor::Neighbors => Vec3::new(0.0, 0.0, 0.3),
        };
        builder.draw(other, &[to - half, to + half]);
    }
    let link = Link {
        name: format!("{}-{name}", builder.parts[rack].name),
        bodies: [rack, other],
        points: [builder.within(rack, from), builder.within(other, to)],
    };
    let tie = device.tie(link, 1.0, Similitude::FULL);
    builder.loose.push(Loose::new(tie, device.slack, AnchorTies::WORDS));
}
