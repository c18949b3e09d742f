//! Motions that are formulas: sines and pulses of a stated peak.

use barrelstack_motion::{
    GroundMotion, History, IntensityMeasure, MotionError, Pulse as MotionPulse,
};

use crate::motion::{Amplitude, Direction, Pulse, PulseKind, Sine};

pub(super) fn harmonic(sine: &Sine) -> Result<GroundMotion, MotionError> {
    let frequency = std::f64::consts::TAU / sine.period;
    let amplitude = match sine.amplitude {
        Amplitude::Displacement(d) => d,
        Amplitude::Velocity(v) => v / frequency,
        Amplitude::Acceleration(a) => a / (frequency * frequency),
    };
    let pulse = MotionPulse::Sine {
        amplitude,
        period: sine.period,
        cycles: sine.cycles,
        ramp_cycles: sine.ramp_cycles,
    };
    Ok(directed(GroundMotion::from_pulse("sine", pulse)?, sine.direction, 0.0))
}

/// A pulse whose peak is what the scenario says.
///
/// Each form has an amplitude of its own, of acceleration or of velocity; where the scenario states
/// the other one, the pulse is scaled to it.
pub(super) fn pulsed(pulse: &Pulse) -> Result<GroundMotion, MotionError> {
    let period = pulse.period;
    let unit = 1.0;
    let (name, natural, made) = match pulse.kind {
        PulseKind::Ricker => (
            "Ricker pulse",
            Natural::Acceleration,
            MotionPulse::Ricker { acceleration: unit, period },
        ),
        PulseKind::HalfSine => (
            "half sine",
            Natural::Acceleration,
            MotionPulse::HalfSine { acceleration: unit, duration: 0.5 * period },
        ),
        PulseKind::OneSine => {
            ("one sine", Natural::Acceleration, MotionPulse::OneSine { acceleration: unit, period })
        }
        PulseKind::OneCosine => (
            "one cosine",
            Natural::Acceleration,
            MotionPulse::OneCosine { acceleration: unit, period },
        ),
        PulseKind::Rectangular => (
            "rectangular pulse",
            Natural::Acceleration,
            MotionPulse::Rectangular { acceleration: unit, duration: period },
        ),
        PulseKind::Gabor { gamma, phase } => (
            "Gabor pulse",
            Natural::Velocity,
            MotionPulse::Gabor { velocity: unit, period, gamma, phase },
        ),
        PulseKind::CycloidA => {
            ("cycloid A", Natural::Velocity, MotionPulse::CycloidA { velocity: unit, period })
        }
        PulseKind::CycloidB => {
            ("cycloid B", Natural::Velocity, MotionPulse::CycloidB { velocity: unit, period })
        }
        PulseKind::CycloidC { cycles } => (
            "cycloid C",
            Natural::Velocity,
            MotionPulse::CycloidC { velocity: unit, period, cycles },
        ),
        PulseKind::MavroeidisPapageorgiou { gamma, phase } => (
            "Mavroeidis–Papageorgiou pulse",
            Natural::Velocity,
            MotionPulse::MavroeidisPapageorgiou { velocity: unit, period, gamma, phase },
        ),
    };
    let base = GroundMotion::from_pulse(name, made)?;
    let sized = match (pulse.amplitude, natural) {
        (Amplitude::Acceleration(a), Natural::Acceleration) => base.scaled(a),
        (Amplitude::Velocity(v), Natural::Velocity) => base.scaled(v),
        (Amplitude::Acceleration(a), Natural::Velocity) => {
            base.scale_to(IntensityMeasure::Pga, a)?
        }
        (Amplitude::Velocity(v), Natural::Acceleration) => {
            base.scale_to(IntensityMeasure::Pgv, v)?
        }
        (Amplitude::Displacement(d), _) => base.scale_to(IntensityMeasure::Pgd, d)?,
    };
    Ok(directed(sized, pulse.direction, pulse.start))
}

/// What the amplitude of a pulse's formula is.
#[derive(Clone, Copy)]
enum Natural {
    Acceleration,
    Velocity,
}

/// A horizontal motion, turned to its direction and delayed.
fn directed(motion: GroundMotion, direction: Direction, start: f64) -> GroundMotion {
    let history = if start == 0.0 {
        motion.horizontal
    } else {
        let delayed = barrelstack_motion::Delayed { delay: start, history: motion.horizontal };
        History::Sum(vec![delayed])
    };
    let mut made = match direction {
        Direction::Horizontal => GroundMotion::new(motion.name, history, None),
        Direction::Vertical => {
            GroundMotion::new(motion.name, History::Sum(Vec::new()), Some(history))
        }
    };
    made.provenance = motion.provenance;
    made
}
