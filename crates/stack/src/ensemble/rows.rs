//! Tables of any number of cases, where each case is created on demand.
//!
//! Only table rows are kept, so memory holds no more than one batch of cases per core.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use barrelstack_columns::column::Column;

use super::{Audience, CASE_COLUMNS, CaseResult, Prepared, Width, simulate_in, table};
use crate::ground::{Ground, GroundError, of_spec, scaled};
use crate::pool;
use crate::scenario::{MeasuredOn, MotionSource, MotionSpec, Scale, Scenario};

/// Maximum number of cases that a core takes at once.
const BATCH: usize = 64;

/// Minimum number of batches per core, so that no core waits long for the last batch.
const SHARE: usize = 4;

/// Cache of unscaled ground motions, so that a record is not read again for every case.
#[derive(Debug, Default)]
pub struct Grounds(Mutex<Vec<(MotionSpec, Arc<Ground>)>>);

/// Maximum number of motions in the cache.
const KEPT: usize = 64;

impl Grounds {
    /// Returns the ground motion of a scenario, bit-identical to the result of [`Scenario::ground`].
    ///
    /// # Errors
    /// Same as [`Scenario::ground`].
    pub fn of(&self, scenario: &Scenario) -> Result<Arc<Ground>, GroundError> {
        let (spec, similitude) = (&scenario.motion, scenario.run.similitude);
        let alone = match (&spec.source, spec.scale) {
            (MotionSource::Record(_), Scale::Measure { of, .. }) => of != MeasuredOn::Component,
            (MotionSource::Record(_), Scale::Factor(_) | Scale::Pga(_) | Scale::Pgv(_)) => false,
            (MotionSource::None | MotionSource::Sine(_) | MotionSource::Pulse(_), _) => true,
        };
        if alone {
            return of_spec(spec, similitude).map(Arc::new);
        }
        let plain = MotionSpec { scale: Scale::Factor(1.0), similitude: 1.0, ..spec.clone() };
        let known = self.0.lock().ok().and_then(|kept| {
            kept.iter().find(|(kept, _)| *kept == plain).map(|(_, ground)| Arc::clone(ground))
        });
        let read = if let Some(read) = known {
            read
        } else {
            let read = Arc::new(of_spec(&plain, 1.0)?);
            if let Ok(mut kept) = self.0.lock() {
                if kept.len() >= KEPT {
                    kept.remove(0);
                }
                kept.push((plain.clone(), Arc::clone(&read)));
            }
            read
        };
        if *spec == plain && similitude == 1.0 {
            return Ok(read);
        }
        let Some(motion) = read.motion.clone() else { return Ok(read) };
        let motion = scaled(motion, spec, similitude)?;
        Ok(Arc::new(Ground { motion: Some(motion), warnings: read.warnings.clone() }))
    }
}

/// Runs `count` cases on all cores and returns their table, one row per case; `None` if stopped.
///
/// `make` creates a case from its number, and the rows are in the order of the numbers. The observer is called for
/// every case and may stop the run. A case that cannot be created has a row with the reason as its error. Cases of the
/// same topology run together if `kind` returns the same value for them; results do not depend on `kind`.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use barrelstack_stack::Scenario;
/// use barrelstack_stack::ensemble::{Grounds, Prepared, rows};
///
/// let base = Scenario::builtin("sliding-block", &[])?;
/// let grounds = Grounds::default();
/// let make = |number: usize| {
///     let change = format!("interface.block-ground.friction.coefficient={}", 0.1 * (number + 1) as f64);
///     let scenario = base.with(&[change]).map_err(|error| error.sentence())?;
///     let ground = grounds.of(&scenario).map_err(|error| error.to_string())?;
///     Ok(Prepared::shaken_by(scenario.into(), ground))
/// };
/// let table = rows(9, &|_| 0, &make, None, &|_| ControlFlow::Continue(()), &|| false);
/// assert_eq!(table.map(|table| table[0].values.len()), Some(9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rows(
    count: usize,
    kind: &dyn Fn(usize) -> u64,
    make: &(dyn Fn(usize) -> Result<Prepared, String> + Sync),
    lanes: Option<Width>,
    observer: &(dyn Fn(&CaseResult) -> ControlFlow<()> + Sync),
    asked_to_stop: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<Column>> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|number| kind(*number));
    let stopped = AtomicBool::new(false);
    let lanes = lanes.unwrap_or_else(Width::widest);
    let together = |numbers: &&[usize]| -> Option<Vec<Column>> {
        let report = |result: &CaseResult| {
            if observer(result).is_break() {
                stopped.store(true, Ordering::Relaxed);
            }
        };
        let stop = || stopped.load(Ordering::Relaxed) || asked_to_stop();
        let mut made = Vec::with_capacity(numbers.len());
        for number in *numbers {
            if stop() {
                return None;
            }
            made.push(make(*number));
        }
        let ready: Vec<Prepared> = made.iter().filter_map(|one| one.clone().ok()).collect();
        let mut report_one = |result: &CaseResult| report(result);
        let mut audience = Audience { on_case: &mut report_one, stop: &stop };
        let mut done = simulate_in(lanes, &ready, &mut audience)?.into_iter();
        let result = |one: Result<Prepared, String>| match one {
            Ok(_) => done.next(),
            Err(reason) => {
                let failed = CaseResult::failed(reason);
                report(&failed);
                Some(failed)
            }
        };
        let results: Option<Vec<CaseResult>> = made.into_iter().map(result).collect();
        Some(table(&results?))
    };
    let size = count.div_ceil(SHARE * pool::cores()).clamp(1, BATCH);
    let batches: Vec<&[usize]> = order.chunks(size).collect();
    let parts: Option<Vec<Vec<Column>>> =
        pool::map(&batches, together, &|_| ()).into_iter().collect();
    let parts = parts?;
    // Batch of each case, and its row in that batch.
    let mut places = vec![(0, 0); count];
    for (at, number) in order.iter().enumerate() {
        places[*number] = (at / size, at % size);
    }
    let column = |index: usize| {
        let mut column = Column::empty(CASE_COLUMNS[index].spec());
        for (part, row) in &places {
            // Columns and values come from the same list, so every value has the kind of its column.
            let _ = column.values.push(parts[*part][index].values.get(*row));
        }
        column
    };
    Some((0..CASE_COLUMNS.len()).map(column).collect())
}
