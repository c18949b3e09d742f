//! Technical terms: marked where they first occur in a section, and listed at the end.

use crate::{Word, escape};

/// Heading of the list of terms.
pub(crate) const TITLE: &str = "Words";

/// The terms of a page, with a record of the terms that occur on the page.
pub(crate) struct Glossary {
    words: Vec<Word>,
    /// Two flags for each term: whether the term was marked since the last heading, and whether it was marked anywhere.
    marked: Vec<[bool; 2]>,
}

impl Glossary {
    pub(crate) fn of(words: &[Word]) -> Self {
        Self { words: words.to_vec(), marked: vec![[false; 2]; words.len()] }
    }

    /// Begins a section, in which the first occurrence of each term is marked again.
    pub(crate) fn again(&mut self) {
        for [here, _] in &mut self.marked {
            *here = false;
        }
    }

    /// Returns `text` as markup, in which the first occurrence of each term in this section is marked.
    ///
    /// A marked term shows its meaning while the pointer is over the term or while the term has the focus, even
    /// without scripts.
    pub(crate) fn marked(&mut self, text: &str) -> String {
        let mut out = String::new();
        let mut rest = text;
        loop {
            let new = (0..self.words.len()).filter(|at| !self.marked[*at][0]);
            // Of two terms that begin at the same position, prefer the longer.
            let found = new
                .filter_map(|at| Some((find(rest, self.words[at].word)?, at)))
                .min_by_key(|(place, at)| (*place, usize::MAX - self.words[*at].word.len()));
            let Some((place, at)) = found else { break };
            let Word { word, meaning } = self.words[at];
            self.marked[at] = [true; 2];
            let (before, from) = rest.split_at(place);
            let (shown, after) = from.split_at(word.len());
            out += &escape::html(before);
            let (meaning, shown) = (escape::html(meaning), escape::html(shown));
            let button = format!(
                "<button type=\"button\" class=\"term\" aria-describedby=\"word-{at}\" \
                 data-meaning=\"{meaning}\">{shown}</button>"
            );
            // A browser may break a line after a button, but not between a word and its ending or punctuation.
            let end = after.find(char::is_whitespace).unwrap_or(after.len());
            let (own, after) = after.split_at(if end <= MOST_JOINED { end } else { 0 });
            let joined = if own.is_empty() {
                button
            } else {
                format!("<span class=\"joined\">{button}{}</span>", escape::html(own))
            };
            out += &joined;
            rest = after;
        }
        out + &escape::html(rest)
    }

    /// Returns the list of all marked terms with their meanings under a title; empty if there are none.
    pub(crate) fn list(&self, title: &str) -> String {
        let used = self.marked.iter().enumerate().filter(|(_, [_, anywhere])| *anywhere);
        let rows: Vec<String> = used
            .map(|(at, _)| {
                let Word { word, meaning } = self.words[at];
                format!(
                    "<div><dt>{word}</dt><dd id=\"word-{at}\">{}</dd></div>\n",
                    escape::html(meaning)
                )
            })
            .collect();
        if rows.is_empty() {
            return String::new();
        }
        format!(
            "<section class=\"provenance\" id=\"words\">\n<h2>{title}</h2>\n<dl>\n{}</dl>\n</section>\n",
            rows.concat()
        )
    }
}

/// Returns the terms from `words` that occur in `text`.
pub(crate) fn used<'a>(words: &'a [Word], text: &str) -> Vec<&'a Word> {
    words.iter().filter(|one| find(text, one.word).is_some()).collect()
}

/// Maximum length (bytes) of the text between a marked term and the next whitespace, such as a plural ending or a
/// comma, that is kept on the same line as the term.
const MOST_JOINED: usize = 4;

/// Returns the byte index of the first occurrence of `word` or its plural, as a whole word, in `text`; `None` if there
/// is none. The case of ASCII letters is ignored, and the parts of a key such as `stack.rack.mass` are not words.
fn find(text: &str, word: &str) -> Option<usize> {
    let (lower, word) = (text.to_ascii_lowercase(), word.to_ascii_lowercase());
    let letter = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    let of_key = |at: usize| {
        let after = lower[at + word.len()..].strip_prefix('.');
        lower[..at].ends_with('.') || after.is_some_and(|after| after.starts_with(letter))
    };
    let whole = |at: &usize| {
        let after = &lower[at + word.len()..];
        !of_key(*at)
            && !lower[..*at].ends_with(letter)
            && (!after.starts_with(letter)
                || (after.starts_with('s') && !after[1..].starts_with(letter)))
    };
    lower.match_indices(&word).map(|(at, _)| at).find(whole)
}

#[cfg(test)]
mod tests {
    use super::{Glossary, TITLE, find};
    use crate::Word;

    const WORDS: [Word; 2] = [
        Word { word: "rack", meaning: "what barrels lie on" },
        Word { word: "rack sliding", meaning: "a rack < off \"its\" barrels" },
    ];

    #[test]
    fn words_are_found_whole_and_in_the_plural() {
        assert_eq!(find("A Rack", "rack"), Some(2));
        // Parts of a key are not words.
        assert_eq!(find("stack.rack.mass of the rack.", "rack"), Some(23));
        assert_eq!(find("Two racks.", "rack"), Some(4));
        assert_eq!(find("The tracks crack; rack-ground", "rack"), None);
        assert_eq!(find("é rack", "rack"), Some(3));
    }

    #[test]
    fn a_word_is_marked_once_in_a_section_and_listed_once() {
        let mut glossary = Glossary::of(&WORDS);
        let text = glossary.marked("a rack & a rack, by rack sliding");
        assert_eq!(text.matches("<button").count(), 2);
        assert!(text.contains(">rack</button> &amp; a rack, by <button"), "{text}");
        assert!(text.contains("a rack &lt; off &quot;its&quot; barrels"), "{text}");
        assert!(!glossary.marked("rack").contains("button"));
        glossary.again();
        assert!(glossary.marked("rack").contains("button"));
        assert_eq!(glossary.list(TITLE).matches("<dt>").count(), 2);
        assert_eq!(Glossary::of(&WORDS).list(TITLE), "");
    }
}
