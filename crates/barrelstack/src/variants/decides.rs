//! Range of the share of collapses as the uncertain constants of the seats vary, and the constant
//! that changes this share most.

use barrelstack_fragility::{Conditional, DrawnRun, Influence, conditional, normal_quantile};
use barrelstack_motion::Random;
use barrelstack_report::described;

use super::draw::{self, Shared};
use super::spread::{LEVEL, verdict};
use super::{Plane, Spread};
use crate::ensemble::CaseResult;
use crate::scenario::{Basis, Damping, Friction, Interface, NormalLaw, StackInterfaces, Unknowns};

/// Smallest change of the share of collapses, over the range of a constant, for which the constant can be decisive.
const DECISIVE: f64 = 0.2;

/// Fractiles of a constant at which the share of collapses is given.
const FRACTILES: [f64; 9] = [0.05, 0.1625, 0.275, 0.3875, 0.5, 0.6125, 0.725, 0.8375, 0.95];

described! {
    /// An uncertain constant of the seats, and its effect on the share of variants that collapse.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Unknown {
        /// Name of the constant.
        pub name: &'static str,
        /// Field of the scenario that states the median of the constant.
        pub field: &'static str,
        /// Unit of the constant; "1" for a pure number.
        pub unit: &'static str,
        /// Scatter of the constant: the standard deviation of its logarithm. For a restitution, it is the standard
        /// deviation of the logarithm of the damping ratio; for static friction, the largest excess over the stated
        /// value, as a fraction.
        pub dispersion: f64 as "1",
        /// Share of variants that collapse as a function of the constant, from the 5 % to the 95 % fractile of the
        /// constant; the mean over all other constants.
        pub shares: Vec<ShareAt>,
        /// 95 % interval of the difference between the largest and the smallest value of `shares`.
        pub difference: [f64; 2] as "1",
        /// Total-effect index: the part of the variance of the share that remains if all other constants are known,
        /// as a fraction of the whole variance.
        pub total: f64 as "1",
        /// Width of the 95 % range of the share of collapses if this constant were known exactly and all other
        /// constants remained uncertain; the mean over the values of this constant.
        pub width_if_measured: f64 as "1",
    }

    /// Share of variants that collapse at a value of a constant.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ShareAt {
        /// Value of the constant.
        pub value: f64 as "`unit`",
        /// Share of variants that collapse.
        pub share: f64 as "1",
        /// 95 % interval of the share.
        pub interval: [f64; 2] as "1",
    }
}

impl Unknown {
    /// Returns the constant at its 5 % fractile, median and 95 % fractile, each with the share of collapses at this
    /// value.
    pub fn low_median_high(&self) -> Option<[&ShareAt; 3]> {
        Some([self.shares.first()?, self.shares.get(FRACTILES.len() / 2)?, self.shares.last()?])
    }

    /// Returns the difference between the largest and the smallest of `shares`.
    pub fn effect(&self) -> f64 {
        let shares = || self.shares.iter().map(|at| at.share);
        shares().fold(0.0, f64::max) - shares().fold(1.0, f64::min)
    }

    /// Returns `true` if the share changes by at least a fifth over the range of the constant, and the 95 % interval of
    /// this change excludes zero.
    pub fn is_decisive(&self) -> bool {
        self.effect() >= DECISIVE && self.difference[0] > 0.0
    }

    /// Returns the unit in which pages state the constant (empty for a pure number), and the factor
    /// that converts a value from the SI unit to this unit.
    pub fn shown_unit(&self) -> (String, f64) {
        match self.unit {
            "1" => (String::new(), 1.0),
            unit if self.field.ends_with(".damping") => (format!("k{unit}"), 1e-3),
            unit => (format!("M{unit}"), 1e-6),
        }
    }

    /// Formats a value of the constant (SI) with its symbol or unit, such as "μ = 0.22" or
    /// "3.1 MN/m".
    pub fn words(&self, value: f64) -> String {
        let (unit, factor) = self.shown_unit();
        match self.field.rsplit('.').next() {
            Some("restitution") => format!("e = {value:.2}"),
            Some("damping" | "stiffness") => {
                format!("{} {unit}", barrelstack_report::significant(factor * value, 2))
            }
            _ => format!("μ = {value:.2}"),
        }
    }

    /// Describes a simple test that measures the constant; `None` if there is none.
    pub fn test(&self) -> Option<&'static str> {
        match self.field {
            FRICTION_BARREL_RACK => Some(
                "tilt a rack with an empty barrel on it until the barrel slips, and read the angle",
            ),
            FRICTION_RACK_GROUND => {
                Some("pull an empty rack over the floor, and read the force on a luggage scale")
            }
            STATIC_BARREL_RACK => Some(
                "pull an empty barrel along a rack, and read the force at which it starts to slide and the force that \
                 keeps it sliding",
            ),
            STIFFNESS => Some("set a full barrel down on a rack, and read how far it sinks"),
            _ => None,
        }
    }
}

const FRICTION_RACK_GROUND: &str = "interface.rack-ground.friction.coefficient";
const FRICTION_BARREL_RACK: &str = "interface.barrel-rack.friction.coefficient";
const STATIC_BARREL_RACK: &str = "interface.barrel-rack.friction.static_coefficient";
const FRICTION_RACK_RACK: &str = "interface.rack-rack.friction.coefficient";
const STIFFNESS: &str = "interface.barrel-rack.stiffness";
const RESTITUTION: &str = "interface.barrel-rack.restitution";
const DAMPING: &str = "interface.barrel-rack.damping";

/// A constant whose value is drawn at random for each variant.
struct Drawn {
    axis: Shared,
    name: &'static str,
    field: &'static str,
    unit: &'static str,
    dispersion: f64,
    /// Returns the factor by which the constant is multiplied, given its dispersion and a standard normal deviate.
    factor: fn(f64, f64) -> f64,
    /// Multiplies the constant in a contact law by a factor.
    change: fn(&mut Interface, f64),
    /// Returns the value of the constant in a contact law; `None` if the law has no such constant.
    value: fn(&Interface) -> Option<f64>,
    law: Interface,
}

impl Drawn {
    fn constant(&self) -> Constant<'_> {
        let Self { name, field, unit, dispersion, .. } = *self;
        Constant { name, field, unit, dispersion, value: Box::new(|deviate| self.at(deviate)) }
    }

    /// Returns the value of the constant at a standard normal deviate; `None` if the contact law has no such constant.
    fn at(&self, deviate: f64) -> Option<f64> {
        let mut law = self.law;
        (self.change)(&mut law, (self.factor)(self.dispersion, deviate));
        (self.value)(&law)
    }
}

/// Returns the constants that may decide whether a seat is lost: friction, stiffness and damping of seats.
///
/// The variation of all other drawn quantities counts as sampling error. These quantities are the constants of impacts
/// and of fallen bodies, the tangential stiffness, the positions of rails, racks and barrels, and the masses of racks
/// and barrels.
fn drawn(laws: &StackInterfaces, spread: &Unknowns, posts: bool) -> Vec<Drawn> {
    let seat = laws.barrel_rack;
    let lognormal = |dispersion: f64, deviate: f64| libm::exp(dispersion * deviate);
    let friction = |axis, name, field, dispersion, law| Drawn {
        axis,
        name,
        field,
        unit: "1",
        dispersion,
        factor: lognormal,
        change: Interface::roughen,
        value: coefficient,
        law,
    };
    let mut all = vec![
        Drawn {
            axis: Shared::SeatStiffness,
            name: "stiffness of seats",
            field: STIFFNESS,
            unit: unit(&seat),
            dispersion: spread.stiffness,
            factor: lognormal,
            change: Interface::stiffen,
            value: |law| Some(stiffness(law)),
            law: seat,
        },
        friction(
            Shared::FrictionBarrelRack,
            "friction of barrels on racks",
            FRICTION_BARREL_RACK,
            spread.friction_of_barrels(),
            seat,
        ),
        friction(
            Shared::FrictionGround,
            "friction of racks on the floor",
            FRICTION_RACK_GROUND,
            spread.friction_ground,
            laws.rack_ground,
        ),
        Drawn {
            axis: Shared::SeatDamping,
            name: "damping of seats",
            field: if seat.states_restitution() { RESTITUTION } else { DAMPING },
            unit: match (seat.states_restitution(), seat.basis) {
                (true, _) => "1",
                (false, Basis::Length) => "N·s/m²",
                (false, Basis::Node | Basis::Seat) => "N·s/m",
            },
            dispersion: spread.damping,
            factor: lognormal,
            change: Interface::damp,
            value: damping,
            law: seat,
        },
        Drawn {
            dispersion: spread.static_friction,
            factor: draw::excess,
            change: Interface::hold,
            value: static_coefficient,
            ..friction(
                Shared::StaticFriction,
                "static friction of barrels on racks",
                STATIC_BARREL_RACK,
                0.0,
                seat,
            )
        },
    ];
    if posts {
        all.push(friction(
            Shared::FrictionRackRack,
            "friction of racks on racks",
            FRICTION_RACK_RACK,
            spread.friction,
            laws.rack_rack,
        ));
    }
    all.retain(|one| one.dispersion > 0.0 && one.at(0.0).is_some());
    all
}

fn coefficient(law: &Interface) -> Option<f64> {
    match law.friction {
        Friction::Coulomb { coefficient, .. } | Friction::Regularized { coefficient, .. } => {
            Some(coefficient)
        }
        Friction::None => None,
    }
}

fn static_coefficient(law: &Interface) -> Option<f64> {
    match law.friction {
        Friction::Coulomb { static_coefficient, .. } => Some(static_coefficient),
        Friction::Regularized { .. } | Friction::None => None,
    }
}

fn stiffness(law: &Interface) -> f64 {
    match law.normal {
        NormalLaw::SpeedGap { stiffness, .. }
        | NormalLaw::KelvinVoigt { stiffness, .. }
        | NormalLaw::HuntCrossley { stiffness, .. }
        | NormalLaw::Rebound { stiffness, .. }
        | NormalLaw::Hertz { stiffness } => stiffness,
    }
}

fn damping(law: &Interface) -> Option<f64> {
    match law.normal {
        NormalLaw::SpeedGap { damping, .. } | NormalLaw::KelvinVoigt { damping, .. } => {
            Some(match damping {
                Damping::Coefficient(value) => value,
                Damping::Restitution { restitution, .. } => restitution,
            })
        }
        NormalLaw::HuntCrossley { .. } | NormalLaw::Rebound { .. } | NormalLaw::Hertz { .. } => {
            None
        }
    }
}

fn unit(law: &Interface) -> &'static str {
    let linear = matches!(law.normal, NormalLaw::SpeedGap { .. } | NormalLaw::KelvinVoigt { .. });
    match (law.basis, linear) {
        (Basis::Length, true) => "N/m²",
        (_, true) => "N/m",
        (Basis::Length, false) => "N/m^2.5",
        (_, false) => "N/m^1.5",
    }
}

/// An uncertain constant that is a predictor in the regression of the share of collapses.
pub struct Constant<'a> {
    /// Name of the constant.
    pub name: &'static str,
    /// Field of the scenario that states the median of the constant.
    pub field: &'static str,
    /// SI unit of the constant; "1" for a pure number.
    pub unit: &'static str,
    /// Standard deviation of the logarithm of the constant.
    pub dispersion: f64,
    /// Returns the value of the constant (SI) at a standard normal deviate. Returns `None` if the contact law has no
    /// such constant, or if the distribution of the constant is discrete.
    pub value: Box<dyn Fn(f64) -> Option<f64> + 'a>,
}

/// Effect of the uncertain constants on the share of collapses.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Range that contains the share of collapses with a probability of 95 % as the uncertain constants vary.
    pub range: [f64; 2],
    /// Share of collapses if all uncertain constants are at their medians.
    pub as_stated: f64,
    /// The constants, in the order of [`Unknown::effect`], the largest first.
    pub decides: Vec<Unknown>,
}

impl Fitted {
    /// Evaluates a fitted regression; `constants` are in the order of the deviates in the regression.
    pub fn of(fitted: &Conditional, constants: &[Constant<'_>]) -> Self {
        let whole = fitted.range(LEVEL);
        let unknown = |(at, (one, influence)): (usize, (&Constant<'_>, Influence))| {
            let share_at = |deviate: f64| {
                let (share, interval) = fitted.at(at, deviate, LEVEL);
                Some(ShareAt {
                    value: (one.value)(deviate)?,
                    share,
                    interval: [interval.low, interval.high],
                })
            };
            let deviates = FRACTILES.map(normal_quantile);
            let shares: Vec<ShareAt> = deviates.into_iter().filter_map(share_at).collect();
            let by_share = |a: &usize, b: &usize| shares[*a].share.total_cmp(&shares[*b].share);
            let least = (0..shares.len()).min_by(by_share).unwrap_or(0);
            let most = (0..shares.len()).max_by(by_share).unwrap_or(0);
            let difference = fitted.difference(at, [deviates[least], deviates[most]], LEVEL);
            Unknown {
                name: one.name,
                field: one.field,
                unit: one.unit,
                dispersion: one.dispersion,
                shares,
                difference: [difference.low, difference.high],
                total: influence.total,
                width_if_measured: influence.width_if_known,
            }
        };
        let influences = fitted.influences(LEVEL);
        let decides = constants.iter().zip(influences).enumerate().map(unknown).collect();
        Self {
            range: [whole.low, whole.high],
            as_stated: fitted.at_medians(),
            decides: by_effect(decides),
        }
    }

    /// Returns the decisive constant that changes the share of collapses most; `None` if no constant is decisive.
    pub fn decisive(&self) -> Option<&Unknown> {
        self.decides.iter().find(|one| one.is_decisive())
    }
}

/// Sorts constants by the difference between the largest and the smallest share, the largest difference first. Pages
/// state these shares, so the order agrees with the numbers that a reader sees.
fn by_effect(mut decides: Vec<Unknown>) -> Vec<Unknown> {
    decides.sort_by(|a, b| b.effect().total_cmp(&a.effect()));
    decides
}

/// Returns the correlation matrix of the deviates of constants. `of_friction` is the correlation between any two
/// coefficients of friction; all other deviates are independent.
fn correlations(constants: &[Drawn], of_friction: f64) -> Vec<Vec<f64>> {
    let between = |i: usize, j: usize| match (i == j, [i, j].map(|at| constants[at].axis)) {
        (true, _) => 1.0,
        (false, axes) if axes.iter().all(|axis| axis.is_friction()) => of_friction,
        (false, _) => 0.0,
    };
    let all = 0..constants.len();
    all.clone().map(|i| all.clone().map(|j| between(i, j)).collect()).collect()
}

/// Fits the regression of the share of collapses to `results`, the results of the nominal case and of its variants in
/// the order of their numbers. Returns `None` if the variants do not differ in their constants, if a variant has no
/// verdict, or if there are too few variants.
pub(super) fn range(plane: &Plane, results: &[CaseResult]) -> Option<Fitted> {
    let verdicts: Vec<Option<bool>> = results.get(1..)?.iter().map(verdict).collect();
    let (fitted, constants) = fit(plane, &verdicts)?;
    let constants: Vec<Constant<'_>> = constants.iter().map(Drawn::constant).collect();
    Some(Fitted::of(&fitted, &constants))
}

/// Returns the share of collapses for every draw of the uncertain constants. If there are several planes, the largest
/// of their shares is returned for each draw.
///
/// The share also has a random error, drawn from the error distribution of the regression. For all stacks with the same
/// uncertain constants and the same correlations, draws with the same index use the same values of the constants.
/// `verdicts` holds the verdicts of the variants in every plane. Returns `None` in the same cases as [`range`].
pub(super) fn draws(planes: &[Plane], verdicts: &[Vec<Option<bool>>]) -> Option<Vec<f64>> {
    let of = |(plane, verdicts): (&Plane, &Vec<_>)| Some(fit(plane, verdicts)?.0.shares());
    let shares = planes.iter().zip(verdicts).map(of).collect::<Option<Vec<Vec<f64>>>>()?;
    let larger = |all: Vec<f64>, other: Vec<f64>| {
        all.into_iter().zip(other).map(|(one, other)| one.max(other)).collect()
    };
    shares.into_iter().reduce(larger)
}

/// Fits the regression of the share of collapses to the verdicts of the variants, in the order of their numbers, and
/// returns it with its predictors, the uncertain constants. Returns `None` in the same cases as [`range`].
fn fit(plane: &Plane, verdicts: &[Option<bool>]) -> Option<(Conditional, Vec<Drawn>)> {
    let imperfections = plane.scenario.imperfections()?;
    let unknowns = plane.scenario.unknowns()?;
    let stack = plane.scenario.stack()?;
    if !unknowns.drawn {
        return None;
    }
    let constants = drawn(&stack.interfaces, unknowns, stack.rack.posts.is_some());
    let run = |(number, failed): (u32, bool)| DrawnRun {
        deviates: constants
            .iter()
            .map(|one| draw::deviate(imperfections, unknowns, one.axis, number))
            .collect(),
        second_half: plane.exchanged.is_some() && plane.is_exchanged(number),
        failed,
    };
    let failed = verdicts.iter().copied().collect::<Option<Vec<bool>>>()?;
    let runs: Vec<DrawnRun> = (1..).zip(failed).map(run).collect();
    let mut random = Random::new(u64::from(imperfections.seed));
    let fitted = conditional(&runs, || random.uniform())?
        .correlated(correlations(&constants, unknowns.friction_correlation));
    Some((fitted, constants))
}

impl Spread {
    /// Returns the constant whose measurement by a simple test would narrow the range of the share of collapses most,
    /// and the average width of the range after the measurement; `None` if no measurement would narrow the range by
    /// more than a tenth.
    pub fn worth_measuring(&self) -> Option<(&Unknown, f64)> {
        let [low, high] = self.range?;
        let tested = self.decides.iter().filter(|one| one.test().is_some());
        let best = tested.min_by(|a, b| a.width_if_measured.total_cmp(&b.width_if_measured))?;
        let left = best.width_if_measured;
        (left < 0.9 * (high - low)).then_some((best, left))
    }

    /// Returns the decisive constant that changes the share of collapses most; `None` if no constant is decisive.
    pub fn decisive(&self) -> Option<&Unknown> {
        self.decides.iter().find(|one| one.is_decisive())
    }
}

#[cfg(test)]
mod tests {
    use super::{Fitted, STATIC_BARREL_RACK, ShareAt, Unknown, by_effect, drawn};
    use crate::Scenario;

    #[test]
    fn the_constant_with_the_widest_range_of_shares_comes_first() {
        let of = |name, shares: [f64; 3], total| Unknown {
            name,
            field: "interface.barrel-rack.stiffness",
            unit: "N/m",
            dispersion: 0.6,
            shares: shares
                .map(|share| ShareAt { value: 1.0, share, interval: [share; 2] })
                .to_vec(),
            difference: [0.1, 0.9],
            total,
            width_if_measured: 0.5,
        };
        // More variance would remain for the stiffness, but the range over the friction is wider.
        let stiffness = of("stiffness of seats", [0.9, 0.8, 0.6], 0.6);
        let friction = of("friction of barrels on racks", [0.95, 0.8, 0.4], 0.4);
        let decides = by_effect(vec![stiffness, friction]);
        let fitted = Fitted { range: [0.2, 1.0], as_stated: 0.8, decides };
        assert_eq!(fitted.decisive().unwrap().name, "friction of barrels on racks");
    }

    #[test]
    fn constants_enter_the_fit_if_they_are_drawn() {
        let fields = |changes: &[&str]| {
            let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
            let scenario = Scenario::builtin("demo-napa", &changes).unwrap();
            let laws = &scenario.stack().unwrap().interfaces;
            drawn(laws, scenario.unknowns().unwrap(), false)
        };
        let names =
            |changes: &[&str]| fields(changes).iter().map(|one| one.field).collect::<Vec<_>>();
        assert_eq!(names(&[]).len(), 4);
        // The fit leaves out constants that change the share by less than its sampling error.
        assert_eq!(names(&["unknowns.stick=0.5", "unknowns.rails=5 mm"]), names(&[]));
        let held = fields(&["unknowns.static_friction=0.4"]);
        let held = held.iter().find(|one| one.field == STATIC_BARREL_RACK).unwrap();
        // The catalog states 0.30 for kinetic and static friction. The values correspond to 5 %, 50 % and 95 % of the
        // largest excess of 0.4.
        for (deviate, exact) in [(-1.644_854, 0.306), (0.0, 0.36), (1.644_854, 0.414)] {
            let found = held.at(deviate).unwrap();
            assert!((found - exact).abs() < 1e-6, "{found} {exact}");
        }
        let none =
            names(&["unknowns.friction=0", "unknowns.friction_ground=0", "unknowns.damping=0"]);
        assert_eq!(none, ["interface.barrel-rack.stiffness"]);
    }
}
