//! How the cases of a study are dealt into chunks.

use super::Study;
use super::column::Value;
use super::design::{Case, Design};

/// A chunk: cases that are run and kept as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Its number, from 0.
    pub number: usize,
    /// How many cases it has; of an incremental dynamic analysis, hunts.
    pub cases: usize,
    /// The first of them.
    pub first: u64,
    /// The last of them.
    pub last: u64,
}

/// All chunks of a study.
///
/// Cases of one chunk have the same bodies and contacts where the design allows, so that they can be run in lockstep.
/// Each case goes to the open chunk of its kind, and a chunk is opened when there is none, so that cases which are
/// added behind change no chunk that was full.
#[derive(Clone, Debug)]
pub(super) enum Chunks {
    /// In the order of the cases.
    Even { count: u64, size: u32 },
    /// As listed.
    Listed(Vec<Vec<u32>>),
}

impl Chunks {
    pub(super) fn of(study: &Study) -> Self {
        let (count, size) = (study.cases.count(study), study.chunk);
        let mixed = study.factors.iter().any(|factor| factor.structural);
        // Chunks of Monte Carlo come in the order of the cases, since it stops after one of them.
        let ordered = matches!(study.design, Design::MonteCarlo { .. });
        if !mixed || ordered {
            return Self::Even { count, size };
        }
        let mut chunks: Vec<Vec<u32>> = Vec::new();
        let mut open: Vec<(Vec<Option<Value>>, usize)> = Vec::new();
        for number in 0..u32::try_from(count).unwrap_or(u32::MAX) {
            let kind = study.structure(&study.cases.case(study, u64::from(number)));
            let at = if let Some(at) = open.iter().position(|(known, _)| *known == kind) {
                at
            } else {
                open.push((kind, chunks.len()));
                chunks.push(Vec::new());
                open.len() - 1
            };
            let chunk = open[at].1;
            chunks[chunk].push(number);
            if chunks[chunk].len() >= size as usize {
                open.swap_remove(at);
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
            Self::Even { count, size } => count.div_ceil(u64::from(*size)) as usize,
            Self::Listed(chunks) => chunks.len(),
        }
    }

    /// The numbers of the cases of a chunk, ascending.
    pub(super) fn numbers(&self, chunk: usize) -> Vec<u64> {
        match self {
            Self::Even { count, size } => {
                let first = chunk as u64 * u64::from(*size);
                (first..(first + u64::from(*size)).min(*count)).collect()
            }
            Self::Listed(chunks) => {
                chunks.get(chunk).into_iter().flatten().map(|number| u64::from(*number)).collect()
            }
        }
    }
}

impl Study {
    /// All chunks, in order.
    pub fn plan(&self) -> impl Iterator<Item = Chunk> {
        (0..self.chunks.len()).map(|number| {
            let cases = self.chunks.numbers(number);
            let [first, last] =
                [cases.first(), cases.last()].map(|case| case.copied().unwrap_or(0));
            Chunk { number, cases: cases.len(), first, last }
        })
    }

    /// How many chunks there are.
    pub fn chunk_count(&self) -> usize {
        self.chunks.len()
    }

    /// The values of the factors that change what bodies and contacts there are.
    fn structure(&self, case: &Case) -> Vec<Option<Value>> {
        let structural = |index: &usize| self.factors[*index].structural;
        (0..self.factors.len()).filter(structural).map(|index| self.told(case, index)).collect()
    }
}
