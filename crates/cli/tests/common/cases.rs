//! The program under hostile input, in bounded time and memory.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::common::{names, stderr, stdout};

/// Time limit of an answer; measured 0.02 to 2 s.
const AT_MOST: Duration = Duration::from_secs(30);

/// Memory limit (kB): about two and a half times that of the largest recording.
const MEMORY: u32 = 5_000_000;

/// Words of which every error contains one: the expectation, or the remedy.
const NEXT: [&str; 40] = [
    "download",
    "lengthen",
    "there are:",
    "without it",
    "are needed",
    "expected",
    "must",
    "needs",
    "try ",
    "name ",
    "did you mean",
    "use ",
    "add ",
    "correct",
    "keep one",
    "such as",
    "write",
    "those are",
    "lists",
    "leave",
    "make",
    "see ",
    "take",
    "lower",
    "shorten",
    "valid",
    "is it",
    "help",
    "give",
    "save",
    "move",
    "set ",
    "at most",
    "known",
    "say ",
    "possible values",
    "start from",
    "those there are",
    "there is no file",
    "choose",
];

/// Cases that are run one after the other, with their failures.
pub(crate) struct Cases {
    folder: tempfile::TempDir,
    /// Output of the program goes to files, so that it does not block on a full pipe.
    said: tempfile::TempDir,
    count: usize,
    wrong: Vec<String>,
}

impl Cases {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            said: tempfile::tempdir().unwrap(),
            count: 0,
            wrong: Vec::new(),
        }
    }

    pub(crate) fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.at(name), bytes).unwrap();
        name.to_owned()
    }

    /// Runs the program in the folder with bounded memory and time.
    pub(crate) fn run(&mut self, arguments: &[&str]) -> Option<Output> {
        self.count += 1;
        let place = self.said.path().to_owned();
        let said = |name: &str| place.join(name);
        let limited = format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"");
        let mut child = Command::new("sh")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_barrelstack")])
            .args(arguments)
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .stdout(fs::File::create(said("stdout")).unwrap())
            .stderr(fs::File::create(said("stderr")).unwrap())
            .spawn()
            .unwrap();
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if start.elapsed() > AT_MOST {
                child.kill().unwrap();
                child.wait().unwrap();
                self.wrong.push(format!("{arguments:.100?}: no end"));
                return None;
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let read = |name: &str| fs::read(said(name)).unwrap();
        Some(Output { status, stdout: read("stdout"), stderr: read("stderr") })
    }

    /// Checks properties of all outputs.
    pub(crate) fn clean(&mut self, what: &str, output: &Output) {
        let (printed, said) = (stdout(output), stderr(output));
        let mut require = |holds: bool, why: &str| {
            if !holds {
                self.wrong.push(format!("{what:.200}: {why}: {:?} {said:.600}", output.status));
            }
        };
        require(output.status.code().is_some_and(|code| code <= 3), "status");
        require(!said.contains("panicked") && !printed.contains("panicked"), "panic");
        let obeyed = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
        require(!said.contains(obeyed) && !printed.contains(obeyed), "control characters");
        require(said.matches("error:").count() <= 1, "two errors");
        require(said.len() < 4000, "a flood");
    }

    /// Checks that the program refuses the arguments with these words, and leaves nothing behind.
    pub(crate) fn refused(&mut self, arguments: &[&str], words: &[&str]) {
        let before = names(self.folder.path());
        let what = format!("{arguments:?}");
        let Some(output) = self.run(arguments) else { return };
        self.clean(&what, &output);
        let (printed, said) = (stdout(&output), stderr(&output));
        let mut require = |holds: bool, why: &str| {
            if !holds {
                self.wrong.push(format!("{what:.200}: {why}: {:?} {said:.600}", output.status));
            }
        };
        require(output.status.code() == Some(2), "status");
        require(said.starts_with("error: "), "no error");
        if arguments.contains(&"--json") {
            let document = serde_json::from_str::<serde_json::Value>(&printed);
            require(document.is_ok_and(|document| document["schema"] == "error/1"), "no document");
        } else {
            require(printed.is_empty(), "a result");
        }
        require(NEXT.iter().any(|word| said.contains(word)), "no next move");
        for word in words {
            require(said.contains(word), &format!("no {word:?}"));
        }
        if names(self.folder.path()) != before {
            let left = names(self.folder.path());
            self.wrong.push(format!("{what:.200}: it leaves {left:?} for {before:?}"));
        }
    }

    /// Checks that the program either works or refuses, without harm.
    pub(crate) fn harmless(&mut self, arguments: &[&str]) {
        let what = format!("{arguments:?}");
        if let Some(output) = self.run(arguments) {
            self.clean(&what, &output);
        }
    }

    pub(crate) fn end(self, least: usize) {
        assert!(self.wrong.is_empty(), "{} wrong:\n{}", self.wrong.len(), self.wrong.join("\n"));
        assert!(self.count >= least, "{} cases", self.count);
    }
}
