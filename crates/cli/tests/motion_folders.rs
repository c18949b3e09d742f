//! Whole folders of records: the table, refusals, repetition of changed records, and a set for a study.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::common::{barrelstack, stderr, stdout};
use barrelstack_motion::Random;

/// Runs `motion`, which must succeed, and returns standard output.
fn motion(arguments: &[&str]) -> String {
    let output = barrelstack([&["motion"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// Runs `motion`, which must be refused with these words.
fn refused(arguments: &[String], words: &str) {
    let all = std::iter::once("motion").chain(arguments.iter().map(String::as_str));
    let output = barrelstack(all);
    assert_ne!(output.status.code(), Some(0), "{arguments:?}: {}", stdout(&output));
    assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Returns a folder of `count` synthetic records of two horizontals, one text file, and a flatfile.
fn records(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let below = folder.path().join("records/below");
    fs::create_dir_all(&below).unwrap();
    let mut flatfile = "RSN,magnitude,rrup,vs30\n".to_owned();
    for k in 0..count {
        // Filtered noise of different bandwidth under an envelope.
        let motion = |seed: usize| -> Vec<f64> {
            let mut random = Random::new(seed as u64);
            let (memory, mut last) = (0.5 + 0.04 * k as f64, 0.0);
            let sample = |n: u32| {
                last = memory * last + random.normal();
                let t = 0.02 * f64::from(n);
                last * t * (-t / 3.0).exp()
            };
            (0..1500).map(sample).collect()
        };
        let (east, north) = (motion(2 * k), motion(2 * k + 1));
        let mut lines =
            "# barrelstack motion 1\n# station: S\n# event: made\n# stage: corrected\n# unit: \
                         m/s2\n# time_step: 0.02\n# channels: E az=90, N az=0\n"
                .to_owned();
        for (x, y) in east.iter().zip(&north) {
            let _ = writeln!(lines, "{x:e} {y:e}");
        }
        fs::write(below.join(format!("RSN{}_made.txt", k + 1)), lines).unwrap();
        let _ = writeln!(flatfile, "{},{},{},300", k + 1, 5.5 + 0.1 * (k % 20) as f64, 10 + k);
    }
    fs::write(folder.path().join("records/README.md"), "no record\n").unwrap();
    fs::write(folder.path().join("flat.csv"), flatfile).unwrap();
    folder
}

#[test]
fn a_folder_becomes_a_table_and_a_stopped_one_goes_on() {
    let folder = records(6);
    let (records, out) = (folder.path().join("records"), folder.path().join("out"));
    let flatfile = folder.path().join("flat.csv");
    let all = ["info", text(&records), "--out", text(&out), "--flatfile", text(&flatfile)];
    let printed = motion(&all);
    assert!(printed.starts_with("6 records measured, 1 file refused\n"), "{printed}");
    let table = fs::read_to_string(out.join("records.csv")).unwrap();
    assert_eq!(table.lines().count(), 7);
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    for column in
        ["record", "magnitude", "pga_h1 (m/s2)", "pulse_shahi_baker", "sa_rotd50_1 (m/s2)"]
    {
        assert!(head.contains(&column), "{column}");
    }
    let reasons = fs::read_to_string(out.join("refused.csv")).unwrap();
    assert!(reasons.contains("README.md") && reasons.contains("expected"), "{reasons}");
    let parquet = fs::read(out.join("records.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1"));

    // As a killed process leaves it: half of the lines, the last one truncated.
    let journal = out.join("rows.jsonl");
    let whole = fs::read_to_string(&journal).unwrap();
    let lines: Vec<&str> = whole.lines().collect();
    let cut = format!("{}\n{}", lines[..4].join("\n"), &lines[4][..100]);
    fs::write(&journal, cut).unwrap();
    fs::remove_file(out.join("records.csv")).unwrap();
    let printed = motion(&all);
    assert!(printed.contains(" of them earlier), 1 file refused"), "{printed}");
    assert_eq!(fs::read_to_string(out.join("records.csv")).unwrap(), table);
    assert_eq!(fs::read(out.join("records.parquet")).unwrap(), parquet);

    // A touched file is not repeated, a changed one is.
    let one = records.join("below/RSN1_made.txt");
    let bytes = fs::read(&one).unwrap();
    fs::write(&one, &bytes).unwrap();
    assert!(motion(&all).contains("6 of them earlier"), "{printed}");
    fs::write(&one, [&bytes[..], b"0 0\n"].concat()).unwrap();
    let printed = motion(&all);
    assert!(printed.starts_with("6 records measured (5 of them earlier)"), "{printed}");

    let other = ["info", text(&records), "--out", text(&out), "--table-periods", "1,2"];
    refused(
        &other.map(str::to_owned),
        "contains the table of another command, of the same command with other options, or of another version: give",
    );
    refused(&["info", text(&records)].map(str::to_owned), "--out DIR");

    // Files of others are not overwritten, nor is a folder shared.
    let all = all.map(str::to_owned);
    let kept = fs::read(&journal).unwrap();
    let lock = fs::File::open(&journal).unwrap();
    lock.lock().unwrap();
    refused(&all, "another command is working in");
    drop(lock);
    for foreign in ["{\"my\": \"results\"}", "{\"my\": \"results\"}\n", "my notes\n", "my notes"] {
        fs::write(&journal, foreign).unwrap();
        refused(&all, "a rows.jsonl of another program");
        assert_eq!(fs::read_to_string(&journal).unwrap(), foreign);
    }
    // A truncated head is written anew.
    fs::write(&journal, &kept[..20]).unwrap();
    assert!(motion(&all.each_ref().map(String::as_str)).starts_with("6 records measured, 1 file"));
}

/// Changes the journal of a folder by a digit or a bit. Each change is refused, and the journal left as it is, or the
/// records that it concerns are measured again.
fn damage(times: u32) -> [u32; 2] {
    let folder = records(1);
    let (records, out) = (folder.path().join("records"), folder.path().join("out"));
    let all = ["motion", "info", text(&records), "--out", text(&out)];
    assert_eq!(barrelstack(all).status.code(), Some(0));
    let tables = || {
        ["records.csv", "records.parquet", "refused.csv"]
            .map(|name| fs::read(out.join(name)).unwrap())
    };
    let (journal, whole) = (out.join("rows.jsonl"), tables());
    let bytes = fs::read(&journal).unwrap();
    let digits: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at].is_ascii_digit()).collect();
    let mut random = Random::new(5);
    let mut pick = |below: usize| {
        let at = random.bits() % below as u64;
        usize::try_from(at).unwrap()
    };
    let [mut refused, mut again] = [0, 0];
    for time in 0..times {
        let mut changed = bytes.clone();
        if time.is_multiple_of(2) {
            let digit = &mut changed[digits[pick(digits.len())]];
            *digit = b'0' + (*digit - b'0' + 1 + u8::try_from(pick(9)).unwrap()) % 10;
        } else {
            changed[pick(bytes.len())] ^= 1 << pick(8);
        }
        fs::write(&journal, &changed).unwrap();
        let output = barrelstack(all);
        if output.status.code() == Some(0) {
            assert!(tables() == whole, "{}", String::from_utf8_lossy(&changed));
            again += 1;
        } else {
            assert!(stderr(&output).contains("remove rows.jsonl there"), "{}", stderr(&output));
            assert_eq!(fs::read(&journal).unwrap(), changed);
            refused += 1;
        }
    }
    [refused, again]
}

#[test]
fn no_digit_and_no_bit_of_a_journal_changes_in_silence() {
    damage(24);
}

#[test]
#[ignore = "takes minutes: the same with a thousand changes"]
fn no_digit_and_no_bit_of_a_journal_changes_in_silence_in_a_thousand_tries() {
    let [refused, again] = damage(1000);
    assert!(refused > 100 && again > 100, "{refused} {again}");
}

#[test]
fn a_folder_is_processed_converted_and_drawn() {
    let folder = records(2);
    let records = folder.path().join("records");
    let out = |name: &str| folder.path().join(name);
    motion(&["process", text(&records), "--out", text(&out("p")), "--high-pass", "0.2 Hz"]);
    let made = fs::read_to_string(out("p").join("below/RSN1_made.txt.txt")).unwrap();
    assert!(made.contains("at 0.2000 Hz"));
    motion(&["convert", text(&records), "--out", text(&out("c")), "--form", "csv"]);
    assert!(out("c").join("below/RSN2_made.txt.csv").is_file());
    motion(&["plot", text(&records), "--out", text(&out("d"))]);
    let png = fs::read(out("d").join("below/RSN1_made.txt.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    // Missing files are made again.
    fs::remove_file(out("d").join("below/RSN1_made.txt.png")).unwrap();
    let printed = motion(&["plot", text(&records), "--out", text(&out("d"))]);
    assert!(printed.starts_with("2 records measured (1 of them earlier)"), "{printed}");
    assert!(out("d").join("below/RSN1_made.txt.png").is_file());
}

#[test]
fn a_set_for_a_target_is_a_study_that_runs() {
    let folder = records(12);
    let (records, out) = (folder.path().join("records"), folder.path().join("set"));
    let model = folder.path().join("model.csv");
    let table = "period (s), median (g), sigma\n0.1, 0.5, 0.5\n0.3, 0.5, 0.5\n1.0, 0.2, 0.6\n";
    fs::write(&model, table).unwrap();
    let flatfile = folder.path().join("flat.csv");
    let select = |out: &Path, more: &[&str]| {
        let usual = [
            "select",
            text(&records),
            "--target",
            text(&model),
            "--at",
            "1.0",
            "--epsilon",
            "1",
            "--count",
            "4",
            "--scale",
            "0.01..1000",
            "--out",
            text(out),
            "--flatfile",
            text(&flatfile),
        ];
        [&usual[..], more].concat().into_iter().map(str::to_owned).collect::<Vec<String>>()
    };
    let arguments = select(&out, &["--magnitude", "5.6..", "--distance", "..20"]);
    let printed = motion(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(printed.contains("10 of 12 records are eligible"), "{printed}");
    assert!(printed.contains("; 1 file could not be read, see refused.csv"), "{printed}");
    assert!(
        printed.contains("1 outside the limit of magnitude, 0 of unknown magnitude"),
        "{printed}"
    );
    for file in ["selection.csv", "study.toml", "index.html", "figures/spectra.svg"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let chosen = fs::read_to_string(out.join("selection.csv")).unwrap();
    assert_eq!(chosen.lines().count(), 5);
    let plan = barrelstack(["study", "plan", text(&out.join("study.toml"))]);
    assert_eq!(plan.status.code(), Some(0), "{}", stderr(&plan));
    // Four records of two horizontals each.
    assert!(stdout(&plan).contains("8 cases"), "{}", stdout(&plan));
    let again = folder.path().join("again");
    let arguments = select(&again, &["--magnitude", "5.6..", "--distance", "..20"]);
    motion(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(fs::read_to_string(again.join("selection.csv")).unwrap(), chosen);
    refused(
        &select(&folder.path().join("x"), &["--count", "400"]),
        "cannot be used multiple times",
    );
    refused(&select(&folder.path().join("y"), &["--vs30", "9..1"]), "9 is above 1");
}
