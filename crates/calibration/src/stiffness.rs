//! Stiffness `k` from a press test, in which the force is measured as a function of penetration.

use barrelstack::scenario::Dimension;
use barrelstack_fragility::student_quantile;
use barrelstack_report::{Axis, Figure};

use super::figures::{curve, figure, measured, span};
use super::result::{bodies, quoted, short};
use super::statistics::line;
use super::{CalibrateError, Calibration, Estimate, Table};

/// Difference of the information criteria above which Hertz's law is suggested. Of two models that differ by
/// ten, the worse has essentially no support (Burnham and Anderson 2002).
const CLEARLY: f64 = 10.0;

/// Fits `F = k (δ − δ₀)` to a press test with the columns `penetration` and `force`.
///
/// δ₀ is the seating offset: the reading at which the surfaces first touch. The scatter is attributed to the
/// force, with the same variance in every row. `nodes` is the number of contact nodes that share the force;
/// `k` is the stiffness of one node. `interface` is the name of the interface, such as "barrel-rack", in
/// [`Calibration::scenario`].
///
/// # Errors
/// If the table lacks a column or has fewer than three rows, or if the force does not grow with penetration.
pub fn stiffness(
    table: &Table,
    nodes: u32,
    interface: &str,
) -> Result<Calibration, CalibrateError> {
    let penetration = table.required("penetration", Dimension::LENGTH)?;
    let force = table.required("force", Dimension::FORCE)?;
    let found = line(&penetration, &force).ok_or_else(|| {
        table.unsuited(
            "a slope and its scatter need at least three rows with at least two different penetrations",
        )
    })?;
    let (slope, t) = (found.slope, student_quantile(0.95, found.freedom));
    if slope <= 0.0 {
        return Err(table.unsuited(format!(
            "the force decreases with penetration ({} N/m): keep only the rows measured while the load \
             increases, and state force and penetration as positive into the surface",
            short(slope)
        )).into());
    }
    let per_node = slope / f64::from(nodes);
    let half = t * found.slope_variance.sqrt();
    // δ₀ = x̄ − ȳ/k, with independent errors of ȳ and k.
    let offset = -found.intercept / slope;
    let lever = (found.center - offset) / slope;
    let offset_variance =
        found.center_variance / (slope * slope) + lever * lever * found.slope_variance;
    let stiffness =
        Estimate::symmetric("stiffness k", per_node, half / f64::from(nodes), Dimension::STIFFNESS);
    let seating = Estimate::symmetric(
        "seating offset",
        offset,
        t * offset_variance.sqrt(),
        Dimension::LENGTH,
    );

    let mut warnings = table.unused(&["penetration", "force"]);
    let outside = force.iter().filter(|force| **force <= 0.0).count();
    if outside > 0 {
        warnings.push(format!(
            "{outside} of {} rows have no force: remove the rows measured before the surfaces touch, because they \
             lower k",
            force.len()
        ));
    }
    if let Some((hertz, difference)) = hertz(&penetration, &force, found.squares)
        && difference > CLEARLY
    {
        warnings.push(format!(
            "a force proportional to penetration to the power 1.5 fits the rows better than a straight line (its \
             information criterion is lower by {difference:.0}): use the straight line only between the measured \
             loads, or state law = \"hertz\" with stiffness = {}",
            quoted(hertz / f64::from(nodes), Dimension::HERTZ_STIFFNESS)
        ));
    }
    if half > slope {
        warnings
            .push("the interval of k reaches zero: apply higher loads, or add measurements".into());
    }
    let scatter = (found.squares / found.freedom as f64).sqrt();
    let facts = vec![
        ("bodies".to_owned(), bodies(interface).to_owned()),
        ("rows".to_owned(), force.len().to_string()),
        ("nodes that share the force".to_owned(), nodes.to_string()),
        ("scatter of the force".to_owned(), format!("{} N", short(scatter))),
    ];
    let scenario = format!(
        "[interface.{interface}]\nstiffness = {}\n# the law also needs a damping, which a drop test \
         gives\n",
        quoted(per_node, Dimension::STIFFNESS)
    );
    Ok(Calibration {
        title: format!(
            "press test {}: stiffness of {} (force proportional to penetration)",
            table.file(),
            bodies(interface)
        ),
        estimates: vec![stiffness, seating],
        figures: vec![picture(&penetration, &force, slope, offset)],
        facts,
        scenario,
        warnings,
        ..Calibration::default()
    })
}

/// Plots the readings and the fitted line.
fn picture(penetration: &[f64], force: &[f64], slope: f64, offset: f64) -> Figure {
    let scaled = |values: &[f64], by: f64| values.iter().map(|v| by * v).collect::<Vec<f64>>();
    let depth = scaled(penetration, 1e3);
    let line = |x: f64| 1e-3 * slope * (1e-3 * x - offset);
    let series = vec![
        curve("force in proportion to penetration", span(&depth), line),
        measured("measured", depth, scaled(force, 1e-3), 1),
    ];
    let caption = "Press test: force against penetration, and the least-squares line, whose slope is the \
                   stiffness.";
    let axes = [Axis::new("penetration", "mm"), Axis::new("force", "kN")];
    figure("press-test", caption, axes, series)
}

/// Returns `k` (N/m^1.5) of Hertz's law `F = k (δ − δ₀)^1.5`, and the amount by which the information
/// criterion (Akaike 1974) of this law is lower than the criterion of the straight line. Both laws have two
/// parameters.
///
/// For a given δ₀ the best `k` is a ratio of sums, so only δ₀ is searched. The first grid extends to either side of the
/// smallest reading by nearly the span of the readings; each further grid is finer and centered on the best value so
/// far.
fn hertz(penetration: &[f64], force: &[f64], line_squares: f64) -> Option<(f64, f64)> {
    let low = penetration.iter().copied().fold(f64::INFINITY, f64::min);
    let high = penetration.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let at = |offset: f64| {
        let shape = |x: &f64| {
            let depth = (x - offset).max(0.0);
            depth * depth.sqrt()
        };
        let own: f64 = penetration.iter().map(|x| shape(x) * shape(x)).sum();
        let product: f64 = penetration.iter().zip(force).map(|(x, f)| shape(x) * f).sum();
        let k = product / own;
        let left = |(x, f): (&f64, &f64)| (f - k * shape(x)) * (f - k * shape(x));
        (k, penetration.iter().zip(force).map(left).sum::<f64>())
    };
    let (mut center, mut width) = (low, high - low);
    for _ in 0..8 {
        let tries = (-20..=20).map(|i| center + width * f64::from(i) / 21.0);
        let best = tries.min_by(|a, b| at(*a).1.total_cmp(&at(*b).1))?;
        (center, width) = (best, width / 10.0);
    }
    let (k, squares) = at(center);
    let rows = force.len() as f64;
    // An exact fit leaves nothing to compare, up to the rounding of the sums.
    let rounding = 1e-24 * force.iter().map(|f| f * f).sum::<f64>();
    let ratio = line_squares.max(rounding) / squares.max(rounding);
    Some((k, rows * barrelstack_dynamics::math::log(ratio)))
}
