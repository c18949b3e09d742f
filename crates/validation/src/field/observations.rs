//! Observations of real earthquakes: what was seen of barrel stacks, with source and uncertainty.

use serde::Deserialize;

use super::FieldError;

/// All earthquakes of the file of observations.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Observations {
    /// The earthquakes, in the order of the page.
    pub earthquake: Vec<Earthquake>,
}

/// One earthquake at one place.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Earthquake {
    /// Name and year.
    pub name: String,
    /// Date, magnitude, records and their peaks.
    pub about: String,
    /// Distance between record and cellars.
    pub place: String,
    /// Standard deviation of ln of the motion in a cellar over that at the station.
    pub motion: f64,
    /// Names of the studies that simulate it; none without a record.
    pub studies: Vec<String>,
    /// The statements.
    pub observation: Vec<Observation>,
}

/// One statement.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Observation {
    /// Short name.
    pub id: String,
    /// What was observed, in a sentence.
    pub statement: String,
    /// Where that is stated.
    pub source: String,
    /// How the statement is read as a number.
    pub uncertainty: Option<String>,
    /// What the statement is about.
    pub kind: Kind,
    /// Why it is left out.
    pub reason: Option<String>,
    /// Studies of the stacks observed; several are planes of one stack, which falls if it falls in one of them.
    #[serde(default)]
    pub studies: Vec<String>,
    /// Heights of the stacks observed, in unknown proportions.
    #[serde(default)]
    pub levels: Vec<usize>,
    /// The observed share.
    pub value: Option<f64>,
    /// Lower end of its interval of 95 %.
    pub low: Option<f64>,
    /// Upper end of its interval of 95 %.
    pub high: Option<f64>,
    /// Standard error of a bound.
    pub error: Option<f64>,
    /// Number of stacks of which at least one fell.
    pub stacks: Option<f64>,
}

/// What a statement is about.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Share of the barrels on the floor.
    Barrels,
    /// Share of the stacks that fell, at least about a value.
    Most,
    /// Share of the stacks that fell, at most about a value.
    Few,
    /// At least one of a number of stacks fell.
    Some,
    /// Direction of the falls.
    Along,
    /// No likelihood.
    Unusable,
}

/// Likelihood of a statement as a function of a share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likelihood {
    /// Normal about a share of barrels.
    Near {
        /// The observed share.
        value: f64,
        /// Standard deviation.
        error: f64,
    },
    /// Share of stacks at least about a value.
    AtLeast {
        /// The value.
        value: f64,
        /// Standard error.
        error: f64,
    },
    /// Share of stacks at most about a value.
    AtMost {
        /// The value.
        value: f64,
        /// Standard error.
        error: f64,
    },
    /// At least one of a number of stacks.
    One {
        /// The number.
        stacks: f64,
    },
}

impl Likelihood {
    /// Returns the likelihood of a share, 1 at most.
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

    /// Returns the same with a further, independent error of the model in quadrature.
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

impl Observations {
    /// Reads the file of observations.
    ///
    /// # Errors
    /// If it is not one, if a statement has no source, or one that is used lacks a number or names an unknown study.
    pub fn read(text: &str) -> Result<Self, FieldError> {
        let read: Self = toml::from_str(text).map_err(|error| FieldError(error.to_string()))?;
        for statement in read.statements() {
            let fault = |what: &str| Err(FieldError(format!("`{}`: {what}", statement.id)));
            if statement.source.is_empty() {
                return fault("a statement needs a source");
            }
            if statement.kind == Kind::Unusable {
                if statement.reason.is_none() {
                    return fault("a statement that is left out needs a reason");
                }
                continue;
            }
            if statement.uncertainty.is_none() || statement.studies.is_empty() {
                return fault("a statement that is used needs its uncertainty and its studies");
            }
            if statement.kind != Kind::Along
                && (statement.likelihood().is_none() || statement.levels.is_empty())
            {
                return fault("a likelihood needs levels and its numbers");
            }
        }
        Ok(read)
    }

    /// Returns all statements.
    pub fn statements(&self) -> impl Iterator<Item = &Observation> {
        self.earthquake.iter().flat_map(|one| &one.observation)
    }

    /// Returns a statement and its earthquake by the name of the statement.
    pub fn find(&self, id: &str) -> Option<(&Earthquake, &Observation)> {
        let all = self.earthquake.iter();
        let mut pairs = all.flat_map(|quake| quake.observation.iter().map(move |one| (quake, one)));
        pairs.find(|(_, one)| one.id == id)
    }
}

impl Observation {
    /// Returns the likelihood; `None` of a statement without one.
    pub fn likelihood(&self) -> Option<Likelihood> {
        Some(match self.kind {
            Kind::Barrels => Likelihood::Near {
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
