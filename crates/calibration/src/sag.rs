//! Stiffness of seats from the sag of a loaded rack, read from a dial gauge.

use barrelstack::scenario::Dimension;
use barrelstack_dynamics::math;
use barrelstack_fragility::student_quantile;
use barrelstack_report::{Axis, Figure};

use super::drop::GRAVITY;
use super::figures::{curve, figure, measured, span};
use super::result::{bodies, quoted, short};
use super::statistics::line;
use super::{CalibrateError, Calibration, Estimate, Table};

/// Names of the columns of the table.
const COLUMNS: [&str; 3] = ["load", "sag", "angle"];

/// Fits the stiffness of a seat to the sag of a body that rests on several seats.
///
/// The column `load` holds the mass that was placed on the body, and `sag` the deflection under that mass.
/// The optional column `angle` holds the angle between the contact normal and the vertical, for example in a
/// cradle. `seats` is the number of seats that share the load, so `sag = load g / (seats k cos² angle)`.
///
/// A line through the origin is fitted to sag against load. The 95 % interval of its slope follows from Student's t
/// distribution, and gives the interval of the stiffness.
///
/// # Errors
/// If the table lacks a column or has fewer than two rows, or if the sag does not grow with the load.
pub fn sag(table: &Table, seats: u32, interface: &str) -> Result<Calibration, CalibrateError> {
    let load = table.required("load", Dimension::MASS)?;
    let sag = table.required("sag", Dimension::LENGTH)?;
    let angle = if table.has("angle") {
        table.required("angle", Dimension::ANGLE)?
    } else {
        vec![0.0; load.len()]
    };
    if load.len() < 2 {
        return Err(table
            .unsuited("the scatter cannot be computed from one row: repeat the test at least once")
            .into());
    }
    // Vertical force (N) that gives the same sag on a single seat whose normal is vertical.
    let press: Vec<f64> = load
        .iter()
        .zip(&angle)
        .map(|(load, angle)| {
            let (_, cos) = math::sin_cos(*angle);
            load * GRAVITY / (f64::from(seats) * cos * cos)
        })
        .collect();
    let squares: f64 = press.iter().map(|x| x * x).sum();
    let give = press.iter().zip(&sag).map(|(x, y)| x * y).sum::<f64>() / squares;
    if !(give > 0.0 && give.is_finite()) {
        return Err(table
            .unsuited("the sag does not grow with the load: state load and sag relative to the unloaded rack, and sag \
                 as positive downward")
            .into());
    }
    let freedom = load.len() - 1;
    let left: f64 = press.iter().zip(&sag).map(|(x, y)| (y - give * x) * (y - give * x)).sum();
    let half = student_quantile(0.95, freedom) * (left / freedom as f64 / squares).sqrt();
    let high = if give > half { 1.0 / (give - half) } else { f64::INFINITY };
    let stiffness = Estimate {
        name: "stiffness k".to_owned(),
        value: 1.0 / give,
        low: 1.0 / (give + half),
        high,
        dimension: Dimension::STIFFNESS,
    };
    let mut warnings = table.unused(&COLUMNS);
    if let Some(found) = line(&press, &sag) {
        // Sag (m) at zero load, by a regression line that need not pass through the origin.
        let hollow = found.intercept;
        let variance = found.center_variance + found.center * found.center * found.slope_variance;
        if hollow.abs() > student_quantile(0.95, found.freedom) * variance.sqrt() {
            warnings.push(format!(
                "the line through the readings has a sag of {} mm at zero load, as if the seats were not in contact at \
                 first: apply a light load first, and measure load and sag relative to that state",
                short(1e3 * hollow)
            ));
        }
    }
    if high.is_infinite() {
        warnings.push(
            "the interval of k has no upper end: apply higher loads, or take more readings"
                .to_owned(),
        );
    }
    let scatter = (left / freedom as f64).sqrt();
    let depths: Vec<f64> = sag.iter().map(|sag| 1e3 * sag).collect();
    let forces: Vec<f64> = press.iter().map(|force| 1e-3 * force).collect();
    Ok(Calibration {
        title: format!(
            "sag test {}: stiffness of {} (sag proportional to load)",
            table.file(),
            bodies(interface)
        ),
        facts: vec![
            ("bodies".to_owned(), bodies(interface).to_owned()),
            ("rows".to_owned(), load.len().to_string()),
            ("seats that share the load".to_owned(), seats.to_string()),
            ("scatter of the sag".to_owned(), format!("{} mm", short(1e3 * scatter))),
        ],
        scenario: format!(
            "[interface.{interface}]\nbasis = \"seat\"\nstiffness = {}\n",
            quoted(stiffness.value, Dimension::STIFFNESS)
        ),
        estimates: vec![stiffness],
        figures: vec![picture(depths, forces, give)],
        warnings,
        ..Calibration::default()
    })
}

/// Plots the measured sag against the force on one seat, with the fitted line.
fn picture(sag: Vec<f64>, force: Vec<f64>, give: f64) -> Figure {
    let fit = curve("sag in proportion to load", span(&force), |force| 1e6 * give * force);
    let series = vec![fit, measured("measured", force, sag, 1)];
    let caption = "Sag test: sag against the force on one seat, and the least-squares line through the origin, whose \
                   slope is the reciprocal of the stiffness.";
    figure(
        "sag-test",
        caption,
        [Axis::new("force on a seat", "kN"), Axis::new("sag", "mm")],
        series,
    )
}
