//! Ties of racks to structures beside or above them: cables and rods that only pull. They may have slack, and may yield
//! and tear.
//!
//! Walls and ceilings are assumed to move with the ground; real walls and ceilings move more.

use barrelstack_dynamics::{Link, Space, Strap, Vec2};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range, names};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, named, section};

use super::{Cost, Each, LEVELS, Loose, Setting, Words, check_levels, lowest};
use crate::assemble::{Assembly, Builder, Outline, PartKind, Similitude};

pub(super) static WORDS: Words = Words {
    one: "tie",
    many: "ties",
    force: "tension",
    breaks: "tears",
    break_all: "tear",
    broken: "torn",
    candidates: &[
        Setting {
            name: "the top rack tied to walls on both sides",
            overrides: &["stack.tie.levels=1"],
        },
        Setting {
            name: "the top rack tied to the ceiling",
            overrides: &[
                "stack.tie.levels=1",
                "stack.tie.to=\"ceiling\"",
                "stack.tie.distance=\"2 m\"",
            ],
        },
    ],
    degraded: &[Setting { name: "slack ties", overrides: &["stack.tie.slack=\"5 cm\""] }],
    idle: &["stack.tie.levels=2", "stack.tie.slack=\"9 m\""],
    cost: Cost {
        dollars: [150.0, 600.0],
        each: Each::Level,
        source: "two cables with anchors in concrete, set by two people: an assumption",
    },
};

named! {
    /// Structure to which the ties anchor a rack.
    pub enum Anchor {
        /// A wall at either end of the rack.
        Wall = "wall",
        /// The ceiling above both ends of the rack.
        Ceiling = "ceiling",
        /// The neighboring racks on the same level.
        Neighbors = "neighbors",
    }
}

named! {
    /// Sides of a stack on which its racks are tied.
    pub enum Side {
        /// The left side.
        Left = "left",
        /// The right side.
        Right = "right",
        /// Both sides.
        Both = "both",
    }
}

section! {
    /// Ties of racks.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct AnchorTies;
    /// Cables or rods from the ends of racks to a wall, to the ceiling or to the neighboring racks: they pull, never
    /// push.
    pub static SECTION = "tie";
    /// Number of levels with ties, counted from the top; 0 for none.
    levels: u32 = LEVELS, Default::Value("0");
    /// Structure to which the ties are anchored; walls and ceilings move with the ground.
    to: Anchor = Kind::Choice(names::<Anchor>), Default::Value("\"wall\"");
    /// Side of the stack on which its racks are tied to a wall or a ceiling. If the stack is mirrored, the ties are on
    /// the other side.
    side: Side = Kind::Choice(names::<Side>), Default::Value("\"both\"");
    /// Horizontal distance from the end of a rack to the wall, or vertical distance to the ceiling; the default is the
    /// clearance of 18 inches that one winery keeps from its walls (Press Democrat 2014).
    distance: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.01, 20.0)), Default::Value("\"45 cm\"");
    /// Stiffness of one tie (force per elongation). The default is an assumption: an 8 mm steel cable has a stiffness
    /// of about 2 MN divided by the length of the cable, and anchors make a tie softer.
    stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"500 kN/m\"");
    /// Damping of one tie while it is taut (force per rate of elongation).
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N s/m\"");
    /// Slack of one tie on the stack at rest: the elongation at which the tie begins to pull.
    slack: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 10.0)), Default::Value("\"1 cm\"");
    /// Force at which a tie yields and becomes permanently longer; if not given, ties never yield.
    yields_at: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
    /// Force above which a tie tears; if not given, ties never tear.
    strength: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
}

/// Reads the table of ties.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<AnchorTies, InputError> {
    let ties = AnchorTies::read_fields(&reader)?;
    check_levels(&reader, ties.levels, levels)?;
    if let (Some(yields_at), Some(strength)) = (ties.yields_at, ties.strength)
        && strength <= yields_at
        && ties.damping == 0.0
    {
        let message = format!(
            "`{}` of {yields_at} N is not below the strength of {strength} N, so no tie would yield; leave \
             `yields_at` out",
            reader.path_of("yields_at")
        );
        return Err(reader.inconsistent("yields_at", message));
    }
    reader.finish();
    Ok(ties)
}

impl AnchorTies {
    /// Returns `true` if the stack has ties.
    pub fn is_on(&self) -> bool {
        self.levels > 0
    }

    /// Returns one tie before slack is added.
    ///
    /// `share` is the fraction of the tie that the model contains: 1, or less in a planar model that contains only a
    /// slice of each rack.
    pub fn tie<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        share: f64,
        scale: Similitude,
    ) -> Strap<S> {
        let force =
            |given: Option<f64>| given.map_or(f64::INFINITY, |it| it * scale.force() * share);
        Strap {
            link,
            length: self.distance * scale.length,
            stiffness: self.stiffness * scale.stiffness(1.0, false) * share,
            damping: self.damping * scale.damping(false) * share,
            yields_at: force(self.yields_at),
            strength: force(self.strength),
        }
    }

    /// Installs the ties, from the ground up.
    ///
    /// # Errors
    /// If racks are to be tied to their neighbors, but each level has only one rack.
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        let (spec, scale) = (builder.spec, builder.scale);
        if !self.is_on() {
            return Ok(());
        }
        let racks = spec.racks_per_level();
        if self.to == Anchor::Neighbors && racks < 2 {
            return Err(format!(
                "stack.tie.to = \"neighbors\" ties the racks of a level to each other, but {}, each level of this \
                 stack has only one rack: set stack.columns higher, or stack.tie.to = \"wall\"",
                spec.view.words()
            ));
        }
        let lowest = lowest(self.levels, spec.levels);
        let far = self.distance * scale.length;
        // Mirroring swaps left and right, so the order of summation is reversed as well.
        let mut sides = [("left", -1.0, Side::Left), ("right", 1.0, Side::Right)];
        if spec.mirror {
            sides = [("left", 1.0, Side::Left), ("right", -1.0, Side::Right)];
        }
        for rack in 0..builder.parts.len() {
            let part = &builder.parts[rack];
            if part.kind != PartKind::Rack || part.level < Some(lowest) {
                continue;
            }
            let (level, column, size) = (part.level, part.column, part.size);
            let place = builder.bodies[rack].pose.position;
            for (side, sign, on) in sides {
                let beside = match on {
                    Side::Left => column.and_then(|column| column.checked_sub(1)),
                    Side::Right | Side::Both => column.map(|column| column + 1),
                };
                let neighbor = builder.parts.iter().position(|other| {
                    other.kind == PartKind::Rack && other.level == level && other.column == beside
                });
                let end = Vec2::new(sign * size, 0.0);
                let (other, point, name) = match (self.to, neighbor) {
                    // Each pair of neighbors is visited once, from its left.
                    (Anchor::Neighbors, Some(next)) if on == Side::Right => {
                        (next, Vec2::new(-end.x, 0.0), builder.parts[next].name.clone())
                    }
                    // There is no wall between racks.
                    (Anchor::Neighbors, _) | (Anchor::Wall, Some(_)) => continue,
                    (Anchor::Wall, None) => {
                        let at = place + end + Vec2::new(sign * far, 0.0);
                        (Assembly::GROUND, at, format!("wall {side}"))
                    }
                    (Anchor::Ceiling, _) => {
                        let at = place + end + Vec2::new(0.0, far);
                        (Assembly::GROUND, at, format!("ceiling {side}"))
                    }
                };
                if other == Assembly::GROUND && ![on, Side::Both].contains(&self.side) {
                    continue;
                }
                if other == Assembly::GROUND {
                    let (along, length) = match self.to {
                        Anchor::Ceiling => (Vec2::new(0.15, 0.0), scale.length),
                        Anchor::Wall | Anchor::Neighbors => (Vec2::new(0.0, 0.3), scale.length),
                    };
                    let points = vec![point - along * length, point + along * length];
                    builder.parts[Assembly::GROUND]
                        .outlines
                        .push(Outline { points, closed: false });
                }
                let link = Link {
                    name: format!("{}-{name}", builder.parts[rack].name),
                    bodies: [rack, other],
                    points: [end, point],
                };
                let tie = self.tie(link, 1.0 / builder.side_by_side(), scale);
                let give = self.slack * scale.length;
                builder.loose.push(Loose { element: tie.into(), give, words: &WORDS });
            }
        }
        Ok(())
    }
}
