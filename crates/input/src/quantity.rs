//! Quantities written with their unit, such as `9.8 kN/cm`, converted to SI.

use std::f64::consts::PI;
use std::fmt;

use crate::dimension::Dimension;
use crate::unit::{self, Scale};

/// A value in SI units, with its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Value in SI units.
    pub value: f64,
    /// Dimension of the value.
    pub dimension: Dimension,
}

/// A reason why a string is not a valid quantity.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum QuantityError {
    /// The text does not start with a decimal number.
    #[error("`{text}` does not start with a decimal number")]
    NoNumber {
        /// The input text, truncated to 60 characters.
        text: String,
    },
    /// The number exceeds the range of double precision.
    #[error("`{text}` exceeds the range of double precision")]
    Overflow {
        /// The input text, truncated to 60 characters.
        text: String,
    },
    /// The unit is missing.
    #[error("`{text}` has no unit")]
    NoUnit {
        /// The input text, truncated to 60 characters.
        text: String,
    },
    /// The unit is unknown.
    #[error("unknown unit `{unit}` in `{text}`")]
    UnknownUnit {
        /// Unknown unit.
        unit: String,
        /// The input text, truncated to 60 characters.
        text: String,
        /// The unit that was probably meant; `None` if there is no likely unit.
        nearest: Option<String>,
    },
    /// The unit expression is malformed.
    #[error("cannot read the unit of `{text}`: {reason}")]
    Malformed {
        /// The input text, truncated to 60 characters.
        text: String,
        /// Reason, in words.
        reason: &'static str,
    },
    /// The unit `gal` has two meanings, and no expected dimension selects one of them.
    #[error("the unit `gal` in `{text}` may mean the US gallon or cm/s^2; write `gallon` or `Gal`")]
    Ambiguous {
        /// The input text, truncated to 60 characters.
        text: String,
    },
    /// The quantity does not have the expected dimension.
    #[error("`{text}` is {found}, expected {expected}")]
    WrongDimension {
        /// The input text, truncated to 60 characters.
        text: String,
        /// Dimension of the given quantity.
        found: String,
        /// Expected dimensions.
        expected: String,
    },
}

impl Quantity {
    /// Parses a quantity of any dimension.
    ///
    /// A quantity is a decimal number and a unit. Units may be multiplied (space, `*` or `·`),
    /// divided (`/`), raised to a power (`m^2`, `m²`, `m^1.5`) and grouped with parentheses.
    /// Decimal conversions are exact: the result is the double nearest to the true value.
    ///
    /// ```
    /// use barrelstack_input::quantity::Quantity;
    ///
    /// assert_eq!(Quantity::parse("2 in")?.value, 0.0508);
    /// assert_eq!(Quantity::parse("9.8 kN/cm")?.value, 980_000.0);
    /// # Ok::<(), barrelstack_input::quantity::QuantityError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If the number is missing, too large or not finite, or if the unit is missing, unknown or
    /// malformed.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        match Self::readings(text, &[])?.as_slice() {
            [one] => Ok(*one),
            _ => Err(QuantityError::Ambiguous { text: shorten(text.trim()) }),
        }
    }

    /// Returns all possible interpretations of a string as a quantity. A number without a unit is
    /// accepted only if a plain number is wanted.
    fn readings(text: &str, wanted: &[Dimension]) -> Result<Vec<Self>, QuantityError> {
        let trimmed = text.trim();
        let shown = || shorten(trimmed);
        let (number, rest) =
            Decimal::take(trimmed).ok_or_else(|| QuantityError::NoNumber { text: shown() })?;
        let unit_text = match rest.trim() {
            "" if wanted.contains(&Dimension::NONE) => "1",
            "" => return Err(QuantityError::NoUnit { text: shown() }),
            unit => unit,
        };
        let units = unit::readings(unit_text).map_err(|e| e.within(&shown()))?;
        let reading = |unit: &unit::Unit| {
            let value = number.times(&unit.scale);
            let quantity = Self { value, dimension: unit.dimension };
            let overflow = || QuantityError::Overflow { text: shown() };
            value.is_finite().then_some(quantity).ok_or_else(overflow)
        };
        units.iter().map(reading).collect()
    }

    /// Parses a quantity of one of the dimensions `wanted`. These dimensions determine whether the unit `gal` is read
    /// as a US gallon or as cm/s².
    ///
    /// ```
    /// use barrelstack_input::{Dimension, Quantity};
    ///
    /// assert_eq!(Quantity::parse_as("60 gal", &[Dimension::VOLUME])?.value, 0.22712470704);
    /// assert_eq!(Quantity::parse_as("981 gal", &[Dimension::ACCELERATION])?.value, 9.81);
    /// # Ok::<(), barrelstack_input::quantity::QuantityError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The same as for [`Quantity::parse`], and if the dimension is not one of `wanted`.
    pub fn parse_as(text: &str, wanted: &[Dimension]) -> Result<Self, QuantityError> {
        let readings = Self::readings(text, wanted)?;
        if let Some(quantity) = readings.iter().find(|q| wanted.contains(&q.dimension)) {
            return Ok(*quantity);
        }
        let listed = |dimensions: &mut dyn Iterator<Item = Dimension>| {
            dimensions.map(|dimension| dimension.to_string()).collect::<Vec<_>>().join(" or ")
        };
        Err(QuantityError::WrongDimension {
            text: shorten(text.trim()),
            found: listed(&mut readings.iter().map(|quantity| quantity.dimension)),
            expected: listed(&mut wanted.iter().copied()),
        })
    }

    /// Suggests a replacement for a string that is not a quantity of a dimension in `wanted`.
    ///
    /// The suggestion adds a missing unit, or replaces a wrong unit with the unit that was probably meant. If neither
    /// is possible, the suggestion is an example value. The suggestion always parses as a quantity of one of the
    /// dimensions.
    pub fn suggestion(text: &str, wanted: &[Dimension]) -> String {
        let trimmed = text.trim();
        let reads = |text: &String| text.len() <= 60 && Self::parse_as(text, wanted).is_ok();
        let with_unit = |number: &str, unit: &str| {
            let tries = std::iter::once(unit.to_owned()).chain(unit::alternatives(unit));
            tries.map(|unit| format!("{number} {unit}")).find(reads)
        };
        let repaired = Decimal::take(trimmed).and_then(|(number, rest)| {
            let (number, rest) = (number.text, rest.trim());
            if rest.is_empty() {
                // The example of a dimension has the most common unit of this dimension.
                let units = wanted.iter().map(|d| d.example());
                let units = units.filter_map(|text| Some(text.split_once(' ')?.1.to_owned()));
                return units.map(|unit| format!("{number} {unit}")).find(reads);
            }
            let Some(fraction) = rest.strip_prefix(',') else { return with_unit(number, rest) };
            // A comma before exactly three digits may be a thousands separator.
            let (digits, unit) = split_digits(fraction);
            let decimals = !number.contains('.') && !matches!(digits.len(), 0 | 3);
            decimals.then(|| with_unit(&format!("{number}.{digits}"), unit.trim()))?
        });
        let example = || wanted.first().map_or_else(String::new, |wanted| wanted.example());
        repaired.unwrap_or_else(example)
    }
}

/// Formats the quantity in SI units, with the fewest digits that parse to exactly the same value.
impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", plain(self.value), self.dimension.si_unit())
    }
}

/// Formats a number with the fewest digits that parse to exactly the same value. An exponent is used
/// if the number is very large or very small.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-5..1e15).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Rounds a number to five significant digits, for error messages.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// Truncates a string to 60 characters, for error messages.
pub fn shorten(text: &str) -> String {
    const LIMIT: usize = 60;
    if text.chars().count() <= LIMIT {
        text.to_owned()
    } else {
        text.chars().take(LIMIT).chain("…".chars()).collect()
    }
}

/// A decimal number as digits and a power of ten, so that conversion from decimal units is exact.
struct Decimal<'a> {
    negative: bool,
    /// All digits in order, without the decimal point; empty for zero.
    digits: String,
    /// Power of ten of the last digit.
    exponent: i64,
    text: &'a str,
}

impl<'a> Decimal<'a> {
    /// Splits a leading decimal number off the text.
    fn take(text: &'a str) -> Option<(Self, &'a str)> {
        let unsigned = |text: &'a str| text.strip_prefix(['-', '+']).unwrap_or(text);
        let (whole, rest) = split_digits(unsigned(text));
        let (fraction, mut rest) = rest.strip_prefix('.').map_or(("", rest), split_digits);
        if whole.is_empty() && fraction.is_empty() {
            return None;
        }
        let mut exponent = -i64::try_from(fraction.len()).ok()?;
        if let Some(power) = rest.strip_prefix(['e', 'E'])
            && let (size, after) = split_digits(unsigned(power))
            && !size.is_empty()
        {
            // An exponent too long for i64 stays far beyond the range of f64 after the clamp.
            let size = size.parse::<i64>().unwrap_or(i64::MAX).min(1_000_000);
            exponent += if power.starts_with('-') { -size } else { size };
            rest = after;
        }
        let digits = format!("{whole}{fraction}").trim_start_matches('0').to_owned();
        let taken = &text[..text.len() - rest.len()];
        Some((Self { negative: text.starts_with('-'), digits, exponent, text: taken }, rest))
    }

    /// Returns the number multiplied by the scale of its unit, that is, in SI units. The result is
    /// exact up to one rounding for decimal units and up to a few roundings for others.
    fn times(&self, scale: &Scale) -> f64 {
        let sign = if self.negative { -1.0 } else { 1.0 };
        if self.digits.is_empty() {
            return 0.0 * sign;
        }
        let exponent = self.exponent + i64::from(scale.ten);
        let exact = self
            .digits
            .parse::<u128>()
            .ok()
            .and_then(|digits| digits.checked_mul(scale.numerator))
            .map(|product| {
                // Exact division leaves a single, correctly rounded conversion from text.
                let (product, divisor) = if product.is_multiple_of(scale.denominator) {
                    (product / scale.denominator, 1.0)
                } else {
                    (product, to_f64(scale.denominator))
                };
                decimal_to_f64(&format!("{product}e{exponent}")) / divisor
            });
        let magnitude = exact.unwrap_or_else(|| {
            let number = decimal_to_f64(self.text.trim_start_matches(['-', '+']));
            let ten = decimal_to_f64(&format!("1e{}", scale.ten));
            number * ten * to_f64(scale.numerator) / to_f64(scale.denominator)
        });
        let angle = if scale.pi >= 0 { PI } else { 1.0 / PI };
        let angle = (0..scale.pi.unsigned_abs()).fold(1.0, |product, _| product * angle);
        sign * magnitude * angle * scale.factor
    }
}

/// Splits a string after its leading digits.
fn split_digits(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()))
}

/// Converts decimal text to the nearest double. The text is well formed by construction, and the
/// caller checks for infinity.
fn decimal_to_f64(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}

fn to_f64(integer: u128) -> f64 {
    integer as f64
}
