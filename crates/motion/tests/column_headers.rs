//! Random tables with headers of every style are read with the correct channels, units and steps,
//! or are refused. Damaged headers never change the peak without a warning.

#![allow(
    clippy::format_collect,
    reason = "a test fails by unwrap; what is shown of a failure is built as text"
)]

use crate::headers::{Verdict, mutated, table};
use barrelstack_motion::Random;

/// Number of random tables; the example `headers` runs a million.
const TABLES: u64 = 3000;
/// Number of mutated headers; the example `headers` runs a million.
const MUTATIONS: u64 = 6000;

#[test]
fn headers_of_every_style_give_the_right_record_or_a_refusal() {
    let mut read = 0;
    for seed in 0..TABLES {
        let table = table(&mut Random::new(seed));
        match table.verdict(&table.text()) {
            Verdict::Right => read += 1,
            Verdict::Refused => {}
            Verdict::Wrong(what) => {
                let text: String =
                    table.text().lines().take(12).map(|l| format!("{l}\n")).collect();
                panic!("table {seed}: {what}\n{text}");
            }
        }
    }
    // Tables that state unit and step in an unusual form may be refused; measured 3000 of 3000.
    assert!(read >= TABLES * 9 / 10, "{read} of {TABLES} are read");
}

#[test]
fn damaged_headers_do_not_change_the_peak_without_a_word() {
    for seed in 0..MUTATIONS {
        let mut random = Random::new(1_000_000 + seed);
        let table = table(&mut random);
        let text = mutated(&table, &mut random);
        if let Verdict::Wrong(what) = table.peak_verdict(&text) {
            let shown: String = text.lines().take(12).map(|l| format!("{l}\n")).collect();
            panic!("mutation {seed}: {what}\n{shown}");
        }
    }
}
