//! Rendering: the files of a run hold its recording, and never those of an earlier one.
#![allow(clippy::unwrap_used, reason = "a file that cannot be read fails the test")]

use std::path::Path;

use barrelstack::export::ExportError;
use barrelstack::render::{Part, RenderFolder};
use barrelstack::{Run, Scenario, Summary};

fn rocking_block() -> (Run, Summary) {
    let scenario = Scenario::builtin("rocking-block", &["run.duration=1 s".to_owned()]).unwrap();
    let run = barrelstack::run(&scenario, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    let summary = Summary::of(&run, None);
    (run, summary)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The numbers of the array `name` of a VTK file.
fn array(file: &str, name: &str) -> Vec<f64> {
    let (_, rest) = file.split_once(&format!("Name=\"{name}\"")).unwrap();
    let (_, rest) = rest.split_once('>').unwrap();
    let (numbers, _) = rest.split_once('<').unwrap();
    numbers.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

#[test]
fn the_paraview_series_holds_the_recorded_poses_and_forces() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Paraview], false).unwrap();
    // Above the rate of the frames: every frame is there once.
    let written = folder.write(&run, &summary, 1e6).unwrap();
    let frames = &run.recording.frames;
    assert_eq!(written[0].files, 2 * frames.times.len() + 2);
    let block = run.assembly.parts.iter().position(|part| part.name == "block").unwrap();
    let outline = &run.assembly.parts[block].outlines[0];
    let mut moved = 0.0_f64;
    for frame in 0..frames.times.len() {
        let read = |part: &str| {
            let name = format!("paraview/{part}-{frame:04}.vtp");
            std::fs::read_to_string(out.path().join(name)).unwrap()
        };
        let bodies = read("bodies");
        let points = array(&bodies, "points");
        let [x, z, angle] = frames.poses[frame][block];
        let (sin, cos) = angle.sin_cos();
        moved = moved.max(angle.abs());
        // The block is the last body: its outline ends the points.
        let tail = points.len() - 3 * outline.points.len();
        for (point, read) in outline.points.iter().zip(points[tail..].chunks(3)) {
            let wanted = [x + cos * point.x - sin * point.z, z + sin * point.x + cos * point.z];
            // measured 0
            assert!((read[0] - wanted[0]).abs() < 1e-12 && (read[2] - wanted[1]).abs() < 1e-12);
        }
        let total: f64 = array(&read("forces"), "force").chunks(3).map(|force| force[2]).sum();
        let recorded: f64 = frames.forces[frame].iter().map(|force| force[3].abs()).sum();
        assert!((total - recorded).abs() <= 1e-9 * recorded.max(1.0));
    }
    assert!(moved > 1e-3, "a block that stands still would prove nothing: {moved} rad");
}

#[test]
fn a_second_rendering_needs_leave_and_leaves_no_frame_of_the_first() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &Part::ALL, false).unwrap();
    folder.write(&run, &summary, 20.0).unwrap();
    let first = names(&out.path().join("frames"));
    std::fs::write(out.path().join("frames/notes.txt"), "mine").unwrap();
    let refused = RenderFolder::prepare(out.path(), &[Part::Frames], false).unwrap_err();
    assert!(
        matches!(&refused, ExportError::Occupied { file, .. } if file == "frames/frame-0001.svg")
    );
    let folder = RenderFolder::prepare(out.path(), &[Part::Frames], true).unwrap();
    let written = folder.write(&run, &summary, 5.0).unwrap();
    let second = names(&out.path().join("frames"));
    assert!(second.len() < first.len());
    assert_eq!(second.len(), written[0].files + 1);
    assert!(second.contains(&"notes.txt".to_owned()));
}

#[test]
fn the_markdown_report_names_only_files_that_are_there() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Figures], false).unwrap();
    folder.write(&run, &summary, 20.0).unwrap();
    let text = std::fs::read_to_string(out.path().join("report.md")).unwrap();
    let links: Vec<&str> =
        text.split("](figures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 4);
    let there = names(&out.path().join("figures"));
    assert!(links.iter().all(|link| there.contains(&(*link).to_owned())), "{links:?} {there:?}");
}
