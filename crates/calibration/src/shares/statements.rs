//! Statements on how many stacks fell in an earthquake, with source and uncertainty.

use std::collections::BTreeSet;
use std::path::Path;

use barrelstack_input::names::nearest;
use barrelstack_input::system;
use serde::Deserialize;

/// Maximum size of a file of statements (bytes).
const SIZE_LIMIT: usize = 1 << 20;

/// Standard deviation of the model error in a share. The model has such an error because it neglects, for example,
/// neighbors, walls and empty barrels.
pub const MODEL_ERROR: f64 = 0.10;

/// Largest permitted value of [`Earthquake::motion`]; one standard deviation is then a factor of 7 up or down.
const MOST_MOTION: f64 = 2.0;

/// Reason why a file of statements, or a selection from it, cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct StatementsError(String);

/// Contents of a file of statements: earthquakes, each with the statements on it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statements {
    /// The earthquakes, in the order of the file.
    pub earthquake: Vec<Earthquake>,
}

/// One earthquake at one place.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Earthquake {
    /// Name and year.
    pub name: String,
    /// Date, magnitude, available records and their peak accelerations and velocities.
    #[serde(default)]
    pub about: String,
    /// Where the cellars lie relative to the station that recorded the motion.
    #[serde(default)]
    pub place: String,
    /// Standard deviation of ln r, where r is the motion in a cellar divided by the motion at the station.
    pub motion: f64,
    /// Names of the studies of `validation/field.md` that simulate the earthquake; empty if no record of the motion
    /// is available.
    #[serde(default)]
    pub studies: Vec<String>,
    /// Statements on the stacks in this earthquake.
    pub observation: Vec<Statement>,
}

/// Statement about the stacks in an earthquake, for example on the share that fell.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// Short name.
    pub id: String,
    /// Description of the observation, in one sentence.
    pub statement: String,
    /// Publication or person that makes the statement.
    pub source: String,
    /// How the statement is converted to numbers, such as a share with its error; required unless the kind is
    /// [`Kind::Unusable`].
    pub uncertainty: Option<String>,
    /// Subject of the statement.
    pub kind: Kind,
    /// Reason why the statement is not used; required if the kind is [`Kind::Unusable`].
    pub reason: Option<String>,
    /// Studies of `validation/field.md` that simulate the observed stacks. If there are several, each simulates one
    /// plane of the same stack; the stack counts as fallen if it falls in at least one plane.
    #[serde(default)]
    pub studies: Vec<String>,
    /// Heights (numbers of levels) of the observed stacks. The proportions of stacks of each height are unknown.
    #[serde(default)]
    pub levels: Vec<usize>,
    /// The observed share or, for [`Kind::Most`] and [`Kind::Few`], its approximate bound. Required for these kinds,
    /// [`Kind::Barrels`] and [`Kind::Stacks`].
    pub value: Option<f64>,
    /// Lower end of the 95 % interval of the observed share; required for [`Kind::Barrels`] and [`Kind::Stacks`].
    pub low: Option<f64>,
    /// Upper end of the 95 % interval of the observed share; required for [`Kind::Barrels`] and [`Kind::Stacks`].
    pub high: Option<f64>,
    /// Standard error of `value`; required for [`Kind::Most`] and [`Kind::Few`].
    pub error: Option<f64>,
    /// Number of stacks of which at least one fell; required for [`Kind::Some`].
    pub stacks: Option<f64>,
}

/// Subject of a statement.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Share of all barrels that lie on the floor.
    Barrels,
    /// Share of the stacks that fell.
    Stacks,
    /// Approximate lower bound of the share of the stacks that fell.
    Most,
    /// Approximate upper bound of the share of the stacks that fell.
    Few,
    /// At least one of a number of stacks fell.
    Some,
    /// Direction in which stacks fell; such a statement has no likelihood.
    Along,
    /// A statement that has no likelihood.
    Unusable,
}

/// Likelihood of a statement as a function of the share of stacks that fell, or of barrels that lie on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likelihood {
    /// Normal distribution about the observed share.
    Near {
        /// The observed share.
        value: f64,
        /// Standard deviation of the distribution.
        error: f64,
    },
    /// The share of the stacks that fell is at least about `value`.
    AtLeast {
        /// Approximate lower bound of the share.
        value: f64,
        /// Standard error of `value`.
        error: f64,
    },
    /// The share of the stacks that fell is at most about `value`.
    AtMost {
        /// Approximate upper bound of the share.
        value: f64,
        /// Standard error of `value`.
        error: f64,
    },
    /// At least one of a number of stacks fell.
    One {
        /// Number of stacks of which at least one fell.
        stacks: f64,
    },
}

impl Likelihood {
    /// Returns the likelihood of a share; the largest possible likelihood is 1.
    pub fn of(&self, share: f64) -> f64 {
        match *self {
            Self::Near { value, error } => {
                let off = (share - value) / error;
                libm::exp(-0.5 * off * off)
            }
            Self::AtLeast { value, error } => {
                barrelstack_fragility::normal((share - value) / error)
            }
            Self::AtMost { value, error } => barrelstack_fragility::normal((value - share) / error),
            Self::One { stacks } => 1.0 - libm::pow(1.0 - share, stacks),
        }
    }

    /// `true` if the standard error or the number of stacks is finite and above zero.
    fn is_proper(self) -> bool {
        let (Self::Near { error, .. }
        | Self::AtLeast { error, .. }
        | Self::AtMost { error, .. }
        | Self::One { stacks: error }) = self;
        error.is_finite() && error > 0.0
    }

    /// Returns the likelihood with a larger standard error: `model`, the standard deviation of an independent model
    /// error, is added in quadrature. [`Likelihood::One`] is returned unchanged.
    #[must_use]
    pub fn wider(self, model: f64) -> Self {
        let wider = |error: f64| libm::hypot(error, model);
        match self {
            Self::Near { value, error } => Self::Near { value, error: wider(error) },
            Self::AtLeast { value, error } => Self::AtLeast { value, error: wider(error) },
            Self::AtMost { value, error } => Self::AtMost { value, error: wider(error) },
            Self::One { .. } => self,
        }
    }
}

impl Statements {
    /// Reads a file of statements (TOML).
    ///
    /// # Errors
    /// If the file cannot be read; also as for [`Statements::read`].
    pub fn load(path: &Path) -> Result<Self, StatementsError> {
        let file = path.display().to_string();
        let unreadable =
            |reason: String| StatementsError(format!("{file} cannot be read: {reason}"));
        let bytes = system::read(path, SIZE_LIMIT).map_err(unreadable)?;
        let text = String::from_utf8(bytes)
            .map_err(|_| unreadable("it is not text in UTF-8".to_owned()))?;
        Self::read(&file, &text)
    }

    /// Reads the text of a file of statements (TOML); `file` is the name that error messages show.
    ///
    /// # Errors
    /// If the text is not a file of statements, a statement has no source, a statement that is used lacks a number,
    /// two statements have the same name, or [`Earthquake::motion`] is out of range.
    pub fn read(file: &str, text: &str) -> Result<Self, StatementsError> {
        let read: Self =
            toml::from_str(text).map_err(|error| StatementsError(format!("{file}: {error}")))?;
        for quake in &read.earthquake {
            if !(0.0..=MOST_MOTION).contains(&quake.motion) {
                return Err(StatementsError(format!(
                    "{file}: earthquake `{}`: `motion` must lie between 0 and {MOST_MOTION}, found {}; it is the \
                     standard deviation of ln r, where r is the motion in a cellar divided by the motion at the \
                     station",
                    quake.name, quake.motion
                )));
            }
        }
        let mut names = BTreeSet::new();
        for statement in read.statements() {
            if !names.insert(&statement.id) {
                return Err(StatementsError(format!(
                    "{file}: two statements are named `{}`; give each its own `id`",
                    statement.id
                )));
            }
            if let Some(fault) = statement.fault() {
                return Err(StatementsError(format!(
                    "{file}: statement `{}`: {fault}",
                    statement.id
                )));
            }
        }
        Ok(read)
    }

    /// Returns the named statements and their earthquake; without names, all statements that have a likelihood.
    ///
    /// # Errors
    /// If a statement is unknown or has no likelihood, or if the statements are about different earthquakes, since a
    /// scenario has one motion.
    pub fn chosen(
        &self,
        names: &[String],
    ) -> Result<(&Earthquake, Vec<&Statement>), StatementsError> {
        let usable = || self.statements().filter(|one| one.likelihood().is_some());
        let known = || usable().map(|one| one.id.as_str()).collect::<Vec<_>>().join(", ");
        for name in names {
            let fault = match self.find(name) {
                None => {
                    match nearest(name, &usable().map(|one| one.id.as_str()).collect::<Vec<_>>()) {
                        Some(near) => format!("there is no such statement, did you mean `{near}`?"),
                        None => "there is no such statement".to_owned(),
                    }
                }
                Some((_, one)) if one.likelihood().is_none() => {
                    let reason = one.reason.as_deref().unwrap_or("it states no share");
                    format!("it has no likelihood: {}", reason.trim_end_matches('.'))
                }
                Some(_) => continue,
            };
            return Err(StatementsError(format!(
                "statement `{name}`: {fault}; the statements with a likelihood are: {}",
                known()
            )));
        }
        let mut found: Vec<(&Earthquake, &Statement)> = Vec::new();
        for one in usable().filter(|one| names.is_empty() || names.contains(&one.id)) {
            found.extend(self.find(&one.id));
        }
        let Some((quake, _)) = found.first().copied() else {
            return Err(StatementsError(
                "no statement has a likelihood, so nothing can be fitted".to_owned(),
            ));
        };
        if let Some((other, _)) = found.iter().find(|(other, _)| other.name != quake.name) {
            return Err(StatementsError(format!(
                "the statements are about two earthquakes, {} and {}, but the scenario has only one motion; choose \
                 statements about one of them: {}",
                quake.name,
                other.name,
                known()
            )));
        }
        Ok((quake, found.into_iter().map(|(_, one)| one).collect()))
    }

    /// Returns all statements.
    pub fn statements(&self) -> impl Iterator<Item = &Statement> {
        self.earthquake.iter().flat_map(|one| &one.observation)
    }

    /// Returns the statement with the name `id` and its earthquake; `None` if there is no such statement.
    pub fn find(&self, id: &str) -> Option<(&Earthquake, &Statement)> {
        let all = self.earthquake.iter();
        let mut pairs = all.flat_map(|quake| quake.observation.iter().map(move |one| (quake, one)));
        pairs.find(|(_, one)| one.id == id)
    }
}

impl Statement {
    /// Returns a sentence on what is missing or wrong in the statement; `None` if it is valid.
    fn fault(&self) -> Option<&'static str> {
        let ordered = |value: f64| {
            let low = self.low.unwrap_or(value);
            let high = self.high.unwrap_or(value);
            0.0 <= low && low <= value && value <= high && high <= 1.0
        };
        Some(if self.source.is_empty() {
            "a statement needs a source"
        } else if self.kind == Kind::Unusable {
            return self.reason.is_none().then_some("a statement that is left out needs a reason");
        } else if self.uncertainty.is_none() {
            "a statement that is used needs its uncertainty"
        } else if self.kind != Kind::Along
            && (self.likelihood().is_none() || self.levels.is_empty())
        {
            "a statement with a likelihood needs `levels` and numbers: `low`, `value` and `high` for `barrels` and \
             `stacks`, `value` and `error` for `most` and `few`, or `stacks` for `some`"
        } else if self.levels.contains(&0) {
            "a stack has at least one level"
        } else if self.value.is_some_and(|value| !ordered(value)) {
            "shares must lie between 0 and 1, with `low` at most `value`, and `value` at most `high`"
        } else if self.likelihood().is_some_and(|one| !one.is_proper()) {
            "the standard error or the number of stacks must be above zero"
        } else {
            return None;
        })
    }

    /// Returns a phrase for what the statement counts, such as "barrels on the floor".
    pub fn subject(&self) -> &'static str {
        if self.kind == Kind::Barrels { "barrels on the floor" } else { "stacks that fall" }
    }

    /// Returns the stated share in words, such as "at least about 90 %".
    pub fn bound(&self) -> String {
        let value = format!("{:.0} %", 100.0 * self.value.unwrap_or(f64::NAN));
        match self.kind {
            Kind::Barrels | Kind::Stacks => value,
            Kind::Most => format!("at least about {value}"),
            Kind::Few => format!("at most about {value}"),
            Kind::Some => format!("one of {} or more", self.stacks.unwrap_or(f64::NAN)),
            Kind::Along | Kind::Unusable => "–".to_owned(),
        }
    }

    /// Returns the likelihood; `None` if the statement has none.
    pub fn likelihood(&self) -> Option<Likelihood> {
        Some(match self.kind {
            Kind::Barrels | Kind::Stacks => Likelihood::Near {
                value: self.value?,
                error: (self.high? - self.low?)
                    / (2.0 * barrelstack_fragility::normal_quantile(0.975)),
            },
            Kind::Most => Likelihood::AtLeast { value: self.value?, error: self.error? },
            Kind::Few => Likelihood::AtMost { value: self.value?, error: self.error? },
            Kind::Some => Likelihood::One { stacks: self.stacks? },
            Kind::Along | Kind::Unusable => return None,
        })
    }
}
