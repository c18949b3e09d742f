//! Formulas and tables of the design codes.

use super::{ChileanZone, NCh2745Soil, SiteClass};
use crate::math::{self, PI, STANDARD_GRAVITY};

/// Interpolates between two points, linearly in the logarithms of both coordinates.
pub(super) fn log_log(x: f64, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> f64 {
    y0 * math::powf(y1 / y0, math::ln(x / x0) / math::ln(x1 / x0))
}

/// Returns the acceleration (g) of the design spectrum of ASCE 7-16, section 11.4.6, at the period `t` (s).
pub(super) fn asce7(sds: f64, sd1: f64, long_period: f64, damping: f64, t: f64) -> f64 {
    // Table 17.5-1, interpolated linearly.
    let damped = math::interpolate(
        &[0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5],
        &[0.8, 1.0, 1.2, 1.5, 1.7, 1.9, 2.0],
        damping,
    );
    let corner = sd1 / sds;
    let start = 0.2 * corner;
    if t < start {
        // Damping does not change the peak ground acceleration.
        sds * (0.4 + (1.0 / damped - 0.4) * t / start)
    } else if t <= corner {
        sds / damped
    } else if t <= long_period {
        sd1 / t / damped
    } else {
        sd1 * long_period / (t * t) / damped
    }
}

/// Returns the acceleration of the elastic spectrum of EN 1998-1:2004, section 3.2.2.2, at the period `t` (s), divided
/// by the ground acceleration on rock.
pub(super) fn eurocode8(site: SiteClass, small_magnitude: bool, damping: f64, t: f64) -> f64 {
    // Soil factor and corner periods, tables 3.2 and 3.3.
    let (s, tb, tc, td) = match (small_magnitude, site) {
        (false, SiteClass::A) => (1.0, 0.15, 0.4, 2.0),
        (false, SiteClass::B) => (1.2, 0.15, 0.5, 2.0),
        (false, SiteClass::C) => (1.15, 0.2, 0.6, 2.0),
        (false, SiteClass::D) => (1.35, 0.2, 0.8, 2.0),
        (false, SiteClass::E) => (1.4, 0.15, 0.5, 2.0),
        (true, SiteClass::A) => (1.0, 0.05, 0.25, 1.2),
        (true, SiteClass::B) => (1.35, 0.05, 0.25, 1.2),
        (true, SiteClass::C) => (1.5, 0.1, 0.25, 1.2),
        (true, SiteClass::D) => (1.8, 0.1, 0.3, 1.2),
        (true, SiteClass::E) => (1.6, 0.05, 0.25, 1.2),
    };
    let eta = (10.0 / (5.0 + 100.0 * damping)).sqrt().max(0.55);
    let plateau = 2.5 * eta * s;
    if t < tb {
        s * (1.0 + t / tb * (2.5 * eta - 1.0))
    } else if t <= tc {
        plateau
    } else if t <= td {
        plateau * tc / t
    } else {
        plateau * tc * td / (t * t)
    }
}

/// Returns the acceleration (g) of the elastic spectrum of the Chilean decree 61 of 2011, articles 11 to 13, at the
/// period `t` (s).
pub(super) fn nch433(zone: ChileanZone, site: SiteClass, t: f64) -> f64 {
    let a0 = match zone {
        ChileanZone::One => 0.2,
        ChileanZone::Two => 0.3,
        ChileanZone::Three => 0.4,
    };
    let (s, t0, p) = match site {
        SiteClass::A => (0.9, 0.15, 2.0),
        SiteClass::B => (1.0, 0.3, 1.5),
        SiteClass::C => (1.05, 0.4, 1.6),
        SiteClass::D => (1.2, 0.75, 1.0),
        SiteClass::E => (1.3, 1.2, 1.0),
    };
    let x = t / t0;
    s * a0 * (1.0 + 4.5 * math::powf(x, p)) / (1.0 + x * x * x)
}

/// Returns the acceleration (m/s²) of the base spectrum of `NCh2745.Of2003`, figure 1 and its table, at the period `t`
/// (s). It is divided by the damping factor `B_D`.
pub(super) fn nch2745(zone: ChileanZone, soil: NCh2745Soil, damping: f64, t: f64) -> f64 {
    let factor = match zone {
        ChileanZone::One => 0.75,
        ChileanZone::Two => 1.0,
        ChileanZone::Three => 1.25,
    };
    // Ground acceleration (g), corner periods Tb, Tc and Td (s), and the plateaus of acceleration,
    // velocity and displacement, in cm and s.
    let (ground, tb, tc, td, acceleration, velocity, displacement) = match soil {
        NCh2745Soil::I => (0.40, 0.11, 0.29, 2.51, 1085.0, 50.0, 20.0),
        NCh2745Soil::II => (0.41, 0.2, 0.54, 2.0, 1100.0, 94.0, 30.0),
        NCh2745Soil::III => (0.45, 0.375, 0.68, 1.58, 1212.0, 131.0, 33.0),
    };
    let damped = math::interpolate(
        &[0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5],
        &[0.65, 1.0, 1.37, 1.67, 1.94, 2.17, 2.38, 3.02],
        damping,
    );
    let ta = 0.03;
    let ground = 100.0 * ground * STANDARD_GRAVITY;
    let w = 2.0 * PI / t.max(ta);
    let base = if t <= ta {
        ground
    } else if t < tb {
        ground + (acceleration - ground) * (t - ta) / (tb - ta)
    } else if t <= tc {
        acceleration
    } else if t <= td {
        w * velocity
    } else {
        w * w * displacement
    };
    0.01 * factor * base / damped
}

/// Returns the acceleration (g) of the elastic spectrum of NZS 1170.5:2004, section 3.1.1, at the period `t` (s).
pub(super) fn nzs1170(
    hazard: f64,
    return_period: f64,
    site: SiteClass,
    fault_distance: Option<f64>,
    t: f64,
) -> f64 {
    // Section 3.1.6: there is no near-fault factor for annual probabilities of 1/250 and above,
    // that is, for R up to 0.75.
    let near_fault = match fault_distance {
        Some(distance) if return_period > 0.75 => nzs_near_fault(distance, t),
        _ => 1.0,
    };
    nzs_shape(site, t) * (hazard * return_period).min(0.7) * near_fault
}

/// Returns the spectral shape factor `Ch(T)` of table 3.1, with the short-period values for modal
/// and time-history analysis.
fn nzs_shape(site: SiteClass, t: f64) -> f64 {
    // Ch(T) is `start + slope T/0.1` below 0.1 s, `plateau` up to `end` (s), `a (b/T)^0.75` up to
    // 1.5 s, `c/T` up to 3 s, and `d/T²` for longer periods.
    let (start, slope, plateau, end, (a, b), c, d) = match site {
        SiteClass::A | SiteClass::B => (1.0, 1.35, 2.35, 0.3, (1.6, 0.5), 1.05, 3.15),
        SiteClass::C => (1.33, 1.6, 2.93, 0.3, (2.0, 0.5), 1.32, 3.96),
        SiteClass::D => (1.12, 1.88, 3.0, 0.56, (2.4, 0.75), 2.14, 6.42),
        SiteClass::E => (1.12, 1.88, 3.0, 1.0, (3.0, 1.0), 3.32, 9.96),
    };
    if t < 0.1 {
        start + slope * t / 0.1
    } else if t < end {
        plateau
    } else if t <= 1.5 {
        a * math::powf(b / t, 0.75)
    } else if t <= 3.0 {
        c / t
    } else {
        d / (t * t)
    }
}

/// Returns the near-fault factor `N(T, D)` of section 3.1.6.
fn nzs_near_fault(distance: f64, t: f64) -> f64 {
    let largest = math::interpolate(&[1.5, 2.0, 3.0, 4.0, 5.0], &[1.0, 1.12, 1.36, 1.6, 1.72], t);
    if distance <= 2.0 {
        largest
    } else if distance >= 20.0 {
        1.0
    } else {
        1.0 + (largest - 1.0) * (20.0 - distance) / 18.0
    }
}

/// Returns the required response spectrum (g) of ICC-ES AC156 with ASCE 7-16, section 6.5.1.
/// Between its corner points, the logarithm of the acceleration is linear in the logarithm of the
/// frequency.
pub(super) fn ac156(sds: f64, height_ratio: f64, t: f64) -> f64 {
    let amplification = 1.0 + 2.0 * height_ratio;
    let flexible = (sds * amplification).min(1.6 * sds);
    let rigid = 0.4 * sds * amplification;
    let (first, low, mid, high) = (0.1, 1.3, 8.3, 33.3);
    let f = 1.0 / t.max(1e-9);
    if f < low {
        log_log(f, (first, 0.1 * flexible), (low, flexible))
    } else if f <= mid {
        flexible
    } else if f < high {
        log_log(f, (mid, flexible), (high, rigid))
    } else {
        rigid
    }
}
