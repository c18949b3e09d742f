//! Tests of individual parts of the library.
//!
//! They are here rather than in the library, so that the tests compile the lanes of the library only once.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack_stack::demand::{DEMANDS, Demands};
use barrelstack_stack::{pool, step};

#[test]
fn keys_in_files_are_those_of_the_list_in_its_order() {
    let written = serde_json::to_string(&Demands::default()).unwrap();
    let places: Vec<usize> =
        DEMANDS.iter().map(|d| written.find(&format!("\"{}\":", d.name)).unwrap()).collect();
    assert!(places.is_sorted(), "{written}");
    assert_eq!(written.matches(':').count(), DEMANDS.len());
    let tilt = DEMANDS.iter().find(|demand| demand.name == "rack_tilt_peak").unwrap();
    assert_eq!(tilt.factor, 180.0 / std::f64::consts::PI);
}

#[test]
fn results_keep_the_order_of_their_tasks() {
    let tasks: Vec<usize> = (0..200).collect();
    let reported = AtomicUsize::new(0);
    let squares = pool::map(&tasks, |task| task * task, &|done| {
        reported.fetch_max(done, Ordering::Relaxed);
    });
    assert_eq!(squares, tasks.iter().map(|task| task * task).collect::<Vec<_>>());
    assert_eq!(reported.into_inner(), 200);
    assert!(pool::map(&[] as &[usize], |task| *task, &|_| ()).is_empty());
}

#[test]
fn steps_are_round_numbers() {
    for (value, kept) in [(1.4e-4, 1.2e-4), (2.7e-4, 2.5e-4), (9.9e-4, 8e-4), (1.0e-3, 1e-3)] {
        assert!((step::round_down(value) / kept - 1.0).abs() < 1e-12, "{value}");
    }
}

/// With `[lib] test = false`, tests in the sources would silently not run.
#[test]
fn no_test_stands_in_the_sources_of_the_library() {
    fn look(folder: &Path) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                look(&path);
            } else {
                let text = std::fs::read_to_string(&path).unwrap();
                let file = path.display();
                assert!(
                    !text.contains("#[test]"),
                    "{file}: this test does not run; move it to tests/"
                );
            }
        }
    }
    look(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
}
