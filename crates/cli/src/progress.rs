//! Progress: a bar on a terminal, occasional lines elsewhere; and Ctrl-C that keeps computed results.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use barrelstack::variants;
use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt::Interrupt;
use crate::printer;

/// Interval of lines without a terminal.
const EVERY: Duration = Duration::from_secs(5);

/// Warm-up before an estimate of the total time is shown.
const LOOKED_AT: Duration = Duration::from_secs(1);

/// Minimum share of the work done for an estimate, unless the work takes long.
const SHARE: f64 = 0.02;

/// Shortest total time for which an estimate is shown.
const LONG: Duration = Duration::from_secs(10);

/// Progress display and cancellation.
pub(crate) struct Progress {
    bar: Bar,
    lines: Lines,
    interrupt: Interrupt,
}

/// A bar on a terminal, if requested; removed on drop, also after an error.
pub(crate) struct Bar(pub(crate) Option<ProgressBar>);

impl Bar {
    /// Creates it if there is a terminal.
    pub(crate) fn new(show: bool, make: impl FnOnce() -> ProgressBar) -> Self {
        Self((show && std::io::stderr().is_terminal()).then(make))
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

impl Progress {
    /// Starts the display; shows something only if requested.
    pub(crate) fn new(show: bool) -> Self {
        let bar = Bar::new(show, || {
            let bar = ProgressBar::new_spinner().with_style(style("{spinner} {msg}"));
            bar.set_message("getting ready");
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Self { bar, lines: Lines::new(show), interrupt: Interrupt::listen() }
    }

    /// Reports the progress of a run.
    pub(crate) fn at(&self, progress: barrelstack::Progress) -> ControlFlow<()> {
        let barrelstack::Progress { time, end_time } = progress;
        self.interrupt.reached("seconds", time);
        self.told(time, end_time, || format!("{time:.1} of {end_time:.1} s simulated"))
    }

    /// Reports the number of finished things of a total.
    pub(crate) fn counted(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.interrupt.reached(things, done as f64);
        self.told(done as f64, of as f64, || format!("{done} of {of} {things}"))
    }

    /// Reports the progress of a run and its variants.
    pub(crate) fn told_of(&self, told: variants::Advance) -> ControlFlow<()> {
        match told {
            variants::Advance::Run(reached) => self.at(reached),
            variants::Advance::Variants { done, of } => {
                self.counted(done as u64, of as u64, "variants")
            }
        }
    }

    /// Reports the number of finished things of a part of the work, after which others may follow.
    pub(crate) fn counted_of_part(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.lines.part();
        self.counted(done, of, things)
    }

    /// Reports the number of tries of a search of unknown length.
    pub(crate) fn searched(&self, done: u64, things: &str) -> ControlFlow<()> {
        let words = || format!("{done} {things}");
        if let Some(bar) = &self.bar.0 {
            bar.set_message(words());
        }
        self.lines.now_and_then(words);
        self.interrupt.reached(things, done as f64);
        self.interrupt.flow()
    }

    fn told(&self, done: f64, of: f64, words: impl Fn() -> String) -> ControlFlow<()> {
        if let Some(bar) = &self.bar.0 {
            if bar.length().is_none() {
                bar.set_style(style("{spinner} {bar:30} {msg}, {eta} to go"));
                bar.reset_eta();
            }
            bar.set_length(thousandths(of));
            bar.set_position(thousandths(done));
            bar.set_message(words());
        }
        self.lines.at(done, of, words);
        self.interrupt.flow()
    }
}

/// Lines without a terminal: an estimate of the total time, then the progress every few seconds.
pub(crate) struct Lines {
    /// `None` if no lines are requested.
    told: Option<Mutex<LastLine>>,
}

/// State of the lines of some work.
struct LastLine {
    /// Time of the last line.
    last: Instant,
    /// `true` if the total time was printed, or is unknown.
    whole: bool,
    /// Start of this work, or of this part of it, and the amount done by then: results of an earlier run took this one
    /// no time.
    start: Option<(Instant, f64)>,
    /// Amount done at the last report, and the total.
    done: f64,
    of: f64,
}

impl Lines {
    /// Starts; prints only if requested, and only without a terminal.
    pub(crate) fn new(show: bool) -> Self {
        let told = LastLine { last: Instant::now(), whole: false, start: None, done: 0.0, of: 0.0 };
        let wanted = show && !std::io::stderr().is_terminal();
        Self { told: wanted.then(|| Mutex::new(told)) }
    }

    /// Marks the work as a part, so that the total time is unknown.
    fn part(&self) {
        if let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) {
            told.whole = true;
        }
    }

    /// Reports the progress of work of unknown length.
    fn now_and_then(&self, words: impl Fn() -> String) {
        let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) else { return };
        if told.last.elapsed() > EVERY {
            printer::note(&words());
            told.last = Instant::now();
        }
    }

    /// Reports the progress of work.
    pub(crate) fn at(&self, done: f64, of: f64, words: impl Fn() -> String) {
        let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) else { return };
        // A large decrease starts the next part; a small one comes from another thread.
        let anew = of != told.of || done < 0.5 * told.done;
        (told.done, told.of) = (done, of);
        let (start, first) = match told.start {
            Some(start) if !anew => start,
            _ => *told.start.insert((Instant::now(), done)),
        };
        let (spent, gone, left) = (start.elapsed(), done - first, of - done);
        // The first of many concurrent items do not predict the rest.
        if spent < LOOKED_AT || gone <= 0.0 || (gone < SHARE * of && spent < EVERY) {
            return;
        }
        let to_go = spent.mul_f64((left / gone).clamp(0.0, 1e6));
        if !told.whole && spent + to_go > LONG {
            told.whole = true;
            printer::note(&format!("this takes about {}", rounded(spent + to_go)));
        } else if told.last.elapsed() > EVERY {
            printer::note(&format!("{}, about {} to go", words(), rounded(to_go)));
        } else {
            return;
        }
        told.last = Instant::now();
    }
}

pub(crate) fn style(template: &str) -> ProgressStyle {
    // The templates are constants, and each is shown in a test of the command on a terminal.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_spinner())
}

/// Converts to the unit of the bar.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is counted is not negative"
)]
fn thousandths(value: f64) -> u64 {
    (1e3 * value) as u64
}

/// Formats a time for people.
fn rounded(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..90 => format!("{} s", seconds.max(1)),
        seconds @ 90..5400 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{} h", (seconds + 1800) / 3600),
    }
}
