//! Parallel map on all cores.

use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Returns the number of cores that this process may use; 1 if the number is unknown.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// Runs all tasks on all cores and returns their results in the order of the tasks.
///
/// Threads take the tasks in order, so long tasks should come first. The assignment of tasks to threads does not affect
/// results. After each task, `done` is called with the number of tasks finished so far.
pub fn map<T: Sync, R: Send>(
    tasks: &[T],
    work: impl Fn(&T) -> R + Sync,
    done: &(dyn Fn(usize) + Sync),
) -> Vec<R> {
    map_on(0, tasks, work, done)
}

/// Runs all tasks as [`map`] does, but on the given number of threads; zero for one thread per core.
pub fn map_on<T: Sync, R: Send>(
    threads: usize,
    tasks: &[T],
    work: impl Fn(&T) -> R + Sync,
    done: &(dyn Fn(usize) + Sync),
) -> Vec<R> {
    let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let slots: Vec<Mutex<Option<R>>> = tasks.iter().map(|_| Mutex::new(None)).collect();
    let worker = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(task) = tasks.get(at) else { break };
            let result = work(task);
            if let Ok(mut slot) = slots[at].lock() {
                *slot = Some(result);
            }
            done(finished.fetch_add(1, Ordering::Relaxed) + 1);
        }
    };
    let threads = if threads == 0 { cores() } else { threads }.min(tasks.len());
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(worker);
        }
        worker();
    });
    // Every slot is filled, because the scope propagates the panic of any thread.
    slots.into_iter().filter_map(|slot| slot.into_inner().ok().flatten()).collect()
}
