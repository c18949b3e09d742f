//! Stacks in the plane along the barrels: racks on posts, and rails that raise one end of every barrel.

use barrelstack::assemble::{Assembly, assemble};
use barrelstack::{Run, Scenario};
use barrelstack_dynamics::Vec2;
use barrelstack_dynamics::math::{cos, sin};

use crate::problem::{absent, border, halvings, relative, setting};
use crate::{Failure, Problem};

use super::devices::{push, run_pushed};

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![posts()];
    list.extend([(0.0, 1.0), (3.5, 1.0), (3.5, -1.0)].map(|(degrees, side)| slides(degrees, side)));
    list
}

/// Runs a stack in the plane along its barrels under a push, which is a horizontal ground acceleration (g) that grows
/// for two seconds and is then constant for one second.
///
/// The contacts are so stiff that almost nothing deforms.
fn pushed(settings: &[String], push: f64) -> Result<Run, Failure> {
    run_pushed(&scenario(settings)?, push, 2000)
}

fn scenario(settings: &[String]) -> Result<Scenario, Failure> {
    let text = format!(
        "schema = 1\n[stack]\nview = \"longitudinal\"\ncolumns = 1\nlevels = 1\n\
         [interface.rack-ground]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.rack-ground.friction]\ncoefficient = 5.0\n\
         [interface.rack-rack]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.rack-rack.friction]\ncoefficient = 5.0\n\
         [interface.barrel-rack]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n{}\n\
         [run]\nduration = \"2.99 s\"\nuntil = \"duration\"\n",
        push(0.1, 1.0)
    );
    Ok(Scenario::parse("racks.toml", &text, settings)?)
}

/// Distance (m) from the middle of the rack to the outer end of the flat top of a post: 44 cm to the axis of the post,
/// plus half its width of 5 cm, minus the corner radius of 12 mm.
const EDGE: f64 = 0.44 + 0.025 - 0.012;

/// Vertical distance (m) between two levels of racks that stand on posts.
const PITCH: f64 = 0.89;

fn towers() -> Vec<String> {
    // The bottom rack is so heavy that it stays on the ground and the stack tips about its posts.
    [
        "stack.rack=rack-on-rack",
        "stack.levels=3",
        "interface.rack-ground.stiffness=\"5000 MN/m\"",
        // Before uplift the stack leans, since its outer posts sink into their contacts. This lowers the push at
        // uplift by 0.7 % with 500 MN/m, and by 0.2 % with 2 GN/m.
        "interface.rack-rack.stiffness=\"2000 MN/m\"",
        "stack.override=[{ kind = \"rack\", level = 1, mass = \"50000 kg\" }]",
        "interface.barrel-rack.friction.coefficient=5.0",
    ]
    .map(str::to_owned)
    .into()
}

fn posts() -> Problem {
    // The mass of a rack is uniform over its tubes and posts, so its center follows from the drawing.
    let exact = EDGE / height_of_upper_levels().unwrap_or(f64::NAN);
    setting(
        "devices/posts-along",
        "two levels on the posts of a heavy rack, pushed along the barrels",
        "statics: uplift at a/g = c/h",
    )
    .quantity(
        "smallest push that lifts the upper levels off their posts",
        "g",
        relative(exact, 5e-3).fast(1e-2),
    )
    .by(move |effort| {
        height_of_upper_levels()?;
        let found = border((0.97 * exact, 1.03 * exact), halvings(effort).min(6), |amplitude| {
            let run = pushed(&towers(), amplitude)?;
            let rack = named(&run.assembly, "R2")?;
            Ok(run.fates.fate(rack).peak_tilt > 5e-3)
        })?;
        Ok(found)
    })
}

/// Returns the height (m) of the center of mass of the second and third levels, measured from the tops of the posts
/// that carry these levels.
fn height_of_upper_levels() -> Result<f64, Failure> {
    let assembly = assemble(&scenario(&towers())?).map_err(absent)?;
    let (mut mass, mut moment) = (0.0, 0.0);
    for name in ["R2", "B2.1", "R3", "B3.1"] {
        let body = &assembly.model.bodies()[named(&assembly, name)?];
        mass += body.mass;
        moment += body.mass * (body.pose.position.z - PITCH);
    }
    Ok(moment / mass)
}

fn named(assembly: &Assembly, name: &str) -> Result<usize, Failure> {
    assembly.model.body_named(name).ok_or_else(|| Failure::Absent(format!("no {name}")))
}

/// Length, diameter at the heads, and diameter at the bilge of the barrel (m).
const BARREL: [f64; 3] = [0.945, 0.555, 0.690];

/// Friction coefficient between the barrel and the supports of its cradles.
const FRICTION: f64 = 0.2;

/// Angle (degrees) of the supports of a cradle from the vertical, in the view along the barrel.
const CRADLE: f64 = 28.0;

/// Returns the effective friction coefficient of the barrel along its axis.
///
/// The barrel is wedged between the two supports of each cradle, so the normal forces of the two supports add up to the
/// load of the barrel on the rail, divided by the cosine of the cradle angle.
fn wedged() -> f64 {
    FRICTION / cos(CRADLE.to_radians())
}

/// Returns the smallest horizontal ground acceleration (g) that makes a barrel slide on two rails. The rails tilt the
/// barrel by an angle (rad), so that its right end is higher.
///
/// The barrel slides toward the right end or, with `side = -1`, away from it. The staves form an arc about a point C
/// high above the barrel, so the barrel slides by rotating about C. The balance of forces is
/// `N₁ n₁ + N₂ n₂ + μ (N₁ t₁ + N₂ t₂) + m (A, −g) = 0`, and the balance of moments about C is
/// `m d × (A, −g) = μ (N₁ + N₂) R`. N are the normal forces at the rails, n the unit vectors from the contacts to C,
/// and t the unit vectors of the friction forces. A is the magnitude of the ground acceleration, R the radius of the
/// arc, d the vector from C to the center of the barrel, and μ the coefficient of [`wedged`].
fn sliding(angle: f64, side: f64) -> f64 {
    let [length, head, bilge] = BARREL;
    let friction = wedged();
    let rise = 0.5 * (bilge - head);
    let arc = (0.25 * length * length + rise * rise) / (2.0 * rise);
    // Rails at ±27 cm, 5 cm wide, with corners rounded by 12 mm; the barrel touches their inner corners.
    let (corner, rail) = (0.012, 0.27 - 0.025 + 0.012);
    let down = arc - 0.5 * bilge;
    // Center of the barrel relative to C, mirrored if the barrel slides away from its raised end.
    let center = Vec2::new(side * down * sin(angle), -down * cos(angle));
    let contact = |at: f64| {
        let x = (at + center.x) / (arc + corner);
        Vec2::new(x, -(1.0 - x * x).sqrt())
    };
    let [left, right] = [-rail, rail].map(contact);
    // Force at a contact for a unit normal force: toward C, and against the slip, which is to the right.
    let force = |e: Vec2| Vec2::new(-e.x + friction * e.z, -e.z - friction * e.x);
    let (a, b) = (force(left), force(right));
    // In units of weight: N₁ a + N₂ b = (−A, 1).
    let whole = a.x * b.z - b.x * a.z;
    let normal = |push: f64| {
        let (x, z) = (-push, 1.0);
        [(x * b.z - b.x * z) / whole, (a.x * z - x * a.z) / whole]
    };
    let excess = |push: f64| {
        let [one, other] = normal(push);
        (-center.z * push - center.x) - friction * (one + other) * arc
    };
    let (zero, slope) = (excess(0.0), excess(1.0) - excess(0.0));
    -zero / slope
}

fn slides(degrees: f64, side: f64) -> Problem {
    let exact = sliding(degrees.to_radians(), side);
    let (name, words) = match (degrees > 0.0, side > 0.0) {
        (false, _) => ("level", "on level rails"),
        (true, true) => ("up", "toward the end that is raised by the slope of its rails, 3.5°"),
        (true, false) => ("down", "away from the end that its rails raise by 3.5°"),
    };
    setting(
        format!("devices/incline-{name}"),
        format!("a barrel pushed {words}, μ = {FRICTION}"),
        "statics: two contacts under Coulomb friction on an arc",
    )
    .quantity("smallest push that makes the barrel slide", "g", relative(exact, 1e-2).fast(2e-2))
    .by(move |effort| {
        border((0.95 * exact, 1.05 * exact), halvings(effort), |amplitude| {
            let settings = [
                format!("interface.barrel-rack.friction.coefficient={FRICTION}"),
                format!("stack.rack.incline=\"{degrees} deg\""),
            ];
            // Ground acceleration to the left pushes the barrel to the right.
            let run = pushed(&settings, -side * amplitude)?;
            Ok(run.fates.fate(named(&run.assembly, "B1.1")?).peak_slip > 1e-3)
        })
    })
}
