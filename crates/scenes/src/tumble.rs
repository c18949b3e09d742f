//! Random heaps of discs and blocks, for tests of properties that must hold in any scene.

use barrelstack_dynamics::{Body, Interface, NormalLaw, Planar, Twist, Vec2};

use crate::scene::{coulomb, disc, finely_noded_block, floor, interface, pose};

/// A small random number generator (`SplitMix64`). The same seed gives the same scene on every machine.
pub struct Random(pub u64);

impl Random {
    /// Returns the next random number, uniform between `low` and `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns a floor and a loose heap of discs and blocks above it, which fall, rotate and collide.
///
/// The nodes of a block are at most `spacing` (m) apart; with an infinite spacing they are its corners.
pub fn bodies(seed: u64, count: usize, spacing: f64) -> Vec<Body<Planar>> {
    let mut random = Random(seed);
    let mut bodies = vec![floor()];
    for i in 0..count {
        let (column, row) = ((i % 3) as f64, (i / 3) as f64);
        let x = 0.55 * (column - 1.0) + random.within(-0.1, 0.1);
        let z = 0.45 + 0.6 * row + random.within(-0.05, 0.05);
        let mass = random.within(20.0, 80.0);
        let name = format!("body {i}");
        let mut body = if random.within(0.0, 1.0) < 0.5 {
            let radius = random.within(0.12, 0.2);
            disc(&name, radius, mass, 0.5 * radius * radius, Vec2::new(x, z))
        } else {
            let size = (random.within(0.15, 0.3), random.within(0.1, 0.25));
            finely_noded_block(&name, size, mass, spacing, pose(x, z, random.within(-1.0, 1.0)))
        };
        body.twist = Twist {
            linear: Vec2::new(random.within(-1.0, 1.0), random.within(-1.0, 0.0)),
            angular: random.within(-2.0, 2.0),
        };
        bodies.push(body);
    }
    bodies
}

/// Returns an interface whose contact laws suit the bodies of a heap: a spring with damping on approach only
/// ([`NormalLaw::SpeedGap`]), and Coulomb friction.
///
/// `factor` multiplies the stiffnesses, and `damping` the damping constants.
pub fn rough(factor: f64, damping: f64) -> Interface<Planar> {
    interface(
        NormalLaw::SpeedGap { stiffness: 2.0e5 * factor, damping: 600.0 * damping },
        coulomb(0.4, 1.5e5 * factor, 300.0 * damping),
    )
}
