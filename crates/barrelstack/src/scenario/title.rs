//! The title of what is run, where that is no longer what the title at hand was written for.

use std::path::Path;

use super::catalog::RECORDS;
use super::{MotionSource, RecordSource, Scenario, Scene, StackSpec, View};

/// Numbers in words, from zero.
const WORDS: [&str; 13] = [
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
    "twelve",
];

/// What stands and what shakes it, such as "Six barrels on three levels, elCentro.AT2"; the old title and
/// that it was changed for a free scene.
pub(super) fn of(scenario: &Scenario) -> String {
    let Scene::Stack { stack, .. } = &scenario.scene else {
        return format!("{}, changed", scenario.title);
    };
    format!("{}, {}", stands(stack), shakes(&scenario.motion.source))
}

fn stands(stack: &StackSpec) -> String {
    let mut barrels = counted(stack.levels * stack.columns, "barrel");
    barrels[..1].make_ascii_uppercase();
    let levels = counted(stack.levels, "level");
    let view = match stack.view {
        View::Transverse => "",
        View::Longitudinal => ", along the barrels",
    };
    format!("{barrels} on {levels}{view}")
}

fn shakes(motion: &MotionSource) -> String {
    match motion {
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
    }
}

fn counted(count: u32, one: &str) -> String {
    let number = WORDS.get(count as usize).map_or_else(|| count.to_string(), ToString::to_string);
    format!("{number} {one}{}", if count == 1 { "" } else { "s" })
}
