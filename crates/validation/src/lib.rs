//! Problems with exact answers, and the error of the contact code on them.
//!
//! A [`Problem`] holds the scene, the exact or published answer with its source, and the tolerance,
//! side by side. The crate's tests run all of them in a fast form, the program in full:
//!
//! ```sh
//! cargo xtask validate
//! ```
//!
//! # Order of convergence
//!
//! Penalty contact has two small parameters, the time step and the duration of a contact.
//! A refinement halves both: the step is halved and the contact made four times as stiff, with the
//! damping ratio kept, so that the limit is the rigid body of the closed form, and the order is that
//! of the error against the exact answer. Thresholds found by bisection have no order.
//!
//! # Adding a problem
//!
//! A problem that only needs bodies, a motion and one of the defined quantities is a file in `cases/`
//! ([`cases`]); any other is a function in one of the [`problems`].

pub mod cases;
pub mod counting;
pub mod execute;
pub mod field;
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
