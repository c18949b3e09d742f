//! Two components matched together: their response over all directions follows the target on an
//! independent grid of periods.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use barrelstack_motion::{
    Horizontals, Matching, Record, TargetSpectrum, bundled, rotated_spectrum,
};

/// Returns every second sample of the first 20 s of the bundled record, to keep the tests quick.
fn napa() -> Record {
    let mut record = bundled("napa-college-2014").unwrap();
    for channel in &mut record.channels {
        channel.time_step *= 2.0;
        channel.acceleration = channel.acceleration.iter().take(4000).step_by(2).copied().collect();
    }
    record
}

fn asce() -> TargetSpectrum {
    TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping: 0.05 }
}

/// Returns the largest misfit on an independent grid of 200 periods per decade.
fn misfit(record: &Record, measure: Horizontals, target: &TargetSpectrum) -> f64 {
    let (one, two) = record.horizontal_pair().unwrap();
    let periods: Vec<f64> =
        (0..295).map(|k| 0.1 * 30.0_f64.powf((f64::from(k) + 0.5) / 295.0)).collect();
    let spectrum =
        rotated_spectrum(one.time_step, &one.acceleration, &two.acceleration, &periods, 0.05)
            .unwrap();
    let of = |peak: &barrelstack_motion::RotatedPeak| match measure {
        Horizontals::RotD100 => peak.largest,
        Horizontals::RotD50 | Horizontals::GeometricMean => peak.median,
    };
    let each = spectrum.iter().zip(&periods);
    each.map(|(peak, period)| (of(peak) / target.acceleration(*period) - 1.0).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_response_over_directions_follows_the_target() {
    let record = napa();
    let settings = Matching::default();
    for measure in [Horizontals::RotD100, Horizontals::RotD50] {
        let (after, matched) =
            record.matched_pair(measure, &asce(), "asce7", &settings, true).unwrap();
        let between = misfit(&after, measure, &asce());
        let before = misfit(&record, measure, &asce());
        println!(
            "{measure}: {before:.3} before, {:.4} after {} rounds, {between:.4} between",
            matched.misfit, matched.rounds
        );
        assert!(matched.missed.is_empty() && between <= settings.tolerance, "{measure}: {between}");
    }
}

#[test]
fn both_components_end_at_rest() {
    let record = napa();
    let settings = Matching { tolerance: 0.1, ..Matching::default() };
    let (after, _) =
        record.matched_pair(Horizontals::RotD100, &asce(), "asce7", &settings, false).unwrap();
    for channel in after.channels.iter().filter(|channel| !channel.is_vertical()) {
        let motion = channel.sampled().unwrap();
        let end = motion.velocity().last().unwrap();
        let peak = motion.velocity().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(end.abs() < 1e-12 * peak, "{}: {end}", channel.name);
    }
    assert!(after.notes.iter().any(|note| note.contains("matched together, rotd100")));
    assert!(after.notes.iter().any(|note| note.contains("all other components scaled")));
}

#[test]
fn a_pair_that_cannot_be_matched_is_refused() {
    let record = napa();
    let settings = Matching { tolerance: 0.001, rounds: 2, ..Matching::default() };
    let matched = |record: &Record, measure, settings: &Matching| {
        record.matched_pair(measure, &asce(), "asce7", settings, false).unwrap_err().to_string()
    };
    let error = matched(&record, Horizontals::RotD100, &settings);
    assert!(error.contains("spectral matching") && error.contains("0.1 %"), "{error}");
    let error = matched(&record, Horizontals::GeometricMean, &Matching::default());
    assert!(error.contains("rotd50 or rotd100"), "{error}");
    let mut one = record.clone();
    one.channels.truncate(1);
    let error = matched(&one, Horizontals::RotD50, &Matching::default());
    assert!(error.contains("two horizontal components"), "{error}");
    let mut still = record;
    for channel in &mut still.channels {
        channel.acceleration.fill(0.0);
    }
    let error = matched(&still, Horizontals::RotD50, &Matching::default());
    assert!(error.contains("response spectrum"), "{error}");
}
