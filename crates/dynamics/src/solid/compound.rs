//! Bodies of several solids, such as racks of tubes, and their contact pairs.

use super::{Bulk, Hull, Rounded};
use crate::body::{Body, BodyId, Nodes, Placed};
use crate::model::{ContactPair, Counts, InterfaceId};
use crate::space::{Pose, Rotation3, Spatial, Vec3};

/// A solid of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its surface, both contactor and target.
    pub hull: Hull,
    /// Its origin (m) in the frame of the description.
    pub center: Vec3,
    /// Its rotation in that frame.
    pub rotation: Rotation3,
    /// Its mass distribution, in its own frame.
    pub bulk: Bulk,
}

/// Creates a free body of several solids, in place: its frame becomes that of its principal axes about its center of
/// mass, and its pose is where that is.
///
/// Solids touch one by one, so a pair of bodies has the contact pairs of [`pairs_between`]; for distant ones only
/// their balls are tested when the list of contact elements is built.
pub fn compound(name: &str, parts: &[Part], tributary_length: f64) -> Body<Spatial> {
    let whole = Bulk::sum(parts.iter().map(|part| part.bulk.placed(part.center, part.rotation)));
    let (inertia, orientation) = whole.principal();
    let turned = orientation.matrix();
    let place = |part: &Part| {
        let center = turned.unapply(part.center - whole.center);
        (center, turned.back().after(part.rotation))
    };
    let surface = |part: &Part| {
        let (offset, rotation) = place(part);
        Placed { surface: part.hull.surface(), offset, rotation }
    };
    let node = |part: &Part| {
        let (center, rotation) = place(part);
        Nodes::Whole(Rounded { hull: part.hull, center, rotation, tributary_length })
    };
    Body {
        surfaces: parts.iter().map(surface).collect(),
        nodes: parts.iter().map(node).collect(),
        ..Body::free(name, whole.mass, inertia, Pose { position: whole.center, orientation })
    }
}

/// Returns the contact pairs of two bodies all of whose solids may touch, each once: those of the first are the
/// contactors.
pub fn pairs_between(
    bodies: &[Body<Spatial>],
    contactor: BodyId,
    target: BodyId,
    interface: InterfaceId,
) -> Vec<ContactPair> {
    let all = |nodes| {
        let with = move |surface| {
            let counts = Counts::Everywhere;
            ContactPair { contactor, nodes, target, surface, interface, counts }
        };
        (0..bodies[target].surfaces.len()).map(with)
    };
    (0..bodies[contactor].nodes.len()).flat_map(all).collect()
}
