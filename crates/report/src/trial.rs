//! "Try a change": a page that holds a program, inside a report.

/// A page that holds a program, and what it starts with.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// The page, as [`Shell`](crate::Shell) makes it.
    pub page: &'a str,
    /// What it finds in its element `start`: JSON.
    pub start: &'a str,
}

/// What opens it, as markup.
pub(crate) const OPENER: &str = include_str!("../assets/trial.html");

/// The script that does.
pub(crate) const SCRIPT: &str = include_str!("../assets/trial.js");

/// How that looks.
pub(crate) const STYLE: &str = include_str!("../assets/trial.css");
