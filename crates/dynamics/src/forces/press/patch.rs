//! Forces of a contact patch: normal forces, which need no history, and friction, whose tangential springs are placed
//! around the center of pressure.

use super::{Contact, Laws, Press, Pressed};
use crate::contact::NormalForce;
use crate::real::{Mask, Real};
use crate::shape::{Bearing, Gap, Patch, Points, Spread, Touch};
use crate::space::{Linear, Space, Wrench};

impl<S: Space, L: Fn() -> Laws<S::Real>> Press<'_, S, L> {
    /// Adds the forces of a patch. Its tangential springs are those of the contact elements from the index `first` on.
    #[inline(always)]
    pub(super) fn patch(&mut self, first: usize, patch: &Patch<S>) {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let Touch { node, gap } = patch.deepest;
        self.look_ahead(node, gap);
        self.look_at_speed(node, gap);
        if !gap.distance.lt(zero).any() {
            return;
        }
        let Some(spread) = &patch.spread else {
            self.node(first, node, gap, one);
            return;
        };
        let bears = spread.bears(gap.distance);
        let alone = gap.distance.lt(zero) & !bears;
        if bears.any() && alone.any() {
            // Each lane takes one of the two branches below.
            let at = self.pressed.len();
            let in_lanes =
                |lanes| Gap { distance: S::Real::select(lanes, gap.distance, one), ..gap };
            self.spread(first, Touch { node, gap: in_lanes(bears) }, spread);
            let slip_rate = self.slip_rates[first];
            self.deepest_only(first, Touch { node, gap: in_lanes(alone) }, spread);
            self.slip_rates[first] = S::choose(alone, self.slip_rates[first], slip_rate);
            if let Some(own) = self.pressed.pop() {
                self.pressed[at].merge(alone, &own);
            }
        } else if bears.any() {
            self.spread(first, patch.deepest, spread);
        } else {
            self.deepest_only(first, patch.deepest, spread);
        }
    }

    /// Adds the forces of a patch of which only the deepest point is in contact.
    #[inline(always)]
    fn deepest_only(&mut self, first: usize, deepest: Touch<S>, spread: &Spread<S>) {
        let energy = self.node(first, deepest.node, deepest.gap, spread.shares.deepest);
        self.sum.normal += spread.slopes.deepest.times(-energy);
    }

    /// Requests substeps in lanes where the spring and damper forces would change too abruptly in a whole step, and
    /// detects hard impacts.
    #[inline(always)]
    fn look_at_speed(&mut self, node: S::Vector, gap: Gap<S>) {
        let Some(fast) = self.fast else { return };
        let approach = -self.meeting.velocity(node).dot(gap.normal);
        let travel = self.lookahead * approach.abs();
        // As in `look_ahead`, wider gaps are ignored, since not every run tests elements with wider gaps.
        let near = gap.distance.lt(travel) & gap.distance.lt(self.foreseen_gap);
        self.needs_substeps = self.needs_substeps | (near & fast.whole_step_way.lt(travel));
        self.is_hard = self.is_hard | (near & fast.hard.lt(approach));
    }

    /// Adds the forces of a patch of more than one point.
    #[inline(always)]
    fn spread(&mut self, first: usize, mut deepest: Touch<S>, spread: &Spread<S>) {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        if let Some(face) = self.counted {
            let counts = face.counts(deepest.gap.normal);
            deepest.gap.distance = S::Real::select(counts, deepest.gap.distance, one);
        }
        let meeting = self.meeting;
        let depth_and_rate = |touch: &Touch<S>| {
            let rate = -meeting.velocity(touch.companion()).dot(touch.gap.normal);
            (-touch.gap.distance, rate)
        };
        let ((depth, rate), (middle, middle_rate)) =
            (depth_and_rate(&deepest), depth_and_rate(&spread.middle));
        let touching = zero.lt(depth);
        let (shares, between) = (spread.shares, S::Real::splat(spread.axes.in_the_middle()));
        // For the deepest point, its mirror image and the middle: depth, penetration rate, and number of springs.
        let springs = [
            (depth, rate, shares.deepest),
            (middle + middle - depth, middle_rate + middle_rate - rate, shares.others),
            (middle, middle_rate, shares.others * between),
        ];
        let weight = S::Real::select(touching, self.elements.weights[first], zero);
        let (mut forces, mut stiffness) = ([(zero, zero); 3], zero);
        // Energies that the springs would store if their shares were 1.
        let mut energies = [zero; 3];
        for (((depth, rate, count), (total, damped)), energy) in
            springs.into_iter().zip(&mut forces).zip(&mut energies)
        {
            let pressed = zero.lt(depth);
            let depth = S::Real::select(pressed, depth, zero);
            let normal = self.law(depth, rate);
            *energy = normal.energy * S::Real::select(pressed, weight, zero);
            let weight = S::Real::select(pressed, weight * count, zero);
            *total = normal.total * weight;
            *damped = *total - normal.elastic * weight;
            self.totals.elastic += normal.energy * weight;
            stiffness += depth * weight;
        }
        // Number of springs, each weighted by its depth relative to the depth of the deepest point.
        let stiffness = stiffness / S::Real::select(touching, depth, one);
        let [deep, mirrored, between] = forces;
        let at_deepest = (deep.0 - mirrored.0, deep.1 - mirrored.1);
        let in_middle = (mirrored.0 + mirrored.0 + between.0, mirrored.1 + mirrored.1 + between.1);
        let slopes = &spread.slopes;
        let [at_point, beyond, inside] = energies;
        let others = beyond + inside * S::Real::splat(spread.axes.in_the_middle());
        self.sum.normal += slopes.middle.times(in_middle.1 - in_middle.0);
        self.sum.normal += slopes.deepest.times(-at_point);
        self.sum.normal += slopes.others.times(-others);
        let mut resultant = S::Vector::default();
        for (touch, (total, damped)) in [(&deepest, at_deepest), (&spread.middle, in_middle)] {
            let normal = touch.gap.normal;
            let lever = S::moment(touch.companion() - self.frame.contactor, normal);
            self.sum.normal += Wrench { force: normal * total, moment: lever * total };
            self.sum.damped += Wrench { force: normal * damped, moment: lever * damped };
            resultant += normal * total;
        }
        let normal_force = resultant.dot(resultant).sqrt();
        let presses = zero.lt(normal_force);
        let safe = S::Real::select(presses, normal_force, one);
        let normal = resultant * (one / safe);
        // Normal force is zero where the damper cancels the spring.
        let normal = normal + deepest.gap.normal * S::Real::select(presses, zero, one);
        let lean = S::Real::select(presses, at_deepest.0 / safe, one).clamp_magnitude(one);
        let (from, to) = (spread.middle.companion(), deepest.companion());
        let pressure = Pressure {
            touching,
            center: from + (to - from) * lean,
            normal,
            normal_force,
            stiffness,
            depth,
            rate,
        };
        // In a point contact only the first tangential spring remains.
        let aside = (one - lean * lean) * shares.aside;
        self.stick(first, &pressure, S::Vector::default(), one - aside);
        let axes = spread.axes.all();
        let part = aside * S::Real::splat(0.5 / axes.len() as f64);
        for (index, axis) in axes.iter().enumerate() {
            let aside = *axis * spread.radius;
            self.stick(first + 1 + 2 * index, &pressure, aside, part);
            self.stick(first + 2 + 2 * index, &pressure, -aside, part);
        }
        self.resist_rolling(normal_force);
    }

    /// Adds the forces of points that act like parallel springs. Their tangential springs are those of the contact
    /// elements from the index `first` on.
    ///
    /// Friction acts at two points on each of the [`Points::axes`], one on either side of the center of pressure. Their
    /// distance from the center is the root-mean-square distance of the bearing points from it. So friction transfers
    /// the same moment as it would at the bearing points, and the tangential springs persist when other points come
    /// into contact.
    #[inline(always)]
    pub(super) fn points(&mut self, first: usize, points: &Points<S>) {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let meeting = self.meeting;
        let (mut resultant, mut deepest) = (S::Vector::default(), (zero, zero));
        // Sums of the forces, and of their first and second moments.
        let origin = self.frame.contactor;
        let (mut whole, mut moment, mut square) = (zero, S::Vector::default(), zero);
        let mut stiffness = zero;
        let mut touching = <S::Real as Real>::Mask::default();
        for Bearing { touch, share, turning } in points.points {
            let Touch { node, gap } = touch;
            self.look_ahead(node, gap);
            self.look_at_speed(node, gap);
            let presses = gap.distance.lt(zero) & zero.lt(share);
            if !presses.any() {
                continue;
            }
            let place = touch.companion();
            let depth = S::Real::select(presses, -gap.distance, zero);
            let rate = -meeting.velocity(place).dot(gap.normal);
            let normal = self.law(depth, rate);
            let each = S::Real::select(presses, self.elements.weights[first], zero);
            let weight = each * share;
            let total = normal.total * weight;
            let damped = total - normal.elastic * weight;
            self.totals.elastic += normal.energy * weight;
            let lever = S::moment(place - self.frame.contactor, gap.normal);
            self.sum.normal += Wrench { force: gap.normal * total, moment: lever * total };
            self.sum.damped += Wrench { force: gap.normal * damped, moment: lever * damped };
            let turned = turning * -(normal.energy * each);
            self.sum.normal += Wrench { force: S::Vector::default(), moment: turned };
            let apart = place - origin;
            resultant += gap.normal * total;
            whole += total;
            moment += apart * total;
            square += apart.dot(apart) * total;
            stiffness += depth * weight;
            let deeper = deepest.0.lt(depth);
            deepest.0 = S::Real::select(deeper, depth, deepest.0);
            deepest.1 = S::Real::select(deeper, rate, deepest.1);
            touching = touching | presses;
        }
        if !touching.any() {
            return;
        }
        let normal_force = resultant.dot(resultant).sqrt();
        let presses = zero.lt(normal_force);
        let normal = resultant * (one / S::Real::select(presses, normal_force, one));
        let safe = S::Real::select(zero.lt(whole), whole, one);
        let lean = moment * (one / safe);
        let radius = (square / safe - lean.dot(lean)).max(zero).sqrt();
        let (depth, rate) = deepest;
        let pressure = Pressure {
            touching: touching & presses,
            center: origin + lean,
            normal,
            normal_force,
            stiffness: stiffness / S::Real::select(zero.lt(depth), depth, one),
            depth,
            rate,
        };
        let part = S::Real::splat(0.5 / points.axes.len() as f64);
        for (index, axis) in points.axes.iter().enumerate() {
            let aside = *axis * radius;
            self.stick(first + 2 * index, &pressure, aside, part);
            self.stick(first + 1 + 2 * index, &pressure, -aside, part);
        }
        self.resist_rolling(normal_force);
    }

    /// Returns the normal force of one spring, including its stop if it has one.
    #[inline(always)]
    pub(super) fn law(&self, depth: S::Real, rate: S::Real) -> NormalForce<S::Real> {
        let normal = (self.laws)().normal.force_of_step(depth, rate, self.step);
        match self.stop {
            Some(stop) => stop.add(normal, depth, rate, self.step),
            None => normal,
        }
    }

    /// Adds a share of the friction of a patch, at the offset `aside` (m) from the center of pressure.
    #[inline(always)]
    fn stick(&mut self, element: usize, at: &Pressure<S>, aside: S::Vector, share: S::Real) {
        let meeting = self.meeting;
        let point = at.center + aside;
        let counted = S::Real::select(at.touching, S::Real::splat(1.0), S::Real::zero());
        let slip_rate = S::tangential(meeting.velocity(point), at.normal) * counted;
        let (normal_force, weight) = (at.normal_force * share, at.stiffness * share);
        let load = (normal_force, weight);
        let (friction_force, tangent_plane) =
            self.friction(element, at.touching, at.normal, slip_rate, load);
        let force = -S::along(friction_force, at.normal);
        let moment = S::moment(point - self.frame.contactor, force);
        self.sum.friction += Wrench { force, moment };
        let node = self.elements.nodes[element];
        self.pressed.push(Pressed {
            element,
            pair: self.pair,
            node,
            touching: at.touching,
            point,
            tangent_plane,
            normal_force,
            weight,
        });
        if let Some(contacts) = &mut self.contacts {
            contacts.push(Contact {
                element,
                pair: self.pair,
                node,
                touching: at.touching,
                point,
                normal: at.normal,
                penetration: S::Real::select(at.touching, at.depth, S::Real::zero()),
                penetration_rate: at.rate,
                normal_force,
                slip_rate,
                friction_force,
            });
        }
    }
}

impl<S: Space> Spread<S> {
    /// Returns the lanes in which the patch touches with more than its deepest point; `deepest` is the gap (m) at the
    /// deepest point.
    #[inline(always)]
    fn bears(&self, deepest: S::Real) -> <S::Real as Real>::Mask {
        let (zero, middle) = (S::Real::zero(), self.middle.gap.distance);
        let bears = match self.axes.in_the_middle() {
            0.0 => (middle + middle).lt(deepest),
            _ => middle.lt(zero),
        };
        bears & zero.lt(self.shares.others)
    }
}

/// Resultant of the pressure in a patch.
struct Pressure<S: Space> {
    touching: <S::Real as Real>::Mask,
    /// The center of pressure (m).
    center: S::Vector,
    normal: S::Vector,
    normal_force: S::Real,
    /// Factor by which the constants of the tangential springs are multiplied.
    stiffness: S::Real,
    depth: S::Real,
    rate: S::Real,
}
