//! Contact laws between two kinds of bodies.

mod fields;
mod text;

pub use fields::{FREE_INTERFACE, FRICTION, IMPACT, INTERFACE};
pub(super) use text::{PairDefaults, read, write, write_free};

use barrelstack_dynamics::contact::restitution;
use barrelstack_input::named;

named! {
    /// Unit for which contact constants are stated: a contact node, a meter of boundary, or a seat.
    pub enum Basis {
        /// Constants apply to one contact node, whatever the spacing of the nodes.
        Node = "node",
        /// Constants apply to one meter of boundary and are multiplied by the tributary length of the node.
        Length = "length",
        /// Constants apply to one seat, however many nodes it is divided into: one rail on the crown of a barrel, one
        /// support of a cradle, one end of a rail or one foot on the ground, or one post.
        Seat = "seat",
    }
}

/// Dissipation of a normal law, specified by a damping coefficient or by a coefficient of restitution.
///
/// In either case, the restitution of an impact depends on the mass or the speed of the body that strikes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Damping coefficient: for a linear law, `c`, in N·s/m for one node or seat, or in N·s/m per meter of boundary
    /// (N·s/m²); for a Hunt-Crossley law, `d` (s/m).
    Coefficient(f64),
    /// Coefficient of restitution at a reference mass or speed, from which the damping coefficient follows.
    Restitution {
        /// Coefficient of restitution: normal speed after an impact divided by normal speed before it, in `(0, 1]`.
        restitution: f64,
        /// For a linear law, the mass that strikes one node or seat (kg), or one meter of boundary (kg/m); for a
        /// Hunt-Crossley law, the impact speed (m/s).
        reference: f64,
    },
}

/// Normal law: compressive force as a function of the penetration and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NormalLaw {
    /// `k δ + c δ̇` on approach, `k δ` on rebound (Candia, de la Llera and Almazán 2008, eq. 2.6).
    SpeedGap {
        /// `k`: N/m for one node or seat, or N/m per meter of boundary (N/m²).
        stiffness: f64,
        /// Dissipation.
        damping: Damping,
    },
    /// `max(0, k δ + c δ̇)`.
    KelvinVoigt {
        /// `k`: N/m for one node or seat, or N/m per meter of boundary (N/m²).
        stiffness: f64,
        /// Dissipation.
        damping: Damping,
    },
    /// `k δⁿ (1 + d δ̇)`.
    HuntCrossley {
        /// `k`: N/mⁿ for one node or seat, or N/mⁿ per meter of boundary (N/mⁿ⁺¹).
        stiffness: f64,
        /// `n`, either 1 or 1.5.
        exponent: f64,
        /// Dissipation.
        damping: Damping,
    },
    /// `k δ^1.5` on approach and `e² k δ^1.5` on separation, with a gradual transition over speeds of about `v`.
    Rebound {
        /// `k`: N/m^1.5 for one node or seat, or N/m^1.5 per meter of boundary (N/m^2.5).
        stiffness: f64,
        /// Coefficient of restitution `e`: normal speed after an impact divided by normal speed before it, in `(0, 1]`.
        restitution: f64,
        /// `v` (m/s), the impact speed below which bodies come to rest.
        speed: f64,
    },
    /// `k δ^1.5`, without dissipation.
    Hertz {
        /// `k`: N/m^1.5 for one node or seat, or N/m^1.5 per meter of boundary (N/m^2.5).
        stiffness: f64,
    },
}

/// Friction law: tangential force as a function of the slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// No friction.
    None,
    /// Coulomb friction with an elastic and damped tangential spring (stick).
    Coulomb {
        /// Kinetic coefficient.
        coefficient: f64,
        /// Static coefficient, at least as large as the kinetic coefficient.
        static_coefficient: f64,
        /// Ratio of the tangential to the normal stiffness.
        tangential_stiffness_ratio: f64,
        /// Ratio of the tangential to the normal damping.
        tangential_damping_ratio: f64,
    },
    /// Coulomb friction smoothed near zero slip rate; contacts creep and never stick.
    Regularized {
        /// Kinetic coefficient.
        coefficient: f64,
        /// Slip rate (m/s) at which the friction reaches 71 % of its limit.
        velocity: f64,
    },
}

/// Contact law between two kinds of bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interface {
    /// Basis of the stiffness and damping: per node, per length of boundary or per seat.
    pub basis: Basis,
    /// Law of the normal force.
    pub normal: NormalLaw,
    /// Law of the tangential force.
    pub friction: Friction,
}

/// Function that converts the restitution of a law to its damping ratio; `None` if no damping ratio gives this
/// restitution.
type DampingRatio = fn(f64) -> Option<f64>;

/// Function that converts the damping ratio of a law to its restitution.
type Restitution = fn(f64) -> f64;

impl Interface {
    /// Returns `true` if the damping is specified by a coefficient of restitution.
    pub fn states_restitution(&self) -> bool {
        match self.normal {
            NormalLaw::SpeedGap { damping, .. }
            | NormalLaw::KelvinVoigt { damping, .. }
            | NormalLaw::HuntCrossley { damping, .. } => {
                matches!(damping, Damping::Restitution { .. })
            }
            NormalLaw::Rebound { .. } | NormalLaw::Hertz { .. } => false,
        }
    }

    /// Multiplies the stiffness by a factor.
    pub fn stiffen(&mut self, factor: f64) {
        match &mut self.normal {
            NormalLaw::SpeedGap { stiffness, .. }
            | NormalLaw::KelvinVoigt { stiffness, .. }
            | NormalLaw::HuntCrossley { stiffness, .. }
            | NormalLaw::Rebound { stiffness, .. }
            | NormalLaw::Hertz { stiffness } => *stiffness *= factor,
        }
    }

    /// Multiplies the damping of a linear law by a factor. Other laws are left unchanged.
    ///
    /// If the damping is specified by a coefficient of restitution, that coefficient is changed so that the damping
    /// ratio is multiplied by the factor.
    pub fn damp(&mut self, factor: f64) {
        let (damping, to_ratio, from_ratio): (_, DampingRatio, Restitution) = match &mut self.normal
        {
            NormalLaw::SpeedGap { damping, .. } => {
                (damping, restitution::speed_gap_damping_ratio, restitution::speed_gap)
            }
            NormalLaw::KelvinVoigt { damping, .. } => {
                (damping, restitution::kelvin_voigt_damping_ratio, restitution::kelvin_voigt)
            }
            NormalLaw::HuntCrossley { .. }
            | NormalLaw::Rebound { .. }
            | NormalLaw::Hertz { .. } => return,
        };
        match damping {
            Damping::Coefficient(c) => *c *= factor,
            Damping::Restitution { restitution, .. } => {
                *restitution =
                    to_ratio(*restitution).map_or(1.0, |ratio| from_ratio(factor * ratio));
            }
        }
    }

    /// Multiplies the static friction coefficient by a factor of at least 1.
    pub fn hold(&mut self, factor: f64) {
        if let Friction::Coulomb { static_coefficient, .. } = &mut self.friction {
            *static_coefficient *= factor;
        }
    }

    /// Multiplies the ratio of the tangential to the normal stiffness by a factor.
    pub fn stick(&mut self, factor: f64) {
        if let Friction::Coulomb { tangential_stiffness_ratio, .. } = &mut self.friction {
            *tangential_stiffness_ratio *= factor;
        }
    }

    /// Multiplies the kinetic and static friction coefficients by a factor.
    pub fn roughen(&mut self, factor: f64) {
        match &mut self.friction {
            Friction::Coulomb { coefficient, static_coefficient, .. } => {
                *coefficient *= factor;
                *static_coefficient *= factor;
            }
            Friction::Regularized { coefficient, .. } => *coefficient *= factor,
            Friction::None => {}
        }
    }
}
