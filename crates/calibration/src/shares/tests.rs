//! Coverage of the intervals for stacks whose probability of falling is known in closed form.
#![allow(clippy::print_stdout, reason = "the coverage is shown")]

use barrelstack::scenario::Scenario;
use barrelstack_fragility::normal;
use barrelstack_motion::Random;

use super::{Fit, Height, Kind, Shaken, Statement, Statements, Weighed};

/// Returns the probability that a stack falls, in closed form. It replaces the simulations.
fn chance(point: &[f64], motion: f64, levels: usize) -> f64 {
    normal(0.2 - 1.8 * point[0] + 0.5 * point[1] + 0.6 * motion + 0.7 * (levels as f64 - 5.0))
}

/// Returns a [`Height`] for each number of levels. All have the same scenario, which is not simulated.
fn heights(levels: &[usize]) -> Vec<Height> {
    let scenario = Scenario::builtin("demo-napa", &[]).unwrap();
    levels.iter().map(|&levels| Height { levels, scenario: scenario.clone() }).collect()
}

fn statement(kind: &str, numbers: &str) -> Statement {
    let text = format!(
        "[[earthquake]]\nname = \"E\"\nmotion = 0.3\n[[earthquake.observation]]\nid = \"s\"\nstatement = \"S.\"\n\
         source = \"here\"\nuncertainty = \"counted\"\nkind = \"{kind}\"\n{numbers}\n"
    );
    let read = Statements::read("s.toml", &text).unwrap();
    read.earthquake[0].observation[0].clone()
}

/// For each campaign, true parameters, a true motion and a true mixture of heights are drawn at random. The results of
/// 300 simulated stacks are drawn from the closed form ([`chance`]). The observation states the true share with a
/// standard error of 1 %. The fit adds the model error to this error, although the closed form has no model error.
#[test]
fn intervals_hold_the_truth_in_ninety_of_a_hundred_campaigns() {
    let heights = heights(&[4, 5, 6]);
    let mut random = Random::new(2014);
    let (mut held, mut narrower) = (0, 0.0);
    for campaign in 0..100 {
        let mut point = || [2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0];
        let truth = point();
        let points: Vec<[f64; 2]> = (0..300).map(|_| point()).collect();
        let shaken: Vec<Shaken> = points
            .into_iter()
            .enumerate()
            .map(|(number, point)| {
                let (motion, height) = (random.normal(), number % 3);
                let falls = random.uniform() < chance(&point, motion, heights[height].levels);
                Shaken { point: point.to_vec(), motion, height, fallen: falls.then_some(0.8) }
            })
            .collect();
        let motion = random.normal();
        let parts: [f64; 3] = std::array::from_fn(|_| -(1.0 - random.uniform()).ln());
        let all: f64 = parts.iter().sum();
        let share: f64 = (0..3).map(|i| parts[i] / all * chance(&truth, motion, 4 + i) * 0.8).sum();
        let low = (share - 0.02).max(0.0);
        let high = (share + 0.02).min(1.0);
        let stated = statement(
            "barrels",
            &format!("levels = [4, 5, 6]\nvalue = {share}\nlow = {low}\nhigh = {high}"),
        );
        assert_eq!(stated.kind, Kind::Barrels);
        let fit = Fit::new(&shaken, &heights, campaign).unwrap();
        let found = Weighed::new(&[&stated], &heights, 2, &fit, campaign).unwrap().posterior;
        let ends = [found.quantile(0, 0.025), found.quantile(0, 0.975)];
        held += u32::from(ends[0] <= truth[0] && truth[0] <= ends[1]);
        narrower += (ends[1] - ends[0]) / 1.9 / 100.0;
    }
    println!("{held} of 100 held, {narrower:.2} of the width of the prior");
    // If the true coverage is 95 %, at least 90 of 100 intervals hold the truth with a probability of 98.9 %.
    assert!(held >= 90, "{held}"); // measured 96
    assert!(narrower < 0.9, "{narrower}"); // measured 0.73
}

#[test]
fn a_spread_of_the_motion_and_a_name_are_checked() {
    let file = |motion: &str, ids: &[&str]| {
        let one = |id: &&str| {
            format!(
                "[[earthquake.observation]]\nid = \"{id}\"\nstatement = \"S.\"\nsource = \"here\"\n\
                 uncertainty = \"counted\"\nkind = \"stacks\"\nlevels = [4]\nvalue = 0.4\nlow = 0.3\nhigh = 0.5\n"
            )
        };
        let all: String = ids.iter().map(one).collect();
        let text = format!("[[earthquake]]\nname = \"E\"\nmotion = {motion}\n{all}");
        Statements::read("s.toml", &text).map_err(|error| error.to_string())
    };
    assert!(file("0.3", &["a", "b"]).is_ok());
    for motion in ["nan", "-0.3", "30", "inf"] {
        let error = file(motion, &["a"]).unwrap_err();
        assert!(error.contains("`E`: `motion`") && error.contains("between 0 and 2"), "{error}");
    }
    let error = file("0.3", &["a", "a"]).unwrap_err();
    assert!(error.contains("two statements are named `a`"), "{error}");
}

#[test]
fn a_file_names_what_is_wrong_in_it() {
    let of = |kind: &str, numbers: &str| {
        let text = format!(
            "[[earthquake]]\nname = \"E\"\nmotion = 0.3\n[[earthquake.observation]]\nid = \"s\"\nstatement = \"S.\"\n\
             source = \"here\"\nuncertainty = \"counted\"\nkind = \"{kind}\"\n{numbers}\n"
        );
        Statements::read("s.toml", &text).map(|_| ()).unwrap_err().to_string()
    };
    for (kind, numbers, part) in [
        ("most", "levels = [4]\nvalue = 0.9", "needs `levels` and numbers"),
        ("most", "levels = [4]\nvalue = 1.9\nerror = 0.1", "between 0 and 1"),
        ("barrels", "levels = [4]\nvalue = 0.5\nlow = 0.6\nhigh = 0.7", "`low` at most `value`"),
        ("barrels", "levels = [4]\nvalue = 0.5\nlow = 0.5\nhigh = 0.5", "above zero"),
        ("few", "levels = [0]\nvalue = 0.1\nerror = 0.1", "at least one level"),
        ("some", "levels = [4]\nstacks = 0", "above zero"),
        ("half", "levels = [4]", "unknown variant `half`"),
    ] {
        let error = of(kind, numbers);
        assert!(error.starts_with("s.toml: ") && error.contains(part), "{kind} {numbers}: {error}");
    }
}
