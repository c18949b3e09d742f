//! Variants that are shared among engines say together what one engine says of all, to the last bit.

use std::ops::ControlFlow;

use barrelstack_web::{Ask, Request, answered};
use serde_json::Value;

const SCENARIO: &str = "schema = 1\nextends = \"demo-napa\"\n[stack]\nlevels = 3\n\
                        [imperfections]\nvariants = 6\n[run]\nduration = \"9 s\"\n";

fn asked(request: &Request) -> Result<Value, String> {
    let answer = answered(&request.to_bytes(&[]), &mut |_, _| ControlFlow::Continue(()))?;
    serde_json::from_slice(&answer).map_err(|error| error.to_string())
}

fn request(ask: Ask, numbers: &[u32]) -> Request {
    Request { numbers: numbers.to_vec(), ..Request::of(ask, SCENARIO) }
}

#[test]
fn shares_in_any_order_have_the_spread_of_all() {
    let shares = [vec![0, 4, 1], vec![5], vec![2, 6, 3]];
    let mut found: Vec<(u32, [Value; 2])> = Vec::new();
    for numbers in &shares {
        let planes = asked(&request(Ask::Variants, numbers)).unwrap();
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
        ..request(Ask::Verdict, &[0, 1, 2, 3, 4, 5, 6])
    };
    let verdict = asked(&verdict).unwrap();
    let summary = asked(&request(Ask::Summary, &[])).unwrap();
    let planes = [&summary, &summary["other_plane"]];
    for judged in verdict["planes"].as_array().unwrap() {
        let plane = planes.iter().find(|plane| plane["view"] == judged["view"]).unwrap();
        assert_eq!(judged["spread"], plane["ensemble"]);
    }
    assert!(verdict["headline"].as_str().unwrap().contains("Across the barrels"), "{verdict}");
}

#[test]
fn a_verdict_without_the_stack_as_it_is_stated_is_refused() {
    let refused = asked(&request(Ask::Verdict, &[1])).unwrap_err();
    assert!(refused.contains("the first of which is 0"), "{refused}");
}

#[test]
fn a_look_tells_every_field_and_stands_still() {
    let look = asked(&request(Ask::Look, &[])).unwrap();
    let settings = look["settings"].as_array().unwrap();
    let field = |path: &str| settings.iter().find(|one| one["path"] == path).unwrap();
    assert_eq!(field("stack.levels")["value"], "3");
    // Not given, and there to be given.
    assert_eq!(field("motion.time_step")["value"], "");
    assert!(settings.iter().all(|one| one["help"].as_str().is_some_and(|help| help.len() > 4)));
    let data: Value = serde_json::from_str(look["stage"]["data"].as_str().unwrap()).unwrap();
    assert_eq!(data["players"][0]["panes"].as_array().map(Vec::len), Some(2));
    assert_eq!(data["players"][0]["panes"][0]["poses"]["n"], 1);
    // The South Napa record is strong from 5.0 s on, and an opening goes on for 3 s.
    assert!(
        look["opening"].as_f64().is_some_and(|end| (8.0..=9.0).contains(&end)),
        "{}",
        look["opening"]
    );
}
