//! What the page says in words: verdict and warnings.

use barrelstack_report::{Cell, significant};

use super::Decision;
use super::cases::Cases;
use super::curve::{BandKind, LimitCurve};
use super::hazard::Site;
use super::limit::LimitState;
use super::loss::Losses;
use crate::study::Provenance;

/// A share as a percentage in words.
pub(crate) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value {
        v if v <= 0.0 => "0 %".to_owned(),
        v if v < 0.1 => "less than 0.1 %".to_owned(),
        v if v > 99.9 && v < 100.0 => "more than 99.9 %".to_owned(),
        v if v < 10.0 => format!("{} %", significant(v, 2)),
        v => format!("{} %", significant(v.round(), 3)),
    }
}

/// A count as a cell: all of its digits and no others.
pub(super) fn count(count: impl Into<f64>) -> Cell {
    let count: f64 = count.into();
    let digits = format!("{count:.0}").len();
    Cell::Number(count, digits)
}

/// Once in how many years.
pub(super) fn period(rate: f64) -> String {
    if rate <= 0.0 {
        return "never".to_owned();
    }
    format!("once in {} years", significant(1.0 / rate, 2))
}

/// The largest words of the page.
pub(super) fn headline(decision: &Decision) -> String {
    let cases = &decision.cases;
    let curve = &decision.curves[0];
    let measure = cases.measure();
    let collapsed = cases.all.iter().filter(|case| case.collapsed).count();
    match &curve.fit {
        _ if fit_is_doubtful(curve) => format!(
            "{collapsed} of {} cases collapse, and collapse does not simply grow with {}: read the raw fractions.",
            cases.all.len(),
            measure.label
        ),
        Ok(fit) => format!(
            "Half of the stacks collapse at a {} of {}.",
            measure.label,
            measure.words(fit.curve.median)
        ),
        Err(_) => format!("{collapsed} of {} cases collapse.", cases.all.len()),
    }
}

/// Whether the order that the curve takes for granted is clearly violated.
pub(super) fn fit_is_doubtful(curve: &LimitCurve) -> bool {
    curve.monotony.p < 0.05
}

/// The sentences under it.
pub(super) fn sentences(decision: &Decision) -> Vec<String> {
    let cases = &decision.cases;
    let curve = &decision.curves[0];
    let measure = cases.measure();
    let mut said = Vec::new();
    match (&curve.fit, &curve.median) {
        (Ok(fit), Some(interval)) => {
            let band = if interval.low > 0.0 && interval.high.is_finite() {
                format!(
                    "{} to {} with 95 % confidence",
                    measure.words(interval.low),
                    measure.words(interval.high)
                )
            } else {
                "which the cases hardly bound".to_owned()
            };
            said.push(format!(
                "The median {} of collapse is {} ({band}), its dispersion {}.",
                measure.label,
                measure.words(fit.curve.median),
                significant(fit.curve.dispersion, 2)
            ));
            said.push(format!(
                "One stack in ten collapses at {}, nine in ten at {}.",
                measure.words(fit.curve.intensity(0.1)),
                measure.words(fit.curve.intensity(0.9))
            ));
        }
        (Err(reason), _) => said.push(format!("No fragility curve is fitted: {reason}.")),
        (Ok(_), None) => {}
    }
    if let Some(last) = decision.losses.levels.last() {
        said.push(format!(
            "At {} a stack of {} barrels loses {} of them on average.",
            measure.words(last.intensity),
            decision.losses.barrels,
            significant(last.fallen, 2)
        ));
    }
    if let Some(site) = &decision.site {
        let rate = &site.limits[0];
        let annual = rate.fitted.as_ref().unwrap_or(&rate.raw).low;
        said.push(format!(
            "At the site of {} that is a collapse {}, a chance of {} in {} years, and {} barrels on the floor a year.",
            site.hazard.file,
            period(annual),
            percent(rate.chance),
            site.years,
            significant(site.fallen.low, 2)
        ));
    }
    said
}

/// Warnings, the most important first.
pub(super) fn warnings(
    cases: &Cases,
    curves: &[LimitCurve],
    losses: &Losses,
    site: Option<&Site>,
    made: &Provenance,
) -> Vec<String> {
    let mut said = Vec::new();
    let measure = cases.measure();
    if !made.complete {
        said.push(format!(
            "The study is not finished: {} of {} chunks are done. Run it again to go on.",
            made.chunks_done, made.chunks
        ));
    }
    if cases.left_out > 0 {
        said.push(format!(
            "{} of {} cases have no verdict and are left out; the column `error` of the table says why.",
            cases.left_out,
            cases.left_out + cases.all.len()
        ));
    }
    for curve in curves {
        said.extend(islands(cases, curve));
    }
    let collapse = &curves[0];
    if collapse.limit == LimitState::SeatLost {
        if let Some(test) = collapse.goodness.filter(|test| test.freedom > 0 && test.p < 0.05) {
            said.push(format!(
                "The lognormal curve of collapse does not describe the raw fractions (p = {}): use these, or another \
                 measure.",
                significant(test.p, 2)
            ));
        }
        if collapse.fit.is_ok() && collapse.band_kind == BandKind::Likelihood {
            said.push(format!(
                "The band takes all cases as independent, since {} records are too few to be resampled; with the same \
                 records at every level it is too narrow.",
                cases.records.len()
            ));
        }
        if let Some(found) = collapse.replicates.as_ref().filter(|r| r.refused_share() > 0.025) {
            said.push(format!(
                "{} of the resampled data sets determine no curve and are left out, so the band is too narrow.",
                percent(found.refused_share())
            ));
        }
        let returned = &collapse.returned;
        if !returned.is_empty() {
            let first = &returned[0];
            said.push(format!(
                "{} of {} curves stand at a higher level than one that felled them (the first collapses at {} and \
                 stands at {}). That is the nature of rocking and sliding stacks; a single run proves little.",
                returned.len(),
                cases.all.iter().map(|case| case.curve).max().map_or(0, |last| last + 1),
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

/// Where collapse becomes less likely with intensity.
fn islands(cases: &Cases, curve: &LimitCurve) -> Vec<String> {
    let measure = &cases.measures[curve.measure];
    let falls = curve.monotony.significant(0.05);
    falls
        .map(|fall| {
            format!(
                "{} is not monotone: {} of {} cases at {}, but only {} of {} at {} (p = {}). Below the stable window \
                 lies an island of it that the fitted curve smooths away; use the raw fractions.",
                capital(&curve.limit.words()),
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

fn of_site(cases: &Cases, losses: &Losses, site: &Site) -> Vec<String> {
    let mut said = Vec::new();
    let rate = &site.limits[0];
    let of = rate.fitted.as_ref().unwrap_or(&rate.raw);
    if of.high > 1.1 * of.low {
        said.push(format!(
            "The hazard table ends too early: shaking beyond its last row leaves the rate of collapse between {} and \
             {} a year. Add stronger shaking.",
            significant(of.low, 2),
            significant(of.high, 2)
        ));
    }
    if of.at_first > 0.01 {
        said.push(format!(
            "The hazard table begins too late: its first row already fells {} of the stacks, and weaker shaking is not \
             counted. Add weaker shaking.",
            percent(of.at_first)
        ));
    }
    let last = losses.levels.last().map_or(0.0, |loss| loss.intensity);
    let rows = site.hazard.hazard.rows();
    if rows[rows.len() - 1].0 > 1.5 * last {
        said.push(format!(
            "The hazard reaches {}, the study {} only: losses beyond are held at those of its last level.",
            cases.measure().words(rows[rows.len() - 1].0),
            cases.measure().words(last)
        ));
    }
    said
}

pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
