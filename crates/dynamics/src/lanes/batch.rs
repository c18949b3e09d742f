//! The run loop of many cases in lockstep.

use crate::contact::Stick;
use crate::energy::{EnergyLedger, EnergySummary};
use crate::forces::Scratch;
use crate::integrate::{Drive, Integrator, Method};
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::simulate::{Finish, RunError, StepTimes, lost_body};
use crate::space::{Space, Twist};
use crate::state::State;

use super::Lanewise;

/// A set of lanes, as a mask.
type MaskOf<S> = <<S as Space>::Real as Real>::Mask;

/// A case that is ready to run: model, initial state, ground motion, time step and end time.
pub struct Case<'a, S: Space, D> {
    /// The model.
    pub model: &'a Model<S>,
    /// Initial state.
    pub state: State<S>,
    /// Ground motion.
    pub drive: D,
    /// Time step (s).
    pub time_step: f64,
    /// End time (s), unless the batch stops the case earlier.
    pub end_time: f64,
}

/// Result of a case.
#[derive(Clone, Debug)]
pub struct End {
    /// Reason for the end of the case, or the error.
    pub finish: Result<Finish, RunError>,
    /// End time (s).
    pub time: f64,
    /// Number of accepted steps.
    pub steps: u64,
    /// Energy balance.
    pub energy: EnergySummary,
}

/// Supplies the cases of a batch, and receives their states and results.
pub trait Batch<'a, S: Space> {
    /// Ground motion of a case.
    type Drive: Drive<S::Single>;

    /// Returns the next case for a lane, or `None` to leave the lane without a case. All cases of a batch must have the
    /// same [`Topology`](super::Topology).
    fn next(&mut self, lane: usize) -> Option<Case<'a, S::Single, Self::Drive>>;

    /// Called when a case starts, with the initial state and its forces. The prescribed bodies have already been moved
    /// with the ground.
    fn start(&mut self, lane: usize, state: &State<S::Single>, scratch: &Scratch<S::Single>);

    /// Called after each accepted step of all lanes; returns the lanes to stop.
    ///
    /// Lanes without a case are included; their state is constant.
    fn observe(&mut self, state: &State<S>, scratch: &Scratch<S>) -> MaskOf<S>;

    /// Called when a case has ended.
    fn end(&mut self, lane: usize, end: End);
}

/// Runs all cases of a batch, as many side by side as a bundle has lanes.
///
/// A lane gets the next case as soon as its current case has ended. Every case takes the same steps, with bit-identical
/// results, as a single run by [`simulate`](crate::simulate()): the lanes share only the order of the computations and
/// the list of contact elements, which affects only the speed. Only methods with a fixed step are supported.
pub fn run_batch<'a, S: Space, C: Batch<'a, S>>(method: Method, batch: &mut C) {
    let Some(first) = batch.next(0) else { return };
    let mut lanes = Lanes::<S, C::Drive>::of(&first);
    lanes.load(0, first, batch);
    for lane in 1..S::Real::LANES {
        if let Some(case) = batch.next(lane) {
            lanes.load(lane, case, batch);
        }
    }
    let mut integrator = Integrator::new(method);
    while lanes.busy.any() {
        let ended = S::Real::scope(
            #[inline(always)]
            || lanes.step(&mut integrator, batch),
        );
        if ended.any() {
            for lane in (0..S::Real::LANES).filter(|lane| ended.lane(*lane)) {
                batch.end(lane, lanes.end(lane));
                match batch.next(lane) {
                    Some(case) => lanes.load(lane, case, batch),
                    None => lanes.retire(lane),
                }
            }
        }
    }
}

/// The running cases.
struct Lanes<S: Space, D> {
    model: Model<S>,
    state: State<S>,
    scratch: Scratch<S>,
    energy: EnergyLedger<S>,
    drives: Drives<D>,
    /// The lanes with a case.
    busy: MaskOf<S>,
    /// The lanes that the batch stopped in the last step.
    stopped: MaskOf<S>,
    start: S::Real,
    steps: S::Real,
    times: StepTimes<S::Real>,
    time_step: S::Real,
    end_time: S::Real,
}

/// Ground motion of every lane; the ground is at rest in a lane without a case.
struct Drives<D>(Vec<Option<D>>);

impl<S: Space, D: Drive<S::Single>> Drive<S> for Drives<D> {
    fn at(&self, time: S::Real) -> (S::Vector, S::Vector) {
        let mut moved = (S::Vector::default(), S::Vector::default());
        for (lane, drive) in self.0.iter().enumerate() {
            if let Some(drive) = drive {
                moved.put(lane, &drive.at(time.lane(lane)));
            }
        }
        moved
    }
}

impl<S: Space, D: Drive<S::Single>> Lanes<S, D> {
    /// Creates lanes that all contain the state of one case; none of the lanes is busy.
    fn of(case: &Case<'_, S::Single, D>) -> Self {
        let model = Model::<S>::in_all(case.model);
        let mut state = State::initial(&model);
        state.poses = Lanewise::in_all(&case.state.poses);
        state.contact_elements.rebuild(&model, &state.poses, &state.twists);
        let mut scratch = Scratch::new(&model);
        scratch.keeps_contacts = false;
        crate::forces::evaluate(&model, &state, &mut scratch);
        let energy = EnergyLedger::new(&model, &state, &scratch);
        let time_step = S::Real::splat(case.time_step);
        Self {
            times: StepTimes::new(&model, time_step),
            model,
            state,
            scratch,
            energy,
            drives: Drives((0..S::Real::LANES).map(|_| None).collect()),
            busy: MaskOf::<S>::default(),
            stopped: MaskOf::<S>::default(),
            start: S::Real::zero(),
            steps: S::Real::zero(),
            time_step,
            end_time: S::Real::splat(case.end_time),
        }
    }

    /// Loads a case into a lane.
    fn load<'a>(
        &mut self,
        lane: usize,
        case: Case<'a, S::Single, D>,
        batch: &mut impl Batch<'a, S, Drive = D>,
    ) {
        let Case { model, mut state, drive, time_step, end_time } = case;
        let mut scratch = Scratch::new(model);
        let times = StepTimes::new(model, time_step);
        scratch.lookahead = times.lookahead();
        Integrator::start(model, &drive, &mut state, &mut scratch);
        batch.start(lane, &state, &scratch);
        self.put(lane, model, &state, &scratch);
        self.drives.0[lane] = Some(drive);
        self.start.put(lane, &state.time);
        self.steps.put(lane, &0.0);
        self.times.put(lane, &times);
        self.time_step.put(lane, &time_step);
        self.end_time.put(lane, &end_time);
        self.busy = MaskOf::<S>::from_lanes(|l| l == lane || self.busy.lane(l));
    }

    /// Frees a lane. Its bodies get the poses of a running lane and stay at rest, so that the freed lane needs no
    /// additional contact elements.
    fn retire(&mut self, lane: usize) {
        self.busy = MaskOf::<S>::from_lanes(|l| l != lane && self.busy.lane(l));
        self.drives.0[lane] = None;
        self.time_step.put(lane, &0.0);
        let Some(other) = (0..S::Real::LANES).find(|l| self.busy.lane(*l)) else { return };
        let poses = self.state.poses.of_lane(other);
        self.state.poses.put(lane, &poses);
        for twist in &mut self.state.twists {
            twist.put(lane, &Twist::default());
        }
        for stick in &mut self.state.contact_elements.sticks {
            stick.put(lane, &Stick::default());
        }
        for acceleration in &mut self.scratch.accelerations {
            acceleration.put(lane, &Twist::default());
        }
        for rate in &mut self.scratch.slip_rates {
            rate.put(lane, &Default::default());
        }
    }

    fn put(
        &mut self,
        lane: usize,
        model: &Model<S::Single>,
        state: &State<S::Single>,
        scratch: &Scratch<S::Single>,
    ) {
        self.model.put(lane, model);
        self.state.time.put(lane, &state.time);
        self.state.poses.put(lane, &state.poses);
        self.state.twists.put(lane, &state.twists);
        self.state.memory.put(lane, &state.memory);
        self.scratch.accelerations.put(lane, &scratch.accelerations);
        self.scratch.lookahead.put(lane, &scratch.lookahead);
        let needs_substeps = self.scratch.needs_substeps;
        self.scratch.needs_substeps = MaskOf::<S>::from_lanes(|l| {
            if l == lane { scratch.needs_substeps } else { needs_substeps.lane(l) }
        });
        let origins =
            self.state.contact_elements.rebuild(&self.model, &self.state.poses, &self.state.twists);
        self.scratch.renumber(&origins);
        let slip_rates = &mut self.scratch.slip_rates;
        self.state.contact_elements.put_memory(
            lane,
            slip_rates,
            &state.contact_elements,
            &scratch.slip_rates,
        );
        self.energy.put(lane, &EnergyLedger::new(model, state, scratch));
    }

    /// Takes one step of all lanes; returns the lanes whose case has ended.
    #[inline(always)]
    fn step<'a>(
        &mut self,
        integrator: &mut Integrator<S>,
        batch: &mut impl Batch<'a, S, Drive = D>,
    ) -> MaskOf<S> {
        // As in `simulate`, times are whole multiples of the step, and the last step is shortened.
        let sliver = S::Real::splat(1e-9) * self.time_step;
        let target =
            self.start + self.times.next(self.scratch.needs_substeps, self.scratch.is_hard);
        let early = target.lt(self.end_time - sliver);
        let until = S::Real::select(early, target, self.end_time);
        let until = S::Real::select(self.busy, until, self.state.time);
        integrator.step(&self.model, &self.drives, &mut self.state, &mut self.scratch, until);
        self.steps += S::Real::splat(1.0);
        self.energy.enter(&self.model, &self.state, &self.scratch);
        self.stopped = batch.observe(&self.state, &self.scratch);
        let on = self.state.time.lt(self.end_time - sliver) & self.energy.finite();
        self.busy & (self.stopped | !on)
    }

    fn end(&self, lane: usize) -> End {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let steps = self.steps.lane(lane) as u64;
        let finish = if !self.energy.finite().lane(lane) {
            let time_step = self.time_step.lane(lane);
            Err(lost_body(&self.model, &self.state, lane, time_step, steps - 1))
        } else if self.stopped.lane(lane) {
            Ok(Finish::Stopped)
        } else {
            Ok(Finish::EndTime)
        };
        End { finish, time: self.state.time.lane(lane), steps, energy: self.energy.summary(lane) }
    }
}
