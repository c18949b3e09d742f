//! The contacts of the round pieces of a convex boundary: corners, rounded or sharp, and arcs.

use super::{Group, Laws, Press, midway};
use crate::body::Round;
use crate::pair_frame::PairFrame;
use crate::real::{Mask, Real, both};
use crate::shape::{Facing, Nearest, Surface};
use crate::space::{Linear, Space, Wrench};

/// Length (m) by which a side is extended when it is tested against a corner of the body that [leads](Press::leads),
/// and shortened when it is tested against a corner of the other body. So exactly one contact is counted where two
/// corners coincide.
const SLACK: f64 = 1e-9;

/// Distance (m) from the end of a side within which a corner that bears on the side may share its contact with the
/// other body's corner at that end. A corner that is farther from the end always counts in full.
const COMPANION: f64 = 0.01;

/// Sine of an angle of about 45°. A round piece faces a side of the other body if the direction toward that side lies
/// within the [limits](Round::limits) of the piece, or outside of them by at most this angle.
const FACES: f64 = 0.7;

/// Distance (m) outside the core of the other body up to which the center of a round piece is treated as inside the
/// core. A round piece whose center is inside can bear on any side that it faces, and not only on the nearest side.
/// Where two bodies are flush, one of two nearly coincident corners may lie just outside the core.
const NEARLY_INSIDE: f64 = 1e-5;

/// Tolerance, as the sine of an angle, for contacts between two round pieces: the direction toward the other piece may
/// lie outside the limits of a piece by this angle.
const LIMIT: f64 = 2e-7;

/// Returns `true` if it is certain that every contact between the round pieces of a group and a surface belongs to the
/// pair with exchanged bodies: the contactor [leads](Press::leads) in no lane, and each piece can only touch an arc of
/// the surface.
#[inline(always)]
pub(super) fn belongs_to_others<S: Space>(
    leads: <S::Real as Real>::Mask,
    rounds: &[Round<S>],
    nodes: &[u32],
    frame: &PairFrame<S>,
    surface: &S::Surface,
) -> bool {
    if leads.any() {
        return false;
    }
    for node in nodes {
        let center = frame.to_surface(rounds[*node as usize].center);
        if !surface.is_by_arc(center).all() {
            return false;
        }
    }
    true
}

impl<S: Space, L: Fn() -> Laws<S::Real>> Press<'_, S, L> {
    /// Adds the contacts of the round pieces of a convex boundary. Each piece is tested at its deepest point.
    ///
    /// A round piece touches a straight side if the normal of the contact lies within the [limits](Round::limits) of
    /// the piece; a limit at which the boundary of the body continues with a straight side does not apply. Two round
    /// pieces touch if the normal lies within the limits of both; this contact belongs to the pair whose contactor
    /// [leads](Press::leads).
    #[inline(always)]
    pub(super) fn rounds(&mut self, rounds: &[Round<S>], group: &Group, surface: &S::Surface) {
        let zero = S::Real::zero();
        let first = self.leads;
        let slack = S::Real::select(first, S::Real::splat(SLACK), S::Real::splat(-SLACK));
        for element in group.first..group.end {
            let round = &rounds[self.elements.nodes[element] as usize];
            let center = self.frame.to_surface(round.center);
            let nearest = self.nearest(surface, round, center, slack);
            let (mut gap, against_round) = (nearest.gap, nearest.round);
            gap.distance -= round.radius;
            let foreseen = if self.whole_step_depth.is_some() { self.foreseen_gap } else { zero };
            if !gap.distance.lt(foreseen).any() {
                continue;
            }
            let toward = self.frame.to_contactor(-gap.normal);
            let mut deepest = !<S::Real as Real>::Mask::default();
            for limit in round.arc_limits.iter().flatten() {
                let past = toward.dot(*limit);
                deepest = deepest & if round.takes_limit { past.le(zero) } else { past.lt(zero) };
            }
            // A side that the piece does not face carries no load, however near it is.
            let [a, b] = round.limits;
            let most = S::Real::splat(FACES);
            let faces = toward.dot(a).le(most) & toward.dot(b).le(most);
            let endless = !nearest.to_end.lt(S::Real::splat(f64::INFINITY));
            let mut counts = !against_round & deepest & (faces | endless);
            if first.any() {
                let limit = S::Real::splat(LIMIT);
                let within = toward.dot(a).le(limit) & toward.dot(b).le(limit);
                counts = counts | (against_round & within & first);
            }
            let mut counts = counts & (-round.greatest_depth).lt(gap.distance);
            for (outward, distance) in round.sides.iter().flatten() {
                // If the other body's round piece is nearer to the adjacent side than to the arc, the contact belongs
                // to the side.
                let center = round.center + toward * nearest.core;
                let rounding = nearest.core - nearest.gap.distance;
                let nearer = gap.distance.lt(center.dot(*outward) - *distance - rounding);
                counts = counts & !(against_round & nearer);
            }
            gap.distance = S::Real::select(counts, gap.distance, S::Real::splat(1.0));
            self.look_ahead(center - gap.normal * round.radius, gap);
            if gap.distance.lt(zero).any() {
                let share = self.share(round, &nearest, slack);
                let node = midway(center, gap, round.radius);
                let energy = self.node(element, node, gap, share.value);
                if zero.lt(share.slope).any() {
                    let force = nearest.toward_end * (energy * share.slope);
                    let arm = center - self.frame.contactor;
                    self.sum.normal += Wrench { force, moment: S::moment(arm, force) };
                }
            }
        }
    }

    /// Returns the piece of a surface that is nearest to the center (m) of a round piece. If the center is inside the
    /// core of the surface's shape, returns the nearest piece on which the round piece can bear.
    #[inline(always)]
    fn nearest(
        &self,
        surface: &S::Surface,
        round: &Round<S>,
        center: S::Vector,
        slack: S::Real,
    ) -> Nearest<S> {
        let nearest = surface.nearest(center, slack);
        if !nearest.core.lt(S::Real::splat(NEARLY_INSIDE)).any() {
            return nearest;
        }
        let limits = both(
            round.limits,
            #[inline(always)]
            |limit| self.frame.direction_to_surface(limit),
        );
        let facing = Facing { limits, most: FACES, slack: NEARLY_INSIDE };
        surface.bearing(center, &facing, nearest)
    }

    /// Returns the share, from 0 to 1, by which the forces between a corner and a side of the other body are
    /// multiplied. The share is below 1 only near the end of that side, where the other body's corner may bear on a
    /// side of this body as well.
    ///
    /// Where two faces overlap slightly, a corner of each body is inside the other body, one at each end of the
    /// overlap. They are one contact, which splits into two as the overlap grows. Of the two corners, the one nearer to
    /// the end of the side that it bears on is the shallower; its share decreases to zero toward that end. The other
    /// corner counts in full. So neither contact begins or ends with a jump in force, at any depth. Where two faces end
    /// at the same place to within rounding, the two corners coincide, and only one of them counts. This is the corner
    /// that is farther from the end of the side that it bears on or, if both are equally far, the corner of the body
    /// that [leads](Press::leads).
    #[inline(always)]
    fn share(&self, round: &Round<S>, nearest: &Nearest<S>, slack: S::Real) -> Share<S::Real> {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let to_end = nearest.to_end;
        let near_end = to_end.lt(S::Real::splat(COMPANION));
        let mut partly = <S::Real as Real>::Mask::default();
        if near_end.any() {
            // Vector from this corner to the corner at the end of the side on which it bears.
            let apart = nearest.toward_end * to_end - nearest.gap.normal * nearest.core;
            let apart = self.frame.to_contactor(apart);
            let toward = self.frame.to_contactor(-nearest.gap.normal);
            for (limit, arc) in round.limits.iter().zip(&round.arc_limits) {
                // The side of this body that lies along the side of the other body.
                if arc.is_none() {
                    let along = S::Real::splat(-FACES).lt(toward.dot(*limit));
                    partly = partly | (along & to_end.lt(apart.dot(*limit) - slack));
                }
            }
            partly = partly & near_end;
        }
        // The share is 3 u² − 2 u³, so that the force begins and ends at zero.
        let u = to_end.max(zero) * S::Real::splat(1.0 / COMPANION);
        let slope = S::Real::splat(6.0 / COMPANION) * u * (one - u);
        Share {
            value: S::Real::select(partly, u * u * (S::Real::splat(3.0) - u - u), one),
            slope: S::Real::select(partly, slope, zero),
        }
    }
}

/// Share, from 0 to 1, by which the forces between a corner and a side are multiplied, and its derivative.
struct Share<R> {
    value: R,
    /// Derivative of the share (1/m) with respect to the distance to the end of the side. Since the energy changes with
    /// the share, there is a force toward the end.
    slope: R,
}
