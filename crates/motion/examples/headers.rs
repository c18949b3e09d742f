//! Checks a million random tables and a million damaged headers. Run it with
//! `cargo run --release --example headers -p barrelstack-motion -- 1000000`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::format_collect,
    unreachable_pub,
    reason = "an example prints its results"
)]

#[path = "../tests/headers/mod.rs"]
mod headers;

use barrelstack_motion::Random;
use headers::{Verdict, mutated, table};

fn main() {
    let count = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1_000_000);
    for (what, mutate) in [("tables", false), ("mutations", true)] {
        let (mut right, mut refused, mut wrong) = (0_u64, 0_u64, 0_u64);
        for seed in 0..count {
            let mut random = Random::new(seed);
            let table = table(&mut random);
            let text = if mutate { mutated(&table, &mut random) } else { table.text() };
            let verdict = if mutate { table.peak_verdict(&text) } else { table.verdict(&text) };
            match verdict {
                Verdict::Right => right += 1,
                Verdict::Refused => refused += 1,
                Verdict::Wrong(why) => {
                    wrong += 1;
                    if wrong < 10 {
                        let head: String =
                            text.lines().take(12).map(|l| format!("{l}\n")).collect();
                        println!("{what} {seed}: {why}\n{head}");
                    }
                }
            }
        }
        println!(
            "{count} {what}: {right} right or with a warning, {refused} refused, {wrong} wrong"
        );
    }
}
