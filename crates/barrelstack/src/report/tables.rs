//! Tables of the forces and demands on a stack and its devices, for planar and spatial models.

use barrelstack_report::{Block, Cell, Table};

use crate::demand::{DEMANDS, Demands};
use crate::summary::{Device, JointSummary};

/// Formats a force (N) in kilonewtons, with two decimals.
fn kilonewtons(value: f64) -> Cell {
    Cell::Measured(1e-3 * value, 2)
}

/// Explains the two stress amplifications, of which either may be the larger one.
const TWO_RATIOS: &str = " The ratio of largest stresses is the largest stress on a barrel, divided by its largest \
                          stress at rest; the two may occur at different points. For the ratio of average stresses, \
                          the largest stress at each point, and the stress at rest, are first averaged over the part \
                          of the boundary that is loaded at rest. Either ratio may be the larger one.";

/// `true` if both stress amplifications are known.
fn both(demands: &Demands) -> bool {
    demands.stress_amplification.is_some() && demands.mean_stress_amplification.is_some()
}

/// Tabulates the demands on a stack until the first loss of a seat, and over the whole run.
pub fn demand_table(until_loss: &Demands, whole_run: &Demands) -> Table {
    Table::of(
        format!(
            "Demands on the stack in the run that is shown, until the first loss of a seat and over the whole run, \
             falls included.{}",
            if both(until_loss) { TWO_RATIOS } else { "" }
        ),
        DEMANDS.iter().filter_map(|demand| {
            Some((demand, demand.shown(until_loss)?, demand.shown(whole_run)))
        }),
        &[
            ("demand", "", &|(demand, ..)| Cell::text(demand.label)),
            ("until the loss", "", &|(demand, value, _)| {
                Cell::measured((!demand.is_of_the_end()).then_some(*value), demand.decimals)
            }),
            ("whole run", "", &|(demand, _, value)| Cell::measured(*value, demand.decimals)),
            ("unit", "", &|(demand, ..)| Cell::text(demand.shown_unit)),
        ],
    )
}

/// Formats the time (s) of a maximum force (N), with two decimals; the cell is empty if the force is zero.
fn at(force: f64, time: f64) -> Cell {
    Cell::measured((force != 0.0).then_some(time), 2)
}

/// Tabulates the largest forces at interfaces.
pub fn interface_table(caption: &str, interfaces: &[JointSummary]) -> Table {
    Table::of(
        caption,
        interfaces,
        &[
            ("interface", "", &|joint| Cell::text(&joint.name)),
            ("vertical at rest", "kN", &|joint| kilonewtons(joint.at_rest)),
            ("vertical, largest until the loss", "kN", &|joint| kilonewtons(joint.peak_vertical)),
            ("at", "s", &|joint| at(joint.peak_vertical, joint.peak_vertical_at)),
            ("horizontal", "kN", &|joint| kilonewtons(joint.peak_horizontal)),
            ("at", "s", &|joint| at(joint.peak_horizontal, joint.peak_horizontal_at)),
            ("vertical, whole run", "kN", &|joint| kilonewtons(joint.peak_vertical_whole_run)),
            ("at", "s", &|joint| {
                at(joint.peak_vertical_whole_run, joint.peak_vertical_whole_run_at)
            }),
            ("horizontal", "kN", &|joint| kilonewtons(joint.peak_horizontal_whole_run)),
            ("at", "s", &|joint| {
                at(joint.peak_horizontal_whole_run, joint.peak_horizontal_whole_run_at)
            }),
        ],
    )
}

/// Tabulates the forces in the elements of a device; empty if the device has no elements.
pub fn device_table(Device { words, elements }: &Device) -> Vec<Block> {
    let table = Table::of(
        format!(
            "Largest {} of every {} in the run that is shown, until the first loss of a seat and over the whole run. \
             Left and right are as in the picture.",
            words.force, words.one
        ),
        elements,
        &[
            (words.one, "", &|element| Cell::text(&element.name)),
            (&format!("{}, largest", words.force), "kN", &|element| kilonewtons(element.peak)),
            ("at", "s", &|element| at(element.peak, element.peak_at)),
            ("whole run", "kN", &|element| kilonewtons(element.peak_whole_run)),
            ("at", "s", &|element| at(element.peak_whole_run, element.peak_whole_run_at)),
            (words.broken, "s", &|element| Cell::measured(element.broken_at, 2)),
        ],
    );
    if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] }
}
