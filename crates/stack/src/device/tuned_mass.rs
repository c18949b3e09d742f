//! Tuned masses: masses that oscillate on a spring and a damper relative to a rack.

use std::f64::consts::TAU;

use barrelstack_dynamics::{Guide, Link, Space, Vec2};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, section};

use super::{Cost, Each, LEVELS, Setting, Words};
use crate::assemble::{Builder, Draft, Outline, PartKind, Similitude};

pub(super) static WORDS: Words = Words {
    one: "tuned mass",
    many: "tuned masses",
    force: "force",
    breaks: "breaks",
    break_all: "break",
    broken: "broken",
    candidates: &[
        Setting {
            name: "a tuned mass of 50 kg on the top rack, 1 s",
            overrides: &["stack.tuned_mass.mass=\"50 kg\""],
        },
        Setting {
            name: "a tuned mass of 150 kg on the top rack, 1.5 s",
            overrides: &["stack.tuned_mass.mass=\"150 kg\"", "stack.tuned_mass.period=\"1.5 s\""],
        },
    ],
    degraded: &[Setting {
        name: "a tuned mass without its damper",
        overrides: &["stack.tuned_mass.damping_ratio=0.01"],
    }],
    // A tuned mass is an additional body; a mass of zero adds none.
    idle: &["stack.tuned_mass.mass=\"0 kg\"", "stack.tuned_mass.level=2"],
    cost: Cost {
        dollars: [400.0, 1500.0],
        each: Each::Stack,
        source: "a steel weight on rollers with springs and a damper: an assumption",
    },
};

/// Tuning of a mass to a structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// Natural frequency of the mass divided by the natural frequency of the structure.
    pub frequency: f64,
    /// Damping ratio of the mass at its own natural frequency.
    pub damping_ratio: f64,
}

impl Tuning {
    /// Returns the tuning that minimizes the largest displacement of an undamped structure under a harmonic force.
    ///
    /// `share` is the mass ratio μ. The frequency ratio is `1/(1 + μ)`, and the damping ratio is `√(3μ/(8(1 + μ)))`
    /// (Den Hartog 1956, section 3.3). A rocking stack differs from the structure of this theory: the period of the
    /// stack grows with the amplitude.
    ///
    /// ```
    /// let tuning = barrelstack_stack::device::Tuning::den_hartog(0.05);
    /// assert_eq!(tuning.frequency, 1.0 / 1.05);
    /// assert!((tuning.damping_ratio - 0.1336).abs() < 1e-4);
    /// ```
    pub fn den_hartog(share: f64) -> Self {
        Self {
            frequency: 1.0 / (1.0 + share),
            damping_ratio: (3.0 * share / (8.0 * (1.0 + share))).sqrt(),
        }
    }
}

section! {
    /// A mass on a spring and a damper on every rack of a level.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct TunedMass;
    /// Masses on the racks of one level, which oscillate on springs and dampers in the plane and touch no other body.
    pub static SECTION = "tuned_mass";
    /// Tuned mass on each rack of the level; 0 for no tuned masses.
    mass: f64 =
        Kind::Quantity(&[Dimension::MASS], Range::between(0.0, 1e4)), Default::Value("\"0 kg\"");
    /// Level of the racks that carry a mass; 0 for the top level.
    level: u32 = LEVELS, Default::Value("0");
    /// Natural period of the mass; the optimum for an undamped structure with period T is (1 + μ) T for a mass ratio μ (Den Hartog 1956).
    period: f64 =
        Kind::Quantity(&[Dimension::TIME], Range::between(0.05, 20.0)), Default::Value("\"1 s\"");
    /// Damping ratio of the mass; the optimum for a mass ratio μ is √(3μ/(8(1 + μ))), which is 0.13 for μ = 5 % (Den
    /// Hartog 1956).
    damping_ratio: f64 = Kind::Number(Range::between(0.0, 2.0)), Default::Value("0.13");
    /// Stroke of the mass to either side before it meets a stop. The default is an assumption.
    stroke: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::up_to(10.0)), Default::Value("\"30 cm\"");
    /// Stiffness of the stops. The default is an assumption.
    stop_stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"100 kN/m\"");
}

/// Reads the table of tuned masses.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<TunedMass, InputError> {
    let mass = TunedMass::read_fields(&reader)?;
    if mass.level > levels {
        let path = reader.path_of("level");
        let message =
            format!("`{path}` is {}, but the stack has only {levels} levels; lower it", mass.level);
        return Err(reader.inconsistent("level", message));
    }
    reader.finish();
    Ok(mass)
}

/// Natural frequency (Hz) of a mass on its stiff support. It is far above the natural frequency of any stack, but the
/// support is not stiffer than a seat.
const HOLDING: f64 = 15.0;

impl TunedMass {
    /// Half the width and half the height (m) of a mass in drawings.
    pub const HALF: [f64; 2] = [0.15, 0.03];
    /// Description of the elements that support a mass. These elements appear in no report.
    pub const SUPPORT: &'static Words = &Words::silent("support");

    /// Returns `true` if the stack has tuned masses.
    pub fn is_on(&self) -> bool {
        self.mass > 0.0
    }

    /// Returns the level whose racks carry masses, in a stack with `levels` levels.
    pub fn level_of(&self, levels: u32) -> u32 {
        if self.level == 0 { levels } else { self.level }
    }

    /// Returns the spring, damper and stops of a mass, along an axis of the link's first body.
    ///
    /// `share` is the fraction of the mass that the model contains: 1, or less in a planar model that contains only a
    /// slice of each rack.
    pub fn swing<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        axis: S::Vector,
        share: f64,
        scale: Similitude,
    ) -> Guide<S> {
        let (rate, mass) = (TAU / self.period, self.mass * share);
        let (stiff, damped) = (scale.stiffness(1.0, false), scale.damping(false));
        Guide {
            gap: self.stroke * scale.length,
            stop_stiffness: self.stop_stiffness * share * stiff,
            ..Guide::spring(
                link,
                axis,
                mass * rate * rate * stiff,
                2.0 * self.damping_ratio * mass * rate * damped,
            )
        }
    }

    /// Returns the stiff support of a mass, along an axis of the link's first body.
    ///
    /// `share` is as in [`TunedMass::swing`].
    pub fn hold<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        axis: S::Vector,
        share: f64,
        scale: Similitude,
    ) -> Guide<S> {
        let (fast, mass) = (TAU * HOLDING, self.mass * share);
        let stiff = mass * fast * fast * scale.stiffness(1.0, false);
        Guide::spring(link, axis, stiff, 0.1 * mass * fast * scale.damping(false))
    }

    /// Installs a mass on every rack of its level, at the center of mass of the rack.
    #[expect(clippy::unnecessary_wraps, reason = "common device signature")]
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        let (spec, scale) = (builder.spec, builder.scale);
        let level = self.level_of(spec.levels);
        let racks = if self.is_on() { builder.parts.len() } else { 0 };
        let share = 1.0 / builder.side_by_side();
        let mass = self.mass * share;
        for rack in 0..racks {
            let part = &builder.parts[rack];
            if part.kind != PartKind::Rack || part.level != Some(level) {
                continue;
            }
            let (name, column) = (format!("mass on {}", part.name), part.column.unwrap_or(1));
            let body = builder.add(Draft {
                name: name.clone(),
                kind: PartKind::Device,
                level: None,
                column,
                mass,
                // Every force acts through the center of mass, so the body never rotates.
                inertia: Some(mass * Self::HALF[0] * Self::HALF[0]),
                position: builder.bodies[rack].pose.position * (1.0 / scale.length),
                size: Self::HALF[0],
                solids: Vec::new(),
                carrier: Some(rack),
                supports: Vec::new(),
            });
            let corner =
                |x: f64, z: f64| Vec2::new(x * Self::HALF[0], z * Self::HALF[1]) * scale.length;
            let points =
                vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            builder.parts[body].outlines = vec![Outline { points, closed: true }];

            let link = Link { name, bodies: [rack, body], points: [Vec2::default(); 2] };
            let swing = self.swing(link.clone(), Vec2::new(1.0, 0.0), share, scale);
            builder.hold(swing, &WORDS);
            builder.hold(self.hold(link, Vec2::new(0.0, 1.0), share, scale), Self::SUPPORT);
        }
        Ok(())
    }
}
