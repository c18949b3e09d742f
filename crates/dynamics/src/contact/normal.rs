//! Normal contact force as a function of penetration and penetration rate.

use crate::real::{Mask, Real};

/// A law for the compressive force of one node, δ its penetration (m) and δ̇ the rate (m/s,
/// positive while approaching). No law ever pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw<R = f64> {
    /// Linear spring in parallel with a damper that acts only while the penetration grows:
    ///
    /// ```text
    /// fₙ = k δ + c δ̇   if δ̇ > 0
    /// fₙ = k δ         if δ̇ ≤ 0
    /// ```
    ///
    /// The rebound is elastic, so all dissipation happens on approach
    /// (Candia, de la Llera and Almazán 2008, eq. 2.6).
    /// At touch-down the force jumps to `c δ̇`.
    SpeedGap {
        /// `k` (N/m).
        stiffness: R,
        /// `c` (N·s/m).
        damping: R,
    },
    /// Linear spring and damper in both directions, cut where it would pull:
    /// `fₙ = max(0, k δ + c δ̇)`.
    KelvinVoigt {
        /// `k` (N/m).
        stiffness: R,
        /// `c` (N·s/m).
        damping: R,
    },
    /// `fₙ = max(0, k δⁿ (1 + d δ̇))`: the force starts and ends at zero
    /// (Hunt and Crossley 1975).
    HuntCrossley {
        /// `k` (N/mⁿ).
        stiffness: R,
        /// `d` (s/m).
        dissipation: R,
        /// `n`.
        exponent: Exponent,
    },
    /// An impact that gives back a stated share of its speed, whatever mass meets and however fast:
    ///
    /// ```text
    /// fₙ = k δ^(3/2) (1 + e² + (1 − e²) s) / 2      s = δ̇ / √(δ̇² + v²)
    /// ```
    ///
    /// On approach it is the spring, on separation e² of it, so e² of the energy comes back: the loading
    /// and unloading branches of Walton and Braun (1986), joined without memory over speeds of some `v`.
    /// Slower than that the force is a damper besides the spring, and what it bears comes to rest.
    /// The spring stiffens as that between round bodies does (Hertz), so that a light body rests softly
    /// and a heavy one is stopped within millimeters.
    Rebound {
        /// `k` (N/m^1.5).
        stiffness: R,
        /// `e`, speed after over speed before.
        restitution: R,
        /// `v` (m/s).
        speed: R,
    },
    /// `fₙ = k δ^(3/2)`, elastic (Hertz 1882; for spheres `k = 4/3 E* √r`).
    Hertz {
        /// `k` (N/m^1.5).
        stiffness: R,
    },
}

/// The end of the stroke of a soft law: beyond a depth (m) a second law acts as well, on what the
/// penetration is beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop<R = f64> {
    /// Penetration (m) from which on it acts.
    pub depth: R,
    /// The law that is added.
    pub law: NormalLaw<R>,
}

impl<R: Real> Stop<R> {
    /// The force of the soft law, and that of the stop where it is reached, for a step (s).
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

/// How an elastic force grows with penetration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Exponent {
    /// In proportion, `n = 1`.
    Linear,
    /// As between spheres, `n = 3/2`.
    Hertzian,
}

/// A normal force and what of it can be got back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForce<R> {
    /// Compressive force (N), never negative.
    pub total: R,
    /// The part that does not depend on the rate (N); the rest is dissipated.
    pub elastic: R,
    /// Energy stored in the spring (J).
    pub energy: R,
}

impl<R: Real> NormalForce<R> {
    /// The force that stands for a whole step (s) of central differences.
    ///
    /// The method takes a force as constant for half a step before and after its instant.
    /// A spring met at a rate δ̇ has then pushed only for the time `δ/δ̇` of the half before, one that
    /// is left will push only for the time `δ/|δ̇|` of the half after, with half its force in the mean;
    /// and one that stiffens pushes with more than the mean of what it does along the way:
    ///
    /// ```text
    /// elastic · (½ + (½ − b) δ/w)   where δ < w = |δ̇| Δt
    /// elastic · (1 − b (w/δ)²)      elsewhere, with the bend b = n (n − 1) / 12 of elastic ∝ δⁿ
    /// ```
    ///
    /// So a linear spring met at a steady rate takes exactly the energy that it stores, wherever in
    /// the step it is met, and the error of a bounce falls by orders of magnitude.
    /// A step of zero leaves the force as it is.
    #[inline(always)]
    #[must_use]
    pub fn within_step(self, bend: f64, depth: R, rate: R, step: R) -> Self {
        let way = rate.abs() * step;
        let partly = depth.lt(way);
        if bend == 0.0 && !partly.any() {
            return self;
        }
        let (half, bend, zero) = (R::splat(0.5), R::splat(bend), R::zero());
        let begun = depth / R::select(partly, way, R::splat(1.0));
        let bent = way / R::select(partly, R::splat(1.0), depth);
        let missing = R::select(partly, half - (half - bend) * begun, bend * bent * bent);
        let missing = self.elastic * R::select(zero.lt(way), missing, zero);
        Self {
            total: (self.total - missing).max(zero),
            elastic: self.elastic - missing,
            energy: self.energy,
        }
    }
}

impl<R: Real> NormalLaw<R> {
    /// The force of a node with penetration `depth` (m, positive) and penetration rate `rate`
    /// (m/s, positive while approaching).
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

    /// The force that stands for a whole step (s): see [`NormalForce::within_step`].
    #[inline(always)]
    pub(crate) fn force_of_step(&self, depth: R, rate: R, step: R) -> NormalForce<R> {
        self.force(depth, rate).within_step(self.bend(), depth, rate, step)
    }

    /// `n (n − 1) / 12` of its elastic force `∝ δⁿ`: see [`NormalForce::within_step`].
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

    /// The tangent stiffness `∂fₙ/∂δ` (N/m) at a penetration (m), rates left out.
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

    /// The damping `∂fₙ/∂δ̇` (N·s/m) at a penetration (m), while approaching.
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
            // What it damps grows with the load, not with the penetration: see `Rebound`.
            Self::Hertz { .. } | Self::Rebound { .. } => R::zero(),
        }
    }
}
