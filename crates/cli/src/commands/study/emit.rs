//! Job files for schedulers that run the chunks of a study.

use std::fmt::Write as _;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::ValueEnum;

use crate::number::counting;
use crate::printer;

/// Arguments of `study emit`.
#[derive(Debug, clap::Args)]
pub(super) struct EmitArgs {
    #[command(flatten)]
    which: super::Which,
    /// Scheduler that runs the chunks.
    #[arg(long, value_enum)]
    engine: Engine,
    /// Folder for the results, which every worker must be able to access.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Time limit of a chunk in Slurm's format, such as 02:00:00; by default, the limit of the
    /// partition (slurm).
    #[arg(long, value_name = "TIME")]
    walltime: Option<String>,
    /// Maximum number of chunks that run at the same time; by default, as many as the scheduler
    /// allows (slurm, parallel).
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = counting())]
    throttle: Option<NonZero<usize>>,
    /// Maximum number of tasks in an array job, `MaxArraySize` in Slurm's configuration; by default
    /// 1001 (slurm).
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true, value_parser = counting())]
    array_limit: Option<NonZero<usize>>,
}

/// Scheduler of the chunks.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Engine {
    /// A shell script that submits array jobs, followed by a job that collects the table.
    Slurm,
    /// A shell script that runs one chunk per core at a time with GNU parallel.
    Parallel,
    /// A shell script that submits a task array.
    Hyperqueue,
    /// A Python script that runs the chunks as tasks of a Dask cluster.
    Dask,
    /// A Python script that runs the chunks with `PyLauncher`, in one job on many nodes.
    Pylauncher,
}

/// Quotes a word for a shell command.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Makes a path absolute, because jobs start in other folders.
fn absolute(path: &Path) -> anyhow::Result<String> {
    let whole = std::path::absolute(path)
        .with_context(|| format!("cannot find the absolute path of {}", path.display()))?;
    Ok(whole.display().to_string())
}

/// Data for a job file.
struct Job {
    program: String,
    study: String,
    out: String,
    chunks: usize,
}

impl Job {
    /// Returns the shell command that runs a chunk. `number` is inserted without quoting, so that it may be a shell
    /// variable or a placeholder.
    fn chunk(&self, number: &str) -> String {
        let [program, study, out] = [&self.program, &self.study, &self.out].map(|w| quoted(w));
        format!("{program} study run-chunk {study} --chunk {number} --out {out}")
    }

    fn collect(&self) -> String {
        format!("{} study collect {}", quoted(&self.program), quoted(&self.out))
    }
}

/// Prints the job file.
pub(super) fn emit(args: &EmitArgs) -> anyhow::Result<()> {
    let slurms = matches!(args.engine, Engine::Slurm);
    let throttles = slurms || matches!(args.engine, Engine::Parallel);
    for (option, given, known) in [
        ("walltime", args.walltime.is_some(), slurms),
        ("throttle", args.throttle.is_some(), throttles),
        ("array-limit", args.array_limit.is_some(), slurms),
    ] {
        if given && !known {
            bail!(
                "--{option} cannot be written into the files for this scheduler; leave it out, and set this limit in \
                 the command that starts the jobs"
            );
        }
    }
    let name = &args.which.study;
    let chunks = super::load(name)?.chunk_count();
    let file = Path::new(name);
    let program = std::env::current_exe().context("cannot find the path of this program")?;
    let job = Job {
        program: program.display().to_string(),
        study: if file.is_file() { absolute(file)? } else { name.clone() },
        out: absolute(&args.out)?,
        chunks,
    };
    printer::text(&match args.engine {
        Engine::Slurm => slurm(&job, args),
        Engine::Parallel => parallel(&job, args.throttle),
        Engine::Hyperqueue => hyperqueue(&job),
        Engine::Dask => dask(&job),
        Engine::Pylauncher => pylauncher(&job),
    })
}

/// Placeholder for the number of a chunk.
const PLACE: &str = "\u{0}";

/// Escapes text for a here-document of the shell.
fn in_document(text: &str) -> String {
    text.replace('\\', "\\\\").replace('$', "\\$").replace('`', "\\`")
}

fn slurm(job: &Job, args: &EmitArgs) -> String {
    let limit = args.array_limit.map_or(1001, NonZero::get);
    let time =
        args.walltime.as_ref().map_or_else(String::new, |t| format!(" --time={}", quoted(t)));
    let most = args.throttle.map_or_else(String::new, |most| format!("%{most}"));
    // The throttle applies to each array, so several arrays run one after another.
    let after = if args.throttle.is_some() { " ${job:+--dependency=afterany:$job}" } else { "" };
    let mut text = format!(
        "#!/bin/sh\n\
         # Submits {} chunks, one task each in arrays of at most {limit}, followed by a job that collects the\n\
         # table: sh THIS-FILE. Options for sbatch such as --partition may follow the name of the file.\n\
         set -eu\njobs= job=\n\
         submit() {{ # number of the first chunk, last task, options\n\
         \x20   first=$1 last=$2; shift 2\n\
         \x20   job=$(sbatch --parsable --requeue --cpus-per-task=1{time} --array=\"0-$last{most}\"{after} \"$@\" <<END\n\
         #!/bin/sh\n\
         # A chunk that was killed on its node is run again, up to three times.\n\
         for again in 1 2 3; do\n\
         \x20   {} && exit 0\n\
         \x20   [ \\$? -gt 128 ] || exit 1\n\
         done\n\
         exit 1\n\
         END\n\
         )\n\
         \x20   job=${{job%%;*}} jobs=\"$jobs:${{job%%;*}}\"\n}}\n",
        job.chunks,
        in_document(&job.chunk(PLACE)).replace(PLACE, "\\$(($first + SLURM_ARRAY_TASK_ID))")
    );
    for first in (0..job.chunks).step_by(limit) {
        let last = limit.min(job.chunks - first) - 1;
        let _ = writeln!(text, "submit {first} {last} \"$@\"");
    }
    // The job runs after the arrays end, whether or not they succeed: the collected table states
    // which chunks are missing.
    let _ = writeln!(
        text,
        "sbatch --parsable --cpus-per-task=1 --dependency=\"afterany$jobs\" \"$@\" <<'END'\n\
         #!/bin/sh\n\
         exec {}\n\
         END",
        job.collect()
    );
    text
}

fn parallel(job: &Job, throttle: Option<NonZero<usize>>) -> String {
    let most = throttle.map_or_else(String::new, |most| format!("--jobs {most} "));
    format!(
        "#!/bin/sh\nset -eu\nseq 0 {} | parallel {most}{}\n{}\n",
        job.chunks - 1,
        quoted(&job.chunk("{}")),
        job.collect()
    )
}

fn hyperqueue(job: &Job) -> String {
    format!(
        "#!/bin/sh\nset -eu\nhq submit --wait --array 0-{} --cpus 1 -- sh -c {}\n{}\n",
        job.chunks - 1,
        quoted(&job.chunk("\"$HQ_TASK_ID\"")),
        job.collect()
    )
}

/// Returns text as a Python literal; a JSON string is a valid one.
fn literal(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// Returns the lines with which both Python scripts begin.
fn constants(job: &Job) -> String {
    let [program, study, out] = [&job.program, &job.study, &job.out].map(|text| literal(text));
    format!("PROGRAM = {program}\nSTUDY = {study}\nOUT = {out}\nCHUNKS = {}\n", job.chunks)
}

fn dask(job: &Job) -> String {
    format!(
        r#"#!/usr/bin/env python3
"""Runs the chunks of a study as tasks of a Dask cluster: python THIS-FILE [ADDRESS OF THE SCHEDULER].

Without an address, the cores of this machine are the cluster. For another cluster, change the line of the client:
SLURMCluster, PBSCluster and so on of dask-jobqueue start workers in jobs. All workers need access to the folders below.
"""
import subprocess
import sys

from dask.distributed import Client, progress

{}

def run(chunk):
    command = [PROGRAM, "study", "run-chunk", STUDY, "--chunk", str(chunk), "--out", OUT]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())


if __name__ == "__main__":
    client = Client(*sys.argv[1:2])
    # A chunk whose worker died is given to another worker; a chunk that failed is tried again.
    tasks = client.map(run, range(CHUNKS), retries=3, pure=False)
    progress(tasks, notebook=False)
    client.gather(tasks)
    subprocess.run([PROGRAM, "study", "collect", OUT], check=True)
"#,
        constants(job)
    )
}

fn pylauncher(job: &Job) -> String {
    format!(
        r#"#!/usr/bin/env python3
"""Runs the chunks of a study in one job on many cores with PyLauncher: python THIS-FILE, inside the job."""
import shlex
import subprocess

import pylauncher

{}
if __name__ == "__main__":
    words = [PROGRAM, "study", "run-chunk", STUDY, "--out", OUT, "--chunk"]
    with open("barrelstack.commands", "w") as file:
        file.writelines(f"{{shlex.join(words)}} {{chunk}}\n" for chunk in range(CHUNKS))
    pylauncher.ClassicLauncher("barrelstack.commands", cores=1)
    subprocess.run([PROGRAM, "study", "collect", OUT], check=True)
"#,
        constants(job)
    )
}
