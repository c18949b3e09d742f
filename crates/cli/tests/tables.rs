//! Forms of tables that a command or a build does not write are refused before any work.

use crate::common::{program, stderr};

#[cfg(not(feature = "xlsx"))]
#[test]
fn a_build_without_workbooks_says_so_before_any_work() {
    let place = tempfile::tempdir().unwrap();
    let output = program(["run", "demo-napa", "--xlsx", "--out", "a"])
        .current_dir(place.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--features xlsx"), "{}", stderr(&output));
    assert!(!place.path().join("a").exists());
}

#[test]
fn forms_of_tables_without_tables_are_refused() {
    for arguments in [
        ["run", "rocking-block", "--xlsx"],
        ["run", "rocking-block", "--decimal-comma"],
        ["compare", "rocking-block", "--xlsx"],
    ] {
        let output = program(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(arguments[2]), "{}", stderr(&output));
    }
}
