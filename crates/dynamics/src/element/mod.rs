//! Force elements: forces between two bodies without a contact.
//!
//! An element is of one of the kinds below, each in a file of its own, which defines its forces at a state and
//! whether it fails ([`Load`]).
//! The rest is common to all: elements are attached to a model, remember plastic elongation and failure, enter the
//! forces and the energy balance, and run in lanes.

mod guide;
mod link;
mod rod;
mod strap;

use crate::body::BodyId;
use crate::lanewise;
use crate::real::Real;
use crate::space::{Space, Wrench};
use crate::state::State;

pub use guide::Guide;
pub use link::Link;
pub use rod::Rod;
pub use strap::Strap;

/// Memory of an element; changed by accepted steps only.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory<S: Space> {
    /// Plastic elongation (m).
    pub plastic: S::Real,
    /// `true` if it is broken, for good: then it bears nothing.
    pub broken: <S::Real as Real>::Mask,
}

lanewise!(struct Memory<Planar<R>> { plastic } masks { broken });

/// Load of an element at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R: Real> {
    /// Force (N) along it, positive where it pulls its bodies together.
    pub force: R,
    /// Energy stored in it (J); lost when it breaks.
    pub energy: R,
    /// Part of the force due to the spring (N), which has the energy.
    pub elastic: R,
    /// Plastic elongation (m) once the state is accepted.
    pub plastic: R,
    /// `true` if it fails.
    pub breaks: R::Mask,
}

/// Load and wrenches of an element at a state.
pub(crate) struct Action<S: Space> {
    pub(crate) load: Load<S::Real>,
    /// For each body the total wrench about the center of mass, and the part of the damper in it.
    pub(crate) wrenches: [(Wrench<S>, Wrench<S>); 2],
}

/// Declares the kinds of elements, each a struct with a `link` and the functions called here.
macro_rules! kinds {
    ($($(#[$about:meta])* $kind:ident),*) => {
        /// An element of one of the kinds.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Element<S: Space> {
            $($(#[$about])* $kind($kind<S>)),*
        }

        $(impl<S: Space> From<$kind<S>> for Element<S> {
            fn from(element: $kind<S>) -> Self {
                Self::$kind(element)
            }
        })*

        lanewise!(enum Element<Planar<R>> { $($kind(element)),* });

        impl<S: Space> Element<S> {
            /// Returns its name, and the points that it joins.
            pub fn link(&self) -> &Link<S> {
                match self { $(Self::$kind(element) => &element.link),* }
            }

            /// Returns its largest stiffness (N/m) between its points.
            pub fn stiffness(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.stiffness()),* }
            }

            /// Returns its largest damping (N·s/m) between its points.
            pub fn damping(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.damping()),* }
            }

            /// Fits its natural length to the points at a state, plus an excess (m).
            pub fn fit(&mut self, state: &State<S>, give: S::Real) {
                match self { $(Self::$kind(element) => element.fit(state, give)),* }
            }

            /// Returns the problem of its constants, if any.
            fn flaw(&self) -> Option<&'static str> {
                match self { $(Self::$kind(element) => element.flaw()),* }
            }

            /// Returns its load and wrenches at a state; zero in lanes where it is broken.
            #[inline(always)]
            pub(crate) fn act(
                &self,
                state: &State<S>,
                rotations: &[S::Rotation],
                memory: Memory<S>,
            ) -> Action<S> {
                match self { $(Self::$kind(element) => element.act(state, rotations, memory)),* }
            }
        }
    };
}

kinds!(
    /// Acts in tension only; may yield.
    Strap,
    /// Holds a distance, and damps a pendulum.
    Rod,
    /// A spring, a damper and stops along an axis of a body.
    Guide
);

impl<S: Space> Element<S> {
    /// Returns its problem in a model with a number of bodies, if any.
    pub(crate) fn problem(&self, bodies: usize) -> Option<&'static str> {
        self.link().flaw(bodies).or_else(|| self.flaw())
    }

    /// Returns its load at a state, unbroken.
    pub fn load(&self, state: &State<S>) -> Load<S::Real> {
        let rotations: Vec<_> = state.poses.iter().map(|p| S::rotation(p.orientation)).collect();
        self.act(state, &rotations, Memory::default()).load
    }

    /// Returns the joined bodies, each with the point (m) in its frame.
    pub fn ends(&self) -> impl Iterator<Item = (BodyId, S::Vector)> + use<S> {
        self.link().bodies.into_iter().zip(self.link().points)
    }

    /// Returns `true` if the force acts on both bodies at the point of the second one, not on each at its own.
    pub fn acts_at_second(&self) -> bool {
        match self {
            Self::Strap(_) => false,
            Self::Rod(_) | Self::Guide(_) => true,
        }
    }
}

/// Returns `true` if a number is valid in every lane.
fn all<R: Real>(number: R, sound: fn(f64) -> bool) -> bool {
    (0..R::LANES).all(|lane| sound(number.lane(lane)))
}

/// Stores the plastic elongation of the accepted state, and marks the elements that failed as broken.
#[inline(always)]
pub(crate) fn commit<S: Space>(memory: &mut [Memory<S>], loads: &[Load<S::Real>]) {
    for (memory, load) in memory.iter_mut().zip(loads) {
        memory.plastic = load.plastic;
        memory.broken = memory.broken | load.breaks;
    }
}
