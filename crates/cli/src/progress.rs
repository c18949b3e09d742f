//! A progress bar on a terminal, and Ctrl-C that keeps what was computed.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

/// Tells how far a run is, and whether the user wants it to stop.
pub(crate) struct Progress {
    spinner: Option<ProgressBar>,
    stop: Arc<AtomicBool>,
}

impl Progress {
    /// Starts; shows a line only when asked to and only on a terminal.
    pub(crate) fn new(show: bool) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&stop);
        // A second handler cannot be set in one process; the first one then does the work.
        let _ = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed));
        let spinner = (show && std::io::stderr().is_terminal()).then(|| {
            let spinner = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}  {elapsed}") {
                spinner.set_style(style);
            }
            spinner
        });
        Self { spinner, stop }
    }

    /// The run has reached a simulated time (s).
    pub(crate) fn at(&mut self, time: f64) -> ControlFlow<()> {
        if let Some(spinner) = &self.spinner {
            spinner.set_message(format!("{time:6.2} s simulated"));
            spinner.tick();
        }
        if self.stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Takes the line away.
    pub(crate) fn done(&self) {
        if let Some(spinner) = &self.spinner {
            spinner.finish_and_clear();
        }
    }
}
