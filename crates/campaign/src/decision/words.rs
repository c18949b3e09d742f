//! Sentences of the report page of a study: verdict and warnings.

use barrelstack_fragility::{FitError, Interval, wilson};
use barrelstack_report::{Cell, measured, significant};

use super::Decision;
use super::cases::Cases;
use super::curve::{BandKind, LEVEL, LimitCurve};
use super::hazard::Site;
use super::limit::LimitState;
use super::loss::Losses;
use crate::study::Provenance;

/// Formats a share as a percentage.
pub(crate) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        v if v <= 0.0 => "0 %".to_owned(),
        v if v < 0.1 => "less than 0.1 %".to_owned(),
        v if v > 99.9 && v < 100.0 => "more than 99.9 %".to_owned(),
        v if v < 10.0 => format!("{} %", significant(v, 2)),
        // A share below 1 must not be shown as 100 %.
        v if v > 99.0 && v < 100.0 => format!("{} %", significant(v, 3)),
        v => format!("{v:.0} %"),
    }
}

/// Formats an interval; `format` formats each of its two ends.
pub(crate) fn range(of: Interval, format: impl Fn(f64) -> String) -> String {
    format!("{} to {}", format(of.low), format(of.high))
}

/// Returns a table cell with a count that is not rounded.
pub(super) fn count(count: impl Into<f64>) -> Cell {
    let count: f64 = count.into();
    let digits = format!("{count:.0}").len();
    Cell::Number(count, digits)
}

/// Returns a note on runs without a verdict; `None` if there are no such runs.
pub(crate) fn left_out(lost: usize, runs: usize) -> Option<String> {
    let (have, are) = if lost == 1 { ("has", "is") } else { ("have", "are") };
    (lost > 0).then(|| {
        format!(
            "{lost} of {runs} runs {have} no verdict and {are} left out; the column `error` of the tables gives the \
             reasons."
        )
    })
}

/// Returns a sentence on stacks that fall under their own weight, followed by a space; empty if there are no such
/// stacks.
///
/// `fallen` is the number of these stacks and `of` is the total number. `what` is the noun that follows the numbers,
/// such as "runs".
pub(crate) fn fallen_at_rest(fallen: usize, of: usize, what: &str) -> String {
    let (falls, they) = match fallen {
        0 => return String::new(),
        1 => ("falls under its", "it is"),
        _ => ("fall under their", "they are"),
    };
    format!("{fallen} of {of} {what} {falls} own weight, before {they} shaken. ")
}

/// Returns a clause that states an annual rate of collapse as a return period, such as "a stack collapses once in 500
/// years on average".
fn recurrence(rate: f64) -> String {
    if rate <= 0.0 {
        return "no stack collapses".to_owned();
    }
    format!("a stack collapses once in {} years on average", significant(1.0 / rate, 2))
}

/// Returns the reason why there is no fitted curve; `format` formats intensities.
pub(crate) fn refusal(reason: &FitError, format: impl Fn(f64) -> String) -> String {
    match reason {
        FitError::NothingFailed { largest } => format!(
            "no case failed up to {}, so the median is higher; add cases of higher intensity",
            format(*largest)
        ),
        FitError::EverythingFailed { smallest } => format!(
            "every case failed down to {}, so the median is lower; add cases of lower intensity",
            format(*smallest)
        ),
        FitError::Separated { above, below } => match (format(*above), format(*below)) {
            (above, below) if above == below => {
                format!(
                    "no case failed below {above} and none survived above it, so the dispersion cannot be found; add cases \
                     around this intensity"
                )
            }
            (above, below) => format!(
                "a single capacity between {above} and {below} explains every case; add cases between them"
            ),
        },
        other @ (FitError::Empty
        | FitError::Invalid { .. }
        | FitError::BadDispersion(_)
        | FitError::BadLevel(_)
        | FitError::NotIncreasing
        | FitError::NotConverged
        | FitError::Unstable { .. }) => other.to_string(),
    }
}

/// Returns the headline of the report page.
pub(super) fn headline(decision: &Decision) -> String {
    let cases = &decision.cases;
    fallen_at_rest(cases.fallen_at_rest(), cases.all.len(), "cases") + &collapse(decision)
}

/// Describes how collapse depends on the intensity measure of the study.
fn collapse(decision: &Decision) -> String {
    let cases = &decision.cases;
    let curve = &decision.curves[0];
    let measure = cases.measure();
    let collapsed = cases.all.iter().filter(|case| case.collapsed).count();
    let stacks = cases.stacks.as_ref().map_or_else(
        || "stacks".to_owned(),
        |stacks| {
            // A verb follows, as in "stacks of 4 levels, shaken along the barrels, collapse".
            if stacks.contains(',') { format!("{stacks},") } else { stacks.clone() }
        },
    );
    let of = cases.stacks.as_ref().map_or_else(String::new, |_| format!(" of {stacks}"));
    let collapse = if collapsed == 1 { "collapses" } else { "collapse" };
    let counted = format!("{collapsed} of {} cases{of} {collapse}", cases.all.len());
    if curve.violates_order() {
        return format!(
            "{counted}, and collapse does not become steadily likelier with {}: use the raw fractions.",
            measure.label
        );
    }
    let rests_on = format!("{} cases, {} motions", cases.all.len(), cases.records.len());
    match (&curve.fit, &curve.median) {
        (Ok(fit), median) => {
            let known = median.map_or_else(
                || format!("{rests_on}, which determine no interval"),
                |median| format!("{} with 95 % confidence; {rests_on}", measure.range(median)),
            );
            format!(
                "At a {} of {} ({known}), half of the {stacks} collapse.",
                measure.label,
                measure.words(fit.curve.median)
            )
        }
        // If the cases are samples, their share of collapses is an estimate for the sampled population. If their levels
        // were chosen, their share of collapses has no meaning.
        (Err(_), _) if cases.sampled => {
            let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
            let share = wilson(count(collapsed), count(cases.all.len()), LEVEL);
            format!("{counted}: {} with 95 % confidence.", range(share, percent))
        }
        (Err(_), _) => format!("{counted}."),
    }
}

/// Returns the sentences that follow the headline.
pub(super) fn sentences(decision: &Decision) -> Vec<String> {
    let cases = &decision.cases;
    let curve = &decision.curves[0];
    let measure = cases.measure();
    let mut said = Vec::new();
    let endings = &cases.endings;
    if endings.cut > 0 {
        let were = if endings.cut == 1 { "was" } else { "were" };
        said.push(format!(
            "{} of {} cases {were} cut short while the ground still moved.",
            endings.cut, endings.judged
        ));
    }
    match (&curve.fit, &curve.median) {
        (Ok(fit), Some(interval)) => {
            let dispersion = significant(fit.curve.dispersion, 2);
            // The headline states the median, unless it warns against the curve.
            said.push(if curve.violates_order() {
                format!(
                    "The fitted curve, which cannot decrease, has a median {} of {} ({} with 95 % confidence) and a \
                     dispersion of {dispersion}.",
                    measure.label,
                    measure.words(fit.curve.median),
                    measure.range(*interval)
                )
            } else {
                format!("The dispersion of the fitted curve is {dispersion}.")
            });
            said.push(format!(
                "One stack in ten collapses at {}, and nine in ten collapse at {}{}.",
                measure.words(fit.curve.intensity(0.1)),
                measure.words(fit.curve.intensity(0.9)),
                if curve.violates_order() { " by that curve" } else { "" }
            ));
        }
        (Err(reason), _) => said.push(format!(
            "No fragility curve is fitted: {}.",
            refusal(reason, |x| measure.words(x))
        )),
        (Ok(_), None) => {}
    }
    if let Some((losses, last)) =
        decision.losses.as_ref().ok().and_then(|losses| Some((losses, losses.levels.last()?)))
    {
        said.push(format!(
            "At {}, a stack of {} barrels loses {} of them on average ({} with 95 % confidence).",
            measure.words(last.intensity),
            losses.barrels,
            measured(last.fallen, 1),
            range(last.interval, |barrels| measured(barrels, 1))
        ));
    }
    if let Some(site) = &decision.site {
        let rate = &site.limits[0];
        let annual = rate.fitted.as_ref().unwrap_or(&rate.raw).low;
        said.push(format!(
            "With the hazard curve in {}, {}; the chance of a collapse within {} years is {}{}.",
            site.hazard.file,
            recurrence(annual),
            site.years,
            percent(rate.chance),
            site.lost.as_ref().map_or_else(String::new, |lost| format!(
                ", and {} barrels of a stack fall per year on average",
                measured(lost.fallen.low, 2)
            ))
        ));
    }
    said
}

/// Returns the warnings, the most important first.
pub(super) fn warnings(
    cases: &Cases,
    curves: &[LimitCurve],
    losses: Option<&Losses>,
    site: Option<&Site>,
    made: &Provenance,
) -> Vec<String> {
    let mut said = cases.endings.sentences();
    let measure = cases.measure();
    if !made.complete {
        said.push(format!(
            "The study is not finished: {} of {} chunks are done. Run it again to continue.",
            made.chunks_done, made.chunks
        ));
    }
    if cases.fallen_at_rest() > 0 {
        said.push(format!(
            "In {} of {} cases, the stack does not stand under its own weight: these cases count as collapsed at every \
             strength of shaking, and the barrels of the level that fails and of all levels above it count as fallen. \
             A fitted curve tends to zero as the shaking becomes weaker, but the chance of collapse in these cases \
             does not: use the raw fractions.",
            cases.fallen_at_rest(),
            cases.all.len()
        ));
    }
    if cases.left_out > 0 {
        let (have, are) = if cases.left_out == 1 { ("has", "is") } else { ("have", "are") };
        said.push(format!(
            "{} of {} cases {have} no verdict and {are} left out; the column `error` of the table gives the reasons.",
            cases.left_out,
            cases.left_out + cases.all.len()
        ));
    }
    for curve in curves {
        said.extend(islands(cases, curve));
    }
    if cases.hunted {
        said.push(
            "The levels were chosen by searches for collapse, so that shares and means over all cases apply to the \
             levels that were run, and not to shaking of a given strength."
                .to_owned(),
        );
    }
    let collapse = &curves[0];
    if collapse.limit == LimitState::SeatLost {
        if let Some(test) = collapse.goodness.filter(|test| test.freedom > 0 && test.p < 0.05) {
            said.push(format!(
                "The lognormal curve of collapse does not describe the raw fractions (p = {}): use the raw fractions, or another \
                 measure.",
                significant(test.p, 2)
            ));
        }
        if collapse.fit.is_ok() && collapse.band_kind == BandKind::Likelihood {
            said.push(
                "All cases use one record, and the band treats them as independent: it does not cover the scatter \
                 between records."
                    .to_owned(),
            );
        }
        if collapse.fit.is_ok() && collapse.band_kind == BandKind::None {
            said.push(format!(
                "The curve depends on one of the {} records: if this record is omitted, no curve can be fitted to the \
                 remaining cases, so no interval is given. Add records.",
                cases.records.len()
            ));
        }
        let returned = &collapse.returned;
        if let Some(first) = returned.first() {
            let why = if cases.endings.cut > 0 {
                "Some motions were cut short, which alone can cause such results".to_owned()
            } else if cases.drawn.is_empty() {
                "Such results are typical of rocking and sliding stacks; a single run proves little"
                    .to_owned()
            } else {
                format!(
                    "Such results are typical of rocking and sliding stacks, and {} is drawn for each case; a single \
                     run proves little",
                    cases.drawn.join(", ")
                )
            };
            said.push(format!(
                "{} {} of {} {}, the stack stands at one level of shaking although it collapses at a lower level (the \
                 first: collapse at {}, standing at {}). {why}.",
                if cases.curves_are() == "motions" { "Under" } else { "On" },
                returned.len(),
                cases.curves(),
                cases.curves_are(),
                measure.words(first.failed),
                measure.words(first.stood)
            ));
        }
    }
    if let Some(site) = site {
        said.extend(of_site(cases, losses, site));
    }
    said
}

/// Returns a warning for each significant decrease of the fraction of failures as the intensity grows.
fn islands(cases: &Cases, curve: &LimitCurve) -> Vec<String> {
    let measure = &cases.measures[curve.measure];
    let falls = curve.monotony.significant(0.05);
    let meaning = "A fitted curve hides that failure is likelier at the lower intensity";
    falls
        .map(|fall| {
            format!(
                "The limit state \"{}\" does not become steadily likelier with intensity: it is reached in {} of {} \
                 cases at {}, but only in {} of {} at {} (p = {}). {meaning}; use the raw fractions.",
                curve.limit.words(),
                fall.from.failures,
                fall.from.cases,
                measure.words(fall.from.intensity),
                fall.to.failures,
                fall.to.cases,
                measure.words(fall.to.intensity),
                significant(fall.p, 2)
            )
        })
        .collect()
}

fn of_site(cases: &Cases, losses: Option<&Losses>, site: &Site) -> Vec<String> {
    let mut said = Vec::new();
    let rate = &site.limits[0];
    let of = rate.fitted.as_ref().unwrap_or(&rate.raw);
    if of.high > 1.1 * of.low {
        said.push(format!(
            "The hazard table ends too early: since it gives no rate for stronger shaking than in its last row, the \
             rate of collapse is only known to lie between {} and {} per year. Add rows of stronger shaking.",
            significant(of.low, 2),
            significant(of.high, 2)
        ));
    }
    if of.at_first > 0.01 {
        said.push(format!(
            "The hazard table begins too late: the shaking of its first row already makes {} of the stacks collapse, \
             and weaker shaking is not counted. Add rows of weaker shaking.",
            percent(of.at_first)
        ));
    }
    let rows = site.hazard.hazard.rows();
    let Some(losses) = losses else { return said };
    let last = losses.levels.last().map_or(0.0, |loss| loss.intensity);
    if rows[rows.len() - 1].0 > 1.5 * last {
        said.push(format!(
            "The hazard table reaches {}, but the study only {}: for stronger shaking, the losses at the last \
             level of the study are used.",
            cases.measure().words(rows[rows.len() - 1].0),
            cases.measure().words(last)
        ));
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_reads_as_none_or_all_only_when_it_is() {
        let shares = [0.0, 5e-4, 0.044, 0.5, 0.708, 299.0 / 300.0, 0.9995, 1.0];
        let expected = [
            "0 %",
            "less than 0.1 %",
            "4.4 %",
            "50 %",
            "71 %",
            "99.7 %",
            "more than 99.9 %",
            "100 %",
        ];
        assert_eq!(shares.map(percent), expected);
    }
}
