//! A line on the terminal while a study runs, and Ctrl-C that keeps what was done.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use barrelstack_campaign::study::Progress;
use indicatif::ProgressBar;

use crate::interrupt::Interrupt;
use crate::progress::{Bar, Lines, style};

/// Tells how far a study is, and whether the user wants it to stop.
pub(super) struct Live {
    bar: Bar,
    lines: Lines,
    /// Whether the cases are a sample, so that their share of collapse means something.
    sample: bool,
    interrupt: Interrupt,
    damaged: AtomicUsize,
}

impl Live {
    /// Starts; shows a line only when asked to and only on a terminal.
    pub(super) fn new(show: bool, sample: bool) -> Self {
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
        }
    }

    /// How many shards were damaged and set aside.
    pub(super) fn damaged(&self) -> usize {
        self.damaged.load(Ordering::Relaxed)
    }

    /// Shows how far it is.
    pub(super) fn at(&self, progress: &Progress) -> ControlFlow<()> {
        self.damaged.store(progress.damaged, Ordering::Relaxed);
        if let Some(bar) = &self.bar.0 {
            if bar.length().is_none() {
                bar.set_style(style(
                    "{spinner} {bar:30} {pos} of {len} cases, {per_sec}, {eta} to go; {msg}",
                ));
                bar.set_position(progress.before);
                // The rate is that of this run.
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
        self.lines.at(progress.now as f64, left as f64, || {
            format!("{} of {} cases", progress.before + progress.now, progress.cases)
        });
        self.interrupt.flow()
    }
}
