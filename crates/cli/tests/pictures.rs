//! Figures, films and pictures in the terminal, end to end.

use std::fs;

use crate::common::{barrelstack, names, refused, stderr, stdout};

/// A stack that collapses before its end, in a fraction of a second.
const FALLEN: [&str; 4] =
    ["run", "candia-8-barrels", "--set=run.stop_after_collapse=0.8 s", "--variants=0"];

/// A short run.
const BLOCK: [&str; 4] = ["render", "rocking-block", "--set=run.duration=0.5 s", "--quiet"];

/// Returns the lines of the picture in a summary.
fn picture(text: &str) -> Vec<&str> {
    text.lines().skip_while(|line| !line.starts_with("  at the end, ")).skip(1).collect()
}

#[test]
fn the_summary_draws_the_stack_and_its_drift_in_eighty_columns() {
    for (plain, full) in [(false, '█'), (true, '#')] {
        let output = barrelstack(FALLEN.into_iter().chain(plain.then_some("--plain")));
        assert_eq!(stderr(&output), "");
        let text = stdout(&output);
        let drawn = picture(&text);
        assert!(drawn.len() > 5, "{text}");
        let drift = text.lines().find(|line| line.starts_with("    while it stood ")).unwrap();
        assert!(drift.contains(full) && drift.ends_with(" 1.4 s"), "{drift}");
        for line in drawn.iter().chain([&drift]) {
            assert!(line.chars().count() <= 80, "{line}");
            assert!(!plain || line.is_ascii(), "{line}");
        }
    }
}

#[test]
fn render_writes_every_part_and_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("pictures");
    let output = barrelstack(BLOCK.into_iter().chain(["--dpi=60", "--out", out.to_str().unwrap()]));
    assert_eq!(stderr(&output), "");
    let parts = ["figures", "report.pdf", "animation", "frames", "paraview"];
    let printed = stdout(&output);
    for part in parts {
        assert!(printed.contains(out.join(part).to_str().unwrap()), "{part}: {printed}");
    }
    let animation = out.join("animation");
    assert_eq!(names(&animation).unwrap(), ["stack.gif", "stack.png"]);
    assert!(fs::read(animation.join("stack.gif")).unwrap().starts_with(b"GIF89a"));
    assert!(fs::read(out.join("report.pdf")).unwrap().starts_with(b"%PDF-"));
    assert!(out.join("frames/frame-0001.png").is_file());
}

#[test]
fn render_refuses_what_it_cannot_mean() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("pictures");
    for (option, words) in [
        ("--dpi=5", &["--dpi", "from 20 to 1200"][..]),
        ("--rate=0", &["--rate", "above 0"]),
        ("--size=9", &["--size", "64"]),
        ("--format=bmp", &["--format", "svg, png, pdf"]),
        ("--to=-1", &["--to", "above 0"]),
    ] {
        let output = barrelstack(BLOCK.into_iter().chain([option, "--out", out.to_str().unwrap()]));
        refused(option, &output, &out, words);
    }
    let late = barrelstack(BLOCK.into_iter().chain(["--from=3", "--out", out.to_str().unwrap()]));
    refused("--from", &late, &out, &["after 3 s", "the run ends at 0.50 s"]);
}

#[test]
fn a_run_writes_its_report_on_paper_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let place = out.to_str().unwrap();
    let short = ["run", "rocking-block", "--set=run.duration=0.5 s"];
    let alone = barrelstack(short.into_iter().chain(["--pdf"]));
    refused("--pdf alone", &alone, &out, &["--out"]);
    let output = barrelstack(short.into_iter().chain(["--out", place, "--pdf", "--paper=letter"]));
    assert!(stdout(&output).contains("and report.pdf beside it"), "{}", stdout(&output));
    let pdf = fs::read(out.join("report.pdf")).unwrap();
    assert!(pdf.windows(13).any(|text| text == b"[0 0 612 792]"), "letter paper");
}

/// Returns the number of pages of a PDF.
fn sheets(pdf: &[u8]) -> usize {
    let leaf =
        |text: &&[u8]| text.starts_with(b"/Type /Page\n") || text.starts_with(b"/Type /Page/");
    pdf.windows(12).filter(leaf).count()
}

#[test]
fn a_report_on_paper_has_at_most_twelve_pages() {
    let folder = tempfile::tempdir().unwrap();
    for (name, changes) in [
        ("candia-8-barrels", &["--variants=8"][..]),
        ("candia-8-barrels-longitudinal", &["--variants=8"]),
        // Both planes, with the changes that were tried.
        ("demo-napa", &["--variants=8"]),
        ("demo-napa", &["--variants=0", "--set=stack.view=spatial", "--set=run.duration=10 s"]),
        ("tumbling-block", &[]),
    ] {
        let out = folder.path().join(format!("{name}-{}", changes.len()));
        let place = ["--quiet", "--pdf", "--out", out.to_str().unwrap()];
        let output =
            barrelstack(["run", name].into_iter().chain(changes.iter().copied()).chain(place));
        assert_eq!(stderr(&output), "");
        let pages = sheets(&fs::read(out.join("report.pdf")).unwrap());
        // Measured: 8, 8, 11 and 8 for the stacks.
        assert!((2..=12).contains(&pages), "{name} {changes:?}: {pages} pages");
        // What paper leaves out is on the page.
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("): see the HTML page of this report."));
    }
}
