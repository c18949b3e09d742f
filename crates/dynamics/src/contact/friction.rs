//! Friction force as a function of normal force, slip rate and contact history.

use crate::real::{Mask, Real};
use crate::space::{Linear, Space};

/// Friction law of one node.
///
/// The force that [`FrictionLaw::force`] returns has the sign of the slip; the contact loop applies the opposite force
/// to the contactor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionLaw<R = f64> {
    /// No friction.
    Frictionless,
    /// Coulomb friction with elastic sticking: a tangential spring deforms before the contact slides.
    ///
    /// ```text
    /// spring  = k_t s            limited to ± μ fₙ
    /// f_t     = spring + c_t v_t limited to ± μ fₙ
    /// ```
    ///
    /// `s` is the displacement of the spring. It is integrated like any other coordinate of the state; its rate of
    /// change is the slip rate. It is limited to the capacity of the spring only when a step is accepted
    /// ([`Stick::commit`]). So a body at rest on a slope does not creep. The law `f_t = μ fₙ` of Candia et al. (2008)
    /// is the sliding part of this law. μ is the static coefficient until the force exceeds the static limit, and then
    /// the kinetic coefficient until the slip reverses.
    Coulomb {
        /// Static coefficient `μ_s`, not smaller than the kinetic coefficient.
        static_coefficient: R,
        /// Kinetic coefficient `μ_k`.
        kinetic_coefficient: R,
        /// Tangential stiffness `k_t` (N/m).
        tangential_stiffness: R,
        /// Tangential damping `c_t` (N·s/m); without this damping, a body that has stopped sliding would vibrate on the
        /// tangential spring indefinitely.
        tangential_damping: R,
    },
    /// Smoothed Coulomb friction: `f_t = μ fₙ v_t / √(v_t² + v_r²)`.
    ///
    /// The law has no history and cannot hold a body at rest: under a steady tangential force `T < μ fₙ` the body
    /// creeps at `v_r T / √((μ fₙ)² − T²)`, see [`FrictionLaw::creep_speed`].
    Regularized {
        /// Friction coefficient `μ`.
        coefficient: R,
        /// Slip rate `v_r` (m/s) at which the friction reaches 71 % (1/√2) of its limit `μ fₙ`.
        velocity: R,
    },
}

/// Contact history of a node: the state of the tangential spring of its friction law, kept from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stick<S: Space> {
    /// Elastic tangential displacement of the contactor relative to the target (m), in the inertial frame.
    pub displacement: S::Tangent,
    /// Tangent plane that contained the displacement when the last step was accepted. The plane turns as the contact
    /// moves over a round target.
    pub tangent_plane: S::TangentPlane,
    /// `true` if the node was slipping when the last step was accepted.
    pub slipping: <S::Real as Real>::Mask,
}

/// A friction force, and the recoverable energy of its spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<S: Space> {
    /// Force (N) in the direction of the slip; the opposite force acts on the contactor.
    pub force: S::Tangent,
    /// Energy (J) stored in the tangential spring.
    pub energy: S::Real,
}

impl<R: Real> FrictionLaw<R> {
    /// Returns the friction of a node that slips at `slip_rate` (m/s) under a normal force (N).
    ///
    /// `weight` multiplies the tangential constants: the tributary length (m) for constants per length, and 1 for
    /// constants per node or per seat.
    #[inline(always)]
    pub fn force<S: Space<Real = R>>(
        &self,
        stick: Stick<S>,
        slip_rate: S::Tangent,
        normal_force: R,
        weight: R,
    ) -> Friction<S> {
        match *self {
            Self::Frictionless => Friction { force: S::Tangent::default(), energy: R::zero() },
            Self::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            } => {
                let coefficient =
                    R::select(stick.slipping, kinetic_coefficient, static_coefficient);
                let limit = coefficient * normal_force;
                let stiffness = tangential_stiffness * weight;
                let spring = S::shorten(stick.displacement * stiffness, limit);
                let energy = R::splat(0.5) * spring.dot(stick.displacement);
                let force = S::shorten(spring + slip_rate * (tangential_damping * weight), limit);
                Friction { force, energy }
            }
            Self::Regularized { coefficient, velocity } => {
                let speed = (slip_rate.dot(slip_rate) + velocity * velocity).sqrt();
                Friction {
                    force: slip_rate * (coefficient * normal_force / speed),
                    energy: R::zero(),
                }
            }
        }
    }

    /// Returns the tangential stiffness (N/m) of a sticking contact; zero for friction laws without a tangential
    /// spring.
    #[inline(always)]
    pub fn stick_stiffness(&self) -> R {
        match *self {
            Self::Frictionless | Self::Regularized { .. } => R::zero(),
            Self::Coulomb { tangential_stiffness, .. } => tangential_stiffness,
        }
    }

    /// Returns the creep speed (m/s) of a body under a steady tangential force, given as the fraction `share` of the
    /// friction limit (0 ≤ share < 1); zero for all laws except [`FrictionLaw::Regularized`].
    pub fn creep_speed(&self, share: f64) -> R {
        match *self {
            Self::Frictionless | Self::Coulomb { .. } => R::zero(),
            Self::Regularized { velocity, .. } => {
                velocity * R::splat(share / (1.0 - share * share).sqrt())
            }
        }
    }
}

impl<S: Space> Stick<S> {
    /// Returns the history with its displacement transported into the current tangent plane of the contact.
    #[inline(always)]
    #[must_use]
    pub fn carried(self, to: S::TangentPlane) -> Self {
        let displacement = S::carry(self.displacement, self.tangent_plane, to);
        Self { displacement, tangent_plane: to, ..self }
    }

    /// Returns the contact history after an accepted step: the displacement, limited to the friction capacity, and
    /// whether the node slips. `self` contains the displacement at the end of the step; `weight` is as in
    /// [`FrictionLaw::force`].
    #[inline(always)]
    #[must_use]
    pub fn commit(
        self,
        law: &FrictionLaw<S::Real>,
        slip_rate: S::Tangent,
        normal_force: S::Real,
        weight: S::Real,
    ) -> Self {
        let FrictionLaw::Coulomb {
            static_coefficient,
            kinetic_coefficient,
            tangential_stiffness,
            tangential_damping,
        } = *law
        else {
            return Self::default();
        };
        let stiffness = tangential_stiffness * weight;
        let spring = self.displacement * stiffness;
        let trial = spring + slip_rate * (tangential_damping * weight);
        let kinetic = kinetic_coefficient * normal_force;
        let limit = static_coefficient * normal_force;
        let limit = S::Real::select(self.slipping, kinetic, limit);
        let broken = (limit * limit).lt(trial.dot(trial));
        // A slipping node sticks again when its slip reverses, so that the slip relaxes the stretched spring.
        let follows = S::Real::zero().le(spring.dot(slip_rate));
        let slipping = broken | (self.slipping & follows);
        let held = S::Real::select(slipping, kinetic, limit);
        let overstretched = (held * held).lt(spring.dot(spring));
        if !overstretched.any() {
            return Self { slipping, ..self };
        }
        // Avoids a division by zero: an element of weight zero has no contact, and its history is reset in any case.
        let safe = S::Real::select(overstretched, stiffness, S::Real::splat(1.0));
        let cut = S::shorten(spring, held) * (S::Real::splat(1.0) / safe);
        let displacement = S::choose(overstretched, cut, self.displacement);
        Self { displacement, slipping, ..self }
    }
}
