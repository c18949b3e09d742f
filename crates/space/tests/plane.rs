//! A stack of right cylinders that is shaken across their axes moves in three dimensions as in the plane.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::ops::ControlFlow;

use barrelstack::assemble::PartKind;
use barrelstack_space::{Ground, run};

use crate::common::soft_demo;

/// Returns the displacement (m) of the top barrels in the plane; its largest difference from the displacement in three
/// dimensions, over the run and over the first three seconds; and the displacement out of the plane.
fn apart(view: [&str; 2]) -> [f64; 4] {
    let scenario = |view: &str| {
        let changes = [
            &format!("stack.view={view}"),
            "stack.levels=3",
            // The barrels are right cylinders to within half a millimeter.
            "stack.barrel={ head_diameter = \"0.645 m\", bilge_diameter = \"0.646 m\" }",
            "run.duration='6 s'",
            "record.frame_rate='50 Hz'",
        ];
        soft_demo(&changes.map(str::to_owned))
    };
    let plane = scenario(view[0]);
    let ground = plane.ground().unwrap();
    let flat = plane.run_on(ground.clone(), &mut |_| ControlFlow::Continue(())).unwrap();
    let mut go_on = |_| ControlFlow::Continue(());
    let solid = run::run_on(&scenario(view[1]), Ground::from(ground), &mut go_on).unwrap();
    let top = |body: &usize| flat.assembly.parts[*body].level == Some(3);
    let mut worst = [0.0_f64; 4];
    for body in flat.assembly.of_kind(PartKind::Barrel).filter(top) {
        let name = &flat.assembly.parts[body].name;
        let other = solid.stack.parts.iter().position(|part| part.name == *name).unwrap();
        let (a, b) = (&flat.recording.frames, &solid.frames);
        assert_eq!(a.poses.len(), b.poses.len());
        let (first_a, first_b) = (a.poses[0][body], b.poses[0][other]);
        for (at, (a, b)) in a.poses.iter().zip(&b.poses).enumerate() {
            let (a, b) = (a[body], b[other]);
            let way = [a[0] - first_a[0], a[1] - first_a[1]];
            let seen = [b[0] - first_b[0], b[2] - first_b[2]];
            let off = (way[0] - seen[0]).hypot(way[1] - seen[1]);
            worst[0] = worst[0].max(way[0].abs());
            worst[1] = worst[1].max(off);
            if at <= 150 {
                worst[2] = worst[2].max(off);
            }
            worst[3] = worst[3].max((b[1] - first_b[1]).abs());
            if at % 25 == 0 {
                println!(
                    "{name} {:.2} s: {:.4} m, off {off:.2e} m, aside {:.1e} m",
                    at as f64 / 50.0,
                    way[0],
                    b[1] - first_b[1]
                );
            }
        }
    }
    println!("{:?} {:?}", flat.outcome, solid.outcome);
    assert_eq!(flat.outcome, solid.outcome);
    worst
}

#[test]
fn right_cylinders_in_space_go_where_those_of_the_plane_go() {
    let [way, off, early, aside] = apart(["transverse", "spatial"]);
    println!(
        "goes {way:.4} m, differs by {off:.2e} m, early by {early:.2e} m, aside {aside:.2e} m"
    );
    assert!(way > 0.2, "{way}"); // measured 0.25
    assert!(aside < 1e-12, "{aside:e}"); // measured 7e-15
    // Measured 2.2e-4 of 0.25 m, 1.8e-7 m in the first three seconds. The same stack extruded, with the same masses
    // and from the same start, agrees to 5e-11 m (`extruded` of the dynamics); here a rack of tubes has another mass
    // distribution, its beams have rounder ends, and settling takes another path to the friction at rest.
    assert!(off < 1e-3, "{off:e} of {way:e}");
    assert!(early < 1e-6, "{early:e}"); // measured 1.8e-7
}
