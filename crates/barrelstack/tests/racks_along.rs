//! Racks along their barrels: on posts, and with rails that raise one end of every barrel.
#![allow(clippy::print_stdout, reason = "measured values are shown with --nocapture")]

use std::collections::BTreeSet;

use barrelstack::assemble::{PartKind, assemble};
use barrelstack::device::DEVICES;
use barrelstack::{Run, Scenario};

const ALONG: [&str; 2] = ["stack.view=longitudinal", "stack.columns=1"];

fn demo(changes: &[&str]) -> Scenario {
    let changes: Vec<String> =
        ALONG.iter().chain(changes).map(|change| (*change).to_owned()).collect();
    Scenario::builtin("demo-napa", &changes).unwrap_or_else(|error| panic!("{changes:?}: {error}"))
}

fn briefly(changes: &[&str]) -> Result<Run, String> {
    let brief = ["run.duration=\"0.05 s\"", "run.until=duration"];
    demo(&[&brief[..], changes].concat()).run().map_err(|error| error.to_string())
}

#[test]
fn stacks_along_their_barrels_stand_as_they_are_drawn() {
    let racks = ["rack-on-rack", "two-barrel-inclined", "two-barrel"];
    let leaning = racks.into_iter().map(|rack| vec![format!("stack.rack={rack}")]).chain([vec![
        "stack.rack=rack-on-rack".to_owned(),
        "stack.rack.incline=\"3.5 deg\"".into(),
    ]]);
    for changes in leaning {
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        let run = briefly(&changes).unwrap();
        let mut most = (0.0_f64, 0.0_f64);
        for (at, part) in run.assembly.parts.iter().enumerate() {
            if matches!(part.kind, PartKind::Barrel | PartKind::Rack) {
                let drawn = run.assembly.model.bodies()[at].pose;
                let moved = run.recording.frames.poses[0][at][0] - drawn.position.x;
                let turned = run.recording.frames.poses[0][at][2] - drawn.orientation;
                most = (most.0.max(moved.abs()), most.1.max(turned.abs()));
            }
        }
        let balance = run.energy.unwrap().residual_ratio();
        println!(
            "{changes:?}: moved {:.2} mm, turned {:.2} mrad, balance {balance:.1e}",
            1e3 * most.0,
            1e3 * most.1
        );
        // Measured: 0.57 mm and 0.19 mrad inclined, less than 0.01 level.
        assert!(most.0 < 1e-3 && most.1 < 5e-4, "{changes:?}: {most:?}");
        assert!(balance < 1e-10); // measured 2e-13
    }
}

#[test]
fn a_mirrored_stack_leans_the_other_way() {
    let poses = |changes: &[&str]| {
        let assembly = assemble(&demo(changes)).unwrap();
        let bodies = assembly.model.bodies().iter();
        bodies.map(|b| (b.pose.position, b.pose.orientation)).collect::<Vec<_>>()
    };
    let right = poses(&["stack.rack=two-barrel-inclined", "stack.mirror=true"]);
    let left = poses(&["stack.rack=two-barrel", "stack.rack.incline=\"-3.5 deg\""]);
    assert_eq!(right.len(), left.len());
    let mut worst = (0.0_f64, 0.0_f64);
    for ((at, turned), (there, leaning)) in right.into_iter().zip(left) {
        let apart = (at.x - there.x).abs().max((at.z - there.z).abs());
        worst = (worst.0.max(apart), worst.1.max((turned - leaning).abs()));
    }
    println!("apart {:e} m, turned {:e}", worst.0, worst.1);
    assert!(worst.0 < 1e-12 && worst.1 < 1e-12, "{worst:?}"); // measured 0
}

#[test]
fn posts_meet_no_barrel_along_them_and_every_rack_below() {
    let assembly = assemble(&demo(&["stack.rack=rack-on-rack"])).unwrap();
    let parts = &assembly.parts;
    let beside = |body: usize, surface: usize| parts[body].out_of_plane.get(surface) == Some(&true);
    let mut met = 0;
    for pair in assembly.model.pairs() {
        let kinds = [parts[pair.contactor].kind, parts[pair.target].kind];
        if kinds.contains(&PartKind::Barrel) {
            assert!(!beside(pair.target, pair.surface), "{pair:?}");
        } else if beside(pair.target, pair.surface) && kinds == [PartKind::Rack; 2] {
            met += 1;
        }
    }
    assert!(met > 0);
}

#[test]
fn a_rail_that_would_carry_a_barrel_on_its_outer_corner_is_refused_with_the_most_that_goes() {
    let refused = assemble(&demo(&["stack.rack.incline=\"11.4 deg\""])).unwrap_err().to_string();
    println!("{refused}");
    assert!(refused.contains("reduce stack.rack.incline to at most 11.0"), "{refused}");
}

#[test]
fn every_device_goes_on_racks_on_posts_along_the_barrels_or_says_why_not() {
    let (mut ran, mut refused) = (BTreeSet::new(), BTreeSet::new());
    let mut worst = 0.0_f64;
    for words in DEVICES {
        for candidate in words.candidates {
            let all = [&["stack.rack=rack-on-rack"], candidate.overrides].concat();
            match briefly(&all) {
                Ok(run) => {
                    worst = worst.max(run.energy.unwrap().residual_ratio());
                    ran.insert(words.many);
                }
                Err(why) => {
                    assert!(why.contains("stands on posts"), "{all:?}: {why}");
                    refused.insert(words.many);
                }
            }
        }
    }
    println!("run: {ran:?}; refused: {refused:?}; balance {worst:e}");
    // On posts a rack has no room to walk.
    assert_eq!(refused, BTreeSet::from(["walking stops"]));
    assert_eq!(ran.len(), DEVICES.len() - 1);
    assert!(worst < 1e-10); // measured 3e-13
}
