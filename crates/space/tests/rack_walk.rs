//! Walk of a rack on soft seats: the rigid limit, and comparison of the simplest model with the program.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use crate::two_seats::{Cycle, GRAVITY, TwoSeats, newmark};
use barrelstack::Scenario;

const CYCLE: Cycle = Cycle { amplitude: 0.5 * GRAVITY, period: 0.6 };

/// A full barrel with its share of a rack, on two rails.
fn block(stiffness: f64) -> TwoSeats {
    let (width, height, mass) = (0.54_f64, 1.06_f64, 290.0);
    TwoSeats {
        mass,
        inertia: mass * (width * width + height * height) / 12.0,
        height: 0.5 * height,
        half_spacing: 0.5 * width,
        stiffness,
        // A fifth of the critical damping for half of the mass.
        damping: 0.2 * 2.0 * (0.5 * mass * stiffness).sqrt(),
        friction: 0.3,
        stick: 1.0,
    }
}

#[test]
fn the_smallest_model_slides_as_newmarks_block_where_its_seats_are_rigid() {
    // A low block, so that nothing lifts off.
    let low = TwoSeats { height: 0.02, inertia: 290.0 * 0.1, ..block(1e9) };
    for (friction, cycle) in [(0.05, CYCLE), (0.15, CYCLE), (0.1, Cycle { period: 1.0, ..CYCLE })] {
        let rigid = newmark(friction, cycle);
        let found = TwoSeats { friction, ..low }.walk(cycle);
        println!("Newmark {rigid:.5} m, two seats of 1 GN/m {found:.5} m");
        // Measured 0.02, 0.5 and 0.07 %.
        assert!((found / rigid - 1.0).abs() < 0.01, "{found} {rigid}");
    }
}

#[test]
fn the_program_walks_a_block_as_the_smallest_model_does() {
    for stiffness in [1e6, 3e6, 1e7] {
        let two = block(stiffness);
        let sunk = 0.5 * two.mass * GRAVITY / stiffness;
        let text = format!(
            "schema = 1\nkind = \"free\"\n\
             [[body]]\nname = \"block\"\nmass = \"{} kg\"\nposition = [\"0 m\", \"{} m\"]\nnodes = \"corners\"\n\
             shape = {{ type = \"rectangle\", width = \"0.54 m\", height = \"1.06 m\" }}\n\
             [[interface]]\nbetween = [\"block\", \"ground\"]\nstiffness = \"{stiffness} N/m\"\ndamping = \"{} N s/m\"\n\
             friction = {{ coefficient = 0.3 }}\n\
             [motion.pulse]\nkind = \"one-sine\"\namplitude = \"0.5 g\"\nperiod = \"0.6 s\"\nstart = \"0 s\"\n\
             [run]\nduration = \"1.6 s\"\nuntil = \"duration\"\n",
            two.mass,
            two.height - sunk,
            two.damping
        );
        let run = Scenario::from_str(&text).unwrap().run().unwrap();
        let values = &run.recording.displacement("block").unwrap().values;
        let (program, own) = (*values.last().unwrap(), two.walk(CYCLE));
        println!("{stiffness:e} N/m: program {program:.5} m, two seats {own:.5} m");
        // Measured 0.1 %.
        assert!((program / own - 1.0).abs() < 0.02, "{program} {own}");
    }
}
