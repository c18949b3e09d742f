//! The division of a seat changes the distribution of its pressure, not its stiffness, damping or friction.
#![expect(clippy::print_stdout, reason = "the table of refinement")]

use barrelstack::Scenario;
use barrelstack::check::check;
use barrelstack::run::Run;
use barrelstack::variants::planes;

/// Divisions of a seat into elements, as fields of the rack.
const DIVISIONS: [(&str, &[&str]); 4] = [
    ("one element", &["stack.rack.contact=element"]),
    ("two rails", &["stack.rack.contact=rails"]),
    ("about 5 nodes", &["stack.rack.contact=nodes", "stack.rack.node_spacing=\"8 mm\""]),
    ("about 20 nodes", &["stack.rack.contact=nodes", "stack.rack.node_spacing=\"2 mm\""]),
];

fn scenario(division: &[&str], changes: &[&str]) -> Scenario {
    let all = division.iter().chain(changes).map(|change| (*change).to_owned());
    Scenario::builtin("demo-napa", &all.collect::<Vec<_>>()).unwrap()
}

/// Returns the settlement (m) of the top as the stack comes to rest.
fn settlement(division: &[&str], changes: &[&str]) -> f64 {
    check(&scenario(division, changes)).unwrap().rest.unwrap().deepest_sinking
}

fn run(division: &[&str], changes: &[&str]) -> Run {
    scenario(division, changes).run().unwrap()
}

/// Returns the mean time (s) between upward zero crossings of the history of a body, after a time (s).
fn period(run: &Run, body: &str, after: f64) -> f64 {
    let values = &run.recording.displacement(body).unwrap().values;
    let times = &run.recording.times;
    let zeros: Vec<f64> = (1..values.len())
        .filter(|i| times[*i] > after && values[i - 1] < 0.0 && values[*i] >= 0.0)
        .map(|i| {
            let share = values[i - 1] / (values[i - 1] - values[i]);
            times[i - 1] + share * (times[i] - times[i - 1])
        })
        .collect();
    (zeros.last().unwrap() - zeros[0]) / (zeros.len() - 1) as f64
}

/// Returns the displacement (m) of the upper of two racks relative to the lower rack after the shaking.
fn walk(run: &Run) -> f64 {
    let end = |name: &str| *run.recording.displacement(name).unwrap().values.last().unwrap();
    end("R2") - end("R1")
}

/// A push that makes nothing slip, and a shake that makes the upper level walk.
const PUSH: &str = "motion={ sine = { amplitude = \"2 mm\", period = \"0.4 s\", cycles = 1 } }";
const SHAKE: &str = "motion={ sine = { amplitude = \"5 cm\", period = \"0.8 s\", cycles = 5 } }";

/// Planes of the model, each with its number of columns.
const PLANES: [(&str, u32); 2] = [("transverse", 2), ("longitudinal", 1)];

fn changes((view, columns): (&str, u32), levels: u32, motion: &str, end: &str) -> Vec<String> {
    vec![
        format!("stack.view={view}"),
        format!("stack.columns={columns}"),
        format!("stack.levels={levels}"),
        motion.to_owned(),
        format!("run.duration=\"{end}\""),
        "record.history_rate=\"1000 Hz\"".to_owned(),
    ]
}

#[test]
fn refining_a_seat_changes_neither_rest_nor_period() {
    for plane in PLANES {
        let pushed = changes(plane, 4, PUSH, "2 s");
        let pushed: Vec<&str> = pushed.iter().map(String::as_str).collect();
        let mut first = None;
        for (name, division) in DIVISIONS {
            let found = [settlement(division, &pushed), period(&run(division, &pushed), "R4", 0.5)];
            println!("{} {name}: rest {:.6} m, period {:.5} s", plane.0, found[0], found[1]);
            for (value, one) in found.iter().zip(*first.get_or_insert(found)) {
                // Measured across the barrels: 0.5 % of the settlement and 0.1 % of the period.
                assert!((value / one - 1.0).abs() < 0.02, "{name}: {value} {one}");
            }
        }
    }
}

#[test]
fn refining_a_seat_changes_the_walk_along_the_barrels_by_less_than_2_percent() {
    let shaken = changes(PLANES[1], 2, SHAKE, "5 s");
    let shaken: Vec<&str> = shaken.iter().map(String::as_str).collect();
    let one = walk(&run(DIVISIONS[0].1, &shaken));
    for (name, division) in DIVISIONS {
        let found = walk(&run(division, &shaken));
        println!("{name}: {found:.6} m");
        assert!((found / one - 1.0).abs() < 0.02, "{name}: {found} {one}");
    }
}

/// Returns the mean of the values, and the variance of this mean.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (mean, squares / (count - 1.0) / count)
}

/// Returns, for each of `count` variants, the displacement (m) of the upper rack relative to the lower rack after the
/// shaking across the barrels.
fn walks(division: &[&str], spread: &[&str], count: u32) -> Vec<f64> {
    let mut shaken = changes(PLANES[0], 2, SHAKE, "5 s");
    shaken.extend(spread.iter().map(|&one| one.to_owned()));
    shaken.push("unknowns.drawn=false".to_owned());
    let shaken: Vec<&str> = shaken.iter().map(String::as_str).collect();
    let planes = planes(&scenario(division, &shaken)).unwrap();
    (1..=count).map(|number| walk(&planes[0].variant(number).run().unwrap())).collect()
}

#[test]
fn across_the_barrels_the_walk_is_chaotic_and_agrees_in_the_mean() {
    // If racks and barrels are displaced by a tenth of a millimeter, the walk changes by more than 2 %. Therefore only
    // the means of walks can be compared, not single walks.
    let still = ["imperfections.placement=\"0.1 mm\"", "imperfections.mass=0.0"];
    let touched = walks(DIVISIONS[0].1, &still, 4);
    let (least, most) = touched
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(least, most), walk| (least.min(*walk), most.max(*walk)));
    println!("a tenth of a millimeter: {least:.6} to {most:.6} m");
    assert!(most / least > 1.02, "not chaotic: hold single walks to 2 %");
    let (one, error) = mean(&walks(DIVISIONS[0].1, &[], 12));
    for (name, division) in DIVISIONS {
        let (found, own) = mean(&walks(division, &[], 12));
        println!("{name}: {found:.6} m, standard error {:.6} m", own.sqrt());
        assert!((found - one).abs() <= 3.0 * (own + error).sqrt(), "{name}: {found} {one}");
    }
}
