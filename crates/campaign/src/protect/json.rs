//! The ranking for programs, in SI units.

use barrelstack_report::described;

use super::{Estimate, Ranked, Ranking, Shaking};

described! {
    /// Protections of a stack, ranked by effect and cost.
    pub struct ProtectDocument of all: &Ranking {
        /// Name and version of this layout.
        pub schema: &'static str ["protect/1"] = "protect/1",
        /// The stack.
        pub title: String = all.request.scenario.title.clone(),
        /// Peak ground velocities to which every motion was scaled.
        pub velocities: Vec<f64> as "m/s" = all.request.shaking.levels().to_vec(),
        /// Reference of the estimates: one event at these levels, all equally likely, or a year at the site.
        pub per: &'static str ["event", "year"] = match all.request.shaking {
            Shaking::Levels(_) => "event",
            Shaking::Site(_) => "year",
        },
        /// The file of the hazard; null without a site.
        pub hazard: Option<String> = match &all.request.shaking {
            Shaking::Levels(_) => None,
            Shaking::Site(site) => Some(site.file.clone()),
        },
        /// Seed of motions and friction.
        pub seed: u32 = all.request.seed,
        /// Most that a protection may cost for a stack.
        pub budget: Option<f64> as "US$" = all.request.budget,
        /// Number of protections tried, not counting the stack as it is.
        pub tries: usize = all.tries(),
        /// Runs in all.
        pub runs: usize = all.runs,
        /// The answer in a sentence.
        pub headline: String = all.document.verdict.headline.clone(),
        /// The one that saves most barrels for its cost; null where nothing helps beyond doubt.
        pub best: Option<String> = all.best().map(|one| one.protection.name.clone()),
        /// Every protection that was tried: those first that went furthest, of these the one under which fewest
        /// barrels fall.
        pub protections: Vec<ProtectionRow> = all.all.iter().map(ProtectionRow::of).collect(),
        /// Protections that were not tried.
        pub not_tried: Vec<NotTried> = all.not_tried.iter().map(NotTried::of).collect(),
    }

    /// One protection.
    pub struct ProtectionRow of one: &Ranked {
        /// Its name.
        pub name: String = one.protection.name.clone(),
        /// Kind of change.
        pub kind: &'static str ["as-it-is", "height", "rack", "device", "pair"] = one.protection.kind.name(),
        /// Its changes, as overrides of the scenario.
        pub changes: Vec<String> = one.protection.changes.clone(),
        /// Range of its cost for a stack.
        pub cost: [f64; 2] as "US$" = one.protection.cost,
        /// Where the cost comes from.
        pub cost_source: String = one.protection.source.clone(),
        /// Barrels that have to stand elsewhere.
        pub barrels_moved: u32 = one.protection.moved,
        /// Probability of collapse, or rate of collapse in a year.
        pub collapse: Interval = Interval::of(&one.collapse),
        /// Barrels that fall.
        pub barrels_fallen: Interval = Interval::of(&one.fallen),
        /// Barrels that burst, under the central assumption of falls.
        pub barrels_burst: Interval = Interval::of(&one.burst),
        /// Reduction of fallen barrels from the stack as it is, under the same motions; null for that stack.
        pub barrels_saved: Option<Interval> = one.saved.as_ref().map(Interval::of),
        /// The same with an interval that holds for all protections that were tried at once (Bonferroni), by which `best`
        /// is chosen; null for the stack as it is.
        pub barrels_saved_together: Option<Interval> = one.saved_together.as_ref().map(Interval::of),
        /// Barrels that fall when it is worst kept; null where that was not tried.
        pub barrels_fallen_when_worn: Option<Interval> = one.worn.as_ref().map(|(_, worn)| Interval::of(worn)),
        /// Description of the worn state.
        pub worn: Option<String> = one.worn.as_ref().map(|(words, _)| words.clone()),
        /// The direction of shaking in which more barrels fall.
        pub direction: &'static str ["transverse", "longitudinal"] = one.direction.name(),
        /// Motions under which it was run.
        pub motions: usize = one.motions,
        /// Runs in both directions.
        pub runs: usize = one.runs,
        /// Runs without a verdict.
        pub runs_without_verdict: usize = one.left_out,
        /// Runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = one.fallen_at_rest,
        /// The last round in which it was run.
        pub round: u32 = one.round,
        /// `true` if no protection tried in all rounds both costs no more and loses less.
        pub on_front: bool = one.on_front,
    }

    /// A mean and its 95 % interval, for which the runs of one motion go together and which is no narrower than so few
    /// motions allow.
    pub struct Interval of estimate: &Estimate {
        /// The mean; null where no run has a verdict.
        pub mean: Option<f64> as "that of the field" = Some(estimate.mean).filter(|mean| mean.is_finite()),
        /// From.
        pub low: f64 as "that of the field" = estimate.low,
        /// To.
        pub high: f64 as "that of the field" = estimate.high,
    }

    /// A protection that was not tried.
    pub struct NotTried of one: &(String, String) {
        /// Its name.
        pub name: String = one.0.clone(),
        /// Why.
        pub reason: String = one.1.clone(),
    }
}
