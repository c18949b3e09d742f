//! The JSON Schema of scenario files, made from the definition of the fields.

use barrelstack_input::schema::of_file;
use serde_json::Value;

use super::root::ROOT;

/// Returns the schema (JSON Schema 2020-12) of a scenario file, for completion and checking in editors.
///
/// It holds names, types, choices and ranges of plain numbers. It requires no field, since `extends` and overrides
/// may supply any; ranges and dimensions of quantities, and combinations of fields, are checked by the reader alone.
pub fn json_schema() -> Value {
    of_file("barrelstack scenario", &ROOT)
}
