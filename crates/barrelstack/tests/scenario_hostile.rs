//! Bytes that are not a scenario, missing files, and truncated scenarios: one error, never a panic.

use std::fs;
use std::path::Path;

use barrelstack::scenario::{MotionSource, Place, Problem, RecordSource, Scenario, builtin};
use proptest::prelude::*;

fn refuse(bytes: &[u8]) -> Problem {
    Scenario::parse_bytes("bytes.toml", bytes, &[]).expect_err("accepted").problem().clone()
}

#[test]
fn bytes_that_are_not_text_are_refused() {
    assert_eq!(refuse(b"schema = 1\n\xff\xfe"), Problem::NotText { offset: 11 });
    assert_eq!(refuse(&[0x80]), Problem::NotText { offset: 0 });
    // UTF-16, as some editors save.
    let utf16: Vec<u8> = "schema = 1".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(matches!(refuse(&utf16), Problem::Syntax { .. }));
    // A picture.
    assert!(matches!(refuse(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), Problem::NotText { offset: 0 }));
    assert!(matches!(refuse(b"\0\0\0\0"), Problem::Syntax { .. }));
}

#[test]
fn a_file_as_large_as_a_record_is_refused_before_it_is_parsed() {
    let bytes = vec![b'#'; 2 << 20];
    assert!(matches!(refuse(&bytes), Problem::TooLarge { .. }));
}

#[test]
fn a_mark_of_byte_order_and_carriage_returns_are_accepted() {
    let text = builtin::get("candia-8-barrels").unwrap();
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
    let scenario = Scenario::parse("windows.toml", &windows, &[]).unwrap();
    assert_eq!(scenario, Scenario::builtin("candia-8-barrels", &[]).unwrap());
    let broken = windows.replace("levels = 4", "levles = 4");
    let error = Scenario::parse("windows.toml", &broken, &[]).unwrap_err();
    let Place::File { line, column, text, .. } = error.place() else { panic!("{error}") };
    assert_eq!((*line, *column, text.as_str()), (13, 1, "levles = 4"));
}

#[test]
fn every_truncation_of_a_scenario_is_read_or_refused() {
    for name in builtin::names() {
        let text = builtin::get(name).unwrap();
        for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
            if let Err(error) = Scenario::parse("cut.toml", &text[..end], &[]) {
                assert!(!error.sentence().is_empty());
            }
        }
    }
}

#[test]
fn every_line_left_out_is_read_or_refused() {
    for name in builtin::names() {
        let resolved = Scenario::builtin(name, &[]).unwrap().to_resolved_toml();
        for skipped in 0..resolved.lines().count() {
            let rest: Vec<&str> = resolved
                .lines()
                .enumerate()
                .filter(|(i, _)| *i != skipped)
                .map(|(_, l)| l)
                .collect();
            if let Err(error) = Scenario::parse("less.toml", &rest.join("\n"), &[]) {
                assert!(!error.to_string().contains("default value"), "{error}");
            }
        }
    }
}

#[test]
fn every_value_replaced_by_nonsense_is_refused_at_its_place() {
    let nonsense = [
        "\"\\u0000\"",
        "nan",
        "-1e999",
        "[]",
        "{}",
        "1979-05-27",
        "\"1e400 kg\"",
        "99999999999999999999",
    ];
    for name in builtin::names() {
        let resolved = Scenario::builtin(name, &[]).unwrap().to_resolved_toml();
        let lines: Vec<&str> = resolved.lines().collect();
        for (i, line) in lines.iter().enumerate() {
            let Some((key, _)) = line.split_once(" = ") else { continue };
            for value in nonsense {
                let mut changed: Vec<String> = lines.iter().map(|l| (*l).to_owned()).collect();
                changed[i] = format!("{key} = {value}");
                let result = Scenario::parse("nonsense.toml", &changed.join("\n"), &[]);
                let free_text =
                    ["title", "name", "kind", "record", "obtain", "component", "vertical"];
                if free_text.contains(&key) && result.is_ok() {
                    continue;
                }
                let error =
                    result.map(|_| ()).expect_err(&format!("{name}: {key} = {value} was accepted"));
                assert!(!error.to_string().contains('\0'), "{error}");
                // An unknown kind is first reported by the interface that uses it.
                if !["name", "kind", "between"].contains(&key) {
                    let at_line =
                        matches!(error.place(), Place::File { line, .. } if *line == i + 1);
                    let needs_other =
                        matches!(error.problem(), Problem::Missing { .. } | Problem::OneOf { .. });
                    assert!(at_line || needs_other, "{name}: {key} = {value}: {error}");
                }
            }
        }
    }
}

#[test]
fn a_file_extends_a_file_that_extends_a_builtin_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("cellar");
    fs::create_dir(&inner).unwrap();
    fs::write(
        inner.join("base.toml"),
        "schema = 1\nextends = \"candia-8-barrels\"\n[motion]\nrecord = \"records/a.at2\"\n",
    )
    .unwrap();
    let top = folder.path().join("top.toml");
    fs::write(&top, "schema = 1\nextends = \"cellar/base.toml\"\n[stack]\nlevels = 5\n").unwrap();
    let scenario = Scenario::load(&top, &[]).unwrap();
    assert_eq!(scenario.stack().unwrap().levels, 5);
    assert_eq!(scenario.title, "Ten barrels on five levels, a.at2");
    let MotionSource::Record(record) = &scenario.motion.source else { panic!() };
    let RecordSource::File(file) = &record.source else { panic!() };
    // Relative to the file that names the record, not to the one that extends it.
    assert_eq!(file.resolve(), inner.join("records/a.at2"));
    assert!(scenario.ground().unwrap_err().to_string().contains("a.at2"));

    fs::write(
        inner.join("base.toml"),
        "schema = 1\nextends = \"candia-8-barrels\"\n[run]\nstep = 3\n",
    )
    .unwrap();
    let error = Scenario::load(&top, &[]).unwrap_err();
    let Place::File { file, line: 4, column: 8, .. } = error.place() else { panic!("{error}") };
    assert!(Path::new(file).ends_with("cellar/base.toml"), "{file}");
}

#[test]
fn files_that_extend_each_other_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("snake.toml");
    fs::write(&path, "schema = 1\nextends = \"snake.toml\"\n").unwrap();
    let error = Scenario::load(&path, &[]).unwrap_err();
    assert!(error.sentence().contains("whether one of them extends itself"), "{error}");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Scenario::load(Path::new("no/such/stack.toml"), &[]).unwrap_err();
    assert!(error.sentence().contains("no/such/stack.toml"), "{error}");
    assert!(matches!(error.problem(), Problem::Unreadable { .. }));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("top.toml");
    fs::write(&path, "schema = 1\nextends = \"gone.toml\"\n").unwrap();
    let error = Scenario::load(&path, &[]).unwrap_err();
    assert!(matches!(error.place(), Place::File { line: 2, .. }), "{error}");
    assert!(error.sentence().contains("gone.toml"), "{error}");
}

#[test]
fn an_unknown_builtin_scenario_is_answered_with_the_nearest() {
    let error = Scenario::builtin("demo-nappa", &[]).unwrap_err();
    assert!(error.to_string().contains("did you mean `demo-napa`"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = Scenario::parse_bytes("bytes.toml", &bytes, &[]);
    }

    #[test]
    fn no_change_of_a_character_panics(at in any::<prop::sample::Index>(), new in any::<char>(), which in 0_usize..10) {
        let name = builtin::names().nth(which).unwrap();
        let mut chars: Vec<char> = builtin::get(name).unwrap().chars().collect();
        let at = at.index(chars.len());
        chars[at] = new;
        let text: String = chars.into_iter().collect();
        if let Err(error) = Scenario::parse("changed.toml", &text, &[]) {
            prop_assert!(!error.sentence().contains('\n'));
        }
    }

    #[test]
    fn no_override_panics(path in "[a-z.=_-]{0,20}", value in ".{0,20}", which in 0_usize..10) {
        let name = builtin::names().nth(which).unwrap();
        let _ = Scenario::builtin(name, &[format!("{path}={value}")]);
    }
}
