//! Documents for programs: every field declared once, with its unit and meaning; the JSON Schema and the
//! data dictionary are made from that.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

/// What has a JSON Schema.
pub trait Described {
    /// The schema of its values; the unit of a number is told under `unit`.
    fn schema() -> Value;
}

macro_rules! plain {
    ($($type:ty: $schema:tt),* $(,)?) => {
        $(impl Described for $type {
            fn schema() -> Value {
                json!($schema)
            }
        })*
    };
}

plain! {
    bool: { "type": "boolean" },
    f64: { "type": "number" },
    i64: { "type": "integer" },
    u32: { "type": "integer", "minimum": 0 },
    u64: { "type": "integer", "minimum": 0 },
    usize: { "type": "integer", "minimum": 0 },
    String: { "type": "string" },
    &'static str: { "type": "string" },
}

/// A value, or null.
impl<T: Described> Described for Option<T> {
    fn schema() -> Value {
        nullable(T::schema())
    }
}

impl<T: Described> Described for Vec<T> {
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema() })
    }
}

impl<T: Described, const N: usize> Described for [T; N] {
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema(), "minItems": N, "maxItems": N })
    }
}

/// Values by a name that only the document knows.
impl<T: Described> Described for BTreeMap<String, T> {
    fn schema() -> Value {
        json!({ "type": "object", "additionalProperties": T::schema() })
    }
}

fn nullable(mut schema: Value) -> Value {
    let types = match schema["type"].take() {
        Value::Array(mut types) => {
            types.push(json!("null"));
            types
        }
        one => vec![one, json!("null")],
    };
    schema["type"] = Value::Array(types);
    schema
}

/// A field of an object, as [`described!`](crate::described!) knows it.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its key.
    pub key: &'static str,
    /// What it means, as written in its comment.
    pub meaning: &'static str,
    /// Unit; none where it has none of its own.
    pub unit: Option<&'static str>,
    /// The words that it may be, where those are known.
    pub words: &'static [&'static str],
    /// How it is written: `flatten` puts its own fields in its place, `skip` leaves it out.
    pub how: Option<&'static str>,
    /// The schema of its type.
    pub schema: fn() -> Value,
}

/// The schema of an object; a field that is null may also be left out where `how` says so.
pub fn object(meaning: &str, fields: &[Field]) -> Value {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for field in fields {
        let mut schema = (field.schema)();
        match field.how {
            Some("skip") => continue,
            Some("flatten") => {
                let inner = |key: &str| schema[key].clone();
                if let (Value::Object(own), Value::Array(names)) =
                    (inner("properties"), inner("required"))
                {
                    properties.extend(own);
                    required.extend(names);
                }
                continue;
            }
            _ => {}
        }
        if !field.words.is_empty() {
            let mut words: Vec<Value> = field.words.iter().map(|word| json!(word)).collect();
            if schema["type"].is_array() {
                words.push(Value::Null);
            }
            schema["enum"] = Value::Array(words);
        }
        schema["description"] = json!(sentence(field.meaning));
        if let Some(unit) = field.unit {
            schema["unit"] = json!(unit);
        }
        properties.insert(field.key.to_owned(), schema);
        required.push(json!(field.key));
    }
    json!({
        "type": "object",
        "description": sentence(meaning),
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// A doc comment as one line.
fn sentence(comment: &str) -> String {
    comment.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The schema of a whole document under a title.
pub fn document<T: Described>(title: &str) -> Value {
    let mut schema = T::schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(title);
    schema
}

/// Every field of a schema as key, unit and meaning, by key; what is in a list has `[]` behind the key of the
/// list, what is under a free name `.*`.
pub fn dictionary(schema: &Value) -> Vec<[String; 3]> {
    let mut rows = Vec::new();
    walk(schema, "", &mut rows);
    rows
}

fn walk(schema: &Value, path: &str, rows: &mut Vec<[String; 3]>) {
    for (key, field) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let text = |key: &str| field[key].as_str().unwrap_or_default().to_owned();
        let mut meaning = text("description");
        if let Some(words) = field["enum"].as_array() {
            let words: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
            meaning = format!("{meaning} One of: {}.", words.join(", "));
        }
        rows.push([path.clone(), text("unit"), meaning]);
        walk(field, &path, rows);
    }
    if schema["items"].is_object() {
        walk(&schema["items"], &format!("{path}[]"), rows);
    }
    if schema["additionalProperties"].is_object() {
        walk(&schema["additionalProperties"], &format!("{path}.*"), rows);
    }
}

/// Declares an object of a document: a struct that is written as JSON and knows its schema.
///
/// The comment of a field is its meaning. Behind the type follow, where there are any, the unit (`as "m/s"`,
/// `as "1"` for a ratio), the words that it may be (`["a", "b"]`), and, in a struct that is made `of` something,
/// its value.
///
/// ```
/// barrelstack_report::described! {
///     /// A fall.
///     #[derive(Clone, Debug)]
///     pub struct Fall of drop: &f64 {
///         /// How far.
///         pub height: f64 as "m" = *drop,
///         /// How hard.
///         pub kind: &'static str ["soft", "hard"] = if *drop < 1.0 { "soft" } else { "hard" },
///     }
/// }
/// use barrelstack_report::described::Described as _;
/// assert_eq!(Fall::of(&2.0).kind, "hard");
/// assert_eq!(Fall::schema()["properties"]["height"]["unit"], "m");
/// ```
#[macro_export]
macro_rules! described {
    ($(
        $(#[doc = $doc:literal])+
        $(#[derive($($derive:path),* $(,)?)])?
        $vis:vis struct $name:ident $(of $from:ident: $of:ty)? {
            $(
                $(#[doc = $meaning:literal])+
                $(#[serde($how:ident)])?
                $fvis:vis $field:ident: $type:ty $(as $unit:literal)? $([$($word:literal),+ $(,)?])? $(= $value:expr)?
            ),* $(,)?
        }
    )*) => {
        $(
            $(#[doc = $doc])+
            $(#[derive($($derive),*)])?
            #[derive(serde::Serialize)]
            $vis struct $name {
                $($(#[doc = $meaning])+ $(#[serde($how)])? $fvis $field: $type),*
            }

            impl $crate::described::Described for $name {
                fn schema() -> serde_json::Value {
                    $crate::described::object(concat!($($doc),+), &[$($crate::described::Field {
                        key: stringify!($field),
                        meaning: concat!($($meaning),+),
                        unit: $crate::described!(@option $($unit)?),
                        words: &[$($($word),+)?],
                        how: $crate::described!(@name $($how)?),
                        schema: <$type as $crate::described::Described>::schema,
                    }),*])
                }
            }

            $crate::described!(@of $vis $name $(, $from, $of)? { $($field $(= $value)?),* });
        )*
    };
    (@option) => { None };
    (@option $unit:literal) => { Some($unit) };
    (@name) => { None };
    (@name $how:ident) => { Some(stringify!($how)) };
    (@of $vis:vis $name:ident { $($field:ident),* }) => {};
    (@of $vis:vis $name:ident, $from:ident, $of:ty { $($field:ident = $value:expr),* }) => {
        impl $name {
            /// What there is to say of it.
            $vis fn of($from: $of) -> Self {
                Self { $($field: $value),* }
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{Described as _, dictionary, document};

    described! {
        /// A thing.
        struct Thing {
            /// How long
            /// it is.
            length: Option<f64> as "m",
            /// Its parts.
            parts: Vec<Part>,
            /// What is never told.
            #[serde(skip)]
            hidden: bool,
        }

        /// A part.
        struct Part of name: &'static str {
            /// Its kind.
            kind: &'static str ["a", "b"] = name,
        }
    }

    #[test]
    fn a_schema_and_a_dictionary_say_what_is_written() {
        let thing = Thing { length: None, parts: vec![Part::of("a")], hidden: true };
        assert!(thing.hidden);
        let written = serde_json::to_value(thing).unwrap();
        assert_eq!(written, json!({ "length": null, "parts": [{ "kind": "a" }] }));
        let schema = document::<Thing>("thing");
        assert_eq!(schema["required"], json!(["length", "parts"]));
        assert_eq!(schema["properties"]["length"]["type"], json!(["number", "null"]));
        let rows = dictionary(&schema);
        assert_eq!(rows[0], ["length", "m", "How long it is."]);
        assert_eq!(rows[2], ["parts[].kind", "", "Its kind. One of: a, b."]);
        assert_eq!(Option::<Part>::schema()["type"], json!(["object", "null"]));
    }
}
