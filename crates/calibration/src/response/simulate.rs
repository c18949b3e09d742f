//! Simulation of a scenario with changed contact constants, sampled at the times of a recording.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use barrelstack::assemble::assemble;
use barrelstack::outcome::Outcome;
use barrelstack::pool;
use barrelstack::run::{Run, RunFailure, time_step};
use barrelstack::scenario::{Dimension, Scenario};
use barrelstack_input::names::advice;

use crate::parameters::{Parameter, Tunable};
use crate::{CalibrateError, Table};

/// Recorded response: the times (s), and the values of every channel by name.
pub(super) struct Measured {
    pub(super) times: Vec<f64>,
    pub(super) channels: Vec<(String, Vec<f64>)>,
}

impl Measured {
    pub(super) fn read(table: &Table, until: Option<f64>) -> Result<Self, CalibrateError> {
        let mut times = table.required("time", Dimension::TIME)?;
        if let Some(row) = times.iter().position(|time| *time < 0.0) {
            let found = table.cell(row, "time");
            let remedy = "count time from the start of the scenario's motion";
            return Err(table.at(row, "time", "a time of at least zero", &found, remedy).into());
        }
        if let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let expected = format!("a time after {} of the row above", table.cell(row, "time"));
            let found = table.cell(row + 1, "time");
            return Err(table
                .at(row + 1, "time", &expected, &found, "sort the rows by time")
                .into());
        }
        let kept =
            times.iter().take_while(|time| until.is_none_or(|until| **time <= until)).count();
        times.truncate(kept);
        if kept < 3 {
            return Err(table
                .unsuited(format!("only {kept} rows are in the window: lengthen it"))
                .into());
        }
        let mut channels = Vec::new();
        for name in table.names().filter(|name| !name.eq_ignore_ascii_case("time")) {
            let dimension =
                if name.ends_with("rotation") { Dimension::ANGLE } else { Dimension::LENGTH };
            let mut values = table.required(name, dimension)?;
            values.truncate(kept);
            channels.push((name.to_owned(), values));
        }
        if channels.is_empty() {
            return Err(table.unsuited(
                "there is no column besides the time: add channels such as `B1.1_displacement_x (m)`",
            ).into());
        }
        Ok(Self { times, channels })
    }

    /// Returns the time (s) of the last row.
    pub(super) fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }
}

/// Simulates a scenario with contact constants that a point of the parameter space determines ([`Tunable`]).
pub(super) struct Simulator<'a> {
    scenario: Scenario,
    measured: &'a Measured,
    pub(super) tunable: Tunable,
    count: AtomicUsize,
    report: &'a Report<'a>,
    stopped: AtomicBool,
}

/// Progress callback, called repeatedly from several threads. It receives the number of simulations started so far, and
/// may cancel the simulations.
pub(super) type Report<'a> = dyn Fn(usize) -> ControlFlow<()> + Sync + 'a;

impl<'a> Simulator<'a> {
    pub(super) fn new(
        scenario: &Scenario,
        measured: &'a Measured,
        parameters: &[Parameter],
        report: &'a Report<'a>,
    ) -> Result<Self, CalibrateError> {
        let tunable = Tunable::new(scenario, parameters)?;
        let mut scenario = scenario.clone();
        scenario.run.stop_after_collapse = None;
        let scale = scenario.run.similitude.sqrt();
        // All simulations use one time step, so that a change of step is not mistaken for an effect of a parameter. It
        // is the step that a run chooses by default, a small fraction of the critical time step.
        let assembly = assemble(&scenario).map_err(RunFailure::from)?;
        let step = time_step(&scenario, &assembly)? / scale;
        scenario.run.step = Some(step);
        // Two extra steps, so that the time of the last row lies between samples.
        scenario.run.duration = Some(measured.end() / scale + 2.0 * step);
        // Every step is sampled, so that interpolation adds nothing to the residuals.
        scenario.record.history_rate = 1.0 / step;
        scenario.record.frame_rate = 1.0;
        let (count, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        Ok(Self { scenario, measured, tunable, count, report, stopped })
    }

    /// Returns the number of simulations started so far.
    pub(super) fn count(&self) -> usize {
        self.count.load(Ordering::Relaxed)
    }

    /// `true` if the simulations were canceled.
    pub(super) fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Runs the unchanged scenario and checks that the run has a channel for every recorded channel. Returns a warning
    /// if the stack collapses.
    pub(super) fn first(&self) -> Result<Option<String>, CalibrateError> {
        let run = self.run(&vec![0.0; self.tunable.parameters().len()])?;
        if self.stopped() {
            return Err(CalibrateError::Stopped);
        }
        for (name, _) in &self.measured.channels {
            if run.recording.channel(name).is_none() {
                let bodies = run.recording.channels.iter().map(|channel| channel.name.as_str());
                let names: Vec<&str> = bodies
                    .filter(|name| name.contains("_displacement_") || name.ends_with("_rotation"))
                    .filter(|name| !name.starts_with("ground_"))
                    .collect();
                return Err(CalibrateError::Scenario(format!(
                    "the scenario has no channel \"{name}\"; {}",
                    advice(name, &names)
                )));
            }
        }
        match &run.outcome {
            Outcome::Collapse { time, .. } => Ok(Some(format!(
                "with the values of the scenario the stack collapses at {time:.2} s, within the window: end \
                 the window earlier"
            ))),
            Outcome::Invalid { reason } => Err(CalibrateError::Scenario(reason.clone())),
            Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted => Ok(None),
        }
    }

    fn run(&self, point: &[f64]) -> Result<Run, RunFailure> {
        let count = self.count.fetch_add(1, Ordering::Relaxed) + 1;
        self.tunable.at(&self.scenario, point).run_watched(&mut |_| {
            if (self.report)(count).is_break() {
                self.stopped.store(true, Ordering::Relaxed);
            }
            if self.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }

    /// Returns, for each channel, its values at the recorded times. `None` if the stack cannot be simulated or the
    /// simulations are canceled.
    fn channels(&self, point: &[f64]) -> Option<Vec<Vec<f64>>> {
        if self.stopped() {
            return None;
        }
        let run = self.run(point).ok()?;
        if run.interrupted || matches!(run.outcome, Outcome::Invalid { .. }) {
            return None;
        }
        let times = &run.recording.times;
        let channel = |(name, _): &(String, Vec<f64>)| {
            let values = &run.recording.channel(name)?.values;
            Some(
                self.measured.times.iter().map(|time| interpolated(times, values, *time)).collect(),
            )
        };
        self.measured.channels.iter().map(channel).collect()
    }

    /// Returns the result of `channels` for every point, computed on all cores. It does not depend on the number of
    /// threads.
    pub(super) fn batch(&self, points: &[Vec<f64>]) -> Vec<Option<Vec<Vec<f64>>>> {
        pool::map(points, |point| self.channels(point), &|_| ())
    }
}

/// Interpolates linearly between samples; beyond the last sample the value remains constant.
fn interpolated(times: &[f64], values: &[f64], time: f64) -> f64 {
    let above = times.partition_point(|sample| *sample < time);
    match (above.checked_sub(1), values.get(above)) {
        (None, _) => values.first().copied().unwrap_or(0.0),
        (Some(below), None) => values[below],
        (Some(below), Some(high)) => {
            let share = (time - times[below]) / (times[above] - times[below]);
            values[below] + share * (high - values[below])
        }
    }
}
