//! Wine-barrel stacks in earthquakes: scenario, run, outcome, report.

pub mod scenario;
