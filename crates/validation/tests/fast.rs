//! Runs every problem at fast effort.

use std::collections::HashSet;

use barrelstack_validation::{Effort, all, execute, page};

#[test]
#[allow(clippy::print_stdout, reason = "the measured errors, shown when it fails")]
fn every_problem_is_answered_within_its_fast_tolerance() {
    let problems = all();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let rows = execute(&problems, Effort::Fast, threads, &|_, _| {});
    assert_eq!(rows.len(), problems.len());
    for (problem, row) in problems.iter().zip(&rows) {
        println!("{}", page::line(problem, row, Effort::Fast));
    }
    let failed: Vec<&str> = problems
        .iter()
        .zip(&rows)
        .filter(|(_, row)| !row.passed)
        .map(|(problem, _)| problem.id.as_str())
        .collect();
    assert!(failed.is_empty(), "outside their tolerances: {failed:?}");
}

#[test]
fn every_problem_has_a_name_of_its_own_and_a_source() {
    let problems = all();
    let names: HashSet<&str> = problems.iter().map(|problem| problem.id.as_str()).collect();
    assert_eq!(names.len(), problems.len());
    for problem in &problems {
        assert!(!problem.source.is_empty() && problem.exact.is_finite(), "{}", problem.id);
        assert!(problem.tolerance.limit() >= 0.0, "{}", problem.id);
    }
}
