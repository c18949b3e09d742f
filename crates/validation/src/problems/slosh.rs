//! Sloshing in a partly filled barrel: frequencies and sloshing masses, compared with published values and with a
//! finite-element solution in the plane of the cross-section.

use barrelstack::slosh::{across, along, filled_to};
use barrelstack::{Run, Scenario};
use barrelstack_dynamics::math::{acos, sin_cos};

use crate::problem::{relative, setting};
use crate::swing::crossings;
use crate::{Failure, GRAVITY, Problem};

const HALF_FULL: &str = "Budiansky 1960; McIver 1989";
const NEARLY_EMPTY: &str = "particle in a round trough";
const NEARLY_FULL: &str = "ice-fishing problem, Fox and Kuttler 1983";
const ELEMENTS: &str = "potential theory by finite elements";

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![
        frequency("nearly-empty", NEARLY_EMPTY, 1e-4, 1.0, 2e-3),
        frequency("half-full", HALF_FULL, 1.0, 1.3557, 1e-4),
        nearly_full(),
    ];
    list.extend(
        [0.3, 0.6, 1.0, 1.4, 1.8].into_iter().flat_map(|depth| [by_elements(depth), mass(depth)]),
    );
    list.push(long());
    list.extend([0.5, 0.9].map(in_a_stack));
    list
}

/// Returns `ω² R/g` of the first transverse sloshing mode in a horizontal cylinder of radius 1 m that is filled to a
/// depth (m).
fn number(depth: f64) -> f64 {
    1.0 / across(1.0, filled_to(depth)).length
}

fn frequency(name: &str, source: &'static str, depth: f64, exact: f64, tolerance: f64) -> Problem {
    setting(
        format!("slosh/{name}"),
        format!(
            "horizontal cylinder filled to a depth of {depth} times its radius, first transverse \
             wave"
        ),
        source,
    )
    .quantity("ω² R/g", "", relative(exact, tolerance))
    .by(move |_| Ok(number(depth)))
}

fn nearly_full() -> Problem {
    let depth: f64 = 2.0 - 1e-6;
    let half_width = (1.0 - (depth - 1.0) * (depth - 1.0)).sqrt();
    setting(
        "slosh/nearly-full",
        "horizontal cylinder, full except for a narrow free surface (a slit), first transverse \
         wave",
        NEARLY_FULL,
    )
    .quantity("ω² b/g with half the width b of the slit", "", relative(2.006_119, 1e-3))
    .by(move |_| Ok(number(depth) * half_width))
}

/// Number of elements per side. With this number, the finite-element answers have an error of about 0.1 %.
const SIDE: usize = 28;

fn by_elements(depth: f64) -> Problem {
    let (exact, _) = finite_elements(depth, SIDE);
    setting(
        format!("slosh/frequency-{depth}"),
        format!(
            "horizontal cylinder filled to a depth of {depth} times its radius, first transverse \
             wave"
        ),
        ELEMENTS,
    )
    .quantity("ω² R/g", "", relative(exact, 4e-3))
    .by(move |_| Ok(number(depth)))
}

fn mass(depth: f64) -> Problem {
    let (_, exact) = finite_elements(depth, SIDE);
    setting(
        format!("slosh/mass-{depth}"),
        format!(
            "horizontal cylinder filled to a depth of {depth} times its radius, first transverse \
             wave"
        ),
        ELEMENTS,
    )
    .quantity("share of the mass that moves with the wave", "", relative(exact, 4e-3))
    .by(move |_| Ok(across(1.0, filled_to(depth)).share))
}

/// Returns `ω²/g` and the mass fraction of the first antisymmetric sloshing mode of a liquid whose cross-section is a
/// segment of the unit circle.
///
/// Bilinear elements between the liquid surface and the wall give the eigenvalue problem `K φ = κ M φ`, where `M` has
/// entries for the surface only.
fn finite_elements(depth: f64, side: usize) -> (f64, f64) {
    let angle = acos(1.0 - depth);
    let (width, height) = sin_cos(angle);
    let place = |i: usize, j: usize| {
        let (s, t) = (i as f64 / side as f64, j as f64 / side as f64);
        let (sin, cos) = sin_cos(angle * s);
        [(1.0 - t) * width * s + t * sin, -(1.0 - t) * height - t * cos]
    };
    // On the center line the potential is zero; at the corner of surface and wall there is one node.
    let count = (side - 1) * (side + 1) + 1;
    let number = |i: usize, j: usize| match i {
        0 => None,
        i if i == side => Some(count - 1),
        i => Some((i - 1) * (side + 1) + j),
    };
    let mut matrix = vec![vec![0.0; count]; count];
    let gauss = 0.5 / 3.0_f64.sqrt();
    for i in 0..side {
        for j in 0..side {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            for (s, t) in [(-gauss, -gauss), (gauss, -gauss), (gauss, gauss), (-gauss, gauss)] {
                let (s, t) = (0.5 + s, 0.5 + t);
                let slopes = [[t - 1.0, s - 1.0], [1.0 - t, -s], [t, s], [-t, 1.0 - s]];
                let mut jacobian = [[0.0; 2]; 2];
                for ((a, b), slope) in corners.iter().zip(slopes) {
                    let at = place(*a, *b);
                    for (row, slope) in jacobian.iter_mut().zip(slope) {
                        row[0] += slope * at[0];
                        row[1] += slope * at[1];
                    }
                }
                let [[a, b], [c, d]] = jacobian;
                let area = a * d - b * c;
                let gradient =
                    slopes.map(|[u, v]| [(d * u - b * v) / area, (a * v - c * u) / area]);
                for (p, (pi, pj)) in gradient.iter().zip(corners) {
                    for (q, (qi, qj)) in gradient.iter().zip(corners) {
                        if let (Some(row), Some(column)) = (number(pi, pj), number(qi, qj)) {
                            matrix[row][column] += 0.25 * area.abs() * (p[0] * q[0] + p[1] * q[1]);
                        }
                    }
                }
            }
        }
    }
    let surface: Vec<usize> = (1..=side).filter_map(|i| number(i, 0)).collect();
    let step = width / side as f64;
    // The mass matrix of linear elements on the surface, with zero at the center.
    let weighed = |wave: &[f64]| -> Vec<f64> {
        let at = |i: usize| if i == 0 { 0.0 } else { wave[surface[i - 1]] };
        let mut load = vec![0.0; count];
        for i in 0..side {
            for (own, other) in [(i, i + 1), (i + 1, i)] {
                if own > 0 {
                    load[surface[own - 1]] += step * (at(own) / 3.0 + at(other) / 6.0);
                }
            }
        }
        load
    };
    factorize(&mut matrix);
    let mut wave = vec![1.0; count];
    let mut kappa = 0.0;
    for _ in 0..40 {
        let mut next = weighed(&wave);
        solve(&matrix, &mut next);
        let load = weighed(&next);
        let square: f64 = next.iter().zip(&load).map(|(a, b)| a * b).sum();
        let product: f64 = wave.iter().zip(&load).map(|(a, b)| a * b).sum();
        kappa = product / square;
        wave = next.iter().map(|value| value / square.sqrt()).collect();
    }
    let load = weighed(&wave);
    let push: f64 = (1..=side).map(|i| load[surface[i - 1]] * step * i as f64).sum();
    let square: f64 = wave.iter().zip(&load).map(|(a, b)| a * b).sum();
    let area = angle - width * height;
    (kappa, 2.0 * kappa * push * push / square / area)
}

/// Computes the lower Cholesky factor of a symmetric matrix, in place.
fn factorize(matrix: &mut [Vec<f64>]) {
    for i in 0..matrix.len() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let left = matrix[i][j] - sum;
            matrix[i][j] = if i == j { left.sqrt() } else { left / matrix[j][j] };
        }
    }
}

fn solve(factor: &[Vec<f64>], load: &mut [f64]) {
    let count = load.len();
    for i in 0..count {
        let sum: f64 = (0..i).map(|k| factor[i][k] * load[k]).sum();
        load[i] = (load[i] - sum) / factor[i][i];
    }
    for i in (0..count).rev() {
        let sum: f64 = (i + 1..count).map(|k| factor[k][i] * load[k]).sum();
        load[i] = (load[i] - sum) / factor[i][i];
    }
}

fn long() -> Problem {
    // A tank that is 2 m long and filled to 0.5 m, represented by a half-full cylinder with a mean depth of 0.5 m.
    let (length, depth) = (2.0, 0.5);
    let exact = std::f64::consts::PI / length * (std::f64::consts::PI * depth / length).tanh();
    setting(
        "slosh/rectangular",
        "rectangular tank of 2 m filled to 0.5 m, the model of a half-full barrel along its axis",
        "Ibrahim 2005, section 5",
    )
    .quantity("ω²/g", "1/m", relative(exact, 1e-9))
    .by(move |_| {
        let radius = 4.0 * depth / std::f64::consts::PI;
        Ok(1.0 / along(radius, length, 0.5).length)
    })
}

/// Creates the problem of the sloshing wine in a barrel in its cradle, excited by a short push.
fn in_a_stack(filled: f64) -> Problem {
    let wave = scenario(filled)
        .ok()
        .and_then(|scenario| scenario.stack().and_then(|stack| stack.barrel.wave(stack.view)));
    let exact =
        wave.map_or(f64::NAN, |wave| (GRAVITY / wave.length).sqrt() / std::f64::consts::TAU);
    setting(
        format!("slosh/barrel-{filled}"),
        format!(
            "barrels of 225 L on their rack, {filled} of the capacity filled, after a short push"
        ),
        "pendulum that represents the wave",
    )
    .quantity("frequency of the wave in the wine", "Hz", relative(exact, 3e-3))
    .by(move |_| {
        let run: Run = scenario(filled)?.run()?;
        let recording = &run.recording;
        let name = "wine_in_B1.1_displacement_x";
        let wine = recording.channel(name).ok_or_else(|| Failure::Absent(name.into()))?;
        let held = recording.channel("B1.1_displacement_x");
        let held = held.ok_or_else(|| Failure::Absent("the barrel".into()))?;
        let samples = wine.values.iter().zip(&held.values).map(|(wine, barrel)| wine - barrel);
        let samples: Vec<(f64, f64)> = recording.times.iter().copied().zip(samples).collect();
        let from = samples.partition_point(|(time, _)| *time <= 1.0).saturating_sub(1);
        let through = crossings(&samples[from..]);
        match through[..] {
            [first, .., last] if through.len() > 4 => {
                Ok(0.5 * (through.len() - 1) as f64 / (last - first))
            }
            _ => Err(Failure::Absent("the wine does not swing".into())),
        }
    })
}

fn scenario(filled: f64) -> Result<Scenario, Failure> {
    let text = format!(
        "schema = 1\n[stack]\nlevels = 1\ncolumns = 2\nbarrel = {{ fill = \"part\", filled = {filled} }}\n\
         [interface.rack-ground.friction]\ncoefficient = 0.6\n\
         [interface.barrel-rack]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.barrel-rack.friction]\ncoefficient = 0.6\n\
         [motion.pulse]\nkind = \"rectangular\"\namplitude = \"0.03 g\"\nperiod = \"0.1 s\"\n\
         [run]\nduration = \"8 s\"\nuntil = \"duration\"\n[record]\nhistory_rate = \"200 Hz\"\n"
    );
    Ok(Scenario::parse("slosh.toml", &text, &[])?)
}
