//! First sloshing mode of the wine in a partly filled barrel: its period, and the share of the wine that moves in this
//! mode.

use std::f64::consts::PI;

use barrelstack_dynamics::math::{acos, cos, exp, sin, sin_cos};

/// The first sloshing mode of a tank as an equivalent pendulum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Sloshing mass, as a fraction of the mass of the liquid.
    pub share: f64,
    /// Length (m) of the pendulum, `g/ω²`.
    pub length: f64,
    /// Depth (m) below the center of the tank at which the sloshing mass is placed if the mode is modeled as a mass on
    /// a spring.
    pub depth: f64,
}

/// Number of basis functions on the free surface.
const TERMS: usize = 60;

/// Half the length of the strip to which the surface is mapped (dimensionless); the ends of the strip correspond to the
/// wall to within rounding error.
const HALF_STRIP: f64 = 16.0;

/// Number of quadrature points.
const POINTS: usize = 400;

/// Returns the first transverse sloshing mode of a horizontal circular cylinder with the given radius (m), filled to
/// the given fraction of its volume.
///
/// In linear potential theory, the cross-section of the liquid, a segment of a circle, is mapped to a strip by `x + i z
/// = b tanh(w/2)`, where `b` is half the width of the surface and `w` is the complex coordinate in the strip. Along the
/// surface, the coordinate in the strip is `ξ`, the real part of `w`. The normal derivative of a function `sin k ξ` on
/// the surface is the function multiplied by `k tanh k β`, where `β` is the angle between surface and wall. The
/// remaining eigenvalue problem on the surface has a rapidly converging basis. For a half-full cylinder, the result is
/// `ω² R/g = 1.35573`, in agreement with McIver (1989) and Budiansky (1960). The limit for a nearly empty cylinder is
/// `ω² R/g = 1`, and the limit for a nearly full cylinder is the ice-fishing problem with `ω² b/g = 2.0061` (Fox and
/// Kuttler 1983). The sloshing mass follows from the excitation of the mode by a lateral acceleration (Ibrahim 2005,
/// section 5).
pub fn across(radius: f64, filled: f64) -> Wave {
    let angle = wetted(filled);
    let b = sin(angle);
    let wave_number = |j: usize| (j as f64 + 0.5) * PI / HALF_STRIP;
    let step = HALF_STRIP / POINTS as f64;
    let at: Vec<f64> = (0..POINTS).map(|i| (i as f64 + 0.5) * step).collect();
    let weights: Vec<f64> =
        at.iter().map(|x| 0.5 * b * step * (1.0 - square(tanh(0.5 * x)))).collect();
    let functions: Vec<Vec<f64>> =
        (0..TERMS).map(|j| at.iter().map(|x| sin(wave_number(j) * x)).collect()).collect();
    let stiffness: Vec<f64> = (0..TERMS)
        .map(|j| 0.5 * HALF_STRIP * wave_number(j) * tanh(wave_number(j) * angle))
        .collect();
    let surface = |amplitudes: &[f64]| -> Vec<f64> {
        let sum = |i: usize| amplitudes.iter().zip(&functions).map(|(a, f)| a * f[i]).sum();
        (0..POINTS).map(sum).collect()
    };
    // Power iteration for the largest eigenvalue 1/κ, where κ = ω² R/g. It converges fast, since the next eigenvalue is
    // less than half as large.
    let mut amplitudes = vec![0.0; TERMS];
    amplitudes[0] = 1.0;
    let mut inverse = 0.0;
    for _ in 0..60 {
        let wave = surface(&amplitudes);
        let next: Vec<f64> = functions
            .iter()
            .zip(&stiffness)
            .map(|(f, k)| {
                f.iter().zip(&weights).zip(&wave).map(|((f, w), v)| f * w * v).sum::<f64>() / k
            })
            .collect();
        inverse = next.iter().map(|a| a * a).sum::<f64>().sqrt();
        amplitudes = next.into_iter().map(|a| a / inverse).collect();
    }
    let wave = surface(&amplitudes);
    let over =
        |of: &dyn Fn(usize) -> f64| -> f64 { (0..POINTS).map(|i| 2.0 * weights[i] * of(i)).sum() };
    let norm = over(&|i| wave[i] * wave[i]);
    let push = over(&|i| wave[i] * b * tanh(0.5 * at[i]));
    let area = angle - b * cos(angle);
    let length = inverse * radius;
    Wave { share: push * push / (norm * inverse * area), length, depth: length }
}

/// Returns the first sloshing mode along a barrel, approximated by the first sloshing mode of a rectangular tank.
///
/// The tank has the length L (m) of the barrel, and its depth h (m) is the mean depth of the wine under its surface.
/// The frequency is `ω² = π g/L tanh(π h/L)`, and the sloshing mass is the fraction `8 tanh(π h/L)/(π³ h/L)` of the
/// liquid (Ibrahim 2005, section 5). This is an approximation, since the bottom of a barrel is round.
pub fn along(radius: f64, room_length: f64, filled: f64) -> Wave {
    let angle = wetted(filled);
    let (b, area) = (sin(angle), angle - sin(angle) * cos(angle));
    let depth = radius * area / (2.0 * b);
    let ratio = depth / room_length;
    let swing = tanh(PI * ratio);
    let share = 8.0 * swing / (PI * PI * PI * ratio);
    // This depth preserves the center of mass of the wine, because the wine that does not slosh is placed at the center
    // of the barrel.
    let center = radius * 2.0 * b * b * b / (3.0 * area);
    Wave { share, length: room_length / (PI * swing), depth: center / share }
}

/// Returns half the central angle (rad) of the circular segment that covers the given fraction of its circle.
fn wetted(filled: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let (sin, cos) = sin_cos(middle);
        if middle - sin * cos < PI * filled { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Returns the filled fraction of a horizontal cylinder, from the depth of the liquid divided by the radius.
pub fn filled_to(depth: f64) -> f64 {
    let angle = acos(1.0 - depth);
    let (sin, cos) = sin_cos(angle);
    (angle - sin * cos) / PI
}

fn tanh(x: f64) -> f64 {
    let e = exp(-2.0 * x);
    (1.0 - e) / (1.0 + e)
}

fn square(x: f64) -> f64 {
    x * x
}
