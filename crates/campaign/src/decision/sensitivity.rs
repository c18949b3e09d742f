//! Effects of the varied factors on collapse: the share of collapsed cases at each value of a factor.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use barrelstack_fragility::{Interval, grouped_mean, wilson};

use super::cases::{Cases, JudgedCase, format_value};
use super::curve::LEVEL;
use crate::study::{Column, Provenance, Value};

/// Group of cases in which a factor has the same value.
///
/// If a numeric factor has more than six different values, the cases are instead sorted by value and divided into three
/// groups of equal size.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Value or range of values, for display.
    pub label: String,
    /// Number of cases.
    pub cases: u32,
    /// Number of cases that collapsed.
    pub collapsed: u32,
    /// 95 % interval of the share of cases that collapse.
    pub interval: Interval,
    /// Counts at each level of intensity, for one-at-a-time designs; empty otherwise.
    pub levels: Vec<Level>,
}

/// Cases of a group at one level of intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Intensity (SI).
    pub intensity: f64,
    /// Number of cases.
    pub cases: u32,
    /// Number of cases that collapsed.
    pub collapsed: u32,
    /// 95 % interval of the share of cases that collapse, clustered by motion.
    pub interval: Interval,
}

/// Returns `true` if two intensities belong to the same level. A tolerance is needed because levels are rounded when
/// they are written as text.
pub(super) fn alike(one: f64, other: f64) -> bool {
    (one - other).abs() < 1e-6 * one
}

impl Group {
    /// Returns the share of cases that collapsed.
    pub fn share(&self) -> f64 {
        f64::from(self.collapsed) / f64::from(self.cases)
    }
}

/// Effect of a factor on collapse.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// Name of the factor.
    pub factor: String,
    /// Groups of cases, in ascending order of the value of the factor.
    pub groups: Vec<Group>,
}

impl Effect {
    /// Returns the difference between the largest and the smallest share of collapsed cases among the groups.
    pub fn range(&self) -> f64 {
        let shares = || self.groups.iter().map(Group::share);
        shares().fold(0.0, f64::max) - shares().fold(1.0, f64::min)
    }
}

/// Maximum number of different values of a numeric factor for which each value forms a group of its own.
const MOST: usize = 6;

/// Returns the effects of all factors that vary, the largest first.
pub(super) fn effects(factors: &[Column], made: &Provenance, cases: &Cases) -> Vec<Effect> {
    // In a one-at-a-time design, the cases of a factor are those in which all other factors have their base values.
    let alone = made.design == "one-at-a-time";
    let drawn = |factor: &Column| made.drawn.contains(&factor.spec.name);
    let base: Vec<Option<Value>> = factors.iter().filter(|_| alone).map(most_frequent).collect();
    let mut found: Vec<Effect> = factors
        .iter()
        .enumerate()
        .filter_map(|(at, factor)| {
            let belongs = |case: &&JudgedCase| {
                !alone
                    || factors.iter().zip(&base).enumerate().all(|(other, (column, base))| {
                        let value = || column.values.get(case.row as usize);
                        other == at || drawn(column) || value() == *base
                    })
            };
            let rows = cases
                .all
                .iter()
                .map(AsRef::as_ref)
                .filter(belongs)
                .map(|case| (factor.values.get(case.row as usize), case));
            let mut groups = groups(rows, &factor.spec.unit);
            for (group, of) in groups.iter_mut().filter(|_| alone && cases.records.len() > 1) {
                group.interval = by_motion(of).interval;
                group.levels = levels(of, cases);
            }
            let groups: Vec<Group> = groups.into_iter().map(|(group, _)| group).collect();
            (groups.len() > 1).then(|| Effect { factor: factor.spec.name.clone(), groups })
        })
        .collect();
    found.sort_by(|a, b| b.range().total_cmp(&a.range()));
    found
}

/// Returns the most frequent value of a factor; of several equally frequent values, the first. In a one-at-a-time
/// design this is the base value.
fn most_frequent(factor: &Column) -> Option<Value> {
    let mut counts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for row in 0..factor.values.len() {
        counts.entry(format_value(factor.values.get(row))).or_insert((0, row)).0 += 1;
    }
    let (_, first) = counts.into_values().max_by_key(|(count, first)| (*count, Reverse(*first)))?;
    factor.values.get(first)
}

fn group(label: String, of: Vec<&JudgedCase>) -> (Group, Vec<&JudgedCase>) {
    let cases = u32::try_from(of.len()).unwrap_or(u32::MAX);
    let collapsed = of.iter().map(|case| u32::from(case.collapsed)).sum();
    let interval = wilson(collapsed, cases, LEVEL);
    (Group { label, cases, collapsed, interval, levels: Vec::new() }, of)
}

/// Counts cases and collapses, and computes the interval of the share of collapses, clustered by motion.
fn by_motion(of: &[&JudgedCase]) -> Level {
    let mut motions: BTreeMap<u32, (u32, u32)> = BTreeMap::new();
    for case in of {
        let (collapsed, cases) = motions.entry(case.record).or_default();
        (*collapsed, *cases) = (*collapsed + u32::from(case.collapsed), *cases + 1);
    }
    let shares: Vec<(f64, f64)> =
        motions.values().map(|(sum, cases)| (f64::from(*sum), f64::from(*cases))).collect();
    Level {
        intensity: f64::NAN,
        cases: motions.values().map(|(_, cases)| cases).sum(),
        collapsed: motions.values().map(|(collapsed, _)| collapsed).sum(),
        interval: grouped_mean(&shares, LEVEL),
    }
}

/// Counts cases and collapses at each level, in ascending order; empty if the cases were not scaled to
/// levels.
fn levels(of: &[&JudgedCase], cases: &Cases) -> Vec<Level> {
    let leveled = of.iter().filter(|_| cases.leveled);
    let mut at: Vec<(f64, &JudgedCase)> =
        leveled.filter_map(|case| Some((case.intensity(cases.main)?, *case))).collect();
    at.sort_by(|a, b| a.0.total_cmp(&b.0));
    let parts = at.chunk_by(|a, b| alike(a.0, b.0));
    let level = |part: &[(f64, &JudgedCase)]| {
        let of: Vec<&JudgedCase> = part.iter().map(|(_, case)| *case).collect();
        Level { intensity: part[0].0, ..by_motion(&of) }
    };
    parts.map(level).collect()
}

fn groups<'a>(
    rows: impl Iterator<Item = (Option<Value>, &'a JudgedCase)> + Clone,
    unit: &str,
) -> Vec<(Group, Vec<&'a JudgedCase>)> {
    let numbers: Option<Vec<(f64, &'a JudgedCase)>> = rows
        .clone()
        .map(|(value, case)| match value {
            Some(Value::Number(x)) => Some((x, case)),
            #[expect(clippy::cast_precision_loss, reason = "counts are small")]
            Some(Value::Integer(x)) => Some((x as f64, case)),
            Some(Value::Text(_)) | None => None,
        })
        .collect();
    let with_unit = |text: String| if unit.is_empty() { text } else { format!("{text} {unit}") };
    let short = |x: f64| {
        if x.fract() == 0.0 { format!("{x}") } else { barrelstack_report::significant(x, 3) }
    };
    let Some(mut numbers) = numbers else {
        let mut by_text: BTreeMap<String, Vec<&'a JudgedCase>> = BTreeMap::new();
        for (value, case) in rows {
            by_text.entry(format_value(value)).or_default().push(case);
        }
        return by_text.into_iter().map(|(label, of)| group(label, of)).collect();
    };
    numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let same: Vec<&[(f64, &'a JudgedCase)]> = numbers.chunk_by(|a, b| a.0 == b.0).collect();
    let parts: Vec<&[(f64, &'a JudgedCase)]> = if same.len() <= MOST {
        same
    } else {
        let third = |i: usize| &numbers[i * numbers.len() / 3..(i + 1) * numbers.len() / 3];
        vec![third(0), third(1), third(2)]
    };
    parts
        .into_iter()
        .filter_map(|part| {
            let (first, last) = (part.first()?.0, part.last()?.0);
            let label = if first == last {
                short(first)
            } else {
                format!("{} to {}", short(first), short(last))
            };
            Some(group(with_unit(label), part.iter().map(|(_, case)| *case).collect()))
        })
        .collect()
}
