//! Comparison of the results with field observations at Napa in 2014.

use barrelstack_report::{Block, Cell, Table};

use super::page::span;
use super::plan::VELOCITIES;
use super::{AtLevel, Heights};
use crate::decision::percent;
use crate::direction::Direction;

/// Minimum number of levels of the stacks that are compared with the field observations.
const LOWEST_OBSERVED: u32 = 4;

/// Compares the results with field observations at Napa.
pub(super) fn napa(all: &Heights) -> Vec<Block> {
    let mut blocks = Vec::new();
    if all.request.highest >= LOWEST_OBSERVED {
        blocks.push(Block::Table(observations(all)));
    }
    blocks.push(Block::Table(recorded(all)));
    blocks.push(Block::List(vec![
        "Observed near Napa: peak accelerations above 0.5 g and velocities above 50 cm/s (USGS 2015). Half of the \
         18,000 barrels in one warehouse fell, and almost every stack in one of its rooms collapsed (Wines & Vines \
         2014). Most stacks that collapsed in the county stood on portable racks for two barrels (FEMA P-1024, as \
         reported by Wines & Vines 2017)."
            .into(),
        "This is a weak check. The share of stacks that collapsed was not published for each height, and the shaking \
         at the warehouses was not recorded. The stacks stood in rows, where a falling stack can knock down its \
         neighbors; this effect makes more stacks fall and is not modeled here."
            .into(),
        if all.request.in_space {
            "Each run is three-dimensional, under all components of its motion; the components of a record are scaled \
             by one factor."
        } else {
            "Each run is in one plane. A real stack is shaken across and along the barrels at the same time: its \
             chance of collapse lies between the larger of the two chances and their sum."
        }
        .into(),
    ]));
    blocks
}

/// Tabulates the shares of collapsed stacks and fallen barrels in simulations of high stacks, next to those observed
/// at Napa.
fn observations(all: &Heights) -> Table {
    let mut table = Table::new(
        format!(
            "Stacks of {}: simulations at the strength of shaking at Napa, and observations there.",
            span(LOWEST_OBSERVED, all.request.highest)
        ),
        &[("", ""), ("simulated", ""), ("observed at Napa", "")],
    );
    let range = |of: fn(&AtLevel) -> f64| {
        let found: Vec<f64> = VELOCITIES
            .into_iter()
            .filter(|velocity| (0.4..=0.75).contains(velocity))
            .flat_map(|velocity| {
                let high = all.heights.iter().filter(|height| height.levels >= LOWEST_OBSERVED);
                high.filter_map(move |height| height.at(velocity))
            })
            .map(|at| of(&at))
            .collect();
        let low = found.iter().copied().fold(1.0, f64::min);
        let high = found.iter().copied().fold(0.0, f64::max);
        let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
        format!(
            "{} on average, {} to {} by height{}",
            percent(mean),
            percent(low),
            percent(high),
            if all.request.in_space { "" } else { " and direction" }
        )
    };
    let collapse = range(|at| at.stripe.fraction());
    let fallen = range(|at| at.fallen);
    let row = |name: &str, ours: String, field: &str| {
        vec![Cell::text(name), Cell::text(ours), Cell::text(field)]
    };
    table.rows.push(row(
        "stacks that collapse, at 50 and 70 cm/s",
        collapse,
        "almost every stack in one room of 10,000 ft²; no share over a whole warehouse is known",
    ));
    table.rows.push(row(
        "barrels on the floor, at 50 and 70 cm/s",
        fallen,
        "half of 18,000 barrels in one warehouse",
    ));
    table
}

/// Tabulates the runs under the unscaled bundled record.
fn recorded(all: &Heights) -> Table {
    let names: Vec<String> =
        all.request.heights().map(|levels| format!("{levels} levels")).collect();
    let mut columns = vec![("component", ""), ("PGV", "cm/s"), ("PGA", "g"), ("shaken", "")];
    columns.extend(names.iter().map(|name| (name.as_str(), "")));
    let mut table = Table::new(
        "South Napa 2014 as recorded at Napa College, unscaled: outcome for each stack (friction of the catalog).",
        &columns,
    );
    let mut rows: Vec<(&str, Direction)> = Vec::new();
    for run in &all.recorded {
        if !rows.contains(&(run.motion.as_str(), run.direction)) {
            rows.push((&run.motion, run.direction));
        }
    }
    for (motion, direction) in rows {
        let of = |levels: Option<u32>| {
            all.recorded.iter().find(|run| {
                run.motion == motion
                    && run.direction == direction
                    && levels.is_none_or(|l| run.levels == l)
            })
        };
        let Some(any) = of(None) else { continue };
        let mut row = vec![
            Cell::text(motion),
            Cell::Number(100.0 * any.velocity, 3),
            Cell::Number(any.acceleration / barrelstack_motion::STANDARD_GRAVITY, 3),
            Cell::text(direction.words()),
        ];
        row.extend(all.request.heights().map(|levels| match of(Some(levels)) {
            Some(run) if run.collapsed => {
                Cell::text(format!("falls ({} of the barrels)", percent(run.fallen)))
            }
            Some(_) => Cell::text("stands"),
            None => Cell::Missing,
        }));
        table.rows.push(row);
    }
    table
}
