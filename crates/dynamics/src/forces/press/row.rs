//! Rows of nodes that act as one seat: the contact constants are those of the whole row, not of a node
//! ([`Basis::Seat`](crate::contact::Basis::Seat)).
//!
//! The depth of the seat is that of its deepest node. The contact laws are evaluated at this depth, and their forces
//! are divided among the touching nodes in proportion to the depths of the nodes. So the number of nodes affects the
//! location of the resultant force, but not the stiffness, the damping or the friction.

use crate::pair_frame::AtFace;
use crate::real::Real;
use crate::shape::Gap;
use crate::space::Space;

use super::{Laws, Press};

/// Returns the gap in lanes where the contact filter accepts the contact, and an open gap in all other lanes.
#[inline(always)]
pub(super) fn counting<S: Space>(counted: Option<AtFace<S>>, mut gap: Gap<S>) -> Gap<S> {
    if let Some(face) = counted {
        gap.distance = S::Real::select(face.counts(gap.normal), gap.distance, S::Real::splat(1.0));
    }
    gap
}

/// Depths of a row of nodes that acts as one seat.
#[derive(Clone, Copy, Default)]
pub(super) struct Row<R> {
    /// The depth (m) of the deepest node.
    deepest: R,
    /// The sum of the depths (m) of the touching nodes.
    sum: R,
}

impl<R: Real> Row<R> {
    /// Adds a node, given its gap as returned by [`counting`].
    #[inline(always)]
    pub(super) fn add<S: Space<Real = R>>(&mut self, gap: Gap<S>) {
        let depth = (-gap.distance).max(R::zero());
        self.deepest = self.deepest.max(depth);
        self.sum += depth;
    }
}

impl<S: Space, L: Fn() -> Laws<S::Real>> Press<'_, S, L> {
    /// Adds the forces of one node of a row that acts as one seat. They are a share of the forces of the row, in
    /// proportion to the depth of the node.
    #[inline(always)]
    pub(super) fn of_row(
        &mut self,
        element: usize,
        node: S::Vector,
        gap: Gap<S>,
        row: &Row<S::Real>,
    ) {
        let gap = counting(self.counted, gap);
        let zero = S::Real::zero();
        let touching = gap.distance.lt(zero);
        let sum = S::Real::select(touching, row.sum, S::Real::splat(1.0));
        let share = S::Real::select(touching, -gap.distance / sum, zero);
        self.press(element, node, gap, share, Some(row.deepest));
    }
}
