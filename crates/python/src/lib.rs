//! The Python package: what `barrelstack._native` holds.
//!
//! Here is what needs Rust: the library's types behind handles, arrays and tables without a copy, work without the
//! interpreter's lock.
//! How a person meets it, in Python's words and with its documentation, is in `python/barrelstack`.

#![allow(clippy::needless_pass_by_value, reason = "functions take what the interpreter gives")]

mod ask;
mod calibrate;
mod errors;
mod listen;
mod page;
mod record;
mod run;
mod scenario;
mod space;
mod study;
mod table;
mod value;
mod view;

/// The library for `barrelstack`, the package.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::ask::{compare, heights, protect, reproduce, score, select};
    #[pymodule_export]
    use crate::calibrate::{
        calibrate_collapse, calibrate_drop, calibrate_friction, calibrate_response,
        calibrate_stiffness,
    };
    #[pymodule_export]
    use crate::page::Page;
    #[pymodule_export]
    use crate::record::{Record, formats, group_files, measured, standard_periods};
    #[pymodule_export]
    use crate::run::{Glance, Run};
    #[pymodule_export]
    use crate::scenario::{Scenario, fields, reference, scenarios, schema};
    #[pymodule_export]
    use crate::space::SpatialRun;
    #[pymodule_export]
    use crate::study::{Study, decision, export, provenance, read_table, studies};
    #[pymodule_export]
    use crate::table::{Table, ensemble};

    #[pymodule_export]
    const PERIODS: [f64; 22] = barrelstack_selection::PERIODS;
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
