//! Variants shared among engines give the same combined result as one engine, to the last bit.

use std::ops::ControlFlow;

use barrelstack_motion::{ReadOptions, read};
use barrelstack_web::{Request, RequestKind, answered};
use serde_json::Value;

const SCENARIO: &str = "schema = 1\nextends = \"demo-napa\"\n[stack]\nlevels = 3\n\
                        [imperfections]\nvariants = 6\n[run]\nduration = \"9 s\"\n";

fn bytes_of(request: &Request, files: &[&[u8]]) -> Result<Vec<u8>, String> {
    answered(&request.to_bytes(files), &mut |_, _| ControlFlow::Continue(()))
}

fn answer_to(request: &Request) -> Result<Value, String> {
    serde_json::from_slice(&bytes_of(request, &[])?).map_err(|error| error.to_string())
}

/// Splits an answer into its head and the bytes that follow.
fn parts(answer: &[u8]) -> (Value, &[u8]) {
    let (length, rest) = answer.split_first_chunk::<4>().expect("an answer with a length");
    let (head, rest) = rest.split_at(u32::from_le_bytes(*length) as usize);
    (serde_json::from_slice(head).expect("a head of JSON"), rest)
}

/// Returns the results of variants in each plane, and their trails.
fn run(numbers: &[u32]) -> (Value, Vec<u8>) {
    let answer = bytes_of(&request(RequestKind::Variants, numbers), &[]).expect("a sound request");
    let (cases, trails) = parts(&answer);
    (cases, trails.to_vec())
}

fn request(kind: RequestKind, numbers: &[u32]) -> Request {
    Request { numbers: numbers.to_vec(), ..Request::of(kind, SCENARIO) }
}

#[test]
fn shares_in_any_order_have_the_spread_of_all() {
    let shares = [vec![0, 4, 1], vec![5], vec![2, 6, 3]];
    let mut found: Vec<(u32, [Value; 2])> = Vec::new();
    let mut trails = Vec::new();
    for numbers in &shares {
        let (planes, more) = run(numbers);
        trails.extend(more);
        let case = |plane: usize, at: usize| planes[plane][at].clone();
        found.extend(
            numbers.iter().enumerate().map(|(at, number)| (*number, [case(0, at), case(1, at)])),
        );
    }
    found.sort_by_key(|(number, _)| *number);
    let cases: Vec<Vec<Value>> =
        [0, 1].map(|plane| found.iter().map(|(_, case)| case[plane].clone()).collect()).into();
    let verdict = Request {
        cases: serde_json::from_value(serde_json::to_value(cases).unwrap()).unwrap(),
        ..request(RequestKind::Verdict, &[0, 1, 2, 3, 4, 5, 6])
    };
    let files = Request { kind: RequestKind::Files, trails: trails.len(), ..verdict.clone() };
    let of_shares = bytes_of(&files, &[&trails]).unwrap();
    let of_one = bytes_of(&request(RequestKind::Files, &[]), &[]).unwrap();
    // Including the report, with the paths of all variants.
    assert!(of_shares == of_one, "files of shares differ from those of one engine");
    let cut = bytes_of(&Request { trails: 40, ..files.clone() }, &[&trails[..40]]).unwrap_err();
    assert!(cut.contains("ends within its trails"), "{cut}");
    let fewer = Request { numbers: vec![0, 1], trails: 0, cases: Vec::new(), ..files };
    let fewer = bytes_of(&fewer, &[]).unwrap_err();
    assert!(
        fewer.contains("the results of all 6 variants, but the request has the results of only 1"),
        "{fewer}"
    );
    let verdict = answer_to(&verdict).unwrap();
    let summary = answer_to(&request(RequestKind::Summary, &[])).unwrap();
    let planes = [&summary, &summary["other_plane"]];
    for judged in verdict["planes"].as_array().unwrap() {
        let plane = planes.iter().find(|plane| plane["view"] == judged["view"]).unwrap();
        assert_eq!(judged["spread"], plane["ensemble"]);
    }
    let headline = verdict["headline"].as_str().unwrap();
    assert!(headline.contains("variants fall (") && headline.contains("across them"), "{verdict}");
}

#[test]
fn a_verdict_without_the_stack_as_it_is_stated_is_refused() {
    let refused = answer_to(&request(RequestKind::Verdict, &[1])).unwrap_err();
    assert!(refused.contains("the first value in `numbers` must be 0"), "{refused}");
}

#[test]
fn a_look_lists_every_field_and_stands_still() {
    let look = answer_to(&request(RequestKind::Look, &[])).unwrap();
    let settings = look["settings"].as_array().unwrap();
    let field = |path: &str| settings.iter().find(|one| one["path"] == path).unwrap();
    assert_eq!(field("stack.levels")["value"], "3");
    // Absent, and available to set.
    assert_eq!(field("motion.time_step")["value"], "");
    assert!(settings.iter().all(|one| one["help"].as_str().is_some_and(|help| help.len() > 4)));
    let data: Value = serde_json::from_str(look["stage"]["data"].as_str().unwrap()).unwrap();
    assert_eq!(data["players"][0]["panes"].as_array().map(Vec::len), Some(2));
    assert_eq!(data["players"][0]["panes"][0]["poses"]["n"], 1);
    // The strong motion of the South Napa record begins at 5.0 s, and the opening ends 3 s later.
    assert!(
        look["opening"].as_f64().is_some_and(|end| (8.0..=9.0).contains(&end)),
        "{}",
        look["opening"]
    );
}

#[test]
fn devices_are_offered_as_they_go_on_the_stack_and_present_ones_are_listed() {
    let offered = |changes: &[&str]| {
        let set = changes.iter().map(|change| (*change).to_owned()).collect();
        answer_to(&Request { set, ..request(RequestKind::Devices, &[]) }).unwrap()
    };
    let names = |devices: &Value| -> Vec<String> {
        let all = devices["candidates"].as_array().unwrap();
        all.iter().map(|one| one["name"].as_str().unwrap().to_owned()).collect()
    };
    let of = |devices: &Value, device: &str| {
        devices["candidates"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|one| one["device"] == device)
            .count()
    };
    let three = offered(&[]);
    for words in barrelstack::device::DEVICES {
        assert!(of(&three, words.one) >= words.candidates.len(), "{}", words.one);
    }
    assert!(
        names(&three).contains(&"all levels held together by straps tightened to 3 kN".to_owned())
    );
    assert_eq!(three["candidates"][0]["changes"][0], "stack.strap.levels=1");
    // Two levels have no top three.
    let two = offered(&["stack.levels=2"]);
    assert!(names(&two).iter().all(|name| !name.contains("top three")), "{two}");
    let strapped = offered(&["stack.strap.levels=1"]);
    assert_eq!(strapped["present"], serde_json::json!([{ "name": "straps", "table": "strap" }]));
    assert_eq!(of(&strapped, "strap"), 0);
    // Each of them is applicable.
    for candidate in three["candidates"].as_array().unwrap() {
        let set = serde_json::from_value(candidate["changes"].clone()).unwrap();
        answer_to(&Request { set, ..request(RequestKind::Look, &[]) }).unwrap();
    }
}

#[test]
fn files_given_at_once_are_one_record_or_several_or_reported_as_none() {
    let text = |name: &str, station: &str, channel: &str| {
        let rows: Vec<String> =
            (0..600).map(|at| format!("{:e}", (f64::from(at) * 0.1).sin())).collect();
        let head = format!(
            "# barrelstack motion 1\n# station: {station}\n# event: {name}\n# stage: corrected\n\
             # unit: m/s2\n# time_step: 0.01\n# channels: {channel}\n"
        );
        (head + &rows.join("\n") + "\n").into_bytes()
    };
    let given = |files: &[(&str, Vec<u8>)]| {
        let request = Request {
            records: files.iter().map(|(name, bytes)| ((*name).to_owned(), bytes.len())).collect(),
            ..Request::of(RequestKind::Records, "")
        };
        let bytes: Vec<&[u8]> = files.iter().map(|(_, bytes)| bytes.as_slice()).collect();
        let answer = bytes_of(&request, &bytes).unwrap();
        let (head, rest) = parts(&answer);
        (head, rest.to_vec())
    };
    let napa = |channel| text("Napa", "College", channel);
    let (e, n, up) = (napa("E az=90"), napa("N az=0"), napa("UP vertical"));
    let (one, bytes) =
        given(&[("site-e.txt", e.clone()), ("site-n.txt", n), ("site-up.txt", up.clone())]);
    assert_eq!(one["motions"][0]["name"], "site-set.txt");
    assert_eq!(one["motions"][0]["channels"][2], "site-up.txt (UP) is up and down");
    let again = read(&bytes, "site-set.txt", &ReadOptions::default()).unwrap();
    assert_eq!(again.channels.len(), 3);
    // A horizontal and a vertical component.
    let (pair, _) = given(&[("h.txt", e.clone()), ("v.txt", up)]);
    assert_eq!(pair["motions"].as_array().unwrap().len(), 1);
    // Files of two stations are two motions, each identical to its file.
    let (two, bytes) = given(&[("a.txt", e.clone()), ("b.txt", text("Napa", "Other", "E az=90"))]);
    let names: Vec<&Value> =
        two["motions"].as_array().unwrap().iter().map(|one| &one["name"]).collect();
    assert_eq!(names, ["a.txt", "b.txt"]);
    assert!(bytes.is_empty());
    // A picture is not a record and does not affect the other files; the unit of a column of numbers is missing.
    let numbers: Vec<String> = (0..600).map(|at| f64::from(at).sin().to_string()).collect();
    let column = numbers.join("\n");
    let (some, _) =
        given(&[("a.txt", e), ("b.png", b"\x89PNG\r\n".to_vec()), ("c.csv", column.into_bytes())]);
    assert_eq!(some["motions"][0]["name"], "a.txt");
    assert_eq!(some["refused"][0]["file"], "b.png");
    assert!(some["refused"][1]["missing"].as_str().is_some(), "{some}");
}
