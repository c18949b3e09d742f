//! Sloshing wine in partly filled barrels.
//!
//! Across the barrels, the pressure between wall and wine acts through the axis of the barrel. The first sloshing mode
//! is therefore modeled as a pendulum that hangs from the axis. This model holds for any motion of the barrel. The wine
//! that does not slosh moves with the axis. Along the barrels, the first sloshing mode is approximated by a mass on a
//! spring, as in a rectangular tank of the same length and filling. The mass is placed at a depth that preserves the
//! center of mass of the wine.

use std::f64::consts::PI;

use barrelstack_dynamics::{Guide, Link, Rod, Vec2};

use super::{Builder, Draft, Outline, PartKind};
use crate::device::Words;
use crate::scenario::{StackBody, View};
use crate::slosh::Wave;

/// Description of the force elements that attach a sloshing mass to its barrel. These elements never break and appear
/// in no report.
static WORDS: Words = Words::silent("wine");

/// Damping ratio of the sloshing mode. The value is an assumption: viscosity alone gives less damping in a smooth
/// barrel, and breaking waves give more.
const DAMPING_RATIO: f64 = 0.01;

/// Natural angular frequency (rad/s) of the sloshing mass on the spring that supports it; the frequency is 15 Hz.
///
/// This frequency is far above the sloshing frequency. It is low enough that the support is not stiffer than a seat.
const HOLDING: f64 = 30.0 * PI;

/// Damping ratio of the sloshing mass on its support. The value is an assumption: wine that strikes the wall does not
/// bounce back.
const HOLDING_DAMPING: f64 = 0.2;

/// Radius (m) of the disc that represents the sloshing mass in drawings.
const BOB: f64 = 0.03;

/// Adds a sloshing mass to every partly filled barrel.
pub(super) fn pour(builder: &mut Builder<'_>, gravity: f64) {
    for body in 0..builder.bodies.len() {
        let part = &builder.parts[body];
        let (PartKind::Barrel, Some(level), Some(column)) = (part.kind, part.level, part.column)
        else {
            continue;
        };
        let mut barrel = builder.spec.barrel.clone();
        for change in builder.spec.changes_of(StackBody::Barrel, level, column) {
            barrel = barrel.altered(change.mass, change.fill);
        }
        if let Some(wave) = barrel.wave(builder.spec.view) {
            add(builder, body, (barrel.mass - barrel.empty_mass, wave), gravity);
        }
    }
}

/// Moves the sloshing mass from a barrel that holds `wine` (kg) to a new body, which is suspended in the barrel.
fn add(builder: &mut Builder<'_>, body: usize, (wine, wave): (f64, Wave), gravity: f64) {
    let scale = builder.scale;
    let mass = wave.share * wine;
    let rate = (gravity / wave.length).sqrt();
    let down = match builder.spec.view {
        View::Transverse => wave.length,
        View::Longitudinal => wave.depth,
    };
    let place = builder.bodies[body].pose.position * (1.0 / scale.length) - Vec2::new(0.0, down);
    let held = &mut builder.bodies[body];
    held.mass -= mass * scale.mass();
    let name = format!("wine in {}", held.name);
    let wine = builder.add(Draft {
        name: name.clone(),
        kind: PartKind::Wine,
        level: None,
        column: 1,
        mass,
        // Every force acts through the center of mass, so the body never rotates.
        inertia: Some(0.5 * mass * BOB * BOB),
        position: place,
        size: BOB,
        solids: Vec::new(),
        carrier: Some(body),
        supports: Vec::new(),
    });
    let bob = (0..24).map(|i| {
        let (sin, cos) = barrelstack_dynamics::math::sin_cos(PI * f64::from(i) / 12.0);
        Vec2::new(cos, sin) * (BOB * scale.length)
    });
    builder.parts[wine].outlines = vec![Outline { points: bob.collect(), closed: true }];

    let damping = 2.0 * DAMPING_RATIO * mass * rate * scale.damping(false);
    let stiff = mass * HOLDING * HOLDING * scale.stiffness(1.0, false);
    let hard = 2.0 * HOLDING_DAMPING * mass * HOLDING * scale.damping(false);
    // Static deflection of the support under the weight of the sloshing mass.
    let sag = gravity / (HOLDING * HOLDING);
    let link = |what: &str| Link {
        name: format!("{name} {what}"),
        bodies: [body, wine],
        points: [Vec2::default(); 2],
    };
    match builder.spec.view {
        View::Transverse => builder.hold(
            Rod {
                link: link("pendulum"),
                length: (wave.length - sag) * scale.length,
                stiffness: stiff,
                damping: hard,
                sway_damping: damping,
            },
            &WORDS,
        ),
        View::Longitudinal => {
            let spring = mass * rate * rate * scale.stiffness(1.0, false);
            let at = Vec2::new(0.0, (sag - wave.depth) * scale.length);
            for (what, axis, k, c) in [
                ("spring", Vec2::new(1.0, 0.0), spring, damping),
                ("support", Vec2::new(0.0, 1.0), stiff, hard),
            ] {
                let guide = Guide::spring(link(what), axis, k, c);
                builder.hold(Guide { place: at, ..guide }, &WORDS);
            }
        }
    }
}
