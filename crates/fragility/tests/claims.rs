//! Simulated coverage of intervals, and rate of false claims, compared with the previous rules.
//!
//! `cargo test --release -p barrelstack-fragility --test all claims -- --nocapture` prints the tables of
//! `validation/statistics.md`.

#![expect(clippy::print_stdout, reason = "the measured shares, shown with --nocapture")]

use barrelstack_fragility::{
    Interval, at_most, mean_difference, sobol_indices, student_quantile, wilson,
};
use barrelstack_motion::Random;

const LEVEL: f64 = 0.95;

/// Number of barrels of a stack.
const BARRELS: f64 = 8.0;

/// Draws a standard normal number (Box and Muller 1958).
fn normal(random: &mut Random) -> f64 {
    let (radius, angle) = (random.uniform().max(1e-300), random.uniform());
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
}

/// Draws the mean number of barrels that fall under a motion at three levels of shaking.
///
/// A stack collapses if the motion is more severe than its capacity, which is random; then two to eight barrels fall.
fn fallen(severity: f64, help: f64, random: &mut Random) -> f64 {
    let level = |level: f64, random: &mut Random| {
        let collapses = level + severity - help + 0.5 * normal(random) > 0.0;
        if collapses { (2.0 + 7.0 * random.uniform()).floor().min(BARRELS) } else { 0.0 }
    };
    [-0.8, 0.0, 0.8].map(|at| level(at, random)).iter().sum::<f64>() / 3.0
}

/// Returns Student's interval, the previous rule.
fn student(differences: &[f64]) -> Interval {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let squares: f64 = differences.iter().map(|one| (one - mean) * (one - mean)).sum();
    let half = student_quantile(LEVEL, differences.len() - 1) * (squares / (n * (n - 1.0))).sqrt();
    Interval { low: mean - half, high: mean + half }
}

/// Fractions of searches with a claim, and numbers of barrels claimed, by the previous and the present rule.
///
/// The first of several protections has the effect `help`; the others have none.
struct Claims {
    before: f64,
    after: f64,
    barrels: f64,
    right: f64,
}

fn claims(motions: usize, tries: usize, help: f64, alike: f64, searches: u32) -> Claims {
    let mut random = Random::new(35);
    let mut counts = [0_u32; 3];
    let mut barrels = 0.0;
    for _ in 0..searches {
        // Records may be nearly alike: their severities differ little.
        let severities: Vec<f64> = (0..motions).map(|_| alike * normal(&mut random)).collect();
        let base: Vec<f64> = severities.iter().map(|s| fallen(*s, 0.0, &mut random)).collect();
        let (mut before, mut after, mut most) = (false, false, 0.0_f64);
        for at in 0..tries {
            let help = if at == 0 { help } else { 0.0 };
            let differences: Vec<f64> = severities
                .iter()
                .zip(&base)
                .map(|(severity, base)| base - fallen(*severity, help, &mut random))
                .collect();
            let helps = help > 0.0;
            let old = student(&differences).low > 0.0;
            let new = mean_difference(&differences, BARRELS, LEVEL, tries).unwrap().low > 0.0;
            before |= old && !helps;
            after |= new && !helps;
            counts[2] += u32::from(new && helps);
            if old && !helps {
                most = most.max(differences.iter().sum::<f64>() / motions as f64);
            }
        }
        counts[0] += u32::from(before);
        counts[1] += u32::from(after);
        barrels += most;
    }
    let share = |count: u32| f64::from(count) / f64::from(searches);
    Claims {
        before: share(counts[0]),
        after: share(counts[1]),
        barrels: barrels / f64::from(counts[0].max(1)),
        right: share(counts[2]),
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a minute; run in release")]
fn a_search_in_which_nothing_helps_rarely_claims_that_something_does() {
    println!(
        "| motions | tries | records | help (β) | false, before | barrels claimed, before | false, now | found, now |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (motions, tries, alike, help) in [
        (2, 60, 0.01, 0.0),
        (2, 60, 0.8, 0.0),
        (5, 60, 0.8, 0.0),
        (12, 60, 0.8, 0.0),
        (36, 60, 0.8, 0.0),
        (36, 60, 0.01, 0.0),
        (36, 60, 0.8, 0.3),
        (36, 60, 0.8, 1.0),
        (36, 60, 0.8, 2.0),
    ] {
        let found = claims(motions, tries, help, alike, 2000);
        let kind = if alike < 0.1 { "near-equal" } else { "various" };
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        println!(
            "| {motions} | {tries} | {kind} | {help} | {} | {:.1} | {} | {} |",
            percent(found.before),
            found.barrels,
            percent(found.after),
            if help > 0.0 { percent(found.right) } else { "-".to_owned() }
        );
        // The allowed rate is two in a hundred searches, and four with the scatter of the simulation. Measured: 0 to 2 %.
        assert!(found.after <= 0.04, "{motions} motions: {}", found.after);
        assert!(found.before > 0.2, "the old rule claims: {}", found.before);
        assert!(help < 2.0 || found.right > 0.9, "what helps much is found: {}", found.right);
    }
}

/// Returns the fractions of trials whose interval covers the mean difference, by the previous and the present rule.
fn held(motions: usize, draw: &dyn Fn(&mut Random) -> f64, truth: f64) -> [f64; 2] {
    let mut random = Random::new(7);
    let mut held = [0_u32; 2];
    for _ in 0..2000 {
        let differences: Vec<f64> = (0..motions).map(|_| draw(&mut random)).collect();
        let intervals =
            [student(&differences), mean_difference(&differences, BARRELS, LEVEL, 1).unwrap()];
        for (held, interval) in held.iter_mut().zip(intervals) {
            *held += u32::from(interval.holds(truth));
        }
    }
    held.map(|held| f64::from(held) / 2000.0)
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a while; run in release")]
fn intervals_of_paired_differences_hold_them_where_few_are_not_alike() {
    let rare = |random: &mut Random| if random.uniform() < 0.04 { BARRELS } else { 0.0 };
    let mixed = |random: &mut Random| {
        let small = if random.uniform() < 0.3 { 1.0 / 3.0 } else { 0.0 };
        if random.uniform() < 0.04 { BARRELS } else { small }
    };
    let even = |random: &mut Random| 2.0 + normal(random);
    println!("| differences | motions | coverage before | coverage now |\n|---|---|---|---|");
    for (name, draw, truth) in [
        ("8 barrels in 4 % of the motions", &rare as &dyn Fn(&mut Random) -> f64, 0.32),
        ("the same among small ones", &mixed, 0.32 + 0.96 * 0.1),
        ("normal", &even, 2.0),
    ] {
        for motions in [2, 5, 12, 36] {
            let [before, after] = held(motions, draw, truth);
            println!("| {name} | {motions} | {:.1} % | {:.1} % |", 100.0 * before, 100.0 * after);
            // Measured: 94.4 % and more.
            assert!(after >= 0.93, "{name}, {motions} motions: {after}");
        }
    }
}

/// Weights of the inputs in the test functions below; the first two inputs also interact.
const WEIGHTS: [f64; 5] = [1.0, 0.5, 0.2, 0.05, 0.0];

/// Returns a block of results `[f(A), f(B), f(A with input 1 of B), …]`.
fn block(of: fn(f64) -> f64, random: &mut Random) -> Vec<f64> {
    let mut draw = || WEIGHTS.map(|_| normal(random));
    let (a, b) = (draw(), draw());
    let result = |x: [f64; 5]| {
        let sum: f64 = x.iter().zip(WEIGHTS).map(|(x, weight)| weight * x).sum();
        of(sum + 0.3 * x[0] * x[1])
    };
    let exchanged = (0..WEIGHTS.len()).map(|at| {
        let mut mixed = a;
        mixed[at] = b[at];
        result(mixed)
    });
    [result(a), result(b)].into_iter().chain(exchanged).collect()
}

/// Returns the previous intervals of the total indices: percentiles of resampled blocks.
fn resampled(blocks: &[Vec<f64>], random: &mut Random) -> Vec<Interval> {
    let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); WEIGHTS.len()];
    for _ in 0..100 {
        let pick = |random: &mut Random| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "below the count"
            )]
            let at = (random.uniform() * blocks.len() as f64) as usize;
            blocks[at.min(blocks.len() - 1)].clone()
        };
        let again: Vec<Vec<f64>> = blocks.iter().map(|_| pick(random)).collect();
        let n = again.len() as f64;
        let mean = again.iter().map(|b| b[0] + b[1]).sum::<f64>() / (2.0 * n);
        let square = |x: f64| x * x;
        let variance = again.iter().map(|b| square(b[0] - mean) + square(b[1] - mean)).sum::<f64>()
            / (2.0 * n - 1.0);
        if variance == 0.0 {
            continue;
        }
        for (input, drawn) in drawn.iter_mut().enumerate() {
            let total = again.iter().map(|b| square(b[0] - b[2 + input])).sum::<f64>() / (2.0 * n);
            drawn.push(total / variance);
        }
    }
    let bounds = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let at = |share| barrelstack_fragility::quantile(&values, share);
        Interval { low: at(0.025), high: at(0.975) }
    };
    drawn.into_iter().map(bounds).collect()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a minute; run in release")]
fn intervals_of_sobol_indices_hold_them_for_weak_and_strong_inputs() {
    type Result = fn(f64) -> f64;
    let results: [(&str, Result); 4] = [
        ("collapse, 50 %", |z| f64::from(u8::from(z > 0.0))),
        ("collapse, 10 %", |z| f64::from(u8::from(z > 1.45))),
        ("a demand", |z| (0.6 * z).exp()),
        ("barrels fallen", |z| (3.0 * z).floor().clamp(0.0, 8.0)),
    ];
    println!(
        "| result | blocks | total index | coverage before | coverage now | longest end before | now |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (name, of) in results {
        let mut random = Random::new(1);
        let many: Vec<Vec<f64>> = (0..100_000).map(|_| block(of, &mut random)).collect();
        let truth: Vec<[f64; 2]> = {
            let n = many.len() as f64;
            let mean = many.iter().map(|b| b[0] + b[1]).sum::<f64>() / (2.0 * n);
            let variance =
                many.iter().flat_map(|b| [b[0], b[1]]).map(|x| (x - mean).powi(2)).sum::<f64>()
                    / (2.0 * n);
            let of = |at: usize| {
                let first =
                    many.iter().map(|b| (b[1] - mean) * (b[2 + at] - b[0])).sum::<f64>() / n;
                let total =
                    many.iter().map(|b| (b[0] - b[2 + at]).powi(2)).sum::<f64>() / (2.0 * n);
                [first.max(0.0) / variance, total / variance]
            };
            (0..WEIGHTS.len()).map(of).collect()
        };
        drop(many);
        for blocks in [16, 64, 256] {
            let trials = 16_000 / blocks;
            let mut done = 0_u32;
            let mut held = [[0_u32; 3]; WEIGHTS.len()];
            let mut ends = [0.0_f64; 2];
            for _ in 0..trials {
                let drawn: Vec<Vec<f64>> = (0..blocks).map(|_| block(of, &mut random)).collect();
                let Some(found) = sobol_indices(&drawn, LEVEL) else { continue };
                done += 1;
                let before = resampled(&drawn, &mut random);
                for (at, index) in found.iter().enumerate() {
                    held[at][0] += u32::from(before[at].holds(truth[at][1]));
                    held[at][1] += u32::from(index.total_interval.holds(truth[at][1]));
                    // The true values are known to a few thousandths only.
                    let first = index.first_interval;
                    let first = Interval { low: first.low - 0.003, high: first.high + 0.003 };
                    held[at][2] += u32::from(first.holds(truth[at][0]));
                    ends[0] = ends[0].max(before[at].high);
                    ends[1] = ends[1].max(index.total_interval.high.max(index.first_interval.high));
                }
            }
            for (at, held) in held.iter().enumerate() {
                let [before, after, first] = held.map(|held| f64::from(held) / f64::from(done));
                println!(
                    "| {name} | {blocks} | {:.2} | {:.0} % | {:.0} % | {:.1} | {:.1} |",
                    truth[at][1],
                    100.0 * before,
                    100.0 * after,
                    ends[0],
                    ends[1]
                );
                // There are at least 62 trials, whose shares scatter by 3 %. Measured: at least 89 %.
                assert!(after >= 0.85, "{name}, {blocks} blocks, total {at}: {after}");
                assert!(first >= 0.82, "{name}, {blocks} blocks, first {at}: {first}");
            }
            assert!(ends[1] <= 1.0);
        }
    }
}

#[test]
fn fewer_than_sixteen_blocks_say_nothing_and_no_interval_has_width_zero() {
    let mut random = Random::new(3);
    let of = |z: f64| f64::from(u8::from(z > 0.0));
    let mut few: Vec<Vec<f64>> = (0..15).map(|_| block(of, &mut random)).collect();
    for index in sobol_indices(&few, LEVEL).unwrap() {
        assert_eq!(index.total_interval, Interval { low: 0.0, high: 1.0 });
    }
    few.push(block(of, &mut random));
    let found = sobol_indices(&few, LEVEL).unwrap();
    // The last input has no effect; sixteen blocks are too few to show that.
    let nothing = found.last().unwrap();
    assert_eq!((nothing.first, nothing.total), (0.0, 0.0));
    assert!(nothing.total_interval.high > 0.3, "{nothing:?}");
}

/// Returns the probability of at most `k` failures of `n`.
fn up_to(k: u32, n: u32, p: f64) -> f64 {
    let mut term = (1.0 - p).powi(i32::try_from(n).unwrap());
    let mut sum = term;
    for j in 0..k {
        term *= f64::from(n - j) / f64::from(j + 1) * p / (1.0 - p);
        sum += term;
    }
    sum
}

/// The rule of studies of heights: a height is rated low if the share of collapse and its upper bound are small enough.
#[test]
fn a_height_above_the_limit_is_rarely_called_low_however_many_motions_there_are() {
    let low = |k: u32, n: u32| f64::from(k) / f64::from(n) <= 0.05 && at_most(k, n, LEVEL) <= 0.12;
    let before =
        |k: u32, n: u32| f64::from(k) / f64::from(n) <= 0.05 && wilson(k, n, LEVEL).high <= 0.2;
    let passes = |rule: &dyn Fn(u32, u32) -> bool, n: u32, p: f64| {
        (0..=n).take_while(|k| rule(*k, n)).last().map_or(0.0, |k| up_to(k, n, p))
    };
    println!("| motions | passes with | 8 % | 12 % | 15 % | 20 % (before: 12 %, 15 %, 20 %) |");
    println!("|---|---|---|---|---|---|");
    for n in [16, 24, 34, 40, 60, 100, 200, 400] {
        let [eight, twelve, fifteen, twenty] =
            [0.08, 0.12, 0.15, 0.2].map(|p| 100.0 * passes(&low, n, p));
        let old = [0.12, 0.15, 0.2].map(|p| format!("{:.1} %", 100.0 * passes(&before, n, p)));
        let most = (0..=n).take_while(|k| low(*k, n)).last();
        println!(
            "| {n} | {} | {eight:.1} % | {twelve:.1} % | {fifteen:.1} % | {twenty:.1} % ({}) |",
            most.map_or_else(|| "none".to_owned(), |k| format!("at most {k}")),
            old.join(", ")
        );
    }
    for n in 1..400 {
        let wrong = passes(&low, n, 0.12);
        assert!(wrong <= 0.05 + 1e-9, "{n} motions: {wrong}");
        // A height that passes without failures also passes with more motions without failures.
        assert!(!low(0, n) || low(0, n + 1), "{n}");
    }
    // The previous rule passed a probability of 12 % more often with 34 motions than with 24.
    assert!(passes(&before, 34, 0.12) > passes(&before, 24, 0.12));
}
