//! Sentence that names the run shown on a page, and compares its outcome with the outcomes of all variants.

use super::{View, all_of};
use crate::variants::Spread;

/// Outcome of the run that is shown, in one plane or in three dimensions.
pub struct ShownOutcome<'a> {
    /// The plane; `None` for a three-dimensional model.
    pub view: Option<View>,
    /// Kind of the outcome of the run, such as "collapse".
    pub kind: &'a str,
    /// Statistics of all variants.
    pub spread: &'a Spread,
}

/// Returns a sentence that names the shown run and compares its outcome with the outcomes of all variants, such as "The
/// run that is shown is that of variant 15, the most typical of all runs: the stack stands, while 12 of 64 variants
/// fall.". The sentence is empty if `outcomes` is empty.
pub fn shown_run(number: u32, outcomes: &[ShownOutcome<'_>]) -> String {
    let Some(first) = outcomes.first() else { return String::new() };
    let run = match number {
        0 => "the stack as stated".to_owned(),
        number => format!("variant {number}"),
    };
    let typical =
        if number == first.spread.typical { ", the most typical of all runs" } else { "" };
    let clause = |one: &ShownOutcome<'_>| {
        let place = one.view.map_or_else(String::new, |view| format!("{}, ", view.words()));
        format!("{place}{}", fate(one))
    };
    let clauses: Vec<String> = outcomes.iter().map(clause).collect();
    format!("The run that is shown is that of {run}{typical}: {}.", clauses.join("; "))
}

/// Describes the outcome of the run and, if some variants have another outcome, the number of variants that fall.
fn fate(one: &ShownOutcome<'_>) -> String {
    let Spread { variants, collapsed, standing_until, .. } = *one.spread;
    let (counted, plural) = match collapsed {
        0 => (format!("none of {variants} variants"), false),
        all if all == variants => (all_of(all), all > 1),
        some => (format!("{some} of {variants} variants"), some > 1),
    };
    let fall = if plural { "fall" } else { "falls" };
    match (one.kind, standing_until) {
        ("stable", Some(until)) if collapsed == 0 => {
            format!("the stack stands until the runs end at {until:.1} s")
        }
        ("stable", _) if collapsed == 0 => "the stack stands".to_owned(),
        ("stable", _) => format!("the stack stands, while {counted} {fall}"),
        ("collapse", _) if collapsed == variants => "the stack falls".to_owned(),
        ("collapse", _) if collapsed == 0 => format!("the stack falls, while {counted} {fall}"),
        ("collapse", _) => {
            format!("the stack falls, as {} {counted}", if plural { "do" } else { "does" })
        }
        _ => "the stack has no verdict".to_owned(),
    }
}
