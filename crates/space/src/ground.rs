//! Three-dimensional ground motion: both horizontal components and the vertical component of a motion, rotated into the
//! axes of the stack.

use barrelstack::ground::{GroundError, of_spec, other_component, turn_to_other};
use barrelstack::scenario::{MotionSource, MotionSpec, Scenario};
use barrelstack_dynamics::{Drive, Spatial, Vec3, math};

/// Largest accepted difference (degrees) between 90° and the angle between the two horizontal components.
const SQUARE: f64 = 5.0;

/// Ground motion of a three-dimensional stack.
#[derive(Clone, Debug)]
pub struct Ground {
    /// The horizontal component that the scenario names, and the vertical component if there is one.
    pub first: barrelstack::Ground,
    /// The other horizontal component; `None` if the motion has only one horizontal component.
    pub second: Option<barrelstack::Ground>,
    /// Cosine and sine of the angle by which the stack is rotated counterclockwise.
    turn: [f64; 2],
    /// 1 if the second component points a quarter turn counterclockwise from the first; -1 if it points a quarter turn
    /// clockwise.
    hand: f64,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
}

impl Ground {
    /// Returns the ground motion of a scenario, rotated by the azimuth of its stack. At an azimuth of zero, the
    /// component that the scenario names acts across the barrels, and the other horizontal component acts along the
    /// barrels.
    ///
    /// # Errors
    /// If the motion cannot be read, or cannot be scaled as the scenario requires.
    pub fn of(scenario: &Scenario) -> Result<Self, GroundError> {
        let mut ground = Self::of_spec(&scenario.motion, scenario.run.similitude)?.under(scenario);
        ground.warnings.splice(0..0, scenario.warnings().iter().cloned());
        Ok(ground)
    }

    /// Returns the ground motion without rotation, for a stack built at the length scale `similitude`. The component
    /// that `motion` names acts across the barrels.
    ///
    /// # Errors
    /// The same as for [`Ground::of`].
    pub fn of_spec(motion: &MotionSpec, similitude: f64) -> Result<Self, GroundError> {
        let first = of_spec(motion, similitude)?;
        let second = other_component(motion)?;
        let second = second.map(|spec| of_spec(&spec, similitude)).transpose()?;
        let mut warnings = first.warnings.clone();
        let recorded = matches!(motion.source, MotionSource::Record(_));
        if recorded && second.is_none() {
            warnings.push(
                "the record has only one horizontal component: the ground does not move in the other horizontal \
                 direction, so the share of stacks that fall may be too small; use a record with both components"
                    .to_owned(),
            );
        }
        let turned = turn_to_other(motion)?.filter(|_| second.is_some());
        match turned {
            None if second.is_some() => warnings.push(
                "the record does not state the directions of its horizontal components: the second is assumed to point \
                 90° counterclockwise from the first"
                    .to_owned(),
            ),
            Some(turn) if (turn % 180.0 - 90.0).abs() > SQUARE => warnings.push(format!(
                "the directions of the horizontal components of the record differ by {turn:.0} degrees, but the \
                 components are used as if they were perpendicular"
            )),
            Some(_) | None => {}
        }
        let hand = if turned.is_some_and(|turn| turn < 180.0) { -1.0 } else { 1.0 };
        Ok(Self { first, second, turn: [1.0, 0.0], hand, warnings })
    }

    /// Returns the motion, rotated by the azimuth of the stack in a scenario.
    #[must_use]
    pub fn under(self, scenario: &Scenario) -> Self {
        let azimuth = scenario.stack().and_then(|stack| stack.space).map_or(0.0, |s| s.azimuth);
        self.turned(azimuth)
    }

    /// Returns the motion along the axes of a stack that is rotated counterclockwise by an azimuth (rad).
    #[must_use]
    pub fn turned(self, azimuth: f64) -> Self {
        let (sin, cos) = math::sin_cos(azimuth);
        Self { turn: [cos, sin], ..self }
    }

    /// Returns the motion with all components scaled by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let second = self.second.as_ref().map(|ground| ground.scaled(factor));
        Self { first: self.first.scaled(factor), second, ..self.clone() }
    }

    /// Returns the time (s) at which the motion ends; `None` without motion.
    pub fn motion_end(&self) -> Option<f64> {
        self.first.motion_end().map(|_| self.end())
    }

    /// Returns the time (s) from which the ground is still: the end of the motion, or zero without motion.
    pub fn end(&self) -> f64 {
        self.each(barrelstack::Ground::end)
    }

    /// Returns the time (s) after which no acceleration exceeds a limit (m/s²).
    pub fn calm_from(&self, limit: f64) -> f64 {
        self.each(|ground| ground.calm_from(limit))
    }

    /// Returns the source and every processing step of the components, one sentence each, without duplicates.
    pub fn provenance(&self) -> Vec<String> {
        let grounds = [Some(&self.first), self.second.as_ref()];
        let motions = grounds.into_iter().flatten().filter_map(|ground| ground.motion.as_ref());
        let mut steps: Vec<String> = Vec::new();
        for step in motions.flat_map(|motion| &motion.provenance) {
            // Both horizontal components come from one record, so their processing steps repeat; the vertical
            // component is part of `first`.
            if !steps.contains(step) {
                steps.push(step.clone());
            }
        }
        steps
    }

    fn each(&self, of: impl Fn(&barrelstack::Ground) -> f64) -> f64 {
        self.second.as_ref().map_or(0.0, &of).max(of(&self.first))
    }
}

/// Converts a ground motion of a plane model. The horizontal component of the motion acts across the barrels.
impl From<barrelstack::Ground> for Ground {
    fn from(first: barrelstack::Ground) -> Self {
        let warnings = first.warnings.clone();
        Self { first, second: None, turn: [1.0, 0.0], hand: 1.0, warnings }
    }
}

impl Ground {
    /// Returns the acceleration (m/s²) at a time (s).
    pub fn acceleration(&self, time: f64) -> Vec3 {
        self.kinematics(time)[2]
    }

    /// Returns displacement (m), velocity (m/s) and acceleration (m/s²) at a time (s).
    fn kinematics(&self, time: f64) -> [Vec3; 3] {
        let Some(motion) = &self.first.motion else { return Default::default() };
        let first = motion.horizontal.at(time);
        let second = self.second.as_ref().and_then(|ground| ground.motion.as_ref());
        let second = second.map(|motion| motion.horizontal.at(time)).unwrap_or_default();
        let up = motion.vertical.as_ref().map(|motion| motion.at(time)).unwrap_or_default();
        let ([cos, sin], hand) = (self.turn, self.hand);
        let turned = |a: f64, other: f64, up: f64| {
            let b = hand * other;
            Vec3::new(cos * a + sin * b, cos * b - sin * a, up)
        };
        [
            turned(first.displacement, second.displacement, up.displacement),
            turned(first.velocity, second.velocity, up.velocity),
            turned(first.acceleration, second.acceleration, up.acceleration),
        ]
    }
}

impl Drive<Spatial> for Ground {
    fn at(&self, time: f64) -> (Vec3, Vec3) {
        let [displacement, velocity, _] = self.kinematics(time);
        (displacement, velocity)
    }
}
