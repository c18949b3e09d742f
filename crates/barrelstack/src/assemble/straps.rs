//! Where the straps of a stack go.
//!
//! A strap over a barrel lies on its round without slipping: so it is made fast where it leaves the
//! barrel, at the ends of its horizontal diameter, and from there runs straight down to the rack.
//! Along the barrels both of its ends are seen in one line, through the middle of the barrel.

use barrelstack_dynamics::{Body, BodyId, ModelError, Planar, State, Strap, Vec2};

use super::{AssembleError, Assembly, Part, PartKind, Similitude};
use crate::scenario::{StackSpec, Straps, Ties, View};

/// A strap that is not tightened yet.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    /// As the stack is drawn, before it sinks into its contacts.
    pub(crate) strap: Strap<Planar>,
    /// How much longer (m) it will be than the way between its ends; negative under pretension.
    give: f64,
}

impl Assembly {
    /// Puts on the straps and tightens them as the stack stands in `state`.
    ///
    /// # Errors
    /// When a strap that was sound as drawn is not on the settled stack.
    pub(crate) fn strap(&mut self, state: &mut State<Planar>) -> Result<(), ModelError> {
        let tighten = |Loose { mut strap, give }| {
            strap.length = strap.span(state) + give;
            strap
        };
        let straps: Vec<_> = std::mem::take(&mut self.loose).into_iter().map(tighten).collect();
        state.torn = vec![false; straps.len()];
        self.model.fasten(straps)
    }
}

/// The straps of a stack: from the ground up, those on the left first.
///
/// # Errors
/// When the pretension would stretch a strap over more than its whole way.
pub(super) fn straps(
    spec: &StackSpec,
    scale: Similitude,
    parts: &[Part],
    bodies: &[Body<Planar>],
) -> Result<Vec<Loose>, AssembleError> {
    let Straps { levels, ties, stiffness, damping, slack, pretension, strength } = spec.straps;
    let lowest = spec.levels - levels + 1;
    let give = (slack - pretension / stiffness) * scale.length;
    // Every strap is plumb on the stack as drawn.
    let strap = |upper: BodyId, lower: BodyId, side: &str, from: f64| {
        let apart = bodies[upper].pose.position - bodies[lower].pose.position;
        let name = format!("{}-{} {side}", parts[upper].name, parts[lower].name);
        if apart.z + give <= 0.0 {
            return Err(AssembleError::Stack(format!(
                "the pretension of {pretension} N stretches a strap of {stiffness} N/m by {:.3} m, but the strap \
                 {name} is only {:.3} m long: take a stiffer strap, or less pretension",
                pretension / stiffness,
                apart.z / scale.length
            )));
        }
        let strap = Strap {
            name,
            bodies: [upper, lower],
            points: [Vec2::new(from, 0.0), Vec2::new(from + apart.x, 0.0)],
            length: apart.z + give,
            stiffness: stiffness * scale.stiffness(1.0, false),
            damping: damping * scale.damping(false),
            strength: strength.map_or(f64::INFINITY, |force| force * scale.force()),
        };
        Ok(Loose { strap, give })
    };
    // In the mirror left and right change places, in the order of sums, too.
    let mut sides = [("left", -1.0), ("right", 1.0)];
    if spec.mirror {
        sides.reverse();
    }
    let mut all = Vec::new();
    for (body, part) in parts.iter().enumerate() {
        let strapped = part.level.is_some_and(|level| level >= lowest);
        match (part.kind, part.carrier) {
            (PartKind::Barrel, Some(rack)) if strapped => {
                for (side, sign) in sides {
                    let (side, from) = match spec.view {
                        View::Transverse => (side, sign * part.size),
                        View::Longitudinal if sign < 0.0 => ("front", 0.0),
                        View::Longitudinal => ("back", 0.0),
                    };
                    all.push(strap(body, rack, side, from)?);
                }
            }
            (PartKind::Rack, _) if ties == Ties::LevelsTogether => {
                // The lowest of the strapped levels is tied to nothing below it.
                let below = parts.iter().position(|other| {
                    other.kind == PartKind::Rack
                        && other.column == part.column
                        && other.level.map(|level| level + 1) == part.level
                });
                let Some(below) = below.filter(|_| part.level > Some(lowest)) else { continue };
                for (side, sign) in sides {
                    all.push(strap(body, below, side, sign * part.size)?);
                }
            }
            _ => {}
        }
    }
    Ok(all)
}
