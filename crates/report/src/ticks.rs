//! Axis ticks: steps of 1, 2 or 5 times a power of ten.

use crate::number;

/// Tick values in increasing order and their labels.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Positions of the ticks.
    pub values: Vec<f64>,
    /// Labels of the ticks; the label of an unlabeled tick is empty.
    pub labels: Vec<String>,
}

/// Returns linear ticks inside `[low, high]`, with at most `target` intervals.
///
/// The step is the smallest of 1, 2, 5 × 10ⁿ that gives no more than `target` intervals.
/// An empty, reversed or infinite range gives no ticks.
///
/// ```
/// let ticks = barrelstack_report::linear_ticks(0.0, 1.0, 5);
/// assert_eq!(ticks.labels, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
/// ```
pub fn linear_ticks(low: f64, high: f64, target: usize) -> Ticks {
    let none = Ticks { values: Vec::new(), labels: Vec::new() };
    let span = high - low;
    // Below this span, ticks are indistinguishable in double precision.
    let resolvable = span > 1e-12 * low.abs().max(high.abs());
    if !(span.is_finite() && span > 0.0 && resolvable) {
        return none;
    }
    let rough = span / target.max(1) as f64;
    let mut exponent = rough.log10().floor();
    let mantissa = rough / 10_f64.powf(exponent);
    // The slack keeps quotients such as 0.2/0.1 from selecting the next larger step.
    let factor = match mantissa {
        m if m <= 1.0 + 1e-9 => 1.0,
        m if m <= 2.0 + 1e-9 => 2.0,
        m if m <= 5.0 + 1e-9 => 5.0,
        _ => {
            exponent += 1.0;
            1.0
        }
    };
    let step = factor * 10_f64.powf(exponent);
    let first = (low / step - 1e-9).ceil();
    let last = (high / step + 1e-9).floor();
    if !(first.is_finite() && last >= first && last - first < 1000.0) {
        return none;
    }
    let mut values = Vec::new();
    let mut index = first;
    while index <= last {
        // Dividing by a whole power of ten gives 0.3 where multiplying by 0.1 gives 0.30000000000000004.
        let value =
            if exponent < 0.0 { index * factor / 10_f64.powf(-exponent) } else { index * step };
        values.push(value + 0.0);
        index += 1.0;
    }
    let largest = low.abs().max(high.abs());
    let labels = if (1e-4..1e6).contains(&largest) {
        let decimals = usize::try_from(to_i32(-exponent)).unwrap_or(0);
        values.iter().map(|v| number::fixed(*v, decimals)).collect()
    } else {
        let scale = 10_f64.powf(exponent);
        let power = number::superscript(i64::from(to_i32(exponent)));
        values
            .iter()
            .map(|v| match number::fixed(v / scale, 0) {
                zero if zero == "0" => zero,
                text => format!("{text}×10{power}"),
            })
            .collect()
    };
    Ticks { values, labels }
}

/// Returns logarithmic ticks inside `[low, high]`, both above zero.
///
/// Ticks are at 1, 2, 5 × 10ⁿ. In a range of up to three decades, all ticks are labeled; in a wider
/// range, only powers of ten are labeled. Invalid ranges give no ticks.
pub fn log_ticks(low: f64, high: f64) -> Ticks {
    let mut ticks = Ticks { values: Vec::new(), labels: Vec::new() };
    if !(low > 0.0 && high > low && high.is_finite()) {
        return ticks;
    }
    let (from, to) = (to_i32(low.log10().floor()), to_i32(high.log10().ceil()));
    let decades = (high / low).log10();
    let stride = 1 + to_i32(decades / 12.0);
    for exponent in (from..=to).filter(|e| (e - from) % stride == 0) {
        let factors: &[f64] = if decades > 5.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        for &factor in factors {
            let value = if exponent < 0 {
                factor / 10_f64.powi(-exponent)
            } else {
                factor * 10_f64.powi(exponent)
            };
            if value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9) {
                continue;
            }
            ticks.values.push(value);
            let labeled = factor == 1.0 || decades <= 3.0;
            ticks.labels.push(match exponent {
                _ if !labeled => String::new(),
                -3..=4 => format!("{value}"),
                _ if factor == 1.0 => format!("10{}", number::superscript(i64::from(exponent))),
                _ => format!("{factor}×10{}", number::superscript(i64::from(exponent))),
            });
        }
    }
    ticks
}

/// Returns the largest length of 1, 2 or 5 × 10ⁿ that does not exceed `most`; zero if `most` is not
/// positive.
pub(crate) fn round_length(most: f64) -> f64 {
    if !(most.is_finite() && most > 0.0) {
        return 0.0;
    }
    let scale = 10_f64.powf(most.log10().floor());
    let factor = match most / scale {
        m if m >= 5.0 => 5.0,
        m if m >= 2.0 => 2.0,
        _ => 1.0,
    };
    factor * scale
}

#[expect(clippy::cast_possible_truncation, reason = "exponents of finite doubles are below 400")]
fn to_i32(value: f64) -> i32 {
    value as i32
}
