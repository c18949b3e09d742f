//! A three-dimensional run has the recorded bits and the recorded amount of work.
//!
//! An intended change of bits requires a new `ensemble::VERSION`, since studies keep three-dimensional cases; the new
//! bits here; and an entry in CHANGELOG.md under *Results change*.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_space::run::run;

use crate::common::soft_demo;

/// Returns the FNV-1a hash of the bits of all frames.
fn hash(frames: &[Vec<[f64; 7]>]) -> u64 {
    let bytes = frames.iter().flatten().flatten().flat_map(|number| number.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[test]
fn a_collapse_in_space_has_the_bits_that_are_kept_and_is_as_much_work() {
    let changes = ["stack.view=spatial", "stack.levels=4", "run.duration='9 s'"];
    let changes = changes.map(str::to_owned);
    let run = run(&soft_demo(&changes)).unwrap();
    let fallen: Vec<&str> = run.fallen().map(|body| run.stack.parts[body].name.as_str()).collect();
    assert!(!fallen.is_empty(), "nothing falls, so impacts are not looked at");
    let work = (run.work.steps, run.work.evaluations, run.work.contact_evaluations);
    println!("{fallen:?} {work:?} {:016x}", hash(&run.frames.poses));
    // Skipped pairs do not count as evaluations; the number is half of that without skipping pairs by their true
    // distances.
    assert_eq!(work, (41_109, 41_110, 6_001_491));
    if cfg!(target_arch = "x86_64") {
        assert_eq!(hash(&run.frames.poses), 0xd017_9670_cde8_e108, "other bits: see above");
    }
}
