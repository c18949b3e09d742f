//! Ensemble of the case with eight barrels, in which contact parameters are 10 % lower or higher. It checks the paper's
//! statement that the results are "robust against variations of the contact element parameters within 10 %".

use barrelstack::scenario::{Scenario, StackSpec};
use barrelstack::summary::Summary;
use barrelstack_report::{Block, Cell, Table};

use super::pool::Job;
use super::vary;

/// Relative change of each parameter.
const REACH: f64 = 0.10;

/// Number of members of the ensemble.
pub(super) const COUNT: usize = 24;

type Change = fn(&mut StackSpec, f64);

/// Names of the contact parameters that are changed, each with the function that multiplies the parameter by a factor.
const PARAMETERS: [(&str, Change); 4] = [
    ("k", vary::stiffness),
    ("c", vary::damping),
    ("μ barrel–rack", vary::barrel_rack_friction),
    ("μ rack–ground", vary::rack_ground_friction),
];

/// Returns the runs: first with one parameter changed at a time, then with all four changed, in every combination.
pub(super) fn jobs(base: &Scenario) -> Vec<Job> {
    members()
        .into_iter()
        .map(|factors| {
            let scenario = vary::with(base, |stack| {
                for ((_, change), factor) in PARAMETERS.iter().zip(factors) {
                    if factor != 1.0 {
                        change(stack, factor);
                    }
                }
            });
            Job::brief(format!("eight barrels, {}", name(factors)), scenario)
        })
        .collect()
}

/// Returns, for each member, the factors of the four parameters: first eight members with one parameter changed, then
/// sixteen members with all four changed.
fn members() -> Vec<[f64; 4]> {
    let mut members = Vec::new();
    for parameter in 0..4 {
        for sign in [-1.0, 1.0] {
            let mut factors = [1.0; 4];
            factors[parameter] += sign * REACH;
            members.push(factors);
        }
    }
    for corner in 0..16_u32 {
        members.push(std::array::from_fn(|parameter| {
            if corner & (8 >> parameter) == 0 { 1.0 - REACH } else { 1.0 + REACH }
        }));
    }
    members
}

fn name(factors: [f64; 4]) -> String {
    let changed: Vec<String> = PARAMETERS
        .iter()
        .zip(factors)
        .filter(|(_, factor)| *factor != 1.0)
        .map(|((name, _), factor)| format!("{name} {}10 %", if factor < 1.0 { "−" } else { "+" }))
        .collect();
    if changed.is_empty() { "as stated".into() } else { changed.join(", ") }
}

/// Returns `true` if every barrel of the top level falls.
pub(super) fn top_falls(summary: &Summary) -> bool {
    let top = summary.bodies.iter().filter_map(|b| b.level).max();
    let mut barrels = summary.bodies.iter().filter(|b| b.kind == "barrel" && b.level == top);
    barrels.all(|b| b.fell_at.is_some())
}

/// Returns `true` if a barrel of the top level is the first to fall.
pub(super) fn top_falls_first(summary: &Summary) -> bool {
    let fallen = summary.bodies.iter().filter(|b| b.kind == "barrel");
    let first = fallen
        .filter_map(|b| Some((b.fell_at?, b.level)))
        .min_by(|(one, _), (other, _)| one.total_cmp(other));
    let top = summary.bodies.iter().filter_map(|b| b.level).max();
    first.is_some_and(|(_, level)| level == top)
}

/// Builds the tables of outcomes: one for parameters changed one at a time, and a collapsible one for all parameters
/// changed at once.
pub(super) fn blocks(base: &Summary, members: &[Summary]) -> Vec<Block> {
    let names: Vec<String> = self::members().into_iter().map(name).collect();
    let all: Vec<_> = names.iter().map(String::as_str).zip(members).collect();
    let (one, corners) = all.split_at(all.len().min(PARAMETERS.len() * 2));
    vec![
        Block::Table(table(
            "The eight barrels with one contact parameter changed.",
            &[&[("as stated", base)], one].concat(),
        )),
        Block::details(
            "All sixteen combinations",
            vec![Block::Table(table(
                "The eight barrels with all four contact parameters changed at once.",
                corners,
            ))],
        ),
    ]
}

fn table(caption: &str, members: &[(&str, &Summary)]) -> Table {
    Table::of(
        caption,
        members,
        &[
            ("parameters", "", &|(name, _)| Cell::text(*name)),
            ("outcome", "", &|(_, m)| Cell::text(m.outcome.mode.unwrap_or(m.outcome.kind))),
            ("first body", "", &|(_, m)| Cell::maybe(m.outcome.first.as_ref())),
            ("leaves its seat", "s", &|(_, m)| Cell::number(m.outcome.time, 3)),
            ("first fall", "s", &|(_, m)| Cell::number(m.outcome.first_fall, 3)),
            ("drift", "%", &|(_, m)| {
                Cell::number(m.demands.top_drift_ratio.map(|drift| 100.0 * drift), 3)
            }),
            ("largest stress", "× at rest", &|(_, m)| {
                Cell::number(m.demands.stress_amplification, 3)
            }),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::{members, name};

    #[test]
    fn every_member_is_another_one_and_none_is_the_base() {
        let members = members();
        assert_eq!(members.len(), super::COUNT);
        for (at, factors) in members.iter().enumerate() {
            assert!(!members[..at].contains(factors), "{}", name(*factors));
            assert_ne!(*factors, [1.0; 4]);
        }
    }
}
