//! Derives a constant time step from a time column; unevenly spaced samples are interpolated.

use super::source::{Columns, Source};
use crate::error::ReadError;
use crate::math;
use crate::record::Record;

/// Columns of values, with the time of each row.
pub(crate) struct Timed {
    /// Line of the first row, counted from 0.
    pub(crate) first_line: usize,
    /// Number of samples on each line of the file; a sample is a time with its values.
    pub(crate) per_line: usize,
    /// Times (s).
    pub(crate) time: Vec<f64>,
    /// Values, one column per channel.
    pub(crate) values: Vec<Vec<f64>>,
    /// One unit of the last printed digit of the times (s).
    pub(crate) resolution: f64,
}

impl Timed {
    /// Creates columns from pairs of time and value.
    pub(crate) fn of_pairs(
        first_line: usize,
        pairs: Columns,
        numbers: &[f64],
        resolution: f64,
    ) -> Self {
        let (time, values) = numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).unzip();
        Self { first_line, per_line: pairs.per_line / 2, time, values: vec![values], resolution }
    }
}

/// Returns the constant time step (s) of the columns, and the columns sampled at this step.
///
/// If the times are evenly spaced to within their printed digits, the exact step is derived from them. Otherwise, the
/// values are interpolated linearly at a finer step, with a warning.
pub(crate) fn even_steps(
    source: &Source<'_>,
    record: &mut Record,
    label: &str,
    timed: Timed,
) -> Result<(f64, Vec<Vec<f64>>), ReadError> {
    let Timed { first_line, per_line, time, values, resolution } = timed;
    let line_of = |row: usize| first_line + row / per_line.max(1);
    if time.len() < 2 {
        return Err(source.cut("at least 2 rows", format!("{} rows", time.len())));
    }
    // Coarsely printed times may repeat; only decreasing times indicate damage.
    let back = (1..time.len()).find(|&row| !(time[row] >= time[row - 1]));
    let stuck = (time.len() > 2 && time[time.len() - 1] <= time[0]).then_some(1);
    if let Some(row) = back.or(stuck) {
        return Err(source.damaged(
            line_of(row),
            format!("a time after {} s", time[row - 1]),
            format!("{} s", time[row]),
            "rows are repeated, lost or out of order; get the file again from its source",
        ));
    }
    let (first, last) = (time[0], time[time.len() - 1]);
    let mean = (last - first) / (time.len() - 1) as f64;
    let fits = |step: f64| {
        time.iter().enumerate().all(|(k, t)| {
            (t - first - k as f64 * step).abs() <= 0.51 * resolution + slack(*t, first)
        })
    };
    if let Some(step) = candidates(mean, resolution / (last - first)).find(|&step| fits(step)) {
        return Ok((step, values));
    }
    if let Some(step) = jittered(&time, mean, resolution) {
        record.warn(
            first_line + 1,
            format!(
                "channel {label}: the times deviate from an even step of {step} s only in their \
                 last digits; the even step is used"
            ),
        );
        return Ok((step, values));
    }
    // If the step is even except for one gap, a line was lost; the record was not digitized by
    // hand.
    let (mut shortest, mut longest, mut hole) = (f64::INFINITY, 0.0_f64, 1);
    for row in 1..time.len() {
        let gap = time[row] - time[row - 1];
        shortest = shortest.min(gap);
        if gap > longest {
            (longest, hole) = (gap, row);
        }
    }
    if longest > 20.0 * mean {
        return Err(source.damaged(
            line_of(hole),
            format!("a step near {mean:.4} s"),
            format!("a gap of {longest:.4} s"),
            "rows were lost; get the file again from its source",
        ));
    }
    let step = math::powf(10.0, math::log10(0.5 * mean).floor());
    let step = [5.0, 2.0, 1.0].into_iter().map(|m| m * step).find(|s| *s <= 0.5 * mean);
    let step = step.unwrap_or(0.5 * mean);
    let count = ((last - first) / step + 1e-9).floor();
    if !(count < 1e8) {
        return Err(source.damaged(
            first_line,
            "usable times",
            format!("{first} to {last} s with a mean step of {mean} s"),
            "the time column is damaged; get the file again from its source",
        ));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e8")]
    let count = count as usize;
    let columns = values
        .iter()
        .map(|column| {
            (0..=count).map(|k| math::interpolate(&time, column, first + k as f64 * step)).collect()
        })
        .collect();
    record.warn(
        first_line + 1,
        format!(
            "channel {label}: unevenly spaced times ({shortest:.4} to {longest:.4} s, mean \
             {mean:.5} s) were interpolated linearly to an even step of {step} s"
        ),
    );
    Ok((step, columns))
}

/// Returns the tolerance (s) for rounding errors in a time. It is 10⁻⁹ times the time since the first sample, plus a
/// few units in the last place of `time`. The second term matters for times since 1970, which are large numbers.
fn slack(time: f64, first: f64) -> f64 {
    1e-9 * (time - first).abs() + 4.0 * f64::EPSILON * time.abs()
}

/// Returns a time step (s), the reciprocal of a whole number, that fits all times to within one unit of their last
/// printed digit; `None` if there is no such step. Deviations of up to one unit occur if a program truncates the times
/// instead of rounding them.
fn jittered(time: &[f64], mean: f64, resolution: f64) -> Option<f64> {
    let step = 1.0 / (1.0 / mean).round();
    let strays = |(k, t): (usize, &f64)| {
        (t - time[0] - k as f64 * step).abs() > 1.01 * resolution + slack(*t, time[0])
    };
    // Times printed more coarsely than the step would not show whether they are even.
    let fine = resolution < 0.5 * step;
    (fine && !time.iter().enumerate().any(strays)).then_some(step)
}

/// Returns candidates for the time step: round numbers that differ from the mean step by at most
/// about `relative` times the mean step, then the mean step itself.
fn candidates(mean: f64, relative: f64) -> impl Iterator<Item = f64> {
    let rate = (1.0 / mean).round();
    let decimal = (mean * 1e5).round() / 1e5;
    let near = move |step: &f64| {
        step.is_finite() && *step > 0.0 && (step / mean - 1.0).abs() <= relative.max(1e-9) * 1.01
    };
    [1.0 / rate, decimal].into_iter().filter(near).chain(std::iter::once(mean))
}
