//! Imperfections that differ between variants of a stack.

use barrelstack_input::{named, section};

use super::dimension::Dimension;
use super::field::{Default, Kind, Range, names};
use super::run::Until;

named! {
    /// Source of the differences of variants.
    pub enum Imperfection {
        /// Both.
        Both = "both",
        /// Places and masses, which no cellar has twice.
        Hair = "hair",
        /// Friction and contact constants, which nobody has measured on this stack.
        Ignorance = "ignorance",
    }
}

const SHARE: Kind = Kind::Number(Range::between(0.0, 0.1));
const DISPERSION: Kind = Kind::Number(Range::between(0.0, 1.0));

section! {
    /// Differences of the variants of a stack from the scenario.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Imperfections;
    /// Differences of the variants of a stack from the scenario, which is always their middle.
    pub static IMPERFECTIONS = "imperfections";
    /// Variants of the stack that are run beside it, in each plane; 0 for the stated case alone.
    variants: u32 = Kind::Integer(0, 4096), Default::Value("64");
    /// Criterion that ends a variant where `run.until` is "rest": "verdict" 2 s after its first loss of a seat, or when it has come to rest on ground that stays below 0.02 g; "rest" when every barrel has come to its end.
    until: Until = Kind::Choice(names::<Until>), Default::Value("\"verdict\"");
    /// Seed of the random sequence that draws the variants.
    seed: u32 = Kind::Integer(0, u32::MAX as i64), Default::Value("1");
    /// Source of their differences: "hair", places and masses, which no cellar has twice; "ignorance", friction and contact constants, which nobody has measured on this stack; or both.
    kind: Imperfection = Kind::Choice(names::<Imperfection>), Default::Value("\"both\"");
    /// Hair: every rack on what is below and every barrel in its cradle lies up to this far to either side, each place as likely (assumption: forklifts set down no nearer).
    placement: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.02)), Default::Value("\"1 mm\"");
    /// Hair: standard deviation of the mass of every barrel and rack over that mass, normal up to three of them (assumption: 3 L of ullage or of wet wood in a full barrel).
    mass: f64 = SHARE, Default::Value("0.01");
    /// Ignorance: standard deviation of ln μ where racks or barrels touch each other, lognormal, one draw for each pair of materials (wood on steel goes from 0.1 to 0.6 by moisture and finish, pallets on steel racks from 0.37 to 0.45 by test; with 0.35 nine in ten lie within a factor of 1.8; the number is an assumption).
    friction: f64 = DISPERSION, Default::Value("0.35");
    /// Ignorance: the same for barrels on racks alone, where their friction was measured: the scatter of ln μ between racks and barrels.
    friction_barrel_rack: Option<f64> = DISPERSION, Default::Derived("`friction`");
    /// Ignorance: the same on the ground (floors are washed daily; steel on concrete goes from 0.4 in design to 0.65 by test; the number is an assumption).
    friction_ground: f64 = DISPERSION, Default::Value("0.2");
    /// Ignorance: standard deviation of ln k, lognormal, one draw for all seats (nobody has measured these racks: with 0.6 nineteen in twenty lie within a factor of 3.2, which reaches from what Candia, de la Llera and Almazán 2008 measured to a stave that is clamped between hoops).
    stiffness: f64 = DISPERSION, Default::Value("0.6");
    /// Ignorance: the same for all impacts (an assumption).
    impact_stiffness: f64 = DISPERSION, Default::Value("0.1");
    /// Ignorance: standard deviation of ln c, or of the logarithm of the damping ratio where a restitution is stated, lognormal, one draw for all seats with a damper (with 0.3 a restitution of 0.8 lies between 0.69 and 0.88 in nineteen of twenty; the number is an assumption).
    damping: f64 = DISPERSION, Default::Value("0.3");
    /// True if half of the variants are shaken with the opposite sign, as stacks that face the opposite side are.
    sign: bool = Kind::Flag, Default::Value("false");
}

impl Imperfections {
    /// Returns the standard deviation of ln μ of barrels on racks.
    pub fn friction_of_barrels(&self) -> f64 {
        self.friction_barrel_rack.unwrap_or(self.friction)
    }
}
