//! Computes the wave of rows of dominoes: the table and the figure of `validation/dominoes.md`.
//!
//! `cargo run --release -p barrelstack-validation --example dominoes FIGURE.svg`
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use barrelstack_report::{Axis, Figure, Plot, Series, SeriesStyle};
use barrelstack_validation::dominoes::{DOMINO, Row, theory};

/// Coefficients of friction between dominoes.
const FRICTION: [f64; 3] = [0.0, 0.2, 0.4];

/// Returns a speed, or that the wave stopped.
fn shown(speed: Option<f64>) -> String {
    speed.map_or_else(|| "stops".to_owned(), |speed| format!("{speed:.3}"))
}

fn main() -> Result<(), Box<dyn Error>> {
    let spacings = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let fine: Vec<f64> = (8..=64).map(|at| 0.01 * f64::from(at)).collect();
    let exact = fine.iter().map(|spacing| theory(DOMINO, *spacing)).collect();
    let mut series = vec![Series::new("theory, smooth dominoes", fine, exact)];
    let mut found = vec![Vec::new(); FRICTION.len()];
    println!(
        "| free distance / height | theory | computed, friction 0 | difference from the theory | friction 0.2 \
         | friction 0.4 |"
    );
    println!("|---|---|---|---|---|---|");
    for spacing in spacings {
        for (friction, all) in FRICTION.into_iter().zip(&mut found) {
            // The closer the dominoes, the more of them lean on the front.
            let count = if spacing < 0.15 { 48 } else { 32 };
            all.push(Row { count, spacing, friction }.speed().ok());
        }
        let at = found[0].len() - 1;
        let (exact, own) = (theory(DOMINO, spacing), found[0][at]);
        println!(
            "| {spacing} | {exact:.3} | {} | {} | {} | {} |",
            shown(own),
            own.map_or_else(String::new, |own| format!("{:+.1} %", 100.0 * (own / exact - 1.0))),
            shown(found[1][at]),
            shown(found[2][at])
        );
    }
    for (friction, own) in FRICTION.into_iter().zip(found) {
        let style = SeriesStyle { dots: true, ..SeriesStyle::default() };
        let name = format!("computed, friction {friction}");
        let both = spacings.into_iter().zip(own);
        let (places, own) = both.filter_map(|(place, own)| Some((place, own?))).unzip();
        series.push(Series { style, ..Series::new(&name, places, own) });
    }
    if let Some(path) = std::env::args().nth(1) {
        let plot = Plot {
            x: Axis::new("free distance between dominoes", "heights"),
            y: Axis::new("speed of the wave", "√(gravity · height)"),
            series,
            ..Plot::default()
        };
        let caption = "Speed of the wave of a row of dominoes, as a function of their distance.";
        std::fs::write(path, Figure::new("dominoes", caption, plot).to_svg())?;
    }
    Ok(())
}
