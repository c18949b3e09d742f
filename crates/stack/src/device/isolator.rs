//! Isolators under the bottom racks: a platform on rollers, balls or sheets, flat or in dishes.
//!
//! A platform bears on the ground at two points. In a dish of radius `R`, a stack swings as a pendulum of length `R`
//! with the period `T = 2π √(R/g)`, whatever its mass. For balls between two dishes, `R` is the sum of both radii
//! minus the diameter of the balls.
//! The stroke ends at stops, and a rack stands on its platform as on the ground.

use barrelstack_dynamics::shape::{Cradle, Polygon};
use barrelstack_dynamics::space::Rotation2;
use barrelstack_dynamics::{
    BodyId, ContactPair, Counts, Guide, Link, Node, Nodes, Placed, Shape, Space, Vec2, math,
};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range, names};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, named, section};

use super::{Cost, Each, Loose, Setting, Words};
use crate::assemble::{Assembly, Builder, Draft, Outline, PartKind, Seat, Similitude, Solid};
use crate::scenario::{Basis, Damping, Friction, Interface, NormalLaw};

pub(super) static WORDS: Words = Words {
    one: "isolator",
    many: "isolators",
    force: "force",
    breaks: "breaks",
    break_all: "break",
    broken: "broken",
    candidates: &[
        Setting {
            name: "an isolator of balls in dishes of 1 m",
            overrides: &["stack.isolator.path=\"dish\""],
        },
        Setting {
            name: "a flat isolator of rollers with recentring springs",
            overrides: &["stack.isolator.path=\"flat\"", "stack.isolator.recentring=\"10 kN/m\""],
        },
        Setting {
            name: "a sheet of low friction",
            overrides: &["stack.isolator.path=\"flat\"", "stack.isolator.friction=0.12"],
        },
    ],
    degraded: &[
        Setting { name: "seized rollers", overrides: &["stack.isolator.friction=0.6"] },
        Setting { name: "rusty rollers", overrides: &["stack.isolator.friction=0.1"] },
    ],
    // A platform is an additional body, so results are bit-identical to those of the bare stack only without a
    // platform.
    idle: &["stack.isolator.path=\"none\"", "stack.isolator.recentring=\"10 kN/m\""],
    cost: Cost {
        dollars: [800.0, 2500.0],
        each: Each::Stack,
        source: "a platform of stainless steel with rolling bearings: an assumption",
    },
};

named! {
    /// Shape of the path on which a platform moves.
    pub enum Path {
        /// No path: the stack has no isolators.
        None = "none",
        /// A level path.
        Flat = "flat",
        /// Circular dishes.
        Dish = "dish",
    }
}

section! {
    /// Isolators under the bottom racks.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Isolators;
    /// A platform under every bottom rack; the platform rolls or slides on the ground between stops, on a flat path or
    /// in dishes.
    pub static SECTION = "isolator";
    /// Shape of the path on which the platform moves.
    path: Path = Kind::Choice(names::<Path>), Default::Value("\"none\"");
    /// Friction coefficient of the platform on its path: 0.005 to 0.02 for balls and rollers, 0.1 to 0.2 for
    /// sliding sheets, 0.6 if seized.
    friction: f64 = Kind::Number(Range::between(0.0, 2.0)), Default::Value("0.01");
    /// Radius of the dishes, which is the length of the equivalent pendulum; not used on a flat path. The default is an
    /// assumption; it gives a period of 2 s.
    dish_radius: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.3, 100.0)), Default::Value("\"1 m\"");
    /// Stroke of the platform to either side before it meets a stop. The default is an assumption.
    stroke: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.001, 10.0)), Default::Value("\"20 cm\"");
    /// Stiffness of a stop. The default is an assumption.
    stop_stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"500 kN/m\"");
    /// Damping of a stop, which acts on approach only. The default is an assumption.
    stop_damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"5 kN s/m\"");
    /// Stiffness of the springs that pull the platform back to its initial position.
    recentring: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::NOT_NEGATIVE), Default::Value("\"0 N/m\"");
    /// Stiffness of the bearings at one end of a platform. The default is an assumption for steel balls on a steel
    /// plate.
    bearing_stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"10 MN/m\"");
    /// Mass of a platform. The default is an assumption.
    mass: f64 =
        Kind::Quantity(&[Dimension::MASS], Range::up_to(1e4)), Default::Value("\"60 kg\"");
}

/// Reads the table of isolators.
pub(super) fn read(reader: Reader<'_>, _levels: u32) -> Result<Isolators, InputError> {
    let isolators = Isolators::read_fields(&reader)?;
    if isolators.path == Path::Dish && isolators.stroke > STEEPEST * isolators.dish_radius {
        let message = format!(
            "`{}` of {} m is too long for a dish with a radius of {} m; the stroke may be {} m at most",
            reader.path_of("stroke"),
            isolators.stroke,
            isolators.dish_radius,
            STEEPEST * isolators.dish_radius
        );
        return Err(reader.inconsistent("stroke", message));
    }
    reader.finish();
    Ok(isolators)
}

/// Largest permitted sine of the slope of a dish at its stops.
const STEEPEST: f64 = 0.5;

/// Half of the angle (rad) that a dish spans. A dish extends beyond its stops.
const DISH: f64 = 1.2;

/// Damping of bearings divided by their stiffness (s): an assumption. The damping acts on approach only.
const BEARING_DAMPING: f64 = 5e-4;

impl Isolators {
    /// Height (m) of the bearings of a platform: an assumption.
    pub const BEARING: f64 = 0.03;
    /// Thickness (m) of a platform: an assumption.
    pub const PLATE: f64 = 0.04;
    /// Overhang (m) of a platform beyond the rack: an assumption. The bearings lie at the same distance inside the ends
    /// of the platform.
    pub const MARGIN: f64 = 0.05;

    /// Returns `true` if the stack has isolators.
    pub fn is_on(&self) -> bool {
        self.path != Path::None
    }

    /// Returns the contact law of one contact at an end of a platform. The contact represents the fraction `share` of
    /// the bearings at that end.
    pub fn law(&self, share: f64) -> Interface {
        let stiffness = self.bearing_stiffness * share;
        Interface {
            basis: Basis::Node,
            normal: NormalLaw::SpeedGap {
                stiffness,
                damping: Damping::Coefficient(BEARING_DAMPING * stiffness),
            },
            friction: Friction::Coulomb {
                coefficient: self.friction,
                static_coefficient: self.friction,
                tangential_stiffness_ratio: 1.0,
                tangential_damping_ratio: 1.0,
            },
        }
    }

    /// Returns the guide of a platform along an axis of the ground. The guide represents the fraction `share` of the
    /// springs and stops of the platform.
    pub fn guide<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        axis: S::Vector,
        share: f64,
        scale: Similitude,
    ) -> Guide<S> {
        let stiff = scale.stiffness(1.0, false);
        Guide {
            gap: self.stroke * scale.length,
            stop_stiffness: self.stop_stiffness * share * stiff,
            stop_damping: self.stop_damping * share * scale.damping(false),
            ..Guide::spring(link, axis, self.recentring * share * stiff, 0.0)
        }
    }

    /// Raises the stack and places a platform under every bottom rack.
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        if !self.is_on() {
            return Ok(());
        }
        let (scale, share) = (builder.scale, 1.0 / builder.side_by_side());
        builder.raise((Self::BEARING + Self::PLATE) * scale.length);
        let law = builder.add_law("isolator-ground", &self.law(share));
        let bottom = |(id, part): (BodyId, &crate::assemble::Part)| {
            (part.kind == PartKind::Rack && part.supports.is_empty()).then_some(id)
        };
        let racks: Vec<BodyId> = builder.parts.iter().enumerate().filter_map(bottom).collect();
        for rack in racks {
            let (name, size) = (builder.parts[rack].name.clone(), builder.parts[rack].size);
            let half = size / scale.length + Self::MARGIN;
            let x = builder.bodies[rack].pose.position.x / scale.length;
            let plate = Polygon::rectangle(2.0 * half, Self::PLATE, 0.25 * Self::PLATE)
                .map_err(|problem| format!("the platform under {name}: {problem}"))?;
            let center = Self::BEARING + 0.5 * Self::PLATE;
            let platform = builder.add(Draft {
                name: format!("platform of {name}"),
                kind: PartKind::Device,
                level: None,
                column: builder.parts[rack].column.unwrap_or(1),
                mass: self.mass * share,
                inertia: None,
                position: Vec2::new(x, 0.0),
                size: half,
                solids: vec![Solid::exact(
                    Shape::Polygon(plate),
                    Vec2::new(0.0, center),
                    Seat::None,
                )],
                carrier: None,
                supports: Vec::new(),
            });
            builder.parts[rack].carrier = Some(platform);
            let mut ends = [-1.0, 1.0];
            if builder.spec.mirror {
                ends.reverse();
            }
            for end in ends {
                self.bear(builder, platform, law, (x, end * (half - Self::MARGIN)), center);
            }
            let link =
                Link { name, bodies: [Assembly::GROUND, platform], points: [Vec2::default(); 2] };
            let guide = self.guide(link, Vec2::new(1.0, 0.0), share, scale);
            builder.loose.push(Loose { element: guide.into(), give: 0.0, words: &WORDS });
        }
        Ok(())
    }

    /// Adds the bearing at one end of a platform.
    ///
    /// `x` (m) is the position of the platform along the ground, and `end` (m) is the position of the bearing relative
    /// to the platform. `center` (m) is the height of the platform's center of mass above the ground.
    fn bear(
        &self,
        builder: &mut Builder<'_>,
        platform: BodyId,
        interface: usize,
        (x, end): (f64, f64),
        center: f64,
    ) {
        let length = builder.scale.length;
        let surface = match self.path {
            Path::None | Path::Flat => 0,
            Path::Dish => {
                // The dish is drawn up to the stops. Its surface extends beyond them, so that the bearing stays on the
                // dish when the platform hits a stop.
                let dish =
                    |half_angle| Shape::Cradle(Cradle::new(self.dish_radius * length, half_angle));
                let offset = Vec2::new(x + end, self.dish_radius) * length;
                let drawn = dish(math::atan(self.stroke / self.dish_radius)).outline().0;
                let points = drawn.into_iter().map(|point| offset + point).collect();
                let dish = dish(DISH);
                let ground = &mut builder.parts[Assembly::GROUND];
                ground.outlines.push(Outline { points, closed: false });
                let rotation = Rotation2::identity();
                let surfaces = &mut builder.bodies[Assembly::GROUND].surfaces;
                surfaces.push(Placed { surface: dish, offset, rotation });
                surfaces.len() - 1
            }
        };
        let nodes = &mut builder.bodies[platform].nodes;
        let position = Vec2::new(end, -center) * length;
        nodes.push(Nodes::Fixed(vec![Node { position, tributary_length: length, outward: None }]));
        let nodes = nodes.len() - 1;
        builder.pairs.push(ContactPair {
            contactor: platform,
            nodes,
            target: Assembly::GROUND,
            surface,
            interface,
            counts: Counts::Everywhere,
        });
    }
}
