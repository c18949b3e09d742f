//! The remedy of a stack: whether it suffices, and its wording.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::Scenario;
use barrelstack::variants::{self, Answer, Remedy, RunChoice, Tried, answer};

fn scenario(changes: &[&str]) -> Scenario {
    // Short, with few variants; of three levels one or two may stand.
    let own = [
        "stack.levels=3",
        "motion.sine.cycles=4",
        "run.stop_after_collapse=0.1 s",
        "imperfections.variants=8",
    ];
    let key = |change: &str| change.split('=').next().unwrap_or_default().to_owned();
    let kept = own.iter().filter(|one| changes.iter().all(|other| key(other) != key(one)));
    let changes: Vec<String> = kept.chain(changes).map(|&change| change.to_owned()).collect();
    Scenario::builtin("candia-8-barrels", &changes).unwrap()
}

fn answered(scenario: &Scenario) -> Answer {
    answer(scenario, RunChoice::Number(0), &mut |_| ControlFlow::Continue(())).unwrap()
}

fn remedy(answer: &Answer) -> Option<Remedy> {
    variants::remedy(answer, &|_| ControlFlow::Continue(())).unwrap()
}

/// Returns the number of collapses and of runs of a tried change, run by itself.
fn alone(base: &[&str], tried: &Tried) -> (u32, u32) {
    let changes: Vec<&str> =
        base.iter().copied().chain(tried.changes.iter().map(String::as_str)).collect();
    let spread = answered(&scenario(&changes)).decides.summary.ensemble.unwrap();
    (spread.collapsed + spread.broken, spread.run())
}

#[test]
fn what_is_said_to_suffice_is_what_its_command_makes_and_stands_in_as_many_variants() {
    let mut kinds = Vec::new();
    for base in [&[][..], &["motion.scale.factor=0.7"][..]] {
        let answer = answered(&scenario(base));
        let Some(found) = remedy(&answer) else { panic!("{base:?} stands") };
        assert!(found.complete && !found.tried.is_empty());
        for one in found.height.iter().chain(&found.straps) {
            let (failed, run) = alone(base, one);
            assert_eq!((failed, run), (one.failed, one.variants), "{one:?}");
            assert!(one.is_enough() && run == 8 && failed == 0, "{one:?}");
            // For two levels and five pretensions, in one plane, at 1 − 0.05/7: 1 − (0.025/7)^(1/8).
            assert_eq!((one.share, found.candidates), (Some(0.0), 7));
            let [low, high] = one.interval.unwrap();
            assert!(low == 0.0 && (high - 0.505_6).abs() < 1e-3, "{high}");
            kinds.push(one.kind);
        }
        // A rejected change has counts of the variants that were run and no share.
        for one in found.tried.iter().filter(|one| one.variants < 8) {
            assert!(!one.is_enough() && one.share.is_none() && one.interval.is_none(), "{one:?}");
        }
        // Insufficient changes with all variants failed more often than admissible.
        for one in found.tried.iter().filter(|one| one.is_rejected() && one.variants == 8) {
            assert_eq!(alone(base, one), (one.failed, 8), "{one:?}");
        }
        // The smallest change: the next level up was tried, and fails.
        if let Some(height) = &found.height {
            let above =
                found.tried.iter().filter(|one| one.kind == "height" && one.levels > height.levels);
            assert!(above.clone().all(Tried::is_rejected));
            assert_eq!(above.count(), 2 - height.levels as usize);
        }
    }
    assert!(kinds.contains(&"height"), "{kinds:?}");
}

/// The range of a change is that of the changed stack, run by itself; its draws are those of the stack as it is.
#[test]
fn a_change_has_the_range_of_the_changed_stack_and_its_order_in_draws() {
    let base = ["imperfections.variants=16", "motion.scale.factor=0.7"];
    let found = remedy(&answered(&scenario(&base))).unwrap();
    let whole: Vec<&Tried> = found.tried.iter().filter(|one| one.share.is_some()).collect();
    assert!(!whole.is_empty());
    for one in whole {
        let changes: Vec<&str> =
            base.into_iter().chain(one.changes.iter().map(String::as_str)).collect();
        let spread = answered(&scenario(&changes)).decides.summary.ensemble.unwrap();
        assert!(spread.range.is_some());
        assert_eq!(one.range, spread.range, "{one:?}");
        let better = one.better_than_as_it_is.unwrap();
        assert!((0.0..=1.0).contains(&better) && (!one.is_enough() || better > 0.6), "{one:?}");
    }
    for one in found.tried.iter().filter(|one| one.share.is_none()) {
        assert_eq!((one.range, one.better_than_as_it_is), (None, None), "{one:?}");
    }
    let both = found.height.is_some() && found.straps.is_some();
    assert_eq!(found.height_before_straps.is_some(), both);
    let suffices = found.height.iter().chain(&found.straps).count();
    assert_eq!(found.sentence().contains("(95 % range)"), suffices > 0);
    // Without drawn constants there is no range.
    let known = [&base[..], &["unknowns.drawn=false"]].concat();
    let found = remedy(&answered(&scenario(&known))).unwrap();
    assert!(found.tried.iter().all(|one| one.range.is_none()));
    assert!(!found.sentence().contains("range"));
}

#[test]
fn nothing_is_looked_for_where_the_stack_stands_or_its_motion_is_cut_short() {
    assert_eq!(remedy(&answered(&scenario(&["motion.scale.factor=0.01"]))), None);
    assert_eq!(remedy(&answered(&scenario(&["imperfections.variants=0"]))), None);
    assert_eq!(remedy(&answered(&scenario(&["run.duration=2 s"]))), None);
}

#[test]
fn a_search_that_is_stopped_says_so_and_states_nothing() {
    let answer = answered(&scenario(&[]));
    let asked = AtomicUsize::new(0);
    let found = variants::remedy(&answer, &|_| {
        asked.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Break(())
    });
    let found = found.unwrap().unwrap();
    assert!(!found.complete && found.height.is_none() && found.straps.is_none());
    assert_eq!(
        found.sentence(),
        "The changes that would have kept the stack up are not known, because the search was stopped."
    );
    assert!(asked.into_inner() < 100);
}

#[test]
fn sentences_say_what_suffices_and_what_does_not() {
    let tried = |kind, levels, pretension, failed| Tried {
        kind,
        levels,
        pretension,
        changes: Vec::new(),
        suffices: Some(failed < 4),
        variants: 64,
        failed,
        share: Some(f64::from(failed) / 64.0),
        interval: Some([0.0, 0.09 + 0.03 * f64::from(failed)]),
        range: None,
        better_than_as_it_is: None,
    };
    let height = |failed| tried("height", 3, None, failed);
    let straps = |failed| tried("straps", 5, Some(4e3), failed);
    let said = |height: Option<Tried>, straps: Option<Tried>, all: &[Tried]| {
        let (tried, comparison) = (all.to_vec(), None);
        Remedy {
            required_share: 0.95,
            height,
            straps,
            height_before_straps: None,
            candidates: 9,
            variants: 64,
            tried,
            complete: true,
            comparison,
        }
        .sentence()
    };
    let both = [height(1), straps(1)];
    for (height, straps, all, words) in [
        (
            Some(height(1)),
            Some(straps(1)),
            &both[..],
            "A stack of three levels, or of five levels held together by straps tightened to 4 kN, would have stood in \
             63 of 64 variants. At most 12 % of stacks with either change would fall (95 % confidence, corrected for \
             testing up to 9 changes).",
        ),
        (
            Some(height(1)),
            Some(straps(0)),
            &both,
            "A stack of three levels would have stood in 63 of 64 variants, and a stack of five levels held together \
             by straps tightened to 4 kN in all 64 variants. At most 12 % of stacks with the first change and 9 % of \
             stacks with the second would fall (95 % confidence, corrected for testing up to 9 changes).",
        ),
        (
            Some(height(0)),
            None,
            &both,
            "A stack of three levels would have stood in all 64 variants. Straps tightened to 4 kN would not have been \
             enough. At most 9 % of stacks with three levels would fall (95 % confidence, corrected for testing up to \
             9 changes).",
        ),
        (
            None,
            Some(straps(0)),
            &both,
            "A stack of five levels held together by straps tightened to 4 kN would have stood in all 64 variants; \
             fewer levels without straps would not have been enough. At most 9 % of stacks with five levels held \
             together by straps tightened to 4 kN would fall (95 % confidence, corrected for testing up to 9 changes).",
        ),
        (
            None,
            None,
            &both,
            "Neither fewer levels (down to one) nor straps tightened to 4 kN would have kept the stack up.",
        ),
    ] {
        assert_eq!(said(height, straps, all), words);
    }
}

#[test]
fn sentences_say_which_levels_were_tried_and_not_enough() {
    let tried = |kind, levels, pretension, suffices| Tried {
        kind,
        levels,
        pretension,
        changes: Vec::new(),
        suffices: Some(suffices),
        variants: 16,
        failed: if suffices { 0 } else { 8 },
        share: None,
        interval: None,
        range: None,
        better_than_as_it_is: None,
    };
    // The levels that were tried, from the highest to the lowest, of which the lowest suffices.
    let said = |levels: &[u32], straps: &[(f64, bool)], complete| {
        let last = levels.last().copied();
        let levels = levels.iter().map(|count| tried("height", *count, None, Some(*count) == last));
        let straps = straps
            .iter()
            .map(|(pretension, suffices)| tried("straps", 5, Some(*pretension), *suffices));
        let all: Vec<Tried> = levels.chain(straps).collect();
        let first = |kind| all.iter().find(|one| one.kind == kind && one.is_enough()).cloned();
        let (height, straps) = (first("height"), first("straps"));
        Remedy { height, straps, tried: all, complete, ..Remedy::default() }.sentence()
    };
    let loose = [(3e3, false), (5e3, false)];
    for (levels, straps, words) in [
        (
            &[4, 3, 2, 1][..],
            &loose[..],
            "A stack of one level would have stood in all 16 variants. A stack of two to four levels, or \
             straps tightened to 3 or 5 kN, would not have been enough.",
        ),
        (
            &[4, 3, 2],
            &loose,
            "A stack of two levels would have stood in all 16 variants. A stack of three or four levels, or \
             straps tightened to 3 or 5 kN, would not have been enough.",
        ),
        (
            &[4, 3],
            &[],
            "A stack of three levels would have stood in all 16 variants. A stack of four levels would not have been \
             enough.",
        ),
        // The next lower stack suffices.
        (
            &[4],
            &loose,
            "A stack of four levels would have stood in all 16 variants. Straps tightened to 3 or 5 kN would not have \
             been enough.",
        ),
        (&[4], &[], "A stack of four levels would have stood in all 16 variants."),
        (
            &[4, 3],
            &[(3e3, false), (4e3, true)],
            "A stack of three levels, or of five levels held together by straps tightened to 4 kN, would have stood in \
             all 16 variants. A stack of four levels without these straps would not have been enough.",
        ),
    ] {
        assert_eq!(said(levels, straps, true), words);
    }
    // Of the straps nothing is known if their search was stopped.
    assert_eq!(
        said(&[4, 3], &loose, false),
        "A stack of three levels would have stood in all 16 variants. A stack of four levels would not have been \
         enough. The search for further changes was stopped."
    );
}

/// The progress states the changed stack, the number of its runs and the place of the change in the search; no number
/// exceeds its total.
#[test]
fn the_progress_of_a_search_has_names_and_totals() {
    for (view, things, of) in [("transverse", "variants", 8), ("both", "runs", 16)] {
        let view = format!("stack.view={view}");
        let answer = answered(&scenario(&[&view]));
        let seen = Mutex::new(Vec::new());
        let found = variants::remedy(&answer, &|attempt| {
            let counts = (attempt.number, attempt.candidates, attempt.done, attempt.of);
            let now = (attempt.stack.to_owned(), counts, attempt.to_string());
            let mut seen = seen.lock().unwrap();
            if seen.last() != Some(&now) {
                seen.push(now);
            }
            ControlFlow::Continue(())
        });
        let (found, seen) = (found.unwrap().unwrap(), seen.into_inner().unwrap());
        // Heights and straps are tried at the same time, so their reports may arrive in any order.
        let mut stacks: BTreeMap<usize, &str> = BTreeMap::new();
        for (stack, (number, candidates, done, total), words) in &seen {
            assert_eq!(*stacks.entry(*number).or_insert(stack), stack);
            assert_eq!((*candidates, *total), (found.candidates as usize, of));
            assert!(number <= candidates && done <= total, "{words}");
            assert_eq!(
                words,
                &format!(
                    "testing {stack}: {done} of {of} {things} (change {number} of up to {candidates})"
                )
            );
        }
        let numbers: Vec<usize> = stacks.keys().copied().collect();
        assert_eq!(numbers, (1..=found.tried.len()).collect::<Vec<_>>(), "{stacks:?}");
        let names: BTreeSet<&str> = stacks.into_values().collect();
        assert!(names.contains("a stack of two levels"), "{names:?}");
        assert_eq!(names.len(), found.tried.len(), "{names:?}");
    }
}

#[test]
fn sentences_say_what_the_uncertain_constants_leave_open() {
    let tried = |kind, levels, pretension, range| Tried {
        kind,
        levels,
        pretension,
        changes: Vec::new(),
        suffices: Some(true),
        variants: 64,
        failed: 0,
        share: Some(0.0),
        interval: None,
        range: Some(range),
        better_than_as_it_is: Some(0.98),
    };
    let said = |height, straps, order| {
        let found = Remedy {
            height,
            straps,
            height_before_straps: order,
            complete: true,
            ..Remedy::default()
        };
        found.sentence().split_once(" Depending on the true values of ").unwrap().1.to_owned()
    };
    let height = |high| Some(tried("height", 3, None, [0.0, high]));
    let straps = |high| Some(tried("straps", 5, Some(4e3), [0.0, high]));
    let seats = "the friction, stiffness and damping of the seats, which are uncertain, ";
    for (found, words) in [
        (
            said(height(0.08), straps(0.12), Some(0.71)),
            "0 to 8 % of stacks with the first change and 0 to 12 % of stacks with the second would fall (95 % \
             range); fewer stacks fall with three levels than with five levels held together by straps tightened to \
             4 kN in 71 % of the random draws of these constants.",
        ),
        (
            said(height(0.08), straps(0.08), Some(0.4)),
            "0 to 8 % of stacks with either change would fall (95 % range); fewer stacks fall with five levels \
             held together by straps tightened to 4 kN than with three levels in 60 % of the random draws of these \
             constants.",
        ),
        (
            said(height(0.08), None, None),
            "0 to 8 % of stacks with three levels would fall (95 % range).",
        ),
    ] {
        assert_eq!(found, format!("{seats}{words}"));
    }
    // The bound of the average share may be less than the end of the range over the constants.
    let bounded = Tried { interval: Some([0.0, 0.06]), ..tried("height", 3, None, [0.0, 0.25]) };
    let found = Remedy { height: Some(bounded), complete: true, ..Remedy::default() };
    let sentence = found.sentence();
    let both = " On average over the friction, stiffness and damping of the seats, which are uncertain, at most 6 % of \
                stacks with three levels would fall (95 % confidence). Depending on the true values of these constants, 0 \
                to 25 % of stacks with three levels would fall (95 % range).";
    assert!(sentence.ends_with(both), "{sentence}");
}
