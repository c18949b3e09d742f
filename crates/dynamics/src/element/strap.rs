//! Straps and other ties, which act in tension only.

use super::{Action, Link, Load, Memory, all};
use crate::lanewise;
use crate::real::Real;
use crate::space::Space;
use crate::state::State;

/// A strap between a point of one body and a point of another.
///
/// Its elongation `e` (m) is the distance between the two points minus `length`. While `e` is positive, its tension is
/// `T = max(0, k e + c ė)`; otherwise the strap is slack and has no tension. If the spring force would exceed the yield
/// force, the strap elongates plastically until the spring force equals the yield force; only the elastic elongation
/// causes tension. The strap has no mass, and touches nothing between its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Strap<S: Space> {
    /// The joined points.
    pub link: Link<S>,
    /// Distance (m) between the points beyond which the strap is taut.
    pub length: S::Real,
    /// Stiffness k (N/m).
    pub stiffness: S::Real,
    /// Damping c (N·s/m).
    pub damping: S::Real,
    /// Spring force (N) at which the strap yields; infinite if it never yields.
    pub yields_at: S::Real,
    /// Tension (N) above which the strap tears; infinite if it never tears.
    pub strength: S::Real,
}

lanewise!(struct Strap<S> { link, length, stiffness, damping, yields_at, strength });

impl<S: Space> Strap<S> {
    pub(super) fn stiffness(&self) -> S::Real {
        self.stiffness
    }

    pub(super) fn damping(&self) -> S::Real {
        self.damping
    }

    pub(super) fn fit(&mut self, state: &State<S>, give: S::Real) {
        self.length = self.link.span(state) + give;
    }

    pub(super) fn flaw(&self) -> Option<&'static str> {
        if !all(self.stiffness, |k| k > 0.0 && k.is_finite()) {
            Some("its stiffness must be positive and finite")
        } else if !all(self.damping, |c| c >= 0.0 && c.is_finite()) {
            Some("its damping must not be negative")
        } else if !all(self.length, |l| l >= 0.0 && l.is_finite()) {
            Some("its length must not be negative")
        } else if ![self.strength, self.yields_at].into_iter().all(|it| all(it, |t| t > 0.0)) {
            Some("its strength and its yield force must be positive")
        } else {
            None
        }
    }

    #[inline(always)]
    pub(super) fn act(
        &self,
        state: &State<S>,
        rotations: &[S::Rotation],
        memory: Memory<S>,
    ) -> Action<S> {
        let zero = S::Real::zero();
        let line = self.link.line(state, rotations);
        let length = self.length + memory.plastic;
        let taut = length.lt(line.distance) & zero.lt(line.distance) & !memory.broken;
        let along = line.along(taut);
        let elongation = S::Real::select(taut, line.distance - length, zero);
        let yields = self.yields_at.lt(self.stiffness * elongation);
        let most = self.yields_at / self.stiffness;
        let flow = S::Real::select(yields, elongation - most, zero);
        let elongation = S::Real::select(yields, most, elongation);
        let elastic = self.stiffness * elongation;
        let tension = (elastic + self.damping * line.rate(state, along)).max(zero);
        let tension = S::Real::select(taut, tension, zero);
        let load = Load {
            force: tension,
            energy: S::Real::splat(0.5) * elastic * elongation,
            elastic,
            plastic: memory.plastic + flow,
            breaks: self.strength.lt(tension),
        };
        Action { load, wrenches: line.pull(along, tension, tension - elastic) }
    }
}
