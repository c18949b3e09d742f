//! Normal contact force as a function of penetration and penetration rate.

use crate::real::{Mask, Real};

/// Normal contact law: the compressive force on one node as a function of its penetration δ (m) and penetration rate δ̇
/// (m/s, positive while approaching). The force is never tensile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw<R = f64> {
    /// Linear spring in parallel with a damper that acts only while the penetration grows:
    ///
    /// ```text
    /// fₙ = k δ + c δ̇   if δ̇ > 0
    /// fₙ = k δ         if δ̇ ≤ 0
    /// ```
    ///
    /// The rebound is elastic, so all dissipation happens on approach (Candia, de la Llera and Almazán 2008, eq. 2.6).
    /// When contact begins, the force jumps to `c δ̇`.
    SpeedGap {
        /// Stiffness `k` (N/m).
        stiffness: R,
        /// Damping `c` (N·s/m).
        damping: R,
    },
    /// Linear spring in parallel with a damper that acts on approach and on separation; the force is zero where it
    /// would otherwise be tensile: `fₙ = max(0, k δ + c δ̇)`.
    KelvinVoigt {
        /// Stiffness `k` (N/m).
        stiffness: R,
        /// Damping `c` (N·s/m).
        damping: R,
    },
    /// `fₙ = max(0, k δⁿ (1 + d δ̇))`: the force is zero at the start and at the end of contact (Hunt and Crossley
    /// 1975).
    HuntCrossley {
        /// Stiffness `k` (N/mⁿ).
        stiffness: R,
        /// Dissipation constant `d` (s/m).
        dissipation: R,
        /// Exponent `n`.
        exponent: Exponent,
    },
    /// Law with a prescribed coefficient of restitution `e`, which depends neither on the mass nor, at speeds well
    /// above `v`, on the speed:
    ///
    /// ```text
    /// fₙ = k δ^(3/2) (1 + e² + (1 − e²) s) / 2      s = δ̇ / √(δ̇² + v²)
    /// ```
    ///
    /// On approach, the force is the spring force. On separation, the force is e² times the spring force, so the
    /// fraction e² of the energy is returned. These are the loading and unloading branches of Walton and Braun (1986),
    /// connected by a smooth transition at penetration rates of about `v`, so the law needs no history. At lower
    /// speeds, a spring and a damper act, so bodies come to rest. The spring stiffens as between round bodies (Hertz),
    /// so the contact of a light body at rest is soft, and a heavy body is stopped within millimeters.
    Rebound {
        /// Stiffness `k` (N/m^1.5).
        stiffness: R,
        /// Coefficient of restitution `e`: speed after the impact divided by speed before the impact.
        restitution: R,
        /// Penetration rate `v` (m/s) below which the law acts like a spring and a damper.
        speed: R,
    },
    /// `fₙ = k δ^(3/2)`, elastic (Hertz 1882; for spheres `k = 4/3 E* √r`).
    Hertz {
        /// Stiffness `k` (N/m^1.5).
        stiffness: R,
    },
}

/// Stop at the end of the stroke of a soft contact law. Beyond a given penetration (m), a second contact law acts in
/// addition; its penetration is the excess over the given penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop<R = f64> {
    /// Penetration (m) beyond which the stop acts.
    pub depth: R,
    /// The additional law.
    pub law: NormalLaw<R>,
}

impl<R: Real> Stop<R> {
    /// Adds the force of the stop to the force of the soft contact law, in lanes whose penetration reaches the stop;
    /// `step` (s) is as in [`NormalForce::within_step`].
    #[inline(always)]
    pub(crate) fn add(&self, soft: NormalForce<R>, depth: R, rate: R, step: R) -> NormalForce<R> {
        let beyond = depth - self.depth;
        let reached = R::zero().lt(beyond);
        if !reached.any() {
            return soft;
        }
        let hard = self.law.force_of_step(R::select(reached, beyond, R::zero()), rate, step);
        NormalForce {
            total: soft.total + R::select(reached, hard.total, R::zero()),
            elastic: soft.elastic + R::select(reached, hard.elastic, R::zero()),
            energy: soft.energy + R::select(reached, hard.energy, R::zero()),
        }
    }
}

/// Exponent `n` of an elastic force that is proportional to `δⁿ`, where δ is the penetration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Exponent {
    /// Force proportional to the penetration, `n = 1`.
    Linear,
    /// Force as between two spheres, `n = 3/2`.
    Hertzian,
}

/// A normal force, its recoverable part, and the stored energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce<R> {
    /// Compressive force (N), never negative.
    pub total: R,
    /// Part of the force (N) that does not depend on the penetration rate; the work of the remaining part is
    /// dissipated.
    pub elastic: R,
    /// Energy stored in the spring (J).
    pub energy: R,
}

impl<R: Real> NormalForce<R> {
    /// Returns the effective force over a whole time step (s) of the central difference method.
    ///
    /// The method treats a force as constant from half a step before to half a step after the time at which it is
    /// evaluated. But a spring that engaged at a rate δ̇ acted only for the time `δ/δ̇` of the preceding half step, and
    /// a spring that releases will act only for the time `δ/|δ̇|` of the following half step. In both cases, its
    /// average force during that time is half of its current force. Moreover, the force of a stiffening spring exceeds
    /// its average over the displacement. With both corrections the elastic force is:
    ///
    /// ```text
    /// elastic · (½ + (½ − b) δ/w)   where δ < w = |δ̇| Δt
    /// elastic · (1 − b (w/δ)²)      elsewhere, with the bend b = n (n − 1) / 12 of elastic ∝ δⁿ
    /// ```
    ///
    /// So a linear spring that engages at a steady rate absorbs exactly the energy that it stores, at whatever time
    /// within the step it engages. The energy error of a rebound decreases by orders of magnitude. With a step of zero,
    /// the force is unchanged.
    #[inline(always)]
    #[must_use]
    pub fn within_step(self, bend: f64, depth: R, rate: R, step: R) -> Self {
        let travel = rate.abs() * step;
        let partly = depth.lt(travel);
        if bend == 0.0 && !partly.any() {
            return self;
        }
        let (half, bend, zero) = (R::splat(0.5), R::splat(bend), R::zero());
        let begun = depth / R::select(partly, travel, R::splat(1.0));
        let bent = travel / R::select(partly, R::splat(1.0), depth);
        let missing = R::select(partly, half - (half - bend) * begun, bend * bent * bent);
        let missing = self.elastic * R::select(zero.lt(travel), missing, zero);
        Self {
            total: (self.total - missing).max(zero),
            elastic: self.elastic - missing,
            energy: self.energy,
        }
    }
}

impl<R: Real> NormalLaw<R> {
    /// Returns the force of a node with penetration `depth` (m, positive) and penetration rate `rate` (m/s, positive
    /// while approaching).
    #[inline(always)]
    pub fn force(&self, depth: R, rate: R) -> NormalForce<R> {
        let zero = R::zero();
        match *self {
            Self::SpeedGap { stiffness, damping } => {
                let elastic = stiffness * depth;
                NormalForce {
                    total: elastic + damping * rate.max(zero),
                    elastic,
                    energy: R::splat(0.5) * elastic * depth,
                }
            }
            Self::KelvinVoigt { stiffness, damping } => {
                let elastic = stiffness * depth;
                NormalForce {
                    total: (elastic + damping * rate).max(zero),
                    elastic,
                    energy: R::splat(0.5) * elastic * depth,
                }
            }
            Self::HuntCrossley { stiffness, dissipation, exponent } => {
                let (elastic, share) = match exponent {
                    Exponent::Linear => (stiffness * depth, 0.5),
                    Exponent::Hertzian => (stiffness * depth * depth.sqrt(), 0.4),
                };
                NormalForce {
                    total: (elastic * (R::splat(1.0) + dissipation * rate)).max(zero),
                    elastic,
                    energy: R::splat(share) * elastic * depth,
                }
            }
            Self::Rebound { stiffness, restitution, speed } => {
                let half = R::splat(0.5);
                let spring = stiffness * depth * depth.sqrt();
                let back = restitution * restitution;
                let sense = rate / (rate * rate + speed * speed).sqrt();
                let share = half * (R::splat(1.0) + back + (R::splat(1.0) - back) * sense);
                let elastic = back * spring;
                NormalForce {
                    total: spring * share,
                    elastic,
                    energy: R::splat(0.4) * elastic * depth,
                }
            }
            Self::Hertz { stiffness } => {
                let elastic = stiffness * depth * depth.sqrt();
                NormalForce { total: elastic, elastic, energy: R::splat(0.4) * elastic * depth }
            }
        }
    }

    /// Returns the effective force over a whole time step (s): see [`NormalForce::within_step`].
    #[inline(always)]
    pub(crate) fn force_of_step(&self, depth: R, rate: R, step: R) -> NormalForce<R> {
        self.force(depth, rate).within_step(self.bend(), depth, rate, step)
    }

    /// Returns the bend `n (n − 1) / 12` of the elastic force `∝ δⁿ`; see [`NormalForce::within_step`].
    #[inline(always)]
    fn bend(&self) -> f64 {
        match self {
            Self::SpeedGap { .. }
            | Self::KelvinVoigt { .. }
            | Self::HuntCrossley { exponent: Exponent::Linear, .. } => 0.0,
            Self::HuntCrossley { exponent: Exponent::Hertzian, .. }
            | Self::Rebound { .. }
            | Self::Hertz { .. } => 1.0 / 16.0,
        }
    }

    /// Returns the tangent stiffness `∂fₙ/∂δ` (N/m) at a penetration (m), without the part that depends on the
    /// penetration rate.
    #[inline(always)]
    pub fn tangent_stiffness(&self, depth: R) -> R {
        match *self {
            Self::SpeedGap { stiffness, .. }
            | Self::KelvinVoigt { stiffness, .. }
            | Self::HuntCrossley { stiffness, exponent: Exponent::Linear, .. } => stiffness,
            Self::HuntCrossley { stiffness, .. }
            | Self::Hertz { stiffness }
            | Self::Rebound { stiffness, .. } => {
                R::splat(1.5) * stiffness * depth.max(R::zero()).sqrt()
            }
        }
    }

    /// Returns the damping `∂fₙ/∂δ̇` (N·s/m) on approach at a penetration (m).
    pub fn tangent_damping(&self, depth: R) -> R {
        match *self {
            Self::SpeedGap { damping, .. } | Self::KelvinVoigt { damping, .. } => damping,
            Self::HuntCrossley { stiffness, dissipation, exponent } => {
                let depth = depth.max(R::zero());
                let elastic = match exponent {
                    Exponent::Linear => stiffness * depth,
                    Exponent::Hertzian => stiffness * depth * depth.sqrt(),
                };
                elastic * dissipation
            }
            // The damping of `Rebound` grows with the load and not with the penetration; `Hertz` has none.
            Self::Hertz { .. } | Self::Rebound { .. } => R::zero(),
        }
    }
}
