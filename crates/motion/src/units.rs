//! Units of acceleration, velocity and displacement.

use std::str::FromStr;

use crate::error::MotionError;
use crate::math::STANDARD_GRAVITY;
use crate::record::Quantity;

/// A unit of acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// Standard gravity, 9.80665 m/s².
    G,
    /// A tenth of standard gravity, the unit of some old strong-motion files.
    TenthG,
    /// m/s².
    MetersPerSecondSquared,
    /// cm/s², also called gal.
    Gal,
    /// mm/s².
    MillimetersPerSecondSquared,
    /// ft/s², equal to 0.3048 m/s².
    FeetPerSecondSquared,
    /// in/s², equal to 0.0254 m/s².
    InchesPerSecondSquared,
}

impl AccelerationUnit {
    /// All units.
    pub const ALL: [Self; 7] = [
        Self::G,
        Self::TenthG,
        Self::MetersPerSecondSquared,
        Self::Gal,
        Self::MillimetersPerSecondSquared,
        Self::FeetPerSecondSquared,
        Self::InchesPerSecondSquared,
    ];

    /// Returns the value of this unit in m/s².
    pub fn factor(self) -> f64 {
        match self {
            Self::G => STANDARD_GRAVITY,
            Self::TenthG => 0.1 * STANDARD_GRAVITY,
            Self::MetersPerSecondSquared => 1.0,
            Self::Gal => 0.01,
            Self::MillimetersPerSecondSquared => 0.001,
            Self::FeetPerSecondSquared => 0.3048,
            Self::InchesPerSecondSquared => 0.0254,
        }
    }
}

printed_as!(
    AccelerationUnit,
    G = "g",
    TenthG = "g/10",
    MetersPerSecondSquared = "m/s2",
    Gal = "cm/s2",
    MillimetersPerSecondSquared = "mm/s2",
    FeetPerSecondSquared = "ft/s2",
    InchesPerSecondSquared = "in/s2"
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
            "ft/s2" | "ft/s/s" | "ft/ss" | "ft/s\u{b2}" => Self::FeetPerSecondSquared,
            "in/s2" | "in/s/s" | "in/ss" | "in/s\u{b2}" => Self::InchesPerSecondSquared,
            _ => {
                return Err(MotionError::parameter(
                    "unit of acceleration",
                    "g, g/10, m/s2, cm/s2, gal, mm/s2, ft/s2 or in/s2",
                    format!("\"{text}\""),
                ));
            }
        })
    }
}

/// A unit of acceleration, velocity or displacement in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionUnit {
    /// Physical quantity of the unit.
    pub(crate) quantity: Quantity,
    /// Factor that converts a value in this unit to SI units.
    pub(crate) factor: f64,
}

impl MotionUnit {
    /// Parses a unit such as `cm/s2`, `M/S**2`, `nm s^-2`, `in/sec/sec`, `m/sec`, `mm`, `g`, `%g`,
    /// `mg` or `gal`.
    ///
    /// Returns `None` for anything that is not a unit of acceleration, velocity or displacement.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        // "m/(s^2)" has its parenthesis after an operator; "cm/s(s)" is damaged.
        let letter = |at: usize| text[..at].ends_with(|c: char| c.is_alphanumeric());
        if text.match_indices('(').any(|(at, _)| letter(at)) {
            return None;
        }
        // UTF-8 misread as Latin-1 has U+C2 before a superscript 2, a micro sign and a centered
        // dot.
        let plain: String = text
            .trim()
            .replace('\u{c2}', "")
            .replace("\u{e2}\u{88}\u{92}", "-")
            .replace("\u{e2}\u{81}\u{bb}", "-")
            .to_lowercase()
            .replace('\u{b2}', "2")
            .chars()
            .filter(|c| !" ^*().\u{b7}_'`".contains(*c))
            .collect();
        let acceleration = |factor| Some(Self { quantity: Quantity::Acceleration, factor });
        match plain.as_str() {
            "g" | "gs" | "gn" | "gravity" | "g-force" | "gforce" => {
                return acceleration(STANDARD_GRAVITY);
            }
            "%g" | "pctg" | "percentg" | "percentofg" => {
                return acceleration(0.01 * STANDARD_GRAVITY);
            }
            "g/10" => return acceleration(0.1 * STANDARD_GRAVITY),
            "mg" | "mgs" | "milli-g" | "millig" => return acceleration(1e-3 * STANDARD_GRAVITY),
            "ug" | "\u{b5}g" | "microg" => return acceleration(1e-6 * STANDARD_GRAVITY),
            "gal" | "gals" => return acceleration(1e-2),
            "mgal" => return acceleration(1e-5),
            _ => {}
        }
        let (length, time) = match plain.find('/') {
            Some(at) => (&plain[..at], &plain[at + 1..]),
            // Handles "ms-2", "m-s-2" and "mps2".
            None => ["sec-", "s-", "-s-", "ps", "psec"]
                .iter()
                .find_map(|mark| {
                    let (length, power) = plain.rsplit_once(mark)?;
                    let power = power.trim_start_matches('-');
                    let per = match (*mark, power) {
                        (_, "2") | ("ps", "s") => "s2",
                        ("ps" | "psec", "") | (_, "1") => "s",
                        _ => return None,
                    };
                    Some((length.trim_end_matches('-'), per))
                })
                .unwrap_or((plain.as_str(), "")),
        };
        let quantity = match time
            .replace("seconds", "s")
            .replace("second", "s")
            .replace("sec", "s")
            .as_str()
        {
            "" if plain.contains('/') => return None,
            "" if matches!(length, "kine" | "kines") => {
                return Some(Self { quantity: Quantity::Velocity, factor: 1e-2 });
            }
            "" => Quantity::Displacement,
            "s" => Quantity::Velocity,
            "s2" | "s/s" | "ss" | "squared" | "ssquared" => Quantity::Acceleration,
            _ => return None,
        };
        let factor = match length {
            "m" | "meter" | "meters" | "metre" | "metres" => 1.0,
            "cm" | "centimeter" | "centimeters" => 1e-2,
            "mm" | "millimeter" | "millimeters" => 1e-3,
            "um" | "\u{b5}m" | "micron" | "microns" | "micrometer" | "micrometers" => 1e-6,
            "nm" | "nanometer" | "nanometers" => 1e-9,
            "ft" | "foot" | "feet" => 0.3048,
            "in" | "inch" | "inches" => 0.0254,
            _ => return None,
        };
        Some(Self { quantity, factor })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_motion_are_read_as_files_write_them() {
        let acceleration = [
            ("cm/s2", 1e-2),
            ("M/S**2", 1.0),
            ("nm/s**2", 1e-9),
            ("NM/S^2", 1e-9),
            ("cm/sec/sec", 1e-2),
            ("CM/SEC2", 1e-2),
            ("m/(s^2)", 1.0),
            ("m/s\u{b2}", 1.0),
            ("cm/s\u{c2}\u{b2}", 1e-2),
            ("m s^-2", 1.0),
            ("m*s-2", 1.0),
            ("cm/sec^2", 1e-2),
            ("in/s/s", 0.0254),
            ("ft/sec2", 0.3048),
            ("mm/s2", 1e-3),
            ("mps2", 1.0),
            ("mpss", 1.0),
            ("g", STANDARD_GRAVITY),
            ("G's", STANDARD_GRAVITY),
            ("%g", 0.01 * STANDARD_GRAVITY),
            ("mg", 1e-3 * STANDARD_GRAVITY),
            ("Gal", 1e-2),
        ];
        for (text, factor) in acceleration {
            let unit = MotionUnit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((unit.quantity, unit.factor), (Quantity::Acceleration, factor), "{text}");
        }
        for (text, factor) in [
            ("cm/s", 1e-2),
            ("M/S", 1.0),
            ("m/sec", 1.0),
            ("nm/s", 1e-9),
            ("m s^-1", 1.0),
            ("mps", 1.0),
        ] {
            let unit = MotionUnit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((unit.quantity, unit.factor), (Quantity::Velocity, factor), "{text}");
        }
        for (text, factor) in [("cm", 1e-2), ("M", 1.0), ("in", 0.0254), ("mm", 1e-3)] {
            let unit = MotionUnit::parse(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((unit.quantity, unit.factor), (Quantity::Displacement, factor), "{text}");
        }
        for text in [
            "", "s", "cm/s(s)", "Pa", "V", "rad/s", "counts", "kg", "m/s3", "series", "deg", "m/",
            "Hz",
        ] {
            assert_eq!(MotionUnit::parse(text), None, "{text}");
        }
    }
}
