//! Generates reference documentation for a kind of input file, in Markdown, from the definition of its fields.

use std::fmt::Write as _;

use crate::field::{Default, Field, Kind, Range, Section};
use crate::unit;

/// Returns reference documentation for files with the top-level section `top`.
///
/// The sections named in `elsewhere` are documented on another page. In place of their fields, the
/// documentation contains a sentence that ends in `there`: "`[…]` has the same fields as …".
pub fn of_tables(top: &'static Section, elsewhere: &[&'static str], there: &str) -> String {
    let mut text = String::new();
    let mut documented: Vec<(&str, String)> =
        elsewhere.iter().map(|name| (*name, there.to_owned())).collect();
    table(&mut text, &mut documented, "", top);
    text
}

/// Writes one table and its nested tables. Writing to a `String` cannot fail, so the results of
/// `writeln!` are ignored in this file.
fn table(
    text: &mut String,
    documented: &mut Vec<(&str, String)>,
    path: &str,
    section: &'static Section,
) {
    let heading =
        if path.is_empty() { "Top of the file".to_owned() } else { format!("`[{path}]`") };
    let _ = writeln!(text, "## {heading}\n\n{}\n", section.help);
    rows(text, section.fields.iter());
    for group in section.exclusive {
        let names: Vec<String> = group.iter().map(|name| format!("`{name}`")).collect();
        let _ = writeln!(text, "At most one of {}.", names.join(", "));
    }
    if !section.exclusive.is_empty() {
        text.push('\n');
    }
    for variant in section.variants.iter().flat_map(|v| v.list) {
        let tag = section.variants.as_ref().map_or("", |v| v.tag);
        let _ = writeln!(text, "With `{tag} = \"{}\"`: {}\n", variant.name, variant.help);
        if !variant.fields.is_empty() {
            rows(text, variant.fields.iter());
        }
    }
    for field in section.all_fields() {
        let inner_path =
            if path.is_empty() { field.name.to_owned() } else { format!("{path}.{}", field.name) };
        let Some(inner) = field.kind.section() else { continue };
        if let Some((_, first)) = documented.iter().find(|(name, _)| *name == inner.name) {
            let _ = writeln!(text, "`[{inner_path}]` has the same fields as {first}.\n");
        } else {
            documented.push((inner.name, format!("`[{inner_path}]`")));
            table(text, documented, &inner_path, inner);
        }
    }
}

fn rows(text: &mut String, fields: impl Iterator<Item = &'static Field>) {
    text.push_str("| field | holds | default | meaning |\n|---|---|---|---|\n");
    for field in fields {
        let default = match field.default {
            Default::Required => "required".to_owned(),
            Default::Nothing => "none".to_owned(),
            Default::Derived(words) => words.to_owned(),
            Default::Value(value) => format!("`{}`", value.trim_matches('"')),
        };
        let _ = writeln!(
            text,
            "| `{}` | {} | {default} | {} |",
            field.name,
            holds(field.kind).replace('|', "\\|"),
            field.help
        );
    }
    text.push('\n');
}

fn holds(kind: Kind) -> String {
    let ranged = |range: Range, unit: &str| {
        if range == Range::ANY {
            kind.to_string()
        } else {
            format!("{kind}, {}", range.describe(unit))
        }
    };
    if let Kind::Number(range) = kind {
        return ranged(range, "");
    }
    if let Kind::Quantity([dimension], range) | Kind::WordOr(_, [dimension], range) = kind {
        return ranged(range, &dimension.si_unit());
    }
    if let Kind::Choice(names) = kind {
        return format!("one of {}", quoted(&names()));
    }
    if let Kind::ChoiceOrTable(names, ..) = kind {
        return format!("one of {}, or a table", quoted(&names()));
    }
    kind.to_string()
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Lists all units and explains how they are combined.
pub fn units() -> String {
    let names: Vec<String> =
        unit::names().filter(|u| *u != "1").map(|u| format!("`{u}`")).collect();
    format!(
        "{}.\nUnits may be multiplied (`N s`), divided (`kN/cm`), raised to a power (`m^2`) and grouped (`N/(m s)`).\n\n",
        names.join(" ")
    )
}
