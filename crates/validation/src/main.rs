//! Runs every problem at full effort, prints a table, and writes the report.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program's output")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use barrelstack_report::{attachments, html, markdown};
use barrelstack_validation::{Effort, Problem, Row, all, cases, execute, page};

const USAGE: &str = "usage: barrelstack-validation [--out DIR] [--fast] [--only TEXT] [--threads N] \
                     [CASE.toml ...]";

/// Parsed command line.
struct Request {
    out: PathBuf,
    effort: Effort,
    only: String,
    threads: usize,
    cases: Vec<PathBuf>,
}

fn main() -> ExitCode {
    match request(std::env::args().skip(1)).and_then(|request| validate(&request)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn request(mut args: impl Iterator<Item = String>) -> Result<Request, String> {
    let mut request = Request {
        out: PathBuf::from("validation-report"),
        effort: Effort::Full,
        only: String::new(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        cases: vec![],
    };
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| format!("{arg} needs a value; {USAGE}"));
        match arg.as_str() {
            "--out" => request.out = PathBuf::from(value()?),
            "--only" => request.only = value()?,
            "--fast" => request.effort = Effort::Fast,
            "--threads" => {
                let text = value()?;
                request.threads = text
                    .parse()
                    .map_err(|_| format!("--threads: expected a number, found {text:?}"))?;
            }
            option if option.starts_with('-') => return Err(format!("unknown {option}; {USAGE}")),
            case => request.cases.push(PathBuf::from(case)),
        }
    }
    Ok(request)
}

/// Runs the problems, prints and writes the results; returns `true` if every answer is within its tolerance.
fn validate(request: &Request) -> Result<bool, String> {
    let mut problems: Vec<Problem> = all();
    for path in &request.cases {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let name = path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into());
        problems.push(cases::read(&name, &text).map_err(|e| e.to_string())?);
    }
    problems.retain(|problem| problem.id.contains(&request.only));
    if problems.is_empty() {
        return Err(format!("no problem has a name that contains {:?}", request.only));
    }
    let start = Instant::now();
    let total = problems.len();
    let rows = execute(&problems, request.effort, request.threads, &|at, row| {
        eprintln!("{:>4} of {total}  {} ({:.1} s)", at + 1, problems[at].id, row.seconds);
    });
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "  {:44} {:>12} {:>12} {:>9} {:>8} {:>5}",
        "problem", "exact", "ours", "error", "allowed", "order"
    );
    for (problem, row) in problems.iter().zip(&rows) {
        println!("{}", page::line(problem, row, request.effort));
    }
    write(request, &problems, &rows, seconds)?;
    let failed = rows.iter().filter(|row| !row.passed).count();
    println!("report: {}", request.out.join("index.html").display());
    println!("{} passed, {failed} failed", rows.len() - failed);
    Ok(failed == 0)
}

fn write(
    request: &Request,
    problems: &[Problem],
    rows: &[Row],
    seconds: f64,
) -> Result<(), String> {
    let document = page::document(problems, rows, request.effort, seconds);
    let files = request.out.join("files");
    let put = |path: &Path, bytes: &[u8]| {
        fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))
    };
    fs::create_dir_all(&files).map_err(|e| format!("{}: {e}", files.display()))?;
    put(&request.out.join("index.html"), html(&document).as_bytes())?;
    put(&request.out.join("index.md"), markdown(&document, "files").text.as_bytes())?;
    for file in attachments(&document) {
        put(&files.join(file.name), &file.bytes)?;
    }
    Ok(())
}
