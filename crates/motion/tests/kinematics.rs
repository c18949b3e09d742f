//! Velocity and acceleration are the derivatives of displacement in every kind of motion.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use crate::consistency::{derivatives_of_one_another, scattered};
use barrelstack_motion::{Delayed, GroundMotion, History, IntensityMeasure, Pulse, Sampled};

fn pulses() -> Vec<Pulse> {
    vec![
        Pulse::Sine { amplitude: 0.05, period: 0.8, cycles: 10.0, ramp_cycles: 0.0 },
        Pulse::Sine { amplitude: 0.05, period: 0.8, cycles: 10.0, ramp_cycles: 2.0 },
        Pulse::HalfSine { acceleration: 3.0, duration: 0.5 },
        Pulse::OneSine { acceleration: 3.0, period: 0.9 },
        Pulse::OneCosine { acceleration: 3.0, period: 0.9 },
        Pulse::Rectangular { acceleration: 2.0, duration: 0.4 },
        Pulse::Ricker { acceleration: 3.0, period: 0.7 },
        Pulse::Gabor { velocity: 0.6, period: 1.1, gamma: 2.5, phase: 0.7 },
        Pulse::Gabor { velocity: 0.6, period: 1.1, gamma: 6.0, phase: -1.3 },
        Pulse::CycloidA { velocity: 0.6, period: 1.2 },
        Pulse::CycloidB { velocity: 0.6, period: 1.2 },
        Pulse::CycloidC { velocity: 0.6, period: 1.2, cycles: 1 },
        Pulse::CycloidC { velocity: 0.6, period: 1.2, cycles: 3 },
        Pulse::MavroeidisPapageorgiou { velocity: 0.8, period: 1.5, gamma: 2.3, phase: 0.4 },
    ]
}

/// Integrates by Simpson's rule over a smooth interval.
fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 200;
    let h = (to - from) / f64::from(n);
    let mut sum = f(from) + f(to);
    for k in 1..n {
        sum += if k % 2 == 0 { 2.0 } else { 4.0 } * f(from + h * f64::from(k));
    }
    sum * h / 3.0
}

#[test]
fn every_pulse_is_consistent_at_scattered_times() {
    for pulse in pulses() {
        let end = pulse.duration();
        let history = History::Analytic(pulse);
        let (pgv, pgd) = (history.pgv(), history.pgd());
        for x in scattered(200) {
            let from = x * end * 0.999;
            let to = (from + 0.01 * end).min(end);
            let change_v = integral(from, to, |t| pulse.at(t).acceleration);
            let change_d = integral(from, to, |t| pulse.at(t).velocity);
            // The end of a ramp is a kink in the acceleration, which limits the accuracy of
            // Simpson's rule; measured 1.6e-8.
            let v = (pulse.at(to).velocity - pulse.at(from).velocity - change_v).abs();
            let d = (pulse.at(to).displacement - pulse.at(from).displacement - change_d).abs();
            assert!(v < 5e-8 * pgv, "{pulse:?} at {from}: velocity off by {v:e}");
            assert!(d < 1e-10 * pgd, "{pulse:?} at {from}: displacement off by {d:e}");
        }
    }
}

#[test]
fn a_pulse_starts_from_rest_and_coasts_after_its_end_but_a_sine_stops() {
    for pulse in pulses() {
        assert_eq!(pulse.at(-1e-9).displacement, 0.0);
        assert!(pulse.at(0.0).displacement.abs() < 1e-12, "{pulse:?}");
        if !matches!(pulse, Pulse::Sine { ramp_cycles: 0.0, .. }) {
            assert!(pulse.at(0.0).velocity.abs() < 1e-12, "{pulse:?}");
        }
        let end = pulse.at(pulse.duration());
        let later = pulse.at(pulse.duration() + 2.0);
        assert_eq!(later.acceleration, 0.0);
        let velocity = if matches!(pulse, Pulse::Sine { .. }) { 0.0 } else { end.velocity };
        assert_eq!(later.velocity, velocity, "{pulse:?}");
        let expected = end.displacement + 2.0 * velocity;
        assert!((later.displacement - expected).abs() < 1e-12);
    }
}

#[test]
fn end_displacements_are_the_published_ones() {
    let (v, period) = (0.6, 1.2);
    let end = |pulse: Pulse| pulse.at(pulse.duration());
    let a = end(Pulse::CycloidA { velocity: v, period });
    assert!((a.displacement - v * period / 2.0).abs() < 1e-14);
    assert!(end(Pulse::CycloidB { velocity: v, period }).displacement.abs() < 1e-15);
    for (cycles, peak) in [(1, 1.217), (2, 1.128), (3, 1.091)] {
        let pulse = Pulse::CycloidC { velocity: v, period, cycles };
        assert!(end(pulse).displacement.abs() < 1e-14, "cycloid C{cycles}");
        assert!(end(pulse).velocity.abs() < 1e-14, "cycloid C{cycles}");
        let pgv = History::Analytic(pulse).pgv();
        assert!((pgv / v - peak).abs() < 6e-4, "cycloid C{cycles}: {}", pgv / v);
    }
    let (gamma, phase) = (2.3_f64, 0.4_f64);
    let pulse = Pulse::MavroeidisPapageorgiou { velocity: v, period, gamma, phase };
    let net = v * period / (2.0 * std::f64::consts::PI * (1.0 - gamma * gamma))
        * phase.cos()
        * (std::f64::consts::PI * gamma).sin();
    assert!((end(pulse).displacement - net).abs() < 1e-14);
    let ricker = History::Analytic(Pulse::Ricker { acceleration: 3.0, period: 0.7 });
    let expected = 3.0 * 0.7 / (std::f64::consts::PI * (2.0 * std::f64::consts::E).sqrt());
    assert!((ricker.pgv() - expected).abs() < 1e-12);
}

#[test]
fn samples_are_consistent_between_samples() {
    let a: Vec<f64> = scattered(500).map(|x| x - 0.5).collect();
    let motion = Sampled::new(0.02, a).unwrap();
    derivatives_of_one_another("scattered accelerations", &motion);
}

#[test]
fn a_sampled_motion_coasts_after_its_end() {
    let motion = Sampled::new(0.1, vec![0.0, 1.0, 1.0, 0.5]).unwrap();
    let (end, later) = (motion.at(motion.duration()), motion.at(motion.duration() + 3.0));
    assert_eq!(later.acceleration, 0.0);
    assert_eq!(later.velocity, end.velocity);
    assert!((later.displacement - end.displacement - 3.0 * end.velocity).abs() < 1e-15);
    assert_eq!(motion.at(-1.0), barrelstack_motion::Kinematics::default());
    assert_eq!(motion.at(f64::NAN), barrelstack_motion::Kinematics::default());
}

#[test]
fn froude_scaling_is_exact_for_every_history() {
    let sampled = Sampled::new(0.02, vec![0.0, 1.0, -0.5, 0.25, 0.0]).unwrap();
    let mut histories: Vec<History> = pulses().into_iter().map(History::Analytic).collect();
    histories.push(History::Sampled(sampled.clone()));
    histories.push(History::Sum(vec![
        Delayed { delay: 0.3, history: History::Sampled(sampled) },
        Delayed { delay: 0.0, history: History::Analytic(pulses()[6]) },
    ]));
    for history in histories {
        let model = GroundMotion::new("full", history.clone(), None).froude(0.25);
        for x in scattered(50) {
            let t = x * history.duration() * 1.1;
            let (full, half) = (history.at(t), model.horizontal.at(0.5 * t));
            assert!((half.acceleration - full.acceleration).abs() < 1e-9);
            assert!((half.velocity - 0.5 * full.velocity).abs() < 1e-10);
            assert!((half.displacement - 0.25 * full.displacement).abs() < 1e-11);
        }
    }
}

#[test]
fn scaling_reaches_its_target_and_moves_both_components_alike() {
    let h = Sampled::new(0.01, scattered(3000).map(|x| 4.0 * (x - 0.5)).collect()).unwrap();
    let v = h.scaled(0.5);
    let motion = GroundMotion::new("noise", History::Sampled(h), Some(History::Sampled(v)));
    let targets = [
        (IntensityMeasure::Pga, 3.0),
        (IntensityMeasure::Pgv, 0.6),
        (IntensityMeasure::Pgd, 0.1),
        (IntensityMeasure::Arias, 2.0),
        (IntensityMeasure::Cav, 9.0),
        (IntensityMeasure::CavStandardized, 9.0),
        (IntensityMeasure::Sa { period: 0.5, damping: 0.05 }, 5.0),
        (IntensityMeasure::Housner { damping: 0.05 }, 1.0),
    ];
    for (measure, target) in targets {
        let scaled = motion.scale_to(measure, target).unwrap();
        let reached = scaled.intensity(measure).unwrap();
        assert!((reached / target - 1.0).abs() < 1e-9, "{measure}: {reached}");
        let ratio = scaled.vertical.as_ref().unwrap().pga() / scaled.pga();
        assert!((ratio - 0.5).abs() < 1e-12);
        assert!(scaled.provenance.last().unwrap().contains("scaled by"));
    }
    let refused = motion.scale_to(IntensityMeasure::D5_95, 3.0).unwrap_err();
    assert!(refused.to_string().contains("does not change"), "{refused}");
}
