//! Handling of Ctrl-C and other requests to terminate: work stops within a second, finished results
//! are kept, and a message states where the results are.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

use barrelstack_input::system;

use crate::printer;

/// `true` if the user requested a stop; global, because a program can have only one signal handler.
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// `true` if some task polls the stop request.
static LISTENS: AtomicBool = AtomicBool::new(false);

/// `true` if work has stopped on request, and its finished results are being kept.
static STOPPED: AtomicBool = AtomicBool::new(false);

/// `true` if all work is finished and its results are being written.
static FINISHED: AtomicBool = AtomicBool::new(false);

/// Description of the results that are kept if the program is terminated now.
static KEPT: Mutex<Option<String>> = Mutex::new(None);

/// Folders that may contain unfinished files.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Time that work has to react to a stop request. If it does not react, the program ends within one second of the
/// request; the rest of this second is left for the message that states which results are kept.
const GRACE: Duration = Duration::from_millis(600);

/// Time that stopped work has to print and write its finished results.
const KEEPING: Duration = Duration::from_secs(30);

/// Exit status of an interrupted program.
pub(crate) const STATUS: u8 = 130;

/// Handle through which a task polls for stop requests.
pub(crate) struct Interrupt;

/// Number of tasks that have started to listen for stop requests.
static TASKS: AtomicUsize = AtomicUsize::new(0);

/// Point of the work at which a test stops the program.
static STOP_POINT: OnceLock<Option<StopPoint>> = OnceLock::new();

/// Point of the work at which a test stops the program. Unlike a time, it does not depend on the
/// load of the machine.
///
/// The point `2:runs:3` is reached when three runs of the second task are finished.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StopPoint {
    work: usize,
    things: String,
    done: f64,
}

impl std::str::FromStr for StopPoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.splitn(3, ':');
        let mut next = || parts.next().unwrap_or_default();
        let (work, things, done) = (next(), next(), next());
        match (work.parse(), done.parse()) {
            (Ok(work), Ok(done)) if !things.is_empty() => {
                Ok(Self { work, things: things.to_owned(), done })
            }
            _ => Err("expected the number of a task, the things that it counts, and how many of them are done, \
                      separated by colons, such as 2:runs:3"
                .to_owned()),
        }
    }
}

/// Makes the program stop when its work reaches `point`, as if by a signal. `None` sets no such point.
pub(crate) fn stop_at(point: Option<StopPoint>) {
    // Only the first call has an effect, and there is only one.
    let _ = STOP_POINT.set(point);
}

/// Installs the signal handler of the program; `json` is `true` if the command prints a JSON document.
///
/// The first signal requests a stop. Work that does not poll for the request, or does not stop in time, is terminated;
/// work that stops has time to keep its finished results. A second signal terminates at once. Files are given their
/// final names only when they are complete, and unfinished files are removed.
pub(crate) fn watch(json: bool) {
    JSON.store(json, Ordering::Relaxed);
    // An error means that the system refuses the handler; Ctrl-C then terminates the program as usual.
    drop(ctrlc::set_handler(request_stop));
}

/// `true` if the command prints a JSON document.
static JSON: AtomicBool = AtomicBool::new(false);

/// Handles a signal.
fn request_stop() {
    let json = JSON.load(Ordering::Relaxed);
    if REQUESTED.swap(true, Ordering::Relaxed) || !LISTENS.load(Ordering::Relaxed) {
        end(json);
    }
    // The handler thread must be free for the second signal.
    std::thread::spawn(move || {
        std::thread::sleep(GRACE);
        if STOPPED.load(Ordering::Relaxed) || FINISHED.load(Ordering::Relaxed) {
            printer::note(
                "stopping; finished results are kept; a second Ctrl-C ends the program at once",
            );
            std::thread::sleep(KEEPING);
        }
        end(json);
    });
}

/// Terminates the program, after printing which results are kept and removing unfinished files.
#[expect(clippy::exit, reason = "the work does not stop by itself")]
fn end(json: bool) -> ! {
    system::write_no_more();
    let folders = FOLDERS.lock().map(|folders| folders.clone()).unwrap_or_default();
    for entry in
        folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten()
    {
        if entry.file_name().to_string_lossy().ends_with(&system::unfinished()) {
            // If the file was renamed meanwhile, it is complete and there is nothing to remove.
            let _ = std::fs::remove_file(entry.path());
        }
    }
    barrelstack_campaign::study::remove_drafts();
    printer::stopped(json);
    std::process::exit(i32::from(STATUS))
}

/// Returns `true` if work was stopped before it was finished.
pub(crate) fn has_stopped() -> bool {
    STOPPED.load(Ordering::Relaxed)
}

/// Records that all work is finished and that its results are being written. If a first signal arrives
/// from now on, [`KEEPING`] is the time that remains to write them.
pub(crate) fn finished() {
    FINISHED.store(true, Ordering::Relaxed);
}

/// Sets the description of the results that are kept if the program is terminated from now on.
pub(crate) fn keeps(words: String) {
    if let Ok(mut kept) = KEPT.lock() {
        *kept = Some(words);
    }
}

/// Registers a folder that may contain unfinished files.
pub(crate) fn writes_to(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if let Ok(mut folders) = FOLDERS.lock()
        && !folders.iter().any(|known| known == folder)
    {
        folders.push(folder.to_owned());
    }
}

/// Error that work returns when it has stopped on request. A message about the kept results has
/// already been printed.
#[derive(Debug)]
pub(crate) struct Stopped;

impl std::error::Error for Stopped {}

impl std::fmt::Display for Stopped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kept = KEPT.lock().ok().and_then(|kept| kept.clone());
        write!(f, "stopped; {}", kept.as_deref().unwrap_or("nothing was written"))
    }
}

impl Interrupt {
    /// Starts to listen for stop requests; earlier requests count too.
    pub(crate) fn listen() -> Self {
        LISTENS.store(true, Ordering::Relaxed);
        TASKS.fetch_add(1, Ordering::Relaxed);
        Self
    }

    /// Returns `true` if the user requested a stop; the work then counts as stopped.
    #[expect(clippy::unused_self, reason = "callers must listen first")]
    pub(crate) fn is_requested(&self) -> bool {
        let requested = REQUESTED.load(Ordering::Relaxed);
        if requested {
            STOPPED.store(true, Ordering::Relaxed);
        }
        requested
    }

    /// Reports the progress of work on `things`, for tests that stop the work at a certain point.
    #[expect(clippy::unused_self, reason = "callers must listen first")]
    pub(crate) fn reached(&self, things: &str, done: f64) {
        let Some(Some(point)) = STOP_POINT.get() else { return };
        let here = point.work == TASKS.load(Ordering::Relaxed)
            && things.contains(&point.things)
            && done >= point.done;
        if here && !REQUESTED.load(Ordering::Relaxed) {
            request_stop();
        }
    }

    /// Returns `Break` if a stop was requested; otherwise, `Continue`.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
