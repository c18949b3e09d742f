//! Target spectra on the command line: a code with its parameters, or a table in a file.

use std::path::Path;

use anyhow::{anyhow, bail};
use barrelstack::scenario::Dimension;
use barrelstack_motion::{AccelerationUnit, MotionError, TargetSpectrum};

use super::input;

/// The codes and their parameters, for help and error messages.
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

/// Parses a target: a code with its parameters, or the path of a table.
pub(super) fn target(text: &str) -> anyhow::Result<TargetSpectrum> {
    match text.split_once(':').filter(|(code, _)| code.len() > 1) {
        Some(_) => text.parse().map_err(|error: MotionError| anyhow!("target {error}")),
        None => table(Path::new(text)),
    }
}

/// Reads a table of periods and accelerations.
fn table(path: &Path) -> anyhow::Result<TargetSpectrum> {
    let mut damping = 0.05;
    let columns = "a period and an acceleration, separated by a comma";
    let rows = rows(path, columns, "period (s), Sa (g)", |place, behind| {
        if let Some(at) = behind.trim().strip_prefix("at ") {
            damping = input::quantity(place, at, Dimension::NONE)?;
        }
        Ok(())
    })?;
    let points = rows.into_iter().map(|[period, acceleration]| (period, acceleration)).collect();
    let spectrum = TargetSpectrum::Table { points, damping };
    spectrum.check().map_err(|error| anyhow!("{}: {error}", path.display()))?;
    Ok(spectrum)
}

/// Reads the rows of a table of periods (s) and accelerations (m/s²); the table may have further
/// columns.
///
/// The header states the unit of the accelerations. `behind` is called with the position of the header
/// (file and line) and with the text that follows the unit.
pub(super) fn rows<const N: usize>(
    path: &Path,
    columns: &str,
    header: &str,
    mut behind: impl FnMut(&str, &str) -> anyhow::Result<()>,
) -> anyhow::Result<Vec<[f64; N]>> {
    let bytes = input::bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut unit = None;
    let mut rows = Vec::new();
    for (line, row) in text.lines().enumerate() {
        let row = row.trim().trim_start_matches('\u{feff}');
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let place = format!("{}, line {}", path.display(), line + 1);
        let cells: Vec<&str> = row.split([',', ';', '\t']).map(str::trim).collect();
        if cells.len() != N {
            bail!("{place}: expected {columns}; number of columns found: {}", cells.len());
        }
        let Some(factor) = unit else {
            let words = cells[1].split_once('(').and_then(|(_, rest)| rest.split_once(')'));
            let stated = words.and_then(|(word, _)| word.parse::<AccelerationUnit>().ok());
            let Some(stated) = stated.filter(|_| cells[0].contains("(s)")) else {
                bail!(
                    "{place}: expected a header that states the units, such as \"{header}\", found \"{row}\""
                );
            };
            unit = Some(stated.factor());
            behind(&place, words.map_or("", |(_, after)| after))?;
            continue;
        };
        let mut numbers = [0.0; N];
        for (number, cell) in numbers.iter_mut().zip(cells) {
            let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
            *number =
                value.ok_or_else(|| anyhow!("{place}: expected a number, found \"{cell}\""))?;
        }
        numbers[1] *= factor;
        rows.push(numbers);
    }
    Ok(rows)
}
