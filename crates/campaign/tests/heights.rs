//! Safe heights: requests are checked before anything is run, and an interruption keeps finished runs.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use barrelstack_campaign::Direction;
use barrelstack_campaign::heights::{HeightsError, Request, VELOCITIES, heights};
use barrelstack_campaign::study::{RunOptions, StudyError, StudyTable};
use barrelstack_report::html;

fn stopped_at_once(request: &Request) -> (Result<(), HeightsError>, u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let all = AtomicU64::new(0);
    let result = heights(request, folder.path(), &RunOptions::default(), &|_, of| {
        all.store(of, Ordering::Relaxed);
        ControlFlow::Break(())
    });
    (result.map(drop), all.load(Ordering::Relaxed))
}

#[test]
fn every_height_direction_motion_and_level_is_a_run() {
    let request = Request { synthetic: 3, ..Request::default() };
    let (result, runs) = stopped_at_once(&request);
    assert!(matches!(result, Err(HeightsError::Study(StudyError::Stopped))), "{result:?}");
    // Two components of the bundled record and three synthetic motions, and the record unscaled; two to six levels.
    let stacks = 5 * request.directions().len();
    assert_eq!(usize::try_from(runs).unwrap(), stacks * (VELOCITIES.len() * 5 + 2));
    let (_, fewer) = stopped_at_once(&Request { highest: 2, ..request.clone() });
    assert_eq!(5 * fewer, runs);
    // In three dimensions there is one direction instead of two.
    let (_, in_space) = stopped_at_once(&Request { in_space: true, ..request });
    assert_eq!(2 * in_space, runs);
}

#[test]
fn an_unknown_rack_is_refused_with_those_there_are() {
    let request = Request { rack: "shelf".into(), ..Request::default() };
    let said = stopped_at_once(&request).0.expect_err("no such rack").to_string();
    assert_eq!(
        said,
        "there is no rack `shelf`; use one of two-barrel, two-barrel-feet, single-bar, four-barrel, rack-on-rack, two-barrel-inclined, candia-2008"
    );
}

#[test]
fn a_rack_that_space_does_not_support_is_refused_before_anything_is_run() {
    let request = Request { rack: "rack-on-rack".into(), in_space: true, ..Request::default() };
    let (result, runs) = stopped_at_once(&request);
    let said = result.expect_err("racks on posts").to_string();
    assert!(
        said.contains("three-dimensional stacks support only racks that lie on the barrels below"),
        "{said}"
    );
    assert_eq!(runs, 0);
}

#[test]
fn a_record_that_is_not_there_is_refused_before_anything_is_run() {
    let request = Request { records: vec!["no-such-file.AT2".into()], ..Request::default() };
    let said = stopped_at_once(&request).0.expect_err("no such file").to_string();
    assert!(said.contains("no-such-file.AT2"), "{said}");
}

/// The range of every height at every level is the same in the results, in the JSON and on the page.
#[test]
fn ranges_over_constants_are_the_same_wherever_they_are_stated() {
    let folder = tempfile::tempdir().unwrap();
    let request = Request { synthetic: 3, highest: 2, ..Request::default() };
    let report = |_, _| ControlFlow::Continue(());
    let found = heights(&request, folder.path(), &RunOptions::default(), &report).unwrap();
    let document = serde_json::to_value(found.to_document()).unwrap();
    let page = html(&found.document).replace('\u{a0}', " ");
    for (height, row) in found.heights.iter().zip(document["heights"].as_array().unwrap()) {
        assert_eq!(height.effects.len(), VELOCITIES.len());
        for (at, velocity) in VELOCITIES.into_iter().enumerate() {
            let [low, high] = height.at(velocity).unwrap().range.unwrap();
            let effect = height.effects[at].as_ref().unwrap();
            assert_eq!(effect.range, [low, high]);
            assert!(low <= effect.as_stated && effect.as_stated <= high);
            assert_eq!(effect.decides.len(), 6);
            assert_eq!(row["at"][at]["range"], serde_json::json!([low, high]));
            assert_eq!(row["at"][at]["share_as_stated"].as_f64(), Some(effect.as_stated));
            let decides = &row["at"][at]["decides"]["name"];
            assert_eq!(decides.as_str(), height.decisive(velocity).map(|one| one.name));
        }
    }
    // The page states the range in the direction in which its upper end is higher.
    for velocity in VELOCITIES {
        let ranges = found.heights.iter().filter_map(|height| height.at(velocity)?.range);
        let [low, high] = ranges.reduce(|a, b| if b[1] >= a[1] { b } else { a }).unwrap();
        let words = format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high);
        assert!(page.contains(&words), "{words}");
    }
    // In stronger shaking the upper end of the widest range is higher.
    let highest =
        |at: usize| found.heights.iter().map(move |h| h.effects[at].as_ref().unwrap().range[1]);
    assert!(highest(0).fold(0.0, f64::max) < highest(5).fold(0.0, f64::max));
}

/// Three-dimensional studies of heights have the same statistics as studies in planes; each run draws its horizontal
/// direction.
#[test]
fn heights_in_space_have_ranges_over_constants() {
    let folder = tempfile::tempdir().unwrap();
    let request = Request { synthetic: 2, highest: 2, in_space: true, ..Request::default() };
    let report = |_, _| ControlFlow::Continue(());
    let found = heights(&request, folder.path(), &RunOptions::default(), &report).unwrap();
    assert_eq!((found.heights.len(), found.runs), (1, 4 * VELOCITIES.len() + 2));
    let height = found.of(2, Direction::Space).unwrap();
    let margin = height.static_margin.unwrap();
    assert!(margin > 1.0 && margin < 9.8, "{margin}");
    let document = serde_json::to_value(found.to_document()).unwrap();
    let row = &document["heights"][0];
    assert_eq!(row["direction"], "spatial");
    let page = html(&found.document).replace('\u{a0}', " ");
    for (at, velocity) in VELOCITIES.into_iter().enumerate() {
        let [low, high] = height.at(velocity).unwrap().range.unwrap();
        assert_eq!(row["at"][at]["range"], serde_json::json!([low, high]));
        let words = format!("{:.0}–{:.0} %", 100.0 * low, 100.0 * high);
        assert!(page.contains(&words), "{words}");
    }
    // Something falls in the strongest shaking, and the direction is a column of the table.
    assert!(height.at(1.0).unwrap().stripe.failures > height.at(0.12).unwrap().stripe.failures);
    let table = std::fs::read(folder.path().join("spatial/table.parquet")).unwrap();
    let table = StudyTable::from_parquet(table).unwrap();
    let turned = table.numbers("direction of the motion").unwrap();
    assert!(turned.windows(2).any(|pair| pair[0] != pair[1]));
}
