//! Scenes: floors, blocks and discs, run while a function looks at every step.

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

/// Free fall straight down (m/s²).
pub const DOWN: Vec2 = Vec2::new(0.0, -GRAVITY);

/// Free fall as felt on a plane that falls to the right at an angle (rad): a slope is a level floor
/// under turned gravity.
pub fn gravity_on_slope(angle: f64) -> Vec2 {
    Vec2::new(GRAVITY * math::sin(angle), -GRAVITY * math::cos(angle))
}

/// A shape at the origin of its body.
pub fn centered(shape: Shape) -> Placed<Planar> {
    Placed { surface: shape, offset: Vec2::default(), rotation: Rotation2::identity() }
}

/// The ground with what is fixed to it.
pub fn ground_of(surfaces: Vec<Placed<Planar>>) -> Body<Planar> {
    Body { surfaces, ..floor() }
}

/// A level floor at `z = 0`.
pub fn floor() -> Body<Planar> {
    Body::ground(0.0)
}

/// A pose from a position (m) and an angle (rad).
pub fn pose(x: f64, z: f64, orientation: f64) -> Pose<Planar> {
    Pose { position: Vec2::new(x, z), orientation }
}

/// A free disc with one rolling node; `gyration_squared` is k² (m²), ½ r² for a solid one.
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

/// A sharp rectangle about its middle, corners counterclockwise from the lower left.
///
/// # Panics
/// When a side is not a positive number, which is a mistake in a problem.
pub fn rectangle(width: f64, height: f64) -> Polygon {
    match Polygon::rectangle(width, height, 0.0) {
        Ok(polygon) => polygon,
        Err(problem) => panic!("a rectangle of {width} m by {height} m: {problem}"),
    }
}

/// A free rectangular block with sharp corners; nodes are its corners.
pub fn block(name: &str, size: (f64, f64), mass: f64, pose: Pose<Planar>) -> Body<Planar> {
    finely_noded_block(name, size, mass, f64::INFINITY, pose)
}

/// The same with nodes along its whole boundary, no further apart than `spacing` (m).
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

/// Boundary nodes as the nodes of a body whose shape is centered.
pub fn fixed(nodes: &[BoundaryNode]) -> Nodes<Planar> {
    let node = |n: &BoundaryNode| Node {
        position: n.position,
        tributary_length: n.tributary_length,
        outward: None,
    };
    Nodes::Fixed(nodes.iter().map(node).collect())
}

/// Nodes at points (m) of a body.
pub fn points(points: &[Vec2]) -> Nodes<Planar> {
    Nodes::Fixed(
        points
            .iter()
            .map(|p| Node { position: *p, tributary_length: 1.0, outward: None })
            .collect(),
    )
}

/// An interface with constants per node.
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

/// Coulomb friction with one coefficient.
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

/// The first node set of one body against the first surface of another, with interface 0.
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

/// Every body with nodes against every other body's first surface; two discs, and two solids, meet once.
pub fn all_pairs<S: Space>(bodies: &[Body<S>]) -> Vec<ContactPair> {
    let round =
        |i: usize| matches!(bodies[i].nodes.first(), Some(Nodes::Rolling { .. } | Nodes::Whole(_)));
    let mut pairs = vec![];
    for contactor in 0..bodies.len() {
        for target in 0..bodies.len() {
            let meets_twice = round(contactor) && round(target) && contactor > target;
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

/// A model with its state and working memory.
pub struct Scene<S: Space = Planar> {
    /// What does not change.
    pub model: Model<S>,
    /// Where everything is.
    pub state: State<S>,
    /// The forces there.
    pub scratch: Scratch<S>,
    /// How it is integrated; velocity Verlet unless changed.
    pub method: Method,
}

impl<S: Space<Real = f64>> Scene<S> {
    /// Bodies that all may meet, with one interface.
    ///
    /// # Errors
    /// When the bodies do not make a model.
    pub fn new(
        bodies: Vec<Body<S>>,
        interface: Interface<S>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        let pairs = all_pairs(&bodies);
        Ok(Self::of(Model::new(bodies, vec![interface], pairs, gravity)?))
    }

    /// The initial state of a model.
    pub fn of(model: Model<S>) -> Self {
        let state = State::initial(&model);
        let scratch = Scratch::new(&model);
        Self { model, state, scratch, method: Method::VelocityVerlet }
    }

    /// Settles the scene.
    ///
    /// # Errors
    /// When it does not stand.
    pub fn settled(mut self, tolerance: f64) -> Result<Self, SettleError> {
        self.settle(tolerance)?;
        Ok(self)
    }

    /// Settles, and says how.
    ///
    /// # Errors
    /// When it does not stand.
    pub fn settle(&mut self, tolerance: f64) -> Result<Settled, SettleError> {
        settle(&self.model, &mut self.state, &mut self.scratch, tolerance)
    }

    /// The scene with another method.
    pub fn by(&mut self, method: Method) -> &mut Self {
        self.method = method;
        self
    }

    /// Runs to a time (s).
    ///
    /// # Errors
    /// When the numbers break down.
    pub fn run(
        &mut self,
        drive: &impl Drive<S>,
        time_step: f64,
        end_time: f64,
    ) -> Result<RunTotals<S>, RunError> {
        self.watch(drive, time_step, end_time, |_, _, _| ControlFlow::Continue(()))
    }

    /// Runs to a time (s) while `seen` sees every accepted step.
    ///
    /// # Errors
    /// When the numbers break down.
    pub fn watch(
        &mut self,
        drive: &impl Drive<S>,
        time_step: f64,
        end_time: f64,
        seen: impl FnMut(&State<S>, &Scratch<S>, &EnergyLedger<S>) -> ControlFlow<()>,
    ) -> Result<RunTotals<S>, RunError> {
        let simulation = Simulation { method: self.method, time_step, end_time };
        let Self { model, state, scratch, .. } = self;
        simulate(model, drive, state, scratch, &simulation, &mut look(seen))
    }
}

impl Scene {
    /// Place of a body along `x` (m) relative to body 0, the ground.
    pub fn relative(&self, body: usize) -> f64 {
        self.state.poses[body].position.x - self.state.poses[0].position.x
    }
}
