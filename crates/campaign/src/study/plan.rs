//! Divides the cases of a study into chunks.

use std::collections::HashMap;

use super::Study;
use super::design::{Design, PlannedCase};
use barrelstack_report::column::Value;

/// A chunk of a study: cases that are run and stored together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Number of the chunk, counted from 0.
    pub number: usize,
    /// Number of cases. In an incremental dynamic analysis, this is the number of hunts; a hunt searches for the
    /// intensity at which a stack collapses under one motion.
    pub cases: usize,
    /// Number of the first case.
    pub first: u64,
    /// Number of the last case.
    pub last: u64,
}

/// Sizes of chunks: the size that the study states or, by default, 64 cases, doubled after every 512 chunks.
///
/// Chunks are small enough that little work is lost if a study is interrupted, and that many processes can work at
/// once. They are large enough that a study of a million cases has only about 2,500 files. In a study of a
/// million cases the last chunks are 16 times as large as the first. The size of a chunk does not depend on
/// the number of later chunks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sizes {
    /// All chunks have the given number of cases.
    Given(u32),
    /// The default: chunks of 64 cases at first, with a size that doubles after every 512 chunks.
    Growing,
}

/// Number of successive chunks of the same size, after which the size doubles.
const ALIKE: u64 = 512;

/// Maximum number of doublings, which prevents overflow. A study of ten million cases, the maximum, needs
/// eight doublings.
const DOUBLINGS: u64 = 40;

/// Number of cases in each chunk before the size doubles for the first time.
const FIRST: u64 = 64;

impl Sizes {
    /// Returns the index of the first case of a chunk (if chunks follow the order of the cases), and the size of the
    /// chunk. The last chunk of a study may have fewer cases.
    fn span(self, chunk: u64) -> (u64, u64) {
        match self {
            Self::Given(size) => (chunk * u64::from(size), u64::from(size)),
            Self::Growing => {
                let (doublings, rest) = ((chunk / ALIKE).min(DOUBLINGS), chunk % ALIKE);
                let size = FIRST << doublings;
                (ALIKE * (size - FIRST) + rest * size, size)
            }
        }
    }

    /// Returns the number of chunks into which a number of cases is divided.
    fn chunks(self, cases: u64) -> u64 {
        match self {
            Self::Given(size) => cases.div_ceil(u64::from(size)),
            Self::Growing => {
                let whole =
                    (1..=DOUBLINGS).take_while(|k| self.span(ALIKE * k).0 <= cases).count() as u64;
                let (first, size) = self.span(ALIKE * whole);
                ALIKE * whole + (cases - first).div_ceil(size)
            }
        }
    }
}

/// Chunks of a study.
///
/// If the design allows, all cases of a chunk have models with the same bodies and contacts, so that they can
/// run in lockstep. Each case is added to a chunk of such cases that is not yet full, or else to a new chunk.
/// Additional cases therefore never change a full chunk.
#[derive(Clone, Debug)]
pub(super) enum Chunks {
    /// Each chunk holds consecutive cases; `count` is the total number of cases.
    Even { count: u64, sizes: Sizes },
    /// For each chunk, the numbers of its cases.
    Listed(Vec<Vec<u32>>),
}

impl Chunks {
    pub(super) fn of(study: &Study) -> Self {
        let (count, sizes) = (study.cases.count(study), study.chunk);
        let mixed = study.factors.iter().any(|factor| factor.structural);
        // Chunks of a Monte Carlo design follow the order of the cases, since the design may stop after any of them.
        let ordered = matches!(study.design, Design::MonteCarlo { .. });
        if !mixed || ordered {
            return Self::Even { count, sizes };
        }
        let mut chunks: Vec<Vec<u32>> = Vec::new();
        // For each kind of model, the chunk that is not yet full.
        let mut open: HashMap<String, usize> = HashMap::new();
        for number in 0..u32::try_from(count).unwrap_or(u32::MAX) {
            let kind = study.structure(&study.cases.case(study, u64::from(number)));
            let kind = format!("{kind:?}");
            let chunk = *open.entry(kind.clone()).or_insert_with(|| {
                chunks.push(Vec::new());
                chunks.len() - 1
            });
            chunks[chunk].push(number);
            if chunks[chunk].len() as u64 >= sizes.span(chunk as u64).1 {
                open.remove(&kind);
            }
        }
        Self::Listed(chunks)
    }

    pub(super) fn len(&self) -> usize {
        match self {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "at most ten million, the limit of cases in a study"
            )]
            Self::Even { count, sizes } => sizes.chunks(*count) as usize,
            Self::Listed(chunks) => chunks.len(),
        }
    }

    /// Returns the numbers of the cases in a chunk, in ascending order.
    pub(super) fn numbers(&self, chunk: usize) -> Vec<u64> {
        match self {
            Self::Even { count, sizes } => {
                let (first, size) = sizes.span(chunk as u64);
                (first..(first + size).min(*count)).collect()
            }
            Self::Listed(chunks) => {
                chunks.get(chunk).into_iter().flatten().map(|number| u64::from(*number)).collect()
            }
        }
    }
}

impl Study {
    /// Returns all chunks, in order.
    pub fn plan(&self) -> impl Iterator<Item = Chunk> {
        (0..self.chunks.len()).map(|number| {
            let cases = self.chunks.numbers(number);
            let [first, last] =
                [cases.first(), cases.last()].map(|case| case.copied().unwrap_or(0));
            Chunk { number, cases: cases.len(), first, last }
        })
    }

    /// Returns the number of chunks.
    pub fn chunk_count(&self) -> usize {
        self.chunks.len()
    }

    /// Returns the values of those factors that change the bodies and contacts of the model.
    fn structure(&self, case: &PlannedCase) -> Vec<Option<Value>> {
        let structural = |index: &usize| self.factors[*index].structural;
        (0..self.factors.len())
            .filter(structural)
            .map(|index| self.factor_value(case, index))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Sizes;

    #[test]
    fn growing_chunks_hold_every_case_once_and_are_few() {
        for (cases, expected) in [(1, 1), (64, 1), (65, 2), (32_768, 512), (32_769, 513)] {
            assert_eq!(Sizes::Growing.chunks(cases), expected, "{cases} cases");
        }
        let chunks = Sizes::Growing.chunks(1_000_000);
        assert_eq!(chunks, 4 * 512 + 497);
        assert!(Sizes::Growing.chunks(10_000_000) < 5000);
        let mut next = 0;
        for chunk in 0..chunks {
            let (first, size) = Sizes::Growing.span(chunk);
            assert_eq!(first, next);
            next = first + size;
        }
        assert!(next >= 1_000_000);
    }
}
