//! Three-dimensional cases that run side by side in the lanes of a vector register. Only their results are kept.
//!
//! The results are bit-identical to those of separate runs. Cases can share a register only if they have the same
//! method of integration, with fixed time steps, and models with the same [`Topology`](lanes::Topology). When the case
//! of a lane has ended, the lane takes the next case.

use std::sync::Arc;

use barrelstack::ensemble::Share;
use barrelstack::run::{Ended, Work};
use barrelstack::watch::Ending;
use barrelstack_dynamics::lanes::{self, End, Lanewise as _, Task, Topology, Width, run_batch};
use barrelstack_dynamics::real::{Mask as _, Real};
use barrelstack_dynamics::space::Wrench;
use barrelstack_dynamics::{Finish, Method, Scratch, Spatial, State};

use crate::ground::Ground;
use crate::simulation::{Prepared, Watch};
use crate::variants::Case;

/// Number of steps after which a batch checks whether it has to stop.
const PATIENCE: u32 = 64;

/// Smallest number of cases that run in lanes. Fewer cases would take longer in lanes than one after the other: with
/// AVX2, a step of all lanes takes as long as six to eight steps of a single run for falling stacks, and as long as
/// four to five for standing stacks.
const FEWEST: usize = 6;

/// A case whose stack is at rest, and its index among all cases.
pub(crate) type Ready = (usize, Prepared);

/// Runs cases in lanes on one core, and returns the cases that the caller has to run one after the other. These are
/// the cases that cannot share a register with enough other cases, or all cases if `in_lanes` is `false` or if the
/// machine has no vector unit.
///
/// `report` receives the index and the result of each finished case. The work ends when `stop` returns `true`.
pub(crate) fn run(
    in_lanes: bool,
    ready: Vec<Ready>,
    report: &mut dyn FnMut(usize, Case),
    stop: &dyn Fn() -> bool,
) -> Vec<Ready> {
    let mut groups: Vec<(Topology, Method, Vec<Ready>)> = Vec::new();
    let mut alone = Vec::new();
    for one in ready {
        let (model, method) = (&one.1.fixed.stack.model, one.1.fixed.settings.method);
        if !one.1.can_share_steps() {
            alone.push(one);
            continue;
        }
        let topology = Topology::of(model);
        match groups.iter_mut().find(|(known, by, _)| *known == topology && *by == method) {
            Some((.., group)) => group.push(one),
            None => groups.push((topology, method, vec![one])),
        }
    }
    for (_, method, group) in groups {
        if group.len() < FEWEST || !in_lanes || Width::widest() == Width::Scalar {
            alone.extend(group);
        } else {
            Width::run_in_bundles(InLanes { method, group: &group, report, stop });
        }
    }
    alone
}

struct InLanes<'a> {
    method: Method,
    group: &'a [Ready],
    report: &'a mut dyn FnMut(usize, Case),
    stop: &'a dyn Fn() -> bool,
}

impl Task for InLanes<'_> {
    type Output = ();

    fn run<R: Real>(self) {
        let Self { method, group, report, stop } = self;
        let lanes = std::iter::repeat_with(|| None).take(R::LANES).collect();
        let mut batch = Batch { group, report, stop, next: 0, lanes, steps: 0, interrupted: false };
        run_batch::<Spatial<R>, _>(method, &mut batch);
    }
}

struct Batch<'a> {
    group: &'a [Ready],
    report: &'a mut dyn FnMut(usize, Case),
    stop: &'a dyn Fn() -> bool,
    /// Index, in `group`, of the case that the next free lane takes.
    next: usize,
    lanes: Vec<Option<Lane<'a>>>,
    /// Number of steps since the last call of `stop`.
    steps: u32,
    interrupted: bool,
}

/// A running case, with the current time, poses, twists and wrenches of its bodies.
struct Lane<'a> {
    index: usize,
    prepared: &'a Prepared,
    watch: Watch,
    state: State<Spatial>,
    wrenches: Vec<Wrench<Spatial>>,
    share: Share,
}

impl<'a, R: Real> lanes::Batch<'a, Spatial<R>> for Batch<'a> {
    type Drive = &'a Ground;

    fn next(&mut self, lane: usize) -> Option<lanes::Case<'a, Spatial, &'a Ground>> {
        let (index, prepared) = self.group.get(self.next).filter(|_| !self.interrupted)?;
        self.next += 1;
        let fixed = &*prepared.fixed;
        let watch = prepared.watch.clone();
        let share = Share::new(fixed.settings.end_time, fixed.ground.end());
        let state = prepared.state.clone();
        let wrenches = vec![Wrench::default(); state.poses.len()];
        self.lanes[lane] = Some(Lane { index: *index, prepared, watch, state, wrenches, share });
        Some(lanes::Case {
            model: &fixed.stack.model,
            state: prepared.state.clone(),
            drive: &fixed.ground,
            time_step: fixed.settings.time_step,
            end_time: fixed.settings.end_time,
        })
    }

    fn start(&mut self, lane: usize, state: &State<Spatial>, scratch: &Scratch<Spatial>) {
        let Some(lane) = &mut self.lanes[lane] else { return };
        lane.watch.observe_lane(0, (state, &scratch.wrenches), state, scratch);
        lane.watch.end(state);
    }

    fn observe(
        &mut self,
        state: &State<Spatial<R>>,
        scratch: &Scratch<Spatial<R>>,
    ) -> <R as Real>::Mask {
        self.steps += 1;
        if self.steps == PATIENCE {
            self.steps = 0;
            for (at, lane) in self.lanes.iter_mut().enumerate() {
                if let Some(Lane { share, .. }) = lane {
                    share.reached(state.time.lane(at));
                }
            }
            if (self.stop)() {
                self.interrupted = true;
                return !R::Mask::default();
            }
        }
        for (at, lane) in self.lanes.iter_mut().enumerate() {
            let Some(Lane { watch, state: own, wrenches, .. }) = lane else { continue };
            own.time = state.time.lane(at);
            for (own, pose) in own.poses.iter_mut().zip(&state.poses) {
                *own = pose.of_lane(at);
            }
            for (own, twist) in own.twists.iter_mut().zip(&state.twists) {
                *own = twist.of_lane(at);
            }
            for (own, wrench) in wrenches.iter_mut().zip(&scratch.wrenches) {
                *own = wrench.of_lane(at);
            }
            watch.observe_lane(at, (own, wrenches), state, scratch);
            watch.end(own);
        }
        R::Mask::from_lanes(|at| {
            self.lanes[at].as_ref().is_some_and(|lane| lane.watch.ending.is_some())
        })
    }

    fn end(&mut self, lane: usize, end: End) {
        let Some(lane) = self.lanes[lane].take().filter(|_| !self.interrupted) else { return };
        let Lane { index, prepared, watch, state, share, .. } = lane;
        let fixed = &prepared.fixed;
        let ending = match (&end.finish, watch.ending) {
            (Err(_), _) => Ending::Broken,
            (Ok(Finish::Stopped), Some(ending)) => ending,
            (Ok(Finish::Stopped | Finish::EndTime), _) => Ending::of_time(&fixed.scenario),
        };
        share.end(end.time);
        // Evaluations are counted for all lanes together, so the result of a single case states only its steps.
        let work = Work { steps: end.steps, ..Work::default() };
        let ended = end.finish.map(|_| Ended { energy: end.energy, steps: end.steps });
        let run = watch.conclude(Arc::clone(fixed), state, ended, work, ending);
        (self.report)(index, Case::of(&run));
    }
}
