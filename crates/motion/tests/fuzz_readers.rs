//! Readers never panic, whatever the damage: mutations of every sample, and random bytes.
//!
//! The number and the seed are fixed, so that a failure can be repeated. `cargo xtask fuzz` runs
//! any number, with limits on time and memory.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use crate::fuzz;
use crate::fuzz::{Reader, must_hold, mutate, options, samples, samples_of};
use crate::large;
use barrelstack_motion::{
    AccelerationUnit, Component, Direction, FORMATS, Horizontals, IntensityMeasure, Random,
    ReadOptions, read,
};

/// Number of mutated files per sample.
const MUTATIONS: u32 = 400;

#[test]
fn every_reader_has_a_sample_to_be_damaged() {
    let samples = samples();
    for reader in Reader::all() {
        let own = samples_of(reader, &samples);
        assert!(!own.is_empty(), "{} has no sample", reader.name());
    }
    for reader in [Reader::Packed, Reader::StationXml, Reader::Flatfile] {
        for sample in samples_of(reader, &samples) {
            assert!(reader.take(&sample.bytes, &ReadOptions::default()), "{}", sample.name);
        }
    }
}

#[test]
fn samples_grow_to_large_files_that_their_readers_take() {
    // In the other formats, several blocks, a length in seconds or rising times must agree with the
    // count.
    let growing = [
        "sac",
        "esm",
        "afad",
        "miniseed",
        "barrelstack",
        "smc",
        "csmip-v1",
        "bhrc",
        "cosmos",
        "unam",
        "peer",
        "columns",
    ];
    let samples = samples();
    let given = ReadOptions {
        unit: Some(AccelerationUnit::Gal),
        time_step: Some(0.01),
        sensitivity: Some(1000.0),
        ..ReadOptions::default()
    };
    for name in growing {
        let format = FORMATS.iter().find(|format| format.name == name).unwrap();
        let most = samples_of(Reader::Format(format), &samples)
            .iter()
            .flat_map(|sample| large::sound(&sample.bytes))
            .filter_map(|bytes| format.read(&bytes, "large", &given).ok())
            .map(|record| record.channels.iter().map(|c| c.acceleration.len()).sum::<usize>())
            .max();
        // Measured: at least 71 379 values; no sample has more than 400.
        assert!(most > Some(50_000), "{name}: {most:?}");
    }
}

#[test]
fn mutated_files_never_panic_a_reader() {
    let mut random = Random::new(20_080_227);
    let samples = samples();
    let (mut done, mut refused) = (0, 0);
    for sample in &samples {
        let folder = sample.name.split('/').next().unwrap();
        let reader = Reader::all().into_iter().find(|reader| reader.name() == folder);
        for _ in 0..MUTATIONS {
            let mutated = mutate(&sample.bytes, &samples, &mut random);
            let options = options(&mut random);
            let result = read(&mutated, &sample.name, &options);
            must_hold(&result);
            if result.is_ok() {
                done += 1;
            } else {
                refused += 1;
            }
            if let Some(reader) = reader {
                reader.take(&mutated, &options);
            }
        }
    }
    println!("{done} mutated files read, {refused} refused");
    assert!(done > 100 && refused > 100);
}

#[test]
fn random_bytes_and_numbers_never_panic_a_reader() {
    let mut random = Random::new(7);
    let alphabet = b"0123456789.+-eE ,\n\t#";
    for round in 0..2000 {
        let length = usize::try_from(random.bits() % 400).unwrap();
        let bytes: Vec<u8> = (0..length)
            .map(|_| {
                let byte = random.bits().to_le_bytes()[0];
                if round % 2 == 0 { byte } else { alphabet[usize::from(byte) % alphabet.len()] }
            })
            .collect();
        let options = options(&mut random);
        must_hold(&read(&bytes, "random", &options));
        for format in FORMATS {
            must_hold(&format.read(&bytes, "random", &options));
        }
    }
}

#[test]
fn mutated_words_never_panic_a_parser() {
    let words =
        ["sa(1.0,0.02)", "d5-95", "housner(0.2)", "az:90", "#3", "cm/s2", "rotd100", "N28W"];
    let samples: Vec<fuzz::Sample> = words
        .iter()
        .map(|word| fuzz::Sample { name: (*word).to_owned(), bytes: word.as_bytes().to_vec() })
        .collect();
    let mut random = Random::new(3);
    for sample in &samples {
        for _ in 0..2000 {
            let bytes = mutate(&sample.bytes, &samples, &mut random);
            let text = String::from_utf8_lossy(&bytes);
            let measure = text.parse::<IntensityMeasure>();
            assert!(measure.is_err() || measure.is_ok_and(|measure| measure.check().is_ok()));
            let _ = text.parse::<Component>();
            let _ = text.parse::<AccelerationUnit>();
            let _ = text.parse::<Horizontals>();
            let _ = Direction::parse(&text);
        }
    }
}
