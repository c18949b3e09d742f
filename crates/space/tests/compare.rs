//! Comparisons and repeats of three-dimensional stacks, through the same code as for plane stacks.

#![allow(clippy::unwrap_used, reason = "a test fails by panic, in its helpers too")]

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack::compare::{self, Comparison, Side};
use barrelstack::summary::AnySummary;
use barrelstack::variants::{Advance, RunChoice};
use barrelstack::verify::{APART, DISTURBED, Repeatable as _, verify};
use barrelstack_report::{Block, Language, Paper, document_pdf, html};
use barrelstack_space::run::{Run, run};
use barrelstack_space::{AnyAnswer, answer, summary};

fn demo(changes: &[&str]) -> Scenario {
    let short = ["run.duration=9 s", "run.stop_after_collapse=1.5 s", "stack.levels=2"];
    let all = short.iter().chain(changes).map(|change| (*change).to_owned());
    Scenario::builtin("demo-napa", &all.collect::<Vec<_>>()).unwrap()
}

fn go(_: Advance) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn sides(scenarios: &[(&str, Scenario)]) -> Vec<Side> {
    let answer = |(name, scenario): &(&str, Scenario)| {
        ((*name).to_owned(), AnyAnswer::of(scenario, RunChoice::Typical, &mut go).unwrap())
    };
    let answers = scenarios.iter().map(answer).collect();
    compare::sides(compare::aligned(answers, &mut go).unwrap())
}

#[test]
fn a_comparison_in_space_has_the_shares_of_separate_runs() {
    let space = ["stack.view=spatial", "imperfections.variants=4"];
    let strong = demo(&[&space[..], &["motion.scale.factor=2.5"]].concat());
    let weak = demo(&[&space[..], &["motion.scale.factor=0.3"]].concat());
    let compared = sides(&[("strong", strong.clone()), ("weak", weak.clone())]);
    let mut fallen = Vec::new();
    for (side, scenario) in compared.iter().zip([&strong, &weak]) {
        let alone = answer(scenario, RunChoice::Typical, &mut go).unwrap();
        assert_eq!(side.summary.ensemble(), alone.summary.ensemble.as_ref());
        let own: Vec<_> = alone.cases[1..].iter().map(|case| case.result.collapsed()).collect();
        assert_eq!(side.collapsed, [(Some("spatial"), own)]);
        fallen.push(alone.summary.ensemble.unwrap().collapsed);
    }
    // The case is one in which the two differ.
    assert!(fallen[0] > 0 && fallen[1] == 0, "{fallen:?}");
    assert_eq!(compared[0].summary.variant(), compared[1].summary.variant());
    let paired = &Comparison::of(&compared, Vec::new()).paired;
    assert_eq!(paired.len(), 1);
    assert_eq!((paired[0].view, paired[0].pairs()), (Some("spatial"), 4));
    assert_eq!(paired[0].collapsed().as_slice(), fallen);
    let document = compare::document(&compared);
    let said = format!("0 of 4 variants collapse, down from {}", fallen[0]);
    assert!(document.verdict.headline.contains(&said), "{}", document.verdict.headline);
    let Block::Players(players) = &document.blocks[0] else { panic!("players come first") };
    assert!(players.panes.iter().all(|pane| pane.scene.depth.is_some()));
    let plots = barrelstack_report::figures(&document).into_iter().map(|(name, _)| name);
    let plots: Vec<String> = plots.filter(|name| name.contains("displacements")).collect();
    assert_eq!(
        plots,
        [
            "top-displacements-across",
            "top-displacements-along",
            "base-displacements-across",
            "base-displacements-along"
        ]
    );
}

#[test]
fn a_plane_and_space_are_compared_on_one_page() {
    let none = "imperfections.variants=0";
    let compared =
        sides(&[("in planes", demo(&[none])), ("in space", demo(&[none, "stack.view=spatial"]))]);
    assert!(matches!(compared[0].summary, AnySummary::Planar(_)));
    assert!(matches!(compared[1].summary, AnySummary::Spatial(_)));
    let document = compare::document(&compared);
    assert!(document.verdict.sentences.iter().any(|one| one.starts_with("B, in space: ")));
    // Variants of different models are not pairs.
    assert!(Comparison::of(&compared, Vec::new()).paired.is_empty());
}

/// Returns the first time (s) at which a body of two runs with frames at equal times is farther apart than the limit.
fn apart(one: &Run, other: &Run) -> Option<f64> {
    let frames = one.frames.poses.iter().zip(&other.frames.poses).zip(&one.frames.times);
    let mut frames = frames.filter(|((a, b), _)| {
        let place =
            |poses: &Vec<[f64; 7]>, body: usize, axis: usize| poses[body][axis] - poses[0][axis];
        (1..a.len()).any(|body| {
            let way = |axis| place(b, body, axis) - place(a, body, axis);
            (way(0).powi(2) + way(1).powi(2) + way(2).powi(2)).sqrt() > APART
        })
    });
    frames.next().map(|(_, time)| *time)
}

#[test]
fn the_repeats_of_a_run_in_space_are_runs_with_these_changes() {
    let stated =
        demo(&["stack.view=spatial", "imperfections.variants=0", "motion.scale.factor=2.5"]);
    let base = run(&stated).unwrap();
    let found = verify(&base, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(found.repeats.len(), 1 + usize::try_from(DISTURBED).unwrap());
    assert!(found.skipped[0].reason.contains("no contact nodes"));
    let mut finer = stated.clone();
    finer.run.step = Some(0.5 * base.simulation.time_step);
    let finer = run(&finer).unwrap();
    let (repeat, own) = (&found.repeats[0], summary::of(&finer, &stated).outcome.common);
    assert_eq!(repeat.change, "half the step");
    assert_eq!(finer.simulation.time_step, 0.5 * base.simulation.time_step);
    let facts = |of: &barrelstack::summary::OutcomeSummary| {
        (of.kind, of.mode, of.time, of.first.clone(), of.first_fall, of.barrels_fallen)
    };
    assert_eq!(facts(&repeat.outcome), facts(&own));
    assert!(own.mode.is_some(), "the stack falls");
    // The repeat is compared between its frames, whose times differ by less than a step.
    if let (Some(directly), Some(found)) = (apart(&base, &finer), repeat.apart_at) {
        assert!((directly - found).abs() < 0.1, "{directly} {found}");
    } else {
        assert_eq!(apart(&base, &finer), repeat.apart_at);
    }
    // Barrels displaced by a nanometer take another course, which is still the same at first.
    assert!(found.repeats[1..].iter().all(|one| one.apart_at.is_none_or(|time| time > 0.5)));
    assert!(base.falls().iter().any(Option::is_some));
}

#[test]
fn the_report_on_paper_has_the_headline_and_the_views_of_the_page() {
    let scenario = demo(&["stack.view=spatial", "imperfections.variants=2"]);
    let answer = AnyAnswer::of(&scenario, RunChoice::Typical, &mut go).unwrap();
    let document = answer.document();
    let pdf = lopdf::Document::load_mem(&document_pdf(&document, Paper::A4)).unwrap();
    let pages: Vec<u32> = pdf.get_pages().keys().copied().collect();
    let text = pdf.extract_text(&pages).unwrap();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // Numbers and their units do not break on the page.
    let page = html(&document).replace('\u{a0}', " ");
    for words in
        [answer.headline().as_str(), "Across the barrels", "Along the barrels", "From above"]
    {
        assert!(text.contains(words), "{words}: {text}");
        assert!(page.contains(words), "{words}");
    }
    // Both state which run is shown, and the page states this above the pictures.
    let shown = &document.verdict.shown;
    assert!(
        shown.starts_with("The run that is shown is ") && text.contains(shown.as_str()),
        "{shown}"
    );
    assert!(page.find(shown.as_str()).unwrap() < page.find("<figure").unwrap());
    for words in [
        "before the first loss of a seat or, if no seat is lost, during the whole run",
        "until the first loss of a seat or, if no seat is lost, over the whole run",
        "Force on the upper body of each pair in the run that is shown",
        "The times of the first fall are only those of variants in which a barrel falls",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(document.untranslated(Language::Spanish), Vec::<String>::new());
}
