//! Force elements: forces between points of two bodies, without contact.
//!
//! Each kind of element has a file of its own, which computes the force of an element at a state, and whether the
//! element fails there ([`Load`]). This module contains the parts common to all kinds: the plastic elongation and
//! failure kept from step to step, the contributions to the forces and to the energy balance, and the support for
//! lanes.

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

/// State of a force element that is kept from step to step; changed only when a step is accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory<S: Space> {
    /// Plastic elongation (m).
    pub plastic: S::Real,
    /// `true` if the element is broken. A broken element exerts no force.
    pub broken: <S::Real as Real>::Mask,
}

lanewise!(struct Memory<S> { plastic } masks { broken });

/// Force and energy of an element at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R: Real> {
    /// Force (N) along the element, positive in tension.
    pub force: R,
    /// Energy stored in the element (J), which is lost when the element breaks.
    pub energy: R,
    /// Part of the force (N) that is due to the spring, which stores the energy.
    pub elastic: R,
    /// Plastic elongation (m) of the element if the state is accepted.
    pub plastic: R,
    /// `true` if the element fails at this state.
    pub breaks: R::Mask,
}

lanewise!(struct Load<R> { force, energy, elastic, plastic } masks { breaks });

/// Load and wrenches of an element at a state.
pub(crate) struct Action<S: Space> {
    pub(crate) load: Load<S::Real>,
    /// For each body, the total wrench about its center of mass, and the part of this wrench that is due to dampers.
    pub(crate) wrenches: [(Wrench<S>, Wrench<S>); 2],
}

/// Declares the kinds of elements. Each kind is a struct with a field `link` and the functions that are called here.
macro_rules! kinds {
    ($($(#[$about:meta])* $kind:ident),*) => {
        /// A force element.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Element<S: Space> {
            $($(#[$about])* $kind($kind<S>)),*
        }

        $(impl<S: Space> From<$kind<S>> for Element<S> {
            fn from(element: $kind<S>) -> Self {
                Self::$kind(element)
            }
        })*

        lanewise!(enum Element<S> { $($kind(element)),* });

        impl<S: Space> Element<S> {
            /// Returns the name of the element and the points that it joins.
            pub fn link(&self) -> &Link<S> {
                match self { $(Self::$kind(element) => &element.link),* }
            }

            /// Returns a mutable reference to the link.
            pub(crate) fn link_mut(&mut self) -> &mut Link<S> {
                match self { $(Self::$kind(element) => &mut element.link),* }
            }

            /// Returns the stiffness (N/m) of the element, including the stiffness of its stops.
            pub fn stiffness(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.stiffness()),* }
            }

            /// Returns the damping (N·s/m) of the element: the sum of the constants of its dampers, including those of
            /// its stops.
            pub fn damping(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.damping()),* }
            }

            /// Sets the unloaded length to the distance between the points at a state, plus the excess `give` (m).
            pub fn fit(&mut self, state: &State<S>, give: S::Real) {
                match self { $(Self::$kind(element) => element.fit(state, give)),* }
            }

            /// Returns a description of the error in the constants, if there is one.
            fn flaw(&self) -> Option<&'static str> {
                match self { $(Self::$kind(element) => element.flaw()),* }
            }

            /// Returns the load and the wrenches of the element at a state; they are zero in lanes where the element is
            /// broken.
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
    /// A strap, which acts in tension only and may yield.
    Strap,
    /// A rod, which holds two points at a given distance.
    Rod,
    /// A guide: a spring, a damper and stops along an axis of a body.
    Guide
);

impl<S: Space> Element<S> {
    /// Returns a description of the error in the element, if there is one; `bodies` is the number of bodies of the
    /// model.
    pub(crate) fn problem(&self, bodies: usize) -> Option<&'static str> {
        self.link().flaw(bodies).or_else(|| self.flaw())
    }

    /// Returns the load of the element at a state, as if the element had neither yielded nor broken before.
    pub fn load(&self, state: &State<S>) -> Load<S::Real> {
        let rotations: Vec<_> = state.poses.iter().map(|p| S::rotation(p.orientation)).collect();
        self.act(state, &rotations, Memory::default()).load
    }

    /// Returns the joined bodies, each with its point (m) in the body frame.
    pub fn ends(&self) -> impl Iterator<Item = (BodyId, S::Vector)> + use<S> {
        self.link().bodies.into_iter().zip(self.link().points)
    }

    /// Returns `true` if the force acts on both bodies at the point of the second body, and not on each body at its own
    /// point.
    pub fn acts_at_second(&self) -> bool {
        match self {
            Self::Strap(_) => false,
            Self::Rod(_) | Self::Guide(_) => true,
        }
    }
}

/// Returns `true` if `sound` accepts the number in every lane.
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
