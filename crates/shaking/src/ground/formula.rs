//! Analytic motions: sines and pulses with a given peak.

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

/// Creates a pulse with the peak that the scenario states.
///
/// Each form of pulse is defined by an acceleration or by a velocity. If the scenario states the other quantity, the
/// pulse is scaled so that its peak reaches the stated value.
pub(super) fn pulsed(pulse: &Pulse) -> Result<GroundMotion, MotionError> {
    let period = pulse.period;
    let (acceleration, velocity) = (1.0, 1.0);
    let (name, made) = match pulse.kind {
        PulseKind::Ricker => ("Ricker pulse", MotionPulse::Ricker { acceleration, period }),
        PulseKind::HalfSine => {
            ("half sine", MotionPulse::HalfSine { acceleration, duration: 0.5 * period })
        }
        PulseKind::OneSine => ("one sine", MotionPulse::OneSine { acceleration, period }),
        PulseKind::OneCosine => ("one cosine", MotionPulse::OneCosine { acceleration, period }),
        PulseKind::Rectangular => {
            ("rectangular pulse", MotionPulse::Rectangular { acceleration, duration: period })
        }
        PulseKind::Gabor { gamma, phase } => {
            ("Gabor pulse", MotionPulse::Gabor { velocity, period, gamma, phase })
        }
        PulseKind::CycloidA => ("cycloid A", MotionPulse::CycloidA { velocity, period }),
        PulseKind::CycloidB => ("cycloid B", MotionPulse::CycloidB { velocity, period }),
        PulseKind::CycloidC { cycles } => {
            ("cycloid C", MotionPulse::CycloidC { velocity, period, cycles })
        }
        PulseKind::MavroeidisPapageorgiou { gamma, phase } => (
            "Mavroeidis–Papageorgiou pulse",
            MotionPulse::MavroeidisPapageorgiou { velocity, period, gamma, phase },
        ),
    };
    let base = GroundMotion::from_pulse(name, made)?;
    let of_velocity = matches!(
        pulse.kind,
        PulseKind::Gabor { .. }
            | PulseKind::CycloidA
            | PulseKind::CycloidB
            | PulseKind::CycloidC { .. }
            | PulseKind::MavroeidisPapageorgiou { .. }
    );
    let sized = match (pulse.amplitude, of_velocity) {
        (Amplitude::Acceleration(a), false) => base.scaled(a),
        (Amplitude::Velocity(v), true) => base.scaled(v),
        (Amplitude::Acceleration(a), true) => base.scale_to(IntensityMeasure::Pga, a)?,
        (Amplitude::Velocity(v), false) => base.scale_to(IntensityMeasure::Pgv, v)?,
        (Amplitude::Displacement(d), _) => base.scale_to(IntensityMeasure::Pgd, d)?,
    };
    Ok(directed(sized, pulse.direction, pulse.start))
}

/// Applies direction and delay to a horizontal motion.
fn directed(motion: GroundMotion, direction: Direction, start: f64) -> GroundMotion {
    let history = if start == 0.0 {
        motion.horizontal
    } else {
        let delayed = barrelstack_motion::Delayed { delay: start, history: motion.horizontal };
        History::Sum(vec![delayed])
    };
    let (horizontal, vertical) = match direction {
        Direction::Horizontal => (history, None),
        Direction::Vertical => (History::Sum(Vec::new()), Some(history)),
    };
    let provenance = motion.provenance;
    GroundMotion { provenance, ..GroundMotion::new(motion.name, horizontal, vertical) }
}
