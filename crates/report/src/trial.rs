//! "Try a change": a page with a program, embedded in a report.

/// A page with a program, and its start data.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The page, as [`Shell`](crate::Shell) makes it.
    pub page: &'a str,
    /// The content of its element `start`: JSON.
    pub start: &'a str,
}

/// Markup of the control that opens it.
pub(crate) const OPENER: &str = include_str!("../assets/trial.html");

/// Script of the control.
pub(crate) const SCRIPT: &str = include_str!("../assets/trial.js");

/// Style sheet of the control.
pub(crate) const STYLE: &str = include_str!("../assets/trial.css");
