//! Froude similitude with a length scale that is a power of four changes only the exponents of floating-point numbers,
//! so runs at both scales agree bit for bit.

use barrelstack::{Run, Scenario};

#[expect(clippy::unwrap_used, reason = "a built-in scenario runs")]
fn run_of(name: &str, overrides: &[&str]) -> Run {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let scenario = Scenario::builtin(name, &overrides).unwrap();
    scenario.run().unwrap()
}

/// Lengths scale by 4 and times by 2, bit for bit: every factor is a power of two.
fn assert_four_times_the_size(name: &str, overrides: &[&str]) {
    let full = run_of(name, overrides);
    let large = run_of(name, &[overrides, &["run.similitude=4"]].concat());
    let (small_frames, large_frames) = (&full.recording.frames, &large.recording.frames);
    assert_eq!(small_frames.times.len(), large_frames.times.len());
    assert!(small_frames.times.len() > 50, "too short a run to mean anything");
    for (k, (a, b)) in small_frames.poses.iter().zip(&large_frames.poses).enumerate() {
        assert_eq!((2.0 * small_frames.times[k]).to_bits(), large_frames.times[k].to_bits());
        for (p, q) in a.iter().zip(b) {
            let same = (4.0 * p[0]).to_bits() == q[0].to_bits()
                && (4.0 * p[1]).to_bits() == q[1].to_bits()
                && p[2].to_bits() == q[2].to_bits();
            assert!(same, "{name}, frame {k}: {p:?} against {q:?}");
        }
    }
    assert_eq!(full.work.steps, large.work.steps);
}

#[test]
fn a_free_scene_four_times_the_size_agrees_bit_for_bit() {
    for name in ["rocking-block", "bouncing-disc", "rolling-disc", "sliding-block"] {
        assert_four_times_the_size(name, &[]);
    }
}

#[test]
fn a_collapsing_stack_four_times_the_size_agrees_bit_for_bit() {
    assert_four_times_the_size("candia-8-barrels", &["run.duration=2.5 s"]);
}
