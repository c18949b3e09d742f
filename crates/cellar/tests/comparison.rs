//! Layouts side by side: the numbers of the runs, paired variant by variant.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use barrelstack::compare::CompareError;
use barrelstack::variants::RunChoice;
use barrelstack_cellar::comparison::{
    self, CellarComparison, Layout, LeftOut, check, compared, csv, document, labels, table, usual,
    words,
};
use barrelstack_cellar::{Answer, Cellar, answer};
use barrelstack_report::described;
use serde_json::Value;

/// Two stacks of two levels on the racks of the demo, shaken for a short time.
const SMALL: [&str; 5] = [
    "stack.levels=2",
    "block.1.rows=1",
    "run.duration=6 s",
    "imperfections.variants=3",
    "motion.scale.factor=2.5",
];

fn cellar(changes: &[&str]) -> Cellar {
    let all = |changes: &[&str]| changes.iter().map(|&one| one.to_owned()).collect::<Vec<_>>();
    Cellar::builtin("demo-cellar", &all(&SMALL)).unwrap().with(&all(changes)).unwrap()
}

fn answered(cellar: &Cellar) -> Answer {
    answer(cellar, RunChoice::Typical, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Answers of the small room as it is and with a wider spacing, computed once.
fn answers() -> &'static [Answer; 2] {
    static ANSWERS: OnceLock<[Answer; 2]> = OnceLock::new();
    ANSWERS.get_or_init(|| [&[][..], &["block.1.spacing=1 m"]].map(|own| answered(&cellar(own))))
}

fn layouts() -> Vec<Layout> {
    let names = ["spacing 0.3 m", "spacing 1 m"];
    let of = |(name, answer): (&str, &Answer)| Layout::of(name.to_owned(), answer);
    names.into_iter().zip(answers()).map(of).collect()
}

fn found(layouts: &[Layout]) -> CellarComparison {
    compared(layouts, Vec::new(), Vec::new())
}

#[test]
fn numbers_are_those_of_the_runs_and_differences_those_of_their_variants() {
    let layouts = layouts();
    let found = found(&layouts);
    for (own, answer) in found.layouts.iter().zip(answers()) {
        let json = described::to_json(&answer.summary).unwrap();
        let run: Value = serde_json::from_str(&json).unwrap();
        let room = &run["room"];
        let number = |value: &Value| value.as_f64().unwrap();
        assert_eq!(own.cellar_hash, run["plan"]["cellar_hash"].as_str().unwrap());
        assert_eq!((own.capacity, own.counted), (8, 3));
        let near = |own: f64, run: f64| assert!((own - run).abs() < 1e-9, "{own} {run}");
        near(own.by_themselves.mean, number(&room["by_themselves"]));
        near(own.knocked_over.mean, number(&room["knocked_over"]));
        // The interval of the number of stacks is that of the share, multiplied by the two stacks.
        for end in [0, 1] {
            let share = number(&room["share_by_themselves"]["interval"][end]);
            near(own.by_themselves.interval.unwrap()[end], 2.0 * share);
        }
        assert_eq!(own.spread, room["spread"].as_f64());
        assert_eq!(own.wine_lost, number(&room["wine_lost"][1]));
        assert_eq!(own.cost, [0, 1].map(|end| number(&room["cost"][end])));
        assert_eq!(own.peak_force, room["peak_force"].as_f64());
        let barrels: f64 = run["stacks"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| number(&one["barrels_fallen"]))
            .sum();
        near(own.barrels_fallen.mean, barrels);
        near(own.share_lost.mean, barrels / 8.0);
        assert_eq!(own.aisles.len(), 1);
        assert_eq!(own.some_blocked.unwrap(), answer.summary.aisles[0].blocked);
    }
    // A change is the mean of the differences between the layouts, variant by variant.
    let [first, second] = answers().each_ref().map(|answer| {
        let fallen = |case: &barrelstack_cellar::sample::Case| {
            (case.variant > 0)
                .then(|| case.stacks.iter().map(|stack| stack.barrels as f64).sum::<f64>())
        };
        answer.cases.iter().filter_map(fallen).collect::<Vec<_>>()
    });
    let [pair] = &found.paired[..] else { panic!("{:?}", found.paired) };
    let differences: Vec<f64> = second.iter().zip(&first).map(|(b, a)| b - a).collect();
    assert_eq!((pair.variants, differences.len()), (3, 3));
    let mean = differences.iter().sum::<f64>() / 3.0;
    assert_eq!(pair.barrels_fallen.difference, mean);
    let [low, high] = pair.barrels_fallen.interval.unwrap();
    let exact = barrelstack_fragility::mean_difference(&differences, 8.0, 0.95, 1).unwrap();
    assert_eq!([low, high], [exact.low, exact.high]);
    assert!(pair.same_motion && pair.same_draws && pair.left_out.is_empty(), "{pair:?}");
    let (wine, cost) = (pair.wine_lost, pair.cost_high);
    assert_eq!((wine.interval, cost.interval), (None, None));
    let lost = |at: usize| found.layouts[at].wine_lost;
    assert!((wine.difference - (lost(1) - lost(0))).abs() < 1e-12);
}

#[test]
fn the_effect_comes_first_and_every_number_is_said_once_computed() {
    let layouts = layouts();
    let found = found(&layouts);
    let page = document(&layouts, &found);
    assert_eq!(page.verdict.headline, found.headline);
    let said = &found.headline;
    assert!(said.starts_with("Spacing 1 m instead of 0.3 m: "), "{said}");
    assert!(said.contains("the same 3 variants"), "{said}");
    let barrels = (10.0 * found.paired[0].barrels_fallen.second).round() / 10.0;
    assert!(said.contains(&format!(": {barrels} barrel")), "{said}");
    let sentences = words::sentences(&found).join(" ");
    assert!(sentences.contains("of 8 barrels") && sentences.contains("US$"), "{sentences}");
    assert!(sentences.contains("Runs end before their motion does"), "{sentences}");
    // Tables list the layouts by the share of barrels that fall; the CSV file has all digits.
    let order: Vec<&str> = found.ranked().iter().map(|(one, _)| one.name.as_str()).collect();
    let shares: Vec<f64> = found.ranked().iter().map(|(one, _)| one.share_lost.mean).collect();
    assert!(shares.is_sorted(), "{shares:?}");
    assert_eq!(order, found.order);
    let text = csv(&found).to_csv();
    for (line, (one, _)) in text.lines().skip(1).zip(found.ranked()) {
        assert!(line.starts_with(&format!("{},8,2,3,", one.name)), "{line}");
        assert!(line.contains(&format!(",{},", one.barrels_fallen.mean)), "{line}");
    }
    let lines = table(&found).to_lines();
    assert_eq!(lines.len(), 3);
    assert!(lines[0].starts_with("layout") && lines[1].starts_with(order[0]), "{lines:?}");
    let json: Value = serde_json::from_str(&described::to_json(&found).unwrap()).unwrap();
    assert_eq!(json["schema"], "cellar-comparison/1");
    let paths: Vec<&Value> =
        json["differences"].as_array().unwrap().iter().map(|one| &one["path"]).collect();
    assert_eq!(paths, ["block.1.spacing"]);
}

#[test]
fn a_room_differs_from_itself_by_nothing() {
    let one = layouts().swap_remove(0);
    let again = Layout { name: "again".to_owned(), ..one.clone() };
    let found = found(&[one, again]);
    let pair = &found.paired[0];
    for change in [
        pair.by_themselves,
        pair.knocked_over,
        pair.barrels_fallen,
        pair.share_lost,
        pair.wine_lost,
        pair.cost_low,
        pair.cost_high,
    ] {
        assert_eq!((change.difference, change.first), (0.0, change.second));
    }
    assert!(found.differences.is_empty());
    assert!(!found.headline.contains("fewer (") && !found.headline.contains("more ("));
    // A comparison of equal rooms is refused before anything is run.
    let twice = [cellar(&[]), cellar(&["title=\"another\""])];
    let twice = twice.map(|cellar| ("a".to_owned(), cellar));
    assert!(matches!(check(&twice), Err(CompareError::Identical { .. })));
    assert!(matches!(check(&twice[..1]), Err(CompareError::TooFew(1))));
}

#[test]
fn stopped_work_has_no_verdict_and_variants_without_a_result_have_no_pair() {
    let mut layouts = layouts();
    let stopped = compared(&layouts[..1], vec!["spacing 1 m".to_owned()], Vec::new());
    assert_eq!(stopped.headline, "Stopped after 1 of 2 layouts: there is no verdict.");
    assert!(stopped.paired.is_empty() && words::sentences(&stopped).is_empty());
    let page = document(&layouts[..1], &stopped);
    assert_eq!(page.verdict.headline, stopped.headline);
    // A variant whose computation fails in one of the layouts.
    let second = &mut layouts[1];
    second.cases.iter_mut().filter(|case| case.variant == 2).for_each(|case| case.valid = false);
    let pair = &found(&layouts).paired[0];
    assert_eq!((pair.variants, &pair.left_out), (2, &vec![2]));
    let said = words::sentences(&found(&layouts)).join(" ");
    assert!(said.contains("1 variant has no valid result"), "{said}");
    // No variant of the second layout is valid.
    layouts[1].cases.iter_mut().for_each(|case| case.valid = false);
    layouts[1].summary.counted = 0;
    let none = found(&layouts);
    assert!(none.headline.contains("\"spacing 1 m\" has no valid result"), "{}", none.headline);
    assert_eq!(none.order, ["spacing 0.3 m"]);
    // The room as stated alone gives no interval.
    for layout in &mut layouts {
        layout.cases.truncate(1);
        layout.cases[0].valid = true;
        layout.summary.counted = 1;
    }
    let one = found(&layouts);
    assert_eq!((one.paired[0].variants, one.paired[0].barrels_fallen.interval), (1, None));
    let silent = one.headline.contains("no barrel falls in either layout");
    assert!(silent || one.headline.contains("gives no interval"), "{}", one.headline);
}

#[test]
fn other_motions_are_said_first_and_other_draws_beside_the_variants() {
    let mut layouts = layouts();
    layouts[1].cellar = cellar(&["motion.scale.factor=2.6", "imperfections.seed=7"]);
    let found = found(&layouts);
    assert!(found.headline.starts_with("The motions differ"), "{}", found.headline);
    assert!(found.headline.contains("3 variants with different draws"), "{}", found.headline);
    // If only the number of variants differs, the draws count as the same.
    layouts[1].cellar = cellar(&[]).with_variants(9);
    let pair = &compared(&layouts, Vec::new(), Vec::new()).paired[0];
    assert!(pair.same_draws && pair.same_motion);
}

#[test]
fn layouts_are_named_by_what_differs() {
    let named = |changes: [&[&str]; 2]| {
        let cellars = changes.map(|own| ("given".to_owned(), cellar(own)));
        labels(&cellars)
    };
    assert_eq!(named([&[], &["block.1.spacing=1 m"]]), ["spacing 0.3 m", "spacing 1 m"]);
    assert_eq!(named([&[], &["stack.levels=1"]]), ["two levels", "one level"]);
    assert_eq!(named([&[], &["room.walls=false"]]), ["room walls true", "room walls false"]);
}

#[test]
fn usual_changes_fit_or_say_why_not() {
    let all = usual(&cellar(&[]));
    let names: Vec<&str> = all.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "spacing 1 m",
            "all levels held together by straps tightened to 5 kN",
            "stops under every rack",
            "one level less",
            "every stack turned by 90°"
        ]
    );
    let changed = |at: usize| all[at].changed.as_ref().unwrap();
    let stack = |at: usize| changed(at).stated().stack().unwrap();
    assert_eq!(changed(0).blocks[0].spacing, 1.0);
    let straps = stack(1).devices.strap;
    assert_eq!((straps.levels, straps.pretension), (2, 5000.0));
    assert!(stack(2).devices.walking_stop.is_on());
    assert_eq!(stack(3).levels, 1);
    assert!((changed(4).blocks[0].azimuth - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    for one in &all {
        let count = one.changed.as_ref().unwrap().stated().imperfections().unwrap().variants;
        assert_eq!(count, 3, "{}", one.name);
    }
    // Rooms that are too short for a spacing of 1 m or too narrow for turned stacks, and stacks of one level.
    let reason = |changes: &[&str], at: usize| {
        usual(&cellar(changes)).swap_remove(at).changed.err().unwrap_or_default()
    };
    let short = usual(&cellar(&["room.length=4.2 m", "aisle.aisle.to=[\"4.2 m\", \"3.2 m\"]"]));
    assert!(short[0].name.ends_with("the widest that fits"), "{}", short[0].name);
    // Measured: with 1 m the row extends 0.26 m beyond the wall.
    assert_eq!(short[0].changed.as_ref().unwrap().blocks[0].spacing, 0.74);
    let narrow = ["room.width=1.7 m", "aisle=[]", "place=[]", "door=[]"];
    let said = reason(&narrow, 4);
    assert!(said.contains("beyond the far wall"), "{said}");
    for at in [1, 2, 3] {
        let said = reason(&["stack.levels=1"], at);
        assert!(said.contains("one level"), "{said}");
    }
    assert!(reason(&["block.1.stacks=1"], 0).contains("no row has two stacks"));
    assert!(reason(&["block.1.spacing=1.1 m"], 0).contains("1.10 m apart already"));
    // Heights of rows are reduced one by one.
    let rows = cellar(&["block.1.rows=2", "block.1.levels_by_row=[2, 3]"]);
    let fewer = usual(&rows).swap_remove(3).changed.unwrap();
    assert_eq!(fewer.blocks[0].levels_by_row, [1, 2]);
}

#[test]
fn what_was_not_run_is_listed_with_its_reason() {
    let layouts = layouts();
    let not = LeftOut { name: "one level less".to_owned(), reason: "it does not fit".to_owned() };
    let third = Layout { name: "third".to_owned(), ..layouts[1].clone() };
    let three = [layouts[0].clone(), layouts[1].clone(), third];
    let found = compared(&three, Vec::new(), vec![not]);
    let said = words::sentences(&found).join(" ");
    assert!(
        said.contains("The layout \"one level less\" was not run, because it does not fit."),
        "{said}"
    );
    assert!(said.contains("of all these differences jointly"), "{said}");
    let lines = table(&found).to_lines();
    assert_eq!(lines.len(), 5);
    assert!(lines[4].ends_with("not run: it does not fit"), "{lines:?}");
    // With several differences, each interval is wider, so that all of them hold jointly.
    let width = |found: &CellarComparison| {
        let [low, high] = found.paired[0].barrels_fallen.interval.unwrap();
        high - low
    };
    assert!(width(&found) >= width(&self::found(&layouts)));
    let best = found.layouts.iter().map(|one| one.share_lost.mean).reduce(f64::min).unwrap();
    let first = &found.layouts[0];
    let words = if first.barrels_fallen.mean == 0.0 && best == 0.0 {
        "No barrel falls"
    } else if best < first.share_lost.mean {
        "Of 3 layouts, \"spacing 1 m\" loses the fewest barrels for its capacity"
    } else {
        "None of 2 other layouts loses fewer barrels"
    };
    assert!(found.headline.starts_with(words), "{}", found.headline);
    let names: Vec<String> =
        comparison::files(&found).unwrap().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["layouts.csv", "comparison.json"]);
}
