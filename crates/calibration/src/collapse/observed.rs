//! Observations of collapses from videos or notes: one row per test.

use barrelstack::outcome::CollapseMode;
use barrelstack::scenario::Dimension;
use barrelstack_input::measured::CellContent;

use crate::{CalibrateError, Table};

/// Cell text for a barrel or a stack that still stood at the end of the observation.
const STANDS: &str = "stands";

/// Suffix after the name of a barrel in the header of its column.
const FELL: &str = " fell";

/// Columns that do not refer to a single barrel.
const COLUMNS: [&str; 6] =
    ["scenario", "mode", "first barrel", "loss of seat", "first fall", "until"];

/// Time of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Time {
    /// The event happened at this time (s).
    At(f64),
    /// The event did not happen before the end of the observation.
    Never,
}

/// Outcome of a test: the stack stood, or it collapsed in a certain mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// The stack stood.
    Stands,
    /// The stack collapsed in this mode.
    Collapse(CollapseMode),
}

/// Observations of one test; `None` for a quantity that was not observed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Observed {
    /// Scenario of the test, if the row names one.
    pub(super) scenario: Option<String>,
    /// Mode of collapse; `Mode::Stands` if the stack stood.
    pub(super) mode: Option<Mode>,
    /// Name of the first barrel to fall.
    pub(super) first_barrel: Option<String>,
    /// Time at which the first body left its seat.
    pub(super) loss: Option<Time>,
    /// Time at which the first barrel counts as fallen.
    pub(super) first_fall: Option<Time>,
    /// Name of each observed barrel and the time at which it fell; `Time::Never` if it still stood at the end.
    pub(super) falls: Vec<(String, Time)>,
    /// End of the observation (s), measured from the start of the motion.
    pub(super) until: f64,
}

impl Observed {
    /// Reads every row of a table, and returns the tests and warnings.
    ///
    /// If a row does not state the end of the observation, the end is the last time in the row plus `margin`
    /// (s).
    pub(super) fn read(
        table: &Table,
        margin: f64,
    ) -> Result<(Vec<Self>, Vec<String>), CalibrateError> {
        let barrels: Vec<String> = table
            .names()
            .filter_map(|name| name.strip_suffix(FELL).map(|barrel| barrel.trim().to_owned()))
            .collect();
        let heads: Vec<String> = barrels.iter().map(|barrel| format!("{barrel}{FELL}")).collect();
        let known: Vec<&str> =
            COLUMNS.into_iter().chain(heads.iter().map(String::as_str)).collect();
        let mut warnings = table.unused(&known);
        let ends = times(table, "until")?;
        let losses = times(table, "loss of seat")?;
        let first_falls = times(table, "first fall")?;
        let falls: Vec<Vec<Option<Time>>> =
            heads.iter().map(|head| times(table, head)).collect::<Result<_, _>>()?;
        let mut tests = Vec::new();
        for row in 0..table.count() {
            let text = |name: &str| Some(table.cell(row, name)).filter(|cell| !cell.is_empty());
            let test = Self {
                scenario: text("scenario"),
                mode: mode(table, row)?,
                first_barrel: text("first barrel"),
                loss: losses[row],
                first_fall: first_falls[row],
                falls: barrels
                    .iter()
                    .zip(&falls)
                    .filter_map(|(barrel, times)| Some((barrel.clone(), times[row]?)))
                    .collect(),
                until: 0.0,
            };
            tests.push(test.watched(table, row, ends[row], margin)?);
        }
        if tests.iter().any(|test| !test.falls.is_empty() && test.repeats_itself()) {
            warnings.push(
                "\"first fall\" and \"first barrel\" are ignored in rows that give the fall times of barrels, because \
                 these times contain the same information"
                    .to_owned(),
            );
        }
        for test in tests.iter_mut().filter(|test| !test.falls.is_empty()) {
            (test.first_fall, test.first_barrel) = (None, None);
        }
        Ok((tests, warnings))
    }

    fn repeats_itself(&self) -> bool {
        self.first_fall.is_some() || self.first_barrel.is_some()
    }

    /// Returns every observed time together with the name of its column.
    fn times(&self) -> impl Iterator<Item = (String, Time)> + '_ {
        let own = [("loss of seat", self.loss), ("first fall", self.first_fall)];
        let own = own.into_iter().filter_map(|(name, time)| Some((name.to_owned(), time?)));
        own.chain(self.falls.iter().map(|(barrel, time)| (format!("{barrel}{FELL}"), *time)))
    }

    /// Sets the end of the observation, and checks that nothing was observed after it.
    fn watched(
        mut self,
        table: &Table,
        row: usize,
        end: Option<Time>,
        margin: f64,
    ) -> Result<Self, CalibrateError> {
        let last = self
            .times()
            .filter_map(|(_, time)| if let Time::At(time) = time { Some(time) } else { None })
            .fold(0.0, f64::max);
        if self.mode.is_none() && self.times().next().is_none() && self.first_barrel.is_none() {
            let remedy = "state a mode or a time, or remove the row";
            return Err(table
                .at(row, "mode", "something that was observed", "nothing", remedy)
                .into());
        }
        if let Some(Time::At(until)) = end {
            if let Some((column, _)) =
                self.times().find(|(_, time)| matches!(time, Time::At(time) if *time > until))
            {
                let expected = format!("a time up to the end of the observation at {until} s");
                let found = table.cell(row, &column);
                let remedy = "correct this time, or the column \"until\"";
                return Err(table.at(row, &column, &expected, &found, remedy).into());
            }
            self.until = until;
            return Ok(self);
        }
        let open = self.mode == Some(Mode::Stands)
            || self.times().any(|(_, time)| time == Time::Never)
            || last == 0.0;
        if open {
            let remedy = "state this time; it is needed if a barrel or the stack still stood, or if the row gives no \
            time";
            return Err(table
                .at(row, "until", "the time until which the test was observed", "nothing", remedy)
                .into());
        }
        self.until = last + margin;
        Ok(self)
    }
}

/// Returns the times in a column, with `None` for every empty cell; if there is no such column, all times are
/// `None`.
fn times(table: &Table, name: &str) -> Result<Vec<Option<Time>>, CalibrateError> {
    if !table.has(name) {
        return Ok(vec![None; table.count()]);
    }
    let time = |(row, entry): (usize, CellContent)| match entry {
        CellContent::Empty => Ok(None),
        CellContent::Word => Ok(Some(Time::Never)),
        CellContent::Number(time) if time > 0.0 => Ok(Some(Time::At(time))),
        CellContent::Number(_) => {
            let found = table.cell(row, name);
            let remedy = "count time from the start of the scenario's motion";
            Err(table.at(row, name, "a time above zero", &found, remedy).into())
        }
    };
    table.entries(name, Dimension::TIME, STANDS)?.into_iter().enumerate().map(time).collect()
}

fn mode(table: &Table, row: usize) -> Result<Option<Mode>, CalibrateError> {
    let cell = table.cell(row, "mode");
    if cell.is_empty() {
        return Ok(None);
    }
    if cell == STANDS {
        return Ok(Some(Mode::Stands));
    }
    let modes = CollapseMode::SHAKEN;
    if let Some(mode) = modes.into_iter().find(|mode| mode.name() == cell) {
        return Ok(Some(Mode::Collapse(mode)));
    }
    let names = modes.map(CollapseMode::name).join(", ");
    let expected = format!("{names} or {STANDS}");
    let remedy = "use one of these names, or leave the cell empty";
    Err(table.at(row, "mode", &expected, &format!("\"{cell}\""), remedy).into())
}
