//! Forces between bodies that lean on each other by design: at rest, and at their largest.

use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Planar, Scratch, Vec2, lanewise};

use crate::assemble::{Assembly, Part, PartKind};

/// Two bodies of a stack that lean on each other, and the force between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint<R: Real = f64> {
    /// The upper body.
    pub upper: BodyId,
    /// The lower body.
    pub lower: BodyId,
    /// Force (N) on the upper body in the step at hand.
    pub force: Vec2<R>,
    /// Vertical force (N) on the upper body at rest.
    pub at_rest: R,
    /// Largest vertical force (N) on the upper body in any step, and when (s).
    pub peak_vertical: (R, R),
    /// Largest horizontal force (N) on the upper body in any step, with its sign, and when (s).
    pub peak_horizontal: (R, R),
}

/// Follows all of them through a run, or through as many runs as there are lanes; sees every step.
#[derive(Clone, Debug)]
pub struct Joints<R: Real = f64> {
    /// Every barrel on its rack, every rack on what is below it.
    pub joints: Vec<Joint<R>>,
    /// For every body those below it, each with the number of their joint.
    of_upper: Vec<Vec<(BodyId, usize)>>,
}

lanewise!(struct Joint<R> { upper, lower, force, at_rest, peak_vertical, peak_horizontal });
lanewise!(struct Joints<R> { joints, of_upper });

impl Joint {
    /// Its name, such as "R1 on ground".
    pub fn name(&self, assembly: &Assembly) -> String {
        format!("{} on {}", assembly.parts[self.upper].name, assembly.parts[self.lower].name)
    }
}

/// The bodies on which one of a kind leans by design: the ground, where nothing carries it.
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
    /// Those of a stack, before any force is known.
    pub(crate) fn new(assembly: &Assembly) -> Self {
        let below = |part: &Part| leans_on(part.kind, part.carrier, &part.supports);
        Self::between(assembly.parts.iter().map(below))
    }

    /// Those of every body with each of the ones on which it leans, before any force is known.
    pub fn between(below: impl Iterator<Item = Vec<BodyId>>) -> Self {
        let mut joints = Vec::new();
        let mut of_upper = Vec::new();
        for (upper, below) in below.enumerate() {
            of_upper.push(below.iter().copied().zip(joints.len()..).collect());
            joints.extend(below.into_iter().map(|lower| Joint {
                upper,
                lower,
                force: Vec2::default(),
                at_rest: 0.0,
                peak_vertical: (0.0, 0.0),
                peak_horizontal: (0.0, 0.0),
            }));
        }
        Self { joints, of_upper }
    }

    /// Looks at the state at rest.
    pub(crate) fn start(&mut self, time: f64, scratch: &Scratch<Planar>) {
        self.observe(time, scratch);
        for joint in &mut self.joints {
            joint.at_rest = joint.force.z;
        }
    }
}

impl<R: Real> Joint<R> {
    /// Raises the peaks to the force at hand, at a time (s).
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub fn raise(&mut self, time: R) {
        let Vec2 { x, z } = self.force;
        let (most, when) = self.peak_vertical;
        let more = most.lt(z);
        if more.any() {
            self.peak_vertical = (R::select(more, z, most), R::select(more, time, when));
        }
        let (most, when) = self.peak_horizontal;
        let more = most.abs().lt(x.abs());
        if more.any() {
            self.peak_horizontal = (R::select(more, x, most), R::select(more, time, when));
        }
    }
}

impl<R: Real> Joints<R> {
    /// The number of the joint of two bodies, and whether the first of them is the upper one.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub fn of(&self, one: BodyId, other: BodyId) -> Option<(usize, bool)> {
        let joint = |upper: BodyId, lower: BodyId| {
            self.of_upper[upper].iter().find(|(below, _)| *below == lower).map(|(_, at)| *at)
        };
        let upper = joint(one, other).map(|at| (at, true));
        upper.or_else(|| joint(other, one).map(|at| (at, false)))
    }

    /// Looks at the forces of an accepted step at a time (s).
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub(crate) fn observe(&mut self, time: R, scratch: &Scratch<Planar<R>>) {
        for joint in &mut self.joints {
            joint.force = Vec2::default();
        }
        for pair in &scratch.pair_forces {
            if let Some((at, upper)) = self.of(pair.contactor, pair.target) {
                self.joints[at].force += if upper { pair.force } else { -pair.force };
            }
        }
        for joint in &mut self.joints {
            joint.raise(time);
        }
    }
}
