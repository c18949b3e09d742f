//! Planning and collecting the runs of all cases and studies.

use barrelstack::run::Run;
use barrelstack::scenario::{Scale, Scenario};
use barrelstack::summary::Summary;

use super::cases::{Motion, PaperCases};
use super::neighborhood::{self, Kept};
use super::pool::{Done, Job};
use super::racks::{self, Tried};
use super::study::{self, Factor, Study, Subject};
use super::{ReproduceError, ensemble, vary};

/// Ratios of the paper's measured contact stiffness k and damping c to its calibrated values, which are 10 % (k) and
/// 16 % (c) greater than the measured values.
pub(super) const MEASURED: (f64, f64) = (1.0 / 1.10, 1.0 / 1.16);

/// All planned runs.
pub(super) struct Plan {
    /// The jobs, the longest first.
    pub(super) jobs: Vec<Job>,
    studies: Vec<(Subject, Vec<Factor>)>,
    /// Number of jobs that are run even without the studies. They come first in `jobs`.
    single: usize,
}

/// A completed case: the run with its recording, and its summary.
pub(super) struct Ran {
    /// The run.
    pub(super) run: Run,
    /// Summary of the run.
    pub(super) summary: Summary,
}

/// Results of all cases and studies.
pub(super) struct Results {
    /// The ground motion of the six barrels.
    pub(super) motion: Motion,
    /// Six barrels, rack–ground friction 0.4.
    pub(super) six: Ran,
    /// Six barrels, rack–ground friction 0.1.
    pub(super) slippery: Ran,
    /// Eight barrels at full scale.
    pub(super) eight: Ran,
    /// Eight barrels at half scale.
    pub(super) half: Ran,
    /// A stack of four levels in the longitudinal plane, along the barrel axes.
    pub(super) along: Ran,
    /// Eight barrels under the sine of opposite sign.
    pub(super) mirrored: Summary,
    /// Eight barrels with the measured contact parameters.
    pub(super) measured: Summary,
    /// Summaries of the eight barrels with contact parameters changed by 10 %, one for each member of the ensemble.
    pub(super) ensemble: Vec<Summary>,
    /// Results with other racks that also agree with the paper, one element per rack.
    pub(super) racks: Vec<Tried>,
    /// For each sampled rack near the reconstructed rack, the findings of the paper that it reproduces.
    pub(super) neighborhood: Vec<Kept>,
    /// Sensitivity studies of the cases; empty if the studies were left out.
    pub(super) studies: Vec<Study>,
}

impl Plan {
    /// Plans the runs of all cases, and of the studies if requested.
    pub(super) fn new(cases: &PaperCases, with_studies: bool) -> Self {
        let mut mirrored = cases.eight.clone();
        mirrored.motion.scale = Scale::Factor(-1.0);
        let measured = vary::with(&cases.eight, |stack| {
            vary::stiffness(stack, MEASURED.0);
            vary::damping(stack, MEASURED.1);
        });
        let job = |label: &str, scenario: &Scenario, keep| Job {
            label: label.to_owned(),
            scenario: scenario.clone(),
            keep,
        };
        let mut jobs = vec![
            job("six barrels on a slippery floor", &cases.slippery, true),
            job("four levels along the barrels", &cases.along, true),
            job("six barrels", &cases.six, true),
            job("eight barrels at half scale", &cases.half, true),
            job("eight barrels", &cases.eight, true),
            job("eight barrels, sine of opposite sign", &mirrored, false),
            job("eight barrels, measured parameters", &measured, false),
        ];
        let single = jobs.len();
        if !with_studies {
            return Self { jobs, studies: Vec::new(), single };
        }
        let mut subjects = vec![(Subject::Along, &cases.along), (Subject::Eight, &cases.eight)];
        // The study explains differences from the paper, which exist only under the paper's own motion.
        if cases.motion.is_papers() {
            subjects.insert(1, (Subject::Six, &cases.six));
        }
        let studies: Vec<(Subject, Vec<Factor>)> = subjects
            .into_iter()
            .map(|(subject, base)| (subject, study::factors(subject, base)))
            .collect();
        for (subject, factors) in &studies {
            jobs.extend(study::jobs(*subject, factors));
        }
        jobs.extend(ensemble::jobs(&cases.eight));
        jobs.extend(racks::jobs(cases));
        jobs.extend(neighborhood::jobs(cases));
        Self { jobs, studies, single }
    }

    /// Removes the studies, whose jobs come last.
    pub(super) fn leave_out_studies(&mut self) {
        self.jobs.truncate(self.single);
        self.studies.clear();
    }

    /// Collects the results of the jobs.
    pub(super) fn read(self, motion: Motion, done: Vec<Done>) -> Result<Results, ReproduceError> {
        let labels: Vec<String> = self.jobs.into_iter().map(|job| job.label).collect();
        let lost =
            |at: usize| ReproduceError::Lost { case: labels.get(at).cloned().unwrap_or_default() };
        let mut rest = done.into_iter();
        let mut singles = rest.by_ref().take(self.single).enumerate();
        let mut next = || singles.next().ok_or_else(|| lost(0));
        let ran = |(at, done): (usize, Done)| match done.run {
            Some(run) => Ok(Ran { run: *run, summary: done.summary }),
            None => Err(lost(at)),
        };
        let slippery = ran(next()?)?;
        let along = ran(next()?)?;
        let six = ran(next()?)?;
        let half = ran(next()?)?;
        let eight = ran(next()?)?;
        let mirrored = next()?.1.summary;
        let measured = next()?.1.summary;
        let mut summaries = rest.map(|done| done.summary);
        let mut studies: Vec<Study> = self
            .studies
            .into_iter()
            .map(|(subject, factors)| {
                let base = match subject {
                    Subject::Six => &six,
                    Subject::Eight => &eight,
                    Subject::Along => &along,
                };
                Study::new(subject, base.summary.clone(), factors, &mut summaries)
            })
            .collect();
        studies.sort_by_key(|study| study.subject);
        let ensemble = summaries.by_ref().take(ensemble::COUNT).collect();
        let racks = racks::read(motion.is_papers(), &mut summaries);
        let neighborhood = neighborhood::read(motion.is_papers(), &mut summaries);
        Ok(Results {
            motion,
            six,
            slippery,
            eight,
            half,
            along,
            mirrored,
            measured,
            ensemble,
            racks,
            neighborhood,
            studies,
        })
    }
}

impl Results {
    /// Returns the study of a case; `None` if it was not run.
    pub(super) fn study(&self, subject: Subject) -> Option<&Study> {
        self.studies.iter().find(|study| study.subject == subject)
    }
}
