//! Unmeasured parameters of a stack (friction, stiffness, damping) as factors of a study.
//!
//! The medians of these factors are the constants of the contact laws in the scenario, and their scatter follows from
//! `[unknowns]`. Variants of a run, studies of stack heights, rankings of protections and scores all use the same
//! factors for a stack.

use std::fmt::Write as _;

use crate::scenario::{Scenario, Scene, Setting};

/// Interfaces of seats. Each is paired with the interface of the same materials that applies to fallen bodies, if there
/// is one.
const SEATS: [(&str, Option<&str>); 3] = [
    ("rack-ground", Some("fallen-rack-ground")),
    ("barrel-rack", Some("fallen-barrel-rack")),
    ("rack-rack", Some("fallen-rack-rack")),
];

/// Formats a value for TOML: a bare number, or a quantity in quotes.
fn toml(value: &str) -> String {
    let bare = value.starts_with('"') || value.parse::<f64>().is_ok();
    if bare { value.to_owned() } else { format!("\"{value}\"") }
}

/// Returns TOML text with the `[[factor]]` tables that vary the friction, stiffness and damping of the seats of a
/// scenario around their stated values. If the friction coefficients are correlated, a `[[correlation]]` table follows.
///
/// The string is empty for a scenario without a stack, and for a scenario in which no constants are drawn.
pub(crate) fn factors(scenario: &Scenario) -> String {
    let mut text = String::new();
    let Scene::Stack { stack, unknowns: spread, .. } = &scenario.scene else { return text };
    if !spread.drawn {
        return text;
    }
    let settings = scenario.settings();
    let of = |path: &str| settings.iter().find(|setting: &&Setting| setting.path == path);
    let mut friction_factors = Vec::new();
    for (pair, fallen) in SEATS {
        // Racks stand on each other only if they have posts.
        if pair == "rack-rack" && stack.rack.posts.is_none() {
            continue;
        }
        let path = |field: &str| format!("interface.{pair}.{field}");
        let mut factor = |name: &str, field: &str, also: &[String], dispersion: f64, cut: &str| {
            let Some(median) = of(&path(field)).filter(|_| dispersion > 0.0) else { return false };
            let also: Vec<String> = also.iter().map(|path| format!("\"{path}\"")).collect();
            let also = also.join(", ");
            let also = if also.is_empty() { also } else { format!("also = [{also}]\n") };
            // Writing to a String cannot fail.
            let _ = write!(
                text,
                "[[factor]]\nname = \"{name} {pair}\"\nfield = \"{}\"\n{also}\
                 distribution = {{ kind = \"lognormal\", median = {}, dispersion = {dispersion}{cut} }}\n\n",
                path(field),
                toml(&median.value)
            );
            true
        };
        let friction = "friction.coefficient";
        // Static friction has the same value, so that it is not below kinetic friction. The friction of fallen bodies
        // also has this value, since their materials are the same.
        let others = [
            Some(path("friction.static_coefficient")),
            fallen.map(|fallen| format!("interface.{fallen}.{friction}")),
            fallen.map(|fallen| format!("interface.{fallen}.friction.static_coefficient")),
        ];
        let stated = of(&path(friction)).map(|setting| setting.value.as_str());
        let mut also = Vec::new();
        for other in others.into_iter().flatten() {
            let is_static = other == path("friction.static_coefficient");
            if of(&other).is_some_and(|found| is_static || Some(found.value.as_str()) == stated) {
                also.push(other);
            }
        }
        let dispersion = match pair {
            "rack-ground" => spread.friction_ground,
            "barrel-rack" => spread.friction_of_barrels(),
            _ => spread.friction,
        };
        if factor("friction", friction, &also, dispersion, "") {
            friction_factors.push(format!("\"friction {pair}\""));
        }
        factor("stiffness", "stiffness", &[], spread.stiffness, "");
        factor("damping", "damping", &[], spread.damping, "");
        // The logarithm of a restitution is proportional to the damping ratio as long as the ratio is small.
        let restitution = of(&path("restitution")).and_then(|one| one.value.parse::<f64>().ok());
        if let Some(restitution) = restitution {
            let dispersion = -spread.damping * libm::log(restitution);
            factor("restitution", "restitution", &[], dispersion, ", greatest = 1");
        }
    }
    if spread.friction_correlation > 0.0 && friction_factors.len() > 1 {
        let _ = write!(
            text,
            "[[correlation]]\nfactors = [{}]\ncoefficient = {}\n\n",
            friction_factors.join(", "),
            spread.friction_correlation
        );
    }
    text
}
