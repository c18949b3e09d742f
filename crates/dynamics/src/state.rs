//! State of a simulation: everything that must be saved to continue a run.

use crate::applied::Applied;
use crate::contact_elements::ContactElements;
use crate::element::Memory;
use crate::model::Model;
use crate::real::Real;
use crate::space::{Pose, Space, Twist};

/// Time, poses, twists, contact history, and the plastic elongation and failure of force elements.
#[derive(Clone, Debug, PartialEq)]
pub struct State<S: Space> {
    /// Time (s); lanes may be at different times.
    pub time: S::Real,
    /// Pose of every body.
    pub poses: Vec<Pose<S>>,
    /// Twist of every body.
    pub twists: Vec<Twist<S>>,
    /// Contact elements that may touch before the list is rebuilt, with their contact history.
    pub contact_elements: ContactElements<S>,
    /// Plastic elongation and failure of every force element.
    pub memory: Vec<Memory<S>>,
    /// External forces, at most one for each body; changed by [`Stepper::apply`](crate::Stepper::apply).
    pub applied: Vec<Applied<S>>,
}

impl<S: Space> State<S> {
    /// Creates the initial state of a model, at time zero.
    pub fn initial(model: &Model<S>) -> Self {
        let mut state = Self {
            time: S::Real::zero(),
            poses: model.bodies.iter().map(|b| b.pose).collect(),
            twists: model.bodies.iter().map(|b| b.twist).collect(),
            contact_elements: ContactElements::default(),
            memory: vec![Memory::default(); model.elements.len()],
            applied: Vec::new(),
        };
        state.contact_elements.rebuild(model, &state.poses, &state.twists);
        state
    }
}
