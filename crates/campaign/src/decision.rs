//! Evaluation of a study for decisions: probability of collapse with its uncertainty, losses, and annual rates.
//!
//! ```text
//! StudyTable ─▶ Cases ─ limit state × measure ─▶ LimitCurve (raw fractions, fit, bands, warnings)
//!                 │ └─ fall heights ─▶ Losses
//! hazard.csv ─────┴──────────────────▶ Site (annual rates)
//!                                        └─▶ Decision ─▶ page (HTML, Markdown), JSON
//! ```
//!
//! Every fitted curve is shown together with the raw fractions. Where the data support no fit, the reason is
//! given instead.

mod cases;
mod curve;
mod export;
mod figures;
mod hazard;
mod indices;
mod json;
mod limit;
mod loss;
mod measures;
mod modes;
mod page;
mod sensitivity;
mod tables;
mod words;

use std::path::Path;

use barrelstack_report::Document;

use crate::measured::TableError;
use crate::study::{
    Collected, Column, Provenance, Role, StudyError, StudyTable, manifest_of, read_shards,
};

pub(crate) use figures::{chance_axis, fitted, points, raw};
pub use json::DecisionDocument;
pub(crate) use json::bounds;
pub(crate) use page::{fingerprint, heading, text};
pub(crate) use words::{fallen_at_rest, left_out, percent, range, refusal};

pub use cases::{Cases, JudgedCase, Measure};
pub use curve::{BandKind, LimitCurve};
pub use export::{ExportError, Exported, export};
pub use hazard::{Lost, Site, SiteHazard};
pub use indices::Sensitivity;
pub use limit::LimitState;
pub use loss::Losses;
pub use measures::MeasureRow;
pub use modes::ModeIncidence;
pub use sensitivity::{Effect, Group, Level};

/// Inputs of a decision besides the study.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Hazard curve of the site; if `None`, annual rates are not computed.
    pub hazard: Option<SiteHazard>,
    /// Exposure time in years; 50 by default.
    pub years: Option<f64>,
}

/// Evaluation of a study: curves, losses, rates, and the report page.
#[derive(Clone, Debug)]
pub struct Decision {
    /// Cases with a verdict.
    pub cases: Cases,
    /// Fragility curve of each limit state against the intensity measure of the study. The first curve is for
    /// collapse: at least one barrel or rack loses its seat.
    pub curves: Vec<LimitCurve>,
    /// Cumulative incidence of each collapse mode against the intensity measure of the study, the most
    /// frequent mode first.
    pub modes: Vec<ModeIncidence>,
    /// Comparison of all intensity measures, the best predictor of collapse first.
    pub measures: Vec<MeasureRow>,
    /// Barrels and wine lost at each level, or the reason why they are unknown.
    pub losses: Result<Losses, String>,
    /// Sobol' indices of the varied quantities, for collapse and for the demands; empty for designs other
    /// than "saltelli".
    pub sensitivities: Vec<Sensitivity>,
    /// Effects of the varied factors on collapse, the largest first.
    pub effects: Vec<Effect>,
    /// Annual rates at the site; `None` if the request has no hazard curve.
    pub site: Option<Site>,
    /// Warnings for the reader.
    pub warnings: Vec<String>,
    /// Report page.
    pub document: Document,
}

impl Decision {
    /// Returns the results as a machine-readable document, in SI units.
    pub fn to_document(&self) -> DecisionDocument {
        DecisionDocument::of(self)
    }
}

/// Reason why a study cannot be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum DecisionError {
    /// No case has a verdict.
    #[error(
        "none of the {rows} cases of the study has a verdict, so the study cannot be evaluated; see the column `error` \
         of its table"
    )]
    NoCases {
        /// Number of rows of the table, each of which is a case.
        rows: usize,
    },
    /// The table lacks a column that every table of a study has.
    #[error(
        "the table of the study has no column `{0}`; it was written by another version of the program"
    )]
    Column(&'static str),
    /// A cell does not hold a list of numbers, although its column requires one.
    #[error(
        "in the table of the study, a cell of the column `{column}` contains \"{found}\", but numbers separated by \
         semicolons are expected; run the chunk that contains this cell again"
    )]
    List {
        /// Name of the column.
        column: &'static str,
        /// Text of the cell.
        found: String,
    },
    /// The hazard curve is unsuitable, for example because its intensity measure differs from the intensity measure of
    /// the study.
    #[error(transparent)]
    Hazard(#[from] TableError),
    /// The folder of the study cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
}

/// Accumulator for the inputs of a decision. The rows of a study are added in parts, so that a table of a
/// million cases need not be held in memory.
struct Gathering {
    made: Provenance,
    cases: cases::Reading,
    /// Values of the factors, one column for each factor.
    factors: Vec<Column>,
    results: indices::Results,
}

impl Gathering {
    fn new(made: &Provenance) -> Result<Self, DecisionError> {
        let factors = made.columns.iter().filter(|column| column.role == Role::Factor);
        Ok(Self {
            made: made.clone(),
            cases: cases::Reading::new(made)?,
            factors: factors.cloned().map(Column::empty).collect(),
            results: indices::Results::default(),
        })
    }

    /// Adds the next rows, in the order of the cases.
    fn add(&mut self, table: &StudyTable) -> Result<(), DecisionError> {
        for (factor, column) in self.factors.iter_mut().zip(table.of_role(Role::Factor)) {
            factor.values.append(column.values.clone()).map_err(StudyError::Table)?;
        }
        self.results.add(&self.made, table);
        self.cases.add(table)
    }

    /// Evaluates the study once all rows are added; `made` is the provenance of the study with the final number of
    /// rows.
    fn decide(self, made: &Provenance, request: &Request) -> Result<Decision, DecisionError> {
        let cases = self.cases.finish()?;
        let effects = sensitivity::effects(&self.factors, made, &cases);
        drop(self.factors);
        let sensitivities = self.results.indices(made);
        let curves: Vec<LimitCurve> = LimitState::worth_telling(&cases)
            .into_iter()
            .map(|limit| LimitCurve::of(&cases, limit, cases.main))
            .collect();
        let modes = modes::of(&cases, &curves[0]);
        let losses = Losses::of(&cases);
        let measures = measures::compare(&cases);
        let site = match &request.hazard {
            Some(hazard) => {
                let losses = losses.as_ref().ok();
                Some(Site::of(&cases, &curves, hazard, request.years.unwrap_or(50.0), losses)?)
            }
            None => None,
        };
        let warnings = words::warnings(&cases, &curves, losses.as_ref().ok(), site.as_ref(), made);
        let mut decision = Decision {
            cases,
            curves,
            modes,
            measures,
            losses,
            sensitivities,
            effects,
            site,
            warnings,
            document: Document::default(),
        };
        decision.document = page::document(&decision, made);
        Ok(decision)
    }
}

/// Evaluates a study whose table is in memory.
///
/// Random resampling starts from the seed of the study, so that the same study always gives the same page.
///
/// # Errors
/// If the table is not the table of a study, no case has a verdict, or the hazard curve is for an intensity measure
/// other than that of the study.
pub fn decide(collected: &Collected, request: &Request) -> Result<Decision, DecisionError> {
    let mut gathering = Gathering::new(&collected.provenance)?;
    gathering.add(&collected.table)?;
    gathering.decide(&collected.provenance, request)
}

/// Evaluates the study in a folder, finished or not, and returns the decision with the provenance of its rows.
///
/// The table is read in parts, so that it need not be held in memory.
///
/// # Errors
/// As for [`decide`] and [`read_shards`].
pub fn decide_folder(
    folder: &Path,
    request: &Request,
) -> Result<(Decision, Provenance), DecisionError> {
    let mut gathering = Gathering::new(&manifest_of(folder)?)?;
    let made = read_shards(folder, &mut |_, rows| gathering.add(rows))?;
    Ok((gathering.decide(&made, request)?, made))
}
