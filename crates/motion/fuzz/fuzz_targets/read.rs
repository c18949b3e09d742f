//! Any bytes through every reader; the first byte chooses the options.

#![no_main]

use barrelstack_motion::{AccelerationUnit, ReadOptions, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((choice, bytes)) = data.split_first() else { return };
    let options = if choice % 2 == 0 {
        ReadOptions::default()
    } else {
        ReadOptions {
            unit: Some(AccelerationUnit::G),
            time_step: Some(0.01),
            sensitivity: Some(1000.0),
        }
    };
    if let Ok(record) = read(bytes, "fuzz", &options) {
        for channel in &record.channels {
            assert!(channel.time_step > 0.0);
            assert!(channel.acceleration.iter().all(|a| a.is_finite()));
        }
    }
});
