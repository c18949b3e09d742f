//! First-order and total Sobol' indices of every varied quantity for collapse and for the demands.

use barrelstack_fragility::{Index, sobol_indices};

use super::curve::LEVEL;
use crate::study::{Column, Provenance, Role, StudyTable};

/// Sobol' indices of every varied quantity for one result.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Name of the result: "collapse", or the column of a demand.
    pub result: String,
    /// Number of evaluated blocks of cases. A block is evaluated if every case of the block has the result.
    pub blocks: usize,
    /// Number of blocks that are left out because a case lacks the result.
    pub left_out: usize,
    /// Name and indices of every varied quantity.
    pub inputs: Vec<(String, Index)>,
}

/// Results of every case of a sensitivity design, by case number.
#[derive(Debug, Default)]
pub(super) struct Results {
    /// Name and values of each result: collapse (1 or 0) and the demands; NaN if unknown.
    of: Vec<(String, Vec<f64>)>,
}

impl Results {
    /// Adds the results of the next rows; does nothing unless the design is a sensitivity (Saltelli) design.
    pub(super) fn add(&mut self, made: &Provenance, table: &StudyTable) {
        let (Some(numbers), Some(outcomes)) = (table.integers("case"), table.texts("outcome"))
        else {
            return;
        };
        if made.varied.is_empty() {
            return;
        }
        let collapse: Vec<Option<f64>> = outcomes
            .iter()
            .map(|outcome| match outcome.as_deref() {
                Some("collapse") => Some(1.0),
                Some("stable") => Some(0.0),
                _ => None,
            })
            .collect();
        let mut results = vec![("collapse", collapse.as_slice())];
        let name = |column: &Column| column.spec.name.clone();
        let names: Vec<String> = table.of_role(Role::Demand).map(name).collect();
        results.extend(names.iter().filter_map(|name| Some((name.as_str(), table.numbers(name)?))));
        for (at, (name, values)) in results.into_iter().enumerate() {
            if self.of.len() <= at {
                self.of.push((name.to_owned(), Vec::new()));
            }
            let kept = &mut self.of[at].1;
            for (number, value) in numbers.iter().zip(values) {
                let Some(number) = number.and_then(|n| usize::try_from(n).ok()) else { continue };
                if kept.len() <= number {
                    kept.resize(number + 1, f64::NAN);
                }
                kept[number] = value.unwrap_or(f64::NAN);
            }
        }
    }

    /// Returns the indices for collapse and for every demand that varies; empty unless the design is a sensitivity
    /// (Saltelli) design.
    pub(super) fn indices(self, made: &Provenance) -> Vec<Sensitivity> {
        let size = made.varied.len() + 2;
        let sensitivity = |(result, values): (String, Vec<f64>)| {
            let blocks = values.chunks(size);
            let all = blocks.len();
            let whole: Vec<Vec<f64>> = blocks
                .filter(|block| block.len() == size && !block.iter().any(|v| v.is_nan()))
                .map(<[f64]>::to_vec)
                .collect();
            let found = sobol_indices(&whole, LEVEL)?;
            Some(Sensitivity {
                result,
                blocks: whole.len(),
                left_out: all - whole.len(),
                inputs: made.varied.iter().cloned().zip(found).collect(),
            })
        };
        self.of.into_iter().filter_map(sensitivity).collect()
    }
}
