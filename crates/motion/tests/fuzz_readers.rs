//! Readers never panic, whatever is done to a file: mutations of every sample, and random bytes.
//!
//! A fixed count from a fixed seed, so that a failure repeats; `fuzz/` holds the open-ended targets.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test fails by unwrap and tells by print"
)]

use std::path::Path;

use barrelstack_motion::{AccelerationUnit, ReadOptions, read};

/// Mutated files to a sample.
const MUTATIONS: u32 = 400;

/// A small generator of our own (splitmix64), so that the harness has no dependency.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        if n == 0 { 0 } else { usize::try_from(self.next() % n as u64).unwrap() }
    }
}

fn samples() -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push((path.display().to_string(), std::fs::read(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

fn mutate(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=random.below(4) {
        if out.is_empty() {
            break;
        }
        let at = random.below(out.len());
        match random.below(9) {
            0 => out[at] = u8::try_from(random.below(256)).unwrap(),
            1 => out.truncate(at),
            2 => {
                let end = (at + random.below(200)).min(out.len());
                out.drain(at..end);
            }
            3 => {
                let end = (at + random.below(200)).min(out.len());
                let piece = out[at..end].to_vec();
                let to = random.below(out.len());
                out.splice(to..to, piece);
            }
            4 => out[at] = b"0123456789"[random.below(10)],
            5 => {
                let words: [&[u8]; 12] = [
                    b"*******",
                    b"NaN",
                    b"-999",
                    b"1e308",
                    b"99999999",
                    b"\n",
                    b"\r\n",
                    b"0",
                    b"-0",
                    b"  ",
                    b"\xff",
                    b"(",
                ];
                let word = words[random.below(words.len())];
                let end = (at + word.len()).min(out.len());
                out.splice(at..end, word.iter().copied());
            }
            6 => {
                for byte in &mut out {
                    if *byte == b'\n' {
                        *byte = b'\r';
                    }
                }
            }
            7 => {
                // A digit of the header, where the counts are.
                let head = out.len().min(3000);
                let digits: Vec<usize> = (0..head).filter(|&k| out[k].is_ascii_digit()).collect();
                if !digits.is_empty() {
                    out[digits[random.below(digits.len())]] = b"0123456789"[random.below(10)];
                }
            }
            _ => {
                let other = random.below(out.len());
                out.swap(at, other);
            }
        }
    }
    out
}

/// Whatever is read must be usable: finite samples, a step above zero, two samples or more.
fn try_read(name: &str, bytes: &[u8]) -> bool {
    let given = [
        ReadOptions::default(),
        ReadOptions {
            unit: Some(AccelerationUnit::G),
            time_step: Some(0.01),
            sensitivity: Some(1000.0),
        },
    ];
    let mut any = false;
    for options in given {
        match read(bytes, name, &options) {
            Ok(record) => {
                any = true;
                assert!(!record.channels.is_empty());
                for channel in &record.channels {
                    assert!(channel.time_step > 0.0 && channel.time_step.is_finite());
                    assert!(channel.acceleration.len() >= 2);
                    assert!(channel.acceleration.iter().all(|a| a.is_finite()));
                }
            }
            Err(error) => {
                let text = error.to_string();
                assert!(!text.is_empty() && !text.ends_with('.'), "{text}");
                assert!(!error.found.is_empty() && !error.remedy.is_empty(), "{text}");
            }
        }
    }
    any
}

#[test]
fn mutated_files_never_panic_a_reader() {
    let mut random = Random(20_080_227);
    let (mut read, mut refused) = (0, 0);
    for (name, bytes) in samples() {
        for _ in 0..MUTATIONS {
            let mutated = mutate(&bytes, &mut random);
            if try_read(&name, &mutated) {
                read += 1;
            } else {
                refused += 1;
            }
        }
    }
    println!("{read} mutated files read, {refused} refused");
    assert!(read > 100 && refused > 100);
}

#[test]
fn random_bytes_never_panic_a_reader() {
    let mut random = Random(7);
    for _ in 0..2000 {
        let length = random.below(400);
        let bytes: Vec<u8> =
            (0..length).map(|_| u8::try_from(random.next() & 0xff).unwrap()).collect();
        try_read("random", &bytes);
    }
}

#[test]
fn random_numbers_never_panic_a_reader() {
    let mut random = Random(11);
    let alphabet = b"0123456789.+-eE ,\n\t#";
    for _ in 0..2000 {
        let length = random.below(400);
        let bytes: Vec<u8> = (0..length).map(|_| alphabet[random.below(alphabet.len())]).collect();
        try_read("numbers", &bytes);
    }
}
