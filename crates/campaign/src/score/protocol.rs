//! Protocol of a score.
//!
//! A protocol must never change without a new name, since only scores of the same protocol are comparable.

use std::fmt::Write as _;

use crate::heights::synthetic;
use crate::protect::NAPA;
use crate::scenario::Scenario;

/// Protocol of a score: stack, motions, levels and seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// Name and version of the protocol.
    pub name: String,
    /// Number of levels of the stack.
    pub levels: u32,
    /// Levels of peak ground velocity (m/s) to which every motion is scaled, in ascending order.
    pub velocities: Vec<f64>,
    /// Periods (s) of the velocity pulses.
    pub periods: Vec<f64>,
    /// Number of synthetic motions.
    pub synthetic: u32,
    /// Seed of the synthetic motions and of the constants that are drawn for each run.
    pub seed: u32,
    /// Probability of collapse that defines the score.
    pub chance: f64,
}

/// Friction coefficient of barrels on cradles that are wet from condensation or washing.
///
/// Tables give about 0.2 for wet metal on dry wood. For barrels this is an assumption, since no wet tests are known.
const WET: f64 = 0.2;

/// State in which a stack is scored.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Name for display.
    pub name: String,
    /// Overrides that put the stack of the scenario into this state.
    pub changes: Vec<String>,
}

impl Protocol {
    /// Returns the protocol of the RockScore.
    ///
    /// Stacks with four levels of barrels are shaken by six velocity pulses, both components of the bundled record and
    /// sixteen synthetic motions. Each motion is scaled to six levels of peak ground velocity. The friction, stiffness
    /// and damping of seats are drawn for each run. The [`variants`](barrelstack::variants) of a stack are drawn from
    /// the same distributions. In version 1, only friction was drawn, with less scatter, and contact constants were
    /// stated per contact element.
    pub fn rockscore() -> Self {
        Self {
            name: "rockscore/2".to_owned(),
            levels: 4,
            velocities: vec![0.15, 0.25, 0.40, 0.60, 0.90, 1.35],
            periods: vec![0.5, 0.8, 1.2, 1.8, 2.7, 4.0],
            synthetic: 16,
            seed: 1,
            chance: 0.1,
        }
    }

    /// Returns a faster protocol, with every `step`-th pulse, both components of the bundled record, and one `step`-th
    /// of the synthetic motions. Its name contains the step, since only scores of the same protocol are comparable.
    /// For a `step` of at most 1, the protocol is returned unchanged.
    #[must_use]
    pub fn thinned(self, step: u32) -> Self {
        if step <= 1 {
            return self;
        }
        let periods = self.periods.iter().copied().step_by(step as usize).collect();
        let name = format!("{}, one motion in {step}", self.name);
        Self { name, periods, synthetic: self.synthetic / step, ..self }
    }

    /// Returns the protocol, renamed for the given stack: for a three-dimensional stack, the name contains `-space`.
    pub(super) fn of(&self, stack: &Scenario) -> Self {
        if !stack.is_spatial() {
            return self.clone();
        }
        let name = match self.name.split_once(", ") {
            Some((name, motions)) => format!("{name}-space, {motions}"),
            None => format!("{}-space", self.name),
        };
        Self { name, ..self.clone() }
    }

    /// Returns the overrides that set the number of levels of a stack to that of the protocol.
    pub(super) fn stacked(&self) -> Vec<String> {
        vec![format!("stack.levels={}", self.levels)]
    }

    /// Returns the number of motions of the protocol.
    pub fn count(&self) -> usize {
        self.periods.len() + 2 + self.synthetic as usize
    }

    /// Returns the states to be scored: in new condition, with wet cradles, and with each device worn.
    pub fn states(&self, scenario: &Scenario) -> Vec<State> {
        let state = |name: &str, changes: Vec<String>| State { name: name.to_owned(), changes };
        let friction = |field: &str| format!("interface.barrel-rack.friction.{field}={WET}");
        let known = |field: &str| {
            let path = format!("interface.barrel-rack.friction.{field}");
            scenario.settings().iter().any(|setting| setting.path == path)
        };
        let fields = ["coefficient", "static_coefficient"].into_iter().filter(|field| known(field));
        let mut states = vec![state("as good as new", Vec::new())];
        states.push(state("wet cradles", fields.map(friction).collect()));
        let devices = scenario.stack().map(|stack| stack.devices.present()).unwrap_or_default();
        for worn in devices.into_iter().flat_map(|words| words.degraded) {
            let changes = worn.overrides.iter().map(|change| (*change).to_owned());
            states.push(state(worn.name, changes.collect()));
        }
        states
    }

    /// Returns the motions of the protocol, as `[[motion]]` tables of a study.
    pub(super) fn motions(&self) -> String {
        let mut text = String::new();
        for period in &self.periods {
            // Writing to a String cannot fail.
            let _ = write!(
                text,
                "[[motion]]\nname = \"pulse of {period} s\"\npulse = {{ kind = \"mavroeidis-papageorgiou\", \
                 amplitude = \"50 cm/s\", period = \"{period} s\", gamma = 1.5, phase = \"90 deg\" }}\n\n"
            );
        }
        text + NAPA + &synthetic(self.synthetic, "")
    }
}
