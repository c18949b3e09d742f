//! Construction of a three-dimensional stack: racks made of tubes, barrels as bodies of revolution, and contact pairs
//! with their contact laws.

use barrelstack::assemble::{AssembleError, PartKind, law_in_space, laws_in_space};
use barrelstack::device::{Isolators, Words};
use barrelstack::scenario::{BodyOverride, StackBody, StackPair, StackSpec, View};
use barrelstack_dynamics::solid::{Barrel, Hull, Rounded, compound};
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Counts, Element, Interface, InterfaceId, Nodes, Placed, Pose,
    Rotation3, Spatial, Vec3,
};

use crate::device::Loose;
use crate::part::{Part, Seats, ground};
use crate::rack::{Heights, Tubes, along_barrels, reach_along, tubes};
use crate::stack::Stack;

/// Tributary length (m) of a contact: the factor by which contact constants per meter are multiplied. The plane models
/// use the same value.
pub(crate) const TRIBUTARY: f64 = 0.01;

/// A stack under construction.
pub(crate) struct Builder<'a> {
    pub(crate) spec: &'a StackSpec,
    pub(crate) barrel: Barrel,
    pub(crate) bodies: Vec<Body<Spatial>>,
    /// Description of every body, in the order of the body IDs.
    pub(crate) parts: Vec<Part>,
    pub(crate) laws: Laws,
    /// Force elements that will be attached when the stack is at rest.
    pub(crate) loose: Vec<Loose>,
    /// Elements that already act while the stack settles, because it would not stand without them; each with the
    /// description of its device.
    pub(crate) held: Vec<(Element<Spatial>, &'static Words)>,
    /// Contact pairs between the ground and the bearings of platforms.
    pub(crate) bearings: Vec<ContactPair>,
    /// Height (m) by which devices under the stack, such as isolators, raise the stack.
    pub(crate) raised: f64,
}

/// List of all contact laws, and the indices of those that depend on the devices.
pub(crate) struct Laws {
    /// All contact laws: those of [`StackPair::ALL`] at their indices, followed by those of the devices.
    pub(crate) all: Vec<Interface<Spatial>>,
    /// Index of the contact law between a barrel and its cradle.
    cradle: InterfaceId,
    /// Index of the contact law of a bearing; a platform has one bearing at each corner. `None` if there are no
    /// platforms.
    pub(crate) bearing: Option<InterfaceId>,
}

impl Laws {
    fn of(spec: &StackSpec) -> Self {
        let mut all = laws_in_space(spec);
        let mut add = |name, law| {
            all.push(law_in_space(name, &law));
            all.len() - 1
        };
        let pad = spec.devices.pad.law();
        let cradle = pad.map_or(StackPair::BarrelRack as usize, |law| add("pad", law));
        // In a plane model, the contact law belongs to one end of a platform. In three dimensions an end has two
        // corners, so each corner has half of the constants.
        let isolator = Some(spec.devices.isolator).filter(Isolators::is_on);
        let bearing = isolator.map(|isolator| add("isolator-ground", isolator.law(0.5)));
        Self { all, cradle, bearing }
    }
}

impl<'a> Builder<'a> {
    pub(crate) fn new(spec: &'a StackSpec, barrel: Barrel) -> Self {
        Self {
            spec,
            barrel,
            bodies: vec![ground()],
            parts: vec![Part::alone("ground", PartKind::Ground)],
            laws: Laws::of(spec),
            loose: Vec::new(),
            held: Vec::new(),
            bearings: Vec::new(),
            raised: 0.0,
        }
    }

    /// Returns the distance (m), along the barrels, from the middle of a rack to its outermost beams.
    pub(crate) fn reach_along(&self) -> f64 {
        reach_along(&self.spec.rack, self.spec.barrel.length + self.spec.gap)
    }

    /// Adds a body and returns its ID.
    pub(crate) fn add(&mut self, body: Body<Spatial>, part: Part) -> BodyId {
        self.bodies.push(body);
        self.parts.push(part);
        self.bodies.len() - 1
    }

    /// Raises all bodies except the ground by a height (m).
    pub(crate) fn raise(&mut self, height: f64) {
        for body in &mut self.bodies[1..] {
            body.pose.position.z += height;
        }
        self.raised = height;
    }

    /// Adds all racks and their barrels, level by level from below.
    pub(crate) fn build(&mut self) -> Result<(), AssembleError> {
        let Self { spec, barrel, .. } = *self;
        let (racks, rows) = (spec.racks_per_level(), spec.racks_along());
        let apart = spec.barrel.length + spec.gap;
        let heights = Heights::of(&spec.rack, &barrel);
        let middle = |at: u32, count: u32| f64::from(at) - 0.5 * f64::from(count - 1);
        let mut below: Vec<Vec<BodyId>> = vec![Vec::new(); (racks * rows) as usize];
        for level in 1..=spec.levels {
            let underside = f64::from(level - 1) * (heights.axis + heights.underside);
            for row in 0..rows {
                for column in 0..racks {
                    let slot = (row * racks + column) as usize;
                    let supports = std::mem::take(&mut below[slot]);
                    let place = Vec3::new(
                        middle(column, racks) * (spec.rack.width + spec.gap),
                        middle(row, rows) * f64::from(spec.rack.barrels_deep) * apart,
                        underside,
                    );
                    below[slot] = self.add_rack((level, column + 1, row + 1), place, supports)?;
                }
            }
        }
        Ok(())
    }

    /// Adds a rack with its barrels and returns the IDs of the barrels. `place` is the nominal position (m) of the
    /// middle of the rack's underside.
    fn add_rack(
        &mut self,
        (level, column, row): (u32, u32, u32),
        place: Vec3,
        supports: Vec<BodyId>,
    ) -> Result<Vec<BodyId>, AssembleError> {
        let spec = self.spec;
        let mut rack = spec.rack.clone();
        let mut place = place;
        for change in changes_of(spec, StackBody::Rack, (level, column, row)) {
            rack.mass = change.mass.unwrap_or(rack.mass);
            place += Vec3::new(change.offset_x, change.offset_y, 0.0);
        }
        let apart = spec.barrel.length + spec.gap;
        let chocks = Some(spec.devices.chock).filter(|chock| chock.at(level, spec.levels));
        let Some(Tubes { parts: list, beams, posts }) = tubes(&rack, &self.barrel, apart, chocks)
        else {
            return Err(AssembleError::NotInSpace {
                field: "stack.rack.cradle",
                reason: "in three dimensions a cradle must be a pair of supports: set stack.rack.cradle.type to \
                         \"supports\", or stack.view to \"both\""
                    .into(),
            });
        };
        let many = (spec.racks_per_level() > 1, spec.racks_along() > 1);
        let name = match many {
            (false, false) => format!("R{level}"),
            (true, false) => format!("R{level}.{column}"),
            (_, true) => format!("R{level}.{column}.{row}"),
        };
        let mut body = compound(&name, &list, TRIBUTARY);
        body.pose.position += self.mirrored(place);
        let id = self.bodies.len();
        let count = list.len();
        let mut seats = Seats { carries: vec![None; count], lies_on: vec![None; count] };
        // The barrels below are ordered by row, and within a row by column.
        let columns = rack.barrels;
        for (deep, tube) in beams {
            let of_beam = supports
                .iter()
                .enumerate()
                .filter(|(at, _)| *at / columns as usize == deep as usize)
                .map(|(_, id)| *id);
            seats.lies_on[tube] = Some(of_beam.collect());
        }
        for ((column, deep), tube) in posts {
            // A rack is symmetric, so in a mirrored stack its tubes stay in place, but its barrels change sides.
            let column = if spec.mirror { columns - 1 - column } else { column };
            seats.carries[tube] = Some(id + 1 + (deep * columns + column) as usize);
        }
        let part = Part {
            level,
            column,
            row,
            supports,
            size: 0.5 * rack.width,
            seats,
            ..Part::alone(&name, PartKind::Rack)
        };
        self.add(body, part);
        let middle = |at: u32, count: u32| f64::from(at) - 0.5 * f64::from(count - 1);
        let heights = Heights::of(&rack, &self.barrel);
        let mut barrels = Vec::new();
        for deep in 0..rack.barrels_deep {
            for at in 0..columns {
                let own = Vec3::new(
                    middle(at, columns) * rack.pitch,
                    middle(deep, rack.barrels_deep) * apart,
                    heights.axis,
                );
                let column = (column - 1) * columns + at + 1;
                let row = (row - 1) * rack.barrels_deep + deep + 1;
                barrels.push(self.add_barrel(id, (level, column, row), place + own));
            }
        }
        Ok(barrels)
    }

    fn add_barrel(
        &mut self,
        carrier: BodyId,
        (level, column, row): (u32, u32, u32),
        place: Vec3,
    ) -> BodyId {
        let spec = self.spec;
        let mut contents = spec.barrel.clone();
        let mut place = place;
        for change in changes_of(spec, StackBody::Barrel, (level, column, row)) {
            contents = contents.altered(change.mass, change.fill);
            place += Vec3::new(change.offset_x, change.offset_y, 0.0);
        }
        let rows = spec.space.map_or(1, |space| space.columns_along);
        let name = if rows > 1 {
            format!("B{level}.{column}.{row}")
        } else {
            format!("B{level}.{column}")
        };
        let [axial, across] =
            [View::Transverse, View::Longitudinal].map(|view| contents.inertia(view));
        let hull = Hull::Barrel(self.barrel);
        let centered = Rounded { tributary_length: TRIBUTARY, ..Rounded::centered(hull) };
        let pose = Pose { position: self.mirrored(place), orientation: along_barrels() };
        let body = Body {
            surfaces: vec![Placed {
                surface: hull.surface(),
                offset: Vec3::default(),
                rotation: Rotation3::identity(),
            }],
            nodes: vec![Nodes::Whole(centered)],
            ..Body::free(&name, contents.mass, Vec3::new(axial, across, across), pose)
        };
        let part = Part {
            level,
            column,
            row,
            carrier: Some(carrier),
            size: 0.5 * spec.barrel.section_diameter,
            wine: contents.wine(),
            ..Part::alone(&name, PartKind::Barrel)
        };
        self.add(body, part)
    }

    /// Returns a position (m), or its mirror image if the stack is mirrored.
    pub(crate) fn mirrored(&self, place: Vec3) -> Vec3 {
        let side = if self.spec.mirror { -1.0 } else { 1.0 };
        Vec3::new(side * place.x, place.y, place.z)
    }

    /// Returns all pairs of surfaces that can touch, each with its contact law.
    ///
    /// Where one body rests on another, the contact law of the seat applies. The contact laws for impacts apply to all
    /// other surfaces of the two bodies, and to bodies that do not rest on each other.
    pub(crate) fn pairs(&self) -> Vec<ContactPair> {
        let mut list = Vec::new();
        let count = self.bodies.len();
        for a in 1..count {
            self.meet(&mut list, (a, Stack::GROUND), |tube| self.on_ground(a, tube) as usize);
            for b in a + 1..count {
                match (self.parts[a].kind, self.parts[b].kind) {
                    (PartKind::Rack, PartKind::Barrel) => {
                        self.meet(&mut list, (a, b), |tube| self.seat(a, tube, b));
                    }
                    (PartKind::Barrel, PartKind::Rack) => {
                        self.meet(&mut list, (b, a), |tube| self.seat(b, tube, a));
                    }
                    (PartKind::Rack, PartKind::Device) => {
                        self.meet(&mut list, (a, b), |tube| self.on_platform(a, tube, b) as usize);
                    }
                    (PartKind::Barrel, PartKind::Device) => {
                        self.meet(&mut list, (a, b), |_| StackPair::FallenBarrelRack as usize);
                    }
                    (PartKind::Rack, _) | (PartKind::Device, PartKind::Device) => {
                        self.meet(&mut list, (a, b), |_| StackPair::FallenRackRack as usize);
                    }
                    _ => self.meet(&mut list, (a, b), |_| StackPair::BarrelBarrel as usize),
                }
            }
        }
        list.extend(&self.bearings);
        list
    }

    /// Returns the number of solids of a body that can touch other bodies. These solids are the first ones in the
    /// body's lists of surfaces and node sets.
    fn solids(&self, body: BodyId) -> usize {
        // The other surfaces of the ground are dishes, which touch only bearings.
        if body == Stack::GROUND { 1 } else { self.bodies[body].surfaces.len() }
    }

    /// Adds a contact pair for each combination of a solid of the contactor and a solid of the target.
    ///
    /// `law` is called with the index of the contactor's solid and returns the contact law of the pair.
    fn meet(
        &self,
        list: &mut Vec<ContactPair>,
        (contactor, target): (BodyId, BodyId),
        law: impl Fn(usize) -> InterfaceId,
    ) {
        for nodes in 0..self.solids(contactor) {
            let interface = law(nodes);
            for surface in 0..self.solids(target) {
                let counts = Counts::Everywhere;
                list.push(ContactPair { contactor, nodes, target, surface, interface, counts });
            }
        }
    }

    fn on_ground(&self, body: BodyId, tube: usize) -> StackPair {
        let part = &self.parts[body];
        let stands = part.supports.is_empty();
        match (part.kind, part.seats.lies_on.get(tube)) {
            (PartKind::Barrel, _) => StackPair::BarrelGround,
            (_, Some(Some(_))) if stands => StackPair::RackGround,
            _ => StackPair::FallenRackGround,
        }
    }

    /// Returns the kind of contact between a tube of a rack and a platform. A rack stands on its own platform in the
    /// same way as on the ground.
    fn on_platform(&self, rack: BodyId, tube: usize, device: BodyId) -> StackPair {
        let part = &self.parts[rack];
        match part.seats.lies_on.get(tube) {
            Some(Some(_)) if part.carrier == Some(device) => StackPair::RackGround,
            _ => StackPair::FallenRackRack,
        }
    }

    fn seat(&self, rack: BodyId, tube: usize, barrel: BodyId) -> InterfaceId {
        let seats = &self.parts[rack].seats;
        if seats.carries[tube] == Some(barrel) {
            self.laws.cradle
        } else if seats.lies_on[tube].as_ref().is_some_and(|on| on.contains(&barrel)) {
            StackPair::BarrelRack as usize
        } else {
            StackPair::FallenBarrelRack as usize
        }
    }
}

/// Returns the overrides of one body, in the order in which they apply.
fn changes_of(
    spec: &StackSpec,
    body: StackBody,
    (level, column, row): (u32, u32, u32),
) -> impl Iterator<Item = &BodyOverride> {
    spec.changes_of(body, level, column).filter(move |change| change.row.is_none_or(|r| r == row))
}
