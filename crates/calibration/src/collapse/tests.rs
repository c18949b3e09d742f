//! Coverage of the 95 % intervals in a hundred simulated campaigns of tests.
#![allow(clippy::print_stdout, reason = "the coverage is shown")]

use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack::scenario::Scenario;
use barrelstack_motion::Random;

use super::ensemble::{Built, Course, Shaking, placed, simulate};
use super::likelihood::Errors;
use super::observed::{Mode, Observed, Time};
use super::sampler::{Draw, Posterior};
use super::{Parameter, Tunable};

const ALL: [Parameter; 3] =
    [Parameter::Stiffness, Parameter::Damping, Parameter::FrictionBarrelRack];

/// Returns the observations that an observer of a simulated course would record.
fn noted(course: &Course, until: f64, errors: &Errors, random: &mut Random) -> Observed {
    let read = |time: Time, random: &mut Random| match time {
        Time::At(time) => Time::At((time + errors.reading * random.normal()).clamp(1e-3, until)),
        Time::Never => Time::Never,
    };
    Observed {
        mode: Some(course.mode),
        loss: Some(read(course.loss, random)),
        falls: course
            .falls
            .iter()
            .map(|(name, time)| (name.clone(), read(*time, random)))
            .collect(),
        until,
        ..Observed::default()
    }
}

/// Every campaign draws its true parameters from the prior, builds three stacks with random placements, records
/// the outcomes of these stacks, and estimates the parameters from one table of simulations that all
/// campaigns share.
#[test]
fn intervals_hold_the_truth_in_ninety_of_a_hundred_campaigns() {
    const TESTS: usize = 3;
    const TABLE: usize = 800;
    let (until, errors, reach) = (2.6, Errors::default(), 2.0_f64.ln());
    let scenarios: Vec<Scenario> = ["3 in", "4 in", "6 in"]
        .into_iter()
        .map(|amplitude| {
            let changes =
                [format!("motion.sine.amplitude={amplitude}"), format!("run.duration={until} s")];
            let mut scenario = Scenario::builtin("candia-8-barrels", &changes).unwrap();
            scenario.run.stop_after_collapse = None;
            scenario
        })
        .collect();
    let grounds: Vec<Shaking> =
        scenarios.iter().map(|scenario| Shaking::of(scenario).unwrap()).collect();
    let tunable = Tunable::new(&scenarios[0], &ALL).unwrap();
    let mut random = Random::new(2008);
    let draws: Vec<Draw> = (0..TABLE + 100)
        .map(|_| Draw {
            point: ALL.iter().map(|_| 2.0 * random.uniform() - 1.0).collect(),
            seed: random.bits(),
        })
        .collect();
    let batch: Vec<Built> = draws
        .iter()
        .flat_map(|draw| {
            let mut random = Random::new(draw.seed);
            let point: Vec<f64> = draw.point.iter().map(|x| reach * x).collect();
            let built = |(scenario, ground): (&Scenario, &Shaking)| Built {
                scenario: Arc::new(placed(&tunable.at(scenario, &point), 1e-3, &mut random)),
                ground: ground.clone(),
            };
            scenarios.iter().zip(&grounds).map(built).collect::<Vec<_>>()
        })
        .collect();
    let simulated: Vec<Course> = simulate(batch, None, &|_| ControlFlow::Continue(()))
        .unwrap()
        .into_iter()
        .map(Option::unwrap)
        .collect();
    let collapsed = simulated.iter().filter(|course| course.mode != Mode::Stands).count();
    let courses: Vec<&[Course]> = simulated.chunks_exact(TESTS).collect();
    let (table, truths) = courses.split_at(TABLE);
    let (mut covered, mut width) = ([0; 3], [0.0; 3]);
    for (truth, draw) in truths.iter().zip(&draws[TABLE..]) {
        let notes: Vec<Observed> =
            truth.iter().map(|course| noted(course, until, &errors, &mut random)).collect();
        let log = |course: &&[Course]| -> f64 {
            notes
                .iter()
                .zip(*course)
                .map(|(note, course)| errors.log_likelihood(note, course))
                .sum()
        };
        let logs: Vec<f64> = table.iter().map(log).collect();
        let posterior = Posterior::of(draws[..TABLE].to_vec(), &logs).unwrap();
        for (at, value) in draw.point.iter().enumerate() {
            let (low, high) = (posterior.quantile(at, 0.025), posterior.quantile(at, 0.975));
            covered[at] += u32::from((low..=high).contains(value));
            width[at] += (high - low) / 1.9 / 100.0;
        }
    }
    println!("{collapsed} of {} stacks collapse", simulated.len());
    println!("k, c and μ covered in {covered:?} of 100 campaigns");
    println!("mean width of the intervals over that of the range: {width:.2?}");
    // measured 94, 93 and 97; widths 0.75, 0.97 and 0.60: collapses say nothing about c
    assert!(covered.iter().all(|covered| *covered >= 90), "{covered:?}");
}
