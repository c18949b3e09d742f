//! Date and commit, which the provenance of every page states.

use std::sync::OnceLock;

use crate::Document;

/// Date of the pages of a process, and the commit of the program that writes them.
///
/// Neither belongs to a document, so that equal results give equal documents and fingerprints.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stamp {
    /// Date, such as "2026-11-27 (UTC)"; not stated if empty.
    pub date: String,
    /// Commit of the program; not stated if empty.
    pub commit: String,
}

static STAMP: OnceLock<Stamp> = OnceLock::new();

impl Stamp {
    /// Creates a stamp from a time (s since the start of 1970, UTC) and a commit.
    ///
    /// ```
    /// use barrelstack_report::Stamp;
    ///
    /// assert_eq!(Stamp::new(951_782_400, "").date, "2000-02-29 (UTC)");
    /// ```
    pub fn new(seconds: u64, commit: impl Into<String>) -> Self {
        // Days are counted from March 1 of the year 0, so that a leap day ends its year; a period
        // of 400 years has 146,097 days.
        let day = seconds / 86_400 + 719_468;
        let (era, day) = (day / 146_097, day % 146_097);
        let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
        let day = day - (365 * year + year / 4 - year / 100);
        let month = (5 * day + 2) / 153;
        let day = day - (153 * month + 2) / 5 + 1;
        let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
        let date = format!("{:04}-{month:02}-{day:02} (UTC)", 400 * era + year + next);
        Self { date, commit: commit.into() }
    }

    /// States this date and commit on all pages that the process writes from now on. Only the first
    /// call has an effect.
    pub fn state(self) {
        let _ = STAMP.set(self);
    }
}

/// Returns the provenance of a document with the date first, and with the commit beside the
/// version of the program.
pub(crate) fn provenance(document: &Document) -> Vec<(String, String)> {
    stamped(&document.provenance, STAMP.get())
}

fn stamped(pairs: &[(String, String)], stamp: Option<&Stamp>) -> Vec<(String, String)> {
    let mut pairs = pairs.to_vec();
    let Some(Stamp { date, commit }) = stamp else { return pairs };
    if !commit.is_empty() {
        match pairs.iter_mut().find(|(name, _)| name == "program") {
            Some((_, program)) => {
                program.push_str(", commit ");
                program.push_str(commit);
            }
            None => pairs.insert(0, ("commit".to_owned(), commit.clone())),
        }
    }
    if !date.is_empty() {
        pairs.insert(0, ("made on".to_owned(), date.clone()));
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::{Stamp, stamped};

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (seconds, date) in [
            (0, "1970-01-01"),
            (86_399, "1970-01-01"),
            (68_256_000, "1972-03-01"),
            (951_868_799, "2000-02-29"),
            (1_408_875_644, "2014-08-24"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(Stamp::new(seconds, "").date, format!("{date} (UTC)"));
        }
        // The largest number gives some date.
        assert!(!Stamp::new(u64::MAX, "").date.is_empty());
    }

    #[test]
    fn the_date_comes_first_and_the_commit_stands_beside_the_version() {
        let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        let stamp = Stamp::new(0, "0123abcd");
        let own = [pair("seed", "1"), pair("program", "barrelstack 1.0")];
        let first = pair("made on", "1970-01-01 (UTC)");
        assert_eq!(
            stamped(&own, Some(&stamp)),
            [first.clone(), pair("seed", "1"), pair("program", "barrelstack 1.0, commit 0123abcd")]
        );
        assert_eq!(
            stamped(&own[..1], Some(&stamp)),
            [first, pair("commit", "0123abcd"), pair("seed", "1")]
        );
        assert_eq!(stamped(&own, Some(&Stamp::default())), own);
        assert_eq!(stamped(&own, None), own);
    }
}
