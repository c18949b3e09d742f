//! Tables of what a stack and its devices bore, in a plane and in space.

use barrelstack_report::{Block, Cell, Table};

use super::sections::hundredths;
use crate::demand::{DEMANDS, Demands};
use crate::summary::{Device, JointSummary};

/// A force (N) in kilonewtons, to the weight of a kilogram.
fn kilonewtons(value: f64) -> Cell {
    Cell::Measured(1e-3 * value, 2)
}

/// The demands on a stack.
pub fn demand_table(demands: &Demands) -> Table {
    let mut table = Table::new(
        "While the stack stood, unless said otherwise.",
        &[("demand", ""), ("value", ""), ("unit", "")],
    );
    for demand in DEMANDS {
        if let Some(value) = demand.shown(demands) {
            let (label, unit) = (Cell::text(demand.label), Cell::text(demand.shown_unit));
            table.rows.push(vec![label, Cell::Measured(value, demand.decimals), unit]);
        }
    }
    table
}

/// The largest forces at interfaces.
pub fn interface_table(caption: &str, interfaces: &[JointSummary]) -> Table {
    let mut table = Table::new(
        caption,
        &[
            ("interface", ""),
            ("vertical at rest", "kN"),
            ("vertical, largest", "kN"),
            ("at", "s"),
            ("horizontal, largest", "kN"),
            ("at", "s"),
        ],
    );
    for joint in interfaces {
        table.rows.push(vec![
            Cell::text(&joint.name),
            kilonewtons(joint.at_rest),
            kilonewtons(joint.peak_vertical),
            hundredths(Some(joint.peak_vertical_at)),
            kilonewtons(joint.peak_horizontal),
            hundredths(Some(joint.peak_horizontal_at)),
        ]);
    }
    table
}

/// What the elements of a device bore, as a table; none where it is not there.
pub fn device_table(Device { words, elements }: &Device) -> Vec<Block> {
    let largest = format!("{}, largest", words.force);
    let mut table = Table::new(
        format!(
            "Largest {} of every {} in the whole run. Left and right are those of the picture.",
            words.force, words.one
        ),
        &[(words.one, ""), (&largest, "kN"), ("at", "s"), (words.broken, "s")],
    );
    for element in elements {
        let at = (element.peak != 0.0).then_some(element.peak_at);
        table.rows.push(vec![
            Cell::text(&element.name),
            kilonewtons(element.peak),
            hundredths(at),
            hundredths(element.broken_at),
        ]);
    }
    if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] }
}
