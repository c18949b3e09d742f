//! Straps on a stack in space: those of both planes, each where it is plumb on the stack as drawn.
//!
//! A strap over a barrel lies on its round at half its length, as in the plane across the barrels: made fast at the
//! ends of the horizontal diameter, and from there straight down to the rack.
//! Where levels are tied together every rack has one strap down each of its four sides, at its middle: those to the
//! left and right are the ones that the plane across the barrels has, those nearest and farthest the ones along them.

use barrelstack::assemble::{AssembleError, PartKind, Similitude};
use barrelstack::device::Ties;
use barrelstack::scenario::StackSpec;
use barrelstack_dynamics::{
    Body, BodyId, Element, Link, Memory, ModelError, Rotation3, Spatial, State, Vec3,
};

use crate::part::Part;
use crate::rack::reach_along;
use crate::stack::Stack;

/// A strap that is not tightened yet.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    element: Element<Spatial>,
    /// How much longer (m) it will be than the way between its ends; negative under pretension.
    give: f64,
}

/// The straps of a stack: from the ground up, those on the left first.
pub(crate) fn straps(
    spec: &StackSpec,
    parts: &[Part],
    bodies: &[Body<Spatial>],
) -> Result<Vec<Loose>, AssembleError> {
    let device = &spec.devices.strap;
    let mut all = Vec::new();
    if device.levels == 0 {
        return Ok(all);
    }
    let lowest = device.lowest(spec.levels);
    let turned = |id: BodyId| -> Rotation3 { bodies[id].pose.orientation.matrix() };
    let mut put = |upper: BodyId, lower: BodyId, (side, from): (&str, Vec3)| {
        let apart = bodies[upper].pose.position - bodies[lower].pose.position;
        let name = format!("{}-{} {side}", parts[upper].name, parts[lower].name);
        let over = from + Vec3::new(apart.x, apart.y, 0.0);
        let points = [turned(upper).unapply(from), turned(lower).unapply(over)];
        let link = Link { name, bodies: [upper, lower], points };
        let (strap, give) = device
            .strap(link, apart.z, Similitude::new(1.0))
            .map_err(|reason| AssembleError::NotInSpace { field: "stack.strap", reason })?;
        all.push(Loose { element: strap.into(), give });
        Ok::<_, AssembleError>(())
    };
    // In the mirror left and right change places, in the order of sums, too.
    let sides = |size: f64| {
        let [left, right] =
            [("left", -size), ("right", size)].map(|(side, x)| (side, Vec3::new(x, 0.0, 0.0)));
        if spec.mirror { [right, left] } else { [left, right] }
    };
    let along = reach_along(&spec.rack, spec.barrel.length + spec.gap);
    for (body, part) in parts.iter().enumerate() {
        match part.kind {
            PartKind::Barrel => {
                let Some(rack) = part.carrier.filter(|_| part.level >= lowest) else { continue };
                for side in sides(part.size) {
                    put(body, rack, side)?;
                }
            }
            PartKind::Rack => {
                // The lowest of the strapped levels is tied to nothing below it.
                let tied = device.ties == Ties::LevelsTogether && part.level > lowest;
                let below = parts.iter().position(|other| {
                    other.kind == PartKind::Rack
                        && (other.column, other.row) == (part.column, part.row)
                        && other.level + 1 == part.level
                });
                let Some(below) = below.filter(|_| tied) else { continue };
                let ends = [("near", -along), ("away", along)];
                let ends = ends.map(|(side, y)| (side, Vec3::new(0.0, y, 0.0)));
                for side in sides(part.size).into_iter().chain(ends) {
                    put(body, below, side)?;
                }
            }
            PartKind::Ground | PartKind::Device | PartKind::Wine | PartKind::Body => {}
        }
    }
    Ok(all)
}

impl Stack {
    /// Tightens the straps as the stack stands in `state`; says whether some bear something from the start.
    pub(crate) fn fasten(&mut self, state: &mut State<Spatial>) -> Result<bool, ModelError> {
        let loose = std::mem::take(&mut self.loose);
        if loose.is_empty() {
            return Ok(false);
        }
        let tighten = |Loose { mut element, give }| {
            element.fit(state, give);
            element
        };
        let elements: Vec<Element<Spatial>> = loose.into_iter().map(tighten).collect();
        let strained = elements.iter().any(|element| element.load(state).force != 0.0);
        state.memory = vec![Memory::default(); elements.len()];
        self.model.fasten(elements)?;
        Ok(strained)
    }
}
