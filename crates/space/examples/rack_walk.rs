//! Computes the walk of a rack in one cycle of shaking as a function of the stiffness of its seats: the tables and the
//! figure of `validation/rack-walk.md`.
//!
//! `cargo run --release --package barrelstack-space --example rack_walk FIGURE.svg`
#![expect(clippy::print_stdout, reason = "an example prints")]

#[path = "../tests/two_seats/mod.rs"]
mod two_seats;

use std::error::Error;

use barrelstack::Scenario;
use barrelstack::scenario::Scene;
use barrelstack_report::{Axis, Figure, Plot, Series, SeriesStyle};
use two_seats::{Cycle, GRAVITY, TwoSeats, newmark};

/// Stiffness (N/m) of a rail on a crown in the catalog, and of a contact element of Candia et al. (2008).
const CATALOG: f64 = 3e6;
const PAPER: f64 = 9.8e5;

/// Number of variants, which differ only in positions and masses.
const VARIANTS: u32 = 6;

#[derive(Clone, Copy, PartialEq)]
enum Shown {
    Along,
    Across,
    Space,
}

impl Shown {
    const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Along, "along the barrels", "longitudinal"),
        (Self::Across, "across the barrels", "transverse"),
        (Self::Space, "in space, shaken along the barrels", "spatial"),
    ];
}

/// Returns the absolute walk (m) of the upper of two racks relative to the lower one after a cycle, as the mean over
/// variants.
fn walk(shown: Shown, stiffness: f64, friction: f64, cycle: Cycle) -> Result<f64, Box<dyn Error>> {
    let (.., view) = Shown::ALL.into_iter().find(|(one, ..)| *one == shown).ok_or("a view")?;
    let mut changes = vec![
        format!("stack.view={view}"),
        "stack.levels=2".to_owned(),
        format!("interface.barrel-rack.friction.coefficient={friction}"),
        format!(
            "motion={{ pulse = {{ kind = \"one-sine\", amplitude = \"{} m/s^2\", period = \"{} s\", start = \"0 s\" }} }}",
            cycle.amplitude, cycle.period
        ),
        format!("run.duration=\"{} s\"", cycle.period + 1.0),
        "run.until=\"duration\"".to_owned(),
        "unknowns.drawn=false".to_owned(),
    ];
    if shown == Shown::Along {
        changes.push("stack.columns=1".to_owned());
    }
    if shown == Shown::Space {
        changes.push("stack.azimuth=\"90 deg\"".to_owned());
    }
    let mut stated = Scenario::builtin("demo-napa", &changes)?;
    if let Scene::Stack { stack, .. } = &mut stated.scene {
        stack.interfaces.barrel_rack.stiffen(stiffness / CATALOG);
        stack.interfaces.rack_ground.stiffen(stiffness / CATALOG);
    }
    let mut sum = 0.0;
    let planes = barrelstack::variants::planes(&stated)?;
    for number in 1..=VARIANTS {
        let variant = planes[0].variant(number);
        sum += if shown == Shown::Space {
            let run = barrelstack_space::run::run(&variant)?;
            let place = |name: &str, frame: &[[f64; 7]]| {
                run.stack.parts.iter().position(|part| part.name == name).map(|body| frame[body])
            };
            let frames = &run.frames.poses;
            let apart = |frame: Option<&Vec<[f64; 7]>>| {
                let frame = frame?;
                let (upper, lower) = (place("R2", frame)?, place("R1", frame)?);
                Some([upper[0] - lower[0], upper[1] - lower[1]])
            };
            let (first, last) = (apart(frames.first()), apart(frames.last()));
            let (first, last) = first.zip(last).ok_or("two racks")?;
            (last[0] - first[0]).hypot(last[1] - first[1])
        } else {
            let run = variant.run()?;
            let end = |name: &str| {
                run.recording.displacement(name).and_then(|own| own.values.last()).copied()
            };
            let (upper, lower) = end("R2").zip(end("R1")).ok_or("two racks")?;
            (upper - lower).abs()
        };
    }
    Ok(sum / f64::from(VARIANTS))
}

/// Returns the simplest model of the upper level: a barrel with its share of a rack on two rails.
fn block(stiffness: f64, friction: f64) -> TwoSeats {
    let (mass, height) = (290.0, 0.53);
    // A damping ratio of 0.156, which follows from the catalog's restitution of 0.8 for a quarter of a barrel.
    let damping = 2.0 * 0.156 * (70.0 * stiffness).sqrt();
    // Moment of inertia of a full barrel whose wine does not rotate with it, about an axis at the height of the barrel.
    let inertia = 40.0;
    TwoSeats { mass, inertia, height, half_spacing: 0.27, stiffness, damping, friction, stick: 2.0 }
}

fn main() -> Result<(), Box<dyn Error>> {
    let cycle = Cycle { amplitude: 0.4 * GRAVITY, period: 0.8 };
    let friction = 0.3;
    let mm = |value: f64| 1e3 * value;
    let rigid = mm(newmark(friction, cycle).abs());
    let soft: Vec<f64> = [0.3, 1.0, 3.0, 10.0, 30.0, 100.0].map(|f| f * 1e6).to_vec();
    let mut series = vec![
        Series::new("rigid seats (Newmark)", vec![0.3, 1000.0], vec![rigid; 2]),
        Series::new(
            "two seats under a block",
            (-3..=18).map(|i| 10_f64.powf(f64::from(i) / 6.0)).collect(),
            (-3..=18)
                .map(|i| {
                    mm(block(1e6 * 10_f64.powf(f64::from(i) / 6.0), friction).walk(cycle).abs())
                })
                .collect(),
        ),
    ];
    println!("0.4 g, 0.8 s, friction 0.3: Newmark's block {rigid:.1} mm\n");
    println!(
        "| seat (MN/m) | two seats under a block | {} |",
        Shown::ALL.map(|(_, n, _)| n).join(" | ")
    );
    println!("|---|---|---|---|---|");
    let mut walked = vec![Vec::new(); Shown::ALL.len()];
    for stiffness in &soft {
        let own = mm(block(*stiffness, friction).walk(cycle).abs());
        print!("| {} | {own:.1} |", 1e-6 * stiffness);
        for ((shown, ..), walked) in Shown::ALL.into_iter().zip(&mut walked) {
            let found = mm(walk(shown, *stiffness, friction, cycle)?);
            print!(" {found:.1} |");
            walked.push(found);
        }
        println!();
    }
    for ((_, name, _), walked) in Shown::ALL.into_iter().zip(walked) {
        let places = soft.iter().map(|k| 1e-6 * k).collect();
        let style = SeriesStyle { dots: true, ..SeriesStyle::default() };
        series.push(Series { style, ..Series::new(format!("two levels {name}"), places, walked) });
    }
    println!(
        "\n| friction | amplitude (g) | period (s) | Newmark's block | two seats under a block, 0.98 MN/m \
         | along, 0.98 MN/m | along, 3 MN/m | along, 30 MN/m |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (friction, amplitude, period) in [
        (0.2, 0.4, 0.8),
        (0.3, 0.4, 0.8),
        (0.45, 0.4, 0.8),
        (0.3, 0.2, 0.8),
        (0.3, 0.3, 0.8),
        (0.3, 0.5, 0.8),
        (0.3, 0.4, 0.3),
        (0.3, 0.4, 0.5),
        (0.3, 0.4, 1.2),
    ] {
        let cycle = Cycle { amplitude: amplitude * GRAVITY, period };
        print!(
            "| {friction} | {amplitude} | {period} | {:.1} |",
            mm(newmark(friction, cycle).abs())
        );
        print!(" {:.1} |", mm(block(PAPER, friction).walk(cycle).abs()));
        for stiffness in [PAPER, CATALOG, 3e7] {
            print!(" {:.1} |", mm(walk(Shown::Along, stiffness, friction, cycle)?));
        }
        println!();
    }
    if let Some(path) = std::env::args().nth(1) {
        let plot = Plot {
            x: Axis::new("stiffness of a seat", "MN/m").log(),
            y: Axis::new("displacement left by one cycle", "mm"),
            series,
            ..Plot::default()
        };
        let caption = "Displacement of the upper rack on the lower one after one cycle of 0.4 g and 0.8 s, as a function of the stiffness of the seats.";
        std::fs::write(path, Figure::new("rack-walk", caption, plot).to_svg())?;
    }
    Ok(())
}
