//! Results of a study, finished or not, in words and as JSON.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::Path;

use barrelstack::outcome::CollapseMode;
use barrelstack_campaign::study::{Endings, Provenance, Status, StudyTable, Tally};
use barrelstack_report::described;

use crate::printer::counted;

/// Formats a probability and its confidence interval, in percent.
fn percent((p, [low, high]): (f64, [f64; 2])) -> String {
    // Rounding may leave a bound slightly below zero.
    let shown = |share: f64| 100.0 * share.max(0.0);
    format!("{:.1} % ({:.1} to {:.1} %)", shown(p), shown(low), shown(high))
}

/// Results of the cases of a study, accumulated shard by shard.
#[derive(Default)]
pub(crate) struct Answer {
    tally: Tally,
    endings: Endings,
    modes: BTreeMap<String, usize>,
    errors: BTreeMap<String, usize>,
    /// Intensity levels of the motions, with the numbers of cases by outcome. At most `MOST` + 1 levels are kept, which
    /// suffices to detect that there are more than `MOST`.
    levels: Vec<(f64, Tally)>,
    unit: String,
}

/// Maximum number of different intensity levels, collapse modes or errors that are counted individually.
const MOST: usize = 30;

impl Answer {
    /// Adds the rows of a table to the counts.
    pub(super) fn add(&mut self, table: &StudyTable) {
        self.tally = self.tally.plus(Tally::of(table));
        self.endings.add(table);
        for (column, counts) in [("mode", &mut self.modes), ("error", &mut self.errors)] {
            for text in table.texts(column).unwrap_or_default().iter().flatten() {
                let known = counts.contains_key(text) || counts.len() < MOST;
                let text = if known { text.as_str() } else { OTHERS };
                *counts.entry(text.to_owned()).or_default() += 1;
            }
        }
        let (Some(values), Some(outcomes)) = (table.numbers("level"), table.texts("outcome"))
        else {
            return;
        };
        self.unit = table.column("level").map_or_else(String::new, |of| of.spec.unit.clone());
        for (level, outcome) in values.iter().zip(outcomes) {
            let (Some(level), Some(outcome)) = (level, outcome) else { continue };
            let known = self.levels.iter().position(|(known, _)| known == level);
            if known.is_none() && self.levels.len() > MOST {
                return;
            }
            let at = known.unwrap_or_else(|| {
                self.levels.push((*level, Tally::default()));
                self.levels.len() - 1
            });
            self.levels[at].1.add(outcome);
        }
    }

    /// Returns the intensity levels in ascending order, with the numbers of cases by outcome.
    ///
    /// The list is empty if there is only one level or more than `MOST`. It is also empty if there are fewer than two
    /// cases per level on average, for example because the levels are drawn at random.
    fn levels(&self) -> Vec<(f64, Tally)> {
        let mut levels = self.levels.clone();
        levels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let few = (2..=MOST).contains(&levels.len());
        let shared = few && 2 * levels.len() as u64 <= self.tally.cases;
        if shared { levels } else { Vec::new() }
    }
}

/// Name under which all collapse modes, or all errors, beyond the first `MOST` different ones are counted.
const OTHERS: &str = "others";

/// Sorts the counts of collapse modes or errors in descending order, with the entry [`OTHERS`] last.
fn sorted(counts: &BTreeMap<String, usize>) -> Vec<(&str, usize)> {
    let mut counts: Vec<(&str, usize)> = counts.iter().map(|(k, n)| (k.as_str(), *n)).collect();
    counts.sort_by_key(|(name, count)| (*name == OTHERS, Reverse(*count), *name));
    counts
}

/// Describes the number of collapses. The share of collapses is stated only if the cases are a sample. In adaptive
/// designs, the cases are not a sample, because levels are chosen on the basis of earlier results.
fn collapse(tally: &Tally, provenance: &Provenance) -> Option<String> {
    let share = tally.collapse()?;
    let share =
        if provenance.is_sample() { format!(": {}", percent(share)) } else { String::new() };
    Some(format!("  {} of {} collapse{share}", tally.collapsed, tally.judged))
}

/// Formats the summary as lines of text.
pub(super) fn lines(answer: &Answer, provenance: &Provenance, folder: &Path) -> Vec<String> {
    let tally = answer.tally;
    let mut lines = vec![provenance.title.clone()];
    let state = if provenance.complete {
        String::new()
    } else {
        format!(
            " of an unfinished study, {} of {} chunks",
            provenance.chunks_done, provenance.chunks
        )
    };
    lines.push(format!("  {}{state}", counted(tally.cases, "case")));
    if let Some(fallen) = answer.modes.get(CollapseMode::Gravity.name()) {
        let fall = if *fallen == 1 { "falls under its" } else { "fall under their" };
        lines.push(format!(
            "  {fallen} {fall} own weight, before being shaken, and count as collapsed"
        ));
    }
    lines.extend(collapse(&tally, provenance));
    lines.extend(answer.endings.sentences().into_iter().map(|said| format!("  {said}")));
    let modes: Vec<String> =
        sorted(&answer.modes).into_iter().map(|(mode, count)| format!("{mode} {count}")).collect();
    if !modes.is_empty() {
        lines.push(format!("  modes: {}", modes.join(", ")));
    }
    let other = tally.cases - tally.judged;
    if other > 0 {
        let why = if answer.errors.is_empty() {
            ""
        } else {
            "; the column `error` says why, most often:"
        };
        lines.push(format!("  {} without a verdict{why}", counted(other, "case")));
        let most = sorted(&answer.errors).into_iter().take(3);
        lines.extend(most.map(|(why, count)| format!("    {count} × {why}")));
    }
    let levels = answer.levels();
    if !levels.is_empty() {
        let measure = provenance.measure.as_deref().unwrap_or("level");
        lines.push(String::new());
        lines.push(format!(
            "  {:>14}  collapse (95 % interval)",
            format!("{measure} ({})", answer.unit)
        ));
        lines.extend(levels.iter().filter_map(|(level, tally)| {
            let collapse = tally.collapse()?;
            let shown = (1e6 * level).round() / 1e6;
            Some(format!(
                "  {shown:>14}  {} of {}: {}",
                tally.collapsed,
                tally.judged,
                percent(collapse)
            ))
        }));
    }
    lines.push(String::new());
    lines.push(format!("table: {}", folder.join("table.csv").display()));
    lines
}

/// Describes the progress of a study in words.
pub(super) fn status(status: &Status) -> Vec<String> {
    let provenance = &status.provenance;
    let mut lines = vec![
        provenance.title.clone(),
        format!(
            "  {} of {} chunks, {} cases done{}",
            provenance.chunks_done,
            provenance.chunks,
            provenance.cases,
            if provenance.complete { "; nothing is left to run" } else { "" }
        ),
    ];
    lines.extend(collapse(&status.tally, provenance));
    if !status.missing.is_empty() {
        let mut shown: Vec<String> = status.missing.iter().take(20).map(usize::to_string).collect();
        if status.missing.len() > shown.len() {
            shown.push(format!("and {} more", status.missing.len() - shown.len()));
        }
        lines.push(format!("  missing chunks: {}", shown.join(", ")));
    }
    lines
}

described! {
    /// Results of a study.
    pub(crate) struct StudyResult of found: &(&Answer, &Provenance) {
        /// Name and version of the format of this document.
        schema: &'static str ["study-result/1"] = "study-result/1",
        /// Provenance of the rows of the study.
        provenance: Provenance = found.1.clone(),
        /// Outcomes of the cases of the study.
        tally: TallyRow = TallyRow::of(&(found.0.tally, found.1.is_sample())),
        /// Notes on cases whose runs ended early.
        notes: Vec<String> = found.0.endings.sentences(),
        /// Outcomes of cases, for each level that several cases share.
        levels: Vec<LevelTally> = found.0.levels().iter().map(LevelTally::of).collect(),
    }

    /// Outcomes of the cases of one level.
    pub(crate) struct LevelTally of found: &(f64, Tally) {
        /// The level of the intensity measure.
        level: f64 as "of the measure" = found.0,
        /// Outcomes of the cases at this level.
        tally: TallyRow = TallyRow::of(&(found.1, true)),
    }

    /// Outcomes of cases.
    pub(crate) struct TallyRow of found: &(Tally, bool) {
        /// Number of cases.
        cases: u64 = found.0.cases,
        /// Number of cases with a verdict.
        judged: u64 = found.0.judged,
        /// Number of cases that collapsed.
        collapsed: u64 = found.0.collapsed,
        /// Probability of collapse; null if the cases are not a sample.
        collapse: Option<Fraction> = found.0.collapse().filter(|_| found.1).map(|at| Fraction::of(&at)),
    }

    /// A share with its confidence interval.
    pub(crate) struct Fraction of found: &(f64, [f64; 2]) {
        /// Share of the cases.
        fraction: f64 as "1" = found.0,
        /// 95 % interval of the share (Wilson).
        interval_95: [f64; 2] as "1" = found.1,
    }
}
