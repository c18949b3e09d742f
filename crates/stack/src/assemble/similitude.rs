//! Froude similitude: the same stack at another size under the same gravity.

use barrelstack_dynamics::math;

/// Multiplies what a full-scale scenario states by what a length scale λ demands.
///
/// Lengths λ, times √λ, masses λ³; accelerations, friction coefficients, damping ratios and
/// restitutions stay. With these factors the two trajectories are the same but for their units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similitude {
    /// λ: model length over full length.
    pub length: f64,
}

impl Similitude {
    /// Full size.
    pub const FULL: Self = Self { length: 1.0 };

    /// A length scale λ.
    pub fn new(length: f64) -> Self {
        Self { length }
    }

    /// √λ, the factor of times and velocities.
    pub fn time(self) -> f64 {
        self.length.sqrt()
    }

    /// λ³.
    pub fn mass(self) -> f64 {
        self.length * self.length * self.length
    }

    /// λ⁵.
    pub fn inertia(self) -> f64 {
        self.mass() * self.length * self.length
    }

    /// Factor of a force: λ³.
    pub fn force(self) -> f64 {
        self.mass()
    }

    /// Factor of a stiffness `force / lengthⁿ`; stated per length of boundary, one more length divides.
    pub fn stiffness(self, exponent: f64, per_length: bool) -> f64 {
        let divided = math::pow(self.length, exponent);
        self.force() / divided / if per_length { self.length } else { 1.0 }
    }

    /// Factor of a damping `force / velocity`, likewise.
    pub fn damping(self, per_length: bool) -> f64 {
        self.force() / self.time() / if per_length { self.length } else { 1.0 }
    }
}
