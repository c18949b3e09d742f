//! Data dictionary: the meaning of the columns of all tables in a folder.

use std::fmt::Write as _;
use std::path::Path;

use barrelstack_report::csv_field;

use crate::ensemble;

/// Column names with their meanings.
///
/// A listed name that begins with `_` is a suffix: it applies to all column names that end with it. Such column names
/// begin with the name of a body, of two bodies or of the ground.
const MEANINGS: [(&str, &str); 39] = [
    ("time", "time since the motion began"),
    (
        "plane",
        "plane of the run: transverse (across the barrels) or longitudinal (along the barrels)",
    ),
    ("first_body", "body that left its seat first"),
    ("ground_acceleration_x", "acceleration of the ground to the right"),
    ("ground_acceleration_z", "acceleration of the ground upward"),
    ("ground_velocity_x", "velocity of the ground to the right"),
    ("ground_velocity_z", "velocity of the ground upward"),
    ("ground_displacement_x", "displacement of the ground to the right"),
    ("ground_displacement_z", "displacement of the ground upward"),
    ("energy_kinetic", "kinetic energy of all bodies"),
    ("energy_potential", "potential energy of all bodies"),
    ("energy_elastic", "energy stored in the springs of all contacts"),
    ("energy_stick", "energy stored in the tangential springs of sticking contacts"),
    ("energy_damped", "energy dissipated so far by the dampers of all contacts"),
    ("energy_friction", "energy dissipated so far by friction"),
    ("energy_viscous", "energy dissipated so far by viscous drag"),
    ("energy_ground_work", "work done so far by the ground on the bodies"),
    ("energy_residual", "error of the energy balance"),
    ("body", "name of the body"),
    ("x", "position of the boundary point at rest, to the right of the center of mass"),
    ("z", "position of the boundary point at rest, above the center of mass"),
    (
        "coordinate",
        "position along the boundary: an angle on a round boundary, a length on a straight boundary",
    ),
    ("length_of_boundary", "length of boundary on which the stress at rest acts"),
    ("stress_at_rest", "normal stress at rest"),
    (
        "peak_stress_until_first_loss_of_seat",
        "largest normal stress until the first loss of a seat",
    ),
    ("peak_stress_of_whole_run", "largest normal stress over the whole run"),
    (
        "_displacement_x",
        "displacement to the right from the position at rest, relative to the ground",
    ),
    ("_displacement_z", "displacement upward from the position at rest, relative to the ground"),
    ("_rotation", "rotation, counterclockwise"),
    ("_vertical_force", "upward force on the upper body"),
    ("_horizontal_force", "force to the right on the upper body"),
    (
        "_x",
        "position of the center of mass to the right, in the inertial frame of the ground before the motion",
    ),
    (
        "_y",
        "position of the center of mass away from the viewer, in the inertial frame of the ground before the motion",
    ),
    (
        "_z",
        "position of the center of mass upward, in the inertial frame of the ground before the motion",
    ),
    ("_angle", "rotation, counterclockwise"),
    (
        "_qw",
        "real part of the quaternion that rotates the frame of the body to the inertial frame of the ground before the \
         motion",
    ),
    ("_qx", "first imaginary part of the quaternion of the rotation"),
    ("_qy", "second imaginary part of the quaternion of the rotation"),
    ("_qz", "third imaginary part of the quaternion of the rotation"),
];

/// Returns the name `columns.csv` and the contents of this file, which lists the file, name, unit and
/// meaning of every column of the tables in a folder.
///
/// `other` returns the meanings of columns that only some folders have.
pub fn dictionary(
    files: &[(String, Vec<u8>)],
    other: &dyn Fn(&str) -> Option<&'static str>,
) -> (String, Vec<u8>) {
    let mut text = "file,name,unit,meaning\n".to_owned();
    let tables =
        files.iter().filter(|(name, _)| Path::new(name).extension().is_some_and(|of| of == "csv"));
    for (file, bytes) in tables {
        let heading = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
        for column in String::from_utf8_lossy(heading).split(',') {
            let (name, unit) = column.split_once(" (").unwrap_or((column, ""));
            let unit = unit.trim_end_matches(')');
            let meaning = equal(name)
                .or_else(|| ensemble::meaning(name).or_else(|| other(name)))
                .or_else(|| ends_in(name))
                .unwrap_or_default();
            let row = [file, name, unit, meaning].map(csv_field);
            let _ = writeln!(text, "{}", row.join(","));
        }
    }
    ("columns.csv".to_owned(), text.into_bytes())
}

/// Returns the meaning of a column; `None` if its full name is not listed.
fn equal(name: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}

/// Returns the meaning of the suffix in which the name of a column ends; `None` if no listed suffix matches.
fn ends_in(name: &str) -> Option<&'static str> {
    let ends = |end: &str| end.starts_with('_') && name.ends_with(end);
    MEANINGS.iter().find(|(end, _)| ends(end)).map(|(_, meaning)| *meaning)
}
