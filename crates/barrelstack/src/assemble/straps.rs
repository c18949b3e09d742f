//! Where the straps of a stack go.
//!
//! A strap over a barrel lies on its round without slipping: so it is made fast where it leaves the
//! barrel, at the ends of its horizontal diameter, and from there runs straight down to the rack.
//! Along the barrels both of its ends are seen in one line, through the middle of the barrel.

use barrelstack_dynamics::{Body, BodyId, ModelError, Planar, State, Strap, Vec2};

use super::{Assembly, Part, PartKind, Similitude};
use crate::scenario::{StackSpec, Straps, Ties, View};

impl Assembly {
    /// Puts on the straps and tightens them as the stack stands in `state`.
    ///
    /// # Errors
    /// Never for straps of a scenario: their constants were checked when it was read.
    pub(crate) fn strap(&mut self, state: &mut State<Planar>) -> Result<(), ModelError> {
        let mut straps = std::mem::take(&mut self.loose);
        for strap in &mut straps {
            strap.length += strap.span(state);
        }
        state.torn = vec![false; straps.len()];
        self.model.fasten(straps)
    }
}

/// The straps of a stack, not tightened yet, with how much longer than their way they are for their
/// length: from the ground up, those on the left first.
pub(super) fn straps(
    spec: &StackSpec,
    scale: Similitude,
    parts: &[Part],
    bodies: &[Body<Planar>],
) -> Vec<Strap<Planar>> {
    let Straps { levels, ties, stiffness, damping, slack, pretension, strength } = spec.straps;
    let lowest = spec.levels - levels + 1;
    let strap = |upper: BodyId, lower: BodyId, side: &str, from: f64, along: f64| Strap {
        name: format!("{}-{} {side}", parts[upper].name, parts[lower].name),
        bodies: [upper, lower],
        points: [Vec2::new(from, 0.0), Vec2::new(along, 0.0)],
        length: (slack - pretension / stiffness) * scale.length,
        stiffness: stiffness * scale.stiffness(1.0, false),
        damping: damping * scale.damping(false),
        strength: strength.map_or(f64::INFINITY, |force| force * scale.force()),
    };
    // In the mirror left and right change places, in the order of sums, too.
    let mut sides = [("left", -1.0), ("right", 1.0)];
    if spec.mirror {
        sides.reverse();
    }
    let mut all = Vec::new();
    for (body, part) in parts.iter().enumerate() {
        let strapped = part.level.is_some_and(|level| level >= lowest);
        let x = |body: BodyId| bodies[body].pose.position.x;
        match (part.kind, part.carrier) {
            (PartKind::Barrel, Some(rack)) if strapped => {
                for (side, sign) in sides {
                    let (side, from) = match spec.view {
                        View::Transverse => (side, sign * part.size),
                        View::Longitudinal if sign < 0.0 => ("front", 0.0),
                        View::Longitudinal => ("back", 0.0),
                    };
                    all.push(strap(body, rack, side, from, x(body) + from - x(rack)));
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
                    let from = sign * part.size;
                    all.push(strap(body, below, side, from, x(body) + from - x(below)));
                }
            }
            _ => {}
        }
    }
    all
}
