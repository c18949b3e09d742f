//! Date and commit, which the provenance of every page states.

use std::sync::OnceLock;

use crate::{Document, Language};

/// Date of every page, and the commit of the program that writes it.
///
/// Neither belongs to a document, so that equal results give equal documents and fingerprints.
#[derive(Clone, Debug)]
pub struct Stamp {
    /// Function that returns the date to state on a page, such as "2026-11-27 (UTC)", or an empty string for no date.
    /// It is called when the page is written.
    pub date: fn() -> String,
    /// Commit of the program; not stated if empty.
    pub commit: String,
}

static STAMP: OnceLock<Stamp> = OnceLock::new();

impl Stamp {
    /// States the date and the commit on all pages that the process writes from now on. Only the
    /// first call has an effect.
    pub fn state(self) {
        let _ = STAMP.set(self);
    }
}

/// Returns the provenance of a document as pairs of name and value. The date is added as the first pair, and the commit
/// is appended to the version of the program.
pub(crate) fn provenance(document: &Document) -> Vec<(String, String)> {
    stamped(&document.provenance, STAMP.get(), document.language)
}

/// Adds the date and the commit to the pairs of name and value of a provenance; added names are in the given language.
fn stamped(
    pairs: &[(String, String)],
    stamp: Option<&Stamp>,
    language: Language,
) -> Vec<(String, String)> {
    let mut pairs = pairs.to_vec();
    let Some(Stamp { date, commit }) = stamp else { return pairs };
    if !commit.is_empty() {
        let own = language.fixed("program");
        match pairs.iter_mut().find(|(name, _)| name == own) {
            Some((_, program)) => {
                program.push_str(", commit ");
                program.push_str(commit);
            }
            None => pairs.insert(0, (language.fixed("commit").to_owned(), commit.clone())),
        }
    }
    let date = date();
    if !date.is_empty() {
        pairs.insert(0, (language.fixed("made on").to_owned(), date));
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::{Stamp, stamped};
    use crate::Language;

    #[test]
    fn the_date_comes_first_and_the_commit_stands_beside_the_version() {
        let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        let stamp = Stamp { date: || "1970-01-01 (UTC)".to_owned(), commit: "0123abcd".to_owned() };
        let own = [pair("seed", "1"), pair("program", "barrelstack 1.0")];
        let first = pair("made on", "1970-01-01 (UTC)");
        assert_eq!(
            stamped(&own, Some(&stamp), Language::English),
            [first.clone(), pair("seed", "1"), pair("program", "barrelstack 1.0, commit 0123abcd")]
        );
        assert_eq!(
            stamped(&own[..1], Some(&stamp), Language::English),
            [first, pair("commit", "0123abcd"), pair("seed", "1")]
        );
        let none = Stamp { date: String::new, commit: String::new() };
        assert_eq!(stamped(&own, Some(&none), Language::English), own);
        assert_eq!(stamped(&own, None, Language::English), own);
        let spanish = [pair("programa", "barrelstack 1.0")];
        assert_eq!(
            stamped(&spanish, Some(&stamp), Language::Spanish),
            [
                pair("hecho el", "1970-01-01 (UTC)"),
                pair("programa", "barrelstack 1.0, commit 0123abcd")
            ]
        );
    }
}
