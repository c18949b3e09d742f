//! A row of toppling dominoes, modeled as a room in which each domino is a stack. The module computes the speed of the
//! wave that runs along the row, both by simulation and from theory.

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack_cellar::{Placed, Room, Settings, run};
use barrelstack_dynamics::math::{acos, asin, cos, sin};
use barrelstack_space::Ground;

use crate::problem::absent;
use crate::{Failure, GRAVITY};

/// Thickness of a domino as a fraction of its height.
pub const DOMINO: f64 = 0.15;

/// A row of dominoes that are 1 m high.
pub struct Row {
    /// Number of dominoes.
    pub count: u32,
    /// Gap between two adjacent dominoes, as a fraction of their height.
    pub spacing: f64,
    /// Coefficient of friction between dominoes.
    pub friction: f64,
}

impl Row {
    /// Returns the speed of the wave in the last third of the row, as a multiple of √(g h), where `h` is the height of
    /// a domino.
    ///
    /// # Errors
    /// If the room cannot be run, or if the wave does not reach the last domino.
    pub fn speed(&self) -> Result<f64, Failure> {
        let pitch = self.spacing + DOMINO;
        // The closer the dominoes are, the more of them the first domino must push over, so it starts with a higher
        // spin.
        let spin = if self.spacing < 0.15 { 3.0 } else { 1.5 };
        let domino = |spin: f64| {
            // The first domino turns about its lower edge.
            Scenario::parse(
                "domino.toml",
                &format!(
                    "schema = 1\nkind = \"free-spatial\"\n\
                     [[body]]\nname = \"domino\"\nmass = \"40 kg\"\n\
                     solid = {{ type = \"block\", sides = [\"{DOMINO} m\", \"0.5 m\", \"1 m\"], rounding = \"2 mm\" }}\n\
                     position = [\"0 m\", \"0 m\", \"0.5 m\"]\n\
                     velocity = [\"{} m/s\", \"0 m/s\", \"{} m/s\"]\nspin = [\"0 rad/s\", \"{spin} rad/s\", \"0 rad/s\"]\n\
                     [[interface]]\nbetween = [\"domino\", \"ground\"]\nstiffness = \"4 MN/m\"\ndamping = \"8 kN s/m\"\n\
                     friction = {{ coefficient = 5 }}\n\
                     [[interface]]\nbetween = [\"domino\", \"domino\"]\nlaw = \"kelvin-voigt\"\nstiffness = \"2 MN/m\"\n\
                     damping = \"8 kN s/m\"\nfriction = {{ coefficient = {} }}\n\
                     [run]\nduration = \"{} s\"\nuntil = \"duration\"\n",
                    0.5 * spin,
                    0.5 * DOMINO * spin,
                    self.friction,
                    0.6 + f64::from(self.count) * pitch
                        / if self.friction > 0.0 { 2.5 } else { 4.2 },
                ),
                &[],
            )
        };
        let (first, other) = (domino(spin)?, domino(0.0)?);
        let stack = |at: u32| {
            let scenario = if at == 0 { &first } else { &other };
            Placed::new(&format!("D{at:02}"), scenario.clone(), [f64::from(at) * pitch, 0.0])
        };
        let ground = Ground::of_spec(&first.motion, 1.0).map_err(absent)?;
        let stacks = (0..self.count).map(stack).collect();
        let room = Room { stacks, obstacles: Vec::new(), ground };
        let last = (self.count - 1) as usize;
        let run =
            run(&room, &Settings::default(), &mut |_| ControlFlow::Continue(())).map_err(absent)?;
        let from = (self.count - self.count / 3) as usize;
        let hit = |at: usize| {
            let own = run.meetings.iter().find(|meeting| meeting.stacks == [at - 1, at]);
            own.map(|meeting| meeting.time).ok_or_else(|| absent("the wave stopped"))
        };
        let speed = pitch * (last - from) as f64 / (hit(last)? - hit(from)?);
        Ok(speed / GRAVITY.sqrt())
    }
}

/// Returns the speed of the wave for rigid, smooth dominoes that do not rebound, as a multiple of √(g h), where `h` is
/// the height of a domino.
pub fn theory(thickness: f64, spacing: f64) -> f64 {
    theory_by(thickness, spacing, 2000)
}

/// Returns the same speed as [`theory`], from a numerical integral with a given number of steps.
///
/// All dominoes behind the front lean on each other, so the row has one degree of freedom, the angle θ₁ of its front
/// domino: `sin(θᵢ₊₁ − θᵢ) = (s + d) cos θᵢ − d`, where the spacing `s` and the thickness `d` are fractions of the
/// height (van Leeuwen 2010). With `J = Σ (dθᵢ/dθ₁)²`, the energy `½ I ω² J + V` is constant until the front domino
/// reaches the next domino, at `sin θ₁ = s`. The impact adds one domino to the moving row and changes `ω` to
/// `ω J/(J + 1)`. In a steady wave the energy lost at an impact equals the energy that one domino releases as it falls.
fn theory_by(thickness: f64, spacing: f64, steps: u32) -> f64 {
    let pitch = spacing + thickness;
    // Units: mass, gravity and height are one.
    let inertia = (1.0 + thickness * thickness) / 3.0;
    let height = |angle: f64| 0.5 * (cos(angle) + thickness * sin(angle));
    // For a domino at `angle`: the angle of the next domino behind it, and the derivative with respect to `angle`.
    let behind = |angle: f64| {
        let reach = pitch * cos(angle) - thickness;
        let rate = 1.0 - pitch * sin(angle) / (1.0 - reach * reach).sqrt();
        (angle + asin(reach), rate)
    };
    let last = acos(thickness / pitch);
    // J and V of an endless row whose front domino is at the angle `front`.
    let row = |front: f64| {
        let (mut angle, mut rate) = (front, 1.0);
        let (mut sum, mut potential) = (0.0, 0.0);
        for _ in 0..10_000 {
            sum += rate * rate;
            potential += height(angle) - height(last);
            if last - angle < 1e-13 {
                break;
            }
            let (next, slope) = behind(angle);
            (angle, rate) = (next, rate * slope);
        }
        (sum, potential)
    };
    let end = asin(spacing);
    let (before, low) = row(end);
    let (after, high) = row(0.0);
    // Energy after the impact, from the balance of one cycle: E + released = ½ I ω² J, E = ½ I ω² J²/(J + 1).
    let released = high - low;
    let square = 2.0 * released * (before + 1.0) / (inertia * before);
    let start = 0.5 * inertia * square * before * before / (before + 1.0);
    debug_assert!((after - before - 1.0).abs() < 1e-6, "the row is longer by one");
    let slowness = |angle: f64| {
        let (sum, potential) = row(angle);
        (0.5 * inertia * sum / (start + high - potential)).sqrt()
    };
    // Simpson's rule.
    let step = end / f64::from(steps);
    let weight = |at: u32| match at {
        0 => 1.0,
        at if at == steps => 1.0,
        at if at % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=steps).map(|at| weight(at) * slowness(f64::from(at) * step)).sum();
    pitch / (sum * step / 3.0)
}

#[cfg(test)]
mod tests {
    use super::{DOMINO, theory, theory_by};

    #[test]
    fn the_theory_has_the_limits_that_follow_by_hand() {
        // At a large spacing only few dominoes lean on the front domino and push it, so the wave is slower.
        assert!(theory(DOMINO, 0.7) < theory(DOMINO, 0.2));
        // Halving the steps of the integral hardly changes the result.
        let (fine, coarse) = (theory_by(DOMINO, 0.3, 4000), theory_by(DOMINO, 0.3, 2000));
        assert!((fine / coarse - 1.0).abs() < 1e-6, "{fine} {coarse}");
    }
}
