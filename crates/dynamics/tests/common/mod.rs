//! Scenes and exact answers that the suites share.
//!
//! A scene and its closed form stand side by side: the builders here make the bodies, [`exact`] holds
//! the formulas that several suites ask for.
#![allow(dead_code, unreachable_pub, reason = "every suite uses its own share of these scenes")]
#![allow(clippy::unwrap_used, reason = "a scene that cannot be made fails its test")]

pub mod exact;
pub mod motion;
pub mod tumble;

use std::ops::ControlFlow;

use barrelstack_dynamics::shape::{BoundaryNode, Circle, HalfPlane, Polygon};
use barrelstack_dynamics::simulate::RunTotals;
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    Basis, Body, BodyId, ContactPair, Counts, Drive, EnergyLedger, FrictionLaw, Interface, Method,
    Model, Motion, Node, Nodes, NormalLaw, Observer, Placed, Planar, Pose, RunError, Scratch,
    SettleError, Settled, Shape, Simulation, State, Twist, Vec2, settle, simulate,
};
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

/// Standard gravity (m/s²).
pub const GRAVITY: f64 = 9.80665;

/// Free fall straight down (m/s²).
pub const DOWN: Vec2 = Vec2::new(0.0, -GRAVITY);

/// Free fall as felt on a plane that falls to the right at an angle (rad).
///
/// A slope is a level floor under turned gravity: the same physics with simpler numbers.
pub fn gravity_on_slope(angle: f64) -> Vec2 {
    Vec2::new(GRAVITY * libm::sin(angle), -GRAVITY * libm::cos(angle))
}

/// Every method, the adaptive one with a tolerance (m).
pub fn every_method(tolerance: f64) -> [Method; 4] {
    [
        Method::SemiImplicitEuler,
        Method::VelocityVerlet,
        Method::RungeKutta4,
        Method::BogackiShampine { tolerance },
    ]
}

/// A shape at the origin of its body.
pub fn centered(shape: Shape) -> Placed<Planar> {
    Placed { surface: shape, offset: Vec2::default(), rotation: Rotation2::identity() }
}

/// The ground with what is fixed to it.
pub fn ground_of(surfaces: Vec<Placed<Planar>>) -> Body<Planar> {
    Body {
        name: "ground".into(),
        motion: Motion::Prescribed,
        mass: 1.0,
        inertia: 1.0,
        damping: None,
        pose: pose(0.0, 0.0, 0.0),
        twist: Twist::default(),
        surfaces,
        nodes: vec![],
        faces: Vec::new(),
    }
}

/// A level floor at `z = 0`.
pub fn floor() -> Body<Planar> {
    ground_of(vec![centered(Shape::HalfPlane(HalfPlane))])
}

/// A pose from a position (m) and an angle (rad).
pub fn pose(x: f64, z: f64, orientation: f64) -> Pose<Planar> {
    Pose { position: Vec2::new(x, z), orientation }
}

/// A free disc with one rolling node; `gyration_squared` is `k²` (m²), ½ r² for a solid one.
pub fn disc(
    name: &str,
    radius: f64,
    mass: f64,
    gyration_squared: f64,
    center: Vec2,
) -> Body<Planar> {
    Body {
        name: name.into(),
        motion: Motion::Free,
        mass,
        inertia: mass * gyration_squared,
        damping: None,
        pose: Pose { position: center, orientation: 0.0 },
        twist: Twist::default(),
        surfaces: vec![centered(Shape::Circle(Circle { radius }))],
        nodes: vec![Nodes::Rolling { center: Vec2::default(), radius, tributary_length: 1.0 }],
        faces: Vec::new(),
    }
}

/// A free rectangular block with sharp corners; its nodes are the corners, or lie along the whole
/// boundary no further apart than `spacing` (m).
pub fn block(
    name: &str,
    (width, height): (f64, f64),
    mass: f64,
    spacing: Option<f64>,
    pose: Pose<Planar>,
) -> Body<Planar> {
    let rectangle = Polygon::rectangle(width, height, 0.0).unwrap();
    let nodes = match spacing {
        None => rectangle.corner_nodes(),
        Some(spacing) => Shape::Polygon(rectangle.clone()).nodes(spacing),
    };
    Body {
        name: name.into(),
        motion: Motion::Free,
        mass,
        inertia: mass * (width * width + height * height) / 12.0,
        damping: None,
        pose,
        twist: Twist::default(),
        surfaces: vec![centered(Shape::Polygon(rectangle))],
        nodes: vec![fixed(&nodes)],
        faces: Vec::new(),
    }
}

/// Boundary nodes as the nodes of a body whose shape is centered.
pub fn fixed(nodes: &[BoundaryNode]) -> Nodes<Planar> {
    Nodes::Fixed(
        nodes
            .iter()
            .map(|n| Node { position: n.position, tributary_length: n.tributary_length })
            .collect(),
    )
}

/// An interface with constants per node.
pub fn interface(normal: NormalLaw, friction: FrictionLaw) -> Interface<Planar> {
    Interface {
        name: "test".into(),
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

/// Every body with nodes against every other body's first surface; two discs meet once.
pub fn all_pairs(bodies: &[Body<Planar>]) -> Vec<ContactPair> {
    let round = |i: usize| matches!(bodies[i].nodes.first(), Some(Nodes::Rolling { .. }));
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
pub struct Scene {
    pub model: Model<Planar>,
    pub state: State<Planar>,
    pub scratch: Scratch<Planar>,
}

impl Scene {
    /// Bodies that all may meet, with one interface.
    pub fn new(bodies: Vec<Body<Planar>>, interface: Interface<Planar>, gravity: Vec2) -> Self {
        let pairs = all_pairs(&bodies);
        Self::of(Model::new(bodies, vec![interface], pairs, gravity).unwrap())
    }

    /// The initial state of a model.
    pub fn of(model: Model<Planar>) -> Self {
        let state = State::initial(&model);
        let scratch = Scratch::new(&model);
        Self { model, state, scratch }
    }

    /// Settles the scene.
    pub fn settled(mut self, tolerance: f64) -> Self {
        self.settle(tolerance).unwrap();
        self
    }

    /// Settles, or says why not.
    pub fn settle(&mut self, tolerance: f64) -> Result<Settled, SettleError> {
        settle(&self.model, &mut self.state, &mut self.scratch, tolerance)
    }

    /// Runs to a time (s).
    pub fn run(
        &mut self,
        drive: &impl Drive<Planar>,
        method: Method,
        time_step: f64,
        end_time: f64,
    ) -> RunTotals<Planar> {
        self.watch(drive, method, time_step, end_time, |_, _, _| ControlFlow::Continue(()))
    }

    /// Runs to a time (s) while `look` sees every accepted step.
    pub fn watch(
        &mut self,
        drive: &impl Drive<Planar>,
        method: Method,
        time_step: f64,
        end_time: f64,
        look: impl FnMut(&State<Planar>, &Scratch<Planar>, &EnergyLedger<Planar>) -> ControlFlow<()>,
    ) -> RunTotals<Planar> {
        self.try_watch(drive, method, time_step, end_time, look).unwrap()
    }

    /// As [`Scene::watch`], for runs that may break down.
    pub fn try_watch(
        &mut self,
        drive: &impl Drive<Planar>,
        method: Method,
        time_step: f64,
        end_time: f64,
        look: impl FnMut(&State<Planar>, &Scratch<Planar>, &EnergyLedger<Planar>) -> ControlFlow<()>,
    ) -> Result<RunTotals<Planar>, RunError> {
        simulate(
            &self.model,
            drive,
            &mut self.state,
            &mut self.scratch,
            &Simulation { method, time_step, end_time },
            &mut Watch(look),
        )
    }

    /// The bits of all that a run computes: poses, twists, sticks.
    pub fn bits(&self) -> Vec<u64> {
        bits(&self.state)
    }
}

/// The bits of the poses, twists and sticks of a state.
pub fn bits(state: &State<Planar>) -> Vec<u64> {
    let mut bits = vec![state.time.to_bits()];
    for (pose, twist) in state.poses.iter().zip(&state.twists) {
        bits.extend(numbers(pose, twist).map(f64::to_bits));
    }
    bits.extend((0..state.elements.len()).map(|i| state.elements.stick(i).displacement.to_bits()));
    bits
}

/// The six numbers of a body's motion.
pub fn numbers(pose: &Pose<Planar>, twist: &Twist<Planar>) -> [f64; 6] {
    [
        pose.position.x,
        pose.position.z,
        pose.orientation,
        twist.linear.x,
        twist.linear.z,
        twist.angular,
    ]
}

/// An observer made of a function.
pub struct Watch<F>(pub F);

impl<F> Observer<Planar> for Watch<F>
where
    F: FnMut(&State<Planar>, &Scratch<Planar>, &EnergyLedger<Planar>) -> ControlFlow<()>,
{
    fn observe(
        &mut self,
        _model: &Model<Planar>,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        energy: &EnergyLedger<Planar>,
    ) -> ControlFlow<()> {
        (self.0)(state, scratch, energy)
    }
}

/// Asserts that a number is what it should be, to a share of it; prints the error it measured.
#[allow(clippy::print_stdout, reason = "shown by cargo test with --nocapture, or when it fails")]
#[track_caller]
pub fn assert_close(what: &str, found: f64, expected: f64, relative: f64) {
    let error = (found - expected).abs() / expected.abs();
    println!("{what}: {found:.9}, error {error:.1e} of {relative:.0e}");
    assert!(
        error <= relative,
        "{what}: found {found:.9}, expected {expected:.9}, relative error {error:.2e} > {relative:.0e}"
    );
}

/// Settings of random tests: a few cases, always the same ones.
pub fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2008),
        ..ProptestConfig::default()
    }
}
