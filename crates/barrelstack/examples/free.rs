//! A free scene: the sliding distance of a block, against v²/(2 μ g).
#![expect(clippy::print_stdout, reason = "an example that prints its result")]

use barrelstack::Scenario;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = Scenario::builtin("sliding-block", &[])?;
    let run = scenario.run()?;
    let x = |frame: Option<&Vec<[f64; 3]>>| frame.map_or(f64::NAN, |poses| poses[1][0]);
    let frames = &run.recording.frames.poses;
    let way = x(frames.last()) - x(frames.first());
    println!("{way:.4} m; exactly {:.4} m", 1.0 / (2.0 * 0.3 * 9.80665));
    Ok(())
}
