//! Forces between bodies that lean on each other by design: at rest, and at their largest.

use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{BodyId, Planar, Scratch, Vec2, lanewise};

use crate::assemble::{Assembly, PartKind};

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
    pub(crate) fn name(&self, assembly: &Assembly) -> String {
        format!("{} on {}", assembly.parts[self.upper].name, assembly.parts[self.lower].name)
    }
}

impl Joints {
    /// Those of a stack, before any force is known.
    pub(crate) fn new(assembly: &Assembly) -> Self {
        let mut joints = Vec::new();
        let mut join = |upper: BodyId, lower: BodyId| {
            joints.push(Joint {
                upper,
                lower,
                force: Vec2::default(),
                at_rest: 0.0,
                peak_vertical: (0.0, 0.0),
                peak_horizontal: (0.0, 0.0),
            });
        };
        for (i, part) in assembly.parts.iter().enumerate() {
            match part.kind {
                PartKind::Rack if part.supports.is_empty() => {
                    join(i, part.carrier.unwrap_or(Assembly::GROUND));
                }
                PartKind::Rack => part.supports.iter().for_each(|support| join(i, *support)),
                PartKind::Barrel => part.carrier.iter().for_each(|rack| join(i, *rack)),
                PartKind::Body => join(i, Assembly::GROUND),
                PartKind::Ground | PartKind::Device | PartKind::Wine => {}
            }
        }
        let mut of_upper = vec![Vec::new(); assembly.parts.len()];
        for (at, joint) in joints.iter().enumerate() {
            of_upper[joint.upper].push((joint.lower, at));
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

impl<R: Real> Joints<R> {
    /// Looks at the forces of an accepted step at a time (s).
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "bundles of lanes are fast only in their scope")]
    pub(crate) fn observe(&mut self, time: R, scratch: &Scratch<Planar<R>>) {
        for joint in &mut self.joints {
            joint.force = Vec2::default();
        }
        for pair in &scratch.pair_forces {
            let joint = |upper: BodyId, lower: BodyId| {
                self.of_upper[upper].iter().find(|(below, _)| *below == lower).map(|(_, at)| *at)
            };
            if let Some(at) = joint(pair.contactor, pair.target) {
                self.joints[at].force += pair.force;
            } else if let Some(at) = joint(pair.target, pair.contactor) {
                self.joints[at].force += -pair.force;
            }
        }
        for joint in &mut self.joints {
            let Vec2 { x, z } = joint.force;
            let (most, when) = joint.peak_vertical;
            let more = most.lt(z);
            if more.any() {
                joint.peak_vertical = (R::select(more, z, most), R::select(more, time, when));
            }
            let (most, when) = joint.peak_horizontal;
            let more = most.abs().lt(x.abs());
            if more.any() {
                joint.peak_horizontal = (R::select(more, x, most), R::select(more, time, when));
            }
        }
    }
}
