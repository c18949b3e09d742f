//! Job files with which Slurm, GNU parallel or `HyperQueue` run the chunks of a study.

use std::path::PathBuf;

use clap::ValueEnum;

use crate::printer;

/// Arguments of `study emit`.
#[derive(Debug, clap::Args)]
pub(super) struct EmitArgs {
    #[command(flatten)]
    which: super::Which,
    /// The engine.
    #[arg(long, value_enum)]
    engine: Engine,
    /// Folder of the results, which every worker must see.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// What runs the chunks.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Engine {
    /// An array job, to be handed to sbatch.
    Slurm,
    /// A shell script that runs as many chunks at a time as there are cores.
    Parallel,
    /// A shell script that submits a task array.
    Hyperqueue,
}

/// A word of a shell command, quoted.
fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Prints the job file.
pub(super) fn emit(args: &EmitArgs) -> anyhow::Result<()> {
    let study = super::load(&args.which.study)?;
    let chunks = study.chunk_count();
    let last = chunks - 1;
    let (file, out) = (quoted(&args.which.study), quoted(&args.out.display().to_string()));
    let command =
        |chunk: &str| format!("barrelstack study run-chunk {file} --chunk {chunk} --out {out}");
    let collect = format!("barrelstack study collect {out}");
    let mut lines = vec!["#!/bin/sh".to_owned()];
    match args.engine {
        Engine::Slurm => lines.extend([
            format!("#SBATCH --array=0-{last}"),
            "#SBATCH --cpus-per-task=1".to_owned(),
            format!("# {chunks} chunks; when all are done: {collect}"),
            "set -eu".to_owned(),
            command("\"$SLURM_ARRAY_TASK_ID\""),
        ]),
        Engine::Parallel => lines.extend([
            "set -eu".to_owned(),
            format!("seq 0 {last} | parallel {}", quoted(&command("{}"))),
            collect,
        ]),
        Engine::Hyperqueue => lines.extend([
            "set -eu".to_owned(),
            format!(
                "hq submit --wait --array 0-{last} --cpus 1 -- sh -c {}",
                quoted(&command("\"$HQ_TASK_ID\""))
            ),
            collect,
        ]),
    }
    printer::lines(lines)
}
