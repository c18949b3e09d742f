//! Response spectrum of the ground motion, with the rocking periods of the stack.

use barrelstack_motion::{GroundMotion, ResponseSpectrum, STANDARD_GRAVITY, standard_periods};
use barrelstack_report::{
    Axis, Band, Block, Figure, Mark, Plot, Series, SeriesStyle, measured, significant,
};

use crate::period::{Drift, RigidBlock, Swing, drift};
use crate::run::Run;

/// Damping ratio of the response spectrum.
const DAMPING: f64 = 0.05;

/// Number of intervals into which the plotted curve of the rigid block is divided.
const CURVE: u32 = 60;

/// Measured rocking of a stack, and the rigid block equivalent to the stack.
struct Rocking {
    drift: Drift,
    block: RigidBlock,
}

impl Rocking {
    /// Returns the measured rocking of a run; `None` for a free scene, or if the top did not drift.
    fn of(run: &Run) -> Option<Self> {
        let block = RigidBlock::of(&run.assembly, run.scenario.run.gravity)?;
        let mut drift = drift(run).filter(|drift| drift.largest > 0.0)?;
        // The figures need the swings sorted by amplitude.
        drift.swings.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        Some(Self { drift, block })
    }

    /// Returns the rocking period (s) of the rigid block at the tilt that corresponds to a
    /// displacement of the top by `amplitude` (m).
    fn rigid(&self, amplitude: f64) -> f64 {
        self.block.period(amplitude / self.drift.height)
    }

    fn widest(&self) -> Option<&Swing> {
        self.drift.swings.last()
    }

    /// Returns the shortest and the longest period (s) of the swings.
    fn range(&self) -> (f64, f64) {
        let periods = || self.drift.swings.iter().map(|swing| swing.period);
        (periods().fold(f64::INFINITY, f64::min), periods().fold(0.0, f64::max))
    }
}

/// Plots the response spectrum and, for a rocking stack, the rocking periods.
pub(super) fn figures(run: &Run, motion: &GroundMotion) -> Vec<Block> {
    let rocking = Rocking::of(run);
    let mut blocks = Vec::new();
    blocks.extend(spectrum(motion, rocking.as_ref()).map(Block::Figure));
    if let Some(rocking) = rocking {
        let rocking = vec![Block::Paragraph(words(&rocking)), Block::Figure(periods(&rocking))];
        blocks.push(Block::on_screen("Rocking periods", rocking));
    }
    blocks
}

fn centimeters(amplitude: f64) -> String {
    format!("{} cm", measured(100.0 * amplitude, 1))
}

fn words(rocking: &Rocking) -> String {
    let Rocking { drift, block } = rocking;
    let reached = centimeters(drift.largest);
    let period = rocking.rigid(drift.largest);
    let (rigid, loose) = if period.is_finite() {
        (
            format!(
                "would rock with a period of {} s at the largest drift",
                significant(period, 2)
            ),
            "a stack of loose parts rocks more slowly than such a block, because its parts can move at every level",
        )
    } else {
        (
            "would overturn at the largest drift, so it has no period there".to_owned(),
            "at smaller drifts, a stack of loose parts rocks more slowly than such a block, because its parts \
             can move at every level",
        )
    };
    let measured = match (&drift.swings[..], rocking.widest()) {
        (_, None) => "it made no full swing".to_owned(),
        ([one], _) => format!(
            "it made one full swing, with an amplitude of {} and a period of {} s",
            centimeters(one.amplitude),
            significant(one.period, 2)
        ),
        (many, Some(widest)) => {
            let (low, high) = rocking.range();
            format!(
                "it made {} full swings with periods of {} to {} s; the widest swing has an amplitude of {} and a \
                 period of {} s",
                many.len(),
                significant(low, 2),
                significant(high, 2),
                centimeters(widest.amplitude),
                significant(widest.period, 2)
            )
        }
    };
    format!(
        "A stack has no fixed natural period: the farther it rocks, the longer its period, so it responds to \
         different periods of the ground motion as its amplitude changes. While the stack stood, its top drifted \
         by up to {reached} relative to its foot, and {measured}. A rigid block with the mass and the foot width of \
         the stack {rigid} (Housner 1963: T = 4/p · arcosh(1/(1 − θ₀/α)) with p = {} 1/s and α = {} rad); {loose}.",
        significant(block.frequency, 3),
        significant(block.slenderness, 3),
    )
}

/// Plots the pseudo-acceleration spectrum of the horizontal component; `None` if it cannot be
/// computed.
fn spectrum(motion: &GroundMotion, rocking: Option<&Rocking>) -> Option<Figure> {
    let step = motion.horizontal.natural_step();
    let sampled = motion.horizontal.sampled(step).ok()?;
    let periods: Vec<f64> = standard_periods(30);
    let spectrum = ResponseSpectrum::new(step, sampled.acceleration(), &periods, DAMPING).ok()?;
    let values = spectrum.pseudo_acceleration().iter().map(|a| a / STANDARD_GRAVITY).collect();
    let mut caption = String::from(
        "Pseudo-acceleration response spectrum of the horizontal motion, 5 % damping.",
    );
    let mut plot = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new("spectral acceleration", "g"),
        series: vec![Series::new("horizontal", periods, values)],
        interactive: true,
        ..Plot::default()
    };
    if let Some(rocking) = rocking {
        let reached = rocking.drift.largest;
        let rigid = rocking.rigid(reached);
        if rigid.is_finite() {
            plot.marks.push(Mark {
                at: rigid,
                label: format!("rigid block at {}", centimeters(reached)),
            });
            caption.push_str(
                " A dashed line marks the rocking period of a rigid block with the shape of the stack, at the \
                 largest drift of the stack.",
            );
        }
        match (&rocking.drift.swings[..], rocking.widest()) {
            ([one], _) => {
                let label = format!("stack at {}", centimeters(one.amplitude));
                plot.marks.push(Mark { at: one.period, label });
                caption.push_str(
                    " The stack swings only once; a dashed line also marks the period of this swing.",
                );
            }
            (_, Some(_)) => {
                let (from, to) = rocking.range();
                plot.bands.push(Band { from, to, label: "swings of the stack".into() });
                caption
                    .push_str(" The periods of the swings of the stack lie in the shaded range.");
            }
            (_, None) => {}
        }
    }
    Some(Figure::new("spectrum", caption, plot))
}

/// Plots period against amplitude, for every swing of the run and for the rigid block.
fn periods(rocking: &Rocking) -> Figure {
    let amplitudes: Vec<f64> = (0..=CURVE)
        .map(|k| 1.15 * rocking.drift.largest * f64::from(k) / f64::from(CURVE))
        .collect();
    let curve = amplitudes.iter().map(|a| rocking.rigid(*a)).collect();
    let mut series =
        vec![Series::new("rigid block", amplitudes.iter().map(|a| 100.0 * a).collect(), curve)];
    if rocking.widest().is_some() {
        let swings = &rocking.drift.swings;
        let x = swings.iter().map(|swing| 100.0 * swing.amplitude).collect();
        let y = swings.iter().map(|swing| swing.period).collect();
        let style = SeriesStyle { points: true, ..SeriesStyle::default() };
        series.push(Series { style, ..Series::new("swings of the stack", x, y) });
    }
    let plot = Plot {
        x: Axis::new("amplitude", "cm"),
        y: Axis::new("period", "s"),
        marks: vec![Mark { at: 100.0 * rocking.drift.largest, label: "largest drift".into() }],
        series,
        interactive: true,
        ..Plot::default()
    };
    let caption = "Rocking period as a function of the amplitude at the top, for a rigid block with the mass and the \
                   foot width of the stack, and for the swings of the stack while it stood. The period of a swing is \
                   twice the time between two zero crossings of the drift.";
    Figure::new("periods", caption, plot)
}
