//! Problems with exact or published answers, against which the program is validated.
//!
//! A [`Problem`] holds the scene, the exact or published answer with its source, and the tolerance.
//! The tests of this crate run all problems in a fast form, its program runs them in full:
//!
//! ```sh
//! cargo xtask validate
//! ```
//!
//! # Order of convergence
//!
//! Penalty contact has two small parameters, the time step and the duration of a contact.
//! A refinement halves both: it halves the step and makes the contact four times as stiff, with the same
//! damping ratio. The limit is the rigid body of the closed form, and the order is that of the error
//! against the exact answer. Thresholds found by bisection have no order.
//!
//! # Adding a problem
//!
//! A problem that needs only bodies, a motion and one of the predefined quantities is a file in `cases/`
//! (see [`cases`]); any other is a function in one of the [`problems`].

pub mod cases;
pub mod counting;
pub mod execute;
pub mod ode;
pub mod oracle;
pub mod page;
pub mod problem;
pub mod problems;
pub mod rocking;
pub mod swing;

pub use execute::{Row, execute};
pub use problem::{Effort, Failure, Outcome, Problem, Tolerance};
pub use problems::all;

pub use barrelstack_scenes::{GRAVITY, drive, order, scene, spatial, theory, tumble};
