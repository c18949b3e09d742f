//! "Try a change": a report with an embedded page that contains the program.

/// An embedded page that contains the program, and its start data.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The page, as built by [`Shell`](crate::Shell).
    pub page: &'a str,
    /// JSON content of the element `start` of the page.
    pub start: &'a str,
}

/// Markup of the control that opens the embedded page.
pub(crate) const OPENER: &str = include_str!("../assets/trial.html");

/// Script of the control.
pub(crate) const SCRIPT: &str = include_str!("../assets/trial.js");

/// Style sheet of the control.
pub(crate) const STYLE: &str = include_str!("../assets/trial.css");
