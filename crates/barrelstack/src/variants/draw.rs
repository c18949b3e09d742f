//! Draws a variant of a stack: the scenario with all its uncertain parameters drawn at random.

use barrelstack_fragility::{normal, normal_quantile, sobol};

use crate::scenario::{
    BodyOverride, Imperfections, Interface, Scenario, Scene, StackBody, StackInterfaces, StackSpec,
    Unknowns,
};

/// Random quantities that the whole stack shares, in the order of their axes. A variant is a point in
/// the unit cube that these axes span.
///
/// The axes of the shared quantities are followed by two axes per body. In three dimensions, one more
/// axis per body follows, for the position along the barrels. The first row of the stack therefore has
/// the same values as a stack in the plane across the barrels. Quantities that were added to the
/// program later have axes after the axes of all bodies, so that the other quantities keep their values.
#[derive(Clone, Copy)]
pub(super) enum Shared {
    FrictionGround,
    FrictionBarrelRack,
    FrictionRackRack,
    FrictionBarrelBarrel,
    FrictionBarrelGround,
    SeatStiffness,
    ImpactStiffness,
    SeatDamping,
    Sign,
    Count,
    StaticFriction = 1 << 20,
    Stick,
    RailSpacing,
    Friction,
}

impl Shared {
    /// Returns `true` if the quantity is a friction coefficient.
    pub(super) fn is_friction(self) -> bool {
        matches!(
            self,
            Self::FrictionGround
                | Self::FrictionBarrelRack
                | Self::FrictionRackRack
                | Self::FrictionBarrelBarrel
                | Self::FrictionBarrelGround
        )
    }
}

/// Truncation of normal deviates, in standard deviations.
const FARTHEST: f64 = 3.0;

/// A point in the unit cube whose axes are the drawn quantities.
struct Point {
    number: u32,
    seed: u64,
}

impl Point {
    fn of(imperfections: &Imperfections, number: u32) -> Self {
        Self { number: number.saturating_sub(1), seed: u64::from(imperfections.seed) }
    }

    fn uniform(&self, axis: usize) -> f64 {
        sobol::padded(axis, self.number, self.seed)
    }

    fn normal(&self, axis: usize) -> f64 {
        normal_quantile(self.uniform(axis)).clamp(-FARTHEST, FARTHEST)
    }

    /// Returns the deviate of a constant; the deviates of friction coefficients are correlated through a common part.
    fn constant(&self, axis: Shared, unknowns: &Unknowns) -> f64 {
        let own = self.normal(axis as usize);
        if !axis.is_friction() {
            return own;
        }
        let common = self.normal(Shared::Friction as usize);
        let along = unknowns.friction_correlation;
        (along.sqrt() * common + (1.0 - along).sqrt() * own).clamp(-FARTHEST, FARTHEST)
    }

    /// Returns a lognormal factor with median 1 and the given dispersion.
    fn lognormal(&self, axis: Shared, unknowns: &Unknowns, dispersion: f64) -> f64 {
        libm::exp(dispersion * self.constant(axis, unknowns))
    }
}

/// Converts a standard normal deviate, through its cumulative probability, to a factor that is uniformly distributed
/// from 1 to `1 + largest`.
pub(super) fn excess(largest: f64, deviate: f64) -> f64 {
    1.0 + largest * normal(deviate)
}

/// Returns the standard normal deviate of a constant in a variant; the numbers of variants start from 1.
pub(super) fn deviate(
    imperfections: &Imperfections,
    unknowns: &Unknowns,
    axis: Shared,
    number: u32,
) -> f64 {
    Point::of(imperfections, number).constant(axis, unknowns)
}

/// Returns a variant by its number, starting from 1; a free scene has no variants and is returned
/// unchanged.
pub(super) fn variant(scenario: &Scenario, number: u32) -> Scenario {
    let mut changed = scenario.clone();
    let Scene::Stack { stack, imperfections, unknowns, .. } = &mut changed.scene else {
        return changed;
    };
    let point = Point::of(imperfections, number);
    if imperfections.sign && point.uniform(Shared::Sign as usize) < 0.5 {
        stack.mirror = !stack.mirror;
    }
    if unknowns.drawn {
        constants(&mut stack.interfaces, unknowns, &point);
        stack.rack.rail_half_spacing +=
            unknowns.rails * (2.0 * point.uniform(Shared::RailSpacing as usize) - 1.0);
    }
    if imperfections.drawn {
        places(stack, imperfections, &point);
    }
    changed
}

/// Draws friction and contact constants at random. One friction factor applies to all contacts between the same kinds
/// of bodies, such as barrel and rack, before and after a fall.
fn constants(laws: &mut StackInterfaces, spread: &Unknowns, point: &Point) {
    let roughen = |axis: Shared, dispersion: f64, interfaces: &mut [&mut Interface]| {
        let factor = point.lognormal(axis, spread, dispersion);
        for interface in interfaces {
            interface.roughen(factor);
        }
    };
    let (ground, others) = (spread.friction_ground, spread.friction);
    let steel = &mut [&mut laws.rack_ground, &mut laws.fallen_rack_ground];
    roughen(Shared::FrictionGround, ground, steel);
    roughen(Shared::FrictionBarrelGround, ground, &mut [&mut laws.barrel_ground]);
    let wood = &mut [&mut laws.barrel_rack, &mut laws.fallen_barrel_rack];
    roughen(Shared::FrictionBarrelRack, spread.friction_of_barrels(), wood);
    let steel = &mut [&mut laws.rack_rack, &mut laws.fallen_rack_rack];
    roughen(Shared::FrictionRackRack, others, steel);
    roughen(Shared::FrictionBarrelBarrel, others, &mut [&mut laws.barrel_barrel]);
    let stiffness = [
        (Shared::SeatStiffness, spread.stiffness),
        (Shared::ImpactStiffness, spread.impact_stiffness),
    ]
    .map(|(axis, dispersion)| point.lognormal(axis, spread, dispersion));
    let damping = point.lognormal(Shared::SeatDamping, spread, spread.damping);
    let stick = point.lognormal(Shared::Stick, spread, spread.stick);
    let hold = excess(spread.static_friction, point.normal(Shared::StaticFriction as usize));
    for wood in [&mut laws.barrel_rack, &mut laws.fallen_barrel_rack] {
        wood.hold(hold);
    }
    for seat in [&mut laws.rack_ground, &mut laws.barrel_rack, &mut laws.rack_rack] {
        seat.stiffen(stiffness[0]);
        seat.damp(damping);
        seat.stick(stick);
    }
    for impact in [
        &mut laws.barrel_barrel,
        &mut laws.barrel_ground,
        &mut laws.fallen_barrel_rack,
        &mut laws.fallen_rack_ground,
        &mut laws.fallen_rack_rack,
    ] {
        impact.stiffen(stiffness[1]);
    }
}

/// Draws the position and the mass of every rack and barrel at random.
fn places(stack: &mut StackSpec, spread: &Imperfections, point: &Point) {
    let rows = |body: StackBody| {
        let many = match (body, stack.space) {
            (_, None) => return vec![None],
            (StackBody::Rack, Some(_)) => stack.racks_along(),
            (StackBody::Barrel, Some(space)) => space.columns_along,
        };
        (1..=many).map(Some).collect()
    };
    let mut bodies = Vec::new();
    for (body, columns) in
        [(StackBody::Rack, stack.racks_per_level()), (StackBody::Barrel, stack.columns)]
    {
        for row in rows(body) {
            for level in 1..=stack.levels {
                bodies.extend((1..=columns).map(|column| (body, level, column, row)));
            }
        }
    }
    // The first row of all bodies uses the same axes as a stack in the plane.
    bodies.sort_by_key(|(.., row)| row.unwrap_or(1));
    let first = Shared::Count as usize;
    let aside = |axis: usize| spread.placement * (2.0 * point.uniform(axis) - 1.0);
    let draw = |(at, (body, level, column, row)): (usize, &(StackBody, u32, u32, Option<u32>))| {
        let axis = first + 2 * at;
        let factor = 1.0 + spread.mass * point.normal(axis + 1);
        BodyOverride {
            body: *body,
            level: *level,
            column: Some(*column),
            row: *row,
            mass: Some(mass(stack, *body, *level, *column, *row) * factor),
            fill: None,
            offset_x: aside(axis),
            offset_y: row.map_or(0.0, |_| aside(first + 2 * bodies.len() + at)),
        }
    };
    let drawn: Vec<BodyOverride> = bodies.iter().enumerate().map(draw).collect();
    stack.overrides.extend(drawn);
}

/// Returns the mass (kg) of a body as stated in the scenario.
fn mass(stack: &StackSpec, body: StackBody, level: u32, column: u32, row: Option<u32>) -> f64 {
    let here = |change: &&BodyOverride| change.row.is_none() || change.row == row;
    let changes = stack.changes_of(body, level, column).filter(here);
    match body {
        StackBody::Rack => changes.fold(stack.rack.mass, |mass, one| one.mass.unwrap_or(mass)),
        StackBody::Barrel => {
            let stated = stack.barrel.clone();
            changes.fold(stated, |barrel, one| barrel.altered(one.mass, one.fill)).mass
        }
    }
}

#[cfg(test)]
mod tests {
    use super::variant;
    use crate::Scenario;
    use crate::scenario::{Friction, Scene};

    fn drawn(changes: &[&str], number: u32) -> Scenario {
        let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        variant(&Scenario::builtin("candia-8-barrels", &changes).unwrap(), number)
    }

    fn friction(scenario: &Scenario) -> f64 {
        let Friction::Coulomb { coefficient, .. } =
            scenario.stack().unwrap().interfaces.barrel_rack.friction
        else {
            panic!("no Coulomb friction")
        };
        coefficient
    }

    #[test]
    fn variants_lie_around_what_is_stated_and_as_far_as_is_stated() {
        let all: Vec<Scenario> = (1..=64).map(|number| drawn(&[], number)).collect();
        let logs: Vec<f64> = all.iter().map(|one| (friction(one) / 0.22).ln()).collect();
        let mean = logs.iter().sum::<f64>() / 64.0;
        let deviation = (logs.iter().map(|log| log * log).sum::<f64>() / 64.0).sqrt();
        assert!(mean.abs() < 0.01, "{mean}"); // measured 2e-3
        assert!((deviation / 0.25 - 1.0).abs() < 0.05, "{deviation}");
        for one in &all {
            let stack = one.stack().unwrap();
            // Four racks and eight barrels.
            assert_eq!(stack.overrides.len(), 12);
            assert!(stack.overrides.iter().all(|body| body.offset_x.abs() <= 1e-3));
            let off = stack.overrides[4].mass.unwrap() / stack.barrel.mass - 1.0;
            // Three standard deviations; the small addend covers rounding.
            assert!(off.abs() < 0.03 + 1e-12, "{off}");
        }
        let places: Vec<f64> =
            all.iter().map(|one| one.stack().unwrap().overrides[7].offset_x).collect();
        assert!(places.iter().any(|x| *x > 0.9e-3) && places.iter().any(|x| *x < -0.9e-3));
    }

    #[test]
    fn places_and_constants_are_drawn_apart_from_each_other() {
        let stated = Scenario::builtin("candia-8-barrels", &[]).unwrap();
        let places = drawn(&["unknowns.drawn=false"], 3);
        assert_eq!(places.stack().unwrap().interfaces, stated.stack().unwrap().interfaces);
        let constants = drawn(&["imperfections.drawn=false"], 3);
        assert!(constants.stack().unwrap().overrides.is_empty());
        let both = drawn(&[], 3);
        assert_eq!(both.stack().unwrap().overrides, places.stack().unwrap().overrides);
        assert_eq!(both.stack().unwrap().interfaces, constants.stack().unwrap().interfaces);
        assert_ne!(both, drawn(&["imperfections.seed=2"], 3));
    }

    #[test]
    fn draws_are_those_of_every_earlier_program() {
        // These values were computed when positions and constants were still fields of one table.
        let all = drawn(&[], 3);
        let stack = all.stack().unwrap();
        let body = &stack.overrides[4];
        assert_eq!(friction(&all), 0.201_701_724_401_093_19);
        assert_eq!(
            (body.mass, body.offset_x),
            (Some(271.600_363_458_756_5), -0.000_339_739_266_084_507_1)
        );
    }

    #[test]
    fn constants_that_are_not_drawn_by_default_leave_all_others() {
        let (plain, number) = (drawn(&[], 3), 3);
        let changes = ["unknowns.static_friction=0.4", "unknowns.stick=0.5", "unknowns.rails=5 mm"];
        let all = drawn(&changes, number);
        let (plain, stack) = (plain.stack().unwrap(), all.stack().unwrap());
        assert_eq!(plain.overrides, stack.overrides);
        let laws = [&plain.interfaces.barrel_rack, &stack.interfaces.barrel_rack];
        assert_eq!(laws[0].normal, laws[1].normal);
        let [before, after] = laws.map(|law| match law.friction {
            Friction::Coulomb {
                coefficient,
                static_coefficient,
                tangential_stiffness_ratio,
                ..
            } => [coefficient, static_coefficient / coefficient, tangential_stiffness_ratio],
            Friction::Regularized { .. } | Friction::None => panic!("no Coulomb friction"),
        });
        assert_eq!(before[0], after[0]);
        assert!((1.0..1.4).contains(&after[1]) && before[1] == 1.0, "{after:?}");
        assert!(after[2] != before[2] && (after[2] / before[2]).ln().abs() < 1.5, "{after:?}");
        // Over all variants, the draws are spread evenly.
        let mean = (1..=64).map(|number| {
            let one = drawn(&changes, number);
            let stack = one.stack().unwrap();
            let off = stack.rack.rail_half_spacing - plain.rack.rail_half_spacing;
            assert!(off.abs() < 5e-3, "{off}");
            off / 64.0
        });
        assert!(mean.sum::<f64>().abs() < 1e-4);
    }

    #[test]
    fn frictions_are_correlated_as_stated() {
        let change = ["unknowns.friction_correlation=0.6"];
        let logs = |number: u32| {
            let one = drawn(&change, number);
            let laws = &one.stack().unwrap().interfaces;
            [&laws.barrel_rack, &laws.rack_ground].map(|law| match law.friction {
                Friction::Coulomb { coefficient, .. } => coefficient.ln(),
                Friction::Regularized { .. } | Friction::None => panic!("no Coulomb friction"),
            })
        };
        let all: Vec<[f64; 2]> = (1..=512).map(logs).collect();
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| all.iter().map(of).sum::<f64>() / 512.0;
        let means = [0, 1].map(|at| mean(&|one| one[at]));
        let product = |i: usize, j: usize| mean(&|one| (one[i] - means[i]) * (one[j] - means[j]));
        let found = product(0, 1) / (product(0, 0) * product(1, 1)).sqrt();
        assert!((found - 0.6).abs() < 0.02, "{found}"); // measured 0.006
        let scatter = product(0, 0).sqrt();
        assert!((scatter / 0.25 - 1.0).abs() < 0.05, "{scatter}"); // measured 0.026
        // The correlation changes neither the positions nor the other constants.
        let (plain, one) = (drawn(&[], 3), drawn(&change, 3));
        let (plain, one) = (plain.stack().unwrap(), one.stack().unwrap());
        assert_eq!(plain.overrides, one.overrides);
        assert_eq!(plain.interfaces.barrel_rack.normal, one.interfaces.barrel_rack.normal);
    }

    #[test]
    fn half_of_the_variants_face_the_other_way_when_asked() {
        let mirrored = |number| drawn(&["imperfections.sign=true"], number).stack().unwrap().mirror;
        assert_eq!((1..=64).filter(|number| mirrored(*number)).count(), 32);
        assert!(!(1..=64).any(|number| drawn(&[], number).stack().unwrap().mirror));
    }

    #[test]
    fn a_variant_is_a_scenario_that_reads_back() {
        let one = drawn(&[], 5);
        let again = Scenario::from_str(&one.to_resolved_toml()).unwrap();
        assert_eq!(again, one);
        assert!(matches!(one.scene, Scene::Stack { .. }));
    }
}
