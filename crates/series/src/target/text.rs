//! Parses target spectra from text. A text names a design code and its parameters, such as
//! `ec8:ag=0.3,site=B`.

use std::str::FromStr;

use super::{ChileanZone, NCh2745Soil, SiteClass, TargetSpectrum};
use crate::error::MotionError;

/// Parameters of a design code; each parameter is removed when it is read.
struct Parameters<'a> {
    code: &'a str,
    pairs: Vec<(&'a str, &'a str)>,
}

/// Names of the design codes, with their parameters.
const KNOWN: [(&str, &str); 6] = [
    ("asce7", "sds (g), sd1 (g), tl (s), damping"),
    ("ec8", "ag (g), site (A to E), type (1 or 2), damping"),
    ("nch433", "zone (1 to 3), soil (A to E)"),
    ("nch2745", "zone (1 to 3), soil (I to III), damping"),
    ("nzs1170", "z, r, site (A to E), distance (km)"),
    ("ac156", "sds (g), zh"),
];

impl<'a> Parameters<'a> {
    fn new(code: &'a str, text: &'a str) -> Result<Self, MotionError> {
        let mut given = Self { code, pairs: Vec::new() };
        for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let Some((key, value)) = part.split_once('=') else {
                return Err(given.wrong("parameters", "NAME=VALUE between commas", part));
            };
            if given.pairs.iter().any(|(known, _)| *known == key.trim()) {
                return Err(given.wrong(key.trim(), "one value", part));
            }
            given.pairs.push((key.trim(), value.trim()));
        }
        Ok(given)
    }

    fn wrong(&self, key: &str, expected: &str, found: &str) -> MotionError {
        MotionError::parameter(format!("{}: {key}", self.code), expected, format!("\"{found}\""))
    }

    /// Creates an error about a missing or unknown parameter. The message lists the parameters of
    /// the code.
    fn unlike(&self, key: &str, found: &str) -> MotionError {
        let all = KNOWN.iter().find(|(code, _)| *code == self.code).map_or("", |(_, all)| all);
        MotionError::parameter(format!("{}: {key}", self.code), all, found)
    }

    fn word(&mut self, key: &str) -> Option<&'a str> {
        let at = self.pairs.iter().position(|(known, _)| *known == key)?;
        Some(self.pairs.remove(at).1)
    }

    fn number(&mut self, key: &str) -> Result<Option<f64>, MotionError> {
        let Some(text) = self.word(key) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(self.wrong(key, "a number", text)),
        }
    }

    fn need<T>(&self, key: &str, value: Option<T>) -> Result<T, MotionError> {
        value.ok_or_else(|| self.unlike(&format!("{key} is missing"), "nothing"))
    }

    /// Reads a parameter that must be one of the names in `all`.
    fn choice<T: Copy>(
        &mut self,
        key: &str,
        expected: &str,
        all: &[(&str, T)],
    ) -> Result<T, MotionError> {
        let text = self.word(key);
        let text = self.need(key, text)?;
        let known = all.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
        known.map(|(_, value)| *value).ok_or_else(|| self.wrong(key, expected, text))
    }

    fn site(&mut self, key: &str) -> Result<SiteClass, MotionError> {
        use SiteClass::{A, B, C, D, E};
        self.choice(key, "A, B, C, D or E", &[("A", A), ("B", B), ("C", C), ("D", D), ("E", E)])
    }

    fn zone(&mut self) -> Result<ChileanZone, MotionError> {
        use ChileanZone::{One, Three, Two};
        self.choice("zone", "1, 2 or 3", &[("1", One), ("2", Two), ("3", Three)])
    }

    /// Reads the damping ratio; 0.05 if none is given.
    fn damping(&mut self) -> Result<f64, MotionError> {
        Ok(self.number("damping")?.unwrap_or(0.05))
    }

    /// Checks that no parameter is left unread.
    fn end(self) -> Result<(), MotionError> {
        match self.pairs.first() {
            None => Ok(()),
            Some(("damping", found)) => Err(self.wrong(
                "damping",
                "no value, because this code applies to 5 % damping only (for another ratio, use a table)",
                found,
            )),
            Some((key, found)) => Err(self.unlike(&format!("no parameter {key}"), found)),
        }
    }
}

/// Parses a code with its parameters separated by commas; accelerations are in g.
///
/// Examples are `asce7:sds=1.0,sd1=0.6`, `ec8:ag=0.3,site=B`, `nch433:zone=2,soil=D`,
/// `nch2745:zone=2,soil=II`, `nzs1170:z=0.3,site=C` and `ac156:sds=1`.
///
/// ```
/// use barrelstack_series::target::TargetSpectrum;
/// let target: TargetSpectrum = "ec8:ag=0.3,site=B,damping=0.02".parse()?;
/// assert_eq!(target.damping(), 0.02);
/// assert!("ec8:ag=0.3".parse::<TargetSpectrum>().unwrap_err().to_string().starts_with("ec8: site is missing: "));
/// # Ok::<(), barrelstack_series::MotionError>(())
/// ```
impl FromStr for TargetSpectrum {
    type Err = MotionError;

    fn from_str(text: &str) -> Result<Self, MotionError> {
        let (code, rest) = text.split_once(':').unwrap_or((text, ""));
        let code = code.trim().to_ascii_lowercase();
        let mut given = Parameters::new(&code, rest)?;
        let spectrum = match code.as_str() {
            "asce7" => {
                let (sds, sd1) = (given.number("sds")?, given.number("sd1")?);
                Self::Asce7 {
                    sds: given.need("sds", sds)?,
                    sd1: given.need("sd1", sd1)?,
                    long_period: given.number("tl")?.unwrap_or(8.0),
                    damping: given.damping()?,
                }
            }
            "ec8" => {
                let ground = given.number("ag")?;
                Self::Eurocode8 {
                    ground_acceleration: given.need("ag", ground)?,
                    site: given.site("site")?,
                    small_magnitude: match given.word("type") {
                        None | Some("1") => false,
                        Some("2") => true,
                        Some(other) => return Err(given.wrong("type", "1 or 2", other)),
                    },
                    damping: given.damping()?,
                }
            }
            "nch433" => Self::NCh433 { zone: given.zone()?, site: given.site("soil")? },
            "nch2745" => {
                use NCh2745Soil::{I, II, III};
                Self::NCh2745 {
                    zone: given.zone()?,
                    soil: given.choice(
                        "soil",
                        "I, II or III",
                        &[("I", I), ("II", II), ("III", III)],
                    )?,
                    damping: given.damping()?,
                }
            }
            "nzs1170" => {
                let hazard = given.number("z")?;
                Self::Nzs1170 {
                    hazard: given.need("z", hazard)?,
                    return_period: given.number("r")?.unwrap_or(1.0),
                    site: given.site("site")?,
                    fault_distance: given.number("distance")?,
                }
            }
            "ac156" => {
                let sds = given.number("sds")?;
                Self::Ac156 {
                    sds: given.need("sds", sds)?,
                    height_ratio: given.number("zh")?.unwrap_or(0.0),
                }
            }
            other => {
                let all: Vec<&str> = KNOWN.iter().map(|(code, _)| *code).collect();
                return Err(MotionError::parameter("code", all.join(", "), format!("\"{other}\"")));
            }
        };
        given.end()?;
        spectrum.check().map_err(|error| {
            MotionError::mismatch(format!("{code}: {error}"), "correct the parameter")
        })?;
        Ok(spectrum)
    }
}
