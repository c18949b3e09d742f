//! Rankings of protections: all are run under the same motions, resume after an interruption, and report what was not
//! tried.

use barrelstack_report::html;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::Scenario;
use barrelstack_campaign::Direction;
use barrelstack_campaign::decision::SiteHazard;
use barrelstack_campaign::protect::{ProtectError, Ranking, Reached, Request, Shaking, protect};
use barrelstack_campaign::study::{RunOptions, StudyError, StudyTable};

/// Returns a request for a stack of two levels, with four motions and two rounds.
fn request() -> Request {
    let changes = ["stack.levels=2", "motion.scale.factor=1"].map(str::to_owned);
    Request {
        scenario: Scenario::builtin("candia-8-barrels", &changes).unwrap(),
        shaking: Shaking::Levels(vec![0.6]),
        records: Vec::new(),
        folder: None,
        motions: 4,
        rounds: 2,
        // A low budget leaves enough cheap protections to rank.
        budget: Some(130.0),
        seed: 3,
    }
}

fn ranking(request: &Request, folder: &Path) -> Result<Ranking, ProtectError> {
    protect(request, folder, &RunOptions::default(), &|_| ControlFlow::Continue(()))
}

fn json(ranking: &Ranking) -> String {
    serde_json::to_string_pretty(&ranking.to_document()).unwrap()
}

/// Returns for every case of a study its motion, and its friction on the floor relative to that of the scenario.
fn shaken(folder: &Path) -> Vec<(String, String)> {
    let table =
        StudyTable::from_parquet(std::fs::read(folder.join("table.parquet")).unwrap()).unwrap();
    let records = table.texts("record").unwrap();
    let friction = table.numbers("friction rack-ground").unwrap();
    let words = |record: &Option<String>| record.clone().unwrap_or_default();
    records
        .iter()
        .zip(friction)
        .map(|(record, value)| (words(record), format!("{:.9}", value.unwrap())))
        .collect()
}

#[test]
fn all_protections_meet_the_same_motions_and_friction_and_a_stop_loses_no_bit() {
    let request = request();
    let (whole, stopped) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let found = ranking(&request, whole.path()).unwrap();

    // The stack as it is and with a device.
    let of =
        |key: &str, round: u32| shaken(&whole.path().join(key).join(format!("transverse-{round}")));
    assert_eq!(of("as-it-is", 1), of("chocks-in-the-top-level", 1));
    assert_ne!(of("as-it-is", 1), of("as-it-is", 2));
    assert_eq!(of("as-it-is", 1).len(), 4);

    // A ranking that is interrupted repeatedly has the same result, bit for bit.
    for most in [3, 9, 30] {
        let reports = AtomicUsize::new(0);
        let stop = |_: Reached| {
            if reports.fetch_add(1, Ordering::Relaxed) < most {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let result = protect(&request, stopped.path(), &RunOptions::default(), &stop);
        assert!(matches!(result, Err(ProtectError::Study(StudyError::Stopped))), "{most}");
    }
    let resumed = ranking(&request, stopped.path()).unwrap();
    assert_eq!(json(&found), json(&resumed));
    assert_eq!(html(&found.document), html(&resumed.document));

    // The headline states the confidence and the number of motions for the recommended stack, or for the stack as it
    // is.
    let headline = &found.document.verdict.headline;
    assert!(
        headline.contains("(95 % confidence)") && headline.contains(" motions")
            || found.best().is_none(),
        "{headline}"
    );

    // The number of tries is the same in the sentence, on the page and in the JSON, without the stack as it is.
    let tries = (found.all.len() - 1).to_string();
    let said = &found.document.verdict.sentences;
    assert!(
        said.iter().any(|one| one.starts_with(&format!("{tries} protections were tried"))),
        "{said:?}"
    );
    let of_page =
        found.document.provenance.iter().find(|(name, _)| name.starts_with("protections tried"));
    assert_eq!(of_page.map(|(_, value)| value), Some(&tries));
    assert_eq!(
        serde_json::from_str::<serde_json::Value>(&json(&found)).unwrap()["tries"].to_string(),
        tries
    );
    assert!(!html(&found.document).contains("-0.00"));

    // The changes of every tried protection give a valid scenario.
    let mut kinds = BTreeMap::<&str, usize>::new();
    for one in &found.all {
        *kinds.entry(one.protection.kind.name()).or_default() += 1;
        assert!(one.fallen.low <= one.fallen.mean && one.fallen.mean <= one.fallen.high);
        let changed = one.protection.on(&request.scenario).unwrap();
        assert_eq!(
            changed.fingerprint() == request.scenario.fingerprint(),
            one.protection.changes.is_empty()
        );
    }
    assert!(kinds["device"] >= 2 && kinds["as-it-is"] == 1, "{kinds:?}");
    let reason = |name: &str| {
        found.not_tried.iter().find(|(known, _)| known == name).map(|(_, why)| why.as_str())
    };
    assert!(reason("1 level").unwrap().contains("US$400, above the budget of US$130"));
    assert!(reason("chocks in the top three levels").unwrap().contains("the stack has only 2"));
}

#[test]
fn a_protection_above_the_budget_is_reported_and_not_tried() {
    let folder = tempfile::tempdir().unwrap();
    let request = Request { budget: Some(0.0), rounds: 1, ..request() };
    let found = ranking(&request, folder.path()).unwrap();
    assert_eq!(found.all.len(), 1);
    assert!(found.best().is_none());
    assert!(found.not_tried.iter().all(|(_, reason)| reason.contains("above the budget of US$0")));
    assert!(
        found
            .document
            .verdict
            .headline
            .contains("No protection that was tried helps significantly")
    );
}

#[test]
fn a_free_scene_and_a_hazard_over_another_measure_are_refused_before_anything_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let free = Request { scenario: Scenario::builtin("sliding-block", &[]).unwrap(), ..request() };
    let said = ranking(&free, folder.path()).unwrap_err().to_string();
    assert!(said.contains("is a free scene"), "{said}");
    let text = "pga (g),rate (1/year)\n0.1,0.05\n0.5,0.005\n1.0,0.0005\n";
    let hazard = SiteHazard::parse("napa.csv", text).unwrap();
    let over = Request { shaking: Shaking::Site(hazard), ..request() };
    let said = ranking(&over, folder.path()).unwrap_err().to_string();
    assert!(said.contains("napa.csv is for pga") && said.contains("for pgv"), "{said}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_stack_that_stands_as_it_is_is_said_to_with_what_the_motions_can_prove() {
    let folder = tempfile::tempdir().unwrap();
    let weak = Shaking::Levels(vec![0.02]);
    let request = Request { shaking: weak, budget: Some(0.0), rounds: 1, ..request() };
    let headline = ranking(&request, folder.path()).unwrap().document.verdict.headline;
    assert!(headline.contains(" stands as it is: no barrel falls"), "{headline}");
    let bound = headline.split("the true frequency of collapse is at most ").nth(1);
    let percent =
        bound.and_then(|rest| rest.split(" % (95 % confidence)").next()?.parse::<f64>().ok());
    assert!(percent.is_some_and(|percent| (20.0..=100.0).contains(&percent)), "{headline}");
}

/// The shares of draws in sentence, page and JSON are those counted by brute force.
#[test]
fn the_order_over_constants_is_counted_in_draws_that_all_protections_share() {
    let folder = tempfile::tempdir().unwrap();
    let levels = Shaking::Levels(vec![0.4, 0.8]);
    let request =
        Request { shaking: levels, motions: 8, rounds: 1, budget: Some(60.0), ..request() };
    let found = ranking(&request, folder.path()).unwrap();
    let base = found.as_it_is().unwrap();
    assert!(base.draws.len() > 1000 && found.all.len() > 1, "{}", found.all.len());
    let count = |one: &[f64], other: &[f64]| {
        let less = one.iter().zip(other).filter(|(a, b)| a < b).count() as f64;
        let equal = one.iter().zip(other).filter(|(a, b)| a == b).count() as f64;
        (less + 0.5 * equal) / one.len() as f64
    };
    let document = serde_json::to_value(found.to_document()).unwrap();
    for (at, one) in found.all.iter().enumerate() {
        let row = &document["protections"][at];
        let [low, high] = one.range.unwrap();
        assert!(low <= high && row["range"] == serde_json::json!([low, high]));
        let brute = (one.protection != base.protection).then(|| count(&one.draws, &base.draws));
        assert_eq!(one.better_than_as_it_is, brute, "{}", one.protection.name);
        assert_eq!(row["better_than_as_it_is"].as_f64(), brute);
        let next = found.all.get(at + 1).map(|next| count(&one.draws, &next.draws));
        assert_eq!(one.better_than_next, next);
    }
    if let Some(best) = found.best() {
        // A share near 0 or 100 % has more digits in the sentence.
        let share = 100.0 * best.better_than_as_it_is.unwrap();
        let share =
            if (10.0..=99.0).contains(&share) { format!("{share:.0}") } else { String::new() };
        let said = &found.document.verdict.sentences;
        let words = format!("{share} % of the draws");
        assert!(
            said.iter().any(|one| one.replace('\u{a0}', " ").contains(&words)),
            "{words}: {said:?}"
        );
    }
}

/// In three dimensions the losses of the unprotected stack are the means of its cases.
#[test]
fn a_ranking_in_space_rests_on_cases_in_space() {
    let changes = ["stack.levels=2", "stack.view=spatial", "motion.scale.factor=1"];
    let scenario = Scenario::builtin("demo-napa", &changes.map(str::to_owned)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let request = Request { scenario, rounds: 1, budget: Some(0.0), ..request() };
    let found = ranking(&request, folder.path()).unwrap();
    let base = found.as_it_is().unwrap();
    assert_eq!((base.direction, base.runs), (Direction::Space, 4));
    let table = folder.path().join("as-it-is/spatial-1/table.parquet");
    let table = StudyTable::from_parquet(std::fs::read(table).unwrap()).unwrap();
    let outcomes = table.texts("outcome").unwrap().iter();
    let falls = outcomes.filter(|one| one.as_deref() == Some("collapse")).count();
    assert!((base.collapse.mean - falls as f64 / 4.0).abs() < 1e-12);
    let heights = table.texts("fall_heights").unwrap().iter().flatten();
    let fallen: usize =
        heights.map(|all| all.split(';').filter(|one| !one.is_empty()).count()).sum();
    assert!((base.fallen.mean - fallen as f64 / 4.0).abs() < 1e-12, "{fallen}");
    assert_eq!(table.numbers("direction of the motion").map(<[_]>::len), Some(4));
}
