//! Study files of a study of safe heights: stacks, motions and random factors.

use std::fmt::Write as _;

use barrelstack_input::names::advice;

use super::{HeightsError, Request};
use crate::direction::{Direction, turned};
use crate::protect::NAPA;
use crate::scenario::{Scenario, View, catalog};
use crate::study::StudyError;
use crate::unknown::factors;

/// Number of levels of the lowest stacks in the study.
pub const LOWEST: u32 = 2;
/// Largest number of levels that may be requested.
pub const HIGHEST: u32 = 6;

/// Levels of peak ground velocity (m/s) to which every motion is scaled.
pub const VELOCITIES: [f64; 6] = [0.12, 0.24, 0.36, 0.50, 0.70, 1.00];

/// Returns the name of a study, which is also the name of its folder.
pub(super) fn name(direction: Direction, recorded: bool) -> String {
    format!("{}{}", direction.name(), if recorded { "-as-recorded" } else { "" })
}

/// Returns the text of a study file. The study runs every height under every motion at every level or, if `recorded`
/// is `true`, under the unscaled bundled record.
pub(super) fn text(
    request: &Request,
    direction: Direction,
    recorded: bool,
) -> Result<String, HeightsError> {
    let (columns, rack) = columns_and_rack(request, direction)?;
    let levels: Vec<String> = request.heights().map(|levels| levels.to_string()).collect();
    let mut text = format!(
        "schema = 1\n\
         title = \"How high: {} racks shaken {}\"\n\
         seed = {}\n\n\
         [base]\n\
         schema = 1\n\
         [base.stack]\n\
         view = \"{}\"\n\
         levels = 4\n\
         columns = {columns}\n\
         barrel = \"{}\"\n\
         rack = {rack}\n\n\
         [[factor]]\n\
         name = \"levels\"\n\
         field = \"stack.levels\"\n\
         values = [{}]\n\n",
        request.rack,
        direction.words(),
        request.seed,
        direction.name(),
        request.barrel,
        levels.join(", ")
    );
    if !recorded {
        let stack = at_rest(request, direction, LOWEST)?;
        text.push_str(&factors(&stack));
        text.push_str(&turned(&stack));
    }
    text.push_str(NAPA);
    if recorded {
        text.push_str("[design]\nkind = \"full-factorial\"\n");
        return Ok(text);
    }
    for record in &request.records {
        let _ = write!(text, "[[motion]]\nrecords = [{}]\n\n", quoted(record));
    }
    text.push_str(&synthetic(request.synthetic, ""));
    let velocities: Vec<String> =
        VELOCITIES.iter().map(|v| format!("\"{} cm/s\"", (100.0 * v).round())).collect();
    let _ = write!(
        text,
        "[intensity]\nmeasure = \"pgv\"\nlevels = [{}]\n\n[design]\nkind = \"stripes\"\nchunk = 32\n",
        velocities.join(", ")
    );
    Ok(text)
}

/// Returns the number of columns of a stack for a direction of shaking, and its rack as TOML.
fn columns_and_rack(
    request: &Request,
    direction: Direction,
) -> Result<(u32, String), HeightsError> {
    let catalog::CatalogRack { rack, .. } = catalog::rack(&request.rack).ok_or_else(|| {
        let known: Vec<&str> = catalog::RACKS.iter().map(|known| known.rack.base).collect();
        HeightsError::Rack(request.rack.clone(), advice(&request.rack, &known))
    })?;
    if catalog::barrel(&request.barrel).is_none() {
        let known: Vec<&str> = catalog::BARRELS.iter().map(|known| known.name).collect();
        let next = advice(&request.barrel, &known);
        return Err(HeightsError::Barrel(request.barrel.clone(), next));
    }
    // In the plane along the barrels, one rack is one column. A rail touches the bulged staves at its inner edge, which
    // requires a smaller node spacing but no other change of the rack.
    Ok(match direction {
        Direction::Plane(View::Transverse) | Direction::Space => {
            (rack.barrels, format!("\"{}\"", rack.base))
        }
        Direction::Plane(View::Longitudinal) => {
            (1, format!("{{ base = \"{}\", node_spacing = \"5 mm\" }}", rack.base))
        }
    })
}

/// Returns the scenario of a stack with the given number of levels on ground at rest.
pub(super) fn at_rest(
    request: &Request,
    direction: Direction,
    levels: u32,
) -> Result<Scenario, HeightsError> {
    let stack = stack(request, direction, levels)?;
    let text = format!("schema = 1\nmotion.none = true\n{stack}");
    Ok(Scenario::from_str(&text).map_err(StudyError::from)?)
}

/// Returns the `[stack]` table of a scenario for a number of levels.
pub(super) fn stack(
    request: &Request,
    direction: Direction,
    levels: u32,
) -> Result<String, HeightsError> {
    let (columns, rack) = columns_and_rack(request, direction)?;
    Ok(format!(
        "[stack]\nlevels = {levels}\ncolumns = {columns}\nview = \"{}\"\nbarrel = \"{}\"\nrack = {rack}\n",
        direction.name(),
        request.barrel
    ))
}

/// Returns a path as a TOML string. The path is made absolute, so that it does not depend on the folder of
/// the study.
pub(crate) fn quoted(path: &std::path::Path) -> String {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let text = whole.display().to_string().replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{text}\"")
}

/// Divides a number of synthetic motions among their kinds: a moderate earthquake nearby, a large earthquake farther
/// away, and motions with a velocity pulse, as occurs near faults. The first kind has at least half of the motions.
pub(super) fn kinds(count: u32) -> [u32; 3] {
    let quarter = count / 4;
    [count - 2 * quarter, quarter, quarter]
}

/// Returns the `[[motion]]` tables of synthetic motions of all [`kinds`]; `suffix` is appended to their names.
pub(crate) fn synthetic(count: u32, suffix: &str) -> String {
    let [near, large, pulses] = kinds(count);
    let mut text = String::new();
    let mut set = |count: u32, name: &str, body: &str| {
        if count > 0 {
            let _ = write!(
                text,
                "[[motion]]\nname = \"{name}{suffix}\"\nsynthetic = {{ count = {count}, {body} }}\n\n"
            );
        }
    };
    set(near, "M 6 at 8 km", "kind = \"boore\", magnitude = 6.0, distance = \"8 km\"");
    set(large, "M 7 at 20 km", "kind = \"boore\", magnitude = 7.0, distance = \"20 km\"");
    let pulse = |period: &str| {
        format!(
            "kind = \"near-fault\", magnitude = 6.0, distance = \"8 km\", pulse_velocity = \"40 cm/s\", \
             pulse_period = \"{period}\""
        )
    };
    set(pulses.div_ceil(2), "pulse of 1 s", &pulse("1 s"));
    set(pulses / 2, "pulse of 2 s", &pulse("2 s"));
    text
}
