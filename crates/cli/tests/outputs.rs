//! Outputs of every command: nothing that was read is replaced, nothing is lost without an error, and a full disk leaves
//! no part of a file.
#![cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
#![allow(clippy::print_stdout, reason = "the table of links is read with --nocapture")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::common::{HEAD, STUDY, barrelstack, names, program, stderr, stdout};

/// Commands that write, with OUT for where, beside the inputs that [`place`] makes.
const WRITERS: [&[&str]; 19] = [
    &["run", "rocking-block", "--set=run.duration=1 s", "--pdf", "--out", "OUT"],
    &["run", "rolling-ball", "--set=run.duration=0.2 s", "--out", "OUT"],
    &["demo", "--variants=0", "--no-remedy", "--set=run.duration=0.5 s", "--out", "OUT"],
    &["compare", "rocking-block", "sliding-block", "--set=run.duration=1 s", "--out", "OUT"],
    &["render", "rocking-block", "--set=run.duration=1 s", "--rate=4", "--dpi=50", "--out", "OUT"],
    &["study", "run", "s.toml", "--out", "OUT"],
    &["man", "OUT"],
    &["motion", "info", "records", "--out", "OUT"],
    &["motion", "plot", "m.txt", "-o", "OUT"],
    &["motion", "convert", "m.txt", "-o", "OUT.npz"],
    &["motion", "process", "m.txt", "--high-pass=0.5 Hz", "--figure=OUT.svg", "-o", "OUT.csv"],
    &["motion", "scale", "m.txt", "--factor=2", "-o", "OUT.at2"],
    &["motion", "spectrum", "m.txt", "-o", "OUT.csv"],
    &["motion", "synth", "clough-penzien", "--duration=5 s", "-o", "OUT.txt"],
    &["motion", "match", "m.txt", "--to=ec8:ag=0.3,site=B", "--accept-misfit", "-o", "OUT.txt"],
    &[
        "motion",
        "select",
        "records",
        "--target=ec8:ag=0.3,site=B",
        "--spectrum=h1",
        "--scale=0.01..1000",
        "--count=2",
        "--out",
        "OUT",
    ],
    &["study", "export", "finished", "--out", "OUT"],
    &["calibrate", "friction", "tilts.csv", "--interface=rack-ground", "--out", "OUT"],
    PROTECT,
];

/// A search that is over soon.
const PROTECT: &[&str] = &[
    "protect",
    "candia-6-barrels",
    "--motions=records",
    "--budget=0",
    "--pgv=20 cm/s",
    "--rounds=1",
    "--quiet",
    "--out",
    "OUT",
];

/// Commands that go on in a folder of results.
const CONTINUED: [&[&str]; 5] = [
    &["study", "run", "f.toml", "--out", "OUT"],
    &["study", "collect", "OUT"],
    &["study", "report", "OUT"],
    PROTECT,
    &["heights", "--highest=2", "--synthetic=0", "--quiet", "--out", "OUT"],
];

/// Thirty cases of which about half collapse, so that a curve can be fitted; after [`HEAD`].
const GRADUAL: &str = "\
duration = \"2 s\"
[[motion]]
name = \"long\"
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.8 s\" }
[[motion]]
name = \"short\"
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.4 s\" }
[intensity]
measure = \"pgv\"
levels = [\"150 cm/s\", \"200 cm/s\", \"250 cm/s\", \"300 cm/s\", \"400 cm/s\"]
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
values = [0.3, 0.5, 0.7]
[design]
kind = \"stripes\"
";

/// A folder with the inputs of [`WRITERS`].
fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let made = ["motion", "synth", "clough-penzien", "--duration=5 s", "-o", "m.txt"];
    assert_eq!(program(made).current_dir(folder.path()).output().unwrap().status.code(), Some(0));
    fs::create_dir(folder.path().join("records")).unwrap();
    for name in ["a.txt", "b.txt"] {
        fs::copy(folder.path().join("m.txt"), folder.path().join("records").join(name)).unwrap();
    }
    fs::write(folder.path().join("s.toml"), format!("{HEAD}{STUDY}")).unwrap();
    fs::write(folder.path().join("f.toml"), format!("{HEAD}{GRADUAL}")).unwrap();
    fs::write(folder.path().join("tilts.csv"), "angle (deg)\n20\n21\n22\n").unwrap();
    let study = shell(folder.path(), ":", &["study", "run", "f.toml", "--out", "OUT"], "finished");
    assert_eq!(study.status.code(), Some(0), "{}", stderr(&study));
    folder
}

/// The command in a folder, with OUT as `out`, behind what a shell does before.
fn shell(folder: &Path, before: &str, arguments: &[&str], out: &str) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("{before}; exec \"$0\" \"$@\"")]);
    command.arg(env!("CARGO_BIN_EXE_barrelstack"));
    command.args(arguments.iter().map(|argument| argument.replace("OUT", out)));
    command.current_dir(folder).stdin(Stdio::null()).output().unwrap()
}

/// Files below a folder or a file whose name begins so, with their sizes.
fn files(folder: &Path, begins: &str) -> Vec<(String, u64)> {
    let mut found = Vec::new();
    let mut look = vec![folder.to_owned()];
    while let Some(folder) = look.pop() {
        for entry in fs::read_dir(&folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            if path.is_dir() {
                look.push(path);
            } else {
                found.push((path.display().to_string(), entry.metadata().unwrap().len()));
            }
        }
    }
    let begins = folder.join(begins).display().to_string();
    found.retain(|(name, _)| name.starts_with(&begins));
    found.sort();
    found
}

/// A limit of the size of files stands for a full disk: both refuse the rest of what is written.
#[test]
fn a_full_disk_leaves_no_part_of_a_file_in_any_command() {
    let place = place();
    for (number, command) in WRITERS.iter().enumerate() {
        let whole = shell(place.path(), ":", command, &format!("whole-{number}"));
        assert_eq!(whole.status.code(), Some(0), "{command:?}: {}", stderr(&whole));
        let largest = files(place.path(), &format!("whole-{number}"));
        let largest = largest.iter().map(|(_, size)| *size).max().unwrap();
        // In units of 512 bytes: nearly nothing, and all but the end of the largest file.
        for limit in [1, (largest - 1) / 512] {
            let out = format!("cut-{number}-{limit}");
            let cut = shell(place.path(), &format!("ulimit -f {limit}"), command, &out);
            let words = stderr(&cut);
            assert_eq!(cut.status.code(), Some(2), "{command:?} {limit}: {words}");
            assert!(words.contains("the file exceeds the size limit"), "{command:?}: {words}");
            assert!(words.contains(&out), "the file is named: {words}");
            for (name, size) in files(place.path(), &out) {
                assert!(!name.contains(".part"), "{command:?} {limit} leaves {name}");
                assert_ne!(size, 512 * limit, "{command:?} {limit} leaves a part of {name}");
            }
        }
    }
}

#[test]
fn what_is_printed_into_a_closed_or_full_output_is_an_error_of_every_command() {
    let place = place();
    let printers: [&[&str]; 8] = [
        &["scenarios"],
        &["schema"],
        &["completions", "bash"],
        &["--help"],
        &["--version"],
        &["check", "rocking-block", "--json"],
        &["motion", "info", "m.txt"],
        &["study", "example", "demo-devices"],
    ];
    for (number, command) in WRITERS.iter().chain(&printers).enumerate() {
        // Only what prints a result.
        if command[0] == "man" {
            continue;
        }
        for (name, before) in [("closed", "exec >&-"), ("full", "exec >/dev/full")] {
            let said = shell(place.path(), before, command, &format!("{name}-{number}"));
            let words = stderr(&said);
            assert_eq!(said.status.code(), Some(2), "{command:?} {name}: {words}");
            assert!(
                words.contains("cannot write to standard output"),
                "{command:?} {name}: {words}"
            );
        }
        // Where somebody wants nothing printed, all is well.
        if printers.contains(command) {
            let said = shell(place.path(), "exec >/dev/null", command, "none");
            assert_eq!(said.status.code(), Some(0), "{command:?}: {}", stderr(&said));
        }
    }
}

#[test]
fn of_commands_at_once_in_one_new_folder_one_writes() {
    let place = place();
    for command in [WRITERS[0], WRITERS[3]] {
        let start = || {
            let arguments = command.iter().map(|argument| argument.replace("OUT", "same"));
            let mut one = program(arguments);
            one.current_dir(place.path()).stdout(Stdio::null()).stderr(Stdio::piped());
            one.spawn().unwrap()
        };
        let both = [start(), start()].map(|one| one.wait_with_output().unwrap());
        let mut statuses = both.each_ref().map(|one| one.status.code().unwrap());
        statuses.sort_unstable();
        assert_eq!(statuses, [0, 2], "{command:?}: {}", stderr(&both[0]));
        let refused = both.iter().find(|one| one.status.code() == Some(2)).unwrap();
        assert!(stderr(refused).contains("is not empty"), "{}", stderr(refused));
        fs::remove_dir_all(place.path().join("same")).unwrap();
    }
}

/// Nothing is written through a link that lies where a command writes, be it a file or a folder.
#[test]
fn no_command_writes_through_a_link() {
    let place = place();
    for command in WRITERS {
        through_links(place.path(), command, false);
    }
    for command in CONTINUED {
        through_links(place.path(), command, true);
    }
}

#[test]
#[ignore = "takes minutes: the protocol of a score has many motions"]
fn no_score_is_written_through_a_link() {
    let short = "--set=run.duration=0.3 s";
    let command = ["score", "candia-6-barrels", short, "--quiet", "--out", "OUT"];
    through_links(place().path(), &command, true);
}

/// Runs a command, and again with each of some files and folders that it wrote as a link; the others are there as well
/// where it is to be continued.
fn through_links(place: &Path, command: &[&str], continued: bool) {
    let (whole, bare, outside) = (place.join("whole"), place.join("bare"), place.join("outside"));
    let before = match (continued, command[0]) {
        (true, "study") => "test -e whole || { mkdir whole; cp -r finished whole/x; }",
        _ => "mkdir -p whole",
    };
    let run = |out: &str| shell(place, before, command, &format!("{out}/x"));
    let first = run("whole");
    assert!(matches!(first.status.code(), Some(0 | 3)), "{command:?}: {}", stderr(&first));
    let below = |file: &(String, u64)| Path::new(&file.0).strip_prefix(&whole).unwrap().to_owned();
    let made: Vec<PathBuf> = files(&whole, "").iter().map(below).collect();
    let folders = made.iter().filter_map(|file| file.parent()).filter(|at| at.iter().count() > 1);
    let places: Vec<&Path> =
        made.iter().map(PathBuf::as_path).chain(folders.collect::<BTreeSet<_>>()).collect();
    assert!(!places.is_empty(), "{command:?}");
    for at in places.iter().step_by(places.len().div_ceil(6)) {
        fs::create_dir_all(&outside).unwrap();
        fs::write(outside.join("kept"), "kept").unwrap();
        let (file, link) = (whole.join(at).is_file(), bare.join(at));
        if continued {
            let copied = Command::new("cp").arg("-r").args([&whole, &bare]).status().unwrap();
            assert!(copied.success());
            if file { fs::remove_file(&link) } else { fs::remove_dir_all(&link) }.unwrap();
        } else {
            fs::create_dir_all(link.parent().unwrap()).unwrap();
        }
        let to = if file { outside.join("kept") } else { outside.clone() };
        std::os::unix::fs::symlink(to, &link).unwrap();
        run("bare");
        let found = names(&outside).unwrap();
        assert_eq!(found, ["kept"], "{command:?} writes through {}", at.display());
        let kept = fs::read(outside.join("kept")).unwrap();
        assert_eq!(kept, b"kept", "{command:?} {}", at.display());
        println!("{} {}: nothing is written behind it", command[..2].join(" "), at.display());
        fs::remove_dir_all(&bare).unwrap();
    }
    fs::remove_dir_all(&whole).unwrap();
}

#[test]
fn what_a_command_reads_it_never_replaces() {
    let place = place();
    let at = |name: &str| place.path().join(name);
    let run = |arguments: &[&str]| shell(place.path(), ":", arguments, "out");
    let kept = |name: &str, arguments: &[&str]| {
        let before = fs::read(at(name)).unwrap();
        let said = run(arguments);
        let words = stderr(&said);
        assert_eq!(said.status.code(), Some(2), "{arguments:?}: {words}");
        assert!(words.contains("is never overwritten"), "{arguments:?}: {words}");
        assert!(words.contains("cannot write "), "{words}");
        assert_eq!(fs::read(at(name)).unwrap(), before, "{arguments:?}");
    };
    let short = "--set=run.duration=1 s";
    assert_eq!(run(&["run", "rocking-block", short, "--out", "out"]).status.code(), Some(0));
    kept("out/scenario.toml", &["run", "out/scenario.toml", "--out", "out", "--overwrite"]);
    let page = ["compare", "out/scenario.toml", "rocking-block", short, "--out", "out"];
    let page = run(&[&page[..], &["--overwrite"]].concat());
    assert_eq!(page.status.code(), Some(2), "{}", stderr(&page));
    // However the path is written.
    std::os::unix::fs::symlink(at("m.txt"), at("link.txt")).unwrap();
    for same in ["m.txt", "out/../m.txt", "link.txt"] {
        for (from, to) in [("m.txt", same), (same, "m.txt")] {
            kept("m.txt", &["motion", "scale", from, "--factor=2", "-o", to, "--overwrite"]);
            kept("m.txt", &["motion", "convert", from, "-o", to, "--overwrite"]);
        }
    }
    // A copy of the study lies in its folder, which is its own to write.
    assert_eq!(run(&["study", "run", "s.toml", "--out", "st"]).status.code(), Some(0));
    let again = run(&["study", "run", "st/study.toml", "--out", "st"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    assert!(names(&at("st")).unwrap().contains(&"study.toml".to_owned()));
    assert!(!stdout(&barrelstack(["scenarios"])).is_empty());
}

/// Names of the columns of a CSV file: what stands before the unit in parentheses.
fn heads(csv: &str) -> Vec<String> {
    let line = csv.lines().find(|line| !line.starts_with('#')).unwrap();
    line.split(',').map(|cell| cell.split(" (").next().unwrap().to_owned()).collect()
}

/// Names of the arrays of a NumPy archive.
fn arrays(archive: &[u8]) -> Vec<String> {
    let mut names = Vec::new();
    for at in 0..archive.len().saturating_sub(30) {
        if archive[at..].starts_with(b"PK\x03\x04") {
            let length = usize::from(u16::from_le_bytes([archive[at + 26], archive[at + 27]]));
            let name = String::from_utf8_lossy(&archive[at + 30..at + 30 + length]);
            names.push(name.trim_end_matches(".npy").to_owned());
        }
    }
    names
}

#[test]
fn a_column_has_one_name_in_all_files() {
    let folder = place();
    let done = |arguments: &[&str]| {
        let made = program(arguments).current_dir(folder.path()).output().unwrap();
        assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    };
    let read = |path: &str| fs::read_to_string(folder.path().join(path)).unwrap();
    let plain = |name: &String| {
        name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_'))
    };
    done(&[
        "run",
        "demo-napa",
        "--set=stack.view=transverse",
        "--set=run.duration=0.5 s",
        "--variants=2",
        "--no-remedy",
        "--out=run",
    ]);
    let mut all = arrays(&fs::read(folder.path().join("run/histories.npz")).unwrap());
    let (histories, forces) = (heads(&read("run/histories.csv")), heads(&read("run/forces.csv")));
    assert!(histories.contains(&"B4.1_displacement_x".to_owned()), "{histories:?}");
    assert!(histories.contains(&"ground_acceleration_x".to_owned()), "{histories:?}");
    assert!(forces.contains(&"R1_on_ground_vertical_force".to_owned()), "{forces:?}");
    let mut written = [histories, forces[1..].to_vec()].concat();
    all.sort();
    written.sort();
    assert_eq!(all, written);
    for file in ["variants.csv", "envelopes.csv", "frames.csv"] {
        all.extend(heads(&read(&format!("run/{file}"))));
    }
    assert!(all.iter().all(plain), "{all:?}");
    // A run lists the columns of all of its tables, each with a meaning.
    let columns = read("run/columns.csv");
    assert_eq!(columns.lines().next(), Some("file,name,unit,meaning"));
    for file in ["variants.csv", "histories.csv", "forces.csv", "envelopes.csv", "frames.csv"] {
        let begin = format!("{file},");
        let rows: Vec<&str> = columns.lines().filter_map(|row| row.strip_prefix(&begin)).collect();
        let names: Vec<&str> = rows.iter().map(|row| row.split(',').next().unwrap()).collect();
        assert_eq!(heads(&read(&format!("run/{file}"))), names, "{file}");
        let without: Vec<&&str> = rows.iter().filter(|row| row.ends_with(',')).collect();
        assert!(without.is_empty(), "{file}: {without:?}");
    }
    // A study lists its columns; names of its own factors stand as they were written.
    done(&["study", "run", "s.toml", "--out", "study"]);
    let columns = read("study/columns.csv");
    assert_eq!(columns.lines().next(), Some("name,unit,role,kind,meaning"));
    let listed: Vec<&str> =
        columns.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(heads(&read("study/table.csv")), listed);
    let parquet = fs::read(folder.path().join("study/table.parquet")).unwrap();
    let holds = |name: &str| parquet.windows(name.len()).any(|part| part == name.as_bytes());
    assert!(listed.iter().all(|name| holds(name)), "{listed:?}");
    let outcomes = ["first_fall", "energy_residual_ratio"];
    assert!(outcomes.iter().all(|name| listed.contains(name)), "{listed:?}");
}
