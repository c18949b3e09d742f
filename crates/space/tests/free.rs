//! Three-dimensional free scenes from a file, compared with closed forms.

use barrelstack::Scenario;
use barrelstack_dynamics::{Linear as _, Spatial, Vec3, space::Space as _};
use barrelstack_space::{Run, run};

const G: f64 = 9.80665;

fn ran(name: &str, changes: &[&str]) -> Run {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    finished(&Scenario::builtin(name, &changes).unwrap())
}

fn parsed(text: &str) -> Run {
    finished(&Scenario::parse("free.toml", text, &[]).unwrap())
}

fn finished(scenario: &Scenario) -> Run {
    let run = run::run(scenario).unwrap();
    assert_eq!(run.outcome.kind(), "not-judged");
    // measured 4e-7 where a ball meets a wall, 3e-8 and less elsewhere
    assert!(run.energy.unwrap().residual_ratio() < 1e-6, "{:?}", run.energy);
    run
}

fn assert_near(found: f64, exact: f64, relative: f64) {
    assert!((found / exact - 1.0).abs() < relative, "{found} against {exact}");
}

#[test]
fn a_ball_thrown_along_the_floor_goes_on_at_five_sevenths() {
    let run = ran("rolling-ball", &[]);
    let end = run.last.twists[1];
    // measured 9e-6, which is the penetration
    assert_near(end.linear.length(), 5.0 / 7.0, 3e-5);
    assert_near(end.angular.length(), 5.0 / 7.0 / 0.3, 3e-5);
    // The ball continues in its initial direction, and rotates about the horizontal axis perpendicular to it.
    let aside = end.linear.dot(Vec3::new(-0.8, 0.6, 0.0)).abs();
    // measured 3e-13
    assert!(aside < 1e-10, "{aside}");
    assert_near(end.angular.dot(Vec3::new(-0.8, 0.6, 0.0)), 5.0 / 7.0 / 0.3, 3e-5);
    // v t − ½ μ g t₁² + …: slides until t₁ = 2 v/(7 μ g), 12/49 of v²/(μ g), and rolls.
    let slides = 2.0 / (7.0 * 0.3 * G);
    let way = 12.0 / 49.0 / (0.3 * G) + 5.0 / 7.0 * (1.0 - slides);
    assert_near(run.fates[1].moved.length(), way, 3e-5);
}

#[test]
fn a_block_thrown_askew_stops_after_the_way_that_friction_takes() {
    let run = ran("sliding-block-in-space", &[]);
    let moved = run.fates[1].moved;
    // Measured 1.0e-4 below, because the tangential spring relaxes.
    assert_near(moved.length(), 1.0 / (2.0 * 0.3 * G), 2e-4);
    // measured 5.4e-7
    assert!((0.6 * moved.y - 0.8 * moved.x).abs() < 2e-6, "{moved:?}");
    // measured 4e-15
    assert!(run.last.twists[1].linear.length() < 1e-9);
}

#[test]
fn a_block_that_tumbles_keeps_its_angular_momentum_and_turns_over() {
    let momentum = |run: &Run| {
        let (body, pose) = (&run.stack.model.bodies()[1], run.last.poses[1]);
        let rotation = pose.orientation.matrix();
        Spatial::momentum(body.inertia, rotation, run.last.twists[1].angular)
    };
    // 600 kg/m³ of 0.3 × 0.2 × 0.1 m
    let inertia = [0.05, 0.1, 0.13].map(|square| 3.6 / 12.0 * square);
    let exact = Vec3::new(0.01 * inertia[0], 5.0 * inertia[1], 0.0);
    let upward = |run: &Run| run.last.poses[1].orientation.matrix().rows[1].y;
    for (end, way) in [("run.duration=2 s", 1.0), ("run.duration=4.5 s", -1.0)] {
        let run = ran("tumbling-block", &[end]);
        // measured 1.4e-15
        assert!((momentum(&run) - exact).length() < 1e-13);
        assert!(way * upward(&run) > 0.9, "{end}: {}", upward(&run));
    }
}

#[test]
fn drag_stops_a_block_along_an_exponential() {
    let drag = "body.block.viscous={ linear = '2 N s/m', angular = '0.02 N m s' }";
    let changes = [
        "body.block.velocity=['1 m/s', '0 m/s', '0 m/s']",
        "body.block.spin=['0 rad/s', '0 rad/s', '3 rad/s']",
        "run.duration=2 s",
        drag,
    ];
    let end = ran("tumbling-block", &changes).last.twists[1];
    let fading = |rate: f64| (-2.0 * rate).exp();
    assert_near(end.linear.x, fading(2.0 / 3.6), 1e-5);
    assert_near(end.angular.z, 3.0 * fading(0.02 / (0.13 * 3.6 / 12.0)), 1e-5);
}

#[test]
fn a_ball_rolls_down_a_slope_of_the_ground() {
    let slope: f64 = 10_f64.to_radians();
    let place = format!("[\"{} m\", \"0 m\", \"{} m\"]", -0.3 * slope.sin(), 0.3 * slope.cos());
    let position = format!("body.ball.position={place}");
    let still = "body.ball.velocity=[\"0 m/s\", \"0 m/s\", \"0 m/s\"]";
    let changes = ["ground.slope=10 deg", "run.settle=false", "run.duration=2 s", &position, still];
    let run = ran("rolling-ball", &changes);
    let way = 0.5 * 5.0 / 7.0 * G * slope.sin() * 4.0;
    // It rises to the right, so the ball goes to the left.
    // measured 9.5e-6 and 2.1e-6
    assert_near(run.fates[1].moved.x, -way * slope.cos(), 3e-5);
    assert_near(run.fates[1].moved.z, -way * slope.sin(), 3e-5);
}

#[test]
fn ground_that_shakes_drags_a_ball_by_two_sevenths() {
    let changes = [
        "motion.pulse={ kind = 'one-sine', amplitude = '0.2 g', period = '0.8 s' }",
        "body.ball.velocity=['0 m/s', '0 m/s', '0 m/s']",
        "interface.ball-ground.friction.coefficient=1",
        "run.duration=1 s",
    ];
    let run = ran("rolling-ball", &changes);
    let ground = run.last.poses[0].position.x;
    assert!(ground.abs() > 0.01, "{ground}");
    // measured 9e-6
    assert_near(run.fates[1].moved.x, -5.0 / 7.0 * ground, 3e-5);
}

/// Two balls of one body on the floor beside a wall that one of them hits.
const DUMBBELL: &str = r#"
schema = 1
kind = "free-spatial"
[[body]]
name = "wall"
kind = "hard"
fixed_to_ground = true
solid = { type = "half-space" }
position = ["2 m", "0 m", "0 m"]
orientation = ["0 deg", "-90 deg", "0 deg"]
[[body]]
name = "dumbbell"
mass = "8 kg"
position = ["0 m", "0 m", "0.1 m"]
velocity = ["4 m/s", "0 m/s", "0 m/s"]
[body.solid]
type = "compound"
[[body.solid.parts]]
solid = { type = "ball", radius = "0.1 m" }
offset = ["0 m", "-0.5 m", "0 m"]
[[body.solid.parts]]
solid = { type = "ball", radius = "0.1 m" }
offset = ["0 m", "0.5 m", "0 m"]
[[interface]]
between = ["dumbbell", "ground"]
law = "kelvin-voigt"
stiffness = "1 MN/m"
damping = "1 kN s/m"
friction = { law = "none" }
[[interface]]
between = ["hard", "dumbbell"]
law = "hertz"
stiffness = "1e7 N/m^1.5"
friction = { law = "none" }
[run]
duration = "1 s"
step = "20 us"
"#;

#[test]
fn a_body_of_two_balls_rests_on_both_and_comes_back_from_a_wall() {
    let run = parsed(DUMBBELL);
    // Each ball carries half of the weight.
    let sunk = 0.1 - run.frames.poses[0][2][2];
    assert_near(sunk, 8.0 * G / 2.0 / 1e6, 1e-9);
    let end = run.last.twists[2];
    // measured 2e-7: nothing is lost
    assert_near(end.linear.x, -4.0, 1e-5);
    assert!(end.angular.length() < 1e-9, "{:?}", end.angular);
}

#[test]
fn what_is_not_there_is_told_at_its_field() {
    let refused = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let scenario = Scenario::builtin("rolling-ball", &changes).unwrap();
        let error = run::run(&scenario).unwrap_err();
        (error.fields().swap_remove(0), error.to_string())
    };
    let (field, told) = refused(&["run.similitude=2"]);
    assert_eq!(field, "run.similitude");
    assert!(told.contains("set run.similitude to 1"), "{told}");
    let (field, told) = refused(&["run.step=10 ms"]);
    assert_eq!(field, "run.step");
    assert!(told.contains("too long"), "{told}");
    let (field, told) = refused(&["body.ball.position=['0 m', '0 m', '0.2 m']"]);
    assert_eq!(field, "body.ground.position");
    assert!(told.contains("overlap"), "{told}");
    // Three-dimensional bodies are not supported in a plane.
    let error = Scenario::builtin("rolling-ball", &[]).unwrap().run().unwrap_err();
    assert_eq!(error.fields(), ["kind"]);
}
