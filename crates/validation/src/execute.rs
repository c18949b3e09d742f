//! Runs problems on several threads and judges the answers; the order of the rows is that of the
//! problems, whatever the number of threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::{Effort, Failure, Outcome, Problem};

/// A problem's answer, judged.
#[derive(Debug)]
pub struct Row {
    /// What the code answered, or why it did not.
    pub answer: Result<Outcome, Failure>,
    /// The error in the measure of the tolerance; not a number without an answer.
    pub error: f64,
    /// Whether the answer is near enough.
    pub passed: bool,
    /// Time on the clock (s).
    pub seconds: f64,
}

/// Runs all problems on a number of threads; one row a problem, in their order.
///
/// `done` is told each problem's place as it ends.
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
                    // The longest stand at the end of the list and begin first.
                    let taken = next.fetch_add(1, Ordering::Relaxed) + 1;
                    let Some(at) = problems.len().checked_sub(taken) else { break };
                    let problem = &problems[at];
                    let row = judge(problem, effort);
                    done(at, &row);
                    // A thread that panicked left no half-written row behind.
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
