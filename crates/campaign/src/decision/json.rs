//! The numbers of a decision as JSON: SI units, chances from 0 to 1, rates a year.

use barrelstack_fragility::{Interval, Rate, Stripe};
use serde_json::{Value, json};

use super::curve::{BandKind, LimitCurve};
use super::{Breakage, Decision, Sensitivity};

/// Everything but the page.
pub(super) fn of(decision: &Decision) -> Value {
    let cases = &decision.cases;
    let measure = cases.measure();
    let site = decision.site.as_ref().map(|site| {
        let limits: Vec<Value> = site
            .limits
            .iter()
            .map(|limit| {
                json!({
                    "limit_state": limit.limit.name(),
                    "annual_rate": limit.fitted.as_ref().map(rate),
                    "annual_rate_interval": limit.interval.map(bounds),
                    "annual_rate_raw": rate(&limit.raw),
                    "chance": limit.chance,
                })
            })
            .collect();
        json!({
            "hazard": site.hazard.file,
            "measure": site.hazard.measure,
            "years": site.years,
            "limit_states": limits,
            "barrels_fallen_per_year": site.lost.as_ref().map(|lost| rate(&lost.fallen)),
            "barrels_burst_per_year":
                site.lost.as_ref().map(|lost| lost.burst.iter().map(rate).collect::<Vec<_>>()),
            "wine_lost_m3_per_year": site.lost.as_ref().map(|lost| lost.wine),
            "contributions": site.contributions.iter().map(|part| json!({
                "from": part.from, "to": part.to, "rate": part.rate,
            })).collect::<Vec<_>>(),
        })
    });
    json!({
        "title": cases.title,
        "headline": decision.document.verdict.headline,
        "cases": cases.all.len(),
        "cases_without_verdict": cases.left_out,
        "records": cases.records,
        "measure": {"name": measure.name, "unit": measure.unit},
        "fragility": decision.curves.iter().map(curve).collect::<Vec<_>>(),
        "measures": decision.measures.iter().map(|row| {
            let found = row.collapse.as_ref().ok();
            json!({
                "measure": cases.measures[row.measure].name,
                "unit": cases.measures[row.measure].unit,
                "median": found.map(|found| found.fit.curve.median),
                "dispersion": found.map(|found| found.fit.curve.dispersion),
                "ln_likelihood": found.map(|found| found.fit.ln_likelihood),
                "concordance": found.map(|found| found.concordance),
                "beside": row.beside.map(|at| &cases.measures[at].name),
                "sufficiency_p": found.and_then(|found| found.sufficiency),
                "no_curve": row.collapse.as_ref().err().map(ToString::to_string),
                "drift_slope": row.drift.map(|found| found.slope),
                "drift_dispersion": row.drift.map(|found| found.dispersion),
                "drift_sufficiency_p": row.drift.and_then(|found| found.sufficiency),
            })
        }).collect::<Vec<_>>(),
        "modes": decision.modes.iter().map(|mode| json!({
            "mode": mode.mode,
            "raw": raw(&mode.stripes, &mode.intervals),
            "cumulative_incidence_at": decision.curves[0].grid.iter().zip(&mode.fitted)
                .map(|(x, p)| json!({"intensity": x, "chance": p})).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "followed_to_rest": cases.endings.followed,
        "stopped_after_collapse": cases.endings.stopped,
        "ended_by_duration": cases.endings.short,
        "cut_while_the_ground_moved": cases.endings.cut,
        "still_moving_at_the_end": cases.endings.moving,
        "no_losses": decision.losses.as_ref().err(),
        "losses": decision.losses.as_ref().ok().map(|losses| json!({
            "barrels": losses.barrels,
            "breakage_median_m": Breakage::RANGE.map(|breakage| breakage.median),
            "breakage_dispersion": Breakage::RANGE.map(|breakage| breakage.dispersion),
            "levels": losses.levels.iter().map(|loss| json!({
                "intensity": loss.intensity,
                "cases": loss.cases,
                "barrels_fallen": loss.fallen,
                "barrels_fallen_interval": bounds(loss.interval),
                "barrels_burst": loss.burst,
            })).collect::<Vec<_>>(),
        })),
        "sobol_indices": decision.sensitivities.iter().map(sensitivity).collect::<Vec<_>>(),
        "effects": decision.effects.iter().map(|effect| json!({
            "factor": effect.factor,
            "groups": effect.groups.iter().map(|group| json!({
                "value": group.label,
                "cases": group.cases,
                "collapsed": group.collapsed,
                "interval": bounds(group.interval),
            })).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "site": site,
        "warnings": decision.warnings,
    })
}

fn sensitivity(of: &Sensitivity) -> Value {
    json!({
        "result": of.result,
        "blocks": of.blocks,
        "blocks_left_out": of.left_out,
        "inputs": of.inputs.iter().map(|(name, index)| json!({
            "input": name,
            "first": index.first,
            "first_interval": bounds(index.first_interval),
            "total": index.total,
            "total_interval": bounds(index.total_interval),
        })).collect::<Vec<_>>(),
    })
}

/// A number, or null: JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

pub(crate) fn bounds(interval: Interval) -> Value {
    json!([finite(interval.low), finite(interval.high)])
}

fn rate(rate: &Rate) -> Value {
    json!({"low": rate.low, "high": rate.high, "at_first_row": rate.at_first})
}

fn raw(stripes: &[Stripe], intervals: &[Interval]) -> Value {
    let each = stripes.iter().zip(intervals).map(|(stripe, interval)| {
        json!({
            "intensity": stripe.intensity,
            "cases": stripe.cases,
            "failures": stripe.failures,
            "interval": bounds(*interval),
        })
    });
    each.collect()
}

fn curve(curve: &LimitCurve) -> Value {
    let fit = curve.fit.as_ref().ok();
    json!({
        "limit_state": curve.limit.name(),
        "raw": raw(&curve.stripes, &curve.intervals),
        "median": fit.map(|fit| fit.curve.median),
        "dispersion": fit.map(|fit| fit.curve.dispersion),
        "ln_median_standard_error": fit.map(|fit| fit.median_error),
        "ln_dispersion_standard_error": fit.map(|fit| fit.dispersion_error),
        "median_interval": curve.median.filter(|_| fit.is_some()).map(bounds),
        "no_curve": curve.fit.as_ref().err().map(ToString::to_string),
        "band": match curve.band_kind {
            BandKind::Records => "jackknife over records",
            BandKind::Likelihood => "profile likelihood",
            BandKind::None => "none",
        },
        "band_at": curve.grid.iter().zip(&curve.band).map(|(x, band)| json!({
            "intensity": x, "interval": bounds(*band),
        })).collect::<Vec<_>>(),
        "goodness_p": curve.goodness.filter(|test| test.freedom > 0).map(|test| test.p),
        "monotone_p": curve.monotony.p,
        "falls": curve.monotony.falls.iter().map(|fall| json!({
            "from": fall.from.intensity, "to": fall.to.intensity, "p": fall.p,
        })).collect::<Vec<_>>(),
        "returned": curve.returned.len(),
    })
}
