//! Rendering: the files of a run hold its recording, and none of an earlier one.

use std::io::Read as _;
use std::path::Path;

use barrelstack::export::{ExportError, Folder};
use barrelstack::render::{Part, RenderFolder, Rendering, drift_line, final_picture};
use barrelstack::{Run, Scenario, Summary};
use barrelstack_report::{Characters, FigureKind, Format, POSE_QUANTUM, figures};

fn rocking_block() -> (Run, Summary) {
    let scenario = Scenario::builtin("rocking-block", &["run.duration=1 s".to_owned()]).unwrap();
    let run = scenario.run().unwrap();
    let summary = Summary::of(&run, None);
    (run, summary)
}

#[test]
fn a_reader_can_add_up_the_energy_balance() {
    // At the step that is chosen, 0.4 ms, impacts of what falls leave 6e-4 of the largest part.
    let words = ["run.duration=4 s", "run.step=0.1 ms"].map(str::to_owned);
    let run = Scenario::builtin("candia-8-barrels", &words).unwrap().run().unwrap();
    let document = barrelstack::report::document(&run, &Summary::of(&run, None));
    let (_, figure) = figures(&document).into_iter().find(|(name, _)| name == "energy").unwrap();
    let FigureKind::Plot(plot) = figure.kind else { panic!("no plot") };
    let line = |label: &str| &plot.series.iter().find(|series| series.label == label).unwrap().y;
    let parts = [
        "kinetic",
        "potential",
        "stored in contacts and devices",
        "lost to friction",
        "lost to damping",
    ]
    .map(line);
    let (all, given) = (line("sum of stored and dissipated energy"), line("work of the ground"));
    let largest =
        parts.iter().flat_map(|part| part.iter()).fold(0.0_f64, |most, e| most.max(e.abs()));
    assert!(largest > 10.0, "barrels fall: {largest} kJ");
    for at in 0..all.len() {
        let sum: f64 = parts.iter().map(|part| part[at]).sum();
        assert!((sum - all[at]).abs() < 1e-9 * largest);
        // Less than a tenth of a pixel of the picture.
        let off = (all[at] - given[at]).abs() / largest;
        assert!(off < 4e-4, "{off} at sample {at}"); // measured below 1e-4
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn at_rate(rate: f64) -> Rendering {
    Rendering { rate, ..Rendering::default() }
}

/// Reads points, and the named vectors at them if a name is given, from the file alone: the array of the points, and the
/// array of that name among the point data, with as many triples as the piece states points.
fn vtk(path: &Path, vectors: Option<&str>) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let file = std::fs::read(path).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = file.windows(mark.len()).position(|part| part == mark).unwrap();
    let markup = format!("{}</VTKFile>", std::str::from_utf8(&file[..at]).unwrap());
    let arrays = &file[at + mark.len()..];
    let tree = roxmltree::Document::parse(&markup).unwrap();
    assert_eq!(tree.root_element().attribute("type"), Some("PolyData"));
    let find = |name: &str| tree.descendants().find(|node| node.has_tag_name(name)).unwrap();
    let count: usize = find("Piece").attribute("NumberOfPoints").unwrap().parse().unwrap();
    let threes = |parent: &str, name: &str| -> Vec<[f32; 3]> {
        let mut all = find(parent).children();
        let array = all.find(|node| node.attribute("Name") == Some(name)).unwrap();
        assert_eq!(array.attribute("type"), Some("Float32"));
        assert_eq!(array.attribute("NumberOfComponents"), Some("3"));
        let offset: usize = array.attribute("offset").unwrap().parse().unwrap();
        let word = |k: usize| {
            u32::from_le_bytes(arrays[offset + 4 * k..offset + 4 * k + 4].try_into().unwrap())
        };
        // An array without values has no block.
        assert_eq!(word(0), u32::from(count > 0));
        let mut bytes = Vec::new();
        if count > 0 {
            let packed = &arrays[offset + 16..offset + 16 + word(3) as usize];
            flate2::read::ZlibDecoder::new(packed).read_to_end(&mut bytes).unwrap();
            assert_eq!(word(1) as usize, bytes.len());
        }
        let numbers: Vec<f32> =
            bytes.as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect();
        assert_eq!(numbers.len(), 3 * count);
        numbers.as_chunks().0.to_vec()
    };
    let vectors = vectors.map(|name| threes("PointData", name)).unwrap_or_default();
    (threes("Points", "points"), vectors)
}

#[test]
fn the_paraview_series_holds_the_recorded_poses_and_forces() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Paraview], false).unwrap();
    // Above the rate of the frames: every frame is there once.
    let written = folder.write(&run, &summary, &at_rate(1e6)).unwrap();
    let frames = &run.recording.frames;
    assert_eq!(written[0].files, 2 * frames.times.len() + 2);
    let block = run.assembly.parts.iter().position(|part| part.name == "block").unwrap();
    let outline = &run.assembly.parts[block].outlines[0];
    let (mut moved, mut pushed) = (0.0_f64, 0.0_f64);
    for frame in 0..frames.times.len() {
        let read = |part: &str, vectors: Option<&str>| {
            vtk(&out.path().join(format!("paraview/{part}-{frame:04}.vtp")), vectors)
        };
        let (points, _) = read("bodies", None);
        let [x, z, angle] = frames.poses[frame][block];
        let (sin, cos) = angle.sin_cos();
        moved = moved.max(angle.abs());
        // The block is the last body: its outline ends the points.
        let tail = points.len() - outline.points.len();
        for (point, read) in outline.points.iter().zip(&points[tail..]) {
            let wanted = [x + cos * point.x - sin * point.z, z + sin * point.x + cos * point.z];
            let off = [f64::from(read[0]) - wanted[0], f64::from(read[2]) - wanted[1]];
            assert!(off.iter().all(|off| off.abs() < 0.51 * POSE_QUANTUM), "{off:?}");
            assert_eq!(read[1], 0.0);
        }
        let (places, forces) = read("forces", Some("force"));
        assert_eq!(forces.len(), frames.forces[frame].len());
        for (at, [x, z, fx, fz]) in frames.forces[frame].iter().enumerate() {
            // The force on the body that is pushed up, of the two in contact.
            let sign = if *fz < 0.0 { -1.0 } else { 1.0 };
            let off = [f64::from(places[at][0]) - x, f64::from(places[at][2]) - z];
            assert!(off.iter().all(|off| off.abs() < 0.51 * POSE_QUANTUM), "{off:?}");
            // Rounded to single precision.
            for (found, wanted) in forces[at].iter().zip([sign * fx, 0.0, sign * fz]) {
                assert!((f64::from(*found) - wanted).abs() <= 1e-7 * wanted.abs());
            }
            pushed = pushed.max(fz.abs());
        }
    }
    assert!(moved > 1e-3, "a block that stands still would prove nothing: {moved} rad");
    assert!(pushed > 100.0, "no force: {pushed} N");
}

#[test]
fn a_second_rendering_needs_leave_and_leaves_no_frame_of_the_first() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &Part::ALL, false).unwrap();
    folder.write(&run, &summary, &Rendering::default()).unwrap();
    let first = names(&out.path().join("frames"));
    std::fs::write(out.path().join("frames/notes.txt"), "mine").unwrap();
    let refused = RenderFolder::prepare(out.path(), &[Part::Frames], false).unwrap_err();
    assert!(
        matches!(&refused, ExportError::Occupied { file, .. } if file == "frames/frame-0001.png")
    );
    let folder = RenderFolder::prepare(out.path(), &[Part::Frames], true).unwrap();
    let written = folder.write(&run, &summary, &at_rate(5.0)).unwrap();
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
    folder.write(&run, &summary, &Rendering::default()).unwrap();
    let text = std::fs::read_to_string(out.path().join("report.md")).unwrap();
    let links: Vec<&str> =
        text.split("](figures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 4);
    let there = names(&out.path().join("figures"));
    assert!(links.iter().all(|link| there.contains(&(*link).to_owned())), "{links:?} {there:?}");
}

#[test]
fn the_index_of_the_paraview_series_names_every_file_at_its_time() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Paraview], false).unwrap();
    folder.write(&run, &summary, &at_rate(1e6)).unwrap();
    let index = std::fs::read_to_string(out.path().join("paraview/stack.pvd")).unwrap();
    let value = |line: &str, name: &str| {
        let (_, rest) = line.split_once(&format!(" {name}=\"")).unwrap();
        rest.split('"').next().unwrap().to_owned()
    };
    let rows: Vec<&str> = index.lines().filter(|line| line.starts_with("<DataSet")).collect();
    let times = &run.recording.frames.times;
    assert_eq!(rows.len(), 2 * times.len());
    for (at, row) in rows.iter().enumerate() {
        assert_eq!(value(row, "timestep").parse::<f64>().unwrap(), times[at / 2]);
        assert!(out.path().join("paraview").join(value(row, "file")).is_file());
    }
}

#[test]
fn every_figure_is_there_in_every_format_asked_for() {
    let (run, summary) = rocking_block();
    for (formats, endings) in [
        (Format::ALL.to_vec(), &["csv", "pdf", "png", "svg"][..]),
        (vec![Format::Svg, Format::Pdf], &["csv", "pdf", "svg"]),
        (vec![Format::Svg], &["csv", "svg"]),
    ] {
        let out = tempfile::tempdir().unwrap();
        let folder = RenderFolder::prepare(out.path(), &[Part::Figures], false).unwrap();
        let how = Rendering { formats, dpi: 50.0, ..Rendering::default() };
        let written = folder.write(&run, &summary, &how).unwrap();
        let there = names(&out.path().join("figures"));
        assert_eq!(written[0].files, there.len());
        let figures = there.iter().filter_map(|name| name.strip_suffix(".svg"));
        for figure in figures {
            let of = |name: &&String| name.rsplit_once('.').is_some_and(|(stem, _)| stem == figure);
            let found: Vec<&str> =
                there.iter().filter(of).filter_map(|name| name.rsplit('.').next()).collect();
            assert_eq!(found, endings, "{figure}");
        }
    }
}

#[test]
fn a_part_of_a_run_is_filmed_alone() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Frames], false).unwrap();
    let how = Rendering { between: Some([0.4, 0.7]), ..at_rate(10.0) };
    folder.write(&run, &summary, &how).unwrap();
    let times = std::fs::read_to_string(out.path().join("frames/times.csv")).unwrap();
    let times: Vec<f64> =
        times.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert!(times[0] >= 0.4 && *times.last().unwrap() <= 0.7, "{times:?}");
    assert!((3..=4).contains(&times.len()), "{times:?}");
}

#[test]
fn a_report_on_paper_is_not_overwritten_in_silence() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let folder = RenderFolder::prepare(out.path(), &[Part::Report], false).unwrap();
    let written = folder.write(&run, &summary, &Rendering::default()).unwrap();
    assert_eq!(written[0].files, 1);
    let bytes = std::fs::read(out.path().join("report.pdf")).unwrap();
    assert!(bytes.starts_with(b"%PDF-"));
    let refused = RenderFolder::prepare(out.path(), &[Part::Report], false).unwrap_err();
    assert!(matches!(&refused, ExportError::Occupied { file, .. } if file == "report.pdf"));
}

#[test]
fn a_collapsed_stack_and_its_drift_fit_a_terminal() {
    let change = ["run.stop_after_collapse=1 s".to_owned()];
    let scenario = Scenario::builtin("candia-8-barrels", &change).unwrap();
    let run = scenario.run().unwrap();
    for characters in [Characters::Unicode, Characters::Ascii] {
        let picture = final_picture(&run, characters);
        assert!((4..=16).contains(&picture.len()), "{picture:#?}");
        assert!(picture.iter().all(|line| line.chars().count() <= 72), "{picture:#?}");
        let (line, [until, peak]) = drift_line(&run, 40, characters).unwrap();
        assert_eq!(line.chars().count(), 40);
        let collapse = run.fates.collapse_time().unwrap();
        // One sample of the history, 1/200 s, may lie between.
        assert!(until <= collapse && collapse - until < 0.006, "{until} {collapse}");
        let top = if characters == Characters::Unicode { '█' } else { '#' };
        let column = line.chars().position(|c| c == top).unwrap() as f64;
        // The tallest column is that of the peak, within two columns of the first of that height.
        assert!((column - peak / until * 40.0).abs() < 6.0, "{line} {peak}");
    }
    let block = rocking_block().0;
    assert!(drift_line(&block, 40, Characters::Unicode).is_none());
    assert!(!final_picture(&block, Characters::Unicode).is_empty());
}

#[test]
fn of_two_runs_into_one_new_or_empty_folder_the_second_is_refused() {
    let place = tempfile::tempdir().unwrap();
    for name in ["new", "empty"] {
        let path = place.path().join(name);
        if name == "empty" {
            std::fs::create_dir(&path).unwrap();
        }
        let [one, other] = [0, 1].map(|_| Folder::prepare(&path, false).unwrap());
        let of = |text: &'static str| [("summary.json", text.as_bytes())];
        one.put(&of("one").iter().copied()).unwrap();
        let refused = other.put(&of("other").iter().copied()).unwrap_err();
        assert!(matches!(refused, ExportError::Occupied { .. }), "{refused}");
        // The first goes on with its own.
        one.put(&of("one").iter().copied()).unwrap();
        assert_eq!(std::fs::read(path.join("summary.json")).unwrap(), b"one");
    }
}

#[test]
fn what_a_killed_rendering_left_is_refused_and_with_leave_removed() {
    let (run, summary) = rocking_block();
    let out = tempfile::tempdir().unwrap();
    let at = |name: &str| out.path().join(name);
    // As a process leaves them that is killed within a file.
    let left = ["report.pdf.41.part", "report.md.41.part", "figures/drift.svg.41.part"];
    // Of somebody else, whatever the name resembles.
    let kept = ["notes.part", "report.pdf.part", "report.txt.41.part", "figures/mine.txt"];
    std::fs::create_dir(at("figures")).unwrap();
    for name in left.iter().chain(&kept) {
        std::fs::write(at(name), "half").unwrap();
    }
    for part in [Part::Figures, Part::Report] {
        let refused = RenderFolder::prepare(out.path(), &[part], false).unwrap_err();
        assert!(refused.to_string().contains("41.part"), "{refused}");
    }
    let parts = [Part::Figures, Part::Report];
    let folder = RenderFolder::prepare(out.path(), &parts, true).unwrap();
    folder.write(&run, &summary, &Rendering::default()).unwrap();
    assert!(left.iter().all(|name| !at(name).exists()), "{:?}", names(out.path()));
    assert!(kept.iter().all(|name| at(name).exists()), "{:?}", names(out.path()));
    assert!(std::fs::read(at("report.pdf")).unwrap().starts_with(b"%PDF-"));
}
