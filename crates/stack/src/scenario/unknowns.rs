//! Unknowns: constants that have not been measured on the stack. Each constant has one value for the whole stack.

use barrelstack_input::section;

use super::dimension::Dimension;
use super::field::{Default, Kind, Range};

/// Kind of a parameter from 0 to 1, such as the standard deviation of a logarithm.
const DISPERSION: Kind = Kind::Number(Range::between(0.0, 1.0));

section! {
    /// Uncertainty of contact constants; every variant draws each constant once for the whole stack.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Unknowns;
    /// Uncertainty of constants that nobody has measured on this stack. In every variant, each constant is multiplied
    /// by a factor that the whole stack shares. Factors are lognormal with median 1, cut off at three standard
    /// deviations. They are independent of each other, except those of friction if a correlation is stated. A value of
    /// 0 keeps a constant as stated.
    pub static UNKNOWNS = "unknowns";
    /// True to draw the constants at random; false to keep them as stated in all variants.
    drawn: bool = Kind::Flag, Default::Value("true");
    /// Standard deviation of ln μ for contacts between racks or barrels; it is the same for static and kinetic
    /// friction. One value is drawn for barrels on racks, one for racks on racks, and one for barrels on barrels; these
    /// values also apply to bodies that have fallen. Shear tests give μ = 0.10 to 0.30 for laminated veneer on smooth
    /// steel and up to 0.80 on rough steel (Dorn et al. 2021), 0.28 to 0.55 for chestnut on chestnut (Villar-García et
    /// al. 2020), 0.37 to 0.45 for pallets on steel racks. The default is an assumption; with 0.35, nine in ten
    /// variants have a μ within a factor of 1.8 of the stated value.
    friction: f64 = DISPERSION, Default::Value("0.35");
    /// Standard deviation of ln μ for barrels on racks only; to be stated if this friction was measured. After a
    /// measurement, only the scatter of ln μ between pairs of a barrel and a rack remains.
    friction_barrel_rack: Option<f64> = DISPERSION, Default::Derived("`friction`");
    /// Standard deviation of ln μ on the ground; one value is drawn for racks and one for barrels. The default is an
    /// assumption: floors are washed daily, and μ of steel on concrete ranges from 0.4 in design to 0.65 in the tests
    /// of Rabbat and Russell (1985).
    friction_ground: f64 = DISPERSION, Default::Value("0.2");
    /// Correlation of ln μ between any two pairs of materials. The default is an assumption, since nobody has measured
    /// this correlation: a wet cellar is wet everywhere, but steel, wood and floors differ in roughness.
    friction_correlation: f64 = Kind::Number(Range::between(0.0, 0.95)), Default::Value("0");
    /// Standard deviation of ln k, where k is the stiffness of seats; one value is drawn for all seats. The default is
    /// an assumption, since nobody has measured these racks. With 0.6, nineteen in twenty variants have a k within a
    /// factor of 3.2 of the stated value. This range extends from the value measured by Candia, de la Llera and Almazán
    /// (2008) to the value for a stave clamped between hoops.
    stiffness: f64 = DISPERSION, Default::Value("0.6");
    /// Standard deviation of ln k of impacts; one value is drawn for all impacts. The default is an assumption.
    impact_stiffness: f64 = DISPERSION, Default::Value("0.1");
    /// Standard deviation of ln c, or of the logarithm of the damping ratio if a restitution is stated; one value is
    /// drawn for all seats with a damper. The default is an assumption: with 0.3 and a stated restitution of 0.8, the
    /// restitution is between 0.69 and 0.88 in nineteen of twenty variants.
    damping: f64 = DISPERSION, Default::Value("0.3");
    /// Largest excess of the static over the kinetic friction coefficient of barrels on racks, as a fraction of the
    /// kinetic coefficient. An additional excess, uniformly distributed between 0 and this value, is drawn once for all
    /// seats and added to the stated excess. Tests of chestnut on chestnut gave an excess of 0.29 to 0.41
    /// (Villar-García et al. 2020). Not drawn by default: in planar models, an excess of 0.4 changes the shares of
    /// collapses by less than their sampling error. In three dimensions, it reduces the number of collapses of the demo with four
    /// levels from 53 to 39 of 64 variants, with a single seed.
    static_friction: f64 = DISPERSION, Default::Value("0");
    /// Standard deviation of the logarithm of the ratio of tangential to normal stiffness; one value is drawn for all
    /// seats. Not drawn by default, because a factor of 2 in this ratio changes the shares of collapses by less than
    /// their sampling error.
    stick: f64 = DISPERSION, Default::Value("0");
    /// Largest deviation of `stack.rack.rail_half_spacing` to either side. It is uniformly distributed and drawn once
    /// for all racks, since racks are made alike. Not drawn by default, because a deviation of 1 cm changes the shares
    /// of collapses by less than their sampling error.
    rails: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.02)), Default::Value("\"0 mm\"");
}

impl Unknowns {
    /// Returns the standard deviation of ln μ of barrels on racks.
    pub fn friction_of_barrels(&self) -> f64 {
        self.friction_barrel_rack.unwrap_or(self.friction)
    }
}
