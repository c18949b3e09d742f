//! Ctrl-C, and what else asks a program to end: within a second work has stopped, what is finished is kept, and what
//! that is has been said.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

use barrelstack_input::system;

use crate::printer;

/// Whether the user asked to stop; of the whole program, which can have one handler only.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether there is work that looks at it.
static LISTENS: AtomicBool = AtomicBool::new(false);

/// Whether work has stopped since, and what is finished of it is being kept.
static STOPPED: AtomicBool = AtomicBool::new(false);

/// Whether all work is finished, and what came of it is being written.
static FINISHED: AtomicBool = AtomicBool::new(false);

/// What is kept when the program is ended in the middle of work.
static KEPT: Mutex<Option<String>> = Mutex::new(None);

/// Folders in which files may lie that are not finished.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Time for work to notice that it is to stop; what is left of a second is for saying what is kept.
const GRACE: Duration = Duration::from_millis(600);

/// Time for work that stops to print and write what is finished.
const KEEPING: Duration = Duration::from_secs(30);

/// Exit status of a program that was asked to stop.
pub(crate) const STATUS: u8 = 130;

/// Knows whether the user asked to stop.
pub(crate) struct Interrupt;

/// How many pieces of work have begun to listen.
static WORKS: AtomicUsize = AtomicUsize::new(0);

/// Where a test stops the program.
static PLACE: OnceLock<Option<Place>> = OnceLock::new();

/// A place in the work of the program, the same whatever the load: `2:variants:3` is where three variants are done in
/// the second piece of work.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    work: usize,
    things: String,
    done: f64,
}

impl std::str::FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.splitn(3, ':');
        let mut next = || parts.next().unwrap_or_default();
        let (work, things, done) = (next(), next(), next());
        match (work.parse(), done.parse()) {
            (Ok(work), Ok(done)) if !things.is_empty() => {
                Ok(Self { work, things: things.to_owned(), done })
            }
            _ => Err("expected WORK:THINGS:DONE, such as 2:variants:3".to_owned()),
        }
    }
}

/// Stops the program at a place as a signal would.
pub(crate) fn stop_at(place: Option<Place>) {
    // Only the first counts, and there is one.
    let _ = PLACE.set(place);
}

/// Takes the signals of the whole program; `json` says whether what is printed is a document.
///
/// The first asks to stop. Work that does not listen, or does not notice in time, is ended; work that stops has time to
/// keep what is finished; a second signal ends everything. Files are written under their own names only when whole, and
/// what is unfinished is removed.
pub(crate) fn watch(json: bool) {
    JSON.store(json, Ordering::Relaxed);
    // An error says that the system refuses a handler: then Ctrl-C ends the program as it always did.
    drop(ctrlc::set_handler(ask));
}

/// Whether what is printed is a document.
static JSON: AtomicBool = AtomicBool::new(false);

/// What a signal does.
fn ask() {
    let json = JSON.load(Ordering::Relaxed);
    if ASKED.swap(true, Ordering::Relaxed) || !LISTENS.load(Ordering::Relaxed) {
        end(json);
    }
    // The handler's own thread has to be free for the second signal.
    std::thread::spawn(move || {
        std::thread::sleep(GRACE);
        if STOPPED.load(Ordering::Relaxed) || FINISHED.load(Ordering::Relaxed) {
            printer::note("stopping; what is finished is kept, a second Ctrl-C ends at once");
            std::thread::sleep(KEEPING);
        }
        end(json);
    });
}

/// Ends the program, says what is kept and removes what is unfinished.
#[expect(clippy::exit, reason = "the work does not end by itself")]
fn end(json: bool) -> ! {
    system::write_no_more();
    let folders = FOLDERS.lock().map(|folders| folders.clone()).unwrap_or_default();
    for entry in
        folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten()
    {
        if entry.file_name().to_string_lossy().ends_with(&system::unfinished()) {
            // It may have been renamed since, and then it is whole.
            let _ = std::fs::remove_file(entry.path());
        }
    }
    barrelstack_campaign::study::remove_drafts();
    printer::stopped(json);
    std::process::exit(i32::from(STATUS))
}

/// Whether work was stopped before its end.
pub(crate) fn has_stopped() -> bool {
    STOPPED.load(Ordering::Relaxed)
}

/// All work is finished: from now on what came of it is written, which a first signal does not cut short.
pub(crate) fn finished() {
    FINISHED.store(true, Ordering::Relaxed);
}

/// Says what is kept when the program is ended from now on.
pub(crate) fn keeps(words: String) {
    if let Ok(mut kept) = KEPT.lock() {
        *kept = Some(words);
    }
}

/// Files are written in this folder from now on.
pub(crate) fn writes_to(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if let Ok(mut folders) = FOLDERS.lock()
        && !folders.iter().any(|known| known == folder)
    {
        folders.push(folder.to_owned());
    }
}

/// The work stopped because it was asked to; what is kept was said beforehand.
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
    /// Listens from now on; work that comes after other work hears what that was asked.
    pub(crate) fn listen() -> Self {
        LISTENS.store(true, Ordering::Relaxed);
        WORKS.fetch_add(1, Ordering::Relaxed);
        Self
    }

    /// Whether the user asked to stop.
    #[expect(clippy::unused_self, reason = "who asks has to listen")]
    pub(crate) fn asked(&self) -> bool {
        let asked = ASKED.load(Ordering::Relaxed);
        if asked {
            STOPPED.store(true, Ordering::Relaxed);
        }
        asked
    }

    /// Work of this kind has come this far: the place where a test stops it.
    #[expect(clippy::unused_self, reason = "who reaches it has to listen")]
    pub(crate) fn reached(&self, things: &str, done: f64) {
        let Some(Some(place)) = PLACE.get() else { return };
        let here = place.work == WORKS.load(Ordering::Relaxed)
            && things.contains(&place.things)
            && done >= place.done;
        if here && !ASKED.load(Ordering::Relaxed) {
            ask();
        }
    }

    /// Whether to go on.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
