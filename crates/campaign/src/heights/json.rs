//! The numbers of the page for programs, in SI units.

use barrelstack_fragility::Stripe;
use barrelstack_report::described;

use super::{AsRecorded, Height, Heights, known};
use crate::decision::{LimitCurve, bounds};

described! {
    /// Collapse of stacks by height.
    pub struct HeightsDocument of all: &Heights {
        /// Name and version of this layout.
        pub schema: &'static str ["heights/1"] = "heights/1",
        /// Rack of the catalog.
        pub rack: String = all.request.rack.clone(),
        /// Barrel of the catalog.
        pub barrel: String = all.request.barrel.clone(),
        /// Seed of motions and friction.
        pub seed: u32 = all.request.seed,
        /// Motions that shook every stack.
        pub motions: usize = all.motions,
        /// Runs in all.
        pub runs: usize = all.runs,
        /// Runs without a verdict.
        pub runs_without_verdict: usize = all.left_out,
        /// Runs whose stack fell under its own weight, before it was shaken; they count as collapsed.
        pub runs_fallen_at_rest: usize = all.fallen_at_rest,
        /// The answer in a sentence.
        pub headline: String = all.document.verdict.headline.clone(),
        /// Every height in every direction.
        pub heights: Vec<HeightRow> = all.heights.iter().map(HeightRow::of).collect(),
        /// The bundled record as it was recorded.
        pub as_recorded: Vec<RecordedRow> = all.recorded.iter().map(RecordedRow::of).collect(),
        /// Warnings.
        pub warnings: Vec<String> = all.warnings.clone(),
    }

    /// One run under the bundled record as it was recorded.
    pub struct RecordedRow of run: &AsRecorded {
        /// Levels of the stack.
        pub levels: u32 = run.levels,
        /// Direction of the shaking: across or along the barrels.
        pub direction: &'static str ["transverse", "longitudinal"] = run.view.name(),
        /// The component.
        pub motion: String = run.motion.clone(),
        /// `true` if it collapsed.
        pub collapsed: bool = run.collapsed,
        /// Share of its barrels that fell.
        pub fallen_share: f64 as "1" = run.fallen,
        /// Peak ground velocity.
        pub pgv: f64 as "m/s" = run.velocity,
        /// Peak ground acceleration.
        pub pga: f64 as "m/s2" = run.acceleration,
    }

    /// The stacks of one height in one direction.
    pub struct HeightRow of height: &Height {
        /// Levels of the stack.
        pub levels: u32 = height.levels,
        /// Direction of the shaking: across or along the barrels.
        pub direction: &'static str ["transverse", "longitudinal"] = height.view.name(),
        /// Steady horizontal acceleration that they bear at most, with the friction and the seats of the catalog; null
        /// where they bear 1 g.
        pub static_margin: Option<f64> as "m/s2" = height.static_margin,
        /// Results at every level of shaking.
        pub at: Vec<LevelRow> = levels(height),
        /// Collapse over peak ground velocity (m/s).
        pub pgv: FittedCurve = FittedCurve::of(&height.by_velocity),
        /// Collapse over peak ground acceleration (m/s2).
        pub pga: FittedCurve = FittedCurve::of(&height.by_acceleration),
    }

    /// Results of stacks at one level of shaking.
    pub struct LevelRow of at: &(&Stripe, &f64) {
        /// Peak ground velocity.
        pub pgv: f64 as "m/s" = at.0.intensity,
        /// Runs with a verdict.
        pub cases: u32 = at.0.cases,
        /// Runs that collapse.
        pub collapsed: u32 = at.0.failures,
        /// Ends of the chance of collapse, each of which holds with 95 % confidence (Clopper and Pearson).
        pub interval: [Option<f64>; 2] as "1" = bounds(known(at.0)),
        /// Mean share of the barrels that fall.
        pub fallen_share: f64 as "1" = *at.1,
    }

    /// A lognormal curve of the chance of collapse.
    pub struct FittedCurve of curve: &LimitCurve {
        /// Intensity at which half collapse; null where no curve can be fitted.
        pub median: Option<f64> as "of the intensity" =
            curve.fit.as_ref().ok().map(|fit| fit.curve.median),
        /// Standard deviation of the logarithm of the intensity at collapse.
        pub dispersion: Option<f64> as "1" = curve.fit.as_ref().ok().map(|fit| fit.curve.dispersion),
        /// 95 % interval of the median.
        pub median_interval: Option<[Option<f64>; 2]> as "of the intensity" =
            curve.median.filter(|_| curve.fit.is_ok()).map(bounds),
        /// Why there is no curve.
        pub no_curve: Option<String> = curve.fit.as_ref().err().map(ToString::to_string),
    }
}

fn levels(height: &Height) -> Vec<LevelRow> {
    let curve = &height.by_velocity;
    let at = curve.stripes.iter().zip(&height.fallen);
    at.map(|at| LevelRow::of(&at)).collect()
}
