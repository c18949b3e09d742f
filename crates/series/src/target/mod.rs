//! Target spectra from design codes and tables: pseudo-acceleration as a function of period.

mod codes;
mod text;

use crate::error::MotionError;
use crate::math::STANDARD_GRAVITY;
use codes::log_log;

/// Site classes `A` to `E`; their exact meaning depends on the code.
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
    /// Very soft soil; in Eurocode 8, a thin soft layer over rock.
    E,
}

/// Seismic zones of Chile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChileanZone {
    /// The Andes.
    One = 1,
    /// The central valley.
    Two,
    /// The coast.
    Three,
}

/// Soil types of `NCh2745`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NCh2745Soil {
    /// Rock.
    I,
    /// Dense soil.
    II,
    /// Soft soil.
    III,
}

/// A target spectrum of pseudo-acceleration (m/s²).
///
/// Codes with a damping correction have a damping parameter; the others are defined for 5 %
/// damping.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetSpectrum {
    /// ASCE/SEI 7-16, section 11.4.6: design spectrum from two ordinates and the long-period transition. If the damping
    /// ratio is not 0.05, the ordinates are divided by the factor `B_M` of table 17.5-1; this does not apply to the
    /// peak ground acceleration.
    Asce7 {
        /// Short-period spectral acceleration `S_DS` (g).
        sds: f64,
        /// Spectral acceleration at 1 s, `S_D1` (g).
        sd1: f64,
        /// Long-period transition `T_L` (s).
        long_period: f64,
        /// Damping ratio, 0.02 to 0.5.
        damping: f64,
    },
    /// EN 1998-1:2004, section 3.2.2.2: horizontal elastic spectrum, tables 3.2 and 3.3.
    Eurocode8 {
        /// Ground acceleration on rock `a_g` (g), including the importance factor.
        ground_acceleration: f64,
        /// Ground type.
        site: SiteClass,
        /// `true` for the type 2 spectrum (small magnitudes), `false` for type 1.
        small_magnitude: bool,
        /// Damping ratio; `η = 1` at 0.05. Above 0.28, the code's lower bound of `η` applies.
        damping: f64,
    },
    /// `NCh433` with decree 61 of 2011: elastic spectrum `S A0 α(T)`, importance 1, 5 % damping.
    NCh433 {
        /// Seismic zone, which sets `A0` to 0.20, 0.30 or 0.40 g.
        zone: ChileanZone,
        /// Soil class of decree 61.
        site: SiteClass,
    },
    /// `NCh2745.Of2003` (base isolation): base spectrum with acceleration, velocity and
    /// displacement branches, divided by the damping factor `B_D`.
    NCh2745 {
        /// Seismic zone, which multiplies the spectrum by 3/4, 1 or 5/4.
        zone: ChileanZone,
        /// Soil type.
        soil: NCh2745Soil,
        /// Damping ratio; `B_D` is constant below 0.02 and above 0.5.
        damping: f64,
    },
    /// NZS 1170.5:2004, section 3.1: `C(T) = Ch(T) Z R N(T, D)` for 5 % damping, with `Z R` limited
    /// to 0.7 and `Ch` for modal and time-history analysis.
    Nzs1170 {
        /// Hazard factor `Z`.
        hazard: f64,
        /// Return period factor `R`.
        return_period: f64,
        /// Site subsoil class.
        site: SiteClass,
        /// Distance to the nearest major fault (km); `None` for no near-fault factor. If `R` is at
        /// most 0.75, the factor is 1 at any distance.
        fault_distance: Option<f64>,
    },
    /// ICC-ES AC156 with ASCE 7-16: horizontal required response spectrum for shake-table tests,
    /// 5 % damping. It is defined from 0.1 Hz, where it is a tenth of the plateau, to 33.3 Hz.
    Ac156 {
        /// Short-period spectral acceleration `S_DS` (g).
        sds: f64,
        /// Height of attachment divided by roof height, 0 to 1.
        height_ratio: f64,
    },
    /// A spectrum given by points in ascending order of period. Between the points, the logarithm of the acceleration
    /// is linear in the logarithm of the period. Outside the points, the acceleration is constant.
    Table {
        /// Period (s) and pseudo-acceleration (m/s²) of each point.
        points: Vec<(f64, f64)>,
        /// Damping ratio to which the accelerations apply.
        damping: f64,
    },
}

impl std::fmt::Display for TargetSpectrum {
    /// Writes the code and its parameters with their units.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Asce7 { sds, sd1, long_period, .. } => {
                write!(f, "ASCE 7-16 (S_DS {sds} g, S_D1 {sd1} g, T_L {long_period} s")?;
            }
            Self::Eurocode8 { ground_acceleration, site, small_magnitude, .. } => {
                let kind = if *small_magnitude { 2 } else { 1 };
                let ground = ground_acceleration;
                write!(f, "EN 1998-1 type {kind} (a_g {ground} g, ground {site:?}")?;
            }
            Self::NCh433 { zone, site } => {
                write!(f, "NCh433 (zone {}, soil {site:?}", *zone as u8)?;
            }
            Self::NCh2745 { zone, soil, .. } => {
                write!(f, "NCh2745 (zone {}, soil {soil:?}", *zone as u8)?;
            }
            Self::Nzs1170 { hazard, return_period, site, fault_distance } => {
                write!(f, "NZS 1170.5 (Z {hazard}, R {return_period}, site {site:?}")?;
                if let Some(distance) = fault_distance {
                    write!(f, ", fault at {distance} km")?;
                }
            }
            Self::Ac156 { sds, height_ratio } => {
                write!(f, "AC156 (S_DS {sds} g, z/h {height_ratio}")?;
            }
            Self::Table { points, .. } => write!(f, "a table ({} periods", points.len())?,
        }
        write!(f, ", {} % damping)", 100.0 * self.damping())
    }
}

impl TargetSpectrum {
    /// Checks that all parameters are in range.
    ///
    /// # Errors
    /// If a parameter is out of range; the error names the first such parameter.
    pub fn check(&self) -> Result<(), MotionError> {
        let positive = MotionError::require_positive;
        match self {
            Self::Asce7 { sds, sd1, long_period, damping } => {
                require_damping(*damping, 0.02, 0.5)?;
                positive("S_DS (g)", *sds)?;
                positive("S_D1 (g)", *sd1)?;
                positive("T_L (s)", *long_period)?;
                let corner = sd1 / sds;
                let expected = format!("above S_D1/S_DS = {corner}");
                MotionError::require(corner < *long_period, "T_L (s)", expected, long_period)
            }
            Self::Eurocode8 { ground_acceleration, damping, .. } => {
                positive("ground acceleration (g)", *ground_acceleration)?;
                require_damping(*damping, 0.0, 0.99)
            }
            Self::NCh2745 { damping, .. } => require_damping(*damping, 0.0, 0.99),
            Self::NCh433 { .. } => Ok(()),
            Self::Nzs1170 { hazard, return_period, fault_distance, .. } => {
                positive("hazard factor Z", *hazard)?;
                positive("return period factor R", *return_period)?;
                let distance = fault_distance.unwrap_or(0.0);
                let what = "fault distance (km)";
                MotionError::require(distance >= 0.0, what, "0 or above", distance)
            }
            Self::Ac156 { sds, height_ratio } => {
                positive("S_DS (g)", *sds)?;
                let within = (0.0..=1.0).contains(height_ratio);
                MotionError::require(within, "height ratio z/h", "0 to 1", height_ratio)
            }
            Self::Table { points, damping } => {
                require_damping(*damping, 0.0, 0.99)?;
                check_table(points)
            }
        }
    }

    /// Returns the damping ratio of the spectrum.
    pub fn damping(&self) -> f64 {
        match self {
            Self::Asce7 { damping, .. }
            | Self::Eurocode8 { damping, .. }
            | Self::NCh2745 { damping, .. }
            | Self::Table { damping, .. } => *damping,
            Self::NCh433 { .. } | Self::Nzs1170 { .. } | Self::Ac156 { .. } => 0.05,
        }
    }

    /// Returns the pseudo-acceleration (m/s²) at a period (s).
    pub fn acceleration(&self, period: f64) -> f64 {
        let t = period.max(0.0);
        match self {
            Self::Asce7 { sds, sd1, long_period, damping } => {
                STANDARD_GRAVITY * codes::asce7(*sds, *sd1, *long_period, *damping, t)
            }
            Self::Eurocode8 { ground_acceleration, site, small_magnitude, damping } => {
                STANDARD_GRAVITY
                    * ground_acceleration
                    * codes::eurocode8(*site, *small_magnitude, *damping, t)
            }
            Self::NCh433 { zone, site } => STANDARD_GRAVITY * codes::nch433(*zone, *site, t),
            Self::NCh2745 { zone, soil, damping } => codes::nch2745(*zone, *soil, *damping, t),
            Self::Nzs1170 { hazard, return_period, site, fault_distance } => {
                STANDARD_GRAVITY
                    * codes::nzs1170(*hazard, *return_period, *site, *fault_distance, t)
            }
            Self::Ac156 { sds, height_ratio } => {
                STANDARD_GRAVITY * codes::ac156(*sds, *height_ratio, t)
            }
            Self::Table { points, .. } => table(points, t),
        }
    }
}

fn require_damping(damping: f64, least: f64, greatest: f64) -> Result<(), MotionError> {
    let within = (least..=greatest).contains(&damping);
    MotionError::require(within, "damping ratio", format!("{least} to {greatest}"), damping)
}

fn check_table(points: &[(f64, f64)]) -> Result<(), MotionError> {
    MotionError::require(points.len() >= 2, "target table", "at least 2 points", points.len())?;
    for (k, (period, acceleration)) in points.iter().enumerate() {
        let row = format!("target table, row {}", k + 1);
        MotionError::require_positive(&format!("{row}, period (s)"), *period)?;
        MotionError::require_positive(&format!("{row}, acceleration (m/s2)"), *acceleration)?;
        let before = k.checked_sub(1).map_or(0.0, |before| points[before].0);
        let (what, above) = (format!("{row}, period (s)"), format!("above {before}"));
        MotionError::require(*period > before, what, above, period)?;
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
