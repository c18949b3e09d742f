//! Stops that keep racks from walking on the barrels below: hooks over the ends of the barrels, or saddles.
//!
//! Once a rack has been lifted above the lips of its stops, it stays disengaged.

use barrelstack_dynamics::{Guide, Link, Space, Vec2};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range, names};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, named, section};

use super::{Cost, Each, LEVELS, Loose, Setting, Words, check_levels, lowest};
use crate::assemble::{Builder, Outline, PartKind, Similitude};
use crate::scenario::{RackKind, View};

pub(super) static WORDS: Words = Words {
    one: "walking stop",
    many: "walking stops",
    force: "force",
    breaks: "gives way",
    break_all: "give way",
    broken: "off",
    candidates: &[
        Setting {
            name: "hooks over the barrel ends under every rack",
            overrides: &["stack.walking_stop.levels=12"],
        },
        Setting {
            name: "saddles that hold every rack both ways",
            overrides: &["stack.walking_stop.levels=12", "stack.walking_stop.holds=\"both\""],
        },
    ],
    degraded: &[Setting {
        name: "bent stops",
        overrides: &["stack.walking_stop.gap=\"6 cm\"", "stack.walking_stop.lip=\"1 cm\""],
    }],
    idle: &[
        "stack.walking_stop.levels=12",
        "stack.walking_stop.holds=\"both\"",
        "stack.walking_stop.gap=\"9 m\"",
    ],
    cost: Cost {
        dollars: [20.0, 80.0],
        each: Each::Level,
        source: "four bent plates welded to a rack: an assumption",
    },
};

named! {
    /// Direction in which stops hold racks.
    pub enum Holds {
        /// Along the barrels: a hook of the rack over the hoop or the end of the barrel below.
        Along = "along",
        /// Across the barrels: a saddle of the rack that bears, without friction, against the curved side of the barrel
        /// below.
        Across = "across",
        /// Both along and across the barrels.
        Both = "both",
    }
}

section! {
    /// Stops between racks and the barrels below.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct WalkingStops;
    /// Stops between racks and the barrels below: lips that a rack meets once it has moved by the distance `gap`.
    pub static SECTION = "walking_stop";
    /// Number of levels with stops under their racks, counted from the top; 12 for all levels, 0 for none. The bottom
    /// rack never has stops.
    levels: u32 = LEVELS, Default::Value("0");
    /// Direction in which the stops hold: along the barrels, across them, or both.
    holds: Holds = Kind::Choice(names::<Holds>), Default::Value("\"along\"");
    /// Displacement of a rack from its position at rest, to either side, before it meets a lip. The default is an
    /// assumption.
    gap: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 10.0)), Default::Value("\"2 cm\"");
    /// Height of the lips. A rack that has risen by more than this height is disengaged. The default is an assumption.
    lip: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::up_to(1.0)), Default::Value("\"4 cm\"");
    /// Stiffness of the lips at one barrel (force per displacement). The default is an assumption for bent steel plate.
    stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"1 MN/m\"");
    /// Damping of the lips at one barrel (force per speed), which acts on approach only. The default is an
    /// assumption.
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"2 kN s/m\"");
    /// Force above which the lips at one barrel break; if not given, lips never break.
    strength: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
}

/// Reads the table of walking stops.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<WalkingStops, InputError> {
    let stops = WalkingStops::read_fields(&reader)?;
    if stops.levels < 12 {
        check_levels(&reader, stops.levels, levels)?;
    }
    reader.finish();
    Ok(stops)
}

impl WalkingStops {
    /// Returns `true` if the stack has stops.
    pub fn is_on(&self) -> bool {
        self.levels > 0
    }

    /// Returns the stops between the two bodies of a link; they act along an axis of the first body.
    ///
    /// The stops disengage once the rack has risen above the lips.
    pub fn guide<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        axis: S::Vector,
        scale: Similitude,
    ) -> Guide<S> {
        Guide {
            gap: self.gap * scale.length,
            stop_stiffness: self.stiffness * scale.stiffness(1.0, false),
            stop_damping: self.damping * scale.damping(false),
            strength: self.strength.map_or(f64::INFINITY, |force| force * scale.force()),
            reach: self.lip * scale.length,
            ..Guide::spring(link, axis, 0.0, 0.0)
        }
    }

    /// Installs stops between racks and each of the barrels below.
    ///
    /// # Errors
    /// If the racks stand on other racks instead of barrels.
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        let spec = builder.spec;
        if !self.is_on() {
            return Ok(());
        }
        if spec.rack.kind == RackKind::OnRacks {
            return Err(format!(
                "walking stops hold racks on the barrels below, but a `{}` rack stands on posts: set \
                 stack.walking_stop.levels = 0, or take another rack; racks on posts are held by rack.post_spigot",
                spec.rack.base
            ));
        }
        let held = match spec.view {
            View::Transverse => self.holds != Holds::Along,
            View::Longitudinal => self.holds != Holds::Across,
        };
        let lowest = lowest(self.levels, spec.levels);
        let scale = builder.scale;
        for rack in 0..builder.parts.len() {
            let part = &builder.parts[rack];
            if !held || part.kind != PartKind::Rack || part.level < Some(lowest) {
                continue;
            }
            for barrel in part.supports.clone() {
                let below = &builder.parts[barrel];
                let (name, size) = (below.name.clone(), below.size);
                // A saddle acts at the center of the barrel, because the barrel may turn under the saddle; a hook acts
                // at the top of the barrel.
                let (point, reach) = match spec.view {
                    View::Transverse => (Vec2::default(), 0.7 * size),
                    View::Longitudinal => {
                        (Vec2::new(0.0, size), 0.5 * spec.barrel.length * scale.length)
                    }
                };
                let (gap, lip) = (self.gap * scale.length, self.lip * scale.length);
                let link = Link {
                    name: format!("{}-{name}", builder.parts[rack].name),
                    bodies: [rack, barrel],
                    points: [Vec2::default(), point],
                };
                let guide = self.guide(link, Vec2::new(1.0, 0.0), scale);
                builder.loose.push(Loose { element: guide.into(), give: 0.0, words: &WORDS });
                let apart =
                    builder.bodies[barrel].pose.position - builder.bodies[rack].pose.position;
                for side in [-1.0, 1.0] {
                    let foot = match spec.view {
                        View::Transverse => reach + gap,
                        View::Longitudinal => spec.rack.rail_half_spacing * scale.length,
                    };
                    let top = |x: f64| Vec2::new(apart.x + side * x, apart.z + size);
                    let lip = Vec2::new(0.0, lip.max(0.25 * size));
                    let points = vec![top(foot), top(reach + gap), top(reach + gap) - lip];
                    builder.parts[rack].outlines.push(Outline { points, closed: false });
                }
            }
        }
        Ok(())
    }
}
