//! The numbers of the page as JSON, in SI units.

use serde_json::{Value, json};

use super::{Height, Heights};
use crate::decision::{LimitCurve, interval_json};

/// Everything but the page.
pub(super) fn of(all: &Heights) -> Value {
    json!({
        "rack": all.request.rack,
        "seed": all.request.seed,
        "motions": all.motions,
        "runs": all.runs,
        "runs_without_verdict": all.left_out,
        "headline": all.document.verdict.headline,
        "heights": all.heights.iter().map(height).collect::<Vec<_>>(),
        "as_recorded": all.recorded.iter().map(|run| json!({
            "levels": run.levels,
            "direction": run.view.name(),
            "motion": run.motion,
            "collapsed": run.collapsed,
            "fallen_share": run.fallen,
            "pgv": run.velocity,
            "pga": run.acceleration,
        })).collect::<Vec<_>>(),
        "warnings": all.warnings,
    })
}

fn height(height: &Height) -> Value {
    let curve = &height.by_velocity;
    let at = curve.stripes.iter().zip(&curve.intervals).zip(&height.fallen);
    json!({
        "levels": height.levels,
        "direction": height.view.name(),
        "at": at.map(|((stripe, interval), fallen)| json!({
            "pgv": stripe.intensity,
            "cases": stripe.cases,
            "collapsed": stripe.failures,
            "interval": interval_json(*interval),
            "fallen_share": fallen,
        })).collect::<Vec<_>>(),
        "pgv": fitted(curve),
        "pga": fitted(&height.by_acceleration),
    })
}

fn fitted(curve: &LimitCurve) -> Value {
    let fit = curve.fit.as_ref().ok();
    json!({
        "median": fit.map(|fit| fit.curve.median),
        "dispersion": fit.map(|fit| fit.curve.dispersion),
        "median_interval": curve.median.filter(|_| fit.is_some()).map(interval_json),
        "no_curve": curve.fit.as_ref().err().map(ToString::to_string),
    })
}
