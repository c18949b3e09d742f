//! What every rack has to go through, which must not change under a name: scores compare only within one protocol.

use std::fmt::Write as _;

use crate::heights::synthetic;
use crate::protect::NAPA;
use crate::scenario::Scenario;

/// A protocol.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// Its name and version.
    pub name: &'static str,
    /// Levels of the stack.
    pub levels: u32,
    /// Levels of peak ground velocity (m/s) to which every motion is scaled, ascending.
    pub velocities: Vec<f64>,
    /// Periods (s) of the pulses.
    pub periods: Vec<f64>,
    /// How many synthetic motions, and the seed of these and of friction.
    pub synthetic: u32,
    /// The seed.
    pub seed: u32,
    /// The chance of collapse at which the velocity is the score.
    pub chance: f64,
}

/// Friction of barrels on wet cradles, as condensation and washing leave them: lists of coefficients say about 0.2 for
/// wet metal on dry wood. An assumption for barrels, which nobody has tested wet.
const WET: f64 = 0.2;

/// A state in which a stack is scored.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// In words.
    pub name: String,
    /// What it changes, as overrides of the scenario.
    pub changes: Vec<String>,
}

impl Protocol {
    /// The protocol of the RockScore: stacks of four levels; six velocity pulses, both components of the bundled
    /// record and sixteen synthetic motions, at six levels; friction, stiffness and damping of seats drawn as variants
    /// draw them. Under its first number friction alone was drawn, less widely, and constants belonged to contact elements.
    pub fn rockscore() -> Self {
        Self {
            name: "rockscore/2",
            levels: 4,
            velocities: vec![0.15, 0.25, 0.40, 0.60, 0.90, 1.35],
            periods: vec![0.5, 0.8, 1.2, 1.8, 2.7, 4.0],
            synthetic: 16,
            seed: 1,
            chance: 0.1,
        }
    }

    /// What it makes of a scenario, as overrides.
    pub(super) fn stacked(&self) -> Vec<String> {
        vec![format!("stack.levels={}", self.levels)]
    }

    /// How many motions there are.
    pub fn count(&self) -> usize {
        self.periods.len() + 2 + self.synthetic as usize
    }

    /// As good as new, with wet cradles, and with every device as use leaves it.
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

    /// The motions, as sets of a study.
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
