//! League table: the scores of every rack and every device of the catalog.

use std::ops::ControlFlow;
use std::path::Path;

use barrelstack_fragility::share_less;
use barrelstack_report::column::{Column, ColumnSpec, Role, Value, ValueKind, to_csv};
use barrelstack_report::{Block, Cell, Document, Table, Verdict};

use super::{Prepared, Protocol, ScoreError, Sheet, page, prepared};
use crate::decision::{fingerprint, heading, percent, text};
use crate::direction::Direction;
use crate::protect::{Kind, changed, singles, slug};
use crate::scenario::{Scenario, StackSpec, catalog};
use crate::study::{RunOptions, StudyError};
use crate::system;

/// A rack or device of the league table.
#[derive(Clone, Debug, PartialEq)]
pub struct Contender {
    /// Name of the rack, or of the device on the rack of the scenario.
    pub name: String,
    /// "rack" or "device".
    pub kind: &'static str,
    /// Overrides that change the scenario to this rack or device.
    pub changes: Vec<String>,
}

/// Scores of every rack and every device of the catalog.
#[derive(Clone, Debug)]
pub struct League {
    /// Scored racks and devices, the highest score first.
    pub rows: Vec<(Contender, Sheet)>,
    /// Racks and devices that could not be scored, each with the reason.
    pub not_scored: Vec<(Contender, String)>,
    /// Report page.
    pub document: Document,
}

/// Returns the racks and devices that are scored: every rack of the catalog without devices, and every setting of every
/// device on the rack of the scenario.
pub fn contenders(scenario: &Scenario) -> Vec<Contender> {
    let Some(stack) = scenario.stack() else { return Vec::new() };
    let rack = |known: &catalog::CatalogRack| Contender {
        name: format!("{} rack", known.rack.base),
        kind: "rack",
        changes: on_rack(stack, &known.rack),
    };
    let devices = singles(scenario).into_iter().filter(|one| matches!(one.kind, Kind::Device(_)));
    let device = |one: crate::protect::Protection| Contender {
        name: one.name,
        kind: "device",
        changes: one.changes,
    };
    catalog::RACKS.iter().map(rack).chain(devices.map(device)).collect()
}

/// Returns the overrides that replace the rack of a stack. If `columns` or `columns_along` of the stack is not a
/// multiple of the number of barrels that a rack holds in that direction, the overrides also set it to this number.
fn on_rack(stack: &StackSpec, rack: &crate::scenario::Rack) -> Vec<String> {
    let mut changes = vec![format!("stack.rack=\"{}\"", rack.base)];
    if !stack.columns.is_multiple_of(rack.barrels.max(1)) {
        changes.push(format!("stack.columns={}", rack.barrels));
    }
    let along = stack.space.map(|space| space.columns_along).or(stack.columns_along);
    if along.is_some_and(|along| !along.is_multiple_of(rack.barrels_deep.max(1))) {
        changes.push(format!("stack.columns_along={}", rack.barrels_deep));
    }
    changes
}

/// Scores every rack and every device of the catalog, in stacks like that of the scenario.
///
/// The studies are stored in folders below `folder`, so that an interrupted run resumes from there. `report` receives
/// the number of finished runs and the total number of runs. It cancels the runs by returning [`ControlFlow::Break`].
///
/// # Errors
/// If the scenario has no stack, if nothing can be scored, or if a folder cannot be written.
pub fn league(
    scenario: &Scenario,
    protocol: &Protocol,
    folder: &Path,
    options: &RunOptions,
    report: &(dyn Fn(u64, u64) -> ControlFlow<()> + Sync),
) -> Result<League, ScoreError> {
    if scenario.stack().is_none() {
        return Err(ScoreError::NoStack(scenario.title.clone()));
    }
    let refused = |source| ScoreError::State { state: "stacked as in the protocol".into(), source };
    let scenario = &changed(scenario, &protocol.stacked()).map_err(refused)?;
    let (mut ready, mut not_scored) = (Vec::<(Contender, Prepared)>::new(), Vec::new());
    for contender in contenders(scenario) {
        // Many stacks are settled before the first run, so the caller may cancel here as well.
        if report(0, 1).is_break() {
            return Err(StudyError::Stopped.into());
        }
        let made = changed(scenario, &contender.changes)
            .map_err(|source| ScoreError::State { state: contender.name.clone(), source })
            .and_then(|scenario| prepared(&scenario, protocol));
        match made {
            Ok(prepared) => ready.push((contender, prepared)),
            Err(ScoreError::Study(error)) => return Err(error.into()),
            Err(error) => not_scored.push((contender, reason(&error))),
        }
    }
    let all: u64 = ready.iter().map(|(_, prepared)| prepared.cases()).sum();
    let (mut before, mut rows) = (0, Vec::new());
    for (contender, prepared) in ready {
        let below = Path::new(contender.kind).join(slug(&contender.name));
        let place = folder.join(&below);
        system::folder_below(folder, &below)
            .map_err(StudyError::system("create the folder", &place))?;
        let cases = prepared.cases();
        match prepared.run(&place, options, &|done, _| report(before + done, all)) {
            Ok(sheet) => rows.push((contender, sheet)),
            Err(error @ ScoreError::Curve { .. }) => {
                not_scored.push((contender, reason(&error)));
            }
            Err(other) => return Err(other),
        }
        before += cases;
    }
    rows.sort_by_key(|(_, sheet)| std::cmp::Reverse(sheet.score()));
    let mut league = League { rows, not_scored, document: Document::default() };
    league.document = document(&league, scenario, protocol);
    Ok(league)
}

/// Returns the first line of the message of an error and, if the error has a cause, the first line of the message of
/// the cause. Further lines give locations in a generated text, which are of no use to the reader.
fn reason(error: &ScoreError) -> String {
    let line = |text: String| text.lines().next().unwrap_or_default().to_owned();
    let cause =
        std::error::Error::source(error).map(|cause| format!(": {}", line(cause.to_string())));
    line(error.to_string()) + &cause.unwrap_or_default()
}

impl League {
    /// Returns the share of the draws of the uncertain constants in which the score of a row is higher than the score
    /// of the next row. Draws with the same index have the same constants in all rows. Returns `None` for the last
    /// row, or if the scores in the draws are unknown.
    pub fn better_than_next(&self, row: usize) -> Option<f64> {
        let [own, next] = [self.rows.get(row)?, self.rows.get(row + 1)?].map(|(_, s)| s.draws());
        (!own.is_empty() && own.len() == next.len()).then(|| share_less(&next, &own))
    }

    /// Returns the table as CSV, with units in the header row. Racks and devices that could not be scored follow all
    /// others, each with the reason.
    pub fn to_csv(&self) -> String {
        type Cell<'a> = &'a dyn Fn(&Row<'_>) -> Option<Value>;
        struct Row<'a> {
            at: usize,
            one: &'a Contender,
            sheet: Option<&'a Sheet>,
            reason: Option<&'a str>,
        }
        let whole = |value: u32| Some(Value::Integer(i64::from(value)));
        let words = |value: &str| Some(Value::Text(value.to_owned()));
        let runs = |sheet: &Sheet| sheet.rows.iter().map(|row| row.runs).sum::<usize>();
        let interval = |row: &Row<'_>, high: bool| {
            let of = row.sheet?.weakest()?.capacity.interval()?;
            Some(Value::Number(100.0 * if high { of.high } else { of.low }))
        };
        let columns: [(&str, &str, ValueKind, Cell<'_>); 14] = [
            ("name", "", ValueKind::Text, &|row| words(&row.one.name)),
            ("kind", "", ValueKind::Text, &|row| words(row.one.kind)),
            ("score", "cm/s", ValueKind::Integer, &|row| whole(row.sheet?.score())),
            ("sampling_low", "cm/s", ValueKind::Number, &|row| interval(row, false)),
            ("sampling_high", "cm/s", ValueKind::Number, &|row| interval(row, true)),
            ("range_low", "cm/s", ValueKind::Integer, &|row| whole(row.sheet?.range()?[0])),
            ("range_high", "cm/s", ValueKind::Integer, &|row| whole(row.sheet?.range()?[1])),
            ("better_than_next", "", ValueKind::Number, &|row| {
                row.sheet.and_then(|_| self.better_than_next(row.at)).map(Value::Number)
            }),
            ("decides", "", ValueKind::Text, &|row| words(row.sheet?.decisive()?.name)),
            ("state", "", ValueKind::Text, &|row| words(&row.sheet?.weakest()?.state.name)),
            ("direction", "", ValueKind::Text, &|row| {
                words(row.sheet?.weakest()?.direction.name())
            }),
            ("runs", "", ValueKind::Integer, &|row| {
                i64::try_from(runs(row.sheet?)).ok().map(Value::Integer)
            }),
            ("changes", "", ValueKind::Text, &|row| words(&row.one.changes.join("; "))),
            ("not_scored", "", ValueKind::Text, &|row| words(row.reason?)),
        ];
        let scored = self.rows.iter().enumerate();
        let scored =
            scored.map(|(at, (one, sheet))| Row { at, one, sheet: Some(sheet), reason: None });
        let refused = self.not_scored.iter();
        let refused =
            refused.map(|(one, reason)| Row { at: 0, one, sheet: None, reason: Some(reason) });
        let rows: Vec<Row<'_>> = scored.chain(refused).collect();
        let columns = columns.map(|(name, unit, kind, cell)| {
            let mut column = Column::empty(ColumnSpec::new(name, unit, Role::Outcome, kind));
            for row in &rows {
                // The result is ignored: the value always has the kind of its column.
                let _ = column.values.push(cell(row));
            }
            column
        });
        to_csv(&columns)
    }
}

fn document(league: &League, scenario: &Scenario, protocol: &Protocol) -> Document {
    let runs: usize =
        league.rows.iter().flat_map(|(_, sheet)| &sheet.rows).map(|row| row.runs).sum();
    let on_scale =
        |(one, sheet): &(Contender, Sheet)| (one.name.clone(), sheet.score(), sheet.range());
    let scores: Vec<page::OnScale> = league.rows.iter().map(on_scale).collect();
    let mut blocks = vec![
        Block::Figure(page::scale("The scores of the table.", &scores)),
        Block::Table(table(league)),
        text(legend(scenario)),
    ];
    if !league.not_scored.is_empty() {
        blocks.push(heading("Not scored"));
        let row = |(one, reason): &(Contender, String)| format!("{}: {reason}", one.name);
        blocks.push(Block::List(league.not_scored.iter().map(row).collect()));
    }
    if let Some((_, sheet)) = league.rows.first() {
        blocks.push(heading("The protocol"));
        blocks.push(Block::List(page::rules(sheet)));
    }
    Document {
        title: "RockScores of the catalog".to_owned(),
        verdict: Verdict { headline: headline(league), ..Verdict::default() },
        blocks,
        provenance: vec![
            ("protocol".into(), protocol.of(scenario).name),
            ("stack".into(), scenario.title.clone()),
            ("scenario fingerprint".into(), fingerprint(scenario)),
            ("runs".into(), runs.to_string()),
            ("seed".into(), protocol.seed.to_string()),
            ("program".into(), format!("barrelstack {}", env!("CARGO_PKG_VERSION"))),
        ],
        warnings: league
            .rows
            .iter()
            .flat_map(|(_, sheet)| sheet.document.warnings.clone())
            .collect(),
        words: barrelstack::report::WORDS.to_vec(),
        ..Document::default()
    }
}

fn headline(league: &League) -> String {
    let Some((first, sheet)) = league.rows.first() else { return "Nothing was scored.".to_owned() };
    let range = sheet.range().map_or_else(String::new, |[low, high]| {
        format!(" (between {low} and {high} over the uncertain constants)")
    });
    let next = league.rows.get(1).zip(league.better_than_next(0));
    let next = next.map_or_else(String::new, |((next, _), share)| {
        format!(
            " In {} of the random draws of the uncertain constants, its score is higher than the next score, that of \
             {}.",
            percent(share),
            next.name
        )
    });
    let not = match league.not_scored.len() {
        0 => String::new(),
        1 => {
            " One more rack or device could not be scored; the reason follows the table.".to_owned()
        }
        more => format!(
            " {more} more racks and devices could not be scored; the reasons follow the table."
        ),
    };
    format!(
        "The highest RockScore of {} racks and devices{} is {}{range}: {}.{next}{not}",
        league.rows.len(),
        if sheet.scenario.is_spatial() { ", in three dimensions," } else { "" },
        sheet.score(),
        first.name
    )
}

fn table(league: &League) -> Table {
    let rows: Vec<(usize, &Contender, &Sheet)> =
        league.rows.iter().enumerate().map(|(at, (one, sheet))| (at, one, sheet)).collect();
    let range = |of: Option<[u32; 2]>| of.map(|[low, high]| format!("{low}–{high}"));
    let interval = |sheet: &Sheet| {
        let found = sheet.weakest()?.capacity.interval()?;
        Some(format!("{:.0}–{:.0}", 100.0 * found.low, 100.0 * found.high))
    };
    Table::of(
        "RockScore of every rack without devices, and of every device on the rack of the scenario, the highest first.",
        rows,
        &[
            ("rack or device", "", &|(_, one, _)| Cell::text(&one.name)),
            ("RockScore", "cm/s", &|(.., sheet)| Cell::text(sheet.score().to_string())),
            ("confidence interval", "cm/s", &|(.., sheet)| Cell::maybe(interval(sheet))),
            ("range over the uncertain constants", "cm/s", &|(.., sheet)| {
                Cell::maybe(range(sheet.range()))
            }),
            ("draws in which the score is higher than in the next row", "", &|(at, ..)| {
                Cell::maybe(league.better_than_next(*at).map(percent))
            }),
            ("most important constant", "", &|(.., sheet)| {
                Cell::maybe(sheet.decisive().map(|one| one.name))
            }),
            ("weakest state and direction", "", &|(.., sheet)| {
                Cell::maybe(
                    sheet
                        .weakest()
                        .map(|row| format!("{}, shaken {}", row.state.name, row.direction.words())),
                )
            }),
        ],
    )
}

fn legend(scenario: &Scenario) -> String {
    let space = if Direction::of(scenario) == Some(Direction::Space) {
        " In three dimensions the ground moves in all directions, so that these scores cannot be compared with scores \
         from runs in one plane."
    } else {
        ""
    };
    format!(
        "A score compares racks and devices under the same motions; it does not predict the behavior of a particular \
         cellar. The confidence interval (95 %, clustered by motion) is that of the weakest state and direction; there \
         is none where no curve can be fitted. If the friction, stiffness and damping of a stack are drawn from their \
         distributions, its score lies within the range over the uncertain constants with a probability of 95 %. The \
         range includes the sampling error. Each draw of the constants applies to all rows.{space}"
    )
}
