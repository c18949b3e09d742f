//! A problem: the requested quantity, the exact answer, and the computation that gives the program's answer.

use barrelstack_dynamics::{ModelError, RunError, SettleError};

/// The computational effort of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Effort for the test suite: softer contacts, wider brackets, smaller ensembles.
    Fast,
    /// Effort for the report: converged answers, with the order of convergence.
    Full,
}

/// The allowed deviation of an answer from the exact answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Relative to the exact answer.
    Relative(f64),
    /// In the unit of the quantity.
    Absolute(f64),
}

impl Tolerance {
    /// Returns the error of an answer, relative or absolute in accordance with this tolerance.
    pub fn error(self, value: f64, exact: f64) -> f64 {
        match self {
            Self::Relative(_) => (value - exact).abs() / exact.abs(),
            Self::Absolute(_) => (value - exact).abs(),
        }
    }

    /// Returns the largest error allowed.
    pub fn limit(self) -> f64 {
        match self {
            Self::Relative(limit) | Self::Absolute(limit) => limit,
        }
    }

    /// Returns `true` if an answer is within the tolerance; NaN is never within.
    pub fn admits(self, value: f64, exact: f64) -> bool {
        self.error(value, exact) <= self.limit()
    }
}

/// The program's answer to a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The answer, in the unit of the problem.
    pub value: f64,
    /// Order of convergence to the exact answer (see the documentation of the crate).
    pub order: Option<f64>,
    /// Note for the reader.
    pub note: String,
}

impl Outcome {
    /// Creates an outcome without a note.
    pub fn of(value: f64) -> Self {
        Self { value, order: None, note: String::new() }
    }

    /// Returns the outcome with a note.
    #[must_use]
    pub fn noted(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }
}

impl From<f64> for Outcome {
    fn from(value: f64) -> Self {
        Self::of(value)
    }
}

/// Reasons why a problem has no answer.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The bodies do not form a valid model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The run failed numerically.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The bodies do not come to rest.
    #[error(transparent)]
    Settle(#[from] SettleError),
    /// A scenario cannot be read.
    #[error(transparent)]
    Scenario(#[from] barrelstack::scenario::ScenarioError),
    /// A scenario cannot be run.
    #[error(transparent)]
    Scene(#[from] barrelstack::RunFailure),
    /// The event of interest did not occur.
    #[error("{0}")]
    Absent(String),
}

/// Converts any error to [`Failure::Absent`].
#[expect(clippy::needless_pass_by_value, reason = "as errors are mapped")]
pub fn absent(reason: impl ToString) -> Failure {
    Failure::Absent(reason.to_string())
}

/// The computation of a problem.
type Run = Box<dyn Fn(Effort) -> Result<Outcome, Failure> + Send + Sync>;

/// A problem with an exact answer.
pub struct Problem {
    /// Unique identifier, such as `housner/quarter-period-0.50`; the part before the slash is the theory.
    pub id: String,
    /// The scene in a few words.
    pub title: String,
    /// Author, year and section of the theory.
    pub source: String,
    /// The requested quantity.
    pub quantity: &'static str,
    /// Unit of the quantity; empty for pure numbers.
    pub unit: &'static str,
    /// The exact or published answer.
    pub exact: f64,
    /// Tolerance at full effort.
    pub tolerance: Tolerance,
    /// Tolerance at fast effort, if it differs from the tolerance at full effort.
    pub fast: Option<Tolerance>,
    /// The computation of the answer.
    pub run: Run,
}

impl Problem {
    /// Returns the tolerance at an effort.
    pub fn tolerance(&self, effort: Effort) -> Tolerance {
        match effort {
            Effort::Full => self.tolerance,
            Effort::Fast => self.fast.unwrap_or(self.tolerance),
        }
    }

    /// Returns the theory that the problem belongs to: the first part of its id.
    pub fn theory(&self) -> &str {
        self.id.split_once('/').map_or(self.id.as_str(), |(theory, _)| theory)
    }

    /// Returns the name of the problem within its theory: the second part of its id.
    pub fn name(&self) -> &str {
        self.id.split_once('/').map_or(self.id.as_str(), |(_, name)| name)
    }
}

/// The id, scene and source of a problem, created by [`setting`].
pub struct Setting {
    id: String,
    title: String,
    source: String,
}

/// Creates a setting from an [id](Problem::id), the scene in a few words, and the source of the theory.
pub fn setting(id: impl Into<String>, title: impl Into<String>, source: &str) -> Setting {
    Setting { id: id.into(), title: title.into(), source: source.into() }
}

impl Setting {
    /// Adds the requested quantity, its unit (empty for pure numbers), and the answer with which it is compared.
    pub fn quantity(
        self,
        quantity: &'static str,
        unit: &'static str,
        reference: Reference,
    ) -> Question {
        Question { setting: self, quantity, unit, reference }
    }
}

/// The exact or published answer with which a computed value is compared, and its tolerance.
pub struct Reference {
    exact: f64,
    tolerance: Tolerance,
    fast: Option<Tolerance>,
}

/// Creates a reference with a relative tolerance.
pub fn relative(exact: f64, limit: f64) -> Reference {
    Reference { exact, tolerance: Tolerance::Relative(limit), fast: None }
}

/// Creates a reference with an absolute tolerance, in the unit of the quantity.
pub fn absolute(exact: f64, limit: f64) -> Reference {
    Reference { exact, tolerance: Tolerance::Absolute(limit), fast: None }
}

impl Reference {
    /// Sets the tolerance at fast effort. `limit` is relative or absolute, like the tolerance at full effort.
    #[must_use]
    pub fn fast(self, limit: f64) -> Self {
        let fast = match self.tolerance {
            Tolerance::Relative(_) => Tolerance::Relative(limit),
            Tolerance::Absolute(_) => Tolerance::Absolute(limit),
        };
        Self { fast: Some(fast), ..self }
    }
}

/// A problem to which no computation has been added yet, created by [`Setting::quantity`].
pub struct Question {
    setting: Setting,
    quantity: &'static str,
    unit: &'static str,
    reference: Reference,
}

impl Question {
    /// Adds the computation.
    pub fn by<A: Into<Outcome>>(
        self,
        answer: impl Fn(Effort) -> Result<A, Failure> + Send + Sync + 'static,
    ) -> Problem {
        let Self { setting: Setting { id, title, source }, quantity, unit, reference } = self;
        let Reference { exact, tolerance, fast } = reference;
        let run: Run = Box::new(move |effort| answer(effort).map(Into::into));
        Problem { id, title, source, quantity, unit, exact, tolerance, fast, run }
    }

    /// Adds a computation that is repeated at successive refinements (see [`refine`]).
    pub fn refined(
        self,
        answer: impl Fn(Effort, i32) -> Result<f64, Failure> + Send + Sync + 'static,
    ) -> Problem {
        let exact = self.reference.exact;
        self.by(move |effort| refine(effort, exact, |level| answer(effort, level)))
    }

    /// Adds a bisection (see [`border`]) between two bounds: `1 - share` and `1 + share` times the exact answer.
    pub fn at_border(
        self,
        share: f64,
        above: impl Fn(f64) -> Result<bool, Failure> + Send + Sync + 'static,
    ) -> Problem {
        let exact = self.reference.exact;
        let bracket = ((1.0 - share) * exact, (1.0 + share) * exact);
        self.by(move |effort| border(bracket, halvings(effort), &above))
    }
}

/// Evaluates the refinements 0, 1 and 2 at full effort, and only the coarsest refinement, 0, at fast effort.
///
/// # Errors
/// If `answer` fails.
pub fn refine(
    effort: Effort,
    exact: f64,
    mut answer: impl FnMut(i32) -> Result<f64, Failure>,
) -> Result<Outcome, Failure> {
    if effort == Effort::Fast {
        return answer(0).map(Outcome::of);
    }
    let values = [answer(0)?, answer(1)?, answer(2)?];
    let errors = values.map(|value| (value - exact).abs());
    // Errors at the level of rounding have no order.
    let floor = 1e-11 * exact.abs();
    let order = (errors[2] > floor && errors[1] > floor).then(|| (errors[1] / errors[2]).log2());
    Ok(Outcome {
        value: values[2],
        order,
        note: format!("errors {:.1e}, {:.1e}, {:.1e}", errors[0], errors[1], errors[2]),
    })
}

/// Returns the number of halvings of a bisection.
pub fn halvings(effort: Effort) -> u32 {
    match effort {
        Effort::Fast => 2,
        Effort::Full => 11,
    }
}

/// Finds by bisection, between two bounds, the value at which `above` changes from `false` to `true`.
///
/// # Errors
/// If `above` is `true` at the lower bound or `false` at the upper bound, or if `above` fails.
pub fn border(
    (mut low, mut high): (f64, f64),
    halvings: u32,
    mut above: impl FnMut(f64) -> Result<bool, Failure>,
) -> Result<f64, Failure> {
    if above(low)? || !above(high)? {
        return Err(Failure::Absent(format!("no boundary between {low} and {high}")));
    }
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if above(middle)? { high = middle } else { low = middle }
    }
    Ok(0.5 * (low + high))
}
