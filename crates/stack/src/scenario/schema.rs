//! JSON Schema of scenario files, generated from the definitions of the fields.

use barrelstack_input::schema::of_file;
use serde_json::Value;

use super::root::ROOT;

/// Returns the schema (JSON Schema 2020-12) of a scenario file, for completion and checking in editors.
///
/// The schema has the names, types and choices of fields, and the ranges of plain numbers. The schema requires no
/// field, since `extends` and overrides may supply the value of any field. Ranges and dimensions of quantities, and
/// combinations of fields, are checked by the reader only.
pub fn json_schema() -> Value {
    of_file("barrelstack scenario", &ROOT)
}
