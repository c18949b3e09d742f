//! Names of compared runs, derived from their differences.

use super::{Difference, differences};
use crate::report::shown;
use crate::scenario::Scenario;
use crate::scenario::title::{counted, shakes};

/// Maximum number of differences in a name; runs with more differences keep their given names.
const MOST: usize = 2;

/// Kind of difference that the name of a run can state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Topic {
    Levels,
    Columns,
    Straps,
    Motion,
    Other,
}

/// Names every run by its differences, such as "five levels" or "with straps".
///
/// If there are more differences than a name can state, the given names are kept.
pub fn labels(runs: &[(String, Scenario)]) -> Vec<String> {
    let differing = differences(runs.iter().map(|(_, scenario)| scenario));
    let mut topics: Vec<(Topic, &Difference)> = Vec::new();
    // A static coefficient that the scenario omits equals the kinetic one, so it does not count as a separate
    // difference.
    let follows = |one: &Difference| {
        one.path.strip_suffix("static_coefficient").is_some_and(|of| {
            let led = |other: &Difference| other.path == format!("{of}coefficient");
            differing.iter().any(|other| led(other) && other.values == one.values)
        })
    };
    for one in differing.iter().filter(|one| !follows(one)) {
        let topic = topic(&one.path);
        if topic == Topic::Other || topics.iter().all(|(known, _)| *known != topic) {
            topics.push((topic, one));
        }
    }
    let names = runs.iter().enumerate().map(|(at, (name, scenario))| {
        if topics.is_empty() || topics.len() > MOST {
            return name.clone();
        }
        let words: Vec<String> = topics
            .iter()
            .map(|(topic, one)| match topic {
                Topic::Levels => {
                    scenario.stack().map_or_else(String::new, |s| counted(s.levels, "level"))
                }
                Topic::Columns => {
                    scenario.stack().map_or_else(String::new, |s| counted(s.columns, "column"))
                }
                Topic::Straps => straps(scenario, runs),
                Topic::Motion => shakes(scenario, None),
                Topic::Other => other(one, at),
            })
            .collect();
        words.join(", ").replace(", with", " with")
    });
    distinct(names)
}

/// Names runs by the inputs that differ, such as "block 1 spacing 1". If more inputs differ than a name can state, the
/// given names are kept.
pub fn labels_by(names: &[String], differing: &[Difference]) -> Vec<String> {
    let name = |(at, name): (usize, &String)| {
        if differing.is_empty() || differing.len() > MOST {
            return name.clone();
        }
        differing.iter().map(|one| other(one, at)).collect::<Vec<_>>().join(", ")
    };
    distinct(names.iter().enumerate().map(name))
}

/// Appends a number to every name that has occurred before, such as "four levels (2)".
fn distinct(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut named: Vec<String> = Vec::new();
    for name in names {
        let again = named.iter().filter(|known| **known == name).count();
        named.push(if again > 0 { format!("{name} ({})", again + 1) } else { name });
    }
    named
}

fn topic(path: &str) -> Topic {
    match path {
        "stack.levels" => Topic::Levels,
        "stack.columns" => Topic::Columns,
        _ if path.starts_with("stack.strap.") => Topic::Straps,
        _ if path.starts_with("motion.") => Topic::Motion,
        _ => Topic::Other,
    }
}

/// Describes the straps of a run, with only those properties that differ between the runs.
fn straps(scenario: &Scenario, runs: &[(String, Scenario)]) -> String {
    let of = |scenario: &Scenario| scenario.stack().map(|stack| stack.devices.strap);
    let Some(own) = of(scenario).filter(|straps| straps.levels > 0) else {
        return "without straps".to_owned();
    };
    let others = || runs.iter().filter_map(|(_, other)| of(other)).filter(|other| other.levels > 0);
    let mut said = vec!["with straps".to_owned()];
    if others().any(|other| other.pretension != own.pretension) {
        said.push(format!("tightened to {} kN", 1e-3 * own.pretension));
    }
    if others().any(|other| other.levels != own.levels) {
        said.push(format!("on {}", counted(own.levels, "level")));
    }
    said.join(" ")
}

/// Describes an input by its name and its value in the run with index `at`, such as "rack-ground friction 0.1"; if the
/// run has no such input, puts "no" before the name.
fn other(one: &Difference, at: usize) -> String {
    // These parts occur in the paths of all inputs of a kind, so they carry no information.
    let empty = ["interface", "coefficient", "stack", "run"];
    let parts: Vec<&str> = one.path.split('.').filter(|part| !empty.contains(part)).collect();
    let name = parts.join(" ").replace('_', " ");
    let value = one.values.get(at).and_then(Option::as_deref);
    value
        .map_or_else(|| format!("no {name}"), |value| format!("{name} {}", shown(&one.path, value)))
}
