//! Force elements: what pushes or pulls two bodies without a contact.
//!
//! An element is of one of the kinds in the list below, each a file beside this one that says what it
//! does at a state, and whether it can hold ([`Load`]).
//! All else is the same for all: they are fastened to a model, remember what they gave for good and whether
//! they are broken, enter the forces and the energy books, and run in lanes.

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

/// What an element remembers; changed by accepted steps only.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory<S: Space> {
    /// How much longer (m) it is for good than when it was put on.
    pub plastic: S::Real,
    /// Whether it is broken, for good: then it bears nothing.
    pub broken: <S::Real as Real>::Mask,
}

lanewise!(struct Memory<Planar<R>> { plastic } masks { broken });

/// What an element bears at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R: Real> {
    /// Force (N) along it, positive where it pulls its bodies together.
    pub force: R,
    /// Energy stored in it (J); lost when it breaks.
    pub energy: R,
    /// Of the force that of its spring (N), which its energy belongs to.
    pub elastic: R,
    /// How much longer (m) for good it is once the state is accepted.
    pub plastic: R,
    /// Whether it cannot hold.
    pub breaks: R::Mask,
}

/// What an element does at a state.
pub(crate) struct Action<S: Space> {
    pub(crate) load: Load<S::Real>,
    /// For each of its bodies the whole wrench about the center of mass, and of that the part that its
    /// damper makes.
    pub(crate) wrenches: [(Wrench<S>, Wrench<S>); 2],
}

/// Declares the kinds of elements, each a struct with a `link` and the functions that are asked for here.
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
            /// Its name, and the points that it joins.
            pub fn link(&self) -> &Link<S> {
                match self { $(Self::$kind(element) => &element.link),* }
            }

            /// The largest stiffness (N/m) that it has between its points.
            pub fn stiffness(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.stiffness()),* }
            }

            /// The largest damping (N·s/m) that it has between its points.
            pub fn damping(&self) -> S::Real {
                match self { $(Self::$kind(element) => element.damping()),* }
            }

            /// Lets it bear nothing where its points are at a state, but for some more length (m).
            pub fn fit(&mut self, state: &State<S>, give: S::Real) {
                match self { $(Self::$kind(element) => element.fit(state, give)),* }
            }

            /// What is wrong with its constants.
            fn flaw(&self) -> Option<&'static str> {
                match self { $(Self::$kind(element) => element.flaw()),* }
            }

            /// What it does at a state; nothing in lanes where it is broken.
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
    /// Pulls and never pushes; may yield.
    Strap,
    /// Holds a distance, and damps a pendulum.
    Rod,
    /// A spring, a damper and stops along an axis of a body.
    Guide
);

impl<S: Space> Element<S> {
    /// What is wrong with it in a model of a number of bodies.
    pub(crate) fn problem(&self, bodies: usize) -> Option<&'static str> {
        self.link().flaw(bodies).or_else(|| self.flaw())
    }

    /// What it bears at a state, unbroken.
    pub fn load(&self, state: &State<S>) -> Load<S::Real> {
        let rotations: Vec<_> = state.poses.iter().map(|p| S::rotation(p.orientation)).collect();
        self.act(state, &rotations, Memory::default()).load
    }

    /// The bodies that it joins, each with the point (m) in its frame.
    pub fn ends(&self) -> impl Iterator<Item = (BodyId, S::Vector)> + use<S> {
        self.link().bodies.into_iter().zip(self.link().points)
    }

    /// Whether it pushes both bodies where the point of the second one is, not each at its own.
    pub fn acts_at_second(&self) -> bool {
        match self {
            Self::Strap(_) => false,
            Self::Rod(_) | Self::Guide(_) => true,
        }
    }
}

/// Whether a number is sound in every lane.
fn all<R: Real>(number: R, sound: fn(f64) -> bool) -> bool {
    (0..R::LANES).all(|lane| sound(number.lane(lane)))
}

/// Elements remember what they gave for good in an accepted state, and those that could not hold are broken
/// from then on.
#[inline(always)]
pub(crate) fn commit<S: Space>(memory: &mut [Memory<S>], loads: &[Load<S::Real>]) {
    for (memory, load) in memory.iter_mut().zip(loads) {
        memory.plastic = load.plastic;
        memory.broken = memory.broken | load.breaks;
    }
}
