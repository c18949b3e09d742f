//! Intensity measures of motions with closed-form values.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use barrelstack_motion::{
    FourierSpectrum, Horizontals, IntensityMeasure, Pulse, STANDARD_GRAVITY, Sampled,
    dominant_pulse, response, rotated_peak, rotated_spectrum,
};

const TAU: f64 = std::f64::consts::TAU;

fn sine(amplitude: f64, period: f64, cycles: u32, per_cycle: u32) -> Sampled {
    let n = cycles * per_cycle;
    let a =
        (0..=n).map(|k| amplitude * (TAU * f64::from(k) / f64::from(per_cycle)).sin()).collect();
    Sampled::new(period / f64::from(per_cycle), a).unwrap()
}

#[test]
fn a_harmonic_has_its_closed_forms_to_a_millionth() {
    // A = 0.3 g, T = 0.5 s, 8 cycles: Arias 2.77371 m/s, CAV 7.49429 m/s, PGV 0.46839 m/s.
    let (a, t, n) = (0.3 * STANDARD_GRAVITY, 0.5, 8.0);
    let motion = sine(a, t, 8, 4000);
    let of = |measure: IntensityMeasure| measure.of(&motion).unwrap();
    let near = |value: f64, exact: f64| {
        assert!((value / exact - 1.0).abs() < 1e-6, "{value} against {exact}"); // measured 2e-7
    };
    let pi = std::f64::consts::PI;
    near(of(IntensityMeasure::Arias), pi / (2.0 * STANDARD_GRAVITY) * a * a * n * t / 2.0);
    // The published values are for g = 9.81 m/s²; all three are proportional to g.
    let printed = 9.81 / STANDARD_GRAVITY;
    assert!((of(IntensityMeasure::Arias) * printed - 2.773_71).abs() < 6e-6);
    assert!((of(IntensityMeasure::Cav) * printed - 7.494_29).abs() < 6e-6);
    assert!((of(IntensityMeasure::Pgv) * printed - 0.468_39).abs() < 6e-6);
    near(of(IntensityMeasure::Cav), 2.0 / pi * a * n * t);
    near(of(IntensityMeasure::Pgv), a * t / pi);
    near(of(IntensityMeasure::Pga), a);
    near(of(IntensityMeasure::Rms), a / 2.0_f64.sqrt());
    // |a| exceeds the threshold in every second, so the standardized CAV equals the CAV.
    near(of(IntensityMeasure::CavStandardized), 2.0 / pi * a * n * t);
    // The integral of a squared sine grows evenly, so 5 % to 95 % takes 90 % of the time, within a
    // ripple of a quarter period.
    assert!((of(IntensityMeasure::D5_95) - 0.9 * n * t).abs() < 0.25 * t);
    // The bracketed duration extends from the first to the last crossing of 0.05 g.
    let crossing = (1.0_f64 / 6.0).asin() / TAU * t;
    near(of(IntensityMeasure::BRACKETED), n * t - 2.0 * crossing);
    assert!((of(IntensityMeasure::MeanPeriod) / t - 1.0).abs() < 0.02); // measured 0.01
}

#[test]
fn the_spectrum_goes_to_pga_at_short_periods_and_to_pgd_at_long_ones() {
    let pulse = Pulse::Ricker { acceleration: 3.0, period: 0.5 };
    let motion = barrelstack_motion::History::Analytic(pulse).sampled(0.0005).unwrap();
    let at =
        |period: f64| response(motion.time_step(), motion.acceleration(), period, 0.05).unwrap();
    let pga = motion.pga();
    assert_eq!(at(0.0).pseudo_acceleration, pga);
    assert!((at(0.01).pseudo_acceleration / pga - 1.0).abs() < 1e-3); // measured 5.9e-4
    assert!((at(200.0).displacement / motion.pgd() - 1.0).abs() < 1e-3); // measured 4.6e-4
}

#[test]
fn the_recursion_is_the_exact_solution_of_a_ramp_at_any_step() {
    // Closed-form solution of u'' + 2 z w u' + w^2 u = -k t, starting from rest.
    for (period, damping) in [(0.5, 0.05), (3.0, 0.2), (1.0, 0.0), (0.05, 0.7)] {
        let w = TAU / period;
        let exact = |t: f64| {
            let wd = w * (1.0_f64 - damping * damping).sqrt();
            let (c1, k) = (2.0 * damping / (w * w * w), -1.0 / (w * w));
            let decay = (-damping * w * t).exp();
            let particular = k * t + c1;
            // Homogeneous part, so that u(0) = 0 and u'(0) = 0.
            let b = (-k - damping * w * c1) / wd;
            particular + decay * (-c1 * (wd * t).cos() + b * (wd * t).sin())
        };
        for step in [1e-4, 1e-2, 0.3] {
            let samples = 40;
            let a: Vec<f64> = (0..=samples).map(|n| f64::from(n) * step).collect();
            let peak = response(step, &a, period, damping).unwrap().displacement;
            let truth = (1..=samples).map(|n| exact(f64::from(n) * step).abs()).fold(0.0, f64::max);
            let off = (peak / truth - 1.0).abs();
            assert!(off < 1e-8, "T {period}, z {damping}, step {step}: {off:e}"); // measured 2e-10
        }
    }
}

#[test]
fn fourier_amplitudes_hold_the_energy() {
    let motion = sine(1.0, 0.5, 13, 50);
    let spectrum = FourierSpectrum::new(motion.time_step(), motion.acceleration());
    let df = spectrum.frequency[1];
    let in_frequency: f64 = 2.0
        * df
        * spectrum.amplitude[1..spectrum.amplitude.len() - 1].iter().map(|c| c * c).sum::<f64>()
        + df * spectrum.amplitude[0].powi(2)
        + df * spectrum.amplitude[spectrum.amplitude.len() - 1].powi(2);
    let in_time: f64 =
        motion.time_step() * motion.acceleration().iter().map(|a| a * a).sum::<f64>();
    assert!((in_frequency / in_time - 1.0).abs() < 1e-12); // measured 4e-16
}

#[test]
fn rotated_peaks_of_known_paths() {
    let circle = |k: i32| TAU * f64::from(k) / 7200.0;
    let x: Vec<f64> = (0..7200).map(|k| circle(k).cos()).collect();
    let y: Vec<f64> = (0..7200).map(|k| circle(k).sin()).collect();
    let round = rotated_peak(&x, &y);
    // Measured, here and below: at most 2.2e-16.
    assert!((round.median - 1.0).abs() < 1e-14 && (round.largest - 1.0).abs() < 1e-14);
    // For motion along a line at 30 degrees, the largest value is the amplitude; the median is its
    // projection at 45 degrees.
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    let x: Vec<f64> = (0..100).map(|k| c * (0.1 * f64::from(k)).sin()).collect();
    let y: Vec<f64> = (0..100).map(|k| s * (0.1 * f64::from(k)).sin()).collect();
    let line = rotated_peak(&x, &y);
    let amplitude = (0..100).map(|k| (0.1 * f64::from(k)).sin().abs()).fold(0.0, f64::max);
    assert!((line.largest - amplitude).abs() < 1e-14);
    assert_eq!(line.angle, 30.0);
    assert!((line.median / amplitude - 45.0_f64.to_radians().cos()).abs() < 1e-14);
    assert!(line.smallest < 1e-14 * amplitude);
}

#[test]
fn a_rotated_spectrum_lies_between_the_components_of_a_pair() {
    let one = sine(2.0, 0.4, 10, 40);
    let zero = vec![0.0; one.acceleration().len()];
    let periods = [0.0, 0.2, 0.4, 1.0];
    let rotated =
        rotated_spectrum(one.time_step(), one.acceleration(), &zero, &periods, 0.05).unwrap();
    for (period, peak) in periods.iter().zip(rotated) {
        let single = response(one.time_step(), one.acceleration(), *period, 0.05).unwrap();
        // Measured: 0, and 1.1e-16 of the ratio.
        assert!((peak.largest / single.pseudo_acceleration - 1.0).abs() < 1e-14);
        let ratio = peak.median / peak.largest;
        assert!((ratio - 0.5_f64.sqrt()).abs() < 1e-14, "{ratio}");
    }
}

#[test]
fn two_horizontals_are_scaled_to_any_measure_over_all_directions() {
    let one = sine(2.0, 0.4, 10, 40);
    let a: Vec<f64> = one
        .acceleration()
        .iter()
        .enumerate()
        .map(|(k, a)| 0.7 * a * (0.01 * k as f64).cos())
        .collect();
    let two = Sampled::new(one.time_step(), a).unwrap();
    for (measure, target) in [
        (IntensityMeasure::Pga, 3.0),
        (IntensityMeasure::Pgv, 0.4),
        (IntensityMeasure::Pgd, 0.05),
        (IntensityMeasure::Sa { period: 0.5, damping: 0.05 }, 6.0),
        (IntensityMeasure::Arias, 1.5),
        (IntensityMeasure::Cav, 6.0),
        (IntensityMeasure::CavStandardized, 6.0),
        (IntensityMeasure::Rms, 1.0),
    ] {
        for over in [Horizontals::RotD50, Horizontals::RotD100, Horizontals::GeometricMean] {
            let factor = over.scale_factor(measure, &one, &two, target).unwrap();
            let (first, second) = (one.scaled(factor), two.scaled(factor));
            let reached = over.of(measure, &first, &second).unwrap();
            assert!((reached / target - 1.0).abs() < 1e-9, "{over} {measure}: {reached}");
        }
        // The largest value exceeds the median and both components.
        let of = |over: Horizontals| over.of(measure, &one, &two).unwrap();
        assert!(of(Horizontals::RotD100) >= of(Horizontals::RotD50));
        let single = measure.of(&one).unwrap().max(measure.of(&two).unwrap());
        assert!(of(Horizontals::RotD100) >= single * (1.0 - 1e-12), "{measure}");
    }
    // If one component is at rest, the largest value is the measure of the other component.
    let still = one.scaled(0.0);
    for measure in [IntensityMeasure::Pga, IntensityMeasure::Pgv, IntensityMeasure::Pgd] {
        let largest = Horizontals::RotD100.of(measure, &one, &still).unwrap();
        assert_eq!(largest, measure.of(&one).unwrap(), "{measure}");
    }
    let time = Horizontals::RotD50.scale_factor(IntensityMeasure::D5_95, &one, &two, 3.0);
    assert!(time.unwrap_err().to_string().contains("does not change"));
    // Rotated Arias intensities have a closed form: their median is the value at 45 degrees from
    // the axes.
    let arias = |m: &Sampled| IntensityMeasure::Arias.of(m).unwrap();
    let mean = 0.5 * (arias(&one) + arias(&two));
    let median = Horizontals::RotD50.of(IntensityMeasure::Arias, &one, &two).unwrap();
    assert!((median / mean - 1.0).abs() < 1e-3, "{median} {mean}"); // measured 1e-5
}

#[test]
fn a_pulse_is_found_in_noise_with_its_period_and_amplitude() {
    for (period, gamma, phase, start) in
        [(1.2, 1.6, 0.5, 3.0), (2.5, 2.0, -1.0, 4.0), (0.8, 2.6, 2.0, 6.5)]
    {
        let pulse = Pulse::MavroeidisPapageorgiou { velocity: 0.9, period, gamma, phase };
        let noise = |t: f64| 0.6 * (TAU * 5.3 * t).sin() + 0.5 * (TAU * 8.7 * t + 1.0).cos();
        let a: Vec<f64> = (0..4000)
            .map(|k| {
                let t = f64::from(k) * 0.005;
                pulse.at(t - start).acceleration + noise(t)
            })
            .collect();
        let motion = Sampled::new(0.005, a).unwrap();
        let fit = dominant_pulse(&motion, 0.4, 6.0).unwrap();
        println!("{fit:?}");
        // Measured: period 0.8 %, amplitude 1.3 %, start 1.4 % of a period, share 0.98 and more.
        assert!((fit.period / period - 1.0).abs() < 0.015, "{period}: {fit:?}");
        assert!((fit.amplitude / 0.9 - 1.0).abs() < 0.025, "{fit:?}");
        assert!((fit.start - start).abs() < 0.03 * period, "{fit:?}");
        assert!(fit.energy_share > 0.95 && fit.energy_share <= 1.0, "{fit:?}");
    }
    let still = Sampled::new(0.01, vec![0.0; 100]).unwrap();
    assert!(dominant_pulse(&still, 0.5, 5.0).is_err());
}

#[test]
fn measures_print_and_parse_alike() {
    for text in [
        "pga",
        "pgv",
        "pgd",
        "pgv/pga",
        "arias",
        "cav",
        "cav-std",
        "d5-95",
        "d5-75",
        "rms",
        "housner(0.2)",
        "asi",
        "vsi",
        "tm",
        "fajfar",
        "sa(1,0.05)",
        "sa(0.35,0.02)",
        "bracketed(0.5)",
    ] {
        let measure: IntensityMeasure = text.parse().unwrap();
        assert_eq!(measure.to_string(), text);
    }
    assert_eq!(
        "SA(2.0)".parse::<IntensityMeasure>().unwrap(),
        IntensityMeasure::Sa { period: 2.0, damping: 0.05 }
    );
    for text in ["", "pgx", "sa(-1)", "sa(1,2)", "d95-5", "sa(1", "dx-y"] {
        assert!(text.parse::<IntensityMeasure>().is_err(), "{text}");
    }
}
