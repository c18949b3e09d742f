//! Lids over the barrels of the top levels, such as a cap rack or bars above the barrels.
//!
//! A lid is fixed to the rack that carries the barrel, touches the barrel without friction, and has no mass. A barrel
//! has to rise before it can roll out of its cradle, and the lid prevents this rise. Once the barrel has moved out from
//! under the lid, the lid no longer holds it.

use barrelstack_dynamics::{Guide, Link, Space, Vec2};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, section};

use super::{Cost, Each, LEVELS, Loose, Setting, Words, check_levels, lowest};
use crate::assemble::{Builder, Outline, PartKind, Similitude};

pub(super) static WORDS: Words = Words {
    one: "lid",
    many: "lids",
    force: "force",
    breaks: "gives way",
    break_all: "give way",
    broken: "off",
    candidates: &[
        Setting { name: "a cap rack on the top level", overrides: &["stack.lid.levels=1"] },
        Setting { name: "lids on the top three levels", overrides: &["stack.lid.levels=3"] },
    ],
    degraded: &[Setting { name: "lids that sit loose", overrides: &["stack.lid.gap=\"4 cm\""] }],
    idle: &["stack.lid.levels=3", "stack.lid.gap=\"1 m\""],
    cost: Cost {
        dollars: [100.0, 250.0],
        each: Each::Level,
        source: "an upside-down rack with clamps: an assumption",
    },
};

section! {
    /// Lids over barrels.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Lids;
    /// Lids over the barrels of the top levels, such as a cap rack clamped to the rack below; a lid limits the rise of a barrel until the barrel has moved sideways by more than 0.6 of its radius.
    pub static SECTION = "lid";
    /// Number of levels with lids, counted from the top; 0 for none.
    levels: u32 = LEVELS, Default::Value("0");
    /// Rise of a barrel from its position at rest before it touches its lid. The default is an assumption.
    gap: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1.0)), Default::Value("\"1 cm\"");
    /// Stiffness of one lid (force per displacement). The default is an assumption.
    stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"500 kN/m\"");
    /// Damping of one lid (force per speed), which acts on approach only. The default is an assumption.
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"2 kN s/m\"");
    /// Force above which a lid breaks; if not given, lids never break.
    strength: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
}

/// Reach of a lid to either side of the center of its barrel, as a fraction of the radius of the barrel: an assumption.
const HALF_WIDTH: f64 = 0.6;

/// Reads the table of lids.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<Lids, InputError> {
    let lids = Lids::read_fields(&reader)?;
    check_levels(&reader, lids.levels, levels)?;
    reader.finish();
    Ok(lids)
}

impl Lids {
    /// Returns `true` if the stack has lids.
    pub fn is_on(&self) -> bool {
        self.levels > 0
    }

    /// Returns the lid of a barrel with the given radius (m), as a guide between its rack and the barrel.
    ///
    /// The first body of `link` is the rack, and the second is the barrel; `up` is the upward direction in the frame
    /// of the rack.
    pub fn guide<S: Space<Real = f64>>(
        &self,
        link: Link<S>,
        up: S::Vector,
        radius: f64,
        scale: Similitude,
    ) -> Guide<S> {
        Guide {
            gap: self.gap * scale.length,
            stop_stiffness: self.stiffness * scale.stiffness(1.0, false),
            stop_damping: self.damping * scale.damping(false),
            strength: self.strength.map_or(f64::INFINITY, |force| force * scale.force()),
            reach: HALF_WIDTH * radius,
            ..Guide::spring(link, up, 0.0, 0.0)
        }
    }

    /// Returns the half-width (m) of a lid in drawings, and the height (m) of the lid above the center of its barrel.
    ///
    /// `radius` (m) is the radius of the barrel in the model, at the length scale of `scale`.
    pub fn drawn(&self, radius: f64, scale: Similitude) -> [f64; 2] {
        [HALF_WIDTH * radius, radius + self.gap * scale.length]
    }

    /// Installs a lid over every barrel of the levels that have lids.
    #[expect(clippy::unnecessary_wraps, reason = "common device signature")]
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        let (spec, scale) = (builder.spec, builder.scale);
        let lowest = lowest(self.levels, spec.levels);
        for barrel in 0..builder.parts.len() {
            let part = &builder.parts[barrel];
            let Some(rack) = part.carrier.filter(|_| part.kind == PartKind::Barrel) else {
                continue;
            };
            if part.level < Some(lowest) {
                continue;
            }
            let (name, size) = (part.name.clone(), part.size);
            let link = Link { name, bodies: [rack, barrel], points: [Vec2::default(); 2] };
            let guide = self.guide(link, Vec2::new(0.0, 1.0), size, scale);
            builder.loose.push(Loose { element: guide.into(), give: 0.0, words: &WORDS });
            let [half_width, rise] = self.drawn(size, scale);
            let top = builder.bodies[barrel].pose.position - builder.bodies[rack].pose.position
                + Vec2::new(0.0, rise);
            let half = Vec2::new(half_width, 0.0);
            let points = vec![top - half, top + half];
            builder.parts[rack].outlines.push(Outline { points, closed: false });
        }
        Ok(())
    }
}
