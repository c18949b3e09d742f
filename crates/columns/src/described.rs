//! Machine-readable documents: each field is declared once with its unit and meaning.
//!
//! The JSON Schema and the data dictionary are generated from the declaration.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::one_line;

/// Schemas of the objects in a document, by the names of the objects. Schemas refer to each other by these names, so an
/// object may contain objects of its own type.
pub type Objects = Map<String, Value>;

/// A type that has a JSON Schema.
pub trait Described {
    /// Returns the schema of the type, and adds to `objects` all schemas to which it refers. The
    /// unit of a number is stated under the key `unit`.
    fn schema(objects: &mut Objects) -> Value;
}

macro_rules! plain {
    ($($type:ty: $schema:tt),* $(,)?) => {
        $(impl Described for $type {
            fn schema(_: &mut Objects) -> Value {
                json!($schema)
            }
        })*
    };
}

plain! {
    bool: { "type": "boolean" },
    f64: { "type": "number" },
    u32: { "type": "integer", "minimum": 0 },
    u64: { "type": "integer", "minimum": 0 },
    usize: { "type": "integer", "minimum": 0 },
    String: { "type": "string" },
    &'static str: { "type": "string" },
}

/// A value, or null.
impl<T: Described> Described for Option<T> {
    fn schema(objects: &mut Objects) -> Value {
        let mut schema = T::schema(objects);
        if schema["type"].is_string() {
            schema["type"] = json!([schema["type"], "null"]);
            schema
        } else {
            json!({ "anyOf": [schema, { "type": "null" }] })
        }
    }
}

impl<T: Described> Described for Box<T> {
    fn schema(objects: &mut Objects) -> Value {
        T::schema(objects)
    }
}

impl<T: Described> Described for Vec<T> {
    fn schema(objects: &mut Objects) -> Value {
        json!({ "type": "array", "items": T::schema(objects) })
    }
}

impl<T: Described, const N: usize> Described for [T; N] {
    fn schema(objects: &mut Objects) -> Value {
        json!({ "type": "array", "items": T::schema(objects), "minItems": N, "maxItems": N })
    }
}

/// A map whose keys are not known in advance.
impl<K: Ord, T: Described> Described for BTreeMap<K, T> {
    fn schema(objects: &mut Objects) -> Value {
        json!({ "type": "object", "additionalProperties": T::schema(objects) })
    }
}

/// Returns a document as indented JSON text, in which negative zeros (such as the sum of an empty
/// list in Rust) are written as zero.
///
/// # Errors
/// If the document contains a map whose keys are not strings.
pub fn to_json(document: &impl Serialize) -> serde_json::Result<String> {
    let text = serde_json::to_string_pretty(document)?;
    // Only a number can end a line with `-0.0`, because a string ends with a quotation mark.
    let plain = |line: &str| match line.strip_suffix("-0.0").or_else(|| line.strip_suffix("-0.0,"))
    {
        Some(before) if before.is_empty() || before.ends_with(' ') => {
            format!("{before}{}", line[before.len()..].replacen('-', "", 1))
        }
        _ => line.to_owned(),
    };
    Ok(text.lines().map(plain).collect::<Vec<_>>().join("\n"))
}

/// A field of an object, as declared with [`described!`](crate::described!).
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Key of the field.
    pub key: &'static str,
    /// Meaning: the doc comment of the field.
    pub meaning: &'static str,
    /// Unit; `None` if the field has no unit.
    pub unit: Option<&'static str>,
    /// Permitted values of a string field; empty if any string is permitted.
    pub words: &'static [&'static str],
    /// Serialization attribute: `flatten` merges the fields of the value into the object, and `skip` omits the field.
    /// `None` if the field is serialized under its key.
    pub how: Option<&'static str>,
    /// Function that returns the schema of the type of the field.
    pub schema: fn(&mut Objects) -> Value,
}

/// Adds the schema of an object to `objects` under its name, unless this name is already present. Returns a schema that
/// refers to the schema of the object (`$ref`).
pub fn object(objects: &mut Objects, name: &str, meaning: &str, fields: &[Field]) -> Value {
    let reference = json!({ "$ref": format!("#/$defs/{name}") });
    if objects.contains_key(name) {
        return reference;
    }
    // The name is reserved first, so that an object that contains objects of its own type can refer to its schema.
    objects.insert(name.to_owned(), Value::Null);
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for field in fields.iter().filter(|field| field.how != Some("skip")) {
        let mut schema = (field.schema)(objects);
        if field.how == Some("flatten") {
            let mut inner = resolved(&schema, objects).clone();
            if let (Value::Object(own), Value::Array(names)) =
                (inner["properties"].take(), inner["required"].take())
            {
                properties.extend(own);
                required.extend(names);
            }
            continue;
        }
        if !field.words.is_empty() {
            let mut words: Vec<Value> = field.words.iter().map(|word| json!(word)).collect();
            words.extend(schema["type"].is_array().then_some(Value::Null));
            schema["enum"] = Value::Array(words);
        }
        schema["description"] = json!(one_line(field.meaning));
        if let Some(unit) = field.unit {
            schema["unit"] = json!(unit);
        }
        properties.insert(field.key.to_owned(), schema);
        required.push(json!(field.key));
    }
    let described = json!({
        "type": "object",
        "description": one_line(meaning),
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    objects.insert(name.to_owned(), described);
    reference
}

/// Resolves a reference; returns any other schema unchanged.
fn resolved<'a>(schema: &'a Value, objects: &'a Objects) -> &'a Value {
    let name = schema["$ref"].as_str().and_then(|at| at.strip_prefix("#/$defs/"));
    name.and_then(|name| objects.get(name)).unwrap_or(schema)
}

/// Returns the JSON Schema of a document, including the schemas of its objects. `title` is the title of the schema.
pub fn document<T: Described>(title: &str) -> Value {
    let mut objects = Objects::new();
    let mut schema = T::schema(&mut objects);
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!(title);
    schema["$defs"] = Value::Object(objects);
    schema
}

/// Returns the key, unit and meaning of every field of a document, given its schema from [`document`].
///
/// Fields of list items have `[]` after the key of the list; fields of maps with arbitrary keys
/// have `.*` in place of the key. An object that contains objects of its own type is listed once.
pub fn dictionary(document: &Value) -> Vec<[String; 3]> {
    let none = Objects::new();
    let mut walk = Walk {
        objects: document["$defs"].as_object().unwrap_or(&none),
        within: Vec::new(),
        rows: Vec::new(),
    };
    walk.inside(document, "");
    walk.rows
}

/// State of the traversal of a schema.
struct Walk<'a> {
    objects: &'a Objects,
    /// The objects that enclose the current position.
    within: Vec<&'a Value>,
    rows: Vec<[String; 3]>,
}

impl<'a> Walk<'a> {
    fn inside(&mut self, schema: &'a Value, path: &str) {
        for one in schema["anyOf"].as_array().into_iter().flatten() {
            self.inside(one, path);
        }
        let schema = resolved(schema, self.objects);
        if self.within.iter().any(|known| std::ptr::eq(*known, schema)) {
            return;
        }
        self.within.push(schema);
        for (key, field) in schema["properties"].as_object().into_iter().flatten() {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let text = |key: &str| field[key].as_str().unwrap_or_default().to_owned();
            let mut meaning = text("description");
            if let Some(words) = field["enum"].as_array() {
                let words: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
                meaning = format!("{meaning} One of: {}.", words.join(", "));
            }
            self.rows.push([path.clone(), text("unit"), meaning]);
            self.inside(field, &path);
        }
        if schema["items"].is_object() {
            self.inside(&schema["items"], &format!("{path}[]"));
        }
        if schema["additionalProperties"].is_object() {
            self.inside(&schema["additionalProperties"], &format!("{path}.*"));
        }
        self.within.pop();
    }
}

/// Declares an object of a document: a struct that is serialized as JSON and has a JSON Schema.
///
/// The doc comment of a field states the meaning of the field. The type may be followed by the unit
/// (`as "m/s"`, or `as "1"` for a ratio) and by the permitted values (`["a", "b"]`). A struct that is
/// declared with `of` and one or more arguments gets a function `of`, which builds the struct from these
/// arguments; each field then ends with the expression of its value.
///
/// ```
/// barrelstack_columns::described! {
///     /// A fall.
///     #[derive(Clone, Debug)]
///     pub struct Fall of drop: &f64 {
///         /// How far.
///         pub height: f64 as "m" = *drop,
///         /// How hard.
///         pub kind: &'static str ["soft", "hard"] = if *drop < 1.0 { "soft" } else { "hard" },
///     }
/// }
/// use barrelstack_columns::described::document;
/// assert_eq!(Fall::of(&2.0).kind, "hard");
/// let schema = document::<Fall>("fall");
/// assert_eq!(schema["$defs"]["Fall"]["properties"]["height"]["unit"], "m");
/// ```
#[macro_export]
macro_rules! described {
    ($(
        $(#[doc = $doc:literal])+
        $(#[derive($($derive:path),* $(,)?)])?
        $vis:vis struct $name:ident $(of $($from:ident: $of:ty),+)? {
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
                fn schema(objects: &mut $crate::described::Objects) -> serde_json::Value {
                    let fields = &[$($crate::described::Field {
                        key: stringify!($field),
                        meaning: concat!($($meaning),+),
                        unit: $crate::described!(@option $($unit)?),
                        words: &[$($($word),+)?],
                        how: $crate::described!(@name $($how)?),
                        schema: <$type as $crate::described::Described>::schema,
                    }),*];
                    let meaning = concat!($($doc),+);
                    $crate::described::object(objects, stringify!($name), meaning, fields)
                }
            }

            $crate::described!(@of $vis $name $(, $($from: $of),+)? { $($field $(= $value)?),* });
        )*
    };
    (@option) => { None };
    (@option $unit:literal) => { Some($unit) };
    (@name) => { None };
    (@name $how:ident) => { Some(stringify!($how)) };
    (@of $vis:vis $name:ident { $($field:ident),* }) => {};
    (@of $vis:vis $name:ident, $($from:ident: $of:ty),+ { $($field:ident = $value:expr),* }) => {
        impl $name {
            /// Builds the object from its arguments.
            $vis fn of($($from: $of),+) -> Self {
                Self { $($field: $value),* }
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{dictionary, document, to_json};

    described! {
        /// A thing.
        struct Thing {
            /// Length
            /// of it.
            length: Option<f64> as "m",
            /// Its parts.
            parts: Vec<Part>,
            /// Its contents.
            inner: Option<Box<Thing>>,
            /// True if the thing is hidden; not in the document.
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
    fn no_zero_has_a_sign_and_no_text_is_changed() {
        let none = Vec::<f64>::new().iter().sum::<f64>();
        assert!(none.is_sign_negative());
        let written =
            to_json(&json!({ "a": none, "b": [none, -1.0, -0.05], "c": "x -0.0" })).unwrap();
        assert!(!written.contains(": -0.0\n") && written.contains("x -0.0"), "{written}");
        let read: serde_json::Value = serde_json::from_str(&written).unwrap();
        assert!(read["a"].as_f64().unwrap().is_sign_positive(), "{written}");
        assert!(read["b"][0].as_f64().unwrap().is_sign_positive(), "{written}");
        assert_eq!(read["b"][2], json!(-0.05));
    }

    #[test]
    fn a_schema_and_a_dictionary_say_what_is_written() {
        let thing = Thing { length: None, parts: vec![Part::of("a")], inner: None, hidden: true };
        assert!(thing.hidden);
        let written = serde_json::to_value(thing).unwrap();
        assert_eq!(written, json!({ "length": null, "parts": [{ "kind": "a" }], "inner": null }));
        let schema = document::<Thing>("thing");
        let object = &schema["$defs"]["Thing"];
        assert_eq!(object["required"], json!(["length", "parts", "inner"]));
        assert_eq!(object["properties"]["length"]["type"], json!(["number", "null"]));
        let rows = dictionary(&schema);
        let row = |key: &str| rows.iter().find(|row| row[0] == key).unwrap();
        assert_eq!(row("length")[1..], ["m", "Length of it."]);
        assert_eq!(row("parts[].kind")[2], "Its kind. One of: a, b.");
        assert_eq!(rows.len(), 4);
    }
}
