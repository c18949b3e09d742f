//! Report page of a calibration: the parameters, and the measurements compared with the fit.

use barrelstack_report::{Block, Cell, Document, Table, Verdict, capital, significant};

use super::{Calibration, Estimate};

/// Statement of what the intervals cover, used if [`Calibration::covers`] is `None`.
const COVERS: &str = "The 95 % intervals account only for the scatter of the test. They do not cover errors of the \
    model or of values that are assumed to be exact.";

impl Calibration {
    /// Builds the report page of a calibration.
    pub fn document(&self) -> Document {
        let heading = |text: &str| Block::heading(2, text);
        let mut blocks = Vec::new();
        if !self.figures.is_empty() {
            blocks.push(heading("Measurements and fit"));
            blocks.extend(self.figures.iter().cloned().map(Block::Figure));
        }
        blocks.push(heading("Parameters"));
        blocks.push(Block::Table(self.parameters()));
        if self.estimates.len() > 1 && !self.correlation.is_empty() {
            blocks.push(Block::Table(self.correlations()));
        }
        if !self.facts.is_empty() {
            blocks.push(Block::Table(Table::of(
                "Data and settings of the fit.",
                &self.facts,
                &[
                    ("fact", "", &|(name, _)| Cell::text(name)),
                    ("value", "", &|(_, value)| Cell::text(value)),
                ],
            )));
        }
        if !self.scenario.is_empty() {
            blocks.push(heading("Lines for a scenario"));
            blocks.push(Block::Table(Table::of(
                "Lines to paste into a scenario.",
                self.scenario.lines(),
                &[("scenario", "", &|line| Cell::verbatim(*line))],
            )));
        }
        Document {
            title: self.title.clone(),
            verdict: Verdict {
                headline: self.headline(),
                sentences: vec![self.covers.unwrap_or(COVERS).to_owned()],
                ..Verdict::default()
            },
            blocks,
            provenance: vec![(
                "program".to_owned(),
                format!("barrelstack {}", env!("CARGO_PKG_VERSION")),
            )],
            warnings: self.warnings.clone(),
            words: Vec::new(),
            ..Document::default()
        }
    }

    /// Returns the headline: a sentence that states the value of every parameter.
    fn headline(&self) -> String {
        let stated = |estimate: &Estimate| {
            let unit = estimate.unit();
            let value = format!("{} {}", significant(estimate.value, 3), unit);
            format!("{} {}", estimate.name, value.trim_end())
        };
        let all: Vec<String> = self.estimates.iter().map(stated).collect();
        format!("{}.", capital(&all.join(", ")))
    }

    fn parameters(&self) -> Table {
        let bound = |value: f64| Cell::number(Some(value).filter(|value| value.is_finite()), 4);
        Table::of(
            "Parameters, with 95 % intervals.",
            &self.estimates,
            &[
                ("parameter", "", &|of| Cell::text(&of.name)),
                ("value", "", &|of| bound(of.value)),
                ("from", "", &|of| bound(of.low)),
                ("to", "", &|of| bound(of.high)),
                ("unit", "", &|of| Cell::text(of.unit())),
            ],
        )
    }

    fn correlations(&self) -> Table {
        let names = self.estimates.iter().map(|estimate| estimate.name.as_str());
        let columns: Vec<(&str, &str)> =
            std::iter::once("parameter").chain(names).map(|name| (name, "")).collect();
        let mut table = Table::new("Correlations between the parameters.", &columns);
        let row = |(estimate, values): (&Estimate, &Vec<f64>)| {
            let values = values.iter().map(|value| Cell::text(format!("{value:+.2}")));
            std::iter::once(Cell::text(&estimate.name)).chain(values).collect()
        };
        table.rows = self.estimates.iter().zip(&self.correlation).map(row).collect();
        table
    }
}
