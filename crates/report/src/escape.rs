//! Escaping for HTML, SVG, JSON inside a script element and Markdown.

use barrelstack_columns::{number, one_line};

/// Escapes text for an HTML or SVG element or a double-quoted attribute.
///
/// Control characters that XML forbids become U+FFFD, so an SVG always parses.
pub(crate) fn html(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(c),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

/// Escapes JSON so that it cannot end the script element that contains it.
///
/// In JSON, `<` occurs only inside strings, where `\u003c` has the same meaning.
pub(crate) fn json_in_script(json: &str) -> String {
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// Escapes text for Markdown on one line, with no-break spaces between numbers and units.
pub(crate) fn markdown(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let line = number::tied(&one_line(text));
    for (at, c) in line.char_indices() {
        let opens_list = matches!(c, '+' | '-') && at == 0;
        let ends_number = matches!(c, '.' | ')')
            && at > 0
            && line[..at].bytes().all(|b| b.is_ascii_digit())
            && line[at + 1..].starts_with(' ');
        if opens_list
            || ends_number
            || matches!(c, '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '|' | '~' | '&')
        {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

/// Converts text to a name for files and anchors, with lower-case letters, digits and single
/// hyphens.
///
/// Letters outside ASCII are omitted; an empty result becomes `item`.
pub(crate) fn slug(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        if c.is_ascii_alphanumeric() {
            out.push(c.to_ascii_lowercase());
        } else if !out.is_empty() && !out.ends_with('-') {
            out.push('-');
        }
    }
    let out = out.trim_end_matches('-');
    if out.is_empty() { "item".into() } else { out.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_end_inside_json_is_defused_and_reads_back_the_same() {
        let json = serde_json::to_string("a </script><!-- & b").unwrap();
        let safe = json_in_script(&json);
        assert!(!safe.contains("</"));
        assert!(!safe.contains("<!--"));
        assert_eq!(serde_json::from_str::<String>(&safe).unwrap(), "a </script><!-- & b");
    }

    #[test]
    fn markdown_text_cannot_open_a_list_a_table_or_a_tag() {
        assert_eq!(markdown("a|b *c* <b>"), "a\\|b \\*c\\* \\<b\\>");
        assert_eq!(markdown("- x"), "\\- x");
        assert_eq!(markdown("12. x"), "12\\. x");
        assert_eq!(markdown("0.5 m"), "0.5\u{a0}m");
        assert_eq!(markdown("two\nlines"), "two lines");
    }

    #[test]
    fn slugs_are_safe_for_files_and_anchors() {
        assert_eq!(slug("../B 7: σ (kPa)"), "b-7-kpa");
        assert_eq!(slug("σ"), "item");
    }
}
