//! Protection devices on stacks built from scenarios: forces, periods and frequencies.

use std::f64::consts::TAU;

use barrelstack::device::Tuning;
use barrelstack::{Run, assemble::Assembly};
use barrelstack_dynamics::math::{cos, sin, tan};

use crate::problem::{relative, setting};
use crate::{Failure, GRAVITY, Problem};

use super::devices::{self, displacement, one_level, pressed, push};

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![lid(), lid_breaks(), strap()];
    list.extend(walking_stop());
    list.push(tie());
    list.extend([0, 1].map(frequency));
    list.extend([0.05, 0.15].map(tuned));
    list
}

/// Angle (rad) from the vertical at which a barrel rests on the supports of a cradle.
const CRADLE: f64 = 28.0 * TAU / 360.0;

/// Mass of a full barrel (kg).
const BARREL: f64 = 46.0 + 990.0 * 0.225;

/// Returns the horizontal ground acceleration (g) under which a barrel leans on only one support of its cradle while a
/// device holds the barrel down with a force (N): `N sin φ = m A`, `N cos φ = m g + F`.
fn held_at(force: f64) -> f64 {
    tan(CRADLE) * (1.0 + force / (BARREL * GRAVITY))
}

/// Returns the force (N) that holds a barrel down on one support under a horizontal ground acceleration (g). This
/// function is the inverse of [`held_at`].
fn holding(push: f64) -> f64 {
    BARREL * GRAVITY * (push / tan(CRADLE) - 1.0)
}

const HELD: &str = "statics: F = m g (A/(g tan φ) − 1)";

/// Setting of a contact stiffness that is so large that the penetration of the barrel into its support is negligible.
const HARD: &str = "interface.barrel-rack.stiffness=\"500 MN/m\"";

fn lids() -> Vec<String> {
    let fields = ["levels=1", "gap=\"0 m\"", "stiffness=\"500 MN/m\""];
    let mut settings = fields.map(|field| format!("stack.lid.{field}")).to_vec();
    settings.push(HARD.into());
    settings
}

/// Returns the largest force (N) in any element.
fn largest(run: &Run) -> f64 {
    run.elements.iter().map(|element| element.peak.0.abs()).fold(0.0, f64::max)
}

fn lid() -> Problem {
    let exact = holding(0.9);
    setting(
        "devices/lid",
        "a barrel in a cradle of 28° under a lid without a gap, pushed with 0.9 g",
        HELD,
    )
    .quantity("force on the lid", "N", relative(exact, 5e-3))
    .by(|_| Ok(largest(&pressed(&lids(), 0.9)?)))
}

fn lid_breaks() -> Problem {
    let strength = 1000.0;
    let exact = held_at(strength);
    setting(
        "devices/lid-breaks",
        "a barrel in a cradle of 28° under a lid that breaks at 1 kN",
        HELD,
    )
    .quantity("smallest push that makes the barrel roll out", "g", relative(exact, 5e-3).fast(2e-2))
    .at_border(0.05, move |amplitude| {
        let mut settings = lids();
        settings.push(format!("stack.lid.strength=\"{strength} N\""));
        Ok(pressed(&settings, amplitude)?.fates.collapse_time().is_some())
    })
}

fn strap() -> Problem {
    // There is a strap on each side of the barrel. Without friction the barrel turns until both straps pull equally.
    let exact = 0.5 * holding(0.9);
    setting(
        "devices/strap",
        "a barrel strapped into a cradle of 28° without slack, pushed with 0.9 g",
        HELD,
    )
    .quantity("tension of one of the two straps", "N", relative(exact, 5e-3))
    .by(|_| {
        let settings = ["stack.strap.levels=1", "stack.strap.stiffness=\"500 MN/m\"", HARD];
        let settings = settings.map(str::to_owned);
        Ok(largest(&pressed(&settings, 0.9)?))
    })
}

/// Returns the period (s) of a quantity, computed from its zero crossings after a time (s).
fn period(samples: &[(f64, f64)], after: f64) -> Result<f64, Failure> {
    devices::period(samples, after)
        .ok_or_else(|| Failure::Absent("the stack does not swing".into()))
}

/// Returns the mass (kg) of the bodies whose names pass a filter.
fn mass_of(run: &Run, counts: impl Fn(&str) -> bool) -> f64 {
    let bodies = run.assembly.model.bodies().iter().enumerate();
    let counted = bodies.filter(|(at, body)| *at != Assembly::GROUND && counts(&body.name));
    counted.map(|(_, body)| body.mass).sum()
}

/// Creates the problems of a two-level stack with stops between the upper rack and the two barrels below. The upper
/// level slides without friction until it meets a stop.
fn walking_stop() -> [Problem; 2] {
    let (gap, stiffness) = (0.01, 1e5);
    let (push_g, seconds) = (0.1, 0.1);
    let speed = push_g * GRAVITY * seconds;
    let mass = 400.0 + 2.0 * BARREL;
    let omega = (2.0 * stiffness / mass).sqrt();
    let run = move || {
        let settings = [
            "stack.levels=2".to_owned(),
            "stack.walking_stop.levels=12".into(),
            "stack.walking_stop.holds=\"across\"".into(),
            format!("stack.walking_stop.gap=\"{gap} m\""),
            "stack.walking_stop.lip=\"20 cm\"".into(),
            format!("stack.walking_stop.stiffness=\"{stiffness} N/m\""),
            "stack.walking_stop.damping=\"0 N s/m\"".into(),
        ];
        one_level(&settings, &push(push_g, seconds), 4.0)
    };
    let title = || "a rack that slides between stops of ±1 cm on the barrels below".to_owned();
    [
        setting("devices/walking-stop-period", title(), "4 δ/v + 2π/ω")
            .quantity("period", "s", relative(4.0 * gap / speed + TAU / omega, 5e-3))
            .by(move |_| period(&displacement(&run()?, "R2", "x")?, seconds)),
        setting("devices/walking-stop-force", title(), "energy: ½ m v² = F²/2k on two stops")
            .quantity(
                "largest force in one of the two stops",
                "N",
                relative(0.5 * mass * omega * speed, 5e-3),
            )
            .by(move |_| Ok(largest(&run()?))),
    ]
}

/// Returns the settings of a platform without friction on springs of the stiffness `recentring` (N/m).
fn platform(recentring: f64) -> Vec<String> {
    vec![
        "stack.isolator.path=\"flat\"".to_owned(),
        "stack.isolator.friction=0".into(),
        "stack.isolator.stroke=\"5 m\"".into(),
        format!("stack.isolator.recentring=\"{recentring} N/m\""),
        "interface.barrel-rack.friction.coefficient=0.6".into(),
    ]
}

/// Mass (kg) that moves with a platform, including the default mass of the platform.
const ABOARD: f64 = 60.0 + 400.0 + 2.0 * BARREL;

fn tie() -> Problem {
    let (slack, stiffness) = (0.02, 4e4);
    let (push_g, seconds) = (0.1, 0.15);
    let speed = push_g * GRAVITY * seconds;
    let omega = (stiffness / ABOARD).sqrt();
    setting(
        "devices/tie",
        "a stack that slides without friction between ties to both walls, each tie with 2 cm of \
         slack",
        "4 δ/v + 2π/ω",
    )
    .quantity("period", "s", relative(4.0 * slack / speed + TAU / omega, 5e-3))
    .by(move |_| {
        let mut settings = platform(0.0);
        settings.extend([
            "stack.tie.levels=1".into(),
            format!("stack.tie.slack=\"{slack} m\""),
            format!("stack.tie.stiffness=\"{stiffness} N/m\""),
        ]);
        let run = one_level(&settings, &push(push_g, seconds), 6.0)?;
        period(&displacement(&run, "R1", "x")?, seconds)
    })
}

/// Stiffness (N/m) of the springs of a platform with a tuned mass.
const SPRINGS: f64 = 1e5;

/// Simulates a platform on springs, with a tuned mass on the rack that the platform carries. `motion` is the amplitude
/// (g) and the duration (s) of a rectangular pulse of ground acceleration.
fn with_mass(mass: f64, tuning: Tuning, motion: (f64, f64), seconds: f64) -> Result<Run, Failure> {
    let own = TAU / (tuning.frequency * (SPRINGS / ABOARD).sqrt());
    let mut settings = platform(SPRINGS);
    settings.extend([
        format!("stack.tuned_mass.mass=\"{mass} kg\""),
        format!("stack.tuned_mass.period=\"{own} s\""),
        format!("stack.tuned_mass.damping_ratio={}", tuning.damping_ratio),
        "stack.tuned_mass.stroke=\"5 m\"".into(),
    ]);
    let run = one_level(&settings, &push(motion.0, motion.1), seconds)?;
    let aboard = mass_of(&run, |name| name != "mass on R1");
    if (aboard / ABOARD - 1.0).abs() > 1e-9 {
        return Err(Failure::Absent(format!("the platform carries {aboard} kg, not {ABOARD} kg")));
    }
    Ok(run)
}

/// Creates the problem of a natural frequency of a platform with a tuned mass, without damping: the lower frequency if
/// `upper` is 0, and the upper frequency if it is 1.
fn frequency(upper: usize) -> Problem {
    let (mass, tuning) = (150.0, Tuning { frequency: 0.9, damping_ratio: 0.0 });
    let whole = SPRINGS / ABOARD;
    let own = tuning.frequency * tuning.frequency * whole;
    // (k₁ + k₂ − ω² m₁)(k₂ − ω² m₂) = k₂².
    let sum = whole + own * (1.0 + mass / ABOARD);
    let root = (0.25 * sum * sum - whole * own).sqrt();
    let square = 0.5 * sum + if upper == 1 { root } else { -root };
    let name = ["lower", "upper"][upper];
    setting(
        format!("devices/tuned-mass-{name}"),
        "a stack on a platform with springs and a tuned mass of 150 kg on its rack, undamped",
        "two degrees of freedom",
    )
    .quantity(
        ["lower frequency", "upper frequency"][upper],
        "Hz",
        relative(square.sqrt() / TAU, 2e-3),
    )
    .by(move |_| {
        let run = with_mass(mass, tuning, (0.2, 0.05), 10.0)?;
        let (platform, other) =
            (displacement(&run, "platform of R1", "x")?, displacement(&run, "mass on R1", "x")?);
        // A mode is isolated by projecting out the other mode, which is orthogonal with respect to the masses.
        let shape = own / (own - square);
        let projected =
            |((t, x), (_, y)): (&(f64, f64), &(f64, f64))| (*t, ABOARD * x + mass * shape * y);
        let mode: Vec<(f64, f64)> = platform.iter().zip(&other).map(projected).collect();
        period(&mode, 0.1).map(|period| 1.0 / period)
    })
}

/// Returns the frequencies (rad/s) at which the response is evaluated.
fn frequencies() -> impl Iterator<Item = f64> {
    (0..=60).map(|i| (SPRINGS / ABOARD).sqrt() * (0.65 + 0.01 * f64::from(i)))
}

/// Creates the problem of a platform with a mass that is tuned by Den Hartog's formula. The quantity is the largest
/// dynamic amplification of the displacement of the platform, over all frequencies of the ground motion.
///
/// The exact answer is a closed form. The program's answer is computed from the response to an impulse, which excites
/// all frequencies.
fn tuned(share: f64) -> Problem {
    let tuning = Tuning::den_hartog(share);
    let whole = SPRINGS / ABOARD;
    let own = tuning.frequency * whole.sqrt();
    let closed = |omega: f64| {
        // The mass, relative to the platform: y (ω₂² − ω² + 2 i ζ ω₂ ω) = −a + ω² x.
        let (re, im) = (own * own - omega * omega, 2.0 * tuning.damping_ratio * own * omega);
        let size = re * re + im * im;
        // The platform: x (ω₁² − ω²) = −a + μ (ω₂² + 2 i ζ ω₂ ω) y.
        let (spring_re, spring_im) = (own * own, im);
        let (ratio_re, ratio_im) =
            ((spring_re * re + spring_im * im) / size, (spring_im * re - spring_re * im) / size);
        let (left_re, left_im) =
            (whole - omega * omega * (1.0 + share * ratio_re), -omega * omega * share * ratio_im);
        let (right_re, right_im) = (1.0 + share * ratio_re, share * ratio_im);
        let square = |a: f64, b: f64| a * a + b * b;
        whole * (square(right_re, right_im) / square(left_re, left_im)).sqrt()
    };
    let exact = frequencies().map(closed).fold(0.0, f64::max);
    let (blow, seconds) = (0.5, 0.02);
    setting(
        format!("devices/tuned-mass-{share}"),
        format!(
            "a stack on a platform with springs and a tuned mass by Den Hartog, {share} times all \
             other mass"
        ),
        "two degrees of freedom",
    )
    .quantity("largest displacement divided by the static displacement", "", relative(exact, 1e-2))
    .by(move |_| {
        let run = with_mass(share * ABOARD, tuning, (blow, seconds), 16.0)?;
        let samples = displacement(&run, "platform of R1", "x")?;
        let answer = |omega: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for pair in samples.windows(2) {
                let step = 0.5 * (pair[1].0 - pair[0].0);
                for (t, x) in pair {
                    re += step * x * cos(omega * t);
                    im += step * x * sin(omega * t);
                }
            }
            // The impulse has the amplitude a v sin(ωT/2)/(ωT/2) at every frequency.
            let held = blow * GRAVITY * sin(0.5 * omega * seconds) / (0.5 * omega);
            (re * re + im * im).sqrt() * whole / held
        };
        Ok(frequencies().map(answer).fold(0.0, f64::max))
    })
}
