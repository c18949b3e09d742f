//! Growth of studies: only new cases are run, and the table is that of a study of the larger size.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;

use crate::common::HEAD;
use barrelstack::ensemble::Width;
use barrelstack_campaign::study::{ChunkRun, Progress, RunOptions, Study, StudyError, holder};

/// Two barrels on two levels, shaken briefly.
fn text(count: u32, motions: &str, intensity: &str, design: &str) -> String {
    format!(
        "{HEAD}duration = \"0.3 s\"\n\
         [[factor]]\nname = \"friction on the ground\"\nfield = \"interface.rack-ground.friction.coefficient\"\n\
         distribution = {{ kind = \"uniform\", from = 0.2, to = 0.6 }}\n\
         {motions}\n{intensity}\n[design]\nkind = \"{design}\"\nchunk = 20\n{}",
        if design == "stripes" { String::new() } else { format!("count = {count}\n") }
    )
}

const PULSE: &str =
    "[[motion]]\npulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.25 s\" }\n";

fn synthetic(count: u32) -> String {
    format!(
        "[[motion]]\nsynthetic = {{ kind = \"clough-penzien\", duration = \"0.3 s\", rise = \"0.05 s\", decay = \"0.1 s\", count = {count} }}\n"
    )
}

/// Runs a study and returns the number of cases run, and the bytes of its table.
fn run(text: &str, folder: &Path) -> (u64, [Vec<u8>; 4]) {
    let study = Study::parse("test.toml", text).unwrap();
    let last = Mutex::new(Progress::default());
    let report = |progress: &Progress| {
        *last.lock().unwrap() = *progress;
        ControlFlow::Continue(())
    };
    study.run(folder, &RunOptions::default(), &report).unwrap();
    let files = ["table.csv", "table.parquet", "provenance.json", "columns.csv"];
    let now = last.lock().unwrap().now;
    (now, files.map(|name| std::fs::read(folder.join(name)).unwrap()))
}

#[test]
fn more_points_run_only_the_new_ones_and_give_the_table_of_a_fresh_study() {
    let folder = tempfile::tempdir().unwrap();
    let grown = folder.path().join("grown");
    for (count, new) in [(320, 320), (640, 320), (1280, 640)] {
        let text = text(count, PULSE, "", "sobol");
        let (ran, table) = run(&text, &grown);
        assert_eq!(ran, new, "of {count} cases");
        let (_, fresh) = run(&text, &folder.path().join(count.to_string()));
        assert!(table == fresh, "{count} cases: not the bytes of a fresh study");
    }
}

#[test]
fn more_motions_run_only_the_new_ones_and_give_the_table_of_a_fresh_study() {
    let folder = tempfile::tempdir().unwrap();
    let grown = folder.path().join("grown");
    let levels = "[intensity]\nmeasure = \"pgv\"\nlevels = [\"20 cm/s\", \"40 cm/s\", \"60 cm/s\", \"80 cm/s\", \"100 cm/s\"]\n";
    for (motions, new) in [(24, 120), (30, 30)] {
        let text = text(0, &synthetic(motions), levels, "stripes");
        let (ran, table) = run(&text, &grown);
        assert_eq!(ran, new, "under {motions} motions");
        let (_, fresh) = run(&text, &folder.path().join(motions.to_string()));
        assert!(table == fresh, "{motions} motions: not the bytes of a fresh study");
    }
}

#[test]
fn what_every_case_depends_on_may_not_change_and_the_refusal_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let first = text(40, PULSE, "", "sobol");
    run(&first, folder.path());
    let refused = |text: &str| {
        let study = Study::parse("test.toml", text).unwrap();
        let error =
            study.run(folder.path(), &RunOptions::default(), &|_| ControlFlow::Continue(()));
        let Err(StudyError::Folder { reason, .. }) = error else { panic!("it ran: {text}") };
        reason
    };
    for (from, to, named) in [
        ("to = 0.6", "to = 0.7", "a [[factor]] has changed"),
        ("levels = 2", "levels = 1", "the scenario in [base] has changed"),
        ("chunk = 20", "chunk = 10", "[design] has changed"),
        ("seed = 7", "seed = 8", "its seed is 7, and the seed of this study is 8"),
        ("1 g", "2 g", "the motion"),
    ] {
        let reason = refused(&first.replace(from, to));
        assert!(reason.contains(named), "{named}: {reason}");
    }
    // Running a single chunk does not accept a changed study.
    let study = Study::parse("test.toml", &first.replace("count = 40", "count = 60")).unwrap();
    let reason =
        study.run_chunk(folder.path(), 2, Width::widest(), &|| false).unwrap_err().to_string();
    assert!(reason.contains("run the whole study once"), "{reason}");
    // A damaged shard is replaced when its chunk is run alone.
    let study = Study::parse("test.toml", &first).unwrap();
    let shard = std::fs::read_dir(folder.path().join("shards")).unwrap().next().unwrap().unwrap();
    std::fs::write(shard.path(), b"no shard").unwrap();
    let chunk = shard.file_name().to_string_lossy()[..6].parse().unwrap();
    let run = || study.run_chunk(folder.path(), chunk, Width::widest(), &|| false).unwrap();
    assert_eq!([run(), run()], [ChunkRun::Again, ChunkRun::Before]);
}

/// Returns the paths of the shards of a chunk, sorted by name.
fn shards(folder: &Path, chunk: &str) -> Vec<std::path::PathBuf> {
    let all = std::fs::read_dir(folder.join("shards")).unwrap();
    let mut found: Vec<_> = all.map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.file_name().unwrap().to_string_lossy().starts_with(chunk));
    found
}

#[test]
fn what_an_older_process_writes_into_a_grown_folder_is_run_again() {
    let (small, large) = (text(30, PULSE, "", "sobol"), text(40, PULSE, "", "sobol"));
    let folder = tempfile::tempdir().unwrap();
    let (old, grown) = (folder.path().join("old"), folder.path().join("grown"));
    run(&small, &old);
    let foreign = shards(&old, "000001").remove(0);
    let (_, table) = run(&large, &grown);
    let good = shards(&grown, "000001").remove(0);
    std::fs::remove_file(&good).unwrap();
    let stale = grown.join("shards").join(foreign.file_name().unwrap());
    std::fs::copy(&foreign, &stale).unwrap();
    let (ran, again) = run(&large, &grown);
    assert_eq!(ran, 20);
    assert!(again == table);
    assert!(good.is_file() && !stale.exists());
    // Next to the right shard it has no effect, and nothing is run.
    std::fs::copy(&foreign, &stale).unwrap();
    let (ran, again) = run(&large, &grown);
    assert!(ran == 0 && again == table && !stale.exists());
    std::fs::remove_file(&good).unwrap();
    std::fs::copy(&foreign, &stale).unwrap();
    let study = Study::parse("test.toml", &large).unwrap();
    assert_eq!(study.run_chunk(&grown, 1, Width::widest(), &|| false).unwrap(), ChunkRun::Now);
    assert!(good.is_file() && !stale.exists());
}

#[test]
fn a_process_whose_study_grew_meanwhile_ends_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let (out, grown) = (folder.path().join("out"), folder.path().join("grown"));
    run(&text(80, PULSE, "", "sobol"), &grown);
    let study = Study::parse("test.toml", &text(60, PULSE, "", "sobol")).unwrap();
    let report = |progress: &Progress| {
        if progress.now == 1 {
            std::fs::copy(grown.join("study.json"), out.join("study.json")).unwrap();
        }
        ControlFlow::Continue(())
    };
    let options = RunOptions { threads: std::num::NonZero::new(1), ..RunOptions::default() };
    let error = study.run(&out, &options, &report).unwrap_err().to_string();
    assert!(
        error.contains("holds a larger version of the study, which was started after this run"),
        "{error}"
    );
}

#[test]
fn a_shard_that_is_damaged_while_a_study_runs_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let study = Study::parse("test.toml", &text(60, PULSE, "", "sobol")).unwrap();
    let damaged = folder.path().join("shards/000002-0000000000000000.parquet");
    let last = Mutex::new(Progress::default());
    let report = |progress: &Progress| {
        if progress.now == 1 {
            std::fs::write(&damaged, "no shard").unwrap();
        }
        *last.lock().unwrap() = *progress;
        ControlFlow::Continue(())
    };
    let options = RunOptions { threads: std::num::NonZero::new(1), ..RunOptions::default() };
    let collected = study.run(folder.path(), &options, &report).unwrap();
    let last = last.lock().unwrap();
    assert_eq!((last.damaged, last.now, collected.table.rows()), (1, 60, 60));
    assert!(damaged.with_extension("damaged").is_file() && !damaged.exists());
}

#[test]
fn who_waits_for_a_chunk_of_a_stopped_process_learns_its_name() {
    let study = Study::parse("test.toml", &text(40, PULSE, "", "sobol")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    study.run_chunk(folder.path(), 1, Width::widest(), &|| false).unwrap();
    // A process that is stopped keeps its claim locked and does nothing.
    let claim = folder.path().join("shards").join("000000.claim");
    std::fs::write(&claim, "process 4711 on cellar").unwrap();
    let stopped = Mutex::new(Some(std::fs::File::open(&claim).unwrap()));
    stopped.lock().unwrap().as_ref().unwrap().lock().unwrap();
    let found = Mutex::new(None);
    let report = |progress: &Progress| {
        if let Some(chunk) = progress.waits_for {
            *found.lock().unwrap() = Some((chunk, holder(folder.path(), chunk).unwrap()));
            // The process ends, which releases its claim.
            stopped.lock().unwrap().take();
        }
        ControlFlow::Continue(())
    };
    let options = RunOptions { threads: std::num::NonZero::new(1), lanes: None };
    study.run(folder.path(), &options, &report).unwrap();
    let (chunk, holder) = found.into_inner().unwrap().expect("it waits");
    assert_eq!((chunk, holder.who.as_str()), (0, "process 4711 on cellar"));
    assert!(folder.path().join("table.csv").is_file());
}
