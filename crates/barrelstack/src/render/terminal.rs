//! A run in a few lines of text: the final picture of the stack, and the drift of its top.

use barrelstack_report::{Characters, sparkline, terminal_picture};

use crate::assemble::PartKind;
use crate::outcome::Outcome;
use crate::report;
use crate::run::Run;

/// Draws the last frame of a run as lines of text, at most 72 columns wide. Returns no lines if the run is invalid or
/// has no frames.
pub fn final_picture(run: &Run, characters: Characters) -> Vec<String> {
    let broke_down = matches!(run.outcome, Outcome::Invalid { .. });
    match run.recording.frames.times.len().checked_sub(1) {
        Some(last) if !broke_down => terminal_picture(&report::scene(run), last, characters),
        _ => Vec::new(),
    }
}

/// Draws the displacement of the top barrels relative to the ground, while the stack stands, as a
/// line of `columns` characters.
///
/// Also returns the time (s) at the end of the line and the time (s) of the maximum. Returns `None` for a free scene
/// and for an invalid run.
pub fn drift_line(run: &Run, columns: usize, characters: Characters) -> Option<(String, [f64; 2])> {
    if matches!(run.outcome, Outcome::Invalid { .. }) {
        return None;
    }
    let recording = &run.recording;
    let until = run.fates.collapse_time().unwrap_or(f64::INFINITY);
    let count = recording.times.iter().take_while(|time| **time <= until).count();
    let mut largest = vec![0.0_f64; count];
    for body in run.assembly.of_kind(PartKind::Barrel) {
        let part = &run.assembly.parts[body];
        if part.level != Some(run.assembly.levels) {
            continue;
        }
        let channel = recording.displacement(&part.name)?;
        for (most, value) in largest.iter_mut().zip(&channel.values) {
            *most = most.max(value.abs());
        }
    }
    let (peak, highest) = largest.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if run.assembly.levels == 0 {
        return None;
    }
    let line = sparkline(&largest, *highest, columns, characters);
    Some((line, [recording.times[count - 1], recording.times[peak]]))
}
