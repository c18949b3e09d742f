//! Files of a set of records: its table, and a study that uses the records as motions.

use std::fmt::Write as _;

use barrelstack_campaign::study::StudyTable;
use barrelstack_report::csv_field;
use barrelstack_selection::{Chosen, Selection, SelectionTarget};

use super::SelectArgs;
use crate::store::store;

/// A selected set of records, with the table of all records.
pub(super) struct Set<'a> {
    pub(super) args: &'a SelectArgs,
    pub(super) table: &'a StudyTable,
    /// For each candidate, its row in the table.
    pub(super) rows: &'a [usize],
    pub(super) selection: &'a Selection,
}

impl Set<'_> {
    /// Returns the selected records with their rows in the table.
    pub(super) fn chosen(&self) -> impl Iterator<Item = (usize, &Chosen)> {
        self.selection.chosen.iter().map(|chosen| (self.rows[chosen.candidate], chosen))
    }

    /// Returns the text in a cell of the table of records; empty if there is none.
    pub(super) fn text(&self, column: &str, row: usize) -> &str {
        let texts = self.table.texts(column).unwrap_or_default();
        texts.get(row).and_then(Option::as_deref).unwrap_or_default()
    }

    /// Returns the number in a cell of the table of records; `None` if there is none.
    pub(super) fn number(&self, column: &str, row: usize) -> Option<f64> {
        self.table.numbers(column)?.get(row).copied().flatten()
    }

    /// Writes `selection.csv` and `study.toml`.
    pub(super) fn write(&self) -> anyhow::Result<()> {
        store(&self.args.out.join("selection.csv"), self.csv().as_bytes())?;
        store(&self.args.out.join("study.toml"), self.study()?.as_bytes())?;
        let tables = ["selection.csv", "records.csv", "refused.csv"];
        self.args.folder.tables.write(&self.args.out, &tables)
    }

    fn csv(&self) -> String {
        let mut text =
            "record,files,event,factor,magnitude,rupture_distance (km),epicentral_distance (km),vs30 (m/s)\n".to_owned();
        for (row, chosen) in self.chosen() {
            let number = |column: &str| {
                self.number(column, row).map_or_else(String::new, |value| value.to_string())
            };
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{}",
                csv_field(self.text("record", row)),
                csv_field(self.text("files", row)),
                csv_field(self.text("event", row)),
                chosen.scale,
                number("magnitude"),
                number("rupture_distance"),
                number("epicentral_distance"),
                number("vs30")
            );
        }
        text
    }

    /// Returns a study of the set as TOML; every horizontal component is a separate motion, scaled
    /// by the factor of its record.
    fn study(&self) -> anyhow::Result<String> {
        let a = self.args;
        let mut text = format!(
            "# {} records selected for {}, seed {}, scaled by their factors.\n\
             # Records are given with their full paths; adjust these if the records are moved.\n\
             schema = 1\ntitle = {}\nseed = {}\n\n[base]\nextends = {}\n\n\
             [design]\nkind = \"full-factorial\"\n",
            self.selection.chosen.len(),
            a.target,
            a.seed,
            quoted(&format!("{} records for {}", self.selection.chosen.len(), a.target))?,
            a.seed,
            quoted(&a.base)?
        );
        for (row, chosen) in self.chosen() {
            for place in ["h1", "h2"] {
                let (file, channel) = (
                    self.text(&format!("file_{place}"), row),
                    self.text(&format!("name_{place}"), row),
                );
                if file.is_empty() {
                    continue;
                }
                let path = std::path::absolute(file)?.display().to_string();
                let name = format!("{} {channel}", self.text("record", row));
                // Writing to a String cannot fail.
                let _ = write!(
                    text,
                    "\n[[motion]]\nname = {}\nrecords = [{}]\ncomponents = [{}]\nscale = {{ factor = {} }}\n",
                    quoted(&name)?,
                    quoted(&path)?,
                    quoted(self.text(&format!("place_{place}"), row))?,
                    chosen.scale
                );
            }
        }
        Ok(text)
    }

    /// Summarizes the set and its fit in sentences.
    pub(super) fn summary(&self, target: &SelectionTarget) -> Vec<String> {
        let out = self.args.out.display();
        vec![
            self.fit(target),
            format!("written: {out}/selection.csv, {out}/study.toml and {out}/index.html"),
            format!("next: barrelstack study {out}/study.toml --out runs"),
        ]
    }

    /// Describes the fit of the set to the target.
    pub(super) fn fit(&self, target: &SelectionTarget) -> String {
        let selection = self.selection;
        let spread = target.deviation().iter().any(|s| *s > 0.0);
        format!(
            "{} selected of {} that can be scaled to the target: median within {:.1} % of the \
             target, {}, after {} {} of exchanges",
            selection.chosen.len(),
            selection.eligible,
            100.0 * selection.median_error(target),
            if spread {
                format!(
                    "standard deviation of ln Sa within {:.1} % of the target",
                    100.0 * selection.deviation_error(target)
                )
            } else {
                format!(
                    "standard deviation of ln Sa around the target up to {:.2}",
                    selection.deviation_error(target)
                )
            },
            selection.rounds,
            if selection.rounds == 1 { "round" } else { "rounds" }
        )
    }
}

/// Quotes text for TOML.
fn quoted(text: &str) -> anyhow::Result<String> {
    // A JSON string is also a basic string in TOML.
    Ok(serde_json::to_string(text)?)
}
