//! Generated titles of scenarios.

use std::path::Path;

use super::catalog::RECORDS;
use super::{MotionSource, RecordSource, Scale, Scenario, Scene, StackSpec, View};
use crate::ground::{self, GroundError};

/// Numbers in words, from zero.
const WORDS: [&str; 13] = [
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
    "twelve",
];

/// Suffix of the title of a changed scenario, used if the rest of the title does not show the change.
pub(super) const CHANGED: &str = ", changed";

/// Returns a title with the suffix `, changed` removed, if present.
pub fn without_changed(title: &str) -> &str {
    title.strip_suffix(CHANGED).unwrap_or(title)
}

/// A title that the user wrote, with the words for the stack and for the motion to which it applies.
#[derive(Clone)]
pub(super) struct Own {
    title: String,
    /// Words for the stack and for the motion; `None` if they are unknown.
    stated: Option<(String, String)>,
}

impl Own {
    /// Returns a title that applies to the scenario `stated`; `None` if the title was generated from this scenario.
    ///
    /// If words about changes were appended to the title, as in the resolved text of a changed scenario, they are left
    /// out.
    pub(super) fn of(title: &str, stated: Option<&Scenario>) -> Option<Self> {
        let mut title = without_changed(title);
        let Some((stated, Scene::Stack { stack, .. })) = stated.map(|one| (one, &one.scene)) else {
            return Some(Self { title: title.to_owned(), stated: None });
        };
        let words = (stands(stack), shakes(stated, None));
        // A generated title may name the event of a record, which is not known without its file. The names of all other
        // motions are known; the date of an event or a scale may follow them.
        let name = words.1.split(", ").next().unwrap_or(&words.1);
        let of_a_file = matches!(
            &stated.motion.source,
            MotionSource::Record(record) if matches!(record.source, RecordSource::File(_))
        );
        if title.strip_prefix(&words.0).is_some_and(|rest| {
            rest.is_empty()
                || rest.strip_prefix(", ").is_some_and(|rest| of_a_file || rest.starts_with(name))
        }) {
            return None;
        }
        if let Some((own, _)) = title.split_once(&format!(": {}", lower(&words.0))) {
            title = own;
        } else if let Some(own) = title.strip_suffix(&format!(": {}", words.1)) {
            title = own;
        }
        Some(Self { title: title.to_owned(), stated: Some(words) })
    }

    /// Appends words for the stack and for the motion to the title. Words are left out if they also apply to the stated
    /// scenario or already occur in the title. If all words also apply to the stated scenario, [`CHANGED`] is appended
    /// instead.
    fn with(&self, stands: &str, shakes: &str) -> String {
        let known = |of: fn(&(String, String)) -> &String| self.stated.as_ref().map(of);
        let mut changed = Vec::new();
        if known(|words| &words.0).is_none_or(|stated| stated != stands) {
            changed.push(lower(stands));
        }
        if known(|words| &words.1).is_none_or(|stated| stated != shakes) {
            changed.push(shakes.to_owned());
        }
        if changed.is_empty() {
            return self.title.clone() + CHANGED;
        }
        let title = self.title.to_lowercase();
        changed.retain(|words| !title.contains(&words.to_lowercase()));
        if changed.is_empty() {
            return self.title.clone();
        }
        format!("{}: {}", self.title, changed.join(", "))
    }
}

fn lower(words: &str) -> String {
    let mut lower = words.to_owned();
    lower[..1].make_ascii_lowercase();
    lower
}

/// Returns a title that describes the stack and its motion, such as "Six barrels on three levels, elCentro.AT2". If the
/// user wrote a title, the changes are appended to it, as in "My stack: elCentro.AT2". For a free scene, returns the
/// title of the scenario with ", changed" appended.
pub(super) fn of(scenario: &Scenario) -> String {
    let Scene::Stack { stack, .. } = &scenario.scene else {
        return without_changed(&scenario.title).to_owned() + CHANGED;
    };
    let (stands, shakes) = (stands(stack), shakes(scenario, None));
    match &scenario.written.own {
        Some(own) => own.with(&stands, &shakes),
        None => format!("{stands}, {shakes}"),
    }
}

impl Scenario {
    /// Returns the scenario with a title that names the event of its record. If the title was not generated, it is left
    /// unchanged. The event is read from the file of the record.
    ///
    /// # Errors
    /// If the record cannot be read.
    pub fn with_event(&self) -> Result<Self, GroundError> {
        let mut named = self.clone();
        let Scene::Stack { stack, .. } = &self.scene else { return Ok(named) };
        if self.written.own.is_none()
            && self.title == of(self)
            && let Some(event) = ground::event(&self.motion)?
        {
            named.title = format!("{}, {}", stands(stack), shakes(self, Some(&event)));
        }
        Ok(named)
    }
}

fn stands(stack: &StackSpec) -> String {
    // In three dimensions, and in both planes, barrels also stand behind each other.
    let rows = stack.space.map(|space| space.columns_along).or(stack.columns_along).unwrap_or(1);
    let mut barrels = counted(stack.levels * stack.columns * rows, "barrel");
    barrels[..1].make_ascii_uppercase();
    let levels = counted(stack.levels, "level");
    let view = match stack.view {
        View::Transverse => "",
        View::Longitudinal => ", along the barrels",
    };
    let strapped = stack.devices.strap.levels;
    let straps = match strapped {
        0 => String::new(),
        all if all == stack.levels => ", strapped".to_owned(),
        some => format!(", {} strapped", number(some)),
    };
    let others = stack.devices.present().into_iter().filter(|words| words.one != "strap");
    let others: Vec<&str> = others.map(|words| words.many).collect();
    let with = if others.is_empty() { "" } else { ", with " };
    let others = with.to_owned() + &others.join(", ");
    format!("{barrels} on {levels}{straps}{others}{view}")
}

/// Returns a description of the motion and its scale; a record is named by its event if the event is known.
pub fn shakes(scenario: &Scenario, event: Option<&str>) -> String {
    let motion = &scenario.motion.source;
    let scaled = match scenario.motion.scale {
        Scale::Factor(1.0) => String::new(),
        Scale::Factor(factor) => format!(", times {factor}"),
        Scale::Pga(peak) => format!(", at {:.2} g", peak / barrelstack_motion::STANDARD_GRAVITY),
        Scale::Pgv(peak) => format!(", at {:.0} cm/s", 100.0 * peak),
        Scale::Measure { .. } => ", scaled".to_owned(),
    };
    if let Some(event) = event {
        return event.to_owned() + &scaled;
    }
    let name = match motion {
        MotionSource::None => "ground at rest".to_owned(),
        MotionSource::Record(record) => match &record.source {
            RecordSource::File(file) => {
                let name = Path::new(&file.path).file_name();
                name.map_or_else(|| file.path.clone(), |name| name.to_string_lossy().into_owned())
            }
            RecordSource::Bundled(name) => {
                let known = RECORDS.iter().find(|(known, _)| known == name);
                let text = known.and_then(|(_, text)| text.split(',').next());
                text.unwrap_or(name).to_owned()
            }
        },
        MotionSource::Sine(sine) => format!("sine of {:.2} s", sine.period),
        MotionSource::Pulse(pulse) => format!("pulse of {:.2} s", pulse.period),
    };
    name + &scaled
}

/// Returns a number in words up to twelve, and in digits above.
pub fn number(count: u32) -> String {
    WORDS.get(count as usize).map_or_else(|| count.to_string(), ToString::to_string)
}

/// Returns a count in words with its noun, in the plural if needed.
pub fn counted(count: u32, one: &str) -> String {
    format!("{} {one}{}", number(count), if count == 1 { "" } else { "s" })
}
