//! Yardstick: the eight barrels of [`Scene::consensus`] in a plain scalar loop, written as in C.
//!
//! The law is that of Candia, de la Llera and Almazán (2008): a spring at every contact point, with a
//! damper that acts on approach only, and Coulomb friction through a tangential spring with damping. All pairs
//! are tested in every step; nothing is recorded. The loop shares no code with the engine.

use std::f64::consts::TAU;

use crate::scene::{AMPLITUDE, PERIOD, Scene};
use crate::{Failure, time};

/// Time step (s).
pub(crate) const STEP: f64 = 1e-4;

const GRAVITY: f64 = 9.806_65;
const RADIUS: f64 = 0.35;
const PITCH: f64 = 0.76;
const CLEARANCE: f64 = 0.06;
/// Half the width and half the height (m) of the beam of a rack.
const HALF: [f64; 2] = [0.75, 0.02];
const LEVELS: usize = 4;
/// Number of bodies: on each level, a rack and two barrels.
const BODIES: usize = 3 * LEVELS;
const STIFFNESS: f64 = 9.8e5;
const DAMPING: f64 = 2200.0;
/// Friction coefficients: on the ground, then between bodies.
const FRICTION: [f64; 2] = [0.5, 0.22];

/// Largest accepted relative deviation of the sag of a body at rest from its sag in the engine.
const AGREED: f64 = 0.03;

#[derive(Clone, Copy, Default)]
struct Body {
    mass: f64,
    inertia: f64,
    at: [f64; 2],
    angle: f64,
    speed: [f64; 2],
    spin: f64,
    force: [f64; 2],
    torque: f64,
}

/// The stack, with the elongation (m) of the tangential spring of every possible contact.
#[derive(Clone)]
struct Stack {
    bodies: [Body; BODIES],
    supports: [[f64; 2]; 4],
    springs: Vec<f64>,
    /// Displacement (m) and velocity (m/s) of the ground.
    ground: [f64; 2],
}

/// A contact point: the body that is pushed along the normal, and the body that pushes (`None` for the
/// ground).
struct Touch {
    on: usize,
    by: Option<usize>,
    point: [f64; 2],
    normal: [f64; 2],
    depth: f64,
}

/// Cost of the loop, in processor seconds per simulated second.
pub(crate) struct Costs {
    /// Cost while the stack stands.
    pub(crate) standing: f64,
    /// Mean cost over twelve seconds, in which the stack falls.
    pub(crate) falling: f64,
}

/// Measures the loop, after a check against the engine.
///
/// # Errors
/// If a body does not sag as in the engine, if the first barrel does not fall at 1.5 to 2.1 s under the larger motion
/// (1.64 to 2.0 s in five other codes), or if a barrel falls under the smaller motion.
pub(crate) fn costs(degrees: f64) -> Result<Costs, Failure> {
    let settled = check(degrees)?;
    let run = |factor: f64, end: f64| {
        let mut stack = settled.clone();
        shake(&mut stack, factor, end)
    };
    let fell = run(1.0, 2.2);
    if !fell.is_some_and(|time| (1.5..=2.1).contains(&time)) {
        return Err(format!(
            "plain loop: the first barrel falls at {fell:?} s, not at 1.5 to 2.1 s"
        )
        .into());
    }
    let mut stands = true;
    let standing = time::least(|| stands &= run(0.15, 4.0).is_none()) / 4.0;
    if !stands {
        return Err("plain loop: a barrel falls under the small motion".into());
    }
    let falling = time::least(|| stands &= run(1.0, 12.0).is_none()) / 12.0;
    println!(
        "plain loop: first barrel falls at {:.2} s (five codes: 1.64 to 2.0 s); {:.2} ms per simulated second \
         standing, {:.2} falling",
        fell.unwrap_or_default(),
        1e3 * standing,
        1e3 * falling
    );
    Ok(Costs { standing, falling })
}

/// Returns the stack at rest; an error if the sag of a body differs from the sag in the engine by more than [`AGREED`].
fn check(degrees: f64) -> Result<Stack, Failure> {
    let mut stack = Stack::new(degrees.to_radians());
    let before = stack.bodies;
    for _ in 0..60_000 {
        stack.step(0.9995);
    }
    let engine = Scene::consensus(degrees)?;
    let mut worst = 0.0_f64;
    let poses = engine.model.bodies().iter().zip(&engine.rest.poses).skip(1);
    for ((body, pose), (own, start)) in poses.zip(stack.bodies.iter().zip(&before)) {
        let sag = body.pose.position.z - pose.position.z;
        worst = worst.max(((start.at[1] - own.at[1]) / sag - 1.0).abs());
    }
    println!(
        "plain loop: bodies at rest sag as in the engine within {:.2} % (top barrel: {:.1} mm)",
        100.0 * worst,
        1e3 * (before[BODIES - 1].at[1] - stack.bodies[BODIES - 1].at[1])
    );
    if worst > AGREED {
        return Err("plain loop: the sag at rest differs from that of the engine".into());
    }
    Ok(stack)
}

/// Shakes the stack until a time (s); returns the time (s) at which the first barrel has dropped by one
/// level.
fn shake(stack: &mut Stack, factor: f64, end: f64) -> Option<f64> {
    let rest = stack.bodies.map(|body| body.at[1]);
    let omega = TAU / PERIOD;
    let mut fallen = None;
    for step in 0..(end / STEP).round() as usize {
        let time = step as f64 * STEP;
        let (sin, cos) = (omega * time).sin_cos();
        stack.ground = [factor * AMPLITUDE * sin, factor * AMPLITUDE * omega * cos];
        stack.step(1.0);
        let dropped = |body: usize| rest[body] - stack.bodies[body].at[1] > PITCH;
        if fallen.is_none() && (0..BODIES).any(|body| body % 3 > 0 && dropped(body)) {
            fallen = Some(time);
        }
    }
    fallen
}

impl Stack {
    fn new(angle: f64) -> Self {
        let mut bodies = [Body::default(); BODIES];
        for level in 0..LEVELS {
            let underside = (CLEARANCE + 2.0 * RADIUS) * level as f64;
            let inertia = 30.0 * (HALF[0] * HALF[0] + HALF[1] * HALF[1]) / 3.0;
            let rack =
                Body { mass: 30.0, inertia, at: [0.0, underside + HALF[1]], ..Body::default() };
            bodies[3 * level] = rack;
            for (column, side) in [-0.5, 0.5].into_iter().enumerate() {
                bodies[3 * level + 1 + column] = Body {
                    mass: 275.0,
                    inertia: 0.5 * 275.0 * RADIUS * RADIUS,
                    at: [side * PITCH, underside + CLEARANCE + RADIUS],
                    ..Body::default()
                };
            }
        }
        let (sin, cos) = angle.sin_cos();
        let height = CLEARANCE + RADIUS - HALF[1] - RADIUS * cos;
        let support = |side: f64, end: f64| [0.5 * side * PITCH + end * RADIUS * sin, height];
        let supports =
            [support(-1.0, -1.0), support(-1.0, 1.0), support(1.0, -1.0), support(1.0, 1.0)];
        Self { bodies, supports, springs: vec![0.0; 256], ground: [0.0; 2] }
    }

    /// Advances by one step; velocities are multiplied by `kept`, which is below 1 while the stack settles.
    fn step(&mut self, kept: f64) {
        for body in &mut self.bodies {
            body.force = [0.0, -GRAVITY * body.mass];
            body.torque = 0.0;
        }
        let mut spring = 0;
        for rack in (0..BODIES).step_by(3) {
            self.rack(rack, &mut spring);
        }
        for barrel in (0..BODIES).filter(|body| body % 3 > 0) {
            self.barrel(barrel, &mut spring);
        }
        for body in &mut self.bodies {
            for axis in 0..2 {
                body.speed[axis] = kept * (body.speed[axis] + STEP * body.force[axis] / body.mass);
                body.at[axis] += STEP * body.speed[axis];
            }
            body.spin = kept * (body.spin + STEP * body.torque / body.inertia);
            body.angle += STEP * body.spin;
        }
    }

    /// Computes the contacts of the feet of a rack with the ground and of its supports with all barrels.
    fn rack(&mut self, rack: usize, spring: &mut usize) {
        let Body { at, angle, .. } = self.bodies[rack];
        let (sin, cos) = angle.sin_cos();
        let place =
            |p: [f64; 2]| [at[0] + cos * p[0] - sin * p[1], at[1] + sin * p[0] + cos * p[1]];
        for side in [-1.0, 1.0] {
            let point = place([side * HALF[0], -HALF[1]]);
            let touch = Touch { on: rack, by: None, point, normal: [0.0, 1.0], depth: -point[1] };
            self.press(&touch, spring);
        }
        for support in self.supports {
            let point = place(support);
            for barrel in (0..BODIES).filter(|body| body % 3 > 0) {
                let center = self.bodies[barrel].at;
                let (x, z) = (point[0] - center[0], point[1] - center[1]);
                let squared = x * x + z * z;
                if squared >= RADIUS * RADIUS {
                    self.springs[*spring] = 0.0;
                    *spring += 1;
                    continue;
                }
                let distance = squared.sqrt();
                let normal = [x / distance, z / distance];
                let touch =
                    Touch { on: rack, by: Some(barrel), point, normal, depth: RADIUS - distance };
                self.press(&touch, spring);
            }
        }
    }

    /// Computes the contacts of a barrel with the ground, with the beams of the racks of other levels, and with the
    /// barrels of higher index.
    fn barrel(&mut self, barrel: usize, spring: &mut usize) {
        let at = self.bodies[barrel].at;
        let point = [at[0], at[1] - RADIUS];
        let touch = Touch { on: barrel, by: None, point, normal: [0.0, 1.0], depth: -point[1] };
        self.press(&touch, spring);
        for rack in (0..BODIES).step_by(3).filter(|rack| rack / 3 != barrel / 3) {
            let beam = self.bodies[rack];
            let (sin, cos) = beam.angle.sin_cos();
            let (x, z) = (at[0] - beam.at[0], at[1] - beam.at[1]);
            let own = [cos * x + sin * z, cos * z - sin * x];
            let near = [own[0].clamp(-HALF[0], HALF[0]), own[1].clamp(-HALF[1], HALF[1])];
            let away = [own[0] - near[0], own[1] - near[1]];
            let away = [cos * away[0] - sin * away[1], sin * away[0] + cos * away[1]];
            self.round(barrel, rack, away, RADIUS, spring);
        }
        for other in (barrel + 1..BODIES).filter(|body| body % 3 > 0) {
            let other_at = self.bodies[other].at;
            let away = [at[0] - other_at[0], at[1] - other_at[1]];
            self.round(barrel, other, away, 2.0 * RADIUS, spring);
        }
    }

    /// Computes the contact of a barrel with another body. `away` (m) is the vector to the center of the barrel from
    /// the nearest point of the other body or, if both are barrels, from its center. The bodies touch if `away` is
    /// shorter than `reach` (m).
    fn round(&mut self, barrel: usize, by: usize, away: [f64; 2], reach: f64, spring: &mut usize) {
        let squared = away[0] * away[0] + away[1] * away[1];
        if squared >= reach * reach || squared == 0.0 {
            self.springs[*spring] = 0.0;
            *spring += 1;
            return;
        }
        let distance = squared.sqrt();
        let normal = [away[0] / distance, away[1] / distance];
        let at = self.bodies[barrel].at;
        let point = [at[0] - RADIUS * normal[0], at[1] - RADIUS * normal[1]];
        self.press(
            &Touch { on: barrel, by: Some(by), point, normal, depth: reach - distance },
            spring,
        );
    }

    /// Applies the force of a contact point, if it touches, to both bodies.
    fn press(&mut self, touch: &Touch, spring: &mut usize) {
        let Touch { on, by, point, normal, depth } = *touch;
        let stretch = &mut self.springs[*spring];
        *spring += 1;
        if depth <= 0.0 {
            *stretch = 0.0;
            return;
        }
        let speed_at = |body: &Body| {
            let arm = [point[0] - body.at[0], point[1] - body.at[1]];
            [body.speed[0] - body.spin * arm[1], body.speed[1] + body.spin * arm[0]]
        };
        let own = speed_at(&self.bodies[on]);
        let other = by.map_or([self.ground[1], 0.0], |by| speed_at(&self.bodies[by]));
        let speed = [own[0] - other[0], own[1] - other[1]];
        let approach = -(speed[0] * normal[0] + speed[1] * normal[1]);
        let slip = speed[0] * normal[1] - speed[1] * normal[0];
        let press = STIFFNESS * depth + DAMPING * approach.max(0.0);
        let limit = FRICTION[usize::from(by.is_some())] * press;
        *stretch += STEP * slip;
        let mut drag = -STIFFNESS * *stretch - DAMPING * slip;
        if drag.abs() > limit {
            drag = limit.copysign(drag);
            *stretch = -(drag + DAMPING * slip) / STIFFNESS;
        }
        let force = [press * normal[0] + drag * normal[1], press * normal[1] - drag * normal[0]];
        self.bodies[on].push(point, force);
        if let Some(by) = by {
            self.bodies[by].push(point, [-force[0], -force[1]]);
        }
    }
}

impl Body {
    /// Adds a force (N) at a point (m).
    fn push(&mut self, point: [f64; 2], force: [f64; 2]) {
        self.force[0] += force[0];
        self.force[1] += force[1];
        self.torque += (point[0] - self.at[0]) * force[1] - (point[1] - self.at[1]) * force[0];
    }
}
