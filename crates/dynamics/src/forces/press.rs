//! Contacts of one pair: from gaps to forces on both bodies.

mod meeting;
mod patch;
mod rounds;
mod row;

use crate::body::Nodes;
use crate::contact::{Basis, FrictionLaw, NormalLaw, Rolling, Stop};
use crate::contact_elements::{ContactElements, Group};
use crate::model::{ContactPair, Fast, Model};
use crate::pair_frame::{AtFace, PairFrame};
use crate::real::{Mask, Real};
use crate::shape::{Facing, Gap, Surface, Whole};
use crate::space::{Linear, Space, Wrench};
use crate::state::State;

use super::{Contact, ContactTotals, PairForce, Pressed, Scratch, asleep};

use meeting::Meeting;
pub(super) use meeting::PairKinematics;
use row::{Row, counting};

/// Adds the contacts of one pair: gap, normal law, friction law, and the sum of the forces on both bodies.
///
/// For several lanes in two dimensions, the speed-gap law with Coulomb friction has a loop of its own, without dispatch
/// per contact. For a single run such a loop would not be faster, and in three dimensions it would take long to
/// compile.
#[inline(always)]
pub(super) fn touch<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    group: usize,
    scratch: &mut Scratch<S>,
) {
    // A group that is awake in a single run is awake in its only lane.
    let all = !<S::Real as Real>::Mask::default();
    let near = if S::SOLIDS_SHARE && S::Real::LANES > 1 {
        !asleep(model, &state.contact_elements, group)
    } else {
        all
    };
    let group = &state.contact_elements.groups[group];
    let pair = model.pair(group.pair);
    scratch.contact_evaluations += (group.end - group.first) as u64;
    let interface = &model.interfaces[pair.interface];
    match (&interface.normal, &interface.friction) {
        (
            &NormalLaw::SpeedGap { stiffness, damping },
            &FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            },
        ) if S::Real::LANES > 1 && !S::SOLIDS_SHARE => {
            touch_by(
                &pair,
                #[inline(always)]
                || Laws {
                    normal: NormalLaw::SpeedGap { stiffness, damping },
                    friction: FrictionLaw::Coulomb {
                        static_coefficient,
                        kinetic_coefficient,
                        tangential_stiffness,
                        tangential_damping,
                    },
                },
                model,
                state,
                step,
                (group, near),
                scratch,
            );
        }
        // The laws are read where they are needed; a copy for every pair would take longer.
        _ => touch_by(
            &pair,
            #[inline(always)]
            || Laws { normal: interface.normal, friction: interface.friction },
            model,
            state,
            step,
            (group, near),
            scratch,
        ),
    }
}

/// The contact laws of a pair.
#[derive(Clone, Copy)]
struct Laws<R> {
    normal: NormalLaw<R>,
    friction: FrictionLaw<R>,
}

/// Adds the contacts of one pair, evaluated with the given contact laws.
#[inline(always)]
fn touch_by<S: Space>(
    pair: &ContactPair,
    laws: impl Fn() -> Laws<S::Real>,
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    (group, near): (&Group, <S::Real as Real>::Mask),
    scratch: &mut Scratch<S>,
) {
    let surface = &model.bounded(pair.target).surfaces[pair.surface].surface;
    let leads = leads(model, pair);
    let own;
    let kinematics = if S::SOLIDS_SHARE {
        PairKinematics::shared(&mut scratch.kinematics, model, pair, state, &scratch.rotations)
    } else {
        let frame = PairFrame::new(model, pair, &state.poses, &scratch.rotations);
        if let Nodes::Rounds(rounds) = model.pair_nodes(pair) {
            let nodes = &state.contact_elements.nodes[group.first..group.end];
            if rounds::belongs_to_others(leads, rounds, nodes, &frame, surface) {
                return;
            }
        }
        own = PairKinematics::new(frame, pair, state);
        &own
    };
    let frame = &kinematics.frame;
    let counted = frame.at_face(model, pair);
    if counted.is_some_and(|face| face.never()) {
        return;
    }
    let counted = counted.filter(|face| !face.always());
    let whole_step_depth = model.substepping.whole_step_depth[pair.interface];
    let meeting = Meeting::of(kinematics);
    let others = scratch.pressed.len();
    let basis = model.interfaces[pair.interface].basis;
    let mut press = Press {
        whole_step_depth: whole_step_depth
            .lt(S::Real::splat(f64::INFINITY))
            .any()
            .then_some(whole_step_depth),
        near,
        resting_allowance: model.substepping.resting_allowance,
        foreseen_gap: model.substepping.foreseen_gap,
        fast: model.substepping.fast,
        lookahead: scratch.lookahead,
        needs_substeps: scratch.needs_substeps,
        is_hard: scratch.is_hard,
        rolling: model.interfaces[pair.interface].rolling.map(
            #[inline(always)]
            |rolling| RollingPair::new(rolling, meeting.spin()),
        ),
        stop: model.interfaces[pair.interface].stop,
        counted,
        laws,
        step,
        frame,
        meeting,
        leads,
        pair: group.pair,
        elements: &state.contact_elements,
        sum: PairWrench::default(),
        totals: scratch.totals,
        slip_rates: &mut scratch.slip_rates,
        pressed: &mut scratch.pressed,
        contacts: scratch.keeps_contacts.then_some(&mut scratch.contacts),
    };
    press.nodes(model.pair_nodes(pair), group, surface, basis);
    let Press { meeting, sum, totals, needs_substeps, is_hard, pressed, .. } = press;
    let touches = pressed.len() > others;
    scratch.needs_substeps = needs_substeps;
    scratch.is_hard = is_hard;
    if !touches {
        return;
    }
    scratch.totals = totals;
    let damped = meeting.on_bodies(sum.damped);
    let friction = meeting.on_bodies(sum.friction);
    let (on_contactor, on_target) = meeting.on_bodies(sum.normal.plus(sum.friction));
    scratch.wrenches[pair.contactor] += on_contactor;
    scratch.wrenches[pair.target] += on_target;
    let lost = &mut scratch.losses[pair.contactor];
    lost.damped += damped.0;
    lost.friction += friction.0;
    let lost = &mut scratch.losses[pair.target];
    lost.damped += damped.1;
    lost.friction += friction.1;
    let (contactor, target) = (pair.contactor, pair.target);
    let force = on_contactor.force;
    scratch.pair_forces.push(PairForce { pair: group.pair, contactor, target, force });
}

/// Returns the lanes in which the contactor of a pair [leads](Press::leads).
#[inline(always)]
fn leads<S: Space>(model: &Model<S>, pair: &ContactPair) -> <S::Real as Real>::Mask {
    let (own, other) = (model.inert[pair.contactor].mass, model.inert[pair.target].mass);
    if pair.contactor < pair.target { other.le(own) } else { other.lt(own) }
}

/// Accumulator for the contact forces of one pair: nodes of the contactor against a surface of the target.
struct Press<'a, S: Space, L> {
    /// Copy of [`Substepping::whole_step_depth`](crate::model::Substepping::whole_step_depth) for the interface; `None`
    /// if it is infinite.
    whole_step_depth: Option<S::Real>,
    /// The lanes in which the bodies may touch in this step.
    near: <S::Real as Real>::Mask,
    /// Copy of [`Substepping::resting_allowance`](crate::model::Substepping::resting_allowance).
    resting_allowance: S::Real,
    /// Copy of [`Substepping::foreseen_gap`](crate::model::Substepping::foreseen_gap).
    foreseen_gap: S::Real,
    /// Copy of [`Substepping::fast`](crate::model::Substepping::fast).
    fast: Option<Fast<S::Real>>,
    /// Copy of [`Scratch::lookahead`].
    lookahead: S::Real,
    /// Accumulates [`Scratch::needs_substeps`].
    needs_substeps: <S::Real as Real>::Mask,
    /// Accumulates [`Scratch::is_hard`].
    is_hard: <S::Real as Real>::Mask,
    /// Rolling resistance of the pair, if any.
    rolling: Option<RollingPair<S::Real>>,
    stop: Option<Stop<S::Real>>,
    /// Contact filter of the pair; `None` if all contacts count.
    counted: Option<AtFace<S>>,
    /// Function that returns the contact laws of the pair. It is called once per contact, so that the compiler can
    /// specialize the loop for laws that are known at compile time.
    laws: L,
    /// Time step (s) for the effective forces; see
    /// [`NormalForce::within_step`](crate::contact::NormalForce::within_step).
    step: S::Real,
    frame: &'a PairFrame<S>,
    /// Relative kinematics of the pair, computed before the first node; computing them on demand would need a test at
    /// every node.
    meeting: Meeting<'a, S>,
    /// Lanes in which this pair, and not the pair with exchanged bodies, counts a contact of two round pieces. In these
    /// lanes the contactor is the heavier body or, if both are equally heavy, the first body.
    leads: <S::Real as Real>::Mask,
    pair: usize,
    elements: &'a ContactElements<S>,
    sum: PairWrench<S>,
    totals: ContactTotals<S::Real>,
    slip_rates: &'a mut [S::Tangent],
    pressed: &'a mut Vec<Pressed<S>>,
    contacts: Option<&'a mut Vec<Contact<S>>>,
}

/// A contact counts as at rest if its depth changes by less than this share of
/// [`Substepping::resting_allowance`](crate::model::Substepping::resting_allowance) within [`Scratch::lookahead`].
const RESTING_SHARE: f64 = 0.01;

impl<S: Space, L: Fn() -> Laws<S::Real>> Press<'_, S, L> {
    /// Adds the contacts of a node set with a surface.
    #[inline(always)]
    fn nodes(&mut self, nodes: &Nodes<S>, group: &Group, surface: &S::Surface, basis: Basis) {
        let one = S::Real::splat(1.0);
        match nodes {
            Nodes::Fixed(all) => {
                let (elements, frame) = (self.elements, self.frame);
                let places = &elements.positions[group.first..group.end];
                let mut row = Row::default();
                if basis == Basis::Seat {
                    let counted = self.counted;
                    surface.penetrated_by(
                        places.len(),
                        #[inline(always)]
                        |index| frame.to_surface(places[index]),
                        #[inline(always)]
                        |index| {
                            let node = &all[elements.nodes[group.first + index] as usize];
                            node.outward.map(
                                #[inline(always)]
                                |outward| Facing::outward(frame.direction_to_surface(outward)),
                            )
                        },
                        #[inline(always)]
                        |_, _, gap| row.add(counting(counted, gap)),
                    );
                }
                surface.penetrated_by(
                    places.len(),
                    #[inline(always)]
                    |index| frame.to_surface(places[index]),
                    #[inline(always)]
                    |index| {
                        let node = &all[elements.nodes[group.first + index] as usize];
                        node.outward.map(
                            #[inline(always)]
                            |outward| Facing::outward(frame.direction_to_surface(outward)),
                        )
                    },
                    #[inline(always)]
                    |index, node, gap| {
                        self.look_ahead(node, gap);
                        if basis == Basis::Seat {
                            self.of_row(group.first + index, node, gap, &row);
                        } else {
                            self.node(group.first + index, node, gap, one);
                        }
                    },
                );
            }
            Nodes::Rounds(rounds) => self.rounds(rounds, group, surface),
            Nodes::Rolling { center, radius, .. } => {
                let center = self.frame.to_surface(*center);
                let mut gap = surface.gap(center);
                gap.distance -= *radius;
                self.look_ahead(center - gap.normal * *radius, gap);
                if gap.distance.lt(S::Real::zero()).any() {
                    let node = midway(center, gap, *radius);
                    self.node(group.first, node, gap, one);
                }
            }
            Nodes::Whole(whole) => {
                let frame = self.frame;
                if let Some(points) =
                    whole.points(surface, frame.contactor, frame.relative, self.near)
                {
                    self.points(group.first, &points);
                } else {
                    whole.meet(
                        surface,
                        frame.contactor,
                        frame.relative,
                        self.near,
                        #[inline(always)]
                        |patch| {
                            if S::Real::LANES == 1 {
                                return self.patch(group.first + patch.first, &patch);
                            }
                            // Compiled once for all kinds of pairs.
                            S::Real::scope(
                                #[inline(always)]
                                || self.patch(group.first + patch.first, &patch),
                            );
                        },
                    );
                }
            }
        }
    }

    /// Requests substeps in lanes where the penetration of a node at `node` (m) is predicted to exceed the penetration
    /// above which a time step is divided.
    #[inline(always)]
    fn look_ahead(&mut self, node: S::Vector, gap: Gap<S>) {
        let Some(whole_step_depth) = self.whole_step_depth else { return };
        let mut near = gap.distance.lt(self.foreseen_gap - whole_step_depth);
        if !near.any() {
            return;
        }
        if let Some(face) = self.counted {
            near = near & face.counts(gap.normal);
        }
        let approach = -self.meeting.velocity(node).dot(gap.normal);
        let ahead = self.lookahead * approach.max(S::Real::zero());
        let change = self.lookahead * approach.abs();
        let rests = change.lt(self.resting_allowance * S::Real::splat(RESTING_SHARE));
        let allowance = S::Real::select(rests, self.resting_allowance, S::Real::zero());
        let deep = (whole_step_depth + allowance).lt(ahead - gap.distance);
        self.needs_substeps = self.needs_substeps | (near & deep);
    }

    /// Adds the moment of the rolling resistance that is due to a normal force (N).
    #[inline(always)]
    fn resist_rolling(&mut self, normal_force: S::Real) {
        let Some(rolling) = &self.rolling else { return };
        let resisted = normal_force * rolling.lever / rolling.scale;
        let moment = -(self.meeting.spin() * resisted);
        self.sum.friction += Wrench { force: S::Vector::default(), moment };
    }

    /// Adds the forces of a node at `node` (m, in the frame of the target's surface), which penetrates in at least one
    /// lane.
    ///
    /// The forces and the stored energy are multiplied by `share`. Returns the energy (J) without this factor.
    #[inline(always)]
    fn node(&mut self, element: usize, node: S::Vector, gap: Gap<S>, share: S::Real) -> S::Real {
        let gap = counting(self.counted, gap);
        if S::SOLIDS_SHARE && S::Real::LANES > 1 {
            // Compiled once for all callers.
            return S::Real::scope(
                #[inline(always)]
                || self.press(element, node, gap, share, None),
            );
        }
        self.press(element, node, gap, share, None)
    }

    /// Adds the forces of a node at `node` (m) whose contact the filter accepts.
    ///
    /// The contact laws are evaluated at the depth `shared` (m) of the row of nodes, if given, and otherwise at the
    /// depth of the node itself.
    #[inline(always)]
    fn press(
        &mut self,
        element: usize,
        node: S::Vector,
        gap: Gap<S>,
        share: S::Real,
        shared: Option<S::Real>,
    ) -> S::Real {
        let meeting = self.meeting;
        let contact = meeting.contact(self.pair, self.elements, element, node, gap);
        let touching = contact.touching;
        let whole = self.elements.weights[element] * share;
        let weight = S::Real::select(touching, whole, S::Real::zero());
        let rate = contact.penetration_rate;
        let normal = self.law(shared.unwrap_or(contact.penetration), rate);
        let normal_force = normal.total * weight;
        let (slip_rate, load) = (contact.slip_rate, (normal_force, weight));
        let (friction_force, tangent_plane) =
            self.friction(element, touching, contact.normal, slip_rate, load);
        self.totals.elastic += normal.energy * weight;

        let damped = normal_force - normal.elastic * weight;
        let arm = contact.point - self.frame.contactor;
        let lever = S::moment(arm, contact.normal);
        let sum = &mut self.sum;
        sum.normal += Wrench { force: contact.normal * normal_force, moment: lever * normal_force };
        sum.damped += Wrench { force: contact.normal * damped, moment: lever * damped };
        let sliding = -S::along(friction_force, contact.normal);
        sum.friction += Wrench { force: sliding, moment: S::moment(arm, sliding) };
        self.resist_rolling(normal_force);

        self.pressed.push(Pressed {
            element,
            pair: self.pair,
            node: contact.node,
            touching,
            point: contact.point,
            tangent_plane,
            normal_force,
            weight: whole,
        });
        if let Some(contacts) = &mut self.contacts {
            contacts.push(Contact { normal_force, friction_force, ..contact });
        }
        S::Real::select(touching, normal.energy * self.elements.weights[element], S::Real::zero())
    }
}

impl<S: Space, L: Fn() -> Laws<S::Real>> Press<'_, S, L> {
    /// Returns the friction force (N) and the tangent plane of an element, given its normal force (N) and weight. Also
    /// stores the energy and the rate of its tangential spring.
    ///
    /// The displacement of the spring is stored in the inertial frame, so both bodies are treated alike.
    #[inline(always)]
    fn friction(
        &mut self,
        element: usize,
        touching: <S::Real as Real>::Mask,
        normal: S::Vector,
        slip_rate: S::Tangent,
        (normal_force, weight): (S::Real, S::Real),
    ) -> (S::Tangent, S::TangentPlane) {
        let rotation = self.frame.rotation;
        let tangent_plane = S::tangent_plane(rotation, normal);
        let stick = self.elements.sticks[element].carried(tangent_plane);
        let slip = S::rotate_tangent(rotation, slip_rate);
        let friction = (self.laws)().friction.force::<S>(stick, slip, normal_force, weight);
        self.totals.stick += friction.energy;
        let turn = S::stick_turn(stick.displacement, tangent_plane, rotation, self.meeting.spins());
        self.slip_rates[element] = S::add_turn(touching, slip, turn);
        (S::unrotate_tangent(rotation, friction.force), tangent_plane)
    }
}

/// Returns a node position (m) for a round piece about `center`, such that the companion point of the node lies midway
/// between the two boundaries. The force acts at the companion point, so it does not change if the bodies are
/// exchanged.
#[inline(always)]
fn midway<S: Space>(center: S::Vector, gap: Gap<S>, radius: S::Real) -> S::Vector {
    center - gap.normal * (radius - gap.distance * S::Real::splat(0.5))
}

/// Rolling resistance of the contacts of a pair.
struct RollingPair<R> {
    /// Copy of [`Rolling::lever`].
    lever: R,
    /// Divisor of the spin in the rolling resistance (rad/s): `√(ω² + ω₀²)`, where ω is the relative spin and ω₀ is the
    /// constant [`Rolling::spin`].
    scale: R,
}

impl<R: Real> RollingPair<R> {
    /// Creates the rolling resistance at a relative spin. Called only for pairs with rolling resistance, since it
    /// computes a square root.
    #[inline(always)]
    fn new(rolling: Rolling<R>, spin: impl Linear<R>) -> Self {
        let scale = (spin.dot(spin) + rolling.spin * rolling.spin).sqrt();
        Self { lever: rolling.lever, scale }
    }
}

/// Sums of contact forces on the contactor of a pair, in the frame of the target's surface, with their moments about
/// the contactor's center of mass.
#[derive(Clone, Copy)]
struct PairWrench<S: Space> {
    normal: Wrench<S>,
    /// The part of the normal forces that is due to dampers.
    damped: Wrench<S>,
    friction: Wrench<S>,
}

impl<S: Space> Default for PairWrench<S> {
    #[inline(always)]
    fn default() -> Self {
        let none = Wrench::default();
        Self { normal: none, damped: none, friction: none }
    }
}
