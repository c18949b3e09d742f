//! Runs work without the interpreter lock; meanwhile, the calling thread polls for Ctrl-C and
//! reports progress.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use pyo3::prelude::*;

/// Interval at which signals are polled, so that work stops well within a second.
pub(crate) const POLL: Duration = Duration::from_millis(50);

/// Progress and cancellation state of the work.
#[derive(Default)]
pub(crate) struct ProgressState {
    stop: AtomicBool,
    latest: Mutex<Option<Latest>>,
}

/// Latest progress: amount done, total, and unit.
#[derive(Clone, PartialEq)]
struct Latest {
    done: f64,
    of: f64,
    what: Cow<'static, str>,
}

impl ProgressState {
    /// Reports progress of the work; returns `Break` if the work should stop.
    pub(crate) fn report(
        &self,
        done: f64,
        of: f64,
        what: impl Into<Cow<'static, str>>,
    ) -> ControlFlow<()> {
        let latest = Latest { done, of, what: what.into() };
        *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(latest);
        if self.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// `true` if the work should stop.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn pass_on(&self, last: &mut Option<Latest>, progress: &Bound<'_, PyAny>) -> PyResult<()> {
        let latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if latest != *last
            && let Some(Latest { done, of, what }) = &latest
        {
            progress.call1((*done, *of, &**what))?;
            *last = latest;
        }
        Ok(())
    }
}

/// Runs work on another thread without the interpreter lock.
///
/// If a signal or the `progress` callback stops the work, the exception of the signal or callback
/// is raised after the work has ended.
pub(crate) fn run_interruptible<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&ProgressState) -> T + Send,
) -> PyResult<T> {
    let state = ProgressState::default();
    let mut last = None;
    let mut raised = None;
    let done = std::thread::scope(|scope| {
        let (give, take) = sync_channel(1);
        let state = &state;
        let worker = scope.spawn(move || {
            // The receiver is dropped only after it has received the result.
            let _ = give.send(work(state));
        });
        let take = Mutex::new(take);
        loop {
            let got = py
                .detach(|| take.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(POLL));
            match got {
                Ok(done) => break Ok(done),
                Err(RecvTimeoutError::Disconnected) => break Err(worker.join()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            if raised.is_none() {
                let checked = py.check_signals();
                let checked = checked.and_then(|()| match progress {
                    Some(progress) => state.pass_on(&mut last, progress),
                    None => Ok(()),
                });
                if let Err(error) = checked {
                    raised = Some(error);
                    state.stop.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    if let Some(raised) = raised {
        return Err(raised);
    }
    match done {
        Ok(done) => {
            if let Some(progress) = progress {
                state.pass_on(&mut last, progress)?;
            }
            Ok(done)
        }
        Err(Err(panic)) => std::panic::resume_unwind(panic),
        Err(Ok(())) => Err(crate::errors::general("the computation ended without a result")),
    }
}
