//! The response spectrum of the ground motion.

use barrelstack_motion::{GroundMotion, ResponseSpectrum, STANDARD_GRAVITY, standard_periods};
use barrelstack_report::{Axis, Figure, FigureKind, Plot, Series};

/// Damping ratio of the spectrum.
const DAMPING: f64 = 0.05;

/// The pseudo-acceleration spectrum of the horizontal component; none where it cannot be computed.
pub(super) fn figure(motion: &GroundMotion) -> Option<Figure> {
    let step = motion.horizontal.natural_step();
    let sampled = motion.horizontal.sampled(step).ok()?;
    let periods: Vec<f64> = standard_periods(30);
    let spectrum = ResponseSpectrum::new(step, sampled.acceleration(), &periods, DAMPING).ok()?;
    let values = spectrum.pseudo_acceleration().iter().map(|a| a / STANDARD_GRAVITY).collect();
    Some(Figure {
        id: "spectrum".into(),
        caption: "Pseudo-acceleration response spectrum of the horizontal motion, 5 % damping."
            .into(),
        kind: FigureKind::Plot(Plot {
            x: Axis::new("period", "s").log(),
            y: Axis::new("spectral acceleration", "g"),
            series: vec![Series::new("horizontal", periods, values)],
            ..Plot::default()
        }),
    })
}
