//! Joins three-dimensional runs into one run, in which bodies of different runs may touch each other.
//!
//! Each run is a party with a model of its own. A joined model has the bodies, laws and elements of all parties, and
//! contact pairs between bodies of different parties. The pairs within a party are summed in the same order as in its
//! own model, and before all pairs between parties, so a party whose bodies touch no other party moves exactly as it
//! would alone.

use std::ops::Range;
use std::sync::Arc;

use crate::body::{Body, BodyId, Nodes};
use crate::contact_elements::{ContactElements, Moved};
use crate::energy::EnergyLedger;
use crate::forces::{Losses, Scratch, evaluate};
use crate::integrate::{Drive, place_prescribed};
use crate::model::{ContactPair, InterfaceId, Model, ModelError, Substepping};
use crate::pairs::{Foreign, Pairs};
use crate::shape::{Surface as _, Whole as _};
use crate::simulate::{Simulation, Stepper};
use crate::space::{Pose, Quaternion, Rotation3, Space as _, Spatial, Twist, Vec3, Wrench};
use crate::state::State;

/// Placement on level ground: a position (m) and an angle (rad), counterclockwise about the vertical.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Position (m) of the origin.
    pub at: Vec3,
    /// Angle (rad) from the outer `x` axis to the `x` axis of the frame.
    pub azimuth: f64,
}

impl Frame {
    /// Returns the placement of this frame relative to `outer`; both must be placements in the same frame.
    #[must_use]
    pub fn within(self, outer: Self) -> Self {
        let back = Self { at: Vec3::default(), azimuth: -outer.azimuth };
        Self { at: back.vector(self.at - outer.at), azimuth: self.azimuth - outer.azimuth }
    }

    /// Returns the inverse placement.
    #[must_use]
    pub fn back(self) -> Self {
        Self::default().within(self)
    }

    fn turn(self) -> Quaternion {
        Quaternion::turn(Vec3::new(0.0, 0.0, self.azimuth))
    }

    /// Transforms a direction from this frame to the outer frame.
    pub fn vector(self, vector: Vec3) -> Vec3 {
        self.turn().matrix().apply(vector)
    }

    /// Transforms a pose from this frame to the outer frame.
    pub fn pose(self, pose: Pose<Spatial>) -> Pose<Spatial> {
        Pose {
            position: self.vector(pose.position) + self.at,
            orientation: self.turn().after(pose.orientation),
        }
    }

    /// Transforms a twist from this frame to the outer frame.
    pub fn twist(self, twist: Twist<Spatial>) -> Twist<Spatial> {
        Twist { linear: self.vector(twist.linear), angular: self.vector(twist.angular) }
    }

    fn wrench(self, wrench: Wrench<Spatial>) -> Wrench<Spatial> {
        Wrench { force: self.vector(wrench.force), moment: self.vector(wrench.moment) }
    }
}

/// Contact kind of a body: how many of its node sets and how many of its surfaces may touch bodies of other parties.
/// These node sets and surfaces come first in the lists of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ContactKind {
    /// Number of node sets.
    pub nodes: usize,
    /// Number of surfaces.
    pub surfaces: usize,
}

/// Rule for contact between bodies of two contact kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rule {
    /// `true` if the body of the second contact kind is the contactor.
    pub reversed: bool,
    /// Index of the contact law in the model of the first body's party, and in the model of the second body's party.
    /// Only one index is used: that of the party that supplies the contact law ([`Party::rank`]).
    pub laws: [InterfaceId; 2],
}

/// Rules for contacts between bodies of different parties, by the contact kinds of the bodies.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Crossing {
    /// The contact kinds.
    pub kinds: Vec<ContactKind>,
    /// Rule for each combination of two contact kinds, indexed first by the contact kind of the body that comes first
    /// in the joined model; `None` if bodies of these kinds never touch.
    pub rules: Vec<Vec<Option<Rule>>>,
}

/// A party of a joined model: one of the runs that are joined.
#[derive(Clone, Copy, Debug)]
pub struct Party<'a> {
    /// Prefix of the names of the party's bodies in the joined model, without the slash that follows it.
    pub name: &'a str,
    /// Model of the party before it is joined.
    pub model: &'a Model<Spatial>,
    /// For every body, the index of its contact kind in [`Crossing::kinds`].
    pub kinds: &'a [usize],
    /// Rank of the party: where bodies of two parties touch, the party with the lower rank supplies the contact law.
    pub rank: usize,
    /// Placement in the joined model.
    pub frame: Frame,
    /// Time step (s) of the party.
    pub step: f64,
}

/// Joins the models of several parties. Returns the model and its time step (s), the shortest step of all parties.
///
/// # Errors
/// If two bodies have the same name.
///
/// # Panics
/// If the `kinds` of a party do not have exactly one entry for each of its bodies, or if there is no party.
pub fn joined(
    parties: &[Party<'_>],
    crossing: &Arc<Crossing>,
) -> Result<(Model<Spatial>, f64), ModelError> {
    let (mut bodies, mut interfaces) = (Vec::new(), Vec::new());
    let (mut pairs, mut elements) = (Vec::new(), Vec::new());
    let mut depths = Vec::new();
    let mut foreign = Foreign {
        bodies: Vec::new(),
        parties: Vec::new(),
        crossing: Arc::clone(crossing),
        most: crossing.kinds.iter().map(|kind| kind.nodes).max().unwrap_or(0)
            * crossing.kinds.iter().map(|kind| kind.surfaces).max().unwrap_or(0),
    };
    for (number, party) in parties.iter().enumerate() {
        let Party { name, model, kinds, rank, frame, .. } = *party;
        assert_eq!(kinds.len(), model.bodies.len(), "one kind for each body");
        let (first, law) = (bodies.len(), interfaces.len());
        bodies.extend(model.bodies.iter().map(|body| Body {
            name: format!("{name}/{}", body.name),
            pose: frame.pose(body.pose),
            twist: frame.twist(body.twist),
            ..body.clone()
        }));
        interfaces.extend(model.interfaces.iter().cloned());
        pairs.extend(model.pairs().map(|pair| ContactPair {
            contactor: pair.contactor + first,
            target: pair.target + first,
            interface: pair.interface + law,
            ..pair
        }));
        elements.extend(model.elements.iter().cloned().map(|mut element| {
            for body in &mut element.link_mut().bodies {
                *body += first;
            }
            element
        }));
        depths.extend(&model.substepping.whole_step_depth);
        foreign.bodies.extend(kinds.iter().map(|kind| (number, *kind)));
        foreign.parties.push((rank, law));
    }
    let Pairs::Listed { pairs, couples } = Pairs::listed(pairs) else { unreachable!("listed") };
    let pairs = Pairs::Joined { pairs, couples, foreign };
    let mut model = Model::of_pairs(bodies, interfaces, pairs, parties[0].model.gravity)?;
    model.fasten(elements)?;
    let all = || parties.iter().map(|party| &party.model.substepping);
    let step = parties.iter().map(|party| party.step).fold(f64::INFINITY, f64::min);
    let shortest = parties.iter().map(|party| party.step / party.model.substepping.substeps);
    let shortest = shortest.fold(f64::INFINITY, f64::min);
    model.set_substepping(Substepping {
        substeps: (step / shortest * (1.0 - 1e-9)).ceil().max(1.0),
        whole_step_depth: depths,
        resting_allowance: all().map(|own| own.resting_allowance).fold(f64::INFINITY, f64::min),
        foreseen_gap: all().map(|own| own.foreseen_gap).fold(0.0, f64::max),
        fast: all().find_map(|own| own.fast),
    });
    Ok((model, step))
}

/// A run whose bodies are carried over into another model, between two steps.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The model.
    pub model: &'a Model<Spatial>,
    /// The state.
    pub state: &'a State<Spatial>,
    /// The forces of the state.
    pub scratch: &'a Scratch<Spatial>,
    /// Time stepping and energy balance of the run.
    pub stepper: &'a Stepper<Spatial>,
    /// Placement of the frame of this run in the frame of the new model.
    pub frame: Frame,
}

/// Bodies and force elements of one source that [`carry`] copies into the new model.
#[derive(Clone, Debug)]
pub struct Carry {
    /// Index of the source in the list of sources.
    pub source: usize,
    /// IDs of the bodies in the source.
    pub bodies: Range<BodyId>,
    /// ID of the first of these bodies in the new model.
    pub to: BodyId,
    /// Indices of the force elements in the source; the elements keep their order.
    pub elements: Range<usize>,
}

/// A run between two steps, as returned by [`carry`].
#[derive(Clone, Debug)]
pub struct Running {
    /// The state.
    pub state: State<Spatial>,
    /// The forces of the state.
    pub scratch: Scratch<Spatial>,
    /// Time stepping and energy balance of the run.
    pub stepper: Stepper<Spatial>,
}

/// Continues several runs as one run of a new model. All runs must be at the same time.
///
/// Motion, forces, contact history and the state of elements are copied from the sources. At times above zero, the
/// copied forces are kept, so the next step of every body is the same as in its source. At time zero, the forces are
/// evaluated anew, since bodies of two sources may be pressed together from the start.
///
/// Bodies of the new model that no source contains must be prescribed. No external force may act in a source.
///
/// # Panics
/// If there is no source.
pub fn carry(
    model: &Model<Spatial>,
    drive: &impl Drive<Spatial>,
    sources: &[Source<'_>],
    carries: &[Carry],
    simulation: &Simulation,
) -> Running {
    let mut state = State::initial(model);
    let mut scratch = Scratch::new(model);
    state.time = sources[0].state.time;
    (state.memory, scratch.loads) = (Vec::new(), Vec::new());
    let damped = model.is_damped();
    for Carry { source, bodies, to, elements } in carries {
        let Source { state: old, scratch: before, frame, .. } = sources[*source];
        for (at, body) in bodies.clone().enumerate() {
            let new = to + at;
            state.poses[new] = frame.pose(old.poses[body]);
            state.twists[new] = frame.twist(old.twists[body]);
            scratch.accelerations[new] = frame.twist(before.accelerations[body]);
            scratch.wrenches[new] = frame.wrench(before.wrenches[body]);
            let Losses { damped: lost, friction } = before.losses[body];
            scratch.losses[new] =
                Losses { damped: frame.wrench(lost), friction: frame.wrench(friction) };
            if let (true, Some(viscous)) = (damped, before.viscous.get(body)) {
                scratch.viscous[new] = frame.wrench(*viscous);
            }
        }
        state.memory.extend_from_slice(&old.memory[elements.clone()]);
        scratch.loads.extend_from_slice(&before.loads[elements.clone()]);
    }
    place_prescribed(model, drive, &mut state);
    for (rotation, pose) in scratch.rotations.iter_mut().zip(&state.poses) {
        *rotation = pose.orientation.matrix();
    }
    let (mut moved, mut whole) = (Vec::new(), true);
    for (number, source) in sources.iter().enumerate() {
        let mut places = vec![None; source.model.bodies.len()];
        for carry in carries.iter().filter(|carry| carry.source == number) {
            for (at, body) in carry.bodies.clone().enumerate() {
                places[body] = Some(carry.to + at);
            }
        }
        let number_of = |number: usize| {
            let pair = source.model.pair(number);
            let (contactor, target) = (places[pair.contactor]?, places[pair.target]?);
            model.pairs.number_of(&ContactPair { contactor, target, ..pair })
        };
        let turn = source.frame.turn().matrix();
        let rates = &source.scratch.slip_rates;
        moved.extend(source.state.contact_elements.moved(rates, turn, &number_of));
        whole &= places.iter().all(Option::is_some);
        scratch.totals.elastic += source.scratch.totals.elastic;
        scratch.totals.stick += source.scratch.totals.stick;
        scratch.needs_substeps |= source.scratch.needs_substeps;
        scratch.is_hard |= source.scratch.is_hard;
    }
    moved.sort_by_key(Moved::pair);
    let (elements, slip_rates) = ContactElements::of_moved(model, &moved, &state);
    (state.contact_elements, scratch.slip_rates) = (elements, slip_rates);
    scratch.keeps_contacts = false;
    if state.time <= 0.0 {
        // Bodies of two sources may be pressed together from the start; no source has the forces between them.
        let stepper = Stepper::start(model, drive, &mut state, &mut scratch, simulation);
        return Running { state, scratch, stepper };
    }
    if !whole {
        // The totals of a source include contacts that are not carried over, so the energy of the contacts is evaluated
        // anew.
        let mut anew = scratch.clone();
        evaluate(model, &state, &mut anew);
        scratch.totals = anew.totals;
    }
    let steppers: Vec<_> = sources.iter().map(|source| source.stepper).collect();
    let energy = EnergyLedger::new(model, &state, &scratch);
    let stepper = Stepper::after(&steppers, model, &state, &mut scratch, energy, simulation);
    Running { state, scratch, stepper }
}

/// Returns the gap (m) between the first `nodes` node sets of the contactor and the first `surfaces` surfaces of the
/// target. If the gap exceeds `enough` (m), the result may be a lower bound of the gap.
pub fn gap_between(
    (contactor, pose, nodes): (&Body<Spatial>, Pose<Spatial>, usize),
    (target, base, surfaces): (&Body<Spatial>, Pose<Spatial>, usize),
    enough: f64,
) -> f64 {
    let (turned, under) = (pose.orientation.matrix(), base.orientation.matrix());
    let mut least = f64::INFINITY;
    for placed in &target.surfaces[..surfaces] {
        let rotation: Rotation3 = under.after(placed.rotation);
        let origin = base.position + under.apply(placed.offset);
        let place = rotation.unapply(pose.position - origin);
        let relative = Spatial::relative(rotation, turned);
        let distance = |point: Vec3| placed.surface.gap(place + relative.apply(point)).distance;
        for nodes in &contactor.nodes[..nodes] {
            match nodes {
                Nodes::Whole(whole) => {
                    let (center, radius) = whole.ball();
                    let bound = distance(center) - radius;
                    if bound >= enough.min(least) {
                        least = least.min(bound);
                    } else {
                        whole.meet(&placed.surface, place, relative, true, |patch| {
                            least = least.min(patch.deepest.gap.distance);
                        });
                    }
                }
                Nodes::Rolling { center, radius, .. } => {
                    least = least.min(distance(*center) - radius);
                }
                Nodes::Fixed(all) => {
                    for node in all {
                        least = least.min(distance(node.position));
                    }
                }
                Nodes::Rounds(rounds) => {
                    for round in rounds {
                        least = least.min(distance(round.center) - round.radius);
                    }
                }
            }
        }
    }
    least
}
