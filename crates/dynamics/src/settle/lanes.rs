//! Settling of many stacks side by side, with results that are bit-identical to settling each stack alone.

use crate::contact_elements::ContactElements;
use crate::forces::{Scratch, evaluate};
use crate::integrate::{Still, place_prescribed};
use crate::lanes::Lanewise;
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Planar, Pose, Twist};
use crate::state::State;

use super::refusal::Departure;
use super::relax::Relaxation;
use super::{LOOK, Locked, MOST_STEPS, SettleError, Settled, TRIES, gravity, settle, stop};

/// A stack to be settled under gravity.
#[derive(Debug)]
pub struct Stack<'a> {
    /// The model.
    pub model: &'a Model<Planar>,
    /// Initial state; at rest on return.
    pub state: &'a mut State<Planar>,
    /// Working memory; on return, contains the forces and the contacts of the stack at rest.
    pub scratch: &'a mut Scratch<Planar>,
}

/// Settles stacks of one [`Topology`](crate::lanes::Topology), as many side by side as a bundle has lanes. Returns the
/// result of [`settle`] for each stack, in order, or `None` if `stop` returns `true` before all stacks are settled.
///
/// A lane gets the next stack as soon as its current stack is at rest. The lanes share only the list of contact
/// elements, so every stack takes the same steps as if it were settled alone. A stack that does not come to rest at the
/// first attempt is settled again by [`settle`], which also diagnoses the cause.
pub fn settle_all<R: Real>(
    stacks: &mut [Stack<'_>],
    tolerance: f64,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Result<Settled, SettleError>>> {
    let mut settled: Vec<Option<Settled>> = vec![None; stacks.len()];
    if R::LANES > 1
        && let Some(first) = stacks.first()
    {
        let mut lanes = Lanes::<R>::of(first.model);
        let mut next = 0..stacks.len();
        let mut free: Vec<usize> = (0..R::LANES).collect();
        loop {
            lanes.relaxation.set_out(&lanes.model, &mut lanes.state, &lanes.scratch);
            if !free.is_empty() {
                if stop() {
                    return None;
                }
                for lane in &free {
                    match next.next() {
                        Some(stack) => lanes.load(*lane, stack, &mut stacks[stack]),
                        None => lanes.retire(*lane),
                    }
                }
                lanes.list(&free, stacks);
            }
            if lanes.tries.iter().all(Option::is_none) {
                break;
            }
            free = lanes.step(tolerance, stacks, &mut settled);
        }
    }
    let alone = |(stack, settled): (&mut Stack<'_>, Option<Settled>)| match settled {
        Some(settled) => Some(Ok(settled)),
        None if stop() => None,
        None => Some(settle(stack.model, stack.state, stack.scratch, tolerance)),
    };
    stacks.iter_mut().zip(settled).map(alone).collect()
}

/// The stacks that are settling.
struct Lanes<R: Real> {
    model: Model<Planar<R>>,
    state: State<Planar<R>>,
    scratch: Scratch<Planar<R>>,
    relaxation: Relaxation<Planar<R>>,
    /// The current attempt in every lane; `None` in lanes without a stack.
    tries: Vec<Option<Try>>,
}

/// First attempt to settle a stack.
struct Try {
    /// Index of the stack.
    stack: usize,
    departure: Departure<Planar>,
    steps: u64,
}

impl<R: Real> Lanes<R> {
    /// Creates lanes that all contain the same model and no stack.
    fn of(model: &Model<Planar>) -> Self {
        let model = Model::<Planar<R>>::in_all(model);
        let state = State::initial(&model);
        let mut scratch = Scratch::new(&model);
        evaluate(&model, &state, &mut scratch);
        let (margin, calm) = TRIES[0];
        let mut relaxation = Relaxation::new(&model, margin, calm);
        relaxation.weigh(&model, &state, &scratch);
        relaxation.resting = !R::Mask::default();
        Self { model, state, scratch, relaxation, tries: (0..R::LANES).map(|_| None).collect() }
    }

    /// Loads a stack in its initial state into a lane; the list of contact elements is not updated yet.
    fn load(&mut self, lane: usize, index: usize, stack: &mut Stack<'_>) {
        let Stack { model, state, .. } = stack;
        stop(model, state);
        place_prescribed(model, &Still, state);
        self.model.put(lane, model);
        self.state.memory.put(lane, &state.memory);
        self.relaxation.reach.put(lane, &model.reach);
        self.place(lane, &state.poses);
        let departure = Departure::new(model, state.poses.clone());
        self.tries[lane] = Some(Try { stack: index, departure, steps: 0 });
    }

    /// Empties a lane; its bodies return to the initial poses of its last stack.
    fn retire(&mut self, lane: usize) {
        let start: Vec<Pose<Planar>> =
            self.model.bodies.iter().map(|body| body.pose.of_lane(lane)).collect();
        self.place(lane, &start);
        self.tries[lane] = None;
    }

    fn place(&mut self, lane: usize, poses: &Vec<Pose<Planar>>) {
        self.relaxation.begin(lane);
        self.state.poses.put(lane, poses);
        for twist in &mut self.state.twists {
            twist.put(lane, &Twist::default());
        }
    }

    /// Rebuilds the list of contact elements of all lanes; in lanes where a new stack begins, the elements take over
    /// the contact history of that stack.
    fn list(&mut self, begin: &[usize], stacks: &[Stack<'_>]) {
        let State { contact_elements, poses, twists, .. } = &mut self.state;
        let origins = contact_elements.rebuild(&self.model, poses, twists);
        self.relaxation.renumber(&origins, &mut self.scratch);
        let nothing = ContactElements::default();
        for lane in begin {
            let single = self.tries[*lane]
                .as_ref()
                .map_or(&nothing, |t| &stacks[t.stack].state.contact_elements);
            let rates = vec![0.0; single.len()];
            contact_elements.put_memory(*lane, &mut self.scratch.slip_rates, single, &rates);
        }
    }

    /// Evaluates the forces, and ends the attempts whose stack is at rest or must be settled alone. Returns the lanes
    /// of these attempts.
    fn step(
        &mut self,
        tolerance: f64,
        stacks: &mut [Stack<'_>],
        settled: &mut [Option<Settled>],
    ) -> Vec<usize> {
        let Self { model, state, scratch, relaxation, .. } = self;
        relaxation.arrive(model, state, scratch);
        relaxation.weigh(model, state, scratch);
        let (rests, worst) = relaxation.left_over(model, state, scratch, tolerance);
        let mut ended = Vec::new();
        for lane in 0..R::LANES {
            let Some(Try { stack, departure, steps }) = &mut self.tries[lane] else { continue };
            let stack = *stack;
            if rests.lane(lane) {
                let unbalanced = worst.lane(lane) / gravity(&self.model).lane(lane);
                let found = (*steps, unbalanced);
                settled[stack] = Some(self.take(lane, &mut stacks[stack], found));
            } else {
                let looks = *steps % LOOK == 0;
                let left = looks
                    && departure.has_left(stacks[stack].model, &self.state.poses.of_lane(lane));
                if !left && *steps < MOST_STEPS {
                    *steps += 1;
                    continue;
                }
            }
            self.tries[lane] = None;
            ended.push(lane);
        }
        let tries = &self.tries;
        self.relaxation.resting = R::Mask::from_lanes(|lane| tries[lane].is_none());
        ended
    }

    /// Copies the settled state of a lane to its stack, evaluates the forces there and returns the result.
    fn take(&self, lane: usize, stack: &mut Stack<'_>, (steps, unbalanced): (u64, f64)) -> Settled {
        let Stack { model, state, scratch } = stack;
        state.poses = self.state.poses.of_lane(lane);
        state.memory = self.state.memory.of_lane(lane);
        state.contact_elements =
            self.state.contact_elements.of_lane(lane, &self.relaxation.touched);
        state.contact_elements.rebuild(model, &state.poses, &state.twists);
        let keeps_contacts = std::mem::replace(&mut scratch.keeps_contacts, true);
        evaluate(model, state, scratch);
        let locked = Locked::of(state, scratch);
        scratch.keeps_contacts = keeps_contacts;
        Settled { steps, unbalanced, locked }
    }
}
