//! Devices on a stack, and devices that could be added.

use barrelstack::Scenario;
use barrelstack::device::DEVICES;
use barrelstack::report;
use barrelstack::scenario::MotionSource;
use barrelstack::variants::planes;
use barrelstack_report::Language;
use serde::Serialize;

/// The devices on a stack, and devices that could be added.
#[derive(Serialize)]
pub(crate) struct Devices {
    /// Names of the devices on the stack, with their tables in `[stack]`.
    present: Vec<DeviceTable>,
    /// Devices that the stack does not have but that could be added, one entry for each possible setting.
    candidates: Vec<Candidate>,
}

#[derive(Serialize)]
struct DeviceTable {
    name: String,
    table: String,
}

/// A device that could be added to the stack, with one of its possible settings.
#[derive(Serialize)]
struct Candidate {
    device: &'static str,
    /// Description of the setting, in the language of the answer.
    name: String,
    /// Changes to the scenario, such as `stack.lid.levels=1`.
    changes: Vec<String>,
}

impl Devices {
    /// Lists the devices of a scenario. A candidate is listed only if the stack with this device can
    /// be assembled; this check leaves out the ground motion.
    pub(crate) fn of(scenario: &Scenario, language: Language) -> Self {
        let mut still = scenario.clone();
        still.motion.source = MotionSource::None;
        let text = still.to_resolved_toml();
        let Some(stack) = scenario.stack() else {
            return Self { present: Vec::new(), candidates: Vec::new() };
        };
        let on = stack.devices.present();
        let fits = |changes: &[String]| {
            let tried = Scenario::parse("scenario", &text, changes).ok();
            let planes = tried.and_then(|tried| planes(&tried).ok());
            planes.is_some_and(|planes| report::still(&planes).is_ok())
        };
        let mut candidates = Vec::new();
        let mut present = Vec::new();
        for words in DEVICES {
            let settings = words.settings(stack.levels);
            if on.contains(words) {
                let table = settings.iter().find_map(|(_, changes)| table(changes.first()?));
                present.extend(
                    table.map(|table| DeviceTable { name: language.text(words.many), table }),
                );
                continue;
            }
            for (name, changes) in settings.into_iter().filter(|(_, changes)| fits(changes)) {
                let name = language.text(&name);
                candidates.push(Candidate { device: words.one, name, changes });
            }
        }
        Self { present, candidates }
    }
}

/// Returns the table in `[stack]` to which a change refers, such as `lid` for `stack.lid.levels=1`; `None` if the
/// change does not have this form.
fn table(change: &str) -> Option<String> {
    Some(change.strip_prefix("stack.")?.split_once('.')?.0.to_owned())
}
