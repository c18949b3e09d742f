//! Units, and their products, quotients and powers.

use crate::dimension::Dimension;
use crate::quantity::QuantityError;

/// Size of a unit in SI: `numerator / denominator · 10^ten · π^pi · factor`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub(crate) numerator: u128,
    pub(crate) denominator: u128,
    pub(crate) ten: i32,
    pub(crate) pi: i32,
    /// Part of the size that the other fields cannot represent exactly. It arises from half-integer
    /// exponents and from products that overflow 128 bits.
    pub(crate) factor: f64,
}

/// A parsed unit expression, such as `kN/cm`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) scale: Scale,
    pub(crate) dimension: Dimension,
}

/// Units: name, exact size (numerator, denominator, power of ten, power of π) and dimension.
///
/// Inch, foot, yard, pound, US gallon and standard gravity are exact by definition; units of force
/// such as `kgf` are the mass unit times standard gravity. `tonf` is the metric ton-force, 1000
/// kgf.
const UNITS: &[(&str, u128, u128, i32, i32, Dimension)] = &[
    ("1", 1, 1, 0, 0, Dimension::NONE),
    ("%", 1, 1, -2, 0, Dimension::NONE),
    ("m", 1, 1, 0, 0, Dimension::LENGTH),
    ("km", 1, 1, 3, 0, Dimension::LENGTH),
    ("dm", 1, 1, -1, 0, Dimension::LENGTH),
    ("cm", 1, 1, -2, 0, Dimension::LENGTH),
    ("mm", 1, 1, -3, 0, Dimension::LENGTH),
    ("um", 1, 1, -6, 0, Dimension::LENGTH),
    ("µm", 1, 1, -6, 0, Dimension::LENGTH),
    ("in", 254, 1, -4, 0, Dimension::LENGTH),
    ("ft", 3048, 1, -4, 0, Dimension::LENGTH),
    ("yd", 9144, 1, -4, 0, Dimension::LENGTH),
    ("L", 1, 1, -3, 0, Dimension::VOLUME),
    ("mL", 1, 1, -6, 0, Dimension::VOLUME),
    ("hL", 1, 1, -1, 0, Dimension::VOLUME),
    ("gallon", 3_785_411_784, 1, -12, 0, Dimension::VOLUME),
    ("kg", 1, 1, 0, 0, Dimension::MASS),
    ("gram", 1, 1, -3, 0, Dimension::MASS),
    ("t", 1, 1, 3, 0, Dimension::MASS),
    ("lb", 45_359_237, 1, -8, 0, Dimension::MASS),
    ("s", 1, 1, 0, 0, Dimension::TIME),
    ("ms", 1, 1, -3, 0, Dimension::TIME),
    ("us", 1, 1, -6, 0, Dimension::TIME),
    ("µs", 1, 1, -6, 0, Dimension::TIME),
    ("min", 60, 1, 0, 0, Dimension::TIME),
    ("rad", 1, 1, 0, 0, Dimension::ANGLE),
    ("mrad", 1, 1, -3, 0, Dimension::ANGLE),
    ("deg", 1, 180, 0, 1, Dimension::ANGLE),
    ("Hz", 1, 1, 0, 0, Dimension::FREQUENCY),
    ("kHz", 1, 1, 3, 0, Dimension::FREQUENCY),
    ("g", 980_665, 1, -5, 0, Dimension::ACCELERATION),
    ("Gal", 1, 1, -2, 0, Dimension::ACCELERATION),
    ("N", 1, 1, 0, 0, Dimension::FORCE),
    ("kN", 1, 1, 3, 0, Dimension::FORCE),
    ("MN", 1, 1, 6, 0, Dimension::FORCE),
    ("kgf", 980_665, 1, -5, 0, Dimension::FORCE),
    ("tonf", 980_665, 1, -2, 0, Dimension::FORCE),
    ("lbf", 44_482_216_152_605, 1, -13, 0, Dimension::FORCE),
    ("kip", 44_482_216_152_605, 1, -10, 0, Dimension::FORCE),
    ("Pa", 1, 1, 0, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("kPa", 1, 1, 3, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("MPa", 1, 1, 6, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("GPa", 1, 1, 9, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("bar", 1, 1, 5, 0, Dimension::STIFFNESS_PER_LENGTH),
    // lbf/in² = 4.4482216152605 N / (0.0254 m)², lbf/ft² = 4.4482216152605 N / (0.3048 m)².
    ("psi", 44_482_216_152_605, 64_516, -5, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("ksi", 44_482_216_152_605, 64_516, -2, 0, Dimension::STIFFNESS_PER_LENGTH),
    ("psf", 44_482_216_152_605, 9_290_304, -5, 0, Dimension::STIFFNESS_PER_LENGTH),
    // lb/ft³ = 0.45359237 kg / (0.3048 m)³.
    ("pcf", 45_359_237, 28_316_846_592, 4, 0, Dimension::DENSITY),
];

/// Alternative spellings with a single meaning, each with the unit that it denotes.
const ALIASES: &[(&str, &str)] = &[
    ("lbs", "lb"),
    ("lbm", "lb"),
    ("kgs", "kg"),
    ("tf", "tonf"),
    ("kips", "kip"),
    ("l", "L"),
    ("liter", "L"),
    ("liters", "L"),
    ("litre", "L"),
    ("litres", "L"),
    ("ml", "mL"),
    ("hl", "hL"),
    ("gallons", "gallon"),
    ("gals", "gallon"),
    ("grams", "gram"),
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("meter", "m"),
    ("meters", "m"),
    ("metre", "m"),
    ("metres", "m"),
    ("inch", "in"),
    ("inches", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("tonne", "t"),
    ("tonnes", "t"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("newton", "N"),
    ("newtons", "N"),
];

/// The ambiguous name `gal`, with the unambiguous names of its two meanings.
const GAL: (&str, [&str; 2]) = ("gal", ["gallon", "Gal"]);

/// Returns the names of all units.
pub fn names() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|unit| unit.0)
}

/// An error in a unit expression. [`UnitError::within`] adds the text that contains the expression.
pub(crate) enum UnitError {
    Unknown { unit: String, nearest: Option<String> },
    Malformed(&'static str),
}

impl UnitError {
    pub(crate) fn within(self, text: &str) -> QuantityError {
        let text = text.to_owned();
        match self {
            Self::Unknown { unit, nearest } => QuantityError::UnknownUnit { unit, text, nearest },
            Self::Malformed(reason) => QuantityError::Malformed { text, reason },
        }
    }
}

/// Parses a unit expression and returns all of its meanings: two if it contains `gal` (a US gallon
/// or a cm/s²), else one.
pub(crate) fn readings(text: &str) -> Result<Vec<Unit>, UnitError> {
    if text.len() > 200 {
        return Err(UnitError::Malformed("it is too long"));
    }
    let tokens = tokenize(text)?;
    let (word, meanings) = GAL;
    let ambiguous = Token::Name(word.to_owned());
    if !tokens.contains(&ambiguous) {
        return Ok(vec![whole(&tokens)?]);
    }
    let reading = |meaning: &str| {
        let named = |token: &Token| {
            if *token == ambiguous { Token::Name(meaning.to_owned()) } else { token.clone() }
        };
        whole(&tokens.iter().map(named).collect::<Vec<_>>())
    };
    meanings.into_iter().map(reading).collect()
}

fn whole(tokens: &[Token]) -> Result<Unit, UnitError> {
    let mut at = 0;
    let unit = product(tokens, &mut at, 0)?;
    if at < tokens.len() {
        return Err(UnitError::Malformed(
            "a closing parenthesis has no matching opening parenthesis",
        ));
    }
    Ok(unit)
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Name(String),
    Times,
    Over,
    Power(String),
    Open,
    Close,
}

fn tokenize(text: &str) -> Result<Vec<Token>, UnitError> {
    let mut tokens = Vec::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            ' ' | '\t' => {}
            '*' | '·' | '⋅' => tokens.push(Token::Times),
            '/' => tokens.push(Token::Over),
            '(' => tokens.push(Token::Open),
            ')' => tokens.push(Token::Close),
            '²' => tokens.push(Token::Power("2".to_owned())),
            '³' => tokens.push(Token::Power("3".to_owned())),
            '^' => {
                let mut power = String::new();
                while let Some(&next) = chars.peek() {
                    let leading_sign = power.is_empty() && (next == '-' || next == '+');
                    if !(next.is_ascii_digit() || next == '.' || leading_sign) {
                        break;
                    }
                    power.push(next);
                    chars.next();
                }
                tokens.push(Token::Power(power));
            }
            _ if c.is_alphabetic() || c == '%' || c == '1' || c == '"' || c == '\'' || c == '_' => {
                // The micro sign and the Greek mu look alike and mean the same.
                let mut name = String::from(if c == 'μ' { 'µ' } else { c });
                while let Some(&next) = chars.peek() {
                    if !(next.is_alphabetic() || next == '_') || c == '1' {
                        break;
                    }
                    name.push(if next == 'μ' { 'µ' } else { next });
                    chars.next();
                }
                tokens.push(Token::Name(name));
                // `ft/s2` is common in files and spreadsheets.
                if let Some(power) = chars.next_if(|next| c != '1' && ('2'..='6').contains(next)) {
                    tokens.push(Token::Power(power.to_string()));
                }
            }
            ',' => return Err(UnitError::Malformed("write a decimal point instead of the comma")),
            _ if c.is_ascii_digit() || c == '.' || c == '-' || c == '+' => {
                return Err(UnitError::Malformed(
                    "there is a second number where a unit was expected; write a power as `m^2`",
                ));
            }
            _ => {
                return Err(UnitError::Malformed(
                    "a unit may contain only names, `*`, `/`, `^` and parentheses",
                ));
            }
        }
    }
    Ok(tokens)
}

/// Maximum depth of nested parentheses.
const DEPTH: u32 = 8;

fn product(tokens: &[Token], at: &mut usize, depth: u32) -> Result<Unit, UnitError> {
    if depth > DEPTH {
        return Err(UnitError::Malformed("its parentheses are nested too deeply"));
    }
    let mut total = factor(tokens, at, depth)?;
    let mut divided = false;
    while let Some(token) = tokens.get(*at) {
        match token {
            Token::Close => break,
            Token::Over => {
                *at += 1;
                total = total.times(factor(tokens, at, depth)?.power(-2)?);
                divided = true;
            }
            Token::Times | Token::Name(_) | Token::Open => {
                // `N/m s` is ambiguous: `N/(m s)` or `(N/m) s`.
                if divided {
                    return Err(UnitError::Malformed(
                        "a product after a quotient is ambiguous; write `N s/m` or `N/(m s)`",
                    ));
                }
                if *token == Token::Times {
                    *at += 1;
                }
                total = total.times(factor(tokens, at, depth)?);
            }
            Token::Power(_) => return Err(UnitError::Malformed("a power follows a power")),
        }
    }
    Ok(total)
}

fn factor(tokens: &[Token], at: &mut usize, depth: u32) -> Result<Unit, UnitError> {
    let unit = match tokens.get(*at) {
        Some(Token::Name(name)) => {
            *at += 1;
            named(name)?
        }
        Some(Token::Open) => {
            *at += 1;
            let inner = product(tokens, at, depth + 1)?;
            if tokens.get(*at) != Some(&Token::Close) {
                return Err(UnitError::Malformed("a parenthesis is not closed"));
            }
            *at += 1;
            inner
        }
        Some(Token::Times | Token::Over | Token::Power(_) | Token::Close) | None => {
            return Err(UnitError::Malformed("a unit is missing"));
        }
    };
    if let Some(Token::Power(power)) = tokens.get(*at) {
        *at += 1;
        return unit.power(halves(power)?);
    }
    Ok(unit)
}

/// Parses an exponent and returns twice its value: `2` gives 4, `1.5` gives 3.
fn halves(power: &str) -> Result<i8, UnitError> {
    let value: f64 =
        power.parse().map_err(|_| UnitError::Malformed("`^` must be followed by a power"))?;
    let halves = value * 2.0;
    if halves.fract() != 0.0 || halves == 0.0 || halves.abs() > 12.0 {
        return Err(UnitError::Malformed("an exponent must be a multiple of 0.5 between -6 and 6"));
    }
    #[expect(clippy::cast_possible_truncation, reason = "a whole number of at most 12 in size")]
    Ok(halves as i8)
}

/// Symbols and names with several meanings, each with the unit most often meant.
const MEANT: &[(&str, &str)] =
    &[("\"", "in"), ("'", "ft"), ("pound", "lb"), ("pounds", "lb"), ("ton", "t"), ("tons", "t")];

fn named(name: &str) -> Result<Unit, UnitError> {
    let spelled = ALIASES.iter().find(|(word, _)| *word == name).map_or(name, |(_, unit)| *unit);
    if let Some(&(_, numerator, denominator, ten, pi, dimension)) =
        UNITS.iter().find(|unit| unit.0 == spelled)
    {
        let scale = Scale { numerator, denominator, ten, pi, factor: 1.0 };
        return Ok(Unit { scale, dimension });
    }
    let nearest = MEANT
        .iter()
        .chain(ALIASES)
        .find(|(word, _)| word.eq_ignore_ascii_case(name))
        .map(|(_, unit)| (*unit).to_owned())
        .or_else(|| names().find(|unit| unit.eq_ignore_ascii_case(name)).map(str::to_owned));
    Err(UnitError::Unknown { unit: name.chars().take(30).collect(), nearest })
}

/// Units of mass with the corresponding units of weight; the two are often confused.
const WEIGHTS: &[(&str, &str)] = &[("kg", "kgf"), ("lb", "lbf"), ("t", "tonf")];

/// Replaces each name in a unit expression by the result of `replace`. A name for which `replace`
/// returns `None` is kept.
fn renamed(text: &str, replace: impl Fn(&str) -> Option<&'static str>) -> String {
    let mut out = String::new();
    let mut rest = text;
    while !rest.is_empty() {
        let end = rest.find(|c: char| !(c.is_alphabetic() || c == '_')).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        out.push_str(replace(word).unwrap_or(word));
        let skip = after.find(char::is_alphabetic).unwrap_or(after.len());
        out.push_str(&after[..skip]);
        rest = &after[skip..];
    }
    out
}

/// Returns candidate replacements for a unit that is unknown or of a wrong dimension, the likeliest
/// first. The candidates themselves may be invalid.
pub(crate) fn alternatives(text: &str) -> Vec<String> {
    let canonical =
        |word: &str| ALIASES.iter().find(|(alias, _)| *alias == word).map(|(_, unit)| *unit);
    let meant = |word: &str| {
        let likely = MEANT.iter().chain(ALIASES).find(|(w, _)| w.eq_ignore_ascii_case(word));
        let known = || names().find(|unit| unit.eq_ignore_ascii_case(word));
        if names().any(|unit| unit == word) {
            None
        } else {
            likely.map(|(_, unit)| *unit).or_else(known)
        }
    };
    let likely = renamed(text, meant);
    let likely = likely.replace('"', "in").replace('\'', "ft");
    let spelled = renamed(&likely, canonical);
    let swapped = |from_mass: bool| {
        renamed(&spelled, |word| {
            let pair = WEIGHTS
                .iter()
                .find(|(mass, weight)| if from_mass { *mass == word } else { *weight == word });
            pair.map(|(mass, weight)| if from_mass { *weight } else { *mass })
        })
    };
    let gram = renamed(&spelled, |word| (word == "g").then_some("gram"));
    let gallon = renamed(&spelled, |word| (word == "Gal").then_some("gallon"));
    let (weight, mass) = (swapped(true), swapped(false));
    vec![likely, weight, mass, gram, gallon]
}

impl Unit {
    fn times(self, other: Self) -> Self {
        Self { scale: self.scale.times(other.scale), dimension: self.dimension + other.dimension }
    }

    /// Returns the unit raised to the power `halves / 2`.
    fn power(self, halves: i8) -> Result<Self, UnitError> {
        let dimension =
            self.dimension.power(halves).ok_or(UnitError::Malformed("its powers are too large"))?;
        Ok(Self { scale: self.scale.power(halves), dimension })
    }
}

impl Scale {
    const ONE: Self = Self { numerator: 1, denominator: 1, ten: 0, pi: 0, factor: 1.0 };

    fn times(self, other: Self) -> Self {
        let factor = self.factor * other.factor;
        let (ten, pi) = (self.ten + other.ten, self.pi + other.pi);
        // Common factors are canceled first, so that units such as `lbf/lb` and `deg/deg` stay
        // exact.
        let (a, d) = reduce(self.numerator, other.denominator);
        let (c, b) = reduce(other.numerator, self.denominator);
        if let (Some(numerator), Some(denominator)) = (a.checked_mul(c), b.checked_mul(d)) {
            return Self { numerator, denominator, ten, pi, factor };
        }
        let ratio = (a as f64) * (c as f64) / ((b as f64) * (d as f64));
        Self { numerator: 1, denominator: 1, ten, pi, factor: factor * ratio }
    }

    fn power(self, halves: i8) -> Self {
        let whole = halves / 2;
        let base = if whole < 0 {
            Self {
                numerator: self.denominator,
                denominator: self.numerator,
                ten: -self.ten,
                pi: -self.pi,
                factor: 1.0 / self.factor,
            }
        } else {
            self
        };
        let mut total = (0..whole.unsigned_abs()).fold(Self::ONE, |t, _| t.times(base));
        if halves % 2 != 0 {
            let ten: f64 = format!("1e{}", self.ten).parse().unwrap_or(f64::NAN);
            let angle = (0..self.pi.unsigned_abs()).fold(1.0, |p, _| p * std::f64::consts::PI);
            let angle = if self.pi < 0 { 1.0 / angle } else { angle };
            let size =
                (self.numerator as f64) / (self.denominator as f64) * ten * angle * self.factor;
            let root = size.sqrt();
            total.factor *= if halves > 0 { root } else { 1.0 / root };
        }
        total
    }
}

fn reduce(a: u128, b: u128) -> (u128, u128) {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    (a / x, b / x)
}
