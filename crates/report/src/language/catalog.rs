//! The catalog of a language: templates of English texts with their translations.

use std::collections::{HashMap, HashSet};

/// The translations to one language.
pub(super) struct Catalog {
    /// All translations by English string. Strings with placeholders are included as written, for scripts, which fill
    /// the placeholders themselves.
    entries: HashMap<&'static str, &'static str>,
    templates: Vec<Template>,
    /// Indices of the templates, grouped by the rarest word of each template. A template matches only texts that
    /// contain this word.
    by_word: HashMap<&'static str, Vec<usize>>,
    /// Indices of all templates that are not in `by_word`, because every word in them touches a placeholder.
    wordless: Vec<usize>,
}

/// A part of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Text(&'static str),
    /// A placeholder; `{1}` has the index 0.
    Slot(usize),
}

/// A text with placeholders, and its translation.
#[derive(Debug)]
pub(super) struct Template {
    source: Vec<Part>,
    target: Vec<Part>,
    /// Number of letters outside the placeholders.
    pub(super) letters: usize,
}

impl Catalog {
    /// Reads a catalog, whose entries are lines of the form `"English" = "translation"`. Empty lines and comments that
    /// start with `#` are skipped. Any other line is skipped, too, but a test reports it.
    pub(super) fn of(text: &'static str) -> Self {
        let templates: Vec<Template> = text
            .lines()
            .filter_map(entry)
            .filter(|(source, _)| source.contains('{'))
            .map(|(source, target)| Template::of(source, target))
            .filter(|template| template.source.iter().any(|part| matches!(part, Part::Slot(_))))
            .collect();
        let entries = text.lines().filter_map(entry).collect();
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for template in &templates {
            for word in template.words() {
                *counts.entry(word).or_default() += 1;
            }
        }
        let (mut by_word, mut wordless) = (HashMap::<_, Vec<usize>>::new(), Vec::new());
        for (at, template) in templates.iter().enumerate() {
            // The rarest word leaves the fewest templates to compare with a text.
            match template.words().into_iter().min_by_key(|word| (counts[word], *word)) {
                Some(word) => by_word.entry(word).or_default().push(at),
                None => wordless.push(at),
            }
        }
        Self { entries, templates, by_word, wordless }
    }

    /// Returns the translation of a text that is itself an entry, without placeholders.
    pub(super) fn entry(&self, text: &str) -> Option<&'static str> {
        self.entries.get(text).copied()
    }

    /// Returns the templates that a text may match.
    pub(super) fn candidates(&self, text: &str) -> Vec<&Template> {
        let words: HashSet<&str> = words(text).collect();
        let found = words.iter().filter_map(|word| self.by_word.get(word)).flatten();
        let mut places: Vec<usize> = found.chain(&self.wordless).copied().collect();
        places.sort_unstable();
        places.into_iter().map(|at| &self.templates[at]).collect()
    }
}

/// Returns the English text and the translation in a line; `None` if the line is not an entry.
pub(super) fn entry(line: &'static str) -> Option<(&'static str, &'static str)> {
    let (source, rest) = quoted(line.trim())?;
    let (target, rest) = quoted(rest.trim_start().strip_prefix('=')?.trim_start())?;
    let rest = rest.trim_start();
    (rest.is_empty() || rest.starts_with('#')).then_some((source, target))
}

/// Reads the TOML string at the start of `text`. Returns the content of the string and the text after it; `None` if
/// `text` does not start with a string.
fn quoted(text: &'static str) -> Option<(&'static str, &'static str)> {
    let inner = text.strip_prefix('"')?;
    let mut escaped = false;
    let end = inner.char_indices().find(|(_, c)| {
        let ends = *c == '"' && !escaped;
        escaped = *c == '\\' && !escaped;
        ends
    });
    let (end, _) = end?;
    let (raw, rest) = (&inner[..end], &inner[end + 1..]);
    if !raw.contains('\\') {
        return Some((raw, rest));
    }
    // Few entries have an escape, and the catalog lives as long as the program.
    let whole: String = serde_json::from_str(&format!("\"{raw}\"")).ok()?;
    Some((Box::leak(whole.into_boxed_str()), rest))
}

/// Returns the words and numbers of a text.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Splits a template at its placeholders.
fn parts(text: &'static str) -> Vec<Part> {
    let (mut found, mut rest) = (Vec::new(), text);
    let mut from = 0;
    while let Some(at) = rest[from..].find('{').map(|at| at + from) {
        let digits = rest[at + 1..].find('}').map(|end| &rest[at + 1..at + 1 + end]);
        let Some((slot, digits)) =
            digits.and_then(|digits| Some((digits.parse::<usize>().ok()?.checked_sub(1)?, digits)))
        else {
            from = at + 1;
            continue;
        };
        if at > 0 {
            found.push(Part::Text(&rest[..at]));
        }
        found.push(Part::Slot(slot));
        rest = &rest[at + digits.len() + 2..];
        from = 0;
    }
    if !rest.is_empty() {
        found.push(Part::Text(rest));
    }
    found
}

impl Template {
    fn of(source: &'static str, target: &'static str) -> Self {
        let (source, target) = (parts(source), parts(target));
        let letters = source
            .iter()
            .map(|part| if let Part::Text(text) = part { super::letters(text) } else { 0 })
            .sum();
        Self { source, target, letters }
    }

    /// `true` if the template begins with literal text, not with a placeholder.
    pub(super) fn begins_with_text(&self) -> bool {
        matches!(self.source.first(), Some(Part::Text(_)))
    }

    /// Returns the words that occur as whole words in every text that matches the template: those that do not touch a
    /// placeholder.
    fn words(&self) -> Vec<&'static str> {
        let mut found = Vec::new();
        for (at, part) in self.source.iter().enumerate() {
            let Part::Text(text) = part else { continue };
            let (first, last) = (at == 0, at + 1 == self.source.len());
            for word in words(text) {
                let start = word.as_ptr() as usize - text.as_ptr() as usize;
                let joins_before = start == 0 && !first;
                let joins_after = start + word.len() == text.len() && !last;
                if !joins_before && !joins_after {
                    found.push(word);
                }
            }
        }
        found
    }

    /// Finds every match of `text` with this template, and calls `use_it` for each match until `use_it` returns
    /// `false`. The argument of `use_it` is the part of `text` that each placeholder matches, by placeholder index.
    pub(super) fn readings<'a>(&self, text: &'a str, use_it: &mut dyn FnMut(&[&'a str]) -> bool) {
        let slots = self.source.iter().filter_map(|part| match part {
            Part::Slot(slot) => Some(*slot + 1),
            Part::Text(_) => None,
        });
        let mut values = vec![""; slots.max().unwrap_or(0)];
        if matches!(self.source.last(), Some(Part::Text(last)) if !text.ends_with(last)) {
            return;
        }
        read(&self.source, text, &mut values, use_it);
    }

    /// Returns the translation, in which `value(i)` replaces the placeholder with index `i`.
    pub(super) fn write<'a>(&self, value: &dyn Fn(usize) -> &'a str) -> String {
        let part = |part: &Part| match part {
            Part::Text(text) => *text,
            Part::Slot(slot) => value(*slot),
        };
        self.target.iter().map(part).collect()
    }
}

/// Finds every match of `text` with the parts of a template. For each match, stores the part of `text` that each
/// placeholder matches in `values`, and calls `use_it` with them.
///
/// Stops and returns `false` when `use_it` returns `false`; otherwise returns `true`.
fn read<'a>(
    parts: &[Part],
    text: &'a str,
    values: &mut Vec<&'a str>,
    use_it: &mut dyn FnMut(&[&'a str]) -> bool,
) -> bool {
    match parts {
        [] => !text.is_empty() || use_it(values),
        [Part::Text(literal), rest @ ..] => match text.strip_prefix(literal) {
            Some(after) => read(rest, after, values, use_it),
            None => true,
        },
        [Part::Slot(slot)] => {
            if text.is_empty() {
                return true;
            }
            values[*slot] = text;
            use_it(values)
        }
        [Part::Slot(slot), rest @ ..] => {
            let ends: Vec<usize> = match rest[0] {
                Part::Text(next) => {
                    text.match_indices(next).map(|(at, _)| at).filter(|at| *at > 0).collect()
                }
                Part::Slot(_) => text.char_indices().map(|(at, _)| at).skip(1).collect(),
            };
            for end in ends {
                values[*slot] = &text[..end];
                if !read(rest, &text[end..], values, use_it) {
                    return false;
                }
            }
            true
        }
    }
}
