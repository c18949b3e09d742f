//! Bodies made of several solids, such as racks made of tubes, and their contact pairs.

use super::{Bulk, Hull, Rounded};
use crate::body::{Body, BodyId, Nodes, Placed};
use crate::model::{ContactPair, Counts, InterfaceId};
use crate::space::{Pose, Rotation3, Spatial, Vec3};

/// One solid of a compound body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Surface of the solid, used both as contactor and as target.
    pub hull: Hull,
    /// Position (m) of the solid's origin in the common frame of all parts.
    pub center: Vec3,
    /// Rotation from the frame of the solid to the common frame.
    pub rotation: Rotation3,
    /// Mass distribution in the frame of the solid.
    pub bulk: Bulk,
}

/// Creates a free body from several solids that are given in a common frame.
///
/// The body frame has its origin at the center of mass and its axes along the principal axes; the pose of the body is
/// the pose of this frame in the common frame.
///
/// Every solid is a boundary of its own, so two bodies need the contact pairs of [`pairs_between`]. For bodies that are
/// far apart, only the bounding balls are tested, and only when the list of contact elements is built.
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

/// Returns the contact pairs of every solid of one body with every solid of another; the solids of the first body are
/// the contactors.
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
