//! Generates the JSON Schema of an input file from the definition of its fields.

use serde_json::{Map, Value, json};

use crate::field::{Default, Field, Kind, Range, Section};

/// Returns the JSON Schema (2020-12) of a file with the given top-level section, for completion and
/// checking in editors.
///
/// The schema contains names, types, choices and ranges of plain numbers. No field is required,
/// since other files and overrides may supply any field. Ranges and dimensions of quantities, and
/// consistency between fields, are checked only by the reader.
pub fn of_file(title: &str, top: &'static Section) -> Value {
    let mut sections = Map::new();
    collect(&mut sections, top);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        "$ref": reference(top),
        "$defs": sections,
    })
}

/// Pattern of a number and a unit. No unit starts with a digit, except for `1/s`.
const QUANTITY: &str =
    r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?(\s*[^-+.0-9eE\s].*|\s+1/.*)$";

fn reference(section: &Section) -> String {
    format!("#/$defs/{}", section.name)
}

/// Adds a section and all nested sections to the schema.
fn collect(sections: &mut Map<String, Value>, outer: &'static Section) {
    if sections.contains_key(outer.name) {
        return;
    }
    sections.insert(outer.name.to_owned(), section(outer));
    for inner in outer.all_fields().filter_map(|field| field.kind.section()) {
        collect(sections, inner);
    }
}

fn section(section: &'static Section) -> Value {
    let Some(variants) = &section.variants else {
        return object(section.help, section.fields.iter());
    };
    // There is one alternative per variant. The tag field is not required, because a file that
    // extends another may omit it.
    let alternatives: Vec<Value> = variants
        .list
        .iter()
        .map(|variant| {
            let mut alternative = object(variant.help, section.fields_of(Some(variant)));
            alternative["properties"][variants.tag] = json!({ "const": variant.name });
            alternative
        })
        .collect();
    json!({ "description": section.help, "anyOf": alternatives })
}

fn object(help: &str, fields: impl Iterator<Item = &'static Field>) -> Value {
    let properties: Map<String, Value> =
        fields.map(|field| (field.name.to_owned(), property(field))).collect();
    json!({
        "description": help,
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    })
}

fn property(field: &Field) -> Value {
    let mut schema = kind(field.kind);
    let note = match field.default {
        Default::Required | Default::Nothing => String::new(),
        Default::Derived(words) => format!(" Default: {words}."),
        Default::Value(text) => format!(" Default: {}.", text.trim_matches('"')),
    };
    schema["description"] = format!("{}{note}", field.help).into();
    schema
}

fn kind(kind: Kind) -> Value {
    let quantity = || json!({ "type": "string", "pattern": QUANTITY });
    let single = || json!({ "type": ["string", "number", "boolean"] });
    let some = |count: u32, item: Value| json!({ "type": "array", "items": item, "minItems": count, "maxItems": count });
    let pair = |item| some(2, item);
    match kind {
        Kind::Text | Kind::Unit(_) => json!({ "type": "string", "minLength": 1 }),
        Kind::Label => json!({ "type": ["string", "integer"] }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer(least, greatest) => {
            json!({ "type": "integer", "minimum": least, "maximum": greatest })
        }
        Kind::Number(range) => json!({ "anyOf": [number(range), quantity()] }),
        Kind::Quantity(..) => quantity(),
        Kind::WordOr(word, ..) => json!({ "anyOf": [{ "const": word }, quantity()] }),
        Kind::Point(_) => pair(quantity()),
        Kind::Triple(_) => some(3, quantity()),
        Kind::Points(_) => json!({ "type": "array", "items": pair(quantity()), "minItems": 3 }),
        Kind::Pair => pair(json!({ "type": "string" })),
        Kind::TextOrFalse => json!({ "anyOf": [{ "type": "string" }, { "const": false }] }),
        Kind::Texts => json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 }),
        Kind::Value => single(),
        Kind::Values => json!({ "type": "array", "items": single(), "minItems": 1 }),
        Kind::Choice(names) => json!({ "enum": names() }),
        Kind::Table(inner) => json!({ "$ref": reference(inner) }),
        Kind::Tables(inner) => json!({ "type": "array", "items": { "$ref": reference(inner) } }),
        Kind::ChoiceOrTable(names, _, inner) => {
            json!({ "anyOf": [{ "enum": names() }, { "$ref": reference(inner) }] })
        }
    }
}

fn number(range: Range) -> Value {
    let least = if range.above { "exclusiveMinimum" } else { "minimum" };
    json!({ "type": "number", least: range.least, "maximum": range.greatest })
}
