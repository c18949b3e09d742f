//! Target spectra as they are typed: a code and its parameters, or a table of a file.

use std::path::Path;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{AccelerationUnit, ChileanZone, NCh2745Soil, SiteClass, TargetSpectrum};

use super::input;

/// The codes and their parameters, for help and errors.
pub(super) const CODES: &str = "\
Targets (accelerations in g; damping ratio 0.05 where none is given):
  asce7:sds=1.0,sd1=0.6[,tl=8,damping=0.05]    ASCE/SEI 7-16 design spectrum; T_L in s
  ec8:ag=0.3,site=B[,type=1,damping=0.05]      Eurocode 8 horizontal elastic spectrum, type 1 or 2
  nch433:zone=2,soil=D                         NCh433 with decree 61; zone 1 to 3, soil A to E
  nch2745:zone=2,soil=II[,damping=0.05]        NCh2745.Of2003; zone 1 to 3, soil I to III
  nzs1170:z=0.3,site=C[,r=1,distance=5]        NZS 1170.5:2004; fault distance in km
  ac156:sds=1.0[,zh=0]                         ICC-ES AC156; height of attachment over roof height
  FILE.csv                                     a header such as \"period (s), Sa (g)\", then rows;
                                               \"period (s), Sa (g) at 2 %\" for another damping";

/// Parameters of a code, each asked for once.
struct Parameters<'a> {
    code: &'a str,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Parameters<'a> {
    fn new(code: &'a str, text: &'a str) -> anyhow::Result<Self> {
        let mut pairs = Vec::new();
        for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| {
                anyhow!("target {code}: expected NAME=VALUE between commas, found \"{part}\"")
            })?;
            if pairs.iter().any(|(known, _)| *known == key.trim()) {
                bail!("target {code}: {} is given twice", key.trim());
            }
            pairs.push((key.trim(), value.trim()));
        }
        Ok(Self { code, pairs })
    }

    fn word(&mut self, key: &str) -> Option<&'a str> {
        let at = self.pairs.iter().position(|(known, _)| *known == key)?;
        Some(self.pairs.remove(at).1)
    }

    fn number(&mut self, key: &str) -> anyhow::Result<Option<f64>> {
        let Some(text) = self.word(key) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => bail!("target {}: {key} must be a number, found \"{text}\"", self.code),
        }
    }

    fn need<T>(&self, key: &str, value: Option<T>) -> anyhow::Result<T> {
        value.ok_or_else(|| {
            anyhow!(
                "target {}: {key} is missing; `barrelstack motion match --help` lists the \
                     parameters",
                self.code
            )
        })
    }

    fn site(&mut self, key: &str) -> anyhow::Result<SiteClass> {
        let text = self.word(key);
        Ok(match self.need(key, text)?.to_ascii_uppercase().as_str() {
            "A" => SiteClass::A,
            "B" => SiteClass::B,
            "C" => SiteClass::C,
            "D" => SiteClass::D,
            "E" => SiteClass::E,
            other => {
                bail!("target {}: {key} must be A, B, C, D or E, found \"{other}\"", self.code)
            }
        })
    }

    fn zone(&mut self) -> anyhow::Result<ChileanZone> {
        let text = self.word("zone");
        Ok(match self.need("zone", text)? {
            "1" => ChileanZone::One,
            "2" => ChileanZone::Two,
            "3" => ChileanZone::Three,
            other => bail!("target {}: zone must be 1, 2 or 3, found \"{other}\"", self.code),
        })
    }

    /// The damping ratio, 5 % if none is given.
    fn damping(&mut self) -> anyhow::Result<f64> {
        Ok(self.number("damping")?.unwrap_or(0.05))
    }

    /// Nothing may be left over.
    fn end(self) -> anyhow::Result<()> {
        match self.pairs.first() {
            None => Ok(()),
            Some(("damping", _)) => bail!(
                "target {}: the code defines its spectrum for 5 % of damping and no correction; match \
                 a table for another damping",
                self.code
            ),
            Some((key, _)) => bail!(
                "target {}: it has no parameter {key}; `barrelstack motion match --help` lists the \
                 parameters",
                self.code
            ),
        }
    }
}

/// A target as typed.
pub(super) fn target(text: &str) -> anyhow::Result<TargetSpectrum> {
    let Some((code, rest)) = text.split_once(':').filter(|(code, _)| code.len() > 1) else {
        return table(Path::new(text));
    };
    let mut given = Parameters::new(code, rest)?;
    let spectrum = match code.to_ascii_lowercase().as_str() {
        "asce7" => {
            let (sds, sd1) = (given.number("sds")?, given.number("sd1")?);
            TargetSpectrum::Asce7 {
                sds: given.need("sds", sds)?,
                sd1: given.need("sd1", sd1)?,
                long_period: given.number("tl")?.unwrap_or(8.0),
                damping: given.damping()?,
            }
        }
        "ec8" => {
            let ground = given.number("ag")?;
            TargetSpectrum::Eurocode8 {
                ground_acceleration: given.need("ag", ground)?,
                site: given.site("site")?,
                small_magnitude: match given.word("type") {
                    None | Some("1") => false,
                    Some("2") => true,
                    Some(other) => bail!("target ec8: type must be 1 or 2, found \"{other}\""),
                },
                damping: given.damping()?,
            }
        }
        "nch433" => TargetSpectrum::NCh433 { zone: given.zone()?, site: given.site("soil")? },
        "nch2745" => {
            let zone = given.zone()?;
            let soil = given.word("soil");
            let soil = match given.need("soil", soil)?.to_ascii_uppercase().as_str() {
                "I" => NCh2745Soil::I,
                "II" => NCh2745Soil::II,
                "III" => NCh2745Soil::III,
                other => bail!("target nch2745: soil must be I, II or III, found \"{other}\""),
            };
            TargetSpectrum::NCh2745 { zone, soil, damping: given.damping()? }
        }
        "nzs1170" => {
            let hazard = given.number("z")?;
            TargetSpectrum::Nzs1170 {
                hazard: given.need("z", hazard)?,
                return_period: given.number("r")?.unwrap_or(1.0),
                site: given.site("site")?,
                fault_distance: given.number("distance")?,
            }
        }
        "ac156" => {
            let sds = given.number("sds")?;
            TargetSpectrum::Ac156 {
                sds: given.need("sds", sds)?,
                height_ratio: given.number("zh")?.unwrap_or(0.0),
            }
        }
        _ => bail!(
            "there is no code spectrum \"{code}\"; the codes are asce7, ec8, nch433, nch2745, nzs1170 \
             and ac156, and a table is a file without a colon in its name"
        ),
    };
    given.end()?;
    spectrum.check().map_err(|error| anyhow!("target {code}: {error}"))?;
    Ok(spectrum)
}

/// A table of periods (s) and accelerations in the unit that its header states.
fn table(path: &Path) -> anyhow::Result<TargetSpectrum> {
    let bytes = input::bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let place = |line: usize| format!("{}, line {}", path.display(), line + 1);
    let mut unit = None;
    let mut damping = 0.05;
    let mut points = Vec::new();
    for (line, row) in text.lines().enumerate() {
        let row = row.trim().trim_start_matches('\u{feff}');
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let cells: Vec<&str> = row.split([',', ';', '\t']).map(str::trim).collect();
        let [period, acceleration] = cells.as_slice() else {
            bail!(
                "{}: expected a period and an acceleration with a comma between, found {} columns",
                place(line),
                cells.len()
            );
        };
        let Some(factor) = unit else {
            let words = acceleration.split_once('(').and_then(|(_, rest)| rest.split_once(')'));
            let stated = words.and_then(|(word, _)| word.parse::<AccelerationUnit>().ok());
            let Some(stated) = stated.filter(|_| period.contains("(s)")) else {
                bail!(
                    "{}: expected a header that states the units, such as \"period (s), Sa (g)\", \
                     found \"{row}\"",
                    place(line)
                );
            };
            unit = Some(stated.factor());
            if let Some(at) = words.and_then(|(_, after)| after.trim().strip_prefix("at ")) {
                damping = input::quantity(&place(line), at, Dimension::NONE)?;
            }
            continue;
        };
        let number = |cell: &str| {
            cell.parse::<f64>()
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| anyhow!("{}: expected a number, found \"{cell}\"", place(line)))
        };
        points.push((number(period)?, factor * number(acceleration)?));
    }
    let spectrum = TargetSpectrum::Table { points, damping };
    spectrum.check().map_err(|error| anyhow!("{}: {error}", path.display()))?;
    Ok(spectrum)
}
