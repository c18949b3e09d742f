//! JSON document of a study of safe heights, in SI units.

use barrelstack::variants::{Fitted, Unknown};
use barrelstack_fragility::Stripe;
use barrelstack_report::described;

use super::{AsRecorded, Height, Heights, known};
use crate::decision::{LimitCurve, bounds};

described! {
    /// Probability of collapse of stacks by height, direction and strength of shaking.
    pub struct HeightsDocument of all: &Heights {
        /// Name and version of the format of this document.
        pub schema: &'static str ["heights/1"] = "heights/1",
        /// Name of the rack in the catalog.
        pub rack: String = all.request.rack.clone(),
        /// Name of the barrel in the catalog.
        pub barrel: String = all.request.barrel.clone(),
        /// Seed of the synthetic motions and of the random friction.
        pub seed: u32 = all.request.seed,
        /// Number of motions under which every stack was run.
        pub motions: usize = all.motions,
        /// Total number of runs.
        pub runs: usize = all.runs,
        /// Number of runs without a verdict.
        pub runs_without_verdict: usize = all.left_out,
        /// Number of runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = all.fallen_at_rest,
        /// Main result in a sentence.
        pub headline: String = all.document.verdict.headline.clone(),
        /// Results of every height in every direction.
        pub heights: Vec<HeightRow> = all.heights.iter().map(HeightRow::of).collect(),
        /// Runs under the unscaled bundled record.
        pub as_recorded: Vec<RecordedRow> = all.recorded.iter().map(RecordedRow::of).collect(),
        /// Warnings.
        pub warnings: Vec<String> = all.warnings.clone(),
    }

    /// Run of a stack under the unscaled bundled record.
    pub struct RecordedRow of run: &AsRecorded {
        /// Number of levels of the stack.
        pub levels: u32 = run.levels,
        /// Direction of the shaking: across the barrels, along them, or three-dimensional.
        pub direction: &'static str ["transverse", "longitudinal", "spatial"] = run.direction.name(),
        /// Name of the horizontal component.
        pub motion: String = run.motion.clone(),
        /// `true` if the stack collapsed.
        pub collapsed: bool = run.collapsed,
        /// Share of the barrels that fell.
        pub fallen_share: f64 as "1" = run.fallen,
        /// Peak ground velocity.
        pub pgv: f64 as "m/s" = run.velocity,
        /// Peak ground acceleration.
        pub pga: f64 as "m/s2" = run.acceleration,
    }

    /// Results of stacks of one height, shaken in one direction.
    pub struct HeightRow of height: &Height {
        /// Number of levels of the stack.
        pub levels: u32 = height.levels,
        /// Direction of the shaking: across the barrels, along them, or three-dimensional with a horizontal direction
        /// that is drawn for every run.
        pub direction: &'static str ["transverse", "longitudinal", "spatial"] = height.direction.name(),
        /// Static margin: largest steady horizontal acceleration under which the stack stands, with the friction and
        /// the seats of the catalog; null if the stack stands at 1 g. For three-dimensional shaking it is the smaller
        /// of the margins across and along the barrels.
        pub static_margin: Option<f64> as "m/s2" = height.static_margin,
        /// Results at every level of shaking.
        pub at: Vec<LevelRow> = levels(height),
        /// Fragility curve against peak ground velocity (m/s).
        pub pgv: FittedCurve = FittedCurve::of(&height.by_velocity),
        /// Fragility curve against peak ground acceleration (m/s2).
        pub pga: FittedCurve = FittedCurve::of(&height.by_acceleration),
    }

    /// Results of stacks at one level of shaking.
    pub struct LevelRow of at: &(&Stripe, &f64, Option<&Fitted>) {
        /// Peak ground velocity.
        pub pgv: f64 as "m/s" = at.0.intensity,
        /// Number of runs with a verdict.
        pub cases: u32 = at.0.cases,
        /// Number of runs that collapse.
        pub collapsed: u32 = at.0.failures,
        /// Lower and upper bound of the probability of collapse. Each of them is a one-sided bound with 95 %
        /// confidence (Clopper and Pearson).
        pub interval: [Option<f64>; 2] as "1" = bounds(known(at.0)),
        /// Mean share of the barrels that fall.
        pub fallen_share: f64 as "1" = *at.1,
        /// Range that contains, with a probability of 95 %, the share of stacks that collapse, given the uncertain
        /// constants of the seats (friction, stiffness, damping) and the sampling error. Null if a run of this stack
        /// has no verdict, or if there are too few runs.
        pub range: Option<[f64; 2]> as "1" = at.2.map(|effect| effect.range),
        /// Share of stacks that collapse if all uncertain constants have their stated values; null if `range` is null.
        pub share_as_stated: Option<f64> as "1" = at.2.map(|effect| effect.as_stated),
        /// The uncertain constant with the largest effect on the share of stacks that collapse; null if no constant
        /// changes this share both significantly and by at least 20 percentage points.
        pub decides: Option<Unknown> = at.2.and_then(Fitted::decisive).cloned(),
    }

    /// Lognormal fragility curve of collapse.
    pub struct FittedCurve of curve: &LimitCurve {
        /// Intensity at which half of the stacks collapse; null if no curve can be fitted.
        pub median: Option<f64> as "of the intensity" =
            curve.fit.as_ref().ok().map(|fit| fit.curve.median),
        /// Standard deviation of the logarithm of the intensity at collapse.
        pub dispersion: Option<f64> as "1" = curve.fit.as_ref().ok().map(|fit| fit.curve.dispersion),
        /// 95 % interval of the median.
        pub median_interval: Option<[Option<f64>; 2]> as "of the intensity" =
            curve.median.filter(|_| curve.fit.is_ok()).map(bounds),
        /// Reason why no curve could be fitted; null if there is a curve.
        pub no_curve: Option<String> = curve.fit.as_ref().err().map(ToString::to_string),
    }
}

fn levels(height: &Height) -> Vec<LevelRow> {
    let curve = &height.by_velocity;
    let effects = height.effects.iter().map(Option::as_ref).chain(std::iter::repeat(None));
    let at = curve.stripes.iter().zip(&height.fallen).zip(effects);
    at.map(|((stripe, fallen), effect)| LevelRow::of(&(stripe, fallen, effect))).collect()
}
