//! Contact parameters that a test of a whole stack can determine, and scenarios in which these parameters are
//! changed.

use std::fmt::Write as _;

use barrelstack::scenario::{
    Basis, Damping, Dimension, Friction, Interface, NormalLaw, Scenario, Scene,
};
use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math;

use super::CalibrateError;
use super::result::{quoted, rounded};

/// A parameter that can be estimated from a recorded response or from observed collapses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Stiffness of barrel–rack contacts. The stiffness of rack–ground contacts changes in proportion.
    Stiffness,
    /// Damping of barrel–rack contacts. The damping of rack–ground contacts changes in proportion.
    Damping,
    /// Friction coefficients of barrel–rack contacts. The static and the kinetic coefficient keep their
    /// ratio.
    FrictionBarrelRack,
    /// Friction coefficients of rack–ground contacts. The static and the kinetic coefficient keep their
    /// ratio.
    FrictionRackGround,
}

impl Parameter {
    /// All parameters with their short names.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("k", Self::Stiffness),
        ("c", Self::Damping),
        ("mu-br", Self::FrictionBarrelRack),
        ("mu-rg", Self::FrictionRackGround),
    ];

    /// Returns the name of the parameter in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness k",
            Self::Damping => "damping c",
            Self::FrictionBarrelRack => "friction barrel-rack",
            Self::FrictionRackGround => "friction rack-ground",
        }
    }
}

/// Contact constants of one interface.
#[derive(Clone, Copy)]
struct Constants {
    stiffness: f64,
    damping: f64,
    kinetic: f64,
    rest: f64,
}

/// Parameters to be estimated, and the contact constants of the scenario.
///
/// A point in the parameter space has one coordinate per parameter: the logarithm of the ratio of the parameter to
/// its value in the scenario.
pub(super) struct Tunable {
    parameters: Vec<Parameter>,
    barrel_rack: Constants,
    rack_ground: Constants,
    basis: Basis,
}

impl Tunable {
    /// Reads the values of parameters from a scenario.
    ///
    /// # Errors
    /// If the scenario is not a stack whose contact laws are linear and have friction.
    pub(super) fn new(
        scenario: &Scenario,
        parameters: &[Parameter],
    ) -> Result<Self, CalibrateError> {
        let refuse = |reason: &str| CalibrateError::Scenario(reason.to_owned());
        let Scene::Stack { stack, .. } = &scenario.scene else {
            return Err(refuse(
                "k, c and μ can be fitted only to a stack, but this is a free scene: use the scenario of a stack",
            ));
        };
        let interfaces = &stack.interfaces;
        let barrel_rack = constants("barrel-rack", &interfaces.barrel_rack)?;
        let rack_ground = constants("rack-ground", &interfaces.rack_ground)?;
        let basis = interfaces.barrel_rack.basis;
        if interfaces.rack_ground.basis != basis {
            return Err(refuse(
                "the interfaces barrel-rack and rack-ground differ in `basis`: state both per seat, both per \
                 node or both per length",
            ));
        }
        Ok(Self { parameters: parameters.to_vec(), barrel_rack, rack_ground, basis })
    }

    /// Returns the parameters, in the order of the coordinates of a point.
    pub(super) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Returns the value of a parameter in the scenario (SI).
    pub(super) fn start(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Stiffness => self.barrel_rack.stiffness,
            Parameter::Damping => self.barrel_rack.damping,
            Parameter::FrictionBarrelRack => self.barrel_rack.kinetic,
            Parameter::FrictionRackGround => self.rack_ground.kinetic,
        }
    }

    /// Returns the dimension of a parameter.
    pub(super) fn dimension(&self, parameter: Parameter) -> Dimension {
        match (parameter, self.basis) {
            (Parameter::Stiffness, Basis::Node | Basis::Seat) => Dimension::STIFFNESS,
            (Parameter::Stiffness, Basis::Length) => Dimension::STIFFNESS_PER_LENGTH,
            (Parameter::Damping, Basis::Node | Basis::Seat) => Dimension::DAMPING,
            (Parameter::Damping, Basis::Length) => Dimension::DAMPING_PER_LENGTH,
            (Parameter::FrictionBarrelRack | Parameter::FrictionRackGround, _) => Dimension::NONE,
        }
    }

    /// Returns a copy of a scenario in which the parameters have the values of a point.
    pub(super) fn at(&self, scenario: &Scenario, point: &[f64]) -> Scenario {
        let mut scenario = scenario.clone();
        if let Scene::Stack { stack, .. } = &mut scenario.scene {
            set(&mut stack.interfaces.barrel_rack, &self.constants(true, point));
            set(&mut stack.interfaces.rack_ground, &self.constants(false, point));
        }
        scenario
    }

    /// Returns the contact constants of an interface at a point. The interface is barrel–rack if `barrel_rack` is
    /// `true`, and rack–ground otherwise.
    fn constants(&self, barrel_rack: bool, point: &[f64]) -> Constants {
        let mut constants = if barrel_rack { self.barrel_rack } else { self.rack_ground };
        for (parameter, log) in self.parameters.iter().zip(point) {
            let factor = math::exp(*log);
            match parameter {
                Parameter::Stiffness => constants.stiffness *= factor,
                Parameter::Damping => constants.damping *= factor,
                Parameter::FrictionBarrelRack | Parameter::FrictionRackGround => {
                    if (*parameter == Parameter::FrictionBarrelRack) == barrel_rack {
                        constants.kinetic *= factor;
                        constants.rest *= factor;
                    }
                }
            }
        }
        constants
    }

    /// Returns the lines to paste into a scenario, with the fitted constants of each interface.
    pub(super) fn scenario_lines(&self, point: &[f64]) -> String {
        let mut text = String::new();
        let has = |parameter| self.parameters.contains(&parameter);
        for (name, own) in [
            ("barrel-rack", Parameter::FrictionBarrelRack),
            ("rack-ground", Parameter::FrictionRackGround),
        ] {
            let constants = self.constants(name == "barrel-rack", point);
            if has(Parameter::Stiffness) || has(Parameter::Damping) {
                let _ = writeln!(
                    text,
                    "[interface.{name}]\nstiffness = {}\ndamping = {}",
                    quoted(constants.stiffness, self.dimension(Parameter::Stiffness)),
                    quoted(constants.damping, self.dimension(Parameter::Damping)),
                );
            }
            if has(own) {
                let _ = writeln!(
                    text,
                    "[interface.{name}.friction]\ncoefficient = {}",
                    rounded(constants.kinetic)
                );
                if constants.rest > constants.kinetic {
                    let _ = writeln!(text, "static_coefficient = {}", rounded(constants.rest));
                }
            }
        }
        text
    }
}

/// Returns the constants of an interface, or an error if a constant is not positive: the fit multiplies the constants
/// by factors, which cannot change zero.
fn constants(name: &str, interface: &Interface) -> Result<Constants, CalibrateError> {
    let refuse =
        |reason: &str| Err(CalibrateError::Scenario(format!("interface.{name}: {reason}")));
    let (NormalLaw::SpeedGap { stiffness, damping }
    | NormalLaw::KelvinVoigt { stiffness, damping }) = interface.normal
    else {
        return refuse(
            "k and c are constants of a linear contact law: set law = \"speed-gap\" or law = \"kelvin-voigt\"",
        );
    };
    // The fit varies k and c separately, so a restitution is first converted to a damping c.
    let damping = match damping {
        Damping::Coefficient(damping) => damping,
        Damping::Restitution { restitution: ratio, reference: mass } => {
            let ratio = if matches!(interface.normal, NormalLaw::KelvinVoigt { .. }) {
                restitution::kelvin_voigt_damping_ratio(ratio)
            } else {
                restitution::speed_gap_damping_ratio(ratio)
            };
            restitution::damping(stiffness, ratio.unwrap_or(0.0), mass)
        }
    };
    let (kinetic, rest) = match interface.friction {
        Friction::Coulomb { coefficient, static_coefficient, .. } => {
            (coefficient, static_coefficient)
        }
        Friction::Regularized { coefficient, .. } => (coefficient, coefficient),
        Friction::None => return refuse("a fit needs a friction law: set law = \"coulomb\""),
    };
    if [stiffness, damping, kinetic].iter().any(|value| *value <= 0.0) {
        return refuse("a fit needs starting values of stiffness, damping and friction above zero");
    }
    Ok(Constants { stiffness, damping, kinetic, rest })
}

fn set(interface: &mut Interface, to: &Constants) {
    match &mut interface.normal {
        NormalLaw::SpeedGap { stiffness, damping }
        | NormalLaw::KelvinVoigt { stiffness, damping } => {
            *stiffness = to.stiffness;
            *damping = Damping::Coefficient(to.damping);
        }
        NormalLaw::HuntCrossley { .. } | NormalLaw::Hertz { .. } | NormalLaw::Rebound { .. } => {}
    }
    match &mut interface.friction {
        Friction::Coulomb { coefficient, static_coefficient, .. } => {
            *coefficient = to.kinetic;
            *static_coefficient = to.rest;
        }
        Friction::Regularized { coefficient, .. } => *coefficient = to.kinetic,
        Friction::None => {}
    }
}
