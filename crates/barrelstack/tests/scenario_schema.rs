//! The JSON Schema and the reference agree with what the reader accepts.

use barrelstack::scenario::field::{Default, Field, Kind, Section};
use barrelstack::scenario::{ROOT, Scenario, builtin, reference, schema};
use serde_json::{Value, json};

/// Checks a value against the part of JSON Schema that the generator uses; an unsupported keyword
/// fails.
fn check(root: &Value, schema: &Value, value: &Value, path: &str) -> Result<(), String> {
    let fail = |what: &str| Err(format!("{path}: {value} breaks {what}"));
    for (keyword, rule) in schema.as_object().unwrap() {
        match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" | "additionalProperties" => {}
            "type" => {
                let types = rule.as_array().cloned().unwrap_or_else(|| vec![rule.clone()]);
                let is = |name: &Value| match name.as_str().unwrap() {
                    "string" => value.is_string(),
                    "integer" => value.is_i64(),
                    "number" => value.is_number(),
                    "boolean" => value.is_boolean(),
                    "array" => value.is_array(),
                    "object" => value.is_object(),
                    other => panic!("type {other}"),
                };
                if !types.iter().any(is) {
                    return fail("type");
                }
            }
            "properties" => {
                let Some(object) = value.as_object() else { continue };
                for (key, item) in object {
                    match rule.get(key) {
                        Some(schema) => check(root, schema, item, &format!("{path}.{key}"))?,
                        None => return fail(&format!("additionalProperties with `{key}`")),
                    }
                }
            }
            "items" => {
                for item in value.as_array().into_iter().flatten() {
                    check(root, rule, item, path)?;
                }
            }
            "minItems" | "maxItems" => {
                let count = value.as_array().map_or(0, Vec::len) as u64;
                let limit = rule.as_u64().unwrap();
                if (keyword == "minItems" && count < limit)
                    || (keyword == "maxItems" && count > limit)
                {
                    return fail(keyword);
                }
            }
            "anyOf" => {
                let tried: Vec<_> =
                    rule.as_array().unwrap().iter().map(|s| check(root, s, value, path)).collect();
                if !tried.iter().any(Result::is_ok) {
                    let reasons: Vec<String> = tried.into_iter().filter_map(Result::err).collect();
                    return Err(format!("{path}: no alternative: {}", reasons.join("; ")));
                }
            }
            "enum" => {
                if !rule.as_array().unwrap().contains(value) {
                    return fail("enum");
                }
            }
            "const" => {
                if rule != value {
                    return fail("const");
                }
            }
            "minimum" | "maximum" | "exclusiveMinimum" => {
                let (x, limit) = (value.as_f64().unwrap_or(f64::NAN), rule.as_f64().unwrap());
                let good = match keyword.as_str() {
                    "minimum" => x >= limit,
                    "maximum" => x <= limit,
                    _ => x > limit,
                };
                if !good {
                    return fail(keyword);
                }
            }
            "$ref" => {
                let name = rule.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                check(root, &root["$defs"][name], value, path)?;
            }
            "minLength" => {
                if value.as_str().is_some_and(str::is_empty) {
                    return fail(keyword);
                }
            }
            "pattern" => {
                if !is_quantity(value.as_str().unwrap_or("")) {
                    return fail("pattern");
                }
            }
            other => panic!("keyword {other} is not checked"),
        }
    }
    Ok(())
}

/// `true` if a text matches the one pattern of the schema, parsed by hand: a number, then anything that does not
/// continue a number.
fn is_quantity(text: &str) -> bool {
    fn digits(text: &str) -> &str {
        text.trim_start_matches(|c: char| c.is_ascii_digit())
    }
    let text = text.trim_start();
    let text = text.strip_prefix(['-', '+']).unwrap_or(text);
    let rest = digits(text);
    let rest = rest.strip_prefix('.').map_or(rest, digits);
    let number = text[..text.len() - rest.len()].contains(|c: char| c.is_ascii_digit());
    let rest = rest.strip_prefix(['e', 'E']).map_or(rest, |power| {
        let power = power.strip_prefix(['-', '+']).unwrap_or(power);
        if digits(power) == power { rest } else { digits(power) }
    });
    let unit = rest.trim_start();
    number && (unit.starts_with("1/") || unit.starts_with(|c: char| !"-+.0123456789eE".contains(c)))
}

fn as_json(text: &str) -> Value {
    let table: toml::Table = toml::from_str(text).unwrap();
    serde_json::to_value(table).unwrap()
}

#[test]
fn builtin_scenarios_satisfy_the_schema_as_written_and_as_resolved() {
    let schema = schema::json_schema();
    for name in builtin::names() {
        check(&schema, &schema, &as_json(builtin::get(name).unwrap()), name).unwrap();
        let scenario = Scenario::builtin(name, &[]).unwrap();
        check(&schema, &schema, &as_json(&scenario.to_resolved_toml()), name).unwrap();
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses_by_form() {
    let schema = schema::json_schema();
    for wrong in [
        json!({ "schema": 1, "stack": { "levles": 4 } }),
        json!({ "schema": 1, "stack": { "levels": 0 } }),
        json!({ "schema": 1, "stack": { "levels": "4" } }),
        json!({ "schema": 2 }),
        json!({ "schema": 1, "run": { "duration": 30 } }),
        json!({ "schema": 1, "run": { "duration": "30" } }),
        json!({ "schema": 1, "run": { "method": "verlet" } }),
        json!({ "schema": 1, "kind": "free", "stack": { "levels": 4 } }),
        json!({ "schema": 1, "interface": { "rack-ground": { "law": "hertz", "damping": "1 s/m" } } }),
        json!({ "schema": 1, "kind": "free", "body": [{ "position": ["0 m"] }] }),
    ] {
        assert!(check(&schema, &schema, &wrong, "").is_err(), "{wrong}");
    }
}

/// Returns every field with its section, variants included, each section once.
fn all_fields() -> Vec<(&'static Section, &'static Field)> {
    fn collect(section: &'static Section, seen: &mut Vec<&'static Section>) {
        if seen.iter().any(|known| std::ptr::eq(*known, section)) {
            return;
        }
        seen.push(section);
        for field in fields_of(section) {
            if let Some(inner) = field.kind.section() {
                collect(inner, seen);
            }
        }
    }
    fn fields_of(section: &'static Section) -> impl Iterator<Item = &'static Field> {
        let variants = section.variants.iter().flat_map(|v| v.list).flat_map(|v| v.fields);
        section.fields.iter().chain(variants)
    }
    let mut seen = Vec::new();
    collect(&ROOT, &mut seen);
    seen.into_iter()
        .flat_map(|section| fields_of(section).map(move |field| (section, field)))
        .collect()
}

#[test]
fn definitions_are_well_formed() {
    let fields = all_fields();
    assert!(fields.len() > 100, "{}", fields.len());
    for (section, field) in fields {
        let name = field.name;
        assert!(field.help.ends_with('.') && section.help.ends_with('.'), "{name}");
        if let Default::Value(text) = field.default {
            let value = as_json(&format!("v = {text}"));
            let schema = schema::json_schema();
            // The default must satisfy the schema of its own field, wherever that stands.
            assert!(finds(&schema, &schema, name, &value["v"]), "{name} = {text}");
        }
    }
    let mut names: Vec<&str> = all_fields().iter().map(|(section, _)| section.name).collect();
    names.dedup();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count, "two sections share a name: {names:?}");
    for (section, _) in all_fields() {
        let Some(variants) = &section.variants else { continue };
        let tag = section.fields.iter().find(|field| field.name == variants.tag).unwrap();
        let Kind::Choice(names) = tag.kind else { panic!("{}", tag.name) };
        let mut listed: Vec<&str> = variants.list.iter().map(|variant| variant.name).collect();
        let mut chosen = names();
        listed.sort_unstable();
        chosen.sort_unstable();
        assert_eq!(listed, chosen, "{}", section.help);
        for group in section.exclusive {
            for name in *group {
                let known = section.fields.iter().any(|field| field.name == *name)
                    || variants.list.iter().any(|v| v.fields.iter().any(|f| f.name == *name));
                assert!(known, "{name}");
            }
        }
    }
}

/// `true` if any property of this name in the schema accepts the value.
fn finds(root: &Value, schema: &Value, name: &str, value: &Value) -> bool {
    match schema {
        Value::Object(object) => {
            let here = object
                .get("properties")
                .and_then(|properties| properties.get(name))
                .is_some_and(|inner| check(root, inner, value, name).is_ok());
            here || object.values().any(|inner| finds(root, inner, name, value))
        }
        Value::Array(items) => items.iter().any(|inner| finds(root, inner, name, value)),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => false,
    }
}

#[test]
fn the_reference_names_every_field() {
    let text = reference::markdown();
    for (_, field) in all_fields() {
        assert!(text.contains(&format!("| `{}` |", field.name)), "{}", field.name);
        assert!(text.contains(field.help), "{}", field.name);
    }
    for line in text.lines() {
        assert_eq!(line, line.trim_end());
    }
}
