//! RockScore: the smallest velocity of all states and directions, equal after an interruption, refused without a rack.

use barrelstack_report::html;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::Scenario;
use barrelstack_campaign::score::{Capacity, Protocol, ScoreError, Sheet, score};
use barrelstack_campaign::study::{RunOptions, StudyError};

/// Returns a short protocol: stacks of two levels under three motions.
fn brief(velocities: &[f64]) -> Protocol {
    let velocities = velocities.to_vec();
    Protocol { levels: 2, velocities, periods: vec![1.2], synthetic: 0, ..Protocol::rockscore() }
}

fn scored(scenario: &Scenario, protocol: &Protocol, folder: &Path) -> Result<Sheet, ScoreError> {
    score(scenario, protocol, folder, &RunOptions::default(), &|_, _| ControlFlow::Continue(()))
}

fn demo(changes: &[&str]) -> Scenario {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scenario::builtin("demo-napa", &changes).unwrap()
}

#[test]
fn the_score_is_the_least_of_all_states_and_directions_and_a_stop_loses_no_bit() {
    let protocol = brief(&[0.3, 0.9, 2.4]);
    let chocked = demo(&["stack.chock.levels=1"]);
    let (whole, stopped) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let sheet = scored(&chocked, &protocol, whole.path()).unwrap();

    let least = sheet.rows.iter().map(|row| row.capacity.velocity()).fold(f64::MAX, f64::min);
    assert_eq!(f64::from(sheet.score()), (100.0 * least + 1e-6).floor());
    // The states new, wet, and worn chocks, in two directions; no run is missing.
    let worn = chocked.stack().unwrap().devices.present()[0].degraded.len();
    assert!(worn > 0);
    assert_eq!(sheet.rows.len(), 2 * (2 + worn));
    assert!(sheet.rows.iter().all(|row| (row.runs, row.left_out) == (9, 0)));
    // At the strongest shaking at least six runs collapse; at the weakest none does.
    let at = |velocity| sheet.rows.iter().map(move |row| row.at(velocity).unwrap().failures);
    assert_eq!(at(0.3).sum::<u32>(), 0);
    assert!(at(2.4).sum::<u32>() >= 6);

    let reports = AtomicUsize::new(0);
    let stop = |_, _| {
        if reports.fetch_add(1, Ordering::Relaxed) < 20 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let result = score(&chocked, &protocol, stopped.path(), &RunOptions::default(), &stop);
    assert!(matches!(result, Err(ScoreError::Study(StudyError::Stopped))));
    let resumed = scored(&chocked, &protocol, stopped.path()).unwrap();
    assert_eq!(html(&sheet.document), html(&resumed.document));
}

#[test]
fn what_no_shaking_of_a_protocol_brings_down_has_its_strongest_as_score_at_least() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = scored(&demo(&[]), &brief(&[0.02, 0.05]), folder.path()).unwrap();
    assert!(sheet.rows.iter().all(|row| row.capacity == Capacity::Above(0.05)));
    assert_eq!(sheet.score(), 5);
    assert!(sheet.document.verdict.headline.contains("RockScore of at least 5"));
}

#[cfg(unix)]
#[test]
fn a_folder_of_somebody_else_leads_no_state_out_of_it() {
    let (place, protocol) = (tempfile::tempdir().unwrap(), brief(&[0.02]));
    let (outside, folder) = (place.path().join("outside"), place.path().join("score"));
    for folder in [&outside, &folder] {
        std::fs::create_dir(folder).unwrap();
    }
    std::os::unix::fs::symlink(&outside, folder.join("as-good-as-new")).unwrap();
    let said = scored(&demo(&[]), &protocol, &folder).unwrap_err();
    let said = std::error::Error::source(&said).map_or(said.to_string(), ToString::to_string);
    assert!(said.contains("is a link, not a folder"), "{said}");
    assert_eq!(std::fs::read_dir(&outside).unwrap().count(), 0);
}

#[test]
fn a_scene_without_racks_has_no_score() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scenario::builtin("sliding-block", &[]).unwrap();
    let refused = scored(&scene, &Protocol::rockscore(), folder.path()).unwrap_err();
    assert!(refused.to_string().contains("use the scenario of a stack"), "{refused}");
}
