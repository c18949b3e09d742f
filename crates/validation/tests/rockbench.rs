//! The cases of `benchmarks/rockbench`: well formed, and answered by this engine within their tolerances.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::HashSet;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;

#[path = "../../../benchmarks/rockbench/engines/barrelstack.rs"]
mod engine;

/// Reads all cases, in the order of their names.
fn cases() -> Vec<Value> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benchmarks/rockbench/cases");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.collect();
    files.sort();
    files
        .iter()
        .map(|file| {
            let case: Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
            assert_eq!(case["id"].as_str(), file.file_stem().and_then(|stem| stem.to_str()));
            case
        })
        .collect()
}

/// Cases that take half of the time of all, and whose like is tested elsewhere.
const LONG: [&str; 4] = ["stack-10", "stack-arch-stands", "stack-drums", "stack-spatial"];

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("no text: {value}"))
}

#[test]
fn every_case_states_bodies_laws_and_sourced_answers() {
    let cases = cases();
    assert!(cases.len() >= 40, "{} cases", cases.len());
    let ids: HashSet<&str> = cases.iter().map(|case| text(&case["id"])).collect();
    assert_eq!(ids.len(), cases.len());
    for case in &cases {
        let id = text(&case["id"]);
        assert_eq!(case["format"], "rockbench-1", "{id}");
        let dimension = if case["space"] == "planar" { 2 } else { 3 };
        assert_eq!(list(&case["gravity"]).len(), dimension, "{id}");
        let names: HashSet<&str> =
            list(&case["bodies"]).iter().map(|body| text(&body["name"])).collect();
        assert_eq!(names.len(), list(&case["bodies"]).len(), "{id}: names repeat");
        for body in list(&case["bodies"]) {
            assert_eq!(list(&body["position"]).len(), dimension, "{id}");
            assert!(!list(&body["shapes"]).is_empty(), "{id}");
            assert!(body["fixed"] == true || number(&body["mass"]) > 0.0, "{id}");
        }
        for law in list(&case["interfaces"]) {
            for side in list(&law["between"]) {
                assert!(side == "*" || names.contains(text(side)), "{id}: no body {side}");
            }
            assert!(number(&law["friction"]) >= 0.0, "{id}");
            assert!(law["normal"] == "rigid" || number(&law["normal"]["stiffness"]) > 0.0, "{id}");
        }
        if !case["ground"].is_null() {
            let times: Vec<f64> = list(&case["ground"]["time"]).iter().map(number).collect();
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{id}: times must grow");
            assert_eq!(list(&case["ground"]["acceleration"]).len(), times.len(), "{id}");
        }
        let mut quantities = HashSet::new();
        for quantity in list(&case["quantities"]) {
            let name = text(&quantity["name"]);
            assert!(quantities.insert(name), "{id}: {name} twice");
            assert!(!text(&quantity["source"]).is_empty(), "{id}: {name} has no source");
            let verdict = quantity["answer"].is_boolean();
            assert!(verdict || number(&quantity["tolerance"]) > 0.0, "{id}: {name}");
            if let Some(time) = quantity["time"].as_f64() {
                assert!(time <= number(&case["duration"]) + 1e-9, "{id}: {name} is after the end");
            }
        }
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "the measured errors, shown when it fails")]
fn this_engine_answers_within_the_tolerances() {
    let cases = cases();
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = || {
        let (mut failed, mut measured) = (Vec::new(), 0);
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            if LONG.contains(&text(&case["id"])) {
                continue;
            }
            let answer = engine::answer(case);
            assert_eq!(answer["cannot"], Value::Null, "{}", case["id"]);
            let trace = Trace { case, answer: &answer };
            for quantity in list(&case["quantities"]) {
                let Some(value) = trace.quantity(quantity) else { continue };
                measured += 1;
                let exact = quantity["answer"].as_bool().map(|holds| f64::from(u8::from(holds)));
                let exact = exact.unwrap_or_else(|| number(&quantity["answer"]));
                let error = (value - exact).abs();
                let line = format!("{}: {} is {value}, not {exact}", case["id"], quantity["name"]);
                println!("{line}");
                if error.is_nan() || error > number(&quantity["tolerance"]) {
                    failed.push(line);
                }
            }
        }
        (failed, measured)
    };
    let (failed, measured) = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().map(|worker| worker.join().unwrap()).fold(
            (Vec::new(), 0),
            |(mut failed, count), (more, measured)| {
                failed.extend(more);
                (failed, count + measured)
            },
        )
    });
    assert!(failed.is_empty(), "outside their tolerances:\n{}", failed.join("\n"));
    assert!(measured >= 180, "only {measured} quantities were measured");
}

/// The states that the engine returned.
struct Trace<'a> {
    case: &'a Value,
    answer: &'a Value,
}

impl Trace<'_> {
    fn time(&self, sample: usize) -> f64 {
        number(&self.answer["times"][sample])
    }

    fn samples(&self) -> usize {
        list(&self.answer["times"]).len()
    }

    fn state(&self, body: &str, sample: usize, component: usize) -> f64 {
        let at = list(&self.answer["bodies"]).iter().position(|name| name == body);
        number(&self.answer["states"][sample][at.unwrap()][component])
    }

    /// Returns a component at the sample nearest to a time (s).
    fn at(&self, body: &str, component: usize, time: f64) -> f64 {
        let away = |sample: &usize| (self.time(*sample) - time).abs();
        let nearest = (0..self.samples()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
        assert!(away(&nearest) < 1e-4, "{}: no state at {time} s", self.case["id"]);
        self.state(body, nearest, component)
    }

    fn axis(&self, name: &Value) -> usize {
        let axes =
            if self.case["space"] == "planar" { ["x", "z", "angle"] } else { ["x", "y", "z"] };
        axes.iter().position(|axis| name == axis).unwrap()
    }

    /// Returns the component of the initial pose.
    fn initial(&self, body: &str, axis: &Value) -> f64 {
        let body = list(&self.case["bodies"]).iter().find(|spec| spec["name"] == body).unwrap();
        if axis == "angle" {
            number(&body["angle"])
        } else {
            number(&body["position"][self.axis(axis)])
        }
    }

    fn window(&self, quantity: &Value) -> impl Iterator<Item = usize> {
        let [from, to] = [&quantity["between"][0], &quantity["between"][1]].map(number);
        (0..self.samples())
            .filter(move |sample| (from - 1e-9..=to + 1e-9).contains(&self.time(*sample)))
    }

    /// Returns a quantity, a verdict as 0 or 1; `None` for the kinds that only the scorer knows.
    fn quantity(&self, quantity: &Value) -> Option<f64> {
        let body = quantity["body"].as_str().unwrap_or_default();
        let axis = &quantity["axis"];
        let rates = if self.case["space"] == "planar" { 3 } else { 7 };
        let time = || number(&quantity["time"]);
        Some(match text(&quantity["kind"]) {
            "position" => {
                let of = |body: &str| self.at(body, self.axis(axis), time());
                of(body) - quantity["relative_to"].as_str().map_or(0.0, of)
            }
            "velocity" => self.at(body, rates + self.axis(axis), time()),
            "spin" => self.at(body, 10 + self.axis(axis), time()),
            "momentum" => {
                let free = list(&self.case["bodies"]).iter().filter(|body| body["fixed"] != true);
                free.map(|body| {
                    let velocity = self.at(text(&body["name"]), rates + self.axis(axis), time());
                    number(&body["mass"]) * velocity
                })
                .sum()
            }
            "peak" => self
                .window(quantity)
                .map(|sample| self.state(body, sample, self.axis(axis)))
                .fold(f64::NEG_INFINITY, f64::max),
            "largest" if axis != "lean" => {
                let (axis, start) = match text(axis) {
                    "dz" => (Value::from("z"), self.initial(body, &"z".into())),
                    _ => (axis.clone(), 0.0),
                };
                self.window(quantity)
                    .map(|sample| (self.state(body, sample, self.axis(&axis)) - start).abs())
                    .fold(0.0, f64::max)
            }
            "crossing" if axis != "lean" => {
                let value = |sample| self.state(body, sample, self.axis(axis));
                let mut crossings =
                    (1..self.samples()).filter(|sample| value(sample - 1) * value(*sample) < 0.0);
                let rank = quantity["number"].as_u64().unwrap();
                let after = crossings.nth(usize::try_from(rank - 1).unwrap())?;
                let (from, to) = (value(after - 1), value(after));
                let (start, end) = (self.time(after - 1), self.time(after));
                start + (end - start) * from / (from - to)
            }
            kind @ ("exceeds" | "first_exceeds") => {
                let several = quantity["bodies"].as_array().cloned();
                let several = several.unwrap_or_else(|| vec![body.into()]);
                let exceeds = |sample: &usize| {
                    several.iter().any(|body| {
                        let value = self.state(text(body), *sample, self.axis(axis));
                        let change = value - self.initial(text(body), axis);
                        change.abs() > number(&quantity["level"])
                    })
                };
                let first = (0..self.samples()).find(exceeds);
                if kind == "exceeds" {
                    f64::from(u8::from(first.is_some()))
                } else {
                    first.map_or(f64::INFINITY, |sample| self.time(sample))
                }
            }
            "force" => {
                let pair =
                    list(&self.case["forces"]).iter().position(|p| *p == quantity["pair"])?;
                let forces: Vec<f64> = self
                    .window(quantity)
                    .map(|sample| number(&self.answer["forces"][sample][pair]))
                    .collect();
                forces.iter().sum::<f64>() / forces.len() as f64
            }
            _ => return None,
        })
    }
}
