//! Forces from outside the model, such as those of a controller.

use crate::body::{BodyId, Motion};
use crate::model::Model;
use crate::space::{Linear, Space, Wrench};

/// Force and moment on a body, constant until they are replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Applied<S: Space> {
    /// The body.
    pub body: BodyId,
    /// Force (N), in the inertial frame.
    pub force: S::Vector,
    /// Point (m) at which the force acts, in the frame of the body.
    pub point: S::Vector,
    /// Moment (N·m), in the inertial frame, in addition to the moment of the force about the center of mass.
    pub moment: S::Spin,
}

/// Reason why a force cannot be applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ApplyError {
    /// There is no such body.
    #[error("there is no body {body}: the model has {bodies} bodies, counted from 0")]
    NoBody {
        /// The requested body.
        body: BodyId,
        /// Number of bodies of the model.
        bodies: usize,
    },
    /// The body follows the ground.
    #[error(
        "body \"{name}\" follows the ground, so a force does not move it: apply the force to a free body"
    )]
    Prescribed {
        /// Name of the body.
        name: String,
    },
    /// A component of the force, its point or its moment is not finite.
    #[error(
        "the force on body \"{name}\", its point of application or its moment is not finite: every component must be \
         a finite number"
    )]
    NotFinite {
        /// Name of the body.
        name: String,
    },
}

impl<S: Space> Applied<S> {
    /// Returns the force and the moment about the center of mass of the body, given the rotations of all bodies.
    #[inline(always)]
    pub(crate) fn wrench(&self, rotations: &[S::Rotation]) -> Wrench<S> {
        let arm = S::rotate(rotations[self.body], self.point);
        Wrench { force: self.force, moment: S::moment(arm, self.force) + self.moment }
    }

    /// Returns `true` if neither a force nor a moment acts.
    fn is_nothing(&self) -> bool {
        self.force == S::Vector::default() && self.moment == S::Spin::default()
    }
}

impl<S: Space<Real = f64>> Applied<S> {
    /// Stores this force in `all`, the list of the applied forces, which contains at most one force for each body. An
    /// earlier force on the same body is replaced. If this force and its moment are zero, the earlier force is removed
    /// instead.
    ///
    /// Returns the index of the body's force in the list before and after the change; `None` if there is no such force.
    pub(crate) fn replace(
        self,
        model: &Model<S>,
        all: &mut Vec<Self>,
    ) -> Result<[Option<usize>; 2], ApplyError> {
        let bodies = model.bodies();
        let Some(body) = bodies.get(self.body) else {
            return Err(ApplyError::NoBody { body: self.body, bodies: bodies.len() });
        };
        let name = || body.name.clone();
        if body.motion == Motion::Prescribed {
            return Err(ApplyError::Prescribed { name: name() });
        }
        let size = self.force.dot(self.force) + self.point.dot(self.point);
        if !(size + self.moment.dot(self.moment)).is_finite() {
            return Err(ApplyError::NotFinite { name: name() });
        }
        let before = all.iter().position(|one| one.body == self.body);
        match before {
            Some(at) if self.is_nothing() => {
                all.remove(at);
                Ok([before, None])
            }
            Some(at) => {
                all[at] = self;
                Ok([before, before])
            }
            None if self.is_nothing() => Ok([None, None]),
            None => {
                all.push(self);
                Ok([None, Some(all.len() - 1)])
            }
        }
    }
}
