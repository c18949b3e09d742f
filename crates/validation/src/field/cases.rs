//! Simulated cases of a study, as stored in its CSV file.

use super::FieldError;

/// Columns of a file of cases.
pub const COLUMNS: [&str; 14] = [
    "levels",
    "azimuth (deg)",
    "friction barrel-rack",
    "friction rack-ground",
    "stiffness of a seat (MN/m)",
    "record",
    "factor",
    "pgv (m/s)",
    "outcome",
    "mode",
    "first loss (s)",
    "barrels",
    "barrels fallen",
    "heading",
];

/// Number of unknowns that are drawn for a case: barrel–rack friction, rack–ground friction, stiffness, and factor on
/// the motion.
pub const UNKNOWNS: usize = 4;

/// One simulated stack.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldCase {
    /// Number of levels.
    pub levels: usize,
    /// Azimuth (rad) of the stack in a three-dimensional simulation; `None` in a plane.
    pub azimuth: Option<f64>,
    /// Unknowns: barrel–rack friction, rack–ground friction, stiffness of a seat (MN/m), and factor on the motion.
    pub unknowns: [f64; UNKNOWNS],
    /// `true` if the stack fell.
    pub falls: bool,
    /// Mode of the collapse; empty if the stack did not fall.
    pub mode: String,
    /// Share of the barrels of the stack that fell.
    pub fallen: f64,
    /// Direction in which the first body left its seat: "right", "left", "away" or "near". Empty if the stack stands or
    /// the simulation is planar.
    pub heading: String,
}

/// All cases of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldCases {
    /// Name of the study.
    pub study: String,
    /// The cases whose simulation has an outcome (the stack falls or stands).
    pub cases: Vec<FieldCase>,
    /// Number of cases whose simulation has no outcome.
    pub unjudged: usize,
}

impl FieldCases {
    /// Reads a file of cases.
    ///
    /// # Errors
    /// If the columns differ from [`COLUMNS`], or a cell is not a number.
    pub fn read(study: &str, text: &str) -> Result<Self, FieldError> {
        let mut lines = text.lines();
        if lines.next() != Some(COLUMNS.join(",").as_str()) {
            return Err(FieldError(format!(
                "{study}.csv: expected the columns {}",
                COLUMNS.join(",")
            )));
        }
        let (mut cases, mut unjudged) = (Vec::new(), 0);
        for (line, at) in lines.zip(2..) {
            let cells: Vec<&str> = line.split(',').collect();
            let fault = |what: String| FieldError(format!("{study}.csv, line {at}: {what}"));
            if cells.len() != COLUMNS.len() {
                return Err(fault(format!(
                    "expected {} cells, found {}",
                    COLUMNS.len(),
                    cells.len()
                )));
            }
            let number = |column: usize| {
                let expected = || fault(format!("expected a number, found {:?}", cells[column]));
                cells[column].parse::<f64>().map_err(|_| expected())
            };
            let falls = match cells[8] {
                "collapse" => true,
                "stable" => false,
                _ => {
                    unjudged += 1;
                    continue;
                }
            };
            let azimuth = if cells[1].is_empty() { None } else { Some(number(1)?.to_radians()) };
            cases.push(FieldCase {
                levels: cells[0]
                    .parse()
                    .map_err(|_| fault("the number of levels is not a whole number".to_owned()))?,
                azimuth,
                unknowns: [number(2)?, number(3)?, number(4)?, number(6)?],
                falls,
                mode: cells[9].to_owned(),
                fallen: number(12)? / number(11)?,
                heading: cells[13].to_owned(),
            });
        }
        Ok(Self { study: study.to_owned(), cases, unjudged })
    }

    /// Returns the cases with a given number of levels.
    pub fn of(&self, levels: usize) -> impl Iterator<Item = &FieldCase> {
        self.cases.iter().filter(move |case| case.levels == levels)
    }

    /// Returns the number of cases in which the stack falls, and the number of all cases.
    pub fn count<'a>(cases: impl Iterator<Item = &'a FieldCase>) -> (u32, u32) {
        cases.fold((0, 0), |(falls, all), case| (falls + u32::from(case.falls), all + 1))
    }

    /// Returns the mean share of fallen barrels in the stacks with this number of levels that fell. If no such stack
    /// fell, returns the mean over all stacks that fell. If no stack fell at all, returns 0.
    pub fn fallen(&self, levels: usize) -> f64 {
        let mean = |cases: &mut dyn Iterator<Item = &FieldCase>| {
            let (mut sum, mut count) = (0.0, 0.0);
            for case in cases.filter(|case| case.falls) {
                sum += case.fallen;
                count += 1.0;
            }
            (count > 0.0).then(|| sum / count)
        };
        mean(&mut self.of(levels)).or_else(|| mean(&mut self.cases.iter())).unwrap_or(0.0)
    }
}
