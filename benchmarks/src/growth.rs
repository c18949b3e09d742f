//! Cost of a run as a function of the number of bodies. The cost must not grow faster than the
//! number of contacts.

use std::fmt::Write as _;

use barrelstack::Scenario;

use crate::{Failure, time};

/// Simulated time (s), during which nothing falls.
const UNTIL: f64 = 0.25;

/// A family of scenes of increasing size.
struct Family {
    name: &'static str,
    sizes: &'static [usize],
    scenario: fn(usize, f64) -> Result<Scenario, Failure>,
}

const FAMILIES: [Family; 4] = [
    Family {
        name: "levels of two barrels",
        sizes: &[2, 4, 6, 8, 10, 12],
        scenario: |levels, until| stack(levels, 2, until),
    },
    Family {
        name: "columns of four barrels",
        sizes: &[2, 4, 8, 12, 16, 20],
        scenario: |columns, until| stack(4, columns, until),
    },
    Family { name: "blocks in a row", sizes: BODIES, scenario: |count, until| row(count, until) },
    Family { name: "discs in a heap", sizes: BODIES, scenario: |count, until| heap(count, until) },
];

const BODIES: &[usize] = &[10, 50, 200, 500, 1000, 2000, 5000];

/// Prints, for every family, the set-up time and the cost per contact element, with the ratio of
/// the largest to the smallest value of each.
pub(crate) fn with_size() -> Result<(), Failure> {
    println!(
        "single runs of increasing size: set-up (from text to the first step), and cost per contact element tested"
    );
    for Family { name, sizes, scenario } in FAMILIES {
        println!("  {name:24}  bodies  elements   set-up ms   µs / (n log₂ n)    ns per element");
        let (mut costs, mut shares) = (Vec::new(), Vec::new());
        for size in sizes {
            let long = scenario(*size, UNTIL)?.run()?;
            let elements = long.work.contact_evaluations as f64;
            let count = (long.assembly.parts.len() - 1) as f64;
            // A run of one step measures the set-up, so the first step counts as part of it.
            let set_up = time::least_of(2, || {
                let brief = scenario(*size, 1e-4).map(|brief| brief.run());
                assert!(brief.is_ok_and(|run| run.is_ok()), "it runs");
            });
            let all = time::least_of(2, || {
                let whole = scenario(*size, UNTIL).map(|whole| whole.run());
                assert!(whole.is_ok_and(|run| run.is_ok()), "it runs");
            });
            let (cost, share) = ((all - set_up) / elements, set_up / (count * count.log2()));
            println!(
                "  {size:24} {count:7} {:9.0} {:11.1} {:20.2} {:15.1}",
                elements / long.work.evaluations as f64,
                1e3 * set_up,
                1e6 * share,
                1e9 * cost
            );
            costs.push(cost);
            shares.push(share);
        }
        println!(
            "  largest divided by smallest: {:.2} per element, {:.2} for the set-up",
            spread(&costs),
            spread(&shares)
        );
    }
    Ok(())
}

fn spread(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(0.0, f64::max);
    most / values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn stack(levels: usize, columns: usize, until: f64) -> Result<Scenario, Failure> {
    let settings = [
        format!("stack.levels={levels}"),
        format!("stack.columns={columns}"),
        format!("run.duration=\"{until} s\""),
    ];
    Ok(Scenario::builtin("candia-8-barrels", &settings)?)
}

fn row(count: usize, until: f64) -> Result<Scenario, Failure> {
    let shape = "{ type = \"rectangle\", width = \"0.4 m\", height = \"0.4 m\" }";
    free((0..count).map(|at| (0.5 * at as f64, 0.2)), shape, "corners", until)
}

/// Builds a heap of discs in a hexagonal packing, about as high as it is wide.
fn heap(count: usize, until: f64) -> Result<Scenario, Failure> {
    let across = (count as f64).sqrt().ceil() as usize;
    let place = |at: usize| {
        let (row, column) = (at / across, at % across);
        let odd = (row % 2) as f64;
        (0.4 * (column as f64 + 0.5 * odd), 0.2 + 0.4 * 0.866_025_404 * row as f64)
    };
    free((0..count).map(place), "{ type = \"circle\", radius = \"0.2 m\" }", "rolling", until)
}

/// Builds a free scene of equal bodies with their centers at given places (m).
fn free(
    places: impl Iterator<Item = (f64, f64)>,
    shape: &str,
    nodes: &str,
    until: f64,
) -> Result<Scenario, Failure> {
    let mut text = format!(
        "schema = 1\ntitle = \"growth\"\nkind = \"free\"\n\
         [motion.sine]\namplitude = \"1 cm\"\nperiod = \"1 s\"\ncycles = 10\n\
         [run]\nduration = \"{until} s\"\nstep = \"0.1 ms\"\nsettle = false\n"
    );
    for between in ["[\"body\", \"ground\"]", "[\"body\", \"body\"]"] {
        write!(
            text,
            "[[interface]]\nbetween = {between}\nstiffness = \"1e6 N/m\"\ndamping = \"2000 N s/m\"\n\
             friction = {{ coefficient = 0.5 }}\n"
        )?;
    }
    for (at, (x, z)) in places.enumerate() {
        write!(
            text,
            "[[body]]\nname = \"b{at}\"\nkind = \"body\"\nshape = {shape}\nmass = \"100 kg\"\n\
             nodes = \"{nodes}\"\nposition = [\"{x} m\", \"{z} m\"]\n"
        )?;
    }
    Ok(Scenario::parse("growth.toml", &text, &[])?)
}
