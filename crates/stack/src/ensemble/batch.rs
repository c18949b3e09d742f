//! Cases that run in vector lanes: loading, observation and results.

use barrelstack_dynamics::lanes::{self, Case, End, Lanewise as _, Task, Width, run_batch};
use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{Finish, Method, Planar, Scratch, State};

use super::case::Observed;
use super::trail::Trail;
use super::work::Share;
use super::{Audience, CaseResult, Run};
use crate::ground::Ground;
use crate::run::{Ended, conclude, thresholds};
use crate::stand::{Stack, Standing};
use crate::watch::{self, Ending, Fates, Joints, StressWatch};

/// Number of steps between two polls of the stop request.
const PATIENCE: u32 = 1024;

/// Runs a group of cases with the same topology and method in vector lanes; if stopped, returns the results so far.
pub(super) fn run(
    width: Width,
    method: Method,
    group: &[Run<'_>],
    stacks: &[Stack<'_>],
    audience: &mut Audience<'_>,
) -> Vec<(usize, CaseResult)> {
    let width = if width.is_here() { width } else { Width::Scalar };
    // The result is `None` only for a width that the machine does not have.
    width.run(InLanes { method, group, stacks, audience }).unwrap_or_default()
}

struct InLanes<'a, 'b> {
    method: Method,
    group: &'a [Run<'a>],
    stacks: &'a [Stack<'a>],
    audience: &'a mut Audience<'b>,
}

impl Task for InLanes<'_, '_> {
    type Output = Vec<(usize, CaseResult)>;

    fn run<R: Real>(self) -> Self::Output {
        let Self { method, group, stacks, audience } = self;
        let mut batch = Batch::<R> {
            group,
            stacks,
            audience,
            next: 0,
            runs: vec![0; R::LANES],
            fates: None,
            stresses: StressWatch::nothing(),
            joints: None,
            end: None,
            trails: vec![Trail::default(); R::LANES],
            shares: std::iter::repeat_with(|| None).take(R::LANES).collect(),
            due: R::splat(f64::INFINITY),
            rested: R::Mask::default(),
            steps: 0,
            interrupted: false,
            results: Vec::with_capacity(group.len()),
        };
        run_batch::<Planar<R>, _>(method, &mut batch);
        batch.results
    }
}

struct Batch<'a, 'b, R: Real> {
    group: &'a [Run<'a>],
    stacks: &'a [Stack<'a>],
    audience: &'a mut Audience<'b>,
    /// Index in `group` of the next run to be loaded.
    next: usize,
    /// For each lane, the index of its run in `group`.
    runs: Vec<usize>,
    /// Losses of seats and falls in each lane; `None` before the first run is loaded.
    fates: Option<Fates<R>>,
    /// Observer of the contact stresses in all lanes.
    stresses: StressWatch<R>,
    /// Forces between bodies in each lane; `None` before the first run is loaded.
    joints: Option<Joints<R>>,
    /// Stop criteria of each lane; `None` before the first run is loaded.
    end: Option<watch::End<R>>,
    /// For each lane, the sampled barrel positions of its case.
    trails: Vec<Trail>,
    /// For each lane, the time (s) at which its next sample is due; infinity in lanes without a case.
    due: R,
    /// For each lane, the guard that counts the progress of its case; `None` in lanes without a case.
    shares: Vec<Option<Share>>,
    /// The lanes that met the rest criterion in the last step.
    rested: R::Mask,
    /// Number of steps since the last poll of the stop request.
    steps: u32,
    interrupted: bool,
    results: Vec<(usize, CaseResult)>,
}

impl<R: Real> Batch<'_, '_, R> {
    fn standing(&self, lane: usize) -> Option<(&Run<'_>, &Standing)> {
        let run = &self.group[self.runs[lane]];
        self.stacks[run.stack].standing.as_ref().ok().map(|standing| (run, standing))
    }
}

impl<'a, R: Real> lanes::Batch<'a, Planar<R>> for Batch<'a, '_, R> {
    type Drive = &'a Ground;

    fn next(&mut self, lane: usize) -> Option<Case<'a, Planar, &'a Ground>> {
        let run = self.group.get(self.next).filter(|_| !self.interrupted)?;
        self.runs[lane] = self.next;
        self.next += 1;
        let standing = self.stacks[run.stack].standing.as_ref().ok()?;
        Some(Case {
            model: &standing.assembly.model,
            state: standing.state.clone(),
            drive: &*run.case.ground,
            time_step: standing.step,
            end_time: run.end_time,
        })
    }

    fn start(&mut self, lane: usize, state: &State<Planar>, scratch: &Scratch<Planar>) {
        let Some((run, standing)) = self.standing(lane) else { return };
        let end = run.end(standing);
        let share = Share::new(run.end_time, run.case.ground.end());
        let rest = &standing.state;
        let mut fates = Fates::new(&standing.assembly, rest, thresholds(&run.case.scenario));
        fates.observe(state, scratch);
        let stresses = run.case.records_stresses.then(|| {
            let (assembly, model) = (&standing.assembly, &standing.assembly.model);
            let mut stresses = StressWatch::new(assembly, rest, &standing.scratch);
            stresses.observe(true, state, scratch, &|_| Some(model));
            stresses
        });
        let mut joints = Joints::new(&standing.assembly);
        joints.start(state.time, scratch);
        let mut trail = Trail::new(&standing.assembly);
        trail.see_state(state);
        self.due.put(lane, &trail.due());
        self.trails[lane] = trail;
        self.shares[lane] = Some(share);
        if let Some(stresses) = stresses {
            self.stresses.begin(lane, stresses);
        }
        self.joints.get_or_insert_with(|| Joints::in_all(&joints)).put(lane, &joints);
        self.fates.get_or_insert_with(|| Fates::in_all(&fates)).put(lane, &fates);
        self.end.get_or_insert_with(|| watch::End::in_all(&end)).put(lane, &end);
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn observe(&mut self, state: &State<Planar<R>>, scratch: &Scratch<Planar<R>>) -> R::Mask {
        self.steps += 1;
        if self.steps == PATIENCE {
            self.steps = 0;
            for (lane, share) in self.shares.iter_mut().enumerate() {
                if let Some(share) = share {
                    share.reached(state.time.lane(lane));
                }
            }
            if (self.audience.stop)() {
                self.interrupted = true;
                return !R::Mask::default();
            }
        }
        let (Some(fates), Some(joints), Some(end)) =
            (&mut self.fates, &mut self.joints, &mut self.end)
        else {
            return R::Mask::default();
        };
        let standing = fates.stands();
        fates.observe(state, scratch);
        joints.observe(state.time, standing, scratch);
        let (group, stacks, runs) = (self.group, self.stacks, &self.runs);
        let model = |lane: usize| {
            let stack = &stacks[group[runs[lane]].stack];
            stack.standing.as_ref().ok().map(|standing| &standing.assembly.model)
        };
        self.stresses.observe(standing, state, scratch, &model);
        let (collapsed, rested) = end.observe(state, fates);
        self.rested = rested;
        let ended = collapsed | rested;
        // Lanes without a case also count as ended, but their next sample is never due.
        let due = self.due.le(state.time) | (ended & self.due.lt(R::splat(f64::INFINITY)));
        if due.any() {
            for lane in (0..R::LANES).filter(|lane| due.lane(*lane)) {
                let trail = &mut self.trails[lane];
                trail.see(state.time.lane(lane), |body| state.poses[body].of_lane(lane));
                self.due.put(lane, &trail.due());
            }
        }
        ended
    }

    fn end(&mut self, lane: usize, end: End) {
        let (Some(fates), Some(joints), false) = (&self.fates, &self.joints, self.interrupted)
        else {
            return;
        };
        let (fates, joints) = (fates.of_lane(lane), joints.of_lane(lane));
        let stresses = self.stresses.finish(lane);
        // A lane without a case does not move and is not sampled.
        self.due.put(lane, &f64::INFINITY);
        let trail = std::mem::take(&mut self.trails[lane]);
        let Some((run, standing)) = self.standing(lane) else { return };
        let ending = match &end.finish {
            Ok(Finish::Stopped) if self.rested.lane(lane) => Ending::Rest,
            Ok(Finish::Stopped) => Ending::AfterCollapse,
            Ok(Finish::EndTime) => Ending::of_time(&run.case.scenario),
            Err(_) => Ending::Broken,
        };
        let ended = end.finish.map(|_| Ended { energy: end.energy, steps: end.steps });
        let (assembly, ground) = (&standing.assembly, &*run.case.ground);
        let verdict = conclude(assembly, ground, &fates, ended, end.time, ending);
        let observed = Observed { fates: &fates, stresses: &stresses, joints: &joints, trail };
        let result = CaseResult::of(assembly, ground, observed, verdict, end.time);
        let index = run.index;
        if let Some(share) = self.shares[lane].take() {
            share.end(end.time);
        }
        (self.audience.on_case)(&result);
        self.results.push((index, result));
    }
}
