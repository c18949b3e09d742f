//! Code and table spectra: pseudo-acceleration at 5 % damping as a function of period.

use crate::error::MotionError;
use crate::math::{self, PI, STANDARD_GRAVITY};

/// Soil or site classes `A` to `E`, each code with its own meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SiteClass {
    /// Strong rock.
    A,
    /// Rock.
    B,
    /// Dense or shallow soil.
    C,
    /// Soft or deep soil.
    D,
    /// Very soft soil; in Eurocode 8 a thin soft layer over rock.
    E,
}

/// Seismic zones of Chile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChileanZone {
    /// The Andes.
    One,
    /// The central valley.
    Two,
    /// The coast.
    Three,
}

/// Soils of `NCh2745`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NCh2745Soil {
    /// Rock.
    I,
    /// Dense soil.
    II,
    /// Soft soil.
    III,
}

/// A target spectrum (m/s², 5 % damping unless a damping is part of it).
#[derive(Clone, Debug, PartialEq)]
pub enum TargetSpectrum {
    /// ASCE/SEI 7, section 11.4: design spectrum of two ordinates and the long-period transition.
    Asce7 {
        /// `S_DS` (g).
        sds: f64,
        /// `S_D1` (g).
        sd1: f64,
        /// `T_L` (s).
        long_period: f64,
    },
    /// EN 1998-1:2004, section 3.2.2.2: horizontal elastic spectrum.
    Eurocode8 {
        /// Ground acceleration on rock `a_g` (g), importance included.
        ground_acceleration: f64,
        /// Ground type.
        site: SiteClass,
        /// Type 2 (small magnitudes) instead of type 1.
        small_magnitude: bool,
        /// Damping ratio, 0.05 for `η = 1`.
        damping: f64,
    },
    /// `NCh433` with decree 61 of 2011: elastic spectrum `S A0 α(T)`, importance 1.
    NCh433 {
        /// Seismic zone, which gives `A0` = 0.20, 0.30 or 0.40 g.
        zone: ChileanZone,
        /// Soil class of decree 61.
        site: SiteClass,
    },
    /// `NCh2745` (base isolation), base spectrum of acceleration, velocity and displacement branches;
    /// acceleration 0.41 g at short periods in zone 2.
    NCh2745 {
        /// Seismic zone, factor 3/4, 1 or 5/4.
        zone: ChileanZone,
        /// Soil.
        soil: NCh2745Soil,
    },
    /// NZS 1170.5:2004, section 3.1: `C(T) = Ch(T) Z R N(T, D)`.
    Nzs1170 {
        /// Hazard factor `Z`.
        hazard: f64,
        /// Return period factor `R`.
        return_period: f64,
        /// Site subsoil class.
        site: SiteClass,
        /// Distance to the nearest major fault (km); `None` for no near-fault factor.
        fault_distance: Option<f64>,
    },
    /// ICC-ES AC156: horizontal required response spectrum for shake-table tests, defined from 1.3 to
    /// 33.3 Hz; below 1.3 Hz it falls in proportion to frequency.
    Ac156 {
        /// `S_DS` (g).
        sds: f64,
        /// Height of attachment over roof height, 0 to 1.
        height_ratio: f64,
    },
    /// Points `(period (s), acceleration (m/s²))` in ascending order, linear between in the
    /// logarithm of both; held outside.
    Table(Vec<(f64, f64)>),
}

impl TargetSpectrum {
    /// Checks the parameters.
    ///
    /// # Errors
    /// Names the first that is out of range.
    pub fn check(&self) -> Result<(), MotionError> {
        let positive = MotionError::require_positive;
        match self {
            Self::Asce7 { sds, sd1, long_period } => {
                positive("S_DS (g)", *sds)?;
                positive("S_D1 (g)", *sd1)?;
                positive("T_L (s)", *long_period)?;
                if sd1 / sds >= *long_period {
                    return Err(MotionError::parameter(
                        "T_L (s)",
                        format!("above S_D1/S_DS = {}", sd1 / sds),
                        long_period,
                    ));
                }
                Ok(())
            }
            Self::Eurocode8 { ground_acceleration, damping, .. } => {
                positive("ground acceleration (g)", *ground_acceleration)?;
                crate::response::check_oscillator(1.0, *damping)
            }
            Self::NCh433 { .. } | Self::NCh2745 { .. } => Ok(()),
            Self::Nzs1170 { hazard, return_period, fault_distance, .. } => {
                positive("hazard factor Z", *hazard)?;
                positive("return period factor R", *return_period)?;
                match fault_distance {
                    Some(distance) if !(*distance >= 0.0) => {
                        Err(MotionError::parameter("fault distance (km)", "0 or above", distance))
                    }
                    _ => Ok(()),
                }
            }
            Self::Ac156 { sds, height_ratio } => {
                positive("S_DS (g)", *sds)?;
                if (0.0..=1.0).contains(height_ratio) {
                    Ok(())
                } else {
                    Err(MotionError::parameter("height ratio z/h", "0 to 1", height_ratio))
                }
            }
            Self::Table(points) => check_table(points),
        }
    }

    /// The damping ratio the spectrum is for.
    pub fn damping(&self) -> f64 {
        match self {
            Self::Eurocode8 { damping, .. } => *damping,
            Self::Asce7 { .. }
            | Self::NCh433 { .. }
            | Self::NCh2745 { .. }
            | Self::Nzs1170 { .. }
            | Self::Ac156 { .. }
            | Self::Table(_) => 0.05,
        }
    }

    /// Pseudo-acceleration (m/s²) at a period (s).
    pub fn acceleration(&self, period: f64) -> f64 {
        let t = period.max(0.0);
        match self {
            Self::Asce7 { sds, sd1, long_period } => {
                STANDARD_GRAVITY * asce7(*sds, *sd1, *long_period, t)
            }
            Self::Eurocode8 { ground_acceleration, site, small_magnitude, damping } => {
                STANDARD_GRAVITY
                    * ground_acceleration
                    * eurocode8(*site, *small_magnitude, *damping, t)
            }
            Self::NCh433 { zone, site } => STANDARD_GRAVITY * nch433(*zone, *site, t),
            Self::NCh2745 { zone, soil } => nch2745(*zone, *soil, t),
            Self::Nzs1170 { hazard, return_period, site, fault_distance } => {
                STANDARD_GRAVITY
                    * hazard
                    * return_period
                    * nzs_shape(*site, t)
                    * fault_distance.map_or(1.0, |distance| nzs_near_fault(distance, t))
            }
            Self::Ac156 { sds, height_ratio } => STANDARD_GRAVITY * ac156(*sds, *height_ratio, t),
            Self::Table(points) => table(points, t),
        }
    }
}

fn check_table(points: &[(f64, f64)]) -> Result<(), MotionError> {
    if points.len() < 2 {
        return Err(MotionError::parameter("target table", "at least 2 points", points.len()));
    }
    for (k, (period, acceleration)) in points.iter().enumerate() {
        let row = format!("target table, row {}", k + 1);
        MotionError::require_positive(&format!("{row}, period (s)"), *period)?;
        MotionError::require_positive(&format!("{row}, acceleration (m/s2)"), *acceleration)?;
        if k > 0 && *period <= points[k - 1].0 {
            return Err(MotionError::parameter(
                format!("{row}, period (s)"),
                format!("above {}", points[k - 1].0),
                period,
            ));
        }
    }
    Ok(())
}

fn table(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.partition_point(|(period, _)| *period < t);
    match (after.checked_sub(1).and_then(|k| points.get(k)), points.get(after)) {
        (Some((t0, a0)), Some((t1, a1))) => log_log(t, (*t0, *a0), (*t1, *a1)),
        (None, Some((_, a))) | (Some((_, a)), None) => *a,
        (None, None) => 0.0,
    }
}

/// The straight line through two points in the logarithm of both.
fn log_log(x: f64, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> f64 {
    y0 * math::powf(y1 / y0, math::ln(x / x0) / math::ln(x1 / x0))
}

fn asce7(sds: f64, sd1: f64, long_period: f64, t: f64) -> f64 {
    let corner = sd1 / sds;
    let start = 0.2 * corner;
    if t < start {
        sds * (0.4 + 0.6 * t / start)
    } else if t <= corner {
        sds
    } else if t <= long_period {
        sd1 / t
    } else {
        sd1 * long_period / (t * t)
    }
}

fn eurocode8(site: SiteClass, small_magnitude: bool, damping: f64, t: f64) -> f64 {
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

fn nch433(zone: ChileanZone, site: SiteClass, t: f64) -> f64 {
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

fn nch2745(zone: ChileanZone, soil: NCh2745Soil, t: f64) -> f64 {
    let factor = match zone {
        ChileanZone::One => 0.75,
        ChileanZone::Two => 1.0,
        ChileanZone::Three => 1.25,
    };
    // Corner periods Tb, Tc, Td (s) and plateaus of acceleration, velocity and displacement in cm.
    let (tb, tc, td, acceleration, velocity, displacement) = match soil {
        NCh2745Soil::I => (0.11, 0.29, 2.51, 1085.0, 50.0, 20.0),
        NCh2745Soil::II => (0.2, 0.54, 2.0, 1100.0, 94.0, 30.0),
        NCh2745Soil::III => (0.375, 0.68, 1.58, 1212.0, 131.0, 33.0),
    };
    let ta = 0.03;
    let ground = 100.0 * 0.41 * STANDARD_GRAVITY;
    let w = 2.0 * PI / t.max(ta);
    factor
        * 0.01
        * if t <= ta {
            ground
        } else if t < tb {
            log_log(t, (ta, ground), (tb, acceleration))
        } else if t <= tc {
            acceleration
        } else if t <= td {
            w * velocity
        } else {
            w * w * displacement
        }
}

/// Spectral shape factor `Ch(T)` of table 3.1 (modal and time-history values at short periods).
fn nzs_shape(site: SiteClass, t: f64) -> f64 {
    let power = |a: f64, reference: f64| a * math::powf(reference / t, 0.75);
    match site {
        SiteClass::A | SiteClass::B => match t {
            _ if t < 0.1 => 1.0 + 1.35 * t / 0.1,
            _ if t < 0.3 => 2.35,
            _ if t <= 1.5 => power(1.6, 0.5),
            _ if t <= 3.0 => 1.05 / t,
            _ => 3.15 / (t * t),
        },
        SiteClass::C => match t {
            _ if t < 0.1 => 1.33 + 1.6 * t / 0.1,
            _ if t < 0.3 => 2.93,
            _ if t <= 1.5 => power(2.0, 0.5),
            _ if t <= 3.0 => 1.32 / t,
            _ => 3.96 / (t * t),
        },
        SiteClass::D => match t {
            _ if t < 0.1 => 1.12 + 1.88 * t / 0.1,
            _ if t < 0.56 => 3.0,
            _ if t <= 1.5 => power(2.4, 0.75),
            _ if t <= 3.0 => 2.14 / t,
            _ => 6.42 / (t * t),
        },
        SiteClass::E => match t {
            _ if t < 0.1 => 1.12 + 1.88 * t / 0.1,
            _ if t < 1.0 => 3.0,
            _ if t <= 1.5 => power(3.0, 1.0),
            _ if t <= 3.0 => 3.32 / t,
            _ => 9.96 / (t * t),
        },
    }
}

/// Near-fault factor `N(T, D)` of section 3.1.6 for annual probabilities below 1/250.
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

fn ac156(sds: f64, height_ratio: f64, t: f64) -> f64 {
    let amplification = 1.0 + 2.0 * height_ratio;
    let flexible = (sds * amplification).min(1.6 * sds);
    let rigid = 0.4 * sds * amplification;
    let (low, mid, high) = (1.3, 8.3, 33.3);
    let f = 1.0 / t.max(1e-9);
    if f < low {
        flexible * f / low
    } else if f <= mid {
        flexible
    } else if f < high {
        log_log(f, (mid, flexible), (high, rigid))
    } else {
        rigid
    }
}
