//! Results are bit-identical to the stored references, unless their version has changed.

mod common;
mod golden;

use common::skipped;
use golden::{RENEW, Table, Verdict, file};

#[test]
fn results_have_the_bits_that_are_kept_or_another_version() {
    let file = file();
    if !file.is_file() {
        let kind = std::env::consts::ARCH;
        skipped(&format!("no bits are kept for {kind}; type `{RENEW}` on one to keep them"));
        return;
    }
    let kept = std::fs::read_to_string(&file).map_err(|error| error.to_string());
    let kept = kept.and_then(|text| Table::parse(&text));
    let kept = kept.unwrap_or_else(|reason| panic!("{}: {reason}", file.display()));
    match kept.verdict(&Table::now()) {
        Verdict::Kept => {}
        Verdict::Refused(reason) | Verdict::Stale(reason) => panic!("{reason}"),
    }
}

#[test]
fn other_bits_ask_for_another_version_and_other_work_for_new_counts() {
    let text = "version 1\na 00000000000000ff 1 2 3\nb 0000000000000001 4 5 6\n";
    let table = Table::parse(text).unwrap_or_else(|reason| panic!("{reason}"));
    let same = Table::parse(&table.to_string()).unwrap_or_else(|reason| panic!("{reason}"));
    assert!(matches!(table.verdict(&same), Verdict::Kept));
    let mut bits = table.clone();
    bits.lines[1].hash = 2;
    let Verdict::Refused(reason) = table.verdict(&bits) else { panic!("other bits are kept") };
    assert!(reason.contains("raise VERSION") && reason.contains("0000000000000002"), "{reason}");
    bits.version = 2;
    assert!(matches!(table.verdict(&bits), Verdict::Stale(_)));
    let mut work = table.clone();
    work.lines[0].work.evaluations = 7;
    assert!(matches!(table.verdict(&work), Verdict::Stale(_)));
    for damaged in ["", "a 00ff 1 2 3\n", "version 1\na xyz 1 2 3\n", "version 1\na 00ff 1 2\n"] {
        assert!(Table::parse(damaged).is_err(), "{damaged}");
    }
}
