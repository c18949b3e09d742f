//! `barrelstack compare` of cellars: two or more layouts of rooms side by side.

use std::process::ExitCode;

use anyhow::bail;
use barrelstack::export::Folder;
use barrelstack::variants::RunChoice;
use barrelstack_cellar::comparison::{self, CellarComparison, Layout, LeftOut, words};
use barrelstack_cellar::{Cellar, Prepared};
use barrelstack_report::listed;

use super::compare::CompareArgs;
use crate::args::ScenarioArgs;
use crate::interrupt::Stopped;
use crate::printer;
use crate::progress::Progress;

/// Name of the layout without changes.
const AS_IT_IS: &str = "as it is";

/// Runs all layouts and writes the comparison.
///
/// `requested` holds the arguments of each given cellar; error messages refer to them.
pub(super) fn compare(
    args: &CompareArgs,
    requested: &[(String, ScenarioArgs)],
    given: Vec<(String, Cellar)>,
) -> anyhow::Result<ExitCode> {
    // All given rooms are checked first, so that a room that cannot be run is refused before another room runs for
    // minutes. The usual changes have been checked already.
    for ((_, cellar), (_, one)) in given.iter().zip(requested) {
        Prepared::new(cellar).map_err(|error| super::cellar::placed(error, cellar, one))?;
    }
    let (runs, left_out) = layouts(args, given)?;
    // The usual changes are changes of the first cellar.
    let of = |at: usize| &requested.get(at).unwrap_or(&requested[0]).1;
    let folder = Folder::prepare(&args.out, args.overwrite)?;
    let mut done = Vec::new();
    for (at, (name, cellar)) in runs.iter().enumerate() {
        let progress = Progress::new(!args.quiet);
        let answer = barrelstack_cellar::answer(cellar, RunChoice::Typical, &mut |reached| {
            progress.advance(reached)
        });
        drop(progress);
        let answer = answer.map_err(|error| super::cellar::placed(error, cellar, of(at)))?;
        if answer.is_stopped() {
            break;
        }
        done.push(Layout::of(name.clone(), &answer));
    }
    crate::interrupt::finished();
    if done.is_empty() {
        return Err(Stopped.into());
    }
    let unfinished = runs.iter().skip(done.len()).map(|(name, _)| name.clone()).collect();
    let found = comparison::compared(&done, unfinished, left_out);
    crate::interrupt::writes_to(folder.path());
    // The verdict is printed even if the files cannot be written.
    let page = args.language.page(&comparison::document(&done, &found));
    let written = folder.write_page(&page).map_err(anyhow::Error::from);
    let written = written
        .and_then(|()| Ok(folder.write_files(&args.tables.of(comparison::files(&found)?)?)?));
    printed(args, &found, &folder)?;
    written?;
    Ok(super::status(found.layouts.iter().any(|one| one.counted == 0)))
}

/// Prints the comparison.
fn printed(args: &CompareArgs, found: &CellarComparison, folder: &Folder) -> anyhow::Result<()> {
    if !found.unfinished.is_empty() {
        printer::note(&format!(
            "stopped before the end of {}: nothing is compared with it",
            listed(found.unfinished.iter().map(|name| format!("\"{name}\"")))
        ));
    }
    if args.json {
        printer::document(found)?;
    } else {
        let indented = |text: String| format!("  {text}");
        let mut lines = vec![found.headline.clone()];
        lines.extend(words::sentences(found).into_iter().map(indented));
        lines.push(String::new());
        lines.extend(comparison::table(found).to_lines().into_iter().map(indented));
        lines.extend([String::new(), format!("report: {}", folder.report().display())]);
        printer::lines(lines)?;
    }
    found.warnings.iter().for_each(|warning| printer::warning(warning));
    Ok(())
}

/// A cellar with its name in the comparison.
type Named = (String, Cellar);

/// Returns two lists: the layouts to run with their names, the given layouts first; and the usual changes that are not
/// run, with reasons.
fn layouts(args: &CompareArgs, given: Vec<Named>) -> anyhow::Result<(Vec<Named>, Vec<LeftOut>)> {
    let given: Vec<Named> = given
        .into_iter()
        .map(|(name, cellar)| match args.variants {
            Some(count) => (name, cellar.with_variants(count)),
            None => (name, cellar),
        })
        .collect();
    if given.len() > 1 || !args.usual {
        comparison::check(&given)?;
    }
    let mut names = comparison::labels(&given);
    if let (true, [name]) = (args.usual, names.as_mut_slice()) {
        AS_IT_IS.clone_into(name);
    }
    super::compare::name(&mut names, &args.label)?;
    let mut runs: Vec<(String, Cellar)> =
        names.into_iter().zip(given).map(|(name, (_, cellar))| (name, cellar)).collect();
    let mut left_out = Vec::new();
    let usual = if args.usual { comparison::usual(&runs[0].1) } else { Vec::new() };
    for change in usual {
        let changed = change.changed.and_then(|cellar| {
            let same = runs.iter().find(|(_, run)| run.fingerprint() == cellar.fingerprint());
            same.map_or(Ok(cellar), |(name, _)| {
                Err(format!("it is the same as the layout \"{name}\""))
            })
        });
        match changed {
            Ok(cellar) => runs.push((change.name, cellar)),
            Err(reason) => left_out.push(LeftOut { name: change.name, reason }),
        }
    }
    if runs.len() == 1 {
        let reasons = left_out.iter().map(|one| format!("{}: {}", one.name, one.reason));
        bail!(
            "none of the changes that --usual adds can be applied to this cellar ({}); use --against for another \
             change",
            reasons.collect::<Vec<_>>().join("; ")
        );
    }
    comparison::check(&runs)?;
    Ok((runs, left_out))
}
