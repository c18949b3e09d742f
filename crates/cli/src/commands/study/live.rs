//! Progress line of a running study, and handling of Ctrl-C, which keeps finished chunks.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use barrelstack_campaign::study::{Holder, Progress, holder};
use indicatif::ProgressBar;

use crate::interrupt::Interrupt;
use crate::printer;
use crate::progress::{Bar, Lines, Of, style};

/// Progress display and cancellation of a study.
pub(super) struct Live {
    bar: Bar,
    lines: Lines,
    /// `true` if the cases are a sample of the stated distributions, so that the share of collapsed cases estimates
    /// the probability of collapse.
    sample: bool,
    interrupt: Interrupt,
    damaged: AtomicUsize,
    healed: AtomicBool,
    waiting: Waiting,
}

/// Reports once which process holds the chunk for which this process waits, because a suspended
/// process holds its chunk indefinitely.
pub(super) struct Waiting {
    folder: PathBuf,
    /// The chunk, the start of the wait, and `true` if the wait was reported; `None` before the first wait.
    state: Mutex<Option<(usize, Instant, bool)>>,
}

/// Time to wait for a chunk before the process that holds the chunk is reported.
const PATIENCE: Duration = Duration::from_secs(5);

impl Waiting {
    /// Creates the state for the study in a folder; no wait has started.
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), state: Mutex::new(None) }
    }

    /// Continues the wait for a chunk, or starts it if the chunk is a new one. When the wait exceeds `PATIENCE`, a
    /// warning names the process that holds the chunk.
    ///
    /// `None` changes nothing. This function is called many times per second.
    pub(super) fn at(&self, chunk: Option<usize>) {
        let Ok(mut state) = self.state.lock() else { return };
        let Some(chunk) = chunk else { return };
        let known = state.filter(|(known, ..)| *known == chunk);
        let (_, since, said) = *state.insert(known.unwrap_or((chunk, Instant::now(), false)));
        if said || since.elapsed() < PATIENCE {
            return;
        }
        *state = Some((chunk, since, true));
        drop(state);
        if let Some(Holder { who, age }) = holder(&self.folder, chunk) {
            printer::warning(&format!(
                "waiting for chunk {chunk}, which {who} claimed {} ago; if that process is suspended or hangs, resume \
                 it (kill -CONT) or end it, so that another process can run the chunk",
                age_in_words(age)
            ));
        }
    }
}

/// Formats a duration for display, such as "40 s", "12 min" or "3 h".
fn age_in_words(age: Duration) -> String {
    match age.as_secs() {
        seconds @ ..120 => format!("{seconds} s"),
        seconds @ ..7200 => format!("{} min", seconds / 60),
        seconds => format!("{} h", seconds / 3600),
    }
}

impl Live {
    /// Starts the display, which shows a line only if requested and only on a terminal.
    pub(super) fn new(show: bool, sample: bool, folder: &Path) -> Self {
        let bar = Bar::new(show, || {
            let bar = ProgressBar::no_length();
            bar.set_style(style("{spinner} reading the motions"));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Self {
            bar,
            lines: Lines::new(show),
            sample,
            interrupt: Interrupt::listen(),
            damaged: AtomicUsize::new(0),
            healed: AtomicBool::new(false),
            waiting: Waiting::new(folder),
        }
    }

    /// Returns the number of shards that were damaged and set aside.
    pub(super) fn damaged(&self) -> usize {
        self.damaged.load(Ordering::Relaxed)
    }

    /// Returns `true` if the manifest was damaged and has been rewritten.
    pub(super) fn manifest_healed(&self) -> bool {
        self.healed.load(Ordering::Relaxed)
    }

    /// Shows the progress, and returns `Break` if the user requested a stop.
    pub(super) fn at(&self, progress: &Progress) -> ControlFlow<()> {
        self.damaged.store(progress.damaged, Ordering::Relaxed);
        self.healed.store(progress.manifest_healed, Ordering::Relaxed);
        self.waiting.at(progress.waits_for);
        self.interrupt.reached("cases", progress.now as f64);
        if let Some(bar) = &self.bar.0 {
            if bar.length().is_none() {
                bar.set_style(style(
                    "{spinner} {bar:30} {pos} of {len} cases, {per_sec}, {eta} to go; {msg}",
                ));
                bar.set_position(progress.before);
                // The rate counts only the cases of this run.
                bar.reset_eta();
            }
            bar.set_length(progress.cases);
            bar.set_position(progress.before + progress.now);
            if let Some((p, [low, high])) = progress.tally.collapse().filter(|_| self.sample) {
                let [p, low, high] = [p, low, high].map(|share| 100.0 * share);
                bar.set_message(format!("collapse {p:.0} % ({low:.0} to {high:.0} %)"));
            } else {
                let tally = progress.tally;
                bar.set_message(format!("{} of {} collapse", tally.collapsed, tally.judged));
            }
        }
        let left = progress.cases.saturating_sub(progress.before);
        self.lines.at(progress.now as f64, left as f64, Of::Many, || {
            format!("{} of {} cases", progress.before + progress.now, progress.cases)
        });
        self.interrupt.flow()
    }
}
