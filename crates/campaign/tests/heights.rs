//! Safe heights: requests are checked before anything is run, and an interruption keeps finished runs.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use barrelstack_campaign::heights::{HeightsError, Request, VELOCITIES, View, heights};
use barrelstack_campaign::study::{RunOptions, StudyError};

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
    let stacks = 5 * View::ALL.len();
    assert_eq!(usize::try_from(runs).unwrap(), stacks * (VELOCITIES.len() * 5 + 2));
    let (_, fewer) = stopped_at_once(&Request { highest: 2, ..request });
    assert_eq!(5 * fewer, runs);
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
fn a_record_that_is_not_there_is_refused_before_anything_is_run() {
    let request = Request { records: vec!["no-such-file.AT2".into()], ..Request::default() };
    let said = stopped_at_once(&request).0.expect_err("no such file").to_string();
    assert!(said.contains("no-such-file.AT2"), "{said}");
}
