//! Straps that hold the top levels of a stack.
//!
//! A strap over a barrel does not slip on the barrel. In the model, each strap is therefore attached where it leaves
//! the barrel, at the ends of the horizontal diameter, and runs straight down to the rack from there. In the plane
//! along the barrels, both sides of the strap coincide in one line through the middle of the barrel.

use barrelstack_dynamics::{BodyId, Link, Space, Strap, Vec2};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range, names};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, named, section};

use super::{Cost, Each, LEVELS, Loose, Setting, Words, check_levels, lowest};
use crate::assemble::{Builder, PartKind, Similitude};
use crate::scenario::View;

pub(super) static WORDS: Words = Words {
    one: "strap",
    many: "straps",
    force: "tension",
    breaks: "tears",
    break_all: "tear",
    broken: "torn",
    candidates: &[
        Setting {
            name: "barrels of the top level strapped to their racks",
            overrides: &["stack.strap.levels=1", "stack.strap.pretension=\"1 kN\""],
        },
        Setting {
            name: "the top three levels strapped together",
            overrides: &[
                "stack.strap.levels=3",
                "stack.strap.ties=\"levels-together\"",
                "stack.strap.pretension=\"2 kN\"",
            ],
        },
    ],
    degraded: &[Setting {
        name: "loose straps",
        overrides: &["stack.strap.pretension=\"0 N\"", "stack.strap.slack=\"3 cm\""],
    }],
    idle: &["stack.strap.levels=3", "stack.strap.pretension=\"0 N\"", "stack.strap.slack=\"1 m\""],
    cost: Cost {
        dollars: [40.0, 120.0],
        each: Each::Level,
        source: "two ratchet straps of 5 kN with hooks, and half an hour of work by two people: an assumption",
    },
};

/// Candidate pretensions (kN) of straps around the whole stack; a hand ratchet for 50 mm webbing reaches 5 kN at most.
const PRETENSIONS: [u32; 2] = [1, 3];

/// Returns candidate settings that strap all levels of a stack together; none for a stack of one level.
pub(super) fn about_all(levels: u32) -> impl Iterator<Item = (String, Vec<String>)> {
    PRETENSIONS.into_iter().filter(move |_| levels > 1).map(move |pretension| {
        let fields = [
            format!("levels={levels}"),
            "ties=\"levels-together\"".to_owned(),
            format!("pretension=\"{pretension} kN\""),
        ];
        let changes = fields.iter().map(|field| format!("stack.strap.{field}")).collect();
        (format!("all levels held together by straps tightened to {pretension} kN"), changes)
    })
}

named! {
    /// Bodies that straps tie together.
    pub enum Ties {
        /// Every barrel is tied to its own rack, on both sides.
        BarrelsToRacks = "barrels-to-racks",
        /// In addition, every rack is tied to the rack below it, so that the levels become one block.
        LevelsTogether = "levels-together",
    }
}

section! {
    /// Straps on the top levels of a stack.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Straps;
    /// Straps on the top levels, which pull but never push and have no mass.
    pub static SECTION = "strap";
    /// Number of levels with straps, counted from the top; 0 for no straps.
    levels: u32 = LEVELS, Default::Value("0");
    /// Bodies that the straps tie together: every barrel to its rack, or in addition every rack to the rack below.
    ties: Ties = Kind::Choice(names::<Ties>), Default::Value("\"barrels-to-racks\"");
    /// Stiffness of one strap (force per elongation); a polyester strap tears at an elongation of about 5 to 7 % of its
    /// length.
    stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"100 kN/m\"");
    /// Damping of one strap while it is taut (force per rate of elongation).
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N s/m\"");
    /// Slack of one strap on the stack at rest: the elongation at which the strap begins to pull.
    slack: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1.0)), Default::Value("\"0 m\"");
    /// Force in one strap when it is tightened; the stack settles under this force, so that part of the force is lost.
    pretension: f64 =
        Kind::Quantity(&[Dimension::FORCE], Range::NOT_NEGATIVE), Default::Value("\"0 N\"");
    /// Force above which a strap tears; if not given, straps never tear.
    strength: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
}

/// Reads the table of straps of a stack with `levels` levels.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<Straps, InputError> {
    let straps = Straps::read_fields(&reader)?;
    if straps.slack > 0.0 && straps.pretension > 0.0 {
        let message =
            "a strap with pretension has no slack; leave `pretension` or `slack` out".to_owned();
        return Err(reader.inconsistent("pretension", message));
    }
    if let Some(strength) = straps.strength.filter(|strength| *strength <= straps.pretension) {
        let message = format!(
            "`{}` of {} N is not below the strength of {strength} N; lower it, or raise the strength",
            reader.path_of("pretension"),
            straps.pretension
        );
        return Err(reader.inconsistent("pretension", message));
    }
    let refused = |message: String| Err(reader.inconsistent("levels", message));
    let path = reader.path_of("levels");
    check_levels(&reader, straps.levels, levels)?;
    if straps.levels == 1 && straps.ties == Ties::LevelsTogether {
        return refused(format!(
            "`{path}` is 1, but \"levels-together\" ties at least 2 levels; write 2, or choose \"barrels-to-racks\""
        ));
    }
    reader.finish();
    Ok(straps)
}

impl Straps {
    /// Returns one strap, and its slack (m) after it is tightened on the stack at rest. `distance` (m) is the vertical
    /// distance between the ends of the strap before the stack settles.
    ///
    /// The slack is the length of the strap minus the distance between its ends; it is negative under pretension.
    ///
    /// # Errors
    /// If the pretension would stretch the strap by more than its whole length.
    pub fn strap<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        distance: f64,
        scale: Similitude,
    ) -> Result<(Strap<S>, f64), String> {
        let Self { stiffness, damping, slack, pretension, strength, .. } = *self;
        let give = (slack - pretension / stiffness) * scale.length;
        if distance + give <= 0.0 {
            return Err(format!(
                "the pretension of {pretension} N stretches a strap with a stiffness of {stiffness} N/m by {:.3} m, \
                 but the strap {} is only {:.3} m long: take a stiffer strap, or less pretension",
                pretension / stiffness,
                link.name,
                distance / scale.length
            ));
        }
        let strap = Strap {
            link,
            length: distance + give,
            stiffness: stiffness * scale.stiffness(1.0, false),
            damping: damping * scale.damping(false),
            yields_at: f64::INFINITY,
            strength: strength.map_or(f64::INFINITY, |force| force * scale.force()),
        };
        Ok((strap, give))
    }

    /// Installs the straps from the ground up, and the left strap of each pair before the right one.
    ///
    /// # Errors
    /// If the pretension would stretch a strap by more than its whole length.
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        let Builder { spec, parts, bodies, scale, .. } = builder;
        let (scale, view) = (*scale, spec.view);
        let lowest = lowest(self.levels, spec.levels);
        // Every strap is vertical before the stack settles.
        let strap = |upper: BodyId, lower: BodyId, side: &str, from: f64| {
            let apart = bodies[upper].pose.position - bodies[lower].pose.position;
            let name = format!("{}-{} {side}", parts[upper].name, parts[lower].name);
            let points = [Vec2::new(from, 0.0), Vec2::new(from + apart.x, 0.0)];
            let link = Link { name, bodies: [upper, lower], points };
            let (strap, give) = self.strap(link, apart.z, scale)?;
            Ok::<_, String>(Loose { element: strap.into(), give, words: &WORDS })
        };
        // Mirroring swaps left and right, so the order of summation is reversed as well.
        let mut sides = [("left", -1.0), ("right", 1.0)];
        if spec.mirror {
            sides.reverse();
        }
        let mut all = Vec::new();
        for (body, part) in parts.iter().enumerate() {
            match part.kind {
                PartKind::Barrel => {
                    let strapped = part.level.is_some_and(|level| level >= lowest);
                    let Some(rack) = part.carrier.filter(|_| strapped) else { continue };
                    for (side, sign) in sides {
                        let (side, from) = match view {
                            View::Transverse => (side, sign * part.size),
                            View::Longitudinal if sign < 0.0 => ("front", 0.0),
                            View::Longitudinal => ("back", 0.0),
                        };
                        all.push(strap(body, rack, side, from)?);
                    }
                }
                PartKind::Rack => {
                    // The lowest of the strapped levels has no strap to the level below.
                    let tied = self.ties == Ties::LevelsTogether && part.level > Some(lowest);
                    let below = parts.iter().position(|other| {
                        other.kind == PartKind::Rack
                            && other.column == part.column
                            && other.level.map(|level| level + 1) == part.level
                    });
                    let Some(below) = below.filter(|_| tied) else { continue };
                    for (side, sign) in sides {
                        all.push(strap(body, below, side, sign * part.size)?);
                    }
                }
                PartKind::Ground | PartKind::Device | PartKind::Wine | PartKind::Body => {}
            }
        }
        builder.loose.extend(all);
        Ok(())
    }

    /// Returns `true` if the stack has straps.
    pub fn is_on(&self) -> bool {
        self.levels > 0
    }
}
