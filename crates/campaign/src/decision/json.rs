//! The numbers of a decision for programs: SI units, chances from 0 to 1, rates a year.

use barrelstack_fragility::{Contribution, Fall, Index, Interval, Rate, Stripe};
use barrelstack_report::described;

use super::curve::{BandKind, LimitCurve};
use super::hazard::{LimitRate, Lost, Site};
use super::loss::{Breakage, Loss, Losses};
use super::measures::MeasureRow;
use super::modes::ModeIncidence;
use super::sensitivity::{Effect, Group, Level};
use super::{Cases, Decision, Sensitivity};

described! {
    /// Results of a study. Intensities in the SI unit of their measure.
    pub struct DecisionDocument of decision: &Decision {
        /// Name and version of this layout.
        pub schema: &'static str ["decision/1"] = "decision/1",
        /// The title of the study.
        pub title: String = decision.cases.title.clone(),
        /// The answer in a sentence.
        pub headline: String = decision.document.verdict.headline.clone(),
        /// Cases with a verdict.
        pub cases: usize = decision.cases.all.len(),
        /// Cases without one.
        pub cases_without_verdict: usize = decision.cases.left_out,
        /// Names of the motions.
        pub records: Vec<String> = decision.cases.records.clone(),
        /// The intensity measure of the study.
        pub measure: NamedMeasure = NamedMeasure::of(decision.cases.measure()),
        /// A curve for every limit state, over that measure.
        pub fragility: Vec<Fragility> = decision.curves.iter().map(Fragility::of).collect(),
        /// Efficiency of every measure as a predictor of collapse, the best first.
        pub measures: Vec<MeasureEfficiency> =
            decision.measures.iter().map(|row| MeasureEfficiency::of(&(row, &decision.cases))).collect(),
        /// Share of each collapse mode, the most frequent first.
        pub modes: Vec<ModeShare> =
            decision.modes.iter().map(|mode| ModeShare::of(&(mode, &decision.curves[0]))).collect(),
        /// Cases that were followed until nothing moved.
        pub followed_to_rest: u64 = decision.cases.endings.followed,
        /// Cases that were stopped a while after their collapse.
        pub stopped_after_collapse: u64 = decision.cases.endings.stopped,
        /// Cases that were ended by run.duration.
        pub ended_by_duration: u64 = decision.cases.endings.short,
        /// Cases that were cut short while the ground still moved.
        pub cut_while_the_ground_moved: u64 = decision.cases.endings.cut,
        /// Cases in which something still moved when their time was over.
        pub still_moving_at_the_end: u64 = decision.cases.endings.moving,
        /// Why there are no losses.
        pub no_losses: Option<String> = decision.losses.as_ref().err().cloned(),
        /// Barrels and wine lost.
        pub losses: Option<LossTable> = decision.losses.as_ref().ok().map(LossTable::of),
        /// Sobol indices of the varied quantities for every result; empty unless the design is made for them.
        pub sobol_indices: Vec<SobolIndices> =
            decision.sensitivities.iter().map(SobolIndices::of).collect(),
        /// Effects of the varied factors, the largest first.
        pub effects: Vec<FactorEffect> = decision.effects.iter().map(FactorEffect::of).collect(),
        /// Rates at the site; null without a hazard curve.
        pub site: Option<SiteRates> = decision.site.as_ref().map(SiteRates::of),
        /// Warnings.
        pub warnings: Vec<String> = decision.warnings.clone(),
    }

    /// An intensity measure.
    pub struct NamedMeasure of measure: &super::Measure {
        /// Its name.
        pub name: String = measure.name.clone(),
        /// Its unit.
        pub unit: String = measure.unit.clone(),
    }

    /// The fragility of a limit state.
    pub struct Fragility of curve: &LimitCurve {
        /// The limit state.
        pub limit_state: String = curve.limit.name(),
        /// Raw counts at every level.
        pub raw: Vec<RawShare> = raw(&curve.stripes, &curve.intervals),
        /// Median of the lognormal curve; null where the data support none.
        pub median: Option<f64> as "of the measure" =
            curve.fit.as_ref().ok().map(|fit| fit.curve.median),
        /// Standard deviation of the logarithm.
        pub dispersion: Option<f64> as "1" = curve.fit.as_ref().ok().map(|fit| fit.curve.dispersion),
        /// Standard error of the logarithm of the median: cases of one record go together (jackknife over records) where
        /// `band` says so, and are taken as independent elsewhere.
        pub ln_median_standard_error: Option<f64> as "1" = curve.standard_errors().ok().and_then(|[median, _]| finite(median)),
        /// Standard error of the logarithm of the dispersion, likewise.
        pub ln_dispersion_standard_error: Option<f64> as "1" = curve.standard_errors().ok().and_then(|[_, dispersion]| finite(dispersion)),
        /// 95 % interval of the median; an end is null where it is not bounded.
        pub median_interval: Option<[Option<f64>; 2]> as "of the measure" =
            curve.median.filter(|_| curve.fit.is_ok()).map(bounds),
        /// Why there is no curve.
        pub no_curve: Option<String> = curve.fit.as_ref().err().map(ToString::to_string),
        /// Method of the band.
        pub band: &'static str ["jackknife over records", "profile likelihood", "none"] =
            match curve.band_kind {
                BandKind::Records => "jackknife over records",
                BandKind::Likelihood => "profile likelihood",
                BandKind::None => "none",
            },
        /// The 95 % band of the curve.
        pub band_at: Vec<BandAt> = curve.grid.iter().zip(&curve.band).map(|at| BandAt::of(&at)).collect(),
        /// Chance of data that fit the curve worse than these.
        pub goodness_p: Option<f64> as "1" =
            curve.goodness.filter(|test| test.freedom > 0).map(|test| test.p),
        /// Chance of falls as large as these if more shaking never does less.
        pub monotone_p: Option<f64> as "1" = finite(curve.monotony.p),
        /// Where more shaking did less.
        pub falls: Vec<FallBetween> = curve.monotony.falls.iter().map(FallBetween::of).collect(),
        /// Motions that brought a stack down at one level and not at a higher one.
        pub returned: usize = curve.returned.len(),
    }

    /// Raw counts at one level.
    pub struct RawShare of at: &(&Stripe, &Interval) {
        /// The level.
        pub intensity: f64 as "of the measure" = at.0.intensity,
        /// Cases.
        pub cases: u32 = at.0.cases,
        /// Cases that reached the limit state.
        pub failures: u32 = at.0.failures,
        /// 95 % interval of the chance (Wilson).
        pub interval: [Option<f64>; 2] as "1" = bounds(*at.1),
    }

    /// The band of a curve at one intensity.
    pub struct BandAt of at: &(&f64, &Interval) {
        /// The intensity.
        pub intensity: f64 as "of the measure" = *at.0,
        /// The band of the chance.
        pub interval: [Option<f64>; 2] as "1" = bounds(*at.1),
    }

    /// Two levels of which the higher did less.
    pub struct FallBetween of fall: &Fall {
        /// The lower level.
        pub from: f64 as "of the measure" = fall.from.intensity,
        /// The higher one.
        pub to: f64 as "of the measure" = fall.to.intensity,
        /// Chance of such a fall if more shaking never does less.
        pub p: f64 as "1" = fall.p,
    }

    /// Efficiency of a measure as a predictor of collapse.
    pub struct MeasureEfficiency of row: &(&MeasureRow, &Cases) {
        /// The measure.
        pub measure: String = row.1.measures[row.0.measure].name.clone(),
        /// Its unit.
        pub unit: String = row.1.measures[row.0.measure].unit.clone(),
        /// Median at collapse; null where no curve can be fitted.
        pub median: Option<f64> as "of the measure" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.curve.median),
        /// Standard deviation of the logarithm.
        pub dispersion: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.curve.dispersion),
        /// Logarithm of the likelihood.
        pub ln_likelihood: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().map(|found| found.fit.ln_likelihood),
        /// Share of pairs that it puts in the right order.
        pub concordance: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().and_then(|found| finite(found.concordance)),
        /// Other measure against which sufficiency was tested.
        pub beside: Option<String> = row.0.beside.map(|at| row.1.measures[at].name.clone()),
        /// p-value of the hypothesis that the other measure adds nothing on collapse.
        pub sufficiency_p: Option<f64> as "1" =
            row.0.collapse.as_ref().ok().and_then(|found| found.sufficiency),
        /// Why there is no curve.
        pub no_curve: Option<String> = row.0.collapse.as_ref().err().map(ToString::to_string),
        /// Slope of the logarithm of the drift of stacks that stand.
        pub drift_slope: Option<f64> as "1" = row.0.drift.map(|found| found.slope),
        /// Scatter about it.
        pub drift_dispersion: Option<f64> as "1" = row.0.drift.map(|found| found.dispersion),
        /// p-value of the hypothesis that the other measure adds nothing on the drift.
        pub drift_sufficiency_p: Option<f64> as "1" = row.0.drift.and_then(|found| found.sufficiency),
    }

    /// One mode of collapse.
    pub struct ModeShare of mode: &(&ModeIncidence, &LimitCurve) {
        /// The mode.
        pub mode: String = mode.0.mode.clone(),
        /// Raw counts at every level.
        pub raw: Vec<RawShare> = raw(&mode.0.stripes, &mode.0.intervals),
        /// Cumulative incidence: the chance of collapse in this mode.
        pub cumulative_incidence_at: Vec<ChanceAt> =
            mode.1.grid.iter().zip(&mode.0.fitted).map(|at| ChanceAt::of(&at)).collect(),
    }

    /// A chance at one intensity.
    pub struct ChanceAt of at: &(&f64, &f64) {
        /// The intensity.
        pub intensity: f64 as "of the measure" = *at.0,
        /// The chance.
        pub chance: f64 as "1" = *at.1,
    }

    /// Losses.
    pub struct LossTable of losses: &Losses {
        /// Barrels of a stack.
        pub barrels: u32 = losses.barrels,
        /// Fall height at which half of the barrels burst, under three assumptions.
        pub breakage_median_m: [f64; 3] as "m" = Breakage::RANGE.map(|breakage| breakage.median),
        /// Standard deviation of its logarithm.
        pub breakage_dispersion: [f64; 3] as "1" = Breakage::RANGE.map(|breakage| breakage.dispersion),
        /// At every level.
        pub levels: Vec<LossAt> = losses.levels.iter().map(LossAt::of).collect(),
    }

    /// Losses at one level.
    pub struct LossAt of loss: &Loss {
        /// The level.
        pub intensity: f64 as "of the measure" = loss.intensity,
        /// Cases.
        pub cases: usize = loss.cases,
        /// Mean number of barrels that fall.
        pub barrels_fallen: f64 as "barrels" = loss.fallen,
        /// Its 95 % interval.
        pub barrels_fallen_interval: [Option<f64>; 2] as "barrels" = bounds(loss.interval),
        /// Mean number of barrels that burst, under each assumption.
        pub barrels_burst: [f64; 3] as "barrels" = loss.burst,
        /// Wine lost in them, under each assumption.
        pub wine_lost_m3: [f64; 3] as "m3" = loss.wine,
        /// Mean number of barrels that burst, by the largest force on them; null where the study does not record forces.
        pub barrels_burst_by_force: Option<f64> as "barrels" = loss.burst_by_force,
    }

    /// Sobol indices of the varied quantities for one result.
    pub struct SobolIndices of found: &Sensitivity {
        /// The result.
        pub result: String = found.result.clone(),
        /// Blocks of cases that count.
        pub blocks: usize = found.blocks,
        /// Blocks that lack a verdict.
        pub blocks_left_out: usize = found.left_out,
        /// Every varied quantity.
        pub inputs: Vec<SobolIndex> = found.inputs.iter().map(SobolIndex::of).collect(),
    }

    /// One varied quantity.
    pub struct SobolIndex of input: &(String, Index) {
        /// Its name.
        pub input: String = input.0.clone(),
        /// First-order index, cut to 0 and 1.
        pub first: f64 as "1" = input.1.first,
        /// Its 95 % interval (jackknife over blocks); 0 to 1 where the blocks are too few to say more.
        pub first_interval: [Option<f64>; 2] as "1" = bounds(input.1.first_interval),
        /// Total index, cut to 0 and 1.
        pub total: f64 as "1" = input.1.total,
        /// Its 95 % interval, likewise.
        pub total_interval: [Option<f64>; 2] as "1" = bounds(input.1.total_interval),
    }

    /// Effect of a varied factor.
    pub struct FactorEffect of effect: &Effect {
        /// The factor.
        pub factor: String = effect.factor.clone(),
        /// Collapse by groups of its values.
        pub groups: Vec<EffectGroup> = effect.groups.iter().map(EffectGroup::of).collect(),
    }

    /// Cases with neighboring values of a factor.
    pub struct EffectGroup of group: &Group {
        /// The values.
        pub value: String = group.label.clone(),
        /// Cases.
        pub cases: u32 = group.cases,
        /// Cases that collapse.
        pub collapsed: u32 = group.collapsed,
        /// 95 % interval of the share (Wilson); of one change at a time the cases of one motion go together.
        pub interval: [Option<f64>; 2] as "1" = bounds(group.interval),
        /// The same at each level, where one thing is changed at a time.
        pub levels: Vec<EffectLevel> = group.levels.iter().map(EffectLevel::of).collect(),
    }

    /// Cases with neighboring values of a factor at one level.
    pub struct EffectLevel of level: &Level {
        /// The level.
        pub intensity: f64 as "of the measure" = level.intensity,
        /// Cases.
        pub cases: u32 = level.cases,
        /// Cases that collapse.
        pub collapsed: u32 = level.collapsed,
        /// 95 % interval of the share, for which the cases of one motion go together.
        pub interval: [Option<f64>; 2] as "1" = bounds(level.interval),
    }

    /// Rates at a site.
    pub struct SiteRates of site: &Site {
        /// File of the hazard curve.
        pub hazard: String = site.hazard.file.clone(),
        /// Its measure.
        pub measure: String = site.hazard.measure.clone(),
        /// Years for which chances are given.
        pub years: f64 as "year" = site.years,
        /// Every limit state.
        pub limit_states: Vec<LimitStateRate> = site.limits.iter().map(LimitStateRate::of).collect(),
        /// Barrels that fall.
        pub barrels_fallen_per_year: Option<YearlyRate> =
            site.lost.as_ref().map(|lost| YearlyRate::of(&lost.fallen)),
        /// Barrels that burst, under each assumption.
        pub barrels_burst_per_year: Option<Vec<YearlyRate>> =
            site.lost.as_ref().map(|lost: &Lost| lost.burst.iter().map(YearlyRate::of).collect()),
        /// Wine lost, under each assumption.
        pub wine_lost_m3_per_year: Option<[f64; 3]> as "m3/year" = site.lost.as_ref().map(|lost| lost.wine),
        /// Range of the cost of barrels that burst under the central assumption, with their wine.
        pub money_lost_per_year: Option<[f64; 2]> as "US$/year" = site.lost.as_ref().map(|lost| lost.money),
        /// Shares of the rate of collapse by intensity.
        pub contributions: Vec<RatePart> = site.contributions.iter().map(RatePart::of).collect(),
    }

    /// Rate at which a limit state is reached.
    pub struct LimitStateRate of limit: &LimitRate {
        /// The limit state.
        pub limit_state: String = limit.limit.name(),
        /// With the curve.
        pub annual_rate: Option<YearlyRate> = limit.fitted.as_ref().map(YearlyRate::of),
        /// Its 95 % interval.
        pub annual_rate_interval: Option<[Option<f64>; 2]> as "1/year" = limit.interval.map(bounds),
        /// With the raw shares.
        pub annual_rate_raw: YearlyRate = YearlyRate::of(&limit.raw),
        /// Chance in the requested number of years.
        pub chance: f64 as "1" = limit.chance,
    }

    /// A number a year.
    pub struct YearlyRate of rate: &Rate {
        /// If shaking beyond the last row of the hazard curve did no more than that of the last row.
        pub low: f64 as "1/year" = rate.low,
        /// If it did the worst.
        pub high: f64 as "1/year" = rate.high,
        /// Effect of shaking of the intensity of the first row.
        pub at_first_row: f64 as "1" = rate.at_first,
    }

    /// A share of a rate by intensity.
    pub struct RatePart of part: &Contribution {
        /// From this intensity on.
        pub from: f64 as "of the measure" = part.from,
        /// Up to this one.
        pub to: f64 as "of the measure" = part.to,
        /// The rate.
        pub rate: f64 as "1/year" = part.rate,
    }
}

/// Returns a number, or `None`: JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

pub(crate) fn bounds(interval: Interval) -> [Option<f64>; 2] {
    [finite(interval.low), finite(interval.high)]
}

fn raw(stripes: &[Stripe], intervals: &[Interval]) -> Vec<RawShare> {
    stripes.iter().zip(intervals).map(|at| RawShare::of(&at)).collect()
}
