//! The button "Try a change" of a report, which opens an embedded page that contains the program.

/// The page that the button "Try a change" opens, and its initial data. The page contains the program and is embedded
/// in the report.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The page, as built by [`Shell`](crate::Shell).
    pub page: &'a str,
    /// Initial data of the page, as JSON: the content of the element with the id `start`.
    pub start: &'a str,
}

/// Markup of the button, and of the dialog that shows the embedded page.
pub(crate) const OPENER: &str = include_str!("../assets/trial.html");

/// Script of the button and the dialog.
pub(crate) const SCRIPT: &str = include_str!("../assets/trial.js");

/// Style sheet of the button and the dialog.
pub(crate) const STYLE: &str = include_str!("../assets/trial.css");
