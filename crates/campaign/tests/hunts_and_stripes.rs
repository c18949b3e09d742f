//! Incremental dynamic analysis and multiple stripes give the same fragility: both designs are run on the six barrels of
//! the paper, under the same motions.

#![allow(clippy::print_stdout, reason = "the measured values are shown")]

use std::ops::ControlFlow;

use barrelstack_campaign::decision::{Decision, Request, decide};
use barrelstack_campaign::study::{RunOptions, Study};
use barrelstack_fragility::{Interval, Lognormal};

/// The six barrels under motions of an earthquake of magnitude 6.5 at 10 km.
const STUDY: &str = "\
schema = 1
title = \"six barrels\"
seed = 6
[base]
extends = \"candia-6-barrels\"
[base.run]
duration = \"20 s\"
stop_after_collapse = \"0.01 s\"
[[motion]]
synthetic = { kind = \"boore\", count = 10, magnitude = 6.5, distance = \"10 km\" }
[intensity]
measure = \"pgv\"
";

fn found(design: &str) -> Decision {
    let study = Study::parse("test.toml", &format!("{STUDY}{design}")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let collected = study.run(&out, &RunOptions::default(), &|_| ControlFlow::Continue(()));
    decide(&collected.unwrap(), &Request::default()).unwrap()
}

/// Returns the curve of collapse, and the 95 % intervals of median and dispersion.
fn curve(name: &str, found: &Decision) -> (Lognormal, [Interval; 2]) {
    let limit = &found.curves[0];
    let fitted = limit.fit.as_ref().unwrap().curve;
    let intervals = [limit.median.unwrap(), limit.left_out.as_ref().unwrap().dispersion(0.95)];
    println!("{name}: {} cases, {fitted:.4?}, {intervals:.4?}", found.cases.all.len());
    println!("  motions that it stands above a level that felled it: {}", limit.returned.len());
    for stripe in &limit.stripes {
        println!("  {:.3} m/s: {} of {}", stripe.intensity, stripe.failures, stripe.cases);
    }
    (fitted, intervals)
}

#[test]
fn hunts_and_stripes_agree_within_their_bands_on_the_six_barrels() {
    let hunts =
        found("[design]\nkind = \"ida\"\nfirst = \"20 cm/s\"\nstep = \"20 cm/s\"\nruns = 10\n");
    let stripes = found(
        "levels = [\"30 cm/s\", \"40 cm/s\", \"50 cm/s\", \"60 cm/s\", \"80 cm/s\"]\n\
         [design]\nkind = \"stripes\"\n",
    );
    assert_eq!(hunts.cases.records, stripes.cases.records);
    let (hunted, of_hunts) = curve("hunts", &hunts);
    let (striped, of_stripes) = curve("stripes", &stripes);
    // Measured: 0.531 m/s in 0.449 to 0.627, and 0.514 m/s in 0.438 to 0.603.
    assert!(of_stripes[0].holds(hunted.median) && of_hunts[0].holds(striped.median));
    // Measured: 0.221 in 0.130 to 0.375, and 0.209 in 0.120 to 0.363.
    assert!(of_stripes[1].holds(hunted.dispersion) && of_hunts[1].holds(striped.dispersion));
}
