//! The simplest model of a rack that walks: a rigid block on two seats, on oscillating ground. Each seat is a spring
//! with a damper that acts on approach, and friction with a tangential spring.
//!
//! The model shares no line with the program. Its integrator is the semi-implicit Euler method with steps of a
//! microsecond.

/// Acceleration of gravity (m/s²).
pub(crate) const GRAVITY: f64 = 9.806_65;

/// One cycle of ground acceleration `amplitude sin(2 π t / period)`.
#[derive(Clone, Copy)]
pub(crate) struct Cycle {
    /// Largest acceleration (m/s²).
    pub(crate) amplitude: f64,
    /// Period (s).
    pub(crate) period: f64,
}

impl Cycle {
    /// Returns the acceleration of the ground (m/s²) at a time (s) after the cycle begins.
    pub(crate) fn acceleration(self, time: f64) -> f64 {
        if time < self.period {
            self.amplitude * (std::f64::consts::TAU * time / self.period).sin()
        } else {
            0.0
        }
    }
}

/// Returns the displacement (m) of a rigid block on rigid ground after one cycle; the block slides and does not rock
/// (Newmark 1965).
pub(crate) fn newmark(friction: f64, cycle: Cycle) -> f64 {
    let (step, limit) = (1e-6, friction * GRAVITY);
    let (mut x, mut v, mut time) = (0.0, 0.0_f64, 0.0);
    while time < cycle.period + 5.0 {
        let pull = -cycle.acceleration(time + 0.5 * step);
        if v == 0.0 && pull.abs() <= limit {
            // The block sticks; once the ground is still, it stays.
            if time > cycle.period {
                break;
            }
        } else {
            let way = if v == 0.0 { pull.signum() } else { v.signum() };
            let next = v + step * (pull - limit * way);
            // Friction stops the block and does not reverse its motion.
            let next = if next * way < 0.0 { 0.0 } else { next };
            x += 0.5 * step * (v + next);
            v = next;
        }
        time += step;
    }
    x
}

/// A block on two seats.
#[derive(Clone, Copy)]
pub(crate) struct TwoSeats {
    /// Mass (kg) and moment of inertia about the center of mass (kg·m²).
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    /// Height of the center of mass above the seats, and distance of each seat from the middle (m).
    pub(crate) height: f64,
    pub(crate) half_spacing: f64,
    /// Stiffness (N/m) and damping on approach (N·s/m) of a seat.
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Friction of a seat, and its tangential stiffness divided by its normal stiffness.
    pub(crate) friction: f64,
    pub(crate) stick: f64,
}

impl TwoSeats {
    /// Returns the displacement of the center of mass (m) one second after the end of a cycle; the block starts at
    /// rest.
    pub(crate) fn walk(self, cycle: Cycle) -> f64 {
        // Steps resolve the period of the springs with at least a hundred steps.
        let fastest = (2.0 * self.stiffness * (1.0 + self.stick) / self.mass).sqrt();
        let step = (0.02 / fastest).min(1e-5);
        let sunk = 0.5 * self.mass * GRAVITY / self.stiffness;
        let (mut x, mut z, mut turn) = (0.0, self.height - sunk, 0.0_f64);
        let (mut vx, mut vz, mut spin) = (0.0, 0.0, 0.0);
        let mut stretch = [0.0; 2];
        let mut time = 0.0;
        while time < cycle.period + 1.0 {
            let (sin, cos) = turn.sin_cos();
            let (mut fx, mut fz, mut moment) =
                (-self.mass * cycle.acceleration(time), -self.mass * GRAVITY, 0.0);
            for (side, stretch) in [-1.0, 1.0].into_iter().zip(&mut stretch) {
                let (rx, rz) = (
                    side * self.half_spacing * cos + self.height * sin,
                    side * self.half_spacing * sin - self.height * cos,
                );
                let (slip, sink) = (vx - spin * rz, -(vz + spin * rx));
                let depth = -(z + rz);
                if depth <= 0.0 {
                    *stretch = 0.0;
                    continue;
                }
                let normal = self.stiffness * depth + self.damping * sink.max(0.0);
                *stretch += slip * step;
                let (k, limit) = (self.stick * self.stiffness, self.friction * normal);
                let mut drag = -(k * *stretch + self.stick * self.damping * slip);
                if drag.abs() > limit {
                    drag = limit.copysign(drag);
                    *stretch = -drag / k;
                }
                fx += drag;
                fz += normal;
                moment += rx * normal - rz * drag;
            }
            vx += step * fx / self.mass;
            vz += step * fz / self.mass;
            spin += step * moment / self.inertia;
            x += step * vx;
            z += step * vz;
            turn += step * spin;
            time += step;
        }
        x
    }
}
