//! Matched motions follow their target and end at rest; target spectra have the values of their
//! codes.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use barrelstack_motion::{
    ChileanZone, Component, GroundMotion, History, MatchMethod, Matching, NCh2745Soil, Processing,
    STANDARD_GRAVITY, SiteClass, TargetSpectrum, bundled, response,
};

/// Returns every second sample of the first 20 s of the bundled record, to keep the tests quick.
fn napa() -> GroundMotion {
    let mut record = bundled("napa-college-2014").unwrap();
    for channel in &mut record.channels {
        channel.time_step *= 2.0;
        channel.acceleration = channel.acceleration.iter().take(4000).step_by(2).copied().collect();
    }
    record
        .ground_motion(&Component::Horizontal1, Some(&Component::Vertical), &Processing::compact())
        .unwrap()
}

fn asce() -> TargetSpectrum {
    TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping: 0.05 }
}

fn nch2745() -> TargetSpectrum {
    TargetSpectrum::NCh2745 { zone: ChileanZone::Two, soil: NCh2745Soil::II, damping: 0.05 }
}

/// Returns the largest misfit on an independent grid of 1000 periods per decade.
fn misfit(motion: &GroundMotion, target: &TargetSpectrum) -> f64 {
    let History::Sampled(sampled) = &motion.horizontal else {
        panic!("a matched motion is sampled")
    };
    (0..=1477)
        .map(|k| {
            let period = 0.1 * 30.0_f64.powf(f64::from(k) / 1477.0);
            let peaks =
                response(sampled.time_step(), sampled.acceleration(), period, 0.05).unwrap();
            (peaks.pseudo_acceleration / target.acceleration(period) - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

/// Checks that each method meets the target within 5 % and leaves a motion that ends at rest.
fn both_methods_meet(target: &TargetSpectrum) {
    let start = napa();
    for method in [MatchMethod::Frequency, MatchMethod::Time] {
        let settings = Matching { method, ..Matching::default() };
        let matched = start.match_spectrum(target, &settings).unwrap();
        let between = misfit(&matched.motion, target);
        println!("{method:?} {target}: {:.4} at its periods, {between:.4} between", matched.misfit);
        assert!(matched.misfit <= 0.05 && between <= 0.05, "{method:?} {target}: {between}");
        let motion = &matched.motion;
        let end = motion.horizontal.at(motion.horizontal.duration());
        // Measured 5e-16 and 3e-14 at most.
        assert!(end.velocity.abs() < 1e-12 * motion.pgv());
        assert!(end.displacement.abs() < 1e-10 * motion.pgd());
        let step = motion.provenance.last().unwrap();
        assert!(step.contains(&format!("matched in {} to {target}", matched.domain())), "{step}");
        assert!(motion.vertical.is_some());
    }
}

// The largest measured misfits in frequency and in time follow each target.

#[test]
fn both_methods_meet_asce_7() {
    both_methods_meet(&asce()); // 0.0450 and 0.0480
}

#[test]
fn both_methods_meet_eurocode_8() {
    // 0.0436 and 0.0470
    both_methods_meet(&TargetSpectrum::Eurocode8 {
        ground_acceleration: 0.3,
        site: SiteClass::B,
        small_magnitude: false,
        damping: 0.05,
    });
}

#[test]
fn both_methods_meet_nch433() {
    // 0.0455 and 0.0351
    both_methods_meet(&TargetSpectrum::NCh433 { zone: ChileanZone::Three, site: SiteClass::D });
}

#[test]
fn both_methods_meet_nch2745() {
    both_methods_meet(&nch2745()); // 0.0419 and 0.0424
}

#[test]
fn both_methods_meet_nzs_1170() {
    // 0.0427 and 0.0337
    both_methods_meet(&TargetSpectrum::Nzs1170 {
        hazard: 0.4,
        return_period: 1.0,
        site: SiteClass::C,
        fault_distance: None,
    });
}

#[test]
fn both_methods_meet_ac156() {
    // 0.0445 and 0.0371
    both_methods_meet(&TargetSpectrum::Ac156 { sds: 0.8, height_ratio: 0.5 });
}

#[test]
fn where_wavelets_stall_the_frequency_domain_begins_and_says_so() {
    // Wavelets alone no longer converge within few rounds at some tolerance; measured at 0.045.
    let stalled = (0..8).find_map(|k| {
        let tolerance = 0.05 - 0.0025 * f64::from(k);
        let settings = Matching { tolerance, rounds: 20, ..Matching::default() };
        let matched = napa().match_spectrum(&nch2745(), &settings).ok()?;
        (matched.first == MatchMethod::Frequency).then_some(matched)
    });
    let matched = stalled.unwrap();
    assert_eq!(matched.chosen, MatchMethod::Time);
    assert!(matched.misfit <= 0.05);
    let step = matched.motion.provenance.last().unwrap();
    assert!(
        step.contains("the frequency domain, because matching in the time domain made no further progress, to NCh2745 \
        (zone 2")
    );
}

#[test]
fn a_table_is_matched_like_a_code() {
    let table: Vec<(f64, f64)> =
        [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0].iter().map(|t| (*t, 6.0 / (1.0 + 3.0 * t))).collect();
    let target = TargetSpectrum::Table { points: table, damping: 0.05 };
    let matched = napa().match_spectrum(&target, &Matching::default()).unwrap();
    assert!(matched.misfit <= 0.05); // measured 0.0498
}

#[test]
fn impossible_matches_are_refused_in_words() {
    let motion = napa();
    let target = &asce();
    let short = Matching { shortest: 0.001, ..Matching::default() };
    assert!(motion.match_spectrum(target, &short).unwrap_err().to_string().contains("four steps"));
    let hopeless = Matching { tolerance: 1e-6, rounds: 2, ..Matching::default() };
    let error = motion.match_spectrum(target, &hopeless).unwrap_err().to_string();
    assert!(error.contains("misfit"), "{error}");
    // The message must not list a page of periods.
    assert!(error.contains(" other ranges") && error.len() < 500, "{error}");
    let bad = TargetSpectrum::Table { points: vec![(1.0, 1.0), (0.5, 1.0)], damping: 0.05 };
    assert!(motion.match_spectrum(&bad, &Matching::default()).is_err());
}

#[test]
fn code_spectra_have_their_published_ordinates() {
    let g = STANDARD_GRAVITY;
    let near = |value: f64, expected: f64| {
        assert!((value / expected - 1.0).abs() < 2e-3, "{value} against {expected}");
    };
    let asce = TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping: 0.05 };
    for (t, a) in [(0.0, 0.4), (0.06, 0.7), (0.3, 1.0), (1.2, 0.5), (16.0, 0.6 * 8.0 / 256.0)] {
        near(asce.acceleration(t), a * g);
    }
    let ec8 = TargetSpectrum::Eurocode8 {
        ground_acceleration: 0.2,
        site: SiteClass::C,
        small_magnitude: false,
        damping: 0.05,
    };
    for (t, a) in [(0.0, 0.23), (0.4, 0.575), (1.2, 0.2875), (4.0, 0.575 * 0.6 * 2.0 / 16.0)] {
        near(ec8.acceleration(t), a * g);
    }
    // alpha(T0) = (1 + 4.5)/2.
    let nch = TargetSpectrum::NCh433 { zone: ChileanZone::Three, site: SiteClass::D };
    near(nch.acceleration(0.75), 1.2 * 0.4 * 2.75 * g);
    near(nch.acceleration(0.0), 1.2 * 0.4 * g);
    // The branches meet within the rounding of the plateaus in the code.
    for soil in [NCh2745Soil::I, NCh2745Soil::II, NCh2745Soil::III] {
        let spectrum = TargetSpectrum::NCh2745 { zone: ChileanZone::Two, soil, damping: 0.05 };
        let mut previous = spectrum.acceleration(0.01);
        for k in 1..4000 {
            let here = spectrum.acceleration(0.01 + 0.001 * f64::from(k));
            assert!((here / previous - 1.0).abs() < 0.03); // measured 0.022, where branches meet
            previous = here;
        }
    }
    near(
        TargetSpectrum::NCh2745 { zone: ChileanZone::Three, soil: NCh2745Soil::II, damping: 0.05 }
            .acceleration(0.3),
        1.25 * 11.0,
    );
    let nzs = |site, t| {
        TargetSpectrum::Nzs1170 { hazard: 0.5, return_period: 1.0, site, fault_distance: None }
            .acceleration(t)
            / (0.5 * g)
    };
    for (site, t, shape) in [
        (SiteClass::B, 0.5, 1.60),
        (SiteClass::B, 2.0, 0.53),
        (SiteClass::C, 0.2, 2.93),
        (SiteClass::C, 1.0, 1.19),
        (SiteClass::C, 4.0, 0.25),
        (SiteClass::D, 0.56, 3.0),
        (SiteClass::D, 1.5, 1.43),
        (SiteClass::E, 1.5, 2.21),
    ] {
        // Measured: 0.0121, because the printed table is rounded and its formula is not.
        assert!((nzs(site, t) - shape).abs() < 0.013, "{site:?} {t}: {}", nzs(site, t));
    }
    let near_fault = |return_period: f64, t: f64| {
        let distance = Some(2.0);
        let (hazard, site) = (0.3, SiteClass::C);
        TargetSpectrum::Nzs1170 { hazard, return_period, site, fault_distance: distance }
            .acceleration(t)
            / g
    };
    near(near_fault(1.0, 4.0), 0.3 * 3.96 / 16.0 * 1.6);
    near(near_fault(0.5, 4.0), 0.3 * 0.5 * 3.96 / 16.0);
    // Z R is limited to 0.7.
    near(near_fault(3.0, 1.0), 0.7 * 2.0 * 0.5_f64.powf(0.75));
    let ac = TargetSpectrum::Ac156 { sds: 1.0, height_ratio: 1.0 };
    for (f, a) in [(0.1, 0.16), (1.3, 1.6), (8.3, 1.6), (33.3, 1.2), (50.0, 1.2)] {
        near(ac.acceleration(1.0 / f), a * g);
    }
    let ground = TargetSpectrum::Ac156 { sds: 1.0, height_ratio: 0.0 };
    near(ground.acceleration(0.2), g);
    near(ground.acceleration(0.01), 0.4 * g);
}

#[test]
fn damping_changes_the_spectra_of_the_codes_that_say_how() {
    let g = STANDARD_GRAVITY;
    let near = |value: f64, expected: f64| {
        assert!((value / expected - 1.0).abs() < 1e-9, "{value} against {expected}");
    };
    let asce = |damping| TargetSpectrum::Asce7 { sds: 1.0, sd1: 0.6, long_period: 8.0, damping };
    for (damping, factor) in [(0.02, 0.8), (0.05, 1.0), (0.15, 1.35), (0.3, 1.7), (0.5, 2.0)] {
        near(asce(damping).acceleration(0.0), 0.4 * g);
        near(asce(damping).acceleration(0.5), g / factor);
        near(asce(damping).acceleration(2.0), 0.3 * g / factor);
        assert_eq!(asce(damping).damping(), damping);
    }
    let ec8 = |damping| TargetSpectrum::Eurocode8 {
        ground_acceleration: 0.2,
        site: SiteClass::C,
        small_magnitude: true,
        damping,
    };
    near(ec8(0.1).acceleration(0.2), 0.2 * 1.5 * 2.5 * (10.0_f64 / 15.0).sqrt() * g);
    near(ec8(0.9).acceleration(0.2), 0.2 * 1.5 * 2.5 * 0.55 * g);
    let nch = |soil, damping| TargetSpectrum::NCh2745 { zone: ChileanZone::Two, soil, damping };
    near(nch(NCh2745Soil::I, 0.05).acceleration(0.01), 0.40 * g);
    near(nch(NCh2745Soil::III, 0.05).acceleration(0.01), 0.45 * g);
    near(nch(NCh2745Soil::II, 0.05).acceleration(0.115), 0.5 * (0.41 * g + 11.0));
    near(nch(NCh2745Soil::II, 0.10).acceleration(0.3), 11.0 / 1.37);
    near(nch(NCh2745Soil::II, 0.02).acceleration(0.3), 11.0 / 0.65);
    for target in [asce(0.01), asce(0.6), ec8(1.0), nch(NCh2745Soil::I, f64::NAN)] {
        assert!(target.check().unwrap_err().to_string().contains("damping ratio"), "{target:?}");
    }
}

#[test]
fn a_motion_is_matched_at_the_damping_of_its_target() {
    let target = TargetSpectrum::Asce7 { sds: 0.8, sd1: 0.5, long_period: 8.0, damping: 0.1 };
    let matched = napa().match_spectrum(&target, &Matching::default()).unwrap();
    let History::Sampled(sampled) = &matched.motion.horizontal else { panic!("not sampled") };
    for period in [0.15, 0.4, 0.9, 2.2] {
        let peaks = response(sampled.time_step(), sampled.acceleration(), period, 0.1).unwrap();
        let off = peaks.pseudo_acceleration / target.acceleration(period) - 1.0;
        assert!(off.abs() <= 0.05, "{period} s: {off}"); // measured 0.008 at most
    }
}
