//! Damaged files: truncated, with missing lines, stars and words, or with other bytes. Each is
//! refused or read with a warning.

use crate::formats::{OFFSET, SAMPLES, bytes, options};
use barrelstack_motion::{AccelerationUnit, ReadOptions, Refusal, read};

/// Returns the lines of a text file with their line endings.
fn lines(file: &str) -> Vec<Vec<u8>> {
    bytes(file).split_inclusive(|b| *b == b'\n').map(<[u8]>::to_vec).collect()
}

fn text_samples() -> Vec<&'static str> {
    SAMPLES
        .iter()
        .chain(OFFSET)
        .map(|sample| sample.0)
        .filter(|file| {
            let binary = ["sac/", "miniseed", "npz", "seed", "gse2/cm6"];
            !binary.iter().any(|binary| file.starts_with(binary))
        })
        .chain(["usc/example.y0a", "smc/uncorrected.smc"])
        .collect()
}

#[test]
fn a_file_cut_at_any_line_is_refused_or_says_so() {
    for file in text_samples() {
        // Plain columns state no count, so a truncation cannot be detected.
        if file.starts_with("columns") && file != "columns/count-first.txt"
            || file.starts_with("barrelstack")
        {
            continue;
        }
        let lines = lines(file);
        let whole = read(&bytes(file), file, &options(file)).unwrap();
        for keep in 0..lines.len() {
            let cut: Vec<u8> = lines[..keep].concat();
            if let Ok(record) = read(&cut, file, &options(file)) {
                let complete = record.channels.len() <= whole.channels.len()
                    && record
                        .channels
                        .iter()
                        .zip(&whole.channels)
                        .all(|(a, b)| a.acceleration.len() == b.acceleration.len());
                let warned = record.warnings.len() > whole.warnings.len()
                    || record.warnings.iter().any(|w| w.message.contains("states"));
                assert!(complete || warned, "{file} cut after line {keep} was read in silence");
            }
        }
    }
}

#[test]
fn stars_words_and_huge_numbers_are_refused_with_their_place() {
    // Files with pairs of time and value have no line of values alone; they are damaged elsewhere.
    for file in text_samples().into_iter().filter(|file| *file != "timeseries/tspair.txt") {
        let lines = lines(file);
        // Damage the first number of a line near the end of the data.
        let numeric: Vec<usize> = (0..lines.len())
            .filter(|&k| {
                let text = lines[k].trim_ascii();
                !text.is_empty() && text.iter().all(|b| b"0123456789.+-Ee, \t".contains(b))
            })
            .collect();
        let target = numeric[numeric.len() - 4];
        let line = String::from_utf8_lossy(&lines[target]).into_owned();
        let start = line.find(|c: char| c.is_ascii_digit() || "+-.".contains(c)).unwrap();
        let body = line.as_bytes();
        let mut end = start + 1;
        while end < body.len()
            && (matches!(body[end], b'0'..=b'9' | b'.' | b'E' | b'e')
                || (matches!(body[end], b'+' | b'-') && matches!(body[end - 1], b'E' | b'e')))
        {
            end += 1;
        }
        let width = end - start;
        for (damage, found) in [
            ("*".repeat(width), "*"),
            (format!("{:>width$}", "NaN"), "NaN"),
            (format!("{:>width$}", "9E99"), "9e99"),
        ] {
            if damage.len() > width {
                continue;
            }
            let damaged = format!("{}{damage}{}", &line[..start], &line[end..]);
            let mut all = lines.clone();
            all[target] = damaged.into_bytes();
            let Err(error) = read(&all.concat(), file, &options(file)) else {
                panic!("{file}: {found} on line {} was read", target + 1)
            };
            assert_eq!(error.refusal, Refusal::Damaged, "{error}");
            assert_eq!(error.line, Some(target + 1), "{error}");
            assert!(error.column.is_some(), "{error}");
            let message = error.to_string().to_lowercase();
            assert!(message.contains(&found.to_lowercase()), "{error}");
        }
    }
}

#[test]
fn a_lost_line_and_a_wrong_count_are_refused() {
    for file in text_samples() {
        if file.starts_with("columns") && file != "columns/count-first.txt"
            || file.starts_with("barrelstack")
        {
            continue;
        }
        let lines = lines(file);
        let target = lines.len() * 3 / 4;
        let mut all = lines.clone();
        all.remove(target);
        let whole = read(&bytes(file), file, &options(file)).unwrap();
        match read(&all.concat(), file, &options(file)) {
            Err(_) => {}
            Ok(record) => assert!(
                record.warnings.len() > whole.warnings.len()
                    || record.warnings.iter().any(|w| w.message.contains("states")),
                "{file}: line {} was lost in silence",
                target + 1
            ),
        }
    }
}

#[test]
fn binary_garbage_is_refused() {
    let garbage: Vec<u8> =
        (0..5000_u32).map(|k| k.wrapping_mul(2_654_435_761).to_le_bytes()[2]).collect();
    let error = read(&garbage, "garbage", &ReadOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("an unknown format that begins with 00 37 6E A6"),
        "{error}"
    );
    assert!(read(b"", "empty", &ReadOptions::default()).is_err());
    assert!(read(b"\x89HDF\r\n\x1a\n....", "x.h5", &ReadOptions::default()).is_err());
    for file in ["sac/little.sac", "miniseed/steim2.mseed"] {
        let all = bytes(file);
        for keep in [100, 500, all.len() - 1, all.len() - 4] {
            assert!(read(&all[..keep], file, &options(file)).is_err(), "{file} {keep}");
        }
    }
}

#[test]
fn a_count_that_the_values_contradict_is_refused_with_both_numbers() {
    let of = |file: &str| String::from_utf8(bytes(file)).unwrap();
    let csmnc = of("csmnc/example.dat")
        .replace("POINTS:   103", "POINTS:    80")
        .replace("DURATION:  1.03", "DURATION:  0.80");
    let esm = of("esm/example.ACC.ASC").replace("NDATA: 103", "NDATA: 80");
    let bbp = of("bbp/example.000").replacen("103  1.0", "80  1.0", 1);
    for (text, file) in [(csmnc, "a.dat"), (esm, "b.ASC"), (bbp, "c.000")] {
        let given = ReadOptions { unit: Some(AccelerationUnit::Gal), ..ReadOptions::default() };
        let error = read(text.as_bytes(), file, &given).unwrap_err();
        assert_eq!(error.refusal, Refusal::Damaged, "{file}: {error}");
        for number in ["80", "103"] {
            assert!(error.to_string().contains(number), "{file}: {error}");
        }
    }
}
