//! Studies of a ranking. There is one study per protection, direction and round; studies of the same round
//! differ in the stack only.

use std::fmt::Write as _;

use super::Request;
use crate::direction::turned;
use crate::heights::{quoted, synthetic};
use crate::scenario::{Scenario, Until};
use crate::study::Study;
use crate::study::StudyError;
use crate::unknown::factors;

/// Number of runs in a chunk. If the study is interrupted, an unfinished chunk is lost as a whole.
const CHUNK: usize = 24;

/// `[[motion]]` table with two motions from the bundled record: one for each horizontal component, both with the
/// vertical component.
pub(crate) const NAPA: &str = "[[motion]]\n\
     bundled = \"napa-college-2014\"\n\
     components = [\"horizontal-1\", \"horizontal-2\"]\n\
     each = { vertical = \"UP\" }\n\n";

/// Returns the name of the folder of a study, which lies in the folder of the protection. `round` is counted from 0.
pub(super) fn name(direction: &str, round: u32) -> String {
    format!("{direction}-{}", round + 1)
}

/// Returns the study of a stack in one direction, in a round counted from 0.
///
/// Random draws depend on the round only. All protections therefore have the same motions, and the same
/// quantiles of friction and of the contact constants of seats.
///
/// # Errors
/// If a record cannot be read.
pub(super) fn study(
    request: &Request,
    scenario: &Scenario,
    levels: &[f64],
    round: u32,
) -> Result<Study, StudyError> {
    let seed = request.seed.wrapping_add(round);
    // Runs continue until nothing moves, since the losses depend on all falls.
    shaken("protection", (scenario, Until::Rest), seed, &motions(request, round), levels)
}

/// Returns the study of a stack under motions that are scaled to levels of peak ground velocity (m/s).
///
/// Uncertain parameters are drawn for each run from the seed. `until` determines when a run ends.
///
/// # Errors
/// If a record cannot be read.
pub(crate) fn shaken(
    title: &str,
    (scenario, until): (&Scenario, Until),
    seed: u32,
    motions: &str,
    levels: &[f64],
) -> Result<Study, StudyError> {
    let mut text = format!(
        "schema = 1\ntitle = \"{title}\"\nseed = {seed}\n\n{}\n",
        scenario.to_toml_table("base", until)
    );
    text.push_str(&factors(scenario));
    text.push_str(&turned(scenario));
    text.push_str(motions);
    let levels: Vec<String> = levels.iter().map(|v| format!("\"{} cm/s\"", 100.0 * v)).collect();
    let _ = write!(
        text,
        "[intensity]\nmeasure = \"pgv\"\nlevels = [{}]\n\n[design]\nkind = \"stripes\"\nchunk = {CHUNK}\n",
        levels.join(", ")
    );
    Study::written(title, &text)
}

/// Returns the `[[motion]]` tables of a round. They contain the given records; without given records, they
/// contain synthetic motions and, in the first round, the bundled record.
fn motions(request: &Request, round: u32) -> String {
    let mut text = String::new();
    for record in &request.records {
        let _ = write!(text, "[[motion]]\nrecords = [{}]\n\n", quoted(record));
    }
    if let Some(folder) = &request.folder {
        let _ = write!(text, "[[motion]]\nfolder = {}\n\n", quoted(folder));
    }
    if !text.is_empty() {
        return text;
    }
    let bundled = round == 0;
    if bundled {
        text.push_str(NAPA);
    }
    let made = request.motions.saturating_sub(if bundled { 2 } else { 0 });
    text + &synthetic(made, &format!(", {}", round + 1))
}
