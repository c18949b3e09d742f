//! `barrelstack completions` and `barrelstack man`: shell completions and manual pages.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::CommandFactory as _;
use clap_complete::Shell;

use crate::args::Args;
use crate::printer;
use crate::store::{folder, store, writable};

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub(crate) struct CompletionsArgs {
    /// Name of the shell.
    #[arg(value_enum)]
    shell: Shell,
}

/// Arguments of `man`.
#[derive(Debug, clap::Args)]
pub(crate) struct ManArgs {
    /// Folder for the pages, such as ~/.local/share/man/man1; pages with the same names are
    /// replaced.
    dir: PathBuf,
}

/// Prints the completion script of a shell.
pub(crate) fn completions(args: &CompletionsArgs) -> anyhow::Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "barrelstack", &mut script);
    printer::text(&String::from_utf8(script)?)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes one page for the program and one per subcommand.
pub(crate) fn man(args: &ManArgs) -> anyhow::Result<ExitCode> {
    folder(&args.dir)?;
    writable(&args.dir)?;
    let mut command = Args::command();
    command.build();
    let mut left = vec![command];
    let mut pages = 0;
    while let Some(command) = left.pop() {
        left.extend(command.get_subcommands().filter(|sub| sub.get_name() != "help").cloned());
        let page = clap_mangen::Man::new(command);
        let mut text = Vec::new();
        page.render(&mut text)?;
        store(&args.dir.join(page.get_filename()), &text)?;
        pages += 1;
    }
    printer::lines([format!("{}: {}", args.dir.display(), printer::counted(pages, "page"))])?;
    Ok(ExitCode::SUCCESS)
}
