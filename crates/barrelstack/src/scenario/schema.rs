//! The JSON Schema of scenario files, made from the definition of the fields.

use serde_json::{Map, Value, json};

use super::field::{Default, Field, Kind, Range, Section};
use super::root::ROOT;

/// The schema (JSON Schema 2020-12) of a scenario file, for completion and checking in editors.
///
/// It holds names, types, choices and ranges of plain numbers. It requires no field, since `extends` and overrides may
/// supply any; ranges and dimensions of quantities, and what fields mean together, are checked by the reader alone.
pub fn json_schema() -> Value {
    let mut schema = section(&ROOT);
    let extra = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "barrelstack scenario",
    });
    if let (Value::Object(schema), Value::Object(extra)) = (&mut schema, extra) {
        schema.extend(extra);
    }
    schema
}

/// A number and a unit.
const QUANTITY: &str = r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*\S.*$";

fn section(section: &'static Section) -> Value {
    let Some(variants) = &section.variants else {
        return object(section.help, section.fields.iter());
    };
    // One alternative for each variant; a file that extends another may leave the choosing field out.
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
    let pair =
        |item: Value| json!({ "type": "array", "items": item, "minItems": 2, "maxItems": 2 });
    match kind {
        Kind::Text => json!({ "type": "string", "minLength": 1 }),
        Kind::Label => json!({ "type": ["string", "integer"] }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer(least, greatest) => {
            json!({ "type": "integer", "minimum": least, "maximum": greatest })
        }
        Kind::Number(range) => json!({ "anyOf": [number(range), quantity()] }),
        Kind::Quantity(..) => quantity(),
        Kind::WordOr(word, ..) => json!({ "anyOf": [{ "const": word }, quantity()] }),
        Kind::Unit(_) => json!({ "type": "string", "minLength": 1 }),
        Kind::Point(_) => pair(quantity()),
        Kind::Points(_) => json!({ "type": "array", "items": pair(quantity()), "minItems": 3 }),
        Kind::Pair => pair(json!({ "type": "string" })),
        Kind::TextOrFalse => json!({ "anyOf": [{ "type": "string" }, { "const": false }] }),
        Kind::Choice(names) => json!({ "enum": names() }),
        Kind::Table(inner) => section(inner),
        Kind::Tables(inner) => json!({ "type": "array", "items": section(inner) }),
        Kind::ChoiceOrTable(names, _, inner) => {
            json!({ "anyOf": [{ "enum": names() }, section(inner)] })
        }
    }
}

fn number(range: Range) -> Value {
    let least = if range.above { "exclusiveMinimum" } else { "minimum" };
    json!({ "type": "number", least: range.least, "maximum": range.greatest })
}
