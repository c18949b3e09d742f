//! Runs problems on several threads and checks the answers.
//!
//! Rows are in the order of the problems, independent of the number of threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::{Effort, Failure, Outcome, Problem};

/// The answer to a problem, and its assessment.
#[derive(Debug)]
pub struct Row {
    /// The answer, or the reason why there is none.
    pub answer: Result<Outcome, Failure>,
    /// The error, relative or absolute in accordance with the tolerance; NaN if there is no answer.
    pub error: f64,
    /// `true` if the answer is within the tolerance.
    pub passed: bool,
    /// Wall time (s).
    pub seconds: f64,
}

/// Runs all problems on the given number of threads and returns one row per problem, in the order of the problems.
///
/// `done` is called with the index and the row of each problem when it ends.
pub fn execute(
    problems: &[Problem],
    effort: Effort,
    threads: usize,
    done: &(dyn Fn(usize, &Row) + Sync),
) -> Vec<Row> {
    let next = AtomicUsize::new(0);
    let rows: Mutex<Vec<Option<Row>>> = Mutex::new(problems.iter().map(|_| None).collect());
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(|| {
                loop {
                    // The longest problems are at the end of the list, so the list is run from its end.
                    let taken = next.fetch_add(1, Ordering::Relaxed) + 1;
                    let Some(at) = problems.len().checked_sub(taken) else { break };
                    let problem = &problems[at];
                    let row = judge(problem, effort);
                    done(at, &row);
                    // Rows are complete even after a panic, since each is stored in one assignment.
                    rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner)[at] = Some(row);
                }
            });
        }
    });
    let rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    rows.into_iter().flatten().collect()
}

fn judge(problem: &Problem, effort: Effort) -> Row {
    let start = Instant::now();
    let answer = (problem.run)(effort);
    let tolerance = problem.tolerance(effort);
    let value = answer.as_ref().map_or(f64::NAN, |outcome| outcome.value);
    Row {
        error: tolerance.error(value, problem.exact),
        passed: tolerance.admits(value, problem.exact),
        answer,
        seconds: start.elapsed().as_secs_f64(),
    }
}
