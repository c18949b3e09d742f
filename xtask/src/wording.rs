//! Limits on the use of vague words. More precise terms, such as `report`, `request` and
//! `displacement`, can replace them.

use std::path::Path;

use crate::lines::{entries, sources};
use crate::steps::root;

/// Maximum number of occurrences of each group of words in the sources.
const LIMIT: usize = 20;

/// Groups of words; the occurrences of all words of a group are added up.
const GROUPS: [&[&str]; 5] = [
    &["told", "tell", "tells"],
    &["asked", "asks", "ask"],
    &["hear", "hears", "heard"],
    &["seen"],
    &["way", "ways"],
];

/// Fixed phrases whose words do not count, such as "gives way" for a part that fails.
const PHRASES: [&str; 7] =
    ["by the way", "either way", "all the way", "half way", "give way", "gives way", "gave way"];

/// Returns how often `words` occur in a line as whole words, in upper or lower case and outside of
/// [`PHRASES`].
///
/// A word next to a letter, a digit or an underscore is part of a longer word and does not count.
fn count(line: &str, words: &[&str]) -> usize {
    let mut line = line.to_ascii_lowercase();
    for phrase in PHRASES {
        line = line.replace(phrase, "");
    }
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| words.contains(word))
        .count()
}

/// Returns the occurrences of `words` in the sources of all crates and of this program, each as `file:line: text`.
fn places(root: &Path, words: &[&str]) -> anyhow::Result<Vec<String>> {
    let mut folders = entries(&root.join("crates"))?;
    folders.push(root.join("xtask"));
    folders.sort();
    let mut found = Vec::new();
    for folder in folders {
        let mut files = sources(&folder.join("src"))?;
        files.sort();
        // This file has to spell the words.
        for path in files.iter().filter(|path| !path.ends_with("xtask/src/wording.rs")) {
            let name = path.strip_prefix(root)?.display().to_string();
            for (line, at) in std::fs::read_to_string(path)?.lines().zip(1..) {
                let place = format!("{name}:{at}: {}", line.trim());
                found.extend(std::iter::repeat_n(place, count(line, words)));
            }
        }
    }
    Ok(found)
}

#[test]
fn words_count_as_whole_words_outside_of_fixed_phrases() {
    assert_eq!(count("/// Tell what is told; TELLS, tell.", GROUPS[0]), 4);
    assert_eq!(count("fn telling(retell: u8, told_so: u8, untold: u8)", GROUPS[0]), 0);
    assert_eq!(count("By the way, half way is a way of ways; it gives way.", GROUPS[4]), 2);
}

#[test]
fn words_with_a_better_one_in_the_field_stay_rare() {
    for words in GROUPS {
        let found = places(&root(), words).unwrap();
        assert!(
            found.len() <= LIMIT,
            "{} occurrences of {}, at most {LIMIT} are allowed; name what things are or do:\n{}",
            found.len(),
            words.join(", "),
            found.join("\n")
        );
    }
}
