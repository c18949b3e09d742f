//! Properties of the dynamics: symmetries, bits, energy balance, limits of laws, refusals.
//!
//! One program, since each would compile the physics anew.

mod common;
mod contact_laws;
mod determinism;
mod elements;
mod extruded;
mod flush;
mod friction;
mod integrators;
mod invariants;
mod masses;
mod order;
mod patches;
mod racks;
mod regimes;
mod reversal;
mod shapes;
mod solids;
mod statics;
mod straps;

/// A file beside this one that is no module of it would not be run.
#[test]
#[allow(clippy::unwrap_used, reason = "a test fails by panic")]
fn every_file_is_a_module() {
    let modules = include_str!("main.rs");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let stated = modules.contains(&format!("\nmod {name};\n"));
        assert!(name == "main" || path.is_dir() || stated, "{} is not run", path.display());
    }
}
