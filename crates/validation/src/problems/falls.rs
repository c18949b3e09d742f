//! Largest impact force on a falling body, as reported by a run.

use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack::assemble::assemble;
use barrelstack::watch::{Fates, Thresholds};
use barrelstack_dynamics::Still;
use barrelstack_dynamics::math::pow;

use crate::problem::{absent, relative, setting};
use crate::scene::Scene;
use crate::{Failure, GRAVITY, Problem};

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    [1.0, 5.0].map(stopped).into()
}

/// Mass (kg) and radius (m) of a full barrel, and Hertz stiffness (N/m^1.5) of the ground.
const BARREL: [f64; 3] = [268.75, 0.345, 1.2e9];

/// Returns the largest force (N) on a body that falls from a height (m) onto ground with the contact law `F = k δ^1.5`.
/// The energy balance is `m g (h + δ) = ⅖ k δ^2.5`.
fn largest_force(height: f64) -> f64 {
    let [mass, _, hardness] = BARREL;
    let mut depth = 0.0_f64;
    for _ in 0..60 {
        depth = pow(2.5 * mass * GRAVITY * (height + depth) / hardness, 0.4);
    }
    hardness * pow(depth, 1.5)
}

fn stopped(height: f64) -> Problem {
    let [mass, radius, hardness] = BARREL;
    let exact = largest_force(height);
    setting(format!("falls/force-{height}"), format!(
            "a barrel that falls {height} m onto ground with the stiffness of the default impact \
             law"
        ), "energy: m g (h + δ) = ⅖ k δ^2.5")
.quantity("largest force on the barrel", "N", relative(exact, 1e-4))
.by(move |_| {
            let text = format!(
                "schema = 1\nkind = \"free\"\n[[body]]\nname = \"barrel\"\n\
                 shape = {{ type = \"circle\", radius = \"{radius} m\" }}\nmass = \"{mass} kg\"\n\
                 position = [\"0 m\", \"{} m\"]\nnodes = \"rolling\"\n[[interface]]\n\
                 between = [\"barrel\", \"ground\"]\nlaw = \"hertz\"\nstiffness = \"{hardness} N/m^1.5\"\n\
                 friction = {{ law = \"none\" }}\n[run]\nduration = \"1 s\"\nsettle = false\n",
                radius + height
            );
            let assembly = assemble(&Scenario::parse("fall.toml", &text, &[])?)
                .map_err(absent)?;
            let mut scene = Scene::of(assembly.model.clone());
            let mut fates = Fates::new(&assembly, &scene.state, THRESHOLDS);
            scene.watch(&Still, 1e-5, 1.3, |state, scratch, _| {
                fates.observe(state, scratch);
                ControlFlow::Continue(())
            })?;
            let body = assembly.model.body_named("barrel");
            let force = body.and_then(|body| fates.fate(body).fall_force);
            force.ok_or_else(|| Failure::Absent("nothing fell".into()))
        })
}

/// Thresholds for a body that does not rest on a rack. The body counts as fallen when it is 20 cm below its initial
/// position. All other thresholds are infinite.
const THRESHOLDS: Thresholds = Thresholds {
    seat_loss_ratio: f64::INFINITY,
    fall_drop: 0.2,
    rack_slide_ratio: f64::INFINITY,
    rocking_angle: f64::INFINITY,
    overturning_angle: f64::INFINITY,
};
