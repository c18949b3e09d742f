//! Variants of a stack, run together, so that every answer is a distribution.
//!
//! Collapse is chaotic and friction is poorly known, so a single run proves little. A stack is
//! therefore run as stated (number 0) and in variants (numbered from 1) that differ in unavoidable
//! imperfections and in uncertain parameters ([`Imperfections`](crate::scenario::Imperfections)),
//! in one plane or in both.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use barrelstack::{Scenario, variants};
//!
//! let changes = ["imperfections.variants=4", "stack.levels=2", "run.duration='6 s'"];
//! let scenario = Scenario::builtin("candia-8-barrels", &changes.map(str::to_owned))?;
//! let planes = variants::planes(&scenario)?;
//! let found = variants::run(&planes, &|_, _| ControlFlow::Continue(()))?;
//! let spread = found.and_then(|all| all.into_iter().next()).map(|one| one.spread);
//! assert_eq!(spread.map(|spread| (spread.variants, spread.collapsed)), Some((4, 4)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod advice;
mod answer;
mod decides;
mod draw;
mod remedy;
mod spread;
mod typical;
pub mod words;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::ensemble::{CaseResult, Ensemble, Prepared};
use crate::ground::{Ground, GroundError, from_disk, other_component};
use crate::outcome::Outcome;
use crate::scenario::{MotionSource, MotionSpec, Scenario, Scene, Until, View};
use crate::watch::after_collapse;

pub use answer::{
    Advance, Answer, RunCases, RunChoice, Shown, answer, answer_of, run_with_first_verdict,
};
pub(crate) use answer::{common_number, run_together};
pub use decides::{Constant, Fitted, ShareAt, Unknown};
pub use remedy::{
    AsItIs, Attempt, ENOUGH, Judged, Observer, PRETENSIONS, Remedy, RunCounter, Trial, Tried,
    Verdicts, lowered, remedy, remedy_by, strapped_together,
};
pub use spread::{FEW, LEVEL, Range, Spread, verdict};

/// A scenario in one plane, with all its variants.
#[derive(Clone, Debug)]
pub struct Plane {
    /// The nominal case.
    pub scenario: Scenario,
    /// Motion of the second half of the variants, with the other horizontal component. `None` if the stack is not
    /// analyzed in both planes, or if the motion has no other horizontal component.
    exchanged: Option<MotionSpec>,
}

/// Returns the planes in which a scenario is analyzed, the plane across the barrels first.
///
/// Unless the scenario has a stack that is analyzed in both planes, there is only one [`Plane`]. If there are two, each
/// has its own horizontal component of the record; the plane across the barrels has the component that the scenario
/// states. In the second half of the variants, the components are exchanged, as in a stack turned by a right angle.
///
/// # Errors
/// When the motion cannot be read.
pub fn planes(scenario: &Scenario) -> Result<Vec<Plane>, GroundError> {
    let scenario = &scenario.with_records(&mut from_disk)?;
    let both = scenario.stack().and_then(|stack| Some((stack.across()?, stack.along()?)));
    let Some((across, along)) = both else {
        return Ok(vec![Plane { scenario: scenario.clone(), exchanged: None }]);
    };
    let other = other_component(&scenario.motion)?;
    let plane = |plane, motion: MotionSpec, exchanged| {
        let mut scenario = scenario.clone();
        scenario.motion = motion;
        if let Scene::Stack { stack, .. } = &mut scenario.scene {
            *stack = plane;
        }
        Plane { scenario, exchanged }
    };
    let own = &scenario.motion;
    let turned = other.as_ref().map(|_| own.clone());
    Ok(vec![
        plane(across, own.clone(), other.clone()),
        plane(along, other.unwrap_or_else(|| own.clone()), turned),
    ])
}

impl Plane {
    /// Returns the plane; `None` for a free scene.
    pub fn view(&self) -> Option<View> {
        self.scenario.stack().map(|stack| stack.view)
    }

    /// Returns the number of variants, not counting the nominal case.
    pub fn count(&self) -> u32 {
        self.scenario.imperfections().map_or(0, |imperfections| imperfections.variants)
    }

    /// Returns the numbers of the nominal case (0) and of all variants.
    pub fn numbers(&self) -> Vec<u32> {
        (0..=self.count()).collect()
    }

    /// Returns the scenario of the variant with this number; 0 is the nominal case.
    pub fn variant(&self, number: u32) -> Scenario {
        if number == 0 {
            return self.scenario.clone();
        }
        let mut variant = draw::variant(&self.scenario, number);
        variant.motion = self.motion(number).clone();
        variant
    }

    /// Returns the scenario of a variant for a run from which only the verdict is needed. Such a run may end before
    /// everything has come to rest.
    pub fn trial(&self, number: u32) -> Scenario {
        let mut trial = self.variant(number);
        if let (Until::Rest, Some(imperfections)) = (trial.run.until, trial.imperfections()) {
            trial.run.until = imperfections.until;
        }
        trial
    }

    /// Returns the time (s) after the first loss of a seat at which runs for the verdict ([`Plane::trial`]) end; `None`
    /// if they continue until everything is at rest.
    pub fn counted_for(&self) -> Option<f64> {
        Some(after_collapse(&self.trial(0))).filter(|time| time.is_finite())
    }

    /// Returns the motion of a variant by its number.
    fn motion(&self, number: u32) -> &MotionSpec {
        let exchanged = self.exchanged.as_ref().filter(|_| self.is_exchanged(number));
        exchanged.unwrap_or(&self.scenario.motion)
    }

    /// Returns the name of the horizontal component that the motion of a variant states; `None` for
    /// the default component and for motions without a record.
    fn component(&self, number: u32) -> Option<&str> {
        match &self.motion(number).source {
            MotionSource::Record(record) => record.component.as_deref(),
            MotionSource::Sine(_) | MotionSource::Pulse(_) | MotionSource::None => None,
        }
    }

    /// `true` if a variant belongs to the second half of the variants, in which the horizontal components of the
    /// record are exchanged.
    fn is_exchanged(&self, number: u32) -> bool {
        number > self.count().div_ceil(2)
    }

    /// Returns a warning if the planes share a record that has only one horizontal component.
    fn warning(&self, planes: usize) -> Option<String> {
        let recorded = matches!(self.scenario.motion.source, MotionSource::Record(_));
        (planes > 1 && recorded && self.exchanged.is_none()).then(|| {
            "the record has only one horizontal component: the same component shakes the stack across and along its \
             barrels"
                .to_owned()
        })
    }

    /// Prepares variants, given by number, for an ensemble.
    fn prepared(&self, numbers: &[u32]) -> Result<Vec<Prepared>, GroundError> {
        let own = Arc::new(self.scenario.ground()?);
        let exchanged = match &self.exchanged {
            Some(motion) => {
                let mut scenario = self.scenario.clone();
                scenario.motion = motion.clone();
                Some(Arc::new(scenario.ground()?))
            }
            None => None,
        };
        let ground = |number| -> &Arc<Ground> {
            exchanged.as_ref().filter(|_| self.is_exchanged(number)).unwrap_or(&own)
        };
        let case =
            |number| Prepared::shaken_by(Arc::new(self.trial(number)), Arc::clone(ground(number)));
        Ok(numbers.iter().copied().map(case).collect())
    }
}

/// Results of the variants of a stack in one plane.
#[derive(Clone, Debug)]
pub struct Variants {
    /// The plane; `None` for a free scene.
    pub view: Option<View>,
    /// Results of the nominal case, which comes first, and of its variants.
    pub results: Vec<CaseResult>,
    /// Statistics of the variants.
    pub spread: Spread,
}

/// Runs the nominal case and all variants in all planes, on all cores.
///
/// The observer receives the number of finished cases and the number of all cases, from several
/// threads. It may cancel, which returns `None`.
///
/// # Errors
/// When a motion cannot be read.
pub fn run(
    planes: &[Plane],
    observer: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Option<Vec<Variants>>, GroundError> {
    // All planes of a scenario have the same number of variants.
    let numbers = planes.first().map(Plane::numbers).unwrap_or_default();
    let results = run_some(planes, &numbers, observer)?;
    Ok(results.map(|results| together(planes, &numbers, results)))
}

/// Runs only the variants with the given numbers, but otherwise works like [`run`]; number 0 is the
/// nominal case.
///
/// Returns their results in each plane, in the order of the numbers, to be combined with results
/// computed elsewhere ([`together`]). Returns `None` if canceled.
///
/// # Errors
/// As [`run`].
pub fn run_some(
    planes: &[Plane],
    numbers: &[u32],
    observer: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Option<Vec<Vec<CaseResult>>>, GroundError> {
    let results = run_as_far(planes, numbers, observer)?;
    let whole = results.iter().flatten().all(|one| one.outcome != Ok(Outcome::Interrupted));
    Ok(whole.then_some(results))
}

/// Runs variants like [`run_some`], but returns results even if the computation is canceled; the unfinished variants
/// then have the outcome `Interrupted`.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_as_far(
    planes: &[Plane],
    numbers: &[u32],
    observer: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Vec<Vec<CaseResult>>, GroundError> {
    let mut cases = Vec::new();
    for plane in planes {
        cases.extend(plane.prepared(numbers)?);
    }
    let (done, of) = (AtomicUsize::new(0), cases.len());
    let count = |_: &CaseResult| observer(done.fetch_add(1, Ordering::Relaxed) + 1, of);
    let stop = || observer(done.load(Ordering::Relaxed), of).is_break();
    let ensemble = Ensemble { cases, ..Ensemble::default() };
    let results: Vec<CaseResult> = ensemble
        .run_as_far(&count, &stop)
        .into_iter()
        .map(|one| one.unwrap_or_else(CaseResult::interrupted))
        .collect();
    Ok(results.chunks(numbers.len().max(1)).map(<[CaseResult]>::to_vec).collect())
}

/// Computes the statistics of each plane from the results of its cases.
///
/// `results` holds, for each plane, one result for each of `numbers`, in the same order. The first number is 0, the
/// nominal case.
pub fn together(planes: &[Plane], numbers: &[u32], results: Vec<Vec<CaseResult>>) -> Vec<Variants> {
    let mut found = Vec::new();
    for (plane, results) in planes.iter().zip(results) {
        let Some(spread) = Spread::of(plane, &results) else { continue };
        found.push(Variants { view: plane.view(), results, spread });
    }
    let all: Vec<&[CaseResult]> = found.iter().map(|one| one.results.as_slice()).collect();
    let typical = typical::typical(&all, &|_| true);
    let number = |place: u32| numbers.get(place as usize).copied().unwrap_or(place);
    for Variants { spread, .. } in &mut found {
        spread.typical = number(typical);
        spread.gentlest = number(spread.gentlest);
        spread.worst = number(spread.worst);
    }
    found
}
