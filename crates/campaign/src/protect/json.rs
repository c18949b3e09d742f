//! JSON document of a ranking of protections, in SI units.

use barrelstack_report::described;

use super::{Estimate, Ranked, Ranking, Shaking};

described! {
    /// Protections of a stack, ranked by effect and cost.
    pub struct ProtectDocument of all: &Ranking {
        /// Name and version of the format of this document.
        pub schema: &'static str ["protect/1"] = "protect/1",
        /// Title of the scenario.
        pub title: String = all.request.scenario.title.clone(),
        /// Peak ground velocities to which every motion was scaled.
        pub velocities: Vec<f64> as "m/s" = all.request.shaking.levels().to_vec(),
        /// Unit of the estimates: per event, in which all levels are equally likely, or per year at the site.
        pub per: &'static str ["event", "year"] = match all.request.shaking {
            Shaking::Levels(_) => "event",
            Shaking::Site(_) => "year",
        },
        /// Name of the file of the hazard curve; null if there is none.
        pub hazard: Option<String> = match &all.request.shaking {
            Shaking::Levels(_) => None,
            Shaking::Site(site) => Some(site.file.clone()),
        },
        /// Seed of the motions and of the random friction.
        pub seed: u32 = all.request.seed,
        /// Maximum cost of a protection of one stack; null if there is no limit.
        pub budget: Option<f64> as "US$" = all.request.budget,
        /// Number of protections that were tried, excluding the unprotected stack.
        pub tries: usize = all.tries(),
        /// Total number of runs.
        pub runs: usize = all.runs,
        /// Main result in a sentence.
        pub headline: String = all.document.verdict.headline.clone(),
        /// Name of the protection that saves the most barrels per dollar of its cost; null if no protection helps
        /// significantly.
        pub best: Option<String> = all.best().map(|one| one.protection.name.clone()),
        /// Every protection that was tried. They are sorted by the last round in which they were run, the latest round
        /// first, and then by the number of fallen barrels.
        pub protections: Vec<ProtectionRow> = all.all.iter().map(ProtectionRow::of).collect(),
        /// Protections that were not tried.
        pub not_tried: Vec<NotTried> = all.not_tried.iter().map(NotTried::of).collect(),
    }

    /// Results of one protection.
    pub struct ProtectionRow of one: &Ranked {
        /// Name of the protection.
        pub name: String = one.protection.name.clone(),
        /// Kind of the protection.
        pub kind: &'static str ["as-it-is", "height", "rack", "device", "pair"] = one.protection.kind.name(),
        /// Changes to the scenario, as overrides.
        pub changes: Vec<String> = one.protection.changes.clone(),
        /// Lower and upper cost for one stack.
        pub cost: [f64; 2] as "US$" = one.protection.cost,
        /// Source of the cost.
        pub cost_source: String = one.protection.source.clone(),
        /// Number of barrels that the protection requires to be stored elsewhere.
        pub barrels_moved: u32 = one.protection.moved,
        /// Probability of collapse, or number of collapses per year.
        pub collapse: Interval = Interval::of(&one.collapse),
        /// Range that contains `collapse` with a probability of 95 %, given the uncertain constants of the seats
        /// (friction, stiffness, damping) and the sampling error. Null if a run has no verdict, if there are too few
        /// runs, or if the protection was not run in all rounds.
        pub range: Option<[f64; 2]> as "that of `collapse`" = one.range,
        /// Share of the draws in which fewer barrels fall than with the unprotected stack. Each draw samples the uncertain
        /// constants, which are the same for both stacks, and the sampling error. Null if `range` is null or there are no
        /// uncertain constants.
        pub better_than_as_it_is: Option<f64> as "1" = one.better_than_as_it_is,
        /// Share of the draws in which fewer barrels fall than with the next protection of the list; computed like
        /// `better_than_as_it_is`.
        pub better_than_next: Option<f64> as "1" = one.better_than_next,
        /// Number of barrels that fall, per event or per year, according to `per`.
        pub barrels_fallen: Interval = Interval::of(&one.fallen),
        /// Number of barrels that burst under the central assumption, per event or per year, according to
        /// `per`.
        pub barrels_burst: Interval = Interval::of(&one.burst),
        /// Reduction in the number of fallen barrels compared with the unprotected stack, under the same motions; null
        /// for the unprotected stack.
        pub barrels_saved: Option<Interval> = one.saved.as_ref().map(Interval::of),
        /// The same reduction as in `barrels_saved`, with an interval that holds for all tried protections
        /// simultaneously (Bonferroni). This interval determines `best`. Null for the unprotected stack.
        pub barrels_saved_together: Option<Interval> = one.saved_together.as_ref().map(Interval::of),
        /// Number of barrels that fall in the worst state of maintenance; null if no such state was tried.
        pub barrels_fallen_when_worn: Option<Interval> = one.worn.as_ref().map(|(_, worn)| Interval::of(worn)),
        /// Description of the worst state of maintenance; null if no such state was tried.
        pub worn: Option<String> = one.worn.as_ref().map(|(words, _)| words.clone()),
        /// Direction of shaking in which more barrels fall.
        pub direction: &'static str ["transverse", "longitudinal", "spatial"] = one.direction.name(),
        /// Number of motions under which the protection was run.
        pub motions: usize = one.motions,
        /// Number of runs, in both directions.
        pub runs: usize = one.runs,
        /// Number of runs without a verdict.
        pub runs_without_verdict: usize = one.left_out,
        /// Number of runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = one.fallen_at_rest,
        /// Last round in which the protection was run.
        pub round: u32 = one.round,
        /// `true` if no other protection that was run in all rounds costs at most as much and loses fewer barrels.
        pub on_front: bool = one.on_front,
    }

    /// Mean and its 95 % interval. The interval is clustered by motion and allows for the small number of
    /// motions.
    pub struct Interval of estimate: &Estimate {
        /// Mean; null if no run has a verdict.
        pub mean: Option<f64> as "that of the field" = Some(estimate.mean).filter(|mean| mean.is_finite()),
        /// Lower end of the interval.
        pub low: f64 as "that of the field" = estimate.low,
        /// Upper end of the interval.
        pub high: f64 as "that of the field" = estimate.high,
    }

    /// A protection that was not tried.
    pub struct NotTried of one: &(String, String) {
        /// Name of the protection.
        pub name: String = one.0.clone(),
        /// Reason why the protection was not tried.
        pub reason: String = one.1.clone(),
    }
}
