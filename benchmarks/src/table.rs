//! Performance targets and present measurements. Where available, a row also states the cheapest peer that was run on
//! the same scene in the same process, and the plain loop of [`plain`](crate::plain).

use std::f64::consts::TAU;

use barrelstack::assemble::assemble;
use barrelstack::{Scenario, variants};
use barrelstack_dynamics::{Drive, Planar, Scratch, State, Vec2, settle};
use barrelstack_space::{Ground, run};

use crate::scene::{AMPLITUDE, PERIOD, Scene};
use crate::{Failure, lanes, peer, peer3, plain, program, space, user};

/// Time step (s) of the row that measures the library.
const STEP: f64 = 0.5e-3;

/// Number of cases in the planar study of the table, and the simulated time (s) of each case.
const MANY: f64 = 10_000.0;
const LENGTH: f64 = 20.0;

/// Number of variants in the three-dimensional study of the table, and the number of variants that are run; the time of
/// the study is extrapolated from them.
const MANY_IN_SPACE: f64 = 1000.0;
const IN_SPACE: u32 = 32;

/// Number of cores for which the targets of whole studies are stated.
const CORES: f64 = 2.0;

/// Angle (degrees) of the supports of the scene on which five codes agree.
const ANGLE: f64 = 20.0;

/// Friction coefficients of the peers, on the ground and between bodies.
const FRICTION: [f64; 2] = [0.5, 0.22];

/// Measured quantity of a row, which is compared with the target of the row.
enum Figure {
    /// Processor time (s) per simulated second, printed in ms; less is better.
    Cost(f64),
    /// Simulated time per processor time; more is better.
    Speed(f64),
    /// Time (s) of a whole study or command; less is better.
    Seconds(f64),
}

/// One row of the table.
struct Row {
    what: String,
    figure: Figure,
    target: f64,
    /// Fastest peer, with its time (s) for the same work.
    peer: Option<(String, f64)>,
    /// Time (s) of the plain loop for the same work.
    plain: Option<f64>,
}

impl Row {
    fn new(what: impl Into<String>, figure: Figure, target: f64) -> Self {
        Self { what: what.into(), figure, target, peer: None, plain: None }
    }

    /// Adds the times of the cheapest peer and of the plain loop for the work of this row. `peers` (the cheapest first)
    /// and `plain` state costs (s) per simulated second; they are multiplied by `times`, the simulated time (s) of the
    /// row per core.
    fn beside(mut self, peers: &[peer::Cost], plain: Option<f64>, times: f64) -> Self {
        self.peer = peers.first().map(|peer| (peer.engine.to_owned(), peer.second * times));
        self.plain = plain.map(|plain| plain * times);
        self
    }

    fn print(&self) {
        let target = self.target;
        let (now, aim, seconds, met) = match self.figure {
            Figure::Cost(cost) => {
                let ms = 1e3 * cost;
                (format!("{ms:.2} ms"), format!("≤ {target} ms"), cost, ms <= target)
            }
            Figure::Speed(speed) => {
                (format!("{speed:.0} ×"), format!("≥ {target} ×"), 1.0 / speed, speed >= target)
            }
            Figure::Seconds(time) => {
                (format!("{time:.1} s"), format!("≤ {target} s"), time, time <= target)
            }
        };
        let ratio = |other: f64| format!("{:.2}", other / seconds);
        let (peer, by) = self
            .peer
            .as_ref()
            .map_or(("–".to_owned(), "–".to_owned()), |peer| (peer.0.clone(), ratio(peer.1)));
        let plain = self.plain.map_or("–".to_owned(), ratio);
        let met = if met { "yes" } else { "**no**" };
        println!("| {} | {now} | {aim} | {met} | {peer} | {by} | {plain} |", self.what);
    }
}

/// Costs of the peers in the planar scenes of the table.
struct Peers {
    /// The scene on which five codes agree.
    agreed: Vec<peer::Cost>,
    /// A user's stack of eight barrels on solid racks: a run in which it stands, and a run in which it falls.
    standing: Vec<peer::Cost>,
    falling: Vec<peer::Cost>,
}

/// Prints the table; of the ten thousand cases of the study, only `cases` are run. With `protect`, the
/// command of that name is measured as well, which takes minutes.
pub(crate) fn print(cases: usize, protect: bool) -> Result<(), Failure> {
    let plain = plain::costs(ANGLE)?;
    let peers = peers()?;
    let mut rows = planar(cases, &plain, &peers)?;
    rows.extend(singles(&plain, &peers)?);
    rows.extend(spatial()?);
    rows.extend(commands(protect)?);
    println!();
    println!(
        "| quantity | measured | target | met | cheapest peer | peer ÷ this program | plain loop ÷ this program |"
    );
    println!("| :--- | ---: | ---: | :--- | :--- | ---: | ---: |");
    rows.iter().for_each(Row::print);
    println!();
    println!(
        "ms: processor milliseconds per simulated second and core. ×: simulated time in one second of a core. s: \
         seconds, of commands by the clock. Peers: time step {:.1} ms except where stated, defaults otherwise; plain \
         loop: {:.1} ms.",
        1e3 * peer::COARSE,
        1e3 * plain::STEP
    );
    println!("{}", busy());
    Ok(())
}

/// Describes the load and the processor of the machine.
fn busy() -> String {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load: Vec<&str> = load.split(' ').take(3).collect();
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "machine: {}, {cores} cores; load averages of the last 1, 5 and 15 minutes: {}",
        model.unwrap_or("unknown processor"),
        if load.is_empty() { "unknown".to_owned() } else { load.join(", ") }
    )
}

fn peers() -> Result<Peers, Failure> {
    let sine =
        |amplitude: f64| move |time: f64| Vec2::new(amplitude * (TAU / PERIOD * time).sin(), 0.0);
    let scene = Scene::consensus(ANGLE)?;
    // The scene that a user runs: the paper's stack with its solid racks.
    let assembly = assemble(&Scenario::builtin("candia-8-barrels", &[])?)?;
    let mut rest = State::initial(&assembly.model);
    settle(&assembly.model, &mut rest, &mut Scratch::new(&assembly.model), 1e-9)?;
    let (small, large) = (sine(user::STANDING[1]), sine(AMPLITUDE));
    let stage = |model, rest, ground, duration| peer::Stage {
        model,
        rest,
        ground,
        friction: FRICTION,
        duration,
    };
    Ok(Peers {
        agreed: peer::costs(&stage(&scene.model, &scene.rest, &large, 1.2), peer::COARSE)?,
        standing: measured("standing", &stage(&assembly.model, &rest, &small, 10.0))?,
        falling: measured("falling", &stage(&assembly.model, &rest, &large, 12.0))?,
    })
}

/// Measures the peers and prints their costs.
fn measured(what: &str, stage: &peer::Stage<'_>) -> Result<Vec<peer::Cost>, Failure> {
    let costs = peer::costs(stage, peer::COARSE)?;
    let words: Vec<String> = costs
        .iter()
        .map(|peer| {
            format!("{} {:.2} (largest drop {:.2} m)", peer.engine, 1e3 * peer.second, peer.dropped)
        })
        .collect();
    println!("peers, {what}, ms per simulated second: {}", words.join("; "));
    Ok(costs)
}

/// Returns the rows of planar studies.
fn planar(cases: usize, plain: &plain::Costs, peers: &Peers) -> Result<Vec<Row>, Failure> {
    let scene = Scene::consensus(ANGLE)?;
    let lanes = lanes::of_widest(&scene, STEP);
    let standing = user::study(user::STANDING)?;
    let half = user::study(user::HALF)?;
    let falling = user::collapsing()?;
    let settling = user::settling()?;
    let all = user::on_all_cores(cases)?;
    let scale = MANY / cases as f64;
    println!(
        "studies: {:.0} % of the cases collapse under the larger motions, {:.0} % with less friction under the \
         largest; {cases} of {MANY} cases were run on {} cores: {:.0} s for all of them by the clock",
        100.0 * half.collapsed,
        100.0 * falling.collapsed,
        all.cores,
        scale * all.clock
    );
    let middle: Vec<peer::Cost> = middle(&peers.standing, &peers.falling);
    let study = |what: &str, cost: user::Cost, target| {
        Row::new(format!("study of eight barrels, {what}"), Figure::Cost(cost.second), target)
    };
    let simulated = MANY * LENGTH / CORES;
    let many = Figure::Seconds(scale * all.spent / CORES);
    Ok(vec![
        Row::new(
            "lanes of the library, scene of five codes, steps of 0.5 ms",
            Figure::Cost(lanes),
            0.4,
        )
        .beside(&peers.agreed, Some(plain.standing), 1.0),
        study("standing", standing, 0.7).beside(&peers.standing, Some(plain.standing), 1.0),
        study("half collapsing", half, 1.0).beside(
            &middle,
            Some(0.5 * (plain.standing + plain.falling)),
            1.0,
        ),
        study("all collapse, followed for ten seconds", falling, 1.5).beside(
            &peers.falling,
            Some(plain.falling),
            1.0,
        ),
        Row::new("10,000 planar cases of 20 s, standing, on two cores", many, 90.0).beside(
            &peers.standing,
            Some(plain.standing),
            simulated,
        ),
        // No peer computes an equilibrium to start from.
        Row::new(
            "building and settling a case that differs in friction, per case",
            Figure::Cost(settling),
            0.5,
        ),
    ])
}

/// Returns the mean costs of the engines in two scenes, the cheapest first.
fn middle(one: &[peer::Cost], other: &[peer::Cost]) -> Vec<peer::Cost> {
    let mean = |a: &peer::Cost| {
        let b = other.iter().find(|b| b.engine == a.engine).unwrap_or(a);
        peer::Cost { second: 0.5 * (a.second + b.second), ..*a }
    };
    let mut all: Vec<peer::Cost> = one.iter().map(mean).collect();
    all.sort_by(|a, b| a.second.total_cmp(&b.second));
    all
}

/// Returns the rows of single planar runs.
fn singles(plain: &plain::Costs, peers: &Peers) -> Result<Vec<Row>, Failure> {
    let eight = user::single("candia-8-barrels", &[])?;
    let mut rows =
        vec![Row::new("single run, eight barrels (collapse)", Figure::Speed(eight), 250.0).beside(
            &peers.falling,
            Some(plain.falling),
            1.0,
        )];
    for (view, words) in
        [("transverse", "across the barrels"), ("longitudinal", "along the barrels")]
    {
        let settings = [format!("stack.view={view}")];
        let scenario = Scenario::builtin("demo-napa", &settings)?;
        let plane =
            variants::planes(&scenario)?.into_iter().next().ok_or("a scenario has a plane")?;
        let ground = plane.scenario.ground()?;
        let assembly = assemble(&plane.scenario)?;
        let mut rest = State::initial(&assembly.model);
        settle(&assembly.model, &mut rest, &mut Scratch::new(&assembly.model), 1e-9)?;
        let moved = |time: f64| Drive::<Planar>::at(&ground, time).0;
        let stage = peer::Stage {
            model: &assembly.model,
            rest: &rest,
            ground: &moved,
            friction: FRICTION,
            duration: 20.0,
        };
        let costs = measured(&format!("demo {words}"), &stage)?;
        let speed = user::single("demo-napa", &settings)?;
        rows.push(
            Row::new(format!("single run, demo {words}"), Figure::Speed(speed), 100.0)
                .beside(&costs, None, 1.0),
        );
    }
    Ok(rows)
}

/// Returns the rows of three-dimensional stacks.
fn spatial() -> Result<Vec<Row>, Failure> {
    let scenario = space::standing()?;
    let ground = Ground::of(&scenario)?;
    let standing = run::stand(&scenario)?;
    let stage = peer3::Stage {
        model: &standing.stack.model,
        rest: &standing.state,
        ground: &ground,
        friction: FRICTION,
        duration: 10.0,
    };
    let coarse = peer3::cost(&stage, peer::COARSE);
    let settled = peer3::cost(&stage, peer3::SETTLED);
    for (step, found) in [(peer::COARSE, &coarse), (peer3::SETTLED, &settled)] {
        println!(
            "Rapier 3-D, four levels, steps of {:.1} ms: {:.1} ms per simulated second (largest drop {:.0} mm)",
            1e3 * step,
            1e3 * found.second,
            1e3 * found.dropped
        );
    }
    let single = space::single()?;
    let lanes = space::lanes()?;
    let settling = space::settling()?;
    let demo = space::demo(IN_SPACE)?;
    let scale = MANY_IN_SPACE / f64::from(IN_SPACE);
    println!(
        "three dimensions: of 32 variants of the standing stack, {} collapse; building and settling take {:.0} % of their \
         time, {:.0} ms each; {IN_SPACE} of {MANY_IN_SPACE} variants of \
         the demo were run, {} of them collapse, {:.1} s simulated each: {:.0} s for all of them by the clock",
        lanes.collapsed,
        100.0 * settling.spent / lanes.spent,
        1e3 * settling.spent / f64::from(space::CASES),
        demo.collapsed,
        demo.simulated / f64::from(IN_SPACE),
        scale * demo.clock
    );
    let peers = |found: &peer3::Found, engine| {
        [peer::Cost { engine, second: found.second, dropped: found.dropped }]
    };
    let coarse = peers(&coarse, "Rapier 3-D");
    let fine = peers(&settled, "Rapier 3-D, steps of 0.5 ms");
    let mut rows = Vec::new();
    for (peer, remark) in [(&coarse, ""), (&fine, ", compared with the peer at steps of 0.5 ms")] {
        let what = |words: &str| format!("{words}{remark}");
        rows.push(
            Row::new(
                what("three dimensions, single run, eight barrels standing"),
                Figure::Speed(single),
                60.0,
            )
            .beside(peer, None, 1.0),
        );
        let cost = Figure::Cost(lanes.spent / lanes.simulated);
        rows.push(
            Row::new(what("three dimensions, lanes, eight barrels standing"), cost, 4.0)
                .beside(peer, None, 1.0),
        );
    }
    let all = Figure::Seconds(scale * demo.spent / CORES);
    rows.push(Row::new(
        "three dimensions, 1,000 variants of the demo (ten barrels) on two cores",
        all,
        90.0,
    ));
    Ok(rows)
}

/// Returns the rows of commands of the released program, whose elapsed times are measured. The command `protect` is
/// included if `protect` is `true`.
fn commands(protect: bool) -> Result<Vec<Row>, Failure> {
    let program = program::path()?;
    let demo = program::demo(&program, 2)?;
    println!(
        "demo: the answer takes {:.1} s of processor time of all cores together, the answer with a page {:.1} s",
        demo.spent[0], demo.spent[1]
    );
    let row = |what: &str, time, target| Row::new(what, Figure::Seconds(time), target);
    let mut rows = vec![
        row("demo, first sentence, clock", demo.first, 2.0),
        row("demo, final answer with mitigation, clock", demo.answer, 5.0),
        row("demo, page written, clock", demo.page, 6.0),
    ];
    if protect {
        let (clock, spent) = program::protect(&program)?;
        println!(
            "`protect` on the demo takes {spent:.0} s of processor time of all cores together"
        );
        rows.push(row("`protect` on the demo, clock", clock, 180.0));
    }
    Ok(rows)
}
