//! Texts in markup and in scripts.

use super::Language;

/// Attributes whose values are texts, shown on screen or read by a screen reader.
const ATTRIBUTES: [&str; 4] = ["aria-label=\"", "title=\"", "placeholder=\"", "alt=\""];

impl Language {
    /// Translates the texts of markup: those between tags, and labels in attributes.
    ///
    /// The markup must be well formed, without scripts and style sheets.
    pub fn markup(self, markup: &str) -> String {
        if self == Self::English {
            return markup.to_owned();
        }
        let (mut out, mut rest) = (String::with_capacity(markup.len()), markup);
        while let Some(at) = rest.find('<') {
            out += &self.node(&rest[..at]);
            let end = rest[at..].find('>').map_or(rest.len(), |end| at + end + 1);
            out += &self.tag(&rest[at..end]);
            rest = &rest[end..];
        }
        out + &self.node(rest)
    }

    fn node(self, text: &str) -> String {
        let inner = text.trim();
        if inner.is_empty() {
            return text.to_owned();
        }
        let at = text.find(inner).unwrap_or(0);
        format!("{}{}{}", &text[..at], self.text(inner), &text[at + inner.len()..])
    }

    fn tag(self, tag: &str) -> String {
        let mut out = tag.to_owned();
        for name in ATTRIBUTES {
            let opened = format!(" {name}");
            let Some(start) = out.find(&opened).map(|at| at + opened.len()) else { continue };
            let Some(end) = out[start..].find('"').map(|end| start + end) else { continue };
            let text = self.text(&out[start..end]);
            out.replace_range(start..end, &text);
        }
        out
    }
}

/// Returns the texts that a script gives to its function `t`, as first argument in double quotes.
pub(super) fn texts_of_script(script: &str) -> impl Iterator<Item = &str> {
    script.match_indices("t(\"").filter_map(|(at, opening)| {
        let before = script[..at].chars().next_back();
        let inner = &script[at + opening.len()..];
        let called =
            before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != '.' && c != '$');
        Some(&inner[..inner.find('"')?]).filter(|_| called)
    })
}
