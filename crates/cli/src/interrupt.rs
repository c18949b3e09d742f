//! Ctrl-C that keeps what was computed.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user asked to stop; of the whole program, which can have one handler only.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Knows whether the user asked to stop.
pub(crate) struct Interrupt;

impl Interrupt {
    /// Listens from now on; work that comes after other work hears what that was asked.
    ///
    /// The first Ctrl-C asks to stop; a second one, for work that is not there yet, ends the program: files are
    /// written under their own names only when whole.
    pub(crate) fn listen() -> Self {
        // An error says that there is a handler already, or that the system refuses one: then Ctrl-C ends the program
        // as it always did.
        drop(ctrlc::set_handler(|| {
            if ASKED.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        }));
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

#[cfg(all(test, unix))]
mod tests {
    use std::process::{Command, id};
    use std::time::{Duration, Instant};

    use super::Interrupt;

    #[test]
    fn work_that_comes_after_other_work_hears_ctrl_c() {
        let works = [Interrupt::listen(), Interrupt::listen()];
        assert!(works.iter().all(|work| work.flow().is_continue()));
        let sent = Command::new("kill").args(["-INT", &id().to_string()]).status();
        assert!(sent.unwrap().success());
        let start = Instant::now();
        // Measured: a millisecond.
        while works.iter().any(|work| !work.asked()) && start.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(works.iter().all(|work| work.flow().is_break()));
    }
}
