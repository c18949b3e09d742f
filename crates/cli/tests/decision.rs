//! The page of a study and `barrelstack study report`, end to end.

use std::fs;

use crate::common::{HEAD, barrelstack, stderr, stdout};

/// Returns the error for a mistake.
fn refused(arguments: &[&str]) -> String {
    let output = barrelstack(arguments);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
    stderr(&output)
}

/// Three stacks of two barrels under pulses of four strengths: some fall, some do not.
const STUDY: &str = "\
duration = \"2 s\"
[[motion]]
pulse = { kind = \"one-sine\", amplitude = \"1 g\", period = \"0.8 s\" }
[intensity]
measure = \"pgv\"
levels = [\"20 cm/s\", \"60 cm/s\", \"120 cm/s\", \"200 cm/s\"]
[[factor]]
name = \"friction\"
field = \"interface.rack-ground.friction.coefficient\"
values = [0.3, 0.5, 0.7]
[design]
kind = \"stripes\"
";

#[test]
fn a_study_ends_with_a_page_and_report_adds_what_it_means_at_a_site() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (study, out, hazard) = (at("two.toml"), at("out"), at("site.csv"));
    fs::write(&study, [HEAD, STUDY].concat()).unwrap();
    fs::write(&hazard, "pgv (cm/s),rate (1/year)\n5,0.1\n50,0.005\n200,0.0001\n").unwrap();
    let said = stdout(&barrelstack(["study", &study, "--out", &out]));
    assert!(said.contains("page: "), "{said}");
    for file in ["index.html", "index.md", "decision.json", "figures"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
    let before = fs::read(folder.path().join("out/index.html")).unwrap();
    let again = barrelstack(["study", "report", &out]);
    assert!(again.status.success(), "{}", stderr(&again));
    assert_eq!(fs::read(folder.path().join("out/index.html")).unwrap(), before);

    let json =
        barrelstack(["study", "report", &out, "--hazard", &hazard, "--years", "30", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&stdout(&json)).unwrap();
    assert_eq!(found["cases"], 12);
    assert_eq!(found["fragility"][0]["limit_state"], "collapse");
    assert_eq!(found["site"]["years"], 30.0);
    assert!(found["site"].get("barrels_fallen_per_year").is_some(), "{found}");
}

#[test]
fn a_hazard_without_its_unit_is_refused_with_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let hazard = at("site.csv");
    fs::write(&hazard, "pgv,rate (1/year)\n5,0.1\n50,0.005\n").unwrap();
    let said = refused(&["study", "report", &at("nothing"), "--hazard", &hazard]);
    assert!(said.contains("site.csv, line 1, column \"pgv\": expected a unit"), "{said}");
}

#[test]
fn a_folder_that_is_no_study_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let said = refused(&["study", "report", &folder.path().display().to_string()]);
    assert!(said.starts_with("error: "), "{said}");
}

#[test]
fn heights_refuses_an_unknown_rack_and_makes_no_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("page").display().to_string();
    let said = refused(&["heights", "--rack", "shelf", "--out", &out]);
    assert!(said.contains("two-barrel, two-barrel-feet"), "{said}");
    assert!(!folder.path().join("page").join("index.html").exists());
}
