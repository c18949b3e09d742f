//! Forces in the elements of every device, under the names that the device defines.

use barrelstack_dynamics::{Element, Space};
use barrelstack_report::described::{Described, Objects};
use serde::{Serialize, Serializer, ser::SerializeMap};

use serde_json::{Map, Value, json};

use crate::device::{DEVICES, FREE, Words};
use crate::run::Run;
use crate::watch::ElementFate;

/// All devices with their force elements, including the elements of a free scene. A device that the
/// stack does not have is listed without elements.
#[derive(Clone, Debug)]
pub struct Devices(pub Vec<Device>);

/// A device and its force elements.
#[derive(Clone, Debug)]
pub struct Device {
    /// Display strings of the device.
    pub words: &'static Words,
    /// Results of its force elements.
    pub elements: Vec<ElementSummary>,
}

/// Result of one force element.
#[derive(Clone, Debug)]
pub struct ElementSummary {
    words: &'static Words,
    /// Name of the element, such as "B5.1-R5 left".
    pub name: String,
    /// Force (N) with the largest magnitude until the first loss of a seat.
    pub peak: f64,
    /// Time (s) of the force `peak`.
    pub peak_at: f64,
    /// Force (N) with the largest magnitude over the whole run.
    pub peak_whole_run: f64,
    /// Time (s) of the force `peak_whole_run`.
    pub peak_whole_run_at: f64,
    /// Time (s) at which the element failed; `None` if the element did not fail.
    pub broken_at: Option<f64>,
}

impl Devices {
    /// Returns the devices of a run.
    pub(super) fn of(run: &Run) -> Self {
        let assembly = &run.assembly;
        let devices = assembly.devices.iter().copied();
        Self::borne(&assembly.model.elements().iter().zip(devices).zip(&run.elements))
    }

    /// Groups the forces in the elements of a run by device. Each item of `elements` contains an element, the display
    /// strings of its device, and the forces in the element.
    pub fn borne<'a, S: Space + 'a>(
        elements: &(impl Iterator<Item = ((&'a Element<S>, &'static Words), &'a ElementFate)> + Clone),
    ) -> Self {
        let device = |words: &'static Words| {
            let own = elements.clone().filter(|((_, device), _)| **device == *words);
            let element = |((element, _), fate): ((&Element<S>, _), &ElementFate)| {
                let ElementFate { peak, peak_whole_run: whole, broken_at } = *fate;
                ElementSummary {
                    words,
                    name: element.link().name.clone(),
                    peak: peak.0,
                    peak_at: peak.1,
                    peak_whole_run: whole.0,
                    peak_whole_run_at: whole.1,
                    broken_at,
                }
            };
            Device { words, elements: own.map(element).collect() }
        };
        Self(all_words().map(device).collect())
    }

    /// Returns the elements of the device with the plural name `many`; empty if there is no such device.
    pub fn named(&self, many: &str) -> &[ElementSummary] {
        let device = self.0.iter().find(|device| device.words.many == many);
        device.map_or(&[], |device| &device.elements)
    }
}

/// Serializes one list per device, under its plural name.
impl Serialize for Devices {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let keyed = |device: &'_ Device| (key(device.words.many), device.elements.clone());
        serializer.collect_map(self.0.iter().map(keyed))
    }
}

/// Serializes the forces under the names that the device defines.
impl Serialize for ElementSummary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Words { force, broken, .. } = self.words;
        let mut map = serializer.serialize_map(Some(6))?;
        map.serialize_entry("name", &self.name)?;
        map.serialize_entry(&format!("peak_{force}"), &self.peak)?;
        map.serialize_entry(&format!("peak_{force}_at"), &self.peak_at)?;
        map.serialize_entry(&format!("peak_{force}_whole_run"), &self.peak_whole_run)?;
        map.serialize_entry(&format!("peak_{force}_whole_run_at"), &self.peak_whole_run_at)?;
        map.serialize_entry(&format!("{broken}_at"), &self.broken_at)?;
        map.end()
    }
}

impl Described for Devices {
    fn schema(objects: &mut Objects) -> Value {
        let number = |unit: &str, meaning: &str| json!({ "type": "number", "unit": unit, "description": meaning });
        let mut properties = Map::new();
        for Words { one, many, force, broken, .. } in all_words() {
            let mut at = number(
                "s",
                &format!("Time at which the element was {broken}; null if it was not."),
            );
            at["type"] = json!(["number", "null"]);
            let element = json!({
                "name": {
                    "type": "string",
                    "description": "Names of the bodies that the element joins, and the position of the element."
                },
                (format!("peak_{force}")): number(
                    "N",
                    &format!("The {force} with the largest magnitude until the first loss of a seat."),
                ),
                (format!("peak_{force}_at")): number("s", "Time of the largest value until the first loss of a seat."),
                (format!("peak_{force}_whole_run")): number("N", &format!("The {force} with the largest magnitude over the whole run.")),
                (format!("peak_{force}_whole_run_at")): number("s", "Time of the largest value over the whole run."),
                (format!("{broken}_at")): at,
            });
            objects.insert(key(one), closed(&format!("Forces in one {one}."), &element));
            let list = json!({
                "type": "array",
                "items": { "$ref": format!("#/$defs/{}", key(one)) },
                "description": format!("All {many}."),
            });
            properties.insert(key(many), list);
        }
        objects.insert("Devices".into(), closed("The devices.", &Value::Object(properties)));
        json!({ "$ref": "#/$defs/Devices" })
    }
}

/// Returns the display strings of every device, and of the elements of free scenes.
fn all_words() -> impl Iterator<Item = &'static Words> {
    DEVICES.iter().copied().chain([&FREE])
}

/// Converts a name to a document key by replacing spaces with underscores.
fn key(words: &str) -> String {
    words.replace(' ', "_")
}

/// Returns the JSON schema of an object that has exactly the given properties.
fn closed(meaning: &str, properties: &Value) -> Value {
    let required: Vec<&String> = properties.as_object().into_iter().flat_map(Map::keys).collect();
    json!({
        "type": "object",
        "description": meaning,
        "required": required,
        "properties": properties,
        "additionalProperties": false,
    })
}
