//! From records to motions: processing, selection, rotation, joining, and the bundled record.

#![allow(clippy::print_stdout, reason = "a test fails by unwrap and reports by print")]

use std::fmt::Write as _;

use crate::consistency::derivatives_of_one_another;
use barrelstack_motion::{
    Channel, Component, Direction, History, MeanRemoval, Pads, Processing, ReadOptions, Record,
    STANDARD_GRAVITY, Sampled, Stage, bundled, read,
};

fn sampled(history: &History) -> &Sampled {
    match history {
        History::Sampled(sampled) => sampled,
        History::Analytic(_) | History::Sum(_) => panic!("a record's motion is sampled"),
    }
}

/// A record in this crate's text format with two horizontals and a vertical.
fn example(azimuths: (f64, f64), samples: usize) -> Record {
    let mut text = format!(
        "# barrelstack motion 1\n# stage: raw\n# unit: m/s2\n# time_step: 0.01\n\
         # channels: one az={}, two az={}, three vertical\n",
        azimuths.0, azimuths.1
    );
    for k in 0..samples {
        let t = k as f64 * 0.01;
        let envelope = (t / 4.0) * (1.0 - t / 4.0).exp();
        let (n, e) = (
            envelope * (7.0 * t).sin() + 0.3 * envelope * (31.0 * t).cos(),
            envelope * (5.0 * t).cos() - 0.2 * envelope * (43.0 * t).sin(),
        );
        let along = |azimuth: f64| {
            let (s, c) = azimuth.to_radians().sin_cos();
            n * c + e * s
        };
        writeln!(
            text,
            "{:.12e} {:.12e} {:.12e}",
            along(azimuths.0) + 0.05,
            along(azimuths.1) - 0.02,
            0.5 * n
        )
        .unwrap();
    }
    read(text.as_bytes(), "example.txt", &ReadOptions::default()).unwrap()
}

#[test]
fn rotation_recovers_any_azimuth_from_oblique_horizontals() {
    let truth = example((30.0, 115.0), 2000);
    let given = example((0.0, 90.0), 2000);
    let wanted = &truth.channels[0].acceleration;
    let rotated = given.component(&Component::Azimuth(30.0)).unwrap();
    // The offsets of the two sets differ, so the means are removed.
    let mean = |a: &[f64]| a.iter().sum::<f64>() / a.len() as f64;
    let (m1, m2) = (mean(wanted), mean(&rotated.acceleration));
    for (a, b) in wanted.iter().zip(&rotated.acceleration) {
        assert!((a - m1 - (b - m2)).abs() < 1e-10); // measured 2e-12
    }
    let back = truth.component(&Component::Azimuth(115.0)).unwrap();
    assert_eq!(back.acceleration, truth.channels[1].acceleration);
    let opposite = given.component(&Component::Azimuth(180.0)).unwrap();
    for (a, b) in opposite.acceleration.iter().zip(&given.channels[0].acceleration) {
        assert!((a + b).abs() < 1e-14); // measured 2.2e-16
    }
}

#[test]
fn components_are_chosen_by_role_number_name_and_azimuth() {
    let record = example((10.0, 100.0), 100);
    let name = |text: &str| record.component(&text.parse().unwrap()).map(|channel| channel.name);
    assert_eq!(name("h1").unwrap(), "one");
    assert_eq!(name("h2").unwrap(), "two");
    assert_eq!(name("vertical").unwrap(), "three");
    assert_eq!(name("#2").unwrap(), "two");
    assert_eq!(name("THREE").unwrap(), "three");
    assert_eq!(name("az:100").unwrap(), "two");
    let error = name("four").unwrap_err().to_string();
    assert!(error.contains("\"one\", \"two\", \"three\""), "{error}");
    assert!("az:x".parse::<Component>().is_err() && "#0".parse::<Component>().is_err());
}

#[test]
fn a_raw_record_comes_to_rest_and_every_step_is_listed() {
    let record = example((0.0, 90.0), 4000);
    let motion = record.default_motion().unwrap();
    for history in [&motion.horizontal, motion.vertical.as_ref().unwrap()] {
        let motion = sampled(history);
        let end = motion.at(motion.duration());
        assert!(end.velocity.abs() < 1e-3 * motion.pgv()); // measured 1e-15
        assert!(end.displacement.abs() < 1e-2 * motion.pgd()); // measured 1e-14
    }
    let steps = motion.provenance.join("\n");
    for word in ["mean", "taper", "high-pass", "padding", "brought to zero", "ends with"] {
        assert!(steps.contains(word), "{word} is missing in\n{steps}");
    }
}

#[test]
fn an_unprocessed_record_is_the_record_itself() {
    let record = example((0.0, 90.0), 500);
    let motion = record.ground_motion(&Component::Horizontal1, None, &Processing::none()).unwrap();
    assert_eq!(sampled(&motion.horizontal).acceleration(), record.channels[0].acceleration);
    assert!(motion.provenance.iter().any(|step| step.contains("raw record used without")));
}

#[test]
fn removed_pads_leave_the_length_and_the_rest_at_the_end() {
    let record = example((0.0, 90.0), 4000);
    let chain = Processing { pads: Pads::Removed, ..Processing::raw() };
    let motion = record.ground_motion(&Component::Horizontal1, None, &chain).unwrap();
    let motion = sampled(&motion.horizontal);
    assert_eq!(motion.acceleration().len(), 4000);
    let end = motion.at(motion.duration());
    assert!(end.velocity.abs() < 1e-3 * motion.pgv());
    assert!(end.displacement.abs() < 1e-2 * motion.pgd());
}

#[test]
fn the_high_pass_has_the_gain_of_a_butterworth_applied_twice() {
    // A long sine burst well inside the record, with frequencies at and around the corner.
    let dt = 0.02;
    let n: u32 = 20_000;
    for (ratio, gain) in [(0.5, 1.0 / 257.0), (1.0, 0.5), (2.0, 256.0 / 257.0), (8.0, 1.0)] {
        let f = 0.1 * ratio;
        let a: Vec<f64> = (0..n)
            .map(|k| {
                let t = f64::from(k) * dt;
                let window = (std::f64::consts::PI * t / (f64::from(n) * dt)).sin().powi(2);
                window * (std::f64::consts::TAU * f * t).sin()
            })
            .collect();
        let chain = Processing { high_pass: Some(0.1), ..Processing::none() };
        let out = chain.apply(dt, &a, 0.0).unwrap();
        let middle = &out.acceleration[out.acceleration.len() / 2 - 2000..][..4000];
        let peak = middle.iter().fold(0.0_f64, |p, v| p.max(v.abs()));
        assert!((peak - gain).abs() < 0.01, "{ratio}: {peak} against {gain}"); // measured 0.004
        // The filter has zero phase: the recorded part starts `lead` later but is not shifted
        // otherwise.
        let lead = (out.acceleration.len() - a.len()) / 2;
        assert!((out.lead / dt - lead as f64).abs() < 1e-6);
        let dot: f64 = a.iter().zip(&out.acceleration[lead..]).map(|(x, y)| x * y).sum();
        assert!(dot > 0.0);
    }
}

#[test]
fn unreasonable_settings_are_refused() {
    let a = vec![0.1; 100];
    for chain in [
        Processing { high_pass: Some(60.0), ..Processing::none() },
        Processing { high_pass: Some(f64::NAN), ..Processing::none() },
        Processing { low_pass: Some(0.0), ..Processing::none() },
        // The corner is below the reciprocal of the duration of 1 s; the pads would exceed the memory.
        Processing { low_pass: Some(0.99), ..Processing::none() },
        Processing { low_pass: Some(1e-9), ..Processing::none() },
        Processing { low_pass: Some(1e-30), ..Processing::none() },
        Processing { high_pass: Some(5.0), low_pass: Some(2.0), ..Processing::none() },
        // The corner is raised to 1 Hz, where the low-pass corner is.
        Processing { high_pass: Some(0.1), low_pass: Some(1.0), ..Processing::none() },
        Processing { taper: 0.7, ..Processing::none() },
        Processing { order: 0, high_pass: Some(1.0), ..Processing::none() },
    ] {
        assert!(chain.apply(0.01, &a, 0.0).is_err(), "{chain:?}");
    }
    let chain = Processing { low_pass: Some(1e-9), ..Processing::none() };
    let message = chain.apply(0.01, &a, 0.0).unwrap_err().to_string();
    assert!(
        message.starts_with(
            "low-pass corner (Hz): expected at least the reciprocal of the duration, 1"
        )
    );
    let chain = Processing { high_pass: Some(0.1), low_pass: Some(1.0), ..Processing::none() };
    let message = chain.apply(0.01, &a, 0.0).unwrap_err().to_string();
    assert!(
        message.contains("at least the reciprocal of the duration: expected below the low-pass"),
        "{message}"
    );
    let whole = Processing { mean: MeanRemoval::Whole, ..Processing::none() };
    assert!(whole.apply(0.01, &a, 0.0).unwrap().acceleration.iter().all(|v| v.abs() < 1e-15));
}

#[test]
fn every_sample_of_a_raw_record_comes_to_rest_and_stays_consistent() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let given = ReadOptions {
        unit: Some(barrelstack_motion::AccelerationUnit::G),
        time_step: Some(0.01),
        sensitivity: Some(4000.0),
        ..ReadOptions::default()
    };
    let mut count = 0;
    for folder in std::fs::read_dir(root).unwrap() {
        let folder = folder.unwrap().path();
        if !folder.is_dir() {
            continue;
        }
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let name = path.display().to_string();
            let Ok(record) = read(&std::fs::read(&path).unwrap(), &name, &given) else { continue };
            if record.stage != Stage::Raw {
                continue;
            }
            for number in 1..=record.channels.len() {
                for chain in [Processing::raw(), Processing::compact()] {
                    let component = Component::Number(number);
                    let motion = record.ground_motion(&component, None, &chain).unwrap();
                    consistent_and_closed(&name, sampled(&motion.horizontal));
                    count += 1;
                }
            }
        }
    }
    assert!(count >= 40, "{count}");
}

fn consistent_and_closed(name: &str, motion: &Sampled) {
    let end = motion.at(motion.duration());
    assert!(end.velocity.abs() < 1e-3 * motion.pgv(), "{name}"); // measured 1e-13
    assert!(end.displacement.abs() < 1e-2 * motion.pgd(), "{name}"); // measured 1e-12
    derivatives_of_one_another(name, motion);
}

#[test]
fn parts_of_every_kind_are_joined_by_name_or_by_order() {
    let whole = example((0.0, 90.0), 3000);
    let part = |from: usize, to: usize, file: &str| {
        let mut part = whole.clone();
        part.file = file.to_owned();
        part.channels.truncate(1);
        // The only channel of plain columns is named after the file.
        part.channels[0].name = stem(file);
        part.channels[0].acceleration = part.channels[0].acceleration[from..to].to_vec();
        part
    };
    let joined =
        Record::join(&[part(0, 1800, "part1.txt"), part(1300, 3000, "part2.txt")]).unwrap();
    assert_eq!(joined.channels[0].acceleration.len(), 3000);
    // As in K-NET files, both parts have the same channel name and their means are removed.
    let mut two = part(1300, 3000, "part1.txt");
    let mean = two.channels[0].acceleration.iter().sum::<f64>() / 1700.0;
    for a in &mut two.channels[0].acceleration {
        *a -= mean;
    }
    let joined = Record::join(&[part(0, 1800, "part1.txt"), two]).unwrap();
    let off = joined.channels[0]
        .acceleration
        .iter()
        .zip(&whole.channels[0].acceleration)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(off < 1e-15, "{off}"); // measured 2.8e-17
}

fn stem(file: &str) -> String {
    file.trim_end_matches(".txt").to_owned()
}

#[test]
fn parts_are_joined_where_they_repeat() {
    let whole = example((0.0, 90.0), 3000);
    let part = |from: usize, to: usize, offset: f64, file: &str| {
        let mut part = whole.clone();
        part.file = file.to_owned();
        for channel in &mut part.channels {
            channel.acceleration =
                channel.acceleration[from..to].iter().map(|a| a + offset).collect();
        }
        part
    };
    let (one, two) = (part(0, 1800, 0.0, "parte1"), part(1300, 3000, 0.07, "parte2"));
    let joined = Record::join(&[one.clone(), two]).unwrap();
    for (a, b) in joined.channels.iter().zip(&whole.channels) {
        assert_eq!(a.acceleration.len(), 3000);
        let off = a.acceleration.iter().zip(&b.acceleration).map(|(x, y)| (x - y).abs());
        assert!(off.fold(0.0, f64::max) < 1e-14); // measured 1.1e-16
    }
    assert!(joined.notes.iter().any(|note| note.contains("5.00 s")));
    let apart = part(2000, 3000, 0.0, "parte3");
    let error = Record::join(&[one, apart]).unwrap_err().to_string();
    assert!(error.contains("does not repeat"), "{error}");
}

#[test]
fn a_part_of_a_record_names_another_part() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/renadic/example.v1");
    let bytes = std::fs::read(file).unwrap();
    let read = |name: &str| read(&bytes, name, &ReadOptions::default()).unwrap();
    assert!(!read("example.v1").is_part());
    for (name, other) in [
        ("a/curicoparte1.v1", "such as curicoparte2.v1,"),
        ("CuricoParte2.V1", "such as CuricoParte1.V1,"),
    ] {
        let record = read(name);
        assert!(record.is_part());
        let warning = record.warnings.iter().find(|one| one.message.contains("longer record"));
        let message = &warning.unwrap().message;
        for words in [other, "of this part are used"] {
            assert!(message.contains(words), "no {words:?} in {message}");
        }
    }
}

#[test]
fn single_components_are_gathered() {
    let record = example((0.0, 90.0), 300);
    let single = |k: usize| {
        let mut one = record.clone();
        one.channels = vec![record.channels[k].clone()];
        one.file = format!("{k}.txt");
        one
    };
    let gathered = Record::gather(&[single(1), single(0), single(2)]).unwrap();
    let names: Vec<&str> = gathered.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["two", "one", "three"]);
    let mut slow = single(0);
    slow.channels[0] =
        Channel::new("slow", Direction::default(), 0.02, slow.channels[0].acceleration.clone());
    assert!(Record::gather(&[single(1), slow]).is_err());
}

#[test]
fn the_bundled_record_has_its_published_peaks_and_comes_to_rest() {
    let napa = bundled("napa-college-2014").unwrap();
    assert_eq!(napa.stage, Stage::Raw);
    let pga: Vec<f64> = napa.channels.iter().map(|c| c.pga() / STANDARD_GRAVITY).collect();
    for (measured, stated) in pga.iter().zip([0.3728, 0.3389, 0.2152]) {
        assert!((measured - stated).abs() < 5.5e-5); // measured 3.0e-5; half a digit is 5e-5
    }
    let pgv: Vec<f64> = napa.channels.iter().map(|c| c.pgv() * 100.0).collect();
    for (measured, stated) in pgv.iter().zip([57.17, 55.52, 18.96]) {
        assert!((measured - stated).abs() < 5.5e-3, "{measured}"); // measured 4.0e-3
    }
    let motion = napa.default_motion().unwrap();
    println!("{}", motion.provenance.join("\n"));
    println!("PGV {:.4} m/s, PGD {:.4} m, {:.2} s", motion.pgv(), motion.pgd(), motion.duration);
    let end = motion.horizontal.at(motion.horizontal.duration());
    assert!(end.velocity.abs() < 1e-3 * motion.pgv());
    assert!(end.displacement.abs() < 1e-2 * motion.pgd());
    assert!(bundled("nowhere").is_none());
}
