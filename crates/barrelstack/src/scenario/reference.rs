//! The reference of the scenario language in Markdown, made from the definition of the fields.

use std::fmt::Write as _;

use super::catalog;
use super::field::{Default, Field, Kind, Range, Section};
use super::quantity::plain;
use super::root::ROOT;
use super::unit;

/// Every table and field of a scenario file: kind, range, default and meaning; then the units and
/// the catalog.
pub fn markdown() -> String {
    let mut text = String::from("# Fields of a scenario file\n\n");
    text.push_str(&of_tables(&ROOT, &[]));
    text.push_str("## Units\n\n");
    let names: Vec<String> =
        unit::names().filter(|u| *u != "1").map(|u| format!("`{u}`")).collect();
    let _ = writeln!(
        text,
        "{}.\nUnits may be multiplied (`N s`), divided (`kN/cm`), raised to a power (`m^2`) and grouped (`N/(m s)`).\n",
        names.join(" ")
    );
    catalog_tables(&mut text);
    text
}

/// The tables and fields of a file whose top is a section, but for those of the sections left to another page.
pub(crate) fn of_tables(top: &'static Section, elsewhere: &[&'static str]) -> String {
    let mut text = String::new();
    let mut seen: Vec<(&str, String)> =
        elsewhere.iter().map(|name| (*name, format!("{name} of a scenario file"))).collect();
    table(&mut text, &mut seen, "", top);
    text
}

/// Writing to a `String` cannot fail, so results of `writeln!` are dropped in this file.
fn table(text: &mut String, seen: &mut Vec<(&str, String)>, path: &str, section: &'static Section) {
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
    let variants = section.variants.iter().flat_map(|v| v.list).flat_map(|v| v.fields);
    for field in section.fields.iter().chain(variants) {
        let inner_path =
            if path.is_empty() { field.name.to_owned() } else { format!("{path}.{}", field.name) };
        let Some(inner) = field.kind.section() else { continue };
        if let Some((_, first)) = seen.iter().find(|(name, _)| *name == inner.name) {
            let _ = writeln!(text, "`[{inner_path}]` has the same fields as `[{first}]`.\n");
        } else {
            seen.push((inner.name, inner_path.clone()));
            table(text, seen, &inner_path, inner);
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

fn catalog_tables(text: &mut String) {
    text.push_str("## Barrels of the catalog\n\n");
    text.push_str(
        "| name | length (m) | bilge (m) | head (m) | stave (m) | empty (kg) | volume (L) | source |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for b in catalog::BARRELS {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} | {} |",
            b.name,
            plain(b.length),
            plain(b.bilge_diameter),
            plain(b.head_diameter),
            plain(b.stave_thickness),
            plain(b.empty_mass),
            plain(1000.0 * b.capacity),
            b.source
        );
    }
    text.push_str("\n## Racks of the catalog\n\n");
    text.push_str(
        "| name | mass (kg) | barrels | pitch (m) | width (m) | rails ± (m) | clearance (m) | source |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for r in catalog::RACKS {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} by {} | {} | {} | {} | {} | {} |",
            r.name,
            r.mass,
            r.barrels,
            r.barrels_deep,
            r.pitch,
            r.width,
            r.rail_half_spacing,
            r.clearance,
            r.source
        );
    }
    text.push_str(
        "\n## Friction of the catalog\n\n| pair | coefficient | source |\n|---|---|---|\n",
    );
    for p in &catalog::PAIRS {
        let _ = writeln!(text, "| `{}` | {} | {} |", p.name, p.coefficient, p.source);
    }
    text.push_str("\n## Records shipped with the program\n\n| name | record |\n|---|---|\n");
    for (name, help) in catalog::RECORDS {
        let _ = writeln!(text, "| `{name}` | {help} |");
    }
}
