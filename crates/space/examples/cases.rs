//! Exports cases for comparison with another physics engine: three-dimensional stacks at rest before the motion, and
//! the outcome that this program computes for each.
//!
//! ```text
//! cargo run --release -p barrelstack-space --example cases -- 50 cases "stack.levels=3+motion.scale.factor=0.5"
//! ```
//!
//! The first argument is the number of cases, the second the output folder, the third a change of `demo-napa`; several
//! changes are joined by `+`. The cases are the first variants of the example `evidence`, so shares can be compared.
//!
//! If the first argument is `grid`, 36 cases are written: stacks of two to five levels, with three coefficients of
//! friction between barrels and racks, under three factors on the motion. Each case is one variant, which differs from
//! the stated stack only in positions and masses.
//!
//! Files such as `motion-1.json` have the velocity of the ground, files such as `0001.json` one case each: bodies at
//! rest with their masses, solids and seats; the pairs of solids that may touch, with their laws; the thresholds; and
//! two outcomes. `outcome` is that of the case as stated. `alike` is that of seats as in MuJoCo, whose friction holds
//! without a tangential spring and whose damper acts in both directions, with the same restitution. All values are in
//! SI units; rotations are quaternions `w`, `x`, `y`, `z` from the body frame to the inertial frame.

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use barrelstack::Scenario;
use barrelstack::outcome::Outcome;
use barrelstack::run::thresholds;
use barrelstack::variants::planes;
use barrelstack_dynamics::solid::Hull;
use barrelstack_dynamics::{
    Drive as _, FrictionLaw, Interface, Nodes, NormalLaw, Quaternion, Rotation3, Spatial, Vec3,
};
use barrelstack_space::run::{Standing, run_on, stand};
use barrelstack_space::{Ground, Heading};
use serde_json::{Value, json};

/// Changes of `demo-napa` that all stacks share, as in `evidence`.
const COMMON: [&str; 3] =
    ["stack.view=spatial", "run.stop_after_collapse='3 s'", "run.duration='16 s'"];

/// Interfaces of seats.
const SEATS: [&str; 2] = ["barrel-rack", "rack-ground"];

/// Seats as in MuJoCo: a tangential spring that is a hundred times as stiff as the normal spring, and a damper that
/// acts in both directions.
const ALIKE: [&str; 3] = [
    "law='kelvin-voigt'",
    "friction.tangential_stiffness_ratio=100",
    "friction.tangential_damping_ratio=20",
];

/// Time step (s) of the ground motion in the file.
const MOTION_STEP: f64 = 0.5e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().unwrap_or_else(|| "50".to_owned());
    let folder = arguments.next().unwrap_or_else(|| "cases".to_owned());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let mut changes: Vec<String> = COMMON.iter().map(|&change| change.to_owned()).collect();
    for own in arguments {
        changes.extend(own.split('+').map(str::to_owned));
    }
    if count != "grid" {
        changes.push(format!("imperfections.variants={count}"));
        return write(folder, 1, &changes);
    }
    changes.extend(["imperfections.variants=1", "unknowns.drawn=false"].map(str::to_owned));
    let mut number = 1;
    for levels in 2..=5 {
        for friction in [0.22, 0.35, 0.5] {
            for factor in [0.8, 1.0, 1.3] {
                let own = [
                    format!("stack.levels={levels}"),
                    format!("interface.barrel-rack.friction.coefficient={friction}"),
                    format!("motion.scale.factor={factor}"),
                ];
                write(folder, number, &[&changes[..], &own].concat())?;
                number += 1;
            }
        }
    }
    Ok(())
}

/// Writes the variants of `demo-napa` with changes as cases, numbered from `first`.
fn write(folder: &Path, first: u32, changes: &[String]) -> Result<(), Box<dyn Error>> {
    let of = |changes: &[String]| -> Result<_, Box<dyn Error>> {
        Ok(planes(&Scenario::builtin("demo-napa", changes)?)?.swap_remove(0))
    };
    let plane = of(changes)?;
    let seats = SEATS.iter().flat_map(|seat| ALIKE.map(|own| format!("interface.{seat}.{own}")));
    // The law comes first, so that a restitution among the changes applies to it.
    let alike = of(&seats.chain(changes.iter().cloned()).collect::<Vec<_>>())?;
    let ground = Ground::of(&plane.scenario)?;
    let name = format!("motion-{first}.json");
    std::fs::write(folder.join(&name), motion(&ground).to_string())?;
    for variant in plane.numbers().into_iter().filter(|number| *number > 0) {
        let number = first + variant - 1;
        let scenario = plane.variant(variant);
        let mut case = case(number, &scenario, &stand(&scenario)?);
        case["motion"] = json!(name);
        case["changes"] = json!(changes);
        case["outcome"] = outcome(&scenario, &ground)?;
        case["alike"] = outcome(&alike.variant(variant), &ground)?;
        println!("{number}: {}; alike {}", case["outcome"], case["alike"]);
        std::fs::write(folder.join(format!("{number:04}.json")), format!("{case:#}"))?;
    }
    Ok(())
}

/// Returns the velocity of the ground (m/s) at equal time steps.
fn motion(ground: &Ground) -> Value {
    let times = (0_u32..).map(|at| f64::from(at) * MOTION_STEP);
    let times = times.take_while(|time| *time < ground.end() + MOTION_STEP);
    let velocity: Vec<Value> = times.map(|time| vector(ground.at(time).1)).collect();
    json!({ "step": MOTION_STEP, "velocity": velocity })
}

/// Returns a case without its outcome.
fn case(number: u32, scenario: &Scenario, standing: &Standing) -> Value {
    let Standing { stack, state, .. } = standing;
    let limits = thresholds(scenario);
    let body = |(id, part): (usize, &barrelstack_space::stack::Part)| {
        let of = &stack.model.bodies()[id];
        let pose = &state.poses[id];
        json!({
            "name": part.name,
            "kind": format!("{:?}", part.kind).to_lowercase(),
            "level": part.level,
            "mass": of.mass,
            "inertia": vector(of.inertia),
            "position": vector(pose.position),
            "quaternion": quaternion(pose.orientation),
            "solids": of.nodes.iter().filter_map(solid).collect::<Vec<_>>(),
            "carrier": part.carrier,
            "supports": part.supports,
            "size": part.size,
        })
    };
    let pair = |pair: barrelstack_dynamics::ContactPair| {
        json!([pair.contactor, pair.nodes, pair.target, pair.surface, pair.interface])
    };
    json!({
        "number": number,
        "gravity": scenario.run.gravity,
        "end_time": scenario.run.duration,
        "after_collapse": scenario.run.stop_after_collapse,
        "thresholds": {
            "seat_loss_ratio": limits.seat_loss_ratio,
            "fall_drop": limits.fall_drop,
            "rack_slide_ratio": limits.rack_slide_ratio,
            "rocking_angle": limits.rocking_angle,
            "overturning_angle": limits.overturning_angle,
        },
        "reach": stack.reach,
        "interfaces": stack.model.interfaces().iter().map(interface).collect::<Vec<_>>(),
        "bodies": stack.parts.iter().enumerate().map(body).collect::<Vec<_>>(),
        "pairs": stack.model.pairs().map(pair).collect::<Vec<_>>(),
    })
}

/// Returns the outcome that this program computes, and the computing time (s).
fn outcome(scenario: &Scenario, ground: &Ground) -> Result<Value, Box<dyn Error>> {
    let start = Instant::now();
    let run = run_on(scenario, ground.clone(), &mut |_| ControlFlow::Continue(()))?;
    let seconds = start.elapsed().as_secs_f64();
    let (time, first, mode) = match &run.outcome {
        Outcome::Collapse { time, first, mode, .. } => (Some(*time), first.as_str(), mode.name()),
        Outcome::Stable | Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. } => {
            (None, "", "")
        }
    };
    Ok(json!({
        "kind": run.outcome.kind(),
        "time": time,
        "first": first,
        "mode": mode,
        "heading": run.heading.map(Heading::name),
        "first_fall": run.first_fall,
        "fallen": run.fallen().count(),
        "step": run.simulation.time_step,
        "end_time": run.end_time,
        "seconds": seconds,
    }))
}

/// Returns a solid with its position and rotation in the frame of its body; its axis is along its own `x`.
fn solid(nodes: &Nodes<Spatial>) -> Option<Value> {
    let Nodes::Whole(whole) = nodes else { return None };
    let mut told = match whole.hull {
        Hull::Capsule(tube) => {
            json!({ "kind": "capsule", "half_length": tube.half_length, "radius": tube.radius })
        }
        Hull::Barrel(barrel) => json!({
            "kind": "barrel",
            "half_length": barrel.half_length,
            "head_radius": barrel.head_radius,
            "stave_radius": barrel.stave_radius,
            "stave_offset": barrel.stave_offset,
            "rounding": barrel.rounding,
        }),
        Hull::Block(_) => return None,
    };
    told["center"] = vector(whole.center);
    told["matrix"] = matrix(whole.rotation);
    Some(told)
}

fn interface(law: &Interface<Spatial>) -> Value {
    let (coefficient, tangential) = match law.friction {
        FrictionLaw::Coulomb { kinetic_coefficient, tangential_stiffness, .. } => {
            (kinetic_coefficient, tangential_stiffness)
        }
        FrictionLaw::Regularized { coefficient, .. } => (coefficient, 0.0),
        FrictionLaw::Frictionless => (0.0, 0.0),
    };
    json!({
        "name": law.name,
        "normal": normal(&law.normal),
        "stop": law.stop.map(|stop| json!({ "depth": stop.depth, "normal": normal(&stop.law) })),
        "friction": coefficient,
        "tangential_stiffness": tangential,
        "basis": law.basis.name(),
        "law": format!("{law:?}"),
    })
}

fn normal(law: &NormalLaw) -> Value {
    match *law {
        NormalLaw::SpeedGap { stiffness, damping } => {
            json!({ "kind": "speed-gap", "stiffness": stiffness, "damping": damping })
        }
        NormalLaw::KelvinVoigt { stiffness, damping } => {
            json!({ "kind": "kelvin-voigt", "stiffness": stiffness, "damping": damping })
        }
        NormalLaw::Rebound { stiffness, restitution, speed } => json!({
            "kind": "rebound", "stiffness": stiffness, "restitution": restitution, "speed": speed,
        }),
        NormalLaw::HuntCrossley { .. } | NormalLaw::Hertz { .. } => json!({ "kind": "other" }),
    }
}

fn vector(v: Vec3) -> Value {
    json!([v.x, v.y, v.z])
}

fn quaternion(q: Quaternion) -> Value {
    json!([q.w, q.v.x, q.v.y, q.v.z])
}

fn matrix(rotation: Rotation3) -> Value {
    Value::Array(rotation.rows.map(vector).into())
}
