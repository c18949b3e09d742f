//! Friction coefficients from pull tests or tilt tests.

use std::fmt::Write as _;

use barrelstack::scenario::Dimension;
use barrelstack_dynamics::math;
use barrelstack_fragility::student_quantile;
use barrelstack_report::{Axis, Figure};

use super::drop::GRAVITY;
use super::figures::{figure, level, measured, span};
use super::result::{bodies, rounded, short};
use super::statistics::{line, mean};
use super::{CalibrateError, Calibration, Estimate, Table};

/// Columns of pull tests and of tilt tests.
const COLUMNS: [&str; 6] = [
    "normal force",
    "breakaway force",
    "sliding force",
    "angle",
    "sliding distance",
    "sliding time",
];

/// Estimates static and kinetic friction from a table of repeated tests, one per row.
///
/// Pull tests have the columns `normal force`, `breakaway force` (the largest pull before the body moves) and, for the
/// kinetic coefficient, `sliding force`; the coefficients are the ratios of these two forces to the normal force. Tilt
/// tests have the column `angle`, the angle of first slip, whose tangent is the static coefficient. For the kinetic
/// coefficient they also have `sliding distance` and `sliding time`, measured from rest at that angle:
/// `μ = tan α − 2 s / (t² g cos α)`. Each coefficient is the mean over the rows; its interval follows from Student's t
/// distribution.
///
/// # Errors
/// If the table lacks its columns, has fewer than two rows, or contains an impossible value.
pub fn friction(table: &Table, interface: &str) -> Result<Calibration, CalibrateError> {
    let (test, rest, slide) = if table.has("angle") {
        let (rest, slide) = tilt(table)?;
        ("tilt", rest, slide)
    } else {
        let (rest, slide) = pull(table)?;
        ("pull", rest, slide)
    };
    if rest.len() < 2 {
        return Err(table
            .unsuited("the scatter cannot be computed from one row: repeat the test at least once")
            .into());
    }
    let coefficient = |name: &str, values: &[f64]| {
        let (value, half) = mean(values);
        Estimate::symmetric(name, value, half, Dimension::NONE)
    };
    let mut warnings = table.unused(&COLUMNS);
    warnings.extend(load_warning(table, &rest)?);
    let static_estimate = coefficient("static friction", &rest);
    let mut estimates = vec![static_estimate];
    let mut scenario = format!("[interface.{interface}.friction]\n");
    let at_rest = estimates[0].value;
    let coefficients = [Some(rest.clone()), slide.clone()];
    if let Some(slide) = &slide {
        let kinetic = coefficient("kinetic friction", slide);
        if kinetic.value <= 0.0 {
            return Err(table.unsuited(format!(
                "the computed kinetic coefficient is {}: check distance, time and angle, and their units",
                short(kinetic.value)
            )).into());
        }
        let _ = writeln!(scenario, "coefficient = {}", rounded(kinetic.value));
        if at_rest > kinetic.value {
            let _ = writeln!(scenario, "static_coefficient = {}", rounded(at_rest));
        } else {
            warnings.push(
                "the kinetic coefficient is not below the static one: static_coefficient is omitted, and the \
                 kinetic coefficient is used for both"
                    .to_owned(),
            );
        }
        estimates.push(kinetic);
    } else {
        let _ = writeln!(scenario, "coefficient = {}", rounded(at_rest));
        warnings.push(
            "sliding was not tested: the kinetic coefficient is set to the static one, although it is usually \
             smaller"
                .to_owned(),
        );
    }
    // Variants draw friction from the scatter of the tests.
    let field = match interface {
        "barrel-rack" => Some("friction_barrel_rack"),
        "rack-ground" => Some("friction_ground"),
        _ => None,
    };
    if let Some(field) = field {
        let scatter = rounded(dispersion(slide.as_deref().unwrap_or(&rest)).min(1.0));
        let _ = write!(scenario, "\n[unknowns]\n{field} = {scatter}\n");
    }
    warnings.extend(estimates.iter().filter(|estimate| estimate.low <= 0.0).map(|estimate| {
        format!("the interval of {} reaches zero: repeat the test", estimate.name)
    }));
    Ok(Calibration {
        title: format!("{test} test {}: friction of {}", table.file(), bodies(interface)),
        figures: vec![picture(table, bodies(interface), &coefficients, &estimates)?],
        facts: vec![
            ("bodies".to_owned(), bodies(interface).to_owned()),
            ("tests".to_owned(), rest.len().to_string()),
        ],
        estimates,
        scenario,
        warnings,
        ..Calibration::default()
    })
}

/// Plots the coefficient of every test, and each mean with its interval. The horizontal axis is the normal force for
/// pull tests, and the number of the test for tilt tests.
fn picture(
    table: &Table,
    bodies: &str,
    coefficients: &[Option<Vec<f64>>; 2],
    estimates: &[Estimate],
) -> Result<Figure, CalibrateError> {
    let (x, axis) = if table.has("angle") {
        let count = coefficients[0].as_ref().map_or(0, Vec::len);
        ((1..=count).map(|test| test as f64).collect(), Axis::new("test", ""))
    } else {
        let load = table.positive("normal force", Dimension::FORCE)?;
        (load.iter().map(|force| 1e-3 * force).collect::<Vec<f64>>(), Axis::new("load", "kN"))
    };
    let mut series = Vec::new();
    for (index, (values, estimate)) in coefficients.iter().flatten().zip(estimates).enumerate() {
        series.push(level(estimate, span(&x), index));
        let label = format!("{}, single tests", estimate.name);
        series.push(measured(&label, x.clone(), values.clone(), index));
    }
    let caption = format!(
        "Coefficient of friction of {bodies} in every test, and the mean with its 95 % interval."
    );
    Ok(figure("friction-tests", &caption, [axis, Axis::new("coefficient of friction", "")], series))
}

/// Returns the standard deviation of ln μ that is expected for a further test: it includes the scatter of the tests and
/// the uncertainty of their mean.
fn dispersion(values: &[f64]) -> f64 {
    let logs: Vec<f64> = values.iter().map(|value| libm::log(*value)).collect();
    let count = logs.len() as f64;
    let middle = logs.iter().sum::<f64>() / count;
    let squares: f64 = logs.iter().map(|log| (log - middle) * (log - middle)).sum();
    (squares / (count - 1.0) * (1.0 + 1.0 / count)).sqrt()
}

/// Static coefficients, and kinetic coefficients if they were measured.
type Coefficients = (Vec<f64>, Option<Vec<f64>>);

fn pull(table: &Table) -> Result<Coefficients, CalibrateError> {
    let normal = table.positive("normal force", Dimension::FORCE)?;
    let over_normal = |column: &str| -> Result<Vec<f64>, CalibrateError> {
        let pull = table.positive(column, Dimension::FORCE)?;
        Ok(pull.iter().zip(&normal).map(|(pull, normal)| pull / normal).collect())
    };
    let rest = over_normal("breakaway force")?;
    let slide = table.has("sliding force").then(|| over_normal("sliding force")).transpose()?;
    Ok((rest, slide))
}

fn tilt(table: &Table) -> Result<Coefficients, CalibrateError> {
    let angles = table.positive("angle", Dimension::ANGLE)?;
    if let Some(row) = angles.iter().position(|angle| *angle >= std::f64::consts::FRAC_PI_2) {
        let found = table.cell(row, "angle");
        let remedy = "correct the angle, or its unit in the header";
        return Err(table.at(row, "angle", "less than a right angle", &found, remedy).into());
    }
    let rest = angles.iter().map(|angle| math::tan(*angle)).collect();
    if !table.has("sliding distance") && !table.has("sliding time") {
        return Ok((rest, None));
    }
    let distance = table.positive("sliding distance", Dimension::LENGTH)?;
    let time = table.positive("sliding time", Dimension::TIME)?;
    let slide = angles.iter().zip(distance.iter().zip(&time)).map(|(angle, (distance, time))| {
        math::tan(*angle) - 2.0 * distance / (time * time * GRAVITY * math::cos(*angle))
    });
    Ok((rest, Some(slide.collect())))
}

/// Returns a warning if the coefficient depends on the normal force, that is, if the 99 % interval of the
/// slope excludes zero.
fn load_warning(table: &Table, rest: &[f64]) -> Result<Option<String>, CalibrateError> {
    if !table.has("normal force") || table.has("angle") {
        return Ok(None);
    }
    let normal = table.positive("normal force", Dimension::FORCE)?;
    let Some(found) = line(&normal, rest) else { return Ok(None) };
    let clear =
        found.slope.abs() > student_quantile(0.99, found.freedom) * found.slope_variance.sqrt();
    let low = normal.iter().copied().fold(f64::INFINITY, f64::min);
    let high = normal.iter().copied().fold(0.0, f64::max);
    let at = |force: f64| short(found.intercept + found.slope * force);
    Ok(clear.then(|| {
        format!(
            "the coefficient changes with the load, from {} at {} N to {} at {} N: test near the load that the \
             interface carries in the stack",
            at(low),
            short(low),
            at(high),
            short(high)
        )
    }))
}
