//! Forces between bodies of a stack: at rest, and their peaks until the first loss of a seat and over the whole run.

use barrelstack_dynamics::forces::PairForce;
use barrelstack_dynamics::lanes::Lanewise;
use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Planar, Scratch, Space, Vec2, lanewise};

use crate::assemble::{Assembly, Part, PartKind};
use crate::demand::Span;

/// Two bodies of a stack in contact, and the force between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint<R: Real = f64> {
    /// The upper body; if neither body supports the other by design, the body that is named first.
    pub upper: BodyId,
    /// The lower body; if neither body supports the other by design, the body that is named second.
    pub lower: BodyId,
    /// `true` if one body supports the other by design; `false` if they touched during the shaking.
    pub by_design: bool,
    /// Force (N) on the upper body in the current step.
    pub force: Vec2<R>,
    /// Vertical force (N) on the upper body at rest.
    pub at_rest: R,
    /// Largest forces until the first loss of a seat.
    pub until_loss: PeakForces<R>,
    /// Largest forces over the whole run, including falls.
    pub whole_run: PeakForces<R>,
}

/// Largest forces between two bodies in any step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PeakForces<R: Real = f64> {
    /// Vertical force (N) of the largest magnitude on the upper body, with its sign, and its time (s).
    pub vertical: (R, R),
    /// Horizontal force (N) of the largest magnitude on the upper body, with its sign, and its time (s).
    pub horizontal: (R, R),
}

/// Observer of the forces between bodies in one run, or in one run per lane. It must observe every accepted step.
#[derive(Clone, Debug)]
pub struct Joints<R: Real = f64> {
    /// Every barrel on its rack and every rack on its supports, followed by other pairs of bodies in the order of their
    /// first contact.
    pub joints: Vec<Joint<R>>,
    /// For every body, the joints in which it is the upper body: the lower body and the index of each joint.
    of_upper: Vec<Vec<(BodyId, usize)>>,
    /// `true` to also observe bodies that touch although neither supports the other by design.
    follows_all: bool,
}

lanewise!(struct PeakForces<R> { vertical, horizontal });
lanewise!(struct Joint<R> { upper, lower, by_design, force, at_rest, until_loss, whole_run });

impl<R: Real> Lanewise for Joints<R> {
    type Single = Joints;

    fn in_all(single: &Joints) -> Self {
        let Joints { joints, of_upper, follows_all } = single.clone();
        Self { joints: Lanewise::in_all(&joints), of_upper, follows_all }
    }

    fn put(&mut self, lane: usize, single: &Joints) {
        for joint in &mut self.joints {
            let same = |one: &&Joint| [one.upper, one.lower] == [joint.upper, joint.lower];
            let none = || Joint::between(joint.upper, joint.lower, joint.by_design);
            let own = single.joints.iter().find(same).cloned().unwrap_or_else(none);
            joint.put(lane, &own);
        }
        for own in &single.joints {
            if self.number(own.upper, own.lower).is_none() {
                let at = self.add(own.upper, own.lower);
                self.joints[at].put(lane, own);
            }
        }
    }

    fn of_lane(&self, lane: usize) -> Joints {
        let Self { joints, of_upper, follows_all } = self;
        Joints {
            joints: joints.of_lane(lane),
            of_upper: of_upper.clone(),
            follows_all: *follows_all,
        }
    }
}

impl Joint {
    /// Returns the name of the joint, such as "R1 on ground", or "R1.1 against R1.2" if neither body supports the other
    /// by design.
    pub fn name(&self, assembly: &Assembly) -> String {
        self.named(|body| &assembly.parts[body].name)
    }

    /// Returns the name of the joint, from the names of the bodies.
    pub fn named<'a>(&self, name: impl Fn(BodyId) -> &'a str) -> String {
        title(self.upper, self.lower, self.by_design, name)
    }

    /// Returns the largest forces in a span of the run.
    pub fn peaks(&self, span: Span) -> PeakForces {
        match span {
            Span::UntilLoss => self.until_loss,
            Span::WholeRun => self.whole_run,
        }
    }

    /// Returns `true` if the two bodies have touched.
    pub fn has_met(&self) -> bool {
        let PeakForces { vertical, horizontal } = self.whole_run;
        vertical.0 != 0.0 || horizontal.0 != 0.0
    }
}

/// Contact force between two bodies in the current state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceBetween<S: Space> {
    /// The upper body; if neither body supports the other by design, the body that is named first.
    pub upper: BodyId,
    /// The lower body; if neither body supports the other by design, the body that is named second.
    pub lower: BodyId,
    /// `true` if one body supports the other by design.
    pub by_design: bool,
    /// Force (N) on the upper body.
    pub force: S::Vector,
}

impl<S: Space> ForceBetween<S> {
    /// Returns the forces between all bodies that touch, in the order of the bodies; pairs in which one body supports
    /// the other by design come first. `supports` returns the bodies that support a body by design ([`leans_on`]).
    pub fn all(pairs: &[PairForce<S>], supports: impl Fn(BodyId) -> Vec<BodyId>) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for pair in pairs {
            let (one, other) = (pair.contactor, pair.target);
            let on = |upper, lower| supports(upper).contains(&lower);
            let (upper, lower, by_design) = if on(one, other) {
                (one, other, true)
            } else if on(other, one) {
                (other, one, true)
            } else {
                let (first, second) = named_first(one, other);
                (first, second, false)
            };
            let force = if upper == one { pair.force } else { -pair.force };
            match all.iter_mut().find(|known| [known.upper, known.lower] == [upper, lower]) {
                Some(known) => known.force += force,
                None => all.push(Self { upper, lower, by_design, force }),
            }
        }
        all.sort_by_key(|one| (!one.by_design, one.upper, one.lower));
        all
    }

    /// Returns the name, such as "R1 on ground", from the names of the bodies.
    pub fn named<'a>(&self, name: impl Fn(BodyId) -> &'a str) -> String {
        title(self.upper, self.lower, self.by_design, name)
    }
}

/// Returns two bodies, neither of which supports the other by design, in the order in which results name them: the
/// ground comes last, and of two other bodies, the body with the lower index comes first.
fn named_first(one: BodyId, other: BodyId) -> (BodyId, BodyId) {
    let (first, second) = (one.min(other), one.max(other));
    if first == Assembly::GROUND { (second, first) } else { (first, second) }
}

fn title<'a>(
    upper: BodyId,
    lower: BodyId,
    by_design: bool,
    name: impl Fn(BodyId) -> &'a str,
) -> String {
    let between = if by_design { "on" } else { "against" };
    format!("{} {between} {}", name(upper), name(lower))
}

/// Returns the bodies that support a body by design, from its kind, carrier and supports.
pub fn leans_on(kind: PartKind, carrier: Option<BodyId>, supports: &[BodyId]) -> Vec<BodyId> {
    match kind {
        PartKind::Rack if supports.is_empty() => vec![carrier.unwrap_or(Assembly::GROUND)],
        PartKind::Rack => supports.to_vec(),
        PartKind::Barrel => carrier.into_iter().collect(),
        PartKind::Body => vec![Assembly::GROUND],
        PartKind::Ground | PartKind::Device | PartKind::Wine => Vec::new(),
    }
}

impl Joints {
    /// Creates the joints of a stack, without forces.
    pub(crate) fn new(assembly: &Assembly) -> Self {
        let below = |part: &Part| leans_on(part.kind, part.carrier, &part.supports);
        // A free scene may have too many bodies to list in pairs.
        Self::between(assembly.parts.iter().map(below), assembly.levels > 0)
    }

    /// Creates the joints of every body with each of its supports, without forces.
    ///
    /// If `follows_all` is `true`, other bodies that touch are also observed.
    pub fn between(below: impl Iterator<Item = Vec<BodyId>>, follows_all: bool) -> Self {
        let mut joints = Vec::new();
        let mut of_upper = Vec::new();
        for (upper, below) in below.enumerate() {
            of_upper.push(below.iter().copied().zip(joints.len()..).collect());
            joints.extend(below.into_iter().map(|lower| Joint::between(upper, lower, true)));
        }
        Self { joints, of_upper, follows_all }
    }

    /// Records the forces in the state at rest.
    pub(crate) fn start(&mut self, time: f64, scratch: &Scratch<Planar>) {
        self.observe(time, true, scratch);
        for joint in &mut self.joints {
            joint.at_rest = joint.force.z;
        }
    }

    /// Returns the joints in which one body supports the other by design, followed by the joints of other bodies that
    /// have touched. Both groups are in the order of the bodies.
    pub fn listed(&self) -> Vec<&Joint> {
        let mut listed: Vec<&Joint> =
            self.joints.iter().filter(|joint| joint.by_design || joint.has_met()).collect();
        listed.sort_by_key(|joint| (!joint.by_design, joint.upper, joint.lower));
        listed
    }
}

impl Joints {
    /// Returns the largest vertical force (N) between a barrel and any rack in a span of the run; `None` if the
    /// barrel has no joint with a rack.
    pub fn stave_load(
        &self,
        barrel: BodyId,
        kind: &impl Fn(BodyId) -> PartKind,
        span: Span,
    ) -> Option<f64> {
        let with_rack = |joint: &&Joint| match [joint.upper, joint.lower] {
            [one, other] if one == barrel => kind(other) == PartKind::Rack,
            [one, other] => other == barrel && kind(one) == PartKind::Rack,
        };
        let loads = self.joints.iter().filter(with_rack);
        loads.map(|joint| joint.peaks(span).vertical.0.abs()).reduce(f64::max)
    }
}

impl<R: Real> Joint<R> {
    /// Creates the joint of two bodies, without forces.
    fn between(upper: BodyId, lower: BodyId, by_design: bool) -> Self {
        Self {
            upper,
            lower,
            by_design,
            force: Vec2::default(),
            at_rest: R::zero(),
            until_loss: PeakForces::default(),
            whole_run: PeakForces::default(),
        }
    }

    /// Replaces each peak by the current force component and its time (s) in those lanes in which the component is
    /// larger in magnitude. The peaks until the first loss of a seat are replaced in `standing` lanes only.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub fn raise(&mut self, time: R, standing: R::Mask) {
        let Vec2 { x, z } = self.force;
        let Self { until_loss, whole_run, .. } = self;
        raise(&mut until_loss.vertical, &mut whole_run.vertical, (z, time), standing);
        raise(&mut until_loss.horizontal, &mut whole_run.horizontal, (x, time), standing);
    }
}

/// Replaces two peaks by a force (N) and its time (s) in those lanes in which the force is larger in magnitude.
/// `until_loss` is replaced in `standing` lanes only.
#[inline(always)]
#[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
fn raise<R: Real>(
    until_loss: &mut (R, R),
    whole_run: &mut (R, R),
    (force, time): (R, R),
    standing: R::Mask,
) {
    // In standing lanes, the two peaks are equal.
    let more = whole_run.0.abs().lt(force.abs());
    if more.any() {
        for (peak, raised) in [(whole_run, more), (until_loss, more & standing)] {
            *peak = (R::select(raised, force, peak.0), R::select(raised, time, peak.1));
        }
    }
}

impl<R: Real> Joints<R> {
    /// Returns the index of the joint of two bodies, and `true` if the first body is the upper one; `None` if the
    /// bodies have no joint.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn number(&self, one: BodyId, other: BodyId) -> Option<(usize, bool)> {
        let joint = |upper: BodyId, lower: BodyId| {
            self.of_upper[upper].iter().find(|(below, _)| *below == lower).map(|(_, at)| *at)
        };
        let upper = joint(one, other).map(|at| (at, true));
        upper.or_else(|| joint(other, one).map(|at| (at, false)))
    }

    /// Returns the index of the joint of two bodies that touch, and `true` if the first body is the upper one.
    ///
    /// If there is no such joint, adds it if all bodies that touch are observed, and returns `None` otherwise.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub fn meet(&mut self, one: BodyId, other: BodyId) -> Option<(usize, bool)> {
        let known = self.number(one, other);
        if known.is_some() || !self.follows_all {
            return known;
        }
        let (first, second) = named_first(one, other);
        Some((self.add(first, second), first == one))
    }

    /// Adds a joint of two bodies, neither of which supports the other by design.
    fn add(&mut self, upper: BodyId, lower: BodyId) -> usize {
        let at = self.joints.len();
        self.of_upper[upper].push((lower, at));
        self.joints.push(Joint::between(upper, lower, false));
        at
    }

    /// Records the forces of an accepted step at a time (s); `standing` are the lanes in which no seat had been lost
    /// before the step.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub(crate) fn observe(&mut self, time: R, standing: R::Mask, scratch: &Scratch<Planar<R>>) {
        for joint in &mut self.joints {
            joint.force = Vec2::default();
        }
        for pair in &scratch.pair_forces {
            if let Some((at, upper)) = self.meet(pair.contactor, pair.target) {
                self.joints[at].force += if upper { pair.force } else { -pair.force };
            }
        }
        for joint in &mut self.joints {
            joint.raise(time, standing);
        }
    }
}
