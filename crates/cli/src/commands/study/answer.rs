//! What a study says when it is done, or half done: in words and as JSON.

use std::path::Path;

use barrelstack_campaign::study::{Collected, Endings, Status, StudyTable, Tally};
use serde_json::{Value, json};

/// A number of things, such as "1 case" and "2 cases".
pub(super) fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A probability with its interval, in percent.
fn percent((p, [low, high]): (f64, [f64; 2])) -> String {
    // Rounding may leave a bound a hair below nothing.
    let shown = |share: f64| 100.0 * share.max(0.0);
    format!("{:.1} % ({:.1} to {:.1} %)", shown(p), shown(low), shown(high))
}

/// How many rows have each text of a column, the most frequent first.
fn counts(table: &StudyTable, column: &str) -> Vec<(String, usize)> {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for text in table.texts(column).unwrap_or_default().iter().flatten() {
        match counts.iter_mut().find(|(known, _)| known == text) {
            Some((_, count)) => *count += 1,
            None => counts.push((text.clone(), 1)),
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    counts
}

/// Levels that several cases share, ascending, with how their cases ended; none where levels are drawn.
fn levels(table: &StudyTable) -> Vec<(f64, Tally)> {
    const MOST: usize = 30;
    let mut levels: Vec<(f64, Tally)> = Vec::new();
    let (Some(values), Some(outcomes)) = (table.numbers("level"), table.texts("outcome")) else {
        return levels;
    };
    for (level, outcome) in values.iter().zip(outcomes) {
        let (Some(level), Some(outcome)) = (level, outcome) else { continue };
        let at = levels.iter().position(|(known, _)| known == level).unwrap_or_else(|| {
            levels.push((*level, Tally::default()));
            levels.len() - 1
        });
        if at >= MOST {
            return Vec::new();
        }
        levels[at].1.add(outcome);
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    let shared = levels.len() > 1 && 2 * levels.len() <= table.rows();
    if shared { levels } else { Vec::new() }
}

/// The summary for people.
pub(super) fn lines(collected: &Collected, folder: &Path) -> Vec<String> {
    let Collected { table, provenance } = collected;
    let tally = Tally::of(table);
    let hunted = provenance.design == "ida";
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
    if let Some(collapse) = tally.collapse() {
        // A hunt goes where collapses are: its share of them says nothing.
        let share = if hunted { String::new() } else { format!(": {}", percent(collapse)) };
        lines.push(format!("  {} of {} collapse{share}", tally.collapsed, tally.judged));
    }
    lines.extend(Endings::of(table).sentences().into_iter().map(|said| format!("  {said}")));
    let modes: Vec<String> =
        counts(table, "mode").into_iter().map(|(mode, count)| format!("{mode} {count}")).collect();
    if !modes.is_empty() {
        lines.push(format!("  modes: {}", modes.join(", ")));
    }
    let other = tally.cases - tally.judged;
    if other > 0 {
        lines.push(format!(
            "  {} without a verdict; the column `error` says why, most often:",
            counted(other, "case")
        ));
        lines.extend(
            counts(table, "error")
                .into_iter()
                .take(3)
                .map(|(why, count)| format!("    {count} × {why}")),
        );
    }
    let levels = levels(table);
    if let Some(spec) =
        table.column("level").map(|column| &column.spec).filter(|_| !levels.is_empty())
    {
        let measure = provenance.measure.as_deref().unwrap_or("level");
        lines.push(String::new());
        lines.push(format!(
            "  {:>14}  collapse (95 % interval)",
            format!("{measure} ({})", spec.unit)
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

/// How far a study is, for people.
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
    if provenance.design != "ida" {
        let collapse = status.tally.collapse();
        lines.extend(collapse.map(|share| format!("  collapse so far: {}", percent(share))));
    }
    if !status.missing.is_empty() {
        let mut shown: Vec<String> = status.missing.iter().take(20).map(usize::to_string).collect();
        if status.missing.len() > shown.len() {
            shown.push(format!("and {} more", status.missing.len() - shown.len()));
        }
        lines.push(format!("  missing chunks: {}", shown.join(", ")));
    }
    lines
}

/// How cases ended.
pub(super) fn tally(tally: &Tally) -> Value {
    let collapse =
        tally.collapse().map(|(p, interval)| json!({ "fraction": p, "interval_95": interval }));
    json!({
        "cases": tally.cases, "judged": tally.judged, "collapsed": tally.collapsed, "collapse": collapse,
    })
}

/// The summary as JSON.
pub(super) fn json(collected: &Collected) -> anyhow::Result<String> {
    let levels: Vec<Value> = levels(&collected.table)
        .iter()
        .map(|(level, found)| json!({ "level": level, "tally": tally(found) }))
        .collect();
    let document = json!({
        "provenance": collected.provenance,
        "tally": tally(&Tally::of(&collected.table)),
        "notes": Endings::of(&collected.table).sentences(),
        "levels": levels,
    });
    Ok(serde_json::to_string_pretty(&document)?)
}
