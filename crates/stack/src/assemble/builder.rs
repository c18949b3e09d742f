//! Builder of a stack: collects its bodies, contact laws and force elements, all scaled to the length scale of the
//! stack.

use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Element, Interface, Nodes, Planar, Pose, Shape, Vec2,
};

use super::bundle::{Bundle, Shown};
use super::interfaces::interface;
use super::solid::{Seat, Solid, Touch, uniform};
use super::{Part, PartKind, Similitude, outline_of};
use crate::device::{Loose, Words};
use crate::scenario::{self, StackBody, StackPair, StackSpec, View};

/// A stack under construction.
pub(crate) struct Builder<'a> {
    pub(crate) spec: &'a StackSpec,
    pub(crate) scale: Similitude,
    pub(crate) bodies: Vec<Body<Planar>>,
    pub(crate) parts: Vec<Part>,
    /// Moment of inertia (kg·m²) of a barrel without overrides.
    inertia: f64,
    /// Contact data of all surfaces: one list per body, in the order of the bodies.
    pub(super) touches: Vec<Vec<Touch>>,
    /// Index of the contact law between barrels and their cradles.
    pub(crate) cradle_law: usize,
    /// Contact laws of devices, numbered after the contact laws of the stack.
    pub(super) laws: Vec<Interface<Planar>>,
    /// Contact pairs of devices, which use the contact laws in `laws`.
    pub(crate) pairs: Vec<ContactPair>,
    /// Force elements that act from the start because the stack does not stand without them. Each element is stored
    /// with the description of its device.
    pub(super) held: Vec<(Element<Planar>, &'static Words)>,
    /// Force elements of devices that are installed after the stack has settled.
    pub(crate) loose: Vec<Loose>,
    /// Height (m) by which devices have raised the stack.
    pub(super) raised: f64,
}

/// Description of a body before it is added to the stack. All values are at full scale, in a frame fixed to the body.
pub(crate) struct Draft {
    pub(crate) name: String,
    pub(crate) kind: PartKind,
    /// Level of the body; `None` if it belongs to no level.
    pub(crate) level: Option<u32>,
    pub(crate) column: u32,
    /// Mass (kg).
    pub(crate) mass: f64,
    /// Moment of inertia (kg·m²) about the center of mass. If given, the center of mass is the origin of the body
    /// frame.
    ///
    /// If `None`, the center of mass and the inertia are computed from the solids, all with the same density.
    pub(crate) inertia: Option<f64>,
    /// Position (m) of the origin of the body frame.
    pub(crate) position: Vec2,
    /// Characteristic size (m) of the body; for a barrel, its radius.
    pub(crate) size: f64,
    pub(crate) solids: Vec<Solid>,
    pub(crate) carrier: Option<BodyId>,
    pub(crate) supports: Vec<BodyId>,
}

impl<'a> Builder<'a> {
    /// Creates a builder with only the ground.
    pub(super) fn new(spec: &'a StackSpec, scale: Similitude) -> Self {
        let (bodies, parts) = (vec![Body::ground(0.0)], vec![Part::ground()]);
        let inertia = spec.barrel.inertia(spec.view);
        Self {
            spec,
            scale,
            bodies,
            parts,
            inertia,
            touches: vec![Vec::new()],
            cradle_law: StackPair::BarrelRack as usize,
            laws: Vec::new(),
            pairs: Vec::new(),
            held: Vec::new(),
            loose: Vec::new(),
            raised: 0.0,
        }
    }

    /// Returns the number of equal slices into which a rack is divided; the planar model contains one slice.
    ///
    /// The number is 1 in the plane across the barrels. In the plane along the barrels, it is the number of barrels
    /// that a rack carries side by side.
    pub(crate) fn side_by_side(&self) -> f64 {
        match self.spec.view {
            View::Transverse => 1.0,
            View::Longitudinal => f64::from(self.spec.rack.barrels),
        }
    }

    /// Adds a contact law of a device and returns its index.
    pub(crate) fn add_law(&mut self, name: &str, law: &scenario::Interface) -> usize {
        self.add_bundle(name, law, Bundle::ONE)
    }

    /// Adds a contact law for barrels in their cradles and returns its index.
    pub(crate) fn add_cradle(&mut self, name: &str, law: &scenario::Interface) -> usize {
        let shown = Shown::Plane(self.spec.view);
        self.add_bundle(name, law, Bundle::of_cradle(law, self.spec, shown))
    }

    fn add_bundle(&mut self, name: &str, law: &scenario::Interface, bundle: Bundle) -> usize {
        self.laws.push(interface(name, law, bundle, self.scale));
        StackPair::ALL.len() + self.laws.len() - 1
    }

    /// Adds a force element that acts from the start, because the stack does not stand without it.
    pub(crate) fn hold(&mut self, element: impl Into<Element<Planar>>, words: &'static Words) {
        self.held.push((element.into(), words));
    }

    /// Raises everything that stands on the ground by a height (m).
    pub(crate) fn raise(&mut self, height: f64) {
        for body in &mut self.bodies[1..] {
            body.pose.position.z += height;
        }
        self.raised = height;
    }

    /// Scales a body, adds it to the stack, and returns its ID.
    pub(crate) fn add(&mut self, draft: Draft) -> BodyId {
        let length = self.scale.length;
        let (center, inertia) = if let Some(inertia) = draft.inertia {
            (Vec2::default(), inertia)
        } else {
            let (center, square_radius) = uniform(&draft.solids);
            (center, draft.mass * square_radius)
        };
        let mut body = Body::free(
            &draft.name,
            draft.mass * self.scale.mass(),
            inertia * self.scale.inertia(),
            Pose { position: (draft.position + center) * length, orientation: 0.0 },
        );
        let add = |solid: Solid| solid.add_to(&mut body, center, length);
        let touches: Vec<Touch> = draft.solids.into_iter().map(add).collect();
        let outlines = body.surfaces.iter().map(outline_of);
        self.parts.push(Part {
            name: draft.name,
            kind: draft.kind,
            level: draft.level,
            column: Some(draft.column),
            carrier: draft.carrier,
            supports: draft.supports,
            size: draft.size * length,
            wine: 0.0,
            foot: center.z * length,
            outlines: outlines.collect(),
            out_of_plane: touches.iter().map(|touch| touch.out_of_plane).collect(),
        });
        self.bodies.push(body);
        self.touches.push(touches);
        self.bodies.len() - 1
    }

    /// Returns the name and mass (kg) of a rack, and its displacement (m) from its regular position, positive to the
    /// right in a stack that is not mirrored. The overrides of the scenario are applied.
    pub(super) fn rack_at(&self, level: u32, column: u32) -> (String, f64, f64) {
        let mut mass = self.spec.rack.mass;
        let mut offset = 0.0;
        for change in self.spec.changes_of(StackBody::Rack, level, column) {
            mass = change.mass.unwrap_or(mass);
            offset += change.offset_x;
        }
        let name = if self.spec.racks_per_level() == 1 {
            format!("R{level}")
        } else {
            format!("R{level}.{column}")
        };
        (name, mass, offset)
    }

    /// Adds the barrels of a rack, all of the same shape and characteristic size (m), and returns their IDs.
    ///
    /// `places` are the positions of the barrels along the rack (m), relative to `origin` (m); `column` is the column
    /// of the rack.
    pub(super) fn add_barrels(
        &mut self,
        carrier: BodyId,
        (level, column): (u32, u32),
        (origin, places): (Vec2, &[f64]),
        (shape, size): (&Shape, f64),
    ) -> Vec<BodyId> {
        let spec = self.spec;
        let first = (column - 1) * u32::try_from(places.len()).unwrap_or(0) + 1;
        let mut barrels = Vec::new();
        for (column, place) in (first..).zip(places) {
            let mut barrel = spec.barrel.clone();
            let (mut inertia, mut offset) = (self.inertia, 0.0);
            for change in self.spec.changes_of(StackBody::Barrel, level, column) {
                barrel = barrel.altered(change.mass, change.fill);
                inertia = barrel.inertia(spec.view);
                offset += change.offset_x;
            }
            let body = self.add(Draft {
                name: format!("B{level}.{column}"),
                kind: PartKind::Barrel,
                level: Some(level),
                column,
                mass: barrel.mass,
                inertia: Some(inertia),
                position: Vec2::new(origin.x + place + offset, origin.z),
                size,
                solids: vec![Solid::exact(shape.clone(), Vec2::default(), Seat::None)],
                carrier: Some(carrier),
                supports: Vec::new(),
            });
            self.parts[body].wine = barrel.wine();
            barrels.push(body);
        }
        barrels
    }

    /// Mirrors the stack left to right: everything at `x` moves to `−x`.
    pub(super) fn mirror(&mut self) {
        let flip = |v: &mut Vec2| v.x = -v.x;
        for body in &mut self.bodies {
            flip(&mut body.pose.position);
            // Negating zero would give -0 and change the bits of the results.
            if body.pose.orientation != 0.0 {
                body.pose.orientation = -body.pose.orientation;
            }
            for face in &mut body.faces {
                flip(&mut face.point);
                flip(&mut face.outward);
            }
            for placed in &mut body.surfaces {
                flip(&mut placed.offset);
                // All shapes of a stack other than polygons are symmetric left to right.
                if let Shape::Polygon(polygon) = &placed.surface {
                    placed.surface = Shape::Polygon(polygon.mirrored());
                }
            }
            for set in &mut body.nodes {
                match set {
                    Nodes::Fixed(nodes) => nodes.iter_mut().for_each(|n| flip(&mut n.position)),
                    Nodes::Rounds(rounds) => {
                        for round in rounds {
                            flip(&mut round.center);
                            round.limits.iter_mut().for_each(flip);
                            round.arc_limits.iter_mut().flatten().for_each(flip);
                            round.sides.iter_mut().flatten().for_each(|side| flip(&mut side.0));
                        }
                    }
                    Nodes::Rolling { center, .. } => flip(center),
                    Nodes::Whole(none) => match *none {},
                }
            }
        }
        for outline in self.parts.iter_mut().flat_map(|part| &mut part.outlines) {
            outline.points.iter_mut().for_each(flip);
        }
    }
}
