//! Conversion of the contact laws of a scenario to the contact laws of the model.

use barrelstack_dynamics::contact::{Exponent, restitution};
use barrelstack_dynamics::{Basis, FrictionLaw, Interface, NormalLaw, Space};

use super::Similitude;
use super::bundle::Bundle;
use crate::scenario;

/// Penetration (m) at which a nonlinear normal law is linearized to obtain the stiffness of the tangential spring.
const STICK_REFERENCE: f64 = 2e-4;

/// Damping ratio of the tangential spring of a contact with the normal law [`NormalLaw::Rebound`], if the contact
/// carries the mass [`STICK_MASS`].
const STICK_DAMPING_RATIO: f64 = 0.1;

/// Mass (kg) on a contact for which [`STICK_DAMPING_RATIO`] holds.
const STICK_MASS: f64 = 50.0;

/// Converts a contact law to an interface of the model; each contact of the interface represents a bundle of seats.
pub(super) fn interface<S: Space<Real = f64>>(
    name: &str,
    law: &scenario::Interface,
    bundle: Bundle,
    scale: Similitude,
) -> Interface<S> {
    let basis = match law.basis {
        scenario::Basis::Node => Basis::Node,
        scenario::Basis::Length => Basis::Length,
        scenario::Basis::Seat => Basis::Seat,
    };
    let normal = together(normal(&law.normal, basis, scale), bundle.elements());
    let friction = bundle.friction(law.friction);
    let friction = friction_of(&friction, &normal, basis == Basis::Length, scale);
    Interface { name: name.to_owned(), normal, stop: None, rolling: None, friction, basis }
}

/// Returns the normal law of several identical elements in parallel, which all have the same penetration.
fn together(law: NormalLaw, elements: f64) -> NormalLaw {
    match law {
        NormalLaw::SpeedGap { stiffness, damping } => {
            NormalLaw::SpeedGap { stiffness: elements * stiffness, damping: elements * damping }
        }
        NormalLaw::KelvinVoigt { stiffness, damping } => {
            NormalLaw::KelvinVoigt { stiffness: elements * stiffness, damping: elements * damping }
        }
        NormalLaw::HuntCrossley { stiffness, dissipation, exponent } => {
            NormalLaw::HuntCrossley { stiffness: elements * stiffness, dissipation, exponent }
        }
        NormalLaw::Rebound { stiffness, restitution, speed } => {
            NormalLaw::Rebound { stiffness: elements * stiffness, restitution, speed }
        }
        NormalLaw::Hertz { stiffness } => NormalLaw::Hertz { stiffness: elements * stiffness },
    }
}

fn normal(law: &scenario::NormalLaw, basis: Basis, scale: Similitude) -> NormalLaw {
    let per_length = basis == Basis::Length;
    let stiff = |k: f64, exponent: f64| k * scale.stiffness(exponent, per_length);
    let damp = |k: f64, damping: &scenario::Damping, invert: fn(f64) -> Option<f64>| {
        let full = match *damping {
            scenario::Damping::Coefficient(c) => c,
            scenario::Damping::Restitution { restitution: e, reference: mass } => {
                // The scenario accepts only restitutions in (0, 1], and a restitution of 1 has no damping.
                let ratio = invert(e).unwrap_or(0.0);
                restitution::damping(k, ratio, mass)
            }
        };
        full * scale.damping(per_length)
    };
    match law {
        scenario::NormalLaw::SpeedGap { stiffness, damping } => NormalLaw::SpeedGap {
            stiffness: stiff(*stiffness, 1.0),
            damping: damp(*stiffness, damping, restitution::speed_gap_damping_ratio),
        },
        scenario::NormalLaw::KelvinVoigt { stiffness, damping } => NormalLaw::KelvinVoigt {
            stiffness: stiff(*stiffness, 1.0),
            damping: damp(*stiffness, damping, restitution::kelvin_voigt_damping_ratio),
        },
        scenario::NormalLaw::HuntCrossley { stiffness, exponent, damping } => {
            let full = match *damping {
                scenario::Damping::Coefficient(d) => d,
                scenario::Damping::Restitution { restitution: e, reference: speed } => {
                    restitution::hunt_crossley_dissipation(e, speed).unwrap_or(0.0)
                }
            };
            NormalLaw::HuntCrossley {
                stiffness: stiff(*stiffness, *exponent),
                dissipation: full / scale.time(),
                exponent: if *exponent == 1.0 { Exponent::Linear } else { Exponent::Hertzian },
            }
        }
        scenario::NormalLaw::Rebound { stiffness, restitution, speed } => NormalLaw::Rebound {
            stiffness: stiff(*stiffness, 1.5),
            restitution: *restitution,
            speed: speed * scale.time(),
        },
        scenario::NormalLaw::Hertz { stiffness } => {
            NormalLaw::Hertz { stiffness: stiff(*stiffness, 1.5) }
        }
    }
}

fn friction_of(
    law: &scenario::Friction,
    normal: &NormalLaw,
    per_length: bool,
    scale: Similitude,
) -> FrictionLaw {
    match *law {
        scenario::Friction::None => FrictionLaw::Frictionless,
        scenario::Friction::Coulomb {
            coefficient,
            static_coefficient,
            tangential_stiffness_ratio,
            tangential_damping_ratio,
        } => {
            let reference = STICK_REFERENCE * scale.length;
            let stiffness = normal.tangent_stiffness(reference);
            let damping = match normal {
                // The damping of a rebound law has no constant coefficient, so the damping of the tangential spring
                // follows from a damping ratio.
                NormalLaw::Rebound { .. } => {
                    let mass =
                        STICK_MASS * scale.mass() / if per_length { scale.length } else { 1.0 };
                    restitution::damping(stiffness, STICK_DAMPING_RATIO, mass)
                }
                NormalLaw::SpeedGap { .. }
                | NormalLaw::KelvinVoigt { .. }
                | NormalLaw::HuntCrossley { .. }
                | NormalLaw::Hertz { .. } => normal.tangent_damping(reference),
            };
            FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient: coefficient,
                tangential_stiffness: tangential_stiffness_ratio * stiffness,
                tangential_damping: tangential_damping_ratio * damping,
            }
        }
        scenario::Friction::Regularized { coefficient, velocity } => {
            FrictionLaw::Regularized { coefficient, velocity: velocity * scale.time() }
        }
    }
}
