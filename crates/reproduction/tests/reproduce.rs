//! The page of published against ours: complete, and without comparisons that are impossible.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::LazyLock;

use barrelstack_report::{html, markdown};
use barrelstack_reproduction::{Agreement, Comparison, Motion, Reproduction, recognize, reproduce};

/// The page without the paper's record and without the studies, made once.
fn found() -> &'static Reproduction {
    static FOUND: LazyLock<Reproduction> =
        LazyLock::new(|| reproduce(None, false, &|_, _| ControlFlow::Continue(())).unwrap());
    &FOUND
}

fn row(quantity: &str) -> &'static Comparison {
    let rows = &found().comparisons;
    rows.iter().find(|row| row.quantity == quantity).unwrap_or_else(|| panic!("no row {quantity}"))
}

#[test]
fn every_number_of_the_paper_has_a_row() {
    for published in [
        "10 s",
        "2.9",
        "2 cm",
        "1.5 s",
        "2.5 s",
        "5.2 %",
        "3",
        "2 s",
        "4.5 s",
        "8.9 kN/cm, 19.0 N s/cm",
    ] {
        let rows = found().comparisons.iter().filter(|row| row.published == published);
        assert_eq!(rows.count(), 1, "{published}");
    }
}

#[test]
fn what_needs_the_papers_record_is_not_compared_without_it() {
    assert_eq!(found().motion, Motion::Bundled);
    for row in &found().comparisons {
        let six = row.quantity.starts_with("six barrels");
        // The paper states the measured parameters but no result for them.
        let unstated = row.quantity.ends_with("measured k and c")
            || row.quantity.contains("amplification defined as");
        assert_eq!(row.agreement == Agreement::NotCompared, six || unstated, "{}", row.quantity);
        if six {
            assert_eq!(row.difference, None, "{}", row.quantity);
            assert!(
                !row.ours.contains(|c: char| c.is_ascii_digit()),
                "{}: {}",
                row.quantity,
                row.ours
            );
        }
    }
    let [warning] = found().document.warnings.as_slice() else { panic!("one warning") };
    assert!(warning.contains("PEL360") && warning.contains("995"), "{warning}");
}

#[test]
fn the_benchmarks_agree() {
    for quantity in [
        "eight barrels: collapse",
        "eight barrels: first barrel falls",
        "eight barrels: second barrel falls",
        "eight barrels: drift of the top",
        "eight barrels: the top barrels fall",
        "eight barrels: what falls besides the top level",
        "eight barrels: stress amplification",
        "half scale at t* against full scale at √2 t*",
        "the test at half scale: time until both top barrels have fallen",
        "along the barrels: collapse",
    ] {
        assert_eq!(row(quantity).agreement, Agreement::Agrees, "{:?}", row(quantity));
    }
    // measured 4.78 s
    let along = row("along the barrels: time for which the stack stands");
    assert!(matches!(along.agreement, Agreement::Agrees | Agreement::InBand), "{along:?}");
}

#[test]
fn what_differs_is_said_to_differ() {
    for row in found().comparisons.iter().filter(|row| row.agreement == Agreement::Differs) {
        assert!(!row.why.is_empty(), "{row:?}");
    }
    let headline = &found().document.verdict.headline;
    let count = |agreement| found().comparisons.iter().filter(|r| r.agreement == agreement).count();
    assert!(headline.contains(&format!("{} differ", count(Agreement::Differs))), "{headline}");
}

#[test]
fn every_figure_of_the_paper_is_drawn() {
    let bundle = markdown(&found().document, "figures");
    for figure in [
        "figure-6a.svg",
        "figure-6b.svg",
        "figure-6c-upper.svg",
        "figure-6c-lower.svg",
        "figure-7a-pairs.svg",
        "figure-7a-sequence.svg",
        "figure-7b-half.svg",
        "figure-7b-full.svg",
        "figure-7c-body-2.svg",
        "figure-7c-body-3.svg",
        "along.svg",
        "along-pairs.svg",
    ] {
        let file = bundle.files.iter().find(|file| file.name == figure);
        assert!(file.is_some_and(|file| file.bytes.len() > 1000), "{figure}");
        assert!(bundle.text.contains(&format!("figures/{figure}")), "{figure}");
    }
    assert!(
        html(&found().document).contains("under the South Napa record scaled to 60 cm/s"),
        "captions must name the motion"
    );
    let drawn = bundle.files.iter().filter(|file| file.bytes.starts_with(b"<svg"));
    assert!(drawn.clone().count() >= 9);
    for file in drawn {
        let text = std::str::from_utf8(&file.bytes).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{}", file.name);
    }
    assert!(!bundle.text.contains("NaN"), "a number is missing");
}

#[test]
fn the_page_is_the_same_every_time() {
    let again = reproduce(None, false, &|_, _| ControlFlow::Continue(())).unwrap();
    assert_eq!(html(&again.document), html(&found().document));
    assert_eq!(markdown(&again.document, "figures"), markdown(&found().document, "figures"));
}

#[test]
fn a_missing_record_is_an_error_before_any_run() {
    let counted = std::sync::atomic::AtomicUsize::new(0);
    let tell = |_, _| {
        counted.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let error =
        reproduce(Some(Path::new("no/such/file.at2")), true, &tell).unwrap_err().to_string();
    assert!(error.contains("no/such/file.at2"), "{error}");
    assert_eq!(counted.into_inner(), 0);
}

#[test]
fn the_papers_record_is_told_from_its_neighbors() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/ground-motions/peer");
    if !folder.is_dir() {
        // Bypasses the test runner, which hides the output of passing tests, so that skipped tests are counted.
        let notice = format!("skipped: {} is not there\n", folder.display());
        std::io::stdout().write_all(notice.as_bytes()).unwrap();
        return;
    }
    let north = recognize(&folder.join("RSN995_NORTHR_PEL360.AT2")).unwrap();
    assert!(north.is_papers(), "{north:?}");
    let east = recognize(&folder.join("RSN995_NORTHR_PEL090.AT2")).unwrap();
    assert!(
        matches!(&east, Motion::Other { file, .. } if file == "RSN995_NORTHR_PEL090.AT2"),
        "{east:?}"
    );
}

#[test]
fn the_validation_page_says_what_the_program_finds() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/README.md");
    let text = std::fs::read_to_string(page).unwrap();
    let table = barrelstack_reproduction::table(found());
    for (row, line) in found().comparisons.iter().zip(table.lines().skip(2)) {
        // Rows that need the record need its file, too, which a fresh clone does not have; verdict and
        // reason of the others depend on the studies.
        let cells = if row.quantity.starts_with("six barrels") { 2 } else { 3 };
        let head: Vec<&str> = line.split(" | ").take(cells).collect();
        let head = head.join(" | ");
        assert!(text.contains(&head), "validation/README.md has no row {head:?}");
    }
}
