//! Restitution of a mass that strikes the floor, with and without gravity, and of a rocking block.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::{FrictionLaw, Method, NormalLaw, Still, Twist, Vec2};

use crate::problem::{refine, relative, setting};
use crate::rocking::{Corner, RockingBlock, contact_frequency};
use crate::scene::{DOWN, Scene, disc, floor, ground_of, interface};
use crate::swing::crossing;
use crate::{Effort, Failure, GRAVITY, Outcome, Problem, theory};

const SOURCE: &str = "damped oscillator on approach";
const ROCKING: &str = "calibration of viscous damping, as Vlachakis et al. 2021";

/// Natural frequency √(k/m) (rad/s) of the mass on the spring of its node.
const OMEGA: f64 = 100.0;
const RADIUS: f64 = 0.1;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    let table = [0.05, 0.0676, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0];
    let speed_gap =
        [0.926_69, 0.903_17, 0.862_60, 0.756_13, 0.671_55, 0.546_29, 0.458_57, 0.367_88, 0.218_56];
    let kelvin_voigt =
        [0.858_76, 0.815_71, 0.744_08, 0.571_74, 0.450_98, 0.298_44, 0.210_28, 0.135_34, 0.047_77];
    for (zeta, exact) in table.into_iter().zip(speed_gap) {
        list.push(rebound(Corner::SpeedGap, zeta, exact));
    }
    for (zeta, exact) in table.into_iter().zip(kelvin_voigt) {
        list.push(rebound(Corner::KelvinVoigt, zeta, exact));
    }
    list.extend(table.map(contact_time));
    let inverse =
        [(0.1, 4.807), (0.3, 1.336), (0.5, 0.5973), (0.7, 0.2639), (0.9, 0.0700), (0.95, 0.0333)];
    list.extend(inverse.map(|(e, zeta)| inverted(e, zeta)));
    for (zeta, gamma) in [(0.0676, 0.1), (0.0676, 0.5), (0.3, 0.1), (0.3, 0.5)] {
        list.push(under_gravity(zeta, gamma));
    }
    list.extend([0.0676, 0.2, 0.3].map(stays));
    list.extend([0.0, 0.07, 0.5, 1.0].map(stability));
    list.extend([0.92, 0.94, 0.96].map(calibrated));
    list.push(newtons_cradle());
    list
}

/// Creates the problem of a disc that strikes a row of four equal discs: elastic contacts must conserve energy.
fn newtons_cradle() -> Problem {
    setting(
        "restitution/newtons-cradle",
        "one disc at 1 m/s that strikes a row of four touching discs, no damping, no friction",
        "balance of energy",
    )
    .quantity(
        "kinetic energy after the impact, divided by that before",
        "",
        relative(1.0, 1e-6).fast(1e-4),
    ) // measured 1.9e-10
    .by(|effort| {
        let mut bodies = vec![ground_of(vec![])];
        for at in 0..5 {
            let x = 2.0 * RADIUS * f64::from(at);
            bodies.push(disc(&format!("disc {at}"), RADIUS, 1.0, 0.005, Vec2::new(x, 0.0)));
        }
        bodies[1].twist = Twist { linear: Vec2::new(1.0, 0.0), angular: 0.0 };
        let normal = NormalLaw::SpeedGap { stiffness: OMEGA * OMEGA, damping: 0.0 };
        let laws = interface(normal, FrictionLaw::Frictionless);
        let mut scene = Scene::new(bodies, laws, Vec2::default())?;
        let finer = if effort == Effort::Full { 1e-4 } else { 1e-3 };
        scene.run(&Still, finer / OMEGA, 40.0 / OMEGA)?;
        let speeds: Vec<f64> = scene.state.twists[1..].iter().map(|twist| twist.linear.x).collect();
        let energy: f64 = speeds.iter().map(|speed| speed * speed).sum();
        let said: Vec<String> = speeds.iter().map(|speed| format!("{speed:.3}")).collect();
        Ok(Outcome::of(energy).noted(format!("speeds after: {} m/s", said.join(", "))))
    })
}

/// Creates a mass of 1 kg that hits the floor at a speed (m/s).
fn striking(law: Corner, zeta: f64, speed: f64, gravity: Vec2) -> Result<Scene, Failure> {
    let stiffness = OMEGA * OMEGA;
    let damping = restitution::damping(stiffness, zeta, 1.0);
    let normal = match law {
        Corner::SpeedGap => NormalLaw::SpeedGap { stiffness, damping },
        Corner::KelvinVoigt => NormalLaw::KelvinVoigt { stiffness, damping },
    };
    let mut body = disc("mass", RADIUS, 1.0, 0.01, Vec2::new(0.0, RADIUS));
    body.twist = Twist { linear: Vec2::new(0.0, -speed), angular: 0.0 };
    Ok(Scene::new(vec![floor(), body], interface(normal, FrictionLaw::Frictionless), gravity)?)
}

/// Returns the time (s) and the speed (m/s) at which a mass leaves the floor; `None` if the mass does not leave within
/// `patience` (s).
fn leaving(scene: &mut Scene, step: f64, patience: f64) -> Result<Option<(f64, f64)>, Failure> {
    let mut before = (0.0, 0.0);
    let mut left = None;
    scene.watch(&Still, step, patience, |state, _, _| {
        let gap = state.poses[1].position.z - RADIUS;
        if gap >= 0.0 && before.1 < 0.0 {
            left = Some((crossing(before, (state.time, gap)), state.twists[1].linear.z));
            return ControlFlow::Break(());
        }
        before = (state.time, gap);
        ControlFlow::Continue(())
    })?;
    Ok(left)
}

/// Returns the time step (s) at a refinement level.
///
/// Each level halves the time step. The stiffness is the same at all levels, because the exact answer is the
/// restitution of the contact law with this stiffness.
fn step(level: i32) -> f64 {
    1e-4 / OMEGA / 2.0_f64.powi(level)
}

fn gone(left: Option<(f64, f64)>) -> Result<(f64, f64), Failure> {
    left.ok_or_else(|| Failure::Absent("the mass does not leave the floor".into()))
}

fn rebound(law: Corner, zeta: f64, exact: f64) -> Problem {
    let name = match law {
        Corner::SpeedGap => "speed-gap",
        Corner::KelvinVoigt => "kelvin-voigt",
    };
    setting(
        format!("restitution/{name}-{zeta}"),
        format!("mass on one node, {name} law, ζ = {zeta}, no gravity"),
        SOURCE,
    )
    // The published values have five digits.
    .quantity("restitution", "", relative(exact, 2e-4).fast(5e-4))
    .by(move |effort| {
        let true_value = match law {
            Corner::SpeedGap => restitution::speed_gap(zeta),
            Corner::KelvinVoigt => restitution::kelvin_voigt(zeta),
        };
        refine(effort, true_value, |level| {
            let mut scene = striking(law, zeta, 1.0, Vec2::default())?;
            // The Kelvin–Voigt node releases the mass below the surface; the mass then passes the surface at the
            // speed of its release.
            Ok(gone(leaving(&mut scene, step(level), 60.0 / OMEGA)?)?.1)
        })
    })
}

fn contact_time(zeta: f64) -> Problem {
    let exact = theory::contact_phase(zeta);
    setting(
        format!("restitution/contact-time-{zeta}"),
        format!("mass on one node, speed-gap law, ζ = {zeta}, no gravity"),
        SOURCE,
    )
    .quantity("ω multiplied by the contact time", "", relative(exact, 2e-4).fast(5e-4))
    .refined(move |_, level| {
        let mut scene = striking(Corner::SpeedGap, zeta, 1.0, Vec2::default())?;
        Ok(OMEGA * gone(leaving(&mut scene, step(level), 60.0 / OMEGA)?)?.0)
    })
}

fn inverted(e: f64, published: f64) -> Problem {
    setting(
        format!("restitution/damping-for-{e}"),
        format!("damping ratio of the speed-gap law for e = {e}, checked with an impact"),
        SOURCE,
    )
    // The published values have three or four digits.
    .quantity("damping ratio ζ", "", relative(published, 2e-3))
    .by(move |_| {
        let zeta = restitution::speed_gap_damping_ratio(e)
            .ok_or_else(|| Failure::Absent(format!("no damping ratio gives e = {e}")))?;
        let mut scene = striking(Corner::SpeedGap, zeta, 1.0, Vec2::default())?;
        let shown = gone(leaving(&mut scene, step(0), 1.0)?)?.1;
        Ok(Outcome::of(zeta).noted(format!("a mass that hits this node has e = {shown:.4}")))
    })
}

fn under_gravity(zeta: f64, gamma: f64) -> Problem {
    let exact = theory::rebound_under_gravity(zeta, gamma).0.unwrap_or(f64::NAN);
    setting(
        format!("restitution/gravity-{zeta}-{gamma}"),
        format!("mass on one speed-gap node, ζ = {zeta}, Γ = g/ωv = {gamma}"),
        SOURCE,
    )
    .quantity("restitution", "", relative(exact, 5e-4).fast(1e-3))
    .by(move |effort| {
        let speed = GRAVITY / (OMEGA * gamma);
        refine(effort, exact, |level| {
            let mut scene = striking(Corner::SpeedGap, zeta, speed, DOWN)?;
            Ok(gone(leaving(&mut scene, step(level), 60.0 / OMEGA)?)?.1 / speed)
        })
    })
}

fn stays(zeta: f64) -> Problem {
    let exact = theory::lift_off_lost(zeta);
    setting(
        format!("restitution/stays-{zeta}"),
        format!("mass on one speed-gap node under gravity, ζ = {zeta}"),
        SOURCE,
    )
    .quantity(
        "smallest Γ = g/ωv at which the mass does not rebound",
        "",
        relative(exact, 2e-3).fast(1.2e-2),
    )
    .at_border(0.02, move |gamma| {
        let mut scene = striking(Corner::SpeedGap, zeta, GRAVITY / (OMEGA * gamma), DOWN)?;
        // Every later rebound is lower than the first.
        Ok(leaving(&mut scene, step(0), 8.0 / OMEGA)?.is_none())
    })
}

/// Creates the problem of the longest time step for which symplectic Euler is stable, for a mass on a contact spring.
fn stability(zeta: f64) -> Problem {
    let exact = 2.0 * ((1.0 + zeta * zeta).sqrt() - zeta);
    setting(
        format!("restitution/stable-step-{zeta}"),
        format!("mass that rests on a damped node, ζ = {zeta}, symplectic Euler"),
        "root of the step's polynomial at −1",
    )
    .quantity("ω multiplied by the longest stable step", "", relative(exact, 5e-3).fast(1.2e-2))
    .at_border(0.02, move |step| {
        let mut scene = striking(Corner::KelvinVoigt, zeta, 0.0, DOWN)?;
        scene.method = Method::SemiImplicitEuler;
        let sunk = GRAVITY / (OMEGA * OMEGA);
        scene.state.poses[1].position.z = RADIUS - sunk * (1.0 + 1e-6);
        let mut swing = 0.0_f64;
        scene.watch(&Still, step / OMEGA, 3000.0 * step / OMEGA, |state, _, _| {
            swing = swing.max((state.poses[1].position.z - RADIUS + sunk).abs());
            ControlFlow::Continue(())
        })?;
        Ok(swing > 0.1 * sunk)
    })
}

/// Creates the problem of a damping ratio that is calibrated at one amplitude and checked at another.
fn calibrated(target: f64) -> Problem {
    let alpha = 0.25;
    setting(
        format!("restitution/rocking-target-{target}"),
        format!("block of α = {alpha}, damping calibrated at φ = 0.5, checked at φ = 0.75"),
        ROCKING,
    )
    .quantity("ratio of angular velocities η", "", relative(target, 5e-3).fast(1.2e-2))
    .by(move |effort| {
        let block = RockingBlock {
            contact_frequency: contact_frequency(effort),
            ..RockingBlock::new(1.0, alpha)
        };
        let Some(block) = block.calibrated(target)? else {
            return Err(Failure::Absent(format!("no damping ratio gives η = {target}")));
        };
        let mut note = format!("ζ = {:.4}", block.damping_ratio);
        if effort == Effort::Full {
            for share in [0.1, 0.25, 0.9] {
                let shown = block.restitution(share)?;
                let _ = write!(note, "; at φ = {share}: {shown:.4}");
            }
        }
        Ok(Outcome::of(block.restitution(0.75)?).noted(note))
    })
}
