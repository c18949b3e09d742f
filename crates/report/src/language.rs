//! Languages of pages. The strings in the sources are English, and a catalog translates them to another language.

use std::cell::RefCell;
use std::collections::HashMap;
use std::str::FromStr;
use std::sync::OnceLock;

mod catalog;
mod document;
pub(crate) mod markup;

use catalog::{Catalog, Template};

/// The language of a page or a report.
///
/// Numbers, units, commands, file names and station names are the same in all languages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Language {
    /// English, the language of the sources.
    #[default]
    English,
    /// Spanish, as engineers in Chile write it.
    Spanish,
}

impl Language {
    /// All languages.
    pub const ALL: [Self; 2] = [Self::English, Self::Spanish];

    /// Returns the code of the language as in the attribute `lang` of a page, such as "es".
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Spanish => "es",
        }
    }

    fn catalog(self) -> Option<&'static Catalog> {
        static SPANISH: OnceLock<Catalog> = OnceLock::new();
        match self {
            Self::English => None,
            // The English page that contains the program is built without the catalog, which takes half a megabyte.
            Self::Spanish if cfg!(all(target_arch = "wasm32", not(feature = "languages"))) => None,
            Self::Spanish => Some(
                SPANISH.get_or_init(|| Catalog::of(include_str!("../assets/languages/es.toml"))),
            ),
        }
    }

    /// Translates a text of one or more sentences from English; a text without an entry in the
    /// catalog stays in English.
    pub fn text(self, english: &str) -> String {
        match self.catalog() {
            Some(catalog) => Translator::new(catalog).text(english),
            None => english.to_owned(),
        }
    }

    /// Returns the parts of an English text that have no entry in the catalog of the language.
    pub fn untranslated(self, english: &str) -> Vec<String> {
        let Some(catalog) = self.catalog() else { return Vec::new() };
        let Translated { text, mut missing } = Translator::new(catalog).translated(english);
        // A word alone is not a name, even if it begins with a capital.
        if text == english && is_phrase(english) && catalog.entry(english).is_none() {
            missing.push(english.to_owned());
        }
        missing
    }

    /// Returns the translation of an English string that is itself an entry of the catalog; any other string stays in
    /// English.
    pub(crate) fn fixed(self, english: &'static str) -> &'static str {
        self.catalog().and_then(|catalog| catalog.entry(english)).unwrap_or(english)
    }

    /// Returns the translations of the strings that scripts pass to their function `t`, with the English strings as
    /// keys.
    pub(crate) fn entries(self, scripts: &[&str]) -> HashMap<String, String> {
        let Some(catalog) = self.catalog() else { return HashMap::new() };
        let translator = Translator::new(catalog);
        let texts = scripts.iter().flat_map(|script| markup::texts_of_script(script));
        texts.map(|text| (text.to_owned(), translator.text(text))).collect()
    }
}

impl FromStr for Language {
    type Err = UnknownLanguage;

    fn from_str(code: &str) -> Result<Self, Self::Err> {
        let known = Self::ALL.into_iter().find(|language| language.code() == code);
        known.ok_or_else(|| UnknownLanguage(code.to_owned()))
    }
}

/// Error for a language code, such as "xx", for which there is no [`Language`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLanguage(String);

impl std::fmt::Display for UnknownLanguage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "there is no language {:?}; pages are written in en or es", self.0)
    }
}

impl std::error::Error for UnknownLanguage {}

/// A translated text, and the parts of it that have no entry in the catalog.
#[derive(Clone, Debug, Default)]
struct Translated {
    text: String,
    missing: Vec<String>,
}

impl Translated {
    fn kept(text: &str) -> Self {
        let missing = if is_prose(text) { vec![text.trim().to_owned()] } else { Vec::new() };
        Self { text: text.to_owned(), missing }
    }

    /// Returns the number of letters in the parts that have no entry.
    fn untranslated(&self) -> usize {
        self.missing.iter().map(|text| letters(text)).sum()
    }
}

/// Translates the strings of a document; equal strings are translated once.
struct Translator {
    catalog: &'static Catalog,
    known: RefCell<HashMap<String, Translated>>,
}

/// Maximum depth at which a phrase is translated; a deeper phrase stays in English. A part of a phrase, such as the
/// text in the place of a placeholder, is one level deeper than the phrase.
const DEEPEST: usize = 8;

/// Maximum number of matches of a text with one template that are compared to find the best translation.
const READINGS: usize = 24;

impl Translator {
    fn new(catalog: &'static Catalog) -> Self {
        Self { catalog, known: RefCell::default() }
    }

    fn text(&self, english: &str) -> String {
        self.translated(english).text
    }

    fn translated(&self, english: &str) -> Translated {
        let plain = english.replace('\u{a0}', " ");
        self.sentences(&plain, 0)
    }

    /// Translates a text sentence by sentence. If the translation of a sentence is not complete, but the sentence has a
    /// complete translation together with up to three following sentences, these sentences are translated as one
    /// phrase.
    fn sentences(&self, text: &str, depth: usize) -> Translated {
        let parts = sentences(text);
        if parts.len() < 2 {
            return self.phrase(text, depth);
        }
        let (mut whole, mut at) = (Translated::default(), 0);
        while at < parts.len() {
            let joined = |end: usize| {
                let from = parts[at].as_ptr() as usize - text.as_ptr() as usize;
                let to = parts[end].as_ptr() as usize - text.as_ptr() as usize + parts[end].len();
                &text[from..to]
            };
            let alone = self.phrase(parts[at], depth);
            let (mut best, mut end) = (alone, at);
            if !best.missing.is_empty() {
                for last in at + 1..parts.len().min(at + 4) {
                    let longer = self.phrase(joined(last), depth);
                    if longer.missing.is_empty() {
                        (best, end) = (longer, last);
                        break;
                    }
                }
            }
            if at > 0 {
                whole.text.push(' ');
            }
            whole.text += &best.text;
            whole.missing.extend(best.missing);
            at = end + 1;
        }
        whole
    }

    /// Translates a phrase: a sentence, a heading, or the text in the place of a placeholder.
    fn phrase(&self, text: &str, depth: usize) -> Translated {
        if !has_words(text) || depth > DEEPEST {
            return Translated::kept(text);
        }
        if let Some(known) = self.known.borrow().get(text) {
            return known.clone();
        }
        let found = self.read(text, depth);
        self.known.borrow_mut().insert(text.to_owned(), found.clone());
        found
    }

    fn read(&self, text: &str, depth: usize) -> Translated {
        if let Some(fixed) = self.catalog.entry(text) {
            return Translated { text: fixed.to_owned(), missing: Vec::new() };
        }
        let mut best = Translated::kept(text);
        let mut rank = (best.untranslated(), usize::MAX);
        for template in self.catalog.candidates(text) {
            if let Some(found) = self.filled(template, text, depth) {
                let left = found.untranslated();
                let better = (left, usize::MAX - template.letters);
                // A sentence of which less than half is translated stays in English.
                let enough = left <= template.letters;
                if enough && (better < rank || (rank.1 == usize::MAX && left == 0)) {
                    (best, rank) = (found, better);
                }
            }
        }
        if rank.0 == 0 && rank.1 != usize::MAX {
            return best;
        }
        // A sentence of which less than half is translated stays in English.
        let whole = letters(text);
        for found in self.derived(text, depth) {
            let left = found.untranslated();
            if left < best.untranslated() && 2 * left <= whole {
                best = found;
            }
        }
        if best.text == text && is_quotation(text) {
            best.missing.clear();
        }
        best
    }

    /// Returns the best translation of a text by a template; `None` if the text does not match the template.
    fn filled(&self, template: &Template, text: &str, depth: usize) -> Option<Translated> {
        let mut best: Option<Translated> = None;
        let mut left = READINGS;
        template.readings(text, &mut |slots| {
            let parts: Vec<Translated> =
                slots.iter().map(|slot| self.sentences(slot, depth + 1)).collect();
            let text = template.write(&|slot| parts.get(slot).map_or("", |part| &part.text));
            let missing = parts.into_iter().flat_map(|part| part.missing).collect();
            let found = Translated { text, missing };
            if best.as_ref().is_none_or(|best| found.untranslated() < best.untranslated()) {
                best = Some(found);
            }
            left -= 1;
            left > 0 && best.as_ref().is_some_and(|best| !best.missing.is_empty())
        });
        best
    }

    /// Returns candidate translations of a text for which no single entry gives a complete translation.
    ///
    /// If the text has leading or trailing whitespace, the only candidate is the translation of the trimmed text, with
    /// the whitespace restored. Otherwise, the candidates are the translation with the case of the first letter
    /// inverted, the translation without the punctuation around the text, and the translations of the parts of a list,
    /// joined again.
    fn derived(&self, text: &str, depth: usize) -> Vec<Translated> {
        let mut found = Vec::new();
        let inner = text.trim();
        if inner.len() < text.len() {
            let at = text.find(inner).unwrap_or(0);
            let (before, after) = (&text[..at], &text[at + inner.len()..]);
            return vec![around(before, self.phrase(inner, depth + 1), after)];
        }
        if let Some(flipped) = flipped(text) {
            let other = self.other_case(&flipped, depth);
            found.extend(other.map(|other| Translated {
                text: flipped_back(&other.text, text),
                missing: other.missing,
            }));
        }
        for (open, close) in [("(", ")"), ("\"", "\""), ("“", "”"), ("", "."), ("", ":"), ("", ",")]
        {
            let inner = text.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
            if let Some(inner) = inner.filter(|inner| !inner.is_empty()) {
                found.push(around(open, self.sentences(inner, depth + 1), close));
            }
        }
        for (mark, word) in
            [("; ", "; "), (": ", ": "), (", ", ", "), (" and ", " y "), (" or ", " o ")]
        {
            if text.contains(mark) {
                let parts: Vec<Translated> =
                    text.split(mark).map(|part| self.phrase(part, depth + 1)).collect();
                found.push(joined(parts, word));
            }
        }
        found
    }

    /// Translates `flipped`, a text with the case of its first letter inverted. The text must be an entry, or match a
    /// template that begins with literal text and leaves no more letters untranslated than the template contains;
    /// otherwise, returns `None`.
    ///
    /// Does not use [`Self::derived`], which would invert the case of the first letter a second time.
    fn other_case(&self, flipped: &str, depth: usize) -> Option<Translated> {
        if let Some(fixed) = self.catalog.entry(flipped) {
            return Some(Translated { text: fixed.to_owned(), missing: Vec::new() });
        }
        let candidates = self.catalog.candidates(flipped);
        candidates
            .into_iter()
            .filter(|template| template.begins_with_text())
            .filter_map(|template| Some((self.filled(template, flipped, depth)?, template)))
            .filter(|(found, template)| found.untranslated() <= template.letters)
            .min_by_key(|(found, template)| (found.untranslated(), usize::MAX - template.letters))
            .map(|(found, _)| found)
    }
}

fn around(before: &str, inner: Translated, after: &str) -> Translated {
    Translated { text: format!("{before}{}{after}", inner.text), missing: inner.missing }
}

fn joined(parts: Vec<Translated>, word: &str) -> Translated {
    let mut whole = Translated::default();
    for (at, part) in parts.into_iter().enumerate() {
        if at > 0 {
            // Before the sound of i, the Spanish word for "and" is "e" instead of "y".
            let next = part.text.to_lowercase();
            let sound = next.starts_with('i') || next.starts_with("hi");
            whole.text += if word == " y " && sound { " e " } else { word };
        }
        whole.text += &part.text;
        whole.missing.extend(part.missing);
    }
    whole
}

/// Returns a text with the case of its first letter inverted; `None` if the text does not begin with a word.
fn flipped(text: &str) -> Option<String> {
    let mut rest = text.chars();
    let first = rest.next().filter(|c| c.is_alphabetic())?;
    let second = rest.clone().next();
    // A symbol such as "PGA" or "R3" has no other case.
    if !second.is_none_or(|c| c.is_lowercase() || c == ' ') {
        return None;
    }
    let other: String = if first.is_lowercase() {
        first.to_uppercase().collect()
    } else {
        first.to_lowercase().collect()
    };
    Some(other + rest.as_str())
}

/// Gives the first letter of a translation the same case as the first letter of the original.
fn flipped_back(translation: &str, original: &str) -> String {
    let upper = original.starts_with(char::is_uppercase);
    let mut rest = translation.chars();
    match rest.next() {
        Some(first) if upper => first.to_uppercase().chain(rest).collect(),
        Some(first) => first.to_lowercase().chain(rest).collect(),
        None => String::new(),
    }
}

/// Splits a text into sentences, without the spaces between them.
fn sentences(text: &str) -> Vec<&str> {
    let (mut parts, mut start) = (Vec::new(), 0);
    for (at, _) in text.match_indices(' ') {
        let before = &text[start..at];
        let ends = before.ends_with(['.', '?', '!']) && !ends_in_initials(before);
        let next = text[at + 1..].chars().next();
        if ends && at > start && next.is_some_and(|c| !c.is_lowercase() && c != ' ') {
            parts.push(&text[start..at]);
            start = at + 1;
        }
    }
    parts.push(&text[start..]);
    parts
}

/// `true` if a text ends in the initials of a name, such as "A.P.".
fn ends_in_initials(text: &str) -> bool {
    let word = text.rsplit(|c: char| !c.is_alphanumeric() && c != '.').next().unwrap_or("");
    let initial =
        |part: &str| part.len() == 1 && part.starts_with(|c: char| c.is_ascii_uppercase());
    word.strip_suffix('.').is_some_and(|word| word.contains('.') && word.split('.').all(initial))
}

fn letters(text: &str) -> usize {
    text.chars().filter(|c| c.is_alphabetic()).count()
}

/// `true` if a text has a word of at least two letters.
fn has_words(text: &str) -> bool {
    text.split(|c: char| !c.is_alphabetic()).any(|word| word.chars().count() > 1)
}

/// Units that look like words.
const UNITS: [&str; 4] = ["rad", "deg", "min", "mrad"];

/// `true` if a text contains a word of prose, as opposed to a unit, a name, a symbol, or a part of a path, an option or
/// a key.
fn is_prose(text: &str) -> bool {
    text.split(|c: char| c.is_whitespace() || "()[]\"“”,;:".contains(c)).any(|word| {
        let word = word.trim_end_matches(['.', '?', '!', '…']);
        let word = word.strip_suffix("'s").unwrap_or(word);
        word.chars().count() > 2
            && word.chars().all(|c| c.is_lowercase() || c == '-')
            && !word.starts_with('-')
            && !UNITS.contains(&word)
    })
}

/// `true` if the whole text is in double quotes or backticks, such as a quotation from a user's file.
fn is_quotation(text: &str) -> bool {
    let inner = |mark| text.strip_prefix(mark).and_then(|rest| rest.strip_suffix(mark));
    inner('"').or_else(|| inner('`')).is_some_and(|inner| !inner.contains("\" "))
}

/// `true` if a text has a word of at least four letters that is not in capitals.
fn is_phrase(text: &str) -> bool {
    text.split(|c: char| !c.is_alphabetic())
        .any(|word| word.chars().count() > 3 && word.chars().skip(1).all(char::is_lowercase))
}

#[cfg(test)]
mod tests;
