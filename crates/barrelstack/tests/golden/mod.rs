//! Reference results of a few cases, bit for bit, and their work.

use std::fmt;
use std::path::{Path, PathBuf};

pub(crate) use barrelstack::ensemble::VERSION;
use barrelstack::ensemble::{Audience, CaseResult, Prepared, simulate_in};
use barrelstack::outcome::Outcome;
use barrelstack::run::Work;
use barrelstack::{Run, Scenario};
use barrelstack_dynamics::lanes::Width;

/// Command that stores the present bits as reference.
pub(crate) const RENEW: &str = "cargo xtask golden bits";

/// Built-in scenarios with changes.
const RUNS: [(&str, &str, &[&str]); 12] = [
    ("paper-8-barrels", "candia-8-barrels", &[]),
    ("paper-8-barrels-longitudinal", "candia-8-barrels-longitudinal", &["run.duration='5 s'"]),
    ("paper-8-barrels-half-scale", "candia-8-barrels-half-scale", &[]),
    (
        "paper-6-barrels-napa",
        "candia-6-barrels",
        &["motion={ bundled = 'napa-college-2014', component = 'horizontal-1' }"],
    ),
    ("demo-heap", "demo-napa", &["stack.view='longitudinal'"]),
    (
        "demo-strapped",
        "demo-napa",
        &[
            "stack.view='longitudinal'",
            "stack.strap={ levels = 5, ties = 'levels-together', pretension = '3 kN' }",
        ],
    ),
    (
        "straps-that-tear",
        "candia-8-barrels",
        &["stack.strap={ levels = 3, ties = 'levels-together', strength = '5 kN' }"],
    ),
    ("rocking-block-euler", "rocking-block", &["run.method='semi-implicit-euler'"]),
    ("sliding-block-runge-kutta", "sliding-block", &["run.method='runge-kutta-4'"]),
    ("rolling-disc", "rolling-disc", &[]),
    ("bouncing-disc", "bouncing-disc", &[]),
    (
        "bouncing-disc-adaptive",
        "bouncing-disc",
        &["run.method='bogacki-shampine'", "run.tolerance=1e-7"],
    ),
];

/// Number of cases that run in SIMD lanes: more than two bundles of the widest kind.
const IN_LANES: u32 = 20;

/// The bits of a case and its work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) hash: u64,
    pub(crate) work: Work,
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Work { steps, evaluations, contact_evaluations } = self.work;
        let Self { name, hash, .. } = self;
        write!(f, "{name:30} {hash:016x} {steps:>8} {evaluations:>8} {contact_evaluations:>11}")
    }
}

/// All lines, and the version of their results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Table {
    pub(crate) version: u32,
    pub(crate) lines: Vec<Line>,
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# Written by `{RENEW}`.")?;
        writeln!(f, "# case, hash of its result, steps, evaluations, contact evaluations")?;
        writeln!(f, "version {}", self.version)?;
        self.lines.iter().try_for_each(|line| writeln!(f, "{line}"))
    }
}

impl Table {
    /// Reads stored references; the error describes a line that cannot be read.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut rows = text.lines().enumerate().filter(|(_, row)| !row.starts_with('#'));
        let version = rows.next().and_then(|(_, row)| row.strip_prefix("version ")?.parse().ok());
        let version = version.ok_or("expected `version` and a number before the first case")?;
        let line = |(number, row): (usize, &str)| {
            let cells: Vec<&str> = row.split_whitespace().collect();
            let [name, hash, counts @ ..] = &cells[..] else { return Err(number) };
            let hash = u64::from_str_radix(hash, 16).map_err(|_| number)?;
            let counts: Result<Vec<u64>, _> = counts.iter().map(|count| count.parse()).collect();
            let [steps, evaluations, contact_evaluations] =
                counts.map_err(|_| number)?.try_into().map_err(|_| number)?;
            let work = Work { steps, evaluations, contact_evaluations };
            Ok(Line { name: (*name).to_owned(), hash, work })
        };
        let lines = rows.map(line).collect::<Result<_, _>>();
        let lines = lines.map_err(|number| format!("line {}: expected five cells", number + 1))?;
        Ok(Self { version, lines })
    }

    /// Computes the present results, those in lanes at every width of this machine.
    pub(crate) fn now() -> Self {
        let mut lines: Vec<Line> =
            RUNS.iter().map(|(name, scenario, changes)| of_run(name, scenario, changes)).collect();
        let cases: Vec<Prepared> = (0..IN_LANES).map(small_case).collect();
        let mut widths = Width::ALL.into_iter().filter(|width| width.is_here());
        let scalar = widths.next().expect("every machine computes one number after the other");
        let alone = of_lanes(scalar, &cases);
        for width in widths {
            assert_eq!(alone, of_lanes(width, &cases), "lanes of {} differ", width.name());
        }
        lines.push(alone);
        Self { version: VERSION, lines }
    }

    /// Compares present results with the stored ones.
    pub(crate) fn verdict(&self, now: &Self) -> Verdict {
        let kept = |line: &&Line| self.lines.iter().find(|kept| kept.name == line.name).cloned();
        let mut changed = Vec::new();
        let mut bits = false;
        for line in &now.lines {
            if let Some(kept) = kept(&line).filter(|kept| kept != line) {
                bits |= kept.hash != line.hash;
                changed.push(format!("was {kept}\nis  {line}"));
            }
        }
        let told = changed.join("\n");
        if bits && self.version == now.version {
            Verdict::Refused(format!(
                "results changed in their bits, and their version is still {VERSION}:\n{told}\n\
                 If that is meant, raise VERSION in crates/stack/src/ensemble.rs, say in \
                 CHANGELOG.md under *Results change* what changed, and type `{RENEW}`."
            ))
        } else if self == now {
            Verdict::Kept
        } else {
            Verdict::Stale(format!(
                "what is kept of the bits is not what is computed (version {} kept, {} now):\n\
                 {told}\ntype `{RENEW}` and commit what it writes",
                self.version, now.version
            ))
        }
    }
}

/// Result of a comparison with stored references.
pub(crate) enum Verdict {
    /// Equal.
    Kept,
    /// The results differ, although the version is the same.
    Refused(String),
    /// The version differs, the same results took other work, or the cases differ.
    Stale(String),
}

/// Returns the file of the references; results depend on the platform, too.
pub(crate) fn file() -> PathBuf {
    let name = format!("{}.txt", std::env::consts::ARCH);
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

/// A stack of two to four levels, half of which collapse, with straps that may tear in one of five.
fn small_case(at: u32) -> Prepared {
    let settings = [
        format!("stack.levels={}", 2 + at % 3),
        format!("stack.strap.levels={}", if at.is_multiple_of(5) { 2 } else { 0 }),
        format!("stack.strap.strength='{} kN'", 3 + at % 4),
        format!("motion.sine.period='{} s'", 0.6 + 0.05 * f64::from(at % 11)),
        format!("motion.sine.amplitude='{} cm'", 4 + at % 10),
        "motion.sine.ramp_cycles=0".to_owned(),
        "run.duration='1.6 s'".to_owned(),
        "run.stop_after_collapse='0.2 s'".to_owned(),
    ];
    let scenario = Scenario::builtin("candia-8-barrels", &settings).expect("a case is sound");
    Prepared::new(scenario).expect("its motion is a formula")
}

fn of_run(name: &str, scenario: &str, changes: &[&str]) -> Line {
    let changes: Vec<String> = changes.iter().map(|change| change.replace('\'', "\"")).collect();
    let scenario = Scenario::builtin(scenario, &changes).expect("a case is sound");
    let run = scenario.run().expect("a case runs");
    let mut hash = Hash::default();
    hash.run(&run);
    Line { name: name.to_owned(), hash: hash.0, work: run.work }
}

fn of_lanes(width: Width, cases: &[Prepared]) -> Line {
    let mut audience = Audience { on_case: &mut |_| {}, stop: &|| false };
    let results = simulate_in(width, cases, &mut audience).expect("nobody stops it");
    let mut hash = Hash::default();
    for result in &results {
        hash.case(result);
    }
    let steps = results.iter().filter_map(|result| result.steps).sum();
    let work = Work { steps, ..Work::default() };
    Line { name: "small-cases-in-lanes".to_owned(), hash: hash.0, work }
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn number(&mut self, value: f64) {
        self.bytes(&value.to_bits().to_le_bytes());
    }

    /// Adds an optional number; `None` differs from every number.
    fn known(&mut self, value: Option<f64>) {
        self.bytes(&[u8::from(value.is_some())]);
        self.number(value.unwrap_or_default());
    }

    fn outcome(&mut self, outcome: &Outcome) {
        self.bytes(outcome.kind().as_bytes());
        match outcome {
            Outcome::Stable
            | Outcome::NotJudged
            | Outcome::Interrupted
            | Outcome::Invalid { .. } => {}
            Outcome::Collapse { mode, time, first, from_level, to_level } => {
                self.bytes(mode.name().as_bytes());
                self.number(*time);
                self.bytes(first.as_bytes());
                self.bytes(&from_level.to_le_bytes());
                self.bytes(&to_level.to_le_bytes());
            }
        }
    }

    /// Adds the trajectory of every body, the final energies, which include the last velocities, and the outcome.
    fn run(&mut self, run: &Run) {
        self.outcome(&run.outcome);
        self.number(run.end_time);
        self.known(run.fates.first_fall());
        run.recording.frames.poses.iter().flatten().flatten().for_each(|value| self.number(*value));
        let energy = run.energy.expect("no case breaks down");
        let stored = [energy.kinetic, energy.potential, energy.elastic, energy.stick];
        let lost = [energy.damped, energy.friction, energy.viscous];
        let rest = [energy.ground_work, energy.residual, energy.throughput];
        stored.into_iter().chain(lost).chain(rest).for_each(|value| self.number(value));
        for element in &run.elements {
            self.known(element.broken_at);
        }
    }

    /// Adds the results of a case in a lane.
    fn case(&mut self, case: &CaseResult) {
        self.outcome(case.outcome.as_ref().expect("a case runs"));
        self.known(case.first_fall);
        case.falls.iter().for_each(|(_, fall)| self.known(*fall));
        case.fall_heights.iter().for_each(|height| self.number(*height));
        self.known(case.residual_displacement);
        self.known(case.end_time);
        self.known(case.energy_residual_ratio);
    }
}
