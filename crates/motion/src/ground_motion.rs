//! A ground motion that can drive a model: a horizontal component and optionally a vertical one.

use crate::error::MotionError;
use crate::history::History;
use crate::intensity::IntensityMeasure;
use crate::pulse::Pulse;
use crate::sampled::Sampled;

/// A ground motion with its provenance.
///
/// ```
/// use barrelstack_motion::{GroundMotion, IntensityMeasure, Pulse};
/// let pulse = Pulse::Ricker { acceleration: 3.0, period: 0.8 };
/// let motion = GroundMotion::from_pulse("ricker", pulse)?;
/// let strong = motion.scale_to(IntensityMeasure::Pgv, 0.6)?;
/// assert!((strong.pgv() - 0.6).abs() < 1e-12);
/// # Ok::<(), barrelstack_motion::MotionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GroundMotion {
    /// Horizontal component, positive along `x`.
    pub horizontal: History,
    /// Vertical component, positive upward.
    pub vertical: Option<History>,
    /// Name for tables and plots.
    pub name: String,
    /// Time (s) at which the motion ends.
    pub duration: f64,
    /// Every processing and scaling step, in order, one sentence each.
    pub provenance: Vec<String>,
}

impl GroundMotion {
    /// Creates a motion from its components.
    pub fn new(name: impl Into<String>, horizontal: History, vertical: Option<History>) -> Self {
        let duration = horizontal.duration().max(vertical.as_ref().map_or(0.0, History::duration));
        Self { horizontal, vertical, name: name.into(), duration, provenance: Vec::new() }
    }

    /// Creates a horizontal motion from an analytic pulse.
    ///
    /// # Errors
    /// If a parameter of the pulse is out of range.
    pub fn from_pulse(name: impl Into<String>, pulse: Pulse) -> Result<Self, MotionError> {
        pulse.check()?;
        let mut motion = Self::new(name, History::Analytic(pulse), None);
        motion.provenance.push(format!("closed form: {pulse}"));
        Ok(motion)
    }

    /// Creates a horizontal motion from equally spaced accelerations (m/s²), integrated from rest.
    ///
    /// # Errors
    /// The same as for [`Sampled::new`].
    pub fn from_acceleration(
        name: impl Into<String>,
        time_step: f64,
        acceleration: Vec<f64>,
    ) -> Result<Self, MotionError> {
        Ok(Self::new(name, History::Sampled(Sampled::new(time_step, acceleration)?), None))
    }

    /// Returns the motion with all components multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let step = format!("scaled by {factor:.6} (one factor for all components)");
        self.changed(|history| history.scaled(factor), step)
    }

    /// Returns the motion for a model whose lengths are multiplied by `length_scale` under the same
    /// gravity (Froude scaling). Time and velocity are multiplied by `√length_scale` and
    /// displacement by `length_scale`; acceleration is unchanged.
    #[must_use]
    pub fn froude(&self, length_scale: f64) -> Self {
        let step = format!(
            "Froude-scaled to length {length_scale}: time multiplied by {:.6}, acceleration \
             unchanged",
            length_scale.sqrt()
        );
        self.changed(|history| history.froude(length_scale), step)
    }

    /// Applies a change to all components and adds its description to the provenance.
    fn changed(&self, change: impl Fn(&History) -> History, step: String) -> Self {
        let horizontal = change(&self.horizontal);
        let vertical = self.vertical.as_ref().map(change);
        let provenance = self.provenance.iter().cloned().chain([step]).collect();
        Self { provenance, ..Self::new(self.name.clone(), horizontal, vertical) }
    }

    /// Scales the motion so that its horizontal component has the intensity `target` (SI units).
    /// The vertical component is multiplied by the same factor.
    ///
    /// # Errors
    /// If the measure does not grow with the amplitude or is zero for this motion, or if the target
    /// is not positive.
    pub fn scale_to(&self, measure: IntensityMeasure, target: f64) -> Result<Self, MotionError> {
        let factor = self.scale_factor(measure, target)?;
        let step = format!(
            "scaled by {factor:.6} to {measure} = {target} {} of the horizontal component (one \
             factor for all components)",
            measure.unit()
        );
        Ok(self.changed(|history| history.scaled(factor), step))
    }

    /// Returns the factor that brings the horizontal component to the intensity `target` (SI
    /// units).
    ///
    /// # Errors
    /// The same as for [`GroundMotion::scale_to`].
    pub fn scale_factor(&self, measure: IntensityMeasure, target: f64) -> Result<f64, MotionError> {
        measure.factor(target, &self.name, |factor| {
            if factor == 1.0 {
                measure.of_history(&self.horizontal)
            } else {
                measure.of_history(&self.horizontal.scaled(factor))
            }
        })
    }

    /// Returns an intensity measure of the horizontal component (SI units).
    ///
    /// # Errors
    /// If a parameter of the measure is out of range.
    pub fn intensity(&self, measure: IntensityMeasure) -> Result<f64, MotionError> {
        measure.of_history(&self.horizontal)
    }

    /// Returns the time (s) after which no component exceeds an acceleration limit (m/s²).
    pub fn calm_from(&self, limit: f64) -> f64 {
        let vertical = self.vertical.as_ref().map_or(0.0, |vertical| vertical.calm_from(limit));
        self.horizontal.calm_from(limit).max(vertical)
    }

    /// Returns the peak ground acceleration of the horizontal component (m/s²).
    pub fn pga(&self) -> f64 {
        self.horizontal.pga()
    }

    /// Returns the peak ground velocity of the horizontal component (m/s).
    pub fn pgv(&self) -> f64 {
        self.horizontal.pgv()
    }

    /// Returns the peak ground displacement of the horizontal component (m).
    pub fn pgd(&self) -> f64 {
        self.horizontal.pgd()
    }
}
