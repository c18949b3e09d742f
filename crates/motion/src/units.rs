//! Units of acceleration as files and users write them.

use std::str::FromStr;

use crate::error::MotionError;
use crate::math::STANDARD_GRAVITY;

/// A unit of acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// Standard gravity, 9.80665 m/s².
    G,
    /// A tenth of standard gravity, the unit of old strong-motion files.
    TenthG,
    /// m/s².
    MetersPerSecondSquared,
    /// cm/s², also called gal.
    Gal,
    /// mm/s².
    MillimetersPerSecondSquared,
}

impl AccelerationUnit {
    /// m/s² to one of this unit.
    pub fn factor(self) -> f64 {
        match self {
            Self::G => STANDARD_GRAVITY,
            Self::TenthG => 0.1 * STANDARD_GRAVITY,
            Self::MetersPerSecondSquared => 1.0,
            Self::Gal => 0.01,
            Self::MillimetersPerSecondSquared => 0.001,
        }
    }
}

printed_as!(
    AccelerationUnit,
    G = "g",
    TenthG = "g/10",
    MetersPerSecondSquared = "m/s2",
    Gal = "cm/s2",
    MillimetersPerSecondSquared = "mm/s2"
);

impl FromStr for AccelerationUnit {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let plain: String =
            text.trim().to_ascii_lowercase().replace(['^', '*', ' '], "").replace("sec", "s");
        Ok(match plain.as_str() {
            "g" | "g's" | "gs" => Self::G,
            "g/10" => Self::TenthG,
            "m/s2" | "m/s/s" | "m/ss" | "m/s\u{b2}" => Self::MetersPerSecondSquared,
            "cm/s2" | "cm/s/s" | "cm/ss" | "gal" | "gals" | "cm/s\u{b2}" => Self::Gal,
            "mm/s2" | "mm/s/s" | "mm/s\u{b2}" => Self::MillimetersPerSecondSquared,
            _ => {
                return Err(MotionError::parameter(
                    "unit of acceleration",
                    "g, g/10, m/s2, cm/s2, gal or mm/s2",
                    format!("\"{text}\""),
                ));
            }
        })
    }
}
