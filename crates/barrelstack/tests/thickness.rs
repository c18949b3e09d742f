//! No body is so thin, or falls so fast, that another could pass through it within a step.
#![expect(clippy::print_stdout, reason = "prints the smallest distance")]

use barrelstack::Scenario;
use barrelstack::assemble::{Outline, PartKind, assemble};
use barrelstack::scenario::catalog;

/// Returns the smallest width (m) of a convex outline, which is always measured perpendicular to one of its sides.
fn least_width(outline: &Outline) -> f64 {
    let points = &outline.points;
    let across = |i: usize| {
        let (a, b) = (points[i], points[(i + 1) % points.len()]);
        let side = b - a;
        let far = |p: &barrelstack_dynamics::Vec2| {
            let from = *p - a;
            (side.x * from.z - side.z * from.x).abs() / side.length()
        };
        (side.length() > 1e-9).then(|| points.iter().map(far).fold(0.0, f64::max))
    };
    (0..points.len()).filter_map(across).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_falls_from_six_levels_passes_through_nothing() {
    let mut most = 0.0_f64;
    for rack in catalog::RACKS {
        for view in ["transverse", "longitudinal"] {
            let name = rack.rack.base;
            let text = format!(
                "schema = 1\n[stack]\nview = \"{view}\"\nlevels = 6\ncolumns = 2\nrack = \"{name}\"\n\
                 [interface.rack-ground.friction]\ncoefficient = 0.5\n\
                 [motion]\nnone = true\n[run]\nduration = \"1 s\"\n"
            );
            let assembly = assemble(&Scenario::parse(name, &text, &[]).unwrap()).unwrap();
            let solids = assembly.parts.iter().filter(|part| part.kind != PartKind::Ground);
            let thinnest = solids.flat_map(|part| &part.outlines).map(least_width);
            let thinnest = thinnest.fold(f64::INFINITY, f64::min);
            // Closing speed of a body that falls from the full height and a body that rebounds from the floor at 0.3
            // times the speed of its impact.
            let speed = 1.3 * (2.0 * 9.80665 * assembly.height).sqrt();
            let way = speed * assembly.step / assembly.model.substepping().substeps;
            println!(
                "{name}, {view}: {:.1} mm in a step, thinnest solid {:.1} mm",
                1e3 * way,
                1e3 * thinnest
            );
            most = most.max(way / (0.5 * thinnest));
        }
    }
    // A body that has penetrated another by less than half the thickness of the latter is pushed back to the side from
    // which it came.
    assert!(most < 1.0, "{most}"); // measured 0.989: the lips of a cup, 8 mm thick; elsewhere 0.26
}
