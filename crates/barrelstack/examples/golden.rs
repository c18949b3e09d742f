//! Stores the bits of present results as reference; refuses if they changed under the same version.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example that prints its result")]

#[path = "../tests/golden/mod.rs"]
mod golden;

use std::process::ExitCode;

use golden::{Table, Verdict, file};

fn main() -> ExitCode {
    match renew() {
        Ok(told) => {
            println!("{told}");
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

fn renew() -> Result<String, String> {
    let file = file();
    let at = |reason: String| format!("{}: {reason}", file.display());
    let now = Table::now();
    if file.is_file() {
        let text = std::fs::read_to_string(&file).map_err(|error| at(error.to_string()))?;
        let kept = Table::parse(&text)
            .map_err(|reason| at(format!("{reason}; restore or remove the file")))?;
        match kept.verdict(&now) {
            Verdict::Kept => return Ok("the bits are those that are kept".to_owned()),
            Verdict::Refused(reason) => return Err(reason),
            Verdict::Stale(reason) => println!("{reason}\n"),
        }
    }
    std::fs::write(&file, now.to_string()).map_err(|error| at(error.to_string()))?;
    Ok(format!("{now}\nkept in {}", file.display()))
}
