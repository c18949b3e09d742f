//! Adapter of this engine for `RockBench`: reads a case on standard input, writes the answer on standard output.

use std::io::Read;
use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Instant;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::shape::{Circle, HalfPlane, Polygon};
use barrelstack_dynamics::solid::{Ball, Barrel, Block, Hull, Rounded};
use barrelstack_dynamics::{
    Basis, Body, BodyId, ContactPair, Counts, Drive, FrictionLaw, Interface, Method, Model, Motion,
    Nodes, NormalLaw, Placed, Planar, Pose, Quaternion, Rotation3, Scratch, Shape, Simulation,
    Solid, Space, Spatial, State, Twist, Vec2, Vec3, look, simulate,
};
use serde_json::{Value, json};

/// Reason why a case cannot be run.
type Refusal = Box<dyn std::error::Error>;

/// Step (s) where contacts are rigid, and where all of them have a stiffness of their own.
const RIGID_STEP: f64 = 2e-5;
const SOFT_STEP: f64 = 1e-4;

#[allow(clippy::print_stdout, clippy::print_stderr, reason = "a command")]
#[allow(dead_code, reason = "a test of the workspace includes this file and calls `answer`")]
fn main() -> ExitCode {
    let mut text = String::new();
    let case = match std::io::stdin().read_to_string(&mut text) {
        Ok(_) => serde_json::from_str::<Value>(&text).map_err(Refusal::from),
        Err(error) => Err(error.into()),
    };
    match case {
        Ok(case) => {
            println!("{}", answer(&case));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the answer to a case, or the reason why there is none.
pub(crate) fn answer(case: &Value) -> Value {
    let made = if case["space"] == "planar" { planar(case) } else { spatial(case) };
    let mut made = made.unwrap_or_else(
        |refusal| json!({ "cannot": [{ "what": "case", "why": refusal.to_string() }] }),
    );
    made["engine"] = json!("barrelstack");
    made["version"] = json!(env!("CARGO_PKG_VERSION"));
    made
}

/// Measures the time that the processor spent on this thread, or where the system does not state it, real time.
struct Clock {
    processor: Option<f64>,
    start: Instant,
}

impl Clock {
    fn processor() -> Option<f64> {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok().map(|nanoseconds| 1e-9 * nanoseconds)
    }

    fn start() -> Self {
        Self { processor: Self::processor(), start: Instant::now() }
    }

    fn seconds(&self) -> f64 {
        match (self.processor, Self::processor()) {
            (Some(before), Some(now)) => now - before,
            _ => self.start.elapsed().as_secs_f64(),
        }
    }
}

fn numbers<const N: usize>(value: &Value) -> Result<[f64; N], Refusal> {
    let list = value.as_array().ok_or_else(|| format!("expected {N} numbers, found {value}"))?;
    let list: Vec<f64> = list.iter().filter_map(Value::as_f64).collect();
    list.try_into().map_err(|_| format!("expected {N} numbers, found {value}").into())
}

fn number(value: &Value) -> Result<f64, Refusal> {
    value.as_f64().ok_or_else(|| format!("expected a number, found {value}").into())
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn name(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn vector2(value: &Value) -> Result<Vec2, Refusal> {
    numbers(value).map(|[x, z]| Vec2::new(x, z))
}

fn vector3(value: &Value) -> Result<Vec3, Refusal> {
    numbers(value).map(|[x, y, z]| Vec3::new(x, y, z))
}

/// Ground motion: acceleration linear between samples, displacement and velocity its exact integrals.
struct Ground<V> {
    times: Vec<f64>,
    accelerations: Vec<V>,
    velocities: Vec<V>,
    displacements: Vec<V>,
}

impl<V> Ground<V>
where
    V: Copy + Default + std::ops::Add<Output = V> + std::ops::Sub<Output = V>,
    V: std::ops::Mul<f64, Output = V>,
{
    fn read(case: &Value, vector: fn(&Value) -> Result<V, Refusal>) -> Result<Self, Refusal> {
        let table = &case["ground"];
        let mut ground = Self {
            times: list(&table["time"]).iter().map(number).collect::<Result<_, _>>()?,
            accelerations: list(&table["acceleration"])
                .iter()
                .map(vector)
                .collect::<Result<_, _>>()?,
            velocities: vec![V::default()],
            displacements: vec![V::default()],
        };
        for cell in 1..ground.times.len() {
            let (displacement, velocity) = ground.within(cell - 1, ground.times[cell]);
            ground.displacements.push(displacement);
            ground.velocities.push(velocity);
        }
        Ok(ground)
    }

    fn within(&self, cell: usize, time: f64) -> (V, V) {
        let (start, end) = (self.times[cell], self.times[cell + 1]);
        let (a, v, x) = (self.accelerations[cell], self.velocities[cell], self.displacements[cell]);
        let (s, slope) = (time - start, (self.accelerations[cell + 1] - a) * (1.0 / (end - start)));
        let velocity = v + a * s + slope * (0.5 * s * s);
        (x + v * s + a * (0.5 * s * s) + slope * (s * s * s / 6.0), velocity)
    }
}

impl<S: Space<Real = f64>> Drive<S> for Ground<S::Vector> {
    fn at(&self, time: f64) -> (S::Vector, S::Vector) {
        let Some(last) = self.times.last() else { return <(S::Vector, S::Vector)>::default() };
        let within = time.min(*last);
        let cell = self.times.partition_point(|t| *t <= within).clamp(1, self.times.len() - 1) - 1;
        let (displacement, velocity) = self.within(cell, within);
        (displacement + velocity * (time - within), velocity)
    }
}

/// Kind of the boundary of a piece, which decides how two pieces meet.
#[derive(Clone, Copy, PartialEq)]
enum Piece {
    Flat,
    Round,
    Cornered,
}

/// A body with the kinds of its pieces; a piece that is not flat has the node set of its rank among those.
struct Made<S: Space> {
    body: Body<S>,
    pieces: Vec<Piece>,
}

impl<S: Space> Made<S> {
    fn nodes_of(&self, surface: usize) -> usize {
        self.pieces[..surface].iter().filter(|piece| **piece != Piece::Flat).count()
    }

    fn mass(&self) -> f64
    where
        S: Space<Real = f64>,
    {
        if self.body.motion == Motion::Free { self.body.mass } else { f64::INFINITY }
    }
}

/// Contacts of corners between two pieces.
#[derive(Clone, Copy)]
enum Corners {
    None,
    OfPlane,
    OfSpace,
}

/// Law of contact of two bodies: that of the case where it states a stiffness; else as stiff and as damped as the step
/// resolves.
fn interface<S: Space<Real = f64>>(
    spec: &Value,
    masses: [f64; 2],
    corners: Corners,
    step: f64,
) -> Result<Interface<S>, Refusal> {
    let mass = 1.0 / (1.0 / masses[0] + 1.0 / masses[1]);
    let friction = number(&spec["friction"])?;
    let (normal, stiffness, tangential_damping) = if spec["normal"] == "rigid" {
        let rebound = spec["restitution"].as_f64().unwrap_or(0.0);
        // A corner carries a part of its body, and several of them act on it at once.
        let (angle, share) = match corners {
            Corners::None => (0.06, 0.36),
            Corners::OfPlane => (0.02, 0.14),
            Corners::OfSpace => (0.015, 0.07),
        };
        let stiffness = mass * (angle / step) * (angle / step);
        let dead = share * mass / step;
        let law = if rebound == 0.0 {
            NormalLaw::KelvinVoigt { stiffness, damping: dead }
        } else if rebound < 1.0 && !matches!(corners, Corners::None) {
            // The mass that a corner stops depends on where the body is hit, so its law must not; as stiff as above at
            // a depth of a millimeter.
            let stiffness = stiffness / (1.5 * f64::sqrt(1e-3));
            NormalLaw::Rebound { stiffness, restitution: rebound, speed: 0.01 }
        } else {
            let ratio = restitution::kelvin_voigt_damping_ratio(rebound)
                .ok_or("restitution beyond 0 to 1")?;
            NormalLaw::KelvinVoigt {
                stiffness,
                damping: restitution::damping(stiffness, ratio, mass),
            }
        };
        (law, stiffness, 0.5 * dead)
    } else {
        let stiffness = number(&spec["normal"]["stiffness"])?;
        let damping = number(&spec["normal"]["damping"])?;
        (NormalLaw::KelvinVoigt { stiffness, damping }, stiffness, damping)
    };
    let friction = if friction > 0.0 {
        FrictionLaw::Coulomb {
            static_coefficient: friction,
            kinetic_coefficient: friction,
            tangential_stiffness: stiffness,
            tangential_damping,
        }
    } else {
        FrictionLaw::Frictionless
    };
    let basis = Basis::Node;
    Ok(Interface { name: "contact".into(), normal, stop: None, rolling: None, friction, basis })
}

/// Returns the interface of a case for two bodies: the first that names them, in either order.
fn between<'a>(case: &'a Value, names: [&str; 2]) -> Option<&'a Value> {
    let fits = |word: &Value, name: &str| word == "*" || word == name;
    list(&case["interfaces"]).iter().find(|spec| {
        let [a, b] = [&spec["between"][0], &spec["between"][1]];
        fits(a, names[0]) && fits(b, names[1]) || fits(a, names[1]) && fits(b, names[0])
    })
}

/// Runs a case, and returns its trace.
fn run<S: Space<Real = f64>>(
    case: &Value,
    all: Vec<Made<S>>,
    gravity: S::Vector,
    drive: &impl Drive<S>,
    row: impl Fn(&State<S>, BodyId) -> Vec<f64>,
) -> Result<Value, Refusal> {
    let soft = list(&case["interfaces"]).iter().all(|spec| spec["normal"] != "rigid");
    let step = case["step"].as_f64().unwrap_or(if soft { SOFT_STEP } else { RIGID_STEP });
    let flat = case["space"] == "planar";
    let (mut interfaces, mut pairs) = (Vec::new(), Vec::new());
    for one in 0..all.len() {
        for other in one + 1..all.len() {
            let (first, second) = (&all[one], &all[other]);
            if first.mass().is_infinite() && second.mass().is_infinite() {
                continue;
            }
            let Some(spec) = between(case, [&first.body.name, &second.body.name]) else { continue };
            for (i, a) in first.pieces.iter().enumerate() {
                for (j, b) in second.pieces.iter().enumerate() {
                    let corners = match (*a == Piece::Cornered || *b == Piece::Cornered, flat) {
                        (false, _) => Corners::None,
                        (true, true) => Corners::OfPlane,
                        (true, false) => Corners::OfSpace,
                    };
                    let law = interface(spec, [first.mass(), second.mass()], corners, step)?;
                    let interface = interfaces.len();
                    interfaces.push(law);
                    let counts = Counts::Everywhere;
                    let forth = ContactPair {
                        contactor: one,
                        nodes: first.nodes_of(i),
                        target: other,
                        surface: j,
                        interface,
                        counts,
                    };
                    let back = ContactPair {
                        contactor: other,
                        nodes: second.nodes_of(j),
                        target: one,
                        surface: i,
                        interface,
                        counts,
                    };
                    match (a, b) {
                        (Piece::Flat, Piece::Flat) => {}
                        (Piece::Flat, _) | (Piece::Cornered, Piece::Round) => pairs.push(back),
                        (_, Piece::Flat) | (Piece::Round, _) => pairs.push(forth),
                        // In space bodies touch as a whole; in the plane with the corners of both.
                        (Piece::Cornered, Piece::Cornered) => {
                            pairs.push(forth);
                            if flat {
                                pairs.push(back);
                            }
                        }
                    }
                }
            }
        }
    }
    let bodies: Vec<Body<S>> = all.into_iter().map(|made| made.body).collect();
    let free: Vec<BodyId> =
        (0..bodies.len()).filter(|id| bodies[*id].motion == Motion::Free).collect();
    let names: Vec<String> = free.iter().map(|id| bodies[*id].name.clone()).collect();
    let id = |word: &Value| bodies.iter().position(|body| body.name == name(word));
    let paired: Vec<[BodyId; 2]> = list(&case["forces"])
        .iter()
        .map(|pair| Some([id(&pair[0])?, id(&pair[1])?]))
        .collect::<Option<_>>()
        .ok_or("a force between bodies that do not exist")?;
    let model = Model::new(bodies, interfaces, pairs, gravity)?;
    let mut state = State::initial(&model);
    let mut scratch = Scratch::new(&model);
    let (sample, end_time) = (number(&case["sample"])?, number(&case["duration"])?);
    let simulation = Simulation { method: Method::VelocityVerlet, time_step: step, end_time };
    let (mut times, mut states, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    let clock = Clock::start();
    let mut observer = look(|state: &State<S>, scratch: &Scratch<S>, _: &_| {
        if state.time > times.len() as f64 * sample - 0.5 * step {
            times.push(state.time);
            states.push(free.iter().map(|id| row(state, *id)).collect::<Vec<_>>());
            let force = |between: &[BodyId; 2]| {
                let of = |pair: usize| {
                    let pair = model.pair(pair);
                    [pair.contactor, pair.target] == *between
                        || [pair.target, pair.contactor] == *between
                };
                let contacts = scratch.contacts.iter().filter(|contact| of(contact.pair));
                contacts.map(|contact| contact.normal_force).sum::<f64>()
            };
            forces.push(paired.iter().map(force).collect::<Vec<_>>());
        }
        ControlFlow::Continue(())
    });
    simulate(&model, drive, &mut state, &mut scratch, &simulation, &mut observer)?;
    drop(observer);
    Ok(json!({
        "step": step,
        "cpu_seconds": clock.seconds(),
        "bodies": names,
        "times": times,
        "states": states,
        "forces": forces,
    }))
}

fn motion(spec: &Value) -> Motion {
    if spec["fixed"] == true { Motion::Prescribed } else { Motion::Free }
}

/// Mass (kg) and, for fixed bodies, which need none, one.
fn mass(spec: &Value) -> f64 {
    spec["mass"].as_f64().unwrap_or(1.0)
}

fn planar(case: &Value) -> Result<Value, Refusal> {
    let bodies = list(&case["bodies"]).iter().map(planar_body).collect::<Result<_, _>>()?;
    let ground: Ground<Vec2> = Ground::read(case, vector2)?;
    run(case, bodies, vector2(&case["gravity"])?, &ground, |state, id| {
        let (shift, speed) = Drive::<Planar>::at(&ground, state.time);
        let (pose, twist) = (state.poses[id], state.twists[id]);
        let (at, moving) = (pose.position - shift, twist.linear - speed);
        vec![at.x, at.z, pose.orientation, moving.x, moving.z, twist.angular]
    })
}

fn planar_body(spec: &Value) -> Result<Made<Planar>, Refusal> {
    let pose = Pose {
        position: vector2(&spec["position"])?,
        orientation: spec["angle"].as_f64().unwrap_or(0.0),
    };
    let inertia = spec["inertia"].as_f64().unwrap_or(1.0);
    let mut body = Body::free(name(&spec["name"]), mass(spec), inertia, pose);
    body.motion = motion(spec);
    if body.motion == Motion::Free {
        body.twist = Twist { linear: vector2(&spec["velocity"])?, angular: number(&spec["spin"])? };
    }
    let mut pieces = Vec::new();
    for shape in list(&spec["shapes"]) {
        let at = if shape["at"].is_null() { Vec2::default() } else { vector2(&shape["at"])? };
        let mut polygon = |corners: Vec<Vec2>| -> Result<(), Refusal> {
            let corners: Vec<Vec2> = corners.into_iter().map(|corner| corner + at).collect();
            let shape = Shape::Polygon(Polygon::new(&corners, 0.0)?);
            body.nodes.push(Nodes::Rounds(shape.rounds(1.0)));
            let rotation = <Planar as Space>::rotation(0.0);
            body.surfaces.push(Placed { surface: shape, offset: Vec2::default(), rotation });
            pieces.push(Piece::Cornered);
            Ok(())
        };
        match name(&shape["type"]) {
            "halfspace" => {
                let rotation = <Planar as Space>::rotation(0.0);
                body.surfaces.push(Placed {
                    surface: Shape::HalfPlane(HalfPlane),
                    offset: at,
                    rotation,
                });
                pieces.push(Piece::Flat);
            }
            "disc" => {
                let radius = number(&shape["radius"])?;
                let rotation = <Planar as Space>::rotation(0.0);
                let surface = Shape::Circle(Circle { radius });
                body.surfaces.push(Placed { surface, offset: at, rotation });
                body.nodes.push(Nodes::Rolling { center: at, radius, tributary_length: 1.0 });
                pieces.push(Piece::Round);
            }
            "box" => {
                let [width, height] = numbers(&shape["size"])?;
                let corner = |x: f64, z: f64| Vec2::new(0.5 * x * width, 0.5 * z * height);
                polygon(vec![
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ])?;
            }
            "polygon" => {
                polygon(list(&shape["corners"]).iter().map(vector2).collect::<Result<_, _>>()?)?;
            }
            other => return Err(format!("no shape `{other}` in the plane").into()),
        }
    }
    Ok(Made { body, pieces })
}

/// Turns the axis of a body of revolution, z in a case, to x as this engine has it.
const AXIS: Quaternion = Quaternion { w: 0.5, v: Vec3 { x: -0.5, y: -0.5, z: -0.5 } };

fn spatial(case: &Value) -> Result<Value, Refusal> {
    let bodies = list(&case["bodies"]).iter().map(spatial_body).collect::<Result<_, _>>()?;
    let revolved: Vec<bool> = list(&case["bodies"]).iter().map(is_revolved).collect();
    let ground: Ground<Vec3> = Ground::read(case, vector3)?;
    run(case, bodies, vector3(&case["gravity"])?, &ground, |state, id| {
        let (shift, speed) = Drive::<Spatial>::at(&ground, state.time);
        let (pose, twist) = (state.poses[id], state.twists[id]);
        let (at, moving, spin) = (pose.position - shift, twist.linear - speed, twist.angular);
        let turn = pose.orientation;
        let q = if revolved[id] { turn.after(AXIS.back()) } else { turn };
        let pose = [at.x, at.y, at.z, q.w, q.v.x, q.v.y, q.v.z];
        let twist = [moving.x, moving.y, moving.z, spin.x, spin.y, spin.z];
        [&pose[..], &twist[..]].concat()
    })
}

fn is_revolved(spec: &Value) -> bool {
    list(&spec["shapes"]).iter().any(|shape| shape["type"] == "cylinder")
}

fn spatial_body(spec: &Value) -> Result<Made<Spatial>, Refusal> {
    let revolved = is_revolved(spec);
    let [w, x, y, z] = numbers(&spec["orientation"])?;
    let turn = Quaternion { w, v: Vec3::new(x, y, z) };
    let pose = Pose {
        position: vector3(&spec["position"])?,
        orientation: if revolved { turn.after(AXIS) } else { turn },
    };
    let fixed = motion(spec) == Motion::Prescribed;
    let inertia = if fixed { Vec3::new(1.0, 1.0, 1.0) } else { vector3(&spec["inertia"])? };
    // The engine's axes x, y, z are z, x, y of a case.
    let inertia = if revolved { Vec3::new(inertia.z, inertia.x, inertia.y) } else { inertia };
    let mut body = Body::free(name(&spec["name"]), mass(spec), inertia, pose);
    body.motion = motion(spec);
    if !fixed {
        body.twist =
            Twist { linear: vector3(&spec["velocity"])?, angular: vector3(&spec["spin"])? };
    }
    let mut pieces = Vec::new();
    for shape in list(&spec["shapes"]) {
        if !shape["at"].is_null() {
            return Err("this adapter has no shapes beside the center of mass in space".into());
        }
        let (surface, piece, hull) = match name(&shape["type"]) {
            "halfspace" => (Solid::HalfSpace, Piece::Flat, None),
            "sphere" => {
                let radius = number(&shape["radius"])?;
                let center = Vec3::default();
                body.nodes.push(Nodes::Rolling { center, radius, tributary_length: 1.0 });
                (Solid::Ball(Ball { radius }), Piece::Round, None)
            }
            "box" => {
                let half = vector3(&shape["size"])? * 0.5;
                let rounding = 0.01 * half.x.min(half.y).min(half.z);
                let core = half - Vec3::new(rounding, rounding, rounding);
                let block = Block { half: core, rounding };
                (Solid::Block(block), Piece::Cornered, Some(Hull::Block(block)))
            }
            "cylinder" => {
                let (radius, length) = (number(&shape["radius"])?, number(&shape["length"])?);
                // A barrel that hardly bulges, with a chime that is hardly rounded.
                let bulge = 1e-6 * length;
                let rounding = 0.01 * radius.min(0.5 * length);
                let barrel = Barrel::new(length, radius - bulge, radius, rounding)?;
                (Solid::Barrel(barrel), Piece::Cornered, Some(Hull::Barrel(barrel)))
            }
            other => return Err(format!("no shape `{other}` in space").into()),
        };
        body.nodes.extend(hull.map(|hull| Nodes::Whole(Rounded::centered(hull))));
        let rotation = Rotation3::identity();
        body.surfaces.push(Placed { surface, offset: Vec3::default(), rotation });
        pieces.push(piece);
    }
    Ok(Made { body, pieces })
}
