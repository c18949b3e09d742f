//! Restitution and damping `c` from drop tests in which heights or the times of impacts are measured.

use barrelstack::scenario::Dimension;
use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math;
use barrelstack_fragility::student_quantile;
use barrelstack_report::{Axis, Figure};

use super::figures::{curve, figure, fitted, measured};
use super::least_squares::{self, Fit, Start};
use super::result::{bodies, quoted, rounded, short};
use super::statistics::mean;
use super::{CalibrateError, Calibration, Estimate, Table, impact};

/// Properties of the striking mass and of its contact. The file of a drop test does not contain them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Striker {
    /// Falling mass (kg).
    pub mass: f64,
    /// Stiffness `k` (N/m) of the contact at one node.
    pub stiffness: f64,
    /// Number of contact nodes that the mass hits at once.
    pub nodes: u32,
    /// Acceleration of gravity (m/s²).
    pub gravity: f64,
}

/// Standard gravity (m/s²).
pub const GRAVITY: f64 = 9.80665;

/// Fits parameters whose magnitude is about 1, with narrow finite differences and a tight stopping criterion.
fn fit(start: &[f64], evaluate: &least_squares::Evaluate<'_>) -> Option<Fit> {
    let parameters = start.to_vec();
    least_squares::fit(Start { parameters, slopes: None, width: 1e-4, share: 0.01 }, evaluate)
}

/// Estimates the restitution from a drop test, and also the damping if `striker` is given.
///
/// The table has the columns `drop height` and `rebound height`, or the column `time` with the times of the impacts of
/// one bounce sequence.
///
/// If `striker` is given, the impact is solved with gravity and takes a finite time, and the damping ratio ζ is fitted
/// to the rebounds or the times. Gravity presses the mass into the contact and so reduces the rebound of slow impacts.
/// If `striker` is `None`, the impact is assumed to be instantaneous. For heights, the scatter is attributed to the
/// restitution, which differs from drop to drop; for times, it is attributed to errors of measurement.
///
/// # Errors
/// If the table lacks columns or rows, or a rebound is not lower than its drop.
pub fn drop(
    table: &Table,
    striker: Option<Striker>,
    interface: &str,
) -> Result<Calibration, CalibrateError> {
    let found =
        if table.has("time") { from_times(table, striker)? } else { from_heights(table, striker)? };
    let mut warnings = table.unused(&["time", "drop height", "rebound height"]);
    warnings.extend(found.warnings);
    let figures = vec![found.figure];
    let e = found.restitution.value;
    let mut estimates = vec![found.restitution];
    let mut facts = vec![
        ("bodies".to_owned(), bodies(interface).to_owned()),
        ("impacts".to_owned(), found.impacts.to_string()),
    ];
    let scenario;
    if let (Some(striker), Some((log_ratio, half))) = (striker, found.log_ratio) {
        let per_node = |ratio: f64| striker.constants(ratio).1 / f64::from(striker.nodes);
        let estimate = |name: &str, dimension, of: &dyn Fn(f64) -> f64| {
            Estimate::of_log(name, log_ratio, half, dimension, |log| of(math::exp(log)))
        };
        estimates.push(estimate("damping ratio", Dimension::NONE, &|ratio| ratio));
        let damping = estimate("damping c", Dimension::DAMPING, &per_node);
        scenario = format!(
            "[interface.{interface}]\nstiffness = {}\ndamping = {}\n",
            quoted(striker.stiffness, Dimension::STIFFNESS),
            quoted(damping.value, Dimension::DAMPING)
        );
        estimates.push(damping);
        facts.push(("falling mass".to_owned(), format!("{} kg", short(striker.mass))));
        let k = short(striker.stiffness);
        facts.push((
            "stiffness k".to_owned(),
            format!("{k} N/m at each of {} nodes, taken as exact", striker.nodes),
        ));
    } else {
        warnings.push(
            "gravity during the impact is neglected, so slow impacts give too low a restitution: state the \
             mass and the stiffness to include gravity and to obtain the damping c"
                .to_owned(),
        );
        scenario = format!(
            "[interface.{interface}]\nrestitution = {}\n# restitution needs stiffness and reference_mass (the mass \
             that falls on one node) beside it\n",
            rounded(e)
        );
    }
    let title = format!(
        "drop test {}: rebound of {} with the speed-gap law",
        table.file(),
        bodies(interface)
    );
    Ok(Calibration {
        title,
        estimates,
        figures,
        facts,
        scenario,
        warnings,
        ..Calibration::default()
    })
}

/// Result of a drop test, whether from heights or from times.
struct DropResult {
    restitution: Estimate,
    /// ln ζ and half the width of its 95 % interval; ζ is the damping ratio.
    log_ratio: Option<(f64, f64)>,
    impacts: usize,
    /// Figure of the measured and the fitted rebounds.
    figure: Figure,
    warnings: Vec<String>,
}

impl Striker {
    /// Returns the stiffness (N/m) and damping (N·s/m) of all nodes together, for a damping ratio.
    fn constants(&self, ratio: f64) -> (f64, f64) {
        let stiffness = self.stiffness * f64::from(self.nodes);
        (stiffness, restitution::damping(stiffness, ratio, self.mass))
    }

    fn strike(&self, log_ratio: f64, speed: f64) -> super::Impact {
        let (stiffness, damping) = self.constants(math::exp(log_ratio));
        impact(self.mass, stiffness, damping, self.gravity, speed)
    }
}

fn from_heights(table: &Table, striker: Option<Striker>) -> Result<DropResult, CalibrateError> {
    let from = table.positive("drop height", Dimension::LENGTH)?;
    let to = table.positive("rebound height", Dimension::LENGTH)?;
    if let Some(row) = from.iter().zip(&to).position(|(from, to)| to >= from) {
        let expected = format!("less than the drop height {}", table.cell(row, "drop height"));
        let found = table.cell(row, "rebound height");
        let remedy = "a mass cannot rebound higher than it fell; correct the row or remove it";
        return Err(table.at(row, "rebound height", &expected, &found, remedy).into());
    }
    if from.len() < 2 {
        return Err(table
            .unsuited("the scatter cannot be computed from one drop: at least two drops are needed")
            .into());
    }
    let shown: Vec<f64> = from.iter().zip(&to).map(|(from, to)| (to / from).sqrt()).collect();
    let (e, half) = mean(&shown);
    let restitution = Estimate::symmetric("restitution", e, half, Dimension::NONE);
    let mut warnings = Vec::new();
    let impacts = from.len();
    let Some(striker) = striker else {
        let figure = heights(&from, &to, &|height| e * e * height);
        return Ok(DropResult { restitution, log_ratio: None, impacts, figure, warnings });
    };
    let start = start_ratio(e);
    let residuals = |point: &Vec<f64>| -> Option<Vec<f64>> {
        let residual = |(from, e): (&f64, &f64)| {
            let speed = (2.0 * striker.gravity * from).sqrt();
            striker.strike(point[0], speed).speed / speed - e
        };
        Some(from.iter().zip(&shown).map(residual).collect())
    };
    let found = fit(&[start], &|points| points.iter().map(residuals).collect());
    let log_ratio =
        log_interval(found.as_ref(), 0).ok_or_else(|| table.unsuited(no_rebound(&striker)))?;
    let slow = from.iter().fold(f64::INFINITY, |least, from| least.min(*from));
    warnings.extend(gravity_warning(&striker, log_ratio.0, (2.0 * striker.gravity * slow).sqrt()));
    let rebound = |height: f64| {
        let speed = (2.0 * striker.gravity * height).sqrt();
        let after = striker.strike(log_ratio.0, speed).speed;
        0.5 * after * after / striker.gravity
    };
    let figure = heights(&from, &to, &rebound);
    Ok(DropResult { restitution, log_ratio: Some(log_ratio), impacts, figure, warnings })
}

/// Plots the measured and the fitted rebound height (m) against the drop height (m).
fn heights(from: &[f64], to: &[f64], rebound: &dyn Fn(f64) -> f64) -> Figure {
    let centimeters = |values: &[f64]| values.iter().map(|v| 100.0 * v).collect::<Vec<f64>>();
    // The curve spans the measured drops only: after a lower drop the mass may not rebound.
    let lowest = from.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = from.iter().copied().fold(0.0, f64::max);
    let series = vec![
        curve("fitted", [100.0 * lowest, 100.0 * highest], |x| 100.0 * rebound(0.01 * x)),
        measured("measured", centimeters(from), centimeters(to), 1),
    ];
    let caption = "Drop test: rebound height against drop height, measured and fitted.";
    let axes = [Axis::new("drop height", "cm"), Axis::new("rebound height", "cm")];
    figure("drops", caption, axes, series)
}

/// Plots the measured and the fitted duration of each flight between two impacts; the impacts are at `times`
/// (s), and the residuals are in units of `unit` (s).
fn bounces(times: &[f64], residuals: &[f64], unit: f64) -> Figure {
    let found: Vec<f64> = times.iter().zip(residuals).map(|(t, r)| t + unit * r).collect();
    let between = |times: &[f64]| times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let number: Vec<f64> = (1..times.len()).map(|flight| flight as f64).collect();
    let series = vec![
        fitted("fitted", number.clone(), between(&found), 0),
        measured("measured", number, between(times), 1),
    ];
    let caption = "Bounces: duration of each flight between two impacts, measured and fitted.";
    let axes = [Axis::new("flight", ""), Axis::new("duration", "s")];
    figure("bounces", caption, axes, series)
}

fn from_times(table: &Table, striker: Option<Striker>) -> Result<DropResult, CalibrateError> {
    let times = table.required("time", Dimension::TIME)?;
    let flights: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if let Some(row) = flights.iter().position(|flight| *flight <= 0.0) {
        let (expected, found) = (
            format!("a time after {} of the row above", table.cell(row, "time")),
            table.cell(row + 1, "time"),
        );
        return Err(table
            .at(row + 1, "time", &expected, &found, "sort the impacts by time")
            .into());
    }
    if times.len() < 4 {
        return Err(table.unsuited(format!(
            "{} impacts do not determine the restitution and its scatter: at least four impacts of one bounce sequence \
             are needed",
            times.len()
        )).into());
    }
    let count = flights.len() as f64;
    let e = math::pow(flights[flights.len() - 1] / flights[0], 1.0 / (count - 1.0));
    if e >= 1.0 {
        return Err(table.unsuited(
            "the last flight between two impacts is not shorter than the first: check that all impacts belong to one \
             bounce sequence",
        ).into());
    }
    // Times are in units of the first flight and speeds in units of the first speed, so that all are about 1.
    let (origin, unit) = (times[0], flights[0]);
    let instant = |e: f64, at: usize| (1.0 - math::pow(e, at as f64)) / (1.0 - e);
    let bounce = |point: &Vec<f64>| -> Option<Vec<f64>> {
        let e = math::exp(point[2]);
        let residual = |(at, time): (usize, &f64)| {
            point[0] + math::exp(point[1]) * instant(e, at) - (time - origin) / unit
        };
        Some(times.iter().enumerate().map(residual).collect())
    };
    let plain = fit(&[0.0, 0.0, math::log(e)], &|points| points.iter().map(bounce).collect());
    let (log_e, half) = log_interval(plain.as_ref(), 2)
        .ok_or_else(|| table.unsuited("the times do not follow a bounce sequence"))?;
    let restitution = Estimate::of_log("restitution", log_e, half, Dimension::NONE, math::exp);
    let mut warnings = Vec::new();
    let picture =
        |fit: Option<Fit>| bounces(&times, &fit.map(|fit| fit.residuals).unwrap_or_default(), unit);
    let Some(striker) = striker else {
        let (figure, impacts) = (picture(plain), times.len());
        return Ok(DropResult { restitution, log_ratio: None, impacts, figure, warnings });
    };
    // The first flight gives the speed after the first impact; divided by the restitution, it gives the speed before
    // the impact.
    let first_speed = 0.5 * striker.gravity * unit / restitution.value;
    let solved = |point: &Vec<f64>| -> Option<Vec<f64>> {
        let (mut time, mut speed) = (point[0], first_speed * math::exp(point[1]));
        let mut residuals = Vec::with_capacity(times.len());
        for measured in &times {
            residuals.push(time - (measured - origin) / unit);
            let found = striker.strike(point[2], speed);
            speed = found.speed;
            time += (found.duration + 2.0 * speed / striker.gravity) / unit;
        }
        Some(residuals)
    };
    let start = [0.0, 0.0, start_ratio(restitution.value)];
    let found = fit(&start, &|points| points.iter().map(solved).collect());
    let log_ratio =
        log_interval(found.as_ref(), 2).ok_or_else(|| table.unsuited(no_rebound(&striker)))?;
    let last = 0.5 * striker.gravity * flights[flights.len() - 1];
    warnings.extend(gravity_warning(&striker, log_ratio.0, last));
    let (figure, impacts) = (picture(found), times.len());
    Ok(DropResult { restitution, log_ratio: Some(log_ratio), impacts, figure, warnings })
}

/// Returns the logarithm of the damping ratio ζ that gives the restitution `e` without gravity. The fit with gravity
/// starts from this value.
fn start_ratio(e: f64) -> f64 {
    let ratio = restitution::speed_gap_damping_ratio(e).unwrap_or(0.1);
    math::log(ratio.clamp(1e-3, 1e3))
}

/// Returns the fitted parameter at an index and half the width of its 95 % interval; `None` if the fit failed
/// or does not determine the parameter.
fn log_interval(fit: Option<&Fit>, at: usize) -> Option<(f64, f64)> {
    let fit = fit.filter(|fit| fit.converged && fit.matters.iter().all(|matters| *matters))?;
    let variance = fit.covariance.as_ref()?[at][at];
    Some((fit.parameters[at], student_quantile(0.95, fit.freedom) * variance.sqrt()))
}

fn no_rebound(striker: &Striker) -> String {
    format!(
        "no value of the damping gives these rebounds for {} kg on {} nodes of {} N/m under gravity: check mass, \
         stiffness and their units",
        short(striker.mass),
        striker.nodes,
        short(striker.stiffness)
    )
}

/// Returns a warning if the slowest impact is so slow that gravity reduces its rebound noticeably.
fn gravity_warning(striker: &Striker, log_ratio: f64, speed: f64) -> Option<String> {
    let ideal = restitution::speed_gap(math::exp(log_ratio));
    let shown = striker.strike(log_ratio, speed).speed / speed;
    (shown < 0.9 * ideal).then(|| {
        format!(
            "gravity reduces the rebound of the slowest impact ({1} m/s) by {0:.0} %, so c depends strongly on \
             the given k: drop the mass from a greater height, or leave out the last bounces",
            100.0 * (1.0 - shown / ideal),
            short(speed)
        )
    })
}
