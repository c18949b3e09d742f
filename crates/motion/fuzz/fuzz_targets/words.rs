//! Any text through the parsers of measures, components and units.

#![no_main]

use barrelstack_motion::{AccelerationUnit, Component, IntensityMeasure};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = text.parse::<IntensityMeasure>();
    let _ = text.parse::<Component>();
    let _ = text.parse::<AccelerationUnit>();
});
