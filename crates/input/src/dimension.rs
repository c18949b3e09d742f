//! Physical dimensions, represented by their exponents of length, mass, time and angle.

use std::fmt;
use std::ops::{Add, Neg};

/// A physical dimension: exponents of length, mass, time and angle. Each exponent is stored as **twice its value**, so
/// that half-integer exponents, as in the unit of the Hertz stiffness (N/m^1.5), are integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension {
    length: i8,
    mass: i8,
    time: i8,
    angle: i8,
}

/// A dimension that has a name, an SI unit and an example.
struct NamedDimension {
    dimension: Dimension,
    name: &'static str,
    unit: &'static str,
    example: &'static str,
}

macro_rules! dimensions {
    ($($constant:ident = [$length:expr, $mass:expr, $time:expr, $angle:expr], $name:literal, $unit:literal, $example:literal;)*) => {
        impl Dimension {
            $(
                #[doc = concat!("The dimension of ", $name, " (", $unit, ").")]
                pub const $constant: Self =
                    Self { length: $length, mass: $mass, time: $time, angle: $angle };
            )*
        }
        const KNOWN: &[NamedDimension] = &[
            $(NamedDimension { dimension: Dimension::$constant, name: $name, unit: $unit, example: $example }),*
        ];
    };
}

dimensions! {
    NONE = [0, 0, 0, 0], "a plain number", "1", "0.5";
    LENGTH = [2, 0, 0, 0], "a length", "m", "0.25 m";
    MASS = [0, 2, 0, 0], "a mass", "kg", "275 kg";
    TIME = [0, 0, 2, 0], "a time", "s", "0.001 s";
    ANGLE = [0, 0, 0, 2], "an angle", "rad", "30 deg";
    FREQUENCY = [0, 0, -2, 0], "a frequency", "Hz", "60 Hz";
    VELOCITY = [2, 0, -2, 0], "a velocity", "m/s", "60 cm/s";
    ACCELERATION = [2, 0, -4, 0], "an acceleration", "m/s^2", "0.35 g";
    SPIN = [0, 0, -2, 2], "an angular velocity", "rad/s", "1.5 rad/s";
    FORCE = [2, 2, -4, 0], "a force", "N", "2 kN";
    VOLUME = [6, 0, 0, 0], "a volume", "m^3", "225 L";
    INERTIA = [4, 2, 0, 0], "a moment of inertia", "kg m^2", "3.9 kg m^2";
    STIFFNESS = [0, 2, -4, 0], "a stiffness", "N/m", "9.8 kN/cm";
    STIFFNESS_PER_LENGTH = [-2, 2, -4, 0], "a stiffness per length", "N/m^2", "9.8 MN/m^2";
    HERTZ_STIFFNESS = [-1, 2, -4, 0], "a Hertz stiffness", "N/m^1.5", "9.8 MN/m^1.5";
    HERTZ_STIFFNESS_PER_LENGTH = [-3, 2, -4, 0], "a Hertz stiffness per length", "N/m^2.5", "9.8 MN/m^2.5";
    DAMPING = [0, 2, -2, 0], "a damping", "N s/m", "22 N s/cm";
    DAMPING_PER_LENGTH = [-2, 2, -2, 0], "a damping per length", "N s/m^2", "22 kN s/m^2";
    HUNT_CROSSLEY_DAMPING = [-2, 0, 2, 0], "a Hunt-Crossley damping", "s/m", "0.5 s/m";
    ANGULAR_DAMPING = [4, 2, -2, 0], "an angular damping", "N m s", "2 N m s";
    MASS_PER_LENGTH = [-2, 2, 0, 0], "a mass per length", "kg/m", "300 kg/m";
    DENSITY = [-6, 2, 0, 0], "a density", "kg/m^3", "990 kg/m^3";
}

impl Dimension {
    /// Returns the SI unit, in the notation of input files.
    pub fn si_unit(self) -> String {
        self.known().map_or_else(
            || {
                let parts: Vec<String> =
                    [("m", self.length), ("kg", self.mass), ("s", self.time), ("rad", self.angle)]
                        .iter()
                        .filter(|(_, halves)| *halves != 0)
                        .map(|(unit, halves)| match f64::from(*halves) / 2.0 {
                            1.0 => (*unit).to_owned(),
                            exponent => format!("{unit}^{exponent}"),
                        })
                        .collect();
                parts.join(" ")
            },
            |known| known.unit.to_owned(),
        )
    }

    /// Returns a quantity of this dimension as a user would write it.
    pub fn example(self) -> String {
        self.known().map_or_else(|| format!("1 {}", self.si_unit()), |k| k.example.to_owned())
    }

    /// Returns the dimension raised to the power `halves / 2`, or `None` if an exponent overflows
    /// or is not a multiple of a half.
    pub(crate) fn power(self, halves: i8) -> Option<Self> {
        let scale = |exponent: i8| -> Option<i8> {
            let doubled = i16::from(exponent) * i16::from(halves);
            if doubled % 2 == 0 { i8::try_from(doubled / 2).ok() } else { None }
        };
        Some(Self {
            length: scale(self.length)?,
            mass: scale(self.mass)?,
            time: scale(self.time)?,
            angle: scale(self.angle)?,
        })
    }

    fn known(self) -> Option<&'static NamedDimension> {
        KNOWN.iter().find(|known| known.dimension == self)
    }
}

impl Add for Dimension {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            length: self.length.saturating_add(other.length),
            mass: self.mass.saturating_add(other.mass),
            time: self.time.saturating_add(other.time),
            angle: self.angle.saturating_add(other.angle),
        }
    }
}

impl Neg for Dimension {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            length: self.length.saturating_neg(),
            mass: self.mass.saturating_neg(),
            time: self.time.saturating_neg(),
            angle: self.angle.saturating_neg(),
        }
    }
}

/// Writes the name and the SI unit, such as `a stiffness (N/m)`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.known() {
            Some(known) if *self == Self::NONE => f.write_str(known.name),
            Some(known) => write!(f, "{} ({})", known.name, known.unit),
            None => write!(f, "a quantity in {}", self.si_unit()),
        }
    }
}
