//! Bodies of several solids, such as racks of tubes, and which of their solids may meet.

use super::{Bulk, Hull, Rounded};
use crate::body::{Body, BodyId, Nodes, Placed};
use crate::model::{ContactPair, Counts, InterfaceId};
use crate::space::{Pose, Rotation3, Spatial, Vec3};

/// A solid of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// What touches and can be touched.
    pub hull: Hull,
    /// Its origin (m) in the frame in which the body is described.
    pub center: Vec3,
    /// How its frame is turned there.
    pub rotation: Rotation3,
    /// Its matter, in its own frame.
    pub bulk: Bulk,
}

/// A free body of several solids, at the place where it is described: its frame becomes that of its
/// principal axes about its center of mass, its pose says where that is.
///
/// Solids touch one by one, so a pair of bodies is as many contact pairs as [`pairs_between`] says; those
/// that are far apart cost a look at their balls when the list of contact elements is built.
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

/// The contact pairs of two bodies whose solids may all meet, each once: those of the first are the
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
