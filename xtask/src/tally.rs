//! Counts of tests, read from the last lines that test runners print.

use std::fmt;

/// Numbers of tests that passed, failed and were skipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    pub(crate) passed: usize,
    pub(crate) failed: usize,
    pub(crate) skipped: usize,
}

impl Tally {
    /// Counts the tests in the output of a command.
    ///
    /// The numbers are read from the closing line of each test run: from Rust's test runner,
    /// `test result: ok. 3 passed; 0 failed; 1 ignored; …`; from scripts, `3 passed, 0 failed, 1 skipped`.
    ///
    /// A test whose data are missing, such as a record that cannot be distributed, prints a line with
    /// `skipped: ` and ends. The test runner counts such a test as passed, but this function counts it
    /// as skipped.
    pub(crate) fn of<'a>(lines: impl IntoIterator<Item = &'a str>) -> Self {
        let mut total = Self::default();
        let mut notices = 0;
        for line in lines {
            let line = line.trim();
            let rust = line.strip_prefix("test result: ").and_then(|rest| rest.split_once(". "));
            if let Some((_, counts)) = rust {
                total.add(counts_of(counts.split(';')).unwrap_or_default());
            } else if let Some(counts) = counts_of(line.split(',')) {
                total.add(counts);
            } else if line.to_ascii_lowercase().contains("skipped: ") {
                notices += 1;
            }
        }
        let misnamed = total.passed.min(notices);
        total.passed -= misnamed;
        total.skipped += misnamed;
        total
    }

    /// Adds another tally.
    pub(crate) fn add(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

/// Returns the counts from parts such as `3 passed`; `None` if a part has another form, or if no
/// part states the number of passed tests.
fn counts_of<'a>(parts: impl Iterator<Item = &'a str>) -> Option<Tally> {
    let mut tally = Tally::default();
    let mut closing = false;
    for part in parts {
        let (count, word) = part.trim().split_once(' ')?;
        if word.starts_with("filtered out") {
            break;
        }
        let count = count.parse().ok()?;
        match word {
            "passed" => (tally.passed, closing) = (count, true),
            "failed" => tally.failed = count,
            "skipped" | "ignored" => tally.skipped += count,
            "measured" => {}
            _ => return None,
        }
    }
    closing.then_some(tally)
}

/// Writes `3 passed, 0 failed`, and `, 1 skipped` if tests were skipped.
impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)?;
        if self.skipped > 0 { write!(f, ", {} skipped", self.skipped) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::Tally;

    fn tally(passed: usize, failed: usize, skipped: usize) -> Tally {
        Tally { passed, failed, skipped }
    }

    #[test]
    fn closing_lines_of_both_kinds_add_up_and_other_lines_count_nothing() {
        let output = "\
running 3 tests
test a ... ok
test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 2 filtered out; finished in 0.01s
3 barrels, 2 racks
12 passed, 1 failed
test result: FAILED. 1 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s
4 passed, 0 failed, 2 skipped";
        assert_eq!(Tally::of(output.lines()), tally(20, 3, 3));
        assert_eq!(Tally::of(["0 failed", "7 skipped", "", "passed"]), Tally::default());
    }

    #[test]
    fn a_test_that_found_nothing_to_test_is_skipped_and_not_passed() {
        let output = "\
skipped: no such record
test a ... skipped: no such folder
test result: ok. 5 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s";
        assert_eq!(Tally::of(output.lines()), tally(3, 0, 2));
    }

    #[test]
    fn the_last_line_names_what_was_skipped_only_where_something_was() {
        assert_eq!(tally(3, 0, 0).to_string(), "3 passed, 0 failed");
        assert_eq!(tally(3, 1, 2).to_string(), "3 passed, 1 failed, 2 skipped");
    }
}
