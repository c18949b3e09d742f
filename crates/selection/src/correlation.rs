//! Correlation of spectral accelerations at two periods.

use std::f64::consts::PI;

/// Period (s) below which the correlation model uses a different formula.
const SHORT: f64 = 0.109;

/// Returns the correlation between the residuals of ln Sa at two periods (s), for one horizontal component.
///
/// The model is that of Baker and Jayaram (2008, Earthquake Spectra 24:299-317), valid from 0.01 to 10 s.
pub fn spectral_correlation(one: f64, other: f64) -> f64 {
    let (low, high) = if one < other { (one, other) } else { (other, one) };
    if low == high {
        return 1.0;
    }
    let c1 = 1.0 - libm::cos(0.5 * PI - 0.366 * libm::log(high / low.max(SHORT)));
    let c2 = if high < 0.2 {
        let step = 1.0 - 1.0 / (1.0 + libm::exp(100.0 * high - 5.0));
        1.0 - 0.105 * step * (high - low) / (high - 0.0099)
    } else {
        0.0
    };
    let c3 = if high < SHORT { c2 } else { c1 };
    let c4 = c1 + 0.5 * (c3.sqrt() - c3) * (1.0 + libm::cos(PI * low / SHORT));
    if high < SHORT {
        c2
    } else if low > SHORT {
        c1
    } else if high < 0.2 {
        c2.min(c4)
    } else {
        c4
    }
}
