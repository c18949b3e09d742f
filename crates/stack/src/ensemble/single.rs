//! Cases with adaptive time steps, which run one after the other because every case chooses its own steps.

use std::ops::ControlFlow;

use barrelstack_dynamics::{
    EnergyLedger, Model, Observer, Planar, Scratch, Simulation, State, simulate,
};

use super::case::Observed;
use super::trail::Trail;
use super::work::Share;
use super::{Audience, CaseResult, Run};
use crate::run::{Ended, conclude, method, thresholds};
use crate::stand::Stack;
use crate::watch::{End, Ending, Fates, Joints, StressWatch};

/// Runs a group of cases one after the other; if stopped, returns the results so far.
pub(super) fn run(
    group: &[Run<'_>],
    stacks: &[Stack<'_>],
    audience: &mut Audience<'_>,
) -> Vec<(usize, CaseResult)> {
    let mut results = Vec::with_capacity(group.len());
    for run in group {
        let Ok(standing) = &stacks[run.stack].standing else { continue };
        let scenario = &*run.case.scenario;
        let (mut state, mut scratch) = (standing.state.clone(), standing.scratch.clone());
        let simulation = Simulation {
            method: method(scenario),
            time_step: standing.step,
            end_time: run.end_time,
        };
        let mut watch = Watch {
            fates: Fates::new(&standing.assembly, &state, thresholds(scenario)),
            stresses: if run.case.records_stresses {
                StressWatch::new(&standing.assembly, &state, &scratch)
            } else {
                StressWatch::nothing()
            },
            joints: Joints::new(&standing.assembly),
            trail: Trail::new(&standing.assembly),
            started: false,
            end: run.end(standing),
            stop: audience.stop,
            next_ask: 0.0,
            share: Share::new(run.end_time, run.case.ground.end()),
            ending: None,
        };
        let ground = &*run.case.ground;
        let model = &standing.assembly.model;
        let ended = simulate(model, ground, &mut state, &mut scratch, &simulation, &mut watch);
        if watch.ending == Some(Ending::Interrupted) {
            break;
        }
        let ending = watch.ending.unwrap_or(Ending::of_time(scenario));
        let ended = ended.map(|totals| Ended::of(&totals));
        let verdict = conclude(&standing.assembly, ground, &watch.fates, ended, state.time, ending);
        let stresses = watch.stresses.finish(0);
        watch.trail.see_state(&state);
        let Watch { fates, joints, trail, share, .. } = watch;
        share.end(state.time);
        let observed = Observed { fates: &fates, stresses: &stresses, joints: &joints, trail };
        let result = CaseResult::of(&standing.assembly, ground, observed, verdict, state.time);
        (audience.on_case)(&result);
        results.push((run.index, result));
    }
    results
}

/// Observer of a case, which records losses of seats and falls, stresses, forces between bodies, and barrel positions.
struct Watch<'a> {
    fates: Fates,
    stresses: StressWatch,
    joints: Joints,
    trail: Trail,
    started: bool,
    end: End,
    stop: &'a dyn Fn() -> bool,
    /// Simulated time (s) of the next poll of the stop request.
    next_ask: f64,
    share: Share,
    ending: Option<Ending>,
}

impl Observer<Planar> for Watch<'_> {
    fn observe(
        &mut self,
        model: &Model<Planar>,
        state: &State<Planar>,
        scratch: &Scratch<Planar>,
        _: &EnergyLedger<Planar>,
    ) -> ControlFlow<()> {
        let standing = self.fates.stands();
        self.fates.observe(state, scratch);
        self.stresses.observe(standing, state, scratch, &|_| Some(model));
        if self.started {
            self.joints.observe(state.time, standing, scratch);
        } else {
            self.joints.start(state.time, scratch);
            self.started = true;
        }
        if state.time >= self.trail.due() {
            self.trail.see_state(state);
        }
        if state.time >= self.next_ask {
            self.next_ask = state.time + 0.05;
            self.share.reached(state.time);
            if (self.stop)() {
                self.ending = Some(Ending::Interrupted);
                return ControlFlow::Break(());
            }
        }
        self.ending = self.end.why(state, &self.fates);
        if self.ending.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
