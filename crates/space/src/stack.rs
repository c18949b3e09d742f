//! From a scenario to a stack that can move in space: racks of tubes, barrels of revolution, and which of them meet
//! by which law.

use barrelstack::RunFailure;
use barrelstack::assemble::{AssembleError, PartKind, Similitude, assemble, laws_in_space};
use barrelstack::run::time_step;
use barrelstack::scenario::{BodyOverride, Scenario, Scene, StackBody, StackPair, StackSpec, View};
use barrelstack_dynamics::solid::{Barrel, Hull, Rounded, compound};
use barrelstack_dynamics::{
    Body, BodyId, ContactPair, Counts, Model, Motion, Nodes, Placed, Pose, Rotation3, Spatial,
    Substepping, Twist, Vec3,
};

use crate::known::known;
pub use crate::part::Part;
use crate::part::{Seats, ground};
use crate::rack::{Heights, Tubes, along_barrels, tubes};
use crate::straps::{Loose, straps};

/// Length (m) of boundary that a contact stands for, where constants are stated for a meter of it; as in the plane.
const TRIBUTARY: f64 = 0.01;

/// A stack in space, or the bodies of a free scene there.
#[derive(Clone, Debug)]
pub struct Stack {
    /// What moves.
    pub model: Model<Spatial>,
    /// One part for every body, in the same order; the ground comes first.
    pub parts: Vec<Part>,
    /// The time step (s), the shorter of those of the same stack across its barrels and along them; impacts divide it.
    pub step: f64,
    /// Height (m) from the ground to the top of the highest barrel; zero for a free scene.
    pub height: f64,
    /// Number of levels; zero for a free scene.
    pub levels: u32,
    /// Radius (m) of a barrel at its widest, on which it lies on the ground; zero for a free scene.
    pub bilge_radius: f64,
    /// How far (m) a rack may move on the barrels below, across and along them, before nothing holds it there, as in
    /// the plane of each.
    pub reach: [f64; 2],
    /// Straps that are not tightened yet: that is done on the stack at rest.
    pub(crate) loose: Vec<Loose>,
}

impl Stack {
    /// The body that the motion moves.
    pub const GROUND: BodyId = 0;

    /// Whether it is a free scene, in which nothing has a seat.
    pub fn is_free(&self) -> bool {
        self.levels == 0
    }

    /// Bodies of a kind, in order.
    pub fn of_kind(&self, kind: PartKind) -> impl Iterator<Item = BodyId> + '_ {
        self.parts.iter().enumerate().filter(move |(_, part)| part.kind == kind).map(|(i, _)| i)
    }

    /// Builds the stack of a scenario, or its free scene, not yet at rest.
    ///
    /// ```
    /// use barrelstack::Scenario;
    /// use barrelstack_space::Stack;
    ///
    /// let scenario = Scenario::builtin("demo-napa", &["stack.view=spatial".to_owned()])?;
    /// let stack = Stack::of(&scenario)?;
    /// // Five racks, ten barrels, and the ground.
    /// assert_eq!(stack.parts.len(), 16);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When something that the scenario asks for is not known in space, with its field, or the stack cannot be built.
    pub fn of(scenario: &Scenario) -> Result<Self, RunFailure> {
        if let Scene::Spatial(scene) = &scenario.scene {
            return crate::free::assemble(scenario, scene);
        }
        let spec = stack_of(scenario)?;
        let barrel = known(scenario, spec)?;
        let Pace { step, substepping, reach } = Pace::of(scenario, spec)?;
        let mut builder = Builder::new(spec, barrel);
        builder.build()?;
        let pairs = builder.pairs();
        let Builder { bodies, parts, .. } = builder;
        let loose = straps(spec, &parts, &bodies)?;
        let laws = laws_in_space(spec, Similitude::new(1.0));
        let gravity = Vec3::new(0.0, 0.0, -scenario.run.gravity);
        let mut model = Model::new(bodies, laws, pairs, gravity).map_err(AssembleError::from)?;
        model.set_substepping(substepping);
        let heights = Heights::of(&spec.rack, &barrel);
        let pitch = heights.axis + heights.underside;
        let bilge_radius = barrel.stave_radius + barrel.rounding - barrel.stave_offset;
        let height = f64::from(spec.levels - 1) * pitch + heights.axis + bilge_radius;
        let levels = spec.levels;
        Ok(Self { model, parts, step, height, levels, bilge_radius, reach, loose })
    }
}

/// The stack of a scenario that looks at one in space.
fn stack_of(scenario: &Scenario) -> Result<&StackSpec, AssembleError> {
    match &scenario.scene {
        Scene::Stack { stack, .. } if stack.space.is_some() => Ok(stack),
        Scene::Stack { .. } | Scene::Free(_) | Scene::Spatial(_) => Err(AssembleError::NotInSpace {
            field: "stack.view",
            reason: "this works in space, and the scenario does not look at a stack there: set stack.view to \
                     \"spatial\""
                .into(),
        }),
    }
}

/// The scenario with its stack as a plane shows it.
pub(crate) fn in_plane(scenario: &Scenario, view: View) -> Scenario {
    let mut plane = scenario.clone();
    if let Scene::Stack { stack, .. } = &mut plane.scene {
        *stack = stack.in_plane(view);
    }
    plane
}

/// How a stack is stepped, and how far its racks may slide: as in its planes.
struct Pace {
    /// The time step (s).
    step: f64,
    /// How impacts divide it.
    substepping: Substepping<f64>,
    /// How far (m) a rack may move on the barrels below, across and along them.
    reach: [f64; 2],
}

impl Pace {
    fn of(scenario: &Scenario, spec: &StackSpec) -> Result<Self, RunFailure> {
        let (mut step, mut shortest) = (f64::INFINITY, f64::INFINITY);
        let mut whole_step_depth: Vec<f64> = Vec::new();
        let mut reach = [0.0; 2];
        for (axis, view) in [View::Transverse, View::Longitudinal].into_iter().enumerate() {
            for cut in cuts(scenario, spec, view) {
                let plane = assemble(&cut)?;
                let own = time_step(&cut, &plane)?;
                let divided = plane.model.substepping();
                step = step.min(own);
                // Impacts are as short as in that of the planes which divides its steps the most.
                if divided.substeps > 1.0 {
                    shortest = shortest.min(own / divided.substeps);
                }
                whole_step_depth.resize(divided.whole_step_depth.len(), f64::INFINITY);
                for (depth, own) in whole_step_depth.iter_mut().zip(&divided.whole_step_depth) {
                    *depth = depth.min(*own);
                }
                reach[axis] = plane.rack_reach;
            }
        }
        let substeps = (step / shortest * (1.0 - 1e-9)).ceil().max(1.0);
        Ok(Self { step, substepping: Substepping { substeps, whole_step_depth }, reach })
    }
}

/// The planes that are cut through a stack, each with the bodies that differ in it: across the barrels through every
/// row, along them through every column.
fn cuts(scenario: &Scenario, spec: &StackSpec, view: View) -> Vec<Scenario> {
    let rack = &spec.rack;
    let (count, per_rack) = match view {
        View::Transverse => (spec.space.map_or(1, |space| space.columns_along), rack.barrels_deep),
        View::Longitudinal => (spec.columns, rack.barrels),
    };
    let differ =
        spec.overrides.iter().any(|change| change.column.is_some() || change.row.is_some());
    let cut = |at: u32| {
        let mut plane = in_plane(scenario, view);
        if let Scene::Stack { stack, .. } = &mut plane.scene {
            stack.overrides.clone_from(&spec.overrides);
            stack.overrides.retain_mut(|change| {
                let here = match change.body {
                    StackBody::Barrel => at,
                    StackBody::Rack => (at - 1) / per_rack.max(1) + 1,
                };
                let row = change.row.take();
                let through = match view {
                    View::Transverse => row,
                    View::Longitudinal => {
                        change.offset_x = change.offset_y;
                        std::mem::replace(&mut change.column, row)
                    }
                };
                through.is_none_or(|other| other == here)
            });
        }
        plane
    };
    (1..=if differ { count } else { 1 }).map(cut).collect()
}

/// A stack while it is built up.
struct Builder<'a> {
    spec: &'a StackSpec,
    barrel: Barrel,
    bodies: Vec<Body<Spatial>>,
    parts: Vec<Part>,
}

impl<'a> Builder<'a> {
    fn new(spec: &'a StackSpec, barrel: Barrel) -> Self {
        let part = Part::alone("ground", PartKind::Ground);
        Self { spec, barrel, bodies: vec![ground()], parts: vec![part] }
    }

    /// All levels, racks and their barrels from below.
    fn build(&mut self) -> Result<(), AssembleError> {
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

    /// One rack with its barrels, whose underside has its middle at a place (m); returns the ids of the barrels.
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
        let Some(Tubes { parts: list, beams, posts }) = tubes(&rack, &self.barrel, apart) else {
            return Err(AssembleError::NotInSpace {
                field: "stack.rack.cradle",
                reason: "in space cradles are pairs of supports: set stack.rack.cradle.type to \"supports\", or \
                         stack.view to \"both\""
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
        // Barrels below are in the order of places along the rack, then columns.
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
            // A rack is its own mirror image, so its tubes stay; the barrels change sides.
            let column = if spec.mirror { columns - 1 - column } else { column };
            seats.carries[tube] = Some(id + 1 + (deep * columns + column) as usize);
        }
        self.bodies.push(body);
        self.parts.push(Part {
            name,
            kind: PartKind::Rack,
            level,
            column,
            row,
            carrier: None,
            supports,
            size: 0.5 * rack.width,
            seats,
        });
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
        self.bodies.push(Body {
            name: name.clone(),
            motion: Motion::Free,
            mass: contents.mass,
            inertia: Vec3::new(axial, across, across),
            damping: None,
            pose: Pose { position: self.mirrored(place), orientation: along_barrels() },
            twist: Twist::default(),
            surfaces: vec![Placed {
                surface: hull.surface(),
                offset: Vec3::default(),
                rotation: Rotation3::identity(),
            }],
            nodes: vec![Nodes::Whole(centered)],
            faces: Vec::new(),
        });
        self.parts.push(Part {
            name,
            kind: PartKind::Barrel,
            level,
            column,
            row,
            carrier: Some(carrier),
            supports: Vec::new(),
            size: 0.5 * spec.barrel.section_diameter,
            seats: Seats::default(),
        });
        self.bodies.len() - 1
    }

    /// A place (m), on the other side where the stack is mirrored.
    fn mirrored(&self, place: Vec3) -> Vec3 {
        let side = if self.spec.mirror { -1.0 } else { 1.0 };
        Vec3::new(side * place.x, place.y, place.z)
    }

    /// All boundaries that can ever meet, each with its law: two bodies that the stack joins meet at seats, everything
    /// else about them, and any other two bodies, meets in impacts only.
    fn pairs(&self) -> Vec<ContactPair> {
        let mut list = Vec::new();
        let count = self.bodies.len();
        for a in 1..count {
            self.meet(&mut list, (a, Stack::GROUND), |tube| self.on_ground(a, tube));
            for b in a + 1..count {
                match (self.parts[a].kind, self.parts[b].kind) {
                    (PartKind::Rack, PartKind::Barrel) => {
                        self.meet(&mut list, (a, b), |tube| self.seat(a, tube, b));
                    }
                    (PartKind::Barrel, PartKind::Rack) => {
                        self.meet(&mut list, (b, a), |tube| self.seat(b, tube, a));
                    }
                    (PartKind::Rack, _) => {
                        self.meet(&mut list, (a, b), |_| StackPair::FallenRackRack);
                    }
                    _ => self.meet(&mut list, (a, b), |_| StackPair::BarrelBarrel),
                }
            }
        }
        list
    }

    /// All solids of a body with all of another, each by the law of the first one's.
    fn meet(
        &self,
        list: &mut Vec<ContactPair>,
        (contactor, target): (BodyId, BodyId),
        law: impl Fn(usize) -> StackPair,
    ) {
        for nodes in 0..self.bodies[contactor].nodes.len() {
            let interface = law(nodes) as usize;
            for surface in 0..self.bodies[target].surfaces.len() {
                let counts = Counts::Everywhere;
                list.push(ContactPair { contactor, nodes, target, surface, interface, counts });
            }
        }
    }

    fn on_ground(&self, body: BodyId, tube: usize) -> StackPair {
        let part = &self.parts[body];
        let stands = part.supports.is_empty();
        match part.seats.lies_on.get(tube) {
            None => StackPair::BarrelGround,
            Some(Some(_)) if stands => StackPair::RackGround,
            Some(_) => StackPair::FallenRackGround,
        }
    }

    fn seat(&self, rack: BodyId, tube: usize, barrel: BodyId) -> StackPair {
        let seats = &self.parts[rack].seats;
        let lies = seats.lies_on[tube].as_ref().is_some_and(|on| on.contains(&barrel));
        if lies || seats.carries[tube] == Some(barrel) {
            StackPair::BarrelRack
        } else {
            StackPair::FallenBarrelRack
        }
    }
}

/// What differs at one place, later entries last.
fn changes_of(
    spec: &StackSpec,
    body: StackBody,
    (level, column, row): (u32, u32, u32),
) -> impl Iterator<Item = &BodyOverride> {
    spec.changes_of(body, level, column).filter(move |change| change.row.is_none_or(|r| r == row))
}
