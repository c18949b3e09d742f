//! Divides the cases of a study into chunks.

use std::collections::HashMap;

use super::Study;
use super::design::{Case, Design};
use barrelstack_report::column::Value;

/// A chunk: cases that are run and kept as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Its number, from 0.
    pub number: usize,
    /// Number of cases; of an incremental dynamic analysis, hunts.
    pub cases: usize,
    /// The first of them.
    pub first: u64,
    /// The last of them.
    pub last: u64,
}

/// Number of cases of a chunk, by its position: as the study states, or 64 and twice as many after every 512 chunks.
///
/// Small enough that an interruption loses little and many workers find work, and so few that a million cases make some
/// 2,500 files. The last of many chunks take longest: those of a million cases are 16 times as long as the first.
/// A chunk does not change with the number of chunks after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sizes {
    /// All equal.
    Given(u32),
    /// Growing.
    Growing,
}

/// Chunks of a size before it doubles.
const ALIKE: u64 = 512;

/// Maximum number of doublings, far below overflow; ten million cases, the most that a study has, end after the
/// eighth.
const DOUBLINGS: u64 = 40;

/// Cases of the first chunks.
const FIRST: u64 = 64;

impl Sizes {
    /// Returns the first case of a chunk in the order of the cases, and its number of cases.
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

    /// Returns the number of chunks for a number of cases.
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

/// All chunks of a study.
///
/// Cases of one chunk have the same bodies and contacts where the design allows, so that they can be run in lockstep.
/// Each case goes to the open chunk of its kind, and a chunk is opened when there is none, so that later additions of
/// cases change no full chunk.
#[derive(Clone, Debug)]
pub(super) enum Chunks {
    /// In the order of the cases.
    Even { count: u64, sizes: Sizes },
    /// As listed.
    Listed(Vec<Vec<u32>>),
}

impl Chunks {
    pub(super) fn of(study: &Study) -> Self {
        let (count, sizes) = (study.cases.count(study), study.chunk);
        let mixed = study.factors.iter().any(|factor| factor.structural);
        // Chunks of Monte Carlo are in the order of the cases, since it stops after one of them.
        let ordered = matches!(study.design, Design::MonteCarlo { .. });
        if !mixed || ordered {
            return Self::Even { count, sizes };
        }
        let mut chunks: Vec<Vec<u32>> = Vec::new();
        // The chunk of each kind that has room, by the words of the kind.
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
                reason = "at most the ten million cases of a study"
            )]
            Self::Even { count, sizes } => sizes.chunks(*count) as usize,
            Self::Listed(chunks) => chunks.len(),
        }
    }

    /// Returns the numbers of the cases of a chunk, ascending.
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

    /// Returns the values of the factors that change which bodies and contacts there are.
    fn structure(&self, case: &Case) -> Vec<Option<Value>> {
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
