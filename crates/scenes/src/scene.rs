//! Planar test scenes of floors, blocks and discs, and the runner of planar and three-dimensional scenes.

use std::ops::ControlFlow;

use barrelstack_dynamics::shape::{BoundaryNode, Circle, Polygon};
use barrelstack_dynamics::simulate::RunTotals;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    Basis, Body, BodyId, ContactPair, Counts, Drive, EnergyLedger, FrictionLaw, Interface, Method,
    Model, ModelError, Node, Nodes, NormalLaw, Placed, Planar, Pose, RunError, Scratch,
    SettleError, Settled, Shape, Simulation, Space, State, Vec2, look, math, settle, simulate,
};

use crate::GRAVITY;

/// Gravity in the direction of −z (m/s²).
pub const DOWN: Vec2 = Vec2::new(0.0, -GRAVITY);

/// Returns gravity (m/s²) in the frame of a slope that descends to the right at an angle (rad).
///
/// The slope is modeled as a level floor under rotated gravity.
pub fn gravity_on_slope(angle: f64) -> Vec2 {
    Vec2::new(GRAVITY * math::sin(angle), -GRAVITY * math::cos(angle))
}

/// Places a shape at the origin of its body.
pub fn centered(shape: Shape) -> Placed<Planar> {
    Placed { surface: shape, offset: Vec2::default(), rotation: Rotation2::identity() }
}

/// Returns a ground body with the given surfaces.
pub fn ground_of(surfaces: Vec<Placed<Planar>>) -> Body<Planar> {
    Body { surfaces, ..floor() }
}

/// Returns a level floor at `z = 0`.
pub fn floor() -> Body<Planar> {
    Body::ground(0.0)
}

/// Returns a pose from a position (m) and an angle (rad).
pub fn pose(x: f64, z: f64, orientation: f64) -> Pose<Planar> {
    Pose { position: Vec2::new(x, z), orientation }
}

/// Returns a free disc with one rolling node: the point of its rim with the largest penetration into the other body.
///
/// `gyration_squared` is the squared radius of gyration k² (m²), which is ½ r² for a solid disc.
pub fn disc(
    name: &str,
    radius: f64,
    mass: f64,
    gyration_squared: f64,
    center: Vec2,
) -> Body<Planar> {
    Body {
        surfaces: vec![centered(Shape::Circle(Circle { radius }))],
        nodes: vec![Nodes::Rolling { center: Vec2::default(), radius, tributary_length: 1.0 }],
        ..Body::free(name, mass, mass * gyration_squared, pose(center.x, center.z, 0.0))
    }
}

/// Returns a rectangle with sharp corners, centered at the origin; its corners are listed counterclockwise from the
/// lower left.
///
/// # Panics
/// If a side is not a positive number, which is a mistake in the definition of the scene.
pub fn rectangle(width: f64, height: f64) -> Polygon {
    match Polygon::rectangle(width, height, 0.0) {
        Ok(polygon) => polygon,
        Err(problem) => panic!("a rectangle of {width} m by {height} m: {problem}"),
    }
}

/// Returns a free rectangular block with sharp corners and a node at each of them.
pub fn block(name: &str, size: (f64, f64), mass: f64, pose: Pose<Planar>) -> Body<Planar> {
    finely_noded_block(name, size, mass, f64::INFINITY, pose)
}

/// Returns a free rectangular block with nodes along its whole boundary, at most `spacing` (m) apart.
pub fn finely_noded_block(
    name: &str,
    (width, height): (f64, f64),
    mass: f64,
    spacing: f64,
    pose: Pose<Planar>,
) -> Body<Planar> {
    let shape = Shape::Polygon(rectangle(width, height));
    let inertia = mass * (width * width + height * height) / 12.0;
    Body {
        nodes: vec![fixed(&shape.nodes(spacing))],
        surfaces: vec![centered(shape)],
        ..Body::free(name, mass, inertia, pose)
    }
}

/// Converts the boundary nodes of a shape to nodes of a body that has the shape at its origin.
pub fn fixed(nodes: &[BoundaryNode]) -> Nodes<Planar> {
    let node = |n: &BoundaryNode| Node {
        position: n.position,
        tributary_length: n.tributary_length,
        outward: None,
    };
    Nodes::Fixed(nodes.iter().map(node).collect())
}

/// Returns a node set with one node at each of the given points (m) of a body.
pub fn points(points: &[Vec2]) -> Nodes<Planar> {
    Nodes::Fixed(
        points
            .iter()
            .map(|p| Node { position: *p, tributary_length: 1.0, outward: None })
            .collect(),
    )
}

/// Returns an interface with the given laws, whose constants are per node ([`Basis::Node`]).
pub fn interface<S: Space<Real = f64>>(normal: NormalLaw, friction: FrictionLaw) -> Interface<S> {
    Interface {
        name: "contact".into(),
        normal,
        stop: None,
        rolling: None,
        friction,
        basis: Basis::Node,
    }
}

/// Returns a Coulomb friction law with equal static and kinetic coefficients.
pub fn coulomb(
    coefficient: f64,
    tangential_stiffness: f64,
    tangential_damping: f64,
) -> FrictionLaw {
    FrictionLaw::Coulomb {
        static_coefficient: coefficient,
        kinetic_coefficient: coefficient,
        tangential_stiffness,
        tangential_damping,
    }
}

/// Returns the contact pair between the first node set of one body and the first surface of another. The pair has the
/// contact laws of the interface with index 0.
pub fn pair(contactor: BodyId, target: BodyId) -> ContactPair {
    ContactPair {
        contactor,
        nodes: 0,
        target,
        surface: 0,
        interface: 0,
        counts: Counts::Everywhere,
    }
}

/// Returns the contact pairs between every body that has nodes and the first surface of every other body.
///
/// Two discs, or two solids, form only one pair. Between a disc and a convex boundary, only the disc is a contactor.
pub fn all_pairs<S: Space>(bodies: &[Body<S>]) -> Vec<ContactPair> {
    let round =
        |i: usize| matches!(bodies[i].nodes.first(), Some(Nodes::Rolling { .. } | Nodes::Whole(_)));
    let mut pairs = vec![];
    for contactor in 0..bodies.len() {
        for target in 0..bodies.len() {
            let convex = matches!(bodies[contactor].nodes.first(), Some(Nodes::Rounds(_)));
            let meets_twice = round(target) && (convex || round(contactor) && contactor > target);
            if contactor != target
                && !bodies[contactor].nodes.is_empty()
                && !bodies[target].surfaces.is_empty()
                && !meets_twice
            {
                pairs.push(pair(contactor, target));
            }
        }
    }
    pairs
}

/// A model with its state, ready to be settled and run.
pub struct Scene<S: Space = Planar> {
    /// The model, constant during a run.
    pub model: Model<S>,
    /// The current state.
    pub state: State<S>,
    /// Working memory of the simulation, which holds the forces in the current state.
    pub scratch: Scratch<S>,
    /// Integration method; velocity Verlet by default.
    pub method: Method,
}

impl<S: Space<Real = f64>> Scene<S> {
    /// Creates a scene of bodies that can all touch each other, with the same interface between all of them.
    ///
    /// # Errors
    /// If the bodies do not make a valid model.
    pub fn new(
        bodies: Vec<Body<S>>,
        interface: Interface<S>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        let pairs = all_pairs(&bodies);
        Ok(Self::of(Model::new(bodies, vec![interface], pairs, gravity)?))
    }

    /// Creates a scene from a model in its initial state.
    pub fn of(model: Model<S>) -> Self {
        let state = State::initial(&model);
        let scratch = Scratch::new(&model);
        Self { model, state, scratch, method: Method::VelocityVerlet }
    }

    /// Brings the scene to static equilibrium and returns the scene.
    ///
    /// # Errors
    /// If a body moves out of place, or the remaining accelerations exceed `tolerance` (a fraction of gravity).
    pub fn settled(mut self, tolerance: f64) -> Result<Self, SettleError> {
        self.settle(tolerance)?;
        Ok(self)
    }

    /// Brings the scene to static equilibrium. Returns the number of steps, the residual acceleration, and a summary of
    /// the friction forces at rest.
    ///
    /// # Errors
    /// If a body moves out of place, or the remaining accelerations exceed `tolerance` (a fraction of gravity).
    pub fn settle(&mut self, tolerance: f64) -> Result<Settled, SettleError> {
        settle(&self.model, &mut self.state, &mut self.scratch, tolerance)
    }

    /// Sets the integration method.
    pub fn by(&mut self, method: Method) -> &mut Self {
        self.method = method;
        self
    }

    /// Runs the scene until `end_time` (s).
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn run(
        &mut self,
        drive: &impl Drive<S>,
        time_step: f64,
        end_time: f64,
    ) -> Result<RunTotals<S>, RunError> {
        self.watch(drive, time_step, end_time, |_, _, _| ControlFlow::Continue(()))
    }

    /// Runs the scene until `end_time` (s) and calls `observer` after every accepted step.
    ///
    /// # Errors
    /// If the run fails numerically.
    pub fn watch(
        &mut self,
        drive: &impl Drive<S>,
        time_step: f64,
        end_time: f64,
        observer: impl FnMut(&State<S>, &Scratch<S>, &EnergyLedger<S>) -> ControlFlow<()>,
    ) -> Result<RunTotals<S>, RunError> {
        let simulation = Simulation { method: self.method, time_step, end_time };
        let Self { model, state, scratch, .. } = self;
        simulate(model, drive, state, scratch, &simulation, &mut look(observer))
    }
}

impl Scene {
    /// Returns the position of a body along `x` (m) relative to body 0, the ground.
    pub fn relative(&self, body: usize) -> f64 {
        self.state.poses[body].position.x - self.state.poses[0].position.x
    }
}
