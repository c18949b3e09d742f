//! Options given by the caller, with flags for the options that a reader has used.

use std::cell::{Cell, RefCell};

use super::ReadOptions;
use crate::instrument::{Instrument, SeedName};
use crate::record::Quantity;
use crate::units::AccelerationUnit;
use crate::utc::Utc;

/// Largest relative difference between two sensitivities of one channel that is attributed to
/// rounding.
const LARGEST_DIFFERENCE: f64 = 0.005;

/// Options given by the caller, with flags for the options that a reader has used.
///
/// A reader queries only information that the file does not state. Unused options are ignored and
/// reported.
pub(super) struct Hints<'a> {
    options: &'a ReadOptions,
    unit: Cell<bool>,
    time_step: Cell<bool>,
    sensitivity: Cell<bool>,
    recorded: Cell<bool>,
    /// Description of contradictory metadata of one channel, if there are any.
    contradiction: RefCell<Option<String>>,
}

impl<'a> Hints<'a> {
    pub(super) fn new(options: &'a ReadOptions) -> Self {
        let no = || Cell::new(false);
        Self {
            options,
            unit: no(),
            time_step: no(),
            sensitivity: no(),
            recorded: no(),
            contradiction: RefCell::default(),
        }
    }

    pub(super) fn options(&self) -> &'a ReadOptions {
        self.options
    }

    /// Sets the flags of all options whose flags are set in `other`.
    pub(super) fn used_as(&self, other: &Hints<'_>) {
        for (mine, theirs) in [
            (&self.unit, &other.unit),
            (&self.time_step, &other.time_step),
            (&self.sensitivity, &other.sensitivity),
            (&self.recorded, &other.recorded),
        ] {
            mine.set(mine.get() || theirs.get());
        }
    }

    pub(super) fn unit(&self) -> Option<AccelerationUnit> {
        self.unit.set(true);
        self.options.unit
    }

    pub(super) fn time_step(&self) -> Option<f64> {
        self.time_step.set(true);
        self.options.time_step
    }

    pub(super) fn sensitivity(&self) -> Option<f64> {
        self.sensitivity.set(true);
        self.options.sensitivity
    }

    /// Returns the first entry of the caller's metadata that applies to the channel `seed` at the time
    /// `start`; `None` if no entry applies.
    pub(super) fn instrument(&self, seed: &SeedName, start: Option<Utc>) -> Option<&'a Instrument> {
        self.sensitivity.set(true);
        let mut fitting =
            self.options.instruments.iter().filter(|known| known.describes(seed, start));
        let first = fitting.next()?;
        // Metadata given by the caller without a station take precedence over those of a file.
        let differs = |other: &&Instrument| {
            (other.sensitivity / first.sensitivity - 1.0).abs() > LARGEST_DIFFERENCE
        };
        if !first.station.is_empty()
            && let Some(other) = fitting.find(differs)
        {
            *self.contradiction.borrow_mut() = Some(format!(
                "{} and {} counts per m/s2 or m/s for {}.{}.{}.{}",
                first.sensitivity,
                other.sensitivity,
                seed.network,
                seed.station,
                seed.location,
                seed.channel
            ));
        }
        Some(first)
    }

    /// Returns a description of contradictory metadata of one channel, if there are any.
    pub(super) fn contradiction(&self) -> Option<String> {
        self.contradiction.borrow().clone()
    }

    /// Describes the lack of metadata for a channel, for the error about a missing sensitivity.
    pub(super) fn no_instrument(&self, seed: &SeedName, start: Option<Utc>) -> String {
        let count = self.options.instruments.len();
        if count == 0 {
            return "none".to_owned();
        }
        let SeedName { network, station, location, channel } = seed;
        let at = start.map_or_else(String::new, |start| format!(" at {start}"));
        format!(
            "none for {network}.{station}.{location}.{channel}{at} among {count} channels with metadata"
        )
    }

    pub(super) fn recorded(&self) -> Option<Quantity> {
        self.recorded.set(true);
        self.options.recorded
    }

    /// Returns the names of the options that were given but not used.
    pub(super) fn ignored(&self) -> impl Iterator<Item = &'static str> {
        let options = self.options;
        let counts = options.sensitivity.is_some() || !options.instruments.is_empty();
        [
            (options.unit.is_some() && !self.unit.get(), "the unit"),
            (options.time_step.is_some() && !self.time_step.get(), "the time step"),
            (counts && !self.sensitivity.get(), "the sensitivity"),
            (options.recorded.is_some() && !self.recorded.get(), "the quantity"),
        ]
        .into_iter()
        .filter_map(|(ignored, what)| ignored.then_some(what))
    }
}
