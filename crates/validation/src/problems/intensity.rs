//! Intensity measures of motions with closed-form answers: a harmonic motion and a constant acceleration.

use std::f64::consts::{PI, TAU};

use barrelstack_dynamics::math::{exp, sin};
use barrelstack_motion::{IntensityMeasure, STANDARD_GRAVITY, Sampled, response};

use crate::problem::{absent, relative, setting};
use crate::{Failure, Problem};

const SOURCE: &str = "integrals of a harmonic";
const STEP: &str = "oscillator pushed by a constant force";

/// Amplitude (m/s²) of the harmonic motion.
const AMPLITUDE: f64 = 0.3 * STANDARD_GRAVITY;
/// Period (s) of the harmonic motion.
const PERIOD: f64 = 0.5;
/// Number of cycles of the harmonic motion.
const CYCLES: u32 = 8;

/// Damping ratio of the response spectra.
const DAMPING: f64 = 0.05;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let time = f64::from(CYCLES) * PERIOD;
    let arias = PI / (2.0 * STANDARD_GRAVITY) * AMPLITUDE * AMPLITUDE * time / 2.0;
    let mut list = vec![
        of_harmonic("arias", "Arias intensity", IntensityMeasure::Arias, "m/s", arias),
        of_harmonic("cav", "CAV", IntensityMeasure::Cav, "m/s", 2.0 / PI * AMPLITUDE * time),
        of_harmonic("pgv", "PGV", IntensityMeasure::Pgv, "m/s", AMPLITUDE * PERIOD / PI),
    ];
    list.extend([0.1, 0.5, 2.0].map(of_push));
    list.push(short_period());
    list.push(housner_intensity());
    list
}

fn harmonic() -> Result<Sampled, Failure> {
    const PER_CYCLE: u32 = 4000;
    let wave = |i: u32| AMPLITUDE * sin(TAU * f64::from(i) / f64::from(PER_CYCLE));
    sampled(PERIOD / f64::from(PER_CYCLE), (0..=CYCLES * PER_CYCLE).map(wave).collect())
}

fn sampled(step: f64, acceleration: Vec<f64>) -> Result<Sampled, Failure> {
    Sampled::new(step, acceleration).map_err(absent)
}

fn measured(measure: &IntensityMeasure, motion: &Sampled) -> Result<f64, Failure> {
    measure.of(motion).map_err(absent)
}

fn of_harmonic(
    name: &str,
    quantity: &'static str,
    measure: IntensityMeasure,
    unit: &'static str,
    exact: f64,
) -> Problem {
    setting(
        format!("intensity/harmonic-{name}"),
        format!("A sin 2πt/T with A = 0.3 g, T = {PERIOD} s, {CYCLES} cycles"),
        SOURCE,
    )
    .quantity(quantity, unit, relative(exact, 1e-6)) // measured 2.1e-7
    .by(move |_| measured(&measure, &harmonic()?))
}

/// Returns a ground acceleration of 1 m/s² that lasts 4 s.
fn push(step: f64) -> Result<Sampled, Failure> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let samples = (4.0 / step) as usize;
    sampled(step, vec![1.0; samples])
}

/// Returns the largest pseudo-acceleration divided by the constant ground acceleration: 1 + e^{−πζ/√(1−ζ²)}.
fn overshoot() -> f64 {
    1.0 + exp(-PI * DAMPING / (1.0 - DAMPING * DAMPING).sqrt())
}

fn of_push(period: f64) -> Problem {
    setting(
        format!("intensity/push-{period}"),
        format!("oscillator with a period of {period} s and 5 % damping under a sustained push"),
        STEP,
    )
    .quantity("pseudo-acceleration divided by the push", "", relative(overshoot(), 1e-5)) // measured 1.3e-6
    .by(move |_| {
        let motion = push(period / 1000.0)?;
        let found =
            response(motion.time_step(), motion.acceleration(), period, DAMPING).map_err(absent)?;
        Ok(found.pseudo_acceleration)
    })
}

fn short_period() -> Problem {
    setting(
        "intensity/short-period",
        "the harmonic motion with twelve samples per cycle; oscillator period of a twentieth of \
         the sample step",
        SOURCE,
    )
    .quantity("Sa divided by PGA", "", relative(1.0, 1e-3)) // measured 1.0e-4
    .by(|_| {
        // With twelve samples per cycle, a sample step is 42 ms, so the recursion has to divide it.
        let wave = |i: u32| AMPLITUDE * sin(TAU * f64::from(i) / 12.0);
        let motion = sampled(PERIOD / 12.0, (0..=12 * CYCLES).map(wave).collect())?;
        let short = IntensityMeasure::Sa { period: 0.002, damping: DAMPING };
        Ok(measured(&short, &motion)? / measured(&IntensityMeasure::Pga, &motion)?)
    })
}

/// Creates the problem of the Housner intensity `∫ PSV dT` from 0.1 s to 2.5 s, with `PSV = S_a T/2π` and equal `S_a`
/// at all periods.
fn housner_intensity() -> Problem {
    let exact = overshoot() * (2.5 * 2.5 - 0.1 * 0.1) / (2.0 * TAU);
    setting("intensity/housner", "Housner intensity of a sustained push of 1 m/s²", STEP)
        .quantity("Housner intensity", "m", relative(exact, 1e-3)) // measured 6.7e-7
        .by(|_| {
            let measure = IntensityMeasure::Housner { damping: DAMPING };
            measured(&measure, &push(0.001)?)
        })
}
