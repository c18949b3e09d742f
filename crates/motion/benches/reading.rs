//! Measures the speed of reading large text files and of evaluating a motion: `cargo bench -p
//! barrelstack-motion`.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a bench prints and may fail")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use barrelstack_motion::{ReadOptions, bundled, read};

/// Acceptance limit: the time (s) in which 10 MB of text must be read.
const LIMIT: f64 = 0.2;

fn peer(values: usize) -> String {
    let mut text = format!(
        "PEER NGA STRONG MOTION DATABASE RECORD\nEXAMPLE, NOWHERE, 360\n\
         ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {values}, DT= .0050 SEC\n"
    );
    for k in 0..values {
        let value = 0.3 * (0.01 * k as f64).sin();
        write!(text, "{value:15.7e}{}", if k % 5 == 4 { "\n" } else { "" }).unwrap();
    }
    text
}

fn volume1(values: usize) -> String {
    let mut text = String::new();
    let title = "UNCORRECTED ACCELEROGRAM DATA";
    for content in [
        title,
        "",
        "",
        "",
        "STATION NO. 0",
        "NOWHERE",
        "CHAN  1:  90 DEG",
        "",
        "",
        "",
        &format!("NO. OF POINTS = {values}"),
        "UNITS OF UNCOR ACCEL ARE SEC AND G.",
        "",
    ] {
        writeln!(text, "{content}").unwrap();
    }
    for _ in 0..14 {
        text.push_str("    0    0\n");
    }
    writeln!(text, "{values} Accelerogram points at 200 pts/sec in units of g. Format: (8f9.6)")
        .unwrap();
    for k in 0..values {
        let value = 0.3 * (0.01 * k as f64).sin();
        write!(text, "{value:9.6}{}", if k % 8 == 7 { "\n" } else { "" }).unwrap();
    }
    text.push_str("\n/& END OF DATA\n");
    text
}

fn columns(values: usize) -> String {
    let mut text = String::from("time (s),acceleration (m/s2)\n");
    for k in 0..values {
        let t = 0.005 * k as f64;
        writeln!(text, "{t:.3},{:.6e}", 0.3 * (2.0 * t).sin()).unwrap();
    }
    text
}

fn main() {
    for (name, text) in
        [("peer", peer(690_000)), ("csmip-v1", volume1(1_150_000)), ("columns", columns(460_000))]
    {
        let megabytes = text.len() as f64 / 1e6;
        let mut best = f64::INFINITY;
        for _ in 0..5 {
            let start = Instant::now();
            let record = read(black_box(text.as_bytes()), name, &ReadOptions::default());
            best = best.min(start.elapsed().as_secs_f64());
            black_box(record.unwrap());
        }
        let per_ten = best * 10.0 / megabytes;
        println!("{name}: {megabytes:.1} MB in {best:.3} s, {per_ten:.3} s for 10 MB");
        assert!(per_ten < LIMIT, "{name} takes {per_ten:.3} s for 10 MB, above {LIMIT} s");
    }
    let motion = bundled("napa-college-2014").unwrap().default_motion().unwrap();
    let (calls, step) = (1_000_000_u32, motion.duration / 1e6);
    let start = Instant::now();
    let mut sum = 0.0;
    for k in 0..calls {
        sum += motion.horizontal.at(step * f64::from(k)).displacement;
    }
    black_box(sum);
    println!("at(): {:.1} ns a call", start.elapsed().as_secs_f64() * 1e9 / f64::from(calls));
}
