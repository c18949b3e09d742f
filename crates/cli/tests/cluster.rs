//! The commands of the page "From a laptop to a cluster", run as written there.

#![cfg(unix)]

use crate::common;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{HEAD, there};

/// Six chunks of short cases after [`HEAD`], in place of the example of the page.
const STUDY: &str = "\
duration = \"0.3 s\"
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
distribution = { kind = \"uniform\", from = 0.2, to = 0.6 }
[[motion]]
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.25 s\" }
[design]
kind = \"sobol\"
count = 48
chunk = 8
";

/// Returns the commands under a heading of the page, one text per block.
fn blocks(heading: &str) -> Vec<String> {
    let page =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("CLUSTER.md")).unwrap();
    let part = page.split("\n## ").find(|part| part.starts_with(heading)).expect(heading);
    let fenced = part.split("```sh\n").skip(1);
    fenced.map(|block| block.split("```").next().unwrap().to_owned()).collect()
}

/// Runs commands in a folder, with the built program in the path.
fn shell(folder: &Path, commands: &str) {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_barrelstack"));
    let path =
        format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("sh");
    command.args(["-eu", "-c", commands]).current_dir(folder).env("PATH", path);
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{commands}\n{said}");
}

fn tables(folder: &Path) -> Option<[Vec<u8>; 3]> {
    let files = ["table.csv", "table.parquet", "provenance.json"];
    let read = files.map(|name| fs::read(folder.join(name)).ok());
    read.iter().all(Option::is_some).then(|| read.map(Option::unwrap))
}

/// Returns a folder in which one process ran the study, and its table.
fn one_machine() -> (tempfile::TempDir, [Vec<u8>; 3]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), [HEAD, STUDY].concat()).unwrap();
    shell(folder.path(), &blocks("One machine")[1]);
    let table = tables(&folder.path().join("mine")).unwrap();
    (folder, table)
}

#[test]
fn one_machine_two_processes_and_single_chunks_make_one_table() {
    let (folder, table) = one_machine();
    shell(folder.path(), &blocks("Several processes")[0]);
    assert!(tables(&folder.path().join("shared")).unwrap() == table);
    fs::remove_dir_all(folder.path().join("mine")).unwrap();
    let chunk = &blocks("Chunk by chunk")[0];
    let run = chunk.lines().next().unwrap();
    for number in 1..6 {
        shell(folder.path(), &run.replace("--chunk 0", &format!("--chunk {number}")));
    }
    shell(folder.path(), chunk);
    assert!(tables(&folder.path().join("mine")).unwrap() == table);
    // Last, since it writes a study of its own.
    shell(folder.path(), &blocks("One machine")[0]);
}

#[test]
fn a_killed_process_leaves_its_chunk_to_the_other() {
    let (folder, table) = one_machine();
    let out = folder.path().join("both");
    let words = |out: &Path| {
        ["study", "mine.toml", "--threads", "1", "--out"]
            .map(PathBuf::from)
            .into_iter()
            .chain([out.into()])
    };
    let mut hits = 0;
    for share in [1_u64, 9, 4, 16, 7, 12] {
        drop(fs::remove_dir_all(&out));
        let start = || {
            let mut program = common::program(words(&out));
            program.current_dir(folder.path()).stdout(std::process::Stdio::null()).spawn().unwrap()
        };
        let (mut killed, mut other) = (start(), start());
        // As soon as there is something to lose, and a little later each time.
        while common::names(&out.join("shards")).is_none_or(|names| names.is_empty()) {
            // On a busy machine it may finish between two polls.
            if let Some(status) = killed.try_wait().unwrap() {
                assert!(status.success(), "it ended before it was killed, with {status}");
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        std::thread::sleep(std::time::Duration::from_millis(5 * share));
        hits += u32::from(killed.try_wait().unwrap().is_none());
        killed.kill().unwrap();
        killed.wait().unwrap();
        assert!(other.wait().unwrap().success());
        assert!(tables(&out).unwrap() == table, "killed after {share} steps");
        let left = common::names(&out.join("shards")).unwrap();
        assert_eq!(left.len(), 6, "one shard a chunk, and no claims: {left:?}");
    }
    assert!(hits >= 1, "none of 6 was alive when it was killed");
}

#[test]
fn dask_makes_the_same_table() {
    if !there("python3", &["-c", "import distributed"]) {
        return;
    }
    let (folder, table) = one_machine();
    shell(folder.path(), &blocks("Dask")[0]);
    assert!(tables(&folder.path().join("on-dask")).unwrap() == table);
}

#[test]
fn slurm_makes_the_same_table() {
    if !there("sinfo", &["--version"]) || !there("sinfo", &[]) {
        return;
    }
    let (folder, table) = one_machine();
    // Two arrays and the job after them.
    let block = blocks("Slurm")[0].replace(" > ", " --array-limit 4 > ");
    shell(folder.path(), &block);
    let out = folder.path().join("on-slurm");
    for _ in 0..600 {
        if out.join("provenance.json").is_file() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(200));
    }
    assert!(tables(&out).unwrap() == table);
}
