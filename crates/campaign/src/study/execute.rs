//! Runs the chunks of a study: one chunk, or all chunks that are missing from a folder, on all cores.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::num::NonZero;
use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::Study;
use super::collect::{Collected, collect};
use super::error::StudyError;
use super::folder::{Folder, read_shard};
use super::grow::Keys;
use super::motions::MotionCache;
use super::prepare::Resources;
use super::stop::{StopRule, Tally};
use super::table::StudyTable;
use crate::ensemble::{CaseResult, Width};
use crate::pool;

/// Polling interval while other processes hold the remaining chunks.
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// Options of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOptions {
    /// Number of threads; `None` for the number of cores.
    pub threads: Option<NonZero<usize>>,
    /// Vector width for the cases; `None` for the widest that the machine supports. The table does not depend
    /// on it.
    pub lanes: Option<Width>,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Total number of cases; for an adaptive design, the maximum number.
    pub cases: u64,
    /// Number of cases in chunks that were finished by earlier or concurrent runs.
    pub before: u64,
    /// Number of cases that this run finished.
    pub now: u64,
    /// Numbers of all finished cases by outcome.
    pub tally: Tally,
    /// Total number of chunks; for an adaptive design, the maximum number.
    pub chunks: usize,
    /// Number of finished chunks.
    pub chunks_done: usize,
    /// Number of damaged shards that were set aside, so that their chunks are run again.
    pub damaged: usize,
    /// `true` if the manifest of the folder was damaged and has been rewritten.
    pub manifest_healed: bool,
    /// Index of a chunk for which this run waits, because another process is running that chunk and this process has no
    /// other chunk left to run.
    pub waits_for: Option<usize>,
}

/// Result of [`Study::run_chunk`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChunkRun {
    /// The chunk was not run, because its shard existed or another process wrote it in the meantime.
    Before,
    /// The chunk was run.
    Now,
    /// The damaged shard of the chunk was set aside, and the chunk was run again.
    Again,
}

/// Finished chunks in a folder.
#[derive(Default)]
struct Done {
    /// Numbers of cases by outcome, for each chunk with an intact shard.
    tallies: BTreeMap<usize, Tally>,
    /// Number of damaged shards that were set aside.
    damaged: usize,
}

/// Data shared by the threads of a run.
struct Shared<'a> {
    study: &'a Study,
    folder: &'a Folder,
    cache: MotionCache,
    /// Keys that identify the shards of the study.
    keys: Keys,
    lanes: Width,
    rule: Option<StopRule>,
    stop: AtomicBool,
    state: Mutex<State>,
    report: &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync),
}

/// State of a run that all its threads share, protected by a mutex.
struct State {
    /// Chunks that no thread of this process has taken. The next chunk to be taken is the last element.
    open: Vec<usize>,
    /// Chunks that other processes have claimed.
    elsewhere: Vec<usize>,
    /// Numbers of cases by outcome, for each finished chunk.
    done: BTreeMap<usize, Tally>,
    progress: Progress,
    /// First error, which ends the run early.
    failed: Option<StudyError>,
}

impl Study {
    /// Runs all chunks that are missing from a folder, writes the table and returns it.
    ///
    /// # Errors
    /// As for [`Study::run_all`].
    pub fn run(
        &self,
        folder: &Path,
        options: &RunOptions,
        report: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync),
    ) -> Result<Collected, StudyError> {
        self.run_all(folder, options, report)?;
        collect(folder, &mut |_, _| Ok(()))?;
        Collected::read(folder)
    }

    /// Runs all chunks that are missing from a folder.
    ///
    /// Several processes may run the same study in a folder at the same time; each chunk is run by a single
    /// process.
    ///
    /// `report` is called from several threads, after each case and many times a second in between. It cancels the run
    /// by returning [`ControlFlow::Break`]. Finished chunks are kept, so that the next run resumes from them. The table
    /// does not depend on the number of threads.
    ///
    /// # Errors
    /// If a motion cannot be read, the folder belongs to another study, or a file cannot be written;
    /// [`StudyError::Stopped`] if `report` canceled the run.
    pub fn run_all(
        &self,
        folder: &Path,
        options: &RunOptions,
        report: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync),
    ) -> Result<(), StudyError> {
        let cache = MotionCache::default();
        // All motions are read before the folder is created, so that a study that cannot run leaves no folder behind.
        self.try_motions(&cache)?;
        let place = Folder::open(folder, self, true)?;
        place.clean()?;
        let keys = self.keys()?;
        let Done { tallies: done, damaged } = self.done(&place, 0..self.chunk_count(), &keys)?;
        // Shards of other studies are set aside by now, so that the new manifest describes only shards of this one.
        place.describe(self)?;
        let rule = self.stop_rule();
        let mut progress =
            Progress { cases: self.cases(), chunks: self.chunk_count(), ..Progress::default() };
        progress.tally = done.values().fold(Tally::default(), |sum, tally| sum.plus(*tally));
        progress.before = progress.tally.cases;
        progress.chunks_done = done.len();
        progress.damaged = damaged;
        progress.manifest_healed = place.healed;
        let open: Vec<usize> =
            (0..self.chunk_count()).rev().filter(|chunk| !done.contains_key(chunk)).collect();
        let threads = options.threads.or_else(|| std::thread::available_parallelism().ok());
        let threads = threads.map_or(1, NonZero::get).min(open.len()).max(1);
        let state = State { open, elsewhere: Vec::new(), done, progress, failed: None };
        let shared = Shared {
            study: self,
            folder: &place,
            cache,
            keys,
            lanes: options.lanes.unwrap_or_else(Width::widest),
            rule,
            stop: AtomicBool::new(false),
            state: Mutex::new(state),
            report,
        };
        if report(&progress).is_break() {
            return Err(StudyError::Stopped);
        }
        std::thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(|| shared.work());
            }
            shared.work();
        });
        let state = shared.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = state.failed {
            return Err(error);
        }
        // Remove files that concurrent runs left behind when they were killed.
        place.clean()
    }

    /// Runs all cases in memory and returns their table.
    ///
    /// ```
    /// use barrelstack_campaign::study::Study;
    ///
    /// let study = Study::parse(
    ///     "friction.toml",
    ///     r#"
    ///     schema = 1
    ///     [base]
    ///     extends = "sliding-block"
    ///     [[factor]]
    ///     field = "interface.block-ground.friction.coefficient"
    ///     values = [0.2, 0.4]
    ///     [design]
    ///     kind = "full-factorial"
    ///     "#,
    /// )?;
    /// let table = study.table()?;
    /// println!("{}", table.to_csv());
    /// assert_eq!(table.rows(), 2);
    /// # Ok::<(), barrelstack_campaign::study::StudyError>(())
    /// ```
    ///
    /// # Errors
    /// If a motion cannot be read.
    pub fn table(&self) -> Result<StudyTable, StudyError> {
        let cache = MotionCache::default();
        self.try_motions(&cache)?;
        let chunks: Vec<usize> = (0..self.chunk_count()).collect();
        let compute = |chunk: &usize| {
            let mut resources = Resources {
                cache: &cache,
                lanes: Width::widest(),
                report: &mut |_| {},
                stop: &|| false,
            };
            self.compute(*chunk, &mut resources)?.ok_or(StudyError::Stopped)
        };
        let rule = self.stop_rule();
        // Without a stopping rule all chunks run at once. With a stopping rule they run one at a time, since later
        // chunks may not be needed.
        let together = if rule.is_some() { 1 } else { chunks.len().max(1) };
        let (mut parts, mut tally) = (Vec::new(), Tally::default());
        for chunks in chunks.chunks(together) {
            for part in pool::map(chunks, compute, &|_| ()) {
                let part = part?;
                tally = tally.plus(Tally::of(&part));
                parts.push(part);
            }
            if rule.is_some_and(|rule| rule.met(tally)) {
                break;
            }
        }
        StudyTable::join(&self.columns(), &parts)
    }

    /// Runs one chunk with a vector width and writes its shard, unless the shard exists.
    ///
    /// # Errors
    /// If there is no such chunk, or as for [`Study::run`].
    pub fn run_chunk(
        &self,
        folder: &Path,
        chunk: usize,
        lanes: Width,
        stop: &dyn Fn() -> bool,
    ) -> Result<ChunkRun, StudyError> {
        let chunks = self.chunk_count();
        if chunk >= chunks {
            return Err(StudyError::Chunk(format!(
                "the study has no chunk {chunk}; its {chunks} chunks are numbered from 0 to {}",
                chunks - 1
            )));
        }
        let place = Folder::open(folder, self, false)?;
        let _claim = loop {
            if let Some(claim) = place.claim(chunk)? {
                break claim;
            }
            if stop() {
                return Err(StudyError::Stopped);
            }
            std::thread::sleep(LOOK_AGAIN);
        };
        let keys = self.keys()?;
        let found = self.done(&place, chunk..chunk + 1, &keys)?;
        if !found.tallies.is_empty() {
            return Ok(ChunkRun::Before);
        }
        let mut resources =
            Resources { cache: &MotionCache::default(), lanes, report: &mut |_| {}, stop };
        let table = self.compute(chunk, &mut resources)?.ok_or(StudyError::Stopped)?;
        place.write_shard(chunk, self.chunk_key(chunk, &keys), &table)?;
        Ok(if found.damaged > 0 { ChunkRun::Again } else { ChunkRun::Now })
    }

    /// Determines which of the given chunks are finished in a folder.
    ///
    /// A shard is set aside, and its chunk counts as not finished, if the shard is damaged or does not
    /// contain the current cases of its chunk. A shard without the current cases was written before the study
    /// grew, possibly by a process that is still running.
    fn done(&self, folder: &Folder, chunks: Range<usize>, keys: &Keys) -> Result<Done, StudyError> {
        let (mut done, specs) = (Done::default(), self.columns());
        for (chunk, path) in folder.shards()?.into_iter().filter(|(n, _)| chunks.contains(n)) {
            match read_shard(&path, &specs) {
                Ok((table, Some(key))) if key == self.chunk_key(chunk, keys) => {
                    done.tallies.insert(chunk, Tally::of(&table));
                }
                Ok(_) => set_aside(&path, "replaced")?,
                // Another process has set the shard aside in the meantime.
                Err(_) if !path.exists() => {}
                Err(StudyError::Shard { .. }) => {
                    done.damaged += 1;
                    set_aside(&path, "damaged")?;
                }
                Err(error) => return Err(error),
            }
        }
        Ok(done)
    }
}

/// Renames a shard, so that its chunk is run again and its data are kept.
///
/// If another process has already renamed the shard, this is not an error.
fn set_aside(path: &Path, ending: &str) -> Result<(), StudyError> {
    match std::fs::rename(path, path.with_extension(ending)) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(StudyError::system("set aside the shard", path)(error))
        }
        _ => Ok(()),
    }
}

impl Shared<'_> {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs chunks until no chunk is left or needed.
    fn work(&self) {
        while !self.stop.load(Ordering::Relaxed) {
            let Some(chunk) = self.take() else { return };
            if let Err(error) = self.claimed(chunk) {
                self.stop.store(true, Ordering::Relaxed);
                self.state().failed.get_or_insert(error);
            }
        }
    }

    /// Takes the next chunk; `None` if no chunk is left, or if the finished chunks before the first unfinished chunk
    /// satisfy the stopping rule.
    fn take(&self) -> Option<usize> {
        let mut state = self.state();
        if let Some(rule) = self.rule {
            let mut tally = Tally::default();
            for chunk in 0.. {
                let Some(done) = state.done.get(&chunk) else { break };
                tally = tally.plus(*done);
                if rule.met(tally) {
                    return None;
                }
            }
        }
        if state.open.is_empty() && !state.elsewhere.is_empty() {
            state.open = std::mem::take(&mut state.elsewhere);
            state.progress.waits_for = state.open.last().copied();
            drop(state);
            // The processes that hold the chunks finish them, or die and release their claims.
            std::thread::sleep(LOOK_AGAIN);
            state = self.state();
            self.report_progress(&mut state);
            state.progress.waits_for = None;
        }
        state.open.pop()
    }

    /// Claims and runs a chunk, unless another process has claimed or finished it.
    fn claimed(&self, chunk: usize) -> Result<(), StudyError> {
        let Some(_claim) = self.folder.claim(chunk)? else {
            self.state().elsewhere.push(chunk);
            return Ok(());
        };
        let mut found = self.study.done(self.folder, chunk..chunk + 1, &self.keys)?;
        let mut state = self.state();
        state.progress.damaged += found.damaged;
        if let Some(tally) = found.tallies.remove(&chunk) {
            state.progress.before += tally.cases;
            state.progress.tally = state.progress.tally.plus(tally);
            state.progress.chunks_done += 1;
            state.done.insert(chunk, tally);
            self.report_progress(&mut state);
            return Ok(());
        }
        drop(state);
        let mut on_case = |result: &CaseResult| self.case_done(result);
        let stop = || {
            self.report_progress(&mut self.state());
            self.stop.load(Ordering::Relaxed)
        };
        let mut resources =
            Resources { cache: &self.cache, lanes: self.lanes, report: &mut on_case, stop: &stop };
        let Some(table) = self.study.compute(chunk, &mut resources)? else { return Ok(()) };
        self.folder.write_shard(chunk, self.study.chunk_key(chunk, &self.keys), &table)?;
        let mut state = self.state();
        state.done.insert(chunk, Tally::of(&table));
        state.progress.chunks_done += 1;
        Ok(())
    }

    fn case_done(&self, result: &CaseResult) {
        let mut state = self.state();
        state.progress.now += 1;
        state.progress.tally.add(result.outcome.as_ref().map_or("error", |outcome| outcome.kind()));
        self.report_progress(&mut state);
    }

    fn report_progress(&self, state: &mut State) {
        if (self.report)(&state.progress).is_break() {
            state.failed.get_or_insert(StudyError::Stopped);
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}
