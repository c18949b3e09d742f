//! Reads the `[[motion]]` tables of a study file: records, folders of records, formulas, and synthetic
//! ensembles.

use std::path::{Path, PathBuf};

use barrelstack_motion::{BooreSource, CloughPenzien, Envelope, NearFault, Pulse};

use crate::scenario::field::Named as _;
use crate::scenario::reader::Reader;
use crate::scenario::template::{self, Opened};
use crate::scenario::tree::{Entry, Node, Table, Value, parse_value};
use crate::scenario::{Problem, Scale, ScenarioError};
use crate::system;

use super::design::seed_of;
use super::fields::{Maker, Soil};
use super::motions::{Making, Motion, Shaking, Synthetic};

/// Maximum number of motions in a study, and of files in a folder of records.
pub(super) const MOST: usize = 100_000;

/// Reads the motions of one `[[motion]]` table; `number` is the position of the table in the file, counted
/// from 1.
pub(super) fn read(
    set: &Reader<'_>,
    opened: &Opened,
    number: usize,
    seed: u64,
) -> Result<Vec<Motion>, ScenarioError> {
    let name = set.optional_text("name")?;
    let files = set.texts("records")?;
    let from_folder = set.optional_text("folder")?;
    let pattern = set.text("pattern")?;
    let bundled = set.optional_catalog_name("bundled")?;
    let components = set.texts("components")?;
    // These tables are read later, by the reader of scenarios.
    let tables = ["sine", "pulse", "each", "scale"];
    for table in tables {
        set.skip(table);
    }
    if let Some(synthetic) = set.optional_section("synthetic")? {
        // Only the scale is needed here. It is read together with a placeholder motion, a formula, so that scaling that
        // needs a record is refused.
        let stand_in = "{ amplitude = \"1 g\", period = \"1 s\", cycles = 1 }";
        let stand_in = parse_value(stand_in, set.origin_of("synthetic")).value;
        let scale = motion_of(set, opened, number, &[("sine", stand_in)])?.scale;
        return ensemble(synthetic, name, number, seed, scale);
    }
    let mut sources: Vec<(String, Vec<(&str, Value)>)> = Vec::new();
    if let Some(name) = bundled {
        sources.push((name.clone(), vec![("bundled", Value::Text(name))]));
    }
    let listed = match &from_folder {
        Some(from) => matching(set, &opened.folder().join(from), from, &pattern)?,
        None => files,
    };
    for file in listed {
        let stem = Path::new(&file)
            .file_stem()
            .map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
        sources.push((stem, vec![("record", Value::Text(file))]));
    }
    for formula in ["sine", "pulse"] {
        if set.has(formula) {
            sources.push((formula.to_owned(), Vec::new()));
        }
    }
    if sources.is_empty() {
        return Err(set.one_of(&["records", "folder", "bundled", "sine", "pulse", "synthetic"]));
    }
    if sources.len().saturating_mul(components.len()) > MOST {
        let message = format!(
            "{} components of {} records give more motions than the maximum of {MOST}: use fewer",
            components.len(),
            sources.len()
        );
        return Err(set.inconsistent("components", message));
    }
    let many = sources.len() > 1 || components.len() > 1;
    let mut motions = Vec::new();
    for (source, entries) in sources {
        let chosen: Vec<Option<&String>> =
            if components.is_empty() { vec![None] } else { components.iter().map(Some).collect() };
        for component in chosen {
            let mut entries = entries.clone();
            let mut label = match &name {
                Some(name) if many => format!("{name} {source}"),
                Some(name) => name.clone(),
                None => source.clone(),
            };
            if let Some(component) = component {
                entries.push(("component", Value::Text(component.clone())));
                if components.len() > 1 {
                    label = format!("{label} {component}");
                }
            }
            let spec = motion_of(set, opened, number, &entries)?;
            motions.push(Motion { name: label, shaking: Shaking::Spec(Box::new(spec)) });
        }
    }
    Ok(motions)
}

/// Reads the motion that is specified by the entries `each`, `sine`, `pulse` and `scale` of a `[[motion]]` table and by
/// `entries`, such as the record and its component.
fn motion_of(
    set: &Reader<'_>,
    opened: &Opened,
    number: usize,
    entries: &[(&str, Value)],
) -> Result<crate::scenario::MotionSpec, ScenarioError> {
    let origin = ["records", "folder", "bundled"]
        .into_iter()
        .find(|key| set.has(key))
        .map_or_else(|| set.origin_of(""), |key| set.origin_of(key));
    let mut table = Table::default();
    if set.has("each") {
        for entry in &set.table("each")?.entries {
            if ["record", "bundled", "sine", "pulse", "none", "scale"].contains(&entry.key.as_str())
            {
                let message =
                    format!("`{}` belongs directly in [[motion]], not in `each`", entry.key);
                return Err(set.error_at(entry.origin, Problem::Inconsistent { message }));
            }
            table.set(entry.clone());
        }
    }
    for key in ["sine", "pulse", "scale"] {
        if set.has(key) {
            let value = Value::Table(set.table(key)?.clone());
            let origin = set.origin_of(key);
            table.set(Entry { key: key.to_owned(), origin, node: Node { origin, value } });
        }
    }
    for (key, value) in entries {
        let node = Node { origin, value: value.clone() };
        table.set(Entry { key: (*key).to_owned(), origin, node });
    }
    template::motion(&opened.sources, &format!("motion.{number}"), &table, origin)
}

/// Returns the sorted paths, relative to the study, of the files in a folder whose names match a pattern.
///
/// Folders are skipped, as are names that begin with a period. Other entries that are not files cause an
/// error when they are read.
fn matching(
    set: &Reader<'_>,
    folder: &Path,
    as_written: &str,
    pattern: &str,
) -> Result<Vec<String>, ScenarioError> {
    let refuse = |reason: String| Err(set.inconsistent("folder", reason));
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => {
            let reason = if error.kind() == std::io::ErrorKind::NotFound {
                "there is no such folder".to_owned()
            } else {
                system::words(&error)
            };
            return refuse(format!("cannot list the folder {}: {reason}", folder.display()));
        }
    };
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|error| set.inconsistent("folder", system::words(&error)))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if !entry.path().is_dir() && !name.starts_with('.') && matches(pattern, &name) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return refuse(format!("no file in the folder {} matches \"{pattern}\"", folder.display()));
    }
    if names.len() > MOST {
        return refuse(format!(
            "the folder {} has {} files that match \"{pattern}\", more than the maximum of {MOST}; use a pattern \
             that matches fewer files",
            folder.display(),
            names.len()
        ));
    }
    names.sort();
    let path = |name: String| PathBuf::from(as_written).join(name).to_string_lossy().into_owned();
    Ok(names.into_iter().map(path).collect())
}

/// Returns `true` if a name matches a pattern, in which `*` stands for any number of characters and `?` for one
/// character; case is ignored.
fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) =
        (pattern.to_lowercase().chars().collect(), name.to_lowercase().chars().collect());
    let (mut p, mut n) = (0, 0);
    // Positions in pattern and name at the last star, from which matching resumes after a mismatch.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        if pattern.get(p) == Some(&'*') {
            star = Some((p, n));
            p += 1;
        } else if pattern.get(p).is_some_and(|letter| *letter == '?' || *letter == name[n]) {
            p += 1;
            n += 1;
        } else if let Some((at, from)) = star {
            star = Some((at, from + 1));
            p = at + 1;
            n = from + 1;
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|letter| *letter == '*')
}

/// Returns the motions of a synthetic ensemble, one for each realization.
fn ensemble(
    reader: Reader<'_>,
    name: Option<String>,
    number: usize,
    seed: u64,
    scale: Scale,
) -> Result<Vec<Motion>, ScenarioError> {
    let kind: Maker = reader.choice("kind")?;
    let count = reader.integer("count")?;
    if count as usize > MOST {
        let message = format!(
            "{count} motions are more than the maximum of {MOST}: use fewer, or several studies with different seeds"
        );
        return Err(reader.inconsistent("count", message));
    }
    let own = reader.optional_integer("seed")?.map(u64::from);
    let time_step = reader.quantity("time_step")?;
    let maker = match kind {
        Maker::Boore => Making::Boore(source(&reader)?),
        Maker::CloughPenzien => {
            let rms = reader.quantity("rms")?;
            let noise = match reader.choice("soil")? {
                Soil::Firm => CloughPenzien::firm(rms),
                Soil::Medium => CloughPenzien::medium(rms),
                Soil::Soft => CloughPenzien::soft(rms),
            };
            let envelope = Envelope::Jennings {
                rise: reader.quantity("rise")?,
                decay_start: reader.quantity("decay_start")?,
                decay: 1.0 / reader.quantity("decay")?,
            };
            Making::CloughPenzien { noise, envelope, duration: reader.quantity("duration")? }
        }
        Maker::NearFault => Making::NearFault(NearFault {
            pulse: Pulse::MavroeidisPapageorgiou {
                velocity: reader.quantity("pulse_velocity")?,
                period: reader.quantity("pulse_period")?,
                gamma: reader.number("gamma")?,
                phase: reader.quantity("phase")?,
            },
            start: reader.quantity("start")?,
            rest: source(&reader)?,
            crossover: reader.number("crossover")?,
        }),
    };
    reader.finish();
    let name = name.unwrap_or_else(|| kind.name().to_owned());
    // The seed of a realization depends on its table and its number, not on the number of realizations.
    let of_set = |realization: u32| match own {
        Some(own) => seed_of(own, &format!("realization {realization}")),
        None => seed_of(seed, &format!("motion {number}, realization {realization}")),
    };
    let motion = |realization: u32| {
        let synthetic =
            Synthetic { maker: maker.clone(), time_step, seed: of_set(realization), scale };
        Motion {
            name: format!("{name} {realization}"),
            shaking: Shaking::Synthetic(Box::new(synthetic)),
        }
    };
    Ok((1..=count).map(motion).collect())
}

fn source(reader: &Reader<'_>) -> Result<BooreSource, ScenarioError> {
    // The formulas use kilometers and bar.
    let kilometers = reader.quantity("distance")? / 1000.0;
    let mut source = BooreSource::western(reader.number("magnitude")?, kilometers);
    source.stress = reader.quantity("stress")? / 1e5;
    source.path.kappa = reader.quantity("kappa")?;
    Ok(source)
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_stand_for_names() {
        for (pattern, name, expected) in [
            ("*", "anything", true),
            ("*.AT2", "RSN995_PEL360.at2", true),
            ("*.AT2", "RSN995_PEL360.AT2.txt", false),
            ("RSN*_?.AT2", "RSN1_H_X.AT2", true),
            ("RSN*_?.AT2", "RSN1_H_XY.AT2", false),
            ("", "a", false),
            ("a*b*c", "aXbYbZc", true),
            ("**", "", true),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
