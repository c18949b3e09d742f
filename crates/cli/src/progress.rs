//! A progress bar on a terminal, and Ctrl-C that keeps what was computed.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::Duration;

use barrelstack::variants::Told;
use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt::Interrupt;

/// Tells how far a run is, and whether the user wants it to stop.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    interrupt: Interrupt,
}

impl Progress {
    /// Starts; shows a line only when asked to and only on a terminal.
    pub(crate) fn new(show: bool) -> Self {
        let bar = (show && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new_spinner().with_style(style("{spinner} {msg}"));
            bar.set_message("the stack comes to rest");
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Self { bar, interrupt: Interrupt::listen() }
    }

    /// The variants, or the run that is shown, have come this far.
    pub(crate) fn told(&mut self, told: Told) -> ControlFlow<()> {
        let (done, of) = match told {
            Told::Run(progress) => return self.at(progress),
            Told::Variants { done, of } => (done, of),
        };
        if let Some(bar) = &self.bar {
            if bar.length().is_none() {
                bar.set_style(style("{spinner} {bar:30} {msg}, {eta} to go"));
                bar.reset_eta();
            }
            bar.set_length(of as u64);
            bar.set_position(done as u64);
            bar.set_message(format!("{done} of {of} variants"));
            if done == of {
                // What comes next counts otherwise.
                bar.unset_length();
                bar.set_style(style("{spinner} {msg}"));
            }
        }
        self.interrupt.flow()
    }

    /// The run has come this far.
    pub(crate) fn at(&mut self, progress: barrelstack::Progress) -> ControlFlow<()> {
        if let Some(bar) = &self.bar {
            if bar.length().is_none() {
                bar.set_style(style("{spinner} {bar:30} {msg}, {eta} to go"));
                bar.reset_eta();
            }
            bar.set_length(milliseconds(progress.end_time));
            bar.set_position(milliseconds(progress.time));
            bar.set_message(format!(
                "{:.1} of {:.1} s simulated",
                progress.time, progress.end_time
            ));
        }
        self.interrupt.flow()
    }
}

/// Takes the line away, also where the run ends in an error.
impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

pub(crate) fn style(template: &str) -> ProgressStyle {
    // The templates are constants, and each is shown in a test of the command on a terminal.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_spinner())
}

/// Whole milliseconds of a time (s), the unit in which the bar counts.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times are not negative"
)]
fn milliseconds(time: f64) -> u64 {
    (1e3 * time) as u64
}
