//! Performance targets and present measurements, including measurements of the peer (Rapier) in the
//! same run.

use std::f64::consts::TAU;

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack_dynamics::{Scratch, State, settle};

use crate::scene::{AMPLITUDE, PERIOD, Scene};
use crate::{Failure, lanes, peer, user};

/// Time step (s) of the row that measures the library.
const STEP: f64 = 0.5e-3;

/// Number of cases in the study of the table.
const MANY: f64 = 10_000.0;

/// Simulated time (s) of each case.
const LENGTH: f64 = 20.0;

/// Prints the table; of the ten thousand cases of the study, only `cases` are run.
pub(crate) fn print(cases: usize) -> Result<(), Failure> {
    let sine = |amplitude: f64| move |time: f64| amplitude * (TAU / PERIOD * time).sin();
    let scene = Scene::consensus(20.0)?;
    let lanes = lanes::of_widest(&scene, STEP);
    let ground = sine(AMPLITUDE);
    let peers = peer::Stage {
        model: &scene.model,
        rest: &scene.rest,
        ground: &ground,
        friction: [0.5, 0.22],
    };
    let [peers_single, peers_double] = peer::costs(&peers, peer::COARSE);

    // The scene that a user runs: the paper's stack with its solid racks.
    let assembly = assemble(&Scenario::builtin("candia-8-barrels", &[])?)?;
    let mut rest = State::initial(&assembly.model);
    settle(&assembly.model, &mut rest, &mut Scratch::new(&assembly.model), 1e-9)?;
    let ground = sine(user::STANDING[1]);
    let users =
        peer::Stage { model: &assembly.model, rest: &rest, ground: &ground, friction: [0.5, 0.22] };
    let [users_single, users_double] = peer::costs(&users, peer::COARSE);

    let standing = user::study(user::STANDING)?;
    let half = user::study(user::HALF)?;
    let settling = user::settling()?;
    let (cores, clock) = user::on_all_cores(cases)?;
    // The demo runs in both planes; here only in the one in which it falls.
    let along = ["stack.view=longitudinal".to_owned()];
    let (eight, demo) =
        (user::single("candia-8-barrels", &[])?, user::single("demo-napa", &along)?);
    let all = clock * MANY / cases as f64;

    let (peers, users) = (peers_single.min(peers_double), users_single.min(users_double));
    println!(
        "Rapier in steps of {:.1} ms, ms per simulated second on one core: the peers' scene {:.2} (32-bit), {:.2} \
         (64-bit); eight barrels on their racks {:.2}, {:.2}",
        1e3 * peer::COARSE,
        1e3 * peers_single,
        1e3 * peers_double,
        1e3 * users_single,
        1e3 * users_double
    );
    println!(
        "study under the larger motions: {:.0} % of the cases collapse; study of {MANY} cases: {cases} were run, on \
         {cores} cores",
        100.0 * half.collapsed
    );
    println!();
    let ms = |seconds: f64| format!("{:.2} ms per simulated s", 1e3 * seconds);
    let ratio = |peer: f64, ours: f64| format!("{:.2}", peer / ours);
    let rows = [
        ("lanes through the library, peers' scene, 0.5 ms", ms(lanes), "0.4", ratio(peers, lanes)),
        (
            "study of eight barrels, standing",
            ms(standing.second),
            "1.0",
            ratio(users, standing.second),
        ),
        (
            "study of eight barrels, half collapse",
            ms(half.second),
            "1.2",
            ratio(users, half.second),
        ),
        (
            "study, cases that differ in friction: building and settling",
            format!("{:.2} ms per case", 1e3 * settling),
            "0.5",
            // Rapier computes no equilibrium to start from.
            "-".to_owned(),
        ),
        (
            "10,000 cases of 20 s on all cores",
            format!("{all:.0} s"),
            "120 on two",
            ratio(users * MANY * LENGTH / cores as f64, all),
        ),
        (
            "single run, eight barrels",
            format!("{eight:.0} × real time"),
            "250",
            ratio(users, 1.0 / eight),
        ),
        ("single run, demo", format!("{demo:.0} × real time"), "250", ratio(users, 1.0 / demo)),
        (
            "cheapest run of the peer ÷ costlier study of this program",
            ratio(users, standing.second.max(half.second)),
            "3",
            "-".to_owned(),
        ),
    ];
    println!("  {:60} {:>24} {:>12} {:>13}", "quantity", "measured", "target", "peer ÷ ours");
    for (what, now, reach, ratio) in rows {
        println!("  {what:60} {now:>24} {reach:>12} {ratio:>13}");
    }
    Ok(())
}
