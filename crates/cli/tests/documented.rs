//! Every documented command line, run as it is written, document by document, from an empty folder.
//!
//! A document states which files it assumes to exist: "… stand for files of your own", with their names before it, and
//! "Saved as `NAME`" for the block above. No other files exist. A line that runs longer than [`AWAIT`] and the
//! remainder of [`PATIENCE`] is stopped with Ctrl-C and printed. For such lines, the test shows that arguments and
//! files are read, that the work begins, and that it ends in order when it is stopped; later failures are not observed.

#![cfg(unix)]
#![allow(
    clippy::print_stdout,
    clippy::format_push_string,
    reason = "tests and their helpers fail by panicking, and print what they ran"
)]

use crate::common;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::common::{HEAD, barrelstack};

/// Time after which a line is stopped.
const AWAIT: Duration = Duration::from_secs(1);
/// Time (ms) beyond [`AWAIT`] that all lines of all documents share, in which most of them end by themselves.
static PATIENCE: AtomicU64 = AtomicU64::new(12_000);
/// Largest share (ms) of one line.
const SHARE: u64 = 3_000;
/// Time within which a stopped line ends; measured 0.1 to 2 s, on a busy machine more.
const AT_MOST: Duration = Duration::from_secs(60);
/// Exit status of a stopped command.
const STOPPED: i32 = 130;

/// Lines of other programs in the blocks, by their beginnings, with the reason why they are not run.
const NOT_RUN: [(&str, &str); 8] = [
    ("cargo run --release -- ", "is run as the command that it stands for"),
    ("cargo xtask test", "runs this test"),
    ("cargo xtask validate", "the checks of the workspace run it"),
    ("cargo xtask bench", "measures speed, for an hour"),
    ("cargo xtask web", "builds the page; a page with the mark of one stands in"),
    ("pip install .", "the tests of the Python package run it"),
    ("cargo run --release -p barrelstack-space --example ", "runs for hours"),
    ("cargo run --release -p barrelstack-cellar --example ", "runs for minutes"),
];

/// Stacks of two barrels that fall at some levels, in place of a study of hours whose curves are exported.
const SMALL: &str = "\
duration = \"2 s\"
[[motion]]
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.8 s\" }
[intensity]
measure = \"pgv\"
levels = [\"100 cm/s\", \"160 cm/s\", \"200 cm/s\", \"240 cm/s\", \"300 cm/s\"]
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
values = [0.3, 0.4, 0.5, 0.6, 0.7]
[design]
kind = \"stripes\"
";

/// A fenced block of a document.
struct Block {
    language: String,
    text: String,
    /// Prose between it and the block before.
    before: String,
}

impl Block {
    fn is_shell(&self) -> bool {
        let own = |line: &str| line.starts_with("barrelstack ");
        self.language == "sh" || self.text.lines().all(own)
    }
}

fn blocks(document: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut rest = document;
    while let Some((before, fenced)) = rest.split_once("\n```") {
        let (language, fenced) = fenced.split_once('\n').unwrap();
        let (text, after) = fenced.split_once("\n```").unwrap_or((fenced, ""));
        found.push(Block {
            language: language.to_owned(),
            text: text.to_owned(),
            before: before.to_owned(),
        });
        rest = after;
    }
    found
}

/// Returns the names in backquotes of a text.
fn names(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// Returns a made-up record of three components, of sines of all periods from 0.05 to 5 s.
fn record(number: u32) -> String {
    let mut text = "time (s),EW (g),NS (g),UD (g)\n".to_owned();
    for row in 0..1600 {
        let t = 0.01 * f64::from(row);
        let envelope = 0.02 * t * (-0.3 * t).exp() * f64::from(2 + number);
        let component = |of: u32| -> f64 {
            let sines = (0..24).map(|k| {
                let k = f64::from(k);
                let frequency = 0.2 * (k / 5.0).exp();
                (std::f64::consts::TAU * frequency * t + k * f64::from(7 * of + number)).sin()
            });
            envelope * sines.sum::<f64>()
        };
        let [x, y, z] = [1, 2, 3].map(component);
        text += &format!("{t:.3},{x:.6},{y:.6},{z:.6}\n");
    }
    text
}

/// Writes a file, or a folder, that a document leaves to its reader.
fn write_stand_in(folder: &Path, name: &str) {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../motion/tests/data");
    let copied = |from: &str| fs::read(data.join(from)).unwrap();
    let scenario = |change: &str| {
        let head = "schema = 1\nextends = \"demo-napa\"\n";
        format!("{head}{change}").into_bytes()
    };
    let bytes: Vec<u8> = match name {
        "my-site.AT2" | "RSN995_NORTHR_PEL360.AT2" => copied("peer/nga-west2.AT2"),
        "my-site.V2" => copied("csmip-v2/example.V2"),
        "records" => {
            fs::create_dir(folder.join(name)).unwrap();
            for number in 1..=8 {
                fs::write(folder.join(format!("records/{number}.csv")), record(number)).unwrap();
            }
            return;
        }
        "tilt.csv" => b"angle (deg)\n22.5\n23.1\n21.8\n24.0\n".to_vec(),
        "sag.csv" => b"load (kg),sag (mm)\n270,0.41\n270,0.47\n272,0.43\n".to_vec(),
        "hazard.csv" => b"pgv (cm/s),rate (1/year)\n5,0.1\n50,0.005\n200,0.0001\n".to_vec(),
        "mine.toml" | "old.toml" => scenario(""),
        "new.toml" => scenario("[stack]\nlevels = 4\n"),
        "strapped.toml" => scenario(
            "[stack.strap]\nlevels = 5\nties = \"levels-together\"\npretension = \"3 kN\"\n",
        ),
        other => panic!("no stand-in is written for {other}"),
    };
    fs::write(folder.join(name), bytes).unwrap();
}

/// Starts a line in a folder, as a shell does; `program` is the folder of the command.
fn start(line: &str, folder: &Path, program: &Path, said: &Path) -> Child {
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    Command::new("sh")
        // The shell becomes the program, so that a signal reaches it.
        .args(["-c", &format!("exec {line}")])
        .current_dir(folder)
        .env("PATH", path)
        .stdin(Stdio::null())
        .stdout(fs::File::create(said.join("stdout")).unwrap())
        .stderr(fs::File::create(said.join("stderr")).unwrap())
        .spawn()
        .unwrap()
}

/// Waits for the end of a line until a time; `None` if it goes on.
fn ended(child: &mut Child, limit: Duration) -> Option<ExitStatus> {
    let begin = Instant::now();
    while begin.elapsed() < limit {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    None
}

/// Waits for the end of a long line in steps of a second, as long as its share and the common patience last.
fn patient(child: &mut Child) -> Option<ExitStatus> {
    (0..SHARE / 1000).find_map(|_| {
        let left = |ms: u64| ms.checked_sub(1000);
        PATIENCE.fetch_update(Ordering::Relaxed, Ordering::Relaxed, left).ok()?;
        ended(child, Duration::from_secs(1))
    })
}

/// Runs a line to its end, or stops it; returns the failure, if any.
fn run(line: &str, folder: &Path, program: &Path, said: &Path) -> Option<String> {
    let mut child = start(line, folder, program, said);
    let status = ended(&mut child, AWAIT).or_else(|| patient(&mut child)).unwrap_or_else(|| {
        println!("stopped: {line}");
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        ended(&mut child, AT_MOST).unwrap_or_else(|| {
            child.kill().unwrap();
            child.wait().unwrap()
        })
    });
    let code = status.code();
    let words = fs::read_to_string(said.join("stderr")).unwrap();
    let fine = matches!(code, Some(0 | STOPPED)) && !words.contains("panicked");
    (!fine).then(|| format!("{line}\n  status {code:?}: {words}"))
}

/// Joins the lines of a block that end with `\`, and leaves comments and blank lines out.
fn lines(block: &str) -> Vec<String> {
    let joined = block.replace("\\\n", " ");
    let lines = joined.lines().map(|line| line.split(" #").next().unwrap_or(line).trim());
    lines.filter(|line| !line.is_empty() && !line.starts_with('#')).map(str::to_owned).collect()
}

/// Runs all lines of a document and returns their number.
fn documented(file: &str) -> usize {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = fs::read_to_string(root.join(file)).unwrap();
    let (folder, said) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let at = folder.path();
    symlink(env!("CARGO_BIN_EXE_barrelstack"), said.path().join("barrelstack")).unwrap();
    let own = text.lines().filter_map(|line| line.split_once(" of your own").map(|parts| parts.0));
    for name in own.filter(|line| line.contains("stand")).flat_map(names) {
        write_stand_in(at, name);
    }
    let (mut count, mut failures) = (0, Vec::new());
    let mut above: Option<Block> = None;
    for block in blocks(&text) {
        if let Some((_, rest)) = block.before.split_once("Saved as ") {
            let saved = above.as_ref().expect("a block above the words");
            fs::write(at.join(names(rest)[0]), format!("{}\n", saved.text)).unwrap();
        }
        for line in lines(&block.text).iter().filter(|_| block.is_shell()) {
            let line = line.replace("cargo run --release -- ", "barrelstack ");
            if let Some((_, why)) = NOT_RUN.iter().find(|(start, _)| line.starts_with(start)) {
                println!("not run: {line}, which {why}");
                if line.starts_with("cargo xtask web") {
                    fs::create_dir(at.join("target")).unwrap();
                    let mark = "<script type=\"text/plain\" id=\"engine\"></script>\n";
                    fs::write(at.join("target/barrelstack.html"), mark).unwrap();
                }
                continue;
            }
            assert!(line.starts_with("barrelstack "), "{file}: what is {line}?");
            if let Some(rest) = line.strip_prefix("barrelstack study export ") {
                finish(at, rest.split(' ').next().unwrap());
            }
            let begin = Instant::now();
            failures.extend(run(&line, at, said.path(), said.path()));
            println!("{:6.2} s  {line}", begin.elapsed().as_secs_f64());
            count += 1;
        }
        above = Some(block);
    }
    assert!(failures.is_empty(), "{file}:\n{}", failures.join("\n"));
    count
}

/// Puts a small finished study in the place of one that was stopped.
fn finish(folder: &Path, name: &str) {
    let (study, out): (PathBuf, PathBuf) = (folder.join("small.toml"), folder.join(name));
    fs::write(&study, [HEAD, SMALL].concat()).unwrap();
    fs::remove_dir_all(&out).unwrap();
    let output = barrelstack(["study".as_ref(), study.as_path(), "--out".as_ref(), out.as_path()]);
    assert!(output.status.success(), "{}", common::stderr(&output));
    fs::remove_file(study).unwrap();
}

#[test]
fn lines_of_the_readme_work_from_an_empty_folder() {
    assert!(documented("README.md") >= 13);
}

#[test]
fn lines_of_the_page_on_the_command_work_from_an_empty_folder() {
    assert!(documented("docs/command-line.md") >= 30);
}

#[test]
fn lines_of_all_other_documents_work_from_an_empty_folder() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let mut count = 0;
    for entry in fs::read_dir(docs).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.extension().is_some_and(|extension| extension == "md") && name != "command-line.md"
        {
            count += documented(&format!("docs/{name}"));
        }
    }
    for name in ["devices.md", "rockscore.md", "space.md"] {
        count += documented(&format!("validation/{name}"));
    }
    assert!(count >= 14, "{count}");
}
