//! Assembly of the three-dimensional stack or free scene of a scenario.

use std::collections::BTreeMap;

use barrelstack::RunFailure;
use barrelstack::assemble::{AssembleError, PartKind, assemble};
use barrelstack::device::Words;
use barrelstack::run::time_step;
use barrelstack::scenario::{Scenario, Scene, StackBody, StackSpec, View};
use barrelstack_dynamics::model::FORESEEN;
use barrelstack_dynamics::{BodyId, Fast, Interface, Model, Spatial, Substepping, Vec3};

use crate::builder::Builder;
use crate::device::{self, Loose};
use crate::known::known;
pub use crate::part::Part;
use crate::rack::Heights;

/// A three-dimensional stack, or the bodies of a three-dimensional free scene.
#[derive(Clone, Debug)]
pub struct Stack {
    /// The model.
    pub model: Model<Spatial>,
    /// Descriptions of all bodies, in the order of the body IDs; the ground comes first.
    pub parts: Vec<Part>,
    /// Time step (s), which is subdivided during impacts; for a stack, the smaller step of its plane models across and
    /// along the barrels.
    pub step: f64,
    /// Height (m) from the ground to the top of the highest barrel; zero for a free scene.
    pub height: f64,
    /// Number of levels; zero for a free scene.
    pub levels: u32,
    /// Radius (m) of a barrel at its bilge, the widest part, on which it lies on the ground; zero for a free scene.
    pub bilge_radius: f64,
    /// Displacements (m) of a rack, across and along the barrels below, beyond which these barrels no longer support
    /// the rack. The values are those of the respective plane models.
    pub reach: [f64; 2],
    /// Vertical force (N) that the staves of a barrel can bear between two racks; zero for a free scene.
    pub stave_capacity: f64,
    /// Force elements of devices that will be attached when the stack is at rest.
    pub(crate) loose: Vec<Loose>,
    /// For each force element of the model, the description of its device.
    pub(crate) devices: Vec<&'static Words>,
}

impl Stack {
    /// The body driven by the ground motion.
    pub const GROUND: BodyId = 0;

    /// Returns `true` for a free scene, which has no seats.
    pub fn is_free(&self) -> bool {
        self.levels == 0
    }

    /// Returns the IDs of all bodies of a kind, in ascending order.
    pub fn of_kind(&self, kind: PartKind) -> impl Iterator<Item = BodyId> + '_ {
        self.parts.iter().enumerate().filter(move |(_, part)| part.kind == kind).map(|(i, _)| i)
    }

    /// Builds the stack of a scenario, or its free scene, without settling it.
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
    /// If the scenario has a feature that is not supported in three dimensions (the error names its field), or if the
    /// stack cannot be built.
    pub fn of(scenario: &Scenario) -> Result<Self, RunFailure> {
        if let Scene::Spatial(scene) = &scenario.scene {
            return crate::free::assemble(scenario, scene);
        }
        let spec = stack_of(scenario)?;
        let barrel = known(scenario, spec)?;
        let pace = Pace::of(scenario, spec)?;
        let mut builder = Builder::new(spec, barrel);
        builder.build()?;
        device::place(&mut builder)?;
        let pairs = builder.pairs();
        let Builder { bodies, parts, laws, loose, held, raised, .. } = builder;
        let gravity = Vec3::new(0.0, 0.0, -scenario.run.gravity);
        let mut model =
            Model::new(bodies, laws.all, pairs, gravity).map_err(AssembleError::from)?;
        model.set_substepping(pace.substepping(model.interfaces()));
        let (elements, devices) = held.into_iter().unzip();
        model.fasten(elements).map_err(AssembleError::from)?;
        let heights = Heights::of(&spec.rack, &barrel);
        let pitch = heights.axis + heights.underside;
        let bilge_radius = barrel.stave_radius + barrel.rounding - barrel.stave_offset;
        let height = f64::from(spec.levels - 1) * pitch + heights.axis + bilge_radius + raised;
        let levels = spec.levels;
        let stave_capacity = spec.barrel.stave_capacity;
        Ok(Self {
            model,
            parts,
            step: pace.step,
            height,
            levels,
            bilge_radius,
            reach: pace.reach,
            stave_capacity,
            loose,
            devices,
        })
    }
}

/// Returns the specification of the stack of a scenario; fails if the scenario has no three-dimensional stack.
fn stack_of(scenario: &Scenario) -> Result<&StackSpec, AssembleError> {
    match &scenario.scene {
        Scene::Stack { stack, .. } if stack.space.is_some() => Ok(stack),
        Scene::Stack { .. } | Scene::Free(_) | Scene::Spatial(_) => Err(AssembleError::NotInSpace {
            field: "stack.view",
            reason: "this needs a three-dimensional stack, but the scenario has none: set stack.view to \"spatial\""
                .into(),
        }),
    }
}

/// Returns the scenario with the stack as a plane model in the given view.
pub(crate) fn in_plane(scenario: &Scenario, view: View) -> Scenario {
    let mut plane = scenario.clone();
    if let Scene::Stack { stack, .. } = &mut plane.scene {
        *stack = stack.in_plane(view);
    }
    plane
}

/// Substepping rules for fast contacts. Such contacts occur in three dimensions when barrels hit the floor with their
/// rims, or when light racks bounce on their own barrels.
const FAST: Fast<f64> = Fast { whole_step_way: 5e-4, hard: 1.0 };

/// Time step and substepping of a stack, and reach of its racks. All values are derived from its plane models.
struct Pace {
    /// The time step (s).
    step: f64,
    /// Number of substeps of a time step during impacts.
    substeps: f64,
    /// For each contact law, by name: the largest penetration (m) at which time steps of full length are short enough.
    depths: BTreeMap<String, f64>,
    /// [`Substepping::resting_allowance`]: the smallest value of all plane models.
    resting_allowance: f64,
    /// Displacements (m) of a rack, across and along the barrels below, beyond which these barrels no longer support
    /// the rack.
    reach: [f64; 2],
}

impl Pace {
    fn of(scenario: &Scenario, spec: &StackSpec) -> Result<Self, RunFailure> {
        let (mut step, mut shortest) = (f64::INFINITY, f64::INFINITY);
        let mut resting_allowance = f64::INFINITY;
        let mut depths: BTreeMap<String, f64> = BTreeMap::new();
        let mut reach = [0.0; 2];
        for (axis, view) in [View::Transverse, View::Longitudinal].into_iter().enumerate() {
            for cut in cuts(scenario, spec, view) {
                let plane = assemble(&cut)?;
                let own = time_step(&cut, &plane)?;
                let divided = plane.model.substepping();
                step = step.min(own);
                // Substeps are as short as in the plane model with the shortest substeps.
                if divided.substeps > 1.0 {
                    shortest = shortest.min(own / divided.substeps);
                }
                // Contact laws are matched by name, because their indices are different in a plane model that merges
                // several seats into one.
                for (law, own) in plane.model.interfaces().iter().zip(&divided.whole_step_depth) {
                    let depth = depths.entry(law.name.clone()).or_insert(f64::INFINITY);
                    *depth = depth.min(*own);
                }
                resting_allowance = resting_allowance.min(divided.resting_allowance);
                reach[axis] = plane.rack_reach;
            }
        }
        let substeps = (step / shortest * (1.0 - 1e-9)).ceil().max(1.0);
        Ok(Self { step, substeps, depths, resting_allowance, reach })
    }

    /// Returns the substepping for a model with the given contact laws.
    fn substepping(&self, laws: &[Interface<Spatial>]) -> Substepping<f64> {
        let depth = |law: &Interface<Spatial>| self.depths.get(&law.name).copied();
        let depths = laws.iter().map(|law| depth(law).unwrap_or(f64::INFINITY));
        Substepping {
            substeps: self.substeps,
            whole_step_depth: depths.collect(),
            resting_allowance: self.resting_allowance,
            foreseen_gap: FORESEEN,
            fast: Some(FAST),
        }
    }
}

/// Returns the scenarios of the plane models of a stack in a view: one for every row in the view across the barrels, or
/// one for every column in the view along the barrels. Each has the overrides that apply to its row or column. If no
/// override names a column or a row, one model is enough.
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
