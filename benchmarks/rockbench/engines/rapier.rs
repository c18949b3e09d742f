//! Adapter of Rapier for `RockBench`, in the plane and in space, in double precision.

use std::collections::HashMap;
use std::io::Read;
use std::process::ExitCode;
use std::time::Instant;

use serde_json::{Value, json};

/// Reason why a case cannot be run.
type Refusal = Box<dyn std::error::Error>;

const VERSION: &str = "0.36 f64";

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

fn answer(case: &Value) -> Value {
    let rigid = list(&case["interfaces"]).iter().all(|spec| spec["normal"] == "rigid");
    let made = if !rigid {
        Err("the stiffness of a contact: it is a frequency, one for all contacts".into())
    } else if case["space"] == "planar" {
        planar::run(case)
    } else {
        spatial::run(case)
    };
    let mut made = made.unwrap_or_else(
        |refusal| json!({ "cannot": [{ "what": "case", "why": refusal.to_string() }] }),
    );
    made["engine"] = json!("Rapier");
    made["version"] = json!(VERSION);
    made
}

/// Time (s) that the processor spent on this thread; real time where the system does not state it.
fn seconds(start: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let spent = text.split_whitespace().next().and_then(|word| word.parse::<f64>().ok());
    spent.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn name(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn number(value: &Value) -> Result<f64, Refusal> {
    value.as_f64().ok_or_else(|| format!("expected a number, found {value}").into())
}

fn numbers<const N: usize>(value: &Value) -> Result<[f64; N], Refusal> {
    let found: Vec<f64> = list(value).iter().filter_map(Value::as_f64).collect();
    found.try_into().map_err(|_| format!("expected {N} numbers, found {value}").into())
}

/// Acceleration of the ground, linear between its samples.
struct Ground<const N: usize>(Vec<(f64, [f64; N])>);

impl<const N: usize> Ground<N> {
    fn read(case: &Value) -> Result<Self, Refusal> {
        let table = &case["ground"];
        let rows = list(&table["time"]).iter().zip(list(&table["acceleration"]));
        let rows = rows.map(|(time, a)| Ok((number(time)?, numbers(a)?)));
        Ok(Self(rows.collect::<Result<_, Refusal>>()?))
    }

    fn at(&self, time: f64) -> [f64; N] {
        let (Some(first), Some(last)) = (self.0.first(), self.0.last()) else { return [0.0; N] };
        let next = self.0.partition_point(|(knot, _)| *knot <= time);
        if next == 0 {
            return first.1;
        }
        if next == self.0.len() {
            return last.1;
        }
        let ((t0, a), (t1, b)) = (self.0[next - 1], self.0[next]);
        let share = (time - t0) / (t1 - t0);
        std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
    }
}

/// Returns the interface of a case for two bodies: the first that names them, in either order.
fn between<'a>(case: &'a Value, names: [&str; 2]) -> Option<&'a Value> {
    let fits = |word: &Value, name: &str| word == "*" || word == name;
    list(&case["interfaces"]).iter().find(|spec| {
        let [a, b] = [&spec["between"][0], &spec["between"][1]];
        fits(a, names[0]) && fits(b, names[1]) || fits(a, names[1]) && fits(b, names[0])
    })
}

macro_rules! engine {
    ($module:ident, $rapier:ident, $dimension:literal, $pieces:ident, $body:ident, $row:ident) => {
        mod $module {
            use super::*;
            use $rapier::prelude::*;

            pub(super) fn vector(value: &Value) -> Result<Vector, Refusal> {
                Ok(Vector::from_array(numbers::<$dimension>(value)?))
            }

            /// Coefficients of every pair of bodies.
            struct Laws {
                body_of: HashMap<ColliderHandle, usize>,
                laws: HashMap<(usize, usize), [f64; 2]>,
            }

            impl PhysicsHooks for Laws {
                fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
                    let of = |handle| self.body_of.get(&handle).copied().unwrap_or(0);
                    let (a, b) = (of(context.collider1), of(context.collider2));
                    let law = self.laws.get(&(a.min(b), a.max(b))).copied().unwrap_or_default();
                    if let Some(rigid) = context.rigid_mut() {
                        [*rigid.friction, *rigid.restitution] = law;
                    }
                }
            }

            pub(super) fn run(case: &Value) -> Result<Value, Refusal> {
                let mut bodies = RigidBodySet::new();
                let mut colliders = ColliderSet::new();
                let specs = list(&case["bodies"]);
                let accurate = case["step"].is_number();
                let mut laws = Laws { body_of: HashMap::new(), laws: HashMap::new() };
                let mut handles = Vec::new();
                for (id, spec) in specs.iter().enumerate() {
                    let handle = bodies.insert($body(spec, accurate)?);
                    for shape in list(&spec["shapes"]) {
                        let collider = $pieces(shape)?.density(0.0);
                        let collider = collider.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
                        let collider = colliders.insert_with_parent(collider, handle, &mut bodies);
                        laws.body_of.insert(collider, id);
                    }
                    for (other, before) in specs[..id].iter().enumerate() {
                        let names = [name(&before["name"]), name(&spec["name"])];
                        if let Some(law) = between(case, names) {
                            let law = [number(&law["friction"])?, number(&law["restitution"])?];
                            laws.laws.insert((other, id), law);
                        }
                    }
                    handles.push(handle);
                }
                let mut parameters = IntegrationParameters::default();
                if let Some(step) = case["step"].as_f64() {
                    // Contacts as stiff as the step resolves, and no penetration left as it is.
                    parameters.contact_softness.natural_frequency *= parameters.dt / step;
                    parameters.static_contact_softness.natural_frequency *= parameters.dt / step;
                    parameters.dt = step;
                    parameters.normalized_allowed_linear_error = 1e-5;
                    parameters.num_solver_iterations = 8;
                    parameters.contact_recycling = false;
                }
                let ground = Ground::<$dimension>::read(case)?;
                let gravity = vector(&case["gravity"])?;
                let free: Vec<usize> = (0..specs.len()).filter(|i| specs[*i]["fixed"] != true).collect();
                let place = |word: &Value| specs.iter().position(|spec| spec["name"] == *word);
                let paired: Vec<_> = list(&case["forces"])
                    .iter()
                    .map(|pair| [place(&pair[0]), place(&pair[1])])
                    .collect();
                let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
                let (mut broad, mut narrow) = (BroadPhaseBvh::new(), NarrowPhase::new());
                let (mut joints, mut multibodies) = (ImpulseJointSet::new(), MultibodyJointSet::new());
                let (mut soft, mut ccd) = (SoftBodySet::new(), CCDSolver::new());
                let sample = number(&case["sample"])?;
                let steps = (number(&case["duration"])? / parameters.dt).round() as usize;
                let (mut times, mut states, mut forces) = (Vec::new(), Vec::new(), Vec::new());
                let clock = Instant::now();
                let mut spent = 0.0;
                for step in 0..=steps {
                    if step > 0 {
                        let before = seconds(clock);
                        // In the frame of the ground: gravity less its acceleration.
                        let shaken = Vector::from_array(ground.at((step as f64 - 0.5) * parameters.dt));
                        pipeline.step(
                            gravity - shaken,
                            &parameters,
                            &mut islands,
                            &mut broad,
                            &mut narrow,
                            &mut bodies,
                            &mut colliders,
                            &mut joints,
                            &mut multibodies,
                            &mut soft,
                            &mut ccd,
                            &laws,
                            &(),
                        );
                        spent += seconds(clock) - before;
                    }
                    let time = step as f64 * parameters.dt;
                    if time > times.len() as f64 * sample - 0.5 * parameters.dt {
                        times.push(time);
                        states.push(free.iter().map(|id| $row(&bodies[handles[*id]])).collect::<Vec<_>>());
                        let force = |pair: &[Option<usize>; 2]| {
                            let mut impulse = 0.0;
                            for contact in narrow.contact_pairs() {
                                let of = |handle| laws.body_of.get(&handle).copied();
                                let found = [of(contact.collider1), of(contact.collider2)];
                                if found == *pair || [found[1], found[0]] == *pair {
                                    let points = contact.solver_manifolds().iter().flat_map(|m| &m.points);
                                    impulse += points.map(|point| point.data.impulse).sum::<f64>();
                                }
                            }
                            impulse / parameters.dt
                        };
                        forces.push(paired.iter().map(force).collect::<Vec<_>>());
                    }
                }
                Ok(json!({
                    "step": parameters.dt,
                    "cpu_seconds": spent,
                    "bodies": free.iter().map(|id| name(&specs[*id]["name"])).collect::<Vec<_>>(),
                    "times": times,
                    "states": states,
                    "forces": forces,
                }))
            }
        }
    };
}

engine!(planar, rapier2d_f64, 2, planar_piece, planar_body, planar_row);
engine!(spatial, rapier3d_f64, 3, spatial_piece, spatial_body, spatial_row);

use rapier2d_f64::prelude as plane;
use rapier3d_f64::prelude as space;

fn planar_body(spec: &Value, _: bool) -> Result<plane::RigidBody, Refusal> {
    let at = planar::vector(&spec["position"])?;
    let angle = spec["angle"].as_f64().unwrap_or(0.0);
    if spec["fixed"] == true {
        return Ok(plane::RigidBodyBuilder::fixed().translation(at).rotation(angle).build());
    }
    let (mass, inertia) = (number(&spec["mass"])?, number(&spec["inertia"])?);
    let matter = plane::MassProperties::new(plane::Vector::ZERO, mass, inertia);
    Ok(plane::RigidBodyBuilder::dynamic()
        .translation(at)
        .rotation(angle)
        .linvel(planar::vector(&spec["velocity"])?)
        .angvel(number(&spec["spin"])?)
        .additional_mass_properties(matter)
        .can_sleep(false)
        .build())
}

fn planar_piece(shape: &Value) -> Result<plane::ColliderBuilder, Refusal> {
    let piece = match name(&shape["type"]) {
        "halfspace" => plane::ColliderBuilder::new(plane::SharedShape::halfspace(plane::Vector::Y)),
        "disc" => plane::ColliderBuilder::ball(number(&shape["radius"])?),
        "box" => {
            let [width, height] = numbers(&shape["size"])?;
            plane::ColliderBuilder::cuboid(0.5 * width, 0.5 * height)
        }
        "polygon" => {
            let corners = list(&shape["corners"]).iter().map(planar::vector);
            let corners: Vec<_> = corners.collect::<Result<_, _>>()?;
            plane::ColliderBuilder::convex_hull(&corners).ok_or("a polygon without area")?
        }
        other => return Err(format!("no shape `{other}` in the plane").into()),
    };
    Ok(if shape["at"].is_null() { piece } else { piece.translation(planar::vector(&shape["at"])?) })
}

fn planar_row(body: &plane::RigidBody) -> Vec<f64> {
    let (at, v) = (body.translation(), body.linvel());
    vec![at.x, at.y, body.rotation().angle(), v.x, v.y, body.angvel()]
}

fn spatial_body(spec: &Value, accurate: bool) -> Result<space::RigidBody, Refusal> {
    let at = spatial::vector(&spec["position"])?;
    let [w, x, y, z] = numbers(&spec["orientation"])?;
    let pose = space::Pose::from_parts(at, space::Rotation::from_xyzw(x, y, z, w));
    if spec["fixed"] == true {
        return Ok(space::RigidBodyBuilder::fixed().pose(pose).build());
    }
    let inertia = spatial::vector(&spec["inertia"])?;
    let matter = space::MassProperties::new(space::Vector::ZERO, number(&spec["mass"])?, inertia);
    let builder = space::RigidBodyBuilder::dynamic()
        .pose(pose)
        .linvel(spatial::vector(&spec["velocity"])?)
        .angvel(spatial::vector(&spec["spin"])?)
        .additional_mass_properties(matter)
        .can_sleep(false);
    Ok(if accurate { builder.gyroscopic_forces_enabled(true) } else { builder }.build())
}

fn spatial_piece(shape: &Value) -> Result<space::ColliderBuilder, Refusal> {
    let piece = match name(&shape["type"]) {
        "halfspace" => space::ColliderBuilder::new(space::SharedShape::halfspace(space::Vector::Z)),
        "sphere" => space::ColliderBuilder::ball(number(&shape["radius"])?),
        "box" => {
            let [x, y, z] = numbers(&shape["size"])?;
            space::ColliderBuilder::cuboid(0.5 * x, 0.5 * y, 0.5 * z)
        }
        "cylinder" => {
            let (radius, length) = (number(&shape["radius"])?, number(&shape["length"])?);
            // Its axis is y, that of a case z.
            space::ColliderBuilder::cylinder(0.5 * length, radius).rotation(space::Vector::new(
                std::f64::consts::FRAC_PI_2,
                0.0,
                0.0,
            ))
        }
        other => return Err(format!("no shape `{other}` in space").into()),
    };
    Ok(if shape["at"].is_null() {
        piece
    } else {
        piece.translation(spatial::vector(&shape["at"])?)
    })
}

fn spatial_row(body: &space::RigidBody) -> Vec<f64> {
    let (at, q, v, w) = (body.translation(), body.rotation(), body.linvel(), body.angvel());
    vec![at.x, at.y, at.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z]
}
