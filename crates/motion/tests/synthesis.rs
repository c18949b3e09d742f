//! Synthetic motions: equal seeds give equal bits, ensembles meet their target on average, motions
//! do not drift.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use barrelstack_motion::{
    BooreSource, CloughPenzien, Envelope, FourierSpectrum, GroundMotion, NearFault, Pulse, Random,
};

const SEEDS: u64 = 200;

#[test]
fn the_generator_has_its_published_first_numbers() {
    // xoshiro256++ from splitmix64(0).
    let mut random = Random::new(0);
    let first: Vec<u64> = (0..3).map(|_| random.bits()).collect();
    assert_eq!(
        first,
        [5_987_356_902_031_041_503, 7_051_070_477_665_621_255, 6_633_766_593_972_829_180]
    );
    let n = 200_000;
    let mut random = Random::new(1);
    let draws: Vec<f64> = (0..n).map(|_| random.normal()).collect();
    let mean = draws.iter().sum::<f64>() / f64::from(n);
    let variance = draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(n);
    // Measured: 3.2e-4 and 2.0e-3; one standard error is 2.2e-3 and 3.2e-3.
    assert!(mean.abs() < 5e-3 && (variance - 1.0).abs() < 8e-3);
}

#[test]
fn stationary_noise_has_its_density_in_the_mean() {
    let soil = CloughPenzien::medium(1.5);
    let (dt, duration) = (0.02, 40.94);
    // The bands are wide enough for averaging; the mean squared amplitudes are compared.
    let bands = [(0.3, 0.8), (0.8, 1.5), (1.5, 2.5), (2.5, 5.0), (5.0, 12.0)];
    let mut measured = [0.0; 5];
    let mut variance = 0.0;
    for seed in 0..SEEDS {
        let a = soil.acceleration(&Envelope::Flat, duration, dt, seed).unwrap();
        variance += a.iter().map(|a| a * a).sum::<f64>() / a.len() as f64 / SEEDS as f64;
        let spectrum = FourierSpectrum::new(dt, &a);
        for ((low, high), sum) in bands.iter().zip(&mut measured) {
            let inside: Vec<f64> = spectrum
                .frequency
                .iter()
                .zip(&spectrum.amplitude)
                .filter(|(f, _)| (*low..*high).contains(*f))
                .map(|(_, c)| c * c)
                .collect();
            *sum += inside.iter().sum::<f64>() / inside.len() as f64 / SEEDS as f64;
        }
    }
    assert!((variance / 2.25 - 1.0).abs() < 0.01, "{variance}"); // measured 0.002
    for ((low, high), measured) in bands.iter().zip(measured) {
        // |A|² = 2π S T for two-sided S in rad/s, averaged over the band.
        let steps = 2000;
        let expected: f64 = (0..steps)
            .map(|k| {
                let f = low + (high - low) * (f64::from(k) + 0.5) / f64::from(steps);
                let w = std::f64::consts::TAU * f;
                std::f64::consts::TAU * soil.density(w, dt) * (duration + dt)
            })
            .sum::<f64>()
            / f64::from(steps);
        assert!(
            (measured / expected - 1.0).abs() < 0.01, // measured 0.0024
            "{low} to {high} Hz: {measured} {expected}"
        );
    }
}

#[test]
fn the_stochastic_method_meets_its_source_spectrum_in_the_mean() {
    let source = BooreSource::western(6.5, 15.0);
    let dt = 0.01;
    let bands = [(0.1, 0.3), (0.3, 1.0), (1.0, 3.0), (3.0, 10.0), (10.0, 25.0)];
    let mut sums = [0.0; 5];
    let mut counts = [0.0; 5];
    for seed in 0..SEEDS {
        let spectrum = FourierSpectrum::new(dt, &source.acceleration(dt, seed).unwrap());
        for (f, c) in spectrum.frequency.iter().zip(&spectrum.amplitude) {
            for (k, (low, high)) in bands.iter().enumerate() {
                if (*low..*high).contains(f) {
                    sums[k] += (c / source.fourier_amplitude(*f)).powi(2);
                    counts[k] += 1.0;
                }
            }
        }
    }
    for ((low, high), (sum, count)) in bands.iter().zip(sums.iter().zip(counts)) {
        let ratio = (sum / count).sqrt();
        println!("{low} to {high} Hz: {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.03, "{low} to {high} Hz: {ratio}"); // measured 0.011
    }
}

fn comes_to_rest(motion: &GroundMotion) {
    let end = motion.horizontal.at(motion.horizontal.duration());
    assert!(end.velocity.abs() < 1e-3 * motion.pgv(), "{}", motion.name);
    assert!(end.displacement.abs() < 1e-2 * motion.pgd(), "{}", motion.name);
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_does_not() {
    let soil = CloughPenzien::firm(2.0);
    let envelope = Envelope::SaragoniHart { peak: 4.0, exponent: 2.0 };
    let make = |seed| soil.motion(&envelope, 20.0, 0.01, seed).unwrap();
    assert_eq!(make(3), make(3));
    assert_ne!(make(3).horizontal, make(4).horizontal);
    comes_to_rest(&make(3));
    let source = BooreSource::western(6.0, 20.0);
    let make = |seed| source.motion(0.01, seed).unwrap();
    assert_eq!(make(5), make(5));
    assert_ne!(make(5).horizontal, make(6).horizontal);
    comes_to_rest(&make(5));
    assert!(make(5).provenance[0].contains("seed 5"));
}

#[test]
fn bits_are_those_of_every_platform() {
    // A hash of the bits, equal on every machine because all functions are part of the crate.
    let hash = |motion: &GroundMotion| {
        (0..2000).fold(0xcbf2_9ce4_8422_2325_u64, |hash, k| {
            let bits = motion.horizontal.at(f64::from(k) * 0.01).acceleration.to_bits();
            (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3)
        })
    };
    let soil = CloughPenzien::firm(2.0);
    let envelope = Envelope::Jennings { rise: 2.0, decay_start: 8.0, decay: 0.3 };
    let cp = hash(&soil.motion(&envelope, 20.0, 0.01, 1).unwrap());
    let boore = hash(&BooreSource::western(6.0, 20.0).motion(0.01, 1).unwrap());
    println!("{cp:#x} {boore:#x}");
    assert_eq!((cp, boore), (GOLDEN_CLOUGH_PENZIEN, GOLDEN_BOORE));
}

const GOLDEN_CLOUGH_PENZIEN: u64 = 0xe423_dd11_543b_2e66;
const GOLDEN_BOORE: u64 = 0x77ec_c6af_84c8_de1a;

#[test]
fn a_larger_and_closer_source_shakes_harder() {
    let pga = |magnitude: f64, distance: f64| {
        (0..20)
            .map(|seed| BooreSource::western(magnitude, distance).motion(0.01, seed).unwrap().pga())
            .sum::<f64>()
            / 20.0
    };
    let (strong, weak, far) = (pga(7.0, 10.0), pga(5.0, 10.0), pga(7.0, 100.0));
    println!("M7 at 10 km {strong:.2} m/s2, M5 at 10 km {weak:.2}, M7 at 100 km {far:.2}");
    assert!(strong > 1.5 * weak && strong > 5.0 * far);
    // Estimate by random vibration: the flat part of the spectrum, C M0 (2π f0)²/R = 0.72 m/s,
    // limited by κ = 0.04 s over a duration of 10.5 s, has an rms of 0.63 m/s²; the peak is about
    // three times the rms.
    assert!((1.4..2.6).contains(&strong), "{strong}");
}

#[test]
fn a_near_fault_motion_holds_its_pulse() {
    let pulse = Pulse::MavroeidisPapageorgiou {
        velocity: 1.0,
        period: 2.0,
        gamma: 2.0,
        phase: std::f64::consts::FRAC_PI_2,
    };
    let recipe =
        NearFault { pulse, start: 3.0, rest: BooreSource::western(6.5, 8.0), crossover: 1.0 };
    let motion = recipe.motion(0.01, 9).unwrap();
    assert_eq!(motion, recipe.motion(0.01, 9).unwrap());
    comes_to_rest(&motion);
    let sampled = motion.horizontal.sampled(0.01).unwrap();
    let fit = barrelstack_motion::dominant_pulse(&sampled, 0.5, 6.0).unwrap();
    assert!((fit.period / 2.0 - 1.0).abs() < 0.01, "{fit:?}"); // measured 0.0016
    assert!((fit.amplitude - 1.0).abs() < 0.05, "{fit:?}"); // measured 0.026
}

#[test]
fn parameters_out_of_range_are_refused() {
    let soil = CloughPenzien::firm(2.0);
    assert!(soil.acceleration(&Envelope::Flat, 10.0, 0.0, 1).is_err());
    assert!(soil.acceleration(&Envelope::Flat, 1e9, 0.01, 1).is_err());
    assert!(CloughPenzien::firm(-1.0).acceleration(&Envelope::Flat, 10.0, 0.01, 1).is_err());
    assert!(BooreSource::western(12.0, 10.0).acceleration(0.01, 1).is_err());
    assert!(BooreSource::western(6.0, 0.0).acceleration(0.01, 1).is_err());
    assert!(
        GroundMotion::from_pulse("x", Pulse::OneSine { acceleration: 1.0, period: 0.0 }).is_err()
    );
}

#[test]
fn provenance_says_how_a_motion_was_made_in_words_and_units() {
    let pulse = Pulse::Ricker { acceleration: 2.0, period: 0.5 };
    let closed = GroundMotion::from_pulse("pulse", pulse).unwrap();
    assert_eq!(closed.provenance, ["closed form: Ricker wavelet of 2 m/s2 and period 0.5 s"]);
    let envelope = Envelope::Jennings { rise: 2.0, decay_start: 8.0, decay: 0.5 };
    let noise = CloughPenzien::firm(1.5).motion(&envelope, 15.0, 0.01, 7).unwrap();
    assert_eq!(
        noise.provenance[0],
        "Clough-Penzien noise: 1.5 m/s2 rms, ground of 15 rad/s and damping ratio 0.6, high-pass of \
         1.5 rad/s and damping ratio 0.6, rising over 2 s and decaying from 8 s at 0.5 1/s \
         (Jennings), 15 s long, seed 7"
    );
    let rest = BooreSource::western(6.0, 20.0);
    let fault = NearFault { pulse, start: 1.0, rest, crossover: 1.2 };
    assert_eq!(
        fault.motion(0.01, 3).unwrap().provenance[0],
        "near-fault motion: Ricker wavelet of 2 m/s2 and period 0.5 s from 1 s on, plus the \
         stochastic method above 1.2 times the pulse frequency: magnitude 6 at 20 km, stress \
         parameter 70 bar, 3.5 km/s and 2.8 g/cm3 at the source, Q = 180 f^0.45, kappa 0.04 s, no \
         site amplification, seed 3"
    );
}
