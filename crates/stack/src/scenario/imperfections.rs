//! Imperfections: random differences between the variants of a stack.

use barrelstack_input::{named, section};

use super::dimension::Dimension;
use super::field::{Default, Kind, Range, names};
use super::run::Until;

named! {
    /// Source of the differences between variants.
    pub enum Imperfection {
        /// Both sources.
        Both = "both",
        /// Positions and masses, which are never exactly the same in two stacks.
        Hair = "hair",
        /// Friction and contact constants, which have not been measured on this stack.
        Ignorance = "ignorance",
    }
}

const SHARE: Kind = Kind::Number(Range::between(0.0, 0.1));
const DISPERSION: Kind = Kind::Number(Range::between(0.0, 1.0));

section! {
    /// Random differences between the scenario and the variants of its stack.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Imperfections;
    /// Random differences between the scenario and the variants of its stack; the differences are always centered on
    /// the scenario.
    pub static IMPERFECTIONS = "imperfections";
    /// Number of variants of the stack that are run in each plane, in addition to the stack as stated; 0 to run only
    /// the stack as stated.
    variants: u32 = Kind::Integer(0, 4096), Default::Value("64");
    /// Criterion that ends a variant if `run.until` is "rest": "verdict" ends it 2 s after the first loss of a seat, or
    /// at rest on ground that stays below 0.02 g; "rest" ends it when all bodies have come to rest.
    until: Until = Kind::Choice(names::<Until>), Default::Value("\"verdict\"");
    /// Seed of the random sequence that draws the variants.
    seed: u32 = Kind::Integer(0, u32::MAX as i64), Default::Value("1");
    /// Source of the differences: "hair" for positions and masses, which are never exactly the same in two stacks;
    /// "ignorance" for friction and contact constants, which have not been measured on this stack; or "both".
    kind: Imperfection = Kind::Choice(names::<Imperfection>), Default::Value("\"both\"");
    /// Hair: largest offset to either side of every rack on its supports and of every barrel in its cradle, uniformly
    /// distributed (assumption: forklifts do not place racks and barrels more precisely).
    placement: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.02)), Default::Value("\"1 mm\"");
    /// Hair: standard deviation of the mass of every barrel and rack as a fraction of that mass, normally distributed
    /// and cut off at three standard deviations (assumption: 3 L of missing wine, or of water in the wood, in a full
    /// barrel).
    mass: f64 = SHARE, Default::Value("0.01");
    /// Ignorance: standard deviation of ln μ where racks or barrels touch each other; lognormal, with one draw for each pair of materials. Wood on steel ranges from 0.1 to 0.6 with moisture and finish, pallets on steel racks from 0.37 to 0.45 in tests. A standard deviation of 0.35, which is an assumption, puts nine in ten variants within a factor of 1.8.
    friction: f64 = DISPERSION, Default::Value("0.35");
    /// Ignorance: standard deviation of ln μ of barrels on racks only, to be stated if this friction was measured; the
    /// value is then the scatter of ln μ between racks and barrels.
    friction_barrel_rack: Option<f64> = DISPERSION, Default::Derived("`friction`");
    /// Ignorance: standard deviation of ln μ on the ground (floors are washed daily; steel on concrete ranges from 0.4 in design to 0.65 in tests; the number is an assumption).
    friction_ground: f64 = DISPERSION, Default::Value("0.2");
    /// Ignorance: standard deviation of ln k, lognormal, one draw for all seats (nobody has measured these racks; with
    /// 0.6, nineteen in twenty variants lie within a factor of 3.2, which reaches from the value measured by Candia, de
    /// la Llera and Almazán 2008 to the value of a stave clamped between hoops).
    stiffness: f64 = DISPERSION, Default::Value("0.6");
    /// Ignorance: standard deviation of ln k of all impacts (an assumption).
    impact_stiffness: f64 = DISPERSION, Default::Value("0.1");
    /// Ignorance: standard deviation of ln c, or of the logarithm of the damping ratio if a restitution is stated,
    /// lognormal, one draw for all seats with a damper (with 0.3, a stated restitution of 0.8 becomes a restitution
    /// between 0.69 and 0.88 in nineteen of twenty variants; the number is an assumption).
    damping: f64 = DISPERSION, Default::Value("0.3");
    /// True to shake half of the variants with the opposite sign, as for stacks that face the other way.
    sign: bool = Kind::Flag, Default::Value("false");
}

impl Imperfections {
    /// Returns the standard deviation of ln μ of barrels on racks.
    pub fn friction_of_barrels(&self) -> f64 {
        self.friction_barrel_rack.unwrap_or(self.friction)
    }
}
