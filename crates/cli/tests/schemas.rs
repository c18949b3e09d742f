//! Every JSON document satisfies the schema that the program prints for it, in every outcome.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};
use std::time::Duration;

use crate::common::{HEAD, STUDY, barrelstack, program, stderr, stdout};
use serde_json::Value;

/// A time step near the critical one, with dampers that are too strong for it. The stack does not settle first, because
/// settling would already reveal this.
const BROKEN: [&str; 5] = [
    "run",
    "candia-8-barrels",
    "--set=run.settle=false",
    "--set=run.step=0.6 ms",
    "--set=interface.barrel-rack.damping=\"3000 N s/cm\"",
];

/// A schema with the objects that it refers to.
struct Schema(Value);

impl Schema {
    fn printed(name: &str) -> Self {
        let output = barrelstack(["schema", name]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
        Self(serde_json::from_str(&stdout(&output)).unwrap())
    }

    /// Returns all violations of the schema in a value. Strict: an unsupported keyword of the schema is a violation,
    /// too.
    fn errors(&self, value: &Value) -> Vec<String> {
        let mut errors = Vec::new();
        self.check(&self.0, value, "$", &mut errors);
        errors
    }

    fn check(&self, schema: &Value, value: &Value, at: &str, errors: &mut Vec<String>) {
        const TELLING: [&str; 5] = ["$schema", "$defs", "title", "description", "unit"];
        for (word, rule) in schema.as_object().unwrap() {
            let wrong = match word.as_str() {
                word if TELLING.contains(&word) => false,
                "$ref" => {
                    let name = rule.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                    self.check(&self.0["$defs"][name], value, at, errors);
                    false
                }
                "anyOf" => !rule.as_array().unwrap().iter().any(|one| {
                    let mut inner = Vec::new();
                    self.check(one, value, at, &mut inner);
                    inner.is_empty()
                }),
                "type" => {
                    let types = rule.as_array();
                    !types
                        .map_or_else(|| is(rule, value), |all| all.iter().any(|one| is(one, value)))
                }
                "enum" => !rule.as_array().unwrap().contains(value),
                "minimum" => value.as_f64().is_some_and(|number| number < rule.as_f64().unwrap()),
                "minItems" => {
                    value.as_array().is_some_and(|a| (a.len() as u64) < rule.as_u64().unwrap())
                }
                "maxItems" => {
                    value.as_array().is_some_and(|a| (a.len() as u64) > rule.as_u64().unwrap())
                }
                "items" => {
                    for (place, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.check(rule, item, &format!("{at}[{place}]"), errors);
                    }
                    false
                }
                "required" => {
                    let missing = |key: &&Value| value.get(key.as_str().unwrap()).is_none();
                    value.is_object() && rule.as_array().unwrap().iter().any(|key| missing(&key))
                }
                "properties" => {
                    for (key, inner) in value.as_object().into_iter().flatten() {
                        if let Some(rule) = rule.get(key) {
                            self.check(rule, inner, &format!("{at}.{key}"), errors);
                        }
                    }
                    false
                }
                "additionalProperties" => {
                    let known = schema.get("properties").and_then(Value::as_object);
                    for (key, inner) in value.as_object().into_iter().flatten() {
                        let more = known.is_none_or(|known| !known.contains_key(key));
                        if more && rule == false {
                            errors.push(format!("{at}.{key} is new"));
                        } else if more {
                            self.check(rule, inner, &format!("{at}.{key}"), errors);
                        }
                    }
                    false
                }
                word => panic!("{at}: nothing is known of {word:?}"),
            };
            if wrong {
                errors.push(format!("{at} is {value}, but {word}: {rule}"));
            }
        }
    }
}

fn is(kind: &Value, value: &Value) -> bool {
    match kind.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        kind => panic!("nothing is known of {kind:?}"),
    }
}

/// `true` if a field holds numbers that are not integers.
fn counts(field: &Value) -> bool {
    if !field.is_object() {
        return false;
    }
    let number = |kind: &Value| kind == "number";
    let kinds = field["type"]
        .as_array()
        .map_or_else(|| number(&field["type"]), |all| all.iter().any(number));
    let inner = ["items", "additionalProperties"].iter().any(|key| counts(&field[*key]));
    kinds || inner || field["anyOf"].as_array().is_some_and(|all| all.iter().any(counts))
}

/// Returns the names that the program lists.
fn listed() -> BTreeSet<String> {
    let list = stdout(&barrelstack(["schema"]));
    list.lines().map(|line| line.split(' ').next().unwrap().to_owned()).collect()
}

/// Number of checked documents, by the name of their schema.
#[derive(Default)]
struct Documents(BTreeMap<String, usize>);

impl Documents {
    /// Checks that a text is one document that satisfies the schema that it names.
    fn document(&mut self, what: &str, text: &str) -> Value {
        let value: Value =
            serde_json::from_str(text).unwrap_or_else(|e| panic!("{what}: {e}: {text}"));
        let said = value["schema"].as_str().unwrap_or_else(|| panic!("{what}: no schema: {text}"));
        let errors = Schema::printed(said).errors(&value);
        assert_eq!(errors, Vec::<String>::new(), "{what}: {text}");
        *self.0.entry(said.split('/').next().unwrap().to_owned()).or_default() += 1;
        value
    }

    fn output(&mut self, what: &str, output: &Output, status: i32) -> Value {
        assert_eq!(output.status.code(), Some(status), "{what}: {}", stderr(output));
        self.document(what, &stdout(output))
    }

    fn run<S: AsRef<std::ffi::OsStr> + std::fmt::Debug>(
        &mut self,
        arguments: &[S],
        status: i32,
    ) -> Value {
        let output = program(arguments).arg("--json").output().unwrap();
        self.output(&format!("{arguments:?}"), &output, status)
    }
}

/// Sends a signal to a program shortly after its start and returns its output.
#[cfg(unix)]
fn interrupted(arguments: &[&str]) -> Output {
    let child = program(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    child.wait_with_output().unwrap()
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

/// Reads the documents of rooms.
fn of_rooms(documents: &mut Documents, out: &str) {
    let room = ["demo-cellar", "--set=stack.levels=1", "--set=run.duration=1 s"];
    assert_eq!(documents.run(&[&["run", "--variants=1"], &room[..]].concat(), 0)["counted"], 1);
    assert_eq!(documents.run(&[&["check"], &room[..]].concat(), 0)["stacks"], 4);
    let several = ["aftershock", "--variants=0", "--scale=0.5,1"];
    assert_eq!(documents.run(&[&several, &room[..]].concat(), 0)["counted"], 1);
    let narrow = [
        "check",
        "demo-cellar",
        "--set=room.length=3 m",
        "--set=aisle.aisle.to=[\"3 m\", \"3 m\"]",
    ];
    let wrong = documents.run(&narrow, 2);
    assert_eq!(wrong["problems"].as_array().unwrap().len(), 1, "{wrong}");
    let layouts = ["compare", "--variants=1", "--against=block.1.spacing=1 m", "--out", out];
    let compared = documents.run(&[&layouts[..], &room].concat(), 0);
    assert!(compared["paired"][0]["barrels_fallen"]["interval"].is_null(), "{compared}");
}

#[test]
fn every_document_has_the_schema_that_it_names_in_every_outcome() {
    let mut documents = Documents::default();
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| path(folder.path(), name);
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        at(name)
    };

    let short = ["--set=run.stop_after_collapse=0.1 s"];
    let outcome = |value: &Value| value["outcome"]["kind"].as_str().unwrap().to_owned();
    let stands = ["run", "demo-napa", "--set=stack.levels=1", "--set=run.duration=1 s"];
    assert_eq!(outcome(&documents.run(&stands, 0)), "stable");
    // Two levels under a sine that no height survives.
    let strong = "motion={ sine = { amplitude = \"12 cm\", period = \"0.8 s\", cycles = 3 } }";
    let weak = ["run", "demo-napa", "--set=stack.levels=2", "--set", strong, "--variants=8"];
    let fallen = documents.run(&[&weak, &short[..]].concat(), 0);
    assert_eq!(outcome(&fallen), "collapse");
    assert!(!fallen["remedy"]["tried"].as_array().unwrap().is_empty());
    assert_eq!(outcome(&documents.run(&["run", "sliding-block"], 0)), "not-judged");
    assert_eq!(outcome(&documents.run(&BROKEN, 1)), "invalid");
    let strap = "stack.strap={ levels = 4, ties = \"levels-together\", pretension = \"3 kN\" }";
    let strapped = ["run", "candia-8-barrels", "--set", strap, "--set=run.duration=1 s"];
    assert!(!documents.run(&strapped, 0)["straps"].as_array().unwrap().is_empty());
    let in_space = ["run", "demo-napa", "--set=stack.view=spatial", "--set=stack.levels=2"];
    let counted = ["--set=run.duration=9 s", "--variants=2", "--set=motion.scale.factor=2"];
    let solid = documents.run(&[&in_space, &short[..], &counted].concat(), 0);
    assert_eq!(outcome(&solid), "collapse");
    assert!(solid["directions"]["first_away"].is_u64());
    let verified = ["run", "rocking-block", "--verify", "--set=run.duration=1 s"];
    assert!(documents.run(&verified, 0)["verification"].is_object());
    #[cfg(unix)]
    {
        let long = [
            "run",
            "demo-napa",
            "--set=run.duration=3600 s",
            "--set=run.until=duration",
            "--set=stack.levels=2",
            "--json",
        ];
        let value = documents.output("stopped", &interrupted(&long), 130);
        assert_eq!(value["run"]["interrupted"], true);
    }

    of_rooms(&mut documents, &at("layouts"));
    documents.run(&["check", "candia-8-barrels"], 0);
    documents.run(&["check", "bouncing-disc"], 0);
    let against = "--against=run.duration=0.5 s";
    let out = at("compared");
    documents
        .run(&["compare", "rocking-block", against, "--set=run.duration=0.6 s", "--out", &out], 0);
    documents.run(&["scenarios"], 0);
    documents.run(&["scenarios", "list"], 0);

    let study = write("study.toml", &[HEAD, STUDY].concat());
    let done = at("study");
    documents.run(&["study", "plan", &study], 0);
    documents.run(&["study", &study, "--out", &done], 0);
    documents.run(&["study", "status", &done], 0);
    documents.run(&["study", "collect", &done], 0);
    documents.run(&["study", "report", &done], 0);
    let hazard = write("hazard.csv", "pgv (cm/s),rate (1/year)\n5,0.1\n20,0.01\n60,0.001\n");
    documents.run(&["study", "report", &done, "--hazard", &hazard], 0);
    let decision = fs::read_to_string(folder.path().join("study/decision.json")).unwrap();
    documents.document("decision.json", &decision);
    // A partly finished study.
    let part = at("part");
    assert!(
        barrelstack(["study", "run-chunk", &study, "--chunk=1", "--out", &part]).status.success()
    );
    documents.run(&["study", "status", &part], 0);
    documents.run(&["study", "collect", &part], 4);

    let tilt = write("tilt.csv", "angle (deg)\n25\n26\n24\n25.5\n");
    documents.run(&["calibrate", "friction", &tilt], 0);
    let press = write("press.csv", "penetration (mm),force (kN)\n1,2\n2,4.1\n3,5.9\n");
    documents.run(&["calibrate", "stiffness", &press], 0);
    let sag = write("sag.csv", "load (kg),sag (mm)\n135,0.11\n270,0.22\n270,0.23\n");
    documents.run(&["calibrate", "stiffness", &sag, "--seats=4"], 0);
    let taps = write("taps.csv", "period (s)\n0.41\n0.42\n0.4\n");
    let along = ["--set=stack.view=longitudinal", "--set=stack.levels=2"];
    documents
        .run(&[&["calibrate", "stiffness", &taps, "--scenario=demo-napa"][..], &along].concat(), 0);

    documents.run(&["motion", "info", "napa-college-2014"], 0);
    documents.run(&["motion", "info", "napa-college-2014", "--all-measures"], 0);

    let error = documents.run(&["run", "nowhere.toml"], 2);
    assert_eq!(error["file"], "nowhere.toml");
    let bad = write("bad.toml", "schema = 1\nextends = \"demo-napa\"\n[stack]\nlevels = 2.5\n");
    let error = documents.run(&["check", &bad], 2);
    assert_eq!((&error["line"], &error["status"]), (&Value::from(4), &Value::from(2)));
    let error = documents.run(&["run", "demo-napa", "--set=run.step=5 ms"], 2);
    assert_eq!(error["change"], "run.step=5 ms");
    documents.run(&["run", "--levels=3"], 2);
    documents.run(&["motion", "info", &bad], 2);
    #[cfg(unix)]
    {
        for command in ["heights", "protect", "score"] {
            let long = [command, "--json", "--quiet", "--out", &at(command)];
            let error = documents.output("stopped", &interrupted(&long), 130);
            assert!(error["error"].as_str().unwrap().contains("continues from there"), "{error}");
        }
    }

    // Slow documents are checked by the test below.
    let slow = ["heights", "protect", "rockscore", "stability"].map(str::to_owned);
    let documents: BTreeSet<String> = documents.0.into_keys().chain(slow).collect();
    assert_eq!(documents, listed());
}

#[test]
fn every_number_has_a_unit_and_every_field_a_meaning() {
    for name in listed() {
        let schema = Schema::printed(&name);
        for (object, described) in schema.0["$defs"].as_object().unwrap() {
            for (key, field) in described["properties"].as_object().unwrap() {
                let place = format!("{name}: {object}.{key}");
                assert!(!field["description"].as_str().unwrap_or_default().is_empty(), "{place}");
                assert!(!counts(field) || field["unit"].is_string(), "{place}: {field}");
            }
        }
        let dictionary = stdout(&barrelstack(["schema", &name, "--dictionary"]));
        let keys = dictionary.lines().filter(|line| line.starts_with("schema ")).count();
        assert_eq!(keys, 1, "{name}: {dictionary}");
    }
}

#[test]
fn what_takes_a_minute_has_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    let out = path(folder.path(), "heights");
    let mut documents = Documents::default();
    let few = ["--synthetic=0", "--highest=2", "--barrel=burgundy-228", "--quiet", "--out", &out];
    let value = documents.run(&[&["heights"][..], &few].concat(), 0);
    assert_eq!(value["barrel"], "burgundy-228");
    assert_eq!(value["heights"].as_array().unwrap().len(), 2);
    let file = fs::read_to_string(folder.path().join("heights/heights.json")).unwrap();
    documents.document("heights.json", &file);
    let out = path(folder.path(), "protect");
    let hazard = folder.path().join("hazard.csv");
    fs::write(&hazard, "pgv (cm/s),rate (1/year)\n5,0.1\n20,0.01\n60,0.001\n200,0.00001\n")
        .unwrap();
    let (site, low) = (format!("--site={}", hazard.display()), "--set=stack.levels=2");
    let arguments =
        ["protect", "candia-8-barrels", low, &site, "--count=4", "--rounds=1", "--budget=130"];
    let value = documents.run(&[&arguments[..], &["--quiet", "--out", &out]].concat(), 0);
    assert_eq!(value["per"], "year");
    assert!(value["protections"].as_array().unwrap().len() > 2);
    let file = fs::read_to_string(folder.path().join("protect/protect.json")).unwrap();
    documents.document("protect.json", &file);
    let value = documents.run(&["check", "candia-8-barrels", "--table"], 0);
    assert_eq!(value["rows"].as_array().unwrap().len(), 7 * 6);
    let out = path(folder.path(), "score");
    let value = documents.run(&["score", "candia-8-barrels", "--quiet", "--out", &out], 0);
    assert_eq!(value["states"].as_array().unwrap().len(), 2);
    let file = fs::read_to_string(folder.path().join("score/rockscore.json")).unwrap();
    documents.document("rockscore.json", &file);
}
