//! Reference of the scenario language in Markdown, generated from the definitions of the fields.

use std::fmt::Write as _;

use barrelstack_input::reference as of;

use super::catalog;
use super::pair::StackPair;
use super::quantity::plain;
use super::root::ROOT;

/// Returns the reference of all tables and fields of a scenario file, followed by the units and the catalog.
///
/// Each field is listed with its kind, range, default and meaning.
pub fn markdown() -> String {
    let mut text = String::from("# Fields of a scenario file\n\n");
    text.push_str(&of::of_tables(&ROOT, &[], ""));
    text.push_str("## Units\n\n");
    text.push_str(&of::units());
    catalog_tables(&mut text);
    text
}

fn catalog_tables(text: &mut String) {
    text.push_str("## Barrels of the catalog\n\n");
    text.push_str(
        "| name | length (m) | bilge (m) | head (m) | stave (m) | empty (kg) | volume (L) | source |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for b in catalog::BARRELS {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} | {} |",
            b.name,
            plain(b.length),
            plain(b.bilge_diameter),
            plain(b.head_diameter),
            plain(b.stave_thickness),
            plain(b.empty_mass),
            plain(1000.0 * b.capacity),
            b.source
        );
    }
    text.push_str("\n## Racks of the catalog\n\n");
    text.push_str(
        "| name | mass (kg) | barrels | pitch (m) | width (m) | rails ± (m) | clearance (m) | source |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for catalog::CatalogRack { rack: r, source, .. } in catalog::RACKS {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} by {} | {} | {} | {} | {} | {} |",
            r.base,
            r.mass,
            r.barrels,
            r.barrels_deep,
            r.pitch,
            r.width,
            r.rail_half_spacing,
            r.clearance,
            source
        );
    }
    text.push_str(
        "\n## Friction of the catalog\n\n| pair | coefficient | source |\n|---|---|---|\n",
    );
    for p in StackPair::ALL {
        let _ = writeln!(text, "| `{}` | {} | {} |", p.name(), p.coefficient(), p.source());
    }
    text.push_str("\n## Records shipped with the program\n\n| name | record |\n|---|---|\n");
    for (name, help) in catalog::RECORDS {
        let _ = writeln!(text, "| `{name}` | {help} |");
    }
}
