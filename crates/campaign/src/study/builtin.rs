//! Studies that are built into the program.

const ALL: &[(&str, &str)] = &[
    ("napa-four-levels", include_str!("../../studies/napa-four-levels.toml")),
    ("demo-devices", include_str!("../../studies/demo-devices.toml")),
    ("demo-devices-across", include_str!("../../studies/demo-devices-across.toml")),
    ("demo-isolators", include_str!("../../studies/demo-isolators.toml")),
    ("demo-racks", include_str!("../../studies/demo-racks.toml")),
    ("demo-slosh", include_str!("../../studies/demo-slosh.toml")),
    ("demo-space", include_str!("../../studies/demo-space.toml")),
    ("tuned-mass", include_str!("../../studies/tuned-mass.toml")),
];

/// Returns the names of all built-in studies.
pub fn names() -> impl Iterator<Item = &'static str> {
    ALL.iter().map(|(name, _)| *name)
}

/// Returns the text of the built-in study with the given name; `None` if there is no such study.
pub fn get(name: &str) -> Option<&'static str> {
    ALL.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
