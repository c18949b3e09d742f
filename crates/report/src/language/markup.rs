//! Finds the text in markup and in scripts that is to be translated.

use super::Language;

/// Attributes whose values are shown on screen or read by a screen reader.
const ATTRIBUTES: [&str; 4] = ["aria-label=\"", "title=\"", "placeholder=\"", "alt=\""];

impl Language {
    /// Translates the text in markup: the text between tags, and the values of attributes that contain labels.
    ///
    /// After a tag with `translate="no"`, the text up to the next tag stays in English, and so do the attributes of
    /// the tag itself.
    ///
    /// The markup must be well formed, without scripts and style sheets.
    pub fn markup(self, markup: &str) -> String {
        if self == Self::English {
            return markup.to_owned();
        }
        replaced(markup, &mut |text| self.text(text))
    }
}

/// Returns each piece of text in markup that [`Language::markup`] translates.
pub(crate) fn texts_of_markup(markup: &str) -> Vec<String> {
    let mut texts = Vec::new();
    replaced(markup, &mut |text| {
        texts.push(text.to_owned());
        text.to_owned()
    });
    texts
}

fn replaced(markup: &str, new: &mut dyn FnMut(&str) -> String) -> String {
    let (mut out, mut rest) = (String::with_capacity(markup.len()), markup);
    let mut kept = false;
    loop {
        let at = rest.find('<').unwrap_or(rest.len());
        let text = &rest[..at];
        let inner = if kept { "" } else { text.trim() };
        if inner.is_empty() {
            out += text;
        } else {
            out += &text.replacen(inner, &new(inner), 1);
        }
        if at == rest.len() {
            return out;
        }
        let end = rest[at..].find('>').map_or(rest.len(), |end| at + end + 1);
        let element = &rest[at..end];
        kept = element.contains(" translate=\"no\"");
        out += &if kept { element.to_owned() } else { tag(element, new) };
        rest = &rest[end..];
    }
}

fn tag(tag: &str, new: &mut dyn FnMut(&str) -> String) -> String {
    let mut out = tag.to_owned();
    for name in ATTRIBUTES {
        let opened = format!(" {name}");
        let Some(start) = out.find(&opened).map(|at| at + opened.len()) else { continue };
        let Some(end) = out[start..].find('"').map(|end| start + end) else { continue };
        let text = new(&out[start..end]);
        out.replace_range(start..end, &text);
    }
    out
}

/// Returns the contents of the double-quoted string literals that a script passes to its function `t` as the
/// first argument.
pub(crate) fn texts_of_script(script: &str) -> impl Iterator<Item = &str> {
    script.match_indices("t(\"").filter_map(|(at, opening)| {
        let before = script[..at].chars().next_back();
        let inner = &script[at + opening.len()..];
        let called =
            before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != '.' && c != '$');
        Some(&inner[..inner.find('"')?]).filter(|_| called)
    })
}
