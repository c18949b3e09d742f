//! JSON document of a decision: SI units, probabilities from 0 to 1, rates per year.

use barrelstack::breakage::Breakage;
use barrelstack_fragility::{Contribution, Fall, Index, Interval, Rate, Stripe};
use barrelstack_report::described;

use super::curve::{BandKind, LimitCurve};
use super::hazard::{LimitRate, Lost, Site};
use super::loss::{Loss, Losses};
use super::measures::MeasureRow;
use super::modes::ModeIncidence;
use super::sensitivity::{Effect, Group, Level};
use super::{Cases, Decision, Sensitivity};

described! {
    /// Evaluation of a study. Intensities are in the SI unit of their measure.
    pub struct DecisionDocument of decision: &Decision {
        /// Name and version of the format of this document.
        pub schema: &'static str ["decision/1"] = "decision/1",
        /// Title of the study.
        pub title: String = decision.cases.title.clone(),
        /// Main result in a sentence.
        pub headline: String = decision.document.verdict.headline.clone(),
        /// Number of cases with a verdict.
        pub cases: usize = decision.cases.all.len(),
        /// Number of cases without a verdict.
        pub cases_without_verdict: usize = decision.cases.left_out,
        /// Names of the motions.
        pub records: Vec<String> = decision.cases.records.clone(),
        /// Intensity measure of the study.
        pub measure: NamedMeasure = NamedMeasure::of(decision.cases.measure()),
        /// Fragility of every limit state against the measure of the study.
        pub fragility: Vec<Fragility> = decision.curves.iter().map(Fragility::of).collect(),
        /// Efficiency of every intensity measure as a predictor of collapse, the best measure first.
        pub measures: Vec<MeasureEfficiency> =
            decision.measures.iter().map(|row| MeasureEfficiency::of(&(row, &decision.cases))).collect(),
        /// Incidence of each collapse mode, the most frequent first.
        pub modes: Vec<ModeShare> =
            decision.modes.iter().map(|mode| ModeShare::of(&(mode, &decision.curves[0]))).collect(),
        /// Number of cases that were simulated until nothing moved.
        pub followed_to_rest: u64 = decision.cases.endings.followed,
        /// Number of cases that were stopped a fixed time after their collapse.
        pub stopped_after_collapse: u64 = decision.cases.endings.stopped,
        /// Number of cases that were ended by `run.duration`.
        pub ended_by_duration: u64 = decision.cases.endings.short,
        /// Number of cases that were ended by `run.duration` while the ground still moved.
        pub cut_while_the_ground_moved: u64 = decision.cases.endings.cut,
        /// Number of cases in which a body still moved when the time limit was reached.
        pub still_moving_at_the_end: u64 = decision.cases.endings.moving,
        /// Reason why no losses are given; null if losses are given.
        pub no_losses: Option<String> = decision.losses.as_ref().err().cloned(),
        /// Barrels and wine lost at each level; null if unknown.
        pub losses: Option<LossTable> = decision.losses.as_ref().ok().map(LossTable::of),
        /// Sobol' indices of the varied quantities for every result; empty unless the design is "saltelli".
        pub sobol_indices: Vec<SobolIndices> =
            decision.sensitivities.iter().map(SobolIndices::of).collect(),
        /// Effects of the varied factors, the largest first.
        pub effects: Vec<FactorEffect> = decision.effects.iter().map(FactorEffect::of).collect(),
        /// Annual rates at the site; null without a hazard curve.
        pub site: Option<SiteRates> = decision.site.as_ref().map(SiteRates::of),
        /// Warnings.
        pub warnings: Vec<String> = decision.warnings.clone(),
    }

    /// Name and unit of an intensity measure.
    pub struct NamedMeasure of measure: &super::Measure {
        /// Name of the measure.
        pub name: String = measure.name.clone(),
        /// SI unit of the measure.
        pub unit: String = measure.unit.clone(),
    }

    /// Fragility of one limit state.
    pub struct Fragility of curve: &LimitCurve {
        /// Name of the limit state.
        pub limit_state: String = curve.limit.name(),
        /// Numbers of cases and failures at every level or in every bin.
        pub raw: Vec<RawShare> = raw(&curve.stripes, &curve.intervals),
        /// Median of the lognormal curve; null if the data determine no curve.
        pub median: Option<f64> as "of the measure" =
            curve.fit.as_ref().ok().map(|fit| fit.curve.median),
        /// Dispersion of the curve: standard deviation of the logarithm of the intensity at failure.
        pub dispersion: Option<f64> as "1" = curve.fit.as_ref().ok().map(|fit| fit.curve.dispersion),
        /// Standard error of the logarithm of the median. It is computed by jackknife over records if `band`
        /// is "jackknife over records", otherwise for independent cases.
        pub ln_median_standard_error: Option<f64> as "1" = curve.standard_errors().ok().and_then(|[median, _]| finite(median)),
        /// Standard error of the logarithm of the dispersion, by the same method as for the median.
        pub ln_dispersion_standard_error: Option<f64> as "1" = curve.standard_errors().ok().and_then(|[_, dispersion]| finite(dispersion)),
        /// 95 % interval of the median; an unbounded end is null.
        pub median_interval: Option<[Option<f64>; 2]> as "of the measure" =
            curve.median.filter(|_| curve.fit.is_ok()).map(bounds),
        /// Reason why no curve could be fitted; null if there is a curve.
        pub no_curve: Option<String> = curve.fit.as_ref().err().map(ToString::to_string),
        /// Method by which the confidence band was computed.
        pub band: &'static str ["jackknife over records", "profile likelihood", "none"] =
            match curve.band_kind {
                BandKind::Records => "jackknife over records",
                BandKind::Likelihood => "profile likelihood",
                BandKind::None => "none",
            },
        /// 95 % confidence band of the curve, at a series of intensities.
        pub band_at: Vec<BandAt> = curve.grid.iter().zip(&curve.band).map(|at| BandAt::of(&at)).collect(),
        /// p-value of the goodness-of-fit test: the probability that data fit worse than these if the curve
        /// is true.
        pub goodness_p: Option<f64> as "1" =
            curve.goodness.filter(|test| test.freedom > 0).map(|test| test.p),
        /// p-value of the test of monotonicity: the probability of decreases as large as these if failure never becomes
        /// less likely with intensity.
        pub monotone_p: Option<f64> as "1" = finite(curve.monotony.p),
        /// Ranges of intensity over which the fraction of failures decreases.
        pub falls: Vec<FallBetween> = curve.monotony.falls.iter().map(FallBetween::of).collect(),
        /// Number of curves on which the stack fails at one intensity and stands at a higher intensity; each curve is
        /// for one motion.
        pub returned: usize = curve.returned.len(),
    }

    /// Numbers of cases and failures at one level.
    pub struct RawShare of at: &(&Stripe, &Interval) {
        /// Intensity of the level.
        pub intensity: f64 as "of the measure" = at.0.intensity,
        /// Number of cases.
        pub cases: u32 = at.0.cases,
        /// Number of cases that reached the limit state.
        pub failures: u32 = at.0.failures,
        /// 95 % interval of the probability, by Wilson's method.
        pub interval: [Option<f64>; 2] as "1" = bounds(*at.1),
    }

    /// Confidence band of a curve at one intensity.
    pub struct BandAt of at: &(&f64, &Interval) {
        /// Intensity.
        pub intensity: f64 as "of the measure" = *at.0,
        /// 95 % interval of the probability.
        pub interval: [Option<f64>; 2] as "1" = bounds(*at.1),
    }

    /// Two levels between which the fraction of failures decreases.
    pub struct FallBetween of fall: &Fall {
        /// Intensity of the lower level.
        pub from: f64 as "of the measure" = fall.from.intensity,
        /// Intensity of the higher level.
        pub to: f64 as "of the measure" = fall.to.intensity,
        /// p-value: the probability of such a decrease if failure never becomes less likely with intensity.
        pub p: f64 as "1" = fall.p,
    }

    /// Efficiency of an intensity measure as a predictor of collapse.
    pub struct MeasureEfficiency of row: &(&MeasureRow, &Cases) {
        /// Name of the measure.
        pub measure: String = row.1.measures[row.0.measure].name.clone(),
        /// SI unit of the measure.
        pub unit: String = row.1.measures[row.0.measure].unit.clone(),
        /// Median intensity at collapse; null if no curve can be fitted.
        pub median: Option<f64> as "of the measure" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.curve.median),
        /// Dispersion: standard deviation of the logarithm of the intensity at collapse.
        pub dispersion: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.curve.dispersion),
        /// Logarithm of the likelihood of the fitted curve.
        pub ln_likelihood: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.ln_likelihood),
        /// Concordance: of all pairs of a collapsed and a standing case, the share in which the collapsed
        /// case has the higher intensity.
        pub concordance: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().and_then(|found| finite(found.concordance)),
        /// Name of the other measure against which sufficiency was tested.
        pub beside: Option<String> = row.0.beside.map(|at| row.1.measures[at].name.clone()),
        /// p-value of the hypothesis that the measure named in `beside` adds no information on collapse.
        pub sufficiency_p: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().and_then(|found| found.sufficiency),
        /// Reason why no curve could be fitted; null if there is a curve.
        pub no_curve: Option<String> = row.0.collapse.as_ref().err().map(ToString::to_string),
        /// Slope of the regression of ln drift on ln intensity, for stacks that stand.
        pub drift_slope: Option<f64> as "1" = row.0.drift.map(|found| found.slope),
        /// Standard deviation of ln drift about the regression line with the slope `drift_slope`.
        pub drift_dispersion: Option<f64> as "1" = row.0.drift.map(|found| found.dispersion),
        /// p-value of the hypothesis that the measure named in `beside` adds no information on the drift.
        pub drift_sufficiency_p: Option<f64> as "1" = row.0.drift.and_then(|found| found.sufficiency),
    }

    /// Incidence of one mode of collapse.
    pub struct ModeShare of mode: &(&ModeIncidence, &LimitCurve) {
        /// Name of the mode.
        pub mode: String = mode.0.mode.clone(),
        /// Numbers of cases, and of collapses in this mode, at every level.
        pub raw: Vec<RawShare> = raw(&mode.0.stripes, &mode.0.intervals),
        /// Cumulative incidence: the probability of collapse in this mode.
        pub cumulative_incidence_at: Vec<ChanceAt> =
            mode.1.grid.iter().zip(&mode.0.fitted).map(|at| ChanceAt::of(&at)).collect(),
    }

    /// Probability at one intensity.
    pub struct ChanceAt of at: &(&f64, &f64) {
        /// Intensity.
        pub intensity: f64 as "of the measure" = *at.0,
        /// Probability.
        pub chance: f64 as "1" = *at.1,
    }

    /// Losses of one stack.
    pub struct LossTable of losses: &Losses {
        /// Number of barrels in a stack.
        pub barrels: u32 = losses.barrels,
        /// Fall height at which half of the barrels burst, under the low, central and high assumptions about breakage.
        pub breakage_median_m: [f64; 3] as "m" = Breakage::RANGE.map(|breakage| breakage.median),
        /// Standard deviation of the logarithm of the fall height at which a barrel bursts, under the low, central and
        /// high assumption about breakage.
        pub breakage_dispersion: [f64; 3] as "1" = Breakage::RANGE.map(|breakage| breakage.dispersion),
        /// Losses at every level.
        pub levels: Vec<LossAt> = losses.levels.iter().map(LossAt::of).collect(),
    }

    /// Losses at one level.
    pub struct LossAt of loss: &Loss {
        /// Intensity of the level.
        pub intensity: f64 as "of the measure" = loss.intensity,
        /// Number of cases.
        pub cases: usize = loss.cases,
        /// Mean number of barrels that fall.
        pub barrels_fallen: f64 as "barrels" = loss.fallen,
        /// 95 % interval of the mean number of barrels that fall.
        pub barrels_fallen_interval: [Option<f64>; 2] as "barrels" = bounds(loss.interval),
        /// Mean number of barrels that burst, under the low, central and high assumptions about breakage.
        pub barrels_burst: [f64; 3] as "barrels" = loss.burst,
        /// Expected volume of wine lost in burst barrels, under the low, central and high assumptions about breakage.
        pub wine_lost_m3: [f64; 3] as "m3" = loss.wine,
        /// Mean number of barrels that burst, estimated from the largest force on each barrel; null if the study does
        /// not record forces.
        pub barrels_burst_by_force: Option<f64> as "barrels" = loss.burst_by_force,
    }

    /// Sobol' indices of the varied quantities for one result.
    pub struct SobolIndices of found: &Sensitivity {
        /// Name of the result.
        pub result: String = found.result.clone(),
        /// Number of blocks of cases that are evaluated.
        pub blocks: usize = found.blocks,
        /// Number of blocks that are left out because a case lacks the result.
        pub blocks_left_out: usize = found.left_out,
        /// Indices of every varied quantity.
        pub inputs: Vec<SobolIndex> = found.inputs.iter().map(SobolIndex::of).collect(),
    }

    /// Sobol' indices of one varied quantity.
    pub struct SobolIndex of input: &(String, Index) {
        /// Name of the quantity.
        pub input: String = input.0.clone(),
        /// First-order index, limited to the range from 0 to 1.
        pub first: f64 as "1" = input.1.first,
        /// 95 % interval of the first-order index, by jackknife over blocks; 0 to 1 if there are too few
        /// blocks.
        pub first_interval: [Option<f64>; 2] as "1" = bounds(input.1.first_interval),
        /// Total index, limited to the range from 0 to 1.
        pub total: f64 as "1" = input.1.total,
        /// 95 % interval of the total index, by the same method as for the first-order index.
        pub total_interval: [Option<f64>; 2] as "1" = bounds(input.1.total_interval),
    }

    /// Effect of a varied factor on collapse.
    pub struct FactorEffect of effect: &Effect {
        /// Name of the factor.
        pub factor: String = effect.factor.clone(),
        /// Counts of collapses, for each value of the factor or for each third of its values.
        pub groups: Vec<EffectGroup> = effect.groups.iter().map(EffectGroup::of).collect(),
    }

    /// Cases with the same value of a factor. If the factor has many values: one third of all cases, sorted by the
    /// value.
    pub struct EffectGroup of group: &Group {
        /// Values of the factor in the group, as text.
        pub value: String = group.label.clone(),
        /// Number of cases.
        pub cases: u32 = group.cases,
        /// Number of cases that collapse.
        pub collapsed: u32 = group.collapsed,
        /// 95 % interval of the share of cases that collapse: clustered by motion for one-at-a-time designs, otherwise
        /// by Wilson's method.
        pub interval: [Option<f64>; 2] as "1" = bounds(group.interval),
        /// Counts of collapses at each level, for one-at-a-time designs; empty otherwise.
        pub levels: Vec<EffectLevel> = group.levels.iter().map(EffectLevel::of).collect(),
    }

    /// Cases of one group of factor values, at one level of intensity.
    pub struct EffectLevel of level: &Level {
        /// Intensity of the level.
        pub intensity: f64 as "of the measure" = level.intensity,
        /// Number of cases.
        pub cases: u32 = level.cases,
        /// Number of cases that collapse.
        pub collapsed: u32 = level.collapsed,
        /// 95 % interval of the share of cases that collapse, clustered by motion.
        pub interval: [Option<f64>; 2] as "1" = bounds(level.interval),
    }

    /// Annual rates at a site.
    pub struct SiteRates of site: &Site {
        /// Name of the file of the hazard curve.
        pub hazard: String = site.hazard.file.clone(),
        /// Intensity measure of the hazard curve.
        pub measure: String = site.hazard.measure.clone(),
        /// Exposure time, for which the probabilities are given.
        pub years: f64 as "year" = site.years,
        /// Rate of every limit state.
        pub limit_states: Vec<LimitStateRate> = site.limits.iter().map(LimitStateRate::of).collect(),
        /// Barrels that fall per year; null if the study does not record falls.
        pub barrels_fallen_per_year: Option<YearlyRate> =
            site.lost.as_ref().map(|lost| YearlyRate::of(&lost.fallen)),
        /// Barrels that burst per year, under the low, central and high assumptions about breakage.
        pub barrels_burst_per_year: Option<Vec<YearlyRate>> =
            site.lost.as_ref().map(|lost: &Lost| lost.burst.iter().map(YearlyRate::of).collect()),
        /// Wine lost per year, under the low, central and high assumptions about breakage.
        pub wine_lost_m3_per_year: Option<[f64; 3]> as "m3/year" = site.lost.as_ref().map(|lost| lost.wine),
        /// Lower and upper estimate of the annual cost of the barrels that burst and of their wine, under the central
        /// assumption about breakage.
        pub money_lost_per_year: Option<[f64; 2]> as "US$/year" = site.lost.as_ref().map(|lost| lost.money),
        /// Contributions of ranges of intensity to the rate of collapse.
        pub contributions: Vec<RatePart> = site.contributions.iter().map(RatePart::of).collect(),
    }

    /// Rate at which a limit state is reached.
    pub struct LimitStateRate of limit: &LimitRate {
        /// Name of the limit state.
        pub limit_state: String = limit.limit.name(),
        /// Annual rate from the fitted curve; null without a curve.
        pub annual_rate: Option<YearlyRate> = limit.fitted.as_ref().map(YearlyRate::of),
        /// 95 % interval of the rate from the fitted curve.
        pub annual_rate_interval: Option<[Option<f64>; 2]> as "1/year" = limit.interval.map(bounds),
        /// Annual rate from the raw fractions.
        pub annual_rate_raw: YearlyRate = YearlyRate::of(&limit.raw),
        /// Probability that the limit state is reached at least once in the exposure time.
        pub chance: f64 as "1" = limit.chance,
    }

    /// Annual rate, as a lower and an upper bound. The bounds differ in the assumed effect of shaking beyond the hazard
    /// curve.
    pub struct YearlyRate of rate: &Rate {
        /// Rate if shaking stronger than that of the last row of the hazard curve has the same effect as the shaking of
        /// the last row.
        pub low: f64 as "1/year" = rate.low,
        /// Rate if shaking stronger than that of the last row of the hazard curve has the worst possible effect.
        pub high: f64 as "1/year" = rate.high,
        /// Expected effect (probability of failure, or number of barrels) at the intensity of the first row of the
        /// hazard curve.
        pub at_first_row: f64 as "1" = rate.at_first,
    }

    /// Contribution of a range of intensities to a rate.
    pub struct RatePart of part: &Contribution {
        /// Lower end of the range.
        pub from: f64 as "of the measure" = part.from,
        /// Upper end of the range.
        pub to: f64 as "of the measure" = part.to,
        /// Contribution to the rate.
        pub rate: f64 as "1/year" = part.rate,
    }
}

/// Returns a number if it is finite and `None` otherwise, since JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

pub(crate) fn bounds(interval: Interval) -> [Option<f64>; 2] {
    [finite(interval.low), finite(interval.high)]
}

fn raw(stripes: &[Stripe], intervals: &[Interval]) -> Vec<RawShare> {
    stripes.iter().zip(intervals).map(|at| RawShare::of(&at)).collect()
}
