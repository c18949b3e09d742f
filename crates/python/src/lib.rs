//! The native module of the Python package, `barrelstack._native`.
//!
//! It contains the parts that need Rust: handles of library types, arrays and tables without
//! copies, and work without the interpreter lock. The public interface and its documentation are in
//! `python/barrelstack`.

#![allow(clippy::needless_pass_by_value, reason = "the interpreter passes arguments by value")]

mod analyses;
mod calibrate;
mod errors;
mod interruptible;
mod page;
mod record;
mod run;
mod scenario;
mod simulation;
mod space;
mod study;
mod table;
mod value;
mod view;

/// Native extension module of the Python package `barrelstack`.
#[pyo3::pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::analyses::{compare, heights, protect, reproduce, score, select};
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
    use crate::simulation::{Simulation, Simulations};
    #[pymodule_export]
    use crate::space::SpatialRun;
    #[pymodule_export]
    use crate::study::{Study, decision, export, provenance, read_table, studies};
    #[pymodule_export]
    use crate::table::{Table, ensemble};

    #[pymodule_export]
    const PERIODS: [f64; 22] = barrelstack_selection::PERIODS;
    /// Sets the current date, which every page states.
    #[pymodule_init]
    #[expect(clippy::unnecessary_wraps, reason = "PyO3 calls it with this type")]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        // If the date is unknown, the import does not fail, and pages state the reason.
        let _ = barrelstack::report::stamp_pages("");
        Ok(())
    }

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
