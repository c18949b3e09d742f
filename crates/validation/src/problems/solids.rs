//! Solid bodies: nothing stands in anything, what falls is stopped within millimeters, and contact is smooth
//! where boundaries slide along each other.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use barrelstack::overlap::Boundaries;
use barrelstack::scenario::Scenario;
use barrelstack_dynamics::shape::Polygon;
use barrelstack_dynamics::{
    Body, ContactPair, Counts, FrictionLaw, Model, Motion, Nodes, NormalLaw, Placed, Planar, Pose,
    Scratch, Shape, State, Still, Twist, Vec2, evaluate,
};

use crate::problem::refine;
use crate::scene::{DOWN, Scene, centered, disc, floor, ground_of, interface};
use crate::{Effort, Failure, GRAVITY, Outcome, Problem, Tolerance};

const REBOUND: &str = "balance of energy of a spring k δ^1.5";

/// A full barrel and its law of impact, those of the catalog.
const MASS: f64 = 270.0;
const STIFFNESS: f64 = 1.2e9;
const RESTITUTION: f64 = 0.3;

/// The problems of this theory.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    for height in [1.0, 2.0, 3.3] {
        list.push(depth(height));
        list.push(rebound("barrel", MASS, height));
    }
    list.push(rebound("rack corner", 10.0, 2.0));
    list.push(default_step());
    list.extend([(0.25, 2.0), (0.5, 2.0), (0.75, 2.0)].map(|(share, count)| flat(share, count)));
    list.push(smooth());
    list.push(overlaps());
    list
}

fn law() -> NormalLaw {
    NormalLaw::Rebound { stiffness: STIFFNESS, restitution: RESTITUTION, speed: 0.1 }
}

/// A mass that meets the floor after a fall from a height (m): its greatest depth (m), and its speed
/// (m/s) as it leaves.
fn drop(mass: f64, height: f64, step: f64) -> Result<(f64, f64), Failure> {
    let radius = 0.35;
    let mut body = disc("mass", radius, mass, 0.01, Vec2::new(0.0, radius));
    body.twist = Twist { linear: Vec2::new(0.0, -speed_after(height)), angular: 0.0 };
    let mut scene =
        Scene::new(vec![floor(), body], interface(law(), FrictionLaw::Frictionless), DOWN)?;
    let (mut deepest, mut left) = (0.0_f64, None);
    scene.watch(&Still, step, 0.2, |state, _, _| {
        let depth = radius - state.poses[1].position.z;
        deepest = deepest.max(depth);
        if depth <= 0.0 && state.twists[1].linear.z > 0.0 {
            left = Some(state.twists[1].linear.z);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    })?;
    let left = left.ok_or_else(|| Failure::Absent("the mass does not leave the floor".into()))?;
    Ok((deepest, left))
}

fn speed_after(height: f64) -> f64 {
    (2.0 * GRAVITY * height).sqrt()
}

/// How deep a barrel goes: `½ m v² + m g δ = ⅖ k δ^2.5`, while it is much faster than the speed at which
/// the law begins to damp.
fn depth(height: f64) -> Problem {
    let energy = MASS * GRAVITY * height;
    let mut exact = 0.01;
    for _ in 0..100 {
        exact = ((energy + MASS * GRAVITY * exact) / (0.4 * STIFFNESS)).powf(0.4);
    }
    Problem {
        id: format!("solids/depth-{height:.1}m"),
        title: format!("a full barrel of {MASS} kg falls {height} m on the floor"),
        source: REBOUND.into(),
        quantity: "greatest depth",
        unit: "m",
        exact,
        tolerance: Tolerance::Relative(2e-3),
        fast: None,
        run: Box::new(move |effort| {
            refine(effort, exact, |level| Ok(drop(MASS, height, 1e-5 / 2.0_f64.powi(level))?.0))
        }),
    }
}

/// How fast it leaves, whatever its mass.
fn rebound(what: &str, mass: f64, height: f64) -> Problem {
    Problem {
        id: format!("solids/restitution-{}-{height:.1}m", what.replace(' ', "-")),
        title: format!("a {what} ({mass} kg at the contact) falls {height} m on the floor"),
        source: "e² of the energy comes back; Walton and Braun 1986".into(),
        quantity: "speed after over speed before",
        unit: "",
        exact: RESTITUTION,
        tolerance: Tolerance::Relative(2e-2),
        fast: None,
        run: Box::new(move |effort| {
            let step = if effort == Effort::Full { 1e-6 } else { 1e-5 };
            let (depth, left) = drop(mass, height, step)?;
            let share = left / speed_after(height);
            Ok(Outcome::of(share).noted(format!("{:.1} mm deep", 1e3 * depth)))
        }),
    }
}

/// The same with the step that a stack takes.
fn default_step() -> Problem {
    Problem {
        id: "solids/restitution-at-the-default-step".into(),
        title: "a full barrel falls 3.3 m, computed with steps of 0.25 ms".into(),
        source: "e² of the energy comes back; Walton and Braun 1986".into(),
        quantity: "speed after over speed before",
        unit: "",
        exact: RESTITUTION,
        tolerance: Tolerance::Relative(0.1),
        fast: None,
        run: Box::new(|_| {
            let (depth, left) = drop(MASS, 3.3, 2.5e-4)?;
            let said = [1e-4, 5e-4].map(|step| drop(MASS, 3.3, step));
            let [fine, coarse] = said;
            let share = |left: f64| left / speed_after(3.3);
            let note = format!(
                "{:.1} mm deep; {:.3} at 0.1 ms, {:.3} at 0.5 ms",
                1e3 * depth,
                share(fine?.1),
                share(coarse?.1)
            );
            Ok(Outcome::of(share(left)).noted(note))
        }),
    }
}

/// A box with rounded corners that touches others exactly.
fn solid(name: &str, (width, height): (f64, f64), corner: f64, pose: Pose<Planar>) -> Body<Planar> {
    let shape = match Polygon::rectangle(width, height, corner) {
        Ok(polygon) => Shape::Polygon(polygon),
        Err(problem) => panic!("a box of {width} m by {height} m: {problem}"),
    };
    let rounds = Nodes::Rounds(shape.rounds(1.0));
    Body {
        name: name.into(),
        motion: Motion::Free,
        mass: 100.0,
        inertia: 10.0,
        damping: None,
        pose,
        twist: Twist::default(),
        surfaces: vec![centered(shape)],
        nodes: vec![rounds],
        faces: Vec::new(),
    }
}

/// Two boxes that test each other both ways, the first of them the lower.
fn boxes(upper: Pose<Planar>, swapped: bool) -> Result<(Model<Planar>, State<Planar>), Failure> {
    let below =
        solid("below", (1.0, 0.2), 0.01, Pose { position: Vec2::default(), orientation: 0.0 });
    let above = solid("above", (0.6, 0.2), 0.01, upper);
    let bodies = if swapped {
        vec![ground_of(Vec::<Placed<Planar>>::new()), above, below]
    } else {
        vec![ground_of(Vec::new()), below, above]
    };
    let pair = |contactor, target| ContactPair {
        contactor,
        nodes: 0,
        target,
        surface: 0,
        interface: 0,
        counts: Counts::Everywhere,
    };
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 0.0 };
    let laws = vec![interface(law, FrictionLaw::Frictionless)];
    let model = Model::new(bodies, laws, vec![pair(1, 2), pair(2, 1)], DOWN)?;
    let state = State::initial(&model);
    Ok((model, state))
}

/// Forces on the upper box: horizontal, vertical (N), moment (N m), and how many contacts make them.
fn forces_on(upper: Pose<Planar>, swapped: bool) -> Result<([f64; 3], usize), Failure> {
    let (model, state) = boxes(upper, swapped)?;
    let mut scratch = Scratch::new(&model);
    evaluate(&model, &state, &mut scratch);
    let wrench = scratch.wrenches[if swapped { 1 } else { 2 }];
    Ok(([wrench.force.x, wrench.force.z, wrench.moment], scratch.contacts.len()))
}

/// A box flat on another: two contacts, at the ends of where they overlap, whichever box they are of.
fn flat(share: f64, count: f64) -> Problem {
    Problem {
        id: format!("solids/flat-on-flat-{share:.2}"),
        title: format!("a box flat on another, {share} of its width beyond the edge or not"),
        source: "two lines that overlap touch at the two ends of the overlap".into(),
        quantity: "contacts",
        unit: "",
        exact: count,
        tolerance: Tolerance::Absolute(0.0),
        fast: None,
        run: Box::new(move |_| {
            let pose = Pose { position: Vec2::new(share * 0.6, 0.2 - 1e-3), orientation: 0.0 };
            let (one, contacts) = forces_on(pose, false)?;
            let (other, swapped) = forces_on(pose, true)?;
            let apart = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if apart > 1e-9 * one[1].abs() || contacts != swapped {
                return Err(Failure::Absent(format!(
                    "swapping the boxes changes forces by {apart} N"
                )));
            }
            Ok(Outcome::of(contacts as f64).noted(format!("{:.0} N", one[1])))
        }),
    }
}

/// Forces change smoothly while one box goes along paths over flats, edges and corners of the other: the
/// largest jump between neighbors of a fine path, over the largest change that the stiffness explains.
fn smooth() -> Problem {
    Problem {
        id: "solids/smooth-along-paths".into(),
        title: "a box led over flats, edges and corners of another on 40 paths".into(),
        source: "forces of a spring of stiffness k change by k times the way".into(),
        quantity: "largest jump of a force over k times the step, in excess of 4",
        unit: "",
        exact: 0.0,
        tolerance: Tolerance::Absolute(1e-9),
        fast: None,
        run: Box::new(|effort| {
            let steps = if effort == Effort::Full { 4000 } else { 1000 };
            let (mut worst, mut touching) = (0.0_f64, 0_u64);
            for path in 0..40 {
                // From the left edge to the right one, sinking and turning a little on the way.
                let lean = f64::from(path) / 40.0 - 0.5;
                let depth = 1e-3 * (1.0 + f64::from(path % 4));
                let at = |i: i32| {
                    let share = f64::from(i) / f64::from(steps);
                    let angle = 0.02 * lean * (2.0 * PI * share).sin();
                    Pose {
                        position: Vec2::new(1.7 * share - 0.85, 0.2 - depth),
                        orientation: angle,
                    }
                };
                let mut before: Option<[f64; 3]> = None;
                for i in 0..=steps {
                    let (forces, contacts) = forces_on(at(i), false)?;
                    touching += contacts as u64;
                    if let Some(before) = before {
                        let (from, to) = (at(i - 1), at(i));
                        let way = (to.position - from.position).x.abs()
                            + (to.orientation - from.orientation).abs();
                        let jump =
                            (0..2).map(|k| (forces[k] - before[k]).abs()).fold(0.0, f64::max);
                        worst = worst.max(jump / (1e6 * way) - 4.0);
                    }
                    before = Some(forces);
                }
            }
            Ok(Outcome::of(worst.max(0.0)).noted(format!("{touching} contacts on the way")))
        }),
    }
}

/// Stacks of all kinds under strong shaking, all frames until rest: how deep bodies stand in each other
/// that are no seat of each other.
fn overlaps() -> Problem {
    Problem {
        id: "solids/overlap-of-falling-stacks".into(),
        title: "stacks of two to six levels, both planes, all racks, shaken until they fall, all frames".into(),
        source: "bodies are solid".into(),
        quantity: "deepest overlap but at seats",
        unit: "m",
        exact: 0.0,
        tolerance: Tolerance::Absolute(0.015),
        fast: None,
        run: Box::new(|effort| {
            let count = if effort == Effort::Full { 300 } else { 8 };
            let mut worst = Survey::default();
            let mut fallen = 0;
            for case in 0..count {
                let scenario = random_stack(case)?;
                let run = match scenario.run() {
                    Ok(run) => run,
                    // A rack whose rails lie too steep on the staves does not stand, and says so.
                    Err(barrelstack::RunFailure::Settle(_)) => continue,
                    Err(failure) => return Err(failure.into()),
                };
                fallen += usize::from(run.fates.collapse_time().is_some());
                worst.look(&run);
            }
            if fallen * 3 < count {
                return Err(Failure::Absent(format!("only {fallen} of {count} stacks fell")));
            }
            let note = format!(
                "{fallen} of {count} stacks fell; at seats {:.1} mm, at the end {:.1} mm and at seats \
                 {:.1} mm; books open by {:.1e} at most",
                1e3 * worst.seat,
                1e3 * worst.end,
                1e3 * worst.seat_end,
                worst.books
            );
            Ok(Outcome::of(worst.loose).noted(note))
        }),
    }
}

/// The deepest overlaps (m) seen.
#[derive(Default)]
struct Survey {
    /// Of two bodies that the stack does not join.
    loose: f64,
    /// Of a body and what it has its seat on.
    seat: f64,
    /// The same in the last frame.
    end: f64,
    seat_end: f64,
    /// Largest residual of the energy books.
    books: f64,
}

impl Survey {
    fn look(&mut self, run: &barrelstack::Run) {
        let boundaries = Boundaries::new(&run.assembly.model);
        let parts = &run.assembly.parts;
        let joined = |a: usize, b: usize| {
            parts[b].carrier == Some(a)
                || parts[a].carrier == Some(b)
                || parts[a].supports.contains(&b)
                || parts[b].supports.contains(&a)
                || (a == 0 && parts[b].supports.is_empty() && parts[b].carrier.is_none())
        };
        let frames = &run.recording.frames;
        for (index, poses) in frames.all_poses().enumerate() {
            for overlap in boundaries.overlaps(&poses) {
                let seat = joined(overlap.bodies[0], overlap.bodies[1]);
                let last = index + 1 == frames.times.len();
                let most = if seat { &mut self.seat } else { &mut self.loose };
                *most = most.max(overlap.depth);
                if last {
                    let most = if seat { &mut self.seat_end } else { &mut self.end };
                    *most = most.max(overlap.depth);
                }
            }
        }
        if let Some(energy) = &run.energy {
            self.books = self.books.max(energy.residual_ratio());
        }
    }
}

/// A stack that depends on nothing but its number.
fn random_stack(case: usize) -> Result<Scenario, Failure> {
    let pick = |salt: usize, count: usize| {
        // A linear congruential generator, a few turns from the number of the case.
        let mut state = (case * 31 + salt * 7919 + 12345) as u64;
        for _ in 0..4 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
        }
        (state >> 33) as usize % count
    };
    let view = ["transverse", "longitudinal"][pick(1, 2)];
    let racks: &[&str] = if view == "transverse" {
        &["two-barrel", "rack-on-rack", "candia-2008", "two-barrel-feet"]
    } else {
        &["two-barrel", "four-barrel", "candia-2008"]
    };
    let rack = racks[pick(2, racks.len())];
    let columns = match (view, rack) {
        ("transverse", _) | (_, "four-barrel") => 2,
        _ => 1,
    };
    let text = format!(
        "schema = 1\ntitle = \"case {case}\"\n[stack]\nview = \"{view}\"\nlevels = {}\ncolumns = {columns}\n\
         rack = \"{rack}\"\n[interface.rack-ground.friction]\ncoefficient = {}\n\
         [interface.barrel-rack.friction]\ncoefficient = {}\n\
         [motion]\nbundled = \"napa-college-2014\"\ncomponent = \"horizontal-{}\"\nvertical = \"UP\"\n\
         scale = {{ pgv = \"{} cm/s\" }}\n[record]\nframe_rate = \"50 Hz\"\n",
        2 + pick(3, 5),
        [0.4, 0.5, 0.65][pick(4, 3)],
        [0.2, 0.3, 0.45][pick(5, 3)],
        1 + pick(6, 2),
        [80, 120, 160][pick(7, 3)],
    );
    Ok(Scenario::parse("random stack", &text, &[])?)
}
