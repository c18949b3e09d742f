//! Ctrl-C, and what else asks a program to end: within a second it has, and has said what is kept.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use barrelstack_input::system;

use crate::printer;

/// Whether the user asked to stop; of the whole program, which can have one handler only.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether there is work that looks at it.
static HEARD: AtomicBool = AtomicBool::new(false);

/// What is kept when the program is ended in the middle of work.
static KEPT: Mutex<Option<String>> = Mutex::new(None);

/// Folders in which files may lie that are not finished.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Time for work to end by itself and to keep what it has; what is left of a second is for saying so.
const GRACE: Duration = Duration::from_millis(600);

/// Exit status of a program that was asked to stop.
pub(crate) const STATUS: u8 = 130;

/// Knows whether the user asked to stop.
pub(crate) struct Interrupt;

/// Takes the signals of the whole program; `json` says whether what is printed is a document.
///
/// The first asks to stop. Work that does not listen, or is not done in time, is ended; so is everything by a second
/// one. Files are written under their own names only when whole, and what is unfinished is removed.
pub(crate) fn watch(json: bool) {
    // An error says that the system refuses a handler: then Ctrl-C ends the program as it always did.
    drop(ctrlc::set_handler(move || {
        if ASKED.swap(true, Ordering::Relaxed) || !HEARD.load(Ordering::Relaxed) {
            end(json);
        }
        // The handler's own thread has to be free for the second signal.
        std::thread::spawn(move || {
            std::thread::sleep(GRACE);
            end(json);
        });
    }));
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
        HEARD.store(true, Ordering::Relaxed);
        Self
    }

    /// Whether the user asked to stop.
    #[expect(clippy::unused_self, reason = "who asks has to listen")]
    pub(crate) fn asked(&self) -> bool {
        ASKED.load(Ordering::Relaxed)
    }

    /// Whether to go on.
    pub(crate) fn flow(&self) -> ControlFlow<()> {
        if self.asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
