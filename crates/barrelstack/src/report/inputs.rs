//! Table of the inputs of a run: values with units, sources and meanings.

use barrelstack_report::{Block, Cell, Table, significant};

use crate::scenario::{Scenario, Setting, Source, catalog};

/// Formats a given input as it was written, followed by its value in SI units if the two differ.
fn given(scenario: &Scenario, one: &Setting) -> String {
    let value = shown(&one.path, &one.value);
    // Other strings, such as paths and names, have no value in SI units.
    let is_quantity =
        |text: &str| text.split_once(' ').is_some_and(|(number, _)| number.parse::<f64>().is_ok());
    match scenario.as_written(&one.path) {
        Some(text)
            if text != one.value
                && text != value
                && is_quantity(text)
                && is_quantity(&one.value) =>
        {
            format!("{text} = {value}")
        }
        _ => value,
    }
}

/// Tabulates settings, with one row per input.
pub(crate) fn settings_table(caption: &str, settings: &[Setting]) -> Table {
    Table::of(
        caption,
        settings,
        &[
            ("input", "", &|one| Cell::verbatim(&one.path)),
            ("value", "", &|one| Cell::verbatim(shown(&one.path, &one.value))),
            ("source", "", &|one| Cell::text(one.source.words())),
            ("meaning", "", &|one| Cell::text(one.help)),
        ],
    )
}

/// Formats the value of an input for a page; a file is shown by its name, without its path.
pub(crate) fn shown(path: &str, value: &str) -> String {
    let file = ["motion.record", "motion.vertical_record"].contains(&path);
    let name = value.rsplit(['/', '\\']).next().filter(|_| file);
    name.map_or_else(|| readable(value), str::to_owned)
}

/// Formats a value for display; a number, with or without a unit, is rounded to six significant
/// digits.
pub(crate) fn readable(value: &str) -> String {
    let (first, rest) = value.split_once(' ').unwrap_or((value, ""));
    match first.parse::<f64>() {
        Ok(number) if first.len() > DIGITS && number != 0.0 => {
            // Trailing zeros carry no information.
            let shown = significant(number, DIGITS);
            let end = shown.find('×').unwrap_or(shown.len());
            let (digits, power) = shown.split_at(end);
            let short = if digits.contains('.') {
                digits.trim_end_matches('0').trim_end_matches('.')
            } else {
                digits
            };
            format!("{short}{power} {rest}").trim_end().to_owned()
        }
        _ => value.to_owned(),
    }
}

/// Significant digits of a printed input; the scenario file beside the report has all digits.
const DIGITS: usize = 6;

/// Tabulates the inputs that differ from their defaults, with the sources of the dimensions; on screen, also tabulates
/// all inputs.
pub fn inputs(stated: &Scenario) -> Vec<Block> {
    let absent = stated.stack().map(|stack| stack.devices.absent()).unwrap_or_default();
    let mut settings = stated.settings();
    settings.retain(|setting| {
        let inside = setting.path.strip_prefix("stack.").and_then(|path| path.split('.').next());
        setting.source == Source::Given || inside.is_none_or(|table| !absent.contains(&table))
    });
    let chosen = Table::of(
        "Inputs that differ from their defaults, as given and in SI units.",
        settings.iter().filter(|one| one.source == Source::Given),
        &[
            ("input", "", &|one| Cell::verbatim(&one.path)),
            ("value", "", &|one| Cell::verbatim(given(stated, one))),
            ("meaning", "", &|one| Cell::text(one.help)),
        ],
    );
    let all = settings_table("Every input.", &settings);
    let left_out = (!absent.is_empty()).then(|| {
        let names = absent.join(", ").replace('_', " ");
        Block::Paragraph(format!(
            "Inputs of devices that the stack does not have are left out: {names}."
        ))
    });
    let mut blocks = vec![Block::Table(chosen)];
    blocks.extend(dimensions(stated));
    let title = format!("All {} inputs, including defaults", all.rows.len());
    let list = [Block::Table(all)].into_iter().chain(left_out).collect();
    blocks.push(Block::details_on_screen(title, list));
    blocks
}

/// Lists what the model of a stack leaves out, in a plane or in three dimensions.
pub fn not_modeled(in_space: bool) -> Block {
    let own = if in_space {
        vec!["Sloshing of the wine."]
    } else {
        vec![
            "The third dimension: the stack is judged in one vertical plane at a time, across the barrels or along them.",
            "Sloshing of the wine beyond its first mode, and splashing.",
        ]
    };
    let always = [
        "Deformation of wood and steel: bodies are rigid, staves do not split, tubes do not bend and welds do not break; only \
         ties and straps yield and tear.",
        "Neighboring stacks and walls, with which a stack may collide.",
        "Soil and building: the ground motion acts at the floor.",
        "Wear, creep, temperature and air resistance.",
        "Breakage of barrels when they land.",
    ];
    Block::List(own.into_iter().chain(always).map(str::to_owned).collect())
}

/// Returns the sources of the dimensions that the catalog provides.
fn dimensions(scenario: &Scenario) -> Option<Block> {
    let stack = scenario.stack()?;
    let barrel = catalog::barrel(stack.barrel.base);
    let rack = catalog::rack(stack.rack.base);
    let mut sources = Vec::new();
    sources.extend(barrel.map(|known| format!("Barrel {}: {}.", known.name, known.source)));
    sources.extend(rack.map(|known| format!("Rack {}: {}.", known.rack.base, known.source)));
    (!sources.is_empty()).then_some(Block::List(sources))
}

#[cfg(test)]
mod tests {
    use super::readable;
    use crate::scenario::{Scenario, Source};

    #[test]
    fn what_was_written_is_given_and_nothing_else() {
        let text = "schema = 1\n[stack]\nlevels = 2\ncolumns = 4\n[motion]\nbundled = \"napa-college-2014\"\n";
        let change = "interface.barrel-rack.stiffness=9 MN/m".to_owned();
        let scenario = Scenario::parse("two.toml", text, &[change]).unwrap();
        let settings = scenario.settings();
        let given = settings.iter().filter(|one| one.source == Source::Given);
        let paths: Vec<&str> = given.map(|one| one.path.as_str()).collect();
        let written =
            ["stack.levels", "stack.columns", "interface.barrel-rack.stiffness", "motion.bundled"];
        assert_eq!(paths, written);
    }

    #[test]
    fn long_numbers_are_rounded_and_everything_else_is_left_alone() {
        assert_eq!(readable("0.6428363673489367 m"), "0.642836 m");
        assert_eq!(readable("980000 N/m"), "980000 N/m");
        assert_eq!(readable("12345678 N"), "1.23457×10⁷ N");
        assert_eq!(readable("1200000000 N/m^1.5"), "1.2×10⁹ N/m^1.5");
        assert_eq!(readable("9.806650000001 m/s^2"), "9.80665 m/s^2");
        assert_eq!(readable("transverse"), "transverse");
        assert_eq!(readable("napa-college-2014 E"), "napa-college-2014 E");
        assert_eq!(readable("0.0000000"), "0.0000000");
    }
}
