//! Froude similitude: the same stack at another size under the same gravity.

use barrelstack_dynamics::math;

/// Scale factors from full-scale quantities to quantities at a length scale λ.
///
/// Lengths scale by λ, times by √λ, masses by λ³; accelerations, friction coefficients, damping ratios and restitutions
/// are unchanged. With these factors, the trajectories at both scales are the same apart from the scales of length and
/// time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similitude {
    /// λ: length of the model divided by the full-scale length.
    pub length: f64,
}

impl Similitude {
    /// The factors at full scale, where λ = 1.
    pub const FULL: Self = Self { length: 1.0 };

    /// Creates the factors of a length scale λ.
    pub fn new(length: f64) -> Self {
        Self { length }
    }

    /// Returns the scale factor for times and velocities, √λ.
    pub fn time(self) -> f64 {
        self.length.sqrt()
    }

    /// Returns the scale factor for masses, λ³.
    pub fn mass(self) -> f64 {
        self.length * self.length * self.length
    }

    /// Returns the scale factor for moments of inertia, λ⁵.
    pub fn inertia(self) -> f64 {
        self.mass() * self.length * self.length
    }

    /// Returns the scale factor for forces, λ³.
    pub fn force(self) -> f64 {
        self.mass()
    }

    /// Returns the scale factor for a stiffness `force / lengthⁿ`, with n = `exponent`.
    ///
    /// If `per_length` is `true`, returns the scale factor for a stiffness per length of boundary.
    pub fn stiffness(self, exponent: f64, per_length: bool) -> f64 {
        let divided = math::pow(self.length, exponent);
        self.force() / divided / if per_length { self.length } else { 1.0 }
    }

    /// Returns the scale factor for a damping constant `force / velocity`.
    ///
    /// If `per_length` is `true`, returns the scale factor for a damping constant per length of boundary.
    pub fn damping(self, per_length: bool) -> f64 {
        self.force() / self.time() / if per_length { self.length } else { 1.0 }
    }
}
