//! Forces at the seats and their contacts in a three-dimensional run: the forces at rest, and the largest forces during
//! the run.

use barrelstack::demand::Span;
use barrelstack::watch::{Joint, Joints, leans_on};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::{BodyId, Scratch, Spatial, Vec2, Vec3};

use crate::stack::Stack;

/// Normal force on one contact element: its value at rest and its maxima.
#[derive(Clone, Copy, Debug, Default)]
struct Press {
    /// Force at rest (N).
    at_rest: f64,
    /// Largest force until the first loss of a seat (N).
    peak: f64,
    /// Largest force over the whole run (N).
    peak_whole_run: f64,
}

impl Press {
    fn peak_in(&self, span: Span) -> f64 {
        match span {
            Span::UntilLoss => self.peak,
            Span::WholeRun => self.peak_whole_run,
        }
    }
}

/// Recorder of the forces at the joints and contacts during a run. It must observe every accepted step.
#[derive(Clone, Debug)]
pub struct Seats {
    /// Joints between every barrel and its rack, between every rack and its supports, and between other bodies that
    /// have touched. For the horizontal force, the magnitude is recorded.
    pub joints: Joints,
    /// For each joint, the force (N) on its upper body in the current step.
    forces: Vec<Vec3>,
    /// Forces on the contact elements of all pairs, pair after pair.
    presses: Vec<Press>,
    /// Contact pairs in the order of the model; empty for a free scene.
    pairs: Vec<Pair>,
}

/// Bodies of a contact pair, with the indices of its first contact element and of its joint.
#[derive(Clone, Debug)]
struct Pair {
    bodies: [BodyId; 2],
    /// Index of the first contact element of the pair.
    first: usize,
    /// Index of the joint between the two bodies, and a flag that is `true` if the contactor is the upper body. `None`
    /// until the bodies have touched.
    joint: Option<(usize, bool)>,
}

impl Seats {
    /// Creates the recorder for a stack at rest. `scratch` contains the forces at the current time `time` (s).
    pub fn new(stack: &Stack, time: f64, scratch: &Scratch<Spatial>) -> Self {
        let below = stack.parts.iter();
        let below = below.map(|part| leans_on(part.kind, part.carrier, &part.supports));
        let joints = Joints::between(below, !stack.is_free());
        let (mut pairs, mut count) = (Vec::new(), 0);
        // A free scene has no seats, and may have too many pairs to list.
        for pair in stack.model.pairs().take_while(|_| !stack.is_free()) {
            pairs.push(Pair { bodies: [pair.contactor, pair.target], first: count, joint: None });
            count += stack.model.bodies()[pair.contactor].nodes[pair.nodes].count();
        }
        let forces = vec![Vec3::default(); joints.joints.len()];
        let mut seats = Self { joints, forces, presses: vec![Press::default(); count], pairs };
        seats.observe((0, time), true, scratch);
        for joint in &mut seats.joints.joints {
            joint.at_rest = joint.force.z;
        }
        for press in &mut seats.presses {
            press.at_rest = press.peak;
        }
        seats
    }

    /// Records the forces in one lane at `time` (s), after an accepted step. `stands` is `true` if no body had left its
    /// seat before this step.
    pub fn observe<R: Real>(
        &mut self,
        (lane, time): (usize, f64),
        stands: bool,
        scratch: &Scratch<Spatial<R>>,
    ) {
        if self.pairs.is_empty() {
            return;
        }
        self.forces.fill(Vec3::default());
        for (pair, pressed) in scratch.touching_pairs(lane) {
            let Pair { joint, first, .. } = &mut self.pairs[pair.pair];
            *joint = joint.or_else(|| self.joints.meet(pair.contactor, pair.target));
            self.forces.resize(self.joints.joints.len(), Vec3::default());
            if let Some((at, upper)) = *joint {
                let force = pair.force.lane(lane);
                self.forces[at] += if upper { force } else { -force };
            }
            for pressed in pressed {
                let press = &mut self.presses[*first + pressed.node as usize];
                let force = pressed.normal_force.lane(lane);
                press.peak_whole_run = press.peak_whole_run.max(force);
                if stands {
                    press.peak = press.peak_whole_run;
                }
            }
        }
        for (joint, force) in self.joints.joints.iter_mut().zip(&self.forces) {
            joint.force = Vec2::new((force.x * force.x + force.y * force.y).sqrt(), force.z);
            joint.raise(time, stands);
        }
    }

    /// Returns the joints of a stack with their names, such as "R1 on ground".
    pub fn named(&self, stack: &Stack) -> impl Iterator<Item = (String, &Joint)> {
        let named = move |joint: &Joint| joint.named(|body| &stack.parts[body].name);
        self.joints.listed().into_iter().map(move |joint| (named(joint), joint))
    }

    /// Returns the contact elements of a body.
    fn of(&self, body: BodyId) -> impl Iterator<Item = &Press> {
        let ends = self.pairs.iter().skip(1).map(|pair| pair.first).chain([self.presses.len()]);
        let own = self.pairs.iter().zip(ends).filter(move |(pair, _)| pair.bodies.contains(&body));
        own.flat_map(|(pair, end)| &self.presses[pair.first..end])
    }

    /// Returns the largest contact force on a body in a span of the run, divided by the largest contact force at rest;
    /// `None` without load at rest.
    ///
    /// The stresses have the same ratio, since every contact element has the same tributary length.
    pub fn amplification(&self, body: BodyId, span: Span) -> Option<f64> {
        let most = |of: &dyn Fn(&Press) -> f64| self.of(body).map(of).fold(0.0, f64::max);
        let at_rest = most(&|press| press.at_rest);
        (at_rest > 0.0).then(|| most(&|press| press.peak_in(span)) / at_rest)
    }

    /// Returns the sum of the largest contact forces on a body in a span of the run, divided by the sum of the contact
    /// forces at rest. Only contact elements that are loaded at rest count; `None` if there are none.
    pub fn mean_amplification(&self, body: BodyId, span: Span) -> Option<f64> {
        let sum = |of: &dyn Fn(&Press) -> f64| {
            self.of(body).filter(|press| press.at_rest > 0.0).map(of).sum::<f64>()
        };
        let at_rest = sum(&|press| press.at_rest);
        (at_rest > 0.0).then(|| sum(&|press| press.peak_in(span)) / at_rest)
    }
}
