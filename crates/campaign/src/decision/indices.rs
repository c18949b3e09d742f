//! What matters: first and total Sobol' indices of every varied quantity, on collapse and on the demands.

use std::collections::BTreeMap;

use barrelstack_fragility::{Index, sobol_indices};
use barrelstack_motion::Random;

use super::curve::LEVEL;
use crate::study::{Collected, Role};

/// Resamples of the blocks for intervals.
const REPLICATES: usize = 400;

/// What every varied quantity does to one result.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The result: "collapse", or the name of a column of demands.
    pub result: String,
    /// Blocks of the design that count; those with a case without the result are left out.
    pub blocks: usize,
    /// Blocks that were left out.
    pub left_out: usize,
    /// Every varied quantity with its indices.
    pub inputs: Vec<(String, Index)>,
}

/// Indices on collapse and on every demand that varies; none but for a design made for them.
pub(super) fn of(collected: &Collected) -> Vec<Sensitivity> {
    let (table, made) = (&collected.table, &collected.provenance);
    let size = made.varied.len() + 2;
    let (Some(numbers), Some(outcomes)) = (table.integers("case"), table.texts("outcome")) else {
        return Vec::new();
    };
    if made.varied.is_empty() {
        return Vec::new();
    }
    let collapse: Vec<Option<f64>> = outcomes
        .iter()
        .map(|outcome| match outcome.as_deref() {
            Some("collapse") => Some(1.0),
            Some("stable") => Some(0.0),
            _ => None,
        })
        .collect();
    let mut results = vec![("collapse".to_owned(), collapse)];
    for column in table.of_role(Role::Demand) {
        let values = table.numbers(&column.spec.name).map(<[_]>::to_vec);
        results.extend(values.map(|values| (column.spec.name.clone(), values)));
    }
    let sensitivity = |(result, values): (String, Vec<Option<f64>>)| {
        let mut blocks: BTreeMap<usize, Vec<Option<f64>>> = BTreeMap::new();
        for (number, value) in numbers.iter().zip(values) {
            let number = number.and_then(|number| usize::try_from(number).ok())?;
            blocks.entry(number / size).or_insert_with(|| vec![None; size])[number % size] = value;
        }
        let all = blocks.len();
        let whole: Vec<Vec<f64>> =
            blocks.into_values().filter_map(|block| block.into_iter().collect()).collect();
        let mut random = Random::new(made.seed);
        let found = sobol_indices(&whole, REPLICATES, LEVEL, || random.uniform())?;
        Some(Sensitivity {
            result,
            blocks: whole.len(),
            left_out: all - whole.len(),
            inputs: made.varied.iter().cloned().zip(found).collect(),
        })
    };
    results.into_iter().filter_map(sensitivity).collect()
}
