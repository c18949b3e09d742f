//! Unknowns: constants that nobody has measured on the stack, and that the whole stack shares.

use barrelstack_input::section;

use super::dimension::Dimension;
use super::field::{Default, Kind, Range};

/// A standard deviation of a logarithm.
const DISPERSION: Kind = Kind::Number(Range::between(0.0, 1.0));

section! {
    /// Uncertainty of contact constants; every variant draws each constant once for the whole stack.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Unknowns;
    /// Uncertainty of constants that nobody has measured on this stack. Every variant draws a factor of each constant,
    /// lognormal around the stated value and cut off at three standard deviations, and the whole stack shares the
    /// factor. Factors are independent of each other, except those of friction if a correlation is stated. 0 keeps a
    /// constant as stated.
    pub static UNKNOWNS = "unknowns";
    /// True to draw the constants; false to keep all of them as stated in all variants.
    drawn: bool = Kind::Flag, Default::Value("true");
    /// Standard deviation of ln μ, static and kinetic alike, where racks or barrels touch each other; one draw for
    /// barrels on racks, one for racks on racks and one for barrels on barrels, each also for bodies that have fallen.
    /// Shear tests give μ = 0.10 to 0.30 for laminated veneer on smooth steel and up to 0.80 on rough steel (Dorn et
    /// al. 2021), 0.28 to 0.55 for chestnut on chestnut (Villar-García et al. 2020), 0.37 to 0.45 for pallets on steel
    /// racks. A standard deviation of 0.35, which is an assumption, puts nine in ten variants within a factor of 1.8.
    friction: f64 = DISPERSION, Default::Value("0.35");
    /// Standard deviation of ln μ of barrels on racks only, to be stated if this friction was measured; the value is
    /// then the scatter of ln μ between racks and barrels.
    friction_barrel_rack: Option<f64> = DISPERSION, Default::Derived("`friction`");
    /// Standard deviation of ln μ on the ground; one draw for racks and one for barrels (floors are washed daily; steel
    /// on concrete ranges from 0.4 in design to 0.65 in tests of Rabbat and Russell 1985; the default is an
    /// assumption).
    friction_ground: f64 = DISPERSION, Default::Value("0.2");
    /// Correlation of ln μ between any two pairs of materials (a wet cellar is wet everywhere, but steel, wood and
    /// floors differ in roughness; nobody has measured it, and 0 is an assumption).
    friction_correlation: f64 = Kind::Number(Range::between(0.0, 0.95)), Default::Value("0");
    /// Standard deviation of ln k, one draw for all seats (nobody has measured these racks; with 0.6, nineteen in
    /// twenty variants lie within a factor of 3.2, which reaches from the value measured by Candia, de la Llera and
    /// Almazán 2008 to the value of a stave clamped between hoops).
    stiffness: f64 = DISPERSION, Default::Value("0.6");
    /// Standard deviation of ln k of impacts, one draw for all impacts (an assumption).
    impact_stiffness: f64 = DISPERSION, Default::Value("0.1");
    /// Standard deviation of ln c, or of the logarithm of the damping ratio if a restitution is stated, one draw for
    /// all seats with a damper (with 0.3, a stated restitution of 0.8 becomes a restitution between 0.69 and 0.88 in
    /// nineteen of twenty variants; the default is an assumption).
    damping: f64 = DISPERSION, Default::Value("0.3");
    /// Largest excess of static over kinetic friction of barrels on racks, as a fraction of the kinetic coefficient and
    /// in addition to the stated excess; uniformly distributed from 0, one draw for all seats. Tests of chestnut on
    /// chestnut gave an excess of 0.29 to 0.41 (Villar-García et al. 2020). Not drawn by default: in planar models, an
    /// excess of 0.4 changes shares of collapses by less than their sampling error; in three dimensions, 39 of 64
    /// variants of the demo on four levels collapse instead of 53, a result of a single seed.
    static_friction: f64 = DISPERSION, Default::Value("0");
    /// Standard deviation of the logarithm of the ratio of tangential to normal stiffness, lognormal, one draw for all
    /// seats. Not drawn by default, because a factor of 2 changes shares of collapses by less than their sampling error.
    stick: f64 = DISPERSION, Default::Value("0");
    /// Largest deviation of `stack.rack.rail_half_spacing` to either side, uniformly distributed, one draw for all
    /// racks, which are made alike. Not drawn by default, because 1 cm changes shares of collapses by less than their
    /// sampling error.
    rails: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.02)), Default::Value("\"0 mm\"");
}

impl Unknowns {
    /// Returns the standard deviation of ln μ of barrels on racks.
    pub fn friction_of_barrels(&self) -> f64 {
        self.friction_barrel_rack.unwrap_or(self.friction)
    }
}
