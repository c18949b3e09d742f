//! Helpers shared by the test modules.
#![allow(dead_code, unused_imports, unreachable_pub, reason = "every suite uses its own share")]

use barrelstack_dynamics::space::Linear as _;
use barrelstack_dynamics::{Method, Planar, Pose, Quaternion, State, Twist, Vec3};
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

pub use barrelstack_scenes::GRAVITY;
pub use barrelstack_scenes::scene::*;

/// Returns all integration methods, the adaptive one with a tolerance (m).
pub fn every_method(tolerance: f64) -> [Method; 4] {
    [
        Method::SemiImplicitEuler,
        Method::VelocityVerlet,
        Method::RungeKutta4,
        Method::BogackiShampine { tolerance },
    ]
}

/// Returns the bits of the poses, twists and contact history of a state.
pub fn bits(state: &State<Planar>) -> Vec<u64> {
    let mut bits = vec![state.time.to_bits()];
    for (pose, twist) in state.poses.iter().zip(&state.twists) {
        bits.extend(numbers(pose, twist).map(f64::to_bits));
    }
    bits.extend(
        (0..state.contact_elements.len())
            .map(|i| state.contact_elements.stick(i).displacement.to_bits()),
    );
    bits
}

/// Returns the six numbers that describe the pose and twist of a body.
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

/// Asserts that a number is as expected, to a relative tolerance; prints the error.
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

/// Returns the settings of property tests with a number of cases, which are the same in every run.
pub fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2008),
        ..ProptestConfig::default()
    }
}

/// Generator of pseudorandom numbers between -1 and 1, which are the same in every run.
pub struct Dice(pub u64);

impl Dice {
    /// Returns the next number.
    pub fn roll(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = self.0 ^ (self.0 >> 33);
        (x.wrapping_mul(0xff51_afd7_ed55_8ccd) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns a vector of three numbers.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.roll(), self.roll(), self.roll())
    }

    /// Returns an orientation from the uniform distribution.
    pub fn orientation(&mut self) -> Quaternion {
        loop {
            let (w, v) = (self.roll(), self.vector());
            if w * w + v.dot(v) <= 1.0 {
                return Quaternion { w, v }.normalized();
            }
        }
    }
}
