//! Comparisons: their differences, refusals and page.

use std::ops::ControlFlow;

use barrelstack::compare::{self, CompareError, OtherPlane, Side, differences};
use barrelstack::outcome::Outcome;
use barrelstack::scenario::{Source, View};
use barrelstack::variants::{RunChoice, answer};
use barrelstack::{Scenario, Summary};
use barrelstack_report::{Block, Document, FigureKind, Plot, Table, figures, listed, markdown};

const MU: &str = "interface.rack-ground.friction.coefficient";

fn scenario(name: &str, changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin(name, &changes).unwrap()
}

fn side(name: &str, scenario: &Scenario) -> Side {
    let run = scenario.run().unwrap();
    Side::of_run(name.into(), &run, Summary::of(&run, None))
}

/// Returns the rows of the table under a heading, as text.
fn table<'a>(document: &'a Document, heading: &str) -> &'a Table {
    let at = document
        .blocks
        .iter()
        .position(|block| matches!(block, Block::Heading { text, .. } if text == heading));
    let Block::Table(table) = &document.blocks[at.unwrap() + 1] else {
        panic!("no table follows {heading}")
    };
    table
}

/// Returns the plot of a name.
fn plot(document: &Document, id: &str) -> Plot {
    let found = figures(document).into_iter().find(|(name, _)| name == id);
    let Some(FigureKind::Plot(plot)) = found.map(|(_, figure)| figure.kind) else {
        panic!("there is no plot {id}")
    };
    plot
}

/// Returns the names of the histories under the players.
fn lanes(document: &Document) -> Vec<&str> {
    let Block::Players(players) = &document.blocks[0] else { panic!("players come first") };
    players.ground.iter().map(|history| history.label.as_str()).collect()
}

#[test]
fn only_inputs_that_differ_are_listed_with_their_values_and_meaning() {
    let sure = scenario("candia-8-barrels", &[]);
    let slippery = scenario("candia-8-barrels", &[&format!("{MU}=0.1")]);
    let found = differences([&sure, &slippery]);
    let one = found.iter().find(|one| one.path == MU).unwrap();
    let values: Vec<&str> = one.values.iter().flatten().map(String::as_str).collect();
    assert_eq!(values, ["0.5", "0.1"]);
    assert!(one.help.to_lowercase().contains("friction"));
    assert!(found.iter().all(|one| one.path.starts_with("interface.rack-ground.friction.")));
    assert!(differences([&sure, &sure]).is_empty());
}

#[test]
fn an_input_that_one_run_has_not_is_absent_there() {
    let pulse = scenario("candia-8-barrels", &[]);
    let record = scenario("demo-napa", &[]);
    let found = differences([&pulse, &record]);
    let bundled = found.iter().find(|one| one.path == "motion.bundled").unwrap();
    assert_eq!(bundled.values, [None, Some("napa-college-2014".to_owned())]);
    // The title does not concern the physics.
    assert!(found.iter().all(|one| one.path != "title"));
}

#[test]
fn settings_say_where_they_come_from() {
    let settings = scenario("demo-napa", &[]).settings();
    let source = |path: &str| settings.iter().find(|one| one.path == path).unwrap().source;
    assert_eq!(source("stack.levels"), Source::Given);
    assert_eq!(source("stack.mirror"), Source::Default);
    assert_eq!(source("stack.gap"), Source::Default);
    assert!(matches!(source("stack.barrel.mass"), Source::Derived(_)));
    assert!(settings.len() > 50 && settings.iter().all(|one| !one.help.is_empty()));
}

#[test]
fn too_few_too_many_and_the_same_twice_are_refused() {
    let named = |levels: u32| {
        (format!("{levels}"), scenario("demo-napa", &[&format!("stack.levels={levels}")]))
    };
    assert_eq!(compare::check(&[named(3)]), Err(CompareError::TooFew(1)));
    let error = compare::check(&[named(3), named(4), named(3)]).unwrap_err();
    assert_eq!(error.to_string(), "3 and 3 are the same run: all their inputs are equal");
    let many: Vec<_> = (2..9).map(named).collect();
    assert_eq!(compare::check(&many), Err(CompareError::TooMany { found: 7, most: 6 }));
    assert_eq!(compare::check(&many[..6]), Ok(()));
}

#[test]
fn the_page_sets_outcomes_and_demands_side_by_side() {
    let changes = |levels: &str| {
        scenario("candia-8-barrels", &[levels, "run.stop_after_collapse=0.1 s", "run.duration=2 s"])
    };
    let sides = [side("four", &changes("stack.levels=4")), side("two", &changes("stack.levels=2"))];
    let document = compare::document(&sides);
    let Block::Players(players) = &document.blocks[0] else { panic!("players come first") };
    assert_eq!(players.panes.len(), 2);
    let outcomes = table(&document, "Outcomes");
    assert_eq!(outcomes.columns.len(), 3);
    let demands = table(&document, "Demands");
    let drift = demands.rows.iter().find(|row| format!("{:?}", row[0]).contains("drift")).unwrap();
    // The numbers are those of the summaries.
    for (cell, side) in drift[2..].iter().zip(&sides) {
        let own = 100.0 * side.summary.demands().top_drift_ratio.unwrap();
        assert_eq!(*cell, barrelstack_report::Cell::Measured(own, 1));
    }
    let inputs = table(&document, "Differences");
    assert_eq!(inputs.rows.len(), 1);
    let text = markdown(&document, "figures").text;
    assert!(text.contains("The runs differ in one input, stack.levels: 4 and 2."), "{text}");
    assert!(text.contains("A, four: ") && text.contains("B, two: "), "{text}");
}

#[test]
fn what_falls_leaves_the_picture_whichever_run_comes_first() {
    let disc = side("disc", &scenario("rolling-disc", &["run.duration=0.2 s"]));
    let changes = ["run.stop_after_collapse=1 s"];
    let stack = side("stack", &scenario("candia-8-barrels", &changes));
    assert!(stack.collapse_time.is_some());
    let range = |sides: &[Side], id: &str| plot(&compare::document(sides), id).y.range;
    let orders = [vec![disc.clone(), stack.clone()], vec![stack, disc]];
    let [first, second] = orders.each_ref().map(|sides| range(sides, "top-displacements"));
    assert!(first.is_some() && first == second, "{first:?} {second:?}");
    // Ground motion after the collapse stays in the plot.
    for sides in &orders {
        assert_eq!(range(sides, "ground-accelerations"), None);
    }
}

#[test]
fn a_length_scale_makes_another_motion() {
    let run = |more: &[&str]| {
        let changes = [&["run.duration=0.2 s"], more].concat();
        side("run", &scenario("candia-8-barrels", &changes))
    };
    let stated = run(&[]);
    let document = compare::document(&[stated.clone(), run(&["run.similitude=0.5"])]);
    assert_eq!(lanes(&document), ["A: ground acceleration", "B: ground acceleration"]);
    let shared = compare::document(&[stated, run(&["stack.levels=2"])]);
    assert_eq!(lanes(&shared), ["ground acceleration", "ground velocity"]);
}

#[test]
fn runs_are_called_by_what_differs_between_them_in_words() {
    let strap = "stack.strap={ levels = 5, ties = \"levels-together\", pretension = \"3 kN\" }";
    let tight = "stack.strap={ levels = 5, ties = \"levels-together\", pretension = \"4 kN\" }";
    let named = |changes: &[&[&str]]| {
        let runs: Vec<_> =
            changes.iter().map(|one| ("file".to_owned(), scenario("demo-napa", one))).collect();
        compare::labels(&runs)
    };
    for (changes, names) in [
        (&[&[][..], &["stack.levels=3"]][..], &["five levels", "three levels"][..]),
        (&[&[], &[strap]], &["without straps", "with straps"]),
        (
            &[&[], &[strap], &[tight]],
            &["without straps", "with straps tightened to 3 kN", "with straps tightened to 4 kN"],
        ),
        (
            &[&[], &["stack.levels=3"], &[strap]],
            &[
                "five levels without straps",
                "three levels without straps",
                "five levels with straps",
            ],
        ),
        (
            &[&[], &["interface.rack-ground.friction.coefficient=0.1"]],
            &["rack-ground friction 0.5", "rack-ground friction 0.1"],
        ),
        (
            &[&[], &["motion.scale.factor=0.8"]],
            &["South Napa 2014-08-24 M6.0", "South Napa 2014-08-24 M6.0, times 0.8"],
        ),
    ] {
        let found = named(changes);
        assert_eq!(found, names);
        assert!(found.iter().all(|name| !name.contains(['=', '{', '"'])));
    }
    // Runs with more differences than a name can state keep the names of their files.
    let many = ["stack.levels=3", "stack.columns=4", "run.gravity=9 m/s^2"];
    assert_eq!(named(&[&[], &many]), ["file", "file (2)"]);
}

#[test]
fn all_panes_show_one_variant_under_one_motion_and_the_headline_is_the_effect() {
    let answered = |name: &str, levels: &str| {
        let changes = [
            levels,
            "imperfections.variants=6",
            "run.duration=6 s",
            "run.stop_after_collapse=0.2 s",
        ];
        let scenario = scenario("demo-napa", &changes);
        let go = &mut |_| ControlFlow::Continue(());
        (name.to_owned(), answer(&scenario, RunChoice::Typical, go).unwrap())
    };
    let answers =
        vec![answered("five levels", "stack.levels=5"), answered("two levels", "stack.levels=2")];
    let aligned = compare::aligned(answers, &mut |_| ControlFlow::Continue(())).unwrap();
    let sides = compare::sides(aligned);
    let shown = |side: &Side| (side.summary.variant(), side.view, side.scenario.motion.clone());
    assert_eq!(shown(&sides[0]), shown(&sides[1]));
    let document = compare::document(&sides);
    assert_eq!(lanes(&document), ["ground acceleration", "ground velocity"]);
    // Counts of the headline are those of the shares and of the pairs.
    let paired = &compare::Comparison::of(&sides[..], Vec::new()).paired[0];
    let counts = [&sides[0], &sides[1]].map(|side| side.summary.ensemble().unwrap().collapsed);
    assert_eq!((paired.collapsed(), paired.pairs()), (counts, 6));
    let [from, to] = counts;
    let headline = &document.verdict.headline;
    let change =
        if from == to { ", as many as before".to_owned() } else { format!(" from {from}") };
    assert!(headline.contains(&change), "{headline}");
    assert!(headline.contains(&format!(", {to} of 6 variants collapse")), "{headline}");
    assert!(headline.starts_with("With two levels instead of five levels, "), "{headline}");
}

#[test]
fn a_headline_of_both_planes_is_one_sentence() {
    let answered = |name: &str, levels: &str| {
        let changes = [
            levels,
            "imperfections.variants=2",
            "motion.scale.factor=2.5",
            "run.duration=9 s",
            "run.stop_after_collapse=0.2 s",
        ];
        let scenario = scenario("demo-napa", &changes);
        let go = &mut |_| ControlFlow::Continue(());
        (name.to_owned(), answer(&scenario, RunChoice::Typical, go).unwrap())
    };
    let answers =
        vec![answered("five levels", "stack.levels=5"), answered("four levels", "stack.levels=4")];
    let aligned = compare::aligned(answers, &mut |_| ControlFlow::Continue(())).unwrap();
    let headline = compare::document(&compare::sides(aligned)).verdict.headline;
    assert!(headline.contains("With four levels instead of five levels, "), "{headline}");
    assert!(headline.contains("; ") && !headline.contains(':'), "{headline}");
}

#[test]
fn without_variants_both_planes_are_judged_and_named() {
    let short = ["stack.levels=2", "run.duration=9 s", "run.stop_after_collapse=0.1 s"];
    let answered = |factor: &str| {
        let none = ["imperfections.variants=0", factor];
        let scenario = scenario("demo-napa", &[&short[..], &none].concat());
        answer(&scenario, RunChoice::Typical, &mut |_| ControlFlow::Continue(())).unwrap()
    };
    let (weak, strong) = ("motion.scale.factor=0.02", "motion.scale.factor=2.5");
    let sides = compare::sides(vec![
        ("weak".to_owned(), answered(weak)),
        ("strong".to_owned(), answered(strong)),
    ]);
    let outcomes = |side: &Side| {
        let other = side.other.as_ref().unwrap();
        let shown = (side.view.unwrap(), side.outcome.clone());
        [shown, (other.view, other.outcome.clone())]
    };
    assert!(outcomes(&sides[0]).iter().all(|(_, outcome)| *outcome == Outcome::Stable));
    let strong = outcomes(&sides[1]);
    let fallen = strong.iter().filter(|(_, outcome)| outcome.is_collapse());
    let fallen: Vec<&str> = fallen.map(|(view, _)| view.words()).collect();
    assert!(!fallen.is_empty());
    let expected = format!(
        "Stands: weak. Falls: strong ({}). Runs end before their motion does, so a stack that stands at the end may still fall later.",
        listed(fallen)
    );
    assert_eq!(compare::document(&sides).verdict.headline, expected);
}

#[test]
fn a_stack_that_falls_in_the_plane_that_is_not_shown_falls() {
    let cut = " Runs end before their motion does, so a stack that stands at the end may still fall later.";
    let mut sides = vec![
        side("one", &scenario("candia-8-barrels", &["run.duration=0.2 s"])),
        side("other", &scenario("candia-8-barrels", &["run.duration=0.3 s"])),
    ];
    let headline = |sides: &[Side]| compare::document(sides).verdict.headline;
    assert_eq!(headline(&sides), format!("Both stand: one and other.{cut}"));
    let fallen = scenario("candia-8-barrels", &["run.stop_after_collapse=0.1 s"]).run().unwrap();
    let (view, outcome, spread) = (View::Longitudinal, fallen.outcome, None);
    assert!(outcome.is_collapse());
    sides[1].other = Some(OtherPlane { view, outcome, spread });
    assert_eq!(headline(&sides), format!("Stands: one. Falls: other (along the barrels).{cut}"));
    let page = markdown(&compare::document(&sides), "figures").text;
    assert!(page.contains("outcome in the other plane"));
}
