//! The file that states what the columns of all tables of a folder mean.

use std::fmt::Write as _;
use std::path::Path;

use barrelstack_report::csv_field;

use crate::ensemble;

/// Names of columns with their meanings; one that begins with `_` stands for all names that end in it, after the name
/// of a body, of two bodies or of the ground.
const MEANINGS: [(&str, &str); 39] = [
    ("time", "time since the motion began"),
    ("plane", "plane of the run: transverse, across the barrels, or longitudinal, along them"),
    ("first_body", "body that left its seat first"),
    ("ground_acceleration_x", "acceleration of the ground to the right"),
    ("ground_acceleration_z", "acceleration of the ground upward"),
    ("ground_velocity_x", "velocity of the ground to the right"),
    ("ground_velocity_z", "velocity of the ground upward"),
    ("ground_displacement_x", "displacement of the ground to the right"),
    ("ground_displacement_z", "displacement of the ground upward"),
    ("energy_kinetic", "kinetic energy of all bodies"),
    ("energy_potential", "potential energy of all bodies"),
    ("energy_elastic", "energy in the springs of all contacts"),
    ("energy_stick", "energy in the springs of friction that holds"),
    ("energy_damped", "energy taken by the dampers of all contacts so far"),
    ("energy_friction", "energy taken by friction so far"),
    ("energy_viscous", "energy taken by viscous drag so far"),
    ("energy_ground_work", "work of the ground on the bodies so far"),
    ("energy_residual", "error of the energy balance"),
    ("body", "name of the body"),
    ("x", "place of the point on the boundary, from the center of mass to the right at rest"),
    ("z", "place of the point on the boundary, from the center of mass upward at rest"),
    ("coordinate", "place along the boundary: angle on a round one, length on a straight one"),
    ("length_of_boundary", "length on which the stress acts at rest"),
    ("stress_at_rest", "normal stress at rest"),
    (
        "peak_stress_until_first_loss_of_seat",
        "largest normal stress until the first loss of a seat",
    ),
    ("peak_stress_of_whole_run", "largest normal stress over the whole run"),
    (
        "_displacement_x",
        "displacement to the right, relative to the ground and to the place at rest",
    ),
    ("_displacement_z", "displacement upward, relative to the ground and to the place at rest"),
    ("_rotation", "rotation, counterclockwise"),
    ("_vertical_force", "upward force on the upper body"),
    ("_horizontal_force", "force to the right on the upper body"),
    ("_x", "place of the center of mass to the right, in the frame of the ground before it moved"),
    (
        "_y",
        "place of the center of mass away from the viewer, in the frame of the ground before it moved",
    ),
    ("_z", "place of the center of mass upward, in the frame of the ground before it moved"),
    ("_angle", "rotation, counterclockwise"),
    (
        "_qw",
        "real part of the quaternion from the frame of the body to that of the ground before it moved",
    ),
    ("_qx", "first imaginary part of that quaternion"),
    ("_qy", "second imaginary part of that quaternion"),
    ("_qz", "third imaginary part of that quaternion"),
];

/// Returns the file `columns.csv` of a folder: one row for each column of its tables, with file, name, unit and meaning.
///
/// `other` knows columns of cases that only some folders have.
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

/// Returns the meaning of a name that is listed whole.
fn equal(name: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}

/// Returns the meaning of a name that begins with a body.
fn ends_in(name: &str) -> Option<&'static str> {
    let ends = |end: &str| end.starts_with('_') && name.ends_with(end);
    MEANINGS.iter().find(|(end, _)| ends(end)).map(|(_, meaning)| *meaning)
}
