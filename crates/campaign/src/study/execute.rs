//! Runs chunks: one of them, or all that are missing, on all cores.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::Study;
use super::claim::Claim;
use super::collect::{Collected, collect};
use super::error::StudyError;
use super::folder::{Folder, read_shard};
use super::motions::Shelf;
use super::prepare::Bench;
use super::stop::{StopRule, Tally};
use super::table::StudyTable;
use crate::ensemble::CaseResult;
use crate::pool;

/// How long (s) to wait for chunks that others have claimed before looking again.
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// How a study is run.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOptions {
    /// Threads; as many as there are cores without.
    pub threads: Option<NonZero<usize>>,
}

/// How far a study is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Cases in all; of an adaptive design, at most.
    pub cases: u64,
    /// Cases of chunks that others did: earlier runs, and those beside this one.
    pub before: u64,
    /// Cases that this run has done.
    pub now: u64,
    /// How the cases of both ended.
    pub tally: Tally,
    /// Chunks in all; of an adaptive design, at most.
    pub chunks: usize,
    /// Chunks that are done.
    pub chunks_done: usize,
    /// Damaged shards that were found and set aside; their chunks are run again.
    pub damaged: usize,
}

/// What threads share.
struct Shared<'a> {
    study: &'a Study,
    folder: &'a Folder,
    shelf: Shelf,
    /// What tells the motions from all others.
    motions: Vec<u64>,
    rule: Option<StopRule>,
    stop: AtomicBool,
    state: Mutex<State>,
    tell: &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync),
}

/// What threads take turns with.
struct State {
    /// Chunks that nobody here has taken, the next one last.
    open: Vec<usize>,
    /// Those of them that another process has claimed.
    elsewhere: Vec<usize>,
    /// How the cases of each chunk that is done ended.
    done: BTreeMap<usize, Tally>,
    progress: Progress,
    failed: Option<StudyError>,
    /// Whether the caller asked to stop.
    interrupted: bool,
}

impl Study {
    /// Runs all chunks that are missing from a folder, collects the table and reads it.
    ///
    /// # Errors
    /// As [`Study::run_all`].
    pub fn run(
        &self,
        folder: &Path,
        options: &RunOptions,
        tell: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync),
    ) -> Result<Collected, StudyError> {
        self.run_all(folder, options, tell)?;
        collect(folder, &mut |_, _| Ok(()))?;
        Collected::read(folder)
    }

    /// Runs all chunks that are missing from a folder; other processes may do so at the same time, and each chunk
    /// is run by one of them.
    ///
    /// `tell` hears of every case that is done, from several threads, and may stop the run; what was done until then is
    /// kept, and the next run goes on from there.
    /// How many threads there are changes nothing about the table.
    ///
    /// # Errors
    /// When a motion cannot be read, the folder belongs to something else, a file cannot be written, and
    /// [`StudyError::Stopped`] when `tell` stopped it.
    pub fn run_all(
        &self,
        folder: &Path,
        options: &RunOptions,
        tell: &(dyn Fn(&Progress) -> ControlFlow<()> + Sync),
    ) -> Result<(), StudyError> {
        let shelf = Shelf::default();
        // Before the folder is made: a study that cannot run leaves none behind.
        self.try_motions(&shelf)?;
        let place = Folder::open(folder, self, true)?;
        place.clean()?;
        let (done, damaged) = self.done(&place)?;
        let rule = self.stop_rule();
        let mut progress =
            Progress { cases: self.cases(), chunks: self.chunk_count(), ..Progress::default() };
        progress.tally = done.values().fold(Tally::default(), |sum, tally| sum.plus(*tally));
        progress.before = progress.tally.cases;
        progress.chunks_done = done.len();
        progress.damaged = damaged;
        let open: Vec<usize> =
            (0..self.chunk_count()).rev().filter(|chunk| !done.contains_key(chunk)).collect();
        let threads = options.threads.or_else(|| std::thread::available_parallelism().ok());
        let threads = threads.map_or(1, NonZero::get).min(open.len()).max(1);
        let state =
            State { open, elsewhere: Vec::new(), done, progress, failed: None, interrupted: false };
        let shared = Shared {
            study: self,
            folder: &place,
            shelf,
            motions: self.motion_keys()?,
            rule,
            stop: AtomicBool::new(false),
            state: Mutex::new(state),
            tell,
        };
        if tell(&progress).is_break() {
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
        if state.interrupted {
            return Err(StudyError::Stopped);
        }
        // What others that were killed beside this run left behind.
        place.clean()
    }

    /// Runs all its cases and keeps their table in memory.
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
    /// When a motion cannot be read.
    pub fn table(&self) -> Result<StudyTable, StudyError> {
        let shelf = Shelf::default();
        self.try_motions(&shelf)?;
        let chunks: Vec<usize> = (0..self.chunk_count()).collect();
        let compute = |chunk: &usize| {
            let mut bench = Bench { shelf: &shelf, tell: &mut |_| {}, stop: &|| false };
            self.compute(*chunk, &mut bench)?.ok_or(StudyError::Stopped)
        };
        let rule = self.stop_rule();
        // Without a rule all at once; with one, no chunk is begun that may not be needed.
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

    /// Runs one chunk and writes its shard; false when it was there already, or another process has made it
    /// meanwhile.
    ///
    /// # Errors
    /// When there is no such chunk, or as [`Study::run`].
    pub fn run_chunk(
        &self,
        folder: &Path,
        chunk: usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<bool, StudyError> {
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
        if self.sound(&place, chunk)?.is_some() {
            return Ok(false);
        }
        let mut bench = Bench { shelf: &Shelf::default(), tell: &mut |_| {}, stop };
        let table = self.compute(chunk, &mut bench)?.ok_or(StudyError::Stopped)?;
        place.write_shard(chunk, self.chunk_key(chunk, &self.motion_keys()?), &table)?;
        Ok(true)
    }

    /// How the cases of each chunk that is done ended, and how many shards are damaged: they are set aside under
    /// another name, and their chunks are not done.
    fn done(&self, folder: &Folder) -> Result<(BTreeMap<usize, Tally>, usize), StudyError> {
        let mut done = BTreeMap::new();
        let mut damaged = 0;
        let shards = folder.shards()?.into_iter();
        for (chunk, path) in shards.filter(|(chunk, _)| *chunk < self.chunk_count()) {
            match self.tally_of(&path)? {
                Some(tally) => drop(done.insert(chunk, tally)),
                None => damaged += 1,
            }
        }
        Ok((done, damaged))
    }

    /// How the cases of a chunk ended; none where it has no sound shard, and a damaged one is set aside.
    fn sound(&self, folder: &Folder, chunk: usize) -> Result<Option<Tally>, StudyError> {
        folder.shard(chunk)?.map_or(Ok(None), |path| self.tally_of(&path))
    }

    fn tally_of(&self, shard: &Path) -> Result<Option<Tally>, StudyError> {
        match read_shard(shard, &self.columns()) {
            Ok(table) => Ok(Some(Tally::of(&table))),
            Err(StudyError::Shard { path, .. }) => set_aside(&path).map(|()| None),
            Err(error) => Err(error),
        }
    }
}

/// Gives a damaged shard another name, so that its chunk is run again and nothing is lost.
fn set_aside(path: &Path) -> Result<(), StudyError> {
    std::fs::rename(path, path.with_extension("damaged"))
        .map_err(|error| StudyError::system("set aside the damaged shard", path, &error))
}

impl Shared<'_> {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes chunks until there are none, or none are needed.
    fn work(&self) {
        while !self.stop.load(Ordering::Relaxed) {
            let Some(chunk) = self.take() else { return };
            if let Err(error) = self.claimed(chunk) {
                self.stop.store(true, Ordering::Relaxed);
                self.state().failed.get_or_insert(error);
            }
        }
    }

    /// The next chunk; none when the chunks without a gap are enough.
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
            drop(state);
            // Their owners finish them, or die and leave them to us.
            std::thread::sleep(LOOK_AGAIN);
            state = self.state();
            self.tell(&mut state);
        }
        state.open.pop()
    }

    /// Runs a chunk, unless another process has it or has done it.
    fn claimed(&self, chunk: usize) -> Result<(), StudyError> {
        let Some(claim): Option<Claim> = self.folder.claim(chunk)? else {
            self.state().elsewhere.push(chunk);
            return Ok(());
        };
        if let Some(tally) = self.study.sound(self.folder, chunk)? {
            let mut state = self.state();
            state.progress.before += tally.cases;
            state.progress.tally = state.progress.tally.plus(tally);
            state.progress.chunks_done += 1;
            state.done.insert(chunk, tally);
            self.tell(&mut state);
            return Ok(());
        }
        self.chunk(chunk)?;
        drop(claim);
        Ok(())
    }

    fn chunk(&self, chunk: usize) -> Result<(), StudyError> {
        let mut tell = |result: &CaseResult| self.case_done(result);
        let stop = || self.stop.load(Ordering::Relaxed);
        let mut bench = Bench { shelf: &self.shelf, tell: &mut tell, stop: &stop };
        let Some(table) = self.study.compute(chunk, &mut bench)? else { return Ok(()) };
        self.folder.write_shard(chunk, self.study.chunk_key(chunk, &self.motions), &table)?;
        let mut state = self.state();
        state.done.insert(chunk, Tally::of(&table));
        state.progress.chunks_done += 1;
        Ok(())
    }

    fn case_done(&self, result: &CaseResult) {
        let mut state = self.state();
        state.progress.now += 1;
        state.progress.tally.add(result.outcome.as_ref().map_or("error", |outcome| outcome.kind()));
        self.tell(&mut state);
    }

    fn tell(&self, state: &mut State) {
        if (self.tell)(&state.progress).is_break() {
            state.interrupted = true;
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}
