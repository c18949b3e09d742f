//! Scenarios shipped with the program.

macro_rules! scenarios {
    ($($name:literal),* $(,)?) => {
        const ALL: &[(&str, &str)] = &[
            $(($name, include_str!(concat!("../../scenarios/", $name, ".toml")))),*
        ];
    };
}

scenarios![
    "candia-6-barrels",
    "candia-6-barrels-low-friction",
    "candia-8-barrels",
    "candia-8-barrels-half-scale",
    "candia-8-barrels-longitudinal",
    "demo-napa",
    "rocking-block",
    "sliding-block",
    "rolling-disc",
    "bouncing-disc",
    "rolling-ball",
    "sliding-block-in-space",
    "tumbling-block",
];

/// Returns the names of all built-in scenarios.
pub fn names() -> impl Iterator<Item = &'static str> {
    ALL.iter().map(|(name, _)| *name)
}

/// Returns the text of a built-in scenario.
pub fn get(name: &str) -> Option<&'static str> {
    ALL.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Returns the titles of all built-in scenarios.
pub(super) fn titles() -> impl Iterator<Item = &'static str> {
    let title = |text: &'static str| text.lines().find_map(|line| line.strip_prefix("title = \""));
    ALL.iter().filter_map(move |(_, text)| title(text)?.strip_suffix('"'))
}
