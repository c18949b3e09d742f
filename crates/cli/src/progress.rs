//! Progress display: a bar on a terminal, occasional lines elsewhere. Ctrl-C keeps finished
//! results.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use barrelstack::ensemble::Work;
use barrelstack::variants;
use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt::Interrupt;
use crate::printer;

/// Interval between progress lines if the output is not a terminal.
const EVERY: Duration = Duration::from_secs(5);

/// Time that must be spent on work before its remaining time is predicted.
const LOOKED_AT: Duration = Duration::from_secs(1);

/// Share of a run that must be finished before its remaining time is predicted. After the time [`EVERY`], no minimum
/// share is required.
const SHARE: f64 = 0.02;

/// Number of runs that must be finished before the time of the remaining runs is predicted. If half of all runs are
/// fewer than this number, half of all runs are enough.
const ENOUGH: f64 = 24.0;

/// Shortest total time for which an estimate is printed early.
const LONG: Duration = Duration::from_secs(10);

/// Progress display and cancellation.
pub(crate) struct Progress {
    bar: Bar,
    lines: Lines,
    interrupt: Interrupt,
}

/// Progress bar on a terminal, if requested. The bar is removed when this value is dropped, even
/// after an error.
pub(crate) struct Bar(pub(crate) Option<ProgressBar>);

impl Bar {
    /// Creates the bar with `make` if `show` is `true` and standard error is a terminal.
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
    /// Starts the display; nothing is shown if `show` is `false`.
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
        self.report(time, end_time, Of::One, || format!("{time:.1} of {end_time:.1} s simulated"))
    }

    /// Reports that `done` of `of` items are finished. `things` is the noun for the items, such as "runs".
    pub(crate) fn counted(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.interrupt.reached(things, done as f64);
        self.report(done as f64, of as f64, Of::Many, || format!("{done} of {of} {things}"))
    }

    /// Reports the progress of a run and its variants.
    pub(crate) fn advance(&self, reached_so_far: variants::Advance) -> ControlFlow<()> {
        match reached_so_far {
            variants::Advance::Run(reached) => self.at(reached),
            variants::Advance::First { variants, headline } => {
                self.said(&format!("after the first {variants} variants: {headline}"))
            }
            variants::Advance::Variants { done, of } => {
                self.counted(done as u64, of as u64, "runs")
            }
        }
    }

    /// Reports that `done` of `of` items are finished in one part of the work; other parts may follow. `things` is the
    /// noun for the items.
    pub(crate) fn counted_of_part(&self, done: u64, of: u64, things: &str) -> ControlFlow<()> {
        self.lines.part();
        self.counted(done, of, things)
    }

    /// Prints a line that remains on the terminal, if progress is shown.
    fn said(&self, line: &str) -> ControlFlow<()> {
        if let Some(bar) = &self.bar.0 {
            bar.println(line);
        } else if self.lines.last.is_some() {
            printer::note(line);
        }
        self.interrupt.flow()
    }

    /// Reports the number of attempts in a search of unknown length. `one` and `things` are the words for one attempt
    /// and for several attempts.
    pub(crate) fn searched(&self, done: u64, one: &str, things: &str) -> ControlFlow<()> {
        self.report_open_ended(done, things, || {
            format!("{done} {}", if done == 1 { one } else { things })
        })
    }

    /// Reports the progress of a search for changes that keep a stack up.
    pub(crate) fn tried(&self, attempt: variants::Attempt<'_>) -> ControlFlow<()> {
        self.report_open_ended(attempt.done as u64, "runs of changed stacks", || {
            attempt.to_string()
        })
    }

    /// Shows the text that `words` returns about work of unknown length; `done` is the number of `things` that are
    /// finished.
    fn report_open_ended(
        &self,
        done: u64,
        things: &str,
        words: impl Fn() -> String,
    ) -> ControlFlow<()> {
        if let Some(bar) = &self.bar.0 {
            bar.set_message(words());
        }
        self.lines.now_and_then(words);
        self.interrupt.reached(things, done as f64);
        self.interrupt.flow()
    }

    fn report(&self, done: f64, of: f64, work: Of, words: impl Fn() -> String) -> ControlFlow<()> {
        if let Some(bar) = &self.bar.0 {
            if bar.length().is_none() {
                bar.set_style(style("{spinner} {bar:30} {msg}, {eta} to go"));
                bar.reset_eta();
            }
            bar.set_length(thousandths(of));
            bar.set_position(thousandths(done));
            bar.set_message(words());
        }
        self.lines.at(done, of, work, words);
        self.interrupt.flow()
    }
}

/// Kind of work, which determines how much of the work must be finished before the remaining time
/// is predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Of {
    /// One run, whose simulated time advances steadily.
    One,
    /// Many runs in parallel; the shortest runs end first.
    Many,
}

impl Of {
    /// Returns the estimated remaining time; `None` while too little is done.
    ///
    /// The progress of many runs is measured by their total simulated time, if known, rather than
    /// by the number of finished runs: the first runs to end are those that collapse early, and
    /// possibly no run has ended when all are half finished.
    fn to_go(
        self,
        spent: Duration,
        first: f64,
        done: f64,
        of: f64,
        work: Work,
    ) -> Option<Duration> {
        let gone = done - first;
        if let (Self::Many, Some(left)) = (self, left(work, of - done, of - first)) {
            return (spent >= EVERY).then(|| spent.mul_f64(left.min(1e6)));
        }
        let enough = match self {
            Self::One => gone >= SHARE * of || spent >= EVERY,
            Self::Many => gone >= ENOUGH.min(0.5 * (of - first)) && spent >= EVERY,
        };
        let known = enough && gone > 0.0 && spent >= LOOKED_AT;
        known.then(|| spent.mul_f64(((of - done) / gone).clamp(0.0, 1e6)))
    }
}

/// Returns the ratio of the remaining time to the time spent, when `open` of `all` cases are unfinished; `None` before
/// any stack is shaken.
///
/// Cases are expected to end early at the rate observed so far. At the start, when no rate is known, each case is
/// expected to take 0.7 of its full time. Stacks that are still settling are expected to need the settling time of the
/// others.
fn left(work: Work, open: f64, all: f64) -> Option<f64> {
    let rate = (work.early + 0.75) / (work.done + 1.0);
    // Close to (1 - exp(-rate)) / rate, the mean share of a case that ends early at a constant
    // rate.
    let mean = 1.0 / (1.0 + rate / 2.0 + rate * rate / 12.0);
    if work.done <= 0.0 || work.shaking <= 0.0 {
        return None;
    }
    let shaking = work.shaking * (open - work.under_way).max(0.0) * mean / work.done;
    let settling = work.settling * (all - work.at_rest).max(0.0) / work.at_rest.max(1.0);
    Some((shaking + settling) / (work.shaking + work.settling))
}

/// Progress display for output that is not a terminal. It prints lines: first an estimate of the
/// total time, then the progress every few seconds.
pub(crate) struct Lines {
    /// State of the lines; `None` if no lines are requested.
    last: Option<Mutex<LastLine>>,
}

/// State of the progress lines for one task.
struct LastLine {
    /// Time of the last line.
    last: Instant,
    /// `true` if no early estimate of the remaining time will be printed, because one was printed before or the work is
    /// one of several parts.
    estimated: bool,
    /// Time at which this work, or this part of it, started; the amount that was finished at that time; and the value
    /// of `Work::now()` at that time. The finished amount comes from an earlier run, so it is excluded from the
    /// estimate. `None` before the first report.
    start: Option<(Instant, f64, Work)>,
    /// Amount of work that was finished at the last report.
    done: f64,
    /// Total amount of work at the last report.
    of: f64,
}

impl Lines {
    /// Starts the display. Lines are printed only if `show` is `true` and the output is not a terminal.
    pub(crate) fn new(show: bool) -> Self {
        let line =
            LastLine { last: Instant::now(), estimated: false, start: None, done: 0.0, of: 0.0 };
        let wanted = show && !std::io::stderr().is_terminal();
        Self { last: wanted.then(|| Mutex::new(line)) }
    }

    /// Marks the work as one of several parts. The total time is then unknown, and no early estimate is printed.
    fn part(&self) {
        if let Some(Ok(mut line)) = self.last.as_ref().map(Mutex::lock) {
            line.estimated = true;
        }
    }

    /// Reports the progress of work of unknown length: prints the text that `words` returns, if the last line was
    /// printed more than [`EVERY`] ago.
    fn now_and_then(&self, words: impl Fn() -> String) {
        let Some(Ok(mut line)) = self.last.as_ref().map(Mutex::lock) else { return };
        if line.last.elapsed() > EVERY {
            printer::note(&words());
            line.last = Instant::now();
        }
    }

    /// Reports that the amount `done` of the total `of` is finished. If a line is due, prints an estimate of the total
    /// time, or the text that `words` returns. An estimate of the remaining time, if available, is appended to this
    /// text.
    pub(crate) fn at(&self, done: f64, of: f64, work: Of, words: impl Fn() -> String) {
        let Some(Ok(mut line)) = self.last.as_ref().map(Mutex::lock) else { return };
        // If the amount decreases by more than half, the next part has started. A smaller decrease comes from another
        // thread.
        let anew = of != line.of || done < 0.5 * line.done;
        (line.done, line.of) = (done, of);
        let (start, first, before) = match line.start {
            Some(start) if !anew => start,
            _ => *line.start.insert((Instant::now(), done, Work::now())),
        };
        let spent = start.elapsed();
        let Some(to_go) = work.to_go(spent, first, done, of, Work::now().since(before)) else {
            if line.last.elapsed() > EVERY {
                printer::note(&words());
                line.last = Instant::now();
            }
            return;
        };
        let first_estimate = !line.estimated && spent + to_go > LONG;
        if first_estimate || line.last.elapsed() > EVERY {
            line.estimated |= first_estimate;
            printer::note(&format!("{}, about {} to go", words(), rounded(to_go)));
            line.last = Instant::now();
        }
    }
}

pub(crate) fn style(template: &str) -> ProgressStyle {
    // The templates are constants, and a test of the command on a terminal shows each of them.
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_spinner())
}

/// Converts an amount of work to thousandths, the integer unit of the progress bar.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts are not negative"
)]
fn thousandths(value: f64) -> u64 {
    (1e3 * value) as u64
}

/// Formats a duration in whole seconds, minutes or hours.
fn rounded(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..90 => format!("{} s", seconds.max(1)),
        seconds @ 90..5400 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{} h", (seconds + 1800) / 3600),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Start and end times (s) of the settling and of the shaking of a run, and the time (s) that
    /// the shaking would take without a collapse.
    struct Timed {
        first: f64,
        start: f64,
        end: f64,
        whole: f64,
    }

    /// Returns the times of runs that start in the order of `lengths`, at most `width` of them at the same time. Each
    /// run settles for `settling` (s), and is then shaken for the first of its two `lengths` (s). The second length is
    /// the time for which it would be shaken without a collapse.
    fn side_by_side(width: usize, settling: f64, lengths: &[[f64; 2]]) -> Vec<Timed> {
        let mut free = vec![0.0_f64; width];
        let run = |[length, whole]: &[f64; 2]| {
            let next = free.iter_mut().min_by(|a, b| a.total_cmp(b)).unwrap();
            let first = *next;
            *next += settling + length;
            Timed { first, start: first + settling, end: *next, whole: *whole }
        };
        lengths.iter().map(run).collect()
    }

    /// Returns the time (s) of the first estimate, and the total time (s) that it predicts; `None` if there is no
    /// estimate before the last run ends. `known` states whether the simulated time of the runs is known.
    fn first(runs: &[Timed], known: bool) -> Option<(f64, f64)> {
        let all = runs.iter().map(|run| run.end).fold(0.0, f64::max);
        let times = (1..).map(|tenth| 0.1 * f64::from(tenth));
        times.take_while(|time| *time < all).find_map(|time| {
            let ended = |run: &&Timed| run.end <= time;
            let done = runs.iter().filter(ended).count() as f64;
            let share = |run: &Timed| ((time.min(run.end) - run.start) / run.whole).max(0.0);
            let open = runs.iter().filter(|run| !ended(run));
            let early = |run: &&Timed| run.end - run.start < 0.99 * run.whole;
            let between = |from: f64, to: f64| (time.min(to) - from).max(0.0);
            let work = Work {
                at_rest: runs.iter().filter(|run| run.start <= time).count() as f64,
                settling: runs.iter().map(|run| between(run.first, run.start)).sum(),
                shaking: runs.iter().map(|run| between(run.start, run.end)).sum(),
                done: runs.iter().map(share).sum(),
                under_way: open.map(share).sum(),
                early: runs.iter().filter(ended).filter(early).count() as f64,
            };
            let work = if known { work } else { Work::default() };
            let spent = Duration::from_secs_f64(time);
            let to_go = Of::Many.to_go(spent, 0.0, done, runs.len() as f64, work)?;
            Some((time, time + to_go.as_secs_f64()))
        })
    }

    /// Runs without a collapse take their full time, and runs with a collapse take a part of it. The elapsed time is
    /// computed, so that the test does not depend on a clock.
    #[test]
    fn first_estimates_come_after_five_seconds_and_are_within_a_factor_of_two() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut made, mut wrong) = (0, [0, 0]);
        for trial in 0..1000 {
            let (width, count) = ([1, 2, 4, 8, 16, 32][trial % 6], [64, 100, 512][trial % 3]);
            let whole = [0.3, 1.0, 3.0, 6.0, 10.0, 30.0][trial / 6 % 6];
            let (share, part) = (uniform(), 0.1 + 0.5 * uniform());
            let lengths = (0..count).map(|_| {
                let whole = whole * (0.9 + 0.2 * uniform());
                let length = if uniform() < share { part * (0.7 + 0.6 * uniform()) } else { 1.0 };
                [whole * length, whole]
            });
            let settling = whole * [0.0, 0.1, 1.0][trial / 36 % 3];
            let runs = side_by_side(width, settling, &lengths.collect::<Vec<_>>());
            let all = runs.iter().map(|run| run.end).fold(0.0, f64::max);
            if all < 12.0 {
                continue;
            }
            made += 1;
            let (at, estimate) = first(&runs, true).expect("an estimate");
            // No estimate is possible before the first stack is shaken.
            assert!(at < 5.2_f64.max(settling + 0.2), "{at} s");
            assert!((0.25..=4.0).contains(&(estimate / all)), "{estimate} of {all} s");
            wrong[0] += usize::from(!(0.5..=2.0).contains(&(estimate / all)));
            // Without simulated times, the number of finished runs decides, and the estimate comes
            // later.
            let (at, estimate) = first(&runs, false).expect("an estimate");
            assert!(at <= 0.75 * all, "{at} of {all} s");
            wrong[1] += usize::from(!(0.5..=2.0).contains(&(estimate / all)));
        }
        // Measured: 11 of 848 estimates with simulated times are wrong by more than a factor of two, and none without.
        assert!(made > 500 && wrong[0] * 40 <= made && wrong[1] * 100 <= made, "{made} {wrong:?}");
    }
}
