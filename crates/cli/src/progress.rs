//! How far work is: a bar on a terminal, a line now and then elsewhere; and Ctrl-C that keeps what was computed.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use barrelstack::variants;
use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt::Interrupt;
use crate::printer;

/// How often a line is printed where there is no terminal.
const EVERY: Duration = Duration::from_secs(5);

/// How long work is looked at before it is told how long all of it takes.
const LOOKED_AT: Duration = Duration::from_secs(1);

/// The share of it that is done by then, unless it takes long.
const SHARE: f64 = 0.02;

/// The shortest work of which that is told.
const LONG: Duration = Duration::from_secs(10);

/// Tells how far work is, and whether the user wants it to stop.
pub(crate) struct Progress {
    bar: Bar,
    lines: Lines,
    interrupt: Interrupt,
}

/// A bar on a terminal, if one is wanted; it is taken away also where the work ends in an error.
pub(crate) struct Bar(pub(crate) Option<ProgressBar>);

impl Bar {
    /// Makes it where there is a terminal.
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
    /// Starts; shows something only when asked to.
    pub(crate) fn new(show: bool) -> Self {
        let bar = Bar::new(show, || {
            let bar = ProgressBar::new_spinner().with_style(style("{spinner} {msg}"));
            bar.set_message("getting ready");
            bar.enable_steady_tick(Duration::from_millis(100));
            bar
        });
        Self { bar, lines: Lines::new(show), interrupt: Interrupt::listen() }
    }

    /// The run has come this far.
    pub(crate) fn at(&self, progress: barrelstack::Progress) -> ControlFlow<()> {
        let barrelstack::Progress { time, end_time } = progress;
        self.interrupt.reached("seconds", time);
        self.told(time, end_time, || format!("{time:.1} of {end_time:.1} s simulated"))
    }

    /// So many of so many things are done.
    pub(crate) fn counted(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.interrupt.reached(things, done as f64);
        self.told(done as f64, of as f64, || format!("{done} of {of} {things}"))
    }

    /// A run and its variants have come this far.
    pub(crate) fn told_of(&self, told: variants::Advance) -> ControlFlow<()> {
        match told {
            variants::Advance::Run(reached) => self.at(reached),
            variants::Advance::Variants { done, of } => {
                self.counted(done as u64, of as u64, "variants")
            }
        }
    }

    /// So many of so many things are done of a part of the work, after which there may be others.
    pub(crate) fn counted_of_part(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.lines.part();
        self.counted(done, of, things)
    }

    /// So many tries are done of a search whose length is not known.
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

/// Lines where there is no terminal: how long all of it takes, then every few seconds how far it is.
pub(crate) struct Lines {
    /// None where no lines are wanted.
    told: Option<Mutex<LastLine>>,
}

/// What was told of some work.
struct LastLine {
    /// When a line was last printed.
    last: Instant,
    /// Whether it was told how long all of it takes, or nobody knows.
    whole: bool,
    /// When this work, or this part of it, was first looked at, and how much was done by then: what an earlier run had
    /// done took this one no time.
    start: Option<(Instant, f64)>,
    /// How much was done when last looked at, and of how much.
    done: f64,
    of: f64,
}

impl Lines {
    /// Starts; prints something only when asked to, and only where there is no terminal.
    pub(crate) fn new(show: bool) -> Self {
        let told = LastLine { last: Instant::now(), whole: false, start: None, done: 0.0, of: 0.0 };
        let wanted = show && !std::io::stderr().is_terminal();
        Self { told: wanted.then(|| Mutex::new(told)) }
    }

    /// What is told of is a part, and nobody knows how long all of it takes.
    fn part(&self) {
        if let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) {
            told.whole = true;
        }
    }

    /// Work of unknown length has come this far.
    fn now_and_then(&self, words: impl Fn() -> String) {
        let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) else { return };
        if told.last.elapsed() > EVERY {
            printer::note(&words());
            told.last = Instant::now();
        }
    }

    /// Work has come this far.
    pub(crate) fn at(&self, done: f64, of: f64, words: impl Fn() -> String) {
        let Some(Ok(mut told)) = self.told.as_ref().map(Mutex::lock) else { return };
        // Far less than before is the next part; a little less comes from another thread.
        let anew = of != told.of || done < 0.5 * told.done;
        (told.done, told.of) = (done, of);
        let (start, first) = match told.start {
            Some(start) if !anew => start,
            _ => *told.start.insert((Instant::now(), done)),
        };
        let (spent, gone, left) = (start.elapsed(), done - first, of - done);
        // The first of many things that go on together says little of the rest.
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

/// The unit in which the bar counts.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is counted is not negative"
)]
fn thousandths(value: f64) -> u64 {
    (1e3 * value) as u64
}

/// A time as a person would say it.
fn rounded(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..90 => format!("{} s", seconds.max(1)),
        seconds @ 90..5400 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{} h", (seconds + 1800) / 3600),
    }
}
