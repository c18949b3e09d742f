//! Tables of what a stack and its devices bore, in a plane and in space.

use barrelstack_report::{Block, Cell, Table};

use crate::demand::{DEMANDS, Demands};
use crate::summary::{Device, JointSummary};

/// A force (N) in kilonewtons, to the weight of a kilogram.
fn kilonewtons(value: f64) -> Cell {
    Cell::Measured(1e-3 * value, 2)
}

/// The demands on a stack.
pub fn demand_table(demands: &Demands) -> Table {
    Table::of(
        "While the stack stood, unless said otherwise.",
        DEMANDS.iter().filter_map(|demand| Some((demand, demand.shown(demands)?))),
        &[
            ("demand", "", &|(demand, _)| Cell::text(demand.label)),
            ("value", "", &|(demand, value)| Cell::Measured(*value, demand.decimals)),
            ("unit", "", &|(demand, _)| Cell::text(demand.shown_unit)),
        ],
    )
}

/// The largest forces at interfaces.
pub fn interface_table(caption: &str, interfaces: &[JointSummary]) -> Table {
    Table::of(
        caption,
        interfaces,
        &[
            ("interface", "", &|joint| Cell::text(&joint.name)),
            ("vertical at rest", "kN", &|joint| kilonewtons(joint.at_rest)),
            ("vertical, largest", "kN", &|joint| kilonewtons(joint.peak_vertical)),
            ("at", "s", &|joint| Cell::Measured(joint.peak_vertical_at, 2)),
            ("horizontal, largest", "kN", &|joint| kilonewtons(joint.peak_horizontal)),
            ("at", "s", &|joint| Cell::Measured(joint.peak_horizontal_at, 2)),
        ],
    )
}

/// What the elements of a device bore, as a table; none where it is not there.
pub fn device_table(Device { words, elements }: &Device) -> Vec<Block> {
    let table = Table::of(
        format!(
            "Largest {} of every {} in the whole run. Left and right are those of the picture.",
            words.force, words.one
        ),
        elements,
        &[
            (words.one, "", &|element| Cell::text(&element.name)),
            (&format!("{}, largest", words.force), "kN", &|element| kilonewtons(element.peak)),
            ("at", "s", &|element| {
                Cell::measured((element.peak != 0.0).then_some(element.peak_at), 2)
            }),
            (words.broken, "s", &|element| Cell::measured(element.broken_at, 2)),
        ],
    );
    if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] }
}
